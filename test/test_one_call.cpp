// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// spectral_edge_collapse(): its result, its named parameters, progress and cancelling, what it
// refuses.

#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include <CGAL/Spectral_geometry/operator_coefficients.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>

#include "catch.h"
#include "collapse_helpers.h"

namespace test_one_call {

using namespace spectral_test;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;
using Result = SMS::Spectral_edge_collapse_result;
using SG::Phase;
using SG::Progress;
using SMS::Spectral_edge_collapse_options;
using Point = Kernel::Point_3;

namespace {

struct Counting_visitor : SMS::internal::Dummy_visitor
{
  template <class P, class V>
  void OnCollapsed(const P&, const V&)
  {
    ++collapsed;
  }
  std::size_t collapsed = 0;
};

// What is wrong with a result; empty if nothing is.
std::string fault_of_result(const Mesh& mesh, const Result& result, const shapes::Matrices& input,
                            const Spectral_edge_collapse_options& options)
{
  if(!CGAL::is_valid_polygon_mesh(mesh))
    return "the mesh is not valid";
  const shapes::Matrices coarse = SG::mesh_matrices(mesh);
  if(result.output_vertices != std::size_t(coarse.V.rows()) ||
     result.restriction.rows() != coarse.V.rows())
    return "the number of vertices";
  if(result.input_vertices != std::size_t(input.V.rows()) ||
     result.collapses != result.input_vertices - result.output_vertices)
    return "the number of collapses";
  const std::string fault =
      fault_of_restriction(result.restriction, result.vertex_map, options.binary);
  if(!fault.empty())
    return fault;
  if(position_error(result.restriction, input.V, coarse.V) > 1e-12)
    return "P V";
  const Basis basis = eigen_input(input, options.mass, *result.eigenpairs).basis;
  if(relative_difference(energy(coarse, basis, result.restriction), result.E) > 1e-8)
    return "E";
  if(relative_difference(std::sqrt(result.E / basis.lambda.squaredNorm()), result.relative_error) >
     1e-8)
    return "the relative error";
  return "";
}

} // namespace

TEST_CASE("The one call returns what the policies give, and counts, times and reasons")
{
  const shapes::Matrices input = wavy_grid_matrices(20, 18);
  Spectral_edge_collapse_options options = options_with(10);
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  Mesh mesh = make_mesh(input), other = mesh;
  const Result result = SMS::spectral_edge_collapse(mesh, 100, options);
  CHECK(fault_of_result(mesh, result, input, options) == "");
  CHECK(result.stop_reason == Result::Stop_reason::target_reached);
  CHECK(result.stop_reason_name() == std::string("target reached"));
  CHECK(result.explanation == "");
  CHECK(result.warnings.empty());
  CHECK(result.output_vertices == 100);
  CHECK(result.collapses == 299);
  CHECK(result.eigenpairs->size() == 10);
  CHECK(result.seconds_eigenpairs > 0);
  CHECK(result.seconds_first_costs > 0);
  CHECK(result.seconds_collapse >= result.seconds_first_costs);
  CHECK(result.seconds_total >= result.seconds_eigenpairs + result.seconds_collapse);

  const SMS::Spectral_policies<Mesh, Kernel> policies(other, options);
  collapse(other, policies, 100);
  CHECK(positions(other) == positions(mesh));
  CHECK(Eigen::MatrixXd(policies.restriction()) == Eigen::MatrixXd(result.restriction));
  CHECK(relative_difference(policies.error(), result.E) < 1e-10); // the sums differ

  // Its eigenpairs serve another target.
  Mesh again = make_mesh(input);
  options.eigenpairs = result.eigenpairs;
  const Result second = SMS::spectral_edge_collapse(again, 60, options);
  CHECK(fault_of_result(again, second, input, options) == "");
  CHECK(second.output_vertices == 60);
  CHECK(second.eigenpairs == result.eigenpairs); // not found anew
  CHECK(second.E > 0);
}

TEST_CASE(
    "Below 3 K vertices the metric sees N / 4 of the eigenvectors, unless it is told how many")
{
  const shapes::Matrices input = wavy_grid_matrices(20, 18);
  Spectral_edge_collapse_options options = options_with(10);
  Mesh mesh = make_mesh(input), other = mesh, all = mesh;
  const Result result = SMS::spectral_edge_collapse(mesh, 29, options);
  CHECK(fault_of_result(mesh, result, input, options) == "");
  CHECK(result.signals == 8); // the constant one and 29 / 4
  CHECK(result.eigenpairs->size() == 10);
  REQUIRE(result.warnings.size() == 1);
  CHECK_THAT(result.warnings[0],
             ContainsSubstring("3 K = 30") && ContainsSubstring("the first 8 eigenvectors"));
  Mesh larger = other;
  CHECK(SMS::spectral_edge_collapse(larger, 30, options).warnings.empty());

  // It is the same as to pass these eight alone, and not the same as with all of them.
  SG::Eigenpairs first = *result.eigenpairs;
  first.values.conservativeResize(8);
  first.vectors.conservativeResize(Eigen::NoChange, 8);
  first.residuals.conservativeResize(8);
  options.eigenpairs = std::make_shared<const SG::Eigenpairs>(first);
  const SMS::Spectral_policies<Mesh, Kernel> policies(other, options);
  collapse(other, policies, 29);
  CHECK(positions(other) == positions(mesh));
  options.eigenpairs = nullptr;
  options.weights = Eigen::VectorXd::Ones(10);
  const Result whole = SMS::spectral_edge_collapse(all, 29, options);
  CHECK(fault_of_result(all, whole, input, options) == "");
  CHECK(whole.signals == 10);
  CHECK(positions(all) != positions(mesh));
  // Either way E is that of all of them, which the metric that saw them has kept lower.
  CHECK(whole.E < result.E);

  const auto number_seen = [](const std::size_t N, const Eigen::Index K, const Eigen::Index zeros) {
    const Eigen::VectorXd weights = SMS::weights_for_target(N, K, zeros);
    REQUIRE(weights.size() == K);
    const Eigen::Index seen = (weights.array() == 1).count();
    CHECK(weights.tail(K - seen).isZero(0)); // the first ones
    return seen;
  };
  CHECK(number_seen(300, 100, 1) == 100);
  CHECK(number_seen(299, 100, 1) == 75);
  CHECK(number_seen(299, 100, 2) == 76);
  CHECK(number_seen(1, 100, 1) == 2);
  CHECK(number_seen(3, 2, 5) == 2);
}

TEST_CASE("The one call to the size that the mesh has changes nothing")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  Mesh mesh = make_mesh(input);
  const Result result = SMS::spectral_edge_collapse(mesh, 162, options_with(10));
  CHECK(result.stop_reason == Result::Stop_reason::target_reached);
  CHECK(result.collapses == 0);
  CHECK(result.explanation == "");
  CHECK(positions(mesh) == input.V);
  CHECK(Eigen::MatrixXd(result.restriction) == Eigen::MatrixXd::Identity(162, 162));
}

