// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_PLY_READER_H
#define SPECTRAL_EXAMPLES_IO_PLY_READER_H

#include "polygon_soup.h"
#include "text_lines.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// PLY files: text or binary of either byte order, numbers of any type, faces or, as scanned models have them, strips of
// triangles (element tristrips). CGAL's reader knows neither strips nor indices of fewer than 32 bits, crashes on coordinates
// that are integers, and reserves gigabytes for a face that claims to have a billion vertices.
class Ply_reader
{
public:
  // Throws the end of a sentence that says what is wrong.
  static Polygon_soup read(const std::string& path)
  {
    Ply_reader reader(path);
    reader.read_header();
    for(const Element& element : reader.m_elements)
      reader.read_element(element);
    Vertex_attributes& attributes = reader.m_soup.attributes;
    for(const Vertex_attribute& a : attributes.known)
      if(a.values.size() != reader.m_soup.points.size()) { // of a second element of that name
        attributes = {};
        break;
      }
    find_colours(attributes);
    if(reader.m_soup.polygons.empty())
      reader.m_soup.polygons = std::move(reader.m_triangles);
    return std::move(reader.m_soup);
  }

private:
  enum class Type { none, int8, uint8, int16, uint16, int32, uint32, float32, float64 };
  struct Property
  {
    Type count_type = Type::none, type = Type::none; // no type of a count: a single value
    std::size_t coordinate = 3;                      // 0 to 2 for x to z
    bool vertices = false;                           // of a face
    std::size_t attribute = no_vertex;               // its number among those of the vertices
  };
  struct Element
  {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
  };

  explicit Ply_reader(const std::string& path)
  {
    std::ifstream stream(path, std::ios::binary);
    m_bytes.resize(std::filesystem::file_size(path));
    stream.read(m_bytes.data(), static_cast<std::streamsize>(m_bytes.size()));
    m_bytes.resize(static_cast<std::size_t>(stream.gcount()));
    m_line_end = line_end(m_bytes.substr(0, m_bytes.find("end_header")));
    m_end = m_bytes.data() + m_bytes.size();
    m_at = m_bytes.data() + (has_byte_order_mark(m_bytes) ? 3 : 0);
  }

  bool next_line(std::string& line)
  {
    if(m_at == m_end)
      return false;
    const char* const end = std::find(m_at, m_end, m_line_end);
    line.assign(m_at, end);
    m_at = end == m_end ? end : end + 1;
    return true;
  }

  [[noreturn]] static void refuse(const std::string& what) { throw std::runtime_error(what); }

  // The names of each type, in the order of Type.
  static constexpr std::array<const char*, 16> type_names = {
      "char", "int8",  "uchar", "uint8",  "short", "int16",   "ushort", "uint16",
      "int",  "int32", "uint",  "uint32", "float", "float32", "double", "float64"};

  static Type type_of(const std::string& name)
  {
    const auto known = std::find(type_names.begin(), type_names.end(), name);
    if(known == type_names.end())
      refuse("its header has a property of the unknown type " + quoted(name));
    return static_cast<Type>((known - type_names.begin()) / 2 + 1);
  }

  static const char* name_of(const Type type) { return type_names[2 * (static_cast<std::size_t>(type) - 1)]; }

  void read_header()
  {
    std::string line, word;
    if(!next_line(line) || line.compare(0, 3, "ply") != 0)
      refuse("its first word is not ply");
    while(next_line(line)) {
      std::istringstream words(line);
      word.clear();
      words >> word;
      if(word == "end_header")
        return;
      if(word == "format") {
        words >> word;
        m_text = word == "ascii";
        m_big_endian = word == "binary_big_endian";
        if(!m_text && !m_big_endian && word != "binary_little_endian")
          refuse("its format is " + quoted(word));
      } else if(word == "element") {
        m_elements.emplace_back();
        if(!(words >> m_elements.back().name >> m_elements.back().count))
          refuse("its header has an element without a name or a number");
        const std::string& name = m_elements.back().name;
        if(name != "vertex" && name != "face" && name != "tristrips")
          m_soup.attributes.unknown.push_back("element " + name);
      } else if(word == "property" && !m_elements.empty()) {
        m_elements.back().properties.push_back(property_of(words, m_elements.back().name));
      }
    }
    refuse("its header does not end");
  }

  Property property_of(std::istream& words, const std::string& element)
  {
    Property property;
    std::string type, name;
    words >> type;
    const bool list = type == "list";
    if(list) {
      words >> type;
      property.count_type = type_of(type);
      words >> type;
    }
    property.type = type_of(type);
    words >> name;
    Vertex_attributes& attributes = m_soup.attributes;
    if(name == "x" || name == "y" || name == "z")
      property.coordinate = std::size_t(name[0] - 'x');
    else if(element == "vertex" && !list && attributes.find(name) == nullptr) {
      property.attribute = attributes.known.size();
      attributes.add(name, name_of(property.type), {});
    }
    property.vertices = name == "vertex_indices" || name == "vertex_index";
    if((element == "face" && !property.vertices) || (element == "vertex" && list))
      attributes.unknown.push_back("property " + name + " of " + element);
    return property;
  }

