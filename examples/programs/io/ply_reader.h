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

// PLY files: text or binary of either byte order, numbers of any type, faces or, as scanned models
// have them, strips of triangles (element tristrips). CGAL's reader knows neither strips nor
// indices of fewer than 32 bits, crashes on coordinates that are integers, and reserves gigabytes
// for a face that claims to have a billion vertices.
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
    if(std::any_of(reader.m_at, reader.m_end, [](const char c) {
         return c != '\0' && !std::isspace(static_cast<unsigned char>(c));
       }))
      refuse("it goes on after the last element that its header announces");
    Polygon_soup& soup = reader.m_soup;
    const auto complete = [](Attributes& attributes, const std::size_t n) {
      for(const Attribute& a : attributes.known)
        if(a.values.size() != n) { // of a second element of that name
          attributes.known.clear();
          break;
        }
    };
    complete(soup.attributes, soup.points.size());
    complete(soup.face_attributes, soup.polygons.size());
    find_colours(soup.attributes);
    std::size_t corners = 0;
    for(const auto& polygon : soup.polygons)
      corners += polygon.size();
    if(soup.texture.size() != corners)
      soup.texture.clear();
    if(soup.polygons.empty())
      soup.polygons = std::move(reader.m_triangles);
    return std::move(soup);
  }

