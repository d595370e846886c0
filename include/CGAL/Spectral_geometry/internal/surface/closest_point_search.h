// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_CLOSEST_POINT_SEARCH_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_CLOSEST_POINT_SEARCH_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/surface/Box_tree.h>

namespace CGAL::Spectral_geometry::internal {

/// A point of a triangle as a convex combination of its three vertices.
struct Point_of_triangle
{
  Eigen::Vector3d weights;
  double squared_distance; // to the query
};

/// The point of a triangle that is closest to a query, in any dimension: the best of the
/// projections on the three edges and, when it lies inside, on the plane. Each candidate is a point
/// of the triangle and its distance is measured, by `squared_distance(weights)`, so that an
/// ill-conditioned plane (a needle) can lose accuracy but never give a point off the triangle; a
/// face without area is the union of its edges, a face without extent a point. The kernel's
/// projection goes through the normal.
///
/// `best`: the first corner. `lengths`: squared, of the edges; edge i leads from corner i to the
/// next. `along`: the inner product of edge i with the way from corner i to the query. `ab` and
/// `bq`: the inner products of b, from the first corner to the last, with the first edge and with
/// the way to the query.
template <class Squared_distance>
Point_of_triangle closest_of_projections(Point_of_triangle best, const Eigen::Vector3d& lengths,
                                         const Eigen::Vector3d& along, const double ab,
                                         const double bq, const double rounding,
                                         const Squared_distance& squared_distance)
{
  // Strictly closer: a vertex or an edge that is tried first wins against an interior point that
  // only rounding makes as close.
  const auto keep_closer = [&](const Eigen::Vector3d& weights) {
    const double d = squared_distance(weights);
    if(d < best.squared_distance - rounding)
      best = {weights, d};
  };
  for(int i = 0; i < 3; ++i) {
    const double s = lengths(i) > 0 ? std::clamp(along(i) / lengths(i), 0., 1.) : 0.;
    Eigen::Vector3d weights = Eigen::Vector3d::Zero();
    weights(i) = 1 - s;
    weights((i + 1) % 3) = s;
    keep_closer(weights);
  }
  const double aa = lengths(0), bb = lengths(2), aq = along(0);
  const double determinant = aa * bb - ab * ab; // (2 area)^2
  const double v = (bb * aq - ab * bq) / determinant, w = (aa * bq - ab * aq) / determinant;
  if(v > 0 && w > 0 && v + w < 1) // false for NaN as well
    keep_closer(Eigen::Vector3d(1 - v - w, v, w));
  return best;
}

/// Here a triangle lies in space, with one vertex per column.
inline Point_of_triangle closest_point_of_triangle(const Eigen::Vector3d& query,
                                                   const Eigen::Matrix3d& triangle)
{
  Eigen::Vector3d lengths, along;
  for(int i = 0; i < 3; ++i) {
    const Eigen::Vector3d edge = triangle.col((i + 1) % 3) - triangle.col(i);
    lengths(i) = edge.squaredNorm();
    along(i) = edge.dot(query - triangle.col(i));
  }
  const Eigen::Vector3d a = triangle.col(1) - triangle.col(0),
                        b = triangle.col(2) - triangle.col(0), q = query - triangle.col(0);
  return closest_of_projections(
      {Eigen::Vector3d::UnitX(), q.squaredNorm()}, lengths, along, a.dot(b), b.dot(q), 0.,
      [&](const Eigen::Vector3d& weights) { return (triangle * weights - query).squaredNorm(); });
}

/// Works in any dimension, from squared distances alone: d of the query from the corners, l of the
/// edges. Exact to the rounding of d. This does not suffice for a query almost on the triangle: a
/// point must be closer by more than that to win against a corner.
inline Point_of_triangle closest_point_of_triangle_by_distances(const Eigen::Vector3d& d,
                                                                const Eigen::Vector3d& l)
{
  const Eigen::Vector3d along = (d + l - Eigen::Vector3d(d(1), d(2), d(0))) / 2;
  return closest_of_projections(
      {Eigen::Vector3d::UnitX(), d(0)}, l, along, (l(0) + l(2) - l(1)) / 2, l(2) - along(2),
      1e-14 * d.sum(), [&](const Eigen::Vector3d& w) {
        return w.dot(d) - (w(0) * w(1) * l(0) + w(1) * w(2) * l(1) + w(2) * w(0) * l(2));
      });
}

/// Closest points of one surface, asked for again and again.
class Closest_point_query
{
public:
  struct Answer
  {
    Eigen::Index face;
    Eigen::Vector3d weights, point;
    bool is_nearest; // whether no excluded face is nearer, up to rounding
  };

  explicit Closest_point_query(const Mesh_matrices& surface)
    : m_corners(std::size_t(surface.T.rows()))
  {
    std::vector<Box_tree::Box> boxes(m_corners.size());
    for(std::size_t f = 0; f < m_corners.size(); ++f)
      for(int c = 0; c < 3; ++c) {
        m_corners[f].col(c) = surface.V.row(surface.T(Eigen::Index(f), c)).transpose();
        boxes[f].extend(m_corners[f].col(c));
      }
    m_tree.build(boxes);
  }

  Answer operator()(const Eigen::Vector3d& query) const
  {
    return among(query, 0, [](Eigen::Index) { return true; });
  }

  /// Looks among the faces for which `may_be` is true, one of which is `face`: the nearer that
  /// one is, the shorter the search.
  template <class May_be>
  Answer among(const Eigen::Vector3d& query, Eigen::Index face, const May_be& may_be) const
  {
    Point_of_triangle best = closest_point_of_triangle(query, corners(face));
    double refused = std::numeric_limits<double>::infinity();
    m_tree.visit_near(query, best.squared_distance, [&](const std::size_t item) {
      const Point_of_triangle candidate = closest_point_of_triangle(query, m_corners[item]);
      if(!(candidate.squared_distance < best.squared_distance))
        return;
      if(may_be(Eigen::Index(item))) {
        best = candidate;
        face = Eigen::Index(item);
      } else
        refused = (std::min)(refused, candidate.squared_distance);
    });
    return {face, best.weights, corners(face) * best.weights,
            refused >= (1 - 2e-6) * best.squared_distance};
  }

  const Eigen::Matrix3d& corners(const Eigen::Index face) const { return m_corners[face]; }

private:
  std::vector<Eigen::Matrix3d> m_corners; // of each face, a column each
  Box_tree m_tree;
};

/// The matrix whose row i, of `rows`, interpolates functions at `answer(i)`, a closest point of the
/// surface.
template <class Answer_of>
Eigen::SparseMatrix<double> interpolation(const Mesh_matrices& surface, const Eigen::Index rows,
                                          const Answer_of& answer)
{
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(std::size_t(3 * rows));
  for(Eigen::Index i = 0; i < rows; ++i) {
    const Closest_point_query::Answer a = answer(i);
    for(int c = 0; c < 3; ++c)
      if(a.weights(c) != 0)
        entries.emplace_back(int(i), surface.T(a.face, c), a.weights(c));
  }
  Eigen::SparseMatrix<double> W(rows, surface.V.rows());
  W.setFromTriplets(entries.begin(), entries.end());
  return W;
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_CLOSEST_POINT_SEARCH_H
