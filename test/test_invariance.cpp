// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// A shape in another place, at another scale, in another order is simplified alike; what a
// mesh consists of stays.

#include "catch.h"
#include "collapse_helpers.h"
#include "topology.h"

#include <Eigen/Geometry>

namespace test_invariance {

using namespace spectral_test;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;
using SMS::Spectral_options;

namespace {

struct Run
{
  double relative_error = 0;
  Eigen::MatrixXd V; // of the result
};

Run run(const shapes::Matrices& input, const Spectral_options& options, const std::size_t N)
{
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options);
  collapse(mesh, policies, N);
  REQUIRE(count_vertices(mesh) == N);
  return {policies.relative_error(), positions(mesh)};
}

// The share of the vertices of one result that are those of the other to rounding.
double share_of_common_vertices(const Eigen::MatrixXd& V, const Eigen::MatrixXd& W)
{
  Eigen::Index common = 0;
  for(Eigen::Index v = 0; v < V.rows(); ++v)
    common += (W.rowwise() - V.row(v)).rowwise().norm().minCoeff() < 1e-6;
  return double(common) / double(V.rows());
}

// Takes a shape, differently given, and how its points are brought back. To the last bit costs
// differ, and there are exact ties (an ear or a vertex of valence three can be collapsed along any
// of its edges), after which the order of collapses may go another way. So the first collapses must
// be the same, and E near at the end.
template <class Back>
void check_alike(const shapes::Matrices& input, const shapes::Matrices& other,
                 const Spectral_options& options, const Back& back)
{
  const std::size_t n = std::size_t(input.V.rows()), light = n - n / 10, deep = 120;
  const Run expected = run(input, options, light), result = run(other, options, light);
  CHECK(share_of_common_vertices(expected.V, back(result.V)) > 0.97);
  CHECK(relative_difference(result.relative_error, expected.relative_error) < 0.03);
  CHECK(relative_difference(run(other, options, deep).relative_error,
                            run(input, options, deep).relative_error) < 0.15);
}

Spectral_options some_options()
{
  Spectral_options options = options_with(12);
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  return options;
}

shapes::Matrices some_mesh(const bool bordered)
{
  return bordered ? wavy_grid_matrices(18, 15) : shapes::bumpy_icosphere_matrices(3);
}

} // namespace

TEST_CASE("A mesh that was turned and moved is collapsed in the same places")
{
  const Spectral_options options = some_options();
  const shapes::Matrices input = some_mesh(GENERATE(false, true));
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()) *
                             Eigen::AngleAxisd(2., Eigen::Vector3d::UnitX()))
                                .toRotationMatrix();
  const Eigen::RowVector3d offset(2., -3., 0.7);
  shapes::Matrices moved = input;
  moved.V = (input.V * R.transpose()).rowwise() + offset;
  check_alike(input, moved, options, [&](const Eigen::MatrixXd& V) -> Eigen::MatrixXd {
    return (V.rowwise() - offset) * R;
  });
}

TEST_CASE("A millionth of the scale or a million times it give the same collapses")
{
  const Spectral_options options = some_options();
  const shapes::Matrices input = some_mesh(GENERATE(false, true));
  for(const double scale : {1e-6, 1e6, 1e-40, 1e40}) {
    CAPTURE(scale);
    check_alike(input, scaled(input, scale), options,
                [&](const Eigen::MatrixXd& V) -> Eigen::MatrixXd { return V / scale; });
  }
  // A power of two is exact.
  CHECK(run(scaled(input, 1024), options, 120).V / 1024 == run(input, options, 120).V);
}

TEST_CASE("Ten million units away the coordinates are rounded, and little else changes")
{
  const Spectral_options options = some_options();
  const shapes::Matrices input = some_mesh(GENERATE(false, true));
  shapes::Matrices moved = input;
  moved.V.array() += 1e7; // 2e-9 is one unit in the last place
  check_alike(input, moved, options,
              [&](const Eigen::MatrixXd& V) -> Eigen::MatrixXd { return V.array() - 1e7; });
}

