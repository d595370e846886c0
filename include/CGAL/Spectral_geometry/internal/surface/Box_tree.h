// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_BOX_TREE_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_BOX_TREE_H

#include <CGAL/Spectral_geometry/internal/basics.h>

#include <numeric>

namespace CGAL::Spectral_geometry::internal {

/*!
 * A binary tree of boxes for proximity queries, with one leaf for each item. Changing a single box
 * takes O(log n). CGAL's AABB tree and Boost's R-tree would be built anew or restructured at every
 * collapse; here leaves stay where the first boxes put them. Boxes are halved by the median of
 * their centres along the longest side, however unevenly the centres lie.
 */
class Box_tree
{
public:
  using Box = Eigen::AlignedBox3d;

  bool is_empty() const { return m_nodes.empty(); }

  /// An empty box is met by nothing.
  void build(const std::vector<Box>& boxes)
  {
    const std::size_t n = boxes.size();
    for(m_first_leaf = 1; m_first_leaf < n;)
      m_first_leaf *= 2;
    m_nodes.assign(m_first_leaf + n + 1, Box());
    m_item.resize(n);
    m_leaf.resize(n);
    std::iota(m_item.begin(), m_item.end(), 0u);
    std::vector<Eigen::Vector3d> centres;
    centres.reserve(n);
    for(const Box& box : boxes)
      centres.push_back(box.isEmpty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : box.center());
    halve(0, m_first_leaf, centres);
    for(std::size_t i = 0; i < n; ++i) {
      m_leaf[m_item[i]] = std::uint32_t(m_first_leaf + i);
      m_nodes[m_first_leaf + i] = boxes[m_item[i]];
    }
    for(std::size_t node = (std::min)(m_first_leaf, m_nodes.size() / 2); node-- > 1;)
      m_nodes[node] = m_nodes[2 * node].merged(m_nodes[2 * node + 1]);
  }

  /// Replaces the box of an item.
  void update(const std::size_t item, const Box& box)
  {
    std::size_t node = m_leaf[item];
    m_nodes[node] = box;
    while(node > 1) {
      node /= 2;
      const Box both = m_nodes[2 * node].merged(m_nodes[2 * node + 1]);
      if(both.min() == m_nodes[node].min() && both.max() == m_nodes[node].max())
        break;
      m_nodes[node] = both;
    }
  }

  /// Whether `found(item)` is true for an item below `node` whose box meets this one. Stops at the
  /// first such item.
  template <class Found>
  bool any(const Box& box, const Found& found, const std::size_t node = 1) const
  {
    if(!m_nodes[node].intersects(box))
      return false;
    if(node >= m_first_leaf)
      return found(std::size_t(m_item[node - m_first_leaf]));
    return any(box, found, 2 * node) || any(box, found, 2 * node + 1);
  }

  /// Calls `visit(item)` for items below `node` whose boxes are nearer to `p` than the square root
  /// of `bound`, which `visit` lowers; near boxes first. If the tree has only one item, its box
  /// is not tested.
  template <class Visit>
  void visit_near(const Eigen::Vector3d& p, const double& bound, const Visit& visit,
                  const std::size_t node = 1) const
  {
    if(node >= m_first_leaf)
      return visit(std::size_t(m_item[node - m_first_leaf]));
    const double left = m_nodes[2 * node].squaredExteriorDistance(p),
                 right = m_nodes[2 * node + 1].squaredExteriorDistance(p);
    const std::size_t nearer = 2 * node + (right < left);
    if((std::min)(left, right) < bound)
      visit_near(p, bound, visit, nearer);
    if((std::max)(left, right) < bound)
      visit_near(p, bound, visit, nearer ^ 1);
  }

private:
  // Orders the items of `places` leaves, a power of two, the first of which is `begin`.
  void halve(const std::size_t begin, const std::size_t places,
             const std::vector<Eigen::Vector3d>& centres)
  {
    if(places < 2)
      return;
    const std::size_t middle = begin + places / 2, end = (std::min)(begin + places, m_item.size());
    if(middle < end) {
      Box all;
      for(std::size_t i = begin; i < end; ++i)
        all.extend(centres[m_item[i]]);
      Eigen::Index side;
      all.sizes().maxCoeff(&side);
      const auto at = [this](const std::size_t i) { return m_item.begin() + std::ptrdiff_t(i); };
      std::nth_element(
          at(begin), at(middle), at(end), [&](const std::uint32_t a, const std::uint32_t b) {
            return std::make_pair(centres[a][side], a) < std::make_pair(centres[b][side], b);
          });
      halve(middle, places / 2, centres);
    }
    halve(begin, places / 2, centres);
  }

  std::size_t m_first_leaf = 0; // node i has the children 2 i and 2 i + 1; the root is 1
  std::vector<Box> m_nodes;
  std::vector<std::uint32_t> m_item, m_leaf; // of a leaf, from the first; of an item
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_BOX_TREE_H
