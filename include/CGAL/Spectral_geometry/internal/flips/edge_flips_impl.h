// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_EDGE_FLIPS_IMPL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_EDGE_FLIPS_IMPL_H

#include <CGAL/Spectral_geometry/Cancelled.h>
#include <CGAL/Spectral_geometry/edge_flips.h>
#include <CGAL/Spectral_geometry/internal/flips/Flip_connectivity.h>
#include <CGAL/Spectral_geometry/internal/flips/Flip_energy.h>
#include <CGAL/Spectral_geometry/internal/flips/Flip_guards.h>
#include <CGAL/Spectral_geometry/internal/require.h>

#include <CGAL/Real_timer.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <queue>
#include <set>

namespace CGAL::Spectral_geometry {
namespace internal {

/// One run of flips: the queue, and the order in which criterion and guards are asked.
class Edge_flipper
{
public:
  using Flip = Flip_energy::Flip;
  using Triangle = Flip_energy::Triangle;

  /// F and Z: the restricted signals.
  Edge_flipper(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const Flip_energy::Rows& F,
               const Flip_energy::Rows& Z, const Local_operator& op,
               const std::vector<std::pair<int, int>>& constrained, const Edge_flip_options& options)
    : m_options(options)
    , m_mesh(T, V.rows())
    , m_energy(V, m_mesh, F, Z, op)
    , m_guards(V, m_mesh, options)
    , m_smallest_gain(is_delaunay() ? 1e-9 : 1e-10 * m_energy.value())
    , m_version(std::size_t(m_mesh.number_of_edges()), 0)
    , m_stays(std::size_t(m_mesh.number_of_edges()), false)
  {
    m_timer.start();
    std::set<std::pair<int, int>> pairs;
    for(const auto& [v, w] : constrained)
      pairs.insert(std::minmax(v, w));
    for(int e = 0; e < m_mesh.number_of_edges(); ++e) {
      const auto [v, w] = m_mesh.ends(e);
      m_stays[std::size_t(e)] = m_mesh.is_on_boundary(e) || pairs.count(std::minmax(v, w)) != 0;
    }
  }

  Eigen::MatrixXi run(Edge_flip_result& result)
  {
    result.E_before = result.E_after = m_energy.value();
    if(m_options.criterion == Edge_flips::none)
      return m_mesh.triangles();
    require(std::isfinite(result.E_before), "edge flips: a vertex of the coarse mesh has no mass because no "
                                            "face of positive area uses it; remove it.");
    for(int e = 0; e < m_mesh.number_of_edges(); ++e)
      push(e);
    const std::size_t budget =
        m_options.maximum_flips != 0 ? m_options.maximum_flips : 4 * std::size_t(m_mesh.number_of_edges());
    while(!m_queue.empty() && result.flips.size() < budget && m_timer.time() < m_options.maximum_seconds) {
      const Candidate candidate = m_queue.top();
      m_queue.pop();
      if(candidate.version != m_version[std::size_t(candidate.edge)])
        continue;
      if(m_options.progress && !m_options.progress(double(result.flips.size()) / double(budget)))
        throw Cancelled();
      flip(candidate, result);
    }
    result.E_after = m_energy.value();
    result.seconds = m_timer.time();
    return m_mesh.triangles();
  }

private:
  // The lowest key is done first. Where keys are equal the edge decides, so that a run can be repeated.
  struct Candidate
  {
    double key;
    int edge, version;

    bool operator<(const Candidate& other) const
    {
      return key != other.key ? key > other.key : edge > other.edge;
    }
  };

  bool is_delaunay() const { return m_options.criterion == Edge_flips::delaunay; }

  // Puts the edge into the queue if its flip is wanted and legal.
  void push(const int e)
  {
    const int version = ++m_version[std::size_t(e)];
    if(m_stays[std::size_t(e)])
      return;
    const Flip_connectivity::Quad q = m_mesh.quad(e);
    if(m_mesh.are_adjacent(q.c, q.d))
      return;
    const Flip flip = m_energy.flip(q);
    if(!m_guards.keeps_shape(flip))
      return;
    const double key = is_delaunay() ? cotangent_at(flip.before[0], q.c) + cotangent_at(flip.before[1], q.d)
                                     : m_energy.cost(flip);
    if(key < -m_smallest_gain)
      m_queue.push({key, e, version});
  }

  void flip(const Candidate& candidate, Edge_flip_result& result)
  {
    const Flip flip = m_energy.flip(m_mesh.quad(candidate.edge));
    if(!m_guards.keeps_size(flip)) {
      ++result.refused_for_size;
      return;
    }
    if(!m_guards.stays_free(flip)) {
      ++result.refused_for_intersections;
      return;
    }
    result.flips.push_back({{flip.i, flip.j}, {flip.c, flip.d}, m_energy.cost(flip)});
    m_mesh.flip(candidate.edge);
    m_energy.update(flip);
    m_guards.update(flip);
    for(const int e : m_mesh.edges_around(flip.vertices()))
      push(e);
  }

  static double cotangent_at(const Triangle& t, const int v)
  {
    return t.shape.cot(std::find(t.corners.begin(), t.corners.end(), v) - t.corners.begin());
  }

  Real_timer m_timer;
  const Edge_flip_options& m_options;
  Flip_connectivity m_mesh;
  Flip_energy m_energy;
  Flip_guards m_guards;
  double m_smallest_gain; // less is rounding; cospherical vertices have two Delaunay edges
  std::vector<int> m_version;
  std::vector<bool> m_stays;
  std::priority_queue<Candidate> m_queue;
};

} // namespace internal

CGAL_SPECTRAL_GEOMETRY_INLINE Edge_flip_result flip_edges(const Eigen::MatrixXd& V, Eigen::MatrixXi& T,
                                                          const Eigen::SparseMatrix<double>& P,
                                                          const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z,
                                                          const Local_operator& op,
                                                          const std::vector<std::pair<int, int>>& constrained,
                                                          const Edge_flip_options& options)
{
  internal::check_positions(V);
  internal::check_triangles(T, V.rows());
  internal::require(P.rows() == V.rows(), "edge flips: P is ", internal::size_name(P), " and the mesh has ",
                    V.rows(), " vertices; pass a P of coarse x fine.");
  internal::require_signals("edge flips: ", F, Z, P.cols());
  internal::check_local_operator(op, V.rows());
  internal::check_edge_flip_options(options);
  Edge_flip_result result;
  internal::Edge_flipper flipper(V, T, P * F, P * Z, op, constrained, options);
  T = flipper.run(result);
  return result;
}

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_EDGE_FLIPS_IMPL_H
