// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_SVG_PLOT_H
#define SPECTRAL_EXAMPLES_REPORT_SVG_PLOT_H

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

// Curves and bars as inline SVG.

inline std::string escaped(const std::string& text)
{
  std::string result;
  for(const char c : text) {
    if(c == '&')
      result += "&amp;";
    else if(c == '<')
      result += "&lt;";
    else if(c == '>')
      result += "&gt;";
    else if(c == '"')
      result += "&quot;";
    else if(c == '\'')
      result += "&#39;";
    else
      result += c;
  }
  return result;
}

// A number with three significant digits (four before a comma), never in exponents between 1e-4 and
// 1e6.
inline std::string formatted(double x)
{
  if(!std::isfinite(x))
    return "–";
  char text[40];
  const double a = std::abs(x);
  if(a != 0 && (a < 1e-4 || a >= 1e6)) {
    std::snprintf(text, sizeof(text), "%.2e", x);
    return text;
  }
  const int digits = a == 0     ? 0
                     : a >= 100 ? (a >= 1000 ? 0 : 1)
                                : 2 - static_cast<int>(std::floor(std::log10(a)));
  std::snprintf(text, sizeof(text), "%.*f", (std::max)(0, digits), x);
  return text;
}

// How a curve is drawn: colour, dashes and marker, so that colour is never the only difference.
struct Line_style
{
  std::string colour = "#000000", dash;
  int marker = 0;
};

// Colours of Okabe and Ito, which colour-blind readers tell apart: one per family of simplifiers;
// dashes and markers for its variants.
inline Line_style line_style(std::size_t family, std::size_t variant)
{
  const char* colours[] = {"#0072B2", "#D55E00", "#CC79A7", "#009E73",
                           "#E69F00", "#56B4E9", "#000000"};
  const char* dashes[] = {"", "7,3", "2,2.5", "9,3,2,3", "14,4", "9,3,2,3,2,3"};
  return {colours[family % 7], dashes[variant % 6], static_cast<int>(variant % 6)};
}

struct Curve
{
  std::string name;
  Line_style style;
  std::vector<double> x, y;
  bool markers = true;
};

struct Plot
{
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<Curve> curves;
  double width = 460, height = 330;
};

namespace svg_internal {

inline std::string number(double x)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.2f", x);
  return text;
}

inline std::string text(double x, double y, const std::string& content,
                        const std::string& attributes = "")
{
  return "<text x='" + number(x) + "' y='" + number(y) + "' " + attributes + ">" +
         escaped(content) + "</text>";
}

inline std::string marker(int shape, double x, double y, const std::string& colour)
{
  const std::string fill = " fill='#fff' stroke='" + colour + "' stroke-width='1.6'/>";
  if(shape == 0)
    return "<circle cx='" + number(x) + "' cy='" + number(y) + "' r='3.2'" + fill;
  if(shape == 1)
    return "<rect x='" + number(x - 3) + "' y='" + number(y - 3) + "' width='6' height='6'" + fill;
  if(shape == 4)
    return "<path d='M" + number(x) + " " + number(y - 4.2) + "l4.2 4.2l-4.2 4.2l-4.2 -4.2z'" +
           fill;
  if(shape == 5)
    return "<path d='M" + number(x - 3) + " " + number(y - 3) + "l6 6m0 -6l-6 6'" + fill;
  const double s = shape == 2 ? -1 : 1; // triangles that point up and down
  return "<path d='M" + number(x - 3.6) + " " + number(y - 2.6 * s) + "h7.2l-3.6 " + number(6 * s) +
         "z'" + fill;
}

// An axis: data to pixels, and where its ticks are.
class Axis
{
public:
  Axis(double low, double high, bool log, double from, double to)
    : m_log(log)
    , m_from(from)
    , m_to(to)
  {
    if(!(low <= high)) {
      low = log ? 1 : 0;
      high = 1;
    }
    if(log) {
      m_low = std::log10(low) - 0.03;
      m_high = std::log10(high) + 0.03;
      if(m_high - m_low < 0.3) {
        m_low -= 0.15;
        m_high += 0.15;
      }
      log_ticks();
    } else {
      if(low == high) {
        low -= 0.5;
        high += 0.5;
      }
      const double step = nice_step((high - low) / 5);
      m_low = std::floor(low / step + 1e-9) * step;
      m_high = std::ceil(high / step - 1e-9) * step;
      for(double t = m_low; t < m_high + 0.5 * step; t += step)
        m_ticks.push_back(std::abs(t) < 1e-9 * step ? 0. : t);
    }
  }

