// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>

#include "catch.h"
#include "shapes.h"

namespace test_closest_points {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

namespace {

// The closest point of a triangle by the regions of its plane (Ericson 2005, section 5.1.5).
Vector3d closest_by_regions(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                            const Vector3d& c)
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
  shapes::Matrices surface = shapes::matrices(
      {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {9, 9, 9}, {0, 5, 0}, {1, 5, 0}, {0, 6, 0}},
      {{0, 1, 2}, {3, 3, 3}, {4, 5, 6}});
  MatrixXd points(5, 3),
      expected(5, 3); // the last is next to the edge from the third corner to the first
  points << 2, 1, 1, -1, 0, 0, 9, 10, 9, 0.25, 5.25, 4, -1, 5.5, 0;
  expected << 2, 0, 0, 0, 0, 0, 9, 9, 9, 0.25, 5.25, 0, 0, 5.5, 0;
  const Sparse W = SG::closest_point_interpolation(points, surface);
  check_interpolation(W);
  CHECK((W * surface.V - expected).cwiseAbs().maxCoeff() < 1e-14);
  surface.T = surface.T.topRows(1).eval();
  CHECK((SG::closest_point_interpolation(points.topRows(1), surface) * surface.V -
         expected.topRows(1))
            .norm() < 1e-14);
}

TEST_CASE("closest point of a needle lies on the needle")
{
  // The normal of a needle of width 1e-13 is rounding: a projection along it lands anywhere in
  // space.
  const shapes::Matrices surface =
      shapes::matrices({{0.1, 0.2, 0.3}, {1.1, 1.3, 0.9}, {0.6, 0.75 + 1e-13, 0.6}}, {{0, 1, 2}});
  const MatrixXd points = random_points(100, 2., 1);
  const MatrixXd found = SG::closest_point_interpolation(points, surface) * surface.V;
  for(Index i = 0; i < points.rows(); ++i) {
    const Vector3d a = surface.V.row(0), b = surface.V.row(1), p = points.row(i);
    const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0., 1.);
    CHECK((found.row(i).transpose() - a - s * (b - a)).norm() < 1e-7);
    CHECK((found.row(i).transpose() - p).norm() ==
          Approx((a + s * (b - a) - p).norm()).epsilon(1e-12));
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

// How far along the limb of folded_limb_matrices() each vertex is, in parts of all rings.
VectorXd rings_of_folded_limb(int along, int around)
{
  VectorXd result(along * around + 2);
  for(Index v = 0; v < Index(along) * around; ++v)
    result(v) = (double(v / around) + 0.5) / along;
  result.tail(2) << 0, 1;
  return result;
}

// Rows that take values from vertices of other parts.
std::vector<Index> strayed(const Sparse& W, const VectorXd& own, const VectorXd& of_surface)
{
  std::vector<Index> result;
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = W;
  for(Index i = 0; i < rows.rows(); ++i)
    for(Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(rows, i); it; ++it)
      if(std::abs(own(i) - of_surface(it.col())) > 0.25) {
        result.push_back(i);
        break;
      }
  return result;
}

TEST_CASE("closest points are followed on the surface where a limb lies beside another")
{
  const shapes::Matrices fine = shapes::folded_limb_matrices(200, 16, 0.07);
  shapes::Matrices coarse = shapes::folded_limb_matrices(60, 8, 0.07);
  const VectorXd rings = rings_of_folded_limb(200, 16), coarse_rings = rings_of_folded_limb(60, 8);
  for(Index v = 0; v < coarse.V.rows(); ++v)
    if(coarse_rings(v) > 0.71) // behind the bend: pushed towards what it lies beside
      coarse.V(v, 0) -= 0.03;
  const Sparse plain = SG::closest_point_interpolation(coarse.V, fine);
  const std::vector<Index> wrong = strayed(plain, coarse_rings, rings);
  REQUIRE(wrong.size() > 20);
  const std::vector<Index> off = SG::rows_off_their_part(coarse, fine, plain);
  CHECK(std::includes(off.begin(), off.end(), wrong.begin(), wrong.end()));
  for(const Index v : off) // no others than those nearer to the bend
    CHECK(coarse_rings(v) > 0.7);

  const Sparse P = SG::closest_point_restriction(coarse, fine);
  check_interpolation(P);
  CHECK(strayed(P, coarse_rings, rings).empty());
  CHECK(SG::rows_off_their_part(coarse, fine, P).empty());

  for(Index v = 0; v < coarse.V.rows(); ++v)
    if(coarse_rings(v) > 0.71) // far behind, so that the other is nearer to what it stands for
      coarse.V(v, 0) += 0.09;
  CHECK(strayed(SG::closest_point_interpolation(fine.V, coarse), rings, coarse_rings).size() > 100);
  const Sparse Q = SG::closest_point_prolongation(fine, coarse, P);
  check_interpolation(Q);
  CHECK(strayed(Q, rings, coarse_rings).empty());
}

TEST_CASE("meshes without a row that strays keep their closest points")
{
  const shapes::Matrices fine = shapes::bumpy_icosphere_matrices(4),
                         coarse = shapes::bumpy_icosphere_matrices(2);
  const Sparse plain = SG::closest_point_interpolation(coarse.V, fine);
  CHECK((SG::closest_point_restriction(coarse, fine) - plain).norm() == 0);
  CHECK((SG::closest_point_prolongation(fine, coarse, plain) -
         SG::closest_point_interpolation(fine.V, coarse))
            .norm() < 1e-12);
  CHECK_THROWS_WITH(SG::closest_point_prolongation(coarse, fine, plain),
                    ContainsSubstring("coarse x fine"));
  CHECK_THROWS_WITH(SG::rows_off_their_part(coarse, fine, Sparse(plain.rows(), plain.cols())),
                    ContainsSubstring("row 0 (counted from 0) of P sums to 0"));
}

TEST_CASE("a fine surface in unwelded patches tears no edge of the coarse mesh")
{
  const shapes::Matrices coarse = shapes::bumpy_icosphere_matrices(2),
                         welded = shapes::bumpy_icosphere_matrices(3);
  shapes::Matrices soup{MatrixXd(3 * welded.T.rows(), 3), Eigen::MatrixXi(welded.T.rows(), 3)};
  for(Index f = 0; f < welded.T.rows(); ++f)
    for(int k = 0; k < 3; ++k) {
      soup.V.row(3 * f + k) = welded.V.row(welded.T(f, k));
      soup.T(f, k) = int(3 * f + k);
    }
  CHECK(SG::rows_off_their_part(coarse, soup, SG::closest_point_interpolation(coarse.V, soup))
            .empty());
}

} // namespace test_closest_points
