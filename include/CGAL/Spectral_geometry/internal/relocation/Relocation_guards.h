// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_RELOCATION_GUARDS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_RELOCATION_GUARDS_H

#include <CGAL/Spectral_geometry/Relocation_options.h>
#include <CGAL/Spectral_geometry/internal/numerics/for_each_task.h>
#include <CGAL/Spectral_geometry/internal/surface/Border_polyline.h>
#include <CGAL/Spectral_geometry/internal/surface/Triangle_element.h>

namespace CGAL::Spectral_geometry::internal {

/// A piece of the boundary that a vertex may slide along.
struct Boundary_segment
{
  Eigen::Vector3d a, b;

  Eigen::Vector3d closest(const Eigen::Vector3d& p) const
  {
    const Eigen::Vector3d ab = b - a;
    const double length2 = ab.squaredNorm();
    const double s = length2 > 0 ? std::clamp(ab.dot(p - a) / length2, 0., 1.) : 0.;
    return a + s * ab;
  }
};

/// What single vertices and triangles may do while vertices are relocated. Legal at the start;
/// afterwards `admit()` cuts the steps of the vertices that would break something, and of no
/// others.
class Relocation_guards
{
  using Held = Relocation_result::Held;

public:
  using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

  /// Triangles are compared with what they are at `given`; vertices start at `V`.
  Relocation_guards(const Positions& given, const Positions& V, const Eigen::MatrixXi& T,
                    const Positions& anchors, const Relocation_limits& limits, const int threads)
    : m_T(T)
    // Rounding must not make a start illegal that is only just legal; likewise below.
    , m_largest_turn_cosine((std::min)(std::cos(limits.largest_turn), 1 - 1e-12))
    , m_anchors(anchors)
    , m_fixed(std::size_t(V.rows()), false)
    , m_boundary(std::size_t(V.rows()))
    , m_held_by(std::size_t(V.rows()))
    , m_radius(V.rows())
    , m_smallest_angle(T.rows())
    , m_threads(threads)
    , m_normal(std::size_t(T.rows()))
  {
    Eigen::VectorXd length = Eigen::VectorXd::Zero(V.rows()),
                    count = Eigen::VectorXd::Zero(V.rows());
    for(Eigen::Index f = 0; f < m_T.rows(); ++f)
      for(int k = 0; k < 3; ++k) {
        const int i = m_T(f, k), j = m_T(f, (k + 1) % 3);
        const double l = (V.row(i) - V.row(j)).norm();
        for(const int v : {i, j}) {
          length(v) += l;
          count(v) += 1;
        }
      }
    for(Eigen::Index v = 0; v < V.rows(); ++v)
      m_radius(v) = (std::max)(limits.trust_radius * length(v) / (std::max)(count(v), 1.),
                               (V.row(v) - m_anchors.row(v)).norm());
    for(Eigen::Index f = 0; f < m_T.rows(); ++f) {
      m_normal[f] = face_normal(given, m_T, f).normalized();
      m_smallest_angle(f) = (limits.smallest_angle_ratio - 1e-9) * smallest_angle(f, given);
    }
  }

  void fix(const Eigen::Index v) { m_fixed[v] = true; }
  bool is_fixed(const Eigen::Index v) const { return m_fixed[v]; }

  /// Lets a vertex move along those pieces of a border only that are allowed. Far ones are dropped.
  template <class Allowed_piece>
  void keep_on(const Eigen::Index v, const Border_polyline& border, const Allowed_piece& allowed)
  {
    const Eigen::Vector3d anchor = m_anchors.row(v);
    for(const std::size_t s : border.near(anchor, 2 * m_radius(v))) {
      const Boundary_segment piece{border.end(s, 0), border.end(s, 1)};
      if(allowed(s) && (piece.closest(anchor) - anchor).norm() <= 2 * m_radius(v))
        m_boundary[v].push_back(piece);
    }
    if(!is_on_boundary(v))
      fix(v);
  }

  bool is_on_boundary(const Eigen::Index v) const { return !m_boundary[v].empty(); }

  /// A condition on a step of a vertex, from and to: one that leaps to another sheet of a surface
  /// is cut.
  using Leaps = std::function<bool(Eigen::Index, const Eigen::Vector3d&, const Eigen::Vector3d&)>;
  void set_leaps(Leaps leaps) { m_leaps = std::move(leaps); }

  /// How many vertices each guard has held since the start.
  Held held() const
  {
    Held sum;
    sum.fixed = std::size_t(std::count(m_fixed.begin(), m_fixed.end(), true));
    for(const Held& by : m_held_by) {
      sum.trust += by.trust;
      sum.boundary += by.boundary;
      sum.sheet += by.sheet;
      sum.triangles += by.triangles;
    }
    return sum;
  }

