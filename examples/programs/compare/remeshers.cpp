// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// CGAL's remeshers as simplifiers. They make new vertices: P is that of the closest points.

#include "coarse_mesh.h"

#include <CGAL/Real_timer.h>
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
#include <cmath>
#include <stdexcept>

namespace PMP = CGAL::Polygon_mesh_processing;

namespace {

// The remeshers' constructions want exact predicates.
using Robust_kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Robust_mesh = CGAL::Surface_mesh<Robust_kernel::Point_3>;

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

// The best of some attempts at a remeshing with N vertices. `next(n, attempt)` says what to ask for
// where the mesh before had n, and `remesh(mesh, wanted)` does it. The time is that of the best run
// alone.
template <class Remesh, class Next>
Coarse_mesh closest_in_number(const Mesh& input, std::size_t N, double wanted, int attempts,
                              const Remesh& remesh, const Next& next, const std::string& what)
{
  const Robust_mesh fine = converted<Robust_mesh>(input);
  Robust_mesh best;
  Coarse_mesh result;
  for(int attempt = 0;
      attempt < attempts && (attempt == 0 || miss(best.number_of_vertices(), N) > 0.003);
      ++attempt) {
    Robust_mesh mesh = fine;
    CGAL::Real_timer timer;
    timer.start();
    remesh(mesh, wanted);
    mesh.collect_garbage();
    const double seconds = timer.time();
    const std::size_t n = mesh.number_of_vertices();
    wanted = next(wanted, n, attempt);
    if(attempt == 0 || miss(n, N) < miss(best.number_of_vertices(), N)) {
      best = std::move(mesh);
      result.seconds = seconds;
    }
  }
  result.mesh = converted<Mesh>(best);
  if(miss(result.mesh.number_of_vertices(), N) > 0.01)
    result.note =
        "No " + what + " was found that gives " + std::to_string(N) + " vertices within 1 %.";
  return result;
}

// The number of vertices falls about as the square of the edge length, with jumps: a search by that
// law.
Coarse_mesh isotropic(const Mesh& input, std::size_t N)
{
  const auto remesh = [](Robust_mesh& mesh, double edge_length) {
    PMP::isotropic_remeshing(
        faces(mesh), edge_length, mesh,
        CGAL::parameters::number_of_iterations(5).number_of_relaxation_steps(1));
  };
  const auto next = [N](double length, std::size_t n, int attempt) {
    if(n < 4)
      return length / 2;
    // the damping keeps a jump from being answered by the jump back
    return length *
           std::pow(static_cast<double>(n) / static_cast<double>(N), attempt < 4 ? 0.5 : 0.3);
  };
  const double length = std::sqrt(2 / std::sqrt(3.) * PMP::area(input) / static_cast<double>(N));
  return closest_in_number(input, N, length, 12, remesh, next, "edge length");
}

#ifdef SPECTRAL_COMPARE_HAS_ACVD
// It adds vertices where a cluster would not give a manifold, on borders for instance: then fewer
// are asked for.
Coarse_mesh centroidal(const Mesh& input, std::size_t N)
{
  const auto remesh = [](Robust_mesh& mesh, double clusters) {
    PMP::approximated_centroidal_Voronoi_diagram_remeshing(mesh, static_cast<std::size_t>(clusters),
                                                           CGAL::parameters::random_seed(0));
  };
  const auto next = [N](double clusters, std::size_t n, int) {
    return (std::max)(4., std::round(clusters * static_cast<double>(N) / static_cast<double>(n)));
  };
  return closest_in_number(input, N, static_cast<double>(N), 6, remesh, next, "number of clusters");
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
    notes.push_back(
        "Centroidal Voronoi remeshing was left out: CGAL's takes meshes of one component only.");
#else
  (void)fine;
  notes.push_back(
      "Centroidal Voronoi remeshing was left out: this CGAL does not have it (6.1 does).");
#endif
  return result;
}
