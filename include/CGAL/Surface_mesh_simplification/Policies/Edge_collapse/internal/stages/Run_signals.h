// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_RUN_SIGNALS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_RUN_SIGNALS_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>

#include <CGAL/Spectral_geometry/filtered_signals.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <utility>

namespace CGAL::Surface_mesh_simplification::internal {

/// F and Z of a run at the scale of its input, for what follows the collapses: eigenvectors,
/// filtered noise or signals of the user's. `options` may weigh them otherwise than the collapses
/// did.
template <class State>
class Run_signals
{
public:
  using Signals = std::pair<Eigen::MatrixXd, Eigen::MatrixXd>;

  Run_signals(const State& state, const Spectral_options& options)
    : m_state(state)
    , m_options(options)
  {}

  /// F.
  const Eigen::MatrixXd& given() const
  {
    return m_options.signals.size() != 0           ? m_options.signals
           : m_state.filtered_signals() != nullptr ? m_state.filtered_signals()->F
                                                   : m_state.eigenpairs()->vectors;
  }

  /// One for each column of F.
  Eigen::VectorXd weights() const { return spectral_weights(m_options, given().cols()); }

  /// K, also where F holds mixtures of the first K eigenvectors.
  Eigen::Index modes() const
  {
    return m_state.filtered_signals() != nullptr ? m_options.number_of_eigenvectors
                                                 : given().cols();
  }

  /// What the relocation sees: with 64 mixtures it takes 0.85 times as long as with all of 100
  /// eigenvectors, and |C|_L is 0.97 times as large.
  Signals for_relocation() const
  {
    if(const Spectral_geometry::Filtered_signals* const filtered = m_state.filtered_signals())
      return {filtered->F, filtered->Z};
    Spectral_options options;
    options.number_of_mixtures = 2 * m_options.number_of_mixtures;
    options.seed = m_options.seed + 1; // others than those of the collapses
    return mixed(mixing_matrix(options, weights()));
  }

  /// All signals but constants, restricted, each multiplied by the root of its weight.
  Signals restricted(const Eigen::SparseMatrix<double>& P) const
  {
    if(const Spectral_geometry::Filtered_signals* const filtered = m_state.filtered_signals())
      return {P * filtered->F, P * filtered->Z};
    Eigen::MatrixXd R = weights().cwiseSqrt().asDiagonal();
    R.leftCols(m_state.number_of_constants()).setZero();
    Eigen::MatrixXd PF = P * given() * R;
    Eigen::MatrixXd PZ = m_state.has_rough_basis()
                             ? Eigen::MatrixXd(P * mixed(R).second)
                             : Eigen::MatrixXd(PF * m_state.eigenpairs()->values.asDiagonal());
    return {std::move(PF), std::move(PZ)};
  }

  /// || Z ||_B^2 of all of them, for the input scaled to unit area.
  double sum_of_squares() const
  {
    if(!m_state.eigenpairs())
      return m_state.sum_of_squares();
    const double area = m_state.area();
    return area * area * weights().dot(m_state.eigenpairs()->values.cwiseAbs2());
  }

private:
  // F R and Z R, for mixtures or weights R.
  Signals mixed(const Eigen::MatrixXd& R) const
  {
    Eigen::MatrixXd F = given() * R;
    Eigen::MatrixXd Z =
        m_state.has_rough_basis()
            ? spectral_z(operator_of_basis(m_state.fine().V, m_state.fine().T, m_options), F)
            : Eigen::MatrixXd(given() * (m_state.eigenpairs()->values.asDiagonal() * R));
    return {std::move(F), std::move(Z)};
  }

  const State& m_state;
  const Spectral_options& m_options;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_RUN_SIGNALS_H
