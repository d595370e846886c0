// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_LINEAR_ALGEBRA_PANEL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_LINEAR_ALGEBRA_PANEL_H

#include <CGAL/Spectral_geometry/internal/parallel/vector_units.h>

#include <Eigen/Core>

#include <cstddef>

namespace CGAL::Spectral_geometry::internal {

using Eigen::Index;

constexpr int panel_width = 8;

/// Eight vectors, n x 8 by rows, each row in one cache line.
class Panel
{
public:
  explicit Panel(Index n)
    : m_storage(std::size_t(n) * panel_width)
  {}
  Panel(Panel&&) = default;
  Panel& operator=(Panel&&) = default;
  Panel(const Panel&) = delete; // long ones must not be copied unnoticed
  Panel& operator=(const Panel&) = delete;

  double* row(Index i) { return m_storage.data() + i * panel_width; }
  const double* row(Index i) const { return m_storage.data() + i * panel_width; }

private:
  Aligned_buffer m_storage;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_LINEAR_ALGEBRA_PANEL_H
