// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_COMPILE_H
#define CGAL_SPECTRAL_GEOMETRY_COMPILE_H

/*!
\file
\brief for the one source file that compiles what `CGAL_SPECTRAL_GEOMETRY_COMPILED` leaves out of all others.

Without that macro the package is header-only and this file is not needed. With it defined in every source file of a program,
`CGAL::Spectral_geometry::eigenpairs()`, `CGAL::Spectral_geometry::closest_point_interpolation()`,
`CGAL::Spectral_geometry::flip_edges()`, `CGAL::Spectral_geometry::relocate_positions()` and the functions of
`functional_map_estimation.h`, `hierarchical_functional_maps.h` and `vertex_maps.h` are only declared, and exactly one of
the source files includes this header, which defines them: each of the others compiles several seconds faster.
*/

#include <CGAL/Spectral_geometry/internal/closest_point_interpolation_impl.h>
#include <CGAL/Spectral_geometry/internal/edge_flips_impl.h>
#include <CGAL/Spectral_geometry/internal/eigenpairs_impl.h>
#include <CGAL/Spectral_geometry/internal/functional_map_estimation_impl.h>
#include <CGAL/Spectral_geometry/internal/hierarchical_functional_maps_impl.h>
#include <CGAL/Spectral_geometry/internal/relocation_impl.h>
#include <CGAL/Spectral_geometry/internal/triangles_intersect_impl.h>
#include <CGAL/Spectral_geometry/internal/vertex_maps_impl.h>

#endif // CGAL_SPECTRAL_GEOMETRY_COMPILE_H
