// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// What is found in meshes that are broken in one way each.

#include <CGAL/Spectral_toolbox/mesh_diagnosis.h>

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include "catch.h"
#include "shapes.h"

namespace test_mesh_diagnosis {

namespace {

struct Soup
{
  Eigen::MatrixXd V;
  std::vector<std::vector<std::size_t>> polygons;

  SG::Mesh_diagnosis diagnosis() const { return SG::diagnose_polygon_soup(V, polygons); }
};

Soup soup_of(const shapes::Matrices& mesh)
{
  Soup soup{mesh.V, {}};
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f)
    soup.polygons.push_back(
        {std::size_t(mesh.T(f, 0)), std::size_t(mesh.T(f, 1)), std::size_t(mesh.T(f, 2))});
  return soup;
}

void append(Soup& soup, const double x, const double y, const double z)
{
  soup.V.conservativeResize(soup.V.rows() + 1, 3);
  soup.V.bottomRows(1) << x, y, z;
}

bool is(const SG::Mesh_finding& finding, const std::size_t count, const std::size_t first,
        const std::size_t second = 0)
{
  return finding.count == count && finding.first == first && finding.second == second;
}

// Vertices 0..8, three in a row; faces 2 k and 2 k + 1 share a cell.
Soup grid()
{
  return soup_of(shapes::grid_matrices(2, 2));
}

// The only obstacle's clause.
std::string obstacle(const Soup& soup)
{
  const std::vector<std::string> all = soup.diagnosis().obstacles();
  REQUIRE(all.size() == 1);
  CHECK_FALSE(soup.diagnosis().usable());
  return all[0];
}

} // namespace

TEST_CASE("Nothing is found in sound meshes but their components")
{
  for(const shapes::Matrices& mesh :
      {shapes::tetrahedron_matrices(), shapes::bumpy_icosphere_matrices(2),
       shapes::torus_matrices(8, 6), shapes::grid_matrices(5, 4)}) {
    const SG::Mesh_diagnosis d = soup_of(mesh).diagnosis();
    CHECK(d.usable());
    CHECK(d.obstacles().empty());
    CHECK(d.remarks().empty());
    REQUIRE(d.components.size() == 1);
    CHECK(d.components[0].vertices == std::size_t(mesh.V.rows()));
    CHECK(d.components[0].faces == std::size_t(mesh.T.rows()));
  }
  CHECK_FALSE(Soup{Eigen::MatrixXd(0, 3), {}}.diagnosis().usable());
}

