// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// What a run of edge_collapse() with the policies returns: E, P, the spectrum; options;
// reproducibility.

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>

#include <CGAL/Spectral_geometry/functional_map.h>

#include "catch.h"
#include "collapse_helpers.h"

namespace test_policies {

using namespace spectral_test;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;
using SMS::Spectral_options;
using SMS::Spectral_placement_strategy;

namespace {

struct Outcome
{
  Eigen::MatrixXd V;
  Eigen::MatrixXi T;
  Eigen::SparseMatrix<double> P;
  double E;

  bool operator==(const Outcome& other) const
  {
    return V == other.V && T == other.T && E == other.E &&
           Eigen::MatrixXd(P) == Eigen::MatrixXd(other.P);
  }
};

Outcome outcome(const Mesh& mesh, const Policies& policies)
{
  const shapes::Matrices coarse = SG::mesh_matrices(mesh);
  return {coarse.V, coarse.T, policies.restriction(), policies.error()};
}

// A run down to N vertices, with the state that it left behind.
struct Run
{
  Mesh mesh;
  Policies policies;

  Run(const shapes::Matrices& input, const Spectral_options& options, const std::size_t N)
    : mesh(make_mesh(input))
    , policies(mesh, options)
  {
    collapse(mesh, policies, N);
  }
  std::string fault(const Input& fine) const { return fault_of_run(mesh, policies, fine); }
};

Outcome outcome_of_run(const shapes::Matrices& input, const Spectral_options& options,
                       const std::size_t N)
{
  const Run run(input, options, N);
  return outcome(run.mesh, run.policies);
}

// What it costs to collapse each edge of the input.
std::vector<double> costs(const shapes::Matrices& input, const Spectral_options& options)
{
  Mesh mesh = make_mesh(input);
  Policies policies(mesh, options);
  const auto token = policies.state().on_started(mesh);
  SMS::internal::Spectral_collapse_core core = policies.state().core();
  std::vector<double> result;
  for(const auto e : edges(mesh)) {
    const std::uint32_t a = std::uint32_t(source(e, mesh)), b = std::uint32_t(target(e, mesh));
    result.push_back(core.evaluate((std::min)(a, b), (std::max)(a, b)).cost);
  }
  return result;
}

double largest_relative_difference(const std::vector<double>& a, const std::vector<double>& b,
                                   const double factor = 1)
{
  REQUIRE(a.size() == b.size());
  double worst = 0;
  for(std::size_t i = 0; i < a.size(); ++i)
    worst = (std::max)(worst, relative_difference(a[i], factor * b[i]));
  return worst;
}

} // namespace

TEST_CASE("After thousands of collapses the tracked E, P and F are those recomputed from the mesh")
{
  const bool bordered = GENERATE(false, true);
  Spectral_options options = options_with(20);
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  options.placement =
      GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::midpoint);
  options.binary = GENERATE(false, true);
  CAPTURE(bordered, SG::mass_name(options.mass), int(options.placement), options.binary);
  const shapes::Matrices input =
      bordered ? wavy_grid_matrices(50, 44) : shapes::bumpy_icosphere_matrices(4);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options);
  CHECK(policies.error() == 0);
  collapse(mesh, policies, 150);
  CHECK(count_vertices(mesh) == 150);
  CHECK(policies.state().number_of_vertices() == 150);
  const Check check{options.binary};
  const Input fine = eigen_input(input, options.mass, *policies.eigenpairs());
  CHECK(fault_of_run(mesh, policies, fine, check) == "");
  const double scale = std::sqrt(fine.basis.lambda.squaredNorm());
  CHECK(policies.relative_error() == Catch::Approx(std::sqrt(policies.error()) / scale));
  CHECK(policies.relative_error() < 1);

  mesh.collect_garbage();
  CHECK(fault_of_run(mesh, policies, fine, check) == "");
}

