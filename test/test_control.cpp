// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Control over a run: vertices to keep, an error to stop at, cancelling, and the log that gives every level of detail.

#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include <CGAL/Polyhedron_3.h>
#include <CGAL/Polyhedron_items_with_id_3.h>

#include "catch.h"
#include "collapse_helpers.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

using namespace spectral_test;
using Catch::Matchers::ContainsSubstring;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;
using Result = SMS::Spectral_edge_collapse_result;
using SMS::Spectral_edge_collapse_options;
using SMS::Spectral_phase;
using SMS::Spectral_placement_strategy;
using SMS::Spectral_progress;

namespace {

std::vector<std::size_t> every(const std::size_t step, const Eigen::Index n, const std::size_t first = 0)
{
  std::vector<std::size_t> result;
  for(std::size_t i = first; i < std::size_t(n); i += step)
    result.push_back(i);
  return result;
}

// How many of the vertices are where they were, alone in their row of P.
std::size_t survivors(const std::vector<std::size_t>& kept, const shapes::Matrices& input, const Mesh& mesh,
                      const Eigen::SparseMatrix<double, Eigen::RowMajor>& P,
                      const std::vector<std::size_t>& map)
{
  const Eigen::MatrixXd V = positions(mesh);
  std::set<std::size_t> rows;
  for(const std::size_t i : kept) {
    const Eigen::Index row = Eigen::Index(map[i]);
    if(V.row(row) == input.V.row(Eigen::Index(i)) && P.row(row).nonZeros() == 1 &&
       P.coeff(row, Eigen::Index(i)) == 1)
      rows.insert(map[i]);
  }
  return rows.size();
}

std::string fault(const Mesh& mesh, const Eigen::SparseMatrix<double>& P, const std::vector<std::size_t>& map,
                  const shapes::Matrices& input)
{
  if(!CGAL::is_valid_polygon_mesh(mesh))
    return "the mesh is not valid";
  if(P.rows() != Eigen::Index(count_vertices(mesh)) || P.cols() != input.V.rows())
    return "the size of P";
  return fault_of_restriction(P, map);
}

// Edges without length here and there.
shapes::Matrices with_zero_length_edges(shapes::Matrices input)
{
  for(const int f : {100, 300, 500})
    input.V.row(input.T(f, 0)) = input.V.row(input.T(f, 1));
  return input;
}

// The same vertices, faces and coordinates in the same order, garbage included.
bool identical(const Mesh& a, const Mesh& b)
{
  if(a.num_vertices() != b.num_vertices() || a.num_halfedges() != b.num_halfedges() ||
     a.num_faces() != b.num_faces())
    return false;
  for(std::size_t i = 0; i < a.num_vertices(); ++i) {
    const Mesh::Vertex_index v(static_cast<Mesh::size_type>(i));
    if(a.is_removed(v) != b.is_removed(v) ||
       (!a.is_removed(v) && (a.point(v) != b.point(v) || a.halfedge(v) != b.halfedge(v))))
      return false;
  }
  for(std::size_t i = 0; i < a.num_halfedges(); ++i) {
    const Mesh::Halfedge_index h(static_cast<Mesh::size_type>(i));
    if(a.is_removed(h) != b.is_removed(h) ||
       (!a.is_removed(h) && (a.target(h) != b.target(h) || a.next(h) != b.next(h) || a.face(h) != b.face(h))))
      return false;
  }
  return std::equal(a.faces().begin(), a.faces().end(), b.faces().begin());
}

bool same_matrix(const Eigen::SparseMatrix<double>& a, const Eigen::SparseMatrix<double>& b)
{
  return Eigen::MatrixXd(a) == Eigen::MatrixXd(b);
}

} // namespace

// --- vertices to keep --------------------------------------------------------------------------------------------------

