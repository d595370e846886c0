// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_TRIANGLE_STRIPS_H
#define SPECTRAL_EXAMPLES_IO_TRIANGLE_STRIPS_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

// PLY files of scanned models hold strips of triangles (element tristrips) where others hold faces. CGAL's reader passes
// over them and gives the points alone.
class Triangle_strips
{
public:
  // The triangles of the strips in the file; none if there are no strips, or if they are damaged.
  static std::vector<std::vector<std::size_t>> read(const std::string& path)
  {
    Triangle_strips reader(path);
    if(!reader.read_header())
      return {};
    for(const Element& element : reader.m_elements)
      if(!reader.read_element(element))
        return {};
    return std::move(reader.m_triangles);
  }

private:
  struct Property
  {
    std::string count_type, type; // no count_type: a single value
  };
  struct Element
  {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
  };

  explicit Triangle_strips(const std::string& path)
    : m_stream(path, std::ios::binary)
  {}

  // True if the header is one, and ends with strips.
  bool read_header()
  {
    std::string line, word;
    if(!std::getline(m_stream, line) || line.substr(0, 3) != "ply")
      return false;
    while(std::getline(m_stream, line)) {
      std::istringstream words(line);
      words >> word;
      if(word == "end_header")
        return !m_elements.empty() && m_elements.back().name == "tristrips";
      if(word == "format") {
        words >> word;
        m_text = word == "ascii";
        m_big_endian = word == "binary_big_endian";
      } else if(word == "element") {
        m_elements.emplace_back();
        words >> m_elements.back().name >> m_elements.back().count;
      } else if(word == "property" && !m_elements.empty()) {
        Property property;
        words >> property.type;
        if(property.type == "list")
          words >> property.count_type >> property.type;
        m_elements.back().properties.push_back(property);
      }
    }
    return false;
  }

  bool read_element(const Element& element)
  {
    double count = 0, value = 0;
    for(std::size_t i = 0; i < element.count; ++i)
      for(const Property& property : element.properties) {
        if(property.count_type.empty()) {
          if(!read_value(property.type, value))
            return false;
          continue;
        }
        if(!read_value(property.count_type, count))
          return false;
        m_strip.clear();
        for(double k = 0; k < count; ++k) {
          if(!read_value(property.type, value))
            return false;
          if(element.name == "tristrips")
            add(static_cast<long long>(value));
        }
      }
    return true;
  }

  // Each vertex makes a triangle with the two before it, every other one turned round; a negative one ends the strip.
  void add(const long long vertex)
  {
    if(vertex < 0) {
      m_strip.clear();
      return;
    }
    m_strip.push_back(static_cast<std::size_t>(vertex));
    const std::size_t n = m_strip.size();
    if(n < 3)
      return;
    std::size_t a = m_strip[n - 3], b = m_strip[n - 2];
    const std::size_t c = m_strip[n - 1];
    if(n % 2 == 0)
      std::swap(a, b);
    if(a != b && b != c && c != a) // strips turn by repeating a vertex
      m_triangles.push_back({a, b, c});
  }

  bool read_value(const std::string& type, double& value)
  {
    if(m_text)
      return static_cast<bool>(m_stream >> value);
    if(type == "char" || type == "int8")
      return read_as<std::int8_t>(value);
    if(type == "uchar" || type == "uint8")
      return read_as<std::uint8_t>(value);
    if(type == "short" || type == "int16")
      return read_as<std::int16_t>(value);
    if(type == "ushort" || type == "uint16")
      return read_as<std::uint16_t>(value);
    if(type == "int" || type == "int32")
      return read_as<std::int32_t>(value);
    if(type == "uint" || type == "uint32")
      return read_as<std::uint32_t>(value);
    if(type == "float" || type == "float32")
      return read_as<float>(value);
    return (type == "double" || type == "float64") && read_as<double>(value);
  }

  template <class Type>
  bool read_as(double& value)
  {
    char bytes[sizeof(Type)];
    if(!m_stream.read(bytes, sizeof(Type)))
      return false;
    const std::uint16_t one = 1;
    const bool big_endian_machine = *reinterpret_cast<const unsigned char*>(&one) == 0;
    if(m_big_endian != big_endian_machine)
      std::reverse(bytes, bytes + sizeof(Type));
    Type number;
    std::memcpy(&number, bytes, sizeof(Type));
    value = static_cast<double>(number);
    return true;
  }

  std::ifstream m_stream;
  bool m_text = false, m_big_endian = false;
  std::vector<Element> m_elements;
  std::vector<std::size_t> m_strip;
  std::vector<std::vector<std::size_t>> m_triangles;
};

#endif // SPECTRAL_EXAMPLES_IO_TRIANGLE_STRIPS_H
