// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_FLIP_CONNECTIVITY_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_FLIP_CONNECTIVITY_H

#include <CGAL/Spectral_geometry/internal/require.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace CGAL::Spectral_geometry::internal {

/// Triangles that know their neighbours, and whose edges keep their number while they are flipped. Slot 3 f + k is the
/// side of face f that lies opposite to its corner k.
class Flip_connectivity
{
public:
  /// The faces f = (c, i, j) and g = (d, j, i) on both sides of the edge ij.
  struct Quad
  {
    int i, j, c, d, f, g;
    std::array<int, 4> vertices() const { return {i, j, c, d}; }
  };

  /// T refers to n vertices.
  Flip_connectivity(const Eigen::MatrixXi& T, const Eigen::Index n)
    : m_T(T)
    , m_edge(std::size_t(3 * T.rows()))
    , m_faces(std::size_t(n))
  {
    std::map<std::pair<int, int>, int> slot_of; // by directed edge
    for(int s = 0; s < 3 * int(T.rows()); ++s) {
      require(slot_of.emplace(std::make_pair(corner(s, 1), corner(s, 2)), s).second,
              "edge flips: ", face_name(s / 3),
              " does not continue an oriented 2-manifold; repair the mesh.");
      m_faces[std::size_t(corner(s, 0))].push_back(s / 3);
    }
    for(const auto& [ends, s] : slot_of) {
      const auto found = slot_of.find({ends.second, ends.first});
      const bool is_inner = found != slot_of.end();
      if(is_inner && ends.second < ends.first)
        continue; // the other side has made the edge
      const int e = number_of_edges();
      m_edge[std::size_t(s)] = e;
      if(is_inner)
        m_edge[std::size_t(found->second)] = e;
      m_sides.push_back({s, is_inner ? found->second : -1});
    }
  }

  const Eigen::MatrixXi& triangles() const { return m_T; }
  int number_of_edges() const { return int(m_sides.size()); }
  const std::vector<int>& faces_of(const int v) const { return m_faces[std::size_t(v)]; }

  bool is_on_boundary(const int e) const { return m_sides[std::size_t(e)][1] < 0; }

  /// Of an edge that is not on the boundary.
  Quad quad(const int e) const
  {
    const auto [s, t] = m_sides[std::size_t(e)];
    return {corner(s, 1), corner(s, 2), corner(s, 0), corner(t, 0), s / 3, t / 3};
  }

  bool are_adjacent(const int v, const int w) const
  {
    for(const int f : faces_of(v))
      if(m_T(f, 0) == w || m_T(f, 1) == w || m_T(f, 2) == w)
        return true;
    return false;
  }

  std::pair<int, int> ends(const int e) const
  {
    const int s = m_sides[std::size_t(e)][0];
    return {corner(s, 1), corner(s, 2)};
  }

  /// The edges with one of these vertices in one of their two faces, each once.
  std::vector<int> edges_around(const std::array<int, 4>& vertices) const
  {
    std::vector<int> result;
    for(const int v : vertices)
      for(const int f : faces_of(v))
        for(int k = 0; k < 3; ++k)
          result.push_back(m_edge[std::size_t(3 * f + k)]);
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  /// Makes f = (c, i, d) and g = (d, j, c) of the two faces.
  void flip(const int e)
  {
    const Quad q = quad(e);
    const auto [s, t] = m_sides[std::size_t(e)];
    const int from[4] = {side(t, 1), side(s, 2), side(s, 1), side(t, 2)}; // id, ci, jc, dj
    const int to[4] = {3 * q.f, 3 * q.f + 2, 3 * q.g, 3 * q.g + 2};
    int moved[4];
    for(int k = 0; k < 4; ++k)
      moved[k] = m_edge[std::size_t(from[k])];
    for(int k = 0; k < 4; ++k) {
      std::array<int, 2>& sides = m_sides[std::size_t(moved[k])];
      sides = {to[k], sides[sides[0] == from[k]]};
      m_edge[std::size_t(to[k])] = moved[k];
    }
    m_sides[std::size_t(e)] = {3 * q.g + 1, 3 * q.f + 1};
    m_edge[std::size_t(3 * q.f + 1)] = m_edge[std::size_t(3 * q.g + 1)] = e;
    m_T.row(q.f) << q.c, q.i, q.d;
    m_T.row(q.g) << q.d, q.j, q.c;
    remove_face(q.j, q.f);
    remove_face(q.i, q.g);
    m_faces[std::size_t(q.c)].push_back(q.g);
    m_faces[std::size_t(q.d)].push_back(q.f);
  }

private:
  // The k-th corner after the one opposite to a slot, and the slot opposite to it.
  int corner(const int slot, const int k) const { return m_T(slot / 3, (slot + k) % 3); }
  static int side(const int slot, const int k) { return slot - slot % 3 + (slot + k) % 3; }

  void remove_face(const int v, const int f)
  {
    std::vector<int>& faces = m_faces[std::size_t(v)];
    faces.erase(std::find(faces.begin(), faces.end(), f));
  }

  Eigen::MatrixXi m_T;
  std::vector<int> m_edge;                 // by slot
  std::vector<std::array<int, 2>> m_sides; // by edge, its slots; the second is -1 on the boundary
  std::vector<std::vector<int>> m_faces;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_FLIPS_FLIP_CONNECTIVITY_H
