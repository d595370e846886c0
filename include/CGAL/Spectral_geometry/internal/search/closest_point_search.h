// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEARCH_CLOSEST_POINT_SEARCH_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEARCH_CLOSEST_POINT_SEARCH_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/search/Box_tree.h>
#include <CGAL/Spectral_geometry/internal/search/closest_point_of_triangle.h>

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

  /// `parts`: for each vertex of the surface the number, from 0, of the part that its faces belong to; parts are searched apart,
  /// so that another one in the way does not count. Empty: all is one part.
  explicit Closest_point_query(const Mesh_matrices& surface, const std::vector<Eigen::Index>& parts = {})
    : m_corners(std::size_t(surface.T.rows()))
    , m_part_of_face(m_corners.size(), 0)
  {
    std::vector<std::vector<Box_tree::Box>> boxes;
    for(std::size_t f = 0; f < m_corners.size(); ++f) {
      const auto face = surface.T.row(Eigen::Index(f));
      const std::size_t part = m_part_of_face[f] =
          parts.empty() ? 0 : std::size_t(parts[std::size_t(face(0))]);
      if(m_parts.size() <= part) {
        m_parts.resize(part + 1);
        boxes.resize(part + 1);
      }
      Box_tree::Box box;
      for(int c = 0; c < 3; ++c) {
        m_corners[f].col(c) = surface.V.row(face(c)).transpose();
        box.extend(m_corners[f].col(c));
      }
      m_parts[part].faces.push_back(Eigen::Index(f));
      boxes[part].push_back(box);
    }
    for(std::size_t part = 0; part < m_parts.size(); ++part)
      m_parts[part].tree.build(boxes[part]);
  }

  /// In a part, which has a face.
  Answer operator()(const Eigen::Vector3d& query, const Eigen::Index part = 0) const
  {
    return closest(query, m_parts[std::size_t(part)].faces.front());
  }

  /// The same from the answer to a query nearby, in its part, which saves most of the search.
  Answer operator()(const Eigen::Vector3d& query, const Answer& nearby) const
  {
    return closest(query, nearby.face);
  }

  const Eigen::Matrix3d& corners(const Eigen::Index face) const { return m_corners[std::size_t(face)]; }

private:
  struct Part
  {
    std::vector<Eigen::Index> faces;
    Box_tree tree;
  };

  Answer closest(const Eigen::Vector3d& query, Eigen::Index face) const
  {
    const Part& part = m_parts[m_part_of_face[std::size_t(face)]];
    Point_of_triangle best = closest_point_of_triangle(query, corners(face));
    part.tree.visit_near(query, best.squared_distance, [&](const std::size_t item) {
      const Point_of_triangle candidate = closest_point_of_triangle(query, corners(part.faces[item]));
      if(candidate.squared_distance < best.squared_distance) {
        best = candidate;
        face = part.faces[item];
      }
    });
    return {face, best.weights, corners(face) * best.weights};
  }

  std::vector<Eigen::Matrix3d> m_corners; // of each face, a column each
  std::vector<std::size_t> m_part_of_face;
  std::vector<Part> m_parts;
};

/// Interpolation at the points closest to the rows of `points`, each looked for in its part.
inline Eigen::SparseMatrix<double> interpolation(const Closest_point_query& closest,
                                                 const Mesh_matrices& surface, const Eigen::MatrixXd& points,
                                                 const std::vector<Eigen::Index>& parts = {})
{
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(std::size_t(3 * points.rows()));
  for(Eigen::Index i = 0; i < points.rows(); ++i) {
    const Closest_point_query::Answer a = closest(points.row(i), parts.empty() ? 0 : parts[std::size_t(i)]);
    for(int c = 0; c < 3; ++c)
      if(a.weights(c) != 0)
        entries.emplace_back(int(i), surface.T(a.face, c), a.weights(c));
  }
  Eigen::SparseMatrix<double> W(points.rows(), surface.V.rows());
  W.setFromTriplets(entries.begin(), entries.end());
  return W;
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEARCH_CLOSEST_POINT_SEARCH_H
