// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_RELOCATION_HELPERS_H
#define SPECTRAL_TEST_RELOCATION_HELPERS_H

#include "collapse_helpers.h"

#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include <cstddef>
#include <memory>

namespace spectral_test {

// A coarse mesh that a run made, with all that relocation asks for.
struct Simplified_mesh
{
  shapes::Matrices fine, coarse;
  Eigen::SparseMatrix<double> P;
  SG::Laplace_operator op;
  SG::Eigenpairs pairs; // half as many again as the run used

  Eigen::MatrixXd F() const { return pairs.vectors.leftCols(K); }
  Eigen::MatrixXd Z() const { return F() * pairs.values.head(K).asDiagonal(); }
  static constexpr Eigen::Index K = 20;
};

inline Simplified_mesh simplified(const shapes::Matrices& fine, const std::size_t N)
{
  Simplified_mesh s;
  s.fine = fine;
  s.op = SG::laplace_operator(fine.V, fine.T, 0.5);
  s.pairs = SG::eigenpairs(s.op, 3 * Simplified_mesh::K / 2);
  auto basis = std::make_shared<SG::Eigenpairs>();
  basis->values = s.pairs.values.head(Simplified_mesh::K);
  basis->vectors = s.pairs.vectors.leftCols(Simplified_mesh::K);
  SMS::Spectral_edge_collapse_options options = SMS::Spectral_edge_collapse_options::paper();
  options.mass = SG::Mass::averaged;
  options.eigenpairs = basis;
  Mesh mesh = make_mesh(fine);
  s.P = SMS::spectral_edge_collapse(mesh, N, options).restriction;
  s.coarse = SG::mesh_matrices(mesh);
  return s;
}

inline const Simplified_mesh& closed_example()
{
  static const Simplified_mesh s = simplified(shapes::bumpy_icosphere_matrices(4), 160);
  return s;
}

inline const Simplified_mesh& open_example()
{
  static const Simplified_mesh s = simplified(wavy_grid_matrices(36, 30), 150);
  return s;
}

inline Eigen::Vector3d normal(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                              const Eigen::Index f)
{
  const Eigen::Vector3d a = V.row(T(f, 1)) - V.row(T(f, 0)), b = V.row(T(f, 2)) - V.row(T(f, 0));
  return a.cross(b).normalized();
}

} // namespace spectral_test

#endif // SPECTRAL_TEST_RELOCATION_HELPERS_H
