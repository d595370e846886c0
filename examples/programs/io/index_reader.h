// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_INDEX_READER_H
#define SPECTRAL_EXAMPLES_IO_INDEX_READER_H

#include "text_lines.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

// Throws where a file of this name cannot be read.
inline void require_readable(const std::string& path)
{
  if(std::filesystem::is_directory(path))
    throw std::runtime_error("cannot read '" + path + "': it is a folder.");
  if(!std::ifstream(path))
    throw std::runtime_error("cannot read '" + path + "': " + std::strerror(errno) + ".");
}

// Lines of one vertex for each of `sizes`, which say how many vertices the meshes have, counted
// from 0. Throws at the first line that is anything else, or that names a vertex of one mesh again.
// With `or_none`, lines may hold -1, and vertices may repeat.
inline std::vector<std::vector<std::size_t>>
read_vertex_lines(const std::string& path, const std::vector<std::size_t>& sizes,
                  const bool or_none = false)
{
  require_readable(path);
  const std::string form = sizes.size() == 1 ? "one index per line" : "two indices per line";
  const auto place = [&](const std::size_t line) {
    return "line " + std::to_string(line) + " of '" + path + "' ";
  };
  std::vector<std::vector<std::size_t>> rows;
  std::vector<std::vector<bool>> named;
  for(const std::size_t n : sizes)
    named.emplace_back(n, false);
  std::string twice; // the first repetition
  std::size_t largest = 0;
  Text_lines file(path);
  while(file.next()) {
    std::vector<std::size_t> row;
    for(std::size_t c = 0; c < sizes.size(); ++c) {
      const std::string word = file.word();
      if(or_none && word == "-1") {
        row.push_back(std::size_t(-1));
        continue;
      }
      if(word.empty() || word.find_first_not_of("0123456789") != std::string::npos)
        throw std::runtime_error(place(file.line()) + "has " + quoted(word) +
                                 " where the index of a vertex is expected: write " + form +
                                 ", counted from 0.");
      if(word.size() > 18 || std::stoull(word) >= sizes[c])
        throw std::runtime_error(place(file.line()) + "has " + word.substr(0, 40) +
                                 ", but the mesh has " + std::to_string(sizes[c]) +
                                 " vertices: use indices from 0 to " +
                                 std::to_string(sizes[c] - 1) + ".");
      row.push_back(std::stoull(word));
      largest = (std::max)(largest, row.back());
      if(named[c][row.back()] && twice.empty())
        twice = place(file.line()) + "names vertex " + std::to_string(row.back()) +
                (c == 1              ? " of Y"
                 : sizes.size() == 2 ? " of X"
                                     : "") +
                " again: write each index once";
      named[c][row.back()] = true;
    }
    if(file.more())
      throw std::runtime_error(place(file.line()) + "has " + quoted(file.word()) +
                               " after what is expected: write " + form + ", counted from 0.");
    rows.push_back(std::move(row));
  }
  if(rows.empty())
    throw std::runtime_error("'" + path + "' names no vertex: write " + form + ", counted from 0.");
  if(!or_none && !twice.empty())
    throw std::runtime_error(twice + (largest <= 1 && sizes.size() == 1
                                          ? "; a mask of 0 and 1 is no list of indices."
                                          : "."));
  return rows;
}

// Indices of vertices of a mesh of n vertices, one per line, each once.
inline std::vector<std::size_t> read_indices(const std::string& path, const std::size_t n)
{
  std::vector<std::size_t> indices;
  for(const auto& row : read_vertex_lines(path, {n}))
    indices.push_back(row.front());
  return indices;
}

#endif // SPECTRAL_EXAMPLES_IO_INDEX_READER_H
