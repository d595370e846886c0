// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COLLAPSE_CORE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COLLAPSE_CORE_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Fine_vertex_slots.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_candidates.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_change.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_collapse_kernel.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_placement_quadric.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_residual_row.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_thread_pool.h>

#include <CGAL/Spectral_geometry/restriction.h>

#include <Eigen/Core>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// The part of `Spectral_options` that the cost of a candidate depends on.
struct Spectral_cost_parameters
{
  Spectral_placement_strategy placement = Spectral_placement_strategy::on_edge;
  bool binary = false;
  bool preserve_border = false;
  bool single_precision_points = false; ///< the mesh stores its points as float
  int threads = 1;
};

/*!
 * The spectral state without the mesh: F, Z, R = B Z - L F, mass, E, positions, connectivity,
 * candidates and the merge forest, all in slots. It is told what the mesh does and never looks at it.
 *
 * Order of calls: set_basis() once; set_geometry() at the start of each run; then, in any order,
 * candidate(), cost_at(), evaluate_around() or start_around(), which read, and commit(), which follows one collapse.
 * What start_around() has left to other threads is finished by whatever changes the state.
 */
class Spectral_collapse_core
{
public:
  using Rows = Spectral_fields::Rows;

  Spectral_collapse_core() = default;

  /// `F` is n x K. `lambda` has K entries if Z = F Lambda; otherwise it is empty and `Z` is n x K.
  void set_basis(const Eigen::MatrixXd& F, const Eigen::VectorXd& lambda, const Eigen::MatrixXd& Z,
                 const double theta, const double area_scale, const Spectral_cost_parameters& parameters)
  {
    const Eigen::Index K = F.cols();
    const Eigen::Index padded = (K + Eigen::Index(spectral_padding) - 1) / Eigen::Index(spectral_padding) *
                                Eigen::Index(spectral_padding);
    m_number_of_signals = K;
    m_fields.F = Rows::Zero(F.rows(), padded);
    m_fields.F.leftCols(K) = F;
    m_fields.Z.resize(0, 0);
    m_fields.lambda = Eigen::VectorXd::Zero(padded);
    if(lambda.size() != 0)
      m_fields.lambda.head(K) = lambda;
    else
      set_Z(Z);
    m_fields.theta = theta;
    m_fields.area_scale = area_scale;
    m_parameters = parameters;
    m_pool = std::make_unique<Pool>(parameters.threads);
    m_forest = Spectral_geometry::Merge_forest(F.rows());
    m_candidates.resize(std::size_t(F.rows()));
  }

  /// Replaces Z = F Lambda by rows of its own. set_geometry() must follow.
  void set_Z(const Eigen::MatrixXd& Z)
  {
    m_fields.Z = Rows::Zero(m_fields.F.rows(), m_fields.F.cols());
    m_fields.Z.leftCols(Z.cols()) = Z;
  }

  /// Takes positions and rings (entries without triangles) of the mesh as it is and computes R, M, E.
  /// Slots that are gone have an empty ring.
  void set_geometry(std::vector<Eigen::Vector3d> points, Spectral_rings rings)
  {
    finish();
    m_fields.points = std::move(points);
    m_fields.rings = std::move(rings);
    const Eigen::Index n = m_fields.F.rows();
    m_fields.R.resize(n, m_fields.F.cols());
    m_fields.mass = Eigen::VectorXd::Zero(n);
    m_fields.E = Eigen::VectorXd::Zero(n);
    for(Spectral_slot w = 0; w < Spectral_slot(n); ++w) {
      m_fields.rings.link_back(w);
      m_fields.rings.update_triangles(w, position());
    }
    m_products.resize(std::size_t(n));
    m_pool->for_each(std::size_t(n), 1024, [this](const std::size_t w, Workspace& workspace) {
      update_row(Spectral_slot(w), workspace.row);
      workspace.builder.compute(m_fields, Spectral_slot(w), m_products[w]);
    });
    m_total = Sum();
    m_total.add(m_fields.E.sum());
    m_recent_cost = 0;
    m_candidates.clear();
  }

