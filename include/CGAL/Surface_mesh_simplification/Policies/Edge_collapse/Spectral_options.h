// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_OPTIONS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_OPTIONS_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/// Where the vertex that replaces an edge is put (section 3.4 of the paper).
enum class Spectral_placement_strategy {
  midpoint, ///< strategy (i): the middle of the edge; one evaluation per candidate
  on_edge,  ///< strategy (ii): the minimiser along the edge of a parabola through three samples
  /// strategy (iii), appendix A: the minimiser in space of a quadric through ten samples around the
  /// edge, or the cheapest sample, those of `on_edge` included, so that no candidate costs more
  /// than there; with a shape term its minimiser, or the cheapest of the ends and the middle. The
  /// weights come from the projection on the edge, so P times the fine positions is no longer the
  /// coarse positions.
  free
};

/// Where the signals come from that the metric preserves.
enum class Spectral_signal_source {
  /// the first K eigenvectors, or mixtures of them
  eigenpairs,
  /// random functions without high frequencies: mixtures of about the first K eigenvectors that no
  /// eigensolver has made, see `Spectral_geometry::filtered_signals()`. One factorisation and a few
  /// solves. There are no eigenpairs then, and E and the relative error are estimates
  filtered_noise
};

/// Candidates that were given up when their turn came, by cause. One edge may be counted several
/// times: it comes back whenever something near it has changed.
struct Spectral_refusals
{
  /// CGAL's link condition and the like; a filter that is not in `Spectral_policies::filter()`,
  /// where a wrapper does not ask our placement
  std::size_t topology = 0;
  std::size_t geometry = 0; ///< CGAL's geometric test, or a placement wrapper that gave no point
  std::size_t filter = 0;   ///< the `filter` named parameter
  /// no position without a degenerate triangle, none that leaves kept vertices where they are, or
  /// for the next reason
  std::size_t placement = 0;
  /// no position near the edge's cost without a face through another; where a placement is wrapped,
  /// whatever the wrapper did then
  std::size_t crossing = 0;
};

/*!
 * The options of `Spectral_policies`, in the manner of the parameter structures of the other
 * policies; those of `spectral_edge_collapse()` are `Spectral_edge_collapse_options`. The defaults
 * are what was found best, see `best()`.
 *
 * Threads find eigenpairs, and relocate in `spectral_edge_collapse()`; the collapses run on one.
 * Cancelling throws `Spectral_geometry::Cancelled` until the mesh changes. Later
 * `spectral_edge_collapse()`, and `edge_collapse()` with `Spectral_stop_predicate`, stop between
 * two collapses. The mesh is valid then, and P is that of what was done. Policies keep `progress`
 * and `cancel`: what these refer to must outlive them.
 */
struct Spectral_options : Spectral_geometry::Run_control
{
  /// The defaults: averaged mass, free placement, shape term, no new self-intersections. Chosen by
  /// measurement, see the manual.
  static Spectral_options best() { return Spectral_options(); }

  /// What Lescoat et al. describe, *Spectral Mesh Simplification*, Computer Graphics Forum 39(2),
  /// 2020: lumped mass, placement on the edge, E alone, of all K eigenvectors.
  static Spectral_options paper()
  {
    Spectral_options options;
    options.mass = Spectral_geometry::Mass::lumped;
    options.placement = Spectral_placement_strategy::on_edge;
    options.number_of_mixtures = 0;
    options.shape = 0;
    options.keep_free_of_self_intersections = false;
    return options;
  }

  /// K, the number of eigenvectors that are preserved, the constant one included. In [1, n - 1].
  /// The target size should be at least 3 K (section 4.3 of the paper). Ignored when `signals` or
  /// `eigenpairs` are given: they bring their own number of columns.
  Eigen::Index number_of_eigenvectors = 100;

  /// r, the number of random mixtures of the signals that the metric sees in their place; 0: the
  /// signals themselves. E is a squared norm of something linear in the signals, so mixtures
  /// estimate it without bias, with a relative standard deviation of at most sqrt(2 / r). The order
  /// of the collapses needs no more, and costs do not depend on K. No more than r signals are never
  /// mixed. Multiples of 16 are free of padding. |C|_L after relocation was 1.08 times that of
  /// version 0.2 with 16, 1.02 with 32, and 1.01 with all 100 eigenvectors, which version 0.2 saw
  /// (geometric means of twelve meshes). Relocation sees at least 64. Not negative.
  Eigen::Index number_of_mixtures = 32;

  /// Which mixtures, or which noise. The same seed gives the same result everywhere.
  std::uint64_t seed = 1;

  /// Where the signals come from, unless `signals` or `eigenpairs` are given. With `filtered_noise`
  /// the metric sees `number_of_mixtures` of them, which must not be 0, and there are no `weights`.
  Spectral_signal_source source = Spectral_signal_source::eigenpairs;

  /// The placement strategy.
  Spectral_placement_strategy placement = Spectral_placement_strategy::free;

  /// The shape term: a candidate costs the change of E plus `shape` S n times that of a
  /// probabilistic plane quadric, where S = || Z ||_B^2 (the sum of lambda_k^2) is the E of nothing
  /// left and n the number of vertices now. Without unit: one value serves every scale, resolution,
  /// K and target; 1 to 10 are alike. 0: the paper's metric, E alone. As with all CGAL costs, a
  /// cost dates from the last collapse near the edge and uses the n of that moment.
  double shape = 3;

  /// With a shape term no change of E counts for more than this many times S (M_u + M_v), what the
  /// signals have at both ends: beside needles E is larger than that by orders of magnitude, and
  /// they would never be collapsed. Where an error bound is to be kept they must not be: then
  /// infinite, as `spectral_edge_collapse()` has it with `maximum_error`. Positive.
  double largest_loss = 10;

