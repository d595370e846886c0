// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_REQUIRE_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_REQUIRE_H

#include <CGAL/number_type_config.h>

#include <Eigen/SparseCore>

#include <cmath>
#include <cstddef>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace CGAL::Spectral_geometry::internal {

template <class Part>
void add_words(std::string& text, const Part& part)
{
  if constexpr(std::is_floating_point<Part>::value) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out << part;
    text += out.str();
  } else if constexpr(std::is_integral<Part>::value)
    text += std::to_string(part);
  else if constexpr(std::is_convertible<Part, std::string>::value)
    text += part;
  else
    text += part();
}

/// Concatenates the parts: strings, numbers, and names as below. A name is a function, so its text
/// is made only when it is needed.
template <class... Part>
std::string sentence(const Part... parts)
{
  std::string text;
  (add_words(text, parts), ...);
  return text;
}

/// Throws `std::invalid_argument` with the sentence that the parts make, unless `holds`.
template <class... Part>
void require(const bool holds, const Part... parts)
{
  if(!holds)
    throw std::invalid_argument(sentence(parts...));
}

inline auto vertex_name(const std::ptrdiff_t v)
{
  return [v] { return "vertex " + std::to_string(v) + " (counted from 0)"; };
}

inline auto face_name(const std::ptrdiff_t f)
{
  return [f] { return "face " + std::to_string(f) + " (counted from 0)"; };
}

/// `"n x K"`.
template <class Matrix>
auto size_name(const Matrix& M)
{
  return [&M] { return std::to_string(M.rows()) + " x " + std::to_string(M.cols()); };
}

/// Refuses a restriction that does not keep constants, up to what is lost in a file of text.
template <class Restriction>
void check_rows_of_restriction(const char* const who, const Restriction& P)
{
  const Eigen::VectorXd sums = P * Eigen::VectorXd::Ones(P.cols());
  for(Eigen::Index i = 0; i < sums.size(); ++i)
    require(std::abs(sums[i] - 1.) <= 1e-3, who, "row ", i, " (counted from 0) of P sums to ",
            sums[i], " and not to 1; pass the P of a run, or of closest_point_restriction().");
}

/// Checks one dimension of a functional map, or of a matrix from which such a map is made.
inline void check_dimension(const char* const what, const std::ptrdiff_t found,
                            const std::ptrdiff_t wanted)
{
  require(found == wanted, "functional map: ", what, " is ", found, " where ", wanted,
          " is needed, pass matrices that belong together.");
}

} // namespace CGAL::Spectral_geometry::internal

namespace CGAL::Surface_mesh_simplification::internal {
using Spectral_geometry::internal::require;
using Spectral_geometry::internal::sentence;
using Spectral_geometry::internal::vertex_name;
} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_REQUIRE_H
