// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// How the policies live inside CGAL's loop: visitors, misuse, exceptions, several runs, difficult edges.

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_collapse_kernel.h>

#include "catch.h"
#include "collapse_helpers.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace test_collapse_loop {

using namespace spectral_test;
using Catch::Matchers::ContainsSubstring;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;
using SMS::Spectral_options;
using SMS::Spectral_placement_strategy;
using Point = Kernel::Point_3;

namespace {

enum Call {
  started,
  finished,
  stopped,
  collected,
  selected,
  collapsing,
  collapsed,
  non_collapsable,
  number_of_calls
};

struct User_exception
{};

// Counts its calls and throws at a given one. The counts are shared by copies.
class Recorder
{
public:
  using Counts = std::array<std::size_t, number_of_calls>;

  explicit Recorder(const Call throw_in = number_of_calls, const std::size_t throw_at = 0)
    : m_counts(std::make_shared<Counts>())
    , m_throw_in(throw_in)
    , m_throw_at(throw_at)
  {
    m_counts->fill(0);
  }

  std::size_t operator[](const Call call) const { return (*m_counts)[call]; }

  template <class TM>
  void OnStarted(TM&)
  {
    count(started);
  }
  template <class TM>
  void OnFinished(TM&)
  {
    count(finished);
  }
  template <class P>
  void OnStopConditionReached(const P&)
  {
    count(stopped);
  }
  template <class P, class C>
  void OnCollected(const P&, const C& cost)
  {
    costs_are_numbers = costs_are_numbers && cost && !std::isnan(*cost);
    count(collected);
  }
  template <class P, class C, class S>
  void OnSelected(const P&, const C& cost, S, S)
  {
    costs_are_numbers = costs_are_numbers && cost && !std::isnan(*cost);
    count(selected);
  }
  template <class P, class O>
  void OnCollapsing(const P&, const O&)
  {
    count(collapsing);
  }
  template <class P, class V>
  void OnCollapsed(const P&, const V&)
  {
    count(collapsed);
  }
  template <class P>
  void OnNonCollapsable(const P&)
  {
    count(non_collapsable);
  }

  bool costs_are_numbers = true;

private:
  void count(const Call call)
  {
    if(++(*m_counts)[call] == m_throw_at && call == m_throw_in)
      throw User_exception();
  }

  std::shared_ptr<Counts> m_counts;
  Call m_throw_in;
  std::size_t m_throw_at;
};

int collapse_without_visitor(Mesh& mesh, const Policies& policies)
{
  return SMS::edge_collapse(
      mesh, SMS::Vertex_count_stop_predicate<Mesh>(10, mesh),
      CGAL::parameters::get_cost(policies.get_cost()).get_placement(policies.get_placement()));
}

// At every collapse: the edges whose costs CGAL has asked for in either direction. After the run: what differed.
struct Direction_probe : SMS::internal::Dummy_visitor
{
  explicit Direction_probe(const Policies& p)
    : policies(&p)
  {}

  void OnStarted(Mesh& m) { mesh = &m; }

  template <class Profile>
  void OnCollapsed(const Profile& profile, const Mesh::Vertex_index kept)
  {
    if(++number % 7 != 0)
      return;
    for(const auto h : CGAL::halfedges_around_target(kept, *mesh)) {
      const auto make = [&](const Mesh::Halfedge_index e) {
        return Profile(e, *mesh, profile.geom_traits(), get(boost::vertex_index, *mesh),
                       profile.vertex_point_map(), get(boost::halfedge_index, *mesh), true);
      };
      const Profile ahead = make(h), back = make(mesh->opposite(h));
      const auto p = policies->get_placement()(ahead), q = policies->get_placement()(back);
      same = same && p == q && policies->get_cost()(ahead, p) == policies->get_cost()(back, q);
      ++compared;
    }
  }

