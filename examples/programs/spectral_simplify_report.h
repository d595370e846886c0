// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_REPORT_H
#define SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_REPORT_H

#include "io/mesh_repair.h"
#include "io/program.h"
#include "io/text_lines.h"
#include "io/attributes.h"
#include "option_words.h"
#include "report/judgement.h"
#include "report/run_json.h"

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_toolbox/fitted_operators.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_result.h>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// What spectral_simplify says about a run: a table for people, JSON for programs.

// Operators that were fitted to the fine spectrum, and how they are judged.
struct Fitted_operators
{
  CGAL::Spectral_geometry::Operator_fit_options options;
  CGAL::Spectral_geometry::Operator_fit_result fit;
  double seconds = 0;
  CGAL::Spectral_geometry::Eigenpairs pairs; // 1.1 K
  CGAL::Spectral_geometry::Spectral_evaluation evaluation;
};

struct Simplification_report
{
  CGAL::Surface_mesh_simplification::Spectral_edge_collapse_result result;
  std::optional<CGAL::Spectral_geometry::Spectral_evaluation> evaluation;
  std::optional<Fitted_operators> fitted;
  std::size_t rows_off_their_part = 0; // of the restriction, once it was evaluated
  double seconds_reading = 0, seconds_writing = 0, seconds_evaluation = 0;

  std::string input, output, preset, operator_word;
  std::vector<std::string> attributes;   // names of those that were carried
  std::optional<std::size_t> seam_edges; // kept ones of the texture
  // What the preset became.
  CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options options;
  std::vector<Repair> repairs;       // what was changed in the input, and how often
  std::vector<std::size_t> left_out; // first vertices of components that were
  std::vector<std::size_t> levels;   // those that were written
};

// A figure at unit area and at the scale of the meshes, and what good linear elements of the same
// number have, or 0 when no estimate is known.
inline void print_figure(const char* name, const double unit, const double input, const char* after,
                         const double floor = 0)
{
  std::printf("  %-25s %8.2f%s %12.2f%s", name, unit, after, input, after);
  if(floor > 0)
    std::printf("%s(ideal linear elements: about %.2f)", *after == 0 ? "     " : "   ", floor);
  std::printf("\n");
}

// Where fitted operators have entries.
inline const char* mass_pattern_name(const CGAL::Spectral_geometry::Operator_fit_options& options)
{
  return options.mass == CGAL::Spectral_geometry::Operator_fit_options::Mass_pattern::diagonal
             ? "diagonal"
             : "edges";
}

inline void print_evaluation(const CGAL::Spectral_geometry::Spectral_evaluation& e,
                             const bool floors)
{
  print_figure("|C|_L", e.norm_L, e.norm_L_common_scale, "  ", floors ? e.floor_norm_L : 0);
  print_figure("|C|_D", e.norm_D, e.norm_D_input_scale, "  ", floors ? e.floor_norm_D : 0);
  if(e.errors.modes > 0) {
    print_figure("eigenvalue error, mean", 100 * e.errors.mean, 100 * e.errors_input_scale.mean,
                 " %");
    print_figure("eigenvalue error, largest", 100 * e.errors.max, 100 * e.errors_input_scale.max,
                 " %");
  }
  if(e.errors_low.modes > 0)
    print_figure(("its mean, modes 2 to " + std::to_string(e.judged_modes / 5)).c_str(),
                 100 * e.errors_low.mean, 100 * low_errors_at_input_scale(e).mean, " %");
  std::printf("  span loss                 %8.2f %%\n", 100 * e.span_loss);
}

// What took how many seconds, in the words of the table and of the page.
inline std::vector<std::pair<std::string, double>> times(const Simplification_report& r)
{
  using Source = CGAL::Surface_mesh_simplification::Spectral_signal_source;
  std::vector<std::pair<std::string, double>> result = {
      {"reading and checking", r.seconds_reading}};
  if(r.result.quadric_collapses != 0)
    result.emplace_back("collapses by quadrics", r.result.seconds_pre_simplification);
  result.emplace_back(r.options.source == Source::filtered_noise && r.options.signals.size() == 0
                          ? "filtered signals"
                          : "eigenpairs",
                      r.result.seconds_eigenpairs);
  result.emplace_back("collapses", r.result.seconds_collapse);
  if(r.options.relocate)
    result.emplace_back("relocation", r.result.seconds_relocation);
  result.emplace_back("writing", r.seconds_writing);
  result.emplace_back("total", r.seconds_reading + r.result.seconds_total + r.seconds_writing);
  if(r.evaluation)
    result.emplace_back("evaluation, not in total", r.seconds_evaluation);
  if(r.fitted)
    result.emplace_back("operator fit, likewise", r.fitted->seconds);
  return result;
}

