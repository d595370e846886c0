// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_LOCAL_SHAPE_H
#define SPECTRAL_EXAMPLES_MATCHING_LOCAL_SHAPE_H

#include "proxy.h"

#include <Eigen/Core>

#include <vector>

// Refines a map between fine meshes by what the first modes cannot tell: where on a limb a wrinkle is.
//
// A pose stretches the surface a little, and the map that the modes agree on best is then off by an edge or two in the mean,
// whatever it was found by; more iterations with modes alone lead away from the truth. Mean curvature, in bands of scale between
// an edge and the finest mode, moves with the surface. Each step looks for the vertex that is nearest in the embedding by
// modes and, with the weights below, in these bands; it tries the images of the neighbours and walks downhill from the best
// of them, so that it takes a fraction of the time of a search among all vertices.
class Local_refinement
{
public:
  // largest_weight: of a band, which has variance 1, beside the modes; 0 refines by the modes alone.
  Local_refinement(const Shape& X, const Shape& Y, double largest_weight, int threads);

  // Changes the map from X to Y, and C, from Y to X, with it: at most `iterations` steps, fewer when nothing moves.
  void refine(std::vector<Eigen::Index>& map, Eigen::MatrixXd& C, int iterations,
              const Keep_going& keep_going) const;

  // Signal over noise of each band under a map, r^2 / (1 - r^2) with the correlation r, cut at the largest weight: animals
  // of different species share the shape of the limbs, not the wrinkles.
  Eigen::VectorXd weights(const std::vector<Eigen::Index>& map) const;

private:
  using Neighbours = std::vector<std::vector<Eigen::Index>>;

  std::vector<Eigen::Index> step(const std::vector<Eigen::Index>& map, const Eigen::MatrixXd& C,
                                 const Eigen::VectorXd& weights) const;

  const Shape &m_X, &m_Y;
  double m_largest_weight;
  int m_threads;
  Eigen::MatrixXd m_of_X, m_of_Y; // the bands, one per row
  Neighbours m_neighbours_X, m_neighbours_Y;
};

#endif // SPECTRAL_EXAMPLES_MATCHING_LOCAL_SHAPE_H
