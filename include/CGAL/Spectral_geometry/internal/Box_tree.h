// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_BOX_TREE_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_BOX_TREE_H

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/*!
 * A binary tree of boxes, one leaf for each item, in which single boxes change: O(log n) each, and which is asked for what is near. CGAL's AABB tree and Boost's
 * R-tree would be built anew or restructured at every collapse; here leaves stay where they are, along a Morton curve through
 * the first boxes, as what is merged lies side by side.
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
    m_nodes.assign(2 * m_first_leaf, Box());
    m_item.resize(n);
    m_leaf.resize(n);
    const std::vector<std::pair<std::uint64_t, std::uint32_t>> order = along_curve(boxes);
    for(std::size_t i = 0; i < n; ++i) {
      m_item[i] = order[i].second;
      m_leaf[m_item[i]] = std::uint32_t(m_first_leaf + i);
      m_nodes[m_first_leaf + i] = boxes[m_item[i]];
    }
    for(std::size_t node = m_first_leaf; node-- > 1;)
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

  /// Whether `found(item)` is true for an item whose box meets this one; looks no further then.
  template <class Found>
  bool any(const Box& box, const Found& found) const
  {
    return !is_empty() && any_below(1, box, found);
  }

  /// Calls `visit(item)` for items whose boxes are nearer to `p` than the root of `bound`, which `visit` lowers; near boxes first.
  template <class Visit>
  void visit_near(const Eigen::Vector3d& p, const double& bound, const Visit& visit) const
  {
    if(!is_empty() && m_nodes[1].squaredExteriorDistance(p) < bound)
      visit_near_below(1, p, bound, visit);
  }

private:
  template <class Visit>
  void visit_near_below(const std::size_t node, const Eigen::Vector3d& p, const double& bound,
                        const Visit& visit) const
  {
    if(node >= m_first_leaf)
      return visit(std::size_t(m_item[node - m_first_leaf]));
    const double left = m_nodes[2 * node].squaredExteriorDistance(p),
                 right = m_nodes[2 * node + 1].squaredExteriorDistance(p);
    const std::size_t nearer = 2 * node + (right < left);
    if((std::min)(left, right) < bound)
      visit_near_below(nearer, p, bound, visit);
    if((std::max)(left, right) < bound)
      visit_near_below(nearer ^ 1, p, bound, visit);
  }

  template <class Found>
  bool any_below(const std::size_t node, const Box& box, const Found& found) const
  {
    if(!m_nodes[node].intersects(box))
      return false;
    if(node >= m_first_leaf)
      return found(std::size_t(m_item[node - m_first_leaf]));
    return any_below(2 * node, box, found) || any_below(2 * node + 1, box, found);
  }

  static std::uint64_t spread(std::uint64_t x) // two zeros before each of 21 bits
  {
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
  }

  static std::vector<std::pair<std::uint64_t, std::uint32_t>> along_curve(const std::vector<Box>& boxes)
  {
    Box all;
    for(const Box& box : boxes)
      all.extend(box);
    const double extent = all.isEmpty() ? 0. : all.sizes().maxCoeff();
    const double scale = extent > 0 ? double((1 << 21) - 1) / extent : 0.;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(boxes.size());
    for(std::size_t i = 0; i < boxes.size(); ++i) {
      std::uint64_t code = 0;
      if(!boxes[i].isEmpty())
        for(int c = 0; c < 3; ++c)
          code |= spread(std::uint64_t(scale * (boxes[i].center()[c] - all.min()[c]))) << c;
      order[i] = {code, std::uint32_t(i)};
    }
    std::sort(order.begin(), order.end());
    return order;
  }

  std::size_t m_first_leaf = 0; // node i has the children 2 i and 2 i + 1; the root is 1
  std::vector<Box> m_nodes;
  std::vector<std::uint32_t> m_item, m_leaf; // of a leaf, from the first; of an item
};

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_BOX_TREE_H
