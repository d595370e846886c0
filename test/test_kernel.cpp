// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The local cost without a mesh type: Spectral_collapse_core on rings that are made here, against a
// mesh that is a list of triangles and recomputes E globally.

#include "catch.h"
#include "core_helpers.h"

namespace test_kernel {

using namespace spectral_test;
using Placement = SMS::Spectral_placement_strategy;

namespace {

shapes::Matrices bordered_or_closed(const bool bordered, const int nx, const int ny)
{
  return bordered ? wavy_grid_matrices(nx, ny) : shapes::bumpy_icosphere_matrices(2);
}

std::pair<Slow_mesh, Core> slow_and_fast(const shapes::Matrices& input, const Basis& basis,
                                         const Parameters& parameters = Parameters::paper())
{
  const Slow_mesh mesh(input, basis);
  return {mesh, make_core(mesh, basis, parameters)};
}

Parameters parameters_with(const Placement placement, const bool binary = false)
{
  Parameters result = Parameters::paper();
  result.placement = placement;
  result.binary = binary;
  return result;
}

Sample evaluate(Core& core, const Edge& e)
{
  return core.evaluate(Slot(e.first), Slot(e.second));
}

double fast_cost(Core& core, const Edge& e, const Eigen::Vector3d& point)
{
  return core.cost_at(Slot(e.first), Slot(e.second), point);
}

double slow_cost(const Slow_mesh& mesh, const Edge& e, const double weight,
                 const Eigen::Vector3d& point)
{
  return mesh.energy_after(e, weight, point) - mesh.energy();
}

} // namespace

TEST_CASE("The local cost of a collapse is the change of the global E, for every mass, point and "
          "kind of edge")
{
  const bool bordered = GENERATE(false, true), rough = GENERATE(false, true);
  const double theta = GENERATE(0., 0.5, 0.3);
  CAPTURE(bordered, theta, rough);
  const shapes::Matrices input = scaled(bordered_or_closed(bordered, 15, 14), 3.);
  const Basis basis =
      rough ? signal_basis(input, theta, rough_signals(input, 5)) : eigenbasis(input, theta, 10);
  auto [mesh, core] = slow_and_fast(input, basis);
  std::mt19937 random(7);
  CHECK(core.total() < 1e-12 * basis.Z.squaredNorm());
  for(const int collapses : {0, 20, 40, 40}) {
    CHECK(simplify(core, mesh, collapses, random) == collapses);
    const Comparison comparison = compare_costs(core, mesh, 12, random);
    CHECK(comparison.worst < 1e-9);
    CHECK(comparison.counts[interior] == 12);
    CHECK(comparison.counts[border_edge] == (bordered ? 12 : 0));
    CHECK(comparison.counts[one_border_vertex] == (bordered ? 12 : 0));
  }
}

TEST_CASE(
    "The local cost is as exact beside a cap, whose cotangents square to more than doubles hold")
{
  const double theta = GENERATE(0., 0.5), height = GENERATE(1e-4, 1e-7, 1e-9);
  CAPTURE(theta, height);
  shapes::Matrices input = wavy_grid_matrices(8, 8);
  for(const int face : {40, 60, 85}) {
    const Eigen::RowVector3i t = input.T.row(face);
    input.V.row(t[1]) = (input.V.row(t[0]) + input.V.row(t[2])) / 2 + height * input.V.row(t[1]);
  }
  auto [mesh, core] = slow_and_fast(input, eigenbasis(input, theta, 5));
  std::mt19937 random(5);
  for(const int collapses : {0, 20}) {
    CHECK(simplify(core, mesh, collapses, random) == collapses);
    CHECK(compare_costs(core, mesh, 300, random).worst < 1e-6);
  }
}

TEST_CASE("Costs after many collapses are those of a state built afresh from the mesh")
{
  const bool bordered = GENERATE(false, true);
  const double theta = GENERATE(0., 0.5);
  CAPTURE(bordered, theta);
  const shapes::Matrices input = bordered_or_closed(bordered, 18, 16);
  Basis basis = eigenbasis(input, theta, 10);
  auto [mesh, core] = slow_and_fast(input, basis);
  std::mt19937 random(9);
  while(simplify(core, mesh, 10, random) == 10) { // down to the last edge that can be collapsed
    basis.F = mesh.F;
    basis.Z = mesh.Z;
    Core fresh = make_core(mesh, basis);
    CHECK(relative_difference(core.total(), fresh.total()) < 1e-9);
    double worst = 0;
    for(const Edge& e : mesh.edge_list()) {
      const Sample a = evaluate(core, e), b = evaluate(fresh, e);
      if(a.collapsible() != b.collapsible())
        worst = infinity;
      else if(a.collapsible())
        worst = (std::max)(worst, std::abs(a.cost - b.cost) / (std::abs(b.cost) + fresh.total()));
    }
    CHECK(worst < 1e-9);
  }
  CHECK(mesh.edge_list().size() < 60);
}

TEST_CASE("E, F and P follow the mesh through collapses in either direction")
{
  const bool bordered = GENERATE(false, true), binary = GENERATE(false, true);
  const double theta = GENERATE(0., 0.5);
  const Placement placement = GENERATE(Placement::on_edge, Placement::midpoint, Placement::free);
  CAPTURE(bordered, theta, binary, int(placement));
  const shapes::Matrices input = bordered_or_closed(bordered, 16, 14);
  const Basis basis = eigenbasis(input, theta, 9);
  auto [mesh, core] = slow_and_fast(input, basis, parameters_with(placement, binary));
  std::mt19937 random(3);
  const int collapses = int(input.V.rows()) - 40;
  CHECK(simplify(core, mesh, collapses, random) == collapses);
  const Eigen::VectorXd E = mesh.vertex_energies();
  CHECK((core.fields().E - E).cwiseAbs().maxCoeff() < 1e-9 * E.sum());
  CHECK(relative_difference(core.total(), E.sum()) < 1e-9);
  const std::vector<Eigen::Index> slots = core.log().forest().kept_slots();
  const Eigen::SparseMatrix<double> P = core.log().forest().restriction(slots);
  CHECK(fault_of_restriction(P, core.log().forest().vertex_map(slots), binary) == "");
  const Eigen::MatrixXd PF = P * basis.F, PV = P * input.V;
  double worst_f = 0, worst_slow = 0, worst_v = 0;
  for(std::size_t i = 0; i < slots.size(); ++i) {
    const Eigen::RowVectorXd f = tracked_signals(core.fields(), slots[i]);
    worst_f = (std::max)(worst_f, (PF.row(i) - f).cwiseAbs().maxCoeff());
    worst_slow = (std::max)(worst_slow, (mesh.F.row(slots[i]) - f).cwiseAbs().maxCoeff());
    worst_v = (std::max)(
        worst_v, (PV.row(i) - core.fields().points[slots[i]].transpose()).cwiseAbs().maxCoeff());
  }
  CHECK(worst_f < 1e-12);
  CHECK(worst_slow < 1e-12);
  if(!binary && placement != Placement::free)
    CHECK(worst_v < 1e-12);
}

TEST_CASE(
    "A candidate on the edge is the best of three samples and the minimiser of their parabola")
{
  const shapes::Matrices input = wavy_grid_matrices(12, 11);
  auto [mesh, core] = slow_and_fast(input, eigenbasis(input, 0.5, 8));
  std::mt19937 random(11);
  int minimisers = 0;
  for(const int collapses : {0, 40}) {
    simplify(core, mesh, collapses, random);
    const double before = mesh.energy();
    const std::vector<Edge> edges = mesh.edge_list();
    for(std::size_t i = 0; i < edges.size(); i += 5) {
      const Edge e = edges[i];
      const Sample c = evaluate(core, e);
      if(!c.collapsible())
        continue;
      const auto cost = [&, &mesh = mesh](const double alpha) {
        return mesh.energy_after(e, alpha, on_edge(mesh, e, alpha)) - before;
      };
      const double s0 = cost(0), s1 = cost(0.5), s2 = cost(1);
      double best = (std::min)({s0, s1, s2});
      const double a = 2 * s0 - 4 * s1 + 2 * s2, b = 4 * s1 - 3 * s0 - s2, alpha = -b / (2 * a);
      if(a > 0 && alpha > 0 && alpha < 1 && std::isfinite(a) && cost(alpha) < best) {
        best = cost(alpha);
        ++minimisers;
      }
      CHECK(std::abs(c.cost - best) < 1e-9 * (std::abs(best) + before));
      CHECK((c.point - on_edge(mesh, e, c.weight)).norm() < 1e-14);
      CHECK(std::abs(cost(c.weight) - c.cost) < 1e-9 * (std::abs(best) + before));
    }
  }
  CHECK(minimisers > 10);
}

TEST_CASE("A midpoint candidate lies in the middle and weighs both ends alike")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(1);
  auto [mesh, core] =
      slow_and_fast(input, eigenbasis(input, 0, 6), parameters_with(Placement::midpoint));
  for(const Edge& e : mesh.edge_list()) {
    const Sample c = evaluate(core, e);
    REQUIRE(c.collapsible());
    CHECK(c.weight == 0.5);
    CHECK((c.point - on_edge(mesh, e, 0.5)).norm() < 1e-15);
    CHECK(relative_difference(c.cost, slow_cost(mesh, e, 0.5, c.point)) < 1e-9);
  }
}

