// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_ARGUMENTS_H
#define SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_ARGUMENTS_H

#include "io/mesh_io.h"

#include <boost/program_options.hpp>

#include <cmath>
#include <cstddef>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

// The command line of spectral_simplify.
struct Arguments
{
  std::string input, output;
  std::optional<long> vertices; // this one
  std::optional<double> ratio;  // or that
  long eigenvectors = 100;
  std::string placement = "on_edge", mass = "lumped";
  int threads = 1;
  bool binary = false, preserve_border = false, no_evaluation = false, quiet = false, repair = false;
  std::string restriction, prolongation, map, eigenpairs, json, report, repaired; // empty: not wanted
  std::string command;                                                            // as it was typed
  std::string help; // the text, if it was asked for

  bool wants_matrices() const
  {
    return !(restriction.empty() && prolongation.empty() && map.empty() && eigenpairs.empty());
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
      "INPUT and OUTPUT end in .off, .obj, .ply or .stl. All outputs appear at the end, or none.\n\nOptions",
      100, 60);
  auto add = options.add_options();
  add("help", "show this text");
  add("vertices", po::value<long>()->value_name("N"), "how many vertices OUTPUT has");
  add("ratio", po::value<double>()->value_name("R"), "instead: as a fraction of INPUT's, in ]0, 1]");
  add("eigenvectors", po::value(&a.eigenvectors)->value_name("K")->default_value(a.eigenvectors),
      "how many to keep, the constant one included; N should be at least 3 K");
  add("placement", text(a.placement, "on_edge|midpoint|free")->default_value(a.placement),
      "where the vertex goes that replaces an edge");
  add("mass", text(a.mass, "lumped|averaged")->default_value(a.mass),
      "the mass matrix of the eigenproblem: lumped as in the paper, or the mean of lumped and consistent, "
      "which "
      "keeps the eigenvalues of coarse meshes much closer");
  add("binary", po::bool_switch(&a.binary), "a restriction of ones and zeros: it picks vertices of INPUT");
  add("preserve-border", po::bool_switch(&a.preserve_border), "no edge is drawn away from the border");
  add("repair", po::bool_switch(&a.repair),
      "make INPUT an oriented manifold of triangles first and say what was changed: polygons are "
      "triangulated, vertices of "
      "equal position merged, copies of faces, isolated vertices and degenerate faces removed, faces "
      "oriented, "
      "sheets that share an edge or a vertex separated, borders stitched");
  add("repaired", text(a.repaired, "mesh.ply"),
      "write the repaired mesh; with --repair the matrices and maps number its vertices, not INPUT's");
  add("threads", po::value(&a.threads)->value_name("T")->default_value(a.threads),
      "threads for the costs; the result does not depend on it");
  add("restriction", text(a.restriction, "P.mtx"),
      "write the matrix (OUTPUT's vertices x INPUT's, Matrix Market) that carries functions to OUTPUT");
  add("prolongation", text(a.prolongation, "Q.mtx"),
      "write the matrix (INPUT's vertices x OUTPUT's) that carries them back: barycentric coordinates of the "
      "closest points");
  add("map", text(a.map, "map.txt"),
      "write for each vertex of INPUT the vertex of OUTPUT it went to, one per line, counted from 0");
  add("eigenpairs", text(a.eigenpairs, "DIR"),
      "write {fine,coarse}_{eigenvalues,eigenvectors}.npy, {fine,coarse}_{L,mass}.mtx and C.npy, all at the "
      "scale "
      "of the meshes as they are");
  add("json", text(a.json, "out.json"), "write the figures of the table and more");
  add("report", text(a.report, "report.html"),
      "write a page with the figures, the functional map and the eigenvalues");
  add("no-evaluation", po::bool_switch(&a.no_evaluation), "do not compute how well the spectrum was kept");
  add("quiet", po::bool_switch(&a.quiet), "no table, no progress bar, no warnings");
  return options;
}

