// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_COMMAND_LINE_H
#define SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_COMMAND_LINE_H

#include "io/command_line.h"
#include "spectral_simplify_arguments.h"

#include <string>

namespace arguments_internal {

inline Command_line described(Arguments& a)
{
  Command_line line("spectral_simplify INPUT OUTPUT --vertices N [options]",
                    "Simplifies a triangle mesh and keeps the eigenvalues and eigenvectors of its "
                    "Laplace-Beltrami\n"
                    "operator as well as it can (Lescoat et al., Spectral Mesh Simplification, "
                    "2020). INPUT and OUTPUT\n"
                    "end in .off, .obj, .ply or .stl. Exit status: 0 on success; 1 on error, with "
                    "no file written; 3 if\n"
                    "OUTPUT was written but its evaluation failed; 130 if interrupted.");
  line.argument(a.input);
  line.argument(a.output);

  line.group("Size");
  line.option("vertices", a.vertices_word, "N|P%",
              "how many vertices OUTPUT has, such as 600 or 3%");
  line.option("faces", a.faces_word, "N|P%",
              "how many faces OUTPUT has at most, in place of --vertices; two or three fewer where "
              "its border loses an edge");
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
              "best keeps the spectrum best; fast takes half of the time on large meshes; paper: "
              "P follows the "
              "collapses, and the mass is diagonal");

  line.group("Input");
  line.flag("repair", a.repair,
            "make INPUT an oriented manifold of triangles and say what was changed");
  line.option("drop-debris", a.drop_debris_word, "S%",
              "leave out components of less than this share of the area, such as 0.1%, and say "
              "which; they take vertices from the others");
  line.option("keep", a.keep, "LIST",
              "vertices that keep their positions, words separated by commas: border; sharp:ANGLE, "
              "edges whose face normals are ANGLE degrees apart or more, and corners of the "
              "border; seams: those of a texture; FILE, one index per line, from 0");

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
  line.flag("no-evaluation", a.no_evaluation,
            "do not compute how well the spectrum was kept; with fast the default above 20000 "
            "vertices, unless an output shows it");
  line.flag("evaluation", a.evaluation, "compute it in any case");
  line.flag("quiet", a.quiet, "no table, no progress bar, no warnings");

  line.advanced_group("Each part of a preset (advanced)");
  line.choice(
      "mass", a.mass, words_of(mass_words),
      "the mass matrix: lumped (paper); averaged (best), the mean of lumped and consistent, which "
      "keeps the eigenvalues of coarse meshes much closer; voronoi, lumped by mixed Voronoi areas; "
      "consistent");
  line.choice("placement", a.placement, words_of(placement_words),
              "where the vertex goes that replaces an edge (best: free, paper: on_edge)");
  line.option("shape", a.shape, "G",
              "weight of the shape term in the cost, which keeps thin limbs (best: 3, paper: 0); 1 "
              "to 10 are alike");
  line.choice("self-intersections", a.self_intersections, {"allow", "refuse"},
              "collapses that put a face through another (best: refuse, paper: allow)");
  line.choice("relocate", a.relocate, words_of(relocation_words, {"none"}),
              "move the vertices afterwards so that the spectrum is kept still better (best: "
              "sampled, paper: none): by the functions at the closest points of INPUT (sampled), "
              "by what the restriction carries (carried), or by both. With sampled the restriction "
              "interpolates at closest points and no longer follows --map");
  line.choice("prefer", a.prefer, {"spectrum", "shape"},
              "what relocation keeps best, by default the spectrum; with shape the Hausdorff "
              "distance is a fifth smaller, errors of the spectrum are a tenth larger");
  line.option(
      "quadrics-above", a.quadrics_above, "R",
      "while there are more than R times the vertices of OUTPUT, collapse edges by quadrics alone: "
      "much faster, and as good (best and fast: 7, paper: inf, never)");
  line.option(
      "pre-simplify", a.pre_simplify, "N0",
      "first reduce a larger INPUT to this number by quadrics alone (fast: 15 N, at least 10000; "
      "best with --no-evaluation: 30 N, at least 300000; others: 0, never)");

