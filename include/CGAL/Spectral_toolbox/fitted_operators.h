// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_FITTED_OPERATORS_H
#define CGAL_SPECTRAL_TOOLBOX_FITTED_OPERATORS_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_toolbox/internal/separate_compilation.h>

#include <Eigen/SparseCore>

#include <functional>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/*!
How `fit_operators()` chooses the entries of a coarse Laplacian and mass. All numbers are free of
scale; the defaults are those that were measured.
*/
struct Operator_fit_options
{
  /// Where the mass has entries.
  enum class Mass_pattern {
    diagonal, ///< on the diagonal alone
    edges     ///< on the edges of the mesh as well
  };
  Mass_pattern mass = Mass_pattern::edges; ///< the choice among them
  /// Where the Laplacian has entries: 2, the pattern of L L, about 19 entries per row; 1, the edges
  /// of the mesh alone, where \f$ \|C\|_D \f$ gains nothing: what a single ring adds for high modes
  /// it takes from the eigenvalues of low ones.
  int rings = 2;
  /// e: the residual of signal k has the weight \f$ (\lambda_k + 4 \pi)^{-e} \f$. More is for
  /// distances and signatures, which live on the lowest modes, less for the functional map: with 1
  /// in place of 2.5 \f$ \|C\|_L \f$ is 0.83 times as large, and errors of biharmonic distances
  /// are 1.6 times, of diffusion distances 2.4 times as large (four meshes). From 0 to 20.
  double low_modes = 2.5;
  /// mu: weight of the orthonormality of the restricted eigenvectors beside commutativity. More
  /// lowers \f$ \|C\|_D \f$ and raises \f$ \|C\|_L \f$ and the errors of the eigenvalues; from 0.
  double orthonormality = 0.01;
  /// eta: weight of the whole residual beside the part of it that the functional map sees, the
  /// projection on the restricted eigenvectors. Less lowers \f$ \|C\|_L \f$, more keeps the modes
  /// beyond K; from 0.
  double plain = 0.2;
  /// tau: weight of the mean squared change of an entry, relative to the entry and a typical one.
  /// Positive: it alone decides on what the eigenvectors do not.
  double tie = 0.05;
  /// No weight of an edge falls below this part of its own, nor of a twentieth of the median one:
  /// what keeps each component together. In ]0, 1].
  double smallest_weight = 0.02;
  /// No b_v falls below this part of the vertex' own row sum, or of a thousandth of the mean one
  /// where that is more. In ]0, 1].
  double smallest_mass = 0.01;

  /// Ends when gap and Newton decrement are below this part of the objective. In ]0, 1[.
  double tolerance = 0.05;
  /// Ends after so many iterations, each of one factorisation and a few products; from 0.
  int maximum_iterations = 30;
  /// Threads of the products, factorisations and solves, at least 1; the result does not depend on
  /// it.
  int threads = 1;
  /// Called before each iteration with the fraction of `maximum_iterations` that is done; returns
  /// false to cancel.
  std::function<bool(double)> progress;

  /// For a mass of the blend \f$ \theta \f$ of `laplace_operator()`: on the edges, where it is
  /// lumped on the diagonal.
  static Operator_fit_options for_mass(double theta)
  {
    Operator_fit_options options;
    options.mass = theta == 0. ? Mass_pattern::diagonal : Mass_pattern::edges;
    return options;
  }
};

/// What `fit_operators()` found.
struct Operator_fit_result
{
  /// L, B, and the row sums of B; `theta` is that of the coarse operator, 0 for a diagonal mass
  Laplace_operator op;
  double objective_before =
      0; ///< what was minimised, for the own entries brought inside of the bounds and to the total
  double objective_after = 0; ///< and for those of `op`, never larger
  int iterations = 0;         ///< of the barrier method
  bool converged = false;     ///< within `Operator_fit_options::tolerance`; otherwise stopped, and
                              ///< valid all the same
  Eigen::Index unknowns = 0;  ///< number of weights that were chosen
  Eigen::Index at_bound = 0;  ///< and of those that ended at their lower bounds
};

