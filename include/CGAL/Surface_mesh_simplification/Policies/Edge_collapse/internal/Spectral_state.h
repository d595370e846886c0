// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_STATE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_STATE_H

#include <CGAL/Named_function_parameters.h>
#include <CGAL/Real_timer.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Fine_vertex_slots.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_collapse_core.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_handle.h>

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>

#include <CGAL/boost/graph/helpers.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>

namespace CGAL::Surface_mesh_simplification::internal {

/*!
 * What cost, placement and visitor of one `Spectral_policies` share: F and Z or their mixtures, the
 * residual R = B Z - L F, mass, E, positions, the restriction, and the counts of what happened.
 *
 * It translates between the mesh and slots (the order of `vertices(mesh)` at construction) and
 * leaves the mathematics to `Spectral_collapse_core`. `edge_collapse()` copies the policies several
 * times; all copies are handles on one state.
 *
 * Life of a run: on_started() builds everything from the mesh as it is; placement() and cost()
 * evaluate an edge; on_collapsing() captures which merge is about to happen; on_collapsed() follows
 * the mesh; on_finished() ends it. A further run continues: F, Z and P go on from where they are.
 */
template <class TriangleMesh, class GeomTraits, class VertexPointMap>
class Spectral_state
{
public:
  using FT = typename GeomTraits::FT;
  using Point = typename boost::property_traits<VertexPointMap>::value_type;
  using vertex_descriptor = typename boost::graph_traits<TriangleMesh>::vertex_descriptor;
  using halfedge_descriptor = typename boost::graph_traits<TriangleMesh>::halfedge_descriptor;
  using Slot = Spectral_slot;

  /// Reads the mesh, finds the basis. `np` as of `Spectral_policies`. Throws
  /// `std::invalid_argument` for a mesh, an option or a basis that cannot be used (the first
  /// offender is named), `Spectral_geometry::Cancelled` where the progress callback asks for it.
  template <class NamedParameters>
  Spectral_state(TriangleMesh& mesh, const Spectral_options& options, const NamedParameters& np)
    : m_mesh(&mesh)
    , m_vpm(parameters::choose_parameter(parameters::get_parameter(np, internal_np::vertex_point),
                                         get_property_map(vertex_point, mesh)))
    , m_has_own_points(
          parameters::is_default_parameter<NamedParameters, internal_np::vertex_point_t>::value)
    , m_traits(parameters::choose_parameter<GeomTraits>(
          parameters::get_parameter(np, internal_np::geom_traits)))
    , m_slots(mesh, "Spectral_policies")
    , m_options(options)
    , m_knows_constraints(
          !parameters::is_default_parameter<NamedParameters,
                                            internal_np::edge_is_constrained_t>::value)
  {
    Real_timer timer;
    timer.start();
    m_fine = Spectral_geometry::mesh_matrices(mesh, np);
    check_fans(mesh, m_fine.T);
    std::vector<char> kept = kept_vertex_flags(mesh, options.kept_vertices, np);
    check_kept_vertices_apart(kept, m_fine.V, m_fine.T);
    m_fixed = fixed_vertex_flags(mesh, kept, np);
    m_core.set_basis(spectral_basis(m_fine.V, m_fine.T, options), local_operator(options), options,
                     std::is_same<FT, float>::value, std::move(kept));
    m_seconds_basis = timer.time();
  }

  Spectral_state(const Spectral_state&) = delete;
  Spectral_state& operator=(const Spectral_state&) = delete;

  /// Before the first run: `collapse()` collapses edges of the mesh, returns their log and the
  /// slots of the vertices that are left. F, Z, P and the quadrics of the shape follow.
  template <class Collapse>
  void collapse_by_others(const Collapse& collapse)
  {
    { // rings take more memory than the quadrics
      const auto [points, rings] = read_geometry();
      m_core.set_input(points, rings);
    }
    const auto [log, slots] = collapse();
    m_slots.set(slots);
    for(std::size_t i = 0; i < log.points().size(); ++i) {
      const Merge& m = log.forest().merges()[i];
      m_core.follow(m, log.points()[i]);
      follow_fixed(m);
    }
  }

