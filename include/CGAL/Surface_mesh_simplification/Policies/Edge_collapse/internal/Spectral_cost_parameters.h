// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COST_PARAMETERS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COST_PARAMETERS_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_fields.h>

#include <cstddef>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// The part of `Spectral_options` that the cost of a candidate depends on.
struct Spectral_cost_parameters
{
  Spectral_placement_strategy placement = Spectral_placement_strategy::on_edge;
  bool binary = false;
  bool preserve_border = false;
  bool single_precision_points = false; ///< the mesh stores its points as float
  bool keep_free_of_self_intersections = false;
  bool exact_costs = false;  ///< see `Spectral_options::exact_costs`
  double shape = 0;          ///< see `Spectral_options::shape`
  double largest_loss = 10;  ///< see `Spectral_options::largest_loss`
  double sum_of_squares = 1; ///< || Z ||_B^2, E when everything is lost
  int threads = 1;
  std::size_t largest_degree_of_others = Spectral_fields().largest_degree_of_others;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_COST_PARAMETERS_H
