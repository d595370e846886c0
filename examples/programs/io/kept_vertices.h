// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_KEPT_VERTICES_H
#define SPECTRAL_EXAMPLES_IO_KEPT_VERTICES_H

#include "mesh_io.h"

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Feature_vertices_map.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

// What --keep, and keep= in Python, say: words for features, and files.
struct Kept
{
  bool border = false, seams = false;
  std::optional<double> sharp; // an angle in degrees
  std::vector<std::string> files;

  bool has_features() const { return border || sharp; }

  // Takes one word; `option` is its name in an error.
  void take(const std::string& option, const std::string& word)
  {
    if(word == "border")
      border = true;
    else if(word == "seams")
      seams = true;
    else if(word == "sharp" || word.rfind("sharp:", 0) == 0) {
      const std::string number = word.size() > 6 ? word.substr(6) : "";
      char* end = nullptr;
      const double degrees = std::strtod(number.c_str(), &end);
      if(number.empty() || *end != '\0' || !(degrees > 0 && degrees <= 180))
        throw std::runtime_error(
            option + " has '" + word +
            "', an angle must follow, above 0 and up to 180 degrees, such as sharp:60.");
      if(sharp && *sharp != degrees)
        throw std::runtime_error(option + " names two angles: choose one.");
      sharp = degrees;
    } else if(word.empty())
      throw std::runtime_error(option + " has an empty word: separate words by one comma.");
    else
      files.push_back(word);
  }
};

// Words separated by commas; what is a file as a whole is one, whatever is in its name.
inline Kept parsed_keep(const std::string& list)
{
  Kept kept;
  if(std::filesystem::exists(list)) {
    kept.files.push_back(list);
    return kept;
  }
  std::istringstream words(list + ",");
  for(std::string word; std::getline(words, word, ',');)
    kept.take("--keep", word);
  for(const std::string& file : kept.files)
    if(!std::filesystem::exists(file))
      throw std::runtime_error("--keep names '" + file +
                               "', which is no file: give one, or border, sharp:ANGLE or seams.");
  return kept;
}

// The vertices at borders and sharp edges, by their places in `vertices(mesh)`.
inline std::vector<std::size_t> feature_vertices(const Mesh& mesh, const Kept& kept)
{
  std::vector<std::size_t> result;
  if(!kept.has_features())
    return result;
  const CGAL::Surface_mesh_simplification::Feature_vertices_map<Mesh> is_feature(mesh, kept.border,
                                                                                 kept.sharp);
  std::size_t i = 0;
  for(const auto v : mesh.vertices()) {
    if(get(is_feature, v))
      result.push_back(i);
    ++i;
  }
  return result;
}

#endif // SPECTRAL_EXAMPLES_IO_KEPT_VERTICES_H
