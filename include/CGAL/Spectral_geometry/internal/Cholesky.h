// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_CHOLESKY_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_CHOLESKY_H

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#ifdef CGAL_SPECTRAL_WITH_CHOLMOD
#include <cholmod.h>
#endif

#include <memory>
#include <stdexcept>
#include <string>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

using Sparse_matrix = Eigen::SparseMatrix<double>;

[[noreturn]] inline void factorisation_failed()
{
  throw std::runtime_error(
      "Eigenpairs: the factorisation of the shifted Laplacian failed; look for needle faces or "
      "coordinates of very different magnitude in the mesh.");
}

#ifdef CGAL_SPECTRAL_WITH_CHOLMOD

// By `cholmod_common::status`.
[[noreturn]] inline void factorisation_failed(int status)
{
  if(status == CHOLMOD_OUT_OF_MEMORY)
    throw std::runtime_error(
        "Eigenpairs: there is not enough memory for the factor of the shifted Laplacian; simplify the mesh "
        "before.");
  if(status == CHOLMOD_TOO_LARGE)
    throw std::runtime_error(
        "Eigenpairs: the factor of the shifted Laplacian has more entries than indices of 32 bits can count; "
        "simplify the mesh before.");
  if(status < CHOLMOD_OK)
    throw std::runtime_error("Eigenpairs: CHOLMOD could not factorise the shifted Laplacian (status " +
                             std::to_string(status) + "); look at its installation.");
  factorisation_failed();
}

// CHOLMOD keeps its settings, its workspace and the outcome of the last call here; one for each thread.
class Cholmod_context
{
public:
  Cholmod_context()
  {
    cholmod_start(&m_common);
    m_common.print = 0; // a library prints nothing
  }
  ~Cholmod_context()
  {
    cholmod_free_dense(&m_x, &m_common);
    cholmod_free_dense(&m_y, &m_common);
    cholmod_free_dense(&m_e, &m_common);
    cholmod_finish(&m_common);
  }
  Cholmod_context(const Cholmod_context&) = delete;
  Cholmod_context& operator=(const Cholmod_context&) = delete;

  cholmod_common* common() { return &m_common; }

  // x = A^-1 b for all columns at once; the workspace survives for the next call.
  void solve(cholmod_factor* factor, const Eigen::Ref<const Eigen::MatrixXd>& b,
             Eigen::Ref<Eigen::MatrixXd> x)
  {
    cholmod_dense rhs{};
    rhs.nrow = b.rows();
    rhs.ncol = b.cols();
    rhs.d = b.outerStride();
    rhs.nzmax = rhs.d * rhs.ncol;
    rhs.x = const_cast<double*>(b.data());
    rhs.xtype = CHOLMOD_REAL;
    rhs.dtype = CHOLMOD_DOUBLE;
    if(!cholmod_solve2(CHOLMOD_A, factor, &rhs, nullptr, &m_x, nullptr, &m_y, &m_e, &m_common))
      throw std::runtime_error("Eigenpairs: CHOLMOD ran out of memory in a triangular solve.");
    x = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(m_x->x), b.rows(), b.cols());
  }

private:
  cholmod_common m_common;
  cholmod_dense* m_x = nullptr;
  cholmod_dense* m_y = nullptr;
  cholmod_dense* m_e = nullptr;
};

