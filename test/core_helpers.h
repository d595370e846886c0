// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_CORE_HELPERS_H
#define SPECTRAL_TEST_CORE_HELPERS_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_collapse_core.h>

#include "slow_mesh.h"
#include "spectral_test_helpers.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

// Spectral_collapse_core side by side with a Slow_mesh.
namespace spectral_test {

namespace SMS = CGAL::Surface_mesh_simplification;

using Core = SMS::internal::Spectral_collapse_core;
using Sample = SMS::internal::Spectral_sample;
using Parameters = SMS::Spectral_options;
using Rings = SMS::internal::Spectral_rings;
using Slot = SMS::internal::Spectral_slot;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Every signal of the basis, as it is.
inline SMS::internal::Spectral_basis core_basis(const Basis& basis)
{
  SMS::internal::Spectral_basis result;
  result.signals = SMS::internal::Spectral_signals(basis.F.rows(), basis.F.cols());
  result.signals.set(0, basis.F, basis.Z);
  result.number_of_vertices = basis.F.rows();
  result.area = basis.area;
  result.sum_of_squares = basis.lambda.squaredNorm();
  return result;
}

inline Core make_core(const Slow_mesh& mesh, SMS::internal::Spectral_basis signals,
                      const SG::Local_operator& local, const Parameters& parameters,
                      const std::size_t largest_degree_of_others = 256)
{
  Core core;
  core.set_basis(std::move(signals), local, parameters, false);
  core.set_largest_degree_of_others(largest_degree_of_others);
  std::vector<Eigen::Vector3d> points;
  Rings rings;
  rings.resize(std::size_t(mesh.V.rows()));
  for(int v = 0; v < mesh.V.rows(); ++v) {
    points.push_back(mesh.V.row(v));
    rings[Slot(v)] = mesh.ring(v);
  }
  core.set_geometry(std::move(points), std::move(rings));
  return core;
}

inline Core make_core(const Slow_mesh& mesh, const Basis& basis,
                      const Parameters& parameters = Parameters::paper(),
                      const std::size_t largest_degree_of_others = 256)
{
  return make_core(mesh, core_basis(basis), basis.local, parameters, largest_degree_of_others);
}

inline void commit(Core& core, Slow_mesh& mesh, const Edge& e, const Sample& c,
                   const bool keep_first)
{
  const int kept = keep_first ? e.first : e.second, removed = keep_first ? e.second : e.first;
  const double weight = keep_first ? c.weight : 1 - c.weight;
  mesh.collapse(removed, kept, weight, c.point);
  core.commit({removed, kept, weight}, c.point, mesh.ring(kept));
}

// Collapses `count` edges, each the cheapest of a few drawn at random, in the core and in the slow
// mesh alike.
inline int simplify(Core& core, Slow_mesh& mesh, const int count, std::mt19937& random)
{
  int done = 0;
  for(int i = 0; i < 2 * count && done < count; ++i) {
    const std::vector<Edge> edges = mesh.edge_list();
    Sample best;
    Edge edge(0, 0);
    for(int k = 0; k < 12; ++k) {
      const Edge e = edges[random() % edges.size()];
      const Sample c = core.evaluate(Slot(e.first), Slot(e.second));
      if(c.collapsible() && c.cost < best.cost) {
        best = c;
        edge = e;
      }
    }
    if(best.collapsible()) {
      commit(core, mesh, edge, best, random() % 2 == 0);
      ++done;
    }
  }
  return done;
}

// The largest difference of fast and slow cost, and of the change whatever arises, over some edges
// of each kind, at points on and off the edge.
struct Comparison
{
  double worst = 0;
  int counts[number_of_kinds] = {};
};

inline Comparison compare_costs(Core& core, const Slow_mesh& mesh, const int per_kind,
                                std::mt19937& random)
{
  Comparison result;
  const std::map<Edge, int> faces = mesh.edges();
  std::vector<Edge> edges = mesh.edge_list();
  std::shuffle(edges.begin(), edges.end(), random);
  const double before = mesh.energy();
  for(const Edge& e : edges) {
    const Kind kind = mesh.kind(e, faces);
    if(result.counts[kind] == per_kind)
      continue;
    ++result.counts[kind];
    const Slot u = Slot(e.first), v = Slot(e.second);
    const bool valid = kind != bridge && mesh.link_condition(e);
    const double length = (mesh.V.row(e.first) - mesh.V.row(e.second)).norm();
    for(const double alpha : {0., 0.5, 1., (random() % 1000) / 1000., -0.2, 0.7}) {
      Eigen::Vector3d point = on_edge(mesh, e, alpha);
      if(alpha == -0.2 || alpha == 0.7) // off the edge
        point += 0.3 * length *
                 Eigen::Vector3d(std::sin(double(u)), std::cos(double(v)), std::sin(double(u + v)));
      const Eigen::Vector3d uv = on_edge(mesh, e, 1) - on_edge(mesh, e, 0);
      const double projection = (point - on_edge(mesh, e, 0)).dot(uv) / uv.squaredNorm();
      const bool zero_u = mesh.vanishes_at(e.first, faces),
                 zero_v = mesh.vanishes_at(e.second, faces);
      const double weight =
          zero_u != zero_v ? (zero_u ? 0. : 1.) : (std::min)(1., (std::max)(0., projection));
      const double slow = valid ? mesh.energy_after(e, weight, point) - before : infinity;
      const double fast = core.cost_at(u, v, point);
      if(std::isfinite(slow) != std::isfinite(fast))
        result.worst = infinity;
      else if(std::isfinite(slow)) {
        const double whole = core.change_at(u, v, weight, point);
        for(const double cost : {fast, whole})
          result.worst =
              (std::max)(result.worst, std::abs(cost - slow) / (std::abs(slow) + before));
      }
    }
  }
  return result;
}

} // namespace spectral_test

#endif // SPECTRAL_TEST_CORE_HELPERS_H
