// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Operators with coefficients and masses of other kinds: against slow assembly, closed forms, and
// the global E.

#include "catch.h"
#include "core_helpers.h"
#include "relocation_helpers.h"

#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Spectral_geometry/operator_coefficients.h>
#include <CGAL/Spectral_geometry/relocation_energy.h>

#include <Eigen/Dense>

namespace test_local_operator {

using namespace spectral_test;

namespace {

constexpr double pi = 3.14159265358979323846;

// Smooth, between a third and three.
Eigen::VectorXd bumps(const Eigen::MatrixXd& V, const double phase)
{
  const Eigen::RowVector3d middle = V.colwise().mean();
  const double size = (V.rowwise() - middle).rowwise().norm().maxCoeff();
  return ((V * Eigen::Vector3d(2, -1.5, 1) / size).array() + phase).sin().exp().matrix();
}

// Every vertex has axes of its own.
Eigen::MatrixXd tensors(const Eigen::MatrixXd& V)
{
  Eigen::MatrixXd D(V.rows(), 6);
  for(Eigen::Index v = 0; v < V.rows(); ++v) {
    const Eigen::Vector3d axis =
        Eigen::Vector3d(std::sin(2 * V(v, 0) + 1), std::cos(3 * V(v, 1)), 0.5 + V(v, 2))
            .normalized();
    const Eigen::Matrix3d d = 0.5 * Eigen::Matrix3d::Identity() + 2.5 * axis * axis.transpose();
    D.row(v) << d(0, 0), d(0, 1), d(0, 2), d(1, 1), d(1, 2), d(2, 2);
  }
  return D;
}

enum class Kind_of_operator { voronoi, weighted, anisotropic, anisotropic_voronoi, dirichlet };

SG::Local_operator operator_on(const Eigen::MatrixXd& V, const Kind_of_operator kind,
                               const SG::Mass mass)
{
  const Eigen::VectorXd density = bumps(V, 0.3);
  switch(kind) {
  case Kind_of_operator::voronoi:
    return SG::Local_operator(SG::Mass::voronoi);
  case Kind_of_operator::weighted:
    return {mass, SG::weighted_coefficients(density, bumps(V, 2))};
  case Kind_of_operator::anisotropic:
    return {mass, SG::anisotropic_coefficients(tensors(V), density)};
  case Kind_of_operator::dirichlet:
    return {mass, SG::weighted_coefficients(density, bumps(V, 2)),
            SG::Boundary_condition::dirichlet};
  default:
    return {SG::Mass::voronoi, SG::anisotropic_coefficients(tensors(V), density)};
  }
}

// Integrals of products of hat functions and their gradients.
struct Slow_operator
{
  Eigen::MatrixXd L, B;
};

Slow_operator slow_operator(const shapes::Matrices& mesh, const SG::Local_operator& op)
{
  const Eigen::Index n = mesh.V.rows();
  Slow_operator result{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f) {
    const Eigen::Vector3i t = mesh.T.row(f);
    const Eigen::Vector3d p = mesh.V.row(t(0)), q = mesh.V.row(t(1)), r = mesh.V.row(t(2));
    const Eigen::Vector3d normal = (q - p).cross(r - p);
    const double area = normal.norm() / 2;
    Eigen::Matrix3d frame, D = Eigen::Matrix3d::Identity(), gradient;
    frame << (q - p).transpose(), (r - p).transpose(), normal.transpose();
    double density = 1;
    if(op.coefficients.rows() != 0) {
      const Eigen::VectorXd c =
          (op.coefficients.row(t(0)) + op.coefficients.row(t(1)) + op.coefficients.row(t(2)))
              .transpose() /
          3;
      D << c(1), c(2), c(3), c(2), c(4), c(5), c(3), c(5), c(6);
      density = c(0);
    }
    for(int k = 0; k < 3;
        ++k) { // the rise of the hat at corner k along two edges, and none along the normal
      const Eigen::Vector3d rise(double(k == 1) - double(k == 0), double(k == 2) - double(k == 0),
                                 0);
      gradient.col(k) = frame.fullPivLu().solve(rise);
    }
    for(int i = 0; i < 3; ++i)
      for(int j = 0; j < 3; ++j) {
        result.L(t(i), t(j)) += area * gradient.col(i).dot(D * gradient.col(j));
        result.B(t(i), t(j)) +=
            density * area *
            (op.theta * (i == j ? 2. : 1.) / 12 + (i == j ? (1 - op.theta) / 3 : 0.));
      }
  }
  return result;
}

// The parts of a triangle nearest to each corner, cut out by the bisectors of its edges.
Eigen::Vector3d areas_by_bisectors(const Eigen::Vector3d (&p)[3])
{
  const auto area = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                       const Eigen::Vector3d& c) { return (b - a).cross(c - a).norm() / 2; };
  for(int k = 0; k < 3; ++k)
    if((p[(k + 1) % 3] - p[k]).dot(p[(k + 2) % 3] - p[k]) < 0) {
      Eigen::Vector3d result = Eigen::Vector3d::Constant(area(p[0], p[1], p[2]) / 4);
      result(k) *= 2;
      return result;
    }
  const Eigen::Vector3d a = p[1] - p[0], b = p[2] - p[0], n = a.cross(b);
  const Eigen::Vector3d centre =
      p[0] + (a.squaredNorm() * b.cross(n) + b.squaredNorm() * n.cross(a)) / (2 * n.squaredNorm());
  Eigen::Vector3d result;
  for(int k = 0; k < 3; ++k)
    result(k) = area(p[k], (p[k] + p[(k + 1) % 3]) / 2, centre) +
                area(p[k], centre, (p[k] + p[(k + 2) % 3]) / 2);
  return result;
}

SMS::Spectral_edge_collapse_options options_of(const SG::Local_operator& op, const SG::Mass mass,
                                               const Eigen::Index K)
{
  SMS::Spectral_edge_collapse_options options;
  options.mass = mass;
  options.coefficients = op.coefficients;
  options.number_of_eigenvectors = K;
  return options;
}

double norm_of(const shapes::Matrices& fine, const SG::Local_operator& op, const Mesh& mesh,
               const Eigen::SparseMatrix<double>& P, const Eigen::Index K)
{
  const SG::Mesh_matrices coarse = SG::mesh_matrices(mesh);
  const SG::Laplace_operator fine_op = SG::laplace_operator(fine.V, fine.T, op),
                             coarse_op = SG::laplace_operator(coarse.V, coarse.T, op.restricted(P));
  return SG::evaluate_spectrum(fine_op, SG::eigenpairs(fine_op, K + K / 10), coarse_op,
                               SG::eigenpairs(coarse_op, K + K / 10), P, K)
      .norm_L;
}

} // namespace