  const Policies* policies;
  Mesh* mesh = nullptr;
  int number = 0, compared = 0;
  bool same = true;
};

// Checks that an edge with one border vertex is collapsed onto it.
struct Border_probe : SMS::internal::Dummy_visitor
{
  template <class Profile, class Optional_point>
  void OnCollapsing(const Profile& profile, const Optional_point& placement)
  {
    const bool b0 = bool(CGAL::is_border(profile.v0(), profile.surface_mesh()));
    const bool b1 = bool(CGAL::is_border(profile.v1(), profile.surface_mesh()));
    if(b0 == b1)
      return;
    ++one_border;
    kept += *placement == (b0 ? profile.p0() : profile.p1());
  }
  int one_border = 0, kept = 0;
};

// A candidate as it would be found now: one that is deferred by its three samples alone.
SMS::internal::Spectral_candidate evaluate_like(const SMS::internal::Spectral_collapse_core& core,
                                                const SMS::internal::Spectral_candidate& c,
                                                const SMS::internal::Spectral_slot u,
                                                SMS::internal::Spectral_collapse_kernel& kernel)
{
  const double infinity = std::numeric_limits<double>::infinity();
  return core.evaluate(c.other, u, kernel, c.deferred ? -infinity : infinity);
}

// CGAL does not cost edges again after it has merged the ends of an edge without length: what is known of the edges
// around must be forgotten.
bool no_stale_candidate_around_merged_vertices(const Mesh& mesh, const Policies& policies)
{
  const auto& core = policies.state().core();
  const Eigen::SparseMatrix<double, Eigen::RowMajor> P = policies.restriction();
  const std::vector<Eigen::Index> slots = policies.state().current_slots();
  std::vector<SMS::internal::Spectral_slot> slot(mesh.num_vertices());
  std::vector<Mesh::Vertex_index> merged;
  Eigen::Index row = 0;
  for(const auto v : vertices(mesh)) {
    slot[v] = SMS::internal::Spectral_slot(slots[row]);
    if(P.row(row++).nonZeros() > 1)
      merged.push_back(v);
  }
  SMS::internal::Spectral_collapse_kernel kernel;
  for(const auto v : merged)
    for(const auto h : CGAL::halfedges_around_target(v, mesh))
      for(const auto e : CGAL::halfedges_around_target(mesh.source(h), mesh)) {
        const auto a = slot[mesh.source(e)], b = slot[mesh.target(e)];
        const auto* c = core.candidates().find(a, b);
        if(c != nullptr && c->cost != evaluate_like(core, *c, (std::min)(a, b), kernel).cost)
          return false;
      }
  return !merged.empty();
}

// Our cost, and how often it was not what the edge costs when CGAL asks. Slots are vertices: nothing has been removed before.
struct Watched_cost
{
  template <class Profile, class Placement>
  auto operator()(const Profile& profile, const Placement& placement) const
  {
    const auto result = cost(profile, placement);
    const SMS::internal::Spectral_slot u = std::uint32_t(profile.v0()), v = std::uint32_t(profile.v1());
    SMS::internal::Spectral_collapse_kernel kernel;
    const auto now = policies->state().core().evaluate(u, v, kernel);
    ++*asked;
    *stale += placement && (!result || *result != now.cost);
    return result;
  }
  Policies::Get_cost cost;
  const Policies* policies;
  int *asked, *stale;
};

} // namespace

TEST_CASE("Exact costs are those of now whenever CGAL asks, and the others are not")
{
  const auto placement =
      GENERATE(SMS::Spectral_placement_strategy::on_edge, SMS::Spectral_placement_strategy::free);
  const bool exact = GENERATE(false, true);
  Mesh mesh = make_mesh(wavy_grid_matrices(16, 14));
  SMS::Spectral_options options = options_with(8);
  options.placement = placement;
  options.exact_costs = exact;
  const Policies policies(mesh, options);
  int asked = 0, stale = 0;
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(60, mesh),
                     CGAL::parameters::get_cost(Watched_cost{policies.get_cost(), &policies, &asked, &stale})
                         .get_placement(policies.get_placement())
                         .visitor(policies.visitor()));
  CHECK(count_vertices(mesh) == 60);
  CHECK(asked > 1000);
  CHECK((stale == 0) == exact);
}

