// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// What mesh files have at their vertices beside positions: read, carried to a coarse mesh, and
// written.

#include "../examples/programs/io/input_mesh.h"
#include "../examples/programs/io/text_lines.h"
#include "../examples/programs/io/texture_seams.h"

#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include "catch.h"

#include <unistd.h>

#include <filesystem>

namespace test_vertex_attributes {

using Values = std::vector<double>;
using Kind = Attribute::Kind;

namespace {

// A file that lasts as long as the object.
struct File
{
  explicit File(const std::string& extension, const std::string& bytes = "")
    : path((std::filesystem::temp_directory_path() /
            ("spectral_attributes_" + std::to_string(getpid()) + extension))
               .string())
  {
    std::ofstream(path, std::ios::binary) << bytes;
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { std::filesystem::remove(path); }
  std::string path;
};

Attributes attributes_of(const std::string& extension, const std::string& text)
{
  const File file(extension, text);
  return read_polygon_soup(file.path).attributes;
}

Values values(const Attributes& attributes, const std::string& name)
{
  const Attribute* const found = attributes.find(name);
  return found == nullptr ? Values() : found->values;
}

std::string type(const Attributes& attributes, const std::string& name)
{
  const Attribute* const found = attributes.find(name);
  return found == nullptr ? "none" : found->type;
}

const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "property uint8 red\nproperty uchar green\nproperty uchar blue\nproperty int32 label\n"
    "property double heat\nproperty float nx\nproperty float ny\nproperty float nz\n"
    "property list uchar int friends\nelement face 2\nproperty list uchar int vertex_indices\n"
    "property float quality\nelement edge 1\nproperty int vertex1\nproperty int "
    "vertex2\nend_header\n"
    "0 0 0 10 20 30 7 0.5 0 0 1 1 5\n1 0 0 11 21 31 -2 1.5 0 0 1 0\n1 1 0 12 22 32 7 2.5 1 0 0 0\n"
    "0 1 0 250 0 255 9 3.5 0 1 0 0\n3 0 1 2 0.25\n3 0 2 3 0.5\n0 1\n";

const double pi = std::acos(-1.);

// A torus of n x m vertices whose texture is cut along two circles: at corners, or at copies of
// vertices, where the faces may be quads.
std::string torus(const int n, const int m, const bool copies, const bool quads)
{
  std::ostringstream text;
  text.precision(17);
  const int rows = copies ? n + 1 : n, columns = copies ? m + 1 : m;
  for(int i = 0; i < rows; ++i)
    for(int j = 0; j < columns; ++j) {
      const double u = 2 * pi * (i % n) / n, v = 2 * pi * (j % m) / m, r = 2 + std::cos(v);
      text << "v " << r * std::cos(u) << ' ' << r * std::sin(u) << ' ' << std::sin(v) << '\n';
    }
  for(int i = 0; i <= n; ++i)
    for(int j = 0; j <= m; ++j)
      text << "vt " << double(i) / n << ' ' << double(j) / m << '\n';
  const auto corner = [&](const int i, const int j) {
    return " " + std::to_string((i % rows) * columns + j % columns + 1) + "/" +
           std::to_string(i * (m + 1) + j + 1);
  };
  for(int i = 0; i < n; ++i)
    for(int j = 0; j < m; ++j) {
      const std::string a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1),
                        d = corner(i, j + 1);
      text << (quads ? "f" + a + b + c + d : "f" + a + b + c + "\nf" + a + c + d) << '\n';
    }
  return text.str();
}

// How far the corners are from the angles of their points, counted without a jump from those of the
// middle of the face.
double largest_error(const Mesh& mesh, const Corner_texture& texture)
{
  double largest = 0;
  const auto angles = [](const double x, const double y, const double z) {
    const double u = std::atan2(y, x) / (2 * pi),
                 v = std::atan2(z, std::hypot(x, y) - 2) / (2 * pi);
    return std::array<double, 2>{u - std::floor(u), v - std::floor(v)};
  };
  for(const auto f : mesh.faces()) {
    double x = 0, y = 0, z = 0;
    for(const auto v : mesh.vertices_around_face(mesh.halfedge(f))) {
      x += mesh.point(v).x();
      y += mesh.point(v).y();
      z += mesh.point(v).z();
    }
    const auto middle = angles(x / 3, y / 3, z / 3);
    for(const auto h : mesh.halfedges_around_face(mesh.halfedge(f))) {
      const Kernel::Point_3& p = mesh.point(mesh.target(h));
      const auto here = angles(p.x(), p.y(), p.z());
      for(std::size_t k = 0; k < 2; ++k) {
        const double step = here[k] - middle[k];
        largest =
            (std::max)(largest, std::abs(texture[h][k] - (middle[k] + step - std::round(step))));
      }
    }
  }
  return largest;
}

} // namespace

TEST_CASE("PLY files have any property, and what cannot be carried is named")
{
  const Attributes a = attributes_of(".ply", ply);
  CHECK(joined(a.names()) == "red, green, blue, label, heat, nx, ny, nz");
  CHECK(values(a, "red") == Values{10, 11, 12, 250});
  CHECK(values(a, "label") == Values{7, -2, 7, 9});
  CHECK(values(a, "heat") == Values{0.5, 1.5, 2.5, 3.5});
  CHECK(values(a, "ny") == Values{0, 0, 0, 1});
  CHECK(type(a, "red") == "uchar");
  CHECK(type(a, "label") == "int");
  CHECK(type(a, "heat") == "double");
  CHECK(a.find("red")->kind == Kind::colour);
  CHECK(a.find("label")->kind == Kind::label);
  CHECK(a.find("heat")->kind == Kind::function);
  CHECK(a.find("nz")->kind == Kind::normal);
  CHECK(a.unknown == std::vector<std::string>{"property friends of vertex", "element edge"});
}

TEST_CASE(
    "OBJ files have colours behind the coordinates, and normals and texture coordinates at corners")
{
  const std::string points =
      "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 1 1 0 0 0 1\nv 0 1 0 0 0 0\nv 5 5 5 1 1 1\n";
  const std::string texture = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nvn 0 0 1\n";
  const Attributes a =
      attributes_of(".obj", points + texture + "f 1/1/1 2/2/1 3/3/1\nf 1/1/2 3/3/-1 4/-1/2\n");
  CHECK(values(a, "red") == Values{255, 0, 0, 0, 255});
  CHECK(values(a, "green") == Values{0, 128, 0, 0, 255});
  CHECK(values(a, "s") == Values{0, 1, 1, 0, 0}); // the last is isolated
  CHECK(values(a, "t") == Values{0, 0, 1, 1, 0});
  CHECK(values(a, "nz") == Values{1, 1, 1, 1, 0});
  CHECK(a.unknown.empty());

  const File seam(".obj", points + texture + "usemtl wood\nf 1/1 2/2 3/3\nf 1/4 3/3 4/4\n");
  const Polygon_soup soup = read_polygon_soup(seam.path);
  CHECK(soup.attributes.find("s") == nullptr);
  CHECK(soup.attributes.unknown == std::vector<std::string>{"normals (some corners have none)"});
  CHECK(soup.texture == Corner_texture{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 1}, {0, 1}});
  REQUIRE(soup.face_attributes.known.size() == 1);
  CHECK(soup.face_attributes.known[0].words == std::vector<std::string>{"wood"});
  for(const std::string corner : {"f 1 2/2 3/3\n", "f 1/9 2/2 3/3\n", "f 1/-9 2/2 3/3\n"})
    CHECK(attributes_of(".obj", points + "vt 0 0\nvt 1 0\nvt 1 1\n" + corner).unknown ==
          std::vector<std::string>{"texture coordinates (some corners have none)"});
  // Not at all vertices: not at any.
  CHECK(attributes_of(".obj", "v 0 0 0 1 1 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").known.empty());
}

