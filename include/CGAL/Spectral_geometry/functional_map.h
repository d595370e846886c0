// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_FUNCTIONAL_MAP_H
#define CGAL_SPECTRAL_GEOMETRY_FUNCTIONAL_MAP_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>

#include <CGAL/number_type_config.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationEvaluation
/// @{

/*!
returns the functional map \f$ C = \widetilde\Phi^\top \widetilde B P \Phi \f$ of a restriction `P`
in two truncated eigenbases (section 4.1 of Lescoat et al. 2020; Ovsjanikov et al. 2012): a function
\f$ \Phi x \f$ on the fine mesh has the coarse coefficients `C x`.

Nothing is rescaled: see `unit_area_functional_map()`.

@param coarse_vectors \f$ \widetilde\Phi \f$, coarse x (number of coarse modes), orthonormal in
`coarse_B`
@param coarse_B the mass matrix \f$ \widetilde B \f$ of the coarse mesh, in the unit of area of its
operator
@param P the restriction, coarse x fine
@param fine_vectors \f$ \Phi \f$, fine x (number of fine modes), orthonormal in the mass of the fine
mesh
@return (number of coarse modes) x (number of fine modes)

Throws `std::invalid_argument` if the sizes do not match.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::MatrixXd
functional_map(const Eigen::Ref<const Eigen::MatrixXd>& coarse_vectors,
               const Eigen::SparseMatrix<double>& coarse_B, const Eigen::SparseMatrix<double>& P,
               const Eigen::Ref<const Eigen::MatrixXd>& fine_vectors);

/*!
returns the functional map of the two meshes each scaled to unit area, from that at input scale,
without a second solve.

Scaling a mesh by \f$ 1/\sqrt{A} \f$ divides `B` by the area `A` and leaves `L` as it is, so that
\f$ \lambda' = A \lambda \f$ and, orthonormal in \f$ B/A \f$, \f$ \Phi' = \sqrt{A} \Phi \f$. Hence
\f[ C' = (\sqrt{\widetilde A} \widetilde\Phi)^\top (\widetilde B / \widetilde A) P (\sqrt{A} \Phi)
       = \sqrt{A / \widetilde A} \; C. \f]

@param C functional map at input scale
@param fine_area, coarse_area `A` and \f$ \widetilde A \f$, positive, the sums of the masses
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::MatrixXd
unit_area_functional_map(const Eigen::MatrixXd& C, double fine_area, double coarse_area);

/*!
returns the Laplacian commutativity \f$ \|C\|_L = \|C \Lambda - \widetilde\Lambda C\| / \|C\| \f$,
the root of Eq. (3) of Lescoat et al. 2020, **not squared**. Frobenius norms.

It has the unit of the eigenvalues, the inverse of an area. The published figures are for meshes
scaled to unit area.

@param C (number of coarse modes) x (number of fine modes), not zero
@param fine_values \f$ \Lambda \f$, one per column of `C`
@param coarse_values \f$ \widetilde\Lambda \f$, one per row of `C`, at the scale of the coarse mesh

Throws `std::invalid_argument` if the sizes do not match or `C` is zero.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE double
laplacian_commutativity_norm(const Eigen::MatrixXd& C, const Eigen::VectorXd& fine_values,
                             const Eigen::VectorXd& coarse_values);

/*!
returns the orthonormality \f$ \|C\|_D = \|C^\top C - Id\| \f$, the root of Eq. (4) of Lescoat et
al. 2020, **not squared**. Frobenius norm; no unit.

With more rows (coarse modes) than columns a fine eigenvector may also land on coarse modes beyond
the number of columns without counting as lost.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE double orthonormality_norm(const Eigen::MatrixXd& C);

/*!
returns the *span loss*, how much of the first `K` fine eigenvectors lies outside of the span of the
coarse ones that `Q` carries back to the fine mesh:
\f[ \frac{1}{K} \min_X \| \Phi - Q \widetilde\Phi X \|_B^2
     = 1 - \frac{1}{K} \mathrm{tr}(H^\top G^+ H), \quad
     G = \widetilde\Phi^\top Q^\top B Q \widetilde\Phi, \quad
     H = \widetilde\Phi^\top Q^\top B \Phi, \f]
a number between 0 (nothing is lost) and 1. It has no unit, and does not change if eigenvectors of
one eigenvalue are rotated. Directions that \f$ Q \widetilde\Phi \f$ lacks count as lost.

@param fine_vectors \f$ \Phi \f$, fine x `K`, `K` at least 1, orthonormal in `fine_B`
@param fine_B the mass matrix `B` of the fine mesh
@param Q the prolongation, fine x coarse, see `closest_point_prolongation()`
@param coarse_vectors \f$ \widetilde\Phi \f$, coarse x any, in any scale

Throws `std::invalid_argument` if `K` is 0 or the sizes do not match.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE double
span_loss(const Eigen::Ref<const Eigen::MatrixXd>& fine_vectors,
          const Eigen::SparseMatrix<double>& fine_B, const Eigen::SparseMatrix<double>& Q,
          const Eigen::Ref<const Eigen::MatrixXd>& coarse_vectors);

/*!
returns an estimate of \f$ \|C\|_L \f$ at unit area for the best that linear elements on `N`
vertices can do when the coarse mesh only samples the fine one: equilateral triangles, `C = Id`,
eigenvalues at \f$ 4 \pi k \f$ (Weyl's law).

A plane wave on the equilateral lattice of edge length `h` has, with \f$ x = \lambda h^2 \f$, the
discrete eigenvalue
\f[ \widetilde\lambda = \lambda \left(1 - \frac{1 - 2 \theta}{16} x
      + \left(\frac{1}{576} - \frac{\theta - \theta^2}{64}\right) x^2 + O(x^3)\right),
    \qquad h^2 = \frac{2}{\sqrt 3 N} \f]
(second order averaged over directions). The root mean square of \f$ \widetilde\lambda - \lambda \f$
over `K` modes is 5.1 K^2/N for the lumped mass (theta = 0); the averaged mass (theta = 1/2) cancels
it and leaves 2.2 K^3/N^2. The two terms are combined by their squares.

This is an estimate to compare with, not a bound: irregular meshes stay above it; a mesh that
distorts the surface on purpose, or a sphere, can fall below. A subdivided icosphere of 642 vertices
out of 10,242 at K = 100 has 71 (estimate: 79) lumped and 8.1 (estimate: 5.3) averaged.

@param theta weight of the consistent mass, 0 lumped, 1/2 averaged
@param K number of modes, at least 1
@param N number of coarse vertices, at least 1
*/
CGAL_SPECTRAL_GEOMETRY_INLINE double commutativity_floor(double theta, Eigen::Index K,
                                                         Eigen::Index N);

