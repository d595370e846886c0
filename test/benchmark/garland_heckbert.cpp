// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// CGAL's plane quadrics from file to file, as its manual has them: what whole runs are measured
// beside. garland_heckbert INPUT OUTPUT N

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <cstdlib>
#include <iostream>

int main(int argc, char** argv)
{
  namespace SMS = CGAL::Surface_mesh_simplification;
  using Kernel = CGAL::Simple_cartesian<double>;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  const long vertices = argc == 4 ? std::atol(argv[3]) : 0;
  Mesh mesh;
  if(vertices < 4 || !CGAL::IO::read_polygon_mesh(argv[1], mesh) || !CGAL::is_triangle_mesh(mesh)) {
    std::cerr << "usage: garland_heckbert INPUT OUTPUT N, INPUT being a triangle mesh\n";
    return EXIT_FAILURE;
  }
  const SMS::GarlandHeckbert_plane_policies<Mesh, Kernel> policies(mesh);
  SMS::edge_collapse(
      mesh, SMS::Vertex_count_stop_predicate<Mesh>(std::size_t(vertices), mesh),
      CGAL::parameters::get_cost(policies.get_cost()).get_placement(policies.get_placement()));
  mesh.collect_garbage();
  return CGAL::IO::write_polygon_mesh(argv[2], mesh, CGAL::parameters::stream_precision(17))
             ? EXIT_SUCCESS
             : EXIT_FAILURE;
}