TEST_CASE("OFF files have what their first word announces")
{
  const std::string end = "3 0 1 2\n";
  const Attributes all = attributes_of(
      ".off", "STCNOFF\n3 1 0\n0 0 0  0 0 1  10 20 30 255  0 0.5\n1 0 0  0 0 1  1 2 3 255  1 0\n"
              "0 1 0  1 0 0  0 0 0 0  0 1\n" +
                  end);
  CHECK(joined(all.names()) == "nx, ny, nz, red, green, blue, alpha, s, t");
  CHECK(values(all, "nx") == Values{0, 0, 1});
  CHECK(values(all, "blue") == Values{30, 3, 0});
  CHECK(values(all, "t") == Values{0.5, 0, 1});
  const Attributes small =
      attributes_of(".off", "COFF\n3 1 0\n0 0 0 1 0 0.5\n1 0 0 0 1 0\n0 1 0 0 0 1\n" + end);
  CHECK(values(small, "red") == Values{255, 0, 0});
  CHECK(values(small, "blue") == Values{128, 0, 255});
  CHECK(attributes_of(".off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n" + end).known.empty());
  const Attributes less =
      attributes_of(".off", "COFF\n3 1 0\n0 0 0 1 0 0\n1 0 0\n0 1 0 0 0 1\n" + end);
  CHECK(less.known.empty());
  CHECK(less.unknown.size() == 1);
}

