// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_BASIS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_BASIS_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_signals.h>

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/filtered_signals.h>
#include <CGAL/Spectral_geometry/internal/numerics/product.h>

namespace CGAL::Surface_mesh_simplification::internal {

using Spectral_geometry::internal::product;

/// What the metric preserves, for the input scaled to unit area: F and Z = B^-1 L F. Columns carry
/// the square root of their weight. Where there are more than
/// `Spectral_options::number_of_mixtures` of them, these are F R and Z R instead.
struct Spectral_basis
{
  Spectral_signals signals;
  Eigen::Index number_of_vertices = 0; ///< n, of the input
  double area = 1;                     ///< of the input, weighted by the density
  /// || Z ||_B^2 of all signals; the sum of lambda_k^2 for eigenvectors; exactly 0 where it is the
  /// rounding of 0
  double sum_of_squares = 0;
  /// whether Z = F Lambda is not good enough: signals of the user's, or rough pairs
  bool rough = false;
  Eigen::Index constants = 0; ///< the first eigenvectors, left out: P carries them over exactly
  /// with `Spectral_signal_source::filtered_noise`, at the input's scale; those that the metric
  /// sees are the first
  std::shared_ptr<const Spectral_geometry::Filtered_signals> filtered;
  /// all of them, at the input's scale
  std::shared_ptr<const Spectral_geometry::Eigenpairs> eigenpairs;
};

CGAL_SPECTRAL_GEOMETRY_INLINE void check_spectral_options(const Spectral_options& options,
                                                          Eigen::Index n);

/// The least number of mixtures in relocation, or of signals of filtered noise, which are made for
/// it and the collapses together. With 32 relocation takes five sixths of the time, and |C|_L is
/// 1.04 times as large, with noise 1.06 times.
constexpr Eigen::Index mixtures_of_relocation = 64;

/// Whether signals are made of noise.
inline bool is_filtered(const Spectral_options& options)
{
  return options.source == Spectral_signal_source::filtered_noise && options.signals.size() == 0 &&
         !options.eigenpairs;
}

/// K, whoever brings the signals.
inline Eigen::Index number_of_signals(const Spectral_options& options)
{
  return options.signals.size() != 0 ? options.signals.cols()
         : options.eigenpairs        ? options.eigenpairs->size()
                                     : options.number_of_eigenvectors;
}

/// The operator that the metric takes rows of.
inline Spectral_geometry::Local_operator local_operator(const Spectral_options& options)
{
  return {options.mass, options.coefficients, options.boundary};
}

/// The matrices of it, or those of `Spectral_options::operator_of_eigenpairs`.
inline Spectral_geometry::Laplace_operator operator_of_basis(const Eigen::MatrixXd& V,
                                                             const Eigen::MatrixXi& T,
                                                             const Spectral_options& options)
{
  if(!options.operator_of_eigenpairs)
    return Spectral_geometry::laplace_operator(V, T, local_operator(options));
  Spectral_geometry::Laplace_operator op = options.operator_of_eigenpairs(V, T);
  require(op.L.rows() == V.rows() && op.theta == Spectral_geometry::mass_blend(options.mass),
          "Spectral_options: operator_of_eigenpairs returned an operator of ", op.L.rows(),
          " vertices and the blend ", op.theta, ", but the mesh has ", V.rows(),
          " vertices and mass the blend ", Spectral_geometry::mass_blend(options.mass),
          "; return that of the mesh in this mass.");
  return op;
}

inline void check_extent(const Eigen::MatrixXd& V)
{
  require(Spectral_geometry::internal::extent_is_usable(Spectral_geometry::internal::extent_of(V)),
          "edge collapses: the coordinates of the mesh are not between 1e-50 and 1e50 in "
          "magnitude; rescale "
          "the mesh.");
}

inline Eigen::VectorXd spectral_weights(const Spectral_options& options, const Eigen::Index K)
{
  if(options.weights.size() == 0)
    return Eigen::VectorXd::Ones(K);
  require(options.weights.size() == K, "Spectral_options: there are ", options.weights.size(),
          " weights for ", K, " signals; give one for each.");
  for(Eigen::Index k = 0; k < K; ++k)
    require(options.weights[k] >= 0 && std::isfinite(options.weights[k]),
            "Spectral_options: weight ", k, " is negative or not finite; use numbers from 0.");
  return options.weights;
}

/// Z = B^-1 L F. The consistent mass scaled by its diagonal has eigenvalues in [1/2, 2], so
/// conjugate gradients converge in a number of steps that does not depend on the mesh.
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::MatrixXd
spectral_z(const Spectral_geometry::Laplace_operator& op, const Eigen::MatrixXd& F);

/// Z = F Lambda needs converged pairs: E of the fine mesh must be negligible beside what collapses
/// add. With this bound it is at most 1e-10 of sum lambda_k^2, a millionth of what a thousand
/// collapses cost. For rougher pairs Z = B^-1 L F is computed.
inline bool pairs_are_rough(const Eigen::VectorXd& residuals)
{
  return residuals.size() != 0 && residuals.maxCoeff() > 1e-5;
}

/*!
 * R, for r random mixtures F R of the columns of F: `rows` x r. Its columns are orthogonal and of
 * random direction (uniform, by Haar's measure), of length sqrt(rows / r), so that the expectation
 * of R R^T is the identity. Then \f$ \|A F R\|^2 \f$ has, for any A, the expectation \f$ \|A F\|^2
 * = tr G \f$, G = (A F)^T A F, and with n rows the variance
 * \f[ \frac{2 (n - r)}{r (n - 1) (n + 2)} \left( n \, tr G^2 - (tr G)^2 \right) \le \frac{2}{r} tr
 * G^2 . \f]
 * Independent normal entries (W. B. Johnson and J. Lindenstrauss 1984; M. F. Hutchinson
 * 1990) reach the bound on the right. The same `seed` gives the same mixtures everywhere.
 */
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::MatrixXd random_mixtures(Eigen::Index rows, Eigen::Index r,
                                                              std::uint64_t seed);

/// R for the signals of positive weight, each multiplied by the square root of its weight. They are
/// mixed only if there are more than `Spectral_options::number_of_mixtures`. R has a row for every
/// signal.
inline Eigen::MatrixXd mixing_matrix(const Spectral_options& options,
                                     const Eigen::VectorXd& weights)
{
  std::vector<Eigen::Index> seen;
  for(Eigen::Index k = 0; k < weights.size(); ++k)
    if(weights[k] > 0)
      seen.push_back(k);
  const Eigen::Index rows = Eigen::Index(seen.size()), r = options.number_of_mixtures;
  const Eigen::MatrixXd mixtures = r == 0 || rows <= r
                                       ? Eigen::MatrixXd(Eigen::MatrixXd::Identity(rows, rows))
                                       : random_mixtures(rows, r, options.seed);
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(weights.size(), mixtures.cols());
  for(Eigen::Index i = 0; i < rows; ++i)
    R.row(seen[i]) = std::sqrt(weights[seen[i]]) * mixtures.row(i);
  return R;
}

/// Relocation sees other mixtures than the collapses. Low eigenvectors weigh more, lambda^-1/2.
/// With 1 / lambda |C|_D is 1.04 times as large, and biharmonic distances are 0.92 times as far off
/// (nine meshes, 32 mixtures). `eigenvalues`: of the signals, none for those of the user's.
inline Eigen::MatrixXd mixing_matrix_of_relocation(const Spectral_options& collapses,
                                                   Eigen::VectorXd weights,
                                                   const Eigen::Index constants,
                                                   const Eigen::VectorXd& eigenvalues)
{
  Spectral_options options;
  const Eigen::Index r = collapses.number_of_mixtures;
  options.number_of_mixtures = r == 0 ? 0 : (std::max)(r, mixtures_of_relocation);
  options.seed = collapses.seed + 1;
  if(eigenvalues.size() != 0 && eigenvalues.maxCoeff() > 0) {
    const Eigen::VectorXd parts = eigenvalues / eigenvalues.maxCoeff();
    for(Eigen::Index k = constants; k < parts.size(); ++k)
      weights[k] /= std::sqrt((std::max)(parts[k], 1e-6)); // zeros that are no constants
  }
  return mixing_matrix(options, weights);
}

/// mesh -> Laplacian -> eigenpairs -> F and Z.
CGAL_SPECTRAL_GEOMETRY_INLINE Spectral_basis spectral_basis(const Eigen::MatrixXd& V,
                                                            const Eigen::MatrixXi& T,
                                                            const Spectral_options& options);

/// F and Z of a run at the scale of its input, for what follows the collapses: eigenvectors,
/// filtered noise or signals of the user's. `options` may weigh them otherwise than the collapses
/// did.
class Run_signals
{
public:
  using Signals = std::pair<Eigen::MatrixXd, Eigen::MatrixXd>;

