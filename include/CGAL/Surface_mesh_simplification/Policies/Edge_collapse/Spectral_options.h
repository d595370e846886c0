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
  /// edge, or the cheapest sample. The samples of `on_edge` are among them, so no candidate costs
  /// more than there. With a shape term: the minimiser of that term, or the cheapest of the ends
  /// and the middle. The weights come from the projection on the edge, so P times the fine
  /// positions is no longer the coarse positions.
  free
};

/// Where the signals come from that the metric preserves.
enum class Spectral_signal_source {
  /// the first K eigenvectors, or mixtures of them
  eigenpairs,
  /// random functions without high frequencies: mixtures of about the first K eigenvectors, made
  /// without an eigensolver by one factorisation and a few solves, see
  /// `Spectral_geometry::filtered_signals()`. There are no eigenpairs then, and E and the relative
  /// error are estimates
  filtered_noise
};

/// Numbers of candidates that were refused at the head of the queue, by cause. An edge may be
/// counted several times: it returns to the queue whenever something near it changes.
struct Spectral_refusals
{
  /// CGAL's link condition and the like; also a filter outside of `Spectral_policies::filter()`, if
  /// a wrapper of the placement does not call ours
  std::size_t topology = 0;
  std::size_t geometry = 0; ///< CGAL's geometric test, or a placement wrapper that gave no point
  std::size_t filter = 0;   ///< the `filter` named parameter
  /// every position makes a degenerate triangle or moves a kept vertex, or for the next reason
  std::size_t placement = 0;
  /// every position near the edge's cost puts a face through another; with a wrapped placement this
  /// counts whatever the wrapper did then
  std::size_t crossing = 0;
};

/*!
 * The options of `Spectral_policies`; `Spectral_edge_collapse_options` adds those of
 * `spectral_edge_collapse()`. The defaults are what was found best, see `best()`.
 *
 * Several threads find the eigenpairs and, in `spectral_edge_collapse()`, relocate; the collapses
 * run on one. Until the mesh changes, cancelling throws `Spectral_geometry::Cancelled`. Later,
 * `spectral_edge_collapse()` and `edge_collapse()` with `Spectral_stop_predicate` stop between two
 * collapses; the mesh is then valid, with its P. The policies keep `progress` and `cancel`:
 * whatever these refer to must outlive the policies.
 */
struct Spectral_options : Spectral_geometry::Run_control
{
  /// The defaults: averaged mass, free placement, shape term, no new self-intersections. Chosen by
  /// measurement, see the manual.
  static Spectral_options best() { return Spectral_options(); }

  /// The method of Lescoat et al., *Spectral Mesh Simplification*, Computer Graphics Forum 39(2),
  /// 2020: lumped mass, placement on the edge, and E of all K eigenvectors as the only cost.
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

  /// r, the number of random mixtures that the metric sees in place of the signals; 0: the signals
  /// themselves. E is the squared norm of a linear function of the signals, so mixtures estimate it
  /// without bias, with a relative standard deviation of at most sqrt(2 / r). This is accurate
  /// enough for the order of the collapses, and the time of a cost does not depend on K. If there
  /// are at most r signals, they are not mixed. Multiples of 16 need no padding. |C|_L after
  /// relocation, relative to version 0.2 with all 100 eigenvectors, was 1.08 with 16, 1.02 with 32
  /// and 1.01 with all 100 (geometric means of twelve meshes). Relocation sees at least 64. Not
  /// negative.
  Eigen::Index number_of_mixtures = 32;

  /// Seed of the mixtures, or of the noise. The same seed gives the same result everywhere.
  std::uint64_t seed = 1;

  /// Where the signals come from, unless `signals` or `eigenpairs` are given. With `filtered_noise`
  /// the metric sees `number_of_mixtures` signals: this must not be 0, and `weights` must be empty.
  Spectral_signal_source source = Spectral_signal_source::eigenpairs;

  /// The placement strategy.
  Spectral_placement_strategy placement = Spectral_placement_strategy::free;

