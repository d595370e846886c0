// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_COMPILE_H
#define CGAL_SPECTRAL_TOOLBOX_COMPILE_H

/*!
\file
\brief for the one source file that compiles what `CGAL_SPECTRAL_TOOLBOX_COMPILED` leaves out of all
others: every function of the toolbox that depends on no mesh type. Without that macro nobody needs
this file. The CMake target `Spectral_mesh_simplification::toolbox` does it for you.
*/

#if defined(CGAL_SPECTRAL_TOOLBOX_COMPILED) && \
    defined(CGAL_SPECTRAL_TOOLBOX_INTERNAL_SEPARATE_COMPILATION_H)
#error "Include <CGAL/Spectral_toolbox/compile.h> before every other header of the package."
#endif
#define CGAL_SPECTRAL_COMPILE_TOOLBOX

#include <CGAL/Spectral_toolbox/curvature_coefficients.h>
#include <CGAL/Spectral_toolbox/fitted_operators.h>
#include <CGAL/Spectral_toolbox/functional_map_estimation.h>
#include <CGAL/Spectral_toolbox/hierarchical_functional_maps.h>
#include <CGAL/Spectral_toolbox/intrinsic_delaunay.h>
#include <CGAL/Spectral_toolbox/mesh_diagnosis.h>
#include <CGAL/Spectral_toolbox/vertex_maps.h>

#endif // CGAL_SPECTRAL_TOOLBOX_COMPILE_H
