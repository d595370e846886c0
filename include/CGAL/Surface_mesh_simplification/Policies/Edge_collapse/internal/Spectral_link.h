// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_LINK_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_LINK_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_lanes.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_ring_products.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_rings.h>

#include <CGAL/assertions.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

// An edge (u,v) with its two rings, as this file, Spectral_merged_row.h and Spectral_ring_products.h number them. The rings run
// counterclockwise; s and t see both ends, the a_i see u alone, the b_i see v alone.
//
//        a0 ---- s ---- b2         link, in the order of its numbers:  a0 a1 t s  b1 b2   (the ring of u without v, from wherever
//       / \    / \    / \                                             it starts, then those of v alone)
//     a1 --- u --- v --- b1        goes:      (u v s) and (v u t), the triangles of the edge
//       \ /    \ /    \ /          survives:  (u; a0 a1), (v; b1 b2), ... as (x; ., .), the outer triangles
//        .  --- t ---- .           H = {x} + link, whose E_w a collapse changes
//
// in_u, in_v: place in the ring of u, of v.  u_in, v_in: place of u, v in one's own ring.  near: the end that one sees, u if both;
// far: the other end.  neighbor[0], neighbor[1]: before and after one along the link.

/// Which ends of an edge a vertex of its link is next to.
enum Spectral_link_ends { next_to_u_and_v, next_to_u, next_to_v, number_of_link_ends };

/// A vertex w of the link of an edge (u,v), and what the triangles that go give to its row: half cotangents and
/// areas. c is the end that w is next to, u where it is next to both; columns as in `Spectral_collapse_kernel`.
struct Spectral_link_vertex
{
  Spectral_slot slot;
  Spectral_link_ends ends;
  std::uint32_t in_u, in_v;       ///< its index in the rings of u and v, where it is in them
  std::uint32_t u_in, v_in;       ///< their indices in its own ring, where they are in it
  std::uint32_t neighbor_in[2];   ///< its neighbours along the link, in its own ring
  std::uint32_t neighbor_near[2]; ///< the same in the ring of c, where w is next to c alone
  double old_near, old_far, area_near, area_far;
  double old_neighbor[2], old_area_neighbor[2], old_area;
  double mass;
};

/// A triangle around u or v that survives the collapse as (x; a, b); a and b index the link, and each names the
/// other by a column.
struct Spectral_outer_triangle
{
  std::uint32_t a, b;
  int column_of_b, column_of_a;
  bool degenerate;
};

/*!
 * The link of an edge (u,v): the ring of u without v, in order, then what only the ring of v has. Holds scratch memory of
 * one thread, which only ever grows.
 */
class Spectral_link
{
public:
  using Vertex = Spectral_link_vertex;
  using Triangle = Spectral_outer_triangle;

  enum class Topology { collapsible, link_condition, both_on_border };

  /// CGAL's link condition, and its refusal of inner edges between border vertices. Both depend only on the rings of u and
  /// v, and whenever those change CGAL costs the edge again. collect() may follow if the answer is `collapsible`.
  Topology set_edge(const Spectral_fields& fields, const Spectral_slot u, const Spectral_slot v)
  {
    const Spectral_rings& rings = fields.rings;
    m_u = u;
    m_v = v;
    if(!fields.has_products(u) || !fields.has_products(v))
      return set_edge_at_large_ring(rings);
    m_v_in_u = rings.find(u, v);
    CGAL_assertion(m_v_in_u < rings[u].size());
    m_u_in_v = rings[u][m_v_in_u].back;
    CGAL_assertion(rings[v][m_u_in_v].vertex == u);

    std::uint64_t near_v = 0; // one bit for 64 slots: most vertices are seen not to be in the ring at once
    for(const Spectral_ring_entry& e : rings[v])
      near_v |= bit(e.vertex);
    const Spectral_ring& ring = rings[u];
    const std::size_t before = Spectral_rings::prev(ring, m_v_in_u),
                      after = Spectral_rings::next(ring, m_v_in_u);
    bool border_u = false;
    for(std::size_t j = 0; j < ring.size(); ++j) {
      border_u |= !ring[j].face;
      const bool shares_face = (j == after && ring[m_v_in_u].face) || (j == before && ring[before].face);
      if((near_v & bit(ring[j].vertex)) != 0 && j != m_v_in_u && !shares_face &&
         rings.find(v, ring[j].vertex) < rings[v].size())
        return Topology::link_condition;
    }
    if(border_u && ring[m_v_in_u].face && ring[before].face && rings.is_border(v))
      return Topology::both_on_border;
    return Topology::collapsible;
  }

