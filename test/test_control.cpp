// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Control over a run: an error to stop at, progress, cancelling, and what the first of two stages
// asks.

#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_length_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Midpoint_placement.h>

#include "catch.h"
#include "collapse_helpers.h"

#include <thread>

namespace test_control {

using namespace spectral_test;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;
using Result = SMS::Spectral_edge_collapse_result;
using SG::Phase;
using SG::Progress;
using SMS::Spectral_edge_collapse_options;

TEST_CASE("What only the collapses need is given back, to the last number")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(3));
  const Policies policies(mesh, options_with(20));
  collapse(mesh, policies, 300);
  const auto& fields = policies.state().core().fields();
  REQUIRE((fields.signals.size() == 19 && fields.E.data() != nullptr));
  policies.shared_state()->release();
  CHECK(fields.signals.size() == 0);
  CHECK(fields.E.data() == nullptr);
  CHECK(fields.mass.data() == nullptr);
  CHECK(fields.points.capacity() == 0);
}

TEST_CASE("A bound of the error stops before the collapse that would exceed it")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Spectral_edge_collapse_options options = options_with(20);
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const std::size_t about = GENERATE(500, 200);
  Mesh counted_first = make_mesh(input);
  const double bound =
      1.0001 * SMS::spectral_edge_collapse(counted_first, about, options).relative_error;
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options);
  SMS::edge_collapse(mesh, SMS::Spectral_error_stop_predicate(policies, bound),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .visitor(policies.visitor()));
  const std::size_t N = count_vertices(mesh);
  const double error = policies.relative_error();
  CAPTURE(bound, N);
  CHECK(error <= bound);
  CHECK(error > 0.8 * bound);
  CHECK(N < about + 100);

  options.eigenpairs = policies.eigenpairs();
  options.maximum_error = bound;
  Mesh by_call = make_mesh(input);
  const Result result = SMS::spectral_edge_collapse(by_call, 1, options);
  CHECK(identical(by_call, mesh));
  CHECK(result.stop_reason == Result::Stop_reason::error_reached);
  CHECK(result.stop_reason_name() == std::string("error bound reached"));
  CHECK(result.explanation == "");
  CHECK(result.warnings.empty());
  CHECK(result.relative_error == Catch::Approx(error).epsilon(1e-9)); // the sums differ

  options.maximum_error = std::numeric_limits<double>::infinity();
  Mesh one_further = make_mesh(input);
  CHECK(SMS::spectral_edge_collapse(one_further, N - 1, options).relative_error > bound);

  options.maximum_error = bound;
  Mesh by_count = make_mesh(input);
  const Result counted = SMS::spectral_edge_collapse(by_count, N + 5, options);
  CHECK(counted.stop_reason == Result::Stop_reason::target_reached);
  CHECK(counted.output_vertices == N + 5);
}

TEST_CASE("A bound of the error holds beside a cap, whose cost is nothing but rounding")
{
  int stopped = 0;
  for(const int face : {20, 40, 60})
    for(const double height : {1e-8, 1e-9, 1e-10})
      for(const double bound : {0.1, 0.2}) {
        shapes::Matrices input = wavy_grid_matrices(8, 8);
        const Eigen::RowVector3i t = input.T.row(face);
        input.V.row(t[1]) =
            (input.V.row(t[0]) + input.V.row(t[2])) / 2 + height * input.V.row(t[1]);
        Mesh mesh = make_mesh(input);
        Spectral_edge_collapse_options options = options_with(5);
        options.maximum_error = bound;
        const Result result = SMS::spectral_edge_collapse(mesh, 1, options);
        CAPTURE(face, height, bound, result.output_vertices);
        CHECK(result.relative_error <= bound);
        stopped += int(result.stop_reason == Result::Stop_reason::error_reached);
      }
  CHECK(stopped >= 9); // some go on to the end below the higher bound
}

