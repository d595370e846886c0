// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_RELOCATION_ENERGY_H
#define CGAL_SPECTRAL_GEOMETRY_RELOCATION_ENERGY_H

#include <CGAL/Spectral_geometry/internal/surface/Operator_geometry.h>
#include <CGAL/Spectral_geometry/internal/numerics/for_each_task.h>

#include <Eigen/SparseCholesky>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// Signals on a coarse mesh that depend on where its vertices are: read off the fine surface, for
/// instance.
class Position_dependent_signals
{
public:
  using Positions = internal::Operator_geometry::Positions; ///< n x 3, one position in each row
  /// n x K, one vertex in each row
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  virtual ~Position_dependent_signals() = default;
  /// writes the n x K signals F and their Laplacians Z at the n positions V.
  virtual void evaluate(const Positions& V, Rows& F, Rows& Z) = 0;
  /// adds to `gradient` the derivatives by the positions, given those by the entries of F and Z at
  /// the positions evaluated last.
  virtual void add_gradient(const Rows& by_F, const Rows& by_Z, Positions& gradient) const = 0;
};

/*!
The metric as a function of the positions of a coarse mesh whose triangles stay as they are, with
its gradient. With \f$ R = B Z - L F \f$
\f[ E(V) = \sum_w \|R_w\|^2 / M_w \f]
(Eq. 2 of Lescoat et al. 2020 in the weak form for any mass, decomposed by vertex). Beside it stands
the part of the residual that the functional map sees: with \f$ A = B + \tau L \f$ \f[ S(V) = \|
A^{-1} R \|_B^2 + \mu E(V) . \f] In coarse eigenvectors, \f$ C = \widetilde\Phi^\top B F \f$ over
all of them, and with eigenvectors as signals, \f[ \|A^{-1} R\|_B^2 = \sum_{i,j} \frac{(\lambda_j -
\widetilde\lambda_i)^2 C_{ij}^2}
   {(1 + \tau\widetilde\lambda_i)^2}, \f]
and E is this sum without the denominator. Most of E lies in coarse modes far beyond K, which \f$
\|C\|_L \f$ does not contain: a descent on E would spend its steps on them. With \f$ \tau \f$ near
\f$ 1/\lambda_K \f$ the denominator takes them out. A small \f$ \mu E \f$ keeps E from rising. With
\f$ \tau = 0 \f$ the first term is left out: S is \f$ \mu E \f$.

The signals may be given (carried by a restriction), depend on the positions, or both: S is the sum.

S does not see how area is spread over the mesh: a commutator of C is as small where all of a column
is too large. Distances and heat kernels do, they are sums of squared eigenvectors. Of signals that
depend on the positions `keep_inner_products()` therefore adds \f[ \nu \sum_p \left\| \frac{F_p^\top
B F_p}{\mathrm{tr} M} - T_p \right\|^2 \Big/ \sum_p (\mathrm{tr}\, T_p)^2 \f] with \f$ F_p \f$ 32
signals each and \f$ T_p \f$ what they should be: with the lumped mass of the fine mesh \f[ T =
F^\top M \Big( F - \frac{\theta\, \mathrm{tr} M}{4 \sqrt 3\, n} Z \Big) \Big/ \mathrm{tr} M, \f]
since an even mesh of n vertices, edges of length h, finds \f$ 1 - \theta \lambda h^2 / 8 \f$ for
the square of a unit eigenvector that is read off at its vertices.

The gradient is exact: the chain rule leads from the entries of B, L and M to the three cotangents
and the area of each triangle, and from there to its corners. Residuals sum differences F_j - F_w:
the small ones of smooth signals are not lost in the rounding of large sums.

A value or a gradient takes O(n K). If tau is positive, it also takes one sparse Cholesky
factorisation of A, and for each signal one solve, two with a gradient. Signals are treated 32 at a
time, so that a solve stays in the cache, on the threads of `set_threads()`.

E is a function of lengths: it does not see on which side of a surface a vertex lies, nor
inversions. Guard the vertices that you move, see `relocate_positions()`.
*/
class Relocation_energy
{
public:
  using Index = Eigen::Index;                               ///< of vertices
  using Positions = internal::Operator_geometry::Positions; ///< n x 3, one position in each row
  /// n x K, one vertex in each row
  using Rows = Position_dependent_signals::Rows;

