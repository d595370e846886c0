#!/usr/bin/env python3
# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Makes the figures of the manual from runs of the example programs on the shape of the
# demonstration and on a terrain, and from the tables of times in doc/:
#   doc/make_figures.py BUILD [FOLDER]
# BUILD is where the programs and the Python module were built. What they write goes to FOLDER
# (BUILD/figures) and is used again when it is there. What the manual quotes of it goes to
# doc/figures.json. Needs what pictures.py does.

import csv
import json
import math
import os
import re
import subprocess
import sys
import warnings

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LogNorm, Normalize
from matplotlib.ticker import FuncFormatter, NullFormatter, NullLocator

from make_results import commit, name
from pictures import (BLUE, ERRORS, GREEN, GREY, MODES, ORANGE, PINK, RED, WIDTH, Judged, Picture,
                      box_of, colour_bar, package, plt, save, seen, show)

HERE = os.path.dirname(os.path.abspath(__file__))
K = 100
SIZES = [100, 150, 200, 300, 450, 600, 900, 1400, 2000]
FLANK = (-0.6, -0.35, 0.2, 0.45)  # of the demonstration shape as it is seen
# The terrain's runs: what stands above the picture, and the options.
BORDERS = {
    "paper": ("the paper's metric", ["--preset", "paper", "--mass", "averaged"]),
    "preserved": ("with preserve_border",
                  ["--preset", "paper", "--mass", "averaged",
                   "--preserve-border"]), "best": ("preset best", [])
}
# The simplifiers of all.json that are shown, by a short name: simplifier, placement, relocation.
SHOWN = {
    "best": ("spectral, best", "free", "sampled"),
    "shape term": ("spectral with shape term", "free", "none"),
    "metric": ("spectral", "free", "none"), "plane": ("Garland-Heckbert plane", "optimal", "none"),
    "probabilistic": ("Garland-Heckbert probabilistic plane, area 20000", "optimal", "none"),
    "isotropic": ("isotropic remeshing", "none", "none"), "edge length": ("edge length", "midpoint",
                                                                          "none")
}


def run(build, folder, output, program, *arguments):
    if not os.path.exists(os.path.join(folder, output)):
        subprocess.run([os.path.abspath(os.path.join(build, "examples", program)), *arguments],
                       check=True,
                       cwd=folder)


def run_all(build, folder):
    os.makedirs(folder, exist_ok=True)
    run(build, folder, "shape.ply", "make_demo_shape", "shape.ply", "--vertices", "10000")
    run(build, folder, "all.json", "spectral_compare", "shape.ply", "--vertices", "600", "--judge",
        "averaged", "--coloured", "col", "--json", "all.json", "--quiet")
    run(build, folder, "curve.json", "spectral_compare", "shape.ply", "--vertices",
        ",".join(map(str, SIZES)), "--only", "spectral, best", "--only", "spectral with shape term",
        "--only", "isotropic", "--only", "probabilistic plane", "--without", "fitted", "--judge",
        "lumped,averaged", "--json", "curve.json", "--quiet")
    run(build, folder, "masses.json", "spectral_compare", "shape.ply", "--vertices", "600",
        "--only", "spectral, best", "--judge", "lumped,averaged", "--json", "masses.json",
        "--quiet")
    terrain(os.path.join(folder, "terrain.off"))
    for stem, (_, options) in BORDERS.items():
        run(build, folder, f"border_{stem}.json", "spectral_simplify", "terrain.off",
            f"border_{stem}.off", "--vertices", "300", *options, "--json", f"border_{stem}.json",
            "--quiet")


def read(folder, json_name):
    with open(os.path.join(folder, json_name)) as file:
        return json.load(file)


