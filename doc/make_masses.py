#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The table of masses in measurements.md: each MESH simplified to 600 vertices in each mass, and
# every result judged in all of them.
#   doc/make_masses.py BUILD MESH...
# BUILD is where the Python module was built, MESH... are files that it reads. Needs NumPy and
# SciPy.

import math
import os
import sys

from make_results import commit, replace

N, K = 600, 100
MASSES = ("lumped", "voronoi", "averaged", "consistent")


# All but that of the constant.
def at_unit_area(pairs):
    return pairs.values[1:] * pairs.M.sum()


def main():
    if len(sys.argv) < 3:
        sys.exit("usage: make_masses.py BUILD MESH...")
    sys.path.insert(0, os.path.join(sys.argv[1], "examples", "python"))
    import spectral_simplification as ss

    errors = {run: {judge: [] for judge in MASSES} for run in MASSES}
    largest = {run: {judge: [] for judge in MASSES} for run in MASSES}
    for mesh in sys.argv[2:]:
        V, F = ss.read_mesh(mesh)
        fine = {judge: at_unit_area(ss.eigenpairs(V, F, K, judge)) for judge in MASSES}
        for run in MASSES:
            result = ss.simplify(V, F, N, K, mass=run)
            for judge in MASSES:
                e = abs(at_unit_area(result.coarse_eigenpairs(K, judge)) / fine[judge] - 1)
                errors[run][judge].append(100 * e.mean())
                largest[run][judge].append(100 * e.max())
    mean = lambda values: math.exp(sum(map(math.log, values)) / len(values))
    lines = [f"Commit {commit()}. Mean error of the eigenvalues in %, and the largest.", "",
             "| mass of the run | " + " | ".join("judged " + judge for judge in MASSES) + " |", "|---" * (len(MASSES) + 1) + "|"]
    for run in MASSES:
        lines.append(f"| {run} | " + " | ".join(f"{mean(errors[run][j]):.2f}, {mean(largest[run][j]):.1f}" for j in MASSES) + " |")
    replace(os.path.join(os.path.dirname(os.path.abspath(__file__)), "measurements.md"), "masses", "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
