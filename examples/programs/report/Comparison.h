// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_COMPARISON_H
#define SPECTRAL_EXAMPLES_REPORT_COMPARISON_H

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// What a comparison found: plain data, filled by the programs, written as a table, JSON or a page.
// A number that was not computed is NaN.

constexpr double not_computed = std::numeric_limits<double>::quiet_NaN();

// The norms of one functional map, not squared; unit area unless the name says otherwise.
struct Map_norms
{
  double norm_L = not_computed, norm_D = not_computed, norm_D_extended = not_computed;
  double norm_L_input_scale = not_computed, norm_L_common_scale = not_computed;
  double norm_D_input_scale = not_computed;
};

// Mean relative errors of distances and signatures on the coarse mesh, see distance_errors().
struct Distance_errors
{
  double diffusion = not_computed, biharmonic = not_computed, commute_time = not_computed,
         wave_kernel = not_computed, heat_kernel_signature = not_computed,
         wave_kernel_signature = not_computed;
};

// A coarse mesh judged in one mass.
struct Judgement
{
  std::string mass;                 // in which fine and coarse eigenpairs are compared
  std::optional<Map_norms> carried; // with the simplifier's own P
  std::optional<Map_norms> closest; // with that of the closest points of the fine surface
  double floor_norm_L = not_computed, floor_norm_D = not_computed;
  double span_loss = not_computed;                                          // meshes only
  double error_mean = not_computed, error_max = not_computed;               // eigenvalues 1..K
  double error_low_mean = not_computed;                                     // 2..K/5
  double error_beyond_mean = not_computed, error_beyond_max = not_computed; // K+1..1.5K
  double error_input_scale_mean = not_computed, error_input_scale_max = not_computed,
         error_input_scale_low_mean = not_computed;
  Distance_errors distances;
  std::string distances_by;      // "carried" or "closest point": the P of the errors of distances
  Eigen::VectorXd coarse_values; // at unit area
  Eigen::MatrixXd C; // of the carried P if there is one, coarse modes aligned with fine ones

  // The norms that the tables show first.
  const Map_norms& norms() const { return carried ? *carried : *closest; }
};

// Quality of the coarse mesh as a surface.
struct Shape_measures
{
  double smallest_angle = not_computed; // degrees
  double largest_aspect_ratio = not_computed;
  double self_intersections = not_computed;  // pairs of faces
  double rows_off_their_part = not_computed; // of the P that is judged first
  double hausdorff = not_computed;    // symmetric, relative to the diagonal of the fine mesh's box
  double volume_ratio = not_computed; // coarse over fine; closed meshes only
  double area_ratio = not_computed;   // coarse over fine
  // Coordinates as doubles and indices of 4 bytes; an operator: its nonzeros.
  double bytes_per_vertex = not_computed;
};

// One simplifier at one size.
struct Simplified
{
  std::string simplifier;           // "spectral", "Garland-Heckbert plane", ...
  std::string placement;            // "on_edge", "optimal", ...
  std::string relocation = "none";  // by which signals vertices were moved afterwards
  double shape_term = 0;            // its weight in a spectral metric
  std::string metric_mass = "none"; // the mass in the metric of the simplifier, if it has one
  std::size_t requested_vertices = 0, vertices = 0, faces = 0;
  double seconds = not_computed;            // simplification alone
  double seconds_eigenpairs = not_computed; // and the basis that it needs
  Shape_measures shape;
  std::string note; // a sentence where the result is not what was asked for
  std::vector<Judgement> judgements;

  bool has_mesh() const { return faces > 0; }

  double seconds_total() const
  {
    return seconds + (seconds_eigenpairs > 0 ? seconds_eigenpairs : 0.);
  }

  // Names a curve: all sizes have one name.
  std::string name() const
  {
    std::string text = simplifier;
    if(!placement.empty() && placement != "none")
      text += ", " + placement;
    if(metric_mass != "none")
      text += ", " + metric_mass + " metric";
    if(relocation != "none")
      text += ", relocated by " + relocation;
    return text;
  }
};

// A result of another program that could not be judged.
struct Refused
{
  std::string name, reason; // a sentence
};

// The fine spectrum in one mass.
struct Fine_spectrum
{
  std::string mass;
  Eigen::VectorXd values; // at unit area
  Eigen::Index zeros = 0; // how many of them, the first, are zero
  double seconds = not_computed;
  double largest_residual = not_computed;
};

struct Comparison
{
  std::string program, command; // what was run
  std::string mesh;             // and on what
  std::size_t vertices = 0, faces = 0;
  double area = not_computed, diagonal = not_computed; // in the mesh's own unit
  bool closed = false;
  std::size_t components = 0;
  Eigen::Index K = 0;
  std::size_t sources = 0; // of the distances
  unsigned seed = 0;
  int threads = 1;
  std::string cgal_version, compiler;
  std::vector<Fine_spectrum> fine;
  std::vector<Simplified> results; // ordered by size, then simplifier
  std::vector<Refused> refused;    // rivals
  std::vector<std::string> notes;  // what was left out, and why

  // What one run has, whose page is not a comparison:
  bool is_run = false;
  std::string restriction;                           // what P is, a clause
  std::vector<std::pair<std::string, double>> times; // what took how many seconds
};

#endif // SPECTRAL_EXAMPLES_REPORT_COMPARISON_H
