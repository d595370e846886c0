// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_PROGRESS_BAR_H
#define SPECTRAL_EXAMPLES_IO_PROGRESS_BAR_H

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>

// Who wants to know how far a run is, and has no terminal, such as a page.
inline std::function<void(const std::string& phase, double fraction)> progress_listener;

// One line on the terminal with the phase, how far it is and how long it will take. Prints nothing
// where standard error is no terminal.
class Progress_bar
{
public:
  explicit Progress_bar(bool wanted)
    : m_enabled(wanted && !progress_listener && isatty(STDERR_FILENO))
  {}
  Progress_bar(const Progress_bar&) = delete;
  Progress_bar& operator=(const Progress_bar&) = delete;
  ~Progress_bar() { clear(); }

  // `phase` is a name, "first_costs", or words.
  void show(const std::string& phase, double fraction)
  {
    if(progress_listener)
      progress_listener(phase, fraction);
    if(!m_enabled)
      return;
    const auto now = Clock::now();
    if(phase != m_phase) {
      m_phase = phase;
      m_start = now;
    } else if(now - m_last < std::chrono::milliseconds(100)) {
      return; // a terminal is slow
    }
    m_last = now;
    draw((std::max)(0., (std::min)(fraction, 1.)),
         std::chrono::duration<double>(now - m_start).count());
  }

  void clear()
  {
    if(m_drawn)
      std::fputs("\r\033[K", stderr);
    m_drawn = false;
  }

private:
  using Clock = std::chrono::steady_clock;

  void draw(double fraction, double elapsed)
  {
    constexpr int width = 30;
    const int filled = static_cast<int>(width * fraction);
    const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
    std::string phase = m_phase;
    std::replace(phase.begin(), phase.end(), '_', ' ');
    std::fprintf(stderr, "\r\033[K%-18s [%s] %3.0f %%", phase.c_str(), bar.c_str(), 100 * fraction);
    // The first moments say too little about the rest.
    if(elapsed > 0.5 && fraction > 0.01)
      std::fprintf(stderr, "  %.0f s left", elapsed * (1 - fraction) / fraction);
    std::fflush(stderr);
    m_drawn = true;
  }

  bool m_enabled, m_drawn = false;
  std::string m_phase;
  Clock::time_point m_start, m_last;
};

#endif // SPECTRAL_EXAMPLES_IO_PROGRESS_BAR_H
