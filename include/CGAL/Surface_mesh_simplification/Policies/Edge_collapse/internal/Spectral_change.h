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

#include <cstddef>
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
 */
class Spectral_change
{
public:
  /// E after - E before, where u and v become one vertex at `point` with f = (1 - weight) f_u + weight f_v. The edge must
  /// fulfil the link condition.
  double operator()(const Spectral_fields& fields, const Spectral_slot u, const Spectral_slot v,
                    const double weight, const Eigen::Vector3d& point)
  {
    m_fields = &fields;
    m_u = u;
    m_v = v;
    m_weight = weight;
    m_point = point;
    m_R.resize(fields.F.cols());
    begin_row();
    add_ring(u);
    add_ring(v);
    double change = end_row(u) - fields.E[u] - fields.E[v];
    for(const Spectral_slot end : {u, v})
      for(const Spectral_ring_entry& e : fields.rings[end]) {
        const Spectral_slot w = e.vertex;
        const bool seen = end == v && fields.rings.find(u, w) < fields.rings[u].size();
        if(is_merged(w) || seen)
          continue;
        begin_row();
        add_ring(w);
        change += end_row(w) - fields.E[w];
      }
    return change;
  }

private:
  bool is_merged(const Spectral_slot s) const { return s == m_u || s == m_v; }
  const Eigen::Vector3d& position(const Spectral_slot s) const
  {
    return is_merged(s) ? m_point : m_fields->points[s];
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
      if(!ring[i].face || int(is_merged(a)) + int(is_merged(b)) + int(is_merged(c)) > 1)
        continue;
      const Spectral_triangle t = spectral_triangle(position(c), position(a), position(b));
      const double area = t.area * m_fields->area_scale, of_z = area * m_fields->off_diagonal_share();
      add_entry(a, t.cot_second / 2, of_z);
      add_entry(b, t.cot_first / 2, of_z);
      m_to_self -= (t.cot_first + t.cot_second) / 2;
      m_area += area;
    }
  }

  // E_w of the row that has been gathered.
  double end_row(const Spectral_slot w)
  {
    add_entry(w, m_to_self, m_area * m_fields->diagonal_share());
    const double square = spectral_combine_rows(*m_fields, m_row, m_R.data());
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

  const Spectral_fields* m_fields = nullptr;
  Spectral_slot m_u = null_spectral_slot, m_v = null_spectral_slot;
  double m_weight = 0, m_to_self = 0, m_area = 0;
  Eigen::Vector3d m_point = Eigen::Vector3d::Zero();
  Eigen::VectorXd m_R;
  std::vector<Spectral_row_entry> m_row;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_CHANGE_H
