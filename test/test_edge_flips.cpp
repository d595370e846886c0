// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Edge flips: costs against a slow recomputation, the guards, mesh types, the one-call form.

#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_flips.h>

#include "catch.h"
#include "collapse_helpers.h"
#include "topology.h"

#include <CGAL/Polyhedron_3.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_geometry/internal/search/triangles_intersect.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace test_edge_flips {

using namespace spectral_test;
using Catch::Matchers::ContainsSubstring;
using Edges = std::set<std::pair<int, int>>;

namespace {

constexpr Eigen::Index K = 20;

// A coarse mesh with what flips ask for.
struct Example
{
  shapes::Matrices coarse;
  Eigen::SparseMatrix<double> P;
  Eigen::MatrixXd F, Z;
};

// A mesh that is its own fine mesh, so that E is 0 as long as no edge is another.
Example own_fine_mesh(const shapes::Matrices& mesh, const double theta)
{
  Example example;
  example.coarse = mesh;
  example.P.resize(mesh.V.rows(), mesh.V.rows());
  example.P.setIdentity();
  example.F = rough_signals(mesh, 6);
  const SG::Laplace_operator op = SG::laplace_operator(mesh.V, mesh.T, theta);
  example.Z = Eigen::MatrixXd(op.B).ldlt().solve(op.L * example.F);
  return example;
}

double slow_energy(const Example& s, const Eigen::MatrixXi& T, const double theta)
{
  return SG::restriction_energy(SG::laplace_operator(s.coarse.V, T, theta), s.P, s.F, s.Z);
}

SG::Edge_flip_result flipped(const Example& s, Eigen::MatrixXi& T, const double theta,
                             const SG::Edge_flip_options& options = {},
                             const std::vector<std::pair<int, int>>& constrained = {})
{
  T = s.coarse.T;
  return SG::flip_edges(s.coarse.V, T, s.P, s.F, s.Z, theta, constrained, options);
}

// Edges that have `faces` triangles.
Edges edges_of(const Eigen::MatrixXi& T, const int faces)
{
  std::multiset<std::pair<int, int>> all;
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    for(int k = 0; k < 3; ++k)
      all.insert(std::minmax({T(f, k), T(f, (k + 1) % 3)}));
  Edges result;
  for(const auto& edge : all)
    if(int(all.count(edge)) == faces)
      result.insert(edge);
  return result;
}

// The two triangles of an edge, and the corner opposite to it.
std::vector<std::pair<Eigen::Index, int>> triangles_at(const Eigen::MatrixXi& T, const int i, const int j)
{
  std::vector<std::pair<Eigen::Index, int>> result;
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    for(int k = 0; k < 3; ++k)
      if(std::minmax(T(f, (k + 1) % 3), T(f, (k + 2) % 3)) == std::minmax(i, j))
        result.emplace_back(f, k);
  return result;
}

// A flip as one does it by hand.
void flip_slowly(Eigen::MatrixXi& T, const int i, const int j)
{
  const auto at = triangles_at(T, i, j);
  REQUIRE(at.size() == 2);
  const auto [f, k] = at[0];
  const int c = T(f, k), first = T(f, (k + 1) % 3), second = T(f, (k + 2) % 3);
  const int d = T(at[1].first, at[1].second);
  T.row(f) << c, first, d;
  T.row(at[1].first) << d, second, c;
}

Eigen::Vector3d normal(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const Eigen::Index f)
{
  const Eigen::Vector3d a = V.row(T(f, 1)) - V.row(T(f, 0)), b = V.row(T(f, 2)) - V.row(T(f, 0));
  return a.cross(b).normalized();
}

double smallest_angle(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const Eigen::Index f)
{
  const SG::Triangle_cotangents t = SG::triangle_cotangents(V.row(T(f, 0)), V.row(T(f, 1)), V.row(T(f, 2)));
  return std::atan2(1., t.cot.maxCoeff());
}

double volume(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T)
{
  double sum = 0;
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    sum += V.row(T(f, 0)).transpose().head<3>().dot(
               V.row(T(f, 1)).transpose().head<3>().cross(V.row(T(f, 2)).transpose().head<3>())) /
           6;
  return sum;
}

// Turns edges the wrong way: those whose quadrangle is nearly flat and convex, at least `rings` rings of triangles apart.
int turn_edges(shapes::Matrices& mesh, const int rings)
{
  std::vector<char> near(std::size_t(mesh.V.rows()), 0);
  int turned = 0;
  for(const auto& [i, j] : edges_of(mesh.T, 2)) {
    const auto before = triangles_at(mesh.T, i, j);
    const int c = mesh.T(before[0].first, before[0].second), d = mesh.T(before[1].first, before[1].second);
    if(near[std::size_t(i)] || near[std::size_t(j)] || near[std::size_t(c)] || near[std::size_t(d)] ||
       !triangles_at(mesh.T, c, d).empty())
      continue;
    Eigen::MatrixXi T = mesh.T;
    flip_slowly(T, i, j);
    bool good = true;
    for(const auto& old_face : before)
      for(const auto& new_face : triangles_at(T, c, d))
        good = good && smallest_angle(mesh.V, T, new_face.first) > 0.3 &&
               normal(mesh.V, T, new_face.first).dot(normal(mesh.V, mesh.T, old_face.first)) > 0.7;
    if(!good)
      continue;
    mesh.T = T;
    ++turned;
    for(const int v : {i, j, c, d})
      near[std::size_t(v)] = 1;
    for(int ring = 0; ring < rings; ++ring) {
      const std::vector<char> inside = near;
      for(Eigen::Index f = 0; f < T.rows(); ++f)
        if(inside[std::size_t(T(f, 0))] || inside[std::size_t(T(f, 1))] || inside[std::size_t(T(f, 2))])
          for(int k = 0; k < 3; ++k)
            near[std::size_t(T(f, k))] = 1;
    }
  }
  return turned;
}

Example simplified(const shapes::Matrices& fine, const std::size_t N)
{
  SMS::Spectral_edge_collapse_options options = options_with(K);
  options.mass = SG::Mass::averaged;
  Mesh mesh = make_mesh(fine);
  const auto result = SMS::spectral_edge_collapse(mesh, N, options);
  Example example;
  example.coarse = SG::mesh_matrices(mesh);
  turn_edges(example.coarse, 0); // collapses leave few flips that pay
  example.P = result.restriction;
  example.F = result.eigenpairs->vectors;
  example.Z = example.F * result.eigenpairs->values.asDiagonal();
  return example;
}

const Example& closed_example()
{
  static const Example example = simplified(shapes::bumpy_icosphere_matrices(4), 160);
  return example;
}

const Example& open_example()
{
  static const Example example = simplified(wavy_grid_matrices(36, 30), 150);
  return example;
}

// What one flip broke that the guards promise; empty if all is well.
std::string broken_guard(const Example& s, const Eigen::MatrixXi& before, const Eigen::MatrixXi& after,
                         const SG::Edge_flip& flip)
{
  if(!triangles_at(before, flip.to[0], flip.to[1]).empty())
    return "the new edge was there already";
  const auto old_faces = triangles_at(before, flip.from[0], flip.from[1]);
  const auto new_faces = triangles_at(after, flip.to[0], flip.to[1]);
  if(old_faces.size() != 2 || new_faces.size() != 2)
    return "the edge was no inner one";
  double angles[2] = {4, 4};
  for(std::size_t k = 0; k < 2; ++k) {
    angles[0] = (std::min)(angles[0], smallest_angle(s.coarse.V, before, old_faces[k].first));
    angles[1] = (std::min)(angles[1], smallest_angle(s.coarse.V, after, new_faces[k].first));
    for(const auto& old_face : old_faces)
      if(normal(s.coarse.V, after, new_faces[k].first).dot(normal(s.coarse.V, before, old_face.first)) <
         0.5 - 1e-9)
        return "a triangle has turned";
  }
  return angles[1] < 0.5 * angles[0] - 1e-9 ? "an angle has become too small" : "";
}

} // namespace

