# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   beside_scipy.py [--vertices 32000 100000] [--modes 50] [--threads T] [FILE ...]
#
# Compares time and eigenvalues of eigsh() with those of SciPy's, called as LaPy does: shift-invert
# at -0.01, consistent mass, with SuperLU and, if scikit-sparse is installed, with CHOLMOD. Meshes
# are files, or sheets with hills made here.

import argparse
import time

import numpy as np
import scipy.sparse.linalg

import spectral_simplification as ss


def sheet(side):
    x, y = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side), indexing="ij")
    V = np.column_stack([x.ravel(), y.ravel(), 0.2 * np.sin(5 * x.ravel()) * np.cos(4 * y.ravel())])
    v = np.arange(side * side).reshape(side, side)
    a, b, c, d = v[:-1, :-1].ravel(), v[1:, :-1].ravel(), v[1:, 1:].ravel(), v[:-1, 1:].ravel()
    return 100 * V, np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def superlu(L, M, k):
    factor = scipy.sparse.linalg.splu((L + 0.01 * M).tocsc())
    inverse = scipy.sparse.linalg.LinearOperator(L.shape, factor.solve, dtype=float)
    return scipy.sparse.linalg.eigsh(L, k, M, sigma=-0.01, OPinv=inverse)


def cholmod(L, M, k):
    from sksparse.cholmod import cholesky

    factor = cholesky((L + 0.01 * M).tocsc())
    inverse = scipy.sparse.linalg.LinearOperator(L.shape, factor, dtype=float)
    return scipy.sparse.linalg.eigsh(L, k, M, sigma=-0.01, OPinv=inverse)


def compared(V, F, k, threads):
    """Rows of a solver's name, its seconds, and how far its eigenvalues are from those of
    eigsh()."""
    few = ss.eigenpairs(V, F, 1, "consistent")
    L, M = few.L.tocsc(), few.M.tocsc()
    rows = []
    for name, solver in (
        ("eigsh()", lambda *a: ss.eigsh(*a, threads=threads)),
        ("SciPy, SuperLU", superlu),
        ("SciPy, CHOLMOD", cholmod),
    ):
        try:
            begin = time.perf_counter()
            values, _ = solver(L, M, k)
            seconds = time.perf_counter() - begin
        except ImportError:
            continue
        if not rows:
            own = values
        rows.append((name, seconds, abs(values[1:] / own[1:] - 1).max()))
    return rows


def main(arguments=None):
    parser = argparse.ArgumentParser(description="Eigenpairs beside SciPy's.")
    parser.add_argument("files", nargs="*")
    parser.add_argument("--vertices", type=int, nargs="+", default=[32000, 100000])
    parser.add_argument("--modes", type=int, default=50)
    parser.add_argument("--threads", type=int)
    a = parser.parse_args(arguments)
    meshes = [ss.read_mesh(f) for f in a.files] or [sheet(round(n**0.5)) for n in a.vertices]
    for V, F in meshes:
        rows = compared(V, F, a.modes, a.threads)
        for name, seconds, difference in rows:
            print(
                f"{len(V)} vertices, {a.modes} pairs: {name:15} {seconds:6.2f} s, "
                f"{seconds / rows[0][1]:5.1f} times eigsh(), eigenvalues agree within "
                f"{difference:.0e}"
            )


if __name__ == "__main__":
    main()
