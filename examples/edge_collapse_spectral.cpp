// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// edge_collapse_spectral INPUT OUTPUT N

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <cstdlib>
#include <exception>
#include <iostream>

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace SMS = CGAL::Surface_mesh_simplification;

int main(int argc, char* argv[])
try {
  Mesh mesh;
  if(argc != 4 || !CGAL::IO::read_polygon_mesh(argv[1], mesh)) {
    std::cerr << "usage: edge_collapse_spectral INPUT OUTPUT N, INPUT being a triangle mesh\n";
    return EXIT_FAILURE;
  }
  const std::size_t N = std::strtoul(argv[3], nullptr, 10);
  //! [policies]
  SMS::Spectral_policies spectral(mesh);
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate(N, mesh),
                     CGAL::parameters::get_cost(spectral.get_cost())
                         .get_placement(spectral.get_placement())
                         .visitor(spectral.visitor()));
  const auto P = spectral.restriction();
  //! [policies]
  std::cout << "P, which takes functions to the coarse mesh, is " << P.rows() << " x " << P.cols()
            << '\n';
  return CGAL::IO::write_polygon_mesh(argv[2], mesh, CGAL::parameters::stream_precision(17))
             ? EXIT_SUCCESS
             : EXIT_FAILURE;
} catch(const std::exception& error) {
  std::cerr << error.what() << '\n';
  return EXIT_FAILURE;
}
