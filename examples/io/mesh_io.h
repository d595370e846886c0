// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_MESH_IO_H
#define SPECTRAL_EXAMPLES_IO_MESH_IO_H

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <utility>
#include <vector>

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

// Reading and writing of meshes with errors of one sentence that name the file and the first offender.

struct Polygon_soup
{
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
};

// Returns the extension of a mesh file in lower case; throws when CGAL does not read and write it.
inline std::string mesh_format(const std::string& path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if(extension != ".off" && extension != ".obj" && extension != ".ply" && extension != ".stl")
    throw std::runtime_error("the format of '" + path +
                             "' is unknown: its name must end in .off, .obj, .ply or .stl.");
  return extension;
}

// CGAL's readers tell some errors to std::cerr in their own words; not while this object lives.
class Silence
{
public:
  Silence()
    : m_buffer(std::cerr.rdbuf(nullptr))
  {}
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
  ~Silence()
  {
    std::cerr.rdbuf(m_buffer);
    std::cerr.clear();
  }

private:
  std::streambuf* m_buffer;
};

inline Polygon_soup read_polygon_soup(const std::string& path)
{
  const std::string format = mesh_format(path);
  if(std::filesystem::is_directory(path))
    throw std::runtime_error("cannot read '" + path + "': it is a folder.");
  if(!std::ifstream(path))
    throw std::runtime_error("cannot read '" + path + "': " + std::strerror(errno) + ".");

  Polygon_soup soup;
  bool good = false;
  try {
    const Silence silence;
    good = CGAL::IO::read_polygon_soup(path, soup.points, soup.polygons);
  } catch(const std::exception&) { // a damaged header asks for any amount of memory
    good = false;
  }
  if(!good || soup.points.empty())
    throw std::runtime_error("cannot read '" + path + "': it is not a valid " + format.substr(1) + " file.");
  if(soup.polygons.empty())
    throw std::runtime_error(
        "'" + path + "' holds points but no faces, at least none that CGAL reads (triangle strips are not).");
  return soup;
}

// Throws at the first face that is no triangle of three different, existing vertices.
inline void check_triangles(const Polygon_soup& soup, const std::string& path)
{
  for(std::size_t f = 0; f < soup.polygons.size(); ++f) {
    const std::vector<std::size_t>& polygon = soup.polygons[f];
    const std::string name = "face " + std::to_string(f) + " (counted from 0) of '" + path + "' ";
    if(polygon.size() != 3)
      throw std::runtime_error(name + "has " + std::to_string(polygon.size()) +
                               " vertices: triangulate the mesh first.");
    for(const std::size_t v : polygon) {
      if(v >= soup.points.size())
        throw std::runtime_error(name + "uses a vertex that does not exist.");
    }
    if(polygon[0] == polygon[1] || polygon[1] == polygon[2] || polygon[2] == polygon[0])
      throw std::runtime_error(name + "uses a vertex twice: remove degenerate faces first.");
  }
}

// Throws at the first place where the triangles do not form an oriented surface without branches.
inline void check_manifold(const Polygon_soup& soup, const std::string& path)
{
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> face_of_halfedge;
  for(std::size_t f = 0; f < soup.polygons.size(); ++f) {
    for(int i = 0; i < 3; ++i) {
      const std::size_t v = soup.polygons[f][i], w = soup.polygons[f][(i + 1) % 3];
      const auto [other, is_new] = face_of_halfedge.try_emplace({v, w}, f);
      if(!is_new)
        throw std::runtime_error("'" + path + "' is not an oriented manifold: its faces " +
                                 std::to_string(other->second) + " and " + std::to_string(f) +
                                 " (counted from 0) run along the edge from vertex " + std::to_string(v) +
                                 " to " + std::to_string(w) + " in the same direction; repair it first.");
    }
  }
  if(!CGAL::Polygon_mesh_processing::is_polygon_soup_a_polygon_mesh(soup.polygons))
    throw std::runtime_error("'" + path +
                             "' is not a manifold: parts of it touch in a single vertex; repair it first.");
}

// Reads a triangle mesh; its vertices have the order of the file (of first appearance for STL).
inline Mesh read_mesh(const std::string& path)
{
  const Polygon_soup soup = read_polygon_soup(path);
  check_triangles(soup, path);
  check_manifold(soup, path);
  Mesh mesh;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, mesh);
  return mesh;
}

// Writes a mesh, its vertices in the order of `vertices(mesh)`, to the file `file`, which errors call `name`.
inline void write_mesh(const std::string& file, const Mesh& mesh, const std::string& name)
{
  // 17 digits give every double back.
  if(!CGAL::IO::write_polygon_mesh(file, mesh, CGAL::parameters::stream_precision(17)))
    throw std::runtime_error("cannot write '" + name + "': " + std::strerror(errno) + ".");
}

#endif // SPECTRAL_EXAMPLES_IO_MESH_IO_H
