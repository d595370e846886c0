#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Writes the tables of results.md and the summary in it:
#   doc/make_results.py BUILD FOLDER MESH...
# BUILD is where the programs were built (with a CGAL of 6.1 or later, for all remeshers), FOLDER
# where the meshes are and where one JSON file per mesh goes: BUILD/results. An existing file is
# used again. The text outside of the marks stays.

import json
import math
import os
import subprocess
import sys

SIZES = "3%,600"
# Simplifiers that do not come to an end on a mesh.
WITHOUT = {"nefertiti.obj": "centroidal"}
# The rows of the summary: the two presets, and CGAL's own that are used most or come nearest.
SUMMARY = {"spectral, best": "**this package**", "spectral, paper": "this package, preset `paper`",
           "spectral, best, fitted operators": "this package, operators fitted",
           "Garland-Heckbert plane": "Garland-Heckbert, plane quadrics",
           "Garland-Heckbert probabilistic plane, area 20000": "Garland-Heckbert, probabilistic plane quadrics",
           "Lindstrom-Turk": "Lindstrom-Turk", "isotropic remeshing": "isotropic remeshing"}


def options(mesh):
    return ["--without", WITHOUT[mesh]] if mesh in WITHOUT else []


def compare(build, folder, mesh):
    program = os.path.join(build, "examples", "spectral_compare")
    output = os.path.abspath(os.path.join(build, "results", mesh + ".json"))
    os.makedirs(os.path.dirname(output), exist_ok=True)
    if not os.path.exists(output):
        subprocess.run([os.path.abspath(program), mesh, "--vertices", SIZES, "--json", output, "--quiet",
                        *options(mesh)],
                       check=True, cwd=folder)
    with open(output) as file:
        return {**json.load(file), "path": mesh}


def norms(row):
    return row["carried_P"] or row["closest_point_P"]


def name(row):
    parts = [row["simplifier"]]
    if row["placement"] not in ("", "none"):
        parts.append(row["placement"])
    if row["metric_mass"] != "none":
        parts.append(row["metric_mass"] + " metric")
    if row["relocation"] != "none":
        parts.append("relocated by " + row["relocation"])
    return ", ".join(parts)


def number(x, digits=2, factor=1.0):
    return "–" if x is None else f"{factor * x:.{digits}f}"


def bold_smallest(rows, key, text):
    values = [key(r) for r in rows]
    smallest = min(v for v in values if v is not None)
    return [f"**{t}**" if v == smallest else t for v, t in zip(values, text)]


# Title, value, digits, factor, and whether the smallest is printed bold.
COLUMNS = [
    ("C_L", lambda r: norms(r)["norm_L"], 1, 1, True),
    ("C_D", lambda r: norms(r)["norm_D"], 2, 1, True),
    ("C_D, 1.1 K", lambda r: norms(r)["norm_D_extended"], 2, 1, False),
    ("C_L, closest P", lambda r: r["closest_point_P"]["norm_L"], 1, 1, True),
    ("C_D, closest P", lambda r: r["closest_point_P"]["norm_D"], 2, 1, True),
    ("λ %", lambda r: r["eigenvalue_error_mean"], 2, 100, True),
    ("λ 2..K/5 %", lambda r: r["eigenvalue_error_low_mean"], 2, 100, True),
    ("λ beyond %", lambda r: r["eigenvalue_error_beyond_mean"], 2, 100, True),
    ("span loss %", lambda r: r["span_loss"], 2, 100, True),
    ("diffusion %", lambda r: r["distance_errors"]["diffusion"], 2, 100, True),
    ("biharm. %", lambda r: r["distance_errors"]["biharmonic"], 2, 100, True),
    ("HKS %", lambda r: r["distance_errors"]["heat_kernel_signature"], 2, 100, True),
    ("WKS %", lambda r: r["distance_errors"]["wave_kernel_signature"], 2, 100, True),
    ("Hausdorff %", lambda r: r["hausdorff_over_diagonal"], 2, 100, True),
    ("angle °", lambda r: r["smallest_angle_degrees"], 1, 1, False),
    ("volume", lambda r: r["volume_ratio"], 3, 1, False),
    ("self-int.", lambda r: r["self_intersections"], 0, 1, False),
    ("s", lambda r: r["seconds_total"], 2, 1, False),
]