  /*!
  @param T      m x 3, the triangles of the coarse mesh, an oriented manifold
  @param F, Z   n x K, the restricted signals and their restricted Laplacians; K may be 0 if
  `moving` is given
  @param op     the operator, with coefficients for the n vertices or none; or the weight theta of
  the consistent mass
  @param tau    not negative, in the inverse of the unit of eigenvalues; 0: no first term
  @param mu     weight of E, not negative
  @param moving signals that depend on the positions, or null; not owned

  Throws `std::invalid_argument` if the sizes do not match, an index or a number is out of range.
  */
  Relocation_energy(const Eigen::MatrixXi& T, const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z,
                    const Local_operator& op, const double tau = 0, const double mu = 1,
                    Position_dependent_signals* moving = nullptr)
    : m_geometry(T, F.rows(), op)
    , m_tau(tau)
    , m_mu(mu)
    , m_moving(moving)
  {
    internal::require(Z.rows() == F.rows() && Z.cols() == F.cols(), "relocation: F is ",
                      internal::size_name(F), " and Z ", internal::size_name(Z),
                      "; pass two matrices of one size.");
    internal::require(tau >= 0 && mu >= 0,
                      "relocation: tau and mu must not be negative, but they are ", tau, " and ",
                      mu, ".");
    for(Index first = 0; first < F.cols(); first += width)
      m_given.push_back({panel(F, first), panel(Z, first)});
  }

  /// n.
  Index number_of_vertices() const { return m_geometry.number_of_vertices(); }

  /// Sets the weight of E, also in the gradient.
  void set_mu(const double mu) { m_mu = mu; }

  /// Adds nu times the differences of inner products of moving signals to S. `mass`: the lumped
  /// mass of the fine mesh; F and Z, fine x K: these signals on it.
  void keep_inner_products(const Eigen::VectorXd& mass, const Eigen::MatrixXd& F,
                           const Eigen::MatrixXd& Z, const double nu)
  {
    internal::require(F.rows() == mass.size() && Z.rows() == mass.size() && Z.cols() == F.cols(),
                      "relocation: F and Z have ", F.rows(), " and ", Z.rows(),
                      " rows, but the fine mesh has ", mass.size(),
                      " vertices; pass one row for each, and as many columns.");
    m_inner_products.clear();
    const double area = mass.sum(), lost = m_geometry.local_operator().theta * area /
                                           (4 * std::sqrt(3.) * double(number_of_vertices()));
    double size = 0;
    for(Index first = 0; first < F.cols(); first += width) {
      const Index columns = (std::min)(Index(width), F.cols() - first);
      Eigen::MatrixXd T = Eigen::MatrixXd::Zero(width, width);
      for(Index row = 0; row < F.rows(); row += 1024) { // no copy of F
        const Index rows = (std::min)(Index(1024), F.rows() - row);
        const Eigen::MatrixXd f = F.block(row, first, rows, columns),
                              g = mass.segment(row, rows).asDiagonal() *
                                  (f - lost * Z.block(row, first, rows, columns));
        T.topLeftCorner(columns, columns) += f.transpose() * g / area;
      }
      m_inner_products.push_back((T + T.transpose()) / 2);
      size += std::pow(T.trace(), 2);
    }
    m_nu = size > 0 ? nu / size : 0.;
  }

  /// Threads to use, from 1; no result depends on them.
  void set_threads(const int threads) { m_threads = threads; }

  /// returns S(V), infinity if a triangle has no area or A cannot be factorised.
  double value(const Positions& V) { return evaluate(V, nullptr); }

  /// returns S(V) and writes its gradient, n x 3, which is 0 where S is infinite.
  double value_and_gradient(const Positions& V, Positions& gradient)
  {
    gradient.setZero(number_of_vertices(), 3);
    return evaluate(V, &gradient);
  }

  /// Returns the first term where the last value was taken.
  double smoothed_part() const { return m_smoothed; }
  /// Returns E, without its weight, where the last value was taken.
  double energy_part() const { return m_energy; }

private:
  static constexpr int width = 32, lanes = 8;
  using Panel = Rows; // of `width` columns
  using Entries = internal::Operator_geometry::Entries;
  struct Signals
  {
    Panel F, Z;
  };

  template <class Matrix>
  static Panel panel(const Matrix& F, const Index first)
  {
    Panel result = Panel::Zero(F.rows(), Index(width));
    const Index columns = (std::min)(Index(width), F.cols() - first);
    result.leftCols(columns) = F.middleCols(first, columns);
    return result;
  }

  // The contribution of 32 signals, and scratch memory for it.
  struct Work
  {
    double smoothed, energy, inner = 0;
    Entries derivatives;
    Panel Y, X, multiplier, scratch, BF, by_F;
  };

