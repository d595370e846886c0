// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_FLIP_GUARDS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_FLIP_GUARDS_H

#include <CGAL/Spectral_geometry/Edge_flip_options.h>
#include <CGAL/Spectral_geometry/internal/search/Box_tree.h>
#include <CGAL/Spectral_geometry/internal/flips/Flip_connectivity.h>
#include <CGAL/Spectral_geometry/internal/flips/Flip_energy.h>
#include <CGAL/Spectral_geometry/internal/operators/connectivity.h>
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
  using Flip = Flip_energy::Flip;
  using Triangle = Flip_energy::Triangle;

  Flip_guards(const Eigen::MatrixXd& V, const Flip_connectivity& mesh, const Edge_flip_options& options)
    : m_V(V)
    , m_mesh(mesh)
    , m_angle_ratio(options.smallest_angle_ratio)
    , m_cosine((std::min)(std::cos(options.largest_turn), 1 - 1e-12)) // rounding is no turn
    , m_tolerance(options.size_tolerance)
    , m_closed(boundary_edges(mesh.triangles()).empty())
  {
    const Eigen::MatrixXi& T = mesh.triangles();
    for(Eigen::Index f = 0; f < T.rows(); ++f) {
      m_area += 0.5 * normal({T(f, 0), T(f, 1), T(f, 2)}).norm();
      m_volume += Eigen::Vector3d(V.row(T(f, 0)) - V.row(0))
                      .dot(Eigen::Vector3d(V.row(T(f, 1)) - V.row(0))
                               .cross(Eigen::Vector3d(V.row(T(f, 2)) - V.row(0)))) /
                  6;
    }
    if(!options.keep_free_of_self_intersections)
      return;
    std::vector<Box_tree::Box> boxes;
    for(Eigen::Index f = 0; f < T.rows(); ++f)
      boxes.push_back(box_of(corners_of_face(V, T.row(f))));
    m_tree.build(boxes);
  }

  /// Angles and normals.
  bool keeps_shape(const Flip& flip) const
  {
    for(const Triangle& t : flip.after)
      if(!(t.shape.area > 0) || !(t.shape.cot.cwiseAbs().maxCoeff() <= largest_cotangent))
        return false;
    if(smallest_angle(flip.after) < m_angle_ratio * smallest_angle(flip.before))
      return false;
    const Eigen::Vector3d old_normals[2] = {normal({flip.c, flip.i, flip.j}),
                                            normal({flip.d, flip.j, flip.i})};
    const Eigen::Vector3d new_normals[2] = {normal(flip.after[0].corners), normal(flip.after[1].corners)};
    for(const Eigen::Vector3d& m : new_normals)
      for(const Eigen::Vector3d& n : old_normals) // a triangle without area has no side
        if(!(m.dot(n) >= m_cosine * m.norm() * n.norm()))
          return false;
    return true;
  }

  bool keeps_size(const Flip& flip) const
  {
    return std::abs(m_area_change + area_change(flip)) <= m_tolerance * m_area &&
           (!m_closed || std::abs(m_volume_change + volume_change(flip)) <= m_tolerance * std::abs(m_volume));
  }

  bool stays_free(const Flip& flip) const
  {
    if(m_tree.is_empty())
      return true;
    const Corners both[2] = {corners_of_face(m_V, flip.after[0].corners),
                             corners_of_face(m_V, flip.after[1].corners)};
    for(const Corners& t : both) {
      const auto meets = [&](const std::size_t f) {
        return f != std::size_t(flip.f) && f != std::size_t(flip.g) &&
               triangles_intersect(t, corners_of_face(m_V, m_mesh.triangles().row(Eigen::Index(f))));
      };
      if(m_tree.any(box_of(t), meets))
        return false;
    }
    return !triangles_intersect(both[0], both[1]);
  }

  void update(const Flip& flip)
  {
    m_area_change += area_change(flip);
    m_volume_change += volume_change(flip);
    if(!m_tree.is_empty()) {
      m_tree.update(std::size_t(flip.f), box_of(corners_of_face(m_V, flip.after[0].corners)));
      m_tree.update(std::size_t(flip.g), box_of(corners_of_face(m_V, flip.after[1].corners)));
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

  static double area_change(const Flip& flip)
  {
    return flip.after[0].shape.area + flip.after[1].shape.area - flip.before[0].shape.area -
           flip.before[1].shape.area;
  }

  // The tetrahedron between the old triangles (c,i,j), (d,j,i) and the new ones (c,i,d), (d,j,c).
  double volume_change(const Flip& flip) const
  {
    const Eigen::Vector3d c = m_V.row(flip.c), i = m_V.row(flip.i), j = m_V.row(flip.j), d = m_V.row(flip.d);
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
