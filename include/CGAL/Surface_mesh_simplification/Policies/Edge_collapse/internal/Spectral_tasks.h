// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_TASKS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_TASKS_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_thread_pool.h>

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <utility>
#include <vector>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/*!
 * Results that the other threads of a pool compute while the caller does something else. Each is computed once, by
 * another thread or, if none has begun with it, by the caller when it asks for it. What its computation has thrown is thrown
 * again to who asks for it.
 */
template <class Result, class Workspace>
class Spectral_tasks
{
public:
  using Pool = Spectral_thread_pool<Workspace>;

  /// Begins with `compute(i, workspace)` for each i in [0, n). The results before are gone.
  void start(Pool& pool, const std::size_t n, std::function<Result(std::size_t, Workspace&)> compute)
  {
    pool.finish();
    m_pool = &pool;
    m_compute = std::move(compute);
    if(m_tasks.size() < n)
      m_tasks = std::vector<Task>(2 * n);
    m_size = m_last = n;
    for(std::size_t i = 0; i < n; ++i) {
      m_tasks[i].stage.store(Task::waiting, std::memory_order_relaxed);
      m_tasks[i].taken = false;
      m_tasks[i].error = nullptr;
    }
    pool.start(n, [this](const std::size_t i, Workspace& workspace) { run(i, workspace); });
  }

  /// Result i. While another thread is in it, the caller computes others, from the last on: the threads begin at the front.
  const Result& take(const std::size_t i)
  {
    Task& task = m_tasks[i];
    run(i, m_pool->workspace());
    const auto done = [&task] { return task.stage.load(std::memory_order_acquire) == Task::done; };
    while(m_last > i && !done())
      run(--m_last, m_pool->workspace());
    Pool::wait_for(done);
    if(task.error)
      std::rethrow_exception(task.error);
    task.taken = true;
    return task.result;
  }

  /// Waits for all; `put(i, result)` is called with each that has not been taken.
  template <class Put>
  void finish(const Put& put)
  {
    if(m_size == 0)
      return;
    m_pool->finish();
    const std::size_t size = std::exchange(m_size, 0); // over, even if a task throws
    for(std::size_t i = 0; i < size; ++i)
      if(!m_tasks[i].taken)
        put(i, take(i));
  }

private:
  // In memory of its own: two threads look at it.
  struct alignas(spectral_cache_line) Task
  {
    enum Stage { waiting, begun, done };
    std::atomic<int> stage{waiting};
    bool taken = false;
    std::exception_ptr error;
    Result result;
  };

  // Unless somebody has begun with it.
  void run(const std::size_t i, Workspace& workspace)
  {
    Task& task = m_tasks[i];
    int stage = Task::waiting;
    if(!task.stage.compare_exchange_strong(stage, Task::begun))
      return;
    try {
      task.result = m_compute(i, workspace);
    } catch(...) {
      task.error = std::current_exception();
    }
    task.stage.store(Task::done, std::memory_order_release);
  }

  Pool* m_pool = nullptr;
  std::function<Result(std::size_t, Workspace&)> m_compute;
  std::vector<Task> m_tasks;
  std::size_t m_size = 0, m_last = 0; // the caller has not looked at [0, m_last) from behind
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_SPECTRAL_TASKS_H
