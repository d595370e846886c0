// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_FILTERED_SIGNALS_H
#define CGAL_SPECTRAL_GEOMETRY_FILTERED_SIGNALS_H

#include <CGAL/Spectral_geometry/Run_control.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/separate_compilation.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief how `filtered_signals()` computes.
struct Filtered_signals_options : Run_control
{
  Eigen::Index signals = 16; ///< r, at least 1; computed eight at a time
  std::uint64_t seed = 1;    ///< of the noise
  /// m, solves with the factor for eight signals, from 3 to 32; the more, the sharper the filter
  int solves = 5;
};

/// \brief random functions on a mesh in which eigenvectors have the weights \f$f(\lambda_k)\f$.
struct Filtered_signals
{
  Eigen::MatrixXd F; ///< n x r, \f$F = r^{-1/2} \sum_k f(\lambda_k) \phi_k \xi_k^T\f$
  Eigen::MatrixXd Z; ///< n x r, \f$Z = B^{-1} L F\f$
  double cutoff = 0; ///< \f$\lambda_K\f$, above which f falls off, in the unit of eigenvalues
  /// number of eigenvalues below `cutoff`: K to 5 %, unless eigenvalues coincide there
  Eigen::Index below = 0;
  double shift = 0;             ///< s
  Eigen::VectorXd coefficients; ///< \f$a_0 \dots a_{m-2}\f$

  /// \f$f(\lambda)\f$
  CGAL_SPECTRAL_GEOMETRY_INLINE double response(double lambda) const;
};

/// \brief returns random functions without high frequencies: mixtures of about the first K
/// eigenvectors, without computing these.
///
/// White noise w has \f$\mathrm{E}[w w^T] = B^{-1}\f$, so that its coefficients
/// \f$\xi_k = \phi_k^T B w\f$ are uncorrelated and have the variance 1. A filter multiplies them by
/// \f$f(\lambda_k)\f$, a polynomial in \f$x = s / (\lambda + s)\f$, which are the eigenvalues of
/// \f$X = s (L + s B)^{-1} B\f$:
/// \f[ f(\lambda) = x^2 q(x), \qquad q(x) = \sum_{j=0}^{m-2} a_j T_j(2x - 1) \f]
/// with Chebyshev polynomials \f$T_j\f$. One factorisation of \f$L + s B\f$ and m solves with it,
/// in the recurrence of \f$T_j\f$, give \f$Y = X q(X) w\f$ and \f$F = X Y\f$. From
/// \f$\lambda x = s (1 - x)\f$ follows \f$Z = B^{-1} L F = s (Y - F)\f$ without a solve.
///
/// The filter takes the noise as B w, whose covariance is B. With
/// \f[ B = \sum_{i<j} B_{ij} (e_i + e_j)(e_i + e_j)^T
///       + \sum_i \Bigl(B_{ii} - \sum_{j \ne i} B_{ij}\Bigr) e_i e_i^T \f]
/// B w is the sum of these vectors, each times the root of its factor and a random sign.
///
/// The coefficients minimise the squared distance of f to 1 below \f$\lambda_K\f$ and to 0 above,
/// there with the weight \f$(\lambda/\lambda_K)^4\f$, as the metric E charges a mode. Eigenvalues
/// are taken as evenly spaced (Weyl's law). At the cut-off \f$\lambda_K\f$ the matrix \f$L -
/// \lambda_K B\f$ has K negative eigenvalues, to 5 %. The signs of pivots count them (Sylvester's
/// law of inertia), since borders, components and coefficients change Weyl's constant. If K is not
/// larger than the number of components, the cut-off is that of a few eigenvalues more than these.
/// Constants pass the filter; their part of Z is 0.
///
/// E is a sum of squares \f$\|A F\|^2\f$ with a linear A. Its expectation is the E of eigenvectors
/// with weights f, and its relative variance is at most 2/r (Hutchinson 1989; Tremblay et al. 2016
/// sample graphs in this way). With another number of `signals` the first columns change only by
/// the factor \f$r^{-1/2}\f$.
///
/// \param op       the operator; rows of B are diagonally dominant, as with linear elements.
///                 With the Dirichlet condition F is 0 at the vertices of the border.
/// \param K        1 <= K <= n; with the Dirichlet condition at most the number of other vertices
/// \param options  signals, seed, sharpness, threads, progress
///
/// \throws std::invalid_argument when K or an option is out of range, or where a row of B is not
///         dominant, which is named;
///         std::runtime_error when the factorisation fails;
///         Cancelled when it is cancelled
CGAL_SPECTRAL_GEOMETRY_INLINE Filtered_signals filtered_signals(
    const Laplace_operator& op, Eigen::Index K, const Filtered_signals_options& options = {});

