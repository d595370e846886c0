// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Makes the shape of the demonstration: a walking animal whose tail grows back into its back (a
// closed surface of genus 1) with features from half its length down to toes, spines and wrinkles a
// few edges wide.
//
//   make_demo_shape OUTPUT [--vertices N] [--pose stand|walk|bend] [--shuffle SEED] [--map map.txt]
//
// A pose moves the vertices and keeps the triangles: the shapes of two poses are nearly isometric,
// and it is known which vertex is which.
//
// The surface is the zero set of a smooth union of round cones. Marching tetrahedra find its
// topology, isotropic remeshing gives well-shaped triangles of the wanted number, a few Newton
// steps put the vertices back onto the zero set. Beyond 100,000 vertices the triangles of a smaller
// shape are cut into four.

#include "io/command_line.h"
#include "io/matrix_io.h"
#include "io/mesh_io.h"
#include "io/output_files.h"
#include "io/program.h"

#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace PMP = CGAL::Polygon_mesh_processing;

using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;

// A cone with round ends: radius `r` at `a`, radius `s` at `b`.
struct Round_cone
{
  Point a, b;
  double r, s;
};

// The animal: f < 0 inside, f > 0 outside, and |grad f| close to 1.
class Animal
{
public:
  Animal()
  {
    add_body_and_head();
    add_leg({0.52, 0.22, -0.15}, {0.66, 0.30, -0.55}, {0.60, 0.30, -0.98});
    add_leg({0.48, -0.22, -0.15}, {0.44, -0.30, -0.55}, {0.22, -0.29, -0.95});
    add_leg({-0.58, 0.22, -0.12}, {-0.74, 0.30, -0.55}, {-0.90, 0.28, -0.93});
    add_leg({-0.55, -0.22, -0.12}, {-0.46, -0.31, -0.56}, {-0.52, -0.31, -0.98});
    add_tail();
    add_spines();
  }

  // The smooth union -k log(sum exp(-d_i / k)) of the parts, with wrinkles on the skin.
  double operator()(const Point& p) const
  {
    constexpr double k = 0.03;
    double nearest = 1e30, sum = 0; // sum of exp((nearest - d_i) / k)
    for(const Round_cone& part : m_parts) {
      const double d = distance(p, part);
      if(d < nearest) {
        sum = 1 + sum * std::exp((d - nearest) / k);
        nearest = d;
      } else if(d < nearest + 30 * k) {
        sum += std::exp((nearest - d) / k);
      }
    }
    return nearest - k * std::log(sum) + wrinkles(p);
  }

  Vector gradient(const Point& p) const
  {
    constexpr double h = 1e-5;
    const Vector x(h, 0, 0), y(0, h, 0), z(0, 0, h);
    const Animal& f = *this;
    return Vector(f(p + x) - f(p - x), f(p + y) - f(p - y), f(p + z) - f(p - z)) / (2 * h);
  }

  // A box around the animal with some room.
  CGAL::Bbox_3 bbox() const
  {
    CGAL::Bbox_3 box;
    for(const Round_cone& part : m_parts) {
      for(const auto& [p, r] : {std::pair(part.a, part.r + 0.1), std::pair(part.b, part.s + 0.1)})
        box += CGAL::Bbox_3(p.x() - r, p.y() - r, p.z() - r, p.x() + r, p.y() + r, p.z() + r);
    }
    return box;
  }

private:
  static double distance(const Point& p, const Round_cone& c)
  {
    const Vector axis = c.b - c.a;
    const double t = std::clamp((p - c.a) * axis / axis.squared_length(), 0., 1.);
    return std::sqrt((p - (c.a + t * axis)).squared_length()) - (c.r + t * (c.s - c.r));
  }

  static double wrinkles(const Point& p)
  {
    const double coarse =
        std::sin(7 * p.x() + 2 * p.y()) * std::sin(6 * p.y() + 1) * std::sin(8 * p.z() - p.x());
    const double fine = std::sin(31 * p.x() + 9 * p.z()) * std::sin(27 * p.y() + 2) *
                        std::sin(29 * p.z() - 5 * p.x());
    return 0.02 * coarse + 0.006 * fine;
  }

