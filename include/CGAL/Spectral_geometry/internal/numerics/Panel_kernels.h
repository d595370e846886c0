// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_PANEL_KERNELS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_PANEL_KERNELS_H

#include <CGAL/Spectral_geometry/internal/numerics/vector_units.h>

#include <boost/align/aligned_alloc.hpp>
#include <boost/align/aligned_delete.hpp>

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

#ifdef CGAL_SPECTRAL_VECTOR_EXTENSION
/// What rows of a panel are made of: a type as template argument would lose its alignment.
struct Wide_units
{
  using Vector = Four_doubles;
};
struct Baseline_units
{
  using Vector = Two_doubles;
};
#else
struct Baseline_units
{
  using Vector = double;
};
#endif

/// One row of a panel in registers.
template <class Units>
struct Row_of
{
  using Vector = typename Units::Vector;
  static constexpr int size = int(panel_width * sizeof(double) / sizeof(Vector));
  Vector part[size];
};

template <class Units>
CGAL_SPECTRAL_INLINE void load(Row_of<Units>& x, const double* p)
{
  using Vector = typename Units::Vector;
  for(int k = 0; k < x.size; ++k)
    x.part[k] = reinterpret_cast<const Vector*>(p)[k];
}

template <class Units>
CGAL_SPECTRAL_INLINE void store(double* p, const Row_of<Units>& x)
{
  using Vector = typename Units::Vector;
  for(int k = 0; k < x.size; ++k)
    reinterpret_cast<Vector*>(p)[k] = x.part[k];
}

/// y += a x.
template <class Units>
CGAL_SPECTRAL_INLINE void add(Row_of<Units>& y, double a, const Row_of<Units>& x)
{
  for(int k = 0; k < x.size; ++k)
    y.part[k] += a * x.part[k];
}

template <class Units>
CGAL_SPECTRAL_INLINE void subtract(Row_of<Units>& y, double a, const Row_of<Units>& x)
{
  for(int k = 0; k < x.size; ++k)
    y.part[k] -= a * x.part[k];
}

/// y += a x, entry by entry.
template <class Units>
CGAL_SPECTRAL_INLINE void add(Row_of<Units>& y, const Row_of<Units>& a, const Row_of<Units>& x)
{
  for(int k = 0; k < x.size; ++k)
    y.part[k] += a.part[k] * x.part[k];
}

/// Calls `kernel` with a row, of the kind that the machine is good at. On Clang it is inlined where
/// it is marked CGAL_SPECTRAL_INLINE_LAMBDA.
template <class Kernel>
void on_rows(const Kernel& kernel)
{
#ifdef CGAL_SPECTRAL_VECTOR_EXTENSION
  on_vector_units([&]() CGAL_SPECTRAL_INLINE_LAMBDA { kernel(Row_of<Wide_units>{}); },
                  [&] { kernel(Row_of<Baseline_units>{}); });
#else
  kernel(Row_of<Baseline_units>{});
#endif
}

/// H += P^T W over some rows; four columns of P at once fill the registers.
inline void gram(const double* P, const double* W, std::ptrdiff_t rows, double* H)
{
  on_rows([=](const auto& kind) CGAL_SPECTRAL_INLINE_LAMBDA {
    using Row = std::decay_t<decltype(kind)>;
    for(int half = 0; half < panel_width; half += 4) {
      Row x, sum[4];
      for(int c = 0; c < 4; ++c)
        load(sum[c], H + (half + c) * panel_width);
      const double* p = P + half;
      const double* w = W;
      for(std::ptrdiff_t i = 0; i < rows; ++i, p += panel_width, w += panel_width) {
        load(x, w);
        for(int c = 0; c < 4; ++c)
          add(sum[c], p[c], x);
      }
      for(int c = 0; c < 4; ++c)
        store(H + (half + c) * panel_width, sum[c]);
    }
  });
}

/// W -= P H over some rows.
inline void subtract_product(double* W, const double* P, std::ptrdiff_t rows, const double* H)
{
  on_rows([=](const auto& kind) CGAL_SPECTRAL_INLINE_LAMBDA {
    using Row = std::decay_t<decltype(kind)>;
    for(int half = 0; half < panel_width; half += 4) {
      Row x, h[4];
      for(int c = 0; c < 4; ++c)
        load(h[c], H + (half + c) * panel_width);
      const double* p = P + half;
      double* w = W;
      for(std::ptrdiff_t i = 0; i < rows; ++i, p += panel_width, w += panel_width) {
        load(x, w);
        for(int c = 0; c < 4; ++c)
          subtract(x, p[c], h[c]);
        store(w, x);
      }
    }
  });
}

