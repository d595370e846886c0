// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// CGAL's remeshers as simplifiers. They make new vertices: P is that of the closest points.

#include "coarse_mesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#if __has_include(<CGAL/Polygon_mesh_processing/approximated_centroidal_Voronoi_diagram_remeshing.h>)
#define SPECTRAL_COMPARE_HAS_ACVD 1
#include <CGAL/Polygon_mesh_processing/approximated_centroidal_Voronoi_diagram_remeshing.h>
#endif
#include <CGAL/boost/graph/copy_face_graph.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

namespace PMP = CGAL::Polygon_mesh_processing;

namespace {

// The remeshers' constructions want exact predicates.
using Robust_kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Robust_mesh = CGAL::Surface_mesh<Robust_kernel::Point_3>;

double seconds_since(std::chrono::steady_clock::time_point begin)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <class To, class From>
To converted(const From& from)
{
  To to;
  CGAL::copy_face_graph(from, to);
  return to;
}

// How far a count is from the wanted one.
double miss(std::size_t n, std::size_t N)
{
  return std::abs(static_cast<double>(n) / static_cast<double>(N) - 1);
}

struct Remeshed
{
  Robust_mesh mesh;
  double seconds = 0;
};

Remeshed remesh_isotropically(const Robust_mesh& fine, double edge_length)
{
  Remeshed result;
  result.mesh = fine;
  const auto begin = std::chrono::steady_clock::now();
  PMP::isotropic_remeshing(faces(result.mesh), edge_length, result.mesh,
                           CGAL::parameters::number_of_iterations(5).number_of_relaxation_steps(1));
  result.mesh.collect_garbage();
  result.seconds = seconds_since(begin);
  return result;
}

// The number of vertices falls about as the square of the edge length, with jumps: a search by that law, and
// the best that it met. The time is that of the best run alone.
Coarse_mesh isotropic(const Mesh& input, std::size_t N)
{
  const Robust_mesh fine = converted<Robust_mesh>(input);
  const double area = PMP::area(fine);
  double length = std::sqrt(2 / std::sqrt(3.) * area / static_cast<double>(N));
  Remeshed best;
  for(int attempt = 0; attempt < 12 && (attempt == 0 || miss(best.mesh.number_of_vertices(), N) > 0.003);
      ++attempt) {
    Remeshed next = remesh_isotropically(fine, length);
    const std::size_t n = next.mesh.number_of_vertices();
    if(n < 4)
      length /= 2;
    else // the damping keeps a jump from being answered by the jump back
      length *= std::pow(static_cast<double>(n) / static_cast<double>(N), attempt < 4 ? 0.5 : 0.3);
    if(attempt == 0 || miss(n, N) < miss(best.mesh.number_of_vertices(), N))
      best = std::move(next);
  }
  Coarse_mesh result;
  result.mesh = converted<Mesh>(best.mesh);
  result.seconds = best.seconds;
  if(miss(result.mesh.number_of_vertices(), N) > 0.01)
    result.note = "No edge length was found that gives " + std::to_string(N) + " vertices within 1 %.";
  return result;
}

#ifdef SPECTRAL_COMPARE_HAS_ACVD
// It adds vertices where a cluster would not give a manifold, on borders for instance: then fewer are asked
// for. The time is that of the best run alone.
Coarse_mesh centroidal(const Mesh& input, std::size_t N)
{
  const Robust_mesh fine = converted<Robust_mesh>(input);
  double wanted = static_cast<double>(N);
  Remeshed best;
  for(int attempt = 0; attempt < 6 && (attempt == 0 || miss(best.mesh.number_of_vertices(), N) > 0.003);
      ++attempt) {
    Remeshed next;
    next.mesh = fine;
    const auto begin = std::chrono::steady_clock::now();
    PMP::approximated_centroidal_Voronoi_diagram_remeshing(next.mesh, static_cast<std::size_t>(wanted),
                                                           CGAL::parameters::random_seed(0));
    next.seconds = seconds_since(begin);
    next.mesh.collect_garbage();
    const std::size_t n = next.mesh.number_of_vertices();
    wanted = (std::max)(4., std::round(wanted * static_cast<double>(N) / static_cast<double>(n)));
    if(attempt == 0 || miss(n, N) < miss(best.mesh.number_of_vertices(), N))
      best = std::move(next);
  }
  Coarse_mesh result;
  result.mesh = converted<Mesh>(best.mesh);
  result.seconds = best.seconds;
  if(miss(result.mesh.number_of_vertices(), N) > 0.01)
    result.note = "No number of clusters was found that gives " + std::to_string(N) + " vertices within 1 %.";
  return result;
}
#endif

} // namespace

std::vector<Simplifier> remeshers(const Mesh& fine, std::vector<std::string>& notes)
{
  std::vector<Simplifier> result;
  result.push_back({"isotropic remeshing", "none", "none", 0, isotropic});
#ifdef SPECTRAL_COMPARE_HAS_ACVD
  Mesh mesh = fine;
  auto components = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:component").first;
  if(PMP::connected_components(mesh, components) == 1)
    result.push_back({"centroidal Voronoi remeshing", "none", "none", 0, centroidal});
  else
    notes.push_back("Centroidal Voronoi remeshing was left out: CGAL's takes meshes of one component only.");
#else
  (void)fine;
  notes.push_back("Centroidal Voronoi remeshing was left out: this CGAL does not have it (6.1 does).");
#endif
  return result;
}
