// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_RELOCATION_OBJECTIVE_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_RELOCATION_OBJECTIVE_H

#include <CGAL/Spectral_geometry/internal/relocation/Distance_term.h>
#include <CGAL/Spectral_geometry/internal/relocation/Spectrum_term.h>
#include <CGAL/Spectral_geometry/internal/surface/Surface_regions.h>
#include <CGAL/Spectral_geometry/relocation_energy.h>

namespace CGAL::Spectral_geometry::internal {

/// Signals of the fine mesh, read off at the closest points of the coarse vertices. The rows of F
/// and Z that are read are copied once: on a large mesh they are few, and far apart in memory.
class Surface_signals : public Position_dependent_signals
{
public:
  /// F and Z: fine x K. All but the number of threads are kept by reference.
  Surface_signals(const Mesh_matrices& fine, Followed_closest_points& closest,
                  const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z, const int threads)
    : m_fine(fine)
    , m_closest(closest)
    , m_F(F)
    , m_Z(Z)
    , m_threads(threads)
    , m_rows(std::size_t(fine.V.rows()))
  {}

  void evaluate(const Positions& V, Rows& F, Rows& Z) override
  {
    F.resize(V.rows(), m_F.cols());
    Z.resize(V.rows(), m_F.cols());
    m_answers.resize(std::size_t(V.rows()));
    const auto find = [&](const Eigen::Index w) { m_answers[w] = m_closest(w, V.row(w)); };
    for_each_task(V.rows(), m_threads, find, 16);
    copy_new_rows();
    const auto read_off = [&](const Eigen::Index w) {
      const Eigen::Vector3d& weights = m_answers[w].weights;
      const auto t = corners(w);
      F.row(w) = weights(0) * f(t(0)) + weights(1) * f(t(1)) + weights(2) * f(t(2));
      Z.row(w) = weights(0) * z(t(0)) + weights(1) * z(t(1)) + weights(2) * z(t(2));
    };
    for_each_task(V.rows(), m_threads, read_off, 16);
  }

  // The signals are linear in the face. A closest point on an edge stays on it for a while, one in
  // a corner does not move at all.
  void add_gradient(const Rows& by_F, const Rows& by_Z, Positions& gradient) const override
  {
    const auto add = [&](const Eigen::Index w) {
      const Closest_point_query::Answer& a = m_answers[w];
      const auto t = corners(w);
      Eigen::Matrix3d p;
      for(int k = 0; k < 3; ++k)
        p.col(k) = m_fine.V.row(t(k));
      const Eigen::Vector3d normal = face_normal(m_fine.V, m_fine.T, a.face);
      const double size2 = normal.squaredNorm();
      Eigen::Index zero;
      a.weights.minCoeff(&zero);
      const Eigen::Index positive = (a.weights.array() > 0).count();
      if(positive == 1 || !(size2 > 0))
        return;
      Eigen::Vector3d g = Eigen::Vector3d::Zero();
      for(int k = 0; k < 3; ++k) {
        const double slope = by_F.row(w).dot(f(t(k))) + by_Z.row(w).dot(z(t(k)));
        g += slope / size2 * normal.cross(p.col((k + 2) % 3) - p.col((k + 1) % 3));
      }
      if(positive == 2) {
        const Eigen::Vector3d edge = (p.col((zero + 2) % 3) - p.col((zero + 1) % 3)).normalized();
        g = edge.dot(g) * edge;
      }
      gradient.row(w) += g.transpose();
    };
    for_each_task(gradient.rows(), m_threads, add, 16);
  }

private:
  // The corners of the face that the closest point of w lies in.
  Eigen::RowVector3i corners(const Eigen::Index w) const { return m_fine.T.row(m_answers[w].face); }

  using Row = Eigen::Map<const Eigen::RowVectorXd>;
  Row f(const int v) const { return {m_rows[v].data(), m_F.cols()}; }
  Row z(const int v) const { return {m_rows[v].data() + m_F.cols(), m_F.cols()}; }

  void copy_new_rows()
  {
    for(std::size_t w = 0; w < m_answers.size(); ++w)
      for(const int v : corners(Eigen::Index(w)))
        if(m_rows[v].size() == 0) {
          m_rows[v].resize(2 * m_F.cols());
          m_rows[v] << m_F.row(v), m_Z.row(v);
        }
  }

