// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_AROUND_COLLAPSES_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_AROUND_COLLAPSES_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Fine_vertex_slots.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/stages/run_explanations.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_result.h>
#include <CGAL/Surface_mesh_simplification/quadric_edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/spectral_relocation.h>

#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Spectral_geometry/Run_control.h>
#include <CGAL/Spectral_geometry/functional_map.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/Real_timer.h>

namespace CGAL::Surface_mesh_simplification::internal {

/// What the first stage has done; nothing where it was skipped.
struct Pre_simplification
{
  bool done = false;
  Collapse_log log;
  std::vector<Eigen::Index> slots;        ///< of `vertices(mesh)` afterwards, in that order
  std::vector<std::size_t> kept_vertices; ///< where those to be kept are in it
};

/// Throws for what would otherwise be found out after the mesh has changed.
inline void check_pre_simplification(const Spectral_edge_collapse_options& options,
                                     const std::size_t target)
{
  require(options.pre_simplify >= target, "Spectral_edge_collapse_options: pre_simplify is ",
          options.pre_simplify, ", less than the target of ", target,
          " vertices; use a number between the target and the size of the mesh.");
  require(options.signals.size() == 0 && !options.eigenpairs,
          "Spectral_edge_collapse_options: pre_simplify is set, but the signals or eigenpairs that "
          "are given "
          "belong to the mesh before it; use one of the two.");
  require(options.number_of_eigenvectors < Eigen::Index(options.pre_simplify),
          "Spectral_edge_collapse_options: pre_simplify is ", options.pre_simplify, ", but ",
          options.number_of_eigenvectors,
          " eigenvectors are asked for; use a number of vertices above that.");
  spectral_weights(options, options.number_of_eigenvectors);
  Spectral_geometry::internal::check_eigenpairs_options(options.eigenpairs_options,
                                                        options.number_of_eigenvectors);
}

/// `collapse_by_quadrics()` of n vertices to `target` as the options have it. Until the mesh
/// changes it can be cancelled, and nothing has happened then.
template <class TriangleMesh, class NamedParameters>
std::pair<Collapse_log, std::vector<Eigen::Index>>
collapse_by_quadrics(TriangleMesh& mesh, const std::size_t n, const std::size_t target,
                     const std::vector<char>& kept, const Spectral_edge_collapse_options& options,
                     const NamedParameters& np)
{
  const auto report = [&](const std::size_t left) {
    const double fraction = double(n - left) / double(n - target);
    Spectral_geometry::internal::report_to(
        options, {Spectral_geometry::Phase::pre_simplification, fraction, left});
  };
  return collapse_by_quadrics(mesh, target, kept,
                              options.preserve_border ||
                                  options.boundary ==
                                      Spectral_geometry::Boundary_condition::dirichlet,
                              options.binary, options.keep_free_of_self_intersections, report, np);
}

/// The first stage of `Spectral_edge_collapse_options::pre_simplify` on a mesh of n vertices.
template <class TriangleMesh, class NamedParameters>
Pre_simplification pre_simplify(TriangleMesh& mesh, const std::size_t n, const std::size_t target,
                                const Spectral_edge_collapse_options& options,
                                const NamedParameters& np)
{
  Pre_simplification result;
  if(options.pre_simplify == 0 || n <= options.pre_simplify)
    return result;
  require(parameters::is_default_parameter<NamedParameters, internal_np::filter_t>::value &&
              parameters::is_default_parameter<NamedParameters, internal_np::visitor_t>::value,
          "Spectral_edge_collapse_options: pre_simplify calls no filter and no visitor, but one is "
          "given; "
          "leave one of the two out, or simplify by edge_collapse() with a cheap cost and a "
          "Restriction_visitor first.");
  check_pre_simplification(options, target);
  const std::vector<char> kept = kept_vertex_flags(mesh, options.kept_vertices, np);
  std::tie(result.log, result.slots) =
      collapse_by_quadrics(mesh, n, options.pre_simplify, kept, options, np);
  for(std::size_t i = 0; i < result.slots.size(); ++i)
    if(!kept.empty() && kept[result.slots[i]])
      result.kept_vertices.push_back(i);
  result.done = true;
  return result;
}

/// What follows the collapses: `Spectral_edge_collapse_options::relocate`, and the error of what is
/// left. The log, and what is replayed from it, stay as they are: they end before.
template <class TriangleMesh, class Policies, class NamedParameters>
class Spectral_post_process
{
  using Result = Spectral_edge_collapse_result;
  using SpMat = Eigen::SparseMatrix<double>;

public:
  Spectral_post_process(TriangleMesh& mesh, const Policies& policies,
                        const Spectral_edge_collapse_options& options, const NamedParameters& np,
                        Result& result)
    : m_mesh(mesh)
    , m_state(policies.state())
    , m_options(options)
    , m_np(np)
    , m_result(result)
    , m_P(policies.restriction())
  {}