def table(rows):
    lines = ["| simplifier | N | " + " | ".join(c[0] for c in COLUMNS) + " |",
             "|---|---|" + "---|" * len(COLUMNS)]
    cells = []
    for _, value, digits, factor, bold in COLUMNS:
        text = [number(value(r), digits, factor) for r in rows]
        cells.append(bold_smallest(rows, value, text) if bold else text)
    for i, r in enumerate(rows):
        lines.append(f"| {name(r)} | {r['vertices']} | " + " | ".join(c[i] for c in cells) + " |")
    lines.append(f"| *ideal linear elements (estimate)* | {rows[0]['requested_vertices']} | "
                 f"{rows[0]['floor_norm_L']:.1f} | {rows[0]['floor_norm_D']:.2f} |" + " |" * (len(COLUMNS) - 2))
    return "\n".join(lines) + "\n"


# One line per simplifier, one column per mesh and size, and the means over the columns that no
# simplifier of the first is missing from. `restriction` finds the norms in a row.
def overview(results, mass, restriction=norms, suffix=""):
    cases = [(result, n) for result in results for n in sorted({r["requested_vertices"] for r in result["rows"]})]
    names, found = [], {}
    for k, (result, n) in enumerate(cases):
        for row in result["rows"]:
            if row["judged_mass"] == mass and row["requested_vertices"] == n:
                if name(row) not in names:
                    names.append(name(row))
                found[name(row), k] = restriction(row)
    usual = [x for x in names if (x, 0) in found]
    common = [k for k in range(len(cases)) if all((x, k) in found for x in usual)]
    mean = "mean" if len(common) == len(cases) else f"mean of the first {len(common)}"
    text = ""
    for norm, digits in (("norm_L", 1), ("norm_D", 2)):
        smallest = [min(found[x, k][norm] for x in names if (x, k) in found) for k in range(len(cases))]
        title = "C_L" if norm == "norm_L" else "C_D"
        text += f"\n{title}, judged in the {mass} mass{suffix}:\n\n| simplifier | "
        text += " | ".join(f"{os.path.splitext(result['mesh'])[0]} {n}" for result, n in cases) + f" | {mean} |\n|---|"
        text += "---|" * (len(cases) + 1) + "\n"
        rows = []
        for x in names:
            values = [found[x, k][norm] if (x, k) in found else None for k in range(len(cases))]
            complete = all(values[k] is not None for k in common)
            rows.append((x, values, sum(values[k] for k in common) / len(common) if complete else None))
        best = min(average for _, _, average in rows if average is not None)
        for x, values, average in rows:
            cells = [f"**{v:.{digits}f}**" if v == s else number(v, digits) for v, s in zip(values, smallest)]
            cells.append(f"**{average:.{digits}f}**" if average == best else number(average, digits))
            text += f"| {x} | " + " | ".join(cells) + " |\n"
    return text


