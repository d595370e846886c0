// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_PLACEMENT_SEARCH_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_PLACEMENT_SEARCH_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Fine_vertex_slots.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_collapse_kernel.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_fields.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_shape_term.h>

#include <Eigen/Eigenvalues>

namespace CGAL::Surface_mesh_simplification::internal {

/*!
 * The quadric q(y) = c + b.y + y^T A y through ten samples of cost(e,x), x = m + sum_i y_i a_i
 * (strategy (iii), appendix A of the paper): y = 0, +-e_i and (e_i + e_j) / sqrt(2), which are ten
 * unknowns.
 *
 * m is the middle of the edge and a_0 half of it, so three of the samples are those of strategy
 * (ii). a_1 lies across the edge in the surface, and a_2 along its normal, where the cost rises
 * steeply: it is shorter.
 */
class Spectral_placement_quadric
{
public:
  static constexpr int number_of_samples = 10;
  /// The samples in the order of point(): u, m, v first, then those off the edge.
  static constexpr int number_on_edge = 3;

  /// `normal`: of the surface at the edge, of any length. False if the edge or the normal has no
  /// direction.
  bool set_frame(const Eigen::Vector3d& u, const Eigen::Vector3d& v, const Eigen::Vector3d& normal)
  {
    m_middle = (u + v) / 2;
    m_axes.col(0) = (v - u) / 2;
    const Eigen::Vector3d across = normal.cross(v - u);
    const double half_length = m_axes.col(0).norm(), across_length = across.norm();
    if(!(half_length > 0) || !(across_length > 0))
      return false;
    m_axes.col(1) = across * (half_length / across_length);
    const Eigen::Vector3d up = (v - u).cross(across).normalized();
    m_axes.col(2) = up * (half_length * normal_ratio);
    return m_axes.allFinite();
  }

  /// x of sample i.
  Eigen::Vector3d point(const int i) const
  {
    const double h = std::sqrt(0.5);
    const double y[number_of_samples][3] = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0},  {0, 1, 0},
                                            {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {h, h, 0},
                                            {h, 0, h},  {0, h, h}};
    return at(Eigen::Vector3d(y[i]));
  }

  /// x that minimises the quadric through these ten costs in the ellipsoid of the samples, outside
  /// of which they tell nothing: four of five quadrics have no minimum elsewhere. None unless all
  /// costs are finite.
  std::optional<Eigen::Vector3d> minimiser(const double* costs) const
  {
    const double c = costs[1];
    const Eigen::Vector3d plus(costs[2], costs[3], costs[5]), minus(costs[0], costs[4], costs[6]);
    const Eigen::Vector3d b = (plus - minus) / 2;
    Eigen::Matrix3d A;
    A.diagonal() = ((plus + minus) / 2).array() - c;
    int sample = 7;
    for(int i = 0; i < 3; ++i)
      for(int j = i + 1; j < 3; ++j)
        A(i, j) = A(j, i) =
            costs[sample++] - c - (b[i] + b[j]) / std::sqrt(2.) - (A(i, i) + A(j, j)) / 2;
    if(!A.allFinite() || !b.allFinite())
      return {};
    const Eigen::Vector3d y = minimiser_in_ball(A, b);
    return y.allFinite() ? std::optional<Eigen::Vector3d>(at(y)) : std::nullopt;
  }

private:
  // It is a part of half the edge. On spot, cheburashka, homer and rocker-arm 0.1 and 0.25 give
  // away half of what 0.5 gains.
  static constexpr double normal_ratio = 0.5;

  // The y of |y| <= 1 with (A + mu I) y = -b / 2, where mu >= 0 makes the matrix positive definite
  // and is 0 if |y| < 1. |y| falls as mu grows.
  static Eigen::Vector3d minimiser_in_ball(const Eigen::Matrix3d& A, const Eigen::Vector3d& b)
  {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(A);
    const Eigen::Vector3d values = solver.eigenvalues(),
                          c = solver.eigenvectors().transpose() * b / -2;
    const double scale = values.cwiseAbs().maxCoeff() + c.norm();
    const auto y = [&](const double mu) -> Eigen::Vector3d {
      return c.cwiseQuotient((values.array() + mu).matrix());
    };
    double low = (std::max)(0., -values[0]) + 1e-12 * scale, high = low + c.norm();
    if(y(low).squaredNorm() <= 1)
      high = low;
    while(high - low > 1e-12 * scale) {
      const double middle = (low + high) / 2;
      (y(middle).squaredNorm() <= 1 ? high : low) = middle;
    }
    return solver.eigenvectors() * y(high);
  }

  Eigen::Vector3d at(const Eigen::Vector3d& y) const { return m_middle + m_axes * y; }

  Eigen::Vector3d m_middle;
  Eigen::Matrix3d m_axes;
};

/*!
 * The placement of a candidate (u,v) (section 3.4, appendix A): which points are tried, and the
 * weight that goes with each. Looks at the state and changes nothing; the kernel that evaluates has
 * been prepared for the edge.
 */
