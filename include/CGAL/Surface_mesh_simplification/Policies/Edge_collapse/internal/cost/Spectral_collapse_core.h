// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_COLLAPSE_CORE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_COLLAPSE_CORE_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_collapse_kernel.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_crossing_guard.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_placement_search.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_shape_term.h>

#include <CGAL/Spectral_geometry/internal/separate_compilation.h>
#include <CGAL/Spectral_geometry/local_operator.h>

namespace CGAL::Surface_mesh_simplification::internal {

/*!
 * The spectral state without the mesh: signals, R = B Z - L F, mass, E, positions, connectivity and
 * the log of merges, all in slots. It is told what the mesh does and never looks at it.
 *
 * Order of calls: set_basis() once; if collapses chosen by others come first, set_input(), then
 * follow() for each of them; set_geometry() at the start of each run; then, in any order,
 * evaluate(), select() or cost_at(), which remember costs and change nothing else, and commit(),
 * which follows one collapse.
 */
class Spectral_collapse_core
{
public:
  using Slot = Spectral_slot;
  using Merge = Spectral_geometry::Merge_forest::Merge;

  /// `op` has n coefficients or none. `single_precision`: whether the mesh stores its points as
  /// `float`. `kept`: see `Spectral_fields`. Signals and coefficients of the options are not read.
  void set_basis(Spectral_basis basis, const Spectral_geometry::Local_operator& op,
                 const Spectral_options& options, const bool single_precision,
                 std::vector<char> kept = {})
  {
    m_options = options;
    m_options.signals.resize(0, 0); // large, and in F now
    m_options.coefficients.resize(0, 7);
    m_options.boundary = op.boundary;
    if(op.boundary == Spectral_geometry::Boundary_condition::dirichlet)
      m_options.preserve_border = true;
    m_basis = std::move(basis);
    m_log = Collapse_log(m_basis.number_of_vertices);
    m_fields.signals = std::exchange(m_basis.signals, {});
    m_fields.theta = op.theta;
    m_fields.voronoi = op.voronoi;
    const Spectral_geometry::Operator_coefficients& c = op.coefficients;
    for(Eigen::Index v = 0; v < c.rows(); ++v)
      m_fields.coefficients.push_back(c.row(v).transpose());
    m_fields.conductivity = Spectral_geometry::internal::mean_conductivity(c);
    m_fields.area_scale = 1 / m_basis.area;
    m_fields.single_precision = single_precision;
    m_fields.kept = std::move(kept);
    m_shape.set_weights(options, m_basis.sum_of_squares);
  }

  /// See `Spectral_fields`.
  void set_largest_degree_of_others(const std::size_t degree)
  {
    m_fields.largest_degree_of_others = degree;
  }

  /// Takes the quadrics and the border of the input, from its positions and rings (entries without
  /// triangles). set_geometry() does it in the first run, unless the mesh is another one then.
  void set_input(const std::vector<Eigen::Vector3d>& points, const Spectral_rings& rings);

  /// Follows a collapse outside of a run: F, Z, coefficients, log, quadrics and what is kept. The
  /// geometry is set afterwards.
  void follow(const Merge& m, const Eigen::Vector3d& point)
  {
    m_shape.merge(Slot(m.removed), Slot(m.kept));
    m_log.merge(m.removed, m.kept, m.weight, point);
    if(m_fields.is_kept(Slot(m.removed)))
      m_fields.kept[m.kept] = true; // the mesh decides which of the two remains
    m_fields.signals.merge(m.removed, m.kept, m.weight);
    if(m_fields.vanishes_at(Slot(m.removed)))
      m_fields.vanishing[m.kept] = 1;
    if(!m_fields.coefficients.empty())
      m_fields.coefficients[m.kept] = (1 - m.weight) * m_fields.coefficients[m.kept] +
                                      m.weight * m_fields.coefficients[m.removed];
  }

