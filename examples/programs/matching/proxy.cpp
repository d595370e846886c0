// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "proxy.h"

#include "../compare/heaviest_vertices.h"
#include "../simplification.h"

#include <CGAL/Real_timer.h>
#include <CGAL/Spectral_geometry/fitted_operators.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Restriction_visitor.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>

namespace SMS = CGAL::Surface_mesh_simplification;
namespace SG = CGAL::Spectral_geometry;

namespace {

Eigen::SparseMatrix<double> picking(const std::vector<Eigen::Index>& representative, Eigen::Index n)
{
  std::vector<Eigen::Triplet<double>> ones;
  for(std::size_t i = 0; i < representative.size(); ++i)
    ones.emplace_back(static_cast<int>(i), static_cast<int>(representative[i]), 1.);
  Eigen::SparseMatrix<double> P(static_cast<Eigen::Index>(representative.size()), n);
  P.setFromTriplets(ones.begin(), ones.end());
  return P;
}

// In the spectral metric, with the eigenpairs that the fine mesh has anyhow.
Eigen::SparseMatrix<double> simplify_spectrally(Mesh& mesh, const Shape& fine, std::size_t vertices,
                                                SMS::Spectral_edge_collapse_options options,
                                                const Keep_going& keep_going, Proxy& proxy)
{
  options.binary = true; // the matches are vertices of the fine mesh
  options.relocate = false;
  SG::Eigenpairs pairs = fine.spectral.pairs; // at the scale of the mesh
  pairs.values /= fine.area;
  pairs.vectors /= std::sqrt(fine.area);
  options.eigenpairs = std::make_shared<SG::Eigenpairs>(std::move(pairs));
  options.progress = [&](const SMS::Spectral_progress&) { return keep_going(); };
  const auto result = simplify_mesh(mesh, vertices, options);
  if(!result.explanation.empty() && keep_going())
    throw std::runtime_error(result.explanation);
  proxy.vertex_map = result.vertex_map;
  return result.restriction;
}

Eigen::SparseMatrix<double> simplify_by_quadrics(Mesh& mesh, std::size_t vertices, Proxy& proxy)
{
  const SMS::Restriction_visitor<Mesh> visitor(mesh);
  SMS::GarlandHeckbert_plane_policies<Mesh, Kernel> policies(mesh);
  SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(vertices, mesh),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .visitor(visitor));
  if(mesh.number_of_vertices() != vertices)
    throw std::runtime_error("Garland-Heckbert ran out of edges at " +
                             std::to_string(mesh.number_of_vertices()) + " vertices instead of " +
                             std::to_string(vertices) + ".");
  proxy.vertex_map = visitor.vertex_map();
  return visitor.restriction();
}

} // namespace

const char* proxy_name(Proxy_kind kind)
{
  return kind == Proxy_kind::spectral           ? "spectral"
         : kind == Proxy_kind::garland_heckbert ? "garland_heckbert"
                                                : "none";
}

Mesh mesh_of(const SG::Mesh_matrices& matrices)
{
  Mesh mesh;
  for(Eigen::Index v = 0; v < matrices.V.rows(); ++v)
    mesh.add_vertex(Kernel::Point_3(matrices.V(v, 0), matrices.V(v, 1), matrices.V(v, 2)));
  const auto vertex = [](int v) { return Mesh::Vertex_index(static_cast<Mesh::size_type>(v)); };
  for(Eigen::Index t = 0; t < matrices.T.rows(); ++t)
    mesh.add_face(vertex(matrices.T(t, 0)), vertex(matrices.T(t, 1)), vertex(matrices.T(t, 2)));
  return mesh;
}

Reduced_mesh reduced_by_quadrics(Mesh mesh, const std::size_t vertices,
                                 const std::function<bool()>& keep_going)
{
  const auto reduction = simplify_mesh_by_quadrics(mesh, vertices, [&](double) { return keep_going(); });
  Reduced_mesh result;
  result.vertex_map.assign(reduction.vertex_map.begin(), reduction.vertex_map.end());
  result.mesh =
      mesh_of(SG::mesh_matrices(mesh)); // without what was removed, in the order of the vertices left
  return result;
}

Shape make_shape(SG::Mesh_matrices matrices, Eigen::Index modes, SG::Mass mass, const Keep_going& keep_going,
                 const std::function<void(SG::Laplace_operator&)>& fit)
{
  Shape shape;
  SG::Laplace_operator op = SG::laplace_operator(matrices.V, matrices.T, mass);
  shape.area = op.mass.sum();
  op.B /= shape.area;
  op.mass /= shape.area;
  if(fit)
    fit(op);
  SG::Eigenpairs_options options;
  options.tolerance = 1e-6; // far below the errors of a match
  options.progress = [&](double) { return keep_going(); };
  shape.spectral.pairs = SG::eigenpairs(op, (std::min)(modes, op.L.rows()), options);
  shape.spectral.op = std::move(op);
  shape.spectral.T = matrices.T;
  shape.matrices = std::move(matrices);
  return shape;
}

Proxy make_proxy(const Mesh& mesh, const Shape& fine, Proxy_kind kind, std::size_t vertices,
                 Eigen::Index modes, const SMS::Spectral_edge_collapse_options& options,
                 Proxy_operators operators, const Keep_going& keep_going)
{
  Proxy proxy;
  CGAL::Real_timer timer;
  timer.start();
  Mesh coarse = mesh;
  Eigen::SparseMatrix<double> P;
  if(kind == Proxy_kind::spectral)
    P = simplify_spectrally(coarse, fine, vertices, options, keep_going, proxy);
  else
    P = simplify_by_quadrics(coarse, vertices, proxy);
  proxy.representative = heaviest_vertices(P);
  proxy.restriction = picking(proxy.representative, P.cols());
  SG::Mesh_matrices matrices = SG::mesh_matrices(coarse); // garbage is skipped, in the order of P
  proxy.seconds_simplification = timer.time();
  timer.reset();
  std::function<void(SG::Laplace_operator&)> fit;
  if(operators == Proxy_operators::fitted)
    fit = [&](SG::Laplace_operator& op) {
      SG::Operator_fit_options fit_options = SG::Operator_fit_options::for_mass(op.theta);
      fit_options.progress = [&](double) { return keep_going(); };
      op = SG::fit_operators(op, proxy.restriction, fine.spectral.op, fine.spectral.pairs, fit_options).op;
    };
  proxy.shape = make_shape(std::move(matrices), modes, options.mass, keep_going, fit);
  proxy.seconds_eigenpairs = timer.time();
  return proxy;
}
