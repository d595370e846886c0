// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_ARGUMENTS_H
#define SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_ARGUMENTS_H

#include "io/command_line.h"
#include "io/kept_vertices.h"
#include "io/mesh_io.h"
#include "io/operator_reader.h"
#include "io/program.h"
#include "io/vertex_target.h"
#include "option_words.h"

#include <CGAL/Spectral_geometry/mesh_diagnosis.h>

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
  Operator_word operator_;                                   // what it says
  std::string mass, placement, self_intersections, relocate; // empty: as the preset has it
  std::optional<double> shape;                               // the same
  int threads = all_threads();
  bool binary = false, preserve_border = false, no_evaluation = false, quiet = false,
       repair = false, strict = false, intrinsic_delaunay = false, no_attributes = false;
  std::string restriction, prolongation, map, eigenpairs, json, report,
      repaired;                 // empty: not wanted
  std::string fit_operators;    // the same
  std::string fit_mass;         // empty: as the mass has it
  std::optional<int> fit_rings; // the same
  std::string signals, on_interrupt = "discard";
  Kept kept;
  std::vector<std::string> labels; // attributes whose numbers are labels
  std::string command;             // as it was typed
  std::string help;                // the text, if it was asked for

  std::string vertices_word, faces_word, levels_word, keep, labels_word; // as they were typed
  std::vector<Vertex_target> level_targets;

  bool wants_matrices() const
  {
    return !(restriction.empty() && prolongation.empty() && map.empty() && eigenpairs.empty() &&
             fit_operators.empty());
  }
};

