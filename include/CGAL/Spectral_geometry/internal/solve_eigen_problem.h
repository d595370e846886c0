// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SOLVE_EIGEN_PROBLEM_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SOLVE_EIGEN_PROBLEM_H

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/Eigen_problem.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// What all solvers share: checks before, signs, zeros and residuals after. `solve(problem, result)` returns Ritz pairs and says in
/// the result by which solver and whether they are complete.
template <class Solve>
Eigenpairs solve_eigen_problem(const Laplace_operator& op, const Eigen::Index K,
                               const Eigenpairs_options& options, const Solve& solve)
{
  const Eigen_problem problem(op.L, op.B, op.mass, options.progress);
  problem.check(K, op.boundary == Boundary_condition::neumann);
  if(K > problem.size() - op.vanishing)
    throw std::invalid_argument("Eigenpairs: " + std::to_string(K) +
                                " eigenvectors are asked for, but only " +
                                std::to_string(problem.size() - op.vanishing) +
                                " vertices are off the border, where functions vanish; ask for fewer.");
  check_eigenpairs_options(options, K);
  problem.report(0.);
  Eigenpairs result;
  Ritz_pairs pairs = solve(problem, result);
  clear_uncoupled_rows(problem, pairs);
  fix_signs(pairs.vectors);
  result.zeros = number_of_zero_eigenvalues(op);
  result.residuals = problem.residuals(pairs.values, pairs.vectors);
  result.values = std::move(pairs.values);
  result.vectors = std::move(pairs.vectors);
  problem.report(1.);
  return result;
}

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SOLVE_EIGEN_PROBLEM_H
