// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// One metric on every mesh type, kernel and point map.

#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Polyhedron_items_with_id_3.h>

#include <boost/property_map/property_map.hpp>

#include "catch.h"
#include "collapse_helpers.h"

namespace test_types {

using namespace spectral_test;
using SMS::Spectral_edge_collapse_options;

namespace {

// For each vertex of the input the first one that was merged into the same vertex: a partition,
// whatever the order of the coarse vertices.
std::vector<std::size_t> partition(const std::vector<std::size_t>& map)
{
  std::vector<std::size_t> first(map.size(), map.size()), result;
  for(std::size_t i = 0; i < map.size(); ++i) {
    first[map[i]] = (std::min)(first[map[i]], i);
    result.push_back(first[map[i]]);
  }
  return result;
}

// A run on another mesh type ends as that on Surface_mesh does, up to the order and rounding of the
// vertices.
template <class Mesh_type, class Traits>
void check_against_surface_mesh(const shapes::Matrices& input,
                                const Spectral_edge_collapse_options& options, const std::size_t N)
{
  Mesh expected = make_mesh(input);
  const SMS::Spectral_policies reference(expected, options);
  collapse(expected, reference, N);
  const std::vector<std::size_t> expected_partition = partition(reference.vertex_map());

  Mesh_type mesh;
  shapes::make_mesh(mesh, input);
  const SMS::Spectral_policies<Mesh_type, Traits> policies(mesh, options);
  collapse(mesh, policies, N);
  CHECK(count_vertices(mesh) == N);
  CHECK(policies.state().number_of_vertices() == N);
  const Input fine = eigen_input(input, options.mass, *policies.eigenpairs());
  CHECK(fault_of_run(mesh, policies, fine, Check{options.binary, true, 1e-8}) == "");
  CHECK(partition(policies.vertex_map()) == expected_partition);
  CHECK(relative_difference(policies.error(), reference.error()) < 1e-6);

  const Eigen::MatrixXd V = positions(mesh), W = positions(expected);
  const std::vector<std::size_t> to = policies.vertex_map(), from = reference.vertex_map();
  double worst = 0;
  for(std::size_t i = 0; i < to.size(); ++i)
    worst = (std::max)(worst, (V.row(Eigen::Index(to[i])) - W.row(Eigen::Index(from[i]))).norm());
  CHECK(worst < 1e-6);
}

} // namespace

TEST_CASE("Surface_mesh and Polyhedron_3 give the same mesh")
{
  const bool bordered = GENERATE(false, true);
  const bool zero_length = GENERATE(false, true);
  shapes::Matrices input =
      bordered ? wavy_grid_matrices(22, 20) : shapes::bumpy_icosphere_matrices(3);
  if(zero_length)
    for(const int f : {20, 200, 410, 700})
      input.V.row(input.T(f, 0)) = input.V.row(input.T(f, 1));
  CAPTURE(bordered, zero_length);
  Spectral_edge_collapse_options options = options_with(15);
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  check_against_surface_mesh<CGAL::Polyhedron_3<Kernel>, Kernel>(input, options, 120);
}

TEST_CASE("Polyhedron_3 with ids works, and its rows follow vertices(mesh)")
{
  check_against_surface_mesh<CGAL::Polyhedron_3<Kernel, CGAL::Polyhedron_items_with_id_3>, Kernel>(
      shapes::bumpy_icosphere_matrices(3), options_with(10), 120);
}

TEST_CASE("The kernel with exact predicates gives the same mesh")
{
  using Exact_predicates = CGAL::Exact_predicates_inexact_constructions_kernel;
  Spectral_edge_collapse_options options = options_with(12);
  options.binary = GENERATE(false, true);
  check_against_surface_mesh<CGAL::Surface_mesh<Exact_predicates::Point_3>, Exact_predicates>(
      wavy_grid_matrices(22, 20), options, 100);
}

TEST_CASE("The kernel with exact constructions gives the same mesh")
{
  using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
  check_against_surface_mesh<CGAL::Surface_mesh<Exact::Point_3>, Exact>(
      shapes::bumpy_icosphere_matrices(2), options_with(10), 60);
}

TEST_CASE(
    "With points in single precision E is that of the rounded mesh, P gives its points to rounding")
{
  using Single = CGAL::Simple_cartesian<float>;
  using Single_mesh = CGAL::Surface_mesh<Single::Point_3>;
  Spectral_edge_collapse_options options = options_with(12);
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const bool bordered = GENERATE(false, true);
  Single_mesh mesh;
  shapes::make_mesh(mesh,
                    bordered ? wavy_grid_matrices(22, 20) : shapes::bumpy_icosphere_matrices(3));
  const shapes::Matrices input = SG::mesh_matrices(mesh); // in doubles, rounded
  const SMS::Spectral_policies policies(mesh, options);
  CHECK(collapse(mesh, policies, 100) > 0);
  CHECK(count_vertices(mesh) == 100);
  const Input fine = eigen_input(input, options.mass, *policies.eigenpairs());
  CHECK(fault_of_run(mesh, policies, fine, Check{false, false, 1e-8}) == "");
  CHECK(position_error(policies.restriction(), input.V, positions(mesh)) < 3e-6);
}

TEST_CASE("A mesh with garbage is as good as one without")
{
  const shapes::Matrices input = shapes::irregular_grid_matrices(22, 20);
  // Every third row of triangles is taken away, and with the first of them a corner.
  Mesh mesh = make_mesh(input);
  std::vector<Mesh::Face_index> gone;
  for(const auto f : faces(mesh)) {
    const auto center = mesh.point(mesh.target(mesh.halfedge(f)));
    if(center.x() < 0.3 && center.y() < 0.3)
      gone.push_back(f);
  }
  for(const auto f : gone)
    CGAL::Euler::remove_face(mesh.halfedge(f), mesh);
  REQUIRE(mesh.has_garbage());
  REQUIRE(count_vertices(mesh) < mesh.num_vertices());
  const shapes::Matrices left = SG::mesh_matrices(mesh);
  Mesh clean = make_mesh(left);

  const SMS::Spectral_policies policies(mesh, options_with(10)), reference(clean, options_with(10));
  collapse(mesh, policies, 100);
  collapse(clean, reference, 100);
  CHECK(fault_of_run(mesh, policies, eigen_input(left, SG::Mass::lumped, *policies.eigenpairs())) ==
        "");
  // The halfedges are numbered otherwise and sums are rounded otherwise, after which a greedy order
  // may part.
  CHECK(relative_difference(policies.error(), reference.error()) < 0.2);
}

TEST_CASE("A point map of the user's is read and written, the mesh's own points are not")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Mesh mesh = make_mesh(input), expected = mesh;
  // Points kept outside of the mesh.
  std::vector<Kernel::Point_3> points;
  for(const auto v : vertices(mesh)) {
    points.push_back(mesh.point(v));
    mesh.point(v) = Kernel::Point_3(0, 0, 0);
  }
  const auto map =
      boost::make_iterator_property_map(points.begin(), get(boost::vertex_index, mesh));
  const auto np = CGAL::parameters::vertex_point_map(map).geom_traits(Kernel());
  const SMS::Spectral_policies policies(mesh, options_with(10), np);
  collapse(mesh, policies, 100);
  CHECK(fault_of_run(mesh, policies,
                     eigen_input(input, SG::Mass::lumped, *policies.eigenpairs())) == "");
  for(const auto v : vertices(mesh))
    CHECK(mesh.point(v) == CGAL::ORIGIN);
  SMS::spectral_edge_collapse(expected, 100, options_with(10));
  CHECK(SG::mesh_matrices(mesh, np).V == positions(expected));
  CHECK(policies.prolongation().rows() == 642);
  CHECK(policies.prolongation().cols() == 100);
}

} // namespace test_types