  Run_signals(const Spectral_basis& basis, const Spectral_geometry::Mesh_matrices& fine,
              const Spectral_options& options)
    : m_basis(basis)
    , m_fine(fine)
    , m_options(options)
  {}

  /// F.
  const Eigen::MatrixXd& given() const
  {
    return m_options.signals.size() != 0 ? m_options.signals
           : m_basis.filtered            ? m_basis.filtered->F
                                         : m_basis.eigenpairs->vectors;
  }

  /// One for each column of F.
  Eigen::VectorXd weights() const { return spectral_weights(m_options, given().cols()); }

  /// K, also where F holds mixtures of the first K eigenvectors.
  Eigen::Index modes() const
  {
    return m_basis.filtered ? m_options.number_of_eigenvectors : given().cols();
  }

  /// What relocation sees. Filtered signals are not mixed.
  Signals mixtures() const
  {
    return mixed(mixing_matrix_of_relocation(m_options, weights(), m_basis.constants,
                                             m_basis.eigenpairs ? m_basis.eigenpairs->values
                                                                : Eigen::VectorXd()));
  }

  /// All signals but constants, restricted, each multiplied by the root of its weight.
  Signals restricted(const Eigen::SparseMatrix<double>& P) const
  {
    const int threads = m_options.threads;
    if(m_basis.filtered)
      return {product(P, m_basis.filtered->F, threads), product(P, m_basis.filtered->Z, threads)};
    Eigen::VectorXd roots = weights().cwiseSqrt();
    roots.head(m_basis.constants).setZero();
    Eigen::MatrixXd PF = product(P, given(), threads) * roots.asDiagonal();
    Eigen::MatrixXd PZ = m_basis.rough
                             ? product(P, mixed(roots.asDiagonal()).second, threads)
                             : Eigen::MatrixXd(PF * m_basis.eigenpairs->values.asDiagonal());
    return {std::move(PF), std::move(PZ)};
  }

