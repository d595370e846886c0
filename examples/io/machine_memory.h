// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_MACHINE_MEMORY_H
#define SPECTRAL_EXAMPLES_IO_MACHINE_MEMORY_H

#include <cstdio>
#include <fstream>
#include <string>

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

// Bytes that a program can still take: what Linux calls available, elsewhere all memory of the machine; 0 when unknown.
inline double available_memory()
{
  std::ifstream file("/proc/meminfo");
  std::string name, unit;
  double kilobytes, sum = 0;
  while(file >> name >> kilobytes) {
    std::getline(file, unit);
    if(name == "MemAvailable:" || name == "SwapFree:")
      sum += 1024 * kilobytes;
  }
  if(sum > 0)
    return sum;
#if defined(_SC_PHYS_PAGES) && defined(_SC_PAGESIZE)
  return double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
#else
  return 0;
#endif
}

// "12.3 GB" or "45 MB"
inline std::string formatted_memory(double bytes)
{
  char text[40];
  if(bytes < 1e9)
    std::snprintf(text, sizeof(text), "%.0f MB", bytes / 1e6);
  else
    std::snprintf(text, sizeof(text), "%.1f GB", bytes / 1e9);
  return text;
}

#endif // SPECTRAL_EXAMPLES_IO_MACHINE_MEMORY_H
