// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_MACHINE_MEMORY_H
#define SPECTRAL_EXAMPLES_IO_MACHINE_MEMORY_H

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace machine_memory_internal {

// The first number of a file, or infinity: some say "max".
inline double number_in(const std::filesystem::path& file)
{
  double number;
  return std::ifstream(file) >> number ? number : std::numeric_limits<double>::infinity();
}

// The number beside `key` in a file of names and numbers, or 0.
inline double number_beside(const std::string& key, const std::filesystem::path& file)
{
  std::ifstream stream(file);
  std::string name, rest;
  for(double number; stream >> name >> number; std::getline(stream, rest))
    if(name == key)
      return number;
  return 0;
}

// What is left in the control group at `path` below `mount` and in those around it, of which some
// may not be visible.
inline double left_in_group(const std::filesystem::path& mount, const std::string& path,
                            const char* limit, const char* usage, const char* idle)
{
  double left = std::numeric_limits<double>::infinity();
  for(std::filesystem::path group = mount / std::filesystem::path(path).relative_path();;
      group = group.parent_path()) {
    const double most = number_in(group / limit), used = number_in(group / usage);
    if(std::isfinite(most) && std::isfinite(used)) // idle pages of files are given up first
      left = (std::min)(left, most - used + number_beside(idle, group / "memory.stat"));
    if(group == mount || group == group.parent_path())
      return (std::max)(left, 1.);
  }
}

// A line is "0::/path" in version 2, "4:memory:/path" in version 1.
inline double left_in_groups(const std::filesystem::path& root)
{
  double left = std::numeric_limits<double>::infinity();
  std::ifstream groups(root / "proc/self/cgroup");
  const std::filesystem::path mount = root / "sys/fs/cgroup";
  for(std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if(second == std::string::npos)
      continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",",
                      path = line.substr(second + 1);
    if(controllers == ",,")
      left = (std::min)(
          left, left_in_group(mount, path, "memory.max", "memory.current", "inactive_file"));
    else if(controllers.find(",memory,") != std::string::npos)
      left = (std::min)(left, left_in_group(mount / "memory", path, "memory.limit_in_bytes",
                                            "memory.usage_in_bytes", "total_inactive_file"));
  }
  return left;
}

} // namespace machine_memory_internal

// Bytes that a program can still take: what Linux calls available, within the limits of its control
// groups; elsewhere all memory of the machine; 0 when unknown. The files of Linux are looked for
// below `root`.
inline double available_memory(const std::filesystem::path& root = "/")
{
  using namespace machine_memory_internal;
  const std::filesystem::path file = root / "proc/meminfo";
  const double sum =
      1024 * (number_beside("MemAvailable:", file) + number_beside("SwapFree:", file));
  if(sum > 0)
    return (std::min)(sum, left_in_groups(root));
#if defined(_SC_PHYS_PAGES) && defined(_SC_PAGESIZE)
  return double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
#else
  return 0;
#endif
}

// The most bytes that this process has had in memory so far; 0 when unknown.
inline double peak_memory()
{
#if defined(__unix__) || defined(__APPLE__)
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
  return static_cast<double>(usage.ru_maxrss);
#else
  return 1024. * static_cast<double>(usage.ru_maxrss);
#endif
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

// Refuses --sources whose distances to n vertices do not fit in memory: those of both meshes, and
// what carries them over, four numbers for each.
inline void check_sources(const long sources, const std::size_t n)
{
  const double needed = 32. * double(sources) * double(n), available = available_memory();
  if(available > 0 && needed > available)
    throw std::runtime_error("distances from " + std::to_string(sources) + " sources to " +
                             std::to_string(n) + " vertices take about " +
                             formatted_memory(needed) + " of memory, but this machine has " +
                             formatted_memory(available) + " left: lower --sources.");
}

#endif // SPECTRAL_EXAMPLES_IO_MACHINE_MEMORY_H
