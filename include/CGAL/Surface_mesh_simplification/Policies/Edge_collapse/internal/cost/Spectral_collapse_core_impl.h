// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_COLLAPSE_CORE_IMPL_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_COLLAPSE_CORE_IMPL_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_collapse_core.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_residual_row.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace CGAL::Surface_mesh_simplification::internal {

CGAL_SPECTRAL_GEOMETRY_INLINE void
Spectral_collapse_core::set_basis(Spectral_basis basis, const Spectral_geometry::Local_operator& op,
                                  const Spectral_options& options, const bool single_precision)
{
  m_options = options;
  m_options.signals.resize(0, 0); // large, and in F now
  m_options.coefficients.resize(0, 7);
  m_options.boundary = op.boundary;
  if(op.boundary == Spectral_geometry::Boundary_condition::dirichlet)
    m_options.preserve_border = true;
  m_log = Collapse_log(basis.number_of_vertices);
  m_fields.signals = std::move(basis.signals);
  m_fields.theta = op.theta;
  m_fields.voronoi = op.voronoi;
  const Spectral_geometry::Operator_coefficients& c = op.coefficients;
  for(Eigen::Index v = 0; v < c.rows(); ++v)
    m_fields.coefficients.push_back(c.row(v).transpose());
  m_fields.conductivity = Spectral_geometry::internal::mean_conductivity(c);
  m_fields.area_scale = 1 / basis.area;
  m_fields.single_precision = single_precision;
  m_shape.set_weights(options, basis.sum_of_squares);
}

