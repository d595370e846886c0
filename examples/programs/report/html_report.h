// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_HTML_REPORT_H
#define SPECTRAL_EXAMPLES_REPORT_HTML_REPORT_H

#include "Comparison.h"
#include "html_figures.h"
#include "svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

// A comparison as one page that needs neither network nor another file.

namespace html_internal {

inline const char* style()
{
  return "body{font:15px/1.5 sans-serif;color:#222;max-width:1280px;margin:2em auto;padding:0 "
         "1.5em}"
         "h1{font-size:1.7em;margin-bottom:.2em;overflow-wrap:anywhere}"
         "h2{font-size:1.3em;margin-top:2em;border-bottom:1px solid #bbb}"
         "h3{font-size:1.05em;margin:1.4em 0 .4em}"
         "table{border-collapse:collapse;font-size:13px;margin:.6em 0}"
         "th,td{padding:2px 9px;text-align:right;border-bottom:1px solid "
         "#e3e3e3;vertical-align:bottom}"
         "th{border-bottom:1.5px solid #555;font-weight:600}"
         "th.l,td.l{text-align:left}tr.floor td{font-style:italic;border-bottom:1.5px solid #999}"
         "td.n{white-space:nowrap}td.best{font-weight:bold}"
         ".figures{display:flex;flex-wrap:wrap;gap:14px 18px;align-items:flex-start}"
         "figure{margin:0;width:190px;max-width:100%;break-inside:avoid}"
         "figcaption{font-size:12.5px;line-height:1.35}"
         "figure img{width:188px;height:188px;border:1px solid "
         "#999;image-rendering:pixelated;display:block}"
         "figure.wide,figure.large{width:460px}"
         "figure.large img{box-sizing:border-box;width:100%;height:auto}"
         "figure.wide img{box-sizing:border-box;width:100%;height:auto;image-rendering:auto}"
         ".legend{max-width:none;columns:3;column-gap:2em;font-size:13px;list-style:none;padding:0;"
         "margin:."
         "4em 0}"
         ".legend li{break-inside:avoid;display:block}.legend "
         "svg{vertical-align:middle;margin-right:.5em}"
         "svg{max-width:100%;height:auto}code{font-size:13px;overflow-wrap:anywhere}"
         "p,ul{max-width:62em}sub{line-height:0}.note{color:#555;font-size:13px}"
         ".shapes{display:grid;grid-template-columns:1fr 1fr;gap:14px}.shapes "
         "figure{width:auto;min-width:0}"
         ".shapes figcaption{font-weight:600;font-size:14px}"
         ".shapes img,.shapes "
         "canvas{box-sizing:border-box;width:100%;height:auto;aspect-ratio:400/287;"
         "display:block;border:1px solid #999;image-rendering:auto}"
         ".shapes canvas{touch-action:none;cursor:grab}"
         ".scale{max-width:36em;margin:.6em 0;font-size:13px}#shape-bar{height:14px;border:1px "
         "solid #999}"
         "#shape-ticks{display:flex}#shape-ticks span{flex:1}#shape-ticks "
         "span+span{text-align:center}"
         "#shape-ticks span+span+span{text-align:right}"
         "@media(max-width:700px){body{margin:1em auto;padding:0 .8em}table{display:block}"
         "table,.bars{overflow-x:auto;"
         "background:linear-gradient(90deg,#fff0,#fff 60%) 100% 0/40px 100% no-repeat local,"
         "linear-gradient(90deg,#0000,#0003) 100% 0/12px 100% no-repeat scroll}"
         "td.n{white-space:normal;min-width:8em}"
         "td.n,th.l:first-child{position:sticky;left:0;background:#fff}"
         "table.facts{display:table;background:none}table.facts td{white-space:normal;"
         "overflow-wrap:anywhere}table.facts td:first-child{min-width:7em}"
         "svg[role=img]{font-size:17px;overflow:visible}.bars>svg[role=img]{max-width:none;flex:"
         "none;font-"
         "size:12px}"
         ".legend{columns:1}.shapes{grid-template-columns:1fr}}"
         "@media print{#shape-controls{display:none}body{margin:0;max-width:none;font-size:10pt}"
         "table{font-size:7.5pt}th,td{padding:1px 4px}h2{break-after:avoid}"
         "*{-webkit-print-color-adjust:exact;print-color-adjust:exact}}"
         "@page{size:A4 landscape;margin:12mm}";
}

inline std::string cell(const std::string& content, const char* type = "td",
                        const std::string& cls = "")
{
  return std::string("<") + type + (cls.empty() ? "" : " class='" + cls + "'") + ">" + content +
         "</" + type + ">";
}

inline std::string heading_row(const std::vector<std::string>& names, std::size_t left)
{
  std::string row = "<tr>";
  for(std::size_t i = 0; i < names.size(); ++i)
    row += cell(names[i], "th", i < left ? "l" : "");
  return row + "</tr>\n";
}

inline std::string percent(double x)
{
  return formatted(100 * x);
}

// The cells that say what a row is.
inline std::string who(const Simplified& s)
{
  const auto or_dash = [](const std::string& t) {
    return t.empty() || t == "none" ? std::string("–") : escaped(t);
  };
  return cell(escaped(s.simplifier), "td", "l n") + cell(or_dash(s.placement), "td", "l") +
         cell(or_dash(s.relocation), "td", "l") + cell(or_dash(s.metric_mass), "td", "l") +
         cell(std::to_string(s.vertices));
}

// A table of all results judged in one mass; `value(result, judgement)` gives the columns. The
// smallest entry of a column among those of one size is bold where `best` says so.
template <class Values>
std::string table(const Comparison& c, const std::string& mass,
                  const std::vector<std::string>& columns, const std::vector<bool>& best,
                  bool floors, const Values& values)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  // Columns without any number are left out.
  std::vector<bool> shown(columns.size(), false);
  for(const std::size_t N : sizes(c))
    for(const auto& [s, j] : judged(c, N, mass))
      for(std::size_t k = 0; k < columns.size(); ++k)
        shown[k] = shown[k] || std::isfinite(values(*s, *j)[k].first);
  std::vector<std::string> names = {"simplifier", "placement", "relocation", "metric", "vertices"};
  for(std::size_t k = 0; k < columns.size(); ++k)
    if(shown[k])
      names.push_back(columns[k]);
  if(names.size() == 5)
    return "";

