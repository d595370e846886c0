// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "bcicp.h"

#include "matcher.h"

#include <CGAL/Spectral_geometry/Run_control.h>
#include <CGAL/Spectral_toolbox/functional_map_estimation.h>
#include <CGAL/Spectral_toolbox/vertex_maps.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <set>
#include <utility>
#include <vector>

namespace SG = CGAL::Spectral_geometry;

namespace {

using Index = Eigen::Index;
using Map = std::vector<Index>;

// A mesh at unit area, with the lengths of the shortest paths along its edges.
struct Surface
{
  Surface(const Shape& shape, Index modes)
    : shape(shape.spectral)
    , modes(shape.spectral.pairs.vectors.leftCols(modes))
    , rings(static_cast<std::size_t>(this->modes.rows()))
    , distances(this->modes.rows(), this->modes.rows())
  {
    const Eigen::MatrixXi& T = shape.matrices.T;
    for(Index t = 0; t < T.rows(); ++t)
      for(int k = 0; k < 3; ++k) {
        rings[static_cast<std::size_t>(T(t, k))].insert(T(t, (k + 1) % 3));
        rings[static_cast<std::size_t>(T(t, (k + 1) % 3))].insert(T(t, k));
      }
    const Eigen::MatrixXd V = shape.matrices.V / std::sqrt(shape.area);
    const auto length = [&](Index u, Index v) { return (V.row(u) - V.row(v)).norm(); };
    for(Index v = 0; v < V.rows(); ++v)
      for(const Index u : ring(v))
        longest_edge = (std::max)(longest_edge, length(u, v));
    distances.setConstant(std::numeric_limits<double>::infinity());
    using Reached = std::pair<double, Index>;
    for(Index source = 0; source < V.rows(); ++source) {
      auto distance = distances.col(source);
      distance(source) = 0;
      std::priority_queue<Reached, std::vector<Reached>, std::greater<Reached>> queue;
      queue.emplace(0., source);
      while(!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if(d > distance(v))
          continue;
        for(const Index u : ring(v))
          if(d + length(u, v) < distance(u)) {
            distance(u) = d + length(u, v);
            queue.emplace(distance(u), u);
          }
      }
    }
  }

  const std::set<Index>& ring(Index v) const { return rings[static_cast<std::size_t>(v)]; }
  Index size() const { return modes.rows(); }

