// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "matcher.h"

#include "linear_assignment.h"

#include <CGAL/Spectral_geometry/Cancelled.h>
#include <CGAL/Spectral_geometry/hierarchical_functional_maps.h>
#include <CGAL/Spectral_geometry/spectral_distances.h>
#include <CGAL/Spectral_geometry/vertex_maps.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <future>
#include <utility>
#include <vector>

namespace SG = CGAL::Spectral_geometry;

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Signatures of both shapes at the same times and energies, and heat that spreads from landmarks.
class Descriptors
{
public:
  Descriptors(const SG::Spectral_shape& X, const SG::Spectral_shape& Y, const Landmarks& landmarks)
  {
    const Eigen::Index steps = 20, spreads = 4;
    const Eigen::VectorXd times = SG::heat_kernel_times(X.pairs, steps);
    const SG::Wave_kernel_energies energies = SG::wave_kernel_energies(X.pairs, steps);
    const Eigen::VectorXd spreading = SG::heat_kernel_times(X.pairs, spreads + 2).segment(1, spreads);
    const auto compute = [&](const SG::Spectral_shape& shape, const std::vector<Eigen::Index>& sources) {
      const Eigen::Index marks = static_cast<Eigen::Index>(sources.size());
      Eigen::MatrixXd result(shape.op.B.rows(), 2 * steps + spreads * marks);
      result.leftCols(steps) = SG::heat_kernel_signature(shape.pairs, times);
      result.middleCols(steps, steps) = SG::wave_kernel_signature(shape.pairs, energies);
      for(Eigen::Index t = 0; t < spreads && marks > 0; ++t)
        result.middleCols(2 * steps + t * marks, marks) = SG::heat_kernel(shape.pairs, sources, spreading(t));
      // Functions without their means: constants tell nothing.
      return Eigen::MatrixXd(result.rowwise() - shape.op.mass.transpose() * result);
    };
    std::vector<Eigen::Index> of_X, of_Y;
    for(const auto& [x, y] : landmarks) {
      of_X.push_back(x);
      of_Y.push_back(y);
    }
    f_X = compute(X, of_X);
    f_Y = compute(Y, of_Y);
  }

  Eigen::MatrixXd f_X, f_Y;
};

// How far a map is from one of an orientation-preserving isometry; small is good. Limbs that changed places and mirror
// images are far.
double strangeness(const Eigen::MatrixXd& C, const SG::Spectral_shape& X, const SG::Spectral_shape& Y)
{
  const Eigen::Index k = C.rows();
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(k, k);
  const double root = std::sqrt(static_cast<double>(k));
  const double orthonormality =
      ((C.transpose() * C - I).norm() + (C * C.transpose() - I).norm()) / (2 * root);
  const Eigen::MatrixXd before = C * Y.pairs.values.head(k).asDiagonal(),
                        after = X.pairs.values.head(k).asDiagonal() * C;
  const double commutativity = (before - after).norm() / std::hypot(before.norm(), after.norm());
  // Do the oriented derivatives along a few smooth functions agree? 1: they do, -1: mirrored.
  double orientation = 0;
  constexpr Eigen::Index functions = 6;
  const Eigen::MatrixXd phi = X.pairs.vectors.leftCols(k), psi = Y.pairs.vectors.leftCols(k);
  for(Eigen::Index i = 1; i <= functions; ++i) {
    const Eigen::MatrixXd first = C * SG::orientation_operator(Y.T, psi, psi.col(i)),
                          second = SG::orientation_operator(X.T, phi, phi * C.col(i)) * C;
    orientation += (first.array() * second.array()).sum() / (first.norm() * second.norm() * functions);
  }
  return orthonormality + commutativity - orientation;
}

// C from Y to X, up-sampled. On coarse meshes the best of several starts.
Eigen::MatrixXd initial_map(const SG::Spectral_shape& X, const SG::Spectral_shape& Y,
                            const Landmarks& landmarks, const Matching_options& options, bool several_starts)
{
  const Descriptors descriptors(X, Y, landmarks);
  const Eigen::Index last = (std::min)({options.modes, X.pairs.size(), Y.pairs.size()});
  const auto start = [&](double factor, double orientation, Eigen::Index modes) {
    const Eigen::Index k =
        (std::min)(static_cast<Eigen::Index>(factor * static_cast<double>(options.initial_modes)), modes);
    SG::Functional_map_weights weights = options.weights;
    weights.orientation *= orientation;
    return SG::zoom_out(SG::functional_map_of_descriptors(Y, X, descriptors.f_Y, descriptors.f_X, k, weights),
                        Y, X, modes, 2 * options.zoom_step, 1);
  };
  if(!several_starts)
    return SG::zoom_out(start(1, 1, (std::min)(last, options.initial_modes + 4)), Y, X, last,
                        options.zoom_step, options.threads);

  std::vector<std::pair<double, double>> settings;
  for(const double factor : {0.6, 1., 1.5})
    for(const double orientation : {1., 10., 100.})
      settings.emplace_back(factor, orientation);
  const Eigen::Index middle = (std::min)(last, Eigen::Index(50));
  std::vector<Eigen::MatrixXd> maps(settings.size());
  std::vector<double> scores(settings.size());
  const std::size_t threads = static_cast<std::size_t>(options.threads);
  std::vector<std::future<void>> workers;
  for(std::size_t w = 0; w < threads; ++w)
    workers.push_back(std::async(threads > 1 ? std::launch::async : std::launch::deferred, [&, w] {
      for(std::size_t i = w; i < settings.size(); i += threads) {
        maps[i] = start(settings[i].first, settings[i].second, middle);
        scores[i] = strangeness(maps[i], X, Y);
      }
    }));
  for(std::future<void>& worker : workers)
    worker.get();
  const auto best = std::min_element(scores.begin(), scores.end()) - scores.begin();
  return SG::zoom_out(maps[static_cast<std::size_t>(best)], Y, X, last, options.zoom_step, options.threads);
}

