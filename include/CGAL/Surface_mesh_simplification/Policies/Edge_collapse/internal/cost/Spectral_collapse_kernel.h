// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_COLLAPSE_KERNEL_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_COLLAPSE_KERNEL_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_candidates.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_lanes.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_residual_row.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_rings.h>

#include <CGAL/assertions.h>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace CGAL::Surface_mesh_simplification::internal {

/*!
 * The local cost of collapsing one edge: cost = sum over H of E_w after - sum over H of E_w before,
 * where H is the merged vertex and its link (section 3.3 of the paper).
 *
 *        a0 ---- s ---- b2         The rings of u and v run counterclockwise; s and t see both ends, the a_i see u alone, the
 *       / \    / \    / \          b_i see v alone.
 *     a1 --- u --- v --- b1        goes:      (u v s) and (v u t), the triangles of the edge
 *       \ /    \ /    \ /          changes:   (u; a0 a1), (v; b1 b2), ... become (x; ., .), the outer triangles
 *        .  --- t ---- .           H = {x} + link, whose E_w a collapse changes
 *
 * The row of x is summed anew. For a vertex w of the link R_w after is R_w plus what its triangles around u and v give after and gave
 * before: a combination of a few rows of F and Z, however many neighbours w has. Where a vertex of many neighbours stays where it is with
 * its values, so is its own row, and of its neighbours only those change that the other end shares. Up to four samples are combined
 * side by side.
 *
 * The object holds the scratch memory of one thread; it allocates only while a larger ring than any
 * before comes along.
 */
class Spectral_collapse_kernel
{
public:
  static constexpr int max_samples = 4;

  /// Sets the edge and says whether it may be collapsed: CGAL's link condition, and its refusal of inner edges between border vertices.
  /// Both depend only on the rings of u and v, and whenever those change CGAL costs the edge again. Unless it may, nothing may be
  /// evaluated. In time linear in the smaller ring and those of its vertices, but for the border of the larger one.
  bool prepare(const Spectral_fields& fields, const Spectral_slot u, const Spectral_slot v)
  {
    m_fields = &fields;
    const Spectral_rings& rings = fields.rings;
    const bool small_u = rings[u].size() <= rings[v].size();
    const Spectral_slot c = small_u ? u : v, o = small_u ? v : u;
    const Spectral_ring& ring = rings[c];
    const std::size_t o_in_c = rings.find(c, o);
    CGAL_assertion(o_in_c < ring.size());
    m_end[0] = u;
    m_end[1] = v;
    m_other_in[small_u ? 0 : 1] = o_in_c;
    m_other_in[small_u ? 1 : 0] = ring[o_in_c].back;
    const std::size_t before = Spectral_rings::prev(ring, o_in_c), after = Spectral_rings::next(ring, o_in_c);
    for(std::size_t j = 0; j < ring.size(); ++j) {
      const bool shares_face = (j == after && ring[o_in_c].face) || (j == before && ring[before].face);
      if(j != o_in_c && !shares_face && rings.are_adjacent(o, ring[j].vertex))
        return false;
    }
    return !(ring[o_in_c].face && ring[before].face && rings.is_border(c) && rings.is_border(o));
  }

  /// Fills `cost` of up to four samples; infinity where a triangle without area would arise.
  void evaluate(Spectral_sample* samples, const int count)
  {
    CGAL_precondition(count >= 1 && count <= max_samples);
    Spectral_geometry::internal::on_vector_units([&] {
      if(m_fields->theta == 0)
        evaluate_body<false>(samples, count);
      else
        evaluate_body<true>(samples, count);
    });
    for(int s = 0; s < count; ++s)
      samples[s].cost = m_invalid[s] != 0 || !std::isfinite(m_change[s])
                            ? std::numeric_limits<double>::infinity()
                            : m_change[s];
  }