TEST_CASE("Any number of signals is counted in full, whatever the padding of the blocks")
{
  const double theta = GENERATE(0., 0.5);
  const shapes::Matrices input = wavy_grid_matrices(8, 7);
  for(const Eigen::Index K : {1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 25, 33}) {
    CAPTURE(K);
    auto [mesh, core] = slow_and_fast(input, signal_basis(input, theta, rough_signals(input, K)));
    std::mt19937 random(1);
    CHECK(core.fields().signals.size() == K);
    CHECK(core.fields().signals.number_of_blocks() == (K + 15) / 16);
    CHECK(compare_costs(core, mesh, 3, random).worst < 1e-9);
  }
}

TEST_CASE("Costs do not depend on the scale of the mesh")
{
  const double theta = GENERATE(0., 0.5);
  const shapes::Matrices input = wavy_grid_matrices(9, 8);
  auto [mesh, core] = slow_and_fast(input, eigenbasis(input, theta, 7));
  for(const double scale : {1e-5, 1e5}) {
    const shapes::Matrices other = scaled(input, scale);
    Core other_core = slow_and_fast(other, eigenbasis(other, theta, 7)).second;
    for(const Edge& e : mesh.edge_list()) {
      const Sample a = evaluate(core, e), b = evaluate(other_core, e);
      CHECK(a.collapsible() == b.collapsible());
      if(a.collapsible())
        CHECK(relative_difference(a.cost, b.cost) < 1e-7);
    }
  }
}

