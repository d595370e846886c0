// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_LANES_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_LANES_H

#include <CGAL/Spectral_geometry/internal/parallel/vector_units.h>

#include <cmath>
#include <cstring>

#if defined(CGAL_SPECTRAL_DISPATCH) && defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector) // GCC from 12
#define CGAL_SPECTRAL_SHUFFLE 1
#endif
#endif

namespace CGAL::Surface_mesh_simplification::internal {

#ifdef CGAL_SPECTRAL_VECTOR_EXTENSION
using Spectral_lanes_in_memory = Spectral_geometry::internal::Four_doubles;
#ifdef __clang__
// In templates Clang forgets that a type asks for less than its natural alignment: its variables have that.
typedef double Spectral_lanes __attribute__((vector_size(32), aligned(32), may_alias));
#else
// Without -mavx the natural alignment is 16 for GCC, but 32 in functions for wide vector units: neither is asked for.
typedef Spectral_lanes_in_memory Spectral_lanes;
#endif
#else
/// Four doubles, lane by lane.
struct Spectral_lanes
{
  double lane[4];
  double& operator[](const int i) { return lane[i]; }
  double operator[](const int i) const { return lane[i]; }
#define CGAL_SPECTRAL_LANE_OPERATOR(op)                                        \
  friend Spectral_lanes operator op(Spectral_lanes a, const Spectral_lanes& b) \
  {                                                                            \
    for(int i = 0; i < 4; ++i)                                                 \
      a.lane[i] = a.lane[i] op b.lane[i];                                      \
    return a;                                                                  \
  }                                                                            \
  friend Spectral_lanes operator op(Spectral_lanes a, const double b)          \
  {                                                                            \
    for(int i = 0; i < 4; ++i)                                                 \
      a.lane[i] = a.lane[i] op b;                                              \
    return a;                                                                  \
  }                                                                            \
  friend Spectral_lanes operator op(const double a, Spectral_lanes b)          \
  {                                                                            \
    for(int i = 0; i < 4; ++i)                                                 \
      b.lane[i] = a op b.lane[i];                                              \
    return b;                                                                  \
  }                                                                            \
  template <class Number>                                                      \
  Spectral_lanes& operator op##=(const Number& b)                              \
  {                                                                            \
    return *this = *this op b;                                                 \
  }
  CGAL_SPECTRAL_LANE_OPERATOR(+)
  CGAL_SPECTRAL_LANE_OPERATOR(-)
  CGAL_SPECTRAL_LANE_OPERATOR(*)
#undef CGAL_SPECTRAL_LANE_OPERATOR
  Spectral_lanes operator-() const
  {
    return 0. - *this;
  }
};
#endif

CGAL_SPECTRAL_INLINE void spectral_load(Spectral_lanes& x, const double* p)
{
#ifdef CGAL_SPECTRAL_VECTOR_EXTENSION
  x = *reinterpret_cast<const Spectral_lanes_in_memory*>(p);
#else
  std::memcpy(&x, p, sizeof(x));
#endif
}

CGAL_SPECTRAL_INLINE void spectral_store(double* p, const Spectral_lanes& x)
{
#ifdef CGAL_SPECTRAL_VECTOR_EXTENSION
  *reinterpret_cast<Spectral_lanes_in_memory*>(p) = x;
#else
  std::memcpy(p, &x, sizeof(x));
#endif
}

CGAL_SPECTRAL_INLINE double spectral_sum(const Spectral_lanes& x)
{
  return (x[0] + x[1]) + (x[2] + x[3]);
}

/// result = 1 / sqrt(x) where x > bound, else 0; adds 1 to `failed` where the result is 0.
CGAL_SPECTRAL_INLINE void spectral_inverse_sqrt(Spectral_lanes& result, const Spectral_lanes& x,
                                                const Spectral_lanes& bound, Spectral_lanes& failed)
{
#ifdef CGAL_SPECTRAL_SHUFFLE
  // The halves are SSE2, which every x86_64 has; the AVX2 variant of the caller turns them into VEX code.
  const __m128d low = _mm_sqrt_pd(__builtin_shufflevector(x, x, 0, 1));
  const __m128d high = _mm_sqrt_pd(__builtin_shufflevector(x, x, 2, 3));
  const Spectral_lanes root = __builtin_shufflevector(low, high, 0, 1, 2, 3);
#elif defined(CGAL_SPECTRAL_DISPATCH)
  __m128d half[2];
  std::memcpy(half, &x, sizeof(x));
  half[0] = _mm_sqrt_pd(half[0]);
  half[1] = _mm_sqrt_pd(half[1]);
  Spectral_lanes root;
  std::memcpy(&root, half, sizeof(root));
#else
  Spectral_lanes root;
  for(int i = 0; i < 4; ++i)
    root[i] = std::sqrt(x[i]);
#endif
#ifdef CGAL_SPECTRAL_VECTOR_EXTENSION
  const Spectral_lanes one = {1, 1, 1, 1}, zero = {};
  result = x > bound ? one / root : zero;
  failed += x > bound ? zero : one;
#else
  for(int i = 0; i < 4; ++i) {
    result[i] = x[i] > bound[i] ? 1 / root[i] : 0;
    failed[i] += x[i] > bound[i] ? 0 : 1;
  }
#endif
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_LANES_H
