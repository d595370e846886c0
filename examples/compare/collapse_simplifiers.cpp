// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Simplifiers that collapse edges, all of them in CGAL's loop.

// CGAL's Lindstrom-Turk placement sets an optional vector in ways that GCC cannot follow.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include "coarse_mesh.h"

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_length_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_probabilistic_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_probabilistic_triangle_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_triangle_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Midpoint_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Restriction_visitor.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/spectral_relocation.h>

#include <chrono>
#include <utility>

namespace SMS = CGAL::Surface_mesh_simplification;
namespace SG = CGAL::Spectral_geometry;

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string note_on_size(const Mesh& mesh, std::size_t N)
{
  return mesh.number_of_vertices() > N ? "It ran out of edges that may be collapsed at " +
                                             std::to_string(mesh.number_of_vertices()) + " vertices."
                                       : "";
}

// `make_policies(mesh)` returns a pair of cost and placement; to make them is part of the time.
template <class Make_policies>
Coarse_mesh collapse(const Mesh& fine, std::size_t N, const Make_policies& make_policies)
{
  Coarse_mesh result;
  result.mesh = fine;
  const SMS::Restriction_visitor<Mesh> visitor(result.mesh);
  const auto begin = std::chrono::steady_clock::now();
  make_policies(result.mesh, [&](const auto& cost, const auto& placement) {
    SMS::edge_collapse(result.mesh, SMS::Vertex_count_stop_predicate<Mesh>(N, result.mesh),
                       CGAL::parameters::get_cost(cost).get_placement(placement).visitor(visitor));
  });
  result.seconds = seconds_since(begin);
  result.note = note_on_size(result.mesh, N);
  result.mesh.collect_garbage(); // reorders the vertices, and the visitor knows how
  result.carried = visitor.restriction();
  return result;
}

template <class Policies>
Simplifier garland_heckbert(const std::string& name)
{
  return {"Garland-Heckbert " + name, "optimal", "none", 0, [](const Mesh& fine, std::size_t N) {
            return collapse(fine, N, [](Mesh& mesh, const auto& run) {
              Policies policies(mesh);
              run(policies.get_cost(), policies.get_placement());
            });
          }};
}

template <class Cost, class Placement>
Simplifier plain(const std::string& name, const std::string& placement)
{
  return {name, placement, "none", 0, [](const Mesh& fine, std::size_t N) {
            return collapse(fine, N, [](Mesh&, const auto& run) { run(Cost(), Placement()); });
          }};
}

enum class Relocate {
  no,
  carried, // by the default signals: P stays
  sampled  // by signals at the closest points alone, where P is taken anew
};

struct Spectral_variant
{
  SMS::Spectral_placement_strategy placement;
  Relocate relocate = Relocate::no;
  bool preserve_border = false;
};

const char* relocation_name(Relocate relocate)
{
  return relocate == Relocate::no ? "none" : relocate == Relocate::carried ? "smoothed" : "sampled";
}

Coarse_mesh simplify_spectrally(const Mesh& fine, std::size_t N, const Basis& basis,
                                SMS::Spectral_options options, Relocate relocate)
{
  Coarse_mesh result;
  result.mesh = fine;
  options.metric_eigenvectors = SMS::metric_eigenvectors_for(N, basis.pairs->size());
  const auto begin = std::chrono::steady_clock::now();
  const SMS::Spectral_policies<Mesh> policies(result.mesh, options);
  SMS::edge_collapse(result.mesh, SMS::Vertex_count_stop_predicate<Mesh>(N, result.mesh),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .visitor(policies.visitor()));
  result.note = note_on_size(result.mesh, N);
  result.mesh.collect_garbage();
  result.carried = policies.restriction();
  if(relocate != Relocate::no) {
    SG::Relocation_options how;
    if(relocate == Relocate::sampled)
      how.signals = SG::Relocation_options::Signals::sampled;
    result.carried = SMS::spectral_relocation(result.mesh, *result.carried, SG::mesh_matrices(fine),
                                              *basis.pairs, basis.mass, how)
                         .restriction;
  }
  result.seconds = seconds_since(begin);
  return result;
}

Simplifier spectral(const Spectral_variant& variant, const Basis& basis, int threads)
{
  SMS::Spectral_options options;
  options.placement = variant.placement;
  options.preserve_border = variant.preserve_border;
  options.mass = basis.mass;
  options.eigenpairs = basis.pairs;
  options.number_of_eigenvectors = basis.pairs->size();
  options.threads = threads;
  return {variant.preserve_border ? "spectral, border preserved" : "spectral",
          SMS::placement_name(variant.placement),
          SG::mass_name(basis.mass),
          basis.seconds,
          [options, basis, relocate = variant.relocate](const Mesh& fine, std::size_t N) {
            return simplify_spectrally(fine, N, basis, options, relocate);
          },
          relocation_name(variant.relocate)};
}

std::vector<Spectral_variant> variants(const Mesh& fine, SG::Mass mass)
{
  using Placement = SMS::Spectral_placement_strategy;
  std::vector<Spectral_variant> result{{Placement::on_edge}, {Placement::midpoint}, {Placement::free}};
  if(mass != SG::Mass::averaged)
    return result;
  for(const Relocate relocate : {Relocate::carried, Relocate::sampled}) {
    result.push_back({Placement::on_edge, relocate});
    result.push_back({Placement::free, relocate});
    if(!CGAL::is_closed(fine))
      result.push_back({Placement::on_edge, relocate, true});
  }
  return result;
}

} // namespace

Basis spectral_basis(const Mesh& fine, Eigen::Index K, SG::Mass mass)
{
  Mesh mesh = fine;
  SMS::Spectral_options options;
  options.number_of_eigenvectors = K;
  options.mass = mass;
  const SMS::Spectral_policies<Mesh> policies(mesh, options);
  return {mass, policies.eigenpairs(), policies.state().seconds_basis()};
}

std::vector<Simplifier> collapse_simplifiers(const Mesh& fine, const std::vector<Basis>& bases, int threads)
{
  std::vector<Simplifier> result;
  for(const Basis& basis : bases)
    for(const Spectral_variant& variant : variants(fine, basis.mass))
      result.push_back(spectral(variant, basis, threads));
  result.push_back(garland_heckbert<SMS::GarlandHeckbert_plane_policies<Mesh, Kernel>>("plane"));
  result.push_back(garland_heckbert<SMS::GarlandHeckbert_triangle_policies<Mesh, Kernel>>("triangle"));
  result.push_back(garland_heckbert<SMS::GarlandHeckbert_probabilistic_plane_policies<Mesh, Kernel>>(
      "probabilistic plane"));
  result.push_back(garland_heckbert<SMS::GarlandHeckbert_probabilistic_triangle_policies<Mesh, Kernel>>(
      "probabilistic triangle"));
  result.push_back(
      plain<SMS::LindstromTurk_cost<Mesh>, SMS::LindstromTurk_placement<Mesh>>("Lindstrom-Turk", "optimal"));
  result.push_back(
      plain<SMS::Edge_length_cost<Mesh>, SMS::Midpoint_placement<Mesh>>("edge length", "midpoint"));
  return result;
}
