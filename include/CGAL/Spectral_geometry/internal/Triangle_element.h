// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_TRIANGLE_ELEMENT_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_TRIANGLE_ELEMENT_H

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/*!
 * What linear finite elements take from a triangle, wherever they are needed: assembly, the rings of the collapses, flips and
 * relocation. The cotangent at corner k is dot[k] / twice_area; the edge opposite to it gets half of that in L, each corner a third of the
 * area in M.
 */
struct Triangle_element
{
  double dot[3]; ///< of the two edges that leave the corner
  double twice_area;

  /// To rounding. Such a triangle contributes nothing.
  bool is_degenerate() const { return !(twice_area > 0); }
};

/// `edge[k]` lies opposite to corner k, from corner k + 1 to corner k + 2. The area is that of the cross product of the two shortest
/// edges: that of others would be a difference of larger numbers.
inline Triangle_element triangle_element(const Eigen::Vector3d (&edge)[3])
{
  double square[3];
  int longest = 0;
  for(int k = 0; k < 3; ++k) {
    square[k] = edge[k].squaredNorm();
    if(square[k] > square[longest])
      longest = k;
  }
  const int a = (longest + 1) % 3, b = (longest + 2) % 3;
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  const double twice_area_squared = edge[a].cross(edge[b]).squaredNorm();
  Triangle_element t{{0, 0, 0}, 0};
  if(!(twice_area_squared > rounding * rounding * square[a] * square[b]))
    return t;
  for(int k = 0; k < 3; ++k)
    t.dot[k] = -edge[(k + 1) % 3].dot(edge[(k + 2) % 3]);
  t.twice_area = std::sqrt(twice_area_squared);
  return t;
}

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_TRIANGLE_ELEMENT_H