  void tangential(const Positions& at, Positions& direction) const
  {
    for(Eigen::Index v = 0; v < at.rows(); ++v)
      if(m_fixed[v])
        direction.row(v).setZero();
      else if(is_on_boundary(v)) {
        const Boundary_segment& s = closest_segment(v, at.row(v));
        const Eigen::Vector3d t = (s.b - s.a).normalized();
        direction.row(v) = (t.dot(direction.row(v)) * t).transpose();
      }
  }

  void admit(const Positions& from, Positions& to) const
  {
    const auto admit_vertex = [&](const Eigen::Index v) {
      to.row(v) = nearest_allowed(v, from.row(v), to.row(v)).transpose();
      if(m_leaps && to.row(v) != from.row(v))
        stay_on_sheet(v, from, to);
    };
    for_each_task(to.rows(), m_threads, admit_vertex, 16);
    admit_without_projection(from, to);
  }

  /// As admit(), if the position of every single vertex is known to be allowed.
  void admit_without_projection(const Positions& from, Positions& to) const
  {
    std::vector<char> offends(std::size_t(to.rows()), 0);
    for(int round = 0; mark_offenders(to, offends); ++round)
      for(Eigen::Index v = 0; v < to.rows(); ++v)
        if(offends[v]) {
          offends[v] = 0;
          m_held_by[v].triangles = 1;
          if(round >= 4)
            to.row(v) = from.row(v);
          else
            to.row(v) =
                nearest_allowed(v, from.row(v), 0.5 * (from.row(v) + to.row(v))).transpose();
        }
  }

  /// true if the triangle keeps its side and its angles.
  bool legal(const Eigen::Index f, const Positions& V) const
  {
    const Eigen::Vector3d normal = face_normal(V, m_T, f);
    if(!(normal.dot(m_normal[f]) >= m_largest_turn_cosine * normal.norm()))
      return false;
    return smallest_angle(f, V) >= m_smallest_angle(f);
  }

private:
  // A step that leaps is taken in part, or not at all.
  void stay_on_sheet(const Eigen::Index v, const Positions& from, Positions& to) const
  {
    for(int cut = 0; m_leaps(v, from.row(v), to.row(v)); ++cut) {
      m_held_by[v].sheet = 1;
      if(cut == 3) {
        to.row(v) = from.row(v);
        return;
      }
      to.row(v) = (0.6 * from.row(v) + 0.4 * to.row(v)).eval();
      if(is_on_boundary(v))
        to.row(v) = nearest_allowed(v, from.row(v), to.row(v)).transpose();
    }
  }

  double smallest_angle(const Eigen::Index f, const Positions& V) const
  {
    Eigen::Vector3d edge[3];
    for(int k = 0; k < 3; ++k)
      edge[k] = V.row(m_T(f, (k + 2) % 3)) - V.row(m_T(f, (k + 1) % 3));
    const Triangle_element t = triangle_element(edge);
    return t.is_degenerate() ? 0 : std::atan2(t.twice_area, *std::max_element(t.dot, t.dot + 3));
  }

  const Boundary_segment& closest_segment(const Eigen::Index v, const Eigen::Vector3d& p) const
  {
    const std::vector<Boundary_segment>& segments = m_boundary[v];
    return *std::min_element(segments.begin(), segments.end(), [&](const auto& s, const auto& t) {
      return (s.closest(p) - p).squaredNorm() < (t.closest(p) - p).squaredNorm();
    });
  }

  Eigen::Vector3d nearest_allowed(const Eigen::Index v, const Eigen::Vector3d& from,
                                  Eigen::Vector3d to) const
  {
    if(m_fixed[v] || !to.allFinite())
      return from;
    const Eigen::Vector3d anchor = m_anchors.row(v);
    const double distance = (to - anchor).norm();
    Held& held = m_held_by[v];
    if(distance > m_radius(v)) {
      held.trust = 1;
      to = anchor + m_radius(v) / distance * (to - anchor);
    }
    if(is_on_boundary(v)) {
      to = closest_segment(v, to).closest(to);
      if((to - anchor).norm() > 1.01 * m_radius(v)) {
        held.boundary = 1;
        return from;
      }
    }
    return to;
  }

  bool mark_offenders(const Positions& V, std::vector<char>& offends) const
  {
    bool any = false;
    for(Eigen::Index f = 0; f < m_T.rows(); ++f)
      if(!legal(f, V)) {
        any = true;
        for(int k = 0; k < 3; ++k)
          offends[m_T(f, k)] = 1;
      }
    return any;
  }

  Eigen::MatrixXi m_T;
  double m_largest_turn_cosine;
  Positions m_anchors;
  std::vector<bool> m_fixed;
  std::vector<std::vector<Boundary_segment>> m_boundary;
  Leaps m_leaps;
  mutable std::vector<Held> m_held_by; // of each vertex, 1 for every guard that has ever held it
  Eigen::VectorXd m_radius, m_smallest_angle; // of each vertex; of each triangle, what is allowed
  int m_threads;
  std::vector<Eigen::Vector3d> m_normal;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_RELOCATION_GUARDS_H
