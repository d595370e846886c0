// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_SPECTRAL_POST_PROCESS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_SPECTRAL_POST_PROCESS_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/stages/Spectral_pre_simplification.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_result.h>
#include <CGAL/Surface_mesh_simplification/spectral_relocation.h>

#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Spectral_geometry/Cancelled.h>
#include <CGAL/Spectral_geometry/functional_map.h>

#include <CGAL/Real_timer.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace CGAL::Surface_mesh_simplification::internal {

/// What follows the collapses: `Spectral_edge_collapse_options::relocate`, and the error of what is
/// left. The log, and what is replayed from it, stay as they are: they end before.
template <class TriangleMesh, class Policies, class NamedParameters>
class Spectral_post_process
{
  using Result = Spectral_edge_collapse_result;
  using SpMat = Eigen::SparseMatrix<double>;

public:
  Spectral_post_process(TriangleMesh& mesh, const Policies& policies,
                        const Spectral_edge_collapse_options& options, const NamedParameters& np,
                        Result& result)
    : m_mesh(mesh)
    , m_state(policies.state())
    , m_options(options)
    , m_np(np)
    , m_result(result)
    , m_P(policies.restriction())
  {}

  void run(const Pre_simplification& first)
  {
    set_error(m_P);
    if(!m_options.relocate || m_result.stop_reason == Result::Stop_reason::cancelled)
      return;
    Spectral_geometry::Relocation_result& relocation = m_result.relocation;
    if(has_operator_and_areas())
      relocate();
    m_result.seconds_relocation = relocation.seconds;
    if(m_result.relative_error > m_options.maximum_error &&
       m_result.stop_reason != Result::Stop_reason::cancelled)
      m_result.warnings.push_back(
          "The collapses kept the error bound, but with relocation the relative error is " +
          std::to_string(m_result.relative_error) + "; set relocate to false to keep it.");
    // Carried signals keep P as it is; sampled ones bring their own, from the mesh of the
    // eigenpairs.
    if(relocation.resampled)
      m_result.restriction =
          first.done ? SpMat(relocation.restriction * first.log.forest().restriction(first.slots))
                     : relocation.restriction;
    relocation.restriction.resize(0, 0);
  }

private:
  std::function<bool(double)> reporting(const Spectral_phase phase) const
  {
    return [this, phase](const double fraction) { return m_state.report(phase, fraction); };
  }

  Spectral_geometry::Mesh_matrices coarse() const
  {
    return Spectral_geometry::mesh_matrices(m_mesh, m_np);
  }

  // With the coefficients that the collapses have merged.
  Spectral_geometry::Local_operator local_operator() const
  {
    return {m_options.mass, m_result.coefficients, m_options.boundary};
  }

  // The operator of the mesh as it is now.
  Spectral_geometry::Laplace_operator coarse_operator() const
  {
    const Spectral_geometry::Mesh_matrices mesh = coarse();
    return Spectral_geometry::laplace_operator(mesh.V, mesh.T, local_operator());
  }

  // Whether the mesh that is left has an operator, and each face an area; warns where it has not.
  // The collapses are done: to throw would lose them.
  bool has_operator_and_areas()
  {
    using namespace Spectral_geometry;
    const Mesh_matrices mesh = coarse();
    try {
      laplace_operator(mesh.V, mesh.T, local_operator());
      Spectral_geometry::internal::check_areas("", "simplified", mesh.V, mesh.T);
    } catch(const std::invalid_argument& error) {
      m_result.warnings.push_back("The vertices were not relocated: " + std::string(error.what()));
      return false;
    }
    return true;
  }

  void relocate()
  {
    const auto [F, Z] = signals_for_relocation();
    if(m_options.mass != Spectral_geometry::Mass::averaged)
      m_result.warnings.push_back(
          "Relocation is made for the averaged mass: in a lumped one it bends the shape "
          "to cancel the error of the elements.");
    Spectral_geometry::Relocation_options relocation = m_options.relocation;
    relocation.modes = m_state.filtered_signals() != nullptr ? m_options.number_of_eigenvectors
                                                             : given_signals().cols();
    relocation.progress = reporting(Spectral_phase::relocation);
    relocation.threads = (std::max)(relocation.threads, m_options.threads);
    std::vector<bool> stays;
    if(!m_state.core().fields().kept.empty())
      for(const Eigen::Index slot : m_state.current_slots())
        stays.push_back(m_state.core().fields().is_kept(Spectral_slot(slot)));
    try {
      m_result.relocation = relocate_mesh(m_mesh, m_P, m_state.fine(), F, Z, local_operator(),
                                          relocation, stays, m_np);
    } catch(const Spectral_geometry::Cancelled&) {
      set_cancelled(m_result, ", which are as the collapses left them");
      return;
    }
    SpMat& own = m_result.relocation.restriction;
    if(m_result.relocation.resampled &&
       !stays.empty()) // where the input has several points in one place
      keep_rows(own, stays);
    // A vertex of the border whose closest point is an inner one goes on having 0.
    if(m_result.relocation.resampled &&
       m_options.boundary == Spectral_geometry::Boundary_condition::dirichlet)
      keep_rows(own, Spectral_geometry::internal::border_vertices(coarse().T, m_P.rows()));
    set_error(own);
  }