TEST_CASE("Stiffness and mass with coefficients are the integrals of hat functions")
{
  const auto kind = GENERATE(Kind_of_operator::weighted, Kind_of_operator::anisotropic);
  const SG::Mass mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  CAPTURE(int(kind), SG::mass_name(mass));
  for(const shapes::Matrices& mesh :
      {shapes::bumpy_icosphere_matrices(1), wavy_grid_matrices(9, 8)}) {
    const SG::Local_operator local = operator_on(mesh.V, kind, mass);
    const SG::Laplace_operator op = SG::laplace_operator(mesh.V, mesh.T, local);
    const Slow_operator slow = slow_operator(mesh, local);
    CHECK((Eigen::MatrixXd(op.L) - slow.L).norm() < 1e-13 * slow.L.norm());
    CHECK((Eigen::MatrixXd(op.B) - slow.B).norm() < 1e-13 * slow.B.norm());
    CHECK((op.mass - slow.B.rowwise().sum()).norm() < 1e-13 * op.mass.norm());
    CHECK(SG::number_of_zero_eigenvalues(op) == 1);
  }
  for(const double unit : {1e-120, 1e13}) { // which is no needle, and no singular tensor
    const shapes::Matrices grid = wavy_grid_matrices(5, 5);
    const Eigen::VectorXd c = Eigen::VectorXd::Constant(grid.V.rows(), unit);
    CHECK(SG::laplace_operator(grid.V, grid.T, {mass, SG::weighted_coefficients({}, c)}).L.norm() >
          unit);
  }
  // A conductivity of one number is that number times the cotangents.
  const shapes::Matrices mesh = wavy_grid_matrices(9, 8);
  const Eigen::VectorXd three = Eigen::VectorXd::Constant(mesh.V.rows(), 3.);
  const SG::Laplace_operator plain = SG::laplace_operator(mesh.V, mesh.T, mass),
                             scaled_op = SG::laplace_operator(
                                 mesh.V, mesh.T, {mass, SG::weighted_coefficients({}, three)});
  CHECK((scaled_op.L - 3 * plain.L).norm() < 1e-13 * plain.L.norm());
  CHECK((scaled_op.B - plain.B).norm() < 1e-15);
}

