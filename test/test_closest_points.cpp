// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>

#include "catch.h"
#include "shapes.h"

#include <algorithm>
#include <limits>
#include <random>

namespace test_closest_points {

namespace SG = CGAL::Spectral_geometry;

using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

namespace {

// The closest point of a triangle by the regions of its plane (Ericson 2005, section 5.1.5).
Vector3d closest_by_regions(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c)
{
  const Vector3d ab = b - a, ac = c - a;
  const double d1 = ab.dot(p - a), d2 = ac.dot(p - a), d3 = ab.dot(p - b), d4 = ac.dot(p - b),
               d5 = ab.dot(p - c), d6 = ac.dot(p - c);
  if(d1 <= 0 && d2 <= 0)
    return a;
  if(d3 >= 0 && d4 <= d3)
    return b;
  if(d6 >= 0 && d5 <= d6)
    return c;
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if(vc <= 0 && d1 >= 0 && d3 <= 0)
    return a + d1 / (d1 - d3) * ab;
  if(vb <= 0 && d2 >= 0 && d6 <= 0)
    return a + d2 / (d2 - d6) * ac;
  if(va <= 0 && d4 >= d3 && d5 >= d6)
    return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  return a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
}

MatrixXd random_points(Index n, double extent, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-extent, extent);
  return MatrixXd::NullaryExpr(n, 3, [&]() { return uniform(random); });
}

void check_interpolation(const Sparse& W)
{
  const VectorXd sums = W * VectorXd::Ones(W.cols());
  CHECK((sums.array() - 1.).abs().maxCoeff() < 1e-14);
  CHECK(MatrixXd(W).minCoeff() >= 0.);
  CHECK((MatrixXd(W).array() != 0.).rowwise().count().maxCoeff() <= 3);
}

} // namespace

TEST_CASE("closest points equal those of a search of all faces")
{
  const shapes::Matrices surface = shapes::bumpy_icosphere_matrices(2);
  const MatrixXd points = random_points(500, 2., 7);
  const Sparse W = SG::closest_point_interpolation(points, surface);
  check_interpolation(W);
  const MatrixXd found = W * surface.V;
  for(Index i = 0; i < points.rows(); ++i) {
    const Vector3d p = points.row(i);
    double nearest = std::numeric_limits<double>::infinity();
    for(Index f = 0; f < surface.T.rows(); ++f) {
      const Vector3d a = surface.V.row(surface.T(f, 0)), b = surface.V.row(surface.T(f, 1)),
                     c = surface.V.row(surface.T(f, 2));
      nearest = std::min(nearest, (closest_by_regions(p, a, b, c) - p).norm());
    }
    CHECK((found.row(i).transpose() - p).norm() == Approx(nearest).epsilon(1e-12));
  }
}

TEST_CASE("interpolation at the vertices of the surface is the identity")
{
  const shapes::Matrices surface = shapes::bumpy_icosphere_matrices(2);
  CHECK(MatrixXd(SG::closest_point_interpolation(surface.V, surface)).isIdentity(0.));
}

TEST_CASE("interpolation of a linear function at points of a plane surface is exact")
{
  shapes::Matrices surface = shapes::irregular_grid_matrices(7, 5);
  surface.V.rowwise() += Eigen::RowVector3d(1e3, -2e3, 5e2);
  MatrixXd points = random_points(200, 0.5, 3);
  points.col(2).setZero();
  points.rowwise() += Eigen::RowVector3d(1e3 + 0.5, -2e3 + 0.5, 5e2);
  const Sparse W = SG::closest_point_interpolation(points, surface);
  check_interpolation(W);
  CHECK((W * surface.V - points).cwiseAbs().maxCoeff() < 1e-11);
}

TEST_CASE("faces without area count as their edges")
{
  // a segment, a point and a proper triangle; then the segment alone
  shapes::Matrices surface =
      shapes::matrices({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {9, 9, 9}, {0, 5, 0}, {1, 5, 0}, {0, 6, 0}},
                       {{0, 1, 2}, {3, 3, 3}, {4, 5, 6}});
  MatrixXd points(5, 3), expected(5, 3); // the last is next to the edge from the third corner to the first
  points << 2, 1, 1, -1, 0, 0, 9, 10, 9, 0.25, 5.25, 4, -1, 5.5, 0;
  expected << 2, 0, 0, 0, 0, 0, 9, 9, 9, 0.25, 5.25, 0, 0, 5.5, 0;
  const Sparse W = SG::closest_point_interpolation(points, surface);
  check_interpolation(W);
  CHECK((W * surface.V - expected).cwiseAbs().maxCoeff() < 1e-14);
  surface.T = surface.T.topRows(1).eval();
  CHECK(
      (SG::closest_point_interpolation(points.topRows(1), surface) * surface.V - expected.topRows(1)).norm() <
      1e-14);
}

TEST_CASE("closest point of a needle lies on the needle")
{
  // The normal of a needle of width 1e-13 is rounding: a projection along it lands anywhere in space.
  const shapes::Matrices surface =
      shapes::matrices({{0.1, 0.2, 0.3}, {1.1, 1.3, 0.9}, {0.6, 0.75 + 1e-13, 0.6}}, {{0, 1, 2}});
  const MatrixXd points = random_points(100, 2., 1);
  const MatrixXd found = SG::closest_point_interpolation(points, surface) * surface.V;
  for(Index i = 0; i < points.rows(); ++i) {
    const Vector3d a = surface.V.row(0), b = surface.V.row(1), p = points.row(i);
    const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0., 1.);
    CHECK((found.row(i).transpose() - a - s * (b - a)).norm() < 1e-7);
    CHECK((found.row(i).transpose() - p).norm() == Approx((a + s * (b - a) - p).norm()).epsilon(1e-12));
  }
}

TEST_CASE("interpolation rejects what has no closest point")
{
  shapes::Matrices surface = shapes::tetrahedron_matrices();
  MatrixXd points = MatrixXd::Zero(2, 3);
  CHECK(SG::closest_point_interpolation(MatrixXd(0, 3), surface).rows() == 0);
  CHECK_THROWS_WITH(SG::closest_point_interpolation(MatrixXd::Zero(2, 2), surface),
                    ContainsSubstring("2 columns"));
  points(1, 2) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(SG::closest_point_interpolation(points, surface), ContainsSubstring("point 1"));
  points.setZero();
  surface.T(2, 1) = 4;
  CHECK_THROWS_WITH(SG::closest_point_interpolation(points, surface), ContainsSubstring("face 2"));
  surface.T.resize(0, 3);
  CHECK_THROWS_WITH(SG::closest_point_interpolation(points, surface), ContainsSubstring("no face"));
}

} // namespace test_closest_points
