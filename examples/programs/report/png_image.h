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
  boost::crc_32_type crc;
  crc.process_bytes(body.data(), body.size());
  return big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(crc.checksum());
}

// Deflate with its fixed codes (RFC 1951, 3.2.6) and no matches but runs of one byte: enough for the empty ground
// of pictures.
class Deflated_runs
{
public:
  explicit Deflated_runs(const std::string& data)
  {
    bits(3, 3); // the last block, and one of fixed codes
    for(std::size_t i = 0; i < data.size();) {
      std::size_t end = i + 1;
      while(end < data.size() && data[end] == data[i])
        ++end;
      run(static_cast<unsigned char>(data[i]), end - i);
      i = end;
    }
    symbol(256);
    bits(0, (8 - m_count) % 8);
  }

  const std::string& bytes() const { return m_bytes; }

private:
  // Lengths that need no further bits: 258, and 3 to 10.
  void run(unsigned byte, std::size_t length)
  {
    symbol(byte);
    for(--length; length >= 3;) {
      const unsigned n = length >= 258 ? 258 : static_cast<unsigned>((std::min)(length, std::size_t(10)));
      symbol(n == 258 ? 285 : 254 + n);
      code(0, 5); // one byte back
      length -= n;
    }
    for(; length > 0; --length)
      symbol(byte);
  }

  void symbol(unsigned s)
  {
    if(s < 144)
      code(0x30 + s, 8);
    else if(s < 256)
      code(0x190 + s - 144, 9);
    else if(s < 280)
      code(s - 256, 7);
    else
      code(0xc0 + s - 280, 8);
  }

  void code(unsigned value, int length) // the highest bit first
  {
    while(length > 0)
      bits(value >> --length & 1, 1);
  }

  void bits(unsigned value, int n) // the lowest bit first
  {
    for(int i = 0; i < n; ++i) {
      m_byte |= (value >> i & 1) << m_count++;
      if(m_count == 8) {
        m_bytes += static_cast<char>(m_byte);
        m_byte = 0;
        m_count = 0;
      }
    }
  }

  std::string m_bytes;
  unsigned m_byte = 0;
  int m_count = 0;
};

// zlib's format.
inline std::string zlib_compressed(const std::string& data)
{
  std::uint32_t a = 1, b = 0;
  for(const char c : data) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  return "\x78\x01" + Deflated_runs(data).bytes() + big_endian(b << 16 | a);
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

// The colour of a value in [0, 1]: white, blue, nearly black, of falling lightness, so that it prints in grey
// as well.
inline std::array<int, 3> sequential_colour(double value)
{
  return colour_between({{255, 255, 255}, {120, 190, 230}, {0, 114, 178}, {5, 25, 60}}, value);
}

// The colour of a value in [0, 1] whose middle is zero: blue, white, orange, which colour-blind readers tell apart.
inline std::array<int, 3> diverging_colour(double value)
{
  return colour_between({{0, 60, 120}, {60, 150, 210}, {245, 245, 245}, {235, 150, 50}, {140, 60, 0}}, value);
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
                          chunk("IDAT", zlib_compressed(pixels)) + chunk("IEND", "");
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
