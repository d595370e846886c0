// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_ARGUMENTS_H
#define SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_ARGUMENTS_H

#include "io/command_line.h"
#include "io/program.h"
#include "io/mesh_io.h"
#include "io/operator_reader.h"

#include <boost/program_options.hpp>

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
  std::optional<long> vertices; // this one
  std::optional<double> ratio;  // or that
  std::optional<double> max_error;
  std::vector<std::size_t> levels; // descending
  long eigenvectors = 100;
  std::optional<long> pre_simplify; // as the preset has it; 0: never
  std::string preset = "best", flips = "none";
  std::string boundary = "neumann";
  std::string operator_word = "cotangent";
  Operator_word operator_;                                   // what it says
  std::string mass, placement, self_intersections, relocate; // empty: as the preset has it
  std::optional<double> shape;                               // the same
  int threads = all_threads();
  bool binary = false, preserve_border = false, no_evaluation = false, quiet = false, repair = false,
       strict = false, intrinsic_delaunay = false, no_attributes = false, keep_seams = false;
  std::string restriction, prolongation, map, eigenpairs, json, report, repaired; // empty: not wanted
  std::string fit_operators;                                                      // the same
  std::string fit_mass;                                                           // empty: as the mass has it
  std::optional<int> fit_rings;                                                   // the same
  std::string keep, signals, on_interrupt = "discard";
  std::string command; // as it was typed
  std::string help;    // the text, if it was asked for

  bool wants_matrices() const
  {
    return !(restriction.empty() && prolongation.empty() && map.empty() && eigenpairs.empty() &&
             fit_operators.empty());
  }
};