  /// The change of E that a collapse makes, whatever triangles arise. Needs no prepare().
  double change(const Spectral_fields& fields, const Spectral_slot u, const Spectral_slot v,
                const double weight, const Eigen::Vector3d& point)
  {
    prepare(fields, u, v);
    Spectral_sample sample{point, weight};
    evaluate(&sample, 1);
    return m_change[0];
  }

private:
  using Lanes = Spectral_lanes;
  using Entry = Spectral_row_entry;
  using Slot = Spectral_slot;

  // A `Spectral_triangle` for each sample.
  struct Triangles
  {
    Lanes cot_center, cot_first, cot_second, area;

    CGAL_SPECTRAL_INLINE void set(const int s, const Spectral_triangle& t)
    {
      cot_center[s] = t.cot_center;
      cot_first[s] = t.cot_first;
      cot_second[s] = t.cot_second;
      area[s] = t.area;
    }
  };

  const Spectral_ring& ring(const int end) const { return m_fields->rings[m_end[end]]; }

  // Whether what lies around an end is left as it is, but for what the other end shares.
  bool is_left(const int end) const { return end == m_left; }

  // Whether the i-th triangle around an end survives the collapse.
  bool is_outer(const int end, const std::size_t i) const
  {
    const std::size_t o = m_other_in[end];
    return ring(end)[i].face && i != o && Spectral_rings::next(ring(end), i) != o;
  }

  // `Full`: with a mass that has off-diagonal entries.
  template <bool Full>
  CGAL_SPECTRAL_INLINE void evaluate_body(const Spectral_sample* samples, const int count)
  {
    m_count = count;
    for(int end = 0; end < 2; ++end)
      m_number_moving[end] = 0;
    for(int s = 0; s < max_samples; ++s) {
      const Spectral_sample& sample = samples[s < count ? s : 0];
      m_weight[s] = sample.weight;
      for(int c = 0; c < 3; ++c)
        m_point[c][s] = sample.point[c];
      m_change[s] = -m_fields->E[m_end[0]] - m_fields->E[m_end[1]];
      m_invalid[s] = 0;
      for(int end = 0; end < 2; ++end)
        if(s < count && (sample.weight != double(end) || sample.point != m_fields->points[m_end[end]]))
          m_moving[end][m_number_moving[end]++] = s;
    }
    const int larger = ring(0).size() >= ring(1).size() ? 0 : 1;
    const bool hub_stays = m_fields->is_hub(m_end[larger]) && m_number_moving[larger] == 0;
    m_left = hub_stays ? larger : -1;
    for(int end = 0; end < 2; ++end)
      if(!is_left(end))
        set_outer_triangles(end, samples);
    add_merged_vertex<Full>();
    for(int end = 0; end < 2; ++end)
      for(std::size_t i = 0; !is_left(end) && i < ring(end).size(); ++i)
        if(i != m_other_in[end])
          add_link_vertex<Full>(end, i);
  }

  CGAL_SPECTRAL_INLINE void set_outer_triangles(const int end, const Spectral_sample* samples)
  {
    const Spectral_ring& around = ring(end);
    if(m_outer[end].size() < around.size())
      m_outer[end].resize(around.size());
    if(m_row.size() < ring(0).size() + ring(1).size() + 8)
      m_row.resize(ring(0).size() + ring(1).size() + 8);
    for(std::size_t i = 0; i < around.size(); ++i) {
#ifdef CGAL_SPECTRAL_VECTOR_EXTENSION
      // The row that add_link_vertex() will read: by then it has arrived.
      for(Eigen::Index k = 0; k < m_fields->R.cols(); k += spectral_padding)
        __builtin_prefetch(m_fields->R[around[i].vertex] + k);
#endif
      if(!is_outer(end, i))
        continue;
      const Slot a = around[i].vertex, b = around[Spectral_rings::next(around, i)].vertex;
      Lanes failed = {};
      if(m_fields->coefficients.empty())
        set_triangles(m_fields->points[a], m_fields->points[b], m_outer[end][i], failed);
      else
        for(int s = 0; s < m_count; ++s) {
          const Spectral_triangle t = triangle(samples[s], a, b);
          m_outer[end][i].set(s, t);
          failed[s] = is_degenerate(t);
        }
      if(!is_degenerate(around[i].triangle))
        m_invalid += failed;
    }
  }

