// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_PRE_SIMPLIFICATION_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_PRE_SIMPLIFICATION_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Restriction_visitor.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Kept_vertices.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Shifted_point_map.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/is_given.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/boost/graph/properties.h>

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// What the first stage has done; nothing where it was skipped.
struct Pre_simplification
{
  bool done = false, cancelled = false;
  Collapse_log log;
  std::vector<Eigen::Index> slots;        ///< of `vertices(mesh)` afterwards, in that order
  std::vector<std::size_t> kept_vertices; ///< where those to be kept are in it
};

/// Stops at a number of vertices, or when the user cancels.
template <class TriangleMesh>
class Pre_simplification_stop
{
public:
  Pre_simplification_stop(const TriangleMesh& mesh, const Collapse_log& log,
                          const Spectral_edge_collapse_options& options)
    : m_stop(options.pre_simplify, mesh)
    , m_log(&log)
    , m_options(&options)
  {}

  template <class Cost, class Profile>
  bool operator()(const Cost& cost, const Profile& profile, const std::size_t initial,
                  const std::size_t current) const
  {
    if(m_stop(cost, profile, initial, current))
      return true;
    const std::size_t n = m_log->number_of_vertices(), left = m_log->number_of_vertices_left();
    const double fraction = double(n - left) / double(n - m_options->pre_simplify);
    if(fraction >= m_next_report) {
      m_next_report = fraction + 0.01;
      m_cancelled = !report_progress(*m_options, Spectral_phase::pre_simplification, fraction, left);
    }
    m_cancelled = m_cancelled || is_cancelled(*m_options);
    return m_cancelled;
  }

  bool cancelled() const { return m_cancelled; }

private:
  Vertex_count_stop_predicate<TriangleMesh> m_stop;
  const Collapse_log* m_log;
  const Spectral_edge_collapse_options* m_options;
  mutable double m_next_report = 0;
  mutable bool m_cancelled = false;
};

/// Throws for what would otherwise be found out after the mesh has changed.
inline void check_pre_simplification(const Spectral_edge_collapse_options& options, const std::size_t n,
                                     const std::size_t target)
{
  using std::to_string;
  const std::string size =
      "Spectral_edge_collapse_options: pre_simplify is " + to_string(options.pre_simplify);
  if(options.pre_simplify < target)
    throw std::invalid_argument(size + ", less than the target of " + to_string(target) +
                                " vertices; use a number between the target and the size of the mesh.");
  if(options.signals.size() != 0 || options.eigenpairs)
    throw std::invalid_argument(
        "Spectral_edge_collapse_options: pre_simplify is set, but the signals or eigenpairs that are "
        "given belong to the mesh before it; use one of the two.");
  if(options.number_of_eigenvectors >= Eigen::Index(options.pre_simplify))
    throw std::invalid_argument(size + ", but " + to_string(options.number_of_eigenvectors) +
                                " eigenvectors are asked for; use a number of vertices above that.");
  check_spectral_options(options, Eigen::Index(n));
  spectral_weights(options, options.number_of_eigenvectors);
  Spectral_geometry::internal::check_eigenpairs_options(options.eigenpairs_options,
                                                        options.number_of_eigenvectors);
}

/// The same for what is wrong with the mesh and stays so in the first stage. Needles and faces without area need not.
template <class TriangleMesh>
void check_mesh_to_pre_simplify(const TriangleMesh& mesh, const Eigen::MatrixXd& V)
{
  check_extent(V);
  Eigen::Index i = 0;
  for(const auto v : vertices(mesh)) {
    if(halfedge(v, mesh) == boost::graph_traits<TriangleMesh>::null_halfedge())
      throw std::invalid_argument("Spectral_policies: " + Spectral_geometry::internal::vertex_name(i) +
                                  " is isolated, no face uses it; remove it.");
    ++i;
  }
}

/// The log of what was done to points minus `offset`.
inline Collapse_log shifted(const Collapse_log& log, const Eigen::Vector3d& offset)
{
  std::vector<Eigen::Vector3d> points = log.points();
  for(Eigen::Vector3d& point : points)
    point += offset;
  return Collapse_log(log.forest(), std::move(points));
}

