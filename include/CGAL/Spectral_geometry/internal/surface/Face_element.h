// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_FACE_ELEMENT_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_FACE_ELEMENT_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>

namespace CGAL::Spectral_geometry::internal {

/// The cotangents and the area of a triangle whose edges were divided by 2 to the `exponent`.
inline Triangle_cotangents cotangents_of(const Triangle_element& t, const int exponent)
{
  if(t.is_degenerate())
    return {Eigen::Vector3d::Zero(), 0.};
  return {Eigen::Vector3d(t.dot) / t.twice_area, std::scalbn(0.5 * t.twice_area, 2 * exponent)};
}

/// What a face adds: cotangents, area, and the lumped mass of its corners.
struct Face_element
{
  Triangle_cotangents t;
  Eigen::RowVector3d corner_masses;
};

inline Face_element lumped_element(const Triangle_cotangents& t, const bool voronoi)
{
  Face_element result{t, Eigen::RowVector3d::Constant(t.area / 3.)};
  for(int k = 0; k < 3 && voronoi; ++k)
    result.corner_masses(k) = t.area * lumped_share(voronoi, t.cot, k);
  return result;
}

/// Sums up L and B. `element(f)` is the `Face_element` of face f.
template <class Element>
Laplace_operator assemble(const Eigen::MatrixXi& T, const Eigen::Index n, const double theta,
                          const Element& element)
{
  // Upper triangles only, mirrored afterwards: both matrices are symmetric to the last bit.
  using Triplet = Eigen::Triplet<double>;
  const Eigen::Index m = T.rows();
  std::vector<Triplet> stiffness, consistent;
  stiffness.reserve(3 * m + n);
  consistent.reserve(theta > 0. ? 3 * m + n : n);

  Laplace_operator result;
  result.theta = theta;
  result.mass = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd mass_diagonal = Eigen::VectorXd::Zero(n);
  for(Eigen::Index f = 0; f < m; ++f) {
    const auto [t, corner_masses] = element(f);
    for(int k = 0; k < 3; ++k) {
      const int c = T(f, k);
      const int i = (std::min)(T(f, (k + 1) % 3), T(f, (k + 2) % 3));
      const int j = (std::max)(T(f, (k + 1) % 3), T(f, (k + 2) % 3));
      stiffness.emplace_back(i, j, -0.5 * t.cot(k));
      if(theta > 0.)
        consistent.emplace_back(i, j, theta * t.area / 12.);
      const double lumped = (1. - theta) * corner_masses(k);
      mass_diagonal(c) += lumped + theta * t.area / 6.;
      result.mass(c) += lumped + theta * t.area / 3.;
    }
  }
  check_mass(result.mass, T);

  const auto mirrored = [n](const std::vector<Triplet>& entries) -> Eigen::SparseMatrix<double> {
    Eigen::SparseMatrix<double> upper(n, n);
    upper.setFromTriplets(entries.begin(), entries.end());
    return upper.selfadjointView<Eigen::Upper>();
  };
  for(int i = 0; i < int(n); ++i) {
    stiffness.emplace_back(i, i, 0.);
    consistent.emplace_back(i, i, mass_diagonal(i));
  }
  result.L = mirrored(stiffness);
  const Eigen::VectorXd sums = result.L * Eigen::VectorXd::Ones(n);
  result.L.diagonal() -= sums; // so that rows sum to 0
  result.B = mirrored(consistent);
  return result;
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_FACE_ELEMENT_H
