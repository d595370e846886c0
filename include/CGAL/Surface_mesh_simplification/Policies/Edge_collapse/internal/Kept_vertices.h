// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_KEPT_VERTICES_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_KEPT_VERTICES_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/is_given.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/use.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// One flag for each vertex in the order of `vertices(mesh)`, from indices in that order and from the named parameter
/// `vertex_is_constrained_map`; empty if there is none to keep.
template <class TriangleMesh, class NamedParameters>
std::vector<char> kept_vertex_flags(const TriangleMesh& mesh, const std::vector<std::size_t>& indices,
                                    const NamedParameters& np)
{
  std::vector<char> flags;
  bool any = !indices.empty();
  for(const auto v : vertices(mesh)) {
    bool kept = false;
    if constexpr(is_given<NamedParameters>(internal_np::vertex_is_constrained_t()))
      kept = get(parameters::get_parameter(np, internal_np::vertex_is_constrained), v);
    CGAL_USE(v);
    any = any || kept;
    flags.push_back(kept);
  }
  for(const std::size_t i : indices) {
    if(i >= flags.size())
      throw std::invalid_argument("Spectral_options: vertex " + std::to_string(i) +
                                  " is to be kept, but the mesh has " + std::to_string(flags.size()) +
                                  " vertices; use indices from 0.");
    flags[i] = true;
  }
  return any ? flags : std::vector<char>();
}

/// Throws where two vertices to be kept are joined by edges without length: `edge_collapse()` merges their ends before
/// it asks for a cost. `kept(v)` and `index(v)` belong to the vertex v, `same(v, w)` says whether two points coincide.
template <class TriangleMesh, class Kept, class Index, class Same>
void check_kept_vertices_apart(const TriangleMesh& mesh, const Kept& kept, const Index& index,
                               const Same& same)
{
  using vertex_descriptor = typename boost::graph_traits<TriangleMesh>::vertex_descriptor;
  std::vector<vertex_descriptor> reached;
  for(const vertex_descriptor start : vertices(mesh)) {
    if(!kept(start))
      continue;
    reached.assign(1, start);
    for(std::size_t i = 0; i < reached.size(); ++i) {
      if(halfedge(reached[i], mesh) == boost::graph_traits<TriangleMesh>::null_halfedge())
        continue;
      for(const vertex_descriptor w : vertices_around_target(halfedge(reached[i], mesh), mesh)) {
        if(!same(start, w) || std::find(reached.begin(), reached.end(), w) != reached.end())
          continue;
        if(kept(w))
          throw std::invalid_argument("Spectral_options: the vertices " + std::to_string(index(start)) +
                                      " and " + std::to_string(index(w)) +
                                      " are both to be kept, but edges without length join them and are "
                                      "collapsed before anything else; keep one of the two.");
        reached.push_back(w);
      }
    }
  }
}

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_KEPT_VERTICES_H
