// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// edge_collapse_spectral_functions INPUT OUTPUT N
//
// Simplifies with one call, says how well the spectrum was kept, and carries a function to the
// coarse mesh and back.

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace SG = CGAL::Spectral_geometry;
namespace SMS = CGAL::Surface_mesh_simplification;

int main(int argc, char* argv[])
try {
  Mesh fine;
  if(argc != 4 || !CGAL::IO::read_polygon_mesh(argv[1], fine)) {
    std::cerr
        << "usage: edge_collapse_spectral_functions INPUT OUTPUT N, INPUT being a triangle mesh\n";
    return EXIT_FAILURE;
  }
  Mesh mesh = fine;
  const std::size_t N = std::strtoul(argv[3], nullptr, 10);

  //! [one_call]
  SMS::Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 50;
  const SMS::Spectral_edge_collapse_result result = SMS::spectral_edge_collapse(mesh, N, options);
  std::cout << result.output_vertices << " vertices, " << result.stop_reason_name() << '\n';
  //! [one_call]

  //! [evaluate]
  const Eigen::Index K = 50;
  const SG::Laplace_operator fine_operator = SG::cotangent_laplacian(fine, options.mass);
  const SG::Laplace_operator coarse_operator = SG::cotangent_laplacian(mesh, options.mass);
  const SG::Eigenpairs fine_pairs = SG::eigenpairs(fine_operator, K);
  const SG::Eigenpairs coarse_pairs = SG::eigenpairs(coarse_operator, K + K / 10);
  const SG::Spectral_evaluation evaluation = SG::evaluate_spectrum(
      fine_operator, fine_pairs, coarse_operator, coarse_pairs, result.restriction, K);
  std::cout << "|C|_L " << evaluation.norm_L << ", |C|_D " << evaluation.norm_D
            << ", eigenvalues off by " << 100 * evaluation.errors.mean << " % in the mean\n";
  //! [evaluate]

  //! [transfer]
  const SG::Mesh_matrices fine_matrices = SG::mesh_matrices(fine),
                          coarse_matrices = SG::mesh_matrices(mesh);
  const Eigen::VectorXd height = fine_matrices.V.col(2); // a function on the fine mesh
  const Eigen::VectorXd coarse_height = result.restriction * height;
  const Eigen::SparseMatrix<double> Q =
      SG::closest_point_prolongation(fine_matrices, coarse_matrices, result.restriction);
  const Eigen::VectorXd height_again = Q * coarse_height;
  //! [transfer]
  const Eigen::ArrayXd difference = (height_again - height).array();
  const double error = std::sqrt((fine_operator.mass.array() * difference.square()).sum() /
                                 (fine_operator.mass.array() * height.array().square()).sum());
  std::cout << "the height, carried to the coarse mesh and back, is off by " << 100 * error
            << " %\n";
  return CGAL::IO::write_polygon_mesh(argv[2], mesh, CGAL::parameters::stream_precision(17))
             ? EXIT_SUCCESS
             : EXIT_FAILURE;
} catch(const std::exception& error) {
  std::cerr << error.what() << '\n';
  return EXIT_FAILURE;
}
