// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_MATCHING_REPORT_H
#define SPECTRAL_EXAMPLES_MATCHING_MATCHING_REPORT_H

#include "../io/program.h"
#include "../report/html_report.h"
#include "../report/json_text.h"
#include "../report/mesh_picture.h"
#include "matcher.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

// A part of the work, for X and Y side by side.
struct Stage
{
  std::string name;
  double seconds = 0;
  double peak = 0; // bytes that the process had at most, up to its end
};

// One way to match X and Y, with what it cost and how well it went.
struct Matching_result
{
  std::string proxy;
  std::size_t vertices = 0; // of the meshes that were matched; of X's, where they differ
  Match match;
  std::vector<Stage> stages;  // from reading to the lift, the same for all results
  std::vector<double> errors; // ascending; empty without a ground truth

  double seconds() const
  {
    double sum = 0;
    for(const Stage& stage : stages)
      sum += stage.seconds;
    return sum;
  }

  double mean_error() const
  {
    double sum = 0;
    for(const double e : errors)
      sum += e;
    return errors.empty() ? std::numeric_limits<double>::quiet_NaN()
                          : sum / static_cast<double>(errors.size());
  }

  // The part of the errors that are at most x.
  double part_below(double x) const
  {
    return static_cast<double>(std::upper_bound(errors.begin(), errors.end(), x) - errors.begin()) /
           static_cast<double>(errors.size());
  }

  double quantile(double q) const
  {
    return errors.empty()
               ? std::numeric_limits<double>::quiet_NaN()
               : errors[static_cast<std::size_t>(q * static_cast<double>(errors.size() - 1))];
  }
};

struct Matching_comparison
{
  std::string command, X, Y, mass, matcher;
  long modes = 0;
  std::size_t landmarks = 0;
  const Shape *shape_X = nullptr, *shape_Y = nullptr;
  std::vector<Matching_result> results;
};

// Without the maps. Numbers that were not computed are null.
inline nlohmann::json to_json(const Matching_comparison& c)
{
  nlohmann::json json = {{"program", "shape_matching"},
                         {"command", c.command},
                         {"X", c.X},
                         {"Y", c.Y},
                         {"vertices_X", c.shape_X->read().V.rows()},
                         {"vertices_Y", c.shape_Y->read().V.rows()},
                         {"matched_vertices_X", c.shape_X->matrices.V.rows()},
                         {"matched_vertices_Y", c.shape_Y->matrices.V.rows()},
                         {"mass", c.mass},
                         {"modes", c.modes},
                         {"landmarks", c.landmarks},
                         {"results", nlohmann::json::array()}};
  for(const Matching_result& r : c.results) {
    nlohmann::json stages = nlohmann::json::array();
    for(const Stage& stage : r.stages)
      stages.push_back({{"stage", stage.name},
                        {"seconds", stage.seconds},
                        {"peak_megabytes_so_far", stage.peak / 1e6}});
    json["results"].push_back({{"proxy", r.proxy},
                               {"vertices", r.vertices},
                               {"stages", stages},
                               {"seconds", r.seconds()},
                               {"condition", number_json(r.match.condition)},
                               {"errors_measured_at", r.errors.size()},
                               {"error_mean", number_json(r.mean_error())},
                               {"error_median", number_json(r.quantile(0.5))},
                               {"error_90_percent", number_json(r.quantile(0.9))},
                               {"error_max", number_json(r.quantile(1))},
                               {"part_below_0.05", number_json(r.part_below(0.05))}});
  }
  return json;
}

inline void print_matching(const Matching_comparison& c)
{
  const std::string title = "seconds, proxy";
  std::size_t width = title.size();
  for(const Matching_result& r : c.results)
    width = (std::max)(width, printable(r.proxy).size());
  std::printf("%-*s %8s", static_cast<int>(width), title.c_str(), "vertices");
  for(const Stage& stage : c.results.front().stages)
    std::printf(" %10s", stage.name.c_str());
  std::printf(" %10s %10s %10s\n", "total", "mean error", "below 0.05");
  for(const Matching_result& r : c.results) {
    std::printf("%-*s %8zu", static_cast<int>(width), printable(r.proxy).c_str(), r.vertices);
    for(const Stage& stage : r.stages)
      std::printf(" %10.2f", stage.seconds);
    std::printf(" %10.2f", r.seconds());
    if(r.errors.empty())
      std::printf(" %10s %10s\n", "-", "-");
    else
      std::printf(" %10.4f %8.1f %%\n", r.mean_error(), 100 * r.part_below(0.05));
  }
}

