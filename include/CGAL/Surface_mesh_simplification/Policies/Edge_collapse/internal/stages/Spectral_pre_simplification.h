// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_SPECTRAL_PRE_SIMPLIFICATION_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_SPECTRAL_PRE_SIMPLIFICATION_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Kept_vertices.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Surface_mesh_simplification/quadric_edge_collapse.h>

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/require.h>

#include <CGAL/Named_function_parameters.h>

#include <Eigen/Core>

#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

namespace CGAL::Surface_mesh_simplification::internal {

/// What the first stage has done; nothing where it was skipped.
struct Pre_simplification
{
  bool done = false;
  Collapse_log log;
  std::vector<Eigen::Index> slots;        ///< of `vertices(mesh)` afterwards, in that order
  std::vector<std::size_t> kept_vertices; ///< where those to be kept are in it
};

/// Throws for what would otherwise be found out after the mesh has changed.
inline void check_pre_simplification(const Spectral_edge_collapse_options& options,
                                     const std::size_t n, const std::size_t target)
{
  require(options.pre_simplify >= target, "Spectral_edge_collapse_options: pre_simplify is ",
          options.pre_simplify, ", less than the target of ", target,
          " vertices; use a number between the target and the size of the mesh.");
  require(options.signals.size() == 0 && !options.eigenpairs,
          "Spectral_edge_collapse_options: pre_simplify is set, but the signals or eigenpairs that "
          "are given "
          "belong to the mesh before it; use one of the two.");
  require(options.number_of_eigenvectors < Eigen::Index(options.pre_simplify),
          "Spectral_edge_collapse_options: pre_simplify is ", options.pre_simplify, ", but ",
          options.number_of_eigenvectors,
          " eigenvectors are asked for; use a number of vertices above that.");
  check_spectral_options(options, Eigen::Index(n));
  spectral_weights(options, options.number_of_eigenvectors);
  Spectral_geometry::internal::check_eigenpairs_options(options.eigenpairs_options,
                                                        options.number_of_eigenvectors);
}

/// `collapse_by_quadrics()` of n vertices to `target` as the options have it. Until the mesh
/// changes it can be cancelled, and nothing has happened then.
template <class TriangleMesh, class NamedParameters>
std::pair<Collapse_log, std::vector<Eigen::Index>>
collapse_by_quadrics(TriangleMesh& mesh, const std::size_t n, const std::size_t target,
                     const std::vector<char>& kept, const Spectral_edge_collapse_options& options,
                     const NamedParameters& np)
{
  const auto report = [&](const std::size_t left) {
    const double fraction = double(n - left) / double(n - target);
    if(!report_progress(options, Spectral_phase::pre_simplification, fraction, left))
      throw Spectral_geometry::Cancelled();
  };
  return collapse_by_quadrics(mesh, target, kept,
                              options.preserve_border ||
                                  options.boundary ==
                                      Spectral_geometry::Boundary_condition::dirichlet,
                              options.binary, options.keep_free_of_self_intersections, report, np);
}

/// The first stage of `Spectral_edge_collapse_options::pre_simplify` on a mesh of n vertices.
template <class TriangleMesh, class NamedParameters>
Pre_simplification pre_simplify(TriangleMesh& mesh, const std::size_t n, const std::size_t target,
                                const Spectral_edge_collapse_options& options,
                                const NamedParameters& np)
{
  Pre_simplification result;
  if(options.pre_simplify == 0 || n <= options.pre_simplify)
    return result;
  require(parameters::is_default_parameter<NamedParameters, internal_np::filter_t>::value &&
              parameters::is_default_parameter<NamedParameters, internal_np::visitor_t>::value,
          "Spectral_edge_collapse_options: pre_simplify calls no filter and no visitor, but one is "
          "given; "
          "leave one of the two out, or simplify by edge_collapse() with a cheap cost and a "
          "Restriction_visitor first.");
  check_pre_simplification(options, n, target);
  const std::vector<char> kept = kept_vertex_flags(mesh, options.kept_vertices, np);
  std::tie(result.log, result.slots) =
      collapse_by_quadrics(mesh, n, options.pre_simplify, kept, options, np);
  for(std::size_t i = 0; i < result.slots.size(); ++i)
    if(!kept.empty() && kept[std::size_t(result.slots[i])])
      result.kept_vertices.push_back(i);
  result.done = true;
  return result;
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_SPECTRAL_PRE_SIMPLIFICATION_H
