// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Vertices of many neighbours, hubs: discs and the caps of gears.

#include "catch.h"
#include "core_helpers.h"

#include <CGAL/Real_timer.h>
#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>
#include <CGAL/Spectral_toolbox/curvature_coefficients.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_crossing_guard.h>

namespace test_high_degree {

using namespace spectral_test;
using SMS::Spectral_placement_strategy;

namespace {

// Signals without the cost of a solve.
Basis smooth_basis(const shapes::Matrices& mesh, const double theta, const int K)
{
  Eigen::MatrixXd signals(mesh.V.rows(), K);
  for(int k = 0; k < K; ++k)
    signals.col(k) = ((k + 1) * mesh.V.col(k % 3).array() + 0.3 * k).sin();
  return signal_basis(mesh, theta, signals);
}

} // namespace

TEST_CASE("Costs are the change of the global E, whichever vertices are hubs")
{
  const std::size_t limit = GENERATE(2, 5, 6, 7);
  const double theta = GENERATE(0., 0.5);
  const bool bordered = GENERATE(false, true);
  CAPTURE(limit, theta, bordered);
  const shapes::Matrices input =
      bordered ? shapes::irregular_grid_matrices(12, 11) : shapes::bumpy_icosphere_matrices(2);
  const Basis basis = eigenbasis(input, theta, 9);
  Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis, Parameters::paper(), limit);
  std::mt19937 random(7);
  for(const int collapses : {0, 20, 40}) {
    CHECK(simplify(core, mesh, collapses, random) == collapses);
    CHECK(compare_costs(core, mesh, 12, random).worst < 1e-9);
    CHECK(std::abs(core.total() - mesh.energy()) < 1e-12 * basis.Z.squaredNorm());
  }
}

TEST_CASE("What becomes of discs and gears does not depend on what a hub is, and stays so while "
          "rings grow and "
          "shrink; until its turn comes an edge at a hub is costed as if that stayed")
{
  const bool closed = GENERATE(false, true);
  const double theta = GENERATE(0., 0.5);
  const double shape = GENERATE(0., 3.);
  const Spectral_placement_strategy placement =
      GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::free);
  CAPTURE(closed, theta, shape, int(placement));
  const shapes::Matrices input = closed ? shapes::gear_matrices(40, 3) : shapes::disc_matrices(60);
  const Basis basis = eigenbasis(input, theta, 8);
  Parameters parameters = Parameters::paper();
  parameters.placement = placement;
  parameters.shape = shape;
  Slow_mesh mesh(input, basis), other(input, basis);
  Core plain = make_core(mesh, basis, parameters, 1000);
  Core hubs = make_core(other, basis, parameters, 35);
  int at_hubs = 0;
  for(int collapse = 0; collapse < 30; ++collapse) {
    double worst = 0, scale = plain.total();
    const auto compare = [&](const double a, const double b) {
      if(std::isfinite(a) != std::isfinite(b))
        worst = infinity;
      else if(std::isfinite(a))
        worst = (std::max)(worst, std::abs(a - b) / (std::abs(a) + scale));
    };
    Sample best;
    Edge edge(0, 0);
    for(const Edge& e : mesh.edge_list()) {
      const Slot u = Slot(e.first), v = Slot(e.second);
      const Sample a = plain.select(u, v), b = hubs.select(u, v);
      compare(a.cost, b.cost);
      compare(plain.evaluate(u, v).cost, a.cost);
      const Sample waiting = hubs.evaluate(u, v);
      const auto& rings = hubs.fields().rings;
      const bool at_u = rings[u].size() >= rings[v].size();
      const double staying = plain.cost_at(u, v, on_edge(mesh, e, at_u ? 0 : 1));
      const bool is_hub = hubs.fields().is_hub(u) || hubs.fields().is_hub(v);
      const bool stays = is_hub && std::isfinite(staying);
      compare(waiting.cost, stays ? staying : a.cost);
      if(stays)
        CHECK(waiting.weight == (at_u ? 0. : 1.));
      at_hubs += stays;
      if(a.collapsible() && a.cost < best.cost) {
        best = a;
        edge = e;
      }
    }
    CHECK(worst < 1e-9);
    REQUIRE(best.collapsible());
    // Now and then an edge at a centre, whose ring then grows at the other end.
    commit(plain, mesh, edge, best, collapse % 2 == 0);
    commit(hubs, other, edge, best, collapse % 2 == 0);
    CHECK(relative_difference(plain.total(), hubs.total()) < 1e-9);
  }
  CHECK(at_hubs > 100);
}