# An island whose border has bays, of 7,651 vertices.
def terrain(path, rings=50):
    points, rows, triangles = [(0, 0)], [[0]], []
    for j in range(1, rings + 1):
        rows.append([])
        for i in range(6 * j):
            turn, r = 2 * math.pi * i / (6 * j), j / rings
            r *= 1 + r * (0.12 * math.cos(5 * turn) + 0.06 * math.cos(11 * turn + 1) +
                          0.03 * math.cos(23 * turn))
            rows[j].append(len(points))
            points.append((r * math.cos(turn), r * math.sin(turn)))
        for i in range(6 * j):
            inner, outer, side = rows[j - 1], rows[j], i // j
            a, b = outer[i], outer[(i + 1) % (6 * j)]
            c, d = inner[(i - side) % len(inner)], inner[(i - side + 1) % len(inner)]
            triangles.append((c, a, b))
            if (i + 1) % j:
                triangles.append((c, b, d))
    with open(path, "w") as file:
        file.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        for x, y in points:
            z = 0.12 * math.sin(5 * x + 1) * math.cos(4 * y) + 0.04 * math.sin(13 * x - 9 * y)
            file.write(f"{x:.9g} {y:.9g} {z:.9g}\n")
        file.writelines("3 {} {} {}\n".format(*t) for t in triangles)


# --- meshes ---------------------------------------------------------------------------------------


