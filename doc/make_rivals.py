#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The parts of run_rivals.sh that a shell cannot do:
#   make_rivals.py --measure LIMIT FILE COMMAND...   runs it for at most LIMIT seconds; FILE gets
#                                                    its seconds and, where there is /usr/bin/time,
#                                                    its peak MB
#   make_rivals.py --merge FOLDER N                  FOLDER.json from what run_rivals.sh left in
#                                                    FOLDER
#   make_rivals.py --tables OUTPUT                   Markdown from all OUTPUT/*.json: means over
#                                                    all, and a table for each
#   make_rivals.py --pages OUTPUT                    writes it into rivals.md, and the summary of it
#                                                    into README.md
# and, without programs of others, what this package and CGAL make of groups of meshes:
#   make_rivals.py --span BUILD MESH:N... -- MESH:N...
#                                                    writes means of each group and a table for each
#                                                    mesh into rivals.md. What is in BUILD/span from
#                                                    an earlier run is used again: remove it to have
#                                                    it anew

import contextlib
import glob
import io
import itertools
import json
import math
import os
import signal
import subprocess
import sys
import time

from make_results import bold_smallest, commit, name, norms, number, replace
from make_spectra import machine

# Our rows, as they are called in the tables, by the simplifier, or by all that tells a row from
# others.
OURS = {"spectral, best": "**this package**", "spectral, best, fitted operators": "this package, operators fitted",
        "spectral with shape term, free, averaged metric": "this package, without relocation",
        "spectral, paper": "this package, preset `paper`",
        "Garland-Heckbert plane": "CGAL: Garland-Heckbert, plane quadrics",
        "Garland-Heckbert probabilistic plane, area 20000": "CGAL: Garland-Heckbert, probabilistic plane quadrics"}
# The rows of the README, and what they are called there.
SUMMARY = {**OURS, "rematching": "ReMatching", "meshoptimizer-regularized": "meshoptimizer, regularised",
           "line-quadrics-0.1": "line quadrics", "published-program": "the authors' program of 2020"}
# Title, value, digits, factor. A row without a closest point has the P of its own, as operators do.
COLUMNS = [
    ("C_L", lambda r: (r["closest_point_P"] or norms(r))["norm_L"], 1, 1),
    ("C_D", lambda r: (r["closest_point_P"] or norms(r))["norm_D"], 2, 1),
    ("λ %", lambda r: r["eigenvalue_error_mean"], 2, 100),
    ("λ 2..K/5 %", lambda r: r["eigenvalue_error_low_mean"], 2, 100),
    ("λ max %", lambda r: r["eigenvalue_error_max"], 1, 100),
    ("λ K+1..1.5K %", lambda r: r["eigenvalue_error_beyond_mean"], 2, 100),
    ("biharm. %", lambda r: r["distance_errors"]["biharmonic"], 2, 100),
    ("Hausdorff %", lambda r: r["hausdorff_over_diagonal"], 2, 100),
    ("span loss %", lambda r: r.get("span_loss"), 2, 100), # judged before there was one: none
    ("s", lambda r: r["seconds_total"], 2, 1),
    ("peak MB", lambda r: r.get("peak_megabytes"), 0, 1),
]
JUDGED = COLUMNS[:-2] # all but time and memory
# What --span compares: texts of --only, and the rows that OURS does not name.
SPAN = ["spectral, best", "spectral with shape term", "Garland-Heckbert plane", "Garland-Heckbert probabilistic plane, area", "Lindstrom-Turk"]
FAST = "this package, preset fast"
SEEDS = [1, 2, 3] # of the rows whose simplifier begins with BEST
BEST = "spectral, best"


