// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_TEXT_MESH_READERS_H
#define SPECTRAL_EXAMPLES_IO_TEXT_MESH_READERS_H

#include "polygon_soup.h"
#include "text_lines.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// OBJ and OFF as programs write them. CGAL's readers refuse OBJ files with lines, tabs or continued
// lines, take the first coordinate of an OFF file without a number of edges for that number, and
// reserve gigabytes for a face that claims to have a billion vertices. What is wrong is thrown as
// the end of a sentence: "line 5 holds 'x' where a number is expected".

namespace text_mesh_internal {

inline Kernel::Point_3 read_point(Text_lines& file)
{
  const double x = file.number(), y = file.number(), z = file.number();
  return {x, y, z};
}

// What an OBJ file means by `index`: from 1, or from the last of `known` ones backwards.
inline std::size_t obj_index(const long long index, const std::size_t known)
{
  if(index > 0)
    return static_cast<std::size_t>(index - 1);
  const std::size_t back = 0 - static_cast<std::size_t>(index);
  return back != 0 && back <= known ? known - back : no_vertex;
}

// What OFF files announce that vertices have beside their coordinates.
struct Off_keyword
{
  bool texture = false, colour = false, normal = false, homogeneous = false;
  std::string number; // of vertices, where no space is before it

  bool announces() const { return texture || colour || normal; }

  // False if the word is none.
  bool read(std::string word)
  {
    const std::size_t end = word.find("OFF");
    if(end == std::string::npos)
      return false;
    number = word.substr(end + 3);
    if(number.find_first_not_of("0123456789") != std::string::npos || number.size() > 15)
      return false;
    word.resize(end);
    const auto take = [&word](const std::string& prefix) {
      const bool found = word.compare(0, prefix.size(), prefix) == 0;
      word.erase(0, found ? prefix.size() : 0);
      return found;
    };
    texture = take("ST");
    colour = take("C");
    normal = take("N");
    homogeneous = take("4");
    return word.empty();
  }
};

// What OBJ files give to the corners of faces: to the vertices, where all corners of each have the
// same. Lines may come after the faces that use them.
class Corner_values
{
public:
  explicit Corner_values(const std::size_t numbers)
    : m_columns(numbers)
  {}

  void add(const std::vector<double>& numbers)
  {
    for(std::size_t c = 0; c < m_columns.size(); ++c)
      m_columns[c].push_back(c < numbers.size() ? numbers[c] : 0.);
  }

  // The next corner of a face; `index` as in the file, 0 for none.
  void add_corner(const long long index)
  {
    m_corners.push_back(obj_index(index, m_columns.front().size()));
  }

  // After all lines.
  void find_vertices(const std::vector<std::vector<std::size_t>>& polygons, const std::size_t n)
  {
    m_of.assign(n, no_vertex); // isolated ones have 0
    std::size_t corner = 0;
    for(const auto& polygon : polygons)
      for(const std::size_t vertex : polygon) {
        const std::size_t value = m_corners[corner++];
        if(vertex >= n || value >= m_columns.front().size())
          ++m_missing;
        else if(m_of[vertex] == no_vertex)
          m_of[vertex] = value;
        else if(!std::all_of(m_columns.begin(), m_columns.end(), [&](const auto& column) {
                  return column[m_of[vertex]] == column[value];
                }))
          ++m_seams;
      }
  }

  void add_to(Attributes& attributes, const std::string& what,
              const std::vector<const char*>& names)
  {
    if(m_columns.front().empty())
      return;
    if(m_seams + m_missing > 0) {
      attributes.unknown.push_back(what + (m_missing > 0
                                               ? " (some corners have none)"
                                               : " (they differ between the corners of a vertex)"));
      return;
    }
    for(std::size_t c = 0; c < names.size(); ++c) {
      std::vector<double> values;
      for(const std::size_t v : m_of)
        values.push_back(v == no_vertex ? 0. : m_columns[c][v]);
      attributes.add(names[c], "float", std::move(values));
    }
  }

  // Whether there is a vertex whose corners differ.
  bool has_seams() const { return m_seams > 0; }

