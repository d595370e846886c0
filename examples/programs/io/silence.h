// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_SILENCE_H
#define SPECTRAL_EXAMPLES_IO_SILENCE_H

#include <iostream>
#include <streambuf>

// CGAL's readers tell some errors to std::cerr in their own words; not while this object lives.
class Silence
{
public:
  Silence()
    : m_buffer(std::cerr.rdbuf(nullptr))
  {}
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
  ~Silence()
  {
    std::cerr.rdbuf(m_buffer);
    std::cerr.clear();
  }

private:
  std::streambuf* m_buffer;
};

#endif // SPECTRAL_EXAMPLES_IO_SILENCE_H
