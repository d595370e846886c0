// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_SPECTRA_EIGENPAIRS_H
#define SPECTRAL_TEST_SPECTRA_EIGENPAIRS_H

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/numerics/Eigen_problem.h>

#include <Eigen/Core>
#ifdef SPECTRAL_TEST_WITH_CHOLMOD
#include <Eigen/CholmodSupport>
#else
#include <Eigen/SparseCholesky>
#endif
#include <Spectra/SymGEigsShiftSolver.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

// The independent reference for eigenpairs(), in the tests and in the benchmark: Spectra's
// implicitly restarted Lanczos method.
namespace reference {

namespace SG = CGAL::Spectral_geometry;

// Spectra's operators, without unit, since Spectra compares with absolute thresholds: the inner
// product is s B, the operator S = s (L + s B)^-1 B with eigenvalues s / (lambda + s) in ]0, 1], 1
// for the kernel.
class Scaled_mass
{
public:
  using Scalar = double;

  explicit Scaled_mass(const SG::internal::Eigen_problem& problem)
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
  const SG::internal::Eigen_problem& m_problem;
};

class Shift_inverse
{
public:
  using Scalar = double;

  explicit Shift_inverse(const SG::internal::Eigen_problem& problem)
    : m_size(problem.size())
    , m_cholesky(problem.shifted(-problem.shift()))
  {}
  Eigen::Index rows() const { return m_size; }
  Eigen::Index cols() const { return m_size; }
  void set_shift(double) {} // factorised beforehand
  void perform_op(const double* x, double* y) const
  {
    Eigen::Map<Eigen::VectorXd>(y, m_size) =
        m_cholesky.solve(Eigen::Map<const Eigen::VectorXd>(x, m_size));
  }

private:
  Eigen::Index m_size;
#ifdef SPECTRAL_TEST_WITH_CHOLMOD
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>> m_cholesky;
#else
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> m_cholesky;
#endif
};

// K < n. It starts from one vector: copies of multiple eigenvalues can be missing.
inline SG::Eigenpairs spectra_eigenpairs(const SG::Laplace_operator& op, const Eigen::Index K,
                                         const double tolerance = 1e-10)
{
  const SG::internal::Eigen_problem problem(op);
  const double s = problem.shift();
  Shift_inverse inverse(problem);
  Scaled_mass mass(problem);
  Spectra::SymGEigsShiftSolver<Shift_inverse, Scaled_mass, Spectra::GEigsMode::ShiftInvert> solver(
      inverse, mass, K, (std::min)(problem.size(), 2 * K + 20), 0.);
  solver.init(); // from a fixed seed
  solver.compute(Spectra::SortRule::LargestMagn, 300, tolerance, Spectra::SortRule::SmallestAlge);
  if(solver.info() != Spectra::CompInfo::Successful)
    throw std::runtime_error("Spectra did not converge.");
  SG::Eigenpairs result;
  // Spectra's are (lambda + s) / s.
  result.values = (s * (solver.eigenvalues().array() - 1.)).max(0.);
  result.vectors = std::sqrt(s) * solver.eigenvectors(K);
  result.residuals = problem.residuals(result, 1);
  return result;
}

} // namespace reference

#endif // SPECTRAL_TEST_SPECTRA_EIGENPAIRS_H
