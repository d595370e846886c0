// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_FOR_EACH_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_FOR_EACH_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <cstddef>
#include <vector>

#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
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

/// Calls `body(i, workspace)` for each i in [0, n), with one workspace per thread. What a call computes
/// must depend on i alone, so that the result is the same for any number of threads.
template <class Workspace, class Body>
void spectral_for_each(const std::size_t n, const int threads, std::vector<Workspace>& workspaces,
                       const Body& body)
{
  const std::size_t wanted = threads > 1 ? std::size_t(threads) : 1;
  if(workspaces.size() < wanted)
    workspaces.resize(wanted);
#ifdef CGAL_LINKED_WITH_TBB
  constexpr std::size_t grain = 8; // a few microseconds each: less would be spent on scheduling
  if(threads > 1 && n > grain) {
    tbb::task_arena arena(threads);
    arena.execute([&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain),
                        [&](const tbb::blocked_range<std::size_t>& range) {
                          Workspace& workspace = workspaces[tbb::this_task_arena::current_thread_index()];
                          for(std::size_t i = range.begin(); i != range.end(); ++i)
                            body(i, workspace);
                        });
    });
    return;
  }
#endif
  for(std::size_t i = 0; i < n; ++i)
    body(i, workspaces.front());
}

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_FOR_EACH_H