TEST_CASE("Each obstacle is counted, and the first offender named")
{
  Soup soup = grid();
  SECTION("coordinates")
  {
    soup.V(3, 1) = std::numeric_limits<double>::quiet_NaN();
    soup.V(7, 2) = std::numeric_limits<double>::infinity();
    CHECK(is(soup.diagnosis().non_finite_vertices, 2, 3));
    CHECK_THAT(obstacle(soup),
               ContainsSubstring("2 of 9 vertices") && ContainsSubstring("vertex 3 "));
  }
  SECTION("indices")
  {
    soup.polygons.push_back({0, 1, 9});
    CHECK(is(soup.diagnosis().foreign_indices, 1, 8));
    CHECK_THAT(obstacle(soup),
               ContainsSubstring("face 8 (counted from 0) uses a vertex that does not exist"));
  }
  SECTION("a vertex twice, and an edge for a face")
  {
    soup.polygons.push_back({0, 1, 0});
    soup.polygons.push_back({0, 1});
    CHECK(is(soup.diagnosis().repeated_vertices, 2, 8));
    CHECK_THAT(obstacle(soup), ContainsSubstring("2 of 10 faces"));
  }
  SECTION("polygons")
  {
    soup.polygons.erase(soup.polygons.begin() + 7);
    soup.polygons[6] = {4, 5, 8, 7};
    CHECK(is(soup.diagnosis().polygons, 1, 6, 4));
    CHECK_THAT(obstacle(soup),
               ContainsSubstring("face 6 (counted from 0) has 4 vertices: triangulate"));
  }
  SECTION("isolated vertices")
  {
    append(soup, 5, 5, 5);
    append(soup, 6, 5, 5);
    CHECK(is(soup.diagnosis().isolated_vertices, 2, 9));
    CHECK(soup.diagnosis().components.size() == 1);
    CHECK_THAT(obstacle(soup), ContainsSubstring("2 of 11 vertices are isolated"));
  }
  SECTION("a vertex between two fans")
  {
    append(soup, 2, 0, 0);
    append(soup, 2, 1, 1);
    soup.polygons.push_back({2, 9, 10});
    CHECK(is(soup.diagnosis().non_manifold_vertices, 1, 2, 2));
    CHECK(soup.diagnosis().components.size() == 1);
    CHECK_THAT(obstacle(soup), ContainsSubstring("vertex 2 (counted from 0) is where parts"));
  }
  SECTION("an edge of three faces")
  {
    append(soup, 0.5, 0.2, 1);
    soup.polygons.push_back({1, 4, 9});
    CHECK(is(soup.diagnosis().non_manifold_edges, 1, 1, 4));
    CHECK_THAT(obstacle(soup), ContainsSubstring("the edge from vertex 1 to vertex 4"));
  }
  SECTION("a face that is turned round")
  {
    std::swap(soup.polygons[7][0], soup.polygons[7][1]);
    CHECK(is(soup.diagnosis().misoriented_edges, 2, 4, 7));
    CHECK_THAT(obstacle(soup),
               ContainsSubstring("faces 4 and 7 (counted from 0)") && ContainsSubstring("2 edges"));
  }
  SECTION("faces without area")
  {
    // 0, 1, 2 and 3 on a line; 1 and 2 have a face with area, too.
    soup.V.resize(5, 3);
    soup.V << 0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 1, 1, 0;
    soup.polygons = {{0, 2, 1}, {1, 2, 4}, {3, 2, 0}};
    const SG::Mesh_diagnosis d = soup.diagnosis();
    CHECK(is(d.zero_area_faces, 2, 0));
    CHECK(is(d.massless_vertices, 2, 0));
    CHECK_THAT(d.obstacles().back(), ContainsSubstring("2 of 5 vertices have no mass"));
  }
  SECTION("a needle")
  {
    soup.V.row(4) = soup.V.row(1) + 1e-14 * (soup.V.row(4) - soup.V.row(1));
    CHECK(soup.diagnosis().overflowing_faces.count >= 1);
    CHECK_THAT(obstacle(soup), ContainsSubstring("needle") && ContainsSubstring("collapse"));
  }
  SECTION("an area beyond all numbers")
  {
    soup.V *= 1e160;
    CHECK(is(soup.diagnosis().overflowing_faces, 8, 0));
    REQUIRE(soup.diagnosis().obstacles().size() == 2);
    CHECK(soup.diagnosis().out_of_scale());
    CHECK_THAT(soup.diagnosis().obstacles()[0],
               ContainsSubstring("above 1e50") &&
                   ContainsSubstring("scale the mesh to another unit"));
    CHECK_THAT(soup.diagnosis().obstacles()[1],
               ContainsSubstring("8 of 8 faces") && ContainsSubstring("rescale"));
  }
}

TEST_CASE("Copies of a face are found in whatever order they list its vertices")
{
  Soup soup = grid();
  soup.polygons.push_back({5, 1, 4});
  soup.polygons.push_back(soup.polygons[0]);
  soup.polygons.push_back({soup.polygons[0][1], soup.polygons[0][0], soup.polygons[0][2]});
  const SG::Mesh_diagnosis d = soup.diagnosis();
  CHECK(d.duplicate_faces.count == 3);
  CHECK(d.duplicate_faces.first == 8);
  CHECK(d.duplicate_faces.second == 3);
  CHECK_THAT(d.obstacles().front(), ContainsSubstring("copies"));
}

TEST_CASE("Faces with the least vertex and the sum of another are no copies of it")
{
  Soup soup = grid();
  soup.polygons = {{0, 1, 8}, {0, 2, 7}, {0, 3, 6}, {0, 4, 5}, {0, 1, 2, 6}, {6, 3, 0}};
  const SG::Mesh_diagnosis d = soup.diagnosis();
  CHECK(d.duplicate_faces.count == 1);
  CHECK(d.duplicate_faces.first == 5);
  CHECK(d.duplicate_faces.second == 2);
}

