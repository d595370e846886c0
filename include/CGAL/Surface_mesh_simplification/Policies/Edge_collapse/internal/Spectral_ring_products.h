// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_RING_PRODUCTS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_RING_PRODUCTS_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_lanes.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_rings.h>

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
  for(std::size_t k = 0; k < length; k += 4) {
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
  void clear()
  {
    std::vector<double>().swap(m_data);
    m_degree = 0;
  }

  /// Forgets the neighbour at index i, which has left the ring.
  void erase(const std::size_t i)
  {
    Spectral_ring_products smaller;
    const std::size_t d = m_degree;
    smaller.resize(d - 1, m_full);
    const auto old = [i](const std::size_t j) { return j < i ? j : j + 1; };
    double* out = smaller.m_data.data();
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
    m_data.swap(smaller.m_data);
    m_degree = d - 1;
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
#ifdef CGAL_SPECTRAL_DISPATCH
    if(spectral_has_avx2())
      return compute_avx2(fields, c, products);
#endif
    compute_body(fields, c, products);
  }

  /// Only the products with R_c, and those with f and z of the neighbour at index `moved`.
  void update(const Spectral_fields& fields, const Spectral_slot c, Spectral_ring_products& products,
              const std::size_t moved)
  {
#ifdef CGAL_SPECTRAL_DISPATCH
    if(spectral_has_avx2())
      return update_avx2(fields, c, products, moved);
#endif
    update_body(fields, c, products, moved);
  }

private:
#ifdef CGAL_SPECTRAL_DISPATCH
  CGAL_SPECTRAL_AVX2 void compute_avx2(const Spectral_fields& fields, const Spectral_slot c,
                                       Spectral_ring_products& products)
  {
    compute_body(fields, c, products);
  }
  CGAL_SPECTRAL_AVX2 void update_avx2(const Spectral_fields& fields, const Spectral_slot c,
                                      Spectral_ring_products& products, const std::size_t moved)
  {
    update_body(fields, c, products, moved);
  }
#endif

  CGAL_SPECTRAL_INLINE void compute_body(const Spectral_fields& fields, const Spectral_slot c,
                                         Spectral_ring_products& products)
  {
    const std::size_t d = fields.rings[c].size(), length = std::size_t(fields.F.cols());
    const bool full = fields.theta != 0;
    products.resize(d, full);
    if(d == 0)
      return;
    set_rows(fields, c);
    const double* fc = fields.f_row(c);
    m_scratch.resize((d + 1) * length);
    m_g.resize(d);
    for(std::size_t j = 0; j < d; ++j) {
      double* g = m_scratch.data() + j * length;
      for(std::size_t k = 0; k < length; ++k)
        g[k] = m_f[j][k] - fc[k];
      m_g[j] = g;
    }
    const Spectral_row_list g{m_g.data(), d};
    spectral_dots<false, false>(g, g, length, products.g_rows(), d);
    dots_with_residual(fields, c, g, products);
    for(std::size_t j = 0; j < d; ++j)
      dots_with_z(fields, m_g[j], products.zg_rows() + j, d);
    for(std::size_t i = full ? 0 : d; i <= d; ++i)
      dots_with_z(fields, z_row(fields, i), products.zz_rows() + (full ? i * (d + 1) : 0), 1);
  }

  CGAL_SPECTRAL_INLINE void update_body(const Spectral_fields& fields, const Spectral_slot c,
                                        Spectral_ring_products& products, const std::size_t moved)
  {
    const std::size_t d = fields.rings[c].size(), length = std::size_t(fields.F.cols());
    set_rows(fields, c);
    m_scratch.resize((d + 1) * length);
    const Spectral_row_list g{m_f.data(), d, fields.f_row(c)};
    update_moved(fields, products, moved, g);
    dots_with_residual(fields, c, g, products);
  }

  // The column of the neighbour in all products, and its row where it is one.
  CGAL_SPECTRAL_INLINE void update_moved(const Spectral_fields& fields, Spectral_ring_products& products,
                                         const std::size_t moved, const Spectral_row_list& g)
  {
    const std::size_t d = products.degree(), length = std::size_t(fields.F.cols());
    double* gx = m_scratch.data();
    for(std::size_t k = 0; k < length; ++k)
      gx[k] = m_f[moved][k] - g.center[k];
    const double* row = gx;
    const Spectral_row_list x{&row, 1};
    spectral_dots<false, true>(x, g, length, products.g_rows() + moved * d, d);
    for(std::size_t j = 0; j < d; ++j)
      products.g_rows()[j * d + moved] = products.g_rows()[moved * d + j];
    dots_with_z(fields, gx, products.zg_rows() + moved, d);
    const double* z = z_row(fields, moved);
    spectral_dots<false, true>({&z, 1}, g, length, products.zg_rows() + moved * d, d);
    if(fields.theta == 0) {
      const double* left = fields.has_z_rows() ? m_z[d] : m_f[d];
      const double* right = fields.has_z_rows() ? z : times_lambda(fields, z, m_scaled);
      spectral_dots<false, false>({&left, 1}, {&right, 1}, length, products.zz_rows() + moved, 1);
      return;
    }
    dots_with_z(fields, z, products.zz_rows() + moved * (d + 1), 1);
    for(std::size_t j = 0; j <= d; ++j)
      products.zz_rows()[j * (d + 1) + moved] = products.zz_rows()[moved * (d + 1) + j];
  }

  // R_c . g_j, and R_c . z_c or R_c . z_j.
  CGAL_SPECTRAL_INLINE void dots_with_residual(const Spectral_fields& fields, const Spectral_slot c,
                                               const Spectral_row_list& g, Spectral_ring_products& products)
  {
    const std::size_t d = products.degree(), length = std::size_t(fields.F.cols());
    const double* r = fields.r_row(c);
    if(g.center != nullptr)
      spectral_dots<false, true>({&r, 1}, g, length, products.rg_row(), d);
    else
      spectral_dots<false, false>({&r, 1}, g, length, products.rg_row(), d);
    if(fields.theta != 0)
      return dots_with_z(fields, r, products.rz_row(), 1);
    const double* z = z_row(fields, d);
    spectral_dots<false, false>({&r, 1}, {&z, 1}, length, products.rz_row(), 1);
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

  // out[i * stride] = z_i . row over the ring and c. Where Z = F Lambda, z_i . row = f_i . (Lambda row): no row of Z
  // is formed.
  CGAL_SPECTRAL_INLINE void dots_with_z(const Spectral_fields& fields, const double* row, double* out,
                                        const std::size_t stride)
  {
    const std::size_t n = m_f.size(), length = std::size_t(fields.F.cols());
    const double* right = fields.has_z_rows() ? row : times_lambda(fields, row, m_scaled);
    const double* const* left = fields.has_z_rows() ? m_z.data() : m_f.data();
    spectral_dots<false, false>({left, n}, {&right, 1}, length, out, stride);
  }

  // z of a member of the ring; valid until the next call.
  CGAL_SPECTRAL_INLINE const double* z_row(const Spectral_fields& fields, const std::size_t i)
  {
    return fields.has_z_rows() ? m_z[i] : times_lambda(fields, m_f[i], m_scratch_z);
  }

  CGAL_SPECTRAL_INLINE static const double* times_lambda(const Spectral_fields& fields, const double* row,
                                                         std::vector<double>& result)
  {
    const std::size_t length = std::size_t(fields.F.cols());
    const double* lambda = fields.lambda.data();
    result.resize(length);
    for(std::size_t k = 0; k < length; ++k)
      result[k] = lambda[k] * row[k];
    return result.data();
  }

  std::vector<double> m_scratch, m_scratch_z, m_scaled;
  std::vector<const double*> m_f, m_z, m_g;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_RING_PRODUCTS_H
