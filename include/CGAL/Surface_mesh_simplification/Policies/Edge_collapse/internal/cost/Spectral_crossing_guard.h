// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_CROSSING_GUARD_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_CROSSING_GUARD_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_fields.h>

#include <CGAL/Spectral_geometry/internal/surface/Box_tree.h>
#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>

namespace CGAL::Surface_mesh_simplification::internal {

/*!
 * Tells whether a collapse would make triangles intersect that did not before: ears, mouths and
 * hooves are thin sheets, and their two sides are approximated independently.
 *
 * Every triangle belongs to the smallest of its slots. A tree of boxes has one leaf for the
 * triangles of each slot. Before set_geometry() there is no tree, and nothing crosses.
 *
 * `Fans`, the connectivity: `for_triangles(w, f)` calls f(a, b) for each triangle (w, a, b),
 * `for_neighbours(w, f)` f(a) for each neighbour of w.
 */
class Spectral_crossing_guard
{
public:
  using Points = std::vector<Eigen::Vector3d>;

  template <class Fans>
  void set_geometry(const Points& points, const Fans& fans)
  {
    std::vector<Box> boxes;
    for(const Eigen::Vector3d& p : points)
      boxes.emplace_back(p);
    m_tree.build(boxes); // by the points: what belongs to a slot may be nothing, for the time being
    for(std::size_t w = 0; w < points.size(); ++w)
      m_tree.update(w, box_of_owned(points, fans, Spectral_slot(w)));
    m_refusals = points.size() / 20;
  }

  /// Whether, with both ends at x, the remaining triangles of u and v would cross others that no
  /// triangle around u and v crosses now. Sheets that coincide all over, as in scans, must not
  /// block a run: beside triangles that already cross, the number of refusals is limited.
  template <class Fans>
  bool crosses(const Points& points, const Fans& fans, const Spectral_slot u, const Spectral_slot v,
               const Eigen::Vector3d& x)
  {
    if(m_tree.is_empty())
      return false;
    collect(points, fans, u, v, x);
    const bool fan = fan_intersects(m_new.data(), m_new.size());
    if((!fan || old_intersect()) && !meet_others(points, fans, u, v, m_new, m_old))
      return false;
    m_boxes.clear();
    for(const Corners& t : m_old)
      m_boxes.push_back(box_of(t));
    if(!old_intersect() && !meet_others(points, fans, u, v, m_old, {}))
      return true;
    if(m_refusals == 0)
      return false;
    --m_refusals;
    return true;
  }

  /// Follows a collapse, once fans and points have.
  template <class Fans>
  void commit(const Points& points, const Fans& fans, const Spectral_slot removed,
              const Spectral_slot kept)
  {
    if(m_tree.is_empty())
      return;
    m_tree.update(removed, Box());
    m_tree.update(kept, box_of_owned(points, fans, kept));
    fans.for_neighbours(
        kept, [&](const Spectral_slot w) { m_tree.update(w, box_of_owned(points, fans, w)); });
  }

private:
  using Box = Spectral_geometry::internal::Box_tree::Box;
  using Corners = Spectral_geometry::internal::Corners;

  static bool triangles_intersect(const Corners& s, const Corners& t)
  {
    return box_of(s).intersects(box_of(t)) &&
           Spectral_geometry::internal::triangles_intersect(s, t);
  }

  // Whether two triangles of those around u and v intersect, as they are.
  bool old_intersect() const
  {
    for(std::size_t i = 0; i < m_old_of_u; ++i)
      for(std::size_t j = m_old_of_u; j < m_old.size(); ++j)
        if(triangles_intersect(m_old[i], m_old[j]))
          return true;
    return fan_intersects(m_old.data(), m_old_of_u) ||
           fan_intersects(m_old.data() + m_old_of_u, m_old.size() - m_old_of_u);
  }

  // Whether two of the triangles around a vertex, the first corner of each, intersect. They meet
  // outside of the vertex only if their directions from it do. In a large fan a tree of boxes of
  // these directions finds the pairs.
  static bool fan_intersects(const Corners* fan, const std::size_t size)
  {
    if(size <= largest_fan_of_pairs) {
      for(std::size_t i = 0; i < size; ++i)
        for(std::size_t j = i + 1; j < size; ++j)
          if(triangles_intersect(fan[i], fan[j]))
            return true;
      return false;
    }
    std::vector<Box> boxes(size);
    for(std::size_t i = 0; i < size; ++i)
      boxes[i] = box_of_directions(fan[i]);
    Spectral_geometry::internal::Box_tree tree;
    tree.build(boxes);
    for(std::size_t i = 0; i < size; ++i)
      if(tree.any(boxes[i], [&](const std::size_t j) {
           return i < j && triangles_intersect(fan[i], fan[j]);
         }))
        return true;
    return false;
  }

