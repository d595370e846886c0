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

// Returns the permutation p that maximises sum_i scores(i, p[i]), with the scores rounded to a
// millionth of their range: a transport of one unit from each row to each column, by LEMON's
// network simplex. With fewer rows than columns each row has a column of its own; with more each
// column has a row of its own, and the rows that are left take their best columns.
inline std::vector<Eigen::Index> linear_assignment(const Eigen::MatrixXd& scores)
{
  const Eigen::Index n = scores.rows(), m = scores.cols();
  if(n == 0 || m == 0 || !scores.allFinite())
    throw std::invalid_argument(
        "linear assignment: the scores must be a matrix of finite numbers.");
  using Graph = lemon::SmartDigraph;
  Graph graph;
  graph.reserveNode(static_cast<int>(n + m));
  graph.reserveArc(static_cast<int>(n * m));
  for(Eigen::Index i = 0; i < n + m; ++i)
    graph.addNode();
  for(Eigen::Index i = 0; i < n; ++i)
    for(Eigen::Index j = 0; j < m; ++j)
      graph.addArc(Graph::nodeFromId(static_cast<int>(i)),
                   Graph::nodeFromId(static_cast<int>(n + j)));

  // Integers: with floating point costs the simplex may go round in circles.
  const double largest = scores.maxCoeff(), range = largest - scores.minCoeff();
  const double scale = range > 0 ? 1e6 / range : 0.;
  Graph::ArcMap<long long> cost(graph);
  for(Eigen::Index i = 0; i < n; ++i)
    for(Eigen::Index j = 0; j < m; ++j)
      cost[Graph::arcFromId(static_cast<int>(i * m + j))] =
          std::llround(scale * (largest - scores(i, j)));
  Graph::NodeMap<int> supply(graph, 1);
  for(Eigen::Index j = 0; j < m; ++j)
    supply[Graph::nodeFromId(static_cast<int>(n + j))] = -1;

  lemon::NetworkSimplex<Graph, int, long long> simplex(graph);
  simplex.supplyType(n > m ? decltype(simplex)::LEQ : decltype(simplex)::GEQ);
  if(simplex.costMap(cost).supplyMap(supply).run() != decltype(simplex)::OPTIMAL)
    throw std::runtime_error("linear assignment: LEMON found no solution.");
  std::vector<Eigen::Index> result(static_cast<std::size_t>(n));
  for(Eigen::Index i = 0; i < n && n > m; ++i)
    scores.row(i).maxCoeff(&result[static_cast<std::size_t>(i)]);
  for(Eigen::Index i = 0; i < n; ++i)
    for(Eigen::Index j = 0; j < m; ++j)
      if(simplex.flow(Graph::arcFromId(static_cast<int>(i * m + j))) == 1)
        result[static_cast<std::size_t>(i)] = j;
  return result;
}

#endif // SPECTRAL_EXAMPLES_MATCHING_LINEAR_ASSIGNMENT_H
