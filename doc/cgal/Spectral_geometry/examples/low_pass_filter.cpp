// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// low_pass_filter [INPUT]

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <cstdlib>
#include <iostream>
#include <string>

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace SG = CGAL::Spectral_geometry;

int main(int argc, char* argv[])
{
  const std::string filename = (argc > 1) ? argv[1] : CGAL::data_file_path("meshes/elephant.off");
  Mesh mesh;
  if(!CGAL::IO::read_polygon_mesh(filename, mesh)) {
    std::cerr << "Invalid input: " << filename << '\n';
    return EXIT_FAILURE;
  }
  const SG::Laplace_operator op = SG::cotangent_laplacian(mesh, SG::Mass::averaged);
  const SG::Eigenpairs pairs = SG::eigenpairs(op, 50);
  std::cout << "the first eigenvalues are " << pairs.values.head(5).transpose() << '\n';

  // What the eigenvectors keep of the coordinates.
  const Eigen::MatrixXd V = SG::mesh_matrices(mesh).V,
                        smooth = pairs.vectors * (pairs.vectors.transpose() * (op.B * V));
  const Eigen::VectorXd distance = (smooth - V).rowwise().norm();
  std::cout << "without higher frequencies vertices move by "
            << op.mass.dot(distance) / op.mass.sum() << " in the mean\n";
  return EXIT_SUCCESS;
}
