// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_ARGUMENTS_H
#define SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_ARGUMENTS_H

#include "io/kept_vertices.h"
#include "io/mesh_io.h"
#include "io/operator_reader.h"
#include "io/program.h"
#include "io/vertex_target.h"
#include "option_words.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

// The exit status of a run whose result is written, but not what was to be said about it.
constexpr int evaluation_failed = 3;

// The command line of spectral_simplify.
struct Arguments
{
  std::string input, output;
  std::optional<Vertex_target> vertices, faces;
  std::optional<double> max_error;
  std::vector<std::size_t> levels; // descending, once the size of INPUT is known
  long eigenvectors = 100;
  std::optional<double> quadrics_above;
  std::optional<long> pre_simplify; // as the preset has it; 0: never
  std::string preset = "best";
  std::string boundary = "neumann";
  std::string operator_word = "cotangent";
  Operator_word operator_; // what it says
  // empty: as the preset has it
  std::string mass, placement, self_intersections, relocate, prefer;
  std::optional<double> shape; // the same
  int threads = all_threads();
  bool binary = false, preserve_border = false, evaluation = false, no_evaluation = false,
       quiet = false, repair = false, strict = false, intrinsic_delaunay = false,
       no_attributes = false;
  std::string restriction, prolongation, map, eigenpairs, json, report,
      repaired;                 // empty: not wanted
  std::string fit_operators;    // the same
  std::string fit_mass;         // empty: as the mass has it
  std::optional<int> fit_rings; // the same
  std::string signals, on_interrupt = "discard";
  double drop_debris = 0; // a share of the area
  Kept kept;
  std::vector<std::string> labels; // attributes whose numbers are labels
  std::string command;             // as it was typed
  std::string help;                // the text, if it was asked for

  // as they were typed
  std::string vertices_word, faces_word, levels_word, keep, labels_word, drop_debris_word;
  std::vector<Vertex_target> level_targets;

  bool wants_matrices() const
  {
    return !(restriction.empty() && prolongation.empty() && map.empty() && eigenpairs.empty() &&
             fit_operators.empty());
  }
};

