// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_SHAPE_VIEW_H
#define SPECTRAL_EXAMPLES_REPORT_SHAPE_VIEW_H

#include "../compare/mode_alignment.h"
#include "mesh_picture.h"
#include "png_image.h"
#include "svg_plot.h"

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_toolbox/spectral_distances.h>

#include <Eigen/Core>

#include <nlohmann/json.hpp>

#include <shape_view_script.h> // made of shape_view.js

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Both meshes side by side, coloured by functions in one scale: pictures, and in their place, where
// there is WebGL, views to turn.

struct Viewed_mesh
{
  const CGAL::Spectral_geometry::Mesh_matrices& mesh;
  const CGAL::Spectral_geometry::Eigenpairs& pairs;
};

namespace shape_view_internal {

// A function on both meshes, at unit area.
struct Shown_function
{
  std::string name;
  bool both_signs; // its scale has zero in the middle
  Eigen::VectorXd fine, coarse;

  double largest() const
  {
    return both_signs ? (std::max)(fine.cwiseAbs().maxCoeff(), coarse.cwiseAbs().maxCoeff())
                      : (std::max)(fine.maxCoeff(), coarse.maxCoeff());
  }
  double smallest() const
  {
    return both_signs ? -largest() : (std::min)(fine.minCoeff(), coarse.minCoeff());
  }
  // From 0 to 1 over the scale.
  Eigen::VectorXd shade(const Eigen::VectorXd& values) const
  {
    const double low = smallest(), range = largest() - low;
    return range > 0 ? Eigen::VectorXd((values.array() - low) / range)
                     : Eigen::VectorXd::Constant(values.size(), 0.5);
  }
  std::array<int, 3> colour(double shade) const
  {
    return both_signs ? diverging_colour(shade) : sequential_colour(shade);
  }
};

// Eigenfunctions, the coarse ones aligned with the fine, and the heat kernel signature; `most` of
// them.
inline std::vector<Shown_function>
shown_functions(const CGAL::Spectral_geometry::Eigenpairs& fine,
                const CGAL::Spectral_geometry::Eigenpairs& coarse,
                const CGAL::Spectral_geometry::Spectral_evaluation& e, std::size_t most)
{
  namespace SG = CGAL::Spectral_geometry;
  const Eigen::Index modes = e.judged_modes, first = (std::min)(e.fine_zeros, modes - 1);
  const Eigen::MatrixXd rotation = aligning_rotation(e.C, e.fine_values);
  std::vector<Shown_function> result;
  for(const Eigen::Index k :
      {first, first + 1, first + 3, first + 8}) // 2, 3, 5, 10 of one component
    if(k < modes && result.size() < most)
      result.push_back(
          {"Eigenfunction " + std::to_string(k + 1), true,
           std::sqrt(e.fine_area) * fine.vectors.col(k),
           std::sqrt(e.coarse_area) * (coarse.vectors.leftCols(modes) * rotation.col(k))});
  if(result.size() < most && fine.zeros < fine.size() && fine.values(fine.zeros) > 0) {
    const Eigen::VectorXd time = SG::heat_kernel_times(fine, 3).segment(1, 1) / e.fine_area;
    const auto signature = [&time](const SG::Eigenpairs& pairs, double area) {
      return Eigen::VectorXd(area * SG::heat_kernel_signature(pairs, area * time));
    };
    result.push_back({"Heat kernel signature, t = " + formatted(time(0)), false,
                      signature(fine, e.fine_area), signature(coarse, e.coarse_area)});
  }
  return result;
}

// How far each mesh's vertices are from the other surface.
inline Shown_function distance_between(const CGAL::Spectral_geometry::Mesh_matrices& fine,
                                       const CGAL::Spectral_geometry::Mesh_matrices& coarse)
{
  namespace SG = CGAL::Spectral_geometry;
  const double diagonal = (fine.V.colwise().maxCoeff() - fine.V.colwise().minCoeff()).norm();
  const auto distances = [&](const SG::Mesh_matrices& from, const SG::Mesh_matrices& to) {
    const Eigen::MatrixXd feet = SG::closest_point_interpolation(from.V, to) * to.V;
    return Eigen::VectorXd(100 / diagonal * (from.V - feet).rowwise().norm());
  };
  return {"Distance between the surfaces, % of the diagonal", false, distances(fine, coarse),
          distances(coarse, fine)};
}

inline std::string grouped(std::size_t n) // 25126: 25,126
{
  std::string text = std::to_string(n);
  for(std::size_t i = text.size(); i > 3;)
    text.insert(i -= 3, ",");
  return text;
}

// For typed arrays, lowest byte first.
inline void append(std::string& data, std::uint32_t x, int bytes)
{
  for(int i = 0; i < bytes; ++i)
    data += static_cast<char>(x >> 8 * i & 0xff);
}

// A mesh as the script reads it: points of 16 bits, -`half_cube` to `half_cube` as they are seen;
// triangles of 16 or 32 bits; for each function a byte at each vertex.
inline nlohmann::ordered_json mesh_data(const std::string& name,
                                        const CGAL::Spectral_geometry::Mesh_matrices& mesh,
                                        const Screen_frame& frame, double half_cube,
                                        const std::vector<Eigen::VectorXd>& shades)
{
  const bool wide = mesh.V.rows() > 65536;
  std::string points, triangles, values;
  const Eigen::MatrixXd V = frame.on_screen(mesh.V);
  for(Eigen::Index v = 0; v < V.rows(); ++v)
    for(int c = 0; c < 3; ++c)
      append(points, static_cast<std::uint32_t>(std::lround(65535 * (V(v, c) / half_cube + 1) / 2)),
             2);
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f)
    for(int c = 0; c < 3; ++c)
      append(triangles, static_cast<std::uint32_t>(mesh.T(f, c)), wide ? 4 : 2);
  for(const Eigen::VectorXd& shade : shades)
    for(const double x : shade)
      append(values, static_cast<std::uint32_t>(std::lround(255 * x)), 1);
  using png_internal::base64;
  return {{"name", name},
          {"wide", wide},
          {"points", base64(points)},
          {"triangles", base64(triangles)},
          {"values", base64(values)}};
}

