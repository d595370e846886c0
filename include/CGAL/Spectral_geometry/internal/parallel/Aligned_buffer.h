// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_PARALLEL_ALIGNED_BUFFER_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_PARALLEL_ALIGNED_BUFFER_H

#include <CGAL/Spectral_geometry/internal/parallel/vector_units.h>

#include <cstddef>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// Numbers that begin with a cache line. A vector register that is loaded across the end of one costs two loads.
class Aligned_buffer
{
public:
  double* data() { return m_lines.empty() ? nullptr : m_lines.front().numbers; }
  const double* data() const { return m_lines.empty() ? nullptr : m_lines.front().numbers; }

  /// n numbers, all zero.
  void assign(const std::size_t n) { m_lines.assign(lines(n), Line()); }

  /// Room for n numbers, for scratch memory: it only grows, and what was in it is lost then.
  double* at_least(const std::size_t n)
  {
    if(m_lines.size() < lines(n))
      assign(n);
    return data();
  }

private:
  static constexpr std::size_t line_size = cache_line / sizeof(double);
  struct alignas(cache_line) Line
  {
    double numbers[line_size] = {};
  };
  static std::size_t lines(const std::size_t n) { return (n + line_size - 1) / line_size; }

  std::vector<Line> m_lines;
};

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_PARALLEL_ALIGNED_BUFFER_H
