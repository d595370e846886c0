// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_POLYGON_SOUP_H
#define SPECTRAL_EXAMPLES_IO_POLYGON_SOUP_H

#include "attributes.h"

#include <CGAL/Simple_cartesian.h>

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

using Kernel = CGAL::Simple_cartesian<double>;

using Texture_point = std::array<double, 2>;

// Coordinates in a texture at the corners of faces.
using Corner_texture = std::vector<Texture_point>;

// What a mesh file holds, before anybody has looked whether it is a mesh.
struct Polygon_soup
{
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
  Attributes attributes = {};      // of the points, as long as they are those of the file
  Attributes face_attributes = {}; // of the polygons, likewise
  std::vector<std::string> material_libraries = {}; // files, as an OBJ file names them
  Corner_texture texture = {}; // at the corners of one polygon after the other, or empty
  std::string without_texture =
      "it has no texture coordinates"; // why it is empty, the end of a sentence
};

// An index that no file can mean; the diagnosis names the face that uses it.
constexpr std::size_t no_vertex = (std::numeric_limits<std::size_t>::max)();

#endif // SPECTRAL_EXAMPLES_IO_POLYGON_SOUP_H
