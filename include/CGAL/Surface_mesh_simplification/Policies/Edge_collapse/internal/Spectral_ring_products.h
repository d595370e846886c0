// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_RING_PRODUCTS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_RING_PRODUCTS_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_lanes.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_rings.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// Rows a_i, or a_i - center where there is a center.
struct Spectral_row_list
{
  const double* const* rows;
  std::size_t size;
  const double* center = nullptr;
};

/// Row i of a result, `stride` after the one before.
struct Spectral_strided_rows
{
  double* first;
  std::size_t stride;
  double* operator()(const std::size_t i) const { return first + i * stride; }
};

/// Row i of a result that is kept in up to three places.
struct Spectral_three_rows
{
  double* row[3];
  double* operator()(const std::size_t i) const { return row[i]; }
};

// out(i)[j] = a_i . b_j for M rows and N columns; three by three keep nine sums in registers for six loads. Written
// out, because compilers keep small arrays of vectors in memory.
template <int M, int N, bool CenterA, bool CenterB, class Out>
CGAL_SPECTRAL_INLINE void spectral_dot_block(const double* const* a, const double* ca, const double* const* b,
                                             const double* cb, const std::size_t length, const Out& out,
                                             const std::size_t i, const std::size_t j)
{
  const double *a0 = a[0], *a1 = a[M > 1 ? 1 : 0], *a2 = a[M - 1];
  const double *b0 = b[0], *b1 = b[N > 1 ? 1 : 0], *b2 = b[N - 1];
  Spectral_lanes s00 = {}, s01 = {}, s02 = {}, s10 = {}, s11 = {}, s12 = {}, s20 = {}, s21 = {}, s22 = {};
  const auto step = [&](const std::size_t k) {
    Spectral_lanes x0, x1, x2, y, c = {};
    spectral_load(x0, a0 + k);
    if(M > 1)
      spectral_load(x1, a1 + k);
    if(M > 2)
      spectral_load(x2, a2 + k);
    if(CenterA) {
      spectral_load(c, ca + k);
      x0 -= c;
      if(M > 1)
        x1 -= c;
      if(M > 2)
        x2 -= c;
    }
    if(CenterB)
      spectral_load(c, cb + k);
    spectral_load(y, b0 + k);
    if(CenterB)
      y -= c;
    s00 += x0 * y;
    if(M > 1)
      s10 += x1 * y;
    if(M > 2)
      s20 += x2 * y;
    if(N > 1) {
      spectral_load(y, b1 + k);
      if(CenterB)
        y -= c;
      s01 += x0 * y;
      if(M > 1)
        s11 += x1 * y;
      if(M > 2)
        s21 += x2 * y;
    }
    if(N > 2) {
      spectral_load(y, b2 + k);
      if(CenterB)
        y -= c;
      s02 += x0 * y;
      if(M > 1)
        s12 += x1 * y;
      if(M > 2)
        s22 += x2 * y;
    }
  };
  for(std::size_t k = 0; k < length; k += 8) { // rows are padded to a multiple of that
    step(k);
    step(k + 4);
  }
  const auto write = [&](const std::size_t row, const Spectral_lanes& s0, const Spectral_lanes& s1,
                         const Spectral_lanes& s2) {
    double* result = out(row) + j;
    result[0] = spectral_sum(s0);
    if(N > 1)
      result[1] = spectral_sum(s1);
    if(N > 2)
      result[2] = spectral_sum(s2);
  };
  write(i, s00, s01, s02);
  if(M > 1)
    write(i + 1, s10, s11, s12);
  if(M > 2)
    write(i + 2, s20, s21, s22);
}

