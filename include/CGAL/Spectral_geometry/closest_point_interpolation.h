// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_CLOSEST_POINT_INTERPOLATION_H
#define CGAL_SPECTRAL_GEOMETRY_CLOSEST_POINT_INTERPOLATION_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/separate_compilation.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationTransfer
/// @{

/*!
returns the matrix that interpolates functions on a triangulated surface at the closest points of
given points.

Row `i` holds the barycentric coordinates, in the face of the surface that is closest to
`points.row(i)`, of the point of that face closest to `points.row(i)`: at most three nonzeros, none
negative, which sum to 1. Zeros are not written. The function \f$ W g \f$ is the piecewise linear
function `g` read off at the closest points, so that `W` times the vertices of the surface gives the
closest points themselves.

Where several points of the surface are equally close one of them is taken, always the same one for
the same input. Bare points say nothing of the part of a body that they belong to: where an arm lies
near the flank, or sheets nearly touch, they can take each other's values. For two meshes of one
shape use `closest_point_restriction()` and `closest_point_prolongation()`, which do not.

@param points `r` x 3, coordinates in the unit of the surface, whose squares do not overflow.
@param surface `n` vertices and `m` triangles, `m > 0`. Faces without area count as their edges,
vertices without a face get an empty column.
@return `r` x `n`.

Throws `std::invalid_argument` for a coordinate that is not finite, an index out of range, a surface
without a face, or matrices that do not have three columns.

Complexity: one tree of the faces' boxes, then O(log m) per point for points close to the surface.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::SparseMatrix<double>
closest_point_interpolation(const Eigen::MatrixXd& points, const Mesh_matrices& surface);

/*!
returns a restriction `P` (coarse x fine) that does not depend on the simplifier, for judging any
coarse mesh, whoever made it.

Its rows are those of `closest_point_interpolation()`, followed on the surface: the feet of two
neighbours lie near each other on the fine surface as well. Where they do not, the vertices of the
smaller group are looked for again, from the feet of their neighbours. It is not the transpose of
the prolongation, and may have several nonzeros in a column.

Throws `std::invalid_argument` for what `closest_point_interpolation()` refuses.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::SparseMatrix<double>
closest_point_restriction(const Mesh_matrices& coarse, const Mesh_matrices& fine);

/*!
returns the *prolongation* (fine x coarse), by which functions on a simplified mesh go back to the
input: closest points of the coarse mesh, among the faces at most two edges away from the coarse
vertex whose row of P is nearest on the fine surface.

@param fine, coarse both meshes
@param P coarse x fine, the restriction; where there is none `closest_point_restriction()`. Fine
vertices in a component where it has no entry are looked for everywhere.

Throws `std::invalid_argument` for what `closest_point_interpolation()` refuses, and a P of another
size or with a row that does not sum to 1.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::SparseMatrix<double>
closest_point_prolongation(const Mesh_matrices& fine, const Mesh_matrices& coarse,
                           const Eigen::SparseMatrix<double>& P);

/*!
returns the rows of a restriction, of whatever origin, that read functions off another part of the
body than their neighbours do, ascending: those that `closest_point_restriction()` would look for
again. None in a good one.

A coarse edge counts as torn where the feet of its ends, \f$ P V \f$, lie further apart along the
edges of the fine mesh than three times the length of the edge and the distances of the feet from
the vertices.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE std::vector<Eigen::Index>
rows_off_their_part(const Mesh_matrices& coarse, const Mesh_matrices& fine,
                    const Eigen::SparseMatrix<double>& P);

/// @}

} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_GEOMETRY_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_GEOMETRY)

#include <CGAL/Spectral_geometry/internal/surface/Row_follower.h>
#include <CGAL/Spectral_geometry/internal/surface/Surface_regions.h>
#include <CGAL/Spectral_geometry/internal/surface/closest_point_search.h>

namespace CGAL::Spectral_geometry {
namespace internal {

inline void check_surface(const Mesh_matrices& surface, const char* const who,
                          const char* const name)
{
  require(surface.T.rows() != 0, who, "the ", name,
          " has no face, pass one with at least one triangle.");
  require(surface.T.cols() == 3 && surface.V.cols() == 3, who, "the matrices of the ", name,
          " have ", surface.V.cols(), " and ", surface.T.cols(),
          " columns, pass n x 3 coordinates and m x 3 indices.");
  for(Eigen::Index f = 0; f < surface.T.rows(); ++f)
    for(int c = 0; c < 3; ++c) {
      const int v = surface.T(f, c);
      require(v >= 0 && v < surface.V.rows(), who, "face ", f, " of the ", name,
              " refers to vertex ", v, ", which does not exist, repair the face.");
    }
  for(Eigen::Index v = 0; v < surface.V.rows(); ++v)
    require(surface.V.row(v).allFinite(), who, "vertex ", v, " of the ", name,
            " has a coordinate that is not finite, remove or repair it.");
}

inline void check_pair(const Mesh_matrices& coarse, const Mesh_matrices& fine,
                       const Eigen::SparseMatrix<double>& P, const char* const who)
{
  check_surface(coarse, who, "coarse mesh");
  check_surface(fine, who, "fine mesh");
  require(P.rows() == coarse.V.rows() && P.cols() == fine.V.rows(), who, "P is ", size_name(P),
          " where ", coarse.V.rows(), " x ", fine.V.rows(),
          " is needed, coarse x fine; pass matrices that belong together.");
  check_rows_of_restriction(who, P);
}

} // namespace internal

Eigen::SparseMatrix<double> closest_point_interpolation(const Eigen::MatrixXd& points,
                                                        const Mesh_matrices& surface)
{
  using internal::require;
  require(points.rows() == 0 || points.cols() == 3, "closest_point_interpolation: the points have ",
          points.cols(), " columns, pass a matrix of 3 columns.");
  for(Eigen::Index i = 0; i < points.rows(); ++i)
    require(points.row(i).allFinite(), "closest_point_interpolation: point ", i,
            " has a coordinate that is not finite, remove or repair it.");
  internal::check_surface(surface, "closest_point_interpolation: ", "surface");
  const internal::Closest_point_query closest(surface);
  return internal::interpolation(surface, points.rows(),
                                 [&](const Eigen::Index i) { return closest(points.row(i)); });
}

Eigen::SparseMatrix<double> closest_point_restriction(const Mesh_matrices& coarse,
                                                      const Mesh_matrices& fine)
{
  internal::check_surface(coarse, "closest_point_restriction: ", "coarse mesh");
  internal::check_surface(fine, "closest_point_restriction: ", "fine mesh");
  return internal::Row_follower(coarse, fine, closest_point_interpolation(coarse.V, fine)).run().P;
}

Eigen::SparseMatrix<double> closest_point_prolongation(const Mesh_matrices& fine,
                                                       const Mesh_matrices& coarse,
                                                       const Eigen::SparseMatrix<double>& P)
{
  internal::check_pair(coarse, fine, P, "closest_point_prolongation: ");
  return internal::Surface_regions(coarse, fine, P).prolongation();
}

std::vector<Eigen::Index> rows_off_their_part(const Mesh_matrices& coarse,
                                              const Mesh_matrices& fine,
                                              const Eigen::SparseMatrix<double>& P)
{
  internal::check_pair(coarse, fine, P, "rows_off_their_part: ");
  return internal::Row_follower(coarse, fine, P).run().off;
}

} // namespace CGAL::Spectral_geometry

#endif // definitions

#endif // CGAL_SPECTRAL_GEOMETRY_CLOSEST_POINT_INTERPOLATION_H