TEST_CASE("Mixed Voronoi areas are those that bisectors cut out, half and quarters where obtuse")
{
  int obtuse = 0, acute = 0;
  for(const shapes::Matrices& mesh :
      {shapes::irregular_grid_matrices(9, 8), shapes::bumpy_icosphere_matrices(1)}) {
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(mesh.V.rows());
    for(Eigen::Index f = 0; f < mesh.T.rows(); ++f) {
      const Eigen::Vector3d p[3] = {mesh.V.row(mesh.T(f, 0)), mesh.V.row(mesh.T(f, 1)),
                                    mesh.V.row(mesh.T(f, 2))};
      const Eigen::Vector3d areas = areas_by_bisectors(p);
      ++(areas.maxCoeff() > 0.4999 * areas.sum() ? obtuse : acute);
      for(int k = 0; k < 3; ++k)
        expected(mesh.T(f, k)) += areas(k);
    }
    const SG::Laplace_operator op = SG::laplace_operator(mesh.V, mesh.T, SG::Mass::voronoi);
    CHECK((op.mass - expected).cwiseAbs().maxCoeff() < 1e-13 * expected.maxCoeff());
    CHECK(op.voronoi);
    CHECK((op.L - SG::laplace_operator(mesh.V, mesh.T).L).norm() == 0);
  }
  CHECK(obtuse > 5);
  CHECK(acute > 20);
}

