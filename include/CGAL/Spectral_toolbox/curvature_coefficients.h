// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_CURVATURE_COEFFICIENTS_H
#define CGAL_SPECTRAL_TOOLBOX_CURVATURE_COEFFICIENTS_H

#include <CGAL/Spectral_geometry/Run_control.h>
#include <CGAL/Spectral_toolbox/internal/separate_compilation.h>
#include <CGAL/Spectral_geometry/local_operator.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/*!
\brief returns coefficients by which functions vary more easily along than across the bends of a
surface: the anisotropic Laplacian of Andreux et al., *Anisotropic Laplace-Beltrami Operators for
Shape Analysis*, 2014,
\f[ D = \psi(\kappa_1) d_1 d_1^\top + \psi(\kappa_2) d_2 d_2^\top + \sqrt{\psi(\kappa_1)
\psi(\kappa_2)} \, n n^\top, \qquad \psi(\kappa) = \frac{1}{1 + \alpha \, r \, |\kappa|} , \qquad
\rho = 1, \f]
with the principal curvatures and directions of a jet of degree two, fitted to the first rings that
hold at least 16 vertices, with at most 64 neighbours of a hub (F. Cazals and M. Pouget,
`CGAL::Monge_via_jet_fitting`), and \f$r = \sqrt{A / 4 \pi}\f$, the radius of the sphere of the same
area: D does not change with the scale. Where too few vertices can be fitted to, D is the identity.

\param V, T   n x 3 positions and m x 3 vertex indices
\param alpha  how much the curvature counts, from 0 (the identity) to 1e6; without unit
\param progress  is called with the fraction done; returns false to cancel

\throws std::invalid_argument if alpha is out of range, or as `barycentric_corner_masses()` does;
Cancelled when the progress callback returned false
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Operator_coefficients
curvature_coefficients(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const double alpha,
                       const Progress_callback& progress = {});

/// @}

} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_TOOLBOX_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_TOOLBOX)

#include <CGAL/Cartesian.h>
#include <CGAL/Eigen_svd.h>
#include <CGAL/Monge_via_jet_fitting.h>

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Spectral_geometry/operator_coefficients.h>

namespace CGAL::Spectral_geometry {

Operator_coefficients curvature_coefficients(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                                             const double alpha, const Progress_callback& progress)
{
  using Kernel = CGAL::Cartesian<double>;
  using Point = Kernel::Point_3;
  using Fitting = CGAL::Monge_via_jet_fitting<Kernel, Kernel, CGAL::Eigen_svd>;
  constexpr std::size_t wanted = 16, needed = 6;
  internal::require(alpha >= 0 && alpha <= 1e6, "Local operator: the anisotropy is ", alpha,
                    "; use a number from 0 to 1e6.");
  const double area = 3 * barycentric_corner_masses(V, T).sum();
  const double radius = std::sqrt(area / (4 * std::acos(-1.)));
  const auto rings = internal::Vertex_rings::of_vertices(T, V.rows());
  std::vector<char> seen(std::size_t(V.rows()), 0);
  std::vector<Point> points;
  const auto vector = [](const auto& v) { return Eigen::Vector3d(v.x(), v.y(), v.z()); };
  const auto psi = [&](const double kappa) { return 1 / (1 + alpha * std::abs(kappa)); };
  // The identity at each vertex.
  Eigen::MatrixXd D = weighted_coefficients({}, Eigen::VectorXd::Ones(V.rows())).rightCols<6>();
  for(Eigen::Index v = 0; v < V.rows() && alpha > 0; ++v) {
    if(v % 1024 == 0)
      internal::report_to({1, progress}, {Phase::curvature, double(v) / double(V.rows())});
    points.clear();
    for(const int w : rings.around(int(v), wanted, seen)) {
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

#endif // definitions

#endif // CGAL_SPECTRAL_TOOLBOX_CURVATURE_COEFFICIENTS_H
