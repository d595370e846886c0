// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_MERGED_ROW_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_MERGED_ROW_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_lanes.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_link.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_ring_products.h>

#include <cstddef>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// What the new triangles (x; w, n) give to a vertex w of the link, for each sample: half cotangents, areas.
struct Spectral_new_entries
{
  Spectral_lanes to_x, to_neighbor[2], area, area_neighbor[2];
};

/*!
 * E_x after the collapse of (u,v) to x. The row is new as a whole,
 * R_x = sum over the link of l_k (f_k - f_x) + b_k z_k, plus b_x z_x. With e = f_v - f_u it is a combination
 * of f_k - f_u for the neighbours k of u (v among them: e), of f_m - f_v for the neighbours m of v alone, and of
 * rows of Z: f_k - f_x = (f_k - f_u) - weight e, f_m - f_x = (f_m - f_v) + (1 - weight) e.
 *
 * The matrix of the quadratic form comes from the products in the rings of u and v. Only pairs of a neighbour of u
 * alone and one of v alone are in neither: they are the work over K that is left in an evaluation.
 *
 * Vertices of the link are numbered as in `Spectral_link`: the ring of u without v, then those of v alone.
 */
class Spectral_merged_row
{
public:
  using Lanes = Spectral_lanes;
  using Ring = Spectral_ring_products::View;

  CGAL_SPECTRAL_INLINE void prepare(const Spectral_fields& fields, const Spectral_link& link,
                                    const Ring& of_u, const Ring& of_v)
  {
    m_full = fields.theta != 0;
    m_v_in_u = link.v_in_u();
    m_u_in_v = link.u_in_v();
    m_of_u = of_u;
    m_of_v = of_v;
    classify(link);
    multiply_across(fields, link);
    fill_gram();
  }

  /// Adds E_x = |R_x|^2 / M_x to the cost of each sample. `fresh` is indexed by the link.
  CGAL_SPECTRAL_INLINE void add_term(const Spectral_new_entries* fresh, const Lanes& total_area,
                                     const Lanes& weight, const double diagonal, const double off_diagonal,
                                     const double area_scale, Lanes& cost)
  {
    const std::size_t nu = m_of_u.d, nv = m_nv;
    if(m_c.size() < m_n)
      m_c.resize(m_n);
    Lanes sum_u = {}, sum_v = {};
    for(std::size_t i = 0, k = 0; i < nu; ++i)
      if(i != m_v_in_u) {
        m_c[i].value = fresh[k].to_x;
        sum_u += fresh[k++].to_x;
      }
    for(std::size_t m = 0; m < nv; ++m) {
      m_c[nu + m].value = fresh[nu - 1 + m].to_x;
      sum_v += fresh[nu - 1 + m].to_x;
    }
    m_c[m_v_in_u].value = (1. - weight) * sum_v - weight * sum_u;
    const Lanes self = total_area * diagonal;
    m_c[nu + nv].value = (1. - weight) * self;
    m_c[nu + nv + 1].value = weight * self;
    if(m_full)
      for(std::size_t k = 0; k + 1 < nu + nv; ++k)
        m_c[nu + nv + 2 + k].value = fresh[k].area * off_diagonal;
    Lanes norm;
    square(norm);
    cost += norm / (total_area * (area_scale / 3));
  }

private:
  // A coefficient of the quadratic form.
  struct Coefficient
  {
    Lanes value;
  };

  // The quadratic form, two rows at a time: one sum would be a chain of additions that wait for each other.
  CGAL_SPECTRAL_INLINE void square(Lanes& norm) const
  {
    norm = Lanes{};
    std::size_t i = 0;
    for(; i + 1 < m_n; i += 2) {
      const double *g = m_gram.data() + i * m_width, *h = g + m_width;
      Lanes row_g = {}, row_h = {};
      for(std::size_t j = i + 2; j < m_n; ++j) {
        const Lanes& c = m_c[j].value;
        row_g += c * g[j];
        row_h += c * h[j];
      }
      const Lanes &c = m_c[i].value, &d = m_c[i + 1].value;
      row_g += d * g[i + 1];
      norm += c * (c * g[i] + 2. * row_g) + d * (d * h[i + 1] + 2. * row_h);
    }
    if(i < m_n) {
      const Lanes& c = m_c[i].value;
      norm += c * c * m_gram[i * m_width + i];
    }
  }

