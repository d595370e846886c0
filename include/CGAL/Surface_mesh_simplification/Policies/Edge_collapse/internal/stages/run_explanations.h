// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_RUN_EXPLANATIONS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_RUN_EXPLANATIONS_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace CGAL::Surface_mesh_simplification::internal {

inline Eigen::Index number_of_components(const Spectral_geometry::Mesh_matrices& mesh)
{
  const std::vector<Eigen::Index> component =
      Spectral_geometry::internal::connected_components(mesh.V.rows(), mesh.T);
  return *std::max_element(component.begin(), component.end()) + 1;
}

/// Handles of all components together, by Euler's formula.
inline Eigen::Index genus(const Spectral_geometry::Mesh_matrices& mesh)
{
  using namespace Spectral_geometry::internal;
  const auto border = boundary_edges(mesh.T);
  const std::vector<Eigen::Index> loop_of =
      connected_components(mesh.V.rows(), [&](const auto& join) {
        for(const auto& [i, j] : border)
          join(i, j);
      });
  std::set<Eigen::Index> loops;
  for(const auto& [i, j] : border)
    loops.insert(loop_of[std::size_t(i)]);
  const Eigen::Index edges = (3 * mesh.T.rows() + Eigen::Index(border.size())) / 2;
  const Eigen::Index characteristic = mesh.V.rows() - edges + mesh.T.rows();
  return (2 * number_of_components(mesh) - characteristic - Eigen::Index(loops.size())) / 2;
}

/// Why a mesh that has run out of edges cannot be reduced further, and what helps. `wanted`: the
/// target, or 0 where nobody knows it.
inline std::string explain_exhausted_queue(const Spectral_geometry::Mesh_matrices& mesh,
                                           const Spectral_refusals& refusals,
                                           const std::size_t wanted)
{
  using std::to_string;
  const Eigen::Index components = number_of_components(mesh), handles = genus(mesh);
  return "The mesh stopped at " + to_string(mesh.V.rows()) + " vertices" +
         (wanted == 0 ? "" : " instead of " + to_string(wanted)) +
         " because every edge left was refused (topology " + to_string(refusals.topology) +
         ", geometry " + to_string(refusals.geometry) + ", filter " + to_string(refusals.filter) +
         ", placement " + to_string(refusals.placement) + " times" +
         (refusals.crossing == 0 ? ""
                                 : "; " + to_string(refusals.crossing) +
                                       " times so that no face goes through another, as "
                                       "keep_free_of_self_intersections asks") +
         "; constrained edges are never collapsed): it has " + to_string(components) +
         (components == 1 ? " component" : " components") +
         ", each of which needs at least 3 (open) or 4 (closed) vertices, genus " +
         to_string(handles) + (handles == 0 ? "" : ", as handles need more,") + " and " +
         to_string(Spectral_geometry::internal::boundary_edges(mesh.T).size()) + " border edges; " +
         (refusals.filter > refusals.topology && refusals.filter > refusals.crossing
              ? "ask for more vertices, or loosen the filter."
          : refusals.crossing > refusals.topology
              ? "ask for more vertices, or set keep_free_of_self_intersections to false."
          : components > 1 || handles > 0
              ? "ask for more vertices, or take small components and handles away."
              : "ask for more vertices, or constrain and keep less.");
}

/// What was done, but is not advised: one sentence each.
inline void warn_of_eigenpairs(std::vector<std::string>& warnings,
                               const Spectral_geometry::Eigenpairs* const pairs)
{
  if(pairs != nullptr && !pairs->complete && pairs->residuals.size() != 0 &&
     pairs->residuals.maxCoeff() > 1e-3)
    warnings.push_back(
        "The eigenpairs of the input did not reach their tolerance, the largest residual is " +
        std::to_string(pairs->residuals.maxCoeff()) +
        ": its triangles are of too different sizes for doubles; remesh it.");
}

/// \copydoc warn_of_eigenpairs()
inline void warn_of_target(std::vector<std::string>& warnings, const std::size_t vertices,
                           const Eigen::Index K, const Eigen::Index seen)
{
  if(Eigen::Index(vertices) < 3 * K)
    warnings.push_back(
        "The target of " + std::to_string(vertices) +
        " vertices is less than 3 K = " + std::to_string(3 * K) +
        "; the upper part of the spectrum will not be preserved (section 4.3 of the paper)" +
        (seen < K ? ", and the metric saw the first " + std::to_string(seen) + " eigenvectors."
                  : "."));
}

/// \copydoc warn_of_eigenpairs()
inline void warn_of_error(std::vector<std::string>& warnings, const double relative_error)
{
  if(relative_error > 0.5)
    warnings.push_back("The relative error is " + std::to_string(relative_error) +
                       ": more than half of the signals is lost; ask for more vertices, for fewer "
                       "eigenvectors, or take small components away.");
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_RUN_EXPLANATIONS_H