  // Adds those of all corners as a texture, or the reason why there is none.
  void add_to(Polygon_soup& soup) const
  {
    if(m_columns.front().empty())
      return;
    if(m_missing > 0) {
      soup.without_texture = "some corners of its faces have no texture coordinates";
      return;
    }
    for(const std::size_t c : m_corners)
      soup.texture.push_back({m_columns[0][c], m_columns[1][c]});
  }

private:
  std::vector<std::vector<double>> m_columns;
  std::vector<std::size_t> m_of;      // the value of each vertex
  std::vector<std::size_t> m_corners; // and of each corner
  std::size_t m_seams = 0, m_missing = 0;
};

// What lines such as usemtl say of the faces after them: words, which are counted as they come.
class Face_words
{
public:
  void set(const std::string& word)
  {
    const auto known = m_numbers.emplace(word, m_words.size());
    if(known.second)
      m_words.push_back(word);
    m_now = static_cast<double>(known.first->second);
    m_used = true;
  }

  void add_face()
  {
    if(!m_used && m_values.empty()) // none yet
      m_before++;
    else
      m_values.push_back(m_now);
  }

  // Faces before the first line have the word "default".
  void add_to(Attributes& attributes, const std::string& name)
  {
    if(!m_used)
      return;
    if(m_before != 0 && !m_values.empty()) {
      set("default");
      m_values.insert(m_values.begin(), m_before, m_now);
    }
    if(m_values.empty())
      return;
    attributes.add(name, "int", std::move(m_values));
    attributes.known.back().words = std::move(m_words);
  }

private:
  std::map<std::string, std::size_t> m_numbers;
  std::vector<std::string> m_words;
  std::vector<double> m_values;
  std::size_t m_before = 0;
  double m_now = 0;
  bool m_used = false;
};

} // namespace text_mesh_internal

inline Polygon_soup read_obj(const std::string& path)
{
  using namespace text_mesh_internal;
  Polygon_soup soup;
  Text_lines file(path);
  Corner_values texture(2), normals(3);
  std::vector<std::vector<double>> colours(3);
  std::map<std::string, Face_words> words;
  while(file.next()) {
    const std::string keyword = file.word();
    if(keyword == "v") {
      soup.points.push_back(read_point(file));
      const std::vector<double> more = file.numbers();
      for(std::size_t c = 0; more.size() >= 3 && c < 3; ++c)
        colours[c].push_back(more[c]);
    } else if(keyword == "mtllib")
      soup.material_libraries.push_back(file.rest());
    else if(keyword == "usemtl" || keyword == "g" || keyword == "o" || keyword == "s")
      words[keyword].set(file.rest());
    else if(keyword == "vt")
      texture.add(file.numbers());
    else if(keyword == "vn")
      normals.add(file.numbers());
    else if(keyword == "f") {
      std::vector<std::size_t> polygon;
      while(file.more()) {
        const std::array<long long, 3> corner = file.integers<3>('/');
        if(corner[0] == 0)
          file.refuse("has the index 0, but OBJ files count from 1");
        polygon.push_back(obj_index(corner[0], soup.points.size()));
        texture.add_corner(corner[1]);
        normals.add_corner(corner[2]);
      }
      soup.polygons.push_back(std::move(polygon));
      for(const char* name : {"usemtl", "g", "o", "s"})
        words[name].add_face();
    }
  }
  if(colours[0].size() == soup.points.size())
    add_colours(soup.attributes, std::move(colours));
  texture.find_vertices(soup.polygons, soup.points.size());
  normals.find_vertices(soup.polygons, soup.points.size());
  normals.add_to(soup.attributes, "normals", {"nx", "ny", "nz"});
  words["usemtl"].add_to(soup.face_attributes, "material");
  words["g"].add_to(soup.face_attributes, "group");
  words["o"].add_to(soup.face_attributes, "object");
  words["s"].add_to(soup.face_attributes, "smoothing_group");
  texture.add_to(soup);
  if(soup.texture.empty() || !texture.has_seams())
    texture.add_to(soup.attributes, "texture coordinates", {"s", "t"});
  return soup;
}