class Shape:
    """The demonstration shape, its eigenpairs, and simplified ones beside it."""

    def __init__(self, ss, folder):
        self.ss, self.folder = ss, folder
        self.V, self.F = ss.read_mesh(os.path.join(folder, "shape.ply"))
        self.pairs = ss.eigenpairs(self.V, self.F, K + K // 5)
        self.rows = read(folder, "all.json")["rows"]
        self.box = box_of(seen(self.V))
        self.picture = Picture(seen(self.V), self.F, self.box, 350)
        self.mode = self.mode_apart()
        self.input = {f"the input, {len(self.V):,} vertices": self.pairs}
        self.judged = {word: self.judge(*ss.read_mesh(self.path(word))) for word in SHOWN}

    # Nearly equal modes may mix, whoever simplifies. The eigenvalue of this one is a tenth away
    # from the others.
    def mode_apart(self):
        values = self.pairs.values
        apart = [
            k for k in range(2, 11) if all(
                abs(values[k - 1] - values[j]) > 0.1 * values[k - 1] for j in (k - 2, k))
        ]
        return apart[len(apart) // 2]

    def path(self, word):
        row = next(r for r in self.rows
                   if (r["simplifier"], r["placement"] or "none", r["relocation"]) == SHOWN[word])
        return os.path.join(self.folder, "col",
                            re.sub("[^A-Za-z0-9]+", "_", name(row)) + "_600.ply")

    def judge(self, V, F):
        return Judged(self.ss, self.V, self.F, self.pairs, V, F)

    def scale(self, mode, pairs):
        high = np.abs(pairs.vectors[:, mode - 1]).max()
        return Normalize(-high, high)

    # A mode of an operator or two on the input, and of the last one on meshes, with the error map
    # below; returns figure and axes.
    def strip(self, fine, judged, errors, mode=None, rows=2, height=4.6):
        mode = mode or self.mode
        figure, axes = plt.subplots(rows, 4, figsize=(WIDTH, height), constrained_layout=True)
        for a, (title, pairs) in zip(axes[0], fine.items()):
            show(a, self.picture.painted(pairs.vectors[:, mode - 1], MODES,
                                         self.scale(mode, pairs)), title)
        for column, (title, j) in enumerate(judged.items(), len(fine)):
            picture = Picture(seen(j.V), j.F, self.box, 350)
            show(axes[0, column],
                 picture.painted(j.mode(mode), MODES, self.scale(mode, pairs), wire=1), title)
            show(axes[1, column],
                 picture.painted(j.error, ERRORS, errors, wire=1, shade=0.3),
                 below=str(j))
        for a in axes[1:, :len(fine)].flat:
            a.axis("off")
        scale, bars = self.scale(
            mode, pairs), [axes[1, 0].inset_axes([0.05, y, 0.8, 0.06]) for y in (0.75, 0.3)]
        colour_bar(figure,
                   None,
                   MODES,
                   scale,
                   f"above: eigenfunction {mode}",
                   cax=bars[0],
                   orientation="horizontal",
                   ticks=[0])
        colour_bar(figure,
                   None,
                   ERRORS,
                   errors,
                   "right: where ‖C‖$_L$ comes from",
                   cax=bars[1],
                   orientation="horizontal",
                   format="%g")
        return figure, axes


def matrix(axes, judged, title=None, below=None):
    show(axes, np.abs(judged.C), title, below, cmap="Blues", norm=Normalize(0, 1))


# The first picture of README and manual: a mode on the input and on what three simplifiers made of
# it, where they err, their functional maps.
def teaser(shape):
    shown = {
        "this package, 600": shape.judged["best"],
        "probabilistic quadrics, 600": shape.judged["probabilistic"],
        "plane quadrics, 600": shape.judged["plane"]
    }
    figure, axes = shape.strip(shape.input, shown, Normalize(0, 100), rows=3, height=6.9)
    for a, j in zip(axes[2, 1:], shown.values()):
        matrix(a, j)
    axes[2, 0].text(
        0,
        0.5,
        "right: |C|, the first 100\neigenfunctions of the\ninput in those of the\n"
        "result; perfect is a\nthin diagonal",
        va="center",
        transform=axes[2, 0].transAxes)
    save(figure, "teaser")


# What each step of the preset brings: the paper's metric, the shape term, relocation.
def steps(shape):
    shown = {
        "the paper's metric": shape.judged["metric"],
        "with the shape term": shape.judged["shape term"],
        "relocated: the preset best": shape.judged["best"]
    }
    save(shape.strip(shape.input, shown, Normalize(0, 100))[0], "steps")
    return [j.numbers.C_L for j in shown.values()]


# K = 100 modes on fewer and fewer vertices.
def sizes(shape):
    runs = [shape.ss.simplify(shape.V, shape.F, n, K) for n in (2000, 300, 150)]
    shown = {f"N = {len(r.V):,}": shape.judge(r.V, r.F) for r in runs}
    save(shape.strip(shape.input, shown, LogNorm(1, 1000))[0], "sizes")


# A mode of another operator, on a mesh that was simplified for it and on one that was not.
def operators(shape):
    ss, V, F = shape.ss, shape.V, shape.F
    curvature = ss.curvature_coefficients(V, F, 1)
    pairs = ss.eigenpairs(V, F, K + K // 5, coefficients=curvature)
    knows, other = ss.simplify(V, F, 600, K, coefficients=curvature), ss.simplify(V, F, 600, K)
    # Coefficients for the mesh that did not know them, by the P of its collapses.
    carried = ss.simplify(V, F, 600, K, relocate="none").P @ curvature
    shown = {
        title: Judged(ss, V, F, pairs, r.V, r.F, coefficients=curvature, coarse_coefficients=c)
        for title, r, c in (("600, made for it", knows, knows.coefficients),
                            ("600, made for the other", other, carried))
    }
    fine = {
        f"{operator}, {len(V):,}": of
        for operator, of in (("Laplace-Beltrami", shape.pairs), ("anisotropic", pairs))
    }
    save(shape.strip(fine, shown, Normalize(0, 60), mode=8)[0], "operators")
    return [j.numbers.C_L for j in shown.values()]


# Eigenfunctions of the input: how small the features are that K of them tell apart.
def modes(shape):
    figure, axes = plt.subplots(1, 3, figsize=(WIDTH, 3.1), constrained_layout=True)
    picture = Picture(seen(shape.V), shape.F, shape.box, 520)
    for a, k in zip(axes, (10, 30, 100)):
        show(a, picture.painted(shape.pairs.vectors[:, k - 1], MODES, shape.scale(k, shape.pairs)),
             f"eigenfunction {k}")
    save(figure, "modes")


def functional_maps(shape):
    titles = {
        "best": "spectral, best", "isotropic": "isotropic remeshing",
        "edge length": "edge length, midpoint", "plane": "Garland-Heckbert, plane"
    }
    figure, axes = plt.subplots(1, 4, figsize=(WIDTH, 2.55), constrained_layout=True)
    for a, (word, title) in zip(axes, titles.items()):
        j = shape.judged[word]
        matrix(a, j, title, f"‖C‖$_L$ {j.numbers.C_L:.1f}, ‖C‖$_D$ {j.numbers.C_D:.2f}")
    colour_bar(figure, axes, plt.get_cmap("Blues"), Normalize(0, 1), "|C|", shrink=0.8, pad=0.01)
    save(figure, "functional_maps")


# Where relocation moves the vertices, and what it does to C and to the eigenvalues.
def relocation(shape):
    both = {"before": shape.judged["shape term"], "after": shape.judged["best"]}
    before, after = both.values()
    if not np.array_equal(before.F, after.F):
        sys.exit("Relocation starts from other collapses than those without it.")
    figure, axes = plt.subplot_mosaic(
        [["before", "after", "chart"], ["map before", "map after", "chart"]],
        figsize=(WIDTH, 5.6),
        constrained_layout=True)
    for (word, j), style in zip(both.items(),
                                ({"color": RED, "ls": "--", "lw": 1.1}, {"color": BLUE})):
        show(axes[word],
             Picture(seen(j.V), j.F, FLANK, 520).painted(wire=1.2),
             f"{word} relocation",
             extent=np.array(FLANK)[[0, 2, 1, 3]])
        matrix(axes["map " + word], j, f"|C| {word}",
               f"‖C‖$_L$ {j.numbers.C_L:.1f}, ‖C‖$_D$ {j.numbers.C_D:.2f}")
        off = 100 * np.abs(j.numbers.coarse_values[1:K] / j.numbers.values[1:K] - 1)
        axes["chart"].plot(np.arange(2, K + 1),
                           off,
                           label=f"{word}, mean {off.mean():.1f} %",
                           **style)
    X, Y = seen(before.V), seen(after.V)
    N = np.cross(Y[after.F[:, 1]] - Y[after.F[:, 0]], Y[after.F[:, 2]] - Y[after.F[:, 0]])
    front = np.setdiff1d(np.arange(len(Y)), after.F[N[:, 2] <= 0])
    axes["after"].add_collection(
        LineCollection(np.stack([X[front, :2], Y[front, :2]], axis=1), colors=RED, linewidths=1.8))
    axes["after"].set(xlim=FLANK[::2], ylim=FLANK[1::2])
    axes["chart"].set(title="error of eigenvalue k in %",
                      xlabel="mode k",
                      xlim=(0, K),
                      ylim=(0, None))
    axes["chart"].legend()
    save(figure, "relocation")
    return {word: j.numbers.C_L for word, j in both.items()}


# The terrain from above, with the border that it had.
def borders(ss, folder):
    V, F = ss.read_mesh(os.path.join(folder, "terrain.off"))

    def plan_area(V, F):
        return np.cross(V[F[:, 1], :2] - V[F[:, 0], :2], V[F[:, 2], :2] - V[F[:, 0], :2]).sum() / 2

    edges = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1)
    edges, times = np.unique(edges, axis=0, return_counts=True)
    outline, box, data = V[edges[times == 1], :2], box_of(V), {}
    figure, axes = plt.subplots(1, 3, figsize=(WIDTH, 3.4), constrained_layout=True)
    for a, (stem, (title, _)) in zip(axes, BORDERS.items()):
        Vc, Fc = ss.read_mesh(os.path.join(folder, f"border_{stem}.off"))
        result = read(folder, f"border_{stem}.json")
        data[stem] = {
            "norm_L": result["norm_L"],
            "eigenvalue_error_percent": 100 * result["eigenvalue_error_mean"],
            "area_percent": 100 * (plan_area(Vc, Fc) / plan_area(V, F) - 1)
        }
        area = f"{data[stem]['area_percent']:+.1f}".replace("-", "−")
        show(
            a,
            Picture(Vc, Fc, box, 520).painted(wire=1, shade=0.8),
            title,
            f"‖C‖$_L$ {data[stem]['norm_L']:.1f}, eigenvalues "
            f"{data[stem]['eigenvalue_error_percent']:.1f} % off\narea from above {area} %",
            extent=np.array(box)[[0, 2, 1, 3]])
        a.add_collection(LineCollection(outline, colors=RED, linewidths=1.3))
    save(figure, "border")
    return data


# --- charts ---------------------------------------------------------------------------------------


def logarithmic(axes, ticks):
    axis = {"x": axes.xaxis, "y": axes.yaxis}
    for letter, at in ticks.items():
        axis[letter].axes.set(**{letter + "scale": "log"})
        axis[letter].set_ticks(at)
        axis[letter].set_major_formatter(
            FuncFormatter(lambda x, _: "1 M" if x == 1e6 else f"{x:,.10g}"))
        axis[letter].set_minor_locator(NullLocator())
        axis[letter].set_minor_formatter(NullFormatter())


def legend_below(figure, axes, height):
    figure.set_layout_engine("constrained", rect=(0, height, 1, 1 - height))
    figure.legend(*axes.get_legend_handles_labels(),
                  loc="lower center",
                  ncol=5,
                  fontsize=8,
                  frameon=False,
                  columnspacing=1.2)


# The norms over N, P of closest points: for each mass and line the points (N, |C|_L, |C|_D, error
# of the eigenvalues in percent).
def lines_over_n(folder):
    lines = {}
    for r in read(folder, "curve.json")["rows"]:
        own = r["metric_mass"] == r["judged_mass"]
        if r["simplifier"] == "spectral, best":
            line = "best"
        elif r["simplifier"] == "spectral with shape term":
            line = ("policies"
                    if own and r["placement"] == "free" and r["relocation"] == "none" else None)
        else:
            line = "isotropic" if r["simplifier"] == "isotropic remeshing" else "quadrics"
        if line is None or r["placement"] == "midpoint":
            continue
        norms = r["closest_point_P"]
        lines.setdefault((r["judged_mass"], line), []).append(
            (r["vertices"], norms["norm_L"], norms["norm_D"], 100 * r["eigenvalue_error_mean"]))
        if line == "policies":
            lines.setdefault((r["judged_mass"], "floor"), []).append(
                (r["requested_vertices"], r["floor_norm_L"], r["floor_norm_D"], None))
    return {key: sorted(points) for key, points in lines.items()}


def curve(folder):
    lines = lines_over_n(folder)
    styles = {
        "best": ("spectral, best", {"color": BLUE, "lw": 3, "marker": "o"}),
        "policies": ("spectral, not relocated", {"color": BLUE, "lw": 1, "ls": "--",
                                                 "marker": "o"}),
        "quadrics": ("probabilistic plane quadrics", {"color": RED, "lw": 1, "marker": "s"}),
        "isotropic": ("isotropic remeshing", {"color": ORANGE, "lw": 1, "ls": "-.", "marker": "^"}),
        "floor": ("ideal elements (estimate)", {"color": GREY, "lw": 1, "ls": ":"})
    }
    figure, axes = plt.subplots(2, 2, figsize=(WIDTH, 6), constrained_layout=True)
    panels = [("averaged", 1, "‖C‖$_L$, averaged mass", [1, 10, 100]),
              ("averaged", 2, "‖C‖$_D$, averaged mass", [0.3, 1, 3, 10]),
              ("averaged", 3, "mean eigenvalue error in %, averaged mass", [0.3, 1, 3, 10]),
              ("lumped", 1, "‖C‖$_L$, lumped mass", [30, 100, 300])]
    for a, (mass, quantity, title, ticks) in zip(axes.flat, panels):
        for key, (label, style) in styles.items():
            points = np.array([(p[0], p[quantity]) for p in lines[mass, key]
                               if p[quantity]]).reshape(-1, 2)
            a.plot(*points.T, label=label, **style)
        a.axvline(3 * K, color="black", lw=1, ls=(0, (1, 3)))
        logarithmic(a, {"x": [100, 200, 300, 600, 1000, 2000], "y": ticks})
        a.set(title=title, xlabel="N, vertices; dotted: 3 K")
    legend_below(figure, axes[0, 0], 0.06)
    save(figure, "norms_over_n")


# Coarse over fine eigenvalues of one mesh in the mass matrices, its own and fitted ones.
def masses(folder):
    data = read(folder, "masses.json")
    fine = {f["mass"]: np.array(f["eigenvalues"]) for f in data["fine"]}
    modes, means = np.arange(2, K + 1), {}
    figure, axes = plt.subplots(1, 2, figsize=(WIDTH, 3.6), constrained_layout=True)

    def draw(a, label, mass, fitted, **style):
        row = next(r for r in data["rows"]
                   if r["judged_mass"] == mass and ("fitted" in r["simplifier"]) == fitted)
        means[mass + ("_fitted" if fitted else "")] = 100 * row["eigenvalue_error_mean"]
        a.plot(modes,
               100 * (np.array(row["coarse_eigenvalues"])[1:K] / fine[mass][1:K] - 1),
               label=label,
               **style)

    averaged = {"color": BLUE, "lw": 2}
    draw(axes[0], "averaged", "averaged", False, **averaged)
    draw(axes[0], "lumped", "lumped", False, color=RED, ls="--")
    axes[0].plot([1, K], [-100 * 2 * math.pi / (4 * math.sqrt(3)) * k / 600 for k in (1, K)],
                 color=GREY,
                 ls=":",
                 label="lumped, even triangles (estimate)")
    draw(axes[1], "averaged", "averaged", False, **averaged)
    draw(axes[1], "averaged, fitted", "averaged", True, color="black", lw=1.1)
    draw(axes[1], "lumped, fitted", "lumped", True, color=RED, ls="--")
    axes[0].set(title="own operators of the mesh",
                xlabel="mode k",
                ylabel="error of eigenvalue k in %",
                xlim=(0, K))
    axes[1].set(title="fitted operators, at a larger scale", xlabel="mode k", xlim=(0, K))
    for a in axes:
        a.axhline(0, color="black", lw=0.7)
        a.legend()
    save(figure, "masses")
    return means


# --- tables of times ------------------------------------------------------------------------------


def table_of(csv_name, words=()):
    with open(os.path.join(HERE, csv_name), newline="") as file:
        return [{key: value if key in words else float(value or "nan")
                 for key, value in row.items()} for row in csv.DictReader(file)]


# `spectral_benchmark --scaling`: shapes of more and more vertices, for several K. The rival was
# measured again for each K: the mean is drawn.
def scaling():
    rows = table_of("scaling.csv")
    figure, axes = plt.subplots(1, 2, figsize=(WIDTH, 3.8), constrained_layout=True)
    styles = [{"ls": "-", "marker": "o"}, {"ls": "--", "marker": "s"}, {"ls": "-.", "marker": "^"},
              {"ls": ":", "marker": "D"}]
    for k, colour, style in zip(sorted({r["eigenvectors"]
                                        for r in rows}), (BLUE, RED, GREEN, PINK), styles):
        own = [r for r in rows if r["eigenvectors"] == k]
        for a, column in zip(axes, ("us_per_collapse", "seconds_total")):
            a.plot([r["vertices"] for r in own], [r[column] for r in own],
                   color=colour,
                   label=f"spectral, K = {k:g}",
                   **style)
    sizes = sorted({r["vertices"] for r in rows})
    rival = [
        np.mean([r["us_per_collapse_garland_heckbert"] for r in rows if r["vertices"] == n])
        for n in sizes
    ]
    removed = [n - next(r["target"] for r in rows if r["vertices"] == n) for n in sizes]
    for a, values in zip(axes, (rival, np.array(rival) * removed / 1e6)):
        a.plot(sizes,
               values,
               color="black",
               lw=1,
               marker="x",
               label="Garland-Heckbert, plane quadrics")
        a.set(xlabel="vertices of the input")
    axes[0].set(title=f"microseconds per collapse, {rows[0]['threads']:g} threads")
    axes[1].set(title="seconds in all, eigenpairs included")
    logarithmic(axes[0], {"x": [10000, 100000, 1000000], "y": [5, 10, 20, 50, 100]})
    logarithmic(axes[1], {"x": [10000, 100000, 1000000], "y": [0.1, 1, 10, 100]})
    legend_below(figure, axes[0], 0.09)
    save(figure, "scaling")


# `spectral_benchmark --scaling-shape disc`: fans of more and more triangles.
def degree():
    rows = table_of("degree.csv")
    neighbours = [r["vertices"] - 1 for r in rows]
    figure, axes = plt.subplots(figsize=(WIDTH * 0.6, 3.4), constrained_layout=True)
    axes.plot(neighbours, [r["us_per_collapse"] for r in rows],
              color=BLUE,
              lw=2.5,
              marker="o",
              label="spectral, best")
    axes.plot(neighbours, [r["us_per_collapse_garland_heckbert"] for r in rows],
              color="black",
              lw=1,
              ls="--",
              marker="x",
              label="Garland-Heckbert, plane quadrics")
    logarithmic(axes, {"x": [10, 100, 1000, 10000], "y": [10, 100, 1000, 10000, 100000]})
    axes.set(title="microseconds per collapse", xlabel="neighbours of the vertex")
    axes.legend()
    save(figure, "degree")


# Time and memory from file to file, over the size of the input: whole_runs.csv.
def whole_runs():
    rows = table_of("whole_runs.csv", words=("program",))
    figure, axes = plt.subplots(1, 2, figsize=(WIDTH, 3.6), constrained_layout=True)
    styles = {"best": {"color": BLUE, "lw": 3, "marker": "o"},
              "fast": {"color": GREEN, "lw": 2, "ls": "--", "marker": "s"},
              "plane quadrics": {"color": "black", "lw": 1, "marker": "x"}}
    for program, style in styles.items():
        own = [r for r in rows if r["program"] == program]
        for a, column in zip(axes, ("seconds", "gigabytes")):
            a.plot([r["vertices"] for r in own], [r[column] for r in own], label=program, **style)
    ticks = {"x": [10000, 100000, 1000000]}
    logarithmic(axes[0], {**ticks, "y": [0.1, 1, 10]})
    logarithmic(axes[1], {**ticks, "y": [0.01, 0.1, 1]})
    axes[0].set(title="seconds from file to file", xlabel="vertices of the input")
    axes[1].set(title="peak memory, GB", xlabel="vertices of the input")
    legend_below(figure, axes[0], 0.09)
    save(figure, "whole_runs")


# Means over the nine meshes of the README: frontier.csv for several goals of relocation, rivals.md
# for the others. How the first was measured stands in measurements.md.
def frontier():
    rows = table_of("frontier.csv")
    figure, axes = plt.subplots(figsize=(WIDTH * 0.7, 3.6), constrained_layout=True)
    x, y = ([r[key] for r in rows] for key in ("hausdorff", "norm_L"))
    axes.plot(x, y, color=BLUE, lw=2.5, marker="o", label="this package, goals as written")
    for r in rows:
        goal = "none" if r["goal"] > 1 else f"{r['goal']:g}"
        axes.annotate(goal, (r["hausdorff"], r["norm_L"]), (-3, -12), textcoords="offset points",
                      ha="right", fontsize=8)
    with open(os.path.join(HERE, "rivals.md")) as file:
        means = file.read().split("## Geometric means, judged in the averaged mass")[1]
    others = {"CGAL: Garland-Heckbert, plane quadrics": ("plane quadrics", "x", "black"),
              "CGAL: Garland-Heckbert, probabilistic plane quadrics":
                  ("probabilistic plane quadrics", "^", RED),
              "meshoptimizer-regularized": ("meshoptimizer, regularised", "s", GREEN),
              "line-quadrics-0.1": ("line quadrics", "D", ORANGE), "rematching": ("ReMatching", "v",
                                                                               PINK)}
    for name_of_row, (label, marker, colour) in others.items():
        cells = re.search(r"^\| " + re.escape(name_of_row) + r" \|(.*)$", means, re.M)[1]
        numbers = [c.strip(" *") for c in cells.split("|")]
        axes.plot(float(numbers[7]), float(numbers[0]), ls="", marker=marker, ms=7, color=colour,
                  label=label)
    logarithmic(axes, {"x": [0.5, 0.7, 1, 1.5, 2], "y": [10, 20, 50, 100, 200]})
    axes.set(xlabel="Hausdorff distance, % of the diagonal", title="‖C‖_L, averaged mass",
             xlim=(0.5, 2), ylim=(10, 400))
    axes.legend(loc="upper right")
    save(figure, "frontier")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: make_figures.py BUILD [FOLDER]")
    folder = sys.argv[2] if len(sys.argv) == 3 else os.path.join(sys.argv[1], "figures")
    folder = os.path.abspath(folder)
    run_all(sys.argv[1], folder)
    warnings.simplefilter("ignore")  # K = 100 modes on 150 vertices
    ss = package(sys.argv[1])
    shape = Shape(ss, folder)
    teaser(shape)
    sizes(shape)
    modes(shape)
    functional_maps(shape)
    curve(folder)
    scaling()
    degree()
    whole_runs()
    frontier()
    data = {
        "commit": commit(),
        "norms_over_n": [{"mass": mass, "line": line, "points": points}
                         for (mass, line), points in lines_over_n(folder).items()],
        "steps": steps(shape), "operators": operators(shape), "masses": masses(folder),
        "relocation": relocation(shape), "border": borders(ss, folder)
    }
    with open(os.path.join(HERE, "figures.json"), "w") as file:
        json.dump(data, file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
