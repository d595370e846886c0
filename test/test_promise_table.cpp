// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The table of doc/promises.md: one check for each promise, made in every way to run. A promise
// that does not hold is shown not to, or to be refused.

#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/spectral_relocation.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/surface/Border_polyline.h>
#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>
#include <CGAL/Spectral_geometry/operator_coefficients.h>

#include "catch.h"
#include "collapse_helpers.h"

namespace test_promise_table {

using namespace spectral_test;
using Policies = SMS::Spectral_policies<Mesh>;
using Matrix = Eigen::SparseMatrix<double>;
using One_call_options = SMS::Spectral_edge_collapse_options;

namespace {

// What is asked of a run.
struct Trial
{
  shapes::Matrices input = shapes::bumpy_icosphere_matrices(3); // 642 vertices
  std::size_t N = 160;
  std::vector<std::size_t> kept;
  int constrained = 0; // every so many edges, or none
  int threads = 1;
  std::size_t cancelled_below = 0; // so many vertices, or where they are moved
};

// What came of it.
struct Outcome
{
  Mesh mesh;
  Matrix P;
  std::vector<std::size_t> map;
  std::set<Kernel::Point_3> constrained_before, constrained_after;
  std::string refused, explanation;
  bool cancelled = false, thrown = false;
};

void set(SMS::Spectral_options& options, const Trial& trial)
{
  options.number_of_eigenvectors = 20;
  options.kept_vertices = trial.kept;
  options.threads = trial.threads;
  if(trial.cancelled_below != 0)
    options.progress = [trial](const SG::Progress& p) {
      return p.phase != SG::Phase::relocation &&
             (p.phase != SG::Phase::collapses || p.number_of_vertices >= trial.cancelled_below);
    };
}

enum class Way { plain, wrapped, filtered, relocated };

Outcome by_policies(const Trial& trial, const Way way)
{
  Outcome result;
  Mesh& mesh = result.mesh = make_mesh(trial.input);
  const Constraints constraints = constrain_every(trial.constrained, mesh);
  result.constrained_before = ends(mesh, constraints);
  SMS::Spectral_options options;
  set(options, trial);
  // Without constrained edges their map is no part of the call.
  const bool wrapped = way == Way::wrapped || (way == Way::relocated && trial.constrained != 0);
  const Policies spectral(mesh, options, CGAL::parameters::edge_is_constrained_map(constraints));
  const auto np = CGAL::parameters::get_cost(spectral.get_cost())
                      .visitor(spectral.visitor())
                      .edge_is_constrained_map(constraints);
  const auto collapse_with = [&](const auto& placement, const auto& with_placement) {
    const SMS::Spectral_stop_predicate stop(spectral, trial.N,
                                            std::numeric_limits<double>::infinity(), placement);
    if(wrapped)
      SMS::edge_collapse(mesh, stop, with_placement.filter(spectral.filter()));
    else if(way == Way::filtered)
      SMS::edge_collapse(
          mesh, stop,
          with_placement.filter(spectral.filter(SMS::Bounded_normal_change_filter<>())));
    else
      SMS::edge_collapse(mesh, stop, with_placement);
    result.cancelled = stop.cancelled();
  };
  const SMS::Constrained_placement<Policies::Get_placement, Constraints> placement(
      constraints, spectral.get_placement());
  if(trial.cancelled_below != 0 && way == Way::relocated) // the collapses are not cancelled
    SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(trial.N, mesh),
                       np.get_placement(spectral.get_placement()));
  else if(wrapped)
    collapse_with(placement, np.get_placement(placement));
  else
    collapse_with(spectral.get_placement(), np.get_placement(spectral.get_placement()));
  result.P = spectral.restriction();
  result.map = spectral.vertex_map();
  result.explanation = spectral.explanation();
  if(way == Way::relocated) {
    const Eigen::MatrixXd collapsed = positions(mesh);
    try {
      result.P = SMS::spectral_relocation(mesh, spectral, {},
                                          CGAL::parameters::edge_is_constrained_map(constraints))
                     .restriction;
    } catch(const SG::Cancelled&) {
      result.cancelled = positions(mesh) == collapsed;
    }
  }
  result.constrained_after = ends(mesh, constraints);
  return result;
}

Outcome by_one_call(const Trial& trial, One_call_options options)
{
  Outcome result;
  Mesh& mesh = result.mesh = make_mesh(trial.input);
  const Constraints constraints = constrain_every(trial.constrained, mesh);
  result.constrained_before = ends(mesh, constraints);
  set(options, trial);
  const auto take = [&](const SMS::Spectral_edge_collapse_result& run) {
    result.P = run.restriction;
    result.map = run.vertex_map;
    result.explanation = run.explanation;
    result.cancelled =
        run.stop_reason == SMS::Spectral_edge_collapse_result::Stop_reason::cancelled;
  };
  // Quadrics are passed over where there is a filter: without constraints there is none.
  if(trial.constrained != 0)
    take(SMS::spectral_edge_collapse(mesh, trial.N, options,
                                     CGAL::parameters::edge_is_constrained_map(constraints)));
  else
    take(SMS::spectral_edge_collapse(mesh, trial.N, options));
  result.constrained_after = ends(mesh, constraints);
  return result;
}

struct Column
{
  const char* name;
  std::function<Outcome(const Trial&)> run;
};

// Quadrics have a part in the three where they can: the inputs are small.
const std::vector<Column>& columns()
{
  static const std::vector<Column> all = {
      {"policies", [](const Trial& t) { return by_policies(t, Way::plain); }},
      {"with `Constrained_placement` and `spectral.filter()`",
       [](const Trial& t) { return by_policies(t, Way::wrapped); }},
      {"with a filter of CGAL's", [](const Trial& t) { return by_policies(t, Way::filtered); }},
      {"policies, then `spectral_relocation()`",
       [](const Trial& t) { return by_policies(t, Way::relocated); }},
      {"one call, *best*",
       [](const Trial& t) {
         One_call_options options;
         options.quadrics_above = 2;
         return by_one_call(t, options);
       }},
      {"*fast*",
       [](const Trial& t) {
         One_call_options options = One_call_options::fast(t.N);
         options.pre_simplify = std::size_t(0.45 * double(t.input.V.rows()));
         options.quadrics_above = 2;
         return by_one_call(t, options);
       }},
      {"*paper*", [](const Trial& t) { return by_one_call(t, One_call_options::paper()); }},
      {"*best* with `pre_simplify`", [](const Trial& t) {
         One_call_options options;
         options.pre_simplify = std::size_t(0.45 * double(t.input.V.rows()));
         return by_one_call(t, options);
       }}};
  return all;
}

using Run = std::function<Outcome(const Trial&)>;

// Empty if the promise is kept.
std::string fault_of_count(const Run& run)
{
  const Outcome o = run({});
  return count_vertices(o.mesh) == 160 && CGAL::is_valid_polygon_mesh(o.mesh)
             ? ""
             : std::to_string(count_vertices(o.mesh)) + " vertices";
}

std::string fault_of_sums(const Run& run)
{
  const Outcome o = run({});
  const double off = (o.P * Eigen::VectorXd::Ones(o.P.cols()) - Eigen::VectorXd::Ones(o.P.rows()))
                         .cwiseAbs()
                         .maxCoeff();
  return off < 1e-12 ? "" : "a row of P sums to 1 but for " + std::to_string(off);
}

// Row i of P is read near vertex i, and the map leads near.
std::string fault_of_numbering(const Run& run)
{
  const Trial trial;
  const Outcome o = run(trial);
  const shapes::Matrices coarse = SG::mesh_matrices(o.mesh);
  if(o.P.rows() != coarse.V.rows() || o.P.cols() != trial.input.V.rows() ||
     o.map.size() != std::size_t(trial.input.V.rows()))
    return "sizes";
  double edge = 0;
  for(Eigen::Index f = 0; f < coarse.T.rows(); ++f)
    edge += (coarse.V.row(coarse.T(f, 0)) - coarse.V.row(coarse.T(f, 1))).norm() /
            double(coarse.T.rows());
  const Eigen::MatrixXd feet = o.P * trial.input.V;
  if((feet - coarse.V).rowwise().norm().maxCoeff() > edge)
    return "a row of P is another vertex'";
  std::vector<int> mapped(std::size_t(coarse.V.rows()), 0);
  for(std::size_t v = 0; v < o.map.size(); ++v) {
    if(o.map[v] >= mapped.size())
      return "the map leads nowhere";
    ++mapped[o.map[v]];
    if((trial.input.V.row(Eigen::Index(v)) - coarse.V.row(Eigen::Index(o.map[v]))).norm() >
       3 * edge)
      return "the map leads far away";
  }
  return std::count(mapped.begin(), mapped.end(), 0) == 0 ? "" : "nothing is mapped to a vertex";
}

std::string fault_of_kept(const Run& run)
{
  Trial trial;
  trial.kept = every(61, trial.input.V.rows(), 7);
  const Outcome o = run(trial);
  const std::size_t left = survivors(trial.kept, trial.input, o.mesh, o.P, o.map);
  return left == trial.kept.size() ? "" : std::to_string(left) + " are kept";
}

std::string fault_of_constrained(const Run& run)
{
  Trial trial;
  trial.constrained = 97;
  const Outcome o = run(trial);
  REQUIRE(o.constrained_before.size() > 20);
  return o.constrained_before == o.constrained_after ? "" : "ends of constrained edges moved";
}

std::string fault_of_crossings(const Run& run)
{
  Trial trial;
  trial.input = shapes::thin_bowl_matrices(3);
  trial.N = 120;
  const auto crossings = [](const shapes::Matrices& m) {
    return SG::internal::self_intersecting_faces(m.V, m.T).size();
  };
  REQUIRE(crossings(trial.input) == 0);
  const std::size_t n = crossings(SG::mesh_matrices(run(trial).mesh));
  return n == 0 ? "" : std::to_string(n) + " pairs of faces cross";
}

std::string fault_of_threads(const Run& run)
{
  Trial trial;
  const Outcome one = run(trial);
  trial.threads = 3;
  const Outcome three = run(trial), again = run(trial);
  return identical(one.mesh, three.mesh) && (one.P - three.P).norm() == 0 &&
                 identical(three.mesh, again.mesh)
             ? ""
             : "the result depends on threads";
}

// In the middle of the collapses, or of what follows: a mesh with the P of what was done.
std::string fault_of_cancelling(const Run& run)
{
  Trial trial;
  trial.cancelled_below = 250;
  const Outcome o = run(trial);
  if(!o.cancelled)
    return "it went on";
  const std::size_t n = count_vertices(o.mesh);
  if(!CGAL::is_valid_polygon_mesh(o.mesh) || n < trial.N || n > trial.cancelled_below)
    return "a mesh of " + std::to_string(n) + " vertices";
  return fault_of_result(o.mesh, o.P, o.map, trial.input);
}

std::string fault_of_border(const Run& run)
{
  Trial trial;
  trial.input = shapes::island_matrices(24, 96);
  trial.N = 90;
  const SG::internal::Border_polyline coast(trial.input);
  const Outcome o = run(trial);
  double furthest = 0;
  for(const auto v : vertices(o.mesh))
    if(is_border(v, o.mesh)) {
      const auto& p = o.mesh.point(v);
      const auto found = coast.closest({p.x(), p.y(), p.z()}, [](std::size_t) { return true; });
      furthest = (std::max)(furthest, std::sqrt(found.squared_distance));
    }
  return furthest < 1e-12 ? "" : "a vertex is off by " + std::to_string(furthest);
}

struct Row
{
  const char* promise;
  std::string (*fault)(const Run&);
  const char* cells[8]; // what holds in each column; what begins with "no" does not
};

const char *const yes = "yes", *const near_it = "no, near it",
                  *const first = "no, on the border of the first stage";

const Row rows[] = {
    {"the number of vertices is exact", fault_of_count, {yes, yes, yes, yes, yes, yes, yes, yes}},
    {"rows of P sum to one", fault_of_sums, {yes, yes, yes, yes, yes, yes, yes, yes}},
    {"rows of P and the map are numbered as `vertices(mesh)`",
     fault_of_numbering,
     {yes, yes, yes, yes, yes, yes, yes, yes}},
    {"kept vertices stay", fault_of_kept, {yes, yes, yes, yes, yes, yes, yes, yes}},
    {"both ends of constrained edges stay",
     fault_of_constrained,
     {"no, as with any placement of CGAL's", yes, "no, as with any placement of CGAL's", yes, yes,
      yes, yes, yes}},
    {"no face goes through another that did not",
     fault_of_crossings,
     {yes, yes, yes, yes, yes, yes, "no, the paper does not look", yes}},
    {"the result does not depend on threads",
     fault_of_threads,
     {yes, yes, yes, yes, yes, yes, yes, yes}},
    {"a run that is cancelled leaves a mesh and its P",
     fault_of_cancelling,
     {yes, yes, yes, yes, yes, yes, yes, yes}},
    {"vertices of the border are on the border of the input",
     fault_of_border,
     {near_it, near_it, near_it, yes, yes, first, near_it, first}}};

std::string table()
{
  std::string result = "| |";
  for(const Column& c : columns())
    result += std::string(" ") + c.name + " |";
  result += "\n|---|";
  for(std::size_t k = 0; k < columns().size(); ++k)
    result += "---|";
  for(const Row& row : rows) {
    result += std::string("\n| ") + row.promise + " |";
    for(const char* cell : row.cells)
      result += std::string(" ") + cell + " |";
  }
  return result + "\n";
}

} // namespace