TEST_CASE("The one call hands named parameters on: constraints, filter, visitor, point map")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  const Spectral_edge_collapse_options options = options_with(10);
  Mesh mesh = make_mesh(input);
  SECTION("constrained edges, and the points of their ends, stay")
  {
    const auto constraints =
        mesh.add_property_map<Mesh::Edge_index, bool>("e:constrained", false).first;
    std::vector<Point> ends;
    for(const auto e : edges(mesh))
      if(e.idx() % 31 == 0) {
        constraints[e] = true;
        ends.push_back(mesh.point(source(e, mesh)));
        ends.push_back(mesh.point(target(e, mesh)));
      }
    Counting_visitor visitor;
    const Result result =
        SMS::spectral_edge_collapse(mesh, 150, options,
                                    CGAL::parameters::edge_is_constrained_map(constraints)
                                        .visitor(std::ref(visitor))
                                        .filter(SMS::Bounded_normal_change_filter<>()));
    CHECK(visitor.collapsed == result.collapses);
    CHECK(fault_of_result(mesh, result, input, options) == "");
    std::vector<Point> after;
    for(const auto e : edges(mesh))
      if(constraints[e]) {
        after.push_back(mesh.point(source(e, mesh)));
        after.push_back(mesh.point(target(e, mesh)));
      }
    std::sort(ends.begin(), ends.end());
    std::sort(after.begin(), after.end());
    CHECK(ends == after);
  }
  SECTION("a visitor by copy, a filter")
  {
    const Result result =
        SMS::spectral_edge_collapse(mesh, 150, options,
                                    CGAL::parameters::visitor(Counting_visitor())
                                        .filter(SMS::Bounded_normal_change_filter<>()));
    CHECK(fault_of_result(mesh, result, input, options) == "");
    CHECK(result.output_vertices == 150);
  }
  SECTION("a point map of the user's")
  {
    auto points = mesh.add_property_map<Mesh::Vertex_index, Point>("v:mine").first;
    for(const auto v : vertices(mesh)) {
      points[v] = mesh.point(v);
      mesh.point(v) = CGAL::ORIGIN;
    }
    const auto np = CGAL::parameters::vertex_point_map(points).geom_traits(Kernel());
    const Result result = SMS::spectral_edge_collapse(mesh, 150, options, np);
    for(const auto v : vertices(mesh)) {
      CHECK(mesh.point(v) == CGAL::ORIGIN);
      mesh.point(v) = points[v];
    }
    CHECK(fault_of_result(mesh, result, input, options) == "");
  }
}