private:
  enum class Type { none, int8, uint8, int16, uint16, int32, uint32, float32, float64 };
  struct Property
  {
    Type count_type = Type::none, type = Type::none; // no type of a count: a single value
    std::size_t coordinate = 3;                      // 0 to 2 for x to z
    std::string name;
    bool vertices = false;             // of a face
    bool indices = false;              // of vertices: that, or a strip
    bool texture = false;              // at the corners of a face, two numbers each
    std::size_t attribute = no_vertex; // its number among those of its element
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

  static const char* name_of(const Type type)
  {
    return type_names[2 * (static_cast<std::size_t>(type) - 1)];
  }

  void read_header()
  {
    std::string line, word;
    bool has_format = false;
    if(!next_line(line) || line.compare(0, 3, "ply") != 0)
      refuse("its first word is not ply");
    while(next_line(line)) {
      std::istringstream words(line);
      word.clear();
      words >> word;
      if(word == "end_header") {
        if(!has_format)
          refuse("its header has no line that begins with format");
        check_properties();
        return;
      }
      if(word == "format") {
        has_format = true;
        words >> word;
        m_text = word == "ascii";
        m_big_endian = word == "binary_big_endian";
        if(!m_text && !m_big_endian && word != "binary_little_endian")
          refuse("its format is " + quoted(word));
      } else if(word == "element") {
        m_elements.emplace_back();
        std::string count;
        words >> m_elements.back().name >> count;
        if(count.empty() || count.size() > 15 ||
           count.find_first_not_of("0123456789") != std::string::npos)
          refuse("its header has the element " + quoted(m_elements.back().name) + " with " +
                 quoted(count) + " where a number is expected");
        m_elements.back().count = static_cast<std::size_t>(std::stoull(count));
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
    property.name = name;
    const bool vertex = element == "vertex", face = element == "face";
    if(vertex && !list && (name == "x" || name == "y" || name == "z"))
      property.coordinate = std::size_t(name[0] - 'x');
    property.vertices = face && list && (name == "vertex_indices" || name == "vertex_index");
    property.indices = property.vertices || (list && element == "tristrips");
    property.texture = face && list && name == "texcoord";
    Attributes& attributes = vertex ? m_soup.attributes : m_soup.face_attributes;
    if(!vertex && !face)
      return property;
    if(!list && property.coordinate == 3 && attributes.find(name) == nullptr) {
      property.attribute = attributes.known.size();
      attributes.add(name, name_of(property.type), {});
    } else if(list && !property.vertices && !property.texture)
      attributes.unknown.push_back("property " + name + " of " + element);
    return property;
  }

  // A coordinate that is not there is no 0. Some programs call them X, Y and Z.
  void check_properties()
  {
    const auto element = [this](const char* name) {
      const auto found = std::find_if(m_elements.begin(), m_elements.end(),
                                      [&](const Element& e) { return e.name == name; });
      return found == m_elements.end() ? nullptr : &*found;
    };
    Element* const vertices = element("vertex");
    if(vertices == nullptr)
      refuse("its header has no element vertex");
    std::vector<std::string> capitals;
    for(std::size_t c = 0; c < 3; ++c) {
      Property* capital = nullptr;
      std::size_t found = 0;
      for(Property& property : vertices->properties) {
        found += property.coordinate == c;
        if(property.name == std::string(1, "XYZ"[c]) && property.count_type == Type::none)
          capital = &property;
      }
      if(found > 1)
        refuse(std::string("its vertices have two properties ") + "xyz"[c]);
      if(found == 0 && capital == nullptr)
        refuse(std::string("its vertices have no property ") + "xyz"[c]);
      if(found == 0) {
        capital->coordinate = c;
        capital->attribute = no_vertex;
        capitals.push_back(capital->name);
      }
    }
    if(!capitals.empty()) {
      m_soup.attributes.remove(capitals);
      for(Property& property : vertices->properties)
        for(std::size_t k = 0; k < m_soup.attributes.known.size(); ++k)
          if(property.coordinate == 3 && m_soup.attributes.known[k].name == property.name)
            property.attribute = k;
    }
    Element* const faces = element("face");
    if(faces != nullptr && faces->count > 0 && element("tristrips") == nullptr &&
       std::none_of(faces->properties.begin(), faces->properties.end(),
                    [](const Property& property) { return property.vertices; }))
      refuse("its faces have no property vertex_indices, which lists their vertices");
  }

  void read_element(const Element& element)
  {
    const bool vertices = element.name == "vertex", strips = element.name == "tristrips";
    if(element.properties.empty())
      return;
    for(std::size_t i = 0; i < element.count; ++i) {
      std::array<double, 3> point = {0, 0, 0};
      Attributes& attributes = vertices ? m_soup.attributes : m_soup.face_attributes;
      for(const Property& property : element.properties) {
        m_refused.clear();
        if(!(property.count_type == Type::none ? read_single(property, point, attributes)
                                               : read_list(property)))
          refuse((m_refused.empty() ? "it is damaged or cut off" : m_refused) + " at " +
                 quoted(element.name) + " " + std::to_string(i) + " of " +
                 std::to_string(element.count) + " (counted from 0)");
        if(property.vertices) {
          m_soup.polygons.emplace_back();
          for(const double v : m_list)
            m_soup.polygons.back().push_back(index(v));
        } else if(property.texture)
          for(std::size_t c = 1; c < m_list.size(); c += 2)
            m_soup.texture.push_back({m_list[c - 1], m_list[c]});
        else if(property.count_type != Type::none && strips)
          add_strip();
      }
      if(vertices)
        m_soup.points.emplace_back(point[0], point[1], point[2]);
    }
  }

  static std::size_t index(const double value)
  {
    return value >= 0 && value < 1e15 ? static_cast<std::size_t>(value) : no_vertex;
  }

  bool read_single(const Property& property, std::array<double, 3>& point, Attributes& attributes)
  {
    double value = 0;
    if(!read_value(property.type, value))
      return false;
    if(property.attribute != no_vertex && !holds(property.type, value)) {
      m_refused =
          "its property " + quoted(property.name) + " has a number that its type does not hold";
      return false;
    }
    if(property.coordinate < 3)
      point[property.coordinate] = value;
    if(property.attribute != no_vertex)
      attributes.known[property.attribute].values.push_back(value);
    return true;
  }

  bool read_list(const Property& property)
  {
    double count = 0, value = 0;
    if(!read_value(property.count_type, count))
      return false;
    if(!is_integer(count) || count < 0)
      return refuse_value(property, "length", count, "a whole number from 0");
    m_list.clear();
    for(double k = 0; k < count; ++k) {
      if(!read_value(property.type, value))
        return false;
      if(property.indices && !is_integer(value))
        return refuse_value(property, "vertex", value, "a whole number");
      m_list.push_back(value);
    }
    return true;
  }

  static bool is_integer(const double value)
  {
    return std::isfinite(value) && value == std::floor(value);
  }

  bool refuse_value(const Property& property, const char* what, const double value,
                    const char* expected)
  {
    std::ostringstream text;
    text.precision(15);
    text << "its list " << quoted(property.name) << " has the " << what << ' ' << value << " where "
         << expected << " is expected";
    m_refused = text.str();
    return false;
  }

  // Each vertex makes a triangle with the two before it, every other one turned round; a negative
  // one ends the strip.
  void add_strip()
  {
    std::size_t begin = 0;
    for(std::size_t i = 0; i < m_list.size(); ++i) {
      const std::size_t c = index(m_list[i]);
      if(c == no_vertex)
        begin = i + 1;
      if(i < begin + 2)
        continue;
      std::size_t a = index(m_list[i - 2]), b = index(m_list[i - 1]);
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
    // Signed and unsigned ones of 8, 16, 32 bits in turn.
    const int number = static_cast<int>(type) - 1;
    const int bits = 8 << number / 2;
    const bool is_signed = number % 2 == 0;
    const double end = std::ldexp(1., is_signed ? bits - 1 : bits);
    return value >= (is_signed ? -end : 0.) && value < end && is_integer(value);
  }

  // The bytes end with a 0.
  bool read_word(double& value)
  {
    char* end = nullptr;
    value = std::strtod(m_at, &end);
    const bool good =
        end != m_at && (*end == '\0' || std::isspace(static_cast<unsigned char>(*end)));
    if(!good) {
      const char* begin = m_at;
      while(begin != m_end && std::isspace(static_cast<unsigned char>(*begin)))
        ++begin;
      const char* const word =
          std::find_if(begin, m_end, [](const unsigned char c) { return std::isspace(c) != 0; });
      if(begin != m_end)
        m_refused = "it has " + quoted(std::string(begin, word)) + " where a number is expected";
    }
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
  std::vector<double> m_list;
  std::string m_refused; // why the last value was refused, where that is known
  std::vector<std::vector<std::size_t>> m_triangles; // of strips
  Polygon_soup m_soup;
};

#endif // SPECTRAL_EXAMPLES_IO_PLY_READER_H
