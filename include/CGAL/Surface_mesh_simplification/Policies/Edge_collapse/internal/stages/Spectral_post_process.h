// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_STAGES_SPECTRAL_POST_PROCESS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_STAGES_SPECTRAL_POST_PROCESS_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_flips.h>
#include <CGAL/Surface_mesh_simplification/spectral_relocation.h>

#include <CGAL/Spectral_geometry/internal/operators/connectivity.h>
#include <CGAL/Spectral_geometry/Cancelled.h>
#include <CGAL/Spectral_geometry/fitted_operators.h>
#include <CGAL/Spectral_geometry/functional_map.h>

#include <CGAL/Real_timer.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// What follows the collapses: `flips`, `relocate` and `fit_operators` of `Spectral_edge_collapse_options`, in this order. Made
/// before the first collapse: it needs the mesh of the eigenpairs.
class Spectral_post_process
{
public:
  template <class TriangleMesh, class NamedParameters>
  Spectral_post_process(const TriangleMesh& mesh, const Spectral_edge_collapse_options& options,
                        const NamedParameters& np)
    : m_options(options)
  {
    if(changes_mesh() || m_options.fit_operators)
      m_fine = Spectral_geometry::mesh_matrices(mesh, np);
  }

  /// `kept`: what P has in the rows of vertices that must stay, or empty.
  template <class TriangleMesh, class Policies, class NamedParameters, class Result>
  void run(TriangleMesh& mesh, const Policies& policies, const Eigen::SparseMatrix<double>& kept,
           const NamedParameters& np, Result& result) const
  {
    using Reason = typename Result::Stop_reason;
    if((!changes_mesh() && !m_options.fit_operators) || result.stop_reason == Reason::cancelled)
      return;
    const Eigen::SparseMatrix<double> P = policies.restriction();
    if(changes_mesh())
      change(mesh, policies, P, kept, np, result);
    if(m_options.fit_operators && result.stop_reason != Reason::cancelled)
      fit(mesh, policies, result.relocation.resampled ? result.relocation.restriction : P, np, result);
  }

private:
  // Flips and relocation.
  template <class TriangleMesh, class Policies, class NamedParameters, class Result>
  void change(TriangleMesh& mesh, const Policies& policies, const Eigen::SparseMatrix<double>& P,
              const Eigen::SparseMatrix<double>& kept, const NamedParameters& np, Result& result) const
  {
    using namespace Spectral_geometry;
    const Local_operator coarse_op = coarse_operator(result);
    Eigen::MatrixXd F, Z;
    signals(result.eigenpairs.get(), policies.state().core().fields().has_z_rows(), F, Z);
    const char* where = "as the collapses left them";
    try {
      if(m_options.flips != Edge_flips::none && allows(mesh, "No edge was flipped: ", false, np, result)) {
        flip(mesh, policies, P, F, Z, coarse_op, np, result);
        where = "as collapses and flips left them";
      }
      if(m_options.relocate && allows(mesh, "The vertices were not relocated: ", true, np, result))
        relocate(mesh, policies, P, F, Z, coarse_op, kept, np, result);
    } catch(const Cancelled&) {
      result.stop_reason = Result::Stop_reason::cancelled;
      result.explanation = "The run was cancelled at " + std::to_string(result.output_vertices) +
                           " vertices, which are " + where + ".";
    }
  }

