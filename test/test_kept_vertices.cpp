// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Vertices that survive in place.

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Feature_vertices_map.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include "catch.h"
#include "collapse_helpers.h"

namespace test_kept_vertices {

using namespace spectral_test;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;
using Result = SMS::Spectral_edge_collapse_result;
using SMS::Spectral_edge_collapse_options;
using SMS::Spectral_placement_strategy;

TEST_CASE("Vertices to keep survive with their position and their values")
{
  const bool bordered = GENERATE(false, true);
  Spectral_edge_collapse_options options = options_with(10);
  options.placement =
      GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::midpoint);
  options.binary = GENERATE(false, true);
  options.preserve_border = bordered;
  const bool as_map = GENERATE(false, true);
  CAPTURE(bordered, int(options.placement), options.binary, as_map);
  const shapes::Matrices input =
      bordered ? wavy_grid_matrices(20, 18) : shapes::bumpy_icosphere_matrices(3);
  const std::vector<std::size_t> kept = every(17, input.V.rows(), 3);
  Mesh mesh = make_mesh(input);

  auto flags = mesh.add_property_map<Mesh::Vertex_index, bool>("v:kept", false).first;
  if(as_map)
    for(const std::size_t i : kept)
      flags[Mesh::Vertex_index(Mesh::size_type(i))] = true;
  else
    options.kept_vertices = kept;
  const Policies policies(mesh, options, CGAL::parameters::vertex_is_constrained_map(flags));
  collapse(mesh, policies, 60);
  CHECK(count_vertices(mesh) == 60);
  CHECK(survivors(kept, input, mesh, policies.restriction(), policies.vertex_map()) == kept.size());
  const Input fine = eigen_input(input, SG::Mass::lumped, *policies.eigenpairs());
  CHECK(fault_of_run(mesh, policies, fine, Check{options.binary, true, 1e-8}) == "");

  // They would not by themselves.
  Mesh other = make_mesh(input);
  options.kept_vertices.clear();
  const Policies free(other, options);
  collapse(other, free, 60);
  CHECK(survivors(kept, input, other, free.restriction(), free.vertex_map()) < kept.size() / 2);
}

TEST_CASE("A second run keeps the vertices of the first")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  Spectral_edge_collapse_options options = options_with(10);
  options.kept_vertices = every(20, 642);
  const Policies policies(mesh, options);
  for(const std::size_t N : {300, 100}) {
    collapse(mesh, policies, N);
    mesh.collect_garbage();
    CHECK(survivors(options.kept_vertices, input, mesh, policies.restriction(),
                    policies.vertex_map()) == 33);
  }
}

TEST_CASE("Vertices to keep are more than the target: the run ends when nothing else is left")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  Spectral_edge_collapse_options options = options_with(5);
  options.kept_vertices = every(8, 642);
  const Result result = SMS::spectral_edge_collapse(mesh, 40, options);
  CHECK(result.stop_reason == Result::Stop_reason::queue_exhausted);
  CHECK(result.output_vertices >= options.kept_vertices.size());
  CHECK(result.output_vertices < 2 * options.kept_vertices.size());
  CHECK(survivors(options.kept_vertices, input, mesh, result.restriction, result.vertex_map) == 81);
  CHECK(result.refusals.placement > 0);
  CHECK_THAT(result.explanation, ContainsSubstring("constrain and keep less"));
}

TEST_CASE("What CGAL's test of faces holds is not put down to constraints alone")
{
  const int n = 24; // a lens of two sheets, whose faces meet within a degree at the rim
  shapes::Matrices lens{Eigen::MatrixXd::Zero(n + 2, 3), Eigen::MatrixXi(2 * n, 3)};
  for(int k = 0; k < n; ++k) {
    lens.V.row(k) << std::cos(2 * CGAL_PI * k / n), std::sin(2 * CGAL_PI * k / n), 0;
    lens.T.row(2 * k) << n, k, (k + 1) % n;
    lens.T.row(2 * k + 1) << n + 1, (k + 1) % n, k;
  }
  lens.V(n, 2) = 1e-3;
  lens.V(n + 1, 2) = -1e-3;
  Mesh mesh = make_mesh(lens);
  const Result result = SMS::spectral_edge_collapse(mesh, 12, options_with(3));
  CHECK(result.output_vertices > 12);
  CHECK(result.refusals.geometry > result.refusals.placement);
  CHECK_THAT(result.explanation, ContainsSubstring("at the rim of a thin body"));
}