namespace matching_report_internal {

inline std::string result_table(const Matching_comparison& c)
{
  using namespace html_internal;
  std::vector<std::string> names = {"proxy", "vertices"};
  for(const Stage& stage : c.results.front().stages)
    names.push_back(stage.name + ", s");
  for(const char* name : {"total, s", "condition", "mean error", "median", "90 %", "largest"})
    names.push_back(name);
  std::string html = "<table>\n" + heading_row(names, 1);
  for(const Matching_result& r : c.results) {
    html += "<tr>" + cell(escaped(r.proxy), "td", "l") + cell(std::to_string(r.vertices));
    for(const Stage& stage : r.stages)
      html += cell(formatted(stage.seconds));
    for(const double x : {r.seconds(), r.match.condition, r.mean_error(), r.quantile(0.5),
                          r.quantile(0.9), r.quantile(1)})
      html += cell(formatted(x));
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

inline std::string error_curves(const Matching_comparison& c)
{
  Plot plot;
  plot.title = "Vertices that are at most so far from the truth";
  plot.x_label = "geodesic distance / square root of the area";
  plot.y_label = "per cent";
  plot.width = 620;
  plot.height = 400;
  std::string legend = "<ul class='legend'>\n";
  for(std::size_t i = 0; i < c.results.size(); ++i) {
    Curve curve;
    curve.name = c.results[i].proxy;
    curve.style = line_style(i, i);
    curve.markers = false;
    for(int k = 0; k <= 100; ++k) {
      curve.x.push_back(0.0025 * k);
      curve.y.push_back(100 * c.results[i].part_below(0.0025 * k));
    }
    legend += "<li>" + svg_sample(curve.style, false) + escaped(curve.name) + "</li>\n";
    plot.curves.push_back(curve);
  }
  return legend + "</ul>\n" + svg(plot);
}

inline std::string figure(const std::string& picture, const std::string& caption)
{
  return "<figure class='wide'><img alt='" + escaped(caption) + "' src='" + picture +
         "'><figcaption>" + escaped(caption) + "</figcaption></figure>\n";
}

inline std::string pictures(const Matching_comparison& c)
{
  const Eigen::MatrixXd colours = colours_by_position(c.shape_Y->read().V);
  Picture picture;
  picture.colours = colours;
  std::string html =
      "<div class='figures'>\n" + figure(mesh_picture(c.shape_Y->read(), picture), "Y: " + c.Y);
  for(const Matching_result& r : c.results) {
    picture.colours.resize(c.shape_X->read().V.rows(), 3);
    for(std::size_t i = 0; i < r.match.map.size(); ++i)
      picture.colours.row(static_cast<Eigen::Index>(i)) = colours.row(r.match.map[i]);
    html += figure(mesh_picture(c.shape_X->read(), picture), "X: " + c.X + ", proxy " + r.proxy);
  }
  return html + "</div>\n";
}

} // namespace matching_report_internal

// The page: no network, no JavaScript, no other file.
inline std::string matching_page(const Matching_comparison& c)
{
  using namespace matching_report_internal;
  using html_internal::cell;
  std::string html = "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>"
                     "<meta name='viewport' content='width=device-width'><title>Matching " +
                     escaped(c.X) + " and " + escaped(c.Y) + "</title>\n<style>" +
                     html_internal::style() + "</style></head><body>\n<h1>Matching of " +
                     escaped(c.X) + " and " + escaped(c.Y) + "</h1>\n<table>\n";
  const auto fact = [&](const std::string& name, const std::string& value) {
    html += "<tr>" + cell(name, "td", "l") + cell(value, "td", "l") + "</tr>\n";
  };
  const auto sizes = [&](const Eigen::MatrixXd& X, const Eigen::MatrixXd& Y) {
    return std::to_string(X.rows()) + " and " + std::to_string(Y.rows()) + " vertices";
  };
  fact("X, Y", sizes(c.shape_X->read().V, c.shape_Y->read().V));
  if(c.shape_X->full || c.shape_Y->full)
    fact("Reduced to", sizes(c.shape_X->matrices.V, c.shape_Y->matrices.V));
  fact("Eigenvectors, mass", std::to_string(c.modes) + ", " + escaped(c.mass));
  fact("Matcher", escaped(c.matcher));
  fact("Landmarks", std::to_string(c.landmarks));
  fact("Command", "<code>" + escaped(c.command) + "</code>");
  html += "</table>\n<h2>Times and geodesic errors</h2>\n" + result_table(c);
  html += "<p class='note'>Errors: geodesic distances on Y to the true vertex, in square roots of "
          "its area (heat "
          "method). Condition: of the map that the lift inverts, fine to coarse; 1 when nothing "
          "was lost.</p>\n";
  if(!c.results.empty() && !c.results.front().errors.empty())
    html += error_curves(c);
  html += "<h2>Colours of Y carried to X</h2>\n" + pictures(c);
  return html + "</body></html>\n";
}

#endif // SPECTRAL_EXAMPLES_MATCHING_MATCHING_REPORT_H