TEST_CASE(
    "A simplification to the same number of vertices is the identity: C = I and both norms are 0")
{
  const SG::Mass mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  Mesh mesh = make_mesh(input);
  Spectral_options options = options_with(12);
  options.mass = mass;
  const Policies policies(mesh, options);
  CHECK(collapse(mesh, policies, mesh.number_of_vertices()) == 0);
  CHECK(policies.error() < 1e-12);
  const Eigen::SparseMatrix<double> P = policies.restriction();
  CHECK((Eigen::MatrixXd(P) - Eigen::MatrixXd::Identity(P.rows(), P.cols())).norm() == 0);
  CHECK(positions(mesh) == input.V);
  const SG::Laplace_operator op = SG::cotangent_laplacian(mesh, mass);
  const SG::Eigenpairs pairs = SG::eigenpairs(op, 18);
  const SG::Spectral_evaluation e = SG::evaluate_spectrum(op, pairs, op, pairs, P, 12);
  CHECK((e.C - Eigen::MatrixXd::Identity(12, 12)).norm() < 1e-9);
  CHECK(e.norm_L < 1e-7 * e.fine_values(11));
  CHECK(e.norm_D < 1e-9);
  const Eigen::MatrixXd Q = policies.prolongation();
  CHECK((Q - Eigen::MatrixXd::Identity(P.rows(), P.cols())).norm() < 1e-12);
}

TEST_CASE("E bounds the commutativity norm, and is its sum over the whole coarse basis (lumped)")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  const Eigen::Index K = 15, N = 180;
  const Run run(input, options_with(K), N);
  const Policies& policies = run.policies;
  const Basis basis = eigen_input(input, SG::Mass::lumped, *policies.eigenpairs()).basis;
  // Both meshes at the scale at which the input has unit area.
  const shapes::Matrices coarse = scaled(SG::mesh_matrices(run.mesh), 1 / std::sqrt(basis.area));
  const SG::Laplace_operator op = SG::laplace_operator(coarse.V, coarse.T, SG::Mass::lumped);
  const SG::Eigenpairs all = SG::eigenpairs(op, N);
  const Eigen::MatrixXd C = SG::functional_map(all.vectors, op.B, policies.restriction(), basis.F);
  const Eigen::MatrixXd commutator = C * basis.lambda.asDiagonal() - all.values.asDiagonal() * C;
  CHECK(relative_difference(commutator.squaredNorm(), policies.error()) < 1e-8);
  const Eigen::MatrixXd CK = C.topRows(K);
  const double norm_L = SG::laplacian_commutativity_norm(CK, basis.lambda, all.values.head(K));
  CHECK(norm_L > 0);
  CHECK(norm_L <= std::sqrt(policies.error()) / CK.norm());
}

TEST_CASE("The functional map of a symmetric shape is block-diagonal")
{
  const SG::Mass mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const shapes::Matrices input = shapes::icosphere_matrices(4);
  Spectral_options options = options_with(16);
  options.mass = mass;
  const Run run(input, options, 300);
  const SG::Laplace_operator fine = SG::laplace_operator(input.V, input.T, SG::mass_blend(mass));
  const SG::Laplace_operator coarse = SG::cotangent_laplacian(run.mesh, mass);
  const SG::Spectral_evaluation e =
      SG::evaluate_spectrum(fine, *run.policies.eigenpairs(), coarse, SG::eigenpairs(coarse, 24),
                            run.policies.restriction(), 16);
  double off = e.C.squaredNorm();
  for(int l = 0; l < 4; ++l) { // spherical harmonics of degree l: 2 l + 1 of them
    const Eigen::MatrixXd block = e.C.block(l * l, l * l, 2 * l + 1, 2 * l + 1);
    off -= block.squaredNorm();
    CHECK((block.transpose() * block - Eigen::MatrixXd::Identity(2 * l + 1, 2 * l + 1)).norm() <
          0.3);
  }
  CHECK(off < 1e-3 * e.C.squaredNorm());
}

TEST_CASE("The same input gives the same result, on any number of threads")
{
  const bool bordered = GENERATE(false, true), zero_length = GENERATE(false, true);
  shapes::Matrices input =
      bordered ? wavy_grid_matrices(24, 22) : shapes::bumpy_icosphere_matrices(3);
  if(zero_length)
    for(const int f : {20, 200, 400, 700})
      input.V.row(input.T(f, 0)) = input.V.row(input.T(f, 1));
  CAPTURE(bordered, zero_length);
  Spectral_options options = options_with(12);
  const Outcome first = outcome_of_run(input, options, 120);
  CHECK(first == outcome_of_run(input, options, 120));
  for(const int threads : {2, 5}) {
    options.threads = threads;
    CHECK(first == outcome_of_run(input, options, 120));
  }
}