TEST_CASE("Vertices to keep and edge constraints hold at the same time, in one stage or two")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  Spectral_edge_collapse_options options = options_with(10);
  options.pre_simplify = GENERATE(0, 400);
  CAPTURE(options.pre_simplify);
  auto constraints = mesh.add_property_map<Mesh::Edge_index, bool>("e:constrained", false).first;
  std::set<Kernel::Point_3> ends, after;
  for(const auto e : edges(mesh))
    if(e.idx() % 60 == 0) {
      constraints[e] = true;
      ends.insert({mesh.point(source(e, mesh)), mesh.point(target(e, mesh))});
    }
  // Next to the constrained edges: there the two must disagree.
  for(const auto e : edges(mesh))
    if(constraints[e])
      options.kept_vertices.push_back(std::size_t(mesh.target(mesh.next(mesh.halfedge(e))).idx()));
  std::sort(options.kept_vertices.begin(), options.kept_vertices.end());
  const auto last = std::unique(options.kept_vertices.begin(), options.kept_vertices.end());
  options.kept_vertices.erase(last, options.kept_vertices.end());

  const Result result = SMS::spectral_edge_collapse(
      mesh, 10, options, CGAL::parameters::edge_is_constrained_map(constraints));
  CHECK(fault_of_result(mesh, result.restriction, result.vertex_map, input) == "");
  CHECK(result.stop_reason == Result::Stop_reason::queue_exhausted);
  CHECK(result.output_vertices < 200);
  CHECK(survivors(options.kept_vertices, input, mesh, result.restriction, result.vertex_map) ==
        options.kept_vertices.size());
  for(const auto e : edges(mesh))
    if(constraints[e])
      after.insert({mesh.point(source(e, mesh)), mesh.point(target(e, mesh))});
  CHECK(ends == after);
  CHECK(result.refusals.filter > 0);
}

TEST_CASE("A vertex to keep that coincides with a neighbour takes it in; two of them are refused")
{
  shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  const int a = input.T(100, 0), b = input.T(100, 1), c = input.T(100, 2);
  input.V.row(a) = input.V.row(b);
  Mesh mesh = make_mesh(input);
  Spectral_edge_collapse_options options = options_with(8);
  options.pre_simplify = GENERATE(0, 120);
  SECTION("one")
  {
    const std::size_t one = std::size_t(GENERATE(true, false) ? a : b);
    options.kept_vertices = {one};
    const Result result = SMS::spectral_edge_collapse(mesh, 50, options);
    CHECK(survivors({one}, input, mesh, result.restriction, result.vertex_map) == 1);
    CHECK(positions(mesh).row(Eigen::Index(result.vertex_map[one])) ==
          input.V.row(Eigen::Index(one)));
  }
  SECTION("two, with a third between them")
  {
    input.V.row(c) = input.V.row(b);
    Mesh folded = make_mesh(input);
    options.kept_vertices = {std::size_t(a), std::size_t(c)};
    CHECK_THROWS_AS(SMS::spectral_edge_collapse(folded, 50, options), std::invalid_argument);
    CHECK_THROWS_WITH(SMS::spectral_edge_collapse(folded, 50, options),
                      ContainsSubstring("without length") && ContainsSubstring(std::to_string(a)) &&
                          ContainsSubstring(std::to_string(c)));
    CHECK(positions(folded) == input.V);
  }
  SECTION("a vertex that is not there")
  {
    options.kept_vertices = {7, 162};
    CHECK_THROWS_AS(SMS::spectral_edge_collapse(mesh, 50, options), std::invalid_argument);
    CHECK_THROWS_WITH(SMS::spectral_edge_collapse(mesh, 50, options),
                      ContainsSubstring("vertex 162"));
    CHECK(positions(mesh) == input.V);
  }
}