/// @}

} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_GEOMETRY_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_GEOMETRY)

#include <CGAL/Spectral_geometry/internal/numerics/Eigen_problem.h>
#include <CGAL/Spectral_geometry/internal/numerics/Panel_space.h>
#include <CGAL/Spectral_geometry/internal/numerics/Supernodal_factor.h>

#include <Eigen/Cholesky>

namespace CGAL::Spectral_geometry {
namespace internal {

/// The polynomial of the filter, in x = s / (lambda + s).
struct Low_pass
{
  // T_j(2x - 1), j = 0 .. count - 1
  static Eigen::VectorXd chebyshev(double x, Index count)
  {
    Eigen::VectorXd T(count);
    const double y = 2. * x - 1.;
    for(Index j = 0; j < count; ++j)
      T[j] = j == 0 ? 1. : j == 1 ? y : 2. * y * T[j - 1] - T[j - 2];
    return T;
  }

  // Fits f = x^2 q(x) to 1 for t = lambda / lambda_K below 1 and to 0 above, x = rho / (t + rho),
  // in the measure dt, which by Weyl's law is that of the eigenvalues. Above 1 errors count
  // t^4-fold, as E charges a mode; t ends at 1000.
  static Eigen::VectorXd fit(int solves)
  {
    const Index count = solves - 1;
    constexpr int samples = 4000;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(count);
    for(int i = 0; i < samples; ++i) {
      const double x = (i + 0.5) / samples, t = rho * (1. - x) / x, dt = rho / (x * x);
      if(t > 1000.)
        continue;
      const Eigen::VectorXd h = x * x * chebyshev(x, count);
      A += (t <= 1. ? dt : dt * t * t * t * t) * h * h.transpose();
      if(t <= 1.)
        b += dt * h;
    }
    return A.ldlt().solve(b);
  }

  static constexpr double rho = 2.; // s / lambda_K
};

/// Random signs for the vectors that B is a sum of: eight of them, those of one panel, for a pair
/// of vertices.
class Signs
{
public:
  Signs(std::uint64_t seed, Index panel)
    : m_key(mixed(mixed(seed) + std::uint64_t(panel / 8)))
    , m_shift(int(panel % 8) * 8)
  {
    for(int byte = 0; byte < 256; ++byte)
      for(int c = 0; c < panel_width; ++c)
        m_rows[byte][c] = (byte >> c & 1) != 0 ? 1. : -1.;
  }

  const double* operator()(int u, int v) const
  {
    const auto [low, high] = std::minmax({std::uint64_t(u), std::uint64_t(v)});
    return m_rows[mixed(m_key ^ (high << 32 | low)) >> m_shift & 255];
  }

private:
  // The step of SplitMix64 (Steele, Lea and Flood 2014).
  static std::uint64_t mixed(std::uint64_t z)
  {
    z += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::uint64_t m_key;
  int m_shift;
  double m_rows[256][panel_width];
};

/// Counts eigenvalues, then filters noise, with one structure of the factor for both.
class Noise_filter
{
public:
  Noise_filter(const Laplace_operator& op, const Eigen_problem& problem, Index K,
               const Filtered_signals_options& options)
    : m_op(op)
    , m_problem(problem)
    , m_options(options)
    , m_cutoff((std::max)(double(K) * problem.shift(), problem.rounding_of_values()))
    , m_factor(problem.shifted(m_cutoff), options.threads,
               Supernodal_factor::Pivots::of_either_sign)
    , m_panels((options.signals + panel_width - 1) / panel_width)
  {}

  Filtered_signals compute(Index K)
  {
    Filtered_signals result;
    result.below = find_cutoff(K);
    result.cutoff = m_cutoff;
    result.shift = Low_pass::rho * m_cutoff;
    result.coefficients = Low_pass::fit(m_options.solves);
    m_problem.report(0.2);
    m_factor.factorise(m_problem.shifted(-result.shift), m_options.threads);
    if(m_factor.number_of_negative_pivots() != 0)
      throw Not_positive_definite();
    filter(result);
    return result;
  }

private:
  // --- the cut-off ---

