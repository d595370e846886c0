#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Makes the tables of the manual's section on operators:
#   doc/make_operators.py BUILD MESH... [--needles MESH...]
# BUILD is where the programs and the Python module were built, MESH... are .off or .obj files,
# those after --needles for the table of the intrinsic Delaunay triangulation. Tables go to standard
# output. Needs what pictures.py does.

import os
import sys
import warnings

import numpy as np

from pictures import package

N, K = 600, 100


# A smooth positive function of the position, between a third and three.
def bumps(V, axis, phase):
    X = V - V.mean(axis=0)
    return np.exp(np.sin(2 * X @ np.array(axis) / np.linalg.norm(X, axis=1).max() + phase))


def operators(ss, V, F):
    weights = ss.weighted_coefficients(bumps(V, (2, -1.5, 1), 0.3), bumps(V, (-1, 1, 2), 2))
    return (("weighted", "averaged", weights), ("anisotropic:1", "averaged", ss.curvature_coefficients(V, F, 1)),
            ("cotangent", "voronoi", None))


# |C|_L, |C|_D and the mean error of the eigenvalues, with a metric that knows the operator and with
# one that does not.
def rows(ss, name, V, F):
    plain = ss.simplify(V, F, N, K)
    carried = ss.simplify(V, F, N, K, eigenpairs=plain.eigenpairs, relocate="none").P
    for word, mass, coefficients in operators(ss, V, F):
        pairs = ss.eigenpairs(V, F, K + K // 5, mass, coefficients=coefficients)
        knows = ss.simplify(V, F, N, K, mass=mass, coefficients=coefficients)
        own = [(knows, knows.coefficients), (plain, None if coefficients is None else carried @ coefficients)]
        results = [ss.evaluate(V, F, run.V, run.F, run.P, K, mass, coefficients=coefficients, coarse_coefficients=coarse,
                               eigenpairs=pairs) for run, coarse in own]
        yield name, word, mass, [(e.C_L, e.C_D, 100 * e.eigenvalue_error) for e in results]


# |C|_L judged in the intrinsic operators and in the mesh's own, of runs with its own eigenvectors
# and with the intrinsic ones.
def intrinsic_row(ss, V, F):
    pairs = [ss.eigenpairs(V, F, K + K // 5, intrinsic_delaunay=intrinsic) for intrinsic in (True, False)]
    runs = [ss.simplify(V, F, N, K, intrinsic_delaunay=intrinsic) for intrinsic in (False, True)]
    return [ss.evaluate(V, F, run.V, run.F, run.P, K, intrinsic_delaunay=intrinsic, eigenpairs=of).C_L
            for intrinsic, of in zip((True, False), pairs) for run in runs]


def main():
    if len(sys.argv) < 3:
        sys.exit("usage: make_operators.py BUILD MESH... [--needles MESH...]")
    ss = package(sys.argv[1])
    warnings.simplefilter("ignore")
    print("| mesh | operator | mass | \\|C\\|_L | \\|C\\|_D | eigenvalues | with the cotangent metric: \\|C\\|_L | \\|C\\|_D | eigenvalues |")
    print("|---|---|---|---|---|---|---|---|---|")
    ratios = []
    split = sys.argv.index("--needles") if "--needles" in sys.argv else len(sys.argv)
    for path in sys.argv[2:split]:
        mesh = os.path.splitext(os.path.basename(path))[0]
        for name, word, mass, (knows, other) in rows(ss, mesh, *ss.read_mesh(path)):
            ratios.append(knows[0] / other[0])
            print(f"| {name} | {word} | {mass} | " + " | ".join(f"{x[0]:.1f} | {x[1]:.2f} | {x[2]:.1f} %" for x in (knows, other)) +
                  " |", flush=True)
    print(f"\nmean ratio of |C|_L: {np.mean(ratios):.2f}\n")
    if split < len(sys.argv):
        print("| mesh | intrinsic operators: own eigenvectors | intrinsic ones | own operators: own eigenvectors | intrinsic ones |")
        print("|---|---|---|---|---|")
    for path in sys.argv[split + 1:]:
        row = intrinsic_row(ss, *ss.read_mesh(path))
        print(f"| {os.path.splitext(os.path.basename(path))[0]} | " + " | ".join(f"{x:.1f}" for x in row) + " |", flush=True)


if __name__ == "__main__":
    main()
