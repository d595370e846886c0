// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_HTML_FIGURES_H
#define SPECTRAL_EXAMPLES_REPORT_HTML_FIGURES_H

#include "Comparison.h"
#include "png_image.h"
#include "svg_plot.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

// The figures of the page, made from a comparison.
namespace html_internal {

// The sizes that were asked for, ascending.
inline std::vector<std::size_t> sizes(const Comparison& c)
{
  std::vector<std::size_t> result;
  for(const Simplified& s : c.results)
    result.push_back(s.requested_vertices);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// What was judged in a mass at a size.
inline std::vector<std::pair<const Simplified*, const Judgement*>>
judged(const Comparison& c, std::size_t N, const std::string& mass)
{
  std::vector<std::pair<const Simplified*, const Judgement*>> result;
  for(const Simplified& s : c.results)
    for(const Judgement& j : s.judgements)
      if(s.requested_vertices == N && j.mass == mass)
        result.emplace_back(&s, &j);
  return result;
}

inline std::vector<std::string> all_notes(const Comparison& c)
{
  std::vector<std::string> notes = c.notes;
  for(const Simplified& s : c.results)
    if(!s.note.empty())
      notes.push_back(s.name() + ", N = " + std::to_string(s.requested_vertices) + ": " + s.note);
  return notes;
}

// The names of all curves in order of appearance, each with its style: the colour of its family,
// the first word of the simplifier's name ("Garland-Heckbert"), and dashes by its place there.
inline std::vector<std::pair<std::string, Line_style>> styles(const Comparison& c)
{
  std::vector<std::pair<std::string, Line_style>> result;
  std::vector<std::string> families;
  std::map<std::string, std::size_t> variants;
  for(const Simplified& s : c.results) {
    const std::string name = s.name();
    if(std::any_of(result.begin(), result.end(), [&](const auto& p) { return p.first == name; }))
      continue;
    const std::string family = s.simplifier.substr(0, s.simplifier.find(' '));
    auto place = std::find(families.begin(), families.end(), family);
    if(place == families.end())
      place = families.insert(place, family);
    result.emplace_back(
        name, line_style(static_cast<std::size_t>(place - families.begin()), variants[family]++));
  }
  return result;
}

inline Line_style style_of(const Comparison& c, const std::string& name)
{
  for(const auto& [other, style] : styles(c))
    if(other == name)
      return style;
  return {};
}

inline std::string legend(const Comparison& c, bool markers)
{
  std::string html = "<ul class='legend'>\n";
  if(!markers)
    html += "<li>" + svg_sample({"#999999", "", 0}, false) + "fine mesh</li>\n";
  for(const auto& [name, style] : styles(c))
    html += "<li>" + svg_sample(style, markers) + escaped(name) + "</li>\n";
  return html + "</ul>\n";
}

inline std::string norm_bars(const Comparison& c, const std::string& mass)
{
  std::string html;
  for(const std::size_t N : sizes(c)) {
    Bars L, D;
    for(const auto& [s, j] : judged(c, N, mass))
      for(Bars* bars : {&L, &D}) {
        bars->names.push_back(s->name());
        bars->styles.push_back(style_of(c, s->name()));
        bars->values.push_back(bars == &L ? j->norms().norm_L : j->norms().norm_D);
        (bars == &L ? L : D).floor = bars == &L ? j->floor_norm_L : j->floor_norm_D;
      }
    const std::string at = ", N = " + std::to_string(N) + ", " + mass + " mass";
    L.title = "Laplacian commutativity" + at;
    L.label = "|C|_L (unit area)";
    D.title = "Orthonormality" + at;
    D.label = "|C|_D (unit area)";
    html += "<div class='figures bars'>" + svg(L) + svg(D) + "</div>\n";
  }
  return html;
}

// What the shades of the maps mean.
inline std::string shade_scale()
{
  std::string html = svg_begin(300, 34, "scale of the maps");
  for(int i = 0; i < 100; ++i) {
    const auto colour = sequential_colour((i + 0.5) / 100);
    html += "<rect x='" + std::to_string(20 + 2 * i) +
            "' y='2' width='2.5' height='12' fill='rgb(" + std::to_string(colour[0]) + "," +
            std::to_string(colour[1]) + "," + std::to_string(colour[2]) + ")'/>";
  }
  html += "<rect x='20' y='2' width='200' height='12' fill='none' stroke='#999'/>";
  for(const auto& [x, label] :
      {std::pair<int, const char*>{20, "0"}, {120, "0.5"}, {220, "1 and above"}})
    html += svg_internal::text(x, 28, label, "text-anchor='middle'");
  return html + "</svg>\n";
}

// Maps side by side, all at the same scale.
inline std::string functional_maps(const Comparison& c, const std::string& mass)
{
  std::string html =
      "<p class='note'>|C<sub>ij</sub>|: white is 0, darkest is 1 and above. Columns are fine "
      "modes, rows "
      "coarse ones, from the upper left. Within groups of nearly equal fine eigenvalues (closer "
      "than a tenth "
      "of their mean spacing) the coarse modes were rotated to the fine ones, so that an "
      "eigenspace with "
      "another basis does not look like an error; the norms are those before.</p>\n" +
      shade_scale();
  for(const std::size_t N : sizes(c)) {
    html += "<div class='figures'>\n";
    for(const auto& [s, j] : judged(c, N, mass))
      html += std::string("<figure") + (c.results.size() < 3 ? " class='large'" : "") +
              "><img alt='|C| of " + escaped(s->name()) + "' src='" + matrix_image(j->C) +
              "'><figcaption>" + escaped(s->name()) + ", N = " + std::to_string(s->vertices) +
              ": |C|<sub>L</sub> " + formatted(j->norms().norm_L) + ", |C|<sub>D</sub> " +
              formatted(j->norms().norm_D) + "</figcaption></figure>\n";
    html += "</div>\n";
  }
  return html;
}

inline std::string eigenvalue_plots(const Comparison& c, const Fine_spectrum& fine)
{
  std::string html;
  for(const std::size_t N : sizes(c)) {
    Plot values, ratios;
    values.title = "Eigenvalues, N = " + std::to_string(N) + ", " + fine.mass + " mass";
    values.x_label = ratios.x_label = "mode k";
    values.y_label = "λ (unit area)";
    ratios.title =
        "Coarse over fine eigenvalues, N = " + std::to_string(N) + ", " + fine.mass + " mass";
    ratios.y_label = "coarse λ / fine λ";
    values.width = ratios.width = 600;
    values.height = ratios.height = 380;
    Curve reference{"fine mesh", {"#999999", "", 0}, {}, {}, false}, one = reference;
    for(Eigen::Index k = 0; k < fine.values.size(); ++k) {
      reference.x.push_back(static_cast<double>(k + 1));
      reference.y.push_back(fine.values(k));
      one.x.push_back(static_cast<double>(k + 1));
      one.y.push_back(1);
    }
    values.curves.push_back(reference);
    ratios.curves.push_back(one);
    for(const auto& [s, j] : judged(c, N, fine.mass)) {
      Curve curve{s->name(), style_of(c, s->name()), {}, {}, false}, ratio = curve;
      for(Eigen::Index k = 0; k < (std::min)(j->coarse_values.size(), fine.values.size()); ++k) {
        curve.x.push_back(static_cast<double>(k + 1));
        curve.y.push_back(j->coarse_values(k));
        if(k < fine.zeros)
          continue; // zero over zero
        ratio.x.push_back(static_cast<double>(k + 1));
        ratio.y.push_back(j->coarse_values(k) / fine.values(k));
      }
      if(!curve.x.empty())
        values.curves.push_back(curve);
      if(!ratio.x.empty())
        ratios.curves.push_back(ratio);
    }
    html += "<div class='figures'>" + svg(values) + svg(ratios) + "</div>\n";
  }
  return html;
}

// One curve per simplifier through its sizes.
template <class X, class Y>
Plot plot_over_sizes(const Comparison& c, const std::string& mass, const X& x, const Y& y)
{
  Plot plot;
  plot.log_x = plot.log_y = true;
  for(const auto& [name, style] : styles(c)) {
    Curve curve{name, style, {}, {}, true};
    for(const std::size_t N : sizes(c))
      for(const auto& [s, j] : judged(c, N, mass))
        if(s->name() == name) {
          curve.x.push_back(x(*s));
          curve.y.push_back(y(*s, *j));
        }
    if(!curve.x.empty()) // else it was not judged in this mass
      plot.curves.push_back(curve);
  }
  return plot;
}

inline std::string size_plots(const Comparison& c, const std::string& mass)
{
  std::string html = "<div class='figures'>";
  for(const bool norm_L : {true, false}) {
    Plot plot = plot_over_sizes(
        c, mass, [](const Simplified& s) { return static_cast<double>(s.vertices); },
        [&](const Simplified&, const Judgement& j) {
          return norm_L ? j.norms().norm_L : j.norms().norm_D;
        });
    plot.title = std::string(norm_L ? "|C|_L" : "|C|_D") + " over output size, " + mass + " mass";
    plot.x_label = "N, vertices";
    plot.y_label = std::string(norm_L ? "|C|_L" : "|C|_D") + " (unit area)";
    plot.width = 600;
    html += svg(plot);
  }
  return html + "</div>\n";
}

inline std::string time_plot(const Comparison& c)
{
  Plot plot = plot_over_sizes(
      c, c.fine.front().mass, [](const Simplified& s) { return static_cast<double>(s.vertices); },
      [](const Simplified& s, const Judgement&) { return s.seconds_total(); });
  plot.title = "Time over output size";
  plot.x_label = "N, vertices";
  plot.y_label = "time, seconds";
  plot.width = 600;
  return "<div class='figures'>" + svg(plot) + "</div>\n";
}

} // namespace html_internal

#endif // SPECTRAL_EXAMPLES_REPORT_HTML_FIGURES_H