  std::string html = "<table>\n<thead>" + heading_row(names, 4) + "</thead>\n";
  for(const std::size_t N : sizes(c)) {
    const auto rows = judged(c, N, mass);
    std::vector<double> smallest(columns.size(), infinity);
    for(const auto& [s, j] : rows)
      for(std::size_t k = 0; k < columns.size(); ++k)
        smallest[k] =
            (std::min)(smallest[k],
                       std::isfinite(values(*s, *j)[k].first) ? values(*s, *j)[k].first : infinity);
    html += "<tbody>\n";
    for(const auto& [s, j] : rows) {
      html += "<tr>" + who(*s);
      for(std::size_t k = 0; k < columns.size(); ++k) {
        const auto [x, in_percent] = values(*s, *j)[k];
        const bool bold = best[k] && rows.size() > 1 && x == smallest[k];
        if(shown[k])
          html += cell(in_percent ? percent(x) : formatted(x), "td", bold ? "best" : "");
      }
      html += "</tr>\n";
    }
    if(floors && !rows.empty()) {
      const Judgement& j = *rows.front().second;
      html += "<tr class='floor'>" + cell("ideal linear elements (estimate)", "td", "l") +
              "<td></td><td></td><td></td>" + cell(std::to_string(N)) +
              cell(formatted(j.floor_norm_L)) + cell(formatted(j.floor_norm_D));
      for(std::size_t k = 2; k < columns.size(); ++k)
        html += shown[k] ? "<td></td>" : "";
      html += "</tr>\n";
    }
    html += "</tbody>\n";
  }
  return html + "</table>\n";
}