/*!
chooses the entries of a Laplacian and a mass on a coarse mesh so that they have the eigenpairs of a
fine mesh as nearly as the sparsity allows: for functional maps, spectral distances and signatures,
which compute with operators and not with triangles. The result goes to `eigenpairs()`,
`evaluate_spectrum()` and whatever takes an operator. It is not for what needs the cotangents or the
areas of the actual triangles.

With \f$ G = P \Phi \f$ (but for vertices whose own mode \f$ L_{vv} / M_v \f$ is more than eight
times the highest fitted eigenvalue and the median of all: there row v of \f$ L g = \lambda B g \f$
is solved for G, by ten sweeps of Gauss and Seidel), all at unit area, D the lumped mass of the
coarse mesh and \f$ R = \widetilde B G \Lambda - \widetilde L G \f$, it minimises
\f[ \|G^\top R\|_W^2 + \eta \|D^{-1/2} R\|_W^2 + \mu \|G^\top \widetilde B G - I\|^2
   + \frac{\tau}{N} \sum_a \left( \frac{x_a - x_a^0}{x_a^0 + s_a} \right)^2 \f]
where W weights the signals by \f$ (\lambda_k + 4\pi)^{-e} \f$, made relative by \f$ \mathrm{mean}(W
\lambda^2) \f$: 4 pi is the mean spacing of eigenvalues at unit area (Weyl's law), and e = 2 would
ask for the same relative accuracy of all modes. The first term is \f$ \|C \Lambda -
\widetilde\Lambda C\| \f$ when G stands for the coarse eigenvectors, the second the metric E (Eq. 2
of Lescoat et al. 2020). The last ties the N and more unknowns x (the weights w, m, b below) to what
they are of the mesh's own entries, \f$ x_a^0 \f$; \f$ s_a \f$ is the median weight of an edge or
the mean mass of a vertex, for a term of a thin triangle \f$ x_a^0 \f$ more.

**Both matrices are definite, whatever the input.**
\f[ \widetilde L = \sum_a w_a \, d_a d_a^\top, \qquad
   \widetilde B = \sum_v b_v \, e_v e_v^\top + \sum_{ij} m_{ij} (e_i + e_j) (e_i + e_j)^\top, \qquad
w, m \ge 0, \; b > 0, \f]
with \f$ d_a = e_i - e_j \f$ for each edge and positive bounds on these,
so that \f$ \widetilde L \f$ has one zero for each connected component of the graph. An edge of
negative weight (an obtuse or thin triangle) lies in this cone together with the other two edges of
its triangles: \f$ d_a = e_k - (1-t) e_i - t e_j \f$ with k opposite to ij, as much as it needs. Two
rings add for each vertex of up to 64 neighbours its row of L, and for each edge between two
triangles \f$ d_a = e_i + e_j - e_k - e_l \f$, the second difference across it: these, not edges to
far vertices, make up for a diagonal mass. The total of the mass of each component is that of the
coarse mesh (an exact scaling of both matrices follows a penalty that leaves little to do).

This is a convex quadratic program with bounds. A primal-dual barrier method solves it from the own
entries on, each step by conjugate gradients: products are formed from signals (O(N K^2)), the
Cholesky factor of the sparse normal matrix of the second term preconditions, kept while it does.
Time and memory are linear in N but for the fill-in of that factor. Whenever it stops the result is
inside of the bounds, up to that scaling, and its objective not larger than that of the own entries.

@param coarse operator of the coarse mesh. What is off the diagonal of L gives the pattern of both
and where L starts, B where the mass does; the mass gives D and the total
@param P      restriction, coarse x fine
@param fine   operator of the fine mesh, of which the area is taken
@param fine_pairs its eigenpairs, orthonormal in its mass. With a fifth more of them than are to be
judged the modes beyond, and \f$ \|C\|_D \f$, gain more
@param options weights, bounds, pattern, when to stop

Throws `std::invalid_argument` with one sentence that names the first offender for matrices that do
not belong together, a number that is not finite, an option out of range; `std::runtime_error` when
a preconditioner cannot be factorised; `Cancelled` when the progress callback returned false.

References: the operator-based view is that of H.-T. D. Liu, A. Jacobson, M. Ovsjanikov, *Spectral
Coarsening of Geometric Operators*, 2019, and H. Chen et al., *Chordal Decomposition for Spectral
Coarsening*, 2020; the barrier method is in J. Nocedal, S. Wright, *Numerical Optimization*, 2006,
section 16.6.
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Operator_fit_result
fit_operators(const Laplace_operator& coarse, const Eigen::SparseMatrix<double>& P,
              const Laplace_operator& fine, const Eigenpairs& fine_pairs,
              const Operator_fit_options& options = {});

/// @}

namespace internal {

/// Throws `std::invalid_argument` for an option out of range.
CGAL_SPECTRAL_TOOLBOX_INLINE void check_operator_fit_options(const Operator_fit_options& options);

} // namespace internal
} // namespace CGAL::Spectral_geometry

#ifndef CGAL_SPECTRAL_TOOLBOX_COMPILED
#include <CGAL/Spectral_toolbox/internal/fitted_operators_impl.h>
#endif

#endif // CGAL_SPECTRAL_TOOLBOX_FITTED_OPERATORS_H
