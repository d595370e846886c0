// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_FLIP_GUARDS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_FLIP_GUARDS_H

#include <CGAL/Spectral_geometry/Edge_flip_options.h>
#include <CGAL/Spectral_geometry/internal/search/Box_tree.h>
#include <CGAL/Spectral_geometry/internal/flips/Flip_connectivity.h>
#include <CGAL/Spectral_geometry/internal/flips/Flip_energy.h>
#include <CGAL/Spectral_geometry/internal/search/triangles_intersect.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace CGAL::Spectral_geometry::internal {

/// What a flip may do to the shape. Angles and normals depend on its four vertices; sizes and intersections on the
/// rest of the mesh as well, and are asked for when its turn has come.
class Flip_guards
{
public:
  using Quad = Flip_connectivity::Quad;
  using Triangle = Flip_energy::Triangle;

  Flip_guards(const Eigen::MatrixXd& V, const Flip_connectivity& mesh, const Edge_flip_options& options)
    : m_V(V)
    , m_mesh(mesh)
    , m_angle_ratio(options.smallest_angle_ratio)
    , m_cosine((std::min)(std::cos(options.largest_turn), 1 - 1e-12)) // rounding is no turn
    , m_tolerance(options.size_tolerance)
  {
    const Eigen::MatrixXi& T = mesh.triangles();
    for(Eigen::Index f = 0; f < T.rows(); ++f) {
      m_area += 0.5 * normal({T(f, 0), T(f, 1), T(f, 2)}).norm();
      m_volume += Eigen::Vector3d(V.row(T(f, 0)) - V.row(0))
                      .dot(Eigen::Vector3d(V.row(T(f, 1)) - V.row(0))
                               .cross(Eigen::Vector3d(V.row(T(f, 2)) - V.row(0)))) /
                  6;
    }
    m_closed = !mesh.has_boundary();
    if(!options.keep_free_of_self_intersections)
      return;
    std::vector<Box_tree::Box> boxes;
    for(Eigen::Index f = 0; f < T.rows(); ++f)
      boxes.push_back(box_of(corners_of_face(V, T.row(f))));
    m_tree.build(boxes);
  }

  /// Angles and normals.
  bool keeps_shape(const Quad& q, const std::array<Triangle, 2>& before,
                   const std::array<Triangle, 2>& after) const
  {
    for(const Triangle& t : after)
      if(!(t.shape.area > 0) || !(t.shape.cot.cwiseAbs().maxCoeff() <= largest_cotangent))
        return false;
    if(smallest_angle(after) < m_angle_ratio * smallest_angle(before))
      return false;
    const Eigen::Vector3d old_normals[2] = {normal({q.c, q.i, q.j}), normal({q.d, q.j, q.i})};
    const Eigen::Vector3d new_normals[2] = {normal(after[0].corners), normal(after[1].corners)};
    for(const Eigen::Vector3d& m : new_normals)
      for(const Eigen::Vector3d& n : old_normals) // a triangle without area has no side
        if(!(m.dot(n) >= m_cosine * m.norm() * n.norm()))
          return false;
    return true;
  }

  bool keeps_size(const Quad& q, const std::array<Triangle, 2>& before,
                  const std::array<Triangle, 2>& after) const
  {
    return std::abs(m_area_change + area_change(before, after)) <= m_tolerance * m_area &&
           (!m_closed || std::abs(m_volume_change + volume_change(q)) <= m_tolerance * std::abs(m_volume));
  }

  bool stays_free(const Quad& q, const std::array<Triangle, 2>& after) const
  {
    if(m_tree.is_empty())
      return true;
    const Corners both[2] = {corners_of_face(m_V, after[0].corners), corners_of_face(m_V, after[1].corners)};
    for(const Corners& t : both) {
      const auto meets = [&](const std::size_t f) {
        return f != std::size_t(q.f) && f != std::size_t(q.g) &&
               triangles_intersect(t, corners_of_face(m_V, m_mesh.triangles().row(Eigen::Index(f))));
      };
      if(m_tree.any(box_of(t), meets))
        return false;
    }
    return !triangles_intersect(both[0], both[1]);
  }

  void update(const Quad& q, const std::array<Triangle, 2>& before, const std::array<Triangle, 2>& after)
  {
    m_area_change += area_change(before, after);
    m_volume_change += volume_change(q);
    if(!m_tree.is_empty()) {
      m_tree.update(std::size_t(q.f), box_of(corners_of_face(m_V, after[0].corners)));
      m_tree.update(std::size_t(q.g), box_of(corners_of_face(m_V, after[1].corners)));
    }
  }

private:
  Eigen::Vector3d normal(const std::array<int, 3>& t) const
  {
    const Eigen::Vector3d a = m_V.row(t[1]) - m_V.row(t[0]), b = m_V.row(t[2]) - m_V.row(t[0]);
    return a.cross(b);
  }

  static double smallest_angle(const std::array<Triangle, 2>& both)
  {
    const auto of = [](const Triangle& t) {
      return t.shape.area > 0 ? std::atan2(1., t.shape.cot.maxCoeff()) : 0;
    };
    return (std::min)(of(both[0]), of(both[1]));
  }

  static double area_change(const std::array<Triangle, 2>& before, const std::array<Triangle, 2>& after)
  {
    return after[0].shape.area + after[1].shape.area - before[0].shape.area - before[1].shape.area;
  }

  // The tetrahedron between the old triangles (c,i,j), (d,j,i) and the new ones (c,i,d), (d,j,c).
  double volume_change(const Quad& q) const
  {
    const Eigen::Vector3d c = m_V.row(q.c), i = m_V.row(q.i), j = m_V.row(q.j), d = m_V.row(q.d);
    return (i - c).cross(d - c).dot(j - c) / -6;
  }

  const Eigen::MatrixXd& m_V;
  const Flip_connectivity& m_mesh;
  double m_angle_ratio, m_cosine, m_tolerance;
  double m_area = 0, m_volume = 0, m_area_change = 0, m_volume_change = 0;
  bool m_closed;
  Box_tree m_tree; // of the faces; empty: nobody asks
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_FLIP_GUARDS_H
