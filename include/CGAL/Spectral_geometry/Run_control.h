// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_RUN_CONTROL_H
#define CGAL_SPECTRAL_GEOMETRY_RUN_CONTROL_H

#include <CGAL/Spectral_geometry/internal/basics.h>

#include <atomic>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief is thrown when a computation is cancelled: by a progress callback, or by the flag of
/// `Run_control`.
class Cancelled : public std::runtime_error
{
public:
  Cancelled()
    : std::runtime_error("The computation was cancelled.")
  {}
};

/// \brief what a computation is doing.
enum class Phase {
  pre_simplification, ///< collapsing by quadrics
  eigenpairs,         ///< solving for the basis: eigenpairs or filtered signals
  first_costs,        ///< evaluating every edge once
  collapses,          ///< inside the collapse loop
  relocation,         ///< moving the vertices that are left
  operator_fit,       ///< fitting operators to the coarse mesh
  curvature,          ///< estimating principal curvatures
  matching            ///< looking for nearest rows
};

/// \brief the argument of a progress callback. It converts to `double`, so that a callback may be a
/// function of the fraction alone.
struct Progress
{
  Phase phase; ///< what is being done
  /// of this phase, in [0,1]; within a phase it never decreases on any thread that reports. A run
  /// may enter a phase again
  double fraction;
  /// current number of vertices of the mesh that is simplified; 0 if there is none
  std::size_t number_of_vertices = 0;

  operator double() const { return fraction; } ///< `fraction`
};

/// \brief is called now and then; returns `false` to cancel. Searches of nearest rows call it from
/// each of their threads, with the fraction that the thread has come to.
using Progress_callback = std::function<bool(const Progress&)>;

/// \brief how a computation runs. No result depends on it.
struct Run_control
{
  /// number of threads, at least 1
  int threads = 1;
  /// called now and then, if there is one
  Progress_callback progress{};
  /// A flag that cancels as the callback does; set it from another thread or a signal handler. It
  /// is read before and after each report, and between two collapses. It must outlive the
  /// computation. Null: none.
  const std::atomic<bool>* cancel = nullptr;
};

/// @}

namespace internal {

inline bool is_cancelled(const Run_control& control)
{
  return control.cancel != nullptr && control.cancel->load(std::memory_order_relaxed);
}

/// Reports; `false` means that the user cancelled.
inline bool goes_on(const Run_control& control, const Progress& progress)
{
  return !is_cancelled(control) && (!control.progress || control.progress(progress)) &&
         !is_cancelled(control); // the callback may have waited for somebody
}

/// Reports; throws where the user cancelled.
inline void report_to(const Run_control& control, const Progress& progress)
{
  if(!goes_on(control, progress))
    throw Cancelled();
}

} // namespace internal

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_RUN_CONTROL_H
