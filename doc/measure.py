#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The numbers that README.md, tutorial.md, reference.md and measurements.md quote:
#   doc/measure.py BUILD FOLDER [PART...]  measures them, or parts of them, into measured.json, on a
#                                          machine without other work
#   doc/measure.py --check                 stops at a number in the text that is not the one of the
#                                          data in this folder
# FOLDER has nefertiti.obj and rocker-arm.obj of common-3d-test-models. The data are measured.json,
# figures.json (make_figures.py), scaling.csv and degree.csv (spectral_benchmark --scaling),
# rivals.md and results.md.

import csv
import json
import os
import platform
import re
import statistics
import subprocess
import sys
import tempfile
import time

from make_results import commit
from make_rivals import OURS, SUMMARY

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(HERE, "measured.json")
PRESETS = ("best", "fast", "paper")
# A file, what stands in it, with one space for any white space (a group for each number), and what
# the numbers are.
QUOTED = [
    ("../README.md", r"makes a shape of ([\d,]+) vertices, simplifies it to ([\d,]+), prints",
     ("measured.demo.input_vertices", "measured.demo.output_vertices")),
    ("../README.md", r"\|C\|_L +([\d.]+) [\d.]+ \(ideal linear elements: about ([\d.]+)\)", ("measured.demo.norm_L", "measured.demo.floor_norm_L")),
    ("../README.md", r"\|C\|_D +([\d.]+) [\d.]+ \(ideal linear elements: about ([\d.]+)\)", ("measured.demo.norm_D", "measured.demo.floor_norm_D")),
    ("../README.md", r"eigenvalue error, mean +([\d.]+) %", ("measured.demo.eigenvalue_error_percent",)),
    ("../README.md", r"Two cores take nefertiti\.obj, ([\d,]+) vertices, to 1,000 in ([\d.]+) s with best, ([\d.]+) s with fast, ([\d.]+) s with paper",
     ("measured.nefertiti.vertices", "measured.nefertiti.best.seconds", "measured.nefertiti.fast.seconds", "measured.nefertiti.paper.seconds")),
    ("../README.md", r"`--fit-operators DIR --fit-mass diagonal` \(eigenvalues off by ([\d.]+) % in the mean", ("rivals.lumped.fitted.2",)),
    ("../README.md", r"a million vertices to 10,000 in ([\d.]+) s and ([\d.]+) GB with best, ([\d.]+) s and ([\d.]+) GB with fast",
     ("measured.million.best.seconds", "measured.million.best.gigabytes", "measured.million.fast.seconds", "measured.million.fast.gigabytes")),
    ("measurements.md", r"For nefertiti best takes ([\d.]+) s with one thread and ([\d.]+) s with two",
     ("measured.nefertiti.one_thread.seconds", "measured.nefertiti.best.seconds")),
    ("reference.md", r"Beside `paper`, `best` takes ([\d.]+) times as long for nefertiti", ("best_over_paper",)),
    ("measurements.md", r"A collapse of rocker-arm takes ([\d.]+) µs, first costs included, ([\d.]+) times as long as with Garland-Heckbert's quadrics",
     ("measured.benchmark.us_per_collapse", "measured.benchmark.ratio_garland_heckbert")),
    ("measurements.md", r"everything ([\d.]+) s and ([\d.]+) MB", ("measured.benchmark.seconds_total", "measured.benchmark.peak_rss_mb")),
    ("measurements.md", r"takes ([\d,]+) µs with 1,000 neighbours, where Garland-Heckbert's takes ([\d,]+), and ([\d,]+) with 10,000, where that takes ([\d,]+)",
     tuple(f"degree.{d}.{key}" for d in (1000, 10000) for key in ("us_per_collapse", "us_per_collapse_garland_heckbert"))),
    ("measurements.md", r"with K = 100 the ratio falls from ([\d.]+) at 25,000 vertices to ([\d.]+)\.", ("scaling.25002.100.ratio", "scaling.998562.100.ratio")),
    ("measurements.md", r"A million vertices took ([\d.]+) s and ([\d.]+) GB with K = 100, ([\d.]+) s of them for the eigenpairs; with K = 400 it took "
     r"([\d.]+) s, ([\d.]+) of them for the eigenpairs, and ([\d.]+) GB",
     tuple(f"scaling.998562.{K}.{key}" for K, keys in ((100, ("seconds_total", "gigabytes", "seconds_eigenpairs")),
                                                      (400, ("seconds_total", "seconds_eigenpairs", "gigabytes"))) for key in keys)),
    ("reference.md", r"lumped \| 5\.1 K²/N \| 0 \| ([\d.]+) \| \| averaged \| 2\.2 K³/N² \| 0\.52 K\^1\.5/N \| ([\d.]+) and ([\d.]+) \|",
     ("over_n.lumped.floor.600.L", "over_n.averaged.floor.600.L", "over_n.averaged.floor.600.D")),
    ("reference.md", r"takes ‖C‖_L from ([\d.]+) to ([\d.]+), and relocation to ([\d.]+):", ("figures.steps.0", "figures.steps.1", "figures.steps.2")),
    ("reference.md", r"takes ‖C‖_L from ([\d.]+) to ([\d.]+)\.\*", ("figures.relocation.before", "figures.relocation.after")),
    ("measurements.md", r"‖C‖_L of the preset best is ([\d.]+) to ([\d.]+) times as large as with isotropic remeshing, "
     r"and ‖C‖_D ([\d.]+) to ([\d.]+) times; from 3 K on ([\d.]+) to ([\d.]+) and ([\d.]+) to ([\d.]+) times",
     tuple(f"over_isotropic.{part}.{norm}.{end}" for part in ("below", "above") for norm in ("L", "D") for end in ("least", "most"))),
    ("reference.md", r"by ([\d.]+) % in the mean; the averaged mass is off by ([\d.]+) %, and fitted operators by ([\d.]+) % with a diagonal mass and "
     r"([\d.]+) % with one on the edges", tuple("figures.masses." + key for key in ("lumped", "averaged", "lumped_fitted", "averaged_fitted"))),
    ("reference.md", r"judged in the lumped mass it has ‖C‖_L ([\d.]+) in the mean of nine meshes, paper ([\d.]+) and the best rival ([\d.]+)\. "
     r"Or fit operators with a diagonal mass \(`fit_operators\(\)`\): ([\d.]+), and eigenvalues within ([\d.]+) %",
     ("rivals.lumped.own.0", "lumped_means.paper", "lumped_means.rival", "rivals.lumped.fitted.0", "rivals.lumped.fitted.2")),
    ("measurements.md", r"The 100 pairs of nefertiti to 1e-8 take ([\d.]+) s with one thread and ([\d.]+) s with two, to 1e-4 ([\d.]+) and ([\d.]+) s; "
     r"Spectra takes ([\d.]+) s", tuple("measured.pairs." + key for key in ("1e-08 one", "1e-08 all", "1e-04 one", "1e-04 all", "spectra"))),
    ("reference.md", r"wears capes away, ([\d.]+) % of the area", ("border_loss",)),
    ("reference.md", r"its ‖C‖_L is ([\d.]+), and ([\d.]+) where the metric did not know the operator",
     ("figures.operators.0", "figures.operators.1")),
    ("tutorial.md", r"at N = 3 K the eigenvalues are off by ([\d.]+) %",
     ("over_n.averaged.best.300.percent",)),
    ("reference.md", r"within ([\d.]+) % instead of ([\d.]+) % in the mean of nine meshes", ("rivals.averaged.own.2", "rivals.lumped.own.2")),
    ("reference.md", r"reduced from 25,600 to 768 vertices ‖C‖_L is ([\d.]+) without `preserve_border` and ([\d.]+) with it \(both relocated\)",
     ("results.mountain 768.best", "results.mountain 768.preserved")),
    ("measurements.md", r"‖C‖_L falls to ([\d.]+) to ([\d.]+) times the mesh's own, ‖C‖_D to ([\d.]+) to ([\d.]+) times",
     ("fitted.0.least", "fitted.0.most", "fitted.1.least", "fitted.1.most")),
]
# The tables of measurements.md, by the first cell of a row: what its other cells are.
TABLES = {"‖C‖_L, averaged, best": [f"over_n.averaged.best.{N}.L" for N in (100, 200, 300, 600, 1400)],
          "‖C‖_D, averaged, best": [f"over_n.averaged.best.{N}.D" for N in (100, 200, 300, 600, 1400)],
          "mean eigenvalue error, averaged, best": [f"over_n.averaged.best.{N}.percent" for N in (100, 200, 300, 600, 1400)],
          "‖C‖_L, lumped, best": [f"over_n.lumped.best.{N}.L" for N in (100, 200, 300, 600, 1400)]}
