// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_toolbox/intrinsic_delaunay.h>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include "catch.h"
#include "shapes.h"

#include <Eigen/Dense>

namespace test_intrinsic_delaunay {

using Eigen::Vector3d;
using SG::Laplace_operator;
using SG::Mass;

namespace {

constexpr Mass masses[] = {Mass::lumped, Mass::averaged, Mass::voronoi};

Laplace_operator plain(const shapes::Matrices& mesh, const Mass mass = Mass::lumped)
{
  return SG::laplace_operator(mesh.V, mesh.T, mass);
}

Laplace_operator intrinsic(const shapes::Matrices& mesh, const Mass mass = Mass::lumped)
{
  return SG::intrinsic_delaunay_laplacian(mesh.V, mesh.T, mass);
}

double difference(const Eigen::SparseMatrix<double>& A, const Eigen::SparseMatrix<double>& B)
{
  return (Eigen::MatrixXd(A) - Eigen::MatrixXd(B)).cwiseAbs().maxCoeff() /
         Eigen::MatrixXd(B).cwiseAbs().maxCoeff();
}

// Zero where none is positive.
double largest_off_diagonal(const Laplace_operator& op)
{
  Eigen::MatrixXd L = op.L;
  L.diagonal().setZero();
  return L.maxCoeff();
}

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& A)
{
  return A.selfadjointView<Eigen::Lower>().eigenvalues();
}

double angle(const shapes::Matrices& mesh, const int at, const int p, const int q)
{
  const Vector3d a = mesh.V.row(p) - mesh.V.row(at), b = mesh.V.row(q) - mesh.V.row(at);
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Flat, its faces stretched to needles: a cell is 20 times as wide as high.
shapes::Matrices stretched_grid()
{
  shapes::Matrices mesh = shapes::irregular_grid_matrices(14, 10, 0.3);
  mesh.V.col(0) *= 20.;
  for(const auto t : mesh.T.rowwise()) {
    const Vector3d p = mesh.V.row(t[0]), q = mesh.V.row(t[1]), r = mesh.V.row(t[2]);
    REQUIRE((q - p).cross(r - p).z() > 0.);
  }
  return mesh;
}

// These vertices in CGAL's triangulation of the plane, which has exact predicates.
shapes::Matrices planar_delaunay(const shapes::Matrices& mesh)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Vertex = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
  CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex>> delaunay;
  for(int v = 0; v < int(mesh.V.rows()); ++v)
    delaunay.insert(Kernel::Point_2(mesh.V(v, 0), mesh.V(v, 1)))->info() = v;
  shapes::Matrices result = mesh;
  REQUIRE(Eigen::Index(delaunay.number_of_faces()) == mesh.T.rows());
  Eigen::Index f = 0;
  for(const auto face : delaunay.finite_face_handles()) {
    for(int k = 0; k < 3; ++k)
      result.T(f, k) = face->vertex(k)->info();
    ++f;
  }
  return result;
}

// Needles on the unit sphere: every third vertex or so goes most of the way to a neighbour, along
// the sphere.
shapes::Matrices needle_sphere(const int subdivisions, const double way)
{
  shapes::Matrices mesh = shapes::icosphere_matrices(subdivisions);
  std::mt19937 random(7);
  std::vector<char> fixed(std::size_t(mesh.V.rows()), 0);
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f) {
    const int k = int(random() % 3), v = mesh.T(f, k), w = mesh.T(f, (k + 1) % 3);
    if(fixed[std::size_t(v)])
      continue;
    mesh.V.row(v) = ((1 - way) * mesh.V.row(v) + way * mesh.V.row(w)).normalized();
    for(Eigen::Index g = 0; g < mesh.T.rows(); ++g) // its neighbours stay
      if((mesh.T.row(g).array() == v).any())
        for(int j = 0; j < 3; ++j)
          fixed[std::size_t(mesh.T(g, j))] = 1;
  }
  return mesh;
}