TEST_CASE("A forgotten visitor throws at the first cost and leaves the mesh as it is")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options_with(8));
  CHECK_THROWS_AS(collapse_without_visitor(mesh, policies), std::logic_error);
  CHECK_THROWS_WITH(collapse_without_visitor(mesh, policies), ContainsSubstring("visitor"));
  CHECK(positions(mesh) == input.V);
  collapse(mesh, policies, 50);
  CHECK(count_vertices(mesh) == 50);
  CHECK_THROWS_AS(collapse_without_visitor(mesh, policies), std::logic_error); // the run is over
}

TEST_CASE("The policies refuse a mesh other than their own")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(2)), other = mesh;
  const Policies policies(mesh, options_with(8));
  CHECK_THROWS_AS(collapse(other, policies, 50), std::invalid_argument);
  CHECK_THROWS_WITH(collapse(other, policies, 50), ContainsSubstring("another mesh"));
  CHECK(count_vertices(other) == 162);
}

TEST_CASE("A point map other than that of the policies is found out")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(2));
  auto doubled = mesh.add_property_map<Mesh::Vertex_index, Point>("v:doubled").first;
  for(const auto v : vertices(mesh))
    doubled[v] = CGAL::ORIGIN + 2 * (mesh.point(v) - CGAL::ORIGIN);
  const Policies policies(mesh, options_with(8), CGAL::parameters::vertex_point_map(doubled));
  const auto run = [&] {
    SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(50, mesh),
                       CGAL::parameters::get_cost(policies.get_cost())
                           .get_placement(policies.get_placement())
                           .visitor(policies.visitor()));
  };
  CHECK_THROWS_AS(run(), std::logic_error);
  CHECK_THROWS_WITH(run(), ContainsSubstring("vertex_point_map"));
  CHECK(count_vertices(mesh) == 162);
  collapse(mesh, policies, 50); // with the right one
  CHECK(count_vertices(mesh) == 50);
}

TEST_CASE("A user's visitor sees every call, copied or by reference")
{
  const bool by_reference = GENERATE(false, true);
  Mesh mesh = make_mesh(wavy_grid_matrices(14, 12));
  const std::size_t n = count_vertices(mesh), edges = mesh.number_of_edges();
  const Policies policies(mesh, options_with(8));
  Recorder recorder;
  if(by_reference)
    collapse(mesh, policies, 40, std::ref(recorder));
  else
    collapse(mesh, policies, 40, recorder);
  CHECK(recorder[started] == 1);
  CHECK(recorder[finished] == 1);
  CHECK(recorder[stopped] == 1);
  CHECK(recorder[collected] == edges);
  CHECK(recorder[collapsing] == n - 40);
  CHECK(recorder[collapsed] == n - 40);
  const auto& refusals = policies.state().refusals();
  CHECK(recorder[non_collapsable] == refusals.topology);
  CHECK(recorder[selected] == n - 40 + 1 + refusals.topology + refusals.geometry + refusals.placement);
  CHECK(refusals.filter == 0);
  CHECK(recorder.costs_are_numbers);
}

