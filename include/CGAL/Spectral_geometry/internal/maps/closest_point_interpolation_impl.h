// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_MAPS_CLOSEST_POINT_INTERPOLATION_IMPL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_MAPS_CLOSEST_POINT_INTERPOLATION_IMPL_H

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/internal/require.h>
#include <CGAL/Spectral_geometry/internal/search/closest_point_search.h>

namespace CGAL::Spectral_geometry {

CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::SparseMatrix<double>
closest_point_interpolation(const Eigen::MatrixXd& points, const Mesh_matrices& surface)
{
  using internal::require;
  const char* const who = "closest_point_interpolation: ";
  require(points.rows() == 0 || points.cols() == 3, who, "the points have ", points.cols(),
          " columns, pass a matrix of 3 columns.");
  for(Eigen::Index i = 0; i < points.rows(); ++i)
    require(points.row(i).allFinite(), who, "point ", i,
            " has a coordinate that is not finite, remove or repair it.");
  require(surface.T.rows() != 0, who, "the surface has no face, pass one with at least one triangle.");
  require(surface.T.cols() == 3 && surface.V.cols() == 3, who, "the matrices of the surface have ",
          surface.V.cols(), " and ", surface.T.cols(), " columns, pass n x 3 coordinates and m x 3 indices.");
  for(Eigen::Index f = 0; f < surface.T.rows(); ++f)
    for(int c = 0; c < 3; ++c) {
      const int v = surface.T(f, c);
      require(v >= 0 && v < surface.V.rows(), who, "face ", f, " of the surface refers to vertex ", v,
              ", which does not exist, repair the face.");
      require(surface.V.row(v).allFinite(), who, "vertex ", v,
              " of the surface has a coordinate that is not finite, remove or repair it.");
    }
  return internal::interpolation(internal::Closest_point_query(surface), surface, points);
}

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_MAPS_CLOSEST_POINT_INTERPOLATION_IMPL_H