// A sphere turned about its axis, by an angle that grows along it: faces are sheared, vertices are
// as dense as before.
shapes::Matrices twisted_sphere(const int subdivisions, const double turn)
{
  shapes::Matrices mesh = shapes::icosphere_matrices(subdivisions);
  for(Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    const Vector3d p = mesh.V.row(v);
    mesh.V.row(v) = Eigen::AngleAxisd(turn * p.z(), Vector3d::UnitZ()) * p;
  }
  return mesh;
}

// Two tips, far apart, and a small waist at each: p, q, a, b.
shapes::Matrices spindle()
{
  return shapes::matrices({{-10, 0.3, -0.1}, {10, -0.2, 0.2}, {-4, 0.9, 0.4}, {5, 0.1, -0.8}},
                          {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}});
}

// Closed, all of them with obtuse faces.
std::vector<shapes::Matrices> closed_shapes()
{
  shapes::Matrices sheared_sphere = shapes::icosphere_matrices(1, 2.),
                   sheared_torus = shapes::torus_matrices(20, 7);
  for(shapes::Matrices* mesh : {&sheared_sphere, &sheared_torus})
    mesh->V.col(0) += 4. * mesh->V.col(2);
  return {shapes::bumpy_icosphere_matrices(2),
          shapes::gear_matrices(11, 3),
          shapes::folded_limb_matrices(20, 7),
          shapes::thin_bowl_matrices(2),
          needle_sphere(2, 0.97),
          twisted_sphere(2, 2.5),
          spindle(),
          sheared_sphere,
          sheared_torus};
}

// Slow: lengths alone, angles by the law of cosines, any edge that has too large ones until there
// is none. Its L, and how many sides have a vertex at both ends.
Eigen::MatrixXd slow_intrinsic_stiffness(const shapes::Matrices& mesh, int& loops)
{
  using Side = std::pair<int, int>; // a face and the corner of it that is opposite
  struct Corner
  {
    int vertex;
    Side glued;    // to the opposite side
    double length; // of that side
  };
  std::vector<std::array<Corner, 3>> faces(std::size_t(mesh.T.rows()));
  const int m = int(faces.size());
  const auto at = [&](int f, int k) -> Corner& {
    return faces[std::size_t(f)][std::size_t((k + 6) % 3)];
  };
  for(int f = 0; f < m; ++f)
    for(int k = 0; k < 3; ++k) {
      const int i = mesh.T(f, (k + 1) % 3), j = mesh.T(f, (k + 2) % 3);
      at(f, k) = {mesh.T(f, k), {-1, -1}, (mesh.V.row(i) - mesh.V.row(j)).norm()};
      for(int g = 0; g < m; ++g)
        for(int l = 0; l < 3; ++l)
          if(mesh.T(g, (l + 1) % 3) == j && mesh.T(g, (l + 2) % 3) == i)
            at(f, k).glued = {g, l};
    }
  const auto angle_at = [&](int f, int k) {
    const double a = at(f, k).length, b = at(f, k + 1).length, c = at(f, k + 2).length;
    return std::acos((b * b + c * c - a * a) / (2 * b * c));
  };
  for(bool flipped = true; flipped;) {
    flipped = false;
    for(int f = 0; f < m; ++f)
      for(int k = 0; k < 3; ++k) {
        const auto [g, l] = at(f, k).glued;
        if(g < 0 || angle_at(f, k) + angle_at(g, l) < shapes::pi + 1e-9)
          continue;
        REQUIRE(g != f);
        // The faces are (c, i, j) and (d, j, i).
        const Corner c = at(f, k), i = at(f, k + 1), j = at(f, k + 2), d = at(g, l);
        const Corner id = at(g, l + 1), dj = at(g, l + 2);
        const double at_i = angle_at(f, k + 1) + angle_at(g, l + 2);
        const double cd = std::sqrt(j.length * j.length + id.length * id.length -
                                    2 * j.length * id.length * std::cos(at_i));
        // Outer sides in their new places: f = (c, i, d), g = (d, j, c).
        faces[std::size_t(f)] = {{{c.vertex, id.glued, id.length},
                                  {i.vertex, {g, 1}, cd},
                                  {d.vertex, j.glued, j.length}}};
        faces[std::size_t(g)] = {{{d.vertex, i.glued, i.length},
                                  {j.vertex, {f, 1}, cd},
                                  {c.vertex, dj.glued, dj.length}}};
        const std::map<Side, Side> moved = {{{g, (l + 1) % 3}, {f, 0}},
                                            {{f, (k + 2) % 3}, {f, 2}},
                                            {{f, (k + 1) % 3}, {g, 0}},
                                            {{g, (l + 2) % 3}, {g, 2}}};
        for(const auto& [from, to] : moved) { // glued to a side that has moved as well
          Side& glued = at(to.first, to.second).glued;
          if(const auto place = moved.find(glued); place != moved.end())
            glued = place->second;
        }
        for(const auto& [from, to] : moved)
          if(const Side other = at(to.first, to.second).glued; other.first >= 0)
            at(other.first, other.second).glued = to;
        flipped = true;
      }
  }
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(mesh.V.rows(), mesh.V.rows());
  for(int f = 0; f < m; ++f)
    for(int k = 0; k < 3; ++k) {
      const int i = at(f, k + 1).vertex, j = at(f, k + 2).vertex;
      loops += i == j;
      const double w = 0.5 / std::tan(angle_at(f, k));
      L(i, i) += w; // (u_i - u_j)^2: all four fall on one entry if i = j
      L(j, j) += w;
      L(i, j) -= w;
      L(j, i) -= w;
    }
  return L;
}

} // namespace

