// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/numerics/Spectrum_slices.h>

#include "catch.h"
#include "shapes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <cstdlib>

#ifdef SPECTRAL_TEST_WITH_LAPACK
extern "C" void dsygv_(const int* type, const char* job, const char* triangle, const int* n,
                       double* A, const int* lda, double* B, const int* ldb, double* values,
                       double* work, const int* lwork, int* info);
#endif

namespace test_eigenpairs {

using Method = SG::Eigenpairs_method;
using SG::Eigenpairs;
using SG::Laplace_operator;

namespace {

constexpr double thetas[] = {0., 0.5};

Laplace_operator laplace(const shapes::Matrices& mesh, double theta = 0.)
{
  return SG::laplace_operator(mesh.V, mesh.T, theta);
}

SG::Eigenpairs_options with_method(Method method, double tolerance = 1e-10)
{
  SG::Eigenpairs_options options;
  options.method = method;
  options.tolerance = tolerance;
  return options;
}

template <Method method>
Eigenpairs by(const Laplace_operator& op, Eigen::Index K, const SG::Eigenpairs_options& options)
{
  SG::Eigenpairs_options with = options;
  with.method = method;
  return SG::eigenpairs(op, K, with);
}

using Solver = Eigenpairs (*)(const Laplace_operator&, Eigen::Index, const SG::Eigenpairs_options&);
constexpr Solver by_block = by<Method::block>, by_dense = by<Method::dense>;

double orthonormality_error(const Laplace_operator& op, const Eigenpairs& pairs)
{
  const Eigen::MatrixXd gram = pairs.vectors.transpose() * (op.B * pairs.vectors);
  return (gram - Eigen::MatrixXd::Identity(pairs.size(), pairs.size())).cwiseAbs().maxCoeff();
}

// The pairs are eigenpairs, orthonormal, in order, and their signs follow the documented rule.
void check_pairs(const Laplace_operator& op, const Eigenpairs& pairs, double tolerance = 1e-8)
{
  CHECK(orthonormality_error(op, pairs) < 1e-10);
  CHECK(pairs.residuals.maxCoeff() < tolerance);
  CHECK(pairs.values.minCoeff() >= 0.);
  CHECK(std::is_sorted(pairs.values.data(), pairs.values.data() + pairs.size()));
  for(Eigen::Index k = 0; k < pairs.size(); ++k) {
    const Eigen::VectorXd phi = pairs.vectors.col(k);
    const Eigen::VectorXd r = op.L * phi - pairs.values(k) * (op.B * phi);
    const double s = 4. * shapes::pi / op.mass.sum();
    const double norm =
        std::sqrt(r.cwiseAbs2().cwiseQuotient(op.mass).sum()) / (pairs.values(k) + s);
    CHECK(pairs.residuals(k) == Approx(norm).margin(1e-14));
    Eigen::Index i = 0;
    while(std::abs(phi(i)) < 0.618 * phi.cwiseAbs().maxCoeff())
      ++i;
    CHECK(phi(i) > 0.);
  }
}

double mean_error(const Eigenpairs& pairs, const std::vector<double>& exact)
{
  double sum = 0.;
  for(Eigen::Index k = 1; k < pairs.size(); ++k)
    sum += std::abs(pairs.values(k) / exact[k] - 1.);
  return sum / (pairs.size() - 1);
}

} // namespace

TEST_CASE("Residuals and orthonormality of eigenpairs in either mass, by either method")
{
  for(const shapes::Matrices& mesh :
      {shapes::bumpy_icosphere_matrices(3), shapes::irregular_grid_matrices(25, 20)})
    for(const double theta : thetas)
      for(const Solver solver : {by_block, by_dense}) {
        const Laplace_operator op = laplace(mesh, theta);
        const Eigenpairs pairs = solver(op, 40, {});
        check_pairs(op, pairs);
        CHECK(pairs.complete);
        CHECK(pairs.solver == (solver == by_block ? "block" : "dense"));
        CHECK(pairs.values(0) * op.mass.sum() < 1e-10);
        CHECK(pairs.values(1) * op.mass.sum() > 1.);
      }
}

TEST_CASE("A sphere's spectrum is l(l+1) with multiplicity 2l+1")
{
  for(const double theta : thetas) {
    const double radius = 3.;
    const Laplace_operator op = laplace(shapes::icosphere_matrices(4, radius), theta);
    const Eigenpairs pairs = SG::eigenpairs(op, 36);
    check_pairs(op, pairs);
    CHECK(pairs.complete);
    for(int l = 1, k = 1; l < 6; k += 2 * l + 1, ++l)
      for(int i = 0; i < 2 * l + 1; ++i)
        CHECK(pairs.values(k + i) * radius * radius ==
              Approx(l * (l + 1)).epsilon(theta > 0. ? 0.01 : 0.02));
    // The symmetry of the icosahedron makes three copies exact.
    CHECK(pairs.values(3) - pairs.values(1) < 1e-9 * pairs.values(1));
  }
}

TEST_CASE("A square's Neumann spectrum is pi^2 (i^2 + j^2)")
{
  const Laplace_operator op = laplace(shapes::grid_matrices(60, 60), 0.5);
  const Eigenpairs pairs = SG::eigenpairs(op, 15);
  std::vector<double> exact;
  for(int i = 0; i < 6; ++i)
    for(int j = 0; j < 6; ++j)
      exact.push_back(shapes::pi * shapes::pi * (i * i + j * j));
  std::sort(exact.begin(), exact.end());
  for(int k = 0; k < 15; ++k)
    CHECK(pairs.values(k) == Approx(exact[k]).epsilon(0.01).margin(1e-9));
}

TEST_CASE("On equilateral triangles the averaged mass is far more accurate than the lumped one")
{
  // Lame's closed form for the equilateral triangle with Neumann condition: 16 pi^2 / 9 (i^2 + ij +
  // j^2).
  std::vector<double> exact;
  for(int i = 0; i < 12; ++i)
    for(int j = 0; j < 12; ++j)
      exact.push_back(16. * shapes::pi * shapes::pi / 9. * (i * i + i * j + j * j));
  std::sort(exact.begin(), exact.end());
  const shapes::Matrices mesh = shapes::equilateral_matrices(40);
  const double lumped = mean_error(SG::eigenpairs(laplace(mesh), 40), exact);
  const double averaged = mean_error(SG::eigenpairs(laplace(mesh, 0.5), 40), exact);
  CHECK(lumped > 0.005);
  CHECK(averaged < 0.02 * lumped);
}

TEST_CASE("Copies of eigenvalues on several components are all found, by either method")
{
  const shapes::Matrices mesh = shapes::components_matrices(shapes::icosphere_matrices(2), 3);
  for(const double theta : thetas)
    for(const Solver solver : {by_block, by_dense}) {
      const Laplace_operator op = laplace(mesh, theta);
      const Eigenpairs pairs = solver(op, 48, {}); // three times 1 + 3 + 5 + 7
      check_pairs(op, pairs);
      CHECK(pairs.complete);
      const Eigenpairs single = SG::eigenpairs(laplace(shapes::icosphere_matrices(2), theta), 16);
      for(Eigen::Index k = 0; k < 48; ++k)
        CHECK(pairs.values(k) == Approx(single.values(k / 3)).epsilon(1e-8).margin(1e-10));
    }
}

TEST_CASE("More copies of an eigenvalue than a block has vectors are found")
{
  // Twenty components: 20 constants, then 60 copies of the first eigenvalue of a sphere.
  const Laplace_operator op =
      laplace(shapes::components_matrices(shapes::icosphere_matrices(2), 20));
  const Eigenpairs pairs = SG::eigenpairs(op, 70, with_method(Method::block));
  check_pairs(op, pairs);
  CHECK(pairs.complete);
  const Eigenpairs single = SG::eigenpairs(laplace(shapes::icosphere_matrices(2)), 4);
  for(Eigen::Index k = 0; k < 70; ++k)
    CHECK(pairs.values(k) == Approx(k < 20 ? 0. : single.values(1)).epsilon(1e-8).margin(1e-9));
}

TEST_CASE("Copies are found where the last block of the first round was not full")
{
  // What was kept beyond the first K had not converged, and the second round lost its orthogonality
  // to it.
  const Laplace_operator op =
      laplace(shapes::components_matrices(shapes::icosphere_matrices(2), 20));
  for(const int K : {21, 26}) {
    const Eigenpairs pairs = SG::eigenpairs(op, K, with_method(Method::block, 1e-3));
    CHECK(pairs.complete);
    const Eigen::MatrixXd gram = pairs.vectors.transpose() * op.B * pairs.vectors;
    CHECK((gram - Eigen::MatrixXd::Identity(K, K)).cwiseAbs().maxCoeff() < 1e-10);
  }
}

TEST_CASE("A kernel larger than K is returned as such")
{
  const Laplace_operator op =
      laplace(shapes::components_matrices(shapes::icosphere_matrices(1), 9));
  for(const Solver solver : {by_block, by_dense}) {
    const Eigenpairs pairs = solver(op, 7, {});
    check_pairs(op, pairs);
    CHECK(pairs.values.maxCoeff() * op.mass.sum() < 1e-9);
  }
}

TEST_CASE("A small Krylov space restarts and gives the same pairs")
{
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(4), 0.5);
  const Eigenpairs reference = SG::eigenpairs(op, 40);
  SG::Eigenpairs_options options = with_method(Method::block);
  for(const int vectors : {72, 100}) {
    options.maximum_vectors = vectors;
    const Eigenpairs pairs = SG::eigenpairs(op, 40, options);
    check_pairs(op, pairs);
    CHECK((pairs.values - reference.values).cwiseAbs().maxCoeff() < 1e-9 * reference.values(39));
  }
  options.maximum_vectors = 71;
  CHECK_THROWS_WITH(SG::eigenpairs(op, 40, options), ContainsSubstring("maximum_vectors"));
  options.maximum_vectors = 72;
  options.maximum_iterations = 1;
  CHECK_THROWS_WITH(SG::eigenpairs(op, 40, options), ContainsSubstring("did not converge"));
}

