// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COLLAPSE_KERNEL_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COLLAPSE_KERNEL_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_change.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_lanes.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_link.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_merged_row.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_ring_products.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_rings.h>

#include <CGAL/assertions.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// A way to collapse a candidate (u,v): x replaces both, f_x = (1 - weight) f_u + weight f_v.
struct Spectral_sample
{
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double weight = 0;
  double cost = std::numeric_limits<double>::infinity();
};

/*!
 * The local cost of collapsing one edge: cost = sum over H of E_w after - sum over H of E_w before,
 * where H is the merged vertex and its link (section 3.3 of the paper).
 *
 * For a vertex w of the link only the triangles around u and v change, so R_w after is R_w plus a
 * combination of z_w and of four differences of rows of F (and, with a mass that has off-diagonal entries, of the
 * rows of Z of the same vertices). Its square is a quadratic form in the coefficients, whose matrix is gathered from
 * `Spectral_ring_products`. The coefficients of up to four samples are computed side by side. Where a triangle that goes
 * has such cotangents that their squares leave nothing but rounding, and where a ring is too large to keep its products,
 * `Spectral_change` takes the place of all that.
 *
 * The object holds the scratch memory of one thread; it allocates only while a larger ring than any
 * before comes along.
 */
class Spectral_collapse_kernel
{
public:
  static constexpr int max_samples = 4;

  using Topology = Spectral_link::Topology;

  /// Collects the neighbourhood of (u,v) as it is. Unless the answer is `collapsible`, CGAL's loop would
  /// refuse the edge until something near changes, and nothing may be evaluated.
  Topology prepare(const Spectral_fields& fields, const std::vector<Spectral_ring_products>& products,
                   const Spectral_slot u, const Spectral_slot v)
  {
    m_fields = &fields;
    m_products = products.data();
    const Topology topology = m_link.set_edge(fields, u, v);
    m_by_rows = topology == Topology::collapsible && !m_link.has_products(fields);
    if(topology == Topology::collapsible && !m_by_rows)
      Spectral_geometry::internal::on_vector_units([&] { prepare_body(products); });
    return topology;
  }

  /// Fills `cost` of up to four samples; infinity where a triangle without area would arise.
  void evaluate(Spectral_sample* samples, const int count)
  {
    CGAL_precondition(count >= 1 && count <= max_samples);
    if(m_by_rows) {
      for(int s = 0; s < count; ++s)
        samples[s].cost =
            m_change.cost(*m_fields, m_link.u(), m_link.v(), samples[s].weight, samples[s].point);
      return;
    }
    Spectral_geometry::internal::on_vector_units([&] { evaluate_body(samples, count); });
    if(m_link.roughness() > rough_cotangent)
      correct(samples, count);
  }

  /// The change of E to rounding, whatever the cotangents are, of any edge: see `Spectral_change`. Needs no prepare().
  double change(const Spectral_fields& fields, const Spectral_slot u, const Spectral_slot v,
                const double weight, const Eigen::Vector3d& point)
  {
    return m_change(fields, u, v, weight, point);
  }

private:
  using Lanes = Spectral_lanes;
  using Ring = Spectral_ring_products::View;

  // The vectors that R_w after is a combination of. For w next to one end c of the edge, with the other end o:
  // f_c - f_w and f_o - f_c; for w next to both: f_u - f_w and f_v - f_w. Then the two neighbours along the link. The
  // rows of Z are those of w, of c and o (or u and v), and of the same neighbours.
  enum Column {
    residual,
    z_self,
    g_near,
    g_far,
    g_first,
    g_second,
    z_near,
    z_far,
    z_first,
    z_second,
    columns
  };
  static constexpr int lumped_columns = z_near;
  static constexpr int number_of_coefficients = 7;

  // The matrix of the quadratic form of one vertex of the link: inner products of its columns, upper triangle.
  struct Gram
  {
    double at[columns][columns];
    double* operator[](const int i) { return at[i]; }
    const double* operator[](const int i) const { return at[i]; }
  };
  using Link_vertex = Spectral_link_vertex;

