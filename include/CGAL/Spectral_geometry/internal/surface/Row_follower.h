// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_ROW_FOLLOWER_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_ROW_FOLLOWER_H

#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Spectral_geometry/internal/surface/closest_point_search.h>

#include <queue>

namespace CGAL::Spectral_geometry::internal {

/// Rows of P that were followed on the surface.
struct Followed_rows
{
  /// with the rows replaced that read functions off another part
  Eigen::SparseMatrix<double> P;
  /// rows whose foot cannot be reached from the feet of their neighbours
  std::vector<Eigen::Index> off;
};

/*!
Finds the rows of P, of whatever origin, that read functions off another part of the body. A coarse
edge is torn where the feet of its ends, P V, lie further apart on the fine surface than three times
what their distance in space accounts for. Normals tell which end is wrong, and how far wrong rows
reach into an armpit, where no edge is torn: sheets that face each other have opposite ones.

So the ends of torn edges are in doubt, and vertices whose feet have a normal of the other side. In
each component of the coarse mesh the largest edge-connected group of the others is right. From
there on each vertex is tested in turn: can its foot be reached from those of its neighbours? If
not, or if its normal is wrong, it gets the closest point of what can be reached.
*/
class Row_follower
{
public:
  Row_follower(const Mesh_matrices& coarse, const Mesh_matrices& fine,
               const Eigen::SparseMatrix<double>& P)
    : m_coarse(coarse)
    , m_fine(fine)
    , m_rings(Vertex_rings::of_vertices(coarse.T, coarse.V.rows()))
    , m_fine_rings(Vertex_rings::of_vertices(fine.T, fine.V.rows()))
    , m_rows(std::size_t(coarse.V.rows()))
    , m_distance(std::size_t(fine.V.rows()), infinity)
    , m_waiting(std::size_t(fine.V.rows()), 0)
    , m_component(connected_components(fine.V.rows(), fine.T))
    , m_coarse_component(connected_components(coarse.V.rows(), coarse.T))
  {
    for(int j = 0; j < int(P.cols()); ++j)
      for(Eigen::SparseMatrix<double>::InnerIterator it(P, j); it; ++it)
        m_rows[it.row()].entries.emplace_back(j, it.value());
    for(std::size_t v = 0; v < m_rows.size(); ++v)
      set_foot(int(v));
    set_sides();
  }

