// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_CATCH_H
#define SPECTRAL_TEST_CATCH_H

// What every test includes: Catch2, the standard library and the names of both packages.
//
// Catch2 3 and 2.13 differ in their headers and in a few names. The tests use the names of version
// 3: Catch::Approx, and Catch::Matchers::{ContainsSubstring, StartsWith, EndsWith, WithinAbs,
// WithinRel}. An assertion that throws ends its test, as one of REQUIRE does, which saves a tenth
// of the time to compile.
#define CATCH_CONFIG_FAST_COMPILE
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
#else
#include <catch2/catch.hpp>

namespace Catch {
using Detail::Approx;

namespace Matchers {
inline auto ContainsSubstring(const std::string& text)
{
  return Contains(text);
}
} // namespace Matchers
} // namespace Catch
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace CGAL::Spectral_geometry {}
namespace CGAL::Surface_mesh_simplification {}
namespace SG = CGAL::Spectral_geometry;
namespace SMS = CGAL::Surface_mesh_simplification;

using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

#endif // SPECTRAL_TEST_CATCH_H
