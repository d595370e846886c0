// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The policies together with what CGAL ships: constraints, filters, wrappers, queues, stop
// predicates, other costs.

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_length_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Midpoint_placement.h>
#include <CGAL/version.h>
#if CGAL_VERSION_MAJOR >= 6
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_count_stop_predicate.h>
#else
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#endif

#include "catch.h"
#include "collapse_helpers.h"

using namespace spectral_test;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;
using SMS::Spectral_options;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;
#if CGAL_VERSION_MAJOR >= 6
using Edge_count_stop = SMS::Edge_count_stop_predicate<Mesh>;
#else
using Edge_count_stop = SMS::Count_stop_predicate<Mesh>;
#endif

namespace test_composition {

namespace {

// The ends of the constrained edges.
std::set<std::pair<Point, Point>> constrained_segments(const Mesh& mesh,
                                                       const Constraints& constraints)
{
  std::set<std::pair<Point, Point>> result;
  for(const auto e : edges(mesh))
    if(constraints[e])
      result.insert(std::minmax(mesh.point(source(e, mesh)), mesh.point(target(e, mesh))));
  return result;
}

// A user's placement: near the middle of the edge and off it. Not every mesh is a plane.
template <class Placement>
struct Shifted_placement
{
  Placement base;

  template <class Profile>
  auto operator()(const Profile& profile) const
  {
    auto point = base(profile);
    if(point) {
      const double length = std::sqrt(CGAL::squared_distance(profile.p0(), profile.p1()));
      point =
          *point + 0.1 * length * Vector(std::sin(50 * point->x()), std::cos(70 * point->y()), 0.5);
    }
    return point;
  }
};

// Keeps the point at which each edge was last costed, and compares the one that is collapsed with
// it and with the best of now.
struct Costed_points
{
  using Edge = std::pair<Mesh::Vertex_index, Mesh::Vertex_index>;

  std::map<Edge, std::optional<Point>> points; // none: the cost was put off
  const Policies* policies = nullptr;
  bool selecting = false;
  std::size_t compared = 0, different = 0, put_off = 0, not_best = 0;

  // Vertices are numbered as slots are.
  bool is_put_off(const Edge& edge) const
  {
    return policies->state()
        .core()
        .postponed_cost(std::uint32_t(edge.first), std::uint32_t(edge.second))
        .has_value();
  }
  bool is_best(const Edge& edge, const Point& point) const
  {
    SMS::internal::Spectral_collapse_core core = policies->state().core();
    const Eigen::Vector3d best =
        core.evaluate(std::uint32_t(edge.first), std::uint32_t(edge.second)).point;
    return best == Eigen::Vector3d(point.x(), point.y(), point.z());
  }
};

template <class Placement>
struct Recording_placement
{
  Placement base;
  Costed_points* log;

  template <class Profile>
  auto operator()(const Profile& profile) const
  {
    const Costed_points::Edge edge = std::minmax(profile.v0(), profile.v1());
    const bool put_off = log->is_put_off(edge);
    const auto point = base(profile);
    if(!log->selecting) {
      log->points[edge].reset();
      if(point && !put_off)
        log->points[edge] = *point;
    } else if(point) {
      const std::optional<Point>& costed = log->points[edge];
      ++(costed ? log->compared : log->put_off);
      log->different += costed && *costed != *point;
      log->not_best += !log->is_best(edge, *point);
    }
    return point;
  }
};

struct Selection_visitor : SMS::internal::Dummy_visitor
{
  Costed_points* log;

