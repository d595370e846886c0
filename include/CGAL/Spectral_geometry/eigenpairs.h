// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_EIGENPAIRS_H
#define CGAL_SPECTRAL_GEOMETRY_EIGENPAIRS_H

#include <CGAL/Spectral_geometry/Cancelled.h>
#include <CGAL/Spectral_geometry/Eigenpairs_options.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/separate_compilation.h>

#include <Eigen/SparseCore>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief returns the first K generalised eigenpairs of a Laplace operator, \f$L \phi_k = \lambda_k
/// B \phi_k\f$.
///
/// Shift and invert: \f$(L - \sigma B)^{-1} B \phi = \nu \phi\f$, \f$\lambda = \sigma + 1/\nu\f$,
/// by a Lanczos method with a factorisation of \f$L - \sigma B\f$. About six tenths of the wanted
/// eigenvalues are below the shift \f$\sigma\f$, which the signs of the pivots count (Grimes, Lewis
/// and Simon 1994): the iteration then approaches the wanted spectrum from both of its ends. For
/// fewer than 16 pairs, more than four zeros, a `maximum_vectors` that is given, or where no such
/// shift serves, the shift is \f$-s\f$, where \f$s = 4\pi/\f$area is the mean spacing of the
/// eigenvalues by Weyl's law: the matrix is positive definite, and the eigenvalues next to 0 are
/// separated as well as with a smaller one. An L in another unit (entries a thousand times larger
/// or smaller than cotangents) has s in that unit. Start vectors are fixed, so the result is the
/// same in every run. With K = 100, `block` keeps about 2.4 K vectors of n doubles at a tolerance
/// of 1e-8, 2.1 K at 1e-4, with the shift below 0 3.4 K and 2.8 K, never more than max(3.6 K, K +
/// 120). More than 500 pairs are found some 120 at a time, each time with a shift among them.
///
/// Eigenvectors are orthonormal in B. Signs: the first entry (in vertex order) that is larger in
/// magnitude than 0.618 times the largest one is positive. Within an eigenspace of several
/// dimensions the basis is arbitrary.
///
/// \param op       the operator; eigenvalues are in the inverse of its unit of area
/// \param K        number of eigenpairs, 1 <= K <= n; with the Dirichlet condition at most the
/// number of vertices off the border \param options  method, tolerance, limits, threads, progress
///
/// \throws std::invalid_argument when K or an option is out of range or L, B differ in size;
///         std::runtime_error when the factorisation or the iteration fails;
///         Cancelled when the progress callback returned false
CGAL_SPECTRAL_GEOMETRY_INLINE Eigenpairs eigenpairs(const Laplace_operator& op, Eigen::Index K,
                                                    const Eigenpairs_options& options = {});

/// \brief returns the first K eigenpairs of any pencil \f$L \phi = \lambda B \phi\f$, with or
/// without a mesh.
///
/// \param L  n x n, symmetric, positive semidefinite, in any unit: the shift is taken from the
/// pencil
/// \param B  n x n, symmetric, positive definite, with positive row sums: a mass matrix
/// \param K, options  as above
///
/// \throws what the overload above does, and std::invalid_argument that names the first row in
///         which a matrix is not symmetric, or B has no positive sum
CGAL_SPECTRAL_GEOMETRY_INLINE Eigenpairs eigenpairs(const Eigen::SparseMatrix<double>& L,
                                                    const Eigen::SparseMatrix<double>& B,
                                                    Eigen::Index K,
                                                    const Eigenpairs_options& options = {});

/// @}

namespace internal {

class Eigen_problem;

/// The first K pairs of one part of a mesh.
CGAL_SPECTRAL_GEOMETRY_INLINE Eigenpairs pairs_of_part(const Eigen_problem& problem,
                                                       const Eigen::Index K,
                                                       const Eigenpairs_options& options);

} // namespace internal
} // namespace CGAL::Spectral_geometry

#ifndef CGAL_SPECTRAL_GEOMETRY_COMPILED
#include <CGAL/Spectral_geometry/internal/numerics/eigenpairs_impl.h>
#endif

#endif // CGAL_SPECTRAL_GEOMETRY_EIGENPAIRS_H
