// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_INTERNAL_VERTEX_RINGS_H
#define CGAL_SPECTRAL_TOOLBOX_INTERNAL_VERTEX_RINGS_H

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace CGAL::Spectral_geometry::internal {

/// The neighbours of each vertex.
inline std::vector<std::vector<int>> vertex_neighbors(const Eigen::MatrixXi& T,
                                                      const Eigen::Index n)
{
  std::vector<std::vector<int>> result(static_cast<std::size_t>(n));
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    for(int k = 0; k < 3; ++k)
      for(const int l : {1, 2})
        result[std::size_t(T(f, k))].push_back(T(f, (k + l) % 3));
  for(std::vector<int>& row : result) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
  return result;
}

/// Whole rings of v, v first, until there are so many vertices; only some neighbours of a hub,
/// spread over all: a fan would hand all of its vertices to each. `seen` has been zero everywhere,
/// and is again.
inline std::vector<int> rings_of(const std::vector<std::vector<int>>& neighbors, const int v,
                                 const std::size_t wanted, std::vector<char>& seen)
{
  constexpr std::size_t most_of_a_hub = 64;
  std::vector<int> result = {v};
  seen[std::size_t(v)] = 1;
  for(std::size_t first = 0; first < result.size() && result.size() < wanted;) {
    const std::size_t last = result.size();
    for(; first < last; ++first) {
      const std::vector<int>& row = neighbors[std::size_t(result[first])];
      const std::size_t step = first == 0 ? 1 : (row.size() + most_of_a_hub - 1) / most_of_a_hub;
      for(std::size_t i = 0; i < row.size(); i += step)
        if(!seen[std::size_t(row[i])]) {
          seen[std::size_t(row[i])] = 1;
          result.push_back(row[i]);
        }
    }
  }
  for(const int w : result)
    seen[std::size_t(w)] = 0;
  return result;
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_TOOLBOX_INTERNAL_VERTEX_RINGS_H
