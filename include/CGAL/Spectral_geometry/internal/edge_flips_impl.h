// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_EDGE_FLIPS_IMPL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_EDGE_FLIPS_IMPL_H

#include <CGAL/Spectral_geometry/edge_flips.h>
#include <CGAL/Spectral_geometry/internal/Edge_flipper.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

inline void check_edge_flips(const Edge_flip_options& o, const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                             const Eigen::SparseMatrix<double>& P, const Eigen::MatrixXd& F,
                             const Eigen::MatrixXd& Z, const Local_operator& op)
{
  const auto require = [](const bool fine_so_far, const std::string& sentence) {
    if(!fine_so_far)
      throw std::invalid_argument("edge flips: " + sentence);
  };
  const auto size = [](const Eigen::Index rows, const Eigen::Index columns) {
    return std::to_string(rows) + " x " + std::to_string(columns);
  };
  check_positions(V);
  check_triangles(T, V.rows());
  require(P.rows() == V.rows(), "P is " + size(P.rows(), P.cols()) + " and the mesh has " +
                                    std::to_string(V.rows()) + " vertices; pass a P of coarse x fine.");
  require(F.rows() == P.cols() && Z.rows() == F.rows() && Z.cols() == F.cols() && F.cols() > 0,
          "F is " + size(F.rows(), F.cols()) + " and Z " + size(Z.rows(), Z.cols()) +
              "; pass two matrices with one row for each of the " + std::to_string(P.cols()) +
              " fine vertices and one column for each signal.");
  check_local_operator(op, V.rows());
  check_edge_flip_options(o);
}

} // namespace internal

CGAL_SPECTRAL_GEOMETRY_INLINE Edge_flip_result flip_edges(const Eigen::MatrixXd& V, Eigen::MatrixXi& T,
                                                          const Eigen::SparseMatrix<double>& P,
                                                          const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z,
                                                          const Local_operator& op,
                                                          const std::vector<std::pair<int, int>>& constrained,
                                                          const Edge_flip_options& options)
{
  internal::check_edge_flips(options, V, T, P, F, Z, op);
  Edge_flip_result result;
  internal::Edge_flipper flipper(V, T, P * F, P * Z, op, constrained, options);
  if(options.criterion != Edge_flips::none)
    T = flipper.run(result);
  return result;
}

} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_EDGE_FLIPS_IMPL_H
