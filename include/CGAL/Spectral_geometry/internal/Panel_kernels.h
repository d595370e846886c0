// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_PANEL_KERNELS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_PANEL_KERNELS_H

#include <CGAL/Spectral_geometry/internal/Panel.h>

#include <cstddef>

// The inner loops of the block solver, on panels: n x 8 matrices stored by rows, so that one row is a cache line and eight
// vectors share every access to a matrix entry. Vectors of four doubles are a language extension of GCC and Clang on every
// target. A function marked CGAL_SPECTRAL_PANEL_AVX2 is compiled for wide vector units beside its baseline variant, and the
// machine decides at run time: a build without any -m flag has them too.
#if(defined(__GNUC__) || defined(__clang__)) && !defined(CGAL_SPECTRAL_NO_VECTOR_EXTENSION)
#define CGAL_SPECTRAL_PANEL_INLINE inline __attribute__((always_inline))
#if defined(__x86_64__)
#define CGAL_SPECTRAL_PANEL_AVX2 __attribute__((flatten, target("avx2,fma")))
#endif
#else
#define CGAL_SPECTRAL_PANEL_INLINE inline
#define CGAL_SPECTRAL_PANEL_LOOPS
#endif

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

#ifndef CGAL_SPECTRAL_PANEL_LOOPS
typedef double Four_doubles __attribute__((vector_size(32), aligned(8), may_alias));
#else
struct Four_doubles
{
  double v[4];
  Four_doubles& operator+=(const Four_doubles& o)
  {
    for(int i = 0; i < 4; ++i)
      v[i] += o.v[i];
    return *this;
  }
  Four_doubles& operator-=(const Four_doubles& o)
  {
    for(int i = 0; i < 4; ++i)
      v[i] -= o.v[i];
    return *this;
  }
  friend Four_doubles operator*(double a, Four_doubles b)
  {
    for(int i = 0; i < 4; ++i)
      b.v[i] *= a;
    return b;
  }
};
#endif

// One row of a panel in registers. Loaded through a pointer of the vector type, which may alias: GCC splits a memcpy in
// halves before it inlines the function into its AVX2 variant (five times slower solves). Never passed or returned by value:
// that ABI would depend on -m flags.
struct Panel_row
{
  Four_doubles low, high;
};

CGAL_SPECTRAL_PANEL_INLINE void load(Panel_row& x, const double* p)
{
  x.low = *reinterpret_cast<const Four_doubles*>(p);
  x.high = *reinterpret_cast<const Four_doubles*>(p + 4);
}

CGAL_SPECTRAL_PANEL_INLINE void store(double* p, const Panel_row& x)
{
  *reinterpret_cast<Four_doubles*>(p) = x.low;
  *reinterpret_cast<Four_doubles*>(p + 4) = x.high;
}

CGAL_SPECTRAL_PANEL_INLINE void clear(Panel_row& x)
{
  x.low = x.high = Four_doubles{};
}

// y += a x
CGAL_SPECTRAL_PANEL_INLINE void add(Panel_row& y, double a, const Panel_row& x)
{
  y.low += a * x.low;
  y.high += a * x.high;
}

// y -= a x
CGAL_SPECTRAL_PANEL_INLINE void subtract(Panel_row& y, double a, const Panel_row& x)
{
  y.low -= a * x.low;
  y.high -= a * x.high;
}

// H += P^T W over some rows; four columns of P at once fill the registers.
CGAL_SPECTRAL_PANEL_INLINE void gram_body(const double* P, const double* W, std::ptrdiff_t rows, double* H)
{
  for(int half = 0; half < panel_width; half += 4) {
    Panel_row sum[4];
    for(int c = 0; c < 4; ++c)
      load(sum[c], H + (half + c) * panel_width);
    const double* p = P + half;
    const double* w = W;
    for(std::ptrdiff_t i = 0; i < rows; ++i, p += panel_width, w += panel_width) {
      Panel_row x;
      load(x, w);
      for(int c = 0; c < 4; ++c)
        add(sum[c], p[c], x);
    }
    for(int c = 0; c < 4; ++c)
      store(H + (half + c) * panel_width, sum[c]);
  }
}

// W -= P H over some rows.
CGAL_SPECTRAL_PANEL_INLINE void subtract_product_body(double* W, const double* P, std::ptrdiff_t rows,
                                                      const double* H)
{
  for(int half = 0; half < panel_width; half += 4) {
    Panel_row h[4];
    for(int c = 0; c < 4; ++c)
      load(h[c], H + (half + c) * panel_width);
    const double* p = P + half;
    double* w = W;
    for(std::ptrdiff_t i = 0; i < rows; ++i, p += panel_width, w += panel_width) {
      Panel_row x;
      load(x, w);
      for(int c = 0; c < 4; ++c)
        subtract(x, p[c], h[c]);
      store(w, x);
    }
  }
}

// y_i = sum over the entries of row i of a sparse matrix of value times x_column, for rows begin .. end.
CGAL_SPECTRAL_PANEL_INLINE void multiply_body(const int* start, const int* column, const double* value,
                                              const double* x, double* y, std::ptrdiff_t begin,
                                              std::ptrdiff_t end)
{
  for(std::ptrdiff_t i = begin; i < end; ++i) {
    Panel_row sum;
    clear(sum);
    for(int p = start[i]; p < start[i + 1]; ++p) {
      Panel_row r;
      load(r, x + std::ptrdiff_t(column[p]) * panel_width);
      add(sum, value[p], r);
    }
    store(y + i * panel_width, sum);
  }
}

/// One supernode of a Cholesky factor: `width` neighbouring columns that share their row structure. `L` holds
/// width + below rows of `width` entries; the first `width` rows are a lower triangle with the *inverse* of the diagonal.
struct Supernode
{
  const double* L;
  const int* rows; // of the `below` rows
  int first, width, below;
};

