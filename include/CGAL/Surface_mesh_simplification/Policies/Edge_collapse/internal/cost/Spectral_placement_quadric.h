// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_PLACEMENT_QUADRIC_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_PLACEMENT_QUADRIC_H

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace CGAL::Surface_mesh_simplification::internal {

/*!
 * The quadric q(y) = c + b.y + y^T A y through ten samples of cost(e,x), x = m + sum_i y_i a_i
 * (strategy (iii), appendix A of the paper): y = 0, +-e_i and (e_i + e_j) / sqrt(2), which are ten
 * unknowns.
 *
 * m is the middle of the edge and a_0 half of it, so three of the samples are those of strategy
 * (ii). a_1 lies across the edge in the surface, and a_2 along its normal, where the cost rises
 * steeply: it is shorter.
 */
class Spectral_placement_quadric
{
public:
  static constexpr int number_of_samples = 10;
  /// The samples in the order of point(): u, m, v first, then those off the edge.
  static constexpr int number_on_edge = 3;

  /// `normal`: of the surface at the edge, of any length. False if the edge or the normal has no
  /// direction.
  bool set_frame(const Eigen::Vector3d& u, const Eigen::Vector3d& v, const Eigen::Vector3d& normal)
  {
    m_middle = (u + v) / 2;
    m_axes.col(0) = (v - u) / 2;
    const Eigen::Vector3d across = normal.cross(v - u);
    const double half_length = m_axes.col(0).norm(), across_length = across.norm();
    if(!(half_length > 0) || !(across_length > 0))
      return false;
    m_axes.col(1) = across * (half_length / across_length);
    const Eigen::Vector3d up = (v - u).cross(across).normalized();
    m_axes.col(2) = up * (half_length * normal_ratio);
    return m_axes.allFinite();
  }

  /// x of sample i.
  Eigen::Vector3d point(const int i) const { return at(coordinates(i)); }

  /// x that minimises the quadric through these ten costs in the ellipsoid of the samples, outside
  /// of which they tell nothing: four of five quadrics have no minimum elsewhere. None unless all
  /// costs are finite.
  std::optional<Eigen::Vector3d> minimiser(const double* costs) const
  {
    const double c = costs[1];
    const double plus[3] = {costs[2], costs[3], costs[5]},
                 minus[3] = {costs[0], costs[4], costs[6]};
    Eigen::Matrix3d A;
    Eigen::Vector3d b;
    for(int i = 0; i < 3; ++i) {
      b[i] = (plus[i] - minus[i]) / 2;
      A(i, i) = (plus[i] + minus[i]) / 2 - c;
    }
    int sample = 7;
    for(int i = 0; i < 3; ++i)
      for(int j = i + 1; j < 3; ++j)
        A(i, j) = A(j, i) =
            costs[sample++] - c - (b[i] + b[j]) / std::sqrt(2.) - (A(i, i) + A(j, j)) / 2;
    if(!A.allFinite() || !b.allFinite())
      return {};
    const Eigen::Vector3d y = minimiser_in_ball(A, b);
    return y.allFinite() ? std::optional<Eigen::Vector3d>(at(y)) : std::nullopt;
  }

private:
  // It is a part of half the edge. On spot, cheburashka, homer and rocker-arm 0.1 and 0.25 give
  // away half of what 0.5 gains.
  static constexpr double normal_ratio = 0.5;

  // The y of |y| <= 1 with (A + mu I) y = -b / 2, where mu >= 0 makes the matrix positive definite
  // and is 0 if |y| < 1. |y| falls as mu grows.
  static Eigen::Vector3d minimiser_in_ball(const Eigen::Matrix3d& A, const Eigen::Vector3d& b)
  {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(A);
    const Eigen::Vector3d values = solver.eigenvalues(),
                          c = solver.eigenvectors().transpose() * b / -2;
    const double scale = values.cwiseAbs().maxCoeff() + c.norm();
    const auto y = [&](const double mu) -> Eigen::Vector3d {
      return c.cwiseQuotient((values.array() + mu).matrix());
    };
    double low = (std::max)(0., -values[0]) + 1e-12 * scale, high = low + c.norm();
    if(y(low).squaredNorm() <= 1)
      high = low;
    while(high - low > 1e-12 * scale) {
      const double middle = (low + high) / 2;
      (y(middle).squaredNorm() <= 1 ? high : low) = middle;
    }
    return solver.eigenvectors() * y(high);
  }

  Eigen::Vector3d at(const Eigen::Vector3d& y) const { return m_middle + m_axes * y; }

  static Eigen::Vector3d coordinates(const int i)
  {
    const double h = std::sqrt(0.5);
    const double y[number_of_samples][3] = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0},  {0, 1, 0},
                                            {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {h, h, 0},
                                            {h, 0, h},  {0, h, h}};
    return Eigen::Vector3d(y[i][0], y[i][1], y[i][2]);
  }

  Eigen::Vector3d m_middle;
  Eigen::Matrix3d m_axes;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_PLACEMENT_QUADRIC_H
