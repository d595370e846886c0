// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_KEPT_VERTICES_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_KEPT_VERTICES_H

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/iterator.h>

#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Spectral_geometry/internal/require.h>

#include <Eigen/Core>

#include <cstddef>
#include <iterator>
#include <vector>

namespace CGAL::Surface_mesh_simplification::internal {

/// One flag for each vertex in the order of `vertices(mesh)`, from indices in that order and from
/// the named parameter `vertex_is_constrained_map`; empty if there is none to keep.
template <class TriangleMesh, class NamedParameters>
std::vector<char> kept_vertex_flags(const TriangleMesh& mesh,
                                    const std::vector<std::size_t>& indices,
                                    const NamedParameters& np)
{
  std::vector<char> flags;
  bool any = !indices.empty();
  for([[maybe_unused]] const auto v : vertices(mesh)) {
    bool kept = false;
    if constexpr(!parameters::is_default_parameter<NamedParameters,
                                                   internal_np::vertex_is_constrained_t>::value)
      kept = get(parameters::get_parameter(np, internal_np::vertex_is_constrained), v);
    any = any || kept;
    flags.push_back(kept);
  }
  for(const std::size_t i : indices) {
    require(i < flags.size(), "Spectral_options: vertex ", i, " is to be kept, but the mesh has ",
            flags.size(), " vertices; use indices from 0.");
    flags[i] = true;
  }
  return any ? flags : std::vector<char>();
}

/// The vertices that must be left where they are: those to keep and the ends of constrained edges.
/// Empty, or one flag for each.
template <class TriangleMesh, class NamedParameters>
std::vector<char> fixed_vertex_flags([[maybe_unused]] const TriangleMesh& mesh,
                                     const std::vector<char>& kept, const NamedParameters& np)
{
  std::vector<char> fixed = kept;
  if constexpr(!parameters::is_default_parameter<NamedParameters,
                                                 internal_np::edge_is_constrained_t>::value) {
    const auto constrained = parameters::get_parameter(np, internal_np::edge_is_constrained);
    fixed.resize(std::size_t(std::distance(vertices(mesh).begin(), vertices(mesh).end())), false);
    std::size_t i = 0;
    for(const auto v : vertices(mesh)) {
      const auto h0 = halfedge(v, mesh);
      if(h0 != boost::graph_traits<TriangleMesh>::null_halfedge())
        for(const auto h : halfedges_around_target(h0, mesh))
          fixed[i] = fixed[i] || get(constrained, edge(h, mesh));
      ++i;
    }
  }
  return fixed;
}

/// Throws where two vertices to be kept are joined by edges without length: `edge_collapse()`
/// merges their ends before it asks for a cost. `kept`: empty, or one flag for each row of V.
inline void check_kept_vertices_apart(const std::vector<char>& kept, const Eigen::MatrixXd& V,
                                      const Eigen::MatrixXi& T)
{
  if(kept.empty())
    return;
  const std::vector<Eigen::Index> place =
      Spectral_geometry::internal::connected_components(V.rows(), [&](const auto& join) {
        for(Eigen::Index f = 0; f < T.rows(); ++f)
          for(int k = 0; k < 3; ++k)
            if(V.row(T(f, k)) == V.row(T(f, (k + 1) % 3)))
              join(T(f, k), T(f, (k + 1) % 3));
      });
  std::vector<Eigen::Index> kept_at(kept.size(), -1);
  for(std::size_t v = 0; v < kept.size(); ++v)
    if(kept[v]) {
      Eigen::Index& first = kept_at[std::size_t(place[v])];
      require(first < 0, "Spectral_options: the vertices ", first, " and ", v,
              " are both to be kept, but edges without length join them and are collapsed before "
              "anything "
              "else; keep one of the two.");
      first = Eigen::Index(v);
    }
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_KEPT_VERTICES_H