  /// The vertices that survive with their position and their row of P: one flag for each slot, or nothing.
  void set_kept(std::vector<char> kept) { m_kept = std::move(kept); }

  bool is_kept(const Spectral_slot s) const { return !m_kept.empty() && m_kept[s] != 0; }

  /// Whether a collapse to `point` would move a vertex that is to be kept, or merge two of them.
  bool moves_kept_vertex(const Spectral_slot u, const Spectral_slot v, const Eigen::Vector3d& point) const
  {
    return (is_kept(u) && (is_kept(v) || point != m_fields.points[u])) ||
           (is_kept(v) && point != m_fields.points[v]);
  }

  const Spectral_fields& fields() const { return m_fields; }
  const Spectral_cost_parameters& parameters() const { return m_parameters; }
  Eigen::Index number_of_signals() const { return m_number_of_signals; }
  const Spectral_geometry::Merge_forest& forest() const { return m_forest; }
  /// With all that is being evaluated.
  const Spectral_candidates& candidates() const
  {
    finish();
    return m_candidates;
  }

  /// E, the sum of E_w over the current vertices (Eq. 2).
  double total() const { return m_total.value(); }

  /// The best way to collapse the edge between two slots. Reads only; one kernel per thread. Where all three samples of
  /// section 3.4 cost more than `bound`, the best of them is taken and the candidate is marked as deferred: it is to be
  /// evaluated again, with the minimiser, when its turn comes.
  Spectral_candidate evaluate(Spectral_slot u, Spectral_slot v, Spectral_collapse_kernel& kernel,
                              const double bound = std::numeric_limits<double>::infinity()) const
  {
    if(v < u)
      std::swap(u, v);
    Spectral_candidate result;
    result.other = v;
    if(kernel.prepare(m_fields, m_products, u, v) != Spectral_collapse_kernel::Topology::collapsible)
      return result;
    const Spectral_sample best = best_sample(u, v, kernel, bound);
    if(!std::isfinite(best.cost))
      return result;
    result.collapsible = true;
    result.deferred = best.cost > bound;
    result.cost = best.cost;
    result.weight = best.weight;
    result.point = best.point;
    return result;
  }

  /// The candidate of an edge, evaluated if need be. A candidate of an older version is good enough
  /// where the edge was selected: it is what CGAL's queue holds.
  const Spectral_candidate& candidate(const Spectral_slot u, const Spectral_slot v, const bool any_version)
  {
    const Spectral_candidate* found = m_candidates.find(u, v);
    if(found != nullptr && found->task != 0)
      found = &collect(found->task - 1);
    if(found != nullptr && (any_version ? !found->deferred : found->version == m_candidates.version()))
      return *found;
    ++m_number_of_evaluations;
    return m_candidates.insert(
        (std::min)(u, v),
        evaluate(u, v, m_pool->workspace().kernel,
                 any_version ? std::numeric_limits<double>::infinity() : minimiser_bound()));
  }

  /// The cost of collapsing to a point that somebody else chose; the weights follow from its projection.
  double cost_at(const Spectral_slot u, const Spectral_slot v, const Eigen::Vector3d& point)
  {
    Spectral_collapse_kernel& kernel = m_pool->workspace().kernel;
    if(kernel.prepare(m_fields, m_products, u, v) != Spectral_collapse_kernel::Topology::collapsible)
      return std::numeric_limits<double>::infinity();
    ++m_number_of_evaluations;
    Spectral_sample sample;
    sample.point = point;
    sample.weight = projected_weight(u, v, point);
    kernel.evaluate(&sample, 1);
    return sample.cost;
  }

