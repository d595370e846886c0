// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_SPECTRUM_TERM_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_SPECTRUM_TERM_H

#include <CGAL/Spectral_geometry/Relocation_options.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/numerics/for_each_task.h>
#include <CGAL/Spectral_geometry/internal/relocation/Low_mode_term.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>

namespace CGAL::Spectral_geometry::internal {

/*!
What the descent is told of coarse eigenvalues \f$ \widetilde\lambda_k \f$, all at unit area.

With eigenvalues of the fine mesh, the weighted mean square of their relative errors \f$ e_k =
\widetilde\lambda_k / \lambda_k - 1 \f$
\f[ \frac{1}{\epsilon^2} \sum_{k \le K} w_k e_k^2 \Big/ \sum_{k \le K} w_k, \qquad
   w_k = 1 + 50 \lambda_2 / \lambda_k. \f]
E weighs mode k by \f$ \lambda_k^2 \f$ and leaves low modes to chance. The number of modes is at
most a sixth of that of vertices: linear elements hardly represent the others. With more than ten
vertices per mode (of K) errors are smaller, and epsilon falls as \f$ (10 K / N)^{2/3} \f$.

The modes after these, up to 1.5 K, would fall, see `relocate_positions()`. They are too low
already: with the averaged mass the leading error of the elements is \f$ -x^2 / 461 \f$ of the
eigenvalue, see `commutativity_floor()`. Their mean should rise to that of the fine mesh if some of
its eigenvalues there are known; otherwise it should not fall.

Between two calls of `refresh()` the eigenvectors are fixed and eigenvalues are their Rayleigh
quotients. These are right to first order in the movement; their sum over all modes up to the last
is never too low. Within a cluster the eigenvectors may rotate; only the sum of its eigenvalues is
smooth. Nothing else matters here, since they have nearly one goal.
*/
class Spectrum_term
{
public:
  using Positions = Operator_geometry::Positions;
  using Index = Eigen::Index;
  using Row = Low_mode_term::Row;
  /// Returns the first eigenvectors of the fine mesh, as many or fewer, at coarse vertices.
  using Fine_modes = std::function<Eigen::MatrixXd(const Positions&, Index)>;

  /// `modes`: K; `eigenvalues`: of the fine mesh at unit area, or none; `fine_modes`: or empty.
  /// Without modes, or where a vertex has no face, it does nothing.
  Spectrum_term(const Eigen::MatrixXi& T, const Positions& V, const Local_operator& op,
                const Index modes, const Eigen::VectorXd& eigenvalues, Fine_modes fine_modes,
                const Relocation_limits& limits, const Run_control& control = {})
    : m_T(T)
    , m_geometry(T, V.rows(), op)
    , m_modes(V.rows() - 1)
    , m_first(modes)
    , m_error(limits.eigenvalue_error)
    , m_fine_modes(std::move(fine_modes))
    , m_threads(control.threads)
    , m_cancel(control.cancel)
  {
    bool all_have_faces = true;
    for(Index v = 0; v < V.rows(); ++v) {
      m_modes -= m_geometry.vanishes_at(v); // where functions vanish there is no mode
      all_have_faces = all_have_faces && !m_geometry.row(v).empty();
    }
    // Zero has no relative error, and does not fall.
    if(all_have_faces)
      m_first = (std::max)(modes, number_of_zero_eigenvalues(laplace_operator(V, T, op)));
    m_last = m_first + Index(limits.beyond * double(modes));
    const Index known = (std::min)(eigenvalues.size(), m_modes / 4),
                goals = (std::min)({known, modes, m_modes / 6});
    if(goals > 0 && m_error > 0) {
      Eigen::VectorXd sorted = eigenvalues;
      std::sort(sorted.data(), sorted.data() + sorted.size());
      m_error *= std::pow((std::min)(1., finer * double(modes) / double(V.rows())), 2. / 3);
      if(set_goals(sorted.head(goals)))
        m_after_goals = sorted.segment(goals, known - goals).transpose().array();
    }
    m_last = (std::max)(m_last, m_first + m_goals.size());
    m_last = all_have_faces ? (std::min)(m_last, m_modes) : m_first;
    refresh(V);
  }

  bool is_active() const { return m_last > m_first; }

  /// Whether eigenvalues of the fine mesh are among what it knows.
  bool has_goals() const { return is_active() && m_goals.size() != 0; }

