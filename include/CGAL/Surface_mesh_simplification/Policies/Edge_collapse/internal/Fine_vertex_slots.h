// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_FINE_VERTEX_SLOTS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_FINE_VERTEX_SLOTS_H

#include <CGAL/license/Surface_mesh_simplification.h>

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
    , m_slots(get(dynamic_vertex_property_t<Eigen::Index>(), mesh))
  {
    for(const vertex_descriptor v : vertices(mesh))
      put(m_slots, v, ++m_size);
  }

  Eigen::Index size() const { return m_size; } ///< number of vertices at construction

  /// The slot of a vertex. A vertex that a collapse has just removed still has one: its handle is looked up,
  /// never followed.
  Eigen::Index slot(const vertex_descriptor v) const
  {
    // The map holds slot + 1: a vertex that appeared after construction reads as 0.
    const Eigen::Index s = get(m_slots, v);
    if(s == 0)
      throw std::logic_error(m_owner +
                             ": a vertex of the mesh was not there when it was made; make a new one "
                             "after adding vertices.");
    return s - 1;
  }

  /// The slots of `vertices(mesh)`, in that order.
  std::vector<Eigen::Index> current() const
  {
    std::vector<Eigen::Index> slots;
    for(const vertex_descriptor v : vertices(*m_mesh))
      slots.push_back(slot(v));
    return slots;
  }

private:
  const Triangle_mesh* m_mesh;
  std::string m_owner;
  Eigen::Index m_size = 0;
  typename boost::property_map<Triangle_mesh, dynamic_vertex_property_t<Eigen::Index>>::type m_slots;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_FINE_VERTEX_SLOTS_H
