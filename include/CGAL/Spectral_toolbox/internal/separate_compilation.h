// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_INTERNAL_SEPARATE_COMPILATION_H
#define CGAL_SPECTRAL_TOOLBOX_INTERNAL_SEPARATE_COMPILATION_H

// The toolbox is header-only, whether the kernel is compiled apart or not. A program that defines
// CGAL_SPECTRAL_TOOLBOX_COMPILED in all of its source files includes
// <CGAL/Spectral_toolbox/compile.h> in one of them.
#ifdef CGAL_SPECTRAL_TOOLBOX_COMPILED
#define CGAL_SPECTRAL_TOOLBOX_INLINE
#else
#define CGAL_SPECTRAL_TOOLBOX_INLINE inline
#endif

#endif // CGAL_SPECTRAL_TOOLBOX_INTERNAL_SEPARATE_COMPILATION_H