TEST_CASE("After an exception of the user's visitor the run is over, the mesh valid, and the policies go on")
{
  const Call where = GENERATE(started, finished, stopped, collected, selected, collapsing, collapsed);
  CAPTURE(where);
  const shapes::Matrices input = wavy_grid_matrices(14, 12);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options_with(8));
  const bool once = where == started || where == finished || where == stopped;
  CHECK_THROWS_AS(collapse(mesh, policies, 100, Recorder(where, once ? 1 : 30)), User_exception);
  CHECK_THROWS_AS(collapse_without_visitor(mesh, policies), std::logic_error);
  const Input fine = eigen_input(input, SG::Mass::lumped, *policies.eigenpairs());
  if(where != started && where != collected) // before the first collapse E is rounding
    CHECK(fault_of_run(mesh, policies, fine) == "");
  collapse(mesh, policies, 40);
  CHECK(count_vertices(mesh) == 40);
  CHECK(fault_of_run(mesh, policies, fine) == "");
}

TEST_CASE("A second run continues, and P still starts at the original input")
{
  const shapes::Matrices input = wavy_grid_matrices(20, 18);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options_with(10));
  const Input fine = eigen_input(input, SG::Mass::lumped, *policies.eigenpairs());
  collapse(mesh, policies, 200);
  const double E = policies.error();
  const bool garbage_collected = GENERATE(false, true);
  if(garbage_collected) {
    mesh.collect_garbage();
    CHECK(mesh.number_of_vertices() == 200);
    CHECK(fault_of_run(mesh, policies, fine) == "");
  }
  SECTION("at once")
  {
    CHECK(collapse(mesh, policies, 200) == 0);
    CHECK(relative_difference(policies.error(), E) < 1e-10);
    collapse(mesh, policies, 60);
    CHECK(count_vertices(mesh) == 60);
    CHECK(fault_of_run(mesh, policies, fine) == "");
    CHECK(policies.error() > E);
  }
  SECTION("after vertices were moved")
  {
    for(const auto v : vertices(mesh))
      mesh.point(v) = mesh.point(v) + Kernel::Vector_3(0, 0, 0.1 * std::sin(9 * mesh.point(v).x()));
    collapse(mesh, policies, 60);
    CHECK(fault_of_run(mesh, policies, fine, Check{false, false, 1e-8}) == "");
  }
  SECTION("not after vertices were added")
  {
    const auto h = CGAL::Euler::add_center_vertex(mesh.halfedge(*faces(mesh).begin()), mesh);
    mesh.point(mesh.target(h)) =
        CGAL::centroid(mesh.point(mesh.source(h)), mesh.point(mesh.target(mesh.next(h))),
                       mesh.point(mesh.source(mesh.opposite(h))));
    CHECK_THROWS_WITH(collapse(mesh, policies, 60), ContainsSubstring("adding vertices"));
  }
}

TEST_CASE("A second run refuses a mesh from which vertices were removed without the visitor")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(2));
  const Policies policies(mesh, options_with(8));
  collapse(mesh, policies, 100);
  for(const auto e : edges(mesh))
    if(CGAL::Euler::does_satisfy_link_condition(e, mesh)) {
      CGAL::Euler::collapse_edge(e, mesh);
      break;
    }
  REQUIRE(count_vertices(mesh) == 99);
  CHECK_THROWS_AS(policies.restriction(), std::logic_error);
  CHECK_THROWS_AS(collapse(mesh, policies, 60), std::logic_error);
  CHECK_THROWS_WITH(collapse(mesh, policies, 60), ContainsSubstring("visitor"));
}