  /// Whether all products that a cost needs are there.
  bool has_products(const Spectral_fields& fields) const
  {
    if(fields.largest_degree <= fields.largest_degree_with_products)
      return true;
    for(const Spectral_slot c : {m_u, m_v}) {
      if(!fields.has_products(c))
        return false;
      for(const Spectral_ring_entry& e : fields.rings[c])
        if(!fields.has_products(e.vertex))
          return false;
    }
    return true;
  }

  /// Collects the vertices and the outer triangles; has_products() holds.
  CGAL_SPECTRAL_INLINE void collect(const Spectral_fields& fields,
                                    const std::vector<Spectral_ring_products>& products)
  {
    const Spectral_ring &ring_u = fields.rings[m_u], &ring_v = fields.rings[m_v];
    reserve(ring_u.size() + ring_v.size());
    m_roughness = 0;
    m_unit = fields.conductivity;
    m_before = fields.E[m_u] + fields.E[m_v];
    m_number_of_triangles = 0;
    m_size = 0;
    collect_ring_of_u(fields, products, ring_u.data(), ring_u.size());
    collect_ring_of_v(fields, products, ring_v.data(), ring_v.size());
    if(fields.voronoi)
      collect_own_areas(fields);
  }

  Spectral_slot u() const { return m_u; }
  Spectral_slot v() const { return m_v; }
  std::size_t v_in_u() const { return m_v_in_u; } ///< the index of v in the ring of u
  std::size_t u_in_v() const { return m_u_in_v; }
  std::size_t size() const { return m_size; }
  const Vertex& operator[](const std::size_t i) const { return m_vertices[i]; }
  const Vertex* begin() const { return m_vertices.data(); }
  const Vertex* end() const { return m_vertices.data() + m_size; }
  const Triangle* triangles_begin() const { return m_triangles.data(); }
  const Triangle* triangles_end() const { return m_triangles.data() + m_number_of_triangles; }
  /// The sum of E over u, v and the link.
  double error() const { return m_before; }
  /// The largest sum of cotangents among the triangles around u and v, in units of the conductivity.
  double roughness() const { return m_roughness; }

private:
  // The same in time linear in the smaller ring, but for the border of the larger one.
  Topology set_edge_at_large_ring(const Spectral_rings& rings)
  {
    const bool small_u = rings[m_u].size() <= rings[m_v].size();
    const Spectral_slot c = small_u ? m_u : m_v, o = small_u ? m_v : m_u;
    const Spectral_ring& ring = rings[c];
    const std::size_t o_in_c = rings.find(c, o);
    CGAL_assertion(o_in_c < ring.size());
    m_v_in_u = small_u ? o_in_c : ring[o_in_c].back;
    m_u_in_v = small_u ? ring[o_in_c].back : o_in_c;
    const std::size_t before = Spectral_rings::prev(ring, o_in_c), after = Spectral_rings::next(ring, o_in_c);
    for(std::size_t j = 0; j < ring.size(); ++j) {
      const bool shares_face = (j == after && ring[o_in_c].face) || (j == before && ring[before].face);
      if(j != o_in_c && !shares_face && rings.are_adjacent(o, ring[j].vertex))
        return Topology::link_condition;
    }
    if(ring[o_in_c].face && ring[before].face && rings.is_border(c) && rings.is_border(o))
      return Topology::both_on_border;
    return Topology::collapsible;
  }

  static std::uint64_t bit(const Spectral_slot s) { return std::uint64_t(1) << (s & 63); }

  void reserve(const std::size_t n)
  {
    if(m_vertices.size() >= n)
      return;
    m_vertices.resize(n);
    m_triangles.resize(n);
    m_of_v.resize(n);
  }

  // (a^2 + b^2 + c^2) / (4 area): never negative, and large where one of them is.
  static double sum_of_cotangents(const Spectral_triangle& t)
  {
    return t.cot_center + t.cot_first + t.cot_second;
  }

  static std::uint32_t before(const std::uint32_t i, const std::size_t size)
  {
    return i == 0 ? std::uint32_t(size) - 1 : i - 1;
  }
  static std::uint32_t after(const std::uint32_t i, const std::size_t size)
  {
    return i + 1 == size ? 0 : i + 1;
  }

