// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include "catch.h"
#include "shapes.h"

#include <Eigen/Eigenvalues>

namespace test_operators {

using Point = CGAL::Simple_cartesian<double>::Point_3;
using Surface_mesh = CGAL::Surface_mesh<Point>;
using SG::Eigenpairs;
using SG::Laplace_operator;

namespace {

Laplace_operator laplace(const shapes::Matrices& mesh, double theta = 0.)
{
  return SG::laplace_operator(mesh.V, mesh.T, theta);
}

double area(const shapes::Matrices& mesh)
{
  double sum = 0.;
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f) {
    const Eigen::Vector3d p = mesh.V.row(mesh.T(f, 0)), q = mesh.V.row(mesh.T(f, 1)),
                          r = mesh.V.row(mesh.T(f, 2));
    sum += 0.5 * (q - p).cross(r - p).norm();
  }
  return sum;
}

} // namespace

TEST_CASE("The Laplacian is symmetric, semidefinite and its rows sum to zero")
{
  for(const shapes::Matrices& mesh :
      {shapes::bumpy_icosphere_matrices(2), shapes::irregular_grid_matrices(9, 7),
       shapes::tetrahedron_matrices()}) {
    const Laplace_operator op = laplace(mesh);
    const Eigen::MatrixXd L = op.L;
    CHECK(L == L.transpose());
    CHECK((op.L * Eigen::VectorXd::Ones(L.rows())).cwiseAbs().maxCoeff() <
          1e-12 * L.cwiseAbs().maxCoeff());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(L);
    CHECK(solver.eigenvalues()(0) > -1e-12);
    CHECK(solver.eigenvalues()(1) > 1e-3); // connected: one constant only
  }
}

TEST_CASE("Off-diagonal entries are half the sum of the opposite cotangents")
{
  const Laplace_operator op = laplace(shapes::tetrahedron_matrices());
  CHECK(op.L.coeff(0, 1) == Approx(-1. / std::sqrt(3.)));
  CHECK(op.L.coeff(0, 0) == Approx(std::sqrt(3.)));
  const Laplace_operator square = laplace(shapes::grid_matrices(1, 1));
  CHECK(square.L.coeff(0, 1) == Approx(-0.5));
  CHECK(square.L.coeff(0, 3) == Approx(0.).margin(1e-15)); // the diagonal faces two right angles
}

TEST_CASE("Linear functions are harmonic in the interior of a planar mesh")
{
  const shapes::Matrices mesh = shapes::irregular_grid_matrices(12, 10);
  const Eigen::MatrixXd LV = laplace(mesh).L * mesh.V;
  for(Eigen::Index v = 0; v < LV.rows(); ++v) {
    const double x = mesh.V(v, 0), y = mesh.V(v, 1);
    if(x > 0. && x < 1. && y > 0. && y < 1.)
      CHECK(LV.row(v).cwiseAbs().maxCoeff() < 1e-13);
  }
}

TEST_CASE(
    "The Dirichlet energy of a linear function on a square is its area times the squared slope")
{
  const shapes::Matrices mesh = shapes::irregular_grid_matrices(8, 8);
  const Eigen::VectorXd f = 3. * mesh.V.col(0) - 4. * mesh.V.col(1);
  CHECK(f.dot(laplace(mesh).L * f) == Approx(25.));
}

TEST_CASE("Masses sum to the area and are the row sums of B, lumped, averaged and consistent")
{
  const shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(3);
  const Eigen::VectorXd lumped = laplace(mesh).mass;
  for(const double theta : {0., 0.5, 1.}) {
    const Laplace_operator op = laplace(mesh, theta);
    CHECK(op.theta == theta);
    CHECK(op.mass.sum() == Approx(area(mesh)));
    CHECK((op.B * Eigen::VectorXd::Ones(op.B.cols()) - op.mass).cwiseAbs().maxCoeff() < 1e-15);
    CHECK((op.mass - lumped).cwiseAbs().maxCoeff() < 1e-15);
    CHECK(op.B.nonZeros() == (theta > 0. ? op.L.nonZeros() : op.B.rows()));
  }
  CHECK(SG::mass_blend(SG::Mass::lumped) == 0.);
  CHECK(SG::mass_blend(SG::Mass::averaged) == 0.5);
  CHECK(SG::mass_name(SG::Mass::averaged) == std::string("averaged"));
}

