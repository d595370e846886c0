// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_QUADRIC_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_QUADRIC_H

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>

namespace CGAL::Surface_mesh_simplification::internal {

/// q(x) = x^T A x + 2 b.x + c.
class Spectral_quadric
{
public:
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double c = 0;

  double operator()(const Eigen::Vector3d& x) const { return x.dot(A * x + 2 * b) + c; }

  Spectral_quadric& operator+=(const Spectral_quadric& other)
  {
    A += other.A;
    b += other.b;
    c += other.c;
    return *this;
  }

  friend Spectral_quadric operator+(Spectral_quadric a, const Spectral_quadric& b)
  {
    return a += b;
  }

  /// Where it is least; not finite where A is singular. Cholesky's A = U^T U, written out: Eigen's
  /// for this size takes a twentieth of the time in which the smallest program compiles.
  Eigen::Vector3d minimiser() const
  {
    const double u00 = std::sqrt(A(0, 0)), u01 = A(0, 1) / u00, u02 = A(0, 2) / u00;
    const double u11 = std::sqrt(A(1, 1) - u01 * u01), u12 = (A(1, 2) - u01 * u02) / u11;
    const double u22 = std::sqrt(A(2, 2) - (u02 * u02 + u12 * u12));
    const double y0 = -b[0] / u00, y1 = (-b[1] - u01 * y0) / u11,
                 y2 = (-b[2] - (u02 * y0 + u12 * y1)) / u22;
    const double x2 = y2 / u22, x1 = (y1 - u12 * x2) / u11;
    return Eigen::Vector3d((y0 - (u01 * x1 + u02 * x2)) / u00, x1, x2);
  }

  /// The plane of a face with a corner p, from which edges lead along a and b, and the planes at
  /// right angles to it through those of them that are border edges. Nothing for a face without
  /// area.
  void add_corner(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const bool a_is_border,
                  const Eigen::Vector3d& b, const bool b_is_border)
  {
    const Eigen::Vector3d cross = a.cross(b);
    const double double_area = cross.norm();
    if(!(double_area > 0))
      return;
    const Eigen::Vector3d normal = cross / double_area;
    add_plane(normal, p, double_area / 2);
    if(a_is_border)
      add_border(a, normal, p);
    if(b_is_border)
      add_border(b, normal, p);
  }

private:
  // sigma^2: of the direction of a normal, 0.15 radians. Between 0.1 and 0.25 the norms hardly
  // depend on it; 0.5 shrinks tips.
  static constexpr double variance = 0.0225;
  // A border edge counts so much beside a face of as much area; 100 is as good, 1 lets it wear off.
  static constexpr double border_weight = 10;

  void add_border(const Eigen::Vector3d& edge, const Eigen::Vector3d& normal,
                  const Eigen::Vector3d& p)
  {
    add_plane(edge.cross(normal).normalized(), p, border_weight * edge.squaredNorm());
  }

  // Adds weight ((n.(x - p))^2 + variance |x - p|^2): the expected squared distance to a plane
  // through p whose unit normal n has that variance in each coordinate (Trettner and Kobbelt, *Fast
  // and Robust QEF Minimization using Probabilistic Quadrics*, Computer Graphics Forum 39(2), 2020,
  // Eq. 14). A variance of p adds a constant there, which no change contains.
  void add_plane(const Eigen::Vector3d& normal, const Eigen::Vector3d& p, const double weight)
  {
    Eigen::Matrix3d plane = weight * normal * normal.transpose();
    plane.diagonal().array() += weight * variance;
    const Eigen::Vector3d at_p = plane * p;
    A += plane;
    b -= at_p;
    c += p.dot(at_p);
  }
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_QUADRIC_H
