// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEARCH_CLOSEST_POINT_OF_TRIANGLE_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEARCH_CLOSEST_POINT_OF_TRIANGLE_H

#include <Eigen/Core>

#include <algorithm>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// A point of a triangle as a convex combination of its three vertices.
struct Point_of_triangle
{
  Eigen::Vector3d weights;
  double squared_distance; // to the query
};

/// The point of a triangle, one vertex per column, that is closest to the query: the best of the projections on
/// the three edges and, when it lies inside, on the plane. Each candidate is a point of the triangle and its
/// distance is measured, so that an ill-conditioned plane (a needle) can lose accuracy but never give a point
/// off the triangle; a face without area is the union of its edges, a face without extent a point. The
/// kernel's projection goes through the normal.
inline Point_of_triangle closest_point_of_triangle(const Eigen::Vector3d& query,
                                                   const Eigen::Matrix3d& triangle)
{
  using Vector = Eigen::Vector3d;
  Point_of_triangle best{Eigen::Vector3d::UnitX(), (triangle.col(0) - query).squaredNorm()};
  // Strictly closer: a vertex or an edge that is tried first wins against an interior point that only rounding makes as close.
  const auto keep_closer = [&](const Eigen::Vector3d& weights) {
    const double d = (triangle * weights - query).squaredNorm();
    if(d < best.squared_distance)
      best = {weights, d};
  };
  for(int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Vector edge = triangle.col(j) - triangle.col(i);
    const double length2 = edge.squaredNorm();
    const double s = length2 > 0 ? std::clamp(edge.dot(query - triangle.col(i)) / length2, 0., 1.) : 0.;
    Eigen::Vector3d weights = Eigen::Vector3d::Zero();
    weights(i) = 1 - s;
    weights(j) = s;
    keep_closer(weights);
  }
  const Vector a = triangle.col(1) - triangle.col(0), b = triangle.col(2) - triangle.col(0),
               q = query - triangle.col(0);
  const double aa = a.squaredNorm(), ab = a.dot(b), bb = b.squaredNorm(), aq = a.dot(q), bq = b.dot(q);
  const double determinant = aa * bb - ab * ab; // (2 area)^2
  const double v = (bb * aq - ab * bq) / determinant, w = (aa * bq - ab * aq) / determinant;
  if(v > 0 && w > 0 && v + w < 1) // false for NaN as well
    keep_closer(Eigen::Vector3d(1 - v - w, v, w));
  return best;
}

/// The same in a space of any dimension, from squared distances alone: d of the query from the corners, l of the edges, the i-th of which
/// leads from corner i to the next. Exact to the rounding of the d, which is too little for a query that is all but on the triangle:
/// a point has to be closer than that to win against a corner.
inline Point_of_triangle closest_point_of_triangle_by_distances(const Eigen::Vector3d& d,
                                                                const Eigen::Vector3d& l)
{
  Point_of_triangle best{Eigen::Vector3d::UnitX(), d(0)};
  const double rounding = 1e-14 * d.sum();
  const auto keep_closer = [&](const Eigen::Vector3d& w) {
    const double d_w = w.dot(d) - (w(0) * w(1) * l(0) + w(1) * w(2) * l(1) + w(2) * w(0) * l(2));
    if(d_w < best.squared_distance - rounding)
      best = {w, (std::max)(d_w, 0.)};
  };
  for(int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double s = l(i) > 0 ? std::clamp((d(i) + l(i) - d(j)) / (2 * l(i)), 0., 1.) : 0.;
    Eigen::Vector3d weights = Eigen::Vector3d::Zero();
    weights(i) = 1 - s;
    weights(j) = s;
    keep_closer(weights);
  }
  // a and b lead from the first corner to the others, q to the query.
  const double aa = l(0), bb = l(2), ab = (l(0) + l(2) - l(1)) / 2, aq = (d(0) + l(0) - d(1)) / 2,
               bq = (d(0) + l(2) - d(2)) / 2;
  const double determinant = aa * bb - ab * ab; // (2 area)^2
  const double v = (bb * aq - ab * bq) / determinant, w = (aa * bq - ab * aq) / determinant;
  if(v > 0 && w > 0 && v + w < 1) // false for NaN as well
    keep_closer(Eigen::Vector3d(1 - v - w, v, w));
  return best;
}

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEARCH_CLOSEST_POINT_OF_TRIANGLE_H