def measure(limit, path, command):
    peak, start, status = path + ".peak", time.time(), "finished"
    counted = os.access("/usr/bin/time", os.X_OK)
    process = subprocess.Popen((["/usr/bin/time", "-q", "-f", "%M", "-o", peak] if counted else []) + command, start_new_session=True)
    try:
        if process.wait(timeout=float(limit)):
            status = "failed"
    except subprocess.TimeoutExpired:
        status = f"took longer than {limit} s"
        print(status, file=sys.stderr)
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
    kilobytes = text(peak)
    if os.path.exists(peak):
        os.remove(peak)
    with open(path, "w") as file:
        json.dump({"status": status, "wall_seconds": time.time() - start,
                   "peak_megabytes": int(kilobytes) / 1024 if kilobytes.isdigit() else None}, file)
    return 0 if status == "finished" else 1


def text(path):
    if not os.path.exists(path):
        return ""
    with open(path) as file:
        return file.read().strip()


def loaded(path):
    return json.loads(text(path) or "null")


def title_of(row):
    return OURS.get(row["simplifier"]) or OURS.get(name(row))


# Geometric means of the positive numbers in values of one form; the first of anything else.
def mean_of(values):
    first = values[0]
    if isinstance(first, dict):
        return {key: mean_of([value[key] for value in values]) for key in first}
    if not isinstance(first, (int, float)) or len(set(values)) == 1 or min(values) <= 0:
        return first
    return math.exp(sum(map(math.log, values)) / len(values))


# The results of the first file, with the rows of BEST as means over the files, one for each seed.
def over_seeds(paths):
    results = [loaded(path) for path in paths]
    if None in results:
        sys.exit(f"make_rivals.py: there are no results in '{paths[results.index(None)]}'")
    rows = [{(r["simplifier"], r["judged_mass"]): r for r in result["rows"] if r["simplifier"].startswith(BEST)} for result in results]
    return {**results[0], "rows": [mean_of([found[r["simplifier"], r["judged_mass"]] for found in rows]) if r["simplifier"].startswith(BEST) else r
                                   for r in results[0]["rows"]]}


def merge(folder, n):
    ours = over_seeds([os.path.join(folder, f"ours-{seed}.json") for seed in SEEDS])
    order = list(OURS.values()) + [None]
    rows = sorted(ours["rows"], key=lambda r: order.index(title_of(r)))
    result = {**ours, "rows": rows, "requested_vertices": n, "rivals": []}
    del result["command"]
    for row in result["rows"]:
        alone = {"spectral, best": "", "spectral, best, fitted operators": "fitted"}.get(row["simplifier"])
        if alone is not None:
            measured = loaded(os.path.join(folder, f"ours-alone{alone}.measured"))
            row["peak_megabytes"] = measured and measured["peak_megabytes"]
    for path in sorted(glob.glob(os.path.join(glob.escape(folder), "*", "made.measured"))):
        prefix = path[:-len(".measured")]
        version, licence, flags = (text(prefix + ".about") + ";;").split(";")[:3]
        rival = {"name": os.path.basename(os.path.dirname(prefix)), "version": version.strip(), "licence": licence.strip(), "flags": flags.strip(),
                 **loaded(path), "note": text(prefix + ".note")}
        rival["seconds"] = float(text(prefix + ".seconds") or rival["wall_seconds"])
        judged = [x for x in (loaded(prefix + ".json"), loaded(prefix + ".lumped.json")) if x]
        if not judged and rival["status"] == "finished":
            rival["status"] = "cannot be judged"
        for row in (r for x in judged for r in x["rows"]):
            result["rows"].append({**row, "requested_vertices": n, "seconds_total": rival["seconds"],
                                   "peak_megabytes": rival["peak_megabytes"], "note": rival["note"] or row["note"]})
        result["rivals"].append(rival)
    with open(folder + ".json", "w") as file:
        json.dump(result, file, indent=1)
    return 0


# The rows of that mass: each has a name, a count of vertices and the cells of COLUMNS, or what went
# wrong.
def rows_of(result, mass):
    rows = [(title_of(r), r) for r in result["rows"] if r["judged_mass"] == mass and title_of(r)]
    for rival in result["rivals"]:
        found = [r for r in result["rows"] if r["judged_mass"] == mass and r["simplifier"] == rival["name"]]
        rows.append((rival["name"] + (" †" if found and rival["note"] else ""), found[0] if found else rival["status"]))
    return rows


