// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_FILTERED_SIGNALS_H
#define CGAL_SPECTRAL_GEOMETRY_FILTERED_SIGNALS_H

#include <CGAL/Spectral_geometry/Cancelled.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/separate_compilation.h>

#include <Eigen/Core>

#include <cstdint>
#include <functional>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief how `filtered_signals()` computes.
struct Filtered_signals_options
{
  Eigen::Index signals = 16; ///< r, at least 1; computed eight at a time
  std::uint64_t seed = 1;    ///< of the noise
  /// m, solves with the factor for eight signals, from 3 to 32; the more, the sharper the filter
  int solves = 5;
  int threads = 1; ///< at least 1; the result does not depend on it
  /// is called with the fraction done, in [0, 1]; returns false to cancel
  std::function<bool(double)> progress;
};

/// \brief random functions on a mesh in which eigenvectors have the weights \f$f(\lambda_k)\f$.
struct Filtered_signals
{
  Eigen::MatrixXd F; ///< n x r, \f$F = r^{-1/2} \sum_k f(\lambda_k) \phi_k \xi_k^T\f$
  Eigen::MatrixXd Z; ///< n x r, \f$Z = B^{-1} L F\f$
  double cutoff = 0; ///< \f$\lambda_K\f$, above which f falls off, in the unit of eigenvalues
  /// number of eigenvalues below `cutoff`: K to 5 %, unless eigenvalues coincide there
  Eigen::Index below = 0;
  double shift = 0;             ///< s
  Eigen::VectorXd coefficients; ///< \f$a_0 \dots a_{m-2}\f$

  /// \f$f(\lambda)\f$
  CGAL_SPECTRAL_GEOMETRY_INLINE double response(double lambda) const;
};

/// \brief returns random functions without high frequencies: mixtures of about the first K
/// eigenvectors, without computing these.
///
/// White noise w has \f$\mathrm{E}[w w^T] = B^{-1}\f$, so that its coefficients
/// \f$\xi_k = \phi_k^T B w\f$ are uncorrelated and have the variance 1. A filter multiplies them by
/// \f$f(\lambda_k)\f$, a polynomial in \f$x = s / (\lambda + s)\f$, which are the eigenvalues of
/// \f$X = s (L + s B)^{-1} B\f$:
/// \f[ f(\lambda) = x^2 q(x), \qquad q(x) = \sum_{j=0}^{m-2} a_j T_j(2x - 1) \f]
/// with Chebyshev polynomials \f$T_j\f$. One factorisation of \f$L + s B\f$ and m solves with it,
/// in the recurrence of \f$T_j\f$, give \f$Y = X q(X) w\f$ and \f$F = X Y\f$. From
/// \f$\lambda x = s (1 - x)\f$ follows \f$Z = B^{-1} L F = s (Y - F)\f$ without a solve.
///
/// The filter takes the noise as B w, whose covariance is B. From
/// \f[ B = \sum_{i<j} B_{ij} (e_i + e_j)(e_i + e_j)^T
///       + \sum_i \Bigl(B_{ii} - \sum_{j \ne i} B_{ij}\Bigr) e_i e_i^T \f]
/// follows that it is the sum of these vectors, each times the root of its factor and a random
/// sign.
///
/// The coefficients minimise the squared distance of f to 1 below \f$\lambda_K\f$ and to 0 above,
/// there with the weight \f$(\lambda/\lambda_K)^4\f$, as the metric E charges a mode. Eigenvalues
/// count as evenly spread (Weyl's law). The cut-off \f$\lambda_K\f$ is where \f$L - \lambda_K
/// B\f$ has K negative eigenvalues, to 5 %, which the signs of pivots tell (Sylvester's law of
/// inertia): borders, components and coefficients change Weyl's constant. Where K is not larger
/// than the number of components the cut-off is that of one eigenvalue more than these. Constants
/// pass the filter; their part of Z is 0.
///
/// E is a sum of squares \f$\|A F\|^2\f$ with a linear A. Its expectation is that with
/// eigenvectors of the weights f, its relative variance 2/r at most (Hutchinson 1989; Tremblay et
/// al. 2016 sample graphs in this way). The first columns depend on `signals` by the factor
/// \f$r^{-1/2}\f$ alone.
///
/// \param op       the operator; rows of B are diagonally dominant, as with linear elements.
///                 With the Dirichlet condition F is 0 at the vertices of the border.
/// \param K        1 <= K <= n; with the Dirichlet condition at most the number of other vertices
/// \param options  signals, seed, sharpness, threads, progress
///
/// \throws std::invalid_argument when K or an option is out of range, or where a row of B is not
///         dominant, which is named;
///         std::runtime_error when the factorisation fails;
///         Cancelled when the progress callback returned false
CGAL_SPECTRAL_GEOMETRY_INLINE Filtered_signals filtered_signals(
    const Laplace_operator& op, Eigen::Index K, const Filtered_signals_options& options = {});

/// @}

} // namespace CGAL::Spectral_geometry

#ifndef CGAL_SPECTRAL_GEOMETRY_COMPILED
#include <CGAL/Spectral_geometry/internal/numerics/filtered_signals_impl.h>
#endif

#endif // CGAL_SPECTRAL_GEOMETRY_FILTERED_SIGNALS_H
