// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_CLOSEST_POINT_INTERPOLATION_IMPL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_CLOSEST_POINT_INTERPOLATION_IMPL_H

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/internal/require.h>
#include <CGAL/Spectral_geometry/internal/surface/Row_follower.h>
#include <CGAL/Spectral_geometry/internal/surface/Surface_regions.h>
#include <CGAL/Spectral_geometry/internal/surface/closest_point_search.h>

namespace CGAL::Spectral_geometry {
namespace internal {

inline void check_points(const Eigen::MatrixXd& points, const char* const who,
                         const char* const what)
{
  require(points.rows() == 0 || points.cols() == 3, who, "the ", what, "s have ", points.cols(),
          " columns, pass a matrix of 3 columns.");
  for(Eigen::Index i = 0; i < points.rows(); ++i)
    require(points.row(i).allFinite(), who, what, " ", i,
            " has a coordinate that is not finite, remove or repair it.");
}

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
                       const char* const who)
{
  check_surface(coarse, who, "coarse mesh");
  check_surface(fine, who, "fine mesh");
}

inline void check_pair(const Mesh_matrices& coarse, const Mesh_matrices& fine,
                       const Eigen::SparseMatrix<double>& P, const char* const who)
{
  check_pair(coarse, fine, who);
  require(P.rows() == coarse.V.rows() && P.cols() == fine.V.rows(), who, "P is ", size_name(P),
          " where ", coarse.V.rows(), " x ", fine.V.rows(),
          " is needed, coarse x fine; pass matrices that belong together.");
}

} // namespace internal

CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::SparseMatrix<double>
closest_point_interpolation(const Eigen::MatrixXd& points, const Mesh_matrices& surface)
{
  const char* const who = "closest_point_interpolation: ";
  internal::check_points(points, who, "point");
  internal::check_surface(surface, who, "surface");
  const internal::Closest_point_query closest(surface);
  return internal::interpolation(surface, points.rows(),
                                 [&](const Eigen::Index i) { return closest(points.row(i)); });
}

CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::SparseMatrix<double>
closest_point_restriction(const Mesh_matrices& coarse, const Mesh_matrices& fine)
{
  internal::check_pair(coarse, fine, "closest_point_restriction: ");
  return internal::Row_follower(coarse, fine, closest_point_interpolation(coarse.V, fine)).run().P;
}

CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::SparseMatrix<double>
closest_point_prolongation(const Mesh_matrices& fine, const Mesh_matrices& coarse,
                           const Eigen::SparseMatrix<double>& P)
{
  internal::check_pair(coarse, fine, P, "closest_point_prolongation: ");
  return internal::Surface_regions(coarse, fine, P).prolongation();
}

CGAL_SPECTRAL_GEOMETRY_INLINE std::vector<Eigen::Index>
rows_off_their_part(const Mesh_matrices& coarse, const Mesh_matrices& fine,
                    const Eigen::SparseMatrix<double>& P)
{
  internal::check_pair(coarse, fine, P, "rows_off_their_part: ");
  return internal::Row_follower(coarse, fine, P).run().off;
}

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_CLOSEST_POINT_INTERPOLATION_IMPL_H