  /// Starts a run. It lasts as long as somebody holds the token that is returned, so that an
  /// exception that leaves the loop ends the run as well.
  std::shared_ptr<void> on_started(TriangleMesh& mesh)
  {
    require(&mesh == m_mesh,
            "Spectral_policies: edge_collapse() was called with another mesh than the one "
            "that the policies were made for; make policies for that mesh.");
    m_first_costs = Real_timer(); // a run that threw has left the old one running
    m_first_costs.start();
    m_run.reset();
    auto [points, rings] = read_geometry();
    m_core.set_geometry(std::move(points), std::move(rings));
    m_positions_checked = false;
    m_selecting = m_selection_open = m_stopped = false;
    m_announced.reset();
    m_answer = Answer();
    m_number_of_first_costs = 0;
    m_expected_first_costs = edges(mesh).size(); // num_edges() may count what has been removed
    std::shared_ptr<void> token = std::make_shared<int>(0);
    m_run = token;
    ++m_number_of_runs;
    return token;
  }

  // These follow the callbacks of the visitor that have the same names.
  void on_finished()
  {
    close_selection();
    m_run.reset();
  }

  void on_selected()
  {
    if(m_first_costs.is_running())
      m_first_costs.stop();
    close_selection();
    m_selecting = m_selection_open = true;
    m_filter_asked = false;
    m_answer = Answer();
    m_placement_found.reset();
  }

  void on_stop_condition_reached()
  {
    m_selection_open = false;
    m_stopped = true;
  }

  void on_non_collapsable()
  {
    ++(m_placement_found ? m_refusals.filter : m_refusals.topology);
    m_selection_open = false;
  }

  /// Records which slots are merged, and with which weight: after the collapse some mesh types have
  /// freed the removed vertex, and the kept one has moved. Throws `std::logic_error` if a wrapper
  /// chose the point, no filter was asked, and vertices are kept or self-intersections refused.
  template <class Profile, class OptionalPoint>
  void on_collapsing(const Profile& profile, const OptionalPoint& placement)
  {
    m_selection_open = false;
    const Slot removed = slot(profile.v0()), kept = slot(profile.v1());
    const Eigen::Vector3d point = placement ? to_vector(*placement) : m_core.fields().points[kept];
    if(!m_filter_asked && !is_own_point(removed, kept, point)) {
      m_has_foreign_points = true;
      if(m_options.keep_free_of_self_intersections || !m_core.fields().kept.empty())
        throw std::logic_error(
            "Spectral_policies: the placement is wrapped and chose a point of its own, which may "
            "put a face through another or move a kept vertex; pass spectral.filter() to "
            "edge_collapse() with .filter(), or set keep_free_of_self_intersections to false and "
            "keep no vertices.");
    }
    m_announced = {Eigen::Index(removed), Eigen::Index(kept), weight_of(removed, kept, point)};
    if(!is_answered(removed, kept))
      m_core.postpone_no_more();
  }

  /// Merges the two slots and follows the mesh.
  template <class Profile>
  void on_collapsed(const Profile& profile, const vertex_descriptor kept_vertex)
  {
    if(!m_announced) { // an edge without length, collapsed before the loop
      const Slot u = slot(profile.v0()), v = slot(profile.v1());
      m_announced = {Eigen::Index(u), Eigen::Index(v),
                     m_core.projected_weight(v, u, m_core.fields().points[u])};
    }
    const Merge m = merge_into(slot(kept_vertex), *std::exchange(m_announced, {}));
    m_selecting = false;
    m_answer = Answer();
    follow_fixed(m);
    m_core.commit(m, to_vector(get(m_vpm, kept_vertex)), ring_of(kept_vertex));
  }

  /// The placement of a candidate; no point if it cannot be collapsed. For a selected candidate it
  /// is the best one on the current mesh: a collapse two rings away, after which CGAL does not ask
  /// again, may have changed it.
  template <class Profile>
  auto placement(const Profile& profile)
  {
    using Optional_point = Spectral_optional<Point>;
    check_ready(profile);
    const Slot u = slot(profile.v0()), v = slot(profile.v1());
    // CGAL asks for the cost next, and for the placement again when it selects the edge.
    if(postponed_cost(u, v))
      return Optional_point(Point(profile.p0()));
    const Spectral_sample& c = answer(u, v);
    m_placement_found = c.collapsible();
    if(!c.collapsible())
      return Optional_point();
    // An end stays what it is, whatever its number type.
    if(c.point == m_core.fields().points[u])
      return Optional_point(Point(profile.p0()));
    if(c.point == m_core.fields().points[v])
      return Optional_point(Point(profile.p1()));
    return Optional_point(Point(FT(c.point.x()), FT(c.point.y()), FT(c.point.z())));
  }