TEST_CASE("each promise holds where the table says so, and nowhere else", "[slow]")
{
  const std::size_t r = GENERATE(range(std::size_t(0), std::size(rows)));
  const Row& row = rows[r];
  DYNAMIC_SECTION(row.promise)
  {
    for(std::size_t k = 0; k < columns().size(); ++k) {
      const std::string fault = row.fault(columns()[k].run);
      const bool holds = std::string(row.cells[k]).rfind("no", 0) != 0;
      CAPTURE(row.promise, columns()[k].name, row.cells[k], fault);
      CHECK((fault.empty()) == holds);
    }
  }
}

namespace {

struct Preset
{
  const char* name;
  One_call_options (*options)();
};

const Preset presets[] = {{"*best*",
                           [] {
                             One_call_options options;
                             options.quadrics_above = 2;
                             return options;
                           }},
                          {"*fast*",
                           [] {
                             One_call_options options = One_call_options::fast(160);
                             options.pre_simplify = 500;
                             options.quadrics_above = 2;
                             return options;
                           }},
                          {"*paper*", [] { return One_call_options::paper(); }}};

struct Counting_visitor : SMS::internal::Dummy_visitor
{
  std::size_t* collapsed;

  explicit Counting_visitor(std::size_t& n)
    : collapsed(&n)
  {}
  template <class Profile, class Vertex>
  void OnCollapsed(const Profile&, Vertex)
  {
    ++*collapsed;
  }
};

struct No_placement
{
  template <class Profile, class Placement>
  Placement operator()(const Profile&, Placement) const
  {
    return Placement();
  }
};

const shapes::Matrices& sphere()
{
  static const shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(3);
  return mesh;
}

const shapes::Matrices& sheet()
{
  static const shapes::Matrices mesh = wavy_grid_matrices(28, 26);
  return mesh;
}

// The run, with the mesh that it leaves.
template <class NamedParameters = CGAL::parameters::Default_named_parameters>
SMS::Spectral_edge_collapse_result
run(const shapes::Matrices& input, One_call_options options, Mesh& mesh,
    const NamedParameters& np = CGAL::parameters::default_values())
{
  mesh = make_mesh(input);
  options.number_of_eigenvectors = 20;
  return SMS::spectral_edge_collapse(mesh, 160, options, np);
}

bool differ(const Mesh& mesh, const shapes::Matrices& input, const One_call_options& options)
{
  Mesh plain;
  run(input, options, plain);
  return !identical(mesh, plain);
}

// What rows of border vertices have of inner ones.
double inner_part(const Mesh& mesh, const Matrix& P)
{
  const std::vector<char> fine = SG::internal::border_vertices(sheet().T, sheet().V.rows());
  const std::vector<char> coarse =
      SG::internal::border_vertices(SG::mesh_matrices(mesh).T, P.rows());
  double sum = 0;
  for(Eigen::Index j = 0; j < P.cols(); ++j)
    for(Matrix::InnerIterator it(P, j); it; ++it)
      if(coarse[std::size_t(it.row())] && !fine[std::size_t(j)])
        sum += std::abs(it.value());
  return sum;
}

const SG::Eigenpairs& pairs_of_sphere(const SG::Mass mass)
{
  static const SG::Eigenpairs
      averaged =
          SG::eigenpairs(SG::laplace_operator(sphere().V, sphere().T, SG::Mass::averaged), 20),
      lumped = SG::eigenpairs(SG::laplace_operator(sphere().V, sphere().T, SG::Mass::lumped), 20);
  return mass == SG::Mass::averaged ? averaged : lumped;
}

struct Option
{
  const char* name;
  bool (*is_heeded)(One_call_options);
  const char* cells[3]; // "yes", or "refused: ..." with words of the sentence
};

const Option option_rows[] = {
    {"`binary`, not relocated",
     [](One_call_options options) {
       Mesh mesh;
       options.binary = true;
       options.relocate = false;
       const auto result = run(sphere(), options, mesh);
       return fault_of_restriction(result.restriction, result.vertex_map, true).empty();
     },
     {"yes", "yes", "yes"}},
    {"`binary`, relocated by sampled signals",
     [](One_call_options options) {
       Mesh mesh;
       options.binary = options.relocate = true;
       run(sphere(), options, mesh);
       return false;
     },
     {"refused: not binary", "refused: not binary", "refused: not binary"}},
    {"`preserve_border`",
     [](One_call_options options) {
       Mesh mesh;
       options.preserve_border = true;
       return inner_part(mesh, run(sheet(), options, mesh).restriction) == 0;
     },
     {"yes", "yes", "yes"}},
    {"`boundary` = `dirichlet`",
     [](One_call_options options) {
       Mesh mesh;
       options.boundary = SG::Boundary_condition::dirichlet;
       const auto result = run(sheet(), options, mesh);
       options.boundary = SG::Boundary_condition::neumann;
       return inner_part(mesh, result.restriction) == 0 && differ(mesh, sheet(), options);
     },
     {"yes", "yes", "yes"}},
    {"`maximum_error`",
     [](One_call_options options) {
       Mesh mesh;
       options.maximum_error = 0.01;
       options.relocate = false;
       const auto result = run(sphere(), options, mesh);
       return result.output_vertices > 160 && result.relative_error <= 0.01;
     },
     {"yes", "refused: maximum_error", "yes"}},
    {"`signals`",
     [](One_call_options options) {
       Mesh mesh;
       options.signals = sphere().V;
       const auto result = run(sphere(), options, mesh);
       options.signals.resize(0, 0);
       return !result.eigenpairs && differ(mesh, sphere(), options);
     },
     {"yes", "refused: belong to the mesh before it", "yes"}},
    {"`eigenpairs`",
     [](One_call_options options) {
       Mesh mesh;
       options.eigenpairs = std::make_shared<SG::Eigenpairs>(pairs_of_sphere(options.mass));
       return run(sphere(), options, mesh).eigenpairs == options.eigenpairs;
     },
     {"yes", "refused: belong to the mesh before it", "yes"}},
    {"`weights`",
     [](One_call_options options) {
       Mesh mesh;
       options.weights = Eigen::VectorXd::LinSpaced(20, 1, 0);
       run(sphere(), options, mesh);
       options.weights.resize(0);
       return differ(mesh, sphere(), options);
     },
     {"yes", "refused: weights are for eigenvectors", "yes"}},
    {"`coefficients`",
     [](One_call_options options) {
       Mesh mesh;
       const Eigen::VectorXd c = (1.5 + sphere().V.col(0).array()).matrix();
       options.coefficients = SG::weighted_coefficients(c, Eigen::VectorXd::Ones(c.size()));
       const auto result = run(sphere(), options, mesh);
       options.coefficients.resize(0, 7);
       return result.coefficients.rows() == 160 && differ(mesh, sphere(), options);
     },
     {"yes", "yes", "yes"}},
    {"`operator_of_eigenpairs`",
     [](One_call_options options) {
       Mesh mesh;
       int calls = 0;
       options.operator_of_eigenpairs = [&](const Eigen::MatrixXd& V, const Eigen::MatrixXi& T) {
         ++calls;
         return SG::laplace_operator(V, T, options.mass);
       };
       run(sphere(), options, mesh);
       return calls > 0;
     },
     {"yes", "yes", "yes"}},
    {"a visitor",
     [](One_call_options options) {
       Mesh mesh;
       std::size_t collapsed = 0;
       const auto result =
           run(sphere(), options, mesh, CGAL::parameters::visitor(Counting_visitor(collapsed)));
       return collapsed == result.collapses;
     },
     {"yes", "refused: no visitor", "yes"}},
    {"a filter",
     [](One_call_options options) {
       Mesh mesh;
       return run(sphere(), options, mesh, CGAL::parameters::filter(No_placement()))
                  .output_vertices == 642;
     },
     {"yes", "refused: no filter", "yes"}}};

std::string table_of_options()
{
  std::string result = "| |";
  for(const Preset& preset : presets)
    result += std::string(" ") + preset.name + " |";
  result += "\n|---|---|---|---|";
  for(const Option& option : option_rows) {
    result += std::string("\n| ") + option.name + " |";
    for(const std::string cell : option.cells)
      result += " " + cell.substr(0, cell.find(':')) + " |";
  }
  return result + "\n";
}

} // namespace

TEST_CASE("an option is heeded in a preset, or refused", "[slow]")
{
  const Option& option = option_rows[GENERATE(range(std::size_t(0), std::size(option_rows)))];
  for(std::size_t k = 0; k < std::size(presets); ++k) {
    const std::string cell = option.cells[k], words = cell.substr(cell.find(' ') + 1);
    CAPTURE(option.name, presets[k].name);
    if(cell == "yes")
      CHECK(option.is_heeded(presets[k].options()));
    else
      CHECK_THROWS_WITH(option.is_heeded(presets[k].options()),
                        Catch::Matchers::ContainsSubstring(words));
  }
}

TEST_CASE("the tables of promises are those of the document")
{
  std::ifstream file(SPECTRAL_SOURCE_DIR "/doc/promises.md");
  REQUIRE(file);
  std::stringstream text;
  text << file.rdbuf();
  for(const std::string& expected : {table(), table_of_options()}) {
    CAPTURE(expected);
    CHECK(text.str().find(expected) != std::string::npos);
  }
}

} // namespace test_promise_table
