// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// edge_collapse_spectral_constrained INPUT OUTPUT N
//
// The spectral metric with two things that CGAL ships: edges sharper than 60 degrees and border
// edges stay as they are, and no collapse turns a face over. The program says what could not be
// done for their sake.

#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <algorithm>
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
    std::cerr << "usage: edge_collapse_spectral_constrained INPUT OUTPUT N, INPUT being a triangle "
                 "mesh\n";
    return EXIT_FAILURE;
  }
  auto is_constrained =
      mesh.add_property_map<Mesh::Edge_index, bool>("e:is_constrained", false).first;
  CGAL::Polygon_mesh_processing::detect_sharp_edges(mesh, 60, is_constrained);
  const auto count = [&] {
    const auto range = edges(mesh);
    return std::count_if(range.begin(), range.end(),
                         [&](Mesh::Edge_index e) { return is_constrained[e]; });
  };
  std::cout << count() << " edges are constrained\n";

  //! [constrained]
  const SMS::Spectral_edge_collapse_result result = SMS::spectral_edge_collapse(
      mesh, std::strtoul(argv[3], nullptr, 10), SMS::Spectral_edge_collapse_options(),
      CGAL::parameters::edge_is_constrained_map(is_constrained)
          .filter(SMS::Bounded_normal_change_filter<>()));
  //! [constrained]

  std::cout << result.input_vertices << " -> " << result.output_vertices << " vertices, "
            << result.stop_reason_name() << "; " << result.refusals.filter
            << " collapses were refused by the filter; " << count()
            << " constrained edges are left\n";
  if(!result.explanation.empty())
    std::cout << result.explanation << '\n';
  return CGAL::IO::write_polygon_mesh(argv[2], mesh, CGAL::parameters::stream_precision(17))
             ? EXIT_SUCCESS
             : EXIT_FAILURE;
} catch(const std::exception& error) {
  std::cerr << error.what() << '\n';
  return EXIT_FAILURE;
}
