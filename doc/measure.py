#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The numbers that README.md and user_manual.md quote:
#   doc/measure.py BUILD NEFERTITI    measures them into measured.json, on a machine without other work
#   doc/measure.py --check            stops at a number in the text that is not the one in measured.json
# NEFERTITI is nefertiti.obj of common-3d-test-models, to 1,000 vertices three times with each preset.

import json
import os
import platform
import re
import statistics
import subprocess
import sys
import tempfile
import time

from make_rivals import OURS, SUMMARY

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(HERE, "measured.json")
PRESETS = ("best", "fast", "paper")
# A file, what stands in it (a group for each number), and what the numbers are.
QUOTED = [
    ("../README.md", r"makes a shape of ([\d,]+) vertices, simplifies it to ([\d,]+), prints", ("demo.input_vertices", "demo.output_vertices")),
    ("../README.md", r"\|C\|_L +([\d.]+)   \(ideal linear elements: about ([\d.]+)\)", ("demo.norm_L", "demo.floor_norm_L")),
    ("../README.md", r"\|C\|_D +([\d.]+)   \(ideal linear elements: about ([\d.]+)\)", ("demo.norm_D", "demo.floor_norm_D")),
    ("../README.md", r"eigenvalue error, mean +([\d.]+) %", ("demo.eigenvalue_error_percent",)),
    ("../README.md", r"nefertiti\.obj, ([\d,]+) vertices, to 1,000 on two\ncores: ([\d.]+) s with best, ([\d.]+) s with fast, ([\d.]+) s with paper",
     ("nefertiti.vertices", "nefertiti.best.seconds", "nefertiti.fast.seconds", "nefertiti.paper.seconds")),
    ("user_manual.md", r"nefertiti to 1,000 vertices takes ([\d.]+) s with best: ([\d.]+) s of it for the eigenpairs, ([\d.]+) s for the "
     r"collapses and\n([\d.]+) s for relocation",
     ("nefertiti.best.seconds", "nefertiti.best.seconds_eigenpairs", "nefertiti.best.seconds_collapse", "nefertiti.best.seconds_relocation")),
]


def run(command):
    start = time.time()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.time() - start


def measured(build, nefertiti):
    programs = os.path.join(os.path.abspath(build), "examples")
    simplify = os.path.join(programs, "spectral_simplify")
    with tempfile.TemporaryDirectory() as folder:
        shape, coarse, output = (os.path.join(folder, name) for name in ("shape.ply", "coarse.off", "run.json"))

        def result(*arguments):
            seconds = run([simplify, *arguments, "--quiet", "--json", output])
            with open(output) as file:
                return {**json.load(file), "seconds": seconds}

        run([os.path.join(programs, "make_demo_shape"), shape])
        demo = result(shape, coarse, "--vertices", "3%")
        data = {"demo": {**{key: demo[key] for key in ("input_vertices", "output_vertices", "norm_L", "norm_D", "floor_norm_L", "floor_norm_D")},
                         "eigenvalue_error_percent": 100 * demo["eigenvalue_error_mean"]}, "nefertiti": {}}
        runs = {preset: [] for preset in PRESETS}
        for _ in range(3):
            for preset in PRESETS:
                runs[preset].append(result(nefertiti, coarse, "--vertices", "1000", "--preset", preset, "--no-evaluation"))
        data["nefertiti"]["vertices"] = runs["best"][0]["input_vertices"]
        for preset in PRESETS:
            data["nefertiti"][preset] = {key: statistics.median(r[key] for r in runs[preset])
                                         for key in ("seconds", "seconds_eigenpairs", "seconds_collapse", "seconds_relocation")}
    return {"commit": subprocess.run(["git", "-C", HERE, "describe", "--always", "--dirty"], capture_output=True, text=True, check=True).stdout.strip(),
            "processors": os.cpu_count(), "machine": platform.machine(), **data}


# The number as it stands in the text, with as many digits.
def written(value, quoted):
    digits = len(quoted.partition(".")[2])
    return f"{value:,.{digits}f}"


# The cells of each row of a table, without bold, by the first.
def cells(table):
    rows = [[cell.strip(" *") for cell in line.split("|")[1:-1]] for line in table.splitlines() if line.startswith("| ")]
    return {row[0]: row[1:] for row in rows}


def check():
    with open(DATA) as file:
        data = json.load(file)
    wrong = []
    for name, pattern, keys in QUOTED:
        with open(os.path.join(HERE, name)) as file:
            found = re.search(pattern, file.read())
        if not found:
            wrong.append(f"{name} does not say: {pattern}")
            continue
        for quoted, key in zip(found.groups(), keys):
            value = data
            for part in key.split("."):
                value = value[part]
            if written(value, quoted) != quoted:
                wrong.append(f"{name} says {quoted} for {key}, which is {value}")
    # The table of the README is a part of that of the averaged mass in rivals.md, and what it says of further meshes stands there.
    with open(os.path.join(HERE, "rivals.md")) as file:
        rivals = file.read()
    with open(os.path.join(HERE, "..", "README.md")) as file:
        readme = file.read()
    rows = cells(rivals.split("## Geometric means, judged in the averaged mass")[1].split("\n## ")[0])
    table = cells(readme.split("<!-- summary: begin -->")[1].split("<!-- summary: end -->")[0])
    for name, title in SUMMARY.items():
        if table.get(title.strip("*")) != rows[OURS.get(name, name).strip("*")][:6]:
            wrong.append(f"README.md and rivals.md differ in {title}")
    survey = rivals.split("<!-- survey: begin -->")[1]
    found = re.search(r"On (\d+) further meshes \|C\|_L is ([\d.]+) times that of the probabilistic quadrics on the average, and lower on (\d+)\.", readme)
    if not found or (found[2], f"{found[3]} of {found[1]}") != tuple(cells(survey)[k][0] for k in ("ratio, geometric mean", "the default is better")):
        wrong.append("README.md does not say of further meshes what rivals.md says")
    sys.exit("\n".join(wrong) or None)


def main():
    if sys.argv[1:] == ["--check"]:
        check()
    if len(sys.argv) != 3:
        sys.exit("usage: measure.py BUILD NEFERTITI, or --check")
    data = measured(*sys.argv[1:])
    with open(DATA, "w") as file:
        json.dump(data, file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