  CGAL_SPECTRAL_INLINE void prepare_body(const std::vector<Spectral_ring_products>& products)
  {
    m_link.collect(*m_fields, products);
    const std::size_t n = m_link.size();
    if(m_gram.size() < n) {
      m_gram.resize(n);
      m_new.resize(n);
    }
    const Ring of_u = m_products[m_link.u()].view(), of_v = m_products[m_link.v()].view();
    for(std::size_t i = 0; i < n; ++i)
      gather_gram(m_link[i], of_u, of_v, m_gram[i]);
    multiply_far_residuals();
    m_merged.prepare(*m_fields, m_link, of_u, of_v);
  }

  // The square of 1e5, times the rounding of doubles, is 1e-6, of costs that matter from about 1e-3.
  static constexpr double rough_cotangent = 1e5;
  void correct(Spectral_sample* samples, const int count)
  {
    for(int s = 0; s < count; ++s)
      if(std::isfinite(samples[s].cost))
        samples[s].cost = m_change(*m_fields, m_link.u(), m_link.v(), samples[s].weight, samples[s].point);
  }

  CGAL_SPECTRAL_INLINE void gather_gram(const Link_vertex& w, const Ring& of_u, const Ring& of_v,
                                        Gram& gram) const
  {
    const Ring own = m_products[w.slot].view();
    gram[residual][residual] = m_fields->E[w.slot] * w.mass;
    if(w.ends == next_to_u_and_v)
      gather_own<true>(w, own, w.u_in, w.v_in, gram);
    else if(w.ends == next_to_u) {
      gather_own<false>(w, own, w.u_in, own.d, gram);
      gather_far(w, of_u, w.in_u, m_link.v_in_u(), gram);
    } else {
      gather_own<false>(w, own, w.v_in, own.d, gram);
      gather_far(w, of_v, w.in_v, m_link.u_in_v(), gram);
    }
  }

  // Products among the differences and the rows of Z at ring indices near, far and those of the two neighbours in the
  // ring of w; with the far one only if `Far`.
  template <bool Far>
  CGAL_SPECTRAL_INLINE void gather_own(const Link_vertex& w, const Ring& own, const std::size_t near,
                                       const std::size_t far, Gram& gram) const
  {
    const std::size_t first = w.neighbor_in[0], second = w.neighbor_in[1], d = own.d;
    const bool full = m_fields->theta != 0;
    const double *const z = own.z_g(d), *const zz = own.z(d);
    gram[residual][z_self] = own.rz[full ? d : 0];
    gram[z_self][z_self] = zz[d];
    const double* g = own.g(near);
    gram[residual][g_near] = own.rg[near];
    gram[z_self][g_near] = z[near];
    gram[g_near][g_near] = g[near];
    gram[g_near][g_first] = g[first];
    gram[g_near][g_second] = g[second];
    if(Far) {
      gram[g_near][g_far] = g[far];
      g = own.g(far);
      gram[residual][g_far] = own.rg[far];
      gram[z_self][g_far] = z[far];
      gram[g_far][g_far] = g[far];
      gram[g_far][g_first] = g[first];
      gram[g_far][g_second] = g[second];
    }
    g = own.g(first);
    gram[residual][g_first] = own.rg[first];
    gram[z_self][g_first] = z[first];
    gram[g_first][g_first] = g[first];
    gram[g_first][g_second] = g[second];
    gram[residual][g_second] = own.rg[second];
    gram[z_self][g_second] = z[second];
    gram[g_second][g_second] = own.g(second)[second];
    if(!full)
      return;
    const std::size_t in[4] = {near, far, first, second};
    for(int j = 0; j < 4; ++j) {
      if(!Far && j == 1)
        continue;
      const double *const row_g = own.z_g(in[j]), *const row_z = own.z(in[j]);
      gram[residual][z_near + j] = own.rz[in[j]];
      gram[z_self][z_near + j] = zz[in[j]];
      gram[g_near][z_near + j] = row_g[near];
      if(Far)
        gram[g_far][z_near + j] = row_g[far];
      gram[g_first][z_near + j] = row_g[first];
      gram[g_second][z_near + j] = row_g[second];
      for(int i = 0; i <= j; ++i)
        gram[z_near + i][z_near + j] = row_z[in[i]];
    }
  }

