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

// out[i * stride + j] = a_i . b_j. Two rows by three keep six sums in registers for five loads.
template <int M, int N>
CGAL_SPECTRAL_INLINE void spectral_dot_block(const double* const* a, const double* const* b,
                                             const std::size_t length, double* out, const std::size_t stride)
{
  // Written out so that the sums live in registers: compilers keep small arrays in memory here.
  const double *a0 = a[0], *a1 = a[M - 1], *b0 = b[0], *b1 = b[N > 1 ? 1 : 0], *b2 = b[N - 1];
  Spectral_lanes s00 = {}, s01 = {}, s02 = {}, s10 = {}, s11 = {}, s12 = {};
  for(std::size_t k = 0; k < length; k += 4) {
    Spectral_lanes x0, x1, y;
    spectral_load(x0, a0 + k);
    if(M > 1)
      spectral_load(x1, a1 + k);
    spectral_load(y, b0 + k);
    s00 += x0 * y;
    if(M > 1)
      s10 += x1 * y;
    if(N > 1) {
      spectral_load(y, b1 + k);
      s01 += x0 * y;
      if(M > 1)
        s11 += x1 * y;
    }
    if(N > 2) {
      spectral_load(y, b2 + k);
      s02 += x0 * y;
      if(M > 1)
        s12 += x1 * y;
    }
  }
  out[0] = spectral_sum(s00);
  if(N > 1)
    out[1] = spectral_sum(s01);
  if(N > 2)
    out[2] = spectral_sum(s02);
  if(M > 1) {
    out[stride] = spectral_sum(s10);
    if(N > 1)
      out[stride + 1] = spectral_sum(s11);
    if(N > 2)
      out[stride + 2] = spectral_sum(s12);
  }
}

/// out[i * stride + j] = a_i . b_j for m rows a and n rows b of the given padded length.
CGAL_SPECTRAL_INLINE void spectral_dots_body(const double* const* a, const std::size_t m,
                                             const double* const* b, const std::size_t n,
                                             const std::size_t length, double* out, const std::size_t stride)
{
  for(std::size_t j = 0; j < n;) {
    const std::size_t columns = n - j >= 3 ? 3 : n - j;
    for(std::size_t i = 0; i < m;) {
      const std::size_t rows = m - i >= 2 ? 2 : 1;
      double* block = out + i * stride + j;
      if(rows == 2 && columns == 3)
        spectral_dot_block<2, 3>(a + i, b + j, length, block, stride);
      else if(rows == 2 && columns == 2)
        spectral_dot_block<2, 2>(a + i, b + j, length, block, stride);
      else if(rows == 2)
        spectral_dot_block<2, 1>(a + i, b + j, length, block, stride);
      else if(columns == 3)
        spectral_dot_block<1, 3>(a + i, b + j, length, block, stride);
      else if(columns == 2)
        spectral_dot_block<1, 2>(a + i, b + j, length, block, stride);
      else
        spectral_dot_block<1, 1>(a + i, b + j, length, block, stride);
      i += rows;
    }
    j += columns;
  }
}

/*!
 * Inner products in the ring of a vertex c with neighbours n_0 .. n_(d-1): of the differences g_j = f_j - f_c, and of
 * the rows of Z and R of the neighbours and, at index d, of c itself.
 *
 * Every residual row that a collapse changes is a combination of such vectors whose coefficients depend on
 * geometry alone. With the products at hand a candidate costs no work over K, except for the few pairs that lie
 * across its edge; keeping them up costs as much as a handful of evaluations per collapse.
 */
class Spectral_ring_products
{
public:
  /// `full`: all of Z Z^T and R Z^T in the ring, which a mass with off-diagonal entries needs.
  void resize(const std::size_t degree, const bool full)
  {
    m_degree = degree;
    m_full = full;
    const std::size_t d = degree;
    m_data.resize((3 * d + 2) * d + (full ? 2 * (d + 1) * (d + 1) : d + 2));
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
    for(std::size_t family = 0; family < 3; ++family)
      for(std::size_t r = 0; r < (family == 0 ? d - 1 : d); ++r)
        for(std::size_t j = 0; j + 1 < d; ++j)
          *out++ = family == 0 ? gg(old(r), old(j)) : family == 1 ? zg(old(r), old(j)) : rg(old(r), old(j));
    for(std::size_t r = m_full ? 0 : d - 1; r < d; ++r)
      for(std::size_t j = 0; j < d; ++j)
        *out++ = zz(old(r), old(j));
    for(std::size_t r = m_full ? 0 : d - 1; r < d; ++r)
      for(std::size_t j = m_full ? 0 : d - 1; j < d; ++j)
        *out++ = rz(old(r), old(j));
    m_data.swap(smaller.m_data);
    m_degree = d - 1;
  }

