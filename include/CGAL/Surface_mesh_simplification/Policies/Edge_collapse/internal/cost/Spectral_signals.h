// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_SIGNALS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_SIGNALS_H

#include <boost/align/aligned_allocator.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace CGAL::Surface_mesh_simplification::internal {

/// The number of signals that lie side by side: 16 doubles fill four vector registers.
constexpr int spectral_width = 16;

/// What one vertex w has of 16 signals: the rows f_w, z_w and R_w = (B Z)_w - (L F)_w.
struct alignas(64) Spectral_block
{
  double f[spectral_width] = {}, z[spectral_width] = {}, r[spectral_width] = {};
};

/*!
 * The signals F and Z = B^-1 L F of all vertices, and the residual R of the current mesh. A vertex
 * has one block for every 16 signals; the last block is padded with zeros, which cost nothing.
 */
class Spectral_signals
{
public:
  Spectral_signals() = default;

  Spectral_signals(const Eigen::Index rows, const Eigen::Index columns)
    : m_blocks((std::max)(Eigen::Index(1), (columns + spectral_width - 1) / spectral_width))
    , m_columns(columns)
    , m_values(std::size_t(rows * m_blocks))
  {}

  /// The number of signals without padding.
  Eigen::Index size() const { return m_columns; }
  /// The number of blocks of each vertex.
  int number_of_blocks() const { return int(m_blocks); }

  /// The blocks of a vertex.
  const Spectral_block* operator[](const std::size_t w) const
  {
    return &m_values[w * std::size_t(m_blocks)];
  }
  Spectral_block* operator[](const std::size_t w) { return &m_values[w * std::size_t(m_blocks)]; }

  /// Sets the columns from `first` on, a multiple of 16, of F and Z.
  void set(const Eigen::Index first, const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z)
  {
    for(Eigen::Index k = 0; k < F.cols(); ++k)
      for(Eigen::Index w = 0; w < F.rows(); ++w) {
        Spectral_block& block = (*this)[std::size_t(w)][(first + k) / spectral_width];
        block.f[k % spectral_width] = F(w, k);
        block.z[k % spectral_width] = Z(w, k);
      }
  }

  /// Merges two rows of F and of Z: f_kept = (1 - weight) f_kept + weight f_removed (section 3.2).
  void merge(const std::size_t removed, const std::size_t kept, const double weight)
  {
    for(Eigen::Index b = 0; b < m_blocks; ++b) {
      const Spectral_block& from = (*this)[removed][b];
      Spectral_block& to = (*this)[kept][b];
      for(int i = 0; i < spectral_width; ++i) {
        to.f[i] = (1 - weight) * to.f[i] + weight * from.f[i];
        to.z[i] = (1 - weight) * to.z[i] + weight * from.z[i];
      }
    }
  }

private:
  Eigen::Index m_blocks = 1, m_columns = 0;
  std::vector<Spectral_block,
              boost::alignment::aligned_allocator<Spectral_block, alignof(Spectral_block)>>
      m_values;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_SIGNALS_H
