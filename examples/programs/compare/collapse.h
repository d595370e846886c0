// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_COMPARE_COLLAPSE_H
#define SPECTRAL_EXAMPLES_COMPARE_COLLAPSE_H

#include "coarse_mesh.h"

#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Real_timer.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Restriction_visitor.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <cmath>
#include <cstddef>
#include <string>

// Edge collapses with CGAL's own costs, for what compares with them.

// Empty where a mesh has the size that was asked for.
inline std::string note_on_size(const Mesh& mesh, std::size_t N)
{
  return mesh.number_of_vertices() > N
             ? "It ran out of edges that may be collapsed at " +
                   std::to_string(mesh.number_of_vertices()) + " vertices."
             : "";
}

// `make_policies(mesh)` returns a pair of cost and placement; to make them is part of the time.
template <class Make_policies>
Coarse_mesh collapse(const Mesh& fine, std::size_t N, const Make_policies& make_policies)
{
  Coarse_mesh result;
  result.mesh = fine;
  const CGAL::Surface_mesh_simplification::Restriction_visitor visitor(result.mesh);
  CGAL::Real_timer timer;
  timer.start();
  make_policies(result.mesh, [&](const auto& cost, const auto& placement) {
    CGAL::Surface_mesh_simplification::edge_collapse(
        result.mesh, CGAL::Surface_mesh_simplification::Vertex_count_stop_predicate(N, result.mesh),
        CGAL::parameters::get_cost(cost).get_placement(placement).visitor(visitor));
  });
  result.seconds = timer.time();
  result.note = note_on_size(result.mesh, N);
  result.mesh.collect_garbage(); // reorders the vertices, and the visitor knows how
  result.carried = visitor.restriction();
  result.vertex_map = visitor.vertex_map();
  return result;
}

inline void scale(Mesh& mesh, double factor)
{
  for(const auto v : mesh.vertices())
    mesh.point(v) = CGAL::ORIGIN + factor * (mesh.point(v) - CGAL::ORIGIN);
}

// By one of CGAL's Garland-Heckbert policies.
template <class Policies>
Coarse_mesh collapse_by_quadrics(const Mesh& fine, std::size_t N)
{
  return collapse(fine, N, [](Mesh& mesh, const auto& run) {
    Policies policies(mesh);
    run(policies.get_cost(), policies.get_placement());
  });
}

// CGAL's probabilistic quadrics have variances in the unit of the mesh: what they make depends on
// it. They are judged in the unit in which they are best, that of an area of 20,000.
template <class Policies>
Coarse_mesh collapse_by_probabilistic_quadrics(const Mesh& fine, std::size_t N)
{
  const double factor = std::sqrt(20000 / CGAL::Polygon_mesh_processing::area(fine));
  Mesh scaled = fine;
  scale(scaled, factor);
  Coarse_mesh coarse = collapse_by_quadrics<Policies>(scaled, N);
  scale(coarse.mesh, 1 / factor);
  return coarse;
}

#endif // SPECTRAL_EXAMPLES_COMPARE_COLLAPSE_H
