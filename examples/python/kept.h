// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_PYTHON_KEPT_H
#define SPECTRAL_PYTHON_KEPT_H

#include "../programs/io/kept_vertices.h"
#include "arguments.h"

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

// The indices that keep= holds, each once.
inline std::vector<std::size_t> kept_indices(const Arguments& a)
{
  const auto n = std::size_t(a.integer("v", 0));
  const std::vector<std::size_t> result = a.indices("keep", n, "V");
  std::vector<bool> named(n, false);
  for(std::size_t i = 0; i < result.size(); ++i) {
    if(named[result[i]])
      refuse("keep[" + to_string(i) + "] names vertex " + to_string(result[i]) +
             " again: write each index once; a mask must hold booleans.");
    named[result[i]] = true;
  }
  return result;
}

// The features that the words of keep= name.
inline Kept kept_features(const Arguments& a)
{
  Kept kept;
  for(const py::handle& word : a["features"]) {
    try {
      kept.take("keep", word.cast<std::string>());
    } catch(const std::runtime_error& error) {
      refuse(error.what());
    }
    if(kept.seams || !kept.files.empty())
      refuse("keep has " + shown(word) +
             ", it must be 'border', 'sharp:ANGLE', indices, booleans, or a list of these.");
  }
  return kept;
}

#endif // SPECTRAL_PYTHON_KEPT_H
