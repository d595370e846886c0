// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The log of a run, and the mesh and P at any size from it.

#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include <CGAL/Polyhedron_3.h>
#include <CGAL/Polyhedron_items_with_id_3.h>

#include "catch.h"
#include "collapse_helpers.h"

namespace test_levels {

using namespace spectral_test;
using Result = SMS::Spectral_edge_collapse_result;
using SMS::Spectral_edge_collapse_options;
using SMS::Spectral_placement_strategy;

namespace {

// Edges without length here and there.
shapes::Matrices with_zero_length_edges(shapes::Matrices input)
{
  for(const int f : {100, 300, 500})
    input.V.row(input.T(f, 0)) = input.V.row(input.T(f, 1));
  return input;
}

bool same_matrix(const Eigen::SparseMatrix<double>& a, const Eigen::SparseMatrix<double>& b)
{
  return Eigen::MatrixXd(a) == Eigen::MatrixXd(b);
}

} // namespace

TEST_CASE("A level replayed from the log is what a direct run to it gives: mesh and P")
{
  const bool bordered = GENERATE(false, true);
  Spectral_edge_collapse_options options = options_with(10);
  options.placement =
      GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::midpoint);
  options.binary = GENERATE(false, true);
  const shapes::Matrices input = with_zero_length_edges(
      bordered ? wavy_grid_matrices(20, 18) : shapes::bumpy_icosphere_matrices(3));
  const Mesh fine = make_mesh(input);
  Mesh mesh = fine, copy = fine;
  const Result result = SMS::spectral_edge_collapse(mesh, 40, options);
  options.eigenpairs = result.eigenpairs;
  const std::size_t n = result.input_vertices;
  CHECK(result.log.number_of_vertices() == n);
  CHECK(result.log.number_of_vertices_left() == 40);
  SMS::Collapse_replay<Mesh> replay(copy, result.log);
  for(const std::size_t N : {n, n - 3, std::size_t(300), std::size_t(123), std::size_t(40)}) {
    CAPTURE(bordered, N);
    replay.collapse_to(N);
    CHECK(replay.number_of_vertices() == N);
    CHECK(count_vertices(copy) == N);
    if(N < n) { // a run merges the edges without length whatever its target is
      Mesh direct = fine;
      const Result expected = SMS::spectral_edge_collapse(direct, N, options);
      CHECK(identical(copy, direct));
      CHECK(same_matrix(replay.restriction(), expected.restriction));
      CHECK(same_matrix(result.log.restriction(N), expected.restriction));
      CHECK(replay.vertex_map() == expected.vertex_map);
      CHECK(result.log.vertex_map(N) == expected.vertex_map);
    } else {
      CHECK(identical(copy, fine));
      CHECK(same_matrix(replay.restriction(),
                        Eigen::MatrixXd::Identity(Eigen::Index(n), Eigen::Index(n)).sparseView()));
    }
  }
  CHECK(identical(copy, mesh));
}

TEST_CASE("Levels of both stages, under edge constraints, with vertices to keep")
{
  Mesh fine = make_mesh(shapes::bumpy_icosphere_matrices(3));
  auto constraints = fine.add_property_map<Mesh::Edge_index, bool>("e:constrained", false).first;
  for(const auto e : edges(fine))
    constraints[e] = e.idx() % 60 == 0;
  const auto constrained = [](Mesh& m) { // that of the copy, which is there already
    return CGAL::parameters::edge_is_constrained_map(
        m.add_property_map<Mesh::Edge_index, bool>("e:constrained", false).first);
  };
  Spectral_edge_collapse_options options = options_with(10);
  options.kept_vertices = every(50, 642);
  options.pre_simplify = 400;
  Mesh mesh = fine, copy = fine;
  const Result result = SMS::spectral_edge_collapse(mesh, 150, options, constrained(mesh));
  CHECK(result.output_vertices == 150);
  CHECK(result.log.number_of_vertices() == 642);
  const auto np = constrained(copy);
  SMS::Collapse_replay replay(copy, result.log, np);
  for(const std::size_t N : {500, 400, 250, 150}) {
    CAPTURE(N);
    replay.collapse_to(N);
    CHECK(CGAL::is_valid_polygon_mesh(copy));
    if(N == 500) { // the first stage stops at 400 only
      options.pre_simplify = 500;
      Mesh direct = fine;
      const Result expected = SMS::spectral_edge_collapse(direct, N, options, constrained(direct));
      CHECK(identical(copy, direct));
      CHECK(same_matrix(replay.restriction(), expected.restriction));
      options.pre_simplify = 400;
    } else {
      Mesh direct = fine;
      const Result expected = SMS::spectral_edge_collapse(direct, N, options, constrained(direct));
      CHECK(identical(copy, direct));
      CHECK(same_matrix(replay.restriction(), expected.restriction));
    }
  }
}