  void run(const Pre_simplification& first)
  {
    attempt("E of the result is not known: ", "", [&] { set_error(m_P); });
    // Before relocation, which raises E where the norms do not see it.
    warn_of_error(m_result.warnings, m_result.relative_error);
    Spectral_geometry::Relocation_result& relocation = m_result.relocation;
    if(m_options.relocate && !is_cancelled())
      attempt("The vertices were not relocated: ", ", which are as the collapses left them",
              [&] { relocate(); });
    m_result.seconds_relocation = relocation.seconds;
    if(m_result.relative_error > m_options.maximum_error && !is_cancelled())
      m_result.warnings.push_back(
          sentence("The collapses kept the error bound, but with relocation the relative error is ",
                   m_result.relative_error, "; set relocate to false to keep it."));
    // Carried signals keep P as it is; sampled ones bring their own, from the mesh of the
    // eigenpairs.
    if(relocation.resampled && first.done) {
      const Spectral_geometry::Merge_forest& forest = m_result.log.forest();
      m_result.restriction = relocation.restriction *
                             forest.restriction(first.slots, forest.number_of_slots() -
                                                                 Eigen::Index(first.slots.size()));
    } else if(relocation.resampled)
      m_result.restriction = relocation.restriction;
    relocation.restriction.resize(0, 0);
  }

private:
  bool is_cancelled() const { return m_result.stop_reason == Result::Stop_reason::cancelled; }

  // The collapses are done: whatever a stage after them throws is a warning, for the mesh and P not
  // to be lost. What a callback of the user's throws is the user's.
  template <class Stage>
  void attempt(const char* const consequence, const char* const cancelled, const Stage& stage)
  {
    try {
      stage();
    } catch(const Spectral_geometry::Cancelled&) {
      set_cancelled(m_result, cancelled);
    } catch(const std::exception& error) {
      if(m_thrown_by_callback)
        throw;
      m_result.warnings.push_back(consequence + std::string(error.what()));
    }
  }

  Spectral_geometry::Progress_callback reporting(const Spectral_geometry::Phase phase) const
  {
    return [this, phase](const double fraction) {
      m_thrown_by_callback = true;
      const bool goes_on = m_state.report(phase, fraction);
      m_thrown_by_callback = false;
      return goes_on;
    };
  }

  Spectral_geometry::Mesh_matrices coarse() const
  {
    return Spectral_geometry::mesh_matrices(m_mesh, m_np);
  }

  // With the coefficients that the collapses have merged.
  Spectral_geometry::Local_operator local_operator() const
  {
    return {m_options.mass, m_result.coefficients, m_options.boundary};
  }

  // The operator of the mesh as it is now.
  Spectral_geometry::Laplace_operator coarse_operator() const
  {
    const Spectral_geometry::Mesh_matrices mesh = coarse();
    return Spectral_geometry::laplace_operator(mesh.V, mesh.T, local_operator());
  }

  void relocate()
  {
    if(m_options.mass != Spectral_geometry::Mass::averaged)
      m_result.warnings.push_back(
          sentence("Relocation is made for the averaged mass: in the ",
                   Spectral_geometry::mass_name(m_options.mass),
                   " one it bends the shape to cancel the error of the elements."));
    Spectral_geometry::Relocation_options relocation = m_options.relocation;
    relocation.progress = reporting(Spectral_geometry::Phase::relocation);
    const auto points = m_state.vertex_point_map();
    std::vector<typename Policies::State::Point> before;
    for(const auto v : vertices(m_mesh))
      before.push_back(get(points, v));
    try {
      m_result.relocation =
          relocate_after_collapses(m_mesh, m_state, m_options, m_P, m_result.coefficients,
                                   relocation, m_state.fixed_vertices(), m_np);
      set_error(m_result.relocation.restriction);
    } catch(...) {
      m_result.relocation = Spectral_geometry::Relocation_result();
      std::size_t i = 0;
      for(const auto v : vertices(m_mesh))
        put(points, v, before[i++]);
      throw;
    }
  }

  // E of the input scaled to unit area, as the loop has it, but of all signals. There eigenvectors
  // are longer by the root of the area, a user's signals are as they were given, and Z is
  // multiplied by the area. The result is scaled, not the signals, which are large, nor the
  // positions: far from the origin that would cost digits.
  void set_error(const SpMat& P)
  {
    const double area = m_state.basis().area;
    const Run_signals signals(m_state.basis(), m_state.fine(), m_options);
    const auto [PF, PZ] = signals.restricted(P);
    m_result.E = area * (m_options.signals.size() != 0 ? 1. : area) *
                 Spectral_geometry::internal::residual_energy(coarse_operator(), PF, PZ);
    m_result.relative_error =
        m_state.basis().sum_of_squares > 0 ? std::sqrt(m_result.E / signals.sum_of_squares()) : 0.;
  }

  TriangleMesh& m_mesh;
  const typename Policies::State& m_state;
  const Spectral_edge_collapse_options& m_options;
  const NamedParameters& m_np;
  Result& m_result;
  SpMat m_P; // from the mesh of the eigenpairs to that of the collapses
  mutable bool m_thrown_by_callback = false;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_AROUND_COLLAPSES_H
