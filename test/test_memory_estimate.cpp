// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// What a run is said to take before it starts.

#include <CGAL/Spectral_toolbox/Spectral_memory_estimate.h>

#include "catch.h"

namespace test_memory_estimate {

TEST_CASE("The memory estimate grows with the mesh and K, and shrinks with what is not needed")
{
  const double plain = SMS::estimated_memory(50000, 100);
  CHECK(plain > 104e6); // the solver's vectors alone
  CHECK(plain < 500e6);
  CHECK(SMS::estimated_memory(500000, 100) == Catch::Approx(10 * plain).epsilon(0.01));
  CHECK(SMS::estimated_memory(50000, 400) > 2.6 * 50000 * 400 * 8.);
  SMS::Spectral_edge_collapse_options options;
  options.pre_simplify = 100000;
  CHECK(SMS::estimated_memory(50000, 100, options) == plain);
  CHECK(SMS::estimated_memory(1000000, 100, options) < 0.5 * SMS::estimated_memory(1000000, 100));
  options = SMS::Spectral_edge_collapse_options();
  options.relocate = false;
  const double without_relocation = SMS::estimated_memory(50000, 100, options);
  CHECK(without_relocation <= plain); // 64 mixtures are less than the loop takes
  options.number_of_mixtures = 0;     // F, Z and R of all
  CHECK(SMS::estimated_memory(50000, 100, options) > without_relocation + 2. * 50000 * 84 * 8);
  options.number_of_mixtures = SMS::Spectral_options().number_of_mixtures;
  options.source = SMS::Spectral_signal_source::filtered_noise;
  const double noise = SMS::estimated_memory(50000, 100, options);
  CHECK(SMS::estimated_memory(50000, 300, options) == noise); // 64 signals, whatever K
  options.source = SMS::Spectral_signal_source::eigenpairs;
  CHECK(SMS::estimated_memory(50000, 300, options) > noise);
  options.eigenpairs_options.maximum_vectors = 800;
  CHECK(SMS::estimated_memory(50000, 100, options) > without_relocation);
  options.eigenpairs = std::make_shared<SG::Eigenpairs>();
  CHECK(SMS::estimated_memory(50000, 100, options) <= without_relocation);
}

TEST_CASE("A fit of operators takes another solve, of the whole input")
{
  SMS::Spectral_edge_collapse_options options;
  CHECK(SMS::estimated_memory(50000, 100, options, true) >
        SMS::estimated_memory(50000, 100, options) + 0.2 * 50000 * 100 * 8);
  options.pre_simplify = 10000;
  CHECK(SMS::estimated_memory(50000, 100, options, true) > 2.6 * 50000 * 120 * 8);
  options.eigenpairs = std::make_shared<SG::Eigenpairs>();
  CHECK(SMS::estimated_memory(50000, 100, options, true) ==
        SMS::estimated_memory(50000, 100, options));
}

TEST_CASE("The memory estimate knows of dense solves")
{
  // L, B, their factor, the reduced matrix and the vectors: at least five matrices of n^2
  SMS::Spectral_edge_collapse_options options;
  const double loop = 8. * 3. * 4000 * 1000;
  CHECK(SMS::estimated_memory(4000, 3950, options) > 8. * 5 * 4000 * 4000);
  CHECK(SMS::estimated_memory(4000, 1000, options) < 8. * 4000 * 4000 + 2. * loop);
  options.eigenpairs_options.method = SG::Eigenpairs_method::dense;
  CHECK(SMS::estimated_memory(20000, 50, options) > 8. * 5 * 20000. * 20000.);
  options.pre_simplify = 2000;
  CHECK(SMS::estimated_memory(20000, 50, options) > 8. * 5 * 2000 * 2000);
  CHECK(SMS::estimated_memory(20000, 50, options) < 8. * 20000. * 20000.);
}

TEST_CASE("To judge a pre-simplified run takes what the eigenpairs of the whole input take")
{
  SMS::Spectral_edge_collapse_options options;
  options.pre_simplify = 100000;
  const double run = SMS::estimated_memory(4000000, 100, options),
               evaluation = SMS::estimated_evaluation_memory(4000000, 1000, 100);
  CHECK(evaluation > run);
  CHECK(evaluation > 3. * 8. * 4e6 * 100);
  CHECK(SMS::estimated_evaluation_memory(4000000, 1000, 100, {}, true) < 0.5 * evaluation);
  // a coarse mesh of as many pairs as vertices is solved densely beside the pairs of the input
  CHECK(SMS::estimated_evaluation_memory(50000, 5000, 5000, {}, true) >
        8. * (5e4 * 5000 + 5. * 5000 * 5000));
}

TEST_CASE("The memory estimate knows the projected problem, and slices of the spectrum")
{
  // A solve for 500 pairs of 3,600 vertices took 72 MB, for 800 in one space 146, in slices 51.
  SG::Eigenpairs_options options;
  const auto megabytes = [&](double K) {
    return SMS::internal::memory_of_eigenpairs(3600, K, options) / 1e6;
  };
  CHECK(megabytes(500) == Catch::Approx(76).epsilon(0.1));
  CHECK(megabytes(800) == Catch::Approx(51).epsilon(0.1));
  options.maximum_vectors = 2080;
  CHECK(megabytes(800) > 146);
}

TEST_CASE("The memory estimate knows the shape term and the tree of boxes")
{
  SMS::Spectral_edge_collapse_options options = SMS::Spectral_edge_collapse_options::paper();
  const double plain = SMS::estimated_memory(100000, 200, options);
  options.eigenpairs = std::make_shared<SG::Eigenpairs>(); // the loop alone
  const double loop = SMS::estimated_memory(100000, 200, options);
  CHECK(loop <= plain);
  options.shape = 3;
  CHECK(SMS::estimated_memory(100000, 200, options) == Catch::Approx(loop + 100000 * 104.));
  options.keep_free_of_self_intersections = true;
  CHECK(SMS::estimated_memory(100000, 200, options) > loop + 100000 * 200.);
}

} // namespace test_memory_estimate
