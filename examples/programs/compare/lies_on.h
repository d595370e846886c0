// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_COMPARE_LIES_ON_H
#define SPECTRAL_EXAMPLES_COMPARE_LIES_ON_H

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

// Why a coarse mesh, whoever made it, cannot stand for a fine one: the end of a sentence, or
// nothing. What counts is how far the vertices of each lie from the surface of the other, on
// average. Simplifications to 300 vertices are off by a hundredth of the shape, and by a sixth of
// their edges; a shape that is turned by a right angle is off by half an edge, however round it is.
inline std::string not_on(const CGAL::Spectral_geometry::Mesh_matrices& coarse,
                          const CGAL::Spectral_geometry::Mesh_matrices& fine)
{
  using CGAL::Spectral_geometry::closest_point_interpolation;
  const double size =
      std::sqrt(CGAL::Spectral_geometry::laplace_operator(fine.V, fine.T).mass.sum());
  const double distance =
      (std::max)(
          (closest_point_interpolation(coarse.V, fine) * fine.V - coarse.V).rowwise().norm().mean(),
          (closest_point_interpolation(fine.V, coarse) * coarse.V - fine.V)
              .rowwise()
              .norm()
              .mean()) /
      size;
  const double in_edges = distance * std::sqrt(double(coarse.V.rows()));
  if(distance < 0.01 || (distance < 0.05 && in_edges < 0.3))
    return "";
  char percent[32];
  std::snprintf(percent, sizeof(percent), "%.3g", 100 * distance);
  return std::string("does not lie on it, both are ") + percent +
         " % of the square root of the area apart on average: is it in another unit, moved or "
         "turned? "
         "Simplify "
         "that mesh, and leave it where it is and in its unit of length";
}

#endif // SPECTRAL_EXAMPLES_COMPARE_LIES_ON_H
