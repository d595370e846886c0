// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_HANDLE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_HANDLE_H

#include <CGAL/Spectral_geometry/internal/basics.h>

#include <CGAL/version.h>

#if CGAL_VERSION_NR < 1060000900
#include <boost/optional.hpp>
#endif

namespace CGAL::Surface_mesh_simplification::internal {

/// The optional of `GetCost` and `GetPlacement`: Boost's before CGAL 6, that of the standard since.
#if CGAL_VERSION_NR >= 1060000900
template <class T>
using Spectral_optional = std::optional<T>;
#else
template <class T>
using Spectral_optional = boost::optional<T>;
#endif

/// What a handle stands for. Throws `std::logic_error` where it was made by default or has been
/// moved from.
template <class State>
State& state_of_handle(const std::shared_ptr<State>& state, const char* const handle)
{
  if(!state)
    throw std::logic_error(std::string(handle) +
                           ": made by default or moved from, it stands for nothing; take one from "
                           "Spectral_policies, or copy instead of moving.");
  return *state;
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_HANDLE_H
