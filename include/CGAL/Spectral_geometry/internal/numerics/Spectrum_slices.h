// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_SPECTRUM_SLICES_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_SPECTRUM_SLICES_H

#include <CGAL/Spectral_geometry/Eigenpairs_options.h>
#include <CGAL/Spectral_geometry/internal/numerics/Block_lanczos.h>
#include <CGAL/Spectral_geometry/internal/numerics/Eigen_problem.h>

namespace CGAL::Spectral_geometry::internal {

/// Computes many pairs in slices of about 120, each with a shift among its values (spectrum
/// slicing: Grimes, Lewis and Simon 1994). A single Krylov space would be as large as all pairs,
/// and the cost of its projected problem cubic in their number.
///
/// A slice ends in the widest gap near its upper end. The next slice looks for exactly as many
/// values between this gap and its shift as the inertia counts. If a slice had missed a copy, the
/// next one would find a value below the gap.
class Spectrum_slices
{
public:
  Spectrum_slices(const Eigen_problem& problem, Index K, const Eigenpairs_options& options)
    : m_problem(problem)
    , m_options(options)
    , m_pairs{Eigen::VectorXd(K), Eigen::MatrixXd(problem.size(), K), {}, "block"}
    , m_part(problem.op(),
             {1,
              [this](const double fraction) {
                const double end = double((std::min)(m_found + size, m_pairs.size()));
                m_problem.report((fraction * end + (1. - fraction) * double(m_found)) /
                                 double(m_pairs.size()));
                return true;
              }},
             problem.scale())
    , m_lanczos(m_part, largest, options)
  {}

  /// Throws `Not_converged` if no shift serves for a slice, a slice has no end, or copies are
  /// missing.
  Eigenpairs compute()
  {
    while(m_found < m_pairs.size())
      add_slice();
    const Index missing =
        m_options.verify ? count_missing(m_problem, m_pairs.values, m_options.threads) : -1;
    if(missing > 0)
      throw Not_converged("copies of multiple eigenvalues are missing");
    m_pairs.complete = missing == 0;
    return std::move(m_pairs);
  }

private:
  void add_slice()
  {
    const Index left = m_pairs.size() - m_found, K = left <= largest ? left : size;
    int attempt = 0;
    while(!m_lanczos.find_next_to_shift(move_shift(K, attempt), K))
      if(++attempt == 4)
        throw Not_converged("no shift serves for a slice of the spectrum");
    const Eigenpairs slice = m_lanczos.pairs();
    if(!(slice.values(0) > m_end))
      throw Not_converged("copies of multiple eigenvalues are missing");
    m_spacing = (slice.values(K - 1) - m_end) / double(K);
    const Index kept = K == left ? K : widest_gap(slice.values);
    if(K != left)
      m_end = 0.5 * (slice.values(kept) + slice.values(kept - 1));
    append(slice, kept);
    m_pairs.further_values = slice.further_values; // those of the last slice stay
  }

  // Moves the shift until about half of K values are between the end of the last slice and it, and
  // returns how many.
  Index move_shift(const Index K, const int attempt)
  {
    double low = 0., high = std::numeric_limits<double>::infinity(); // distances from the end
    double distance = (0.5 + 0.03 * attempt) * double(K) * m_spacing;
    for(int i = 0; i < 20; ++i) {
      const Index count = m_lanczos.count_below(m_end + distance) - m_found;
      if(count >= 0 && count >= (i < 10 ? K / 4 : 0) && count <= (i < 10 ? K - K / 4 : K))
        return count;
      if(count < 0) { // next to an eigenvalue of a leading block
        distance += 0.1 * m_spacing;
        continue;
      }
      (2 * count < K ? low : high) = distance;
      distance *= (std::min)(4., 0.5 * double(K) / double((std::max)(count, Index(1))));
      if(!(distance > low && distance < high))
        distance = 0.5 * (low + high);
    }
    throw Not_converged("no shift serves for a slice of the spectrum");
  }

  // The values of the slice below the widest gap among its last ones.
  Index widest_gap(const Eigen::VectorXd& values) const
  {
    const Index K = values.size();
    for(const Index first : {K - K / 8, K / 2}) {
      Index kept = first;
      for(Index k = first; k < K; ++k)
        if(values(k) - values(k - 1) > values(kept) - values(kept - 1))
          kept = k;
      if(values(kept) - values(kept - 1) > 1e-3 * m_spacing)
        return kept;
    }
    throw Not_converged("a slice of the spectrum has no end");
  }

  // Removes what the tolerance has left of lower slices: it is large where a gap is narrow.
  void append(const Eigenpairs& slice, const Index kept)
  {
    const auto lower = m_pairs.vectors.leftCols(m_found);
    const Index width = 2 * panel_width;
    for_each_task((kept + width - 1) / width, m_options.threads, [&](const Index task) {
      const Index first = task * width, columns = (std::min)(width, kept - first);
      auto X = m_pairs.vectors.middleCols(m_found + first, columns);
      X = slice.vectors.middleCols(first, columns);
      const Eigen::MatrixXd BX = m_problem.B() * X;
      X -= lower * (lower.transpose() * BX);
    });
    auto X = m_pairs.vectors.middleCols(m_found, kept);
    const Eigen::MatrixXd Y = X, G = Y.transpose() * (m_problem.B() * Y);
    X = 1.5 * Y - 0.5 * (Y * G); // orthonormal in B, where it nearly was
    m_pairs.values.segment(m_found, kept) = slice.values.head(kept);
    m_found += kept;
  }

  static constexpr Index size = 128; // pairs of a slice
  static constexpr Index largest = 5 * size / 4;

  const Eigen_problem& m_problem;
  const Eigenpairs_options& m_options;
  Eigenpairs m_pairs; // the first m_found are known
  Index m_found = 0;
  double m_end = -m_problem.shift(), m_spacing = m_problem.shift(); // of the values found
  Eigen_problem m_part; // reports what a slice has done as a part of all
  Block_lanczos m_lanczos;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_SPECTRUM_SLICES_H
