// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_SPECTRAL_TEST_HELPERS_H
#define SPECTRAL_TEST_SPECTRAL_TEST_HELPERS_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_fields.h>

#include "shapes.h"

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

// The slow way: everything from whole matrices, nothing from the package's local kernel.
namespace spectral_test {

namespace SG = CGAL::Spectral_geometry;

// F and Z of the input scaled to unit area.
struct Basis
{
  Eigen::MatrixXd F, Z;
  Eigen::VectorXd lambda;   // empty for signals
  SG::Local_operator local; // for the vertices of the input
  double area = 1;          // weighted by the density
};

// f_w of the signals that a state has: each column of F, or mixtures of them.
inline Eigen::RowVectorXd
tracked_signals(const CGAL::Surface_mesh_simplification::internal::Spectral_fields& fields,
                const Eigen::Index slot)
{
  constexpr Eigen::Index width = CGAL::Surface_mesh_simplification::internal::spectral_width;
  Eigen::RowVectorXd result(fields.signals.size());
  for(Eigen::Index k = 0; k < result.size(); ++k)
    result[k] = fields.signals[std::size_t(slot)][k / width].f[k % width];
  return result;
}

inline Basis basis_of_pairs(const SG::Laplace_operator& op, const SG::Eigenpairs& pairs,
                            const SG::Local_operator& local)
{
  Basis basis;
  basis.local = local;
  basis.area = op.mass.sum();
  basis.F = std::sqrt(basis.area) * pairs.vectors;
  basis.lambda = basis.area * pairs.values;
  basis.Z = basis.F * basis.lambda.asDiagonal();
  return basis;
}

inline Basis basis_of_pairs(const SG::Laplace_operator& op, const SG::Eigenpairs& pairs)
{
  return basis_of_pairs(op, pairs, op.theta);
}

inline Basis eigenbasis(const shapes::Matrices& mesh, const SG::Local_operator& local,
                        const Eigen::Index K)
{
  const SG::Laplace_operator op = SG::laplace_operator(mesh.V, mesh.T, local);
  return basis_of_pairs(op, SG::eigenpairs(op, K), local);
}

// Z = B^-1 L F on the mesh scaled to unit area.
inline Basis signal_basis(const shapes::Matrices& mesh, const SG::Local_operator& local,
                          const Eigen::MatrixXd& signals)
{
  const SG::Laplace_operator op = SG::laplace_operator(mesh.V, mesh.T, local);
  Basis basis;
  basis.local = local;
  basis.area = op.mass.sum();
  basis.F = signals;
  basis.Z =
      basis.area * Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(op.B).solve(op.L * signals);
  return basis;
}

// K signals of every roughness: waves, and one that differs from vertex to vertex.
inline Eigen::MatrixXd rough_signals(const shapes::Matrices& mesh, const Eigen::Index K)
{
  Eigen::MatrixXd F(mesh.V.rows(), K);
  for(Eigen::Index v = 0; v < F.rows(); ++v)
    for(Eigen::Index k = 0; k < K; ++k)
      F(v, k) = k == 0 ? std::sin(12.9898 * double(v))
                       : std::sin(mesh.V.row(v).dot(Eigen::RowVector3d(
                             double(k), 1. + 0.7 * double(k % 3), 0.4 * double(k))));
  return F;
}

// E_w = || (B P Z)_w - (L P F)_w ||^2 / M_w of every vertex w of a mesh, from its assembled
// matrices (Eq. 2).
inline Eigen::VectorXd energies(const shapes::Matrices& mesh, const SG::Local_operator& local,
                                const double input_area, const Eigen::MatrixXd& PF,
                                const Eigen::MatrixXd& PZ)
{
  const SG::Laplace_operator op =
      SG::laplace_operator(mesh.V / std::sqrt(input_area), mesh.T, local);
  const Eigen::MatrixXd R = op.B * PZ - op.L * PF;
  return R.rowwise().squaredNorm().cwiseQuotient(op.mass);
}

inline double energy(const shapes::Matrices& mesh, const Basis& basis,
                     const Eigen::SparseMatrix<double>& P)
{
  return energies(mesh, basis.local.restricted(P), basis.area, P * basis.F, P * basis.Z).sum();
}

// What is wrong with a restriction and its vertex map; empty if nothing is.
inline std::string fault_of_restriction(const Eigen::SparseMatrix<double>& P,
                                        const std::vector<std::size_t>& map,
                                        const bool binary = false)
{
  const auto at = [](const Eigen::Index i) { return " " + std::to_string(i); };
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(P.rows());
  std::vector<int> nonzeros(std::size_t(P.rows()), 0), mapped(std::size_t(P.rows()), 0);
  if(Eigen::Index(map.size()) != P.cols())
    return "the map has" + at(Eigen::Index(map.size())) + " entries for columns" + at(P.cols());
  for(Eigen::Index j = 0; j < P.cols(); ++j) {
    if(Eigen::Index(map[std::size_t(j)]) >= P.rows())
      return "the map leads nowhere from vertex" + at(j);
    ++mapped[map[std::size_t(j)]];
    int in_column = 0;
    for(Eigen::SparseMatrix<double>::InnerIterator it(P, j); it; ++it) {
      if(++in_column > 1)
        return "several nonzeros in column" + at(j);
      if(!(it.value() > 0 && it.value() <= 1))
        return "a weight outside of ]0,1] in column" + at(j);
      if(it.row() != Eigen::Index(map[std::size_t(j)]))
        return "the map contradicts P in column" + at(j);
      if(binary && it.value() != 1)
        return "a weight other than 1 in column" + at(j);
      sums(it.row()) += it.value();
      ++nonzeros[std::size_t(it.row())];
    }
  }
  for(Eigen::Index i = 0; i < P.rows(); ++i) {
    if(!(std::abs(sums(i) - 1) < 1e-12))
      return "a sum other than 1 in row" + at(i);
    if(mapped[std::size_t(i)] == 0)
      return "nothing is mapped to row" + at(i);
    if(binary && nonzeros[std::size_t(i)] != 1)
      return "not exactly one 1 in row" + at(i);
  }
  return "";
}

// The largest coordinate of P V_fine - V_coarse, relative to the extent of the mesh.
inline double position_error(const Eigen::SparseMatrix<double>& P, const Eigen::MatrixXd& fine,
                             const Eigen::MatrixXd& coarse)
{
  return (P * fine - coarse).cwiseAbs().maxCoeff() / fine.cwiseAbs().maxCoeff();
}

inline double relative_difference(const double a, const double b)
{
  return std::abs(a - b) / (std::max)({std::abs(a), std::abs(b), 1e-300});
}

inline shapes::Matrices scaled(shapes::Matrices mesh, const double factor)
{
  mesh.V *= factor;
  return mesh;
}

// A grid that is neither flat nor regular, with its boundary.
inline shapes::Matrices wavy_grid_matrices(const int nx, const int ny)
{
  shapes::Matrices mesh = shapes::irregular_grid_matrices(nx, ny);
  for(Eigen::Index v = 0; v < mesh.V.rows(); ++v)
    mesh.V(v, 2) = 0.15 * std::sin(5 * mesh.V(v, 0) + 1) * std::cos(4 * mesh.V(v, 1)) +
                   0.2 * mesh.V(v, 0) * mesh.V(v, 1);
  return mesh;
}

} // namespace spectral_test

#endif // SPECTRAL_TEST_SPECTRAL_TEST_HELPERS_H