inline std::string spectrum_tables(const Comparison& c, const std::string& mass)
{
  std::string html = "<h3>Norms</h3>\n";
  html += table(c, mass,
                {"|C|<sub>L</sub>", "|C|<sub>D</sub>", "|C|<sub>D</sub>, 1.1 K",
                 "|C|<sub>L</sub> closest P", "|C|<sub>D</sub> closest P",
                 "|C|<sub>L</sub> input scale", "|C|<sub>D</sub> input scale"},
                {true, true, false, true, true, false, false}, true,
                [](const Simplified&, const Judgement& j) {
                  const Map_norms& n = j.norms();
                  const Map_norms p = j.closest ? *j.closest : Map_norms();
                  return std::vector<std::pair<double, bool>>{{n.norm_L, false},
                                                              {n.norm_D, false},
                                                              {n.norm_D_extended, false},
                                                              {p.norm_L, false},
                                                              {p.norm_D, false},
                                                              {n.norm_L_input_scale, false},
                                                              {n.norm_D_input_scale, false}};
                });
  html += "<h3>Errors in percent: eigenvalues, span, distances, signatures</h3>\n";
  html += table(c, mass,
                {"λ<sub>1..K</sub> mean", "λ<sub>1..K</sub> max", "λ<sub>2..K/5</sub> mean",
                 "λ<sub>K+1..1.5K</sub> mean", "span loss", "diffusion", "biharmonic",
                 "commute time", "wave kernel", "HKS", "WKS"},
                {true, true, true, true, true, true, true, true, true, true, true}, false,
                [](const Simplified&, const Judgement& j) {
                  const Distance_errors& d = j.distances;
                  return std::vector<std::pair<double, bool>>{{j.error_mean, true},
                                                              {j.error_max, true},
                                                              {j.error_low_mean, true},
                                                              {j.error_beyond_mean, true},
                                                              {j.span_loss, true},
                                                              {d.diffusion, true},
                                                              {d.biharmonic, true},
                                                              {d.commute_time, true},
                                                              {d.wave_kernel, true},
                                                              {d.heat_kernel_signature, true},
                                                              {d.wave_kernel_signature, true}};
                });
  return html;
}

inline std::string refused_rivals(const Comparison& c)
{
  std::string html = "<table>\n" + heading_row({"refused", "why"}, 2);
  for(const Refused& r : c.refused)
    html += "<tr>" + cell(escaped(r.name), "td", "l n") + cell(escaped(r.reason), "td", "l") +
            "</tr>\n";
  return html + "</table>\n";
}

inline std::string shape_table(const Comparison& c)
{
  return table(c, c.fine.front().mass,
               {"eigenpairs, s", "simplification, s", "total, s", "smallest angle, °",
                "largest aspect ratio", "self-inter&shy;sections", "Hausdorff, % diag.",
                "volume ratio", "area ratio", "bytes per vertex"},
               {false, false, true, false, false, false, true, false, false, false}, false,
               [](const Simplified& s, const Judgement&) {
                 const Shape_measures& m = s.shape;
                 return std::vector<std::pair<double, bool>>{
                     {s.seconds_eigenpairs > 0 ? s.seconds_eigenpairs : not_computed, false},
                     {s.seconds, false},
                     {s.seconds_total(), false},
                     {m.smallest_angle, false},
                     {m.largest_aspect_ratio, false},
                     {m.self_intersections, false},
                     {m.hausdorff, true},
                     {m.volume_ratio, false},
                     {m.area_ratio, false},
                     {m.bytes_per_vertex, false}};
               });
}