namespace arguments_internal {

inline Command_line described(Arguments& a)
{
  Command_line line("spectral_simplify INPUT OUTPUT --vertices N [options]",
                    "Simplifies a triangle mesh and keeps the eigenvalues and eigenvectors of its "
                    "Laplace-Beltrami\n"
                    "operator as well as it can (Lescoat et al., Spectral Mesh Simplification, "
                    "2020). INPUT and OUTPUT\n"
                    "end in .off, .obj, .ply or .stl. Exit status: 0 all is written; 1 nothing is; "
                    "3 OUTPUT is, but the\n"
                    "evaluation failed; 130 interrupted.");
  line.argument(a.input);
  line.argument(a.output);

  line.group("Size");
  line.option("vertices", a.vertices_word, "N|P%",
              "how many vertices OUTPUT has, such as 600 or 3%");
  line.option("faces", a.faces_word, "N|P%",
              "in its place, how many faces it has at most; two or three fewer where its border "
              "loses an edge");
  line.option("levels", a.levels_word, "N1,N2,...",
              "write these sizes as well: OUTPUT-N1, OUTPUT-N2, ..., with a matrix of "
              "--restriction and a map "
              "of --map for each");
  line.option("max-error", a.max_error, "E",
              "stop before the relative error sqrt(E / sum lambda^2) exceeds this, such as 0.1; "
              "alone, at 3 K "
              "vertices at the latest");

  line.group("Quality");
  line.option("eigenvectors", a.eigenvectors, "K",
              "how many to keep, the constant one included; best N >= 3 K");
  line.choice("preset", a.preset, {"best", "fast", "paper"},
              "best keeps the spectrum best; fast is for N below a two-hundredth of INPUT; paper: "
              "P follows the "
              "collapses, and the mass is diagonal");

  line.group("Input");
  line.flag("repair", a.repair,
            "make INPUT an oriented manifold of triangles and say what was changed");
  line.option("keep", a.keep, "LIST",
              "vertices that stay where they are, words separated by commas: border; sharp:ANGLE, "
              "those of edges "
              "where the normals of both faces are ANGLE degrees apart, and corners of the border; "
              "seams, those of a "
              "texture; "
              "FILE, one index per line, from 0");

  line.group("Outputs");
  line.option("restriction", a.restriction, "P.mtx",
              "the matrix, OUTPUT's vertices x INPUT's, that carries functions to OUTPUT");
  line.option("prolongation", a.prolongation, "Q.mtx",
              "the matrix that carries them back, by the closest points");
  line.option("map", a.map, "FILE",
              "for each vertex of INPUT the one of OUTPUT it went to, from 0; -1: left out");
  line.option("json", a.json, "FILE", "the figures of the table, and more");
  line.option("report", a.report, "FILE.html",
              "a page with both meshes, the figures, the functional map and the eigenvalues");

  line.group("Run");
  line.threads(a.threads);
  line.flag("no-evaluation", a.no_evaluation, "do not compute how well the spectrum was kept");
  line.flag("quiet", a.quiet, "no table, no progress bar, no warnings");

  line.advanced_group("Each part of a preset (advanced)");
  line.choice(
      "mass", a.mass, {"lumped", "averaged", "voronoi"},
      "the mass matrix: lumped (paper), the mean of lumped and consistent (best), which keeps the "
      "eigenvalues of coarse meshes much closer, or lumped by mixed Voronoi areas");
  line.choice("placement", a.placement, words_of(placement_words),
              "where the vertex goes that replaces an edge (best: free, paper: on_edge)");
  line.option("shape", a.shape, "G",
              "weight of the shape beside the spectrum, which keeps thin limbs (best: 3, paper: "
              "0); 1 to 10 "
              "are alike");
  line.choice("self-intersections", a.self_intersections, {"allow", "refuse"},
              "collapses that put a face through another (best: refuse, paper: allow)");
  line.choice("relocate", a.relocate, words_of(relocation_words, {"none"}),
              "afterwards move the vertices so that the spectrum is kept still better (best: "
              "sampled, paper: "
              "none), by the functions at the closest points of INPUT, by what the restriction "
              "carries, or by "
              "both. With sampled the restriction is that of the closest points, and no longer "
              "follows --map");
  line.option(
      "quadrics-above", a.quadrics_above, "R",
      "while there are more than R times the vertices of OUTPUT, collapse edges by quadrics alone: "
      "much faster, and as good (best and fast: 15, paper: inf, never)");
  line.option(
      "pre-simplify", a.pre_simplify, "N0",
      "first reduce a larger INPUT to this number by quadrics alone (fast: 30 N, at least 10000; "
      "others: 0, never)");

  line.advanced_group("What is kept (advanced)");
  line.option("operator", a.operator_word, "OPERATOR",
              "whose spectrum is kept and judged: cotangent; weighted:W.npy, -div(c grad f) = "
              "lambda rho f, a "
              "NumPy array with a row for each vertex of INPUT: c, or rho and c, or rho and a "
              "tensor xx, xy, "
              "xz, yy, yz, zz; anisotropic:A, a surface that conducts 1 / (1 + A |k|) in the "
              "direction of a "
              "principal curvature k, which is 1 on a sphere of the same area. --eigenpairs writes "
              "coarse_coefficients.npy as well");
  line.choice(
      "boundary", a.boundary, words_of(boundary_words),
      "what functions do on the border of INPUT: their derivative across it is zero, or they are");
  line.flag("intrinsic-delaunay", a.intrinsic_delaunay,
            "for an INPUT of needles: take eigenvectors, and judge, on the intrinsic Delaunay "
            "triangulations "
            "of INPUT and OUTPUT");
  line.option("signals", a.signals, "F.npy",
              "preserve these functions instead of eigenvectors: a NumPy array of float64 or "
              "float32, one row "
              "for each vertex of INPUT");
  line.flag("binary", a.binary, "a restriction of ones and zeros: it picks vertices of INPUT");
  line.flag("preserve-border", a.preserve_border, "no edge is drawn away from the border");
  line.option(
      "labels", a.labels_word, "NAMES",
      "attributes of INPUT whose floating numbers are labels, separated by commas: the one of most "
      "weight is taken");
  line.flag(
      "no-attributes", a.no_attributes,
      "leave behind what INPUT has at its vertices and faces. Otherwise OUTPUT has it as well, "
      "as far as its format holds it (.ply all, .obj colours, normals, texture coordinates, "
      "materials "
      "and groups, .off "
      "colours and normals, .stl colours of faces): numbers by the restriction, integers that are "
      "no "
      "colours as labels, of "
      "which the one of most weight is taken; what faces have by the area that each face of OUTPUT "
      "takes over");

  line.advanced_group("Dirty meshes (advanced)");
  line.option(
      "repaired", a.repaired, "FILE",
      "write the mesh that --repair makes: polygons are triangulated, vertices of equal position "
      "merged, cracks closed, degenerate faces removed, sheets that share an edge or a vertex "
      "separated, borders "
      "stitched. What leaves the surface as it is needs no option: isolated vertices are left out, "
      "copies of faces removed, edges without length closed, faces turned round to agree with "
      "their "
      "neighbours. Matrices and maps number INPUT's vertices all the same");
  line.strict(a.strict);

  line.advanced_group("Operators and interrupts (advanced)");
  line.option("eigenpairs", a.eigenpairs, "DIR",
              "write {fine,coarse}_{eigenvalues,eigenvectors}.npy, {fine,coarse}_{L,mass}.mtx and "
              "C.npy, all "
              "at the scale of the meshes as they are");
  line.option(
      "fit-operators", a.fit_operators, "DIR",
      "choose the entries of a Laplacian and a mass on OUTPUT's vertices so that they have INPUT's "
      "spectrum as nearly as they can, and write L.mtx, mass.mtx, eigenvalues.npy and "
      "eigenvectors.npy: for functional maps and spectral distances");
  line.choice("fit-mass", a.fit_mass, {"diagonal", "edges"},
              "where the fitted mass has entries (lumped mass: diagonal, averaged: edges)");
  line.option("fit-rings", a.fit_rings, "1|2",
              "where the fitted Laplacian has entries: the edges of OUTPUT, or two rings (2)");
  line.choice(
      "on-interrupt", a.on_interrupt, {"discard", "write"},
      "what Ctrl-C does once vertices have been removed: write nothing, or what there is, without "
      "evaluation; a second Ctrl-C ends the program at once");
  return line;
}

inline std::string shown(const double number)
{
  std::ostringstream text;
  text << number;
  return text.str();
}

inline void check(const Arguments& a)
{
  const auto refuse = [](const std::string& sentence) { throw std::runtime_error(sentence); };
  if(a.input.empty() || a.output.empty())
    refuse("INPUT and OUTPUT are needed: spectral_simplify INPUT OUTPUT --vertices N; --help shows "
           "everything.");
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
  if(a.binary && (a.relocate == "sampled" || (a.relocate.empty() && a.preset != "paper")))
    refuse("--binary asks for a restriction of ones and zeros, and relocation by the closest "
           "points makes "
           "another one: add --relocate none or --relocate carried.");
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

// Throws with one sentence for what cannot be meant.
inline Arguments parse_arguments(int argc, char* argv[])
{
  Arguments a;
  a.command = command_line("spectral_simplify", argc, argv);
  a.help = arguments_internal::described(a).read(argc, argv);
  if(!a.help.empty())
    return a;
  if(!a.vertices_word.empty())
    a.vertices = parsed_vertex_target("--vertices", a.vertices_word);
  if(!a.faces_word.empty())
    a.faces = parsed_vertex_target("--faces", a.faces_word, "faces");
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

// Sets the levels, and returns the number of vertices to simplify to, for a mesh of n vertices, of
// which `kept` stay; throws when one of these or K does not suit it. `for_faces`: the number of
// vertices that --faces means.
inline std::size_t resolve_sizes(Arguments& a,
                                 const CGAL::Spectral_geometry::Mesh_diagnosis& diagnosis,
                                 const std::size_t n, const std::size_t kept,
                                 const std::size_t for_faces)
{
  const std::string size = "'" + a.input + "' has " + std::to_string(n) + " vertices";
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
  if(const std::string reason = diagnosis.too_small(static_cast<std::size_t>(target));
     !reason.empty() && static_cast<std::size_t>(target) < n)
    throw std::runtime_error("OUTPUT is to have " + std::to_string(target) + " vertices, but " +
                             reason + ".");
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