// A view of one triangle of a symmetric matrix.
inline cholmod_sparse cholmod_view(const Sparse_matrix& lower)
{
  cholmod_sparse view{};
  view.nrow = lower.rows();
  view.ncol = lower.cols();
  view.nzmax = lower.nonZeros();
  view.p = const_cast<int*>(lower.outerIndexPtr());
  view.i = const_cast<int*>(lower.innerIndexPtr());
  view.x = const_cast<double*>(lower.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

// A factorisation P A P^T = L L^T (supernodal: level 3 BLAS) or L D L^T (simplicial: A may be indefinite).
class Cholmod_factor
{
public:
  // With `many` factorisations to come, two orderings are tried for a large matrix.
  Cholmod_factor(const Sparse_matrix& A, bool positive_definite, bool many = false)
  {
    const Sparse_matrix lower = A.triangularView<Eigen::Lower>();
    cholmod_sparse view = cholmod_view(lower);
    cholmod_common* c = m_context.common();
    c->supernodal = positive_definite ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
    c->final_ll = positive_definite;
    if(many && A.rows() > 30000)
      c->nmethods = 3; // given (there is none), minimum degree and nested dissection: that of fewer entries
    m_factor = cholmod_analyze(&view, c);
    factorise(view);
  }
  ~Cholmod_factor() { cholmod_free_factor(&m_factor, m_context.common()); }
  Cholmod_factor(const Cholmod_factor&) = delete;
  Cholmod_factor& operator=(const Cholmod_factor&) = delete;

  // Another matrix with the entries of the first in the same places: the ordering is kept.
  void refactorise(const Sparse_matrix& A)
  {
    const Sparse_matrix lower = A.triangularView<Eigen::Lower>();
    cholmod_sparse view = cholmod_view(lower);
    factorise(view);
  }

  bool ok() const { return m_ok; }
  int status() const { return m_status; }
  cholmod_factor* get() const { return m_factor; }
  Cholmod_context& context() { return m_context; }

  // L D L^T only: D is the first entry of each column.
  Eigen::Index number_of_negative_pivots() const
  {
    const int* begin = static_cast<const int*>(m_factor->p);
    const double* value = static_cast<const double*>(m_factor->x);
    Eigen::Index count = 0;
    for(std::size_t j = 0; j < m_factor->n; ++j)
      count += value[begin[j]] < 0.;
    return count;
  }

private:
  void factorise(cholmod_sparse& view)
  {
    cholmod_common* c = m_context.common();
    m_ok = m_factor != nullptr && cholmod_factorize(&view, m_factor, c) && c->status == CHOLMOD_OK &&
           m_factor->minor == m_factor->n;
    m_status = c->status;
  }

  Cholmod_context m_context;
  cholmod_factor* m_factor = nullptr;
  bool m_ok = false;
  int m_status = CHOLMOD_OK;
};

#endif // CGAL_SPECTRAL_WITH_CHOLMOD

/// The Cholesky factorisation of a symmetric positive definite matrix and its solves: CHOLMOD's supernodal one where
/// the program is built with it, Eigen's otherwise. Throws std::runtime_error when the matrix is not positive definite.
class Cholesky
{
public:
  // `many`: others are to be factorised in the same places, so that CHOLMOD may look longer for an ordering.
  explicit Cholesky(const Sparse_matrix& A, [[maybe_unused]] bool many = false)
    : m_n(A.rows())
#ifdef CGAL_SPECTRAL_WITH_CHOLMOD
    , m_factor(A, true, many)
#endif
  {
#ifndef CGAL_SPECTRAL_WITH_CHOLMOD
    m_llt.compute(A);
#endif
    check();
  }

  // Another matrix with the entries of the first in the same places.
  void refactorise(const Sparse_matrix& A)
  {
#ifdef CGAL_SPECTRAL_WITH_CHOLMOD
    m_factor.refactorise(A);
#else
    m_llt.factorize(A);
#endif
    check();
  }

  static std::string name()
  {
#ifdef CGAL_SPECTRAL_WITH_CHOLMOD
    return "cholmod";
#else
    return "simplicial";
#endif
  }

  Eigen::Index size() const
  {
    return m_n;
  }

  // x = A^-1 b, any number of columns; x and b may be the same.
  void solve(const Eigen::Ref<const Eigen::MatrixXd>& b, Eigen::Ref<Eigen::MatrixXd> x)
  {
#ifdef CGAL_SPECTRAL_WITH_CHOLMOD
    m_factor.context().solve(m_factor.get(), b, x);
#else
    x = m_llt.solve(b);
#endif
  }

private:
  void check() const
  {
#ifdef CGAL_SPECTRAL_WITH_CHOLMOD
    if(!m_factor.ok())
      factorisation_failed(m_factor.status());
#else
    if(m_llt.info() != Eigen::Success)
      factorisation_failed();
#endif
  }

  Eigen::Index m_n;
#ifdef CGAL_SPECTRAL_WITH_CHOLMOD
  Cholmod_factor m_factor;
#else
  Eigen::SimplicialLLT<Sparse_matrix> m_llt;
#endif
};

/// Returns the number of negative eigenvalues of a symmetric matrix (Sylvester's law of inertia: the signs of D in
/// A = L D L^T), or -1 when a pivot vanishes.
inline Eigen::Index number_of_negative_eigenvalues(const Sparse_matrix& A)
{
#ifdef CGAL_SPECTRAL_WITH_CHOLMOD
  const Cholmod_factor factor(A, false);
  return factor.ok() ? factor.number_of_negative_pivots() : -1;
#else
  const Eigen::SimplicialLDLT<Sparse_matrix> ldlt(A);
  return ldlt.info() == Eigen::Success ? (ldlt.vectorD().array() < 0.).count() : -1;
#endif
}

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_CHOLESKY_H
