// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_MATCHING_ARGUMENTS_H
#define SPECTRAL_EXAMPLES_MATCHING_MATCHING_ARGUMENTS_H

#include "../io/command_line.h"
#include "../io/program.h"
#include "../io/text_lines.h"
#include "matcher.h"

#include <boost/program_options.hpp>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// The command line of shape_matching.
struct Matching_arguments
{
  std::string X, Y, output, report, landmarks, ground_truth; // empty: not wanted
  std::string proxies = "spectral", mass = "averaged", operators = "fitted";
  long vertices = 600, eigenvectors = 100, initial_modes = 20, filter_iterations = 5, fine_iterations = 18;
  long samples = 300;
  double local_weight = 4;
  int threads = all_threads();
  bool quiet = false, repair = false, strict = false;
  std::string command, help;

  std::vector<Proxy_kind> kinds() const
  {
    std::vector<Proxy_kind> result;
    std::istringstream stream(proxies);
    for(std::string name; std::getline(stream, name, ',');) {
      const Proxy_kind all[] = {Proxy_kind::spectral, Proxy_kind::garland_heckbert, Proxy_kind::none};
      const auto kind =
          std::find_if(std::begin(all), std::end(all), [&](Proxy_kind k) { return name == proxy_name(k); });
      if(kind == std::end(all) || std::find(result.begin(), result.end(), *kind) != result.end())
        throw std::runtime_error("--proxy has '" + name +
                                 "', name each of spectral, garland_heckbert and none at most once.");
      result.push_back(*kind);
    }
    if(result.empty())
      throw std::runtime_error("--proxy names no proxy: spectral, garland_heckbert or none.");
    return result;
  }
};

namespace matching_arguments_internal {

inline boost::program_options::options_description described(Matching_arguments& a)
{
  namespace po = boost::program_options;
  const auto text = [](std::string& value, const char* name) { return po::value(&value)->value_name(name); };
  const auto number = [](long& value, const char* name) {
    return po::value(&value)->value_name(name)->default_value(value);
  };
  po::options_description options(
      "shape_matching X Y --output map.txt [options]\n\n"
      "Finds for each vertex of the mesh X the vertex of the mesh Y that corresponds to it: simplifies both "
      "to\n"
      "the same number of vertices, matches these (functional map from signatures, ZoomOut, Product "
      "Manifold\n"
      "Filter) and lifts the functional map to X and Y (section 5.2 of Lescoat et al. 2020).\n\nOptions",
      100, 60);
  auto add = options.add_options();
  add("help", "show this text");
  add("vertices", number(a.vertices, "N"), "of the simplified meshes");
  add("landmarks", text(a.landmarks, "file"),
      "pairs of vertices that correspond, one of X and one of Y on each line, counted from 0");
  add("output", text(a.output, "map.txt"),
      "write for each vertex of X the vertex of Y, one per line, -1 for one that no face uses");
  add("report", text(a.report, "report.html"), "write a page with pictures, times and errors");
  add("ground-truth", text(a.ground_truth, "map.txt"),
      "the true map, as of --output: geodesic errors are measured");
  add("proxy", text(a.proxies, "NAME,...")->default_value(a.proxies),
      "how to simplify: spectral, garland_heckbert or none (no filter then); several are compared, the first "
      "is "
      "written");
  add("eigenvectors", number(a.eigenvectors, "K"), "of all meshes; N should be at least 3 K");
  add("initial", number(a.initial_modes, "k"), "modes of the functional map from signatures");
  add("mass", text(a.mass, "lumped|averaged")->default_value(a.mass), "the mass matrix");
  add("operators", text(a.operators, "fitted|mesh")->default_value(a.operators),
      "of the simplified meshes: fitted to the spectra of X and Y, or their own");
  add("filter-iterations", number(a.filter_iterations, "I"),
      "of the Product Manifold Filter; 0 leaves it out");
  add("fine-iterations", number(a.fine_iterations, "I"),
      "of bending X onto Y in space, at the end; 0 leaves it out");
  add("local-weight", po::value(&a.local_weight)->value_name("w")->default_value(a.local_weight),
      "of curvature in these, at most; 0: positions alone");
  add("samples", number(a.samples, "S"), "how many vertices of X errors are measured at");
  add("threads", po::value(&a.threads)->value_name("T")->default_value(a.threads),
      "all cores by default; the result does not depend on it");
  add("repair", po::bool_switch(&a.repair), "change meshes that cannot be used, as spectral_simplify does");
  add("strict", po::bool_switch(&a.strict),
      "change nothing of them, not even what leaves the surface as it is");
  add("quiet", po::bool_switch(&a.quiet), "no table");
  return options;
}

inline void check(const Matching_arguments& a)
{
  const auto at_least = [](const char* name, long value, long least) {
    if(value < least)
      throw std::runtime_error(std::string("--") + name + " is " + std::to_string(value) +
                               ", it must be at least " + std::to_string(least) + ".");
  };
  if(a.X.empty() || a.Y.empty())
    throw std::runtime_error(
        "two meshes are needed: shape_matching X Y --output map.txt; --help shows everything.");
  if(a.output.empty() && a.report.empty())
    throw std::runtime_error("nothing is to be written: give --output, --report or both.");
  at_least("vertices", a.vertices, 4);
  at_least("eigenvectors", a.eigenvectors, 10);
  at_least("initial", a.initial_modes, 4);
  at_least("filter-iterations", a.filter_iterations, 0);
  at_least("fine-iterations", a.fine_iterations, 0);
  at_least("samples", a.samples, 1);
  if(!(a.local_weight >= 0 && a.local_weight <= 100))
    throw std::runtime_error("--local-weight is " + std::to_string(a.local_weight) +
                             ", it must lie between 0 and 100.");
  at_least("threads", a.threads, 1);
  if(a.initial_modes > 60)
    throw std::runtime_error("--initial is " + std::to_string(a.initial_modes) +
                             ", it must be at most 60: memory grows with its fourth power.");
  if(a.eigenvectors > a.vertices)
    throw std::runtime_error("--eigenvectors is " + std::to_string(a.eigenvectors) +
                             ", it must be at most --vertices, which is " + std::to_string(a.vertices) + ".");
  check_choice("--mass", a.mass, {"lumped", "averaged"});
  check_choice("--operators", a.operators, {"fitted", "mesh"});
  a.kinds();
}

} // namespace matching_arguments_internal