// The figures of one run, a row for each, so that a narrow screen shows all of them.
inline std::string run_table(const Simplified& s, const Judgement& j)
{
  struct Row
  {
    const char* name;
    double unit, input, ideal;
    bool in_percent;
  };
  const Map_norms& n = j.norms();
  const Row rows[] = {
      {"|C|<sub>L</sub>", n.norm_L, n.norm_L_common_scale, j.floor_norm_L, false},
      {"|C|<sub>D</sub>", n.norm_D, n.norm_D_input_scale, j.floor_norm_D, false},
      {"|C|<sub>D</sub>, 1.1 K", n.norm_D_extended, not_computed, not_computed, false},
      {"λ<sub>1..K</sub>, mean error, %", j.error_mean, j.error_input_scale_mean, not_computed,
       true},
      {"λ<sub>1..K</sub>, largest error, %", j.error_max, j.error_input_scale_max, not_computed,
       true},
      {"λ<sub>2..K/5</sub>, mean error, %", j.error_low_mean, j.error_input_scale_low_mean,
       not_computed, true},
      {"λ<sub>K+1..1.5K</sub>, mean error, %", j.error_beyond_mean, not_computed, not_computed,
       true},
      {"span loss, %", j.span_loss, not_computed, not_computed, true},
      {"area of output / input", s.shape.area_ratio, not_computed, not_computed, false}};
  const bool ideal = j.floor_norm_L > 0 || j.floor_norm_D > 0;
  std::vector<std::string> names = {escaped(s.name()), "unit area", "scale of input"};
  if(ideal)
    names.push_back("ideal linear elements");
  std::string html = "<table>\n<thead>" + heading_row(names, 1) + "</thead>\n<tbody>\n";
  for(const Row& row : rows) {
    if(!std::isfinite(row.unit))
      continue;
    const auto shown = [&](const double x) {
      return std::isfinite(x) ? row.in_percent ? percent(x) : formatted(x) : std::string();
    };
    html += "<tr>" + cell(row.name, "td", "l n") + cell(shown(row.unit)) + cell(shown(row.input)) +
            (ideal ? cell(row.ideal > 0 ? shown(row.ideal) : "") : "") + "</tr>\n";
  }
  return html + "</tbody>\n</table>\n";
}

inline std::string times_table(const Comparison& c)
{
  std::string html = "<table>\n" + heading_row({"stage", "seconds"}, 1);
  for(const auto& [what, seconds] : c.times)
    html += "<tr>" + cell(what, "td", "l") + cell(formatted(seconds)) + "</tr>\n";
  return html + "</table>\n";
}

inline std::string facts(const Comparison& c)
{
  std::string html = "<table class='facts'>\n";
  const auto fact = [&](const std::string& name, const std::string& value) {
    html += "<tr>" + cell(name, "td", "l") + cell(value, "td", "l") + "</tr>\n";
  };
  const std::string components =
      std::to_string(c.components) + (c.components == 1 ? " component, " : " components, ");
  fact("Fine mesh",
       escaped(c.mesh) + ", " + std::to_string(c.vertices) + " vertices, " +
           std::to_string(c.faces) + " triangles" +
           (c.components == 0 ? "" : ", " + components + (c.closed ? "closed" : "with boundary")));
  if(c.is_run) {
    const Simplified& s = c.results.front();
    fact("Coarse mesh",
         std::to_string(s.vertices) + " vertices, " + std::to_string(s.faces) + " triangles");
    fact("Simplifier", escaped(s.name()));
    fact("P, the restriction", escaped(c.restriction));
    fact("Mass of the figures", escaped(c.fine.front().mass));
  }
  fact("Area", formatted(c.area) + " u² (u: the unit of the file)");
  if(std::isfinite(c.diagonal))
    fact("Diagonal of its box", formatted(c.diagonal) + " u");
  fact("K, number of eigenvectors", std::to_string(c.K));
  for(const Fine_spectrum& f : c.fine)
    if(std::isfinite(f.seconds))
      fact("Reference eigenpairs, " + f.mass + " mass",
           std::to_string(f.values.size()) + " in " + formatted(f.seconds) +
               " s, largest residual " + formatted(f.largest_residual));
  if(c.sources > 0)
    fact("Distances", std::to_string(c.sources) + " sources, seed " + std::to_string(c.seed));
  fact(c.is_run ? "Threads" : "Threads for the spectral costs", std::to_string(c.threads));
  if(!c.cgal_version.empty())
    fact("CGAL, compiler", escaped(c.cgal_version) + ", " + escaped(c.compiler));
  fact("Command", "<code>" + escaped(c.command) + "</code>");
  return html + "</table>\n";
}

