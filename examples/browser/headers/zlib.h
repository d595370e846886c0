// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_BROWSER_ZLIB_H
#define SPECTRAL_EXAMPLES_BROWSER_ZLIB_H

// What the pictures of the report need of zlib, which Emscripten would fetch from the network: by
// the compressor of stb_image_write.h.

#include <cstdlib>
#include <cstring>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

using Bytef = unsigned char;
using uInt = unsigned;
using uLong = unsigned long;
using uLongf = unsigned long;

constexpr int Z_OK = 0, Z_MEM_ERROR = -4;

inline uLong crc32(uLong, const Bytef* data, const uInt size)
{
  return stbiw__crc32(const_cast<Bytef*>(data), static_cast<int>(size));
}

// A little more than zlib's: stb may make what it cannot compress larger by an eighth.
inline uLong compressBound(const uLong size)
{
  return size + size / 8 + 64;
}

inline int compress(Bytef* to, uLongf* size, const Bytef* from, const uLong from_size)
{
  int length = 0;
  Bytef* const data =
      stbi_zlib_compress(const_cast<Bytef*>(from), static_cast<int>(from_size), &length, 8);
  const bool fits = data != nullptr && static_cast<uLongf>(length) <= *size;
  if(fits) {
    std::memcpy(to, data, static_cast<std::size_t>(length));
    *size = static_cast<uLongf>(length);
  }
  std::free(data);
  return fits ? Z_OK : Z_MEM_ERROR;
}

#endif // SPECTRAL_EXAMPLES_BROWSER_ZLIB_H
