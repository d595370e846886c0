// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The local cost without a mesh type: Spectral_collapse_core on rings that are made here, against a
// mesh that is a list of triangles and recomputes E globally.

#include "catch.h"
#include "core_helpers.h"

namespace test_kernel {

using namespace spectral_test;
using SMS::Spectral_placement_strategy;

TEST_CASE("The local cost of a collapse is the change of the global E, for every mass, point and "
          "kind of edge")
{
  const bool bordered = GENERATE(false, true);
  const double theta = GENERATE(0., 0.5, 0.3);
  const bool rough = GENERATE(false, true);
  CAPTURE(bordered, theta, rough);
  const shapes::Matrices input =
      scaled(bordered ? wavy_grid_matrices(15, 14) : shapes::bumpy_icosphere_matrices(2), 3.);
  const Basis basis =
      rough ? signal_basis(input, theta, rough_signals(input, 5)) : eigenbasis(input, theta, 10);
  Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis);
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
  const Basis basis = eigenbasis(input, theta, 5);
  Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis);
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
  const shapes::Matrices input =
      bordered ? wavy_grid_matrices(18, 16) : shapes::bumpy_icosphere_matrices(2);
  Basis basis = eigenbasis(input, theta, 10);
  Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis);
  std::mt19937 random(9);
  while(simplify(core, mesh, 10, random) == 10) { // down to the last edge that can be collapsed
    basis.F = mesh.F;
    basis.Z = mesh.Z;
    Core fresh = make_core(mesh, basis);
    CHECK(relative_difference(core.total(), fresh.total()) < 1e-9);
    double worst = 0;
    for(const Edge& e : mesh.edge_list()) {
      const Sample a = core.evaluate(Slot(e.first), Slot(e.second));
      const Sample b = fresh.evaluate(Slot(e.first), Slot(e.second));
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
  const bool bordered = GENERATE(false, true);
  const double theta = GENERATE(0., 0.5);
  const bool binary = GENERATE(false, true);
  const Spectral_placement_strategy placement =
      GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::midpoint,
               Spectral_placement_strategy::free);
  CAPTURE(bordered, theta, binary, int(placement));
  const shapes::Matrices input =
      bordered ? wavy_grid_matrices(16, 14) : shapes::bumpy_icosphere_matrices(2);
  const Basis basis = eigenbasis(input, theta, 9);
  Slow_mesh mesh(input, basis);
  Parameters parameters = Parameters::paper();
  parameters.binary = binary;
  parameters.placement = placement;
  Core core = make_core(mesh, basis, parameters);
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
  if(!binary && placement != Spectral_placement_strategy::free)
    CHECK(worst_v < 1e-12);
}