TEST_CASE("What is handled is remarked upon, not refused")
{
  Soup soup = grid();
  SECTION("an edge without length")
  {
    soup.V.row(4) = soup.V.row(1);
    const SG::Mesh_diagnosis d = soup.diagnosis();
    CHECK(is(d.zero_length_edges, 1, 1, 4));
    CHECK(d.zero_area_faces.count >= 2);
    CHECK(d.coincident_vertices.count == 0);
    CHECK(d.usable());
    CHECK(d.remarks().size() == 2);
  }
  // The right half gets a middle column of its own, that far away.
  const auto cut = [](Soup soup, const double distance) {
    for(const Eigen::Index r : {1, 4, 7})
      append(soup, soup.V(r, 0) + distance, soup.V(r, 1), soup.V(r, 2));
    for(std::vector<std::size_t>& p : soup.polygons) {
      bool right = false;
      for(const std::size_t v : p)
        right = right || v == 2 || v == 5 || v == 8;
      for(std::size_t& v : p)
        v = right && (v == 1 || v == 4 || v == 7) ? 9 + v / 3 : v;
    }
    return soup.diagnosis();
  };
  const std::vector<std::pair<std::size_t, std::size_t>> cracks = {{9, 1}, {10, 4}, {11, 7}};
  SECTION("a seam")
  {
    const SG::Mesh_diagnosis d = cut(soup, 0);
    CHECK(d.usable());
    CHECK(is(d.coincident_vertices, 3, 9, 1));
    CHECK(d.cracks == cracks);
    CHECK(d.components.size() == 2);
    REQUIRE(d.remarks().size() == 2);
    CHECK_THAT(d.remarks()[0], ContainsSubstring("stitched"));
    CHECK_THAT(d.remarks()[1],
               ContainsSubstring("2 components, the smallest of 6 vertices around vertex 0"));
    REQUIRE(d.warnings(3).size() == 1);
    CHECK_THAT(d.warnings(3)[0],
               ContainsSubstring("3 border vertices that lie on another, the first is vertex 9 "
                                 "(counted from 0) on vertex 1"));
  }
  SECTION("a crack")
  {
    const double size = (soup.V.row(8) - soup.V.row(0)).norm(); // of the box
    for(const double distance : {0.9e-5, -0.9e-5}) {
      CHECK(cut(soup, distance * size).cracks == cracks);
      CHECK(cut(soup, distance * size).coincident_vertices.count == 0);
    }
    CHECK(cut(soup, 1.1e-5 * size).cracks.empty());
    CHECK(soup.diagnosis().cracks.empty());
    // Not wider than half of the edges there.
    soup.V.row(1) = soup.V.row(0) + 1e-5 * size * Eigen::RowVector3d::UnitX();
    CHECK(cut(soup, 0.6e-5 * size).cracks.size() == 2);
    CHECK(cut(soup, 0.4e-5 * size).cracks == cracks);
    // No vertex goes further by way of another: tips of loose triangles.
    Soup loose;
    for(const double x : {0., 0.9e-5, 1.8e-5, 2.7e-5}) {
      const std::size_t n = std::size_t(loose.V.rows());
      append(loose, x, 0, 0);
      append(loose, x, 0.6, 0.3);
      append(loose, 1 - x, 0.6, 0.6 + 1000 * x);
      loose.polygons.push_back({n, n + 1, n + 2});
    }
    CHECK(loose.diagnosis().cracks ==
          std::vector<std::pair<std::size_t, std::size_t>>{{3, 0}, {4, 1}, {9, 6}, {10, 7}});
  }
}

TEST_CASE("K is judged by the components")
{
  const SG::Mesh_diagnosis d =
      soup_of(shapes::components_matrices(shapes::bumpy_icosphere_matrices(1), 3)).diagnosis();
  REQUIRE(d.components.size() == 3);
  CHECK(d.components[1].first == 42);
  CHECK(d.components[2].vertices == 42);
  CHECK(d.warnings(20).empty());
  REQUIRE(d.warnings(3).size() == 1);
  CHECK_THAT(d.warnings(3)[0], ContainsSubstring("With 3 eigenvectors only") &&
                                   ContainsSubstring("constant on each of the 3 components"));
  CHECK_THAT(d.warnings(1)[0], ContainsSubstring("With 1 eigenvector only"));
  REQUIRE(d.warnings(42).size() == 1);
  CHECK_THAT(d.warnings(42)[0], ContainsSubstring("has 42 vertices"));
  CHECK(soup_of(shapes::bumpy_icosphere_matrices(1)).diagnosis().warnings(1).empty());
}

TEST_CASE("A mesh is examined in the order of its vertices and faces, through its point map")
{
  using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;
  Mesh mesh;
  shapes::make_mesh(mesh, shapes::grid_matrices(3, 2));
  CGAL::Euler::remove_face(mesh.halfedge(*faces(mesh).begin()), mesh);
  mesh.add_vertex({9, 9, 9});
  const std::size_t n = std::size_t(std::distance(vertices(mesh).begin(), vertices(mesh).end()));
  const SG::Mesh_diagnosis d = SG::diagnose_mesh(mesh);
  CHECK(is(d.isolated_vertices, 1, n - 1));
  CHECK(d.number_of_faces == 11);
  CHECK(d.number_of_vertices == n);
  auto flat =
      mesh.add_property_map<Mesh::Vertex_index, CGAL::Simple_cartesian<double>::Point_3>("v:flat")
          .first;
  CHECK(SG::diagnose_mesh(mesh, CGAL::parameters::vertex_point_map(flat)).zero_area_faces.count ==
        11);
}

} // namespace test_mesh_diagnosis
