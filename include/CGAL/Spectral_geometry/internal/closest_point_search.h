// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_CLOSEST_POINT_SEARCH_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_CLOSEST_POINT_SEARCH_H

#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spectral_geometry/internal/closest_point_of_triangle.h>
#include <CGAL/version.h>
#if CGAL_VERSION_MAJOR >= 6
#include <CGAL/AABB_traits_3.h>
#else
#include <CGAL/AABB_traits.h>
#endif

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

using Closest_point_kernel = CGAL::Simple_cartesian<double>;

inline Closest_point_kernel::Point_3 to_point(const Eigen::Vector3d& p)
{
  return Closest_point_kernel::Point_3(p(0), p(1), p(2));
}

// A face of the surface, its index and its corners (one per column).
struct Indexed_face
{
  Indexed_face(Eigen::Index face, const Eigen::Matrix3d& points)
    : id(face)
    , corners(points)
    , triangle(to_point(points.col(0)), to_point(points.col(1)), to_point(points.col(2)))
  {}

  Eigen::Index id;
  Eigen::Matrix3d corners;
  Closest_point_kernel::Triangle_3 triangle;
};

// Model of `AABBPrimitive`: a handle on a face.
class Indexed_face_primitive
{
public:
  using Id = std::vector<Indexed_face>::const_iterator;
  using Point = Closest_point_kernel::Point_3;
  using Datum = Closest_point_kernel::Triangle_3;
  using Datum_reference = const Datum&;
  using Point_reference = const Point&;

  Indexed_face_primitive(Id face)
    : m_face(face)
  {}

  Id id() const { return m_face; }
  Datum_reference datum() const { return m_face->triangle; }
  Point_reference reference_point() const { return m_face->triangle.vertex(0); }

private:
  Id m_face;
};

#if CGAL_VERSION_MAJOR >= 6
using Face_traits_base = CGAL::AABB_traits_3<Closest_point_kernel, Indexed_face_primitive>;
#else
using Face_traits_base = CGAL::AABB_traits<Closest_point_kernel, Indexed_face_primitive>;
#endif

// CGAL's traits with the closest point above instead of the kernel's.
class Face_traits : public Face_traits_base
{
public:
  struct Closest_point
  {
    Point_3 operator()(const Point_3& query, const Indexed_face_primitive& face, const Point_3& bound) const
    {
      const Eigen::Vector3d q(query.x(), query.y(), query.z());
      const Point_of_triangle closest = closest_point_of_triangle(q, face.id()->corners);
      if(closest.squared_distance >= CGAL::squared_distance(query, bound))
        return bound;
      return to_point(face.id()->corners * closest.weights);
    }
  };

  Closest_point closest_point_object() const { return Closest_point(); }
};

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_CLOSEST_POINT_SEARCH_H
