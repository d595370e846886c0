# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   simplify_match_plot.py X.off Y.off picture.png [N]
#
# Simplifies X to N vertices (600), matches X to Y, and draws both. Cells for an editor begin with
# %%. Two poses of one shape to try it on:
#   make_demo_shape X.off --vertices 5000 --pose stand
#   make_demo_shape Y.off --vertices 5000 --pose walk --shuffle 1

# %% Two meshes: arrays of positions and of corners.
import sys

import matplotlib
import numpy as np

import spectral_simplification as ss

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def read_off(path):
    with open(path) as file:
        words = file.read().split()
    n, m = int(words[1]), int(words[2])
    corners = np.array(words[4 + 3 * n:4 + 3 * n + 4 * m], int).reshape(m, 4)
    return np.array(words[4:4 + 3 * n], float).reshape(n, 3), corners[:, 1:]


x, y, picture = sys.argv[1:4]
n = int(sys.argv[4]) if len(sys.argv) > 4 else 600
k = min(100, n // 3)
(VX, FX), (VY, FY) = read_off(x), read_off(y)

# %% Simplify, and say how well the spectrum was kept.
run = ss.simplify(VX, FX, n, k)
judged = ss.evaluate(VX, FX, run.V, run.F, run.P, k, eigenpairs=run.eigenpairs)
print(judged)

# %% Match: a vertex of Y for each of X.
matched = ss.match(VX, FX, VY, FY, n, k)

# %% Draw. The match carries colours of Y to X, and P carries them to the simplified X.
colours = (VY - VY.min(axis=0)) / np.ptp(VY, axis=0)
of_X = colours[matched.map]


def draw(place, title, V, F, colours):
    axes = figure.add_subplot(1, 4, place, projection="3d", title=title)
    axes.set_axis_off()
    axes.set_box_aspect(np.ptp(V, axis=0))
    surface = axes.plot_trisurf(*V.T, triangles=F, linewidth=0)
    surface.set_facecolor(np.clip(colours[F].mean(axis=1), 0, 1))


figure = plt.figure(figsize=(16, 4), layout="constrained")
draw(1, "Y", VY, FY, colours)
draw(2, "X, matched", VX, FX, of_X)
draw(3, "X, simplified", run.V, run.F, run.P @ of_X)
axes = figure.add_subplot(1, 4, 4, title="C of the simplification")
axes.imshow(abs(judged.C), cmap="Blues")
figure.savefig(picture)