for title, key in (("from file to file", "seconds"), ("eigenpairs or filtered signals", "seconds_eigenpairs"), ("collapses", "seconds_collapse"),
                   ("relocation", "seconds_relocation")):
    TABLES[title] = [f"measured.nefertiti.{preset}.{key}" for preset in PRESETS]


# --- measuring ------------------------------------------------------------------------------------


# Seconds and peak memory in GB.
def run(command):
    start = time.time()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command)
    return time.time() - start, usage.ru_maxrss * 1024 / 1e9


def simplified(build, *arguments):
    with tempfile.TemporaryDirectory() as folder:
        output = os.path.join(folder, "run.json")
        seconds, gigabytes = run([os.path.join(build, "examples", "spectral_simplify"), arguments[0], os.path.join(folder, "coarse.off"), *arguments[1:],
                       "--quiet", "--json", output])
        with open(output) as file:
            return {**json.load(file), "seconds": seconds, "gigabytes": gigabytes}


def demo(build, _):
    with tempfile.TemporaryDirectory() as folder:
        shape = os.path.join(folder, "shape.ply")
        run([os.path.join(build, "examples", "make_demo_shape"), shape])
        result = simplified(build, shape, "--vertices", "3%")
    return {**{key: result[key] for key in ("input_vertices", "output_vertices", "norm_L", "norm_D", "floor_norm_L", "floor_norm_D")},
            "eigenvalue_error_percent": 100 * result["eigenvalue_error_mean"]}


