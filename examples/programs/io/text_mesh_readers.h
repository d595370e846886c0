// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_TEXT_MESH_READERS_H
#define SPECTRAL_EXAMPLES_IO_TEXT_MESH_READERS_H

#include "polygon_soup.h"
#include "text_lines.h"

#include <array>
#include <cctype>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// OBJ and OFF as programs write them. CGAL's readers refuse OBJ files with lines, tabs or continued lines, take the first
// coordinate of an OFF file without a number of edges for that number, and reserve gigabytes for a face that claims to have a
// billion vertices. What is wrong is thrown as the end of a sentence: "line 5 holds 'x' where a number is expected".

namespace text_mesh_internal {

inline Kernel::Point_3 read_point(Text_lines& file)
{
  const double x = file.number(), y = file.number(), z = file.number();
  return {x, y, z};
}

// The vertex that an OBJ file means by `index`: from 1, or from the last one backwards.
inline std::size_t obj_vertex(const Text_lines& file, const long long index, const std::size_t points)
{
  if(index == 0)
    file.refuse("has the index 0, but OBJ files count from 1");
  if(index > 0)
    return static_cast<std::size_t>(index - 1);
  const std::size_t back = 0 - static_cast<std::size_t>(index);
  return back <= points ? points - back : no_vertex;
}

// True for OFF with the prefixes of what else vertices may have; `homogeneous` for a fourth coordinate.
inline bool is_off_keyword(std::string word, bool& homogeneous)
{
  if(word.size() < 3 || word.compare(word.size() - 3, 3, "OFF") != 0)
    return false;
  word.resize(word.size() - 3);
  for(const std::string prefix : {"ST", "C", "N"})
    if(word.compare(0, prefix.size(), prefix) == 0)
      word.erase(0, prefix.size());
  homogeneous = word == "4";
  return word.empty() || homogeneous;
}

} // namespace text_mesh_internal

inline Polygon_soup read_obj(const std::string& path)
{
  Polygon_soup soup;
  Text_lines file(path);
  while(file.next()) {
    const std::string keyword = file.word();
    if(keyword == "v")
      soup.points.push_back(text_mesh_internal::read_point(file));
    else if(keyword == "f") {
      std::vector<std::size_t> polygon;
      while(file.more()) // vertex/texture/normal
        polygon.push_back(text_mesh_internal::obj_vertex(file, file.integer('/'), soup.points.size()));
      soup.polygons.push_back(std::move(polygon));
    }
  }
  return soup;
}

namespace text_mesh_internal {

// A line for each vertex and face, of which the end means nothing; or, `packed`, any number of them on a line and nothing else.
inline Polygon_soup read_off(const std::string& path, const bool packed)
{
  Polygon_soup soup;
  Text_lines file(path);
  if(!file.next())
    throw std::runtime_error("it is empty");
  bool homogeneous = false;
  const std::string keyword = file.word();
  if(!is_off_keyword(keyword, homogeneous))
    throw std::runtime_error("its first word is not OFF");
  if(!file.more_or_next())
    throw std::runtime_error("nothing follows its first word");
  // Of binary OFF there are two kinds, which no header tells apart.
  if(std::isalpha(static_cast<unsigned char>(file.peek())))
    throw std::runtime_error("it is a binary one, convert it to .ply");
  const long long points = file.integer(), polygons = file.integer();
  if(points < 0 || polygons < 0)
    file.refuse("holds a negative number");

  const auto go_on = [&](const long long done, const long long all, const char* what) {
    if(!(packed ? file.more_or_next() : file.next()))
      throw std::runtime_error("it ends after " + std::to_string(done) + " of " + std::to_string(all) + what);
  };
  if(packed && file.more())
    file.integer(); // edges
  for(long long v = 0; v < points; ++v) {
    std::array<double, 4> p = {0, 0, 0, 1};
    for(std::size_t i = 0; i < (homogeneous ? 4 : 3); ++i) {
      if(packed || i == 0)
        go_on(v, points, " vertices");
      p[i] = file.number();
    }
    soup.points.emplace_back(p[0] / p[3], p[1] / p[3], p[2] / p[3]);
  }
  for(long long f = 0; f < polygons; ++f) {
    go_on(f, polygons, " faces");
    std::vector<std::size_t> polygon;
    for(long long left = file.integer(); left > 0; --left) {
      if(!file.more())
        go_on(f, polygons, " faces");
      const long long vertex = file.integer();
      polygon.push_back(vertex < 0 ? no_vertex : static_cast<std::size_t>(vertex));
    }
    soup.polygons.push_back(std::move(polygon));
  }
  if(packed && file.more_or_next())
    file.refuse("goes on after the last face");
  return soup;
}

} // namespace text_mesh_internal

inline Polygon_soup read_off(const std::string& path)
{
  try {
    return text_mesh_internal::read_off(path, false);
  } catch(const std::runtime_error& fault) {
    try {
      return text_mesh_internal::read_off(path, true);
    } catch(const std::runtime_error&) {
      throw fault;
    }
  }
}

#endif // SPECTRAL_EXAMPLES_IO_TEXT_MESH_READERS_H
