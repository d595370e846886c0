// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_VECTOR_UNITS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_VECTOR_UNITS_H

#include <CGAL/Spectral_geometry/internal/basics.h>

// Vectors of four doubles are a language extension of GCC and Clang on every target; other
// compilers do without. On x86_64 the inner loops are compiled twice, for the baseline and for wide
// vector units. The choice is made at run time: a build without any -m flag uses the units that the
// machine has.
#if(defined(__GNUC__) || defined(__clang__)) && !defined(CGAL_SPECTRAL_NO_VECTOR_EXTENSION)
#define CGAL_SPECTRAL_VECTOR_EXTENSION 1
#define CGAL_SPECTRAL_INLINE inline __attribute__((always_inline))
#define CGAL_SPECTRAL_INLINE_LAMBDA __attribute__((always_inline))
#ifdef __x86_64__
#define CGAL_SPECTRAL_DISPATCH 1
#endif
#else
#define CGAL_SPECTRAL_INLINE inline
#define CGAL_SPECTRAL_INLINE_LAMBDA
#endif

#include <boost/align/aligned_allocator.hpp>

namespace CGAL::Spectral_geometry::internal {

/// In bytes: a row of numbers begins with one.
constexpr std::size_t cache_line = 64;

/// Numbers that begin with a cache line. A vector register that is loaded across the end of one
/// costs two loads.
using Aligned_buffer = std::vector<double, boost::alignment::aligned_allocator<double, cache_line>>;

#ifdef CGAL_SPECTRAL_VECTOR_EXTENSION
/// Four doubles at any address, or two where wide units are missing: there GCC makes vectors of
/// four slower by a factor of fifteen. They are never passed or returned by value: that ABI would
/// depend on -m flags. Nor are they copied by memcpy: GCC splits the copy into halves for the
/// baseline before the variant for wide units sees it (five times slower).
typedef double Four_doubles __attribute__((vector_size(32), aligned(8), may_alias));
typedef double Two_doubles __attribute__((vector_size(16), aligned(8), may_alias));
#endif

#ifdef CGAL_SPECTRAL_DISPATCH
/// Whether the machine has them; a test may say that it has not.
inline bool& has_wide_units()
{
  static bool result = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return result;
}

// Everything that f calls is inlined as well; on Clang, only what is marked CGAL_SPECTRAL_INLINE.
template <class Function>
__attribute__((flatten, target("avx2,fma"))) void call_for_wide_units(const Function& f)
{
  f();
}
#endif

/// Calls `wide()`, compiled for AVX2 and FMA with all that it calls, where the machine has them,
/// otherwise `baseline()`.
template <class Wide, class Baseline>
void on_vector_units(const Wide& wide, const Baseline& baseline)
{
#ifdef CGAL_SPECTRAL_DISPATCH
  if(has_wide_units())
    return call_for_wide_units(wide);
#else
  (void)wide;
#endif
  baseline();
}

/// Compiles one function for both.
template <class Function>
void on_vector_units(const Function& f)
{
  on_vector_units(f, f);
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_VECTOR_UNITS_H