  void add(const Point& a, double r, const Point& b, double s) { m_parts.push_back({a, b, r, s}); }

  void add_body_and_head()
  {
    add({-0.60, 0.00, 0.02}, 0.37, {0.50, 0.00, 0.06}, 0.33);
    add({0.60, 0.00, 0.15}, 0.24, {0.98, 0.06, 0.62}, 0.16); // neck
    add({1.02, 0.07, 0.68}, 0.22, {1.16, 0.13, 0.66}, 0.19); // head
    add({1.20, 0.15, 0.63}, 0.15, {1.46, 0.27, 0.52}, 0.09); // snout
    add({1.00, 0.24, 0.82}, 0.07, {0.88, 0.42, 1.06}, 0.05); // ears
    add({1.06, -0.09, 0.82}, 0.07, {1.02, -0.30, 1.07}, 0.05);
    add({1.30, 0.08, 0.74}, 0.04, {1.33, 0.07, 0.77}, 0.04); // eyes
    add({1.22, 0.28, 0.74}, 0.04, {1.24, 0.30, 0.77}, 0.04);
  }

  void add_leg(const Point& hip, const Point& knee, const Point& ankle)
  {
    add(hip, 0.20, knee, 0.13);
    add(knee, 0.12, ankle, 0.085);
    add(ankle, 0.09, ankle + Vector(0.10, 0, -0.04), 0.075);
    for(const double side : {-0.07, 0., 0.07})
      add(ankle + Vector(0.12, side, -0.05), 0.035, ankle + Vector(0.20, 1.3 * side, -0.06), 0.03);
  }

  // Rises behind the body, swings to the side and ends in the back: the handle.
  void add_tail()
  {
    const auto at = [](double t) {
      const double angle = CGAL_PI * (0.95 - 1.0 * t);
      return Point(-0.50 + 0.42 * std::cos(angle) * (1 - 0.2 * t),
                   0.16 * std::sin(CGAL_PI * t) * std::sin(3 * t),
                   0.16 + 0.55 * std::sin(angle) - 0.05 * t);
    };
    constexpr int pieces = 10;
    for(int i = 0; i < pieces; ++i) {
      const double t = double(i) / pieces, u = double(i + 1) / pieces;
      add(at(t), 0.11 - 0.045 * t, at(u), 0.11 - 0.045 * u);
    }
  }

  // A row of small bumps from the shoulders up the neck, another on each flank.
  void add_spines()
  {
    for(int i = 0; i < 6; ++i) {
      const double t = i / 5.;
      const Point foot(0.42 + 0.36 * t, 0.03 * t, 0.36 + 0.36 * t);
      add(foot, 0.055, foot + Vector(-0.06, 0, 0.10), 0.042);
    }
    for(int i = 0; i < 5; ++i) {
      for(const double side : {-1., 1.})
        add({-0.55 + 0.24 * i, 0.33 * side, 0.1}, 0.055, {-0.56 + 0.24 * i, 0.37 * side, 0.13},
            0.04);
    }
  }

  std::vector<Round_cone> m_parts;
};

// Rotates around an axis through `centre` by `angle`: right-handed around y (`axis` 1) or z (`axis`
// 2).
Point rotated(const Point& p, const Point& centre, int axis, double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  const Vector d = p - centre;
  return axis == 1 ? centre + Vector(c * d.x() + s * d.z(), d.y(), c * d.z() - s * d.x())
                   : centre + Vector(c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z());
}

// From 0 at `from` to 1 at `to`, with continuous second derivatives.
double smooth_step(double x, double from, double to)
{
  const double t = std::clamp((x - from) / (to - from), 0., 1.);
  return t * t * t * (10 + t * (6 * t - 15));
}

