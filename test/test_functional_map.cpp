// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/functional_map.h>

#include "catch.h"
#include "shapes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace test_functional_map {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using SG::Eigenpairs;
using SG::Laplace_operator;
using Sparse = Eigen::SparseMatrix<double>;

namespace {

constexpr double thetas[] = {0., 0.5};

Laplace_operator laplace(const shapes::Matrices& mesh, double theta = 0.)
{
  return SG::laplace_operator(mesh.V, mesh.T, theta);
}

// The coarse vertices are the first of the fine ones.
Sparse injection(Index coarse, Index fine)
{
  Sparse P(coarse, fine);
  for(Index i = 0; i < coarse; ++i)
    P.insert(i, i) = 1.;
  return P;
}

} // namespace

TEST_CASE("identity has the identity as functional map and both norms zero")
{
  for(const double theta : thetas) {
    const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(3), theta);
    const Eigenpairs pairs = SG::eigenpairs(op, 45);
    const SG::Spectral_evaluation e =
        SG::evaluate_spectrum(op, pairs, op, pairs, injection(642, 642), 30);
    CHECK(e.C.isIdentity(1e-10));
    CHECK(e.norm_L < 1e-7);
    CHECK(e.norm_D < 1e-10);
    CHECK(e.norm_D_extended < 1e-10);
    CHECK(e.errors.modes == 29); // the zero is skipped
    CHECK(e.errors.max < 1e-12);
    CHECK(e.errors_beyond.modes == 15);
    CHECK(e.extended_modes == 33);
    CHECK(e.area_ratio == 1.);
    CHECK(e.mass == (theta == 0. ? "lumped" : "averaged"));
  }
}

TEST_CASE("a permutation of the vertices loses nothing")
{
  const shapes::Matrices fine = shapes::bumpy_icosphere_matrices(2);
  const Index n = fine.V.rows();
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index(0));
  std::shuffle(order.begin(), order.end(), std::mt19937(2));
  shapes::Matrices coarse = fine;
  for(Index i = 0; i < n; ++i)
    coarse.V.row(order[i]) = fine.V.row(i);
  coarse.T = fine.T.unaryExpr([&](int v) { return static_cast<int>(order[v]); });
  Sparse P(n, n);
  for(Index i = 0; i < n; ++i)
    P.insert(order[i], i) = 1.;
  for(const double theta : thetas) {
    const Laplace_operator A = laplace(fine, theta), B = laplace(coarse, theta);
    const SG::Spectral_evaluation e =
        SG::evaluate_spectrum(A, SG::eigenpairs(A, 25), B, SG::eigenpairs(B, 25), P, 25);
    CHECK(e.C.cwiseAbs().isIdentity(
        1e-8)); // signs of eigenvectors depend on the order of the vertices
    CHECK(e.norm_L < 1e-7);
    CHECK(e.norm_D < 1e-9);
  }
}

TEST_CASE("functional map between two tessellations of a sphere is block-diagonal")
{
  const shapes::Matrices fine = shapes::icosphere_matrices(4);
  shapes::Matrices coarse = shapes::icosphere_matrices(3);
  coarse.V *= Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Sparse P = SG::closest_point_interpolation(coarse.V, fine);
  const Laplace_operator A = laplace(fine, 0.5), B = laplace(coarse, 0.5);
  const SG::Spectral_evaluation e =
      SG::evaluate_spectrum(A, SG::eigenpairs(A, 25), B, SG::eigenpairs(B, 25), P, 25);
  for(Index l = 0; l < 5; ++l) {
    const Index first = l * l, size = 2 * l + 1;
    const MatrixXd block = e.C.block(first, first, size, size);
    CHECK((block.transpose() * block).isIdentity(0.05));
    MatrixXd off = e.C.middleCols(first, size);
    off.middleRows(first, size).setZero();
    CHECK(off.cwiseAbs().maxCoeff() < 0.01);
  }
  CHECK(e.errors.max < 0.005);
  // Five exact multiplicities, but nothing like a diagonal: the map is as good as the identity for
  // both norms.
  CHECK(e.norm_L < 3.);
  CHECK(e.norm_D < 0.2);
  CHECK((e.C - MatrixXd::Identity(25, 25)).norm() > 1.);
}