TEST_CASE("Rows of P follow vertices(mesh) after collect_garbage")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options_with(8));
  collapse(mesh, policies, 100);
  const Eigen::MatrixXd before = positions(mesh), P = policies.restriction();
  mesh.collect_garbage();
  const Eigen::MatrixXd after = positions(mesh), Q = policies.restriction();
  CHECK(before != after); // the order has changed
  CHECK((Q * input.V - after).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((P * input.V - before).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("An edge has one placement and one cost, in whichever direction it is presented")
{
  Spectral_options options = options_with(10);
  options.binary = GENERATE(false, true);
  const bool bordered = GENERATE(false, true);
  Mesh mesh = make_mesh(bordered ? wavy_grid_matrices(25, 24) : shapes::bumpy_icosphere_matrices(3));
  const Policies policies(mesh, options);
  Direction_probe probe(policies);
  collapse(mesh, policies, 60, std::ref(probe));
  CHECK(probe.compared > 200);
  CHECK(probe.same);
}

TEST_CASE("After many collapses the candidates on record weigh the vertices that they say")
{
  const bool bordered = GENERATE(false, true);
  Mesh mesh = make_mesh(bordered ? wavy_grid_matrices(40, 30) : shapes::bumpy_icosphere_matrices(4));
  const Policies policies(mesh, options_with(10));
  collapse(mesh, policies, 300);
  const auto& core = policies.state().core();
  SMS::internal::Spectral_collapse_kernel kernel;
  const std::vector<Eigen::Index> slots = policies.state().current_slots();
  std::vector<Eigen::Index> slot(mesh.num_vertices(), -1);
  std::size_t i = 0;
  for(const auto v : vertices(mesh))
    slot[v] = slots[i++];
  double worst = 0;
  int recorded = 0, fresh = 0;
  for(const auto e : edges(mesh)) {
    const auto u = SMS::internal::Spectral_slot((std::min)(slot[source(e, mesh)], slot[target(e, mesh)]));
    const auto v = SMS::internal::Spectral_slot((std::max)(slot[source(e, mesh)], slot[target(e, mesh)]));
    const auto* c = core.candidates().find(u, v);
    REQUIRE(c != nullptr);
    CHECK(c->other == v);
    if(!c->collapsible())
      continue;
    ++recorded;
    const Eigen::Vector3d expected =
        (1 - c->weight) * core.fields().points[u] + c->weight * core.fields().points[v];
    worst = (std::max)(worst, (c->point - expected).norm());
    if(c->version != core.candidates().version())
      continue;
    const auto now = evaluate_like(core, *c, u, kernel);
    if(c->deferred && now.cost != c->cost)
      continue; // it was put off as it is
    ++fresh;
    CHECK(now.cost == c->cost);
    CHECK(now.weight == c->weight);
    CHECK(now.point == c->point);
  }
  CHECK(worst < 1e-12);
  CHECK(recorded > 500);
  CHECK(fresh > 5);
}

TEST_CASE("Edges without length are merged with equal weights before the loop, and E and P stay right")
{
  const bool bordered = GENERATE(false, true);
  Spectral_options options = options_with(10);
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  options.placement = GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::midpoint);
  CAPTURE(bordered, SG::mass_name(options.mass), int(options.placement));
  shapes::Matrices input = bordered ? wavy_grid_matrices(20, 18) : shapes::bumpy_icosphere_matrices(3);
  const auto put_on = [&](const int v, const int w) { input.V.row(v) = input.V.row(w); };
  std::size_t merges = 0;
  for(const int f : {100, 300, 500}) { // one edge
    put_on(input.T(f, 0), input.T(f, 1));
    ++merges;
  }
  put_on(input.T(410, 0), input.T(410, 2)); // a whole face
  put_on(input.T(410, 1), input.T(410, 2));
  merges += 2;
  if(bordered) {    // 21 vertices in a row
    put_on(5, 6);   // along the border
    put_on(12, 33); // towards the border
    put_on(63, 84); // on the left side
    merges += 3;
  }
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options);
  const Input fine = eigen_input(input, options.mass, *policies.eigenpairs());
  const std::size_t n = count_vertices(mesh);
  Recorder recorder;
  SECTION("nothing but them")
  {
    collapse(mesh, policies, n, std::ref(recorder));
    CHECK(count_vertices(mesh) == n - merges);
    CHECK(recorder[collapsed] == merges);
    CHECK(recorder[collapsing] == 0);
    const Eigen::MatrixXd P = policies.restriction();
    CHECK((P.array() == 0.5).count() >= Eigen::Index(2 * (merges - 2)));
    CHECK(no_stale_candidate_around_merged_vertices(mesh, policies));
  }
  SECTION("and many collapses")
  {
    collapse(mesh, policies, 80, std::ref(recorder));
    CHECK(count_vertices(mesh) == 80);
    CHECK(recorder[collapsed] == n - 80);
    CHECK(recorder[collapsing] == n - 80 - merges);
  }
  CHECK(policies.state().number_of_vertices() == count_vertices(mesh));
  CHECK(recorder.costs_are_numbers);
  CHECK(policies.error() > 0);
  CHECK(fault_of_run(mesh, policies, fine) == "");
}