// Permutations of largest score under ever narrower kernels.
Eigen::MatrixXd filtered(Eigen::MatrixXd C, const SG::Spectral_shape& X, const SG::Spectral_shape& Y,
                         const Matching_options& options, const Keep_going& keep_going)
{
  // From a twentieth of the shape to the distance of neighbouring vertices.
  const double widest = 0.05 * 0.05 / 2, narrowest = 0.5 / static_cast<double>(X.op.B.rows()) / 2;
  for(int i = 0; i < options.filter_iterations; ++i) {
    if(!keep_going())
      throw SG::Cancelled();
    const double s = options.filter_iterations > 1 ? double(i) / (options.filter_iterations - 1) : 1.;
    const double time = widest * std::pow(narrowest / widest, s);
    const auto permutation = linear_assignment(SG::product_manifold_scores(C, Y, X, time));
    C = SG::functional_map_of_vertex_map(Y.pairs.vectors.leftCols(C.cols()),
                                         X.pairs.vectors.leftCols(C.rows()), X.op.B, permutation);
  }
  // Its bijection rounds to vertices, which costs the upper modes: up-sample once more.
  const Eigen::Index half = C.rows() / 2;
  return options.filter_iterations > 0 ? SG::zoom_out(C.topLeftCorner(half, half), Y, X, C.rows(),
                                                      2 * options.zoom_step, options.threads)
                                       : C;
}

// One step of ZoomOut between the levels, from the map C of fine Y to fine X to k modes: the vertices of the coarse X look
// for their images among all vertices of the fine Y, and the map from the fine Y to the coarse X is lifted as in
// section 5.2. No coarse face interpolates, and only as many points are searched as the proxy has vertices.
Eigen::MatrixXd refined_once(const Eigen::MatrixXd& C, const Shape& X, const Proxy& coarse_X, const Shape& Y,
                             Eigen::Index k, int threads)
{
  const Eigen::MatrixXd &phi = X.spectral.pairs.vectors, &psi = Y.spectral.pairs.vectors;
  const SG::Spectral_shape& coarse = coarse_X.shape.spectral;
  Eigen::MatrixXd at_representatives(coarse.op.B.rows(), C.rows());
  for(Eigen::Index i = 0; i < at_representatives.rows(); ++i)
    at_representatives.row(i) = phi.row(coarse_X.representative[static_cast<std::size_t>(i)]).head(C.rows());
  const std::vector<Eigen::Index> images = SG::target_to_source_map(C, psi, at_representatives, threads);
  const Eigen::MatrixXd coarse_phi = coarse.pairs.vectors.leftCols(k);
  const Eigen::MatrixXd to_coarse =
      SG::functional_map_of_vertex_map(psi.leftCols(k), coarse_phi, coarse.op.B, images);
  const Eigen::MatrixXd restriction =
      SG::functional_map(coarse_phi, coarse.op.B, coarse_X.restriction, phi.leftCols(k));
  return SG::lift_functional_map(Eigen::MatrixXd::Identity(k, k), to_coarse, restriction).C;
}

// From the smoother half of the modes of the lifted map to all of them. Both directions take part: where the shapes are not quite isometric,
// each is drawn its own way, and these errors are opposite.
Eigen::MatrixXd refined_between_levels(Eigen::MatrixXd C, const Shape& X, const Proxy& coarse_X,
                                       const Shape& Y, const Proxy& coarse_Y, const Matching_options& options)
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

void finish(Match& match, const Shape& X, const Shape& Y, const Matching_options& options)
{
  const SG::Spectral_shape &x = X.spectral, &y = Y.spectral;
  match.map = SG::target_to_source_map(match.C, y.pairs.vectors, x.pairs.vectors, options.threads);
  for(int i = 0; i < options.fine_iterations; ++i) {
    match.C = SG::functional_map_of_vertex_map(y.pairs.vectors.leftCols(match.C.cols()),
                                               x.pairs.vectors.leftCols(match.C.rows()), x.op.B, match.map);
    match.map = SG::target_to_source_map(match.C, y.pairs.vectors, x.pairs.vectors, options.threads);
  }
}

} // namespace

Match match_over_proxies(const Shape& X, const Proxy& coarse_X, const Shape& Y, const Proxy& coarse_Y,
                         const Landmarks& landmarks, const Matching_options& options,
                         const Keep_going& keep_going)
{
  Match match;
  const auto begin = std::chrono::steady_clock::now();
  Landmarks coarse_landmarks;
  for(const auto& [x, y] : landmarks)
    coarse_landmarks.emplace_back(coarse_X.vertex_map[static_cast<std::size_t>(x)],
                                  coarse_Y.vertex_map[static_cast<std::size_t>(y)]);
  const SG::Spectral_shape &x = coarse_X.shape.spectral, &y = coarse_Y.shape.spectral;
  Eigen::MatrixXd C = initial_map(x, y, coarse_landmarks, options, true);
  C = filtered(std::move(C), x, y, options, keep_going);
  match.seconds_coarse = seconds_since(begin);

  const auto middle = std::chrono::steady_clock::now();
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
  finish(match, X, Y, options);
  match.seconds_lift = seconds_since(middle);
  return match;
}

Match match_directly(const Shape& X, const Shape& Y, const Landmarks& landmarks,
                     const Matching_options& options, const Keep_going&)
{
  Match match;
  const auto begin = std::chrono::steady_clock::now();
  match.C = initial_map(X.spectral, Y.spectral, landmarks, options, false);
  finish(match, X, Y, options);
  match.seconds_coarse = seconds_since(begin);
  return match;
}
