// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_SLOW_MESH_H
#define SPECTRAL_TEST_SLOW_MESH_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_fields.h>

#include "spectral_test_helpers.h"

#include <Eigen/Core>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace spectral_test {

using Edge = std::pair<int, int>;

enum Kind { interior, one_border_vertex, border_edge, bridge, number_of_kinds };

// Triangles, positions and the rows of F and Z; knows nothing but definitions.
class Slow_mesh
{
public:
  Slow_mesh(const shapes::Matrices& mesh, const Basis& basis)
    : V(mesh.V)
    , F(basis.F)
    , Z(basis.Z)
    , m_local(basis.local)
    , m_area(basis.area)
  {
    for(Eigen::Index f = 0; f < mesh.T.rows(); ++f)
      triangles.push_back(mesh.T.row(f));
  }

  static bool contains(const Eigen::Vector3i& t, const int v)
  {
    return t(0) == v || t(1) == v || t(2) == v;
  }

  bool alive(const int v) const
  {
    return std::any_of(triangles.begin(), triangles.end(),
                       [v](const auto& t) { return contains(t, v); });
  }

  // Each edge with the number of its faces.
  std::map<Edge, int> edges() const
  {
    std::map<Edge, int> result;
    for(const Eigen::Vector3i& t : triangles)
      for(int k = 0; k < 3; ++k)
        ++result[std::minmax(int(t(k)), int(t((k + 1) % 3)))];
    return result;
  }

  std::vector<Edge> edge_list() const
  {
    std::vector<Edge> result;
    for(const auto& e : edges())
      result.push_back(e.first);
    return result;
  }

  std::set<int> neighbors(const int v) const
  {
    std::set<int> result;
    for(const Eigen::Vector3i& t : triangles)
      if(contains(t, v))
        result.insert({t(0), t(1), t(2)});
    result.erase(v);
    return result;
  }

  bool on_border(const int v, const std::map<Edge, int>& edges) const
  {
    for(const int w : neighbors(v))
      if(edges.at(std::minmax(v, w)) == 1)
        return true;
    return false;
  }

  Kind kind(const Edge& e, const std::map<Edge, int>& edges) const
  {
    const int borders = on_border(e.first, edges) + on_border(e.second, edges);
    return edges.at(e) == 1 ? border_edge
           : borders == 2   ? bridge
           : borders == 1   ? one_border_vertex
                            : interior;
  }

  // Whether the Dirichlet condition takes a vertex out of the operator.
  bool vanishes_at(const int v, const std::map<Edge, int>& edges) const
  {
    return m_local.boundary == SG::Boundary_condition::dirichlet && on_border(v, edges);
  }

  // The vertices adjacent to both ends are those of the faces at the edge.
  bool link_condition(const Edge& e) const
  {
    const std::set<int> a = neighbors(e.first), b = neighbors(e.second);
    std::vector<int> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    const auto faces = std::count_if(triangles.begin(), triangles.end(), [&](const auto& t) {
      return contains(t, e.first) && contains(t, e.second);
    });
    return common.size() == std::size_t(faces);
  }

  void collapse(const int removed, const int kept, const double alpha, const Eigen::Vector3d& point)
  {
    for(Eigen::MatrixXd* rows : {&F, &Z})
      rows->row(kept) = (1 - alpha) * rows->row(kept) + alpha * rows->row(removed);
    if(SG::Operator_coefficients& c = m_local.coefficients; c.rows() != 0)
      c.row(kept) = (1 - alpha) * c.row(kept) + alpha * c.row(removed);
    V.row(kept) = point;
    std::vector<Eigen::Vector3i> left;
    for(Eigen::Vector3i t : triangles) {
      for(int k = 0; k < 3; ++k)
        if(t(k) == removed)
          t(k) = kept;
      if(t(0) != t(1) && t(1) != t(2) && t(2) != t(0))
        left.push_back(t);
    }
    triangles.swap(left);
  }

  // The neighbours of c in order. Around a border vertex the walk starts after the gap.
  CGAL::Surface_mesh_simplification::internal::Spectral_ring ring(const int c) const
  {
    std::map<int, int> next;
    std::set<int> starts;
    for(const Eigen::Vector3i& t : triangles)
      for(int k = 0; k < 3; ++k)
        if(t(k) == c)
          next[t((k + 1) % 3)] = t((k + 2) % 3);
    for(const auto& n : next)
      starts.insert(n.first);
    for(const auto& n : next)
      starts.erase(n.second);
    CGAL::Surface_mesh_simplification::internal::Spectral_ring result;
    if(next.empty())
      return result;
    const int first = starts.empty() ? next.begin()->first : *starts.begin();
    int v = first;
    do {
      result.emplace_back();
      result.back().vertex = std::uint32_t(v);
      result.back().face = next.count(v) != 0;
      v = result.back().face ? next.at(v) : first;
    } while(v != first);
    return result;
  }

  // E_w by slot, 0 where the slot is gone.
  Eigen::VectorXd vertex_energies() const
  {
    std::vector<int> slots;
    Eigen::VectorXi index = Eigen::VectorXi::Constant(V.rows(), -1);
    for(int v = 0; v < V.rows(); ++v)
      if(alive(v)) {
        index(v) = int(slots.size());
        slots.push_back(v);
      }
    const Eigen::Index n = Eigen::Index(slots.size());
    shapes::Matrices mesh{Eigen::MatrixXd(n, 3), Eigen::MatrixXi(triangles.size(), 3)};
    Eigen::MatrixXd PF(n, F.cols()), PZ(n, Z.cols());
    SG::Local_operator local = m_local;
    local.coefficients.resize(m_local.coefficients.rows() == 0 ? 0 : n, 7);
    for(Eigen::Index i = 0; i < n; ++i) {
      mesh.V.row(i) = V.row(slots[i]);
      PF.row(i) = F.row(slots[i]);
      PZ.row(i) = Z.row(slots[i]);
      if(local.coefficients.rows() != 0)
        local.coefficients.row(i) = m_local.coefficients.row(slots[i]);
    }
    for(std::size_t f = 0; f < triangles.size(); ++f)
      for(int k = 0; k < 3; ++k)
        mesh.T(f, k) = index(triangles[f](k));
    const Eigen::VectorXd E = energies(mesh, local, m_area, PF, PZ);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(V.rows());
    for(Eigen::Index i = 0; i < n; ++i)
      result(slots[i]) = E(i);
    return result;
  }

  double energy() const { return vertex_energies().sum(); }

  // Collapsing to a point with a weight of `e.second`: E afterwards. Infinite where a vertex loses
  // its last face.
  double energy_after(const Edge& e, const double weight, const Eigen::Vector3d& point) const
  {
    Slow_mesh after = *this;
    after.collapse(e.second, e.first, weight, point);
    try {
      return after.energy();
    } catch(const std::invalid_argument&) {
      return std::numeric_limits<double>::infinity();
    }
  }

  Eigen::MatrixXd V, F, Z;
  std::vector<Eigen::Vector3i> triangles;

private:
  SG::Local_operator m_local;
  double m_area;
};

inline Eigen::Vector3d on_edge(const Slow_mesh& mesh, const Edge& e, const double alpha)
{
  return (1 - alpha) * mesh.V.row(e.first) + alpha * mesh.V.row(e.second);
}

} // namespace spectral_test

#endif // SPECTRAL_TEST_SLOW_MESH_H