TEST_CASE("norms at unit area do not depend on scale, and equal those of meshes that were scaled")
{
  const shapes::Matrices fine = shapes::bumpy_icosphere_matrices(3),
                         coarse = shapes::bumpy_icosphere_matrices(2);
  const Index K = 20, N = coarse.V.rows();
  const Sparse P = injection(N, fine.V.rows());
  const auto evaluate = [&](double fine_scale, double coarse_scale) {
    shapes::Matrices f = fine, c = coarse;
    f.V *= fine_scale;
    c.V *= coarse_scale;
    const Laplace_operator A = laplace(f), B = laplace(c);
    return SG::evaluate_spectrum(A, SG::eigenpairs(A, 30), B, SG::eigenpairs(B, 30), P, K);
  };
  const SG::Spectral_evaluation e = evaluate(1., 1.);
  CHECK(e.norm_L > 1.);
  const double unit_fine = 1. / std::sqrt(e.fine_area), unit_coarse = 1. / std::sqrt(e.coarse_area);
  const SG::Spectral_evaluation scaled = evaluate(100., 100.), shrunk = evaluate(1., 0.9),
                                unit = evaluate(unit_fine, unit_coarse),
                                half = evaluate(unit_fine, unit_fine);
  for(const SG::Spectral_evaluation& s : {scaled, shrunk, unit}) {
    CHECK(s.norm_L == Approx(e.norm_L).epsilon(1e-8));
    CHECK(s.norm_D == Approx(e.norm_D).epsilon(1e-8));
    CHECK(s.norm_D_extended == Approx(e.norm_D_extended).epsilon(1e-8));
    CHECK(s.errors.mean == Approx(e.errors.mean).epsilon(1e-8));
    CHECK((s.C - e.C).norm() < 1e-8);
  }
  // at unit area there is nothing to scale
  CHECK(unit.norm_L_input_scale == Approx(e.norm_L).epsilon(1e-8));
  CHECK(unit.norm_D_input_scale == Approx(e.norm_D).epsilon(1e-8));
  CHECK(half.norm_L_input_scale == Approx(e.norm_L_common_scale).epsilon(1e-8));
  CHECK(scaled.norm_L_input_scale == Approx(1e-4 * e.norm_L_input_scale).epsilon(1e-8));
  CHECK(scaled.norm_L_common_scale == Approx(e.norm_L_common_scale).epsilon(1e-8));
  // unit area hides shrinking, the figures at input scale and the area ratio show it
  CHECK(shrunk.area_ratio == Approx(0.81 * e.area_ratio));
  CHECK(shrunk.errors_input_scale.mean > e.errors_input_scale.mean + 0.1);
  CHECK(shrunk.norm_L_common_scale > e.norm_L_common_scale + 1.);
}

TEST_CASE("the metric is the commutativity plus what leaves the truncated basis")
{
  const shapes::Matrices fine = shapes::bumpy_icosphere_matrices(3),
                         coarse = shapes::bumpy_icosphere_matrices(2);
  const Index K = 20, n = fine.V.rows(), N = coarse.V.rows();
  Sparse scattered(N, n); // any P will do, this one is awful
  for(Index i = 0; i < n; ++i)
    scattered.insert(i % N, i) = 1. / double((n - i % N + N - 1) / N);
  for(const Sparse& P : {injection(N, n), scattered})
    for(const double theta : thetas) {
      const Laplace_operator A = laplace(fine, theta), B = laplace(coarse, theta);
      const Eigenpairs f = SG::eigenpairs(A, K), c = SG::eigenpairs(B, N);
      const MatrixXd Z = f.vectors * f.values.asDiagonal();
      const double E = SG::restriction_energy(B, P, f.vectors, Z);
      const MatrixXd C = SG::functional_map(c.vectors, B.B, P, f.vectors);
      const MatrixXd commutator = C * f.values.asDiagonal() - c.values.asDiagonal() * C;
      const MatrixXd weak = B.B * (P * Z) - B.L * (P * f.vectors);
      const double E_B = (weak.array() * MatrixXd(B.B).llt().solve(weak).array()).sum();
      CHECK(commutator.squaredNorm() == Approx(E_B).epsilon(1e-7));
      const double norm_L =
          SG::laplacian_commutativity_norm(C.topRows(K), f.values, c.values.head(K));
      CHECK(norm_L * norm_L * C.topRows(K).squaredNorm() +
                commutator.bottomRows(N - K).squaredNorm() ==
            Approx(E_B).epsilon(1e-7));
      if(theta == 0.)
        CHECK(E == Approx(E_B).epsilon(1e-10));
      CHECK(E <= E_B * (1. + 1e-12));
      CHECK(E_B <= E / (1. - 0.75 * theta) * (1 + 1e-9));
      CHECK(norm_L <= std::sqrt(E / (1. - 0.75 * theta)) / C.topRows(K).norm());
    }
}

