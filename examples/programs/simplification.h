// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_SIMPLIFICATION_H
#define SPECTRAL_EXAMPLES_SIMPLIFICATION_H

#include "io/mesh_io.h"

#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_result.h>
#include <CGAL/Surface_mesh_simplification/quadric_edge_collapse.h>

#include <cstddef>
#include <functional>

// spectral_edge_collapse() for the mesh of the programs: CGAL's loop with the policies is compiled
// once for all of them.
CGAL::Surface_mesh_simplification::Spectral_edge_collapse_result
simplify_mesh(Mesh& mesh, std::size_t number_of_vertices,
              const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options& options);

// quadric_edge_collapse(), the same way.
CGAL::Surface_mesh_simplification::Quadric_edge_collapse_result
simplify_mesh_by_quadrics(Mesh& mesh, std::size_t number_of_vertices,
                          const std::function<bool(double)>& progress);

#endif // SPECTRAL_EXAMPLES_SIMPLIFICATION_H
