// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_READER_INPUT_H
#define SPECTRAL_TEST_READER_INPUT_H

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

// Small valid files, one and more for each format, and what is done to them.
namespace spectral_test {

// The first byte of an input modulo their number; the rest is the file.
constexpr std::array<const char*, 7> extensions = {".off", ".obj", ".ply", ".stl",
                                                   ".npy", ".mtx", ".txt"};

struct Seed
{
  const char* extension;
  std::string contents;
};

namespace seeds {

// The bytes of numbers, the first byte first or last.
template <class Number>
std::string raw(const std::initializer_list<Number> numbers, const bool big_endian = false)
{
  std::string bytes;
  for(const Number x : numbers) {
    char copy[sizeof(Number)];
    std::memcpy(copy, &x, sizeof(Number));
    if(big_endian)
      std::reverse(copy, copy + sizeof(Number));
    bytes.append(copy, sizeof(Number));
  }
  return bytes;
}

inline std::string npy(const std::string& type, const std::string& order, const std::string& shape,
                       const std::string& data, const char version = 1)
{
  std::string text =
      "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': (" + shape + "), }";
  text.append(69 - text.size(), ' ');
  text += '\n';
  std::string bytes = "\x93NUMPY";
  bytes += version;
  bytes += '\0';
  bytes += char(text.size());
  bytes.append(version == 1 ? 1 : 3, '\0');
  return bytes + text + data;
}

// A tetrahedron, of the vertices and faces of which the types are given by name and by the numbers.
template <class Coordinate, class Count, class Index>
std::string binary_ply(const std::string& coordinate, const std::string& count,
                       const std::string& index, const bool big_endian)
{
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\nelement vertex 4\n";
  for(const char* name : {"x", "y", "z"})
    bytes += "property " + coordinate + " " + name + "\n";
  bytes += "element face 4\nproperty list " + count + " " + index + " vertex_indices\nend_header\n";
  bytes += raw<Coordinate>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, big_endian);
  for(const std::initializer_list<Index>& face :
      {std::initializer_list<Index>{0, 2, 1}, std::initializer_list<Index>{0, 1, 3},
       std::initializer_list<Index>{1, 2, 3}, std::initializer_list<Index>{0, 3, 2}})
    bytes += raw<Count>({3}, big_endian) + raw<Index>(face, big_endian);
  return bytes;
}

inline std::string binary_stl()
{
  std::string bytes(80, ' ');
  bytes += raw<std::uint32_t>({2});
  bytes += raw<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}) + std::string(2, '\0');
  return bytes + raw<float>({0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + std::string(2, '\0');
}

} // namespace seeds

inline const std::vector<Seed>& valid_files()
{
  using namespace seeds;
  static const std::vector<Seed> files = {
      {".off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"},
      {".off", "4OFF # four\n4 1 0\n0 0 0 1 1 0 0 1\n1 1 0 1 0 1 0 2\n4 0 1 2\n3\n"},
      {".off",
       "\xEF\xBB\xBFSTCNOFF\r\n3 1\r\n0 0 0 9 9\r\n1e0 0 \\\r\n0\r\n.5 1 0x1p-2\r\n3 0 1 2 7\r\n"},
      {".obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0 1\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1/1/1 3//1 2/7\n"
               "f 1 2 4\nf -3 -2 -1\nl 1 2\nf 1 \\\n4 3\n"},
      {".ply",
       "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty float y\n"
       "property double z\nproperty uchar red\nelement face 2\nproperty list uchar int "
       "vertex_indices\n"
       "property int flags\nend_header\n0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 nan 4\n3 0 1 2 5\n3 0 2 3 "
       "6\n"},
      {".ply",
       "ply\nformat ascii 1.0\nelement vertex 4\nproperty int x\nproperty int y\nproperty int z\n"
       "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 "
       "0\n"
       "1 1 1\n5 0 1 2 -1 3\n"},
      {".ply", binary_ply<float, std::uint8_t, std::int32_t>("float", "uchar", "int", false)},
      {".ply",
       binary_ply<double, std::uint32_t, std::uint16_t>("float64", "uint32", "uint16", true)},
      {".ply",
       binary_ply<std::int16_t, std::int8_t, std::uint8_t>("short", "char", "uchar", false)},
      {".stl", "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
               "0\nendloop\n"
               "endfacet\nendsolid s\n"},
      {".stl", binary_stl()},
      {".npy", npy("<f8", "True", "3, 2", raw<double>({1, 2, 3, 4, 5, 6}))},
      {".npy", npy(">f4", "False", "3,", raw<float>({1, 2, 3}, true), 2)},
      {".mtx",
       "%%MatrixMarket matrix coordinate real general\n% c\n2 3 3\n1 1 0.5\n1 2 0.5\n2 3 1e0\n"},
      {".mtx",
       "%%MatrixMarket matrix coordinate integer Symmetric\n3 3 4\n1 1 2\n2 1 -1\n2 2 2\n3 3 1\n"},
      {".txt", "0\n 7\r\n\n11\n"}};
  return files;
}

inline std::vector<std::uint8_t> input_of(const std::string& extension, const std::string& contents)
{
  const auto place = std::find_if(extensions.begin(), extensions.end(),
                                  [&](const char* e) { return extension == e; });
  const std::string bytes = char(place - extensions.begin()) + contents;
  return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
}

// Puts another number, or what is none, in place of a word.
inline void replace_word(std::string& text, std::mt19937& random)
{
  static const std::vector<std::string> words = {"-1",
                                                 "0",
                                                 "1",
                                                 "2",
                                                 "3",
                                                 "255",
                                                 "1000000",
                                                 "2147483647",
                                                 "2147483648",
                                                 "4294967295",
                                                 "-2147483649",
                                                 "999999999999999",
                                                 "9223372036854775807",
                                                 "18446744073709551615",
                                                 "99999999999999999999999",
                                                 "1e308",
                                                 "1e999",
                                                 "-1e-320",
                                                 "nan",
                                                 "inf",
                                                 "symmetric",
                                                 "list",
                                                 "double",
                                                 "uchar",
                                                 "\x1b[2J",
                                                 "\xff\xfe",
                                                 ""};
  const char* const separators = " \t\r\n,()'/";
  const std::size_t begin = text.find_first_not_of(separators, random() % (text.size() + 1));
  if(begin == std::string::npos)
    return;
  const std::size_t end = (std::min)(text.find_first_of(separators, begin), text.size());
  text.replace(begin, end - begin, words[random() % words.size()]);
}

// Cuts, overwrites, repeats and leaves out.
inline std::string mutated(std::string text, std::mt19937& random)
{
  for(unsigned left = 1 + random() % 4; left > 0; --left) {
    const std::size_t at = random() % (text.size() + 1);
    const std::size_t length = (std::min)(std::size_t(1 + random() % 20), text.size() - at);
    switch(random() % 8) {
    case 0:
      text.resize(at);
      break;
    case 1:
      text.erase(at, length);
      break;
    case 2:
      text.insert(random() % (text.size() + 1), text.substr(at, length));
      break;
    case 3:
      if(length != 0)
        text[at] = char(random() >> 16);
      break;
    case 4:
      text.insert(at, 1, "\n\r\t \\#\0"[random() % 7]);
      break;
    default:
      replace_word(text, random);
    }
  }
  return text;
}

} // namespace spectral_test

#endif // SPECTRAL_TEST_READER_INPUT_H