  // The far end o is not in the ring of w, but both are in that of the near end c: e = f_o - f_c is one of
  // its differences, and f_i - f_w = (f_i - f_c) - (f_w - f_c). `self` and `o` are the indices of w and o there.
  CGAL_SPECTRAL_INLINE void gather_far(const Link_vertex& w, const Ring& near, const std::size_t self,
                                       const std::size_t o, Gram& gram) const
  {
    const std::size_t first = w.neighbor_near[0], second = w.neighbor_near[1];
    const double* const e = near.g(o);
    gram[z_self][g_far] = near.z_g(self)[o];
    gram[g_far][g_far] = e[o];
    gram[g_near][g_far] = -e[self];
    gram[g_far][g_first] = e[first] - e[self];
    gram[g_far][g_second] = e[second] - e[self];
    if(m_fields->theta == 0)
      return;
    const std::size_t in[4] = {near.d, o, first, second};
    const double *const z_o = near.z_g(o), *const zz_o = near.z(o);
    for(int j = 0; j < 4; ++j) {
      gram[g_far][z_near + j] = near.z_g(in[j])[o];
      if(j != 1)
        gram[(std::min)(z_near + j, int(z_far))][(std::max)(z_near + j, int(z_far))] = zz_o[in[j]];
    }
    gram[z_self][z_far] = zz_o[self];
    gram[z_far][z_far] = zz_o[o];
    gram[g_near][z_far] = -z_o[self];
    gram[g_first][z_far] = z_o[first] - z_o[self];
    gram[g_second][z_far] = z_o[second] - z_o[self];
  }

  // R_w . (f_o - f_c), and R_w . z_o, for each w next to one end c alone: f_o - f_c is the same for both ends but for its
  // sign.
  CGAL_SPECTRAL_INLINE void multiply_far_residuals()
  {
    const Spectral_fields& fields = *m_fields;
    const std::size_t length = std::size_t(fields.F.cols()), n = m_link.size();
    if(m_rows.size() < n) {
      m_rows.resize(n);
      m_far.resize(n);
    }
    double* const scratch = m_scratch.at_least(length);
    std::size_t count = 0, of_u = 0; // those next to u come first
    for(std::size_t i = 0; i < n; ++i)
      if(m_link[i].ends != next_to_u_and_v) {
        of_u += m_link[i].ends == next_to_u ? 1 : 0;
        m_rows[count++] = fields.r_row(m_link[i].slot);
      }
    const double *const f_u = fields.f_row(m_link.u()), *const f_v = fields.f_row(m_link.v());
    spectral_subtract_rows(f_v, f_u, length, scratch);
    spectral_dots_with(m_rows.data(), count, scratch, length, m_far.data());
    std::size_t next = 0;
    for(std::size_t i = 0; i < n; ++i)
      if(m_link[i].ends != next_to_u_and_v) {
        m_gram[i][residual][g_far] = m_link[i].ends == next_to_u ? m_far[next] : -m_far[next];
        ++next;
      }
    if(fields.theta == 0)
      return;
    spectral_dots_with(m_rows.data(), of_u, fields.z_row(m_link.v(), scratch), length, m_far.data());
    spectral_dots_with(m_rows.data() + of_u, count - of_u, fields.z_row(m_link.u(), scratch), length,
                       m_far.data() + of_u);
    next = 0;
    for(std::size_t i = 0; i < n; ++i)
      if(m_link[i].ends != next_to_u_and_v)
        m_gram[i][residual][z_far] = m_far[next++];
  }

