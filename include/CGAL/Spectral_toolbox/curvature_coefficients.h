// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_CURVATURE_COEFFICIENTS_H
#define CGAL_SPECTRAL_TOOLBOX_CURVATURE_COEFFICIENTS_H

#include <CGAL/Spectral_toolbox/internal/separate_compilation.h>
#include <CGAL/Spectral_geometry/local_operator.h>

#include <Eigen/Core>

#include <functional>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/*!
\brief returns coefficients by which functions vary more easily along than across the bends of a
surface: the anisotropic Laplacian of Andreux et al., *Anisotropic Laplace-Beltrami Operators for
Shape Analysis*, 2014,
\f[ D = \psi(\kappa_1) d_1 d_1^\top + \psi(\kappa_2) d_2 d_2^\top + \sqrt{\psi(\kappa_1)
\psi(\kappa_2)} \, n n^\top, \qquad \psi(\kappa) = \frac{1}{1 + \alpha \, r \, |\kappa|} , \qquad
\rho = 1, \f]
with the principal curvatures and directions of a jet of degree two fitted to the
first rings of 16 vertices and more, 64 neighbours of a hub in them (F. Cazals and M. Pouget,
`CGAL::Monge_via_jet_fitting`), and \f$r = \sqrt{A / 4 \pi}\f$, the radius of the sphere of the same
area: D does not change with the scale. Where too few vertices can be fitted to, D is the identity.

\param V, T   n x 3 positions and m x 3 vertex indices
\param alpha  how much the curvature counts, from 0 (the identity) to 1e6; without unit
\param progress  is called with the fraction done; returns false to cancel

\throws std::invalid_argument if alpha is out of range, or as `barycentric_corner_masses()` does;
Cancelled when the progress callback returned false
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Operator_coefficients
curvature_coefficients(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const double alpha,
                       const std::function<bool(double)>& progress = {});

/// @}

} // namespace CGAL::Spectral_geometry

#ifndef CGAL_SPECTRAL_TOOLBOX_COMPILED
#include <CGAL/Spectral_toolbox/internal/curvature_coefficients_impl.h>
#endif

#endif // CGAL_SPECTRAL_TOOLBOX_CURVATURE_COEFFICIENTS_H
