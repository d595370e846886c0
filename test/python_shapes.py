# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Shapes for the tests of the Python module.

import numpy as np


def sphere(levels):
    """A subdivided icosahedron with bumps and three different axes, 10 * 4^levels + 2 vertices."""
    g = (1 + 5 ** 0.5) / 2
    V = np.array([(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g),
                  (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)])
    F = np.array([(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
                  (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
                  (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)])
    for _ in range(levels):
        sides = np.sort(np.vstack([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1)
        edges, which = np.unique(sides, axis=0, return_inverse=True)
        a, b, c = (len(V) + which.reshape(3, -1)).astype(F.dtype)
        V = np.vstack([V, V[edges].mean(axis=1)])
        corners = (F[:, 0], a, c), (a, F[:, 1], b), (c, b, F[:, 2]), (a, b, c)
        F = np.vstack([np.column_stack(t) for t in corners])
    V /= np.linalg.norm(V, axis=1)[:, None]
    x, y, z = V.T
    bumps = 1 + 0.2 * np.sin(3 * x + 0.5) * np.cos(4 * y + 0.8) + 0.1 * np.sin(2 * z + x)
    return V * bumps[:, None] * [2, 1.3, 0.8], F


def sheet(side):
    """A square with hills, side^2 vertices, with a border."""
    x, y = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side), indexing="ij")
    V = np.column_stack([x.ravel(), y.ravel(), 0.2 * np.sin(5 * x.ravel()) * np.cos(4 * y.ravel())])
    v = np.arange(side * side).reshape(side, side)
    a, b, c, d = v[:-1, :-1].ravel(), v[1:, :-1].ravel(), v[1:, 1:].ravel(), v[:-1, 1:].ravel()
    return V, np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