  void read_element(const Element& element)
  {
    const bool vertices = element.name == "vertex", faces = element.name == "face",
               strips = element.name == "tristrips";
    if(element.properties.empty())
      return;
    for(std::size_t i = 0; i < element.count; ++i) {
      std::array<double, 3> point = {0, 0, 0};
      for(const Property& property : element.properties)
        if(!(property.count_type == Type::none ? read_single(property, point) : read_list(property)))
          refuse("it is damaged or cut off at " + quoted(element.name) + " " + std::to_string(i) + " of " +
                 std::to_string(element.count) + " (counted from 0)");
        else if(property.count_type != Type::none && faces && property.vertices)
          m_soup.polygons.push_back(m_list);
        else if(property.count_type != Type::none && strips)
          add_strip();
      if(vertices)
        m_soup.points.emplace_back(point[0], point[1], point[2]);
    }
  }

  bool read_single(const Property& property, std::array<double, 3>& point)
  {
    double value = 0;
    if(!read_value(property.type, value) || (property.attribute != no_vertex && !holds(property.type, value)))
      return false;
    if(property.coordinate < 3)
      point[property.coordinate] = value;
    if(property.attribute != no_vertex)
      m_soup.attributes.known[property.attribute].values.push_back(value);
    return true;
  }

  bool read_list(const Property& property)
  {
    double count = 0, value = 0;
    if(!read_value(property.count_type, count))
      return false;
    m_list.clear();
    for(double k = 0; k < count; ++k) {
      if(!read_value(property.type, value))
        return false;
      m_list.push_back(value >= 0 && value < 1e15 ? static_cast<std::size_t>(value) : no_vertex);
    }
    return true;
  }

  // Each vertex makes a triangle with the two before it, every other one turned round; a negative one ends the strip.
  void add_strip()
  {
    std::size_t begin = 0;
    for(std::size_t i = 0; i < m_list.size(); ++i) {
      if(m_list[i] == no_vertex)
        begin = i + 1;
      if(i < begin + 2)
        continue;
      std::size_t a = m_list[i - 2], b = m_list[i - 1];
      const std::size_t c = m_list[i];
      if((i - begin) % 2 != 0)
        std::swap(a, b);
      if(a != b && b != c && c != a) // strips turn by repeating a vertex
        m_triangles.push_back({a, b, c});
    }
  }

  bool read_value(const Type type, double& value)
  {
    if(m_text)
      return read_word(value);
    switch(type) {
    case Type::int8:
      return read_as<std::int8_t>(value);
    case Type::uint8:
      return read_as<std::uint8_t>(value);
    case Type::int16:
      return read_as<std::int16_t>(value);
    case Type::uint16:
      return read_as<std::uint16_t>(value);
    case Type::int32:
      return read_as<std::int32_t>(value);
    case Type::uint32:
      return read_as<std::uint32_t>(value);
    case Type::float32:
      return read_as<float>(value);
    case Type::float64:
      return read_as<double>(value);
    case Type::none:
      break;
    }
    return false;
  }

  // Whether a number, of a text for instance, is one of the type.
  static bool holds(const Type type, const double value)
  {
    if(type == Type::float32 || type == Type::float64)
      return true;
    const int number = static_cast<int>(type) - 1; // signed and unsigned ones of 8, 16, 32 bits in turn
    const int bits = 8 << number / 2;
    const bool is_signed = number % 2 == 0;
    const double end = std::ldexp(1., is_signed ? bits - 1 : bits);
    return value >= (is_signed ? -end : 0.) && value < end && value == std::floor(value);
  }

  // The bytes end with a 0.
  bool read_word(double& value)
  {
    char* end = nullptr;
    value = std::strtod(m_at, &end);
    const bool good = end != m_at && (*end == '\0' || std::isspace(static_cast<unsigned char>(*end)));
    m_at = end;
    return good;
  }

  template <class Number>
  bool read_as(double& value)
  {
    char bytes[sizeof(Number)];
    if(static_cast<std::size_t>(m_end - m_at) < sizeof(Number))
      return false;
    std::memcpy(bytes, m_at, sizeof(Number));
    m_at += sizeof(Number);
    const std::uint16_t one = 1;
    const bool big_endian_machine = *reinterpret_cast<const unsigned char*>(&one) == 0;
    if(m_big_endian != big_endian_machine)
      std::reverse(bytes, bytes + sizeof(Number));
    Number number;
    std::memcpy(&number, bytes, sizeof(Number));
    value = static_cast<double>(number);
    return true;
  }

  std::string m_bytes; // of the file
  const char *m_at = nullptr, *m_end = nullptr;
  char m_line_end = '\n';
  bool m_text = false, m_big_endian = false;
  std::vector<Element> m_elements;
  std::vector<std::size_t> m_list;
  std::vector<std::vector<std::size_t>> m_triangles; // of strips
  Polygon_soup m_soup;
};

#endif // SPECTRAL_EXAMPLES_IO_PLY_READER_H