  /// cost(e) = sum over H of E_w after - E_w before, at the given point, plus the term of
  /// `Spectral_options::shape`. The largest finite number if there is none: CGAL's queue would sort
  /// an absent cost first.
  template <class Profile, class OptionalPoint>
  auto cost(const Profile& profile, const OptionalPoint& placement)
  {
    using Optional_cost = Spectral_optional<FT>;
    check_ready(profile);
    if(!placement)
      return Optional_cost(largest_cost());
    const Slot u = slot(profile.v0()), v = slot(profile.v1());
    if(const std::optional<double> postponed = postponed_cost(u, v))
      return Optional_cost(FT(*postponed));
    const Eigen::Vector3d point = to_vector(*placement);
    if(m_core.fields().moves_kept_vertex(u, v, point))
      return Optional_cost(largest_cost());
    const Spectral_sample& c = answer(u, v);
    const bool own = is_own_point(u, v, point);
    m_has_foreign_points = m_has_foreign_points || !own;
    const double value = own ? c.cost : m_core.cost_at(u, v, point);
    if(!own || m_selecting)
      m_core.set_queued_cost((std::min)(u, v), (std::max)(u, v), value);
    if(!(value < double((std::numeric_limits<float>::max)())))
      return Optional_cost(largest_cost());
    return Optional_cost(FT(value));
  }

  /// The relative error after the collapse of the selected candidate, to rounding; that of now if
  /// it cannot be collapsed. `get_placement` is the one that `edge_collapse()` has been given: the
  /// cost in CGAL's queue may be out of date.
  template <class Profile, class GetPlacement>
  double relative_error_after(const Profile& profile, const GetPlacement& get_placement)
  {
    const std::optional<bool> found = m_placement_found;
    const auto placement = get_placement(profile);
    m_placement_found = found; // CGAL itself has not asked yet
    if(!placement)
      return relative_error();
    const Slot u = slot(profile.v0()), v = slot(profile.v1());
    const Eigen::Vector3d point = to_vector(*placement);
    if(m_core.fields().moves_kept_vertex(u, v, point))
      return relative_error();
    return relative_error(error() + m_core.change_at(v, u, weight_of(u, v, point), point));
  }

  /// Whether a filter accepts a placement. It refuses one that would move a kept vertex or merge
  /// two of them, and one of a wrapper that would put a face through another.
  template <class Profile, class OptionalPoint>
  bool lets_through(const Profile& profile, const OptionalPoint& placement)
  {
    // CGAL has reached the filter, whether or not a wrapper has called our own placement.
    m_placement_found = m_filter_asked = true;
    if(!placement)
      return false;
    const Slot u = slot(profile.v0()), v = slot(profile.v1());
    const Eigen::Vector3d point = to_vector(*placement);
    if(m_core.fields().moves_kept_vertex(u, v, point))
      return false;
    answer(u, v); // which has been looked at
    return is_own_point(u, v, point) || !m_core.crosses(u, v, point);
  }

  const Collapse_log& log() const { return m_core.log(); }

  /// The slots of `vertices(mesh)`, in that order. Throws `std::logic_error` where the merges on
  /// record are not all that has happened to the mesh.
  std::vector<Eigen::Index> current_slots() const
  {
    std::vector<Eigen::Index> slots = m_slots.current();
    if(slots.size() != number_of_vertices())
      throw std::logic_error(
          "Spectral_policies: vertices of the mesh have been removed without the visitor of the "
          "policies; make new policies for the mesh as it is.");
    return slots;
  }

