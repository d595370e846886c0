// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_CHANGE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_CHANGE_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_residual_row.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_rings.h>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/*!
 * The change of E that a collapse makes, from whole rows of the mesh as it would be.
 *
 * `Spectral_collapse_kernel` is many times faster, but its quadratic form squares the cotangents of the triangles that
 * go: at 1e8, in a cap that is nearly flat, nothing but rounding is left of the cost. Here they are left out before
 * anything is summed, as they are after the collapse.
 *
 * Its inner products are quadratic in the degree, too. Here time is linear in it: K times the sum of the degrees in the link. Less
 * where a vertex of many neighbours is in the link or stays where it is with its values: its row changes by a few triangles, and
 * of its neighbours only those that the other end shares.
 */
class Spectral_change
{
public:
  /// E after - E before, where u and v become one vertex at `point` with f = (1 - weight) f_u + weight f_v. The edge must
  /// fulfil the link condition.
  double operator()(const Spectral_fields& fields, const Spectral_slot u, const Spectral_slot v,
                    const double weight, const Eigen::Vector3d& point)
  {
    set_collapse(fields, u, v, weight, point);
    double change = at_merged(merged_energy()) - fields.E[u] - fields.E[v];
    for(const Spectral_slot end : {u, v})
      for(const Spectral_ring_entry& e : fields.rings[end])
        if(!is_merged(e.vertex) && !(end == v && fields.rings.are_adjacent(u, e.vertex)))
          change += energy_after(e.vertex) - fields.E[e.vertex];
    return change;
  }

  /// The same; infinity where a triangle without area would arise.
  double cost(const Spectral_fields& fields, const Spectral_slot u, const Spectral_slot v,
              const double weight, const Eigen::Vector3d& point)
  {
    set_collapse(fields, u, v, weight, point);
    // The end with more neighbours, o the other one.
    const bool more_at_u = fields.rings[u].size() >= fields.rings[v].size();
    const Spectral_slot c = more_at_u ? u : v, o = more_at_u ? v : u;
    const bool stays = point == fields.points[c] && weight == (more_at_u ? 0. : 1.);
    double change = at_merged(stays ? energy_after_few(c, o) : merged_energy()) - fields.E[u] - fields.E[v];
    for(const Spectral_ring_entry& e : fields.rings[o])
      if(e.vertex != c && (stays || !fields.rings.are_adjacent(c, e.vertex)))
        change += energy_after(e.vertex) - fields.E[e.vertex];
    if(!stays)
      for(const Spectral_ring_entry& e : fields.rings[c])
        if(e.vertex != o)
          change += energy_after(e.vertex) - fields.E[e.vertex];
    return m_invalid ? std::numeric_limits<double>::infinity() : change;
  }

private:
  using Coefficients = Spectral_geometry::internal::Point_coefficients;

  void set_collapse(const Spectral_fields& fields, const Spectral_slot u, const Spectral_slot v,
                    const double weight, const Eigen::Vector3d& point)
  {
    m_fields = &fields;
    m_u = u;
    m_v = v;
    m_weight = weight;
    m_point = point;
    if(!fields.coefficients.empty())
      m_coefficients = (1 - weight) * fields.coefficients[u] + weight * fields.coefficients[v];
    m_R.resize(fields.F.cols());
    m_invalid = false;
  }

  bool is_merged(const Spectral_slot s) const { return s == m_u || s == m_v; }
  const Eigen::Vector3d& position(const Spectral_slot s) const
  {
    return is_merged(s) ? m_point : m_fields->points[s];
  }
  const Coefficients& coefficients(const Spectral_slot s) const
  {
    return is_merged(s) ? m_coefficients : m_fields->coefficients[s];
  }

  Spectral_triangle triangle(const Spectral_slot c, const Spectral_slot a, const Spectral_slot b) const
  {
    if(m_fields->coefficients.empty())
      return spectral_triangle(position(c), position(a), position(b));
    const Coefficients mean = (coefficients(c) + coefficients(a) + coefficients(b)) / 3;
    return spectral_triangle(position(c), position(a), position(b), &mean);
  }

  // Where functions vanish there is no term.
  double at_merged(const double E) const
  {
    return m_fields->vanishes_at(m_u) || m_fields->vanishes_at(m_v) ? 0. : E;
  }

  // E_x of the merged vertex.
  double merged_energy()
  {
    begin_row();
    add_ring(m_u);
    add_ring(m_v);
    return end_row(m_u);
  }

  // E_w of a vertex of the link.
  double energy_after(const Spectral_slot w)
  {
    double E = 0;
    if(!m_fields->has_products(w))
      E = energy_after_few(w, w);
    else {
      begin_row();
      add_ring(w);
      E = end_row(w);
    }
    return m_fields->vanishes_at(w) ? 0. : E; // with its triangles looked at
  }

  void begin_row()
  {
    m_row.clear();
    m_to_self = m_area = 0;
  }

  // The triangles around c, but for those with both ends of the edge.
  void add_ring(const Spectral_slot c)
  {
    const Spectral_ring& ring = m_fields->rings[c];
    for(std::size_t i = 0; i < ring.size(); ++i) {
      const Spectral_slot a = ring[i].vertex, b = ring[Spectral_rings::next(ring, i)].vertex;
      if(ring[i].face && int(is_merged(a)) + int(is_merged(b)) + int(is_merged(c)) <= 1)
        add_triangle(c, a, b, ring[i].triangle);
    }
  }

