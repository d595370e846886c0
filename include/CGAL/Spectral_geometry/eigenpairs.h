// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_EIGENPAIRS_H
#define CGAL_SPECTRAL_GEOMETRY_EIGENPAIRS_H

#include <CGAL/Spectral_geometry/Eigenpairs_options.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/separate_compilation.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief returns the first K generalised eigenpairs of a Laplace operator, \f$L \phi_k = \lambda_k
/// B \phi_k\f$.
///
/// Shift and invert: \f$(L - \sigma B)^{-1} B \phi = \nu \phi\f$, \f$\lambda = \sigma + 1/\nu\f$,
/// by a Lanczos method with a factorisation of \f$L - \sigma B\f$. About six tenths of the wanted
/// eigenvalues lie below the shift \f$\sigma\f$; the signs of the pivots count them (Grimes, Lewis
/// and Simon 1994). The iteration then approaches the wanted spectrum from both of its ends. For
/// fewer than 16 pairs, if `maximum_vectors` is given, or where no such shift serves, the shift is
/// \f$-s\f$. Here \f$s = 4\pi/\f$area is the mean spacing of the eigenvalues by Weyl's law: the
/// matrix is positive definite, and the eigenvalues next to 0 are separated as well as with a
/// smaller s. If L is in another unit (entries a thousand times larger or smaller than cotangents),
/// s is in that unit. Start vectors are fixed, so the result is the same in every run. With K =
/// 100, `block` keeps about 2.4 K vectors of n doubles at a tolerance of 1e-8 and 2.1 K at 1e-4;
/// with a negative shift 3.4 K and 2.8 K; never more than max(3.6 K, K + 120). More than 500 pairs
/// are found about 120 at a time, each time with a shift among them.
///
/// Eigenvectors are orthonormal in B. Signs: the first entry (in vertex order) that is larger in
/// magnitude than 0.618 times the largest one is positive. Within an eigenspace of several
/// dimensions the basis is arbitrary.
///
/// \param op       the operator; eigenvalues are in the inverse of its unit of area
/// \param K        number of eigenpairs, 1 <= K <= n; with the Dirichlet condition at most the
/// number of vertices off the border
/// \param options  method, tolerance, limits, threads, progress
///
/// \throws std::invalid_argument when K or an option is out of range or L, B differ in size;
///         std::runtime_error when the factorisation or the iteration fails;
///         Cancelled when it is cancelled
CGAL_SPECTRAL_GEOMETRY_INLINE Eigenpairs eigenpairs(const Laplace_operator& op, Eigen::Index K,
                                                    const Eigenpairs_options& options = {});

/// \brief returns the first K eigenpairs of any pencil \f$L \phi = \lambda B \phi\f$, with or
/// without a mesh.
///
/// \param L  n x n, symmetric, positive semidefinite, in any unit: the shift is taken from the
/// pencil
/// \param B  n x n, symmetric, positive definite, with positive row sums: a mass matrix
/// \param K, options  as above
///
/// \throws what the overload above does, and std::invalid_argument that names the first row in
///         which a matrix is not symmetric, or B has no positive sum
CGAL_SPECTRAL_GEOMETRY_INLINE Eigenpairs eigenpairs(const Eigen::SparseMatrix<double>& L,
                                                    const Eigen::SparseMatrix<double>& B,
                                                    Eigen::Index K,
                                                    const Eigenpairs_options& options = {});

/// @}

namespace internal {

class Eigen_problem;

/// The first K pairs of one part of a mesh.
CGAL_SPECTRAL_GEOMETRY_INLINE Eigenpairs pairs_of_part(const Eigen_problem& problem,
                                                       const Eigen::Index K,
                                                       const Eigenpairs_options& options);

} // namespace internal
} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_GEOMETRY_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_GEOMETRY)

#include <CGAL/Spectral_geometry/internal/numerics/Block_lanczos.h>
#include <CGAL/Spectral_geometry/internal/numerics/Eigen_problem.h>
#include <CGAL/Spectral_geometry/internal/numerics/Spectrum_slices.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

