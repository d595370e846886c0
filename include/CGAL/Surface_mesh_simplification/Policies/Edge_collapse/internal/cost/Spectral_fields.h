// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_FIELDS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_FIELDS_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_rings.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_signals.h>

#include <CGAL/Spectral_geometry/internal/surface/Triangle_element.h>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace CGAL::Surface_mesh_simplification::internal {

/*!
 * The current mesh and what lives on it, in slots: for each slot w the rows f_w, z_w and
 * R_w = (B Z)_w - (L F)_w, the mass M_w and E_w = |R_w|^2 / M_w (Eq. 2, decomposed by vertex).
 * Areas and masses are those of the input scaled to unit area.
 */
struct Spectral_fields
{
  Spectral_signals signals; ///< F, Z and R, or mixtures of their columns
  Eigen::VectorXd mass;     ///< lumped M_w
  Eigen::VectorXd E;        ///< E_w
  std::vector<Eigen::Vector3d> points;
  Spectral_rings rings;
  double theta = 0;     ///< B = (1 - theta) M_lumped + theta M_consistent
  bool voronoi = false; ///< M_lumped has mixed Voronoi areas
  /// of the operator, merged as f_w is; empty for the cotangent Laplacian
  std::vector<Spectral_geometry::internal::Point_coefficients> coefficients;
  double conductivity = 1; ///< their mean on the input: the unit of cotangents
  /// Whether functions vanish there, on the border: its row is not in E. Empty: nowhere.
  std::vector<char> vanishing;
  std::vector<char>
      kept; ///< one flag for each slot that survives with its position and its row of P, or nothing
  double area_scale = 1;         ///< 1 / area of the input, weighted by the density
  bool single_precision = false; ///< whether the mesh stores its points as `float`
  /// A vertex of more neighbours is a hub: an edge that leads there is costed as if it stayed,
  /// until its turn comes, for whatever else may become of it changes all of its triangles.
  std::size_t largest_degree_of_others = 256;

  bool is_hub(const Spectral_slot s) const { return rings[s].size() > largest_degree_of_others; }

  bool is_kept(const Spectral_slot s) const { return !kept.empty() && kept[s] != 0; }

  /// Whether a collapse to `point` would move a vertex that is to be kept, merge two of them, or
  /// put one with its values on a border where functions vanish.
  bool moves_kept_vertex(const Spectral_slot u, const Spectral_slot v,
                         const Eigen::Vector3d& point) const
  {
    const auto would_move = [&](const Spectral_slot kept, const Spectral_slot other) {
      return is_kept(kept) && (is_kept(other) || point != points[kept] ||
                               (vanishes_at(other) && !vanishes_at(kept)));
    };
    return would_move(u, v) || would_move(v, u);
  }

  /// The triangle (c; a, b), weighted by the coefficients.
  Spectral_triangle triangle(const Spectral_slot c, const Spectral_slot a,
                             const Spectral_slot b) const
  {
    if(coefficients.empty())
      return spectral_triangle(points[c], points[a], points[b]);
    const Spectral_geometry::internal::Point_coefficients mean =
        (coefficients[c] + coefficients[a] + coefficients[b]) / 3;
    return spectral_triangle(points[c], points[a], points[b], &mean);
  }

  /// Fills the triangles of the ring of c.
  void update_triangles(const Spectral_slot c)
  {
    Spectral_ring& ring = rings[c];
    for(std::size_t i = 0; i < ring.size(); ++i)
      ring[i].triangle =
          ring[i].face ? triangle(c, ring[i].vertex, ring[Spectral_rings::next(ring, i)].vertex)
                       : Spectral_triangle();
  }

  bool vanishes_at(const Spectral_slot s) const { return !vanishing.empty() && vanishing[s] != 0; }

  /// Three times what the triangle gives to the lumped mass of its centre: its area, where that is
  /// divided equally.
  double area_of_center(const Spectral_triangle& t) const
  {
    return voronoi ? 3 * t.area *
                         Spectral_geometry::internal::mixed_voronoi_share(t.cot_center, t.cot_first,
                                                                          t.cot_second)
                   : t.area;
  }

  // Shares of a triangle's area: row sums of B stay A / 3 per corner.
  double diagonal_share() const { return (1 - theta) / 3 + theta / 6; }
  double off_diagonal_share() const { return theta / 12; }
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_FIELDS_H
