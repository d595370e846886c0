// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_COMPARE_MODE_ALIGNMENT_H
#define SPECTRAL_EXAMPLES_COMPARE_MODE_ALIGNMENT_H

#include <CGAL/Spectral_toolbox/functional_map_estimation.h>
#include <CGAL/number_type_config.h>

#include <Eigen/Core>

#include <algorithm>
#include <utility>
#include <vector>

// Coarse modes are compared with fine ones only after what is arbitrary in them, signs and the
// bases of eigenspaces, agrees.

// Ranges [first, last) of eigenvalues closer to their neighbour than a tenth of the mean spacing 4
// pi (unit area): within one the eigenvectors are determined up to a rotation only.
inline std::vector<std::pair<Eigen::Index, Eigen::Index>>
eigenvalue_clusters(const Eigen::VectorXd& values, Eigen::Index K)
{
  std::vector<std::pair<Eigen::Index, Eigen::Index>> clusters;
  for(Eigen::Index k = 0; k < K; ++k)
    if(k > 0 && values(k) - values(k - 1) < 0.1 * 4 * CGAL_PI)
      clusters.back().second = k + 1;
    else
      clusters.emplace_back(k, k + 1);
  return clusters;
}

// The rotation R, orthogonal and block diagonal, for which the coarse modes R' = Phi~ R are closest
// to the restricted fine ones, block by block. C becomes R^T C.
inline Eigen::MatrixXd aligning_rotation(const Eigen::MatrixXd& C,
                                         const Eigen::VectorXd& fine_values)
{
  Eigen::MatrixXd R = Eigen::MatrixXd::Identity(C.rows(), C.rows());
  for(const auto& [first, last] :
      eigenvalue_clusters(fine_values, (std::min)(C.rows(), C.cols()))) {
    const Eigen::Index n = last - first;
    R.block(first, first, n, n) =
        CGAL::Spectral_geometry::nearest_orthogonal_map(C.block(first, first, n, n));
  }
  return R;
}

#endif // SPECTRAL_EXAMPLES_COMPARE_MODE_ALIGNMENT_H