TEST_CASE("norms of a map of two modes by hand")
{
  MatrixXd C(3, 2);
  C << 1., 2., 0., 1., 2., 0.;
  const Eigen::Vector2d fine(0., 3.);
  const Vector3d coarse(0., 2., 4.);
  // C Lambda - Lambda~ C = [0 6; 0 1; -8 0], C^T C - Id = [4 2; 2 4]
  CHECK(SG::laplacian_commutativity_norm(C, fine, coarse) == Approx(std::sqrt(101. / 10.)));
  CHECK(SG::orthonormality_norm(C) == Approx(std::sqrt(40.)));
  CHECK(SG::unit_area_functional_map(C, 8., 2.) == MatrixXd(2. * C));
  CHECK_THROWS_AS(SG::laplacian_commutativity_norm(C, coarse, fine), std::invalid_argument);
  CHECK_THROWS_AS(SG::laplacian_commutativity_norm(0. * C, fine, coarse), std::invalid_argument);
  CHECK_THROWS_AS(SG::unit_area_functional_map(C, 0., 1.), std::invalid_argument);
}

TEST_CASE("relative errors skip the zeros and the modes that are not there")
{
  VectorXd fine(5), coarse(4);
  fine << 0., 1e-12, 2., 4., 8.;
  coarse << 1e-13, 0., 1.8, 5.;
  const Index zeros = 2;
  const SG::Eigenvalue_errors e = SG::eigenvalue_errors(fine, coarse, 0, 5, zeros);
  CHECK(e.modes == 2);
  CHECK(e.mean == Approx((0.1 + 0.25) / 2));
  CHECK(e.max == Approx(0.25));
  CHECK(SG::eigenvalue_errors(fine, coarse, 4, 7, zeros).modes == 0);
  CHECK(std::isnan(SG::eigenvalue_errors(fine, coarse, 4, 7, zeros).mean));
}

TEST_CASE("evaluation skips one zero for each component")
{
  const Laplace_operator op =
      laplace(shapes::components_matrices(shapes::bumpy_icosphere_matrices(2), 3));
  const Eigenpairs pairs = SG::eigenpairs(op, 20);
  const SG::Spectral_evaluation e =
      SG::evaluate_spectrum(op, pairs, op, pairs, injection(486, 486), 20);
  CHECK(e.fine_zeros == 3);
  CHECK(e.coarse_zeros == 3);
  CHECK(e.errors.modes == 17);
  CHECK(e.errors_beyond.modes == 0);
}