def table(rows, columns=COLUMNS):
    lines = ["| | N | " + " | ".join(c[0] for c in columns) + " |", "|---|---|" + "---|" * len(columns)]
    judged = [r for _, r in rows if not isinstance(r, str)]
    cells = [bold_smallest_present(judged, value, digits, factor) for _, value, digits, factor in columns]
    for name, row in rows:
        if isinstance(row, str):
            lines.append(f"| {name} | {row} |" + " – |" * len(columns))
        else:
            k = next(i for i, r in enumerate(judged) if r is row)
            lines.append(f"| {name} | {row['vertices']} | " + " | ".join(c[k] for c in cells) + " |")
    return "\n".join(lines) + "\n"


def bold_smallest_present(rows, value, digits, factor):
    words = [number(value(r), digits, factor) for r in rows]
    return words if all(value(r) is None for r in rows) else bold_smallest(rows, value, words)


# Geometric means over all pairs of a mesh and a size, of those that have a result for each; of the
# names of `wanted` alone, if given.
def means(results, mass, columns=COLUMNS, wanted=None):
    found = {}
    for result in results:
        for title, row in rows_of(result, mass):
            if not isinstance(row, str):
                found.setdefault(title.removesuffix(" †"), []).append(row)
    complete = {title: rows for title, rows in found.items() if len(rows) == len(results)}
    if wanted:
        complete = {title: complete[own] for key, title in wanted.items() for own in (OURS.get(key, key),) if own in complete}

    def mean(rows, value):
        # A figure that no row of a result has, such as the error of eigenvalues that are zero, is
        # not of the mean.
        values = [value(row) for row, *all_rows in zip(rows, *complete.values()) if any(value(r) is not None for r in all_rows)]
        return None if None in values or not values else math.exp(sum(math.log(max(v, 1e-12)) for v in values) / len(values))

    lines = [f"| {len(results)} pairs of a mesh and a size | " + " | ".join(c[0] for c in columns) + " |",
             "|---|" + "---|" * len(columns)]
    cells = [bold_smallest_present(list(complete.values()), lambda rows, value=value: mean(rows, value), digits, factor)
             for _, value, digits, factor in columns]
    for k, name in enumerate(complete):
        lines.append(f"| {name} | " + " | ".join(c[k] for c in cells) + " |")
    names = dict.fromkeys(name.removesuffix(" †") for result in results for name, _ in rows_of(result, mass))
    for name in names if not wanted else []:
        if name not in complete:
            lines.append(f"| {name}: {len(found.get(name, []))} of {len(results)} |" + " – |" * len(columns))
    return "\n".join(lines) + "\n"


def results_in(output):
    results = [loaded(path) for path in sorted(glob.glob(os.path.join(glob.escape(output), "*.json")))]
    if not results:
        sys.exit(f"make_rivals.py: there is no result in '{output}'")
    return results


def pages(output):
    here, page = os.path.dirname(os.path.abspath(__file__)), io.StringIO()
    with contextlib.redirect_stdout(page):
        tables(output)
    replace(os.path.join(here, "rivals.md"), "tables", page.getvalue())
    titles = [r"\|C\|_L", r"\|C\|_D", "eigenvalues, %", "eigenvalues 2 to 20, %", "largest error, %",
              "eigenvalues 101 to 150, %", "biharmonic distance, %", "Hausdorff, %"]
    columns = [(title, *column[1:]) for title, column in zip(titles, COLUMNS)]
    replace(os.path.join(here, "..", "README.md"), "summary", means(results_in(output), "averaged", columns, SUMMARY))
    return 0


