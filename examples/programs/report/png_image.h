// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_PNG_IMAGE_H
#define SPECTRAL_EXAMPLES_REPORT_PNG_IMAGE_H

#include <Eigen/Core>

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <new>
#include <string>

// Images inside a page as PNG: pictures, and matrices with a palette.

namespace png_internal {

inline std::string big_endian(std::uint32_t x)
{
  return {static_cast<char>(x >> 24), static_cast<char>(x >> 16), static_cast<char>(x >> 8),
          static_cast<char>(x)};
}

inline std::string chunk(const std::string& type, const std::string& data)
{
  const std::string body = type + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + body +
         big_endian(static_cast<std::uint32_t>(sum));
}

inline std::string compressed(const std::string& data)
{
  uLongf size = compressBound(static_cast<uLong>(data.size()));
  std::string result(size, '\0');
  if(compress(reinterpret_cast<Bytef*>(&result[0]), &size,
              reinterpret_cast<const Bytef*>(data.data()), static_cast<uLong>(data.size())) != Z_OK)
    throw std::bad_alloc();
  result.resize(size);
  return result;
}

inline std::string base64(const std::string& data)
{
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  for(std::size_t i = 0; i < data.size(); i += 3) {
    std::uint32_t x = 0;
    for(std::size_t j = 0; j < 3; ++j)
      x = x << 8 | (i + j < data.size() ? static_cast<unsigned char>(data[i + j]) : 0u);
    for(int j = 0; j < 4; ++j)
      result +=
          i + static_cast<std::size_t>(j) <= data.size() ? digits[x >> (18 - 6 * j) & 63] : '=';
  }
  return result;
}

} // namespace png_internal

// The colour at `value` in [0, 1] between stops at equal distances.
template <std::size_t N>
std::array<int, 3> colour_between(const double (&stops)[N][3], double value)
{
  const double x = static_cast<double>(N - 1) * (std::max)(0., (std::min)(value, 1.));
  const std::size_t i = (std::min)(static_cast<std::size_t>(x), N - 2);
  std::array<int, 3> colour;
  for(std::size_t c = 0; c < 3; ++c)
    colour[c] = static_cast<int>(
        std::lround(stops[i][c] + (x - static_cast<double>(i)) * (stops[i + 1][c] - stops[i][c])));
  return colour;
}

// The colour of a value in [0, 1]: white, blue, nearly black, of falling lightness, so that it
// prints in grey as well.
inline std::array<int, 3> sequential_colour(double value)
{
  return colour_between({{255, 255, 255}, {120, 190, 230}, {0, 114, 178}, {5, 25, 60}}, value);
}

// The colour of a value in [0, 1] whose middle is zero: blue, white, orange, which colour-blind
// readers tell apart.
inline std::array<int, 3> diverging_colour(double value)
{
  return colour_between(
      {{0, 60, 120}, {60, 150, 210}, {245, 245, 245}, {235, 150, 50}, {140, 60, 0}}, value);
}

// A `data:` address of an image of 8 bits per channel. `type` is 2 (red, green, blue) or 3
// (`palette`); each row of `pixels` begins with the number of its filter.
inline std::string png_address(std::ptrdiff_t width, std::ptrdiff_t height, char type,
                               const std::string& palette, const std::string& pixels)
{
  using namespace png_internal;
  const std::string header =
      big_endian(static_cast<std::uint32_t>(width)) +
      big_endian(static_cast<std::uint32_t>(height)) + '\x08' + type +
      std::string(3, '\0'); // 8 bits, no compression, filter or interlace but the usual
  const std::string png = std::string("\x89PNG\r\n\x1a\n") + chunk("IHDR", header) +
                          (palette.empty() ? "" : chunk("PLTE", palette)) +
                          chunk("IDAT", compressed(pixels)) + chunk("IEND", "");
  return "data:image/png;base64," + base64(png);
}

// A `data:` address of the image of |A|, one pixel per entry; white is zero, entries of `largest`
// and above are darkest.
inline std::string matrix_image(const Eigen::MatrixXd& A, double largest = 1)
{
  using namespace png_internal;
  std::string palette, pixels;
  for(int i = 0; i < 256; ++i)
    for(const int c : sequential_colour(i / 255.))
      palette += static_cast<char>(c);
  for(Eigen::Index i = 0; i < A.rows(); ++i) {
    pixels += '\0'; // no filter
    for(Eigen::Index j = 0; j < A.cols(); ++j)
      pixels += static_cast<char>(std::lround(255 * (std::min)(1., std::abs(A(i, j)) / largest)));
  }
  return png_address(A.cols(), A.rows(), 3, palette, pixels);
}

#endif // SPECTRAL_EXAMPLES_REPORT_PNG_IMAGE_H
