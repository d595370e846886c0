// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SELF_INTERSECTING_FACES_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SELF_INTERSECTING_FACES_H

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// Pairs of faces, the smaller index first, in ascending order.
using Face_pairs = std::vector<std::pair<Eigen::Index, Eigen::Index>>;

/// The pairs of faces of the mesh (V, T) that meet in more than a common vertex or edge.
template <class Positions>
Face_pairs self_intersecting_faces(const Positions& V, const Eigen::MatrixXi& T)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel; // the predicates have to be right
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  Mesh mesh;
  for(Eigen::Index v = 0; v < V.rows(); ++v)
    mesh.add_vertex(Kernel::Point_3(V(v, 0), V(v, 1), V(v, 2)));
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    if(mesh.add_face(Mesh::Vertex_index(Mesh::size_type(T(f, 0))),
                     Mesh::Vertex_index(Mesh::size_type(T(f, 1))),
                     Mesh::Vertex_index(Mesh::size_type(T(f, 2)))) == Mesh::null_face())
      throw std::invalid_argument("relocation: triangle " + std::to_string(f) +
                                  " does not continue an oriented 2-manifold; repair the mesh.");
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> found;
  CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(found));
  Face_pairs pairs;
  for(const auto& [f, g] : found)
    pairs.emplace_back(Eigen::Index((std::min)(f, g)), Eigen::Index((std::max)(f, g)));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SELF_INTERSECTING_FACES_H