/*!
returns an estimate of \f$ \|C\|_D \f$ for the best that linear elements on `N` vertices can do when
the coarse mesh only samples the fine one: \f$ (\pi/3) \theta K^{3/2} / N \f$, that is 0.52 K^1.5/N
for the averaged mass.

On the lattice of `commutativity_floor()` a sampled plane wave of unit norm has the discrete norm
\f$ 1 - \theta x / 8 \f$ (squared). For the lumped mass the leading term vanishes and 0 is returned;
on surfaces what is left is small. A subdivided icosphere, 642 vertices out of 10,242, K = 100, has
0.13; with the averaged mass it has 0.70, and the estimate is 0.82.

Parameters as for `commutativity_floor()`.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE double orthonormality_floor(double theta, Eigen::Index K,
                                                          Eigen::Index N);

/*!
returns the metric \f$ E = \sum_w \| (\widetilde B P Z)_w - (\widetilde L P F)_w \|^2 / \widetilde
M_w \f$ of a restriction, Eq. (2) of Lescoat et al. 2020 at theta = 0, computed from scratch.

For the signals \f$ F = \Phi, Z = \Phi \Lambda \f$ and the lumped mass
\f[ E = \|C\|^2 \|C\|_L^2 + \sum_{i > K} \sum_j (\lambda_j - \widetilde\lambda_i)^2 C_{ij}^2 \f]
at the scale of the input, where `i > K` are the coarse modes outside of the truncated map:
\f$ \|C\|_L \le \sqrt{E}/\|C\| \f$. For other masses the same holds with \f$ \widetilde B^{-1} \f$
in place of \f$ \widetilde M^{-1} \f$. The consistent mass of a triangle is between a quarter of the
lumped one and the lumped one, so that \f$ \widetilde B \ge (1 - 3\theta/4) \widetilde M \f$ and \f$
\|C\|_L \le \sqrt{E / (1 - 3\theta/4)}/\|C\| \f$.

@param coarse operator of the coarse mesh
@param P restriction, coarse x fine
@param F signals, fine x K, one per column
@param Z \f$ B^{-1} L F \f$, fine x K
*/
CGAL_SPECTRAL_GEOMETRY_INLINE double restriction_energy(const Laplace_operator& coarse,
                                                        const Eigen::SparseMatrix<double>& P,
                                                        const Eigen::Ref<const Eigen::MatrixXd>& F,
                                                        const Eigen::Ref<const Eigen::MatrixXd>& Z);