TEST_CASE("The order of vertices and faces does not matter")
{
  const Spectral_options options = some_options();
  const shapes::Matrices input = some_mesh(GENERATE(false, true));
  std::mt19937 random(7);
  std::vector<int> to(std::size_t(input.V.rows())), face(std::size_t(input.T.rows()));
  std::iota(to.begin(), to.end(), 0);
  std::iota(face.begin(), face.end(), 0);
  std::shuffle(to.begin(), to.end(), random);
  std::shuffle(face.begin(), face.end(), random);
  shapes::Matrices shuffled = input;
  for(Eigen::Index v = 0; v < input.V.rows(); ++v)
    shuffled.V.row(to[std::size_t(v)]) = input.V.row(v);
  for(Eigen::Index f = 0; f < input.T.rows(); ++f)
    for(int k = 0; k < 3; ++k) // another corner first
      shuffled.T(face[std::size_t(f)], k) = to[std::size_t(input.T(f, (k + f % 3) % 3))];
  check_alike(input, shuffled, options, [](const Eigen::MatrixXd& V) { return V; });
}

TEST_CASE("Components, handles and border curves are kept")
{
  shapes::Matrices input;
  Topology expected;
  std::size_t N = 0;
  SECTION("three spheres")
  {
    input = shapes::components_matrices(shapes::bumpy_icosphere_matrices(2), 3);
    expected = {3, 0, 6};
    N = 12;
  }
  SECTION("two tori")
  {
    input = shapes::components_matrices(shapes::torus_matrices(16, 10), 2);
    expected = {2, 0, 0};
    N = 40;
  }
  SECTION("a torus with two holes")
  {
    input = shapes::torus_matrices(16, 10);
    input.T.row(0) = input.T.row(input.T.rows() - 1);
    input.T.row(150) = input.T.row(input.T.rows() - 2);
    input.T.conservativeResize(input.T.rows() - 2, 3);
    expected = {1, 2, -2};
    N = 30;
  }
  SECTION("strips of nothing but border vertices")
  {
    input = shapes::components_matrices(wavy_grid_matrices(12, 1), 2);
    expected = {2, 2, 2};
    N = 6;
  }
  for(const Eigen::Index K :
      {Eigen::Index(1), Eigen::Index(2), Eigen::Index(15), input.V.rows() - 1}) {
    CAPTURE(K);
    Mesh mesh = make_mesh(input);
    const Policies policies(mesh, options_with(K));
    std::size_t zeros = 0;
    const Eigen::VectorXd& values = policies.eigenpairs()->values;
    for(Eigen::Index k = 0; k < values.size(); ++k)
      zeros += values[k] < 1e-8 * values[values.size() - 1] || values[values.size() - 1] < 1e-8;
    CHECK(zeros == (std::min)(std::size_t(K), expected.components));
    collapse(mesh, policies, N);
    CHECK((topology(mesh) == expected));
    CHECK(count_vertices(mesh) == N);
    CHECK(fault_of_restriction(policies.restriction(), policies.vertex_map()) == "");
  }
}

TEST_CASE("Property maps of what is left survive simplification and garbage collection")
{
  const shapes::Matrices input = wavy_grid_matrices(14, 12);
  Mesh mesh = make_mesh(input);
  auto number = mesh.add_property_map<Mesh::Vertex_index, int>("v:number", -1).first;
  auto name = mesh.add_property_map<Mesh::Face_index, std::string>("f:name", "").first;
  for(const auto v : vertices(mesh))
    number[v] = int(v.idx());
  for(const auto f : faces(mesh))
    name[f] = std::to_string(f.idx());
  const Policies policies(mesh, options_with(8));
  collapse(mesh, policies, 60);
  std::set<int> numbers;
  std::set<std::string> names;
  for(const auto v : vertices(mesh))
    numbers.insert(number[v]);
  for(const auto f : faces(mesh))
    names.insert(name[f]);
  CHECK(numbers.size() == 60);
  CHECK(names.size() == mesh.number_of_faces());
  mesh.collect_garbage();
  std::set<int> numbers_after;
  std::set<std::string> names_after;
  const std::vector<std::size_t> map = policies.vertex_map();
  std::size_t row = 0;
  for(const auto v : vertices(mesh)) {
    numbers_after.insert(number[v]);
    CHECK(map[std::size_t(number[v])] == row++); // a vertex that was kept goes to itself
  }
  for(const auto f : faces(mesh))
    names_after.insert(name[f]);
  CHECK(numbers_after == numbers);
  CHECK(names_after == names);
}

} // namespace test_invariance
