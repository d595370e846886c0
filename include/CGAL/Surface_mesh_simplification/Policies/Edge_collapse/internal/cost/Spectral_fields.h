// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_FIELDS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_COST_SPECTRAL_FIELDS_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_signals.h>

#include <CGAL/Spectral_geometry/internal/surface/Triangle_element.h>
#include <CGAL/assertions.h>

namespace CGAL::Surface_mesh_simplification::internal {

/// Cotangents and area of a triangle (c; a, b), seen from its corner c.
struct Spectral_triangle
{
  double cot_center = 0; ///< at c, opposite ab
  double cot_first = 0;  ///< at a, opposite cb
  double cot_second = 0; ///< at b, opposite ca
  double area = 0;

  /// This triangle as (a; b, c) and (b; c, a).
  Spectral_triangle from_first() const { return {cot_first, cot_second, cot_center, area}; }
  Spectral_triangle from_second() const { return {cot_second, cot_center, cot_first, area}; }

  // A cotangent of 1e10 means an angle of 1e-10: collapses make no such triangle.
  static constexpr double degenerate_cotangent = 1e10;
};

/// That of `Spectral_geometry::internal::Triangle_element`, with one division and one square root.
/// The rule for what is degenerate is that of the assembly, so that E is 0 on the input. With
/// `mean`, the coefficients of an operator, cotangents are those of its conductivity and the area
/// is weighted by its density.
inline Spectral_triangle
spectral_triangle(const Eigen::Vector3d& c, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  const Spectral_geometry::internal::Point_coefficients* mean = nullptr)
{
  using Spectral_geometry::internal::triangle_element;
  const Eigen::Vector3d edges[3] = {b - a, c - b, a - c};
  const Spectral_geometry::internal::Triangle_element element =
      mean == nullptr ? triangle_element(edges) : triangle_element(edges, *mean);
  if(element.is_degenerate())
    return {};
  const double inverse = 1 / element.twice_area;
  return {element.dot[0] * inverse, element.dot[1] * inverse, element.dot[2] * inverse,
          (mean == nullptr ? 1. : (*mean)[0]) * element.twice_area / 2};
}

/// A neighbour in the ring of a vertex c, and the triangle (c; vertex, next vertex of the ring) if
/// `face` is set. A vertex of the border has one entry without a face.
struct Spectral_ring_entry
{
  Spectral_slot vertex = null_spectral_slot;
  bool face = false;
  /// the latest cost of collapsing the edge from a smaller slot to `vertex`; negative infinity: not
  /// known
  double cost = unknown_cost;
  Spectral_triangle triangle;

  static constexpr double unknown_cost = -std::numeric_limits<double>::infinity();
};

using Spectral_ring = std::vector<Spectral_ring_entry>;

/*!
 * The connectivity of the current mesh in slots, with the geometry of each triangle at each of its
 * corners.
 *
 * The policies see every mesh type through this mirror: the walk over halfedges is done once, for
 * the kept vertex of a collapse, and everything else is arithmetic on arrays.
 */
class Spectral_rings
{
public:
  void resize(const std::size_t n) { m_rings.assign(n, Spectral_ring()); }

  Spectral_ring& operator[](const Spectral_slot s) { return m_rings[s]; }
  const Spectral_ring& operator[](const Spectral_slot s) const { return m_rings[s]; }

  /// Position of `w` in the ring of `c`, or the ring's size.
  std::size_t find(const Spectral_slot c, const Spectral_slot w) const
  {
    const Spectral_ring& ring = m_rings[c];
    std::size_t i = 0;
    while(i < ring.size() && ring[i].vertex != w)
      ++i;
    return i;
  }

  /// Whether an edge joins two vertices: looks at the smaller of their rings.
  bool are_adjacent(Spectral_slot c, Spectral_slot w) const
  {
    if(m_rings[w].size() < m_rings[c].size())
      std::swap(c, w);
    return find(c, w) < m_rings[c].size();
  }

