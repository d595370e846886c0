// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_CANDIDATES_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_CANDIDATES_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_rings.h>

#include <CGAL/assertions.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace CGAL::Surface_mesh_simplification::internal {

/// A way to collapse an edge (u,v): x replaces both, f_x = (1 - weight) f_u + weight f_v.
struct Spectral_sample
{
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double weight = 0;
  double cost = std::numeric_limits<double>::infinity();
};

/// The best way found to collapse an edge (u, other) with u < other.
///
/// The weight belongs to the slot `other`, never to an end of a halfedge: the direction in which CGAL
/// presents the same edge can change after a collapse nearby.
struct Spectral_candidate : Spectral_sample
{
  Spectral_slot other = null_spectral_slot;
  std::uint32_t version = 0; ///< the number of merges and of new runs that it has seen
  bool deferred = false; ///< of before a change nearby, or of fewer samples: evaluated when its turn comes
  bool at_another_point = false; ///< its best one would put a face through another

  bool collapsible() const { return std::isfinite(cost); }
};

/// The candidates of all edges, each kept with the smaller of its slots: a lookup runs through about
/// three entries that lie side by side. Long lists have an index.
class Spectral_candidates
{
public:
  /// None yet, for n slots.
  void reset(const std::size_t n)
  {
    m_lists = std::vector<List>(n);
    ++m_version;
  }

  std::uint32_t version() const { return m_version; }

  const Spectral_candidate* find(Spectral_slot u, Spectral_slot v) const
  {
    if(v < u)
      std::swap(u, v);
    const List& list = m_lists[u];
    const std::size_t i = list.find(v);
    return i < list.entries.size() ? &list.entries[i] : nullptr;
  }

  /// Keeps the candidate of an edge, u being its smaller slot, as it is if it costs more than `bound`, and says whether it does. Where
  /// there is none yet an empty one is put in, to be evaluated when somebody asks for it.
  bool defer(const Spectral_slot u, const Spectral_slot other, const double bound)
  {
    Spectral_candidate& c = find_or_add(u, other);
    if(!c.collapsible() || !(c.cost > bound))
      return false;
    c.version = m_version;
    return c.deferred = true;
  }

  /// Puts in or replaces the candidate of the edge (u, candidate.other), u being the smaller slot. May run side by side for edges
  /// that have one.
  const Spectral_candidate& insert(const Spectral_slot u, const Spectral_candidate& candidate)
  {
    Spectral_candidate& c = find_or_add(u, candidate.other);
    static_cast<Spectral_sample&>(c) =
        candidate; // not `other`, which is read on the way to the entries behind it
    c.deferred = candidate.deferred;
    c.at_another_point = candidate.at_another_point;
    c.version = m_version;
    return c;
  }

  /// Room for n candidates of u.
  void reserve(const Spectral_slot u, const std::size_t n) { m_lists[u].entries.reserve(n); }

  void forget(const Spectral_slot u, const Spectral_slot v)
  {
    List& list = m_lists[(std::min)(u, v)];
    const std::size_t i = list.find((std::max)(u, v));
    if(i < list.entries.size())
      list.erase(i);
  }

  /// A vertex is gone, and with it the candidates that are kept under it.
  void merge(const Spectral_slot removed)
  {
    m_lists[removed] = List();
    ++m_version;
  }

private:
  struct List
  {
    std::vector<Spectral_candidate> entries;
    std::unique_ptr<std::unordered_map<Spectral_slot, std::size_t>> index; // place by slot, of a long list

    static constexpr std::size_t longest_without_index = 64;

    // The place of a slot, or the number of entries.
    std::size_t find(const Spectral_slot other) const
    {
      if(index) {
        const auto found = index->find(other);
        return found == index->end() ? entries.size() : found->second;
      }
      std::size_t i = 0;
      while(i < entries.size() && entries[i].other != other)
        ++i;
      return i;
    }

    Spectral_candidate& add(const Spectral_slot other)
    {
      entries.emplace_back();
      entries.back().other = other;
      if(index)
        index->emplace(other, entries.size() - 1);
      else if(entries.size() > longest_without_index) {
        index = std::make_unique<std::unordered_map<Spectral_slot, std::size_t>>();
        for(std::size_t i = 0; i < entries.size(); ++i)
          index->emplace(entries[i].other, i);
      }
      return entries.back();
    }

    // The last entry takes the place.
    void erase(const std::size_t i)
    {
      if(index) {
        index->erase(entries[i].other);
        if(i + 1 < entries.size())
          (*index)[entries.back().other] = i;
      }
      entries[i] = entries.back();
      entries.pop_back();
    }
  };

  Spectral_candidate& find_or_add(const Spectral_slot u, const Spectral_slot other)
  {
    CGAL_precondition(u < other);
    List& list = m_lists[u];
    const std::size_t i = list.find(other);
    if(i < list.entries.size())
      return list.entries[i];
    Spectral_candidate& c = list.add(other);
    c.version = m_version - 1;
    c.deferred = true;
    return c;
  }

  std::vector<List> m_lists;
  std::uint32_t m_version = 0;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_CANDIDATES_H