TEST_CASE("An edge without length that must not be collapsed stays, and its neighbours still can be")
{
  // The ends of a bridge between two borders coincide.
  shapes::Matrices input = wavy_grid_matrices(12, 1);
  input.V.row(6) = input.V.row(19);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options_with(5));
  const Input fine = eigen_input(input, SG::Mass::lumped, *policies.eigenpairs());
  Recorder recorder;
  collapse(mesh, policies, 10, std::ref(recorder));
  CHECK(recorder.costs_are_numbers);
  CHECK(count_vertices(mesh) == 10);
  CHECK(fault_of_run(mesh, policies, fine) == "");
}

TEST_CASE("preserve_border collapses an edge with one border vertex onto it")
{
  Spectral_options options = options_with(10);
  options.preserve_border = GENERATE(true, false);
  options.placement = GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::midpoint);
  const shapes::Matrices input = wavy_grid_matrices(20, 18);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options);
  Border_probe probe;
  collapse(mesh, policies, 80, std::ref(probe));
  CHECK(count_vertices(mesh) == 80);
  CHECK(fault_of_run(mesh, policies, eigen_input(input, SG::Mass::lumped, *policies.eigenpairs())) == "");
  CHECK(probe.one_border > 5);
  CHECK((probe.kept == probe.one_border) == options.preserve_border);
}

TEST_CASE("The smallest meshes go as far as the topology lets them")
{
  shapes::Matrices input;
  std::size_t least = 0;
  SECTION("a triangle")
  {
    input = shapes::matrices({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    least = 3;
  }
  SECTION("two triangles")
  {
    input = shapes::grid_matrices(1, 1);
    least = 3;
  }
  SECTION("a tetrahedron")
  {
    input = shapes::tetrahedron_matrices();
    least = 4;
  }
  SECTION("an octahedron")
  {
    input = shapes::matrices(
        {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
        {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}});
    least = 4;
  }
  SECTION("a fan around one inner vertex")
  {
    input = shapes::matrices({{0, 0, 0.1}, {1, 0, 0}, {0.3, 1, 0}, {-1, 0.5, 0}, {-0.2, -1, 0}},
                             {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}});
    least = 3;
  }
  for(const SG::Mass mass : {SG::Mass::lumped, SG::Mass::averaged})
    for(Eigen::Index K = 1; K < input.V.rows(); ++K)
      for(const auto placement :
          {Spectral_placement_strategy::on_edge, Spectral_placement_strategy::midpoint}) {
        CAPTURE(K, SG::mass_name(mass), int(placement));
        Spectral_options options = options_with(K);
        options.mass = mass;
        options.placement = placement;
        Mesh mesh = make_mesh(input);
        const Policies policies(mesh, options);
        collapse(mesh, policies, 1);
        CHECK(count_vertices(mesh) == least);
        const Input fine = eigen_input(input, mass, *policies.eigenpairs());
        // A constant alone, or nothing collapsed: E is rounding.
        const double E = energy(SG::mesh_matrices(mesh), fine.basis, policies.restriction());
        CHECK(std::abs(E - policies.error()) < 1e-8 * (1 + E));
        CHECK(fault_of_restriction(policies.restriction(), policies.vertex_map()) == "");
      }
}

} // namespace test_collapse_loop