  // m_far: ring indices, at v, of the neighbours of v alone. m_at_v: for each index in the ring of u that at v (v
  // itself: the centre), or the row of the products across, counted down from -1.
  CGAL_SPECTRAL_INLINE void classify(const Spectral_link& link)
  {
    const std::size_t nu = m_of_u.d, n = link.size();
    m_nv = n - (nu - 1);
    if(m_at_v.size() < n + 1) {
      m_at_v.resize(n + 1);
      m_far.resize(n + 1);
      m_a.resize(2 * n + 2);
      m_b.resize(2 * n + 2);
    }
    m_na = 0;
    for(std::size_t k = 0; k + 1 < nu; ++k) {
      const Spectral_link_vertex& w = link[k];
      m_at_v[w.in_u] = w.ends == next_to_u_and_v ? int(w.in_v) : -int(++m_na);
    }
    m_at_v[m_v_in_u] = int(m_of_v.d);
    for(std::size_t m = 0; m < m_nv; ++m)
      m_far[m] = link[nu - 1 + m].in_v;
  }

  // Products of f_i - f_u (and z_i) for i next to u alone with f_m - f_v (and z_m) for m next to v alone.
  CGAL_SPECTRAL_INLINE void multiply_across(const Spectral_fields& fields, const Spectral_link& link)
  {
    const std::size_t length = std::size_t(fields.F.cols()), nu = m_of_u.d, na = m_na, nb = m_nv;
    const std::size_t stride = m_full ? 2 * nb : nb;
    m_stride = stride;
    if(na == 0 || nb == 0)
      return; // no products, and the pointers into empty vectors would be null
    for(std::size_t k = 0, i = 0; i < na; ++k)
      if(link[k].ends == next_to_u)
        m_a[i++] = fields.f_row(link[k].slot);
    for(std::size_t m = 0; m < nb; ++m)
      m_b[m] = fields.f_row(link[nu - 1 + m].slot);
    const std::size_t size = (m_full ? 2 : 1) * na * stride;
    if(m_across.size() < size)
      m_across.resize(size);
    const Spectral_row_list a{m_a.data(), na, fields.f_row(link.u())},
        b{m_b.data(), nb, fields.f_row(link.v())};
    spectral_dots<true, true>(a, b, length, m_across.data(), stride);
    if(!m_full)
      return;
    double* const scratch = m_scratch.at_least((na + nb) * length);
    for(std::size_t k = 0, i = 0; i < na; ++k)
      if(link[k].ends == next_to_u) {
        m_a[na + i] = fields.z_row(link[k].slot, scratch + i * length);
        ++i;
      }
    for(std::size_t m = 0; m < nb; ++m)
      m_b[nb + m] = fields.z_row(link[nu - 1 + m].slot, scratch + (na + m) * length);
    const Spectral_row_list za{m_a.data() + na, na}, zb{m_b.data() + nb, nb};
    spectral_dots<true, false>(a, zb, length, m_across.data() + nb, stride);
    spectral_dots<false, true>(za, b, length, m_across.data() + na * stride, stride);
    spectral_dots<false, false>(za, zb, length, m_across.data() + na * stride + nb, stride);
  }

  double across(const int row, const std::size_t m, const bool z_of_u, const bool z_of_v) const
  {
    const std::size_t i = std::size_t(-row - 1) + (z_of_u ? m_na : 0);
    return m_across[i * m_stride + m + (z_of_v ? m_nv : 0)];
  }

