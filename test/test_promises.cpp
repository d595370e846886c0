// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// What is promised, in the ways to run it: policies, policies with a wrapper, the one call.

#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/spectral_relocation.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>

#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>

#include "catch.h"
#include "collapse_helpers.h"

#include <new>

namespace test_promises {

using namespace spectral_test;

namespace {

using Policies = SMS::Spectral_policies<Mesh>;
using Signals = SG::Relocation_options::Signals;

std::size_t crossings(const Mesh& mesh)
{
  const shapes::Matrices m = SG::mesh_matrices(mesh);
  return SG::internal::self_intersecting_faces(m.V, m.T).size();
}

// What a user writes who has constrained edges.
void collapse_wrapped(Mesh& mesh, const Policies& spectral, const Constraints& constraints,
                      const std::size_t N, const bool filtered = true)
{
  const SMS::Constrained_placement<Policies::Get_placement, Constraints> placement(
      constraints, spectral.get_placement());
  const SMS::Vertex_count_stop_predicate<Mesh> stop(N, mesh);
  const auto np = CGAL::parameters::get_cost(spectral.get_cost())
                      .get_placement(placement)
                      .edge_is_constrained_map(constraints)
                      .visitor(spectral.visitor());
  if(filtered)
    SMS::edge_collapse(mesh, stop, np.filter(spectral.filter()));
  else
    SMS::edge_collapse(mesh, stop, np);
}

template <class Options>
Options default_options_with(const Eigen::Index K)
{
  Options options;
  options.number_of_eigenvectors = K;
  return options;
}

enum class Source { eigenpairs, own_signals, noise };

SMS::Spectral_options options_of(const Source source, const shapes::Matrices& input)
{
  auto options = default_options_with<SMS::Spectral_options>(20);
  if(source == Source::noise)
    options.source = SMS::Spectral_signal_source::filtered_noise;
  if(source == Source::own_signals)
    options.signals =
        SG::eigenpairs(SG::laplace_operator(input.V, input.T, options.mass), 20).vectors;
  return options;
}

double norm_L(const shapes::Matrices& fine, const Mesh& mesh, const Eigen::SparseMatrix<double>& P)
{
  const SG::Eigenpairs a =
      SG::eigenpairs(SG::laplace_operator(fine.V, fine.T, SG::Mass::averaged), 20);
  const SG::Laplace_operator op = SG::cotangent_laplacian(mesh, SG::Mass::averaged);
  const SG::Eigenpairs b = SG::eigenpairs(op, 20);
  const Eigen::MatrixXd C = b.vectors.transpose() * (op.B * (P * a.vectors));
  return (C * a.values.asDiagonal() - b.values.asDiagonal() * C).norm() / C.norm();
}

} // namespace

TEST_CASE("relocation after the policies leaves constrained edges and kept vertices, whatever the "
          "signals",
          "[slow]")
{
  const Source source = GENERATE(Source::eigenpairs, Source::own_signals, Source::noise);
  const bool told_late = GENERATE(false, true);
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  SMS::Spectral_options options = options_of(source, input);
  options.kept_vertices = every(61, input.V.rows(), 7);
  Mesh mesh = make_mesh(input);
  const Constraints constraints = constrain_every(97, mesh);
  const std::set<Kernel::Point_3> before = ends(mesh, constraints);
  REQUIRE(before.size() > 20);
  const auto np = CGAL::parameters::edge_is_constrained_map(constraints);
  const Policies spectral = told_late ? Policies(mesh, options) : Policies(mesh, options, np);
  collapse_wrapped(mesh, spectral, constraints, 160);
  REQUIRE(count_vertices(mesh) == 160);
  const Eigen::MatrixXd collapsed = positions(mesh);
  const Eigen::SparseMatrix<double> P = spectral.restriction();
  const double norm_before = norm_L(input, mesh, P);
  const SG::Relocation_result result = told_late ? SMS::spectral_relocation(mesh, spectral, {}, np)
                                                 : SMS::spectral_relocation(mesh, spectral);
  CHECK(ends(mesh, constraints) == before);
  CHECK(survivors(options.kept_vertices, input, mesh, result.restriction, spectral.vertex_map()) ==
        options.kept_vertices.size());
  CHECK(result.moved_vertices > 40);
  CHECK(positions(mesh) != collapsed);
  CHECK(norm_L(input, mesh, result.restriction) < 0.9 * norm_before);
  const Eigen::VectorXd sums = result.restriction * Eigen::VectorXd::Ones(P.cols());
  CHECK((sums.array() - 1).abs().maxCoeff() < 1e-12);
  CHECK((spectral.restriction() - P).norm() == 0);
}

TEST_CASE("relocation after the policies is that of the one call")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  auto options = default_options_with<SMS::Spectral_edge_collapse_options>(20);
  options.quadrics_above = std::numeric_limits<double>::infinity();
  Mesh one = make_mesh(input), other = one;
  const auto result = SMS::spectral_edge_collapse(one, 100, options);
  const Policies spectral(other, options);
  collapse(other, spectral, 100);
  const SG::Relocation_result relocated = SMS::spectral_relocation(other, spectral);
  CHECK(positions(one) == positions(other));
  CHECK((result.restriction - relocated.restriction).norm() == 0);
}

