// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_INDEX_READER_H
#define SPECTRAL_EXAMPLES_IO_INDEX_READER_H

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

// Reads indices of the vertices of a mesh of n vertices, one per line, counted from 0, as write_indices() writes them.
// Throws at the first line that is anything else. Empty lines are passed over.
inline std::vector<std::size_t> read_indices(const std::string& path, const std::size_t n)
{
  if(std::filesystem::is_directory(path))
    throw std::runtime_error("cannot read '" + path + "': it is a folder.");
  std::ifstream stream(path);
  if(!stream)
    throw std::runtime_error("cannot read '" + path + "': " + std::strerror(errno) + ".");
  std::vector<std::size_t> indices;
  std::size_t number = 0;
  for(std::string line; std::getline(stream, line);) {
    ++number;
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if(begin == std::string::npos)
      continue;
    const std::string word = line.substr(begin, line.find_last_not_of(" \t\r") + 1 - begin);
    const std::string place = "line " + std::to_string(number) + " of '" + path + "' ";
    if(word.find_first_not_of("0123456789") != std::string::npos)
      throw std::runtime_error(place + "is not the index of a vertex: write one per line, counted from 0.");
    if(word.size() > 18 || std::stoull(word) >= n)
      throw std::runtime_error(place + "is " + word.substr(0, 40) + ", but the mesh has " +
                               std::to_string(n) + " vertices: use indices from 0 to " +
                               std::to_string(n - 1) + ".");
    indices.push_back(std::stoull(word));
  }
  if(indices.empty())
    throw std::runtime_error("'" + path + "' names no vertex: write one index per line, counted from 0.");
  return indices;
}

#endif // SPECTRAL_EXAMPLES_IO_INDEX_READER_H
