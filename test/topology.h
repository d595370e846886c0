// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_TOPOLOGY_H
#define SPECTRAL_TEST_TOPOLOGY_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

#include <CGAL/boost/graph/helpers.h>

#include <algorithm>
#include <cstddef>
#include <set>

namespace spectral_test {

// What collapses leave as it is.
struct Topology
{
  std::size_t components = 0, border_cycles = 0;
  long euler = 0; // vertices - edges + faces

  bool operator==(const Topology& t) const
  {
    return components == t.components && border_cycles == t.border_cycles && euler == t.euler;
  }
};

template <class Mesh>
Topology topology(const Mesh& mesh)
{
  Topology result;
  const CGAL::Spectral_geometry::Mesh_matrices m = CGAL::Spectral_geometry::mesh_matrices(mesh);
  const auto component = CGAL::Spectral_geometry::internal::connected_components(m.V.rows(), m.T);
  result.components = std::size_t(*std::max_element(component.begin(), component.end()) + 1);
  long number_of_halfedges = 0;
  std::set<typename boost::graph_traits<Mesh>::halfedge_descriptor> seen;
  for(const auto h : halfedges(mesh)) {
    ++number_of_halfedges;
    if(!CGAL::is_border(h, mesh) || !seen.insert(h).second)
      continue;
    ++result.border_cycles;
    for(auto i = next(h, mesh); i != h; i = next(i, mesh))
      seen.insert(i);
  }
  result.euler = long(m.V.rows()) - number_of_halfedges / 2 + long(m.T.rows());
  return result;
}

} // namespace spectral_test

#endif // SPECTRAL_TEST_TOPOLOGY_H