TEST_CASE(
    "A candidate on the edge is the best of three samples and the minimiser of their parabola")
{
  const shapes::Matrices input = wavy_grid_matrices(12, 11);
  const Basis basis = eigenbasis(input, 0.5, 8);
  Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis);
  std::mt19937 random(11);
  int minimisers = 0;
  for(const int collapses : {0, 40}) {
    simplify(core, mesh, collapses, random);
    const double before = mesh.energy();
    const std::vector<Edge> edges = mesh.edge_list();
    for(std::size_t i = 0; i < edges.size(); i += 5) {
      const Edge e = edges[i];
      const Sample c = core.evaluate(Slot(e.first), Slot(e.second));
      if(!c.collapsible())
        continue;
      const auto cost = [&](const double alpha) {
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
  const Basis basis = eigenbasis(input, 0, 6);
  const Slow_mesh mesh(input, basis);
  Parameters parameters = Parameters::paper();
  parameters.placement = Spectral_placement_strategy::midpoint;
  Core core = make_core(mesh, basis, parameters);
  for(const Edge& e : mesh.edge_list()) {
    const Sample c = core.evaluate(Slot(e.first), Slot(e.second));
    REQUIRE(c.collapsible());
    CHECK(c.weight == 0.5);
    CHECK((c.point - on_edge(mesh, e, 0.5)).norm() < 1e-15);
    CHECK(relative_difference(c.cost, mesh.energy_after(e, 0.5, c.point) - mesh.energy()) < 1e-9);
  }
}

TEST_CASE("Any number of signals is counted in full, whatever the padding of the blocks")
{
  const double theta = GENERATE(0., 0.5);
  const shapes::Matrices input = wavy_grid_matrices(8, 7);
  for(const Eigen::Index K : {1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 25, 33}) {
    CAPTURE(K);
    const Basis basis = signal_basis(input, theta, rough_signals(input, K));
    const Slow_mesh mesh(input, basis);
    Core core = make_core(mesh, basis);
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
  const Basis basis = eigenbasis(input, theta, 7);
  const Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis);
  for(const double scale : {1e-5, 1e5}) {
    const shapes::Matrices other = scaled(input, scale);
    const Basis other_basis = eigenbasis(other, theta, 7);
    Core other_core = make_core(Slow_mesh(other, other_basis), other_basis);
    for(const Edge& e : mesh.edge_list()) {
      const Sample a = core.evaluate(Slot(e.first), Slot(e.second));
      const Sample b = other_core.evaluate(Slot(e.first), Slot(e.second));
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
    const Basis constant = signal_basis(input, theta, signals.leftCols(1));
    const Slow_mesh constant_mesh(input, constant);
    Core constant_core = make_core(constant_mesh, constant);
    for(const Edge& e : constant_mesh.edge_list()) {
      const double cost =
          constant_core.cost_at(Slot(e.first), Slot(e.second), on_edge(constant_mesh, e, 0.3));
      CHECK((std::abs(cost) < 1e-10 || cost == infinity));
    }
  }
  // Lumped: the rows of Z inside do not feel those of the border.
  const Basis linear = signal_basis(input, 0, signals);
  const Slow_mesh mesh(input, linear);
  Core core = make_core(mesh, linear);
  const auto inside = [&](const int v) {
    return mesh.V.row(v).head(2).minCoeff() > 0.2 && mesh.V.row(v).head(2).maxCoeff() < 0.8;
  };
  int tested = 0;
  for(const Edge& e : mesh.edge_list())
    if(inside(e.first) && inside(e.second)) {
      const Slot u = Slot(e.first), v = Slot(e.second);
      const Eigen::Vector3d off = on_edge(mesh, e, 0.5) + 0.02 * Eigen::Vector3d(0.3, 0.1, 1);
      const double scale = core.cost_at(u, v, off);
      for(const double alpha : {0., 0.5, 0.8, 1.})
        CHECK(std::abs(core.cost_at(u, v, on_edge(mesh, e, alpha))) < 1e-9 * scale);
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
  const Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis);
  const double before = mesh.energy();
  double worst = 0;
  for(const Edge& e : mesh.edge_list()) {
    const double fast = core.cost_at(Slot(e.first), Slot(e.second), on_edge(mesh, e, 0.5));
    if(std::isfinite(fast)) {
      const double slow = mesh.energy_after(e, 0.5, on_edge(mesh, e, 0.5)) - before;
      worst = (std::max)(worst, std::abs(fast - slow) / (std::abs(slow) + 1e-8 * before));
    }
  }
  CHECK(worst < 1e-6);
}

TEST_CASE(
    "Weights are projections on the edge, cut off at its ends, and 1/2 where it has no length")
{
  shapes::Matrices input = shapes::grid_matrices(4, 4);
  const Basis basis = eigenbasis(input, 0, 3);
  input.V.row(12) = input.V.row(13);
  Core core = make_core(Slow_mesh(input, basis), basis);
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
  const Slow_mesh mesh(input, basis);
  const Eigen::VectorXd mass = SG::laplace_operator(input.V, input.T).mass;
  Parameters parameters = Parameters::paper();
  parameters.binary = true;
  Core core = make_core(mesh, basis, parameters);
  parameters.placement = Spectral_placement_strategy::midpoint;
  Core midpoint = make_core(mesh, basis, parameters);
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
    CHECK(relative_difference(c.cost, mesh.energy_after(e, c.weight, c.point) - mesh.energy()) <
          1e-9);
    CHECK(m.weight == (mass(v) > mass(u) ? 1. : 0.));
    CHECK(core.projected_weight(u, v, on_edge(mesh, e, 0.3)) == 0.);
    CHECK(core.projected_weight(v, u, on_edge(mesh, e, 0.3)) == 1.);
  }
  CHECK(inner > 5);

  // All masses alike, to the last bit: an octahedron.
  const shapes::Matrices octahedron = shapes::matrices(
      {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}});
  const Basis small = eigenbasis(octahedron, 0, 3);
  const Slow_mesh regular(octahedron, small);
  Core tied = make_core(regular, small, parameters);
  for(const Edge& e : regular.edge_list())
    CHECK(tied.evaluate(Slot(e.first), Slot(e.second)).weight == 0.);
}

TEST_CASE("preserve_border keeps the border vertex of an edge that has one, whole")
{
  const Spectral_placement_strategy placement =
      GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::midpoint,
               Spectral_placement_strategy::free);
  const shapes::Matrices input = wavy_grid_matrices(9, 8);
  const Basis basis = eigenbasis(input, 0, 7);
  const Slow_mesh mesh(input, basis);
  Parameters parameters = Parameters::paper();
  parameters.placement = placement;
  Core free = make_core(mesh, basis, parameters);
  parameters.preserve_border = true;
  Core core = make_core(mesh, basis, parameters);
  const std::map<Edge, int> faces = mesh.edges();
  int counts[number_of_kinds] = {};
  for(const Edge& e : mesh.edge_list()) {
    const Sample c = core.evaluate(Slot(e.first), Slot(e.second));
    if(!c.collapsible())
      continue;
    const Kind kind = mesh.kind(e, faces);
    ++counts[kind];
    if(kind == one_border_vertex) {
      CHECK(c.weight == (mesh.on_border(e.second, faces) ? 1. : 0.));
      CHECK(c.point == on_edge(mesh, e, c.weight));
      CHECK(relative_difference(c.cost, mesh.energy_after(e, c.weight, c.point) - mesh.energy()) <
            1e-9);
    } else if(kind == border_edge && placement == Spectral_placement_strategy::free) {
      CHECK((c.point - on_edge(mesh, e, c.weight)).norm() < 1e-14);
    } else
      CHECK(c.cost == free.evaluate(Slot(e.first), Slot(e.second)).cost);
  }
  CHECK(counts[one_border_vertex] > 20);
  CHECK(counts[border_edge] > 20);
  CHECK(counts[bridge] == 0);
}

