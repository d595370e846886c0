// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_LOW_MODE_TERM_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_LOW_MODE_TERM_H

#include <CGAL/Spectral_geometry/internal/surface/Operator_geometry.h>

#include <Eigen/Eigenvalues>

namespace CGAL::Spectral_geometry::internal {

/*!
Keeps low coarse eigenvectors from rotating into each other.

They may be rotated although their eigenvalues are right. Biharmonic and diffusion distances show
this at once. U holds the coarse eigenvectors of the first m modes with a goal, and of
eight more. \f$ Y = U C (C^T C)^{-1/2} \f$ with \f$ C = U^T \widetilde B P \Phi \f$ are the
orthonormal functions in the span of U that are nearest to the m fine eigenvectors. If nothing is
rotated, the coarse operator is diagonal in Y. The term is the mean square of what is beside the
diagonal, \f[ \frac{1}{\epsilon^2} \sum_{j \ne k} w_{jk} h_{jk}^2 \Big/ \sum_{j \ne k} w_{jk},
\qquad h_{jk} = \frac{Y_j^T \widetilde L Y_k}{\sqrt{\lambda_j \lambda_k}}, \qquad w_{jk} =
\frac{\lambda_2^2}{\lambda_j \lambda_k}, \f] all at unit area, with the epsilon of `Spectrum_term`.
It divides by no difference of eigenvalues: modes of one eigenvalue may rotate as they like, which
no distance sees. Where the second eigenvalue is far below the others, beyond a thin neck, the pairs
with it have nearly all of the weight.

Between two calls of `refresh()` Y stays. To first order in the movement the changes of L and of B
would rotate it. So \f$ \lambda_{jk} Y_j^T \widetilde B Y_k \f$ is subtracted from the product in h,
with the mean of both Rayleigh quotients. The movement of P Phi is seen at the next call.
*/
class Low_mode_term
{
public:
  using Index = Eigen::Index;
  using Row = Eigen::Array<double, 1, Eigen::Dynamic>;

  /// At most so many modes are followed. With six modes errors of biharmonic distances are 1.16
  /// times as large, with twenty they are the same.
  static constexpr Index largest_number = 12;
  /// Coarse modes beyond these among which their directions are sought.
  static constexpr Index spare = 8;

  /// `U`: coarse eigenvectors; `fine`: the fine ones at the coarse vertices, no more of them;
  /// `goals`: their eigenvalues at unit area, positive.
  void refresh(const Laplace_operator& op, const Eigen::MatrixXd& U, const Eigen::MatrixXd& fine,
               const Row& goals)
  {
    const Eigen::MatrixXd C = U.transpose() * (op.B * fine);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> squares(C.transpose() * C);
    m_Y.resize(0, 0);
    // A fine mode that lies outside of U has no nearest one there: then there is no term at all.
    if(!(squares.eigenvalues()(0) > 1e-3 * squares.eigenvalues().maxCoeff()))
      return;
    m_Y = U * (C * squares.operatorInverseSqrt());
    const Eigen::RowVectorXd quotients = (m_Y.transpose() * (op.L * m_Y)).diagonal();
    const Index m = m_Y.cols();
    m_quotients = (quotients.replicate(m, 1) + quotients.transpose().replicate(1, m)) / 2;
    const Eigen::VectorXd root = goals.head(m).sqrt().inverse();
    m_scale = root * root.transpose();
    m_weights = m_scale.cwiseAbs2();
    m_weights.diagonal().setZero();
    m_weights /= m_weights.sum();
  }

  /// The value where the entries of the operator are these, times `weight`; adds its derivatives.
  double penalty(const Operator_geometry& geometry, const Operator_geometry::Entries& entries,
                 const double weight, Operator_geometry::Entries& d) const
  {
    if(m_Y.cols() < 2)
      return 0;
    const auto& edges = geometry.edges();
    Eigen::MatrixXd LY = Eigen::MatrixXd::Zero(m_Y.rows(), m_Y.cols()),
                    BY = entries.B_diagonal.asDiagonal() * m_Y;
    for(std::size_t e = 0; e < edges.size(); ++e) {
      const auto [i, j] = edges[e];
      const Eigen::RowVectorXd difference = entries.L(Index(e)) * (m_Y.row(j) - m_Y.row(i));
      LY.row(i) += difference;
      LY.row(j) -= difference;
      BY.row(i) += entries.B(Index(e)) * m_Y.row(j);
      BY.row(j) += entries.B(Index(e)) * m_Y.row(i);
    }
    const double area = entries.mass.sum();
    const Eigen::MatrixXd h =
        area * (m_Y.transpose() * LY - m_quotients.cwiseProduct(m_Y.transpose() * BY))
                   .cwiseProduct(m_scale);
    const Eigen::MatrixXd slope = 2 * weight * m_weights.cwiseProduct(h);
    const double value = slope.cwiseProduct(h).sum() / 2;
    d.mass.array() += 2 * value / area;
    const Eigen::MatrixXd by_L = area * slope.cwiseProduct(m_scale),
                          by_B = -by_L.cwiseProduct(m_quotients);
    const Eigen::MatrixXd YL = m_Y * by_L, YB = m_Y * by_B;
    d.B_diagonal += m_Y.cwiseProduct(YB).rowwise().sum();
    for(std::size_t e = 0; e < edges.size(); ++e) {
      const auto [i, j] = edges[e];
      d.L(Index(e)) -= (m_Y.row(i) - m_Y.row(j)).dot(YL.row(i) - YL.row(j));
      d.B(Index(e)) += 2 * m_Y.row(i).dot(YB.row(j));
    }
    return value;
  }

private:
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> m_Y;
  Eigen::MatrixXd m_quotients, m_scale, m_weights;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_LOW_MODE_TERM_H
