// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_MATCHING_ARGUMENTS_H
#define SPECTRAL_EXAMPLES_MATCHING_MATCHING_ARGUMENTS_H

#include "../io/command_line.h"
#include "../io/program.h"
#include "../io/text_lines.h"
#include "../io/vertex_target.h"
#include "../option_words.h"
#include "matcher.h"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

constexpr Proxy_kind all_proxies[] = {Proxy_kind::spectral, Proxy_kind::garland_heckbert,
                                      Proxy_kind::garland_heckbert_probabilistic, Proxy_kind::none};

inline std::string proxy_names()
{
  std::vector<std::string> names;
  for(const Proxy_kind kind : all_proxies)
    names.push_back(proxy_name(kind));
  return joined(names);
}

// Coarse meshes of X and Y that another program made.
struct Foreign_proxy
{
  std::string name, X, Y;
};

// The command line of shape_matching.
struct Matching_arguments
{
  std::string X, Y, output, report, json, landmarks, ground_truth; // empty: not wanted
  std::string proxies, preset = "best", mass, operators = "fitted",
                       matcher = "product_manifold_filter"; // mass empty: as the preset has it
  std::string vertices = "600";                             // as it was typed
  Vertex_target target;
  long eigenvectors = 100, initial_modes = 20, filter_iterations = 5, fine_iterations = 18;
  long samples = 300;
  long pre_simplify = 0; // 0: never
  double local_weight = 4;
  int threads = all_threads();
  bool quiet = false, repair = false, strict = false;
  std::vector<std::string> proxy_meshes; // as they were typed
  std::string command, help;

  std::vector<Proxy_kind> kinds() const
  {
    std::vector<Proxy_kind> result;
    std::istringstream stream(proxies.empty() && proxy_meshes.empty() ? "spectral" : proxies);
    for(std::string name; std::getline(stream, name, ',');) {
      const auto kind = std::find_if(std::begin(all_proxies), std::end(all_proxies),
                                     [&](Proxy_kind k) { return name == proxy_name(k); });
      if(kind == std::end(all_proxies) ||
         std::find(result.begin(), result.end(), *kind) != result.end())
        throw std::runtime_error("--proxy has '" + name + "', name each of " + proxy_names() +
                                 " at most once.");
      result.push_back(*kind);
    }
    return result;
  }

  std::vector<Foreign_proxy> foreign() const
  {
    std::vector<Foreign_proxy> result;
    for(const std::string& text : proxy_meshes) {
      const std::vector<std::string> parts =
          named_files("--proxy-meshes", text, "NAME=X_PROXY,Y_PROXY, a name and two meshes", 2, 2);
      const bool taken = std::any_of(std::begin(all_proxies), std::end(all_proxies),
                                     [&](Proxy_kind k) { return parts[0] == proxy_name(k); }) ||
                         std::any_of(result.begin(), result.end(),
                                     [&](const Foreign_proxy& f) { return parts[0] == f.name; });
      if(taken)
        throw std::runtime_error("--proxy-meshes " + parts[0] +
                                 ": there is another proxy of this name, choose another name.");
      result.push_back({parts[0], parts[1], parts[2]});
    }
    return result;
  }
};

