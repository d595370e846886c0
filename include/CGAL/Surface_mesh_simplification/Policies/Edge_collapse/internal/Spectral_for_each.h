// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_FOR_EACH_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_FOR_EACH_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <cstddef>
#include <memory>
#include <vector>

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#endif

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

#ifdef CGAL_LINKED_WITH_TBB
constexpr bool spectral_threads_available = true;
#else
constexpr bool spectral_threads_available = false;
#endif

/*!
 * Calls `body(i, workspace)` for each i of a range, on a number of threads with one workspace each. What a
 * call computes must depend on i alone, so that the result is the same for any number of threads.
 *
 * The arena outlives the batches: making one for each costs more than a batch of a collapse takes.
 */
template <class Workspace>
class Spectral_for_each
{
public:
  explicit Spectral_for_each(const int threads = 1)
    : m_workspaces(threads > 1 ? std::size_t(threads) : 1)
  {
#ifdef CGAL_LINKED_WITH_TBB
    if(threads > 1)
      m_arena = std::make_unique<tbb::task_arena>(threads);
#endif
  }

  Workspace& first_workspace()
  {
    return m_workspaces.front();
  }

  /// Runs of `grain` calls stay on one thread.
  template <class Body>
  void operator()(const std::size_t n, const std::size_t grain, const Body& body)
  {
#ifdef CGAL_LINKED_WITH_TBB
    if(m_arena && n > grain) {
      m_arena->execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, n, grain),
            [&](const tbb::blocked_range<std::size_t>& range) {
              Workspace& workspace = m_workspaces[std::size_t(tbb::this_task_arena::current_thread_index())];
              for(std::size_t i = range.begin(); i != range.end(); ++i)
                body(i, workspace);
            },
            tbb::simple_partitioner());
      });
      return;
    }
#endif
    (void)grain;
    for(std::size_t i = 0; i < n; ++i)
      body(i, m_workspaces.front());
  }

private:
  std::vector<Workspace> m_workspaces;
#ifdef CGAL_LINKED_WITH_TBB
  std::unique_ptr<tbb::task_arena> m_arena;
#endif
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_FOR_EACH_H
