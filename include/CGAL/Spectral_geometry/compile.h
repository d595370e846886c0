// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_COMPILE_H
#define CGAL_SPECTRAL_GEOMETRY_COMPILE_H

/*!
\file
\brief for the one source file that compiles what `CGAL_SPECTRAL_GEOMETRY_COMPILED` leaves out of
all others: the long functions of `CGAL::Spectral_geometry` that depend on no mesh type. Without
that macro nobody needs this file.
`<CGAL/Surface_mesh_simplification/compile_spectral.h>` has this and the collapse loop.
*/

#if defined(CGAL_SPECTRAL_GEOMETRY_COMPILED) && \
    defined(CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEPARATE_COMPILATION_H)
#error "Include <CGAL/Spectral_geometry/compile.h> before every other header of the package."
#endif
#define CGAL_SPECTRAL_COMPILE_GEOMETRY

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/filtered_signals.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>
#include <CGAL/Spectral_geometry/relocation.h>

#endif // CGAL_SPECTRAL_GEOMETRY_COMPILE_H
