// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_COLLAPSE_HELPERS_H
#define SPECTRAL_TEST_COLLAPSE_HELPERS_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>

#include "spectral_test_helpers.h"

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

// Runs of edge_collapse() on real mesh types, and the whole of what must hold after one.
namespace spectral_test {

namespace SMS = CGAL::Surface_mesh_simplification;

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

inline Mesh make_mesh(const shapes::Matrices& from)
{
  Mesh mesh;
  shapes::make_mesh(mesh, from);
  return mesh;
}

// The paper's setting, in which P carries positions and E alone is minimised: what most tests look
// at.
inline SMS::Spectral_edge_collapse_options options_with(const Eigen::Index K)
{
  SMS::Spectral_edge_collapse_options options = SMS::Spectral_edge_collapse_options::paper();
  options.number_of_eigenvectors = K;
  return options;
}

template <class Mesh, class Policies, class Visitor = SMS::internal::Dummy_visitor>
int collapse(Mesh& mesh, const Policies& policies, const std::size_t N, const Visitor& visitor = {})
{
  return SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate<Mesh>(N, mesh),
                            CGAL::parameters::get_cost(policies.get_cost())
                                .get_placement(policies.get_placement())
                                .visitor(policies.visitor(visitor))
                                .vertex_point_map(policies.state().vertex_point_map())
                                .geom_traits(policies.state().geom_traits()));
}

template <class Mesh>
std::size_t count_vertices(const Mesh& mesh)
{
  std::size_t n = 0;
  for(const auto v : vertices(mesh)) {
    CGAL_USE(v);
    ++n;
  }
  return n;
}

template <class Mesh>
Eigen::MatrixXd positions(const Mesh& mesh)
{
  return SG::mesh_matrices(mesh).V;
}

// The input of a run, kept to judge its result.
struct Input
{
  shapes::Matrices mesh;
  Basis basis;
};

inline Input eigen_input(const shapes::Matrices& mesh, const SG::Mass mass,
                         const SG::Eigenpairs& pairs)
{
  return {mesh, basis_of_pairs(SG::laplace_operator(mesh.V, mesh.T, mass), pairs, mass)};
}

// The columns of F that the metric sees where it mixes none: not those of weight 0, nor constants
// of components. Where cotangents of 0 make more functions of eigenvalue 0, it sees all of them.
inline Eigen::MatrixXd seen_signals(const Input& input)
{
  const Basis& basis = input.basis;
  const Eigen::Index n = input.mesh.V.rows();
  const std::vector<Eigen::Index> component = SG::internal::connected_components(n, input.mesh.T);
  const Eigen::Index components = 1 + *std::max_element(component.begin(), component.end());
  const bool constants = (basis.lambda.array() <= 1e-6).count() <= components;
  Eigen::MatrixXd seen(n, 0);
  for(Eigen::Index k = 0; k < basis.F.cols(); ++k)
    if(!basis.F.col(k).isZero(0) &&
       !(constants && basis.lambda.size() != 0 && basis.lambda[k] <= 1e-6)) {
      seen.conservativeResize(Eigen::NoChange, seen.cols() + 1);
      seen.rightCols(1) = basis.F.col(k);
    }
  return seen;
}

struct Check
{
  bool binary = false;
  bool positions = true; // P V_fine = V_coarse: midpoint and on_edge without a wrapper
  double tolerance = 1e-8;
};

// What is wrong with a mesh, its P and the E that was tracked of all signals; empty if nothing is.
template <class Mesh, class Policies>
std::string fault_of_run(const Mesh& mesh, const Policies& policies, const Input& input,
                         const Check check = {})
{
  const auto vpm = CGAL::parameters::vertex_point_map(policies.state().vertex_point_map());
  if(!CGAL::is_valid_polygon_mesh(mesh) || !CGAL::is_triangle_mesh(mesh))
    return "the mesh is not a valid triangle mesh";
  const shapes::Matrices coarse = SG::mesh_matrices(mesh, vpm);
  const Eigen::SparseMatrix<double> P = policies.restriction();
  if(P.rows() != coarse.V.rows() || P.cols() != input.mesh.V.rows())
    return "P is " + std::to_string(P.rows()) + " x " + std::to_string(P.cols());
  const std::string fault = fault_of_restriction(P, policies.vertex_map(), check.binary);
  if(!fault.empty())
    return fault;
  const double off = position_error(P, input.mesh.V, coarse.V);
  if(check.positions && !(off < (check.binary ? 10. : 1e-3 * check.tolerance)))
    return "P times the fine positions is off by " + std::to_string(off);

  const Eigen::MatrixXd PF = P * seen_signals(input);
  const SMS::internal::Spectral_fields& fields = policies.state().core().fields();
  if(fields.signals.size() != PF.cols())
    return "the metric sees " + std::to_string(fields.signals.size()) + " signals, not " +
           std::to_string(PF.cols());
  const std::vector<Eigen::Index> slots = policies.state().current_slots();
  double worst = 0;
  for(std::size_t i = 0; i < slots.size() && PF.cols() != 0; ++i)
    worst = (std::max)(
        worst, (PF.row(Eigen::Index(i)) - tracked_signals(fields, slots[i])).cwiseAbs().maxCoeff());
  if(!(worst < 1e-10 * input.basis.F.cwiseAbs().maxCoeff()))
    return "P F is off by " + std::to_string(worst);

  const double E = energy(coarse, input.basis, P);
  if(!(relative_difference(E, policies.error()) < check.tolerance))
    return "E is " + std::to_string(E) + ", tracked as " + std::to_string(policies.error());
  return "";
}