TEST_CASE("Time is linear in the degree, whatever the number of the hub")
{
  // Were all triangles of a hub looked at for each of its edges: 4,000 times 4,000 rows.
  const int d = 4000, n = 2 * d + 2;
  const bool hubs_first = GENERATE(false, true);
  const auto number = [&](const int v) { return hubs_first ? n - 1 - v : v; };
  std::vector<Eigen::Index> order;
  for(int v = 0; v < n; ++v)
    order.push_back(number(v));
  const shapes::Matrices input = shapes::permuted(shapes::gear_matrices(d, 2), order);
  const Basis basis = smooth_basis(input, 0, 8);
  std::vector<Eigen::Vector3d> points;
  Rings rings;
  rings.resize(std::size_t(n));
  for(int v = 0; v < n; ++v)
    points.push_back(input.V.row(v));
  const auto add = [&](const int c, const std::vector<int>& around) {
    for(const int w : around) {
      SMS::internal::Spectral_ring_entry e;
      e.vertex = Slot(number(w));
      e.face = true;
      rings[Slot(number(c))].push_back(e);
    }
  };
  std::vector<int> bottom, top;
  for(int i = 0; i < d; ++i) {
    const int next = (i + 1) % d, previous = (i + d - 1) % d;
    bottom.push_back((d - i) % d);
    top.push_back(d + i);
    add(i, {2 * d, next, d + i, d + previous, previous});
    add(d + i, {2 * d + 1, d + previous, i, next, d + next});
  }
  add(2 * d, bottom);
  add(2 * d + 1, top);
  CGAL::Real_timer timer;
  timer.start();
  Core core;
  core.set_basis(core_basis(basis), basis.local, Parameters::paper(), false);
  core.set_geometry(std::move(points), std::move(rings));
  for(const Edge& e : Slow_mesh(input, basis).edge_list())
    core.evaluate(Slot(e.first), Slot(e.second));
  CHECK(core.number_of_evaluations() == std::size_t(6 * d));
  CHECK(timer.time() < 20);
  // The ring of a hub is not searched: costs stand in those of its neighbours.
  for(const auto& entry : core.fields().rings[Slot(number(2 * d))]) {
    REQUIRE(entry.cost == entry.unknown_cost);
    REQUIRE(core.fields().rings[entry.vertex][0].cost != entry.unknown_cost);
  }
}

TEST_CASE("Triangles around a vertex that cross are found, few or many")
{
  using SG::internal::Corners;
  const int d = GENERATE(20, 200);
  CAPTURE(d);
  const shapes::Matrices input = shapes::gear_matrices(d, 2);
  const Basis basis = smooth_basis(input, 0, 1);
  const Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis);
  SMS::internal::Spectral_crossing_guard guard;
  const auto& fields = core.fields();
  guard.set_geometry(fields.points, fields.rings);
  const Slot u = Slot(2 * d + 1), v = Slot(d); // a cap's centre and a vertex of its rim
  int crossing = 0, apart = 0;
  for(const Eigen::Vector3d& x :
      {Eigen::Vector3d(0, 0, 0.6), Eigen::Vector3d(0.3, 0.1, 0.7), Eigen::Vector3d(1.3, 0.4, 0.52),
       Eigen::Vector3d(2, 0, 0.6), Eigen::Vector3d(0, 0, 3), Eigen::Vector3d(0.95, 0.2, 0.5)}) {
    std::vector<Corners> fan, rest;
    for(const Eigen::Vector3i& t : mesh.triangles) {
      const bool at_u = Slow_mesh::contains(t, int(u)), at_v = Slow_mesh::contains(t, int(v));
      Corners corners = SG::internal::corners_of_face(input.V, t);
      if(at_u && at_v)
        continue;
      for(auto& corner : corners)
        if(corner.vertex == u || corner.vertex == v)
          corner = {u, x};
      (at_u || at_v ? fan : rest).push_back(corners);
    }
    bool slow = false;
    for(std::size_t i = 0; i < fan.size(); ++i) {
      for(std::size_t j = i + 1; j < fan.size(); ++j)
        slow = slow || SG::internal::triangles_intersect(fan[i], fan[j]);
      for(const Corners& t : rest)
        slow = slow || SG::internal::triangles_intersect(fan[i], t);
    }
    CHECK(guard.crosses(fields.points, fields.rings, u, v, x) == slow);
    ++(slow ? crossing : apart);
  }
  CHECK(crossing > 0);
  CHECK(apart > 0);
}

TEST_CASE("curvature_coefficients: neighbours of a hub do not have all of its vertices each")
{
  const auto work = [](const int degree) {
    const shapes::Matrices disc = shapes::disc_matrices(degree);
    const auto rings = SG::internal::Vertex_rings::of_vertices(disc.T, disc.V.rows());
    std::vector<char> seen(std::size_t(disc.V.rows()), 0);
    std::size_t result = 0;
    for(int v = 0; v < int(disc.V.rows()); ++v) {
      const std::vector<int> ring = rings.around(v, 16, seen);
      CHECK(ring.front() == v);
      CHECK(std::set<int>(ring.begin(), ring.end()).size() == ring.size());
      CHECK(ring.size() >= 16);
      result += ring.size();
    }
    return double(result);
  };
  CHECK(work(4000) < 4.2 * work(1000));
}

TEST_CASE("curvature_coefficients can be cancelled")
{
  const shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(4);
  std::vector<double> fractions;
  SG::curvature_coefficients(mesh.V, mesh.T, 1., [&](double f) {
    fractions.push_back(f);
    return true;
  });
  CHECK(fractions.size() > 2);
  CHECK(std::is_sorted(fractions.begin(), fractions.end()));
  CHECK_THROWS_AS(SG::curvature_coefficients(mesh.V, mesh.T, 1., [](double f) { return f < 0.3; }),
                  SG::Cancelled);
}

} // namespace test_high_degree