namespace internal {

/// The energy of signals that have been restricted, PF = P F and PZ = P Z.
CGAL_SPECTRAL_GEOMETRY_INLINE double residual_energy(const Laplace_operator& coarse,
                                                     const Eigen::MatrixXd& PF,
                                                     const Eigen::MatrixXd& PZ);

} // namespace internal

/// relative errors \f$ |\widetilde\lambda_k - \lambda_k| / \lambda_k \f$ of a range of eigenvalues.
struct Eigenvalue_errors
{
  Eigen::Index modes = 0; ///< number of modes compared; when it is 0, `mean` and `max` are NaN
  double mean = std::numeric_limits<double>::quiet_NaN(); ///< mean over the modes compared
  double max = std::numeric_limits<double>::quiet_NaN();  ///< largest of the modes compared
};

/*!
returns the relative errors of the modes `first`, ..., `last - 1` (counted from 0) of `coarse`
against `fine`. Modes that either spectrum lacks, and the first `zeros` modes, are left out.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Eigenvalue_errors eigenvalue_errors(const Eigen::VectorXd& fine,
                                                                  const Eigen::VectorXd& coarse,
                                                                  Eigen::Index first,
                                                                  Eigen::Index last,
                                                                  Eigen::Index zeros);

/*!
How well a coarse mesh and a restriction keep the first `K` eigenpairs of a fine mesh, see
`evaluate_spectrum()`.

Unless a name says *input scale*, figures are for both meshes scaled to unit area each, as in
section 4 of Lescoat et al. 2020, and depend neither on the unit of length nor on a shrinking of the
coarse mesh. Norms are not squared.
*/
struct Spectral_evaluation
{
  Eigen::Index requested_modes = 0; ///< the `K` that was asked for
  /// the `K` of all figures: `requested_modes`, or the number of coarse vertices if that is smaller
  Eigen::Index judged_modes = 0;
  /// number of coarse modes of `norm_D_extended`, 1.1 `K` or as many as were given
  Eigen::Index extended_modes = 0;

  double theta = 0; ///< blend of the coarse mass; figures of different theta are not comparable
  /// "lumped", "averaged", "voronoi", "consistent", or "theta = ..." of the coarse mesh; both if
  /// they differ
  std::string mass;

  Eigen::MatrixXd C; ///< functional map, `judged_modes` x `judged_modes`, rows are coarse modes
  /// all fine eigenvalues that were given, at unit area: \f$ A \lambda \f$
  Eigen::VectorXd fine_values;
  Eigen::VectorXd coarse_values; ///< all coarse eigenvalues that were given, at unit area
  Eigen::Index fine_zeros = 0;   ///< number of fine eigenvalues that are zero, one per component
  /// number of coarse ones; if they differ, the modes compared are shifted
  Eigen::Index coarse_zeros = 0;