TEST_CASE("a coarse mesh with fewer vertices than K is judged with as many modes as it has")
{
  const Laplace_operator A = laplace(shapes::bumpy_icosphere_matrices(2));
  const Laplace_operator B = laplace(shapes::bumpy_icosphere_matrices(0));
  const Eigenpairs fine = SG::eigenpairs(A, 20);
  const SG::Spectral_evaluation e =
      SG::evaluate_spectrum(A, fine, B, SG::eigenpairs(B, 12), injection(12, 162), 20);
  CHECK(e.requested_modes == 20);
  CHECK(e.judged_modes == 12);
  CHECK(e.extended_modes == 12);
  CHECK(e.errors.modes == 11);
  CHECK(std::isfinite(e.norm_L));
  CHECK_THROWS_WITH(
      SG::evaluate_spectrum(A, fine, B, SG::eigenpairs(B, 11), injection(12, 162), 20),
      ContainsSubstring("the coarse mesh has 11 eigenpairs, compute at least 12"));
  CHECK_THROWS_WITH(SG::evaluate_spectrum(A, fine, A, fine, injection(162, 162), 21),
                    ContainsSubstring("the fine mesh has 20 eigenpairs"));
  CHECK_THROWS_AS(SG::evaluate_spectrum(A, fine, A, fine, injection(162, 162), 0),
                  std::invalid_argument);
  CHECK_THROWS_WITH(SG::evaluate_spectrum(A, fine, A, fine, injection(12, 162), 10),
                    ContainsSubstring("rows of P"));
}

TEST_CASE("modes that change places at K are lost for K coarse modes but not for 1.1 K")
{
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(2));
  const Eigenpairs fine = SG::eigenpairs(op, 11);
  Eigenpairs coarse = fine;
  coarse.vectors.col(9).swap(coarse.vectors.col(10));
  const SG::Spectral_evaluation e =
      SG::evaluate_spectrum(op, fine, op, coarse, injection(162, 162), 10);
  CHECK(e.norm_D == Approx(1.));
  CHECK(e.norm_D_extended < 1e-10);
}

namespace {

// Least squares by a dense QR decomposition, weighted by the root of the mass; for a full rank.
double slow_span_loss(const MatrixXd& fine_vectors, const Sparse& B, const MatrixXd& carried)
{
  const MatrixXd root = Eigen::SelfAdjointEigenSolver<MatrixXd>(MatrixXd(B)).operatorSqrt();
  const MatrixXd A = root * carried, b = root * fine_vectors;
  const MatrixXd X = A.householderQr().solve(b);
  return (b - A * X).squaredNorm() / double(fine_vectors.cols());
}

// A bumpy sphere and a coarser one, with a prolongation.
struct Two_spheres
{
  explicit Two_spheres(double theta, double scale = 1)
  {
    shapes::Matrices fine = shapes::bumpy_icosphere_matrices(3),
                     coarse = shapes::bumpy_icosphere_matrices(2);
    fine.V *= scale;
    coarse.V *= scale;
    fine_op = laplace(fine, theta);
    coarse_op = laplace(coarse, theta);
    fine_pairs = SG::eigenpairs(fine_op, 20);
    coarse_pairs = SG::eigenpairs(coarse_op, 22);
    P = injection(162, 642);
    Q = SG::closest_point_prolongation(fine, coarse, P);
  }

  double loss(const MatrixXd& fine_vectors, const MatrixXd& coarse_vectors) const
  {
    return SG::span_loss(fine_vectors, fine_op.B, Q, coarse_vectors);
  }

  Laplace_operator fine_op, coarse_op;
  Eigenpairs fine_pairs, coarse_pairs;
  Sparse P, Q;
};

} // namespace

