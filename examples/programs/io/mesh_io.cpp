// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_io.h"

#include "matrix_io.h"
#include "ply_reader.h"
#include "silence.h"
#include "text_lines.h"
#include "text_mesh_readers.h"

#include <CGAL/IO/Color.h>
#include <CGAL/IO/STL.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <istream>
#include <new>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

std::string mesh_format(const std::string& path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if(extension != ".off" && extension != ".obj" && extension != ".ply" && extension != ".stl")
    throw std::runtime_error("the format of '" + path +
                             "' is unknown: its name must end in .off, .obj, .ply or .stl.");
  return extension;
}

namespace {

// CGAL's reader takes a text for binary where a byte order mark comes before its first word, "solid", or a tab behind it, and keeps what it
// has misread beside the faces.
Polygon_soup read_stl(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  std::string start(84, '\0'); // of binary files: words, and the number of faces, 50 bytes each
  file.read(&start[0], 84);
  std::uintmax_t faces = 0;
  for(const std::size_t i : {83, 82, 81, 80})
    faces = 256 * faces + static_cast<unsigned char>(start[i]);
  const bool binary = std::filesystem::file_size(path) == 84 + 50 * faces;
  const bool marked = has_byte_order_mark(start);
  const std::size_t solid = start.find_first_not_of(" \t\r\n", marked ? 3 : 0);
  const bool respelt =
      !binary && solid < 70 && start.compare(solid, 5, "solid") == 0 && (marked || start[solid + 5] == '\t');
  file.clear();
  file.seekg(respelt ? std::streamoff(solid + 6) : 0);
  std::stringstream text;
  if(respelt)
    text << "solid " << file.rdbuf();
  Polygon_soup soup;
  const Silence silence;
  if(!CGAL::IO::read_STL(respelt ? text : static_cast<std::istream&>(file), soup.points, soup.polygons))
    throw std::runtime_error("it is damaged or cut off");
  return soup;
}

} // namespace

