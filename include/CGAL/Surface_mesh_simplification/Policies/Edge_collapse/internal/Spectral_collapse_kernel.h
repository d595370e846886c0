// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COLLAPSE_KERNEL_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COLLAPSE_KERNEL_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_rings.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_row_norms.h>

#include <CGAL/assertions.h>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/*!
 * What the local cost reads: the current mesh in slots and, for each slot w, the rows f_w and
 * R_w = (B Z)_w - (L F)_w, the mass M_w and E_w = |R_w|^2 / M_w (Eq. 2, decomposed by vertex).
 * Areas and masses are those of the input scaled to unit area.
 */
struct Spectral_fields
{
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Rows F;                          ///< n x padded K
  Rows Z;                          ///< the same, or empty where Z = F Lambda
  Eigen::VectorXd lambda;          ///< padded K, read where Z is empty
  Rows R;                          ///< n x padded K
  Eigen::VectorXd mass;            ///< lumped barycentric M_w
  Eigen::VectorXd E;               ///< E_w
  std::vector<Eigen::Vector3d> points;
  Spectral_rings rings;
  double theta = 0;                ///< B = (1 - theta) M_lumped + theta M_consistent
  double area_scale = 1;           ///< 1 / area of the input

  // Shares of a triangle's area: row sums of B stay A / 3 per corner.
  double diagonal_share() const { return (1 - theta) / 3 + theta / 6; }
  double off_diagonal_share() const { return theta / 12; }
};

/// A way to collapse a candidate (u,v): x replaces both, f_x = (1 - weight) f_u + weight f_v.
struct Spectral_sample
{
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double weight = 0;
  double cost = std::numeric_limits<double>::infinity();
};

/*!
 * The local cost of collapsing one edge: cost = sum over H of E_w after - sum over H of E_w before,
 * where H is the merged vertex and its link (section 3.3 of the paper).
 *
 * For a vertex w of the link only the triangles around u and v change, so R_w after is R_w plus a
 * combination of five rows: w, u, v and the two neighbours of w along the link. The merged
 * vertex has no such shortcut: its row is summed over its whole ring.
 *
 * The object holds the scratch memory of one thread; it allocates only while a larger ring than any
 * before comes along.
 */
class Spectral_collapse_kernel
{
public:
  enum class Topology { collapsible, link_condition, both_on_border };

  /// Collects the neighbourhood of (u,v) as it is. Unless the answer is `collapsible`, CGAL's loop would
  /// refuse the edge until something near changes, and nothing may be evaluated.
  Topology prepare(const Spectral_fields& fields, const Spectral_slot u, const Spectral_slot v)
  {
    m_fields = &fields;
    m_u = u;
    m_v = v;
    const Topology topology = check_topology();
    if(topology == Topology::collapsible) {
      collect_link();
      subtract_old_triangles();
    }
    return topology;
  }

  /// Fills `cost` of up to three samples; infinity where a triangle without area would arise.
  void evaluate(Spectral_sample* samples, const int count)
  {
    CGAL_precondition(count >= 1 && count <= Spectral_row_combination::max_samples);
    for(int s = 0; s < count; ++s) {
      samples[s].cost = -m_before;
      if(!add_new_triangles(samples[s], s))
        samples[s].cost = std::numeric_limits<double>::infinity();
    }
    for(std::size_t i = 0; i < m_link.size(); ++i)
      add_link_row(i, samples, count);
    add_merged_row(samples, count);
    for(int s = 0; s < count; ++s)
      if(!std::isfinite(samples[s].cost))
        samples[s].cost = std::numeric_limits<double>::infinity();
  }

private:
  enum Column { self, at_u, at_v, first, second, number_of_columns };

  // Coefficients of one row of the residual on its five columns: a on F (from -L), b on Z (from B).
  struct Coefficients
  {
    std::array<double, number_of_columns> a{}, b{};
    double mass = 0;
  };

