// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_THREADS_H
#define SPECTRAL_EXAMPLES_IO_THREADS_H

#include <algorithm>
#include <string>
#include <thread>

// As many threads as the machine runs at once.
inline int all_threads()
{
  return static_cast<int>((std::max)(1u, std::thread::hardware_concurrency()));
}

// As many as are wanted, but no more than that; hands `say` a sentence then, in which `option`
// stands before the number.
template <class Say>
int usable_threads(const int wanted, const std::string& option, const Say& say)
{
  const int most = all_threads();
  if(wanted > most)
    say("this machine runs " + std::to_string(most) + (most == 1 ? " thread" : " threads") +
        " at once: " + option + std::to_string(wanted) + " is taken for that.");
  return (std::min)(wanted, most);
}

#endif // SPECTRAL_EXAMPLES_IO_THREADS_H
