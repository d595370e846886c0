// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_SHAPE_TERM_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_COST_SPECTRAL_SHAPE_TERM_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_quadric.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_rings.h>

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <vector>

namespace CGAL::Surface_mesh_simplification::internal {

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
 * Before set_geometry() it is empty and costs nothing. Reads may run on several threads.
 *
 * With the shape term no change of E counts for more than `Spectral_options::largest_loss` times
 * what the signals have at both ends: beside needles E is larger than that by orders of magnitude,
 * and a few folds of the input (eyes, nostrils) would never be collapsed.
 */
class Spectral_shape_term
{
public:
  bool is_empty() const { return m_quadrics.empty(); }

  /// What makes `Spectral_options::shape` a number without unit: both terms of the cost grow with
  /// the scale of E, and the shape term, a squared distance times an area, is compared with 1 / n,
  /// the area that a vertex stands for.
  void set_weights(const Spectral_options& options, const double sum_of_squares)
  {
    const double scale = sum_of_squares > 0 ? sum_of_squares : 1.;
    m_weight = options.shape * scale;
    m_largest_loss = options.largest_loss * scale;
  }

  /// For each unit of mass at the ends of an edge.
  double largest_loss() const
  {
    return is_empty() ? std::numeric_limits<double>::infinity() : m_largest_loss;
  }

  /// The planes of a mesh as its rings have it.
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
