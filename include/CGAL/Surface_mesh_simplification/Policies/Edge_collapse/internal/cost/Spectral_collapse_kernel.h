// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_COLLAPSE_KERNEL_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_COLLAPSE_KERNEL_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_signals.h>

#include <CGAL/assertions.h>

namespace CGAL::Surface_mesh_simplification::internal {

/// A way to collapse an edge (u,v): x replaces both, f_x = (1 - weight) f_u + weight f_v.
///
/// The weight belongs to a slot, never to an end of a halfedge: the direction in which CGAL
/// presents the same edge can change after a collapse nearby.
struct Spectral_sample
{
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double weight = 0;
  double cost = std::numeric_limits<double>::infinity();

  bool collapsible() const { return std::isfinite(cost); }
};

// clang-format off
/*!
 * The local cost of collapsing one edge: cost = sum over H of E_w after - sum over H of E_w before,
 * where H is the merged vertex and its link (section 3.3 of the paper).
 *
 *        a0 ---- s ---- b2
 *       / \    / \    / \
 *     a1 --- u --- v --- b1
 *       \ /    \ /    \ /
 *        .  --- t ---- .
 *
 * The rings of u and v run counterclockwise; s and t see both ends, the a_i see u alone, the b_i
 * see v alone. The triangles of the edge, (u v s) and (v u t), go. The outer triangles, (u; a0 a1),
 * (v; b1 b2) and so on, become (x; ., .). H = {x} + link, whose E_w a collapse changes.
 *
 * The row of x is summed anew. For a vertex w of the link, R_w after is R_w plus what its triangles
 * around u and v give after less what they gave before: a combination of a few rows of F and Z,
 * however many neighbours w has. An end that stays where it is, with its values, keeps its
 * triangles: its own row changes as those of the link do, and of its neighbours only those change
 * that the other end shares.
 *
 * The object holds scratch memory; it allocates only when a ring is larger than any before.
 */
// clang-format on
class Spectral_collapse_kernel
{
public:
  /// Sets the edge and says whether it may be collapsed: CGAL's link condition, and its refusal of
  /// inner edges between border vertices. Both depend only on the rings of u and v, and whenever
  /// those change CGAL costs the edge again. Unless it may, nothing may be evaluated. In time
  /// linear in the smaller ring and those of its vertices, but for the border of the larger.
  bool prepare(const Spectral_fields& fields, const Spectral_slot u, const Spectral_slot v)
  {
    m_fields = &fields;
    const Spectral_rings& rings = fields.rings;
    const bool small_u = rings[u].size() <= rings[v].size();
    const Spectral_slot c = small_u ? u : v, o = small_u ? v : u;
    const Spectral_ring& ring = rings[c];
    m_end[0] = u;
    m_end[1] = v;
    const std::size_t o_in_c = rings.find(c, o);
    CGAL_assertion(o_in_c < ring.size());
    const std::size_t before = Spectral_rings::prev(ring, o_in_c),
                      after = Spectral_rings::next(ring, o_in_c);
    for(std::size_t j = 0; j < ring.size(); ++j) {
      const bool shares_face =
          (j == after && ring[o_in_c].face) || (j == before && ring[before].face);
      if(j != o_in_c && !shares_face && rings.are_adjacent(o, ring[j].vertex))
        return false;
    }
    return !(ring[o_in_c].face && ring[before].face && rings.is_border(c) && rings.is_border(o));
  }

  /// Fills the cost of a sample; infinity where a triangle without area would arise.
  void evaluate(Spectral_sample& sample)
  {
    Spectral_geometry::internal::on_vector_units([&] {
      if(m_fields->theta == 0)
        evaluate_body<false>(sample);
      else
        evaluate_body<true>(sample);
    });
    sample.cost =
        m_invalid || !std::isfinite(m_change) ? std::numeric_limits<double>::infinity() : m_change;
  }

  /// The change of E that the sample of evaluate() makes, whatever triangles arise.
  double change() const { return m_change; }

private:
  using Entry = Spectral_row_entry;
  using Slot = Spectral_slot;

