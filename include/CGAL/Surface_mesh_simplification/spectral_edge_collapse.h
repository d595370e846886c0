// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_COLLAPSE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_COLLAPSE_H

#include <CGAL/Real_timer.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/stages/around_collapses.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/stages/run_explanations.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_result.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/boost/graph/properties.h>

namespace CGAL::Surface_mesh_simplification {

namespace internal {

using Stop_reason = Spectral_edge_collapse_result::Stop_reason;

/// Keeps the state in step during one of several runs of the loop. The user's visitor sees all runs
/// as one: `run_spectral_stage()` tells it that they begin and end.
template <class State, class UserVisitor>
struct Visitor_of_runs : Spectral_visitor<State, UserVisitor>
{
  using Spectral_visitor<State, UserVisitor>::Spectral_visitor;

  template <class TriangleMesh>
  void OnStarted(TriangleMesh& mesh)
  {
    this->m_run = this->m_follower->on_started(mesh);
  }

  template <class TriangleMesh>
  void OnFinished(TriangleMesh&)
  {
    this->m_follower->on_finished();
    this->m_run.reset();
  }
};

/// Runs the loop with the user's constraint map and filter, if any. Returns what ended it, unless
/// that was the target.
template <class TriangleMesh, class Policies, class Visitor, class NamedParameters>
Stop_reason run_spectral_edge_collapse(TriangleMesh& mesh, const Policies& policies,
                                       const std::size_t target, const double maximum_error,
                                       Visitor& user, const NamedParameters& np)
{
  using parameters::choose_parameter;
  using parameters::get_parameter;
  constexpr bool has_constraints = is_given<NamedParameters, internal_np::edge_is_constrained_t>;

  const Visitor_of_runs<typename Policies::State, std::reference_wrapper<Visitor>> visitor(
      policies.shared_state(), user);
  const auto common = parameters::visitor(visitor)
                          .vertex_point_map(policies.state().vertex_point_map())
                          .geom_traits(policies.state().geom_traits());
  const auto run = [&](const auto& placement, const auto& with_placement) {
    const Spectral_stop_predicate stop(policies, target, maximum_error, placement);
    const auto with_cost = with_placement.get_cost(policies.get_cost()).get_placement(placement);
    if constexpr(has_constraints || is_given<NamedParameters, internal_np::filter_t>)
      edge_collapse(mesh, stop,
                    with_cost.filter(policies.filter(
                        choose_parameter(get_parameter(np, internal_np::filter), Dummy_filter()))));
    else
      edge_collapse(mesh, stop, with_cost);
    return stop.cancelled()       ? Stop_reason::cancelled
           : stop.error_reached() ? Stop_reason::error_reached
                                  : Stop_reason::queue_exhausted;
  };
  if constexpr(has_constraints) {
    const auto ecm = get_parameter(np, internal_np::edge_is_constrained);
    using Map = std::decay_t<decltype(ecm)>;
    return run(
        Constrained_placement<typename Policies::Get_placement, Map>(ecm, policies.get_placement()),
        common.edge_is_constrained_map(ecm));
  } else
    return run(policies.get_placement(), common);
}

/// Makes the policies of the spectral stage. Throws `std::runtime_error` if they refuse what the
/// first stage left: `std::invalid_argument` means that the input has not been changed.
template <class Policies, class TriangleMesh, class NamedParameters>
Policies policies_of_stage(TriangleMesh& mesh, const Spectral_options& options,
                           const NamedParameters& np, const Pre_simplification& first)
{
  if(!first.done)
    return Policies(mesh, options, np);
  // Vertices to keep may have other handles now: they are known by index, no longer by the user's
  // map.
  using parameters::choose_parameter;
  using parameters::get_parameter;
  const auto points = choose_parameter(get_parameter(np, internal_np::vertex_point),
                                       get_property_map(vertex_point, mesh));
  const auto traits =
      choose_parameter<typename Policies::Geom_traits>(get_parameter(np, internal_np::geom_traits));
  try {
    return Policies(mesh, options, parameters::vertex_point_map(points).geom_traits(traits));
  } catch(const std::invalid_argument& error) {
    throw std::runtime_error(
        sentence("spectral_edge_collapse: the mesh of ", first.slots.size(),
                 " vertices that the first stage has left cannot be used, choose another "
                 "pre_simplify or repair the input (",
                 error.what(), ")"));
  }
}

/// Makes the collapses of `Spectral_edge_collapse_options::quadrics_above`; the state of the
/// policies follows them.
template <class TriangleMesh, class Policies, class NamedParameters>
void collapse_ahead_by_quadrics(TriangleMesh& mesh, const Policies& policies,
                                const std::size_t target,
                                const Spectral_edge_collapse_options& options,
                                const NamedParameters& np, Spectral_edge_collapse_result& result)
{
  auto& state = policies.state();
  const std::size_t n = state.number_of_vertices();
  if(is_given<NamedParameters, internal_np::filter_t, internal_np::visitor_t> ||
     !quadrics_come_first(options))
    return;
  // At least one collapse is left to the loop, so that a run cancelled before it ends above the
  // target.
  const double end = (std::max)(std::floor(options.quadrics_above * double(target)), target + 1.);
  if(!(double(n) > end))
    return;
  Real_timer timer;
  timer.start();
  state.collapse_by_others([&] {
    return collapse_by_quadrics(mesh, std::size_t(end), state.core().fields().kept, options, np);
  });
  result.quadric_collapses += n - state.number_of_vertices();
  result.seconds_pre_simplification += timer.time();
}

/// The stage of the spectral cost.
template <class TriangleMesh, class NamedParameters>
void run_spectral_stage(TriangleMesh& mesh, const std::size_t target,
                        const Spectral_edge_collapse_options& given, const NamedParameters& np,
                        Pre_simplification& first, Spectral_edge_collapse_result& result)
{
  using Vertex_point_map = typename GetVertexPointMap<TriangleMesh, NamedParameters>::type;
  using Geom_traits = typename GetGeomTraits<TriangleMesh, NamedParameters>::type;
  using Policies = Spectral_policies<TriangleMesh, Geom_traits, Vertex_point_map>;
  const Eigen::Index K = number_of_signals(given);
  const auto weights = [&] {
    return weights_for_target(target, K,
                              number_of_components(Spectral_geometry::mesh_matrices(mesh, np)));
  };
  // No copy where there is no need: signals may be large.
  std::optional<Spectral_edge_collapse_options> narrowed;
  if(std::isfinite(given.maximum_error)) { // a bound holds for all signals, not for an estimate
    narrowed = given;
    narrowed->largest_loss = std::numeric_limits<double>::infinity();
    narrowed->number_of_mixtures = 0;
  } else if(is_filtered(given)) {
    narrowed = given;
    narrowed->number_of_eigenvectors = Eigen::Index(weights().sum());
  } else if(given.signals.size() == 0 && given.weights.size() == 0 &&
            Eigen::Index(target / 3) < K) {
    narrowed = given;
    narrowed->weights = weights();
  }
  const Spectral_edge_collapse_options& options = narrowed ? *narrowed : given;
  const Policies policies = policies_of_stage<Policies>(mesh, options, np, first);
  auto& state = policies.state();
  result.pre_simplified_vertices = std::size_t(state.fine().V.rows());
  result.signals = std::size_t(options.weights.size() == 0 ? number_of_signals(options)
                                                           : (options.weights.array() > 0).count());
  warn_of_eigenpairs(result.warnings, policies.eigenpairs().get());
  if(!std::isfinite(options.maximum_error))
    warn_of_target(result.warnings, target, K, Eigen::Index(result.signals));

  collapse_ahead_by_quadrics(mesh, policies, target, options, np, result);
  Real_timer timer;
  timer.start();
  Stop_reason end = Stop_reason::queue_exhausted;
  // CGAL does not ask again for an edge that was refused because of another sheet when that sheet
  // changes. So the loop runs again while that removes a hundredth of the vertices.
  bool again = true;
  auto given_visitor = parameters::choose_parameter(
      parameters::get_parameter(np, internal_np::visitor), Dummy_visitor());
  auto& user = std::ref(given_visitor).get(); // what a reference_wrapper refers to
  user.OnStarted(mesh);
  try {
    for(std::size_t before = (std::numeric_limits<std::size_t>::max)(); again;
        before = state.number_of_vertices()) {
      end = run_spectral_edge_collapse(mesh, policies, target, options.maximum_error, user, np);
      again = end == Stop_reason::queue_exhausted && state.core().number_of_crossings() != 0 &&
              state.number_of_vertices() > target &&
              state.number_of_vertices() < before - before / 100;
    }
  } catch(const Spectral_geometry::Cancelled&) {
    if(state.log().points().empty())
      throw;
    end = Stop_reason::cancelled; // while first costs were evaluated, after collapses
  }
  user.OnFinished(mesh);
  result.seconds_collapse = timer.time();
  result.evaluations = state.core().number_of_evaluations();
  result.seconds_eigenpairs = state.seconds_basis();
  result.seconds_first_costs = state.seconds_first_costs();

  result.output_vertices = state.number_of_vertices();
  result.collapses = result.input_vertices - result.output_vertices;
  result.refusals = state.refusals();
  if(result.output_vertices > target) {
    result.stop_reason = end;
    if(end == Stop_reason::cancelled)
      set_cancelled(result);
    else if(end == Stop_reason::queue_exhausted)
      result.explanation = explain_exhausted_queue(Spectral_geometry::mesh_matrices(mesh, np),
                                                   result.refusals, target);
  }
  result.eigenpairs = policies.eigenpairs();
  std::vector<Eigen::Index> slots = state.current_slots();
  if(first.done) {
    Collapse_log log = std::move(first.log);
    log.append(policies.log(), first.slots);
    for(Eigen::Index& s : slots)
      s = first.slots[s];
    set_restriction(result, std::move(log), slots);
  } else
    set_restriction(result, policies.log(), slots);
  if(options.coefficients.rows() != 0)
    result.coefficients = policies.restriction() * options.coefficients;
  state.release();
  Spectral_post_process(mesh, policies, given, np, result).run(first);
}

/// The rest of a run after its first stage. The mesh has changed, so a cancelled run returns what
/// was done.
template <class TriangleMesh, class NamedParameters>
void run_after_first_stage(TriangleMesh& mesh, const std::size_t target,
                           Spectral_edge_collapse_options options, const NamedParameters& np,
                           Pre_simplification& first, Spectral_edge_collapse_result& result)
{
  options.kept_vertices = first.kept_vertices;
  if(options.coefficients.rows() != 0)
    options.coefficients = first.log.forest().restriction(first.slots) * options.coefficients;
  try {
    run_spectral_stage(mesh, target, options, np, first, result);
  } catch(const Spectral_geometry::Cancelled&) {
    if(first.log.number_of_vertices() == 0) // it has gone into the result
      throw;
    result.output_vertices = result.pre_simplified_vertices = first.slots.size();
    result.collapses = result.input_vertices - result.output_vertices;
    set_cancelled(result, ", before the first spectral collapse");
    set_restriction(result, first.log, first.slots);
    result.coefficients = options.coefficients;
  }
}

} // namespace internal

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * Simplifies a mesh to a number of vertices and preserves its Laplace-Beltrami spectrum: the
 * one-call form of `Spectral_policies` with `edge_collapse()` and `Spectral_stop_predicate`.
 *
 * @param mesh a triangle mesh without isolated vertices; changed in place, garbage is not collected
 * @param number_of_vertices the target N, at most the number of vertices of the mesh. At least 3 K
 *        is advised (section 4.3 of the paper); the result warns of a smaller target. A target that
 *        small components or handles would use up, so that nothing of the shape is left, is refused
 *        with the number to ask for. With an error bound neither applies
 * @param options see `Spectral_edge_collapse_options`
 * @param np an optional sequence of named parameters among those below, which are those of
 * `edge_collapse()` and one more
 *
 * \cgalNamedParamsBegin
 *   \cgalParamNBegin{vertex_point_map}
 *     \cgalParamDescription{the positions of the vertices}
 *     \cgalParamType{a model of `ReadWritePropertyMap` from vertices to points}
 *     \cgalParamDefault{the mesh's own map}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{geom_traits}
 *     \cgalParamDescription{the kernel}
 *     \cgalParamType{one whose numbers `CGAL::to_double()` reads}
 *     \cgalParamDefault{that of the points}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{edge_is_constrained_map}
 *     \cgalParamDescription{edges that stay as they are; the placement is then wrapped in
 *     `Constrained_placement`}
 *     \cgalParamType{a model of `ReadWritePropertyMap` from edges to `bool`}
 *     \cgalParamDefault{no edge is constrained}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{vertex_is_constrained_map}
 *     \cgalParamDescription{vertices to keep, see `Spectral_options::kept_vertices`}
 *     \cgalParamType{a model of `ReadablePropertyMap` from vertices to `bool`}
 *     \cgalParamDefault{no vertex is}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{filter}
 *     \cgalParamDescription{refuses placements}
 *     \cgalParamType{a model of `PlacementFilter`}
 *     \cgalParamDefault{none}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{visitor}
 *     \cgalParamDescription{is called at every step}
 *     \cgalParamType{a model of `EdgeCollapseSimplificationVisitor`}
 *     \cgalParamDefault{none}
 *   \cgalParamNEnd
 * \cgalNamedParamsEnd
 *
 * Collapses by quadrics work on arrays and call neither filter nor visitor: if one is given,
 * `Spectral_edge_collapse_options::pre_simplify` is refused and `quadrics_above` is ignored. The
 * other named parameters of `edge_collapse()` do not compile: the metric decides on cost, placement
 * and order, and has its own indices.
 *
 * \pre `CGAL::is_triangle_mesh(mesh)`
 *
 * @return P, the vertex map, the log of all collapses, why it stopped, counts and times
 *
 * @throws std::invalid_argument for a mesh or an option that cannot be used, before anything is
 * changed
 * @throws std::runtime_error when the eigenpairs do not converge, before anything is changed. With
 *         `Spectral_edge_collapse_options::pre_simplify` it is thrown after the first stage, and
 *         also if that stage left a mesh that the spectral cost refuses (a needle, a vertex without
 *         area)
 * @throws Spectral_geometry::Cancelled when the run is cancelled before the mesh changes, while
 *         collapses by quadrics, eigenpairs or first costs are computed; later a cancelled run
 *         returns what was done
 */
template <class TriangleMesh, class NamedParameters = parameters::Default_named_parameters>
Spectral_edge_collapse_result
spectral_edge_collapse(TriangleMesh& mesh, const std::size_t number_of_vertices,
                       const Spectral_edge_collapse_options& options = {},
                       const NamedParameters& np = parameters::default_values())
{
  static_assert(
      !internal::overrides_policies<NamedParameters>,
      "spectral_edge_collapse() takes no get_cost, get_placement, use_relaxed_order or index map");
  Real_timer timer;
  timer.start();
  Spectral_edge_collapse_result result;
  result.input_vertices = std::size_t(std::distance(vertices(mesh).begin(), vertices(mesh).end()));
  internal::check_target("spectral_edge_collapse", number_of_vertices, result.input_vertices);
  internal::check_edge_collapse_options(options);
  internal::check_spectral_options(options, Eigen::Index(result.input_vertices));
  if(number_of_vertices < result.input_vertices && !std::isfinite(options.maximum_error))
    internal::check_useful_target(Spectral_geometry::mesh_matrices(mesh, np), number_of_vertices,
                                  internal::number_of_signals(options));
  const double checked = timer.time();
  internal::Pre_simplification first =
      internal::pre_simplify(mesh, result.input_vertices, number_of_vertices, options, np);
  if(first.done)
    result.seconds_pre_simplification = timer.time() - checked;
  result.quadric_collapses = first.log.points().size();
  if(first.done)
    internal::run_after_first_stage(mesh, number_of_vertices, options, np, first, result);
  else
    internal::run_spectral_stage(mesh, number_of_vertices, options, np, first, result);
  result.seconds_total = timer.time();
  return result;
}

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_COLLAPSE_H