TEST_CASE("Where the target cannot be reached the result says why")
{
  Spectral_edge_collapse_options options = options_with(3);
  options.maximum_error = 1e9; // with a bound targets are not refused
  SECTION("components cannot vanish")
  {
    const shapes::Matrices input = shapes::components_matrices(shapes::icosphere_matrices(1), 3);
    Mesh mesh = make_mesh(input);
    options.number_of_eigenvectors = 6;
    const Result result = SMS::spectral_edge_collapse(mesh, 5, options);
    CHECK(result.stop_reason == Result::Stop_reason::queue_exhausted);
    CHECK(result.stop_reason_name() == std::string("no collapsible edge left"));
    CHECK(result.output_vertices >= 12);
    CHECK(result.output_vertices < 126);
    CHECK_THAT(result.explanation,
               ContainsSubstring("instead of 5") && ContainsSubstring("3 components") &&
                   ContainsSubstring("topology") && ContainsSubstring(" 0 border edges"));
    CHECK(result.refusals.topology > 0);
    CHECK(fault_of_restriction(result.restriction, result.vertex_map) == "");
  }
  SECTION("two tetrahedra are as small as they get")
  {
    const shapes::Matrices input = shapes::components_matrices(shapes::tetrahedron_matrices(), 2);
    Mesh mesh = make_mesh(input);
    const Result result = SMS::spectral_edge_collapse(mesh, 1, options);
    CHECK(result.stop_reason == Result::Stop_reason::queue_exhausted);
    CHECK(result.output_vertices == 8);
    CHECK(positions(mesh) == input.V);
    CHECK_THAT(result.explanation, ContainsSubstring("2 components"));
  }
  SECTION("a triangle")
  {
    Mesh mesh = make_mesh(shapes::matrices({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
    options.number_of_eigenvectors = 2;
    const Result result = SMS::spectral_edge_collapse(mesh, 1, options);
    CHECK(result.output_vertices == 3);
    CHECK_THAT(result.explanation,
               ContainsSubstring("1 component,") && ContainsSubstring("3 border edges"));
  }
  SECTION("every edge constrained")
  {
    Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(1));
    const auto constraints =
        mesh.add_property_map<Mesh::Edge_index, bool>("e:constrained", true).first;
    const Result result = SMS::spectral_edge_collapse(
        mesh, 20, options, CGAL::parameters::edge_is_constrained_map(constraints));
    CHECK(result.output_vertices == 42);
    CHECK(result.stop_reason == Result::Stop_reason::queue_exhausted);
    CHECK_THAT(result.explanation, ContainsSubstring("constrained"));
    CHECK(result.E < 1e-10);
  }
}

namespace {

// |C|_L of the first K eigenpairs, or of as many as there are vertices, with and without
// relocation.
void check_relocated_norm(const shapes::Matrices& input, const Eigen::Index K, const std::size_t N,
                          Spectral_edge_collapse_options options, int& relocated)
{
  const SG::Laplace_operator fine = SG::laplace_operator(input.V, input.T);
  const SG::Eigenpairs fine_pairs = SG::eigenpairs(fine, K);
  const auto norm = [&](const bool relocate) {
    options.number_of_eigenvectors = K;
    options.relocate = relocate;
    Mesh mesh = make_mesh(input);
    const auto result = SMS::spectral_edge_collapse(mesh, N, options);
    relocated += result.relocation.moved_vertices > 0;
    const SG::Mesh_matrices m = SG::mesh_matrices(mesh);
    const SG::Laplace_operator coarse = SG::laplace_operator(m.V, m.T);
    const Eigen::Index modes = (std::min)(K, coarse.L.rows());
    return SG::evaluate_spectrum(fine, fine_pairs, coarse, SG::eigenpairs(coarse, modes),
                                 result.restriction, K)
        .norm_L;
  };
  CAPTURE(input.V.rows(), K, N);
  CHECK(norm(true) <= 1.001 * norm(false));
}

} // namespace

TEST_CASE("Relocation leaves no larger |C|_L than the collapses, also far below 3 K", "[slow]")
{
  int relocated = 0;
  SECTION("best")
  {
    for(const shapes::Matrices& input :
        {shapes::torus_matrices(7, 5), shapes::bumpy_icosphere_matrices(1),
         shapes::grid_matrices(9, 9), shapes::disc_matrices(10)})
      for(const Eigen::Index K : {5, 7, 10})
        for(const std::size_t N : {4, 5, 6, 7, 10})
          if(N == 10 || input.V.rows() != 35) // a handle needs more
            check_relocated_norm(input, K, N, {}, relocated);
  }
  SECTION("fast, whose noise goes up to modes that are fewer")
  {
    // Without symmetries: where K cuts a cluster of eigenvalues the norm is that of an arbitrary
    // basis.
    for(const shapes::Matrices& input :
        {shapes::bumpy_icosphere_matrices(2), shapes::irregular_grid_matrices(11, 8),
         shapes::thin_bowl_matrices(2)})
      for(const Eigen::Index K : {5, 10, 30})
        for(const std::size_t N : {4, 10, 15, 30})
          check_relocated_norm(input, K, N, Spectral_edge_collapse_options::fast(N), relocated);
    check_relocated_norm(shapes::bumpy_icosphere_matrices(3), 120, 130,
                         Spectral_edge_collapse_options::fast(130), relocated);
  }
  CHECK(relocated > 20);
}

TEST_CASE(
    "Filtered noise takes a number of eigenvectors that the mesh has, and says how many it saw")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(2));
  Spectral_edge_collapse_options options = Spectral_edge_collapse_options::fast(40);
  if(GENERATE(false, true))
    options.source = SMS::Spectral_signal_source::eigenpairs;
  for(const Eigen::Index K :
      {Eigen::Index(-1), Eigen::Index(0), Eigen::Index(162), Eigen::Index(1) << 50}) {
    options.number_of_eigenvectors = K;
    CHECK_THROWS_WITH(SMS::spectral_edge_collapse(mesh, 40, options),
                      ContainsSubstring("use a number from 1 to 161"));
  }
  options.number_of_eigenvectors = 30;
  const Result result = SMS::spectral_edge_collapse(mesh, 40, options);
  CHECK(result.signals == 11); // the constant one and 40 / 4
  REQUIRE(result.warnings.size() == 1);
  CHECK_THAT(result.warnings[0], ContainsSubstring("the first 11 eigenvectors"));
}