TEST_CASE("A flat mesh has the operators of its planar Delaunay triangulation")
{
  const shapes::Matrices mesh = stretched_grid(), delaunay = planar_delaunay(mesh);
  CHECK(difference(plain(mesh).L, plain(delaunay).L) > 0.1);
  for(const Mass mass : masses) {
    const Laplace_operator op = intrinsic(mesh, mass), expected = plain(delaunay, mass);
    CHECK(difference(op.L, expected.L) < 1e-12);
    CHECK(difference(op.B, expected.B) < 1e-12);
    CHECK((op.mass - expected.mass).cwiseAbs().maxCoeff() < 1e-12 * expected.mass.maxCoeff());
    CHECK(op.theta == expected.theta);
    CHECK(op.voronoi == expected.voronoi);
  }
}

TEST_CASE("Linear functions have their energy on a flat mesh with needles")
{
  const shapes::Matrices mesh = stretched_grid();
  const Laplace_operator op = intrinsic(mesh);
  const Eigen::VectorXd f = 3. * mesh.V.col(0) - 4. * mesh.V.col(1);
  CHECK(f.dot(op.L * f) == Approx(25. * 20.));
  const Eigen::VectorXd Lf = op.L * f;
  for(Eigen::Index v = 0; v < Lf.size(); ++v)
    if(mesh.V(v, 0) > 0. && mesh.V(v, 0) < 20. && mesh.V(v, 1) > 0. && mesh.V(v, 1) < 1.)
      CHECK(std::abs(Lf(v)) < 1e-11);
}

TEST_CASE("A flipped Laplacian has no positive weights, sums to zero and keeps the area")
{
  for(const shapes::Matrices& mesh : closed_shapes()) {
    const Laplace_operator before = plain(mesh);
    CHECK(largest_off_diagonal(before) > 0.01);
    for(const Mass mass : masses) {
      const Laplace_operator op = intrinsic(mesh, mass);
      const Eigen::VectorXd one = Eigen::VectorXd::Ones(op.L.rows());
      const double size = op.L.diagonal().maxCoeff();
      CHECK(largest_off_diagonal(op) < 1e-10);
      CHECK(Eigen::MatrixXd(op.L) == Eigen::MatrixXd(op.L).transpose());
      CHECK(Eigen::MatrixXd(op.B) == Eigen::MatrixXd(op.B).transpose());
      CHECK((op.L * one).cwiseAbs().maxCoeff() < 1e-13 * size);
      CHECK((op.B * one - op.mass).cwiseAbs().maxCoeff() < 1e-13 * op.mass.maxCoeff());
      CHECK(op.mass.minCoeff() > 0.);
      CHECK(op.mass.sum() == Approx(before.mass.sum()).epsilon(1e-12));
      CHECK(SG::number_of_zero_eigenvalues(op) == 1);
      const Eigen::VectorXd values = eigenvalues(op.L);
      CHECK(values(0) > -1e-13 * size);
      CHECK(values(1) > 1e-9 * size);
    }
  }
}