  // Moves the cut-off until K eigenvalues are below it, to 5 %, or it is known to 5 %. Returns
  // their number. Two equal counts reveal a gap, which beside needles spans twelve powers of ten.
  Index find_cutoff(Index K)
  {
    double lower = m_problem.rounding_of_values(), upper = std::numeric_limits<double>::infinity();
    Index last = -1;
    for(int attempt = 0; attempt < 64; ++attempt) {
      if(attempt > 0)
        m_factor.factorise(m_problem.shifted(m_cutoff), m_options.threads);
      m_problem.report(0.1);
      const Index below = m_factor.number_of_negative_pivots();
      if(below < 0) { // next to an eigenvalue of a leading block
        m_cutoff *= 1.01;
        continue;
      }
      (below < K ? lower : upper) = m_cutoff;
      if(20 * std::abs(below - K) <= K || upper < 1.05 * lower)
        return below;
      const double factor = double(K) / (std::max)(0.5, double(below));
      const bool in_gap = below == last;
      last = below;
      m_cutoff *= in_gap && below < K ? 8. : (std::min)(8., (std::max)(1. / 8., factor));
      if(std::isfinite(upper) && (in_gap || !(m_cutoff > lower && m_cutoff < upper)))
        m_cutoff = std::sqrt(lower * upper);
    }
    throw std::runtime_error(
        "Filtered signals: eigenvalues of the Laplacian cannot be counted; look for needle "
        "faces or coordinates of very different magnitude in the mesh.");
  }

  // --- the noise ---

  // The roots of the factors with which B is a sum of squares, of pairs and of vertices. Rows
  // without couplings whose own eigenvalue is beyond the cut-off get no noise: functions vanish
  // there.
  void split_mass()
  {
    m_roots = permuted(m_op.B, m_factor.order());
    m_rest = Eigen::VectorXd::Zero(m_problem.size());
    for(Index i = 0; i < m_problem.size(); ++i) {
      const int v = m_factor.order()[i];
      double rest = 0., diagonal = 0.;
      for(Sparse_matrix::InnerIterator it(m_roots, i); it; ++it) {
        rest += it.row() == i ? it.value() : -std::abs(it.value());
        if(it.row() == i)
          diagonal = it.value();
        it.valueRef() =
            it.row() == i ? 0. : std::copysign(std::sqrt(std::abs(it.value())), it.value());
      }
      const bool coupled = m_op.L.col(v).nonZeros() > 1 || m_op.B.col(v).nonZeros() > 1;
      if(coupled || m_op.L.coeff(v, v) <= m_cutoff * diagonal)
        m_rest[i] = std::sqrt((std::max)(0., rest));
    }
  }

  // b = factor B w / sqrt(r), eight columns.
  void make_noise(Index panel, double factor, Panel& b) const
  {
    using Row = Eigen::Array<double, panel_width, 1>;
    const Signs signs(m_options.seed, panel);
    factor /= std::sqrt(double(m_options.signals));
    for_each_range([&](Index first, Index last) {
      for(Index i = first; i < last; ++i) {
        const int v = m_factor.order()[i];
        Row sum = m_rest[i] * Row::Map(signs(v, v));
        for(Sparse_matrix::InnerIterator it(m_roots, i); it; ++it) {
          // One end of a pair of negative mass has the other sign.
          const int u = m_factor.order()[it.row()];
          const double root = u > v ? it.value() : std::abs(it.value());
          sum += root * Row::Map(signs(u, v));
        }
        Row::Map(b.row(i)) = factor * sum;
      }
    });
  }

  // --- the filter ---

