// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_TRIANGLES_INTERSECT_IMPL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_TRIANGLES_INTERSECT_IMPL_H

#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

namespace CGAL::Spectral_geometry::internal {

CGAL_SPECTRAL_GEOMETRY_INLINE bool triangles_intersect_exactly(const Corners& s, const Corners& t,
                                                               const std::size_t common)
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

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_TRIANGLES_INTERSECT_IMPL_H
