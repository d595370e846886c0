// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_GUARDED_DESCENT_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_GUARDED_DESCENT_H

#include <CGAL/Spectral_geometry/internal/basics.h>

#include <deque>
#include <utility>

namespace CGAL::Spectral_geometry::internal {

/*!
L-BFGS (Nocedal and Wright, algorithm 7.5) over the positions of all vertices, with guards that cut
the steps of single vertices: where the full step would break a triangle or leave the ball of a
vertex, that vertex alone moves less and the others go on. A step of the whole that no longer
descends is halved.

`Objective`: `double value_and_gradient(const Positions&, Positions& gradient)`.
`Guards`: `void tangential(const Positions& at, Positions& direction)` removes the forbidden part of
a direction or gradient; `void admit(const Positions& from, Positions& to)` makes `to` legal if
`from` is legal.
*/
template <class Objective, class Guards>
class Guarded_descent
{
public:
  using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

  Guarded_descent(Objective& objective, Guards& guards, const double first_step)
    : m_objective(objective)
    , m_guards(guards)
    , m_first_step(first_step)
  {}

  /// starts at legal positions.
  void start(const Positions& V)
  {
    m_history.clear();
    go_on_from(V);
  }

  /// goes on where some vertices were put back. Pairs keep their rows of the others, which is about
  /// what is known of the curvature there.
  void go_on_from(Positions V)
  {
    m_V.swap(V);
    refresh();
    for(Pair& pair : std::exchange(m_history, {})) {
      for(Eigen::Index v = 0; v < V.rows(); ++v)
        if(m_V.row(v) != V.row(v)) {
          pair.s.row(v).setZero();
          pair.y.row(v).setZero();
        }
      remember(pair.s, pair.y);
    }
    if(m_history.empty())
      set_scales();
  }

  /// takes value and gradient anew; the objective has changed a little.
  void refresh()
  {
    m_value = m_objective.value_and_gradient(m_V, m_gradient);
    m_guards.tangential(m_V, m_gradient);
  }

  const Positions& positions() const { return m_V; }
  double value() const { return m_value; }

  /// one step; false if none that descends was found, not even with the curvature levelled.
  bool step()
  {
    if(try_direction())
      return true;
    if(!m_history.empty()) { // once more along the gradient
      m_history.clear();
      set_scales();
      if(try_direction())
        return true;
    }
    level_curvature();
    return try_direction();
  }

private:
  // With 12, and none kept where vertices are put back, 70 steps came as far as 50 do.
  static constexpr std::size_t memory = 24;

  struct Pair
  {
    Positions s, y;
    double rho;
  };

  static double dot(const Positions& a, const Positions& b) { return a.cwiseProduct(b).sum(); }

  // The gradient at the vertices of a needle exceeds all others by orders of magnitude and would
  // alone determine the direction. The initial inverse Hessian levels gradients: their lengths are
  // then below 1, one half at the median.
  void set_scales()
  {
    if(m_levelled)
      return;
    const Eigen::VectorXd lengths = m_gradient.rowwise().norm();
    m_scales = (lengths.array() + median_of_positive(lengths)).inverse();
  }

  // From now on a vertex moves the less, the faster its gradient changes along a short step. At
  // needles it changes too fast for any common step. Forgets the history.
  void level_curvature()
  {
    m_levelled = true;
    m_history.clear();
    Positions V = m_V + 1e-4 * direction(), gradient;
    m_guards.admit(m_V, V);
    m_objective.value_and_gradient(V, gradient);
    m_guards.tangential(V, gradient);
    const Eigen::VectorXd s = (V - m_V).rowwise().norm();
    const Eigen::VectorXd curvature =
        (s.array() > 0).select((gradient - m_gradient).rowwise().norm().cwiseQuotient(s), 0.);
    m_scales = (curvature.array() + median_of_positive(curvature)).inverse();
    m_scales /= 2 * median_of_positive(m_scales.cwiseProduct(m_gradient.rowwise().norm()));
  }

  // The median of the positive and finite ones; 1 if there are none.
  static double median_of_positive(const Eigen::VectorXd& lengths)
  {
    Eigen::VectorXd positive(lengths.size());
    Eigen::Index count = 0;
    for(const double l : lengths)
      if(l > 0 && std::isfinite(l))
        positive[count++] = l;
    return count == 0 ? 1 : median(positive.head(count));
  }

  Positions scaled(const Positions& d) const { return m_scales.asDiagonal() * d; }

  Positions direction() const
  {
    Positions d = -m_gradient;
    if(m_history.empty())
      return m_first_step * scaled(d);
    std::vector<double> a(m_history.size());
    for(std::size_t i = m_history.size(); i-- > 0;) {
      a[i] = m_history[i].rho * dot(m_history[i].s, d);
      d -= a[i] * m_history[i].y;
    }
    const Pair& last = m_history.back();
    d = (1 / (last.rho * dot(last.y, scaled(last.y))) * scaled(d)).eval();
    for(std::size_t i = 0; i < m_history.size(); ++i)
      d += (a[i] - m_history[i].rho * dot(m_history[i].y, d)) * m_history[i].s;
    return d;
  }

  bool try_direction()
  {
    Positions d = direction();
    m_guards.tangential(m_V, d);
    double t = 1;
    for(int halvings = 0; halvings < 12; ++halvings, t /= 2) {
      Positions V = m_V + t * d;
      m_guards.admit(m_V, V);
      const Positions s = V - m_V;
      const double slope = dot(m_gradient, s);
      if(!(slope < 0))
        continue;
      Positions gradient;
      const double value = m_objective.value_and_gradient(V, gradient);
      if(!(value <= m_value + 1e-4 * slope))
        continue;
      m_guards.tangential(V, gradient);
      remember(s, gradient - m_gradient);
      m_V = V;
      m_gradient = gradient;
      m_value = value;
      return true;
    }
    return false;
  }

  void remember(const Positions& s, const Positions& y)
  {
    const double sy = dot(s, y);
    if(!(sy > 1e-12 * s.norm() * y.norm()))
      return;
    m_history.push_back({s, y, 1 / sy});
    if(m_history.size() > memory)
      m_history.pop_front();
  }

  Objective& m_objective;
  Guards& m_guards;
  double m_first_step;
  Positions m_V, m_gradient;
  Eigen::VectorXd m_scales;
  double m_value = 0;
  bool m_levelled = false; // whether the scales are of the curvature
  std::deque<Pair> m_history;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_GUARDED_DESCENT_H
