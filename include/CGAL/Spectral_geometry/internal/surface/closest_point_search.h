// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_CLOSEST_POINT_SEARCH_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_CLOSEST_POINT_SEARCH_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/surface/Box_tree.h>
#include <CGAL/Spectral_geometry/internal/surface/closest_point_of_triangle.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <cstddef>
#include <vector>

namespace CGAL::Spectral_geometry::internal {

/// Closest points of one surface, asked for again and again.
class Closest_point_query
{
public:
  struct Answer
  {
    Eigen::Index face;
    Eigen::Vector3d weights, point;
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
    m_tree.visit_near(query, best.squared_distance, [&](const std::size_t item) {
      const Point_of_triangle candidate = closest_point_of_triangle(query, m_corners[item]);
      if(candidate.squared_distance < best.squared_distance && may_be(Eigen::Index(item))) {
        best = candidate;
        face = Eigen::Index(item);
      }
    });
    return {face, best.weights, corners(face) * best.weights};
  }

  const Eigen::Matrix3d& corners(const Eigen::Index face) const
  {
    return m_corners[std::size_t(face)];
  }

private:
  std::vector<Eigen::Matrix3d> m_corners; // of each face, a column each
  Box_tree m_tree;
};

/// The matrix of which row i, of `rows`, reads functions off at `answer(i)`, a closest point of the
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
