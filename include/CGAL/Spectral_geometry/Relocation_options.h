// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_RELOCATION_OPTIONS_H
#define CGAL_SPECTRAL_GEOMETRY_RELOCATION_OPTIONS_H

#include <CGAL/number_type_config.h>

#include <CGAL/Spectral_geometry/Eigenpairs_options.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/*!
How `relocate_positions()` moves the vertices of a coarse mesh, and what it may not do. The defaults
are those that were measured.
*/
struct Relocation_options : Run_control
{
  /// What the signals of a vertex are while it moves.
  enum class Signals {
    carried, ///< P F, the restriction that came with the mesh; it stays as it is
    /// both P F and F at the closest point of the fine surface: good with either restriction
    carried_and_sampled,
    /// F at the closest point alone, in the component of the vertex' row of P. With the restriction
    /// of closest points its norms are the lowest of the three. The restriction that came with the
    /// mesh no longer fits: the result holds the one to use instead
    sampled
  };
  Signals signals = Signals::sampled; ///< the choice among them

  /// tau lambda_K of `Relocation_energy`. 0: the plain metric E, at half the work.
  double smoothing = 1;
  /// Vertices that cause new self-intersections are moved back as far as needed.
  bool keep_free_of_self_intersections = true;
  /// The surfaces are drawn together where they are further apart than this part of the largest
  /// distance of a fine vertex at the start. No fine vertex gets further away than that distance,
  /// so tips stay. Positive; a large number leaves only this bound, infinity removes both. With 0.5
  /// the Hausdorff distance is 0.8 times as large, |C|_L and errors of eigenvalues are 1.1 times as
  /// large.
  double hausdorff_goal = 0.8;
  /// Whether boundary vertices stay where they are; otherwise they slide along the fine boundary.
  bool fix_boundary = false;
  /// K, where F holds mixtures of the first K eigenvectors; 0: the number of columns of F. Not
  /// negative.
  Eigen::Index modes = 0;
  /// Eigenpairs of the fine mesh, ascending, that judge the result: |C|_L before and after is taken
  /// of all, or of as many as there are coarse vertices. With `eigenvalues` they also steer the
  /// descent. Not owned. Null: `spectral_relocation()` takes its own; otherwise F and Z judge.
  const Eigenpairs* eigenpairs = nullptr;
  /// The eigenvalues of the fine mesh at unit area, in any order (each times the sum of M). The
  /// first K coarse eigenvalues are drawn to them, at most as many as a sixth of the vertices. The
  /// mean of the coarse ones after these rises to theirs, as far as a quarter of the vertices. Not
  /// for lumped masses, where the shape would compensate the error of the elements. If |C|_L does
  /// not fall, or from 4 K vertices on by less than three per cent, relocation is repeated with
  /// less and less weight on them, in the end with none, until it does. Empty: no such term.
  Eigen::VectorXd eigenvalues;

  /// Largest number of steps; a step takes one value and gradient, seldom two. With 80 the errors
  /// of the eigenvalues beyond K are 1.04 times and |C|_L 1.01 times as large.
  int maximum_steps = 100;
  /// After this wall time, in seconds, the descent takes no further step.
  double maximum_seconds = std::numeric_limits<double>::infinity();
};

/// What `relocate_positions()` did.
struct Relocation_result
{
  /// Why the descent ended.
  enum class Stop_reason {
    converged,  ///< ten steps lowered the objective by less than half a percent
    no_descent, ///< no step that the guards allow lowers it
    /// the norm got worse, or there was nothing to gain: vertices are where the descent began, or
    /// as they were given
    no_gain,
    steps,  ///< `Relocation_options::maximum_steps`
    seconds ///< `Relocation_options::maximum_seconds`
  };

  /// Numbers of vertices that a guard held back in at least one step, by guard.
  struct Held
  {
    /// never moved: kept by the caller, or boundary vertices that have to stay
    std::size_t fixed = 0;
    std::size_t trust = 0;    ///< by the ball around (P V)_w in which it stays
    std::size_t boundary = 0; ///< by the end of the boundary that they slide along
    /// because another sheet of the fine surface would have been nearer, or their closest point
    /// would have leapt to one
    std::size_t sheet = 0;
    std::size_t triangles = 0; ///< because a triangle would have turned or become too thin
  };