TEST_CASE("Eigenpairs do not depend on the number of threads")
{
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(5), 0.5);
  SG::Eigenpairs_options options = with_method(Method::block, 1e-6);
  const Eigenpairs one = SG::eigenpairs(op, 20, options);
  options.threads = 3;
  CHECK(SG::eigenpairs(op, 20, options).vectors == one.vectors);
}

TEST_CASE("Spaces that are exhausted are continued with random vectors")
{
  // 320 vertices of high symmetry, and nearly half of the spectrum.
  const Laplace_operator op = laplace(shapes::torus_matrices(20, 16));
  const Eigenpairs dense = SG::eigenpairs(op, 150, with_method(Method::dense));
  const Eigenpairs pairs = SG::eigenpairs(op, 150, with_method(Method::block));
  check_pairs(op, pairs);
  CHECK((pairs.values - dense.values).cwiseAbs().maxCoeff() < 1e-9 * dense.values(149));
}

TEST_CASE("The block method takes problems of any size")
{
  for(const shapes::Matrices& mesh :
      {shapes::grid_matrices(4, 3), shapes::torus_matrices(6, 5), shapes::icosphere_matrices(1),
       shapes::components_matrices(shapes::icosphere_matrices(0), 5),
       shapes::irregular_grid_matrices(8, 7), shapes::torus_matrices(11, 9),
       shapes::bumpy_icosphere_matrices(2)}) {
    const Laplace_operator op = laplace(mesh, 0.5);
    const Eigen::Index n = op.mass.size();
    for(Eigen::Index K = 1; K <= n; K += K < 10 ? 1 : 7) {
      const Eigenpairs dense = SG::eigenpairs(op, K, with_method(Method::dense));
      const Eigenpairs pairs = SG::eigenpairs(op, K, with_method(Method::block));
      CHECK(pairs.complete);
      CHECK(orthonormality_error(op, pairs) < 1e-10);
      const double spacing = 4. * shapes::pi / op.mass.sum();
      CHECK((pairs.values - dense.values).cwiseAbs().maxCoeff() <
            1e-8 * (dense.values(K - 1) + spacing));
    }
  }
}

