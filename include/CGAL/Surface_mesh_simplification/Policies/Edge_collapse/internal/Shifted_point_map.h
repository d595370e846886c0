// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SHIFTED_POINT_MAP_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SHIFTED_POINT_MAP_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <boost/property_map/property_map.hpp>

#include <Eigen/Core>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/*!
 * The points of a mesh minus an offset: quadrics square coordinates, and far from the origin nothing is left of what they are
 * to tell apart.
 *
 * The offset is a point of the mesh along each axis on which the mesh is at least eight times as far from the origin as it is long,
 * 0 on the others. So no point changes by being moved there and back: such differences of doubles are exact.
 */
template <class VertexPointMap, class Vector>
class Shifted_point_map
{
public:
  using key_type = typename boost::property_traits<VertexPointMap>::key_type;
  using value_type = typename boost::property_traits<VertexPointMap>::value_type;
  using reference = value_type;
  using category = boost::read_write_property_map_tag;

  Shifted_point_map(VertexPointMap points, Vector offset)
    : m_points(points)
    , m_offset(offset)
  {}

  friend reference get(const Shifted_point_map& map, const key_type& v)
  {
    using boost::get;
    return get(map.m_points, v) - map.m_offset;
  }

  friend void put(const Shifted_point_map& map, const key_type& v, const value_type& point)
  {
    using boost::put;
    put(map.m_points, v, point + map.m_offset);
  }

private:
  VertexPointMap m_points;
  Vector m_offset;
};

/// The offset for the positions in the rows of V, of which there is at least one.
inline Eigen::Vector3d offset_of(const Eigen::MatrixXd& V)
{
  Eigen::Vector3d offset = V.row(0);
  for(int axis = 0; axis < 3; ++axis)
    if(!(V.col(axis).cwiseAbs().minCoeff() >= 8 * (V.col(axis).maxCoeff() - V.col(axis).minCoeff())))
      offset[axis] = 0;
  return offset;
}

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SHIFTED_POINT_MAP_H
