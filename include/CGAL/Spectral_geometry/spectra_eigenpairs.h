// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_SPECTRA_EIGENPAIRS_H
#define CGAL_SPECTRAL_GEOMETRY_SPECTRA_EIGENPAIRS_H

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/Cholesky.h>
#include <CGAL/Spectral_geometry/internal/completeness.h>
#include <CGAL/Spectral_geometry/internal/solve_eigen_problem.h>

#include <Eigen/Core>
#include <Spectra/SymGEigsShiftSolver.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

// Spectra's operators. Scaled to be without unit, since Spectra compares with absolute thresholds: the inner product is
// s B, the operator S = s (L + s B)^-1 B with eigenvalues s / (lambda + s) in ]0, 1], 1 for the kernel.
class Scaled_mass
{
public:
  using Scalar = double;

  explicit Scaled_mass(const Eigen_problem& problem)
    : m_problem(problem)
  {}
  Eigen::Index rows() const { return m_problem.size(); }
  Eigen::Index cols() const { return m_problem.size(); }
  void perform_op(const double* x, double* y) const
  {
    Eigen::Map<Eigen::VectorXd>(y, rows()).noalias() =
        m_problem.shift() * (m_problem.B() * Eigen::Map<const Eigen::VectorXd>(x, rows()));
  }

private:
  const Eigen_problem& m_problem;
};

class Shift_inverse
{
public:
  using Scalar = double;

  Shift_inverse(const Eigen_problem& problem, Cholesky& cholesky, Eigen::Index expected_solves)
    : m_problem(problem)
    , m_cholesky(cholesky)
    , m_expected_solves(expected_solves)
  {}
  Eigen::Index rows() const { return m_problem.size(); }
  Eigen::Index cols() const { return m_problem.size(); }
  void set_shift(double) {} // factorised beforehand

  // Restricts the operator to the B-orthogonal complement of known eigenvectors; none by default.
  void deflate(const Eigen::MatrixXd& known) { m_known = &known; }

  void perform_op(const double* x, double* y) const
  {
    const Eigen::Map<const Eigen::MatrixXd> rhs(x, rows(), 1);
    Eigen::Map<Eigen::MatrixXd> result(y, rows(), 1);
    m_cholesky.solve(rhs, result);
    if(m_known != nullptr) {
      const Eigen::VectorXd overlap = m_known->transpose() * (m_problem.B() * result);
      result.noalias() -= *m_known * overlap;
    }
    m_problem.report(0.9 * (std::min)(1., double(++m_solves) / double(m_expected_solves)));
  }

private:
  const Eigen_problem& m_problem;
  Cholesky& m_cholesky;
  const Eigen::MatrixXd* m_known = nullptr;
  Eigen::Index m_expected_solves;
  mutable Eigen::Index m_solves = 0;
};

class Spectra_solver
{
public:
  Spectra_solver(const Eigen_problem& problem, double tolerance, Eigen::Index maximum_iterations)
    : m_problem(problem)
    , m_tolerance(tolerance)
    , m_maximum_iterations(maximum_iterations)
    , m_cholesky(problem.shifted(-problem.shift()))
  {}

  Ritz_pairs compute(Eigen::Index K)
  {
    Shift_inverse inverse(m_problem, m_cholesky, 3 * K + 40);
    return iterate(inverse, K);
  }

  // Returns whether the pairs are proved to be the first ones, after having added those that were missing.
  bool complete(Ritz_pairs& pairs)
  {
    if(!counting_is_meaningful(m_tolerance))
      return false;
    // Each search from one vector finds at least one copy of each multiple eigenvalue.
    for(Eigen::Index attempt = 0; attempt <= pairs.values.size(); ++attempt) {
      m_problem.report(0.92);
      Eigen::Index missing;
      if(!count_missing(m_problem, pairs.values, missing))
        return false;
      if(missing == 0)
        return true;
      Shift_inverse inverse(m_problem, m_cholesky, 3 * missing + 40);
      inverse.deflate(pairs.vectors);
      pairs = merged(pairs, iterate(inverse, missing));
    }
    throw std::runtime_error(
        "Eigenpairs: copies of a multiple eigenvalue could not be found; lower the tolerance or solve "
        "the connected components one by one.");
  }

private:
  // The first ones of both, as many as `pairs` are.
  static Ritz_pairs merged(const Ritz_pairs& pairs, const Ritz_pairs& more)
  {
    const Eigen::Index K = pairs.values.size();
    Eigen::VectorXd values(K + more.values.size());
    values << pairs.values, more.values;
    std::vector<Eigen::Index> order(values.size());
    std::iota(order.begin(), order.end(), Eigen::Index(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](Eigen::Index i, Eigen::Index j) { return values(i) < values(j); });
    Ritz_pairs result = pairs;
    for(Eigen::Index k = 0; k < K; ++k) {
      const Eigen::Index from = order[k];
      result.values(k) = values(from);
      result.vectors.col(k) = from < K ? pairs.vectors.col(from) : more.vectors.col(from - K);
    }
    return result;
  }

