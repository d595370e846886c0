// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_COLLAPSE_CORE_IMPL_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_COLLAPSE_CORE_IMPL_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_collapse_core.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_collapse_kernel.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_placement_search.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_residual_row.h>

#include <algorithm>

namespace CGAL::Surface_mesh_simplification::internal {

// The scratch memory of one thread.
struct alignas(cache_line) Spectral_collapse_core::Workspace
{
  Spectral_collapse_kernel kernel;
  std::vector<Spectral_row_entry> row;
};

inline void merge_rows(Spectral_rows& rows, const Spectral_slot removed, const Spectral_slot kept,
                       const double weight)
{
  rows.row(kept) = (1 - weight) * rows.row(kept) + weight * rows.row(removed);
}

CGAL_SPECTRAL_GEOMETRY_INLINE void
Spectral_collapse_core::set_basis(const Spectral_basis& basis, const Spectral_geometry::Local_operator& op,
                                  const Spectral_options& options, const bool single_precision)
{
  m_options = options;
  m_options.signals.resize(0, 0); // large, and in F now
  m_options.coefficients.resize(0, 7);
  m_options.boundary = op.boundary;
  if(op.boundary == Spectral_geometry::Boundary_condition::dirichlet)
    m_options.preserve_border = true;
  m_number_of_signals = basis.F.cols();
  m_fields.F.assign(basis.F);
  if(basis.Z.size() != 0)
    m_fields.Z.assign(basis.Z);
  else
    m_fields.lambda.assign(basis.lambda.transpose());
  m_fields.theta = op.theta;
  m_fields.voronoi = op.voronoi;
  const Spectral_geometry::Operator_coefficients& c = op.coefficients;
  for(Eigen::Index v = 0; v < c.rows(); ++v)
    m_fields.coefficients.push_back(c.row(v).transpose());
  m_fields.conductivity = Spectral_geometry::internal::mean_conductivity(c);
  m_fields.area_scale = 1 / basis.area;
  m_fields.single_precision = single_precision;
  m_shape.set_weights(options, basis.sum_of_squares);
  m_pool = std::make_shared<Pool>(options.threads);
  m_log = Collapse_log(basis.F.rows());
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::set_input(std::vector<Eigen::Vector3d> points,
                                                                     Spectral_rings rings)
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
  merge_rows(m_fields.F, removed, kept, weight);
  if(m_fields.has_z_rows())
    merge_rows(m_fields.Z, removed, kept, weight);
  if(m_fields.vanishes_at(removed))
    m_fields.vanishing[kept] = 1;
  if(!m_fields.coefficients.empty())
    m_fields.coefficients[kept] =
        (1 - weight) * m_fields.coefficients[kept] + weight * m_fields.coefficients[removed];
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::set_geometry(std::vector<Eigen::Vector3d> points,
                                                                        Spectral_rings rings)
{
  set_input(std::move(points), std::move(rings)); // of a later run it keeps the positions and the rings alone
  const Eigen::Index n = Eigen::Index(m_fields.points.size());
  if(m_fields.R.empty())
    m_fields.R.assign(n, m_number_of_signals);
  m_fields.mass = Eigen::VectorXd::Zero(n);
  m_fields.E = Eigen::VectorXd::Zero(n);
  m_pool->for_each(std::size_t(n), 256, [this](const std::size_t w, Workspace& workspace) {
    m_fields.rings.find_back(Spectral_slot(w));
    m_fields.update_triangles(Spectral_slot(w));
    update_row(Spectral_slot(w), workspace.row);
  });
  if(m_options.keep_free_of_self_intersections)
    m_crossing.set_geometry(m_fields.points, m_fields.rings);
  m_total = Sum();
  m_total.add(m_fields.E.sum());
  m_candidates.reset(std::size_t(n));
}

CGAL_SPECTRAL_GEOMETRY_INLINE double Spectral_collapse_core::surface_area() const
{
  double sum = 0;
  for(std::size_t w = 0; w < m_fields.points.size(); ++w)
    m_fields.rings.for_triangles(Spectral_slot(w), [&](const Spectral_slot a, const Spectral_slot b) {
      sum += spectral_triangle(m_fields.points[w], m_fields.points[a], m_fields.points[b]).area;
    });
  return sum / 3; // each triangle from its three corners
}

CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_candidate
Spectral_collapse_core::evaluate(Spectral_slot u, Spectral_slot v, Spectral_collapse_kernel& kernel,
                                 const double bound, const bool for_queue) const
{
  if(v < u)
    std::swap(u, v);
  Spectral_candidate result;
  result.other = v;
  if(!kernel.prepare(m_fields, u, v))
    return result;
  const Spectral_placement_search search = this->search(u, v);
  Spectral_sample& sample = result;
  if(for_queue && !m_options.exact_costs)
    sample = search.at_large_end(kernel);
  result.deferred = result.collapsible();
  if(!result.deferred) {
    sample = search.best(kernel, bound);
    result.deferred = result.collapsible() && result.cost > bound;
  }
  return result;
}

CGAL_SPECTRAL_GEOMETRY_INLINE const Spectral_candidate&
Spectral_collapse_core::candidate(Spectral_slot u, Spectral_slot v, const bool any_version)
{
  if(v < u)
    std::swap(u, v);
  Spectral_collapse_kernel& kernel = m_pool->workspace().kernel;
  const Spectral_candidate* found = m_candidates.find(u, v);
  if(found == nullptr || (any_version ? found->deferred : found->version != m_candidates.version())) {
    ++m_number_of_evaluations;
    found = &m_candidates.insert(u, any_version ? evaluate(u, v, kernel)
                                                : evaluate(u, v, kernel, minimiser_bound(), true));
  }
  if(any_version && found->collapsible() && crosses(u, v, found->point)) {
    ++m_number_of_evaluations;
    Spectral_candidate apart;
    apart.other = v;
    apart.at_another_point = kernel.prepare(m_fields, u, v);
    if(apart.at_another_point)
      static_cast<Spectral_sample&>(apart) = search(u, v).best_on_edge(
          kernel, crossing_factor * (std::max)(found->cost, m_recent_cost),
          [&](const Eigen::Vector3d& point) { return point != found->point && !crosses(u, v, point); });
    found = &m_candidates.insert(u, apart);
    m_number_of_crossings += !found->collapsible();
  }
  return *found;
}

CGAL_SPECTRAL_GEOMETRY_INLINE bool
Spectral_collapse_core::crosses(const Spectral_slot u, const Spectral_slot v, const Eigen::Vector3d& point)
{
  return m_crossing.crosses(m_fields.points, m_fields.rings, u, v, point);
}

CGAL_SPECTRAL_GEOMETRY_INLINE double
Spectral_collapse_core::cost_at(const Spectral_slot u, const Spectral_slot v, const Eigen::Vector3d& point)
{
  Spectral_collapse_kernel& kernel = m_pool->workspace().kernel;
  if(!kernel.prepare(m_fields, u, v))
    return std::numeric_limits<double>::infinity();
  ++m_number_of_evaluations;
  const Spectral_placement_search search = this->search(u, v);
  Spectral_sample sample{point, search.projected_weight(point)};
  search.evaluate(kernel, &sample, 1);
  return sample.cost;
}

CGAL_SPECTRAL_GEOMETRY_INLINE double Spectral_collapse_core::change_at(const Spectral_slot u,
                                                                       const Spectral_slot v,
                                                                       const double weight,
                                                                       const Eigen::Vector3d& point)
{
  return m_pool->workspace().kernel.change(m_fields, u, v, weight, point);
}

CGAL_SPECTRAL_GEOMETRY_INLINE double
Spectral_collapse_core::projected_weight(const Spectral_slot u, const Spectral_slot v,
                                         const Eigen::Vector3d& point) const
{
  return search(u, v).projected_weight(point);
}

CGAL_SPECTRAL_GEOMETRY_INLINE bool
Spectral_collapse_core::evaluate_all(const std::function<bool(double)>& progress)
{
  const double bound = minimiser_bound();
  const std::size_t n = m_fields.points.size(), chunk = 1024;
  for(std::size_t first = 0; first < n; first += chunk) {
    const std::size_t size = (std::min)(chunk, n - first);
    m_pool->for_each(size, 16, [&](const std::size_t i, Workspace& workspace) {
      const Spectral_slot u = Spectral_slot(first + i);
      m_candidates.reserve(u, m_fields.rings.number_above(u));
      for(const Spectral_ring_entry& e : m_fields.rings[u])
        if(u < e.vertex)
          m_candidates.insert(u, evaluate(u, e.vertex, workspace.kernel, bound, true));
    });
    for(std::size_t u = first; u < first + size; ++u)
      m_number_of_evaluations += m_fields.rings.number_above(Spectral_slot(u));
    if(!progress(double(first + size) / double(n)))
      return false;
  }
  return true;
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::evaluate_around(const Spectral_slot kept)
{
  defer_around(kept);
  m_number_of_evaluations += m_batch.size();
  const double bound = minimiser_bound();
  m_pool->for_each(m_batch.size(), 2, [this, bound](const std::size_t i, Workspace& workspace) {
    const auto [u, v] = m_batch[i];
    m_candidates.insert(u, evaluate(u, v, workspace.kernel, bound, true));
  });
}

CGAL_SPECTRAL_GEOMETRY_INLINE void
Spectral_collapse_core::commit(const Spectral_slot removed, const Spectral_slot kept, const double weight,
                               const Eigen::Vector3d& point, Spectral_ring ring)
{
  const double before = total();
  const double shape_cost = m_shape.cost(m_fields.points, removed, kept, point);
  const double largest_loss = m_shape.largest_loss() * (m_fields.mass[removed] + m_fields.mass[kept]);
  const Spectral_candidate* const candidate = m_candidates.find(removed, kept);
  const bool at_another_point =
      candidate != nullptr && candidate->at_another_point && candidate->point == point;
  follow(removed, kept, weight, point);
  m_total.add(-m_fields.E[removed]);
  m_fields.E[removed] = m_fields.mass[removed] = 0;
  m_fields.points[kept] = point;
  m_fields.rings.merge(removed, kept, std::move(ring));
  m_fields.update_triangles(kept);
  m_candidates.merge(removed);
  for(std::size_t i = 0; i < m_fields.rings[kept].size(); ++i) {
    m_fields.rings.follow(removed, kept, i);
    m_candidates.forget(m_fields.rings[kept][i].vertex, removed);
  }
  m_crossing.commit(m_fields.points, m_fields.rings, removed, kept);
  refresh_around(kept);
  const double loss = (std::min)(total() - before, largest_loss);
  m_recent_cost = (std::max)(at_another_point ? 0. : loss + shape_cost, m_recent_cost * recent_cost_decay);
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::drop_candidates_around(const Spectral_slot kept)
{
  for(const Spectral_ring_entry& e : m_fields.rings[kept])
    for(const Spectral_ring_entry& f : m_fields.rings[e.vertex])
      m_candidates.forget(e.vertex, f.vertex);
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::release()
{
  Spectral_fields left;
  left.lambda = m_fields.lambda; // it tells whether signals have rows of their own
  left.kept = m_fields.kept;
  m_fields = std::move(left);
  m_shape = Spectral_shape_term();
  m_crossing = Spectral_crossing_guard();
  m_candidates = Spectral_candidates();
}

CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_placement_search
Spectral_collapse_core::search(const Spectral_slot u, const Spectral_slot v) const
{
  return Spectral_placement_search(m_fields, m_options, m_shape, u, v);
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::update_row(const Spectral_slot w,
                                                                      std::vector<Spectral_row_entry>& row)
{
  const Spectral_ring& ring = m_fields.rings[w];
  double area = 0, to_self = 0;
  row.clear();
  for(std::size_t i = 0; i < ring.size(); ++i) {
    const Spectral_triangle &after = ring[i].triangle, &before = ring[Spectral_rings::prev(ring, i)].triangle;
    const double cot = (after.cot_second + before.cot_first) / 2;
    row.push_back(Spectral_row_entry{
        ring[i].vertex, Spectral_lanes{cot},
        Spectral_lanes{(after.area + before.area) * m_fields.area_scale * m_fields.off_diagonal_share()}});
    to_self -= cot;
    area += m_fields.area_of_center(after) * m_fields.area_scale;
  }
  row.push_back(
      Spectral_row_entry{w, Spectral_lanes{to_self}, Spectral_lanes{area * m_fields.diagonal_share()}});
  double square = 0;
  Spectral_geometry::internal::on_vector_units([&] {
    const Spectral_row_entry *const first = row.data(), *const end = first + row.size();
    spectral_combine_rows<1>(m_fields, first, m_fields.theta == 0 ? end - 1 : first, end, nullptr,
                             m_fields.R[w], &square);
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
  m_pool->for_each(
      n, 1, [this, &slot](const std::size_t i, Workspace& workspace) { update_row(slot(i), workspace.row); });
  for(std::size_t i = 0; i < n; ++i)
    m_total.add(m_fields.E[slot(i)]);
}

CGAL_SPECTRAL_GEOMETRY_INLINE double Spectral_collapse_core::minimiser_bound() const
{
  return m_options.placement == Spectral_placement_strategy::on_edge && !m_options.exact_costs
             ? m_recent_cost
             : std::numeric_limits<double>::infinity();
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::defer_around(const Spectral_slot kept)
{
  m_batch.clear();
  m_marks.resize(m_fields.points.size(), 0);
  ++m_mark;
  for(const Spectral_ring_entry& neighbor : m_fields.rings[kept])
    m_marks[neighbor.vertex] = m_mark;
  // An edge between two neighbours is in both of their rings.
  for(const Spectral_ring_entry& neighbor : m_fields.rings[kept])
    for(const Spectral_ring_entry& e : m_fields.rings[neighbor.vertex]) {
      const bool inner = m_marks[e.vertex] == m_mark;
      if(inner && e.vertex < neighbor.vertex)
        continue;
      const auto [u, v] = std::minmax(neighbor.vertex, e.vertex);
      const bool at_once = m_options.exact_costs || e.vertex == kept;
      const double factor = inner ? inner_deferral_factor : outer_deferral_factor;
      if(!m_candidates.defer(u, v,
                             at_once ? std::numeric_limits<double>::infinity() : factor * m_recent_cost))
        m_batch.emplace_back(u, v);
    }
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_COLLAPSE_CORE_IMPL_H
