// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_LINEAR_ASSIGNMENT_H
#define SPECTRAL_EXAMPLES_MATCHING_LINEAR_ASSIGNMENT_H

#include <Eigen/Core>

#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

#include <cmath>
#include <stdexcept>
#include <vector>

// Returns the permutation p that maximises sum_i scores(i, p[i]), with the scores rounded to a millionth of their range:
// a transport of one unit from each row to each column, by LEMON's network simplex.
inline std::vector<Eigen::Index> linear_assignment(const Eigen::MatrixXd& scores)
{
  const Eigen::Index n = scores.rows();
  if(n != scores.cols() || n == 0 || !scores.allFinite())
    throw std::invalid_argument("linear assignment: the scores must be a square matrix of finite numbers.");
  using Graph = lemon::SmartDigraph;
  Graph graph;
  graph.reserveNode(static_cast<int>(2 * n));
  graph.reserveArc(static_cast<int>(n * n));
  for(Eigen::Index i = 0; i < 2 * n; ++i)
    graph.addNode();
  for(Eigen::Index i = 0; i < n; ++i)
    for(Eigen::Index j = 0; j < n; ++j)
      graph.addArc(Graph::nodeFromId(static_cast<int>(i)), Graph::nodeFromId(static_cast<int>(n + j)));

  // Integers: with floating point costs the simplex may go round in circles.
  const double largest = scores.maxCoeff(), range = largest - scores.minCoeff();
  const double scale = range > 0 ? 1e6 / range : 0.;
  Graph::ArcMap<long long> cost(graph);
  for(Eigen::Index i = 0; i < n; ++i)
    for(Eigen::Index j = 0; j < n; ++j)
      cost[Graph::arcFromId(static_cast<int>(i * n + j))] = std::llround(scale * (largest - scores(i, j)));
  Graph::NodeMap<int> supply(graph, 1);
  for(Eigen::Index j = 0; j < n; ++j)
    supply[Graph::nodeFromId(static_cast<int>(n + j))] = -1;

  lemon::NetworkSimplex<Graph, int, long long> simplex(graph);
  if(simplex.costMap(cost).supplyMap(supply).run() != decltype(simplex)::OPTIMAL)
    throw std::runtime_error("linear assignment: LEMON found no solution.");
  std::vector<Eigen::Index> result(static_cast<std::size_t>(n));
  for(Eigen::Index i = 0; i < n; ++i)
    for(Eigen::Index j = 0; j < n; ++j)
      if(simplex.flow(Graph::arcFromId(static_cast<int>(i * n + j))) == 1)
        result[static_cast<std::size_t>(i)] = j;
  return result;
}

#endif // SPECTRAL_EXAMPLES_MATCHING_LINEAR_ASSIGNMENT_H
