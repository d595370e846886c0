// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_KEPT_VERTICES_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_KEPT_VERTICES_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_optional.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/is_given.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/number_utils.h>
#include <CGAL/use.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
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

using Coordinates = std::array<double, 3>;

/// As doubles, which the spectral cost sees: of two points of an exact kernel that differ by less, one edge without length.
template <class Point>
Coordinates coordinates(const Point& p)
{
  return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
}

/// Sorted, each once.
using Shared_positions = std::vector<Coordinates>;

/// The positions that several vertices to be kept share. They never move.
template <class TriangleMesh, class VertexPointMap, class Kept>
Shared_positions positions_of_several(const TriangleMesh& mesh, const VertexPointMap& vpm, const Kept& kept)
{
  Shared_positions all, shared;
  for(const auto v : vertices(mesh))
    if(kept(v))
      all.push_back(coordinates(get(vpm, v)));
  std::sort(all.begin(), all.end());
  for(std::size_t i = 1; i < all.size(); ++i)
    if(all[i] == all[i - 1] && (shared.empty() || shared.back() != all[i]))
      shared.push_back(all[i]);
  return shared;
}

/// No vertex is at a constrained edge.
struct No_constrained_vertices
{
  template <class TriangleMesh, class Vertex>
  bool operator()(const TriangleMesh&, const Vertex&) const
  {
    return false;
  }
};

/// Whether a vertex is at a constrained edge, so that `Constrained_placement` leaves it where it is.
template <class EdgeIsConstrainedMap>
struct Ends_of_constrained_edges
{
  EdgeIsConstrainedMap map;

  template <class TriangleMesh, class Vertex>
  bool operator()(const TriangleMesh& mesh, const Vertex v) const
  {
    for(const auto h : halfedges_around_target(halfedge(v, mesh), mesh))
      if(get(map, edge(h, mesh)))
        return true;
    return false;
  }
};

/*!
 * A placement that keeps vertices and is wrapped around one that knows nothing of them, that of
 * `Constrained_placement` included: the vertex to be kept, or none between two of them. For the first stage of
 * `Spectral_edge_collapse_options::pre_simplify`. `Tracker::is_kept(v)` says which they are, `IsConstrained` which
 * others must not move either.
 *
 * Vertices to be kept that share a position are never joined by edges without length, which the next stage would have
 * to collapse: no point is given at such a position when a neighbour is there already.
 */
template <class Tracker, class Placement, class IsConstrained>
class Kept_vertices_placement
{
public:
  Kept_vertices_placement(std::shared_ptr<const Tracker> tracker,
                          std::shared_ptr<const Shared_positions> shared, const Placement& placement,
                          const IsConstrained& is_constrained)
    : m_tracker(std::move(tracker))
    , m_shared(std::move(shared))
    , m_placement(placement)
    , m_is_constrained(is_constrained)
  {}

  template <class Profile>
  Spectral_optional<typename Profile::Point> operator()(const Profile& profile) const
  {
    using Optional_point = Spectral_optional<typename Profile::Point>;
    const bool kept0 = m_tracker->is_kept(profile.v0()), kept1 = m_tracker->is_kept(profile.v1());
    if(kept0 && kept1)
      return Optional_point();
    Optional_point point = m_placement(profile);
    if(point && (kept0 || kept1)) {
      const auto& fixed = kept0 ? profile.p0() : profile.p1();
      const bool other_stays = m_is_constrained(profile.surface_mesh(), kept0 ? profile.v1() : profile.v0());
      point = other_stays ? Optional_point() : Optional_point(fixed);
    }
    return point && joins_shared_position(profile, coordinates(*point)) ? Optional_point() : point;
  }

private:
  template <class Profile>
  bool joins_shared_position(const Profile& profile, const Coordinates& point) const
  {
    if(!std::binary_search(m_shared->begin(), m_shared->end(), point))
      return false;
    const auto link = profile.link();
    return std::any_of(link.begin(), link.end(), [&](const auto v) {
      return coordinates(get(profile.vertex_point_map(), v)) == point;
    });
  }

  std::shared_ptr<const Tracker> m_tracker;
  std::shared_ptr<const Shared_positions> m_shared;
  Placement m_placement;
  IsConstrained m_is_constrained;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_KEPT_VERTICES_H
