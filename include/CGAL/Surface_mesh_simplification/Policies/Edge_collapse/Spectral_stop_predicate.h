// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_STOP_PREDICATE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_STOP_PREDICATE_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_error_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * Ends a run at a number of vertices, at an error, or when the user cancels it, whichever comes
 * first, and calls `Spectral_options::progress` about a hundred times. `spectral_edge_collapse()`
 * uses it. In a run of `edge_collapse()`, collapses can be cancelled only here, where the mesh is
 * valid.
 *
 * \cgalModels{StopPredicate}
 *
 * It needs the visitor of the policies. The functions below refer to the last run that called it: a
 * second `edge_collapse()` with the same predicate begins anew.
 *
 * @tparam Policies a `Spectral_policies`; deduced
 * @tparam GetPlacement the placement that `edge_collapse()` gets; deduced
 */
template <class Policies, class GetPlacement = typename Policies::Get_placement>
class Spectral_stop_predicate
{
public:
  /// @param policies those of the run
  /// @param number_of_vertices the target, as that of `Vertex_count_stop_predicate`
  /// @param maximum_error as that of `Spectral_error_stop_predicate`; infinite: none
  Spectral_stop_predicate(const Policies& policies, const std::size_t number_of_vertices,
                          const double maximum_error = std::numeric_limits<double>::infinity())
    : Spectral_stop_predicate(policies, number_of_vertices, maximum_error, policies.get_placement())
  {}

  /// Takes a placement that wraps that of the policies, `Constrained_placement` for instance.
  Spectral_stop_predicate(const Policies& policies, const std::size_t number_of_vertices,
                          const double maximum_error, const GetPlacement& placement)
    : m_state(policies.shared_state())
    , m_target(number_of_vertices)
    , m_bound(maximum_error)
    , m_count_stop(number_of_vertices, m_state->mesh())
    , m_error_stop(policies, maximum_error, placement)
  {}

  /// whether to stop before the collapse of the selected candidate
  template <class Cost, class Profile>
  bool operator()(const Cost& cost, const Profile& profile, const std::size_t initial,
                  const std::size_t current) const
  {
    if(m_state->number_of_runs() != m_run)
      begin_run();
    m_reached = m_count_stop(cost, profile, initial, current);
    if(m_reached)
      return true;
    // A hundred reports in all: a callback may well draw something.
    m_fraction = (std::max)(m_fraction, fraction());
    if(m_fraction >= m_next_report) {
      m_next_report = m_fraction + 0.01;
      m_cancelled = !m_state->report(Spectral_geometry::Phase::collapses, m_fraction);
    }
    m_cancelled = m_cancelled || m_state->is_cancelled();
    if(!m_cancelled && std::isfinite(m_bound))
      m_error_reached = m_error_stop(cost, profile, initial, current);
    return m_cancelled || m_error_reached;
  }

  /// whether the number of vertices ended the run
  bool reached() const { return m_reached; }
  /// whether the error bound ended it
  bool error_reached() const { return m_error_reached; }
  /// whether the user cancelled it
  bool cancelled() const { return m_cancelled; }

private:
  void begin_run() const
  {
    m_run = m_state->number_of_runs();
    m_begin = m_state->number_of_vertices();
    m_next_report = m_fraction = 0;
    m_reached = m_error_reached = m_cancelled = false;
  }

  // Measures the way to the nearer end. The error may fall again: the caller keeps the largest.
  double fraction() const
  {
    const std::size_t n = m_state->number_of_vertices();
    const double by_count =
        m_begin > m_target ? double(m_begin - n) / double(m_begin - m_target) : 1.;
    const double by_error =
        std::isfinite(m_bound) && m_bound > 0 ? m_state->relative_error() / m_bound : 0.;
    return (std::min)(1., (std::max)(by_count, by_error));
  }

  std::shared_ptr<typename Policies::State> m_state;
  std::size_t m_target;
  double m_bound;
  // It counts the vertices of the mesh, whoever follows it.
  Vertex_count_stop_predicate<typename Policies::Triangle_mesh> m_count_stop;
  Spectral_error_stop_predicate<Policies, GetPlacement> m_error_stop;
  // The run that the members below refer to, and its number of vertices at the first call.
  mutable std::size_t m_run = 0, m_begin = 0;
  mutable double m_next_report = 0, m_fraction = 0;
  mutable bool m_reached = false, m_error_reached = false, m_cancelled = false;
};

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_STOP_PREDICATE_H