  CGAL_SPECTRAL_INLINE void evaluate_body(Spectral_sample* samples, const int count)
  {
    const double before = m_link.error();
    Lanes weight, invalid = {}, cost = {-before, -before, -before, -before}, point[3];
    for(int s = 0; s < max_samples; ++s) {
      const Spectral_sample& sample = samples[s < count ? s : 0];
      weight[s] = sample.weight;
      for(int c = 0; c < 3; ++c)
        point[c][s] = sample.point[c];
    }
    Lanes total_area = {};
    const bool full = m_fields->theta != 0, cotangent = m_fields->coefficients.empty() && !m_fields->voronoi;
    if(full && cotangent)
      add_link_terms<true, true>(point, weight, total_area, cost, invalid);
    else if(full)
      add_link_terms<true, false>(point, weight, total_area, cost, invalid);
    else if(cotangent)
      add_link_terms<false, true>(point, weight, total_area, cost, invalid);
    else
      add_link_terms<false, false>(point, weight, total_area, cost, invalid);
    if(!m_fields->vanishes_at(m_link.u()) && !m_fields->vanishes_at(m_link.v()))
      m_merged.add_term(m_new.data(), total_area, weight, m_fields->diagonal_share() * m_fields->area_scale,
                        m_fields->off_diagonal_share() * m_fields->area_scale, m_fields->area_scale, cost);
    for(int s = 0; s < count; ++s)
      samples[s].cost =
          invalid[s] == 0 && std::isfinite(cost[s]) ? cost[s] : std::numeric_limits<double>::infinity();
  }

  // `Full`: with a mass that has off-diagonal entries. `Cotangent`: without coefficients and Voronoi areas.
  template <bool Full, bool Cotangent>
  CGAL_SPECTRAL_INLINE void add_link_terms(const Lanes* x, const Lanes& weight, Lanes& total_area,
                                           Lanes& cost, Lanes& invalid)
  {
    if constexpr(!Cotangent)
      set_merged_coefficients(weight);
    add_new_triangles<Full, Cotangent>(x, total_area, invalid);
    // f_x = (1 - weight) f_u + weight f_v where w is next to both, f_near + far (f_o - f_c) where next to one end c.
    const Lanes one = {1, 1, 1, 1}, rest = 1. - weight;
    const Lanes near[number_of_link_ends] = {rest, one, one},
                far[number_of_link_ends] = {weight, weight, rest};
    for(std::size_t i = 0; i < m_link.size(); ++i)
      if(!m_fields->vanishes_at(m_link[i].slot))
        add_link_term<Full>(m_link[i], m_gram[i], m_new[i], near[m_link[i].ends], far[m_link[i].ends], cost,
                            invalid);
  }

