// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The fallback for compilers without vectors as a language extension, and the memory that vectors are loaded from.

#define CGAL_SPECTRAL_NO_VECTOR_EXTENSION

// Compiled here and not taken from the library, which has vectors.
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_collapse_core_impl.h>

#include "catch.h"
#include "core_helpers.h"

#include <cstdint>
#include <random>
#include <type_traits>

using namespace spectral_test;
using SMS::Spectral_placement_strategy;

TEST_CASE("Without vector extensions local costs are the change of the global E")
{
  static_assert(std::is_class<SMS::internal::Spectral_lanes>::value, "four doubles in a class");
  const bool bordered = GENERATE(false, true);
  const double theta = GENERATE(0., 0.5);
  const Z_rows z = GENERATE(Z_rows::from_lambda, Z_rows::stored);
  const Spectral_placement_strategy placement =
      GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::free);
  CAPTURE(bordered, theta, z == Z_rows::stored, int(placement));
  const shapes::Matrices input = bordered ? wavy_grid_matrices(13, 12) : shapes::bumpy_icosphere_matrices(2);
  const Basis basis = eigenbasis(input, theta, 10);
  Slow_mesh mesh(input, basis);
  Parameters parameters = Parameters::paper();
  parameters.placement = placement;
  parameters.threads = 2;
  Core core = make_core(mesh, basis, z, parameters);
  std::mt19937 random(7);
  for(const int collapses : {0, 20, 40}) {
    CHECK(simplify(core, mesh, collapses, random) == collapses);
    CHECK(compare_costs(core, mesh, 8, random).worst < 1e-9);
    CHECK(relative_difference(core.total() + basis.Z.squaredNorm(), mesh.energy() + basis.Z.squaredNorm()) <
          1e-9);
  }
}

TEST_CASE("Rows begin with a cache line and are padded with zeros")
{
  using SMS::internal::cache_line;
  const Eigen::Index length = GENERATE(1, 8, 13);
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(5, length);
  SMS::internal::Spectral_rows rows;
  CHECK(rows.empty());
  rows.assign(7, 30); // what was there before must not shine through
  rows.row(0).setOnes();
  rows.assign(matrix);
  REQUIRE(rows.cols() >= length);
  CHECK(rows.cols() * sizeof(double) % cache_line == 0);
  for(std::size_t i = 0; i < 5; ++i) {
    CHECK(reinterpret_cast<std::uintptr_t>(rows[i]) % cache_line == 0);
    CHECK(rows.row(i).head(length) == matrix.row(Eigen::Index(i)));
    CHECK(rows.row(i).tail(rows.cols() - length).isZero(0));
  }
  rows.assign(0, length);
  CHECK(rows.empty());
}
