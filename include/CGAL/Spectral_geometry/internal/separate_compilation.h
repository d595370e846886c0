// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEPARATE_COMPILATION_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEPARATE_COMPILATION_H

// The package is header-only. A program can define CGAL_SPECTRAL_GEOMETRY_COMPILED in all of its
// source files and include <CGAL/Surface_mesh_simplification/compile_spectral.h> in one: what
// depends on no mesh type is then compiled there and only declared elsewhere.
#ifdef CGAL_SPECTRAL_GEOMETRY_COMPILED
#define CGAL_SPECTRAL_GEOMETRY_INLINE
#else
#define CGAL_SPECTRAL_GEOMETRY_INLINE inline
#endif

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEPARATE_COMPILATION_H
