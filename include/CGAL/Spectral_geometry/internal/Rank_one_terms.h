// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_RANK_ONE_TERMS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_RANK_ONE_TERMS_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/Cholesky.h>
#include <CGAL/Spectral_geometry/internal/Tall_products.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// A symmetric matrix sum_a x_a d_a d_a^T with bounds on x; d_a is row a of a sparse matrix.
class Rank_one_terms
{
public:
  using Index = Eigen::Index;
  using Vector = Eigen::VectorXd;
  using Row = Eigen::RowVectorXd;
  using Rows = Tall_products::Rows;
  using Sparse_rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  using Entries = std::vector<std::pair<Index, double>>;
  // start, lower bound and typical size of a coefficient
  using Range = std::array<double, 3>;

  Index size() const { return static_cast<Index>(m_ranges.size()); }
  const std::vector<Range>& ranges() const { return m_ranges; }
  const Sparse_rows& vectors() const { return m_D; }

  void add(const Entries& d, double start, double lowest, double typical)
  {
    for(const auto& e : d)
      m_entries.emplace_back(static_cast<int>(size()), static_cast<int>(e.first), e.second);
    m_ranges.push_back({(std::max)(start, lowest), lowest, typical});
  }

  void assemble(Index n)
  {
    m_D.resize(size(), n);
    m_D.setFromTriplets(m_entries.begin(), m_entries.end());
    m_entries = {};
  }

  // y = d_a^T G, with room for it
  void row(Index a, const Rows& G, Row& y) const
  {
    y.setZero();
    for(Sparse_rows::InnerIterator d(m_D, a); d; ++d)
      y += d.value() * G.row(d.col());
  }

  // sum_a x_a d_a d_a^T G
  Rows times(const Vector& x, const Rows& G) const
  {
    Rows result = Rows::Zero(G.rows(), G.cols());
    Row y(G.cols());
    for(Index a = 0; a < size(); ++a) {
      row(a, G, y);
      for(Sparse_rows::InnerIterator d(m_D, a); d; ++d)
        result.row(d.col()) += (d.value() * x(a)) * y;
    }
    return result;
  }

  // the derivatives by x of the inner product of R with that
  Vector derivatives(const Rows& R, const Rows& G) const
  {
    Vector result(size());
    Row y(G.cols()), z(G.cols());
    for(Index a = 0; a < size(); ++a) {
      row(a, G, y);
      row(a, R, z);
      result(a) = y.dot(z);
    }
    return result;
  }

  Sparse_matrix matrix(const Vector& x) const
  {
    const Sparse_matrix D = m_D, Dt = m_D.transpose();
    return Dt * x.asDiagonal() * D;
  }

private:
  std::vector<Eigen::Triplet<double>> m_entries;
  std::vector<Range> m_ranges;
  Sparse_rows m_D;
};

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_RANK_ONE_TERMS_H
