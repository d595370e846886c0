// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Filtered noise against dense eigenvectors of small shapes, its Laplacian against a solve with B.

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/filtered_signals.h>
#include <CGAL/Spectral_geometry/operator_coefficients.h>

#include "catch.h"
#include "shapes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>

namespace test_filtered_signals {

using SG::Filtered_signals;
using SG::Laplace_operator;

namespace {

struct Case
{
  std::string name;
  Laplace_operator op;
};

Laplace_operator laplace(const shapes::Matrices& mesh,
                         const SG::Local_operator& op = SG::Mass::averaged)
{
  return SG::laplace_operator(mesh.V, mesh.T, op);
}

// Closed, with a border, in two components, with functions that vanish, with coefficients, in every
// mass: 162 to 324 vertices.
std::vector<Case> small_cases()
{
  const shapes::Matrices sphere = shapes::pebble_matrices(shapes::icosphere_matrices(2)),
                         grid = shapes::irregular_grid_matrices(15, 12);
  const Eigen::VectorXd density = (3. * sphere.V.col(0)).array().sin().exp();
  Eigen::MatrixXd D(sphere.V.rows(), 6);
  D.rowwise() = Eigen::RowVectorXd::Map(std::vector<double>{2., 0.3, 0., 1., 0.2, 0.5}.data(), 6);
  using SG::Boundary_condition;
  return {{"lumped", laplace(sphere, SG::Mass::lumped)},
          {"averaged", laplace(sphere)},
          {"consistent", laplace(sphere, 1.)},
          {"voronoi", laplace(sphere, SG::Mass::voronoi)},
          {"border", laplace(grid)},
          {"two components", laplace(shapes::components_matrices(sphere, 2))},
          {"Dirichlet", laplace(grid, {SG::Mass::averaged, {}, Boundary_condition::dirichlet})},
          {"Dirichlet, consistent",
           [&] {
             SG::Local_operator op(1.);
             op.boundary = Boundary_condition::dirichlet;
             return laplace(grid, op);
           }()},
          {"coefficients",
           laplace(sphere, {SG::Mass::averaged, SG::anisotropic_coefficients(D, density)})},
          {"a thousandth of the density",
           laplace(sphere, {SG::Mass::lumped, SG::anisotropic_coefficients(D, 1e-3 * density)})}};
}

Filtered_signals filtered(const Laplace_operator& op, Eigen::Index K, Eigen::Index signals = 16,
                          std::uint64_t seed = 1, int solves = 5, int threads = 1)
{
  SG::Filtered_signals_options options;
  options.signals = signals;
  options.seed = seed;
  options.solves = solves;
  options.threads = threads;
  return SG::filtered_signals(op, K, options);
}

SG::Eigenpairs all_pairs(const Laplace_operator& op)
{
  SG::Eigenpairs_options options;
  options.method = SG::Eigenpairs_method::dense;
  return SG::eigenpairs(op, op.L.rows() - op.vanishing, options);
}

} // namespace

TEST_CASE("Z of filtered signals is B^-1 L F")
{
  for(const Case& c : small_cases())
    for(const int solves : {3, 8, 16}) {
      INFO(c.name << ", " << solves << " solves");
      const Filtered_signals signals = filtered(c.op, 20, 11, 7, solves);
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> B(c.op.B);
      const Eigen::MatrixXd Z = B.solve(c.op.L * signals.F);
      CHECK(signals.F.cols() == 11);
      CHECK((signals.Z - Z).norm() < 1e-9 * Z.norm());
    }
}

TEST_CASE("Filtered noise has each eigenvector with the variance of the response", "[slow]")
{
  constexpr Eigen::Index r = 1500; // of two seeds
  for(const Case& c : small_cases()) {
    INFO(c.name);
    const SG::Eigenpairs pairs = all_pairs(c.op);
    const Filtered_signals one = filtered(c.op, 20, r, 1), other = filtered(c.op, 20, r, 2);
    REQUIRE(one.cutoff == other.cutoff);
    Eigen::MatrixXd C(pairs.size(), 2 * r);
    C << pairs.vectors.transpose() * (c.op.B * one.F),
        pairs.vectors.transpose() * (c.op.B * other.F);
    for(Eigen::Index k = 0; k < pairs.size(); ++k) {
      const double f = one.response(pairs.values[k]);
      C.row(k) = f == 0. ? C.row(k).eval() : (C.row(k) / (f / std::sqrt(double(r)))).eval();
    }
    // The mean of 2 r independent products deviates by 1 / sqrt(2 r), on the diagonal by sqrt(2)
    // times that at most. Modes that the filter takes away have lost digits.
    const Eigen::Index kept =
        std::count_if(pairs.values.begin(), pairs.values.end(),
                      [&](const double value) { return value < 4. * one.cutoff; });
    REQUIRE(kept >= 40);
    const Eigen::MatrixXd G = C.topRows(kept) * C.topRows(kept).transpose() / double(2 * r);
    const Eigen::MatrixXd error = G - Eigen::MatrixXd::Identity(kept, kept);
    const double deviation = 1. / std::sqrt(2. * r);
    CHECK(error.cwiseAbs().maxCoeff() < 6. * std::sqrt(2.) * deviation);
    CHECK(error.norm() < 1.2 * double(kept) * deviation);
    CHECK(error.norm() > 0.5 * double(kept) * deviation); // two seeds are two samples
    CHECK(C.rowwise().mean().cwiseAbs().head(kept).maxCoeff() < 6. * deviation);
  }
}

TEST_CASE("The cut-off of a filter has K eigenvalues below it, and says how many")
{
  for(const Case& c : small_cases()) {
    const SG::Eigenpairs pairs = all_pairs(c.op);
    for(const Eigen::Index K : {1, 2, 20, 60}) {
      INFO(c.name << ", K = " << K);
      const Filtered_signals signals = filtered(c.op, K);
      const Eigen::Index below =
          std::count_if(pairs.values.begin(), pairs.values.end(),
                        [&](const double value) { return value < signals.cutoff; });
      CHECK(signals.below == below);
      const Eigen::Index wanted = (std::max)(K, pairs.zeros + 1);
      // Else the wanted one lies at the cut-off.
      if(20 * std::abs(below - wanted) > wanted)
        CHECK(pairs.values[wanted - 1] == Approx(signals.cutoff).epsilon(0.06));
    }
  }
}

TEST_CASE("The cut-off of a filter is found beyond gaps of many powers of ten")
{
  shapes::Matrices flat = shapes::tetrahedron_matrices(), needles = shapes::icosphere_matrices(1);
  flat.V.col(0) *= 1e-6; // three low values far below the mean spacing, and one far above
  flat.V.col(2) *= 1e-6;
  flat.V.row(3) = flat.V.row(1);
  for(int f = 0; f < needles.T.rows(); ++f) // as many values far above the others
    if(needles.T(f, 0) < 5)
      needles.V.row(needles.T(f, 0)) =
          needles.V.row(needles.T(f, 1)) + 1e-6 * needles.V.row(needles.T(f, 0)).normalized();
  for(const auto& [mesh, K] : {std::pair(flat, 1), std::pair(needles, 40)})
    for(const SG::Mass mass : {SG::Mass::lumped, SG::Mass::averaged}) {
      const Laplace_operator op = laplace(mesh, mass);
      const Filtered_signals signals = filtered(op, K);
      const SG::Eigenpairs pairs = all_pairs(op);
      const Eigen::Index wanted = (std::max)(K, 2);
      CAPTURE(K, signals.below, signals.cutoff, pairs.values.transpose());
      CHECK(signals.below == (pairs.values.array() < signals.cutoff).count());
      CHECK(20 * std::abs(signals.below - wanted) <= wanted);
    }
}

TEST_CASE("Where rounding hides low eigenvalues from each other a filter passes all of them")
{
  shapes::Matrices mesh = shapes::grid_matrices(6, 3, 1e-11, 1.);
  mesh.V.row(7) << -2e-12, 0.27, 0.33;
  const Laplace_operator op = laplace(mesh);
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(
      Eigen::MatrixXd(op.L).cast<long double>(), Eigen::MatrixXd(op.B).cast<long double>(),
      Eigen::EigenvaluesOnly);
  for(const Eigen::Index K : {3, 4, 5, 6}) {
    const Filtered_signals signals = filtered(op, K);
    CAPTURE(K, signals.below, signals.cutoff);
    CHECK(signals.below == (solver.eigenvalues().array() < (long double)(signals.cutoff)).count());
    CHECK(signals.below >= K);
    CHECK(signals.F.allFinite());
    CHECK(signals.Z.allFinite());
  }
}

TEST_CASE("A filter passes what is below its cut-off, and the more solves the sharper")
{
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(2));
  double last = 2.;
  for(const int solves : {3, 4, 6, 8, 12, 16}) {
    const Filtered_signals signals = filtered(op, 20, 8, 1, solves);
    double error = 0., beyond = 0.; // the latter as E charges it
    for(double t = 0.005; t < 100.; t += 0.01) {
      const double f = signals.response(t * signals.cutoff);
      (t < 1. ? error : beyond) += 0.01 * (t < 1. ? (f - 1.) * (f - 1.) : f * f * t * t * t * t);
    }
    INFO(solves << " solves: " << error << " and " << beyond);
    CHECK(error + beyond < 0.9 * last);
    CHECK(beyond < 0.2);
    last = error + beyond;
  }
  CHECK(last < 0.2);
  const Filtered_signals signals = filtered(op, 20);
  CHECK(signals.response(1e6 * signals.cutoff) == Approx(0.).margin(1e-9));
}

