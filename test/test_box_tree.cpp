// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The tree of boxes, and the pairs of faces that it finds.

#include <CGAL/Spectral_geometry/internal/surface/Box_tree.h>
#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include "catch.h"
#include "shapes.h"

#include <Eigen/Core>

namespace test_box_tree {

TEST_CASE("A tree of boxes finds what looking at all of them finds, while they change")
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  using Box = SG::internal::Box_tree::Box;
  const auto draw = [&] {
    const Eigen::Vector3d p(uniform(random), uniform(random), uniform(random));
    // far apart in size
    return Box(p, p + std::pow(10., -6 * uniform(random)) *
                          Eigen::Vector3d(uniform(random), 0.3, 0.1));
  };
  for(const std::size_t n : {std::size_t(0), std::size_t(1), std::size_t(2), std::size_t(700)}) {
    std::vector<Box> boxes(n);
    std::generate(boxes.begin(), boxes.end(), draw);
    if(n > 100)
      boxes[7] = Box(); // met by nothing
    SG::internal::Box_tree tree;
    tree.build(boxes);
    for(int round = 0; round < 200; ++round) {
      const Box box = draw();
      std::set<std::size_t> found, expected;
      tree.any(box, [&](const std::size_t i) {
        found.insert(i);
        return false;
      });
      for(std::size_t i = 0; i < n; ++i)
        if(boxes[i].intersects(box))
          expected.insert(i);
      CHECK(found == expected);
      if(n != 0) {
        const std::size_t i = random() % n;
        boxes[i] = random() % 5 == 0 ? Box() : draw();
        tree.update(i, boxes[i]);
      }
    }
  }
}

TEST_CASE("A tree of boxes looks at few of them, however unevenly they lie")
{
  using Box = SG::internal::Box_tree::Box;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  for(const double far : {1., 1e9, 1e300}) { // of the last one
    std::vector<Box> boxes;
    for(int i = 0; i < 4097; ++i) {
      const Eigen::Vector3d p(uniform(random), uniform(random), uniform(random));
      boxes.push_back(Box(p, p + Eigen::Vector3d::Constant(0.01)));
    }
    boxes.back() = Box(Eigen::Vector3d::Constant(far));
    SG::internal::Box_tree tree;
    tree.build(boxes);
    int looked_at = 0;
    for(int round = 0; round < 100; ++round) {
      const Eigen::Vector3d p(uniform(random), uniform(random), uniform(random));
      double bound = std::numeric_limits<double>::max();
      std::size_t nearest = boxes.size();
      tree.visit_near(p, bound, [&](const std::size_t i) {
        ++looked_at;
        const double distance = boxes[i].squaredExteriorDistance(p);
        if(distance < bound) {
          bound = distance;
          nearest = i;
        }
      });
      REQUIRE(nearest < boxes.size());
      for(const Box& box : boxes)
        REQUIRE(box.squaredExteriorDistance(p) >= bound);
    }
    CHECK(looked_at < 100 * 20);
  }
}

TEST_CASE("Faces that meet are those that CGAL finds")
{
  shapes::Matrices input = shapes::thin_bowl_matrices(3);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for(Eigen::Index i = 0; i < input.V.size(); ++i)
    input.V.data()[i] += 0.03 * uniform(random);
  using Mesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
  Mesh mesh;
  shapes::make_mesh(mesh, input);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> theirs;
  CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(theirs));
  SG::internal::Face_pairs expected;
  for(const auto& [f, g] : theirs)
    expected.emplace_back(Eigen::Index((std::min)(f, g)), Eigen::Index((std::max)(f, g)));
  std::sort(expected.begin(), expected.end());
  REQUIRE(expected.size() > 100);
  CHECK(SG::internal::self_intersecting_faces(input.V, input.T) == expected);
}

} // namespace test_box_tree