TEST_CASE("A target that leaves nothing of the shape is refused with the number to ask for")
{
  // What is refused at N, and is not at the number that the sentence names.
  const auto refusal = [](const shapes::Matrices& input, const std::size_t N,
                          const Eigen::Index K) {
    std::string sentence;
    std::size_t asked = N;
    for(int attempt = 0; attempt < 2; ++attempt) {
      Mesh mesh = make_mesh(input);
      try {
        SMS::spectral_edge_collapse(mesh, asked, options_with(K));
        CHECK(mesh.number_of_vertices() == asked);
        return sentence;
      } catch(const std::invalid_argument& error) {
        CHECK(sentence == "");
        CHECK(positions(mesh) == input.V);
        sentence = error.what();
        const std::string before = ": ask for ";
        REQUIRE(sentence.find(before) != std::string::npos);
        asked = std::stoul(sentence.substr(sentence.find(before) + before.size()));
      }
    }
    INFO("refused twice: " << sentence);
    CHECK(false);
    return sentence;
  };
  SECTION("components of one size")
  {
    const shapes::Matrices input =
        shapes::components_matrices(shapes::bumpy_icosphere_matrices(1), 3);
    CHECK_THAT(refusal(input, 12, 1), ContainsSubstring("3 components need at least 12 vertices, "
                                                        "and 13 for something of their shapes"));
    CHECK(refusal(input, 13, 1) == "");
    CHECK(refusal(input, 20, 21) == ""); // the metric sees eight modes then
    const shapes::Matrices two = shapes::components_matrices(shapes::tetrahedron_matrices(), 2);
    CHECK_THAT(refusal(two, 7, 3),
               ContainsSubstring("2 components need at least 8 vertices: ask for 8 or more"));
    CHECK(refusal(two, 8, 3) == "");
  }
  SECTION("crumbs")
  {
    const shapes::Matrices body = shapes::bumpy_icosphere_matrices(3),
                           crumb = shapes::icosphere_matrices(0);
    const Eigen::Index n = body.V.rows(), m = body.T.rows();
    shapes::Matrices both = body;
    both.V.conservativeResize(n + 60 * 12, 3);
    both.T.conservativeResize(m + 60 * 20, 3);
    for(int c = 0; c < 60; ++c) {
      both.V.middleRows(n + 12 * c, 12) =
          (0.02 * crumb.V).rowwise() + Eigen::RowVector3d(3 + 0.1 * c, 0, 0);
      both.T.middleRows(m + 20 * c, 20) = crumb.T.array() + int(n + 12 * c);
    }
    // 60 tetrahedra, and as many vertices as the body has modes
    CHECK_THAT(refusal(both, 250, 80),
               ContainsSubstring("61 components need at least 244 vertices, and 2") &&
                   ContainsSubstring("leave out the 60 components of 12 vertices") &&
                   ContainsSubstring("% of the area"));
    CHECK(refusal(both, 261, 80) == "");
    CHECK_THAT(refusal(both, 261, 400), ContainsSubstring("ask for 3"));
  }
  SECTION("one component")
  {
    CHECK_THAT(
        refusal(shapes::torus_matrices(8, 6), 6, 40),
        ContainsSubstring("1 component needs at least 7 vertices, and 10 for something of its "
                          "handles to be left: ask for 10"));
    CHECK_THAT(refusal(shapes::bumpy_icosphere_matrices(1), 3, 5),
               ContainsSubstring("1 component needs at least 4 vertices: ask for 4"));
    CHECK(refusal(shapes::bumpy_icosphere_matrices(1), 4, 5) == "");
    CHECK_THAT(refusal(shapes::grid_matrices(3, 3), 2, 5), ContainsSubstring("ask for 3"));
    CHECK_THAT(refusal(shapes::grid_matrices(3, 3), 1, 5), ContainsSubstring("is 1 vertex, but"));
  }
  SECTION("lattices")
  {
    for(const int holes : {1, 2, 5}) {
      const int genus = holes * holes;
      CHECK_THAT(refusal(shapes::lattice_matrices(holes, holes), 4, 8),
                 ContainsSubstring("ask for " + std::to_string(6 + 4 * genus)));
    }
  }
}

