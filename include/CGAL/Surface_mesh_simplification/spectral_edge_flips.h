// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_FLIPS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_FLIPS_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/edge_flips.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * Flips edges of a coarse mesh so that E (Eq. 2) falls, as section 6 of the paper does after a simplification, or until its
 * edges are Delaunay: the mesh form of `Spectral_geometry::flip_edges()`, which says what is compared and what is guarded.
 * Vertices, their positions and P stay. Edges keep their handles, so that a map of constrained edges stays valid.
 *
 * For a mesh that `spectral_edge_collapse()` made pass the restriction of its result, for any other
 * `Spectral_geometry::closest_point_interpolation()` with its vertices as points. Relocation, if any, comes afterwards.
 *
 * @param mesh    the coarse mesh, of triangles
 * @param P       coarse x fine, rows in the order of `vertices(mesh)`
 * @param F       fine x K, the signals
 * @param Z       fine x K, B^-1 L F
 * @param op      the mass matrix of the metric, or an operator with coefficients for the vertices of `mesh`
 * @param options which edges, guards, when to stop
 * @param np      named parameters: `vertex_point_map`, `geom_traits` and `edge_is_constrained_map` (these edges stay)
 *
 * @return the flips, E before and after
 *
 * @throws std::invalid_argument for matrices that do not belong together, or options out of range
 * @throws Spectral_geometry::Cancelled when the progress callback returns false; the mesh is then as it was
 */
template <class TriangleMesh, class NamedParameters = parameters::Default_named_parameters>
Spectral_geometry::Edge_flip_result
spectral_edge_flips(TriangleMesh& mesh, const Eigen::SparseMatrix<double>& P, const Eigen::MatrixXd& F,
                    const Eigen::MatrixXd& Z, const Spectral_geometry::Local_operator& op,
                    const Spectral_geometry::Edge_flip_options& options = {},
                    const NamedParameters& np = parameters::default_values())
{
  Spectral_geometry::Mesh_matrices coarse = Spectral_geometry::mesh_matrices(mesh, np);
  std::vector<std::pair<int, int>> constrained;
  if constexpr(!parameters::is_default_parameter<NamedParameters,
                                                 internal_np::edge_is_constrained_t>::value) {
    Eigen::Index corner = 0; // the target of h
    for(const auto f : faces(mesh))
      for(const auto h : halfedges_around_face(halfedge(f, mesh), mesh)) {
        if(get(parameters::get_parameter(np, internal_np::edge_is_constrained), edge(h, mesh)))
          constrained.emplace_back(coarse.T(corner / 3, corner % 3), coarse.T(corner / 3, (corner + 2) % 3));
        ++corner;
      }
  }
  Spectral_geometry::Edge_flip_result result =
      Spectral_geometry::flip_edges(coarse.V, coarse.T, P, F, Z, op, constrained, options);
  const std::vector<typename boost::graph_traits<TriangleMesh>::vertex_descriptor> handles(
      vertices(mesh).begin(), vertices(mesh).end());
  for(const Spectral_geometry::Edge_flip& flip : result.flips) {
    const auto h = halfedge(handles[std::size_t(flip.from[0])], handles[std::size_t(flip.from[1])], mesh);
    CGAL_assertion(h.second);
    Euler::flip_edge(h.first, mesh);
  }
  return result;
}

/*!
 * The same for eigenvectors.
 *
 * @param mesh    the coarse mesh, of triangles
 * @param P       coarse x fine, rows in the order of `vertices(mesh)`
 * @param pairs   eigenpairs of the fine mesh, of the same operator and mass, at its own scale; tight ones, since Z is taken as
 *        Phi Lambda
 * @param op      the mass matrix of the metric, or an operator with coefficients for the vertices of `mesh`
 * @param options which edges, guards, when to stop
 * @param np      named parameters, as above
 *
 * @return the flips, E before and after
 */
template <class TriangleMesh, class NamedParameters = parameters::Default_named_parameters>
Spectral_geometry::Edge_flip_result
spectral_edge_flips(TriangleMesh& mesh, const Eigen::SparseMatrix<double>& P,
                    const Spectral_geometry::Eigenpairs& pairs, const Spectral_geometry::Local_operator& op,
                    const Spectral_geometry::Edge_flip_options& options = {},
                    const NamedParameters& np = parameters::default_values())
{
  return spectral_edge_flips(mesh, P, pairs.vectors, pairs.vectors * pairs.values.asDiagonal(), op, options,
                             np);
}

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_FLIPS_H
