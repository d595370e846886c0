// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_RESIDUAL_ROW_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_RESIDUAL_ROW_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_lanes.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_rings.h>

#include <cstddef>

namespace CGAL::Surface_mesh_simplification::internal {

/// An entry of a row of -L and of B, for up to four ways in which the row may become: those of `Spectral_collapse_kernel`.
struct Spectral_row_entry
{
  Spectral_slot vertex;
  Spectral_lanes of_f; ///< -L_wj
  Spectral_lanes of_z; ///< B_wj
};

/// For N of them 4 W columns from k on, see spectral_combine_rows(). Written out, because compilers keep small arrays of vectors in memory.
template <int N, int W>
CGAL_SPECTRAL_INLINE void
spectral_combine_columns(const Spectral_fields& fields, const Spectral_row_entry* row,
                         const Spectral_row_entry* first_of_z, const Spectral_row_entry* end,
                         const double* start, double* R, const std::size_t k, Spectral_lanes& s0,
                         Spectral_lanes& s1, Spectral_lanes& s2, Spectral_lanes& s3)
{
  const std::size_t length = std::size_t(fields.F.cols());
  const bool has_z = fields.has_z_rows();
  const double *const F = fields.F.data() + k, *const Z = has_z ? fields.Z.data() + k : F;
  const double* const lambda = has_z ? nullptr : fields.lambda.data() + k;
  Spectral_lanes a0 = {}, a1 = {}, a2 = {}, a3 = {}, b0 = {}, b1 = {}, b2 = {}, b3 = {}, c0 = {}, c1 = {},
                 c2 = {}, c3 = {}, d0 = {}, d1 = {}, d2 = {}, d3 = {};
  const auto add = [](Spectral_lanes& r0, Spectral_lanes& r1, Spectral_lanes& r2, Spectral_lanes& r3,
                      const Spectral_lanes& x, const Spectral_lanes& factor) {
    r0 += x * factor[0];
    if(N > 1)
      r1 += x * factor[1];
    if(N > 2)
      r2 += x * factor[2];
    if(N > 3)
      r3 += x * factor[3];
  };
  const auto add_row = [&](const double* const p, const double* const scale, const Spectral_lanes& factor) {
    Spectral_lanes x, y;
    const auto load = [&](const std::size_t i) {
      spectral_load(x, p + i);
      if(scale != nullptr) {
        spectral_load(y, scale + i);
        x *= y;
      }
    };
    load(0);
    add(a0, a1, a2, a3, x, factor);
    load(4);
    add(b0, b1, b2, b3, x, factor);
    if(W > 2) {
      load(8);
      add(c0, c1, c2, c3, x, factor);
      load(12);
      add(d0, d1, d2, d3, x, factor);
    }
  };
  if(start != nullptr)
    add_row(start + k, nullptr, Spectral_lanes{1, 1, 1, 1});
  for(const Spectral_row_entry* e = row; e != end; ++e)
    add_row(F + e->vertex * length, nullptr, e->of_f);
  for(const Spectral_row_entry* e = first_of_z; e != end; ++e)
    add_row(Z + e->vertex * length, lambda, e->of_z);
  const auto finish = [&](const Spectral_lanes& r0, const Spectral_lanes& r1, const Spectral_lanes& r2,
                          const Spectral_lanes& r3, const std::size_t i) {
    if(N == 1 && R != nullptr)
      spectral_store(R + k + i, r0);
    s0 += r0 * r0;
    s1 += r1 * r1;
    s2 += r2 * r2;
    s3 += r3 * r3;
  };
  finish(a0, a1, a2, a3, 0);
  finish(b0, b1, b2, b3, 4);
  if(W > 2) {
    finish(c0, c1, c2, c3, 8);
    finish(d0, d1, d2, d3, 12);
  }
}

/// For N of them R_w = start + sum_j (B_wj z_j - L_wj f_j); puts |R_w|^2 into `square` and, where N is 1, the row into `R` unless that
/// is null, as `start` may be. Where Z = F Lambda no row of Z is formed. Entries of z are those from `first_of_z` on: a lumped mass
/// has one for the centre alone, the last.
template <int N>
CGAL_SPECTRAL_INLINE void spectral_combine_rows(const Spectral_fields& fields, const Spectral_row_entry* row,
                                                const Spectral_row_entry* first_of_z,
                                                const Spectral_row_entry* end, const double* start, double* R,
                                                double* square)
{
  const std::size_t length = std::size_t(fields.F.cols()); // a multiple of 8
  Spectral_lanes s0 = {}, s1 = {}, s2 = {}, s3 = {};
  std::size_t k = 0;
  for(; N < 4 && k + 16 <= length; k += 16)
    spectral_combine_columns<N, 4>(fields, row, first_of_z, end, start, R, k, s0, s1, s2, s3);
  for(; k < length; k += 8)
    spectral_combine_columns<N, 2>(fields, row, first_of_z, end, start, R, k, s0, s1, s2, s3);
  square[0] = spectral_sum(s0);
  if(N > 1)
    square[1] = spectral_sum(s1);
  if(N > 2)
    square[2] = spectral_sum(s2);
  if(N > 3)
    square[3] = spectral_sum(s3);
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_RESIDUAL_ROW_H