  // (c; a, b) as it will be; `old` is what it was.
  void add_triangle(const Spectral_slot c, const Spectral_slot a, const Spectral_slot b,
                    const Spectral_triangle& old)
  {
    const Spectral_triangle t = triangle(c, a, b);
    if(is_merged(a) || is_merged(b) || is_merged(c))
      m_invalid = m_invalid || (is_degenerate(t) && !is_degenerate(old));
    const double area = t.area * m_fields->area_scale, of_z = area * m_fields->off_diagonal_share();
    add_entry(a, t.cot_second / 2, of_z);
    add_entry(b, t.cot_first / 2, of_z);
    m_to_self -= (t.cot_first + t.cot_second) / 2;
    m_area += m_fields->area_of_center(t) * m_fields->area_scale;
  }

  bool is_degenerate(const Spectral_triangle& t) const
  {
    return !(t.area > 0) || !(t.cot_center + t.cot_first + t.cot_second <
                              Spectral_triangle::degenerate_cotangent * m_fields->conductivity);
  }

  // E_w of the row that has been gathered.
  double end_row(const Spectral_slot w)
  {
    add_entry(w, m_to_self, m_area * m_fields->diagonal_share());
    const double square = spectral_combine_rows(*m_fields, m_row, m_R.data());
    m_invalid = m_invalid || !(m_area > 0);
    return m_area > 0 ? square / (m_area / 3) : 0;
  }

  // The merged vertex has no rows yet: those of both ends, with their weights, take their place.
  void add_entry(const Spectral_slot s, const double of_f, const double of_z)
  {
    if(!is_merged(s)) {
      m_row.push_back(Spectral_row_entry{s, of_f, of_z});
      return;
    }
    m_row.push_back(Spectral_row_entry{m_u, (1 - m_weight) * of_f, (1 - m_weight) * of_z});
    m_row.push_back(Spectral_row_entry{m_v, m_weight * of_f, m_weight * of_z});
  }

  // E after of w, a vertex of the link if w = o, or the end that stays, o being the other one: R_w + what a few triangles
  // change.
  double energy_after_few(const Spectral_slot w, const Spectral_slot o)
  {
    begin_row();
    m_changed.clear();
    for(const Spectral_slot end : {m_u, m_v})
      if(end != w)
        collect_triangles_with(end, w);
    const Spectral_ring& ring = m_fields->rings[w];
    double old_to_self = 0;
    for(const std::size_t i : m_changed) {
      const Spectral_slot a = ring[i].vertex, b = ring[Spectral_rings::next(ring, i)].vertex;
      const Spectral_triangle& t = ring[i].triangle;
      const double area = t.area * m_fields->area_scale, of_z = area * m_fields->off_diagonal_share();
      m_row.push_back(Spectral_row_entry{a, -t.cot_second / 2, -of_z});
      m_row.push_back(Spectral_row_entry{b, -t.cot_first / 2, -of_z});
      old_to_self += (t.cot_first + t.cot_second) / 2;
      m_area -= m_fields->area_of_center(t) * m_fields->area_scale;
      if(w == o && !(is_merged(a) && is_merged(b)))
        add_triangle(w, a, b, t);
    }
    if(w != o) { // the triangles of o go to w
      const Spectral_ring& around = m_fields->rings[o];
      for(std::size_t i = 0; i < around.size(); ++i) {
        const Spectral_slot a = around[i].vertex, b = around[Spectral_rings::next(around, i)].vertex;
        if(around[i].face && a != w && b != w)
          add_triangle(o, a, b, around[i].triangle);
      }
    }
    m_row.push_back(Spectral_row_entry{w, m_to_self + old_to_self, m_area * m_fields->diagonal_share()});
    spectral_combine_rows(*m_fields, m_row, m_R.data());
    m_R += m_fields->R.row(w).transpose();
    const double mass = m_fields->mass[w] + m_area / 3;
    m_invalid = m_invalid || !(mass > 0);
    return mass > 0 ? m_R.squaredNorm() / mass : 0;
  }

  // The indices in the ring of w of the triangles that have a neighbour `end`.
  void collect_triangles_with(const Spectral_slot end, const Spectral_slot w)
  {
    const Spectral_rings& rings = m_fields->rings;
    const std::size_t j = rings.index_of(end, w);
    const Spectral_ring& ring = rings[w];
    if(j == ring.size())
      return;
    for(const std::size_t i : {j, Spectral_rings::prev(ring, j)})
      if(ring[i].face && std::find(m_changed.begin(), m_changed.end(), i) == m_changed.end())
        m_changed.push_back(i);
  }

  const Spectral_fields* m_fields = nullptr;
  Spectral_slot m_u = null_spectral_slot, m_v = null_spectral_slot;
  double m_weight = 0, m_to_self = 0, m_area = 0;
  bool m_invalid = false; // a triangle or a vertex would lose its area
  Eigen::Vector3d m_point = Eigen::Vector3d::Zero();
  Coefficients m_coefficients = Coefficients::Zero(); // of the merged vertex
  Eigen::VectorXd m_R;
  std::vector<Spectral_row_entry> m_row;
  std::vector<std::size_t> m_changed;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_CHANGE_H
