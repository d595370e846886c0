// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_VERTEX_COUNT_STOP_PREDICATE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_VERTEX_COUNT_STOP_PREDICATE_H

#include <CGAL/Spectral_geometry/internal/basics.h>

#include <CGAL/boost/graph/properties.h>

#include <iterator>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * Stops when the mesh has at most the given number of vertices, isolated ones included. Works with
 * every cost and placement, without a visitor.
 *
 * \cgalModels{StopPredicate}
 *
 * CGAL passes only edge counts to a stop predicate, and counting vertices takes linear time while a
 * mesh is being collapsed. Each collapse removes one vertex and two or three edges. So the vertices
 * are counted at the first call, and one is subtracted whenever the edge count has fallen by that
 * much. Any other change of the edge count, such as a new run on a changed mesh, makes it count
 * again.
 *
 * The mesh must outlive the predicate. Copies made before the first call are independent.
 */
template <class TriangleMesh>
class Vertex_count_stop_predicate
{
public:
  using Triangle_mesh = TriangleMesh; ///< the type of the mesh

  /// @param number_of_vertices the target N; 0 never stops
  /// @param mesh the mesh that is simplified
  Vertex_count_stop_predicate(const std::size_t number_of_vertices, const Triangle_mesh& mesh)
    : m_target(number_of_vertices)
    , m_mesh(&mesh)
  {}

  /// a temporary mesh would be gone when its vertices are counted
  Vertex_count_stop_predicate(std::size_t, const Triangle_mesh&&) = delete;

  /// whether the mesh, after the collapses so far, has at most N vertices
  template <class Cost, class Profile>
  bool operator()(const Cost&, const Profile&, const std::size_t initial_edge_count,
                  const std::size_t current_edge_count) const
  {
    const bool same_run = initial_edge_count == m_initial_edges;
    if(same_run && current_edge_count < m_edges && m_edges - current_edge_count <= 3)
      --m_vertices; // one collapse
    else if(!same_run || current_edge_count != m_edges)
      m_vertices = std::size_t(std::distance(vertices(*m_mesh).begin(), vertices(*m_mesh).end()));
    m_initial_edges = initial_edge_count;
    m_edges = current_edge_count;
    return m_vertices <= m_target;
  }

private:
  std::size_t m_target;
  const Triangle_mesh* m_mesh;
  mutable std::size_t m_vertices = 0, m_edges = 0;
  mutable std::size_t m_initial_edges = (std::numeric_limits<std::size_t>::max)(); // no run so far
};

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_VERTEX_COUNT_STOP_PREDICATE_H