TEST_CASE("A cost does not depend on the direction in which its edge is presented")
{
  const shapes::Matrices input = wavy_grid_matrices(9, 8);
  const Basis basis = eigenbasis(input, 0.5, 7);
  const Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis);
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
  const bool bordered = GENERATE(false, true);
  const shapes::Matrices input =
      bordered ? wavy_grid_matrices(13, 12) : shapes::bumpy_icosphere_matrices(2);
  const Basis basis = eigenbasis(input, 0.5, 10);
  Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis);
  std::mt19937 random(5);
  const auto same = [](const Sample& a, const Sample& b) {
    return a.cost == b.cost && a.weight == b.weight && a.point == b.point;
  };
  for(const int collapses : {0, 50, 50}) {
    REQUIRE(simplify(core, mesh, collapses, random) == collapses);
    const double E = core.total();
    std::vector<Sample> samples;
    for(const Edge& e : mesh.edge_list())
      samples.push_back(core.evaluate(Slot(e.first), Slot(e.second)));
    std::size_t i = 0;
    for(const Edge& e : mesh.edge_list()) {
      CHECK(same(core.evaluate(Slot(e.first), Slot(e.second)), samples[i]));
      CHECK(same(core.select(Slot(e.first), Slot(e.second)), samples[i]));
      // However old the vertices are, the right one is weighted.
      if(samples[i].collapsible())
        CHECK((samples[i].point - on_edge(mesh, e, samples[i].weight)).norm() < 1e-14);
      ++i;
    }
    CHECK(core.total() == E);
  }
}