namespace arguments_internal {

inline std::string shown(const double number)
{
  std::ostringstream text;
  text << number;
  return text.str();
}

// P% between 0 and 100, as a share.
inline double parsed_share(const std::string& option, const std::string& word)
{
  char* end = nullptr;
  const double percent = std::strtod(word.c_str(), &end);
  if(word.empty() || end == word.c_str() || std::string(end) != "%" ||
     !(percent > 0 && percent < 100))
    throw std::runtime_error(option + " is '" + word +
                             "', it must be a percentage above 0 and below 100, such as 0.1%.");
  return percent / 100;
}

inline void check(const Arguments& a)
{
  const auto refuse = [](const std::string& sentence) { throw std::runtime_error(sentence); };
  if(a.input.empty() || a.output.empty())
    refuse("INPUT and OUTPUT are needed: spectral_simplify INPUT OUTPUT --vertices N; --help shows "
           "the common options, --help advanced every one.");
  if(!a.vertices && !a.faces && !a.max_error && a.level_targets.empty())
    refuse("say how far to simplify: --vertices N, --vertices P%, --faces N, --levels N1,N2,... or "
           "--max-error E.");
  if(a.faces && (a.vertices || a.max_error))
    refuse(std::string("--faces and ") + (a.vertices ? "--vertices" : "--max-error") +
           " both say how far to simplify: leave one of them out.");
  if(a.max_error && !(*a.max_error > 0 && std::isfinite(*a.max_error)))
    refuse("--max-error is " + shown(*a.max_error) + ", it must be greater than 0.");
  if(a.eigenvectors < 1)
    refuse("--eigenvectors is " + std::to_string(a.eigenvectors) + ", it must be positive.");
  if(a.quadrics_above && !(*a.quadrics_above >= 1))
    refuse("--quadrics-above is " + shown(*a.quadrics_above) + ", it must be 1 or more.");
  if(a.pre_simplify && *a.pre_simplify < 0)
    refuse("--pre-simplify is " + std::to_string(*a.pre_simplify) + ", it must not be negative.");
  if(a.boundary == "dirichlet" && !a.fit_operators.empty())
    refuse("--fit-operators fits Laplacians whose rows sum to zero: leave it out with --boundary "
           "dirichlet.");
  if(a.intrinsic_delaunay &&
     (a.operator_word != "cotangent" || a.boundary != "neumann" || !a.signals.empty()))
    refuse(
        "--intrinsic-delaunay is for eigenvectors of the cotangent operator: leave out --operator, "
        "--boundary and --signals.");
  if(a.shape && !(*a.shape >= 0 && std::isfinite(*a.shape)))
    refuse("--shape is " + shown(*a.shape) + ", it must be a number from 0.");
  if(a.prefer == "shape" && (a.relocate == "none" || (a.relocate.empty() && a.preset == "paper")))
    refuse("--prefer shape is a matter of relocation, and nothing is relocated: leave it out, or "
           "add --relocate sampled.");
  if(a.binary && (a.relocate == "sampled" || (a.relocate.empty() && a.preset != "paper")))
    refuse("--binary asks for a restriction of ones and zeros, and relocation by the closest "
           "points makes "
           "another one: add --relocate none or --relocate carried.");
  if(a.no_evaluation && a.evaluation)
    refuse("--evaluation and --no-evaluation contradict each other: leave one of them out.");
  if(a.no_evaluation && !a.eigenpairs.empty())
    refuse("--eigenpairs writes what the evaluation computes: leave out --no-evaluation.");
  if(a.no_evaluation && !a.fit_operators.empty())
    refuse("--fit-operators uses what the evaluation computes: leave out --no-evaluation.");
  if(!a.fit_operators.empty() && !a.signals.empty())
    refuse("--fit-operators fits to eigenvectors: leave out --signals.");
  if(a.fit_operators.empty() && (!a.fit_mass.empty() || a.fit_rings))
    refuse("--fit-mass and --fit-rings belong to --fit-operators.");
  if(a.fit_rings && *a.fit_rings != 1 && *a.fit_rings != 2)
    refuse("--fit-rings is " + std::to_string(*a.fit_rings) + ", it must be 1 or 2.");
  if(a.no_evaluation && !a.report.empty())
    refuse("--report shows what the evaluation computes: leave out --no-evaluation.");
  if(a.kept.seams && a.no_attributes)
    refuse(
        "--keep seams writes a texture, --no-attributes leaves it behind: leave one of them out.");
  if(!a.labels.empty() && a.no_attributes)
    refuse("--labels names attributes, --no-attributes leaves them behind: leave one of them out.");
  if(a.strict && a.drop_debris > 0)
    refuse("--strict changes nothing of a mesh, --drop-debris leaves components out: give one of "
           "them.");
  if(!a.repaired.empty() && !a.repair)
    refuse("--repaired writes what --repair makes: add --repair.");
  if(!a.repaired.empty())
    mesh_format(a.repaired);
  mesh_format(a.input);
  if(a.kept.seams && mesh_format(a.output) != ".obj")
    refuse("--keep seams writes texture coordinates at the corners of faces, which only OBJ files "
           "have: "
           "choose .obj for '" +
           a.output + "'.");
  if(mesh_format(a.output) == ".stl" && a.wants_matrices())
    refuse("an STL file does not number its vertices, so that no matrix or map can refer to them: "
           "choose .off, "
           ".obj or .ply for '" +
           a.output + "'.");
}

} // namespace arguments_internal

