// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_BASIS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_BASIS_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_signals.h>

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/filtered_signals.h>

#include <Eigen/Core>

#include <cstdint>
#include <memory>

namespace CGAL::Surface_mesh_simplification::internal {

/// What the metric preserves, for the input scaled to unit area: F and Z = B^-1 L F. Columns carry
/// the square root of their weight. Where there are more than
/// `Spectral_options::number_of_mixtures` of them, these are F R and Z R instead.
struct Spectral_basis
{
  Spectral_signals signals;
  Eigen::Index number_of_vertices = 0; ///< n, of the input
  double area = 1;                     ///< of the input, weighted by the density
  /// || Z ||_B^2 of all signals; the sum of lambda_k^2 for eigenvectors; exactly 0 where it is the
  /// rounding of 0
  double sum_of_squares = 0;
  bool rough =
      false; ///< whether Z = F Lambda is not good enough: signals of the user's, or rough pairs
  /// with `Spectral_signal_source::filtered_noise`, at the input's scale; those that the metric
  /// sees are the first
  std::shared_ptr<const Spectral_geometry::Filtered_signals> filtered;
  std::shared_ptr<const Spectral_geometry::Eigenpairs>
      eigenpairs; ///< all of them, at the input's scale
};

CGAL_SPECTRAL_GEOMETRY_INLINE void check_spectral_options(const Spectral_options& options,
                                                          const Eigen::Index n);

/// Whether signals are made of noise.
inline bool is_filtered(const Spectral_options& options)
{
  return options.source == Spectral_signal_source::filtered_noise && options.signals.size() == 0 &&
         !options.eigenpairs;
}

/// The operator that the metric takes rows of.
CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_geometry::Local_operator
local_operator(const Spectral_options& options);

/// The matrices of it, or those of `Spectral_options::operator_of_eigenpairs`.
CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_geometry::Laplace_operator
operator_of_basis(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                  const Spectral_options& options);

CGAL_SPECTRAL_GEOMETRY_INLINE void check_extent(const Eigen::MatrixXd& V);

CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::VectorXd spectral_weights(const Spectral_options& options,
                                                               const Eigen::Index K);

/// Z = B^-1 L F. The consistent mass scaled by its diagonal has eigenvalues in [1/2, 2], so
/// conjugate gradients converge in a number of steps that does not depend on the mesh.
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::MatrixXd
spectral_z(const Spectral_geometry::Laplace_operator& op, const Eigen::MatrixXd& F);

/// Z = F Lambda needs converged pairs: E of the fine mesh must be 0 beside what collapses add. Here
/// it is at most 1e-10 of sum lambda_k^2, a millionth of what a thousand collapses cost. Rougher
/// pairs get a Z = B^-1 L F of its own.
inline bool pairs_are_rough(const Eigen::VectorXd& residuals)
{
  return residuals.size() != 0 && residuals.maxCoeff() > 1e-5;
}

/*!
 * R, for r random mixtures F R of the columns of F: `rows` x r. Its columns are orthogonal and of
 * random direction (uniform, by Haar's measure), of length sqrt(rows / r), so that the expectation
 * of R R^T is the identity. Then \f$ \|A F R\|^2 \f$ has, for any A, the expectation \f$ \|A F\|^2
 * = tr G \f$, G = (A F)^T A F, and with n rows the variance
 * \f[ \frac{2 (n - r)}{r (n - 1) (n + 2)} \left( n \, tr G^2 - (tr G)^2 \right) \le \frac{2}{r} tr
 * G^2 . \f]
 * Independent normal entries (W. B. Johnson and J. Lindenstrauss 1984; M. F. Hutchinson
 * 1990) reach the bound on the right. The same `seed` gives the same mixtures everywhere.
 */
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::MatrixXd
random_mixtures(const Eigen::Index rows, const Eigen::Index r, const std::uint64_t seed);

/// The mixtures of the signals of positive weight, each multiplied by the square root of that; all
/// of these signals where there are no more than `Spectral_options::number_of_mixtures`. R has a
/// row for every signal.
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::MatrixXd mixing_matrix(const Spectral_options& options,
                                                            const Eigen::VectorXd& weights);

/// mesh -> Laplacian -> eigenpairs -> F and Z.
CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_basis spectral_basis(const Eigen::MatrixXd& V,
                                                            const Eigen::MatrixXi& T,
                                                            const Spectral_options& options);

} // namespace CGAL::Surface_mesh_simplification::internal

#ifndef CGAL_SPECTRAL_GEOMETRY_COMPILED
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis_impl.h>
#endif

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_BASIS_H
