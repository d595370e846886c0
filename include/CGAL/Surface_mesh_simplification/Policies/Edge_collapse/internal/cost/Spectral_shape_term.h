// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_SHAPE_TERM_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_SHAPE_TERM_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_fields.h>

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

  /// The minimiser; not finite if A is singular. Cholesky's A = U^T U is written out: Eigen's for
  /// this size takes a twentieth of the compile time of the smallest program.
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

  /// Adds the plane of a face with corner p and the edges a and b from there, and for each border
  /// edge of these the plane through it at right angles to the face. A face without area adds
  /// nothing.
  void add_corner(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const bool a_is_border,
                  const Eigen::Vector3d& b, const bool b_is_border)
  {
    const Eigen::Vector3d cross = a.cross(b);
    const double double_area = cross.norm();
    if(!(double_area > 0))
      return;
    const Eigen::Vector3d normal = cross / double_area;
    add_plane(normal, p, double_area / 2);
    for(const auto& [edge, is_border] : {std::pair(a, a_is_border), std::pair(b, b_is_border)})
      if(is_border)
        add_plane(edge.cross(normal).normalized(), p, border_weight * edge.squaredNorm());
  }

private:
  // sigma^2: of the direction of a normal, 0.15 radians. Between 0.1 and 0.25 the norms hardly
  // depend on it; 0.5 shrinks tips.
  static constexpr double variance = 0.0225;
  // Weight of a border edge relative to a face of equal area; 100 is as good, with 1 it wears off.
  static constexpr double border_weight = 10;

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

/*!
 * The shape term of the cost: for each slot w the quadric
 * \f[ Q_w(x) = \sum_f |f| \left( (n_f \cdot (x - p))^2 + \sigma^2 |x - p|^2 \right) \f]
 * over the faces f around each input vertex p that was merged into w, and as much for each border
 * edge with the plane through it at right angles to its face, weighted by ten times its squared
 * length. A collapse of (u,v) to x costs \f$ Q_u(x) + Q_v(x) - Q_u(p_u) - Q_v(p_v) \f$, for the
 * input scaled to unit area.
 *
 * The first part keeps the surface. The second is the energy of a centroidal Voronoi tessellation:
 * it spreads vertices evenly. Weights are areas, so that the resolution of the input does not
 * matter.
 *
 * Before set_geometry() it is empty and costs nothing. It also limits how much a change of E can
 * count, see `Spectral_options::largest_loss`: otherwise a few folds of the input (eyes, nostrils)
 * would never be collapsed.
 */
class Spectral_shape_term
{
public:
  bool is_empty() const { return m_quadrics.empty(); }

  /// Makes `Spectral_options::shape` dimensionless. Both terms of the cost grow with the scale of
  /// E. The shape term, a squared distance times an area, is compared with 1 / n, the area per
  /// vertex.
  void set_weights(const Spectral_options& options, const double sum_of_squares)
  {
    const double scale = sum_of_squares > 0 ? sum_of_squares : 1.;
    m_weight = options.shape * scale;
    m_largest_loss = options.largest_loss * scale;
  }

  /// The limit per unit of mass at the ends of an edge.
  double largest_loss() const
  {
    return is_empty() ? std::numeric_limits<double>::infinity() : m_largest_loss;
  }

  /// Sets the quadrics to the planes of the mesh that the rings describe.
  void set_geometry(const std::vector<Eigen::Vector3d>& points, const Spectral_rings& rings,
                    const double area_scale)
  {
    m_origin = points.front();
    m_scale = area_scale * area_scale;
    m_quadrics.resize(points.size());
    m_number_of_vertices = points.size();
    for(std::size_t w = 0; w < points.size(); ++w) {
      // Angles and lengths are taken from the vertex itself: far from the origin nothing is lost.
      const Eigen::Vector3d p = points[w] - m_origin;
      const Spectral_ring& ring = rings[Spectral_slot(w)];
      for(std::size_t i = 0; i < ring.size(); ++i) {
        if(!ring[i].face)
          continue;
        const std::size_t before = Spectral_rings::prev(ring, i),
                          after = Spectral_rings::next(ring, i);
        m_quadrics[w].add_corner(p, points[ring[i].vertex] - points[w], !ring[before].face,
                                 points[ring[after].vertex] - points[w], !ring[after].face);
      }
    }
  }

  /// What a collapse of (u,v) to x costs beside E.
  double cost(const std::vector<Eigen::Vector3d>& points, const Spectral_slot u,
              const Spectral_slot v, const Eigen::Vector3d& x) const
  {
    if(is_empty())
      return 0;
    const Spectral_quadric &at_u = m_quadrics[u], &at_v = m_quadrics[v];
    const Eigen::Vector3d y = x - m_origin;
    return m_weight * double(m_number_of_vertices) *
           (m_scale *
            (at_u(y) + at_v(y) - at_u(points[u] - m_origin) - at_v(points[v] - m_origin)));
  }

  /// The x of least cost. Unique: the variance makes the sum positive definite unless the faces
  /// have no area.
  Eigen::Vector3d minimiser(const Spectral_slot u, const Spectral_slot v) const
  {
    return m_origin + (m_quadrics[u] + m_quadrics[v]).minimiser();
  }

  /// Follows the collapse of `removed` into `kept`.
  void merge(const Spectral_slot removed, const Spectral_slot kept)
  {
    if(is_empty())
      return;
    m_quadrics[kept] += m_quadrics[removed];
    --m_number_of_vertices;
  }

private:
  Eigen::Vector3d m_origin = Eigen::Vector3d::Zero();
  double m_scale = 1, m_weight = 0, m_largest_loss = 0;
  std::size_t m_number_of_vertices = 0;
  std::vector<Spectral_quadric> m_quadrics;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_SHAPE_TERM_H
