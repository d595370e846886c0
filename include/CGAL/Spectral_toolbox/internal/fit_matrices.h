// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_INTERNAL_FIT_MATRICES_H
#define CGAL_SPECTRAL_TOOLBOX_INTERNAL_FIT_MATRICES_H

#include <CGAL/Spectral_geometry/internal/numerics/Supernodal_factor.h>
#include <CGAL/Spectral_geometry/internal/numerics/vector_units.h>
#include <CGAL/Spectral_geometry/internal/numerics/Panel_kernels.h>

namespace CGAL::Spectral_geometry::internal {

/// A matrix stored in panels of eight columns. The last panel is padded with zeros. A copy also
/// gets rows of zeros, up to a multiple of eight: rows 8 p .. 8 p + 7 of a panel are a block for
/// the kernels.
class Panel_matrix
{
public:
  // Eight columns of some rows.
  using Rows = Eigen::Map<Eigen::Array<double, Eigen::Dynamic, panel_width, Eigen::RowMajor>>;

  Panel_matrix(Index rows, Index columns)
    : m_rows(rows)
    , m_panels(whole_panels(columns))
    , m_storage(std::size_t(m_rows * m_panels * panel_width))
  {}
  explicit Panel_matrix(const Eigen::MatrixXd& A)
    : Panel_matrix(whole_panels(A.rows()) * panel_width, A.cols())
  {
    for(Index k = 0; k < A.cols(); ++k)
      rows(k / panel_width, 0, A.rows()).col(k % panel_width) = A.col(k).array();
  }

  Index panels() const { return m_panels; }
  Index panel_size() const { return m_rows * panel_width; }
  double* row(Index p, Index i) { return m_storage.data() + (p * m_rows + i) * panel_width; }
  double* block(Index p, Index q) { return row(q, p * panel_width); }
  Rows rows(Index p, Index first, Index count) { return Rows(row(p, first), count, panel_width); }
  Eigen::Array<double, 1, panel_width> numbers(Index p) { return rows(p, 0, 1).row(0); }

  /// Adds what is not below the diagonal to that of a smaller square matrix.
  void add_upper_to(Eigen::MatrixXd& M)
  {
    for(Index k = 0; k < M.cols(); ++k)
      M.col(k).head(k + 1) += rows(k / panel_width, 0, k + 1).col(k % panel_width).matrix();
  }

private:
  static Index whole_panels(Index columns) { return (columns + panel_width - 1) / panel_width; }

  Index m_rows, m_panels;
  Aligned_buffer m_storage;
};

/// y_p = the inner product of rows i of A and column[p] of G, for each entry p of row first + i of
/// a sparse matrix.
inline void sampled_product(const Sparse_matrix& pattern, Index first, Index rows, Panel_matrix& A,
                            Panel_matrix& G, double* y)
{
  const int *start = pattern.outerIndexPtr() + first, *column = pattern.innerIndexPtr();
  const double *of_A = A.row(0, 0), *of_G = G.row(0, 0);
  const Index panels = G.panels(), A_panel = A.panel_size(), G_panel = G.panel_size();
  on_rows([=](const auto& kind) CGAL_SPECTRAL_INLINE_LAMBDA {
    using Row = std::decay_t<decltype(kind)>;
    for(Index i = 0; i < rows; ++i)
      for(int p = start[i]; p < start[i + 1]; ++p) {
        const double *a = of_A + i * panel_width, *g = of_G + Index(column[p]) * panel_width;
        Row sum{}, r, s;
        for(Index q = 0; q < panels; ++q, a += A_panel, g += G_panel) {
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
  using Vector = Eigen::VectorXd;
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
    for(Index a = 0; a < size(); ++a)
      for(Sparse_rows::InnerIterator j(m_D, a); j; ++j)
        for(Sparse_rows::InnerIterator i(m_D, a); i; ++i) {
          const auto entry = &m_pattern.coeffRef(i.col(), j.col()) - m_pattern.valuePtr();
          m_entries.emplace_back(int(entry), int(a), i.value() * j.value());
        }
    m_map.resize(m_pattern.nonZeros(), size());
    m_map.setFromTriplets(m_entries.begin(), m_entries.end());
    m_entries = {};
  }

  // d_a^T G
  Eigen::RowVectorXd row(Index a, const Rows& G) const { return m_D.row(a) * G; }

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