TEST_CASE("A bound of the error holds where a constrained edge makes a needle")
{
  // Constrained edges stay where they are, whatever E says.
  const shapes::Matrices input = shapes::matrices({{-1 + 2e-11, -1 + 2e-11, 1e-11},
                                                   {-0.99999, 0.85097039215686288, -8.5e-12},
                                                   {-1, 1, -1e-11},
                                                   {-1, -1, 1e-11}},
                                                  {{1, 3, 2}, {0, 3, 1}});
  int stopped = 0;
  for(const double bound : {0.1, 0.5, 0.89})
    for(unsigned e = 0; e < 5; ++e) {
      Mesh mesh = make_mesh(input);
      auto constrained = mesh.add_property_map<Mesh::Edge_index, bool>("e:constrained").first;
      constrained[Mesh::Edge_index(e)] = true;
      Spectral_edge_collapse_options options = options_with(2);
      options.signals = rough_signals(input, 2);
      options.mass = SG::Mass::lumped;
      options.placement = SMS::Spectral_placement_strategy::on_edge;
      options.maximum_error = bound;
      const Result result = SMS::spectral_edge_collapse(
          mesh, 1, options, CGAL::parameters::edge_is_constrained_map(constrained));
      CAPTURE(bound, e, result.output_vertices);
      CHECK(result.relative_error <= bound);
      stopped += int(result.stop_reason == Result::Stop_reason::error_reached);
    }
  CHECK(stopped > 0);
}

TEST_CASE("A bound of the error looks at the placement of a wrapper")
{
  // Always the first end, wherever the policies would have put the vertex.
  const auto first_end = [](const auto& profile) {
    return SMS::internal::Spectral_optional<Kernel::Point_3>(profile.p0());
  };
  const double bound = GENERATE(0.05, 0.15, 0.3);
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(3));
  const Policies policies(mesh, options_with(20));
  SMS::edge_collapse(mesh, SMS::Spectral_error_stop_predicate(policies, bound, first_end),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(first_end)
                         .visitor(policies.visitor()));
  CAPTURE(bound, count_vertices(mesh));
  CHECK(policies.relative_error() <= bound);
  CHECK(policies.relative_error() > 0.8 * bound);
}

TEST_CASE("A bound that is no number is refused; 0 lets nothing be lost; constants lose nothing")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(2));
  Spectral_edge_collapse_options options = options_with(5);
  const Policies policies(mesh, options);
  for(const double bound : {-1., std::nan("")})
    CHECK_THROWS_AS(SMS::Spectral_error_stop_predicate(policies, bound), std::invalid_argument);
  options.maximum_error = 0;
  CHECK(SMS::spectral_edge_collapse(mesh, 1, options).output_vertices == 162);
  options.number_of_eigenvectors = 1;
  const Result result = SMS::spectral_edge_collapse(mesh, 50, options);
  CHECK(result.output_vertices == 50);
  CHECK(result.relative_error == 0);
}

TEST_CASE("Progress towards a bound of the error never goes back and ends near 1")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(3));
  Spectral_edge_collapse_options options = options_with(20);
  options.maximum_error = 0.2;
  std::vector<double> fractions;
  std::size_t vertices = 0;
  options.progress = [&](const Progress& p) {
    if(p.phase == Phase::collapses)
      fractions.push_back(p.fraction);
    vertices = p.number_of_vertices;
    return true;
  };
  const Result result = SMS::spectral_edge_collapse(mesh, 1, options);
  REQUIRE(fractions.size() > 20);
  CHECK(fractions.size() < 110);
  CHECK(std::is_sorted(fractions.begin(), fractions.end()));
  CHECK(fractions.back() > 0.9);
  CHECK(fractions.back() <= 1);
  CHECK(vertices < result.output_vertices + 60);
}

TEST_CASE("Fractions lie between 0 and 1, also where quadrics have nothing to collapse")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  const std::size_t n = std::size_t(input.V.rows()), target = GENERATE_COPY(n - 1, n - 2, n / 4);
  Mesh mesh = make_mesh(input);
  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 10;
  options.quadrics_above = 1;
  bool within = true;
  options.progress = [&](const Progress& p) {
    within = within && p.fraction >= 0 && p.fraction <= 1;
    return true;
  };
  CHECK(SMS::spectral_edge_collapse(mesh, target, options).output_vertices == target);
  CHECK(within);
}

