// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_PRODUCT_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_PRODUCT_H

#include <CGAL/Spectral_geometry/internal/numerics/for_each_task.h>

namespace CGAL::Spectral_geometry::internal {

/// Returns A B. Threads share ranges of rows where A is dense, columns where it is sparse. They are
/// the first to touch the memory of the result.
inline Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                               const int threads)
{
  Eigen::MatrixXd result(A.rows(), B.cols());
  for_each_range(A.rows(), 1024, threads, [&](const Eigen::Index first, const Eigen::Index end) {
    result.middleRows(first, end - first).noalias() = A.middleRows(first, end - first) * B;
  });
  return result;
}

inline Eigen::MatrixXd product(const Eigen::SparseMatrix<double>& A, const Eigen::MatrixXd& B,
                               const int threads)
{
  Eigen::MatrixXd result(A.rows(), B.cols());
  for_each_task(B.cols(), threads,
                [&](const Eigen::Index k) { result.col(k).noalias() = A * B.col(k); });
  return result;
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_PRODUCT_H