inline void check(const Arguments& a)
{
  const auto refuse = [](const std::string& sentence) { throw std::runtime_error(sentence); };
  if(a.input.empty() || a.output.empty())
    refuse(
        "INPUT and OUTPUT are needed: spectral_simplify INPUT OUTPUT --vertices N; --help shows everything.");
  if(!a.vertices && !a.ratio)
    refuse("say how far to simplify: --vertices N or --ratio R.");
  if(a.vertices && a.ratio)
    refuse("--vertices and --ratio cannot both be given.");
  if(a.vertices && *a.vertices < 1)
    refuse("--vertices is " + std::to_string(*a.vertices) + ", it must be positive.");
  if(a.ratio && !(*a.ratio > 0 && *a.ratio <= 1)) {
    std::ostringstream ratio;
    ratio << *a.ratio;
    refuse("--ratio is " + ratio.str() + ", it must be greater than 0 and at most 1.");
  }
  if(a.eigenvectors < 1)
    refuse("--eigenvectors is " + std::to_string(a.eigenvectors) + ", it must be positive.");
  if(a.placement != "on_edge" && a.placement != "midpoint" && a.placement != "free")
    refuse("--placement is '" + a.placement + "', it must be on_edge, midpoint or free.");
  if(a.mass != "lumped" && a.mass != "averaged")
    refuse("--mass is '" + a.mass + "', it must be lumped or averaged.");
  if(a.threads < 1)
    refuse("--threads is " + std::to_string(a.threads) + ", it must be positive.");
  if(a.no_evaluation && !a.eigenpairs.empty())
    refuse("--eigenpairs writes what the evaluation computes: leave out --no-evaluation.");
  if(a.no_evaluation && !a.report.empty())
    refuse("--report shows what the evaluation computes: leave out --no-evaluation.");
  if(!a.repaired.empty() && !a.repair)
    refuse("--repaired writes what --repair makes: add --repair.");
  if(!a.repaired.empty())
    mesh_format(a.repaired);
  mesh_format(a.input);
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
  a.command = "spectral_simplify";
  for(int k = 1; k < argc; ++k)
    a.command += std::string(" ") + argv[k];
  const po::options_description visible = arguments_internal::described(a);
  po::options_description all;
  all.add(visible).add_options()("input", po::value(&a.input))("output", po::value(&a.output));
  po::positional_options_description positions;
  positions.add("input", 1).add("output", 1);

  // Without short options a negative number is a value.
  const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_short;
  po::variables_map values;
  try {
    po::store(po::command_line_parser(argc, argv).options(all).positional(positions).style(style).run(),
              values);
    po::notify(values);
  } catch(const po::too_many_positional_options_error&) {
    throw std::runtime_error("there are more arguments than INPUT and OUTPUT; --help shows everything.");
  } catch(const po::error& error) {
    throw std::runtime_error(std::string(error.what()) + "; --help shows everything.");
  }
  if(values.count("help")) {
    std::ostringstream text;
    text << visible;
    a.help = text.str();
    return a;
  }
  a.vertices = arguments_internal::optional_value<long>(values, "vertices");
  a.ratio = arguments_internal::optional_value<double>(values, "ratio");
  arguments_internal::check(a);
  return a;
}

// Returns the number of vertices to simplify to; throws when it or K does not suit a mesh of n vertices.
inline std::size_t checked_target(const Arguments& a, std::size_t n)
{
  const std::string size = "'" + a.input + "' has " + std::to_string(n) + " vertices";
  const long rounded = a.ratio ? std::lround(*a.ratio * static_cast<double>(n)) : 0;
  const long target = a.vertices ? *a.vertices : (rounded > 0 ? rounded : 1);
  if(static_cast<std::size_t>(target) > n)
    throw std::runtime_error("--vertices is " + std::to_string(target) + ", but " + size + ".");
  if(static_cast<std::size_t>(a.eigenvectors) >= n)
    throw std::runtime_error("--eigenvectors is " + std::to_string(a.eigenvectors) + ", it must be below " +
                             std::to_string(n) + ": " + size + ".");
  if(a.eigenvectors > target && !a.no_evaluation)
    throw std::runtime_error("a mesh of " + std::to_string(target) + " vertices has only " +
                             std::to_string(target) + " modes, so that not all of " +
                             std::to_string(a.eigenvectors) +
                             " eigenvectors could be judged: ask for fewer with --eigenvectors, or add "
                             "--no-evaluation to simplify all the same.");
  return static_cast<std::size_t>(target);
}

#endif // SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_ARGUMENTS_H