namespace {

struct Refusal
{
  const char* name;
  void (*spoil)(Spectral_edge_collapse_options&, shapes::Matrices&, std::size_t& N);
  const char* words;
  bool by_policies = true, after_quadrics = true;
};

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

const Refusal refusals[] = {
    {"no vertex", [](auto&, auto&, auto& N) { N = 0; }, "the target is 0", false},
    {"more vertices than there are", [](auto&, auto&, auto& N) { N = 163; }, "from 1 to 162",
     false},
    {"no eigenvector", [](auto& o, auto&, auto&) { o.number_of_eigenvectors = 0; },
     "number_of_eigenvectors is 0"},
    {"as many as vertices", [](auto& o, auto&, auto&) { o.number_of_eigenvectors = 162; },
     "number_of_eigenvectors is 162"},
    {"no thread", [](auto& o, auto&, auto&) { o.threads = 0; }, "threads is 0"},
    {"few weights", [](auto& o, auto&, auto&) { o.weights.setOnes(4); }, "4 weights for 5 signals"},
    {"a negative weight",
     [](auto& o, auto&, auto&) { o.weights = Eigen::VectorXd::Unit(5, 3) * -1; }, "weight 3 "},
    {"a weight that is no number",
     [](auto& o, auto&, auto&) {
       o.weights.setOnes(5);
       o.weights(2) = not_a_number;
     },
     "weight 2 "},
    {"signals of another mesh", [](auto& o, auto&, auto&) { o.signals.setOnes(161, 3); },
     "161 rows", true, false},
    {"signals that are no numbers",
     [](auto& o, auto&, auto&) {
       o.signals.setOnes(162, 3);
       o.signals(7, 1) = not_a_number;
     },
     "not finite", true, false},
    {"a restriction that cannot be binary",
     [](auto& o, auto&, auto&) { o.binary = o.relocate = true; }, "not binary", false},
    {"a negative shape term", [](auto& o, auto&, auto&) { o.shape = -1e-9; }, "shape is -1e-09"},
    {"a negative number of mixtures", [](auto& o, auto&, auto&) { o.number_of_mixtures = -2; },
     "number_of_mixtures is -2"},
    {"quadrics below the target", [](auto& o, auto&, auto&) { o.quadrics_above = 0.5; },
     "quadrics_above", false},
    {"quadrics above no number", [](auto& o, auto&, auto&) { o.quadrics_above = not_a_number; },
     "quadrics_above", false},
    {"a negative bound", [](auto& o, auto&, auto&) { o.maximum_error = -1; }, "maximum_error",
     false},
    {"a bound that is no number", [](auto& o, auto&, auto&) { o.maximum_error = not_a_number; },
     "maximum_error", false},
    {"a tolerance above 1", [](auto& o, auto&, auto&) { o.eigenpairs_options.tolerance = 2; },
     "tolerance"},
    {"negative smoothing",
     [](auto& o, auto&, auto&) {
       o.relocate = true;
       o.relocation.smoothing = -1;
     },
     "smoothing", false},
    {"coefficients of another mesh",
     [](auto& o, auto&, auto&) {
       o.coefficients = SG::weighted_coefficients(Eigen::VectorXd::Ones(5), {});
     },
     "for 5 vertices"},
    {"a coordinate that is no number",
     [](auto&, auto& mesh, auto&) { mesh.V(50, 1) = not_a_number; }, "not a finite number"},
    {"areas whose squares overflow", [](auto&, auto& mesh, auto&) { mesh.V *= 1e60; }, "1e50"},
    {"an isolated vertex",
     [](auto&, auto& mesh, auto&) {
       mesh.V.conservativeResize(163, 3);
       mesh.V.row(162).setZero();
     },
     "isolated"}};

} // namespace