  template <class P, class C, class S>
  void OnSelected(const P&, const C&, S, S)
  {
    log->selecting = true;
  }
  template <class P, class V>
  void OnCollapsed(const P&, const V&)
  {
    log->selecting = false;
  }
};

Input fine_input(const shapes::Matrices& mesh, const Policies& policies,
                 const Spectral_options& options)
{
  return eigen_input(mesh, options.mass, *policies.eigenpairs());
}

constexpr Check off_the_edge{false, false, 1e-8};

} // namespace

TEST_CASE("Constrained edges survive, unmoved, and P stays right")
{
  const bool bordered = GENERATE(false, true);
  Spectral_options options = options_with(10);
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  options.binary = GENERATE(false, true);
  const shapes::Matrices input =
      bordered ? wavy_grid_matrices(24, 22) : shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  const Constraints constraints =
      mesh.add_property_map<Mesh::Edge_index, bool>("e:constrained", false).first;
  for(const auto e : edges(mesh)) {
    const Point p = mesh.point(source(e, mesh)), q = mesh.point(target(e, mesh));
    // Edges across a plane, and a few more.
    constraints[e] = (p.x() < 0.3) != (q.x() < 0.3) || e.idx() % 97 == 0;
  }
  const auto segments = constrained_segments(mesh, constraints);
  const Policies policies(mesh, options);
  const SMS::Constrained_placement<Policies::Get_placement, Constraints> placement(
      constraints, policies.get_placement());
  const std::size_t N = 200;
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(N, mesh),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(placement)
                         .edge_is_constrained_map(constraints)
                         .visitor(policies.visitor()));
  CHECK(count_vertices(mesh) < 400);
  CHECK(constrained_segments(mesh, constraints) == segments);
  CHECK(segments.size() > 40);
  CHECK(fault_of_run(mesh, policies, fine_input(input, policies, options),
                     Check{options.binary, true, 1e-8}) == "");
}

// Noise to preserve makes the cost blind to the shape: it folds the surface wherever that is cheap.
TEST_CASE("P stays right where a filter or CGAL's own geometric test refuses")
{
  const bool filtered = GENERATE(false, true);
  const shapes::Matrices input = wavy_grid_matrices(24, 24);
  Spectral_options options = Spectral_options::paper();
  options.signals = rough_signals(input, 1);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options);
  if(filtered)
    SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(60, mesh),
                       CGAL::parameters::get_cost(policies.get_cost())
                           .get_placement(policies.get_placement())
                           .filter(SMS::Bounded_normal_change_filter<>())
                           .visitor(policies.visitor()));
  else
    collapse(mesh, policies, 60);
  CHECK(count_vertices(mesh) == 60);
  CHECK(policies.state().refusals().geometry > 0);
  CHECK((policies.state().refusals().filter > 0) == filtered);
  CHECK(fault_of_run(mesh, policies, Input{input, signal_basis(input, 0, options.signals)}) == "");
}

TEST_CASE("Bounded_normal_change_placement wraps the placement, and P stays right")
{
  const Spectral_options options = options_with(10);
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options);
  const SMS::Bounded_normal_change_placement<Policies::Get_placement> placement(
      policies.get_placement());
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(20, mesh),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(placement)
                         .visitor(policies.visitor()));
  CHECK(count_vertices(mesh) < 100);
  CHECK(fault_of_run(mesh, policies, fine_input(input, policies, options)) == "");
}

TEST_CASE("A wrapper may move the point anywhere: the cost is that of its point, the weight its "
          "projection")
{
  Spectral_options options = options_with(10);
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const bool bordered = GENERATE(false, true);
  const shapes::Matrices input =
      bordered ? wavy_grid_matrices(20, 18) : shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options);
  const Shifted_placement<Policies::Get_placement> placement{policies.get_placement()};
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(100, mesh),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(placement)
                         .visitor(policies.visitor()));
  CHECK(count_vertices(mesh) == 100);
  CHECK(fault_of_run(mesh, policies, fine_input(input, policies, options), off_the_edge) == "");
}

TEST_CASE("The placement that is collapsed is the best of the mesh as it is, mostly the one that "
          "was costed")
{
  Mesh mesh = make_mesh(wavy_grid_matrices(24, 22));
  const Policies policies(mesh, options_with(10));
  Costed_points log;
  log.policies = &policies;
  Selection_visitor visitor;
  visitor.log = &log;
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(100, mesh),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(Recording_placement<Policies::Get_placement>{
                             policies.get_placement(), &log})
                         .visitor(policies.visitor(visitor)));
  CHECK(count_vertices(mesh) == 100);
  CHECK(log.compared + log.put_off >= 475);
  CHECK(log.compared >= 300);
  CHECK(log.put_off > 0);
  CHECK(log.not_best == 0);
  CHECK(log.different <
        log.compared / 4); // by collapses two rings away, after which CGAL does not ask
}

TEST_CASE("The relaxed queue works, and P stays right")
{
  const Spectral_options options = options_with(10);
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options);
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(100, mesh),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .use_relaxed_order(CGAL::Tag_true())
                         .visitor(policies.visitor()));
  CHECK(count_vertices(mesh) == 100);
  CHECK(fault_of_run(mesh, policies, fine_input(input, policies, options)) == "");
}