  // Order: the ring of u (v at its place), the neighbours of v alone, z_u, z_v, then z of the link. Upper triangle.
  CGAL_SPECTRAL_INLINE void fill_gram()
  {
    const Ring &p = m_of_u, &q = m_of_v;
    const std::size_t nu = p.d, nv = m_nv, zu = nu + nv, zv = zu + 1;
    m_n = zv + 1 + (m_full ? nu - 1 + nv : 0);
    m_width = m_n + 4;
    if(m_gram.size() < m_n * m_width)
      m_gram.resize(m_n * m_width);
    const double *const z_u = p.z_g(nu), *const z_v = p.z_g(m_v_in_u), *const from_u = q.g(m_u_in_v);
    for(std::size_t i = 0; i < nu; ++i) {
      double* const row = m_gram.data() + i * m_width;
      const double* const g = p.g(i);
      // What is copied beyond the row of g is overwritten, or in the room at the end.
      for(std::size_t j = i; j < nu; j += 4) {
        Spectral_lanes four;
        spectral_load(four, g + j);
        spectral_store(row + j, four);
      }
      double* const across = row + nu;
      if(i == m_v_in_u)
        for(std::size_t m = 0; m < nv; ++m)
          across[m] = -from_u[m_far[m]];
      else if(m_at_v[i] < 0) {
        const double* const products = m_across.data() + std::size_t(-m_at_v[i] - 1) * m_stride;
        for(std::size_t m = 0; m < nv; ++m)
          across[m] = products[m];
      } else {
        const double* const both = q.g(std::size_t(m_at_v[i]));
        for(std::size_t m = 0; m < nv; ++m)
          across[m] = both[m_far[m]] - from_u[m_far[m]];
      }
      row[zu] = z_u[i];
      row[zv] = z_v[i];
    }
    const double *const z_at_u = q.z_g(m_u_in_v), *const z_at_v = q.z_g(q.d);
    for(std::size_t m = 0; m < nv; ++m) {
      double* const row = m_gram.data() + (nu + m) * m_width;
      const double* const g = q.g(m_far[m]);
      for(std::size_t l = m; l < nv; ++l)
        row[nu + l] = g[m_far[l]];
      row[zu] = z_at_u[m_far[m]];
      row[zv] = z_at_v[m_far[m]];
    }
    at(zu, zu) = p.z(nu)[nu];
    at(zu, zv) = p.z(nu)[m_v_in_u];
    at(zv, zv) = q.z(q.d)[q.d];
    if(m_full)
      fill_gram_of_z(zu, zv);
  }

  CGAL_SPECTRAL_INLINE void fill_gram_of_z(const std::size_t zu, const std::size_t zv)
  {
    const Ring &p = m_of_u, &q = m_of_v;
    const std::size_t nu = p.d, nv = m_nv, first_far = zv + nu; // of z_m, m next to v alone
    const auto column = [&](const std::size_t i) { return zv + 1 + i - (i > m_v_in_u ? 1 : 0); };
    for(std::size_t i = 0; i < nu; ++i) {
      if(i == m_v_in_u)
        continue;
      const std::size_t zi = column(i);
      for(std::size_t j = 0; j < nu; ++j)
        at(j, zi) = p.z_g(i)[j];
      for(std::size_t m = 0; m < nv; ++m) {
        at(nu + m, zi) =
            m_at_v[i] >= 0 ? q.z_g(std::size_t(m_at_v[i]))[m_far[m]] : across(m_at_v[i], m, true, false);
        at(zi, first_far + m) =
            m_at_v[i] >= 0 ? q.z(std::size_t(m_at_v[i]))[m_far[m]] : across(m_at_v[i], m, true, true);
      }
      at(zu, zi) = p.z(nu)[i];
      at(zv, zi) = p.z(m_v_in_u)[i];
      for(std::size_t j = i; j < nu; ++j)
        if(j != m_v_in_u)
          at(zi, column(j)) = p.z(i)[j];
    }
    for(std::size_t m = 0; m < nv; ++m) {
      const std::size_t zm = first_far + m;
      for(std::size_t j = 0; j < nu; ++j)
        at(j, zm) = gz_across(j, m);
      for(std::size_t l = 0; l < nv; ++l)
        at(nu + l, zm) = q.z_g(m_far[m])[m_far[l]];
      at(zu, zm) = q.z(m_u_in_v)[m_far[m]];
      at(zv, zm) = q.z(q.d)[m_far[m]];
      for(std::size_t l = m; l < nv; ++l)
        at(zm, first_far + l) = q.z(m_far[m])[m_far[l]];
    }
  }

  // (f_i - f_u) . z_m
  double gz_across(const std::size_t i, const std::size_t m) const
  {
    const int j = m_at_v[i];
    if(j < 0)
      return across(j, m, false, true);
    const double* const z = m_of_v.z_g(m_far[m]);
    return i == m_v_in_u ? -z[m_u_in_v] : z[std::size_t(j)] - z[m_u_in_v];
  }

  double& at(const std::size_t i, const std::size_t j) { return m_gram[i * m_width + j]; }

  Ring m_of_u{}, m_of_v{};
  std::size_t m_v_in_u = 0, m_u_in_v = 0;
  std::size_t m_na = 0, m_nv = 0; // vertices next to u alone, to v alone
  bool m_full = false;
  // Scratch memory that only grows.
  std::vector<std::size_t> m_far;
  std::vector<int> m_at_v;
  Aligned_buffer m_scratch;
  std::vector<double> m_across, m_gram;
  std::vector<const double*> m_a, m_b;
  std::size_t m_n = 0, m_width = 0, m_stride = 0;
  std::vector<Coefficient> m_c;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_MERGED_ROW_H
