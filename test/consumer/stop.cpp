// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <iostream>

// The smallest thing that the package has: says whether a mesh of three vertices is small enough.
int main()
{
  using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;
  namespace SMS = CGAL::Surface_mesh_simplification;
  Mesh mesh;
  for(int i = 0; i < 3; ++i)
    mesh.add_vertex({double(i), 0, 0});
  const bool stops = SMS::Vertex_count_stop_predicate<Mesh>(3, mesh)(0., 0, 3, 3);
  const bool goes_on = !SMS::Vertex_count_stop_predicate<Mesh>(2, mesh)(0., 0, 3, 3);
  std::cout << "three vertices are " << (stops && goes_on ? "three" : "not three") << '\n';
  return stops && goes_on ? 0 : 1;
}
