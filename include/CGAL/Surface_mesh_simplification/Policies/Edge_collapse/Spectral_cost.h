// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_COST_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_COST_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_handle.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * The cost, a handle on the state of `Spectral_policies`: the change of E (Eq. 2 of the paper) when
 * an edge is collapsed to the given placement, plus the term of `Spectral_options::shape`, for the
 * input scaled to unit area. It may be negative.
 *
 * The costs in CGAL's queue, and hence those passed to a stop predicate, may be out of date: an
 * edge whose cost is far above that of recent collapses keeps this cost after a collapse nearby,
 * and is evaluated again at the head of the queue. They are estimates where the metric sees
 * mixtures, see `Spectral_options::number_of_mixtures`. A predicate that needs the error itself
 * asks the policies, as `Spectral_error_stop_predicate` does.
 *
 * \cgalModels{GetCost}
 *
 * Made by `Spectral_policies::get_cost()`. Throws `std::logic_error` unless the visitor of the same
 * policies takes part in the run.
 */
template <class State>
class Spectral_cost
{
public:
  /// a handle on nothing, to be assigned to; a call throws `std::logic_error`
  Spectral_cost() = default;
  /// a handle on `state`
  explicit Spectral_cost(std::shared_ptr<State> state)
    : m_state(std::move(state))
  {}

  /// returns the cost of collapsing to the point `placement`; the largest finite number if there is
  /// no point, if the point would move a vertex that is to be kept, or if the cost is more than a
  /// `float` can hold.
  template <class Profile, class OptionalPoint>
  auto operator()(const Profile& profile, const OptionalPoint& placement) const
  {
    return internal::state_of_handle(m_state, "Spectral_cost").cost(profile, placement);
  }

private:
  std::shared_ptr<State> m_state;
};

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_COST_H
