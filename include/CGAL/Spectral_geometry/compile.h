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

#include <CGAL/Spectral_geometry/internal/maps/closest_point_interpolation_impl.h>
#include <CGAL/Spectral_geometry/internal/operators/cotangent_laplacian_impl.h>
#include <CGAL/Spectral_geometry/internal/operators/curvature_coefficients_impl.h>
#include <CGAL/Spectral_geometry/internal/eigenpairs/eigenpairs_impl.h>
#include <CGAL/Spectral_geometry/internal/eigenpairs/filtered_signals_impl.h>
#include <CGAL/Spectral_geometry/internal/operators/fitted_operators_impl.h>
#include <CGAL/Spectral_geometry/internal/maps/functional_map_estimation_impl.h>
#include <CGAL/Spectral_geometry/internal/maps/functional_map_impl.h>
#include <CGAL/Spectral_geometry/internal/maps/hierarchical_functional_maps_impl.h>
#include <CGAL/Spectral_geometry/internal/operators/intrinsic_delaunay_impl.h>
#include <CGAL/Spectral_geometry/internal/operators/mesh_diagnosis_impl.h>
#include <CGAL/Spectral_geometry/internal/operators/operator_coefficients_impl.h>
#include <CGAL/Spectral_geometry/internal/relocation/relocation_impl.h>
#include <CGAL/Spectral_geometry/internal/search/triangles_intersect_impl.h>
#include <CGAL/Spectral_geometry/internal/maps/vertex_maps_impl.h>

#endif // CGAL_SPECTRAL_GEOMETRY_COMPILE_H