  /// Takes positions and rings of the mesh as it is and computes R, M, E. Slots that are gone have
  /// an empty ring.
  void set_geometry(std::vector<Eigen::Vector3d> points, Spectral_rings rings);

  /// That of set_basis(), without its signals, which are among the fields.
  const Spectral_basis& basis() const { return m_basis; }
  const Spectral_fields& fields() const { return m_fields; }
  const Collapse_log& log() const { return m_log; }
  const Spectral_shape_term& shape() const { return m_shape; }

  /// E, the sum of E_w over the current vertices (Eq. 2).
  double total() const { return m_total.value(); }

  /// The cost of the edge between two slots, u < v, that CGAL's queue may keep for now: a collapse
  /// beside the edge has changed it, but it was far above the cost of recent collapses. None where
  /// it must be evaluated.
  std::optional<double> postponed_cost(const Slot u, const Slot v) const
  {
    if(u == m_last_kept || v == m_last_kept || m_last_kept == null_spectral_slot)
      return {};
    const auto [at, other] = place_of_cost(u, v);
    const double cost = m_fields.rings[at][m_fields.rings.find(at, other)].cost;
    const bool inner =
        m_last_neighbor[u] == m_log.points().size() && m_last_neighbor[v] == m_last_neighbor[u];
    const double factor = inner ? inner_postponing_factor : outer_postponing_factor;
    return std::isfinite(cost) && cost > factor * m_recent_cost ? std::optional<double>(cost)
                                                                : std::nullopt;
  }

  /// Records the cost of the edge, u < v, in CGAL's queue if it is not that of evaluate(): with a
  /// placement of the user's.
  void set_queued_cost(const Slot u, const Slot v, const double cost)
  {
    const auto [at, other] = place_of_cost(u, v);
    m_fields.rings[at][m_fields.rings.find(at, other)].cost = cost;
  }

  /// No cost is postponed from now on: somebody else chooses what is collapsed, and what that costs
  /// is not known.
  void postpone_no_more() { m_recent_cost = std::numeric_limits<double>::infinity(); }

  /// The best way to collapse the edge between two slots, u < v, for CGAL's queue. An edge at a hub
  /// is costed as if that hub stayed.
  Spectral_sample evaluate(Slot u, Slot v);

  /// The best way for an edge, u < v, whose turn has come. Where its placement would cross another
  /// sheet: the cheapest of the ends and the middle that does not.
  Spectral_sample select(Slot u, Slot v);

  /// Whether a collapse of (u,v) to a point would put a face through another, where that is
  /// guarded.
  bool crosses(Slot u, Slot v, const Eigen::Vector3d& point);

  /// How often an edge was refused because of that.
  std::size_t number_of_crossings() const { return m_number_of_crossings; }

  /// The cost of collapsing to a point that somebody else chose; the weights follow from its
  /// projection.
  double cost_at(Slot u, Slot v, const Eigen::Vector3d& point);

  /// The change of E that commit() would make, to rounding whatever triangles arise; f = (1 -
  /// weight) f_u + weight f_v. 0 where the edge may not be collapsed.
  double change_at(Slot u, Slot v, double weight, const Eigen::Vector3d& point);

  /// The weight of v in a collapse to `point`, see `Spectral_placement_search`.
  double projected_weight(const Slot u, const Slot v, const Eigen::Vector3d& point) const
  {
    return search(u, v).projected_weight(point);
  }

  /// Follows the collapse of `removed` into `kept`, which now lies at `point` with the given ring:
  /// F_kept = (1 - weight) F_kept + weight F_removed, the same for Z and P (section 3.2).
  void commit(const Merge& m, const Eigen::Vector3d& point, Spectral_ring ring);

  /// Gives back the memory of what only collapses need. Results stay: the log, total(), counts,
  /// what is kept.
  void release()
  {
    Spectral_fields fields;
    fields.kept = std::move(m_fields.kept);
    m_fields = std::move(fields);
    m_shape = {};
    m_crossing = {};
  }

