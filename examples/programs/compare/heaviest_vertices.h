// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_COMPARE_HEAVIEST_VERTICES_H
#define SPECTRAL_EXAMPLES_COMPARE_HEAVIEST_VERTICES_H

#include <Eigen/SparseCore>

#include <cstddef>
#include <vector>

// For each coarse vertex the fine one of largest weight in a restriction (coarse x fine): where
// functions that are not linear in the eigenvectors, such as signatures, are read.
inline std::vector<Eigen::Index> heaviest_vertices(const Eigen::SparseMatrix<double>& P)
{
  std::vector<Eigen::Index> result(static_cast<std::size_t>(P.rows()), 0);
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(P.rows());
  for(Eigen::Index j = 0; j < P.cols(); ++j)
    for(Eigen::SparseMatrix<double>::InnerIterator it(P, j); it; ++it)
      if(it.value() > largest(it.row())) {
        largest(it.row()) = it.value();
        result[static_cast<std::size_t>(it.row())] = j;
      }
  return result;
}

#endif // SPECTRAL_EXAMPLES_COMPARE_HEAVIEST_VERTICES_H