TEST_CASE("Copies of the policies and of their handles behave as the original, which need not "
          "outlive them")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  const Outcome expected = outcome_of_run(input, options_with(12), 150);
  Mesh mesh = make_mesh(input);
  auto original = std::make_unique<Policies>(mesh, options_with(12));
  const Policies copy = *original;
  const Policies::Get_cost cost = original->get_cost(), cost_copy = cost;
  const Policies::Get_placement placement = copy.get_placement();
  const auto visitor = original->visitor();
  original.reset();
  SMS::edge_collapse(
      mesh, SMS::Vertex_count_stop_predicate<Mesh>(150, mesh),
      CGAL::parameters::get_cost(cost_copy).get_placement(placement).visitor(visitor));
  CHECK(outcome(mesh, copy) == expected);
}

TEST_CASE("Ready eigenpairs give the mesh that computed ones give")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Spectral_options options = options_with(12);
  const Run run(input, options, 150);
  options.eigenpairs = run.policies.eigenpairs();
  options.number_of_eigenvectors = 1; // theirs is the number that counts
  CHECK(outcome_of_run(input, options, 150) == outcome(run.mesh, run.policies));
}

TEST_CASE("Eigenpairs that do not belong to the mesh and the mass are refused")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  Mesh mesh = make_mesh(input);
  const SG::Laplace_operator op = SG::laplace_operator(input.V, input.T, SG::Mass::lumped);
  const SG::Eigenpairs good = SG::eigenpairs(op, 8);
  const auto refuse_if = [&](const auto& spoil, const std::string& text) {
    SG::Eigenpairs pairs = good;
    Spectral_options options = Spectral_options::paper();
    spoil(pairs, options);
    options.eigenpairs = std::make_shared<SG::Eigenpairs>(pairs);
    CHECK_THROWS_AS(Policies(mesh, options), std::invalid_argument);
    CHECK_THROWS_WITH(Policies(mesh, options), ContainsSubstring(text));
  };
  refuse_if([](auto&, auto& options) { options.mass = SG::Mass::averaged; }, "averaged");
  refuse_if([](auto& pairs, auto&) { pairs.vectors(5, 3) += 0.1; }, "eigenpair 3 ");
  refuse_if([](auto& pairs, auto&) { pairs.values(6) = std::nan(""); }, "eigenpair 6 ");
  refuse_if([](auto& pairs, auto&) { pairs.vectors.conservativeResize(50, 8); }, "50 rows");
  const auto take_all = [](auto& pairs, auto&) {
    pairs.values.resize(0);
    pairs.vectors.resize(162, 0);
  };
  refuse_if(take_all, "there are no eigenpairs");
  refuse_if([](auto& pairs, auto&) { pairs.values.conservativeResize(5); }, "5 eigenvalues for 8");
  refuse_if([&](auto&, auto& options) { options.signals = input.V; }, "signals");
}

TEST_CASE("Rough eigenpairs still start from E = 0, and E is tracked with B^-1 L F")
{
  const SG::Mass mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  const SG::Laplace_operator op = SG::laplace_operator(input.V, input.T, SG::mass_blend(mass));
  auto pairs = std::make_shared<SG::Eigenpairs>(SG::eigenpairs(op, 10));
  pairs->vectors.leftCols(9) += 3e-5 * pairs->vectors.rightCols(9);
  Spectral_options options = Spectral_options::paper();
  options.mass = mass;
  options.eigenpairs = pairs;
  Run run(input, options, 640);
  Input fine = eigen_input(input, mass, *pairs);
  const Eigen::VectorXd lambda = fine.basis.lambda;
  fine.basis = signal_basis(input, op.theta, fine.basis.F);
  fine.basis.lambda = lambda; // which says what is constant
  CHECK(run.policies.state().basis().rough);
  collapse(run.mesh, run.policies, 100);
  CHECK(run.fault(fine) == "");
}

