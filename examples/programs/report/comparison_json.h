// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_COMPARISON_JSON_H
#define SPECTRAL_EXAMPLES_REPORT_COMPARISON_JSON_H

#include "Comparison.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <vector>

// The comparison for programs: one object per result and mass under "rows". Numbers that were not computed
// are null.

namespace comparison_json_internal {

inline nlohmann::json number(double x)
{
  return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json();
}

inline nlohmann::json vector(const Eigen::VectorXd& x)
{
  return std::vector<double>(x.data(), x.data() + x.size());
}

inline nlohmann::json norms(const std::optional<Map_norms>& n)
{
  if(!n)
    return nlohmann::json();
  return {{"norm_L", number(n->norm_L)},
          {"norm_D", number(n->norm_D)},
          {"norm_D_extended", number(n->norm_D_extended)},
          {"norm_L_input_scale", number(n->norm_L_input_scale)},
          {"norm_L_common_scale", number(n->norm_L_common_scale)},
          {"norm_D_input_scale", number(n->norm_D_input_scale)}};
}

inline nlohmann::json distance_errors(const Distance_errors& d)
{
  return {{"diffusion", number(d.diffusion)},
          {"biharmonic", number(d.biharmonic)},
          {"commute_time", number(d.commute_time)},
          {"wave_kernel", number(d.wave_kernel)},
          {"heat_kernel_signature", number(d.heat_kernel_signature)},
          {"wave_kernel_signature", number(d.wave_kernel_signature)}};
}

inline nlohmann::json row(const Simplified& s, const Judgement& j)
{
  const Shape_measures& m = s.shape;
  return {{"simplifier", s.simplifier},
          {"placement", s.placement},
          {"relocation", s.relocation},
          {"shape", number(s.shape_term)},
          {"metric_mass", s.metric_mass},
          {"judged_mass", j.mass},
          {"requested_vertices", s.requested_vertices},
          {"vertices", s.vertices},
          {"faces", s.faces},
          {"note", s.note},
          {"seconds", number(s.seconds)},
          {"seconds_eigenpairs", number(s.seconds_eigenpairs)},
          {"seconds_total", number(s.seconds_total())},
          {"carried_P", norms(j.carried)},
          {"closest_point_P", norms(j.closest)},
          {"floor_norm_L", number(j.floor_norm_L)},
          {"floor_norm_D", number(j.floor_norm_D)},
          {"eigenvalue_error_mean", number(j.error_mean)},
          {"eigenvalue_error_max", number(j.error_max)},
          {"eigenvalue_error_low_mean", number(j.error_low_mean)},
          {"eigenvalue_error_beyond_mean", number(j.error_beyond_mean)},
          {"eigenvalue_error_beyond_max", number(j.error_beyond_max)},
          {"eigenvalue_error_input_scale_mean", number(j.error_input_scale_mean)},
          {"distance_errors", distance_errors(j.distances)},
          {"distance_errors_by", j.distances_by},
          {"smallest_angle_degrees", number(m.smallest_angle)},
          {"largest_aspect_ratio", number(m.largest_aspect_ratio)},
          {"self_intersections", number(m.self_intersections)},
          {"hausdorff_over_diagonal", number(m.hausdorff)},
          {"volume_ratio", number(m.volume_ratio)},
          {"area_ratio", number(m.area_ratio)},
          {"bytes_per_vertex", number(m.bytes_per_vertex)},
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
                         {"area", number(c.area)},
                         {"diagonal", number(c.diagonal)},
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
                         {"rows", nlohmann::json::array()}};
  for(const Fine_spectrum& f : c.fine)
    json["fine"].push_back({{"mass", f.mass},
                            {"seconds_eigenpairs", number(f.seconds)},
                            {"largest_residual", number(f.largest_residual)},
                            {"eigenvalues", vector(f.values)}});
  for(const Simplified& s : c.results)
    for(const Judgement& j : s.judgements)
      json["rows"].push_back(row(s, j));
  return json;
}

#endif // SPECTRAL_EXAMPLES_REPORT_COMPARISON_JSON_H
