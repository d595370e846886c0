// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_ELASTIC_SURFACE_H
#define SPECTRAL_EXAMPLES_MATCHING_ELASTIC_SURFACE_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

// A triangle mesh that is as rigid as possible (Sorkine and Alexa 2007), drawn by springs of any
// stiffness matrix. CGAL's Surface_mesh_deformation has fixed vertices only.
class Elastic_surface
{
public:
  explicit Elastic_surface(CGAL::Spectral_geometry::Mesh_matrices rest)
    : m_rest(std::move(rest))
    , m_rotations(static_cast<std::size_t>(m_rest.V.rows()), Eigen::Matrix3d::Identity())
    , m_weights(m_rest.V.rows(), m_rest.V.rows())
  {
    // Cotangents, made positive: of bad triangles they make a surface that does not hold its shape.
    constexpr double least = 0.02, largest = 5;
    std::vector<Eigen::Triplet<double>> entries;
    for(Eigen::Index t = 0; t < m_rest.T.rows(); ++t)
      for(int k = 0; k < 3; ++k) {
        const int o = m_rest.T(t, k), i = m_rest.T(t, (k + 1) % 3), j = m_rest.T(t, (k + 2) % 3);
        const Eigen::Vector3d a = m_rest.V.row(i) - m_rest.V.row(o),
                              b = m_rest.V.row(j) - m_rest.V.row(o);
        const double sine = a.cross(b).norm(), cotangent = sine > 0 ? 0.5 * a.dot(b) / sine : 0.;
        entries.emplace_back(i, j, cotangent);
        entries.emplace_back(j, i, cotangent);
      }
    m_weights.setFromTriplets(entries.begin(), entries.end());
    for(Eigen::Index k = 0; k < m_weights.nonZeros(); ++k)
      m_weights.valuePtr()[k] = (std::min)((std::max)(m_weights.valuePtr()[k], least), largest);
  }

  const CGAL::Spectral_geometry::Mesh_matrices& rest() const { return m_rest; }
  const std::vector<Eigen::Matrix3d>& rotations() const { return m_rotations; }

  // Takes targets, one column per vertex, to the smooth points near to them: solves (A + L) P = A
  // targets with A of these weights.
  auto smoothing(const Eigen::VectorXd& weights) const
  {
    const Eigen::VectorXd sums = m_weights * Eigen::VectorXd::Ones(m_weights.cols());
    const Eigen::SparseMatrix<double> diagonal((sums + weights).asDiagonal());
    const auto solver =
        std::make_shared<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>(diagonal - m_weights);
    return [solver, weights](const Eigen::MatrixXd& targets) {
      const Eigen::MatrixXd right = weights.asDiagonal() * targets.transpose();
      return Eigen::MatrixXd(Eigen::MatrixXd(solver->solve(right)).transpose());
    };
  }

  // The rotation of each vertex that takes its edges at rest nearest to those of P, one column per
  // vertex, and with `likeness` also to where the last rotations of its neighbours take them (Levi
  // and Gotsman 2015): shells then resist twists.
  void fit_rotations(const Eigen::MatrixXd& P, double likeness = 0)
  {
    for(Eigen::Index i = 0; i < P.cols(); ++i) {
      Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
      for(Eigen::SparseMatrix<double>::InnerIterator it(m_weights, i); it; ++it) {
        const Eigen::RowVector3d edge = m_rest.V.row(i) - m_rest.V.row(it.row());
        S += it.value() * (P.col(i) - P.col(it.row())) * edge;
        S += likeness * it.value() * edge.squaredNorm() *
             m_rotations[static_cast<std::size_t>(it.row())];
      }
      const Eigen::JacobiSVD<Eigen::Matrix3d> svd(S, Eigen::ComputeFullU | Eigen::ComputeFullV);
      Eigen::Matrix3d U = svd.matrixU();
      if((U * svd.matrixV().transpose()).determinant() < 0)
        U.col(2) *= -1;
      m_rotations[static_cast<std::size_t>(i)] = U * svd.matrixV().transpose();
    }
  }

  // The points, one column each, of least energy for these rotations and the springs p_i^T D_i p_i
  // - 2 p_i^T f_i, of which all D_i must be positive definite.
  Eigen::MatrixXd solve(const std::vector<Eigen::Matrix3d>& D, const Eigen::MatrixXd& f)
  {
    const Eigen::Index n = m_rest.V.rows();
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd right = f;
    for(Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Matrix3d& R = m_rotations[static_cast<std::size_t>(i)];
      double sum = 0;
      for(Eigen::SparseMatrix<double>::InnerIterator it(m_weights, i); it; ++it) {
        const Eigen::Vector3d edge = m_rest.V.row(i) - m_rest.V.row(it.row());
        right.col(i) +=
            it.value() * 0.5 * ((R + m_rotations[static_cast<std::size_t>(it.row())]) * edge);
        sum += it.value();
        for(int k = 0; k < 3; ++k)
          entries.emplace_back(static_cast<int>(3 * i) + k, static_cast<int>(3 * it.row()) + k,
                               -it.value());
      }
      for(int k = 0; k < 3; ++k)
        for(int l = 0; l < 3; ++l)
          entries.emplace_back(static_cast<int>(3 * i) + k, static_cast<int>(3 * i) + l,
                               D[static_cast<std::size_t>(i)](k, l) + (k == l ? sum : 0.));
    }
    Eigen::SparseMatrix<double> A(3 * n, 3 * n);
    A.setFromTriplets(entries.begin(), entries.end());
    if(m_solver.rows() == 0)
      m_solver.analyzePattern(A);
    m_solver.factorize(A);
    const Eigen::VectorXd p =
        m_solver.solve(Eigen::Map<const Eigen::VectorXd>(right.data(), right.size()));
    if(m_solver.info() != Eigen::Success || !p.allFinite())
      throw std::runtime_error(
          "a mesh cannot be bent, its coordinates span too many magnitudes: repair it.");
    return Eigen::Map<const Eigen::MatrixXd>(p.data(), 3, n);
  }

private:
  CGAL::Spectral_geometry::Mesh_matrices m_rest;
  std::vector<Eigen::Matrix3d> m_rotations;
  Eigen::SparseMatrix<double> m_weights;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> m_solver;
};

#endif // SPECTRAL_EXAMPLES_MATCHING_ELASTIC_SURFACE_H