  double evaluate(const Positions& V, Positions* gradient)
  {
    m_smoothed = m_energy = std::numeric_limits<double>::infinity();
    if(!m_geometry.assemble(V, m_entries) || (m_tau > 0 && !factorise()))
      return m_smoothed;
    Rows F, Z, by_F, by_Z;
    if(m_moving) {
      m_moving->evaluate(V, F, Z);
      clear_vanishing(F);
      clear_vanishing(Z);
      by_F.resize(F.rows(), F.cols());
      by_Z.resize(F.rows(), F.cols());
    }
    const int given = int(m_given.size()), moving = int((F.cols() + width - 1) / width);
    internal::require(m_nu == 0 || m_inner_products.size() == std::size_t(moving),
                      "relocation: there are ", F.cols(), " moving signals, but inner products of ",
                      "another number; pass the same signals to keep_inner_products().");
    m_work.resize(std::size_t(given + moving));
    internal::for_each_task(given + moving, m_threads, [&](const int i) {
      Work& work = m_work[std::size_t(i)];
      if(i < given)
        return add(m_given[std::size_t(i)], gradient != nullptr, work);
      const Index first = Index(i - given) * width;
      const Signals signals = {panel(F, first), panel(Z, first)};
      add(signals, gradient != nullptr, work);
      if(gradient)
        internal::on_vector_units([&] { add_linear(first, work, by_F, by_Z); });
      if(m_nu > 0)
        add_inner_products(first, signals.F, gradient != nullptr, work, by_F);
    });
    m_smoothed = m_energy = 0;
    double inner = 0;
    Entries derivatives = m_geometry.zero_entries();
    for(const Work& work : m_work) {
      m_smoothed += work.smoothed;
      m_energy += work.energy;
      inner += work.inner;
      if(gradient)
        derivatives += work.derivatives;
    }
    if(gradient) {
      if(m_moving) {
        clear_vanishing(by_F);
        clear_vanishing(by_Z);
        m_moving->add_gradient(by_F, by_Z, *gradient);
      }
      m_geometry.add_gradient(derivatives, V, *gradient);
    }
    return m_smoothed + m_mu * m_energy + m_nu * inner;
  }

  // With a = tr M, G = F^T B F / a and D = G - T: d|D|^2 = 2 D . (2 F^T B dF + F^T dB F - G da) /
  // a.
  void add_inner_products(const Index first, const Panel& F, const bool derive, Work& work,
                          Rows& by_F) const
  {
    Panel& BF = work.BF;
    BF = m_entries.B_diagonal.asDiagonal() * F;
    for(std::size_t e = 0; e < m_geometry.edges().size(); ++e) {
      const auto [i, j] = m_geometry.edges()[e];
      BF.row(i) += m_entries.B(Index(e)) * F.row(j);
      BF.row(j) += m_entries.B(Index(e)) * F.row(i);
    }
    const double area = m_entries.mass.sum();
    const Eigen::MatrixXd G = F.transpose() * BF / area,
                          D = G - m_inner_products[std::size_t(first / width)];
    work.inner = D.squaredNorm();
    if(!derive)
      return;
    const Eigen::MatrixXd by_G = 2 * m_nu / area * D;
    const Index columns = (std::min)(Index(width), by_F.cols() - first);
    work.by_F = 2 * BF * by_G;
    by_F.middleCols(first, columns) += work.by_F.leftCols(columns);
    Entries& d = work.derivatives;
    d.mass.array() -= by_G.cwiseProduct(G).sum();
    work.by_F = F * by_G;
    for(Index w = 0; w < number_of_vertices(); ++w)
      d.B_diagonal(w) += F.row(w).dot(work.by_F.row(w));
    for(std::size_t e = 0; e < m_geometry.edges().size(); ++e) {
      const auto [i, j] = m_geometry.edges()[e];
      d.B(Index(e)) += 2 * F.row(i).dot(work.by_F.row(j));
    }
  }

  void clear_vanishing(Rows& rows) const
  {
    for(Index w = 0; w < rows.rows(); ++w)
      if(m_geometry.vanishes_at(w))
        rows.row(w).setZero();
  }

  // Derivatives with respect to the entries of F and Z, in which R is linear.
  CGAL_SPECTRAL_INLINE void add_linear(const Index first, const Work& work, Rows& by_F,
                                       Rows& by_Z) const
  {
    const Index columns = (std::min)(Index(width), by_F.cols() - first);
    for(Index w = 0; w < number_of_vertices(); ++w) {
      Row f{}, z{};
      add_multiple(2 * m_entries.B_diagonal(w), work.multiplier.row(w).data(), z);
      for(const auto& entry : m_geometry.row(w)) {
        const double* const x = work.multiplier.row(entry.neighbour).data();
        const double L = 2 * m_entries.L(entry.edge);
        add_multiple(2 * m_entries.B(entry.edge), x, z);
        add_difference(-L, x, work.multiplier.row(w).data(), f);
      }
      std::copy_n(f, columns, by_F.row(w).data() + first);
      std::copy_n(z, columns, by_Z.row(w).data() + first);
    }
  }

