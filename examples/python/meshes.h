// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_PYTHON_MESHES_H
#define SPECTRAL_PYTHON_MESHES_H

#include "../programs/io/input_mesh.h"
#include "../programs/io/mesh_io.h"
#include "arguments.h"
#include "arrays.h"
#include "watch.h"

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_toolbox/mesh_diagnosis.h>

#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>

#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// The library speaks of a mesh; here there may be two.
template <class Function>
auto named(const char* names, const Function& function)
{
  try {
    return function();
  } catch(const std::invalid_argument& error) {
    throw std::invalid_argument(std::string(names) + ": " + error.what());
  }
}

inline std::vector<std::vector<std::size_t>> triangles_of(const SG::Mesh_matrices& matrices)
{
  std::vector<std::vector<std::size_t>> result;
  for(Index f = 0; f < matrices.T.rows(); ++f)
    result.push_back({std::size_t(matrices.T(f, 0)), std::size_t(matrices.T(f, 1)),
                      std::size_t(matrices.T(f, 2))});
  return result;
}

inline Mesh surface_mesh(const SG::Mesh_matrices& matrices)
{
  std::vector<Kernel::Point_3> points;
  for(Index v = 0; v < matrices.V.rows(); ++v)
    points.emplace_back(matrices.V(v, 0), matrices.V(v, 1), matrices.V(v, 2));
  Mesh mesh;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, triangles_of(matrices), mesh);
  return mesh;
}

inline SG::Mesh_diagnosis checked(const SG::Mesh_matrices& matrices, const std::string& names)
{
  const py::gil_scoped_release no_gil;
  SG::Mesh_diagnosis diagnosis = SG::diagnose_polygon_soup(matrices.V, triangles_of(matrices));
  const std::vector<std::string> obstacles = diagnosis.obstacles();
  if(!obstacles.empty())
    refuse(names + " cannot be used as they are: " + obstacles.front() + ".");
  if(matrices.T.rows() == 0)
    refuse(names + " cannot be used as they are: there are no faces.");
  return diagnosis;
}

// A mesh as it comes, which may be none.
inline Polygon_soup soup_of(const Arguments& a)
{
  Polygon_soup soup;
  const auto V = a.array<double>("V", 3, "vertex");
  const auto F = a.array<std::int64_t>("F", 3, "triangle");
  for(py::ssize_t v = 0; v < V.shape(0); ++v)
    soup.points.emplace_back(V.at(v, 0), V.at(v, 1), V.at(v, 2));
  for(py::ssize_t f = 0; f < F.shape(0); ++f) {
    soup.polygons.emplace_back();
    for(py::ssize_t i = 0; i < 3; ++i)
      soup.polygons.back().push_back(F.at(f, i) < 0 ? no_vertex : std::size_t(F.at(f, i)));
  }
  return soup;
}

inline py::list list_of(const std::vector<Repair>& changes)
{
  py::list result;
  for(const Repair& change : changes)
    result.append(to_string(change.count) + " " + change.what());
  return result;
}

// What the programs do with a mesh that they read.
inline py::dict clean(const Arguments& a)
{
  Polygon_soup soup = soup_of(a);
  const Mending mending = a.flag("repair") ? Mending::full : Mending::plain;
  Input_mesh input;
  try {
    Watch watch;
    input = watch.run([&] {
      return input_mesh(std::move(soup), "V, F", mending, false, 0,
                        [&] { return watch("repair", 0); });
    });
  } catch(const py::error_already_set&) {
    throw; // before pybind11 2.10 it is a runtime_error
  } catch(const std::runtime_error& error) {
    // The programs speak of their option.
    std::string said = error.what();
    const std::size_t place = said.find("--repair");
    if(place != std::string::npos)
      said.replace(place, 8, "repair=True");
    refuse(said);
  }
  const SG::Mesh_matrices mesh = SG::mesh_matrices(input.mesh);
  std::vector<std::int64_t> place, origin;
  for(std::size_t v = 0; v < input.numbering.number_of_file_vertices(); ++v)
    place.push_back(input.numbering.mesh_vertex(v) == no_vertex
                        ? -1
                        : std::int64_t(input.numbering.mesh_vertex(v)));
  for(std::size_t w = 0; w < input.numbering.number_of_mesh_vertices(); ++w)
    origin.push_back(std::int64_t(input.numbering.file_vertex(w)));
  py::dict result;
  result["V"] = py::cast(Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>(mesh.V));
  result["F"] = py::cast(Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>(mesh.T));
  result["place"] = array_of(place);
  result["origin"] = array_of(origin);
  result["changes"] = list_of(input.changes);
  return result;
}

// The triangles of a file, or what --repair makes of it, and what that changed.
inline py::tuple read_mesh(const std::string& path, const bool repair)
{
  Polygon_soup soup;
  Input_mesh input;
  try {
    Watch watch;
    soup = watch.run([&] { return read_polygon_soup(path); });
    if(repair)
      input = watch.run([&] {
        return input_mesh(std::move(soup), "'" + path + "'", Mending::full, false, 0,
                          [&] { return watch("repair", 0); });
      });
  } catch(const py::error_already_set&) {
    throw;
  } catch(const std::runtime_error& error) {
    refuse(error.what());
  }
  if(repair) {
    const SG::Mesh_matrices mesh = SG::mesh_matrices(input.mesh);
    return py::make_tuple(mesh.V, mesh.T, list_of(input.changes));
  }
  py::array_t<double> V({py::ssize_t(soup.points.size()), py::ssize_t(3)});
  py::array_t<std::int64_t> F({py::ssize_t(soup.polygons.size()), py::ssize_t(3)});
  for(std::size_t v = 0; v < soup.points.size(); ++v)
    for(int i = 0; i < 3; ++i)
      V.mutable_at(py::ssize_t(v), i) = soup.points[v][i];
  for(std::size_t f = 0; f < soup.polygons.size(); ++f) {
    if(soup.polygons[f].size() != 3)
      refuse("'" + path + "': face " + to_string(f) + " has " + to_string(soup.polygons[f].size()) +
             " corners, it must be a triangle: pass repair=True, which triangulates.");
    for(std::size_t i = 0; i < 3; ++i)
      F.mutable_at(py::ssize_t(f), py::ssize_t(i)) =
          soup.polygons[f][i] == no_vertex ? -1 : std::int64_t(soup.polygons[f][i]);
  }
  return py::make_tuple(V, F, py::list());
}

inline py::dict diagnosis_of(const Arguments& a)
{
  const Polygon_soup soup = soup_of(a);
  SG::Mesh_diagnosis d;
  {
    const py::gil_scoped_release no_gil;
    d = diagnose(soup);
  }
  py::list components;
  for(const SG::Mesh_component& c : d.components)
    components.append(py::make_tuple(c.vertices, c.faces, c.closed, c.first));
  py::dict result;
  result["usable"] = d.usable();
  result["obstacles"] = py::cast(d.obstacles());
  result["remarks"] = py::cast(d.remarks());
  result["components"] = components;
  return result;
}

#endif // SPECTRAL_PYTHON_MESHES_H