  CGAL_SPECTRAL_INLINE void add_triangle(const Spectral_triangle& t, const std::size_t a, const std::size_t b,
                                         const int column_of_b, const int column_of_a)
  {
    const double sum = sum_of_cotangents(t) / m_unit;
    m_roughness = (std::max)(m_roughness, sum);
    m_triangles[m_number_of_triangles++] =
        Triangle{std::uint32_t(a), std::uint32_t(b), column_of_b, column_of_a,
                 !(t.area > 0) || !(sum < Spectral_triangle::degenerate_cotangent)};
  }

  CGAL_SPECTRAL_INLINE Vertex& add_vertex(const Spectral_fields& fields, const Spectral_slot s)
  {
    Vertex& w = m_vertices[m_size++];
    w.slot = s;
    w.mass = fields.mass[s];
    m_before += fields.E[s];
    return w;
  }

  // Around c a vertex w of the ring has the triangles (c; w, next) and (c; previous, w); those without a face are 0. In
  // the ring of w the next vertex comes before c, the previous one after it.
  CGAL_SPECTRAL_INLINE static void set_one_end(Vertex& w, const Spectral_triangle& to_next,
                                               const Spectral_triangle& to_previous, const std::uint32_t c_in,
                                               const std::size_t degree, const std::size_t next,
                                               const std::size_t previous)
  {
    w.neighbor_in[0] = before(c_in, degree);
    w.neighbor_in[1] = after(c_in, degree);
    w.neighbor_near[0] = std::uint32_t(next);
    w.neighbor_near[1] = std::uint32_t(previous);
    w.old_near = (to_next.cot_second + to_previous.cot_first) / 2;
    w.old_area = w.area_near = to_next.area + to_previous.area;
    w.old_far = w.area_far = 0;
    w.old_neighbor[0] = to_next.cot_center / 2;
    w.old_neighbor[1] = to_previous.cot_center / 2;
    w.old_area_neighbor[0] = to_next.area;
    w.old_area_neighbor[1] = to_previous.area;
  }

  // Next to both: one triangle with both (two, if the mesh has no other), and at most one other around each end.
  static void start_both_ends(Vertex& w)
  {
    w.ends = next_to_u_and_v;
    w.old_near = w.old_far = w.area_near = w.area_far = w.old_area = 0;
    for(const int column : {0, 1}) {
      w.neighbor_in[column] = w.neighbor_near[column] = 0;
      w.old_neighbor[column] = w.old_area_neighbor[column] = 0;
    }
  }

  static void add_shared_triangle(Vertex& w, const double at_v, const Spectral_triangle& around_u)
  {
    w.old_near += at_v / 2;
    w.old_far += around_u.cot_center / 2;
    w.old_area += around_u.area;
    w.area_near += around_u.area;
    w.area_far += around_u.area;
  }

  // `at_neighbor` is the cotangent at the neighbour `neighbor_in`; column 0 around u, 1 around v.
  static void add_outer_triangle(Vertex& w, const int column, const double at_neighbor,
                                 const Spectral_triangle& t, const std::uint32_t neighbor_in)
  {
    (column == 0 ? w.old_near : w.old_far) += at_neighbor / 2;
    (column == 0 ? w.area_near : w.area_far) += t.area;
    w.old_neighbor[column] += t.cot_center / 2;
    w.old_area_neighbor[column] += t.area;
    w.old_area += t.area;
    w.neighbor_in[column] = neighbor_in;
  }

  CGAL_SPECTRAL_INLINE void collect_ring_of_u(const Spectral_fields& fields,
                                              const std::vector<Spectral_ring_products>& products,
                                              const Spectral_ring_entry* ring, const std::size_t d)
  {
    const std::size_t o = m_v_in_u;
    std::size_t previous = d - 1;
    for(std::size_t i = 0; i < d; previous = i++) {
      if(i == o)
        continue;
      const std::size_t next = i + 1 == d ? 0 : i + 1, index = m_size;
      const Spectral_triangle &to_next = ring[i].triangle, &to_previous = ring[previous].triangle;
      const bool shares_next = next == o && ring[i].face, shares_previous = previous == o && ring[o].face;
      const std::uint32_t u_in = ring[i].back;
      const std::size_t degree = products[ring[i].vertex].degree();
      Vertex& w = add_vertex(fields, ring[i].vertex);
      w.in_u = std::uint32_t(i);
      w.u_in = u_in;
      if(!shares_next && !shares_previous) {
        w.ends = next_to_u;
        set_one_end(w, to_next, to_previous, u_in, degree, next, previous);
      } else {
        start_both_ends(w);
        if(shares_next) {
          add_shared_triangle(w, to_next.cot_second, to_next);
          m_roughness = (std::max)(m_roughness, sum_of_cotangents(to_next) / m_unit);
        } else if(ring[i].face)
          add_outer_triangle(w, 0, to_next.cot_second, to_next, before(u_in, degree));
        if(shares_previous) {
          add_shared_triangle(w, to_previous.cot_first, to_previous);
          m_roughness = (std::max)(m_roughness, sum_of_cotangents(to_previous) / m_unit);
        } else if(ring[previous].face)
          add_outer_triangle(w, 0, to_previous.cot_first, to_previous, after(u_in, degree));
      }
      if(ring[i].face && next != o) {
        const bool both = (next + 1 == d ? 0 : next + 1) == o && ring[next].face;
        add_triangle(to_next, index, next - (next > o ? 1 : 0), 0, both ? 0 : 1);
      }
    }
  }