/// y = A x for the rows begin .. end - 1 of a sparse matrix A, stored by rows in `start`, `column`
/// and `value`.
inline void multiply(const int* start, const int* column, const double* value, const double* x,
                     double* y, std::ptrdiff_t begin, std::ptrdiff_t end)
{
  on_rows([=](const auto& kind) CGAL_SPECTRAL_INLINE_LAMBDA {
    using Row = std::decay_t<decltype(kind)>;
    for(std::ptrdiff_t i = begin; i < end; ++i) {
      Row sum{}, r;
      for(int p = start[i]; p < start[i + 1]; ++p) {
        load(r, x + std::ptrdiff_t(column[p]) * panel_width);
        add(sum, value[p], r);
      }
      store(y + i * panel_width, sum);
    }
  });
}

// multiply_block() for `Count` rows, which share every access to T.
template <class Row, int Count>
CGAL_SPECTRAL_INLINE void multiply_rows(double* C, std::ptrdiff_t c, int columns, const double* A,
                                        std::ptrdiff_t a, const double* T, std::ptrdiff_t count,
                                        bool subtracted)
{
  Row sum[Count] = {}, t;
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

/// C = A T over some rows (C may be A itself), or C -= A T if `subtracted`. T has `count` rows of
/// eight numbers, zeros beyond the `columns` of C. Rows of C and A lie `c` and `a` numbers apart.
inline void multiply_block(double* C, std::ptrdiff_t c, int columns, const double* A,
                           std::ptrdiff_t a, const double* T, std::ptrdiff_t count,
                           std::ptrdiff_t rows, bool subtracted)
{
  on_rows([=](const auto& kind) CGAL_SPECTRAL_INLINE_LAMBDA {
    using Row = std::decay_t<decltype(kind)>;
    std::ptrdiff_t i = 0;
    for(; i + 4 <= rows; i += 4)
      multiply_rows<Row, 4>(C + i * c, c, columns, A + i * a, a, T, count, subtracted);
    for(; i < rows; ++i)
      multiply_rows<Row, 1>(C + i * c, c, columns, A + i * a, a, T, count, subtracted);
  });
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

/// Solves for the supernode's columns and takes them off the rows below.
inline void forward(const Supernode& s, double* x)
{
  on_rows([=](const auto& kind) CGAL_SPECTRAL_INLINE_LAMBDA {
    using Row = std::decay_t<decltype(kind)>;
    double* own = x + std::ptrdiff_t(s.first) * panel_width; // rows of the panel
    for(int k = 0; k < s.width; ++k) {
      const double* l = s.L + std::ptrdiff_t(k) * s.width;
      Row sum, r, result{};
      load(sum, own + k * panel_width);
      for(int t = 0; t < k; ++t) {
        load(r, own + t * panel_width);
        subtract(sum, l[t], r);
      }
      add(result, l[k], sum);
      store(own + k * panel_width, result);
    }
    int i = 0;
    for(; i + 4 <= s.below; i += 4)
      forward_rows<Row, 4>(s, own, x, i);
    for(; i < s.below; ++i)
      forward_rows<Row, 1>(s, own, x, i);
  });
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

/// Takes the rows below off the supernode's columns and solves for these.
inline void backward(const Supernode& s, double* x)
{
  on_rows([=](const auto& kind) CGAL_SPECTRAL_INLINE_LAMBDA {
    using Row = std::decay_t<decltype(kind)>;
    int t = 0;
    for(; t + 4 <= s.width; t += 4)
      backward_columns<Row, 4>(s, x, t);
    for(; t < s.width; ++t)
      backward_columns<Row, 1>(s, x, t);
    double* own = x + std::ptrdiff_t(s.first) * panel_width;
    for(int k = s.width - 1; k >= 0; --k) {
      Row sum, r, result{};
      load(sum, own + k * panel_width);
      for(int q = k + 1; q < s.width; ++q) {
        load(r, own + q * panel_width);
        subtract(sum, s.L[std::ptrdiff_t(q) * s.width + k], r);
      }
      add(result, s.L[std::ptrdiff_t(k) * s.width + k], sum);
      store(own + k * panel_width, result);
    }
  });
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_PANEL_KERNELS_H