TEST_CASE("A constant signal costs nothing, nor does a linear one inside a plane")
{
  const shapes::Matrices input = shapes::irregular_grid_matrices(9, 9);
  Eigen::MatrixXd signals(input.V.rows(), 3);
  signals << Eigen::VectorXd::Ones(input.V.rows()), input.V.leftCols(2);
  for(const double theta : {0., 0.5}) {
    auto [mesh, core] = slow_and_fast(input, signal_basis(input, theta, signals.leftCols(1)));
    for(const Edge& e : mesh.edge_list()) {
      const double cost = fast_cost(core, e, on_edge(mesh, e, 0.3));
      CHECK((std::abs(cost) < 1e-10 || cost == infinity));
    }
  }
  // Lumped: the rows of Z inside do not feel those of the border.
  auto [mesh, core] = slow_and_fast(input, signal_basis(input, 0, signals));
  const auto inside = [&](const int v) {
    return input.V.row(v).head(2).minCoeff() > 0.2 && input.V.row(v).head(2).maxCoeff() < 0.8;
  };
  int tested = 0;
  for(const Edge& e : mesh.edge_list())
    if(inside(e.first) && inside(e.second)) {
      const Eigen::Vector3d off = on_edge(mesh, e, 0.5) + 0.02 * Eigen::Vector3d(0.3, 0.1, 1);
      const double scale = fast_cost(core, e, off);
      for(const double alpha : {0., 0.5, 0.8, 1.})
        CHECK(std::abs(fast_cost(core, e, on_edge(mesh, e, alpha))) < 1e-9 * scale);
      ++tested;
    }
  CHECK(tested > 20);
}

