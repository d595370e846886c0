// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The restriction of costs and placements that know nothing of it.

// CGAL's Lindstrom-Turk placement sets an optional vector in ways that GCC cannot follow.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Restriction_visitor.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_length_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Midpoint_placement.h>

#include <CGAL/Polyhedron_3.h>
#include <CGAL/Polyhedron_items_with_id_3.h>

#include "catch.h"
#include "collapse_helpers.h"

namespace test_restriction_visitor {

using namespace spectral_test;
using Visitor = SMS::Restriction_visitor<Mesh>;

namespace {

template <class M, class Cost, class Placement, class V>
void collapse_to(M& mesh, const std::size_t N, const Cost& cost, const Placement& placement,
                 const V& visitor)
{
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<M>(N, mesh),
                     CGAL::parameters::get_cost(cost).get_placement(placement).visitor(visitor));
}

// Two vertices of the grid are moved onto neighbours: CGAL merges them before its loop.
shapes::Matrices grid_with_zero_length_edges()
{
  shapes::Matrices grid = wavy_grid_matrices(12, 12);
  grid.V.row(3 * 13 + 4) = grid.V.row(3 * 13 + 5);
  grid.V.row(8 * 13 + 8) = grid.V.row(9 * 13 + 8);
  return grid;
}

struct Counts
{
  int started = 0, finished = 0, collapsing = 0, collapsed = 0, selected = 0, collected = 0,
      stopped = 0;
};

struct Counting_visitor : SMS::internal::Dummy_visitor
{
  Counts* counts = nullptr;

  void OnStarted(Mesh&) { ++counts->started; }
  void OnFinished(Mesh&) { ++counts->finished; }
  template <class P>
  void OnStopConditionReached(const P&)
  {
    ++counts->stopped;
  }
  template <class P, class C>
  void OnCollected(const P&, const C&)
  {
    ++counts->collected;
  }
  template <class P, class C, class S>
  void OnSelected(const P&, const C&, S, S)
  {
    ++counts->selected;
  }
  template <class P, class O>
  void OnCollapsing(const P&, const O&)
  {
    ++counts->collapsing;
  }
  template <class P, class V>
  void OnCollapsed(const P&, const V&)
  {
    ++counts->collapsed;
  }
};

} // namespace

TEST_CASE("Without a collapse P is the identity")
{
  Mesh mesh = make_mesh(shapes::tetrahedron_matrices());
  const Visitor visitor(mesh);
  CHECK(Eigen::MatrixXd(visitor.restriction()) == Eigen::MatrixXd::Identity(4, 4));
  CHECK(visitor.vertex_map() == std::vector<std::size_t>{0, 1, 2, 3});
}

TEST_CASE("P is a restriction under Garland-Heckbert, Lindstrom-Turk and edge length")
{
  const bool bordered = GENERATE(false, true);
  const shapes::Matrices input =
      bordered ? wavy_grid_matrices(20, 20) : shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  const Visitor visitor(mesh);
  const std::size_t N = 100;
  SECTION("Garland-Heckbert")
  {
    const SMS::GarlandHeckbert_plane_policies<Mesh, Kernel> policies(mesh);
    collapse_to(mesh, N, policies.get_cost(), policies.get_placement(), visitor);
  }
  SECTION("Lindstrom-Turk")
  {
    collapse_to(mesh, N, SMS::LindstromTurk_cost<Mesh>(), SMS::LindstromTurk_placement<Mesh>(),
                visitor);
  }
  SECTION("edge length, midpoint: P carries the positions as well")
  {
    collapse_to(mesh, N, SMS::Edge_length_cost<Mesh>(), SMS::Midpoint_placement<Mesh>(), visitor);
    CHECK(position_error(visitor.restriction(), input.V, positions(mesh)) < 1e-12);
  }
  REQUIRE(count_vertices(mesh) == N);
  CHECK(visitor.restriction().rows() == Eigen::Index(N));
  CHECK(fault_of_restriction(visitor.restriction(), visitor.vertex_map()) == "");
}

TEST_CASE("P agrees with that of the spectral policies, run side by side")
{
  SMS::Spectral_options options = options_with(8);
  options.placement =
      GENERATE(SMS::Spectral_placement_strategy::midpoint,
               SMS::Spectral_placement_strategy::on_edge, SMS::Spectral_placement_strategy::free);
  const shapes::Matrices input =
      GENERATE(shapes::bumpy_icosphere_matrices(3), grid_with_zero_length_edges());
  Mesh mesh = make_mesh(input);
  const Visitor visitor(mesh);
  const SMS::Spectral_policies<Mesh, Kernel> policies(mesh, options);
  collapse(mesh, policies, 60, visitor);
  REQUIRE(count_vertices(mesh) == 60);
  const Eigen::MatrixXd difference = policies.restriction() - visitor.restriction();
  CHECK(difference.cwiseAbs().maxCoeff() < 1e-9);
  CHECK(policies.vertex_map() == visitor.vertex_map());
}

