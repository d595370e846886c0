// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_FLIP_ENERGY_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_FLIP_ENERGY_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/flips/Flip_connectivity.h>
#include <CGAL/Spectral_geometry/internal/operators/Triangle_element.h>
#include <CGAL/Spectral_geometry/internal/operators/connectivity.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace CGAL::Spectral_geometry::internal {

/// E_w of each vertex, and what four of them become when an edge is flipped. Every row is summed anew from its triangles:
/// nothing drifts.
class Flip_energy
{
public:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// One triangle in space, and with what L and B need of it, weighted by the coefficients.
  struct Triangle
  {
    std::array<int, 3> corners;
    Triangle_cotangents shape, weighted;
  };

  /// The faces f and g, and what would be in their places after the flip.
  struct Flip : Flip_connectivity::Quad
  {
    std::array<Triangle, 2> before, after;
  };

  /// F and Z: the restricted signals, one row for each vertex; `op` has coefficients for the vertices, or none.
  Flip_energy(const Eigen::MatrixXd& V, const Flip_connectivity& mesh, Rows F, Rows Z,
              const Local_operator& op)
    : m_mesh(mesh)
    , m_V(V)
    , m_F(std::move(F))
    , m_Z(std::move(Z))
    , m_op(op)
    , m_E(V.rows())
    , m_R(m_F.cols())
  {
    const Eigen::MatrixXi& T = mesh.triangles();
    if(op.boundary == Boundary_condition::dirichlet)
      m_border = border_vertices(T, V.rows());
    for(Eigen::Index f = 0; f < T.rows(); ++f)
      m_triangles.push_back(triangle({T(f, 0), T(f, 1), T(f, 2)}));
    for(int v = 0; v < int(V.rows()); ++v)
      m_E(v) = term(v);
  }

  /// E.
  double value() const { return m_E.sum(); }

  Flip flip(const Flip_connectivity::Quad& q) const
  {
    return {q,
            {m_triangles[std::size_t(q.f)], m_triangles[std::size_t(q.g)]},
            {triangle({q.c, q.i, q.d}), triangle({q.d, q.j, q.c})}};
  }

  /// E after the flip less E before; infinity if a vertex would have no mass.
  double cost(const Flip& flip)
  {
    double change = 0;
    for(const int v : flip.vertices())
      change += term(v, &flip) - m_E(v);
    return change;
  }

  /// After `Flip_connectivity::flip()`.
  void update(const Flip& done)
  {
    m_triangles[std::size_t(done.f)] = done.after[0];
    m_triangles[std::size_t(done.g)] = done.after[1];
    for(const int v : done.vertices())
      m_E(v) = term(v);
  }

private:
  Triangle triangle(const std::array<int, 3>& corners) const
  {
    const int t[3] = {corners[0], corners[1], corners[2]};
    return {corners, local_cotangents(m_V, t, {}), local_cotangents(m_V, t, m_op.coefficients)};
  }

  // E_w as it is, or after a flip.
  double term(const int w, const Flip* flip = nullptr)
  {
    if(!m_border.empty() && m_border[std::size_t(w)] != 0)
      return 0;
    m_R.setZero();
    double mass = 0;
    for(const int f : m_mesh.faces_of(w))
      if(!flip || (f != flip->f && f != flip->g))
        add(w, m_triangles[std::size_t(f)], mass);
    if(flip)
      for(const Triangle& t : flip->after)
        add(w, t, mass);
    return mass > 0 ? m_R.squaredNorm() / mass : std::numeric_limits<double>::infinity();
  }

  // The triangle's part of R_w = (B Z)_w - sum_j L_wj (F_j - F_w) and of M_w; none if w is not a corner.
  void add(const int w, const Triangle& t, double& mass)
  {
    for(int k = 0; k < 3; ++k) {
      if(t.corners[std::size_t(k)] != w)
        continue;
      const int x = (k + 1) % 3, y = (k + 2) % 3;
      const int a = t.corners[std::size_t(x)], b = t.corners[std::size_t(y)];
      const double area = t.weighted.area, theta = m_op.theta,
                   share = lumped_share(m_op.voronoi, t.weighted.cot, k),
                   on = ((1 - theta) * share + theta / 6) * area, off = theta / 12 * area;
      m_R += on * m_Z.row(w) + off * (m_Z.row(a) + m_Z.row(b)) +
             0.5 * t.weighted.cot(y) * (m_F.row(a) - m_F.row(w)) +
             0.5 * t.weighted.cot(x) * (m_F.row(b) - m_F.row(w));
      mass += ((1 - theta) * share + theta / 3) * area;
    }
  }

  const Flip_connectivity& m_mesh;
  const Eigen::MatrixXd& m_V;
  Rows m_F, m_Z;
  Local_operator m_op;
  std::vector<char> m_border;        // where functions vanish, or nothing
  std::vector<Triangle> m_triangles; // by face
  Eigen::VectorXd m_E;
  Eigen::RowVectorXd m_R;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_FLIP_ENERGY_H
