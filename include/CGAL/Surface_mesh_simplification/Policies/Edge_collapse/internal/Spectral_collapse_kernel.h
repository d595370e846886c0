// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COLLAPSE_KERNEL_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COLLAPSE_KERNEL_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_change.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_lanes.h>
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
 * has such cotangents that their squares leave nothing but rounding, `Spectral_change` takes the place of all that.
 *
 * The object holds the scratch memory of one thread; it allocates only while a larger ring than any
 * before comes along.
 */
class Spectral_collapse_kernel
{
public:
  static constexpr int max_samples = 4;

  enum class Topology { collapsible, link_condition, both_on_border };

  /// Collects the neighbourhood of (u,v) as it is. Unless the answer is `collapsible`, CGAL's loop would
  /// refuse the edge until something near changes, and nothing may be evaluated.
  Topology prepare(const Spectral_fields& fields, const std::vector<Spectral_ring_products>& products,
                   const Spectral_slot u, const Spectral_slot v)
  {
    m_fields = &fields;
    m_products = &products;
    m_u = u;
    m_v = v;
    m_v_in_u = fields.rings.find(u, v);
    CGAL_assertion(m_v_in_u < fields.rings[u].size());
    m_u_in_v = fields.rings[u][m_v_in_u].back;
    CGAL_assertion(fields.rings[v][m_u_in_v].vertex == u);
    const Topology topology = check_topology();
    if(topology == Topology::collapsible) {
      m_roughness = 0;
#ifdef CGAL_SPECTRAL_DISPATCH
      if(spectral_has_avx2())
        prepare_avx2();
      else
#endif
        prepare_body();
    }
    return topology;
  }