  /// The change of E that commit() would make, to rounding whatever the cotangents are; f = (1 - weight) f_u + weight f_v.
  double change_at(const Spectral_slot u, const Spectral_slot v, const double weight,
                   const Eigen::Vector3d& point)
  {
    return m_change(m_fields, u, v, weight, point);
  }

  /// alpha = (x - u).(v - u) / |v - u|^2 clamped to [0,1] (appendix A), rounded in binary mode; 1/2 on
  /// an edge without length; all of it on an end that is to be kept.
  double projected_weight(const Spectral_slot u, const Spectral_slot v, const Eigen::Vector3d& point) const
  {
    return rounded(u, v, projected_edge_weight(m_fields.points[u], m_fields.points[v], point));
  }

  /// Evaluates every edge of the mesh. `progress(fraction)` returning false stops early.
  template <class Progress>
  bool evaluate_all(const Progress& progress)
  {
    finish();
    m_batch.clear();
    for(Spectral_slot u = 0; u < Spectral_slot(m_fields.points.size()); ++u)
      for(const Spectral_ring_entry& e : m_fields.rings[u])
        if(u < e.vertex)
          m_batch.emplace_back(u, e.vertex);
    const std::size_t chunk = 4096;
    const std::vector<Edge> all = m_batch;
    for(std::size_t i = 0; i < all.size(); i += chunk) {
      m_batch.assign(all.begin() + i, all.begin() + (std::min)(all.size(), i + chunk));
      evaluate_batch();
      if(!progress(double((std::min)(all.size(), i + chunk)) / double(all.size())))
        return false;
    }
    return true;
  }

  /// Evaluates every edge that CGAL's loop costs again after a collapse to `kept`: those incident to
  /// the neighbours of `kept`.
  void evaluate_around(const Spectral_slot kept)
  {
    collect_around(kept);
    evaluate_batch();
  }

  /// The same on other threads, where there are any, while the caller goes on: each candidate is waited for when it is asked
  /// for, or evaluated by who asks.
  void start_around(const Spectral_slot kept)
  {
    collect_around(kept);
    if(m_pool->number_of_threads() == 1)
      evaluate_batch();
    else
      start_batch();
  }

  /// Waits for what was started. Whatever changes the state does so first.
  void finish() const
  {
    m_pool->finish();
    for(std::size_t i = 0; i < m_number_of_tasks; ++i)
      if(!m_tasks[i].collected)
        collect(i);
    m_number_of_tasks = 0;
  }

  /// Only says which of them keep the candidate that they have; the others are evaluated when they are asked for.
  void defer_around(const Spectral_slot kept) { collect_around(kept); }

  /// Follows the collapse of `removed` into `kept`, which now lies at `point` with the given ring:
  /// F_kept = (1 - weight) F_kept + weight F_removed, the same for Z and P (section 3.2).
  void commit(const Spectral_slot removed, const Spectral_slot kept, const double weight,
              const Eigen::Vector3d& point, Spectral_ring ring)
  {
    finish();
    const double before = total();
    m_forest.merge(removed, kept, weight);
    if(is_kept(removed))
      m_kept[kept] = true; // which of the two goes on in the mesh is not ours to choose
    merge_rows(m_fields.F, removed, kept, weight);
    if(m_fields.Z.size() != 0)
      merge_rows(m_fields.Z, removed, kept, weight);
    m_total.add(-m_fields.E[removed]);
    m_fields.E[removed] = m_fields.mass[removed] = 0;
    m_fields.points[kept] = point;
    m_fields.rings.merge(removed, kept, std::move(ring));
    m_fields.rings.update_triangles(kept, position());
    m_candidates.merge(removed);
    follow_around(removed, kept);
    refresh_around(removed, kept);
    m_recent_cost = (std::max)(total() - before, m_recent_cost * recent_cost_decay);
  }