class Spectral_placement_search
{
public:
  Spectral_placement_search(const Spectral_fields& fields, const Spectral_options& options,
                            const Spectral_shape_term& shape, const Spectral_slot u,
                            const Spectral_slot v)
    : m_fields(fields)
    , m_options(options)
    , m_shape(shape)
    , m_u(u)
    , m_v(v)
  {}

  /// `projected_edge_weight()`, rounded in binary mode; all of it on an end that is to be kept.
  double projected_weight(const Eigen::Vector3d& point) const
  {
    return rounded(projected_edge_weight(m_fields.points[m_u], m_fields.points[m_v], point));
  }

  /// The collapse to what the mesh makes of a point, with the weight of its projection.
  Spectral_sample at_point(Spectral_collapse_kernel& kernel, const Eigen::Vector3d& x) const
  {
    const Eigen::Vector3d point = as_stored(x);
    return evaluated(kernel, {point, projected_weight(point)});
  }

  /// Section 3.4: midpoint, or the minimiser over alpha of the parabola through three samples, or
  /// what is found from there.
  Spectral_sample best(Spectral_collapse_kernel& kernel) const
  {
    const Fixed_ends fixed = fixed_ends();
    if(fixed.u && fixed.v)
      return Spectral_sample(); // of infinite cost
    if(fixed.u || fixed.v || m_options.placement == Spectral_placement_strategy::midpoint)
      return at_weight(kernel, fixed.u ? 0. : fixed.v ? 1. : 0.5);
    const bool free = m_options.placement == Spectral_placement_strategy::free && !fixed.on_border;
    if(free && !m_shape.is_empty()) {
      const Spectral_sample at_minimum = at_point(kernel, minimiser_of_shape());
      const Spectral_sample on_edge = best_on_edge(kernel, std::numeric_limits<double>::infinity(),
                                                   [](const Eigen::Vector3d&) { return true; });
      return at_minimum.cost < on_edge.cost ? at_minimum : on_edge;
    }
    Spectral_sample samples[3];
    for(int s = 0; s < 3; ++s)
      samples[s] = at_weight(kernel, s / 2.);
    Spectral_sample best = *cheapest(samples, 3);

    // p(alpha) = c0 + b alpha + a alpha^2
    const double a = 2 * (samples[0].cost - 2 * samples[1].cost + samples[2].cost);
    const double b = 4 * samples[1].cost - 3 * samples[0].cost - samples[2].cost;
    const double alpha = -b / (2 * a);
    if(std::isfinite(a) && a > 0 && alpha > 0 && alpha < 1 && alpha != 0.5) {
      const Spectral_sample minimiser = at_weight(kernel, alpha);
      if(minimiser.cost < best.cost)
        best = minimiser;
    }
    return free ? best_free_sample(samples, best, kernel) : best;
  }

  /// The end of more neighbours stays where it is, which nearly always costs least at a hub.
  /// Infinite cost elsewhere.
  Spectral_sample at_large_end(Spectral_collapse_kernel& kernel) const
  {
    if((!m_fields.is_hub(m_u) && !m_fields.is_hub(m_v)) ||
       m_options.placement == Spectral_placement_strategy::midpoint)
      return Spectral_sample();
    const bool more_at_u = m_fields.rings[m_u].size() >= m_fields.rings[m_v].size();
    const Fixed_ends fixed = fixed_ends();
    if(more_at_u ? fixed.v : fixed.u)
      return Spectral_sample();
    return at_weight(kernel, more_at_u ? 0. : 1.);
  }

  /// The cheapest of the ends and the middle, those that kept ends leave, of which `allowed(point)`
  /// is true, unless it costs more than `bound`.
  template <class Allowed>
  Spectral_sample best_on_edge(Spectral_collapse_kernel& kernel, const double bound,
                               const Allowed& allowed) const
  {
    const Fixed_ends fixed = fixed_ends();
    Spectral_sample samples[3];
    int count = 0;
    for(int s = 0; s < 3; ++s)
      if((!fixed.u || s == 0) && (!fixed.v || s == 2))
        samples[count++] = at_weight(kernel, s / 2.);
    for(; count > 0; --count) {
      Spectral_sample* const best = cheapest(samples, count);
      if(!std::isfinite(best->cost) || best->cost > bound)
        break;
      if(allowed(best->point))
        return *best;
      *best = samples[count - 1];
    }
    return Spectral_sample();
  }

private:
  // With its cost: the change of E and what the shape term adds.
  Spectral_sample evaluated(Spectral_collapse_kernel& kernel, Spectral_sample sample) const
  {
    kernel.evaluate(sample);
    if(sample.collapsible())
      sample.cost = (std::min)(sample.cost,
                               m_shape.largest_loss() * (m_fields.mass[m_u] + m_fields.mass[m_v])) +
                    m_shape.cost(m_fields.points, m_u, m_v, sample.point);
    return sample;
  }

