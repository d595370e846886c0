// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_GEODESIC_ERROR_H
#define SPECTRAL_EXAMPLES_MATCHING_GEODESIC_ERROR_H

#include "../io/mesh_io.h"

#ifndef CGAL_EIGEN3_ENABLED
#define CGAL_EIGEN3_ENABLED 1 // the heat method solves with Eigen, which this package needs anyhow
#endif
#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <vector>

// How far a map from X to Y leads from the true one: geodesic distances on Y in square roots of its
// area, at the vertices of X that were drawn. A vertex whose true one is negative has none.
class Geodesic_error
{
public:
  Geodesic_error(const Mesh& Y, double area, std::vector<Eigen::Index> truth, std::size_t samples)
    : m_Y(Y)
    , m_length(std::sqrt(area))
    , m_truth(std::move(truth))
  {
    std::mt19937 random(1);
    std::vector<std::size_t> all;
    for(std::size_t i = 0; i < m_truth.size(); ++i)
      if(m_truth[i] >= 0)
        all.push_back(i);
    for(std::size_t i = 0; i < all.size() && i < samples; ++i) {
      std::swap(all[i], all[i + random() % (all.size() - i)]);
      m_samples.push_back(all[i]);
    }
  }

  // One column of errors for each map, ascending. Solves for each sample once, by CGAL's heat
  // method.
  std::vector<std::vector<double>>
  measure(const std::vector<const std::vector<Eigen::Index>*>& maps,
          const std::function<void(double)>& progress)
  {
    CGAL::Heat_method_3::Surface_mesh_geodesic_distances_3<Mesh,
                                                           CGAL::Heat_method_3::Intrinsic_Delaunay>
        heat(m_Y);
    auto distance = m_Y.add_property_map<Mesh::Vertex_index, double>("v:distance", 0.).first;
    std::vector<std::vector<double>> errors(maps.size());
    for(std::size_t s = 0; s < m_samples.size(); ++s) {
      progress(static_cast<double>(s) / static_cast<double>(m_samples.size()));
      const Mesh::Vertex_index source = vertex(m_truth[m_samples[s]]);
      heat.clear_sources();
      heat.add_source(source);
      heat.estimate_geodesic_distances(distance);
      for(std::size_t m = 0; m < maps.size(); ++m) {
        const Mesh::Vertex_index found = vertex((*maps[m])[m_samples[s]]);
        // Next to the source the heat method is not better than an edge.
        errors[m].push_back(found == source ? 0. : distance[found] / m_length);
      }
    }
    m_Y.remove_property_map(distance);
    for(std::vector<double>& column : errors)
      std::sort(column.begin(), column.end());
    return errors;
  }

private:
  static Mesh::Vertex_index vertex(Eigen::Index i)
  {
    return Mesh::Vertex_index(static_cast<Mesh::size_type>(i));
  }

  Mesh m_Y;
  double m_length;
  std::vector<Eigen::Index> m_truth;
  std::vector<std::size_t> m_samples;
};

#endif // SPECTRAL_EXAMPLES_MATCHING_GEODESIC_ERROR_H
