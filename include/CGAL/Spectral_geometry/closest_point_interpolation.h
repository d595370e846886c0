// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_CLOSEST_POINT_INTERPOLATION_H
#define CGAL_SPECTRAL_GEOMETRY_CLOSEST_POINT_INTERPOLATION_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/separate_compilation.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationTransfer
/// @{

/*!
returns the matrix that interpolates functions on a triangulated surface at the closest points of given
points.

Row `i` holds the barycentric coordinates, in the face of the surface that is closest to `points.row(i)`, of
the point of that face closest to `points.row(i)`: at most three nonzeros, none negative, which sum to 1.
Zeros are not written. The function \f$ W g \f$ is the piecewise linear function `g` read off at the closest
points, so that `W` times the vertices of the surface gives the closest points themselves.

- With the vertices of the fine mesh as `points` and the coarse mesh as `surface` it is the *prolongation*
  (fine x coarse), by which functions on a simplified mesh go back to the input.
- With the vertices of the coarse mesh as `points` and the fine mesh as `surface` it is a restriction `P`
  (coarse x fine) that does not depend on the simplifier, for judging any coarse mesh, whoever made it. It is
  not the transpose of the prolongation, and may have several nonzeros in a column.

Where several points of the surface are equally close one of them is taken, always the same one for the same
input. A closest point says nothing of the orientation: sheets of a surface that nearly touch can take each
other's values.

@param points `r` x 3, coordinates in the unit of the surface, whose squares do not overflow.
@param surface `n` vertices and `m` triangles, `m > 0`. Faces without area count as their edges, vertices
  without a face get an empty column.
@return `r` x `n`.

Throws `std::invalid_argument` for a coordinate that is not finite, an index out of range, a surface without a
face, or matrices that do not have three columns.

Complexity: one tree of the faces' boxes, then O(log m) per point for points close to the surface.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::SparseMatrix<double>
closest_point_interpolation(const Eigen::MatrixXd& points, const Mesh_matrices& surface);

/// @}

} // namespace CGAL::Spectral_geometry

#ifndef CGAL_SPECTRAL_GEOMETRY_COMPILED
#include <CGAL/Spectral_geometry/internal/maps/closest_point_interpolation_impl.h>
#endif

#endif // CGAL_SPECTRAL_GEOMETRY_CLOSEST_POINT_INTERPOLATION_H
