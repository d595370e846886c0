// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_THREAD_POOL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_THREAD_POOL_H

#include <CGAL/Spectral_geometry/internal/numerics/vector_units.h>

#include <Eigen/Core>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace CGAL::Spectral_geometry::internal {

/*!
 * Runs short loops on several threads, each with a workspace of its own.
 *
 * There are two loops of some microseconds in each collapse. A task scheduler spends as much on
 * waking its workers (measured with TBB: two threads as slow as one), so the workers here wait for
 * the next loop with their eyes open, and go to sleep when none comes for a while. The caller waits
 * only for workers that have entered a loop: one that the system has taken off its processor misses
 * it and costs nothing.
 *
 * What a call computes must depend on its index alone, so that the result is the same for any
 * number of threads. What it throws, on whichever thread, the caller gets when nobody is inside any
 * more; calls that nobody has begun with are left out then.
 */
template <class Workspace>
class Thread_pool
{
public:
  explicit Thread_pool(const int threads = 1)
    : Thread_pool(threads, [](auto&& worker) { return std::thread(worker); })
  {}

  /// `start(worker)` makes the threads. Where the system has no more of them the pool does with
  /// those it has got.
  template <class Start>
  Thread_pool(const int threads, const Start& start)
    : m_workspaces(threads > 1 ? std::size_t(threads) : 1)
  {
    m_workers.reserve(m_workspaces.size() - 1);
    try {
      for(std::size_t i = 1; i < m_workspaces.size(); ++i)
        m_workers.push_back(start([this, i] { work(i); }));
    } catch(const std::system_error&) {
    } catch(const std::bad_alloc&) {
    } catch(...) {
      end();
      throw;
    }
  }

  Thread_pool(const Thread_pool&) = delete;
  Thread_pool& operator=(const Thread_pool&) = delete;

  ~Thread_pool() { end(); }

  std::size_t number_of_threads() const { return m_workers.size() + 1; }

  /// The workspace of the calling thread.
  Workspace& workspace() { return m_workspaces.front(); }

  /// Calls `body(i, workspace)` for each i in [0, n); `grain` calls in a row stay on one thread.
  template <class Body>
  void for_each(const std::size_t n, const std::size_t grain, const Body& body)
  {
    if(m_workers.empty() || n <= grain || n <= m_alone) {
      m_alone -= (std::min)(m_alone, n);
      for(std::size_t i = 0; i < n; ++i)
        body(i, m_workspaces.front());
      return;
    }
    m_run = [](const void* b, const std::size_t begin, const std::size_t end,
               Workspace& workspace) {
      for(std::size_t i = begin; i < end; ++i)
        (*static_cast<const Body*>(b))(i, workspace);
    };
    m_body = &body;
    m_size = n;
    m_grain = grain;
    m_next.store(0, std::memory_order_relaxed);
    announce();
    take_part(m_workspaces.front());
    m_gate.fetch_and(~open_bit);
    wait_for_workers();
    if(m_error)
      std::rethrow_exception(std::exchange(m_error, nullptr));
  }

private:
  static constexpr std::size_t patience = 20000; // spins, about a millisecond on an idle machine
  static constexpr std::size_t most_alone = 1 << 19; // calls, about half a second of collapses

  static void relax(const std::size_t spins)
  {
    if(spins >
       2048) // longer than a loop takes: somebody needs this processor, perhaps the one we wait for
      std::this_thread::yield();
#ifdef CGAL_SPECTRAL_DISPATCH
    _mm_pause();
#endif
  }

  // A worker that does not come out for a millisecond has lost its processor to somebody else.
  // Where that happens the caller does the next calls alone, twice as many each time, while workers
  // fall asleep: awake they would take the caller's processor, too.
  void wait_for_workers()
  {
    using Clock = std::chrono::steady_clock;
    Clock::time_point begin;
    for(std::size_t spins = 0; (m_gate.load(std::memory_order_acquire) & inside_mask) != 0;
        ++spins) {
      if(spins == 0)
        begin = Clock::now();
      relax(spins);
    }
    if(begin != Clock::time_point() && Clock::now() - begin > std::chrono::milliseconds(1)) {
      m_alone = m_next_alone;
      m_next_alone = (std::min)(2 * m_next_alone, most_alone);
    }
  }