TEST_CASE("Eigenvalues with coefficients are those of closed forms")
{
  SECTION("density and conductivity e^{2 a x} on a square")
  {
    // u'' + 2 a u' + lambda u = 0 with u' = 0 at both ends: 0, and a^2 + (k pi)^2.
    const double a = 1.5;
    const shapes::Matrices mesh = shapes::grid_matrices(60, 60);
    const Eigen::VectorXd weight = (2 * a * mesh.V.col(0)).array().exp();
    const SG::Laplace_operator op = SG::laplace_operator(
        mesh.V, mesh.T, {SG::Mass::averaged, SG::weighted_coefficients(weight, weight)});
    std::vector<double> expected;
    for(int k = 0; k < 5; ++k)
      for(int m = 0; m < 5; ++m)
        expected.push_back((k == 0 ? 0. : a * a + k * k * pi * pi) + m * m * pi * pi);
    std::sort(expected.begin(), expected.end());
    const SG::Eigenpairs pairs = SG::eigenpairs(op, 9);
    CHECK(pairs.values(0) < 1e-9);
    for(int k = 1; k < 9; ++k)
      CHECK(relative_difference(pairs.values(k), expected[std::size_t(k)]) < 4e-3);
  }
  SECTION("a tensor on a stretched sphere that undoes the stretching")
  {
    const shapes::Matrices sphere = shapes::icosphere_matrices(4);
    const Eigen::Matrix3d S = Eigen::Vector3d(1, 1.5, 2.5).asDiagonal();
    const shapes::Matrices mesh{sphere.V * S, sphere.T};
    Eigen::MatrixXd D(mesh.V.rows(), 6);
    Eigen::VectorXd density(mesh.V.rows());
    for(Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
      // x -> S x: gradients turn by S, areas grow by det S |S^-1 n|.
      const Eigen::Vector3d n = sphere.V.row(v), m = S.inverse() * n;
      const double growth = S.determinant() * m.norm();
      const Eigen::Matrix3d d = (S * (Eigen::Matrix3d::Identity() - n * n.transpose()) * S +
                                 m.normalized() * m.normalized().transpose()) /
                                growth;
      D.row(v) << d(0, 0), d(0, 1), d(0, 2), d(1, 1), d(1, 2), d(2, 2);
      density(v) = 1 / growth;
    }
    const auto values = [&](const SG::Operator_coefficients& c) {
      return SG::eigenpairs(SG::laplace_operator(mesh.V, mesh.T, {SG::Mass::averaged, c}), 16)
          .values;
    };
    const Eigen::VectorXd undone = values(SG::anisotropic_coefficients(D, density)),
                          stretched = values({});
    for(int k = 1; k < 16; ++k) {
      const int l = k < 4 ? 1 : k < 9 ? 2 : 3;
      CHECK(relative_difference(undone(k), l * (l + 1.)) < 0.01);
    }
    CHECK(relative_difference(stretched(1), 2.) > 0.3);
  }
  SECTION("motion and scale, with the axes of the tensors")
  {
    const shapes::Matrices mesh = wavy_grid_matrices(12, 10);
    const SG::Local_operator local =
        operator_on(mesh.V, Kind_of_operator::anisotropic, SG::Mass::averaged);
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    SG::Local_operator moved = local;
    for(Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
      const Eigen::Matrix3d D =
          R * SG::internal::conductivity(local.coefficients.row(v).transpose()) * R.transpose();
      moved.coefficients.row(v).tail<6>() << D(0, 0), D(0, 1), D(0, 2), D(1, 1), D(1, 2), D(2, 2);
    }
    const Eigen::MatrixXd V = (3 * mesh.V * R.transpose()).rowwise() + Eigen::RowVector3d(4, 5, 6);
    const SG::Laplace_operator one = SG::laplace_operator(mesh.V, mesh.T, local),
                               two = SG::laplace_operator(V, mesh.T, moved);
    CHECK((one.L - two.L).norm() < 1e-11 * one.L.norm());
    CHECK((9 * one.B - two.B).norm() < 1e-11 * two.B.norm());
  }
  SECTION("units")
  {
    const shapes::Matrices mesh = wavy_grid_matrices(12, 10);
    const SG::Local_operator local =
        operator_on(mesh.V, Kind_of_operator::anisotropic, SG::Mass::averaged);
    SG::Local_operator other = local;
    other.coefficients.rightCols<6>() *= 1e5;
    other.coefficients.col(0) *= 10;
    const Eigen::VectorXd one =
        SG::eigenpairs(SG::laplace_operator(mesh.V, mesh.T, local), 10).values;
    const Eigen::VectorXd two =
        SG::eigenpairs(SG::laplace_operator(mesh.V, mesh.T, other), 10).values;
    CHECK((two / 1e4 - one).norm() < 1e-8 * one.norm());
  }
}

