// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_EIGEN_PROBLEM_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_EIGEN_PROBLEM_H

#include <CGAL/Spectral_geometry/Cancelled.h>
#include <CGAL/Spectral_geometry/internal/require.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <functional>

namespace CGAL::Spectral_geometry::internal {

// Approximate eigenpairs, B-orthonormal, in ascending order.
struct Ritz_pairs
{
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// What L is measured in: 1 for cotangents. The diagonal of equilateral triangles is 2 sqrt(3); the median leaves needles aside.
inline double unit_of_stiffness(const Eigen::SparseMatrix<double>& L)
{
  Eigen::VectorXd diagonal = L.diagonal();
  if(diagonal.size() == 0 || !diagonal.allFinite())
    return 1.;
  double* const middle = diagonal.data() + diagonal.size() / 2;
  std::nth_element(diagonal.data(), middle, diagonal.data() + diagonal.size());
  return *middle > 0. ? *middle / std::sqrt(12.) : 1.;
}

/// The mean spacing of eigenvalues by Weyl's law, 4 pi / area, in the unit of L. The shapes of triangles explain a factor of a
/// thousand, beyond that it is a unit.
inline double pencil_shift(const Eigen::SparseMatrix<double>& L, const Eigen::VectorXd& mass)
{
  const double unit = unit_of_stiffness(L);
  return 4. * 3.14159265358979323846 / mass.sum() * (unit > 1e-3 && unit < 1e3 ? 1. : unit);
}

/// The pencil (L, B) with its shift: what every solver shares.
class Eigen_problem
{
public:
  Eigen_problem(const Eigen::SparseMatrix<double>& L, const Eigen::SparseMatrix<double>& B,
                const Eigen::VectorXd& mass, const std::function<bool(double)>& progress)
    : m_L(L)
    , m_B(B)
    , m_mass(mass)
    , m_progress(progress)
    , m_shift(pencil_shift(L, mass))
  {}

  // Where nothing was taken out of B its row sums are the masses.
  void check(const Eigen::Index K, const bool masses_are_row_sums) const
  {
    const Eigen::Index n = size();
    require(m_L.cols() == n && m_B.rows() == n && m_B.cols() == n && m_mass.size() == n,
            "Eigenpairs: L and B must be square matrices of the size of the mass vector.");
    require(m_mass.size() > 0 && m_mass.minCoeff() > 0. && std::isfinite(m_shift),
            "Eigenpairs: every mass must be positive and finite.");
    require(!masses_are_row_sums ||
                ((m_B * Eigen::VectorXd::Ones(n) - m_mass).cwiseAbs().array() <= 1e-6 * m_mass.array()).all(),
            "Eigenpairs: the mass vector must hold the row sums of B.");
    require(K >= 1 && K <= n,
            "Eigenpairs: the number of eigenvectors must lie between 1 and the number of vertices ", n,
            ", but is ", K, ".");
  }

  Eigen::Index size() const { return m_L.rows(); }
  const Eigen::SparseMatrix<double>& L() const { return m_L; }
  const Eigen::SparseMatrix<double>& B() const { return m_B; }
  double shift() const { return m_shift; }

  // L - sigma B
  Eigen::SparseMatrix<double> shifted(double sigma) const
  {
    Eigen::SparseMatrix<double> result = m_L - sigma * m_B;
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

  Eigen::VectorXd residuals(const Eigen::VectorXd& values, const Eigen::MatrixXd& vectors) const
  {
    // Eight columns by rows: faster than one by one, and no second n x K matrix.
    using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, Eigen::Dynamic, 8>;
    const Eigen::Index K = values.size();
    Eigen::VectorXd result(K);
    for(Eigen::Index k = 0; k < K; k += 8) {
      const Eigen::Index columns = (std::min)(Eigen::Index(8), K - k);
      const Block phi = vectors.middleCols(k, columns);
      Block r = m_L * phi;
      const Block b = m_B * phi;
      r -= b * values.segment(k, columns).asDiagonal();
      double squares[8] = {};
      for(Eigen::Index i = 0; i < size(); ++i)
        for(Eigen::Index c = 0; c < columns; ++c)
          squares[c] += r(i, c) * r(i, c) / m_mass(i);
      for(Eigen::Index c = 0; c < columns; ++c)
        result(k + c) = std::sqrt(squares[c]);
    }
    return result.cwiseQuotient((values.array() + m_shift).matrix());
  }

private:
  const Eigen::SparseMatrix<double>& m_L;
  const Eigen::SparseMatrix<double>& m_B;
  const Eigen::VectorXd& m_mass;
  const std::function<bool(double)>& m_progress;
  double m_shift;
  mutable double m_fraction = 0.;
};

// A row without couplings, as of a vertex at which functions vanish, is an eigenvector of its own: of others it has exactly 0,
// and a solver its tolerance.
inline void clear_uncoupled_rows(const Eigen_problem& problem, Ritz_pairs& pairs)
{
  for(Eigen::Index v = 0; v < problem.size(); ++v) {
    if(problem.L().col(v).nonZeros() > 1 || problem.B().col(v).nonZeros() > 1)
      continue;
    const double own = problem.L().coeff(v, v) / problem.B().coeff(v, v);
    for(Eigen::Index k = 0; k < pairs.values.size(); ++k)
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