TEST_CASE("Edges of the current mesh can be counted instead of vertices")
{
  const Spectral_options options = options_with(10);
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options);
  SMS::edge_collapse(mesh, Edge_count_stop(300),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .visitor(policies.visitor()));
  CHECK(edges(mesh).size() < 300);
  CHECK(edges(mesh).size() >= 297);
  CHECK(fault_of_run(mesh, policies, fine_input(input, policies, options)) == "");
}

TEST_CASE("The visitor follows any other cost and placement, too: P for them, and an E that the "
          "metric beats")
{
  const bool binary = GENERATE(false, true);
  Spectral_options options = options_with(20);
  options.binary = binary;
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input), ours = mesh;
  const Policies policies(mesh, options), our_policies(ours, options);
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(120, mesh),
                     CGAL::parameters::get_cost(SMS::Edge_length_cost<Mesh>())
                         .get_placement(SMS::Midpoint_placement<Mesh>())
                         .visitor(policies.visitor()));
  CHECK(count_vertices(mesh) == 120);
  CHECK(fault_of_run(mesh, policies, fine_input(input, policies, options),
                     Check{binary, true, 1e-8}) == "");
  collapse(ours, our_policies, 120);
  CHECK(our_policies.error() < policies.error());
}

TEST_CASE(
    "Vertex_count_stop_predicate stops at the exact count, whatever the cost and without a visitor")
{
  const bool bordered = GENERATE(false, true);
  Mesh mesh =
      make_mesh(bordered ? wavy_grid_matrices(20, 18) : shapes::bumpy_icosphere_matrices(3));
  const auto by_length = CGAL::parameters::get_cost(SMS::Edge_length_cost<Mesh>())
                             .get_placement(SMS::Midpoint_placement<Mesh>());
  const SMS::Vertex_count_stop_predicate<Mesh> stop(150, mesh);
  SECTION("Lindstrom-Turk")
  {
    SMS::edge_collapse(mesh, stop);
    CHECK(count_vertices(mesh) == 150);
  }
  SECTION("edge length and midpoint")
  {
    SMS::edge_collapse(mesh, stop, by_length);
    CHECK(count_vertices(mesh) == 150);
    CHECK(SMS::edge_collapse(mesh, stop, by_length) == 0);
    SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(90, mesh), by_length);
    CHECK(count_vertices(mesh) == 90);
    mesh.collect_garbage();
    SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(89, mesh), by_length);
    CHECK(count_vertices(mesh) == 89);
  }
  SECTION("one predicate for several runs, with edges split in between")
  {
    SMS::edge_collapse(mesh, stop, by_length);
    for(int i = 0; i < 30; ++i) {
      const auto h = mesh.halfedge(*edges(mesh).begin());
      const auto f = mesh.is_border(h) ? mesh.opposite(h) : h;
      const auto center = CGAL::Euler::add_center_vertex(f, mesh);
      mesh.point(mesh.target(center)) = CGAL::centroid(
          mesh.point(mesh.source(center)), mesh.point(mesh.target(mesh.next(center))),
          mesh.point(mesh.source(mesh.opposite(mesh.next(center)))));
    }
    CHECK(count_vertices(mesh) == 180);
    SMS::edge_collapse(mesh, stop, by_length);
    CHECK(count_vertices(mesh) == 150);
  }
#ifndef CGAL_CHECK_EXPENSIVE // with it the loop itself refuses isolated vertices
  SECTION("isolated vertices count")
  {
    for(int i = 0; i < 10; ++i)
      mesh.add_vertex(Point(9, 9, i));
    SMS::edge_collapse(mesh, stop, by_length);
    CHECK(count_vertices(mesh) == 150);
  }
#endif
  SECTION("edges without length, collapsed before the first question")
  {
    for(const int f : {20, 200, 400, 600}) {
      const auto h = mesh.halfedge(Mesh::Face_index(f));
      mesh.point(mesh.target(h)) = mesh.point(mesh.source(h));
    }
    SMS::edge_collapse(mesh, stop, by_length);
    CHECK(count_vertices(mesh) == 150);
  }
  SECTION("a target that is met already")
  {
    const std::size_t n = count_vertices(mesh);
    CHECK(SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(n, mesh), by_length) ==
          0);
    CHECK(SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(n + 5, mesh),
                             by_length) == 0);
    SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(n - 1, mesh), by_length);
    CHECK(count_vertices(mesh) == n - 1);
  }
}

} // namespace test_composition
