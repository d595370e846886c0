// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_OPTIONAL_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_OPTIONAL_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/version.h>

#if CGAL_VERSION_NR >= 1060000900
#include <optional>
#else
#include <boost/optional.hpp>
#endif

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// The optional of `GetCost` and `GetPlacement`: Boost's before CGAL 6, that of the standard since.
#if CGAL_VERSION_NR >= 1060000900
template <class T>
using Spectral_optional = std::optional<T>;
#else
template <class T>
using Spectral_optional = boost::optional<T>;
#endif

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_OPTIONAL_H
