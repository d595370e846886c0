// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_SHAPE_TERM_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_SHAPE_TERM_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_rings.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// q(x) = x^T A x + 2 b.x + c.
struct Spectral_quadric
{
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

  /// Adds weight ((n.(x - p))^2 + variance |x - p|^2): the expected squared distance to a plane through p whose unit normal n
  /// has that variance in each coordinate (Trettner and Kobbelt, *Fast and Robust QEF Minimization using Probabilistic
  /// Quadrics*, Computer Graphics Forum 39(2), 2020, Eq. 14). A variance of p adds a constant there, which no change contains.
  void add_plane(const Eigen::Vector3d& normal, const Eigen::Vector3d& p, const double weight,
                 const double variance)
  {
    Eigen::Matrix3d plane = weight * normal * normal.transpose();
    plane.diagonal().array() += weight * variance;
    const Eigen::Vector3d at_p = plane * p;
    A += plane;
    b -= at_p;
    c += p.dot(at_p);
  }
};

/*!
 * The shape term of the cost: for each slot w the quadric
 * \f[ Q_w(x) = \sum_f |f| \left( (n_f \cdot (x - p))^2 + \sigma^2 |x - p|^2 \right) \f]
 * over the faces f around each input vertex p that was merged into w, and as much for each border edge with the plane
 * through it at right angles to its face, weighted by ten times its squared length. A collapse of (u,v) to x costs
 * \f$ Q_u(x) + Q_v(x) - Q_u(p_u) - Q_v(p_v) \f$, for the input scaled to unit area.
 *
 * The first part keeps the surface. The second is the energy of a centroidal Voronoi tessellation: it spreads vertices
 * evenly. Weights are areas, so that the resolution of the input does not matter.
 *
 * Before set_geometry() it is empty and costs nothing. Reads may run on several threads.
 */
class Spectral_shape_term
{
public:
  bool is_empty() const { return m_quadrics.empty(); }

  /// The planes of a mesh as its rings have it, unless those of an earlier state are there: merged vertices keep theirs.
  void set_geometry(const std::vector<Eigen::Vector3d>& points, const Spectral_rings& rings,
                    const double area_scale)
  {
    if(!is_empty() || points.empty())
      return;
    m_origin = points.front();
    m_scale = area_scale * area_scale;
    m_quadrics.resize(points.size());
    for(std::size_t w = 0; w < points.size(); ++w)
      add_ring(points, rings[Spectral_slot(w)], Spectral_slot(w));
  }

  /// What a collapse of (u,v) to x adds.
  double change(const std::vector<Eigen::Vector3d>& points, const Spectral_slot u, const Spectral_slot v,
                const Eigen::Vector3d& x) const
  {
    const Spectral_quadric &at_u = m_quadrics[u], &at_v = m_quadrics[v];
    const Eigen::Vector3d y = x - m_origin;
    return m_scale * (at_u(y) + at_v(y) - at_u(points[u] - m_origin) - at_v(points[v] - m_origin));
  }

  /// The x of least cost. Unique: the variance makes the sum positive definite unless the faces have no area.
  Eigen::Vector3d minimiser(const Spectral_slot u, const Spectral_slot v) const
  {
    const Eigen::Matrix3d A = m_quadrics[u].A + m_quadrics[v].A;
    return m_origin - A.llt().solve(m_quadrics[u].b + m_quadrics[v].b);
  }

  /// Follows the collapse of `removed` into `kept`.
  void merge(const Spectral_slot removed, const Spectral_slot kept)
  {
    if(!is_empty())
      m_quadrics[kept] += m_quadrics[removed];
  }

private:
  // sigma^2: of the direction of a normal, 0.15 radians. Between 0.1 and 0.25 the norms hardly depend on it; 0.5 shrinks tips.
  static constexpr double variance = 0.0225;
  // Of a border edge beside a face of as much area; 100 is as good, 1 lets the border wear off.
  static constexpr double border_weight = 10;

  // Angles and lengths are taken from the vertex itself: far from the origin nothing is lost.
  void add_ring(const std::vector<Eigen::Vector3d>& points, const Spectral_ring& ring, const Spectral_slot w)
  {
    const Eigen::Vector3d p = points[w] - m_origin;
    for(std::size_t i = 0; i < ring.size(); ++i) {
      if(!ring[i].face)
        continue;
      const std::size_t before = Spectral_rings::prev(ring, i), after = Spectral_rings::next(ring, i);
      const Eigen::Vector3d a = points[ring[i].vertex] - points[w],
                            b = points[ring[after].vertex] - points[w];
      const Eigen::Vector3d cross = a.cross(b);
      const double double_area = cross.norm();
      if(!(double_area > 0))
        continue;
      const Eigen::Vector3d normal = cross / double_area;
      m_quadrics[w].add_plane(normal, p, double_area / 2, variance);
      if(!ring[before].face)
        add_border(a, normal, p, w);
      if(!ring[after].face)
        add_border(b, normal, p, w);
    }
  }

  void add_border(const Eigen::Vector3d& edge, const Eigen::Vector3d& normal, const Eigen::Vector3d& p,
                  const Spectral_slot w)
  {
    m_quadrics[w].add_plane(edge.cross(normal).normalized(), p, border_weight * edge.squaredNorm(), variance);
  }

  Eigen::Vector3d m_origin = Eigen::Vector3d::Zero();
  double m_scale = 1;
  std::vector<Spectral_quadric> m_quadrics;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_SHAPE_TERM_H