TEST_CASE("Flips lower the Dirichlet energy of every function")
{
  for(const shapes::Matrices& mesh : closed_shapes()) {
    const Eigen::VectorXd decreases = eigenvalues(plain(mesh).L - intrinsic(mesh).L);
    CHECK(decreases(0) > -1e-12 * decreases.maxCoeff());
    CHECK(decreases.maxCoeff() > 0.01);
  }
}

TEST_CASE("Flips by lengths and angles in another order lead to the same stiffness")
{
  std::vector<shapes::Matrices> meshes = closed_shapes();
  std::mt19937 random(3);
  for(int run = 0; run < 200; ++run) { // long and thin: edges wind around
    meshes.push_back(run % 2 ? shapes::tetrahedron_matrices() : shapes::icosphere_matrices(0));
    Eigen::MatrixXd& V = meshes.back().V;
    for(Eigen::Index v = 0; v < V.rows(); ++v)
      for(int c = 0; c < 3; ++c)
        V(v, c) += double(random()) / double(random.max()) - 0.5;
    V.col(0) *= 20.;
  }
  // On its way two opposite sides of two triangles are one edge, and these are flipped on.
  meshes.push_back(shapes::matrices(
      {{8638, 7, -15},  {-4954, -1, 27},  {-3904, -25, 18}, {2633, -26, 6},   {-6933, 5, 8},
       {-896, -26, -3}, {-4900, -9, 10},  {1093, 27, 17},   {2630, -21, -24}, {-8080, 20, 38},
       {-904, -18, 0},  {6370, -21, -35}, {-3550, 13, 29},  {5494, 38, -8},   {-2504, -1, -52},
       {4460, -4, 48},  {344, 51, 38},    {-4918, -29, 23}, {-858, 8, -16},   {1531, 36, -40}},
      {}));
  meshes.back().T = shapes::gear_matrices(3, 6).T;
  int loops = 0;
  for(const shapes::Matrices& mesh : meshes) {
    if(mesh.V.rows() > 200)
      continue;
    const Eigen::MatrixXd expected = slow_intrinsic_stiffness(mesh, loops), L = intrinsic(mesh).L;
    CHECK((L - expected).cwiseAbs().maxCoeff() < 1e-8 * expected.cwiseAbs().maxCoeff());
  }
  CHECK(loops > 100);
}

TEST_CASE("Short edges beside a long one keep their digits when it is flipped")
{
  const double h = 1e-9;
  for(const double side : {-1., 1.}) {
    // Both corners beyond the edge 01 lie beside its end 1, at the origin.
    const shapes::Matrices mesh = shapes::matrices(
        {{side, 0, 0}, {0, 0, 0}, {0.6 * side * h, 0.3 * h, 0}, {0.9 * side * h, -1.7 * h, 0}},
        {side < 0 ? Eigen::Vector3i(0, 1, 2) : Eigen::Vector3i(1, 0, 2),
         side < 0 ? Eigen::Vector3i(1, 0, 3) : Eigen::Vector3i(0, 1, 3)});
    shapes::Matrices flipped = mesh, turned = mesh;
    flipped.T << 2, 0, 3, 3, 1, 2;
    turned.T.row(0).swap(turned.T.row(1));
    CHECK(difference(intrinsic(mesh).L, plain(flipped).L) < 1e-14);
    CHECK(difference(intrinsic(turned).L, plain(flipped).L) < 1e-14);
    for(const int v : {2, 3}) // of the small triangle
      CHECK(intrinsic(mesh).L.coeff(1, v) == Approx(plain(flipped).L.coeff(1, v)).epsilon(1e-14));
    const Eigen::VectorXd mass = plain(flipped).mass;
    CHECK((intrinsic(mesh).mass.array() / mass.array() - 1).abs().maxCoeff() < 1e-14);
  }
}

