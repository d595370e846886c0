// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_COMPARISON_JSON_H
#define SPECTRAL_EXAMPLES_REPORT_COMPARISON_JSON_H

#include "Comparison.h"
#include "json_text.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <vector>

// The comparison for programs: one object per result and mass under "rows", rivals that were
// refused under "refused". Numbers that were not computed are null.

namespace comparison_json_internal {

inline nlohmann::json vector(const Eigen::VectorXd& x)
{
  return std::vector<double>(x.data(), x.data() + x.size());
}

inline nlohmann::json norms(const std::optional<Map_norms>& n)
{
  if(!n)
    return nlohmann::json();
  return {{"norm_L", number_json(n->norm_L)},
          {"norm_D", number_json(n->norm_D)},
          {"norm_D_extended", number_json(n->norm_D_extended)},
          {"norm_L_input_scale", number_json(n->norm_L_input_scale)},
          {"norm_L_common_scale", number_json(n->norm_L_common_scale)},
          {"norm_D_input_scale", number_json(n->norm_D_input_scale)}};
}

inline nlohmann::json distance_errors(const Distance_errors& d)
{
  return {{"diffusion", number_json(d.diffusion)},
          {"biharmonic", number_json(d.biharmonic)},
          {"commute_time", number_json(d.commute_time)},
          {"wave_kernel", number_json(d.wave_kernel)},
          {"heat_kernel_signature", number_json(d.heat_kernel_signature)},
          {"wave_kernel_signature", number_json(d.wave_kernel_signature)}};
}

inline nlohmann::json row(const Simplified& s, const Judgement& j)
{
  const Shape_measures& m = s.shape;
  return {{"simplifier", s.simplifier},
          {"placement", s.placement},
          {"relocation", s.relocation},
          {"shape", number_json(s.shape_term)},
          {"metric_mass", s.metric_mass},
          {"judged_mass", j.mass},
          {"requested_vertices", s.requested_vertices},
          {"vertices", s.vertices},
          {"faces", s.faces},
          {"note", s.note},
          {"seconds", number_json(s.seconds)},
          {"seconds_eigenpairs", number_json(s.seconds_eigenpairs)},
          {"seconds_total", number_json(s.seconds_total())},
          {"carried_P", norms(j.carried)},
          {"closest_point_P", norms(j.closest)},
          {"floor_norm_L", number_json(j.floor_norm_L)},
          {"floor_norm_D", number_json(j.floor_norm_D)},
          {"span_loss", number_json(j.span_loss)},
          {"eigenvalue_error_mean", number_json(j.error_mean)},
          {"eigenvalue_error_max", number_json(j.error_max)},
          {"eigenvalue_error_low_mean", number_json(j.error_low_mean)},
          {"eigenvalue_error_beyond_mean", number_json(j.error_beyond_mean)},
          {"eigenvalue_error_beyond_max", number_json(j.error_beyond_max)},
          {"eigenvalue_error_input_scale_mean", number_json(j.error_input_scale_mean)},
          {"eigenvalue_error_input_scale_max", number_json(j.error_input_scale_max)},
          {"eigenvalue_error_input_scale_low_mean", number_json(j.error_input_scale_low_mean)},
          {"distance_errors", distance_errors(j.distances)},
          {"distance_errors_by", j.distances_by},
          {"smallest_angle_degrees", number_json(m.smallest_angle)},
          {"largest_aspect_ratio", number_json(m.largest_aspect_ratio)},
          {"self_intersections", number_json(m.self_intersections)},
          {"rows_off_their_part", number_json(m.rows_off_their_part)},
          {"hausdorff_over_diagonal", number_json(m.hausdorff)},
          {"volume_ratio", number_json(m.volume_ratio)},
          {"area_ratio", number_json(m.area_ratio)},
          {"bytes_per_vertex", number_json(m.bytes_per_vertex)},
          {"coarse_eigenvalues", vector(j.coarse_values)}};
}

} // namespace comparison_json_internal

inline nlohmann::json to_json(const Comparison& c)
{
  using namespace comparison_json_internal;
  nlohmann::json json = {{"program", c.program},
                         {"command", c.command},
                         {"mesh", c.mesh},
                         {"vertices", c.vertices},
                         {"faces", c.faces},
                         {"area", number_json(c.area)},
                         {"diagonal", number_json(c.diagonal)},
                         {"closed", c.closed},
                         {"components", c.components},
                         {"K", c.K},
                         {"sources", c.sources},
                         {"seed", c.seed},
                         {"threads", c.threads},
                         {"cgal_version", c.cgal_version},
                         {"compiler", c.compiler},
                         {"notes", c.notes},
                         {"fine", nlohmann::json::array()},
                         {"rows", nlohmann::json::array()},
                         {"refused", nlohmann::json::array()}};
  for(const Fine_spectrum& f : c.fine)
    json["fine"].push_back({{"mass", f.mass},
                            {"seconds_eigenpairs", number_json(f.seconds)},
                            {"largest_residual", number_json(f.largest_residual)},
                            {"eigenvalues", vector(f.values)}});
  for(const Simplified& s : c.results)
    for(const Judgement& j : s.judgements)
      json["rows"].push_back(row(s, j));
  for(const Refused& r : c.refused)
    json["refused"].push_back({{"simplifier", r.name}, {"reason", r.reason}});
  return json;
}

#endif // SPECTRAL_EXAMPLES_REPORT_COMPARISON_JSON_H
