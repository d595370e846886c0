# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# What the figures of the manual have in common: the style of charts, meshes as images of pixels,
# and the functional map of a mesh, whoever made it. Needs NumPy, SciPy and matplotlib.

import base64
import io
import os
import re
import sys

import matplotlib
import numpy as np
import scipy.sparse
import scipy.spatial
from PIL import Image

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.cm import ScalarMappable

FIGURES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "fig")
WIDTH = 8.65  # inches, 830 pixels of a page
# Colours that the colour-blind tell apart (Okabe and Ito 2008); in print dashes and marks do.
BLUE, RED, GREEN, PINK, ORANGE, GREY = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00",
                                        "#767676")
MODES, COLOURS, ERRORS = plt.get_cmap("RdBu_r"), plt.get_cmap("cividis"), plt.get_cmap("viridis_r")
plt.rcParams.update({
    "font.size": 9, "axes.titlesize": 9, "axes.titleweight": "bold", "axes.grid": True,
    "grid.color": "#dddddd", "axes.axisbelow": True, "axes.edgecolor": GREY,
    "xtick.color": "#444444", "ytick.color": "#444444", "lines.linewidth": 1.6,
    "lines.markersize": 4, "image.composite_image": False, "svg.hashsalt": "figures"
})


def package(build):
    """The Python package of a build."""
    sys.path.insert(0, os.path.join(os.path.abspath(build), "examples", "python"))
    import spectral_simplification

    return spectral_simplification


def save(figure, name):
    """As SVG with letters as outlines, alike everywhere. Images get 96 colours, which makes them
    a third as large."""

    def with_few_colours(found):
        few = io.BytesIO()
        Image.open(io.BytesIO(base64.b64decode(found[1]))).convert("RGB").quantize(96).save(
            few, "PNG", optimize=True)
        return "data:image/png;base64," + base64.b64encode(few.getvalue()).decode()

    drawn = io.StringIO()
    figure.savefig(drawn, format="svg", metadata={"Date": None})
    plt.close(figure)
    text = re.sub(r"data:image/png;base64,\s*([A-Za-z0-9+/=\s]*)", with_few_colours,
                  drawn.getvalue())
    os.makedirs(FIGURES, exist_ok=True)
    with open(os.path.join(FIGURES, name + ".svg"), "w") as file:
        file.write(re.sub(r" +\n", "\n", text))


def seen(V, turn=60, tilt=18):
    """Right, up and towards the eye: the demonstration shape from the side, a little from above."""
    t, h = np.radians([turn, tilt])
    right, away = np.array([np.cos(t), np.sin(t), 0]), np.array([-np.sin(t), np.cos(t), 0])
    up = np.array([0, 0, 1])
    return (V @ np.array(
        [right, np.cos(h) * up + np.sin(h) * away,
         np.sin(h) * up - np.cos(h) * away]).T)


def box_of(*meshes):
    """What all of them take of the plane, with a margin."""
    X = np.concatenate(meshes)[:, :2]
    low, high = X.min(axis=0), X.max(axis=0)
    margin = 0.02 * (high - low).max()
    return (*(low - margin), *(high + margin))


