// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_OPERATOR_GEOMETRY_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_OPERATOR_GEOMETRY_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

namespace CGAL::Spectral_geometry::internal {

/// Stiffness and mass of a mesh as functions of its positions, edge by edge, and the way back from
/// derivatives with respect to their entries to derivatives with respect to positions.
class Operator_geometry
{
public:
  using Index = Eigen::Index;
  using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

  struct Entry
  {
    int neighbour, edge;
  };
  struct Edge
  {
    int i, j;
  };
  /// Off the diagonal there is one number for each edge. The diagonal of L is minus the sum of its
  /// row.
  struct Entries
  {
    Eigen::VectorXd L, B, B_diagonal, mass;

    Entries& operator+=(const Entries& other)
    {
      L += other.L;
      B += other.B;
      B_diagonal += other.B_diagonal;
      mass += other.mass;
      return *this;
    }
  };

  /// `op` has coefficients for the n vertices, or none.
  Operator_geometry(const Eigen::MatrixXi& T, const Index n, const Local_operator& op)
    : m_op(op)
  {
    check_local_operator(op, n);
    require(T.cols() == 3, "relocation: T has ", T.cols(), " columns; pass a matrix of three.");
    m_rows.assign(std::size_t(n), {});
    m_triangles.reserve(std::size_t(T.rows()));
    for(Index f = 0; f < T.rows(); ++f) {
      Triangle t;
      for(int k = 0; k < 3; ++k) {
        t.v[k] = T(f, k);
        require(t.v[k] >= 0 && t.v[k] < n && t.v[k] != T(f, (k + 1) % 3), "relocation: triangle ",
                f, " refers to vertex ", t.v[k],
                ", which does not exist or occurs twice; repair the indices.");
      }
      for(int k = 0; k < 3; ++k)
        t.e[k] = edge_of(t.v[(k + 1) % 3], t.v[(k + 2) % 3]);
      m_triangles.push_back(t);
    }
    if(op.boundary == Boundary_condition::dirichlet)
      m_border = border_vertices(T, n);
  }

  Index number_of_vertices() const { return Index(m_rows.size()); }
  const std::vector<Edge>& edges() const { return m_edges; }
  const std::vector<Entry>& row(const Index w) const { return m_rows[w]; }
  const Local_operator& local_operator() const { return m_op; }
  /// Whether functions vanish there: it has no row in the operator.
  bool vanishes_at(const Index w) const { return !m_border.empty() && m_border[w] != 0; }

  Entries zero_entries() const
  {
    const Index n = number_of_vertices(), m = Index(m_edges.size());
    return {Eigen::VectorXd::Zero(m), Eigen::VectorXd::Zero(m), Eigen::VectorXd::Zero(n),
            Eigen::VectorXd::Zero(n)};
  }

  /// The matrices at V; false if a triangle has no area.
  bool assemble(const Positions& V, Entries& entries) const
  {
    entries = zero_entries();
    for(const Triangle& t : m_triangles) {
      Eigen::Vector3d edge[3];
      edges_of(t, V, edge);
      const std::optional<Point_coefficients> mean = mean_coefficients(m_op.coefficients, t.v);
      const Triangle_element element = triangle_element(edge, mean);
      if(element.is_degenerate())
        return false;
      const double area = density(mean) * element.twice_area / 2;
      for(int k = 0; k < 3; ++k) {
        const double lumped = (1 - m_op.theta) * lumped_share(m_op.voronoi, element.dot, k);
        entries.L(t.e[k]) -= 0.5 * element.dot[k] / element.twice_area;
        entries.B(t.e[k]) += m_op.theta * area / 12;
        entries.B_diagonal(t.v[k]) += area * (lumped + m_op.theta / 6);
        entries.mass(t.v[k]) += area * (lumped + m_op.theta / 3);
      }
    }
    return true;
  }

  /// Adds the gradient of a function of the matrices, given its derivatives with respect to their
  /// entries. The derivative for an edge covers both entries, and for L also the effect on the
  /// diagonal.
  void add_gradient(const Entries& d, const Positions& V, Positions& gradient) const
  {
    for(const Triangle& t : m_triangles) {
      Eigen::Vector3d edge[3];
      edges_of(t, V, edge);
      const std::optional<Point_coefficients> mean = mean_coefficients(m_op.coefficients, t.v);
      const Triangle_element element = triangle_element(edge, mean);
      // derivatives with respect to the weighted area and to the cotangents, of which half are in L
      double by_area = 0, by_cotangent[3], by_share[3];
      for(int k = 0; k < 3; ++k) {
        const double lumped = (1 - m_op.theta) * lumped_share(m_op.voronoi, element.dot, k);
        by_area += d.mass(t.v[k]) * (lumped + m_op.theta / 3) +
                   d.B_diagonal(t.v[k]) * (lumped + m_op.theta / 6) + d.B(t.e[k]) * m_op.theta / 12;
        by_cotangent[k] = -0.5 * d.L(t.e[k]);
        by_share[k] = d.mass(t.v[k]) + d.B_diagonal(t.v[k]);
      }
      if(m_op.voronoi)
        add_gradient_of_shares(element, by_share, density(mean) * element.twice_area / 2,
                               by_cotangent);
      if(mean)
        add_gradient_of_conductivity(t, edge, *mean, element, by_cotangent, density(mean) * by_area,
                                     gradient);
      else
        add_gradient_of_cotangents(t, edge, by_cotangent, by_area, gradient);
    }
  }

private:
  struct Triangle
  {
    int v[3];
    int e[3]; // edge k is opposite to corner k
  };

