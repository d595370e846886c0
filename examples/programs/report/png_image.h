// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_PNG_IMAGE_H
#define SPECTRAL_EXAMPLES_REPORT_PNG_IMAGE_H

#include <boost/crc.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

// Matrices as images inside a page: PNG with a palette, not compressed (a matrix of 100 x 100 takes 11 KB).

namespace png_internal {

inline std::string big_endian(std::uint32_t x)
{
  return {static_cast<char>(x >> 24), static_cast<char>(x >> 16), static_cast<char>(x >> 8),
          static_cast<char>(x)};
}

inline std::string chunk(const std::string& type, const std::string& data)
{
  const std::string body = type + data;
  boost::crc_32_type crc;
  crc.process_bytes(body.data(), body.size());
  return big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(crc.checksum());
}

// zlib's format with stored blocks.
inline std::string zlib_stored(const std::string& data)
{
  std::string result = "\x78\x01";
  constexpr std::size_t block = 65535;
  for(std::size_t i = 0; i == 0 || i < data.size(); i += block) {
    const std::size_t n = (std::min)(block, data.size() - i);
    const bool last = i + n >= data.size();
    for(const unsigned x : {last ? 1u : 0u, unsigned(n & 0xff), unsigned(n >> 8), unsigned(~n & 0xff),
                            unsigned((~n >> 8) & 0xff)})
      result += static_cast<char>(x);
    result.append(data, i, n);
  }
  std::uint32_t a = 1, b = 0;
  for(const char c : data) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  return result + big_endian(b << 16 | a);
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
      result += i + static_cast<std::size_t>(j) <= data.size() ? digits[x >> (18 - 6 * j) & 63] : '=';
  }
  return result;
}

} // namespace png_internal

// The colour of a value in [0, 1]: white, blue, nearly black, of falling lightness, so that it prints in grey
// as well.
inline std::array<int, 3> sequential_colour(double value)
{
  constexpr double stops[4][3] = {{255, 255, 255}, {120, 190, 230}, {0, 114, 178}, {5, 25, 60}};
  const double x = 3 * (std::max)(0., (std::min)(value, 1.));
  const int i = (std::min)(static_cast<int>(x), 2);
  std::array<int, 3> colour;
  for(int c = 0; c < 3; ++c)
    colour[static_cast<std::size_t>(c)] =
        static_cast<int>(std::lround(stops[i][c] + (x - i) * (stops[i + 1][c] - stops[i][c])));
  return colour;
}

// A `data:` address of an image of 8 bits per channel. `type` is 2 (red, green, blue) or 3 (`palette`); each row of
// `pixels` begins with the number of its filter.
inline std::string png_address(std::ptrdiff_t width, std::ptrdiff_t height, char type,
                               const std::string& palette, const std::string& pixels)
{
  using namespace png_internal;
  const std::string header =
      big_endian(static_cast<std::uint32_t>(width)) + big_endian(static_cast<std::uint32_t>(height)) +
      '\x08' + type + std::string(3, '\0'); // 8 bits, no compression, filter or interlace but the usual
  const std::string png = std::string("\x89PNG\r\n\x1a\n") + chunk("IHDR", header) +
                          (palette.empty() ? "" : chunk("PLTE", palette)) +
                          chunk("IDAT", zlib_stored(pixels)) + chunk("IEND", "");
  return "data:image/png;base64," + base64(png);
}

// A `data:` address of the image of |A|, one pixel per entry; white is zero, entries of `largest` and above
// are darkest.
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
