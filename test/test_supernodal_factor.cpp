// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The sparse factorisation beside Eigen's.

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/numerics/Supernodal_factor.h>

#include "catch.h"
#include "shapes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace test_supernodal_factor {

using Sparse = Eigen::SparseMatrix<double>;
using SG::internal::Panel;
using SG::internal::Supernodal_factor;

namespace {

Sparse positive_definite(const shapes::Matrices& mesh)
{
  const SG::Laplace_operator op = SG::laplace_operator(mesh.V, mesh.T, 0.5);
  return op.L + op.B;
}

// Columns of b in the order of A, by way of a panel.
Eigen::MatrixXd solve_panel(Supernodal_factor& factor, const Eigen::MatrixXd& b, int threads)
{
  Panel panel(b.rows());
  for(Eigen::Index i = 0; i < b.rows(); ++i)
    for(int c = 0; c < 8; ++c)
      panel.row(i)[c] = b(factor.order()[i], c);
  factor.solve(panel, panel, threads);
  Eigen::MatrixXd x(b.rows(), 8);
  for(Eigen::Index i = 0; i < b.rows(); ++i)
    for(int c = 0; c < 8; ++c)
      x(factor.order()[i], c) = panel.row(i)[c];
  return x;
}

// A pattern without geometry: some rows have many entries, others none but the diagonal.
Sparse random_matrix(int n, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> index(0, n - 1);
  std::uniform_real_distribution<double> value(-1., 1.);
  std::vector<Eigen::Triplet<double>> entries;
  for(int k = 0; k < 2 * n; ++k) {
    const int i = k % 5 == 0 ? 0 : index(random), j = index(random);
    const double x = value(random);
    entries.emplace_back(i, j, x);
    entries.emplace_back(j, i, x);
  }
  for(int i = 0; i < n; ++i)
    entries.emplace_back(i, i, 0.1);
  Sparse A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

} // namespace

TEST_CASE("Solves agree with Eigen's factorisation, for vectors and panels, and for any number of "
          "threads")
{
  std::vector<Sparse> matrices = {
      positive_definite(shapes::bumpy_icosphere_matrices(4)),
      positive_definite(shapes::irregular_grid_matrices(60, 70)),
      positive_definite(shapes::components_matrices(shapes::icosphere_matrices(2), 3)),
      positive_definite(shapes::icosphere_matrices(0))};
  for(const int n : {1, 2, 9, 300}) { // not meshes
    const Sparse R = random_matrix(n, n);
    matrices.push_back(Sparse(R * R.transpose()));
    matrices.back().diagonal().array() += 1.;
  }
  matrices.push_back(
      Sparse(Eigen::VectorXd::LinSpaced(600, 1., 2.).asDiagonal())); // nothing but roots
  for(const Sparse& A : matrices) {
    const Eigen::MatrixXd b = Eigen::MatrixXd::Random(A.rows(), 8);
    const Eigen::SimplicialLLT<Sparse> reference(A);
    const Eigen::MatrixXd expected = reference.solve(b);
    Supernodal_factor factor(A, 1);
    const Eigen::MatrixXd x = solve_panel(factor, b, 1);
    CHECK((x - expected).norm() < 1e-10 * expected.norm());
    const Eigen::VectorXd y = factor.solve(Eigen::VectorXd(b.col(3)), 1);
    CHECK((y - expected.col(3)).norm() < 1e-10 * expected.col(3).norm());
    CHECK(factor.number_of_negative_pivots() == 0);
    Supernodal_factor same(A, 3);
    CHECK(solve_panel(same, b, 3) == x);
    CHECK(same.solve(Eigen::VectorXd(b.col(3)), 2) == y);
  }
}

TEST_CASE("Other numbers in the same places, of which the lower triangle is read")
{
  const Sparse A = positive_definite(shapes::bumpy_icosphere_matrices(4));
  Supernodal_factor factor(A);
  const Sparse lower = Sparse(2. * A).triangularView<Eigen::Lower>();
  Supernodal_factor of_lower(Sparse(A.triangularView<Eigen::Lower>()));
  of_lower.factorise(lower, 2);
  factor.factorise(2. * A, 1);
  const Eigen::VectorXd b = Eigen::VectorXd::Random(A.rows());
  const Eigen::VectorXd x = factor.solve(b, 1);
  CHECK((2. * (A * x) - b).norm() < 1e-10 * b.norm());
  CHECK((of_lower.solve(b, 1) - x).norm() < 1e-12 * x.norm());
}

TEST_CASE("Negative eigenvalues are counted, and a matrix that has some is refused")
{
  const auto count = [](const Sparse& A) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(Eigen::MatrixXd(A),
                                                                Eigen::EigenvaluesOnly);
    return (solver.eigenvalues().array() < 0.).count();
  };
  const shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(3);
  const SG::Laplace_operator op = SG::laplace_operator(mesh.V, mesh.T, 0.5);
  for(const double shift : {0.5, 3., 40., 400.}) {
    const Sparse A = op.L - shift * op.B;
    CHECK(SG::internal::number_of_negative_eigenvalues(A) == count(A));
    Supernodal_factor factor(A, 3, Supernodal_factor::Pivots::of_either_sign);
    CHECK(factor.number_of_negative_pivots() == count(A));
    const Eigen::VectorXd b = Eigen::VectorXd::Random(A.rows());
    CHECK((A * factor.solve(b, 2) - b).norm() < 1e-9 * b.norm());
    const Eigen::MatrixXd panel = Eigen::MatrixXd::Random(A.rows(), 8);
    CHECK((A * solve_panel(factor, panel, 2) - panel).norm() < 1e-9 * panel.norm());
    CHECK_THROWS_WITH(Supernodal_factor(A), ContainsSubstring("needle"));
  }
  for(const unsigned seed : {1u, 2u, 3u}) {
    const Sparse A = random_matrix(120, seed);
    CHECK(SG::internal::number_of_negative_eigenvalues(A) == count(A));
  }
  Sparse zero(3, 3);
  zero.insert(0, 0) = 1.;
  zero.insert(1, 1) = 0.;
  zero.insert(2, 2) = -1.;
  zero.makeCompressed();
  CHECK(SG::internal::number_of_negative_eigenvalues(zero) == -1);
  Sparse positive = zero;
  positive.coeffs() = 2.;
  Supernodal_factor factor(positive);
  CHECK_THROWS_AS(factor.factorise(zero, 1), SG::internal::Not_positive_definite);
  factor.factorise(positive, 1); // none the worse for it
  CHECK((factor.solve(Eigen::VectorXd::Ones(3), 1) - Eigen::VectorXd::Constant(3, 0.5)).norm() <
        1e-15);
  zero.coeffRef(1, 1) = std::nan("");
  CHECK_THROWS_AS(Supernodal_factor(zero), std::runtime_error);
}

} // namespace test_supernodal_factor