TEST_CASE("A mesh that is Delaunay keeps its operators")
{
  // A flat triangle on a border cannot be flipped, and keeps its height.
  const shapes::Matrices cap = shapes::matrices(
      {{0, 0, 0}, {1, 0, 0}, {0.5, -1e-7, 0.3}, {0.43, 1e-7, 0}}, {{0, 1, 3}, {2, 1, 0}});
  const shapes::Matrices border_cap =
      shapes::matrices({{0, 0, 0}, {1, 0, 0}, {0.43, 1e-7, 0.2e-7}}, {{0, 1, 2}});
  for(const shapes::Matrices& mesh :
      {shapes::icosphere_matrices(2), shapes::equilateral_matrices(7),
       shapes::tetrahedron_matrices(), shapes::grid_matrices(5, 4), border_cap})
    for(const Mass mass : masses) {
      const Laplace_operator op = intrinsic(mesh, mass), expected = plain(mesh, mass);
      CHECK(difference(op.L, expected.L) < 1e-14);
      CHECK(difference(op.B, expected.B) < 1e-14);
      CHECK((op.mass - expected.mass).norm() < 1e-14 * plain(mesh).mass.norm());
    }
  CHECK(difference(intrinsic(cap).L, plain(cap).L) > 0.1);
  CHECK(largest_off_diagonal(plain(cap)) > 1e5);
  CHECK(largest_off_diagonal(intrinsic(cap)) < 10.);
}

TEST_CASE("Neither scale nor motion changes a flipped Laplacian")
{
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  for(const shapes::Matrices& mesh :
      {needle_sphere(2, 0.97), spindle(), shapes::bumpy_icosphere_matrices(2)})
    for(const Mass mass : masses) {
      const Laplace_operator op = intrinsic(mesh, mass);
      for(const double scale : {1e-140, 1e-5, 1e7, 1e140}) {
        const Laplace_operator scaled = intrinsic({scale * mesh.V, mesh.T}, mass);
        CHECK(difference(scaled.L, op.L) < 1e-12);
        CHECK((scaled.mass / scale / scale - op.mass).cwiseAbs().maxCoeff() <
              1e-12 * op.mass.maxCoeff());
      }
      const Laplace_operator moved = intrinsic(
          {(mesh.V * turn.transpose()).rowwise() + Eigen::RowVector3d(3, -1, 2), mesh.T}, mass);
      CHECK(difference(moved.L, op.L) < 1e-10);
      CHECK(difference(moved.B, op.B) < 1e-10);
    }
}

TEST_CASE("A sphere of long thin faces has eigenvalues closer to l (l + 1)")
{
  const shapes::Matrices mesh = twisted_sphere(4, 2.);
  const auto mean_error = [](const Laplace_operator& op) {
    const Eigen::ArrayXd values = SG::eigenpairs(op, 49).values;
    double sum = 0.;
    for(int l = 1; l <= 6; ++l) // of degree l there are 2 l + 1
      sum += (values.segment(l * l, 2 * l + 1) / (l * (l + 1.)) - 1.).abs().sum();
    return sum / 48;
  };
  // Sheared faces make eigenvalues too large, lumped masses too small: without flips these errors
  // cancel in part.
  CHECK(mean_error(intrinsic(mesh, Mass::averaged)) <
        0.1 * mean_error(plain(mesh, Mass::averaged)));
  CHECK(mean_error(intrinsic(mesh, Mass::averaged)) < 0.002);
  for(const Mass mass : {Mass::lumped, Mass::voronoi})
    CHECK(mean_error(intrinsic(mesh, mass)) < 0.8 * mean_error(plain(mesh, mass)));
}