  std::size_t degree() const { return m_degree; } ///< also the index of the centre among rows of Z and R

  double gg(const std::size_t i, const std::size_t j) const { return m_data[i * m_degree + j]; }
  double zg(const std::size_t i, const std::size_t j) const { return m_data[(m_degree + i) * m_degree + j]; }
  double rg(const std::size_t i, const std::size_t j) const
  {
    return m_data[(2 * m_degree + 1 + i) * m_degree + j];
  }
  /// z_i . z_j; only i = degree() unless full
  double zz(const std::size_t i, const std::size_t j) const
  {
    return m_data[zz_offset() + (m_full ? i * (m_degree + 1) : 0) + j];
  }
  /// R_i . z_j; only i = j = degree() unless full
  double rz(const std::size_t i, const std::size_t j) const
  {
    return m_data[rz_offset() + (m_full ? i * (m_degree + 1) + j : 0)];
  }

  double* g_rows() { return m_data.data(); } ///< 3 d + 2 rows of d: gg, zg, rg
  double* rg_row(const std::size_t i) { return m_data.data() + (2 * m_degree + 1 + i) * m_degree; }
  double* zz_rows() { return m_data.data() + zz_offset(); }
  double* rz_rows() { return m_data.data() + rz_offset(); }

private:
  std::size_t zz_offset() const { return (3 * m_degree + 2) * m_degree; }
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

  /// Only the products with R_i, for the ring indices i with `changed(i)`, where i = degree is c itself, and those
  /// with f and z of the neighbour at index `moved`, unless that is the degree.
  template <class Changed>
  void update(const Spectral_fields& fields, const Spectral_slot c, Spectral_ring_products& products,
              const std::size_t moved, const Changed& changed)
  {
    m_changed.clear();
    for(std::size_t i = 0; i <= products.degree(); ++i)
      if(changed(i))
        m_changed.push_back(i);
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
    const Spectral_ring& ring = fields.rings[c];
    const std::size_t d = ring.size(), length = std::size_t(fields.F.cols());
    const bool full = fields.theta != 0;
    products.resize(d, full);
    if(d == 0)
      return;
    set_differences(fields, c);
    set_z_rows(fields, c);
    set_rows(fields, c);
    spectral_dots_body(m_rows.data(), m_rows.size(), m_g.data(), d, length, products.g_rows(), d);
    const double* const* r = m_rows.data() + 2 * d + 1;
    if(full) {
      spectral_dots_body(m_z.data(), d + 1, m_z.data(), d + 1, length, products.zz_rows(), d + 1);
      spectral_dots_body(r, d + 1, m_z.data(), d + 1, length, products.rz_rows(), d + 1);
    } else {
      spectral_dots_body(&m_z[d], 1, m_z.data(), d + 1, length, products.zz_rows(), d + 1);
      spectral_dots_body(r + d, 1, &m_z[d], 1, length, products.rz_rows(), 1);
    }
  }

  CGAL_SPECTRAL_INLINE void update_body(const Spectral_fields& fields, const Spectral_slot c,
                                        Spectral_ring_products& products, const std::size_t moved)
  {
    const Spectral_ring& ring = fields.rings[c];
    const std::size_t d = ring.size(), length = std::size_t(fields.F.cols());
    const bool full = fields.theta != 0, has_moved = moved < d;
    set_differences(fields, c);
    if(full || has_moved || (!m_changed.empty() && m_changed.back() == d))
      set_z_rows(fields, c);
    for(const std::size_t i : m_changed) {
      const double* r = fields.r_row(i == d ? c : ring[i].vertex);
      spectral_dots_body(&r, 1, m_g.data(), d, length, products.rg_row(i), d);
      if(full)
        spectral_dots_body(&r, 1, m_z.data(), d + 1, length, products.rz_rows() + i * (d + 1), d + 1);
      else if(i == d)
        spectral_dots_body(&r, 1, &m_z[d], 1, length, products.rz_rows(), 1);
    }
    if(has_moved)
      update_moved(fields, c, products, moved);
  }