// Explains what is on the page, and nothing else.
inline std::string explanation(const Comparison& c)
{
  const auto any = [&c](const auto& has) {
    for(const Simplified& s : c.results)
      for(const Judgement& j : s.judgements)
        if(has(s, j))
          return true;
    return false;
  };
  std::string html = "<ul>\n";
  const auto item = [&html](const bool is_there, const std::string& text) {
    if(is_there)
      html += "<li>" + text + "</li>\n";
  };
  item(true, "<b>C</b> = Φ<sub>c</sub>ᵀ M<sub>c</sub> P Φ (c: coarse) maps the coefficients of a "
             "function on the fine mesh to those of its restriction. |C|<sub>L</sub> = |CΛ − "
             "Λ<sub>c</sub>C| / |C| (unit: that of the eigenvalues) and |C|<sub>D</sub> = |CᵀC − "
             "I| (no unit), Frobenius norms, not squared; both are 0 if and only if the "
             "eigenpairs are kept exactly. Meshes are scaled to unit area each" +
                 std::string(c.is_run ? ". <i>Scale of input</i>: both by the factor that gives "
                                        "the input unit area; where the area has shrunk "
                                        "eigenvalues are larger there."
                                      : "; <i>input scale</i> is without that."));
  item(c.is_run,
       "<b>P</b>, by which functions come to the coarse mesh: " + escaped(c.restriction) + ".");
  item(!c.is_run, "<b>P</b> is the restriction that the simplifier carries along, after "
                  "relocation by sampled functions that of closest points; for remeshers, which "
                  "have none, that of the closest points of the fine surface." +
                      std::string(any([](const Simplified&, const Judgement& j) {
                        return j.closest.has_value();
                      })
                                      ? " <i>closest P</i> is the latter for all."
                                      : ""));
  item(!c.is_run, "<b>Lumped</b> and <b>averaged</b> mass are two discretisations: compare within "
                  "one. <i>metric</i> is the mass that the simplifier itself works with, the "
                  "heading names the one that it is judged in.");
  item(any([](const Simplified&, const Judgement& j) {
         return std::isfinite(j.norms().norm_D_extended);
       }),
       "<b>1.1 K</b>: with a tenth more coarse modes. Where this is much smaller, modes were "
       "exchanged at the cut, not lost.");
  item(any([](const Simplified&, const Judgement& j) {
         return j.floor_norm_L > 0 || j.floor_norm_D > 0;
       }),
       "<b>Ideal linear elements</b>: an estimate of what the discretisation alone costs on "
       "equilateral triangles that only sample the surface. A mesh that fits the spectrum on "
       "purpose can be below.");
  item(any([](const Simplified&, const Judgement& j) { return std::isfinite(j.span_loss); }),
       "<b>Span loss</b>: how much of the first K fine eigenvectors (the mean of their squared "
       "norms) is outside of the span of the coarse ones, carried back to the fine mesh by its "
       "closest points on the coarse one.");
  item(any([](const Simplified&, const Judgement& j) {
         const Distance_errors& d = j.distances;
         return std::isfinite(d.diffusion) || std::isfinite(d.biharmonic) ||
                std::isfinite(d.commute_time) || std::isfinite(d.wave_kernel) ||
                std::isfinite(d.heat_kernel_signature) || std::isfinite(d.wave_kernel_signature);
       }),
       "<b>Distances</b> (squared, but for the wave kernel's) and signatures: Σ M<sub>c</sub> "
       "|coarse − P fine| / Σ M<sub>c</sub> |P fine|, mean over the sources, times or energies; "
       "times and energies are those of the fine mesh.");
  item(!c.is_run &&
           any([](const Simplified& s, const Judgement&) { return std::isfinite(s.seconds); }),
       "<b>Time</b> of the spectral simplifier includes the eigenvectors of its own metric, "
       "computed once for all sizes. Remeshing is timed at the edge length that was found, "
       "without the search.");
  item(!c.is_run && any([](const Simplified& s, const Judgement&) {
    return std::isfinite(s.shape.largest_aspect_ratio);
  }),
       "<b>Aspect ratio</b>: longest edge over shortest height, 1.15 when equilateral.");
  item(!c.is_run && any([](const Simplified& s, const Judgement&) {
    return std::isfinite(s.shape.self_intersections);
  }),
       "<b>Self-intersections</b> counts pairs of triangles.");
  item(!c.is_run && c.results.size() > sizes(c).size(),
       "Bold: the smallest of its column and size.");
  return html + "</ul>\n";
}