TEST_CASE("Another thread can cancel, in every phase")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  Spectral_edge_collapse_options options = options_with(20);
  std::atomic<bool> cancel{false};
  options.cancel = &cancel;
  Phase phase = Phase::eigenpairs;
  double fraction = 0;
  const bool tells_progress = GENERATE(true, false);
  options.progress = [&](const Progress& p) {
    if(p.phase == phase && p.fraction >= fraction)
      std::thread([&cancel] { cancel = true; }).join();
    return true;
  };
  SECTION("before anything")
  {
    cancel = true;
    if(!tells_progress)
      options.progress = nullptr;
    CHECK_THROWS_AS(SMS::spectral_edge_collapse(mesh, 100, options), SG::Cancelled);
    CHECK(positions(mesh) == input.V);
  }
  SECTION("while the eigenpairs are computed")
  {
    CHECK_THROWS_AS(SMS::spectral_edge_collapse(mesh, 100, options), SG::Cancelled);
    CHECK(positions(mesh) == input.V);
  }
  SECTION("while the first costs are computed")
  {
    phase = Phase::first_costs;
    fraction = 0.1;
    CHECK_THROWS_AS(SMS::spectral_edge_collapse(mesh, 100, options), SG::Cancelled);
    CHECK(positions(mesh) == input.V);
  }
  SECTION("between two collapses")
  {
    phase = Phase::collapses;
    fraction = 0.5;
    const Result result = SMS::spectral_edge_collapse(mesh, 100, options);
    CHECK(result.stop_reason == Result::Stop_reason::cancelled);
    CHECK(result.output_vertices > 350);
    CHECK(result.output_vertices < 380);
    CHECK(fault_of_result(mesh, result.restriction, result.vertex_map, input) == "");
    CHECK(position_error(result.restriction, input.V, positions(mesh)) < 1e-12);
    CHECK(result.log.number_of_vertices_left() == result.output_vertices);
  }
}

TEST_CASE("The flag reaches the solves of a relocation that makes no steps")
{
  struct Cancelling : SMS::internal::Dummy_visitor
  {
    std::atomic<bool>& cancel;
    explicit Cancelling(std::atomic<bool>& flag)
      : cancel(flag)
    {}
    void OnFinished(Mesh&) const { cancel = true; }
  };
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(2));
  std::atomic<bool> cancel{false};
  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 10;
  options.cancel = &cancel;
  options.relocation.maximum_steps = 0;
  const Result result =
      SMS::spectral_edge_collapse(mesh, 60, options, CGAL::parameters::visitor(Cancelling(cancel)));
  CHECK(cancel);
  CHECK(result.output_vertices == 60);
  CHECK(result.stop_reason == Result::Stop_reason::cancelled);
}

TEST_CASE(
    "A run of two stages that is cancelled in the first leaves the mesh as it was, later what the "
    "first has made")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  Spectral_edge_collapse_options options = options_with(20);
  options.pre_simplify = 300;
  const Phase phase = GENERATE(Phase::pre_simplification, Phase::eigenpairs, Phase::first_costs);
  const double fraction = GENERATE(0., 0.5);
  CAPTURE(int(phase), fraction);
  options.progress = [&](const Progress& p) { return p.phase != phase || p.fraction < fraction; };
  if(phase == Phase::pre_simplification) {
    CHECK_THROWS_AS(SMS::spectral_edge_collapse(mesh, 100, options), SG::Cancelled);
    CHECK(positions(mesh) == input.V);
    return;
  }
  const Result result = SMS::spectral_edge_collapse(mesh, 100, options);
  CHECK(result.stop_reason == Result::Stop_reason::cancelled);
  CHECK_THAT(result.explanation, ContainsSubstring("cancelled"));
  CHECK(result.output_vertices == 300);
  CHECK(count_vertices(mesh) == 300);
  CHECK(fault_of_result(mesh, result.restriction, result.vertex_map, input) == "");
}

