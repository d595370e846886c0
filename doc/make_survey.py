#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# On many meshes, the default beside the best of CGAL's quadrics:
#   doc/make_survey.py BUILD N MESH...
# takes each to N vertices, after --repair, and writes how often which is better and where the default is not, as Markdown, to
# standard output. One JSON file per run goes to BUILD/survey and is used again; a mesh that is refused is listed with the reason.

import json
import math
import os
import subprocess
import sys

NAMES = ["spectral, best", "Garland-Heckbert probabilistic plane, area 20000"]
COLUMNS = [("C_L", lambda r: r["closest_point_P"]["norm_L"]), ("C_D", lambda r: r["closest_point_P"]["norm_D"]),
           ("eigenvalues", lambda r: r["eigenvalue_error_mean"]), ("modes 2 to K/5", lambda r: r["eigenvalue_error_low_mean"]),
           ("biharmonic distance", lambda r: r["distance_errors"]["biharmonic"]),
           ("Hausdorff", lambda r: r["hausdorff_over_diagonal"])]


# The row of that simplifier, or the sentence why there is none.
def judged(build, n, mesh, name):
    stem = "-".join(os.path.abspath(mesh).split(os.sep)[-3:] + [n, name.replace(" ", "_")])
    output = os.path.join(build, "survey", stem + ".json")
    if not os.path.exists(output):
        run = subprocess.run([os.path.join(build, "examples", "spectral_compare"), mesh, "--vertices", n, "--only", name, "--judge", "averaged",
                              "--repair", "--quiet", "--json", output], stderr=subprocess.PIPE, text=True)
        if run.returncode:
            return run.stderr.strip().splitlines()[-1]
    with open(output) as file:
        return next(r for r in json.load(file)["rows"] if r["simplifier"].startswith(name))


def main():
    if len(sys.argv) < 4:
        sys.exit("usage: make_survey.py BUILD N MESH...")
    build, n, meshes = sys.argv[1], sys.argv[2], sys.argv[3:]
    os.makedirs(os.path.join(build, "survey"), exist_ok=True)
    pairs, refused = [], []
    for mesh in meshes:
        rows = [judged(build, n, mesh, name) for name in NAMES]
        sentences = [r for r in rows if isinstance(r, str)]
        if sentences:
            refused.append(f"{os.path.basename(mesh)}: {sentences[0]}")
        else:
            pairs.append((os.path.basename(mesh), *rows))
    print(f"| {len(pairs)} meshes, N = {n} | " + " | ".join(c[0] for c in COLUMNS) + " |\n|---|" + "---|" * len(COLUMNS))
    ratio, better, worse = [], [], []
    for title, value in COLUMNS:
        both = [(mesh, value(a), value(b)) for mesh, a, b in pairs if value(a) is not None and value(b) is not None]
        ratio.append(f"{math.exp(sum(math.log(max(a, 1e-12) / max(b, 1e-12)) for _, a, b in both) / len(both)):.2f}")
        lost = [mesh for mesh, a, b in both if a > b]
        better.append(f"{len(both) - len(lost)} of {len(both)}")
        if lost and title != "Hausdorff":
            worse.append(f"{title}: {', '.join(lost)}")
    print("| ratio, geometric mean | " + " | ".join(ratio) + " |\n| the default is better | " + " | ".join(better) + " |")
    print("\nIt is worse in " + "; ".join(worse) + "." if worse else "")
    if refused:
        print("\nRefused: " + "; ".join(refused))


if __name__ == "__main__":
    main()
