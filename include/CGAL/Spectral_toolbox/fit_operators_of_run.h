// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_FIT_OPERATORS_OF_RUN_H
#define CGAL_SPECTRAL_TOOLBOX_FIT_OPERATORS_OF_RUN_H

#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_result.h>

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_toolbox/fitted_operators.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/*!
 * Fits a Laplacian and a mass, on the mesh left by `spectral_edge_collapse()`, to the spectrum of
 * the input: `Spectral_geometry::fit_operators()` with the operator of the run. They are fitted to
 * `Spectral_options::eigenpairs` if these were given, otherwise to a fifth more eigenpairs than K.
 * The latter takes a solve on the input, whatever `pre_simplify` was. The run may have been
 * cancelled.
 *
 * @param input the mesh before the run
 * @param output the mesh that it has left
 * @param options of the run, not with `signals` or the Dirichlet condition
 * @param result of the run
 * @param fit how to fit; its progress callback gets the solve as the first half
 * @return the operators, rows in the order of those of `result.restriction`
 *
 * Throws as `Spectral_geometry::eigenpairs()` and `Spectral_geometry::fit_operators()` do, and
 * `std::invalid_argument` for the excluded options of the run.
 */
inline Spectral_geometry::Operator_fit_result fit_operators_of_run(
    const Spectral_geometry::Mesh_matrices& input, const Spectral_geometry::Mesh_matrices& output,
    const Spectral_edge_collapse_options& options, const Spectral_edge_collapse_result& result,
    Spectral_geometry::Operator_fit_options fit)
{
  using namespace Spectral_geometry;
  Spectral_geometry::internal::check_operator_fit_options(fit);
  internal::require(options.signals.size() == 0,
                    "fit_operators_of_run: operators are fitted to eigenvectors, but the run kept "
                    "signals; call fit_operators() with eigenpairs.");
  internal::require(options.boundary != Boundary_condition::dirichlet,
                    "fit_operators_of_run: fitted Laplacians have rows that sum to zero, which "
                    "those of the Dirichlet condition do not; leave it out.");
  const Laplace_operator fine = internal::operator_of_basis(input.V, input.T, options);
  const auto progress = fit.progress;
  std::shared_ptr<const Eigenpairs> pairs = options.eigenpairs;
  if(!pairs) {
    Eigenpairs_options solver = options.eigenpairs_options;
    solver.threads = (std::max)(solver.threads, options.threads);
    if(fit.cancel != nullptr)
      solver.cancel = fit.cancel;
    solver.progress = [&](const Progress& p) {
      return !progress || progress({Phase::operator_fit, p.fraction / 2});
    };
    const Eigen::Index K = options.number_of_eigenvectors;
    pairs = std::make_shared<Eigenpairs>(
        eigenpairs(fine, (std::min)(K + K / 5, fine.L.rows()), solver));
  }
  fit.threads = (std::max)(fit.threads, options.threads);
  if(progress)
    fit.progress = [&](const Progress& p) {
      return progress({Phase::operator_fit, (1 + p.fraction) / 2});
    };
  return fit_operators(
      laplace_operator(output.V, output.T, {options.mass, result.coefficients, options.boundary}),
      result.restriction, fine, *pairs, fit);
}

/// Fits with the mass on the edges, or for a lumped run on the diagonal alone.
inline Spectral_geometry::Operator_fit_result fit_operators_of_run(
    const Spectral_geometry::Mesh_matrices& input, const Spectral_geometry::Mesh_matrices& output,
    const Spectral_edge_collapse_options& options, const Spectral_edge_collapse_result& result)
{
  return fit_operators_of_run(input, output, options, result,
                              Spectral_geometry::Operator_fit_options::for_mass(
                                  Spectral_geometry::mass_blend(options.mass)));
}

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SPECTRAL_TOOLBOX_FIT_OPERATORS_OF_RUN_H
