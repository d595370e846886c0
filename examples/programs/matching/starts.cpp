// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "starts.h"

#include <CGAL/Spectral_geometry/Run_control.h>
#include <CGAL/Spectral_toolbox/spectral_distances.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <future>
#include <limits>
#include <utility>
#include <vector>

namespace SG = CGAL::Spectral_geometry;

namespace {

// Signatures of both shapes at the same times and energies, and heat that spreads from landmarks.
class Descriptors
{
public:
  Descriptors(const SG::Spectral_shape& X, const SG::Spectral_shape& Y, const Landmarks& landmarks)
  {
    const Eigen::Index steps = 20, spreads = 4;
    const Eigen::VectorXd times = SG::heat_kernel_times(X.pairs, steps);
    const SG::Wave_kernel_energies energies = SG::wave_kernel_energies(X.pairs, steps);
    const Eigen::VectorXd spreading =
        SG::heat_kernel_times(X.pairs, spreads + 2).segment(1, spreads);
    const auto compute = [&](const SG::Spectral_shape& shape,
                             const std::vector<Eigen::Index>& sources) {
      const Eigen::Index marks = static_cast<Eigen::Index>(sources.size());
      Eigen::MatrixXd result(shape.op.B.rows(), 2 * steps + spreads * marks);
      result.leftCols(steps) = SG::heat_kernel_signature(shape.pairs, times);
      result.middleCols(steps, steps) = SG::wave_kernel_signature(shape.pairs, energies);
      for(Eigen::Index t = 0; t < spreads && marks > 0; ++t)
        result.middleCols(2 * steps + t * marks, marks) =
            SG::heat_kernel(shape.pairs, sources, spreading(t));
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

struct Start
{
  Eigen::MatrixXd C;
  double strangeness = 0;
};

// Calls f(i) for i below n.
template <class Function>
void for_each_index(std::size_t n, int threads, const Keep_going& keep_going, const Function& f)
{
  std::vector<std::future<void>> workers;
  for(std::size_t w = 0; w < static_cast<std::size_t>(threads); ++w)
    workers.push_back(std::async(threads > 1 ? std::launch::async : std::launch::deferred, [&, w] {
      for(std::size_t i = w; i < n && keep_going(); i += static_cast<std::size_t>(threads))
        f(i);
    }));
  for(std::future<void>& worker : workers)
    worker.get();
  if(!keep_going())
    throw SG::Cancelled();
}

// The least strange ones, of several that are nearly the same the first.
void keep_best(std::vector<Start>& starts, std::size_t count, double nearly_same)
{
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.strangeness < b.strangeness; });
  std::vector<Start> kept;
  for(Start& s : starts) {
    if(kept.size() == count)
      break;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Start& k) {
      return (k.C - s.C).norm() < nearly_same * k.C.norm();
    });
    if(!known)
      kept.push_back(std::move(s));
  }
  starts = std::move(kept);
}

class Starts
{
public:
  Starts(const SG::Spectral_shape& X, const SG::Spectral_shape& Y, const Matching_options& options,
         const Keep_going& keep_going)
    : m_X(X)
    , m_Y(Y)
    , m_options(options)
    , m_keep_going(keep_going)
    , m_last((std::min)({options.modes, X.pairs.size(), Y.pairs.size()}))
  {}

  Eigen::Index last_mode() const { return m_last; }

  Eigen::MatrixXd of_descriptors(const Descriptors& descriptors, double factor, double orientation,
                                 Eigen::Index modes) const
  {
    const Eigen::Index k = (std::min)(
        static_cast<Eigen::Index>(factor * static_cast<double>(m_options.initial_modes)), modes);
    SG::Functional_map_weights weights = m_options.weights;
    weights.orientation *= orientation;
    return SG::zoom_out(
        SG::functional_map_of_descriptors(m_Y, m_X, descriptors.f_Y, descriptors.f_X, k, weights),
        m_Y, m_X, modes, 2 * m_options.zoom_step);
  }

  std::vector<Start> of_descriptors(const Descriptors& descriptors, Eigen::Index modes) const
  {
    std::vector<std::pair<double, double>> settings;
    for(const double factor : {0.6, 1., 1.5})
      for(const double orientation : {1., 10., 100.})
        settings.emplace_back(factor, orientation);
    std::vector<Start> result(settings.size());
    for_each_index(result.size(), m_options.threads, m_keep_going, [&](std::size_t i) {
      result[i] = judged(of_descriptors(descriptors, settings[i].first, settings[i].second, modes));
    });
    return result;
  }

