// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_COLLAPSE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_COLLAPSE_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Restriction_visitor.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/helpers.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/boost/graph/properties.h>

#include <Eigen/SparseCore>

#include <chrono>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/// What `spectral_edge_collapse()` returns.
struct Spectral_edge_collapse_result
{
  /// Why the loop ended.
  enum class Stop_reason {
    target_reached,  ///< the mesh has the number of vertices that was asked for
    queue_exhausted, ///< no edge is left that may be collapsed; see `explanation`
    cancelled        ///< the progress callback returned false
  };

  /// Candidates that were given up when their turn came, by cause. One edge may be counted several times:
  /// it comes back whenever something near it has changed.
  struct Refusals
  {
    std::size_t topology = 0;  ///< CGAL's link condition and the like
    std::size_t geometry = 0;  ///< CGAL's geometric test, or a placement wrapper that gave no point
    std::size_t filter = 0;    ///< the `filter` named parameter
    std::size_t placement = 0; ///< no position without a degenerate triangle
  };

  std::size_t input_vertices = 0;  ///< number of vertices before
  std::size_t output_vertices = 0; ///< and after
  std::size_t collapses = 0;       ///< merges of two vertices, those of edges without length included
  Stop_reason stop_reason = Stop_reason::target_reached; ///< why it stopped
  std::string explanation;           ///< one sentence if the target was not reached, else empty
  std::vector<std::string> warnings; ///< one sentence each: what was done, but is not advised
  Refusals refusals;                 ///< candidates that were given up, by cause

  double seconds_pre_simplification = 0; ///< wall seconds of `Spectral_options::pre_simplify`
  double seconds_eigenpairs = 0;         ///< reading the mesh and finding the basis
  double seconds_first_costs = 0;        ///< evaluating every edge once
  double seconds_collapse = 0;           ///< first costs and the collapse loop
  double seconds_total = 0;              ///< the whole call

  double E = 0;              ///< Eq. 2, for the input scaled to unit area
  double relative_error = 0; ///< sqrt(E / sum_k lambda_k^2)

  /// P, coarse x fine: rows in the order of `vertices(mesh)` when the function returned, columns in that of the input.
  /// `Surface_mesh::collect_garbage()` changes that order: write or copy the mesh without it, which keeps the order, or
  /// use `Spectral_policies`, whose `restriction()` follows the mesh as it is.
  Eigen::SparseMatrix<double> restriction;
  std::vector<std::size_t> vertex_map; ///< for each vertex of the input the row of P it ended in
  /// number of vertices after `Spectral_options::pre_simplify`; that of the input without
  std::size_t pre_simplified_vertices = 0;
  /// of the input (of the pre-simplified mesh, if it was) at its own scale, to simplify it again; null with signals
  /// of the user's
  std::shared_ptr<const Spectral_geometry::Eigenpairs> eigenpairs;

  /// the reason in words
  const char* stop_reason_name() const
  {
    return stop_reason == Stop_reason::target_reached    ? "target reached"
           : stop_reason == Stop_reason::queue_exhausted ? "no collapsible edge left"
                                                         : "cancelled";
  }
};

namespace internal {

/// Stops at a number of vertices, or when the progress callback cancels. The loop may be left here: the
/// mesh is valid between two collapses.
template <class State>
class Spectral_stop_predicate
{
public:
  Spectral_stop_predicate(const State& state, const std::size_t target)
    : m_state(&state)
    , m_target(target)
    , m_stop(target, state.mesh())
    , m_begin(state.number_of_vertices())
  {}

  template <class Cost, class Profile>
  bool operator()(const Cost& cost, const Profile& profile, const std::size_t initial,
                  const std::size_t current) const
  {
    if(m_stop(cost, profile, initial, current)) {
      m_reached = true;
      return true;
    }
    // A hundred reports in all: a callback may well draw something.
    const std::size_t n = m_state->number_of_vertices();
    const double fraction = m_begin > m_target ? double(m_begin - n) / double(m_begin - m_target) : 1.;
    if(fraction >= m_next_report) {
      m_next_report = fraction + 0.01;
      m_cancelled = !m_state->report(Spectral_phase::collapses, fraction);
    }
    return m_cancelled;
  }