TEST_CASE("Rough pairs are complete only where they have been counted")
{
  // Four spheres that differ a little: twelve nearly equal first eigenvalues, of which a block may
  // find eight mixtures.
  const shapes::Matrices sphere = shapes::icosphere_matrices(3);
  shapes::Matrices mesh = shapes::components_matrices(sphere, 4);
  for(int c = 0; c < 4; ++c)
    mesh.V.middleRows(c * sphere.V.rows(), sphere.V.rows()) *= 1. + 2e-5 * c;
  const Laplace_operator op = laplace(mesh);
  const Eigenpairs reference = SG::eigenpairs(op, 36);
  for(const double tolerance : {0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6})
    for(const Eigen::Index K : {6, 13, 16, 20, 36}) {
      const Eigenpairs pairs = SG::eigenpairs(op, K, with_method(Method::block, tolerance));
      INFO(tolerance << ' ' << K);
      if(tolerance > 1e-3)
        CHECK(!pairs.complete);
      const double error = ((pairs.values - reference.values.head(K)).array().abs() /
                            (reference.values.head(K).array() + 4. * shapes::pi / op.mass.sum()))
                               .maxCoeff();
      if(pairs.complete)
        CHECK(error < 1e-2);
      CHECK((pairs.complete || tolerance > 1e-3));
    }
}

TEST_CASE("Eigenpairs of a stiffness in any unit", "[slow]")
{
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(3), 0.5);
  const Eigenpairs reference = SG::eigenpairs(op, 30);
  for(const double unit : {1e-12, 1e-6, 1e6, 1e12})
    for(const Solver solver : {by_block, by_dense}) {
      Laplace_operator scaled = op;
      scaled.L *= unit;
      const Eigenpairs pairs = solver(scaled, 30, {});
      CHECK(pairs.complete);
      CHECK(pairs.residuals.maxCoeff() < 1e-8);
      CHECK((pairs.values / unit - reference.values).cwiseAbs().maxCoeff() <
            1e-9 * reference.values(29));
    }
  // the shapes of triangles are no unit
  const Laplace_operator strip = laplace(shapes::grid_matrices(400, 1, 1., 1e-5));
  CHECK(SG::internal::Eigen_problem(strip).shift() == Approx(4e5 * shapes::pi));
}

TEST_CASE("The dense path agrees with the iteration, and takes K up to n")
{
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(3), 0.5);
  const Eigenpairs dense = by_dense(op, 30, {});
  const Eigenpairs pairs = SG::eigenpairs(op, 30);
  CHECK((pairs.values - dense.values).cwiseAbs().maxCoeff() < 1e-9 * dense.values(29));
  const Eigen::MatrixXd product = dense.vectors.transpose() * op.B * pairs.vectors;
  CHECK((product.cwiseAbs() - Eigen::MatrixXd::Identity(30, 30)).cwiseAbs().maxCoeff() < 1e-6);

  const Laplace_operator small = laplace(shapes::icosphere_matrices(1));
  const Eigenpairs all = SG::eigenpairs(small, 42);
  CHECK(all.solver == "dense");
  CHECK(all.complete);
  check_pairs(small, all);
}