TEST_CASE("Rough eigenpairs of our own solver are taken again by the residuals that they came with")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Spectral_options options = options_with(30);
  options.eigenpairs_options.method = SG::Eigenpairs_method::block;
  options.eigenpairs_options.tolerance = 1e-2;
  Run run(input, options, 641);
  CHECK(run.policies.state().basis().rough);
  Spectral_options again = Spectral_options::paper();
  again.eigenpairs = run.policies.eigenpairs();
  CHECK(again.eigenpairs->residuals.maxCoeff() > 1e-3);
  Run same(input, again, 641);
  for(Run* r : {&run, &same})
    collapse(r->mesh, r->policies, 150);
  CHECK(outcome(same.mesh, same.policies) == outcome(run.mesh, run.policies));

  SG::Eigenpairs stripped = *again.eigenpairs;
  stripped.residuals.resize(0);
  again.eigenpairs = std::make_shared<SG::Eigenpairs>(stripped);
  CHECK_THROWS_AS(Policies(run.mesh, again), std::invalid_argument);
}

TEST_CASE("A signal of weight zero is absent, and weights multiply what a signal costs")
{
  const shapes::Matrices input = wavy_grid_matrices(14, 13);
  const SG::Laplace_operator op = SG::laplace_operator(input.V, input.T, SG::Mass::lumped);
  const SG::Eigenpairs all = SG::eigenpairs(op, 10);
  SG::Eigenpairs some = all;
  some.values = all.values.head(6);
  some.vectors = all.vectors.leftCols(6);
  Spectral_options weighted = Spectral_options::paper(), plain = weighted;
  weighted.eigenpairs = std::make_shared<SG::Eigenpairs>(all);
  plain.eigenpairs = std::make_shared<SG::Eigenpairs>(some);
  weighted.weights = Eigen::VectorXd::Zero(10);
  weighted.weights.head(6).setOnes();
  CHECK(largest_relative_difference(costs(input, weighted), costs(input, plain)) < 1e-9);

  // Midpoints: the best alpha of weighted signals is another one.
  weighted.placement = plain.placement = Spectral_placement_strategy::midpoint;
  weighted.weights.head(6) *= 3;
  CHECK(largest_relative_difference(costs(input, weighted), costs(input, plain), 3) < 1e-9);

  const auto costs_of = [&](const double weight_of_2, const double weight_of_7) {
    weighted.weights = Eigen::VectorXd::Zero(10);
    weighted.weights(2) = weight_of_2;
    weighted.weights(7) = weight_of_7;
    return costs(input, weighted);
  };
  const std::vector<double> c2 = costs_of(5, 0), c7 = costs_of(0, 2);
  std::vector<double> sum = costs_of(5, 2);
  for(std::size_t i = 0; i < sum.size(); ++i)
    if(sum[i] < 1e300)
      sum[i] -= c2[i];
  CHECK(largest_relative_difference(sum, c7) < 1e-9);
}

TEST_CASE("A rotation of the signals within their span leaves every cost as it is")
{
  const SG::Mass mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const shapes::Matrices input = wavy_grid_matrices(14, 13);
  const SG::Laplace_operator op = SG::laplace_operator(input.V, input.T, SG::mass_blend(mass));
  const SG::Eigenpairs pairs = SG::eigenpairs(op, 9);
  Eigen::MatrixXd rotation(9, 9);
  for(Eigen::Index i = 0; i < 81; ++i)
    rotation(i) = std::sin(12.9898 * double(i * i + 1));
  rotation = Eigen::MatrixXd(rotation.householderQr().householderQ());
  Spectral_options options = Spectral_options::paper();
  options.mass = mass;
  options.eigenpairs = std::make_shared<SG::Eigenpairs>(pairs);
  const std::vector<double> expected = costs(input, options);
  options.eigenpairs.reset();
  // Signals are taken as they are: eigenvectors normalised at unit area are sqrt(area) times
  // longer.
  options.signals = std::sqrt(op.mass.sum()) * pairs.vectors;
  CHECK(largest_relative_difference(costs(input, options), expected) < 1e-7);
  options.signals *= rotation;
  CHECK(largest_relative_difference(costs(input, options), expected) < 1e-7);
}