  struct Link_vertex
  {
    Spectral_slot slot;
    int neighbor[2] = {-1, -1}; ///< along the link, as indices into it
    Coefficients old;           ///< minus the triangles around u and v as they are
    Coefficients updated[Spectral_row_combination::max_samples];
  };

  // A triangle around u or v that survives the collapse as (x; a, b); a and b index the link.
  struct Outer_triangle
  {
    int a, b;
    Spectral_triangle old;
  };

  // Coefficients of the merged row: on F and Z of each link vertex, then on those of x itself.
  struct Merged_row
  {
    std::vector<double> a, b;
    double a_self, b_self, mass;
  };

  // CGAL's link condition, and its refusal of inner edges between border vertices. Both depend only
  // on the rings of u and v, and whenever those change CGAL costs the edge again.
  Topology check_topology() const
  {
    const Spectral_rings& rings = m_fields->rings;
    const Spectral_ring& ring = rings[m_u];
    const std::size_t i = rings.find(m_u, m_v);
    CGAL_assertion(i < ring.size());
    const std::size_t before = Spectral_rings::prev(ring, i);
    for(std::size_t j = 0; j < ring.size(); ++j) {
      const bool shares_face = (j == Spectral_rings::next(ring, i) && ring[i].face) ||
                               (j == before && ring[before].face);
      if(j != i && !shares_face && rings.find(m_v, ring[j].vertex) < rings[m_v].size())
        return Topology::link_condition;
    }
    if(ring[i].face && ring[before].face && rings.is_border(m_u) && rings.is_border(m_v))
      return Topology::both_on_border;
    return Topology::collapsible;
  }

  int link_index(const Spectral_slot s) const
  {
    for(std::size_t i = 0; i < m_link.size(); ++i)
      if(m_link[i].slot == s)
        return int(i);
    return -1;
  }

  void add_to_link(const Spectral_slot s)
  {
    if(link_index(s) >= 0)
      return;
    m_link.emplace_back();
    m_link.back().slot = s;
    m_before += m_fields->E[s];
  }

  void collect_link()
  {
    m_link.clear();
    m_before = m_fields->E[m_u] + m_fields->E[m_v];
    for(const Spectral_ring_entry& e : m_fields->rings[m_u])
      if(e.vertex != m_v)
        add_to_link(e.vertex);
    for(const Spectral_ring_entry& e : m_fields->rings[m_v])
      if(e.vertex != m_u)
        add_to_link(e.vertex);
  }

  static Column link_column(Link_vertex& w, const int neighbor)
  {
    if(w.neighbor[0] == neighbor || w.neighbor[0] < 0) {
      w.neighbor[0] = neighbor;
      return first;
    }
    CGAL_assertion(w.neighbor[1] == neighbor || w.neighbor[1] < 0);
    w.neighbor[1] = neighbor;
    return second;
  }

  // The row of corner w of a triangle (w; p, q): L has -cot(q)/2 on p and -cot(p)/2 on q, B has the
  // shares of the area.
  void add_corner(Coefficients& row, const Column p, const double cot_q, const Column q, const double cot_p,
                  const double area, const double sign) const
  {
    const double to_p = sign * cot_q / 2, to_q = sign * cot_p / 2;
    const double scaled_area = sign * area * m_fields->area_scale;
    row.a[p] += to_p;
    row.a[q] += to_q;
    row.a[self] -= to_p + to_q;
    row.b[self] += scaled_area * m_fields->diagonal_share();
    row.b[p] += scaled_area * m_fields->off_diagonal_share();
    row.b[q] += scaled_area * m_fields->off_diagonal_share();
    row.mass += scaled_area / 3;
  }

  void subtract_old_triangles()
  {
    m_outer.clear();
    subtract_ring(m_u, m_v, at_u, true);
    subtract_ring(m_v, m_u, at_v, false);
  }