TEST_CASE("Constants pass a filter, one for each component, and have no Laplacian")
{
  const shapes::Matrices sphere = shapes::bumpy_icosphere_matrices(2);
  const Laplace_operator op = laplace(shapes::components_matrices(sphere, 3));
  const Filtered_signals signals = filtered(op, 2); // fewer than components
  const Eigen::Index n = sphere.V.rows();
  const Eigen::MatrixXd in_weak_form = op.B * signals.Z, mass_of = op.mass.asDiagonal() * signals.F;
  for(int c = 0; c < 3; ++c) {
    CHECK(in_weak_form.middleRows(c * n, n).colwise().sum().cwiseAbs().maxCoeff() <
          1e-10 * in_weak_form.cwiseAbs().colwise().sum().maxCoeff());
    CHECK(mass_of.middleRows(c * n, n).colwise().sum().norm() > 0.);
  }
}

TEST_CASE("The cut-off comes to the first eigenvalue above the zeros, of however many components")
{
  const int copies = GENERATE(3, 19, 30, 60);
  const Laplace_operator op =
      laplace(shapes::components_matrices(shapes::bumpy_icosphere_matrices(1), copies));
  const Filtered_signals signals = filtered(op, copies / 3);
  // known to 5 %, from above or below
  CHECK(signals.cutoff > 0.95 * SG::eigenpairs(op, copies + 1).values[copies]);
}