  /// No collapse puts a face through another, unless one that it replaces went through that one
  /// already. If the chosen position would do so, both endpoints and the midpoint are tried,
  /// provided that they cost at most 16 times as much as that position or as recent collapses;
  /// otherwise the edge is postponed until an adjacent edge collapses. Where faces of the input
  /// cross already, as in scans, the check is given up after n/20 refusals in a run of the loop, n
  /// being the number of input vertices. Positions of a wrapped placement are checked by
  /// `Spectral_filter` alone. With quadrics the promise holds for the mesh that they end with.
  bool keep_free_of_self_intersections = true;

  /// The mass matrix B of L Phi = B Phi Lambda and of the metric: `lumped` is the paper's;
  /// `averaged` is the mean of lumped and consistent mass, in which coarse meshes keep eigenvalues
  /// best; `voronoi` is that of Meyer et al. 2003, `consistent` that of finite elements.
  Spectral_geometry::Mass mass = Spectral_geometry::Mass::averaged;

  /// Coefficients of the operator whose spectrum is kept, n x 7, rows in the order of
  /// `vertices(mesh)`: a density and a conductivity, which may depend on the direction; see
  /// `Spectral_geometry::Operator_coefficients`. The collapses merge them as they merge signals,
  /// see `Spectral_edge_collapse_result::coefficients`. Empty: the Laplace-Beltrami operator.
  Spectral_geometry::Operator_coefficients coefficients;

  /// What functions do on the border of the mesh. With `dirichlet`, where they vanish,
  /// `preserve_border` is set: a vertex of the border is one of vertices of the border, wherever a
  /// wrapper of the placement puts it. Signals of the user's must vanish there.
  Spectral_geometry::Boundary_condition boundary = Spectral_geometry::Boundary_condition::neumann;

  /// Returns the operator whose eigenpairs are kept, of positions V and triangles T, where it is
  /// not the mesh's own: that of the intrinsic Delaunay triangulation for inputs of needles and
  /// obtuse triangles, whose own operator is that of a poorer space. The metric follows the
  /// triangles of the mesh all the same, so that E begins with the difference of both operators.
  /// Its mass must be of the kind of `mass`. Not with `coefficients`, `boundary` or `signals`.
  /// Empty: the mesh's own.
  std::function<Spectral_geometry::Laplace_operator(const Eigen::MatrixXd& V,
                                                    const Eigen::MatrixXi& T)>
      operator_of_eigenpairs;

  /// Rounds the weights of every merge to 0 or 1, so that each row of P has exactly one 1 (section
  /// 3.4). A tie keeps the vertex of larger mass, then the one that comes first in the input.
  bool binary = false;

  /// On an edge with exactly one border vertex, keeps the position and the value of that vertex.
  /// With the placement `free`, edges of the border are collapsed to a point on them.
  bool preserve_border = false;

  /// Signals F to preserve instead of eigenvectors, n x K, rows in the order of `vertices(mesh)`;
  /// they need not be orthonormal. Then Z = B^-1 L F (Eq. 2). Empty: eigenvectors.
  Eigen::MatrixXd signals;

  /// Eigenpairs of the input in the mass chosen above, at the input's scale, so that several
  /// targets cost one solve. Their residuals are checked. Null: they are computed.
  std::shared_ptr<const Spectral_geometry::Eigenpairs> eigenpairs;

  /// How the basis is computed when it is not given; `threads` below are used if they are more. The
  /// metric would do with a rougher one (the norms of the result do not change up to a tolerance of
  /// 1e-4), but 1e-8 costs least in all: from there on Z = F Lambda needs no rows of its own, which
  /// the loop would carry, and the pairs can judge the result.
  Spectral_geometry::Eigenpairs_options eigenpairs_options =
      Spectral_geometry::Eigenpairs_options::with_tolerance(1e-8);

  /// A non-negative weight for each of the K signals: E = sum_k weights(k) E_k. Empty: all 1.
  Eigen::VectorXd weights;

  /// Vertices that survive, as positions in `vertices(mesh)`, from 0; a readable map from vertices
  /// to `bool` passed as the named parameter `vertex_is_constrained_map` does the same. A collapse
  /// next to one ends on it: its position and its values stay exactly what they were (its row of P
  /// is a single 1), and two of them are never merged. Which of its two handles a mesh goes on with
  /// after a collapse is CGAL's choice: the vertex map says where each went. Edge constraints do
  /// not promise this: they keep edges. Works together with them (see `Spectral_filter`), with
  /// `preserve_border` (an edge from a kept inner vertex to a border vertex that is not kept stays)
  /// and with `Spectral_edge_collapse_options::pre_simplify`.
  std::vector<std::size_t> kept_vertices;
};

/// `Spectral_options::weights` for a target of N vertices. From 3 K vertices on all K eigenvectors
/// have the weight 1 (section 4.3 of the paper). Below, the `zeros` first have it, one of
/// eigenvalue 0 for each component, and N / 4 after them. There the upper modes cannot be kept.
/// A metric that sees them loses the lower ones, too: it gives up whole limbs, which carry few
/// modes.
inline Eigen::VectorXd weights_for_target(const std::size_t number_of_vertices,
                                          const Eigen::Index K, const Eigen::Index zeros = 1)
{
  const Eigen::Index N = Eigen::Index(number_of_vertices);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(K);
  if(N / 3 < K)
    weights.tail((std::max)(K - zeros - (std::max)(N / 4, Eigen::Index(1)), Eigen::Index(0)))
        .setZero();
  return weights;
}

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_OPTIONS_H