  /// Forgets the candidates of the edges whose H met the last commit.
  void drop_candidates_around(const Spectral_slot kept)
  {
    for(const Spectral_ring_entry& e : m_fields.rings[kept])
      for(const Spectral_ring_entry& f : m_fields.rings[e.vertex])
        m_candidates.forget((std::min)(e.vertex, f.vertex), (std::max)(e.vertex, f.vertex));
  }

  std::size_t number_of_evaluations() const { return m_number_of_evaluations; }

private:
  // An edge that leads away from the ring of the kept vertex, or along it, is put off where it cost so many times more
  // than the collapses of late: long before its turn comes, others near it will have had it evaluated again. Measured on seven
  // runs: with 4 times, along the ring never, 22 evaluations for each collapse instead of 37, |C|_L times 1.02 (lumped) and
  // 1.00 (averaged); with these factors 16, and against the former |C|_L times 1.003 and 1.005.
  static constexpr double outer_deferral_factor = 2, inner_deferral_factor = 8;
  static constexpr double recent_cost_decay = 0.998;

  // The scratch memory of one thread.
  struct Workspace
  {
    Spectral_collapse_kernel kernel;
    Spectral_ring_product_builder builder;
    std::vector<Spectral_row_entry> row;
  };
  using Pool = Spectral_thread_pool<Workspace>;
  using Edge = std::pair<Spectral_slot, Spectral_slot>;

  // The evaluation of one edge of m_batch, in memory of its own: two threads look at it.
  struct alignas(64) Task
  {
    enum Stage { waiting, begun, done };
    std::atomic<int> stage{waiting};
    bool collected = false; // into m_candidates
    Spectral_candidate result;
  };

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

  struct Position
  {
    const std::vector<Eigen::Vector3d>& points;
    const Eigen::Vector3d& operator()(const Spectral_slot s) const { return points[s]; }
  };
  Position position() const { return Position{m_fields.points}; }

  static void merge_rows(Rows& rows, const Spectral_slot removed, const Spectral_slot kept,
                         const double weight)
  {
    rows.row(kept) = (1 - weight) * rows.row(kept) + weight * rows.row(removed);
  }

  // R_w = sum_j B_wj z_j - sum_j L_wj f_j over the ring of w, M_w and E_w = |R_w|^2 / M_w.
  void update_row(const Spectral_slot w, std::vector<Spectral_row_entry>& row)
  {
    const Spectral_ring& ring = m_fields.rings[w];
    double area = 0, to_self = 0;
    row.clear();
    for(std::size_t i = 0; i < ring.size(); ++i) {
      const Spectral_triangle &after = ring[i].triangle,
                              &before = ring[Spectral_rings::prev(ring, i)].triangle;
      const double cot = (after.cot_second + before.cot_first) / 2;
      row.push_back(Spectral_row_entry{ring[i].vertex, cot,
                                       (after.area + before.area) * m_fields.area_scale *
                                           m_fields.off_diagonal_share()});
      to_self -= cot;
      area += after.area * m_fields.area_scale;
    }
    row.push_back(Spectral_row_entry{w, to_self, area * m_fields.diagonal_share()});
    const double square = spectral_combine_rows(m_fields, row, m_fields.R.row(w).data());
    m_fields.mass[w] = area / 3;
    m_fields.E[w] = area > 0 ? square / m_fields.mass[w] : 0;
  }

  // The rings of the neighbours of `kept`, and the products in those that have lost an entry.
  void follow_around(const Spectral_slot removed, const Spectral_slot kept)
  {
    Spectral_rings& rings = m_fields.rings;
    for(std::size_t i = 0; i < rings[kept].size(); ++i) {
      const Spectral_slot w = rings[kept][i].vertex;
      const std::size_t lost = rings.follow(removed, kept, i);
      if(lost != Spectral_rings::none) {
        m_products[w].erase(lost);
        rings.link_back(w);
      }
      m_candidates.forget(w, removed);
    }
  }