  line.advanced_group("What is kept (advanced)");
  line.option("operator", a.operator_word, "OPERATOR",
              "the operator whose spectrum is kept and judged: cotangent; weighted:W.npy, -div(c "
              "grad f) = lambda rho f, where the NumPy array W.npy has a row for each vertex of "
              "INPUT: c, or rho and c, or rho and a tensor xx, xy, xz, yy, yz, zz; anisotropic:A, "
              "with conductivity 1 / (1 + A |k|) in the direction of a principal curvature k, "
              "which is 1 on a sphere of the same area. --eigenpairs writes "
              "coarse_coefficients.npy as well");
  line.choice("boundary", a.boundary, words_of(boundary_words),
              "boundary condition: neumann (zero normal derivative) or dirichlet (zero value)");
  line.flag("intrinsic-delaunay", a.intrinsic_delaunay,
            "for an INPUT of needle triangles: compute and judge eigenvectors on the intrinsic "
            "Delaunay triangulations of INPUT and OUTPUT");
  line.option("signals", a.signals, "F.npy",
              "preserve these functions instead of eigenvectors: a NumPy array of float64 or "
              "float32, one row "
              "for each vertex of INPUT");
  line.flag("binary", a.binary, "a restriction of ones and zeros: it picks vertices of INPUT");
  line.flag("preserve-border", a.preserve_border, "no collapse draws a vertex off the border");
  line.option(
      "labels", a.labels_word, "NAMES",
      "names, separated by commas, of attributes of INPUT whose floating-point numbers are labels: "
      "the label of most weight is taken");
  line.flag(
      "no-attributes", a.no_attributes,
      "do not carry the attributes of vertices and faces. Otherwise OUTPUT has them as well, as "
      "far as its format holds them (.ply all; .obj colours, normals, texture coordinates, "
      "materials and groups; .off colours and normals; .stl colours of faces). The restriction "
      "carries numbers; integers that are no colours are labels, and the one of most weight is "
      "taken. Attributes of faces go by the area that each face of OUTPUT takes over");

  line.advanced_group("Dirty meshes (advanced)");
  line.option(
      "repaired", a.repaired, "FILE",
      "write the mesh that --repair makes: polygons are triangulated, vertices of equal position "
      "merged, cracks closed, degenerate faces removed, sheets that share an edge or a vertex "
      "separated, borders stitched. Changes that leave the surface as it is need no option: "
      "isolated vertices are left out, duplicate faces removed, edges of zero length closed, faces "
      "reoriented to agree with their neighbours. Matrices and maps still number the vertices as "
      "INPUT does");
  line.strict(a.strict);

  line.advanced_group("Operators and interrupts (advanced)");
  line.option("eigenpairs", a.eigenpairs, "DIR",
              "write {fine,coarse}_{eigenvalues,eigenvectors}.npy, {fine,coarse}_{L,mass}.mtx and "
              "C.npy, all "
              "at the scale of the meshes as they are");
  line.option(
      "fit-operators", a.fit_operators, "DIR",
      "fit the entries of a Laplacian and a mass matrix on OUTPUT's vertices to INPUT's spectrum, "
      "and write L.mtx, mass.mtx, eigenvalues.npy and eigenvectors.npy: for functional maps and "
      "spectral distances");
  line.choice("fit-mass", a.fit_mass, {"diagonal", "edges"},
              "where the fitted mass has entries (lumped mass: diagonal, averaged: edges)");
  line.option("fit-rings", a.fit_rings, "1|2",
              "where the fitted Laplacian has entries; 1: at the edges of OUTPUT; 2, the default: "
              "in two rings");
  line.choice(
      "on-interrupt", a.on_interrupt, {"discard", "write"},
      "what Ctrl-C does once vertices have been removed; discard: write nothing; write: what there "
      "is, without evaluation. A second Ctrl-C ends the program at once");
  return line;
}

} // namespace arguments_internal

// Throws with one sentence for what cannot be meant.
inline Arguments parse_arguments(int argc, char* argv[])
{
  Arguments a;
  a.command = command_line("spectral_simplify", argc, argv);
  a.help = arguments_internal::described(a).read(argc, argv);
  return a.help.empty() ? understood(a) : a;
}

#endif // SPECTRAL_EXAMPLES_SPECTRAL_SIMPLIFY_COMMAND_LINE_H
