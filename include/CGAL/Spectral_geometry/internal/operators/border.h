// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_OPERATORS_BORDER_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_OPERATORS_BORDER_H

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// The edges of one face, sorted, each with its smaller vertex first.
inline std::vector<std::pair<int, int>> boundary_edges(const Eigen::MatrixXi& T)
{
  std::vector<std::pair<int, int>> edges, result;
  edges.reserve(3 * std::size_t(T.rows()));
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    for(int k = 0; k < 3; ++k)
      edges.push_back(std::minmax({T(f, k), T(f, (k + 1) % 3)}));
  std::sort(edges.begin(), edges.end());
  for(std::size_t i = 0, j; i < edges.size(); i = j) {
    j = std::size_t(std::upper_bound(edges.begin() + std::ptrdiff_t(i), edges.end(), edges[i]) -
                    edges.begin());
    if(j == i + 1)
      result.push_back(edges[i]);
  }
  return result;
}

/// One flag for each of n vertices: whether it is an end of such an edge.
inline std::vector<char> border_vertices(const Eigen::MatrixXi& T, const Eigen::Index n)
{
  std::vector<char> result(std::size_t(n), 0);
  for(const auto& [i, j] : boundary_edges(T))
    result[std::size_t(i)] = result[std::size_t(j)] = 1;
  return result;
}

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_OPERATORS_BORDER_H
