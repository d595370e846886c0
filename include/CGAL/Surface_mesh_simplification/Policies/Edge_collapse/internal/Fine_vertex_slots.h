// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_FINE_VERTEX_SLOTS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_FINE_VERTEX_SLOTS_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Vertex_slot_map.h>

#include <CGAL/boost/graph/properties.h>

#include <Eigen/Core>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// alpha = (x - u).(v - u) / |v - u|^2 clamped to [0,1], the weight of `v` when the edge (u, v) is collapsed
/// to x (appendix A of Lescoat et al. 2020); 1/2 on an edge without length, where no end is closer to x than
/// the other.
inline double projected_edge_weight(const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                                    const Eigen::Vector3d& x)
{
  const Eigen::Vector3d edge = v - u;
  const double squared_length = edge.squaredNorm();
  if(!(squared_length > 0))
    return 0.5;
  return (std::min)((std::max)(edge.dot(x - u) / squared_length, 0.), 1.);
}

/// Which column of the restriction a vertex stands for: its position in `vertices(mesh)` at construction,
/// kept while the mesh is collapsed and its garbage collected.
template <class TriangleMesh>
class Fine_vertex_slots
{
public:
  using Triangle_mesh = TriangleMesh;
  using vertex_descriptor = typename boost::graph_traits<Triangle_mesh>::vertex_descriptor;

  /// The mesh is not changed, but only one that may be can keep the slots right when its garbage is
  /// collected.
  Fine_vertex_slots(Triangle_mesh& mesh, const std::string& owner)
    : m_mesh(&mesh)
    , m_owner(owner)
    , m_slots(mesh)
  {
    for(const vertex_descriptor v : vertices(mesh))
      m_slots.set(v, ++m_size);
  }

  Eigen::Index size() const { return m_size; } ///< number of vertices at construction

  /// The slot of a vertex. A vertex that a collapse has just removed still has one: its handle is looked up,
  /// never followed.
  Eigen::Index slot(const vertex_descriptor v) const
  {
    // The map holds slot + 1: a vertex that appeared after construction reads as 0.
    const Eigen::Index s = m_slots[v];
    if(s == 0)
      throw std::logic_error(m_owner +
                             ": a vertex of the mesh was not there when it was made; make a new one "
                             "after adding vertices.");
    return s - 1;
  }

  /// Gives the vertices of the mesh, in their order, these slots: other handles may go on for them.
  void set(const std::vector<Eigen::Index>& slots)
  {
    std::size_t i = 0;
    for(const vertex_descriptor v : vertices(*m_mesh))
      m_slots.set(v, slots[i++] + 1);
  }

  /// Throws `std::logic_error` where the mesh has been assigned to and its vertices are others.
  void check() const
  {
    if(!m_slots.attach(*m_mesh))
      throw std::logic_error(
          m_owner + ": another mesh has been assigned to the one that it was made for; make a new one.");
  }

  /// The slots of `vertices(mesh)`, in that order. Throws what check() throws.
  std::vector<Eigen::Index> current() const
  {
    check();
    std::vector<Eigen::Index> slots;
    for(const vertex_descriptor v : vertices(*m_mesh))
      slots.push_back(slot(v));
    return slots;
  }

private:
  const Triangle_mesh* m_mesh;
  std::string m_owner;
  Eigen::Index m_size = 0;
  mutable Vertex_slot_map<Triangle_mesh> m_slots; // mutable: where the mesh keeps them is looked up
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_FINE_VERTEX_SLOTS_H
