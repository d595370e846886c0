// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Simplifiers that collapse edges, all of them in CGAL's loop.

// CGAL's Lindstrom-Turk placement sets an optional vector in ways that GCC cannot follow.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include "../option_words.h"
#include "../simplification.h"
#include "collapse.h"

#include <CGAL/Real_timer.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_length_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_probabilistic_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_probabilistic_triangle_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_triangle_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Midpoint_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace SMS = CGAL::Surface_mesh_simplification;
namespace SG = CGAL::Spectral_geometry;

namespace {

template <class Policies>
Simplifier garland_heckbert(const std::string& name)
{
  return {"Garland-Heckbert " + name, "optimal", "none", 0, collapse_by_quadrics<Policies>};
}

template <class Policies>
Simplifier probabilistic_garland_heckbert(const std::string& name)
{
  return {"Garland-Heckbert probabilistic " + name + ", area 20000", "optimal", "none", 0,
          collapse_by_probabilistic_quadrics<Policies>};
}

template <class Cost, class Placement>
Simplifier plain(const std::string& name, const std::string& placement)
{
  return {name, placement, "none", 0, [](const Mesh& fine, std::size_t N) {
            return collapse(fine, N, [](Mesh&, const auto& run) { run(Cost(), Placement()); });
          }};
}

using Options = SMS::Spectral_edge_collapse_options;

Coarse_mesh simplify_spectrally(const Mesh& fine, std::size_t N, const Options& options)
{
  Coarse_mesh result;
  Mesh mesh = fine;
  CGAL::Real_timer timer;
  timer.start();
  result.carried = simplify_mesh(mesh, N, options).restriction;
  result.seconds = timer.time();
  result.note = note_on_size(mesh, N);
  // Without garbage, in the order of P; collect_garbage() has an order of its own.
  auto copy_of = mesh.add_property_map<Mesh::Vertex_index, Mesh::Vertex_index>("v:copy").first;
  for(const auto v : mesh.vertices())
    copy_of[v] = result.mesh.add_vertex(mesh.point(v));
  for(const auto f : mesh.faces()) {
    std::vector<Mesh::Vertex_index> corners;
    for(const auto v : vertices_around_face(mesh.halfedge(f), mesh))
      corners.push_back(copy_of[v]);
    result.mesh.add_face(corners);
  }
  return result;
}

Simplifier spectral(const std::string& name, Options options, const Basis& basis, int threads)
{
  options.mass = basis.mass;
  options.eigenpairs = basis.pairs;
  options.threads = threads;
  options.seed = basis.seed;
  return {
      name,
      word_of(placement_words, options.placement),
      SG::mass_name(basis.mass),
      basis.seconds,
      [options](const Mesh& fine, std::size_t N) { return simplify_spectrally(fine, N, options); },
      relocation_word(options),
      options.shape,
      false};
}

// The presets, in the mass of each, and what lies between them.
std::vector<Simplifier> spectral_simplifiers(const Mesh& fine, const Basis& basis, int threads)
{
  using Placement = SMS::Spectral_placement_strategy;
  using Signals = SG::Relocation_options::Signals;
  std::vector<Simplifier> result;
  const auto add = [&](const std::string& name, const Options& options) {
    result.push_back(spectral(name, options, basis, threads));
  };
  const auto with = [](Options options, const Placement placement) {
    options.placement = placement;
    return options;
  };
  const bool lumped = basis.mass == SG::Mass::lumped;
  const Options paper = Options::paper();
  Options best = Options::best();
  if(!lumped) {
    add("spectral, best", best);
    result.back().fits_operators = true;
  }
  if(!lumped && !CGAL::is_closed(fine)) {
    Options border = best;
    border.preserve_border = true;
    add("spectral, best, border preserved", border);
  }
  if(!lumped) {
    best.relocation.signals = Signals::carried_and_sampled;
    add("spectral with shape term", best);
  }
  best.relocate = false;
  add("spectral with shape term", best);
  add("spectral with shape term", with(best, Placement::on_edge));
  add(lumped ? "spectral, paper" : "spectral", paper);
  add("spectral", with(paper, Placement::midpoint));
  add("spectral", with(paper, Placement::free));
  return result;
}

} // namespace

Basis spectral_basis(const Mesh& fine, Eigen::Index K, SG::Mass mass)
{
  SMS::Spectral_options options;
  options.number_of_eigenvectors = K;
  options.mass = mass;
  CGAL::Real_timer timer;
  timer.start();
  const SG::Mesh_matrices matrices = SG::mesh_matrices(fine);
  auto pairs = SMS::internal::spectral_basis(matrices.V, matrices.T, options).eigenpairs;
  return {mass, std::move(pairs), timer.time()};
}

std::vector<Simplifier> collapse_simplifiers(const Mesh& fine, const std::vector<Basis>& bases,
                                             int threads)
{
  std::vector<Simplifier> result;
  for(const Basis& basis : bases)
    for(Simplifier& s : spectral_simplifiers(fine, basis, threads))
      result.push_back(std::move(s));
  result.push_back(garland_heckbert<SMS::GarlandHeckbert_plane_policies<Mesh, Kernel>>("plane"));
  result.push_back(
      garland_heckbert<SMS::GarlandHeckbert_triangle_policies<Mesh, Kernel>>("triangle"));
  result.push_back(probabilistic_garland_heckbert<
                   SMS::GarlandHeckbert_probabilistic_plane_policies<Mesh, Kernel>>("plane"));
  result.push_back(probabilistic_garland_heckbert<
                   SMS::GarlandHeckbert_probabilistic_triangle_policies<Mesh, Kernel>>("triangle"));
  result.push_back(plain<SMS::LindstromTurk_cost<Mesh>, SMS::LindstromTurk_placement<Mesh>>(
      "Lindstrom-Turk", "optimal"));
  result.push_back(
      plain<SMS::Edge_length_cost<Mesh>, SMS::Midpoint_placement<Mesh>>("edge length", "midpoint"));
  return result;
}
