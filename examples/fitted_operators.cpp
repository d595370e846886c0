// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// fitted_operators INPUT OUTPUT N
//
// Simplifies with one call, and fits a Laplacian and a mass matrix of the coarse mesh to the
// spectrum of the input.

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_toolbox/fit_operators_of_run.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <cstdlib>
#include <exception>
#include <iostream>

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace SG = CGAL::Spectral_geometry;
namespace SMS = CGAL::Surface_mesh_simplification;

int main(int argc, char* argv[])
try {
  Mesh mesh;
  if(argc != 4 || !CGAL::IO::read_polygon_mesh(argv[1], mesh)) {
    std::cerr << "usage: fitted_operators INPUT OUTPUT N, INPUT being a triangle mesh\n";
    return EXIT_FAILURE;
  }
  const SG::Mesh_matrices input = SG::mesh_matrices(mesh);
  const Eigen::Index K = 50;
  SMS::Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = K;
  const SMS::Spectral_edge_collapse_result result =
      SMS::spectral_edge_collapse(mesh, std::strtoul(argv[3], nullptr, 10), options);

  //! [fit]
  const SG::Mesh_matrices output = SG::mesh_matrices(mesh);
  const SG::Operator_fit_result fit = SMS::fit_operators_of_run(input, output, options, result);
  const SG::Eigenpairs fitted_pairs = SG::eigenpairs(fit.op, K);
  //! [fit]
  const SG::Laplace_operator fine = SG::laplace_operator(input.V, input.T, options.mass),
                             own = SG::laplace_operator(output.V, output.T, options.mass);
  const SG::Eigenpairs fine_pairs = SG::eigenpairs(fine, K);
  const auto norm = [&](const SG::Laplace_operator& op, const SG::Eigenpairs& pairs) {
    return SG::evaluate_spectrum(fine, fine_pairs, op, pairs, result.restriction, K).norm_L;
  };
  std::cout << "|C|_L is " << norm(own, SG::eigenpairs(own, K))
            << " with the mesh's own operators, " << norm(fit.op, fitted_pairs)
            << " with the fitted ones\n";
  return CGAL::IO::write_polygon_mesh(argv[2], mesh, CGAL::parameters::stream_precision(17))
             ? EXIT_SUCCESS
             : EXIT_FAILURE;
} catch(const std::exception& error) {
  std::cerr << error.what() << '\n';
  return EXIT_FAILURE;
}