TEST_CASE("Pre-simplification never merges a vertex to keep with the end of a constrained edge")
{
  // A fan around the vertex to keep: every edge leads to it or is on the border.
  const shapes::Matrices input = shapes::disc_matrices(12);
  Spectral_edge_collapse_options options = options_with(1);
  options.kept_vertices = {0};
  options.pre_simplify = 4;
  const bool constrained = GENERATE(false, true);
  Mesh mesh = make_mesh(input);
  auto constraints = mesh.add_property_map<Mesh::Edge_index, bool>("e:constrained", false).first;
  for(const auto e : edges(mesh))
    constraints[e] = constrained && is_border(e, mesh);
  const Result result = SMS::spectral_edge_collapse(
      mesh, 4, options, CGAL::parameters::edge_is_constrained_map(constraints));
  CHECK(result.pre_simplified_vertices == (constrained ? 13 : 4));
  CHECK(survivors({0}, input, mesh, result.restriction, result.vertex_map) == 1);
}

TEST_CASE("Pre-simplification never brings two vertices to keep together that share a position")
{
  // Two triangles on one edge, of which every other edge leads from an end to one of the two.
  shapes::Matrices input{Eigen::MatrixXd(4, 3), Eigen::MatrixXi(2, 3)};
  input.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0;
  input.T << 0, 1, 2, 0, 3, 1;
  Spectral_edge_collapse_options options = options_with(1);
  options.kept_vertices = {2, 3};
  options.pre_simplify = 3;
  Mesh mesh = make_mesh(input);
  const Result result = SMS::spectral_edge_collapse(mesh, 3, options);
  CHECK(result.pre_simplified_vertices == 4);
  CHECK(survivors(options.kept_vertices, input, mesh, result.restriction, result.vertex_map) == 2);
}

TEST_CASE("Borders, sharp edges and corners of a bent sheet are features, and stay")
{
  shapes::Matrices input = shapes::grid_matrices(12, 12, 12, 12); // bent by 45 degrees at x = 6
  for(Eigen::Index v = 0; v < input.V.rows(); ++v)
    input.V(v, 2) = (std::max)(0., input.V(v, 0) - 6);
  Mesh mesh = make_mesh(input);
  const auto count = [&](const SMS::Feature_vertices_map<Mesh>& map) {
    const auto range = vertices(mesh);
    return std::count_if(range.begin(), range.end(), [&](const auto v) { return get(map, v); });
  };
  using Map = SMS::Feature_vertices_map<Mesh>;
  CHECK(count(Map(mesh, false)) == 0);
  CHECK(count(Map(mesh, true)) == 48);
  CHECK(count(Map(mesh, false, 44.)) == 13 + 4);
  CHECK(count(Map(mesh, false, 46.)) == 4);
  CHECK(count(Map(mesh, true, 44.)) == 48 + 11);
  CHECK(count(Map(mesh, false, 91.)) == 0);
  CHECK_THROWS_AS(Map(mesh, true, 0.), std::invalid_argument);
  CHECK_THROWS_AS(Map(mesh, true, 181.), std::invalid_argument);

  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 10;
  const Map features(mesh, true, 44.);
  std::vector<Kernel::Point_3> points;
  for(const auto v : vertices(mesh))
    if(get(features, v))
      points.push_back(mesh.point(v));
  const Result result = SMS::spectral_edge_collapse(
      mesh, 70, options, CGAL::parameters::vertex_is_constrained_map(features));
  CHECK(result.output_vertices == 70);
  std::set<Kernel::Point_3> left;
  for(const auto v : vertices(mesh))
    left.insert(mesh.point(v));
  for(const Kernel::Point_3& p : points)
    CHECK(left.count(p) == 1);
}

} // namespace test_kept_vertices
