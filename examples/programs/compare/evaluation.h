// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_COMPARE_EVALUATION_H
#define SPECTRAL_EXAMPLES_COMPARE_EVALUATION_H

#include "../report/Comparison.h"

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Judges coarse meshes against one fine mesh.

// The fine mesh in one mass, with 1.5 K tight eigenpairs that serve all that is judged.
struct Fine_reference
{
  std::string mass;
  CGAL::Spectral_geometry::Laplace_operator op;
  CGAL::Spectral_geometry::Eigenpairs pairs;
  Eigen::Index K = 0;
  std::vector<Eigen::Index> sources; // of distances, fine vertices
};

// A coarse mesh, or an operator that stands for one.
struct Coarse_candidate
{
  CGAL::Spectral_geometry::Laplace_operator op;
  std::optional<Eigen::SparseMatrix<double>> carried, closest;
  Eigen::SparseMatrix<double> prolongation; // empty for an operator

  const Eigen::SparseMatrix<double>& restriction() const { return carried ? *carried : *closest; }
};

// The judgement, and the coarse eigenpairs aligned with the fine ones, at input scale.
struct Judged
{
  Judgement judgement;
  CGAL::Spectral_geometry::Eigenpairs aligned;
};

// The fine mesh in one mass. `progress` returns false to cancel.
Fine_reference fine_reference(const CGAL::Spectral_geometry::Mesh_matrices& mesh,
                              CGAL::Spectral_geometry::Mass mass, Eigen::Index K,
                              const std::vector<Eigen::Index>& sources,
                              const std::function<bool(double)>& progress);

// For each source the coarse vertex that its value goes to most, and the fine vertex that counts
// most in that one: the two stand for the same place as well as any.
std::pair<std::vector<Eigen::Index>, std::vector<Eigen::Index>>
paired_sources(const std::vector<Eigen::Index>& sources, const Eigen::SparseMatrix<double>& P);

// All figures of one coarse mesh in one mass. `progress` returns false to cancel.
Judged judge(const Fine_reference& reference, const Coarse_candidate& candidate,
             const std::function<bool(double)>& progress);

#endif // SPECTRAL_EXAMPLES_COMPARE_EVALUATION_H