template <int M, bool CenterA, bool CenterB, class Out>
CGAL_SPECTRAL_INLINE void spectral_dot_rows(const Spectral_row_list& a, const std::size_t i,
                                            const Spectral_row_list& b, const std::size_t length,
                                            const Out& out)
{
  const double* const* rows = a.rows + i;
  std::size_t j = 0;
  for(; j + 3 <= b.size; j += 3)
    spectral_dot_block<M, 3, CenterA, CenterB>(rows, a.center, b.rows + j, b.center, length, out, i, j);
  if(b.size - j == 2)
    spectral_dot_block<M, 2, CenterA, CenterB>(rows, a.center, b.rows + j, b.center, length, out, i, j);
  else if(b.size - j == 1)
    spectral_dot_block<M, 1, CenterA, CenterB>(rows, a.center, b.rows + j, b.center, length, out, i, j);
}

/// out(i)[j] = a_i . b_j for rows of the given padded length.
template <bool CenterA, bool CenterB, class Out>
CGAL_SPECTRAL_INLINE void spectral_dots(const Spectral_row_list& a, const Spectral_row_list& b,
                                        const std::size_t length, const Out& out)
{
  std::size_t i = 0;
  for(; i + 3 <= a.size; i += 3)
    spectral_dot_rows<3, CenterA, CenterB>(a, i, b, length, out);
  if(a.size - i == 2)
    spectral_dot_rows<2, CenterA, CenterB>(a, i, b, length, out);
  else if(a.size - i == 1)
    spectral_dot_rows<1, CenterA, CenterB>(a, i, b, length, out);
}

/// The same with out[i * stride + j].
template <bool CenterA, bool CenterB>
CGAL_SPECTRAL_INLINE void spectral_dots(const Spectral_row_list& a, const Spectral_row_list& b,
                                        const std::size_t length, double* out, const std::size_t stride)
{
  spectral_dots<CenterA, CenterB>(a, b, length, Spectral_strided_rows{out, stride});
}

// out[i] = rows[i] . y for M rows.
template <int M>
CGAL_SPECTRAL_INLINE void spectral_dot_block_with(const double* const* rows, const double* y,
                                                  const std::size_t length, double* out)
{
  const double *a0 = rows[0], *a1 = rows[M > 1 ? 1 : 0], *a2 = rows[M > 2 ? 2 : 0], *a3 = rows[M > 3 ? 3 : 0];
  Spectral_lanes s0 = {}, s1 = {}, s2 = {}, s3 = {};
  const auto step = [&](const std::size_t k) {
    Spectral_lanes c, x;
    spectral_load(c, y + k);
    spectral_load(x, a0 + k);
    s0 += x * c;
    if(M > 1) {
      spectral_load(x, a1 + k);
      s1 += x * c;
    }
    if(M > 2) {
      spectral_load(x, a2 + k);
      s2 += x * c;
    }
    if(M > 3) {
      spectral_load(x, a3 + k);
      s3 += x * c;
    }
  };
  for(std::size_t k = 0; k < length; k += 8) {
    step(k);
    step(k + 4);
  }
  out[0] = spectral_sum(s0);
  if(M > 1)
    out[1] = spectral_sum(s1);
  if(M > 2)
    out[2] = spectral_sum(s2);
  if(M > 3)
    out[3] = spectral_sum(s3);
}

/// out[i] = rows[i] . y, four rows at a time.
CGAL_SPECTRAL_INLINE void spectral_dots_with(const double* const* rows, const std::size_t n, const double* y,
                                             const std::size_t length, double* out)
{
  std::size_t i = 0;
  for(; i + 4 <= n; i += 4)
    spectral_dot_block_with<4>(rows + i, y, length, out + i);
  if(n - i == 3)
    spectral_dot_block_with<3>(rows + i, y, length, out + i);
  else if(n - i == 2)
    spectral_dot_block_with<2>(rows + i, y, length, out + i);
  else if(n - i == 1)
    spectral_dot_block_with<1>(rows + i, y, length, out + i);
}

