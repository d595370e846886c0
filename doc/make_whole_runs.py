#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Time, memory and quality of whole runs over the number of vertices, all to N:
#   doc/make_whole_runs.py BUILD N
# makes shapes of 5,000 to 1,000,000 vertices, takes each to N with best, fast and CGAL's plane
# quadrics, one after the other, from file to file without evaluation, and judges the results up to
# LARGEST_JUDGED. Writes whole_runs.csv, which make_figures.py draws, and the table of
# measurements.md. BUILD has the programs and test/benchmark/garland_heckbert.

import csv
import json
import os
import subprocess
import sys
import tempfile

from make_results import commit, replace
from make_rivals import measure

HERE = os.path.dirname(os.path.abspath(__file__))
SIZES = (5000, 20000, 80000, 320000, 1000000)
LARGEST_JUDGED = 320000
COLUMNS = ("vertices", "program", "seconds", "gigabytes", "norm_L", "norm_D", "eigenvalues_percent")


def timed(command, path):
    if measure(900, path, command):
        sys.exit(f"'{' '.join(command)}' failed.")
    with open(path) as file:
        found = json.load(file)
    return found["wall_seconds"], found["peak_megabytes"] * 1024**2 / 1e9


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: make_whole_runs.py BUILD N")
    build, n = sys.argv[1:]
    make, simplify, compare = (os.path.join(build, "examples", x) for x in
                               ("make_demo_shape", "spectral_simplify", "spectral_compare"))
    quadrics = os.path.join(build, "test", "benchmark", "garland_heckbert")
    for program in make, simplify, compare, quadrics, "/usr/bin/time":
        if not os.access(program, os.X_OK):
            sys.exit(f"{program} is missing: build that target, or on Debian apt-get install time.")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        shape, judged = (os.path.join(folder, x) for x in ("shape.off", "judged.json"))
        for size in SIZES:
            subprocess.run([make, shape, "--vertices", str(size)], check=True)
            with open(shape) as file:
                file.readline()
                vertices = int(file.readline().split()[0])
            results = {name: os.path.join(folder, name.split()[-1] + ".off")
                       for name in ("best", "fast", "plane quadrics")}
            found = {}
            for name, result in results.items():
                found[name] = timed([quadrics, shape, result, n] if name == "plane quadrics" else
                                    [simplify, shape, result, "--vertices", n, "--preset", name,
                                     "--no-evaluation", "--quiet"], judged)
            quality = {}
            if size <= LARGEST_JUDGED:
                rivals = [x for name, path in results.items()
                          for x in ("--rival", f"{name}={path}")]
                subprocess.run([compare, shape, *rivals, "--judge", "averaged", "--quiet", "--json",
                                judged], check=True, stdout=subprocess.DEVNULL)
                with open(judged) as file:
                    quality = {r["simplifier"]: r for r in json.load(file)["rows"]}
            for name, (seconds, gigabytes) in found.items():
                r = quality.get(name)
                norms = ("", "", "") if r is None else (
                    r["closest_point_P"]["norm_L"], r["closest_point_P"]["norm_D"],
                    100 * r["eigenvalue_error_mean"])
                rows.append((vertices, name, seconds, gigabytes, *norms))
    with open(os.path.join(HERE, "whole_runs.csv"), "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for row in rows:
            writer.writerow([f"{x:.4g}" if isinstance(x, float) else x for x in row])
    text = [f"To {int(n):,} vertices, commit {commit()}.", "",
            "| vertices | program | s | GB | ‖C‖_L | ‖C‖_D | eigenvalues, % |",
            "|---:|---|---:|---:|---:|---:|---:|"]
    for vertices, name, seconds, gigabytes, *norms in rows:
        cells = [f"{x:.{d}f}" if x != "" else "–" for x, d in zip(norms, (1, 2, 2))]
        text.append(f"| {vertices:,} | {name} | {seconds:.1f} | {gigabytes:.2f} | "
                    + " | ".join(cells) + " |")
    replace(os.path.join(HERE, "measurements.md"), "whole-runs", "\n".join(text) + "\n")


if __name__ == "__main__":
    main()
