// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_COMPILE_H
#define CGAL_SPECTRAL_TOOLBOX_COMPILE_H

/*!
\file
\brief for the one source file that compiles what `CGAL_SPECTRAL_TOOLBOX_COMPILED` leaves out of all
others: every function of the toolbox that depends on no mesh type. Without that macro nobody needs
this file. The CMake target `Spectral_mesh_simplification::toolbox` is that, ready made.
*/

#include <CGAL/Spectral_toolbox/internal/curvature_coefficients_impl.h>
#include <CGAL/Spectral_toolbox/internal/fitted_operators_impl.h>
#include <CGAL/Spectral_toolbox/internal/functional_map_estimation_impl.h>
#include <CGAL/Spectral_toolbox/internal/hierarchical_functional_maps_impl.h>
#include <CGAL/Spectral_toolbox/internal/intrinsic_delaunay_impl.h>
#include <CGAL/Spectral_toolbox/internal/mesh_diagnosis_impl.h>
#include <CGAL/Spectral_toolbox/internal/vertex_maps_impl.h>

#endif // CGAL_SPECTRAL_TOOLBOX_COMPILE_H
