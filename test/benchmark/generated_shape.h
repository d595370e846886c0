// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_BENCHMARK_GENERATED_SHAPE_H
#define SPECTRAL_BENCHMARK_GENERATED_SHAPE_H

#include "../shapes.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

// The distance from the centre of a star-shaped body with limbs and waves of several lengths.
inline double generated_radius(const Eigen::Vector3d& d)
{
  const Eigen::Vector3d limbs[] = {
      {1, 0.2, 0.1}, {-0.8, 0.7, 0.3}, {-0.3, -1, 0.4}, {0.1, 0.4, 1}, {0.4, -0.3, -1}};
  const double height[] = {1.1, 0.8, 0.9, 0.6, 0.7};
  double r = 1;
  for(int k = 0; k < 5; ++k)
    r += height[k] * std::exp(18 * (d.dot(limbs[k].normalized()) - 1));
  r += 0.06 * std::sin(5 * d.x() + 3 * d.y() + 0.5) + 0.03 * std::sin(9 * d.y() - 7 * d.z());
  return r + 0.012 * std::sin(21 * d.z() + 14 * d.x()) * std::cos(17 * d.y());
}

// Each face of the icosahedron cut into f^2 triangles, the points moved to the body: 10 f^2 + 2
// vertices, as near to `vertices` as possible.
inline shapes::Matrices generated_shape(std::size_t vertices)
{
  const int f = (std::max)(1, static_cast<int>(std::lround(std::sqrt(double(vertices) / 10))));
  const shapes::Matrices base = shapes::icosphere_matrices(0);
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  // Each has f + 1 points, from the smaller corner to the larger.
  std::map<std::pair<int, int>, std::vector<int>> sides;
  std::vector<int> corner(base.V.rows(), -1);
  const auto add = [&](const Eigen::Vector3d& p) {
    points.push_back(p);
    return static_cast<int>(points.size()) - 1;
  };
  const auto corner_point = [&](int v) {
    if(corner[v] < 0)
      corner[v] = add(base.V.row(v).transpose());
    return corner[v];
  };
  const auto side_point = [&](int a, int b, int k) { // k steps of f from a to b
    const bool reverse = a > b;
    std::vector<int>& side = sides[reverse ? std::make_pair(b, a) : std::make_pair(a, b)];
    if(side.empty())
      for(int i = 0; i <= f; ++i) {
        const int from = reverse ? b : a, to = reverse ? a : b;
        const double t = double(i) / f;
        side.push_back(i == 0 ? corner_point(from)
                       : i == f
                           ? corner_point(to)
                           : add(((1 - t) * base.V.row(from) + t * base.V.row(to)).transpose()));
      }
    return side[reverse ? f - k : k];
  };
  for(Eigen::Index t = 0; t < base.T.rows(); ++t) {
    const int a = base.T(t, 0), b = base.T(t, 1), c = base.T(t, 2);
    std::vector<std::vector<int>> rows(f + 1); // row j: j steps from side ab towards c
    for(int j = 0; j <= f; ++j)
      for(int i = 0; i + j <= f; ++i) {
        if(j == 0)
          rows[j].push_back(side_point(a, b, i));
        else if(i == 0)
          rows[j].push_back(side_point(a, c, j));
        else if(i + j == f)
          rows[j].push_back(side_point(b, c, j));
        else
          rows[j].push_back(add(
              ((f - i - j) * base.V.row(a) + i * base.V.row(b) + j * base.V.row(c)).transpose() /
              f));
      }
    for(int j = 0; j < f; ++j)
      for(int i = 0; i + j < f; ++i) {
        triangles.emplace_back(rows[j][i], rows[j][i + 1], rows[j + 1][i]);
        if(i + j + 1 < f)
          triangles.emplace_back(rows[j][i + 1], rows[j + 1][i + 1], rows[j + 1][i]);
      }
  }
  for(Eigen::Vector3d& p : points) {
    p.normalize();
    p *= generated_radius(p);
  }
  return shapes::matrices(points, triangles);
}

#endif // SPECTRAL_BENCHMARK_GENERATED_SHAPE_H