inline void print_table(const Simplification_report& r)
{
  std::printf("%s, %zu vertices -> %s, %zu vertices (%s)\n\n", printable(r.input).c_str(),
              r.result.input_vertices, printable(r.output).c_str(), r.result.output_vertices,
              r.result.stop_reason_name());
  if(r.evaluation) {
    const auto& e = *r.evaluation;
    std::string of = r.operator_word == "cotangent" ? "" : " of " + printable(r.operator_word);
    if(r.options.boundary != CGAL::Spectral_geometry::Boundary_condition::neumann)
      of += std::string(", ") + word_of(boundary_words, r.options.boundary);
    const std::string what =
        std::to_string(e.judged_modes) + " eigenvectors" + of + ", " + e.mass + " mass";
    std::printf("  %-25s   unit area  scale of input\n", what.c_str());
    print_evaluation(e, true);
    std::printf("  rows off their part       %8zu\n", r.rows_off_their_part);
    std::printf("  %s of output / input    %8.4f\n\n",
                r.options.coefficients.rows() == 0 ? "area" : "mass", e.area_ratio);
  }
  if(r.fitted) {
    const auto& options = r.fitted->options;
    std::printf("  fitted operators, %d ring%s, mass: %s\n", options.rings,
                options.rings == 1 ? "" : "s", mass_pattern_name(options));
    print_evaluation(r.fitted->evaluation, false);
    std::printf("\n");
  }
  std::printf("  P: %s\n\n", restriction_in_words(r.result, r.options).c_str());
  std::printf("  relative error            %8.4f   (sqrt of E / sum lambda^2, see --max-error)\n\n",
              r.result.relative_error);
  if(r.options.relocate)
    std::printf("  relocated vertices        %8zu   (%d steps, ended by: %s)\n\n",
                r.result.relocation.moved_vertices, r.result.relocation.steps,
                r.result.relocation.stop_reason_name());
  if(r.seam_edges)
    std::printf("  kept edges of seams       %8zu\n\n", *r.seam_edges);
  if(!r.attributes.empty())
    std::printf("  carried attributes        %s\n\n", printable(joined(r.attributes)).c_str());
  for(const auto& [what, seconds] : times(r))
    std::printf("  %-25s %8.2f s\n", what.c_str(), seconds);
}

// All of them null where nothing was evaluated.
inline nlohmann::json
evaluation_json(const CGAL::Spectral_geometry::Spectral_evaluation* evaluation)
{
  const CGAL::Spectral_geometry::Spectral_evaluation none,
      &e = evaluation != nullptr ? *evaluation : none;
  const auto number = [&](const double x) {
    return evaluation != nullptr ? number_json(x) : nlohmann::json();
  };
  return {{"norm_L", number(e.norm_L)},
          {"norm_D", number(e.norm_D)},
          {"norm_L_input_scale", number(e.norm_L_input_scale)},
          {"norm_L_common_scale", number(e.norm_L_common_scale)},
          {"norm_D_input_scale", number(e.norm_D_input_scale)},
          {"norm_D_extended", number(e.norm_D_extended)},
          {"floor_norm_L", number(e.floor_norm_L)},
          {"floor_norm_D", number(e.floor_norm_D)},
          {"span_loss", number(e.span_loss)},
          {"eigenvalue_error_mean", number(e.errors.mean)},
          {"eigenvalue_error_max", number(e.errors.max)},
          {"eigenvalue_error_low_mean", number(e.errors_low.mean)},
          {"eigenvalue_error_input_scale_mean", number(e.errors_input_scale.mean)},
          {"eigenvalue_error_input_scale_max", number(e.errors_input_scale.max)},
          {"eigenvalue_error_input_scale_low_mean",
           number(evaluation != nullptr ? low_errors_at_input_scale(e).mean : 0)},
          {"area_ratio", number(e.area_ratio)}};
}

inline nlohmann::json to_json(const Simplification_report& r)
{
  nlohmann::json json = run_json(r.result, r.options, r.preset);
  json.update({{"operator", r.operator_word},
               {"levels", r.levels},
               {"attributes", r.attributes},
               {"seam_edges", r.seam_edges ? nlohmann::json(*r.seam_edges) : nlohmann::json()},
               {"seconds_reading", r.seconds_reading},
               {"seconds_writing", r.seconds_writing},
               {"left_out", r.left_out},
               {"repairs", nlohmann::json::object()}});
  for(const Repair& repair : r.repairs)
    json["repairs"][repair.many] = repair.count; // one key whatever the count
  json.update(evaluation_json(r.evaluation ? &*r.evaluation : nullptr));
  json["rows_off_their_part"] =
      r.evaluation ? nlohmann::json(r.rows_off_their_part) : nlohmann::json();
  json["seconds_evaluation"] =
      r.evaluation ? nlohmann::json(r.seconds_evaluation) : nlohmann::json();
  if(r.fitted) {
    json["fitted"] = evaluation_json(&r.fitted->evaluation);
    const auto& fit = r.fitted->fit;
    json["fitted"].update({{"mass_pattern", mass_pattern_name(r.fitted->options)},
                           {"rings", r.fitted->options.rings},
                           {"unknowns", fit.unknowns},
                           {"at_bound", fit.at_bound},
                           {"iterations", fit.iterations},
                           {"converged", fit.converged},
                           {"objective_before", fit.objective_before},
                           {"objective_after", fit.objective_after},
                           {"seconds", r.fitted->seconds}});
  } else
    json["fitted"] = nullptr;
  return json;
}

#endif // SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_REPORT_H