  /// E (Eq. 2) before, of the signals that relocation sees, carried by P, at the scale of the
  /// meshes. E may rise while the norms fall: they do not see most of it.
  double E_before = 0;
  double E_after = 0;          ///< see `E_before`
  double objective_before = 0; ///< what was minimised, at the start
  double objective_after = 0;  ///< and at the end
  /// |C|_L (Eq. 3), for signals of any kind, with the restriction that was passed
  double norm_before = 0;
  double norm_after = 0;                             ///< and with that of the result, never more
  int steps = 0;                                     ///< of the descent
  Stop_reason stop_reason = Stop_reason::no_descent; ///< why it ended
  Held held;                                         ///< by which guard
  std::size_t moved_vertices = 0;                    ///< vertices that are elsewhere now
  /// vertices that went back in two rounds, in part or wholly, because of a self-intersection or
  /// the distance, and then stayed
  std::size_t reverted_vertices = 0;
  double seconds = 0;     ///< wall seconds
  bool resampled = false; ///< whether `restriction` is a new one
  /// for `Signals::sampled` the restriction of the new positions, otherwise that which was passed
  Eigen::SparseMatrix<double> restriction;

  /// `stop_reason` in words
  const char* stop_reason_name() const
  {
    return stop_reason == Stop_reason::converged    ? "converged"
           : stop_reason == Stop_reason::no_descent ? "no step descends"
           : stop_reason == Stop_reason::no_gain    ? "no gain"
           : stop_reason == Stop_reason::steps      ? "number of steps"
                                                    : "time";
  }
};

/// @}

namespace internal {

/// Weight of E beside the smoothed term, relative to what the two are at the start. Most of E lies
/// in modes that the norms do not see: with a large weight they lose their gain. With none E rose
/// to twelve times its value on falconstatue; with this weight it falls on seven of eight meshes.
constexpr double weight_of_energy = 0.03;

/// What no vertex and no triangle may do while vertices are relocated, and when the descent ends.
struct Relocation_limits
{
  /// A vertex stays in a ball around (P V)_w: beyond it, the signals are those of another place.
  /// Its radius is this many mean incident edges, or the distance at the start if that is more.
  double trust_radius = 0.5;
  /// No triangle's smallest angle falls below this part of what it was.
  double smallest_angle_ratio = 0.5;
  /// No triangle turns its normal further than this from where it was, radians.
  double largest_turn = CGAL_PI / 3;
  /// Total area, and the volume of a closed mesh, stay between those of the coarse and of the fine
  /// mesh (where these are further apart, no more than a tenth from those of the coarse one), give
  /// or take this part. The spectra are compared at the scale of the meshes as they are, which
  /// brings the area near that of the fine mesh by itself.
  double size_tolerance = 0.03;
  /// The descent ends when ten steps lower the objective by less than this part.
  double relative_decrease = 0.005;
  /// From 4 K vertices on, if |C|_L does not fall below this part of its value before, fewer terms
  /// are tried, and the best of the results is taken: modes beyond K that cut a cluster of
  /// eigenvalues can end a descent. Masses that are not averaged gain 10 to 30 per cent.
  double gain = 0.97;
  /// Inner products of the signals take part.
  bool keep_inner_products = true;
  /// epsilon of `Spectrum_term`, up to ten vertices for each mode: relative errors of the first K
  /// eigenvalues of this size in the mean square cost as much as all does at the start. With 0.025
  /// they are 1.1 times as large, and |C|_L 0.95 times. 0: no such term.
  double eigenvalue_error = 0.02;
  /// The mean of this many coarse eigenvalues beyond K, in parts of K, does not fall at unit area,
  /// and rises as `eigenvalues` says. With the averaged mass they are too low, and without this the
  /// descent lowers them further. 0: they may fall.
  double beyond = 0.5;
};

inline void check_relocation_options(const Relocation_options& o)
{
  require(o.smoothing >= 0 && std::isfinite(o.smoothing),
          "relocation: smoothing must be a number from 0.");
  require(o.modes >= 0, "relocation: modes is ", o.modes, ", use a number from 0.");
  for(Eigen::Index k = 0; k < o.eigenvalues.size(); ++k)
    require(std::isfinite(o.eigenvalues[k]), "relocation: eigenvalue ", k,
            " is no finite number; pass those of the fine mesh.");
  require(o.hausdorff_goal > 0, "relocation: hausdorff_goal must be positive.");
  require(o.threads >= 1, "relocation: threads must be a number from 1, but is ", o.threads, ".");
}

} // namespace internal

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_RELOCATION_OPTIONS_H