TEST_CASE("Edges from a vertex to itself: a triangle covered twice")
{
  // The edge beyond the obtuse corner 2 becomes a loop around it: the corners 0 and 1 are tips of
  // cones.
  const shapes::Matrices mesh =
      shapes::matrices({{0, 0, 0}, {3, 0, 0}, {1, 0.4, 0}}, {{0, 1, 2}, {0, 2, 1}});
  const double at_0 = angle(mesh, 0, 1, 2), at_1 = angle(mesh, 1, 0, 2);
  for(const Mass mass : masses) {
    const Laplace_operator op = intrinsic(mesh, mass);
    CHECK(op.L.coeff(0, 1) == 0.);
    CHECK(op.L.coeff(0, 2) == Approx(-std::tan(at_0)));
    CHECK(op.L.coeff(1, 2) == Approx(-std::tan(at_1)));
    CHECK(op.L.coeff(2, 2) == Approx(std::tan(at_0) + std::tan(at_1)));
    CHECK(op.mass.sum() == Approx(1.2));
  }
  const double A = mesh.V(2, 0) * 0.4, B = 2 * 0.4; // of the cones
  const Laplace_operator op = intrinsic(mesh, Mass::averaged);
  CHECK(op.B.coeff(0, 0) == Approx(0.5 * A / 3 + 0.5 * A / 6));
  CHECK(op.B.coeff(0, 2) == Approx(0.5 * 2 * A / 12));
  CHECK(op.B.coeff(2, 2) == Approx(0.5 * 2 * (A + B) / 3 + 0.5 * (2. / 6 + 2. / 12) * (A + B)));
  CHECK(op.B.coeff(0, 1) == 0.);
  CHECK(op.mass(2) == Approx((A + B) * 2 / 3));
}

TEST_CASE("Edges from a vertex to itself and double edges: a thin tetrahedron")
{
  const shapes::Matrices mesh = spindle();
  const Eigen::MatrixXd L = intrinsic(mesh).L, B = intrinsic(mesh, Mass::averaged).B;
  // A tip lies within a loop about its neighbour: a triangle whose base angles are those the cone
  // leaves.
  const double at_p = angle(mesh, 0, 1, 2) + angle(mesh, 0, 1, 3) + angle(mesh, 0, 2, 3);
  const double at_q = angle(mesh, 1, 0, 2) + angle(mesh, 1, 0, 3) + angle(mesh, 1, 2, 3);
  CHECK(L(0, 2) == Approx(-std::tan(at_p / 2)));
  CHECK(L(1, 3) == Approx(-std::tan(at_q / 2)));
  for(const auto& [tip, other] : {std::pair(0, 1), std::pair(0, 3), std::pair(1, 2)}) {
    CHECK(L(tip, other) == 0.);
    CHECK(B(tip, other) == 0.);
  }
  const double cone = 0.5 * (mesh.V.row(0) - mesh.V.row(2)).squaredNorm() * std::sin(at_p);
  CHECK(B(0, 0) == Approx(cone / 4));
  CHECK(B(0, 2) == Approx(cone / 12));
}