/*!
 * Inner products in the ring of a vertex c with neighbours n_0 .. n_(d-1): of the differences g_j = f_j - f_c, and of
 * the rows of Z of the neighbours and, at index d, of c itself, and of R_c.
 *
 * Every residual row that a collapse changes is a combination of such vectors whose coefficients depend on
 * geometry alone. With the products at hand a candidate costs no work over K, except for the few pairs that lie
 * across its edge and, for each vertex of its link next to one end only, the product of R there with the other end. All
 * products with R of the neighbours could be kept as well, but then a collapse changes those of the rings around its
 * own: measured, that is no faster, even where they are updated only when they are asked for.
 */
class Spectral_ring_products
{
public:
  /// `full`: all of Z Z^T in the ring and R_c Z^T, which a mass with off-diagonal entries needs.
  void resize(const std::size_t degree, const bool full)
  {
    m_degree = degree;
    m_full = full;
    const std::size_t d = degree;
    m_data.resize((2 * d + 2) * d + (full ? (d + 2) * (d + 1) : d + 2));
  }
  /// Keeps nothing, for a ring that is too large.
  void clear()
  {
    std::vector<double>().swap(m_data);
    m_degree = 0;
  }
  /// Of the ring of a vertex that is gone, which no longer needs its memory.
  void take_memory(Spectral_ring_products& gone)
  {
    if(gone.m_data.capacity() > m_data.capacity())
      m_data.swap(gone.m_data);
    gone.clear();
  }

  /// Forgets the neighbour at index i, which has left the ring. What stays moves towards the front.
  void erase(const std::size_t i)
  {
    const std::size_t d = m_degree;
    const auto old = [i](const std::size_t j) { return j < i ? j : j + 1; };
    double* out = m_data.data();
    for(std::size_t r = 0; r + 1 < d; ++r)
      for(std::size_t j = 0; j + 1 < d; ++j)
        *out++ = gg(old(r), old(j));
    for(std::size_t r = 0; r < d; ++r)
      for(std::size_t j = 0; j + 1 < d; ++j)
        *out++ = zg(old(r), old(j));
    for(std::size_t j = 0; j + 1 < d; ++j)
      *out++ = rg(old(j));
    for(std::size_t r = m_full ? 0 : d - 1; r < d; ++r)
      for(std::size_t j = 0; j < d; ++j)
        *out++ = zz(old(r), old(j));
    for(std::size_t j = m_full ? 0 : d - 1; j < d; ++j)
      *out++ = rz(old(j));
    resize(d - 1, m_full);
  }

  std::size_t degree() const { return m_degree; } ///< also the index of the centre among rows of Z

  double gg(const std::size_t i, const std::size_t j) const { return m_data[i * m_degree + j]; }
  double zg(const std::size_t i, const std::size_t j) const { return m_data[(m_degree + i) * m_degree + j]; }
  /// R_c . g_j
  double rg(const std::size_t j) const { return m_data[(2 * m_degree + 1) * m_degree + j]; }
  /// z_i . z_j; only i = degree() unless full
  double zz(const std::size_t i, const std::size_t j) const
  {
    return m_data[zz_offset() + (m_full ? i * (m_degree + 1) : 0) + j];
  }
  /// R_c . z_j; only j = degree() unless full
  double rz(const std::size_t j) const { return m_data[rz_offset() + (m_full ? j : 0)]; }

  /// The same numbers by rows, for who reads many of them: `g(i)[j]` is gg(i, j), and so on.
  struct View
  {
    const double *gg, *zg, *rg, *zz, *rz;
    std::size_t d, zz_stride;
    const double* g(const std::size_t i) const { return gg + i * d; }
    const double* z_g(const std::size_t i) const { return zg + i * d; }
    const double* z(const std::size_t i) const { return zz + i * zz_stride; } ///< only i = d unless full
  };
  View view() const
  {
    const double* const p = m_data.data();
    const std::size_t d = m_degree;
    return View{p, p + d * d, p + (2 * d + 1) * d, p + zz_offset(), p + rz_offset(), d, m_full ? d + 1 : 0};
  }