  double norm_L = 0; ///< Eq. (3), not squared
  double norm_D = 0; ///< Eq. (4), not squared
  /// Eq. (4) of the map with `extended_modes` rows. If it is much smaller than `norm_D`, modes were
  /// not lost: they went into the next ones, because eigenvalues `K` and `K + 1` are close
  double norm_D_extended = 0;
  /// Eq. (3) of the meshes as they are, in the inverse of their unit of area
  double norm_L_input_scale = 0;
  /// `norm_L_input_scale` times the fine area: both meshes scaled by one factor, to set beside
  /// `norm_L`
  double norm_L_common_scale = 0;
  double norm_D_input_scale = 0; ///< Eq. (4) of the meshes as they are
  double floor_norm_L = 0;       ///< `commutativity_floor()`; 0 where there is no estimate
  double floor_norm_D = 0;       ///< `orthonormality_floor()`; the same

  /// `span_loss()` of `judged_modes` of either mesh; NaN where no prolongation was given
  double span_loss = std::numeric_limits<double>::quiet_NaN();

  Eigenvalue_errors errors;     ///< of modes 1..K, zeros skipped
  Eigenvalue_errors errors_low; ///< of modes 2..K/5: limbs that lost their tips show here
  /// of modes K+1..1.5K, as far as both spectra were given: overfitting
  Eigenvalue_errors errors_beyond;
  Eigenvalue_errors errors_input_scale; ///< of modes 1..K of the meshes as they are

  double fine_area = 0;   ///< sum of the fine masses
  double coarse_area = 0; ///< sum of the coarse masses
  double area_ratio = 0;  ///< coarse over fine
};

