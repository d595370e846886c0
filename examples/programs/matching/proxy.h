// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_PROXY_H
#define SPECTRAL_EXAMPLES_MATCHING_PROXY_H

#include "../io/mesh_io.h"

#include <CGAL/Spectral_toolbox/functional_map_estimation.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>

#include <Eigen/SparseCore>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

// A mesh with its spectrum at unit area, and the scale that made it so.
struct Shape
{
  CGAL::Spectral_geometry::Mesh_matrices matrices; // in the unit of the file
  // The mesh that was reduced to this one, if one was.
  std::optional<CGAL::Spectral_geometry::Mesh_matrices> full;
  CGAL::Spectral_geometry::Spectral_shape spectral;
  double area = 0; // in the unit of the file

  // As read: the mesh whose vertices a match is about.
  const CGAL::Spectral_geometry::Mesh_matrices& read() const { return full ? *full : matrices; }
};

// A large mesh that is matched by way of a smaller one.
struct Reduced_mesh
{
  Mesh mesh;
  std::vector<Eigen::Index> vertex_map; // for each vertex of the large mesh the one that it went to
};

// The mesh of these vertices and triangles, in their order.
Mesh mesh_of(const CGAL::Spectral_geometry::Mesh_matrices& matrices);

// Reduces a larger mesh to so many vertices by quadrics alone.
Reduced_mesh reduced_by_quadrics(Mesh mesh, std::size_t vertices,
                                 const std::function<bool()>& keep_going);

enum class Proxy_kind { spectral, garland_heckbert, garland_heckbert_probabilistic, none };

const char* proxy_name(Proxy_kind kind);

// A coarse mesh that stands for a fine one; with `Proxy_kind::none` the fine one itself.
struct Proxy
{
  Shape shape;
  Eigen::SparseMatrix<double> restriction; // coarse x fine, binary
  // For each coarse vertex the fine one that the restriction picks.
  std::vector<Eigen::Index> representative;
  std::vector<std::size_t> vertex_map; // for each fine vertex the coarse one it went to
};

// What a proxy computes with: its own cotangents and areas, or `fit_operators()`.
enum class Proxy_operators { fitted, mesh };

// Returns false to stop.
using Keep_going = std::function<bool()>;

// `fit`, if there is one, changes the operator.
Shape make_shape(CGAL::Spectral_geometry::Mesh_matrices matrices, Eigen::Index modes,
                 CGAL::Spectral_geometry::Mass mass, const Keep_going& keep_going,
                 const std::function<void(CGAL::Spectral_geometry::Laplace_operator&)>& fit = {});

// The mass is that of `options`, which say how to simplify spectrally, but for relocation: the
// matches are vertices of `mesh`. Throws std::runtime_error where it cannot be reduced to exactly
// `vertices`.
Proxy make_proxy(const Mesh& mesh, const Shape& fine, Proxy_kind kind, std::size_t vertices,
                 Eigen::Index modes,
                 const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options& options,
                 Proxy_operators operators, const Keep_going& keep_going);

// Makes one of a coarse mesh, whoever made it. A coarse vertex stands for the nearest corner of the
// fine triangle that is closest to it. Throws std::runtime_error, with the end of a sentence, where
// it does not lie on the fine mesh.
Proxy make_foreign_proxy(const Mesh& coarse, const Shape& fine, Eigen::Index modes,
                         CGAL::Spectral_geometry::Mass mass, Proxy_operators operators,
                         const Keep_going& keep_going);

#endif // SPECTRAL_EXAMPLES_MATCHING_PROXY_H
