// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_LOCAL_OPERATOR_H
#define CGAL_SPECTRAL_GEOMETRY_LOCAL_OPERATOR_H

#include <CGAL/Spectral_geometry/internal/basics.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief the mass matrix of linear finite elements: lumped by barycentric or by mixed Voronoi
/// areas, consistent, or the mean of lumped (barycentric) and consistent.
///
/// `averaged` cancels the leading discretisation error of the eigenvalues on equilateral triangles
/// and largely reduces it elsewhere (blending from dispersion analysis: Marfurt 1984, Ainsworth and
/// Wajid 2010). `voronoi` gives each corner of a triangle the part that is nearest to it; in an
/// obtuse triangle the obtuse corner gets half, the others a quarter each (Meyer et al. 2003).
enum class Mass { lumped, averaged, voronoi, consistent };

/// \brief the weight \f$\theta\f$ of the consistent mass in \f$B = (1-\theta) M_{lumped} + \theta
/// M_{consistent}\f$: 1 for `Mass::consistent`, 1/2 for `Mass::averaged`, otherwise 0.
inline double mass_blend(Mass mass)
{
  return mass == Mass::consistent ? 1. : mass == Mass::averaged ? 0.5 : 0.;
}

/// \brief `"lumped"`, `"averaged"`, `"voronoi"` or `"consistent"`.
inline const char* mass_name(Mass mass)
{
  return mass == Mass::averaged  ? "averaged"
         : mass == Mass::voronoi ? "voronoi"
         : mass == Mass::lumped  ? "lumped"
                                 : "consistent";
}

/// \brief the coefficients of \f$-\mathrm{div}(D \nabla \phi) = \lambda \rho \phi\f$ at the
/// vertices of a mesh, n x 7: in each row the density \f$\rho\f$ and the conductivity D, a
/// symmetric 3 x 3 matrix, as xx, xy, xz, yy, yz, zz.
///
/// Only what D does within the surface matters. Empty: \f$\rho = 1\f$, D the identity, the
/// Laplace-Beltrami operator. Collapses merge coefficients as they merge signals: with their
/// restriction P the coarse mesh has `P * coefficients`.
using Operator_coefficients = Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>;

/// \brief the condition on functions at the border of a mesh: their normal derivative vanishes
/// (`neumann`, the natural condition), or they vanish themselves (`dirichlet`).
enum class Boundary_condition { neumann, dirichlet };

/*!
\brief which stiffness and mass a mesh gets. What a triangle adds to them follows from its corners
alone: the metric of the collapses and relocation can follow such an operator.

In a triangle with corners i, j, k, area A and the mean of its corners' coefficients, \f$\rho\f$ and
D,
\f[ L_{ij} = \frac{(n \times e_i) \cdot D (n \times e_j)}{4A} , \qquad
    B = \rho A \left( (1-\theta)\, \mathrm{diag}(s) + \theta\, \frac{1}{12} (I + 1 1^\top) \right),
\f]
n its normal and \f$e_i\f$ the edge opposite to i, all edges one way round: \f$L_{ij} =
-\cot(k)/2\f$ for the identity, c times that for a conductivity c. The shares s are 1/3 each, or
those of mixed Voronoi areas in the metric of D. Constants are in the kernel of L, whatever D is.

With `Boundary_condition::dirichlet` the matrices keep a row for each vertex. Entries that couple
border vertices to others are taken out of both. What is left of these rows has the eigenvalue 100
pi n over the mass of the mesh in the unit of L, far beyond most of the spectrum. `eigenpairs()`
solves the problem without these rows, and its vectors are 0 there. The masses M do not change.
*/
struct Local_operator
{
  double theta = 0.5;   ///< weight of the consistent mass, in [0, 1]
  bool voronoi = false; ///< mixed Voronoi shares in place of thirds; with `theta` 0 alone
  /// n x 7, or empty for the cotangent Laplacian
  Operator_coefficients coefficients;
  Boundary_condition boundary = Boundary_condition::neumann; ///< where the mesh has a border

  /// the cotangent Laplacian in the blend `theta`
  Local_operator(const double theta = 0.5)
    : theta(theta)
  {}

  /// coefficients at the vertices, or none, in a mass by name
  Local_operator(const Mass mass, Operator_coefficients coefficients = {},
                 const Boundary_condition boundary = Boundary_condition::neumann)
    : theta(mass_blend(mass))
    , voronoi(mass == Mass::voronoi)
    , coefficients(std::move(coefficients))
    , boundary(boundary)
  {}

  /// Returns this operator on a mesh that the restriction P leads to.
  template <class Matrix>
  Local_operator restricted(const Matrix& P) const
  {
    Local_operator result = *this;
    if(coefficients.rows() != 0)
      result.coefficients = P * coefficients;
    return result;
  }
};

/// @}

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_LOCAL_OPERATOR_H