TEST_CASE("Vertices to keep survive with their position and their values")
{
  const bool bordered = GENERATE(false, true);
  Spectral_edge_collapse_options options = options_with(10);
  options.placement = GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::midpoint);
  options.binary = GENERATE(false, true);
  options.preserve_border = bordered;
  const bool as_map = GENERATE(false, true);
  CAPTURE(bordered, SMS::placement_name(options.placement), options.binary, as_map);
  const shapes::Matrices input = bordered ? wavy_grid_matrices(20, 18) : shapes::bumpy_icosphere_matrices(3);
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
    CHECK(survivors(options.kept_vertices, input, mesh, policies.restriction(), policies.vertex_map()) == 33);
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

  const Result result =
      SMS::spectral_edge_collapse(mesh, 10, options, CGAL::parameters::edge_is_constrained_map(constraints));
  CHECK(fault(mesh, result.restriction, result.vertex_map, input) == "");
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
    CHECK(positions(mesh).row(Eigen::Index(result.vertex_map[one])) == input.V.row(Eigen::Index(one)));
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
    CHECK_THROWS_WITH(SMS::spectral_edge_collapse(mesh, 50, options), ContainsSubstring("vertex 162"));
    CHECK(positions(mesh) == input.V);
  }
}

TEST_CASE("Pre-simplification never brings two vertices to keep together that share a position")
{
  // Two triangles on one edge, of which every other edge leads from an end to one of the two.
  shapes::Matrices input{Eigen::MatrixXd(4, 3), Eigen::MatrixXi(2, 3)};
  input.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0;
  input.T << 0, 1, 2, 0, 3, 1;
  Spectral_edge_collapse_options options = options_with(1);
  options.kept_vertices = {2, 3};
  options.pre_simplify = 2;
  Mesh mesh = make_mesh(input);
  const Result result = SMS::spectral_edge_collapse(mesh, 2, options);
  CHECK(result.pre_simplified_vertices == 4);
  CHECK(survivors(options.kept_vertices, input, mesh, result.restriction, result.vertex_map) == 2);
}

namespace {

// A placement that happens to lie on an end of the edge: the one that is not to be kept.
template <class Tracker>
struct Other_end_placement
{
  std::shared_ptr<const Tracker> tracker;

  template <class Profile>
  SMS::internal::Spectral_optional<Kernel::Point_3> operator()(const Profile& profile) const
  {
    return tracker->is_kept(profile.v0()) ? profile.p1() : profile.p0();
  }
};

} // namespace

TEST_CASE("A vertex to keep takes in a neighbour on which the placement happens to lie, unless constraints "
          "hold that one")
{
  using Tracker = SMS::internal::Restriction_tracker<Mesh>;
  const bool constrained = GENERATE(false, true);
  CAPTURE(constrained);
  // A fan around the vertex to keep: every edge that may be collapsed leads to it or is on the border.
  Mesh mesh = make_mesh(shapes::disc_matrices(12));
  std::vector<char> flags(13, 0);
  flags[0] = 1;
  const auto tracker = std::make_shared<Tracker>(mesh, flags);
  const auto shared = std::make_shared<const SMS::internal::Shared_positions>();
  auto constraints = mesh.add_property_map<Mesh::Edge_index, bool>("e:constrained", false).first;
  for(const auto e : edges(mesh))
    constraints[e] = constrained && is_border(e, mesh);
  using Is_constrained = SMS::internal::Ends_of_constrained_edges<decltype(constraints)>;
  using Placement =
      SMS::internal::Kept_vertices_placement<Tracker, Other_end_placement<Tracker>, Is_constrained>;
  const Placement placement(tracker, shared, Other_end_placement<Tracker>{tracker},
                            Is_constrained{constraints});
  int at_centre = 0, refused = 0;
  for(const auto h : halfedges(mesh)) {
    using Profile = SMS::Edge_profile<Mesh, Mesh::Property_map<Mesh::Vertex_index, Kernel::Point_3>, Kernel>;
    const Kernel traits;
    const Profile profile(h, mesh, traits, get(boost::vertex_index, mesh), mesh.points(),
                          get(boost::halfedge_index, mesh), true);
    if(!tracker->is_kept(profile.v0()) && !tracker->is_kept(profile.v1()))
      continue;
    const auto point = placement(profile);
    at_centre += point && *point == mesh.point(Mesh::Vertex_index(0));
    refused += !point;
  }
  CHECK(at_centre == (constrained ? 0 : 24));
  CHECK(refused == (constrained ? 24 : 0));
}

// --- stop at an error --------------------------------------------------------------------------------------------------