  const Mesh_matrices& m_fine;
  Followed_closest_points& m_closest;
  const Eigen::MatrixXd &m_F, &m_Z;
  int m_threads;
  std::vector<Closest_point_query::Answer> m_answers;
  std::vector<Eigen::RowVectorXd> m_rows; // of a fine vertex, once read: that of F, then of Z
};

/// Keeps area and volume between those of the coarse and of the fine mesh, up to a tolerance. The
/// penalty begins at half the tolerance and is steep enough to keep the change below the whole.
class Size_bounds
{
public:
  using Positions = Operator_geometry::Positions;

  Size_bounds(const Eigen::MatrixXi& T, const Positions& V, const Mesh_matrices& fine,
              const double tolerance)
    : m_T(T)
    , m_tolerance(tolerance)
    , m_closed(boundary_edges(T).empty() && boundary_edges(fine.T).empty())
  {
    const auto [area, volume] = measure(m_T, V);
    const auto [fine_area, fine_volume] = measure(fine.T, fine.V);
    m_fine_area = fine_area;
    m_area = range(area, fine_area);
    m_volume = range(volume, fine_volume);
    // A mesh without volume to speak of (two sheets, say) cannot keep a part of it.
    m_closed = m_closed && std::abs(volume) > 1e-3 * area * std::sqrt(area) / 10.6;
  }

  /// The area of the coarse mesh at the start.
  double area() const { return m_area.from; }

  /// Returns the areas of the coarse mesh with these positions, and of the fine one.
  std::pair<double, double> areas(const Positions& V) const
  {
    return {measure(m_T, V).first, m_fine_area};
  }

  bool within(const Positions& V) const
  {
    const auto [area, volume] = measure(m_T, V);
    return std::abs(m_area.beyond(area)) <= m_tolerance &&
           (!m_closed || std::abs(m_volume.beyond(volume)) <= m_tolerance);
  }

  /// The value, scaled by `weight`, the objective at the start; adds its gradient.
  double penalty(const Positions& V, const double weight, Positions& gradient) const
  {
    const auto [area, volume] = measure(m_T, V);
    const double by_area = slope(m_area.beyond(area)),
                 by_volume = m_closed ? slope(m_volume.beyond(volume)) : 0;
    if(by_area == 0 && by_volume == 0)
      return 0;
    for(Eigen::Index f = 0; f < m_T.rows(); ++f) {
      const Eigen::Vector3d unit = face_normal(V, m_T, f).normalized();
      for(int k = 0; k < 3; ++k) {
        const Eigen::Vector3d q = V.row(m_T(f, (k + 1) % 3)), r = V.row(m_T(f, (k + 2) % 3));
        const Eigen::Vector3d g = by_area / m_area.from / 2 * unit.cross(r - q) +
                                  by_volume / (m_closed ? m_volume.from : 1.) / 6 * q.cross(r);
        gradient.row(m_T(f, k)) += weight * g.transpose();
      }
    }
    // slope = 2 steepness h, the penalty is steepness h^2
    return weight * (by_area * by_area + by_volume * by_volume) / (4 * steepness());
  }

private:
  // The value of the coarse mesh at the start; relative changes from there to the fine mesh.
  struct Range
  {
    double from, low, high;

    double beyond(const double value) const
    {
      const double change = value / from - 1;
      return change > high ? change - high : change < low ? change - low : 0.;
    }
  };

  // If the meshes are far apart (a few vertices, or an offset), the coarse mesh need not reach the
  // value of the fine one.
  static Range range(const double coarse, const double fine)
  {
    const double change = std::clamp(fine / coarse - 1, -0.1, 0.1);
    return {coarse, (std::min)(change, 0.), (std::max)(change, 0.)};
  }

  // Area and volume.
  template <class Points>
  static std::pair<double, double> measure(const Eigen::MatrixXi& T, const Points& V)
  {
    double area = 0, volume = 0;
    const Eigen::Vector3d origin = V.row(0);
    for(Eigen::Index f = 0; f < T.rows(); ++f) {
      const Eigen::Vector3d p = V.row(T(f, 0)).transpose() - origin,
                            q = V.row(T(f, 1)).transpose() - origin,
                            r = V.row(T(f, 2)).transpose() - origin;
      area += (q - p).cross(r - p).norm() / 2;
      volume += p.dot(q.cross(r)) / 6;
    }
    return {area, volume};
  }

