// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_FIELDS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_FIELDS_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_lanes.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_rings.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_rows.h>

#include <Eigen/Core>

#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/*!
 * The current mesh and what lives on it, in slots: for each slot w the rows f_w, z_w and
 * R_w = (B Z)_w - (L F)_w, the mass M_w and E_w = |R_w|^2 / M_w (Eq. 2, decomposed by vertex).
 * Areas and masses are those of the input scaled to unit area.
 */
struct Spectral_fields
{
  Spectral_rows F;      ///< n x padded K
  Spectral_rows Z;      ///< the same, or empty where Z = F Lambda
  Spectral_rows lambda; ///< 1 x padded K, read where Z is empty
  Spectral_rows R;      ///< n x padded K
  Eigen::VectorXd mass; ///< lumped barycentric M_w
  Eigen::VectorXd E;    ///< E_w
  std::vector<Eigen::Vector3d> points;
  Spectral_rings rings;
  double theta = 0;      ///< B = (1 - theta) M_lumped + theta M_consistent
  double area_scale = 1; ///< 1 / area of the input
  /// The largest degree of a vertex whose ring keeps its inner products, which are quadratic in it. An edge that has a
  /// larger one at an end or in its link is costed by whole rows (`Spectral_change`): on fans of 200 to 500 faces both ways
  /// take the same time.
  std::size_t largest_degree_with_products = 256;

  std::size_t largest_degree = 0; ///< no ring is larger

  bool has_products(const Spectral_slot s) const { return rings[s].size() <= largest_degree_with_products; }

  // Shares of a triangle's area: row sums of B stay A / 3 per corner.
  double diagonal_share() const { return (1 - theta) / 3 + theta / 6; }
  double off_diagonal_share() const { return theta / 12; }

  bool has_z_rows() const { return !Z.empty(); }
  const double* f_row(const Spectral_slot s) const { return F[s]; }
  const double* z_row(const Spectral_slot s) const { return Z[s]; }
  /// The same where Z = F Lambda: then it is put into `result`, with room for a row.
  CGAL_SPECTRAL_INLINE const double* z_row(const Spectral_slot s, double* result) const
  {
    if(has_z_rows())
      return z_row(s);
    spectral_multiply_rows(lambda.data(), f_row(s), std::size_t(F.cols()), result);
    return result;
  }
  const double* r_row(const Spectral_slot s) const { return R[s]; }
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_FIELDS_H