  // Those with the corners x, a, b. 1 is added to `failed` where one would have no area, to doubles.
  CGAL_SPECTRAL_INLINE void set_triangles(const Eigen::Vector3d& pa, const Eigen::Vector3d& pb, Triangles& t,
                                          Lanes& failed) const
  {
    const Eigen::Vector3d ab = pb - pa;
    const Lanes a[3] = {pa[0] - m_point[0], pa[1] - m_point[1], pa[2] - m_point[2]};
    const Lanes b[3] = {pb[0] - m_point[0], pb[1] - m_point[1], pb[2] - m_point[2]};
    Lanes at_x, at_a, at_b, square, inverse;
    Spectral_geometry::internal::triangle_products(a, ab, b, at_x, at_a, at_b, square);
    const Lanes sum = at_x + at_a + at_b; // of the cotangents, times twice the area
    constexpr double limit = Spectral_triangle::degenerate_cotangent;
    const Lanes bound = sum * sum * (1 / (limit * limit));
    spectral_inverse_sqrt(inverse, square, bound, failed);
    t = Triangles{at_x * inverse, at_a * inverse, at_b * inverse, square * inverse * 0.5};
  }

  Spectral_triangle triangle(const Spectral_sample& x, const Slot a, const Slot b) const
  {
    const Spectral_fields& fields = *m_fields;
    const Spectral_geometry::internal::Point_coefficients of_x =
        (1 - x.weight) * fields.coefficients[m_end[0]] + x.weight * fields.coefficients[m_end[1]];
    const Spectral_geometry::internal::Point_coefficients mean =
        (of_x + fields.coefficients[a] + fields.coefficients[b]) / 3;
    return spectral_triangle(x.point, fields.points[a], fields.points[b], &mean);
  }

  bool is_degenerate(const Spectral_triangle& t) const
  {
    return !(t.area > 0) || !(t.cot_center + t.cot_first + t.cot_second <
                              Spectral_triangle::degenerate_cotangent * m_fields->conductivity);
  }

  // E_x. Where a hub stays its row is what it was and what the triangles around the other end change.
  template <bool Full>
  CGAL_SPECTRAL_INLINE void add_merged_vertex()
  {
    const double off_diagonal = m_fields->off_diagonal_share() * m_fields->area_scale;
    Lanes to_self = {}, area = {};
    double lost = 0, lost_area = 0; // in the row of the hub, of the other end
    m_size = 2;
    for(int end = 0; end < 2; ++end)
      for(std::size_t i = 0; !is_left(end) && i < ring(end).size(); ++i) {
        const Spectral_ring& around = ring(end);
        const std::size_t before = Spectral_rings::prev(around, i);
        Lanes cot = {}, both_areas = {};
        if(is_outer(end, i)) {
          const Triangles& t = m_outer[end][i];
          cot += t.cot_second;
          both_areas += t.area;
          add_area(t, t.cot_center, t.cot_first, t.cot_second, area);
        } else if(m_left >= 0 &&
                  around[i].face) { // a triangle of the edge, of which the hub is the first or second corner
          const Spectral_triangle& t = around[i].triangle;
          const bool is_first = i == m_other_in[end];
          Entry& e = m_row[m_size++];
          e.vertex = around[is_first ? Spectral_rings::next(around, i) : i].vertex;
          e.of_f = Lanes{} - t.cot_center / 2;
          e.of_z = Lanes{} - t.area * off_diagonal;
          lost += (is_first ? t.cot_second : t.cot_first) / 2;
          lost_area += t.area * off_diagonal;
          to_self += t.cot_center / 2 + (is_first ? t.cot_second : t.cot_first) / 2;
          area -= m_fields->area_of_center(is_first ? t.from_first() : t.from_second());
        }
        if(i == m_other_in[end])
          continue;
        if(is_outer(end, before)) {
          cot += m_outer[end][before].cot_first;
          both_areas += m_outer[end][before].area;
        }
        Entry& e = m_row[m_size++];
        e.vertex = around[i].vertex;
        e.of_f = cot * 0.5;
        e.of_z = both_areas * off_diagonal;
        to_self -= e.of_f;
      }
    area *= m_fields->area_scale;
    set_ends(to_self, area * m_fields->diagonal_share());
    if(m_left >= 0) {
      m_row[1 - m_left].of_f -= lost;
      m_row[1 - m_left].of_z -= lost_area;
    }
    const bool vanishes = m_fields->vanishes_at(m_end[0]) || m_fields->vanishes_at(m_end[1]);
    add_term<true>(m_left >= 0 ? m_end[m_left] : null_spectral_slot, area, vanishes, all_samples, m_count);
  }

