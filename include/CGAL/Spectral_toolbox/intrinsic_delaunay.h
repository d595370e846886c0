// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_INTRINSIC_DELAUNAY_H
#define CGAL_SPECTRAL_TOOLBOX_INTRINSIC_DELAUNAY_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_toolbox/internal/separate_compilation.h>
#include <CGAL/Spectral_geometry/local_operator.h>

#include <Eigen/Core>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief assembles the cotangent Laplacian and the mass of the intrinsic Delaunay triangulation of
/// the mesh (V, T): for meshes with needles and obtuse triangles.
///
/// The surface and the vertices stay as they are, and so does the area. Edges become geodesics of
/// the surface: an edge with two faces is flipped within them, laid out in the plane, until no two
/// opposite angles are larger than \f$\pi\f$ together,
/// \f$\cot\alpha_{ij} + \cot\beta_{ij} \ge 0\f$ (Bobenko and Springborn 2007, Fisher et al. 2007,
/// Sharp and Crane 2020). Each flip lowers the Dirichlet energy of every function (Rippa 1990), so
/// \f$L_{plain} - L\f$ is positive semidefinite where all faces have an area, and it lowers the sum
/// of all cotangents, so flips end. Off-diagonal entries of \f$L\f$ are at most 0 to rounding,
/// which gives a maximum principle, unless an obtuse angle faces an edge that is never flipped: one
/// on a border, with more than two faces, or with two whose orientations disagree; or one beside a
/// face that has no area still. A mesh that is Delaunay has the L and B of `laplace_operator()`.
///
/// L and B are those of linear elements on the intrinsic triangles, see `laplace_operator()`; there
/// can be edges from a vertex to itself, which add nothing to L, and several between two vertices.
/// Functions are linear on the intrinsic triangles, not on the faces T: only their values at the
/// vertices belong to both. Faces of zero area contribute nothing; one with a corner between its
/// other two is gone after the flips, and connects what it had torn apart.
///
/// `Spectral_options::operator_of_eigenpairs` hands it to a simplification:
/// `options.operator_of_eigenpairs = [](const auto& V, const auto& T) { return
/// intrinsic_delaunay_laplacian(V, T, Mass::averaged); };`
///
/// \param V      n x 3 positions, in any unit of length u; B is in u^2, eigenvalues in u^-2
/// \param T      m x 3 vertex indices, counted from 0; the mesh need not be a manifold
/// \param mass   averaged (\f$\theta = 1/2\f$, default), lumped or voronoi
///
/// Time: that of sorting 3 m edges, and a constant for each flip. A face is part of 10000 flips at
/// most, for surfaces that are thinner than rounding, around which edges wind without end; meshes
/// of needles take hundreds.
///
/// \throws std::invalid_argument that names the first offender: a coordinate that is not finite, an
///         index out of range, a face that uses a vertex twice, a needle whose cotangent is larger
///         than 1e12 after the flips, an isolated vertex, a vertex with only zero-area faces.
CGAL_SPECTRAL_TOOLBOX_INLINE Laplace_operator intrinsic_delaunay_laplacian(
    const Eigen::MatrixXd& V, const Eigen::MatrixXi& T, Mass mass = Mass::averaged);

/// @}

} // namespace CGAL::Spectral_geometry

#ifndef CGAL_SPECTRAL_TOOLBOX_COMPILED
#include <CGAL/Spectral_toolbox/internal/intrinsic_delaunay_impl.h>
#endif

#endif // CGAL_SPECTRAL_TOOLBOX_INTRINSIC_DELAUNAY_H
