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

#include <sstream>

namespace CGAL::Spectral_geometry::internal {

/// The larger of two in the middle, 0 of none.
inline double median(Eigen::VectorXd numbers)
{
  double *const begin = numbers.data(), *const end = begin + numbers.size(),
                *const middle = begin + numbers.size() / 2;
  std::nth_element(begin, middle, end);
  return begin == end ? 0. : *middle;
}

/// What L is measured in: 1 for cotangents. The diagonal of equilateral triangles is 2 sqrt(3); the
/// median leaves needles aside.
inline double unit_of_stiffness(const Eigen::SparseMatrix<double>& L)
{
  const Eigen::VectorXd diagonal = L.diagonal();
  const double middle = diagonal.allFinite() ? median(diagonal) : 0.;
  return middle > 0. ? middle / std::sqrt(12.) : 1.;
}

/// The mean spacing of eigenvalues by Weyl's law, 4 pi / area, in the unit of L. The shapes of
/// triangles explain a factor of a thousand, beyond that it is a unit.
inline double pencil_shift(const Laplace_operator& op)
{
  const double unit = unit_of_stiffness(op.L);
  return 4. * CGAL_PI / op.mass.sum() * (unit > 1e-3 && unit < 1e3 ? 1. : unit);
}

inline std::string in_digits(const double number)
{
  std::ostringstream out;
  out.precision(2);
  out << number;
  return out.str();
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
  explicit Eigen_problem(const Laplace_operator& op, const Run_control& control = {})
    : Eigen_problem(op, pencil_shift(op), control)
  {}

  /// A part of a larger pencil has a shift of its own, and the residuals that it has in the whole,
  /// whose shift is `scale`.
  Eigen_problem(const Laplace_operator& op, const double scale, const Run_control& control)
    : m_op(op)
    , m_control(control)
    , m_shift(pencil_shift(op))
    , m_scale(scale)
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
  Eigen::SparseMatrix<double> shifted(double sigma) const
  {
    Eigen::SparseMatrix<double> result = L() - sigma * B();
    result.makeCompressed();
    return result;
  }

  // Never goes back, however often an iteration starts again.
  void report(double fraction) const
  {
    m_fraction = (std::min)(1., (std::max)(m_fraction, fraction));
    report_to(m_control, {Phase::eigenpairs, m_fraction});
  }

  Eigen::VectorXd residuals(const Eigenpairs& pairs) const
  {
    return residuals(pairs, 0, pairs.size());
  }

  // Takes the residuals of K pairs.
  Eigen::VectorXd residuals(const Eigenpairs& pairs, const Eigen::Index first,
                            const Eigen::Index K) const
  {
    // Eight columns by rows: faster than one by one, and no second n x K matrix.
    using Block =
        Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, Eigen::Dynamic, 8>;
    Eigen::VectorXd result(K);
    for(Eigen::Index k = 0; k < K; k += 8) {
      const Eigen::Index columns = (std::min)(Eigen::Index(8), K - k);
      const Block phi = pairs.vectors.middleCols(first + k, columns);
      Block r = L() * phi;
      const Block b = B() * phi;
      r -= b * pairs.values.segment(first + k, columns).asDiagonal();
      double squares[8] = {};
      for(Eigen::Index i = 0; i < size(); ++i)
        for(Eigen::Index c = 0; c < columns; ++c)
          squares[c] += r(i, c) * r(i, c) / m_op.mass(i);
      for(Eigen::Index c = 0; c < columns; ++c)
        result(k + c) = std::sqrt(squares[c]);
    }
    return result.cwiseQuotient((pairs.values.segment(first, K).array() + m_scale).matrix());
  }

  // What the residual of a pair can be by rounding alone, in its entries and in L and B.
  double rounding(const Eigenpairs& pairs, const Eigen::Index k) const
  {
    const Eigen::VectorXd phi = pairs.vectors.col(k).cwiseAbs();
    const Eigen::VectorXd terms =
        L().cwiseAbs() * phi + std::abs(pairs.values(k)) * (B().cwiseAbs() * phi);
    return std::numeric_limits<double>::epsilon() *
           std::sqrt(terms.cwiseAbs2().cwiseQuotient(m_op.mass).sum()) /
           (pairs.values(k) + m_scale);
  }

  // What is left of eigenvalue 0 by rounding in L: beside needles it is larger than low
  // eigenvalues.
  double rounding_of_values() const
  {
    return 1e-13 * L().diagonal().cwiseQuotient(B().diagonal()).cwiseAbs().maxCoeff();
  }

private:
  const Laplace_operator& m_op;
  Run_control m_control;
  double m_shift, m_scale;
  mutable double m_fraction = 0.;
};

// Says which matrix has the wrong sign, and goes on where none has and only rounding is negative.
inline void refuse_indefinite(const Eigen_problem& problem, const int threads)
{
  const double s = problem.shift();
  const auto negative = [&](Eigen::SparseMatrix<double> A) {
    A.makeCompressed();
    return number_of_negative_eigenvalues(A, threads);
  };
  require(negative(problem.B()) == 0,
          "Eigenpairs: the mass matrix B is not positive definite; pass one that is.");
  require(negative(s * problem.B() - problem.L()) != 0,
          "Eigenpairs: L has the opposite sign, as cotmatrix() of libigl has; pass -L.");
  const Eigen::Index count =
      negative(problem.shifted(-(std::max)(1e-8 * s, problem.rounding_of_values())));
  require(count <= 0, "Eigenpairs: L is not positive semidefinite, ", count,
          " of its eigenvalues are negative; add a multiple of B to it.");
}

// A sign must not hang on a tie. Largest entries tie on symmetric shapes, and all odd moments of
// antisymmetric vectors vanish; an entry of exactly 0.618... times the largest is not structural.
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
