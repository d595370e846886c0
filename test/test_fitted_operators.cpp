// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Fitted operators: alone, and after the one call.

#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_geometry/operator_coefficients.h>
#include <CGAL/Spectral_toolbox/fit_operators_of_run.h>
#include <CGAL/Spectral_toolbox/fitted_operators.h>
#include <CGAL/Spectral_toolbox/vertex_maps.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include "catch.h"
#include "collapse_helpers.h"
#include "fitted_operator_helpers.h"
#include "shapes.h"
#include "spectral_test_helpers.h"

#include <Eigen/Eigenvalues>

namespace test_fitted_operators {

using namespace spectral_test;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using SG::Eigenpairs;
using SG::Laplace_operator;
using SG::Operator_fit_options;
using SMS::Spectral_edge_collapse_options;
using Result = SMS::Spectral_edge_collapse_result;
using Sparse = Eigen::SparseMatrix<double>;

namespace {

using Mass_pattern = Operator_fit_options::Mass_pattern;

struct Problem
{
  Laplace_operator coarse, fine;
  Sparse P;
  Eigenpairs pairs;
};

Sparse identity(Index n)
{
  Sparse I(n, n);
  I.setIdentity();
  return I;
}

// The vertices of a coarse icosphere are the first of its subdivision; so are those of the bumpy
// one.
Problem nested(int subdivisions, Index K, double scale = 1., double theta = 0.5)
{
  const auto laplace = [&](int s) {
    shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(s);
    return SG::laplace_operator(scale * mesh.V, mesh.T, theta);
  };
  Problem p;
  p.coarse = laplace(subdivisions);
  p.fine = laplace(subdivisions + 1);
  p.P = identity(p.fine.L.rows()).topRows(p.coarse.L.rows());
  p.pairs = SG::eigenpairs(p.fine, K);
  return p;
}

SG::Operator_fit_result fit(const Problem& p, const Operator_fit_options& options = {})
{
  return SG::fit_operators(p.coarse, p.P, p.fine, p.pairs, options);
}

Problem of_itself(const Laplace_operator& op, Index K)
{
  return {op, op, identity(op.L.rows()), SG::eigenpairs(op, K)};
}

SG::Spectral_evaluation judge(const Problem& p, const Laplace_operator& op)
{
  return SG::evaluate_spectrum(p.fine, p.pairs, op, SG::eigenpairs(op, p.pairs.size()), p.P,
                               p.pairs.size());
}

double difference(const Sparse& A, const Sparse& B)
{
  return Sparse(A - B).norm() / B.norm();
}

void check_definite(const SG::Operator_fit_result& result, const Laplace_operator& own,
                    Index components)
{
  CHECK(fault_of_fit(result, own) == "");
  const std::vector<Index> roots = components_of_graph(own.L);
  CHECK(std::set<Index>(roots.begin(), roots.end()).size() == std::size_t(components));
  CHECK(SG::number_of_zero_eigenvalues(result.op) == components);
}

} // namespace

TEST_CASE("Operators that are right already stay as they are")
{
  const shapes::Matrices mesh = shapes::icosphere_matrices(2); // all weights positive
  const Laplace_operator op = SG::laplace_operator(mesh.V, mesh.T, 0.5);
  REQUIRE((MatrixXd(op.L) - MatrixXd(MatrixXd(op.L).diagonal().asDiagonal())).maxCoeff() <= 0.);
  const Problem p = of_itself(op, 60);
  const auto result = fit(p);
  CHECK(difference(result.op.L, op.L) < 1e-9);
  CHECK(difference(result.op.B, op.B) < 1e-9);

  // A mesh with obtuse angles: the other sides of its triangles make up for the negative weights.
  const shapes::Matrices grid = wavy_grid_matrices(14, 9);
  const Laplace_operator obtuse = SG::laplace_operator(grid.V, grid.T, 0.5);
  const MatrixXd L = obtuse.L;
  REQUIRE((L - MatrixXd(L.diagonal().asDiagonal())).maxCoeff() > 0.);
  Operator_fit_options none;
  none.maximum_iterations = 0;
  CHECK(difference(fit(of_itself(obtuse, 60), none).op.L, obtuse.L) <
        1e-3); // bounds lift weights next to 0
}

TEST_CASE("Wrong entries are put right when P is the identity")
{
  const shapes::Matrices mesh = shapes::icosphere_matrices(2);
  const Mass_pattern pattern = GENERATE(Mass_pattern::edges, Mass_pattern::diagonal);
  const double theta = pattern == Mass_pattern::edges ? 0.5 : 0.;
  const Laplace_operator op = SG::laplace_operator(mesh.V, mesh.T, theta);
  Problem p = of_itself(op, 100);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> factor(0.7, 1.3);
  for(Index j = 0; j < p.coarse.L.cols(); ++j)
    for(Sparse::InnerIterator it(p.coarse.L, j); it; ++it)
      it.valueRef() *= 1. + 0.3 * std::sin(double(it.row() + j));
  for(Index v = 0; v < p.coarse.mass.size(); ++v)
    p.coarse.B.coeffRef(v, v) *= factor(random);
  p.coarse.B *= op.mass.sum() / p.coarse.B.sum();
  p.coarse.mass = p.coarse.B * VectorXd::Ones(p.coarse.B.cols());
  REQUIRE(difference(p.coarse.L, op.L) > 0.1);

  Operator_fit_options options;
  options.mass = pattern;
  options.regularization = 1e-6;
  options.tolerance = 1e-3;
  options.maximum_iterations = 60;
  const auto result = fit(p, options);
  CHECK(difference(result.op.L, op.L) < 1e-3);
  CHECK(difference(result.op.B, op.B) < 1e-3);
}

TEST_CASE("Fitted operators keep the spectrum better than the mesh's own")
{
  const Problem p = nested(2, 30);
  const auto own = judge(p, p.coarse);
  Operator_fit_options one_ring;
  one_ring.rings = 1;
  const auto edges = judge(p, fit(p, one_ring).op), two_rings = judge(p, fit(p).op);
  for(const auto& e : {edges, two_rings}) {
    CHECK(e.norm_L < 0.5 * own.norm_L);
    CHECK(e.norm_D < own.norm_D);
    CHECK(e.errors.mean < 0.5 * own.errors.mean);
  }
  CHECK(two_rings.norm_L < edges.norm_L);
  CHECK(two_rings.norm_D < 0.8 * edges.norm_D);

  const shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(2);
  Problem lumped = p;
  lumped.coarse = SG::laplace_operator(mesh.V, mesh.T, 0.);
  Operator_fit_options options;
  options.mass = Mass_pattern::diagonal;
  options.rings = 1;
  const auto own_lumped = judge(lumped, lumped.coarse),
             diagonal = judge(lumped, fit(lumped, options).op);
  CHECK(diagonal.norm_L < 0.5 * own_lumped.norm_L);
  options.rings = 2;
  const auto result = fit(lumped, options);
  CHECK(result.op.B.nonZeros() == mesh.V.rows());
  CHECK(judge(lumped, result.op).norm_L < 0.5 * diagonal.norm_L);
}

TEST_CASE("The fit depends neither on the unit of length nor on the order of the vertices",
          "[fitted_operators]")
{
  Operator_fit_options options;
  options.rings = GENERATE(1, 2);
  const Problem p = nested(2, 40);
  const auto result = fit(p, options);
  REQUIRE(difference(result.op.L, p.coarse.L) > 0.01);

  const double scale = 37.;
  const auto scaled = fit(nested(2, 40, scale), options);
  CHECK(difference(scaled.op.L, result.op.L) < 1e-6);
  CHECK(difference(scaled.op.B / (scale * scale), result.op.B) < 1e-6);

  std::vector<int> order(p.coarse.L.rows());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  Eigen::PermutationMatrix<Eigen::Dynamic> Q(static_cast<Index>(order.size()));
  for(std::size_t i = 0; i < order.size(); ++i)
    Q.indices()(static_cast<Index>(i)) = order[i];
  Problem q = p;
  q.coarse.L = Q * p.coarse.L * Q.transpose();
  q.coarse.B = Q * p.coarse.B * Q.transpose();
  q.coarse.mass = Q * p.coarse.mass;
  q.P = Q * p.P;
  const auto permuted = fit(q, options);
  CHECK(difference(Sparse(Q.transpose() * permuted.op.L * Q), result.op.L) < 1e-6);
  CHECK(difference(Sparse(Q.transpose() * permuted.op.B * Q), result.op.B) < 1e-6);
}

TEST_CASE("The fit does not depend on the number of threads", "[slow]")
{
  const Problem p = nested(4, 20); // rows enough for several ranges
  Operator_fit_options options;
  options.maximum_iterations = 3;
  const auto one = fit(p, options);
  options.threads = 3;
  const auto three = fit(p, options);
  CHECK(one.objective_after < one.objective_before);
  CHECK(difference(three.op.L, one.op.L) == 0.);
  CHECK(difference(three.op.B, one.op.B) == 0.);
}

TEST_CASE("Fitted operators are definite on hostile meshes", "[slow]")
{
  Operator_fit_options options;
  options.rings = GENERATE(1, 2);
  options.mass = GENERATE(Mass_pattern::edges, Mass_pattern::diagonal);
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  // Signals that have nothing to do with the mesh push hardest.
  const auto random_pairs = [&](Index n, Index K) {
    Eigenpairs pairs;
    pairs.values = VectorXd::LinSpaced(K, 0., 1000.);
    pairs.vectors = MatrixXd::NullaryExpr(n, K, [&] { return normal(random); });
    return pairs;
  };
  const auto check = [&](const shapes::Matrices& mesh, Index K, Index components) {
    const Laplace_operator op = SG::laplace_operator(mesh.V, mesh.T, 0.5);
    Problem p = of_itself(op, K);
    check_definite(fit(p, options), op, components);
    p.pairs = random_pairs(op.L.rows(), K);
    check_definite(fit(p, options), op, components);
  };
  SECTION("border")
  {
    check(wavy_grid_matrices(9, 7), 20, 1);
  }
  SECTION("as many signals as vertices, less one")
  {
    check(shapes::tetrahedron_matrices(), 3, 1);
    check(shapes::icosphere_matrices(1), 41, 1);
  }
  SECTION("one signal, which is constant")
  {
    check(shapes::icosphere_matrices(1), 1, 1);
  }
  SECTION("components")
  {
    check(shapes::components_matrices(shapes::icosphere_matrices(1), 3), 30, 3);
  }
  SECTION("fans, whose centres have hundreds of unknowns in their rows")
  {
    check(shapes::gear_matrices(150, 2), 20, 1);
  }
  SECTION("needles")
  {
    shapes::Matrices mesh = shapes::icosphere_matrices(2);
    for(Index v = 0; v < mesh.V.rows(); v += 9)
      mesh.V.row(v) = mesh.V.row(mesh.T(v, 0)) + 1e-7 * mesh.V.row(v);
    check(mesh, 30, 1);
    mesh.V.col(2) *= 1e-5;
    check(mesh, 30, 1);
  }
}

TEST_CASE("A vertex of little mass that P reads elsewhere is not cut off")
{
  // A vertex in a corner of a face, with a thousandth of its area: the hoof of an animal, an eye.
  const Problem p = nested(2, 40);
  shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(2);
  const Index v = mesh.V.rows(), n = p.fine.L.rows();
  const Eigen::RowVector3i face = mesh.T.row(0);
  mesh.V.conservativeResize(v + 1, 3);
  mesh.V.row(v) = 0.94 * mesh.V.row(face(0)) + 0.03 * (mesh.V.row(face(1)) + mesh.V.row(face(2)));
  mesh.T.conservativeResize(mesh.T.rows() + 2, 3);
  for(int i = 0; i < 3; ++i) {
    Eigen::RowVector3i part = face;
    part(i) = static_cast<int>(v);
    mesh.T.row(i == 0 ? 0 : mesh.T.rows() - i) = part;
  }
  Problem q = p;
  q.coarse = SG::laplace_operator(mesh.V, mesh.T, 0.5);
  q.P = Sparse(v + 1, n);
  q.P.reserve(Eigen::VectorXi::Constant(n, 2));
  for(Index i = 0; i < v; ++i)
    q.P.insert(i, i) = 1.;
  q.P.insert(v, 100) = 1.; // on the other side
  q.P.makeCompressed();
  for(const auto mass : {Mass_pattern::edges, Mass_pattern::diagonal}) {
    Operator_fit_options options;
    options.mass = mass;
    const Laplace_operator fitted = fit(q, options).op;
    const auto own_mode = [&](const Laplace_operator& op) { return op.L.coeff(v, v) / op.mass(v); };
    CHECK(own_mode(q.coarse) > 8. * p.pairs.values.maxCoeff());
    CHECK(own_mode(fitted) > 2. * p.pairs.values.maxCoeff());
  }
}

TEST_CASE("Where vertices are many P is taken as it is")
{
  // The own mode of every vertex lies far above ten eigenvalues.
  const Problem p = nested(3, 10);
  const VectorXd mode = p.coarse.L.diagonal().cwiseQuotient(p.coarse.mass);
  REQUIRE((mode.array() > 8. * p.pairs.values.maxCoeff()).count() > mode.size() / 2);
  CHECK(judge(p, fit(p).op).norm_L < 0.75 * judge(p, p.coarse).norm_L);
}

TEST_CASE("Edges of next to no weight do not make up for negative ones")
{
  const shapes::Matrices grid = wavy_grid_matrices(9, 7);
  Problem p = of_itself(SG::laplace_operator(grid.V, grid.T, 0.5), 20);
  for(Index j = 0; j < p.coarse.L.cols(); ++j)
    for(Sparse::InnerIterator it(p.coarse.L, j); it; ++it)
      if(it.value() < 0. && (it.row() + j) % 2 == 0)
        it.valueRef() = -1e-30;
  check_definite(fit(p), p.coarse, 1);
}

TEST_CASE("Two rings stay linear in the degree of a vertex, and fit all the same",
          "[fitted_operators]")
{
  const shapes::Matrices gear = shapes::gear_matrices(500, 3);
  Problem p = of_itself(SG::laplace_operator(gear.V, gear.T, 0.5), 20);
  // Lumped, to the spectrum of the averaged mass.
  p.coarse = SG::laplace_operator(gear.V, gear.T, 0.);
  Operator_fit_options options;
  options.rings = 2;
  options.mass = Mass_pattern::diagonal;
  const SG::Operator_fit_result result = fit(p, options);
  CHECK(result.op.L.nonZeros() < 30 * gear.V.rows()); // a row of the centre would have 250,000
  CHECK(result.unknowns < 10 * gear.V.rows());
  CHECK(result.converged);
  CHECK(result.objective_after < 0.5 * result.objective_before);
}

TEST_CASE("Stopping early is said, and what there is can be used")
{
  const Problem p = nested(2, 40);
  Operator_fit_options options;
  for(options.maximum_iterations = 0; options.maximum_iterations < 4;
      ++options.maximum_iterations) {
    const auto result = fit(p, options);
    CHECK(!result.converged);
    CHECK(result.iterations == options.maximum_iterations);
    check_definite(result, p.coarse, 1);
  }
  options = {};
  CHECK(fit(p, options).converged);
  options.progress = [](double done) { return done < 0.05; };
  CHECK_THROWS_AS(fit(p, options), SG::Cancelled);
}

// It solves this program with dense matrices: min |A x - b|^2 with bounds by projected gradients
// with Nesterov's momentum.
TEST_CASE("The fit agrees with an independent dense bounded solver")
{
  Problem p = nested(1, 12);
  Operator_fit_options options;
  options.orthonormality = 0.1;
  options.regularization = 0.3; // a well-conditioned program: gradients converge
  options.tolerance = 1e-9;
  options.maximum_iterations = 100;
  options.smallest_weight = 0.9; // some bounds bind
  options.rings = 1;
  const Index N = p.coarse.L.rows(), K = p.pairs.size();
  const Sparse L0 = p.coarse.L;
  REQUIRE(MatrixXd(L0).triangularView<Eigen::StrictlyUpper>().toDenseMatrix().maxCoeff() <= 0.);
  const auto result = fit(p, options);
  REQUIRE(result.converged);
  REQUIRE(result.at_bound > 10);
  REQUIRE(result.at_bound < result.unknowns / 2);

  const double area = p.coarse.mass.sum(), fine_area = p.fine.mass.sum();
  const MatrixXd G = std::sqrt(fine_area) * (p.P * p.pairs.vectors);
  const VectorXd lambda = fine_area * p.pairs.values;
  VectorXd W = (lambda.array() + 4 * shapes::pi).pow(-options.low_modes);
  W /= (W.array() * lambda.array().square()).mean();
  std::vector<std::pair<VectorXd, bool>> terms; // d, whether of the mass
  std::vector<double> start, lowest, typical, sizes;
  for(Index j = 0; j < N; ++j)
    for(Sparse::InnerIterator it(L0, j); it; ++it)
      if(it.row() < j)
        sizes.push_back(-it.value());
  std::sort(sizes.begin(), sizes.end());
  const double median = sizes[sizes.size() / 2];
  VectorXd rest = p.coarse.B.diagonal() / area;
  for(Index j = 0; j < N; ++j)
    for(Sparse::InnerIterator it(L0, j); it; ++it)
      if(it.row() < j)
        for(const bool mass : {false, true}) {
          VectorXd d = VectorXd::Unit(N, j) + (mass ? 1. : -1.) * VectorXd::Unit(N, it.row());
          const double own = mass ? p.coarse.B.coeff(it.row(), j) / area : -it.value();
          terms.push_back({d, mass});
          lowest.push_back(mass ? 0. : 0.9 * (std::max)(0.05 * median, own));
          start.push_back(own);
          typical.push_back(mass ? 1. / N : median);
          if(mass) {
            rest(j) -= own;
            rest(it.row()) -= own;
          }
        }
  for(Index v = 0; v < N; ++v) {
    terms.push_back({VectorXd::Unit(N, v), true});
    start.push_back(rest(v));
    lowest.push_back(options.smallest_mass * p.coarse.mass(v) / area);
    typical.push_back(1. / N);
  }
  const Index n = static_cast<Index>(terms.size());
  REQUIRE(n == result.unknowns);
  MatrixXd A = MatrixXd::Zero(2 * K * K + N * K + 1 + n, n);
  VectorXd b = VectorXd::Zero(A.rows());
  for(Index a = 0; a < n; ++a) {
    const VectorXd& d = terms[a].first;
    const MatrixXd dG = d * (d.transpose() * G);
    MatrixXd R = terms[a].second ? MatrixXd(dG * lambda.asDiagonal()) : MatrixXd(-dG);
    R = R * W.cwiseSqrt().asDiagonal();
    const MatrixXd projected = G.transpose() * R;
    const MatrixXd local = std::sqrt(options.whole_residual) *
                           (p.coarse.mass / area).cwiseSqrt().cwiseInverse().asDiagonal() * R;
    MatrixXd T = MatrixXd::Zero(K, K);
    if(terms[a].second)
      T = std::sqrt(options.orthonormality) * G.transpose() * dG;
    A.col(a).head(K * K) = projected.reshaped();
    A.col(a).segment(K * K, K * K) = T.reshaped();
    A.col(a).segment(2 * K * K, N * K) = local.reshaped();
    if(terms[a].second)
      A(2 * K * K + N * K, a) = 100. * d.sum() * d.sum();
    const double row = std::sqrt(options.regularization / N) / (start[a] + typical[a]);
    A(A.rows() - n + a, a) = row;
    b(A.rows() - n + a) = row * start[a];
  }
  b.segment(K * K, K * K) = std::sqrt(options.orthonormality) * MatrixXd::Identity(K, K).reshaped();
  b(2 * K * K + N * K) = 100.;
  // A change of variables that gives the normal matrix a unit diagonal.
  const VectorXd unit = A.colwise().norm().transpose().cwiseInverse();
  A = A * unit.asDiagonal();
  const VectorXd lower = Eigen::Map<const VectorXd>(lowest.data(), n).cwiseQuotient(unit);
  const MatrixXd Q = A.transpose() * A;
  const VectorXd c = A.transpose() * b;
  const double step =
      1. / Eigen::SelfAdjointEigenSolver<MatrixXd>(Q, Eigen::EigenvaluesOnly).eigenvalues()(n - 1);
  VectorXd x = lower, y = x;
  double momentum = 1.;
  for(int k = 0; k < 20000; ++k) {
    const VectorXd next = (y - step * (Q * y - c)).cwiseMax(lower);
    if((y - next).dot(next - x) > 0.)
      momentum = 1.; // restart
    const double m = 0.5 * (1. + std::sqrt(1. + 4. * momentum * momentum));
    y = next + (momentum - 1.) / m * (next - x);
    x = next;
    momentum = m;
  }
  CHECK((A * x - b).squaredNorm() == Catch::Approx(result.objective_after).epsilon(1e-5));
  x = x.cwiseProduct(unit);
  double total = 0.;
  MatrixXd L = MatrixXd::Zero(N, N), B = L;
  for(Index a = 0; a < n; ++a) {
    const VectorXd& d = terms[a].first;
    (terms[a].second ? B : L) += x(a) * d * d.transpose();
    total += terms[a].second ? x(a) * d.sum() * d.sum() : 0.;
  }
  CHECK((L / total - MatrixXd(result.op.L)).norm() < 1e-3 * L.norm());
  CHECK((area * B / total - MatrixXd(result.op.B)).norm() < 1e-3 * area * B.norm());
}

TEST_CASE("What cannot be fitted is refused in one sentence")
{
  const Problem good = nested(1, 10);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Problem p = good;
  const auto refused = [&](const std::string& text, const Operator_fit_options& options = {}) {
    CHECK_THROWS_AS(fit(p, options), std::invalid_argument);
    CHECK_THROWS_WITH(fit(p, options),
                      ContainsSubstring(text) && ContainsSubstring("operator fit: "));
    p = good;
  };
  p.P = Sparse(good.P.leftCols(50));
  refused("42 x 50");
  p.coarse.B = identity(41);
  refused("B 41 x 41");
  p.pairs.values = good.pairs.values.head(9);
  refused("9 eigenvalues");
  p.pairs.values(3) = nan;
  refused("eigenpair 3");
  p.pairs.vectors(17, 4) = nan;
  refused("eigenpair 4");
  p.coarse.mass(5) = 0.;
  refused("vertex 5 ");
  p.coarse.L.coeffRef(2, 2) = nan;
  refused("entry 2, 2 (counted from 0) of the coarse L");
  p.P.coeffRef(7, 7) = nan;
  refused("row 7 (counted from 0) of P sums to nan");
  p.fine.mass *= -1.;
  refused("area of the fine mesh");
  Operator_fit_options options;
  options.rings = 3;
  refused("rings must be 1 or 2, but is 3", options);
  options = {};
  options.regularization = 0.;
  refused("regularization", options);
  options = {};
  options.orthonormality = -1.;
  refused("orthonormality", options);
  options = {};
  for(const double e : {nan, -1., 21.}) {
    options.low_modes = e;
    refused("low_modes", options);
  }
  options = {};
  options.smallest_mass = nan;
  refused("smallest_mass", options);
  options = {};
  options.tolerance = 1.;
  refused("tolerance", options);
  options = {};
  options.maximum_iterations = -1;
  refused("maximum_iterations", options);
  options = {};
  options.threads = 0;
  refused("threads", options);
  p.fine.boundary = SG::Boundary_condition::dirichlet;
  refused("Dirichlet");
}

TEST_CASE("Operators are fitted to the mesh that a run leaves")
{
  const shapes::Matrices input = wavy_grid_matrices(36, 32);
  Spectral_edge_collapse_options options; // best, with relocation
  options.number_of_eigenvectors = 20;
  options.pre_simplify = GENERATE(std::size_t(0), std::size_t(1000));
  const bool given = options.pre_simplify == 0 && GENERATE(false, true);
  const SG::Laplace_operator fine =
      SG::laplace_operator(input.V, input.T, SG::mass_blend(options.mass));
  if(given)
    options.eigenpairs = std::make_shared<SG::Eigenpairs>(SG::eigenpairs(fine, 20));
  Mesh mesh = make_mesh(input);
  const Result result = SMS::spectral_edge_collapse(mesh, 120, options);
  const SG::Mesh_matrices coarse = SG::mesh_matrices(mesh);
  const SG::Operator_fit_result fitted = SMS::fit_operators_of_run(input, coarse, options, result);
  CHECK(fitted.objective_after < fitted.objective_before);

  const SG::Laplace_operator own = SG::cotangent_laplacian(mesh, options.mass);
  const SG::Eigenpairs pairs = SG::eigenpairs(fine, 24, options.eigenpairs_options);
  const SG::Operator_fit_result direct =
      SG::fit_operators(own, result.restriction, fine, given ? *options.eigenpairs : pairs);
  CHECK(difference(fitted.op.L, direct.op.L) < 1e-9);
  CHECK(difference(fitted.op.B, direct.op.B) < 1e-9);
  const auto judged = [&](const SG::Laplace_operator& op) {
    return SG::evaluate_spectrum(fine, pairs, op, SG::eigenpairs(op, 24), result.restriction, 20);
  };
  CHECK(judged(fitted.op).norm_L < 0.8 * judged(own).norm_L);
  CHECK(judged(fitted.op).errors.mean < 0.8 * judged(own).errors.mean);
}

namespace {
// A run of 20 eigenvectors from 480 vertices to 120.
struct Small_run
{
  shapes::Matrices input = wavy_grid_matrices(24, 20);
  Spectral_edge_collapse_options options;
  Result result;
  SG::Mesh_matrices coarse;