TEST_CASE("each flip changes E by its cost, which is negative, and keeps the guards")
{
  for(const Example* s : {&closed_example(), &open_example()})
    for(const double theta : {0., 0.5, 1.}) {
      CAPTURE(theta);
      Eigen::MatrixXi T, replayed = s->coarse.T;
      const SG::Edge_flip_result result = flipped(*s, T, theta);
      REQUIRE(result.flips.size() > 5);
      double E = slow_energy(*s, replayed, theta);
      CHECK(relative_difference(E, result.E_before) < 1e-9);
      for(const SG::Edge_flip& flip : result.flips) {
        const Eigen::MatrixXi before = replayed;
        flip_slowly(replayed, flip.from[0], flip.from[1]);
        const double now = slow_energy(*s, replayed, theta);
        CHECK(flip.E_change < 0);
        CHECK(std::abs(now - E - flip.E_change) < 1e-9 * result.E_before);
        CHECK(broken_guard(*s, before, replayed, flip) == "");
        E = now;
      }
      CHECK(relative_difference(E, result.E_after) < 1e-9);
      CHECK((edges_of(T, 2) == edges_of(replayed, 2)));
      CHECK((edges_of(T, 1) == edges_of(s->coarse.T, 1)));
      const Mesh mesh = make_mesh({s->coarse.V, T}), before = make_mesh(s->coarse);
      CHECK(CGAL::is_valid_polygon_mesh(mesh));
      CHECK(topology(mesh) == topology(before));
      CHECK(SG::internal::self_intersecting_faces(s->coarse.V, T).empty());
      const double area = SG::laplace_operator(s->coarse.V, T).mass.sum() /
                          SG::laplace_operator(s->coarse.V, s->coarse.T).mass.sum();
      CHECK(std::abs(area - 1) <= 0.01);
      if(s == &closed_example())
        CHECK(std::abs(volume(s->coarse.V, T) / volume(s->coarse.V, s->coarse.T) - 1) <= 0.01);
    }
}

