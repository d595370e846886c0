// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_EIGENPAIRS_H
#define CGAL_SPECTRAL_GEOMETRY_EIGENPAIRS_H

#include <CGAL/Spectral_geometry/Cancelled.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/Eigen_problem.h>
#include <CGAL/Spectral_geometry/internal/Lanczos_eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/dense_eigenpairs.h>

#include <Eigen/Core>

#include <functional>
#include <stdexcept>
#include <string>

namespace CGAL {
namespace Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief the first K eigenpairs of \f$L \phi = \lambda B \phi\f$.
struct Eigenpairs
{
  Eigen::VectorXd values;  ///< K, ascending, not negative (what rounding leaves of the kernel's is cut at 0)
  Eigen::MatrixXd vectors; ///< n x K, column k belongs to values(k), \f$\Phi^T B \Phi = I\f$
  Eigen::VectorXd
      residuals; ///< K, \f$\|L \phi_k - \lambda_k B \phi_k\|_{M^{-1}} / (\lambda_k + s)\f$, see `eigenpairs()`
  std::string solver; ///< "spectra+cholmod", "spectra+simplicial" or "dense"
  /// true when an inertia count (or a dense solve) has proved that no eigenvalue below values(K-1) is missing
  bool complete = false;

  Eigen::Index size() const { return values.size(); } ///< K
};

/// \brief how `eigenpairs()` computes. The defaults are for tight pairs.
struct Eigenpairs_options
{
  /// relative accuracy in the shift-inverted operator, \f$\|S\phi - \nu\phi\|_B \le\f$ tolerance \f$\nu\f$ with
  /// \f$S = (L + s B)^{-1} B\f$, \f$\nu = 1/(\lambda + s)\f$; in ]0, 1[
  double tolerance = 1e-10;
  /// restarts of the Krylov space, at least 1
  Eigen::Index maximum_iterations = 300;
  /// count the eigenvalues with one more factorisation and search for those that a Krylov space started from one
  /// vector may have missed: copies of multiple eigenvalues
  bool verify = true;
  /// is called with the fraction done, in [0, 1]; returns false to cancel
  std::function<bool(double)> progress;
};

/// \brief returns the first K generalised eigenpairs of a Laplace operator, \f$L \phi_k = \lambda_k B \phi_k\f$.
///
/// Shift and invert: \f$(L + s B)^{-1} B \phi = \nu \phi\f$, \f$\lambda = 1/\nu - s\f$, by an implicitly restarted Lanczos
/// method (Spectra) with a Cholesky factorisation of \f$L + s B\f$: CHOLMOD's where `CGAL_SPECTRAL_WITH_CHOLMOD` is
/// defined (link with `-lcholmod`), otherwise Eigen's. The shift \f$s = 4\pi/\f$area is the mean spacing of the
/// eigenvalues by Weyl's law: the matrix is positive definite, its condition number stays that of the wanted spectrum, and the
/// eigenvalues next to 0 are separated as well as with a smaller one. Small problems (n at most 300, or K close to
/// n) are solved densely. The start vector is fixed, so the result is the same in every run.
///
/// Eigenvectors are orthonormal in B. Signs: the first entry (in vertex order) that is larger in magnitude than 0.618
/// times the largest one is positive. Within an eigenspace of several dimensions the basis is arbitrary.
///
/// \param op       the operator; eigenvalues are in the inverse of its unit of area
/// \param K        number of eigenpairs, 1 <= K <= n
/// \param options  tolerance, limits, progress
///
/// \throws std::invalid_argument when K or an option is out of range or L, B differ in size;
///         std::runtime_error when the factorisation or the iteration fails;
///         Cancelled when the progress callback returned false
inline Eigenpairs eigenpairs(const Laplace_operator& op, Eigen::Index K,
                             const Eigenpairs_options& options = {})
{
  const internal::Eigen_problem problem(op.L, op.B, op.mass, options.progress);
  problem.check(K, options.tolerance, options.maximum_iterations);

  internal::Ritz_pairs pairs;
  Eigenpairs result;
  problem.report(0.);
  if(internal::dense_is_better(problem.size(), K)) {
    pairs = internal::dense_eigenpairs(problem, K);
    result.solver = "dense";
    result.complete = true;
  } else {
    internal::Lanczos_eigenpairs lanczos(problem, options.tolerance, options.maximum_iterations);
    pairs = lanczos.compute(K);
    result.complete = options.verify && lanczos.complete(pairs);
    result.solver = "spectra+" + internal::Cholesky::name();
  }
  internal::fix_signs(pairs.vectors);
  result.residuals = problem.residuals(pairs);
  result.values = std::move(pairs.values);
  result.vectors = std::move(pairs.vectors);
  problem.report(1.);
  return result;
}

/// @}

} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_EIGENPAIRS_H
