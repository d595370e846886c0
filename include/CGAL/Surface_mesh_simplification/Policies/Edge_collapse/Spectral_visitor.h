// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_VISITOR_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_VISITOR_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_handle.h>

#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{
namespace internal {

/// Forwards the calls of `edge_collapse()` to a follower of the mesh, then to the user's visitor.
/// The run ends with this visitor, even when an exception leaves the loop.
template <class Follower, class UserVisitor>
class Following_visitor
{
public:
  Following_visitor(std::shared_ptr<Follower> follower, UserVisitor user)
    : m_follower(std::move(follower))
    , m_user(std::move(user))
  {}

  template <class TriangleMesh>
  void OnFinished(TriangleMesh& mesh)
  {
    m_follower->on_finished();
    m_run.reset();
    user().OnFinished(mesh);
  }

  template <class Profile>
  void OnStopConditionReached(const Profile& profile)
  {
    m_follower->on_stop_condition_reached();
    user().OnStopConditionReached(profile);
  }

  template <class Profile, class OptionalCost>
  void OnCollected(const Profile& profile, const OptionalCost& cost)
  {
    user().OnCollected(profile, cost);
  }

  template <class Profile, class OptionalCost, class Size>
  void OnSelected(const Profile& profile, const OptionalCost& cost, const Size initial,
                  const Size current)
  {
    m_follower->on_selected();
    user().OnSelected(profile, cost, initial, current);
  }

  template <class Profile, class OptionalPoint>
  void OnCollapsing(const Profile& profile, const OptionalPoint& placement)
  {
    m_follower->on_collapsing(profile, placement);
    user().OnCollapsing(profile, placement);
  }

  template <class Profile, class VertexDescriptor>
  void OnCollapsed(const Profile& profile, const VertexDescriptor& kept)
  {
    m_follower->on_collapsed(profile, kept);
    user().OnCollapsed(profile, kept);
  }

  template <class Profile>
  void OnNonCollapsable(const Profile& profile)
  {
    m_follower->on_non_collapsable();
    user().OnNonCollapsable(profile);
  }

protected:
  auto& user() { return std::ref(m_user).get(); } // what a reference_wrapper refers to

  std::shared_ptr<Follower> m_follower;
  std::shared_ptr<void> m_run;

private:
  UserVisitor m_user;
};

} // namespace internal

/*!
 * A handle on the state of `Spectral_policies` that keeps the state in step with the mesh and
 * forwards every call to the user's visitor.
 *
 * \cgalModels{EdgeCollapseSimplificationVisitor}
 *
 * Made by `Spectral_policies::visitor()`. The user's visitor is called before the state in
 * `OnStarted`, where it may still change the mesh, and after it everywhere else. It is copied, as
 * `edge_collapse()` itself copies visitors; pass `std::ref(my_visitor)` to share it.
 */
template <class State, class UserVisitor = internal::Dummy_visitor>
class Spectral_visitor : public internal::Following_visitor<State, UserVisitor>
{
public:
  /// a handle on `state` that also calls `user`
  explicit Spectral_visitor(std::shared_ptr<State> state, UserVisitor user = UserVisitor())
    : internal::Following_visitor<State, UserVisitor>(std::move(state), std::move(user))
  {}

  /// as in the concept; throws `std::invalid_argument` for another mesh than that of the policies
  template <class TriangleMesh>
  void OnStarted(TriangleMesh& mesh)
  {
    this->user().OnStarted(mesh);
    this->m_run = internal::state_of_handle(this->m_follower, "Spectral_visitor").on_started(mesh);
  }
};

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_VISITOR_H
