// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// edge_collapse_spectral_swap INPUT OUTPUT N [surface_mesh|polyhedron|openmesh]
//
// A program with Garland-Heckbert policies, constrained edges and a filter, before and after a
// change to the spectral policies: the same call of CGAL's, then relocation, on any mesh type.

#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/spectral_relocation.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>
#ifdef SPECTRAL_EXAMPLE_OPENMESH
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <CGAL/boost/graph/graph_traits_TriMesh_ArrayKernelT.h>
#endif

#include <cstdlib>
#include <exception>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <string>

using Kernel = CGAL::Simple_cartesian<double>;
using Surface_mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Polyhedron = CGAL::Polyhedron_3<Kernel>;
namespace PMP = CGAL::Polygon_mesh_processing;
namespace SMS = CGAL::Surface_mesh_simplification;

// Edges sharper than 60 degrees, and those of the border. Not `bool`: CGAL 5.5 cannot read such a
// property of OpenMesh.
template <class Mesh>
auto sharp_edges(Mesh& mesh)
{
  const auto result = get(CGAL::dynamic_edge_property_t<char>(), mesh);
  for(const auto e : edges(mesh))
    put(result, e, false);
  PMP::detect_sharp_edges(mesh, 60, result);
  return result;
}

template <class Mesh>
void simplify_before(Mesh& mesh, const std::size_t N)
{
  const auto constrained = sharp_edges(mesh);
  //! [before]
  using Point_map = typename boost::property_map<Mesh, CGAL::vertex_point_t>::type;
  using Point = typename boost::property_traits<Point_map>::value_type;
  using Policies =
      SMS::GarlandHeckbert_plane_policies<Mesh, typename CGAL::Kernel_traits<Point>::Kernel>;
  Policies policies(mesh);
  const SMS::Constrained_placement<typename Policies::Get_placement, decltype(constrained)>
      placement(constrained, policies.get_placement());
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate(N, mesh),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(placement)
                         .edge_is_constrained_map(constrained)
                         .filter(SMS::Bounded_normal_change_filter<>()));
  //! [before]
}

template <class Mesh>
void simplify(Mesh& mesh, const std::size_t N)
{
  const auto constrained = sharp_edges(mesh);
  //! [swap]
  SMS::Spectral_policies spectral(mesh, {}, CGAL::parameters::edge_is_constrained_map(constrained));
  const SMS::Constrained_placement<typename decltype(spectral)::Get_placement,
                                   decltype(constrained)>
      placement(constrained, spectral.get_placement());
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate(N, mesh),
                     CGAL::parameters::get_cost(spectral.get_cost())
                         .get_placement(placement)
                         .edge_is_constrained_map(constrained)
                         .filter(spectral.filter(SMS::Bounded_normal_change_filter<>()))
                         .visitor(spectral.visitor()));
  const auto relocated = SMS::spectral_relocation(mesh, spectral);
  const auto& P = relocated.restriction; // coarse values = P * fine values
  //! [swap]
  std::cout << "P is " << P.rows() << " x " << P.cols() << ", " << relocated.moved_vertices
            << " vertices were relocated\n";
  if(!spectral.explanation().empty())
    std::cout << spectral.explanation() << '\n';
  for(const std::string& warning : spectral.warnings())
    std::cout << warning << '\n';
}

template <class Mesh>
int run(const std::string& input, const std::string& output, const std::size_t N)
{
  Mesh mesh;
  if(!CGAL::IO::read_polygon_mesh(input, mesh))
    throw std::runtime_error("'" + input + "' is not a triangle mesh that can be read.");
  Mesh before = mesh;
  simplify_before(before, N);
  std::cout << "with Garland-Heckbert "
            << std::distance(vertices(before).begin(), vertices(before).end()) << " vertices\n";
  simplify(mesh, N);
  return CGAL::IO::write_polygon_mesh(output, mesh, CGAL::parameters::stream_precision(17))
             ? EXIT_SUCCESS
             : EXIT_FAILURE;
}

int main(int argc, char* argv[])
try {
  const std::string type = argc == 5 ? argv[4] : "surface_mesh";
  if(argc == 4 || argc == 5) {
    const std::size_t N = std::strtoul(argv[3], nullptr, 10);
    if(type == "surface_mesh")
      return run<Surface_mesh>(argv[1], argv[2], N);
    if(type == "polyhedron")
      return run<Polyhedron>(argv[1], argv[2], N);
#ifdef SPECTRAL_EXAMPLE_OPENMESH
    if(type == "openmesh")
      return run<OpenMesh::TriMesh_ArrayKernelT<>>(argv[1], argv[2], N);
#endif
  }
  std::cerr
      << "usage: edge_collapse_spectral_swap INPUT OUTPUT N [surface_mesh|polyhedron|openmesh]"
         ", INPUT being a triangle mesh, openmesh where it was built with OpenMesh\n";
  return EXIT_FAILURE;
} catch(const std::exception& error) {
  std::cerr << error.what() << '\n';
  return EXIT_FAILURE;
}
