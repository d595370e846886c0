// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_COMPARE_COMPARE_ARGUMENTS_H
#define SPECTRAL_EXAMPLES_COMPARE_COMPARE_ARGUMENTS_H

#include "../io/command_line.h"
#include "../io/program.h"

#include <boost/program_options.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
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
  std::string fine;                                          // MESH or --fine
  std::string vertices;                                      // N[,N2...], each a number or a percentage
  std::string coarse, operator_file, mass_file, restriction; // anybody's result, the only one
  std::vector<Rival> rivals;                                 // with that one
  std::string masses = "lumped,averaged", only, without;
  std::string report, json, coloured;
  long eigenvectors = 100, sources = 20, seed = 1;
  int threads = all_threads();
  bool quiet = false, repair = false, strict = false;
  std::string help; // the text, if it was asked for
};

namespace compare_arguments_internal {

inline boost::program_options::options_description described(Compare_arguments& a)
{
  namespace po = boost::program_options;
  const auto text = [](std::string& value, const char* name) { return po::value(&value)->value_name(name); };
  po::options_description options(
      "spectral_compare MESH --vertices N[,N2,...] [options]\n"
      "spectral_compare --fine A --coarse B [--restriction P.mtx] [options]\n"
      "spectral_compare --fine A --operator L.mtx --mass M.mtx --restriction P.mtx [options]\n"
      "spectral_compare MESH [--vertices N[,N2,...]] --rival NAME=B[,P.mtx] [options]\n\n"
      "Simplifies MESH in every way there is, here and in CGAL, and judges each result by the same figures:\n"
      "norms of functional maps, eigenvalues, distances, shape, time. The second form judges a mesh that\n"
      "another tool made of A, the third an operator that has no mesh (L positive semidefinite), the fourth "
      "any\n"
      "number of both, beside the simplifiers if there is --vertices.\n\nOptions",
      100, 60);
  auto add = options.add_options();
  add("help", "show this text");
  add("vertices", text(a.vertices, "N,..."),
      "sizes of the simplified meshes; 3% is a part of MESH's vertices");
  add("eigenvectors", po::value(&a.eigenvectors)->value_name("K")->default_value(a.eigenvectors),
      "how many to keep and to judge by, the constant one included");
  add("judge", text(a.masses, "MASS,...")->default_value(a.masses),
      "the masses to judge in: lumped, averaged or both; also those of the spectral metric");
  add("only", text(a.only, "TEXT"), "only simplifiers with TEXT in their names");
  add("without", text(a.without, "TEXT"), "no simplifiers with TEXT in their names");
  add("report", text(a.report, "report.html"), "write a page with tables and figures that any browser shows");
  add("json", text(a.json, "out.json"), "write all figures for programs");
  add("coloured", text(a.coloured, "DIR"),
      "write the fine and the coarse meshes as PLY with eigenvectors, hks and a distance as properties of "
      "vertices");
  add("sources", po::value(&a.sources)->value_name("S")->default_value(a.sources),
      "how many random vertices distances are measured from");
  add("seed", po::value(&a.seed)->value_name("X")->default_value(a.seed), "of these vertices");
  add("threads", po::value(&a.threads)->value_name("T")->default_value(a.threads),
      "for the spectral rows, all cores by default; CGAL's simplifiers have one");
  add("fine", text(a.fine, "A"), "the fine mesh, the same as MESH");
  add("coarse", text(a.coarse, "B"), "judge this mesh");
  add("operator", text(a.operator_file, "L.mtx"), "judge this operator (Matrix Market)");
  add("mass", text(a.mass_file, "M.mtx"), "with this mass matrix");
  add("restriction", text(a.restriction, "P.mtx"),
      "and this restriction, coarse x fine; without it, closest points");
  add("rival", po::value<std::vector<std::string>>()->value_name("NAME=B[,P.mtx]"),
      "judge this mesh, too, with the P of the closest points and its own; may be given several times. It "
      "stands at the nearest of the sizes of --vertices");
  add("rival-operators", po::value<std::vector<std::string>>()->value_name("NAME=L.mtx,M.mtx,P.mtx"),
      "the same for an operator with its mass and its restriction");
  add("repair", po::bool_switch(&a.repair), "change meshes that cannot be used, as spectral_simplify does");
  add("strict", po::bool_switch(&a.strict),
      "change nothing of them, not even what leaves the surface as it is");
  add("quiet", po::bool_switch(&a.quiet), "no table, no progress bar");
  return options;
}

inline void check(const Compare_arguments& a)
{
  const auto refuse = [](const std::string& sentence) { throw std::runtime_error(sentence); };
  if(a.fine.empty())
    refuse("a mesh is needed: spectral_compare MESH --vertices N; --help shows everything.");
  if(!a.coarse.empty() && !a.operator_file.empty())
    refuse("--coarse and --operator are two results: judge one at a time.");
  const bool judges_one = !a.coarse.empty() || !a.operator_file.empty();
  if(judges_one && !a.vertices.empty())
    refuse("--vertices asks for simplifications, --coarse and --operator for a judgement: give one of them, "
           "or --rival.");
  if(!judges_one && a.rivals.empty() && a.vertices.empty())
    refuse("--vertices is missing: say how many vertices the simplified meshes are to have.");
  if(!a.operator_file.empty() && (a.mass_file.empty() || a.restriction.empty()))
    refuse("--operator needs --mass and --restriction as well.");
  if(a.operator_file.empty() && !a.mass_file.empty())
    refuse("--mass belongs to --operator; to choose the mass of the judgement use --judge.");
  if(a.coarse.empty() && a.operator_file.empty() && !a.restriction.empty())
    refuse("--restriction belongs to --coarse or --operator.");
  if(!a.coloured.empty() && a.vertices.empty() && a.coarse.empty() &&
     std::all_of(a.rivals.begin(), a.rivals.end(), [](const Rival& r) { return r.mesh.empty(); }))
    refuse("--coloured needs a coarse mesh, an operator has none.");
  check_choice("--judge", a.masses, {"lumped", "averaged", "lumped,averaged", "averaged,lumped"});
  if(a.eigenvectors < 2)
    refuse("--eigenvectors is " + std::to_string(a.eigenvectors) + ", it must be at least 2.");
  if(a.sources < 1)
    refuse("--sources is " + std::to_string(a.sources) + ", it must be at least 1.");
  if(a.threads < 1)
    refuse("--threads is " + std::to_string(a.threads) + ", it must be at least 1.");
}

// NAME=FILE,... with at least and at most so many files.
inline std::vector<std::string> parts_of_rival(const std::string& option, const std::string& text,
                                               const std::string& form, std::size_t least, std::size_t most)
{
  const std::size_t equals = text.find('=');
  std::vector<std::string> parts{text.substr(0, equals)};
  if(equals != std::string::npos) {
    std::istringstream files(text.substr(equals + 1) + ",");
    for(std::string file; std::getline(files, file, ',');)
      parts.push_back(file);
  }
  if(std::find(parts.begin(), parts.end(), "") != parts.end() || parts.size() < 1 + least ||
     parts.size() > 1 + most)
    throw std::runtime_error(option + " is '" + text + "', it must be " + form + ".");
  return parts;
}

inline std::vector<Rival> rivals(const boost::program_options::variables_map& values)
{
  using Texts = std::vector<std::string>;
  std::vector<Rival> result;
  if(values.count("rival"))
    for(const std::string& text : values["rival"].as<Texts>()) {
      Texts parts = parts_of_rival("--rival", text, "NAME=MESH or NAME=MESH,P.mtx", 1, 2);
      parts.resize(3);
      result.push_back({"--rival " + parts[0], parts[0], parts[1], {}, {}, parts[2]});
    }
  if(values.count("rival-operators"))
    for(const std::string& text : values["rival-operators"].as<Texts>()) {
      const Texts parts = parts_of_rival("--rival-operators", text, "NAME=L.mtx,M.mtx,P.mtx", 3, 3);
      result.push_back({"--rival-operators " + parts[0], parts[0], {}, parts[1], parts[2], parts[3]});
    }
  return result;
}

} // namespace compare_arguments_internal