  /// Updates the eigenvectors to the current mesh, by a step of inverse iteration on all of them.
  void refresh(const Positions& V)
  {
    if(!is_active())
      return;
    const Laplace_operator op = laplace_operator(V, m_T, m_geometry.local_operator());
    if(m_vectors.size() == 0 || !iterate(op))
      find(op);
    m_phi = m_vectors.middleCols(m_first, m_last - m_first);
    if(!has_goals() || !m_fine_modes)
      return;
    const Index wanted = (std::min)(m_goals.size(), Low_mode_term::largest_number);
    const Eigen::MatrixXd fine = m_fine_modes(V, m_first + wanted);
    const Index m = (std::max)(fine.cols() - m_first, Index(0)),
                coarse = (std::min)(m + Low_mode_term::spare, m_vectors.cols() - m_first);
    if(m > 1)
      m_low_modes.refresh(op, m_vectors.middleCols(m_first, coarse), fine.rightCols(m), m_goals);
  }

  /// The relative errors of the eigenvalues that have a goal, then the relative changes of the
  /// others since the start.
  Row changes(const Positions& V)
  {
    if(!is_active() || !m_geometry.assemble(V, m_entries))
      return Row();
    m_stiffness.setZero(m_phi.cols());
    m_norm.setZero(m_phi.cols());
    for(Index v = 0; v < m_phi.rows(); ++v)
      m_norm += m_entries.B_diagonal(v) * m_phi.row(v).square();
    for(std::size_t e = 0; e < m_geometry.edges().size(); ++e) {
      const auto [i, j] = m_geometry.edges()[e];
      m_stiffness -= m_entries.L(Index(e)) * (m_phi.row(i) - m_phi.row(j)).square();
      m_norm += 2 * m_entries.B(Index(e)) * m_phi.row(i) * m_phi.row(j);
    }
    return m_entries.mass.sum() * m_stiffness / (m_norm * m_reference) - 1;
  }

  /// The value, scaled by `weight`, the objective at the start; adds its gradient.
  double penalty(const Positions& V, const double weight, Positions& gradient)
  {
    const Row change = changes(V);
    if(change.size() == 0)
      return 0;
    const Index matched = m_goals.size(), others = change.size() - matched;
    const Row goal_slope = weight / (m_error * m_error) * m_weights * change.head(matched);
    Row slope = Row::Zero(change.size());
    slope.head(matched) = 2 * goal_slope;
    double result = (goal_slope * change.head(matched)).sum();
    const double missing = others == 0 ? 0. : m_aim - change.tail(others).mean();
    const double width = std::clamp(2 * m_aim, 0.01, largest_width);
    if(missing > 0) {
      slope.tail(others).setConstant(-2 * weight * missing / (width * width) / double(others));
      result += weight * missing * missing / (width * width);
    }
    if(matched != 0 || missing > 0) {
      Operator_geometry::Entries derivatives = derivatives_of_changes(slope);
      result +=
          m_low_modes.penalty(m_geometry, m_entries, weight / (m_error * m_error), derivatives);
      m_geometry.add_gradient(derivatives, V, gradient);
    }
    return result;
  }

private:
  // A mean that misses its aim by the width costs as much as all does at the start: twice the aim,
  // from 0.01 to this, so that large errors are lowered and small ones do not grow. With three
  // times the aim errors from K to 1.5 K are 1.14 times as large, those of low modes 0.96 times.
  static constexpr double largest_width = 0.1;

  // It is above zero, so that eigenvectors that are not up to date do no harm.
  static constexpr double smallest_aim = 0.002;

  // Modes beyond the last that are followed as well: the iteration turns the last ones least.
  static constexpr Index spare = 16;

  // Where low modes weigh 1 and not 51 their errors are 1.3 times as large, |C|_L the same.
  static constexpr double low = 50;

  // Vertices for each of the K modes from which on epsilon falls. With 40 for each, errors of
  // eigenvalues are half of what they are without it, and |C|_L is 1.02 times as large (ten
  // meshes); with the consistent mass 0.48 and 0.90 times. The power 1 gains no more.
  static constexpr double finer = 10;

  // The columns of one task. No result depends on the number of threads.
  static constexpr Index columns_at_once = 16;

  // False where there are but zeros.
  bool set_goals(const Eigen::VectorXd& values)
  {
    Index zeros = 0;
    while(zeros < values.size() && !(values[zeros] > 1e-9 * values[values.size() - 1]))
      ++zeros;
    if(zeros >= values.size())
      return false;
    m_first = zeros;
    m_goals = values.tail(values.size() - zeros).transpose().array();
    m_weights = 1 + low * m_goals[0] / m_goals;
    m_weights /= m_weights.sum();
    return true;
  }