  bool is_border(const Spectral_slot c) const
  {
    return std::any_of(m_rings[c].begin(), m_rings[c].end(),
                       [](const Spectral_ring_entry& e) { return !e.face; });
  }

  static std::size_t next(const Spectral_ring& ring, const std::size_t i)
  {
    return i + 1 == ring.size() ? 0 : i + 1;
  }
  static std::size_t prev(const Spectral_ring& ring, const std::size_t i)
  {
    return i == 0 ? ring.size() - 1 : i - 1;
  }

  /// Calls function(a, b) for each triangle (c, a, b).
  template <class Function>
  void for_triangles(const Spectral_slot c, const Function& function) const
  {
    const Spectral_ring& ring = m_rings[c];
    for(std::size_t i = 0; i < ring.size(); ++i)
      if(ring[i].face)
        function(ring[i].vertex, ring[next(ring, i)].vertex);
  }
  /// Calls function(a) for each neighbour.
  template <class Function>
  void for_neighbours(const Spectral_slot c, const Function& function) const
  {
    for(const Spectral_ring_entry& e : m_rings[c])
      function(e.vertex);
  }

  /// First step of a collapse of `removed` into `kept`: `ring` is that of the kept vertex after it,
  /// as the mesh has it. Its triangles follow from `Spectral_fields::update_triangles()`, those
  /// around it from follow().
  void merge(const Spectral_slot removed, const Spectral_slot kept, Spectral_ring ring)
  {
    Spectral_ring().swap(m_rings[removed]);
    m_rings[kept] = std::move(ring);
  }

  /// Second step: puts `kept` in the place of `removed` in the ring of each neighbour of `kept`,
  /// and takes the two triangles that they share.
  void follow(const Spectral_slot removed, const Spectral_slot kept)
  {
    const Spectral_ring& around = m_rings[kept];
    for(std::size_t i = 0; i < around.size(); ++i) {
      replace_in_ring(around[i].vertex, removed, kept);
      Spectral_ring& ring = m_rings[around[i].vertex];
      const std::size_t j = find(around[i].vertex, kept);
      CGAL_assertion(j < ring.size());
      // (kept; w, next) is (w; next, kept), and (kept; previous, w) is (w; kept, previous).
      ring[prev(ring, j)].triangle = around[i].triangle.from_first();
      ring[j].triangle = around[prev(around, i)].triangle.from_second();
      ring[j].cost = Spectral_ring_entry::unknown_cost;
    }
  }

private:
  // Puts `kept` in the place of `removed` in the ring of c. Where removed and kept were
  // consecutive, the triangle between them vanished and the later of the two entries takes the
  // place of both: an entry carries the face that follows it.
  void replace_in_ring(const Spectral_slot c, const Spectral_slot removed, const Spectral_slot kept)
  {
    Spectral_ring& ring = m_rings[c];
    const std::size_t i = find(c, removed);
    if(i == ring.size())
      return;
    ring[i].vertex = kept;
    const std::size_t nx = next(ring, i), pv = prev(ring, i);
    if(nx != i && ring[nx].vertex == kept)
      ring.erase(ring.begin() + std::ptrdiff_t(i));
    else if(pv != i && ring[pv].vertex == kept)
      ring.erase(ring.begin() + std::ptrdiff_t(pv));
  }

  std::vector<Spectral_ring> m_rings;
};

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
  /// one flag for each slot that survives with its position and its row of P, or nothing
  std::vector<char> kept;
  double area_scale = 1;         ///< 1 / area of the input, weighted by the density
  bool single_precision = false; ///< whether the mesh stores its points as `float`
  /// A vertex with more neighbours is a hub. An edge at a hub is costed as if the hub stayed, until
  /// its turn comes: anything else would change all triangles of the hub.
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
      if(ring[i].face)
        ring[i].triangle = triangle(c, ring[i].vertex, ring[Spectral_rings::next(ring, i)].vertex);
  }

  bool vanishes_at(const Spectral_slot s) const { return !vanishing.empty() && vanishing[s] != 0; }

  /// Three times the share of the triangle in the lumped mass of its centre: its area, if areas are
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
