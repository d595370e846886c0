// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// How the policies live inside CGAL's loop: visitors, misuse, exceptions, several runs, difficult
// edges.

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_collapse_core.h>

#include "catch.h"
#include "collapse_helpers.h"

namespace test_collapse_loop {

using namespace spectral_test;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;
using SMS::Spectral_options;
using SMS::Spectral_placement_strategy;
using Point = Kernel::Point_3;
using Slot = SMS::internal::Spectral_slot;

namespace {

constexpr double unknown_cost = SMS::internal::Spectral_ring_entry::unknown_cost;

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

// At every collapse: the edges whose costs CGAL has asked for in either direction. After the run:
// what differed.
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

// CGAL does not cost edges again after it has merged the ends of an edge without length: what was
// known of the edges there must be forgotten.
bool costs_at_merged_vertices_are_forgotten(const Mesh& mesh, const Policies& policies)
{
  const SMS::internal::Spectral_rings& rings = policies.state().core().fields().rings;
  const Eigen::SparseMatrix<double, Eigen::RowMajor> P = policies.restriction();
  const std::vector<Eigen::Index> slots = policies.state().current_slots();
  int merged = 0;
  for(Eigen::Index row = 0; row < P.rows(); ++row) {
    const Slot w = Slot(slots[std::size_t(row)]);
    merged += P.row(row).nonZeros() > 1;
    for(const auto& e : rings[w])
      if(P.row(row).nonZeros() > 1 &&
         (rings[w][rings.find(w, e.vertex)].cost != unknown_cost ||
          rings[e.vertex][rings.find(e.vertex, w)].cost != unknown_cost))
        return false;
  }
  return merged > 0 && count_vertices(mesh) == slots.size();
}

// What CGAL is told that edges cost, beside what they cost. Slots are vertices: nothing has been
// removed before.
struct Watch
{
  using Edge = std::pair<Slot, Slot>;

  const Policies* policies = nullptr;
  std::map<Edge, double> told;
  double recent = 0; // about the largest cost of the edges that were selected lately
  std::set<Slot> link;
  Slot kept = 0;
  bool selecting = false;
  std::size_t asked = 0, postponed = 0, wrong = 0;

  static Edge edge(const Mesh::Vertex_index v, const Mesh::Vertex_index w)
  {
    return std::minmax(Slot(std::uint32_t(v)), Slot(std::uint32_t(w)));
  }
  double cost_now(const Edge& e) const
  {
    SMS::internal::Spectral_collapse_core core = policies->state().core();
    return core.evaluate(e.first, e.second).cost;
  }
  void tell(const Edge& e, const double cost)
  {
    ++asked;
    const double now = cost_now(e);
    if(cost != now && (std::isfinite(now) || cost < 1e300)) {
      ++postponed;
      const bool inner = link.count(e.first) != 0 && link.count(e.second) != 0;
      const bool is_old = told.count(e) != 0 && told[e] == cost;
      wrong += !is_old || e.first == kept || e.second == kept || !(cost > (inner ? 8 : 2) * recent);
    }
    told[e] = cost;
  }
};

struct Watched_cost
{
  template <class Profile, class Placement>
  auto operator()(const Profile& profile, const Placement& placement) const
  {
    const auto result = cost(profile, placement);
    watch->tell(Watch::edge(profile.v0(), profile.v1()), result ? *result : 0);
    return result;
  }
  Policies::Get_cost cost;
  Watch* watch;
};

struct Watched_placement
{
  template <class Profile>
  auto operator()(const Profile& profile) const
  {
    const auto result = placement(profile);
    if(result && watch->selecting)
      watch->recent = (std::max)(watch->cost_now(Watch::edge(profile.v0(), profile.v1())),
                                 0.998 * watch->recent);
    return result;
  }
  Policies::Get_placement placement;
  Watch* watch;
};

struct Watching_visitor : SMS::internal::Dummy_visitor
{
  explicit Watching_visitor(Watch& w)
    : watch(&w)
  {}
  template <class P, class C, class S>
  void OnSelected(const P&, const C&, S, S)
  {
    watch->selecting = true;
  }
  template <class P>
  void OnCollapsed(const P&, const Mesh::Vertex_index kept)
  {
    watch->selecting = false;
    watch->kept = std::uint32_t(kept);
    watch->link.clear();
    for(const auto& e : watch->policies->state().core().fields().rings[watch->kept])
      watch->link.insert(e.vertex);
  }
  Watch* watch;
};

} // namespace

TEST_CASE(
    "A cost is that of now whenever CGAL asks, or an older one far above those of recent collapses")
{
  const auto placement =
      GENERATE(SMS::Spectral_placement_strategy::on_edge, SMS::Spectral_placement_strategy::free);
  const double shape = GENERATE(0., 3.);
  CAPTURE(int(placement), shape);
  Mesh mesh = make_mesh(wavy_grid_matrices(16, 14));
  SMS::Spectral_options options = options_with(8);
  options.placement = placement;
  options.shape = shape;
  const Policies policies(mesh, options);
  Watch watch;
  watch.policies = &policies;
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(60, mesh),
                     CGAL::parameters::get_cost(Watched_cost{policies.get_cost(), &watch})
                         .get_placement(Watched_placement{policies.get_placement(), &watch})
                         .visitor(policies.visitor(Watching_visitor(watch))));
  CHECK(count_vertices(mesh) == 60);
  CHECK(watch.asked > 1000);
  CHECK(watch.postponed > watch.asked / 10);
  CHECK(watch.wrong == 0);
  // What is postponed is not evaluated.
  CHECK(policies.state().core().number_of_evaluations() < watch.asked);
}

