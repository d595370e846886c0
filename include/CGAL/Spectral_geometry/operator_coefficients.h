// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_OPERATOR_COEFFICIENTS_H
#define CGAL_SPECTRAL_GEOMETRY_OPERATOR_COEFFICIENTS_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>

namespace CGAL::Spectral_geometry {

namespace internal {

inline void check_length(const char* what, const Eigen::Index found, const Eigen::Index wanted)
{
  require(found == 0 || found == wanted, "Local operator: ", what, " has ", found,
          " entries where ", wanted, " are needed; give one for each vertex.");
}

} // namespace internal

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief returns the coefficients of \f$-\mathrm{div}(D \nabla \phi) = \lambda \rho \phi\f$.
///
/// \param conductivity n x 6, D at each vertex as xx, xy, xz, yy, yz, zz, positive definite
/// \param density      n, positive, or empty: 1
///
/// Throws `std::invalid_argument` that names the first vertex whose D is not positive definite, or
/// whose density is not positive.
inline Operator_coefficients anisotropic_coefficients(const Eigen::MatrixXd& conductivity,
                                                      const Eigen::VectorXd& density = {})
{
  const Eigen::Index n = conductivity.rows();
  internal::require(conductivity.cols() == 6, "Local operator: the conductivity has ",
                    conductivity.cols(), " columns; give six, xx, xy, xz, yy, yz, zz.");
  internal::check_length("the density", density.size(), n);
  Operator_coefficients result(n, 7);
  result.col(0) = density.size() != 0 ? density : Eigen::VectorXd::Ones(n);
  result.rightCols<6>() = conductivity;
  internal::check_local_operator(Local_operator(Mass::lumped, result), n);
  return result;
}

/// \brief returns the coefficients of \f$-\mathrm{div}(c \nabla \phi) = \lambda \rho \phi\f$.
///
/// \param density      n, \f$\rho\f$ at each vertex, positive, or empty: 1
/// \param conductivity n, c at each vertex, positive, or empty: 1
///
/// Throws `std::invalid_argument` that names the first entry that is not positive and finite, or
/// sizes that differ.
inline Operator_coefficients weighted_coefficients(const Eigen::VectorXd& density,
                                                   const Eigen::VectorXd& conductivity)
{
  const Eigen::Index n = density.size() != 0 ? density.size() : conductivity.size();
  internal::check_length("the conductivity", conductivity.size(), n);
  for(Eigen::Index v = 0; v < conductivity.size(); ++v)
    internal::require(conductivity(v) > 0. && std::isfinite(conductivity(v)),
                      "Local operator: the conductivity of ", internal::vertex_name(v), " is ",
                      conductivity(v), "; use positive numbers.");
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, 6);
  for(const int diagonal : {0, 3, 5})
    D.col(diagonal) = conductivity.size() != 0 ? conductivity : Eigen::VectorXd::Ones(n);
  return anisotropic_coefficients(D, density);
}

/// \brief returns coefficients at the vertices from coefficients of the faces, m x 7: the mean over
/// the faces of a vertex, weighted by area. This smooths jumps between faces.
///
/// Throws `std::invalid_argument` for matrices that do not belong together, or a vertex without a
/// face.
inline Operator_coefficients coefficients_at_vertices(const Eigen::MatrixXd& V,
                                                      const Eigen::MatrixXi& T,
                                                      const Operator_coefficients& of_faces)
{
  internal::require(of_faces.rows() == T.rows(), "Local operator: there are coefficients for ",
                    of_faces.rows(), " faces, but the mesh has ", T.rows(),
                    "; give one row for each.");
  const Eigen::VectorXd area = barycentric_corner_masses(V, T);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(V.rows());
  Operator_coefficients result = Operator_coefficients::Zero(V.rows(), 7);
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    for(int k = 0; k < 3; ++k) {
      sum(T(f, k)) += area(f);
      result.row(T(f, k)) += area(f) * of_faces.row(f);
    }
  internal::check_mass(sum, T);
  result = sum.cwiseInverse().asDiagonal() * result;
  internal::check_local_operator(Local_operator(Mass::lumped, result), V.rows());
  return result;
}

/// @}

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_OPERATOR_COEFFICIENTS_H