  // Operators for the mesh as it is now; P leads from the mesh of the eigenpairs to it. What fails is a warning: the mesh is made.
  template <class TriangleMesh, class Policies, class NamedParameters, class Result>
  void fit(const TriangleMesh& mesh, const Policies& policies, const Eigen::SparseMatrix<double>& P,
           const NamedParameters& np, Result& result) const
  {
    using namespace Spectral_geometry;
    Real_timer timer;
    timer.start();
    const auto progress = [&](const double fraction) {
      return policies.state().report(Spectral_phase::operator_fit, fraction);
    };
    const char* consequence = "The operators were not fitted: ";
    try {
      if(!allows(mesh, consequence, false, np, result))
        return;
      const Laplace_operator fine = operator_of_basis(m_fine.V, m_fine.T, m_options);
      std::shared_ptr<const Eigenpairs> pairs = m_options.eigenpairs;
      if(!pairs) {
        Eigenpairs_options solver = m_options.eigenpairs_options;
        solver.threads = (std::max)(solver.threads, m_options.threads);
        solver.progress = [&](const double fraction) { return progress(fraction / 2); };
        const Eigen::Index K = result.eigenpairs->size();
        pairs = std::make_shared<Eigenpairs>(eigenpairs(fine, (std::min)(K + K / 5, fine.L.rows()), solver));
      }
      Operator_fit_options options = m_options.operator_fit;
      options.threads = (std::max)(options.threads, m_options.threads);
      options.progress = [&](const double fraction) { return progress((1 + fraction) / 2); };
      const Mesh_matrices coarse = mesh_matrices(mesh, np);
      result.fitted = fit_operators(laplace_operator(coarse.V, coarse.T, coarse_operator(result)), P, fine,
                                    *pairs, options);
    } catch(const Cancelled&) {
      result.stop_reason = Result::Stop_reason::cancelled;
      result.explanation = "The run was cancelled at " + std::to_string(result.output_vertices) +
                           " vertices, before operators were fitted to them.";
    } catch(const std::runtime_error& error) {
      result.warnings.push_back(consequence + std::string(error.what()));
    }
    result.seconds_operator_fit = timer.time();
  }

  // With the coefficients that the collapses have merged.
  template <class Result>
  Spectral_geometry::Local_operator coarse_operator(const Result& result) const
  {
    return {m_options.mass, result.coefficients, m_options.boundary};
  }

  bool changes_mesh() const
  {
    return m_options.relocate || m_options.flips != Spectral_geometry::Edge_flips::none;
  }

  // Whether the mesh that is left has an operator, and each face an area if need be; warns where it has not. The collapses
  // are done: to throw would lose them.
  template <class TriangleMesh, class NamedParameters, class Result>
  bool allows(const TriangleMesh& mesh, const char* consequence, const bool needs_areas,
              const NamedParameters& np, Result& result) const
  {
    using namespace Spectral_geometry;
    const Mesh_matrices coarse = mesh_matrices(mesh, np);
    std::string obstacle;
    try {
      laplace_operator(coarse.V, coarse.T, coarse_operator(result));
    } catch(const std::invalid_argument& error) {
      obstacle = error.what();
    }
    for(Eigen::Index f = 0; f < coarse.T.rows() && needs_areas && obstacle.empty(); ++f)
      if(!(triangle_cotangents(coarse.V.row(coarse.T(f, 0)), coarse.V.row(coarse.T(f, 1)),
                               coarse.V.row(coarse.T(f, 2)))
               .area > 0))
        obstacle =
            Spectral_geometry::internal::face_name(f) + " of the simplified mesh has no area; remove it.";
    if(!obstacle.empty())
      result.warnings.push_back(consequence + obstacle);
    return obstacle.empty();
  }

  template <class TriangleMesh, class Policies, class NamedParameters, class Result>
  void flip(TriangleMesh& mesh, const Policies& policies, const Eigen::SparseMatrix<double>& P,
            const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z, const Spectral_geometry::Local_operator& op,
            const NamedParameters& np, Result& result) const
  {
    Spectral_geometry::Edge_flip_options flipping = m_options.flipping;
    flipping.criterion = m_options.flips;
    flipping.progress = [&](const double fraction) {
      return policies.state().report(Spectral_phase::flips, fraction);
    };
    const Eigen::Index seen = policies.state().core().number_of_signals();
    result.flips = spectral_edge_flips(mesh, P, F.leftCols(seen), Z.leftCols(seen), op, flipping, np);
    set_error(mesh, policies.state().area(), P, F.leftCols(seen), Z.leftCols(seen), np, result);
  }