TEST_CASE("Edges that must not be collapsed are no candidates")
{
  const auto candidate = [&](const shapes::Matrices& mesh, const Slot u, const Slot v) {
    const Basis basis = eigenbasis(mesh, 0, 2);
    return make_core(Slow_mesh(mesh, basis), basis).evaluate(u, v);
  };
  SECTION("a bridge between two borders")
  {
    const shapes::Matrices strip = shapes::grid_matrices(5, 1);
    CHECK_FALSE(candidate(strip, 2, 8).collapsible());
    CHECK(candidate(strip, 2, 3).collapsible());
  }
  SECTION("an edge of a triangle that is no face: the waist of two tetrahedra glued together")
  {
    const shapes::Matrices mesh =
        shapes::matrices({{1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.9, 0}, {0, 0, 1}, {0, 0, -1.1}},
                         {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 4}, {0, 2, 4}});
    CHECK_FALSE(candidate(mesh, 0, 1).collapsible());
    CHECK(candidate(mesh, 0, 3).collapsible());
  }
  SECTION("an edge whose collapse takes the last face of a vertex")
  {
    const shapes::Matrices ear = shapes::grid_matrices(2, 2); // vertex 2 has one face only
    CHECK_FALSE(candidate(ear, 1, 5).collapsible());
  }
}

TEST_CASE("A point that makes a triangle without area has an infinite cost")
{
  const shapes::Matrices input = shapes::grid_matrices(4, 4);
  const Basis basis = eigenbasis(input, 0, 3);
  Core core = make_core(Slow_mesh(input, basis), basis);
  CHECK(core.cost_at(12, 13, Eigen::Vector3d(0.25, 0.375, 0)) ==
        infinity);                                         // on the line of a link edge
  CHECK(core.cost_at(12, 13, input.V.row(7)) == infinity); // on a link vertex
  CHECK(core.cost_at(12, 13, Eigen::Vector3d(0.6, 0.5, 0)) < infinity);
}

TEST_CASE("E changes as was said where a collapse makes a needle, and where one stays")
{
  const double theta = GENERATE(0., 0.5), height = GENERATE(1e-11, 1e-12);
  CAPTURE(theta, height);
  const shapes::Matrices input = shapes::grid_matrices(4, 4);
  const Basis basis = signal_basis(input, theta, rough_signals(input, 3));
  Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis);
  const Sample needle{Eigen::Vector3d(0.25 + height, 0.375, 0), 0.3};
  CHECK(core.cost_at(12, 13, needle.point) == infinity);
  const double change = core.change_at(12, 13, needle.weight, needle.point), before = core.total();
  commit(core, mesh, {12, 13}, needle, true);
  CHECK(mesh.energy() > 1e16); // the square of a cotangent
  CHECK(relative_difference(core.total(), mesh.energy()) < 1e-9);
  CHECK(relative_difference(before + change, mesh.energy()) < 1e-9);

  // Another end of the needle moves along it.
  const Eigen::Vector3d point(0.25, 0.625, 0);
  const double slow = mesh.energy_after({11, 16}, 0.5, point) - mesh.energy();
  CHECK(relative_difference(core.cost_at(11, 16, point), slow) < 1e-9);
  CHECK(relative_difference(core.change_at(11, 16, 0.5, point), slow) < 1e-9);
}

TEST_CASE("A face without area contributes nothing to a cost")
{
  const double theta = GENERATE(0., 0.5);
  shapes::Matrices input = shapes::bumpy_icosphere_matrices(1);
  std::mt19937 random(2);
  // A vertex on top of a neighbour flattens the two faces at their edge.
  const Edge flat(input.T(9, 0), input.T(9, 1));
  input.V.row(flat.first) = input.V.row(flat.second);
  const Basis basis = eigenbasis(input, theta, 5);
  const Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis);
  CHECK(core.total() < 1e-12 * basis.Z.squaredNorm());
  const Edge sorted = std::minmax(flat.first, flat.second);
  const Eigen::Vector3d point = input.V.row(flat.second);
  const double slow = mesh.energy_after(sorted, 0.5, point) - mesh.energy();
  CHECK(relative_difference(core.cost_at(Slot(sorted.first), Slot(sorted.second), point), slow) <
        1e-9);
  int tested = 0;
  for(const Edge& e : mesh.edge_list()) {
    if(e == sorted || !mesh.link_condition(e))
      continue;
    const Eigen::Vector3d inner = on_edge(mesh, e, 0.4);
    const double fast = core.cost_at(Slot(e.first), Slot(e.second), inner);
    if(!std::isfinite(fast))
      continue;
    CHECK(relative_difference(fast, mesh.energy_after(e, 0.4, inner) - mesh.energy()) < 1e-9);
    ++tested;
  }
  CHECK(tested > 100);
}

} // namespace test_kernel