// The legs take a step, the head turns. The joints are smooth turns over a length of the width of
// the limb; those of the legs begin below the belly.
Point walking(Point p)
{
  const bool front = p.x() > 0, left = p.y() > 0;
  const Point hip(front ? 0.54 : -0.6, 0, -0.3);
  const double step = front == left ? 0.4 : -0.4;
  p = rotated(p, hip, 1, step * smooth_step(-p.z(), 0.39, 0.75));
  return rotated(p, {0.75, 0.02, 0.4}, 2,
                 0.6 * smooth_step(0.66 * p.x() + 0.75 * p.z(), 0.62, 1.02));
}

// The whole animal turns along a circle.
Point bending(const Point& p)
{
  constexpr double curvature = 0.45;
  const double angle = curvature * p.x(), radius = 1 / curvature - p.y();
  return {radius * std::sin(angle), 1 / curvature - radius * std::cos(angle), p.z()};
}

// The zero set of f on a regular grid of cubes of size h, each cut into six tetrahedra around its
// diagonal: a closed manifold, because neighbouring cubes agree on the diagonals of their common
// face.
class Marching_tetrahedra
{
public:
  Marching_tetrahedra(const Animal& f, double h)
    : m_box(f.bbox())
    , m_h(h)
  {
    for(int d = 0; d < 3; ++d)
      m_size[d] = static_cast<std::size_t>((m_box.max(d) - m_box.min(d)) / h) + 2;
    m_values.resize(m_size[0] * m_size[1] * m_size[2]);
    for(std::size_t i = 0; i < m_values.size(); ++i) {
      const double value = f(position(i));
      m_values[i] = std::abs(value) < 1e-3 * h
                        ? 1e-3 * h
                        : value; // no vertex on a grid point, no empty triangle
    }
  }

  Mesh run()
  {
    for(std::size_t z = 0; z + 1 < m_size[2]; ++z) {
      for(std::size_t y = 0; y + 1 < m_size[1]; ++y) {
        for(std::size_t x = 0; x + 1 < m_size[0]; ++x)
          cut_cube(x, y, z);
      }
    }
    Mesh mesh;
    PMP::polygon_soup_to_polygon_mesh(m_points, m_triangles, mesh);
    return mesh;
  }

private:
  std::size_t index(std::size_t x, std::size_t y, std::size_t z) const
  {
    return x + m_size[0] * (y + m_size[1] * z);
  }

  Point position(std::size_t i) const
  {
    const double x = i % m_size[0], y = i / m_size[0] % m_size[1], z = i / (m_size[0] * m_size[1]);
    return {m_box.xmin() + m_h * x, m_box.ymin() + m_h * y, m_box.zmin() + m_h * z};
  }