  const TriangleMesh& mesh() const { return *m_mesh; }
  /// The map that positions are read from.
  VertexPointMap vertex_point_map() const
  {
    using Own_map = typename boost::property_map<TriangleMesh, vertex_point_t>::type;
    if constexpr(std::is_same<VertexPointMap, Own_map>::value)
      if(m_has_own_points) // looked up: where they are changes when the mesh is assigned to
        return get(vertex_point, *m_mesh);
    return m_vpm;
  }
  const GeomTraits& geom_traits() const { return m_traits; }
  const Spectral_collapse_core& core() const { return m_core; }
  /// Gives back the memory of what only collapses need: nothing may be collapsed afterwards.
  void release() { m_core.release(); }
  /// The input, which the eigenpairs are of.
  const Spectral_geometry::Mesh_matrices& fine() const { return m_fine; }
  /// What the metric preserves of it, but for the signals that the collapses carry.
  const Spectral_basis& basis() const { return m_core.basis(); }
  /// Candidates that were refused so far, over all runs.
  Spectral_refusals refusals() const
  {
    Spectral_refusals all = m_refusals;
    all.crossing = m_core.number_of_crossings();
    return all;
  }
  std::size_t number_of_vertices() const { return log().number_of_vertices_left(); }
  /// Whether the last run ended because every edge left was refused, not by its stop predicate.
  bool has_run_out_of_edges() const
  {
    return m_number_of_runs != 0 && m_run.expired() && !m_stopped;
  }
  const Spectral_options& options() const { return m_options; }
  /// Whether a wrapper of the placement has chosen points of its own.
  bool has_foreign_points() const { return m_has_foreign_points; }
  bool knows_constraints() const { return m_knows_constraints; }
  /// For each of `vertices(mesh)` whether it must not move after the collapses, as a kept vertex or
  /// the end of a constrained edge. Empty if there are none.
  std::vector<bool> fixed_vertices() const { return flags_now(m_fixed); }
  /// For each of `vertices(mesh)` whether it is kept with its row of P. Empty if there are none.
  std::vector<bool> kept_vertices() const { return flags_now(m_core.fields().kept); }
  std::size_t number_of_runs() const { return m_number_of_runs; }
  /// E of the current mesh. What is left of 0 after sums and differences is never negative.
  double error() const { return (std::max)(0., m_core.total()); }
  /// sqrt(E / sum_k lambda_k^2); 0 for constant signals, which P carries over exactly.
  double relative_error() const { return relative_error(error()); }
  double relative_error(const double E) const
  {
    const double lost = basis().sum_of_squares; // all of it
    return lost > 0 ? std::sqrt((std::max)(0., E) / lost) : 0.;
  }
  /// Wall seconds of the constructor.
  double seconds_basis() const { return m_seconds_basis; }
  /// Wall seconds of evaluating every edge once, in the last run.
  double seconds_first_costs() const { return m_first_costs.time(); }

  bool is_cancelled() const { return Spectral_geometry::internal::is_cancelled(m_options); }

  /// Calls the progress callback, if any; `false` means that the user cancelled.
  bool report(const Spectral_geometry::Phase phase, const double fraction) const
  {
    return Spectral_geometry::internal::goes_on(m_options, {phase, fraction, number_of_vertices()});
  }

private:
  // The last answer: how to collapse the edge u < v. It is valid until the mesh changes or an edge
  // is selected.
  struct Answer
  {
    Slot u = 0, v = 0;
    std::optional<Spectral_sample> sample;
  };

  using Merge = Spectral_geometry::Merge_forest::Merge;

  static FT largest_cost()
  {
    using Number = std::conditional_t<std::is_same<FT, float>::value, float, double>;
    return FT((std::numeric_limits<Number>::max)());
  }

  Slot slot(const vertex_descriptor v) const { return Slot(m_slots.slot(v)); }

  // None for an edge with a valid answer: its cost is up to date.
  std::optional<double> postponed_cost(const Slot u, const Slot v) const
  {
    return m_selecting || is_answered(u, v)
               ? std::nullopt
               : m_core.postponed_cost((std::min)(u, v), (std::max)(u, v));
  }

  bool is_answered(const Slot u, const Slot v) const
  {
    return m_answer.sample && m_answer.u == (std::min)(u, v) && m_answer.v == (std::max)(u, v);
  }

  // CGAL asks for the placement of an edge and then for the cost of that.
  const Spectral_sample& answer(Slot u, Slot v)
  {
    if(v < u)
      std::swap(u, v);
    if(!is_answered(u, v)) {
      if(m_first_costs.is_running())
        report_first_cost();
      m_answer = {u, v, m_selecting ? m_core.select(u, v) : m_core.evaluate(u, v)};
    }
    return *m_answer.sample;
  }

  // Called for each cost before the first collapse of a run, where cancelling leaves the mesh as it
  // is.
  void report_first_cost()
  {
    const std::size_t between_reports =
        (std::min)(std::size_t(1024), m_expected_first_costs / 100 + 1);
    if(m_number_of_first_costs++ % between_reports == 0 &&
       !report(Spectral_geometry::Phase::first_costs,
               (std::min)(1., double(m_number_of_first_costs) / double(m_expected_first_costs))))
      throw Spectral_geometry::Cancelled();
  }

  // Whether the last answer, of which nothing may have changed since, offered this point.
  bool is_own_point(const Slot u, const Slot v, const Eigen::Vector3d& point) const
  {
    return is_answered(u, v) && m_answer.sample->collapsible() && m_answer.sample->point == point;
  }

  // The merged vertex is fixed if one of the two was, whichever handle the mesh keeps.
  void follow_fixed(const Merge& m)
  {
    if(!m_fixed.empty() && m_fixed[m.removed])
      m_fixed[m.kept] = true;
  }

