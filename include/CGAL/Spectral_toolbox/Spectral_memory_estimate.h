// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_SPECTRAL_MEMORY_ESTIMATE_H
#define CGAL_SPECTRAL_TOOLBOX_SPECTRAL_MEMORY_ESTIMATE_H

#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_shape_term.h>

#include <CGAL/Spectral_geometry/eigenpairs.h>

namespace CGAL::Surface_mesh_simplification {

namespace internal {

constexpr double bytes_of_mesh = 300; ///< for each vertex

/// What `Spectral_geometry::eigenpairs()` takes, its result included.
inline double memory_of_eigenpairs(const double n, const double K,
                                   const Spectral_geometry::Eigenpairs_options& options)
{
  const double factor = 900; // matrices and their factor, for each vertex
  if(Spectral_geometry::internal::is_sliced(Eigen::Index(n), Eigen::Index(K), options))
    return n * (8 * (K + 750) + factor);
  if(Spectral_geometry::internal::is_dense(Eigen::Index(n), Eigen::Index(K), options.method))
    return n * (8 * 5.2 * n + factor);
  // Vectors, and entries of the projected matrices.
  const double most = double(options.maximum_vectors);
  const double space = most > 0 ? most : (std::max)(2.6 * K, K + 120);
  const double projected = most > 0 ? 4 * most * most : 20 * K * K;
  return n * (8 * space + factor) + 8 * projected;
}

} // namespace internal

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * Returns an estimate of the peak memory of `spectral_edge_collapse()` in bytes, the mesh included.
 * Compare it with the memory of the machine before you start a large mesh. Two phases compete. The
 * Krylov space of the eigensolver has 2.6 K vectors of n doubles, and its projected problem 20 K^2
 * doubles. (Other cases: `Eigenpairs_options::maximum_vectors`; K + 750 vectors beyond 500 pairs;
 * 3.5 K with more than four components, which is not checked; 5.2 n^2 doubles for a dense solve,
 * see `Eigenpairs_method`.) The loop keeps the eigenpairs (n K doubles) and 384 bytes per vertex
 * for every 16 signals or mixtures that the metric sees. Relocation keeps F and Z of these, and the
 * rows of them that it reads; `fit_operators_of_run()` solves once more beside them. Filtered noise
 * takes a factor and the signals. The constants were measured on closed meshes of 50,000 to 500,000
 * vertices; estimates are within about a quarter.
 *
 * With `Spectral_edge_collapse_options::pre_simplify` both phases see the reduced mesh, and the
 * first stage takes a number of bytes per vertex of the input that does not depend on K. What
 * `quadrics_above` saves in the loop is not subtracted, and eigenpairs that judge the relocation of
 * `fast()` (K up to 32, or below 2 K vertices) are not added.
 *
 * The shape term keeps a quadric for each vertex,
 * `Spectral_options::keep_free_of_self_intersections` a tree of boxes.
 *
 * @param number_of_vertices n of the input
 * @param number_of_eigenvectors K, at least 1; the number of columns where signals or eigenpairs
 * are given
 * @param options `signals`, `eigenpairs`, `shape`, `keep_free_of_self_intersections`, `relocate`,
 *        `pre_simplify`, `coefficients` and `eigenpairs_options` matter, placement and so on do not
 * @param fits_operators whether `fit_operators_of_run()` follows
 */
inline double
estimated_memory(const std::size_t number_of_vertices, const Eigen::Index number_of_eigenvectors,
                 const Spectral_edge_collapse_options& options = Spectral_edge_collapse_options(),
                 const bool fits_operators = false)
{
  const bool reduced = options.pre_simplify != 0 && number_of_vertices > options.pre_simplify;
  const double input = double(number_of_vertices),
               n = reduced ? double(options.pre_simplify) : input;
  const double K = double(number_of_eigenvectors);
  const bool filtered = internal::is_filtered(options);
  const bool solves = options.signals.size() == 0 && !options.eigenpairs && !filtered;
  const double seen =
      options.number_of_mixtures == 0 ? K : (std::min)(K, double(options.number_of_mixtures));
  const double noise =
      double((std::max)(internal::mixtures_of_relocation, options.number_of_mixtures));

  // Bytes per vertex: rings and CGAL's queue; the first stage.
  const double first_stage = options.keep_free_of_self_intersections ? 600 : 500;
  double loop =
      1650 + sizeof(internal::Spectral_block) * std::ceil(seen / internal::spectral_width);
  if(options.shape > 0)
    loop += sizeof(internal::Spectral_quadric);
  if(options.keep_free_of_self_intersections) // a leaf and a node above it
    loop += 1.5 * 2 * sizeof(Eigen::AlignedBox3d) + 8;
  const double solver = solves ? internal::memory_of_eigenpairs(n, K, options.eigenpairs_options)
                        : filtered ? n * (900 + 8 * 3 * noise)
                                   : 0;
  // Columns that stay: eigenvectors, those of the user, F and Z of filtered noise.
  const double given = filtered ? 2 * noise : options.signals.size() != 0 ? 3 * K : K;
  const double collapses = n * (8 * given + loop);
  // F and Z, unless they are those of the collapses, and the rows that are read: half, say.
  const double after = !options.relocate ? 0 : filtered ? noise : 3 * seen;
  // A fit solves for those of the whole input.
  const double fit =
      fits_operators && !options.eigenpairs
          ? internal::memory_of_eigenpairs(input, 1.2 * K, options.eigenpairs_options)
          : 0;
  const double both =
      (std::max)({solver, collapses, n * 8 * given + (std::max)(n * 8 * after, fit)});
  // The options and their copies, the metric and the judge have them.
  const double coefficients = 5. * 8 * double(options.coefficients.size());
  return input * internal::bytes_of_mesh + coefficients +
         (reduced ? (std::max)(input * first_stage, both) : both);
}

/*!
 * Returns an estimate of the memory in bytes to judge a result by
 * `Spectral_geometry::evaluate_spectrum()`, which first holds the eigenpairs of the whole input,
 * whatever `Spectral_edge_collapse_options::pre_simplify` was, then also those of the result. The
 * evaluation comes after the run of `estimated_memory()`: the larger number counts.
 *
 * @param number_of_vertices n of the input
 * @param number_of_coarse_vertices N of the result, at most n
 * @param number_of_eigenvectors K pairs of either mesh; as many as it has where these are fewer
 * @param options of both solves
 * @param pairs_are_known whether the pairs of the input are known, so that no solve is needed
 */
inline double estimated_evaluation_memory(const std::size_t number_of_vertices,
                                          const std::size_t number_of_coarse_vertices,
                                          const Eigen::Index number_of_eigenvectors,
                                          const Spectral_geometry::Eigenpairs_options& options = {},
                                          const bool pairs_are_known = false)
{
  const double n = double(number_of_vertices), N = double(number_of_coarse_vertices);
  const double K = (std::min)(double(number_of_eigenvectors), n), coarse_K = (std::min)(K, N);
  const double fine_pairs = 8 * n * K;
  const double fine = pairs_are_known ? fine_pairs : internal::memory_of_eigenpairs(n, K, options);
  const double coarse = fine_pairs + internal::memory_of_eigenpairs(N, coarse_K, options);
  return n * internal::bytes_of_mesh + (std::max)(fine, coarse);
}

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SPECTRAL_TOOLBOX_SPECTRAL_MEMORY_ESTIMATE_H
