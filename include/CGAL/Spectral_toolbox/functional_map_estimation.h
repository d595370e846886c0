// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_FUNCTIONAL_MAP_ESTIMATION_H
#define CGAL_SPECTRAL_TOOLBOX_FUNCTIONAL_MAP_ESTIMATION_H

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_toolbox/internal/separate_compilation.h>

/*!
\file
Finding the map between two shapes: functional maps from descriptors, and their refinement.
Directions and units as in vertex_maps.h; these functions need eigenpairs of both meshes **at unit
area** (or of two meshes of one area).
*/

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationTransfer
/// @{

/*!
returns the operator \f$ \Omega_f = \Phi^\top W_f \Phi \f$ with
\f[ (W_f g)_v = \int \psi_v \, n \cdot (\nabla f \times \nabla g)
             = \sum_{(v_1, v_2, v_3) \ni v}
               \frac{(f_2 - f_1)(g_3 - g_1) - (f_3 - f_1)(g_2 - g_1)}{6} \f]
for linear elements with hat functions \f$ \psi_v \f$. A map that keeps f and the orientation
commutes with it; one that mirrors the surface changes its sign. So it tells left from right (Ren,
Poulenard, Wonka and Ovsjanikov 2018). It depends on the triangles, not on the positions.

@param T the triangles, m x 3, oriented
@param vectors \f$ \Phi \f$, n x k
@param f one value per vertex
@return k x k, antisymmetric on a closed mesh
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::MatrixXd orientation_operator(const Eigen::MatrixXi& T,
                                                                  const Eigen::MatrixXd& vectors,
                                                                  const Eigen::VectorXd& f);

/// what `functional_map_of_descriptors()` weighs, relative to the preservation of the descriptors.
struct Functional_map_weights
{
  /// of \f$ \|C \Lambda_X - \Lambda_Y C\|^2 \f$ with eigenvalues divided by the largest
  double commutativity = 1e-1;
  /// of \f$ \sum_i \|C \Gamma_i^X - \Gamma_i^Y C\|^2 \f$ with the multiplication by the i-th
  /// descriptor as operator (Nogneng and Ovsjanikov 2017), on average over the descriptors
  double multiplication = 1e-1;
  /// of \f$ \sum_i \|C \Omega_i^X - \Omega_i^Y C\|^2 \f$, see `orientation_operator()`, on average
  /// over the descriptors
  double orientation = 1e-1;
};

/// a mesh of unit area as functional maps see it.
struct Spectral_shape
{
  Eigen::MatrixXi T;   ///< triangles, m x 3
  Laplace_operator op; ///< at unit area
  Eigenpairs pairs;    ///< at unit area
};

/*!
returns the functional map \f$ C_{X,Y} \f$ between the first modes of two shapes that best keeps
pairs of descriptors \f$ f_i, g_i \f$ with coefficients \f$ a_i, b_i \f$ in the two bases: the
minimiser of
\f[ \frac1d \sum_i \frac{2 \|C a_i - b_i\|^2}{\|a_i\|^2 + \|b_i\|^2} + w_L \|C \Lambda_X - \Lambda_Y
C\|^2
    + \frac{w_M}{d} \sum_i \|C \Gamma_i^X - \Gamma_i^Y C\|^2 + \frac{w_O}{d} \sum_i \|C \Omega_i^X -
\Omega_i^Y C\|^2 \f]
(Ovsjanikov et al. 2012; Nogneng and Ovsjanikov 2017; Ren et al. 2018), a
linear system of the size of C. Pairs of operators are scaled to the norm \f$ \sqrt k \f$.

@param X, Y source and target, at unit area
@param f, g descriptors, n_X x d and n_Y x d, column i of both being the same function of the
surface. Times and energies must be the same for both shapes. Their scale does not matter
@param k number of modes; time grows with \f$ k^6 \f$: 20 to 30 are usual
@param weights of the terms; without multiplication and orientation the rows of C are independent,
and few descriptors leave it underdetermined: commutativity then decides
@return k x k

Throws `std::invalid_argument` if sizes do not match, `std::runtime_error` if the system is singular
up to rounding.
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::MatrixXd
functional_map_of_descriptors(const Spectral_shape& X, const Spectral_shape& Y,
                              const Eigen::MatrixXd& f, const Eigen::MatrixXd& g, Eigen::Index k,
                              const Functional_map_weights& weights = {});

/*!
returns the orthogonal matrix nearest to a functional map in the Frobenius norm, \f$ U V^\top \f$ of
\f$ C = U S V^\top \f$ (orthogonal Procrustes): an area-preserving map between surfaces has an
orthogonal one (Ovsjanikov et al. 2012).

@param C square

Throws `std::invalid_argument` if it is not.
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::MatrixXd nearest_orthogonal_map(const Eigen::MatrixXd& C);

/*!
refines a functional map by spectral up-sampling: ZoomOut (Melzi, Ren, Rodola, Sharma, Wonka and
Ovsjanikov 2019). The functional map of k modes gives a map of points, which gives a functional map
of k + `step` modes, and so on until `last` modes.

Points are taken from the faces of X, not only from its vertices, see `target_to_source_points()`:
on coarse meshes the rounding to vertices would be the largest error.

@param C \f$ C_{X,Y} \f$ to start from, k x k
@param X, Y source and target
@param last number of modes to end with, at least k, at most what both shapes have
@param step at least 1
@param control of the searches
@return \f$ C_{X,Y} \f$, `last` x `last`. It comes from a map of points, even if k is `last` already
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::MatrixXd zoom_out(Eigen::MatrixXd C, const Spectral_shape& X,
                                                      const Spectral_shape& Y, Eigen::Index last,
                                                      Eigen::Index step = 1,
                                                      const Run_control& control = {});

/*!
returns the scores \f$ K_Y B_Y \Pi K_X = \Psi e^{-t \Lambda_Y} C e^{-t \Lambda_X} \Phi^\top \f$ of
the Product Manifold Filter with heat kernels (Vestner et al. 2017): entry (y, x) says how much of
the neighbourhood of y the map that C stands for puts near x. One iteration of the filter is the
permutation of largest total score, and the `C` of that permutation the next map.

@param C \f$ C_{X,Y} \f$ of the present map
@param X, Y source and target
@param time \f$ t \f$ at unit area, at least 0: the width of the kernels is about \f$ \sqrt{2 t} \f$
@return n_Y x n_X
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::MatrixXd product_manifold_scores(const Eigen::MatrixXd& C,
                                                                     const Spectral_shape& X,
                                                                     const Spectral_shape& Y,
                                                                     double time);

/// @}

} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_TOOLBOX_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_TOOLBOX)

#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_toolbox/vertex_maps.h>

#include <Eigen/Cholesky>
#include <Eigen/SVD>

namespace CGAL::Spectral_geometry {

Eigen::MatrixXd orientation_operator(const Eigen::MatrixXi& T, const Eigen::MatrixXd& vectors,
                                     const Eigen::VectorXd& f)
{
  internal::check_dimension("the number of values of f", f.size(), vectors.rows());
  // A face gives each of its corners the same: sum the rows of the corners first.
  const Eigen::Index k = vectors.cols();
  Eigen::MatrixXd sums(T.rows(), k), jacobians(T.rows(), k);
  for(Eigen::Index t = 0; t < T.rows(); ++t) {
    const auto g1 = vectors.row(T(t, 0)), g2 = vectors.row(T(t, 1)), g3 = vectors.row(T(t, 2));
    const double f1 = f(T(t, 0)), f2 = f(T(t, 1)), f3 = f(T(t, 2));
    sums.row(t) = g1 + g2 + g3;
    jacobians.row(t) = ((f2 - f1) * (g3 - g1) - (f3 - f1) * (g2 - g1)) / 6;
  }
  return sums.transpose() * jacobians;
}

namespace internal {

inline void check_modes(const Spectral_shape& shape, Eigen::Index modes, const char* which)
{
  require(modes >= 2 && modes <= shape.pairs.size(), "functional map: ", modes, " modes of the ",
          which, " are asked for, there are ", shape.pairs.size(), ", take at least 2 of them.");
  check_dimension("the number of rows of the eigenvectors", shape.pairs.vectors.rows(),
                  shape.op.B.rows());
}

} // namespace internal

Eigen::MatrixXd functional_map_of_descriptors(const Spectral_shape& X, const Spectral_shape& Y,
                                              const Eigen::MatrixXd& f, const Eigen::MatrixXd& g,
                                              Eigen::Index k, const Functional_map_weights& weights)
{
  internal::check_modes(X, k, "source");
  internal::check_modes(Y, k, "target");
  internal::check_dimension("the number of rows of the source descriptors", f.rows(),
                            X.op.B.rows());
  internal::check_dimension("the number of rows of the target descriptors", g.rows(),
                            Y.op.B.rows());
  internal::check_dimension("the number of target descriptors", g.cols(), f.cols());
  const double d = static_cast<double>(f.cols());
  const Eigen::MatrixXd phi = X.pairs.vectors.leftCols(k), psi = Y.pairs.vectors.leftCols(k);
  Eigen::MatrixXd a = phi.transpose() * (X.op.B * f), b = psi.transpose() * (Y.op.B * g);

  // Terms || C A - B C ||^2 as a quadratic form in vec(C): vec(C A - B C) = (A^T (x) I - I (x) B)
  // vec(C), and its square has four blocks, of which only the mixed ones fill. The others are the
  // same in all blocks: they are summed apart.
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(k * k, k * k), left = Eigen::MatrixXd::Zero(k, k),
                  right = left;
  const auto add = [&](const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double weight) {
    right += weight * (A * A.transpose());
    left += weight * (B.transpose() * B);
    for(Eigen::Index j = 0; j < k; ++j)
      for(Eigen::Index l = 0; l < k; ++l)
        form.block(j * k, l * k, k, k) -= weight * (A(j, l) * B + A(l, j) * B.transpose());
  };
  const double largest = (std::max)(X.pairs.values(k - 1), Y.pairs.values(k - 1));
  add(Eigen::MatrixXd((X.pairs.values.head(k) / largest).asDiagonal()),
      Eigen::MatrixXd((Y.pairs.values.head(k) / largest).asDiagonal()), weights.commutativity);
  const auto add_scaled = [&](Eigen::MatrixXd A, Eigen::MatrixXd B, double weight) {
    const double scale = std::hypot(A.norm(), B.norm()) / std::sqrt(2. * static_cast<double>(k));
    if(scale > 0)
      add(A / scale, B / scale, weight / d);
  };
  for(Eigen::Index i = 0; i < f.cols(); ++i) {
    const Eigen::VectorXd fi = f.col(i), gi = g.col(i);
    if(weights.multiplication > 0)
      add_scaled(phi.transpose() * (X.op.B * Eigen::MatrixXd(fi.asDiagonal() * phi)),
                 psi.transpose() * (Y.op.B * Eigen::MatrixXd(gi.asDiagonal() * psi)),
                 weights.multiplication);
    if(weights.orientation > 0)
      add_scaled(orientation_operator(X.T, phi, fi), orientation_operator(Y.T, psi, gi),
                 weights.orientation);
    const double scale = std::hypot(a.col(i).norm(), b.col(i).norm()) * std::sqrt(d / 2);
    if(scale > 0) {
      a.col(i) /= scale;
      b.col(i) /= scale;
    }
  }
  const Eigen::MatrixXd aa = a * a.transpose(), ba = b * a.transpose();
  for(Eigen::Index j = 0; j < k; ++j) {
    form.block(j * k, j * k, k, k) += left;
    for(Eigen::Index l = 0; l < k; ++l) {
      auto diagonal = form.block(j * k, l * k, k, k).diagonal();
      diagonal.array() += right(j, l);
      diagonal.array() += aa(j, l);
    }
  }
  // Positive semidefinite. The solver replaces the inverses of vanishing pivots by zero and reports
  // success.
  const Eigen::LDLT<Eigen::MatrixXd> solver(form);
  const Eigen::VectorXd pivots = solver.vectorD();
  const double rounding =
      std::numeric_limits<double>::epsilon() * static_cast<double>(pivots.size());
  if(solver.info() != Eigen::Success || !(pivots.minCoeff() > rounding * pivots.maxCoeff()))
    throw std::runtime_error(
        "functional map: the descriptors do not determine it, pass more of them.");
  const Eigen::VectorXd c = solver.solve(Eigen::Map<const Eigen::VectorXd>(ba.data(), ba.size()));
  return Eigen::Map<const Eigen::MatrixXd>(c.data(), k, k);
}

Eigen::MatrixXd nearest_orthogonal_map(const Eigen::MatrixXd& C)
{
  internal::check_dimension("the number of columns of a map that is to be orthogonal", C.cols(),
                            C.rows());
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(C, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Eigen::MatrixXd zoom_out(Eigen::MatrixXd C, const Spectral_shape& X, const Spectral_shape& Y,
                         Eigen::Index last, Eigen::Index step, const Run_control& control)
{
  internal::check_modes(X, last, "source");
  internal::check_modes(Y, last, "target");
  internal::require(C.rows() <= last && C.cols() <= last && step >= 1, "zoom_out: the map is ",
                    internal::size_name(C), " and the step ", step, ", start from at most ", last,
                    " modes with a positive step.");
  Eigen::Index k = (std::max)(C.rows(), C.cols());
  do {
    const Eigen::SparseMatrix<double> points =
        target_to_source_points(C, X.pairs.vectors, X.T, Y.pairs.vectors, control);
    k += (std::min)(step, last - k);
    C = functional_map(Y.pairs.vectors.leftCols(k), Y.op.B, points, X.pairs.vectors.leftCols(k));
  } while(k < last);
  return C;
}

Eigen::MatrixXd product_manifold_scores(const Eigen::MatrixXd& C, const Spectral_shape& X,
                                        const Spectral_shape& Y, double time)
{
  internal::require(time >= 0 && std::isfinite(time), "product manifold filter: the time ", time,
                    " is negative or not finite, pass a time of heat of at least 0.");
  internal::check_modes(X, C.cols(), "source");
  internal::check_modes(Y, C.rows(), "target");
  const Eigen::VectorXd left = (-time * Y.pairs.values.head(C.rows()).array()).exp();
  const Eigen::VectorXd right = (-time * X.pairs.values.head(C.cols()).array()).exp();
  const Eigen::MatrixXd damped = left.asDiagonal() * C * right.asDiagonal();
  return Y.pairs.vectors.leftCols(C.rows()) *
         (damped * X.pairs.vectors.leftCols(C.cols()).transpose());
}

} // namespace CGAL::Spectral_geometry

#endif // definitions

#endif // CGAL_SPECTRAL_TOOLBOX_FUNCTIONAL_MAP_ESTIMATION_H
