// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_OPTION_WORDS_H
#define SPECTRAL_EXAMPLES_OPTION_WORDS_H

#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

// The words in which the command line and Python speak of options; who reads them has checked that they are among these.
struct Option_words
{
  std::string preset;       // best, fast, paper
  std::size_t vertices = 0; // the target, for fast
  // Empty: as the preset has it.
  std::string placement;          // on_edge, midpoint, free
  std::string mass;               // lumped, averaged, voronoi
  std::string self_intersections; // allow, refuse
  std::string relocate;           // none, sampled, carried, carried_and_sampled
  std::optional<double> shape;
  std::optional<double> quadrics_above;
  std::string flips; // none, spectral, delaunay
};

// Whether these options have no use for quadrics_above, which was given; `said` says what to do about it.
inline bool quadrics_above_is_passed_over(
    const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options& options, std::string& said)
{
  said = " goes with free placement and a shape term, and not with coefficients, a binary restriction, "
         "a border to preserve, the Dirichlet condition or an error bound, where all collapses are those of "
         "the metric: "
         "leave it out.";
  return std::isfinite(options.quadrics_above) &&
         !CGAL::Surface_mesh_simplification::internal::quadrics_come_first(options);
}

// The preset and what overrides it.
inline CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options options_of(const Option_words& words)
{
  namespace SMS = CGAL::Surface_mesh_simplification;
  namespace SG = CGAL::Spectral_geometry;
  using Options = SMS::Spectral_edge_collapse_options;
  using Signals = SG::Relocation_options::Signals;
  Options options = words.preset == "paper"  ? Options::paper()
                    : words.preset == "fast" ? Options::fast(words.vertices)
                                             : Options::best();
  if(!words.placement.empty())
    options.placement = words.placement == "midpoint" ? SMS::Spectral_placement_strategy::midpoint
                        : words.placement == "free"   ? SMS::Spectral_placement_strategy::free
                                                      : SMS::Spectral_placement_strategy::on_edge;
  if(!words.mass.empty())
    options.mass = words.mass == "averaged"  ? SG::Mass::averaged
                   : words.mass == "voronoi" ? SG::Mass::voronoi
                                             : SG::Mass::lumped;
  options.operator_fit = SG::Operator_fit_options::for_mass(SG::mass_blend(options.mass));
  if(words.shape)
    options.shape = *words.shape;
  if(words.quadrics_above)
    options.quadrics_above = *words.quadrics_above;
  if(!words.self_intersections.empty())
    options.keep_free_of_self_intersections = words.self_intersections == "refuse";
  if(!words.relocate.empty()) {
    options.relocate = words.relocate != "none";
    options.relocation.signals = words.relocate == "carried"   ? Signals::carried
                                 : words.relocate == "sampled" ? Signals::sampled
                                                               : Signals::carried_and_sampled;
  }
  options.flips = words.flips == "spectral"   ? SG::Edge_flips::spectral
                  : words.flips == "delaunay" ? SG::Edge_flips::delaunay
                                              : SG::Edge_flips::none;
  return options;
}

// The name of a phase, that of its enumerator.
inline const char* phase_name(const CGAL::Surface_mesh_simplification::Spectral_phase phase)
{
  using Phase = CGAL::Surface_mesh_simplification::Spectral_phase;
  switch(phase) {
  case Phase::pre_simplification:
    return "pre_simplification";
  case Phase::eigenpairs:
    return "eigenpairs";
  case Phase::first_costs:
    return "first_costs";
  case Phase::flips:
    return "flips";
  case Phase::relocation:
    return "relocation";
  case Phase::operator_fit:
    return "operator_fit";
  case Phase::collapses:
    break;
  }
  return "collapses";
}

#endif // SPECTRAL_EXAMPLES_OPTION_WORDS_H
