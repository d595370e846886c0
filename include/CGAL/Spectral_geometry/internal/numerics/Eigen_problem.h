// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_EIGEN_PROBLEM_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_EIGEN_PROBLEM_H

#include <CGAL/Spectral_geometry/Run_control.h>
#include <CGAL/Spectral_geometry/Eigenpairs_options.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/numerics/Supernodal_factor.h>

#include <CGAL/number_type_config.h>

namespace CGAL::Spectral_geometry::internal {

/// The unit of L, 1 for cotangents: the median of its diagonal divided by 2 sqrt(3), the diagonal
/// entry of equilateral triangles. The median ignores needles.
inline double unit_of_stiffness(const Eigen::SparseMatrix<double>& L)
{
  const Eigen::VectorXd diagonal = L.diagonal();
  const double middle = diagonal.allFinite() ? median(diagonal) : 0.;
  return middle > 0. ? middle / std::sqrt(12.) : 1.;
}

/// The mean spacing of eigenvalues by Weyl's law, 4 pi / area, in the unit of L. The shapes of
/// triangles explain a factor of up to a thousand; beyond that it is a unit.
inline double pencil_shift(const Laplace_operator& op)
{
  const double unit = unit_of_stiffness(op.L);
  return 4. * CGAL_PI / op.mass.sum() * (unit > 1e-3 && unit < 1e3 ? 1. : unit);
}

/// By how much the diagonal entry of each row exceeds the sum of the magnitudes beside it.
inline Eigen::VectorXd dominance(const Eigen::SparseMatrix<double>& B)
{
  return 2. * B.diagonal() - B.cwiseAbs() * Eigen::VectorXd::Ones(B.cols());
}

/// An iteration has ended without all pairs.
struct Not_converged : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// The pencil (L, B) of an operator with its shift: what every solver shares.
class Eigen_problem
{
public:
  /// A part of a larger pencil has a shift of its own. Its residuals are relative to `scale`, the
  /// shift of the whole.
  explicit Eigen_problem(const Laplace_operator& op, const Run_control& control = {},
                         const std::optional<double> scale = {})
    : m_op(op)
    , m_control(control)
    , m_shift(pencil_shift(op))
    , m_scale(scale.value_or(m_shift))
  {}

  void check(const Eigen::Index K) const
  {
    const Eigen::Index n = size(), coupled = n - m_op.vanishing;
    require(L().cols() == n && B().rows() == n && B().cols() == n && m_op.mass.size() == n,
            "Eigenpairs: L and B must be square matrices of the size of the mass vector.");
    require(n > 0 && m_op.mass.minCoeff() > 0. && std::isfinite(m_shift),
            "Eigenpairs: every mass must be positive and finite.");
    // Where nothing was taken out of B.
    require(m_op.boundary != Boundary_condition::neumann ||
                ((B() * Eigen::VectorXd::Ones(n) - m_op.mass).cwiseAbs().array() <=
                 1e-6 * m_op.mass.array())
                    .all(),
            "Eigenpairs: the mass vector must hold the row sums of B.");
    require(K >= 1 && K <= n,
            "Eigenpairs: the number of eigenvectors must lie between 1 and the number of vertices ",
            n, ", but is ", K, ".");
    require(K <= coupled, "Eigenpairs: ", K, " eigenvectors are asked for, but only ", coupled,
            coupled == 1 ? " vertex is" : " vertices are",
            " off the border, where functions vanish; ask for fewer.");
  }

  Eigen::Index size() const { return L().rows(); }
  const Laplace_operator& op() const { return m_op; }
  const Eigen::SparseMatrix<double>& L() const { return m_op.L; }
  const Eigen::SparseMatrix<double>& B() const { return m_op.B; }
  double shift() const { return m_shift; }
  double scale() const { return m_scale; }

  // L - sigma B
  Eigen::SparseMatrix<double> shifted(double sigma) const { return L() - sigma * B(); }

  // Never goes back, however often an iteration starts again.
  void report(double fraction) const
  {
    m_fraction = (std::min)(1., (std::max)(m_fraction, fraction));
    report_to(m_control, {Phase::eigenpairs, m_fraction});
  }

  Eigen::VectorXd residuals(const Eigenpairs& pairs, const int threads) const
  {
    Eigen::VectorXd result(pairs.size());
    for_each_task(pairs.size(), threads,
                  [&](const Eigen::Index k) { result(k) = residual(pairs, k); });
    return result;
  }

  double residual(const Eigenpairs& pairs, const Eigen::Index k) const
  {
    const auto phi = pairs.vectors.col(k);
    const Eigen::VectorXd r = L() * phi - pairs.values(k) * (B() * phi);
    return norm(r) / (pairs.values(k) + m_scale);
  }

  // What the residual of a pair can be by rounding alone, in its entries and in L and B.
  double rounding(const Eigenpairs& pairs, const Eigen::Index k) const
  {
    const Eigen::VectorXd phi = pairs.vectors.col(k).cwiseAbs();
    const Eigen::VectorXd terms =
        L().cwiseAbs() * phi + std::abs(pairs.values(k)) * (B().cwiseAbs() * phi);
    return std::numeric_limits<double>::epsilon() * norm(terms) / (pairs.values(k) + m_scale);
  }

  // The value that rounding in L can leave for eigenvalue 0. On a mesh with needles it exceeds low
  // eigenvalues.
  double rounding_of_values() const
  {
    return 1e-13 * L().diagonal().cwiseQuotient(B().diagonal()).cwiseAbs().maxCoeff();
  }

private:
  double norm(const Eigen::VectorXd& r) const
  {
    return std::sqrt(r.cwiseAbs2().cwiseQuotient(m_op.mass).sum());
  }

  const Laplace_operator& m_op;
  Run_control m_control;
  double m_shift, m_scale;
  mutable double m_fraction = 0.;
};

// Throws if L has the wrong sign or is indefinite beyond rounding, provided that B is definite.
inline void refuse_indefinite(const Eigen_problem& problem, const int threads)
{
  const double s = problem.shift();
  require(number_of_negative_eigenvalues(s * problem.B() - problem.L(), threads) != 0,
          "Eigenpairs: L has the opposite sign, as cotmatrix() of libigl has; pass -L.");
  const double rounding = (std::max)(1e-8 * s, problem.rounding_of_values());
  const Eigen::Index count = number_of_negative_eigenvalues(problem.shifted(-rounding), threads);
  require(count <= 0, "Eigenpairs: L is not positive semidefinite, ", count,
          " of its eigenvalues are negative; add a multiple of B to it.");
}

// A sign must not depend on a tie. The largest entries tie on symmetric shapes, and all odd moments
// of antisymmetric vectors vanish. Ties with 0.618... times the largest are
// rare: five-fold symmetry can make one.
inline void fix_signs(Eigen::MatrixXd& vectors)
{
  for(Eigen::Index k = 0; k < vectors.cols(); ++k) {
    const double bound = 0.6180339887498949 * vectors.col(k).cwiseAbs().maxCoeff();
    Eigen::Index i = 0;
    while(std::abs(vectors(i, k)) < bound)
      ++i;
    if(vectors(i, k) < 0.)
      vectors.col(k) = -vectors.col(k);
  }
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_EIGEN_PROBLEM_H
