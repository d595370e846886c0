// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_STL_READER_H
#define SPECTRAL_EXAMPLES_IO_STL_READER_H

#include "polygon_soup.h"
#include "text_lines.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// STL files, binary or text in any spelling, and the colours that binary ones have at faces. CGAL's
// reader takes a text for binary where its first word is not "solid" in lower case, and what it has
// misread stays beside the faces.
class Stl_reader
{
public:
  // Throws the end of a sentence that says what is wrong. Vertices stand in the order of first
  // appearance.
  static Polygon_soup read(const std::string& path)
  {
    Stl_reader reader;
    std::ifstream file(path, std::ios::binary);
    std::string start(84, '\0'); // of binary files: words, and the number of faces, 50 bytes each
    file.read(&start[0], 84);
    const bool has_header = file.gcount() == 84;
    start.resize(static_cast<std::size_t>(file.gcount()));
    const std::uintmax_t size = std::filesystem::file_size(path);
    const std::uintmax_t faces = has_header ? number(start.data() + 80, 4) : 0;
    const bool fits = has_header && size == 84 + 50 * faces;
    if(!fits && is_text(start))
      reader.read_text(path);
    else if(!has_header)
      throw std::runtime_error("it is cut off in the header");
    else if(size < 84 + 50 * faces)
      throw std::runtime_error("its header announces " + std::to_string(faces) +
                               " faces, but it is cut off after " +
                               std::to_string((size - 84) / 50));
    else {
      reader.read_binary(file, faces, start.find("COLOR=") != std::string::npos);
      std::array<char, 50> more; // than zeros that fill a block up
      while(file.read(more.data(), 50))
        if(std::any_of(more.begin(), more.end(), [](const char c) { return c != 0; }))
          throw std::runtime_error("its header announces " + std::to_string(faces) +
                                   " faces, but more follow: write the right number, up to " +
                                   std::to_string((size - 84) / 50) + ", in its bytes 80 to 83");
    }
    return std::move(reader.m_soup);
  }

private:
  static std::uintmax_t number(const char* bytes, const std::size_t size)
  {
    std::uintmax_t value = 0;
    for(std::size_t i = size; i-- > 0;)
      value = 256 * value + static_cast<unsigned char>(bytes[i]);
    return value;
  }

  // Headers of binary files hold zeros and other bytes that are no text, at the latest in the
  // number of faces.
  static bool is_text(const std::string& start)
  {
    if(start.compare(0, 2, "\xFF\xFE") == 0 || start.compare(0, 2, "\xFE\xFF") == 0)
      throw std::runtime_error("it is in UTF-16, save it as UTF-8");
    return std::none_of(start.begin(), start.end(),
                        [](const unsigned char c) { return c < ' ' && std::isspace(c) == 0; });
  }

  void add_vertex(const std::array<double, 3>& p, std::vector<std::size_t>& polygon)
  {
    const bool finite = std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
    std::size_t v = m_soup.points.size();
    if(finite) // others equal nothing
      v = m_vertices.emplace(p, v).first->second;
    if(v == m_soup.points.size())
      m_soup.points.emplace_back(p[0], p[1], p[2]);
    polygon.push_back(v);
  }

