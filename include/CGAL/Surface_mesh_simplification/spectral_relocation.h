// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_RELOCATION_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_RELOCATION_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Kept_vertices.h>

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/relocation.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/boost/graph/properties.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <cstddef>
#include <vector>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

namespace internal {

/// `spectral_relocation()` for signals: F and Z = B^-1 L F are fine x K. `fixed`: further vertices
/// that stay, or empty.
template <class TriangleMesh, class NamedParameters>
Spectral_geometry::Relocation_result
relocate_mesh(TriangleMesh& mesh, const Eigen::SparseMatrix<double>& P,
              const Spectral_geometry::Mesh_matrices& fine, const Eigen::MatrixXd& F,
              const Eigen::MatrixXd& Z, const Spectral_geometry::Local_operator& op,
              const Spectral_geometry::Relocation_options& options, std::vector<bool> fixed,
              const NamedParameters& np)
{
  using parameters::choose_parameter;
  using parameters::get_parameter;
  using Geom_traits = typename GetGeomTraits<TriangleMesh, NamedParameters>::type;
  using FT = typename Geom_traits::FT;
  using Point = typename Geom_traits::Point_3;
  Spectral_geometry::Mesh_matrices coarse = Spectral_geometry::mesh_matrices(mesh, np);
  const Eigen::MatrixXd before = coarse.V;
  const std::vector<char> constrained =
      fixed_vertex_flags(mesh, kept_vertex_flags(mesh, {}, np), np);
  fixed.resize(std::size_t(coarse.V.rows()));
  for(std::size_t v = 0; v < constrained.size(); ++v)
    fixed[v] = fixed[v] || constrained[v];
  Spectral_geometry::Relocation_result result =
      Spectral_geometry::relocate_positions(coarse.V, coarse.T, P, fine, F, Z, op, fixed, options);
  const auto points = choose_parameter(get_parameter(np, internal_np::vertex_point),
                                       get_property_map(vertex_point, mesh));
  Eigen::Index i = 0;
  for(const auto v : vertices(mesh)) {
    if(coarse.V.row(i) !=
       before.row(i)) // a point that did not move keeps its own number type's digits
      put(points, v, Point(FT(coarse.V(i, 0)), FT(coarse.V(i, 1)), FT(coarse.V(i, 2))));
    ++i;
  }
  return result;
}

} // namespace internal

/*!
 * Moves the vertices of a coarse mesh so that its Laplace-Beltrami spectrum agrees better with that
 * of a fine mesh: the mesh form of `Spectral_geometry::relocate_positions()`, which says what is
 * minimised and what is guarded.
 *
 * The coarse mesh may come from anywhere. For one that `spectral_edge_collapse()` made, pass the
 * restriction of its result; for a remeshed one `Spectral_geometry::closest_point_restriction()`.
 *
 * @param mesh  the coarse mesh; its connectivity stays
 * @param P     coarse x fine, rows in the order of `vertices(mesh)`
 * @param fine  the fine mesh, taken with `Spectral_geometry::mesh_matrices()` before it was
 * simplified
 * @param pairs eigenpairs of the fine mesh, of the same operator and mass, at its own scale; tight
 *        ones, since Z is taken as Phi Lambda
 * @param op    a mass, or an operator with coefficients for the vertices of `mesh`. Made for the
 * mass `averaged`: with a lumped one the shape is bent to cancel the error of the elements
 * @param options what to minimise, guards, when to stop
 * @param np    named parameters: `vertex_point_map`, `geom_traits`, `vertex_is_constrained_map` and
 *        `edge_is_constrained_map` (both ends stay where they are)
 *
 * @return what was done, and the restriction to use from now on
 *
 * @throws std::invalid_argument for matrices that do not belong together, or options out of range
 * @throws Spectral_geometry::Cancelled when the progress callback returns false; the mesh is then
 * as it was
 */
template <class TriangleMesh, class NamedParameters = parameters::Default_named_parameters>
Spectral_geometry::Relocation_result
spectral_relocation(TriangleMesh& mesh, const Eigen::SparseMatrix<double>& P,
                    const Spectral_geometry::Mesh_matrices& fine,
                    const Spectral_geometry::Eigenpairs& pairs,
                    const Spectral_geometry::Local_operator& op = Spectral_geometry::Mass::averaged,
                    const Spectral_geometry::Relocation_options& options = {},
                    const NamedParameters& np = parameters::default_values())
{
  return internal::relocate_mesh(mesh, P, fine, pairs.vectors,
                                 pairs.vectors * pairs.values.asDiagonal(), op, options, {}, np);
}

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_RELOCATION_H