// x_own: the rows of the panel that belong to the supernode's columns.
CGAL_SPECTRAL_PANEL_INLINE void forward_body(const Supernode& s, double* x)
{
  double* own = x + std::ptrdiff_t(s.first) * panel_width;
  for(int k = 0; k < s.width; ++k) {
    const double* l = s.L + std::ptrdiff_t(k) * s.width;
    Panel_row sum, r, result;
    load(sum, own + k * panel_width);
    for(int t = 0; t < k; ++t) {
      load(r, own + t * panel_width);
      subtract(sum, l[t], r);
    }
    clear(result);
    add(result, l[k], sum);
    store(own + k * panel_width, result);
  }
  const double* l = s.L + std::ptrdiff_t(s.width) * s.width;
  int i = 0;
  for(; i + 4 <= s.below; i += 4, l += 4 * s.width) { // four rows at once: one access to x_own for all
    Panel_row sum[4], r;
    for(int q = 0; q < 4; ++q)
      load(sum[q], x + std::ptrdiff_t(s.rows[i + q]) * panel_width);
    for(int t = 0; t < s.width; ++t) {
      load(r, own + t * panel_width);
      for(int q = 0; q < 4; ++q)
        subtract(sum[q], l[q * s.width + t], r);
    }
    for(int q = 0; q < 4; ++q)
      store(x + std::ptrdiff_t(s.rows[i + q]) * panel_width, sum[q]);
  }
  for(; i < s.below; ++i, l += s.width) {
    Panel_row sum, r;
    load(sum, x + std::ptrdiff_t(s.rows[i]) * panel_width);
    for(int t = 0; t < s.width; ++t) {
      load(r, own + t * panel_width);
      subtract(sum, l[t], r);
    }
    store(x + std::ptrdiff_t(s.rows[i]) * panel_width, sum);
  }
}

// Subtracts the rows below from `Count` neighbouring columns of the supernode.
template <int Count>
CGAL_SPECTRAL_PANEL_INLINE void backward_columns(const Supernode& s, double* x, int t)
{
  double* own = x + std::ptrdiff_t(s.first + t) * panel_width;
  const double* l = s.L + std::ptrdiff_t(s.width) * s.width + t;
  Panel_row sum[Count], r;
  for(int q = 0; q < Count; ++q)
    load(sum[q], own + q * panel_width);
  for(int i = 0; i < s.below; ++i, l += s.width) {
    load(r, x + std::ptrdiff_t(s.rows[i]) * panel_width);
    for(int q = 0; q < Count; ++q)
      subtract(sum[q], l[q], r);
  }
  for(int q = 0; q < Count; ++q)
    store(own + q * panel_width, sum[q]);
}

CGAL_SPECTRAL_PANEL_INLINE void backward_body(const Supernode& s, double* x)
{
  int t = 0;
  for(; t + 4 <= s.width; t += 4)
    backward_columns<4>(s, x, t);
  for(; t + 2 <= s.width; t += 2)
    backward_columns<2>(s, x, t);
  if(t < s.width)
    backward_columns<1>(s, x, t);
  double* own = x + std::ptrdiff_t(s.first) * panel_width;
  for(int k = s.width - 1; k >= 0; --k) {
    Panel_row sum, r, result;
    load(sum, own + k * panel_width);
    for(int q = k + 1; q < s.width; ++q) {
      load(r, own + q * panel_width);
      subtract(sum, s.L[std::ptrdiff_t(q) * s.width + k], r);
    }
    clear(result);
    add(result, s.L[std::ptrdiff_t(k) * s.width + k], sum);
    store(own + k * panel_width, result);
  }
}

inline bool panel_has_avx2()
{
#ifdef CGAL_SPECTRAL_PANEL_AVX2
  static const bool result = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return result;
#else
  return false;
#endif
}

// For each kernel its two variants and the choice between them.
#ifdef CGAL_SPECTRAL_PANEL_AVX2
#define CGAL_SPECTRAL_PANEL_KERNEL(name, parameters, arguments)           \
  inline void name##_baseline parameters                                  \
  {                                                                       \
    name##_body arguments;                                                \
  }                                                                       \
  CGAL_SPECTRAL_PANEL_AVX2 inline void name##_avx2 parameters             \
  {                                                                       \
    name##_body arguments;                                                \
  }                                                                       \
  inline void name parameters                                             \
  {                                                                       \
    panel_has_avx2() ? name##_avx2 arguments : name##_baseline arguments; \
  }
#else
#define CGAL_SPECTRAL_PANEL_KERNEL(name, parameters, arguments) \
  inline void name parameters                                   \
  {                                                             \
    name##_body arguments;                                      \
  }
#endif

CGAL_SPECTRAL_PANEL_KERNEL(gram, (const double* P, const double* W, std::ptrdiff_t rows, double* H),
                           (P, W, rows, H))
CGAL_SPECTRAL_PANEL_KERNEL(subtract_product,
                           (double* W, const double* P, std::ptrdiff_t rows, const double* H),
                           (W, P, rows, H))
CGAL_SPECTRAL_PANEL_KERNEL(multiply,
                           (const int* start, const int* column, const double* value, const double* x,
                            double* y, std::ptrdiff_t begin, std::ptrdiff_t end),
                           (start, column, value, x, y, begin, end))
CGAL_SPECTRAL_PANEL_KERNEL(forward, (const Supernode& s, double* x), (s, x))
CGAL_SPECTRAL_PANEL_KERNEL(backward, (const Supernode& s, double* x), (s, x))

#undef CGAL_SPECTRAL_PANEL_KERNEL

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_PANEL_KERNELS_H