  // E_w after less before, of the i-th neighbour of an end. Those of both are met first around u.
  template <bool Full>
  CGAL_SPECTRAL_INLINE void add_link_vertex(const int end, const std::size_t i)
  {
    const Spectral_ring &around = ring(end), &around_other = ring(1 - end);
    const std::size_t o = m_other_in[end], at_other = m_other_in[1 - end];
    const bool is_after = i == Spectral_rings::next(around, o) && around[o].face,
               is_before = i == Spectral_rings::prev(around, o) && around[i].face,
               is_both = is_after || is_before;
    if(is_both && end == 1 && m_left < 0)
      return;
    Change change;
    m_size = 2;
    add_corner<Full>(end, i, true, change);
    if(is_both && !is_left(1 - end))
      add_corner<Full>(1 - end,
                       is_after ? Spectral_rings::prev(around_other, at_other)
                                : Spectral_rings::next(around_other, at_other),
                       false, change);
    const double off_diagonal = m_fields->off_diagonal_share() * m_fields->area_scale;
    set_ends(change.to_x, change.area_at_x * off_diagonal);
    Lanes to_self = {};
    for(int c = 0; c < 2; ++c) {
      m_row[c].of_f -= change.lost[c];
      if(Full)
        m_row[c].of_z -= change.lost_area[c] * off_diagonal;
    }
    for(std::size_t e = 0; e < m_size; ++e)
      to_self -= m_row[e].of_f;
    const Slot w = around[i].vertex;
    change.area *= m_fields->area_scale;
    m_row[m_size++] = Entry{w, to_self, change.area * m_fields->diagonal_share()};
    // Where its end stays as it is so does the row of one that is next to no other.
    const int* const samples = is_both ? all_samples : m_moving[end];
    const int count = is_both ? m_count : m_number_moving[end];
    for(int j = 0; j < count; ++j)
      m_change[samples[j]] -= m_fields->E[w];
    add_term<Full>(w, change.area, m_fields->vanishes_at(w), samples, count);
  }

  // Of the row of a vertex of the link, beside the entries for others: what its triangles with x bring, and what those with u and v
  // took away.
  struct Change
  {
    Lanes to_x, area_at_x, area;
    double lost[2], lost_area[2];

    // Assigned, because compilers clear what is initialised with zeros by a string instruction, which takes longer.
    Change()
    {
      to_x = area_at_x = area = Lanes{};
      lost[0] = lost[1] = lost_area[0] = lost_area[1] = 0;
    }
  };

  // What the triangles at the i-th neighbour of an end bring and take away. Those of the edge are in both rings.
  template <bool Full>
  CGAL_SPECTRAL_INLINE void add_corner(const int end, const std::size_t i, const bool with_edge,
                                       Change& change)
  {
    const Spectral_ring& around = ring(end);
    const std::size_t o = m_other_in[end], before = Spectral_rings::prev(around, i),
                      after = Spectral_rings::next(around, i);
    for(const bool is_first : {true, false}) { // of the triangle that follows it, second of the one before
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
      const Triangles& t = m_outer[end][j];
      Entry& e = m_row[m_size++];
      e.vertex = around[neighbor].vertex;
      e.of_f = (t.cot_center - old.cot_center) * 0.5;
      if(Full)
        e.of_z = (t.area - old.area) * (m_fields->off_diagonal_share() * m_fields->area_scale);
      change.to_x += (is_first ? t.cot_second : t.cot_first) * 0.5;
      change.area_at_x += t.area;
      add_area(t, is_first ? t.cot_first : t.cot_second, t.cot_center, is_first ? t.cot_second : t.cot_first,
               change.area);
    }
  }