  // R and what follows from it, at `kept` and its neighbours. R is computed afresh from the current geometry: nothing
  // accumulates, so E cannot drift. f changed at `kept` alone: the products in its ring are computed afresh, in those of
  // its neighbours what f of `kept` or R of the centre is in. The rings around them hold neither.
  void refresh_around(const Spectral_slot removed, const Spectral_slot kept)
  {
    const Spectral_rings& rings = m_fields.rings;
    const std::size_t n = rings[kept].size() + 1;
    const auto center = [&](const std::size_t i) { return i == 0 ? kept : rings[kept][i - 1].vertex; };
    for(std::size_t i = 0; i < n; ++i)
      m_total.add(-m_fields.E[center(i)]);
    m_products[kept].take_memory(m_products[removed]);
    m_pool->for_each(n, 1, [&](const std::size_t i, Workspace& workspace) {
      const Spectral_slot c = center(i);
      update_row(c, workspace.row);
      if(i == 0 || rings[c].size() != m_products[c].degree())
        workspace.builder.compute(m_fields, c, m_products[c]);
      else
        workspace.builder.update(m_fields, c, m_products[c], rings[kept][i - 1].back);
    });
    for(std::size_t i = 0; i < n; ++i)
      m_total.add(m_fields.E[center(i)]);
  }

  // A candidate that costs more than the collapses of late gets the minimiser of section 3.4 when its turn comes, and the
  // best of the three samples till then. Measured on 60 runs, 30 in each mass: |C|_L times 1.007 and 0.991, within
  // their noise. Free placement gains too much from its search: there it was 1.03.
  double minimiser_bound() const
  {
    return m_parameters.placement == Spectral_placement_strategy::on_edge
               ? m_recent_cost
               : std::numeric_limits<double>::infinity();
  }

  double rounded(const Spectral_slot u, const Spectral_slot v, const double alpha) const
  {
    if(is_kept(u) || is_kept(v))
      return is_kept(u) ? 0. : 1.;
    if(!m_parameters.binary)
      return alpha;
    if(alpha != 0.5)
      return alpha < 0.5 ? 0. : 1.;
    if(m_fields.mass[u] != m_fields.mass[v])
      return m_fields.mass[u] > m_fields.mass[v] ? 0. : 1.;
    return u < v ? 0. : 1.;
  }

  Spectral_sample sample_at(const Spectral_slot u, const Spectral_slot v, const double alpha) const
  {
    Spectral_sample s;
    const Eigen::Vector3d &pu = m_fields.points[u], &pv = m_fields.points[v];
    s.point = alpha == 0 ? pu : alpha == 1 ? pv : Eigen::Vector3d((1 - alpha) * pu + alpha * pv);
    if(m_parameters.single_precision_points)
      s.point = s.point.cast<float>().cast<double>();
    s.weight = rounded(u, v, alpha);
    return s;
  }

  // The sum of the normals around both ends, weighted by area.
  Eigen::Vector3d normal_at_edge(const Spectral_slot u, const Spectral_slot v) const
  {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for(const Spectral_slot c : {u, v}) {
      const Spectral_ring& ring = m_fields.rings[c];
      for(std::size_t i = 0; i < ring.size(); ++i)
        if(ring[i].face)
          normal +=
              (m_fields.points[ring[i].vertex] - m_fields.points[c])
                  .cross(m_fields.points[ring[Spectral_rings::next(ring, i)].vertex] - m_fields.points[c]);
    }
    return normal;
  }

  Spectral_sample sample_off_edge(const Spectral_slot u, const Spectral_slot v, Eigen::Vector3d point) const
  {
    Spectral_sample s;
    if(m_parameters.single_precision_points)
      point = point.cast<float>().cast<double>();
    s.point = point;
    s.weight = projected_weight(u, v, point);
    return s;
  }