  // A space that was too small for clustered eigenvalues is enlarged.
  Ritz_pairs iterate(Shift_inverse& inverse, Eigen::Index K)
  {
    using Solver = Spectra::SymGEigsShiftSolver<Shift_inverse, Scaled_mass, Spectra::GEigsMode::ShiftInvert>;
    const Eigen::Index n = m_problem.size();
    const double s = m_problem.shift();
    Scaled_mass mass(m_problem);
    Eigen::Index dimension = (std::min)(n, 2 * K + 20);
    for(int attempt = 0; attempt < 3; ++attempt) {
      Solver solver(inverse, mass, K, dimension, 0.);
      solver.init(); // from a fixed seed
      solver.compute(Spectra::SortRule::LargestMagn, m_maximum_iterations, m_tolerance,
                     Spectra::SortRule::SmallestAlge);
      if(solver.info() == Spectra::CompInfo::Successful) {
        // Spectra's eigenvalue is (lambda + s) / s
        const Eigen::VectorXd values = s * (solver.eigenvalues().array() - 1.);
        Ritz_pairs result{values.cwiseMax(0.), solver.eigenvectors(K)};
        result.vectors *= std::sqrt(s);
        return result;
      }
      if(dimension == n)
        break;
      dimension = (std::min)(n, 2 * dimension);
    }
    throw std::runtime_error("Eigenpairs: the Lanczos iteration did not converge to the tolerance for " +
                             std::to_string(K) +
                             " eigenpairs; raise the tolerance or the number of iterations.");
  }

  const Eigen_problem& m_problem;
  double m_tolerance;
  Eigen::Index m_maximum_iterations;
  Cholesky m_cholesky;
};

} // namespace internal

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief returns the pairs of `eigenpairs()` by Spectra's implicitly restarted Lanczos method, the independent reference.
///
/// It starts from one vector, with the shift and the factorisation of `eigenpairs()`, in a space of min(2 K + 20, n) vectors, and is
/// several times slower. Needs the headers of Spectra 1.0 (https://spectralib.org), which nothing else in this package does.
///
/// \param op       the operator
/// \param K        number of eigenpairs, 1 <= K < n; with the Dirichlet condition at most the number of vertices off the border
/// \param options  tolerance, number of restarts, progress. With `verify` the eigenvalues are counted in any case, as one start
///                 vector may miss each copy of a multiple one. The other members are of `eigenpairs()` and have to be left as they are.
///
/// \throws what `eigenpairs()` does, and std::invalid_argument for K = n and for a method, maximum_vectors or threads
inline Eigenpairs spectra_eigenpairs(const Laplace_operator& op, const Eigen::Index K,
                                     const Eigenpairs_options& options = {})
{
  if(options.method != Eigenpairs_method::automatic || options.maximum_vectors != 0 || options.threads != 1)
    throw std::invalid_argument(
        "spectra_eigenpairs: the options method, maximum_vectors and threads are those of "
        "eigenpairs(); leave them as they are.");
  return internal::solve_eigen_problem(
      op, K, options, [&](const internal::Eigen_problem& problem, Eigenpairs& result) {
        if(K == problem.size())
          throw std::invalid_argument("spectra_eigenpairs: K must be less than the number of vertices " +
                                      std::to_string(K) + "; ask for fewer or call eigenpairs().");
        internal::Spectra_solver solver(problem, options.tolerance, options.maximum_iterations);
        internal::Ritz_pairs pairs = solver.compute(K);
        result.complete = options.verify && solver.complete(pairs);
        result.solver = "spectra+" + internal::Cholesky::name();
        return pairs;
      });
}

/// @}

} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_SPECTRA_EIGENPAIRS_H