  static Spectral_sample* cheapest(Spectral_sample* samples, const int count)
  {
    return std::min_element(samples, samples + count,
                            [](const auto& a, const auto& b) { return a.cost < b.cost; });
  }

  double rounded(const double alpha) const
  {
    if(m_fields.is_kept(m_u) || m_fields.is_kept(m_v))
      return m_fields.is_kept(m_u) ? 0. : 1.;
    if(m_fields.vanishes_at(m_u) != m_fields.vanishes_at(m_v))
      return m_fields.vanishes_at(m_u) ? 0. : 1.;
    if(!m_options.binary)
      return alpha;
    if(alpha != 0.5)
      return alpha < 0.5 ? 0. : 1.;
    if(m_fields.mass[m_u] != m_fields.mass[m_v])
      return m_fields.mass[m_u] > m_fields.mass[m_v] ? 0. : 1.;
    return m_u < m_v ? 0. : 1.;
  }

  Spectral_sample at_weight(Spectral_collapse_kernel& kernel, const double alpha) const
  {
    const Eigen::Vector3d &pu = m_fields.points[m_u], &pv = m_fields.points[m_v];
    const Eigen::Vector3d x = alpha == 0   ? pu
                              : alpha == 1 ? pv
                                           : Eigen::Vector3d((1 - alpha) * pu + alpha * pv);
    return evaluated(kernel, {as_stored(x), rounded(alpha)});
  }

  Eigen::Vector3d as_stored(const Eigen::Vector3d& point) const
  {
    return m_fields.single_precision ? point.cast<float>().cast<double>() : point;
  }

  // The sum of the normals around both ends, weighted by area.
  Eigen::Vector3d normal_at_edge() const
  {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for(const Spectral_slot c : {m_u, m_v})
      m_fields.rings.for_triangles(c, [&](const Spectral_slot a, const Spectral_slot b) {
        normal += (m_fields.points[a] - m_fields.points[c])
                      .cross(m_fields.points[b] - m_fields.points[c]);
      });
    return normal;
  }

  // The point of least shape term, no farther from the middle of the edge than its length. The ends
  // and the middle are tried as well: without them |C|_L was 1.08 times as large after relocation
  // (twelve meshes), also where only the edge that is selected was tried with all four.
  Eigen::Vector3d minimiser_of_shape() const
  {
    const Eigen::Vector3d &pu = m_fields.points[m_u], &pv = m_fields.points[m_v];
    const Eigen::Vector3d middle = (pu + pv) / 2, x = m_shape.minimiser(m_u, m_v);
    const double radius = (pv - pu).norm(), distance = (x - middle).norm();
    if(!x.allFinite())
      return middle;
    return distance > radius ? Eigen::Vector3d(middle + radius / distance * (x - middle)) : x;
  }

  // Appendix A, strategy (iii): the minimiser of a quadric through samples around the edge, unless
  // one of the samples or `best`, the one on the edge, is cheaper. `on_edge` are the three samples
  // of strategy (ii).
  Spectral_sample best_free_sample(const Spectral_sample* on_edge, Spectral_sample best,
                                   Spectral_collapse_kernel& kernel) const
  {
    using Quadric = Spectral_placement_quadric;
    Quadric quadric;
    if(!quadric.set_frame(m_fields.points[m_u], m_fields.points[m_v], normal_at_edge()))
      return best;
    constexpr int n = Quadric::number_of_samples, first = Quadric::number_on_edge;
    Spectral_sample samples[n];
    double costs[n];
    std::copy(on_edge, on_edge + first, samples);
    for(int i = first; i < n; ++i)
      samples[i] = at_point(kernel, quadric.point(i));
    for(int i = 0; i < n; ++i) {
      costs[i] = samples[i].cost;
      if(costs[i] < best.cost)
        best = samples[i];
    }
    const std::optional<Eigen::Vector3d> x = quadric.minimiser(costs);
    if(!x)
      return best;
    const Spectral_sample minimiser = at_point(kernel, *x);
    return minimiser.cost < best.cost ? minimiser : best;
  }

  struct Fixed_ends
  {
    bool u, v;
    bool on_border; // the whole edge is the border, which is to be preserved
  };

  // The ends that the merged vertex must lie on.
  Fixed_ends fixed_ends() const
  {
    Fixed_ends fixed{m_fields.is_kept(m_u), m_fields.is_kept(m_v), false};
    if(m_options.preserve_border) {
      // Functions go on to vanish where the border of a hole was, when it has closed.
      const bool border_u = m_fields.rings.is_border(m_u) || m_fields.vanishes_at(m_u),
                 border_v = m_fields.rings.is_border(m_v) || m_fields.vanishes_at(m_v);
      fixed.on_border = border_u && border_v;
      fixed.u = fixed.u || (border_u && !border_v);
      fixed.v = fixed.v || (border_v && !border_u);
    }
    return fixed;
  }

  const Spectral_fields& m_fields;
  const Spectral_options& m_options;
  const Spectral_shape_term& m_shape;
  Spectral_slot m_u, m_v;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_PLACEMENT_SEARCH_H
