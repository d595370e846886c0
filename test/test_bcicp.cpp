// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../examples/programs/matching/bcicp.h"

#include "catch.h"
#include "shapes.h"

#include <CGAL/Spectral_geometry/Run_control.h>

namespace test_bcicp {

namespace {

using Index = Eigen::Index;
using Map = std::vector<Index>;

constexpr Index modes = 40;

bool always()
{
  return true;
}

Shape shape_of(const shapes::Matrices& mesh)
{
  return make_shape({mesh.V, mesh.T}, modes, SG::Mass::averaged, always);
}

// About an axis beside it, and turned in space.
shapes::Matrices bent(shapes::Matrices mesh)
{
  for(Index i = 0; i < mesh.V.rows(); ++i) {
    const double angle = 0.2 * mesh.V(i, 0), radius = 5 - mesh.V(i, 1);
    mesh.V.row(i) =
        Eigen::RowVector3d(mesh.V(i, 2), radius * std::sin(angle), 5 - radius * std::cos(angle));
  }
  return mesh;
}

Map identity(Index n)
{
  Map result(static_cast<std::size_t>(n));
  std::iota(result.begin(), result.end(), Index(0));
  return result;
}

// Every fifth vertex to one drawn from all, and every seventh to where its successor goes.
Map perturbed(Map map, unsigned seed)
{
  std::mt19937 random(seed);
  for(std::size_t i = 0; i + 1 < map.size(); ++i)
    if(i % 5 == 0)
      map[i] = static_cast<Index>(random() % map.size());
    else if(i % 7 == 0)
      map[i] = map[i + 1];
  return map;
}

double coverage(const Map& map)
{
  return static_cast<double>(std::set<Index>(map.begin(), map.end()).size()) /
         static_cast<double>(map.size());
}

// Mean length of the edges where the map takes them, over that of the edges.
double roughness(const shapes::Matrices& from, const shapes::Matrices& to, const Map& map)
{
  double before = 0, after = 0;
  for(Index t = 0; t < from.T.rows(); ++t)
    for(int k = 0; k < 3; ++k) {
      const int u = from.T(t, k), v = from.T(t, (k + 1) % 3);
      before += (from.V.row(u) - from.V.row(v)).norm();
      after +=
          (to.V.row(map[static_cast<std::size_t>(u)]) - to.V.row(map[static_cast<std::size_t>(v)]))
              .norm();
    }
  return after / before;
}

// Mean distance of the images from the true ones.
double error(const shapes::Matrices& to, const Map& map, const Map& truth)
{
  double sum = 0;
  for(std::size_t i = 0; i < map.size(); ++i)
    sum += (to.V.row(map[i]) - to.V.row(truth[i])).norm();
  return sum / static_cast<double>(map.size());
}

// How many vertices come back to where they were.
double bijectivity(const Vertex_maps& maps)
{
  double sum = 0;
  for(std::size_t i = 0; i < maps.X_to_Y.size(); ++i)
    sum += maps.Y_to_X[static_cast<std::size_t>(maps.X_to_Y[i])] == static_cast<Index>(i);
  return sum / static_cast<double>(maps.X_to_Y.size());
}

} // namespace

TEST_CASE("BCICP leaves an exact map between copies as it is")
{
  const shapes::Matrices X = shapes::pebble_matrices(shapes::icosphere_matrices(3));
  Map p = identity(X.V.rows());
  std::mt19937 random(1);
  for(std::size_t i = p.size(); i > 1; --i)
    std::swap(p[i - 1], p[random() % i]);
  Map inverse(p.size());
  for(std::size_t i = 0; i < p.size(); ++i)
    inverse[static_cast<std::size_t>(p[i])] = static_cast<Index>(i);
  const Vertex_maps maps =
      bcicp(shape_of(X), shape_of(shapes::permuted(X, p)), {inverse, p}, modes, 3, 2, always);
  CHECK(maps.X_to_Y == inverse);
  CHECK(maps.Y_to_X == p);
}

TEST_CASE("BCICP mends a map between a shape and the same bent", "[slow]")
{
  const shapes::Matrices X = shapes::pebble_matrices(shapes::icosphere_matrices(3)), Y = bent(X);
  const Shape x = shape_of(X), y = shape_of(Y);
  const Map truth = identity(X.V.rows());
  const Vertex_maps before{perturbed(truth, 1), perturbed(truth, 2)};
  const Vertex_maps after = bcicp(x, y, before, modes, 5, 1, always);
  CHECK(coverage(after.X_to_Y) > 0.95);
  CHECK(coverage(after.Y_to_X) > 0.95);
  CHECK(coverage(before.X_to_Y) < 0.85);
  CHECK(roughness(X, Y, after.X_to_Y) < 1.2);
  CHECK(roughness(Y, X, after.Y_to_X) < 1.2);
  CHECK(roughness(X, Y, before.X_to_Y) > 2);
  CHECK(bijectivity(after) > 0.9);
  CHECK(bijectivity(before) < 0.7);
  CHECK(error(Y, after.X_to_Y, truth) < 0.1 * error(Y, before.X_to_Y, truth));
  CHECK(error(X, after.Y_to_X, truth) < 0.1 * error(X, before.Y_to_X, truth));

  // The exact map of a bend is off by less than an edge after it, in the mean.
  const Vertex_maps of_exact = bcicp(x, y, {truth, truth}, modes, 5, 1, always);
  CHECK(error(Y, of_exact.X_to_Y, truth) <= error(Y, after.X_to_Y, truth));
  CHECK(coverage(of_exact.X_to_Y) > 0.95);

  const Vertex_maps two_threads = bcicp(x, y, before, modes, 5, 2, always);
  CHECK(two_threads.X_to_Y == after.X_to_Y);
  const Vertex_maps none = bcicp(x, y, before, modes, 0, 1, always);
  CHECK(none.X_to_Y == before.X_to_Y);
  CHECK_THROWS_AS(bcicp(x, y, before, modes, 5, 1, [] { return false; }), SG::Cancelled);
}

} // namespace test_bcicp
