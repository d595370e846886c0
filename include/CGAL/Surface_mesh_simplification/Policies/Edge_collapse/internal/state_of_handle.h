// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_STATE_OF_HANDLE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_STATE_OF_HANDLE_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// What a handle stands for. Throws `std::logic_error` where it was made by default or has been moved from.
template <class State>
State& state_of_handle(const std::shared_ptr<State>& state, const char* const handle)
{
  if(!state)
    throw std::logic_error(std::string(handle) +
                           ": made by default or moved from, it stands for nothing; take one from "
                           "Spectral_policies, or copy instead of moving.");
  return *state;
}

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_STATE_OF_HANDLE_H
