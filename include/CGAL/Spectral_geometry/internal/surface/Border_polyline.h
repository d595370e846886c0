// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_BORDER_POLYLINE_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_BORDER_POLYLINE_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/surface/Box_tree.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

#include <set>

namespace CGAL::Spectral_geometry::internal {

/// Proximity queries on the border of a mesh, which is kept by reference.
class Border_polyline
{
public:
  /// A point of a piece of the border: (1 - weight) of its first end and weight of its second.
  struct Point
  {
    std::size_t segment = 0;
    double weight = 0;
    Eigen::Vector3d position;
    double squared_distance = (std::numeric_limits<double>::infinity)();

    bool exists() const { return squared_distance < (std::numeric_limits<double>::infinity)(); }
  };

  explicit Border_polyline(const Mesh_matrices& mesh)
    : m_mesh(mesh)
    , m_segments(boundary_edges(mesh.T))
  {
    m_loop = connected_components(mesh.V.rows(), [this](const auto& join) {
      for(const auto& [i, j] : m_segments)
        join(i, j);
    });
    std::vector<Box_tree::Box> boxes;
    for(std::size_t s = 0; s < m_segments.size(); ++s) {
      boxes.emplace_back(end(s, 0));
      boxes.back().extend(end(s, 1));
    }
    m_tree.build(boxes);
  }

  bool is_empty() const { return m_segments.empty(); }
  const std::pair<int, int>& segment(const std::size_t s) const { return m_segments[s]; }
  Eigen::Vector3d end(const std::size_t s, const int k) const
  {
    return m_mesh.V.row(k == 0 ? m_segments[s].first : m_segments[s].second);
  }
  /// The number of the closed curve that a piece belongs to.
  Eigen::Index loop(const std::size_t s) const { return m_loop[m_segments[s].first]; }

  /// For each row of a restriction, the border curves that its vertices lie on.
  std::vector<std::set<Eigen::Index>> loops_of_rows(const Eigen::SparseMatrix<double>& P) const
  {
    const std::vector<char> on_border = border_vertices(m_mesh.T, m_mesh.V.rows());
    std::vector<std::set<Eigen::Index>> result(std::size_t(P.rows()));
    for(Eigen::Index j = 0; j < P.cols(); ++j)
      for(Eigen::SparseMatrix<double>::InnerIterator it(P, j); it; ++it)
        if(on_border[j] && it.value() > 0)
          result[it.row()].insert(m_loop[j]);
    return result;
  }

  /// The closest point of the pieces that are allowed; there may be none.
  template <class Allowed>
  Point closest(const Eigen::Vector3d& p, const Allowed& allowed) const
  {
    Point result;
    if(is_empty())
      return result;
    m_tree.visit_near(p, result.squared_distance, [&](const std::size_t s) {
      const Eigen::Vector3d a = end(s, 0), b = end(s, 1);
      const double length2 = (b - a).squaredNorm(),
                   weight = length2 > 0 ? std::clamp((b - a).dot(p - a) / length2, 0., 1.) : 0.;
      const Eigen::Vector3d position = weight == 1 ? b : Eigen::Vector3d(a + weight * (b - a));
      const double distance = (position - p).squaredNorm();
      if((distance < result.squared_distance ||
          (distance == result.squared_distance && s < result.segment)) &&
         allowed(s))
        result = {s, weight, position, distance};
    });
    return result;
  }

  /// The pieces whose boxes are no further than this from `p`, ascending.
  std::vector<std::size_t> near(const Eigen::Vector3d& p, const double distance) const
  {
    std::vector<std::size_t> result;
    m_tree.any(Box_tree::Box(p.array() - distance, p.array() + distance), [&](const std::size_t s) {
      result.push_back(s);
      return false;
    });
    std::sort(result.begin(), result.end());
    return result;
  }

private:
  const Mesh_matrices& m_mesh;
  std::vector<std::pair<int, int>> m_segments;
  std::vector<Eigen::Index> m_loop; // by vertex
  Box_tree m_tree;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_BORDER_POLYLINE_H