TEST_CASE("Borders and edges that are not manifold stay")
{
  const std::vector<Vector3d> points = {
      {0, 0, 0}, {1, 0, 0}, {0.4, 0.1, 0}, {0.6, -0.1, 0}, {0.5, 0, 0.1}};
  const auto unchanged = [](const shapes::Matrices& mesh) {
    const Laplace_operator op = intrinsic(mesh, Mass::averaged),
                           expected = plain(mesh, Mass::averaged);
    return difference(op.L, expected.L) < 1e-14 && difference(op.B, expected.B) < 1e-14;
  };
  const auto first = [&](const std::size_t n, const std::vector<Eigen::Vector3i>& triangles) {
    return shapes::matrices({points.begin(), points.begin() + std::ptrdiff_t(n)}, triangles);
  };
  CHECK(unchanged(first(3, {{0, 1, 2}})));
  CHECK_FALSE(unchanged(first(4, {{0, 1, 2}, {1, 0, 3}})));
  CHECK(unchanged(first(4, {{0, 1, 2}, {0, 1, 3}})));            // orientations disagree
  CHECK(unchanged(first(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}))); // three faces
  CHECK(unchanged(first(3, {{0, 1, 2}, {0, 1, 2}})));            // one twice
  CHECK(largest_off_diagonal(intrinsic(first(3, {{0, 1, 2}}))) > 1.);

  // A closed needle sphere with one more face on an edge is flipped elsewhere, and has its area.
  const shapes::Matrices sphere = needle_sphere(2, 0.97);
  const Eigen::Index n = sphere.V.rows(), m = sphere.T.rows();
  shapes::Matrices fin{Eigen::MatrixXd(n + 1, 3), Eigen::MatrixXi(m + 1, 3)};
  fin.V << sphere.V, 2 * sphere.V.row(0);
  fin.T << sphere.T, sphere.T(0, 0), sphere.T(0, 1), int(n);
  CHECK(intrinsic(fin).mass.sum() == Approx(plain(fin).mass.sum()));
  CHECK(intrinsic(fin).L.diagonal().sum() < 0.9 * plain(fin).L.diagonal().sum());
}

TEST_CASE("A face without area whose corner lies between the others is flipped away")
{
  // A square with a vertex on its diagonal, on one side alone.
  shapes::Matrices mesh =
      shapes::matrices({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}},
                       {{0, 1, 2}, {0, 4, 3}, {4, 2, 3}, {0, 2, 4}});
  shapes::Matrices split = mesh;
  split.T << 0, 1, 4, 1, 2, 4, 0, 4, 3, 4, 2, 3;
  for(const Mass mass : masses) {
    CHECK(difference(intrinsic(mesh, mass).L, plain(split, mass).L) < 1e-14);
    CHECK(difference(intrinsic(mesh, mass).B, plain(split, mass).B) < 1e-14);
  }

  // Two of them, and with vertices of both sides between each other.
  mesh = shapes::matrices({{0, 0, 0}, {4, -3, 0}, {4, 4, 0}, {-3, 4, 0}, {1, 1, 0}, {3, 3, 0}},
                          {{0, 1, 4}, {4, 1, 2}, {0, 5, 3}, {5, 2, 3}, {0, 4, 2}, {0, 2, 5}});
  split = mesh;
  split.T << 0, 1, 4, 4, 1, 5, 5, 1, 2, 0, 4, 3, 4, 5, 3, 5, 2, 3;
  CHECK(difference(intrinsic(mesh).L, intrinsic(split).L) < 1e-14);
  CHECK((intrinsic(mesh).mass - intrinsic(split).mass).norm() < 1e-14);
  CHECK(SG::number_of_zero_eigenvalues(intrinsic(mesh)) == 1);

  // Neither of two equal vertices is between others: faces at an edge without length stay.
  mesh = shapes::matrices({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}},
                          {{0, 1, 2}, {4, 2, 3}, {0, 2, 4}});
  CHECK(intrinsic(mesh).mass.sum() == Approx(1.));
  CHECK(largest_off_diagonal(intrinsic(mesh)) < 1e-15);
}