  // A tree of maps as in MapTree (Ren, Melzi, Ovsjanikov, Wonka 2020). From the constants on, each
  // map of k modes is continued by the next mode with either sign, and by the next two exchanged;
  // each is made the map of points once and judged. Descriptors have one opinion of what a limb of
  // Y is; this has all, and leaves the choice to what comes of them.
  std::vector<Start> grown(Eigen::Index modes) const
  {
    constexpr std::size_t width = 24;
    const Eigen::Index leaf = (std::min)(Eigen::Index(9), modes);
    std::vector<std::vector<Start>> level(static_cast<std::size_t>(leaf) +
                                          1); // by the number of modes
    level[1].push_back({Eigen::MatrixXd::Identity(1, 1), 0.});
    for(Eigen::Index k = 1; k < leaf; ++k) {
      std::vector<Start>& present = level[static_cast<std::size_t>(k)];
      keep_best(present, width, 0.15);
      std::vector<Eigen::MatrixXd> children;
      for(const Start& start : present)
        for(const double sign : {1., -1.}) {
          children.push_back(extended(start.C, Eigen::MatrixXd::Constant(1, 1, sign)));
          if(k + 2 <= leaf)
            for(const double other : {1., -1.})
              children.push_back(extended(start.C, Eigen::Matrix2d{{0., sign}, {other, 0.}}));
        }
      for(Start& start : up_sampled(children, 0, 1))
        level[static_cast<std::size_t>(start.C.rows())].push_back(std::move(start));
    }
    std::vector<Start> result =
        continued(std::move(level.back()), width, (std::min)(Eigen::Index(20), modes), 4);
    return continued(std::move(result), 8, modes, 8);
  }

private:
  Start judged(Eigen::MatrixXd C) const
  {
    const double s = strangeness(C, m_X, m_Y);
    return {std::move(C), std::isfinite(s) ? s : (std::numeric_limits<double>::max)()};
  }

  static Eigen::MatrixXd extended(const Eigen::MatrixXd& C, const Eigen::MatrixXd& corner)
  {
    const Eigen::Index k = C.rows(), more = corner.rows();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(k + more, k + more);
    result.topLeftCorner(k, k) = C;
    result.bottomRightCorner(more, more) = corner;
    return result;
  }

  // Up to `last` modes, or as many as the map has.
  std::vector<Start> up_sampled(const std::vector<Eigen::MatrixXd>& maps, Eigen::Index last,
                                Eigen::Index step) const
  {
    std::vector<Start> result(maps.size());
    for_each_index(maps.size(), m_options.threads, m_keep_going, [&](std::size_t i) {
      result[i] = judged(SG::zoom_out(maps[i], m_Y, m_X, (std::max)(last, maps[i].rows()), step));
    });
    return result;
  }

  // The best `count` with more modes.
  std::vector<Start> continued(std::vector<Start> starts, std::size_t count, Eigen::Index modes,
                               Eigen::Index step) const
  {
    keep_best(starts, count, 0.15);
    std::vector<Eigen::MatrixXd> maps;
    for(Start& start : starts)
      maps.push_back(std::move(start.C));
    return up_sampled(maps, modes, step);
  }

  const SG::Spectral_shape &m_X, &m_Y;
  const Matching_options& m_options;
  Keep_going m_keep_going;
  Eigen::Index m_last;
};

} // namespace

double strangeness(const Eigen::MatrixXd& C, const SG::Spectral_shape& X,
                   const SG::Spectral_shape& Y)
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
  const Eigen::Index functions = (std::min)(Eigen::Index(6), k - 1);
  const Eigen::MatrixXd phi = X.pairs.vectors.leftCols(k), psi = Y.pairs.vectors.leftCols(k);
  for(Eigen::Index i = 1; i <= functions; ++i) {
    const Eigen::MatrixXd first = C * SG::orientation_operator(Y.T, psi, psi.col(i)),
                          second = SG::orientation_operator(X.T, phi, phi * C.col(i)) * C;
    const double norms = first.norm() * second.norm() * static_cast<double>(functions);
    orientation += norms > 0 ? (first.array() * second.array()).sum() / norms : 0.;
  }
  return orthonormality + commutativity - orientation;
}

Eigen::MatrixXd map_of_descriptors(const SG::Spectral_shape& X, const SG::Spectral_shape& Y,
                                   const Landmarks& landmarks, const Matching_options& options,
                                   const Keep_going& keep_going)
{
  const Starts starts(X, Y, options, keep_going);
  const Eigen::Index last = starts.last_mode();
  return SG::zoom_out(starts.of_descriptors(Descriptors(X, Y, landmarks), 1., 1.,
                                            (std::min)(last, options.initial_modes + 4)),
                      Y, X, last, options.zoom_step, {options.threads});
}

Eigen::MatrixXd map_of_many_starts(const SG::Spectral_shape& X, const SG::Spectral_shape& Y,
                                   const Landmarks& landmarks, const Matching_options& options,
                                   const Keep_going& keep_going)
{
  const Starts starts(X, Y, options, keep_going);
  const Eigen::Index middle = (std::min)(starts.last_mode(), Eigen::Index(50));
  std::vector<Start> all = starts.of_descriptors(Descriptors(X, Y, landmarks), middle);
  if(landmarks.empty())
    for(Start& start : starts.grown(middle))
      all.push_back(std::move(start));
  keep_best(all, 1, 0.);
  return SG::zoom_out(all.front().C, Y, X, starts.last_mode(), options.zoom_step,
                      {options.threads});
}