TEST_CASE("The kernels on panels compute what Eigen does, for either kind of rows")
{
  namespace I = SG::internal;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, I::panel_width, Eigen::RowMajor>;
  using Small = Eigen::Matrix<double, I::panel_width, I::panel_width, Eigen::RowMajor>;
  const Eigen::Index n = 37;
  const Rows P = Rows::Random(n, 8), W = Rows::Random(n, 8);
  const Small H = Small::Random();
  const auto check = [&] {
    Small sum = H;
    I::gram(P.data(), W.data(), n, sum.data());
    CHECK((sum - (H + P.transpose() * W)).norm() < 1e-13);

    Rows left = W;
    I::subtract_product(left.data(), P.data(), n, H.data());
    CHECK((left - (W - P * H)).norm() < 1e-13);

    const Eigen::SparseMatrix<double, Eigen::RowMajor> A =
        Eigen::MatrixXd(P * W.transpose()).sparseView();
    Rows product = W;
    I::multiply(A.outerIndexPtr(), A.innerIndexPtr(), A.valuePtr(), P.data(), product.data(), 5, n);
    CHECK((product.bottomRows(n - 5) - (A * P).bottomRows(n - 5)).norm() < 1e-12);
    CHECK(product.topRows(5) == W.topRows(5));

    // One supernode of 7 columns that begins at row 3, and 11 rows below; its diagonal holds
    // inverses.
    const int width = 7, below = 11;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> L =
        Eigen::MatrixXd::Random(width + below, width);
    L.diagonal().array() += 3;
    const Eigen::MatrixXd lower = L.topRows(width).triangularView<Eigen::Lower>();
    L.topRows(width).diagonal() = L.topRows(width).diagonal().cwiseInverse().eval();
    std::vector<int> rows;
    for(int i = 0; i < below; ++i)
      rows.push_back(12 + 2 * i);
    const I::Supernode s{L.data(), rows.data(), 3, width, below};
    Rows expected = W, found = W;
    expected.middleRows(3, width) =
        lower.triangularView<Eigen::Lower>().solve(W.middleRows(3, width));
    for(int i = 0; i < below; ++i)
      expected.row(rows[i]) -= L.row(width + i) * expected.middleRows(3, width);
    I::forward(s, found.data());
    CHECK((found - expected).norm() < 1e-12);

    Eigen::MatrixXd right = found.middleRows(3, width);
    for(int i = 0; i < below; ++i)
      right -= L.row(width + i).transpose() * found.row(rows[i]);
    expected = found;
    expected.middleRows(3, width) = lower.transpose().triangularView<Eigen::Upper>().solve(right);
    I::backward(s, found.data());
    CHECK((found - expected).norm() < 1e-12);

    // Five columns of a block times a triangle, added to others and in place.
    const Rows T = Small(H.triangularView<Eigen::Upper>());
    Rows block = W;
    I::multiply_block(block.data(), 8, 5, P.data(), 8, T.data(), 5, n, true);
    expected = W;
    expected.leftCols(5) -= P.leftCols(5) * T.topLeftCorner(5, 5);
    CHECK((block - expected).norm() < 1e-12);
    I::multiply_block(block.data(), 8, 8, block.data(), 8, T.data(), 8, n, false);
    CHECK((block - expected * T).norm() < 1e-12);
  };
  check();
#ifdef CGAL_SPECTRAL_DISPATCH
  const bool was = std::exchange(I::has_wide_units(), false);
  check();
  I::has_wide_units() = was;
#endif
}

TEST_CASE("The shift lies inside of the wanted spectrum, unless that has too many copies", "[slow]")
{
  const auto shift = [&](const Laplace_operator& op, Eigen::Index K) {
    const SG::internal::Eigen_problem problem(op);
    const SG::Eigenpairs_options options;
    SG::internal::Block_lanczos lanczos(problem, K, options);
    const Eigenpairs pairs = lanczos.compute();
    const Eigen::VectorXd& values = pairs.values;
    CHECK(pairs.complete);
    CHECK((values - by_dense(op, K, {}).values).cwiseAbs().maxCoeff() < 1e-9 * values(K - 1));
    return lanczos.shift() / values(K - 1);
  };
  for(const Eigen::Index K : {30, 40, 52}) { // also where the space is full shortly before the end
    for(const shapes::Matrices& mesh :
        {shapes::bumpy_icosphere_matrices(3), shapes::irregular_grid_matrices(20, 20)}) {
      const double place = shift(laplace(mesh, 0.5), K);
      CHECK(place > 0.4);
      CHECK(place < 0.9);
    }
  }
  CHECK(shift(laplace(shapes::components_matrices(shapes::icosphere_matrices(1), 20)), 50) < 0.);
}

TEST_CASE("A shift that meets an eigenvalue is moved")
{
  // Eigenvalues 0, 1, 2, ... spacings, next to each of which the first shift may lie.
  const Eigen::Index n = 400;
  const double spacing = 4. * shapes::pi / n;
  Eigen::SparseMatrix<double> L(n, n), B(n, n);
  L = Eigen::VectorXd::LinSpaced(n, 0., n - 1.).asDiagonal();
  B.setIdentity();
  for(const double offset : {0., 1e-13, 1e-11, 1e-9, 1e-6, -1e-9})
    for(const Eigen::Index K : {20, 25, 50, 100}) {
      const Eigenpairs pairs =
          SG::eigenpairs(spacing * (1. + offset) * L, B, K, with_method(Method::block));
      INFO(offset << ' ' << K);
      CHECK(pairs.complete);
      CHECK((pairs.values / (spacing * (1. + offset)) - Eigen::VectorXd::LinSpaced(K, 0., K - 1.))
                .cwiseAbs()
                .maxCoeff() < 1e-9 * K);
      CHECK((pairs.vectors.transpose() * pairs.vectors - Eigen::MatrixXd::Identity(K, K))
                .cwiseAbs()
                .maxCoeff() < 1e-10);
    }
}

