// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_ROW_NORMS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_ROW_NORMS_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <cstddef>

// Vectors of four doubles are a language extension of GCC and Clang on every target; other compilers
// run the same loops one double at a time. The wide variant is chosen at run time, so that a default
// build uses the vector units that the machine has.
#if defined(__GNUC__) || defined(__clang__)
#define CGAL_SPECTRAL_VECTOR_EXTENSION 1
#define CGAL_SPECTRAL_INLINE inline __attribute__((always_inline))
#else
#define CGAL_SPECTRAL_INLINE inline
#endif
#if defined(CGAL_SPECTRAL_VECTOR_EXTENSION) && defined(__x86_64__)
#define CGAL_SPECTRAL_DISPATCH_AVX2 1
#endif

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

#ifdef CGAL_SPECTRAL_VECTOR_EXTENSION
typedef double Spectral_lanes __attribute__((vector_size(32), aligned(8), may_alias));
constexpr std::size_t spectral_lanes = 4;
#else
typedef double Spectral_lanes;
constexpr std::size_t spectral_lanes = 1;
#endif

/// Rows are padded with zeros to a multiple of this.
constexpr std::size_t spectral_padding = 8;

/*!
 * A row of the residual for several samples of a candidate at once:
 * r_s = base + sum_j a(s,j) f_j + sum_{j < n_mass} b(s,j) z_j, where z_j = Lambda f_j unless rows of Z are
 * stored. The columns that carry mass come first.
 */
struct Spectral_row_combination
{
  static constexpr int max_samples = 3;

  const double* base = nullptr; ///< null: zero
  std::size_t n = 0;            ///< number of columns
  std::size_t n_mass = 0;       ///< of them, those with mass coefficients
  const double* const* f = nullptr;
  const double* const* z = nullptr;    ///< rows of Z, or null
  const double* lambda = nullptr;      ///< eigenvalues, used when z is null
  const double* const* a = nullptr;    ///< a[s][j]
  const double* const* b = nullptr;    ///< b[s][j]
  std::size_t length = 0;              ///< padded K
};

// The sum of squares of r_s for S samples. Samples share every load of a row.
template <int S, bool StoredZ>
CGAL_SPECTRAL_INLINE void spectral_row_norms_body(const Spectral_row_combination& c, double* result)
{
  Spectral_lanes sum[S] = {};
  constexpr std::size_t W = spectral_lanes;
  for(std::size_t k = 0; k < c.length; k += 2 * W) {
    Spectral_lanes p0[S] = {}, p1[S] = {}, q0[S] = {}, q1[S] = {};
    if(c.base != nullptr)
      for(int s = 0; s < S; ++s) {
        p0[s] = *reinterpret_cast<const Spectral_lanes*>(c.base + k);
        p1[s] = *reinterpret_cast<const Spectral_lanes*>(c.base + k + W);
      }
    for(std::size_t j = 0; j < c.n; ++j) {
      const Spectral_lanes f0 = *reinterpret_cast<const Spectral_lanes*>(c.f[j] + k);
      const Spectral_lanes f1 = *reinterpret_cast<const Spectral_lanes*>(c.f[j] + k + W);
      for(int s = 0; s < S; ++s) {
        p0[s] += f0 * c.a[s][j];
        p1[s] += f1 * c.a[s][j];
      }
      if(j >= c.n_mass)
        continue;
      if(StoredZ) {
        const Spectral_lanes z0 = *reinterpret_cast<const Spectral_lanes*>(c.z[j] + k);
        const Spectral_lanes z1 = *reinterpret_cast<const Spectral_lanes*>(c.z[j] + k + W);
        for(int s = 0; s < S; ++s) {
          p0[s] += z0 * c.b[s][j];
          p1[s] += z1 * c.b[s][j];
        }
      } else
        for(int s = 0; s < S; ++s) {
          q0[s] += f0 * c.b[s][j];
          q1[s] += f1 * c.b[s][j];
        }
    }
    if(!StoredZ) {
      const Spectral_lanes l0 = *reinterpret_cast<const Spectral_lanes*>(c.lambda + k);
      const Spectral_lanes l1 = *reinterpret_cast<const Spectral_lanes*>(c.lambda + k + W);
      for(int s = 0; s < S; ++s) {
        p0[s] += l0 * q0[s];
        p1[s] += l1 * q1[s];
      }
    }
    for(int s = 0; s < S; ++s)
      sum[s] += p0[s] * p0[s] + p1[s] * p1[s];
  }
  for(int s = 0; s < S; ++s) {
    double lanes[W];
    *reinterpret_cast<Spectral_lanes*>(lanes) = sum[s];
    double total = 0;
    for(std::size_t l = 0; l < W; ++l)
      total += lanes[l];
    result[s] = total;
  }
}

CGAL_SPECTRAL_INLINE void spectral_row_norms_select(const Spectral_row_combination& c, const int samples,
                                                    double* result)
{
  if(c.z == nullptr) {
    if(samples == 3)
      spectral_row_norms_body<3, false>(c, result);
    else if(samples == 2)
      spectral_row_norms_body<2, false>(c, result);
    else
      spectral_row_norms_body<1, false>(c, result);
  } else {
    if(samples == 3)
      spectral_row_norms_body<3, true>(c, result);
    else if(samples == 2)
      spectral_row_norms_body<2, true>(c, result);
    else
      spectral_row_norms_body<1, true>(c, result);
  }
}

inline void spectral_row_norms_baseline(const Spectral_row_combination& c, const int samples, double* result)
{
  spectral_row_norms_select(c, samples, result);
}

#ifdef CGAL_SPECTRAL_DISPATCH_AVX2
__attribute__((target("avx2,fma"))) inline void
spectral_row_norms_avx2(const Spectral_row_combination& c, const int samples, double* result)
{
  spectral_row_norms_select(c, samples, result);
}
#endif

/// result[s] = || r_s ||^2 for the first `samples` samples.
inline void spectral_row_norms(const Spectral_row_combination& c, const int samples, double* result)
{
#ifdef CGAL_SPECTRAL_DISPATCH_AVX2
  static const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if(wide)
    return spectral_row_norms_avx2(c, samples, result);
#endif
  spectral_row_norms_baseline(c, samples, result);
}

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_ROW_NORMS_H
