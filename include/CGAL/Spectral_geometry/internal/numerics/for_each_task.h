// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_FOR_EACH_TASK_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_FOR_EACH_TASK_H

#include <CGAL/Spectral_geometry/internal/basics.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>

namespace CGAL::Spectral_geometry::internal {

/// Calls f(first, end) for ranges of `at_once` numbers of 0 .. size - 1, in any order; the last
/// range may be shorter. At most `threads` threads take part: the caller and those that
/// `start(worker)` creates. If the system has no more threads, fewer take part.
///
/// What a call computes must depend on its range alone, and the caller adds up results in the order
/// of the ranges: then no result depends on the number of threads. The first exception of any
/// thread is rethrown to the caller when all have returned; calls that have not begun are then left
/// out.
inline void for_each_range(
    const Eigen::Index size, const Eigen::Index at_once, const int threads,
    const std::function<void(Eigen::Index, Eigen::Index)>& f,
    const std::function<std::thread(const std::function<void()>&)>& start = [](const auto& worker) {
      return std::thread(worker);
    })
{
  std::atomic<Eigen::Index> next{0};
  std::mutex mutex;
  std::exception_ptr error; // the first
  const auto take_part = [&] {
    try {
      for(Eigen::Index i = next.fetch_add(at_once); i < size; i = next.fetch_add(at_once))
        f(i, (std::min)(i + at_once, size));
    } catch(...) {
      const std::lock_guard<std::mutex> lock(mutex);
      if(!error)
        error = std::current_exception();
      next = size;
    }
  };
  {
    struct Workers : std::vector<std::thread>
    {
      ~Workers()
      {
        for(std::thread& worker : *this)
          worker.join();
      }
    } workers;
    const Eigen::Index most = (std::min)(Eigen::Index(threads), (size + at_once - 1) / at_once);
    workers.reserve(std::size_t((std::max)(most, Eigen::Index(1))));
    try {
      for(Eigen::Index i = 1; i < most; ++i)
        workers.push_back(start(take_part));
    } catch(const std::system_error&) {
    } catch(const std::bad_alloc&) {
    }
    take_part();
  }
  if(error)
    std::rethrow_exception(error);
}

/// Calls f(0) .. f(count - 1) likewise, `grain` of them in a row on one thread.
template <class Function>
void for_each_task(const Eigen::Index count, const int threads, const Function& f,
                   const int grain = 1)
{
  for_each_range(count, grain, threads, [&f](Eigen::Index i, const Eigen::Index end) {
    for(; i < end; ++i)
      f(i);
  });
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_FOR_EACH_TASK_H