  Followed_rows run()
  {
    std::vector<char> settled = main_groups();
    std::vector<int> queue;
    const auto call_neighbours = [&](const int v) {
      for(const int w : m_rings[v])
        if(!settled[w])
          queue.push_back(w);
    };
    for(int v = 0; v < int(m_rows.size()); ++v)
      if(settled[v])
        call_neighbours(v);
    Followed_rows result;
    for(std::size_t next = 0; next < queue.size(); ++next) {
      const int v = queue[next];
      if(settled[v])
        continue;
      if(!settle(v, settled))
        result.off.push_back(v);
      settled[v] = 1;
      call_neighbours(v);
    }
    std::sort(result.off.begin(), result.off.end());
    std::vector<Eigen::Triplet<double>> entries;
    for(std::size_t v = 0; v < m_rows.size(); ++v)
      for(const auto& [j, weight] : m_rows[v].entries)
        entries.emplace_back(int(v), j, weight);
    result.P.resize(Eigen::Index(m_rows.size()), m_fine.V.rows());
    result.P.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

private:
  static constexpr double infinity = (std::numeric_limits<double>::infinity)();

  struct Row
  {
    std::vector<std::pair<int, double>> entries;
    Eigen::Vector3d foot;
    double off = 0, extent = 0; // of the foot from the vertex, and from the entries
    bool is_turned = false;     // whether the foot is on the other side of a sheet
  };

  void set_foot(const int v)
  {
    Row& row = m_rows[v];
    row.foot.setZero();
    for(const auto& [j, weight] : row.entries)
      row.foot += weight * m_fine.V.row(j).transpose();
    row.off = (row.foot.transpose() - m_coarse.V.row(v)).norm();
    row.extent = 0;
    for(const auto& [j, weight] : row.entries)
      row.extent = (std::max)(row.extent, to_foot(row, j));
  }

  double to_foot(const Row& row, const int j) const
  {
    return (m_fine.V.row(j).transpose() - row.foot).norm();
  }

  // How far apart the feet of two neighbours may lie.
  double allowed(const int v, const int w) const
  {
    const Row &a = m_rows[v], &b = m_rows[w];
    return 3 * ((m_coarse.V.row(v) - m_coarse.V.row(w)).norm() + a.off + b.off) +
           2 * (a.extent + b.extent);
  }

  // Distances along fine edges from the feet of `sources`, up to a bound, or until all entries of
  // `targets`, if any, are reached.
  void spread(const std::vector<int>& sources, const double bound, const std::vector<int>& targets)
  {
    for(const int i : m_touched)
      m_distance[i] = infinity;
    m_touched.clear();
    std::size_t missing = 0;
    for(const int w : targets)
      for(const auto& [j, weight] : m_rows[w].entries) {
        missing += m_waiting[j] == 0;
        m_waiting[j] = 1;
      }
    using Front = std::pair<double, int>;
    std::priority_queue<Front, std::vector<Front>, std::greater<Front>> queue;
    const auto reach = [&](const double distance, const int i) {
      double& d = m_distance[i];
      if(distance >= d || distance > bound)
        return;
      if(d == infinity)
        m_touched.push_back(i);
      d = distance;
      queue.emplace(distance, i);
    };
    for(const int v : sources)
      for(const auto& [j, weight] : m_rows[v].entries)
        reach(to_foot(m_rows[v], j), j);
    while(!queue.empty() && (missing != 0 || targets.empty())) {
      const auto [distance, i] = queue.top();
      queue.pop();
      if(distance > m_distance[i])
        continue;
      missing -= m_waiting[i];
      m_waiting[i] = 0;
      for(const int j : m_fine_rings[i])
        reach(distance + (m_fine.V.row(j) - m_fine.V.row(i)).norm(), j);
    }
    for(const int w : targets)
      for(const auto& [j, weight] : m_rows[w].entries)
        m_waiting[j] = 0;
  }

  bool reached(const int v, const double bound) const
  {
    for(const auto& [j, weight] : m_rows[v].entries)
      if(m_distance[j] + to_foot(m_rows[v], j) <= bound)
        return true;
    return false;
  }

  // Nothing can be said about feet in two components: unwelded patches have neighbours in others.
  bool are_comparable(const int v, const int w) const
  {
    const auto &a = m_rows[v].entries, &b = m_rows[w].entries;
    return !a.empty() && !b.empty() && m_component[a.front().first] == m_component[b.front().first];
  }

  // The sum of the normals of the faces around each vertex, by area.
  static Eigen::MatrixXd normals(const Mesh_matrices& mesh)
  {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(mesh.V.rows(), 3);
    for(Eigen::Index f = 0; f < mesh.T.rows(); ++f) {
      const Eigen::Vector3d n = face_normal(mesh.V, mesh.T, f);
      for(int k = 0; k < 3; ++k)
        result.row(mesh.T(f, k)) += n.transpose();
    }
    return result;
  }

  // Normals of the coarse vertices, reversed in components of which the majority says that the
  // meshes are oriented oppositely.
  void set_sides()
  {
    m_normals = normals(m_coarse);
    const Eigen::MatrixXd fine = normals(m_fine);
    Eigen::VectorXd agreement = Eigen::VectorXd::Zero(m_coarse.V.rows());
    Eigen::VectorXd of_component = agreement;
    for(Eigen::Index v = 0; v < agreement.size(); ++v) {
      Eigen::RowVector3d n = Eigen::RowVector3d::Zero();
      for(const auto& [j, weight] : m_rows[v].entries)
        n += weight * fine.row(j).normalized();
      agreement(v) = m_normals.row(v).normalized().dot(n);
      of_component(m_coarse_component[v]) += agreement(v);
    }
    for(Eigen::Index v = 0; v < agreement.size(); ++v) {
      const double sign = of_component(m_coarse_component[v]) < 0 ? -1 : 1;
      m_normals.row(v) *= sign;
      m_rows[v].is_turned = sign * agreement(v) < 0;
    }
  }

  // Flags the largest group of each component without the vertices in doubt.
  std::vector<char> main_groups()
  {
    std::vector<char> doubtful(m_rows.size());
    for(std::size_t v = 0; v < m_rows.size(); ++v)
      doubtful[v] = m_rows[v].is_turned;
    for(int v = 0; v < int(m_rows.size()); ++v) {
      std::vector<int> later;
      double bound = 0;
      for(const int w : m_rings[v])
        if(w > v && are_comparable(v, w)) {
          later.push_back(w);
          bound = (std::max)(bound, allowed(v, w));
        }
      spread({v}, bound, later);
      for(const int w : later)
        if(!reached(w, allowed(v, w)))
          doubtful[v] = doubtful[w] = 1;
    }
    const std::vector<Eigen::Index> group =
        connected_components(Eigen::Index(m_rows.size()), [&](const auto& join) {
          for(int v = 0; v < int(m_rows.size()); ++v)
            for(const int w : m_rings[v])
              if(!doubtful[v] && !doubtful[w])
                join(v, w);
        });
    std::vector<std::size_t> size(m_rows.size(), 0);
    for(const Eigen::Index g : group)
      ++size[g];
    std::vector<Eigen::Index> largest(m_rows.size(), -1);
    for(std::size_t v = 0; v < m_rows.size(); ++v) {
      Eigen::Index& best = largest[m_coarse_component[v]];
      if(best < 0 || size[group[v]] > size[best])
        best = group[v];
    }
    std::vector<char> result(m_rows.size());
    for(std::size_t v = 0; v < m_rows.size(); ++v)
      result[v] = largest[m_coarse_component[v]] == group[v];
    return result;
  }

  // False if the foot of v cannot be reached.
  bool settle(const int v, const std::vector<char>& settled)
  {
    std::vector<int> sources;
    double bound = 0;
    for(const int w : m_rings[v])
      if(settled[w] && are_comparable(v, w)) {
        sources.push_back(w);
        bound = (std::max)(bound, allowed(v, w));
      }
    spread(sources, bound, {v});
    const bool is_reached = sources.empty() || reached(v, bound);
    if(is_reached && (sources.empty() || !m_rows[v].is_turned))
      return true;
    spread(sources, bound, {}); // all of it
    if(!m_fine_faces)
      m_fine_faces.emplace(Vertex_rings::of_faces(m_fine.T, m_fine.V.rows()));
    const Eigen::Vector3d p = m_coarse.V.row(v);
    Point_of_triangle best{Eigen::Vector3d::Zero(), infinity};
    int face = -1;
    for(const int i : m_touched)
      for(const int f : (*m_fine_faces)[i]) {
        if(!(face_normal(m_fine.V, m_fine.T, f).dot(m_normals.row(v)) >= 0))
          continue;
        Eigen::Matrix3d corners;
        for(int k = 0; k < 3; ++k)
          corners.col(k) = m_fine.V.row(m_fine.T(f, k)).transpose();
        const Point_of_triangle candidate = closest_point_of_triangle(p, corners);
        if(candidate.squared_distance < best.squared_distance) {
          best = candidate;
          face = f;
        }
      }
    if(face < 0)
      return is_reached; // nothing better
    m_rows[v].entries.clear();
    for(int k = 0; k < 3; ++k)
      if(best.weights(k) != 0)
        m_rows[v].entries.emplace_back(m_fine.T(face, k), best.weights(k));
    set_foot(v);
    return is_reached;
  }

  const Mesh_matrices& m_coarse;
  const Mesh_matrices& m_fine;
  Vertex_rings m_rings, m_fine_rings;
  std::optional<Vertex_rings> m_fine_faces; // once a row is off
  std::vector<Row> m_rows;
  std::vector<double> m_distance; // by fine vertex, of those touched last
  std::vector<int> m_touched;
  std::vector<char> m_waiting;
  std::vector<Eigen::Index> m_component, m_coarse_component; // by vertex
  Eigen::MatrixXd m_normals;                                 // of the coarse vertices
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_ROW_FOLLOWER_H
