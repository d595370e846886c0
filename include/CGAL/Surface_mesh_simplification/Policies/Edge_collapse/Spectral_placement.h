// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_PLACEMENT_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_PLACEMENT_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_handle.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * The placement, a handle on the state of `Spectral_policies`: the point on the edge where the cost
 * is least (section 3.4 of the paper), its midpoint, or a point near the edge (appendix A). There
 * is none if the collapse is topologically impossible, or if every position makes a triangle
 * without area, moves a vertex that is to be kept or puts a face through another.
 *
 * \cgalModels{GetPlacement}
 *
 * Made by `Spectral_policies::get_placement()`. May be wrapped, by `Constrained_placement` for
 * instance: the cost is then evaluated at the point that the wrapper returns.
 */
template <class State>
class Spectral_placement
{
public:
  /// a handle on nothing, to be assigned to; a call throws `std::logic_error`
  Spectral_placement() = default;
  /// a handle on `state`
  explicit Spectral_placement(std::shared_ptr<State> state)
    : m_state(std::move(state))
  {}

  /// returns the best point for `profile`, or none.
  template <class Profile>
  auto operator()(const Profile& profile) const
  {
    return internal::state_of_handle(m_state, "Spectral_placement").placement(profile);
  }

private:
  std::shared_ptr<State> m_state;
};

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_PLACEMENT_H
