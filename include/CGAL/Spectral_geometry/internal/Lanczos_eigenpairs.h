// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_LANCZOS_EIGENPAIRS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_LANCZOS_EIGENPAIRS_H

#include <CGAL/Spectral_geometry/internal/Cholesky.h>
#include <CGAL/Spectral_geometry/internal/Eigen_problem.h>
#include <CGAL/Spectral_geometry/internal/completeness.h>

#include <Eigen/Core>
#include <Spectra/SymGEigsShiftSolver.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

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

/// The reference solver: Spectra's implicitly restarted Lanczos method with shift and invert.
class Lanczos_eigenpairs
{
public:
  Lanczos_eigenpairs(const Eigen_problem& problem, double tolerance, Eigen::Index maximum_iterations)
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
    const auto find_missing = [this](const Ritz_pairs& known, Eigen::Index number) {
      Shift_inverse inverse(m_problem, m_cholesky, 3 * number + 40);
      inverse.deflate(known.vectors);
      return iterate(inverse, number);
    };
    return counting_is_meaningful(m_tolerance) && make_complete(m_problem, pairs, find_missing);
  }

private:
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
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_LANCZOS_EIGENPAIRS_H