class Picture:
    """A mesh as seen(): for each pixel its face and the coordinates within it. There are twice as
    many pixels in each direction as in the image, whose edges are smooth therefore."""

    def __init__(self, X, F, box, width):
        scale = 2 * width / (box[2] - box[0])
        w, h = 2 * width, 2 * round(width * (box[3] - box[1]) / (box[2] - box[0]))
        P = np.column_stack([(X[:, 0] - box[0]) * scale, (box[3] - X[:, 1]) * scale,
                             X[:, 2] * scale])
        self.F, self.face, self.corners = F, np.full((h, w), -1), np.zeros((h, w, 3))
        depth = np.full((h, w), -np.inf)
        N = np.cross(P[F[:, 1]] - P[F[:, 0]], P[F[:, 2]] - P[F[:, 0]])
        self.light = np.abs(N[:, 2]) / np.maximum(np.linalg.norm(N, axis=1), 1e-300)
        # How far a corner is from the edge opposite, in pixels.
        opposite = np.linalg.norm((P[np.roll(F, -1, 1)] - P[np.roll(F, -2, 1)])[:, :, :2], axis=2)
        self.heights = np.abs(N[:, 2])[:, None] / np.maximum(opposite, 1e-300)
        for f in np.flatnonzero(N[:, 2] < 0):  # rows go down: these face the eye
            a, b, c = P[F[f]]
            x0, y0 = np.maximum(np.ceil(np.minimum(np.minimum(a, b), c)[:2]), 0).astype(int)
            x1, y1 = np.minimum(np.maximum(np.maximum(a, b), c)[:2], (w - 1, h - 1)).astype(int) + 1
            if x0 >= x1 or y0 >= y1:
                continue
            x, y = np.arange(x0, x1)[None, :], np.arange(y0, y1)[:, None]
            s = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / N[f, 2]
            t = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / N[f, 2]
            z = a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2])
            new = (s >= 0) & (t >= 0) & (s + t <= 1) & (z > depth[y0:y1, x0:x1])
            depth[y0:y1, x0:x1][new] = z[new]
            self.face[y0:y1, x0:x1][new] = f
            self.corners[y0:y1, x0:x1][new] = np.stack([1 - s - t, s, t], axis=2)[new]

    def painted(self,
                values=None,
                colours=None,
                scale=None,
                wire=0,
                lines=None,
                lines_of=None,
                shade=0.5):
        """An image. `values` at vertices become `colours` by `scale`; `wire` is the width of edges
        in pixels of it; at multiples of `lines` a function has lines, `values` or `lines_of`."""
        on = self.face >= 0
        face, corners = self.face[on], self.corners[on]
        image = np.ones((*on.shape, 3))

        def at_pixels(f):
            return np.einsum("pc,pc->p", f[self.F[face]], corners)

        pixels = (np.tile([0.84, 0.90, 0.96],
                          (len(face),
                           1)) if values is None else colours(scale(at_pixels(values)))[:, :3])
        pixels = pixels * (1 - shade + shade * self.light[face])[:, None]
        if wire:
            pixels[(corners * self.heights[face]).min(axis=1) < wire] *= 0.5
        image[on] = pixels
        if lines:
            level = np.full(on.shape, -(10**6))
            level[on] = np.floor(at_pixels(values if lines_of is None else lines_of) / lines)
            near = np.zeros(on.shape, bool)
            for axis in (0, 1):
                for step in (-1, 1):
                    other = np.roll(level, step, axis)
                    near |= (np.abs(level - other) == 1) & on
            image[near] *= 0.25
        h, w = on.shape
        return image.reshape(h // 2, 2, w // 2, 2, 3).mean(axis=(1, 3))


def show(axes, image, title=None, below=None, **options):
    axes.imshow(image, interpolation="none", **options)
    axes.set_title(title)
    axes.set_xlabel(below, color="black")
    axes.set(xticks=[], yticks=[])
    axes.grid(False)
    if image.ndim == 3:
        axes.spines[:].set_visible(False)


def colour_bar(figure, axes, colours, scale, label, **options):
    bar = figure.colorbar(ScalarMappable(scale, colours), ax=axes, label=label, **options)
    bar.outline.set_edgecolor(GREY)
    return bar


def closest_point_restriction(V, F, points):
    """P of the closest points on a fine mesh, among the faces around the 16 nearest vertices."""
    around = scipy.sparse.csr_matrix(
        (np.ones(F.size), (F.ravel(), np.repeat(np.arange(len(F)), 3))), (len(V), len(F)))
    rows, columns, weights = [], [], []
    for i, near in enumerate(scipy.spatial.cKDTree(V).query(points, 16)[1]):
        faces = np.unique(around[near].indices)
        A, B, C = (V[F[faces, k]] for k in range(3))
        p = points[i]
        N = np.cross(B - A, C - A)
        area = np.maximum((N * N).sum(axis=1), 1e-300)
        s = (np.cross(p - A, C - A) * N).sum(axis=1) / area
        t = (np.cross(B - A, p - A) * N).sum(axis=1) / area
        candidates = [
            np.where(((s >= 0) & (t >= 0) & (s + t <= 1))[:, None],
                     np.column_stack([1 - s - t, s, t]), np.nan)
        ]
        for a, b in ((0, 1), (1, 2), (2, 0)):  # on the edges
            S, E = V[F[faces, a]], V[F[faces, b]] - V[F[faces, a]]
            u = np.clip(((p - S) * E).sum(axis=1) / np.maximum((E * E).sum(axis=1), 1e-300), 0, 1)
            on_edge = np.zeros((len(faces), 3))
            on_edge[:, a], on_edge[:, b] = 1 - u, u
            candidates.append(on_edge)
        where = np.stack(candidates)
        distance = np.linalg.norm(np.einsum("kfc,fcx->kfx", where, V[F[faces]]) - p, axis=2)
        k, f = np.unravel_index(np.nanargmin(distance), distance.shape)
        rows += [i] * 3
        columns += list(F[faces[f]])
        weights += list(where[k, f])
    return scipy.sparse.csr_matrix((weights, (rows, columns)), (len(points), len(V)))


class Judged:
    """A coarse mesh beside the fine one, both at unit area: its functional map C, the norms, and
    where on the mesh |C|_L comes from."""

    def __init__(self, ss, V, F, pairs, Vc, Fc, P=None, K=100, **operator):
        coefficients = ({"coefficients": operator["coarse_coefficients"]}
                        if "coarse_coefficients" in operator else {})
        P = closest_point_restriction(V, F, Vc) if P is None else P
        self.V, self.F = Vc, Fc
        self.numbers = ss.evaluate(V, F, Vc, Fc, P, K, eigenpairs=pairs, **operator)
        own = ss.eigenpairs(Vc, Fc, K, **coefficients)
        area, coarse_area = pairs.M.sum(), own.M.sum()
        self.C = own.vectors.T @ (own.M @ (P @ pairs.vectors[:, :K])) * np.sqrt(area / coarse_area)
        self.values, fine = own.values * coarse_area, pairs.values[:K] * area
        off = own.vectors @ (self.C * fine - self.values[:, None] * self.C) * np.sqrt(coarse_area)
        # Its mean square over the surface is the square of |C|_L.
        self.error = np.linalg.norm(off, axis=1) / np.linalg.norm(self.C)
        self.vectors = own.vectors

    def mode(self, k):
        """The coarse mode nearest to the fine mode k, from 1: equal ones may change places."""
        row = np.argmax(np.abs(self.C[:, k - 1]))
        return self.vectors[:, row] * np.sign(self.C[row, k - 1])

    def __str__(self):
        error = 100 * self.numbers.eigenvalue_error
        return f"‖C‖$_L$ {self.numbers.C_L:.1f}, eigenvalues {error:.1f} % off"
