// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_SURFACE_REGIONS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_SURFACE_REGIONS_H

#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Spectral_geometry/internal/surface/closest_point_search.h>

#include <queue>

namespace CGAL::Spectral_geometry::internal {

/*!
Tells which places of a fine and of a coarse surface correspond, so that a closest point is not
found on another part of the body that is nearer. Each fine vertex is assigned to the coarse vertex
whose row of P is nearest along the surface. A coarse vertex may have its closest point where fine
vertices are assigned to coarse ones at most two edges away, and vice versa. With one edge, regions
would end within the reach of a moving vertex.
*/
class Surface_regions
{
public:
  /// P: coarse x fine. `coarse` and `fine` are kept by reference.
  Surface_regions(const Mesh_matrices& coarse, const Mesh_matrices& fine,
                  const Eigen::SparseMatrix<double>& P)
    : m_coarse(coarse)
    , m_fine(fine)
    , m_rings(Vertex_rings::of_vertices(coarse.T, coarse.V.rows()))
  {
    set_nearest_rows(P);
    set_homes(P);
  }

  /// Whether a fine vertex belongs to a coarse one.
  bool are_near(const int coarse, const Eigen::Index fine) const
  {
    return within_two_edges(coarse, m_row[fine]);
  }

  /// The fine vertices that belong to a coarse one, on components that P reads from.
  std::vector<Eigen::Index> fine_vertices() const
  {
    std::vector<Eigen::Index> result;
    for(std::size_t i = 0; i < m_row.size(); ++i)
      if(m_row[i] >= 0)
        result.push_back(Eigen::Index(i));
    return result;
  }

  /// The closest point on the fine surface of a coarse vertex that is at `p`. Begins at `before`
  /// where it was on that face before, which saves most of the search.
  Closest_point_query::Answer of_coarse_vertex(const Closest_point_query& fine,
                                               const Eigen::Index v, const Eigen::Vector3d& p,
                                               const Eigen::Index before = -1) const
  {
    const Home& home = m_home[v];
    const Eigen::Index first = before < 0 ? (std::max)(home.face, Eigen::Index(0)) : before;
    return fine.among(p, first, [&](const Eigen::Index f) {
      for(const int i : m_fine.T.row(f))
        if(home.row < 0 || m_row[i] == home.row || within_two_edges(int(v), m_row[i]))
          return true;
      return false;
    });
  }

  /// P at the closest points of the coarse vertices, which are at V.
  Eigen::SparseMatrix<double> restriction(const Closest_point_query& fine,
                                          const Eigen::MatrixXd& V) const
  {
    return interpolation(m_fine, V.rows(),
                         [&](const Eigen::Index v) { return of_coarse_vertex(fine, v, V.row(v)); });
  }

  /// The way back, fine x coarse, at the closest points of the fine vertices.
  Eigen::SparseMatrix<double> prolongation() const
  {
    const Closest_point_query coarse(m_coarse);
    const std::vector<Eigen::Index> face_of = faces_at_vertices(m_coarse.T, m_coarse.V.rows());
    return interpolation(m_coarse, m_fine.V.rows(), [&](const Eigen::Index i) {
      const int row = m_row[i];
      const Eigen::Index face = row < 0 ? -1 : face_of[row];
      if(face < 0)
        return coarse(m_fine.V.row(i)); // P says nothing about it
      return coarse.among(m_fine.V.row(i), face, [&](const Eigen::Index f) {
        for(const int v : m_coarse.T.row(f))
          if(within_two_edges(row, v))
            return true;
        return false;
      });
    });
  }

private:
  // A fine face at the row of a coarse vertex, and the coarse vertex that this place is assigned
  // to: another one if several rows share the place.
  struct Home
  {
    Eigen::Index face = -1;
    int row = -1;
  };

  bool within_two_edges(int v, int w) const
  {
    if(v < 0 || w < 0)
      return false;
    if(m_rings[v].size() > m_rings[w].size())
      std::swap(v, w);
    const auto ring = m_rings[w];
    const auto is_around_w = [&](const int u) {
      return std::binary_search(ring.begin(), ring.end(), u);
    };
    return v == w || is_around_w(v) ||
           std::any_of(m_rings[v].begin(), m_rings[v].end(), is_around_w);
  }