  void find(const Laplace_operator& op)
  {
    Eigenpairs_options options = Eigenpairs_options::with_tolerance(1e-3);
    options.verify = false;
    options.threads = m_threads;
    options.cancel = m_cancel;
    const Eigenpairs pairs = eigenpairs(op, (std::min)(m_last + spare, m_modes), options);
    m_vectors = pairs.vectors;
    if(m_reference.size() == 0) { // it stays that of the start
      m_reference = op.mass.sum() * pairs.values.segment(m_first, m_last - m_first).array();
      m_reference.head(m_goals.size()) = m_goals;
      if(const Index n = (std::min)(m_after_goals.size(), m_reference.size() - m_goals.size());
         n > 0)
        m_aim = (std::max)(
            smallest_aim,
            m_after_goals.head(n).mean() / m_reference.segment(m_goals.size(), n).mean() - 1);
    }
  }

  // X = (L + s B)^-1 B Phi, then Rayleigh-Ritz in its span, columns on several threads. False
  // where rounding leaves one of the two without a factor.
  bool iterate(const Laplace_operator& op)
  {
    const double shift =
        4 * CGAL_PI / op.mass.sum() * mean_conductivity(m_geometry.local_operator().coefficients);
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky(op.L + shift * op.B);
    if(cholesky.info() != Eigen::Success)
      return false;
    const Index count = m_vectors.cols();
    Eigen::MatrixXd X(m_vectors.rows(), count), stiffness(count, count), mass(count, count);
    for_each_range(count, columns_at_once, m_threads, [&](const Index first, const Index end) {
      auto x = X.middleCols(first, end - first);
      x = cholesky.solve(op.B * m_vectors.middleCols(first, end - first));
      for(Index k = 0; k < x.cols(); ++k) { // their lengths are near 1 / (lambda + s)
        const Eigen::VectorXd Bx = op.B * x.col(k);
        x.col(k) /= std::sqrt(x.col(k).dot(Bx));
      }
    });
    // The solver reads lower triangles alone.
    for_each_range(count, columns_at_once, m_threads, [&](const Index first, const Index end) {
      const auto x = X.middleCols(first, end - first), below = X.rightCols(count - first);
      stiffness.block(first, first, count - first, end - first).noalias() =
          below.transpose() * (op.L * x);
      mass.block(first, first, count - first, end - first).noalias() =
          below.transpose() * (op.B * x);
    });
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(stiffness, mass);
    if(ritz.info() != Eigen::Success)
      return false;
    for_each_range(count, columns_at_once, m_threads, [&](const Index first, const Index end) {
      m_vectors.middleCols(first, end - first).noalias() =
          X * ritz.eigenvectors().middleCols(first, end - first);
    });
    return true;
  }

  // The derivatives of sum_i slope_i A q_i / reference_i by the entries, q_i = stiffness_i /
  // norm_i, at the positions of the last changes().
  Operator_geometry::Entries derivatives_of_changes(const Row& slope) const
  {
    Operator_geometry::Entries d = m_geometry.zero_entries();
    const Row quotient = m_stiffness / m_norm;
    d.mass.setConstant((slope * quotient / m_reference).sum());
    const Row by_stiffness = slope * m_entries.mass.sum() / (m_reference * m_norm);
    const Row by_norm = -by_stiffness * quotient;
    for(Index v = 0; v < m_phi.rows(); ++v)
      d.B_diagonal(v) = (by_norm * m_phi.row(v).square()).sum();
    for(std::size_t e = 0; e < m_geometry.edges().size(); ++e) {
      const auto [i, j] = m_geometry.edges()[e];
      d.L(Index(e)) = -(by_stiffness * (m_phi.row(i) - m_phi.row(j)).square()).sum();
      d.B(Index(e)) = 2 * (by_norm * m_phi.row(i) * m_phi.row(j)).sum();
    }
    return d;
  }

  Eigen::MatrixXi m_T;
  Operator_geometry m_geometry;
  Operator_geometry::Entries m_entries;
  Index m_modes;         // that the coarse mesh has
  Index m_first, m_last; // the modes that are looked at; those with goals come first
  double m_error;
  Fine_modes m_fine_modes;
  int m_threads;
  const std::atomic<bool>* m_cancel;
  Low_mode_term m_low_modes;
  Row m_goals, m_weights; // at unit area; empty: none
  Row m_after_goals;      // eigenvalues that follow, as far as they are known
  double m_aim = smallest_aim;
  Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> m_phi;
  Eigen::MatrixXd m_vectors; // all modes to the last and the spare ones
  Row m_reference, m_stiffness, m_norm;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_SPECTRUM_TERM_H