  static constexpr std::size_t largest_fan_of_pairs = 64;

  // Bounds the unit vectors from the first corner into the triangle.
  static Box box_of_directions(const Corners& t)
  {
    const Eigen::Vector3d& x = t[0].point;
    const Eigen::Vector3d a = (t[1].point - x).normalized(), b = (t[2].point - x).normalized();
    // An arc leaves its chord by at most 1 - cos(angle / 2).
    double rise = 1 - (a + b).norm() / 2;
    if(!(a.squaredNorm() > 0.5 && b.squaredNorm() > 0.5))
      rise = 2;
    Box box(a.cwiseMin(b), a.cwiseMax(b));
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(rise + 1e-12);
    return Box(box.min() - margin, box.max() + margin);
  }

  template <class Fans, class Function>
  static void for_each_owned(const Fans& fans, const Spectral_slot w, const Function& function)
  {
    fans.for_triangles(w, [&](const Spectral_slot a, const Spectral_slot b) {
      if(w < a && w < b)
        function(a, b);
    });
  }

  template <class Fans>
  static Box box_of_owned(const Points& points, const Fans& fans, const Spectral_slot w)
  {
    Box box;
    for_each_owned(fans, w, [&](const Spectral_slot a, const Spectral_slot b) {
      box.extend(points[w]).extend(points[a]).extend(points[b]);
    });
    return box;
  }

  // Collects the triangles of both ends: all of them now, and those left after the collapse, with
  // their boxes.
  template <class Fans>
  void collect(const Points& points, const Fans& fans, const Spectral_slot u, const Spectral_slot v,
               const Eigen::Vector3d& x)
  {
    m_old.clear();
    m_new.clear();
    m_boxes.clear();
    constexpr std::size_t merged = (std::numeric_limits<std::size_t>::max)();
    for(const Spectral_slot c : {u, v}) {
      fans.for_triangles(c, [&](const Spectral_slot a, const Spectral_slot b) {
        const bool shared = a == u || a == v || b == u || b == v;
        if(shared && c == v)
          return;
        m_old.push_back(Corners{{{c, points[c]}, {a, points[a]}, {b, points[b]}}});
        if(shared)
          return;
        m_new.push_back(Corners{{{merged, x}, {a, points[a]}, {b, points[b]}}});
        // Around an end that stays where it is none is new.
        m_boxes.push_back(x == points[c] ? Box() : box_of(m_new.back()));
      });
      if(c == u)
        m_old_of_u = m_old.size();
    }
  }

  // Whether one of the triangles, whose boxes are m_boxes, meets one that is not around u or v, and
  // that none of `known` meets. One walk through the tree for all.
  template <class Fans>
  bool meet_others(const Points& points, const Fans& fans, const Spectral_slot u,
                   const Spectral_slot v, const std::vector<Corners>& triangles,
                   const std::vector<Corners>& known) const
  {
    Box all;
    for(const Box& box : m_boxes)
      all.extend(box);
    return !all.isEmpty() && m_tree.any(all, [&](const std::size_t owner) {
      bool result = false;
      if(owner != u && owner != v)
        for_each_owned(
            fans, Spectral_slot(owner), [&](const Spectral_slot a, const Spectral_slot b) {
              if(result || a == u || a == v || b == u || b == v)
                return;
              const Corners other{{{owner, points[owner]}, {a, points[a]}, {b, points[b]}}};
              const Box box = box_of(other);
              for(std::size_t i = 0; i < triangles.size() && !result && box.intersects(all); ++i)
                result = m_boxes[i].intersects(box) &&
                         Spectral_geometry::internal::triangles_intersect(triangles[i], other);
              for(std::size_t i = 0; i < known.size() && result; ++i)
                result = !triangles_intersect(known[i], other);
            });
      return result;
    });
  }

  Spectral_geometry::internal::Box_tree m_tree;
  std::size_t m_refusals = 0; // that are left, beside triangles that cross already
  std::vector<Box> m_boxes;   // of the triangles that are looked at, empty for those that are not
  // Scratch: the triangles around u, then those of v alone; what is left of them.
  std::vector<Corners> m_old, m_new;
  std::size_t m_old_of_u = 0;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_CROSSING_GUARD_H