  void cut_cube(std::size_t x, std::size_t y, std::size_t z)
  {
    std::array<std::size_t, 8> corner;
    for(std::size_t c = 0; c < 8; ++c)
      corner[c] = index(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
    // From corner 0 to corner 7 along the axes, in each of their six orders.
    constexpr int paths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
    for(const auto& path : {0, 1, 2, 3, 4, 5})
      cut_tetrahedron({corner[0], corner[paths[path][0]], corner[paths[path][1]], corner[7]});
  }

  void cut_tetrahedron(std::array<std::size_t, 4> t)
  {
    const auto middle =
        std::partition(t.begin(), t.end(), [&](std::size_t i) { return m_values[i] < 0; });
    const auto inside = middle - t.begin();
    if(inside == 1)
      add_triangle(t, {crossing(t[0], t[1]), crossing(t[0], t[2]), crossing(t[0], t[3])});
    else if(inside == 3)
      add_triangle(t, {crossing(t[0], t[3]), crossing(t[1], t[3]), crossing(t[2], t[3])});
    else if(inside == 2) {
      const std::size_t first = crossing(t[0], t[2]), opposite = crossing(t[1], t[3]);
      add_triangle(t, {first, crossing(t[0], t[3]), opposite});
      add_triangle(t, {first, opposite, crossing(t[1], t[2])});
    }
  }

  // Turns the triangle so that it faces away from t[0], which is inside.
  void add_triangle(const std::array<std::size_t, 4>& t, std::array<std::size_t, 3> triangle)
  {
    const Point &a = m_points[triangle[0]], &b = m_points[triangle[1]], &c = m_points[triangle[2]];
    if(CGAL::cross_product(b - a, c - a) * (a - position(t[0])) < 0)
      std::swap(triangle[1], triangle[2]);
    m_triangles.push_back(triangle);
  }

  // The vertex on the grid edge (i, j), made when first asked for.
  std::size_t crossing(std::size_t i, std::size_t j)
  {
    const auto [place, is_new] = m_crossings.try_emplace(std::minmax(i, j), m_points.size());
    if(is_new) {
      const Point p = position(i), q = position(j);
      m_points.push_back(p + m_values[i] / (m_values[i] - m_values[j]) * (q - p));
    }
    return place->second;
  }

  CGAL::Bbox_3 m_box;
  double m_h;
  std::array<std::size_t, 3> m_size;
  std::vector<double> m_values;
  std::vector<Point> m_points;
  std::vector<std::array<std::size_t, 3>> m_triangles;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> m_crossings;
};

// Moves every vertex to the zero set by Newton's method along the gradient.
void project(const Animal& animal, Mesh& mesh)
{
  for(const auto v : vertices(mesh)) {
    for(int step = 0; step < 3; ++step) {
      const Point p = mesh.point(v);
      const Vector g = animal.gradient(p);
      mesh.point(v) = p - animal(p) / g.squared_length() * g;
    }
  }
}

// Each triangle cut into four at the midpoints of its edges, which lie on the zero set as well
// afterwards.
Mesh refined(const Animal& animal, const Mesh& coarse)
{
  Mesh mesh;
  for(const auto v : vertices(coarse))
    mesh.add_vertex(coarse.point(v));
  for(const auto e : edges(coarse))
    mesh.add_vertex(
        CGAL::midpoint(coarse.point(source(e, coarse)), coarse.point(target(e, coarse))));
  const auto middle = [&](const Mesh::Halfedge_index h) {
    return Mesh::Vertex_index(
        static_cast<Mesh::size_type>(num_vertices(coarse) + std::size_t(edge(h, coarse))));
  };
  for(const auto f : faces(coarse)) {
    const auto h = halfedge(f, coarse), i = next(h, coarse), j = next(i, coarse);
    mesh.add_face(middle(h), middle(i), middle(j));
    for(const auto& [in, out] : {std::pair(h, i), std::pair(i, j), std::pair(j, h)})
      mesh.add_face(middle(in), target(in, coarse), middle(out));
  }
  project(animal, mesh);
  return mesh;
}

// The animal with about `number_of_vertices` vertices.
Mesh make_shape(std::size_t number_of_vertices)
{
  const Animal animal;
  if(number_of_vertices > 100000) // remeshing takes minutes for a million
    return refined(animal, make_shape(number_of_vertices / 4));
  const double scale = std::sqrt(25000. / number_of_vertices);
  const Mesh dense = Marching_tetrahedra(animal, 0.022 * (std::min)(scale, 1.)).run();

  // Remeshing ends with edges a little shorter than it was asked for: the factor brings the first
  // attempt near.
  double edge_length = std::sqrt(PMP::area(dense) / number_of_vertices * 2 / std::sqrt(3.)) * 1.093;
  for(int attempt = 0;; ++attempt) {
    Mesh mesh = dense;
    PMP::isotropic_remeshing(faces(mesh), edge_length, mesh,
                             CGAL::parameters::number_of_iterations(5));
    mesh.collect_garbage();
    const double excess = double(num_vertices(mesh)) / number_of_vertices;
    if(attempt == 4 || std::abs(excess - 1) < 0.02) {
      project(animal, mesh);
      return mesh;
    }
    edge_length *= std::sqrt(excess);
  }
}

void pose(Mesh& mesh, const std::string& name)
{
  for(const auto v : vertices(mesh))
    mesh.point(v) = name == "walk" ? walking(mesh.point(v)) : bending(mesh.point(v));
}

// Renumbers vertices and faces at random. Returns for each vertex its new number.
std::vector<std::size_t> shuffle(Mesh& mesh, unsigned seed)
{
  // std::shuffle differs between libraries, this does not.
  std::mt19937 random(seed);
  const auto shuffled = [&](std::size_t n) {
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t(0));
    for(std::size_t i = n; i > 1; --i)
      std::swap(order[i - 1], order[random() % i]);
    return order;
  };
  const std::vector<std::size_t> new_number = shuffled(num_vertices(mesh));
  std::vector<Point> points(new_number.size());
  for(std::size_t v = 0; v < new_number.size(); ++v)
    points[new_number[v]] = mesh.point(Mesh::Vertex_index(static_cast<Mesh::size_type>(v)));
  std::vector<std::array<std::size_t, 3>> triangles(num_faces(mesh));
  const std::vector<std::size_t> face_number = shuffled(triangles.size());
  for(const auto f : faces(mesh)) {
    std::array<std::size_t, 3>& triangle = triangles[face_number[f]];
    std::size_t corner = 0;
    for(const auto v : vertices_around_face(halfedge(f, mesh), mesh))
      triangle[corner++] = new_number[v];
  }
  mesh.clear();
  PMP::polygon_soup_to_polygon_mesh(points, triangles, mesh);
  return new_number;
}

