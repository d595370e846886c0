#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# On many meshes, the default beside the best of CGAL's quadrics:
#   doc/make_survey.py BUILD N MESH...
# takes each to N vertices, after --repair, and writes into rivals.md how often which is better, and
# the errors of both on every mesh. One JSON file per run goes to BUILD/survey and is used again; a
# mesh that is refused is listed with the reason.

import json
import math
import os
import subprocess
import sys

from make_results import commit, replace

NAMES = ["spectral, best", "Garland-Heckbert probabilistic plane, area 20000"]
# Title, value, digits, factor.
COLUMNS = [("C_L", lambda r: r["closest_point_P"]["norm_L"], 1, 1), ("C_D", lambda r: r["closest_point_P"]["norm_D"], 2, 1),
           ("eigenvalues %", lambda r: r["eigenvalue_error_mean"], 2, 100),
           ("modes 2 to K/5 %", lambda r: r["eigenvalue_error_low_mean"], 2, 100),
           ("biharmonic distance %", lambda r: r["distance_errors"]["biharmonic"], 2, 100),
           ("Hausdorff %", lambda r: r["hausdorff_over_diagonal"], 2, 100)]


# The rows of both simplifiers, or the sentence why there are none.
def judged(build, n, mesh):
    output = os.path.join(build, "survey", "-".join(os.path.abspath(mesh).split(os.sep)[-3:] + [n]) + ".json")
    if not os.path.exists(output):
        only = [word for name in NAMES for word in ("--only", name)]
        run = subprocess.run([os.path.join(build, "examples", "spectral_compare"), mesh, "--vertices", n, *only, "--judge", "averaged",
                              "--repair", "--quiet", "--json", output], stderr=subprocess.PIPE, text=True)
        if run.returncode:
            return (run.stderr.strip().splitlines() or [f"ended with status {run.returncode}"])[-1]
    with open(output) as file:
        result = json.load(file)
    rows = [next((r for r in result["rows"] if r["simplifier"].startswith(name)), None) for name in NAMES]
    if None in rows: # of one that failed the notes say why
        return "; ".join(result["notes"])
    return [{**row, "fine_vertices": result["vertices"]} for row in rows]


def main():
    if len(sys.argv) < 4:
        sys.exit("usage: make_survey.py BUILD N MESH...")
    build, n, meshes = sys.argv[1], sys.argv[2], sys.argv[3:]
    os.makedirs(os.path.join(build, "survey"), exist_ok=True)
    pairs, refused = [], []
    for mesh in meshes:
        rows = judged(build, n, mesh)
        if isinstance(rows, str):
            refused.append(f"{os.path.basename(mesh)}: {rows}")
        else:
            pairs.append((os.path.join(*os.path.abspath(mesh).split(os.sep)[-2:]), *rows))
    lines = [f"Commit {commit()}.", ""]
    ratios, better, cells = [], [], {mesh: [] for mesh, _, _ in pairs}
    for _, value, digits, factor in COLUMNS:
        both = [(value(a), value(b)) for _, a, b in pairs if value(a) is not None and value(b) is not None]
        ratios.append(f"{math.exp(sum(math.log(max(a, 1e-12) / max(b, 1e-12)) for a, b in both) / len(both)):.2f}")
        better.append(f"{sum(a < b for a, b in both)} of {len(both)}")
        for mesh, a, b in pairs:
            words = ["–" if value(r) is None else f"{factor * value(r):.{digits}f}" for r in (a, b)]
            worse = value(a) is not None and value(b) is not None and value(a) > value(b)
            cells[mesh].append(f"{words[0]} / {words[1]}" if not worse else f"{words[0]} / **{words[1]}**")
    titles = " | ".join(c[0] for c in COLUMNS)
    lines += [f"| {len(pairs)} meshes, N = {n} | {titles} |", "|---|" + "---|" * len(COLUMNS),
                    "| ratio, geometric mean | " + " | ".join(ratios) + " |", "| the default is better | " + " | ".join(better) + " |", "",
                    f"| mesh | vertices | {titles} |", "|---|---|" + "---|" * len(COLUMNS)]
    for mesh, row, _ in pairs:
        lines.append(f"| {mesh} | {row['fine_vertices']} | " + " | ".join(cells[mesh]) + " |")
    lines += ["", "Refused: " + "; ".join(refused)] if refused else []
    replace(os.path.join(os.path.dirname(os.path.abspath(__file__)), "rivals.md"), "survey", "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
