// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_COLLAPSE_OPTIONS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_COLLAPSE_OPTIONS_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>

#include <CGAL/Spectral_geometry/Relocation_options.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * The options of `spectral_edge_collapse()`: those of the metric, and what is done before and after
 * the collapses. The defaults are what was found best.
 */
struct Spectral_edge_collapse_options : Spectral_options
{
  /// `Spectral_options::best()` for the collapses, then relocation with the signals at the closest
  /// points. Relocation takes a third of the run; with its own P |C|_L is less than half. That P
  /// does not follow the vertex map, and levels replayed from the log are not relocated.
  static Spectral_edge_collapse_options best() { return Spectral_edge_collapse_options(); }

  /// `best()` for large inputs: quadrics first reduce the mesh to 30 times the target, but not
  /// below 300,000 vertices. The eigenpairs are those of the reduced mesh. |C|_L was no larger for
  /// a smooth shape of a million vertices, and 1.25 times as large for a rough terrain of 1.44
  /// million. See `pre_simplify` for what cannot be given with it.
  static Spectral_edge_collapse_options best(const std::size_t number_of_vertices)
  {
    Spectral_edge_collapse_options options;
    options.pre_simplify = (std::max)(30 * number_of_vertices, std::size_t(300000));
    return options;
  }

  /// `best()` without an eigensolver. Quadrics first reduce the mesh to 15 times the target, but
  /// not below 10,000 vertices; its signals are filtered noise on the reduced mesh. Relocation sees
  /// 64 signals and takes at most 28 steps. With 30 times the target and 40 steps, a run from
  /// 50,000 vertices took 1.5 times as long, and |C|_L was 0.93 times as large on average, 0.8
  /// times on human figures. If K is at most 32, or N is below 2 K, eigenpairs judge the
  /// relocation: noise alone would let |C|_L rise there. E and the relative error are estimates.
  /// See `pre_simplify` for what cannot be given with it.
  static Spectral_edge_collapse_options fast(const std::size_t number_of_vertices)
  {
    Spectral_edge_collapse_options options;
    options.source = Spectral_signal_source::filtered_noise;
    options.number_of_mixtures = 16;
    options.pre_simplify = (std::max)(15 * number_of_vertices, std::size_t(10000));
    options.relocation.maximum_steps = 28;
    return options;
  }

  /// `Spectral_options::paper()`, and nothing after the collapses.
  static Spectral_edge_collapse_options paper()
  {
    Spectral_edge_collapse_options options;
    static_cast<Spectral_options&>(options) = Spectral_options::paper();
    options.relocate = false;
    options.quadrics_above = std::numeric_limits<double>::infinity();
    return options;
  }

  /// Stops before a collapse that would raise `relative_error`, sqrt(E / sum_k lambda_k^2), above
  /// this; see `Spectral_error_stop_predicate` for how to choose it. From 0; infinite: no bound.
  /// The run ends at this bound or at the number of vertices, whichever comes first: pass 3 K as
  /// that number. The bound holds for the collapses: if relocation raises the error above it, a
  /// warning says so. With a bound `largest_loss` is infinite, and all signals are seen, not
  /// mixtures.
  double maximum_error = std::numeric_limits<double>::infinity();

  /// A mesh of more vertices is first reduced to this number by the quadrics of `shape` alone (M.
  /// Garland and P. Heckbert, *Surface Simplification Using Quadric Error Metrics*, SIGGRAPH 1997);
  /// then the spectral cost takes over. `best(N)` and `fast()` take 30 and 15 times the target.
  /// This stage takes three to nine microseconds per vertex, at least twice as long where faces
  /// would go through others. P spans both stages. Kept vertices and the ends of constrained edges
  /// stay. Signals, eigenpairs, a filter and a visitor are refused if this stage takes part. 0:
  /// never.
  std::size_t pre_simplify = 0;

  /// While the mesh has more than this many times the target's vertices, edges are collapsed by the
  /// quadrics of `shape` alone, as with `pre_simplify`. But F, Z and P follow, so eigenpairs,
  /// relocation and the error refer to the input. Only the last collapses determine the quality:
  /// with 7 and with 15 the norms were the same in the mean of 106 runs, and a mesh of 80 N took
  /// half the time. From 1; infinite: never. It is ignored in these cases, so that the metric
  /// decides every collapse: no `shape`; a `placement` other than `free`; `coefficients`, `binary`,
  /// `preserve_border`, the Dirichlet condition or `maximum_error`; a filter or a visitor. Levels
  /// of `Spectral_edge_collapse_result::log` with more than this many times the target's vertices
  /// come from quadrics.
  double quadrics_above = 7;

  /// Moves the remaining vertices to preserve the spectrum better, see
  /// `Spectral_geometry::relocate_positions()`. Kept vertices and both ends of constrained edges
  /// stay. Made for the averaged mass. Not with `binary` if `relocation.signals` is `sampled`,
  /// which makes a new P.
  bool relocate = true;

  /// How vertices are moved; the progress callback of the run replaces its own.
  Spectral_geometry::Relocation_options relocation;
};

/// @}

namespace internal {

/// Whether `quadrics_above` is heeded, as far as the options tell.
inline bool quadrics_come_first(const Spectral_edge_collapse_options& options)
{
  return std::isfinite(options.quadrics_above) && options.shape > 0 &&
         options.placement == Spectral_placement_strategy::free && !options.binary &&
         !options.preserve_border && options.coefficients.rows() == 0 &&
         options.boundary != Spectral_geometry::Boundary_condition::dirichlet &&
         !std::isfinite(options.maximum_error);
}

/// Throws for what would otherwise be found out after the mesh has changed.
inline void check_edge_collapse_options(const Spectral_edge_collapse_options& options)
{
  require(options.quadrics_above >= 1, "Spectral_edge_collapse_options: quadrics_above is ",
          options.quadrics_above, ", use a number from 1.");
  require(!std::isfinite(options.maximum_error) || !is_filtered(options),
          "Spectral_edge_collapse_options: maximum_error is a bound for eigenvectors, of which "
          "filtered noise only estimates the error; set source to eigenpairs.");
  require(options.maximum_error >= 0, "Spectral_edge_collapse_options: maximum_error is ",
          options.maximum_error, ", use a number from 0.");
  if(!options.relocate)
    return;
  Spectral_geometry::internal::check_relocation_options(options.relocation);
  require(
      !options.binary ||
          options.relocation.signals != Spectral_geometry::Relocation_options::Signals::sampled,
      "Spectral_edge_collapse_options: relocate takes a restriction anew that is not binary; set "
      "relocate to false, or relocation.signals to carried.");
}

} // namespace internal

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_COLLAPSE_OPTIONS_H
