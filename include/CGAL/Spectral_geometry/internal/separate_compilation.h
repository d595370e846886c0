// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEPARATE_COMPILATION_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEPARATE_COMPILATION_H

// The package is header-only. A program of many source files can define CGAL_SPECTRAL_GEOMETRY_COMPILED in all of them and
// include <CGAL/Spectral_geometry/compile.h> in one: the eigensolvers, the search of closest points, edge flips, relocation,
// fitted operators and the maps between shapes, which depend on no template parameter, are then compiled once and only declared elsewhere.
#ifdef CGAL_SPECTRAL_GEOMETRY_COMPILED
#define CGAL_SPECTRAL_GEOMETRY_INLINE
#else
#define CGAL_SPECTRAL_GEOMETRY_INLINE inline
#endif

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SEPARATE_COMPILATION_H
