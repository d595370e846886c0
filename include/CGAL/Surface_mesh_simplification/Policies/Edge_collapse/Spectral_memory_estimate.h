// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_MEMORY_ESTIMATE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_MEMORY_ESTIMATE_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>

namespace CGAL {
namespace Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * Returns about how many bytes `spectral_edge_collapse()` takes at its peak, the mesh included: to be compared with what the
 * machine has before a large mesh is started. Two phases compete: the Krylov space of the eigensolver, of 3.5 K vectors of n
 * doubles (or `Eigenpairs_options::maximum_vectors`), and the loop, which keeps the eigenpairs, F and R = B Z - L F, three
 * times n K doubles (five times with signals of the user's, for Z). The constants were measured on closed meshes of 50,000
 * to 500,000 vertices; estimates are within about a quarter.
 *
 * With `Spectral_edge_collapse_options::pre_simplify` both phases see the reduced mesh, and the first stage takes a number of bytes per
 * vertex of the input that does not depend on K.
 *
 * @param number_of_vertices n of the input
 * @param number_of_eigenvectors K, at least 1; the number of columns where signals or eigenpairs are given
 * @param options placement and so on do not matter; `signals`, `eigenpairs`, `pre_simplify` and `eigenpairs_options` do
 */
inline double estimated_memory(const std::size_t number_of_vertices,
                               const Eigen::Index number_of_eigenvectors,
                               const Spectral_edge_collapse_options& options = Spectral_edge_collapse_options())
{
  const bool reduced = options.pre_simplify != 0 && number_of_vertices > options.pre_simplify;
  const double input = double(number_of_vertices), n = reduced ? double(options.pre_simplify) : input;
  const double K = double(number_of_eigenvectors);
  const Eigen::Index limit = options.eigenpairs_options.maximum_vectors;
  const bool solves = options.signals.size() == 0 && !options.eigenpairs;

  // Bytes per vertex: mesh; matrices and Cholesky factor; rings, inner products, candidates and CGAL's queue.
  const double mesh = 300, factor = 900, loop = 1900, first_stage = 1500;
  const double space = limit > 0 ? double(limit) : (std::max)(3.5 * K, K + 120);
  const double solver = solves ? n * (8 * space + factor) : 0;
  const double collapses = n * (8 * (options.signals.size() != 0 ? 5 : 3) * K + loop);
  const double both = (std::max)(solver, collapses);
  return input * mesh + (reduced ? (std::max)(input * first_stage, both) : both);
}

/// @}

} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_MEMORY_ESTIMATE_H