TEST_CASE("Costs are accurate on a mesh that is fine for its signals")
{
  // A patch of a mesh of 40,000 vertices and unit area. The cost is the change of a small
  // difference of large terms.
  const double theta = GENERATE(0., 0.5);
  const int wave = GENERATE(0, 1, 3, 10);
  const bool steep = GENERATE(false, true);
  CAPTURE(theta, wave, steep);
  shapes::Matrices input = scaled(wavy_grid_matrices(10, 10), 0.05);
  input.V.col(2) *= steep ? 4. : 0.1;
  Basis basis;
  basis.local = theta;
  const double pi = shapes::pi;
  basis.F.resize(input.V.rows(), 2);
  basis.F.col(0) = std::sqrt(2.) * (pi * wave * input.V.col(0).array() + 0.4).cos();
  basis.F.col(1) = 2. * (pi * wave * input.V.col(0).array()).cos() *
                   (pi * (wave + 1) * input.V.col(1).array() + 1).cos();
  basis.lambda = pi * pi * Eigen::Vector2d(wave * wave, wave * wave + (wave + 1) * (wave + 1));
  basis.Z = basis.F * basis.lambda.asDiagonal();
  auto [mesh, core] = slow_and_fast(input, basis);
  const double before = mesh.energy();
  double worst = 0;
  int seen = 0;
  for(const Edge& e : mesh.edge_list()) {
    const double fast = fast_cost(core, e, on_edge(mesh, e, 0.5));
    if(std::isfinite(fast)) {
      ++seen;
      const double slow = mesh.energy_after(e, 0.5, on_edge(mesh, e, 0.5)) - before;
      worst = (std::max)(worst, std::abs(fast - slow) / (std::abs(slow) + 1e-8 * before));
    }
  }
  CHECK(worst < 1e-6);
  CHECK(seen > 50);
}

TEST_CASE(
    "Weights are projections on the edge, cut off at its ends, and 1/2 where it has no length")
{
  shapes::Matrices input = shapes::grid_matrices(4, 4);
  const Basis basis = eigenbasis(input, 0, 3);
  input.V.row(12) = input.V.row(13);
  const Core core = slow_and_fast(input, basis).second;
  CHECK(core.projected_weight(6, 7, Eigen::Vector3d(0.25 + 0.0625, 0.7, 3)) == Catch::Approx(0.25));
  CHECK(core.projected_weight(7, 6, Eigen::Vector3d(0.25 + 0.0625, 0.7, 3)) == Catch::Approx(0.75));
  CHECK(core.projected_weight(6, 7, Eigen::Vector3d(-1, 0, 0)) == 0);
  CHECK(core.projected_weight(6, 7, Eigen::Vector3d(2, 0, 0)) == 1);
  CHECK(core.projected_weight(12, 13, Eigen::Vector3d(2, 0, 0)) == 0.5);
}

TEST_CASE(
    "Binary weights round to the nearer end; a tie keeps the larger mass, then the smaller index")
{
  const shapes::Matrices input = wavy_grid_matrices(9, 8);
  const Basis basis = eigenbasis(input, 0.5, 7);
  const Eigen::VectorXd mass = SG::laplace_operator(input.V, input.T).mass;
  const Parameters at_midpoint = parameters_with(Placement::midpoint, true);
  auto [mesh, core] = slow_and_fast(input, basis, parameters_with(Placement::on_edge, true));
  Core midpoint = make_core(mesh, basis, at_midpoint);
  int inner = 0;
  for(const Edge& e : mesh.edge_list()) {
    const Slot u = Slot(e.first), v = Slot(e.second);
    const Sample c = core.evaluate(u, v), m = midpoint.evaluate(u, v);
    if(!c.collapsible() || !m.collapsible())
      continue;
    const double alpha =
        (c.point - on_edge(mesh, e, 0)).norm() / (on_edge(mesh, e, 1) - on_edge(mesh, e, 0)).norm();
    if(std::abs(alpha - 0.5) > 1e-9)
      CHECK(c.weight == (alpha < 0.5 ? 0. : 1.));
    inner += alpha > 0.01 && alpha < 0.99;
    CHECK(relative_difference(c.cost, slow_cost(mesh, e, c.weight, c.point)) < 1e-9);
    CHECK(m.weight == (mass(v) > mass(u) ? 1. : 0.));
    CHECK(core.projected_weight(u, v, on_edge(mesh, e, 0.3)) == 0.);
    CHECK(core.projected_weight(v, u, on_edge(mesh, e, 0.3)) == 1.);
  }
  CHECK(inner > 5);

  // All masses alike, to the last bit: an octahedron.
  const shapes::Matrices octahedron = shapes::matrices(
      {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}});
  auto [regular, tied] = slow_and_fast(octahedron, eigenbasis(octahedron, 0, 3), at_midpoint);
  for(const Edge& e : regular.edge_list())
    CHECK(evaluate(tied, e).weight == 0.);
}

