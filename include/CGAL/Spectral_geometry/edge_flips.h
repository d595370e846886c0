// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_EDGE_FLIPS_H
#define CGAL_SPECTRAL_GEOMETRY_EDGE_FLIPS_H

#include <CGAL/Spectral_geometry/Edge_flip_options.h>
#include <CGAL/Spectral_geometry/internal/separate_compilation.h>
#include <CGAL/Spectral_geometry/local_operator.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <utility>
#include <vector>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/*!
flips edges of a coarse mesh so that its Laplace-Beltrami operator agrees better with that of a fine one, as section 6 of
Lescoat et al. 2020 does after a simplification; positions and the restriction stay.

The metric (Eq. 2, in the weak form for any mass)
\f[ E = \sum_w \| (B \tilde Z)_w - (L \tilde F)_w \|^2 / M_w, \qquad \tilde F = P F, \quad \tilde Z = P Z, \f]
is a sum over vertices, and the term of w depends on the triangles around w alone. A flip replaces two triangles, so that
it changes the terms of their four vertices and no other: its cost, E after less E before, is computed from these rows
exactly. The flip of lowest cost is done first, then the edges are looked at again that have one of the four vertices in
one of their two triangles, until no cost is negative. With `Edge_flips::delaunay` the cotangent weight of an edge takes
the place of the cost, and E is only reported.

@param V       coarse x 3, the positions
@param T       the triangles of the coarse mesh, an oriented manifold, changed in place
@param P       coarse x fine, the restriction
@param F, Z    fine x K, the signals and B^-1 L F; for eigenvectors Phi and Phi Lambda
@param op      the operator, with coefficients for the coarse vertices or none; a mass by name, or the weight theta of the
               consistent mass
@param constrained  edges that stay, each as a pair of vertices in either order; pairs that are no edge are ignored
@param options which edges, guards, when to stop

Throws `std::invalid_argument` for matrices that do not belong together, triangles that are no oriented manifold or options
out of range, `Cancelled` when the progress callback returned false; T is then as it was.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Edge_flip_result
flip_edges(const Eigen::MatrixXd& V, Eigen::MatrixXi& T, const Eigen::SparseMatrix<double>& P,
           const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z, const Local_operator& op,
           const std::vector<std::pair<int, int>>& constrained = {}, const Edge_flip_options& options = {});

/// @}

} // namespace CGAL::Spectral_geometry

#ifndef CGAL_SPECTRAL_GEOMETRY_COMPILED
#include <CGAL/Spectral_geometry/internal/flips/edge_flips_impl.h>
#endif

#endif // CGAL_SPECTRAL_GEOMETRY_EDGE_FLIPS_H
