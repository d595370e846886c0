// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_CANDIDATES_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_CANDIDATES_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_rings.h>

#include <CGAL/assertions.h>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// The best way found to collapse an edge (u, other) with u < other.
///
/// The weight belongs to the slot `other`, never to an end of a halfedge: the direction in which CGAL
/// presents the same edge can change after a collapse nearby.
struct Spectral_candidate
{
  Spectral_slot other = null_spectral_slot;
  std::uint32_t version = 0; ///< the number of commits that it has seen
  bool collapsible = false;
  std::uint32_t task = 0; ///< not 0: being evaluated, by the task of the core that has this number, less 1
  bool deferred = false;  ///< something near has changed, but it cost too much to be worth a look
  double cost = std::numeric_limits<double>::infinity();
  double weight = 0; ///< f_x = (1 - weight) f_u + weight f_other
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

/// The candidates of all edges, each kept with the smaller of its slots: a lookup runs through about
/// three entries that lie side by side.
class Spectral_candidates
{
public:
  void resize(const std::size_t n) { m_lists.assign(n, {}); }

  void clear()
  {
    for(auto& list : m_lists)
      list.clear();
    ++m_version;
  }

  std::uint32_t version() const { return m_version; }

  const Spectral_candidate* find(Spectral_slot u, Spectral_slot v) const
  {
    if(v < u)
      std::swap(u, v);
    for(const Spectral_candidate& c : m_lists[u])
      if(c.other == v)
        return &c;
    return nullptr;
  }

  /// The place of the candidate of an edge among those of u, its smaller slot. Where there is none yet an empty one is put
  /// in, to be evaluated when somebody asks for it. A place holds until a candidate of u is forgotten.
  std::size_t place(const Spectral_slot u, const Spectral_slot other)
  {
    CGAL_precondition(u < other);
    auto& list = m_lists[u];
    std::size_t i = 0;
    while(i < list.size() && list[i].other != other)
      ++i;
    if(i == list.size()) {
      list.emplace_back();
      list.back().other = other;
      list.back().version = m_version - 1;
      list.back().deferred = true;
    }
    return i;
  }

  /// Keeps the candidate at a place as it is if it costs more than `bound`, and says whether it does.
  bool defer(const Spectral_slot u, const std::size_t place, const double bound)
  {
    Spectral_candidate& c = m_lists[u][place];
    if(!c.collapsible || !(c.cost > bound))
      return false;
    c.version = m_version;
    return c.deferred = true;
  }

  /// Replaces the candidate at a place.
  const Spectral_candidate& put(const Spectral_slot u, const std::size_t place,
                                const Spectral_candidate& candidate)
  {
    Spectral_candidate& c = m_lists[u][place];
    CGAL_precondition(c.other == candidate.other);
    c = candidate;
    c.version = m_version;
    return c;
  }

  /// Puts in or replaces the candidate of the edge (u, candidate.other), u being the smaller slot.
  const Spectral_candidate& insert(const Spectral_slot u, const Spectral_candidate& candidate)
  {
    return put(u, place(u, candidate.other), candidate);
  }

  /// Room for n candidates of u.
  void reserve(const Spectral_slot u, const std::size_t n) { m_lists[u].reserve(n); }

  void forget(const Spectral_slot u, const Spectral_slot v)
  {
    auto& list = m_lists[(std::min)(u, v)];
    const Spectral_slot other = (std::max)(u, v);
    list.erase(std::remove_if(list.begin(), list.end(),
                              [other](const Spectral_candidate& c) { return c.other == other; }),
               list.end());
  }

  /// A vertex is gone, and with it the candidates that are kept under it.
  void merge(const Spectral_slot removed)
  {
    std::vector<Spectral_candidate>().swap(m_lists[removed]);
    ++m_version;
  }

private:
  std::vector<std::vector<Spectral_candidate>> m_lists;
  std::uint32_t m_version = 0;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_CANDIDATES_H