  /// Fills `cost` of up to four samples; infinity where a triangle without area would arise.
  void evaluate(Spectral_sample* samples, const int count)
  {
    CGAL_precondition(count >= 1 && count <= max_samples);
#ifdef CGAL_SPECTRAL_DISPATCH
    if(spectral_has_avx2())
      evaluate_avx2(samples, count);
    else
#endif
      evaluate_body(samples, count);
    if(m_roughness > rough_cotangent)
      correct(samples, count);
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

  // Which ends of the edge a vertex of the link is next to.
  enum Ends { next_to_u_and_v, next_to_u, next_to_v, number_of_ends };

  struct Link_vertex
  {
    Link_vertex() {} // leaves `gram` as it is, which is filled where it is read

    Spectral_slot slot;
    int in_u = -1, in_v = -1;      // its index in the rings of u and v
    int u_in = -1, v_in = -1;      // their indices in its own ring
    int neighbor_in[2] = {0, 0};   // its neighbours along the link, in its own ring
    int neighbor_near[2] = {0, 0}; // the same in the ring of the one end that it is next to
    // Half cotangents and shares of area of the triangles that go.
    double old_near = 0, old_far = 0, area_near = 0, area_far = 0; // of the columns near and far
    int ends = next_to_u_and_v;
    double old_u = 0, old_v = 0, old_neighbor[2] = {0, 0};
    double old_area = 0, old_area_u = 0, old_area_v = 0, old_area_neighbor[2] = {0, 0};
    double gram[columns][columns]; // upper triangle

    bool next_to_both() const { return in_u >= 0 && in_v >= 0; }
  };

  // A triangle around u or v that survives the collapse as (x; a, b); a and b index the link, and each names the
  // other by a column.
  struct Outer_triangle
  {
    int a, b, column_of_b, column_of_a;
    bool degenerate;
  };

  // CGAL's link condition, and its refusal of inner edges between border vertices. Both depend only
  // on the rings of u and v, and whenever those change CGAL costs the edge again.
  Topology check_topology() const
  {
    const Spectral_rings& rings = m_fields->rings;
    const Spectral_ring& ring = rings[m_u];
    const std::size_t i = m_v_in_u, before = Spectral_rings::prev(ring, i);
    for(std::size_t j = 0; j < ring.size(); ++j) {
      const bool shares_face =
          (j == Spectral_rings::next(ring, i) && ring[i].face) || (j == before && ring[before].face);
      if(j != i && !shares_face && rings.find(m_v, ring[j].vertex) < rings[m_v].size())
        return Topology::link_condition;
    }
    if(ring[i].face && ring[before].face && rings.is_border(m_u) && rings.is_border(m_v))
      return Topology::both_on_border;
    return Topology::collapsible;
  }

#ifdef CGAL_SPECTRAL_DISPATCH
  CGAL_SPECTRAL_AVX2 void prepare_avx2()
  {
    prepare_body();
  }
  CGAL_SPECTRAL_AVX2 void evaluate_avx2(Spectral_sample* samples, const int count)
  {
    evaluate_body(samples, count);
  }
#endif

  CGAL_SPECTRAL_INLINE void prepare_body()
  {
    collect_link();
    m_outer.clear();
    collect_triangles(m_u, m_v, true);
    collect_triangles(m_v, m_u, false);
    const Ring of_u = (*m_products)[m_u].view(), of_v = (*m_products)[m_v].view();
    for(Link_vertex& w : m_link) {
      set_ends(w);
      gather_gram(w, of_u, of_v);
    }
    multiply_far_residuals(m_u, m_v, true);
    multiply_far_residuals(m_v, m_u, false);
    m_merged.prepare(*m_fields, (*m_products)[m_u], (*m_products)[m_v], m_u, m_v, m_v_in_u, m_u_in_v);
  }

  // First the ring of u without v, in order, then what only the ring of v has.
  void collect_link()
  {
    const Spectral_rings& rings = m_fields->rings;
    m_link.clear();
    m_before = m_fields->E[m_u] + m_fields->E[m_v];
    m_link_of_u.assign(rings[m_u].size(), -1);
    m_link_of_v.assign(rings[m_v].size(), -1);
    const Spectral_ring &ring_u = rings[m_u], &ring_v = rings[m_v];
    for(std::size_t i = 0; i < ring_u.size(); ++i)
      if(i != m_v_in_u) {
        m_link_of_u[i] = int(m_link.size());
        Link_vertex& w = add_to_link(ring_u[i].vertex);
        w.in_u = int(i);
        w.u_in = int(ring_u[i].back);
      }
    // By the link condition a vertex next to both makes a face with the edge.
    const std::size_t beside[2] = {Spectral_rings::next(ring_u, m_v_in_u),
                                   Spectral_rings::prev(ring_u, m_v_in_u)};
    for(std::size_t i = 0; i < ring_v.size(); ++i) {
      const Spectral_slot s = ring_v[i].vertex;
      if(s == m_u)
        continue;
      int k = int(m_link.size());
      if(ring_u[beside[0]].vertex == s)
        k = m_link_of_u[beside[0]];
      else if(ring_u[beside[1]].vertex == s)
        k = m_link_of_u[beside[1]];
      else
        add_to_link(s);
      m_link_of_v[i] = k;
      m_link[k].in_v = int(i);
      m_link[k].v_in = int(ring_v[i].back);
    }
  }

  Link_vertex& add_to_link(const Spectral_slot s)
  {
    m_link.emplace_back();
    m_link.back().slot = s;
    m_before += m_fields->E[s];
    return m_link.back();
  }

  // Triangles with both u and v are seen from both ends; they are taken once.
  void collect_triangles(const Spectral_slot center, const Spectral_slot other, const bool with_shared)
  {
    const Spectral_ring_entry* const ring = m_fields->rings[center].data();
    const std::size_t d = m_fields->rings[center].size();
    const int* const link_of = (center == m_u ? m_link_of_u : m_link_of_v).data();
    for(std::size_t i = 0; i < d; ++i) {
      if(!ring[i].face)
        continue;
      const std::size_t j = i + 1 == d ? 0 : i + 1;
      if(ring[i].vertex != other && ring[j].vertex != other)
        add_outer_triangle(ring[i].triangle, center == m_u, i, j, link_of[i], link_of[j]);
      else if(with_shared)
        subtract_shared_triangle(ring[i].triangle, ring[i].vertex == other,
                                 link_of[ring[i].vertex == other ? j : i]);
    }
  }

  // In the ring of a the corner b of the triangle (c; a, b) comes before c, in that of b the corner a comes after it.
  void add_outer_triangle(const Spectral_triangle& t, const bool around_u, const std::size_t i,
                          const std::size_t j, const int a, const int b)
  {
    Link_vertex &wa = m_link[a], &wb = m_link[b];
    const int column_of_b = wa.next_to_both() ? (around_u ? 0 : 1) : 0;
    const int column_of_a = wb.next_to_both() ? (around_u ? 0 : 1) : 1;
    const int in_a = around_u ? wa.u_in : wa.v_in, in_b = around_u ? wb.u_in : wb.v_in;
    wa.neighbor_in[column_of_b] = in_a == 0 ? degree(wa.slot) - 1 : in_a - 1;
    wb.neighbor_in[column_of_a] = in_b + 1 == degree(wb.slot) ? 0 : in_b + 1;
    wa.neighbor_near[column_of_b] = int(j);
    wb.neighbor_near[column_of_a] = int(i);
    (around_u ? wa.old_u : wa.old_v) += t.cot_second / 2;
    (around_u ? wb.old_u : wb.old_v) += t.cot_first / 2;
    (around_u ? wa.old_area_u : wa.old_area_v) += t.area;
    (around_u ? wb.old_area_u : wb.old_area_v) += t.area;
    for(const int side : {0, 1}) {
      Link_vertex& w = side == 0 ? wa : wb;
      const int column = side == 0 ? column_of_b : column_of_a;
      w.old_neighbor[column] += t.cot_center / 2;
      w.old_area_neighbor[column] += t.area;
      w.old_area += t.area;
    }
    m_roughness = (std::max)(m_roughness, sum_of_cotangents(t));
    m_outer.push_back(Outer_triangle{a, b, column_of_b, column_of_a, degenerate(t)});
  }

  int degree(const Spectral_slot s) const
  {
    return int((*m_products)[s].degree());
  }

  void subtract_shared_triangle(const Spectral_triangle& t, const bool v_is_first, const int link)
  {
    m_roughness = (std::max)(m_roughness, sum_of_cotangents(t));
    Link_vertex& w = m_link[link];
    w.old_u += (v_is_first ? t.cot_first : t.cot_second) / 2; // the angle at v
    w.old_v += t.cot_center / 2;                              // the angle at u
    w.old_area += t.area;
    w.old_area_u += t.area;
    w.old_area_v += t.area;
  }

  static void set_ends(Link_vertex& w)
  {
    const bool both = w.next_to_both(), near_u = w.in_u >= 0;
    w.ends = both ? next_to_u_and_v : near_u ? next_to_u : next_to_v;
    w.old_near = near_u ? w.old_u : w.old_v;
    w.area_near = near_u ? w.old_area_u : w.old_area_v;
    w.old_far = both ? w.old_v : 0;
    w.area_far = both ? w.old_area_v : 0;
  }

  // A cotangent of 1e10 means an angle of 1e-10: such a triangle has no area that doubles can tell.
  static constexpr double degenerate_cotangent = 1e10;
  static bool degenerate(const Spectral_triangle& t)
  {
    return !(t.area > 0) || !(sum_of_cotangents(t) < degenerate_cotangent);
  }

  // (a^2 + b^2 + c^2) / (4 area): never negative, and large where one of them is.
  static double sum_of_cotangents(const Spectral_triangle& t)
  {
    return t.cot_center + t.cot_first + t.cot_second;
  }

  // The square of 1e5, times the rounding of doubles, is 1e-6, of costs that matter from about 1e-3.
  static constexpr double rough_cotangent = 1e5;
  void correct(Spectral_sample* samples, const int count)
  {
    for(int s = 0; s < count; ++s)
      if(std::isfinite(samples[s].cost))
        samples[s].cost = m_change(*m_fields, m_u, m_v, samples[s].weight, samples[s].point);
  }

  CGAL_SPECTRAL_INLINE void gather_gram(Link_vertex& w, const Ring& of_u, const Ring& of_v) const
  {
    const Ring own = (*m_products)[w.slot].view();
    w.gram[residual][residual] = m_fields->E[w.slot] * m_fields->mass[w.slot];
    if(w.next_to_both())
      gather_own<true>(w, own, std::size_t(w.u_in), std::size_t(w.v_in));
    else {
      const bool near_u = w.in_u >= 0;
      gather_own<false>(w, own, std::size_t(near_u ? w.u_in : w.v_in), own.d);
      gather_far(w, near_u ? of_u : of_v, std::size_t(near_u ? w.in_u : w.in_v),
                 near_u ? m_v_in_u : m_u_in_v);
    }
  }

  // Products among the differences and the rows of Z at ring indices near, far and those of the two neighbours in the
  // ring of w; with the far one only if `Far`.
  template <bool Far>
  CGAL_SPECTRAL_INLINE void gather_own(Link_vertex& w, const Ring& own, const std::size_t near,
                                       const std::size_t far) const
  {
    const std::size_t first = std::size_t(w.neighbor_in[0]), second = std::size_t(w.neighbor_in[1]),
                      d = own.d;
    const bool full = m_fields->theta != 0;
    const double *const z = own.z_g(d), *const zz = own.z(d);
    w.gram[residual][z_self] = own.rz[full ? d : 0];
    w.gram[z_self][z_self] = zz[d];
    const double* g = own.g(near);
    w.gram[residual][g_near] = own.rg[near];
    w.gram[z_self][g_near] = z[near];
    w.gram[g_near][g_near] = g[near];
    w.gram[g_near][g_first] = g[first];
    w.gram[g_near][g_second] = g[second];
    if(Far) {
      w.gram[g_near][g_far] = g[far];
      g = own.g(far);
      w.gram[residual][g_far] = own.rg[far];
      w.gram[z_self][g_far] = z[far];
      w.gram[g_far][g_far] = g[far];
      w.gram[g_far][g_first] = g[first];
      w.gram[g_far][g_second] = g[second];
    }
    g = own.g(first);
    w.gram[residual][g_first] = own.rg[first];
    w.gram[z_self][g_first] = z[first];
    w.gram[g_first][g_first] = g[first];
    w.gram[g_first][g_second] = g[second];
    w.gram[residual][g_second] = own.rg[second];
    w.gram[z_self][g_second] = z[second];
    w.gram[g_second][g_second] = own.g(second)[second];
    if(!full)
      return;
    const std::size_t in[4] = {near, far, first, second};
    for(int j = 0; j < 4; ++j) {
      if(!Far && j == 1)
        continue;
      const double *const row_g = own.z_g(in[j]), *const row_z = own.z(in[j]);
      w.gram[residual][z_near + j] = own.rz[in[j]];
      w.gram[z_self][z_near + j] = zz[in[j]];
      w.gram[g_near][z_near + j] = row_g[near];
      if(Far)
        w.gram[g_far][z_near + j] = row_g[far];
      w.gram[g_first][z_near + j] = row_g[first];
      w.gram[g_second][z_near + j] = row_g[second];
      for(int i = 0; i <= j; ++i)
        w.gram[z_near + i][z_near + j] = row_z[in[i]];
    }
  }

  // The far end o is not in the ring of w, but both are in that of the near end c: e = f_o - f_c is one of
  // its differences, and f_i - f_w = (f_i - f_c) - (f_w - f_c). `self` and `o` are the indices of w and o there.
  CGAL_SPECTRAL_INLINE void gather_far(Link_vertex& w, const Ring& near, const std::size_t self,
                                       const std::size_t o) const
  {
    const std::size_t first = std::size_t(w.neighbor_near[0]), second = std::size_t(w.neighbor_near[1]);
    const double* const e = near.g(o);
    w.gram[z_self][g_far] = near.z_g(self)[o];
    w.gram[g_far][g_far] = e[o];
    w.gram[g_near][g_far] = -e[self];
    w.gram[g_far][g_first] = e[first] - e[self];
    w.gram[g_far][g_second] = e[second] - e[self];
    if(m_fields->theta == 0)
      return;
    const std::size_t in[4] = {near.d, o, first, second};
    const double *const z_o = near.z_g(o), *const zz_o = near.z(o);
    for(int j = 0; j < 4; ++j) {
      w.gram[g_far][z_near + j] = near.z_g(in[j])[o];
      if(j != 1)
        w.gram[(std::min)(z_near + j, int(z_far))][(std::max)(z_near + j, int(z_far))] = zz_o[in[j]];
    }
    w.gram[z_self][z_far] = zz_o[self];
    w.gram[z_far][z_far] = zz_o[o];
    w.gram[g_near][z_far] = -z_o[self];
    w.gram[g_first][z_far] = z_o[first] - z_o[self];
    w.gram[g_second][z_far] = z_o[second] - z_o[self];
  }

  // R_w . (f_o - f_c), and R_w . z_o, for each w next to the end c alone.
  CGAL_SPECTRAL_INLINE void multiply_far_residuals(const Spectral_slot c, const Spectral_slot o,
                                                   const bool near_u)
  {
    const Spectral_fields& fields = *m_fields;
    const std::size_t length = std::size_t(fields.F.cols());
    const int ends = near_u ? next_to_u : next_to_v;
    m_rows.clear();
    for(const Link_vertex& w : m_link)
      if(w.ends == ends)
        m_rows.push_back(fields.r_row(w.slot));
    if(m_rows.empty())
      return;
    m_far.resize(2 * m_rows.size());
    const Spectral_row_list rows{m_rows.data(), m_rows.size()};
    const double* row = fields.f_row(o);
    spectral_dots<false, true>(rows, {&row, 1, fields.f_row(c)}, length, m_far.data(), 2);
    if(fields.theta != 0) {
      m_scratch.resize(length);
      row = fields.z_row(o, m_scratch.data());
      spectral_dots<false, false>(rows, {&row, 1}, length, m_far.data() + 1, 2);
    }
    const double* next = m_far.data();
    for(Link_vertex& w : m_link)
      if(w.ends == ends) {
        w.gram[residual][g_far] = next[0];
        w.gram[residual][z_far] = next[1];
        next += 2;
      }
  }

  CGAL_SPECTRAL_INLINE void evaluate_body(Spectral_sample* samples, const int count)
  {
    Lanes weight, invalid = {}, cost = {-m_before, -m_before, -m_before, -m_before}, point[3];
    for(int s = 0; s < max_samples; ++s) {
      const Spectral_sample& sample = samples[s < count ? s : 0];
      weight[s] = sample.weight;
      for(int c = 0; c < 3; ++c)
        point[c][s] = sample.point[c];
    }
    Lanes total_area = {};
    if(m_fields->theta != 0)
      add_link_terms<true>(point, weight, total_area, cost, invalid);
    else
      add_link_terms<false>(point, weight, total_area, cost, invalid);
    m_merged.add_term(m_new.data(), total_area, weight, m_fields->diagonal_share() * m_fields->area_scale,
                      m_fields->off_diagonal_share() * m_fields->area_scale, m_fields->area_scale, cost);
    for(int s = 0; s < count; ++s)
      samples[s].cost =
          invalid[s] == 0 && std::isfinite(cost[s]) ? cost[s] : std::numeric_limits<double>::infinity();
  }

  // `Full`: with a mass that has off-diagonal entries.
  template <bool Full>
  CGAL_SPECTRAL_INLINE void add_link_terms(const Lanes* x, const Lanes& weight, Lanes& total_area,
                                           Lanes& cost, Lanes& invalid)
  {
    add_new_triangles<Full>(x, total_area, invalid);
    // f_x = (1 - weight) f_u + weight f_v where w is next to both, f_near + far (f_o - f_c) where next to one end c.
    const Lanes one = {1, 1, 1, 1}, rest = 1. - weight;
    const Lanes near[number_of_ends] = {rest, one, one}, far[number_of_ends] = {weight, weight, rest};
    for(std::size_t i = 0; i < m_link.size(); ++i)
      add_link_term<Full>(m_link[i], m_new[i], near[m_link[i].ends], far[m_link[i].ends], cost, invalid);
  }

  template <bool Full>
  CGAL_SPECTRAL_INLINE void add_new_triangles(const Lanes* x, Lanes& total_area, Lanes& invalid)
  {
    const Lanes zero = {};
    m_new.assign(m_link.size(), Spectral_new_entries{zero, {zero, zero}, zero, {zero, zero}});
    for(const Outer_triangle& o : m_outer) {
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
      const Lanes bound = sum * sum * (1 / (degenerate_cotangent * degenerate_cotangent));
      Lanes half, failed = {};
      spectral_inverse_sqrt(half, square, bound, failed);
      half *= Lanes{0.5, 0.5, 0.5, 0.5};
      if(!o.degenerate)
        invalid += failed;
      const Lanes cot_x = a_b * half, cot_a = -a_ab * half, cot_b = b_ab * half, area = square * half;
      add_new_entries<Full>(m_new[o.a], o.column_of_b, cot_b, cot_x, area);
      add_new_entries<Full>(m_new[o.b], o.column_of_a, cot_a, cot_x, area);
      total_area += area;
    }
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
  CGAL_SPECTRAL_INLINE void add_link_term(const Link_vertex& w, const Spectral_new_entries& fresh,
                                          const Lanes& near, const Lanes& far, Lanes& cost,
                                          Lanes& invalid) const
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
        row += c[j] * w.gram[i][j];
      norm += c[i] * (c[i] * w.gram[i][i] + 2. * row);
    }
    const Lanes mass = m_fields->mass[w.slot] + area_change * (m_fields->area_scale / 3);
    spectral_require_positive(mass, invalid);
    cost += norm / mass;
  }

  const Spectral_fields* m_fields = nullptr;
  const std::vector<Spectral_ring_products>* m_products = nullptr;
  Spectral_slot m_u = null_spectral_slot, m_v = null_spectral_slot;
  std::size_t m_v_in_u = 0, m_u_in_v = 0;
  double m_before = 0;
  double m_roughness = 0; // largest sum of cotangents among the triangles around the edge
  std::vector<Link_vertex> m_link;
  std::vector<int> m_link_of_u, m_link_of_v; // ring index -> link index
  std::vector<Outer_triangle> m_outer;
  std::vector<Spectral_new_entries> m_new;
  std::vector<const double*> m_rows;
  std::vector<double> m_far, m_scratch;
  Spectral_merged_row m_merged;
  Spectral_change m_change;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COLLAPSE_KERNEL_H
