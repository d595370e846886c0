// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_CROSSING_GUARD_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_CROSSING_GUARD_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_rings.h>

#include <CGAL/Spectral_geometry/internal/Box_tree.h>
#include <CGAL/Spectral_geometry/internal/triangles_intersect.h>

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/*!
 * Tells whether a collapse would put a triangle through another one that it was not through before: ears, mouths and hooves are
 * thin sheets, and their sides are approximated apart from each other.
 *
 * Every triangle belongs to the smallest of its slots; a tree of boxes has a leaf for what belongs to each.
 */
class Spectral_crossing_guard
{
public:
  using Points = std::vector<Eigen::Vector3d>;

  bool is_active() const { return !m_tree.is_empty(); }

  void set_geometry(const Points& points, const Spectral_rings& rings)
  {
    std::vector<Box> boxes(points.size());
    for(std::size_t w = 0; w < points.size(); ++w)
      boxes[w] = box_of_owned(points, rings, Spectral_slot(w));
    m_tree.build(boxes);
  }

  /// Whether the triangles of u and v that are left would cross others once both are at x, where none of those around u and v
  /// crosses them now.
  bool crosses(const Points& points, const Spectral_rings& rings, const Spectral_slot u,
               const Spectral_slot v, const Eigen::Vector3d& x)
  {
    collect(points, rings, u, v, x);
    for(std::size_t i = 0; i < m_new.size(); ++i) {
      for(std::size_t j = i + 1; j < m_new.size(); ++j)
        if(triangles_intersect(m_new[i], m_new[j]) && !intersect_among(m_old))
          return true;
      const auto meets = [&](const std::size_t owner) {
        return meets_owned(points, rings, Spectral_slot(owner), u, v, m_new[i]);
      };
      if(m_tree.any(box_of(m_new[i]), meets))
        return true;
    }
    return false;
  }

  /// Follows a collapse, once rings and points have.
  void commit(const Points& points, const Spectral_rings& rings, const Spectral_slot removed,
              const Spectral_slot kept)
  {
    m_tree.update(removed, Box());
    m_tree.update(kept, box_of_owned(points, rings, kept));
    for(const Spectral_ring_entry& e : rings[kept])
      m_tree.update(e.vertex, box_of_owned(points, rings, e.vertex));
  }

private:
  using Box = Spectral_geometry::internal::Box_tree::Box;
  using Corners = Spectral_geometry::internal::Corners;

  static Box box_of(const Corners& t) { return Spectral_geometry::internal::box_of(t); }

  static bool triangles_intersect(const Corners& s, const Corners& t)
  {
    return box_of(s).intersects(box_of(t)) && Spectral_geometry::internal::triangles_intersect(s, t);
  }

  static bool intersect_among(const std::vector<Corners>& triangles)
  {
    for(std::size_t i = 0; i < triangles.size(); ++i)
      for(std::size_t j = i + 1; j < triangles.size(); ++j)
        if(triangles_intersect(triangles[i], triangles[j]))
          return true;
    return false;
  }

  template <class Function>
  static void for_each_owned(const Spectral_rings& rings, const Spectral_slot w, const Function& function)
  {
    const Spectral_ring& ring = rings[w];
    for(std::size_t i = 0; i < ring.size(); ++i) {
      const Spectral_slot a = ring[i].vertex, b = ring[Spectral_rings::next(ring, i)].vertex;
      if(ring[i].face && w < a && w < b)
        function(a, b);
    }
  }

  static Box box_of_owned(const Points& points, const Spectral_rings& rings, const Spectral_slot w)
  {
    Box box;
    for_each_owned(rings, w, [&](const Spectral_slot a, const Spectral_slot b) {
      box.extend(points[w]).extend(points[a]).extend(points[b]);
    });
    return box;
  }

  // The triangles of both ends: all as they are, and those that are left as they would be.
  void collect(const Points& points, const Spectral_rings& rings, const Spectral_slot u,
               const Spectral_slot v, const Eigen::Vector3d& x)
  {
    m_old.clear();
    m_new.clear();
    constexpr std::size_t merged = (std::numeric_limits<std::size_t>::max)();
    for(const Spectral_slot c : {u, v}) {
      const Spectral_ring& ring = rings[c];
      for(std::size_t i = 0; i < ring.size(); ++i) {
        const Spectral_slot a = ring[i].vertex, b = ring[Spectral_rings::next(ring, i)].vertex;
        const bool shared = a == u || a == v || b == u || b == v;
        if(!ring[i].face || (shared && c == v))
          continue;
        m_old.push_back(Corners{{{c, points[c]}, {a, points[a]}, {b, points[b]}}});
        if(!shared)
          m_new.push_back(Corners{{{merged, x}, {a, points[a]}, {b, points[b]}}});
      }
    }
  }

  bool meets_owned(const Points& points, const Spectral_rings& rings, const Spectral_slot owner,
                   const Spectral_slot u, const Spectral_slot v, const Corners& t) const
  {
    if(owner == u || owner == v)
      return false;
    bool result = false;
    for_each_owned(rings, owner, [&](const Spectral_slot a, const Spectral_slot b) {
      if(result || a == u || a == v || b == u || b == v)
        return;
      const Corners other{{{owner, points[owner]}, {a, points[a]}, {b, points[b]}}};
      if(!triangles_intersect(t, other))
        return;
      result = true;
      for(const Corners& old : m_old)
        if(triangles_intersect(old, other))
          result = false;
    });
    return result;
  }

  Spectral_geometry::internal::Box_tree m_tree;
  std::vector<Corners> m_old, m_new; // scratch
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_CROSSING_GUARD_H
