// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_SHAPES_H
#define SPECTRAL_TEST_SHAPES_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>

#include <CGAL/Kernel_traits.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/helpers.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <array>
#include <map>
#include <utility>
#include <vector>

// Meshes with known geometry, as matrices (..._matrices()) and in any MutableFaceGraph
// (make_...()).
namespace shapes {

using Matrices = CGAL::Spectral_geometry::Mesh_matrices;

constexpr double pi = 3.14159265358979323846;

inline Matrices matrices(const std::vector<Eigen::Vector3d>& points,
                         const std::vector<Eigen::Vector3i>& triangles)
{
  Matrices result{Eigen::MatrixXd(points.size(), 3), Eigen::MatrixXi(triangles.size(), 3)};
  for(std::size_t i = 0; i < points.size(); ++i)
    result.V.row(i) = points[i];
  for(std::size_t i = 0; i < triangles.size(); ++i)
    result.T.row(i) = triangles[i];
  return result;
}

// The mesh whose vertex i is the vertex p[i] of another.
inline Matrices permuted(const Matrices& mesh, const std::vector<Eigen::Index>& p)
{
  Matrices result = mesh;
  std::vector<int> place(p.size());
  for(std::size_t i = 0; i < p.size(); ++i) {
    result.V.row(static_cast<Eigen::Index>(i)) = mesh.V.row(p[i]);
    place[static_cast<std::size_t>(p[i])] = static_cast<int>(i);
  }
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f)
    for(int c = 0; c < 3; ++c)
      result.T(f, c) = place[static_cast<std::size_t>(mesh.T(f, c))];
  return result;
}

inline Matrices tetrahedron_matrices()
{
  return matrices({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                  {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}});
}