TEST_CASE("A matrix of the wrong sign is named")
{
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(2), 0.5);
  const double s = 4. * shapes::pi / op.mass.sum();
  for(const Method method : {Method::block, Method::dense})
    for(const Eigen::Index K : {10, 30}) {
      const SG::Eigenpairs_options options = with_method(method);
      const auto refuses = [&](const Eigen::SparseMatrix<double>& L,
                               const Eigen::SparseMatrix<double>& B, const char* sentence) {
        CHECK_THROWS_WITH(SG::eigenpairs(L, B, K, options), ContainsSubstring(sentence));
        CHECK_THROWS_AS(SG::eigenpairs(L, B, K, options), std::invalid_argument);
      };
      refuses(-op.L, op.B, "pass -L");
      for(const double shift : {0.01, 3., 8.})
        refuses(op.L - shift * s * op.B, op.B, "L is not positive semidefinite");
      // Its row sums are positive.
      Eigen::SparseMatrix<double> B = op.B;
      B.coeffRef(5, 5) -= 3. * B.coeff(5, 5);
      for(const Eigen::Index neighbor : {6, 7}) {
        B.coeffRef(5, neighbor) += 2. * op.mass(5);
        B.coeffRef(neighbor, 5) += 2. * op.mass(5);
      }
      refuses(op.L, B, "B is not positive definite");
    }
}

namespace {

// Parts of one shape, each turned another way, the last one of another size.
shapes::Matrices turned_copies(const shapes::Matrices& part, const int copies,
                               const double last_size = 1.)
{
  shapes::Matrices result = shapes::components_matrices(part, copies);
  const Eigen::Index n = part.V.rows();
  for(int c = 0; c < copies; ++c) {
    const double size = c + 1 == copies ? last_size : 1.;
    const Eigen::Matrix3d turn =
        size * (Eigen::AngleAxisd(0.7 * c + 0.2, Eigen::Vector3d::UnitX()) *
                Eigen::AngleAxisd(1.3 * c, Eigen::Vector3d(1, 2, c % 7).normalized()))
                   .toRotationMatrix();
    result.V.middleRows(c * n, n) =
        ((part.V * turn.transpose()).rowwise() + Eigen::RowVector3d(3. * c, 0, 0)).eval();
  }
  return result;
}

shapes::Matrices box_matrices()
{
  shapes::Matrices box;
  box.V.resize(8, 3);
  for(int v = 0; v < 8; ++v)
    box.V.row(v) << v % 2, v / 2 % 2 * 0.7, v / 4 * 0.4;
  box.T.resize(12, 3);
  box.T << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6,
      1, 3, 5, 3, 7, 5;
  return box;
}

// All eigenvalues of the dense problem, by LAPACK where there is one.
Eigen::VectorXd dense_values(const Laplace_operator& op)
{
#ifdef SPECTRAL_TEST_WITH_LAPACK
  Eigen::MatrixXd L = op.L, B = op.B;
  const int type = 1, n = int(L.rows()), size = 34 * n;
  int info = 0;
  Eigen::VectorXd values(n), work(size);
  dsygv_(&type, "N", "L", &n, L.data(), &n, B.data(), &n, values.data(), work.data(), &size, &info);
  REQUIRE(info == 0);
  return values;
#else
  const Eigen::MatrixXd L = op.L, B = op.B;
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(L, B, Eigen::EigenvaluesOnly)
      .eigenvalues();
#endif
}

// Solves for the parts, each by itself: the whole would take the dense solver minutes.
Eigen::VectorXd dense_values_of_parts(const shapes::Matrices& part, const shapes::Matrices& mesh,
                                      double theta)
{
  const Eigen::Index n = part.V.rows();
  std::vector<double> all;
  for(Eigen::Index first = 0; first < mesh.V.rows(); first += n) {
    const Eigen::VectorXd values =
        dense_values(laplace({mesh.V.middleRows(first, n), part.T}, theta));
    all.insert(all.end(), values.data(), values.data() + n);
  }
  std::sort(all.begin(), all.end());
  return Eigen::VectorXd::Map(all.data(), Eigen::Index(all.size()));
}

void check_converged(const Laplace_operator& op, const Eigenpairs& pairs,
                     const Eigen::VectorXd& expected)
{
  const double s = 4. * shapes::pi / op.mass.sum();
  const Eigen::VectorXd values = expected.head(pairs.size());
  CHECK(pairs.complete);
  CHECK(pairs.residuals.maxCoeff() < 1e-9);
  CHECK(((pairs.values - values).array().abs() / (values.array() + s)).maxCoeff() < 1e-8);
  CHECK(orthonormality_error(op, pairs) < 1e-10);
}

} // namespace