namespace arguments_internal {

template <class T>
std::optional<T> optional_value(const boost::program_options::variables_map& values, const char* name)
{
  return values.count(name) ? std::optional<T>(values[name].as<T>()) : std::nullopt;
}

inline boost::program_options::options_description described(Arguments& a)
{
  namespace po = boost::program_options;
  const auto text = [](std::string& value, const char* name) { return po::value(&value)->value_name(name); };
  po::options_description options(
      "spectral_simplify INPUT OUTPUT --vertices N [options]\n\n"
      "Simplifies a triangle mesh and keeps the eigenvalues and eigenvectors of its Laplace-Beltrami\n"
      "operator as well as it can (Lescoat et al., Spectral Mesh Simplification, 2020).\n"
      "INPUT and OUTPUT end in .off, .obj, .ply or .stl. The meshes, matrices and maps appear together at "
      "the\n"
      "end, before the evaluation begins, and what that writes appears together after it.\n"
      "Exit status: 0 all is written; 1 nothing is; 3 OUTPUT is, but the evaluation failed; 130 "
      "interrupted.\n\n"
      "Options",
      100, 60);
  auto add = options.add_options();
  add("help", "show this text");
  add("vertices", po::value<long>()->value_name("N"), "how many vertices OUTPUT has");
  add("ratio", po::value<double>()->value_name("R"), "instead: as a fraction of INPUT's, in ]0, 1]");
  add("max-error", po::value<double>()->value_name("E"),
      "instead or as well: stop before the relative error sqrt(E / sum lambda^2) exceeds this; 0.1 keeps the "
      "spectrum "
      "closely, 0.14 well; alone, it ends at 3 K vertices at the latest");
  add("levels", po::value<std::string>()->value_name("N1,N2,..."),
      "write these numbers of vertices as well, from the same run: OUTPUT-N1, OUTPUT-N2, ..., and with "
      "--restriction "
      "and --map a matrix and a map for each; without --vertices and --ratio the smallest is the target");
  add("keep", text(a.keep, "landmarks.txt"),
      "vertices of INPUT that stay where they are, one index per line, counted from 0; --map says where they "
      "are in "
      "OUTPUT");
  add("signals", text(a.signals, "F.npy"),
      "preserve these functions instead of eigenvectors: a NumPy array of float64 or float32, one row for "
      "each vertex of "
      "INPUT");
  add("eigenvectors", po::value(&a.eigenvectors)->value_name("K")->default_value(a.eigenvectors),
      "how many to keep, the constant one included; N should be at least 3 K");
  add("pre-simplify", po::value<long>()->value_name("N0"),
      "first reduce a larger INPUT to this number by quadrics alone; 0: never");
  add("preset", text(a.preset, "best|fast|paper")->default_value(a.preset),
      "best: what keeps the spectrum best; fast: the same with --pre-simplify at 30 N, at least 10000; "
      "paper: what the "
      "paper describes. Each of the next five, and --pre-simplify, overrides it");
  add("mass", text(a.mass, "lumped|averaged|voronoi"),
      "the mass matrix of the eigenproblem: lumped (paper), or the mean of lumped and consistent (best), "
      "which keeps the eigenvalues of coarse meshes much closer, or lumped by mixed Voronoi areas");
  add("operator", text(a.operator_word, "OPERATOR")->default_value(a.operator_word),
      "whose spectrum is kept and judged: cotangent; weighted:W.npy, -div(c grad f) = lambda rho f, a NumPy "
      "array with a row for each vertex of INPUT: c, or rho and c, or rho and a tensor xx, xy, xz, yy, yz, "
      "zz; anisotropic:A, a surface that conducts 1 / (1 + A |k|) in the direction of a principal curvature "
      "k, which is 1 on a sphere of the same area. --eigenpairs writes coarse_coefficients.npy as well");
  add("boundary", text(a.boundary, "neumann|dirichlet")->default_value(a.boundary),
      "what functions do on the border of INPUT: their derivative across it is zero, or they are");
  add("intrinsic-delaunay", po::bool_switch(&a.intrinsic_delaunay),
      "for an INPUT of needles: take eigenvectors, and judge, on the intrinsic Delaunay triangulations of "
      "INPUT and OUTPUT");
  add("placement", text(a.placement, "on_edge|midpoint|free"),
      "where the vertex goes that replaces an edge (best: free, paper: on_edge)");
  add("shape", po::value<double>()->value_name("G"),
      "weight of the shape beside the spectrum, which keeps thin limbs (best: 3, paper: 0); 1 to 10 are "
      "alike");
  add("self-intersections", text(a.self_intersections, "allow|refuse"),
      "collapses that put a face through another (best: refuse, paper: allow)");
  add("relocate", text(a.relocate, "none|sampled|carried|carried_and_sampled"),
      "afterwards move the vertices so that the spectrum is kept still better (best: sampled, paper: none), "
      "by the functions at the closest points of INPUT, by what the restriction carries, or by both. With "
      "sampled the restriction is that of the closest points, and no longer follows --map");
  add("binary", po::bool_switch(&a.binary), "a restriction of ones and zeros: it picks vertices of INPUT");
  add("preserve-border", po::bool_switch(&a.preserve_border), "no edge is drawn away from the border");
  add("flips", text(a.flips, "none|spectral|delaunay")->default_value(a.flips),
      "afterwards flip edges, before --relocate: where that lowers the error, or where the opposite angles "
      "are more than 180 "
      "degrees together; --levels are written without");
  add("repair", po::bool_switch(&a.repair),
      "make INPUT an oriented manifold of triangles first and say what was changed: polygons are "
      "triangulated, "
      "vertices of equal position merged, degenerate faces removed, sheets that share an edge or a vertex "
      "separated, borders stitched. What leaves the surface as it is needs no option: isolated vertices are "
      "left "
      "out, copies of faces removed, edges without length closed, faces turned round to agree with their "
      "neighbours");
  add("strict", po::bool_switch(&a.strict), "change nothing of INPUT: refuse what cannot be used as it is");
  add("repaired", text(a.repaired, "mesh.ply"),
      "write the repaired mesh; the matrices and maps number INPUT's vertices all the same");
  add("no-attributes", po::bool_switch(&a.no_attributes),
      "leave behind what INPUT has at its vertices beside positions. Otherwise OUTPUT has it as well, as far "
      "as its format "
      "holds it (.ply all, .obj colours, normals and texture coordinates, .off colours and normals): numbers "
      "by the restriction, "
      "integers that are no colours as labels, of which the one of most weight is taken");
  add("keep-seams", po::bool_switch(&a.keep_seams),
      "the seams of INPUT's texture stay: edges whose two faces have other texture coordinates, and edges "
      "that INPUT has "
      "twice in the same place. Their vertices are kept, and OUTPUT, an .obj file, has texture coordinates "
      "at the "
      "corners of faces");
  add("threads", po::value(&a.threads)->value_name("T")->default_value(a.threads),
      "for eigenpairs, costs and relocation, all cores by default; the result does not depend on it");
  add("restriction", text(a.restriction, "P.mtx"),
      "write the matrix (OUTPUT's vertices x INPUT's, Matrix Market) that carries functions to OUTPUT; "
      "columns "
      "of vertices that were left out are empty");
  add("prolongation", text(a.prolongation, "Q.mtx"),
      "write the matrix (INPUT's vertices x OUTPUT's) that carries them back: barycentric coordinates of the "
      "closest points");
  add("map", text(a.map, "map.txt"),
      "write for each vertex of INPUT the vertex of OUTPUT it went to, one per line, counted from 0; -1 for "
      "one "
      "that was left out");
  add("eigenpairs", text(a.eigenpairs, "DIR"),
      "write {fine,coarse}_{eigenvalues,eigenvectors}.npy, {fine,coarse}_{L,mass}.mtx and C.npy, all at the "
      "scale "
      "of the meshes as they are");
  add("fit-operators", text(a.fit_operators, "DIR"),
      "choose the entries of a Laplacian and a mass on OUTPUT's edges so that they have INPUT's spectrum as "
      "nearly as they can, and "
      "write L.mtx, mass.mtx, eigenvalues.npy and eigenvectors.npy: for functional maps and spectral "
      "distances");
  add("fit-mass", text(a.fit_mass, "diagonal|edges"),
      "where the fitted mass has entries (lumped mass: diagonal, averaged: edges)");
  add("fit-rings", po::value<int>()->value_name("1|2"),
      "where the fitted Laplacian has entries: the edges of OUTPUT, or two rings (mass on edges: 1, "
      "diagonal: 2)");
  add("json", text(a.json, "out.json"), "write the figures of the table and more");
  add("report", text(a.report, "report.html"),
      "write a page with the figures, the functional map and the eigenvalues");
  add("on-interrupt", text(a.on_interrupt, "discard|write")->default_value(a.on_interrupt),
      "what Ctrl-C does once vertices have been removed: write nothing, or what there is, without "
      "evaluation; a second "
      "Ctrl-C ends the program at once");
  add("no-evaluation", po::bool_switch(&a.no_evaluation), "do not compute how well the spectrum was kept");
  add("quiet", po::bool_switch(&a.quiet), "no table, no progress bar, no warnings");
  return options;
}

inline std::string shown(const double number)
{
  std::ostringstream text;
  text << number;
  return text.str();
}

// "5000,1000" as numbers, the largest first.
inline std::vector<std::size_t> parsed_levels(const std::string& list)
{
  std::vector<std::size_t> levels;
  std::istringstream words(list + ",");
  for(std::string word; std::getline(words, word, ',');) {
    if(word.empty() || word.size() > 15 || word.find_first_not_of("0123456789") != std::string::npos ||
       std::stoull(word) == 0)
      throw std::runtime_error("--levels is '" + list +
                               "', it must be positive numbers of vertices separated by commas.");
    levels.push_back(std::stoull(word));
  }
  std::sort(levels.rbegin(), levels.rend());
  const auto twice = std::adjacent_find(levels.begin(), levels.end());
  if(twice != levels.end())
    throw std::runtime_error("--levels names " + std::to_string(*twice) + " twice.");
  return levels;
}

inline void check(const Arguments& a)
{
  const auto refuse = [](const std::string& sentence) { throw std::runtime_error(sentence); };
  if(a.input.empty() || a.output.empty())
    refuse(
        "INPUT and OUTPUT are needed: spectral_simplify INPUT OUTPUT --vertices N; --help shows everything.");
  if(!a.vertices && !a.ratio && !a.max_error && a.levels.empty())
    refuse("say how far to simplify: --vertices N, --ratio R, --levels N1,N2,... or --max-error E.");
  if(a.vertices && a.ratio)
    refuse("--vertices and --ratio cannot both be given.");
  if(a.vertices && *a.vertices < 1)
    refuse("--vertices is " + std::to_string(*a.vertices) + ", it must be positive.");
  if(a.ratio && !(*a.ratio > 0 && *a.ratio <= 1))
    refuse("--ratio is " + shown(*a.ratio) + ", it must be greater than 0 and at most 1.");
  if(a.max_error && !(*a.max_error > 0 && std::isfinite(*a.max_error)))
    refuse("--max-error is " + shown(*a.max_error) + ", it must be greater than 0.");
  if(a.eigenvectors < 1)
    refuse("--eigenvectors is " + std::to_string(a.eigenvectors) + ", it must be positive.");
  if(a.pre_simplify && *a.pre_simplify < 0)
    refuse("--pre-simplify is " + std::to_string(*a.pre_simplify) + ", it must not be negative.");
  check_choice("--preset", a.preset, {"best", "fast", "paper"});
  check_choice("--placement", a.placement, {"on_edge", "midpoint", "free"});
  check_choice("--mass", a.mass, {"lumped", "averaged", "voronoi"});
  check_choice("--boundary", a.boundary, {"neumann", "dirichlet"});
  if(a.boundary == "dirichlet" && !a.fit_operators.empty())
    refuse("--fit-operators fits Laplacians whose rows sum to zero: leave it out with --boundary dirichlet.");
  if(a.intrinsic_delaunay &&
     (a.operator_word != "cotangent" || a.boundary != "neumann" || !a.signals.empty()))
    refuse("--intrinsic-delaunay is for eigenvectors of the cotangent operator: leave out --operator, "
           "--boundary and --signals.");
  check_choice("--self-intersections", a.self_intersections, {"allow", "refuse"});
  check_choice("--relocate", a.relocate, {"none", "sampled", "carried", "carried_and_sampled"});
  check_choice("--on-interrupt", a.on_interrupt, {"discard", "write"});
  check_choice("--fit-mass", a.fit_mass, {"diagonal", "edges"});
  check_choice("--flips", a.flips, {"none", "spectral", "delaunay"});
  if(a.shape && !(*a.shape >= 0 && std::isfinite(*a.shape)))
    refuse("--shape is " + shown(*a.shape) + ", it must be a number from 0.");
  if(a.binary && (a.relocate == "sampled" || (a.relocate.empty() && a.preset != "paper")))
    refuse("--binary asks for a restriction of ones and zeros, and relocation by the closest points makes "
           "another one: add --relocate none or --relocate carried.");
  if(a.threads < 1)
    refuse("--threads is " + std::to_string(a.threads) + ", it must be positive.");
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
  if(a.keep_seams && a.no_attributes)
    refuse("--keep-seams writes a texture, --no-attributes leaves it behind: leave one of them out.");
  if(a.keep_seams && a.flips != "none")
    refuse("--flips may turn an edge of a seam: leave out --flips or --keep-seams.");
  if(!a.repaired.empty() && !a.repair)
    refuse("--repaired writes what --repair makes: add --repair.");
  if(!a.repaired.empty())
    mesh_format(a.repaired);
  mesh_format(a.input);
  if(a.keep_seams && mesh_format(a.output) != ".obj")
    refuse("--keep-seams writes texture coordinates at the corners of faces, which only OBJ files have: "
           "choose .obj for '" +
           a.output + "'.");
  if(mesh_format(a.output) == ".stl" && a.wants_matrices())
    refuse(
        "an STL file does not number its vertices, so that no matrix or map can refer to them: choose .off, "
        ".obj or .ply for '" +
        a.output + "'.");
}

} // namespace arguments_internal