namespace matching_arguments_internal {

inline Command_line described(Matching_arguments& a)
{
  Command_line line("shape_matching X Y --output map.txt [options]",
                    "Finds for each vertex of the mesh X the vertex of the mesh Y that corresponds "
                    "to it. Both are\n"
                    "simplified to the same number of vertices and matched (functional map from "
                    "signatures, ZoomOut,\n"
                    "Product Manifold Filter or BCICP). The functional map is then lifted to X and "
                    "Y (section 5.2 of\n"
                    "Lescoat et al. 2020).");
  line.argument(a.X);
  line.argument(a.Y);
  line.group("Size");
  line.option("vertices", a.vertices, "N|P%", "of both simplified meshes; 3% is a part of X's");
  line.option(
      "pre-simplify", a.pre_simplify, "N0",
      "first reduce larger X and Y to this number by quadrics alone, match the reduced meshes, and "
      "carry the map to X and Y by bending one onto the other; for meshes of 100,000 vertices and "
      "more; 0: never");
  line.group("Quality");
  line.option("eigenvectors", a.eigenvectors, "K", "of all meshes; best N >= 3 K");
  line.choice("preset", a.preset, {"best", "paper"},
              "how the simplified meshes are made, without relocation");
  line.option("landmarks", a.landmarks, "FILE",
              "pairs of vertices that correspond, one of X and one of Y on each line, from 0");
  line.group("Input");
  line.flag("repair", a.repair, "change meshes that cannot be used, as spectral_simplify does");
  line.strict(a.strict);
  line.group("Outputs");
  line.option("output", a.output, "map.txt",
              "for each vertex of X the vertex of Y, one per line, from 0; -1: no face uses it");
  line.option("report", a.report, "FILE.html", "a page with pictures, times and errors");
  line.option("json", a.json, "FILE", "seconds and memory of each stage, and errors, for programs");
  line.option("ground-truth", a.ground_truth, "map.txt",
              "the true map, in the format of --output: geodesic errors are measured");
  line.group("Run");
  line.threads(a.threads);
  line.flag("quiet", a.quiet, "no table");
  line.advanced_group("Stages of the match (advanced)");
  line.option("proxy", a.proxies, "NAME,...",
              "how to simplify, one or several of " + proxy_names() +
                  " (no matcher then). The first is written; spectral, if no proxy is given");
  line.option(
      "proxy-meshes", a.proxy_meshes, "NAME=X_PROXY,Y_PROXY",
      "match over these coarse meshes of X and Y as well, from any source, restricted to closest "
      "points; may be given several times. Without --proxy match over these alone");
  line.choice("mass", a.mass, words_of(mass_words),
              "the mass matrix (best: averaged, paper: lumped)");
  line.choice("operators", a.operators, {"fitted", "mesh"},
              "of the simplified meshes: fitted to the spectra of X and Y, or their own");
  line.option("initial", a.initial_modes, "k", "modes of the functional map from signatures");
  line.choice(
      "matcher", a.matcher, {"product_manifold_filter", "bcicp"},
      "what makes the map between the simplified meshes bijective: assignments, or bijective and "
      "continuous ICP (Ren et al. 2018)");
  line.option("filter-iterations", a.filter_iterations, "I", "of the matcher; 0 leaves it out");
  line.option("fine-iterations", a.fine_iterations, "I",
              "iterations that bend X onto Y in space, at the end; 0 leaves them out");
  line.option("local-weight", a.local_weight, "w",
              "largest weight of curvature in these iterations; 0: positions alone");
  line.option("samples", a.samples, "S", "how many vertices of X errors are measured at");
  return line;
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
        "two meshes are needed: shape_matching X Y --output map.txt; --help shows the common "
        "options, --help advanced every one.");
  if(a.output.empty() && a.report.empty() && a.json.empty())
    throw std::runtime_error(
        "nothing is to be written: give --output, --report, --json or several.");
  at_least("pre-simplify", a.pre_simplify, 0);
  at_least("eigenvectors", a.eigenvectors, 10);
  at_least("initial", a.initial_modes, 4);
  at_least("filter-iterations", a.filter_iterations, 0);
  at_least("fine-iterations", a.fine_iterations, 0);
  if(a.pre_simplify > 0 && a.fine_iterations == 0)
    throw std::runtime_error(
        "--pre-simplify needs --fine-iterations of at least 1: what bends X onto Y carries the "
        "map to the vertices that were left out.");
  if(a.pre_simplify > 0 && a.pre_simplify <= a.eigenvectors)
    throw std::runtime_error("--pre-simplify is " + std::to_string(a.pre_simplify) +
                             ", it must be above --eigenvectors, which is " +
                             std::to_string(a.eigenvectors) + ".");
  at_least("samples", a.samples, 1);
  if(!(a.local_weight >= 0 && a.local_weight <= 100))
    throw std::runtime_error("--local-weight is " + std::to_string(a.local_weight) +
                             ", it must lie between 0 and 100.");
  if(a.initial_modes > 60)
    throw std::runtime_error("--initial is " + std::to_string(a.initial_modes) +
                             ", it must be at most 60: memory grows with its fourth power.");
  const std::vector<Proxy_kind> kinds = a.kinds();
  a.foreign();
  if(a.matcher == "bcicp" && std::find(kinds.begin(), kinds.end(), Proxy_kind::none) != kinds.end())
    throw std::runtime_error(
        "--matcher bcicp refines the match of simplified meshes, and --proxy has 'none'.");
}

} // namespace matching_arguments_internal

// Throws std::runtime_error with one sentence for what cannot be meant.
inline Matching_arguments parse_matching_arguments(int argc, const char* const* argv)
{
  Matching_arguments a;
  a.command = command_line("shape_matching", argc, argv);
  a.help = matching_arguments_internal::described(a).read(argc, argv);
  if(!a.help.empty())
    return a;
  a.target = parsed_vertex_target("--vertices", a.vertices);
  matching_arguments_internal::check(a);
  return a;
}

// The number of vertices of the simplified meshes, for meshes of n_X and n_Y vertices; 0 where
// there are none.
inline std::size_t proxy_size(const Matching_arguments& a, const std::size_t n_X,
                              const std::size_t n_Y)
{
  const std::vector<Proxy_kind> kinds = a.kinds();
  if(std::all_of(kinds.begin(), kinds.end(), [](Proxy_kind k) { return k == Proxy_kind::none; }))
    return 0;
  const std::size_t N = a.target.of(n_X);
  const auto refuse = [N](const std::string& why) {
    throw std::runtime_error("--vertices asks for " + std::to_string(N) + ", but " + why + ".");
  };
  if(N < 4 || static_cast<long>(N) < a.eigenvectors)
    refuse("it must be at least 4, and --eigenvectors, which is " + std::to_string(a.eigenvectors));
  if(a.pre_simplify > 0 && static_cast<long>(N) > a.pre_simplify)
    refuse("--pre-simplify leaves " + std::to_string(a.pre_simplify) + " vertices");
  for(const auto& [path, n] : {std::make_pair(a.X, n_X), std::make_pair(a.Y, n_Y)})
    if(n < N)
      refuse("'" + path + "' has " + std::to_string(n) + " vertices");
  return N;
}

#endif // SPECTRAL_EXAMPLES_MATCHING_MATCHING_ARGUMENTS_H
