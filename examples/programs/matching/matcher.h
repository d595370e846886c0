// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_MATCHER_H
#define SPECTRAL_EXAMPLES_MATCHING_MATCHER_H

#include "proxy.h"

#include <Eigen/Core>

#include <future>
#include <utility>
#include <vector>

// What makes the map between the proxies a bijection, as nearly as it can: linear assignments
// (Vestner et al. 2017), or bcicp().
enum class Matcher { product_manifold_filter, bcicp };

struct Matching_options
{
  Matcher matcher = Matcher::product_manifold_filter;
  Eigen::Index initial_modes = 20; // of the map from descriptors
  Eigen::Index modes = 100;        // of the maps after up-sampling
  Eigen::Index zoom_step = 4;
  int filter_iterations = 5; // of the matcher; 0: none
  int fine_iterations = 18;  // of the registration in space; 0: none
  double local_weight = 4;   // of a band of curvature there, at most; 0: positions alone
  int threads = 1;
  CGAL::Spectral_geometry::Functional_map_weights weights;
};

// Pairs of vertices of X and Y that are known to correspond.
using Landmarks = std::vector<std::pair<Eigen::Index, Eigen::Index>>;

struct Match
{
  std::vector<Eigen::Index> map; // for each vertex of X as read the vertex of Y as read
  Eigen::MatrixXd C;             // functional map from fine Y to fine X
  double condition = 1, relative_residual = 0; // of the lift
  double seconds_coarse = 0, seconds_lift = 0;
  double peak_coarse = 0; // bytes that the process had at most before the lift
};

// Matches fine X to fine Y over their proxies.
Match match_over_proxies(const Shape& X, const Proxy& coarse_X, const Shape& Y,
                         const Proxy& coarse_Y, const Landmarks& landmarks,
                         const Matching_options& options, const Keep_going& keep_going);

// Matches without proxies, from one start and without the filter: several starts and the
// assignment are beyond meshes of full size.
Match match_directly(const Shape& X, const Shape& Y, const Landmarks& landmarks,
                     const Matching_options& options, const Keep_going& keep_going);

// f for X beside f for Y, with more than one thread.
template <class Function_X, class Function_Y>
auto side_by_side(int threads, const Function_X& for_X, const Function_Y& for_Y)
{
  auto x = std::async(threads > 1 ? std::launch::async : std::launch::deferred, for_X);
  auto y = for_Y();
  return std::make_pair(x.get(), std::move(y));
}

#endif // SPECTRAL_EXAMPLES_MATCHING_MATCHER_H
