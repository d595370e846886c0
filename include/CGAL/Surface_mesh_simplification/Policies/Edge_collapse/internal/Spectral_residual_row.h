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

/// sum += factor times 4 N numbers from `row` on. Written out, because compilers keep small arrays of vectors in memory.
template <int N>
CGAL_SPECTRAL_INLINE void spectral_add_multiple(Spectral_lanes& s0, Spectral_lanes& s1, Spectral_lanes& s2,
                                                Spectral_lanes& s3, const double* row, const double factor)
{
  Spectral_lanes x;
  spectral_load(x, row);
  s0 += x * factor;
  spectral_load(x, row + 4);
  s1 += x * factor;
  if(N > 2) {
    spectral_load(x, row + 8);
    s2 += x * factor;
    spectral_load(x, row + 12);
    s3 += x * factor;
  }
}

/// Four numbers of R: f + z, z times lambda first if that is given; adds their squares. By reference throughout: a vector
/// by value is passed in other registers where the caller is compiled for AVX2 and this, not inlined, is not.
CGAL_SPECTRAL_INLINE void spectral_put(const Spectral_lanes& f, Spectral_lanes& z, const double* lambda,
                                       double* R, Spectral_lanes& squares)
{
  if(lambda != nullptr) {
    Spectral_lanes factor;
    spectral_load(factor, lambda);
    z *= factor;
  }
  z += f;
  squares += z * z;
  spectral_store(R, z);
}

/// 4 N numbers of R from column k on; adds their squares.
template <int N>
CGAL_SPECTRAL_INLINE void spectral_combine_columns(const Spectral_fields& fields,
                                                   const std::vector<Spectral_row_entry>& row,
                                                   const Spectral_row_entry* first_of_z, const std::size_t k,
                                                   double* R, Spectral_lanes& squares)
{
  const double* const F = fields.F.data() + k;
  const double* const Z = fields.has_z_rows() ? fields.Z.data() + k : F;
  const std::size_t length = std::size_t(fields.F.cols());
  Spectral_lanes f0 = {}, f1 = {}, f2 = {}, f3 = {}, z0 = {}, z1 = {}, z2 = {}, z3 = {};
  const Spectral_row_entry* const end = row.data() + row.size();
  for(const Spectral_row_entry* e = row.data(); e != end; ++e)
    spectral_add_multiple<N>(f0, f1, f2, f3, F + e->vertex * length, e->of_f);
  for(const Spectral_row_entry* e = first_of_z; e != end; ++e)
    spectral_add_multiple<N>(z0, z1, z2, z3, Z + e->vertex * length, e->of_z);
  const bool scale = !fields.has_z_rows();
  spectral_put(f0, z0, scale ? fields.lambda.data() + k : nullptr, R + k, squares);
  spectral_put(f1, z1, scale ? fields.lambda.data() + k + 4 : nullptr, R + k + 4, squares);
  if(N > 2) {
    spectral_put(f2, z2, scale ? fields.lambda.data() + k + 8 : nullptr, R + k + 8, squares);
    spectral_put(f3, z3, scale ? fields.lambda.data() + k + 12 : nullptr, R + k + 12, squares);
  }
}

CGAL_SPECTRAL_INLINE double spectral_combine_rows_body(const Spectral_fields& fields,
                                                       const std::vector<Spectral_row_entry>& row, double* R)
{
  const std::size_t length = std::size_t(fields.F.cols()); // a multiple of 8
  Spectral_lanes squares = {};
  const Spectral_row_entry *first_of_z = row.data(), *const end = first_of_z + row.size();
  while(first_of_z != end &&
        first_of_z->of_z == 0) // a lumped mass has an entry for the centre alone, the last
    ++first_of_z;
  std::size_t k = 0;
  for(; k + 16 <= length; k += 16)
    spectral_combine_columns<4>(fields, row, first_of_z, k, R, squares);
  if(k < length)
    spectral_combine_columns<2>(fields, row, first_of_z, k, R, squares);
  return spectral_sum(squares);
}

/// R = sum_j (B_wj z_j - L_wj f_j) over the entries of a row; returns |R|^2.
inline double spectral_combine_rows(const Spectral_fields& fields, const std::vector<Spectral_row_entry>& row,
                                    double* R)
{
  double square = 0;
  Spectral_geometry::internal::on_vector_units([&] { square = spectral_combine_rows_body(fields, row, R); });
  return square;
}

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_RESIDUAL_ROW_H
