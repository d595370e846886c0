// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_IS_GIVEN_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_IS_GIVEN_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Named_function_parameters.h>

#include <type_traits>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// Whether a named parameter was given: is_given<NamedParameters>(internal_np::filter_t()).
template <class NamedParameters, class Tag>
constexpr bool is_given(Tag)
{
  return !std::is_same<typename internal_np::Get_param<typename NamedParameters::base, Tag>::type,
                       internal_np::Param_not_found>::value;
}

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_IS_GIVEN_H