  const SG::Spectral_shape& shape;
  Eigen::MatrixXd modes;
  std::vector<std::set<Index>> rings;
  Eigen::MatrixXd distances;
  double longest_edge = 0;
};

Index image(const Map& map, Index v)
{
  return map[static_cast<std::size_t>(v)];
}

std::vector<int> preimages(const Map& map, Index targets)
{
  std::vector<int> result(static_cast<std::size_t>(targets), 0);
  for(const Index w : map)
    ++result[static_cast<std::size_t>(w)];
  return result;
}

// Which vertices have an edge whose ends are mapped further apart than the ends of any edge of
// either mesh?
std::vector<bool> torn(const Surface& from, const Surface& to, const Map& map)
{
  const double longest = (std::max)(from.longest_edge, to.longest_edge);
  std::vector<bool> result(map.size(), false);
  for(Index v = 0; v < from.size(); ++v)
    for(const Index u : from.ring(v))
      if(to.distances(image(map, u), image(map, v)) > longest)
        result[static_cast<std::size_t>(v)] = true;
  return result;
}

// Torn vertices, and islands between them, go where the nearest vertex of a large torn-free region
// goes.
Map without_outliers(const Surface& from, const Surface& to, const Map& map)
{
  constexpr double smallest_region = 0.08; // of all vertices
  std::vector<bool> seen = torn(from, to, map);
  Map right;
  for(Index seed = 0; seed < from.size(); ++seed) {
    Map region;
    const auto reach = [&](Index v) {
      if(!seen[static_cast<std::size_t>(v)]) {
        seen[static_cast<std::size_t>(v)] = true;
        region.push_back(v);
      }
    };
    reach(seed);
    for(std::size_t i = 0; i < region.size(); ++i)
      for(const Index u : from.ring(region[i]))
        reach(u);
    if(static_cast<double>(region.size()) >= smallest_region * static_cast<double>(from.size()))
      right.insert(right.end(), region.begin(), region.end());
  }
  const double farthest = (std::max)(from.longest_edge, to.longest_edge);
  Map result = map;
  for(Index v = 0; v < from.size(); ++v) {
    const auto nearest = std::min_element(right.begin(), right.end(), [&](Index a, Index b) {
      return from.distances(a, v) < from.distances(b, v);
    });
    if(nearest != right.end() && from.distances(*nearest, v) < farthest)
      result[static_cast<std::size_t>(v)] = image(map, *nearest);
  }
  return result;
}

// How much the edges at v change their lengths if v goes to w.
double stretch(const Surface& from, const Surface& to, const Map& map, Index v, Index w)
{
  double sum = 0;
  for(const Index u : from.ring(v))
    sum += std::abs(to.distances(image(map, u), w) - from.distances(u, v));
  return sum;
}

// Vertices go to the mean of where their neighbours are, of all vertices in and beside these
// images: the torn ones always, the others with `all`, if that leaves no vertex uncovered and
// stretches less.
Map smoothed(const Surface& from, const Surface& to, Map map, bool all)
{
  const std::vector<bool> is_torn = torn(from, to, map);
  std::vector<int> count = preimages(map, to.size());
  for(Index v = 0; v < from.size(); ++v) {
    Index& present = map[static_cast<std::size_t>(v)];
    const bool at_once = is_torn[static_cast<std::size_t>(v)];
    if(from.ring(v).empty() ||
       (!at_once && (!all || count[static_cast<std::size_t>(present)] == 1)))
      continue;
    std::set<Index> candidates;
    for(const Index u : from.ring(v)) {
      candidates.insert(image(map, u));
      candidates.insert(to.ring(image(map, u)).begin(), to.ring(image(map, u)).end());
    }
    Index best = present;
    double least = std::numeric_limits<double>::infinity();
    for(const Index w : candidates) {
      double sum = 0;
      for(const Index u : from.ring(v))
        sum += to.distances(image(map, u), w) * to.distances(image(map, u), w);
      if(sum < least) {
        least = sum;
        best = w;
      }
    }
    if(at_once || stretch(from, to, map, v, best) < stretch(from, to, map, v, present)) {
      --count[static_cast<std::size_t>(present)];
      ++count[static_cast<std::size_t>(best)];
      present = best;
    }
  }
  return map;
}

// Vertices that nothing is mapped to get one: of those that share their image with others the one
// that is nearest to where the map back goes, if it thereby comes no further away from its own way
// there and back.
Map covering(const Surface& from, const Surface& to, Map map, const Map& back)
{
  std::vector<int> count = preimages(map, to.size());
  for(Index w = 0; w < to.size(); ++w) {
    if(count[static_cast<std::size_t>(w)] > 0)
      continue;
    const auto distance = from.distances.col(image(back, w));
    Index nearest = -1;
    for(Index v = 0; v < from.size(); ++v)
      if(count[static_cast<std::size_t>(image(map, v))] > 1 &&
         (nearest == -1 || distance(v) < distance(nearest)))
        nearest = v;
    if(nearest == -1)
      break;
    Index& present = map[static_cast<std::size_t>(nearest)];
    if(distance(nearest) <= from.distances(image(back, present), nearest)) {
      --count[static_cast<std::size_t>(present)];
      ++count[static_cast<std::size_t>(w)];
      present = w;
    }
  }
  return map;
}

class Bcicp
{
public:
  Bcicp(Surface X, Surface Y, Vertex_maps maps, int threads)
    : m_X(std::move(X))
    , m_Y(std::move(Y))
    , m_maps(std::move(maps))
    , m_threads(threads)
  {}

  void iterate()
  {
    by_modes();
    on_surfaces();
    by_images();
    on_surfaces();
    m_maps.X_to_Y = smoothed(m_X, m_Y, std::move(m_maps.X_to_Y), true);
    m_maps.Y_to_X = smoothed(m_Y, m_X, std::move(m_maps.Y_to_X), true);
  }