TEST_CASE("Garbage may be collected between two levels, and another mesh type replays the same log")
{
  using Polyhedron = CGAL::Polyhedron_3<Kernel, CGAL::Polyhedron_items_with_id_3>;
  const shapes::Matrices input = with_zero_length_edges(wavy_grid_matrices(20, 18));
  Mesh mesh = make_mesh(input), copy = mesh;
  const Result result = SMS::spectral_edge_collapse(mesh, 60, options_with(10));
  SMS::Collapse_replay<Mesh> replay(copy, result.log);
  replay.collapse_to(200);
  copy.collect_garbage();
  CHECK(position_error(replay.restriction(), input.V, positions(copy)) < 1e-12);
  replay.collapse_to(60);
  copy.collect_garbage();
  CHECK(fault_of_result(copy, replay.restriction(), replay.vertex_map(), input) == "");

  Polyhedron polyhedron;
  shapes::make_mesh(polyhedron, input);
  SMS::Collapse_replay<Polyhedron> on_polyhedron(polyhedron, result.log);
  on_polyhedron.collapse_to(60);
  CHECK(CGAL::is_valid_polygon_mesh(polyhedron));
  CHECK(position_error(on_polyhedron.restriction(), input.V, SG::mesh_matrices(polyhedron).V) <
        1e-12);
  const auto sorted = [](const Eigen::MatrixXd& V) {
    std::vector<std::array<double, 3>> points;
    for(Eigen::Index i = 0; i < V.rows(); ++i)
      points.push_back({V(i, 0), V(i, 1), V(i, 2)});
    std::sort(points.begin(), points.end());
    return points;
  };
  CHECK(sorted(SG::mesh_matrices(polyhedron).V) == sorted(positions(mesh)));
  CHECK(sorted(positions(copy)) == sorted(positions(mesh)));
}

TEST_CASE("A Polyhedron_3 is replayed as it was run")
{
  using Polyhedron = CGAL::Polyhedron_3<Kernel, CGAL::Polyhedron_items_with_id_3>;
  Polyhedron mesh;
  shapes::make_mesh(mesh, shapes::bumpy_icosphere_matrices(2));
  Polyhedron copy = mesh;
  const Result result = SMS::spectral_edge_collapse(mesh, 40, options_with(8));
  SMS::Collapse_replay<Polyhedron> replay(copy, result.log);
  replay.collapse_to(40);
  const shapes::Matrices a = SG::mesh_matrices(mesh), b = SG::mesh_matrices(copy);
  CHECK(a.V == b.V);
  CHECK(a.T == b.T);
  CHECK(same_matrix(replay.restriction(), result.restriction));
}

TEST_CASE("The log says what it cannot do")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  Mesh mesh = make_mesh(input), copy = mesh;
  const Result result = SMS::spectral_edge_collapse(mesh, 60, options_with(8));
  const SMS::Collapse_log& log = result.log;
  CHECK_THROWS_AS(log.restriction(59), std::invalid_argument);
  CHECK_THROWS_WITH(log.restriction(163), ContainsSubstring("from 60 to 162"));
  CHECK_THROWS_WITH(SMS::Collapse_replay<Mesh>(mesh, log), ContainsSubstring("60 vertices"));
  SMS::Collapse_replay<Mesh> replay(copy, log);
  replay.collapse_to(100);
  CHECK_THROWS_WITH(replay.collapse_to(101), ContainsSubstring("from fine to coarse"));
  CHECK_THROWS_AS(replay.collapse_to(59), std::invalid_argument);
  CHECK(count_vertices(copy) == 100);
  copy.add_vertex();
  CHECK_THROWS_WITH(replay.collapse_to(60), ContainsSubstring("was not there"));
  Mesh stranger = make_mesh(wavy_grid_matrices(17, 8)); // as many vertices
  REQUIRE(count_vertices(stranger) == 162);
  SMS::Collapse_replay<Mesh> wrong(stranger, log);
  CHECK_THROWS_WITH(wrong.collapse_to(60), ContainsSubstring("not joined"));
  CHECK(CGAL::is_valid_polygon_mesh(stranger));

  SMS::Collapse_log first(4), second(2);
  first.merge(0, 1, 0.5, Eigen::Vector3d::Zero());
  CHECK_THROWS_WITH(first.append(second, {2, 3}), ContainsSubstring("3 are left"));
  CHECK_THROWS_AS(SMS::Collapse_log(first.forest(), {}), std::invalid_argument);
}

} // namespace test_levels