  template <bool Full, bool Cotangent>
  CGAL_SPECTRAL_INLINE void add_new_triangles(const Lanes* x, Lanes& total_area, Lanes& invalid)
  {
    const Lanes zero = {};
    for(std::size_t i = 0; i < m_link.size(); ++i)
      m_new[i] = Spectral_new_entries{zero, {zero, zero}, zero, {zero, zero}};
    for(const Spectral_outer_triangle *t = m_link.triangles_begin(), *end = m_link.triangles_end(); t != end;
        ++t) {
      const Spectral_outer_triangle& o = *t;
      const Eigen::Vector3d &pa = m_fields->points[m_link[o.a].slot],
                            &pb = m_fields->points[m_link[o.b].slot];
      const Eigen::Vector3d ab = pb - pa;
      const Lanes a[3] = {pa[0] - x[0], pa[1] - x[1], pa[2] - x[2]};
      const Lanes b[3] = {pb[0] - x[0], pb[1] - x[1], pb[2] - x[2]};
      const Lanes n[3] = {a[1] * ab[2] - a[2] * ab[1], a[2] * ab[0] - a[0] * ab[2],
                          a[0] * ab[1] - a[1] * ab[0]};
      const Lanes square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
      const Lanes a_ab = a[0] * ab[0] + a[1] * ab[1] + a[2] * ab[2];
      const Lanes b_ab = b[0] * ab[0] + b[1] * ab[1] + b[2] * ab[2];
      const Lanes a_b = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      // Half of 1 / |cross|, so that the products are half cotangents. cot a + cot b + cot x < bound.
      const Lanes sum = a_b - a_ab + b_ab;
      constexpr double limit = Spectral_triangle::degenerate_cotangent;
      const Lanes bound = sum * sum * (1 / (limit * limit));
      Lanes half, failed = {};
      spectral_inverse_sqrt(half, square, bound, failed);
      half *= Lanes{0.5, 0.5, 0.5, 0.5};
      if(!o.degenerate)
        invalid += failed;
      if constexpr(Cotangent) {
        const Lanes cot_x = a_b * half, cot_a = -a_ab * half, cot_b = b_ab * half, area = square * half;
        add_new_entries<Full>(m_new[o.a], o.column_of_b, cot_b, cot_x, area);
        add_new_entries<Full>(m_new[o.b], o.column_of_a, cot_a, cot_x, area);
        total_area += area;
      } else {
        Corner_products products{a_b, a_ab, b_ab};
        Lanes area = square * half;
        if(!m_fields->coefficients.empty())
          apply_coefficients(o, a, b, n, 2. * half, products, area);
        const Lanes cot_x = products.a_b * half, cot_a = -products.a_ab * half, cot_b = products.b_ab * half;
        Lanes area_x = area, area_a = area, area_b = area;
        if(m_fields->voronoi)
          for(int s = 0; s < max_samples; ++s) {
            using Spectral_geometry::internal::mixed_voronoi_share;
            area_x[s] *= 3 * mixed_voronoi_share(cot_x[s], cot_a[s], cot_b[s]);
            area_a[s] *= 3 * mixed_voronoi_share(cot_a[s], cot_b[s], cot_x[s]);
            area_b[s] *= 3 * mixed_voronoi_share(cot_b[s], cot_x[s], cot_a[s]);
          }
        add_new_entries<Full>(m_new[o.a], o.column_of_b, cot_b, cot_x, area_a);
        add_new_entries<Full>(m_new[o.b], o.column_of_a, cot_a, cot_x, area_b);
        total_area += area_x;
      }
    }
  }

  // Of the edges a, b from x and ab of a new triangle.
  struct Corner_products
  {
    Lanes a_b, a_ab, b_ab;
  };

  CGAL_SPECTRAL_INLINE void set_merged_coefficients(const Lanes& weight)
  {
    if(m_fields->coefficients.empty())
      return;
    const auto &of_u = m_fields->coefficients[m_link.u()], &of_v = m_fields->coefficients[m_link.v()];
    for(int i = 0; i < number_of_coefficients; ++i)
      m_coefficients[i] = (1. - weight) * of_u[i] + weight * of_v[i];
  }

  // `triangle_element()` with coefficients: products of a and b, turned within the triangle, by the conductivity.
  CGAL_SPECTRAL_INLINE void apply_coefficients(const Spectral_outer_triangle& o, const Lanes* a,
                                               const Lanes* b, const Lanes* n, const Lanes& inverse_length,
                                               Corner_products& products, Lanes& area) const
  {
    const auto &of_a = m_fields->coefficients[m_link[o.a].slot],
               &of_b = m_fields->coefficients[m_link[o.b].slot];
    Lanes c[number_of_coefficients];
    for(int i = 0; i < number_of_coefficients; ++i)
      c[i] = (m_coefficients[i] + (of_a[i] + of_b[i])) * (1. / 3);
    Lanes turned_a[3], turned_b[3], image[3];
    for(int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      turned_a[i] = (n[j] * a[k] - n[k] * a[j]) * inverse_length;
      turned_b[i] = (n[j] * b[k] - n[k] * b[j]) * inverse_length;
    }
    const auto apply = [&](const Lanes* x) {
      image[0] = c[1] * x[0] + c[2] * x[1] + c[3] * x[2];
      image[1] = c[2] * x[0] + c[4] * x[1] + c[5] * x[2];
      image[2] = c[3] * x[0] + c[5] * x[1] + c[6] * x[2];
    };
    apply(turned_a);
    const Lanes aa = turned_a[0] * image[0] + turned_a[1] * image[1] + turned_a[2] * image[2];
    products.a_b = turned_b[0] * image[0] + turned_b[1] * image[1] + turned_b[2] * image[2];
    apply(turned_b);
    const Lanes bb = turned_b[0] * image[0] + turned_b[1] * image[1] + turned_b[2] * image[2];
    products.a_ab = products.a_b - aa;
    products.b_ab = bb - products.a_b;
    area *= c[0];
  }