TEST_CASE("no flip of negative cost is left that a guard does not forbid")
{
  const Example& s = closed_example();
  Eigen::MatrixXi T;
  flipped(s, T, 0.5);
  Example again = s;
  again.coarse.T = T;
  SG::Edge_flip_options options; // sizes count from the start of a run
  const SG::Edge_flip_result second = flipped(again, T, 0.5, options);
  CHECK(second.flips.empty());
}

TEST_CASE("diagonals that were turned the wrong way are turned back")
{
  for(const double theta : {0., 0.5}) {
    const Example right = own_fine_mesh(shapes::bumpy_icosphere_matrices(3), theta);
    Example wrong = right;
    const int turned = turn_edges(wrong.coarse, 2);
    REQUIRE(turned > 4);
    Eigen::MatrixXi T;
    SG::Edge_flip_options options;
    options.size_tolerance = 1;
    const SG::Edge_flip_result result = flipped(wrong, T, theta, options);
    CHECK(int(result.flips.size()) == turned);
    CHECK((edges_of(T, 2) == edges_of(right.coarse.T, 2)));
    CHECK(result.E_after < 1e-18 * result.E_before);
    CHECK(flipped(right, T, theta).flips.empty());
  }
}

TEST_CASE("constrained edges stay, and a budget ends the flips")
{
  const Example& s = closed_example();
  Eigen::MatrixXi T;
  const SG::Edge_flip_result free = flipped(s, T, 0.5);
  std::vector<std::pair<int, int>> constrained;
  for(const SG::Edge_flip& flip : free.flips)
    if(!triangles_at(s.coarse.T, flip.from[0], flip.from[1]).empty())
      constrained.emplace_back(flip.from[1], flip.from[0]);
  REQUIRE(constrained.size() > 5);
  flipped(s, T, 0.5, {}, constrained);
  for(const auto& [i, j] : constrained)
    CHECK(triangles_at(T, i, j).size() == 2);

  SG::Edge_flip_options options;
  options.maximum_flips = 3;
  const SG::Edge_flip_result few = flipped(s, T, 0.5, options);
  REQUIRE(few.flips.size() == 3);
  CHECK(few.flips[2].from[0] == free.flips[2].from[0]);
  CHECK(relative_difference(few.E_after, slow_energy(s, T, 0.5)) < 1e-9);
  options.maximum_seconds = 0;
  CHECK(flipped(s, T, 0.5, options).flips.empty());
  options = {};
  options.criterion = SG::Edge_flips::none;
  const SG::Edge_flip_result none = flipped(s, T, 0.5, options);
  CHECK(none.flips.empty());
  CHECK(T == s.coarse.T);
  CHECK(none.E_before == free.E_before);
  CHECK(none.E_after == free.E_before);
}