namespace text_mesh_internal {

// What follows the coordinates, in this order: a normal, a colour of three or four numbers,
// coordinates of a texture.
inline void add_off_attributes(const Off_keyword& keyword, std::vector<std::vector<double>> columns,
                               Attributes& attributes)
{
  const std::size_t normal = keyword.normal ? 3 : 0, texture = keyword.texture ? 2 : 0;
  const std::size_t colour = keyword.colour && columns.size() >= normal + 3 + texture
                                 ? (std::min)(columns.size() - normal - texture, std::size_t(4))
                                 : 0;
  if(columns.size() < normal + colour + texture || (keyword.colour && colour == 0)) {
    attributes.unknown.push_back(
        "what its first word announces (some vertices have fewer numbers)");
    return;
  }
  auto next = columns.begin();
  if(keyword.normal)
    for(const char* name : {"nx", "ny", "nz"})
      attributes.add(name, "float", std::move(*next++));
  if(keyword.colour)
    add_colours(attributes, {next, next + static_cast<std::ptrdiff_t>(colour)});
  next += static_cast<std::ptrdiff_t>(colour);
  if(keyword.texture)
    for(const char* name : {"s", "t"})
      attributes.add(name, "float", std::move(*next++));
}

inline bool are_integers(const std::vector<double>& values)
{
  return std::all_of(values.begin(), values.end(), [](const double x) {
    return x == std::floor(x) && std::abs(x) < 2147483648.;
  });
}

// A line for each vertex, whose end means nothing but what the first word announces, and for each
// face, whose end is a colour or a label; or, `packed`, any number of them on a line and nothing
// else.
inline Polygon_soup read_off(const std::string& path, const bool packed)
{
  Polygon_soup soup;
  Text_lines file(path);
  if(!file.next())
    throw std::runtime_error("it is empty");
  Off_keyword keyword;
  if(!keyword.read(file.word()))
    throw std::runtime_error("its first word is not OFF");
  if(!file.more_or_next())
    throw std::runtime_error("nothing follows its first word");
  // Two kinds of binary OFF exist, which no header tells apart.
  if(file.peek() == 'B')
    throw std::runtime_error("it is a binary one, convert it to .ply");
  const long long points = keyword.number.empty() ? file.integer() : std::stoll(keyword.number),
                  polygons = file.integer();
  if(points < 0 || polygons < 0)
    file.refuse("holds a negative number");

  const auto go_on = [&](const long long done, const long long all, const char* what) {
    if(!(packed ? file.more_or_next() : file.next()))
      throw std::runtime_error("it ends after " + std::to_string(done) + " of " +
                               std::to_string(all) + what);
  };
  if(packed && file.more())
    file.integer();                         // edges
  std::vector<std::vector<double>> columns; // of what follows the coordinates
  for(long long v = 0; v < points; ++v) {
    std::array<double, 4> p = {0, 0, 0, 1};
    for(std::size_t i = 0; i < (keyword.homogeneous ? 4 : 3); ++i) {
      if(packed || i == 0)
        go_on(v, points, " vertices");
      p[i] = file.number();
    }
    soup.points.emplace_back(p[0] / p[3], p[1] / p[3], p[2] / p[3]);
    if(packed || !keyword.announces())
      continue;
    const std::vector<double> more = file.numbers();
    columns.resize(v == 0 ? more.size() : (std::min)(columns.size(), more.size()));
    for(std::size_t c = 0; c < columns.size(); ++c)
      columns[c].push_back(more[c]);
  }
  if(keyword.announces() && !packed)
    add_off_attributes(keyword, std::move(columns), soup.attributes);
  columns.clear();
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
    if(packed)
      continue;
    const std::vector<double> more = file.numbers();
    columns.resize(f == 0 ? more.size() : (std::min)(columns.size(), more.size()));
    for(std::size_t c = 0; c < columns.size(); ++c)
      columns[c].push_back(more[c]);
  }
  if(columns.size() == 3 || columns.size() == 4)
    add_colours(soup.face_attributes, std::move(columns));
  else if(!columns.empty() && are_integers(columns[0]))
    soup.face_attributes.add("label", "int", std::move(columns[0]));
  if(packed ? file.more_or_next() : file.next())
    file.refuse("goes on after the last face that its head announces");
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