  // Appendix A, strategy (iii): the minimiser of a quadric through samples around the edge, unless one of the samples
  // or `best`, the one on the edge, is cheaper. `on_edge` are the three samples of strategy (ii).
  Spectral_sample best_free_sample(const Spectral_slot u, const Spectral_slot v,
                                   const Spectral_sample* on_edge, Spectral_sample best,
                                   Spectral_collapse_kernel& kernel) const
  {
    using Quadric = Spectral_placement_quadric;
    Quadric quadric;
    if(!quadric.set_frame(m_fields.points[u], m_fields.points[v], normal_at_edge(u, v)))
      return best;
    constexpr int n = Quadric::number_of_samples, first = Quadric::number_on_edge;
    Spectral_sample samples[n];
    double costs[n];
    std::copy(on_edge, on_edge + first, samples);
    for(int i = first; i < n; ++i)
      samples[i] = sample_off_edge(u, v, quadric.point(i));
    for(int i = first; i < n; i += Spectral_collapse_kernel::max_samples)
      kernel.evaluate(samples + i, (std::min)(int(Spectral_collapse_kernel::max_samples), n - i));
    for(int i = 0; i < n; ++i) {
      costs[i] = samples[i].cost;
      if(costs[i] < best.cost)
        best = samples[i];
    }
    if(!quadric.fit(costs))
      return best;
    Spectral_sample minimiser = sample_off_edge(u, v, quadric.minimiser());
    kernel.evaluate(&minimiser, 1);
    return minimiser.cost < best.cost ? minimiser : best;
  }

  struct Fixed_ends
  {
    bool u, v;
    bool on_border; // the whole edge is the border, which is to be preserved
  };

  // The ends that the merged vertex must lie on.
  Fixed_ends fixed_ends(const Spectral_slot u, const Spectral_slot v) const
  {
    Fixed_ends fixed{is_kept(u), is_kept(v), false};
    if(m_parameters.preserve_border) {
      const bool border_u = m_fields.rings.is_border(u), border_v = m_fields.rings.is_border(v);
      fixed.on_border = border_u && border_v;
      fixed.u = fixed.u || (border_u && !border_v);
      fixed.v = fixed.v || (border_v && !border_u);
    }
    return fixed;
  }

  // Section 3.4: midpoint, or the minimiser over alpha of the parabola through three samples, or what is found from
  // there.
  Spectral_sample best_sample(const Spectral_slot u, const Spectral_slot v, Spectral_collapse_kernel& kernel,
                              const double bound) const
  {
    Spectral_sample samples[3];
    const Fixed_ends fixed = fixed_ends(u, v);
    if(fixed.u && fixed.v)
      return Spectral_sample(); // of infinite cost
    if(fixed.u || fixed.v) {
      samples[0] = sample_at(u, v, fixed.v ? 1. : 0.);
      kernel.evaluate(samples, 1);
      return samples[0];
    }
    if(m_parameters.placement == Spectral_placement_strategy::midpoint) {
      samples[0] = sample_at(u, v, 0.5);
      kernel.evaluate(samples, 1);
      return samples[0];
    }
    for(int s = 0; s < 3; ++s)
      samples[s] = sample_at(u, v, s / 2.);
    kernel.evaluate(samples, 3);
    Spectral_sample best = samples[0];
    for(int s = 1; s < 3; ++s)
      if(samples[s].cost < best.cost)
        best = samples[s];
    if(best.cost > bound)
      return best;

    // p(alpha) = c0 + b alpha + a alpha^2
    const double a = 2 * (samples[0].cost - 2 * samples[1].cost + samples[2].cost);
    const double b = 4 * samples[1].cost - 3 * samples[0].cost - samples[2].cost;
    const double alpha = -b / (2 * a);
    if(std::isfinite(a) && a > 0 && alpha > 0 && alpha < 1 && alpha != 0.5) {
      Spectral_sample minimiser = sample_at(u, v, alpha);
      kernel.evaluate(&minimiser, 1);
      if(minimiser.cost < best.cost)
        best = minimiser;
    }
    if(m_parameters.placement == Spectral_placement_strategy::free && !fixed.on_border)
      return best_free_sample(u, v, samples, best, kernel);
    return best;
  }

