// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COMPILE_LOOP_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COMPILE_LOOP_H

// All definitions of the collapse loop that depend on no mesh type; those of Spectral_geometry are
// in its own compile.h.
#define CGAL_SPECTRAL_COMPILE_LOOP
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_collapse_core.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/stages/Quadric_collapses.h>

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COMPILE_LOOP_H