inline std::string figures_of_run(const Comparison& c)
{
  std::string html = "<h2>How well the spectrum was kept</h2>\n";
  for(const Simplified& s : c.results)
    html += run_table(s, s.judgements.front());
  html += "<h3>Functional map</h3>\n" + functional_maps(c, c.fine.front().mass);
  html += "<h3>Eigenvalues, coarse against fine</h3>\n" + legend(c, false) +
          eigenvalue_plots(c, c.fine.front());
  return html + "<h2>Time</h2>\n" + times_table(c);
}

inline std::string figures_of_comparison(const Comparison& c)
{
  std::string html;
  for(const Fine_spectrum& f : c.fine) {
    html += "<h2>Judged in the " + escaped(f.mass) + " mass</h2>\n" + spectrum_tables(c, f.mass);
    if(c.results.size() > 1)
      html += "<h3>Norms (dashed: ideal linear elements)</h3>\n" + norm_bars(c, f.mass);
    html += "<h3>Functional maps</h3>\n" + functional_maps(c, f.mass);
    html +=
        "<h3>Eigenvalues, coarse against fine</h3>\n" + legend(c, false) + eigenvalue_plots(c, f);
    if(sizes(c).size() > 1)
      html += "<h3>Norms over output size</h3>\n" + legend(c, true) + size_plots(c, f.mass);
  }
  html += "<h2>Time and shape</h2>\n" + shape_table(c);
  if(sizes(c).size() > 1)
    html += legend(c, true) + time_plot(c);
  return html;
}

} // namespace html_internal

// The page; `introduction` comes before the tables.
inline std::string html_report(const Comparison& c, const std::string& introduction = "")
{
  using namespace html_internal;
  const std::string what = c.is_run               ? "Spectral simplification"
                           : c.results.size() > 1 ? "Spectral comparison of simplifications"
                                                  : "A simplification and its spectrum";
  std::string html = "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>"
                     "<meta name='viewport' content='width=device-width'><title>" +
                     escaped(c.mesh) + " – " +
                     (c.is_run ? "spectral simplification" : "spectral comparison") +
                     "</title>\n<style>" + style() + "</style></head><body>\n";
  html += "<h1>" + what + ": " + escaped(c.mesh) + "</h1>\n" + introduction;
  html += facts(c);
  if(!c.refused.empty())
    html += refused_rivals(c);
  for(const std::string& note : all_notes(c))
    html += "<p class='note'>" + escaped(note) + "</p>\n";
  html += c.is_run ? figures_of_run(c) : figures_of_comparison(c);
  html += "<h2>How to read this page</h2>\n" + explanation(c);
  return html + "</body></html>\n";
}

#endif // SPECTRAL_EXAMPLES_REPORT_HTML_REPORT_H