TEST_CASE("span loss is what dense least squares leave of the fine eigenvectors, in any unit")
{
  for(const double theta : thetas) {
    const Two_spheres s(theta), scaled(theta, 100.);
    const MatrixXd coarse = s.coarse_pairs.vectors.leftCols(20);
    const SG::Spectral_evaluation e =
        SG::evaluate_spectrum(s.fine_op, s.fine_pairs, s.coarse_op, s.coarse_pairs, s.P, 20, s.Q);
    CHECK(e.span_loss ==
          Approx(slow_span_loss(s.fine_pairs.vectors, s.fine_op.B, s.Q * coarse)).epsilon(1e-10));
    CHECK(e.span_loss > 0.001);
    CHECK(e.span_loss < 0.1);
    CHECK(SG::evaluate_spectrum(scaled.fine_op, scaled.fine_pairs, scaled.coarse_op,
                                scaled.coarse_pairs, scaled.P, 20, scaled.Q)
              .span_loss == Approx(e.span_loss).epsilon(1e-6));
    CHECK(std::isnan(
        SG::evaluate_spectrum(s.fine_op, s.fine_pairs, s.coarse_op, s.coarse_pairs, s.P, 20)
            .span_loss));
    // Two functions are half lost where the span has one of them.
    CHECK(s.loss(s.fine_pairs.vectors.leftCols(2), MatrixXd::Ones(162, 1)) == Approx(0.5));
    CHECK(s.loss(s.fine_pairs.vectors, MatrixXd(162, 0)) == 1);
    CHECK_THROWS_WITH(SG::span_loss(s.fine_pairs.vectors, s.fine_op.B, s.P, coarse),
                      ContainsSubstring("rows of Q"));
    CHECK_THROWS_WITH(SG::span_loss(s.fine_pairs.vectors, s.fine_op.B, s.Q, s.fine_pairs.vectors),
                      ContainsSubstring("columns of Q"));
    CHECK_THROWS_WITH(SG::span_loss(s.fine_pairs.vectors, s.coarse_op.B, s.Q, coarse),
                      ContainsSubstring("fine mass"));
    CHECK_THROWS_WITH(s.loss(MatrixXd(642, 0), coarse), ContainsSubstring("no fine vector"));
  }
}

TEST_CASE("span loss is 0 for the mesh itself, and near 1 for a random span")
{
  for(const double theta : thetas) {
    const Two_spheres s(theta);
    const MatrixXd& phi = s.fine_pairs.vectors;
    const Sparse one = injection(642, 642);
    CHECK(SG::span_loss(phi, s.fine_op.B, one, phi) < 1e-13);
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    const MatrixXd noise = MatrixXd::NullaryExpr(642, 20, [&] { return normal(random); });
    const double loss = SG::span_loss(phi, s.fine_op.B, one, noise);
    CHECK(loss > 0.9);
    CHECK(loss < 1.);
    CHECK(loss == Approx(slow_span_loss(phi, s.fine_op.B, noise)).epsilon(1e-10));
  }
}

