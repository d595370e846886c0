// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_IMPL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_IMPL_H

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/Block_lanczos.h>
#include <CGAL/Spectral_geometry/internal/Eigen_problem.h>
#include <CGAL/Spectral_geometry/internal/Lanczos_eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/dense_eigenpairs.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace CGAL {
namespace Spectral_geometry {

CGAL_SPECTRAL_GEOMETRY_INLINE Eigenpairs eigenpairs(const Laplace_operator& op, Eigen::Index K,
                                                    const Eigenpairs_options& options)
{
  using Method = Eigenpairs_method;
  const internal::Eigen_problem problem(op.L, op.B, op.mass, options.progress);
  problem.check(K);
  internal::check_eigenpairs_options(options, K);

  internal::Ritz_pairs pairs;
  Eigenpairs result;
  problem.report(0.);
  if(internal::is_dense(problem.size(), K, options.method)) {
    pairs = internal::dense_eigenpairs(problem, K);
    result.solver = "dense";
    result.complete = true;
  } else if(options.method == Method::spectra) {
    internal::Lanczos_eigenpairs lanczos(problem, options.tolerance, options.maximum_iterations);
    pairs = lanczos.compute(K);
    result.complete = options.verify && lanczos.complete(pairs);
    result.solver = "spectra+" + internal::Cholesky::name();
  } else {
    internal::Block_lanczos lanczos(problem, options.tolerance, options.maximum_iterations,
                                    options.maximum_vectors, options.threads);
    pairs = lanczos.compute(K, options.verify, result.complete);
    result.solver = "block+" + internal::Cholesky::name();
  }
  internal::fix_signs(pairs.vectors);
  result.zeros = number_of_zero_eigenvalues(op);
  result.residuals = problem.residuals(pairs);
  result.values = std::move(pairs.values);
  result.vectors = std::move(pairs.vectors);
  problem.report(1.);
  return result;
}

} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_EIGENPAIRS_IMPL_H
