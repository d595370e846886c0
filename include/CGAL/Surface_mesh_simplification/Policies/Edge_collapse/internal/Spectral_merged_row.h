// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_MERGED_ROW_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_MERGED_ROW_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_lanes.h>
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
 * Vertices of the link are numbered as the kernel does: the ring of u without v, then those of v alone.
 */
class Spectral_merged_row
{
public:
  using Lanes = Spectral_lanes;

  CGAL_SPECTRAL_INLINE void prepare(const Spectral_fields& fields, const Spectral_ring_products& of_u,
                                    const Spectral_ring_products& of_v, const Spectral_slot u,
                                    const Spectral_slot v, const std::size_t v_in_u, const std::size_t u_in_v)
  {
    m_full = fields.theta != 0;
    m_v_in_u = v_in_u;
    m_of_u = &of_u;
    m_of_v = &of_v;
    m_u_in_v = u_in_v;
    classify(fields.rings[u], fields.rings[v]);
    multiply_across(fields, u, v);
    fill_gram();
  }

  /// Adds E_x = |R_x|^2 / M_x to the cost of each sample. `fresh` is indexed by the link.
  CGAL_SPECTRAL_INLINE void add_term(const Spectral_new_entries* fresh, const Lanes& total_area,
                                     const Lanes& weight, const double diagonal, const double off_diagonal,
                                     const double area_scale, Lanes& cost)
  {
    const std::size_t nu = m_of_u->degree(), nv = m_far.size();
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
      const double *g = m_gram.data() + i * m_n, *h = g + m_n;
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
      norm += c * c * m_gram[i * m_n + i];
    }
  }

  // m_far: ring indices, at v, of the neighbours of v alone. m_at_v: for each index in the ring of u that at v (v
  // itself: the centre), or the row of the products across, counted down from -1.
  void classify(const Spectral_ring& ring_u, const Spectral_ring& ring_v)
  {
    m_far.clear();
    m_only_u.clear();
    m_at_v.assign(ring_u.size(), -1);
    m_at_v[m_v_in_u] = int(ring_v.size());
    // A vertex next to both makes a face with the edge, so it is next to v in the ring of u.
    const std::size_t beside[2] = {Spectral_rings::next(ring_u, m_v_in_u),
                                   Spectral_rings::prev(ring_u, m_v_in_u)};
    for(std::size_t m = 0; m < ring_v.size(); ++m) {
      const Spectral_slot s = ring_v[m].vertex;
      if(m == m_u_in_v)
        continue;
      if(ring_u[beside[0]].vertex == s)
        m_at_v[beside[0]] = int(m);
      else if(ring_u[beside[1]].vertex == s)
        m_at_v[beside[1]] = int(m);
      else
        m_far.push_back(m);
    }
    for(std::size_t i = 0; i < ring_u.size(); ++i)
      if(m_at_v[i] == -1) {
        m_only_u.push_back(i);
        m_at_v[i] = -int(m_only_u.size());
      }
  }

  // Products of f_i - f_u (and z_i) for i next to u alone with f_m - f_v (and z_m) for m next to v alone.
  CGAL_SPECTRAL_INLINE void multiply_across(const Spectral_fields& fields, const Spectral_slot u,
                                            const Spectral_slot v)
  {
    const std::size_t length = std::size_t(fields.F.cols()), na = m_only_u.size(), nb = m_far.size();
    const std::size_t stride = m_full ? 2 * nb : nb;
    m_stride = stride;
    if(na == 0 || nb == 0)
      return; // no products, and the pointers into empty vectors would be null
    m_a.resize(m_full ? 2 * na : na);
    m_b.resize(stride);
    for(std::size_t i = 0; i < na; ++i)
      m_a[i] = fields.f_row(fields.rings[u][m_only_u[i]].vertex);
    for(std::size_t m = 0; m < nb; ++m)
      m_b[m] = fields.f_row(fields.rings[v][m_far[m]].vertex);
    m_across.resize((m_full ? 2 : 1) * na * stride);
    const Spectral_row_list a{m_a.data(), na, fields.f_row(u)}, b{m_b.data(), nb, fields.f_row(v)};
    spectral_dots<true, true>(a, b, length, m_across.data(), stride);
    if(!m_full)
      return;
    m_scratch.resize((na + nb) * length);
    double* const scratch = m_scratch.data();
    for(std::size_t i = 0; i < na; ++i)
      m_a[na + i] = fields.z_row(fields.rings[u][m_only_u[i]].vertex, scratch + i * length);
    for(std::size_t m = 0; m < nb; ++m)
      m_b[nb + m] = fields.z_row(fields.rings[v][m_far[m]].vertex, scratch + (na + m) * length);
    const Spectral_row_list za{m_a.data() + na, na}, zb{m_b.data() + nb, nb};
    spectral_dots<true, false>(a, zb, length, m_across.data() + nb, stride);
    spectral_dots<false, true>(za, b, length, m_across.data() + na * stride, stride);
    spectral_dots<false, false>(za, zb, length, m_across.data() + na * stride + nb, stride);
  }

  double across(const int row, const std::size_t m, const bool z_of_u, const bool z_of_v) const
  {
    const std::size_t i = std::size_t(-row - 1) + (z_of_u ? m_only_u.size() : 0);
    return m_across[i * m_stride + m + (z_of_v ? m_far.size() : 0)];
  }

  // Order: the ring of u (v at its place), the neighbours of v alone, z_u, z_v, then z of the link. Upper triangle.
  CGAL_SPECTRAL_INLINE void fill_gram()
  {
    const Spectral_ring_products &p = *m_of_u, &q = *m_of_v;
    const std::size_t nu = p.degree(), nv = m_far.size(), zu = nu + nv, zv = zu + 1;
    m_n = zv + 1 + (m_full ? nu - 1 + nv : 0);
    m_gram.resize(m_n * m_n);
    for(std::size_t i = 0; i < nu; ++i) {
      for(std::size_t j = i; j < nu; ++j)
        at(i, j) = p.gg(i, j);
      for(std::size_t m = 0; m < nv; ++m)
        at(i, nu + m) = gg_across(i, m);
      at(i, zu) = p.zg(nu, i);
      at(i, zv) = p.zg(m_v_in_u, i);
    }
    for(std::size_t m = 0; m < nv; ++m) {
      for(std::size_t l = m; l < nv; ++l)
        at(nu + m, nu + l) = q.gg(m_far[m], m_far[l]);
      at(nu + m, zu) = q.zg(m_u_in_v, m_far[m]);
      at(nu + m, zv) = q.zg(q.degree(), m_far[m]);
    }
    at(zu, zu) = p.zz(nu, nu);
    at(zu, zv) = p.zz(nu, m_v_in_u);
    at(zv, zv) = q.zz(q.degree(), q.degree());
    if(m_full)
      fill_gram_of_z(zu, zv);
  }

  CGAL_SPECTRAL_INLINE void fill_gram_of_z(const std::size_t zu, const std::size_t zv)
  {
    const Spectral_ring_products &p = *m_of_u, &q = *m_of_v;
    const std::size_t nu = p.degree(), nv = m_far.size(), first_far = zv + nu; // of z_m, m next to v alone
    const auto column = [&](const std::size_t i) { return zv + 1 + i - (i > m_v_in_u ? 1 : 0); };
    for(std::size_t i = 0; i < nu; ++i) {
      if(i == m_v_in_u)
        continue;
      const std::size_t zi = column(i);
      for(std::size_t j = 0; j < nu; ++j)
        at(j, zi) = p.zg(i, j);
      for(std::size_t m = 0; m < nv; ++m) {
        at(nu + m, zi) =
            m_at_v[i] >= 0 ? q.zg(std::size_t(m_at_v[i]), m_far[m]) : across(m_at_v[i], m, true, false);
        at(zi, first_far + m) =
            m_at_v[i] >= 0 ? q.zz(std::size_t(m_at_v[i]), m_far[m]) : across(m_at_v[i], m, true, true);
      }
      at(zu, zi) = p.zz(nu, i);
      at(zv, zi) = p.zz(m_v_in_u, i);
      for(std::size_t j = i; j < nu; ++j)
        if(j != m_v_in_u)
          at(zi, column(j)) = p.zz(i, j);
    }
    for(std::size_t m = 0; m < nv; ++m) {
      const std::size_t zm = first_far + m;
      for(std::size_t j = 0; j < nu; ++j)
        at(j, zm) = gz_across(j, m);
      for(std::size_t l = 0; l < nv; ++l)
        at(nu + l, zm) = q.zg(m_far[m], m_far[l]);
      at(zu, zm) = q.zz(m_u_in_v, m_far[m]);
      at(zv, zm) = q.zz(q.degree(), m_far[m]);
      for(std::size_t l = m; l < nv; ++l)
        at(zm, first_far + l) = q.zz(m_far[m], m_far[l]);
    }
  }

  // (f_i - f_u) . (f_m - f_v): with f_i - f_u = (f_i - f_v) - (f_u - f_v) where i is next to v as well.
  double gg_across(const std::size_t i, const std::size_t m) const
  {
    const int j = m_at_v[i];
    if(j < 0)
      return across(j, m, false, false);
    const double to_u = m_of_v->gg(m_u_in_v, m_far[m]);
    return i == m_v_in_u ? -to_u : m_of_v->gg(std::size_t(j), m_far[m]) - to_u;
  }

  // (f_i - f_u) . z_m
  double gz_across(const std::size_t i, const std::size_t m) const
  {
    const int j = m_at_v[i];
    if(j < 0)
      return across(j, m, false, true);
    const double to_u = m_of_v->zg(m_far[m], m_u_in_v);
    return i == m_v_in_u ? -to_u : m_of_v->zg(m_far[m], std::size_t(j)) - to_u;
  }

  double& at(const std::size_t i, const std::size_t j) { return m_gram[i * m_n + j]; }

  const Spectral_ring_products *m_of_u = nullptr, *m_of_v = nullptr;
  std::size_t m_v_in_u = 0, m_u_in_v = 0;
  bool m_full = false;
  std::vector<std::size_t> m_far, m_only_u;
  std::vector<int> m_at_v;
  std::vector<double> m_scratch, m_across, m_gram;
  std::vector<const double*> m_a, m_b;
  std::size_t m_n = 0, m_stride = 0;
  std::vector<Coefficient> m_c;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_MERGED_ROW_H