TEST_CASE("Edges without length are merged half and half")
{
  const shapes::Matrices input = grid_with_zero_length_edges();
  SECTION("Surface_mesh")
  {
    Mesh mesh = make_mesh(input);
    const Visitor visitor(mesh);
    collapse_to(mesh, 167, SMS::Edge_length_cost<Mesh>(), SMS::Midpoint_placement<Mesh>(), visitor);
    REQUIRE(visitor.log().forest().number_of_merges() == 2);
    CHECK(visitor.log().forest().merges()[0].weight == 0.5);
    CHECK(visitor.log().forest().merges()[1].weight == 0.5);
    CHECK(fault_of_restriction(visitor.restriction(), visitor.vertex_map()) == "");
    CHECK(position_error(visitor.restriction(), input.V, positions(mesh)) < 1e-12);
  }
  SECTION("Polyhedron_3, which frees what it removes")
  {
    using Polyhedron = CGAL::Polyhedron_3<Kernel, CGAL::Polyhedron_items_with_id_3>;
    Polyhedron mesh;
    shapes::make_mesh(mesh, input);
    CGAL::set_halfedgeds_items_id(mesh);
    const SMS::Restriction_visitor<Polyhedron> visitor(mesh);
    collapse_to(mesh, 80, SMS::Edge_length_cost<Polyhedron>(),
                SMS::Midpoint_placement<Polyhedron>(), visitor);
    REQUIRE(count_vertices(mesh) == 80);
    CHECK(fault_of_restriction(visitor.restriction(), visitor.vertex_map()) == "");
    CHECK(position_error(visitor.restriction(), input.V, positions(mesh)) < 1e-12);
  }
}

TEST_CASE("A constrained edge decides which vertex is kept, and P follows")
{
  const shapes::Matrices input = wavy_grid_matrices(16, 16);
  Mesh mesh = make_mesh(input);
  const auto constraints =
      mesh.add_property_map<Mesh::Edge_index, bool>("e:constrained", false).first;
  for(const auto e : edges(mesh))
    constraints[e] = e.idx() % 5 == 0;
  const Visitor visitor(mesh);
  const SMS::Midpoint_placement<Mesh> midpoint;
  SMS::edge_collapse(
      mesh, SMS::Vertex_count_stop_predicate<Mesh>(120, mesh),
      CGAL::parameters::get_cost(SMS::Edge_length_cost<Mesh>())
          .get_placement(SMS::Constrained_placement<SMS::Midpoint_placement<Mesh>,
                                                    std::decay_t<decltype(constraints)>>(
              constraints, midpoint))
          .edge_is_constrained_map(constraints)
          .visitor(visitor));
  CHECK(visitor.log().forest().number_of_merges() > 20);
  CHECK(fault_of_restriction(visitor.restriction(), visitor.vertex_map()) == "");
  CHECK(position_error(visitor.restriction(), input.V, positions(mesh)) < 1e-12);
}

TEST_CASE("Rows follow the vertices after garbage collection, and a second run continues")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  const Visitor visitor(mesh);
  const SMS::Edge_length_cost<Mesh> cost;
  const SMS::Midpoint_placement<Mesh> midpoint;
  collapse_to(mesh, 300, cost, midpoint, visitor);
  mesh.collect_garbage();
  CHECK(position_error(visitor.restriction(), input.V, positions(mesh)) < 1e-12);
  collapse_to(mesh, 100, cost, midpoint, visitor);
  CHECK(visitor.restriction().rows() == 100);
  CHECK(position_error(visitor.restriction(), input.V, positions(mesh)) < 1e-12);
}

TEST_CASE("A user's visitor gets every call, copied or by reference")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(2));
  const std::size_t edges_before = num_edges(mesh);
  Counts counts;
  Counting_visitor counting;
  counting.counts = &counts;
  const bool by_reference = GENERATE(false, true);
  const SMS::Edge_length_cost<Mesh> cost;
  const SMS::Midpoint_placement<Mesh> midpoint;
  if(by_reference)
    collapse_to(mesh, 100, cost, midpoint,
                SMS::Restriction_visitor<Mesh, std::reference_wrapper<Counting_visitor>>(
                    mesh, std::ref(counting)));
  else
    collapse_to(mesh, 100, cost, midpoint,
                SMS::Restriction_visitor<Mesh, Counting_visitor>(mesh, counting));
  CHECK(counts.started == 1);
  CHECK(counts.finished == 1);
  CHECK(counts.stopped == 1);
  CHECK(counts.collected == int(edges_before));
  CHECK(counts.collapsing == 62);
  CHECK(counts.collapsed == 62);
  CHECK(counts.selected >= 62);
}

TEST_CASE("Another mesh is refused")
{
  Mesh mesh = make_mesh(shapes::icosphere_matrices(1)), other = mesh;
  const Visitor visitor(mesh);
  CHECK_THROWS_WITH(collapse_to(other, 20, SMS::Edge_length_cost<Mesh>(),
                                SMS::Midpoint_placement<Mesh>(), visitor),
                    Catch::Matchers::ContainsSubstring("another mesh"));
  CHECK(count_vertices(other) == 42);
}

} // namespace test_restriction_visitor
