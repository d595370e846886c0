// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_OPERATOR_GEOMETRY_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_OPERATOR_GEOMETRY_H

#include <CGAL/Spectral_geometry/internal/Triangle_element.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// Stiffness and mass of a mesh as functions of its positions, edge by edge, and the way back from derivatives
/// with respect to their entries to derivatives with respect to positions.
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
  /// Off the diagonal there is one number for each edge. The diagonal of L is minus the sum of its row.
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

  Operator_geometry(const Eigen::MatrixXi& T, const Index n, const double theta)
    : m_theta(theta)
  {
    check(T, n);
    m_rows.assign(std::size_t(n), {});
    m_triangles.reserve(std::size_t(T.rows()));
    for(Index f = 0; f < T.rows(); ++f) {
      Triangle t;
      for(int k = 0; k < 3; ++k)
        t.v[k] = T(f, k);
      for(int k = 0; k < 3; ++k)
        t.e[k] = edge_of(t.v[(k + 1) % 3], t.v[(k + 2) % 3]);
      m_triangles.push_back(t);
    }
  }

  Index number_of_vertices() const { return Index(m_rows.size()); }
  const std::vector<Edge>& edges() const { return m_edges; }
  const std::vector<Entry>& row(const Index w) const { return m_rows[std::size_t(w)]; }
  double theta() const { return m_theta; }

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
      const Triangle_element element = triangle_element(edge);
      if(element.is_degenerate())
        return false;
      const double area = element.twice_area / 2;
      for(int k = 0; k < 3; ++k) {
        entries.L(t.e[k]) -= 0.5 * element.dot[k] / element.twice_area;
        entries.B(t.e[k]) += m_theta * area / 12;
        entries.B_diagonal(t.v[k]) += area * ((1 - m_theta) / 3 + m_theta / 6);
        entries.mass(t.v[k]) += area / 3;
      }
    }
    return true;
  }

  /// Adds the gradient of a function of the matrices, whose derivatives with respect to their entries are given. That
  /// for an edge counts both entries, and for L what it does to the diagonal.
  void add_gradient(const Entries& d, const Positions& V, Positions& gradient) const
  {
    for(const Triangle& t : m_triangles)
      add_gradient(t, d, V, gradient);
  }

private:
  struct Triangle
  {
    int v[3];
    int e[3]; // edge k is opposite to corner k
  };

  void check(const Eigen::MatrixXi& T, const Index n) const
  {
    const std::string who = "relocation: ";
    if(!(m_theta >= 0 && m_theta <= 1))
      throw std::invalid_argument(who + "theta must lie in [0, 1], but is " + std::to_string(m_theta) + ".");
    if(T.cols() != 3)
      throw std::invalid_argument(who + "T has " + std::to_string(T.cols()) +
                                  " columns; pass a matrix of three.");
    for(Index f = 0; f < T.rows(); ++f)
      for(int k = 0; k < 3; ++k)
        if(T(f, k) < 0 || T(f, k) >= n || T(f, k) == T(f, (k + 1) % 3))
          throw std::invalid_argument(who + "triangle " + std::to_string(f) + " refers to vertex " +
                                      std::to_string(T(f, k)) +
                                      ", which does not exist or occurs twice; repair the indices.");
  }

  int edge_of(const int i, const int j)
  {
    for(const Entry& entry : m_rows[std::size_t(i)])
      if(entry.neighbour == j)
        return entry.edge;
    const int e = int(m_edges.size());
    m_edges.push_back({i, j});
    m_rows[std::size_t(i)].push_back({j, e});
    m_rows[std::size_t(j)].push_back({i, e});
    return e;
  }

  static void edges_of(const Triangle& t, const Positions& V, Eigen::Vector3d (&edge)[3])
  {
    for(int k = 0; k < 3; ++k)
      edge[k] = V.row(t.v[(k + 2) % 3]) - V.row(t.v[(k + 1) % 3]);
  }

  // With l_k the lengths, A the area: cot_k = (l_{k+1}^2 + l_{k+2}^2 - l_k^2) / (4 A).
  void add_gradient(const Triangle& t, const Entries& d, const Positions& V, Positions& gradient) const
  {
    Eigen::Vector3d edge[3];
    edges_of(t, V, edge);
    const Eigen::Vector3d normal = edge[0].cross(edge[1]);
    const double double_area = normal.norm(), area = double_area / 2;

    double by_area = 0, by_cotangent[3];
    for(int k = 0; k < 3; ++k) {
      by_area += d.mass(t.v[k]) / 3 + d.B_diagonal(t.v[k]) * ((1 - m_theta) / 3 + m_theta / 6) +
                 d.B(t.e[k]) * m_theta / 12;
      by_cotangent[k] = -0.5 * d.L(t.e[k]);
    }
    double quadratic = 0, by_squared_length[3];
    for(int k = 0; k < 3; ++k) {
      by_squared_length[k] = by_cotangent[(k + 1) % 3] + by_cotangent[(k + 2) % 3] - by_cotangent[k];
      quadratic += by_squared_length[k] * edge[k].squaredNorm();
      by_squared_length[k] /= 4 * area;
    }
    by_area -= quadratic / (4 * area * area);
    for(int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const Eigen::Vector3d change = (0.5 * by_area / double_area) * normal.cross(edge[k]) +
                                     2 * by_squared_length[i] * edge[i] - 2 * by_squared_length[j] * edge[j];
      gradient.row(t.v[k]) += change.transpose();
    }
  }

  double m_theta;
  std::vector<Triangle> m_triangles;
  std::vector<Edge> m_edges;
  std::vector<std::vector<Entry>> m_rows;
};

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_OPERATOR_GEOMETRY_H
