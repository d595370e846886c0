// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_COLLAPSE_CORE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_COLLAPSE_CORE_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_candidates.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_crossing_guard.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_shape_term.h>
#include <CGAL/Spectral_geometry/internal/parallel/Thread_pool.h>

#include <CGAL/Spectral_geometry/internal/separate_compilation.h>
#include <CGAL/Spectral_geometry/local_operator.h>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace CGAL::Surface_mesh_simplification::internal {

class Spectral_collapse_kernel;
class Spectral_placement_search;
struct Spectral_row_entry;

/*!
 * The spectral state without the mesh: F, Z, R = B Z - L F, mass, E, positions, connectivity,
 * candidates and the log of merges, all in slots. It is told what the mesh does and never looks at it.
 *
 * Order of calls: set_basis() once; where collapses come that others choose, set_input() and follow() for each of them; set_geometry()
 * at the start of each run; then, in any order, candidate(), cost_at() or evaluate_around(), which change nothing but candidates and
 * counts, and commit(), which follows one collapse.
 */
class Spectral_collapse_core
{
public:
  /// `op` has n coefficients or none. `single_precision`: whether the mesh stores its points as `float`. Signals and coefficients of the
  /// options are not read.
  void set_basis(const Spectral_basis& basis, const Spectral_geometry::Local_operator& op,
                 const Spectral_options& options, const bool single_precision);

  /// See `Spectral_fields`.
  void set_largest_degree_of_others(const std::size_t degree) { m_fields.largest_degree_of_others = degree; }

  /// Takes positions and rings (entries without triangles) of the input: its quadrics and its border. What set_geometry() does in the
  /// first run, unless the mesh is another one then.
  void set_input(std::vector<Eigen::Vector3d> points, Spectral_rings rings);

  /// Follows a collapse outside of a run: F, Z, coefficients, log, quadrics and what is kept. The geometry is set afterwards.
  void follow(const Spectral_slot removed, const Spectral_slot kept, const double weight,
              const Eigen::Vector3d& point);

  /// Takes positions and rings of the mesh as it is and computes R, M, E. Slots that are gone have an empty ring.
  void set_geometry(std::vector<Eigen::Vector3d> points, Spectral_rings rings);

  /// The vertices that survive with their position and their row of P: one flag for each slot, or nothing.
  void set_kept(std::vector<char> kept) { m_fields.kept = std::move(kept); }

  /// Those of set_basis(), without their signals and coefficients.
  const Spectral_options& options() const { return m_options; }
  const Spectral_fields& fields() const { return m_fields; }
  Eigen::Index number_of_signals() const { return m_number_of_signals; }
  const Collapse_log& log() const { return m_log; }
  const Spectral_shape_term& shape() const { return m_shape; }
  const Spectral_candidates& candidates() const { return m_candidates; }

  /// E, the sum of E_w over the current vertices (Eq. 2).
  double total() const { return m_total.value(); }

  /// The best way to collapse the edge between two slots. Reads only; one kernel per thread. Where all three samples of
  /// section 3.4 cost more than `bound`, the best of them is taken and the candidate is marked as deferred: it is to be
  /// evaluated again, with the minimiser, when its turn comes. For CGAL's queue an edge at an end of many neighbours is costed as
  /// if that end stayed, unless costs are to be exact, and marked as well.
  Spectral_candidate evaluate(Spectral_slot u, Spectral_slot v, Spectral_collapse_kernel& kernel,
                              const double bound = std::numeric_limits<double>::infinity(),
                              const bool for_queue = false) const;

  /// The candidate of an edge, evaluated if need be. A candidate of an older version is good enough
  /// where the edge was selected: it is what CGAL's queue holds. Where its placement would cross another sheet, then: the cheapest of the
  /// ends and the middle that does not.
  const Spectral_candidate& candidate(Spectral_slot u, Spectral_slot v, const bool any_version);

  /// Whether a collapse of (u,v) to a point would put a face through another, where that is guarded.
  bool crosses(const Spectral_slot u, const Spectral_slot v, const Eigen::Vector3d& point);

  /// How often an edge was given up because of that.
  std::size_t number_of_crossings() const { return m_number_of_crossings; }

  /// The cost of collapsing to a point that somebody else chose; the weights follow from its projection.
  double cost_at(const Spectral_slot u, const Spectral_slot v, const Eigen::Vector3d& point);

  /// The change of E that commit() would make, to rounding whatever triangles arise; f = (1 - weight) f_u + weight f_v.
  double change_at(const Spectral_slot u, const Spectral_slot v, const double weight,
                   const Eigen::Vector3d& point);

  /// What a collapse to `point` weights v with, see `Spectral_placement_search`.
  double projected_weight(const Spectral_slot u, const Spectral_slot v, const Eigen::Vector3d& point) const;