  // The column of the neighbour in all products, and its row where it is one.
  CGAL_SPECTRAL_INLINE void update_moved(const Spectral_fields& fields, const Spectral_slot c,
                                         Spectral_ring_products& products, const std::size_t moved)
  {
    const std::size_t d = products.degree(), length = std::size_t(fields.F.cols());
    set_rows(fields, c);
    spectral_dots_body(m_rows.data(), m_rows.size(), &m_g[moved], 1, length, products.g_rows() + moved, d);
    spectral_dots_body(&m_g[moved], 1, m_g.data(), d, length, products.g_rows() + moved * d, d);
    spectral_dots_body(&m_z[moved], 1, m_g.data(), d, length, products.g_rows() + (d + moved) * d, d);
    if(fields.theta != 0) {
      spectral_dots_body(&m_z[moved], 1, m_z.data(), d + 1, length, products.zz_rows() + moved * (d + 1),
                         d + 1);
      spectral_dots_body(m_z.data(), d + 1, &m_z[moved], 1, length, products.zz_rows() + moved, d + 1);
      spectral_dots_body(m_rows.data() + 2 * d + 1, d + 1, &m_z[moved], 1, length, products.rz_rows() + moved,
                         d + 1);
    } else
      spectral_dots_body(&m_z[d], 1, &m_z[moved], 1, length, products.zz_rows() + moved, 1);
  }

  // m_rows: the differences, then z and R of the ring and of c.
  CGAL_SPECTRAL_INLINE void set_rows(const Spectral_fields& fields, const Spectral_slot c)
  {
    m_rows.assign(m_g.begin(), m_g.end());
    m_rows.insert(m_rows.end(), m_z.begin(), m_z.end());
    for(const Spectral_ring_entry& e : fields.rings[c])
      m_rows.push_back(fields.r_row(e.vertex));
    m_rows.push_back(fields.r_row(c));
  }

  // m_g[j] points to f_j - f_c.
  CGAL_SPECTRAL_INLINE void set_differences(const Spectral_fields& fields, const Spectral_slot c)
  {
    const Spectral_ring& ring = fields.rings[c];
    const std::size_t d = ring.size(), length = std::size_t(fields.F.cols());
    m_scratch_g.resize(d * length);
    m_g.resize(d);
    const double* fc = fields.f_row(c);
    for(std::size_t j = 0; j < d; ++j) {
      const double* f = fields.f_row(ring[j].vertex);
      double* g = m_scratch_g.data() + j * length;
      for(std::size_t k = 0; k < length; ++k)
        g[k] = f[k] - fc[k];
      m_g[j] = g;
    }
  }

  // m_z[j] points to z_j, m_z[d] to z_c.
  CGAL_SPECTRAL_INLINE void set_z_rows(const Spectral_fields& fields, const Spectral_slot c)
  {
    const Spectral_ring& ring = fields.rings[c];
    const std::size_t d = ring.size(), length = std::size_t(fields.F.cols());
    m_z.resize(d + 1);
    m_scratch_z.resize((d + 1) * length);
    for(std::size_t j = 0; j <= d; ++j) {
      const Spectral_slot s = j == d ? c : ring[j].vertex;
      if(fields.has_z_rows()) {
        m_z[j] = fields.z_row(s);
        continue;
      }
      const double *f = fields.f_row(s), *lambda = fields.lambda.data();
      double* z = m_scratch_z.data() + j * length;
      for(std::size_t k = 0; k < length; ++k)
        z[k] = lambda[k] * f[k];
      m_z[j] = z;
    }
  }

  std::vector<double> m_scratch_g, m_scratch_z;
  std::vector<const double*> m_g, m_z, m_rows;
  std::vector<std::size_t> m_changed;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_RING_PRODUCTS_H