TEST_CASE("Many like parts, each turned", "[slow]")
{
  struct Scene
  {
    shapes::Matrices part;
    int copies;
    std::vector<Eigen::Index> numbers;
  };
  for(const Scene& scene : {Scene{box_matrices(), 400, {20, 100}}, Scene{box_matrices(), 80, {630}},
                            Scene{shapes::icosphere_matrices(0), 80, {20, 100, 400, 700}},
                            Scene{shapes::icosphere_matrices(0), 300, {200}},
                            Scene{shapes::icosphere_matrices(1), 25, {20, 100, 300, 700}},
                            Scene{shapes::icosphere_matrices(1), 100, {100}},
                            Scene{shapes::icosphere_matrices(2), 5, {20, 200, 350, 600}}})
    for(const double theta : thetas) {
      shapes::Matrices mesh = turned_copies(scene.part, scene.copies);
      mesh.V = mesh.V.cast<float>().cast<double>().eval(); // as files have it
      const Laplace_operator op = laplace(mesh, theta);
      const Eigen::VectorXd expected = dense_values_of_parts(scene.part, mesh, theta);
      for(const Eigen::Index K : scene.numbers) {
        INFO(scene.copies << " parts of " << scene.part.V.rows() << ", K = " << K);
        check_converged(op, SG::eigenpairs(op, K), expected);
      }
    }
}

TEST_CASE("One ball of five is a tenth as large")
{
  const shapes::Matrices mesh = turned_copies(shapes::icosphere_matrices(2), 5, 0.1);
  for(const double theta : thetas) {
    const Laplace_operator op = laplace(mesh, theta);
    check_converged(op, SG::eigenpairs(op, 350), dense_values(op));
  }
}

TEST_CASE("Many like parts in one Krylov space: its rank falls, copies are missed at first",
          "[slow]")
{
  struct Scene
  {
    shapes::Matrices part;
    int copies;
    Eigen::Index K;
  };
  for(const Scene& scene :
      {Scene{box_matrices(), 40, 60}, Scene{shapes::icosphere_matrices(0), 40, 120},
       Scene{shapes::icosphere_matrices(1), 10, 100}, Scene{shapes::icosphere_matrices(2), 3, 60}})
    for(const double theta : thetas) {
      const Laplace_operator op = laplace(turned_copies(scene.part, scene.copies), theta);
      const SG::internal::Eigen_problem problem(op);
      INFO(scene.copies << " parts of " << scene.part.V.rows() << ", K = " << scene.K);
      check_converged(op, SG::internal::pairs_of_part(problem, scene.K, with_method(Method::block)),
                      dense_values(op));
    }
}

TEST_CASE("Copies below a shift inside that are missing do not mix up the order")
{
  // The first values were those above the shift, and the count agreed.
  const Laplace_operator op = laplace(turned_copies(box_matrices(), 40));
  const SG::internal::Eigen_problem problem(op);
  const Eigenpairs pairs = SG::internal::pairs_of_part(problem, 150, with_method(Method::block));
  CHECK(std::is_sorted(pairs.values.data(), pairs.values.data() + 150));
  check_converged(op, pairs, dense_values(op));
}

TEST_CASE("Residuals are within ten times the tolerance, or are reported")
{
  for(const shapes::Matrices& mesh :
      {shapes::bumpy_icosphere_matrices(3), shapes::grid_matrices(150, 3, 1., 1e-3),
       turned_copies(shapes::icosphere_matrices(2), 4, 1e-3)})
    for(const double theta : thetas)
      for(const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14}) {
        const Laplace_operator op = laplace(mesh, theta);
        const Eigenpairs pairs =
            SG::eigenpairs(op, 60, SG::Eigenpairs_options::with_tolerance(tolerance));
        INFO(tolerance);
        CHECK(orthonormality_error(op, pairs) < 1e-9);
        if(pairs.complete)
          CHECK(pairs.residuals.maxCoeff() <= 10. * tolerance);
        else // what rounding leaves, or no count
          CHECK(pairs.residuals.maxCoeff() < (tolerance > 1e-3 ? 10. * tolerance : 1e-5));
      }
  // Rounding does not matter yet.
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(3));
  CHECK(SG::eigenpairs(op, 60, SG::Eigenpairs_options::with_tolerance(1e-11)).complete);
}

TEST_CASE("Hundreds of random scenes: what has no small residual is reported", "[.long][slow]")
{
  std::mt19937 random(1);
  const auto below = [&](const int n) { return int(random() % unsigned(n)); };
  int reported = 0;
  for(int solves = 0; solves < 300; ++solves) {
    const int subdivisions = below(3), most[] = {400, 100, 25};
    const shapes::Matrices part = shapes::icosphere_matrices(subdivisions);
    const int copies = 1 + below(below(2) == 0 ? 8 : most[subdivisions]);
    const double sizes[] = {1., 1., 0.1, 10.}, theta = thetas[below(2)];
    const shapes::Matrices mesh = turned_copies(part, copies, sizes[below(4)]);
    const Laplace_operator op = laplace(mesh, theta);
    const int n = int(mesh.V.rows());
    const Eigen::Index K = below(3) == 0 ? n - below((std::min)(n, 60)) : 1 + below(n);
    INFO(copies << " parts of " << part.V.rows() << ", K = " << K << ", theta = " << theta);
    const Eigen::VectorXd expected = dense_values_of_parts(part, mesh, theta);
    // The whole, and as one part: many like ones exhaust a Krylov space.
    const SG::internal::Eigen_problem problem(op);
    const bool whole = n > 1000 || below(4) != 0;
    const Eigenpairs pairs =
        whole ? SG::eigenpairs(op, K) : SG::internal::pairs_of_part(problem, K, {});
    if(!pairs.complete) {
      ++reported;
      continue;
    }
    const Eigen::ArrayXd values = expected.head(K).array();
    const double error =
        ((pairs.values.array() - values).abs() / (values + problem.scale())).maxCoeff();
    CHECK(problem.residuals(pairs, 1).maxCoeff() <= 10. * SG::Eigenpairs_options().tolerance);
    CHECK(error < 1e-8);
  }
  CHECK(reported <= 2); // as a rule none
}