// Throws std::runtime_error with one sentence for what cannot be meant.
inline Matching_arguments parse_matching_arguments(int argc, const char* const* argv)
{
  namespace po = boost::program_options;
  Matching_arguments a;
  a.command = command_line("shape_matching", argc, argv);
  po::variables_map values;
  a.help = read_command_line(argc, argv, matching_arguments_internal::described(a),
                             {{"X", &a.X}, {"Y", &a.Y}}, "two meshes", values);
  if(!a.help.empty())
    return a;
  matching_arguments_internal::check(a);
  return a;
}

// Reads lines of one vertex for each of `sizes`, which say how many vertices there are, or of -1 where `none` is allowed.
// Throws at the first line that is wrong.
inline std::vector<std::vector<Eigen::Index>>
read_vertex_lines(const std::string& path, const std::vector<std::size_t>& sizes, const bool none)
{
  std::ifstream stream(path);
  if(!stream)
    throw std::runtime_error("cannot read '" + path + "': there is no such file, or it may not be read.");
  std::vector<std::vector<Eigen::Index>> lines;
  std::size_t number = 0;
  for(std::string line; std::getline(stream, line);) {
    ++number;
    if(line.find_first_not_of(" \t\r") == std::string::npos)
      continue;
    std::istringstream numbers(line);
    std::vector<Eigen::Index> row(sizes.size());
    bool good = true;
    for(std::size_t c = 0; c < sizes.size(); ++c)
      good = good && numbers >> row[c] && row[c] >= (none ? -1 : 0) &&
             row[c] < static_cast<Eigen::Index>(sizes[c]);
    std::string rest;
    if(!good || numbers >> rest)
      throw std::runtime_error("'" + path + "' has " + quoted(line) + " in line " + std::to_string(number) +
                               ", where it must have " + (sizes.size() == 1 ? "one vertex" : "two vertices") +
                               ", counted from 0 and below the number of vertices of the mesh.");
    lines.push_back(row);
  }
  if(lines.empty())
    throw std::runtime_error("'" + path + "' names no vertex.");
  return lines;
}

#endif // SPECTRAL_EXAMPLES_MATCHING_MATCHING_ARGUMENTS_H