TEST_CASE("relocation after the policies refuses what it cannot know or keep")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  auto options = default_options_with<SMS::Spectral_options>(10);
  options.binary = true;
  Mesh mesh = make_mesh(input), copy = mesh;
  const Constraints constraints = constrain_every(31, mesh);
  const Policies spectral(mesh, options);
  collapse_wrapped(mesh, spectral, constraints, 80);
  const Eigen::MatrixXd before = positions(mesh);
  const auto refusal = [&](Mesh& of) -> std::string {
    try {
      SMS::spectral_relocation(of, spectral);
    } catch(const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  CHECK_THAT(refusal(mesh), ContainsSubstring("edge_is_constrained_map"));
  CHECK_THAT(refusal(copy), ContainsSubstring("another mesh"));
  Mesh plain = make_mesh(input);
  const Policies binary(plain, options);
  collapse(plain, binary, 80);
  CHECK_THROWS_WITH(SMS::spectral_relocation(plain, binary), ContainsSubstring("not binary"));
  SG::Relocation_options carried;
  carried.signals = Signals::carried;
  const auto P = SMS::spectral_relocation(plain, binary, carried).restriction;
  CHECK(fault_of_restriction(P, binary.vertex_map(), true) == "");
  CHECK(positions(mesh) == before);
}

TEST_CASE("a wrapped placement without the filter is refused before a collapse that nobody has "
          "looked at")
{
  const shapes::Matrices input = shapes::folded_limb_matrices(120, 16, 0.06);
  auto options = default_options_with<SMS::Spectral_options>(20);
  const bool guarded = GENERATE(false, true), kept = GENERATE(false, true);
  options.keep_free_of_self_intersections = guarded;
  if(kept)
    options.kept_vertices = every(101, input.V.rows(), 3);
  Mesh mesh = make_mesh(input);
  const Constraints constraints = constrain_every(53, mesh);
  const Policies spectral(mesh, options);
  if(guarded || kept) {
    CHECK_THROWS_WITH(collapse_wrapped(mesh, spectral, constraints, 300, false),
                      ContainsSubstring("spectral.filter()"));
    CHECK(CGAL::is_valid_polygon_mesh(mesh));
    collapse_wrapped(mesh, spectral, constraints, 300); // goes on from there
  } else
    collapse_wrapped(mesh, spectral, constraints, 300, false);
  CHECK(count_vertices(mesh) < 500);
  if(guarded)
    CHECK(crossings(mesh) == 0);
  CHECK(survivors(options.kept_vertices, input, mesh, spectral.restriction(),
                  spectral.vertex_map()) == options.kept_vertices.size());
}

TEST_CASE("policies that stop early say why, and what to do")
{
  Mesh mesh = make_mesh(shapes::components_matrices(shapes::torus_matrices(24, 12), 2));
  const Policies spectral(mesh, default_options_with<SMS::Spectral_options>(10));
  CHECK(spectral.explanation() == "");
  collapse(mesh, spectral, 100);
  CHECK(spectral.explanation() == "");
  CHECK(spectral.warnings().empty());
  collapse(mesh, spectral, 3);
  CHECK(count_vertices(mesh) >= 14);
  CHECK_THAT(spectral.explanation(), ContainsSubstring("2 components") &&
                                         ContainsSubstring("genus 2") &&
                                         ContainsSubstring("ask for more vertices"));
  CHECK(spectral.refusals().topology > 0);
  const std::vector<std::string> warnings = spectral.warnings();
  REQUIRE(!warnings.empty());
  CHECK_THAT(warnings.front(), ContainsSubstring("less than 3 K"));
  CHECK((spectral.relative_error() > 0.5) == (warnings.size() == 2));
}

TEST_CASE("genus and components are those of Euler's formula")
{
  const auto genus = [](const shapes::Matrices& m) { return SMS::internal::genus(m); };
  CHECK(genus(shapes::tetrahedron_matrices()) == 0);
  CHECK(genus(shapes::grid_matrices(4, 5)) == 0);
  CHECK(genus(shapes::torus_matrices(7, 5)) == 1);
  CHECK(genus(shapes::components_matrices(shapes::torus_matrices(7, 5), 3)) == 3);
  shapes::Matrices cut = shapes::torus_matrices(7, 5); // of one face less
  cut.T.conservativeResize(cut.T.rows() - 1, Eigen::NoChange);
  CHECK(genus(cut) == 1);
}

namespace {

struct Counts
{
  int started = 0, finished = 0;
};

struct Counting_visitor : SMS::internal::Dummy_visitor
{
  Counts* counts;
  int own = 0; // a copy of its own

  explicit Counting_visitor(Counts& c)
    : counts(&c)
  {}
  void OnStarted(Mesh&) { counts->started += ++own; }
  void OnFinished(Mesh&) { counts->finished += own; }
};

} // namespace

TEST_CASE("a visitor sees one run, also where the loop begins again")
{
  // Four shells, each close inside of the one before: once some have become small, others may go
  // on.
  const shapes::Matrices shell = shapes::bumpy_icosphere_matrices(2);
  shapes::Matrices input = shapes::components_matrices(shell, 4);
  const Eigen::Index n = shell.V.rows();
  for(int c = 0; c < 4; ++c)
    input.V.middleRows(c * n, n) = (1 - 0.006 * c) * shell.V;
  auto options = default_options_with<SMS::Spectral_edge_collapse_options>(12);
  options.relocate = false;
  Mesh mesh = make_mesh(input);
  Counts counts;
  const auto result = SMS::spectral_edge_collapse(
      mesh, 20, options, CGAL::parameters::visitor(Counting_visitor(counts)));
  CHECK(result.output_vertices > 20);
  CHECK(counts.started == 1);
  CHECK(counts.finished == 1);
}

namespace {

// The points of a mesh; writes the tenth and then fails as memory does, once, where that is armed.
struct Failing_points
{
  using key_type = Mesh::Vertex_index;
  using value_type = Kernel::Point_3;
  using reference = const value_type&;
  using category = boost::lvalue_property_map_tag;

  Mesh* mesh;
  int* left; // until it fails; negative: it does not

  friend reference get(const Failing_points& map, const key_type v) { return map.mesh->point(v); }
  friend void put(const Failing_points& map, const key_type v, const value_type& p)
  {
    if(*map.left >= 0 && (*map.left)-- == 0)
      throw std::bad_alloc();
    map.mesh->point(v) = p;
  }
};

} // namespace

TEST_CASE("a stage after the collapses that runs out of memory is a warning: mesh and P of the "
          "collapses are returned")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  auto options = default_options_with<SMS::Spectral_edge_collapse_options>(20);
  options.relocate = false;
  Mesh collapsed = make_mesh(input), mesh = collapsed;
  const auto without = SMS::spectral_edge_collapse(collapsed, 100, options);
  options.relocate = true;
  int left = -1;
  options.progress = [&](const SG::Progress& p) {
    if(p.phase == SG::Phase::relocation && left < 0)
      left = 10;
    return true;
  };
  const auto result = SMS::spectral_edge_collapse(
      mesh, 100, options, CGAL::parameters::vertex_point_map(Failing_points{&mesh, &left}));
  REQUIRE(result.warnings.size() == 1);
  CHECK_THAT(result.warnings.front(), ContainsSubstring("not relocated"));
  CHECK(positions(mesh) == positions(collapsed));
  CHECK((result.restriction - without.restriction).norm() == 0);
  CHECK(relative_difference(result.E, without.E) < 1e-10);
  CHECK(result.relocation.moved_vertices == 0);
}