  double operator()(double x) const
  {
    const double t = m_log ? std::log10(x) : x;
    return m_from + (t - m_low) / (m_high - m_low) * (m_to - m_from);
  }

  const std::vector<double>& ticks() const { return m_ticks; }

private:
  static double nice_step(double x)
  {
    const double decade = std::pow(10., std::floor(std::log10(x)));
    for(const double m : {1., 2., 5.})
      if(m * decade >= x * (1 - 1e-9))
        return m * decade;
    return 10 * decade;
  }

  // The densest of three sets of ticks that does not crowd.
  void log_ticks()
  {
    const std::vector<double> sets[] = {{1}, {1, 2, 5}, {1, 1.5, 2, 3, 4, 5, 6, 8}};
    for(const std::vector<double>& mantissas : sets) {
      std::vector<double> ticks;
      for(int decade = static_cast<int>(std::floor(m_low)); decade <= m_high; ++decade)
        for(const double m : mantissas) {
          const double t = m * std::pow(10., decade);
          if(std::log10(t) >= m_low && std::log10(t) <= m_high)
            ticks.push_back(t);
        }
      if(m_ticks.empty() || ticks.size() <= 9)
        m_ticks = ticks;
    }
  }

  bool m_log;
  double m_from, m_to, m_low = 0, m_high = 1;
  std::vector<double> m_ticks;
};

inline std::string tick_label(double x)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", x);
  return text;
}

inline bool drawable(const Plot& plot, double x, double y)
{
  return std::isfinite(x) && std::isfinite(y) && (!plot.log_x || x > 0) && (!plot.log_y || y > 0);
}

inline std::string curve(const Plot& plot, const Curve& c, const Axis& ax, const Axis& ay)
{
  std::string points, markers;
  for(std::size_t i = 0; i < c.x.size(); ++i) {
    if(!drawable(plot, c.x[i], c.y[i]))
      continue;
    const double x = ax(c.x[i]), y = ay(c.y[i]);
    points += number(x) + "," + number(y) + " ";
    if(c.markers)
      markers += marker(c.style.marker, x, y, c.style.colour);
  }
  const std::string dash = c.style.dash.empty() ? "" : " stroke-dasharray='" + c.style.dash + "'";
  return "<g><title>" + escaped(c.name) + "</title><polyline points='" + points +
         "' fill='none' stroke='" + c.style.colour +
         "' stroke-width='1.7' stroke-linejoin='round'" + dash + "/>" + markers + "</g>\n";
}

inline std::string axes(const Plot& plot, const Axis& ax, const Axis& ay, double left, double top,
                        double right, double bottom)
{
  std::string svg;
  for(const double t : ax.ticks()) {
    const std::string x = number(ax(t));
    svg += "<path d='M" + x + " " + number(top) + "V" + number(bottom) + "' stroke='#e3e3e3'/>" +
           text(ax(t), bottom + 15, tick_label(t), "text-anchor='middle'");
  }
  for(const double t : ay.ticks()) {
    const std::string y = number(ay(t));
    svg += "<path d='M" + number(left) + " " + y + "H" + number(right) + "' stroke='#e3e3e3'/>" +
           text(left - 6, ay(t) + 4, tick_label(t), "text-anchor='end'");
  }
  svg += "<path d='M" + number(left) + " " + number(top) + "V" + number(bottom) + "H" +
         number(right) + "' fill='none' stroke='#333'/>\n";
  svg += text((left + right) / 2, bottom + 34, plot.x_label, "text-anchor='middle'");
  const std::string middle = number((top + bottom) / 2);
  svg += text(14, (top + bottom) / 2, plot.y_label,
              "text-anchor='middle' transform='rotate(-90 14 " + middle + ")'");
  return svg + text((left + right) / 2, 16, plot.title, "text-anchor='middle' font-weight='bold'");
}

} // namespace svg_internal

inline std::string svg_begin(double width, double height, const std::string& description)
{
  using svg_internal::number;
  return "<svg xmlns='http://www.w3.org/2000/svg' role='img' width='" + number(width) +
         "' height='" + number(height) + "' viewBox='0 0 " + number(width) + " " + number(height) +
         "' font-family='sans-serif' font-size='12' fill='#222'><title>" + escaped(description) +
         "</title>\n";
}

