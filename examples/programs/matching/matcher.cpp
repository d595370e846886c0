// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "matcher.h"

#include "../io/machine_memory.h"
#include "bcicp.h"
#include "linear_assignment.h"
#include "registration.h"
#include "starts.h"

#include <CGAL/Real_timer.h>
#include <CGAL/Spectral_geometry/Run_control.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_toolbox/hierarchical_functional_maps.h>
#include <CGAL/Spectral_toolbox/vertex_maps.h>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace SG = CGAL::Spectral_geometry;

namespace {

// Permutations of largest score, or assignments that come as near, under ever narrower kernels.
Eigen::MatrixXd of_permutations(Eigen::MatrixXd C, const SG::Spectral_shape& X,
                                const SG::Spectral_shape& Y, const Matching_options& options,
                                const Keep_going& keep_going)
{
  // From a twentieth of the shape to the distance of neighbouring vertices.
  const double widest = 0.05 * 0.05 / 2, narrowest = 0.5 / static_cast<double>(X.op.B.rows()) / 2;
  for(int i = 0; i < options.filter_iterations; ++i) {
    if(!keep_going())
      throw SG::Cancelled();
    const double s =
        options.filter_iterations > 1 ? double(i) / (options.filter_iterations - 1) : 1.;
    const double time = widest * std::pow(narrowest / widest, s);
    const auto permutation = linear_assignment(SG::product_manifold_scores(C, Y, X, time));
    C = SG::functional_map_of_vertex_map(Y.pairs.vectors.leftCols(C.cols()),
                                         X.pairs.vectors.leftCols(C.rows()), X.op.B, permutation);
  }
  return C;
}

Eigen::MatrixXd of_bcicp(const Eigen::MatrixXd& C, const Shape& X, const Shape& Y,
                         const Matching_options& options, const Keep_going& keep_going)
{
  const SG::Spectral_shape &x = X.spectral, &y = Y.spectral;
  const Eigen::MatrixXd phi = x.pairs.vectors.leftCols(C.rows()),
                        psi = y.pairs.vectors.leftCols(C.cols());
  const Vertex_maps maps = bcicp(
      X, Y,
      {SG::target_to_source_map(C, psi, phi), SG::target_to_source_map(C.transpose(), phi, psi)},
      C.rows(), options.filter_iterations, options.threads, keep_going);
  return (SG::functional_map_of_vertex_map(psi, phi, x.op.B, maps.X_to_Y) +
          SG::functional_map_of_vertex_map(phi, psi, y.op.B, maps.Y_to_X).transpose()) /
         2;
}

Eigen::MatrixXd filtered(Eigen::MatrixXd C, const Shape& X, const Shape& Y,
                         const Matching_options& options, const Keep_going& keep_going)
{
  if(options.filter_iterations == 0)
    return C;
  C = options.matcher == Matcher::bcicp
          ? of_bcicp(C, X, Y, options, keep_going)
          : of_permutations(std::move(C), X.spectral, Y.spectral, options, keep_going);
  // A bijection rounds to vertices, which costs the upper modes: up-sample once more.
  const Eigen::Index half = C.rows() / 2;
  return SG::zoom_out(C.topLeftCorner(half, half), Y.spectral, X.spectral, C.rows(),
                      2 * options.zoom_step, {options.threads});
}

// One step of ZoomOut between the levels, from the map C of fine Y to fine X to k modes: the
// vertices of the coarse X look for their images among all vertices of the fine Y, and the map from
// the fine Y to the coarse X is lifted as in section 5.2. No coarse face interpolates, and only as
// many points are searched as the proxy has vertices.
Eigen::MatrixXd refined_once(const Eigen::MatrixXd& C, const Shape& X, const Proxy& coarse_X,
                             const Shape& Y, Eigen::Index k, int threads)
{
  const Eigen::MatrixXd &phi = X.spectral.pairs.vectors, &psi = Y.spectral.pairs.vectors;
  const SG::Spectral_shape& coarse = coarse_X.shape.spectral;
  Eigen::MatrixXd at_representatives(coarse.op.B.rows(), C.rows());
  for(Eigen::Index i = 0; i < at_representatives.rows(); ++i)
    at_representatives.row(i) =
        phi.row(coarse_X.representative[static_cast<std::size_t>(i)]).head(C.rows());
  const std::vector<Eigen::Index> images =
      SG::target_to_source_map(C, psi, at_representatives, {threads});
  const Eigen::MatrixXd coarse_phi = coarse.pairs.vectors.leftCols(k);
  const Eigen::MatrixXd to_coarse =
      SG::functional_map_of_vertex_map(psi.leftCols(k), coarse_phi, coarse.op.B, images);
  const Eigen::MatrixXd restriction =
      SG::functional_map(coarse_phi, coarse.op.B, coarse_X.restriction, phi.leftCols(k));
  return SG::lift_functional_map(Eigen::MatrixXd::Identity(k, k), to_coarse, restriction).C;
}

// From the smoother half of the modes of the lifted map to all of them. Both directions take part:
// where the shapes are not quite isometric, each is drawn its own way, and these errors are
// opposite.
Eigen::MatrixXd refined_between_levels(Eigen::MatrixXd C, const Shape& X, const Proxy& coarse_X,
                                       const Shape& Y, const Proxy& coarse_Y,
                                       const Matching_options& options)
{
  const Eigen::Index last = C.rows(), step = 10;
  constexpr int repetitions = 2; // of the last step
  Eigen::Index k = (last + 1) / 2;
  C = Eigen::MatrixXd(C.topLeftCorner(k, k));
  for(int at_last = 0; at_last < repetitions; at_last += k == last) {
    k = (std::min)(k + step, last);
    const Eigen::MatrixXd there = refined_once(C, X, coarse_X, Y, k, options.threads);
    const Eigen::MatrixXd back = refined_once(C.transpose(), Y, coarse_Y, X, k, options.threads);
    C = (there + back.transpose()) / 2;
  }
  return C;
}

void finish(Match& match, const Shape& X, const Shape& Y, const Matching_options& options,
            const Keep_going& keep_going)
{
  Registration::Maps maps = Registration(X, Y, options.local_weight, options.threads)
                                .refine(match.C, options.fine_iterations, keep_going);
  match.map = std::move(maps.map);
  if(options.fine_iterations > 0)
    match.C = SG::functional_map_of_vertex_map(Y.spectral.pairs.vectors.leftCols(match.C.cols()),
                                               X.spectral.pairs.vectors.leftCols(match.C.rows()),
                                               X.spectral.op.B, match.map);
  if(!maps.of_full.empty())
    match.map = std::move(maps.of_full);
}

} // namespace