  double* g_rows() { return m_data.data(); } ///< rows of d, as those of zg
  double* zg_rows() { return m_data.data() + m_degree * m_degree; }
  double* rg_row() { return m_data.data() + (2 * m_degree + 1) * m_degree; }
  double* zz_rows() { return m_data.data() + zz_offset(); }
  double* rz_row() { return m_data.data() + rz_offset(); }

private:
  std::size_t zz_offset() const { return (2 * m_degree + 2) * m_degree; }
  std::size_t rz_offset() const { return zz_offset() + (m_degree + 1) * (m_full ? m_degree + 1 : 1); }

  std::vector<double> m_data;
  std::size_t m_degree = 0;
  bool m_full = false;
};

/// Computes `Spectral_ring_products` from the rows; holds the scratch memory of one thread.
class Spectral_ring_product_builder
{
public:
  /// All products of the ring of c.
  void compute(const Spectral_fields& fields, const Spectral_slot c, Spectral_ring_products& products)
  {
    Spectral_geometry::internal::on_vector_units([&] { compute_body(fields, c, products); });
  }

  /// Only the products with R_c, and those with f and z of the neighbour at index `moved`.
  void update(const Spectral_fields& fields, const Spectral_slot c, Spectral_ring_products& products,
              const std::size_t moved)
  {
    Spectral_geometry::internal::on_vector_units([&] { update_body(fields, c, products, moved); });
  }

private:
  CGAL_SPECTRAL_INLINE void compute_body(const Spectral_fields& fields, const Spectral_slot c,
                                         Spectral_ring_products& products)
  {
    const std::size_t d = fields.rings[c].size(), length = std::size_t(fields.F.cols());
    const bool full = fields.theta != 0;
    products.resize(d, full);
    if(d == 0)
      return;
    set_rows(fields, c);
    const double *fc = fields.f_row(c), *r = fields.r_row(c);
    double* next = m_scratch.at_least((4 * d + 4) * length);
    m_g.resize(d);
    m_right.resize(d);
    for(std::size_t j = 0; j < d; ++j) {
      double* g = next;
      next += length;
      spectral_subtract_rows(m_f[j], fc, length, g);
      m_g[j] = g;
      m_right[j] = against_z(fields, g, next);
    }
    const Spectral_row_list g{m_g.data(), d}, z{left_of_z(), d + 1};
    for(std::size_t i = 0; i < d; i += 3) {
      const std::size_t rows = (std::min)(d - i, std::size_t(3));
      spectral_dots<false, false>({m_g.data() + i, rows}, {m_g.data() + i, d - i}, length,
                                  products.g_rows() + i * d + i, d);
    }
    for(std::size_t i = 0; i < d; ++i)
      for(std::size_t j = i + 1; j < d; ++j)
        products.g_rows()[j * d + i] = products.g_rows()[i * d + j];
    spectral_dots<false, false>({&r, 1}, g, length, products.rg_row(), d);
    spectral_dots<false, false>(z, {m_right.data(), d}, length, products.zg_rows(), d);
    const double* right = against_z(fields, r, next);
    if(!full) {
      spectral_dots<false, false>({&right, 1}, {z.rows + d, 1}, length, products.rz_row(), 1);
      right = against_z(fields, z_row(fields, d, next), next);
      spectral_dots<false, false>({&right, 1}, z, length, products.zz_rows(), d + 1);
      return;
    }
    spectral_dots<false, false>({&right, 1}, z, length, products.rz_row(), d + 1);
    m_right.resize(d + 1);
    for(std::size_t i = 0; i <= d; ++i)
      m_right[i] = against_z(fields, z_row(fields, i, next), next);
    spectral_dots<false, false>(z, {m_right.data(), d + 1}, length, products.zz_rows(), d + 1);
  }