  // Words count, lines do not, but for the names of solids, which end with theirs.
  void read_text(const std::string& path)
  {
    Text_lines file(path);
    std::vector<std::size_t> polygon;
    bool in_solid = false, in_name = false; // which may go on in the next lines
    const auto next_word = [&file] {
      return file.more_or_next() ? lower(file.word()) : std::string();
    };
    const auto close_face = [&] {
      if(polygon.empty())
        return;
      if(polygon.size() < 3)
        file.refuse("ends a face of fewer than three vertices");
      m_soup.polygons.push_back(std::move(polygon));
      polygon.clear();
    };
    for(std::string word = next_word(); !word.empty(); word = next_word()) {
      if(word == "end")
        word += next_word();
      if(word == "solid" || word == "endsolid") {
        in_solid = in_name = true;
        close_face();
        pass_over_name(file);
      } else if(word == "vertex") {
        std::array<double, 3> p;
        for(double& x : p)
          x = file.more_or_next() ? file.number()
                                  : throw std::runtime_error("it ends within a vertex");
        add_vertex(p, polygon);
      } else if(word == "facet" || word == "endloop" || word == "endfacet") {
        close_face();
        in_solid = true;
        in_name = false;
        if(word == "facet" && file.more() &&
           std::tolower(static_cast<unsigned char>(file.peek())) == 'n') {
          next_word();
          for(int i = 0; i < 3 && file.more_or_next(); ++i)
            file.word(); // the normal, which follows from the vertices and is often none
        }
      } else if(word == "outer" || word == "loop")
        continue;
      else if(in_name)
        file.rest();
      else if(!in_solid)
        throw std::runtime_error("its first word is neither solid nor facet");
      else
        file.refuse("holds " + quoted(word) + " where a keyword of STL is expected");
    }
    if(!polygon.empty())
      throw std::runtime_error("it ends within face " + std::to_string(m_soup.polygons.size()) +
                               " (counted from 0)");
  }

  // A name may hold any words; "facet normal" is none where all is on one line.
  static void pass_over_name(Text_lines& file)
  {
    while(file.more()) {
      char* const place = file.place();
      if(lower(file.word()) != "facet")
        continue;
      char* const next = file.place();
      const bool begins = lower(file.word()) == "normal";
      file.return_to(begins ? place : next);
      if(begins)
        return;
    }
  }

  static std::string lower(std::string word)
  {
    std::transform(word.begin(), word.end(), word.begin(),
                   [](const unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return word;
  }

  void read_binary(std::ifstream& file, const std::uintmax_t faces,
                   const bool in_order_of_materialise)
  {
    std::vector<double> marks; // of the faces
    std::array<char, 50> face;
    for(std::uintmax_t f = 0; f < faces && file.read(face.data(), 50); ++f) {
      std::vector<std::size_t> polygon;
      for(std::size_t i = 0; i < 3; ++i) {
        std::array<double, 3> p;
        for(std::size_t c = 0; c < 3; ++c) {
          const auto bits =
              static_cast<std::uint32_t>(number(face.data() + 12 + 12 * i + 4 * c, 4));
          float x = 0;
          std::memcpy(&x, &bits, 4);
          p[c] = x;
        }
        add_vertex(p, polygon);
      }
      m_soup.polygons.push_back(std::move(polygon));
      marks.push_back(static_cast<double>(number(face.data() + 48, 2)));
    }
    if(std::all_of(marks.begin(), marks.end(), [](const double mark) { return mark == 0; }))
      return;
    // Five bits a channel, and one that says that they are a colour; Materialise counts the other
    // way round.
    const auto is_coloured = [&](const double mark) {
      return (mark >= 32768) != in_order_of_materialise;
    };
    if(std::none_of(marks.begin(), marks.end(), is_coloured)) {
      m_soup.face_attributes.add("label", "ushort", std::move(marks));
      return;
    }
    std::vector<std::vector<double>> channels(4);
    for(const double mark : marks) {
      const auto bits = static_cast<unsigned>(mark);
      for(std::size_t c = 0; c < 3; ++c) {
        const std::size_t shift = 5 * (in_order_of_materialise ? c : 2 - c);
        channels[c].push_back(std::round(((bits >> shift) & 31) * 255 / 31.));
      }
      channels[3].push_back(is_coloured(mark) ? 255 : 0);
    }
    if(std::all_of(marks.begin(), marks.end(), is_coloured))
      channels.pop_back();
    const std::array<const char*, 4> names = {"red", "green", "blue", "alpha"};
    for(std::size_t c = 0; c < channels.size(); ++c)
      m_soup.face_attributes.add(names[c], "uchar", std::move(channels[c]));
  }

  Polygon_soup m_soup;
  std::map<std::array<double, 3>, std::size_t> m_vertices;
};

#endif // SPECTRAL_EXAMPLES_IO_STL_READER_H