Match match_over_proxies(const Shape& X, const Proxy& coarse_X, const Shape& Y,
                         const Proxy& coarse_Y, const Landmarks& landmarks,
                         const Matching_options& options, const Keep_going& keep_going)
{
  Match match;
  CGAL::Real_timer timer;
  timer.start();
  Landmarks coarse_landmarks;
  for(const auto& [x, y] : landmarks)
    coarse_landmarks.emplace_back(coarse_X.vertex_map[static_cast<std::size_t>(x)],
                                  coarse_Y.vertex_map[static_cast<std::size_t>(y)]);
  const SG::Spectral_shape &x = coarse_X.shape.spectral, &y = coarse_Y.shape.spectral;
  Eigen::MatrixXd C = map_of_many_starts(x, y, coarse_landmarks, options, keep_going);
  C = filtered(std::move(C), coarse_X.shape, coarse_Y.shape, options, keep_going);
  match.seconds_coarse = timer.time();
  match.peak_coarse = peak_memory();

  timer.reset();
  const auto restriction = [&](const Shape& fine, const Proxy& proxy) {
    return SG::functional_map(proxy.shape.spectral.pairs.vectors.leftCols(C.rows()),
                              proxy.shape.spectral.op.B, proxy.restriction,
                              fine.spectral.pairs.vectors.leftCols(C.rows()));
  };
  const SG::Lifted_functional_map lifted =
      SG::lift_functional_map(restriction(Y, coarse_Y), C, restriction(X, coarse_X));
  match.C = lifted.C;
  match.condition = lifted.condition;
  match.relative_residual = lifted.relative_residual;
  match.C = refined_between_levels(std::move(match.C), X, coarse_X, Y, coarse_Y, options);
  finish(match, X, Y, options, keep_going);
  match.seconds_lift = timer.time();
  return match;
}

Match match_directly(const Shape& X, const Shape& Y, const Landmarks& landmarks,
                     const Matching_options& options, const Keep_going& keep_going)
{
  Match match;
  CGAL::Real_timer timer;
  timer.start();
  match.C = map_of_descriptors(X.spectral, Y.spectral, landmarks, options, keep_going);
  finish(match, X, Y, options, keep_going);
  match.seconds_coarse = timer.time();
  match.peak_coarse = peak_memory();
  return match;
}