// Throws std::runtime_error with one sentence for what cannot be used.
inline Compare_arguments parse_compare_arguments(int argc, const char* const* argv)
{
  namespace po = boost::program_options;
  Compare_arguments a;
  po::variables_map values;
  a.help = read_command_line(argc, argv, compare_arguments_internal::described(a), {{"fine", nullptr}},
                             "one MESH", values);
  if(!a.help.empty())
    return a;
  a.rivals = compare_arguments_internal::rivals(values);
  compare_arguments_internal::check(a);
  const std::string& only = a.coarse.empty() ? a.operator_file : a.coarse;
  if(!only.empty())
    a.rivals.push_back({{},
                        std::filesystem::path(only).filename().string(),
                        a.coarse,
                        a.operator_file,
                        a.mass_file,
                        a.restriction});
  return a;
}

// The sizes of --vertices for a mesh of n vertices.
inline std::vector<std::size_t> target_sizes(const Compare_arguments& a, std::size_t n)
{
  std::vector<std::size_t> result;
  std::istringstream list(a.vertices);
  std::string item;
  while(std::getline(list, item, ',')) {
    char* end = nullptr;
    double value = std::strtod(item.c_str(), &end);
    const bool percent = *end == '%';
    if(item.empty() || *(percent ? end + 1 : end) != '\0' || !(value > 0) ||
       (!percent && value != std::floor(value)))
      throw std::runtime_error("--vertices has '" + item +
                               "' in it, it must be a list of numbers or percentages.");
    if(percent)
      value = std::round(value / 100 * static_cast<double>(n));
    if(value < 4 || value > static_cast<double>(n))
      throw std::runtime_error("--vertices asks for " + item + ", but '" + a.fine + "' has " +
                               std::to_string(n) + " vertices and fewer than 4 are no mesh.");
    const std::size_t size = static_cast<std::size_t>(value);
    if(std::find(result.begin(), result.end(), size) == result.end())
      result.push_back(size);
  }
  return result;
}

#endif // SPECTRAL_EXAMPLES_COMPARE_COMPARE_ARGUMENTS_H