  std::size_t number_of_evaluations() const { return m_number_of_evaluations; }

private:
  static constexpr double recent_cost_decay = 0.998;
  // An edge whose cost exceeds that of recent collapses by such a factor is evaluated again, after
  // collapses near it, long before its turn. Edges of the link change more than those that lead
  // away from it. These factors give 16 evaluations per collapse instead of 38, which saves a
  // quarter of the loop; |C|_L was 1.004 times as large (14 runs).
  static constexpr double outer_postponing_factor = 2, inner_postponing_factor = 8;
  // If the placement of an edge would put a face through another, another point may cost at most
  // this factor times the cost of that placement or of the latest collapses. Otherwise one vertex
  // swallows what lies around it, at a thousand times the cost of others. With 4, 8, 16, 32 and 64
  // |C|_L of 19 runs was 34.7, 34.1, 32.4, 34.8 and 36.8 in the geometric mean.
  static constexpr double crossing_factor = 16;

  // The ends of an edge, u < v, reordered: its cost stands in the ring of the first, which is a hub
  // only if both are. A vertex that becomes a hub was kept, so the costs of its edges are unknown.
  std::pair<Slot, Slot> place_of_cost(const Slot u, const Slot v) const
  {
    return m_fields.is_hub(u) && !m_fields.is_hub(v) ? std::pair(v, u) : std::pair(u, v);
  }

  // A running sum that compensates for rounding (Neumaier 1974). A plain sum would carry the
  // rounding of the largest E that it has seen, and a needle makes an E that dwarfs the rest for a
  // while.
  struct Sum
  {
    void add(const double term)
    {
      const double sum = m_sum + term;
      m_rest += std::abs(m_sum) >= std::abs(term) ? (m_sum - sum) + term : (term - sum) + m_sum;
      m_sum = sum;
    }
    double value() const { return m_sum + m_rest; }

    double m_sum = 0, m_rest = 0;
  };

  Spectral_placement_search search(const Slot u, const Slot v) const
  {
    return Spectral_placement_search(m_fields, m_options, m_shape, u, v);
  }

  // R_w = sum_j B_wj z_j - sum_j L_wj f_j over the ring of w, M_w and E_w = |R_w|^2 / M_w. R is
  // computed afresh from the current geometry: nothing accumulates, so E cannot drift.
  void update_row(Slot w);

  Spectral_basis m_basis;
  Spectral_fields m_fields;
  Spectral_options m_options; // but for signals and coefficients
  Spectral_shape_term m_shape;
  Spectral_crossing_guard m_crossing;
  Spectral_collapse_kernel m_kernel;
  bool m_has_input = false;
  Slot m_last_kept = null_spectral_slot;
  // For each slot the last collapse, by number, that it was a neighbour of.
  std::vector<std::uint32_t> m_last_neighbor;
  std::vector<Spectral_row_entry> m_row; // scratch of update_row()

