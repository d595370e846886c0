// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_RELOCATION_ENERGY_H
#define CGAL_SPECTRAL_GEOMETRY_RELOCATION_ENERGY_H

#include <CGAL/Spectral_geometry/internal/operators/Operator_geometry.h>

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/*!
The metric as a function of the positions of a coarse mesh whose triangles and restricted signals stay as
they are,
\f[ E(V) = \sum_w \| (B(V) Z)_w - (L(V) F)_w \|^2 / M_w(V), \f]
(Eq. 2 of Lescoat et al. 2020 in the weak form for any mass, decomposed by vertex), with its gradient.

The rows of the residual are combinations of few rows of F and Z,
\f[ R_w = \sum_j B_{wj} Z_j - \sum_j L_{wj} (F_j - F_w), \f]
j over w and its neighbours, so that \f$ \|R_w\|^2 \f$ is a quadratic form in 2 d + 1 coefficients, d the
degree of w, whose matrix of inner products does not depend on V. It is computed once. After that a value
or a gradient costs \f$ O(\sum_w d_w \min(d_w, K)) \f$: rows of more than K terms stay as they are. The
differences F_j - F_w keep the small residual of smooth signals from being lost in the rounding of large inner products.

The gradient is exact: derivatives with respect to the entries of B, L and M are gathered for each triangle into
derivatives with respect to its three cotangents and its area, and go on from there to its corners.

E does not see the side of a surface on which a vertex lies: it is a function of lengths, and knows nothing of
inversions. Whoever moves vertices has to guard them, see `relocate_positions()`.
*/
class Relocation_energy
{
public:
  using Index = Eigen::Index; ///< of vertices
  /// n x 3, one position in each row
  using Positions = internal::Operator_geometry::Positions;

  /*!
  @param T      m x 3, the triangles of the coarse mesh, an oriented manifold
  @param F      n x K, the restricted signals P F, one row for each coarse vertex
  @param Z      n x K, the restricted Laplacian of the signals, P B^-1 L F; for eigenvectors P Phi Lambda
  @param op     the operator, with coefficients for the n vertices or none; or the weight theta of the consistent mass

  Throws `std::invalid_argument` if the sizes do not match, an index is out of range or the operator is.
  */
  Relocation_energy(const Eigen::MatrixXi& T, const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z,
                    const Local_operator& op)
    : m_geometry(T, F.rows(), op)
    , m_E(Eigen::VectorXd::Zero(F.rows()))
  {
    if(Z.rows() != F.rows() || Z.cols() != F.cols())
      throw std::invalid_argument("relocation: F is " + std::to_string(F.rows()) + " x " +
                                  std::to_string(F.cols()) + " and Z " + std::to_string(Z.rows()) + " x " +
                                  std::to_string(Z.cols()) + "; pass two matrices of one size.");
    make_products(F, Z);
  }

  /// n.
  Index number_of_vertices() const { return m_geometry.number_of_vertices(); }

  /// returns E(V), infinity if a triangle has no area.
  double value(const Positions& V)
  {
    return m_geometry.assemble(V, m_entries) ? sum_of_rows(nullptr) : std::numeric_limits<double>::infinity();
  }

  /// returns E(V) and writes its gradient, n x 3, which is 0 where E is infinite.
  double value_and_gradient(const Positions& V, Positions& gradient)
  {
    gradient.setZero(number_of_vertices(), 3);
    if(!m_geometry.assemble(V, m_entries))
      return std::numeric_limits<double>::infinity();
    internal::Operator_geometry::Entries derivatives = m_geometry.zero_entries();
    const double E = sum_of_rows(&derivatives);
    m_geometry.add_gradient(derivatives, V, gradient);
    return E;
  }

  /// E_w of each vertex where the last value was taken.
  const Eigen::VectorXd& values_by_vertex() const { return m_E; }

private:
  // Of Z_w, Z_j and F_j - F_w, j over the neighbours, the inner products, or where there are more of them than signals the rows.
  void make_products(const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z)
  {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> panel;
    m_products.resize(std::size_t(F.rows()));
    for(Index w = 0; w < F.rows(); ++w) {
      const auto& row = m_geometry.row(w);
      const Index d = Index(row.size());
      panel.resize(2 * d + 1, F.cols());
      panel.row(0) = Z.row(w);
      for(Index i = 0; i < d; ++i) {
        const int j = row[std::size_t(i)].neighbour;
        panel.row(1 + i) = Z.row(j);
        panel.row(1 + d + i) = F.row(j) - F.row(w);
      }
      if(2 * d + 1 > F.cols())
        m_products[std::size_t(w)] = panel;
      else
        m_products[std::size_t(w)].noalias() = panel * panel.transpose();
    }
  }

  double sum_of_rows(internal::Operator_geometry::Entries* derivatives)
  {
    for(Index w = 0; w < number_of_vertices(); ++w) {
      const auto& row = m_geometry.row(w);
      m_E(w) = 0;
      if(row.empty() || m_geometry.vanishes_at(w))
        continue;
      const Index d = Index(row.size());
      m_coefficients.resize(2 * d + 1);
      m_coefficients(0) = m_entries.B_diagonal(w);
      for(Index i = 0; i < d; ++i) {
        m_coefficients(1 + i) = m_entries.B(row[std::size_t(i)].edge);
        m_coefficients(1 + d + i) = -m_entries.L(row[std::size_t(i)].edge);
      }
      const Eigen::MatrixXd& products = m_products[std::size_t(w)];
      if(products.cols() == products.rows())
        m_image.noalias() = products * m_coefficients;
      else {
        m_row.noalias() = products.transpose() * m_coefficients;
        m_image.noalias() = products * m_row;
      }
      const double mass = m_entries.mass(w);
      m_E(w) = m_coefficients.dot(m_image) / mass;
      if(derivatives == nullptr)
        continue;
      m_image *= 2 / mass;
      derivatives->mass(w) = -m_E(w) / mass;
      derivatives->B_diagonal(w) = m_image(0);
      for(Index i = 0; i < d; ++i) {
        derivatives->B(row[std::size_t(i)].edge) += m_image(1 + i);
        derivatives->L(row[std::size_t(i)].edge) -= m_image(1 + d + i);
      }
    }
    return m_E.sum();
  }

  internal::Operator_geometry m_geometry;
  internal::Operator_geometry::Entries m_entries;
  std::vector<Eigen::MatrixXd> m_products;
  Eigen::VectorXd m_E, m_coefficients, m_image, m_row;
};

/// @}

} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_RELOCATION_ENERGY_H
