// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_MESH_IO_H
#define SPECTRAL_EXAMPLES_IO_MESH_IO_H

#include "matrix_io.h"
#include "ply_reader.h"
#include "polygon_soup.h"
#include "text_mesh_readers.h"

#include <CGAL/Spectral_geometry/mesh_diagnosis.h>

#include <CGAL/IO/STL.h>
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
#include <new>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <system_error>

using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

// Reading and writing of meshes with errors of one sentence that name the file and the first offender.

// Returns the extension of a mesh file in lower case; throws when the programs do not read and write it.
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

inline Polygon_soup read_stl(const std::string& path)
{
  Polygon_soup soup;
  const Silence silence;
  if(!CGAL::IO::read_STL(path, soup.points, soup.polygons) || soup.points.empty())
    throw std::runtime_error("it is damaged or cut off");
  return soup;
}

inline Polygon_soup read_polygon_soup(const std::string& path)
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
  if(file.get() == 0x1F && file.get() == 0x8B)
    throw std::runtime_error("cannot read '" + path + "': it is compressed, unpack it first.");

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

inline CGAL::Spectral_geometry::Mesh_diagnosis diagnose(const Polygon_soup& soup)
{
  Eigen::MatrixXd V(Eigen::Index(soup.points.size()), 3);
  for(std::size_t v = 0; v < soup.points.size(); ++v)
    V.row(Eigen::Index(v)) << soup.points[v].x(), soup.points[v].y(), soup.points[v].z();
  return CGAL::Spectral_geometry::diagnose_polygon_soup(V, soup.polygons);
}

// Writes a mesh, its vertices in the order of `vertices(mesh)`, to the file `file`, which errors call `name`.
inline void write_mesh(const std::string& file, const Mesh& mesh, const std::string& name)
{
  const std::string format = mesh_format(name);
  std::ofstream stream(file, std::ios::binary);
  stream.precision(17); // give every double back
  if(format == ".ply" || format == ".stl")
    CGAL::IO::set_binary_mode(stream);
  // CGAL's functions that open the file themselves do not say when the disk is full.
  const bool good = format == ".ply"   ? CGAL::IO::write_PLY(stream, mesh)
                    : format == ".stl" ? CGAL::IO::write_STL(stream, mesh)
                    : format == ".obj" ? CGAL::IO::write_OBJ(stream, mesh)
                                       : CGAL::IO::write_OFF(stream, mesh);
  if(!good)
    throw Write_error(name, "the disk refused it, is it full?");
  finish_writing(stream, name);
}

#endif // SPECTRAL_EXAMPLES_IO_MESH_IO_H
