// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The fallback for compilers without vectors as a language extension.

#define CGAL_SPECTRAL_NO_VECTOR_EXTENSION

// Compiled here and not taken from the library, which has vectors.
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/compile_loop.h>

#include "catch.h"
#include "core_helpers.h"

using namespace spectral_test;
using SMS::Spectral_placement_strategy;

TEST_CASE("Without vector extensions local costs are the change of the global E")
{
  static_assert(std::is_class<SMS::internal::Spectral_quad>::value, "four doubles in a class");
  const bool bordered = GENERATE(false, true);
  const double theta = GENERATE(0., 0.5);
  const int K = GENERATE(10, 16, 20); // with and without padding, in one block and in two
  const Spectral_placement_strategy placement =
      GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::free);
  CAPTURE(bordered, theta, K, int(placement));
  const shapes::Matrices input =
      bordered ? wavy_grid_matrices(13, 12) : shapes::bumpy_icosphere_matrices(2);
  const Basis basis = eigenbasis(input, theta, K);
  Slow_mesh mesh(input, basis);
  Parameters parameters = Parameters::paper();
  parameters.placement = placement;
  Core core = make_core(mesh, basis, parameters);
  std::mt19937 random(7);
  for(const int collapses : {0, 20, 40}) {
    CHECK(simplify(core, mesh, collapses, random) == collapses);
    CHECK(compare_costs(core, mesh, 8, random).worst < 1e-9);
    CHECK(relative_difference(core.total() + basis.Z.squaredNorm(),
                              mesh.energy() + basis.Z.squaredNorm()) < 1e-9);
  }
}

TEST_CASE("The blocks of signals begin with a cache line and are padded with zeros")
{
  const Eigen::Index length = GENERATE(1, 8, 13, 16, 17);
  const Eigen::MatrixXd F = Eigen::MatrixXd::Random(5, length),
                        Z = Eigen::MatrixXd::Random(5, length);
  SMS::internal::Spectral_signals signals(5, length);
  signals.set(0, F, Z);
  CHECK(signals.size() == length);
  REQUIRE(signals.number_of_blocks() == (length + 15) / 16);
  for(std::size_t w = 0; w < 5; ++w)
    for(Eigen::Index k = 0; k < 16 * signals.number_of_blocks(); ++k) {
      const SMS::internal::Spectral_block& block = signals[w][k / 16];
      CHECK(reinterpret_cast<std::uintptr_t>(&block) % 64 == 0);
      CHECK(block.f[k % 16] == (k < length ? F(Eigen::Index(w), k) : 0.));
      CHECK(block.z[k % 16] == (k < length ? Z(Eigen::Index(w), k) : 0.));
      CHECK(block.r[k % 16] == 0.);
    }
}
