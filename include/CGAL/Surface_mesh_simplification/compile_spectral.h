// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_COMPILE_SPECTRAL_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_COMPILE_SPECTRAL_H

/*!
\file
\brief for the one source file that compiles what `CGAL_SPECTRAL_GEOMETRY_COMPILED` leaves out of
all others.

Without that macro the package is header-only and nobody needs this file. If every source file of a
program defines it, everything that does not depend on a mesh type (operators, eigensolvers, the
collapse loop's evaluation of costs, relocation, maps) is only declared. Exactly one source file
must then include this header, which defines it. The CMake target
`Spectral_mesh_simplification::compiled` does both for you.
*/

#include <CGAL/Spectral_geometry/compile.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/compile_loop.h>

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_COMPILE_SPECTRAL_H
