// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_PANEL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_PANEL_H

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

using Eigen::Index;

constexpr int panel_width = 8;

/// Eight vectors, n x 8 by rows, each row in one cache line.
class Panel
{
public:
  explicit Panel(Index n)
    : m_storage(n * panel_width + panel_width)
  {
    const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(m_storage.data());
    m_offset = (64 - address % 64) % 64 / sizeof(double);
  }
  Panel(Panel&&) = default; // moving a vector keeps its address
  Panel& operator=(Panel&&) = default;
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;

  double* row(Index i) { return m_storage.data() + m_offset + i * panel_width; }
  const double* row(Index i) const { return m_storage.data() + m_offset + i * panel_width; }

private:
  std::vector<double> m_storage;
  std::size_t m_offset;
};

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_PANEL_H