  // A = B + tau L, lower triangle.
  bool factorise()
  {
    const Index n = number_of_vertices();
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(std::size_t(n) + m_geometry.edges().size());
    Eigen::VectorXd diagonal = m_entries.B_diagonal;
    for(std::size_t e = 0; e < m_geometry.edges().size(); ++e) {
      const auto [i, j] = m_geometry.edges()[e];
      const double L = m_tau * m_entries.L(Index(e));
      diagonal(i) -= L;
      diagonal(j) -= L;
      // A row that vanishes has its diagonal alone.
      const bool apart = m_geometry.vanishes_at(i) || m_geometry.vanishes_at(j);
      entries.emplace_back((std::max)(i, j), (std::min)(i, j),
                           apart ? 0. : m_entries.B(Index(e)) + L);
    }
    for(Index i = 0; i < n; ++i)
      entries.emplace_back(int(i), int(i),
                           diagonal(i) > 0 ? diagonal(i) : 1.); // 1: a vertex without a face
    Eigen::SparseMatrix<double> A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    if(m_cholesky.rows() == 0)
      m_cholesky.analyzePattern(A); // it stays the same
    m_cholesky.factorize(A);
    return m_cholesky.info() == Eigen::Success;
  }

  // x <- A^-1 x, row by row of the factor: what belongs to one vertex is contiguous.
  CGAL_SPECTRAL_INLINE void solve(Panel& x, Panel& scratch) const
  {
    using Entry_of_factor = Eigen::SparseMatrix<double>::InnerIterator;
    const auto& G = m_cholesky.matrixL().nestedExpression();
    const auto& place = m_cholesky.permutationP().indices();
    scratch.resize(x.rows(), width);
    double* const y = scratch.data();
    for(Index i = 0; i < x.rows(); ++i)
      std::copy_n(x.row(i).data(), width, y + place(i) * width);
    for(Index j = 0; j < x.rows(); ++j) {
      Entry_of_factor it(G, j); // the diagonal comes first
      double* const pivot = y + j * width;
      scale(1 / it.value(), pivot);
      for(++it; it; ++it)
        add_multiple(-it.value(), pivot, y + it.row() * width);
    }
    for(Index j = x.rows(); j-- > 0;) {
      Entry_of_factor it(G, j);
      const double diagonal = it.value();
      double* const pivot = y + j * width;
      for(++it; it; ++it)
        add_multiple(-it.value(), y + it.row() * width, pivot);
      scale(1 / diagonal, pivot);
    }
    for(Index i = 0; i < x.rows(); ++i)
      std::copy_n(y + place(i) * width, width, x.row(i).data());
  }

  // With Y = A^-1 R, X = A^-1 B Y and Q = R / M:
  // dS = Y^T dB Y - 2 X^T dA Y + 2 (X + mu Q)^T (dB Z - dL F) - mu E_w / M_w dM_w.
  void add(const Signals& s, const bool derive, Work& work) const
  {
    internal::on_vector_units([&] { add_body(s, derive, work); });
  }

  CGAL_SPECTRAL_INLINE void add_body(const Signals& s, const bool derive, Work& work) const
  {
    const Index n = number_of_vertices();
    Panel &Y = work.Y, &X = work.X, &Q = work.multiplier;
    work.smoothed = work.energy = 0;
    work.derivatives = m_geometry.zero_entries();
    Y.setZero(n, width);
    X.setZero(n, width);
    Q.setZero(n, width);
    for(Index w = 0; w < n; ++w) {
      if(m_geometry.vanishes_at(w))
        continue;
      double* const r = Y.row(w).data();
      add_multiple(m_entries.B_diagonal(w), s.Z.row(w).data(), r);
      for(const auto& entry : m_geometry.row(w)) {
        const double L = m_entries.L(entry.edge);
        add_multiple(m_entries.B(entry.edge), s.Z.row(entry.neighbour).data(), r);
        add_difference(-L, s.F.row(entry.neighbour).data(), s.F.row(w).data(), r);
      }
      if(m_geometry.row(w).empty())
        continue;
      const double mass = m_entries.mass(w), E = dot(r, r) / mass;
      work.energy += E;
      add_multiple(m_mu / mass, r, Q.row(w).data());
      if(derive)
        work.derivatives.mass(w) -= m_mu * E / mass;
    }
    if(m_tau > 0)
      smooth(derive, work);
    else
      Y.setZero();
    if(derive) {
      Q += X;
      add_derivatives(s, work);
    }
  }