  /// Evaluates every edge of the mesh. `progress(fraction)` returning false stops early.
  bool evaluate_all(const std::function<bool(double)>& progress);

  /// Evaluates every edge that CGAL's loop costs again after a collapse to `kept`, those incident to
  /// the neighbours of `kept`, but for what is put off.
  void evaluate_around(const Spectral_slot kept);

  /// Only says which of them keep the candidate that they have; the others are evaluated when they are asked for, or from m_batch.
  void defer_around(const Spectral_slot kept);

  /// Follows the collapse of `removed` into `kept`, which now lies at `point` with the given ring:
  /// F_kept = (1 - weight) F_kept + weight F_removed, the same for Z and P (section 3.2).
  void commit(const Spectral_slot removed, const Spectral_slot kept, const double weight,
              const Eigen::Vector3d& point, Spectral_ring ring);

  /// Forgets the candidates of the edges whose H met the last commit, for one that CGAL costs nothing after: what they are now is found
  /// when their turn comes.
  void drop_candidates_around(const Spectral_slot kept);

  /// Gives back the memory of what only collapses need. Results stay: the log, total(), counts; of the fields what is kept, and has_z_rows().
  void release();

  std::size_t number_of_evaluations() const { return m_number_of_evaluations; }

private:
  // An edge that leads away from the ring of the kept vertex, or along it, is put off where it cost so many times more
  // than the collapses of late: long before its turn comes, others near it will have had it evaluated again. Measured on seven
  // runs: with 4 times, along the ring never, 22 evaluations for each collapse instead of 37, |C|_L times 1.02 (lumped) and
  // 1.00 (averaged); with these factors 16, and against the former |C|_L times 1.003 and 1.005.
  static constexpr double outer_deferral_factor = 2, inner_deferral_factor = 8;
  static constexpr double recent_cost_decay = 0.998;
  // An edge whose placement would put a face through another may cost so many times more at another point than at that placement,
  // or than the collapses of late. Otherwise one vertex swallows what lies around it, at a thousand times the cost of others.
  // With 4, 8, 16, 32 and 64 |C|_L of 19 runs was 34.7, 34.1, 32.4, 34.8 and 36.8 in the geometric mean.
  static constexpr double crossing_factor = 16;

  struct Workspace; // the scratch memory of one thread
  using Pool = Spectral_geometry::internal::Thread_pool<Workspace>;

  // A running sum that keeps what rounding takes off (Neumaier 1974): a plain one would carry the rounding of the largest
  // E that it has seen, and a needle makes an E that dwarfs the rest for a while.
  class Sum
  {
  public:
    void add(const double term)
    {
      const double sum = m_sum + term;
      m_rest += std::abs(m_sum) >= std::abs(term) ? (m_sum - sum) + term : (term - sum) + m_sum;
      m_sum = sum;
    }
    double value() const { return m_sum + m_rest; }

  private:
    double m_sum = 0, m_rest = 0;
  };

  Spectral_placement_search search(Spectral_slot u, Spectral_slot v) const;

  // Of the mesh as it is, whatever the density.
  double surface_area() const;

  // R_w = sum_j B_wj z_j - sum_j L_wj f_j over the ring of w, M_w and E_w = |R_w|^2 / M_w.
  void update_row(const Spectral_slot w, std::vector<Spectral_row_entry>& row);

  // R and what follows from it, at `kept` and its neighbours. R is computed afresh from the current geometry: nothing
  // accumulates, so E cannot drift.
  void refresh_around(const Spectral_slot kept);

  // A candidate that costs more than the collapses of late gets the minimiser of section 3.4 when its turn comes, and the
  // best of the three samples till then. Measured on 60 runs, 30 in each mass: |C|_L times 1.007 and 0.991, within
  // their noise. Free placement gains too much from its search: there it was 1.03.
  double minimiser_bound() const;

  Spectral_fields m_fields;
  Spectral_options m_options;
  Spectral_shape_term m_shape;
  Spectral_crossing_guard m_crossing;
  Eigen::Index m_number_of_signals = 0;
  // Edges around a vertex that are not put off, the smaller slot first, and who is a neighbour of it: whose mark is m_mark.
  std::vector<std::pair<Spectral_slot, Spectral_slot>> m_batch;
  std::vector<std::size_t> m_marks;
  std::size_t m_mark = 0;

  Sum m_total;
  double m_recent_cost = 0; // about the largest of the last collapses, but for those at another point
  Collapse_log m_log;
  Spectral_candidates m_candidates;
  std::size_t m_number_of_evaluations = 0, m_number_of_crossings = 0;

  std::shared_ptr<Pool> m_pool; // shared by nobody: it can be destroyed where `Workspace` is incomplete
};

} // namespace CGAL::Surface_mesh_simplification::internal

#ifndef CGAL_SPECTRAL_GEOMETRY_COMPILED
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_collapse_core_impl.h>
#endif

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_COLLAPSE_CORE_H