inline std::string gradient(const Shown_function& f)
{
  std::string text = "linear-gradient(90deg";
  for(int i = 0; i <= 16; ++i) {
    const auto c = f.colour(i / 16.);
    text += ",rgb(" + std::to_string(c[0]) + "," + std::to_string(c[1]) + "," +
            std::to_string(c[2]) + ")";
  }
  return text + ")";
}

inline std::array<std::string, 3> ticks(const Shown_function& f)
{
  return {formatted(f.smallest()), formatted((f.smallest() + f.largest()) / 2),
          formatted(f.largest())};
}

inline nlohmann::ordered_json function_data(const Shown_function& f)
{
  std::string colours;
  for(int i = 0; i < 256; ++i)
    for(const int c : f.colour(i / 255.))
      colours += static_cast<char>(c);
  return {{"name", f.name},
          {"ticks", ticks(f)},
          {"gradient", gradient(f)},
          {"colours", png_internal::base64(colours)}};
}

// The element that the script puts a canvas in.
inline std::string panel(const std::string& name, const std::string& caption,
                         const CGAL::Spectral_geometry::Mesh_matrices& mesh,
                         const Screen_frame& frame, const Shown_function& f,
                         const Eigen::VectorXd& shade)
{
  Picture picture;
  picture.width = 400;
  picture.height = 287;
  picture.frame = frame;
  picture.colours.resize(shade.size(), 3);
  for(Eigen::Index i = 0; i < shade.size(); ++i) {
    const auto c = f.colour(shade(i));
    picture.colours.row(i) << c[0] / 255., c[1] / 255., c[2] / 255.;
  }
  const std::string text =
      caption + ", " + grouped(static_cast<std::size_t>(mesh.V.rows())) + " vertices";
  return "<figure id='shape-" + name + "'><figcaption>" + text + "</figcaption><img alt='" + text +
         "' src='" + mesh_picture(mesh, picture) + "'></figure>\n";
}