TEST_CASE("The Dirichlet problem is that of the rows off the border")
{
  // Rings whose radii fall by a quarter: eigenvalues of the innermost exceed what stands in the
  // rows of the border.
  const int rings = 40, around = 12;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  for(int i = 0; i < rings; ++i)
    for(int j = 0; j < around; ++j) {
      const double r = std::pow(0.75, i), angle = 2. * shapes::pi * j / around;
      const int a = i * around + j, b = i * around + (j + 1) % around;
      points.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.);
      triangles.emplace_back(a, b, i + 1 < rings ? a + around : rings * around);
      if(i + 1 < rings)
        triangles.emplace_back(b, b + around, a + around);
    }
  points.emplace_back(0, 0, 0);
  const shapes::Matrices mesh = shapes::matrices(points, triangles);
  const Eigen::Index n = mesh.V.rows(), K = 200;
  for(const SG::Mass mass : {SG::Mass::lumped, SG::Mass::averaged}) {
    const Laplace_operator op =
        SG::laplace_operator(mesh.V, mesh.T, {mass, {}, SG::Boundary_condition::dirichlet});
    Laplace_operator inner; // the border is the first ring
    inner.L = op.L.bottomRightCorner(n - around, n - around);
    inner.B = op.B.bottomRightCorner(n - around, n - around);
    const Eigen::VectorXd expected = dense_values(inner).head(K);
    CHECK(expected(K - 1) > op.L.coeff(0, 0) / op.B.coeff(0, 0));
    for(const Solver solver : {by_block, by_dense}) {
      const Eigenpairs pairs = solver(op, K, {});
      CHECK(pairs.residuals.maxCoeff() < 1e-6);
      CHECK(pairs.vectors.topRows(around).isZero(0.));
      // A dense solver rounds to the largest eigenvalue, 1e10 times the least of these.
      CHECK(((pairs.values - expected).array().abs() / expected.array()).maxCoeff() < 1e-5);
      CHECK(orthonormality_error(op, pairs) < 1e-9);
    }
    CHECK_THROWS_WITH(SG::eigenpairs(op, n - around + 1), ContainsSubstring("off the border"));
  }
}

TEST_CASE("Many eigenvectors stay orthonormal", "[slow]")
{
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(4), 0.5);
  CHECK(orthonormality_error(op, SG::eigenpairs(op, 400)) < 1e-11);
}

TEST_CASE("Many pairs are found in slices of the spectrum, up to nearly all", "[slow]")
{
  // The rotations of a torus make nearly all eigenvalues double.
  for(const double theta : thetas) {
    const Laplace_operator op = laplace(shapes::torus_matrices(48, 32), theta);
    const Eigen::VectorXd expected = dense_values(op);
    for(const Eigen::Index K : {theta > 0. ? 501 : 700, 1480}) {
      INFO("K = " << K << ", theta = " << theta);
      const Eigenpairs pairs = SG::eigenpairs(op, K);
      CHECK(pairs.solver == "block");
      check_converged(op, pairs, expected);
    }
  }
}

TEST_CASE("Slices do not depend on the number of threads, report progress and can be cancelled",
          "[slow]")
{
  const Laplace_operator op = laplace(shapes::irregular_grid_matrices(45, 40), 0.5);
  SG::Eigenpairs_options options;
  std::vector<double> fractions;
  options.progress = [&](double fraction) { return fractions.push_back(fraction), true; };
  const Eigenpairs one = SG::eigenpairs(op, 520, options);
  check_pairs(op, one);
  CHECK(one.complete);
  CHECK(std::is_sorted(fractions.begin(), fractions.end()));
  CHECK(std::count_if(fractions.begin(), fractions.end(),
                      [](double f) { return f > 0.3 && f < 0.7; }) > 20);
  options.threads = 3;
  CHECK(SG::eigenpairs(op, 520, options).vectors == one.vectors);
  options.progress = [](double fraction) { return fraction < 0.5; };
  CHECK_THROWS_AS(SG::eigenpairs(op, 520, options), SG::Cancelled);
}

TEST_CASE("Slices of eigenvalues 0, 1, 2, ..., at which every shift may lie, and of many copies",
          "[slow]")
{
  const Eigen::Index n = 1600, K = 520;
  for(const int copies : {1, 7, 30}) { // of the values around the 200th
    INFO(copies << " copies");
    Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(n, 0., n - 1.);
    values.segment(200, copies).setConstant(200.);
    values.segment(400, copies).setConstant(400.);
    values *= 4. * shapes::pi / double(n);
    Laplace_operator op;
    op.L.resize(n, n);
    op.B.resize(n, n);
    op.L = values.asDiagonal();
    op.B.setIdentity();
    op.mass.setOnes(n);
    const SG::internal::Eigen_problem problem(op); // eigenpairs() would see n parts of it
    const SG::Eigenpairs_options options;
    if(copies > 8) // a block finds eight at a time: one space of all goes on until all are there
      CHECK_THROWS_AS(SG::internal::Spectrum_slices(problem, K, options).compute(),
                      SG::internal::Not_converged);
    check_converged(op, SG::internal::pairs_of_part(problem, K, options), values);
  }
}

