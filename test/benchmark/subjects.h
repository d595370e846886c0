// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_BENCHMARK_SUBJECTS_H
#define SPECTRAL_BENCHMARK_SUBJECTS_H

#include <cstddef>
#include <limits>
#include <string>

// What is measured, apart from the program around it because CGAL's templates take their time to
// compile. A mesh is given by the name of its file, or as "generated:N": a closed shape without
// symmetry of about N vertices, or as "disc:D" and "gear:D", with one vertex of D neighbours in 1 +
// D, and two in 2 + 4 D.

struct Setting
{
  std::size_t target = 0;
  long eigenvectors = 100;
  std::size_t pre_simplify = 0;
  double quadrics_above = std::numeric_limits<double>::infinity();
  bool paper = false;         // the preset
  bool all_in_metric = false; // all eigenvectors, however few vertices remain
  bool loop_alone = false;    // no relocation afterwards
};

struct Mesh_size
{
  std::size_t vertices = 0, edges = 0;
};

struct Spectral_time
{
  double seconds_pre_simplification = 0, seconds_eigenpairs = 0, seconds_first_costs = 0,
         seconds_collapse = 0, seconds_total = 0;
  std::size_t edges = 0; // when the first costs are computed
  std::size_t evaluations = 0, collapses = 0;
};

struct Collapse_time
{
  double seconds = 0;
  std::size_t collapses = 0;
};

struct Eigenpairs_time
{
  double seconds = 0, residual = 0;
};

enum class Rival { garland_heckbert, lindstrom_turk };
enum class Solver { block, spectra };

Mesh_size measure_mesh(const std::string& mesh);

// The whole of spectral_edge_collapse().
Spectral_time measure_spectral(const std::string& mesh, const Setting& setting, int threads);

// CGAL's edge_collapse() with a cost and placement of its own, their construction included.
Collapse_time measure_rival(const std::string& mesh, Rival rival, std::size_t target);

// A program outside of CGAL, from its start to its end, reading and writing included, or, where it
// leaves PREFIX.seconds, so long. It is called as doc/run_rivals.sh says: `program INPUT N PREFIX`.
// Throws with its last words when it fails.
Collapse_time measure_program(const std::string& program, const std::string& mesh,
                              std::size_t target);

// eigenpairs(), without the Laplacian; `residual` is the largest.
Eigenpairs_time measure_eigenpairs(const std::string& mesh, const Setting& setting, Solver solver,
                                   double tolerance, int threads);

// What spectral_edge_collapse() is expected to take, in bytes.
double estimated_memory(std::size_t vertices, const Setting& setting);

// The tolerance of the basis that spectral_edge_collapse() computes by default.
double default_tolerance();

// With which flags of the compiler's choice this program was built, and with which BLAS it runs.
std::string build_description();

#endif // SPECTRAL_BENCHMARK_SUBJECTS_H
