// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_COMPARE_COLOURED_MESH_H
#define SPECTRAL_EXAMPLES_COMPARE_COLOURED_MESH_H

#include "../io/mesh_io.h"
#include "../io/output_files.h"
#include "../report/png_image.h"

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_toolbox/spectral_distances.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

// Meshes with functions on them, for MeshLab, ParaView, F3D: PLY with named scalar properties of
// the vertices. Viewers that know no names show the colours, or the quality: both are those of the
// distance.

struct Vertex_functions
{
  std::vector<std::pair<std::string, Eigen::VectorXd>> named;
  Eigen::VectorXd shade; // in [0, 1], for the colours
};

// What colours of the fine and the coarse mesh have in common.
struct Colour_scale
{
  double hks_time = 0, largest_distance = 0;
};

// eigenvector_2, ..., eigenvector_11 (the first is constant), hks at one time and the biharmonic
// distance from `source`, all at input scale.
inline Vertex_functions vertex_functions(const CGAL::Spectral_geometry::Eigenpairs& pairs,
                                         Eigen::Index source, const Colour_scale& scale)
{
  namespace SG = CGAL::Spectral_geometry;
  Vertex_functions result;
  for(Eigen::Index k = 1; k < (std::min)(pairs.size(), Eigen::Index(11)); ++k)
    result.named.emplace_back("eigenvector_" + std::to_string(k + 1), pairs.vectors.col(k));
  result.named.emplace_back(
      "hks", SG::heat_kernel_signature(pairs, Eigen::VectorXd::Constant(1, scale.hks_time)).col(0));
  const Eigen::VectorXd distance = SG::squared_biharmonic_distance(pairs, source).cwiseSqrt();
  result.named.emplace_back("distance", distance);
  result.named.emplace_back("quality", distance);
  result.shade = distance / scale.largest_distance;
  return result;
}

inline void write_coloured_ply(const std::string& file, const Mesh& mesh,
                               const Vertex_functions& functions, const std::string& name)
{
  std::ofstream stream(file);
  stream << "ply\nformat ascii 1.0\nelement vertex " << mesh.number_of_vertices()
         << "\nproperty double x\nproperty double y\nproperty double z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  for(const auto& function : functions.named)
    stream << "property float " << function.first << '\n';
  stream << "element face " << mesh.number_of_faces()
         << "\nproperty list uchar int vertex_indices\nend_header\n";
  std::vector<std::size_t> position(mesh.num_vertices());
  Eigen::Index i = 0;
  for(const auto v : vertices(mesh)) {
    position[v] = static_cast<std::size_t>(i);
    const Kernel::Point_3& p = mesh.point(v);
    const std::array<int, 3> colour = sequential_colour(functions.shade(i));
    stream.precision(17);
    stream << p.x() << ' ' << p.y() << ' ' << p.z() << ' ' << colour[0] << ' ' << colour[1] << ' '
           << colour[2];
    stream.precision(9);
    for(const auto& function : functions.named)
      stream << ' ' << static_cast<float>(function.second(i));
    stream << '\n';
    ++i;
  }
  for(const auto f : faces(mesh)) {
    stream << 3;
    for(const auto v : vertices_around_face(halfedge(f, mesh), mesh))
      stream << ' ' << position[v];
    stream << '\n';
  }
  finish_writing(stream, name);
}

#endif // SPECTRAL_EXAMPLES_COMPARE_COLOURED_MESH_H