TEST_CASE("The consistent mass integrates products of linear functions exactly")
{
  const shapes::Matrices mesh = shapes::irregular_grid_matrices(6, 5);
  const Eigen::VectorXd x = mesh.V.col(0), y = mesh.V.col(1);
  const Laplace_operator op = laplace(mesh, 1.);
  CHECK(x.dot(op.B * x) == Approx(1. / 3.));
  CHECK(x.dot(op.B * y) == Approx(1. / 4.));
}

TEST_CASE(
    "The Laplacian does not depend on scale, the mass is an area, at any magnitude of coordinates")
{
  const shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(1);
  const Laplace_operator op = laplace(mesh);
  for(const double scale : {1e-140, 1e-5, 1e7, 1e140}) {
    shapes::Matrices scaled = mesh;
    scaled.V *= scale;
    const Laplace_operator other = laplace(scaled);
    CHECK((other.L - op.L).norm() < 1e-12 * op.L.norm());
    CHECK((other.mass / scale / scale - op.mass).cwiseAbs().maxCoeff() < 1e-13);
    const Eigenpairs pairs = SG::eigenpairs(other, 10);
    const Eigen::MatrixXd gram = pairs.vectors.transpose() * (other.B * pairs.vectors);
    CHECK((gram - Eigen::MatrixXd::Identity(10, 10)).cwiseAbs().maxCoeff() < 1e-10);
    CHECK(pairs.values(9) * scale * scale == Approx(SG::eigenpairs(op, 10).values(9)));
  }
}

TEST_CASE("Zero-area faces contribute nothing, exact or degenerate to rounding")
{
  // A square of two triangles, one diagonal of which is doubled by a face without area.
  shapes::Matrices mesh =
      shapes::matrices({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}},
                       {{0, 1, 2}, {0, 4, 3}, {4, 2, 3}, {0, 2, 4}});
  shapes::Matrices without = mesh;
  without.T.conservativeResize(3, 3);
  CHECK((Eigen::MatrixXd(laplace(mesh).L) - Eigen::MatrixXd(laplace(without).L)).norm() == 0.);
  CHECK((laplace(mesh).mass - laplace(without).mass).norm() == 0.);

  // Collinear on a slanted line, no coordinate is exact.
  const Eigen::Vector3d p(0.1, 0.7, 0.3), d(0.3, 0.1, 0.7);
  const SG::Triangle_cotangents t = SG::triangle_cotangents(p, p + d / 3., p + d);
  CHECK(t.area == 0.);
  CHECK(t.cot == Eigen::Vector3d::Zero());
}

TEST_CASE("Cotangents have no unit, from the smallest double to the largest")
{
  for(const double x : {5e-324, 1e-310, 1e-300, 1., 1e300, 1.7e308}) {
    CAPTURE(x);
    const SG::Triangle_cotangents t = SG::triangle_cotangents({0, 0, 0}, {x, 0, 0}, {0, x, 0});
    CHECK((t.cot - Eigen::Vector3d(0, 1, 1)).norm() < 1e-15);
  }
}

TEST_CASE("A mesh and its matrices give the same operators, for every mesh type and kernel")
{
  const shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(1);
  Surface_mesh surface_mesh;
  CGAL::Polyhedron_3<CGAL::Simple_cartesian<double>> polyhedron;
  CGAL::Surface_mesh<CGAL::Exact_predicates_exact_constructions_kernel::Point_3> exact;
  shapes::make_mesh(surface_mesh, mesh);
  shapes::make_mesh(polyhedron, mesh);
  shapes::make_mesh(exact, mesh);
  CHECK(SG::mesh_matrices(surface_mesh).V == mesh.V);
  CHECK(SG::mesh_matrices(polyhedron).V == mesh.V);
  CHECK(SG::mesh_matrices(exact).V == mesh.V);
  const Eigen::MatrixXd L = laplace(mesh, 0.5).L, B = laplace(mesh, 0.5).B;
  CHECK(Eigen::MatrixXd(SG::cotangent_laplacian(surface_mesh, SG::Mass::averaged).L)
            .isApprox(L, 1e-14));
  CHECK(Eigen::MatrixXd(SG::cotangent_laplacian(polyhedron, SG::Mass::averaged).L)
            .isApprox(L, 1e-14));
  CHECK(Eigen::MatrixXd(SG::cotangent_laplacian(exact, SG::Mass::averaged).B).isApprox(B, 1e-14));
}