// Throws with one sentence for what cannot be meant.
inline Arguments parse_arguments(int argc, char* argv[])
{
  namespace po = boost::program_options;
  Arguments a;
  a.command = command_line("spectral_simplify", argc, argv);
  po::variables_map values;
  a.help = read_command_line(argc, argv, arguments_internal::described(a),
                             {{"input", &a.input}, {"output", &a.output}}, "INPUT and OUTPUT", values);
  if(!a.help.empty())
    return a;
  a.vertices = arguments_internal::optional_value<long>(values, "vertices");
  a.ratio = arguments_internal::optional_value<double>(values, "ratio");
  a.pre_simplify = arguments_internal::optional_value<long>(values, "pre-simplify");
  a.shape = arguments_internal::optional_value<double>(values, "shape");
  a.max_error = arguments_internal::optional_value<double>(values, "max-error");
  a.fit_rings = arguments_internal::optional_value<int>(values, "fit-rings");
  if(values.count("levels"))
    a.levels = arguments_internal::parsed_levels(values["levels"].as<std::string>());
  arguments_internal::check(a);
  a.operator_ = parsed_operator(a.operator_word);
  return a;
}

// Returns the number of vertices to simplify to; throws when it or K does not suit a mesh of n vertices, of which `at_seams`
// are kept.
inline std::size_t checked_target(const Arguments& a, const std::size_t n, const std::size_t at_seams)
{
  const std::string size = "'" + a.input + "' has " + std::to_string(n) + " vertices";
  const long rounded = a.ratio ? std::lround(*a.ratio * static_cast<double>(n)) : 0;
  const long advised = 3 * a.eigenvectors; // section 4.3 of the paper
  const long target = a.vertices          ? *a.vertices
                      : a.ratio           ? (std::max)(rounded, 1L)
                      : !a.levels.empty() ? static_cast<long>(a.levels.back())
                                          : (std::max)((std::min)(advised, static_cast<long>(n)),
                                                       static_cast<long>(at_seams));
  if(!a.levels.empty() && a.levels.front() > n)
    throw std::runtime_error("--levels names " + std::to_string(a.levels.front()) + ", but " + size + ".");
  if(static_cast<std::size_t>(target) > n)
    throw std::runtime_error("--vertices is " + std::to_string(target) + ", but " + size + ".");
  if(!a.levels.empty() && a.levels.back() < static_cast<std::size_t>(target))
    throw std::runtime_error("--levels names " + std::to_string(a.levels.back()) +
                             ", but OUTPUT is to have " + std::to_string(target) +
                             " vertices: name only levels above that.");
  if(static_cast<std::size_t>(target) < at_seams)
    throw std::runtime_error("OUTPUT is to have " + std::to_string(target) +
                             " vertices, but --keep-seams keeps " + std::to_string(at_seams) +
                             ": ask for more, or leave it out.");
  if(static_cast<std::size_t>(a.eigenvectors) >= n)
    throw std::runtime_error("--eigenvectors is " + std::to_string(a.eigenvectors) + ", it must be below " +
                             std::to_string(n) + ": " + size + ".");
  if(a.eigenvectors > target && !a.no_evaluation)
    throw std::runtime_error("a mesh of " + std::to_string(target) + " vertices has only " +
                             std::to_string(target) + " modes, so that not all of " +
                             std::to_string(a.eigenvectors) +
                             " eigenvectors could be judged: ask for fewer with --eigenvectors, or add "
                             "--no-evaluation to simplify all the same.");
  if(const long first = a.pre_simplify.value_or(0); first > 0 && (first < target || first <= a.eigenvectors))
    throw std::runtime_error("--pre-simplify is " + std::to_string(first) + ", it must not be below the " +
                             std::to_string(target) + " vertices of OUTPUT, and above the " +
                             std::to_string(a.eigenvectors) + " eigenvectors.");
  return static_cast<std::size_t>(target);
}

#endif // SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_ARGUMENTS_H