  // At nine tenths of the tolerance it costs as much as all there was at the start.
  double steepness() const { return 1 / (0.16 * m_tolerance * m_tolerance); }

  double slope(const double beyond) const
  {
    const double excess = std::abs(beyond) - m_tolerance / 2;
    return excess <= 0 ? 0 : 2 * steepness() * (beyond > 0 ? excess : -excess);
  }

  Eigen::MatrixXi m_T;
  double m_tolerance, m_fine_area = 0;
  bool m_closed;
  Range m_area, m_volume;
};

/// What the descent sees: S, and the penalties on size, spectrum and distance.
class Relocation_objective
{
public:
  using Positions = Operator_geometry::Positions;

  /// F and Z: the signals that P carries, whether S sees them (`carried`) or not; `sampled`: others
  /// that it sees, or null; `fine_modes` as of `Spectrum_term`.
  Relocation_objective(const Eigen::MatrixXi& T, const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z,
                       const Local_operator& op, const Size_bounds& size, const Positions& start,
                       Position_dependent_signals* sampled, const bool carried, const double tau,
                       const Spectrum_term::Fine_modes& fine_modes,
                       const Relocation_options& options, const Relocation_limits& limits)
    : m_E(T, F, Z, op)
    , m_S(T, F.leftCols(carried ? F.cols() : 0), Z.leftCols(carried ? F.cols() : 0), op, tau,
          tau > 0 ? 0. : 1., sampled)
    , m_size(size)
    , m_spectrum(T, start, op, options.modes == 0 ? F.cols() : options.modes, options.eigenvalues,
                 fine_modes, limits, options)
    , m_threads(options.threads)
  {
    m_S.set_threads(options.threads);
    m_scale = m_S.value(start);
    if(tau > 0 && m_S.energy_part() > 0) {
      m_S.set_mu(weight_of_energy * m_S.smoothed_part() / m_S.energy_part());
      m_scale = m_S.value(start);
    }
  }

  /// Lets inner products of the sampled signals come near those of the fine mesh, where F has them.
  void keep_inner_products(const Eigen::VectorXd& mass, const Eigen::MatrixXd& F,
                           const Eigen::MatrixXd& Z)
  {
    const double error = has_goals() ? inner_product_error : inner_product_error_without_goals;
    m_S.keep_inner_products(mass, F, Z, m_scale / (error * error));
  }

  /// Lets the surfaces come near each other; `distance` is kept.
  void keep_near(Distance_term& distance) { m_distance = &distance; }

  /// Brings what changes slowly up to date; true if that changes the values.
  bool refresh(const Positions& V)
  {
    m_spectrum.refresh(V);
    const bool distances = m_distance != nullptr && m_distance->refresh(V);
    return m_spectrum.is_active() || distances;
  }

  /// Whether values change that `refresh()` should follow closely.
  bool has_goals() const { return m_spectrum.has_goals(); }

  double E(const Positions& V) { return m_E.value(V); }

  double value_and_gradient(const Positions& V, Positions& gradient)
  {
    Positions by_spectrum = Positions::Zero(V.rows(), 3);
    double value = 0, spectrum = 0;
    // S starts threads as well; the term of the spectrum keeps a further one for a fifth of the
    // time.
    for_each_task(2, m_spectrum.is_active() ? m_threads : 1, [&](const int part) {
      if(part == 0)
        value = m_S.value_and_gradient(V, gradient);
      else
        spectrum = m_spectrum.penalty(V, m_scale, by_spectrum);
    });
    if(!std::isfinite(value))
      return value;
    gradient += by_spectrum;
    if(m_distance != nullptr)
      value += m_distance->penalty(V, m_scale, gradient);
    return value + spectrum + m_size.penalty(V, m_scale, gradient);
  }

private:
  // A difference of this size, relative to the sum of squares, costs as much as all at the start.
  // With 0.015 biharmonic distances are 1.02 times as far off (nine meshes). Filtered noise has no
  // goals for eigenvalues: there |C|_L with 0.015 is 1.06 times that with 0.022 (seventeen).
  static constexpr double inner_product_error = 0.013, inner_product_error_without_goals = 0.022;

  Relocation_energy m_E, m_S; // E alone; what is minimised
  Size_bounds m_size;
  Spectrum_term m_spectrum;
  Distance_term* m_distance = nullptr;
  int m_threads;
  double m_scale = 1;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_RELOCATION_OBJECTIVE_H