TEST_CASE("preserve_border keeps the border vertex of an edge that has one, whole")
{
  const Placement placement = GENERATE(Placement::on_edge, Placement::midpoint, Placement::free);
  const shapes::Matrices input = wavy_grid_matrices(9, 8);
  const Basis basis = eigenbasis(input, 0, 7);
  Parameters parameters = parameters_with(placement);
  auto [mesh, free] = slow_and_fast(input, basis, parameters);
  parameters.preserve_border = true;
  Core core = make_core(mesh, basis, parameters);
  const std::map<Edge, int> faces = mesh.edges();
  int counts[number_of_kinds] = {};
  for(const Edge& e : mesh.edge_list()) {
    const Sample c = evaluate(core, e);
    if(!c.collapsible())
      continue;
    const Kind kind = mesh.kind(e, faces);
    ++counts[kind];
    if(kind == one_border_vertex) {
      CHECK(c.weight == (mesh.on_border(e.second, faces) ? 1. : 0.));
      CHECK(c.point == on_edge(mesh, e, c.weight));
      CHECK(relative_difference(c.cost, slow_cost(mesh, e, c.weight, c.point)) < 1e-9);
    } else if(kind == border_edge && placement == Placement::free)
      CHECK((c.point - on_edge(mesh, e, c.weight)).norm() < 1e-14);
    else
      CHECK(c.cost == evaluate(free, e).cost);
  }
  CHECK(counts[one_border_vertex] > 20);
  CHECK(counts[border_edge] > 20);
  CHECK(counts[bridge] == 0);
}

TEST_CASE("A cost does not depend on the direction in which its edge is presented")
{
  const shapes::Matrices input = wavy_grid_matrices(9, 8);
  auto [mesh, core] = slow_and_fast(input, eigenbasis(input, 0.5, 7));
  for(const Edge& e : mesh.edge_list()) {
    const Slot u = Slot(e.first), v = Slot(e.second);
    const Sample c = core.evaluate(u, v);
    if(!c.collapsible())
      continue;
    CHECK(relative_difference(core.cost_at(u, v, c.point), c.cost) < 1e-9);
    const Eigen::Vector3d point = on_edge(mesh, e, 0.3);
    CHECK(relative_difference(core.cost_at(u, v, point), core.cost_at(v, u, point)) < 1e-9);
    CHECK(relative_difference(core.change_at(u, v, 0.3, point), core.change_at(v, u, 0.7, point)) <
          1e-9);
  }
}

TEST_CASE("An evaluation changes nothing: another one, or that of the edge whose turn has come, "
          "finds the same")
{
  const shapes::Matrices input = bordered_or_closed(GENERATE(false, true), 13, 12);
  auto [mesh, core] = slow_and_fast(input, eigenbasis(input, 0.5, 10));
  std::mt19937 random(5);
  const auto same = [](const Sample& a, const Sample& b) {
    return a.cost == b.cost && a.weight == b.weight && a.point == b.point;
  };
  for(const int collapses : {0, 50, 50}) {
    REQUIRE(simplify(core, mesh, collapses, random) == collapses);
    const double E = core.total();
    std::vector<Sample> samples;
    for(const Edge& e : mesh.edge_list())
      samples.push_back(evaluate(core, e));
    auto sample = samples.begin();
    for(const Edge& e : mesh.edge_list()) {
      CHECK(same(evaluate(core, e), *sample));
      CHECK(same(core.select(Slot(e.first), Slot(e.second)), *sample));
      // However old the vertices are, the right one is weighted.
      if(sample->collapsible())
        CHECK((sample->point - on_edge(mesh, e, sample->weight)).norm() < 1e-14);
      ++sample;
    }
    CHECK(core.total() == E);
  }
}

