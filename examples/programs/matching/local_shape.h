// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_LOCAL_SHAPE_H
#define SPECTRAL_EXAMPLES_MATCHING_LOCAL_SHAPE_H

#include "proxy.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

// Refines a map between fine meshes by what the first modes cannot tell: where on a limb a wrinkle is.
//
// A pose stretches the surface a little, and the map that the modes agree on best is then off by an edge or two in the mean,
// whatever it was found by; more iterations with modes alone lead away from the truth. Mean curvature, in bands of scale between
// an edge and the finest mode, moves with the surface. Each iteration looks for the vertex that is nearest in the embedding by
// modes and, with the weights below, in these bands.
//
// A sample of vertices goes to the fixed point of these iterations, which is where maps that were found in different ways meet;
// all vertices then need a few. Most iterations try the images of the neighbours and walk downhill from the best of them, in a
// fraction of the time of a search among all vertices; every fourth of the sample searches among all, because the walk sticks at
// one vertex in seventy.
class Local_refinement
{
public:
  // largest_weight: of a band, which has variance 1, beside the modes; 0 refines by the modes alone.
  Local_refinement(const Shape& X, const Shape& Y, double largest_weight, int threads);

  // Makes the map from X to Y of C, from Y to X, and changes C with it: at most `iterations` of the sample, fewer when nothing
  // moves any more. 0: the map of C as it is.
  std::vector<Eigen::Index> refine(Eigen::MatrixXd& C, int iterations, const Keep_going& keep_going) const;

private:
  using Neighbours = std::vector<std::vector<Eigen::Index>>;

  // Vertices of X with their images.
  struct Part
  {
    std::vector<Eigen::Index> vertices, images;
    Eigen::MatrixXd modes, bands; // one column each
    Eigen::MatrixXd to_map;       // times the modes of Y at the images, one row each, is the map C
    bool complete = false;        // all vertices, in their order
  };

  Part part(std::vector<Eigen::Index> vertices, Eigen::Index modes) const;
  // Signal over noise of each band under the images, r^2 / (1 - r^2) with the correlation r, cut at the largest weight: animals
  // of different species share the shape of the limbs, not the wrinkles.
  Eigen::VectorXd weights(const Part& part, const std::vector<Eigen::Index>& images) const;
  std::vector<Eigen::Index> walked(const Part& part, const Eigen::MatrixXd& points,
                                   const Eigen::MatrixXd& queries) const;
  std::vector<Eigen::Index> searched(const Part& part, const Eigen::MatrixXd& C,
                                     const Eigen::VectorXd& weights) const;
  // One iteration; returns how many images changed.
  std::size_t iterate(Part& part, Eigen::MatrixXd& C, Eigen::VectorXd& weights, bool among_all) const;
  void set_map(const Part& part, Eigen::MatrixXd& C) const;

  const Shape &m_X, &m_Y;
  double m_largest_weight;
  int m_threads;
  Eigen::MatrixXd m_of_X, m_of_Y; // the bands, one per row
  Neighbours m_neighbours_X, m_neighbours_Y;
};

#endif // SPECTRAL_EXAMPLES_MATCHING_LOCAL_SHAPE_H
