// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shape_measures.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Random.h>
#include <CGAL/boost/graph/copy_face_graph.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace PMP = CGAL::Polygon_mesh_processing;

namespace {

struct Face_quality
{
  double smallest_angle = std::numeric_limits<double>::infinity(); // degrees
  double largest_aspect_ratio = 0;
};

// The aspect ratio is the longest edge over the shortest height: 1.15 for an equilateral triangle.
Face_quality face_quality(const Mesh& mesh)
{
  Face_quality result;
  for(const auto f : faces(mesh)) {
    const auto h = halfedge(f, mesh);
    const Kernel::Point_3& p = mesh.point(source(h, mesh));
    const Kernel::Point_3& q = mesh.point(target(h, mesh));
    const Kernel::Point_3& r = mesh.point(target(next(h, mesh), mesh));
    double longest2 = 0;
    const Kernel::Point_3* corners[] = {&p, &q, &r};
    for(int i = 0; i < 3; ++i) {
      const Kernel::Vector_3 a = *corners[(i + 1) % 3] - *corners[i],
                             b = *corners[(i + 2) % 3] - *corners[i];
      longest2 = (std::max)(longest2, a.squared_length());
      const double area2 = std::sqrt(CGAL::cross_product(a, b).squared_length());
      result.smallest_angle =
          (std::min)(result.smallest_angle, std::atan2(area2, a * b) * 180 / CGAL_PI);
    }
    const double area2 = std::sqrt(CGAL::cross_product(q - p, r - p).squared_length());
    result.largest_aspect_ratio = (std::max)(result.largest_aspect_ratio, longest2 / area2);
  }
  return result;
}

double number_of_self_intersections(const Mesh& mesh)
{
  using Robust_mesh =
      CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
  Robust_mesh robust;
  CGAL::copy_face_graph(mesh, robust);
  std::vector<std::pair<Robust_mesh::Face_index, Robust_mesh::Face_index>> pairs;
  PMP::self_intersections(robust, std::back_inserter(pairs));
  return static_cast<double>(pairs.size());
}

// From 100,000 points on each side, always the same ones: the seed chooses triangles, CGAL's own
// generator points in them.
double symmetric_hausdorff(const Mesh& fine, const Mesh& coarse)
{
  CGAL::get_default_random() = CGAL::Random(0);
  const auto sampling = CGAL::parameters::random_seed(0).number_of_points_on_faces(100000);
  const double there =
      PMP::approximate_Hausdorff_distance<CGAL::Sequential_tag>(fine, coarse, sampling);
  const double back =
      PMP::approximate_Hausdorff_distance<CGAL::Sequential_tag>(coarse, fine, sampling);
  return (std::max)(there, back);
}

} // namespace

double box_diagonal(const Mesh& mesh)
{
  const CGAL::Bbox_3 box = PMP::bbox(mesh);
  return std::sqrt(CGAL::square(box.xmax() - box.xmin()) + CGAL::square(box.ymax() - box.ymin()) +
                   CGAL::square(box.zmax() - box.zmin()));
}

std::size_t number_of_components(const Mesh& mesh)
{
  Mesh copy = mesh;
  const auto components = copy.add_property_map<Mesh::Face_index, std::size_t>("f:component").first;
  return PMP::connected_components(copy, components);
}

Shape_measures shape_measures(const Mesh& fine, const Mesh& coarse)
{
  Shape_measures result;
  const Face_quality quality = face_quality(coarse);
  result.smallest_angle = quality.smallest_angle;
  result.largest_aspect_ratio = quality.largest_aspect_ratio;
  result.self_intersections = number_of_self_intersections(coarse);
  result.hausdorff = symmetric_hausdorff(fine, coarse) / box_diagonal(fine);
  if(CGAL::is_closed(fine) && CGAL::is_closed(coarse))
    result.volume_ratio = PMP::volume(coarse) / PMP::volume(fine);
  result.area_ratio = PMP::area(coarse) / PMP::area(fine);
  const double n = static_cast<double>(coarse.number_of_vertices());
  result.bytes_per_vertex = (24 * n + 12 * static_cast<double>(coarse.number_of_faces())) / n;
  return result;
}