TEST_CASE("What cannot be used is refused before the mesh changes, in every way to run")
{
  const Refusal& r = refusals[GENERATE(range(std::size_t(0), std::size(refusals)))];
  shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  Spectral_edge_collapse_options options = options_with(5);
  std::size_t N = 50;
  r.spoil(options, input, N);
  CAPTURE(r.name);
  Mesh mesh = make_mesh(input);
  for(const std::size_t pre_simplify : {0, 100}) {
    options.pre_simplify = pre_simplify;
    if(pre_simplify == 0 || r.after_quadrics) {
      CHECK_THROWS_AS(SMS::spectral_edge_collapse(mesh, N, options), std::invalid_argument);
      CHECK_THROWS_WITH(SMS::spectral_edge_collapse(mesh, N, options), ContainsSubstring(r.words));
    }
  }
  if(r.by_policies) {
    CHECK_THROWS_AS(Policies(mesh, options), std::invalid_argument);
    CHECK_THROWS_WITH(Policies(mesh, options), ContainsSubstring(r.words));
  }
  CHECK(count_vertices(mesh) == std::size_t(input.V.rows()));
}

TEST_CASE("Progress runs through the phases, never backwards, and does not change the result")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Spectral_edge_collapse_options options = options_with(20);
  Mesh expected = make_mesh(input);
  SMS::spectral_edge_collapse(expected, 100, options);

  std::vector<Progress> reports;
  options.progress = [&](const Progress& p) { return reports.push_back(p), true; };
  Mesh mesh = make_mesh(input);
  SMS::spectral_edge_collapse(mesh, 100, options);
  CHECK(positions(mesh) == positions(expected));
  std::map<Phase, int> count;
  for(std::size_t i = 0; i < reports.size(); ++i) {
    const Progress& p = reports[i];
    ++count[p.phase];
    CHECK((p.fraction >= 0 && p.fraction <= 1));
    CHECK(p.number_of_vertices >= 100);
    CHECK(p.number_of_vertices <= 642);
    if(i > 0) {
      CHECK(int(reports[i - 1].phase) <= int(p.phase));
      CHECK((reports[i - 1].phase != p.phase || reports[i - 1].fraction <= p.fraction));
      CHECK(reports[i - 1].number_of_vertices >= p.number_of_vertices);
    }
  }
  CHECK(count[Phase::eigenpairs] > 1);
  CHECK(count[Phase::first_costs] > 0);
  CHECK(count[Phase::collapses] > 50);
  CHECK(count[Phase::collapses] < 150);
}