  template <class TriangleMesh, class Policies, class NamedParameters, class Result>
  void relocate(TriangleMesh& mesh, const Policies& policies, const Eigen::SparseMatrix<double>& P,
                const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z,
                const Spectral_geometry::Local_operator& op, const Eigen::SparseMatrix<double>& kept,
                const NamedParameters& np, Result& result) const
  {
    if(m_options.mass != Spectral_geometry::Mass::averaged)
      result.warnings.push_back(
          "Relocation is made for the averaged mass: in a lumped one it bends the shape "
          "to cancel the error of the elements.");
    Spectral_geometry::Relocation_options relocation = m_options.relocation;
    relocation.progress = [&](const double fraction) {
      return policies.state().report(Spectral_phase::relocation, fraction);
    };
    relocation.threads = (std::max)(relocation.threads, m_options.threads);
    std::vector<bool> stays;
    if(kept.rows() != 0) {
      const Eigen::VectorXd ones = kept * Eigen::VectorXd::Ones(kept.cols());
      stays.assign(ones.data(), ones.data() + ones.size());
    }
    result.relocation = relocate_mesh(mesh, P, m_fine, F, Z, op, relocation, stays, np);
    Eigen::SparseMatrix<double>& own = result.relocation.restriction;
    if(result.relocation.resampled && !stays.empty()) { // where the input has several points in one place
      own.prune([&](const Eigen::Index row, Eigen::Index, double) { return !stays[std::size_t(row)]; });
      own += kept;
    }
    if(result.relocation.resampled && op.boundary == Spectral_geometry::Boundary_condition::dirichlet)
      keep_border_rows(mesh, P, np, own);
    const Eigen::Index seen = policies.state().core().number_of_signals();
    set_error(mesh, policies.state().area(), own, F.leftCols(seen), Z.leftCols(seen), np, result);
  }

  // A vertex of the border whose closest point is an inner one goes on having 0.
  template <class TriangleMesh, class NamedParameters>
  static void keep_border_rows(const TriangleMesh& mesh, const Eigen::SparseMatrix<double>& P,
                               const NamedParameters& np, Eigen::SparseMatrix<double>& own)
  {
    const std::vector<char> border =
        Spectral_geometry::internal::border_vertices(Spectral_geometry::mesh_matrices(mesh, np).T, P.rows());
    Eigen::SparseMatrix<double> carried = P;
    carried.prune(
        [&](const Eigen::Index row, Eigen::Index, double) { return border[std::size_t(row)] != 0; });
    own.prune([&](const Eigen::Index row, Eigen::Index, double) { return border[std::size_t(row)] == 0; });
    own += carried;
  }

  // All of them, those that the metric sees first, at the scale of the input. Z has rows of its own where that of the loop had, for rough pairs as for signals.
  void signals(const Spectral_geometry::Eigenpairs* pairs, const bool own_rows, Eigen::MatrixXd& F,
               Eigen::MatrixXd& Z) const
  {
    const Eigen::MatrixXd& given = m_options.signals.size() != 0 ? m_options.signals : pairs->vectors;
    F = given * spectral_weights(m_options, given.cols()).cwiseSqrt().asDiagonal();
    if(own_rows)
      Z = spectral_z(operator_of_basis(m_fine.V, m_fine.T, m_options), F);
    else
      Z = F * pairs->values.asDiagonal();
  }

  // E of the input scaled to unit area, as the loop has it. There eigenvectors are longer by the root of the area, user's
  // signals are as they were given, and Z is multiplied by the area.
  template <class TriangleMesh, class NamedParameters, class Result>
  void set_error(const TriangleMesh& mesh, const double area, const Eigen::SparseMatrix<double>& P,
                 const Eigen::Ref<const Eigen::MatrixXd>& F, const Eigen::Ref<const Eigen::MatrixXd>& Z,
                 const NamedParameters& np, Result& result) const
  {
    using namespace Spectral_geometry;
    const Mesh_matrices coarse = mesh_matrices(mesh, np);
    const double scale = m_options.signals.size() != 0 ? 1. : std::sqrt(area);
    const double before = result.E;
    // The result is scaled, not the signals, which are large, nor the positions: far from the origin that would cost digits.
    const Laplace_operator op = laplace_operator(coarse.V, coarse.T, coarse_operator(result));
    result.E = area * scale * scale * restriction_energy(op, P, F, Z);
    if(before > 0)
      result.relative_error *= std::sqrt(result.E / before);
  }

  const Spectral_edge_collapse_options& m_options;
  Spectral_geometry::Mesh_matrices m_fine;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_STAGES_SPECTRAL_POST_PROCESS_H