  bool reached() const { return m_reached; }
  bool cancelled() const { return m_cancelled; }

private:
  const State* m_state;
  std::size_t m_target;
  Vertex_count_stop_predicate<typename State::Triangle_mesh> m_stop;
  std::size_t m_begin;
  mutable double m_next_report = 0;
  mutable bool m_reached = false, m_cancelled = false;
};

/// P and vertex map of the first stage; empty where it was skipped.
struct Pre_simplification
{
  bool done = false;
  Eigen::SparseMatrix<double> restriction;
  std::vector<std::size_t> vertex_map;
};

/// The first stage of `Spectral_options::pre_simplify`.
template <class GeomTraits, class TriangleMesh, class NamedParameters>
Pre_simplification pre_simplify(TriangleMesh& mesh, const std::size_t n, const std::size_t target,
                                const Spectral_options& options, const NamedParameters& np)
{
  using parameters::choose_parameter;
  using parameters::get_parameter;
  if(options.pre_simplify == 0 || n <= options.pre_simplify)
    return Pre_simplification();
  if(options.pre_simplify < target)
    throw std::invalid_argument("Spectral_options: pre_simplify is " + std::to_string(options.pre_simplify) +
                                ", less than the target of " + std::to_string(target) +
                                " vertices; use a number between the target and the size of the mesh.");
  if(options.signals.size() != 0 || options.eigenpairs)
    throw std::invalid_argument(
        "Spectral_options: pre_simplify is set, but the signals or eigenpairs that are "
        "given belong to the mesh before it; use one of the two.");
  constexpr bool has_constraints =
      !std::is_same<typename internal_np::Get_param<typename NamedParameters::base,
                                                    internal_np::edge_is_constrained_t>::type,
                    internal_np::Param_not_found>::value;
  using Policies = GarlandHeckbert_plane_policies<TriangleMesh, GeomTraits>;
  if(options.progress && !options.progress(Spectral_progress{Spectral_phase::pre_simplification, 0., n}))
    throw Spectral_geometry::Cancelled();
  Policies policies(mesh);
  Restriction_visitor<TriangleMesh> visitor(mesh);
  const Vertex_count_stop_predicate<TriangleMesh> stop(options.pre_simplify, mesh);
  const auto common = parameters::visitor(visitor).vertex_point_map(
      choose_parameter(get_parameter(np, internal_np::vertex_point), get_property_map(vertex_point, mesh)));
  if constexpr(has_constraints) {
    const auto ecm = get_parameter(np, internal_np::edge_is_constrained);
    using Map = std::decay_t<decltype(ecm)>;
    const Constrained_placement<typename Policies::Get_placement, Map> placement(ecm,
                                                                                 policies.get_placement());
    edge_collapse(mesh, stop,
                  common.edge_is_constrained_map(ecm).get_cost(policies.get_cost()).get_placement(placement));
  } else
    edge_collapse(mesh, stop, common.get_cost(policies.get_cost()).get_placement(policies.get_placement()));
  return Pre_simplification{true, visitor.restriction(), visitor.vertex_map()};
}

/// The vertex map of both stages: the second follows the order of `vertices(mesh)` after the first.
inline std::vector<std::size_t> compose(const std::vector<std::size_t>& first,
                                        const std::vector<std::size_t>& second)
{
  std::vector<std::size_t> result;
  result.reserve(first.size());
  for(const std::size_t i : first)
    result.push_back(second[i]);
  return result;
}

/// Runs the loop with the constraint map, filter and visitor that the user gave, if any.
template <class TriangleMesh, class Policies, class Stop, class NamedParameters>
void run_spectral_edge_collapse(TriangleMesh& mesh, const Policies& policies, const Stop& stop,
                                const NamedParameters& np)
{
  using parameters::choose_parameter;
  using parameters::get_parameter;
  using Filter_in_np =
      typename internal_np::Get_param<typename NamedParameters::base, internal_np::filter_t>::type;
  using Constraints_in_np = typename internal_np::Get_param<typename NamedParameters::base,
                                                            internal_np::edge_is_constrained_t>::type;
  constexpr bool has_filter = !std::is_same<Filter_in_np, internal_np::Param_not_found>::value;
  constexpr bool has_constraints = !std::is_same<Constraints_in_np, internal_np::Param_not_found>::value;

  const auto visitor =
      policies.visitor(choose_parameter(get_parameter(np, internal_np::visitor), No_visitor()));
  const auto common = parameters::visitor(visitor)
                          .vertex_point_map(policies.state().vertex_point_map())
                          .geom_traits(policies.state().geom_traits());
  const auto run = [&](const auto& placement, const auto& with_placement) {
    if constexpr(has_filter)
      edge_collapse(mesh, stop,
                    with_placement.get_cost(policies.get_cost())
                        .get_placement(placement)
                        .filter(get_parameter(np, internal_np::filter)));
    else
      edge_collapse(mesh, stop, with_placement.get_cost(policies.get_cost()).get_placement(placement));
  };
  if constexpr(has_constraints) {
    const auto ecm = get_parameter(np, internal_np::edge_is_constrained);
    using Map = std::decay_t<decltype(ecm)>;
    run(Constrained_placement<typename Policies::Get_placement, Map>(ecm, policies.get_placement()),
        common.edge_is_constrained_map(ecm));
  } else
    run(policies.get_placement(), common);
}

/// Why a mesh that has run out of edges cannot be reduced further.
template <class TriangleMesh>
std::string explain_exhausted_queue(const TriangleMesh& mesh, const Spectral_edge_collapse_result& result,
                                    const std::size_t target)
{
  std::size_t border_edges = 0;
  for(const auto h : halfedges(mesh))
    if(is_border(h, mesh))
      ++border_edges;
  std::vector<typename boost::graph_traits<TriangleMesh>::vertex_descriptor> todo;
  std::size_t components = 0;
  auto seen = get(dynamic_vertex_property_t<bool>(), mesh);
  for(const auto v : vertices(mesh))
    put(seen, v, false);
  for(const auto seed : vertices(mesh)) {
    if(get(seen, seed))
      continue;
    ++components;
    put(seen, seed, true);
    todo.push_back(seed);
    while(!todo.empty()) {
      const auto v = todo.back();
      todo.pop_back();
      for(const auto w : vertices_around_target(halfedge(v, mesh), mesh))
        if(!get(seen, w)) {
          put(seen, w, true);
          todo.push_back(w);
        }
    }
  }
  using std::to_string;
  return "The mesh stopped at " + to_string(result.output_vertices) + " vertices instead of " +
         to_string(target) + " because every edge left was refused (topology " +
         to_string(result.refusals.topology) + ", geometry " + to_string(result.refusals.geometry) +
         ", filter " + to_string(result.refusals.filter) + ", placement " +
         to_string(result.refusals.placement) + " times; constrained edges are never collapsed): it has " +
         to_string(components) + (components == 1 ? " component" : " components") +
         ", each of which needs at least 3 (open) or 4 (closed) vertices, and " + to_string(border_edges) +
         " border edges.";
}

} // namespace internal

