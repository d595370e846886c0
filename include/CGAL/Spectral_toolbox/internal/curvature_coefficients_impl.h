// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_INTERNAL_CURVATURE_COEFFICIENTS_IMPL_H
#define CGAL_SPECTRAL_TOOLBOX_INTERNAL_CURVATURE_COEFFICIENTS_IMPL_H

#include <CGAL/Cartesian.h>
#include <CGAL/Eigen_svd.h>
#include <CGAL/Monge_via_jet_fitting.h>

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_toolbox/curvature_coefficients.h>
#include <CGAL/Spectral_toolbox/internal/vertex_rings.h>
#include <CGAL/Spectral_geometry/Cancelled.h>
#include <CGAL/Spectral_geometry/internal/require.h>
#include <CGAL/Spectral_geometry/operator_coefficients.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace CGAL::Spectral_geometry {

CGAL_SPECTRAL_TOOLBOX_INLINE Operator_coefficients
curvature_coefficients(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const double alpha,
                       const std::function<bool(double)>& progress)
{
  using Kernel = CGAL::Cartesian<double>;
  using Point = Kernel::Point_3;
  using Fitting = CGAL::Monge_via_jet_fitting<Kernel, Kernel, CGAL::Eigen_svd>;
  constexpr std::size_t wanted = 16, needed = 6;
  internal::require(alpha >= 0 && alpha <= 1e6, "Local operator: the anisotropy is ", alpha,
                    "; use a number from 0 to 1e6.");
  const double area = 3 * barycentric_corner_masses(V, T).col(0).sum();
  const double radius = std::sqrt(area / (4 * std::acos(-1.)));
  const std::vector<std::vector<int>> neighbors = internal::vertex_neighbors(T, V.rows());
  std::vector<char> seen(std::size_t(V.rows()), 0);
  std::vector<Point> points;
  const auto vector = [](const auto& v) { return Eigen::Vector3d(v.x(), v.y(), v.z()); };
  const auto psi = [&](const double kappa) { return 1 / (1 + alpha * std::abs(kappa)); };
  Eigen::MatrixXd D =
      weighted_coefficients({}, Eigen::VectorXd::Ones(V.rows())).rightCols<6>(); // the identity
  for(Eigen::Index v = 0; v < V.rows() && alpha > 0; ++v) {
    if(progress && v % 1024 == 0 && !progress(double(v) / double(V.rows())))
      throw Cancelled();
    points.clear();
    for(const int w : internal::rings_of(neighbors, int(v), wanted, seen)) {
      const Eigen::Vector3d x = (V.row(w) - V.row(v)) / radius;
      points.emplace_back(x(0), x(1), x(2));
    }
    if(points.size() < needed)
      continue;
    Fitting fitting;
    const auto form = fitting(points.begin(), points.end(), 2, 2);
    const Eigen::Vector3d d1 = vector(form.maximal_principal_direction()),
                          d2 = vector(form.minimal_principal_direction()), n = d1.cross(d2);
    const double p1 = psi(form.principal_curvatures(0)), p2 = psi(form.principal_curvatures(1));
    const Eigen::Matrix3d d = p1 * d1 * d1.transpose() + p2 * d2 * d2.transpose() +
                              std::sqrt(p1 * p2) * n * n.transpose();
    if(d.allFinite() && std::abs(n.norm() - 1) < 1e-6 && p1 > 0 && p2 > 0)
      D.row(v) << d(0, 0), d(0, 1), d(0, 2), d(1, 1), d(1, 2), d(2, 2);
  }
  return anisotropic_coefficients(D);
}

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_TOOLBOX_INTERNAL_CURVATURE_COEFFICIENTS_IMPL_H