TEST_CASE("Eigenvalues that are missing are counted")
{
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(3), 0.5);
  const SG::internal::Eigen_problem problem(op);
  const Eigen::VectorXd all = by_dense(op, 40, {}).values;
  for(const std::vector<int>& left_out : {std::vector<int>{}, {0}, {17}, {5, 6, 30}}) {
    std::vector<double> found;
    for(int k = 0; k < 40; ++k)
      if(std::find(left_out.begin(), left_out.end(), k) == left_out.end())
        found.push_back(all(k));
    const Eigen::Index missing =
        SG::internal::count_missing(problem, Eigen::VectorXd::Map(found.data(), found.size()), 2);
    CHECK(missing == static_cast<Eigen::Index>(left_out.size()));
  }
}

TEST_CASE("Further eigenvalues are the next ones, to a thousandth, and none is left out", "[slow]")
{
  const auto check = [](const SG::Laplace_operator& op, const Eigen::Index K,
                        const Eigen::Index least, const double tolerance = 1e-8) {
    const auto options = SG::Eigenpairs_options::with_tolerance(tolerance);
    const SG::Eigenpairs pairs = SG::eigenpairs(op, K, options);
    const Eigen::Index n = pairs.further_values.size();
    INFO(pairs.solver << ", K = " << K << ", further: " << n);
    CHECK(n >= least);
    CHECK(n <= K / 2);
    const Eigen::VectorXd known = pairs.all_values();
    REQUIRE(known.size() == K + n);
    const Eigen::VectorXd more = SG::eigenpairs(op, K + n, options).values;
    for(Eigen::Index k = 0; k < known.size(); ++k)
      CHECK(std::abs(known[k] - more[k]) <= 1e-3 * more[k] + 1e-6);
  };
  const shapes::Matrices waves = shapes::bumpy_icosphere_matrices(4),
                         small = shapes::bumpy_icosphere_matrices(2);
  const SG::Laplace_operator op = SG::laplace_operator(waves.V, waves.T);
  for(const Eigen::Index K : {1, 7, 15}) // the shift is below
    check(op, K, K / 3);
  for(const Eigen::Index K : {40, 100})
    check(op, K, K / 5);
  check(op, 100, 20, 1e-4);
  check(op, 100, 20, 1e-12);
  check(op, 600, 10);                                    // in slices
  check(SG::laplace_operator(small.V, small.T), 40, 20); // dense
  check(SG::laplace_operator(small.V, small.T), 161, 1); // all but one
  check(SG::laplace_operator(small.V, small.T), 162, 0);
  // Parts of different sizes: what one does not know another must not pass by.
  Eigen::MatrixXd V(waves.V.rows() + small.V.rows(), 3);
  V << waves.V, (0.6 * small.V).rowwise() + Eigen::RowVector3d(5, 0, 0);
  Eigen::MatrixXi F(waves.T.rows() + small.T.rows(), 3);
  F << waves.T, small.T.array() + int(waves.V.rows());
  for(const Eigen::Index K : {10, 60})
    check(SG::laplace_operator(V, F), K, 2);
}

TEST_CASE("Progress is reported in [0, 1] and can cancel")
{
  const Laplace_operator op = laplace(shapes::bumpy_icosphere_matrices(3));
  for(const Solver solver : {by_block, by_dense}) {
    std::vector<double> fractions;
    SG::Eigenpairs_options options;
    options.progress = [&](double fraction) { return fractions.push_back(fraction), true; };
    solver(op, 20, options);
    CHECK(std::is_sorted(fractions.begin(), fractions.end()));
    CHECK(fractions.front() == 0.);
    CHECK(fractions.back() == 1.);
    options.progress = [](double fraction) { return fraction < 0.5; };
    CHECK_THROWS_AS(solver(op, 20, options), SG::Cancelled);
  }
}

TEST_CASE("Bad requests for eigenpairs are refused")
{
  const Laplace_operator op = laplace(shapes::icosphere_matrices(1));
  CHECK_THROWS_WITH(SG::eigenpairs(op, 43),
                    ContainsSubstring("between 1 and") && ContainsSubstring("43"));
  CHECK_THROWS_AS(SG::eigenpairs(op, 0), std::invalid_argument);
  CHECK_THROWS_AS(SG::eigenpairs(op, -3), std::invalid_argument);
  SG::Eigenpairs_options options;
  options.tolerance = 0.;
  CHECK_THROWS_WITH(SG::eigenpairs(op, 5, options), ContainsSubstring("tolerance"));
  Laplace_operator broken = op;
  broken.mass.conservativeResize(7);
  CHECK_THROWS_AS(SG::eigenpairs(broken, 5), std::invalid_argument);
  broken = op;
  broken.mass *= 2.;
  CHECK_THROWS_WITH(SG::eigenpairs(broken, 5), ContainsSubstring("row sums of B"));
  broken = op;
  broken.mass(3) = 0.;
  CHECK_THROWS_AS(SG::eigenpairs(broken, 5), std::invalid_argument);
}

} // namespace test_eigenpairs
