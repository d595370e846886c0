// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_VERTEX_TARGET_H
#define SPECTRAL_EXAMPLES_IO_VERTEX_TARGET_H

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

// How far to simplify: N vertices or faces, or N% of those of a mesh.
struct Vertex_target
{
  double number = 0;
  bool percent = false;

  // For a mesh of n, the nearest integer and at least 1.
  std::size_t of(const std::size_t n) const
  {
    return static_cast<std::size_t>(
        (std::max)(std::round(percent ? number / 100 * static_cast<double>(n) : number), 1.));
  }
};

// The targets of an option, separated by commas, as they stand there.
inline std::vector<Vertex_target> parsed_vertex_targets(const std::string& option,
                                                        const std::string& list,
                                                        const std::string& things = "vertices")
{
  std::vector<Vertex_target> targets;
  std::istringstream words(list + ",");
  for(std::string word; std::getline(words, word, ',');) {
    const bool percent = !word.empty() && word.back() == '%';
    const std::string digits = word.substr(0, word.size() - (percent ? 1 : 0));
    const double number = std::strtod(digits.c_str(), nullptr);
    if(digits.empty() || digits.size() > 15 ||
       digits.find_first_not_of(percent ? "0123456789." : "0123456789") != std::string::npos ||
       std::count(digits.begin(), digits.end(), '.') > 1 || !(number > 0) ||
       (percent && number > 100))
      throw std::runtime_error(option + (word == list ? " is '" : " has '") + word +
                               (word == list ? "'" : "' in it") + ", it must be a number of " +
                               things + " above 0 or a percentage, such as 600 or 3%.");
    targets.push_back({number, percent});
  }
  return targets;
}

inline Vertex_target parsed_vertex_target(const std::string& option, const std::string& word,
                                          const std::string& things = "vertices")
{
  const std::vector<Vertex_target> targets = parsed_vertex_targets(option, word, things);
  if(targets.size() != 1)
    throw std::runtime_error(option + " is '" + word + "', it must be one number of " + things +
                             " or percentage.");
  return targets.front();
}

#endif // SPECTRAL_EXAMPLES_IO_VERTEX_TARGET_H
