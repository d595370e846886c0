// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_OPERATOR_COEFFICIENTS_H
#define CGAL_SPECTRAL_GEOMETRY_OPERATOR_COEFFICIENTS_H

#include <CGAL/Spectral_geometry/internal/separate_compilation.h>
#include <CGAL/Spectral_geometry/local_operator.h>

#include <Eigen/Core>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief returns the coefficients of \f$-\mathrm{div}(c \nabla \phi) = \lambda \rho \phi\f$.
///
/// \param density      n, \f$\rho\f$ at each vertex, positive, or empty: 1
/// \param conductivity n, c at each vertex, positive, or empty: 1
///
/// Throws `std::invalid_argument` that names the first entry that is not positive and finite, or
/// sizes that differ.
CGAL_SPECTRAL_GEOMETRY_INLINE Operator_coefficients
weighted_coefficients(const Eigen::VectorXd& density, const Eigen::VectorXd& conductivity);

/// \brief returns the coefficients of \f$-\mathrm{div}(D \nabla \phi) = \lambda \rho \phi\f$.
///
/// \param conductivity n x 6, D at each vertex as xx, xy, xz, yy, yz, zz, positive definite
/// \param density      n, positive, or empty: 1
///
/// Throws `std::invalid_argument` that names the first vertex whose D is not positive definite, or
/// whose density is not positive.
CGAL_SPECTRAL_GEOMETRY_INLINE Operator_coefficients
anisotropic_coefficients(const Eigen::MatrixXd& conductivity, const Eigen::VectorXd& density = {});

/// \brief returns coefficients at the vertices from coefficients of the faces, m x 7: the mean over
/// the faces of a vertex, weighted by area. What jumps between faces is smoothed by that.
///
/// Throws `std::invalid_argument` for matrices that do not belong together, or a vertex without a
/// face.
CGAL_SPECTRAL_GEOMETRY_INLINE Operator_coefficients coefficients_at_vertices(
    const Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const Operator_coefficients& of_faces);

/// @}

} // namespace CGAL::Spectral_geometry

#ifndef CGAL_SPECTRAL_GEOMETRY_COMPILED
#include <CGAL/Spectral_geometry/internal/surface/operator_coefficients_impl.h>
#endif

#endif // CGAL_SPECTRAL_GEOMETRY_OPERATOR_COEFFICIENTS_H