/*!
judges a simplification: compares the first `K` eigenpairs of the fine mesh, restricted by `P`, with
those of the coarse mesh.

One eigensolve per mesh serves every scale, see `unit_area_functional_map()`. What the figures mean:
\f$ \|C\|_L \f$ and \f$ \|C\|_D \f$ vanish together if and only if the eigenpairs are kept exactly
(theorem 1 of Lescoat et al. 2020). They depend on the mass: compare within one theta. They also
depend on `P`: if a simplifier made its own, judge it with that of `closest_point_restriction()` as
well.

@param fine, fine_pairs operator of the fine mesh and at least `K` of its eigenpairs, 1.5 `K` to
judge the modes beyond. Their tolerance must be tight: residuals count as errors of the
simplification
@param coarse, coarse_pairs the same for the coarse mesh. If it has fewer than `K` vertices, as many
eigenpairs are enough, and that many modes are judged. 1.1 `K` and 1.5 `K` pairs fill
`norm_D_extended` and `errors_beyond`
@param P restriction, coarse x fine, rows that sum to 1
@param K number of modes to judge, at least 1
@param Q prolongation, fine x coarse, for `Spectral_evaluation::span_loss`; empty if there is none

Throws `std::invalid_argument` if there are fewer pairs or if sizes do not match.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_evaluation evaluate_spectrum(
    const Laplace_operator& fine, const Eigenpairs& fine_pairs, const Laplace_operator& coarse,
    const Eigenpairs& coarse_pairs, const Eigen::SparseMatrix<double>& P, Eigen::Index K,
    const Eigen::SparseMatrix<double>& Q = {});

/*!
carries functions from the coarse mesh back to the fine one through the spectrum,
\f$ f = \Phi C^\top \widetilde\Phi^\top \widetilde B g \f$ with all matrices at unit area.

It inverts the restriction on the span of the first eigenvectors as far as `C` is orthonormal; what
`g` has outside of the span of \f$ \widetilde\Phi \f$ is lost. In matrices at input scale and the
map \f$ C \f$ at unit area it reads \f$ \sqrt{A/\widetilde A} \; \Phi C^\top \widetilde\Phi^\top
\widetilde B g \f$. Unit area matters: the mean of a constant is then kept exactly on a connected
surface, while \f$ C^\top \f$ at input scale would multiply it by \f$ \widetilde A / A \f$.

@param fine, fine_pairs operator and eigenpairs of the fine mesh, at least as many as `C` has
columns
@param coarse, coarse_pairs the same for the coarse mesh, at least as many as `C` has rows
@param C functional map at unit area, `Spectral_evaluation::C`
@param g one function per column, coarse x any
@return fine x any
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::MatrixXd
prolong_through_spectrum(const Laplace_operator& fine, const Eigenpairs& fine_pairs,
                         const Laplace_operator& coarse, const Eigenpairs& coarse_pairs,
                         const Eigen::MatrixXd& C, const Eigen::MatrixXd& g);

/// @}

} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_GEOMETRY_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_GEOMETRY)

#include <Eigen/QR>

namespace CGAL::Spectral_geometry {

namespace internal {

inline std::string name_of_mass(const Laplace_operator& op)
{
  if(op.voronoi)
    return mass_name(Mass::voronoi);
  for(const Mass mass : {Mass::lumped, Mass::averaged, Mass::consistent})
    if(op.theta == mass_blend(mass))
      return mass_name(mass);
  return sentence("theta = ", op.theta);
}

inline void check_pairs(const char* which, const Laplace_operator& op, const Eigenpairs& pairs,
                        Eigen::Index wanted)
{
  require(pairs.vectors.rows() == op.B.rows() && pairs.vectors.cols() == pairs.values.size() &&
              op.mass.size() == op.B.rows(),
          "spectral evaluation: the ", which, " eigenvectors are ", size_name(pairs.vectors),
          " for ", op.B.rows(), " vertices and ", pairs.values.size(),
          " eigenvalues, pass the operator and the eigenpairs of one mesh.");
  require(pairs.size() >= wanted, "spectral evaluation: the ", which, " mesh has ", pairs.size(),
          " eigenpairs, compute at least ", wanted, " of them.");
  require(op.mass.sum() > 0, "spectral evaluation: the ", which,
          " mesh has no area, check its masses.");
}

} // namespace internal

Eigen::MatrixXd functional_map(const Eigen::Ref<const Eigen::MatrixXd>& coarse_vectors,
                               const Eigen::SparseMatrix<double>& coarse_B,
                               const Eigen::SparseMatrix<double>& P,
                               const Eigen::Ref<const Eigen::MatrixXd>& fine_vectors)
{
  internal::check_dimension("the number of columns of P", P.cols(), fine_vectors.rows());
  internal::check_dimension("the number of rows of P", P.rows(), coarse_vectors.rows());
  internal::check_dimension("the size of the coarse mass", coarse_B.cols(), P.rows());
  internal::check_dimension("the number of rows of the coarse mass", coarse_B.rows(), P.rows());
  const Eigen::MatrixXd restricted = P * fine_vectors;
  const Eigen::MatrixXd weighted = coarse_B * restricted;
  return coarse_vectors.transpose() * weighted;
}

Eigen::MatrixXd unit_area_functional_map(const Eigen::MatrixXd& C, double fine_area,
                                         double coarse_area)
{
  internal::require(fine_area > 0 && coarse_area > 0,
                    "functional map: an area is not positive, pass the sums of the masses.");
  return std::sqrt(fine_area / coarse_area) * C;
}

double laplacian_commutativity_norm(const Eigen::MatrixXd& C, const Eigen::VectorXd& fine_values,
                                    const Eigen::VectorXd& coarse_values)
{
  internal::check_dimension("the number of fine eigenvalues", fine_values.size(), C.cols());
  internal::check_dimension("the number of coarse eigenvalues", coarse_values.size(), C.rows());
  const double norm = C.norm();
  internal::require(
      norm > 0 && std::isfinite(norm),
      "functional map: C is zero or not finite, its commutativity is undefined; check P, and take "
      "more eigenvectors than the mesh has components.");
  return (C * fine_values.asDiagonal() - coarse_values.asDiagonal() * C).norm() / norm;
}

double orthonormality_norm(const Eigen::MatrixXd& C)
{
  return (C.transpose() * C - Eigen::MatrixXd::Identity(C.cols(), C.cols())).norm();
}

double span_loss(const Eigen::Ref<const Eigen::MatrixXd>& fine_vectors,
                 const Eigen::SparseMatrix<double>& fine_B, const Eigen::SparseMatrix<double>& Q,
                 const Eigen::Ref<const Eigen::MatrixXd>& coarse_vectors)
{
  internal::check_dimension("the number of rows of Q", Q.rows(), fine_vectors.rows());
  internal::check_dimension("the number of columns of Q", Q.cols(), coarse_vectors.rows());
  internal::check_dimension("the size of the fine mass", fine_B.cols(), Q.rows());
  internal::check_dimension("the number of rows of the fine mass", fine_B.rows(), Q.rows());
  internal::require(fine_vectors.cols() != 0, "span loss: there is no fine vector, pass one.");
  if(coarse_vectors.cols() == 0)
    return 1;
  // Nothing here is fine x K: Q^T B has a few entries for each fine vertex.
  const Eigen::SparseMatrix<double> QtB = Eigen::SparseMatrix<double>(Q.transpose()) * fine_B,
                                    QtBQ = QtB * Q;
  const Eigen::MatrixXd H = coarse_vectors.transpose() * (QtB * fine_vectors),
                        G = coarse_vectors.transpose() * (QtBQ * coarse_vectors);
  const Eigen::MatrixXd X = G.completeOrthogonalDecomposition().solve(H); // G^+ H
  const double kept = X.cwiseProduct(H).sum() / double(fine_vectors.cols());
  return (std::min)((std::max)(1 - kept, 0.), 1.);
}

double commutativity_floor(double theta, Eigen::Index K, Eigen::Index N)
{
  const double k = static_cast<double>(K), n = static_cast<double>(N);
  const double wave = 4 * CGAL_PI, h2 = 2 / (std::sqrt(3.) * n);
  const double first = std::abs(1 - 2 * theta) / 16 * wave * wave * h2 * k * k / std::sqrt(5.);
  const double second = std::abs(1. / 576 - (theta - theta * theta) / 64) * wave * wave * wave *
                        h2 * h2 * k * k * k / std::sqrt(7.);
  return std::hypot(first, second);
}

double orthonormality_floor(double theta, Eigen::Index K, Eigen::Index N)
{
  const double k = static_cast<double>(K);
  return CGAL_PI / 3 * theta * k * std::sqrt(k) / static_cast<double>(N);
}

double internal::residual_energy(const Laplace_operator& coarse, const Eigen::MatrixXd& PF,
                                 const Eigen::MatrixXd& PZ)
{
  const Eigen::MatrixXd difference = coarse.B * PZ - coarse.L * PF;
  return (difference.rowwise().squaredNorm().array() / coarse.mass.array()).sum();
}

double restriction_energy(const Laplace_operator& coarse, const Eigen::SparseMatrix<double>& P,
                          const Eigen::Ref<const Eigen::MatrixXd>& F,
                          const Eigen::Ref<const Eigen::MatrixXd>& Z)
{
  internal::check_dimension("the number of rows of P", P.rows(), coarse.L.rows());
  internal::check_dimension("the number of rows of F", F.rows(), P.cols());
  internal::check_dimension("the number of rows of Z", Z.rows(), P.cols());
  internal::check_dimension("the number of columns of Z", Z.cols(), F.cols());
  return internal::residual_energy(coarse, P * F, P * Z);
}

Eigenvalue_errors eigenvalue_errors(const Eigen::VectorXd& fine, const Eigen::VectorXd& coarse,
                                    Eigen::Index first, Eigen::Index last, Eigen::Index zeros)
{
  first = (std::max)(first, zeros);
  last = (std::min)({last, fine.size(), coarse.size()});
  Eigenvalue_errors errors;
  if(first >= last)
    return errors;
  errors.modes = last - first;
  const Eigen::ArrayXd relative =
      (coarse.segment(first, errors.modes).array() / fine.segment(first, errors.modes).array() - 1)
          .abs();
  errors.mean = relative.mean();
  errors.max = relative.maxCoeff();
  return errors;
}

Spectral_evaluation evaluate_spectrum(const Laplace_operator& fine, const Eigenpairs& fine_pairs,
                                      const Laplace_operator& coarse,
                                      const Eigenpairs& coarse_pairs,
                                      const Eigen::SparseMatrix<double>& P, Eigen::Index K,
                                      const Eigen::SparseMatrix<double>& Q)
{
  internal::require(K >= 1, "spectral evaluation: K is ", K, ", judge at least one mode.");
  const Eigen::Index N = coarse.B.rows() - coarse.vanishing, judged = (std::min)(K, N);
  internal::check_pairs("fine", fine, fine_pairs, judged);
  internal::check_pairs("coarse", coarse, coarse_pairs, judged);

  Spectral_evaluation e;
  e.requested_modes = K;
  e.judged_modes = judged;
  e.extended_modes = (std::min)(judged + (judged + 9) / 10, coarse_pairs.size());
  e.theta = coarse.theta;
  e.mass = internal::name_of_mass(coarse);
  if(const std::string of_fine = internal::name_of_mass(fine); of_fine != e.mass)
    e.mass += " (fine mesh: " + of_fine + ")";

  e.fine_area = fine.mass.sum();
  e.coarse_area = coarse.mass.sum();
  e.area_ratio = e.coarse_area / e.fine_area;
  e.fine_values = e.fine_area * fine_pairs.values;
  e.coarse_values = e.coarse_area * coarse_pairs.values;
  e.fine_zeros = (std::min)(number_of_zero_eigenvalues(fine), fine_pairs.size());
  e.coarse_zeros = (std::min)(number_of_zero_eigenvalues(coarse), coarse_pairs.size());

  const Eigen::MatrixXd C_extended =
      functional_map(coarse_pairs.vectors.leftCols(e.extended_modes), coarse.B, P,
                     fine_pairs.vectors.leftCols(judged));
  const Eigen::MatrixXd C = C_extended.topRows(judged);
  e.norm_L_input_scale = laplacian_commutativity_norm(C, fine_pairs.values.head(judged),
                                                      coarse_pairs.values.head(judged));
  e.norm_L_common_scale = e.fine_area * e.norm_L_input_scale;
  e.norm_D_input_scale = orthonormality_norm(C);
  e.C = unit_area_functional_map(C, e.fine_area, e.coarse_area);
  e.norm_L =
      laplacian_commutativity_norm(e.C, e.fine_values.head(judged), e.coarse_values.head(judged));
  e.norm_D = orthonormality_norm(e.C);
  e.norm_D_extended =
      orthonormality_norm(unit_area_functional_map(C_extended, e.fine_area, e.coarse_area));
  if(Q.size() != 0)
    e.span_loss = span_loss(fine_pairs.vectors.leftCols(judged), fine.B, Q,
                            coarse_pairs.vectors.leftCols(judged));
  if(!fine.has_coefficients && fine.boundary == Boundary_condition::neumann) {
    e.floor_norm_L = commutativity_floor(e.theta, judged, N);
    e.floor_norm_D = orthonormality_floor(e.theta, judged, N);
  }

  e.errors = eigenvalue_errors(e.fine_values, e.coarse_values, 0, judged, e.fine_zeros);
  e.errors_low = eigenvalue_errors(e.fine_values, e.coarse_values, 1, judged / 5, e.fine_zeros);
  e.errors_beyond =
      eigenvalue_errors(e.fine_values, e.coarse_values, judged, judged + judged / 2, e.fine_zeros);
  e.errors_input_scale =
      eigenvalue_errors(fine_pairs.values, coarse_pairs.values, 0, judged, e.fine_zeros);
  return e;
}

Eigen::MatrixXd prolong_through_spectrum(const Laplace_operator& fine, const Eigenpairs& fine_pairs,
                                         const Laplace_operator& coarse,
                                         const Eigenpairs& coarse_pairs, const Eigen::MatrixXd& C,
                                         const Eigen::MatrixXd& g)
{
  internal::check_pairs("fine", fine, fine_pairs, C.cols());
  internal::check_pairs("coarse", coarse, coarse_pairs, C.rows());
  internal::check_dimension("the number of rows of g", g.rows(), coarse.B.rows());
  const Eigen::MatrixXd weighted = coarse.B * g;
  const Eigen::MatrixXd coefficients =
      coarse_pairs.vectors.leftCols(C.rows()).transpose() * weighted;
  const double scale = std::sqrt(fine.mass.sum() / coarse.mass.sum());
  return scale * (fine_pairs.vectors.leftCols(C.cols()) * (C.transpose() * coefficients));
}

} // namespace CGAL::Spectral_geometry

#endif // definitions

#endif // CGAL_SPECTRAL_GEOMETRY_FUNCTIONAL_MAP_H
