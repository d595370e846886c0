// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_ROWS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_ROWS_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Spectral_geometry/internal/Aligned_buffer.h>

#include <Eigen/Core>

#include <cstddef>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

using Spectral_geometry::internal::Aligned_buffer;
using Spectral_geometry::internal::cache_line;

/// The rows of F, Z and R are padded with zeros to a multiple of this.
constexpr std::size_t spectral_padding = cache_line / sizeof(double);

/// A matrix whose rows begin with a cache line each.
class Spectral_rows
{
public:
  /// All zero; `length` before padding.
  void assign(const Eigen::Index rows, const Eigen::Index length)
  {
    constexpr Eigen::Index multiple = spectral_padding;
    m_rows = rows;
    m_cols = (length + multiple - 1) / multiple * multiple;
    m_numbers.assign(std::size_t(m_rows * m_cols));
  }

  void assign(const Eigen::MatrixXd& matrix)
  {
    assign(matrix.rows(), matrix.cols());
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<Rows>(data(), m_rows, m_cols).leftCols(matrix.cols()) = matrix;
  }

  bool empty() const { return m_rows == 0 || m_cols == 0; }
  Eigen::Index cols() const { return m_cols; }
  const double* data() const { return m_numbers.data(); }
  double* data() { return m_numbers.data(); }

  const double* operator[](const std::size_t i) const { return data() + i * std::size_t(m_cols); }
  double* operator[](const std::size_t i) { return data() + i * std::size_t(m_cols); }
  Eigen::Map<const Eigen::RowVectorXd> row(const std::size_t i) const { return {(*this)[i], m_cols}; }
  Eigen::Map<Eigen::RowVectorXd> row(const std::size_t i) { return {(*this)[i], m_cols}; }

private:
  Aligned_buffer m_numbers;
  Eigen::Index m_rows = 0, m_cols = 0;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_ROWS_H