inline std::string svg(const Plot& plot)
{
  using namespace svg_internal;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double x0 = infinity, x1 = -infinity, y0 = infinity, y1 = -infinity;
  for(const Curve& c : plot.curves)
    for(std::size_t i = 0; i < c.x.size(); ++i)
      if(drawable(plot, c.x[i], c.y[i])) {
        x0 = (std::min)(x0, c.x[i]);
        x1 = (std::max)(x1, c.x[i]);
        y0 = (std::min)(y0, c.y[i]);
        y1 = (std::max)(y1, c.y[i]);
      }
  const double left = 66, top = 28, right = plot.width - 14, bottom = plot.height - 46;
  const Axis ax(x0, x1, plot.log_x, left, right), ay(y0, y1, plot.log_y, bottom, top);
  std::string result = svg_begin(plot.width, plot.height, plot.title);
  result += axes(plot, ax, ay, left, top, right, bottom);
  for(const Curve& c : plot.curves)
    result += curve(plot, c, ax, ay);
  return result + "</svg>\n";
}

// What a curve looks like, beside its name in a legend.
inline std::string svg_sample(const Line_style& style, bool marker = true)
{
  const std::string dash = style.dash.empty() ? "" : " stroke-dasharray='" + style.dash + "'";
  return "<svg xmlns='http://www.w3.org/2000/svg' width='44' height='12' aria-hidden='true'><path "
         "d='M1 "
         "6H43' "
         "stroke-width='1.8' stroke='" +
         style.colour + "'" + dash + "/>" +
         (marker ? svg_internal::marker(style.marker, 22, 6, style.colour) : "") + "</svg>";
}

// Bars of one length per name, from zero, the value at the end; `floor` is drawn as a line across
// when positive.
struct Bars
{
  std::string title, label;
  double floor = 0;
  std::vector<std::string> names;
  std::vector<Line_style> styles;
  std::vector<double> values;
  double width = 600, names_width = 300;
};

inline std::string svg(const Bars& bars)
{
  using namespace svg_internal;
  double largest = bars.floor;
  for(const double v : bars.values)
    if(std::isfinite(v))
      largest = (std::max)(largest, v);
  const double row = 20, top = 28, bottom = top + row * static_cast<double>(bars.names.size());
  std::size_t longest = 0;
  for(const std::string& name : bars.names)
    longest = (std::max)(longest, name.size());
  // A letter of 12 px sans-serif is 6.1 px wide.
  const double left = (std::max)(bars.names_width, 12 + 6.1 * static_cast<double>(longest));
  const double width = bars.width + left - bars.names_width;
  const double right = width - 56, height = bottom + 40;
  const Axis axis(0, largest > 0 ? largest : 1, false, left, right);
  std::string result = svg_begin(width, height, bars.title);
  for(const double t : axis.ticks())
    result += "<path d='M" + number(axis(t)) + " " + number(top) + "V" + number(bottom) +
              "' stroke='#e3e3e3'/>" +
              text(axis(t), bottom + 15, tick_label(t), "text-anchor='middle'");
  std::string values; // above the line of the floor, with a white rim
  for(std::size_t i = 0; i < bars.names.size(); ++i) {
    const double y = top + row * static_cast<double>(i);
    result += text(left - 7, y + 14, bars.names[i], "text-anchor='end'");
    if(!std::isfinite(bars.values[i]))
      continue;
    const double x = axis(bars.values[i]);
    result += "<rect x='" + number(left) + "' y='" + number(y + 3) + "' width='" +
              number(x - left) + "' height='14' fill='" + bars.styles[i].colour + "'/>";
    values += text(x + 5, y + 14, formatted(bars.values[i]),
                   "paint-order='stroke' stroke='#fff' stroke-width='4'");
  }
  if(bars.floor > 0)
    result += "<path d='M" + number(axis(bars.floor)) + " " + number(top - 2) + "V" +
              number(bottom) + "' stroke='#000' stroke-width='1.5' stroke-dasharray='4,3'/>";
  result += values;
  result += "<path d='M" + number(left) + " " + number(top) + "V" + number(bottom) + "H" +
            number(right) + "' fill='none' stroke='#333'/>";
  result += text((left + right) / 2, bottom + 33, bars.label, "text-anchor='middle'");
  result += text(width / 2, 16, bars.title, "text-anchor='middle' font-weight='bold'");
  return result + "</svg>\n";
}

#endif // SPECTRAL_EXAMPLES_REPORT_SVG_PLOT_H