  template <bool Full>
  CGAL_SPECTRAL_INLINE static void add_new_entries(Spectral_new_entries& w, const int column,
                                                   const Lanes& to_x, const Lanes& to_neighbor,
                                                   const Lanes& area)
  {
    w.to_x += to_x;
    w.to_neighbor[column] += to_neighbor;
    w.area += area;
    if(Full)
      w.area_neighbor[column] += area;
  }

  // E_w after, |R_w|^2 / M_w. Every new triangle of w has the corner x.
  template <bool Full>
  CGAL_SPECTRAL_INLINE void add_link_term(const Link_vertex& w, const Gram& gram,
                                          const Spectral_new_entries& fresh, const Lanes& near,
                                          const Lanes& far, Lanes& cost, Lanes& invalid) const
  {
    constexpr int n = Full ? int(columns) : lumped_columns;
    const Lanes area_change = fresh.area - w.old_area;
    Lanes c[n];
    c[residual] = Lanes{1, 1, 1, 1};
    c[z_self] = area_change * (m_fields->diagonal_share() * m_fields->area_scale);
    c[g_near] = near * fresh.to_x - w.old_near;
    c[g_far] = far * fresh.to_x - w.old_far;
    c[g_first] = fresh.to_neighbor[0] - w.old_neighbor[0];
    c[g_second] = fresh.to_neighbor[1] - w.old_neighbor[1];
    if constexpr(Full) {
      const double off_diagonal = m_fields->off_diagonal_share() * m_fields->area_scale;
      // Rows of Z are not taken as differences to their centre: the shares of near and far sum to 1.
      c[z_near] = ((1. - far) * fresh.area - w.area_near) * off_diagonal;
      c[z_far] = (far * fresh.area - w.area_far) * off_diagonal;
      c[z_first] = (fresh.area_neighbor[0] - w.old_area_neighbor[0]) * off_diagonal;
      c[z_second] = (fresh.area_neighbor[1] - w.old_area_neighbor[1]) * off_diagonal;
    }
    Lanes norm = {};
    for(int i = 0; i < n; ++i) {
      Lanes row = {};
      for(int j = i + 1; j < n; ++j)
        row += c[j] * gram[i][j];
      norm += c[i] * (c[i] * gram[i][i] + 2. * row);
    }
    const Lanes mass = w.mass + area_change * (m_fields->area_scale / 3);
    spectral_require_positive(mass, invalid);
    cost += norm / mass;
  }

  const Spectral_fields* m_fields = nullptr;
  const Spectral_ring_products* m_products = nullptr;
  bool m_by_rows = false; // a ring is too large to keep its inner products
  Spectral_link m_link;
  // Scratch memory that only grows; the first entries are those of the link.
  std::vector<Gram> m_gram;
  std::vector<Spectral_new_entries> m_new;
  std::vector<const double*> m_rows;
  std::vector<double> m_far;
  Aligned_buffer m_scratch;
  Spectral_merged_row m_merged;
  Spectral_change m_change;
  Lanes m_coefficients[number_of_coefficients] = {}; // of the merged vertex, for each sample
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COLLAPSE_KERNEL_H