  // The gate: number of the loop, whether it is open, how many workers are inside.
  static constexpr std::uint64_t inside_mask = 0x7fffffff, open_bit = 0x80000000,
                                 one_loop = 0x100000000;

  static std::uint64_t loop_of(const std::uint64_t gate)
  {
    return gate / one_loop;
  }

  void end()
  {
    m_end = true;
    announce();
    for(std::thread& worker : m_workers)
      worker.join();
  }

  // Only the calling thread does this, while nobody is inside.
  void announce()
  {
    m_gate.store((loop_of(m_gate.load()) + 1) * one_loop + open_bit);
    if(m_asleep.load() != 0) {
      std::lock_guard<std::mutex> lock(m_mutex);
      m_wake.notify_all();
    }
  }

  // False if the loop has been closed. Everything that was written before announce() is visible
  // inside.
  bool enter(const std::uint64_t loop)
  {
    std::uint64_t gate = m_gate.load();
    while(loop_of(gate) == loop && (gate & open_bit) != 0)
      if(m_gate.compare_exchange_weak(gate, gate + 1))
        return true;
    return false;
  }

  void take_part(Workspace& workspace)
  {
    for(;;) {
      const std::size_t begin = m_next.fetch_add(m_grain, std::memory_order_relaxed);
      if(begin >= m_size)
        return;
      const std::size_t end = m_size - begin < m_grain ? m_size : begin + m_grain;
      try {
        m_run(m_body, begin, end, workspace);
      } catch(...) {
        std::lock_guard<std::mutex> lock(m_mutex);
        if(!m_error)
          m_error = std::current_exception();
        m_next.store(m_size, std::memory_order_relaxed);
      }
    }
  }

  void work(const std::size_t index)
  {
    std::uint64_t seen = 0;
    for(;;) {
      seen = wait_for_loop_after(seen);
      if(m_end)
        return;
      if(enter(seen)) {
        take_part(m_workspaces[index]);
        m_gate.fetch_sub(1, std::memory_order_release);
      }
    }
  }

  std::uint64_t wait_for_loop_after(const std::uint64_t seen)
  {
    for(std::size_t spins = 0; spins < patience; ++spins) {
      const std::uint64_t loop = loop_of(m_gate.load());
      if(loop != seen)
        return loop;
      relax(spins);
    }
    std::unique_lock<std::mutex> lock(m_mutex);
    ++m_asleep;
    m_wake.wait(lock, [&] { return loop_of(m_gate.load()) != seen; });
    --m_asleep;
    return loop_of(m_gate.load());
  }

  std::vector<Workspace> m_workspaces;
  std::vector<std::thread> m_workers;

  // The loop that is running.
  void (*m_run)(const void*, std::size_t, std::size_t, Workspace&) = nullptr;
  const void* m_body = nullptr;
  std::size_t m_size = 0, m_grain = 1;
  std::exception_ptr m_error; // the first that a call has thrown
  std::size_t m_alone = 0,
              m_next_alone =
                  1 << 12; // calls that the caller does without workers, and the next time

  // Each in a cache line of its own: who waits reads the first of them all the time.
  alignas(cache_line) std::atomic<std::uint64_t> m_gate{0};
  alignas(cache_line) std::atomic<std::size_t> m_next{0};
  alignas(cache_line) std::atomic<std::size_t> m_asleep{0};
  std::atomic<bool> m_end{false};
  std::mutex m_mutex;
  std::condition_variable m_wake;
};

/// Calls f(0) .. f(count - 1) on at most so many threads, in any order, as
/// `Thread_pool::for_each()` does, `grain` of them in a row on one. Sums over tasks are up to the
/// caller, in the order of the tasks, so that no result depends on the number of threads.
template <class Function>
void for_each_task(const Eigen::Index count, const int threads, const Function& f,
                   const int grain = 1)
{
  struct Nothing
  {};
  Thread_pool<Nothing> pool(int((std::min)(Eigen::Index(threads), count / grain)));
  pool.for_each(std::size_t((std::max)(Eigen::Index(0), count)), std::size_t(grain),
                [&f](const std::size_t i, Nothing&) { f(Eigen::Index(i)); });
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_THREAD_POOL_H
