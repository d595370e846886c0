// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_CANCELLED_H
#define CGAL_SPECTRAL_GEOMETRY_CANCELLED_H

#include <CGAL/Spectral_geometry/internal/basics.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief is thrown when a progress callback has asked to stop.
class Cancelled : public std::runtime_error
{
public:
  Cancelled()
    : std::runtime_error("The computation was cancelled by the progress callback.")
  {}
};

/// @}

namespace internal {

/// Tells a progress callback, if there is one, which fraction is done; throws where it asks to
/// stop.
inline void report_to(const std::function<bool(double)>& progress, const double fraction)
{
  if(progress && !progress(fraction))
    throw Cancelled();
}

} // namespace internal

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_CANCELLED_H