  int edge_of(const int i, const int j)
  {
    const bool shorter = m_rows[i].size() < m_rows[j].size(); // that of j may be a hub's
    for(const Entry& entry : m_rows[shorter ? i : j])
      if(entry.neighbour == (shorter ? j : i))
        return entry.edge;
    const int e = int(m_edges.size());
    m_edges.push_back({i, j});
    m_rows[i].push_back({j, e});
    m_rows[j].push_back({i, e});
    return e;
  }

  static void edges_of(const Triangle& t, const Positions& V, Eigen::Vector3d (&edge)[3])
  {
    for(int k = 0; k < 3; ++k)
      edge[k] = V.row(t.v[(k + 2) % 3]) - V.row(t.v[(k + 1) % 3]);
  }

  // share_k = (1 + c_i c_j / Q) / 4 with Q the sum of the three products, in a triangle that is not
  // obtuse.
  static void add_gradient_of_shares(const Triangle_element& element, const double (&by_share)[3],
                                     const double area, double (&by_cotangent)[3])
  {
    double c[3];
    for(int k = 0; k < 3; ++k)
      c[k] = element.dot[k] / element.twice_area;
    const double Q = c[0] * c[1] + c[1] * c[2] + c[2] * c[0];
    if(c[0] < 0 || c[1] < 0 || c[2] < 0 || !(Q > 0))
      return;
    for(int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const double factor = by_share[k] * area / (4 * Q), ratio = c[i] * c[j] / Q;
      by_cotangent[i] += factor * (c[j] - ratio * (c[j] + c[k]));
      by_cotangent[j] += factor * (c[i] - ratio * (c[k] + c[i]));
      by_cotangent[k] -= factor * ratio * (c[i] + c[j]);
    }
  }

  // With l_k the lengths, A the area: cot_k = (l_{k+1}^2 + l_{k+2}^2 - l_k^2) / (4 A).
  static void add_gradient_of_cotangents(const Triangle& t, const Eigen::Vector3d (&edge)[3],
                                         const double (&by_cotangent)[3], double by_area,
                                         Positions& gradient)
  {
    const Eigen::Vector3d normal = edge[0].cross(edge[1]);
    const double double_area = normal.norm(), area = double_area / 2;
    double quadratic = 0, by_squared_length[3];
    for(int k = 0; k < 3; ++k) {
      by_squared_length[k] =
          by_cotangent[(k + 1) % 3] + by_cotangent[(k + 2) % 3] - by_cotangent[k];
      quadratic += by_squared_length[k] * edge[k].squaredNorm();
      by_squared_length[k] /= 4 * area;
    }
    by_area -= quadratic / (4 * area * area);
    for(int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const Eigen::Vector3d change = (0.5 * by_area / double_area) * normal.cross(edge[k]) +
                                     2 * by_squared_length[i] * edge[i] -
                                     2 * by_squared_length[j] * edge[j];
      gradient.row(t.v[k]) += change.transpose();
    }
  }

  // Reverse mode: cot_k = -r_{k+1} . D r_{k+2} / |m| with m = e_0 x e_1, r_k = m / |m| x e_k.
  static void add_gradient_of_conductivity(const Triangle& t, const Eigen::Vector3d (&edge)[3],
                                           const Point_coefficients& mean,
                                           const Triangle_element& element,
                                           const double (&by_cotangent)[3], const double by_area,
                                           Positions& gradient)
  {
    const Eigen::Matrix3d D = conductivity(mean);
    const double length = element.twice_area;
    const Eigen::Vector3d normal = edge[0].cross(edge[1]).normalized();
    Eigen::Vector3d by_turned[3], turned[3], by_edge[3];
    for(int k = 0; k < 3; ++k) {
      turned[k] = normal.cross(edge[k]);
      by_turned[k].setZero();
    }
    double by_length = by_area / 2;
    for(int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      by_turned[i] -= by_cotangent[k] / length * (D * turned[j]);
      by_turned[j] -= by_cotangent[k] / length * (D * turned[i]);
      by_length -= by_cotangent[k] * element.dot[k] / (length * length);
    }
    Eigen::Vector3d by_normal = Eigen::Vector3d::Zero();
    for(int k = 0; k < 3; ++k) {
      by_edge[k] = by_turned[k].cross(normal);
      by_normal += edge[k].cross(by_turned[k]);
    }
    const Eigen::Vector3d by_cross =
        (by_normal - normal.dot(by_normal) * normal) / length + by_length * normal;
    by_edge[0] += edge[1].cross(by_cross);
    by_edge[1] += by_cross.cross(edge[0]);
    for(int k = 0; k < 3; ++k) {
      gradient.row(t.v[(k + 2) % 3]) += by_edge[k].transpose();
      gradient.row(t.v[(k + 1) % 3]) -= by_edge[k].transpose();
    }
  }

  Local_operator m_op;
  std::vector<char> m_border; // where functions vanish, or nothing
  std::vector<Triangle> m_triangles;
  std::vector<Edge> m_edges;
  std::vector<std::vector<Entry>> m_rows;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_OPERATOR_GEOMETRY_H
