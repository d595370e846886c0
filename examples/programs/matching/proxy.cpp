// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "proxy.h"

#include "../compare/collapse.h"
#include "../compare/heaviest_vertices.h"
#include "../compare/lies_on.h"
#include "../simplification.h"

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_toolbox/fitted_operators.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_probabilistic_plane_policies.h>

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

// A coarse mesh, and how it stands for the fine one.
struct Simplification
{
  SG::Mesh_matrices matrices;
  Eigen::SparseMatrix<double> restriction; // rows as in the matrices
  std::vector<std::size_t> vertex_map;
};

// In the spectral metric, with the eigenpairs that the fine mesh has anyhow.
Simplification simplified_spectrally(Mesh mesh, const Shape& fine, std::size_t vertices,
                                     SMS::Spectral_edge_collapse_options options,
                                     const Keep_going& keep_going)
{
  options.binary = true; // the matches are vertices of the fine mesh
  options.relocate = false;
  SG::Eigenpairs pairs = fine.spectral.pairs; // at the scale of the mesh
  pairs.values /= fine.area;
  pairs.vectors /= std::sqrt(fine.area);
  options.eigenpairs = std::make_shared<SG::Eigenpairs>(std::move(pairs));
  options.progress = [&](const SG::Progress&) { return keep_going(); };
  const auto result = simplify_mesh(mesh, vertices, options);
  if(!result.explanation.empty() && keep_going())
    throw std::runtime_error(result.explanation);
  return {SG::mesh_matrices(mesh), result.restriction, result.vertex_map};
}

Simplification simplified_by_quadrics(const Mesh& mesh, Proxy_kind kind, std::size_t vertices)
{
  using Plane = SMS::GarlandHeckbert_plane_policies<Mesh, Kernel>;
  using Probabilistic_plane = SMS::GarlandHeckbert_probabilistic_plane_policies<Mesh, Kernel>;
  Coarse_mesh coarse =
      kind == Proxy_kind::garland_heckbert
          ? collapse_by_quadrics<Plane>(mesh, vertices)
          : collapse_by_probabilistic_quadrics<Probabilistic_plane>(mesh, vertices);
  if(coarse.mesh.number_of_vertices() != vertices)
    throw std::runtime_error(std::string(proxy_name(kind)) + " ran out of edges at " +
                             std::to_string(coarse.mesh.number_of_vertices()) +
                             " vertices instead of " + std::to_string(vertices) + ".");
  return {SG::mesh_matrices(coarse.mesh), std::move(*coarse.carried), std::move(coarse.vertex_map)};
}

Simplification of_closest_points(const Mesh& coarse, const Shape& fine)
{
  Simplification result;
  result.matrices = SG::mesh_matrices(coarse);
  result.restriction = SG::closest_point_restriction(result.matrices, fine.matrices);
  if(const std::string reason = not_on(result.matrices, fine.matrices); !reason.empty())
    throw std::runtime_error(reason + ".");
  for(const Eigen::Index v : heaviest_vertices(
          SG::closest_point_prolongation(fine.matrices, result.matrices, result.restriction)))
    result.vertex_map.push_back(static_cast<std::size_t>(v));
  return result;
}

Proxy proxy_of(Simplification coarse, const Shape& fine, Eigen::Index modes, SG::Mass mass,
               Proxy_operators operators, const Keep_going& keep_going)
{
  Proxy proxy;
  proxy.representative = heaviest_vertices(coarse.restriction);
  proxy.restriction = picking(proxy.representative, coarse.restriction.cols());
  proxy.vertex_map = std::move(coarse.vertex_map);
  std::function<void(SG::Laplace_operator&)> fit;
  if(operators == Proxy_operators::fitted)
    fit = [&](SG::Laplace_operator& op) {
      SG::Operator_fit_options fit_options = SG::Operator_fit_options::for_mass(op.theta);
      fit_options.progress = [&](double) { return keep_going(); };
      op = SG::fit_operators(op, proxy.restriction, fine.spectral.op, fine.spectral.pairs,
                             fit_options)
               .op;
    };
  proxy.shape = make_shape(std::move(coarse.matrices), modes, mass, keep_going, fit);
  return proxy;
}

} // namespace

const char* proxy_name(Proxy_kind kind)
{
  return kind == Proxy_kind::spectral           ? "spectral"
         : kind == Proxy_kind::garland_heckbert ? "garland_heckbert"
         : kind == Proxy_kind::none             ? "none"
                                                : "garland_heckbert_probabilistic";
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
  const auto reduction =
      simplify_mesh_by_quadrics(mesh, vertices, [&](double) { return keep_going(); });
  Reduced_mesh result;
  result.vertex_map.assign(reduction.vertex_map.begin(), reduction.vertex_map.end());
  result.mesh = mesh_of(
      SG::mesh_matrices(mesh)); // without what was removed, in the order of the vertices left
  return result;
}

Shape make_shape(SG::Mesh_matrices matrices, Eigen::Index modes, SG::Mass mass,
                 const Keep_going& keep_going,
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
  Simplification coarse = kind == Proxy_kind::spectral
                              ? simplified_spectrally(mesh, fine, vertices, options, keep_going)
                              : simplified_by_quadrics(mesh, kind, vertices);
  return proxy_of(std::move(coarse), fine, modes, options.mass, operators, keep_going);
}

Proxy make_foreign_proxy(const Mesh& coarse, const Shape& fine, Eigen::Index modes, SG::Mass mass,
                         Proxy_operators operators, const Keep_going& keep_going)
{
  return proxy_of(of_closest_points(coarse, fine), fine, modes, mass, operators, keep_going);
}