  // What a triangle gives to the mass of a corner with a cotangent c, a and b being those of the others.
  CGAL_SPECTRAL_INLINE void add_area(const Triangles& t, const Lanes& c, const Lanes& a, const Lanes& b,
                                     Lanes& area) const
  {
    if(!m_fields->voronoi)
      area += t.area;
    else
      for(int s = 0; s < m_count; ++s)
        area[s] += m_fields->area_of_center({c[s], a[s], b[s], t.area[s]});
  }

  // The merged vertex has no rows yet: those of both ends, with their weights, take their place.
  CGAL_SPECTRAL_INLINE void set_ends(const Lanes& of_f, const Lanes& of_z)
  {
    const Lanes rest = 1. - m_weight;
    m_row[0] = Entry{m_end[0], rest * of_f, rest * of_z};
    m_row[1] = Entry{m_end[1], m_weight * of_f, m_weight * of_z};
  }

  // E of the row that has been gathered: all of it, or what is new in that of w. Where functions vanish there is none.
  template <bool Full>
  CGAL_SPECTRAL_INLINE void add_term(const Slot w, const Lanes& area, const bool vanishes, const int* samples,
                                     const int count)
  {
    const bool is_new = w == null_spectral_slot;
    const double* const start = is_new ? nullptr : m_fields->R[w];
    Entry *const row = m_row.data(), *const end = row + m_size, *const first_of_z = Full ? row : end - 1;
    if(count != m_count)
      for(Entry* e = row; e != end; ++e)
        for(int j = 0; j < count; ++j) {
          e->of_f[j] = e->of_f[samples[j]];
          if(e >= first_of_z)
            e->of_z[j] = e->of_z[samples[j]];
        }
    double square[max_samples];
    if(count == 1)
      spectral_combine_rows<1>(*m_fields, row, first_of_z, end, start, nullptr, square);
    else if(count == 2)
      spectral_combine_rows<2>(*m_fields, row, first_of_z, end, start, nullptr, square);
    else if(count == 3)
      spectral_combine_rows<3>(*m_fields, row, first_of_z, end, start, nullptr, square);
    else if(count == 4)
      spectral_combine_rows<4>(*m_fields, row, first_of_z, end, start, nullptr, square);
    for(int j = 0; j < count; ++j) {
      const int s = samples[j];
      const double mass = (is_new ? 0. : m_fields->mass[w]) + area[s] / 3;
      m_invalid[s] += !(mass > 0);
      if(mass > 0 && !vanishes)
        m_change[s] += square[j] / mass;
    }
  }

  static constexpr int all_samples[max_samples] = {0, 1, 2, 3};

  const Spectral_fields* m_fields = nullptr;
  Slot m_end[2] = {null_spectral_slot, null_spectral_slot}; // u and v
  std::size_t m_other_in[2] = {0, 0}; // the place of v in the ring of u, of u in that of v
  int m_left = -1;                    // the hub that stays, 0 or 1 for u or v, or none
  int m_count = 0;                    // of samples; what follows is for each of them
  int m_moving[2][max_samples] = {}, m_number_moving[2] = {}; // those that do not leave an end as it is
  Lanes m_weight = {}, m_point[3] = {};
  double m_change[max_samples] = {};
  Lanes m_invalid = {};              // not 0: a triangle or a vertex would lose its area
  std::vector<Triangles> m_outer[2]; // those that survive, (x; a, b)
  std::vector<Entry> m_row;          // for u, for v, for others
  std::size_t m_size = 0;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_COLLAPSE_KERNEL_H