TEST_CASE("Signals of the user's are followed as eigenvectors are")
{
  const SG::Mass mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const shapes::Matrices input = wavy_grid_matrices(24, 22);
  Spectral_options options = Spectral_options::paper();
  options.mass = mass;
  options.signals = rough_signals(input, 5);
  Eigen::MatrixXd F = options.signals;
  if(GENERATE(false, true)) {
    options.weights = (Eigen::VectorXd(5) << 1, 0, 0.25, 9, 2).finished();
    F = F * options.weights.cwiseSqrt().asDiagonal();
  }
  const Run run(input, options, 100);
  const Policies& policies = run.policies;
  CHECK(policies.eigenpairs() == nullptr);
  const Input fine{input, signal_basis(input, SG::mass_blend(mass), F)};
  CHECK(run.fault(fine) == "");
  const SG::Laplace_operator op = SG::laplace_operator(input.V, input.T, SG::mass_blend(mass));
  const double lost = fine.basis.Z.cwiseProduct(op.B * fine.basis.Z).sum() / fine.basis.area;
  CHECK(policies.relative_error() == Catch::Approx(std::sqrt(policies.error() / lost)));
}

TEST_CASE("With constants alone nothing can be lost")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  Mesh mesh = make_mesh(input);
  Spectral_options options = options_with(1);
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const bool signals = GENERATE(false, true);
  CAPTURE(signals, SG::mass_name(options.mass));
  if(signals)
    options.signals = Eigen::MatrixXd::Constant(162, 2, -1e3);
  const Policies policies(mesh, options);
  CHECK(policies.state().basis().sum_of_squares == 0);
  CHECK(policies.relative_error() == 0);
  collapse(mesh, policies, 60);
  CHECK(fault_of_restriction(policies.restriction(), policies.vertex_map()) == "");
  CHECK(policies.error() >= 0);
  CHECK(policies.error() < (signals ? 1e-6 : 1e-12)); // beside 1e6 and 1
  CHECK(policies.relative_error() == 0);
  CHECK(policies.state().relative_error(-1e-20) == 0);
}

TEST_CASE("Pairs of constants are left out of E: beside needles they hold something else, too")
{
  const Eigen::Index K = GENERATE(1, 2, 5);
  CAPTURE(K);
  const shapes::Matrices input = shapes::grid_matrices(6, 3, 1e-5, 1.);
  Spectral_options options = options_with(K);
  options.mass = SG::Mass::lumped;
  options.number_of_mixtures = 0;
  const Run run(input, options, 9);
  const Policies& policies = run.policies;
  const shapes::Matrices coarse = SG::mesh_matrices(run.mesh);
  const Eigen::SparseMatrix<double> P = policies.restriction();
  Basis basis = eigen_input(input, options.mass, *policies.eigenpairs()).basis;
  const Basis constant{
      Eigen::MatrixXd::Ones(28, 1), Eigen::MatrixXd::Zero(28, 1), {}, basis.local, basis.area};
  CHECK(energy(coarse, constant, P) < 1e-12 * (1 + policies.error()));
  basis.F.col(0).setZero();
  basis.Z.col(0).setZero();
  CHECK(relative_difference(policies.error(), energy(coarse, basis, P)) < 1e-4);
}

TEST_CASE("Policies take their own eigenpairs back where all triangles are thin")
{
  shapes::Matrices input = wavy_grid_matrices(12, 10);
  input.V.col(0) *= 1e6;
  Mesh mesh = make_mesh(input);
  Spectral_options options = options_with(8);
  options.eigenpairs = Policies(mesh, options).eigenpairs();
  CHECK_NOTHROW(Policies(mesh, options));
}

TEST_CASE("Meshes that cannot be used are refused by the name of the first offender")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(1));
  Mesh isolated = mesh, empty;
  isolated.add_vertex(Kernel::Point_3(9, 9, 9));
  CHECK_THROWS_WITH(Policies(isolated, options_with(5)),
                    ContainsSubstring("vertex 42 ") && ContainsSubstring("isolated"));
  CGAL::Euler::join_face(mesh.halfedge(Mesh::Face_index(7)), mesh);
  CHECK_THROWS_WITH(Policies(mesh, options_with(5)), ContainsSubstring("not a triangle"));
  CHECK_THROWS_AS(Policies(empty, options_with(5)), std::invalid_argument);
}

} // namespace test_policies