  void filter(Filtered_signals& result)
  {
    split_mass();
    const Index n = m_problem.size(), r = m_options.signals;
    const double s = result.shift;
    const Eigen::VectorXd& a = result.coefficients;
    const Panel_space space(s * permuted(m_op.B, m_factor.order()), m_options.threads);
    Panel last(n), before(n), y(n), x(n);
    result.F.resize(n, r);
    result.Z.resize(n, r);
    for(Index panel = 0; panel < m_panels; ++panel) {
      int solved = 0;
      const auto solve = [&](const Panel& rhs, Panel& solution) { // may be one panel
        m_factor.solve(rhs, solution, m_options.threads);
        const double done = double(panel * m_options.solves + ++solved);
        m_problem.report(0.3 + 0.7 * done / double(m_panels * m_options.solves));
      };
      // last = T_j X w, before = T_{j-1} X w, y = their sum so far
      make_noise(panel, s, x);
      solve(x, last);
      for_each_range(
          [&](Index first, Index end) { rows(y, first, end) = a[0] * rows(last, first, end); });
      for(Index j = 1; j < a.size(); ++j) {
        space.multiply_mass(last, x);
        solve(x, x);
        for_each_range([&](Index first, Index end) {
          auto next = rows(before, first, end);
          if(j == 1)
            next = 2. * rows(x, first, end) - rows(last, first, end);
          else
            next = 4. * rows(x, first, end) - 2. * rows(last, first, end) - next;
          rows(y, first, end) += a[j] * next;
        });
        std::swap(last, before);
      }
      space.multiply_mass(y, x);
      solve(x, x);
      for_each_range([&](Index first, Index end) {
        const Index column = panel * panel_width,
                    columns = (std::min)(Index(panel_width), r - column);
        for(Index i = first; i < end; ++i)
          for(Index c = 0; c < columns; ++c) {
            const int v = m_factor.order()[i];
            result.F(v, column + c) = x.row(i)[c];
            result.Z(v, column + c) = s * (y.row(i)[c] - x.row(i)[c]);
          }
      });
    }
  }

  static Eigen::Map<Eigen::ArrayXd> rows(Panel& panel, Index first, Index end)
  {
    return {panel.row(first), (end - first) * panel_width};
  }

  template <class Function>
  void for_each_range(const Function& f) const
  {
    internal::for_each_range(m_problem.size(), 1024, m_options.threads, f);
  }

  const Laplace_operator& m_op;
  const Eigen_problem& m_problem;
  const Filtered_signals_options& m_options;
  double m_cutoff;
  Supernodal_factor m_factor;
  Index m_panels;
  Sparse_matrix m_roots;
  Eigen::VectorXd m_rest;
};

// Checks that the mass is a sum of squares of pairs and vertices.
inline void check_dominance(const Sparse_matrix& B)
{
  const Eigen::VectorXd rest = dominance(B);
  for(Index i = 0; i < B.cols(); ++i)
    require(
        rest[i] >= -1e-9 * B.coeff(i, i), "Filtered signals: in row ", i,
        " (counted from 0) of B the other entries exceed the diagonal one; lump the mass matrix.");
}

inline void check_filtered_signals_options(const Filtered_signals_options& options)
{
  require(options.signals >= 1, "Filtered signals: the number of signals must be positive, but is ",
          options.signals, ".");
  require(options.solves >= 3 && options.solves <= 32,
          "Filtered signals: the number of solves must lie between 3 and 32, but is ",
          options.solves, ".");
  require(options.threads >= 1, "Filtered signals: the number of threads must be positive.");
}

} // namespace internal

double Filtered_signals::response(double lambda) const
{
  const double x = shift / (lambda + shift);
  return x * x * coefficients.dot(internal::Low_pass::chebyshev(x, coefficients.size()));
}

Filtered_signals filtered_signals(const Laplace_operator& op, Eigen::Index K,
                                  const Filtered_signals_options& options)
{
  internal::check_filtered_signals_options(options);
  const internal::Eigen_problem problem(op, options);
  problem.check(K);
  internal::check_dominance(op.B);
  problem.report(0.);
  // Constants alone have no scale; with many of them the tolerance of the count exceeds one.
  const Eigen::Index zeros = number_of_zero_eigenvalues(op);
  const Eigen::Index counted =
      (std::min)((std::max)(K, zeros + 1 + zeros / 19), problem.size() - op.vanishing);
  Filtered_signals result = internal::Noise_filter(op, problem, counted, options).compute(counted);
  problem.report(1.);
  return result;
}

} // namespace CGAL::Spectral_geometry

#endif // definitions

#endif // CGAL_SPECTRAL_GEOMETRY_FILTERED_SIGNALS_H
