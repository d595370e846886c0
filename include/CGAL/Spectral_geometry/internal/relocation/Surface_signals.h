// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_SURFACE_SIGNALS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_SURFACE_SIGNALS_H

#include <CGAL/Spectral_geometry/internal/numerics/Thread_pool.h>
#include <CGAL/Spectral_geometry/internal/surface/Surface_regions.h>
#include <CGAL/Spectral_geometry/relocation_energy.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL::Spectral_geometry::internal {

/// Signals of the fine mesh, read off at the closest points of the coarse vertices.
class Surface_signals : public Position_dependent_signals
{
public:
  /// F and Z: fine x K. The first two, of the fine surface, are kept by reference.
  Surface_signals(const Mesh_matrices& fine, Followed_closest_points& closest, Rows F, Rows Z,
                  const int threads)
    : m_fine(fine)
    , m_closest(closest)
    , m_F(std::move(F))
    , m_Z(std::move(Z))
    , m_threads(threads)
  {}

  void evaluate(const Positions& V, Rows& F, Rows& Z) override
  {
    F.resize(V.rows(), m_F.cols());
    Z.resize(V.rows(), m_F.cols());
    m_answers.resize(std::size_t(V.rows()));
    const auto read_off = [&](const Eigen::Index w) {
      Closest_point_query::Answer& a = m_answers[std::size_t(w)];
      a = m_closest(w, V.row(w));
      const Eigen::RowVector3i t = m_fine.T.row(a.face);
      F.row(w) = a.weights(0) * m_F.row(t(0)) + a.weights(1) * m_F.row(t(1)) +
                 a.weights(2) * m_F.row(t(2));
      Z.row(w) = a.weights(0) * m_Z.row(t(0)) + a.weights(1) * m_Z.row(t(1)) +
                 a.weights(2) * m_Z.row(t(2));
    };
    for_each_task(V.rows(), m_threads, read_off, 16);
  }

  // The signals are linear in the face. A closest point on an edge stays on it for a while, one in
  // a corner does not move at all.
  void add_gradient(const Rows& by_F, const Rows& by_Z, Positions& gradient) const override
  {
    const auto add = [&](const Eigen::Index w) {
      const Closest_point_query::Answer& a = m_answers[std::size_t(w)];
      const Eigen::RowVector3i t = m_fine.T.row(a.face);
      Eigen::Matrix3d p;
      for(int k = 0; k < 3; ++k)
        p.col(k) = m_fine.V.row(t(k));
      const Eigen::Vector3d normal = (p.col(1) - p.col(0)).cross(p.col(2) - p.col(0));
      const double size2 = normal.squaredNorm();
      int zeros = 0, zero = 0;
      for(int k = 0; k < 3; ++k)
        if(!(a.weights(k) > 0)) {
          ++zeros;
          zero = k;
        }
      if(zeros == 2 || !(size2 > 0))
        return;
      Eigen::Vector3d g = Eigen::Vector3d::Zero();
      for(int k = 0; k < 3; ++k) {
        const double slope = by_F.row(w).dot(m_F.row(t(k))) + by_Z.row(w).dot(m_Z.row(t(k)));
        g += slope / size2 * normal.cross(p.col((k + 2) % 3) - p.col((k + 1) % 3));
      }
      if(zeros == 1) {
        const Eigen::Vector3d edge = (p.col((zero + 2) % 3) - p.col((zero + 1) % 3)).normalized();
        g = edge.dot(g) * edge;
      }
      gradient.row(w) += g.transpose();
    };
    for_each_task(gradient.rows(), m_threads, add, 16);
  }

private:
  const Mesh_matrices& m_fine;
  Followed_closest_points& m_closest;
  Rows m_F, m_Z;
  int m_threads;
  std::vector<Closest_point_query::Answer> m_answers;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_SURFACE_SIGNALS_H