inline std::string controls(const std::vector<Shown_function>& functions)
{
  std::string html = "<p id='shape-controls' hidden><label>Colour <select id='shape-function'>";
  for(const Shown_function& f : functions)
    html += "<option>" + f.name + "</option>";
  return html + "</select></label> <label>Edges <select id='shape-edges'><option "
                "value='none'>none</option>"
                "<option value='coarse' selected>of OUTPUT</option><option value='both'>of "
                "both</option></select>"
                "</label> <button type='button' id='shape-reset'>Reset</button><br>"
                "<span class='note'>Drag to turn, with Shift to move; wheel or two fingers zoom; "
                "or arrows, +, − "
                "and 0 on "
                "the keyboard.</span></p>\n";
}

} // namespace shape_view_internal

// A part of a page. A mesh of more than `most_vertices` is a picture only, as it would make the
// page too large; where that is the fine one, a single function is shown.
inline std::string shape_view(const Viewed_mesh& fine, const Viewed_mesh& coarse,
                              const CGAL::Spectral_geometry::Spectral_evaluation& evaluation,
                              std::size_t most_vertices = 200000)
{
  using namespace shape_view_internal;
  const auto fits = [most_vertices](const Viewed_mesh& m) {
    return static_cast<std::size_t>(m.mesh.V.rows()) <= most_vertices;
  };
  std::vector<Shown_function> functions =
      shown_functions(fine.pairs, coarse.pairs, evaluation, fits(fine) ? 5 : 1);
  if(fits(fine))
    functions.push_back(distance_between(fine.mesh, coarse.mesh));
  std::vector<Eigen::VectorXd> of_fine, of_coarse;
  nlohmann::ordered_json data;
  for(const Shown_function& f : functions) {
    of_fine.push_back(f.shade(f.fine));
    of_coarse.push_back(f.shade(f.coarse));
    data["functions"].push_back(function_data(f));
  }
  const Screen_frame frame = screen_frame(fine.mesh.V);
  const double half_cube = (std::max)(frame.on_screen(fine.mesh.V).cwiseAbs().maxCoeff(),
                                      frame.on_screen(coarse.mesh.V).cwiseAbs().maxCoeff());
  data["half"] = {frame.half_width / half_cube, frame.half_height / half_cube};
  if(fits(fine))
    data["meshes"].push_back(mesh_data("fine", fine.mesh, frame, half_cube, of_fine));
  if(fits(coarse))
    data["meshes"].push_back(mesh_data("coarse", coarse.mesh, frame, half_cube, of_coarse));

  const Shown_function& first = functions.front();
  const auto t = ticks(first);
  std::string html = "<h2>The shape</h2>\n";
  if(!fits(fine))
    html += "<p class='note'>INPUT has more vertices than the " + grouped(most_vertices) +
            " that a page can turn: it stays a picture, and one function is shown.</p>\n";
  html += controls(functions) + "<div class='shapes'>\n" +
          panel("fine", "INPUT", fine.mesh, frame, first, of_fine.front()) +
          panel("coarse", "OUTPUT", coarse.mesh, frame, first, of_coarse.front()) +
          "</div>\n<div class='scale'><span id='shape-shown'>" + first.name +
          "</span><div id='shape-bar' style='background:" + gradient(first) +
          "'></div><div id='shape-ticks'><span>" + t[0] + "</span><span>" + t[1] + "</span><span>" +
          t[2] +
          "</span></div></div>\n"
          "<p class='note'>One scale for both meshes, each at unit area. Nearly equal coarse modes "
          "were rotated "
          "to the fine ones.</p>\n";
  if(data["meshes"].empty())
    return html;
  return html + "<script type='application/json' id='shape-data'>" + data.dump() +
         "</script>\n<script>" + shape_view_script() + "</script>\n";
}

#endif // SPECTRAL_EXAMPLES_REPORT_SHAPE_VIEW_H