TEST_CASE("every edge of a tetrahedron is there already")
{
  Example s = own_fine_mesh(shapes::tetrahedron_matrices(), 0.);
  s.F.setRandom();
  s.Z.setRandom();
  Eigen::MatrixXi T;
  SG::Edge_flip_options options;
  options.largest_turn = CGAL_PI / 2;
  options.size_tolerance = 10;
  CHECK(flipped(s, T, 0., options).flips.empty());
  CHECK(T == s.coarse.T);
}

TEST_CASE("Delaunay flips leave no negative cotangent weight in the plane")
{
  const Example s = own_fine_mesh(shapes::irregular_grid_matrices(12, 10, 0.4), 0.5);
  const auto negative = [&](const Eigen::MatrixXi& T) {
    const SG::Laplace_operator op = SG::laplace_operator(s.coarse.V, T);
    int count = 0;
    for(const auto& [i, j] : edges_of(T, 2))
      count += op.L.coeff(i, j) > 1e-8;
    return count;
  };
  Eigen::MatrixXi T;
  SG::Edge_flip_options options;
  options.criterion = SG::Edge_flips::delaunay;
  REQUIRE(negative(s.coarse.T) > 5);
  const SG::Edge_flip_result result = flipped(s, T, 0.5, options);
  CHECK(result.flips.size() > 5);
  CHECK(negative(T) == 0);
  CHECK((edges_of(T, 1) == edges_of(s.coarse.T, 1)));
  CHECK(relative_difference(result.E_after, slow_energy(s, T, 0.5)) < 1e-9);
}

TEST_CASE("a flip does not cut through what lies beneath")
{
  // A roof whose ridge gives way to a valley, and a spike that fits under the roof only.
  Example s = own_fine_mesh(shapes::matrices({{-1, 0, 0.1},
                                              {1, 0, 0.1},
                                              {0, -0.5, 0},
                                              {0, 0.5, 0},
                                              {0.05, 0.1, -0.2},
                                              {-0.05, 0.1, -0.2},
                                              {0, 0.12, 0.05}},
                                             {{2, 1, 0}, {3, 0, 1}, {4, 5, 6}}),
                            0.);
  REQUIRE(SG::internal::self_intersecting_faces(s.coarse.V, s.coarse.T).empty());
  Eigen::MatrixXi T;
  SG::Edge_flip_options options;
  options.criterion = SG::Edge_flips::delaunay;
  options.size_tolerance = 0.5;
  const SG::Edge_flip_result held = flipped(s, T, 0., options);
  CHECK(held.flips.empty());
  CHECK(held.refused_for_intersections == 1);
  CHECK(T == s.coarse.T);
  options.keep_free_of_self_intersections = false;
  CHECK(flipped(s, T, 0., options).flips.size() == 1);
  CHECK(!SG::internal::self_intersecting_faces(s.coarse.V, T).empty());
  options.size_tolerance = 1e-6;
  CHECK(flipped(s, T, 0., options).refused_for_size == 1);
}

TEST_CASE("any mesh type is flipped as the matrices are, constrained edges by their map")
{
  const Example& s = open_example();
  Eigen::MatrixXi T;
  const SG::Edge_flip_result expected = flipped(s, T, 0.5);
  Mesh mesh = make_mesh(s.coarse);
  CGAL::Polyhedron_3<Kernel> polyhedron;
  shapes::make_mesh(polyhedron, s.coarse);
  const auto result = SMS::spectral_edge_flips(mesh, s.P, s.F, s.Z, SG::Mass::averaged);
  SMS::spectral_edge_flips(polyhedron, s.P, s.F, s.Z, SG::Mass::averaged);
  CHECK(result.E_after == expected.E_after);
  CHECK((edges_of(SG::mesh_matrices(mesh).T, 2) == edges_of(T, 2)));
  CHECK((edges_of(SG::mesh_matrices(polyhedron).T, 2) == edges_of(T, 2)));
  CHECK(CGAL::is_valid_polygon_mesh(mesh));
  CHECK(CGAL::is_valid_polygon_mesh(polyhedron));
  CHECK(SG::mesh_matrices(mesh).V == s.coarse.V);

  Mesh held = make_mesh(s.coarse);
  auto constraints = held.add_property_map<Mesh::Edge_index, bool>("e:constrained", true).first;
  const auto np = CGAL::parameters::edge_is_constrained_map(constraints);
  SG::Eigenpairs pairs;
  pairs.vectors = s.F;
  pairs.values = (s.F.transpose() * s.Z).diagonal().cwiseQuotient(s.F.colwise().squaredNorm().transpose());
  CHECK(SMS::spectral_edge_flips(held, s.P, pairs, SG::Mass::averaged, {}, np).flips.empty());
  for(const auto e : edges(held))
    constraints[e] = false;
  const auto freed = SMS::spectral_edge_flips(held, s.P, pairs, SG::Mass::averaged, {}, np);
  CHECK(relative_difference(freed.E_after, expected.E_after) < 1e-9);
}