  // Dijkstra's algorithm along the fine edges, from all entries of P at once.
  void set_nearest_rows(const Eigen::SparseMatrix<double>& P)
  {
    const Vertex_rings rings = Vertex_rings::of_vertices(m_fine.T, m_fine.V.rows());
    const Eigen::MatrixXd feet = P * m_fine.V;
    using Front = std::tuple<double, int, int>; // distance, fine vertex, row
    std::priority_queue<Front, std::vector<Front>, std::greater<Front>> queue;
    for(int j = 0; j < int(P.cols()); ++j)
      for(Eigen::SparseMatrix<double>::InnerIterator it(P, j); it; ++it)
        if(it.value() > 0)
          queue.emplace((m_fine.V.row(j) - feet.row(it.row())).norm(), j, int(it.row()));
    m_row.assign(std::size_t(m_fine.V.rows()), -1);
    while(!queue.empty()) {
      const auto [distance, i, row] = queue.top();
      queue.pop();
      if(m_row[i] >= 0)
        continue;
      m_row[i] = row;
      for(const int j : rings[i])
        if(m_row[j] < 0)
          queue.emplace(distance + (m_fine.V.row(j) - m_fine.V.row(i)).norm(), j, row);
    }
  }

  // A face at the heaviest entry of each row; where a row is empty, that of a neighbour.
  void set_homes(const Eigen::SparseMatrix<double>& P)
  {
    const std::vector<Eigen::Index> face_of = faces_at_vertices(m_fine.T, m_fine.V.rows());
    m_home.assign(std::size_t(m_coarse.V.rows()), Home());
    Eigen::VectorXd most = Eigen::VectorXd::Zero(P.rows());
    for(Eigen::Index j = 0; j < P.cols(); ++j)
      for(Eigen::SparseMatrix<double>::InnerIterator it(P, j); it; ++it)
        if(face_of[j] >= 0 && it.value() > most(it.row())) {
          most(it.row()) = it.value();
          m_home[it.row()] = {face_of[j], m_row[j]};
        }
    std::vector<int> reached;
    for(int v = 0; v < int(P.rows()); ++v)
      if(m_home[v].face >= 0)
        reached.push_back(v);
    for(std::size_t k = 0; k < reached.size(); ++k)
      for(const int w : m_rings[reached[k]])
        if(m_home[w].face < 0) {
          m_home[w] = m_home[reached[k]];
          reached.push_back(w);
        }
  }

  const Mesh_matrices& m_coarse;
  const Mesh_matrices& m_fine;
  Vertex_rings m_rings;     // of the coarse vertices
  std::vector<int> m_row;   // for each fine vertex the coarse one that it goes with, or -1
  std::vector<Home> m_home; // by coarse vertex
};

/// Closest points of moving coarse vertices. A descent asks several times each for the place of a
/// vertex and for its next place. Both answers are remembered, and the next search begins at them.
/// Different vertices may be asked about concurrently.
class Followed_closest_points
{
public:
  using Answer = Closest_point_query::Answer;

  /// For so many coarse vertices. The others are kept by reference.
  Followed_closest_points(const Closest_point_query& fine, const Surface_regions& regions,
                          const std::size_t vertices)
    : m_fine(fine)
    , m_regions(regions)
    , m_places(vertices)
  {}

  Answer operator()(const Eigen::Index v, const Eigen::Vector3d& p)
  {
    auto& [latest, other] = m_places[v];
    if(!latest.closest || latest.position != p) {
      std::swap(latest, other);
      if(!latest.closest || latest.position != p)
        latest = {
            p, m_regions.of_coarse_vertex(m_fine, v, p, other.closest ? other.closest->face : -1)};
    }
    return *latest.closest;
  }

  /// Whether the closest point moves further than three times the step of the vertex. Legs lie
  /// close to the body and some faces intersect; one vertex whose signals leap to another sheet
  /// would end the descent for all.
  bool leaps(const Eigen::Index v, const Eigen::Vector3d& from, const Eigen::Vector3d& to)
  {
    const Eigen::Vector3d start = (*this)(v, from).point;
    return ((*this)(v, to).point - start).norm() > 3 * (to - from).norm();
  }

  /// Whether a face that v may not use is nearer: a search without regions would find that face.
  bool is_beside_another_part(const Eigen::Index v, const Eigen::Vector3d& p)
  {
    return !(*this)(v, p).is_nearest;
  }

private:
  struct Place
  {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    std::optional<Answer> closest; // to it, once it was asked for
  };

  const Closest_point_query& m_fine;
  const Surface_regions& m_regions;
  std::vector<std::pair<Place, Place>> m_places; // by vertex, the latest first
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_SURFACE_REGIONS_H
