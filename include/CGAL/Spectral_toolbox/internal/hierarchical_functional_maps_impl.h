// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_INTERNAL_HIERARCHICAL_FUNCTIONAL_MAPS_IMPL_H
#define CGAL_SPECTRAL_TOOLBOX_INTERNAL_HIERARCHICAL_FUNCTIONAL_MAPS_IMPL_H

#include <CGAL/Spectral_toolbox/hierarchical_functional_maps.h>
#include <CGAL/Spectral_geometry/internal/require.h>

#include <Eigen/SVD>

#include <algorithm>

namespace CGAL::Spectral_geometry {

CGAL_SPECTRAL_TOOLBOX_INLINE Lifted_functional_map
lift_functional_map(const Eigen::MatrixXd& source_restriction, const Eigen::MatrixXd& coarse,
                    const Eigen::MatrixXd& target_restriction, double tolerance)
{
  internal::check_dimension("the number of columns of the coarse map", coarse.cols(),
                            source_restriction.rows());
  internal::check_dimension("the number of rows of the coarse map", coarse.rows(),
                            target_restriction.rows());
  internal::require(tolerance >= 0 && tolerance < 1, "functional map: the tolerance is ", tolerance,
                    ", it must lie in [0, 1[.");
  for(const Eigen::MatrixXd* map : {&source_restriction, &coarse, &target_restriction})
    internal::require(
        map->size() != 0 && map->allFinite(),
        "functional map: a map is empty or has an entry that is not finite, check the "
        "eigenvectors and restrictions.");

  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(target_restriction,
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& sigma = svd.singularValues();
  const Eigen::MatrixXd right = coarse * source_restriction;
  Lifted_functional_map result;
  const double threshold = (std::max)(tolerance, 1e-14) * sigma(0);
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(sigma.size());
  for(; result.rank < sigma.size() && sigma(result.rank) > threshold; ++result.rank)
    inverse(result.rank) = 1 / sigma(result.rank);
  result.C = svd.matrixV() * (inverse.asDiagonal() * (svd.matrixU().transpose() * right));
  const double smallest = target_restriction.cols() <= sigma.size() ? sigma(sigma.size() - 1) : 0.;
  result.condition =
      smallest > 1e-14 * sigma(0) ? sigma(0) / smallest : std::numeric_limits<double>::infinity();
  const double norm = right.norm();
  if(norm > 0)
    result.relative_residual = (target_restriction * result.C - right).norm() / norm;
  return result;
}

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_TOOLBOX_INTERNAL_HIERARCHICAL_FUNCTIONAL_MAPS_IMPL_H
