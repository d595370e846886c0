// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "simplify.h"

#include <CGAL/Spectral_toolbox/mesh_diagnosis.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>
#include <CGAL/boost/graph/generators.h>
#include <CGAL/subdivision_method_3.h>

#include <cmath>
#include <iostream>
#include <string>

// An ellipsoid of 642 vertices.
Mesh ellipsoid()
{
  Mesh mesh;
  CGAL::make_icosahedron(mesh, Kernel::Point_3(0, 0, 0), 1.);
  CGAL::Subdivision_method_3::Loop_subdivision(mesh, CGAL::parameters::number_of_iterations(3));
  for(const auto v : vertices(mesh)) {
    const auto& p = mesh.point(v);
    const double r = std::sqrt(p.x() * p.x() + p.y() * p.y() + p.z() * p.z());
    mesh.point(v) = Kernel::Point_3(p.x() / r, 0.8 * p.y() / r, 0.6 * p.z() / r);
  }
  return mesh;
}

int main()
{
  Mesh mesh = ellipsoid();
  const auto fine = static_cast<Eigen::Index>(num_vertices(mesh));
  std::string solver;
  const Eigen::SparseMatrix<double> P = simplify(mesh, 100, solver);
  mesh.collect_garbage();
  const bool good = CGAL::Spectral_geometry::diagnose_mesh(mesh).usable() && solver == "block" &&
                    num_vertices(mesh) == 100 && P.rows() == 100 && P.cols() == fine &&
                    (P * Eigen::VectorXd::Ones(fine) - Eigen::VectorXd::Ones(100)).norm() < 1e-10;
  std::cout << fine << " -> " << num_vertices(mesh) << " vertices, restriction " << P.rows()
            << " x " << P.cols() << ", " << P.nonZeros() << " entries; eigenpairs by " << solver
            << '\n';
  return good ? 0 : 1;
}