  const Spectral_ring& ring(const int end) const { return m_fields->rings[m_end[end]]; }

  // Whether the i-th triangle around an end survives the collapse.
  bool is_outer(const int end, const std::size_t i) const
  {
    const std::size_t o = m_other_in[end];
    return ring(end)[i].face && i != o && Spectral_rings::next(ring(end), i) != o;
  }

  // `Full`: with a mass that has off-diagonal entries.
  template <bool Full>
  CGAL_SPECTRAL_INLINE void evaluate_body(const Spectral_sample& sample)
  {
    m_weight = sample.weight;
    m_change = -m_fields->E[m_end[0]] - m_fields->E[m_end[1]];
    m_invalid = false;
    m_staying = -1;
    for(int end = 0; end < 2; ++end)
      if(sample.weight == double(end) && sample.point == m_fields->points[m_end[end]])
        m_staying = end;
    m_off_diagonal = m_fields->off_diagonal_share() * m_fields->area_scale;
    m_row.resize((std::max)(m_row.size(), ring(0).size() + ring(1).size() + 8));
    for(int end = 0; end < 2; ++end)
      if(end != m_staying) {
        m_other_in[end] = m_fields->rings.find(m_end[end], m_end[1 - end]);
        set_outer_triangles(end, sample);
      }
    add_merged_vertex<Full>();
    for(int end = 0; end < 2; ++end)
      for(std::size_t i = 0; end != m_staying && i < ring(end).size(); ++i)
        if(i != m_other_in[end])
          add_link_vertex<Full>(end, i);
  }

  CGAL_SPECTRAL_INLINE void set_outer_triangles(const int end, const Spectral_sample& sample)
  {
    const Spectral_ring& around = ring(end);
    m_outer[end].resize((std::max)(m_outer[end].size(), around.size()));
    for(std::size_t i = 0; i < around.size(); ++i) {
      if(!is_outer(end, i))
        continue;
      const Spectral_triangle& t = m_outer[end][i] =
          triangle(sample, around[i].vertex, around[Spectral_rings::next(around, i)].vertex);
      if(is_degenerate(t) && !is_degenerate(around[i].triangle))
        m_invalid = true;
    }
  }

  // The triangle (x; a, b).
  CGAL_SPECTRAL_INLINE Spectral_triangle triangle(const Spectral_sample& x, const Slot a,
                                                  const Slot b) const
  {
    const Spectral_fields& fields = *m_fields;
    if(fields.coefficients.empty())
      return triangle(x.point, fields.points[a], fields.points[b]);
    const Spectral_geometry::internal::Point_coefficients of_x =
        (1 - x.weight) * fields.coefficients[m_end[0]] + x.weight * fields.coefficients[m_end[1]];
    const Spectral_geometry::internal::Point_coefficients mean =
        (of_x + fields.coefficients[a] + fields.coefficients[b]) / 3;
    return spectral_triangle(x.point, fields.points[a], fields.points[b], &mean);
  }

