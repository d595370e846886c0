// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_RESIDUAL_ROW_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_RESIDUAL_ROW_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_rings.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_signals.h>

#include <CGAL/Spectral_geometry/internal/numerics/vector_units.h>

#include <Eigen/Core>

#include <cstddef>

namespace CGAL::Surface_mesh_simplification::internal {

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
CGAL_SPECTRAL_INLINE Spectral_quad& spectral_quad(double* p)
{
  return *reinterpret_cast<Spectral_quad*>(p);
}
#else
using Spectral_quad = Eigen::Array4d;

inline Eigen::Map<const Eigen::Array4d> spectral_quad(const double* p)
{
  return Eigen::Map<const Eigen::Array4d>(p);
}
inline Eigen::Map<Eigen::Array4d> spectral_quad(double* p)
{
  return Eigen::Map<Eigen::Array4d>(p);
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
    if(result != nullptr) {
      spectral_quad(result[b].r) = s0;
      spectral_quad(result[b].r + 4) = s1;
      spectral_quad(result[b].r + 8) = s2;
      spectral_quad(result[b].r + 12) = s3;
    }
  }
  return (squares[0] + squares[1]) + (squares[2] + squares[3]);
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_RESIDUAL_ROW_H