TEST_CASE("Named parameters that the one call cannot honour do not compile")
{
  namespace parameters = CGAL::parameters;
  const auto overrides = [](const auto& np) {
    return SMS::internal::overrides_policies<std::decay_t<decltype(np)>>;
  };
  CHECK(overrides(parameters::use_relaxed_order(CGAL::Tag_true())));
  CHECK(overrides(parameters::vertex_index_map(0)));
  CHECK(overrides(parameters::halfedge_index_map(0)));
  CHECK(overrides(parameters::get_cost(0)));
  CHECK(overrides(parameters::visitor(0).get_placement(0)));
  CHECK(!overrides(parameters::visitor(0).filter(0).edge_is_constrained_map(0)));
  CHECK(!overrides(parameters::default_values()));
}

TEST_CASE(
    "The first stage does not feel how far from the origin the mesh lies, and leaves no vertex a "
    "rounding away")
{
  shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  input.V = (input.V * 65536).array().round() / 65536; // so that moving it is exact
  Spectral_edge_collapse_options options = options_with(20);
  options.pre_simplify = 200;
  options.kept_vertices = every(20, input.V.rows());
  Eigen::MatrixXd expected;
  for(const double offset : {16., 16777216., 1073741824.}) { // above 8 lengths from the first
    shapes::Matrices moved = input;
    moved.V.array() += offset;
    Mesh mesh = make_mesh(moved), replayed = mesh;
    const Result result = SMS::spectral_edge_collapse(mesh, 200, options);
    CAPTURE(offset);
    CHECK(survivors(options.kept_vertices, moved, mesh, result.restriction, result.vertex_map) ==
          options.kept_vertices.size());
    SMS::Collapse_replay<Mesh>(replayed, result.log).collapse_to(200);
    CHECK(positions(replayed) == positions(mesh));
    if(expected.size() == 0)
      expected = positions(mesh).array() - offset;
    else
      CHECK((positions(mesh).array() - offset - expected.array()).abs().maxCoeff() < 1e-6);
  }
}

TEST_CASE(
    "edge_collapse() is cancelled through the stop predicate, and the policies go on afterwards")
{
  const shapes::Matrices input = wavy_grid_matrices(20, 18);
  Mesh mesh = make_mesh(input), expected = mesh;
  std::atomic<bool> cancel{false};
  Spectral_edge_collapse_options options = options_with(10);
  options.cancel = &cancel;
  options.progress = [&](const Progress& p) {
    cancel = p.phase == Phase::collapses && p.fraction > 0.5;
    return true;
  };
  const Policies policies(mesh, options);
  const SMS::Spectral_stop_predicate stop(policies, 100);
  SMS::edge_collapse(mesh, stop,
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .visitor(policies.visitor()));
  CHECK(stop.cancelled());
  CHECK(!stop.reached());
  CHECK(count_vertices(mesh) > 220);
  CHECK(count_vertices(mesh) < 260);
  const Input fine = eigen_input(input, SG::Mass::lumped, *policies.eigenpairs());
  CHECK(fault_of_run(mesh, policies, fine) == "");
  cancel = false;
  collapse(mesh, policies, 50);
  CHECK(count_vertices(mesh) == 50);
  CHECK(fault_of_run(mesh, policies, fine) == "");
}

TEST_CASE("The number of vertices stops a run that no policies follow")
{
  Mesh mesh = make_mesh(wavy_grid_matrices(12, 12));
  const Policies policies(mesh, options_with(10));
  const SMS::Spectral_stop_predicate stop(policies, 100);
  SMS::edge_collapse(mesh, stop,
                     CGAL::parameters::get_cost(SMS::Edge_length_cost<Mesh>())
                         .get_placement(SMS::Midpoint_placement<Mesh>()));
  CHECK(stop.reached());
  CHECK(count_vertices(mesh) == 100);
}

} // namespace test_control