TEST_CASE("With the Dirichlet condition functions vanish on the border, of the input and of what "
          "is left of it")
{
  const SG::Boundary_condition dirichlet = SG::Boundary_condition::dirichlet;
  const SG::Mass mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const shapes::Matrices input = shapes::grid_matrices(40, 40);
  const SG::Local_operator local(mass, {}, dirichlet);
  const SG::Laplace_operator op = SG::laplace_operator(input.V, input.T, local);
  CHECK(relative_difference(op.mass.sum(), 1.) < 1e-12);
  CHECK(SG::number_of_zero_eigenvalues(op) == 0);
  const SG::Eigenpairs pairs = SG::eigenpairs(op, 11); // the twelfth equals the thirteenth
  const std::vector<char> border = SG::internal::border_vertices(input.T, input.V.rows());
  CHECK(std::count(border.begin(), border.end(), 1) == 4 * 40);
  for(Eigen::Index v = 0; v < input.V.rows(); ++v)
    if(border[std::size_t(v)])
      CHECK(pairs.vectors.row(v).cwiseAbs().maxCoeff() < 1e-12);
  std::vector<double> expected;
  for(int k = 1; k < 6; ++k)
    for(int m = 1; m < 6; ++m)
      expected.push_back((k * k + m * m) * pi * pi);
  std::sort(expected.begin(), expected.end());
  for(int k = 0; k < 11; ++k)
    CHECK(relative_difference(pairs.values(k), expected[std::size_t(k)]) < 0.03);

  SMS::Spectral_edge_collapse_options options;
  options.mass = mass;
  options.boundary = dirichlet;
  options.number_of_eigenvectors = 11;
  Mesh mesh = make_mesh(input);
  const auto result = SMS::spectral_edge_collapse(mesh, 150, options);
  const SG::Mesh_matrices coarse = SG::mesh_matrices(mesh);
  const std::vector<char> coarse_border = SG::internal::border_vertices(coarse.T, coarse.V.rows());
  const Eigen::MatrixXd F = result.restriction * pairs.vectors;
  for(Eigen::Index v = 0; v < coarse.V.rows(); ++v)
    if(coarse_border[std::size_t(v)])
      CHECK(F.row(v).cwiseAbs().maxCoeff() < 1e-9);
  const SG::Laplace_operator coarse_op = SG::laplace_operator(coarse.V, coarse.T, local);
  const Eigen::VectorXd values = SG::eigenpairs(coarse_op, 11).values;
  CHECK((values - pairs.values).cwiseQuotient(pairs.values).cwiseAbs().mean() < 0.05);
  const Basis basis = basis_of_pairs(op, pairs, local);
  CHECK(relative_difference(energy(coarse, basis, result.restriction), result.E) < 1e-6);

  CHECK_THROWS_WITH(SG::eigenpairs(op, 39 * 39 + 1),
                    ContainsSubstring("only 1521 vertices are off the border"));
  CHECK(SG::eigenpairs(coarse_op, coarse_op.L.rows() - coarse_op.vanishing).values.tail(1)(0) <
        1e6);

  options.pre_simplify = 800; // the first stage keeps the border apart as well
  Mesh twice = make_mesh(input);
  const Eigen::SparseMatrix<double> P =
      SMS::spectral_edge_collapse(twice, 150, options).restriction;
  const std::vector<char> last_border = SG::internal::border_vertices(
      SG::mesh_matrices(twice).T, Eigen::Index(twice.number_of_vertices()));
  const Eigen::MatrixXd PF = P * pairs.vectors;
  for(Eigen::Index v = 0; v < PF.rows(); ++v)
    if(last_border[std::size_t(v)])
      CHECK(PF.row(v).cwiseAbs().maxCoeff() < 1e-9);
  options.pre_simplify = 0;

  Mesh another = make_mesh(input);
  options.number_of_eigenvectors = 1600;
  CHECK_THROWS_WITH(SMS::spectral_edge_collapse(another, 150, options),
                    ContainsSubstring("only 1521 vertices are off the border"));
  options.number_of_eigenvectors = 11;
  options.signals = Eigen::MatrixXd::Ones(input.V.rows(), 2);
  CHECK_THROWS_WITH(SMS::spectral_edge_collapse(another, 150, options),
                    ContainsSubstring("do not vanish at vertex 0 "));
}

