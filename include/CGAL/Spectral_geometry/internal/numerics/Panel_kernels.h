// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_PANEL_KERNELS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_PANEL_KERNELS_H

#include <CGAL/Spectral_geometry/internal/numerics/vector_units.h>

#include <boost/align/aligned_alloc.hpp>
#include <boost/align/aligned_delete.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <new>

// The inner loops of the block solver, on panels: n x 8 matrices stored by rows, so that one row is
// a cache line and eight vectors share every access to a matrix entry.

namespace CGAL::Spectral_geometry::internal {

using Eigen::Index;

constexpr int panel_width = 8;

/// Eight vectors, n x 8 by rows, each row in one cache line. The entries begin undefined: zeros
/// that are overwritten took a twentieth of a run.
class Panel
{
public:
  explicit Panel(Index n)
    : m_storage(static_cast<double*>(boost::alignment::aligned_alloc(
          cache_line, std::size_t(n) * panel_width * sizeof(double))))
  {
    if(!m_storage && n > 0)
      throw std::bad_alloc();
  }
  Panel(Panel&&) = default;
  Panel& operator=(Panel&&) = default;
  Panel(const Panel&) = delete; // long ones must not be copied unnoticed
  Panel& operator=(const Panel&) = delete;

  double* row(Index i) { return m_storage.get() + i * panel_width; }
  const double* row(Index i) const { return m_storage.get() + i * panel_width; }

private:
  std::unique_ptr<double[], boost::alignment::aligned_delete> m_storage;
};

/// One row of a panel in registers, as Eigen has it for the flags of the build.
using Panel_row = Eigen::Array<double, panel_width, 1>;

CGAL_SPECTRAL_INLINE void load(Panel_row& x, const double* p)
{
  x = Panel_row::Map(p);
}

CGAL_SPECTRAL_INLINE void store(double* p, const Panel_row& x)
{
  Panel_row::Map(p) = x;
}

CGAL_SPECTRAL_INLINE void clear(Panel_row& x)
{
  x.setZero();
}

/// y += a x, where a is a number or a row.
template <class Factor>
CGAL_SPECTRAL_INLINE void add(Panel_row& y, const Factor& a, const Panel_row& x)
{
  y += a * x;
}

CGAL_SPECTRAL_INLINE void subtract(Panel_row& y, double a, const Panel_row& x)
{
  y -= a * x;
}

#ifdef CGAL_SPECTRAL_DISPATCH
/// A row of a panel in the registers of wide vector units, in functions compiled for them:
/// elsewhere six times slower than Eigen.
struct Wide_panel_row
{
  Four_doubles low, high;
};

CGAL_SPECTRAL_INLINE void load(Wide_panel_row& x, const double* p)
{
  x.low = *reinterpret_cast<const Four_doubles*>(p);
  x.high = *reinterpret_cast<const Four_doubles*>(p + 4);
}

CGAL_SPECTRAL_INLINE void store(double* p, const Wide_panel_row& x)
{
  *reinterpret_cast<Four_doubles*>(p) = x.low;
  *reinterpret_cast<Four_doubles*>(p + 4) = x.high;
}

CGAL_SPECTRAL_INLINE void clear(Wide_panel_row& x)
{
  x.low = x.high = Four_doubles{};
}

CGAL_SPECTRAL_INLINE void add(Wide_panel_row& y, double a, const Wide_panel_row& x)
{
  y.low += a * x.low;
  y.high += a * x.high;
}

CGAL_SPECTRAL_INLINE void subtract(Wide_panel_row& y, double a, const Wide_panel_row& x)
{
  y.low -= a * x.low;
  y.high -= a * x.high;
}

CGAL_SPECTRAL_INLINE void add(Wide_panel_row& y, const Wide_panel_row& a, const Wide_panel_row& x)
{
  y.low += a.low * x.low;
  y.high += a.high * x.high;
}
#else
using Wide_panel_row = Panel_row;
#endif

// What follows is compiled for both kinds of rows.

// H += P^T W over some rows; four columns of P at once fill the registers.
template <class Row>
CGAL_SPECTRAL_INLINE void gram_body(const double* P, const double* W, std::ptrdiff_t rows,
                                    double* H)
{
  for(int half = 0; half < panel_width; half += 4) {
    Row sum[4];
    for(int c = 0; c < 4; ++c)
      load(sum[c], H + (half + c) * panel_width);
    const double* p = P + half;
    const double* w = W;
    for(std::ptrdiff_t i = 0; i < rows; ++i, p += panel_width, w += panel_width) {
      Row x;
      load(x, w);
      for(int c = 0; c < 4; ++c)
        add(sum[c], p[c], x);
    }
    for(int c = 0; c < 4; ++c)
      store(H + (half + c) * panel_width, sum[c]);
  }
}

// W -= P H over some rows.
template <class Row>
CGAL_SPECTRAL_INLINE void subtract_product_body(double* W, const double* P, std::ptrdiff_t rows,
                                                const double* H)
{
  for(int half = 0; half < panel_width; half += 4) {
    Row h[4];
    for(int c = 0; c < 4; ++c)
      load(h[c], H + (half + c) * panel_width);
    const double* p = P + half;
    double* w = W;
    for(std::ptrdiff_t i = 0; i < rows; ++i, p += panel_width, w += panel_width) {
      Row x;
      load(x, w);
      for(int c = 0; c < 4; ++c)
        subtract(x, p[c], h[c]);
      store(w, x);
    }
  }
}

// y_i = sum over the entries of row i of a sparse matrix of value times x_column, for rows begin ..
// end.
template <class Row>
CGAL_SPECTRAL_INLINE void multiply_body(const int* start, const int* column, const double* value,
                                        const double* x, double* y, std::ptrdiff_t begin,
                                        std::ptrdiff_t end)
{
  for(std::ptrdiff_t i = begin; i < end; ++i) {
    Row sum;
    clear(sum);
    for(int p = start[i]; p < start[i + 1]; ++p) {
      Row r;
      load(r, x + std::ptrdiff_t(column[p]) * panel_width);
      add(sum, value[p], r);
    }
    store(y + i * panel_width, sum);
  }
}

// C -= A T over some rows, or C = A T, which may be A itself; T has `count` rows of eight numbers,
// zeros beyond the `columns` of C. Rows of C and A lie `c` and `a` numbers apart.
template <class Row, int Count>
CGAL_SPECTRAL_INLINE void multiply_rows(double* C, std::ptrdiff_t c, int columns, const double* A,
                                        std::ptrdiff_t a, const double* T, std::ptrdiff_t count,
                                        bool subtracted)
{
  Row sum[Count], t;
  for(int q = 0; q < Count; ++q)
    clear(sum[q]);
  for(std::ptrdiff_t k = 0; k < count; ++k) {
    load(t, T + k * panel_width);
    for(int q = 0; q < Count; ++q)
      add(sum[q], A[q * a + k], t);
  }
  for(int q = 0; q < Count; ++q) {
    double* const to = C + q * c;
    if(columns == panel_width) {
      if(subtracted) {
        load(t, to);
        subtract(t, 1., sum[q]);
        store(to, t);
      } else
        store(to, sum[q]);
    } else {
      double row[panel_width];
      store(row, sum[q]);
      for(int j = 0; j < columns; ++j)
        to[j] = subtracted ? to[j] - row[j] : row[j];
    }
  }
}

template <class Row>
CGAL_SPECTRAL_INLINE void
multiply_block_body(double* C, std::ptrdiff_t c, int columns, const double* A, std::ptrdiff_t a,
                    const double* T, std::ptrdiff_t count, std::ptrdiff_t rows, bool subtracted)
{
  std::ptrdiff_t i = 0;
  for(; i + 4 <= rows; i += 4)
    multiply_rows<Row, 4>(C + i * c, c, columns, A + i * a, a, T, count, subtracted);
  for(; i < rows; ++i)
    multiply_rows<Row, 1>(C + i * c, c, columns, A + i * a, a, T, count, subtracted);
}

/// One supernode of a Cholesky factor: `width` neighbouring columns that share their row structure.
/// `L` holds width + below rows of `width` entries; the first `width` rows are a lower triangle
/// with the *inverse* of the diagonal, what is above it is not read.
struct Supernode
{
  const double* L;
  const int* rows; // of the `below` rows
  int first, width, below;
};

// Subtracts the columns, solved for, from `Count` of the rows below: one access to `own` for all of
// them.
template <class Row, int Count>
CGAL_SPECTRAL_INLINE void forward_rows(const Supernode& s, const double* own, double* x, int i)
{
  const double* l = s.L + std::ptrdiff_t(s.width + i) * s.width;
  Row sum[Count], r;
  for(int q = 0; q < Count; ++q)
    load(sum[q], x + std::ptrdiff_t(s.rows[i + q]) * panel_width);
  for(int t = 0; t < s.width; ++t) {
    load(r, own + t * panel_width);
    for(int q = 0; q < Count; ++q)
      subtract(sum[q], l[q * s.width + t], r);
  }
  for(int q = 0; q < Count; ++q)
    store(x + std::ptrdiff_t(s.rows[i + q]) * panel_width, sum[q]);
}

// `own`: the rows of the panel that belong to the supernode's columns.
template <class Row>
CGAL_SPECTRAL_INLINE void forward_body(const Supernode& s, double* x)
{
  double* own = x + std::ptrdiff_t(s.first) * panel_width;
  for(int k = 0; k < s.width; ++k) {
    const double* l = s.L + std::ptrdiff_t(k) * s.width;
    Row sum, r, result;
    load(sum, own + k * panel_width);
    for(int t = 0; t < k; ++t) {
      load(r, own + t * panel_width);
      subtract(sum, l[t], r);
    }
    clear(result);
    add(result, l[k], sum);
    store(own + k * panel_width, result);
  }
  int i = 0;
  for(; i + 4 <= s.below; i += 4)
    forward_rows<Row, 4>(s, own, x, i);
  for(; i < s.below; ++i)
    forward_rows<Row, 1>(s, own, x, i);
}

// Subtracts the rows below from `Count` neighbouring columns of the supernode.
template <class Row, int Count>
CGAL_SPECTRAL_INLINE void backward_columns(const Supernode& s, double* x, int t)
{
  double* own = x + std::ptrdiff_t(s.first + t) * panel_width;
  const double* l = s.L + std::ptrdiff_t(s.width) * s.width + t;
  Row sum[Count], r;
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

template <class Row>
CGAL_SPECTRAL_INLINE void backward_body(const Supernode& s, double* x)
{
  int t = 0;
  for(; t + 4 <= s.width; t += 4)
    backward_columns<Row, 4>(s, x, t);
  for(; t + 2 <= s.width; t += 2)
    backward_columns<Row, 2>(s, x, t);
  if(t < s.width)
    backward_columns<Row, 1>(s, x, t);
  double* own = x + std::ptrdiff_t(s.first) * panel_width;
  for(int k = s.width - 1; k >= 0; --k) {
    Row sum, r, result;
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

inline void gram(const double* P, const double* W, std::ptrdiff_t rows, double* H)
{
  on_vector_units([&] { gram_body<Wide_panel_row>(P, W, rows, H); },
                  [&] { gram_body<Panel_row>(P, W, rows, H); });
}

inline void subtract_product(double* W, const double* P, std::ptrdiff_t rows, const double* H)
{
  on_vector_units([&] { subtract_product_body<Wide_panel_row>(W, P, rows, H); },
                  [&] { subtract_product_body<Panel_row>(W, P, rows, H); });
}

inline void multiply(const int* start, const int* column, const double* value, const double* x,
                     double* y, std::ptrdiff_t begin, std::ptrdiff_t end)
{
  on_vector_units([&] { multiply_body<Wide_panel_row>(start, column, value, x, y, begin, end); },
                  [&] { multiply_body<Panel_row>(start, column, value, x, y, begin, end); });
}

inline void multiply_block(double* C, std::ptrdiff_t c, int columns, const double* A,
                           std::ptrdiff_t a, const double* T, std::ptrdiff_t count,
                           std::ptrdiff_t rows, bool subtracted)
{
  on_vector_units(
      [&] { multiply_block_body<Wide_panel_row>(C, c, columns, A, a, T, count, rows, subtracted); },
      [&] { multiply_block_body<Panel_row>(C, c, columns, A, a, T, count, rows, subtracted); });
}

inline void forward(const Supernode& s, double* x)
{
  on_vector_units([&] { forward_body<Wide_panel_row>(s, x); },
                  [&] { forward_body<Panel_row>(s, x); });
}

inline void backward(const Supernode& s, double* x)
{
  on_vector_units([&] { backward_body<Wide_panel_row>(s, x); },
                  [&] { backward_body<Panel_row>(s, x); });
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_PANEL_KERNELS_H