  // The products with R_c, and the column of the neighbour in all others, with its row where it is one.
  CGAL_SPECTRAL_INLINE void update_body(const Spectral_fields& fields, const Spectral_slot c,
                                        Spectral_ring_products& products, const std::size_t moved)
  {
    const std::size_t d = products.degree(), length = std::size_t(fields.F.cols());
    set_rows(fields, c);
    double *next = m_scratch.at_least(5 * length + d + 1), *gx = next;
    next += length;
    const Spectral_row_list g{m_f.data(), d, fields.f_row(c)}, z{left_of_z(), d + 1};
    spectral_subtract_rows(m_f[moved], g.center, length, gx);
    const double* const rows[3] = {gx, fields.r_row(c), z_row(fields, moved, next)};
    double* const gg = products.g_rows() + moved * d;
    spectral_dots<false, true>({rows, 3}, g, length,
                               Spectral_three_rows{{gg, products.rg_row(), products.zg_rows() + moved * d}});
    for(std::size_t j = 0; j < d; ++j)
      products.g_rows()[j * d + moved] = gg[j];

    const double* const right[3] = {against_z(fields, rows[0], next), against_z(fields, rows[1], next),
                                    against_z(fields, rows[2], next)};
    double* const zg = next;
    if(fields.theta == 0) {
      spectral_dots<false, false>({right, 1}, z, length, zg, d + 1);
      spectral_dots<false, false>({right + 1, 2}, {z.rows + d, 1}, length,
                                  Spectral_three_rows{{products.rz_row(), products.zz_rows() + moved}});
    } else {
      double* const zz = products.zz_rows() + moved * (d + 1);
      spectral_dots<false, false>({right, 3}, z, length, Spectral_three_rows{{zg, products.rz_row(), zz}});
      for(std::size_t j = 0; j <= d; ++j)
        products.zz_rows()[j * (d + 1) + moved] = zz[j];
    }
    for(std::size_t j = 0; j <= d; ++j)
      products.zg_rows()[j * d + moved] = zg[j];
  }

  // Rows of F, and of Z if stored: the neighbours, then c.
  CGAL_SPECTRAL_INLINE void set_rows(const Spectral_fields& fields, const Spectral_slot c)
  {
    const Spectral_ring& ring = fields.rings[c];
    const std::size_t n = ring.size() + 1;
    m_f.resize(n);
    m_z.resize(fields.has_z_rows() ? n : 0);
    for(std::size_t i = 0; i < n; ++i) {
      const Spectral_slot s = i + 1 < n ? ring[i].vertex : c;
      m_f[i] = fields.f_row(s);
      if(fields.has_z_rows())
        m_z[i] = fields.z_row(s);
    }
  }

  // z_i . row is the product of left_of_z()[i] and against_z(row): where Z = F Lambda that of f_i and Lambda row, and no row
  // of Z is formed. What is formed is put at `next`, which goes on behind it.
  const double* const* left_of_z() const { return m_z.empty() ? m_f.data() : m_z.data(); }

  CGAL_SPECTRAL_INLINE static const double* against_z(const Spectral_fields& fields, const double* row,
                                                      double*& next)
  {
    return fields.has_z_rows() ? row : times_lambda(fields, row, next);
  }

  // z of a member of the ring.
  CGAL_SPECTRAL_INLINE const double* z_row(const Spectral_fields& fields, const std::size_t i,
                                           double*& next) const
  {
    return fields.has_z_rows() ? m_z[i] : times_lambda(fields, m_f[i], next);
  }

  CGAL_SPECTRAL_INLINE static const double* times_lambda(const Spectral_fields& fields, const double* row,
                                                         double*& next)
  {
    const std::size_t length = std::size_t(fields.F.cols());
    double* const result = next;
    next += length;
    spectral_multiply_rows(fields.lambda.data(), row, length, result);
    return result;
  }

  Aligned_buffer m_scratch;
  std::vector<const double*> m_f, m_z, m_g, m_right;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_RING_PRODUCTS_H