TEST_CASE("Eigenpairs of a pencil are those of the operator, in any unit")
{
  const shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(3);
  const SG::Laplace_operator op = SG::laplace_operator(mesh.V, mesh.T, 0.5);
  const SG::Eigenpairs expected = SG::eigenpairs(op, 20);
  for(const double unit : {1., 1e-9, 1e9}) {
    const SG::Eigenpairs pairs = SG::eigenpairs(Eigen::SparseMatrix<double>(unit * op.L), op.B, 20);
    CHECK((pairs.values / unit - expected.values).norm() < 1e-9 * expected.values.norm());
    CHECK(pairs.zeros == 1);
  }
  Eigen::SparseMatrix<double> L = op.L;
  L.coeffRef(3, 5) += 1;
  CHECK_THROWS_WITH(SG::eigenpairs(L, op.B, 20),
                    ContainsSubstring("L is not symmetric") && ContainsSubstring("row 3"));
  Eigen::SparseMatrix<double> B = op.B;
  B.coeffRef(7, 7) = -1;
  CHECK_THROWS_WITH(SG::eigenpairs(op.L, B, 20),
                    ContainsSubstring("row 7") && ContainsSubstring("not positive"));
  CHECK_THROWS_WITH(SG::eigenpairs(op.L, B.leftCols(3), 20), ContainsSubstring("square"));
}

TEST_CASE("With any operator the local cost of a collapse is the change of the global E")
{
  const auto kind =
      GENERATE(Kind_of_operator::voronoi, Kind_of_operator::weighted, Kind_of_operator::anisotropic,
               Kind_of_operator::anisotropic_voronoi, Kind_of_operator::dirichlet);
  const bool bordered = GENERATE(false, true);
  const SG::Mass mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const std::size_t largest_ring = GENERATE(256, 5); // without hubs, and with
  const bool by_name =
      kind == Kind_of_operator::voronoi || kind == Kind_of_operator::anisotropic_voronoi;
  if(by_name && mass == SG::Mass::averaged)
    return; // Voronoi is a mass itself
  CAPTURE(int(kind), bordered, SG::mass_name(mass), largest_ring);
  const shapes::Matrices input =
      scaled(bordered ? wavy_grid_matrices(15, 14) : shapes::bumpy_icosphere_matrices(2), 3.);
  const Basis basis = eigenbasis(input, operator_on(input.V, kind, mass), 10);
  Slow_mesh mesh(input, basis);
  Core core = make_core(mesh, basis, Parameters::paper(), largest_ring);
  std::mt19937 random(7);
  CHECK(core.total() < 1e-12 * basis.Z.squaredNorm());
  for(const int collapses : {0, 30, 50}) {
    CHECK(simplify(core, mesh, collapses, random) == collapses);
    const Comparison comparison = compare_costs(core, mesh, 10, random);
    CHECK(comparison.worst < 1e-9);
    CHECK(comparison.counts[interior] == 10);
  }
  const Eigen::VectorXd E = mesh.vertex_energies();
  CHECK((core.fields().E - E).cwiseAbs().maxCoeff() < 1e-9 * E.sum());
}

TEST_CASE("A run with an operator reports its E and carries its coefficients, whatever follows the "
          "collapses")
{
  const auto kind = GENERATE(Kind_of_operator::voronoi, Kind_of_operator::weighted,
                             Kind_of_operator::anisotropic);
  const bool pre_simplify = GENERATE(false, true);
  CAPTURE(int(kind), pre_simplify);
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(4);
  const SG::Mass mass = kind == Kind_of_operator::voronoi ? SG::Mass::voronoi : SG::Mass::averaged;
  const SG::Local_operator local = operator_on(input.V, kind, mass);
  SMS::Spectral_edge_collapse_options options = options_of(local, mass, 20);
  options.pre_simplify = pre_simplify ? 1000 : 0;
  Mesh mesh = make_mesh(input);
  const SMS::Spectral_edge_collapse_result result = SMS::spectral_edge_collapse(mesh, 150, options);
  CHECK(result.output_vertices == 150);
  const SG::Merge_forest forest = result.log.forest(); // relocation brings another P
  const SG::Operator_coefficients expected =
      local.restricted(forest.restriction(forest.kept_slots())).coefficients;
  REQUIRE(result.coefficients.rows() == expected.rows());
  CHECK((result.coefficients - expected).norm() <= 1e-12 * expected.norm());
  if(pre_simplify)
    return;
  const Basis basis = eigenbasis(input, local, 20);
  const double E = energies(SG::mesh_matrices(mesh), {mass, result.coefficients}, basis.area,
                            result.restriction * basis.F, result.restriction * basis.Z)
                       .sum();
  CHECK(relative_difference(E, result.E) < 1e-6);
}