TEST_CASE("With a placement of the user's a cost is that of its point, or the one that CGAL was "
          "told before")
{
  const bool calls_ours = GENERATE(false, true);
  CAPTURE(calls_ours);
  Mesh mesh = make_mesh(wavy_grid_matrices(16, 14));
  const Policies policies(mesh, options_with(8));
  Watch watch;
  watch.policies = &policies;
  std::size_t asked = 0, postponed = 0, wrong = 0;
  const auto placement = [&](const auto& profile) {
    if(calls_ours && !policies.get_placement()(profile))
      return SMS::internal::Spectral_optional<Point>();
    return SMS::internal::Spectral_optional<Point>(
        CGAL::barycenter(profile.p0(), 0.8, profile.p1(), 0.2));
  };
  const auto cost = [&](const auto& profile, const auto& point) {
    const auto result = policies.get_cost()(profile, point);
    if(!point || !(*result < 1e300))
      return result;
    const Watch::Edge e = Watch::edge(profile.v0(), profile.v1());
    SMS::internal::Spectral_collapse_core core = policies.state().core();
    const Eigen::Vector3d x(point->x(), point->y(), point->z());
    const double now = core.cost_at(e.first, e.second, x);
    const bool is_old = std::abs(*result - now) > 1e-9 * (std::abs(now) + core.total());
    wrong += is_old && (watch.told.count(e) == 0 || watch.told[e] != *result);
    watch.told[e] = *result;
    postponed += is_old;
    ++asked;
    return result;
  };
  SMS::edge_collapse(
      mesh, SMS::Vertex_count_stop_predicate<Mesh>(60, mesh),
      CGAL::parameters::get_cost(cost).get_placement(placement).visitor(policies.visitor()));
  CHECK(count_vertices(mesh) == 60);
  CHECK(asked > 1000);
  CHECK(wrong == 0);
  CHECK(postponed < asked / (calls_ours ? 1 : 20));
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
  CHECK(recorder[selected] ==
        n - 40 + 1 + refusals.topology + refusals.geometry + refusals.placement);
  CHECK(refusals.filter == 0);
  CHECK(recorder.costs_are_numbers);
}

TEST_CASE("After an exception of the user's visitor the run is over, the mesh valid, and the "
          "policies go on")
{
  const Call where =
      GENERATE(started, finished, stopped, collected, selected, collapsing, collapsed);
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
  Mesh mesh =
      make_mesh(bordered ? wavy_grid_matrices(25, 24) : shapes::bumpy_icosphere_matrices(3));
  const Policies policies(mesh, options);
  Direction_probe probe(policies);
  collapse(mesh, policies, 60, std::ref(probe));
  CHECK(probe.compared > 200);
  CHECK(probe.same);
}

TEST_CASE("After many collapses an edge weighs the vertices that it says")
{
  const bool bordered = GENERATE(false, true);
  Mesh mesh =
      make_mesh(bordered ? wavy_grid_matrices(40, 30) : shapes::bumpy_icosphere_matrices(4));
  const Policies policies(mesh, options_with(10));
  collapse(mesh, policies, 300);
  SMS::internal::Spectral_collapse_core core = policies.state().core();
  const SMS::internal::Spectral_fields& fields = policies.state().core().fields();
  const std::vector<Eigen::Index> slots = policies.state().current_slots();
  std::vector<Eigen::Index> slot(mesh.num_vertices(), -1);
  std::size_t i = 0;
  for(const auto v : vertices(mesh))
    slot[v] = slots[i++];
  double worst = 0, worst_point = 0;
  int collapsible = 0, on_record = 0;
  for(const auto e : edges(mesh)) {
    const auto source_and_target = {slot[source(e, mesh)], slot[target(e, mesh)]};
    const Slot u = Slot((std::min)(source_and_target)), v = Slot((std::max)(source_and_target));
    const auto c = core.evaluate(u, v);
    const double recorded = fields.rings[u][fields.rings.find(u, v)].cost;
    on_record += recorded == c.cost;
    // None that could be put off has been forgotten.
    CHECK(recorded != unknown_cost);
    if(!c.collapsible())
      continue;
    ++collapsible;
    const Eigen::Vector3d expected =
        (1 - c.weight) * fields.points[u] + c.weight * fields.points[v];
    worst = (std::max)(worst, (c.point - expected).norm());
    const auto p = mesh.point(source(e, mesh));
    worst_point = (std::max)(worst_point, (fields.points[std::size_t(slot[source(e, mesh)])] -
                                           Eigen::Vector3d(p.x(), p.y(), p.z()))
                                              .norm());
  }
  CHECK(worst < 1e-12);
  CHECK(worst_point == 0);
  CHECK(collapsible > 500);
  CHECK(on_record > 50);
}

TEST_CASE(
    "Edges without length are merged with equal weights before the loop, and E and P stay right")
{
  const bool bordered = GENERATE(false, true);
  Spectral_options options = options_with(10);
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  options.placement =
      GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::midpoint);
  CAPTURE(bordered, SG::mass_name(options.mass), int(options.placement));
  shapes::Matrices input =
      bordered ? wavy_grid_matrices(20, 18) : shapes::bumpy_icosphere_matrices(3);
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
    CHECK(costs_at_merged_vertices_are_forgotten(mesh, policies));
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

TEST_CASE("An edge without length that must not be collapsed hinders no other")
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
  options.placement =
      GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::midpoint);
  const shapes::Matrices input = wavy_grid_matrices(20, 18);
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options);
  Border_probe probe;
  collapse(mesh, policies, 80, std::ref(probe));
  CHECK(count_vertices(mesh) == 80);
  CHECK(fault_of_run(mesh, policies,
                     eigen_input(input, SG::Mass::lumped, *policies.eigenpairs())) == "");
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
