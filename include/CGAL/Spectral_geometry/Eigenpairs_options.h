// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_EIGENPAIRS_OPTIONS_H
#define CGAL_SPECTRAL_GEOMETRY_EIGENPAIRS_OPTIONS_H

#include <CGAL/Spectral_geometry/Run_control.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief the first K eigenpairs of \f$L \phi = \lambda B \phi\f$.
struct Eigenpairs
{
  /// K, ascending, not negative (zeros that rounding makes negative are set to 0)
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors; ///< n x K, column k belongs to values(k), \f$\Phi^T B \Phi = I\f$
  /// K, \f$\|L \phi_k - \lambda_k B \phi_k\|_{M^{-1}} / (\lambda_k + s)\f$, see `eigenpairs()`
  Eigen::VectorXd residuals;
  std::string solver; ///< "block" or "dense"
  /// true when no eigenvalue below values(K-1) can be missing, see `Eigenpairs_options::verify`,
  /// and no residual is larger than ten times the tolerance
  bool complete = false;
  /// number of zero eigenvalues of the operator, one for each connected component of a mesh: the
  /// first min(`zeros`, K) of the values. Set it if you fill pairs by hand, see
  /// `number_of_zero_eigenvalues()`; negative: not known
  Eigen::Index zeros = -1;
  /// the next eigenvalues after the K-th, to a thousandth: as many, up to K / 2, as the solver
  /// knows at no further cost (about 0.4 K for `block`). They are not counted: a copy of a multiple
  /// eigenvalue may be missing
  Eigen::VectorXd further_values{};

  Eigen::Index size() const { return values.size(); } ///< K
  /// `values`, then `further_values`
  Eigen::VectorXd all_values() const
  {
    Eigen::VectorXd result(values.size() + further_values.size());
    result << values, further_values;
    return result;
  }
};

/// \brief how eigenpairs are computed.
///
/// `automatic` is `dense` when n is at most 300, otherwise `block`: block Lanczos, eight vectors at
/// a time. A problem of fewer than 2 K + 20 or K + 56 vertices is too small for `block` and solved
/// densely. More than 500 pairs of more than 1,500 vertices, up to n - 56, are found in slices of
/// the spectrum unless `maximum_vectors` is set or the tolerance is above 1e-3.
enum class Eigenpairs_method { automatic, block, dense };

/// \brief how `eigenpairs()` computes. The defaults are for tight pairs.
struct Eigenpairs_options : Run_control
{
  Eigenpairs_method method = Eigenpairs_method::automatic; ///< see there
  /// of the residuals, \f$\|L \phi - \lambda B \phi\|_{M^{-1}} \le\f$ tolerance \f$(\lambda + s)\f$
  /// with \f$s = 4\pi/\f$area, in ]0, 1[; rounding may make them up to ten times larger. Pairs of
  /// larger residuals are refined or solved densely, or `eigenpairs()` throws; if doubles cannot
  /// come closer, they are returned with `complete` false. Relative errors of the eigenvalues are
  /// about the square of the tolerance.
  double tolerance = 1e-10;
  /// restarts of the Krylov space, at least 1
  Eigen::Index maximum_iterations = 300;
  /// search for copies of multiple eigenvalues that the Krylov space has missed: one more
  /// factorisation counts the eigenvalues (Sylvester's law of inertia). `block` starts from eight
  /// random vectors, which cannot miss a copy of an eigenvalue of smaller multiplicity; it counts
  /// only if more than four values are equal within the tolerance. With a tolerance above 1e-3 the
  /// values are too rough for a count, and the pairs are not known to be complete.
  bool verify = true;
  /// vectors of the Krylov space of `block` before a restart, at least K + 32, or 0 for max(3.6 K,
  /// K + 120): fewer take less memory and more time
  Eigen::Index maximum_vectors = 0;

  /// the defaults with another tolerance
  static Eigenpairs_options with_tolerance(double tolerance)
  {
    Eigenpairs_options options;
    options.tolerance = tolerance;
    return options;
  }
};

/// @}

namespace internal {

inline void check_eigenpairs_options(const Eigenpairs_options& options, const Eigen::Index K)
{
  require(options.tolerance > 0. && options.tolerance < 1.,
          "Eigenpairs: the tolerance must lie between 0 and 1.");
  require(options.maximum_iterations >= 1,
          "Eigenpairs: the number of iterations must be positive.");
  require(options.threads >= 1, "Eigenpairs: the number of threads must be positive.");
  require(options.maximum_vectors == 0 || options.maximum_vectors >= K + 32,
          "Eigenpairs: maximum_vectors must be 0 or at least K + 32 = ", K + 32, ", but is ",
          options.maximum_vectors, ".");
}

// Most vertices that are solved densely after an iteration has failed: some seconds.
constexpr Eigen::Index largest_dense = 2000;

// Whether K pairs of n vertices are computed densely, see `Eigenpairs_method`. The Krylov space
// must fit into n dimensions, with the vectors that a restart keeps, two panels more, and room for
// random ones. Up to 300 vertices a dense solver takes milliseconds.
inline bool is_dense(const Eigen::Index n, const Eigen::Index K, const Eigenpairs_method method)
{
  return method == Eigenpairs_method::dense || 2 * K + 20 > n || K + 56 > n ||
         (method == Eigenpairs_method::automatic && n <= 300);
}

// Whether block Lanczos takes a slice of the spectrum at a time. Below, one space of all pairs is
// as fast (1.1 times at 600 pairs of 50,000 vertices, half as fast at 400 of 3,600).
inline bool is_sliced(const Eigen::Index n, const Eigen::Index K, const Eigenpairs_options& options)
{
  return options.method != Eigenpairs_method::dense && K > 500 && n > 1500 && K + 56 <= n &&
         options.maximum_vectors == 0 &&
         options.tolerance <= 1e-3; // rough values cannot be counted
}

} // namespace internal

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_EIGENPAIRS_OPTIONS_H
