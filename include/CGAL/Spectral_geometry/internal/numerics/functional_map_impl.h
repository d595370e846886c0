// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_FUNCTIONAL_MAP_IMPL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_FUNCTIONAL_MAP_IMPL_H

#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_geometry/internal/require.h>

namespace CGAL::Spectral_geometry {

namespace internal {

inline std::string name_of_mass(const Laplace_operator& op)
{
  if(op.voronoi)
    return mass_name(Mass::voronoi);
  for(const Mass mass : {Mass::lumped, Mass::averaged})
    if(op.theta == mass_blend(mass))
      return mass_name(mass);
  return "theta = " + std::to_string(op.theta);
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

CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::MatrixXd
functional_map(const Eigen::MatrixXd& coarse_vectors, const Eigen::SparseMatrix<double>& coarse_B,
               const Eigen::SparseMatrix<double>& P, const Eigen::MatrixXd& fine_vectors)
{
  internal::check_dimension("the number of columns of P", P.cols(), fine_vectors.rows());
  internal::check_dimension("the number of rows of P", P.rows(), coarse_vectors.rows());
  internal::check_dimension("the size of the coarse mass", coarse_B.cols(), P.rows());
  internal::check_dimension("the number of rows of the coarse mass", coarse_B.rows(), P.rows());
  const Eigen::MatrixXd restricted = P * fine_vectors;
  const Eigen::MatrixXd weighted = coarse_B * restricted;
  return coarse_vectors.transpose() * weighted;
}

CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::MatrixXd
unit_area_functional_map(const Eigen::MatrixXd& C, double fine_area, double coarse_area)
{
  internal::require(fine_area > 0 && coarse_area > 0,
                    "functional map: an area is not positive, pass the sums of the masses.");
  return std::sqrt(fine_area / coarse_area) * C;
}

CGAL_SPECTRAL_GEOMETRY_INLINE double
laplacian_commutativity_norm(const Eigen::MatrixXd& C, const Eigen::VectorXd& fine_values,
                             const Eigen::VectorXd& coarse_values)
{
  internal::check_dimension("the number of fine eigenvalues", fine_values.size(), C.cols());
  internal::check_dimension("the number of coarse eigenvalues", coarse_values.size(), C.rows());
  const double norm = C.norm();
  internal::require(
      norm > 0 && std::isfinite(norm),
      "functional map: C is zero or not finite, its commutativity is undefined, check P.");
  return (C * fine_values.asDiagonal() - coarse_values.asDiagonal() * C).norm() / norm;
}

CGAL_SPECTRAL_GEOMETRY_INLINE double orthonormality_norm(const Eigen::MatrixXd& C)
{
  return (C.transpose() * C - Eigen::MatrixXd::Identity(C.cols(), C.cols())).norm();
}

CGAL_SPECTRAL_GEOMETRY_INLINE double commutativity_floor(double theta, Eigen::Index K,
                                                         Eigen::Index N)
{
  const double k = static_cast<double>(K), n = static_cast<double>(N);
  const double wave = 4 * CGAL_PI, h2 = 2 / (std::sqrt(3.) * n);
  const double first = std::abs(1 - 2 * theta) / 16 * wave * wave * h2 * k * k / std::sqrt(5.);
  const double second = std::abs(1. / 576 - (theta - theta * theta) / 64) * wave * wave * wave *
                        h2 * h2 * k * k * k / std::sqrt(7.);
  return std::hypot(first, second);
}

CGAL_SPECTRAL_GEOMETRY_INLINE double orthonormality_floor(double theta, Eigen::Index K,
                                                          Eigen::Index N)
{
  const double k = static_cast<double>(K);
  return CGAL_PI / 3 * theta * k * std::sqrt(k) / static_cast<double>(N);
}

CGAL_SPECTRAL_GEOMETRY_INLINE double internal::residual_energy(const Laplace_operator& coarse,
                                                               const Eigen::MatrixXd& PF,
                                                               const Eigen::MatrixXd& PZ)
{
  const Eigen::MatrixXd difference = coarse.B * PZ - coarse.L * PF;
  return (difference.rowwise().squaredNorm().array() / coarse.mass.array()).sum();
}

CGAL_SPECTRAL_GEOMETRY_INLINE double restriction_energy(const Laplace_operator& coarse,
                                                        const Eigen::SparseMatrix<double>& P,
                                                        const Eigen::Ref<const Eigen::MatrixXd>& F,
                                                        const Eigen::Ref<const Eigen::MatrixXd>& Z)
{
  internal::check_dimension("the number of rows of P", P.rows(), coarse.L.rows());
  internal::check_dimension("the number of rows of F", F.rows(), P.cols());
  internal::check_dimension("the number of rows of Z", Z.rows(), P.cols());
  internal::check_dimension("the number of columns of Z", Z.cols(), F.cols());
  return internal::residual_energy(coarse, P * F, P * Z);
}

CGAL_SPECTRAL_GEOMETRY_INLINE Eigenvalue_errors eigenvalue_errors(const Eigen::VectorXd& fine,
                                                                  const Eigen::VectorXd& coarse,
                                                                  Eigen::Index first,
                                                                  Eigen::Index last,
                                                                  Eigen::Index zeros)
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

CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_evaluation evaluate_spectrum(
    const Laplace_operator& fine, const Eigenpairs& fine_pairs, const Laplace_operator& coarse,
    const Eigenpairs& coarse_pairs, const Eigen::SparseMatrix<double>& P, Eigen::Index K)
{
  internal::require(K >= 1, "spectral evaluation: K is ", K, ", judge at least one mode.");
  const Eigen::Index N = coarse.B.rows() - coarse.vanishing, judged = (std::min)(K, N);
  internal::check_pairs("fine", fine, fine_pairs, judged);
  internal::check_pairs("coarse", coarse, coarse_pairs, judged);

  Spectral_evaluation e;
  e.requested_modes = K;
  e.judged_modes = judged;
  e.extended_modes = (std::min)(judged + (judged + 9) / 10, coarse_pairs.size());
  e.fine_theta = fine.theta;
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

CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::MatrixXd
prolong_through_spectrum(const Laplace_operator& fine, const Eigenpairs& fine_pairs,
                         const Laplace_operator& coarse, const Eigenpairs& coarse_pairs,
                         const Eigen::MatrixXd& C, const Eigen::MatrixXd& g)
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

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_FUNCTIONAL_MAP_IMPL_H