// The arguments with what their words mean. Throws with one sentence for what cannot be meant.
inline Arguments understood(Arguments a)
{
  if(!a.vertices_word.empty())
    a.vertices = parsed_vertex_target("--vertices", a.vertices_word);
  if(!a.faces_word.empty())
    a.faces = parsed_vertex_target("--faces", a.faces_word, "faces");
  if(!a.drop_debris_word.empty())
    a.drop_debris = arguments_internal::parsed_share("--drop-debris", a.drop_debris_word);
  if(!a.keep.empty())
    a.kept = parsed_keep(a.keep);
  std::istringstream labels(a.labels_word);
  for(std::string name; std::getline(labels, name, ',');)
    a.labels.push_back(name);
  if(!a.levels_word.empty())
    a.level_targets = parsed_vertex_targets("--levels", a.levels_word);
  arguments_internal::check(a);
  a.operator_ = parsed_operator(a.operator_word);
  return a;
}

// Reads, simplifies, writes and judges; returns the exit status. It is in spectral_simplify.cpp.
int run(Arguments a);

// Sets the levels, and returns the number of vertices to simplify to, for a mesh of n vertices, of
// which `kept` stay; throws when one of these or K does not suit it. `for_faces`: the number of
// vertices that --faces means; `size`: how many the mesh has, in words.
inline std::size_t resolve_sizes(Arguments& a, const std::size_t n, const std::size_t kept,
                                 const std::size_t for_faces, const std::string& size)
{
  a.levels.clear();
  for(const Vertex_target& level : a.level_targets)
    a.levels.push_back(level.of(n));
  std::sort(a.levels.rbegin(), a.levels.rend());
  if(const auto twice = std::adjacent_find(a.levels.begin(), a.levels.end());
     twice != a.levels.end())
    throw std::runtime_error("--levels names " + std::to_string(*twice) + " twice.");
  const long advised = 3 * a.eigenvectors; // section 4.3 of the paper
  const long target = a.faces             ? static_cast<long>(for_faces)
                      : a.vertices        ? static_cast<long>(a.vertices->of(n))
                      : !a.levels.empty() ? static_cast<long>(a.levels.back())
                                          : (std::max)((std::min)(advised, static_cast<long>(n)),
                                                       static_cast<long>(kept));
  if(!a.levels.empty() && a.levels.front() > n)
    throw std::runtime_error("--levels names " + std::to_string(a.levels.front()) + ", but " +
                             size + ".");
  if(static_cast<std::size_t>(target) > n)
    throw std::runtime_error("--vertices is " + std::to_string(target) + ", but " + size + ".");
  if(!a.levels.empty() && a.levels.back() < static_cast<std::size_t>(target))
    throw std::runtime_error("--levels names " + std::to_string(a.levels.back()) +
                             ", but OUTPUT is to have " + std::to_string(target) +
                             " vertices: name only levels above that.");
  if(static_cast<std::size_t>(target) < kept)
    throw std::runtime_error("OUTPUT is to have " + std::to_string(target) +
                             " vertices, but --keep keeps " + std::to_string(kept) +
                             ": ask for more, or keep fewer.");
  if(static_cast<std::size_t>(a.eigenvectors) >= n)
    throw std::runtime_error("--eigenvectors is " + std::to_string(a.eigenvectors) +
                             ", it must be below " + std::to_string(n) + ": " + size + ".");
  if(a.eigenvectors > target && !a.no_evaluation)
    throw std::runtime_error(
        "a mesh of " + std::to_string(target) + " vertices has only " + std::to_string(target) +
        " modes, so that not all of " + std::to_string(a.eigenvectors) +
        " eigenvectors could be judged: ask for fewer with --eigenvectors, or add "
        "--no-evaluation to simplify all the same.");
  if(const long first = a.pre_simplify.value_or(0);
     first > 0 && (first < target || first <= a.eigenvectors))
    throw std::runtime_error("--pre-simplify is " + std::to_string(first) +
                             ", it must not be below the " + std::to_string(target) +
                             " vertices of OUTPUT, and above the " +
                             std::to_string(a.eigenvectors) + " eigenvectors.");
  return static_cast<std::size_t>(target);
}

#endif // SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_ARGUMENTS_H