TEST_CASE("A run can be cancelled in every phase")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Spectral_edge_collapse_options options = options_with(20);
  Phase phase = Phase::eigenpairs;
  double fraction = 0;
  options.progress = [&](const Progress& p) { return p.phase != phase || p.fraction < fraction; };
  Mesh mesh = make_mesh(input);
  SECTION("while the eigenpairs are computed: the mesh is untouched")
  {
    CHECK_THROWS_AS(SMS::spectral_edge_collapse(mesh, 100, options), SG::Cancelled);
    CHECK(positions(mesh) == input.V);
    fraction = 0.5;
    CHECK_THROWS_AS(SMS::spectral_edge_collapse(mesh, 100, options), SG::Cancelled);
  }
  SECTION("while the first costs are computed: the mesh is untouched")
  {
    phase = Phase::first_costs;
    CHECK_THROWS_AS(SMS::spectral_edge_collapse(mesh, 100, options), SG::Cancelled);
    CHECK(positions(mesh) == input.V);
  }
  SECTION("between collapses: what was done is returned")
  {
    phase = Phase::collapses;
    fraction = 0.5;
    const Result result = SMS::spectral_edge_collapse(mesh, 100, options);
    CHECK(result.stop_reason == Result::Stop_reason::cancelled);
    CHECK(result.stop_reason_name() == std::string("cancelled"));
    CHECK_THAT(result.explanation, ContainsSubstring("cancelled"));
    CHECK(result.output_vertices > 300);
    CHECK(result.output_vertices < 450);
    options.progress = nullptr;
    CHECK(fault_of_result(mesh, result, input, options) == "");
  }
}

TEST_CASE("Edges without length are among the collapses that are counted")
{
  shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  for(const int f : {100, 300, 500})
    input.V.row(input.T(f, 0)) = input.V.row(input.T(f, 1));
  Mesh mesh = make_mesh(input);
  const Spectral_edge_collapse_options options = options_with(10);
  const std::size_t N = GENERATE(640, 639, 100);
  const Result result = SMS::spectral_edge_collapse(mesh, N, options);
  CHECK(result.stop_reason == Result::Stop_reason::target_reached);
  CHECK(result.output_vertices ==
        (std::min)(N, std::size_t(639))); // they are merged before anybody asks
  CHECK(result.explanation == "");
  CHECK(fault_of_result(mesh, result, input, options) == "");
}

TEST_CASE("Relocation leaves vertices to keep where they are, whichever handle they go on under")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  Spectral_edge_collapse_options options = options_with(6);
  options.mass = SG::Mass::averaged;
  options.relocate = true;
  options.relocation.maximum_steps = 3;
  for(std::size_t v = 0; v < 162; v += 9)
    options.kept_vertices.push_back(v);
  Mesh mesh = make_mesh(input);
  const Result result = SMS::spectral_edge_collapse(mesh, 60, options);
  CHECK(result.output_vertices == 60);
  CHECK(result.relocation.moved_vertices > 0);
  int other_handles = 0, moved = 0;
  for(const std::size_t v : options.kept_vertices) {
    const std::size_t row = result.vertex_map[v];
    moved += positions(mesh).row(Eigen::Index(row)) != input.V.row(Eigen::Index(v));
    other_handles += std::size_t(*std::next(vertices(mesh).begin(), std::ptrdiff_t(row))) != v;
  }
  CHECK(moved == 0);
  CHECK(other_handles > 0);
}

TEST_CASE(
    "A run in the consistent mass keeps the eigenvalues of that mass better than any other run")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  const auto error_of = [&](const SG::Mass mass) {
    Spectral_edge_collapse_options options = Spectral_edge_collapse_options::best();
    options.number_of_eigenvectors = 20;
    options.mass = mass;
    Mesh mesh = make_mesh(input);
    const Result result = SMS::spectral_edge_collapse(mesh, 100, options);
    CHECK(result.warnings.size() == (mass == SG::Mass::averaged ? 0 : 1));
    for(const std::string& warning : result.warnings)
      CHECK_THAT(warning, ContainsSubstring(SG::mass_name(mass)));
    const shapes::Matrices coarse = SG::mesh_matrices(mesh);
    Eigen::VectorXd values[2];
    for(const bool is_coarse : {false, true}) {
      const shapes::Matrices& m = is_coarse ? coarse : input;
      const auto op = SG::laplace_operator(m.V, m.T, SG::Mass::consistent);
      CHECK(op.theta == 1);
      values[is_coarse] = op.mass.sum() * SG::eigenpairs(op, 20).values.tail(19);
    }
    return (values[1].cwiseQuotient(values[0]).array() - 1).abs().mean();
  };
  const double consistent = error_of(SG::Mass::consistent);
  CHECK(consistent < error_of(SG::Mass::averaged));
  CHECK(consistent < error_of(SG::Mass::lumped));
}

