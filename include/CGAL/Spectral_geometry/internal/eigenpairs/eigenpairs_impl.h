// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_EIGENPAIRS_IMPL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_EIGENPAIRS_IMPL_H

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/eigenpairs/Block_lanczos.h>
#include <CGAL/Spectral_geometry/internal/eigenpairs/Eigen_problem.h>
#include <CGAL/Spectral_geometry/internal/require.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <stdexcept>

namespace CGAL::Spectral_geometry {
namespace internal {

inline Eigenpairs dense_eigenpairs(const Eigen_problem& problem, Eigen::Index K)
{
  // In units of 1/shift: the solver compares with absolute thresholds.
  const double s = problem.shift();
  const Eigen::MatrixXd L = problem.L(), B = Eigen::MatrixXd(problem.B()) * s;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(L, B);
  if(solver.info() != Eigen::Success)
    throw std::runtime_error("Eigenpairs: the dense eigensolver did not converge.");
  Eigenpairs result;
  result.values = (s * solver.eigenvalues().head(K)).cwiseMax(0.);
  result.vectors = std::sqrt(s) * solver.eigenvectors().leftCols(K);
  result.solver = "dense";
  result.complete = true;
  return result;
}

inline void check_pencil(const Eigen::SparseMatrix<double>& matrix, const char* name)
{
  require(matrix.rows() == matrix.cols() && matrix.rows() != 0, "Eigenpairs: ", name, " is ",
          size_name(matrix), "; pass a square matrix.");
  const Eigen::SparseMatrix<double> transposed = matrix.transpose();
  const Eigen::SparseMatrix<double> difference = matrix - transposed;
  for(Eigen::Index j = 0; j < matrix.cols(); ++j) {
    const double size = matrix.col(j).norm();
    require(std::isfinite(size) && difference.col(j).norm() <= 1e-10 * size, "Eigenpairs: ", name,
            " is not symmetric and finite in row ", j, " (counted from 0); correct it.");
  }
}

} // namespace internal

CGAL_SPECTRAL_GEOMETRY_INLINE Eigenpairs eigenpairs(const Laplace_operator& op, Eigen::Index K,
                                                    const Eigenpairs_options& options)
{
  const internal::Eigen_problem problem(op, options.progress);
  problem.check(K);
  internal::check_eigenpairs_options(options, K);

  const Eigen::Index zeros = number_of_zero_eigenvalues(op);
  problem.report(0.);
  Eigenpairs result =
      internal::is_dense(problem.size(), K, options.method)
          ? internal::dense_eigenpairs(problem, K)
          : internal::Block_lanczos(problem, K, zeros <= internal::panel_width / 2, options).compute();
  internal::clear_uncoupled_rows(problem, result);
  internal::fix_signs(result.vectors);
  result.zeros = zeros;
  result.residuals = problem.residuals(result);
  problem.report(1.);
  return result;
}

CGAL_SPECTRAL_GEOMETRY_INLINE Eigenpairs eigenpairs(const Eigen::SparseMatrix<double>& L,
                                                    const Eigen::SparseMatrix<double>& B, Eigen::Index K,
                                                    const Eigenpairs_options& options)
{
  internal::check_pencil(L, "L");
  internal::check_pencil(B, "B");
  Laplace_operator op;
  op.L = L;
  op.B = B;
  op.mass = B * Eigen::VectorXd::Ones(B.cols());
  for(Eigen::Index v = 0; v < op.mass.size(); ++v)
    internal::require(op.mass[v] > 0., "Eigenpairs: the sum of row ", v,
                      " (counted from 0) of B is not positive; pass a mass matrix.");
  return eigenpairs(op, K, options);
}

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_EIGENPAIRS_IMPL_H
