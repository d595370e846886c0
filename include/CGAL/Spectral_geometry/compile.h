// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_COMPILE_H
#define CGAL_SPECTRAL_GEOMETRY_COMPILE_H

/*!
\file
\brief for the one source file that compiles what `CGAL_SPECTRAL_GEOMETRY_COMPILED` leaves out of
all others: every function of `CGAL::Spectral_geometry` that depends on no mesh type. Without that
macro nobody needs this file.
`<CGAL/Surface_mesh_simplification/compile_spectral.h>` has this and the collapse loop.
*/

#include <CGAL/Spectral_geometry/internal/surface/closest_point_interpolation_impl.h>
#include <CGAL/Spectral_geometry/internal/surface/cotangent_laplacian_impl.h>
#include <CGAL/Spectral_geometry/internal/numerics/eigenpairs_impl.h>
#include <CGAL/Spectral_geometry/internal/numerics/filtered_signals_impl.h>
#include <CGAL/Spectral_geometry/internal/numerics/functional_map_impl.h>
#include <CGAL/Spectral_geometry/internal/surface/operator_coefficients_impl.h>
#include <CGAL/Spectral_geometry/internal/relocation/relocation_impl.h>
#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect_impl.h>

#endif // CGAL_SPECTRAL_GEOMETRY_COMPILE_H