TEST_CASE("span loss does not change where clusters are rotated, or a basis is written otherwise")
{
  const Two_spheres s(0.5);
  const MatrixXd &fine = s.fine_pairs.vectors, coarse = s.coarse_pairs.vectors.leftCols(20);
  const double loss = s.loss(fine, coarse);
  MatrixXd rotated = fine, mixed = coarse;
  for(Index first = 1; first + 3 <= 20; first += 3) { // three at a time, close or not
    const MatrixXd R =
        Eigen::AngleAxisd(0.7 * double(first), Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    rotated.middleCols(first, 3) = fine.middleCols(first, 3) * R;
    mixed.middleCols(first, 3) = coarse.middleCols(first, 3) * R.transpose();
  }
  CHECK((rotated - fine).norm() > 1.);
  CHECK(s.loss(rotated, mixed) == Approx(loss).epsilon(1e-10));
  CHECK(s.loss(fine, -3. * coarse.rowwise().reverse()) == Approx(loss).epsilon(1e-10));
}

TEST_CASE("span loss of coarse vectors that depend on each other is that of their span")
{
  for(const double theta : thetas) {
    const Two_spheres s(theta);
    const MatrixXd& fine = s.fine_pairs.vectors;
    const MatrixXd independent = s.coarse_pairs.vectors.leftCols(12);
    MatrixXd coarse(162, 20);
    coarse << independent, independent.leftCols(4) + 0.3 * independent.middleCols(5, 4),
        independent.col(11), MatrixXd::Zero(162, 3);
    CHECK(s.loss(fine, coarse) ==
          Approx(slow_span_loss(fine, s.fine_op.B, s.Q * independent)).epsilon(1e-10));
    CHECK(s.loss(fine, MatrixXd::Zero(162, 20)) == 1.);
  }
}

TEST_CASE("floors are those of plane waves on the equilateral lattice")
{
  CHECK(SG::commutativity_floor(0., 100, 600) == Approx(5.1 * 1e4 / 600).epsilon(0.005));
  CHECK(SG::orthonormality_floor(0.5, 100, 600) == Approx(0.87).epsilon(0.005));
  CHECK(SG::orthonormality_floor(0., 100, 600) == 0.);
  // Symbols by sums over the six edges, eigenvalues 4 pi k, directions averaged.
  const Index K = 100, N = 20000;
  const double h = std::sqrt(2. / (std::sqrt(3.) * N)), M = 1. / N;
  for(const double theta : {0., 0.25, 0.5, 1.}) {
    double commutativity = 0., orthonormality = 0.;
    const int directions = 12;
    for(Index k = 1; k <= K; ++k) {
      const double lambda = 4. * shapes::pi * k;
      for(int d = 0; d < directions; ++d) {
        double L = 0., cosines = 0.;
        for(int edge = 0; edge < 6; ++edge) {
          const double phase =
              std::sqrt(lambda) * h * std::cos(shapes::pi * (edge / 3. + d / (3. * directions)));
          L += (1. - std::cos(phase)) / std::sqrt(3.);
          cosines += std::cos(phase);
        }
        const double B = M * ((1. - theta) + theta * (0.5 + cosines / 12.));
        commutativity += std::pow(L / B - lambda, 2) / directions;
        orthonormality += std::pow(B / M - 1., 2) / directions;
      }
    }
    CHECK(SG::commutativity_floor(theta, K, N) ==
          Approx(std::sqrt(commutativity / K)).epsilon(0.03));
    CHECK(SG::orthonormality_floor(theta, K, N) == Approx(std::sqrt(orthonormality)).epsilon(0.03));
  }
}

TEST_CASE("a nested icosphere comes close to the floors", "[slow]")
{
  const shapes::Matrices fine = shapes::icosphere_matrices(5),
                         coarse = shapes::icosphere_matrices(3);
  const double norm_L[] = {71., 8.1}, norm_D[] = {0.13, 0.70};
  for(int i = 0; i < 2; ++i) {
    const Laplace_operator A = laplace(fine, thetas[i]), B = laplace(coarse, thetas[i]);
    const SG::Spectral_evaluation e = SG::evaluate_spectrum(
        A, SG::eigenpairs(A, 100), B, SG::eigenpairs(B, 110), injection(642, 10242), 100);
    CHECK(e.norm_L == Approx(norm_L[i]).epsilon(0.02));
    CHECK(e.norm_D == Approx(norm_D[i]).epsilon(0.05));
    CHECK(e.floor_norm_L == Approx(e.norm_L).epsilon(0.4));
  }
}

TEST_CASE("prolongation through the spectrum inverts the restriction of a mesh that only shrank")
{
  for(const double theta : thetas) {
    shapes::Matrices coarse = shapes::bumpy_icosphere_matrices(3);
    const Laplace_operator A = laplace(coarse, theta);
    coarse.V *= 0.5; // the same shape, smaller: the identity for all that is scaled to unit area
    const Laplace_operator B = laplace(coarse, theta);
    const Eigenpairs f = SG::eigenpairs(A, 12), c = SG::eigenpairs(B, 12);
    const Sparse P = injection(642, 642);
    const SG::Spectral_evaluation e = SG::evaluate_spectrum(A, f, B, c, P, 12);
    const MatrixXd functions = f.vectors * MatrixXd::Random(12, 3);
    CHECK((SG::prolong_through_spectrum(A, f, B, c, e.C, P * functions) - functions).norm() <
          1e-8 * functions.norm());
    const MatrixXd one = MatrixXd::Ones(642, 1);
    CHECK((SG::prolong_through_spectrum(A, f, B, c, e.C, one) - one).norm() < 1e-8);
    CHECK_THROWS_AS(SG::prolong_through_spectrum(A, f, B, c, e.C, MatrixXd::Ones(12, 1)),
                    std::invalid_argument);
  }
}

} // namespace test_functional_map
