// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_IMPL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_IMPL_H

#include <CGAL/Spectral_geometry/internal/Relocation.h>
#include <CGAL/Spectral_geometry/relocation.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <vector>

namespace CGAL {
namespace Spectral_geometry {

CGAL_SPECTRAL_GEOMETRY_INLINE Relocation_result relocate_positions(
    Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const Eigen::SparseMatrix<double>& P,
    const Mesh_matrices& fine, const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z, const Local_operator& op,
    const std::vector<bool>& fixed, const Relocation_options& options)
{
  internal::check_relocation(options, V, P, fine, F, Z, fixed);
  Relocation_result result;
  internal::Relocation relocation(V, T, P, fine, F, Z, op, fixed, options);
  V = relocation.run(result);
  result.resampled = options.signals == Relocation_options::Signals::sampled;
  result.restriction = result.resampled ? relocation.sampled_restriction(V) : P;
  return result;
}

} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_IMPL_H
