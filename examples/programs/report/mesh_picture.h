// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_MESH_PICTURE_H
#define SPECTRAL_EXAMPLES_REPORT_MESH_PICTURE_H

#include "png_image.h"

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Pictures of coloured meshes, drawn here: a report needs no viewer.

// What is seen of space: points, less the middle, are turned to the screen (x to the right, y up, z
// to the viewer).
struct Screen_frame
{
  Eigen::Matrix3d turn;
  Eigen::RowVector3d middle;
  double half_width, half_height; // what the picture shows at least

  Eigen::MatrixXd on_screen(const Eigen::MatrixXd& V) const
  {
    return (V.rowwise() - middle) * turn.transpose();
  }
};

// The frame of a mesh: the longest side of its box lies across, the shortest to the viewer, a
// little aslant. What is up in the file stays up.
inline Screen_frame screen_frame(const Eigen::MatrixXd& V)
{
  const Eigen::RowVector3d extent = V.colwise().maxCoeff() - V.colwise().minCoeff();
  std::array<int, 3> axis = {0, 1, 2};
  std::sort(axis.begin(), axis.end(), [&](int i, int j) { return extent(i) > extent(j); });
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  for(int i = 0; i < 3; ++i)
    turn(i, axis[static_cast<std::size_t>(i)]) = 1;
  turn.row(2) = turn.row(0).cross(turn.row(1)); // no mirror image
  const Eigen::Matrix3d aslant = (Eigen::AngleAxisd(0.25, Eigen::Vector3d::UnitX()) *
                                  Eigen::AngleAxisd(-0.5, Eigen::Vector3d::UnitY()))
                                     .toRotationMatrix();
  Screen_frame frame{aslant * turn, Eigen::RowVector3d::Zero(), 0, 0};
  const Eigen::MatrixXd turned = frame.on_screen(V);
  const Eigen::RowVector3d low = turned.colwise().minCoeff(), high = turned.colwise().maxCoeff();
  frame.middle = (low + high) / 2 * frame.turn;
  constexpr double filled = 0.94; // the rest is margin
  frame.half_width = (high(0) - low(0)) / 2 / filled;
  frame.half_height = (high(1) - low(1)) / 2 / filled;
  return frame;
}

struct Picture
{
  int width = 460, height = 330;
  Eigen::MatrixXd colours; // one row per vertex, red, green and blue in [0, 1]
  Eigen::VectorXd levels;  // optional, one per vertex: black lines where it passes an integer
  std::optional<Screen_frame> frame; // the mesh's own unless it is given
};

namespace mesh_picture_internal {

struct Raster
{
  int width, height;
  std::vector<double> depth, level;
  std::vector<Eigen::Vector3d> colour;
};

inline void draw_triangle(Raster& raster, const Eigen::Matrix3d& p, const Eigen::Matrix3d& colours,
                          const Eigen::Vector3d& levels)
{
  const Eigen::Vector3d a = p.col(1) - p.col(0), b = p.col(2) - p.col(0);
  const double determinant = a.x() * b.y() - a.y() * b.x();
  if(!(std::abs(determinant) > 0))
    return;
  const Eigen::Vector3d towards_light(0.3, -0.5, 0.81); // from above: y points down here
  const double light = 0.45 + 0.55 * std::abs(a.cross(b).normalized().dot(towards_light));
  const auto first = [](double x) { return (std::max)(0, static_cast<int>(std::ceil(x))); };
  const int x1 = (std::min)(raster.width - 1, static_cast<int>(std::floor(p.row(0).maxCoeff())));
  const int y1 = (std::min)(raster.height - 1, static_cast<int>(std::floor(p.row(1).maxCoeff())));
  for(int y = first(p.row(1).minCoeff()); y <= y1; ++y)
    for(int x = first(p.row(0).minCoeff()); x <= x1; ++x) {
      const double dx = x - p(0, 0), dy = y - p(1, 0);
      const double v = (dx * b.y() - dy * b.x()) / determinant,
                   w = (a.x() * dy - a.y() * dx) / determinant;
      if(v < -1e-9 || w < -1e-9 || v + w > 1 + 1e-9)
        continue;
      const Eigen::Vector3d weights(1 - v - w, v, w);
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(raster.width) +
          static_cast<std::size_t>(x);
      const double depth = p.row(2).dot(weights);
      if(depth <= raster.depth[pixel])
        continue;
      raster.depth[pixel] = depth;
      raster.level[pixel] = std::floor(levels.dot(weights));
      raster.colour[pixel] = light * (colours * weights);
    }
}

// Black where the level changes to the right or below and the surface goes on.
inline void draw_lines(Raster& raster, double largest_step)
{
  const std::vector<double> level = raster.level;
  for(int y = 0; y + 1 < raster.height; ++y)
    for(int x = 0; x + 1 < raster.width; ++x) {
      const std::size_t here =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(raster.width) +
          static_cast<std::size_t>(x);
      for(const std::size_t other : {here + 1, here + static_cast<std::size_t>(raster.width)})
        if(level[here] != level[other] &&
           std::abs(raster.depth[here] - raster.depth[other]) < largest_step)
          raster.colour[here] = raster.colour[other] = Eigen::Vector3d::Zero();
    }
}

} // namespace mesh_picture_internal

