// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_FEATURE_VERTICES_MAP_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_FEATURE_VERTICES_MAP_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Fine_vertex_slots.h>

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/helpers.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/boost/graph/properties.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * Tells which vertices of a mesh lie at its features: on the border if asked for, on edges where
 * the normals of both faces are at least an angle apart, and at corners where the border itself
 * turns by that angle. As named parameter `vertex_is_constrained_map` of `spectral_edge_collapse()`
 * or `Spectral_policies` it keeps these vertices, and their edges, in place:
 *
 * \code
 * spectral_edge_collapse(mesh, N, {},
 * parameters::vertex_is_constrained_map(Feature_vertices_map<Mesh>(mesh, true, 60))); \endcode
 *
 * The features are found once, in the constructor. Copies share them.
 *
 * \cgalModels{ReadablePropertyMap}
 *
 * @tparam TriangleMesh a model of `FaceListGraph` with dynamic properties
 */
template <class TriangleMesh>
class Feature_vertices_map
{
  using Vertex = typename boost::graph_traits<TriangleMesh>::vertex_descriptor;
  using Flags =
      typename boost::property_map<TriangleMesh, CGAL::dynamic_vertex_property_t<bool>>::const_type;

public:
  using key_type = Vertex;                           ///< a vertex of the mesh
  using value_type = bool;                           ///< whether it is kept
  using reference = bool;                            ///< the same
  using category = boost::readable_property_map_tag; ///< only read

  /// @param mesh the mesh
  /// @param border whether the vertices of the border are features
  /// @param degrees the angle above 0 and up to 180; none: no edge is sharp
  /// @param np an optional sequence of named parameters among those below; coordinates go through
  /// `CGAL::to_double()`
  ///
  /// \cgalNamedParamsBegin
  ///   \cgalParamNBegin{vertex_point_map}
  ///     \cgalParamDescription{the positions of the vertices}
  ///     \cgalParamType{a model of `ReadablePropertyMap` from vertices to points}
  ///     \cgalParamDefault{the mesh's own map}
  ///   \cgalParamNEnd
  /// \cgalNamedParamsEnd
  ///
  /// @throws std::invalid_argument for another angle
  template <class NamedParameters = parameters::Default_named_parameters>
  Feature_vertices_map(const TriangleMesh& mesh, const bool border,
                       const std::optional<double> degrees = {},
                       const NamedParameters& np = parameters::default_values())
    : m_flags(get(CGAL::dynamic_vertex_property_t<bool>(), mesh))
  {
    const double angle = degrees.value_or(180);
    internal::require(angle > 0 && angle <= 180,
                      "Feature_vertices_map: the angle must be above 0 and up to 180 degrees, not ",
                      angle);
    for(const Vertex v : vertices(mesh))
      put(m_flags, v, false);
    const auto points =
        parameters::choose_parameter(parameters::get_parameter(np, internal_np::vertex_point),
                                     get_const_property_map(vertex_point, mesh));
    const auto along = [&](const auto h) {
      const Eigen::Vector3d edge = internal::to_vector(get(points, target(h, mesh))) -
                                   internal::to_vector(get(points, source(h, mesh)));
      return Eigen::Vector3d(edge.stableNormalized());
    };
    const auto normal = [&](const auto h) {
      return Eigen::Vector3d(along(h).cross(along(next(h, mesh))).stableNormalized());
    };
    // Where a length or an area is 0 there is no angle.
    const double bound = degrees ? std::cos(*degrees * 3.14159265358979323846 / 180) : -2;
    const auto apart = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return a.squaredNorm() > 0.5 && b.squaredNorm() > 0.5 && a.dot(b) <= bound + 1e-12;
    };
    for(const auto h : halfedges(mesh)) {
      const bool at_border = is_border(h, mesh);
      if(at_border && (border || apart(along(h), along(next(h, mesh)))))
        put(m_flags, target(h, mesh), true);
      if(at_border || is_border(opposite(h, mesh), mesh) ||
         !apart(normal(h), normal(opposite(h, mesh))))
        continue;
      put(m_flags, source(h, mesh), true);
      put(m_flags, target(h, mesh), true);
    }
  }

  /// whether the vertex lies at a feature
  friend bool get(const Feature_vertices_map& map, const Vertex v) { return get(map.m_flags, v); }

private:
  Flags m_flags;
};

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_FEATURE_VERTICES_MAP_H
