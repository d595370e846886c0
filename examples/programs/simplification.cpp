// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "simplification.h"

#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

namespace SMS = CGAL::Surface_mesh_simplification;

SMS::Spectral_edge_collapse_result simplify_mesh(Mesh& mesh, const std::size_t number_of_vertices,
                                                 const SMS::Spectral_edge_collapse_options& options)
{
  return SMS::spectral_edge_collapse(mesh, number_of_vertices, options);
}

SMS::Quadric_edge_collapse_result
simplify_mesh_by_quadrics(Mesh& mesh, const std::size_t number_of_vertices,
                          const std::function<bool(double)>& progress)
{
  return SMS::quadric_edge_collapse(mesh, number_of_vertices, progress);
}
