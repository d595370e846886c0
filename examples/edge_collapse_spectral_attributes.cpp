// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// edge_collapse_spectral_attributes INPUT OUTPUT N
//
// P carries property maps of a `Surface_mesh` to the simplified mesh: colours, normals, and labels,
// by the largest weight in a row. A visitor that mixes the values of the two vertices at each
// collapse gives the same, because P is the product of these steps. Here it does so for the
// normals, and both are compared. OUTPUT ends in .ply, which holds all of them.

#include <CGAL/IO/Color.h>
#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <map>
#include <vector>

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = Mesh::Vertex_index;
namespace SMS = CGAL::Surface_mesh_simplification;

//! [visitor]
// Mixes the vectors of the two ends of an edge by where on it the new vertex lies, as P does, while
// the mesh is collapsed.
class Interpolating_visitor : public SMS::Edge_collapse_visitor_base<Mesh>
{
public:
  using Vector_map = Mesh::Property_map<Vertex, Kernel::Vector_3>;

  explicit Interpolating_visitor(const Vector_map map)
    : m_map(map)
  {}

  template <class Profile, class OptionalPoint>
  void OnCollapsing(const Profile& edge, const OptionalPoint& placement)
  {
    const Kernel::Vector_3 along = edge.p0() - edge.p1();
    const double length = along.squared_length();
    const double alpha = !placement   ? 0
                         : length > 0 ? (*placement - edge.p1()) * along / length
                                      : 0.5;
    const double weight = (std::min)((std::max)(alpha, 0.), 1.);
    m_mixed = (1 - weight) * m_map[edge.v1()] + weight * m_map[edge.v0()];
  }

  template <class Profile>
  void OnCollapsed(const Profile&, const Vertex left)
  {
    m_map[left] = m_mixed;
  }

private:
  Vector_map m_map;
  Kernel::Vector_3 m_mixed;
};
//! [visitor]

int main(int argc, char* argv[])
try {
  Mesh mesh;
  if(argc != 4 || !CGAL::IO::read_polygon_mesh(argv[1], mesh)) {
    std::cerr << "usage: edge_collapse_spectral_attributes INPUT OUTPUT.ply N, INPUT being a "
                 "triangle mesh\n";
    return EXIT_FAILURE;
  }
  // What a mesh may have at its vertices; here it is made up: the colour by the normal, the label
  // by the side of the plane x = y.
  auto colour = mesh.add_property_map<Vertex, CGAL::IO::Color>("v:color").first;
  auto normal = mesh.add_property_map<Vertex, Kernel::Vector_3>("v:normal").first;
  auto label = mesh.add_property_map<Vertex, int>("v:label").first;
  CGAL::Polygon_mesh_processing::compute_vertex_normals(mesh, normal);
  const auto channel = [](const double x) {
    return static_cast<unsigned char>(std::lround((std::min)((std::max)(x, 0.), 255.)));
  };
  const auto shade = [&](const Kernel::Vector_3& n) {
    return CGAL::IO::Color(channel(127.5 + 127.5 * n.x()), channel(127.5 + 127.5 * n.y()),
                           channel(127.5 + 127.5 * n.z()));
  };
  const auto side = [&](const Vertex v) { return mesh.point(v).x() > mesh.point(v).y() ? 7 : 3; };
  for(const Vertex v : mesh.vertices()) {
    colour[v] = shade(normal[v]);
    label[v] = side(v);
  }

  auto mixed = mesh.add_property_map<Vertex, Kernel::Vector_3>("v:mixed").first; // by the visitor
  for(const Vertex v : mesh.vertices())
    mixed[v] = normal[v];

  //! [attributes]
  Eigen::MatrixXd values(mesh.number_of_vertices(),
                         6); // in the order of vertices(mesh), as the columns of P
  std::vector<int> labels;
  for(const Vertex v : mesh.vertices()) {
    values.row(Eigen::Index(labels.size())) << colour[v].red(), colour[v].green(), colour[v].blue(),
        normal[v].x(), normal[v].y(), normal[v].z();
    labels.push_back(label[v]);
  }

  SMS::Spectral_policies spectral(mesh);
  SMS::edge_collapse(mesh,
                     SMS::Vertex_count_stop_predicate(std::strtoul(argv[3], nullptr, 10), mesh),
                     CGAL::parameters::get_cost(spectral.get_cost())
                         .get_placement(spectral.get_placement())
                         .visitor(spectral.visitor(Interpolating_visitor(mixed))));

  const Eigen::SparseMatrix<double, Eigen::RowMajor> P = spectral.restriction();
  const Eigen::MatrixXd carried = P * values;
  Eigen::Index row = 0; // in the order of vertices(mesh) as it is now
  for(const Vertex v : mesh.vertices()) {
    const auto c = carried.row(row);
    colour[v] = CGAL::IO::Color(channel(c[0]), channel(c[1]), channel(c[2]));
    const Kernel::Vector_3 n(c[3], c[4], c[5]);
    normal[v] = n / (std::max)(std::sqrt(n.squared_length()), 1e-300);
    std::map<int, double> votes;
    for(Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(P, row); it; ++it)
      votes[labels[std::size_t(it.col())]] += it.value();
    const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
    label[v] = std::max_element(votes.begin(), votes.end(), fewer)->first;
    ++row;
  }
  //! [attributes]

  double degrees = 0, steps = 0, right = 0, difference = 0;
  row = 0;
  for(const Vertex v : mesh.vertices()) {
    const Kernel::Vector_3 n = CGAL::Polygon_mesh_processing::compute_vertex_normal(v, mesh);
    degrees += std::acos((std::min)(n * normal[v], 1.)) * 180 / std::acos(-1.);
    steps += std::abs(colour[v].red() - shade(normal[v]).red());
    right += label[v] == side(v);
    const auto c = carried.row(row++);
    difference =
        (std::max)(difference, (Kernel::Vector_3(c[3], c[4], c[5]) - mixed[v]).squared_length());
  }
  const double N = double(mesh.number_of_vertices());
  std::cout << N << " vertices; normals are " << degrees / N
            << " degrees from those of the faces, red is " << steps / N
            << " of 255 from what the normal asks for, " << 100 * right / N
            << " % of the labels are on their side\n"
            << "normals of the visitor and of P differ by " << std::sqrt(difference)
            << " at most\n";
  mesh.remove_property_map(mixed);
  return CGAL::IO::write_polygon_mesh(argv[2], mesh, CGAL::parameters::stream_precision(17))
             ? EXIT_SUCCESS
             : EXIT_FAILURE;
} catch(const std::exception& error) {
  std::cerr << error.what() << '\n';
  return EXIT_FAILURE;
}