  // Computes Y and the first term from the R in Y, and X if derivatives are needed.
  CGAL_SPECTRAL_INLINE void smooth(const bool derive, Work& work) const
  {
    Panel &Y = work.Y, &X = work.X;
    solve(Y, work.scratch);
    for(Index w = 0; w < Y.rows(); ++w) {
      if(m_geometry.vanishes_at(w))
        continue;
      double* const x = X.row(w).data();
      add_multiple(m_entries.B_diagonal(w), Y.row(w).data(), x);
      for(const auto& entry : m_geometry.row(w))
        add_multiple(m_entries.B(entry.edge), Y.row(entry.neighbour).data(), x);
      work.smoothed += dot(x, Y.row(w).data());
    }
    if(derive)
      solve(X, work.scratch);
  }

  CGAL_SPECTRAL_INLINE void add_derivatives(const Signals& s, Work& work) const
  {
    const Panel &Y = work.Y, &X = work.X, &Q = work.multiplier;
    Entries& d = work.derivatives;
    for(Index w = 0; w < number_of_vertices(); ++w) {
      const double *const y = Y.row(w).data(), *const x = X.row(w).data();
      d.B_diagonal(w) += dot(y, y) + 2 * dot(Q.row(w).data(), s.Z.row(w).data()) - 2 * dot(x, y);
    }
    for(std::size_t e = 0; e < m_geometry.edges().size(); ++e) {
      const auto [i, j] = m_geometry.edges()[e];
      const double *const yi = Y.row(i).data(), *const yj = Y.row(j).data(),
                          *const xi = X.row(i).data(), *const xj = X.row(j).data(),
                          *const qi = Q.row(i).data(), *const qj = Q.row(j).data(),
                          *const zi = s.Z.row(i).data(), *const zj = s.Z.row(j).data(),
                          *const fi = s.F.row(i).data(), *const fj = s.F.row(j).data();
      double b[lanes] = {}, l[lanes] = {};
      for(int k = 0; k < width; k += lanes)
        for(int c = k; c < k + lanes; ++c) {
          b[c - k] += yi[c] * yj[c] + qi[c] * zj[c] + qj[c] * zi[c] - xi[c] * yj[c] - xj[c] * yi[c];
          l[c - k] += (qi[c] - qj[c]) * (fi[c] - fj[c]) + m_tau * (xi[c] - xj[c]) * (yi[c] - yj[c]);
        }
      d.B(Index(e)) += 2 * sum(b);
      d.L(Index(e)) += 2 * sum(l);
    }
  }

  // Rows of a panel. Plain loops: the compiler turns them into vector instructions, and takes a
  // tenth of the time it takes for Eigen's expressions.
  using Row = double[width];

  CGAL_SPECTRAL_INLINE static void add_multiple(const double a, const double* x, double* y)
  {
    for(int c = 0; c < width; ++c)
      y[c] += a * x[c];
  }

  CGAL_SPECTRAL_INLINE static void add_difference(const double a, const double* x, const double* x0,
                                                  double* y)
  {
    for(int c = 0; c < width; ++c)
      y[c] += a * (x[c] - x0[c]);
  }

  CGAL_SPECTRAL_INLINE static void scale(const double a, double* y)
  {
    for(int c = 0; c < width; ++c)
      y[c] *= a;
  }

  // Eight partial sums: one alone could not be vectorised.
  CGAL_SPECTRAL_INLINE static double dot(const double* x, const double* y)
  {
    double partial[lanes] = {};
    for(int k = 0; k < width; k += lanes)
      for(int c = k; c < k + lanes; ++c)
        partial[c - k] += x[c] * y[c];
    return sum(partial);
  }

  CGAL_SPECTRAL_INLINE static double sum(const double* partial)
  {
    return ((partial[0] + partial[1]) + (partial[2] + partial[3])) +
           ((partial[4] + partial[5]) + (partial[6] + partial[7]));
  }

  internal::Operator_geometry m_geometry;
  double m_tau, m_mu;
  Position_dependent_signals* m_moving;
  std::vector<Signals> m_given;
  Entries m_entries;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> m_cholesky;
  double m_smoothed = 0, m_energy = 0, m_nu = 0;
  std::vector<Eigen::MatrixXd> m_inner_products; // of the fine mesh, of 32 signals each
  int m_threads = 1;
  std::vector<Work> m_work;
};

/// @}

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_RELOCATION_ENERGY_H
