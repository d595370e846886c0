// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_COMPLETENESS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_COMPLETENESS_H

#include <CGAL/Spectral_geometry/internal/eigenpairs/Eigen_problem.h>
#include <CGAL/Spectral_geometry/internal/linear_algebra/Supernodal_factor.h>

#include <Eigen/Core>

#include <algorithm>

namespace CGAL::Spectral_geometry::internal {

// The number of eigenvalues below a gap minus the number of those found. The gap is that below the K-th value and the group that it belongs
// to: copies of values(K-1) itself need not be counted, any K of them are right. Factorisations without pivoting can be wrong next to an
// eigenvalue of a leading block, which a shift elsewhere in the gap avoids.
inline bool count_missing(const Eigen_problem& problem, const Eigen::VectorXd& values, int threads,
                          Eigen::Index& missing)
{
  const double s = problem.shift();
  Eigen::Index k = values.size() - 1; // values below the gap
  while(k > 0 && !(values(k) - values(k - 1) > 1e-5 * (values(k) + s)))
    --k;
  const double lower = k > 0 ? values(k - 1) : -s;
  for(const double t : {0.5, 0.375, 0.59375}) {
    const double mu = lower + t * (values(k) - lower);
    missing = 0;
    if(mu < 0.)
      return true; // L is positive semidefinite
    missing = number_of_negative_eigenvalues(problem.shifted(mu), threads) - k;
    if(missing >= 0)
      return true;
  }
  return false;
}

// Whether a group of equal values is so large that a block of eight start vectors may have missed copies. Fewer copies than
// start vectors are found with probability one; half of that leaves a margin for those that converge late. Values within the
// tolerance of each other are equal to the iteration: a mixture of their vectors passes as converged.
inline bool may_be_incomplete(const Eigen_problem& problem, const Eigen::VectorXd& values, double tolerance)
{
  const double width = (std::max)(1e-5, 10. * tolerance);
  Eigen::Index group = 1;
  for(Eigen::Index k = 1; k < values.size(); ++k) {
    group = values(k) - values(k - 1) < width * (values(k) + problem.shift()) ? group + 1 : 1;
    if(group > 4)
      return true;
  }
  return false;
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_COMPLETENESS_H