TEST_CASE("E is that of the P that is returned where a vertex to keep has the position of another")
{
  // Two spheres that touch in a vertex: the closest point to that of the second is on the first.
  shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  const Eigen::Index n = input.V.rows(), m = input.T.rows();
  const Eigen::RowVector3d touch = input.V.row(7);
  input.V.conservativeResize(2 * n, 3);
  input.T.conservativeResize(2 * m, 3);
  input.V.bottomRows(n) = (-input.V.topRows(n)).rowwise() + 2 * touch;
  input.T.bottomRows(m) = input.T.topRows(m).rowwise().reverse().array() + int(n);
  REQUIRE(input.V.row(7) == input.V.row(n + 7));
  Spectral_edge_collapse_options options = options_with(8);
  options.mass = SG::Mass::averaged;
  options.relocate = true;
  options.kept_vertices = {7, std::size_t(n) + 7};
  Mesh mesh = make_mesh(input);
  const Result result = SMS::spectral_edge_collapse(mesh, 120, options);
  for(const std::size_t v : options.kept_vertices)
    CHECK(result.restriction.coeff(Eigen::Index(result.vertex_map[v]), Eigen::Index(v)) == 1);
  const Basis basis = eigen_input(input, options.mass, *result.eigenpairs).basis;
  CHECK(relative_difference(energy(SG::mesh_matrices(mesh), basis, result.restriction), result.E) <
        1e-8);
}

TEST_CASE("A face without area in the result is warned of where relocation was asked for, the "
          "collapses are kept")
{
  shapes::Matrices input = shapes::grid_matrices(4, 4);
  input.V.row(6) = 0.5 * (input.V.row(5) + input.V.row(11)); // the corner opposite to a diagonal
  Spectral_edge_collapse_options options = options_with(4);
  options.relocate = true;
  Mesh mesh = make_mesh(input);
  const Result result = SMS::spectral_edge_collapse(mesh, 25, options);
  CHECK(result.stop_reason == Result::Stop_reason::target_reached);
  CHECK(result.relocation.moved_vertices == 0);
  REQUIRE_FALSE(result.warnings.empty());
  CHECK_THAT(result.warnings.back(),
             ContainsSubstring("not relocated") && ContainsSubstring("has no area"));
}

TEST_CASE("Rough eigenpairs have one E, in the collapses and for matrices")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  const SG::Laplace_operator op = SG::laplace_operator(input.V, input.T, SG::Mass::lumped);
  const SG::Eigenpairs_options rough = SG::Eigenpairs_options::with_tolerance(0.1);
  Spectral_edge_collapse_options options = options_with(20);
  options.eigenpairs = std::make_shared<SG::Eigenpairs>(SG::eigenpairs(op, 20, rough));
  REQUIRE(SMS::internal::pairs_are_rough(options.eigenpairs->residuals));
  Basis basis = basis_of_pairs(op, *options.eigenpairs);
  basis.Z = signal_basis(input, 0, basis.F).Z;
  for(Eigen::MatrixXd* const signals : {&basis.F, &basis.Z})
    signals->col(0).setZero(); // E leaves the constant out, however rough
  Mesh mesh = make_mesh(input);
  const Result result = SMS::spectral_edge_collapse(mesh, 100, options);
  CHECK(relative_difference(energy(SG::mesh_matrices(mesh), basis, result.restriction), result.E) <
        1e-8);
}

TEST_CASE("Of one eigenvector of a mesh with needles there is nothing to lose but rounding")
{
  shapes::Matrices input = shapes::grid_matrices(4, 4);
  const double length = GENERATE(1., 1e-6, 1e-9);
  for(const int v : {6, 12, 18}) // towards the next vertex
    input.V.row(v) = (1 - length) * input.V.row(v + 1) + length * input.V.row(v);
  Spectral_edge_collapse_options options = options_with(1);
  options.maximum_error = 0.1;
  Mesh mesh = make_mesh(input);
  const Result result = SMS::spectral_edge_collapse(mesh, 6, options);
  CAPTURE(length, result.eigenpairs->values[0], result.E);
  CHECK(result.stop_reason != Result::Stop_reason::error_reached);
  CHECK(result.relative_error == 0);
}

} // namespace test_one_call
