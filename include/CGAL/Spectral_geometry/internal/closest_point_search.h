// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_CLOSEST_POINT_SEARCH_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_CLOSEST_POINT_SEARCH_H

#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>
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

// A point of a triangle as a convex combination of its three vertices.
struct Point_of_triangle
{
  Eigen::Vector3d weights;
  double squared_distance; // to the query
};

inline Eigen::Vector3d combination(const Eigen::Matrix3d& triangle, const Eigen::Vector3d& weights)
{
  return triangle * weights;
}

// Keeps the candidate if it is strictly closer: a vertex or an edge that is tried first wins against an
// interior point that only rounding makes as close.
inline void keep_closer(const Eigen::Vector3d& query, const Eigen::Matrix3d& triangle,
                        const Eigen::Vector3d& weights, Point_of_triangle& best)
{
  const double d = (combination(triangle, weights) - query).squaredNorm();
  if(d < best.squared_distance)
    best = {weights, d};
}

// The point of the triangle (one vertex per column) closest to the query. The best of the projections on the
// three edges and, when it lies inside, on the plane. Each candidate is a point of the triangle and its
// distance is measured, so that an ill-conditioned plane (a needle) can lose accuracy but never give a point
// off the triangle; a face without area is the union of its edges, a face without extent a point. The
// kernel's projection goes through the normal.
inline Point_of_triangle closest_point_of_triangle(const Eigen::Vector3d& query,
                                                   const Eigen::Matrix3d& triangle)
{
  Point_of_triangle best{Eigen::Vector3d::UnitX(), (triangle.col(0) - query).squaredNorm()};
  for(int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Eigen::Vector3d edge = triangle.col(j) - triangle.col(i);
    const double length2 = edge.squaredNorm();
    const double s = length2 > 0 ? std::clamp(edge.dot(query - triangle.col(i)) / length2, 0., 1.) : 0.;
    Eigen::Vector3d weights = Eigen::Vector3d::Zero();
    weights(i) = 1 - s;
    weights(j) = s;
    keep_closer(query, triangle, weights, best);
  }
  const Eigen::Vector3d a = triangle.col(1) - triangle.col(0), b = triangle.col(2) - triangle.col(0);
  const Eigen::Vector3d q = query - triangle.col(0);
  const double aa = a.squaredNorm(), ab = a.dot(b), bb = b.squaredNorm(), aq = a.dot(q), bq = b.dot(q);
  const double determinant = aa * bb - ab * ab; // (2 area)^2
  const double v = (bb * aq - ab * bq) / determinant, w = (aa * bq - ab * aq) / determinant;
  if(v > 0 && w > 0 && v + w < 1) // false for NaN as well
    keep_closer(query, triangle, Eigen::Vector3d(1 - v - w, v, w), best);
  return best;
}

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
      return to_point(combination(face.id()->corners, closest.weights));
    }
  };

  Closest_point closest_point_object() const { return Closest_point(); }
};

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_CLOSEST_POINT_SEARCH_H
