// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_FITTED_OPERATOR_HELPERS_H
#define SPECTRAL_TEST_FITTED_OPERATOR_HELPERS_H

#include <CGAL/Spectral_toolbox/fitted_operators.h>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

namespace spectral_test {

// For each vertex of the graph of a matrix the one that stands for its component.
inline std::vector<Eigen::Index> components_of_graph(const Eigen::SparseMatrix<double>& A)
{
  std::vector<Eigen::Index> parent(static_cast<std::size_t>(A.cols()));
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](Eigen::Index v) {
    while(parent[v] != v)
      v = parent[v] = parent[parent[v]];
    return v;
  };
  for(Eigen::Index j = 0; j < A.cols(); ++j)
    for(Eigen::SparseMatrix<double>::InnerIterator it(A, j); it; ++it)
      parent[root(it.row())] = root(j);
  std::vector<Eigen::Index> result;
  for(Eigen::Index v = 0; v < A.cols(); ++v)
    result.push_back(root(v));
  return result;
}

// What must hold for whatever was fitted to replace `own`, by dense solves; empty if it does. Rows
// and columns are divided by the roots of the diagonal, which changes neither signs nor the number
// of zeros and keeps needles out of the rounding.
inline std::string fault_of_fit(const CGAL::Spectral_geometry::Operator_fit_result& result,
                                const CGAL::Spectral_geometry::Laplace_operator& own)
{
  const Eigen::MatrixXd L = result.op.L, B = result.op.B;
  if(!L.allFinite() || !B.allFinite() || !result.op.mass.allFinite())
    return "an entry is not a finite number";
  if(!(std::isfinite(result.objective_before) && result.objective_after >= 0. &&
       result.objective_after <= result.objective_before))
    return "the objective went from " + std::to_string(result.objective_before) + " to " +
           std::to_string(result.objective_after);
  const auto scaled = [](const Eigen::MatrixXd& A) -> Eigen::MatrixXd {
    const Eigen::VectorXd s = A.diagonal().cwiseSqrt().cwiseInverse();
    return s.asDiagonal() * A * s.asDiagonal();
  };
  if(!(L.diagonal().minCoeff() > 0.) || !(B.diagonal().minCoeff() > 0.))
    return "a diagonal entry is not positive";
  const Eigen::MatrixXd l = scaled(L), b = scaled(B);
  if((l - l.transpose()).norm() > 1e-13 * l.norm() || (b - b.transpose()).norm() > 1e-13 * b.norm())
    return "not symmetric";
  if(!((L.rowwise().sum().cwiseAbs() - 1e-12 * L.cwiseAbs().rowwise().sum()).maxCoeff() <= 0.))
    return "a row of L does not sum to zero";
  if(!((B.rowwise().sum() - result.op.mass).norm() <= 1e-13 * B.norm()))
    return "the masses are not the row sums of B";
  const std::vector<Eigen::Index> component = components_of_graph(own.L);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(own.mass.size()), after = before;
  for(Eigen::Index v = 0; v < own.mass.size(); ++v) {
    before(component[v]) += own.mass(v);
    after(component[v]) += result.op.mass(v);
  }
  Eigen::Index components = 0;
  for(Eigen::Index c = 0; c < before.size(); ++c) {
    components += before(c) > 0.;
    if(!(std::abs(after(c) - before(c)) <= 1e-12 * before(c)))
      return "the mass of a component is " + std::to_string(after(c) / before(c)) +
             " times what it was";
  }
  const auto eigenvalues = [](const Eigen::MatrixXd& A) -> Eigen::ArrayXd {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
  };
  const double rounding = 1e-14 * static_cast<double>(L.rows());
  const double smallest_mass = eigenvalues(b)(0);
  if(!(smallest_mass > rounding))
    return "the smallest eigenvalue of B is " + std::to_string(smallest_mass);
  const Eigen::ArrayXd modes = eigenvalues(l);
  if(!(modes(0) >= -rounding) || (modes <= rounding).count() != components)
    return "L has " + std::to_string((modes <= rounding).count()) + " zeros, the first is " +
           std::to_string(modes(0)) + ", and the graph " + std::to_string(components) +
           " components";
  return "";
}

} // namespace spectral_test

#endif // SPECTRAL_TEST_FITTED_OPERATOR_HELPERS_H
