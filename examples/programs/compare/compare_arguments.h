// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_COMPARE_COMPARE_ARGUMENTS_H
#define SPECTRAL_EXAMPLES_COMPARE_COMPARE_ARGUMENTS_H

#include "../io/command_line.h"
#include "../io/program.h"
#include "../io/vertex_target.h"

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

// A result of another program: a mesh, or an operator that has none.
struct Rival
{
  std::string option; // that named it, where errors have to say which of several it was
  std::string name, mesh, operator_file, mass_file, restriction; // empty: there is none
};

// The command line of spectral_compare.
struct Compare_arguments
{
  std::string mesh, vertices; // N[,N2...], each a number or a percentage
  std::vector<Vertex_target> targets;
  std::vector<Rival> rivals;
  std::string masses = "lumped,averaged", without;
  std::vector<std::string> only; // empty: all
  std::string report, json, coloured;
  long eigenvectors = 100, sources = 20, seed = 1;
  int threads = all_threads();
  bool quiet = false, repair = false, strict = false;
  std::vector<std::string> rival_meshes, rival_operators; // as they were typed
  std::string help;                                       // the text, if it was asked for
};

namespace compare_arguments_internal {

inline Command_line described(Compare_arguments& a)
{
  Command_line line(
      "spectral_compare MESH --vertices N[,N2,...] [options]\n"
      "spectral_compare MESH --rival NAME=B[,P.mtx] [options]\n"
      "spectral_compare MESH --rival-operators NAME=L.mtx,M.mtx,P.mtx [options]",
      "Simplifies MESH in every way there is, here and in CGAL, and judges each result by the same "
      "figures:\n"
      "norms of functional maps, eigenvalues, distances, shape, time. Beside them, or without "
      "--vertices\n"
      "alone, it judges what other tools made of MESH: meshes, or operators without one.");
  line.argument(a.mesh);
  line.group("Size");
  line.option("vertices", a.vertices, "N|P%,...",
              "sizes of the simplified meshes, such as 600 or 3%");
  line.group("Quality");
  line.option("eigenvectors", a.eigenvectors, "K",
              "how many to keep and to judge by, the constant one included");
  line.choice("judge", a.masses, {"lumped,averaged", "lumped", "averaged", "consistent"},
              "the masses to judge in, and of the spectral metric");
  line.option("sources", a.sources, "S", "how many random vertices distances are measured from");
  line.option("seed", a.seed, "X", "of these vertices, and of the random mixtures that best sees");
  line.group("Simplifiers and rivals");
  line.option("only", a.only, "TEXT",
              "only simplifiers with TEXT in their names; may be given several times, for those "
              "with any of them");
  line.option("without", a.without, "TEXT", "no simplifiers with TEXT in their names");
  line.option(
      "rival", a.rival_meshes, "NAME=B[,P.mtx]",
      "judge this mesh, with the P of the closest points and with its own, coarse x fine; may be "
      "given several times. It is listed at the nearest size of --vertices. A rival that is "
      "refused is listed with the reason, and the exit status is then 1");
  line.option(
      "rival-operators", a.rival_operators, "NAME=L.mtx,M.mtx,P.mtx",
      "the same for an operator (Matrix Market, L positive semidefinite) with its mass and its "
      "restriction");
  line.group("Input");
  line.flag("repair", a.repair, "change meshes that cannot be used, as spectral_simplify does");
  line.strict(a.strict);
  line.group("Outputs");
  line.option("report", a.report, "FILE.html", "a page with tables and figures");
  line.option("json", a.json, "FILE", "all figures for programs");
  line.option("coloured", a.coloured, "DIR",
              "the fine and the coarse meshes as PLY with eigenvectors, hks and a distance as "
              "properties of "
              "vertices");
  line.group("Run");
  line.threads(a.threads);
  line.flag("quiet", a.quiet, "no table, no progress bar");
  return line;
}

inline void check(const Compare_arguments& a)
{
  const auto refuse = [](const std::string& sentence) { throw std::runtime_error(sentence); };
  if(a.mesh.empty())
    refuse("a mesh is needed: spectral_compare MESH --vertices N; --help shows every option.");
  if(a.rivals.empty() && a.vertices.empty())
    refuse("--vertices is missing: say how many vertices the simplified meshes are to have.");
  if(std::find(a.only.begin(), a.only.end(), "") != a.only.end())
    refuse("--only has an empty value: say which, or leave it out.");
  if(a.vertices.empty() && !(a.only.empty() && a.without.empty()))
    refuse("--only and --without choose among simplifiers: say with --vertices how far these go, "
           "or leave "
           "them out.");
  if(!a.coloured.empty() && a.vertices.empty() &&
     std::all_of(a.rivals.begin(), a.rivals.end(), [](const Rival& r) { return r.mesh.empty(); }))
    refuse("--coloured needs a coarse mesh, an operator has none.");
  if(a.eigenvectors < 3) // distances take two eigenvalues that are not 0
    refuse("--eigenvectors is " + std::to_string(a.eigenvectors) + ", it must be at least 3.");
  if(a.sources < 1)
    refuse("--sources is " + std::to_string(a.sources) + ", it must be at least 1.");
}

inline std::vector<Rival> rivals(const Compare_arguments& a)
{
  std::vector<Rival> result;
  for(const std::string& text : a.rival_meshes) {
    std::vector<std::string> parts =
        named_files("--rival", text, "NAME=MESH or NAME=MESH,P.mtx", 1, 2);
    parts.resize(3);
    result.push_back({"--rival " + parts[0], parts[0], parts[1], {}, {}, parts[2]});
  }
  for(const std::string& text : a.rival_operators) {
    const std::vector<std::string> parts =
        named_files("--rival-operators", text, "NAME=L.mtx,M.mtx,P.mtx", 3, 3);
    result.push_back({"--rival-operators " + parts[0], parts[0], {}, parts[1], parts[2], parts[3]});
  }
  return result;
}

} // namespace compare_arguments_internal

// Throws std::runtime_error with one sentence for what cannot be used.
inline Compare_arguments parse_compare_arguments(int argc, const char* const* argv)
{
  Compare_arguments a;
  a.help = compare_arguments_internal::described(a).read(argc, argv);
  if(!a.help.empty())
    return a;
  if(!a.vertices.empty())
    a.targets = parsed_vertex_targets("--vertices", a.vertices);
  a.rivals = compare_arguments_internal::rivals(a);
  compare_arguments_internal::check(a);
  return a;
}

// The sizes of --vertices for a mesh of n vertices, each once; `has`: how many it has, in words.
inline std::vector<std::size_t> target_sizes(const Compare_arguments& a, const std::size_t n,
                                             const std::string& has)
{
  std::vector<std::size_t> result;
  for(const Vertex_target& target : a.targets) {
    const std::size_t size = target.of(n);
    if(size < 4 || size > n)
      throw std::runtime_error("--vertices asks for " + std::to_string(size) + ", but " + has +
                               "; fewer than 4 are no mesh.");
    if(std::find(result.begin(), result.end(), size) == result.end())
      result.push_back(size);
  }
  return result;
}

#endif // SPECTRAL_EXAMPLES_COMPARE_COMPARE_ARGUMENTS_H
