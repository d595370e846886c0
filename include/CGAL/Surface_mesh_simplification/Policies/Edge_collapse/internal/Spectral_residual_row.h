// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_RESIDUAL_ROW_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_RESIDUAL_ROW_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_lanes.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_rings.h>

#include <cstddef>
#include <cstring>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// An entry of a row of -L and of B.
struct Spectral_row_entry
{
  Spectral_slot vertex;
  double of_f; ///< -L_wj
  double of_z; ///< B_wj
};

CGAL_SPECTRAL_INLINE double spectral_combine_rows_body(const Spectral_fields& fields,
                                                       const std::vector<Spectral_row_entry>& row, double* R)
{
  const std::size_t length = std::size_t(fields.F.cols());
  const bool stored = fields.has_z_rows();
  Spectral_lanes squares = {};
  for(std::size_t k = 0; k < length; k += 4) {
    Spectral_lanes f = {}, z = {}, x;
    for(const Spectral_row_entry& e : row) {
      spectral_load(x, fields.f_row(e.vertex) + k);
      f += x * e.of_f;
      if(e.of_z == 0)
        continue;
      if(stored)
        spectral_load(x, fields.z_row(e.vertex) + k);
      z += x * e.of_z;
    }
    if(!stored) {
      spectral_load(x, fields.lambda.data() + k);
      z *= x;
    }
    f += z;
    squares += f * f;
    spectral_store(R + k, f);
  }
  return spectral_sum(squares);
}

#ifdef CGAL_SPECTRAL_DISPATCH
CGAL_SPECTRAL_AVX2 inline double spectral_combine_rows_avx2(const Spectral_fields& fields,
                                                            const std::vector<Spectral_row_entry>& row,
                                                            double* R)
{
  return spectral_combine_rows_body(fields, row, R);
}
#endif

/// R = sum_j (B_wj z_j - L_wj f_j) over the entries of a row; returns |R|^2.
inline double spectral_combine_rows(const Spectral_fields& fields, const std::vector<Spectral_row_entry>& row,
                                    double* R)
{
#ifdef CGAL_SPECTRAL_DISPATCH
  if(spectral_has_avx2())
    return spectral_combine_rows_avx2(fields, row, R);
#endif
  return spectral_combine_rows_body(fields, row, R);
}

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_RESIDUAL_ROW_H