  /// Weight of the shape term: a candidate costs the change of E plus `shape` S n times the change
  /// of a probabilistic plane quadric. S = || Z ||_B^2 (the sum of lambda_k^2) is what E would be
  /// if nothing were left, and n is the current number of vertices. The weight has no unit: one
  /// value serves every scale, resolution, K and target, and 1 to 10 are alike. 0: the paper's
  /// metric, E alone. As with all CGAL costs, a cost dates from the last collapse near the edge and
  /// uses the n of that moment.
  double shape = 3;

  /// With a shape term the change of E counts for at most this many times S (M_u + M_v), the share
  /// of the signals at both ends. Beside needles E is larger by orders of magnitude, and without
  /// this limit needles would never be collapsed. An error bound forbids such collapses: set this
  /// to infinity then, as `spectral_edge_collapse()` does with `maximum_error`. Positive.
  double largest_loss = 10;

  /// No collapse puts a face through another, unless a face that it replaces went through that face
  /// already. If the chosen position would do so, both endpoints and the midpoint are tried,
  /// provided that they cost at most 16 times as much as that position or as recent collapses;
  /// otherwise the edge is refused until an adjacent edge collapses. Where faces of the input
  /// cross already, as in scans, the check is given up after n/20 refusals in a run of the loop, n
  /// being the number of input vertices. Positions of a wrapped placement are checked by
  /// `Spectral_filter` alone. Quadrics keep the promise for the mesh that they end with.
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

  /// The condition on functions at the border. With `dirichlet` they vanish there, and
  /// `preserve_border` is set: the row of P of a border vertex combines border vertices alone,
  /// wherever a wrapper of the placement puts it. Signals of your own must vanish on the border.
  Spectral_geometry::Boundary_condition boundary = Spectral_geometry::Boundary_condition::neumann;

  /// Returns, for positions V and triangles T, the operator whose eigenpairs are kept, if it is not
  /// the mesh's own. An example is the intrinsic Delaunay operator for inputs of needles and obtuse
  /// triangles, whose own linear elements span a poorer space. The metric still follows the
  /// triangles of the mesh, so E begins with the difference of both operators. The mass of the
  /// operator must be of the kind of `mass`. Not with `coefficients`, `boundary` or `signals`.
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

  /// Eigenpairs of the input in the mass chosen above, at the input's scale: several targets then
  /// need only one solve. Their residuals are checked. Null: they are computed.
  std::shared_ptr<const Spectral_geometry::Eigenpairs> eigenpairs;

  /// How the eigenpairs are computed if they are not given; `threads` of the run is used if it is
  /// larger. A rougher basis would do for the metric (the norms of the result do not change up to a
  /// tolerance of 1e-4), but 1e-8 costs least in all: Z is then F Lambda without a solve, and
  /// the pairs can judge the result.
  Spectral_geometry::Eigenpairs_options eigenpairs_options =
      Spectral_geometry::Eigenpairs_options::with_tolerance(1e-8);

  /// A non-negative weight for each of the K signals: E = sum_k weights(k) E_k. Empty: all 1.
  Eigen::VectorXd weights;

  /// Vertices that survive, as positions in `vertices(mesh)` from 0. The named parameter
  /// `vertex_is_constrained_map`, a readable map from vertices to `bool`, does the same. A collapse
  /// beside a kept vertex ends on it, and two kept vertices are never merged. The position and the
  /// values of a kept vertex stay exactly the same (its row of P is a single 1). CGAL chooses which
  /// handle remains after a collapse; the vertex map says where each vertex went. Edge constraints
  /// do not promise this: they keep edges. Kept vertices work together with them (see
  /// `Spectral_filter`), with `preserve_border` (an edge from a kept inner vertex to a border
  /// vertex that is not kept stays) and with `Spectral_edge_collapse_options::pre_simplify`.
  std::vector<std::size_t> kept_vertices;
};

/// Returns `Spectral_options::weights` for a target of N vertices. From 3 K vertices on all K
/// eigenvectors have the weight 1 (section 4.3 of the paper). Below, only the first `zeros` (of
/// eigenvalue 0, one per component) and the next N / 4 have it. So few vertices cannot keep the
/// upper modes. A metric that sees them loses lower modes too: it gives up whole limbs, which carry
/// few modes.
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
