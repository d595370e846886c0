// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_PYTHON_WATCH_H
#define SPECTRAL_PYTHON_WATCH_H

#include "arguments.h"

#include <CGAL/Spectral_geometry/Run_control.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

// Raises what Ctrl-C raises. For code without the GIL.
inline void check_signals()
{
  const py::gil_scoped_acquire gil;
  if(PyErr_CheckSignals() != 0)
    throw py::error_already_set();
}

// What `work` returns, which does without the GIL and calls check_signals() now and then.
template <class Work>
auto interruptible(const Work& work)
{
  std::optional<decltype(work())> result;
  {
    const py::gil_scoped_release no_gil;
    result = work();
  }
  return std::move(*result);
}

// Between a computation, which has no GIL, and Python: asks for signals and calls the callback
// twenty times a second and at the begin of each phase. May be asked by several threads; signals
// reach the one that made it.
class Watch
{
public:
  Watch() = default; // for signals alone

  explicit Watch(const Arguments& a)
    : m_callback(a["progress"])
  {
    if(!m_callback.is_none() && !PyCallable_Check(m_callback.ptr()))
      a.must_be("progress", "None or a function of a phase and a fraction", true);
  }

  // False to stop.
  bool operator()(const char* phase, const double fraction)
  {
    if(m_callback.is_none() && std::this_thread::get_id() != m_thread)
      return !m_stopped;
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    constexpr auto pause = std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                               std::chrono::milliseconds(50))
                               .count();
    if(m_stopped || (m_phase == phase && now - m_last < pause))
      return !m_stopped;
    const py::gil_scoped_acquire gil;
    if(m_stopped)
      return false;
    m_phase = phase;
    m_last = now;
    try {
      if(PyErr_CheckSignals() != 0)
        throw py::error_already_set();
      if(!m_callback.is_none()) {
        const py::object answer = m_callback(phase, fraction);
        const int goes_on = answer.is_none() ? 1 : PyObject_IsTrue(answer.ptr());
        if(goes_on < 0)
          throw py::error_already_set();
        m_stopped = goes_on == 0;
      }
    } catch(...) {
      m_error = std::current_exception();
      m_stopped = true;
    }
    return !m_stopped;
  }

  // What `work` returns, which does without the GIL. Throws what stopped it.
  template <class Work>
  auto run(const Work& work)
  {
    std::optional<decltype(work())> result;
    try {
      const py::gil_scoped_release no_gil;
      result = work();
    } catch(...) {
      stop();
      throw;
    }
    stop();
    return std::move(*result);
  }

private:
  void stop() const
  {
    if(m_error)
      std::rethrow_exception(m_error);
    if(m_stopped)
      throw SG::Cancelled();
  }

  py::object m_callback = py::none();
  std::thread::id m_thread = std::this_thread::get_id();
  std::exception_ptr m_error;
  std::atomic<bool> m_stopped{false};
  std::atomic<const char*> m_phase{nullptr};
  std::atomic<std::chrono::steady_clock::rep> m_last{0};
};

#endif // SPECTRAL_PYTHON_WATCH_H