TEST_CASE(
    "Floating colours from 0 to 1 are colours, others are functions, which OFF and OBJ do not hold")
{
  const auto with = [](const std::string& alpha, const std::string& numbers) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
           "float z\n"
           "property float red\nproperty float green\nproperty double blue\n" +
           alpha +
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0 0.53 0 1 " +
           numbers + "\n1 0 0 1 0.2 0 0\n0 1 0 0 0 0 1\n3 0 1 2\n";
  };
  const File file(".ply", with("property float alpha\n", "0.5"));
  const Input_mesh input = read_input_mesh(file.path, Mending::none, true);
  CHECK(joined(input.attributes.names()) == "red, green, blue, alpha");
  CHECK(values(input.attributes, "red") == Values{135, 255, 0});
  CHECK(values(input.attributes, "alpha") == Values{128, 0, 255});
  CHECK(type(input.attributes, "blue") == "uchar");
  for(const std::string extension : {".ply", ".off", ".obj"}) {
    const File copy(extension);
    write_mesh(copy.path, input.mesh, copy.path, {input.attributes, {}});
    const Attributes again = read_polygon_soup(copy.path).attributes;
    for(const std::string name : {"red", "green", "blue"})
      CHECK(values(again, name) == values(input.attributes, name));
  }

  const Attributes opacity = attributes_of(".ply", with("property float alpha\n", "7"));
  CHECK(opacity.find("red")->kind == Kind::colour);
  CHECK(opacity.find("alpha")->kind == Kind::function);
  for(const std::string number : {"1.5", "-0.1", "nan"}) {
    const Attributes bright = attributes_of(
        ".ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
                "y\nproperty float z\nproperty float red\n"
                "property float green\nproperty float blue\nelement face 1\n"
                "property list uchar int vertex_indices\nend_header\n0 0 0 0 1 " +
                    number + "\n3 0 0 0\n");
    CHECK(bright.find("red")->kind == Kind::function);
    CHECK(values(bright, "green") == Values{1});
    CHECK(writable(bright, "a.ply").known.size() == 3);
    CHECK(writable(bright, "a.off").known.empty());
    CHECK(writable(bright, "a.obj").known.empty());
  }
  const std::string off = "COFF\n3 1 0\n0 0 0 nan 0 0\n1 0 0 300 -5 9\n0 1 0 0 0 0\n3 0 1 2\n";
  CHECK(values(attributes_of(".off", off), "red") == Values{0, 255, 0});
}

TEST_CASE("Numbers that their integer type does not hold are refused")
{
  const auto read = [](const std::string& property_type, const std::string& number) {
    return attributes_of(
        ".ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float "
                "y\nproperty float z\nproperty " +
                    property_type +
                    " part\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                    "0 0 0 1\n0 0 0 " +
                    number + "\n3 0 1 1\n");
  };
  const std::vector<std::array<std::string, 3>> limits = {{"char", "-128", "127"},
                                                          {"uchar", "0", "255"},
                                                          {"short", "-32768", "32767"},
                                                          {"ushort", "0", "65535"},
                                                          {"int", "-2147483648", "2147483647"},
                                                          {"uint", "0", "4294967295"}};
  for(const auto& [name, least, most] : limits) {
    CHECK(values(read(name, least), "part") == Values{1, std::stod(least)});
    CHECK(values(read(name, most), "part") == Values{1, std::stod(most)});
    for(const std::string& number :
        {std::to_string(std::stoll(least) - 1), std::to_string(std::stoll(most) + 1),
         std::string("nan"), std::string("inf"), std::string("5e9"), std::string("0.5")})
      CHECK_THROWS_WITH(
          read(name, number),
          ContainsSubstring(
              "property 'part' has a number that its type does not hold at 'vertex' 1 of 2"));
  }
  CHECK(values(read("float", "5e9"), "part") == Values{1, 5e9});
}

