#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# How long 100 eigenpairs take on large meshes, beside what others have published:
#   doc/make_spectra.py [--measured] BUILD [FOLDER]
# makes the demonstration's shape at the sizes of the published tables, runs BUILD's
# spectral_benchmark on them (target spectral_benchmark), and writes the table into rivals.md. What
# it makes goes to FOLDER (BUILD/spectra) and is used again when it is there; with --measured the
# table has nothing else. A solver that takes longer than LIMIT seconds has a row that says so.
# Where RUN_BY is set, each measurement is run by that command: a lock, on a machine with other work
# to do.

import json
import os
import shlex
import subprocess
import sys

from make_results import commit, replace

HERE = os.path.dirname(os.path.abspath(__file__))
LIMIT = 240
K = 100
# Published seconds for 100 pairs at a tolerance: Nasikun and Hildebrandt, The Hierarchical Subspace
# Iteration Method for Laplace-Beltrami Eigenproblems, ACM Transactions on Graphics 41 (2022).
HSIM = {85000: {1e-2: 10.5, 1e-4: 18.0}, 270000: {1e-2: 35.8, 1e-4: 68.9}, 570000: {1e-2: 93.9, 1e-4: 142.8}}
OURS, SPECTRA = ("1e-2", "1e-4", "1e-6", "1e-8"), ("1e-2", "1e-8")


# What the benchmark says of one tolerance; None where it took too long.
def measured(build, mesh, output, solver, tolerance):
    if not os.path.exists(output):
        command = [os.path.join(build, "test", "benchmark", "spectral_benchmark"), mesh, "--pairs", tolerance, "--solver", solver,
                   "--eigenvectors", str(K), "--runs", "1", "--json", output + ".new"]
        status = subprocess.call([*shlex.split(os.environ.get("RUN_BY", "")), "timeout", str(LIMIT), *command], stdout=subprocess.DEVNULL)
        if status == 124:
            with open(output + ".new", "w") as file:
                json.dump({}, file)
        elif status:
            sys.exit(f"make_spectra.py: failed: {' '.join(command)}")
        os.rename(output + ".new", output)
    with open(output) as file:
        return next(iter(json.load(file).values()), None)


# On what the figures of a table were measured.
def machine():
    with open("/proc/cpuinfo") as file:
        model = next(line.split(":")[1].strip() for line in file if line.startswith("model name"))
    return f"{model}, {os.cpu_count()} cores; commit {commit()}"


def main():
    words = [word for word in sys.argv[1:] if word != "--measured"]
    if len(words) not in (1, 2):
        sys.exit("usage: make_spectra.py [--measured] BUILD [FOLDER]")
    build = words[0]
    folder = words[1] if len(words) == 2 else os.path.join(build, "spectra")
    os.makedirs(folder, exist_ok=True)
    lines = []
    for size, published in HSIM.items():
        mesh = os.path.join(folder, f"shape-{size}.off")
        if not os.path.exists(mesh):
            subprocess.run([os.path.join(build, "examples", "make_demo_shape"), mesh, "--vertices", str(size)], check=True)
        for solver, tolerances in (("block", OURS), ("spectra", SPECTRA)):
            for tolerance in tolerances:
                output = os.path.join(folder, f"shape-{size}-{solver}-{tolerance}.json")
                if "--measured" in sys.argv and not os.path.exists(output):
                    continue
                found = measured(build, mesh, output, solver, tolerance)
                name = "**this package**" if solver == "block" else "Spectra with CHOLMOD"
                if found is None:
                    lines.append(f"| | {name} | {tolerance} | | more than {LIMIT} | – | |")
                    continue
                description, n = found["build"], found["vertices"]
                one = next(p for p in found["pairs"] if p["threads"] == 1)
                many = [f"{p['seconds']:.1f}" for p in found["pairs"] if p["threads"] > 1]
                lines.append(f"| {n if solver == 'block' and tolerance == tolerances[0] else ''} | {name} | {tolerance} | {one['residual']:.0e} | "
                             f"{one['seconds']:.1f} | {many[0] if many else '–'} | {one['peak_rss_mb']:.0f} |")
        for tolerance, seconds in published.items():
            lines.append(f"| {size} | HSIM, published | | {tolerance:.0e} | {seconds} on another machine | | |")
    table = [f"K = {K}, averaged mass, one run; {description}; {machine()}.", "",
             "| vertices | | tolerance | largest residual | 1 thread, s | all threads, s | peak MB |", "|---:|---|---|---|---:|---:|---:|", *lines]
    replace(os.path.join(HERE, "rivals.md"), "spectra", "\n".join(table) + "\n")


if __name__ == "__main__":
    main()
