// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_io.h"

#include "matrix_io.h"
#include "ply_reader.h"
#include "stl_reader.h"
#include "text_lines.h"
#include "text_mesh_readers.h"

#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <set>
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
    throw std::runtime_error(
        "the format of '" + path + "' is unknown: its name must end in .off, .obj, .ply or .stl" +
        (extension == ".vtk" || extension == ".vtp" || extension == ".gii"
             ? "; the Python package takes what meshio and nibabel read of such files."
             : "."));
  return extension;
}

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
                              : Stl_reader::read(path);
    if(soup.points.empty())
      throw std::runtime_error("it holds no points");
    find_kinds(soup.attributes);
    for(Attribute& a : soup.face_attributes.known)
      a.kind = a.is_integer() ? Attribute::Kind::label : Attribute::Kind::function;
  } catch(const std::bad_alloc&) {
    throw;
  } catch(const std::exception& fault) {
    throw std::runtime_error("cannot read '" + path + "': it is not a valid " + format.substr(1) +
                             " file; " + fault.what() + ".");
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

Attributes writable(const Attributes& attributes, const std::string& name)
{
  const std::string format = mesh_format(name);
  if(format == ".ply")
    return attributes;
  Attributes result;
  using Kind = Attribute::Kind;
  const auto take = [&](const Kind kind, const auto& found) {
    if(std::all_of(found.begin(), found.end(),
                   [&](const Attribute* const a) { return a != nullptr && a->kind == kind; }))
      for(const Attribute* const a : found)
        result.known.push_back(*a);
  };
  if(format != ".stl") {
    take(Kind::normal, attributes.find(std::array<const char*, 3>{"nx", "ny", "nz"}));
    take(Kind::colour, colour_of(attributes));
  }
  if(format == ".obj")
    take(Kind::function, attributes.find(std::array<const char*, 2>{"s", "t"}));
  return result;
}

namespace {

// What OBJ files say of the faces that follow, and the attribute that holds it.
constexpr std::array<std::array<const char*, 2>, 4> face_keywords = {
    {{"o", "object"}, {"g", "group"}, {"usemtl", "material"}, {"s", "smoothing_group"}}};

bool is_integer(const Attribute* const a)
{
  return a != nullptr && a->is_integer();
}

// The label of faces that has one number a face in OFF and STL files.
const Attribute* face_label(const Attributes& attributes)
{
  const auto found =
      std::find_if(attributes.known.begin(), attributes.known.end(), [](const Attribute& a) {
        return a.is_integer() && a.words.empty() && colour_channel_of(a.name).first == 4;
      });
  return found == attributes.known.end() ? nullptr : &*found;
}

} // namespace

Attributes writable_at_faces(const Attributes& attributes, const std::string& name)
{
  const std::string format = mesh_format(name);
  if(format == ".ply")
    return attributes;
  Attributes result;
  if(format == ".obj") {
    for(const Attribute& a : attributes.known)
      if(std::any_of(face_keywords.begin(), face_keywords.end(),
                     [&](const auto& keyword) { return a.name == keyword[1] && !a.words.empty(); }))
        result.known.push_back(a);
    return result;
  }
  const auto colour = colour_of(attributes);
  const Attribute* const label = face_label(attributes);
  if(std::all_of(colour.begin(), colour.end(), is_integer)) {
    for(const Attribute* const a : colour)
      result.known.push_back(*a);
    if(const Attribute* const alpha = attributes.find("alpha");
       format == ".stl" && is_integer(alpha))
      result.known.push_back(*alpha);
  } else if(label != nullptr &&
            (format == ".off" ||
             (*std::min_element(label->values.begin(), label->values.end()) >= 0 &&
              *std::max_element(label->values.begin(), label->values.end()) < 32768)))
    result.known.push_back(*label);
  return result;
}

namespace {

template <class Number, class Range, class Map>
void fill(const Attribute& a, const Range& range, Map map)
{
  std::size_t i = 0;
  for(const auto x : range)
    map[x] = static_cast<Number>(a.values[i++]);
}

template <class Number>
void add_property(Mesh& mesh, const Attribute& a, const bool of_faces)
{
  if(of_faces)
    fill<Number>(a, faces(mesh), mesh.add_property_map<Mesh::Face_index, Number>(a.name).first);
  else
    fill<Number>(a, vertices(mesh),
                 mesh.add_property_map<Mesh::Vertex_index, Number>(a.name).first);
}

// Property maps, which CGAL's writer of PLY files writes.
void add_properties(Mesh& mesh, const Attributes& attributes, const bool of_faces)
{
  for(const Attribute& a : attributes.known)
    (a.type == "char"     ? add_property<std::int8_t>
     : a.type == "uchar"  ? add_property<std::uint8_t>
     : a.type == "short"  ? add_property<std::int16_t>
     : a.type == "ushort" ? add_property<std::uint16_t>
     : a.type == "int"    ? add_property<std::int32_t>
     : a.type == "uint"   ? add_property<std::uint32_t>
     : a.type == "float"  ? add_property<float>
                          : add_property<double>)(mesh, a, of_faces);
}

// What the numbers of materials and the like mean: "material 0 is Skin".
std::string comments_of(const Attributes& attributes)
{
  std::string text;
  for(const Attribute& a : attributes.known)
    for(std::size_t i = 0; i < a.words.size(); ++i)
      text += a.name + " " + std::to_string(i) + " is " + a.words[i] + "\n";
  return text;
}

bool write_ply(std::ostream& stream, const Mesh& mesh, const Attributes& at_vertices,
               const Attributes& at_faces)
{
  CGAL::IO::set_binary_mode(stream);
  Mesh copy = mesh;
  add_properties(copy, at_vertices, false);
  add_properties(copy, at_faces, true);
  return CGAL::IO::write_PLY(stream, copy, comments_of(at_faces));
}

bool write_off(std::ostream& stream, const Mesh& mesh, const Attributes& at_vertices,
               const Attributes& at_faces)
{
  const auto n = at_vertices.find(std::array<const char*, 3>{"nx", "ny", "nz"});
  const auto c = colour_of(at_vertices), d = colour_of(at_faces);
  const Attribute* const label = face_label(at_faces);
  const auto byte = [](const double x, const double unit) { return std::round(255 * x / unit); };
  stream << (c[0] != nullptr ? "C" : "") << (n[0] != nullptr ? "N" : "") << "OFF\n"
         << mesh.number_of_vertices() << ' ' << mesh.number_of_faces() << " 0\n\n";
  std::vector<std::size_t> number(mesh.num_vertices());
  std::size_t i = 0;
  const double unit = c[0] != nullptr ? full_scale(c) : 1,
               face_unit = d[0] != nullptr ? full_scale(d) : 1;
  for(const auto v : vertices(mesh)) {
    stream << mesh.point(v);
    for(const Attribute* const a : n)
      if(a != nullptr)
        stream << ' ' << a->values[i];
    for(const Attribute* const a : c)
      if(a != nullptr)
        stream << ' ' << byte(a->values[i], unit);
    stream << '\n';
    number[v] = i++;
  }
  stream << '\n';
  i = 0;
  for(const auto f : faces(mesh)) {
    stream << mesh.degree(f);
    for(const auto v : vertices_around_face(mesh.halfedge(f), mesh))
      stream << ' ' << number[v];
    for(const Attribute* const a : d)
      if(a != nullptr)
        stream << ' ' << byte(a->values[i], face_unit);
    if(d[0] == nullptr && label != nullptr)
      stream << ' ' << static_cast<long long>(label->values[i]);
    stream << '\n';
    ++i;
  }
  return stream.good();
}

bool write_stl(std::ostream& stream, const Mesh& mesh, const Attributes& at_faces)
{
  const auto put = [&stream](const std::uint32_t bits, const int bytes) {
    for(int i = 0; i < bytes; ++i)
      stream.put(static_cast<char>(bits >> 8 * i & 255));
  };
  const auto put_point = [&put](const auto& p) {
    for(const double x : {p.x(), p.y(), p.z()}) {
      const float rounded = static_cast<float>(x);
      std::uint32_t bits = 0;
      std::memcpy(&bits, &rounded, 4);
      put(bits, 4);
    }
  };
  const auto c = colour_of(at_faces);
  const Attribute* const alpha = at_faces.find("alpha");
  const Attribute* const label = face_label(at_faces);
  const double unit = c[0] != nullptr ? full_scale(c) : 1;
  stream << "FileType: Binary" << std::string(64, ' ');
  put(static_cast<std::uint32_t>(mesh.number_of_faces()), 4);
  std::size_t i = 0;
  for(const auto f : faces(mesh)) {
    const auto h = mesh.halfedge(f);
    const Kernel::Point_3 &p = mesh.point(mesh.source(h)), &q = mesh.point(mesh.target(h)),
                          &r = mesh.point(mesh.target(mesh.next(h)));
    const Kernel::Vector_3 n = CGAL::cross_product(q - p, r - p);
    const double length = std::sqrt(n.squared_length());
    put_point(length > 0 ? n / length : Kernel::Vector_3(0, 0, 0));
    for(const auto& point : {p, q, r})
      put_point(point);
    std::uint32_t mark = 0;
    if(c[0] != nullptr && (alpha == nullptr || alpha->values[i] != 0)) {
      mark = 1; // five bits for each channel, and this one to say that they are a colour
      for(const Attribute* const a : c)
        mark = 32 * mark + static_cast<std::uint32_t>(std::round(31 * a->values[i] / unit));
    } else if(c[0] == nullptr && label != nullptr)
      mark = static_cast<std::uint32_t>(label->values[i]);
    put(mark, 2);
    ++i;
  }
  return stream.good();
}

// Writes the lines vt, each value of a vertex once, and returns by halfedges which is that of the
// corner at the target.
std::vector<std::size_t> write_texture(std::ostream& stream, const Mesh& mesh,
                                       const Corner_texture& texture)
{
  std::vector<std::size_t> number(mesh.num_halfedges()), written; // corners of one vertex
  std::size_t n = 0;
  for(const auto v : vertices(mesh)) {
    written.clear();
    for(const auto h : halfedges_around_target(v, mesh)) {
      if(mesh.is_border(h))
        continue;
      const auto same = std::find_if(written.begin(), written.end(), [&](const std::size_t other) {
        return texture[other] == texture[h];
      });
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
bool write_obj(std::ostream& stream, const Mesh& mesh, const Attributes& attributes,
               const Attributes& at_faces, Corner_texture texture,
               const std::vector<std::string>& libraries)
{
  for(const std::string& library : libraries)
    stream << "mtllib " << library << '\n';
  const auto c = colour_of(attributes);
  const double unit_of_colour = c[0] != nullptr ? full_scale(c) : 1;
  const auto n = attributes.find(std::array<const char*, 3>{"nx", "ny", "nz"});
  const auto t = attributes.find(std::array<const char*, 2>{"s", "t"});
  const bool at_vertices = texture.empty() && t[0] != nullptr;
  texture.resize(at_vertices ? mesh.num_halfedges() : texture.size());
  std::vector<std::size_t> number(mesh.num_vertices());
  std::size_t i = 0;
  for(const auto v : vertices(mesh)) {
    const auto write = [&](const char* keyword, const auto& channels, const double unit) {
      stream << keyword;
      for(const Attribute* const a : channels)
        stream << ' ' << a->values[i] / unit;
    };
    stream << "v " << mesh.point(v);
    if(c[0] != nullptr)
      write("", c, unit_of_colour);
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
  std::vector<double> said(face_keywords.size(), -1);
  std::size_t face = 0;
  for(const auto f : faces(mesh)) {
    for(std::size_t k = 0; k < face_keywords.size(); ++k) {
      const Attribute* const a = at_faces.find(face_keywords[k][1]);
      if(a == nullptr || a->values[face] == said[k])
        continue;
      said[k] = a->values[face];
      stream << face_keywords[k][0] << ' ' << a->words[static_cast<std::size_t>(said[k])] << '\n';
    }
    ++face;
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

std::string rounding(const Mesh& mesh, const std::string& name, const std::size_t simplified_to)
{
  if(mesh_format(name) != ".stl")
    return "";
  double largest = 0;
  const auto round = [](const Kernel::Point_3& p) {
    return Kernel::Point_3(double(float(p.x())), double(float(p.y())), double(float(p.z())));
  };
  std::set<Kernel::Point_3> exact, rounded; // copies at seams are meant
  for(const auto v : vertices(mesh)) {
    const Kernel::Point_3 &p = mesh.point(v), q = round(p);
    for(int i = 0; i < 3; ++i)
      largest = (std::max)(largest, std::abs(p[i] - q[i]));
    exact.insert(p);
    rounded.insert(q);
  }
  const auto is_flat = [](const Kernel::Point_3& p, const Kernel::Point_3& q,
                          const Kernel::Point_3& r) {
    const Kernel::Vector_3 a = q - p, b = r - p, c = r - q;
    const double longest =
        (std::max)((std::max)(a.squared_length(), b.squared_length()), c.squared_length());
    return CGAL::cross_product(a, b).squared_length() <= 1e-20 * longest * longest;
  };
  std::size_t flat = 0;
  for(const auto f : faces(mesh)) {
    const auto h = mesh.halfedge(f);
    const Kernel::Point_3 &p = mesh.point(mesh.source(h)), &q = mesh.point(mesh.target(h)),
                          &r = mesh.point(mesh.target(mesh.next(h)));
    flat += is_flat(round(p), round(q), round(r)) && !is_flat(p, q, r);
  }
  std::vector<double> lengths;
  for(const auto e : edges(mesh))
    lengths.push_back(std::sqrt(
        CGAL::squared_distance(mesh.point(mesh.vertex(e, 0)), mesh.point(mesh.vertex(e, 1)))));
  std::nth_element(lengths.begin(), lengths.begin() + std::ptrdiff_t(lengths.size() / 2),
                   lengths.end());
  const double edge =
      lengths[lengths.size() / 2] *
      (simplified_to != 0 ? std::sqrt(double(mesh.number_of_vertices()) / double(simplified_to))
                          : 1.);
  std::ostringstream figures;
  figures.precision(2);
  figures << "coordinates are rounded by up to " << largest << ", " << largest / edge
          << " times the median edge";
  const std::string remedy =
      ": choose .ply, .obj or .off, which keep them, or move the mesh to the origin.";
  const std::size_t merged = exact.size() - rounded.size();
  if(!std::isfinite(largest))
    throw Write_error(name,
                      "an STL file holds single precision, in which coordinates overflow" + remedy);
  if(simplified_to != 0) {
    if(largest > edge / 2)
      throw Write_error(name,
                        "an STL file holds single precision, in which " + figures.str() + remedy);
    return "";
  }
  if(merged + flat != 0)
    throw Write_error(
        name, "an STL file holds single precision, in which " + figures.str() + ", so that " +
                  (flat != 0 ? std::to_string(flat) + " faces lose their area"
                             : std::to_string(merged) + " vertices fall onto others") +
                  remedy);
  return largest > 1e-3 * edge ? "In '" + name + "' " + figures.str() + remedy : "";
}

void write_mesh(const std::string& file, const Mesh& mesh, const std::string& name,
                const Decoration& decoration)
{
  const std::string format = mesh_format(name);
  rounding(mesh, name);
  const Attributes at_vertices = writable(decoration.vertices, name),
                   at_faces = writable_at_faces(decoration.faces, name);
  std::ofstream stream(file, std::ios::binary);
  stream.precision(17); // give every double back
  // CGAL's functions that open the file themselves do not say when the disk is full.
  const bool good = format == ".ply"   ? write_ply(stream, mesh, at_vertices, at_faces)
                    : format == ".stl" ? write_stl(stream, mesh, at_faces)
                    : format == ".obj" ? write_obj(stream, mesh, at_vertices, at_faces,
                                                   decoration.texture, decoration.libraries)
                                       : write_off(stream, mesh, at_vertices, at_faces);
  if(!good)
    throw Write_error(name, "the disk refused it, is it full?");
  finish_writing(stream, name);
}