  // What the collapses have left in the rows that are flagged.
  template <class Flags>
  void keep_rows(SpMat& own, const Flags& kept) const
  {
    SpMat carried = m_P;
    carried.prune(
        [&](const Eigen::Index row, Eigen::Index, double) { return bool(kept[std::size_t(row)]); });
    own.prune(
        [&](const Eigen::Index row, Eigen::Index, double) { return !kept[std::size_t(row)]; });
    own += carried;
  }

  using Signals = std::pair<Eigen::MatrixXd, Eigen::MatrixXd>;

  const Eigen::MatrixXd& given_signals() const
  {
    return m_options.signals.size() != 0           ? m_options.signals
           : m_state.filtered_signals() != nullptr ? m_state.filtered_signals()->F
                                                   : m_result.eigenpairs->vectors;
  }

  Eigen::VectorXd weights() const { return spectral_weights(m_options, given_signals().cols()); }

  // F R and Z R at the scale of the input, for mixtures or weights R.
  Signals signals(const Eigen::MatrixXd& R) const
  {
    Eigen::MatrixXd F = given_signals() * R;
    Eigen::MatrixXd Z =
        m_state.has_rough_basis()
            ? spectral_z(operator_of_basis(m_state.fine().V, m_state.fine().T, m_options), F)
            : Eigen::MatrixXd(given_signals() * (m_result.eigenpairs->values.asDiagonal() * R));
    return {std::move(F), std::move(Z)};
  }

  // What the relocation sees. Unlike a greedy order a descent finds the way around mixtures of
  // eigenvectors: with 64 of 100
  // |C|_L was 1.08 times as large.
  Signals signals_for_relocation() const
  {
    if(const Spectral_geometry::Filtered_signals* const filtered = m_state.filtered_signals())
      return {filtered->F, filtered->Z};
    Spectral_options options;
    options.number_of_mixtures = 4 * m_options.number_of_mixtures;
    options.seed = m_options.seed + 1; // others than those of the collapses
    return signals(mixing_matrix(options, weights()));
  }

  // All signals, restricted, each multiplied by the root of its weight.
  Signals restricted_signals(const SpMat& P) const
  {
    if(const Spectral_geometry::Filtered_signals* const filtered = m_state.filtered_signals())
      return {P * filtered->F, P * filtered->Z};
    const Eigen::MatrixXd R = weights().cwiseSqrt().asDiagonal();
    Eigen::MatrixXd PF = P * given_signals() * R;
    Eigen::MatrixXd PZ = m_state.has_rough_basis()
                             ? Eigen::MatrixXd(P * signals(R).second)
                             : Eigen::MatrixXd(PF * m_result.eigenpairs->values.asDiagonal());
    return {std::move(PF), std::move(PZ)};
  }

  // || Z ||_B^2 of these signals, for the input scaled to unit area.
  double sum_of_squares() const
  {
    if(!m_result.eigenpairs)
      return m_state.sum_of_squares();
    const double area = m_state.area();
    return area * area * weights().dot(m_result.eigenpairs->values.cwiseAbs2());
  }

  // E of the input scaled to unit area, as the loop has it, but of all signals. There eigenvectors
  // are longer by the root of the area, a user's signals are as they were given, and Z is
  // multiplied by the area. The result is scaled, not the signals, which are large, nor the
  // positions: far from the origin that would cost digits.
  void set_error(const SpMat& P)
  {
    const double area = m_state.area();
    const auto [PF, PZ] = restricted_signals(P);
    m_result.E = area * (m_options.signals.size() != 0 ? 1. : area) *
                 Spectral_geometry::internal::residual_energy(coarse_operator(), PF, PZ);
    m_result.relative_error =
        m_state.sum_of_squares() > 0 ? std::sqrt(m_result.E / sum_of_squares()) : 0.;
  }

  TriangleMesh& m_mesh;
  const typename Policies::State& m_state;
  const Spectral_edge_collapse_options& m_options;
  const NamedParameters& m_np;
  Result& m_result;
  SpMat m_P; // from the mesh of the eigenpairs to that of the collapses
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_SPECTRAL_POST_PROCESS_H