#include <Eigen/Eigenvalues>

namespace CGAL::Spectral_geometry {
namespace internal {

inline Eigenpairs dense_eigenpairs(const Eigen_problem& problem, const Eigen::Index K)
{
  // In units of 1/shift: the solver compares with absolute thresholds.
  const double s = problem.shift();
  const Eigen::MatrixXd L = problem.L(), B = Eigen::MatrixXd(problem.B()) * s;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(L, B);
  if(solver.info() != Eigen::Success)
    throw std::runtime_error("Eigenpairs: the dense eigensolver did not converge.");
  const Eigen::VectorXd values = s * solver.eigenvalues();
  Eigenpairs result{
      values.head(K), std::sqrt(s) * solver.eigenvectors().leftCols(K), {}, "dense", true};
  result.further_values = values.segment(K, (std::min)(K / 2, problem.size() - K));
  return result;
}

/// A range of consecutive pairs.
struct Pair_range
{
  Eigen::Index first = 0, count = 0;
};

/// Sets all residuals, sets eigenvalues to 0 that rounding made negative, and returns the part of a
/// range whose pairs miss the tolerance although doubles can reach it.
inline Pair_range check_residuals(const Eigen_problem& problem, const Eigenpairs_options& options,
                                  const Pair_range range, Eigenpairs& pairs)
{
  if(-pairs.values(0) >
     10. * (std::max)(options.tolerance, problem.residual(pairs, 0)) * problem.scale())
    refuse_indefinite(problem, options.threads);
  pairs.values = pairs.values.cwiseMax(0.).eval();
  pairs.residuals = problem.residuals(pairs, options.threads);
  Pair_range failed;
  for(Eigen::Index k = range.first; k < range.first + range.count; ++k) {
    const double r = pairs.residuals(k);
    if(!(r <= 10. * options.tolerance || r <= 100. * problem.rounding(pairs, k))) {
      failed.first = failed.count == 0 ? k : failed.first;
      failed.count = k + 1 - failed.first;
    }
  }
  return failed;
}

/// One step of subspace iteration with the factor of L + s B, s being the shift of the problem. It
/// removes what rounding has left of the highest modes, which L enlarges. Pairs outside of the
/// range stay.
inline void refine(const Eigen_problem& problem, Supernodal_factor& factor, const int threads,
                   const Pair_range range, Eigenpairs& pairs)
{
  const double s = problem.shift();
  auto X = pairs.vectors.middleCols(range.first, range.count);
  const std::vector<int>& order = factor.order();
  Panel panel(problem.size());
  for(Eigen::Index k = 0; k < range.count; k += panel_width) {
    problem.report(0.9);
    const Eigen::Index columns = (std::min)(range.count - k, Eigen::Index(panel_width));
    const Eigen::MatrixXd b = problem.B() * X.middleCols(k, columns);
    for(std::size_t i = 0; i < order.size(); ++i)
      for(Eigen::Index c = 0; c < panel_width; ++c)
        panel.row(Eigen::Index(i))[c] = c < columns ? b(order[i], c) : 0.;
    factor.solve(panel, panel, threads);
    for(std::size_t i = 0; i < order.size(); ++i)
      for(Eigen::Index c = 0; c < columns; ++c)
        X(order[i], k + c) =
            (pairs.values(range.first + k + c) + s) * panel.row(Eigen::Index(i))[c];
  }
  // Parts of lower modes have grown, those of higher modes have not.
  if(range.first > 0) {
    const auto lower = pairs.vectors.leftCols(range.first);
    const Eigen::MatrixXd BX = problem.B() * X;
    X -= lower * (lower.transpose() * BX);
  }
  const Eigen::MatrixXd Y = X, G = s * (Y.transpose() * (problem.B() * Y)),
                        H = Y.transpose() * (problem.L() * Y);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(H, G);
  if(solver.info() != Eigen::Success)
    throw Not_converged("the projected eigenproblem has no solution");
  pairs.values.segment(range.first, range.count) = s * solver.eigenvalues();
  X = std::sqrt(s) * (Y * solver.eigenvectors());
  for(Eigen::Index k = 1; k < pairs.size(); ++k) // in order, where equal ones are off by a rounding
    pairs.values(k) = (std::max)(pairs.values(k), pairs.values(k - 1));
}

/// Whether pairs have their accuracy, if necessary after some steps of `refine()`. They are
/// complete only within the tolerance.
inline bool have_converged(const Eigen_problem& problem, const Eigenpairs_options& options,
                           Eigenpairs& pairs)
{
  Pair_range failed = check_residuals(problem, options, {0, pairs.size()}, pairs);
  try {
    std::optional<Supernodal_factor> factor;
    for(int sweep = 0; sweep < 2 && failed.count > 0; ++sweep) {
      if(!factor)
        factor.emplace(problem.shifted(-problem.shift()), options.threads);
      refine(problem, *factor, options.threads, failed, pairs);
      failed = check_residuals(problem, options, failed, pairs);
    }
  } catch(const Not_positive_definite&) { // sizes are so graded that there is no factor
    if(pairs.solver != "dense")
      throw;
  }
  pairs.complete = pairs.complete && pairs.residuals.maxCoeff() <= 10. * options.tolerance;
  return failed.count == 0;
}

Eigenpairs pairs_of_part(const Eigen_problem& problem, const Eigen::Index K,
                         const Eigenpairs_options& options)
{
  Eigenpairs result;
  std::string reason;
  const bool dense = is_dense(problem.size(), K, options.method);
  const auto solved_by = [&](const auto& compute) {
    try {
      result = compute();
      if(have_converged(problem, options, result))
        return true;
      reason = sentence("a residual of ", result.residuals.maxCoeff(), " is left");
    } catch(const Not_converged& error) {
      reason = error.what();
    }
    return false;
  };
  const auto slices = [&] { return Spectrum_slices(problem, K, options).compute(); };
  const auto lanczos = [&] { return Block_lanczos(problem, K, options).compute(); };
  if((is_sliced(problem.size(), K, options) && solved_by(slices)) || (!dense && solved_by(lanczos)))
    return result;
  if(dense || (options.method == Eigenpairs_method::automatic && problem.size() <= largest_dense)) {
    result = dense_eigenpairs(problem, K);
    have_converged(problem, options, result);
    return result; // incomplete where the tolerance is not met: no solver does better in doubles
  }
  throw std::runtime_error(sentence("Eigenpairs: the solver did not converge to the tolerance ",
                                    options.tolerance, " for ", K, " pairs of ", problem.size(),
                                    " vertices: ", reason,
                                    "; raise the tolerance or the number of iterations."));
}

/// Returns the parts that entries of L or B join, each as vertices in their order, without those at
/// which functions vanish.
inline std::vector<std::vector<int>> parts_of(const Laplace_operator& op)
{
  const Eigen::Index n = op.L.rows();
  std::vector<char> vanishes(std::size_t(n), 0);
  for(const int v : op.vanishing_vertices)
    vanishes[v] = 1;
  const std::vector<Eigen::Index> component = connected_components(n, [&](const auto& join) {
    for(const Eigen::SparseMatrix<double>* matrix : {&op.L, &op.B})
      for(Eigen::Index j = 0; j < n; ++j)
        for(Eigen::SparseMatrix<double>::InnerIterator entry(*matrix, j); entry; ++entry)
          if(entry.row() < j && entry.value() != 0.)
            join(j, entry.row());
  });
  std::vector<std::vector<int>> result;
  for(Eigen::Index v = 0; v < n; ++v) {
    const std::size_t c = std::size_t(component[v]);
    result.resize((std::max)(result.size(), c + 1));
    if(!vanishes[v])
      result[c].push_back(int(v));
  }
  result.erase(
      std::remove_if(result.begin(), result.end(), [](const auto& part) { return part.empty(); }),
      result.end());
  return result;
}

/// Returns the rows and columns of a part, in their order; `place`: of vertices in their part.
inline Laplace_operator operator_of_part(const Laplace_operator& op, const std::vector<int>& part,
                                         const std::vector<int>& place)
{
  const auto block = [&](const Eigen::SparseMatrix<double>& A) {
    const Eigen::Index n = Eigen::Index(part.size());
    std::vector<Eigen::Triplet<double>> entries;
    for(Eigen::Index j = 0; j < n; ++j)
      for(Eigen::SparseMatrix<double>::InnerIterator entry(A, part[j]); entry; ++entry) {
        const int i = place[entry.row()]; // an entry that is 0 may join two parts
        if(i < n && part[i] == entry.row())
          entries.emplace_back(i, int(j), entry.value());
      }
    Eigen::SparseMatrix<double> result(n, n);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  };
  Laplace_operator result;
  result.L = block(op.L);
  result.B = block(op.B);
  result.mass = op.mass(part);
  return result;
}

/// Returns the eigenvalues after the K-th, up to where a part may have unknown ones.
inline Eigen::VectorXd further_values_of_parts(const std::vector<Eigenpairs>& pairs,
                                               const std::vector<std::vector<int>>& parts,
                                               const Eigen::Index K)
{
  std::vector<double> values;
  double end = std::numeric_limits<double>::infinity();
  for(std::size_t p = 0; p < parts.size(); ++p) {
    const Eigen::VectorXd known = pairs[p].all_values();
    values.insert(values.end(), known.data(), known.data() + known.size());
    if(known.size() < Eigen::Index(parts[p].size()))
      end = (std::min)(end, known.maxCoeff());
  }
  std::sort(values.begin(), values.end());
  const auto first = values.begin() + K,
             last = std::upper_bound(first, first + (std::min)(K / 2, values.end() - first), end);
  return Eigen::VectorXd::Map(values.data() + K, last - first);
}

/// Returns the pairs of all parts, in the order of their values. Equal parts have equal
/// eigenvalues, and a Krylov space of the whole would find eight copies at a time.
inline Eigenpairs pairs_of_parts(const Eigen_problem& problem,
                                 const std::vector<std::vector<int>>& parts, const Eigen::Index K,
                                 const Eigenpairs_options& options)
{
  std::vector<Eigenpairs> pairs(parts.size());
  std::vector<std::tuple<double, std::size_t, Eigen::Index>> order; // value, part, number there
  const double total = double(problem.size() - problem.op().vanishing);
  std::vector<int> place(std::size_t(problem.size()), problem.size()); // in its part
  for(const std::vector<int>& part : parts)
    for(std::size_t i = 0; i < part.size(); ++i)
      place[part[i]] = int(i);
  double bound = std::numeric_limits<double>::infinity(); // no wanted value is larger
  for(bool enough = false; !enough;) {
    enough = true;
    std::size_t done = 0;
    for(std::size_t p = 0; p < parts.size(); ++p) {
      const Eigen::Index size = Eigen::Index(parts[p].size()), known = pairs[p].size();
      done += parts[p].size();
      if(known == (std::min)(size, K) || (known > 0 && pairs[p].values(known - 1) >= bound))
        continue;
      enough = false;
      // As many as a part of this size is likely to have (Weyl), with some to spare.
      const double share = double(K) * double(size) / total;
      const Eigen::Index wanted = known > 0 ? known + known / 2 + 8 : Eigen::Index(1.2 * share) + 8;
      const Laplace_operator op = operator_of_part(problem.op(), parts[p], place);
      const auto report = [&](const double fraction) {
        problem.report((double(done) - (1. - fraction) * double(size)) / total);
        return true;
      };
      const Eigen_problem part(op, {1, report}, problem.scale());
      pairs[p] = pairs_of_part(part, (std::min)({wanted, size, K}), options);
    }
    order.clear();
    for(std::size_t p = 0; p < parts.size(); ++p)
      for(Eigen::Index k = 0; k < pairs[p].size(); ++k)
        order.emplace_back(pairs[p].values(k), p, k);
    std::sort(order.begin(), order.end());
    if(Eigen::Index(order.size()) >= K)
      bound = std::get<0>(order[K - 1]);
  }
  Eigenpairs result{Eigen::VectorXd(K), Eigen::MatrixXd::Zero(problem.size(), K),
                    Eigen::VectorXd(K), "dense", true};
  for(const Eigenpairs& part : pairs) {
    if(part.solver == "block")
      result.solver = part.solver;
    result.complete = result.complete && part.complete;
  }
  for(Eigen::Index k = 0; k < K; ++k) {
    const auto [value, p, own] = order[k];
    result.values(k) = value;
    result.residuals(k) = pairs[p].residuals(own);
    for(std::size_t i = 0; i < parts[p].size(); ++i)
      result.vectors(parts[p][i], k) = pairs[p].vectors(Eigen::Index(i), own);
  }
  result.further_values = further_values_of_parts(pairs, parts, K);
  return result;
}

/// Diagonal dominance is enough (Gershgorin), as in masses of meshes; otherwise a factorisation.
inline void check_mass_matrix(const Eigen_problem& problem, const int threads)
{
  if(!(dominance(problem.B()).array() > 0.).all())
    require(number_of_negative_eigenvalues(problem.B(), threads) == 0,
            "Eigenpairs: the mass matrix B is not positive definite; pass one that is.");
}

inline void check_pencil(const Eigen::SparseMatrix<double>& matrix, const char* name)
{
  require(matrix.rows() == matrix.cols() && matrix.rows() != 0, "Eigenpairs: ", name, " is ",
          size_name(matrix), "; pass a square matrix.");
  const Eigen::SparseMatrix<double> transposed = matrix.transpose();
  const Eigen::SparseMatrix<double> difference = matrix - transposed;
  for(Eigen::Index j = 0; j < matrix.cols(); ++j) {
    const double size = matrix.col(j).cwiseAbs().sum();
    require(std::isfinite(size) && difference.col(j).cwiseAbs().sum() <= 1e-10 * size,
            "Eigenpairs: ", name, " is not symmetric and finite in row ", j,
            " (counted from 0); correct it.");
  }
}

} // namespace internal

Eigenpairs eigenpairs(const Laplace_operator& op, Eigen::Index K, const Eigenpairs_options& options)
{
  const internal::Eigen_problem problem(op, options);
  problem.check(K);
  internal::check_eigenpairs_options(options, K);
  internal::check_mass_matrix(problem, options.threads);

  const Eigen::Index zeros = number_of_zero_eigenvalues(op);
  problem.report(0.);
  const std::vector<std::vector<int>> parts = internal::parts_of(op);
  Eigenpairs result = Eigen::Index(parts[0].size()) == problem.size()
                          ? internal::pairs_of_part(problem, K, options)
                          : internal::pairs_of_parts(problem, parts, K, options);
  internal::fix_signs(result.vectors);
  result.zeros = zeros;
  problem.report(1.);
  return result;
}

Eigenpairs eigenpairs(const Eigen::SparseMatrix<double>& L, const Eigen::SparseMatrix<double>& B,
                      Eigen::Index K, const Eigenpairs_options& options)
{
  internal::check_pencil(L, "L");
  internal::check_pencil(B, "B");
  Laplace_operator op;
  op.L = L;
  op.B = B;
  op.L.makeCompressed();
  op.B.makeCompressed();
  op.mass = B * Eigen::VectorXd::Ones(B.cols());
  for(Eigen::Index v = 0; v < op.mass.size(); ++v)
    internal::require(op.mass[v] > 0., "Eigenpairs: the sum of row ", v,
                      " (counted from 0) of the mass matrix B is not positive; correct it.");
  return eigenpairs(op, K, options);
}

} // namespace CGAL::Spectral_geometry

#endif // definitions

#endif // CGAL_SPECTRAL_GEOMETRY_EIGENPAIRS_H