TEST_CASE("A bound of the error stops before the collapse that would exceed it")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Spectral_edge_collapse_options options = options_with(20);
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const std::size_t about = GENERATE(500, 200);
  Mesh counted_first = make_mesh(input);
  const double bound = 1.0001 * SMS::spectral_edge_collapse(counted_first, about, options).relative_error;
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
  CHECK(result.relative_error == error);

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
        input.V.row(t[1]) = (input.V.row(t[0]) + input.V.row(t[2])) / 2 + height * input.V.row(t[1]);
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

TEST_CASE("A bound of the error looks at the placement of a wrapper")
{
  // Always the first end, wherever the policies would have put the vertex.
  const auto first_end = [](const auto& profile) {
    return SMS::internal::Spectral_optional<Kernel::Point_3>(profile.p0());
  };
  const double bound = GENERATE(0.05, 0.15, 0.3);
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(3));
  const Policies policies(mesh, options_with(20));
  SMS::edge_collapse(
      mesh, SMS::Spectral_error_stop_predicate(policies, bound, first_end),
      CGAL::parameters::get_cost(policies.get_cost()).get_placement(first_end).visitor(policies.visitor()));
  CAPTURE(bound, count_vertices(mesh));
  CHECK(policies.relative_error() <= bound);
  CHECK(policies.relative_error() > 0.8 * bound);
}

TEST_CASE("A bound that is no number is refused; 0 lets nothing be lost; constants lose nothing")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(2));
  Spectral_edge_collapse_options options = options_with(5);
  const Policies policies(mesh, options);
  for(const double bound : {-1., std::nan("")}) {
    CHECK_THROWS_AS(SMS::Spectral_error_stop_predicate(policies, bound), std::invalid_argument);
    options.maximum_error = bound;
    CHECK_THROWS_WITH(SMS::spectral_edge_collapse(mesh, 50, options), ContainsSubstring("maximum_error"));
  }
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
  options.progress = [&](const Spectral_progress& p) {
    if(p.phase == Spectral_phase::collapses)
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

// --- cancelling --------------------------------------------------------------------------------------------------------

TEST_CASE("Another thread can cancel, in every phase")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  Spectral_edge_collapse_options options = options_with(20);
  std::atomic<bool> cancel{false};
  options.cancel = &cancel;
  Spectral_phase phase = Spectral_phase::eigenpairs;
  double fraction = 0;
  const bool tells_progress = GENERATE(true, false);
  options.progress = [&](const Spectral_progress& p) {
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
    phase = Spectral_phase::first_costs;
    fraction = 0.1;
    CHECK_THROWS_AS(SMS::spectral_edge_collapse(mesh, 100, options), SG::Cancelled);
    CHECK(positions(mesh) == input.V);
  }
  SECTION("between two collapses")
  {
    phase = Spectral_phase::collapses;
    fraction = 0.5;
    const Result result = SMS::spectral_edge_collapse(mesh, 100, options);
    CHECK(result.stop_reason == Result::Stop_reason::cancelled);
    CHECK(result.output_vertices > 350);
    CHECK(result.output_vertices < 380);
    CHECK(fault(mesh, result.restriction, result.vertex_map, input) == "");
    CHECK(position_error(result.restriction, input.V, positions(mesh)) < 1e-12);
    CHECK(result.log.number_of_vertices_left() == result.output_vertices);
  }
}

TEST_CASE("In two stages, what the first has done is returned when the run is cancelled")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  Spectral_edge_collapse_options options = options_with(20);
  options.pre_simplify = 300;
  const Spectral_phase phase =
      GENERATE(Spectral_phase::pre_simplification, Spectral_phase::eigenpairs, Spectral_phase::first_costs);
  const double fraction = GENERATE(0., 0.5);
  CAPTURE(int(phase), fraction);
  options.progress = [&](const Spectral_progress& p) { return p.phase != phase || p.fraction < fraction; };
  if(phase == Spectral_phase::pre_simplification && fraction == 0) {
    CHECK_THROWS_AS(SMS::spectral_edge_collapse(mesh, 100, options), SG::Cancelled);
    CHECK(positions(mesh) == input.V);
    return;
  }
  const Result result = SMS::spectral_edge_collapse(mesh, 100, options);
  CHECK(result.stop_reason == Result::Stop_reason::cancelled);
  CHECK_THAT(result.explanation, ContainsSubstring("cancelled"));
  CHECK(result.output_vertices == count_vertices(mesh));
  CHECK((result.output_vertices == 300) == (phase != Spectral_phase::pre_simplification));
  CHECK(result.output_vertices < 500);
  CHECK(fault(mesh, result.restriction, result.vertex_map, input) == "");
}