def tables(output):
    results = results_in(output)
    print(f"K = {results[0]['K']}; {machine()}. *This package* and *operators fitted* are geometric means of the seeds 1 to 3. C_L and C_D are with the P of the closest points, those of operators with their own. Seconds are without "
          "files where a program says so itself, peak MB are of the whole process. A dagger (†) marks a mesh that could not be judged before "
          "--repair: below the table is why. The best of a column is bold.\n\n"
          "| rival | version | licence | flags |\n|---|---|---|---|")
    rivals = {rival["name"]: rival for result in results for rival in result["rivals"]}
    for name, rival in sorted(rivals.items()):
        print(f"| {name} | {rival['version']} | {rival['licence']} | {rival['flags']} |")
    for mass in ("averaged", "lumped"):
        print(f"\n## Geometric means, judged in the {mass} mass\n\n" + means(results, mass), end="")
    for result in results:
        print(f"\n## {result['mesh']}, {result['vertices']} vertices, N = {result['requested_vertices']}")
        for mass in ("averaged", "lumped"):
            print(f"\nJudged in the {mass} mass:\n\n" + table(rows_of(result, mass)), end="")
        for rival in result["rivals"]:
            if rival["note"]:
                print(f"\n{rival['name']}: {rival['note']}")
    return 0


# As the results of --merge, with what OURS does not name as rivals.
def compared(build, mesh, n):
    folder = os.path.join(build, "span", f"{os.path.basename(mesh)}-{n}")
    fast, P = (os.path.join(folder, file) for file in ("fast.off", "P.mtx"))
    outputs = [os.path.join(folder, f"judged-{seed}.json") for seed in SEEDS]
    if not os.path.exists(outputs[-1]):
        os.makedirs(folder, exist_ok=True)
        program = os.path.join(build, "examples", "spectral_")
        subprocess.run([program + "simplify", mesh, fast, "--vertices", n, "--preset", "fast", "--restriction", P, "--no-evaluation", "--quiet"],
                       check=True)
        for seed, output in zip(SEEDS, outputs):
            only = [word for text in (SPAN if seed == SEEDS[0] else [BEST]) for word in ("--only", text)]
            rival = ["--rival", f"{FAST}={fast},{P}"] if seed == SEEDS[0] else []
            subprocess.run([program + "compare", mesh, "--vertices", n, "--judge", "averaged", *only, "--without", "fitted operators",
                            *rival, "--seed", str(seed), "--quiet", "--json", output], check=True)
    return {**over_seeds(outputs), "requested_vertices": n, "rivals": [{"name": other, "note": "", "status": "failed"} for other in (FAST, "Lindstrom-Turk")]}


def span(build, pairs):
    groups = [[compared(build, *pair.rsplit(":", 1)) for pair in group] for ends, group in itertools.groupby(pairs, "--".__eq__) if not ends]
    text = f"K = {groups[0][0]['K']}, averaged mass, C_L and C_D with the P of the closest points; commit {commit()}. *This package* has the geometric means of the seeds 1 to 3. Means of the meshes:\n"
    text += "".join("\n" + means(group, "averaged", JUDGED) for group in groups)
    for result in (result for group in groups for result in group):
        text += f"\n**{result['mesh']}**, {result['vertices']} vertices:\n\n" + table(rows_of(result, "averaged"), JUDGED)
    replace(os.path.join(os.path.dirname(os.path.abspath(__file__)), "rivals.md"), "span", text)
    return 0


def main():
    actions = {"--measure": lambda a: measure(a[0], a[1], a[2:]), "--merge": lambda a: merge(a[0], int(a[1])), "--tables": lambda a: tables(*a), "--pages": lambda a: pages(*a),
               "--span": lambda a: span(a[0], a[1:])}
    if len(sys.argv) < 3 or sys.argv[1] not in actions:
        sys.exit("usage: make_rivals.py --measure|--merge|--tables|--pages|--span ..., see its head")
    sys.exit(actions[sys.argv[1]](sys.argv[2:]))


if __name__ == "__main__":
    main()