/// The first stage of `Spectral_edge_collapse_options::pre_simplify`: CGAL's Garland-Heckbert on a mesh of n vertices. A filter or
/// visitor of the user's sees points as they are: nothing is shifted then.
template <class GeomTraits, class TriangleMesh, class NamedParameters>
Pre_simplification pre_simplify(TriangleMesh& mesh, const std::size_t n, const std::size_t target,
                                const Spectral_edge_collapse_options& options, const NamedParameters& np)
{
  using parameters::choose_parameter;
  using parameters::get_parameter;
  Pre_simplification result;
  if(options.pre_simplify == 0 || n <= options.pre_simplify)
    return result;
  check_pre_simplification(options, n, target);
  const Eigen::MatrixXd V = Spectral_geometry::mesh_matrices(mesh, np).V;
  check_mesh_to_pre_simplify(mesh, V);
  if(!report_progress(options, Spectral_phase::pre_simplification, 0., n))
    throw Spectral_geometry::Cancelled();

  constexpr bool has_filter = is_given<NamedParameters>(internal_np::filter_t());
  constexpr bool is_seen = has_filter || is_given<NamedParameters>(internal_np::visitor_t());
  const Eigen::Vector3d offset = is_seen ? Eigen::Vector3d::Zero() : offset_of(V);
  const auto points =
      choose_parameter(get_parameter(np, internal_np::vertex_point), get_property_map(vertex_point, mesh));
  const auto vpm = [&] {
    using Vector = typename GeomTraits::Vector_3;
    if constexpr(is_seen)
      return points;
    else
      return Shifted_point_map<std::decay_t<decltype(points)>, Vector>(
          points, Vector(offset[0], offset[1], offset[2]));
  }();
  using Tracker = Restriction_tracker<TriangleMesh>;
  const auto tracker = std::make_shared<Tracker>(mesh, kept_vertex_flags(mesh, options.kept_vertices, np));
  using vertex_descriptor = typename Tracker::vertex_descriptor;
  check_kept_vertices_apart(
      mesh, [&](const vertex_descriptor v) { return tracker->is_kept(v); },
      [&](const vertex_descriptor v) { return tracker->slots().slot(v); },
      [&](const vertex_descriptor v, const vertex_descriptor w) {
        return coordinates(get(vpm, v)) == coordinates(get(vpm, w));
      });
  const auto shared = std::make_shared<const Shared_positions>(
      positions_of_several(mesh, vpm, [&](const vertex_descriptor v) { return tracker->is_kept(v); }));
  using Policies = GarlandHeckbert_plane_policies<TriangleMesh, GeomTraits>;
  using Placement = typename Policies::Get_placement;
  const Policies policies(mesh);
  const auto user = choose_parameter(get_parameter(np, internal_np::visitor), No_visitor());
  const Restriction_visitor<TriangleMesh, std::decay_t<decltype(user)>> visitor(tracker, user);
  const Pre_simplification_stop<TriangleMesh> stop(mesh, tracker->log(), options);
  const auto common = parameters::visitor(visitor).vertex_point_map(vpm).get_cost(policies.get_cost());
  const auto run = [&](const auto& with_placement) {
    if constexpr(has_filter)
      edge_collapse(mesh, stop, with_placement.filter(get_parameter(np, internal_np::filter)));
    else
      edge_collapse(mesh, stop, with_placement);
  };
  if constexpr(is_given<NamedParameters>(internal_np::edge_is_constrained_t())) {
    const auto ecm = get_parameter(np, internal_np::edge_is_constrained);
    using Constrained = Constrained_placement<Placement, std::decay_t<decltype(ecm)>>;
    using Is_constrained = Ends_of_constrained_edges<std::decay_t<decltype(ecm)>>;
    const Constrained constrained(ecm, policies.get_placement());
    run(common.edge_is_constrained_map(ecm).get_placement(
        Kept_vertices_placement<Tracker, Constrained, Is_constrained>(tracker, shared, constrained,
                                                                      Is_constrained{ecm})));
  } else
    run(common.get_placement(Kept_vertices_placement<Tracker, Placement, No_constrained_vertices>(
        tracker, shared, policies.get_placement(), No_constrained_vertices())));
  result.done = true;
  result.cancelled = stop.cancelled();
  result.log = shifted(tracker->log(), offset);
  result.slots = tracker->slots().current();
  result.kept_vertices = tracker->kept_indices();
  return result;
}

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_PRE_SIMPLIFICATION_H
