// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "catch.h"
#include "shapes.h"

#include <CGAL/Spectral_toolbox/functional_map_estimation.h>
#include <CGAL/Spectral_toolbox/hierarchical_functional_maps.h>
#include <CGAL/Spectral_toolbox/spectral_distances.h>
#include <CGAL/Spectral_toolbox/vertex_maps.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Cholesky>
#include <Eigen/SVD>

namespace test_shape_matching {

namespace {

using Index = Eigen::Index;
using Map = std::vector<Index>;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

Eigen::MatrixXd random_matrix(Index rows, Index columns, unsigned seed)
{
  std::mt19937 random(seed);
  Eigen::MatrixXd A(rows, columns);
  for(Index i = 0; i < rows; ++i)
    for(Index j = 0; j < columns; ++j)
      A(i, j) = static_cast<double>(random() % 2001) / 1000 - 1;
  return A;
}

Map random_permutation(Index n, unsigned seed)
{
  std::mt19937 random(seed);
  Map p(static_cast<std::size_t>(n));
  std::iota(p.begin(), p.end(), Index(0));
  for(std::size_t i = p.size(); i > 1; --i)
    std::swap(p[i - 1], p[random() % i]);
  return p;
}

SG::Spectral_shape shape_of(const shapes::Matrices& mesh, Index K)
{
  SG::Spectral_shape shape;
  shape.T = mesh.T;
  shape.op = SG::laplace_operator(mesh.V, mesh.T, 0.5);
  const double area = shape.op.mass.sum();
  shape.op.B /= area;
  shape.op.mass /= area;
  shape.pairs = SG::eigenpairs(shape.op, K);
  return shape;
}

struct Simplified_shape
{
  SG::Spectral_shape fine, coarse;
  Eigen::SparseMatrix<double> P;
  std::vector<std::size_t> vertex_map;
  Eigen::MatrixXd C; // fine to coarse
};

Simplified_shape simplified(const shapes::Matrices& matrices, std::size_t N, Index K)
{
  Mesh mesh;
  shapes::make_mesh(mesh, matrices);
  SMS::Spectral_edge_collapse_options options = SMS::Spectral_edge_collapse_options::paper();
  options.number_of_eigenvectors = K;
  options.mass = SG::Mass::averaged;
  options.binary = true;
  const auto result = SMS::spectral_edge_collapse(mesh, N, options);
  Simplified_shape s;
  s.P = result.restriction;
  s.vertex_map = result.vertex_map;
  s.fine = shape_of(matrices, K);
  s.coarse = shape_of(SG::mesh_matrices(mesh), K);
  s.C = SG::functional_map(s.coarse.pairs.vectors, s.coarse.op.B, s.P, s.fine.pairs.vectors);
  return s;
}

// Carries the known map (for each vertex of Y one of X) to the coarse meshes and lifts it back;
// returns the mean distance of where the vertices of Y end on X from where they belong, in square
// roots of the area.
double error_of_lift(const shapes::Matrices& X, const shapes::Matrices& Y, const Map& truth)
{
  const Index K = 30;
  const Simplified_shape x = simplified(X, 300, K), y = simplified(Y, 300, K);
  Map coarse(static_cast<std::size_t>(y.P.rows()));
  for(Index j = 0; j < y.P.cols(); ++j)
    for(Eigen::SparseMatrix<double>::InnerIterator it(y.P, j); it; ++it)
      coarse[static_cast<std::size_t>(it.row())] = static_cast<Index>(
          x.vertex_map[static_cast<std::size_t>(truth[static_cast<std::size_t>(j)])]);
  const Eigen::MatrixXd C = SG::functional_map_of_vertex_map(
      x.coarse.pairs.vectors, y.coarse.pairs.vectors, y.coarse.op.B, coarse);
  const SG::Lifted_functional_map lifted = SG::lift_functional_map(x.C, C, y.C);
  CHECK(lifted.rank == K);
  CHECK(lifted.condition < 2);
  CHECK(lifted.relative_residual < 1e-10); // as many rows as columns
  const Map found = SG::target_to_source_map(lifted.C, x.fine.pairs.vectors, y.fine.pairs.vectors);
  double sum = 0;
  for(std::size_t i = 0; i < truth.size(); ++i)
    sum += (X.V.row(found[i]) - X.V.row(truth[i])).norm();
  return sum / static_cast<double>(truth.size()) /
         std::sqrt(SG::laplace_operator(X.V, X.T).mass.sum());
}

Map identity(Index n)
{
  Map result(static_cast<std::size_t>(n));
  std::iota(result.begin(), result.end(), Index(0));
  return result;
}

} // namespace

TEST_CASE("A lifted map solves the system of the paper")
{
  const Index k = 12;
  const Eigen::MatrixXd wanted = random_matrix(k, k, 1);
  const Eigen::MatrixXd to_Y = Eigen::MatrixXd::Identity(15, k) + 0.1 * random_matrix(15, k, 2);
  const Eigen::MatrixXd to_X = Eigen::MatrixXd::Identity(k, k) + 0.1 * random_matrix(k, k, 3);
  const Eigen::MatrixXd coarse = to_Y * wanted * to_X.inverse();
  const SG::Lifted_functional_map lifted = SG::lift_functional_map(to_X, coarse, to_Y);
  CHECK((lifted.C - wanted).norm() < 1e-12 * wanted.norm());
  CHECK(lifted.rank == k);
  CHECK(lifted.relative_residual < 1e-13);
  const Eigen::VectorXd sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(to_Y).singularValues();
  CHECK(lifted.condition == Approx(sigma(0) / sigma(k - 1)));
}

TEST_CASE("A mode that the coarse target has lost is left out of a lifted map")
{
  const Index k = 8;
  Eigen::MatrixXd to_Y = Eigen::MatrixXd::Identity(k, k);
  to_Y(k - 1, k - 1) = 1e-3;
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(k, k), coarse = random_matrix(k, k, 4);
  const SG::Lifted_functional_map lifted = SG::lift_functional_map(I, coarse, to_Y);
  CHECK(lifted.rank == k - 1);
  CHECK(lifted.condition == Approx(1e3));
  CHECK(lifted.C.row(k - 1).norm() < 1e-12);
  CHECK((lifted.C.topRows(k - 1) - coarse.topRows(k - 1)).norm() < 1e-12);
  CHECK(lifted.relative_residual == Approx(coarse.row(k - 1).norm() / coarse.norm()));
  CHECK(SG::lift_functional_map(I, coarse, to_Y, 0.).rank == k);
  to_Y(k - 1, k - 1) = 0;
  CHECK(std::isinf(SG::lift_functional_map(I, coarse, to_Y).condition));
  CHECK_THROWS_AS(SG::lift_functional_map(I, coarse.leftCols(5), to_Y), std::invalid_argument);
  CHECK_THROWS_AS(SG::lift_functional_map(I, coarse, to_Y, 1.), std::invalid_argument);
  to_Y(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(SG::lift_functional_map(I, coarse, to_Y), std::invalid_argument);
}

TEST_CASE("Nearest rows are those of a search through all of them")
{
  const Eigen::MatrixXd points = random_matrix(300, 7, 5), queries = random_matrix(101, 7, 6);
  const Map found = SG::nearest_rows(points, queries);
  for(Index i = 0; i < queries.rows(); ++i) {
    const double least = (points.rowwise() - queries.row(i)).rowwise().squaredNorm().minCoeff();
    CHECK((points.row(found[static_cast<std::size_t>(i)]) - queries.row(i)).squaredNorm() ==
          Approx(least));
  }
  CHECK(SG::nearest_rows(points, queries, {3}) == found);
  CHECK(SG::nearest_rows(points, queries.topRows(2), {5}) == Map(found.begin(), found.begin() + 2));
  CHECK_THROWS_AS(SG::nearest_rows(points, queries.leftCols(3)), std::invalid_argument);
  CHECK_THROWS_AS(SG::nearest_rows(points.topRows(0), queries), std::invalid_argument);
  CHECK_THROWS_AS(SG::nearest_rows(points, queries, {0}), std::invalid_argument);
  for(const int threads : {1, 3}) {
    std::atomic<int> calls{0};
    const auto stop = [&](double) { return ++calls < 20; };
    CHECK_THROWS_AS(SG::nearest_rows(points, queries, {threads, stop}), SG::Cancelled);
    CHECK(calls < 20 + threads);
    CHECK(SG::nearest_rows(points, queries, {threads, [](double) { return true; }}) == found);
  }
}

TEST_CASE("Nearest rows in many dimensions: the first of those that are equally near, whatever was "
          "found before")
{
  // A curve, as eigenvectors of low frequency embed it, in noise; every point twice.
  const Index n = 700, dimension = 60;
  Eigen::MatrixXd points = 0.02 * random_matrix(2 * n, dimension, 8), queries;
  for(Index i = 0; i < 2 * n; ++i)
    for(Index k = 0; k < dimension; ++k)
      points(i, k) += std::cos(double(k + 1) * double(i % n) / double(n));
  points.bottomRows(n) = points.topRows(n);
  queries = points + 0.05 * random_matrix(2 * n, dimension, 9);
  queries.topRows(100) = points.bottomRows(100); // without any distance
  const Map found = SG::nearest_rows(points, queries);
  for(Index i = 0; i < queries.rows(); ++i) {
    Index first;
    (points.rowwise() - queries.row(i)).rowwise().squaredNorm().minCoeff(&first);
    CHECK(found[static_cast<std::size_t>(i)] == first);
  }
  const Map p = random_permutation(queries.rows(), 10);
  Eigen::MatrixXd shuffled(queries.rows(), dimension);
  for(Index i = 0; i < queries.rows(); ++i)
    shuffled.row(i) = queries.row(p[static_cast<std::size_t>(i)]);
  const Map again = SG::nearest_rows(points, shuffled, {2});
  for(std::size_t i = 0; i < p.size(); ++i)
    CHECK(again[i] == found[static_cast<std::size_t>(p[i])]);
  const Eigen::MatrixXd one_place = Eigen::MatrixXd::Ones(40, 3);
  CHECK(SG::nearest_rows(one_place, one_place) == Map(40, 0));
}

TEST_CASE("A permutation goes through its functional map and back")
{
  const shapes::Matrices X = shapes::pebble_matrices(shapes::icosphere_matrices(3));
  const Map p = random_permutation(X.V.rows(), 7);
  const SG::Spectral_shape x = shape_of(X, 40), y = shape_of(shapes::permuted(X, p), 40);
  const Eigen::MatrixXd C =
      SG::functional_map_of_vertex_map(x.pairs.vectors, y.pairs.vectors, y.op.B, p);
  CHECK((C.transpose() * C - Eigen::MatrixXd::Identity(40, 40)).norm() < 1e-7);
  CHECK(SG::laplacian_commutativity_norm(C, x.pairs.values, y.pairs.values) <
        1e-5 * x.pairs.values(39));
  CHECK(SG::target_to_source_map(C, x.pairs.vectors, y.pairs.vectors) == p);
  Map inverse(p.size());
  for(std::size_t i = 0; i < p.size(); ++i)
    inverse[static_cast<std::size_t>(p[i])] = static_cast<Index>(i);
  CHECK(SG::target_to_source_map(C.transpose(), y.pairs.vectors, x.pairs.vectors) == inverse);
  Map wrong = p;
  wrong[3] = X.V.rows();
  CHECK_THROWS_AS(SG::functional_map_of_vertex_map(x.pairs.vectors, y.pairs.vectors, y.op.B, wrong),
                  std::invalid_argument);
  CHECK_THROWS_AS(SG::target_to_source_map(C, x.pairs.vectors.leftCols(39), y.pairs.vectors),
                  std::invalid_argument);

  const Eigen::SparseMatrix<double> points =
      SG::target_to_source_points(C, x.pairs.vectors, x.T, y.pairs.vectors);
  CHECK((points * Eigen::VectorXd::Ones(points.cols()) - Eigen::VectorXd::Ones(points.rows()))
            .norm() < 1e-10);
  // An embedded vertex may lie closer to a face through rounding only.
  CHECK((points * X.V - shapes::permuted(X, p).V).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("Points of faces are closer than vertices")
{
  const shapes::Matrices X = shapes::pebble_matrices(shapes::icosphere_matrices(2)),
                         Y = shapes::pebble_matrices(shapes::icosphere_matrices(4));
  const SG::Spectral_shape x = shape_of(X, 15), y = shape_of(Y, 15);
  // The first vertices of the finer sphere are those of the coarser: the map is known there.
  const Eigen::MatrixXd at_vertices = y.pairs.vectors.topRows(X.V.rows());
  const Eigen::MatrixXd C = (x.pairs.vectors.transpose() * x.op.B) * at_vertices; // from Y to X
  const Eigen::MatrixXd from_X = C.transpose();
  const auto points = SG::target_to_source_points(from_X, x.pairs.vectors, x.T, y.pairs.vectors);
  const Map vertices = SG::target_to_source_map(from_X, x.pairs.vectors, y.pairs.vectors);
  // No point of the face, and no vertex, is closer to the query: the way there begins with a step
  // that does not come closer.
  const Eigen::MatrixXd embedded = x.pairs.vectors * from_X.transpose(),
                        nearest = points * embedded - y.pairs.vectors;
  for(Index i = 0; i < Y.V.rows(); ++i) {
    const Eigen::VectorXd away = nearest.row(i), from = nearest.row(i) + y.pairs.vectors.row(i);
    for(Index v = 0; v < points.cols(); ++v)
      if(points.coeff(i, v) != 0)
        CHECK(std::abs((embedded.row(v).transpose() - from).dot(away)) <
              1e-10 * embedded.row(v).squaredNorm());
    CHECK(away.squaredNorm() <=
          (embedded.rowwise() - y.pairs.vectors.row(i)).rowwise().squaredNorm().minCoeff() *
              (1 + 1e-12));
  }
  double of_points = 0, of_vertices = 0;
  const Eigen::MatrixXd placed = points * X.V;
  for(Index i = 0; i < Y.V.rows(); ++i) {
    of_points += (placed.row(i) - Y.V.row(i)).norm();
    of_vertices += (X.V.row(vertices[static_cast<std::size_t>(i)]) - Y.V.row(i)).norm();
  }
  CHECK(of_points < 0.5 * of_vertices);
}

TEST_CASE("Hierarchical maps of pairs whose map is known")
{
  const shapes::Matrices X = shapes::pebble_matrices(shapes::icosphere_matrices(4));
  SECTION("a permutation of the vertices")
  {
    const Map p = random_permutation(X.V.rows(), 8);
    CHECK(error_of_lift(X, shapes::permuted(X, p), p) < 0.03);
  }
  SECTION("a rigid copy")
  {
    shapes::Matrices Y = X;
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    Y.V = (X.V * R.transpose()).rowwise() + Eigen::RowVector3d(3, -2, 5);
    CHECK(error_of_lift(X, Y, identity(X.V.rows())) < 0.03);
  }
  SECTION("a remeshed copy")
  {
    shapes::Matrices sphere = shapes::icosphere_matrices(4);
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, -1, 2).normalized()).toRotationMatrix();
    sphere.V = sphere.V * R.transpose();
    const shapes::Matrices Y = shapes::pebble_matrices(sphere);
    CHECK(error_of_lift(X, Y, SG::nearest_rows(X.V, Y.V)) < 0.04);
  }
  SECTION("a bend")
  {
    shapes::Matrices Y = X;
    for(Index i = 0; i < Y.V.rows(); ++i) {
      const double angle = 0.2 * X.V(i, 0), radius = 5 - X.V(i, 1);
      Y.V.row(i) << radius * std::sin(angle), 5 - radius * std::cos(angle), X.V(i, 2);
    }
    CHECK(error_of_lift(X, Y, identity(X.V.rows())) < 0.04);
  }
}

TEST_CASE("The orientation operator turns with the orientation")
{
  const shapes::Matrices X = shapes::pebble_matrices(shapes::icosphere_matrices(3));
  const SG::Spectral_shape x = shape_of(X, 10);
  const Eigen::VectorXd f = X.V.col(0) + 0.3 * X.V.col(1).cwiseAbs2();
  const Eigen::MatrixXd O = SG::orientation_operator(X.T, x.pairs.vectors, f);
  CHECK(O.norm() > 0.1);
  CHECK((O + O.transpose()).norm() < 1e-10 * O.norm());
  Eigen::MatrixXi mirrored = X.T;
  mirrored.col(0).swap(mirrored.col(1));
  CHECK((SG::orientation_operator(mirrored, x.pairs.vectors, f) + O).norm() < 1e-12 * O.norm());
  CHECK(SG::orientation_operator(X.T, x.pairs.vectors, Eigen::VectorXd::Ones(f.size())).norm() <
        1e-12);

  // On a flat square n . (grad x cross grad y) = 1.
  const shapes::Matrices square = shapes::grid_matrices(4, 4);
  const Eigen::MatrixXd xy = square.V.leftCols(2);
  const Eigen::MatrixXd flat = SG::orientation_operator(square.T, xy, square.V.col(0));
  CHECK(flat(0, 1) == Approx(0.5)); // the integral of x
  CHECK(flat(1, 1) == Approx(0.5)); // the integral of y
  CHECK(std::abs(flat(0, 0)) < 1e-14);
}

TEST_CASE("Descriptors find a permutation, and ZoomOut all of its modes")
{
  const shapes::Matrices X = shapes::pebble_matrices(shapes::icosphere_matrices(3));
  const Map p = random_permutation(X.V.rows(), 9);
  const SG::Spectral_shape x = shape_of(X, 40), y = shape_of(shapes::permuted(X, p), 40);
  const Eigen::VectorXd times = SG::heat_kernel_times(x.pairs, 10);
  const Eigen::MatrixXd f = SG::heat_kernel_signature(x.pairs, times),
                        g = SG::heat_kernel_signature(y.pairs, times);
  const Eigen::MatrixXd wanted =
      SG::functional_map_of_vertex_map(x.pairs.vectors, y.pairs.vectors, y.op.B, p);
  const Eigen::MatrixXd C = SG::functional_map_of_descriptors(x, y, f, g, 12);
  CHECK((C - wanted.topLeftCorner(12, 12)).norm() < 1e-4);
  const Eigen::MatrixXd refined = SG::zoom_out(C, x, y, 40, 7);
  CHECK(SG::zoom_out(C, x, y, 40, (std::numeric_limits<Eigen::Index>::max)()) ==
        SG::zoom_out(C, x, y, 40, 40)); // at once
  CHECK((refined - wanted).norm() < 1e-3);
  CHECK(SG::target_to_source_map(refined, x.pairs.vectors, y.pairs.vectors) == p);
  CHECK_THROWS_AS(SG::zoom_out(C, x, y, 41), std::invalid_argument);
  CHECK_THROWS_AS(SG::zoom_out(C, x, y, 11), std::invalid_argument);
  CHECK_THROWS_AS(SG::functional_map_of_descriptors(x, y, f, g.leftCols(9), 12),
                  std::invalid_argument);

  // Constants say nothing of the other modes, and commutativity nothing of equal eigenvalues.
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(f.rows(), 1);
  CHECK_THROWS_WITH(SG::functional_map_of_descriptors(x, y, ones, ones, 12),
                    ContainsSubstring("do not determine"));
  CHECK_THROWS_WITH(
      SG::functional_map_of_descriptors(x, y, f.leftCols(0), g.leftCols(0), 12, {0.1, 0., 0.}),
      ContainsSubstring("do not determine"));

  // One descriptor of different size on the two shapes, nothing else but a little commutativity:
  // the minimum by hand.
  const SG::Functional_map_weights weights{1e-2, 0., 0.};
  const Eigen::MatrixXd two = f.leftCols(4) * Eigen::Vector4d(1., 2., 3., 4.).asDiagonal();
  Eigen::MatrixXd other = 3. * g.leftCols(4);
  other.col(2) += g.col(9);
  const Eigen::MatrixXd D = SG::functional_map_of_descriptors(x, y, two, other, 3, weights);
  const auto objective = [&](const Eigen::MatrixXd& map) {
    double sum = 0.;
    for(Index i = 0; i < 4; ++i) {
      const Eigen::VectorXd a = x.pairs.vectors.leftCols(3).transpose() * (x.op.B * two.col(i)),
                            b = y.pairs.vectors.leftCols(3).transpose() * (y.op.B * other.col(i));
      sum += 0.25 * 2. * (map * a - b).squaredNorm() / (a.squaredNorm() + b.squaredNorm());
    }
    const double largest = std::max(x.pairs.values(2), y.pairs.values(2));
    return sum + weights.commutativity * (map * x.pairs.values.head(3).asDiagonal() / largest -
                                          y.pairs.values.head(3).asDiagonal() * map / largest)
                                             .squaredNorm();
  };
  for(Index j = 0; j < 3; ++j)
    for(Index l = 0; l < 3; ++l) {
      Eigen::MatrixXd step = Eigen::MatrixXd::Zero(3, 3);
      step(j, l) = 1e-3;
      CHECK(objective(D + step) ==
            Approx(objective(D - step)).epsilon(1e-6)); // a parabola about its minimum
    }

  // The scores from their definition, with the kernels written out.
  const double t = 0.01;
  const auto kernel = [t](const SG::Spectral_shape& s) {
    const Eigen::MatrixXd decay = (-t * s.pairs.values.array()).exp().matrix().asDiagonal();
    return Eigen::MatrixXd(s.pairs.vectors * decay * s.pairs.vectors.transpose());
  };
  Eigen::MatrixXd carried(y.op.B.rows(), x.op.B.rows());
  const Eigen::MatrixXd kernel_X = kernel(x);
  for(Index i = 0; i < carried.rows(); ++i)
    carried.row(i) = kernel_X.row(p[static_cast<std::size_t>(i)]);
  const Eigen::MatrixXd slow = kernel(y) * (y.op.B * carried);
  const Eigen::MatrixXd fast = SG::product_manifold_scores(wanted, x, y, t);
  CHECK((slow - fast).norm() < 1e-6 * slow.norm());
  CHECK_THROWS_AS(SG::product_manifold_scores(wanted, x, y, -1.), std::invalid_argument);
}

TEST_CASE("The orthogonal map nearest to another is the one of its polar decomposition")
{
  const Eigen::MatrixXd C = (Eigen::MatrixXd(3, 3) << 1, 2, 0, -1, 3, 0.5, 0, 1, -2).finished();
  const Eigen::MatrixXd R = SG::nearest_orthogonal_map(C), S = R.transpose() * C;
  CHECK((R.transpose() * R - Eigen::MatrixXd::Identity(3, 3)).norm() < 1e-14);
  CHECK((S - S.transpose()).norm() < 1e-14);
  CHECK(Eigen::LLT<Eigen::MatrixXd>(S).info() == Eigen::Success); // positive definite
  CHECK_THROWS_AS(SG::nearest_orthogonal_map(Eigen::MatrixXd::Ones(2, 3)), std::invalid_argument);
}

} // namespace test_shape_matching