TEST_CASE("The mass is the averaged one where none is named")
{
  const shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(1);
  Surface_mesh surface_mesh;
  shapes::make_mesh(surface_mesh, mesh);
  const Eigen::SparseMatrix<double> B = laplace(mesh, 0.5).B;
  REQUIRE((B - laplace(mesh, 0.).B).norm() > 0.01 * B.norm());
  CHECK((SG::cotangent_laplacian(surface_mesh).B - B).norm() == 0);
  CHECK((SG::laplace_operator(mesh.V, mesh.T).B - B).norm() == 0);
  CHECK((SG::laplace_operator(mesh.V, mesh.T, SG::Local_operator()).B - B).norm() == 0);
}

TEST_CASE("Removed vertices and faces are skipped, a vertex point map is respected")
{
  Surface_mesh mesh;
  shapes::make_mesh(mesh, shapes::grid_matrices(3, 3));
  CGAL::Euler::remove_face(halfedge(*faces(mesh).begin(), mesh), mesh);
  REQUIRE(mesh.has_garbage() == true);
  auto doubled = mesh.add_property_map<Surface_mesh::Vertex_index, Point>("v:doubled").first;
  for(const auto v : vertices(mesh))
    doubled[v] = Point(2. * mesh.point(v).x(), 2. * mesh.point(v).y(), 0.);
  const Laplace_operator op =
      SG::cotangent_laplacian(mesh, SG::Mass::lumped, CGAL::parameters::vertex_point_map(doubled));
  CHECK(op.mass.size() == 16);
  CHECK(op.mass.sum() == Approx(4. * 17. / 18.));
}

TEST_CASE("Bad meshes are refused by the name of the first offender")
{
  shapes::Matrices mesh = shapes::grid_matrices(4, 4);
  SECTION("a coordinate that is not a number")
  {
    mesh.V(7, 1) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(laplace(mesh), ContainsSubstring("vertex 7 "));
    Surface_mesh graph;
    shapes::make_mesh(graph, mesh);
    CHECK_THROWS_WITH(SG::mesh_matrices(graph), ContainsSubstring("vertex 7 "));
  }
  SECTION("a face that is not a triangle")
  {
    Surface_mesh graph;
    shapes::make_mesh(graph, shapes::grid_matrices(4, 4));
    const auto first = faces(graph).begin();
    CGAL::Euler::join_face(halfedge(*first, graph), graph);
    CHECK_THROWS_WITH(SG::mesh_matrices(graph),
                      ContainsSubstring("face 0 ") && ContainsSubstring("triangulate"));
  }
  SECTION("an isolated vertex")
  {
    mesh.V.conservativeResize(26, 3);
    mesh.V.row(25).setConstant(0.5);
    CHECK_THROWS_WITH(laplace(mesh),
                      ContainsSubstring("vertex 25 ") && ContainsSubstring("isolated"));
  }
  SECTION("a vertex with only zero-area faces")
  {
    mesh.T(0, 1) = mesh.T(0, 0) = 0;
    mesh = shapes::matrices({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}}, {{0, 1, 2}, {0, 3, 1}});
    CHECK_THROWS_WITH(laplace(mesh),
                      ContainsSubstring("vertex 3 ") && ContainsSubstring("zero area"));
  }
  SECTION("a needle")
  {
    mesh = shapes::matrices({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, -1e-13, 0}},
                            {{0, 1, 2}, {0, 3, 1}});
    CHECK_THROWS_WITH(laplace(mesh), ContainsSubstring("face 1 ") && ContainsSubstring("needle"));
  }
  SECTION("an area that overflows")
  {
    mesh.V *= 1e160;
    CHECK_THROWS_WITH(laplace(mesh), ContainsSubstring("face 0 "));
  }
  SECTION("indices")
  {
    shapes::Matrices bad = mesh;
    bad.T(5, 2) = 25;
    CHECK_THROWS_WITH(laplace(bad), ContainsSubstring("face 5 ") && ContainsSubstring("0..24"));
    bad = mesh;
    bad.T(6, 0) = bad.T(6, 1);
    CHECK_THROWS_WITH(laplace(bad), ContainsSubstring("face 6 ") && ContainsSubstring("twice"));
    CHECK_THROWS_AS(SG::laplace_operator(mesh.V, Eigen::MatrixXi(0, 3)), std::invalid_argument);
    CHECK_THROWS_AS(SG::laplace_operator(mesh.V, mesh.T, 1.5), std::invalid_argument);
  }
}

} // namespace test_operators
