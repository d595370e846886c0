// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_DENSE_EIGENPAIRS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_DENSE_EIGENPAIRS_H

#include <CGAL/Spectral_geometry/internal/eigenpairs/Eigen_problem.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <stdexcept>

namespace CGAL::Spectral_geometry::internal {

inline Ritz_pairs dense_eigenpairs(const Eigen_problem& problem, Eigen::Index K)
{
  // In units of 1/shift: the solver compares with absolute thresholds.
  const double s = problem.shift();
  const Eigen::MatrixXd L = problem.L(), B = Eigen::MatrixXd(problem.B()) * s;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(L, B);
  if(solver.info() != Eigen::Success)
    throw std::runtime_error("Eigenpairs: the dense eigensolver did not converge.");
  return {(s * solver.eigenvalues().head(K)).cwiseMax(0.), std::sqrt(s) * solver.eigenvectors().leftCols(K)};
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_DENSE_EIGENPAIRS_H