# Geometric means over all pairs of a mesh and a size from 3 vertices per eigenvector on, in the
# averaged mass and with the P of the closest points for all.
def summary(results):
    columns = [("mass of the metric", lambda r: r["metric_mass"].replace("none", "–"), None, 1),
               ("C_L", lambda r: r["closest_point_P"]["norm_L"], 1, 1),
               ("C_D", lambda r: r["closest_point_P"]["norm_D"], 2, 1),
               ("eigenvalues, %", lambda r: r["eigenvalue_error_mean"], 2, 100),
               ("eigenvalues 2 to 20, %", lambda r: r["eigenvalue_error_low_mean"], 2, 100),
               ("biharmonic distance, %", lambda r: r["distance_errors"]["biharmonic"], 2, 100),
               ("Hausdorff, %", lambda r: r["hausdorff_over_diagonal"], 2, 100)]
    cases = sum(len({r["requested_vertices"] for r in result["rows"] if r["requested_vertices"] >= 3 * result["K"]})
                for result in results)
    found = {name: [r for result in results for r in result["rows"] if r["simplifier"] == name and
                    r["judged_mass"] == "averaged" and r["requested_vertices"] >= 3 * result["K"]]
             for name in SUMMARY}
    found = {name: rows for name, rows in found.items() if len(rows) == cases}
    values = {name: [value(rows[0]) if digits is None else
                     math.exp(sum(math.log(value(r)) for r in rows) / cases) for _, value, digits, _ in columns]
              for name, rows in found.items()}
    text = f"| {cases} pairs of a mesh and a size | " + " | ".join(c[0] for c in columns) + " |\n|---|"
    text += "---|" * len(columns) + "\n"
    for name, row in values.items():
        cells = []
        for k, (_, _, digits, factor) in enumerate(columns):
            cell = row[k] if digits is None else number(row[k], digits, factor)
            best = digits is not None and row[k] == min(v[k] for v in values.values())
            cells.append(f"**{cell}**" if best else cell)
        text += f"| {SUMMARY[name]} | " + " | ".join(cells) + " |\n"
    return text


def tables(results):
    first = results[0]
    text = f"K = {first['K']}, CGAL {first['cgal_version']}, {first['compiler'].strip()}, one thread; commit {commit()}. The command for each mesh:\n\n"
    text += "".join(f"    {' '.join(['examples/spectral_compare', r['path'], '--vertices', SIZES, *options(r['path'])])} --json results/{r['path']}.json\n"
                    for r in results)
    text += "\n## Norms of all meshes\n"
    for mass in ("averaged", "lumped"):
        text += overview(results, mass)
        text += overview(results, mass, lambda row: row["closest_point_P"], ", closest P for all")
    for result in results:
        for n in sorted({r["requested_vertices"] for r in result["rows"]}):
            text += f"\n## {result['mesh']}, {result['vertices']} vertices, N = {n}\n"
            for mass in ("averaged", "lumped"):
                rows = [r for r in result["rows"] if r["judged_mass"] == mass and r["requested_vertices"] == n]
                text += f"\nJudged in the {mass} mass:\n\n" + table(rows)
        for note in result["notes"] + sorted({name(r) + ", N = " + str(r["requested_vertices"]) + ": " + r["note"]
                                             for r in result["rows"] if r["note"]}):
            text += "\n" + note + "\n"
    return text


def main():
    if len(sys.argv) < 4:
        sys.exit("usage: make_results.py BUILD FOLDER MESH...")
    results = [compare(sys.argv[1], sys.argv[2], mesh) for mesh in sys.argv[3:]]
    here = os.path.dirname(os.path.abspath(__file__))
    replace(os.path.join(here, "results.md"), "tables", tables(results))
    replace(os.path.join(here, "results.md"), "summary", summary(results))


# The commit that a number comes from, "-dirty" where it was changed afterwards. This folder, whose
# scripts run it and write, and README.md are apart.
def commit():
    here = os.path.dirname(os.path.abspath(__file__))
    name, changes = (subprocess.run(["git", "-C", here, *words], capture_output=True, text=True, check=True).stdout.strip()
                     for words in (["rev-parse", "--short", "HEAD"], ["status", "--porcelain", "--", ":/", ":(top,exclude)doc", ":(top,exclude)README.md"]))
    return name + ("-dirty" if changes else "")


# What stands between the two marks of that name.
def replace(path, name, text):
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"
    with open(path) as file:
        before, rest = file.read().split(begin)
    with open(path, "w") as file:
        file.write(before + begin + text + end + rest.split(end)[1])


if __name__ == "__main__":
    main()
