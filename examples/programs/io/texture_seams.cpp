// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "texture_seams.h"

#include <CGAL/Spectral_geometry/internal/surface/closest_point_search.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

Texture_seams::Texture_seams(const Mesh& mesh, Corner_texture corners)
  : m_mesh(mesh)
  , m_corners(std::move(corners))
  , m_is_seam(mesh.num_edges(), false)
{
  // Ends in order.
  std::vector<std::tuple<Kernel::Point_3, Kernel::Point_3, Mesh::Edge_index>> border;
  for(const auto e : m_mesh.edges()) {
    const Halfedge h = m_mesh.halfedge(e), g = m_mesh.opposite(h);
    if(m_mesh.is_border(e)) {
      const auto &p = m_mesh.point(m_mesh.source(h)), &q = m_mesh.point(m_mesh.target(h));
      border.emplace_back((std::min)(p, q), (std::max)(p, q), e);
    } else if(m_corners[h] != m_corners[m_mesh.prev(g)] ||
              m_corners[g] != m_corners[m_mesh.prev(h)]) {
      m_is_seam[e] = true;
      ++m_number_of_edges;
    }
  }
  std::sort(border.begin(), border.end());
  for(std::size_t i = 0, end = 0; i < border.size(); i = end) {
    const auto place = [&](const std::size_t j) {
      return std::tie(std::get<0>(border[j]), std::get<1>(border[j]));
    };
    for(end = i; end < border.size() && place(end) == place(i); ++end)
      ;
    if(end == i + 1)
      continue;
    ++m_number_of_edges;
    for(std::size_t j = i; j < end; ++j)
      m_is_seam[std::get<2>(border[j])] = true;
  }
  for(const Vertex v : m_mesh.vertices()) {
    const auto around = m_mesh.halfedges_around_target(m_mesh.halfedge(v));
    if(std::any_of(around.begin(), around.end(), [this](const Halfedge h) { return is_seam(h); }))
      m_vertices.push_back(v);
  }
}

Corner_texture Texture_seams::simplified(const Mesh& coarse,
                                         const std::vector<std::size_t>& map) const
{
  const std::vector<Vertex> handles(coarse.vertices().begin(), coarse.vertices().end());
  Corner_texture result(coarse.num_halfedges());
  set_beside_seams(coarse, handles, map, result);
  set_elsewhere(coarse, handles, map, result);
  return result;
}

// Each side of each seam, at both ends: the coordinates go on round the vertex up to the next seam
// or border.
void Texture_seams::set_beside_seams(const Mesh& coarse, const std::vector<Vertex>& handles,
                                     const std::vector<std::size_t>& map,
                                     Corner_texture& result) const
{
  std::vector<std::pair<Halfedge, Halfedge>> sides; // fine and coarse
  std::vector<char> is_end(coarse.num_edges(), false);
  for(const auto e : coarse.edges())
    is_end[e] = coarse.is_border(e);
  for(const Halfedge h : m_mesh.halfedges()) {
    if(!is_seam(h) || m_mesh.is_border(h))
      continue;
    const Halfedge g =
        coarse.halfedge(handles[map[m_mesh.source(h)]], handles[map[m_mesh.target(h)]]);
    if(!g.is_valid() || coarse.is_border(g))
      throw std::logic_error("the simplification did not keep the vertices of seams.");
    sides.emplace_back(h, g);
    is_end[coarse.edge(g)] = true;
  }
  for(const auto& [fine_side, side] : sides) {
    for(Halfedge h = side;; h = coarse.opposite(coarse.next(h))) {
      result[h] = m_corners[fine_side];
      if(is_end[coarse.edge(coarse.next(h))])
        break;
    }
    for(Halfedge h = coarse.prev(side);; h = coarse.prev(coarse.opposite(h))) {
      result[h] = m_corners[m_mesh.prev(fine_side)];
      if(is_end[coarse.edge(h)])
        break;
    }
  }
}

// Any other vertex: near it are the vertices that went to it or to one of its neighbours.
void Texture_seams::set_elsewhere(const Mesh& coarse, const std::vector<Vertex>& handles,
                                  const std::vector<std::size_t>& map, Corner_texture& result) const
{
  std::vector<std::vector<Vertex>> members(coarse.num_vertices());
  for(const Vertex v : m_mesh.vertices())
    members[handles[map[v]]].push_back(v);
  std::vector<char> is_kept(coarse.num_vertices(), false), near(m_mesh.num_vertices(), false);
  for(const std::size_t v : m_vertices)
    is_kept[handles[map[v]]] = true;
  for(const Vertex w : handles) {
    if(is_kept[w])
      continue;
    const auto set_near = [&](const bool value) {
      for(const Vertex v : members[w])
        near[v] = value;
      for(const Vertex neighbour : coarse.vertices_around_target(coarse.halfedge(w)))
        for(const Vertex v : members[neighbour])
          near[v] = value;
    };
    set_near(true);
    std::vector<Mesh::Face_index> faces;
    for(const Vertex v : members[w])
      for(const auto f : m_mesh.faces_around_target(m_mesh.halfedge(v)))
        if(f.is_valid())
          faces.push_back(f);
    const Texture_point point = closest(coarse.point(w), std::move(faces), near);
    set_near(false);
    for(const Halfedge h : coarse.halfedges_around_target(coarse.halfedge(w)))
      result[h] = point;
  }
}

// At the closest point of the faces that are reached from `faces` without crossing a seam, each
// with a vertex that is `near`.
Texture_point Texture_seams::closest(const Kernel::Point_3& query,
                                     std::vector<Mesh::Face_index> faces,
                                     const std::vector<char>& near) const
{
  const auto vector = [](const Kernel::Point_3& p) { return Eigen::Vector3d(p.x(), p.y(), p.z()); };
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  std::set<Mesh::Face_index> reached(faces.begin(), faces.end());
  double least = std::numeric_limits<double>::infinity();
  Texture_point result = {};
  for(std::size_t i = 0; i < faces.size(); ++i) {
    const Halfedge h = m_mesh.halfedge(faces[i]);
    const std::array<Halfedge, 3> sides = {h, m_mesh.next(h), m_mesh.prev(h)};
    Eigen::Matrix3d triangle;
    for(int j = 0; j < 3; ++j)
      triangle.col(j) = vector(m_mesh.point(m_mesh.target(sides[std::size_t(j)])));
    const auto point =
        CGAL::Spectral_geometry::internal::closest_point_of_triangle(vector(query), triangle);
    if(point.squared_distance < least) {
      least = point.squared_distance;
      for(std::size_t k = 0; k < 2; ++k) {
        result[k] = 0;
        for(int j = 0; j < 3; ++j)
          result[k] += point.weights[j] * m_corners[sides[std::size_t(j)]][k];
      }
    }
    for(const Halfedge side : sides) {
      const auto f = m_mesh.face(m_mesh.opposite(side));
      if(is_seam(side) || !f.is_valid())
        continue;
      const auto around = m_mesh.vertices_around_face(m_mesh.halfedge(f));
      if(std::any_of(around.begin(), around.end(), [&](const Vertex v) { return near[v]; }) &&
         reached.insert(f).second)
        faces.push_back(f);
    }
  }
  return result;
}