/*!
 * Simplifies a mesh to a number of vertices while its Laplace-Beltrami spectrum stays what it was: the one-call
 * form of `Spectral_policies` with `edge_collapse()` and `Vertex_count_stop_predicate`.
 *
 * @param mesh a triangle mesh without isolated vertices; changed in place, garbage is not collected
 * @param number_of_vertices the target N, from 1 to the number of vertices of the mesh. At least 3 K is advised
 *        (section 4.3 of the paper); a smaller one is warned of in the result
 * @param options see `Spectral_options`
 * @param np named parameters of `edge_collapse()`: `vertex_point_map`, `geom_traits`, `edge_is_constrained_map` (the
 *        placement is then wrapped in `Constrained_placement`), `filter`, `visitor`
 *
 * @return P, the vertex map, why it stopped, counts and times
 *
 * @throws std::invalid_argument for a mesh or an option that cannot be used, before anything is changed
 * @throws std::runtime_error when the eigenpairs do not converge, before anything is changed
 * @throws Spectral_geometry::Cancelled when the progress callback returns false before the first collapse; later a
 *         cancelled run returns what was done
 */
template <class TriangleMesh, class NamedParameters = parameters::Default_named_parameters>
Spectral_edge_collapse_result spectral_edge_collapse(TriangleMesh& mesh, const std::size_t number_of_vertices,
                                                     const Spectral_options& options = Spectral_options(),
                                                     const NamedParameters& np = parameters::default_values())
{
  using Vertex_point_map = typename GetVertexPointMap<TriangleMesh, NamedParameters>::type;
  using Geom_traits = typename GetGeomTraits<TriangleMesh, NamedParameters>::type;
  using Policies = Spectral_policies<TriangleMesh, Geom_traits, Vertex_point_map>;
  using Result = Spectral_edge_collapse_result;

  const auto begin = std::chrono::steady_clock::now();
  const std::size_t n = std::size_t(std::distance(vertices(mesh).begin(), vertices(mesh).end()));
  if(number_of_vertices < 1 || number_of_vertices > n)
    throw std::invalid_argument("spectral_edge_collapse: the target is " +
                                std::to_string(number_of_vertices) + " vertices, but the mesh has " +
                                std::to_string(n) + "; use a number from 1 to " + std::to_string(n) + ".");
  Result result;
  result.input_vertices = n;
  const internal::Pre_simplification first =
      internal::pre_simplify<Geom_traits>(mesh, n, number_of_vertices, options, np);
  const auto begin_spectral = std::chrono::steady_clock::now();
  result.seconds_pre_simplification = std::chrono::duration<double>(begin_spectral - begin).count();
  const Policies policies(mesh, options, np);
  result.pre_simplified_vertices = std::size_t(policies.state().fine_points().rows());
  const std::size_t K = std::size_t(policies.state().core().number_of_signals());
  if(number_of_vertices < 3 * K)
    result.warnings.push_back(
        "The target of " + std::to_string(number_of_vertices) +
        " vertices is less than 3 K = " + std::to_string(3 * K) +
        "; the upper part of the spectrum will not be preserved (section 4.3 of the paper).");

  const auto& state = policies.state();
  const auto begin_collapse = std::chrono::steady_clock::now();
  const internal::Spectral_stop_predicate<typename Policies::State> stop(state, number_of_vertices);
  internal::run_spectral_edge_collapse(mesh, policies, stop, np);
  const auto end = std::chrono::steady_clock::now();

  result.output_vertices = state.number_of_vertices();
  result.collapses = n - result.output_vertices;
  result.refusals.topology = state.refusals().topology;
  result.refusals.geometry = state.refusals().geometry;
  result.refusals.filter = state.refusals().filter;
  result.refusals.placement = state.refusals().placement;
  if(result.output_vertices > number_of_vertices) {
    result.stop_reason =
        stop.cancelled() ? Result::Stop_reason::cancelled : Result::Stop_reason::queue_exhausted;
    result.explanation =
        stop.cancelled() ? "The run was cancelled at " + std::to_string(result.output_vertices) + " vertices."
                         : internal::explain_exhausted_queue(mesh, result, number_of_vertices);
  }
  result.seconds_eigenpairs = state.seconds_basis();
  result.seconds_first_costs = state.seconds_first_costs();
  result.seconds_collapse = std::chrono::duration<double>(end - begin_collapse).count();
  result.E = policies.error();
  result.relative_error = policies.relative_error();
  result.restriction = policies.restriction();
  result.vertex_map = policies.vertex_map();
  if(first.done) {
    result.restriction = Eigen::SparseMatrix<double>(result.restriction * first.restriction);
    result.vertex_map = internal::compose(first.vertex_map, result.vertex_map);
  }
  result.eigenpairs = policies.eigenpairs();
  result.seconds_total = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

/// @}

} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_COLLAPSE_H