  Sum m_total;
  double m_recent_cost = 0; // about the largest of the edges that were selected lately
  Collapse_log m_log;
  std::size_t m_number_of_evaluations = 0, m_number_of_crossings = 0;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#if !defined(CGAL_SPECTRAL_GEOMETRY_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_LOOP)

namespace CGAL::Surface_mesh_simplification::internal {

CGAL_SPECTRAL_GEOMETRY_INLINE void
Spectral_collapse_core::set_input(const std::vector<Eigen::Vector3d>& points,
                                  const Spectral_rings& rings)
{
  // Quadrics and the border are those of the input.
  if(std::exchange(m_has_input, true))
    return;
  double area = 0; // three times that of the surface, whatever the density
  for(std::size_t w = 0; w < points.size(); ++w) {
    if(m_options.boundary == Spectral_geometry::Boundary_condition::dirichlet)
      m_fields.vanishing.push_back(rings.is_border(Slot(w)));
    rings.for_triangles(Slot(w), [&](const Slot a, const Slot b) {
      area += spectral_triangle(points[w], points[a], points[b]).area;
    });
  }
  if(m_options.shape > 0)
    m_shape.set_geometry(points, rings,
                         m_fields.coefficients.empty() ? m_fields.area_scale : 1 / (area / 3));
}

CGAL_SPECTRAL_GEOMETRY_INLINE void
Spectral_collapse_core::set_geometry(std::vector<Eigen::Vector3d> points, Spectral_rings rings)
{
  set_input(points, rings);
  m_fields.points = std::move(points);
  m_fields.rings = std::move(rings);
  const Eigen::Index n = Eigen::Index(m_fields.points.size());
  m_fields.mass = Eigen::VectorXd::Zero(n);
  m_fields.E = Eigen::VectorXd::Zero(n);
  for(Eigen::Index w = 0; w < n; ++w) {
    m_fields.update_triangles(Slot(w));
    update_row(Slot(w));
  }
  if(m_options.keep_free_of_self_intersections)
    m_crossing.set_geometry(m_fields.points, m_fields.rings);
  m_last_kept = null_spectral_slot;
  m_last_neighbor.assign(std::size_t(n), 0);
  m_total = Sum();
  m_total.add(m_fields.E.sum());
}

CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_sample Spectral_collapse_core::evaluate(const Slot u,
                                                                               const Slot v)
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

CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_sample Spectral_collapse_core::select(const Slot u,
                                                                             const Slot v)
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

CGAL_SPECTRAL_GEOMETRY_INLINE bool Spectral_collapse_core::crosses(const Slot u, const Slot v,
                                                                   const Eigen::Vector3d& point)
{
  return m_crossing.crosses(m_fields.points, m_fields.rings, u, v, point);
}

CGAL_SPECTRAL_GEOMETRY_INLINE double Spectral_collapse_core::cost_at(const Slot u, const Slot v,
                                                                     const Eigen::Vector3d& point)
{
  if(!m_kernel.prepare(m_fields, u, v))
    return std::numeric_limits<double>::infinity();
  ++m_number_of_evaluations;
  return search(u, v).at_point(m_kernel, point).cost;
}

CGAL_SPECTRAL_GEOMETRY_INLINE double Spectral_collapse_core::change_at(const Slot u, const Slot v,
                                                                       const double weight,
                                                                       const Eigen::Vector3d& point)
{
  if(!m_kernel.prepare(m_fields, u, v))
    return 0;
  Spectral_sample sample{point, weight};
  m_kernel.evaluate(sample);
  return m_kernel.change();
}

CGAL_SPECTRAL_GEOMETRY_INLINE void
Spectral_collapse_core::commit(const Merge& m, const Eigen::Vector3d& point, Spectral_ring ring)
{
  const Slot removed = Slot(m.removed), kept = Slot(m.kept);
  follow(m, point);
  m_total.add(-m_fields.E[removed]);
  m_fields.E[removed] = m_fields.mass[removed] = 0;
  m_fields.points[kept] = point;
  m_fields.rings.merge(removed, kept, std::move(ring));
  m_fields.update_triangles(kept);
  m_fields.rings.follow(removed, kept);
  m_crossing.commit(m_fields.points, m_fields.rings, removed, kept);
  m_last_kept = kept;
  std::vector<Slot> changed = {kept};
  m_fields.rings.for_neighbours(kept, [&](const Slot w) {
    m_last_neighbor[w] = std::uint32_t(m_log.points().size());
    changed.push_back(w);
  });
  for(const Slot w : changed)
    m_total.add(-m_fields.E[w]);
  for(const Slot w : changed)
    update_row(w);
  for(const Slot w : changed)
    m_total.add(m_fields.E[w]);
}

CGAL_SPECTRAL_GEOMETRY_INLINE void Spectral_collapse_core::update_row(const Slot w)
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

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // definitions

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_COLLAPSE_CORE_H
