// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_SIGNALS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_SIGNALS_H

#include <CGAL/Spectral_geometry/internal/numerics/for_each_task.h>
#include <CGAL/Spectral_geometry/internal/numerics/vector_units.h>

#include <boost/align/aligned_allocator.hpp>

namespace CGAL::Surface_mesh_simplification::internal {

/// A vertex of the input mesh, numbered in the order of `vertices(mesh)` when the state was made. A
/// merged vertex keeps the slot of the vertex that CGAL kept; slots are never used again.
using Spectral_slot = std::uint32_t;

constexpr Spectral_slot null_spectral_slot = (std::numeric_limits<Spectral_slot>::max)();

/// The number of signals that lie side by side: 16 doubles fill four vector registers.
constexpr int spectral_width = 16;

/// The values of 16 signals at a vertex w: the rows f_w, z_w and R_w = (B Z)_w - (L F)_w. They are
/// not initialised, and `set()` writes them all: zeros that were overwritten took 3 % of a run.
struct alignas(64) Spectral_block
{
  Spectral_block() {}

  double f[spectral_width], z[spectral_width], r[spectral_width];
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
    : m_blocks(blocks_of(columns))
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

  /// Sets the columns from `first` on, a multiple of 16, of F and Z, and what pads the last block;
  /// R is 0.
  void set(const Eigen::Index first, const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z,
           const int threads = 1)
  {
    const Eigen::Index padded = blocks_of(F.cols()) * spectral_width;
    const auto set_rows = [&](const Eigen::Index begin, const Eigen::Index end) {
      for(Eigen::Index w = begin; w < end; ++w)
        for(Eigen::Index k = 0; k < padded; ++k) {
          Spectral_block& block = (*this)[w][(first + k) / spectral_width];
          block.f[k % spectral_width] = k < F.cols() ? F(w, k) : 0.;
          block.z[k % spectral_width] = k < F.cols() ? Z(w, k) : 0.;
          block.r[k % spectral_width] = 0.;
        }
    };
    Spectral_geometry::internal::for_each_range(F.rows(), 1024, threads, set_rows);
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
  static Eigen::Index blocks_of(const Eigen::Index columns)
  {
    return (std::max)(Eigen::Index(1), (columns + spectral_width - 1) / spectral_width);
  }

  Eigen::Index m_blocks = 1, m_columns = 0;
  std::vector<Spectral_block,
              boost::alignment::aligned_allocator<Spectral_block, alignof(Spectral_block)>>
      m_values;
};

/// An entry of a row of -L and of B.
struct Spectral_row_entry
{
  Spectral_slot vertex;
  double of_f; ///< -L_wj
  double of_z; ///< B_wj
};

#ifdef CGAL_SPECTRAL_VECTOR_EXTENSION
using Spectral_quad = Spectral_geometry::internal::Four_doubles;

CGAL_SPECTRAL_INLINE const Spectral_quad& spectral_quad(const double* p)
{
  return *reinterpret_cast<const Spectral_quad*>(p);
}
#else
using Spectral_quad = Eigen::Array4d;

inline Eigen::Map<const Eigen::Array4d> spectral_quad(const double* p)
{
  return Eigen::Map<const Eigen::Array4d>(p);
}
#endif

/// Computes R_w = start + sum_j (B_wj z_j - L_wj f_j), writes it to `result` unless that is null,
/// and returns |R_w|^2. A lumped mass has an entry for the centre alone: entries before
/// `first_of_z` have no z.
///
/// Four registers are written out: Clang makes pairs of a loop over 16 doubles, and takes three
/// times as long.
CGAL_SPECTRAL_INLINE double spectral_residual_row(const Spectral_signals& signals,
                                                  const Spectral_row_entry* const row,
                                                  const Spectral_row_entry* const first_of_z,
                                                  const Spectral_row_entry* const end,
                                                  const Spectral_block* const start,
                                                  Spectral_block* result)
{
  static_assert(spectral_width == 16, "four registers of four");
  Spectral_quad squares = {0, 0, 0, 0};
  for(int b = 0; b < signals.number_of_blocks(); ++b) {
    Spectral_quad s0 = {0, 0, 0, 0}, s1 = s0, s2 = s0, s3 = s0;
    const auto add = [&](const double factor, const double* const x) CGAL_SPECTRAL_INLINE_LAMBDA {
      s0 += factor * spectral_quad(x);
      s1 += factor * spectral_quad(x + 4);
      s2 += factor * spectral_quad(x + 8);
      s3 += factor * spectral_quad(x + 12);
    };
    if(start != nullptr)
      add(1, start[b].r);
    for(const Spectral_row_entry* e = row; e != first_of_z; ++e)
      add(e->of_f, signals[e->vertex][b].f);
    for(const Spectral_row_entry* e = first_of_z; e != end; ++e) {
      const Spectral_block& block = signals[e->vertex][b];
      add(e->of_f, block.f);
      add(e->of_z, block.z);
    }
    squares += s0 * s0 + s1 * s1 + s2 * s2 + s3 * s3;
    for(int i = 0; i < 4 && result != nullptr; ++i) {
      result[b].r[i] = s0[i];
      result[b].r[4 + i] = s1[i];
      result[b].r[8 + i] = s2[i];
      result[b].r[12 + i] = s3[i];
    }
  }
  return (squares[0] + squares[1]) + (squares[2] + squares[3]);
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_SIGNALS_H
