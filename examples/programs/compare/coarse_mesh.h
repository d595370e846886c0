// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_COMPARE_COARSE_MESH_H
#define SPECTRAL_EXAMPLES_COMPARE_COARSE_MESH_H

#include "../io/mesh_io.h"

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>

#include <Eigen/SparseCore>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// What a simplifier hands to the evaluation.
struct Coarse_mesh
{
  Mesh mesh; // without garbage
  // P of the simplifier, rows as `vertices(mesh)`.
  std::optional<Eigen::SparseMatrix<double>> carried;
  std::vector<std::size_t> vertex_map; // of collapses by CGAL's costs: where each fine vertex went
  double seconds = 0;
  std::string note; // a sentence where the result is not what was asked for
};

// A basis for the spectral metric, computed once for all sizes.
struct Basis
{
  CGAL::Spectral_geometry::Mass mass;
  std::shared_ptr<const CGAL::Spectral_geometry::Eigenpairs> pairs;
  double seconds = 0;
  std::uint64_t seed = 1; // of the mixtures of eigenvectors
};

struct Simplifier
{
  std::string name, placement, metric_mass = "none";
  double seconds_eigenpairs = 0; // of the basis that it needs
  std::function<Coarse_mesh(const Mesh& fine, std::size_t N)> run;
  std::string relocation = "none"; // by which signals vertices are moved afterwards
  double shape = 0;                // weight of the shape term
  bool fits_operators = false;     // a row with operators fitted to the fine spectrum follows
};

// The basis that the policies compute when they are given none: their own accuracy, not that of the
// judge.
Basis spectral_basis(const Mesh& fine, Eigen::Index K, CGAL::Spectral_geometry::Mass mass);

// Edge collapses: spectral in the metrics of the bases, and the costs that CGAL ships.
std::vector<Simplifier> collapse_simplifiers(const Mesh& fine, const std::vector<Basis>& bases,
                                             int threads);

// CGAL's remeshers; those that this CGAL or the mesh does not allow are explained in `notes`.
std::vector<Simplifier> remeshers(const Mesh& fine, std::vector<std::string>& notes);

#endif // SPECTRAL_EXAMPLES_COMPARE_COARSE_MESH_H