// An icosahedron whose faces are split into four `subdivisions` times, on the sphere: 10 *
// 4^subdivisions + 2 vertices.
inline Matrices icosphere_matrices(int subdivisions, double radius = 1.)
{
  const double g = 0.5 * (1. + std::sqrt(5.));
  std::vector<Eigen::Vector3d> points = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                         {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                         {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  std::vector<Eigen::Vector3i> triangles = {
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for(; subdivisions > 0; --subdivisions) {
    std::map<std::pair<int, int>, int> midpoints;
    const auto midpoint = [&](int i, int j) {
      const auto inserted = midpoints.insert({std::minmax(i, j), static_cast<int>(points.size())});
      if(inserted.second)
        points.push_back(points[i].normalized() + points[j].normalized());
      return inserted.first->second;
    };
    std::vector<Eigen::Vector3i> finer;
    for(const Eigen::Vector3i& t : triangles) {
      const int a = midpoint(t(0), t(1)), b = midpoint(t(1), t(2)), c = midpoint(t(2), t(0));
      finer.insert(finer.end(), {{t(0), a, c}, {t(1), b, a}, {t(2), c, b}, {a, b, c}});
    }
    triangles.swap(finer);
  }
  for(Eigen::Vector3d& p : points)
    p *= radius / p.norm();
  return matrices(points, triangles);
}

// Without a symmetry, rounder than `bumpy_icosphere_matrices()`, on any sphere.
inline Matrices pebble_matrices(Matrices sphere)
{
  for(Eigen::Index i = 0; i < sphere.V.rows(); ++i) {
    const Eigen::Vector3d d = sphere.V.row(i).transpose().normalized();
    sphere.V.row(i) =
        Eigen::RowVector3d(1.5 * d.x(), 1.1 * d.y(), 0.8 * d.z()) *
        (1 + 0.15 * std::sin(3 * d.x() + 1) + 0.1 * std::cos(4 * d.y() + d.z() - 0.3) +
         0.08 * std::sin(5 * d.z() + 2 * d.x() + 0.5));
  }
  return sphere;
}

// A closed shape without symmetry, star-shaped: five limbs and waves of three lengths on an
// icosphere.
inline Matrices bumpy_icosphere_matrices(int subdivisions)
{
  const Eigen::Vector3d limbs[] = {
      {1, 0.2, 0.1}, {-0.8, 0.7, 0.3}, {-0.3, -1, 0.4}, {0.1, 0.4, 1}, {0.4, -0.3, -1}};
  const double height[] = {1.1, 0.8, 0.9, 0.6, 0.7};
  Matrices result = icosphere_matrices(subdivisions);
  for(Eigen::Index i = 0; i < result.V.rows(); ++i) {
    const Eigen::Vector3d d = result.V.row(i);
    double r = 1.;
    for(int k = 0; k < 5; ++k)
      r += height[k] * std::exp(18. * (d.dot(limbs[k].normalized()) - 1.));
    r += 0.06 * std::sin(5. * d.x() + 3. * d.y() + 0.5) + 0.03 * std::sin(9. * d.y() - 7. * d.z());
    r += 0.012 * std::sin(21. * d.z() + 14. * d.x()) * std::cos(17. * d.y());
    result.V.row(i) *= r;
  }
  return result;
}

// A closed surface of revolution, bent: rings of `around` vertices along a body that ends in a thin
// limb, folded back beside itself at a tenth of its length, or at twice `bend`: its radius is
// 0.055. Little of the spectrum lives on the limb.
inline Matrices folded_limb_matrices(int along, int around, double bend = 0.14)
{
  constexpr double pi = 3.14159265358979323846, leg = 1.2, body = 0.9;
  const double length = body + leg + pi * bend + 0.85 * leg;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  const auto ring = [&](int i, int j) { return i * around + (j + around) % around; };
  for(int i = 0; i < along; ++i) {
    const double s = length * (i + 0.5) / along; // along the centre
    double r =
        0.055 * std::sqrt((std::min)(1., (length - s) / 0.055)) * (1 + 0.1 * std::sin(9 * s));
    if(s < body)
      r = (std::max)(r, 0.42 * std::sqrt((std::max)(0., 1 - std::pow(2 * s / body - 1, 2))));
    Eigen::Vector3d centre(0, 0, -s), across(1, 0, 0);
    const double t = s - body - leg;
    if(t > pi * bend) {
      centre = Eigen::Vector3d(2 * bend, 0, -body - leg + (t - pi * bend));
      across = Eigen::Vector3d(-1, 0, 0);
    } else if(t > 0) {
      const double angle = t / bend;
      across = Eigen::Vector3d(std::cos(angle), 0, std::sin(angle));
      centre =
          Eigen::Vector3d(bend - bend * std::cos(angle), 0, -body - leg - bend * std::sin(angle));
    }
    for(int j = 0; j < around; ++j) {
      const double angle = 2 * pi * (j + 0.5 * (i % 2)) / around;
      points.push_back(centre +
                       r * (std::cos(angle) * across + std::sin(angle) * Eigen::Vector3d(0, 1, 0)));
    }
    for(int j = 0; i > 0 && j < around; ++j) {
      const int shift = i % 2; // rows are half a step apart
      triangles.push_back({ring(i - 1, j), ring(i, j - 1 + shift), ring(i, j + shift)});
      triangles.push_back({ring(i - 1, j), ring(i, j + shift), ring(i - 1, j + 1)});
    }
  }
  const int first = static_cast<int>(points.size()), last = first + 1;
  for(const int i : {0, along - 1}) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for(int j = 0; j < around; ++j)
      middle += points[static_cast<std::size_t>(ring(i, j))] / around;
    points.push_back(middle);
  }
  for(int j = 0; j < around; ++j) {
    triangles.push_back({ring(0, j), ring(0, j + 1), first});
    triangles.push_back({ring(along - 1, j + 1), ring(along - 1, j), last});
  }
  return matrices(points, triangles);
}

// A closed bowl, a fiftieth as thick as wide: two sheets that coarse triangles cut through.
inline Matrices thin_bowl_matrices(int subdivisions)
{
  Matrices result = icosphere_matrices(subdivisions);
  for(Eigen::Index i = 0; i < result.V.rows(); ++i) {
    const double x = result.V(i, 0), y = result.V(i, 1);
    result.V(i, 2) =
        0.02 * result.V(i, 2) + 0.7 * (x * x + y * y) + 0.05 * std::sin(5 * x) * std::cos(4 * y);
  }
  return result;
}

// [0, width] x [0, height] in the plane z = 0, nx x ny cells, each cut in two by the same diagonal.
inline Matrices grid_matrices(int nx, int ny, double width = 1., double height = 1.)
{
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  for(int j = 0; j <= ny; ++j)
    for(int i = 0; i <= nx; ++i)
      points.emplace_back(width * i / nx, height * j / ny, 0.);
  for(int j = 0; j < ny; ++j)
    for(int i = 0; i < nx; ++i) {
      const int a = j * (nx + 1) + i, b = a + 1, c = b + nx + 1, d = c - 1;
      triangles.emplace_back(a, b, c);
      triangles.emplace_back(a, c, d);
    }
  return matrices(points, triangles);
}

// The grid with its inner vertices moved by up to `amount` cells, in the plane.
inline Matrices irregular_grid_matrices(int nx, int ny, double amount = 0.25)
{
  Matrices result = grid_matrices(nx, ny);
  for(Eigen::Index v = 0; v < result.V.rows(); ++v) {
    const double x = result.V(v, 0), y = result.V(v, 1);
    if(x == 0. || x == 1. || y == 0. || y == 1.)
      continue;
    result.V(v, 0) += amount / nx * std::sin(12.9898 * v);
    result.V(v, 1) += amount / ny * std::sin(78.233 * v + 1.);
  }
  return result;
}

// A hilly island, whose coast has bays of two sizes: rings around a vertex in the middle.
inline Matrices island_matrices(const int rings, const int around)
{
  std::vector<Eigen::Vector3d> points = {{0, 0, 0.3}};
  std::vector<Eigen::Vector3i> triangles;
  for(int r = 1; r <= rings; ++r)
    for(int i = 0; i < around; ++i) {
      const double phi = 2 * pi * i / around, s = double(r) / rings;
      const double reach = s * (1 + s * s * (0.2 * std::sin(5 * phi) + 0.05 * std::sin(19 * phi)));
      const double x = reach * std::cos(phi), y = reach * std::sin(phi);
      points.emplace_back(x, y, 0.3 * std::cos(3 * x + 0.5) * std::cos(2.5 * y));
      const int next = (i + 1) % around, outer = 1 + (r - 1) * around, inner = outer - around;
      if(r == 1)
        triangles.emplace_back(0, outer + i, outer + next);
      else {
        triangles.emplace_back(inner + i, outer + i, outer + next);
        triangles.emplace_back(inner + i, outer + next, inner + next);
      }
    }
  return matrices(points, triangles);
}

// An equilateral triangle of side 1 in the plane z = 0, cut into n^2 equilateral triangles.
inline Matrices equilateral_matrices(int n)
{
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  for(int j = 0; j <= n; ++j)
    for(int i = 0; i + j <= n; ++i)
      points.emplace_back((i + 0.5 * j) / n, std::sqrt(0.75) * j / n, 0.);
  for(int j = 0, a = 0; j < n; ++j, ++a)
    for(int i = 0; i + j < n; ++i, ++a) {
      const int above = a + n + 1 - j;
      triangles.emplace_back(a, a + 1, above);
      if(i + j + 1 < n)
        triangles.emplace_back(a + 1, above + 1, above);
    }
  return matrices(points, triangles);
}

/// A slab of unit cubes with a x b holes: a closed surface of genus a b, a little bent.
inline Matrices lattice_matrices(const int a, const int b)
{
  const auto solid = [&](const std::array<int, 3>& c) {
    return c[2] == 0 && c[0] >= 0 && c[1] >= 0 && c[0] <= 2 * a && c[1] <= 2 * b &&
           (c[0] % 2 == 0 || c[1] % 2 == 0);
  };
  std::map<std::array<int, 3>, int> index;
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3i> triangles;
  const auto vertex = [&](const std::array<int, 3>& c) {
    const auto [at, is_new] = index.insert({c, int(positions.size())});
    if(is_new)
      positions.emplace_back(c[0] + 0.05 * std::sin(1.3 * c[1] + 2. * c[2]),
                             c[1] + 0.05 * std::sin(1.1 * c[0] + 1.), c[2]);
    return at->second;
  };
  for(int i = 0; i <= 2 * a; ++i)
    for(int j = 0; j <= 2 * b; ++j)
      for(int side = 0; side < 6; ++side) {
        const std::array<int, 3> cube{i, j, 0};
        const std::size_t axis = std::size_t(side / 2), u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::array<int, 3> next = cube;
        next[axis] += side % 2 == 0 ? 1 : -1;
        if(!solid(cube) || solid(next))
          continue;
        std::array<int, 3> corner = cube;
        corner[axis] += side % 2 == 0;
        int q[4];
        for(int k = 0; k < 4; ++k) {
          std::array<int, 3> c = corner;
          c[u] += k == 1 || k == 2;
          c[v] += k >= 2;
          q[side % 2 == 0 ? k : 3 - k] = vertex(c);
        }
        triangles.emplace_back(q[0], q[1], q[2]);
        triangles.emplace_back(q[0], q[2], q[3]);
      }
  return matrices(positions, triangles);
}

inline Matrices torus_matrices(int nu, int nv, double major = 1., double minor = 0.4)
{
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  for(int i = 0; i < nu; ++i)
    for(int j = 0; j < nv; ++j) {
      const double u = 2. * pi * i / nu, v = 2. * pi * j / nv, r = major + minor * std::cos(v);
      points.emplace_back(r * std::cos(u), r * std::sin(u), minor * std::sin(v));
      const int i1 = (i + 1) % nu, j1 = (j + 1) % nv;
      triangles.emplace_back(i * nv + j, i1 * nv + j, i1 * nv + j1);
      triangles.emplace_back(i * nv + j, i1 * nv + j1, i * nv + j1);
    }
  return matrices(points, triangles);
}

// A wavy disc: the centre, vertex 0, has d neighbours.
inline Matrices disc_matrices(int d)
{
  std::vector<Eigen::Vector3d> points = {{0, 0, 0.1}};
  std::vector<Eigen::Vector3i> triangles;
  for(int i = 0; i < d; ++i) {
    const double a = 2. * pi * i / d,
                 r = 1. + 0.1 * std::cos(5. * a) + 0.02 * std::sin(17. * a + 1.);
    points.emplace_back(r * std::cos(a), r * std::sin(a), 0.05 * std::sin(3. * a));
    triangles.emplace_back(0, 1 + i, 1 + (i + 1) % d);
  }
  return matrices(points, triangles);
}

// A closed gear: a cylinder of `rings` rings of d vertices; the centres of its two caps, the last
// vertices, have d neighbours.
inline Matrices gear_matrices(int d, int rings)
{
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  for(int j = 0; j < rings; ++j)
    for(int i = 0; i < d; ++i) {
      const double a = 2. * pi * (i + 0.5 * j) / d;
      const double r = 1. + 0.1 * std::cos(5. * a) + 0.02 * std::sin(17. * a + 1.);
      points.emplace_back(r * std::cos(a), r * std::sin(a), 0.5 * j + 0.05 * std::sin(3. * a));
    }
  points.emplace_back(0, 0, -0.1);
  points.emplace_back(0, 0, 0.5 * (rings - 1) + 0.1);
  const int bottom = rings * d, top = bottom + 1, last = (rings - 1) * d;
  for(int i = 0; i < d; ++i) {
    const int next = (i + 1) % d;
    for(int j = 0; j + 1 < rings; ++j) {
      triangles.emplace_back(j * d + i, j * d + next, (j + 1) * d + i);
      triangles.emplace_back(j * d + next, (j + 1) * d + next, (j + 1) * d + i);
    }
    triangles.emplace_back(bottom, next, i);
    triangles.emplace_back(top, last + i, last + next);
  }
  return matrices(points, triangles);
}

// `copies` of a mesh as connected components, side by side.
inline Matrices components_matrices(const Matrices& mesh, int copies)
{
  const Eigen::Index n = mesh.V.rows(), m = mesh.T.rows();
  const double step = 1.5 * (mesh.V.col(0).maxCoeff() - mesh.V.col(0).minCoeff());
  Matrices result{Eigen::MatrixXd(copies * n, 3), Eigen::MatrixXi(copies * m, 3)};
  for(int c = 0; c < copies; ++c) {
    result.V.middleRows(c * n, n) = mesh.V;
    result.V.col(0).segment(c * n, n).array() += c * step;
    result.T.middleRows(c * m, m) = mesh.T.array() + static_cast<int>(c * n);
  }
  return result;
}

// Vertices and faces are added in the order of the rows.
template <class Mesh>
void make_mesh(Mesh& mesh, const Matrices& from)
{
  using Vertex = typename boost::graph_traits<Mesh>::vertex_descriptor;
  auto points = get(CGAL::vertex_point, mesh);
  using Point = typename boost::property_traits<decltype(points)>::value_type;
  std::vector<Vertex> vertex;
  for(Eigen::Index i = 0; i < from.V.rows(); ++i) {
    vertex.push_back(add_vertex(mesh));
    put(points, vertex.back(), Point(from.V(i, 0), from.V(i, 1), from.V(i, 2)));
  }
  for(Eigen::Index f = 0; f < from.T.rows(); ++f) {
    const std::vector<Vertex> corners = {vertex[from.T(f, 0)], vertex[from.T(f, 1)],
                                         vertex[from.T(f, 2)]};
    CGAL::Euler::add_face(corners, mesh);
  }
}

} // namespace shapes

#endif // SPECTRAL_TEST_SHAPES_H