  // Triangles with both u and v are seen from u and from v; they are taken once.
  void subtract_ring(const Spectral_slot center, const Spectral_slot other, const Column center_column,
                     const bool with_shared)
  {
    const Spectral_ring& ring = m_fields->rings[center];
    const Column other_column = center_column == at_u ? at_v : at_u;
    for(std::size_t i = 0; i < ring.size(); ++i) {
      if(!ring[i].face)
        continue;
      const Spectral_slot p = ring[i].vertex, q = ring[Spectral_rings::next(ring, i)].vertex;
      const Spectral_triangle& t = ring[i].triangle;
      if(p == other || q == other) {
        if(!with_shared)
          continue;
        Link_vertex& w = m_link[link_index(p == other ? q : p)];
        const double cot_other = p == other ? t.cot_first : t.cot_second;
        add_corner(w.old, center_column, cot_other, other_column, t.cot_center, t.area, -1);
      } else {
        const int a = link_index(p), b = link_index(q);
        Link_vertex &wa = m_link[a], &wb = m_link[b];
        add_corner(wa.old, center_column, t.cot_second, link_column(wa, b), t.cot_center, t.area, -1);
        add_corner(wb.old, center_column, t.cot_first, link_column(wb, a), t.cot_center, t.area, -1);
        m_outer.push_back(Outer_triangle{a, b, t});
      }
    }
  }

  // New coefficients go to the column of u first and are shared out with v by the weight at the end.
  bool add_new_triangles(const Spectral_sample& sample, const int s)
  {
    Merged_row& x = m_merged[s];
    x.a.assign(m_link.size(), 0);
    x.b.assign(m_link.size(), 0);
    x.a_self = x.b_self = x.mass = 0;
    for(Link_vertex& w : m_link)
      w.updated[s] = Coefficients();

    for(const Outer_triangle& o : m_outer) {
      const Eigen::Vector3d &pa = m_fields->points[m_link[o.a].slot], &pb = m_fields->points[m_link[o.b].slot];
      const Spectral_triangle t = spectral_triangle(sample.point, pa, pb);
      if(degenerate(t) && !degenerate(o.old))
        return false;
      Link_vertex &wa = m_link[o.a], &wb = m_link[o.b];
      add_corner(wa.updated[s], at_u, t.cot_second, link_column(wa, o.b), t.cot_center, t.area, 1);
      add_corner(wb.updated[s], at_u, t.cot_first, link_column(wb, o.a), t.cot_center, t.area, 1);
      add_merged_corner(x, o, t);
    }
    for(Link_vertex& w : m_link)
      share_with_v(w.updated[s], w.old, sample.weight);
    return x.mass > 0;
  }

  // A cotangent of 1e10 means an angle of 1e-10: such a triangle has no area that doubles can tell.
  static bool degenerate(const Spectral_triangle& t)
  {
    return !(t.area > 0) || !(t.cot_center + t.cot_first + t.cot_second < 1e10);
  }

  void add_merged_corner(Merged_row& x, const Outer_triangle& o, const Spectral_triangle& t) const
  {
    const double area = t.area * m_fields->area_scale;
    x.a[o.a] += t.cot_second / 2;
    x.a[o.b] += t.cot_first / 2;
    x.a_self -= (t.cot_first + t.cot_second) / 2;
    x.b[o.a] += area * m_fields->off_diagonal_share();
    x.b[o.b] += area * m_fields->off_diagonal_share();
    x.b_self += area * m_fields->diagonal_share();
    x.mass += area / 3;
  }

  static void share_with_v(Coefficients& updated, const Coefficients& old, const double weight)
  {
    const double a = updated.a[at_u], b = updated.b[at_u];
    updated.a[at_u] = (1 - weight) * a;
    updated.a[at_v] = weight * a;
    updated.b[at_u] = (1 - weight) * b;
    updated.b[at_v] = weight * b;
    for(int c = 0; c < number_of_columns; ++c) {
      updated.a[c] += old.a[c];
      updated.b[c] += old.b[c];
    }
    updated.mass += old.mass;
  }