int run(int argc, char* argv[])
{
  std::string output, pose_name = "stand", map;
  long number_of_vertices = 25000;
  std::optional<long> seed;
  Command_line line(
      "make_demo_shape OUTPUT [options]",
      "Makes a closed surface of genus 1, an animal. OUTPUT ends in .off, .obj, .ply or .stl.");
  line.argument(output);
  line.group("Options");
  line.option("vertices", number_of_vertices, "N", "about how many vertices");
  line.choice("pose", pose_name, {"stand", "walk", "bend"},
              "nearly isometric, with the same triangles");
  line.option("shuffle", seed, "X", "renumber vertices and faces at random with this seed");
  line.option("map", map, "map.txt",
              "write for each vertex its number in OUTPUT, one per line, from 0; a "
              "line is the same vertex in every pose");
  const std::string help = line.read(argc, argv);
  if(!help.empty()) {
    std::cout << help;
    return 0;
  }
  if(output.empty())
    throw std::runtime_error(
        "the name of the file to write is missing: make_demo_shape OUTPUT [--vertices N].");
  if(number_of_vertices < 1000 || number_of_vertices > 1000000)
    throw std::runtime_error("--vertices is " + std::to_string(number_of_vertices) +
                             ", it must lie between 1000 and 1000000.");
  if(seed && (*seed < 0 || *seed > 1000000000))
    throw std::runtime_error("--shuffle is " + std::to_string(*seed) +
                             ", it must lie between 0 and 1000000000.");

  mesh_format(output);
  Output_files files({});
  files.add(output);
  if(!map.empty())
    files.add(map);
  Mesh mesh = make_shape(static_cast<std::size_t>(number_of_vertices));
  if(pose_name != "stand")
    pose(mesh, pose_name);
  std::vector<std::size_t> numbers(num_vertices(mesh));
  std::iota(numbers.begin(), numbers.end(), std::size_t(0));
  if(seed)
    numbers = shuffle(mesh, static_cast<unsigned>(*seed));
  write_mesh(files.temporary(output), mesh, output);
  if(!map.empty())
    write_indices(files.temporary(map), numbers, map);
  files.commit();
  std::cout << printable(output) << ": " << num_vertices(mesh) << " vertices, " << num_faces(mesh)
            << " faces\n";
  return 0;
}

int main(int argc, char* argv[])
{
  return run_program("make_demo_shape", [&] { return run(argc, argv); });
}
