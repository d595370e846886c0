// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_INTERNAL_FUNCTIONAL_MAP_ESTIMATION_IMPL_H
#define CGAL_SPECTRAL_TOOLBOX_INTERNAL_FUNCTIONAL_MAP_ESTIMATION_IMPL_H

#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_toolbox/functional_map_estimation.h>
#include <CGAL/Spectral_geometry/internal/require.h>
#include <CGAL/Spectral_toolbox/vertex_maps.h>

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace CGAL::Spectral_geometry {

CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::MatrixXd orientation_operator(const Eigen::MatrixXi& T,
                                                                  const Eigen::MatrixXd& vectors,
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

CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::MatrixXd
functional_map_of_descriptors(const Spectral_shape& X, const Spectral_shape& Y,
                              const Eigen::MatrixXd& f, const Eigen::MatrixXd& g, Eigen::Index k,
                              const Functional_map_weights& weights)
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
  }

  for(Eigen::Index i = 0; i < f.cols(); ++i) {
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

CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::MatrixXd nearest_orthogonal_map(const Eigen::MatrixXd& C)
{
  internal::check_dimension("the number of columns of a map that is to be orthogonal", C.cols(),
                            C.rows());
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(C, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return svd.matrixU() * svd.matrixV().transpose();
}

CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::MatrixXd zoom_out(Eigen::MatrixXd C, const Spectral_shape& X,
                                                      const Spectral_shape& Y, Eigen::Index last,
                                                      Eigen::Index step, int threads)
{
  internal::check_modes(X, last, "source");
  internal::check_modes(Y, last, "target");
  internal::require(C.rows() <= last && C.cols() <= last && step >= 1, "zoom_out: the map is ",
                    internal::size_name(C), " and the step ", step, ", start from at most ", last,
                    " modes with a positive step.");
  Eigen::Index k = (std::max)(C.rows(), C.cols());
  do {
    const Eigen::SparseMatrix<double> points =
        target_to_source_points(C, X.pairs.vectors, X.T, Y.pairs.vectors, threads);
    k = (std::min)(k + step, last);
    C = functional_map(Y.pairs.vectors.leftCols(k), Y.op.B, points, X.pairs.vectors.leftCols(k));
  } while(k < last);
  return C;
}

CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::MatrixXd product_manifold_scores(const Eigen::MatrixXd& C,
                                                                     const Spectral_shape& X,
                                                                     const Spectral_shape& Y,
                                                                     double time)
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

#endif // CGAL_SPECTRAL_TOOLBOX_INTERNAL_FUNCTIONAL_MAP_ESTIMATION_IMPL_H
