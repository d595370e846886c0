// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_TRIANGLE_ELEMENT_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_TRIANGLE_ELEMENT_H

#include <CGAL/Spectral_geometry/internal/numerics/vector_units.h>
#include <CGAL/Spectral_geometry/local_operator.h>

namespace CGAL::Spectral_geometry::internal {

/// For a triangle with consecutive edges p and q, and `sum` = p + q: returns at each corner the
/// inner product of the edges that leave it, and |p x q|^2. An edge is any type with three
/// coordinates.
template <class Edge>
CGAL_SPECTRAL_INLINE void triangle_products(const Edge& p, const Edge& q, const Edge& sum,
                                            double& at_start, double& between, double& at_end,
                                            double& twice_area_squared)
{
  const auto dot = [](const auto& a, const auto& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  const double n[3] = {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2],
                       p[0] * q[1] - p[1] * q[0]};
  twice_area_squared = dot(n, n);
  at_start = dot(p, sum);
  between = -dot(p, q);
  at_end = dot(q, sum);
}

/*!
 * What linear finite elements take from a triangle, wherever they are needed: assembly, the rings
 * of the collapses and relocation. The cotangent at corner k is dot[k] / twice_area; the edge
 * opposite to it gets half of that in L, each corner a third of the area in M.
 */
struct Triangle_element
{
  double dot[3]; ///< of the two edges that leave the corner
  double twice_area;

  /// Whether the area is 0 up to rounding. Such a triangle contributes nothing.
  bool is_degenerate() const { return !(twice_area > 0); }
};

/// `edge[k]` lies opposite to corner k, from corner k + 1 to corner k + 2. The area is that of the
/// cross product of the two shortest edges: that of others would be a difference of larger numbers.
inline Triangle_element triangle_element(const Eigen::Vector3d (&edge)[3])
{
  double square[3];
  int longest = 0;
  for(int k = 0; k < 3; ++k) {
    square[k] = edge[k].squaredNorm();
    if(square[k] > square[longest])
      longest = k;
  }
  const int a = (longest + 1) % 3, b = (longest + 2) % 3;
  Triangle_element t;
  double twice_area_squared;
  triangle_products(edge[a], edge[b], Eigen::Vector3d(-edge[longest]), t.dot[b], t.dot[longest],
                    t.dot[a], twice_area_squared);
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  t.twice_area = twice_area_squared > rounding * rounding * square[a] * square[b]
                     ? std::sqrt(twice_area_squared)
                     : 0.;
  return t;
}

/// The cross product of two edges of face f of the mesh (V, T): twice its area along its normal.
template <class Positions>
Eigen::Vector3d face_normal(const Positions& V, const Eigen::MatrixXi& T, const Eigen::Index f)
{
  const Eigen::Vector3d a = V.row(T(f, 1)) - V.row(T(f, 0)), b = V.row(T(f, 2)) - V.row(T(f, 0));
  return a.cross(b);
}

/// Density, then the conductivity as xx, xy, xz, yy, yz, zz: a row of `Operator_coefficients`.
using Point_coefficients = Eigen::Matrix<double, 7, 1>;

/// A triangle has the mean of its corners' coefficients, if the operator has any.
inline std::optional<Point_coefficients> mean_coefficients(const Operator_coefficients& c,
                                                           const int (&corners)[3])
{
  if(c.rows() == 0)
    return {};
  return Point_coefficients(
      (c.row(corners[0]) + c.row(corners[1]) + c.row(corners[2])).transpose() / 3);
}

inline double density(const std::optional<Point_coefficients>& mean)
{
  return mean ? (*mean)[0] : 1.;
}

/// The unit of L; 1 without coefficients.
inline double mean_conductivity(const Operator_coefficients& c)
{
  return c.rows() == 0 ? 1. : (c.col(1) + c.col(4) + c.col(6)).mean() / 3;
}

inline Eigen::Matrix3d conductivity(const Point_coefficients& c)
{
  Eigen::Matrix3d D;
  D << c[1], c[2], c[3], c[2], c[4], c[5], c[3], c[5], c[6];
  return D;
}

/// Here the operator has coefficients or none, see `Local_operator`: edges are turned by
/// a right angle within the triangle, and products are those of the conductivity. The area is that
/// of the triangle, without the density.
inline Triangle_element triangle_element(const Eigen::Vector3d (&edge)[3],
                                         const std::optional<Point_coefficients>& mean)
{
  Triangle_element t = triangle_element(edge);
  if(!mean || t.is_degenerate())
    return t;
  const Eigen::Vector3d normal = edge[0].cross(edge[1]).normalized();
  const Eigen::Matrix3d D = conductivity(*mean);
  Eigen::Vector3d turned[3];
  for(int k = 0; k < 3; ++k)
    turned[k] = normal.cross(edge[k]);
  for(int k = 0; k < 3; ++k)
    t.dot[k] = -turned[(k + 1) % 3].dot(D * turned[(k + 2) % 3]);
  return t;
}

/// The share of a triangle's area that goes to the corner of cotangent c; a and b belong to the
/// other corners. It is the Voronoi region, or in an obtuse triangle half or a quarter (Meyer et
/// al. 2003, section 3.3). A common factor of the three does not matter: for an operator with a
/// conductivity these are regions in its metric.
inline double mixed_voronoi_share(const double c, const double a, const double b)
{
  if(c < 0)
    return 0.5;
  if(a < 0 || b < 0)
    return 0.25;
  const double all = a * b + c * (a + b);
  return all > 0 ? 0.25 * (1 + a * b / all) : 1. / 3;
}

/// Returns the share of corner k of three, or a third where areas are divided equally.
template <class Cotangents>
double lumped_share(const bool voronoi, const Cotangents& cot, const int k)
{
  return voronoi ? mixed_voronoi_share(cot[k], cot[(k + 1) % 3], cot[(k + 2) % 3]) : 1. / 3;
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_TRIANGLE_ELEMENT_H