  /// || Z ||_B^2 of all of them, for the input scaled to unit area.
  double sum_of_squares() const
  {
    if(!m_basis.eigenpairs)
      return m_basis.sum_of_squares;
    return m_basis.area * m_basis.area * weights().dot(m_basis.eigenpairs->values.cwiseAbs2());
  }

private:
  // F R and Z R, for mixtures or weights R.
  Signals mixed(const Eigen::MatrixXd& R) const
  {
    const int threads = m_options.threads;
    Eigen::MatrixXd F = product(given(), R, threads);
    Eigen::MatrixXd Z =
        m_basis.rough ? spectral_z(operator_of_basis(m_fine.V, m_fine.T, m_options), F)
                      : product(given(), m_basis.eigenpairs->values.asDiagonal() * R, threads);
    return {std::move(F), std::move(Z)};
  }

  const Spectral_basis& m_basis;
  const Spectral_geometry::Mesh_matrices& m_fine;
  const Spectral_options& m_options;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#if !defined(CGAL_SPECTRAL_GEOMETRY_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_LOOP)

#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Spectral_geometry/internal/numerics/Eigen_problem.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/QR>

#include <random>

namespace CGAL::Surface_mesh_simplification::internal {

void check_spectral_options(const Spectral_options& options, const Eigen::Index n)
{
  require(options.threads >= 1, "Spectral_options: threads is ", options.threads,
          ", use a number from 1.");
  require(options.shape >= 0 && std::isfinite(options.shape), "Spectral_options: shape is ",
          options.shape, ", use a number from 0.");
  require(options.largest_loss > 0, "Spectral_options: largest_loss is ", options.largest_loss,
          ", use a number above 0.");
  if(options.signals.size() != 0) {
    require(!options.eigenpairs,
            "Spectral_options: both signals and eigenpairs are given, use one of them.");
    require(options.signals.rows() == n, "Spectral_options: signals has ", options.signals.rows(),
            " rows, but the mesh has ", n, " vertices; give one row for each.");
    require(options.signals.allFinite(),
            "Spectral_options: signals has an entry that is not finite; correct it.");
  }
  if(options.eigenpairs) {
    const Spectral_geometry::Eigenpairs& pairs = *options.eigenpairs;
    require(pairs.vectors.rows() == n, "Spectral_options: the eigenvectors have ",
            pairs.vectors.rows(), " rows, but the mesh has ", n,
            " vertices; give the eigenpairs of this mesh.");
    require(pairs.values.size() == pairs.vectors.cols(), "Spectral_options: there are ",
            pairs.values.size(), " eigenvalues for ", pairs.vectors.cols(),
            " eigenvectors; give one for each.");
    require(
        pairs.values.size() != 0,
        "Spectral_options: there are no eigenpairs in those that are given; give at least one.");
  }
  require(options.number_of_mixtures >= 0, "Spectral_options: number_of_mixtures is ",
          options.number_of_mixtures, ", use a number from 0.");
  if(is_filtered(options)) {
    require(options.number_of_mixtures != 0,
            "Spectral_options: number_of_mixtures is 0, but filtered noise "
            "has no signals to be seen one by one; use 16, or eigenpairs.");
    require(options.weights.size() == 0,
            "Spectral_options: weights are for eigenvectors or signals, but the "
            "source is filtered noise; leave one of them out.");
  }
  Spectral_geometry::internal::check_local_operator(local_operator(options), n);
  require(
      !options.operator_of_eigenpairs ||
          (options.coefficients.rows() == 0 && options.signals.size() == 0 &&
           options.boundary == Spectral_geometry::Boundary_condition::neumann),
      "Spectral_options: operator_of_eigenpairs takes the place of the mesh's own operator, but "
      "coefficients, signals or a boundary condition are given; leave one of the two out.");
  const bool given = options.signals.size() != 0 || options.eigenpairs;
  require(given || (options.number_of_eigenvectors >= 1 && options.number_of_eigenvectors < n),
          "Spectral_options: number_of_eigenvectors is ", options.number_of_eigenvectors,
          ", but the mesh has ", n, " vertices; use a number from 1 to ", n - 1, ".");
}

Eigen::MatrixXd spectral_z(const Spectral_geometry::Laplace_operator& op, const Eigen::MatrixXd& F)
{
  Eigen::MatrixXd Z = op.L * F;
  if(op.theta == 0)
    return op.mass.cwiseInverse().asDiagonal() * Z;
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(op.B);
  solver.setTolerance(1e-13);
  for(Eigen::Index k = 0; k < Z.cols(); ++k) {
    const Eigen::VectorXd column = solver.solve(Z.col(k));
    if(solver.info() != Eigen::Success)
      throw std::runtime_error("Spectral_policies: B z = L f did not converge for signal " +
                               std::to_string(k) + "; check the mesh for needle-shaped faces.");
    Z.col(k) = column;
  }
  return Z;
}

/// What rounding leaves of || B^-1 L F ||_B for constant signals, || |L| |F| ||_{M^-1} times a few
/// units in the last place: needles, with their large cotangents, leave most.
inline double rounding_of_spectral_z(const Spectral_geometry::Laplace_operator& op,
                                     const Eigen::MatrixXd& F)
{
  const Eigen::SparseMatrix<double> size_of_L = op.L.cwiseAbs();
  double sum = 0;
  for(Eigen::Index k = 0; k < F.cols(); ++k)
    sum += (size_of_L * F.col(k).cwiseAbs()).cwiseAbs2().cwiseQuotient(op.mass).sum();
  return 4 * std::numeric_limits<double>::epsilon() * std::sqrt(sum);
}

/// Whether no eigenvalue is further from 0 than twice its residual: an exact eigenvalue lies within
/// one residual. With K = 1 and needles the solver may return a lambda of 1e-5 for 0.
inline bool eigenvalues_are_rounding(const Spectral_geometry::Laplace_operator& op,
                                     const Spectral_geometry::Eigenpairs& pairs,
                                     const Eigen::VectorXd& residuals)
{
  const double shift = Spectral_geometry::internal::pencil_shift(op);
  return !(pairs.values.array() > 2 * residuals.array() * (pairs.values.array() + shift)).any();
}

/// Whether || Z ||_B^2 is what rounding leaves for constant signals: L f is then a rounding of 0
/// beside its diagonal times f, and Z is that over a mass of about 1 / n.
inline bool is_rounding(const double sum_of_squares, const double norm_of_F, const Eigen::Index n)
{
  const double rounding = 1e-14 * double(n);
  return !(sum_of_squares > rounding * rounding * norm_of_F);
}

/// The residuals of given pairs. Refuses pairs of another mesh: residuals must be small, or equal
/// to those that came with the pairs, as for rough pairs.
inline Eigen::VectorXd checked_residuals(const Spectral_geometry::Eigenpairs& pairs,
                                         const Spectral_geometry::Laplace_operator& op,
                                         const Spectral_geometry::Mass mass, const int threads)
{
  const Eigen::VectorXd residuals =
      Spectral_geometry::internal::Eigen_problem(op).residuals(pairs, threads);
  const bool recorded = pairs.residuals.size() == residuals.size();
  for(Eigen::Index k = 0; k < residuals.size(); ++k) {
    const double r = residuals[k];
    require(r < 1e-3 || (recorded && std::abs(pairs.residuals[k] - r) < 1e-3 * r),
            "Spectral_options: eigenpair ", k, " is not one of this mesh and operator in the ",
            Spectral_geometry::mass_name(mass), " mass (relative residual ", r,
            "); compute it with eigenpairs(), or pass the vectors as signals.");
  }
  return residuals;
}

inline void check_signals_on_border(const Spectral_options& options, const Eigen::MatrixXi& T)
{
  if(options.boundary != Spectral_geometry::Boundary_condition::dirichlet)
    return;
  const double largest = options.signals.cwiseAbs().maxCoeff();
  for(const auto& [i, j] : Spectral_geometry::internal::boundary_edges(T))
    for(const int v : {i, j})
      require(!(options.signals.row(v).cwiseAbs().maxCoeff() > 1e-9 * largest),
              "Spectral_options: the signals do not vanish at ", vertex_name(v),
              " of the border, as the Dirichlet condition wants; set them to 0 there.");
}

Eigen::MatrixXd random_mixtures(const Eigen::Index rows, const Eigen::Index r,
                                const std::uint64_t seed)
{
  // G. E. P. Box and M. E. Muller 1958: the normal distribution of the standard library differs
  // from one to the next.
  std::mt19937_64 random(seed);
  const auto uniform = [&random] { return (double(random() >> 11) + 0.5) / 9007199254740992.; };
  Eigen::MatrixXd normal(rows, r);
  for(Eigen::Index k = 0; k < r; ++k)
    for(Eigen::Index i = 0; i < rows; ++i) {
      const double radius = std::sqrt(-2 * std::log(uniform()));
      normal(i, k) = radius * std::cos(6.283185307179586 * uniform());
    }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(normal);
  const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(rows, r);
  return Q * std::sqrt(double(rows) / double(r));
}

inline Spectral_basis basis_of_signals(const Spectral_geometry::Laplace_operator& op,
                                       const Spectral_options& options, const double area)
{
  Spectral_basis basis;
  const Eigen::VectorXd weights = spectral_weights(options, options.signals.cols());
  const Eigen::MatrixXd R = mixing_matrix(options, weights);
  const Eigen::MatrixXd Z = area * spectral_z(op, options.signals);
  basis.signals = Spectral_signals(Z.rows(), R.cols());
  basis.signals.set(0, product(options.signals, R, options.threads), product(Z, R, options.threads),
                    options.threads);
  basis.sum_of_squares =
      ((op.B * Z).cwiseProduct(Z).colwise().sum().transpose()).dot(weights) / area;
  const double rounding =
      rounding_of_spectral_z(op, options.signals * weights.cwiseSqrt().asDiagonal());
  const double norm_of_F = (op.mass.transpose() * options.signals.cwiseAbs2()).dot(weights) / area;
  if(!(basis.sum_of_squares > area * rounding * rounding) ||
     is_rounding(basis.sum_of_squares, norm_of_F, Z.rows()))
    basis.sum_of_squares = 0;
  basis.rough = true;
  return basis;
}

inline Spectral_basis
basis_of_eigenpairs(const Spectral_geometry::Laplace_operator& op, const Spectral_options& options,
                    std::shared_ptr<const Spectral_geometry::Eigenpairs> pairs, const double area,
                    const Eigen::Index components)
{
  Spectral_basis basis;
  Eigen::VectorXd weights = spectral_weights(options, pairs->size());
  const Eigen::VectorXd residuals =
      options.eigenpairs ? checked_residuals(*pairs, op, options.mass, options.threads)
                         : pairs->residuals;
  basis.sum_of_squares = weights.dot((area * pairs->values).cwiseAbs2());
  if(eigenvalues_are_rounding(op, *pairs, residuals) ||
     is_rounding(basis.sum_of_squares, weights.sum(), pairs->vectors.rows()))
    basis.sum_of_squares = 0;
  basis.rough = pairs_are_rough(residuals);
  // P carries the constants of each component over exactly: they are nothing to look at. Where
  // cotangents of 0 take a component apart, L has more functions of eigenvalue 0, and these cost
  // something once triangles change.
  const Eigen::Index zeros = Spectral_geometry::number_of_zero_eigenvalues(op);
  basis.constants = zeros <= components ? (std::min)(zeros, pairs->size()) : 0;
  weights.head(basis.constants).setZero();
  const Eigen::MatrixXd R = mixing_matrix(options, weights) * std::sqrt(area);
  basis.signals = Spectral_signals(pairs->vectors.rows(), R.cols());
  Eigen::Index first = 0;
  do {
    const Eigen::MatrixXd columns =
        R.middleCols(first, (std::min)(Eigen::Index(spectral_width), R.cols() - first));
    const Eigen::MatrixXd F = product(pairs->vectors, columns, options.threads);
    const Eigen::MatrixXd Z =
        basis.rough ? Eigen::MatrixXd(area * spectral_z(op, F))
                    : product(pairs->vectors, (area * pairs->values).asDiagonal() * columns,
                              options.threads);
    basis.signals.set(first, F, Z, options.threads);
    first += spectral_width;
  } while(first < R.cols()); // at least once, where no signal is seen
  basis.eigenpairs = std::move(pairs);
  return basis;
}

inline Spectral_basis basis_of_noise(const Spectral_geometry::Laplace_operator& op,
                                     const Spectral_options& options, const double area)
{
  Spectral_geometry::Filtered_signals_options how;
  const Eigen::Index r = options.number_of_mixtures;
  how.signals = (std::max)(r, mixtures_of_relocation);
  how.seed = options.seed;
  how.threads = options.threads;
  how.progress = [&options, &op](const double fraction) {
    return Spectral_geometry::internal::goes_on(
        options, {Spectral_geometry::Phase::eigenpairs, fraction, std::size_t(op.L.rows())});
  };
  const auto filtered = std::make_shared<Spectral_geometry::Filtered_signals>(
      Spectral_geometry::filtered_signals(op, options.number_of_eigenvectors, how));
  Spectral_basis basis;
  Eigen::VectorXd squares(filtered->Z.cols());
  const auto take_square = [&](const Eigen::Index k) {
    const Eigen::VectorXd BZ = op.B * filtered->Z.col(k);
    squares[k] = filtered->Z.col(k).dot(BZ);
  };
  Spectral_geometry::internal::for_each_task(squares.size(), options.threads, take_square);
  basis.sum_of_squares = area * area * squares.sum();
  if(is_rounding(basis.sum_of_squares, double(options.number_of_eigenvectors), op.L.rows()))
    basis.sum_of_squares = 0;
  // The columns are scaled for all signals; the metric sees r of them.
  const double scale = std::sqrt(area * double(how.signals) / double(r));
  basis.signals = Spectral_signals(op.L.rows(), r);
  basis.signals.set(0, scale * filtered->F.leftCols(r), scale * area * filtered->Z.leftCols(r),
                    options.threads);
  basis.filtered = filtered;
  return basis;
}

Spectral_basis spectral_basis(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                              const Spectral_options& options)
{
  check_spectral_options(options, V.rows());
  check_extent(V);
  const Spectral_geometry::Laplace_operator op = operator_of_basis(V, T, options);
  const double area = op.mass.sum();
  Spectral_basis basis;
  if(options.signals.size() != 0) {
    check_signals_on_border(options, T);
    basis = basis_of_signals(op, options, area);
  } else if(is_filtered(options)) {
    basis = basis_of_noise(op, options, area);
  } else {
    std::shared_ptr<const Spectral_geometry::Eigenpairs> pairs = options.eigenpairs;
    if(!pairs) {
      Spectral_geometry::Eigenpairs_options solver = options.eigenpairs_options;
      // The result does not depend on it.
      solver.threads = (std::max)(solver.threads, options.threads);
      // A callback of the solver's own is asked as well.
      solver.progress = [&options, &V](const Spectral_geometry::Progress& p) {
        const auto& own = options.eigenpairs_options.progress;
        return Spectral_geometry::internal::goes_on(options, {Spectral_geometry::Phase::eigenpairs,
                                                              p.fraction, std::size_t(V.rows())}) &&
               (!own || own(p));
      };
      pairs = std::make_shared<Spectral_geometry::Eigenpairs>(
          Spectral_geometry::eigenpairs(op, options.number_of_eigenvectors, solver));
    }
    const std::vector<Eigen::Index> component =
        Spectral_geometry::internal::connected_components(V.rows(), T);
    basis = basis_of_eigenpairs(op, options, pairs, area,
                                *std::max_element(component.begin(), component.end()) + 1);
  }
  basis.number_of_vertices = V.rows();
  basis.area = area;
  return basis;
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // definitions

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_BASIS_H