TEST_CASE("Edges that must not be collapsed are no candidates")
{
  const auto collapsible = [](const shapes::Matrices& mesh, const Edge& e) {
    Core core = slow_and_fast(mesh, eigenbasis(mesh, 0, 2)).second;
    return evaluate(core, e).collapsible();
  };
  // A bridge between two borders.
  const shapes::Matrices strip = shapes::grid_matrices(5, 1);
  CHECK_FALSE(collapsible(strip, {2, 8}));
  CHECK(collapsible(strip, {2, 3}));
  // An edge of a triangle that is no face: the waist of two tetrahedra glued together.
  const shapes::Matrices glued =
      shapes::matrices({{1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.9, 0}, {0, 0, 1}, {0, 0, -1.1}},
                       {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 4}, {0, 2, 4}});
  CHECK_FALSE(collapsible(glued, {0, 1}));
  CHECK(collapsible(glued, {0, 3}));
  // An edge whose collapse takes the last face of vertex 2, which has one only.
  CHECK_FALSE(collapsible(shapes::grid_matrices(2, 2), {1, 5}));
}

TEST_CASE("A point that makes a triangle without area has an infinite cost")
{
  const shapes::Matrices input = shapes::grid_matrices(4, 4);
  Core core = slow_and_fast(input, eigenbasis(input, 0, 3)).second;
  const Eigen::Vector3d on_line_of_link_edge(0.25, 0.375, 0), on_link_vertex = input.V.row(7);
  CHECK(core.cost_at(12, 13, on_line_of_link_edge) == infinity);
  CHECK(core.cost_at(12, 13, on_link_vertex) == infinity);
  CHECK(core.cost_at(12, 13, Eigen::Vector3d(0.6, 0.5, 0)) < infinity);
}

TEST_CASE("E changes as was said where a collapse makes a needle, and where one stays")
{
  const double theta = GENERATE(0., 0.5), height = GENERATE(1e-11, 1e-12);
  CAPTURE(theta, height);
  const shapes::Matrices input = shapes::grid_matrices(4, 4);
  auto [mesh, core] = slow_and_fast(input, signal_basis(input, theta, rough_signals(input, 3)));
  const Sample needle{Eigen::Vector3d(0.25 + height, 0.375, 0), 0.3};
  CHECK(core.cost_at(12, 13, needle.point) == infinity);
  const double change = core.change_at(12, 13, needle.weight, needle.point), before = core.total();
  commit(core, mesh, {12, 13}, needle, true);
  CHECK(mesh.energy() > 1e16); // the square of a cotangent
  CHECK(relative_difference(core.total(), mesh.energy()) < 1e-9);
  CHECK(relative_difference(before + change, mesh.energy()) < 1e-9);

  // Another end of the needle moves along it.
  const Eigen::Vector3d point(0.25, 0.625, 0);
  const double slow = slow_cost(mesh, {11, 16}, 0.5, point);
  CHECK(relative_difference(core.cost_at(11, 16, point), slow) < 1e-9);
  CHECK(relative_difference(core.change_at(11, 16, 0.5, point), slow) < 1e-9);
}

TEST_CASE("A face without area contributes nothing to a cost")
{
  const double theta = GENERATE(0., 0.5);
  shapes::Matrices input = shapes::bumpy_icosphere_matrices(1);
  // A vertex on top of a neighbour flattens the two faces at their edge.
  const Edge flat = std::minmax(input.T(9, 0), input.T(9, 1));
  input.V.row(input.T(9, 0)) = input.V.row(input.T(9, 1));
  const Basis basis = eigenbasis(input, theta, 5);
  auto [mesh, core] = slow_and_fast(input, basis);
  CHECK(core.total() < 1e-12 * basis.Z.squaredNorm());
  const Eigen::Vector3d point = input.V.row(flat.first);
  CHECK(relative_difference(fast_cost(core, flat, point), slow_cost(mesh, flat, 0.5, point)) <
        1e-9);
  int tested = 0;
  for(const Edge& e : mesh.edge_list()) {
    if(e == flat || !mesh.link_condition(e))
      continue;
    const Eigen::Vector3d inner = on_edge(mesh, e, 0.4);
    const double fast = fast_cost(core, e, inner);
    if(!std::isfinite(fast))
      continue;
    CHECK(relative_difference(fast, slow_cost(mesh, e, 0.4, inner)) < 1e-9);
    ++tested;
  }
  CHECK(tested > 100);
}

} // namespace test_kernel
