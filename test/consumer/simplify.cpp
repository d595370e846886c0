// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Called by main(), which stands in another file.
#include "simplify.h"

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

namespace SMS = CGAL::Surface_mesh_simplification;

Eigen::SparseMatrix<double> simplify(Mesh& mesh, std::size_t number_of_vertices,
                                     std::string& solver)
{
  SMS::Spectral_options options;
  options.number_of_eigenvectors = 20;
  SMS::Spectral_policies spectral(mesh, options);
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(number_of_vertices, mesh),
                     CGAL::parameters::get_cost(spectral.get_cost())
                         .get_placement(spectral.get_placement())
                         .visitor(spectral.visitor()));
  solver = spectral.eigenpairs()->solver;
  return spectral.restriction();
}
