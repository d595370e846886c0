// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// OpenMesh as a mesh type. Built where OpenMesh is found.

#include "catch.h"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized" // OpenMesh's points are not, by default
#endif

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <CGAL/boost/graph/graph_traits_TriMesh_ArrayKernelT.h>

#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Surface_mesh_simplification/quadric_edge_collapse.h>

#include "collapse_helpers.h"

using namespace spectral_test;

TEST_CASE("OpenMesh is simplified as other meshes are, with points in single precision")
{
  using Open_mesh = OpenMesh::TriMesh_ArrayKernelT<>;
  const bool bordered = GENERATE(false, true);
  Open_mesh mesh;
  shapes::make_mesh(mesh,
                    bordered ? wavy_grid_matrices(14, 13) : shapes::bumpy_icosphere_matrices(3));
  const shapes::Matrices input = SG::mesh_matrices(mesh); // its points are floats
  const SMS::Spectral_policies policies(mesh, options_with(10));
  collapse(mesh, policies, 80);
  CHECK(count_vertices(mesh) == 80);
  CHECK(policies.state().number_of_vertices() == 80);
  const Input fine = eigen_input(input, SG::Mass::lumped, *policies.eigenpairs());
  CHECK(fault_of_run(mesh, policies, fine, Check{false, false, 1e-8}) == "");
  CHECK(position_error(policies.restriction(), input.V, positions(mesh)) < 3e-6);
}

TEST_CASE("OpenMesh after quadrics is what a replay of their log leaves")
{
  using Open_mesh = OpenMesh::TriMesh_ArrayKernelT<>;
  Open_mesh mesh;
  shapes::make_mesh(mesh, GENERATE(false, true) ? wavy_grid_matrices(25, 25)
                                                : shapes::bumpy_icosphere_matrices(3));
  Open_mesh other = mesh;
  const SMS::Quadric_edge_collapse_result result = SMS::quadric_edge_collapse(mesh, 80);
  SMS::Collapse_replay<Open_mesh> replay(other, result.log);
  replay.collapse_to(80);
  CHECK(positions(mesh) == positions(other));
  CHECK((result.restriction - replay.restriction()).norm() == 0);
  CHECK(CGAL::is_valid_polygon_mesh(mesh));
  std::size_t others = 0;
  for(const auto h : halfedges(mesh)) { // an edge has the same halfedges in both
    const auto g = halfedge(source(h, mesh), target(h, mesh), other);
    others += !g.second || g.first != h || next(h, other) != next(h, mesh);
  }
  CHECK(others == 0);
}