  CGAL_SPECTRAL_INLINE void collect_ring_of_v(const Spectral_fields& fields,
                                              const std::vector<Spectral_ring_products>& products,
                                              const Spectral_ring_entry* ring, const std::size_t d)
  {
    const std::size_t o = m_u_in_v, first = m_size;
    find_both(ring, d);
    std::size_t previous = d - 1;
    for(std::size_t i = 0; i < d; previous = i++) {
      if(i == o)
        continue;
      const std::size_t next = i + 1 == d ? 0 : i + 1;
      const Spectral_triangle &to_next = ring[i].triangle, &to_previous = ring[previous].triangle;
      const std::uint32_t v_in = ring[i].back;
      const std::size_t degree = products[ring[i].vertex].degree();
      if(m_of_v[i] >= first) {
        Vertex& w = add_vertex(fields, ring[i].vertex);
        w.ends = next_to_v;
        w.in_v = std::uint32_t(i);
        w.v_in = v_in;
        set_one_end(w, to_next, to_previous, v_in, degree, next, previous);
      } else {
        Vertex& w = m_vertices[m_of_v[i]];
        w.in_v = std::uint32_t(i);
        w.v_in = v_in;
        if(next != o && ring[i].face)
          add_outer_triangle(w, 1, to_next.cot_second, to_next, before(v_in, degree));
        if(previous != o && ring[previous].face)
          add_outer_triangle(w, 1, to_previous.cot_first, to_previous, after(v_in, degree));
      }
      if(ring[i].face && next != o)
        add_triangle(to_next, m_of_v[i], m_of_v[next], m_of_v[i] < first ? 1 : 0, 1);
    }
  }

  // The number in the link of each vertex in the ring of v. By the link condition one that is next to both makes a
  // face with the edge.
  CGAL_SPECTRAL_INLINE void find_both(const Spectral_ring_entry* ring, const std::size_t d)
  {
    std::uint32_t both[2] = {0, 0}, count = 0;
    for(std::uint32_t k = 0; k < m_size && count < 2; ++k)
      if(m_vertices[k].ends == next_to_u_and_v)
        both[count++] = k;
    std::uint32_t fresh = std::uint32_t(m_size);
    for(std::size_t i = 0; i < d; ++i) {
      if(i == m_u_in_v)
        continue;
      if(count > 0 && m_vertices[both[0]].slot == ring[i].vertex)
        m_of_v[i] = both[0];
      else if(count > 1 && m_vertices[both[1]].slot == ring[i].vertex)
        m_of_v[i] = both[1];
      else
        m_of_v[i] = fresh++;
    }
  }

  // Where a triangle's area is not divided equally: what those with u or v give to each vertex of the link.
  void collect_own_areas(const Spectral_fields& fields)
  {
    for(std::size_t k = 0; k < m_size; ++k) {
      Vertex& w = m_vertices[k];
      const Spectral_ring& ring = fields.rings[w.slot];
      w.old_area = 0;
      for(std::size_t i = 0; i < ring.size(); ++i) {
        const Spectral_slot a = ring[i].vertex, b = ring[Spectral_rings::next(ring, i)].vertex;
        if(a == m_u || a == m_v || b == m_u || b == m_v)
          w.old_area += fields.area_of_center(ring[i].triangle);
      }
    }
  }

  Spectral_slot m_u = null_spectral_slot, m_v = null_spectral_slot;
  std::size_t m_v_in_u = 0, m_u_in_v = 0;
  double m_before = 0, m_roughness = 0, m_unit = 1;
  std::size_t m_size = 0, m_number_of_triangles = 0;
  std::vector<Vertex> m_vertices;
  std::vector<Triangle> m_triangles;
  std::vector<std::uint32_t> m_of_v; // ring index at v -> number in the link
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_LINK_H