  // Flags of slots in the order of `vertices(mesh)`; empty if there are none.
  std::vector<bool> flags_now(const std::vector<char>& flags) const
  {
    std::vector<bool> result;
    if(!flags.empty())
      for(const Eigen::Index s : current_slots())
        result.push_back(flags[s] != 0);
    return result;
  }

  // The weight of `removed` when it is merged into `kept` at `point`: that of the answer if it
  // offered this point, otherwise that of the projection.
  double weight_of(const Slot removed, const Slot kept, const Eigen::Vector3d& point) const
  {
    if(is_own_point(removed, kept, point))
      return m_answer.v == removed ? m_answer.sample->weight : 1 - m_answer.sample->weight;
    return m_core.projected_weight(kept, removed, point);
  }

  // Starting at the smallest slot makes sums independent of the halfedge that a mesh type starts
  // with.
  Spectral_ring ring_of(const vertex_descriptor v) const
  {
    Spectral_ring ring;
    const halfedge_descriptor h0 = halfedge(v, *m_mesh);
    if(h0 == boost::graph_traits<TriangleMesh>::null_halfedge())
      return ring;
    for(const halfedge_descriptor h : halfedges_around_target(h0, *m_mesh)) {
      ring.emplace_back();
      ring.back().vertex = slot(source(h, *m_mesh));
      ring.back().face = !is_border(h, *m_mesh);
    }
    std::rotate(ring.begin(),
                std::min_element(ring.begin(), ring.end(),
                                 [](const auto& a, const auto& b) { return a.vertex < b.vertex; }),
                ring.end());
    return ring;
  }

  // Positions and rings of the mesh as it is.
  std::pair<std::vector<Eigen::Vector3d>, Spectral_rings> read_geometry()
  {
    const std::vector<Eigen::Index> slots = current_slots();
    m_vpm = vertex_point_map();
    const std::size_t n = std::size_t(m_fine.V.rows());
    std::vector<Eigen::Vector3d> points(n, Eigen::Vector3d::Zero());
    Spectral_rings rings;
    rings.resize(n);
    std::size_t i = 0;
    for(const vertex_descriptor v : vertices(*m_mesh)) {
      const Slot s = Slot(slots[i++]);
      points[s] = to_vector(get(m_vpm, v));
      rings[s] = ring_of(v);
    }
    return {std::move(points), std::move(rings)};
  }

  void close_selection()
  {
    if(m_selection_open)
      ++(m_placement_found.value_or(true) ? m_refusals.geometry : m_refusals.placement);
    m_selection_open = false;
  }

  template <class Profile>
  void check_ready(const Profile& profile)
  {
    if(m_run.expired())
      throw std::logic_error(
          "Spectral_policies: a cost or placement was asked for outside of a run; pass "
          "spectral.visitor() to edge_collapse() with .visitor().");
    if(m_positions_checked)
      return;
    for(const vertex_descriptor v : {profile.v0(), profile.v1()})
      if(to_vector(get(profile.vertex_point_map(), v)) != m_core.fields().points[slot(v)])
        throw std::logic_error(
            "Spectral_policies: the vertex_point_map of edge_collapse() disagrees with that "
            "of the policies; pass the same map to both.");
    m_positions_checked = true;
  }

  TriangleMesh* m_mesh;
  VertexPointMap m_vpm;
  bool m_has_own_points; // of the mesh, not a map of the user's
  GeomTraits m_traits;
  Fine_vertex_slots<TriangleMesh> m_slots;
  Spectral_options m_options; // relocation needs the signals again, at all vertices
  bool m_knows_constraints;
  std::vector<char> m_fixed; // slots that are kept or at the ends of constrained edges, or none

  Spectral_geometry::Mesh_matrices m_fine;
  Spectral_collapse_core m_core;

  std::weak_ptr<void> m_run;
  std::size_t m_number_of_runs = 0;
  Answer m_answer;
  std::optional<Merge> m_announced; // the collapse under way
  bool m_positions_checked = false;
  bool m_selecting = false;      // a placement asked for now is that of the selected candidate
  bool m_selection_open = false; // selected, and nothing has become of it yet
  bool m_filter_asked = false;   // for it
  bool m_stopped = false;        // the run, by its stop predicate
  bool m_has_foreign_points = false;
  std::optional<bool> m_placement_found; // whether there was one for it; none: not asked yet
  Spectral_refusals m_refusals;          // but for `crossing`
  double m_seconds_basis = 0;
  Real_timer m_first_costs; // runs until the first edge is selected
  std::size_t m_number_of_first_costs = 0, m_expected_first_costs = 0;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_STATE_H
