// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The fallback for compilers without vectors as a language extension.

#define CGAL_SPECTRAL_NO_VECTOR_EXTENSION

#include "catch.h"
#include "core_helpers.h"

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
  CAPTURE(bordered, theta, z == Z_rows::stored, SMS::placement_name(placement));
  const shapes::Matrices input = bordered ? wavy_grid_matrices(13, 12) : shapes::bumpy_icosphere_matrices(2);
  const Basis basis = eigenbasis(input, theta, 10);
  Slow_mesh mesh(input, basis);
  Parameters parameters;
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
