// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "orientation.h"

#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace {

using Eigen::Index;

struct Component
{
  std::vector<Index> triangles;
  Eigen::AlignedBox3d box;
  bool closed = true;
  double volume = 0, area = 0;
};

std::vector<Component> components_of(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T)
{
  const std::vector<Index> component =
      CGAL::Spectral_geometry::internal::connected_components(V.rows(), T);
  std::vector<Component> result;
  for(Index t = 0; t < T.rows(); ++t) {
    const auto c = static_cast<std::size_t>(component[std::size_t(T(t, 0))]);
    result.resize((std::max)(result.size(), c + 1));
    Component& own = result[c];
    own.triangles.push_back(t);
    const Eigen::Vector3d origin = V.row(T(own.triangles.front(), 0));
    Eigen::Matrix3d p;
    for(int i = 0; i < 3; ++i) {
      p.col(i) = V.row(T(t, i)).transpose();
      own.box.extend(p.col(i));
    }
    p.colwise() -= origin;
    own.volume += p.col(0).dot(p.col(1).cross(p.col(2))) / 6;
    own.area += (p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).norm() / 2;
  }
  for(const auto& edge : CGAL::Spectral_geometry::internal::boundary_edges(T))
    result[static_cast<std::size_t>(component[std::size_t(edge.first)])].closed = false;
  return result;
}

// How often a closed surface winds round a point: the sum of solid angles (van Oosterom and
// Strackee, 1983).
double winding_number(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const Component& surface,
                      const Eigen::RowVector3d& point)
{
  double sum = 0;
  for(const Index t : surface.triangles) {
    const Eigen::RowVector3d a = V.row(T(t, 0)) - point, b = V.row(T(t, 1)) - point,
                             c = V.row(T(t, 2)) - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * std::acos(-1.));
}

} // namespace

std::vector<Index> inside_out(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T)
{
  const std::vector<Component> components = components_of(V, T);
  const auto lies_in = [&](const Component& inner, const Component& outer) {
    return &inner != &outer && outer.closed && outer.box.contains(inner.box) &&
           std::abs(winding_number(V, T, outer, V.row(T(inner.triangles.front(), 0)))) > 0.5;
  };
  std::vector<Index> result;
  for(const Component& outer : components) {
    // The sign may mean nothing where a surface goes through itself; a sphere has 0.094 here.
    if(!outer.closed || !(outer.volume < -1e-4 * std::pow(outer.area, 1.5)) ||
       std::any_of(components.begin(), components.end(),
                   [&](const Component& other) { return lies_in(outer, other); }))
      continue;
    for(const Component& c : components)
      if(&c == &outer || (c.closed && lies_in(c, outer)))
        result.insert(result.end(), c.triangles.begin(), c.triangles.end());
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}