  // `spectral_triangle()`, without its search for the longest edge unless the triangle is a needle.
  CGAL_SPECTRAL_INLINE static Spectral_triangle
  triangle(const Eigen::Vector3d& x, const Eigen::Vector3d& a, const Eigen::Vector3d& b)
  {
    const double xa[3] = {a[0] - x[0], a[1] - x[1], a[2] - x[2]};
    const double xb[3] = {b[0] - x[0], b[1] - x[1], b[2] - x[2]};
    const double ab[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    double at_x, at_a, at_b, square;
    Spectral_geometry::internal::triangle_products(xa, ab, xb, at_x, at_a, at_b, square);
    constexpr double limit = Spectral_triangle::degenerate_cotangent;
    const double sum = at_x + at_a + at_b; // of the cotangents, times twice the area
    if(!(square > sum * sum * (1 / (limit * limit))))
      return spectral_triangle(x, a, b);
    const double inverse = 1 / std::sqrt(square);
    return {at_x * inverse, at_a * inverse, at_b * inverse, square * inverse * 0.5};
  }

  bool is_degenerate(const Spectral_triangle& t) const
  {
    return !(t.area > 0) || !(t.cot_center + t.cot_first + t.cot_second <
                              Spectral_triangle::degenerate_cotangent * m_fields->conductivity);
  }

  // E_x. The row of an end that stays is what it was and what the triangles around the other end
  // change.
  template <bool Full>
  CGAL_SPECTRAL_INLINE void add_merged_vertex()
  {
    double to_self = 0, area = 0;
    double lost = 0, lost_area = 0; // in the row of an end that stays, of the other end
    m_size = 2;
    for(int end = 0; end < 2; ++end) {
      if(end == m_staying)
        continue;
      const Spectral_ring& around = ring(end);
      std::size_t before = around.size() - 1;
      for(std::size_t i = 0; i < around.size(); before = i++) {
        double cot = 0, both_areas = 0;
        if(is_outer(end, i)) {
          const Spectral_triangle& t = m_outer[end][i];
          cot += t.cot_second;
          both_areas += t.area;
          area += m_fields->area_of_center(t);
        } else if(m_staying >= 0 && around[i].face) { // a triangle of the edge; the end that stays
                                                      // is its first or second corner
          const Spectral_triangle& t = around[i].triangle;
          const bool is_first = i == m_other_in[end];
          const double at_third = (is_first ? t.cot_second : t.cot_first) / 2;
          m_row[m_size++] = {around[is_first ? Spectral_rings::next(around, i) : i].vertex,
                             -t.cot_center / 2, -t.area * m_off_diagonal};
          lost += at_third;
          lost_area += t.area * m_off_diagonal;
          to_self += t.cot_center / 2 + at_third;
          area -= m_fields->area_of_center(is_first ? t.from_first() : t.from_second());
        }
        if(i == m_other_in[end])
          continue;
        if(is_outer(end, before)) {
          cot += m_outer[end][before].cot_first;
          both_areas += m_outer[end][before].area;
        }
        m_row[m_size++] = {around[i].vertex, cot / 2, both_areas * m_off_diagonal};
        to_self -= cot / 2;
      }
    }
    area *= m_fields->area_scale;
    set_ends(to_self, area * m_fields->diagonal_share());
    if(m_staying >= 0) {
      m_row[1 - m_staying].of_f -= lost;
      m_row[1 - m_staying].of_z -= lost_area;
    }
    const bool vanishes = m_fields->vanishes_at(m_end[0]) || m_fields->vanishes_at(m_end[1]);
    add_term<true>(m_staying >= 0 ? m_end[m_staying] : null_spectral_slot, area, vanishes);
  }

  // E_w after less before, of the i-th neighbour of an end. Those of both are met first around u.
  template <bool Full>
  CGAL_SPECTRAL_INLINE void add_link_vertex(const int end, const std::size_t i)
  {
    const Spectral_ring &around = ring(end), &around_other = ring(1 - end);
    const std::size_t o = m_other_in[end], at_other = m_other_in[1 - end];
    const bool is_after = i == Spectral_rings::next(around, o) && around[o].face,
               is_before = i == Spectral_rings::prev(around, o) && around[i].face;
    const bool is_both = is_after || is_before;
    if(is_both && end == 1 && m_staying < 0)
      return;
    Change change;
    m_size = 2;
    add_corner<Full>(end, i, true, change);
    if(is_both && m_staying < 0)
      add_corner<Full>(1 - end,
                       is_after ? Spectral_rings::prev(around_other, at_other)
                                : Spectral_rings::next(around_other, at_other),
                       false, change);
    set_ends(change.to_x, change.area_at_x * m_off_diagonal);
    double to_self = 0;
    for(int c = 0; c < 2; ++c) {
      m_row[c].of_f -= change.lost[c];
      m_row[c].of_z -= change.lost_area[c] * m_off_diagonal;
    }
    for(std::size_t e = 0; e < m_size; ++e)
      to_self -= m_row[e].of_f;
    const Slot w = around[i].vertex;
    change.area *= m_fields->area_scale;
    m_row[m_size++] = {w, to_self, change.area * m_fields->diagonal_share()};
    m_change -= m_fields->E[w];
    add_term<Full>(w, change.area, m_fields->vanishes_at(w));
  }

  // In the row of a vertex of the link, beside the entries for others: what its triangles with x
  // bring, and what those with u and v took away.
  struct Change
  {
    double to_x = 0, area_at_x = 0, area = 0;
    double lost[2] = {}, lost_area[2] = {};
  };

  // What the triangles at the i-th neighbour of an end bring and take away. Those of the edge are
  // in both rings.
  template <bool Full>
  CGAL_SPECTRAL_INLINE void add_corner(const int end, const std::size_t i, const bool with_edge,
                                       Change& change)
  {
    const Spectral_ring& around = ring(end);
    const std::size_t o = m_other_in[end], before = Spectral_rings::prev(around, i),
                      after = Spectral_rings::next(around, i);
    for(const bool is_first :
        {true, false}) { // of the triangle that follows it, second of the one before
      const std::size_t j = is_first ? i : before, neighbor = is_first ? after : before;
      const Spectral_triangle& old = around[j].triangle;
      if(!around[j].face || (neighbor == o && !with_edge))
        continue;
      change.lost[end] += (is_first ? old.cot_second : old.cot_first) / 2;
      change.lost_area[end] += old.area;
      change.area -= m_fields->area_of_center(is_first ? old.from_first() : old.from_second());
      if(neighbor == o) {
        change.lost[1 - end] += old.cot_center / 2;
        change.lost_area[1 - end] += old.area;
        continue;
      }
      const Spectral_triangle& t = m_outer[end][j];
      m_row[m_size++] = {around[neighbor].vertex, (t.cot_center - old.cot_center) / 2,
                         (t.area - old.area) * m_off_diagonal};
      change.to_x += (is_first ? t.cot_second : t.cot_first) / 2;
      change.area_at_x += t.area;
      change.area += m_fields->area_of_center(is_first ? t.from_first() : t.from_second());
    }
  }

  // The merged vertex has no rows yet: those of both ends, with their weights, take their place.
  void set_ends(const double of_f, const double of_z)
  {
    m_row[0] = {m_end[0], (1 - m_weight) * of_f, (1 - m_weight) * of_z};
    m_row[1] = {m_end[1], m_weight * of_f, m_weight * of_z};
  }

  // E of the row that has been gathered: all of it, or what is new in that of w. Where functions
  // vanish there is none.
  template <bool Full>
  CGAL_SPECTRAL_INLINE void add_term(const Slot w, const double area, const bool vanishes)
  {
    const bool is_new = w == null_spectral_slot;
    const Entry *const row = m_row.data(), *const end = row + m_size;
    const double square = spectral_residual_row(m_fields->signals, row, Full ? row : end - 1, end,
                                                is_new ? nullptr : m_fields->signals[w],
                                                static_cast<Spectral_block*>(nullptr));
    const double mass = (is_new ? 0. : m_fields->mass[w]) + area / 3;
    m_invalid = m_invalid || !(mass > 0);
    if(mass > 0 && !vanishes)
      m_change += square / mass;
  }

  const Spectral_fields* m_fields = nullptr;
  Slot m_end[2] = {null_spectral_slot, null_spectral_slot}; // u and v
  std::size_t m_other_in[2] = {0, 0}; // of an end that does not stay, the place of the other end
  int m_staying = -1; // the end that stays with its values, 0 or 1 for u or v, or none
  double m_weight = 0, m_off_diagonal = 0, m_change = 0;
  bool m_invalid = false;                    // a triangle or a vertex would lose its area
  std::vector<Spectral_triangle> m_outer[2]; // those that survive, (x; a, b)
  std::vector<Entry> m_row;                  // for u, for v, for others
  std::size_t m_size = 0;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_COLLAPSE_KERNEL_H