# To 1,000 vertices three times with each preset, and with best on one thread.
def nefertiti(build, meshes):
    runs, one_thread = {preset: [] for preset in PRESETS}, []
    for _ in range(3):
        one_thread.append(simplified(build, os.path.join(meshes, "nefertiti.obj"), "--vertices", "1000", "--threads", "1", "--no-evaluation"))
        for preset in PRESETS:
            runs[preset].append(simplified(build, os.path.join(meshes, "nefertiti.obj"), "--vertices", "1000", "--preset", preset,
                                           "--no-evaluation"))
    return {"vertices": runs["best"][0]["input_vertices"],
            **{preset: {key: statistics.median(r[key] for r in runs[preset])
                        for key in ("seconds", "seconds_eigenpairs", "seconds_collapse", "seconds_relocation")} for preset in PRESETS},
            "one_thread": {"seconds": statistics.median(r["seconds"] for r in one_thread)}}


def benchmark(build, meshes):
    with tempfile.TemporaryDirectory() as folder:
        output = os.path.join(folder, "benchmark.json")
        run([os.path.join(build, "test", "benchmark", "spectral_benchmark"), os.path.join(meshes, "rocker-arm.obj"), "--vertices", "1000",
             "--no-spectra", "--json", output])
        with open(output) as file:
            return json.load(file)["rocker-arm.obj"]


# The first 100 of nefertiti, beside Spectra's.
def pairs(build, meshes):
    def rows(*arguments):
        with tempfile.TemporaryDirectory() as folder:
            output = os.path.join(folder, "pairs.json")
            run([os.path.join(build, "test", "benchmark", "spectral_benchmark"), os.path.join(meshes, "nefertiti.obj"), *arguments, "--json", output])
            with open(output) as file:
                return json.load(file)["nefertiti.obj"]["pairs"]

    result = {f"{row['tolerance']:.0e} {'one' if row['threads'] == 1 else 'all'}": row["seconds"] for row in rows("--pairs", "1e-4,1e-8")}
    return {**result, "spectra": rows("--pairs", "1e-8", "--solver", "spectra", "--runs", "1")[0]["seconds"]}


# A shape of a million vertices to a hundredth.
def million(build, _):
    with tempfile.TemporaryDirectory() as folder:
        shape = os.path.join(folder, "shape.ply")
        run([os.path.join(build, "examples", "make_demo_shape"), shape, "--vertices", "1000000"])
        runs = {preset: simplified(build, shape, "--vertices", "1%", "--preset", preset, "--no-evaluation") for preset in PRESETS}
    return {"vertices": runs["best"]["input_vertices"],
            **{preset: {key: runs[preset][key] for key in ("seconds", "seconds_eigenpairs", "gigabytes")} for preset in PRESETS}}


PARTS = {"demo": demo, "nefertiti": nefertiti, "benchmark": benchmark, "pairs": pairs, "million": million}


