// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_PRE_SIMPLIFICATION_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_PRE_SIMPLIFICATION_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Fine_vertex_slots.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Kept_vertices.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Quadric_collapses.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/is_given.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>
#include <CGAL/use.h>

#include <Eigen/Core>

#include <cstddef>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// What the first stage has done; nothing where it was skipped.
struct Pre_simplification
{
  bool done = false;
  Collapse_log log;
  std::vector<Eigen::Index> slots;        ///< of `vertices(mesh)` afterwards, in that order
  std::vector<std::size_t> kept_vertices; ///< where those to be kept are in it
};

/// Throws for what would otherwise be found out after the mesh has changed.
inline void check_pre_simplification(const Spectral_edge_collapse_options& options, const std::size_t n,
                                     const std::size_t target)
{
  using std::to_string;
  const std::string size =
      "Spectral_edge_collapse_options: pre_simplify is " + to_string(options.pre_simplify);
  if(options.pre_simplify < target)
    throw std::invalid_argument(size + ", less than the target of " + to_string(target) +
                                " vertices; use a number between the target and the size of the mesh.");
  if(options.signals.size() != 0 || options.eigenpairs)
    throw std::invalid_argument(
        "Spectral_edge_collapse_options: pre_simplify is set, but the signals or eigenpairs that are "
        "given belong to the mesh before it; use one of the two.");
  if(options.number_of_eigenvectors >= Eigen::Index(options.pre_simplify))
    throw std::invalid_argument(size + ", but " + to_string(options.number_of_eigenvectors) +
                                " eigenvectors are asked for; use a number of vertices above that.");
  check_spectral_options(options, Eigen::Index(n));
  spectral_weights(options, options.number_of_eigenvectors);
  Spectral_geometry::internal::check_eigenpairs_options(options.eigenpairs_options,
                                                        options.number_of_eigenvectors);
}

/// The same for what is wrong with the mesh and stays so in the first stage. Needles and faces without area need not.
template <class TriangleMesh>
void check_mesh_to_pre_simplify(const TriangleMesh& mesh, const Eigen::MatrixXd& V)
{
  check_extent(V);
  Eigen::Index i = 0;
  for(const auto v : vertices(mesh)) {
    if(halfedge(v, mesh) == boost::graph_traits<TriangleMesh>::null_halfedge())
      throw std::invalid_argument("Spectral_policies: " + Spectral_geometry::internal::vertex_name(i) +
                                  " is isolated, no face uses it; remove it.");
    ++i;
  }
}

/// The corners of all faces in the order of `faces(mesh)`, and those on the other side of their edges. `T` as in `mesh_matrices()`.
template <class TriangleMesh>
Triangle_arrays triangle_arrays(const TriangleMesh& mesh, const Spectral_geometry::Mesh_matrices& matrices)
{
  Triangle_arrays result;
  result.V = matrices.V;
  const auto index = get(CGAL::dynamic_face_property_t<int>(), mesh);
  int m = 0;
  for(const auto f : faces(mesh)) {
    put(index, f, m);
    for(int k = 0; k < 3; ++k)
      result.vertex.push_back(matrices.T(m, k));
    ++m;
  }
  for(const auto f : faces(mesh))
    // Corner k is the target of the k-th halfedge, and what leads from there the next one.
    for(const auto h : halfedges_around_face(next(halfedge(f, mesh), mesh), mesh)) {
      const auto beyond = opposite(h, mesh);
      int corner = -1;
      if(!is_border(beyond, mesh)) {
        const auto first = halfedge(face(beyond, mesh), mesh);
        const int k = beyond == next(first, mesh) ? 0 : beyond == first ? 2 : 1;
        corner = 3 * get(index, face(beyond, mesh)) + k;
      }
      result.opposite.push_back(corner);
    }
  return result;
}

/// The vertices that the first stage must leave where they are: those to keep and the ends of constrained edges.
template <class TriangleMesh, class NamedParameters>
std::vector<char> fixed_vertex_flags(const TriangleMesh& mesh, const std::vector<char>& kept,
                                     const NamedParameters& np)
{
  std::vector<char> fixed = kept;
  if constexpr(is_given<NamedParameters>(internal_np::edge_is_constrained_t())) {
    const auto constrained = parameters::get_parameter(np, internal_np::edge_is_constrained);
    fixed.resize(std::size_t(std::distance(vertices(mesh).begin(), vertices(mesh).end())), false);
    std::size_t i = 0;
    for(const auto v : vertices(mesh)) {
      for(const auto h : halfedges_around_target(v, mesh))
        fixed[i] = fixed[i] || get(constrained, edge(h, mesh));
      ++i;
    }
  } else
    CGAL_USE(mesh);
  return fixed;
}

/// The first stage of `Spectral_edge_collapse_options::pre_simplify` on a mesh of n vertices: `quadric_collapses()` on arrays, then
/// the same collapses on the mesh. Before these it can be cancelled, and nothing has happened then.
template <class TriangleMesh, class NamedParameters>
Pre_simplification pre_simplify(TriangleMesh& mesh, const std::size_t n, const std::size_t target,
                                const Spectral_edge_collapse_options& options, const NamedParameters& np)
{
  Pre_simplification result;
  if(options.pre_simplify == 0 || n <= options.pre_simplify)
    return result;
  if(is_given<NamedParameters>(internal_np::filter_t()) ||
     is_given<NamedParameters>(internal_np::visitor_t()))
    throw std::invalid_argument("Spectral_edge_collapse_options: pre_simplify calls no filter and no "
                                "visitor, but one is given; leave "
                                "one of the two out, or simplify by edge_collapse() with a cheap cost and a "
                                "Restriction_visitor first.");
  check_pre_simplification(options, n, target);
  const std::vector<char> kept = kept_vertex_flags(mesh, options.kept_vertices, np);
  Triangle_arrays arrays;
  {
    const Spectral_geometry::Mesh_matrices matrices = Spectral_geometry::mesh_matrices(mesh, np);
    check_mesh_to_pre_simplify(mesh, matrices.V);
    if(!kept.empty()) {
      using vertex_descriptor = typename boost::graph_traits<TriangleMesh>::vertex_descriptor;
      const Fine_vertex_slots<TriangleMesh> slots(mesh, "spectral_edge_collapse");
      check_kept_vertices_apart(
          mesh, [&](const vertex_descriptor v) { return kept[std::size_t(slots.slot(v))] != 0; },
          [&](const vertex_descriptor v) { return slots.slot(v); },
          [&](const vertex_descriptor v, const vertex_descriptor w) {
            return matrices.V.row(slots.slot(v)) == matrices.V.row(slots.slot(w));
          });
    }
    arrays = triangle_arrays(mesh, matrices);
  }
  const auto report = [&](const std::size_t left) {
    const double fraction = double(n - left) / double(n - options.pre_simplify);
    if(!report_progress(options, Spectral_phase::pre_simplification, fraction, left))
      throw Spectral_geometry::Cancelled();
  };
  report(n);
  result.log = quadric_collapses(std::move(arrays), fixed_vertex_flags(mesh, kept, np),
                                 options.boundary == Spectral_geometry::Boundary_condition::dirichlet,
                                 options.pre_simplify, report);
  Collapse_replay<TriangleMesh, NamedParameters> replay(mesh, result.log, np);
  replay.collapse_to(result.log.number_of_vertices_left());
  result.slots = replay.slots();
  for(std::size_t i = 0; i < result.slots.size(); ++i)
    if(!kept.empty() && kept[std::size_t(result.slots[i])])
      result.kept_vertices.push_back(i);
  result.done = true;
  return result;
}

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_PRE_SIMPLIFICATION_H
