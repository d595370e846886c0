// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_FACE_GRID_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_FACE_GRID_H

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <unordered_map>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// true if two triangles, given by vertices, meet in more than their common vertices or edge. Exact. A triangle
/// without area meets nothing.
inline bool triangles_intersect(const Eigen::MatrixXd& V, std::array<int, 3> s, std::array<int, 3> t)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto point = [&V](const int v) { return Kernel::Point_3(V(v, 0), V(v, 1), V(v, 2)); };
  const auto triangle = [&](const std::array<int, 3>& u) {
    return Kernel::Triangle_3(point(u[0]), point(u[1]), point(u[2]));
  };
  const auto is_flat = [&](const std::array<int, 3>& u) {
    return CGAL::collinear(point(u[0]), point(u[1]), point(u[2]));
  };
  if(is_flat(s) || is_flat(t))
    return false;
  // The common ones to the front.
  std::size_t common = 0;
  for(std::size_t k = 0; k < 3; ++k) {
    const auto found = std::find(t.begin(), t.end(), s[k]);
    if(found == t.end())
      continue;
    std::iter_swap(t.begin() + std::ptrdiff_t(common), found);
    std::swap(s[common++], s[k]);
  }
  if(common == 0)
    return CGAL::do_intersect(triangle(s), triangle(t));
  if(common == 1)
    return CGAL::do_intersect(triangle(s), Kernel::Segment_3(point(t[1]), point(t[2]))) ||
           CGAL::do_intersect(triangle(t), Kernel::Segment_3(point(s[1]), point(s[2])));
  return common == 3 ||
         (CGAL::coplanar(point(s[0]), point(s[1]), point(s[2]), point(t[2])) &&
          CGAL::coplanar_orientation(point(s[0]), point(s[1]), point(s[2]), point(t[2])) != CGAL::NEGATIVE);
}

/// Finds the faces near a box while faces change.
class Face_grid
{
public:
  using Box = Eigen::AlignedBox3d;

  Face_grid(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T)
  {
    Box all;
    double extent = 0;
    for(Eigen::Index f = 0; f < T.rows(); ++f) {
      Box box;
      for(int k = 0; k < 3; ++k)
        box.extend(Eigen::Vector3d(V.row(T(f, k))));
      m_boxes.push_back(box);
      all.extend(box);
      extent += box.diagonal().maxCoeff() / double(T.rows());
    }
    // Numbers of cells fit into the key below, however uneven the faces are.
    m_cell = (std::max)(extent, all.diagonal().maxCoeff() / 1000);
    m_origin = all.min();
    for(std::size_t f = 0; f < m_boxes.size(); ++f)
      for_each_cell(m_boxes[f], [&](std::vector<int>& faces) { faces.push_back(int(f)); });
  }

  void replace(const int f, const Box& box)
  {
    for_each_cell(m_boxes[std::size_t(f)],
                  [f](std::vector<int>& faces) { faces.erase(std::find(faces.begin(), faces.end(), f)); });
    m_boxes[std::size_t(f)] = box;
    for_each_cell(box, [f](std::vector<int>& faces) { faces.push_back(f); });
  }

  /// The faces whose boxes meet this one, each once, in ascending order.
  std::vector<int> near(const Box& box)
  {
    std::vector<int> result;
    for_each_cell(box, [&](const std::vector<int>& faces) {
      for(const int f : faces)
        if(m_boxes[std::size_t(f)].intersects(box))
          result.push_back(f);
    });
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

private:
  template <class Function>
  void for_each_cell(const Box& box, const Function& function)
  {
    const auto cell = [this](const Eigen::Vector3d& p) {
      return ((p - m_origin) / m_cell).array().floor().cast<int>().eval();
    };
    const Eigen::Array3i low = cell(box.min()), high = cell(box.max());
    for(int x = low(0); x <= high(0); ++x)
      for(int y = low(1); y <= high(1); ++y)
        for(int z = low(2); z <= high(2); ++z)
          function(m_cells[x + 1024 * (y + 1024 * z)]);
  }

  std::vector<Box> m_boxes; // by face
  std::unordered_map<int, std::vector<int>> m_cells;
  Eigen::Vector3d m_origin;
  double m_cell;
};

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_FACE_GRID_H