TEST_CASE("Flips end, whatever is degenerate")
{
  // Thinner than rounding: lengths are those of edges that wind around it without end.
  const shapes::Matrices line = shapes::matrices({{-1, 0.0080509370705163265, -0.55266783910725381},
                                                  {-1, 0.0056032834837931814, -0.38464523418448993},
                                                  {-1, 0.014567406497764232, -1},
                                                  {-1, -0.014567406497764241, 1}},
                                                 {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}});
  CHECK_THROWS_WITH(intrinsic(line),
                    ContainsSubstring("vertex 0 ") && ContainsSubstring("zero area"));

  // Vertices on few points of a grid: faces without area or on top of each other, edges without
  // length.
  std::mt19937 random(1);
  int refused = 0, accepted = 0;
  for(int run = 0; run < 300; ++run) {
    shapes::Matrices mesh = run % 3 == 0   ? shapes::icosphere_matrices(2)
                            : run % 3 == 1 ? shapes::torus_matrices(12, 9)
                                           : shapes::irregular_grid_matrices(10, 12);
    const double cell = std::pow(2., -int(random() % 5)),
                 noise = run % 2 ? 0. : std::pow(10., -int(random() % 12) - 6);
    for(Eigen::Index v = 0; v < mesh.V.rows(); ++v)
      for(int c = 0; c < 3; ++c)
        mesh.V(v, c) = cell * std::round(mesh.V(v, c) / cell) +
                       noise * (double(random()) / double(random.max()) - 0.5);
    try {
      const Laplace_operator op = intrinsic(mesh, masses[run % 3]);
      ++accepted;
      const double size = op.L.diagonal().maxCoeff();
      CHECK((op.L * Eigen::VectorXd::Ones(op.L.cols())).cwiseAbs().maxCoeff() <= 1e-12 * size);
      CHECK(eigenvalues(op.L)(0) >= -1e-12 * size);
    } catch(const std::invalid_argument& error) {
      ++refused;
      CHECK_THAT(error.what(), ContainsSubstring("no mass") || ContainsSubstring("needle"));
    }
  }
  CHECK(accepted > 20);
  CHECK(refused > 20);
}

TEST_CASE("Bad meshes are refused by the name of the first offender, before and after flips")
{
  const shapes::Matrices good = shapes::grid_matrices(4, 4);
  const auto refused = [](const shapes::Matrices& mesh, const std::string& offender,
                          const std::string& fault) {
    CHECK_THROWS_WITH(intrinsic(mesh), ContainsSubstring(offender) && ContainsSubstring(fault));
  };
  shapes::Matrices mesh = good;
  mesh.V(7, 1) = std::numeric_limits<double>::quiet_NaN();
  refused(mesh, "vertex 7 ", "not a finite number");
  CHECK_THROWS_WITH(SG::intrinsic_delaunay_laplacian(mesh.V.leftCols(2), mesh.T),
                    ContainsSubstring("3 columns"));
  mesh = good; // indices, as of any operator
  mesh.T(5, 2) = 25;
  refused(mesh, "face 5 ", "0..24");
  mesh = good;
  mesh.V.conservativeResize(26, 3);
  mesh.V.row(25).setConstant(0.5);
  refused(mesh, "vertex 25 ", "isolated");
  mesh = good;
  mesh.V.col(0) = mesh.V.col(1);
  refused(mesh, "vertex 0 ", "zero area");
  mesh.V.setZero();
  refused(mesh, "vertex 0 ", "zero area");
  // On a border nothing can be flipped.
  mesh = shapes::matrices({{0, 0, 0}, {1, 0, 0}, {0.5, -1e-13, 0}}, {{0, 2, 1}});
  refused(mesh, "0, 2 and 1 ", "needle");
  // With a face beyond its longest edge the needle is gone.
  mesh =
      shapes::matrices({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, -1e-13, 0}}, {{0, 1, 2}, {0, 3, 1}});
  CHECK_THROWS_WITH(plain(mesh), ContainsSubstring("needle"));
  CHECK(intrinsic(mesh).L.coeff(2, 3) == Approx(-0.5)); // right at 0, an eighth of a turn at 1
  // An area overflows, then differences of coordinates do.
  mesh = {1e160 * good.V, good.T};
  refused(mesh, "0, 1 and 6 ", "too large");
  mesh.V = (2. * good.V.array() - 1.) * 1.7e308;
  refused(mesh, "0, 1 and 6 ", "too large");
}

} // namespace test_intrinsic_delaunay
