// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_EIGEN_PROBLEM_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_EIGEN_PROBLEM_H

#include <CGAL/Spectral_geometry/Cancelled.h>
#include <CGAL/Spectral_geometry/Eigenpairs_options.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/require.h>

#include <CGAL/number_type_config.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <functional>

namespace CGAL::Spectral_geometry::internal {

/// The larger of two in the middle, 0 of none.
inline double median(Eigen::VectorXd numbers)
{
  double *const begin = numbers.data(), *const end = begin + numbers.size(),
                *const middle = begin + numbers.size() / 2;
  std::nth_element(begin, middle, end);
  return begin == end ? 0. : *middle;
}

/// What L is measured in: 1 for cotangents. The diagonal of equilateral triangles is 2 sqrt(3); the median leaves needles aside.
inline double unit_of_stiffness(const Eigen::SparseMatrix<double>& L)
{
  const Eigen::VectorXd diagonal = L.diagonal();
  const double middle = diagonal.allFinite() ? median(diagonal) : 0.;
  return middle > 0. ? middle / std::sqrt(12.) : 1.;
}

/// The mean spacing of eigenvalues by Weyl's law, 4 pi / area, in the unit of L. The shapes of triangles explain a factor of a
/// thousand, beyond that it is a unit.
inline double pencil_shift(const Laplace_operator& op)
{
  const double unit = unit_of_stiffness(op.L);
  return 4. * CGAL_PI / op.mass.sum() * (unit > 1e-3 && unit < 1e3 ? 1. : unit);
}

/// The pencil (L, B) of an operator with its shift: what every solver shares.
class Eigen_problem
{
public:
  explicit Eigen_problem(const Laplace_operator& op, const std::function<bool(double)>& progress = {})
    : m_op(op)
    , m_progress(progress)
    , m_shift(pencil_shift(op))
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
                ((B() * Eigen::VectorXd::Ones(n) - m_op.mass).cwiseAbs().array() <= 1e-6 * m_op.mass.array())
                    .all(),
            "Eigenpairs: the mass vector must hold the row sums of B.");
    require(K >= 1 && K <= n,
            "Eigenpairs: the number of eigenvectors must lie between 1 and the number of vertices ", n,
            ", but is ", K, ".");
    require(K <= coupled, "Eigenpairs: ", K, " eigenvectors are asked for, but only ", coupled,
            " vertices are off the border, where functions vanish; ask for fewer.");
  }

  Eigen::Index size() const { return L().rows(); }
  const Eigen::SparseMatrix<double>& L() const { return m_op.L; }
  const Eigen::SparseMatrix<double>& B() const { return m_op.B; }
  double shift() const { return m_shift; }

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
    if(m_progress && !m_progress(m_fraction))
      throw Cancelled();
  }

  Eigen::VectorXd residuals(const Eigenpairs& pairs) const
  {
    // Eight columns by rows: faster than one by one, and no second n x K matrix.
    using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, Eigen::Dynamic, 8>;
    const Eigen::Index K = pairs.size();
    Eigen::VectorXd result(K);
    for(Eigen::Index k = 0; k < K; k += 8) {
      const Eigen::Index columns = (std::min)(Eigen::Index(8), K - k);
      const Block phi = pairs.vectors.middleCols(k, columns);
      Block r = L() * phi;
      const Block b = B() * phi;
      r -= b * pairs.values.segment(k, columns).asDiagonal();
      double squares[8] = {};
      for(Eigen::Index i = 0; i < size(); ++i)
        for(Eigen::Index c = 0; c < columns; ++c)
          squares[c] += r(i, c) * r(i, c) / m_op.mass(i);
      for(Eigen::Index c = 0; c < columns; ++c)
        result(k + c) = std::sqrt(squares[c]);
    }
    return result.cwiseQuotient((pairs.values.array() + m_shift).matrix());
  }

private:
  const Laplace_operator& m_op;
  std::function<bool(double)> m_progress;
  double m_shift;
  mutable double m_fraction = 0.;
};

// A row without couplings, as of a vertex at which functions vanish, is an eigenvector of its own: of others it has exactly 0,
// and a solver its tolerance.
inline void clear_uncoupled_rows(const Eigen_problem& problem, Eigenpairs& pairs)
{
  for(Eigen::Index v = 0; v < problem.size(); ++v) {
    if(problem.L().col(v).nonZeros() > 1 || problem.B().col(v).nonZeros() > 1)
      continue;
    const double own = problem.L().coeff(v, v) / problem.B().coeff(v, v);
    for(Eigen::Index k = 0; k < pairs.size(); ++k)
      if(std::abs(pairs.values(k) - own) > 1e-3 * (own + problem.shift()))
        pairs.vectors(v, k) = 0.;
  }
}

// A sign must not hang on a tie. Largest entries tie on symmetric shapes, and all odd moments of antisymmetric vectors
// vanish; an entry of exactly 0.618... times the largest is not structural.
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

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_EIGEN_PROBLEM_H
