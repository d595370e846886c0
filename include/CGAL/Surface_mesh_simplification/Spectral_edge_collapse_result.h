// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_COLLAPSE_RESULT_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_COLLAPSE_RESULT_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>

#include <CGAL/Spectral_geometry/Relocation_options.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/local_operator.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/// What `spectral_edge_collapse()` returns.
struct Spectral_edge_collapse_result
{
  /// Why the loop ended.
  enum class Stop_reason {
    target_reached,  ///< the mesh has the number of vertices that was asked for
    queue_exhausted, ///< every edge that is left was refused; see `explanation`
    cancelled,       ///< by the progress callback or `Spectral_options::cancel`
    /// one more collapse would have exceeded `Spectral_edge_collapse_options::maximum_error`
    error_reached
  };

  std::size_t input_vertices = 0;  ///< number of vertices before
  std::size_t output_vertices = 0; ///< and after
  std::size_t collapses = 0; ///< merges of two vertices, those of edges without length included
  Stop_reason stop_reason = Stop_reason::target_reached; ///< why it stopped
  /// one sentence if the run ended neither at the target nor at the error bound, else empty
  std::string explanation;
  std::vector<std::string> warnings; ///< one sentence each: what was done, but is not advised
  Spectral_refusals refusals;        ///< candidates that were refused, by cause
  std::size_t evaluations = 0;       ///< how often an edge was costed

  double seconds_pre_simplification = 0; ///< wall seconds of the collapses of quadrics
  double seconds_eigenpairs = 0;         ///< reading the mesh and finding the basis
  double seconds_first_costs = 0;        ///< evaluating every edge once
  double seconds_collapse = 0;           ///< first costs and the collapse loop
  double seconds_relocation = 0; ///< wall seconds of `Spectral_edge_collapse_options::relocate`
  double seconds_total = 0;      ///< the whole call

  /// number of signals (of positive weight) that steered the collapses, directly or in mixtures
  std::size_t signals = 0;
  /// Eq. 2 of all signals but constants, with their weights, for the input scaled to unit area
  double E = 0;
  double relative_error = 0; ///< see `Spectral_policies::relative_error()`

  /// what `Spectral_edge_collapse_options::relocate` did. Its own `restriction` is empty: use the
  /// one below
  Spectral_geometry::Relocation_result relocation;

  /// P, coarse x fine: rows in the order of `vertices(mesh)` when the function returned, columns in
  /// the order of the input. `Surface_mesh::collect_garbage()` changes the order of
  /// `vertices(mesh)`, and the rows no longer fit: write or copy the mesh without calling it, or
  /// use `Spectral_policies`, whose `restriction()` follows the mesh as it is.
  Eigen::SparseMatrix<double> restriction;
  std::vector<std::size_t> vertex_map; ///< for each vertex of the input the row of P it ended in
  /// coefficients of the coarse operator: `Spectral_options::coefficients` merged by the collapses,
  /// means of what went into a vertex. Relocation and its P do not change them. Rows as in P; empty
  /// if the input has none
  Spectral_geometry::Operator_coefficients coefficients;
  /// every level of detail between the input and the result: P from it alone, meshes by
  /// `Collapse_replay`
  Collapse_log log;
  /// number of collapses by quadrics alone, see `Spectral_edge_collapse_options::pre_simplify` and
  /// `quadrics_above`
  std::size_t quadric_collapses = 0;
  /// number of vertices after `Spectral_edge_collapse_options::pre_simplify`; that of the input
  /// without
  std::size_t pre_simplified_vertices = 0;
  /// eigenpairs of the input (or of the pre-simplified mesh) at its own scale, to simplify it
  /// again; null with signals of your own or filtered noise
  std::shared_ptr<const Spectral_geometry::Eigenpairs> eigenpairs;

  /// the reason in words
  const char* stop_reason_name() const
  {
    return stop_reason == Stop_reason::target_reached    ? "target reached"
           : stop_reason == Stop_reason::queue_exhausted ? "no collapsible edge left"
           : stop_reason == Stop_reason::error_reached   ? "error bound reached"
                                                         : "cancelled";
  }
};

/// @}

namespace internal {

/// Records that the run was cancelled; `rest` ends the sentence that says so.
inline void set_cancelled(Spectral_edge_collapse_result& result, const std::string& rest = "")
{
  result.stop_reason = Spectral_edge_collapse_result::Stop_reason::cancelled;
  result.explanation =
      sentence("The run was cancelled at ", result.output_vertices, " vertices", rest, ".");
}

} // namespace internal

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_EDGE_COLLAPSE_RESULT_H
