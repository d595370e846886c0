#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Makes the shapes, tables and pictures of applications.md:
#   doc/make_applications.py BUILD [FOLDER]
#   doc/make_applications.py --large BUILD [FOLDER]
#   doc/make_applications.py --distances BUILD FOLDER MESH...
#   doc/make_applications.py --pairs BUILD FOLDER RIVALS [NAME:X:Y:TRUTH ...] [NAME:X:bent ...]
# BUILD is where the programs were built; what they write goes to FOLDER (BUILD/applications) and is
# used again when it is there. Pictures go to doc/fig, tables to standard output. --large makes the
# table of two scans of a million vertices alone, --distances that of operators fitted and the
# meshes' own, --pairs those of proxies and matchers, on shapes in other triangles and on other
# pairs: with the file of the true map, `same` for the identity, or X itself against its bent shape
# in other triangles; all three write into the page. RIVALS is a folder as for run_rivals.sh, whose
# programs make proxies. Where RUN_BY is set, what is timed is run by that command: a lock, on a
# machine with other work to do. Needs what pictures.py does.

import collections
import glob
import json
import math
import os
import random
import re
import shlex
import subprocess
import sys

import numpy as np
from matplotlib.colors import Normalize

from make_results import replace
from make_spectra import machine
from pictures import (COLOURS, ERRORS, WIDTH, Picture, box_of, colour_bar, package, plt, save, seen,
                      show)

PAIRS = [("walk", "walk.off", "walk.txt"), ("bend", "bend.off", "bend.txt"),
         ("wave 3", "wave3.off", "same.txt"), ("walk, other triangles", "other_walk.off", "other.txt"),
         ("bend, other triangles", "other_bend.off", "other.txt"), ("wave 1, other triangles", "other_wave1.off", "other.txt"),
         ("wave 2, other triangles", "other_wave2.off", "other.txt")]


def run(build, folder, output, program, *arguments, by=""):
    if os.path.exists(os.path.join(folder, output)):
        return
    program = os.path.abspath(os.path.join(build, "examples", program))
    said = subprocess.run([*shlex.split(by), program, *arguments], check=True, cwd=folder, stdout=subprocess.PIPE, text=True).stdout
    if output.endswith(".out"):
        with open(os.path.join(folder, output), "w") as file:
            file.write(said)


def report_name(pair):
    return pair.replace(" other triangles", "other").replace(", ", "_").replace(",", "_").replace(" ", "")


def read_vertices(path):
    with open(path) as file:
        lines = [line for line in file if line.strip()]
    return [tuple(map(float, line.split()[:3])) for line in lines[2:2 + int(lines[1].split()[0])]]