TEST_CASE("The metric that knows the operator keeps its spectrum better than that of the cotangent "
          "Laplacian")
{
  const auto kind = GENERATE(Kind_of_operator::weighted, Kind_of_operator::anisotropic);
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(4);
  const SG::Mass mass = SG::Mass::averaged;
  const SG::Local_operator local = operator_on(input.V, kind, mass);
  double norm[2];
  for(const bool knows : {false, true}) {
    SMS::Spectral_edge_collapse_options options =
        options_of(knows ? local : SG::Local_operator(mass), mass, 30);
    options.relocate = false;
    Mesh mesh = make_mesh(input);
    const auto result = SMS::spectral_edge_collapse(mesh, 200, options);
    norm[knows] = norm_of(input, local, mesh, result.restriction, 30);
  }
  CAPTURE(int(kind), norm[0], norm[1]);
  CHECK(norm[1] < 0.9 * norm[0]);
}

TEST_CASE("A run does not depend on the unit of the coefficients")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  const SG::Local_operator local =
      operator_on(input.V, Kind_of_operator::anisotropic, SG::Mass::averaged);
  const Eigen::Index K = GENERATE(15, 16, 20); // 15 and 20 cut a cluster of eigenvalues
  std::vector<double> errors;
  for(const double unit : {1., 1e-8, 1e8}) {
    SMS::Spectral_edge_collapse_options options = options_of(local, SG::Mass::averaged, K);
    options.coefficients.rightCols<6>() *= unit;
    options.coefficients.col(0) *= std::sqrt(unit);
    Mesh mesh = make_mesh(input);
    const auto result = SMS::spectral_edge_collapse(mesh, 100, options);
    errors.push_back(result.relative_error);
  }
  // The unit moves eigenvectors by rounding, which relocation amplifies; a bound in a wrong unit is
  // off by orders of magnitude.
  for(const std::size_t i : {1, 2})
    CHECK(relative_difference(errors[i], errors[0]) < 5e-2);
}

