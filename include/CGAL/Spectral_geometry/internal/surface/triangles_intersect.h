// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_TRIANGLES_INTERSECT_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_TRIANGLES_INTERSECT_H

#include <CGAL/Spectral_geometry/internal/surface/Box_tree.h>
#include <CGAL/Spectral_geometry/internal/separate_compilation.h>

namespace CGAL::Spectral_geometry::internal {

/// A corner of a triangle: which vertex it is, and where.
struct Corner
{
  std::size_t vertex;
  Eigen::Vector3d point;
};

using Corners = std::array<Corner, 3>;

/// The corners of a face of the mesh (V, T).
template <class Positions, class Face>
Corners corners_of_face(const Positions& V, const Face& face)
{
  Corners result;
  for(int k = 0; k < 3; ++k)
    result[k] = {std::size_t(face[k]), V.row(face[k]).transpose()};
  return result;
}

inline Eigen::AlignedBox3d box_of(const Corners& t)
{
  Eigen::AlignedBox3d box;
  for(const Corner& c : t)
    box.extend(c.point);
  return box;
}

/// Whether the corners of t from the `common`-th on lie on one side of the plane of s, certainly:
/// doubles suffice for most.
inline bool lie_on_one_side(const Corners& s, const Corners& t, const std::size_t common)
{
  const Eigen::Vector3d a = s[1].point - s[0].point, b = s[2].point - s[0].point,
                        normal = a.cross(b);
  const double size = a.cwiseAbs().maxCoeff() * b.cwiseAbs().maxCoeff();
  int side = 0;
  for(std::size_t k = common; k < 3; ++k) {
    const Eigen::Vector3d d = t[k].point - s[0].point;
    const double height = normal.dot(d), rounding = 1e-14 * size * d.cwiseAbs().maxCoeff();
    const int sign = height > rounding ? 1 : height < -rounding ? -1 : 0;
    if(sign == 0 || sign == -side)
      return false;
    side = sign;
  }
  return true;
}

/// triangles_intersect() without its quick test, for triangles that share their first `common`
/// vertices.
CGAL_SPECTRAL_GEOMETRY_INLINE bool triangles_intersect_exactly(const Corners& s, const Corners& t,
                                                               std::size_t common);

/// Whether two triangles meet in more than their common vertices or edge. Exact. A triangle without
/// area meets nothing.
inline bool triangles_intersect(Corners s, Corners t)
{
  std::size_t common = 0; // those come to the front
  for(std::size_t k = 0; k < 3; ++k)
    for(std::size_t l = common; l < 3; ++l)
      if(s[k].vertex == t[l].vertex) {
        std::swap(t[common], t[l]);
        std::swap(s[common++], s[k]);
        break;
      }
  if((common < 3 && lie_on_one_side(s, t, common)) || (common < 2 && lie_on_one_side(t, s, common)))
    return false;
  return triangles_intersect_exactly(s, t, common);
}

/// Pairs of faces, the smaller index first, in ascending order.
using Face_pairs = std::vector<std::pair<Eigen::Index, Eigen::Index>>;

/// All pairs of faces of the mesh (V, T) that meet in more than a common vertex or edge.
template <class Positions>
Face_pairs self_intersecting_faces(const Positions& V, const Eigen::MatrixXi& T)
{
  std::vector<Box_tree::Box> boxes;
  boxes.reserve(std::size_t(T.rows()));
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    boxes.push_back(box_of(corners_of_face(V, T.row(f))));
  Box_tree tree;
  tree.build(boxes);
  Face_pairs pairs;
  for(Eigen::Index f = 0; f < T.rows(); ++f) {
    const Corners face = corners_of_face(V, T.row(f));
    tree.any(boxes[std::size_t(f)], [&](const std::size_t item) {
      const Eigen::Index g = Eigen::Index(item);
      if(f < g && triangles_intersect(face, corners_of_face(V, T.row(g))))
        pairs.emplace_back(f, g);
      return false;
    });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

} // namespace CGAL::Spectral_geometry::internal

#if !defined(CGAL_SPECTRAL_GEOMETRY_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_GEOMETRY)

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

namespace CGAL::Spectral_geometry::internal {

bool triangles_intersect_exactly(const Corners& s, const Corners& t, const std::size_t common)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto point = [](const Corner& c) {
    return Kernel::Point_3(c.point.x(), c.point.y(), c.point.z());
  };
  const std::array<Kernel::Point_3, 3> p = {point(s[0]), point(s[1]), point(s[2])},
                                       q = {point(t[0]), point(t[1]), point(t[2])};
  if(common == 2 && !CGAL::coplanar(p[0], p[1], p[2], q[2]))
    return false;
  if(CGAL::collinear(p[0], p[1], p[2]) || CGAL::collinear(q[0], q[1], q[2]))
    return false;
  if(common == 0)
    return CGAL::do_intersect(Kernel::Triangle_3(p[0], p[1], p[2]),
                              Kernel::Triangle_3(q[0], q[1], q[2]));
  if(common == 1)
    return CGAL::do_intersect(Kernel::Triangle_3(p[0], p[1], p[2]),
                              Kernel::Segment_3(q[1], q[2])) ||
           CGAL::do_intersect(Kernel::Triangle_3(q[0], q[1], q[2]), Kernel::Segment_3(p[1], p[2]));
  return common == 3 || CGAL::coplanar_orientation(p[0], p[1], p[2], q[2]) != CGAL::NEGATIVE;
}

} // namespace CGAL::Spectral_geometry::internal

#endif // definitions

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_TRIANGLES_INTERSECT_H