  Small_run()
  {
    options.number_of_eigenvectors = 20;
    Mesh mesh = make_mesh(input);
    result = SMS::spectral_edge_collapse(mesh, 120, options);
    coarse = SG::mesh_matrices(mesh);
  }
};
} // namespace

TEST_CASE_METHOD(Small_run,
                 "The fit of a run reports its solve and itself, and is cancelled in both",
                 "[fitted_operators]")
{
  Operator_fit_options fit;
  std::vector<double> said;
  fit.progress = [&](const double fraction) {
    said.push_back(fraction);
    return true;
  };
  SMS::fit_operators_of_run(input, coarse, options, result, fit);
  CHECK(std::is_sorted(said.begin(), said.end()));
  CHECK(said.front() < 0.5);
  CHECK(said.back() > 0.5);
  CHECK(said.back() <= 1);
  const double end = GENERATE(0., 0.5, 0.51);
  fit.progress = [&](const double fraction) { return fraction < end; };
  CHECK_THROWS_AS(SMS::fit_operators_of_run(input, coarse, options, result, fit), SG::Cancelled);
}

TEST_CASE_METHOD(Small_run,
                 "A flag cancels whatever takes a second, and its progress tells the phase",
                 "[fitted_operators]")
{
  const SG::Laplace_operator op = SG::laplace_operator(input.V, input.T);
  const SG::Eigenpairs& pairs = *result.eigenpairs;
  const MatrixXd Z = pairs.vectors * pairs.values.asDiagonal();
  const std::atomic<bool> cancel{true};
  const auto phases = [&](auto how, const auto& compute) {
    std::set<SG::Phase> told;
    how.progress = [&](const SG::Progress& p) { return told.insert(p.phase), true; };
    compute(how);
    const std::set<SG::Phase> result = told;
    how.cancel = &cancel;
    told.clear();
    CHECK_THROWS_AS(compute(how), SG::Cancelled);
    CHECK(told.empty());
    return result;
  };
  using Phases = std::set<SG::Phase>;
  CHECK(phases(SG::Eigenpairs_options(), [&](const auto& how) { SG::eigenpairs(op, 20, how); }) ==
        Phases{SG::Phase::eigenpairs});
  CHECK(phases(SG::Filtered_signals_options(), [&](const auto& how) {
          SG::filtered_signals(op, 20, how);
        }) == Phases{SG::Phase::eigenpairs});
  CHECK(phases(SG::Relocation_options(), [&](const auto& how) {
          MatrixXd V = coarse.V;
          SG::relocate_positions(V, coarse.T, result.restriction, input, pairs.vectors, Z,
                                 SG::Mass::averaged, {}, how);
        }) == Phases{SG::Phase::relocation});
  CHECK(phases(Operator_fit_options(), [&](const auto& how) {
          SMS::fit_operators_of_run(input, coarse, options, result, how);
        }) == Phases{SG::Phase::operator_fit});
  CHECK(phases(SG::Run_control(), [&](const auto& how) {
          SG::nearest_rows(pairs.vectors, pairs.vectors, how);
        }) == Phases{SG::Phase::matching});
}

TEST_CASE("Runs of whose kind no operators can be fitted are refused")
{
  const shapes::Matrices input = wavy_grid_matrices(12, 10);
  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 10;
  Mesh mesh = make_mesh(input);
  const Result result = SMS::spectral_edge_collapse(mesh, 60, options);
  const SG::Mesh_matrices coarse = SG::mesh_matrices(mesh);
  Operator_fit_options fit;
  const auto refused = [&](const std::string& text) {
    CHECK_THROWS_AS(SMS::fit_operators_of_run(input, coarse, options, result, fit),
                    std::invalid_argument);
    CHECK_THROWS_WITH(SMS::fit_operators_of_run(input, coarse, options, result, fit),
                      ContainsSubstring(text));
  };
  fit.rings = 3;
  refused("rings must be 1 or 2");
  fit.rings = 2;
  options.boundary = SG::Boundary_condition::dirichlet;
  refused("Dirichlet");
  options.boundary = SG::Boundary_condition::neumann;
  options.signals = input.V;
  refused("the run kept signals");
}

TEST_CASE("Operators of a run with coefficients are fitted whatever their unit",
          "[fitted_operators]")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  const VectorXd density = 1 + 0.5 * (3 * input.V.col(0)).array().sin(),
                 conductivity = 1 + 0.5 * (2 * input.V.col(1)).array().cos();
  std::vector<double> fitted;
  for(const double unit : {1., 1e-8, 1e8}) {
    Spectral_edge_collapse_options options;
    options.number_of_eigenvectors = 15;
    options.coefficients =
        SG::weighted_coefficients(std::sqrt(unit) * density, unit * conductivity);
    Mesh mesh = make_mesh(input);
    const Result result = SMS::spectral_edge_collapse(mesh, 100, options);
    const SG::Operator_fit_result fit =
        SMS::fit_operators_of_run(input, SG::mesh_matrices(mesh), options, result);
    fitted.push_back(SG::eigenpairs(fit.op, 15).values(14) / std::sqrt(unit));
  }
  // The unit moves eigenvectors by rounding, which a greedy order amplifies.
  for(const std::size_t i : {1, 2})
    CHECK(std::abs(fitted[i] - fitted[0]) < 5e-2 * fitted[0]);
}

} // namespace test_fitted_operators
