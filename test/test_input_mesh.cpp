// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// What the programs change in a mesh before they use it, and how its vertices are numbered then.

#include "../examples/programs/io/input_mesh.h"

#include "catch.h"

#include <unistd.h>

#include <filesystem>

namespace test_input_mesh {

using Indices = std::vector<std::size_t>;

namespace {

const std::string path = (std::filesystem::temp_directory_path() /
                          ("spectral_input_" + std::to_string(getpid()) + ".obj"))
                             .string();

Input_mesh read(const std::string& text, const Mending mending)
{
  std::ofstream(path) << text;
  struct Removal
  {
    ~Removal() { std::filesystem::remove(path); }
  } removal;
  return read_input_mesh(path, mending);
}

// For each vertex of the file that of the mesh.
Indices mesh_vertices(const Vertex_numbering& numbering)
{
  Indices result;
  for(std::size_t v = 0; v < numbering.number_of_file_vertices(); ++v)
    result.push_back(numbering.mesh_vertex(v));
  return result;
}

void check_positions(const std::string& text, const Input_mesh& input)
{
  std::ofstream(path) << text;
  const Polygon_soup soup = read_polygon_soup(path);
  std::filesystem::remove(path);
  REQUIRE(input.numbering.number_of_file_vertices() == soup.points.size());
  REQUIRE(input.numbering.number_of_mesh_vertices() == input.mesh.number_of_vertices());
  for(const auto v : input.mesh.vertices())
    CHECK(input.mesh.point(v) == soup.points[input.numbering.file_vertex(v)]);
  for(std::size_t v = 0; v < soup.points.size(); ++v)
    if(input.numbering.mesh_vertex(v) != no_vertex)
      CHECK(input.mesh.point(Mesh::Vertex_index(unsigned(input.numbering.mesh_vertex(v)))) ==
            soup.points[v]);
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

} // namespace

TEST_CASE("Isolated vertices are left out, and the others keep their numbers")
{
  const std::string text = "v 9 9 9\n" + square + "v 8 8 8\nf 2 3 4\nf 2 4 5\n";
  CHECK_THROWS_WITH(read(text, Mending::none), ContainsSubstring("2 of 6 vertices are isolated"));
  for(const Mending mending : {Mending::plain, Mending::full}) {
    const Input_mesh input = read(text, mending);
    CHECK(mesh_vertices(input.numbering) == Indices({no_vertex, 0, 1, 2, 3, no_vertex}));
    check_positions(text, input);
    REQUIRE(input.changes.size() == 1);
    CHECK(input.changes[0].count == 2);
    REQUIRE(input.diagnosis.components.size() == 1);
    CHECK(input.diagnosis.components[0].first == 1);
    Eigen::SparseMatrix<double> P(1, 4);
    P.insert(0, 0) = 0.25;
    P.insert(0, 3) = 0.75;
    CHECK(Eigen::RowVectorXd(input.numbering.columns_of_file(P).row(0)) ==
          (Eigen::RowVectorXd(6) << 0, 0.25, 0, 0, 0.75, 0).finished());
    CHECK(input.numbering.map_of_file(Indices({7, 5, 7, 7}), no_vertex) ==
          Indices({no_vertex, 7, 5, 7, 7, no_vertex}));
    CHECK(input.numbering.vertices_of_mesh({4, 1, 4}, "keep") == Indices({3, 0}));
    CHECK_THROWS_WITH(input.numbering.vertices_of_mesh({4, 5}, "keep"),
                      ContainsSubstring("'keep' names the vertex 5"));
  }
}

TEST_CASE("Faces that are turned the other way than their neighbours are turned round, where all "
          "can agree")
{
  const std::string text = square + "v 2 0 0\nv 2 1 0\nf 1 2 3\nf 1 4 3\nf 2 5 6\nf 2 6 3\n";
  CHECK_THROWS_WITH(read(text, Mending::none), ContainsSubstring("same direction"));
  const Input_mesh input = read(text, Mending::plain);
  CHECK(input.changes_of("x.obj") == "'x.obj': 1 face turned round.");
  CHECK(mesh_vertices(input.numbering) == Indices({0, 1, 2, 3, 4, 5}));
  // A strip of five triangles that is closed with a twist has one side.
  std::string moebius;
  for(const char* p : {"0 0 0", "1 0 0.3", "0.5 1 0", "2 0.5 1", "0.2 0.7 2"})
    moebius += std::string("v ") + p + "\n";
  for(int i = 0; i < 5; ++i)
    moebius += "f " + std::to_string(i + 1) + " " + std::to_string((i + 1) % 5 + 1) + " " +
               std::to_string((i + 2) % 5 + 1) + "\n";
  CHECK_THROWS_WITH(read(moebius, Mending::plain), ContainsSubstring("same direction"));
}

TEST_CASE("Degenerate faces that CGAL cannot remove stay, and are named")
{
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 6.995005352750662e+22 1.8943159647675943e+23 1.9429936213942168e-19\n"
      "v 4.7544791794160686e+30 4.5445114319081253e+30 7.760067092203218e+26\nf 1 3 2\nf 1 2 4\nf "
      "2 3 4\n";
  CHECK_THROWS_WITH(read(text, Mending::full), ContainsSubstring("--repair could not do"));
}

TEST_CASE("The full repair takes away faces without area that hang on an edge or stand alone")
{
  // One hangs on the square, one on that, one stands alone, and so does a tetrahedron.
  const std::string text = square +
                           "v 2 0 0\nv 3 0 0\nv 9 9 9\nv 10 9 9\nv 11 9 9\nv 5 5 5\nv 6 5 5\n"
                           "v 7 5 5\nv 8 5 5\nf 1 2 3\nf 1 3 4\nf 2 1 5\nf 5 1 6\nf 7 8 9\n"
                           "f 10 11 12\nf 10 13 11\nf 11 13 12\nf 12 13 10\n";
  CHECK_THROWS_WITH(read(text, Mending::plain), ContainsSubstring("no mass"));
  const Input_mesh input = read(text, Mending::full);
  CHECK(input.mesh.number_of_faces() == 2);
  Indices left = {0, 1, 2, 3};
  left.resize(13, no_vertex);
  CHECK(mesh_vertices(input.numbering) == left);
  CHECK_THAT(input.changes_of("x.obj"), ContainsSubstring("7 degenerate faces removed"));
  CHECK_THAT(input.changes_of("x.obj"), !ContainsSubstring("separated that"));
}

TEST_CASE("The full repair says where only faces without area had joined two parts")
{
  const std::string text = square +
                           "v 3 0 0\nv 4 0 0\nv 4 1 0\nv 3 1 0\nv 2 0 0\nf 1 2 3\nf 1 3 4\n"
                           "f 5 6 7\nf 5 7 8\nf 2 1 9\nf 2 9 5\nf 5 9 6\n";
  const Input_mesh input = read(text, Mending::full);
  CHECK(input.diagnosis.components.size() == 2);
  CHECK_THAT(input.changes_of("x.obj"),
             ContainsSubstring("1 part separated that only faces without area had joined"));
}

TEST_CASE("A file of which the repair leaves nothing is refused with what was removed")
{
  CHECK_THROWS_WITH(read("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", Mending::full),
                    ContainsSubstring("has no faces left: 1 degenerate face removed"));
}

TEST_CASE("What the full repair leaves is named by its number in the file")
{
  // The last face is too large; isolated vertices and a copy stand before.
  CHECK_THROWS_WITH(
      read("v 5 5 5\n" + square + "v 1e40 0 0\nv 0 1e-40 1\nf 2 3 4\nf 2 4 5\nf 2 3 4\nf 2 6 7\n",
           Mending::full),
      ContainsSubstring("face 3 (counted from 0)"));
  // Its edge has three faces, so that both of its ends are doubled.
  CHECK_THROWS_WITH(read("v 0 0 0\nv 0 1 0\nv 1 0 0\nv -1 0 0\nv 0 0.5 1e40\nv 1e40 0 2e40\n"
                         "v 0 1e40 2e40\nf 5 6 7\nf 1 2 3\nf 2 1 4\nf 1 2 5\n",
                         Mending::full),
                    ContainsSubstring("face 3 (counted from 0)"));
}

TEST_CASE("Copies of faces go")
{
  const std::string text = square + "f 1 2 3\nf 3 2 1\nf 1 3 4\nf 2 3 1\n";
  CHECK_THROWS_WITH(read(text, Mending::none), ContainsSubstring("vertices of an earlier one"));
  const Input_mesh input = read(text, Mending::plain);
  CHECK(input.changes_of("x.obj") == "'x.obj': 2 copies of faces removed.");
  CHECK(input.mesh.number_of_faces() == 2);
}

TEST_CASE("The full repair takes away fins, whose faces lie on each other, and keeps one side of "
          "larger sheets")
{
  const std::string octahedron = "v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n";
  const std::string closed =
      "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 2 1 6\nf 3 2 6\nf 4 3 6\nf 1 4 6\n";
  // A fin of two triangles on each other, and a second pair that hangs on it; as triangles, and as
  // a quadrangle folded onto two.
  const std::string small = octahedron + "v 0.5 0.01 0.51\nv 0.49 0.02 0.52\n" + closed;
  const std::string fins[] = {"f 1 5 7\nf 5 1 7\nf 5 8 7\nf 7 8 5\n", "f 1 5 8 7\nf 7 8 5 1\n"};
  for(const std::string& fin : fins) {
    const Input_mesh input = read(small + fin, Mending::full);
    CHECK(input.mesh.number_of_vertices() == 6);
    CHECK(input.mesh.number_of_faces() == 8);
    CHECK(input.numbering.mesh_vertex(6) == no_vertex);
    CHECK(input.numbering.mesh_vertex(7) == no_vertex);
    CHECK_THAT(input.changes_of("x.obj"),
               ContainsSubstring("faces removed that were folded onto each other"));
  }
  // A sheet of some size on a body, and a surface that is there twice: one side stays.
  const Input_mesh sheet =
      read(octahedron + "v 1 1 1\n" + closed + "f 1 5 7\nf 5 1 7\n", Mending::full);
  CHECK(sheet.mesh.number_of_faces() == 9);
  const Input_mesh twice = read(square + "f 1 2 3\nf 1 3 4\nf 3 2 1\nf 4 3 1\n", Mending::full);
  CHECK(twice.mesh.number_of_faces() == 2);
  CHECK_THAT(twice.changes_of("x.obj"), ContainsSubstring("2 copies of faces removed"));
}

TEST_CASE("Edges without length are closed, and their ends share")
{
  // Vertex 5 lies on vertex 3 and has faces without area alone.
  const std::string text = square + "v 1 1 0\nf 1 2 3\nf 1 3 4\nf 3 5 4\n";
  const Input_mesh input = read(text, Mending::plain);
  CHECK(mesh_vertices(input.numbering) == Indices({0, 1, 2, 3, 2}));
  CHECK(input.mesh.number_of_faces() == 2);
  check_positions(text, input);
  CHECK(input.changes_of("x.obj") == "'x.obj': 1 edge without length closed.");
  Eigen::SparseMatrix<double> P(1, 4);
  P.insert(0, 2) = 1;
  CHECK(Eigen::RowVectorXd(input.numbering.columns_of_file(P).row(0)) ==
        (Eigen::RowVectorXd(5) << 0, 0, 0.5, 0, 0.5).finished());
  CHECK(Eigen::RowVectorXd(input.numbering.columns_of_file(P, true).row(0)) ==
        (Eigen::RowVectorXd(5) << 0, 0, 1, 0, 0).finished());
  CHECK(input.numbering.rows_of_file(
            Eigen::VectorXd((Eigen::VectorXd(4) << 1, 2, 3, 4).finished())) ==
        (Eigen::VectorXd(5) << 1, 2, 3, 4, 3).finished());
  CHECK(input.numbering.rows_of_mesh(
            Eigen::VectorXd((Eigen::VectorXd(5) << 1, 2, 3, 4, 5).finished())) ==
        (Eigen::VectorXd(4) << 1, 2, 4, 4).finished());
}

TEST_CASE("The full repair numbers the vertices of the file")
{
  // Two sheets that share a vertex, with a copy of it and one that nothing uses.
  const std::string text =
      "v 7 7 7\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 1 0 0\nv 1 1 0\n"
      "f 2 3 4\nf 2 5 6\nf 4 7 8\n";
  const Input_mesh input = read(text, Mending::full);
  check_positions(text, input);
  CHECK(input.mesh.number_of_vertices() == 7);
  CHECK(input.numbering.mesh_vertex(0) == no_vertex);
  CHECK(input.numbering.mesh_vertex(2) == input.numbering.mesh_vertex(6));
  Eigen::SparseMatrix<double> identity(7, 7);
  identity.setIdentity();
  const Eigen::SparseMatrix<double> P = input.numbering.columns_of_file(identity);
  CHECK((P * Eigen::VectorXd::Ones(8) - Eigen::VectorXd::Ones(7)).norm() < 1e-15);
  CHECK(P.col(2).sum() == 0.5);
  CHECK(P.col(1).sum() == 2); // both sheets have its value
}

TEST_CASE("The full repair closes cracks")
{
  // A square whose halves were written with coordinates of six digits.
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1.00001 0 0\nv 0 1 -0.00001\nv 1 1 0\nf 1 2 3\nf 4 6 5\n";
  const Input_mesh as_it_is = read(text, Mending::plain);
  CHECK(as_it_is.mesh.number_of_vertices() == 6);
  CHECK(as_it_is.diagnosis.cracks.size() == 2);
  const Input_mesh input = read(text, Mending::full);
  CHECK(input.mesh.number_of_vertices() == 4);
  CHECK(input.diagnosis.components.size() == 1);
  CHECK(input.diagnosis.cracks.empty());
  CHECK(mesh_vertices(input.numbering) == Indices{0, 1, 2, 1, 2, 3});
  CHECK(input.mesh.point(Mesh::Vertex_index(1)) == Kernel::Point_3(1, 0, 0));
  CHECK_THAT(input.changes_of("square"),
             ContainsSubstring("2 vertices of cracks moved onto others"));
}

TEST_CASE("The full repair finds no cracks in a thin tube whose faces have vertices of their own")
{
  const int n = 12, rings = 4;
  std::string text;
  for(int r = 0; r + 1 < rings; ++r)
    for(int k = 0; k < n; ++k)
      for(const auto& [dr, dk] : {std::pair{0, 0}, {0, 1}, {1, 1}, {0, 0}, {1, 1}, {1, 0}}) {
        const double angle = 2 * CGAL_PI * ((k + dk) % n) / n;
        std::ostringstream line;
        line.precision(17);
        line << "v " << 1.5e-5 * std::cos(angle) << ' ' << 1.5e-5 * std::sin(angle) << ' '
             << (r + dr) / 3. << "\n";
        text += line.str();
      }
  for(int v = 1; v < 6 * n * (rings - 1); v += 3)
    text +=
        "f " + std::to_string(v) + ' ' + std::to_string(v + 1) + ' ' + std::to_string(v + 2) + '\n';
  const Input_mesh input = read(text, Mending::full);
  CHECK(input.mesh.number_of_vertices() == n * rings);
  CHECK(input.mesh.number_of_faces() == 2 * n * (rings - 1));
}

TEST_CASE("Polygons that are neither plane nor convex are triangulated, and copies that arise are "
          "removed")
{
  // Two quadrangles with the same diagonal to each side of it, one of them with the triangle of the
  // other.
  const std::string diagonal = square + "v 1 0 1\nf 1 2 3 4\nf 1 2 3\nf 1 3 5\n";
  CHECK(read(diagonal, Mending::full).diagnosis.obstacles().empty());
  // A pentagon that turns back on itself, far from any plane.
  const std::string bent = "v 0 0 0\nv 2 0 1\nv 2 2 -1\nv 1 0.5 3\nv 0 2 0\nf 1 2 3 4 5\n";
  const Input_mesh pentagon = read(bent, Mending::full);
  CHECK(pentagon.mesh.number_of_faces() == 3);
  // Its corners on a line, but for one.
  const Input_mesh flat =
      read("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 1 1 0\nf 1 2 3 4 5\n", Mending::full);
  CHECK(flat.mesh.number_of_faces() == 3);
  // A corner on the edge of two others.
  const Input_mesh touching =
      read("v 0 0 0\nv 0 0 5\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3 4 5\n", Mending::full);
  CHECK(touching.mesh.number_of_faces() >= 2);
}

} // namespace test_input_mesh
