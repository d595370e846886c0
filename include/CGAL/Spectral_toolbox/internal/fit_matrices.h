// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_INTERNAL_FIT_MATRICES_H
#define CGAL_SPECTRAL_TOOLBOX_INTERNAL_FIT_MATRICES_H

#include <CGAL/Spectral_geometry/internal/numerics/Supernodal_factor.h>
#include <CGAL/Spectral_geometry/internal/numerics/vector_units.h>
#include <CGAL/Spectral_geometry/internal/numerics/Panel_kernels.h>

namespace CGAL::Spectral_geometry::internal {

/// A tall matrix, panel by panel of eight columns; the last one is filled up with zeros.
class Tall_matrix
{
public:
  // Eight columns of some rows.
  using Rows = Eigen::Map<Eigen::Array<double, Eigen::Dynamic, panel_width, Eigen::RowMajor>>;

  Tall_matrix(Index rows, Index columns)
    : m_rows(rows)
    , m_panels((columns + panel_width - 1) / panel_width)
    , m_storage(std::size_t(m_rows * m_panels * panel_width))
  {}
  explicit Tall_matrix(const Eigen::MatrixXd& A)
    : Tall_matrix(A.rows(), A.cols())
  {
    for(Index k = 0; k < A.cols(); ++k)
      rows(k / panel_width, 0, m_rows).col(k % panel_width) = A.col(k).array();
  }

  Index panels() const { return m_panels; }
  Index panel_size() const { return m_rows * panel_width; }
  double* row(Index p, Index i) { return m_storage.data() + (p * m_rows + i) * panel_width; }
  const double* row(Index p, Index i) const
  {
    return m_storage.data() + (p * m_rows + i) * panel_width;
  }
  Rows rows(Index p, Index first, Index count) { return Rows(row(p, first), count, panel_width); }

private:
  Index m_rows, m_panels;
  Aligned_buffer m_storage;
};

/// A small square matrix in blocks of 8 x 8, as the kernels for panels have it.
class Panel_blocks
{
public:
  explicit Panel_blocks(Index panels)
    : m_panels(panels)
    , m_storage(std::size_t(panels * panels * panel_width * panel_width))
  {}
  explicit Panel_blocks(const Eigen::MatrixXd& M)
    : Panel_blocks((M.cols() + panel_width - 1) / panel_width)
  {
    for(Index j = 0; j < M.cols(); ++j)
      for(Index i = 0; i < M.rows(); ++i)
        entry(i, j) = M(i, j);
  }

  double* block(Index p, Index q)
  {
    return m_storage.data() + (p * m_panels + q) * panel_width * panel_width;
  }
  const double* block(Index p, Index q) const
  {
    return const_cast<Panel_blocks&>(*this).block(p, q);
  }

  // adds the first rows and columns of a symmetric matrix, of which there are the blocks from the
  // diagonal on
  void add_to(Eigen::MatrixXd& M)
  {
    for(Index j = 0; j < M.cols(); ++j)
      for(Index i = 0; i <= j; ++i) {
        M(i, j) += entry(i, j);
        M(j, i) = M(i, j);
      }
  }

private:
  double& entry(Index i, Index j)
  {
    return block(i / panel_width, j / panel_width)[i % panel_width * panel_width + j % panel_width];
  }

  Index m_panels;
  Aligned_buffer m_storage;
};

/// y_p = the inner product of row i of A and row column[p] of G, for each entry p of the first rows
/// of a sparse matrix. Two panels of a matrix lie `A_panel` and `G_panel` numbers apart.
inline void sampled_product(const int* start, const int* column, const double* A,
                            std::ptrdiff_t A_panel, const double* G, std::ptrdiff_t G_panel,
                            std::ptrdiff_t panels, double* y, std::ptrdiff_t rows)
{
  on_rows([=](const auto& kind) CGAL_SPECTRAL_INLINE_LAMBDA {
    using Row = std::decay_t<decltype(kind)>;
    for(std::ptrdiff_t i = 0; i < rows; ++i)
      for(int p = start[i]; p < start[i + 1]; ++p) {
        const double *a = A + i * panel_width, *g = G + std::ptrdiff_t(column[p]) * panel_width;
        Row sum{}, r, s;
        for(std::ptrdiff_t q = 0; q < panels; ++q, a += A_panel, g += G_panel) {
          load(r, a);
          load(s, g);
          add(sum, r, s);
        }
        double parts[panel_width];
        store(parts, sum);
        y[p] = ((parts[0] + parts[1]) + (parts[2] + parts[3])) +
               ((parts[4] + parts[5]) + (parts[6] + parts[7]));
      }
  });
}

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

#endif // CGAL_SPECTRAL_TOOLBOX_INTERNAL_FIT_MATRICES_H
