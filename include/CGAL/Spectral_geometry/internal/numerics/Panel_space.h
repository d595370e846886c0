// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_PANEL_SPACE_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_PANEL_SPACE_H

#include <CGAL/Spectral_geometry/internal/numerics/Panel_kernels.h>
#include <CGAL/Spectral_geometry/internal/numerics/for_each_task.h>

namespace CGAL::Spectral_geometry::internal {

// Coefficients with respect to several panels, 8 rows for each. Outside of this class those of one
// panel are an Eigen::MatrixXd, whose products and factorisations are compiled anyway. A row-major
// type of eight columns would need its own.
using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, panel_width, Eigen::RowMajor>;

/// Linear algebra on panels in the inner product of a mass matrix. Sums run over a fixed number of
/// row ranges, whatever the number of threads is, so that results do not depend on it.
class Panel_space
{
public:
  Panel_space(Eigen::SparseMatrix<double> mass, int threads)
    : m_mass(std::move(mass))
    , m_threads(threads)
  {}

  Index size() const { return m_mass.rows(); }

  // y = M x; the mass matrix M is symmetric, its columns serve as rows
  void multiply_mass(const Panel& x, Panel& y) const
  {
    for_each_block(size(), [&](Index first, Index rows, int) {
      multiply(m_mass.outerIndexPtr(), m_mass.innerIndexPtr(), m_mass.valuePtr(), x.row(0),
               y.row(0), first, first + rows);
    });
  }

  // H = basis^T W and H2 = basis^T W2, of the first count and count2 <= count panels, in one pass
  // over the basis
  void products(const Panel* basis, Index count, const Panel& W, Coefficients& H, Index count2,
                const Panel& W2, Coefficients& H2) const
  {
    const Coefficients zero = Coefficients::Zero((count + count2) * panel_width, panel_width);
    std::vector<Coefficients> parts(number_of_ranges, zero);
    for_each_block(rows_in_cache, [&](Index first, Index rows, int range) {
      for(Index p = 0; p < count; ++p) {
        gram(basis[p].row(first), W.row(first), rows, parts[range].row(p * panel_width).data());
        if(p < count2)
          gram(basis[p].row(first), W2.row(first), rows,
               parts[range].row((count + p) * panel_width).data());
      }
    });
    for(int range = 1; range < number_of_ranges; ++range)
      parts[0] += parts[range];
    H = parts[0].topRows(count * panel_width);
    H2 = parts[0].bottomRows(count2 * panel_width);
  }

  // W -= basis H and W2 -= basis H2
  void subtract(const Panel* basis, Index count, Panel& W, const Coefficients& H, Index count2,
                Panel& W2, const Coefficients& H2) const
  {
    for_each_block(rows_in_cache, [&](Index first, Index rows, int) {
      for(Index p = 0; p < count; ++p) {
        subtract_product(W.row(first), basis[p].row(first), rows, H.row(p * panel_width).data());
        if(p < count2)
          subtract_product(W2.row(first), basis[p].row(first), rows,
                           H2.row(p * panel_width).data());
      }
    });
  }

  // P^T W
  Eigen::MatrixXd product(const Panel& P, const Panel& W) const
  {
    Coefficients H, none;
    products(&P, 1, W, H, 0, W, none);
    return H;
  }

  // W -= P H
  void subtract(Panel& W, const Panel& P, const Eigen::MatrixXd& H) const
  {
    subtract(&P, 1, W, H, 0, W, {});
  }

  // V = V T and W = W T
  void transform(Panel& V, Panel& W, const Eigen::MatrixXd& T) const
  {
    const Coefficients by_rows = T;
    for_each_block(rows_in_cache, [&](Index first, Index rows, int) {
      for(Panel* const panel : {&V, &W})
        multiply_block(panel->row(first), panel_width, panel_width, panel->row(first), panel_width,
                       by_rows.data(), panel_width, rows, false);
    });
  }

  // The combinations basis * Y, in place: Y is (8 count) x (8 new count), new count <= count.
  void rotate(std::vector<Panel>& basis, Index count, const Eigen::MatrixXd& Y) const
  {
    const Index new_count = Y.cols() / panel_width;
    std::vector<Coefficients> minus_Y;
    for(Index q = 0; q < new_count; ++q)
      minus_Y.emplace_back(-Y.middleCols(q * panel_width, panel_width));
    // All panels' rows are in the second level cache.
    for_each_block(64, [&](Index first, Index rows, int) {
      const Index entries = rows * panel_width;
      std::vector<double> result(new_count * entries);
      for(Index q = 0; q < new_count; ++q)
        for(Index p = 0; p < count; ++p)
          subtract_product(&result[q * entries], basis[p].row(first), rows,
                           minus_Y[q].row(p * panel_width).data());
      for(Index q = 0; q < new_count; ++q)
        std::copy_n(&result[q * entries], entries, basis[q].row(first));
    });
  }

private:
  // Calls f(first row, number of rows, range) for blocks of so many rows at most, those of a range
  // in order.
  template <class Function>
  void for_each_block(const Index rows_at_once, const Function& f) const
  {
    const Index n = size();
    for_each_task(number_of_ranges, n < 4096 ? 1 : m_threads, [&](int range) {
      const Index end = n * (range + 1) / number_of_ranges;
      for(Index i = n * range / number_of_ranges; i < end; i += rows_at_once)
        f(i, (std::min)(rows_at_once, end - i), range);
    });
  }

  static constexpr int number_of_ranges = 8;
  static constexpr Index rows_in_cache = 128; // those of two panels in the first level cache

  Eigen::SparseMatrix<double> m_mass;
  int m_threads;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_PANEL_SPACE_H