TEST_CASE(
    "Attributes are carried by P: functions, colours, normals of length 1, labels of most weight")
{
  const Attributes fine = attributes_of(".ply", ply);
  Eigen::SparseMatrix<double> P(3, 4);
  P.insert(0, 0) = 0.3;
  P.insert(0, 1) = 0.4;
  P.insert(0, 2) = 0.3;
  P.insert(1, 3) = 1.2; // beyond the colours that it is made of
  P.insert(1, 2) = -0.2;
  P.insert(2, 2) = 0.5;
  P.insert(2, 3) = 0.5;
  const Attributes coarse = restricted(fine, P);
  CHECK(coarse.names() == fine.names());
  CHECK(coarse.unknown == fine.unknown);
  CHECK(values(coarse, "red") == Values{11, 250, 131});
  CHECK(values(coarse, "green") == Values{21, 0, 11});
  CHECK(values(coarse, "label") ==
        Values{7, 9, 7}); // 0.6 of 7 against 0.4; a tie goes to the smaller
  CHECK(std::abs(values(coarse, "heat")[0] - 1.5) < 1e-12);
  CHECK(std::abs(values(coarse, "nx")[2] - std::sqrt(0.5)) < 1e-12);
  CHECK(std::abs(values(coarse, "ny")[2] - std::sqrt(0.5)) < 1e-12);
}

TEST_CASE("What is written is read again, as far as the format holds it")
{
  Input_mesh input;
  {
    const File file(".ply", ply);
    input = read_input_mesh(file.path, Mending::plain, true);
  }
  const std::string extension = GENERATE(".ply", ".obj", ".off", ".stl");
  const File file(extension);
  write_mesh(file.path, input.mesh, file.path, {input.attributes, {}});
  const Polygon_soup soup = read_polygon_soup(file.path);
  CHECK(soup.polygons.size() == 2);
  for(const Attribute& a : input.attributes.known) {
    const bool written = writable(input.attributes, file.path).find(a.name) != nullptr;
    CHECK(written ==
          (extension == ".ply" || (extension != ".stl" && a.name != "label" && a.name != "heat")));
    const Values again = values(soup.attributes, a.name);
    if(written)
      CHECK(again == a.values);
    else
      CHECK(again.empty());
    if(extension == ".ply")
      CHECK(type(soup.attributes, a.name) == a.type);
  }
  CHECK(soup.attributes.unknown.empty());
}

TEST_CASE("Binary PLY files have the same attributes as their text")
{
  const auto raw = [](const auto number) {
    return std::string(reinterpret_cast<const char*>(&number), sizeof(number));
  };
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty short part\nproperty float heat\nelement face 1\n"
      "property list uchar int vertex_index\nend_header\n";
  for(int v = 0; v < 3; ++v)
    bytes += raw(float(v == 1)) + raw(float(v == 2)) + raw(0.f) + raw(std::int16_t(v - 1)) +
             raw(0.25f * float(v));
  bytes +=
      raw(std::uint8_t(3)) + raw(std::int32_t(0)) + raw(std::int32_t(1)) + raw(std::int32_t(2));
  const Attributes a = attributes_of(".ply", bytes);
  CHECK(values(a, "part") == Values{-1, 0, 1});
  CHECK(values(a, "heat") == Values{0, 0.25, 0.5});
}

TEST_CASE("Seams are the edges across which the coordinates differ")
{
  // A slit in a square of 5 x 5 vertices: the vertex in the middle has other coordinates above than
  // below.
  std::string text;
  for(int j = 0; j < 5; ++j)
    for(int i = 0; i < 5; ++i)
      text += "v " + std::to_string(i) + " " + std::to_string(j) + " 0\nvt " + std::to_string(i) +
              " " + std::to_string(j) + "\n";
  text += "vt 2 9\n";
  for(int j = 0; j < 4; ++j)
    for(int i = 0; i < 4; ++i) {
      const auto corner = [&](const int k, const int l) {
        const int v = 5 * l + k + 1;
        return " " + std::to_string(v) + "/" + std::to_string(v == 13 && j >= 2 ? 26 : v);
      };
      text += "f" + corner(i, j) + corner(i + 1, j) + corner(i + 1, j + 1) + "\nf" + corner(i, j) +
              corner(i + 1, j + 1) + corner(i, j + 1) + "\n";
    }
  const File file(".obj", text);
  const Input_mesh input = read_input_mesh(file.path, Mending::none, true);
  const Texture_seams seams(input.mesh, input.texture);
  CHECK(seams.number_of_edges() == 2);
  CHECK(seams.vertices() == std::vector<std::size_t>{11, 12, 13});
}

