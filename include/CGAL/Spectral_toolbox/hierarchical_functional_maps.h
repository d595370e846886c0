// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_HIERARCHICAL_FUNCTIONAL_MAPS_H
#define CGAL_SPECTRAL_TOOLBOX_HIERARCHICAL_FUNCTIONAL_MAPS_H

#include <CGAL/Spectral_geometry/internal/basics.h>
#include <CGAL/Spectral_toolbox/internal/separate_compilation.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationTransfer
/// @{

/// a functional map between two fine meshes and how well determined it is, see
/// `lift_functional_map()`.
struct Lifted_functional_map
{
  Eigen::MatrixXd C; ///< \f$ C_{X,Y} \f$, (modes of Y) x (modes of X)
  /// largest over smallest singular value of \f$ C_{Y,\widetilde Y} \f$: 1 for a simplification
  /// that keeps all modes of Y, infinite if one of them has vanished from the coarse mesh
  double condition = std::numeric_limits<double>::infinity();
  /// number of singular values of \f$ C_{Y,\widetilde Y} \f$ that were not cut off, at most the
  /// modes of Y
  Eigen::Index rank = 0;
  /// \f$ \|C_{Y,\widetilde Y} C_{X,Y} - C_{\widetilde X,\widetilde Y} C_{X,\widetilde X}\| /
  /// \|C_{\widetilde X,\widetilde Y} C_{X,\widetilde X}\| \f$, Frobenius norms; 0 when the right
  /// side is 0
  double relative_residual = 0;
};

/*!
lifts a functional map between two coarse meshes to the fine meshes that they were simplified from:
solves
\f[ C_{Y,\widetilde Y} \, C_{X,Y} = C_{\widetilde X,\widetilde Y} \, C_{X,\widetilde X} \f]
for \f$ C_{X,Y} \f$ in the sense of least squares (section 5.2 of Lescoat et al. 2020). Both sides
are the map from the fine source X to the coarse target \f$ \widetilde Y \f$: through the fine
target on the left, through the coarse source on the right.

\f$ C_{X,\widetilde X} \f$ and \f$ C_{Y,\widetilde Y} \f$ are those of the restrictions, by
`functional_map()` and `unit_area_functional_map()`; the paper uses binary restrictions here. All
maps are between eigenvectors of meshes scaled to unit area, or all between those of the meshes as
they are.

Conditioning: a simplification that keeps the spectrum makes \f$ C_{Y,\widetilde Y} \f$ nearly
orthonormal, with all singular values close to 1. A mode of Y that the coarse mesh has lost shows as
a small one, whose inverse would multiply the errors of the coarse map. Singular values below
`tolerance` times the largest are therefore cut off, and of the remaining solutions the one of
smallest norm is returned.

@param source_restriction \f$ C_{X,\widetilde X} \f$, (coarse modes of X) x (fine modes of X)
@param coarse \f$ C_{\widetilde X,\widetilde Y} \f$, (coarse modes of Y) x (coarse modes of X)
@param target_restriction \f$ C_{Y,\widetilde Y} \f$, (coarse modes of Y) x (fine modes of Y); with
at least as many rows as columns the system is not underdetermined
@param tolerance in [0, 1[; values below 1e-14, which is rounding, count as 1e-14

Throws `std::invalid_argument` if sizes do not match, a number is not finite or the tolerance out of
range.
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Lifted_functional_map
lift_functional_map(const Eigen::MatrixXd& source_restriction, const Eigen::MatrixXd& coarse,
                    const Eigen::MatrixXd& target_restriction, double tolerance = 0.05);

/// @}

} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_TOOLBOX_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_TOOLBOX)

#include <Eigen/SVD>

namespace CGAL::Spectral_geometry {

Lifted_functional_map lift_functional_map(const Eigen::MatrixXd& source_restriction,
                                          const Eigen::MatrixXd& coarse,
                                          const Eigen::MatrixXd& target_restriction,
                                          double tolerance)
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

  Eigen::JacobiSVD<Eigen::MatrixXd> svd(target_restriction,
                                        Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold((std::max)(tolerance, 1e-14));
  const Eigen::VectorXd& sigma = svd.singularValues();
  const Eigen::MatrixXd right = coarse * source_restriction;
  Lifted_functional_map result;
  result.rank = svd.rank();
  result.C = svd.solve(right);
  const double smallest = target_restriction.cols() <= sigma.size() ? sigma(sigma.size() - 1) : 0.;
  if(smallest > 1e-14 * sigma(0)) // else infinite
    result.condition = sigma(0) / smallest;
  const double norm = right.norm();
  if(norm > 0)
    result.relative_residual = (target_restriction * result.C - right).norm() / norm;
  return result;
}

} // namespace CGAL::Spectral_geometry

#endif // definitions

#endif // CGAL_SPECTRAL_TOOLBOX_HIERARCHICAL_FUNCTIONAL_MAPS_H
