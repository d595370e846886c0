// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_PYTHON_MESHES_H
#define SPECTRAL_PYTHON_MESHES_H

#include "../programs/io/mesh_io.h"
#include "arguments.h"

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/mesh_diagnosis.h>

#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>

#include <cstddef>
#include <stdexcept>
#include <string>
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
    result.push_back(
        {std::size_t(matrices.T(f, 0)), std::size_t(matrices.T(f, 1)), std::size_t(matrices.T(f, 2))});
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

#endif // SPECTRAL_PYTHON_MESHES_H
