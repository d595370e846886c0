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

Row `i` holds the barycentric coordinates, in its face, of the surface point closest to
`points.row(i)`: at most three nonzeros, none negative, which sum to 1. Zeros are not written. The
vector \f$ W g \f$ has the values of the piecewise linear function `g` at the closest points, so
that `W` times the vertices of the surface gives the closest points themselves.

If several points of the surface are equally close, one of them is taken, always the same for the
same input. A bare point does not tell to which part of a body it belongs: where an arm lies near
the flank, or sheets nearly touch, it may get the values of the other part. For two meshes of one
shape use `closest_point_restriction()` and `closest_point_prolongation()`, which avoid this.

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
returns a restriction `P` (coarse x fine) that does not depend on the simplifier, so that any coarse
mesh can be judged with it.

Its rows are those of `closest_point_interpolation()`, corrected so that the closest points of two
neighbours are near each other on the fine surface as well. Where they are not, the smaller group's
are sought again, from the closest points of their neighbours. It is not the
transpose of the prolongation, and may have several nonzeros in a column.

Throws `std::invalid_argument` for what `closest_point_interpolation()` refuses.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::SparseMatrix<double>
closest_point_restriction(const Mesh_matrices& coarse, const Mesh_matrices& fine);

/*!
returns the *prolongation* (fine x coarse), which takes functions on a simplified mesh back to the
input. Each row interpolates at the closest point of the coarse mesh, among the faces at most two
edges away from the coarse vertex whose row of P is nearest on the fine surface.

@param fine, coarse both meshes
@param P coarse x fine, the restriction; if there is none, `closest_point_restriction()`. Fine
vertices of a component without entries of P take the closest point anywhere.

Throws `std::invalid_argument` for what `closest_point_interpolation()` refuses, and a P of another
size or with a row that does not sum to 1.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::SparseMatrix<double>
closest_point_prolongation(const Mesh_matrices& fine, const Mesh_matrices& coarse,
                           const Eigen::SparseMatrix<double>& P);

/*!
returns, ascending, the rows of any restriction that read functions off another part of the body
than their neighbours do. `closest_point_restriction()` would replace them; a good restriction
has none.

A coarse edge counts as torn if the feet of its ends, \f$ P V \f$, are further apart along the edges
of the fine mesh than three times the sum of the edge's length and the distances of the feet from
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