TEST_CASE("Filtered signals vanish where the Dirichlet condition holds")
{
  const shapes::Matrices grid = shapes::irregular_grid_matrices(15, 12);
  for(const SG::Mass mass : {SG::Mass::lumped, SG::Mass::averaged}) {
    const Laplace_operator op = laplace(grid, {mass, {}, SG::Boundary_condition::dirichlet});
    const Filtered_signals signals = filtered(op, 20);
    Eigen::Index zero_rows = 0;
    for(Eigen::Index v = 0; v < op.L.rows(); ++v)
      zero_rows += signals.F.row(v).isZero(0.) && signals.Z.row(v).isZero(0.);
    CHECK(zero_rows == op.vanishing);
  }
}

TEST_CASE(
    "Filtered signals depend neither on threads nor, their first columns, on the number of signals")
{
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(4));
  const Filtered_signals one = filtered(op, 60, 20), two = filtered(op, 60, 20, 1, 5, 2);
  CHECK(one.F == two.F);
  CHECK(one.Z == two.Z);
  CHECK(one.cutoff == two.cutoff);
  const Filtered_signals few = filtered(op, 60, 5), another = filtered(op, 60, 5, 2);
  CHECK((few.F - 2. * one.F.leftCols(5)).norm() < 1e-12 * few.F.norm());
  CHECK((few.F - another.F).norm() > 0.5 * few.F.norm());
  for(Eigen::Index i = 0; i < 20; ++i)
    for(Eigen::Index j = 0; j < i; ++j)
      CHECK((one.F.col(i) - one.F.col(j)).norm() > 0.3 * one.F.col(i).norm());
}

TEST_CASE("Progress of filtered signals is reported in [0, 1] and can cancel")
{
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(2));
  std::vector<double> fractions;
  SG::Filtered_signals_options options;
  options.progress = [&](double fraction) { return fractions.push_back(fraction), true; };
  SG::filtered_signals(op, 20, options);
  CHECK(std::is_sorted(fractions.begin(), fractions.end()));
  CHECK(fractions.front() == 0.);
  CHECK(fractions.back() == 1.);
  CHECK(fractions.size() > 10);
  for(const double limit : {0., 0.1, 0.25, 0.7}) {
    options.progress = [limit](double fraction) { return fraction < limit; };
    CHECK_THROWS_AS(SG::filtered_signals(op, 20, options), SG::Cancelled);
  }
}

TEST_CASE("Bad requests for filtered signals are refused")
{
  const Laplace_operator op = laplace(shapes::icosphere_matrices(1));
  CHECK_THROWS_WITH(filtered(op, 43),
                    ContainsSubstring("between 1 and") && ContainsSubstring("43"));
  CHECK_THROWS_AS(filtered(op, 0), std::invalid_argument);
  CHECK_THROWS_WITH(filtered(op, 5, 0), ContainsSubstring("number of signals"));
  CHECK_THROWS_WITH(filtered(op, 5, 8, 1, 2), ContainsSubstring("between 3 and 32"));
  CHECK_THROWS_WITH(filtered(op, 5, 8, 1, 33), ContainsSubstring("between 3 and 32"));
  CHECK_THROWS_WITH(filtered(op, 5, 8, 1, 8, 0), ContainsSubstring("threads"));
  Laplace_operator broken = op;
  for(const auto& [i, j] : {std::pair(7, 3), std::pair(3, 7)})
    broken.B.coeffRef(i, j) += 2. * op.B.coeff(3, 3);
  for(const int i : {3, 7})
    broken.B.coeffRef(i, i) -= 2. * op.B.coeff(3, 3);
  CHECK_THROWS_WITH(filtered(broken, 5), ContainsSubstring("lump the mass matrix"));
  broken = op;
  broken.L *= -1.;
  CHECK_THROWS_AS(filtered(broken, 5), std::exception);
}

TEST_CASE("A mesh as small as its K can be filtered")
{
  for(const Eigen::Index K : {1, 3, 4}) {
    const Laplace_operator op = laplace(shapes::tetrahedron_matrices());
    const Filtered_signals signals = filtered(op, K, 3);
    CHECK(signals.F.allFinite());
    CHECK(signals.Z.allFinite());
    CHECK(signals.F.norm() > 0.);
  }
}

} // namespace test_filtered_signals