TEST_CASE("a relative error above one half is a warning of its own")
{
  std::vector<std::string> warnings;
  SMS::internal::warn_of_error(warnings, 0.49);
  CHECK(warnings.empty());
  SMS::internal::warn_of_error(warnings, 0.51);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings.front(), ContainsSubstring("off by more than half on the signals"));
}

TEST_CASE("what a callback throws after the collapses comes through, and leaves their mesh")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  auto options = default_options_with<SMS::Spectral_edge_collapse_options>(20);
  options.relocate = false;
  Mesh collapsed = make_mesh(input), thrown = collapsed;
  SMS::spectral_edge_collapse(collapsed, 100, options);
  options.relocate = true;
  options.progress = [](const SG::Progress& p) {
    if(p.phase == SG::Phase::relocation && p.fraction > 0)
      throw std::domain_error("of the user's");
    return true;
  };
  CHECK_THROWS_AS(SMS::spectral_edge_collapse(thrown, 100, options), std::domain_error);
  CHECK(positions(thrown) == positions(collapsed));
}

TEST_CASE("rows of border vertices come from the border, also where relocation has made them anew")
{
  const int kind = GENERATE(0, 1, 2);
  const shapes::Matrices input = wavy_grid_matrices(40, 36);
  SMS::Spectral_edge_collapse_options options;
  if(kind == 2) { // its quadrics heed borders only if told to
    options = SMS::Spectral_edge_collapse_options::fast(150);
    options.pre_simplify = 700;
  }
  options.number_of_eigenvectors = 20;
  options.preserve_border = kind > 0;
  Mesh mesh = make_mesh(input);
  const auto result = SMS::spectral_edge_collapse(mesh, 150, options);
  REQUIRE(result.relocation.resampled);
  const Eigen::SparseMatrix<double>& P = result.restriction;
  const std::vector<char> fine = SG::internal::border_vertices(input.T, P.cols()),
                          coarse =
                              SG::internal::border_vertices(SG::mesh_matrices(mesh).T, P.rows());
  REQUIRE(std::count(coarse.begin(), coarse.end(), 1) > 10);
  double inner = 0;
  for(Eigen::Index j = 0; j < P.cols(); ++j)
    for(Eigen::SparseMatrix<double>::InnerIterator it(P, j); it; ++it)
      if(coarse[std::size_t(it.row())] && !fine[std::size_t(j)])
        inner += std::abs(it.value());
  CHECK(inner == 0);
}

} // namespace test_promises
