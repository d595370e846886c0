#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Makes the table and the picture of the manual's section on operators:
#   doc/make_operators.py BUILD MESH... [--needles MESH...]
# BUILD is where the programs and the Python module were built, MESH... are .off or .obj files, those after --needles for the table of
# the intrinsic Delaunay triangulation. Tables go to standard output, the picture, of the demonstration shape, to doc/fig. Needs
# NumPy, SciPy and matplotlib.

import os
import subprocess
import sys
import tempfile
import warnings

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.collections import PolyCollection

N, K = 600, 100


def read_mesh(path):
    with open(path) as file:
        lines = [line.split() for line in file if line.strip() and line[0] != "#"]
    if path.endswith(".off"):
        n, m = int(lines[1][0]), int(lines[1][1])
        return np.array(lines[2:2 + n])[:, :3].astype(float), np.array(lines[2 + n:2 + n + m])[:, 1:4].astype(int)
    V = [line[1:4] for line in lines if line[0] == "v"]
    F = [[word.split("/")[0] for word in line[1:4]] for line in lines if line[0] == "f"]
    return np.array(V, float), np.array(F, int) - 1


# A smooth positive function of the position, between a third and three.
def bumps(V, axis, phase):
    X = V - V.mean(axis=0)
    return np.exp(np.sin(2 * X @ np.array(axis) / np.linalg.norm(X, axis=1).max() + phase))


def operators(ss, V, F):
    weights = ss.weighted_coefficients(bumps(V, (2, -1.5, 1), 0.3), bumps(V, (-1, 1, 2), 2))
    return (("weighted", "averaged", weights), ("anisotropic:1", "averaged", ss.curvature_coefficients(V, F, 1)),
            ("cotangent", "voronoi", None))


# |C|_L, |C|_D and the mean error of the eigenvalues, with a metric that knows the operator and with one that does not.
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


# |C|_L judged in the intrinsic operators and in the mesh's own, of runs with its own eigenvectors and with the intrinsic ones.
def intrinsic_row(ss, V, F):
    pairs = [ss.eigenpairs(V, F, K + K // 5, intrinsic_delaunay=intrinsic) for intrinsic in (True, False)]
    runs = [ss.simplify(V, F, N, K, intrinsic_delaunay=intrinsic) for intrinsic in (False, True)]
    return [ss.evaluate(V, F, run.V, run.F, run.P, K, intrinsic_delaunay=intrinsic, eigenpairs=of).C_L
            for intrinsic, of in zip((True, False), pairs) for run in runs]


# Faces from back to front, by the mean of a function at their corners.
def draw(axes, V, F, f, limit):
    view = np.array([[0.94, 0.0, -0.34], [0.1, 0.96, 0.27], [0.33, -0.29, 0.9]])
    X = (V - V.mean(axis=0)) @ view.T
    normal = np.cross(X[F[:, 1]] - X[F[:, 0]], X[F[:, 2]] - X[F[:, 0]])
    front = normal[:, 2] > 0
    F, light = F[front], (normal[front, 2] / np.linalg.norm(normal[front], axis=1))
    order = np.argsort(X[F][:, :, 2].mean(axis=1))
    colours = plt.get_cmap("PuOr")(0.5 + 0.5 * f[F].mean(axis=1) / limit)
    colours[:, :3] *= (0.55 + 0.45 * light)[:, None]
    polygons = PolyCollection(X[F][order][:, :, :2], facecolors=colours[order], edgecolors=colours[order], linewidths=0.3)
    axes.add_collection(polygons)
    axes.set_aspect("equal")
    axes.autoscale()
    axes.axis("off")


def picture(ss, V, F, path, mode=8):
    figure, panels = plt.subplots(2, 2, figsize=(9, 7.4), dpi=110)
    for row, (name, c) in enumerate((("Laplace-Beltrami", None), ("anisotropic:1", ss.curvature_coefficients(V, F, 1)))):
        run = ss.simplify(V, F, N, K, coefficients=c)
        e = ss.evaluate(V, F, run.V, run.F, run.P, K, coefficients=c, coarse_coefficients=run.coefficients,
                        eigenpairs=run.eigenpairs)
        fine = run.eigenpairs.vectors[:, mode - 1]
        coarse = ss.eigenpairs(run.V, run.F, K, coefficients=run.coefficients).vectors
        nearest = np.argmax(np.abs(e.C[:, mode - 1])) # nearly equal modes may change places
        coarse = coarse[:, nearest] * np.sign(e.C[nearest, mode - 1])
        limit = np.abs(fine).max()
        draw(panels[row, 0], V, F, fine, limit)
        draw(panels[row, 1], run.V, run.F, coarse, limit)
        panels[row, 0].set_title(f"{name}: mode {mode} on {len(V):,} vertices")
        panels[row, 1].set_title(f"on {len(run.V)} vertices, |C|$_L$ = {e.C_L:.1f}")
    figure.tight_layout()
    figure.savefig(path)


def main():
    if len(sys.argv) < 3:
        sys.exit("usage: make_operators.py BUILD MESH... [--needles MESH...]")
    sys.path.insert(0, os.path.join(os.path.abspath(sys.argv[1]), "examples", "python"))
    import spectral_simplification as ss
    warnings.simplefilter("ignore")
    print("| mesh | operator | mass | \\|C\\|_L | \\|C\\|_D | eigenvalues | with the cotangent metric: \\|C\\|_L | \\|C\\|_D | eigenvalues |")
    print("|---|---|---|---|---|---|---|---|---|")
    ratios = []
    split = sys.argv.index("--needles") if "--needles" in sys.argv else len(sys.argv)
    for path in sys.argv[2:split]:
        for name, word, mass, (knows, other) in rows(ss, os.path.splitext(os.path.basename(path))[0], *read_mesh(path)):
            ratios.append(knows[0] / other[0])
            print(f"| {name} | {word} | {mass} | " + " | ".join(f"{x[0]:.1f} | {x[1]:.2f} | {x[2]:.1f} %" for x in (knows, other)) +
                  " |", flush=True)
    print(f"\nmean ratio of |C|_L: {np.mean(ratios):.2f}\n")
    if split < len(sys.argv):
        print("| mesh | intrinsic operators: own eigenvectors | intrinsic ones | own operators: own eigenvectors | intrinsic ones |")
        print("|---|---|---|---|---|")
    for path in sys.argv[split + 1:]:
        row = intrinsic_row(ss, *read_mesh(path))
        print(f"| {os.path.splitext(os.path.basename(path))[0]} | " + " | ".join(f"{x:.1f}" for x in row) + " |", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        shape = os.path.join(folder, "shape.off")
        subprocess.run([os.path.join(sys.argv[1], "examples", "make_demo_shape"), shape, "--vertices", "10000"], check=True)
        picture(ss, *read_mesh(shape), os.path.join(os.path.dirname(os.path.abspath(__file__)), "fig", "operators.png"))


if __name__ == "__main__":
    main()