# For each vertex of X the nearest vertex of Y, in cells of a grid: both are the same surface.
def nearest_vertices(X, Y, output):
    points, targets = read_vertices(X), read_vertices(Y)
    side = max(max(c) - min(c) for c in zip(*targets)) / 60
    cells = collections.defaultdict(list)

    def cell(p):
        return tuple(int(x // side) for x in p)

    for j, p in enumerate(targets):
        cells[cell(p)].append(j)
    with open(output, "w") as file:
        for p in points:
            a, b, c = cell(p)
            near = [j for x in (a - 1, a, a + 1) for y in (b - 1, b, b + 1) for z in (c - 1, c, c + 1)
                    for j in cells.get((x, y, z), ())]
            file.write(f"{min(near, key=lambda j: sum((s - t) ** 2 for s, t in zip(p, targets[j])))}\n")


# For each vertex of the mesh itself.
def identity(mesh, output):
    if not os.path.exists(output):
        with open(output, "w") as file:
            file.writelines(f"{v}\n" for v in range(len(read_vertices(mesh))))


# Moves the vertices by four waves of random direction and length, which stretches by about a tenth;
# the triangles stay.
def wave(source, output, seed):
    if os.path.exists(output):
        return
    chance = random.Random(seed)
    waves = []
    for _ in range(4):
        k = [chance.gauss(0, 1.3) for _ in range(3)]
        d = [chance.gauss(0, 1) for _ in range(3)]
        length = math.sqrt(sum(x * x for x in d))
        waves.append((k, [0.05 * x / length for x in d], chance.uniform(0, 2 * math.pi)))
    points = read_vertices(source)
    with open(source) as file:
        lines = [line for line in file if line.strip()]
    for i, p in enumerate(points):
        q = p
        for k, d, phase in waves:
            height = math.sin(sum(a * b for a, b in zip(k, p)) + phase)
            q = [x + height * y for x, y in zip(q, d)]
        lines[2 + i] = "{:.9g} {:.9g} {:.9g}\n".format(*q)
    with open(output, "w") as file:
        file.writelines(lines)


def make_shapes(build, folder):
    os.makedirs(folder, exist_ok=True)
    for pose in ("walk", "bend"):
        run(build, folder, f"{pose}.txt", "make_demo_shape", f"{pose}.off", "--pose", pose, "--shuffle", "7", "--map", f"{pose}.txt")
    for name, vertices, pose in (("stand", "25000", "stand"), ("other_stand", "27000", "stand"), ("other_walk", "27000", "walk"),
                                 ("other_bend", "27000", "bend")):
        run(build, folder, f"{name}.off", "make_demo_shape", f"{name}.off", "--vertices", vertices, "--pose", pose)
    truth = os.path.join(folder, "other.txt")
    if not os.path.exists(truth):
        nearest_vertices(os.path.join(folder, "stand.off"), os.path.join(folder, "other_stand.off"), truth)
    for source, target, seed in (("other_stand", "other_wave1", 1), ("other_stand", "other_wave2", 2), ("stand", "wave3", 3)):
        wave(os.path.join(folder, f"{source}.off"), os.path.join(folder, f"{target}.off"), seed)
    identity(os.path.join(folder, "stand.off"), os.path.join(folder, "same.txt"))


def run_all(build, folder):
    make_shapes(build, folder)
    for name, Y, truth in PAIRS:
        run(build, folder, f"{report_name(name)}.out", "shape_matching", "stand.off", Y, "--operators", "mesh",
            "--proxy", "spectral,garland_heckbert", "--ground-truth", truth, "--json", f"{report_name(name)}.json")
    run(build, folder, "distances.out", "spectral_distances_on_proxy", "stand.off", "--operators", "mesh",
        "--vertices", "1000")
    # Runs again with fitted operators, which the programs have as their default.
    run(build, folder, "fitted_distances.out", "spectral_distances_on_proxy", "stand.off", "--vertices", "1000")
    for name, Y, truth in PAIRS:
        run(build, folder, f"fitted_{report_name(name)}.out", "shape_matching", "stand.off", Y,
            "--ground-truth", truth, "--output", f"map_{report_name(name)}.txt")
    # The map of a pair without the last step.
    run(build, folder, "unbent.txt", "shape_matching", "stand.off", "other_bend.off", "--fine-iterations", "0",
        "--output", "unbent.txt", "--quiet")


# --- two scans of a million vertices --------------------------------------------------------------

# Vertices, and what X and Y are reduced to first, or nothing.
LARGE = [(100000, None), (100000, 30000), (1000000, 30000)]
STAGES = ["reading", "reduction", "eigenpairs", "proxies", "matching", "lift"]


def large(build, folder):
    os.makedirs(folder, exist_ok=True)
    lines = []
    for vertices, reduced in LARGE:
        X, Y, truth = (f"large-{vertices}{end}" for end in (".off", "-walk.off", "-truth.txt"))
        run(build, folder, X, "make_demo_shape", X, "--vertices", str(vertices))
        run(build, folder, Y, "make_demo_shape", Y, "--vertices", str(vertices), "--pose", "walk", "--shuffle", "7", "--map", truth)
        stem = f"large-{vertices}-walk-{reduced or 'none'}"
        arguments = [X, Y, "--output", stem + ".txt", "--quiet"] + (["--pre-simplify", str(reduced)] if reduced else [])
        # Timed without the errors, which take longer than the match; on a million vertices many
        # minutes and 4 GB.
        run(build, folder, stem + "-time.json", "shape_matching", *arguments, "--json", stem + "-time.json", by=os.environ.get("RUN_BY", ""))
        with open(os.path.join(folder, stem + "-time.json")) as file:
            written = json.load(file)
        errors = ["–"] * 3
        if vertices <= 100000:
            run(build, folder, stem + "-error.json", "shape_matching", *arguments, "--json", stem + "-error.json", "--ground-truth", truth,
                "--samples", "100")
            with open(os.path.join(folder, stem + "-error.json")) as file:
                result = json.load(file)["results"][0]
            errors = [f"{result['error_' + word]:.4f}" for word in ("mean", "90_percent", "max")]
        timed = written["results"][0]
        stages = {s["stage"]: s for s in timed["stages"]}
        cells = [f"{stages[s]['seconds']:.1f} s, {stages[s]['peak_megabytes_so_far']:.0f} MB" if s in stages else "–" for s in STAGES]
        lines.append("| " + " | ".join([f"{written['vertices_X']:,}", f"{reduced:,}" if reduced else "–", *cells, f"{timed['seconds']:.1f} s",
                                        *errors]) + " |")
    titles = ["vertices of X and Y", "reduced to", *STAGES, "total", "mean error", "90 %", "largest"]
    table = [machine() + ".", "", "| " + " | ".join(titles) + " |", "|" + "---:|" * len(titles), *lines]
    write("large", table)


# --- proxies and matchers -------------------------------------------------------------------------

SHOWN_PAIRS = [pair for pair in PAIRS if pair[0] == "walk, other triangles"] # the others are as easy
PROXIES = {"spectral": "spectral", "garland_heckbert": "Garland-Heckbert plane",
           "garland_heckbert_probabilistic": "Garland-Heckbert probabilistic plane"}
SIZES = (300, 600, 1000)


# The shape of `source` twisted about its length by one radian, and bent about its height by one and
# a half: edges of an animal change by some 6 % in the mean.
def bend(source, output):
    if os.path.exists(output):
        return
    points = read_vertices(source)
    extents = [max(c) - min(c) for c in zip(*points)]
    width, height, length = sorted(range(3), key=lambda k: extents[k])
    centre = [sum(c) / len(points) for c in zip(*points)]
    radius = extents[length] / 1.5
    with open(source) as file:
        lines = [line for line in file if line.strip()]
    for i, p in enumerate(points):
        q = [x - c for x, c in zip(p, centre)]
        angle, twist = q[length] / radius, q[length] / extents[length]
        turned = [0, 0, 0]
        turned[width] = math.cos(twist) * q[width] - math.sin(twist) * q[height]
        turned[height] = math.sin(twist) * q[width] + math.cos(twist) * q[height]
        r = radius - turned[width]
        turned[length], turned[width] = r * math.sin(angle), radius - r * math.cos(angle)
        lines[2 + i] = "{:.9g} {:.9g} {:.9g}\n".format(*turned)
    with open(output, "w") as file:
        file.writelines(lines)


# The mesh against its own bent shape. X is reduced, so that no triangle is that of Y; a vertex of X
# has the nearest one of the mesh as its truth.
def bent_pair(build, folder, name, mesh):
    X, Y, truth = (f"{report_name(name)}_{end}" for end in ("reduced.off", "bent.off", "truth.txt"))
    run(build, folder, X, "spectral_simplify", mesh, X, "--vertices", "60%", "--relocate", "none", "--quiet")
    bend(mesh, os.path.join(folder, Y))
    if not os.path.exists(os.path.join(folder, truth)):
        nearest_vertices(os.path.join(folder, X), mesh, os.path.join(folder, truth))
    return X, Y, truth


# The proxies that other programs make of X and Y, as shape_matching takes them.
def foreign_proxies(folder, rivals, name, X, Y, vertices):
    words = []
    for program in sorted(glob.glob(os.path.join(rivals, "*", "run"))):
        rival, made = os.path.basename(os.path.dirname(program)), []
        for side, mesh in (("X", X), ("Y", Y)):
            prefix = os.path.join(folder, f"{rival}_{report_name(name)}_{side}_{vertices}")
            if not os.path.exists(prefix + ".off"):
                subprocess.run([program, os.path.join(folder, mesh), str(vertices), prefix], check=True, stdout=subprocess.DEVNULL)
            made.append(prefix + ".off")
        words += ["--proxy-meshes", f"{rival}={made[0]},{made[1]}"]
    return words


# Errors and parts below 0.05 by column of the table, as they are shown.
def matched(build, folder, rivals, name, X, Y, truth, vertices, bending=True):
    stem = f"pair_{report_name(name)}_{vertices}" + ("" if bending else "_unbent")
    proxies = ",".join(list(PROXIES) + (["none"] if vertices == 600 and bending else []))
    found = {}
    matchers = [("product_manifold_filter", ["--proxy", proxies, *foreign_proxies(folder, rivals, name, X, Y, vertices)]),
                ("bcicp", ["--proxy", "spectral"])] if bending else [
                    ("product_manifold_filter", ["--proxy", proxies, *foreign_proxies(folder, rivals, name, X, Y, vertices),
                                                 "--fine-iterations", "0"])]
    for matcher, words in matchers:
        output = f"{stem}_{matcher}.json"
        run(build, folder, output, "shape_matching", X, Y, "--ground-truth", truth, "--vertices", str(vertices), "--matcher", matcher, *words,
            "--json", output, "--quiet", by=os.environ.get("RUN_BY", ""))
        with open(os.path.join(folder, output)) as file:
            for result in json.load(file)["results"]:
                proxy = result["proxy"]
                title = "no proxy" if proxy == "none" else PROXIES.get(proxy, proxy)
                title = f"{title}, BCICP" if matcher == "bcicp" else title
                found[title] = (result["error_mean"], 100 * result["part_below_0.05"], result["vertices"])
    return found


# A row of the table, the least error bold.
def pair_row(name, vertices, titles, found):
    best = min(round(f[0], 4) for f in found.values())
    cells = []
    for title in titles:
        if title not in found:
            cells.append("")
            continue
        error, share, *made = found[title]
        cells.append(f"**{error:.4f}**, {share:.1f} %" if round(error, 4) == best else f"{error:.4f}, {share:.1f} %")
        if made and title != "no proxy" and made[0] != vertices:
            cells[-1] += f" ({made[0]:,})"
    return f"| {name} | {vertices:,} | " + " | ".join(cells) + " |"


def pairs(build, folder, rivals, others):
    make_shapes(build, folder)
    wanted = [(name, "stand.off", Y, truth) for name, Y, truth in SHOWN_PAIRS]
    for name, X, Y, *truth in (word.split(":") for word in others):
        X = os.path.abspath(X)
        if Y == "bent":
            wanted.append((name, *bent_pair(build, folder, name, X)))
            continue
        map_file = os.path.abspath(truth[0])
        if truth[0] == "same":
            map_file = os.path.join(folder, f"{report_name(name)}_same.txt")
            identity(X, map_file)
        wanted.append((name, X, os.path.abspath(Y), map_file))
    rows = {(name, vertices): matched(build, folder, rivals, name, X, Y, truth, vertices)
            for name, X, Y, truth in wanted for vertices in SIZES}
    titles = []
    for row in rows.values():
        titles += [title for title in row if title not in titles]
    titles.sort(key=lambda title: (title == "no proxy", not title.startswith("spectral"), title not in PROXIES.values()))
    lines = [pair_row(name if vertices == SIZES[0] else "", vertices, titles, found) for (name, vertices), found in rows.items()]
    for vertices in SIZES:
        of_size = [row for (_, size), row in rows.items() if size == vertices]
        means = {title: [sum(row[title][k] for row in of_size) / len(of_size) for k in (0, 1)] for title in titles if title in of_size[0]}
        lines.append(pair_row("mean" if vertices == SIZES[0] else "", vertices, titles, means))
    table = [machine() + ".", "", "| pair | vertices | " + " | ".join(titles) + " |", "|---|---:|" + "---:|" * len(titles), *lines]
    write("pairs", table)
    if not wanted[1:]:
        return
    # The last steps left out.
    rows = {name: matched(build, folder, rivals, name, X, Y, truth, 600, bending=False) for name, X, Y, truth in wanted[1:]}
    titles = [title for title in titles if all(title in row for row in rows.values())]
    lines = [pair_row(name, 600, titles, found) for name, found in rows.items()]
    means = {title: [sum(row[title][k] for row in rows.values()) / len(rows) for k in (0, 1)] for title in titles}
    lines.append(pair_row("mean", 600, titles, means))
    write("unbent", [machine() + ".", "", "| pair | vertices | " + " | ".join(titles) + " |", "|---|---:|" + "---:|" * len(titles), *lines])


def write(name, lines):
    replace(os.path.join(os.path.dirname(os.path.abspath(__file__)), "applications.md"), name, "\n".join(lines) + "\n")


# Errors of distances by the prolongation, and of signatures at the heaviest vertices, on proxies of
# 600 vertices.
def distances(build, folder, meshes):
    os.makedirs(folder, exist_ok=True)
    program = os.path.abspath(os.path.join(build, "examples", "spectral_distances_on_proxy"))
    columns, titles = {}, []
    for mesh in meshes:
        name = os.path.splitext(os.path.basename(mesh))[0]
        for operators in ("mesh", "fitted"):
            said = subprocess.run([program, os.path.abspath(mesh), "--operators", operators, "--vertices", "600"], check=True, cwd=folder,
                                  stdout=subprocess.PIPE, text=True).stdout
            columns[name, operators] = {title.strip(): float(value) for title, value in re.findall(r"^(\D[^%\n]*?(?:= 0\.01)?) +([\d.]+) %", said, re.M)}
        titles += [f"{name}: own", "fitted"]
    lines = ["| | " + " | ".join(titles) + " | fitted over own, geometric mean |", "|---|" + "---:|" * (len(titles) + 1)]
    for row in next(iter(columns.values())):
        names = list(dict.fromkeys(name for name, _ in columns))
        ratio = math.exp(sum(math.log(columns[n, "fitted"][row] / columns[n, "mesh"][row]) for n in names) / len(names))
        lines.append(f"| {row} | " + " | ".join(f"{columns[n, o][row]:.2f}" for n in names for o in ("mesh", "fitted")) + f" | {ratio:.2f} |")
    write("animals", [machine() + ".", "", *lines])


# --- pictures -------------------------------------------------------------------------------------


# Vertices of X in the colours of the vertices of Y that they are sent to, and how far these are
# from the true ones.
def matching_picture(ss, folder):
    (X, FX), (Y, FY) = (
        ss.read_mesh(os.path.join(folder, mesh)) for mesh in ("stand.off", "other_bend.off")
    )
    truth, unbent, bent = (
        np.loadtxt(os.path.join(folder, path), int)
        for path in ("other.txt", "unbent.txt", "map_bend_other.txt")
    )
    seen_Y = seen(Y)
    box, scale, errors = (
        box_of(seen(X), seen_Y),
        Normalize(*np.percentile(seen_Y[:, 0], (0, 100))),
        Normalize(0, 3),
    )
    figure, axes = plt.subplots(1, 4, figsize=(WIDTH, 2.8), constrained_layout=True)
    drawn = Picture(seen(X), FX, box, 350)
    show(
        axes[0],
        Picture(seen_Y, FY, box, 350).painted(
            seen_Y[:, 0], COLOURS, scale, lines=0.15, lines_of=seen_Y[:, 1]
        ),
        "Y, bent",
        f"{len(Y):,} vertices",
    )
    show(
        axes[1],
        drawn.painted(seen_Y[bent, 0], COLOURS, scale, lines=0.15, lines_of=seen_Y[bent, 1]),
        "its colours on X",
        f"{len(X):,} vertices",
    )
    area = (
        np.linalg.norm(np.cross(Y[FY[:, 1]] - Y[FY[:, 0]], Y[FY[:, 2]] - Y[FY[:, 0]]), axis=1).sum()
        / 2
    )
    for a, title, found in (
        (axes[2], "error, lifted only", unbent),
        (axes[3], "error, bent in space", bent),
    ):
        error = 100 * np.linalg.norm(Y[found] - Y[truth], axis=1) / np.sqrt(area)
        show(
            a, drawn.painted(error, ERRORS, errors, shade=0.3), title, f"mean {error.mean():.2f} %"
        )
    colour_bar(figure, axes, ERRORS, errors, "% of √area", shrink=0.8, pad=0.01)
    save(figure, "matching")


# Biharmonic distances from a vertex, and what two ways back from the proxy make of them.
def distances_picture(ss, folder):
    V, F = ss.read_mesh(os.path.join(folder, "stand.off"))
    run = ss.simplify(V, F, 1000)
    source = np.argmax(seen(V)[:, 2])
    fine = ss.distances(run.eigenpairs, int(source), squared=False)
    coarse = ss.distances(run.coarse_eigenpairs(100), run.Q[[source]], squared=False).ravel()
    box, scale, errors = box_of(seen(V)), Normalize(0, fine.max()), Normalize(0, 3)
    figure, axes = plt.subplots(1, 4, figsize=(WIDTH, 2.8), constrained_layout=True)
    drawn = Picture(seen(V), F, box, 350)
    show(
        axes[0],
        drawn.painted(fine, COLOURS, scale, lines=fine.max() / 16),
        "on the input",
        f"{len(V):,} vertices",
    )
    show(
        axes[1],
        Picture(seen(run.V), run.F, box, 350).painted(
            coarse, COLOURS, scale, lines=fine.max() / 16
        ),
        "on the proxy",
        f"{len(run.V):,} vertices",
    )
    for a, title, back in (
        (axes[2], "off by the vertex map", coarse[run.vertex_map]),
        (axes[3], "off by the prolongation", run.Q @ coarse),
    ):
        error = 100 * np.abs(back - fine) / fine.max()
        show(
            a, drawn.painted(error, ERRORS, errors, shade=0.3), title, f"mean {error.mean():.2f} %"
        )
    colour_bar(figure, axes, ERRORS, errors, "% of the largest", shrink=0.8, pad=0.01)
    save(figure, "distances")


def main():
    words = [word for word in sys.argv[1:] if word not in ("--large", "--distances", "--pairs")]
    many = "--pairs" in sys.argv or "--distances" in sys.argv
    if not words or (many and len(words) < 3) or (not many and len(words) > 2):
        sys.exit("usage: make_applications.py [--large] BUILD [FOLDER], --distances BUILD FOLDER MESH..., or\n"
                 "       --pairs BUILD FOLDER RIVALS [NAME:X:Y:TRUTH ...] [NAME:X:bent ...]")
    folder = os.path.abspath(words[1] if len(words) > 1 else os.path.join(words[0], "applications"))
    if "--pairs" in sys.argv:
        pairs(words[0], folder, os.path.abspath(words[2]), words[3:])
        return
    if "--distances" in sys.argv:
        distances(words[0], folder, words[2:])
        return
    if "--large" in sys.argv:
        large(words[0], folder)
        return
    run_all(words[0], folder)
    ss = package(words[0])
    matching_picture(ss, folder)
    distances_picture(ss, folder)
    for fitted in ("", "fitted_"):
        for name, _, _ in PAIRS:
            with open(os.path.join(folder, fitted + report_name(name) + ".out")) as file:
                print(f"{fitted}{name}\n{file.read()}")
        with open(os.path.join(folder, fitted + "distances.out")) as file:
            print(fitted + file.read())


if __name__ == "__main__":
    main()
