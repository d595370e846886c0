// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_RUN_JSON_H
#define SPECTRAL_EXAMPLES_REPORT_RUN_JSON_H

#include "../option_words.h"
#include "json_text.h"

#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_result.h>

#include <nlohmann/json.hpp>

#include <string>

// What a run of spectral_edge_collapse() did and with what options: of --json, and the report of a
// run in Python.

// What the relocation did; null where there was none.
inline nlohmann::json
relocation_json(const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_result& result,
                const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options& options)
{
  if(!options.relocate)
    return nullptr;
  const CGAL::Spectral_geometry::Relocation_result& x = result.relocation;
  return {{"signals", relocation_word(options)},
          {"hausdorff_goal", number_json(options.relocation.hausdorff_goal)},
          {"steps", x.steps},
          {"stop_reason", x.stop_reason_name()},
          {"moved_vertices", x.moved_vertices},
          {"reverted_vertices", x.reverted_vertices},
          {"held_vertices",
           {{"fixed", x.held.fixed},
            {"trust", x.held.trust},
            {"boundary", x.held.boundary},
            {"sheet", x.held.sheet},
            {"triangles", x.held.triangles}}},
          {"E_before", x.E_before},
          {"E_after", x.E_after},
          {"seconds", x.seconds}};
}

// Whether P is that of closest points, or what the collapses carried.
inline const char*
restriction_word(const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_result& result)
{
  return result.relocation.resampled ? "closest_points" : "carried";
}

// What P is, a clause.
inline std::string restriction_in_words(
    const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_result& result,
    const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options& options)
{
  const std::string first =
      result.pre_simplified_vertices != 0 && result.pre_simplified_vertices < result.input_vertices
          ? "the mesh of " + std::to_string(result.pre_simplified_vertices) +
                " vertices that pre-simplification left, after its own merges"
          : "";
  if(result.relocation.resampled)
    return "closest points of " + (first.empty() ? "the input" : first) +
           ", found anew after relocation" +
           (options.boundary == CGAL::Spectral_geometry::Boundary_condition::dirichlet
                ? "; at the border the merges of the collapses"
                : "");
  return options.binary ? "one vertex of the input for each of the output, as the collapses chose"
                        : "the merges of the collapses, weighted by where the points were placed";
}

// `options`: what the preset became.
inline nlohmann::json
run_json(const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_result& result,
         const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options& options,
         const std::string& preset)
{
  return {{"input_vertices", result.input_vertices},
          {"output_vertices", result.output_vertices},
          {"preset", preset},
          {"eigenvectors", options.number_of_eigenvectors},
          {"mass", mass_name(options.mass)},
          {"boundary", word_of(boundary_words, options.boundary)},
          {"intrinsic_delaunay", bool(options.operator_of_eigenpairs)},
          {"placement", word_of(placement_words, options.placement)},
          {"shape", options.shape},
          {"quadrics_above", number_json(options.quadrics_above)},
          {"quadric_collapses", result.quadric_collapses},
          {"pre_simplified_vertices", result.pre_simplified_vertices},
          {"keep_free_of_self_intersections", options.keep_free_of_self_intersections},
          {"binary", options.binary},
          {"max_error", number_json(options.maximum_error)},
          {"kept_vertices", options.kept_vertices.size()},
          {"signals", options.signals.cols()},
          {"restriction", restriction_word(result)},
          {"relocation", relocation_json(result, options)},
          {"relative_error", number_json(result.relative_error)},
          {"stop_reason", result.stop_reason_name()},
          {"explanation", result.explanation},
          {"warnings", result.warnings},
          {"refusals",
           {{"topology", result.refusals.topology},
            {"geometry", result.refusals.geometry},
            {"filter", result.refusals.filter},
            {"placement", result.refusals.placement},
            {"crossing", result.refusals.crossing}}},
          {"seconds_pre_simplification", result.seconds_pre_simplification},
          {"seconds_eigenpairs", result.seconds_eigenpairs},
          {"seconds_collapse", result.seconds_collapse},
          {"seconds_relocation", result.seconds_relocation},
          {"seconds_total", result.seconds_total}};
}

#endif // SPECTRAL_EXAMPLES_REPORT_RUN_JSON_H