  // The edges incident to the neighbours of `kept`, into m_batch, without those that are put off.
  void collect_around(const Spectral_slot kept)
  {
    finish();
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
        const double factor = inner ? inner_deferral_factor : outer_deferral_factor;
        if(e.vertex != kept && m_candidates.defer(neighbor.vertex, e.vertex, factor * m_recent_cost))
          continue;
        m_batch.push_back(std::minmax(Spectral_slot(neighbor.vertex), Spectral_slot(e.vertex)));
      }
  }

  void evaluate_batch()
  {
    m_number_of_evaluations += m_batch.size();
    m_results.resize(m_batch.size());
    const double bound = minimiser_bound();
    m_pool->for_each(m_batch.size(), 2, [this, bound](const std::size_t i, Workspace& workspace) {
      m_results[i] = evaluate(m_batch[i].first, m_batch[i].second, workspace.kernel, bound);
    });
    for(std::size_t i = 0; i < m_batch.size(); ++i)
      m_candidates.insert(m_batch[i].first, m_results[i]);
  }

  void start_batch()
  {
    const std::size_t n = m_batch.size();
    if(m_tasks.size() < n)
      m_tasks = std::vector<Task>(2 * n);
    m_number_of_tasks = m_last_task = n;
    m_number_of_evaluations += n;
    m_bound = minimiser_bound();
    for(std::size_t i = 0; i < n; ++i) {
      m_tasks[i].stage.store(Task::waiting, std::memory_order_relaxed);
      m_tasks[i].collected = false;
      Spectral_candidate in_work;
      in_work.other = m_batch[i].second;
      in_work.task = std::uint32_t(i + 1);
      m_candidates.insert(m_batch[i].first, in_work);
    }
    m_pool->start(n, [this](const std::size_t i, Workspace& workspace) { run_task(i, workspace); });
  }

  // Unless somebody has begun with it.
  void run_task(const std::size_t i, Workspace& workspace) const
  {
    Task& task = m_tasks[i];
    int stage = Task::waiting;
    if(!task.stage.compare_exchange_strong(stage, Task::begun))
      return;
    task.result = evaluate(m_batch[i].first, m_batch[i].second, workspace.kernel, m_bound);
    task.stage.store(Task::done, std::memory_order_release);
  }

  const Spectral_candidate& collect(const std::size_t i) const
  {
    Task& task = m_tasks[i];
    run_task(i, m_pool->workspace());
    const auto done = [&task] { return task.stage.load(std::memory_order_acquire) == Task::done; };
    while(m_last_task > i && !done()) // rather than to wait: the others begin at the front
      run_task(--m_last_task, m_pool->workspace());
    Pool::wait_for(done);
    task.collected = true;
    return m_candidates.insert(m_batch[i].first, task.result);
  }

  Spectral_fields m_fields;
  Spectral_cost_parameters m_parameters;
  std::vector<char> m_kept;
  Eigen::Index m_number_of_signals = 0;
  Sum m_total;
  double m_recent_cost = 0; // about the largest of the last collapses
  Spectral_geometry::Merge_forest m_forest;
  mutable Spectral_candidates m_candidates; // mutable: what is in work is put in when it is asked for

  std::vector<Spectral_ring_products> m_products;
  std::vector<std::size_t> m_marks;
  std::size_t m_mark = 0;
  std::vector<Edge> m_batch;
  std::vector<Spectral_candidate> m_results;
  mutable std::vector<Task> m_tasks;
  mutable std::size_t m_number_of_tasks = 0, m_last_task = 0;
  double m_bound = 0;
  Spectral_change m_change;
  std::size_t m_number_of_evaluations = 0;
  std::unique_ptr<Pool> m_pool; // last: its threads look at the rest
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COLLAPSE_CORE_H