CGAL_SPECTRAL_GEOMETRY_INLINE void
Spectral_collapse_core::set_input(std::vector<Eigen::Vector3d> points, Spectral_rings rings)
{
  const bool is_later = !m_fields.points.empty();
  m_fields.points = std::move(points);
  m_fields.rings = std::move(rings);
  if(is_later)
    return; // quadrics and the border are those of the input
  if(m_options.boundary == Spectral_geometry::Boundary_condition::dirichlet)
    for(std::size_t w = 0; w < m_fields.points.size(); ++w)
      m_fields.vanishing.push_back(m_fields.rings.is_border(Spectral_slot(w)));
  if(m_options.shape > 0)
    m_shape.set_geometry(m_fields.points, m_fields.rings,
                         m_fields.coefficients.empty() ? m_fields.area_scale : 1 / surface_area());
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::follow(const Spectral_slot removed,
                                                                  const Spectral_slot kept,
                                                                  const double weight,
                                                                  const Eigen::Vector3d& point)
{
  m_shape.merge(removed, kept);
  m_log.merge(removed, kept, weight, point);
  if(m_fields.is_kept(removed))
    m_fields.kept[kept] = true; // which of the two goes on in the mesh is not ours to choose
  m_fields.signals.merge(removed, kept, weight);
  if(m_fields.vanishes_at(removed))
    m_fields.vanishing[kept] = 1;
  if(!m_fields.coefficients.empty())
    m_fields.coefficients[kept] =
        (1 - weight) * m_fields.coefficients[kept] + weight * m_fields.coefficients[removed];
}

CGAL_SPECTRAL_GEOMETRY_INLINE void
Spectral_collapse_core::set_geometry(std::vector<Eigen::Vector3d> points, Spectral_rings rings)
{
  set_input(std::move(points),
            std::move(rings)); // of a later run it keeps the positions and the rings alone
  const Eigen::Index n = Eigen::Index(m_fields.points.size());
  m_fields.mass = Eigen::VectorXd::Zero(n);
  m_fields.E = Eigen::VectorXd::Zero(n);
  for(Eigen::Index w = 0; w < n; ++w) {
    m_fields.rings.find_back(Spectral_slot(w));
    m_fields.update_triangles(Spectral_slot(w));
    update_row(Spectral_slot(w));
  }
  if(m_options.keep_free_of_self_intersections)
    m_crossing.set_geometry(m_fields.points, m_fields.rings);
  m_last_kept = null_spectral_slot;
  m_last_neighbor.assign(std::size_t(n), 0);
  m_total = Sum();
  m_total.add(m_fields.E.sum());
}

CGAL_SPECTRAL_GEOMETRY_INLINE double Spectral_collapse_core::surface_area() const
{
  double sum = 0;
  for(std::size_t w = 0; w < m_fields.points.size(); ++w)
    m_fields.rings.for_triangles(
        Spectral_slot(w), [&](const Spectral_slot a, const Spectral_slot b) {
          sum += spectral_triangle(m_fields.points[w], m_fields.points[a], m_fields.points[b]).area;
        });
  return sum / 3; // each triangle from its three corners
}

CGAL_SPECTRAL_GEOMETRY_INLINE std::optional<double>
Spectral_collapse_core::postponed_cost(const Spectral_slot u, const Spectral_slot v) const
{
  if(u == m_last_kept || v == m_last_kept || m_last_kept == null_spectral_slot)
    return {};
  const double cost = m_fields.rings[u][m_fields.rings.find(u, v)].cost;
  const bool inner =
      m_last_neighbor[u] == m_log.points().size() && m_last_neighbor[v] == m_last_neighbor[u];
  const double factor = inner ? inner_postponing_factor : outer_postponing_factor;
  return std::isfinite(cost) && cost > factor * m_recent_cost ? std::optional<double>(cost)
                                                              : std::nullopt;
}

CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_sample
Spectral_collapse_core::evaluate(const Spectral_slot u, const Spectral_slot v)
{
  ++m_number_of_evaluations;
  Spectral_sample result; // of infinite cost
  if(m_kernel.prepare(m_fields, u, v)) {
    result = search(u, v).at_large_end(m_kernel);
    if(!result.collapsible())
      result = search(u, v).best(m_kernel);
  }
  set_queued_cost(u, v, result.cost);
  return result;
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::set_queued_cost(const Spectral_slot u,
                                                                           const Spectral_slot v,
                                                                           const double cost)
{
  m_fields.rings[u][m_fields.rings.find(u, v)].cost = cost;
}

CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_sample Spectral_collapse_core::select(const Spectral_slot u,
                                                                             const Spectral_slot v)
{
  ++m_number_of_evaluations;
  if(!m_kernel.prepare(m_fields, u, v))
    return Spectral_sample();
  const Spectral_sample best = search(u, v).best(m_kernel);
  if(!best.collapsible())
    return best;
  if(!crosses(u, v, best.point)) {
    m_recent_cost = (std::max)(best.cost, m_recent_cost * recent_cost_decay);
    return best;
  }
  const Spectral_sample apart = search(u, v).best_on_edge(
      m_kernel, crossing_factor * (std::max)(best.cost, m_recent_cost),
      [&](const Eigen::Vector3d& point) { return point != best.point && !crosses(u, v, point); });
  m_number_of_crossings += !apart.collapsible();
  return apart;
}

CGAL_SPECTRAL_GEOMETRY_INLINE bool Spectral_collapse_core::crosses(const Spectral_slot u,
                                                                   const Spectral_slot v,
                                                                   const Eigen::Vector3d& point)
{
  return m_crossing.crosses(m_fields.points, m_fields.rings, u, v, point);
}

CGAL_SPECTRAL_GEOMETRY_INLINE double Spectral_collapse_core::cost_at(const Spectral_slot u,
                                                                     const Spectral_slot v,
                                                                     const Eigen::Vector3d& point)
{
  if(!m_kernel.prepare(m_fields, u, v))
    return std::numeric_limits<double>::infinity();
  ++m_number_of_evaluations;
  const Spectral_placement_search search = this->search(u, v);
  Spectral_sample sample{point, search.projected_weight(point)};
  search.evaluate(m_kernel, sample);
  return sample.cost;
}

CGAL_SPECTRAL_GEOMETRY_INLINE double Spectral_collapse_core::change_at(const Spectral_slot u,
                                                                       const Spectral_slot v,
                                                                       const double weight,
                                                                       const Eigen::Vector3d& point)
{
  return m_kernel.change(m_fields, u, v, weight, point);
}

CGAL_SPECTRAL_GEOMETRY_INLINE double
Spectral_collapse_core::projected_weight(const Spectral_slot u, const Spectral_slot v,
                                         const Eigen::Vector3d& point) const
{
  return search(u, v).projected_weight(point);
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::commit(const Spectral_slot removed,
                                                                  const Spectral_slot kept,
                                                                  const double weight,
                                                                  const Eigen::Vector3d& point,
                                                                  Spectral_ring ring)
{
  follow(removed, kept, weight, point);
  m_total.add(-m_fields.E[removed]);
  m_fields.E[removed] = m_fields.mass[removed] = 0;
  m_fields.points[kept] = point;
  m_fields.rings.merge(removed, kept, std::move(ring));
  m_fields.update_triangles(kept);
  for(std::size_t i = 0; i < m_fields.rings[kept].size(); ++i)
    m_fields.rings.follow(removed, kept, i);
  m_last_kept = kept;
  for(const Spectral_ring_entry& e : m_fields.rings[kept])
    m_last_neighbor[e.vertex] = std::uint32_t(m_log.points().size());
  m_crossing.commit(m_fields.points, m_fields.rings, removed, kept);
  refresh_around(kept);
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::release()
{
  Spectral_fields left;
  left.kept = m_fields.kept;
  m_fields = std::move(left);
  m_shape = Spectral_shape_term();
  m_crossing = Spectral_crossing_guard();
}

CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_placement_search
Spectral_collapse_core::search(const Spectral_slot u, const Spectral_slot v) const
{
  return Spectral_placement_search(m_fields, m_options, m_shape, u, v);
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::update_row(const Spectral_slot w)
{
  const Spectral_ring& ring = m_fields.rings[w];
  double area = 0, to_self = 0;
  m_row.clear();
  for(std::size_t i = 0; i < ring.size(); ++i) {
    const Spectral_triangle &after = ring[i].triangle,
                            &before = ring[Spectral_rings::prev(ring, i)].triangle;
    const double cot = (after.cot_second + before.cot_first) / 2;
    m_row.push_back(
        {ring[i].vertex, cot,
         (after.area + before.area) * m_fields.area_scale * m_fields.off_diagonal_share()});
    to_self -= cot;
    area += m_fields.area_of_center(after) * m_fields.area_scale;
  }
  m_row.push_back({w, to_self, area * m_fields.diagonal_share()});
  double square = 0;
  Spectral_geometry::internal::on_vector_units([&] {
    const Spectral_row_entry *const first = m_row.data(), *const end = first + m_row.size();
    square = spectral_residual_row(m_fields.signals, first, m_fields.theta == 0 ? end - 1 : first,
                                   end, nullptr, m_fields.signals[w]);
  });
  m_fields.mass[w] = area / 3;
  m_fields.E[w] = area > 0 && !m_fields.vanishes_at(w) ? square / m_fields.mass[w] : 0;
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::refresh_around(const Spectral_slot kept)
{
  const Spectral_ring& ring = m_fields.rings[kept];
  const std::size_t n = ring.size() + 1;
  const auto slot = [&](const std::size_t i) { return i == 0 ? kept : ring[i - 1].vertex; };
  for(std::size_t i = 0; i < n; ++i)
    m_total.add(-m_fields.E[slot(i)]);
  for(std::size_t i = 0; i < n; ++i)
    update_row(slot(i));
  for(std::size_t i = 0; i < n; ++i)
    m_total.add(m_fields.E[slot(i)]);
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_COLLAPSE_CORE_IMPL_H
