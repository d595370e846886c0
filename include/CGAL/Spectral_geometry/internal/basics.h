// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_BASICS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_BASICS_H

// What every header of these packages has, by way of others: the matrices of Eigen, the common part
// of the standard library, how arguments are refused, and the median.

#include <CGAL/Spectral_geometry/internal/require.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace CGAL::Spectral_geometry::internal {

/// The upper median; 0 if there are no numbers.
inline double median(Eigen::VectorXd numbers)
{
  double *const begin = numbers.data(), *const end = begin + numbers.size(),
                *const middle = begin + numbers.size() / 2;
  std::nth_element(begin, middle, end);
  return begin == end ? 0. : *middle;
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_BASICS_H
