// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_INTERNAL_RANK_ONE_TERMS_H
#define CGAL_SPECTRAL_TOOLBOX_INTERNAL_RANK_ONE_TERMS_H

#include <CGAL/Spectral_geometry/internal/numerics/supernodal_structure.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <algorithm>
#include <utility>
#include <vector>

namespace CGAL::Spectral_geometry::internal {

/// A symmetric matrix sum_a x_a d_a d_a^T with bounds on x; d_a is row a of a sparse matrix.
class Rank_one_terms
{
public:
  using Index = Eigen::Index;
  using Vector = Eigen::VectorXd;
  using Row = Eigen::RowVectorXd;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Sparse_rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  using Entries = std::vector<std::pair<Index, double>>;
  // start, lower bound and typical size of each coefficient
  using Ranges = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>;

  Index size() const { return static_cast<Index>(m_ranges.size() / 3); }
  Ranges ranges() const { return Ranges(m_ranges.data(), size(), 3); }
  const Sparse_rows& vectors() const { return m_D; }

  void add(const Entries& d, double start, double lowest, double typical)
  {
    for(const auto& e : d)
      m_entries.emplace_back(static_cast<int>(size()), static_cast<int>(e.first), e.second);
    m_ranges.insert(m_ranges.end(), {(std::max)(start, lowest), lowest, typical});
  }

  void assemble(Index n)
  {
    m_D.resize(size(), n);
    m_D.setFromTriplets(m_entries.begin(), m_entries.end());
    m_entries.clear();
    m_pattern = m_D.transpose() * m_D; // where entries are
    const int *start = m_pattern.outerIndexPtr(), *rows = m_pattern.innerIndexPtr();
    for(Index a = 0; a < size(); ++a)
      for(Sparse_rows::InnerIterator j(m_D, a); j; ++j)
        for(Sparse_rows::InnerIterator i(m_D, a); i; ++i) {
          const int* p =
              std::lower_bound(rows + start[j.col()], rows + start[j.col() + 1], i.col());
          m_entries.emplace_back(static_cast<int>(p - rows), static_cast<int>(a),
                                 i.value() * j.value());
        }
    m_map.resize(m_pattern.nonZeros(), size());
    m_map.setFromTriplets(m_entries.begin(), m_entries.end());
    m_entries = {};
  }

  // d_a^T G
  Row row(Index a, const Rows& G) const { return m_D.row(a) * G; }

  Sparse_matrix matrix(const Vector& x) const
  {
    Sparse_matrix result = m_pattern;
    result.coeffs() = Vector(m_map * x).array();
    return result;
  }

  // the adjoint: the derivatives by x of the sum of products of entries of the matrix with those
  Vector derivatives(const Vector& of_entries) const { return m_map.transpose() * of_entries; }

private:
  std::vector<Eigen::Triplet<double>> m_entries;
  std::vector<double> m_ranges; // by rows
  Sparse_rows m_D;
  Sparse_matrix m_pattern, m_map;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_TOOLBOX_INTERNAL_RANK_ONE_TERMS_H