TEST_CASE("A vertex that comes closer to the other side of a seam keeps to its own")
{
  // A square of 5 x 5 vertices, cut in the middle: its right half is elsewhere in the texture.
  std::string text;
  for(int j = 0; j < 5; ++j)
    for(int i = 0; i < 5; ++i)
      text += "v " + std::to_string(i) + " " + std::to_string(j) + " 0\nvt " + std::to_string(i) +
              " " + std::to_string(j) + "\nvt " + std::to_string(i + 10) + " " + std::to_string(j) +
              "\n";
  for(int j = 0; j < 4; ++j)
    for(int i = 0; i < 4; ++i) {
      const auto corner = [&](const int k, const int l) {
        const int v = 5 * l + k;
        return " " + std::to_string(v + 1) + "/" + std::to_string(2 * v + 1 + (i >= 2));
      };
      text += "f" + corner(i, j) + corner(i + 1, j) + corner(i + 1, j + 1) + "\nf" + corner(i, j) +
              corner(i + 1, j + 1) + corner(i, j + 1) + "\n";
    }
  const File file(".obj", text);
  const Input_mesh input = read_input_mesh(file.path, Mending::none, true);
  const Texture_seams seams(input.mesh, input.texture);
  CHECK(seams.vertices() == std::vector<std::size_t>{2, 7, 12, 17, 22});
  Mesh moved = input.mesh;
  const Mesh::Vertex_index v(11); // from (1, 2)
  moved.point(v) = Kernel::Point_3(2.25, 2.5, 0);
  std::vector<std::size_t> map(25);
  std::iota(map.begin(), map.end(), std::size_t(0));
  const Corner_texture texture = seams.simplified(moved, map);
  for(const auto h : moved.halfedges()) {
    if(moved.is_border(h))
      continue;
    if(moved.target(h) == v)
      CHECK(texture[h] == Texture_point{2, 2.5});
    else
      CHECK(texture[h] == input.texture[h]);
  }
}

TEST_CASE("Seams stay, and both sides keep their coordinates", "[slow]")
{
  namespace SMS = CGAL::Surface_mesh_simplification;
  const int n = 40, m = 20;
  const bool copies = GENERATE(false, true), repaired = GENERATE(false, true);
  Input_mesh input;
  {
    const File file(".obj", torus(n, m, copies, repaired));
    input = read_input_mesh(file.path, repaired ? Mending::full : Mending::plain, true);
  }
  // Copies are one vertex after the repair: the seams are those of corners then.
  REQUIRE(input.mesh.number_of_vertices() ==
          std::size_t(copies && !repaired ? (n + 1) * (m + 1) : n * m));
  CHECK(largest_error(input.mesh, input.texture) < 1e-12);
  const Texture_seams seams(input.mesh, input.texture);
  CHECK(seams.number_of_edges() == std::size_t(n + m));
  CHECK(seams.vertices().size() == std::size_t(copies && !repaired ? 2 * (n + m) : n + m - 1));

  SMS::Spectral_edge_collapse_options options = GENERATE(
      SMS::Spectral_edge_collapse_options::best(), SMS::Spectral_edge_collapse_options::paper());
  options.number_of_eigenvectors = 30;
  options.kept_vertices = seams.vertices();
  Mesh coarse = input.mesh;
  const auto result = SMS::spectral_edge_collapse(coarse, 250, options);
  REQUIRE(result.output_vertices == 250);
  const Corner_texture texture = seams.simplified(coarse, result.vertex_map);
  CHECK(largest_error(coarse, texture) < 0.01); // of a side that is taken for the other: 1

  const File file(".obj");
  write_mesh(file.path, coarse, file.path, {{}, {}, texture});
  const Input_mesh again = read_input_mesh(file.path, Mending::none, true);
  CHECK(largest_error(again.mesh, again.texture) == largest_error(coarse, texture));
  CHECK(Texture_seams(again.mesh, again.texture).number_of_edges() == seams.number_of_edges());
}

TEST_CASE("Why there is no texture at corners is said")
{
  const std::string points =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 1e-14 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
  const auto reason = [&](const std::string& faces, const Mending mending) {
    const File file(".obj", points + faces);
    const Input_mesh input = read_input_mesh(file.path, mending, true);
    CHECK(input.texture.empty());
    return input.without_texture;
  };
  CHECK(reason("f 1 2 3\nf 1 3 4\n", Mending::plain) ==
        "some corners of its faces have no texture coordinates");
  CHECK(reason("f 1/1 2/2 5/2\nf 1/1 5/2 3/3\nf 1/1 3/3 4/4\n", Mending::full) ==
        "the repair has made faces that are no part of one of the file");
  const File file(".off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  CHECK(read_input_mesh(file.path, Mending::plain, true).without_texture ==
        "it has no texture coordinates");
  const File at_vertices(".off", "STOFF\n3 1 0\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n");
  CHECK(read_input_mesh(at_vertices.path, Mending::plain, true).texture.size() == 6);
  const Input_mesh plain = read_input_mesh(at_vertices.path, Mending::plain);
  CHECK((plain.texture.empty() && plain.attributes.known.empty()));
}

} // namespace test_vertex_attributes
