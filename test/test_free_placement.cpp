// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Strategy (iii), a placement off the edge, against the slow mesh.

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_placement_search.h>

#include "catch.h"
#include "core_helpers.h"

#include <Eigen/LU>

namespace test_free_placement {

using namespace spectral_test;
using SMS::Spectral_placement_strategy;

TEST_CASE("The quadric of a free placement has its least value at the minimiser, as far as the "
          "samples reach")
{
  SMS::internal::Spectral_placement_quadric quadric;
  const Eigen::Vector3d u(1, 2, 3), v(1.5, 2, 2.5), normal(1, 3, -1);
  REQUIRE(quadric.set_frame(u, v, normal));
  CHECK_FALSE(SMS::internal::Spectral_placement_quadric().set_frame(u, u, normal));
  CHECK_FALSE(SMS::internal::Spectral_placement_quadric().set_frame(u, v, v - u));
  CHECK((quadric.point(0) - u).norm() < 1e-15);
  CHECK((quadric.point(2) - v).norm() < 1e-15);
  Eigen::Matrix3d axes; // point(3) and point(5) lie along the others
  axes << quadric.point(2) - quadric.point(1), quadric.point(3) - quadric.point(1),
      quadric.point(5) - quadric.point(1);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&] {
    return Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  };
  int inside = 0;
  for(int i = 0; i < 40; ++i) {
    Eigen::Matrix3d A =
        Eigen::Vector3d(1 + uniform(random), 1.2, i % 2 == 0 ? 0.9 : -0.7).asDiagonal();
    A(0, 1) = A(1, 0) = 0.3 * uniform(random);
    A(1, 2) = A(2, 1) = 0.3 * uniform(random);
    const Eigen::Vector3d b = draw();
    const auto value = [&](const Eigen::Vector3d& x) {
      const Eigen::Vector3d y = axes.inverse() * (x - quadric.point(1));
      return 5 + b.dot(y) + y.dot(A * y);
    };
    double costs[10];
    for(int s = 0; s < 10; ++s)
      costs[s] = value(quadric.point(s));
    const Eigen::Vector3d best = quadric.minimiser(costs).value(),
                          y = axes.inverse() * (best - quadric.point(1));
    CHECK(y.norm() < 1 + 1e-9);
    if(y.norm() < 0.99) {
      ++inside;
      CHECK((2 * A * y + b).norm() < 1e-9);
    }
    double least = infinity;
    for(int k = 0; k < 300; ++k) {
      const Eigen::Vector3d z = draw();
      if(z.norm() < 1)
        least = (std::min)(least, value(quadric.point(1) + axes * z));
    }
    CHECK(value(best) < least + 1e-9);
    costs[4] = infinity;
    CHECK_FALSE(quadric.minimiser(costs));
  }
  CHECK(inside > 5);
}

TEST_CASE("A free candidate is the best of ten samples around the edge, of those on it, and of "
          "their quadric")
{
  const shapes::Matrices input = wavy_grid_matrices(12, 11);
  const Basis basis = eigenbasis(input, GENERATE(0., 0.5), 8);
  Slow_mesh mesh(input, basis);
  Parameters parameters = Parameters::paper();
  parameters.placement = Spectral_placement_strategy::free;
  Core core = make_core(mesh, basis, parameters);
  std::mt19937 random(12);
  REQUIRE(simplify(core, mesh, 40, random) == 40);
  parameters.placement = Spectral_placement_strategy::on_edge;
  Core on_edge_core =
      make_core(mesh, Basis{mesh.F, mesh.Z, basis.lambda, basis.local, basis.area}, parameters);
  const double before = mesh.energy();
  int quadric_won = 0, better = 0;
  for(const Edge& e : mesh.edge_list()) {
    const Slot u = Slot(e.first), v = Slot(e.second);
    const Sample candidate = core.evaluate(u, v), d = on_edge_core.evaluate(u, v);
    if(!candidate.collapsible())
      continue;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for(const Eigen::Vector3i& t : mesh.triangles)
      for(const int w : {e.first, e.second})
        if(Slow_mesh::contains(t, w)) {
          const Eigen::Vector3d a = mesh.V.row(t(0)), b = mesh.V.row(t(1)), c = mesh.V.row(t(2));
          normal += (b - a).cross(c - a);
        }
    const auto slow = [&](const Eigen::Vector3d& x) {
      return mesh.energy_after(e, core.projected_weight(u, v, x), x) - before;
    };
    SMS::internal::Spectral_placement_quadric quadric;
    REQUIRE(quadric.set_frame(on_edge(mesh, e, 0), on_edge(mesh, e, 1), normal));
    double costs[10], best = d.cost;
    for(int s = 0; s < 10; ++s)
      best = (std::min)(best, costs[s] = slow(quadric.point(s)));
    if(const auto x = quadric.minimiser(costs)) {
      const double least = slow(*x);
      quadric_won += least < best;
      best = (std::min)(best, least);
    }
    CHECK(std::abs(candidate.cost - best) < 1e-8 * (std::abs(best) + before));
    CHECK(std::abs(candidate.cost - slow(candidate.point)) < 1e-9 * (std::abs(best) + before));
    CHECK(std::abs(candidate.weight - core.projected_weight(u, v, candidate.point)) < 1e-12);
    CHECK(candidate.cost <= d.cost + 1e-9 * before);
    better += candidate.cost < d.cost - 1e-6 * before;
  }
  CHECK(quadric_won > 10);
  CHECK(better > 50);
}

} // namespace test_free_placement