TEST_CASE("the one-call form flips after the collapses and relocates what it flipped")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(4);
  SMS::Spectral_edge_collapse_options options = options_with(K);
  options.mass = SG::Mass::averaged;
  Mesh plain = make_mesh(input);
  const auto before = SMS::spectral_edge_collapse(plain, 160, options);
  CHECK(before.flips.flips.empty());
  options.eigenpairs = before.eigenpairs;
  const Basis basis = eigen_input(input, options.mass, *before.eigenpairs).basis;
  for(const SG::Edge_flips flips : {SG::Edge_flips::spectral, SG::Edge_flips::delaunay})
    for(const bool relocate : {false, true}) {
      options.flips = flips;
      options.relocate = relocate;
      bool told = false;
      options.progress = [&](const SMS::Spectral_progress& p) {
        told = told || p.phase == SMS::Spectral_phase::flips;
        return true;
      };
      Mesh mesh = make_mesh(input);
      const auto after = SMS::spectral_edge_collapse(mesh, 160, options);
      const shapes::Matrices a = SG::mesh_matrices(plain), b = SG::mesh_matrices(mesh);
      CHECK(told);
      CHECK(!after.flips.flips.empty());
      CHECK((edges_of(a.T, 2) != edges_of(b.T, 2)));
      CHECK((a.V == b.V) == !relocate);
      CHECK((after.relocation.moved_vertices > 100) == relocate);
      CHECK(((before.restriction - after.restriction).norm() == 0) == !relocate); // which takes P anew
      CHECK(relative_difference(energy(b, basis, after.restriction), after.E) < 1e-8);
      CHECK(relative_difference(std::sqrt(after.E / basis.lambda.squaredNorm()), after.relative_error) <
            1e-8);
      if(flips == SG::Edge_flips::spectral && !relocate)
        CHECK(after.E < before.E);
    }

  options.flips = SG::Edge_flips::spectral;
  options.progress = [](const SMS::Spectral_progress& p) { return p.phase != SMS::Spectral_phase::flips; };
  Mesh mesh = make_mesh(input);
  const auto cancelled = SMS::spectral_edge_collapse(mesh, 160, options);
  CHECK(cancelled.stop_reason == SMS::Spectral_edge_collapse_result::Stop_reason::cancelled);
  CHECK(SG::mesh_matrices(mesh).T == SG::mesh_matrices(plain).T);
  CHECK(cancelled.E == before.E);
}

TEST_CASE("edge flips refuse what does not belong together")
{
  const Example& s = closed_example();
  const auto refusal = [&](const Eigen::MatrixXi& triangles, const Eigen::SparseMatrix<double>& P,
                           const SG::Edge_flip_options& options) {
    Eigen::MatrixXi T = triangles;
    try {
      SG::flip_edges(s.coarse.V, T, P, s.F, s.Z, 0.5, {}, options);
    } catch(const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(refusal(s.coarse.T, s.P.transpose(), {}), ContainsSubstring("coarse x fine"));
  SG::Edge_flip_options options;
  options.smallest_angle_ratio = 2;
  CHECK_THAT(refusal(s.coarse.T, s.P, options), ContainsSubstring("smallest_angle_ratio"));
  options = {};
  options.largest_turn = 0;
  CHECK_THAT(refusal(s.coarse.T, s.P, options), ContainsSubstring("largest_turn"));
  options = {};
  options.size_tolerance = 0;
  CHECK_THAT(refusal(s.coarse.T, s.P, options), ContainsSubstring("size_tolerance"));
  Eigen::MatrixXi T = s.coarse.T;
  std::swap(T(7, 0), T(7, 1));
  CHECK_THAT(refusal(T, s.P, {}), ContainsSubstring("manifold"));
}

} // namespace test_edge_flips