namespace {

struct Counts
{
  std::size_t started = 0, finished = 0, collapsed = 0;
  bool outside = false; // a point was seen that is not near the mesh
};

struct Loop_visitor : SMS::internal::No_visitor
{
  Counts* counts;
  void OnStarted(Mesh&) { ++counts->started; }
  void OnFinished(Mesh&) { ++counts->finished; }
  template <class Profile, class Vertex>
  void OnCollapsed(const Profile& profile, const Vertex&)
  {
    ++counts->collapsed;
    counts->outside |= !(profile.p0().x() > 10 && profile.p0().x() < 22);
  }
};

// Takes no point beyond x = 16.5.
struct Half_space
{
  template <class Profile>
  SMS::internal::Spectral_optional<typename Profile::Point>
  operator()(const Profile&, const SMS::internal::Spectral_optional<typename Profile::Point>& point) const
  {
    return point && point->x() > 16.5 ? SMS::internal::Spectral_optional<typename Profile::Point>() : point;
  }
};

std::size_t vertices_beyond(const Mesh& mesh, const double x)
{
  return std::size_t((positions(mesh).col(0).array() > x).count());
}

} // namespace

TEST_CASE("The first stage calls the visitor and asks the filter")
{
  shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  input.V.array() += 16.;
  Spectral_edge_collapse_options options = options_with(20);
  options.relocate = false;
  options.pre_simplify = 400;
  Mesh mesh = make_mesh(input);
  const std::size_t beyond = vertices_beyond(mesh, 17.2);
  REQUIRE(beyond > 5);
  Counts counts;
  Loop_visitor visitor;
  visitor.counts = &counts;
  const Result result = SMS::spectral_edge_collapse(
      mesh, 300, options, CGAL::parameters::visitor(std::ref(visitor)).filter(Half_space()));
  CHECK(result.pre_simplified_vertices == 400);
  CHECK(result.output_vertices == 300);
  CHECK(vertices_beyond(mesh, 17.2) == beyond);
  CHECK(counts.started == 2);
  CHECK(counts.finished == 2);
  CHECK(counts.collapsed == result.collapses);
  CHECK(!counts.outside);
  Mesh replayed = make_mesh(input);
  SMS::Collapse_replay<Mesh>(replayed, result.log).collapse_to(300);
  CHECK(positions(replayed) == positions(mesh));
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

TEST_CASE("The first stage does not feel how far from the origin the mesh lies, and leaves no vertex a "
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

TEST_CASE("edge_collapse() is cancelled through the stop predicate, and the policies go on afterwards")
{
  const shapes::Matrices input = wavy_grid_matrices(20, 18);
  Mesh mesh = make_mesh(input), expected = mesh;
  std::atomic<bool> cancel{false};
  Spectral_edge_collapse_options options = options_with(10);
  options.cancel = &cancel;
  options.progress = [&](const Spectral_progress& p) {
    cancel = p.phase == Spectral_phase::collapses && p.fraction > 0.5;
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

// --- levels of detail --------------------------------------------------------------------------------------------------

TEST_CASE("A level replayed from the log is what a direct run to it gives: mesh and P")
{
  const bool bordered = GENERATE(false, true);
  Spectral_edge_collapse_options options = options_with(10);
  options.placement = GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::midpoint);
  options.binary = GENERATE(false, true);
  const shapes::Matrices input =
      with_zero_length_edges(bordered ? wavy_grid_matrices(20, 18) : shapes::bumpy_icosphere_matrices(3));
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
  CHECK(fault(copy, replay.restriction(), replay.vertex_map(), input) == "");

  Polyhedron polyhedron;
  shapes::make_mesh(polyhedron, input);
  SMS::Collapse_replay<Polyhedron> on_polyhedron(polyhedron, result.log);
  on_polyhedron.collapse_to(60);
  CHECK(CGAL::is_valid_polygon_mesh(polyhedron));
  CHECK(position_error(on_polyhedron.restriction(), input.V, SG::mesh_matrices(polyhedron).V) < 1e-12);
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
