// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_FOR_EACH_TASK_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_FOR_EACH_TASK_H

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// Calls f(0) .. f(count - 1), on several threads in any order. Tasks must not depend on each other. What one throws
/// the caller gets when no other runs any more, and those that have not begun are left out. Sums over tasks
/// are up to the caller, in the order of the tasks, so that no result depends on the number of threads.
template <class Function>
void for_each_task(int count, int threads, const Function& f)
{
  std::atomic<int> next(0);
  std::mutex mutex;
  std::exception_ptr error;
  const auto work = [&] {
    try {
      for(int i = next++; i < count; i = next++)
        f(i);
    } catch(...) {
      const std::lock_guard<std::mutex> lock(mutex);
      error = std::current_exception();
      next = count;
    }
  };
  const int helpers = (std::min)(threads, count) - 1;
  std::vector<std::thread> others;
  others.reserve((std::max)(0, helpers)); // a vector that cannot grow would leave running threads behind
  try {
    for(int t = 0; t < helpers; ++t)
      others.emplace_back(work);
  } catch(const std::system_error&) {
    // no thread left: those that are there do all tasks
  } catch(const std::bad_alloc&) {
  }
  work();
  for(std::thread& t : others)
    t.join();
  if(error)
    std::rethrow_exception(error);
}

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_FOR_EACH_TASK_H
