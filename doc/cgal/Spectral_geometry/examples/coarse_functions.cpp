// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// coarse_functions [INPUT]

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>
#include <CGAL/subdivision_method_3.h>

#include <cstdlib>
#include <iostream>
#include <string>

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace SG = CGAL::Spectral_geometry;

int main(int argc, char* argv[])
{
  const std::string filename = (argc > 1) ? argv[1] : CGAL::data_file_path("meshes/elephant.off");
  Mesh coarse;
  if(!CGAL::IO::read_polygon_mesh(filename, coarse)) {
    std::cerr << "Invalid input: " << filename << '\n';
    return EXIT_FAILURE;
  }
  Mesh fine = coarse;
  CGAL::Subdivision_method_3::Loop_subdivision(fine, CGAL::parameters::number_of_iterations(1));

  // P takes functions to the coarse mesh, Q takes them back.
  const SG::Mesh_matrices coarse_matrices = SG::mesh_matrices(coarse),
                          fine_matrices = SG::mesh_matrices(fine);
  const Eigen::SparseMatrix<double> P =
      SG::closest_point_restriction(coarse_matrices, fine_matrices);
  const Eigen::SparseMatrix<double> Q =
      SG::closest_point_prolongation(fine_matrices, coarse_matrices, P);
  const Eigen::VectorXd height = fine_matrices.V.col(2), height_again = Q * (P * height);
  std::cout << "the height comes back within " << (height_again - height).lpNorm<Eigen::Infinity>()
            << '\n';

  // The functional map in the first K eigenvectors, and its norms.
  const Eigen::Index K = 50;
  const SG::Laplace_operator fine_operator = SG::cotangent_laplacian(fine, SG::Mass::averaged),
                             coarse_operator = SG::cotangent_laplacian(coarse, SG::Mass::averaged);
  const SG::Eigenpairs fine_pairs = SG::eigenpairs(fine_operator, K),
                       coarse_pairs = SG::eigenpairs(coarse_operator, K + K / 10);
  const SG::Spectral_evaluation evaluation =
      SG::evaluate_spectrum(fine_operator, fine_pairs, coarse_operator, coarse_pairs, P, K);
  std::cout << "|C|_L is " << evaluation.norm_L << ", |C|_D is " << evaluation.norm_D
            << ", eigenvalues are off by " << 100 * evaluation.errors.mean << " % in the mean\n";
  return EXIT_SUCCESS;
}
