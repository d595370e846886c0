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
  std::vector<std::size_t> kept_vertices; ///< the indices of kept vertices in `slots`
};

/// The first stage of `Spectral_edge_collapse_options::pre_simplify` on a mesh of n vertices.
/// Refuses what would otherwise be found out after the mesh has changed.
template <class TriangleMesh, class NamedParameters>
Pre_simplification pre_simplify(TriangleMesh& mesh, const std::size_t n, const std::size_t target,
                                const Spectral_edge_collapse_options& options,
                                const NamedParameters& np)
{
  Pre_simplification result;
  if(options.pre_simplify == 0 || n <= options.pre_simplify)
    return result;
  require(!is_given<NamedParameters, internal_np::filter_t, internal_np::visitor_t>,
          "Spectral_edge_collapse_options: pre_simplify calls no filter and no visitor, but one is "
          "given; leave one of the two out, or simplify by edge_collapse() with a cheap cost and a "
          "Restriction_visitor first.");
  require(options.pre_simplify >= target, "Spectral_edge_collapse_options: pre_simplify is ",
          options.pre_simplify, ", less than the target of ", target,
          " vertices; use a number between the target and the size of the mesh.");
  require(options.signals.size() == 0 && !options.eigenpairs,
          "Spectral_edge_collapse_options: pre_simplify is set, but the signals or eigenpairs that "
          "are given belong to the mesh before it; use one of the two.");
  require(options.number_of_eigenvectors < Eigen::Index(options.pre_simplify),
          "Spectral_edge_collapse_options: pre_simplify is ", options.pre_simplify, ", but ",
          options.number_of_eigenvectors,
          " eigenvectors are asked for; use a number of vertices above that.");
  spectral_weights(options, options.number_of_eigenvectors);
  Spectral_geometry::internal::check_eigenpairs_options(options.eigenpairs_options,
                                                        options.number_of_eigenvectors);
  const std::vector<char> kept = kept_vertex_flags(mesh, options.kept_vertices, np);
  std::tie(result.log, result.slots) =
      collapse_by_quadrics(mesh, options.pre_simplify, kept, options, np);
  for(std::size_t i = 0; i < result.slots.size(); ++i)
    if(!kept.empty() && kept[result.slots[i]])
      result.kept_vertices.push_back(i);
  result.done = true;
  return result;
}

/// The steps after the collapses: `Spectral_edge_collapse_options::relocate`, and the error of the
/// result. The log, and what is replayed from it, end before these steps.
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

  // The collapses are done: an exception of a later stage becomes a warning, so that the mesh and P
  // are not lost. An exception of the user's callback is passed on.
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

  void relocate()
  {
    if(m_options.mass != Spectral_geometry::Mass::averaged)
      m_result.warnings.push_back(
          sentence("Relocation is made for the averaged mass: in the ",
                   Spectral_geometry::mass_name(m_options.mass),
                   " one it bends the shape to cancel the error of the elements."));
    Spectral_geometry::Relocation_options relocation = m_options.relocation;
    relocation.progress = [this](const double fraction) {
      m_thrown_by_callback = true;
      const bool goes_on = m_state.report(Spectral_geometry::Phase::relocation, fraction);
      m_thrown_by_callback = false;
      return goes_on;
    };
    const auto points = m_state.vertex_point_map();
    std::vector<typename Policies::State::Point> before;
    for(const auto v : vertices(m_mesh))
      before.push_back(get(points, v));
    try {
      m_result.relocation =
          relocate_after_collapses(m_mesh, m_state, m_options, m_P, relocation, m_np);
      set_error(m_result.relocation.restriction);
    } catch(...) {
      m_result.relocation = Spectral_geometry::Relocation_result();
      std::size_t i = 0;
      for(const auto v : vertices(m_mesh))
        put(points, v, before[i++]);
      throw;
    }
  }

  // E for the input scaled to unit area, as in the loop, but of all signals. In the loop
  // eigenvectors are longer by the root of the area, a user's signals are unchanged, and Z is
  // multiplied by the area. Here the result is scaled: the signals are large, and positions far
  // from the origin would lose digits.
  void set_error(const SpMat& P)
  {
    const double area = m_state.basis().area;
    const Run_signals signals(m_state.basis(), m_state.fine(), m_options);
    const auto [PF, PZ] = signals.restricted(P);
    const Spectral_geometry::Mesh_matrices coarse = Spectral_geometry::mesh_matrices(m_mesh, m_np);
    const Spectral_geometry::Laplace_operator op = Spectral_geometry::laplace_operator(
        coarse.V, coarse.T, local_operator(m_options).restricted(m_P));
    m_result.E = area * (m_options.signals.size() != 0 ? 1. : area) *
                 Spectral_geometry::internal::residual_energy(op, PF, PZ);
    m_result.relative_error =
        m_state.basis().sum_of_squares > 0 ? std::sqrt(m_result.E / signals.sum_of_squares()) : 0.;
  }

  TriangleMesh& m_mesh;
  const typename Policies::State& m_state;
  const Spectral_edge_collapse_options& m_options;
  const NamedParameters& m_np;
  Result& m_result;
  SpMat m_P; // from the mesh of the eigenpairs to that of the collapses
  bool m_thrown_by_callback = false;
};

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_AROUND_COLLAPSES_H
