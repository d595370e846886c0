// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_PROGRAM_H
#define SPECTRAL_EXAMPLES_IO_PROGRAM_H

#include "threads.h"

#include <CGAL/Spectral_geometry/Run_control.h>

#include <atomic>
#include <csignal>
#include <cstddef>
#include <exception>
#include <iostream>
#include <new>
#include <string>

// What the programs have in common: how they are interrupted, what they say when something is
// wrong, how they end.

// Set by Ctrl-C. Loops and callbacks look at it, so that a program ends by its own way and leaves
// no file behind; the second time the signal does what it does to any program.
inline std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

extern "C" inline void interrupt(int signal)
{
  interrupted = true;
  std::signal(signal, SIG_DFL);
}

inline bool not_interrupted()
{
  return !interrupted;
}

inline void stop_if_interrupted()
{
  if(interrupted)
    throw CGAL::Spectral_geometry::Cancelled();
}

// The text as a terminal may show it: what is no UTF-8 or would control the terminal becomes a
// question mark.
inline std::string printable(const std::string& text)
{
  std::string result;
  for(std::size_t i = 0; i < text.size();) {
    const auto byte = [&](const std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const std::size_t length = byte(i) < 0x80   ? 1
                               : byte(i) < 0xC2 ? 0
                               : byte(i) < 0xE0 ? 2
                               : byte(i) < 0xF0 ? 3
                               : byte(i) < 0xF5 ? 4
                                                : 0;
    bool good = length > 0 && i + length <= text.size() && byte(i) >= 0x20 && byte(i) != 0x7F;
    for(std::size_t k = i + 1; good && k < i + length; ++k)
      good = (byte(k) & 0xC0) == 0x80;
    good = good && !(byte(i) == 0xC2 && byte(i + 1) < 0xA0); // controls of eight bits
    result += good ? text.substr(i, length) : "?";
    i += good ? length : 1;
  }
  return result;
}

inline std::string& program_name()
{
  static std::string name;
  return name;
}

// One line on standard error.
inline void complain(const std::string& sentence)
{
  std::cerr << program_name() + ": " + printable(sentence) + "\n";
}

inline void warn(const std::string& sentence)
{
  complain("warning: " + sentence);
}

// As many threads as are wanted, but no more than the machine runs at once; says so unless `quiet`.
inline int usable_threads(const int wanted, const bool quiet)
{
  return usable_threads(wanted, "--threads ", [quiet](const std::string& sentence) {
    if(!quiet)
      complain(sentence);
  });
}

// Runs `body`, which returns the exit status, and says in one sentence why it ended early.
template <class Body>
int run_program(const std::string& name, const Body& body)
{
  program_name() = name;
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  try {
    return body();
  } catch(const CGAL::Spectral_geometry::Cancelled&) {
    complain("interrupted, nothing was written.");
    return 130;
  } catch(const std::bad_alloc&) {
    complain(
        "the memory does not suffice for meshes of this size and this number of eigenvectors.");
  } catch(const std::exception& error) {
    complain(error.what());
  }
  return 1;
}

#endif // SPECTRAL_EXAMPLES_IO_PROGRAM_H