inline std::vector<std::size_t> every(const std::size_t step, const Eigen::Index n,
                                      const std::size_t first = 0)
{
  std::vector<std::size_t> result;
  for(std::size_t i = first; i < std::size_t(n); i += step)
    result.push_back(i);
  return result;
}

// How many of the vertices are where they were, alone in their row of P.
inline std::size_t survivors(const std::vector<std::size_t>& kept, const shapes::Matrices& input,
                             const Mesh& mesh,
                             const Eigen::SparseMatrix<double, Eigen::RowMajor>& P,
                             const std::vector<std::size_t>& map)
{
  const Eigen::MatrixXd V = positions(mesh);
  std::set<std::size_t> rows;
  for(const std::size_t i : kept) {
    const Eigen::Index row = Eigen::Index(map[i]);
    if(V.row(row) == input.V.row(Eigen::Index(i)) && P.row(row).nonZeros() == 1 &&
       P.coeff(row, Eigen::Index(i)) == 1)
      rows.insert(map[i]);
  }
  return rows.size();
}

inline std::string fault_of_result(const Mesh& mesh, const Eigen::SparseMatrix<double>& P,
                                   const std::vector<std::size_t>& map,
                                   const shapes::Matrices& input)
{
  if(!CGAL::is_valid_polygon_mesh(mesh))
    return "the mesh is not valid";
  if(P.rows() != Eigen::Index(count_vertices(mesh)) || P.cols() != input.V.rows())
    return "the size of P";
  return fault_of_restriction(P, map);
}

// Whether vertices, faces and coordinates are the same in the same order, garbage included.
inline bool identical(const Mesh& a, const Mesh& b)
{
  if(a.num_vertices() != b.num_vertices() || a.num_halfedges() != b.num_halfedges() ||
     a.num_faces() != b.num_faces())
    return false;
  for(std::size_t i = 0; i < a.num_vertices(); ++i) {
    const Mesh::Vertex_index v(static_cast<Mesh::size_type>(i));
    if(a.is_removed(v) != b.is_removed(v) ||
       (!a.is_removed(v) && (a.point(v) != b.point(v) || a.halfedge(v) != b.halfedge(v))))
      return false;
  }
  for(std::size_t i = 0; i < a.num_halfedges(); ++i) {
    const Mesh::Halfedge_index h(static_cast<Mesh::size_type>(i));
    if(a.is_removed(h) != b.is_removed(h) ||
       (!a.is_removed(h) &&
        (a.target(h) != b.target(h) || a.next(h) != b.next(h) || a.face(h) != b.face(h))))
      return false;
  }
  return std::equal(a.faces().begin(), a.faces().end(), b.faces().begin());
}

using Constraints = Mesh::Property_map<Mesh::Edge_index, bool>;

// Constrains every so many edges of a mesh, or with 0 none.
inline Constraints constrain_every(const int step, Mesh& mesh)
{
  const Constraints result =
      mesh.add_property_map<Mesh::Edge_index, bool>("e:constrained", false).first;
  for(const auto e : edges(mesh))
    result[e] = step != 0 && e.idx() % Mesh::size_type(step) == 0;
  return result;
}

inline std::set<Kernel::Point_3> ends(const Mesh& mesh, const Constraints& constraints)
{
  std::set<Kernel::Point_3> result;
  for(const auto e : edges(mesh))
    if(constraints[e])
      result.insert({mesh.point(source(e, mesh)), mesh.point(target(e, mesh))});
  return result;
}

} // namespace spectral_test

#endif // SPECTRAL_TEST_COLLAPSE_HELPERS_H