Polygon_soup read_polygon_soup(const std::string& path)
{
  const std::string format = mesh_format(path);
  std::error_code error; // what it is about, opening the file says
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if(std::filesystem::is_directory(status))
    throw std::runtime_error("cannot read '" + path + "': it is a folder.");
  if(std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw std::runtime_error("cannot read '" + path + "': it is not an ordinary file.");
  std::ifstream file(path, std::ios::binary);
  if(!file)
    throw std::runtime_error("cannot read '" + path + "': " + std::strerror(errno) + ".");
  const int first = file.get(), second = file.get();
  if(first == 0x1F && second == 0x8B)
    throw std::runtime_error("cannot read '" + path + "': it is compressed, unpack it first.");
  if(format != ".stl" && ((first == 0xFF && second == 0xFE) || (first == 0xFE && second == 0xFF)))
    throw std::runtime_error("cannot read '" + path + "': it is in UTF-16, save it as UTF-8.");

  Polygon_soup soup;
  try {
    soup = format == ".off"   ? read_off(path)
           : format == ".obj" ? read_obj(path)
           : format == ".ply" ? Ply_reader::read(path)
                              : read_stl(path);
    if(soup.points.empty())
      throw std::runtime_error("it holds no points");
  } catch(const std::bad_alloc&) {
    throw;
  } catch(const std::exception& fault) {
    throw std::runtime_error("cannot read '" + path + "': it is not a valid " + format.substr(1) + " file; " +
                             fault.what() + ".");
  }
  if(soup.polygons.empty())
    throw std::runtime_error("'" + path + "' holds points but no faces.");
  return soup;
}

CGAL::Spectral_geometry::Mesh_diagnosis diagnose(const Polygon_soup& soup)
{
  Eigen::MatrixXd V(Eigen::Index(soup.points.size()), 3);
  for(std::size_t v = 0; v < soup.points.size(); ++v)
    V.row(Eigen::Index(v)) << soup.points[v].x(), soup.points[v].y(), soup.points[v].z();
  return CGAL::Spectral_geometry::diagnose_polygon_soup(V, soup.polygons);
}

Vertex_attributes writable(const Vertex_attributes& attributes, const std::string& name)
{
  const std::string format = mesh_format(name);
  if(format == ".ply")
    return attributes;
  Vertex_attributes result;
  using Kind = Vertex_attribute::Kind;
  const auto take = [&](const Kind kind, const auto& names) {
    const auto found = attributes.find(names);
    if(std::all_of(found.begin(), found.end(),
                   [&](const Vertex_attribute* const a) { return a != nullptr && a->kind() == kind; }))
      for(const Vertex_attribute* const a : found)
        result.known.push_back(*a);
  };
  if(format != ".stl") {
    take(Kind::normal, std::array<const char*, 3>{"nx", "ny", "nz"});
    take(Kind::colour, std::array<const char*, 3>{"red", "green", "blue"});
  }
  if(format == ".obj")
    take(Kind::function, std::array<const char*, 2>{"s", "t"});
  return result;
}

namespace {

template <class Number>
void add_property(Mesh& mesh, const Vertex_attribute& a)
{
  auto map = mesh.add_property_map<Mesh::Vertex_index, Number>(a.name).first;
  std::size_t i = 0;
  for(const auto v : vertices(mesh))
    map[v] = static_cast<Number>(a.values[i++]);
}

// Property maps, which CGAL's writer of PLY files writes.
void add_properties(Mesh& mesh, const Vertex_attributes& attributes)
{
  for(const Vertex_attribute& a : attributes.known)
    (a.type == "char"     ? add_property<std::int8_t>
     : a.type == "uchar"  ? add_property<std::uint8_t>
     : a.type == "short"  ? add_property<std::int16_t>
     : a.type == "ushort" ? add_property<std::uint16_t>
     : a.type == "int"    ? add_property<std::int32_t>
     : a.type == "uint"   ? add_property<std::uint32_t>
     : a.type == "float"  ? add_property<float>
                          : add_property<double>)(mesh, a);
}

// The property maps that CGAL's writer of OFF files looks for.
void add_normals_and_colours(Mesh& mesh, const Vertex_attributes& attributes)
{
  const auto n = attributes.find(std::array<const char*, 3>{"nx", "ny", "nz"});
  const auto c = attributes.find(std::array<const char*, 3>{"red", "green", "blue"});
  std::size_t i = 0;
  if(n[0] != nullptr) {
    auto map = mesh.add_property_map<Mesh::Vertex_index, Kernel::Vector_3>("v:normal").first;
    for(const auto v : vertices(mesh)) {
      map[v] = Kernel::Vector_3(n[0]->values[i], n[1]->values[i], n[2]->values[i]);
      ++i;
    }
  }
  i = 0;
  if(c[0] != nullptr) {
    auto map = mesh.add_property_map<Mesh::Vertex_index, CGAL::IO::Color>("v:color").first;
    for(const auto v : vertices(mesh)) {
      const auto channel = [&](const Vertex_attribute* const a) {
        return static_cast<unsigned char>(a->values[i]);
      };
      map[v] = CGAL::IO::Color(channel(c[0]), channel(c[1]), channel(c[2]));
      ++i;
    }
  }
}

// Writes the lines vt, each value of a vertex once, and returns by halfedges which is that of the corner at the target.
std::vector<std::size_t> write_texture(std::ostream& stream, const Mesh& mesh, const Corner_texture& texture)
{
  std::vector<std::size_t> number(mesh.num_halfedges()), written; // corners of one vertex
  std::size_t n = 0;
  for(const auto v : vertices(mesh)) {
    written.clear();
    for(const auto h : halfedges_around_target(v, mesh)) {
      if(mesh.is_border(h))
        continue;
      const auto same = std::find_if(written.begin(), written.end(),
                                     [&](const std::size_t other) { return texture[other] == texture[h]; });
      if(same != written.end()) {
        number[h] = number[*same];
        continue;
      }
      stream << "vt " << texture[h][0] << ' ' << texture[h][1] << '\n';
      number[h] = ++n;
      written.push_back(h);
    }
  }
  return number;
}

// CGAL's writer of OBJ files knows neither colours nor textures.
bool write_obj(std::ostream& stream, const Mesh& mesh, const Vertex_attributes& attributes,
               Corner_texture texture)
{
  const auto c = attributes.find(std::array<const char*, 3>{"red", "green", "blue"});
  const auto n = attributes.find(std::array<const char*, 3>{"nx", "ny", "nz"});
  const auto t = attributes.find(std::array<const char*, 2>{"s", "t"});
  const bool at_vertices = texture.empty() && t[0] != nullptr;
  texture.resize(at_vertices ? mesh.num_halfedges() : texture.size());
  std::vector<std::size_t> number(mesh.num_vertices());
  std::size_t i = 0;
  for(const auto v : vertices(mesh)) {
    const auto write = [&](const char* keyword, const auto& channels, const double unit) {
      stream << keyword;
      for(const Vertex_attribute* const a : channels)
        stream << ' ' << a->values[i] / unit;
    };
    stream << "v " << mesh.point(v);
    if(c[0] != nullptr)
      write("", c, 255);
    if(n[0] != nullptr)
      write("\nvn", n, 1);
    stream << '\n';
    if(at_vertices)
      for(const auto h : halfedges_around_target(v, mesh))
        texture[h] = {t[0]->values[i], t[1]->values[i]};
    number[v] = ++i;
  }
  std::vector<std::size_t> texture_number;
  if(!texture.empty())
    texture_number = write_texture(stream, mesh, texture);
  for(const auto f : faces(mesh)) {
    stream << 'f';
    for(const auto h : halfedges_around_face(halfedge(f, mesh), mesh)) {
      const std::size_t corner = number[mesh.target(h)];
      stream << ' ' << corner;
      if(!texture.empty() || n[0] != nullptr)
        stream << '/';
      if(!texture.empty())
        stream << texture_number[h];
      if(n[0] != nullptr)
        stream << '/' << corner;
    }
    stream << '\n';
  }
  return stream.good();
}

} // namespace

void write_mesh(const std::string& file, const Mesh& mesh, const std::string& name,
                const Vertex_attributes& attributes, const Corner_texture& texture)
{
  const std::string format = mesh_format(name);
  const Vertex_attributes written = writable(attributes, name);
  std::ofstream stream(file, std::ios::binary);
  stream.precision(17); // give every double back
  if(format == ".ply" || format == ".stl")
    CGAL::IO::set_binary_mode(stream);
  Mesh copy;
  if(!written.known.empty() && format != ".obj") {
    copy = mesh;
    (format == ".ply" ? add_properties : add_normals_and_colours)(copy, written);
  }
  const Mesh& decorated = copy.is_empty() ? mesh : copy;
  // CGAL's functions that open the file themselves do not say when the disk is full.
  const bool good = format == ".ply"   ? CGAL::IO::write_PLY(stream, decorated)
                    : format == ".stl" ? CGAL::IO::write_STL(stream, mesh)
                    : format == ".obj" ? write_obj(stream, mesh, written, texture)
                                       : CGAL::IO::write_OFF(stream, decorated);
  if(!good)
    throw Write_error(name, "the disk refused it, is it full?");
  finish_writing(stream, name);
}
