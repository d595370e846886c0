// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_FILTER_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_FILTER_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_handle.h>

#include <CGAL/Surface_mesh_simplification/internal/Common.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * A filter for the named parameter `filter` of `edge_collapse()`. It refuses a collapse that would
 * move a vertex of `Spectral_options::kept_vertices` or merge two of them, or put a face through
 * another, if `Spectral_options::keep_free_of_self_intersections` is set.
 *
 * `Spectral_placement` never proposes such a collapse. A placement wrapped around it may:
 * `Constrained_placement` takes the first end with a constrained edge, whatever is at the other.
 * `spectral_edge_collapse()` uses this filter by itself; with `edge_collapse()` pass
 * `.filter(spectral.filter())`. Made by `Spectral_policies::filter()`.
 *
 * \cgalModels{PlacementFilter}
 */
template <class State, class UserFilter = internal::Dummy_filter>
class Spectral_filter
{
public:
  /// made by `Spectral_policies::filter()`
  explicit Spectral_filter(std::shared_ptr<State> state, UserFilter user = UserFilter())
    : m_state(std::move(state))
    , m_user(std::move(user))
  {}

  /// returns the placement, or none if it is refused
  template <class Profile>
  internal::Spectral_optional<typename Profile::Point>
  operator()(const Profile& profile,
             const internal::Spectral_optional<typename Profile::Point>& placement) const
  {
    if(!internal::state_of_handle(m_state, "Spectral_filter").lets_through(profile, placement))
      return internal::Spectral_optional<typename Profile::Point>();
    return m_user(profile, placement);
  }

private:
  std::shared_ptr<State> m_state;
  UserFilter m_user;
};

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_FILTER_H
