// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_EDGE_FLIP_OPTIONS_H
#define CGAL_SPECTRAL_GEOMETRY_EDGE_FLIP_OPTIONS_H

#include <CGAL/number_type_config.h>

#include <CGAL/Spectral_geometry/internal/require.h>

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// Which edges of a coarse mesh are flipped.
enum class Edge_flips {
  none,     ///< none
  spectral, ///< those whose flip lowers E (Eq. 2), section 6 of the paper
  delaunay  ///< those with opposite angles of more than pi together, whose cotangent weight is negative
};

/*!
How `flip_edges()` chooses, and what a flip may not do. Whatever is set here, no edge of the boundary and no
constrained edge is flipped, no edge appears twice, no triangle loses its area and no vertex its mass.
*/
struct Edge_flip_options
{
  Edge_flips criterion = Edge_flips::spectral; ///< which edges

  /// No new triangle's smallest angle falls below this part of the smallest of the two that it replaces. In [0, 1].
  double smallest_angle_ratio = 0.5;
  /// No new triangle's normal is turned further than this from that of either triangle it replaces, radians. In ]0,
  /// pi/2].
  double largest_turn = CGAL_PI / 3;
  /// Total area, and the volume of a closed mesh, change by at most this part. Positive.
  double size_tolerance = 0.01;
  /// No new triangle intersects any other.
  bool keep_free_of_self_intersections = true;

  /// Ends after so many flips; 0: four for each edge. Flips that lower E cannot go in circles, for Delaunay flips in
  /// space nobody promises it.
  std::size_t maximum_flips = 0;
  /// Ends after so much time.
  double maximum_seconds = std::numeric_limits<double>::infinity();
  /// Called before each flip that is tried, with the fraction of the budget that is spent; returns false to cancel.
  std::function<bool(double)> progress;
};

/// One flip: the edge between two vertices gives way to one between the two that were opposite.
struct Edge_flip
{
  int from[2];     ///< the vertices of the edge before
  int to[2];       ///< and after
  double E_change; ///< E after it less E before; negative for `Edge_flips::spectral`
};

/// What `flip_edges()` did.
struct Edge_flip_result
{
  std::vector<Edge_flip> flips; ///< in this order
  double E_before = 0; ///< E (Eq. 2), in the scale of the positions; infinite where a vertex has no mass
  double E_after = 0;  ///< see `E_before`
  /// flips that the criterion asked for and that total area or volume did not allow, counted each time
  std::size_t refused_for_size = 0;
  /// the same, because a new triangle would have intersected another
  std::size_t refused_for_intersections = 0;
  double seconds = 0; ///< wall seconds
};

/// @}

namespace internal {

inline void check_edge_flip_options(const Edge_flip_options& o)
{
  require_shape_limits("edge flips: ", o);
  require(o.size_tolerance > 0, "edge flips: size_tolerance must be positive.");
}

} // namespace internal

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_EDGE_FLIP_OPTIONS_H