  const Vertex_maps& maps() const { return m_maps; }

private:
  // The nearest vertices both ways, compared in the modes of both shapes at once.
  void by_modes()
  {
    Eigen::MatrixXd to_X = functional_map(m_Y, m_X, m_maps.X_to_Y),
                    to_Y = functional_map(m_X, m_Y, m_maps.Y_to_X);
    // There and back is to be the identity: what it rotates is taken out.
    to_X *= SG::nearest_orthogonal_map(to_Y * to_X).transpose();
    to_Y *= SG::nearest_orthogonal_map(to_X * to_Y).transpose();
    find(m_X.modes, m_X.modes * to_Y.transpose(), m_Y.modes * to_X.transpose(), m_Y.modes);
  }

  // Takes the other shape's modes at the images, less what there and back rotates.
  void by_images()
  {
    const Eigen::MatrixXd loop_X = SG::nearest_orthogonal_map(
                              functional_map(m_X, m_X, chained(m_maps.X_to_Y, m_maps.Y_to_X))),
                          loop_Y = SG::nearest_orthogonal_map(
                              functional_map(m_Y, m_Y, chained(m_maps.Y_to_X, m_maps.X_to_Y)));
    find(m_X.modes, at(m_Y.modes, m_maps.X_to_Y) * loop_Y.transpose(),
         at(m_X.modes, m_maps.Y_to_X) * loop_X.transpose(), m_Y.modes);
  }

  void on_surfaces()
  {
    constexpr int rounds = 4;
    for(int round = 0; round < rounds; ++round) {
      improve(m_X, m_Y, m_maps.X_to_Y, m_maps.Y_to_X);
      improve(m_Y, m_X, m_maps.Y_to_X, m_maps.X_to_Y);
    }
  }

  static void improve(const Surface& from, const Surface& to, Map& map, const Map& back)
  {
    map = without_outliers(from, to, map);
    map = smoothed(from, to, std::move(map), false);
    map = covering(from, to, std::move(map), back);
  }

  void find(const Eigen::MatrixXd& X_in_X, const Eigen::MatrixXd& X_in_Y,
            const Eigen::MatrixXd& Y_in_X, const Eigen::MatrixXd& Y_in_Y)
  {
    Eigen::MatrixXd x(X_in_X.rows(), X_in_X.cols() + X_in_Y.cols()), y(Y_in_X.rows(), x.cols());
    x << X_in_X, X_in_Y;
    y << Y_in_X, Y_in_Y;
    m_maps.X_to_Y = SG::nearest_rows(y, x, {m_threads});
    m_maps.Y_to_X = SG::nearest_rows(x, y, {m_threads});
  }

  static Eigen::MatrixXd functional_map(const Surface& source, const Surface& target,
                                        const Map& map)
  {
    return SG::functional_map_of_vertex_map(source.modes, target.modes, target.shape.op.B, map);
  }

  static Map chained(Map first, const Map& second)
  {
    for(Index& v : first)
      v = image(second, v);
    return first;
  }

  static Eigen::MatrixXd at(const Eigen::MatrixXd& modes, const Map& map)
  {
    Eigen::MatrixXd result(static_cast<Index>(map.size()), modes.cols());
    for(Index v = 0; v < result.rows(); ++v)
      result.row(v) = modes.row(image(map, v));
    return result;
  }

  Surface m_X, m_Y;
  Vertex_maps m_maps;
  int m_threads;
};

} // namespace

Vertex_maps bcicp(const Shape& X, const Shape& Y, Vertex_maps maps, Eigen::Index modes,
                  int iterations, int threads, const Keep_going& keep_going)
{
  auto [of_X, of_Y] = side_by_side(
      threads, [&] { return Surface(X, modes); }, [&] { return Surface(Y, modes); });
  Bcicp refinement(std::move(of_X), std::move(of_Y), std::move(maps), threads);
  for(int i = 0; i < iterations; ++i) {
    if(!keep_going())
      throw SG::Cancelled();
    refinement.iterate();
  }
  return refinement.maps();
}