def measure(build, meshes, parts):
    with open(DATA) as file:
        data = json.load(file)
    for part in parts:
        data[part] = {"commit": commit(), "processors": os.cpu_count(), "machine": platform.machine(), **PARTS[part](os.path.abspath(build), meshes)}
    with open(DATA, "w") as file:
        json.dump(data, file, indent=1)
        file.write("\n")


# --- checking -------------------------------------------------------------------------------------


# The number as it stands in the text, with as many digits.
def written(value, quoted):
    digits = len(quoted.partition(".")[2])
    return value if isinstance(value, str) else f"{value:,.{digits}f}"


# The cells of each row of a table, without bold, by the first.
def cells(table):
    rows = [[cell.strip(" *") for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in table.splitlines() if line.startswith("| ")]
    return {row[0]: row[1:] for row in rows}


def read(name):
    with open(os.path.join(HERE, name)) as file:
        return file.read()


# |C|_L, |C|_D, error of the eigenvalues and of the biharmonic distance in a part of rivals.md: of
# the preset best and with fitted operators.
def ours(part):
    rows = cells(part)
    # The tables of single meshes have a column with N, a whole number, before.
    columns = [[row[i] for i in ((0, 1, 2, 6) if "." in row[0] else (1, 2, 3, 7))]
               for row in (rows["this package"], rows["this package, operators fitted"])]
    return dict(zip(("own", "fitted"), columns))


# Both masses of each part of rivals.md, by the name of the mesh and N, and the means.
def rivals_by_mesh():
    text, result = read("rivals.md"), {}
    for title, part in re.findall(r"\n## ([^\n]*)\n(.*?)(?=\n## |\Z)", text, re.S):
        mesh = re.fullmatch(r"([a-z-]+)\.[a-z]+, \d+ vertices, N = (\d+)", title)
        if mesh:
            averaged, lumped = part.split("Judged in the lumped mass:")
            result[f"{mesh[1]}, {mesh[2]}"] = {"averaged": ours(averaged), "lumped": ours(lumped)}
    means = {mass: ours(text.split(f"## Geometric means, judged in the {mass} mass")[1].split("\n## ")[0]) for mass in ("averaged", "lumped")}
    return result, means


def table_of(name):
    with open(os.path.join(HERE, name), newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def data_of():
    data = {"measured": json.loads(read("measured.json")), "figures": json.loads(read("figures.json")), "over_n": {}, "scaling": {}}
    data["best_over_paper"] = data["measured"]["nefertiti"]["best"]["seconds"] / data["measured"]["nefertiti"]["paper"]["seconds"]
    for line in data["figures"]["norms_over_n"]:
        data["over_n"].setdefault(line["mass"], {})[line["line"]] = {
            str(point[0]): dict(zip(("L", "D", "percent"), point[1:])) for point in line["points"]}
    data["degree"] = {f"{row['vertices'] - 1:.0f}": row for row in table_of("degree.csv")}
    data["border_loss"] = -data["figures"]["border"]["paper"]["area_percent"]
    best, even = ([p for line in data["figures"]["norms_over_n"] if (line["mass"], line["line"]) == ("averaged", name) for p in line["points"]]
                  for name in ("best", "isotropic"))
    data["over_isotropic"] = {}
    for part, wanted in (("below", lambda n: n < 300), ("above", lambda n: n >= 300)):
        over = {norm: [a[k] / b[k] for a, b in zip(best, even) if wanted(a[0])] for k, norm in ((1, "L"), (2, "D"))}
        data["over_isotropic"][part] = {norm: {"least": min(r), "most": max(r)} for norm, r in over.items()}
    for row in table_of("scaling.csv"):
        row.update(ratio=row["us_per_collapse"] / row["us_per_collapse_garland_heckbert"], gigabytes=row["peak_rss_mb"] / 1000)
        data["scaling"].setdefault(f"{row['vertices']:.0f}", {})[f"{row['eigenvectors']:.0f}"] = row
    meshes, data["rivals"] = rivals_by_mesh()
    means = {title: float(row[0]) for title, row in
             cells(read("rivals.md").split("## Geometric means, judged in the lumped mass")[1].split("\n## ")[0]).items() if re.match(r"[\d.]+$", row[0])}
    paper = OURS["spectral, paper"].strip("*")
    ours = [title.strip("*") for title in OURS.values()]
    data["lumped_means"] = {"paper": means[paper], "rival": min(value for title, value in means.items() if title not in ours)}
    ratios = [[float(m["averaged"]["fitted"][k]) / float(m["averaged"]["own"][k]) for m in meshes.values()] for k in (0, 1)]
    data["fitted"] = [{"least": min(r), "most": max(r)} for r in ratios]
    norms = read("results.md").split("C_L, judged in the averaged mass:")[1].split("\n\n")[1]
    titles, rows = cells(norms)["simplifier"], cells(norms)
    data["results"] = {title: {"best": rows["spectral, best, free, averaged metric, relocated by sampled"][k],
                               "preserved": rows["spectral, best, border preserved, free, averaged metric, relocated by sampled"][k]}
                       for k, title in enumerate(titles)}
    return data, meshes


def check():
    wrong = []
    data, meshes = data_of()

    def value_of(key):
        value = data
        for part in key.split("."):
            value = value[int(part) if isinstance(value, list) else part]
        return value

    def compare(name, quoted, key):
        value = value_of(key)
        if written(value, quoted) != quoted:
            wrong.append(f"{name} says {quoted} for {key}, which is {value}")

    for name, pattern, keys in QUOTED:
        found = re.search(pattern, re.sub(r"\s+", " ", read(name)))
        if not found:
            wrong.append(f"{name} does not say: {pattern}")
            continue
        for quoted, key in zip(found.groups(), keys):
            compare(name, quoted, key)
    rows = cells(read("measurements.md"))
    for title, keys in TABLES.items():
        if len(rows.get(title, [])) != len(keys):
            wrong.append(f"measurements.md has no row of {len(keys)} numbers '{title}'")
            continue
        for quoted, key in zip(rows[title], keys):
            compare("measurements.md", quoted.removesuffix(" %"), key)
    # The table of fitted operators is a part of rivals.md.
    for title, both in list(meshes.items()) + [("geometric mean", data["rivals"])]:
        wanted = [" / ".join(both[mass][which]) for mass in ("averaged", "lumped") for which in ("own", "fitted")]
        if rows.get(title) != wanted:
            wrong.append(f"measurements.md and rivals.md differ in the row {title}: {' | '.join(wanted)}")
    for page in ("tutorial.md", "reference.md", "measurements.md"):
        text = read(page)
        numbers = [int(n) for n in re.findall(r"^\*Figure (\d+)\. ", text, re.M)]
        if numbers != list(range(1, text.count("](fig/") + 1)):
            wrong.append(f"The figures of {page} are numbered {numbers}")
        tags = [int(n) for n in re.findall(r"\\tag\{(\d+)\}", text)]
        if tags != list(range(1, len(tags) + 1)):
            wrong.append(f"The formulas of {page} are numbered {tags}")
    # The table of the README is a part of the averaged one in rivals.md, and what it says of
    # further meshes stands there.
    rivals, readme = read("rivals.md"), read("../README.md")
    rows = cells(rivals.split("## Geometric means, judged in the averaged mass")[1].split("\n## ")[0])
    table = cells(readme.split("<!-- summary: begin -->")[1].split("<!-- summary: end -->")[0])
    for name, title in SUMMARY.items():
        if title.strip("*") not in table or table[title.strip("*")] != rows.get(OURS.get(name, name).strip("*"), [])[:8]:
            wrong.append(f"README.md and rivals.md differ in {title}")
    survey = rivals.split("<!-- survey: begin -->")[1]
    found = re.search(r"On (\d+) further meshes \|C\|_L is ([\d.]+) times as large as with the probabilistic quadrics on average, and lower on (\d+)\.",
                      re.sub(r"\s+", " ", readme))
    if not found or (found[2], f"{found[3]} of {found[1]}") != tuple(cells(survey)[k][0] for k in ("ratio, geometric mean", "the default is better")):
        wrong.append("README.md does not say of further meshes what rivals.md says")
    sys.exit("\n".join(wrong) or None)


def main():
    if sys.argv[1:] == ["--check"]:
        check()
    if len(sys.argv) < 3 or not set(sys.argv[3:]) <= set(PARTS):
        sys.exit("usage: measure.py BUILD FOLDER [PART...], or --check; parts: " + " ".join(PARTS))
    measure(sys.argv[1], sys.argv[2], sys.argv[3:] or PARTS)


if __name__ == "__main__":
    main()