// A `data:` address of the picture of a mesh.
inline std::string mesh_picture(const CGAL::Spectral_geometry::Mesh_matrices& mesh,
                                const Picture& picture)
{
  using namespace mesh_picture_internal;
  constexpr int samples = 2; // in each direction
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const int width = samples * picture.width, height = samples * picture.height;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  Raster raster{width, height, std::vector<double>(pixels, -infinity),
                std::vector<double>(pixels, 0.),
                std::vector<Eigen::Vector3d>(pixels, Eigen::Vector3d::Ones())};

  const Screen_frame frame = picture.frame ? *picture.frame : screen_frame(mesh.V);
  Eigen::MatrixXd V = frame.on_screen(mesh.V) *
                      (std::min)(width / (2 * frame.half_width), height / (2 * frame.half_height));
  V.col(0).array() += width / 2.;
  V.col(1) = (height / 2. - V.col(1).array()).matrix();
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f) {
    Eigen::Matrix3d p, colours;
    Eigen::Vector3d levels = Eigen::Vector3d::Zero();
    for(int c = 0; c < 3; ++c) {
      p.col(c) = V.row(mesh.T(f, c)).transpose();
      colours.col(c) = picture.colours.row(mesh.T(f, c)).transpose();
      if(picture.levels.size() > 0)
        levels(c) = picture.levels(mesh.T(f, c));
    }
    draw_triangle(raster, p, colours, levels);
  }
  if(picture.levels.size() > 0)
    draw_lines(raster, 0.02 * width);

  std::string rows;
  for(int y = 0; y < picture.height; ++y) {
    rows += '\1'; // the filter: differences to the pixel on the left
    std::array<long, 3> left = {0, 0, 0};
    for(int x = 0; x < picture.width; ++x) {
      Eigen::Vector3d colour = Eigen::Vector3d::Zero();
      for(int i = 0; i < samples; ++i)
        for(int j = 0; j < samples; ++j)
          colour += raster.colour[static_cast<std::size_t>(samples * y + i) *
                                      static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(samples * x + j)];
      for(int c = 0; c < 3; ++c) {
        const long here = std::lround(255 * std::clamp(colour(c) / (samples * samples), 0., 1.));
        rows += static_cast<char>(here - std::exchange(left[static_cast<std::size_t>(c)], here));
      }
    }
  }
  return png_address(picture.width, picture.height, 2, "", rows);
}

// Colours by position in the box, brighter than black: what is near looks alike.
inline Eigen::MatrixXd colours_by_position(const Eigen::MatrixXd& V)
{
  const Eigen::RowVector3d low = V.colwise().minCoeff();
  const Eigen::RowVector3d extent = (V.colwise().maxCoeff() - low).cwiseMax(1e-300);
  return (0.1 + 0.9 * ((V.rowwise() - low).array().rowwise() / extent.array())).matrix();
}

// From white through orange to dark, of values in [0, 1].
inline Eigen::MatrixXd colours_of_values(const Eigen::VectorXd& values)
{
  Eigen::MatrixXd colours(values.size(), 3);
  for(Eigen::Index i = 0; i < values.size(); ++i) {
    const double t = std::clamp(values(i), 0., 1.);
    colours.row(i) << 1 - 0.45 * t * t, 0.95 - 0.75 * t, 0.8 - 0.75 * std::sqrt(t);
  }
  return colours;
}

#endif // SPECTRAL_EXAMPLES_REPORT_MESH_PICTURE_H
