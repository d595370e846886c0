// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SELF_INTERSECTING_FACES_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SELF_INTERSECTING_FACES_H

#include <CGAL/Spectral_geometry/internal/Box_tree.h>
#include <CGAL/Spectral_geometry/internal/triangles_intersect.h>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// Pairs of faces, the smaller index first, in ascending order.
using Face_pairs = std::vector<std::pair<Eigen::Index, Eigen::Index>>;

/// The pairs of faces of the mesh (V, T) that meet in more than a common vertex or edge.
template <class Positions, class Found>
bool any_self_intersecting_faces(const Positions& V, const Eigen::MatrixXi& T, const Found& found)
{
  std::vector<Corners> faces;
  std::vector<Box_tree::Box> boxes;
  for(Eigen::Index f = 0; f < T.rows(); ++f) {
    faces.push_back(corners_of_face(V, T.row(f)));
    boxes.push_back(box_of(faces.back()));
  }
  Box_tree tree;
  tree.build(boxes);
  for(std::size_t f = 0; f < faces.size(); ++f)
    if(tree.any(boxes[f], [&](const std::size_t g) {
         return f < g && triangles_intersect(faces[f], faces[g]) && found(Eigen::Index(f), Eigen::Index(g));
       }))
      return true;
  return false;
}

/// All of them, in ascending order.
template <class Positions>
Face_pairs self_intersecting_faces(const Positions& V, const Eigen::MatrixXi& T)
{
  Face_pairs pairs;
  any_self_intersecting_faces(V, T, [&](const Eigen::Index f, const Eigen::Index g) {
    pairs.emplace_back(f, g);
    return false;
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SELF_INTERSECTING_FACES_H