TEST_CASE("Energies of relocation with an operator are those of its matrices, gradients those of "
          "differences")
{
  const auto kind =
      GENERATE(Kind_of_operator::voronoi, Kind_of_operator::weighted, Kind_of_operator::anisotropic,
               Kind_of_operator::anisotropic_voronoi, Kind_of_operator::dirichlet);
  const Simplified_mesh* s = GENERATE(&closed_example(), &open_example());
  const SG::Mass mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  CAPTURE(int(kind), SG::mass_name(mass), s == &open_example());
  const SG::Local_operator local = operator_on(s->coarse.V, kind, mass);
  Eigen::SparseMatrix<double> P = s->P;
  if(kind == Kind_of_operator::dirichlet) {
    const std::vector<char> border = SG::internal::border_vertices(s->coarse.T, s->coarse.V.rows());
    P.prune(
        [&](const Eigen::Index row, Eigen::Index, double) { return !border[std::size_t(row)]; });
  }
  const Eigen::MatrixXd F = P * s->F(), Z = P * s->Z();
  const double slow = SG::restriction_energy(SG::laplace_operator(s->coarse.V, s->coarse.T, local),
                                             P, s->F(), s->Z());
  SG::Relocation_energy energy(s->coarse.T, F, Z, local);
  CHECK(relative_difference(energy.value(s->coarse.V), slow) < 1e-10);
  SG::Relocation_energy smoothed(s->coarse.T, F, Z, local, 0.01, 0.3);
  CHECK(relative_difference((smoothed.value(s->coarse.V), smoothed.energy_part()), slow) < 1e-9);

  using Positions = SG::Relocation_energy::Positions;
  Positions V = s->coarse.V, gradient, direction(V.rows(), 3);
  const auto set_direction = [&](const int trial) {
    for(Eigen::Index i = 0; i < direction.size(); ++i)
      direction.data()[i] = std::sin(17. * double(i) * (trial + 1) + trial);
  };
  // Where a triangle of the grid is left that is right in the metric, the shares of the Voronoi
  // regions have a kink.
  set_direction(4);
  V += 1e-3 * direction;
  energy.value_and_gradient(V, gradient);
  for(int trial = 0; trial < 4; ++trial) {
    set_direction(trial);
    const double h = 1e-6;
    const auto difference = [&](const double step) {
      return energy.value(V + step * direction) - energy.value(V - step * direction);
    };
    const double slope = (8 * difference(h) - difference(2 * h)) / (12 * h);
    CHECK(std::abs(slope - gradient.cwiseProduct(direction).sum()) <
          1e-5 * gradient.cwiseProduct(direction).norm());
  }
}

TEST_CASE("Coefficients of faces become those of vertices by area")
{
  const shapes::Matrices mesh = wavy_grid_matrices(8, 7);
  SG::Operator_coefficients faces(mesh.T.rows(), 7);
  faces.setZero();
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f)
    for(const int i : {0, 1, 4, 6})
      faces(f, i) = 1 + double(f % 5);
  const SG::Operator_coefficients c = SG::coefficients_at_vertices(mesh.V, mesh.T, faces);
  const Eigen::VectorXd areas = SG::barycentric_corner_masses(mesh.V, mesh.T);
  for(const int v : {0, 20}) {
    double sum = 0, all = 0;
    for(Eigen::Index f = 0; f < mesh.T.rows(); ++f)
      if((mesh.T.row(f).array() == v).any()) {
        sum += areas(f) * faces(f, 0);
        all += areas(f);
      }
    CHECK(relative_difference(c(v, 0), sum / all) < 1e-13);
  }
  CHECK_THROWS_WITH(SG::coefficients_at_vertices(mesh.V, mesh.T, faces.topRows(3)),
                    ContainsSubstring("for 3 faces"));
}

TEST_CASE("What is wrong with coefficients is said of the first vertex")
{
  const shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(2);
  const Eigen::Index n = mesh.V.rows();
  Eigen::VectorXd ones = Eigen::VectorXd::Ones(n), bad = ones;
  bad(4) = 0;
  bad(9) = -1;
  CHECK_THROWS_WITH(SG::weighted_coefficients(bad, ones), ContainsSubstring("density of vertex 4"));
  CHECK_THROWS_WITH(SG::weighted_coefficients(ones, bad),
                    ContainsSubstring("conductivity of vertex 4"));
  bad(4) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(SG::weighted_coefficients(ones, bad),
                    ContainsSubstring("conductivity of vertex 4"));
  CHECK_THROWS_WITH(SG::weighted_coefficients(ones.head(3), ones), ContainsSubstring("entries"));
  CHECK_THROWS_WITH(SG::anisotropic_coefficients(Eigen::MatrixXd::Ones(n, 6)),
                    ContainsSubstring("vertex 0") && ContainsSubstring("positive definite"));
  CHECK_THROWS_WITH(SG::anisotropic_coefficients(Eigen::MatrixXd::Ones(n, 5)),
                    ContainsSubstring("5 columns"));

  SG::Local_operator op(0.5);
  op.voronoi = true;
  CHECK_THROWS_WITH(SG::laplace_operator(mesh.V, mesh.T, op), ContainsSubstring("Voronoi"));
}

} // namespace test_local_operator
