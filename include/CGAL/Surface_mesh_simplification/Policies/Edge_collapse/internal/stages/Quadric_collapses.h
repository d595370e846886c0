// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_QUADRIC_COLLAPSES_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_QUADRIC_COLLAPSES_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>

#include <CGAL/Spectral_geometry/internal/separate_compilation.h>

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

namespace CGAL::Surface_mesh_simplification::internal {

/// An oriented 2-manifold of triangles, with or without border, in arrays. Corner 3 f + i is the
/// i-th of face f; the halfedge of a corner leads from its vertex to that of the next corner of its
/// face.
struct Triangle_arrays
{
  Eigen::MatrixXd V;             ///< n x 3, finite
  std::vector<int> vertex;       ///< of each corner
  std::vector<int> opposite;     ///< the corner whose halfedge leads back, -1 on the border
  bool single_precision = false; ///< whether the mesh holds positions as `float`
  std::vector<char> fixed;       ///< a flag for each vertex that stays where it is, or nothing
  bool border_is_apart =
      false; ///< whether a vertex of the border stays on it, with values of the border alone
  bool binary = false; ///< whether a merged vertex has the values of one of both ends
};

/*!
 * Collapses edges by quadrics alone until `target` vertices are left, or until no edge is left that
 * may be collapsed.
 *
 * The cost of an edge is the least value of the sum of its ends' quadrics, those of the shape term
 * (`Spectral_shape_term`), and its vertex goes where that is taken (M. Garland and P. Heckbert,
 * *Surface Simplification Using Quadric Error Metrics*, SIGGRAPH 1997). Quadrics only grow, so a
 * cost that was computed before its ends changed is a lower bound: the queue holds each edge once
 * and costs are computed anew when they come up, in the order that recomputing all of them would
 * give (to single precision).
 *
 * A collapse keeps the mesh a manifold (link condition), turns no face by more than 78 degrees, and
 * makes no needle (the height of a face below a thousandth of its longest side) where there was
 * none. Edges without length come first, those between vertices of many neighbours last.
 *
 * O(n log n), a few microseconds for each collapse, five times as many where faces would intersect;
 * deterministic.
 *
 * @param keep_free_of_self_intersections whether no collapse may put a face through another, see
 *        `Spectral_crossing_guard`: where faces intersect in the end, all is done once more with an
 *        eye on it
 * @param progress is called with the number of vertices left, each time a hundredth of the
 *        collapses is done and before refused edges are looked at again; what it throws comes
 *        through
 * @throws std::invalid_argument that names the first vertex where several fans of faces meet
 * @return the collapses; a fixed vertex keeps its slot, its position and its values
 */
CGAL_SPECTRAL_GEOMETRY_INLINE Collapse_log
quadric_collapses(Triangle_arrays mesh, bool keep_free_of_self_intersections, std::size_t target,
                  const std::function<void(std::size_t)>& progress);

} // namespace CGAL::Surface_mesh_simplification::internal

#ifndef CGAL_SPECTRAL_GEOMETRY_COMPILED
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/stages/Quadric_collapses_impl.h>
#endif

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_QUADRIC_COLLAPSES_H
