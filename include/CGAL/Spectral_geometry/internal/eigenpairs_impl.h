// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_IMPL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_IMPL_H

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/Block_lanczos.h>
#include <CGAL/Spectral_geometry/internal/dense_eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/solve_eigen_problem.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace CGAL {
namespace Spectral_geometry {

CGAL_SPECTRAL_GEOMETRY_INLINE Eigenpairs eigenpairs(const Laplace_operator& op, Eigen::Index K,
                                                    const Eigenpairs_options& options)
{
  return internal::solve_eigen_problem(
      op, K, options, [&](const internal::Eigen_problem& problem, Eigenpairs& result) {
        if(internal::is_dense(problem.size(), K, options.method)) {
          result.solver = "dense";
          result.complete = true;
          return internal::dense_eigenpairs(problem, K);
        }
        result.solver = "block+" + internal::Cholesky::name();
        internal::Block_lanczos lanczos(problem, options.tolerance, options.maximum_iterations,
                                        options.maximum_vectors, options.threads);
        return lanczos.compute(K, options.verify, result.complete);
      });
}

namespace internal {

inline void check_pencil(const Eigen::SparseMatrix<double>& matrix, const char* name)
{
  if(matrix.rows() != matrix.cols() || matrix.rows() == 0)
    throw std::invalid_argument("Eigenpairs: " + std::string(name) + " is " + std::to_string(matrix.rows()) +
                                " x " + std::to_string(matrix.cols()) + "; pass a square matrix.");
  const Eigen::SparseMatrix<double> transposed = matrix.transpose();
  const Eigen::SparseMatrix<double> difference = matrix - transposed;
  for(Eigen::Index j = 0; j < matrix.cols(); ++j) {
    const double size = matrix.col(j).norm();
    if(!std::isfinite(size) || !(difference.col(j).norm() <= 1e-10 * size))
      throw std::invalid_argument("Eigenpairs: " + std::string(name) +
                                  " is not symmetric and finite in row " + std::to_string(j) +
                                  " (counted from 0); correct it.");
  }
}

} // namespace internal

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
    if(!(op.mass[v] > 0.))
      throw std::invalid_argument("Eigenpairs: the sum of row " + std::to_string(v) +
                                  " (counted from 0) of B is not positive; pass a mass matrix.");
  return eigenpairs(op, K, options);
}

} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_IMPL_H
