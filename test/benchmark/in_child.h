// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_BENCHMARK_IN_CHILD_H
#define SPECTRAL_BENCHMARK_IN_CHILD_H

#include <sys/resource.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace in_child_internal {

inline bool write_all(int file, const void* data, std::size_t size)
{
  const char* p = static_cast<const char*>(data);
  while(size > 0) {
    const ssize_t written = write(file, p, size);
    if(written <= 0)
      return false;
    p += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

inline std::string read_all(int file)
{
  std::string result;
  char buffer[4096];
  for(ssize_t count; (count = read(file, buffer, sizeof(buffer))) > 0;)
    result.append(buffer, static_cast<std::size_t>(count));
  return result;
}

} // namespace in_child_internal

// Calls f() in a process of its own, so that each measurement starts with an empty heap and has a
// peak memory of its own, and returns what it returned, a structure of numbers. `peak_bytes`
// becomes the largest resident set of that process.
template <class Function>
auto in_child(const Function& f, double& peak_bytes) -> decltype(f())
{
  using Result = decltype(f());
  static_assert(std::is_trivially_copyable<Result>::value, "the result goes through a pipe");
  int ends[2];
  if(pipe(ends) != 0)
    throw std::runtime_error("a pipe could not be opened.");
  const pid_t child = fork();
  if(child < 0)
    throw std::runtime_error("a process could not be started.");
  if(child == 0) {
    close(ends[0]);
    int status = 0;
    try {
      const Result result = f();
      status = in_child_internal::write_all(ends[1], &result, sizeof(result)) ? 0 : 2;
    } catch(const std::exception& error) {
      const std::string message = error.what();
      in_child_internal::write_all(ends[1], message.data(), message.size());
      status = 1;
    }
    _exit(status);
  }
  close(ends[1]);
  const std::string answer = in_child_internal::read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  rusage usage{};
  if(wait4(child, &status, 0, &usage) != child || !WIFEXITED(status))
    throw std::runtime_error("a measurement ended by a signal, perhaps for want of memory.");
  if(WEXITSTATUS(status) == 1)
    throw std::runtime_error(answer);
  Result result;
  if(WEXITSTATUS(status) != 0 || answer.size() != sizeof(result))
    throw std::runtime_error("a measurement did not return its result.");
  answer.copy(reinterpret_cast<char*>(&result), sizeof(result));
#ifdef __APPLE__
  peak_bytes = static_cast<double>(usage.ru_maxrss);
#else
  peak_bytes = 1024. * static_cast<double>(usage.ru_maxrss);
#endif
  return result;
}

#endif // SPECTRAL_BENCHMARK_IN_CHILD_H
