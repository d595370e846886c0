// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_RELOCATION_H
#define CGAL_SPECTRAL_GEOMETRY_RELOCATION_H

#include <CGAL/Spectral_geometry/Relocation_options.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/separate_compilation.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <vector>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/*!
moves the vertices of a coarse mesh so that its Laplace-Beltrami operator agrees better with that of
a fine one; which triangles there are stays; the restriction is a new one where signals are
`sampled`.

It lowers the part of the residual of the metric (Eq. 2 of Lescoat et al. 2020) that the functional
map sees, see `Relocation_energy`, over all positions by L-BFGS, with guards that are on by default:
no triangle is inverted or degenerates, no new self-intersection, total area and volume and the
eigenvalues beyond K are kept, no vertex leaves the place its signals were taken from, boundary
vertices stay on the boundary. The mesh may come from anywhere: from an edge collapse with the
restriction it carried, or from a remesher with `closest_point_restriction()`.

Nothing in that residual speaks for the coarse eigenvalues beyond K: their modes meet signals of
lower eigenvalues only, and each term \f$ (\lambda_j - \widetilde\lambda_i)^2 C_{ij}^2 \f$ falls
when \f$ \widetilde\lambda_i \f$ does, although these eigenvalues are too low already.
`Relocation_options::beyond` therefore holds the mean of the next K / 2 where it was; this takes the
lowest 1.5 K eigenpairs of the coarse mesh and 16 more, found once and followed every ten steps, and
nothing of the fine one.

Made for the averaged mass. With the lumped mass (theta = 0) the leading error of the elements has
the size of what is to be repaired, and a descent cancels it by distorting the shape.

@param V      coarse x 3, the positions, changed in place
@param T      the triangles of the coarse mesh
@param P      coarse x fine, the restriction
@param fine   the fine mesh
@param F, Z   fine x K, the signals and B^-1 L F; for eigenvectors Phi and Phi Lambda
@param op     the operator, with coefficients for the coarse vertices or none; a mass by name, or
the weight theta of the consistent mass
@param fixed  for each coarse vertex whether it must stay; empty: none
@param options what to minimise, guards, when to stop

Throws `std::invalid_argument` for matrices that do not belong together or options out of range,
`Cancelled` when the progress callback returned false; V is then as it was.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Relocation_result
relocate_positions(Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                   const Eigen::SparseMatrix<double>& P, const Mesh_matrices& fine,
                   const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z, const Local_operator& op,
                   const std::vector<bool>& fixed = {}, const Relocation_options& options = {});

/// @}

namespace internal {

/// Relocates within other limits; the arguments have been checked.
CGAL_SPECTRAL_GEOMETRY_INLINE Relocation_result
relocate_within(Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const Eigen::SparseMatrix<double>& P,
                const Mesh_matrices& fine, const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z,
                const Local_operator& op, const std::vector<bool>& fixed,
                const Relocation_options& options, const Relocation_limits& limits);

} // namespace internal

} // namespace CGAL::Spectral_geometry

#ifndef CGAL_SPECTRAL_GEOMETRY_COMPILED
#include <CGAL/Spectral_geometry/internal/relocation/relocation_impl.h>
#endif

#endif // CGAL_SPECTRAL_GEOMETRY_RELOCATION_H