  const double* f_row(const Spectral_slot s) const { return m_fields->F.data() + s * m_fields->F.cols(); }
  const double* z_row(const Spectral_slot s) const { return m_fields->Z.data() + s * m_fields->Z.cols(); }

  void set_rows(Spectral_row_combination& c, const Spectral_slot* slots)
  {
    m_f.resize(c.n);
    m_z.resize(c.n);
    const bool stored = m_fields->Z.size() != 0;
    for(std::size_t j = 0; j < c.n; ++j) {
      m_f[j] = f_row(slots[j]);
      m_z[j] = stored ? z_row(slots[j]) : nullptr;
    }
    c.f = m_f.data();
    c.z = stored ? m_z.data() : nullptr;
    c.lambda = m_fields->lambda.data();
    c.length = std::size_t(m_fields->F.cols());
  }

  void add_link_row(const std::size_t i, Spectral_sample* samples, const int count)
  {
    const Link_vertex& w = m_link[i];
    Spectral_slot slots[number_of_columns] = {w.slot, m_u, m_v, w.slot, w.slot};
    for(int k = 0; k < 2; ++k)
      if(w.neighbor[k] >= 0)
        slots[first + k] = m_link[w.neighbor[k]].slot;

    Spectral_row_combination c;
    c.base = m_fields->R.data() + w.slot * m_fields->R.cols();
    c.n = number_of_columns;
    c.n_mass = m_fields->theta == 0 ? 1 : number_of_columns;
    set_rows(c, slots);
    const double *a[3], *b[3];
    for(int s = 0; s < count; ++s) {
      a[s] = w.updated[s].a.data();
      b[s] = w.updated[s].b.data();
    }
    c.a = a;
    c.b = b;
    double norms[3];
    spectral_row_norms(c, count, norms);
    for(int s = 0; s < count; ++s) {
      const double mass = m_fields->mass[w.slot] + w.updated[s].mass;
      samples[s].cost += mass > 0 ? norms[s] / mass : std::numeric_limits<double>::infinity();
    }
  }

  // Columns: u and v, which share the coefficients of x and carry mass in either metric, then the link.
  void add_merged_row(Spectral_sample* samples, const int count)
  {
    const std::size_t n = m_link.size() + 2;
    m_slots.assign({m_u, m_v});
    for(const Link_vertex& w : m_link)
      m_slots.push_back(w.slot);

    Spectral_row_combination c;
    c.n = n;
    c.n_mass = m_fields->theta == 0 ? 2 : n;
    set_rows(c, m_slots.data());
    const double *a[3], *b[3];
    for(int s = 0; s < count; ++s) {
      Merged_row& x = m_merged[s];
      const double weight = samples[s].weight;
      const double head_a[2] = {(1 - weight) * x.a_self, weight * x.a_self};
      const double head_b[2] = {(1 - weight) * x.b_self, weight * x.b_self};
      x.a.insert(x.a.begin(), head_a, head_a + 2);
      x.b.insert(x.b.begin(), head_b, head_b + 2);
      a[s] = x.a.data();
      b[s] = x.b.data();
    }
    c.a = a;
    c.b = b;
    double norms[3];
    spectral_row_norms(c, count, norms);
    for(int s = 0; s < count; ++s)
      samples[s].cost += norms[s] / m_merged[s].mass;
  }

  const Spectral_fields* m_fields = nullptr;
  Spectral_slot m_u = null_spectral_slot, m_v = null_spectral_slot;
  double m_before = 0;
  std::vector<Link_vertex> m_link;
  std::vector<Outer_triangle> m_outer;
  Merged_row m_merged[Spectral_row_combination::max_samples];
  std::vector<const double*> m_f, m_z;
  std::vector<Spectral_slot> m_slots;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COLLAPSE_KERNEL_H
