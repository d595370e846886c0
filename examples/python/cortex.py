# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
#   cortex.py [--surface FILE --mask FILE] [--vertices 2000] [--modes 100] [--eigenvalues FILE]
#             [--other FILE ...] [--mass averaged] [--output FOLDER]
#
# Simplifies a cortex without its medial wall to 2,000 vertices. Says how well the small mesh, and
# operators fitted on it, keep the modes of the full surface in the mass that LaPy takes. Carries
# parcels and other surfaces of the subject to it, and draws a figure. Without --surface the cortex
# is a folded sphere with a hole, made here.

import argparse
import pathlib

import numpy as np

import spectral_simplification as ss


def folded_sphere(levels=4):
    """A sphere with folds, and a mask that leaves out a cap, as the medial wall."""
    g = (1 + 5**0.5) / 2
    V = np.array(
        [
            (-1, g, 0),
            (1, g, 0),
            (-1, -g, 0),
            (1, -g, 0),
            (0, -1, g),
            (0, 1, g),
            (0, -1, -g),
            (0, 1, -g),
            (g, 0, -1),
            (g, 0, 1),
            (-g, 0, -1),
            (-g, 0, 1),
        ]
    )
    F = np.array(
        [
            (0, 11, 5),
            (0, 5, 1),
            (0, 1, 7),
            (0, 7, 10),
            (0, 10, 11),
            (1, 5, 9),
            (5, 11, 4),
            (11, 10, 2),
            (10, 7, 6),
            (7, 1, 8),
            (3, 9, 4),
            (3, 4, 2),
            (3, 2, 6),
            (3, 6, 8),
            (3, 8, 9),
            (4, 9, 5),
            (2, 4, 11),
            (6, 2, 10),
            (8, 6, 7),
            (9, 8, 1),
        ]
    )
    for _ in range(levels):
        sides = np.sort(np.vstack([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1)
        edges, which = np.unique(sides, axis=0, return_inverse=True)
        a, b, c = len(V) + which.reshape(3, -1)
        V = np.vstack([V, V[edges].mean(axis=1)])
        F = np.vstack(
            [
                np.column_stack(t)
                for t in ((F[:, 0], a, c), (a, F[:, 1], b), (c, b, F[:, 2]), (a, b, c))
            ]
        )
    sphere = V / np.linalg.norm(V, axis=1)[:, None]
    x, y, z = sphere.T
    folds = 1 + 0.12 * np.sin(9 * x + 2 * np.sin(3 * y)) * np.cos(8 * z + y)
    return sphere * folds[:, None] * [70, 50, 45], F, sphere, x > -0.9


def errors(values, fine, k):
    """Relative errors of the eigenvalues up to k, without those that are zero."""
    return abs(values[fine.zeros : k] / fine.values[fine.zeros : k] - 1)


def compared(run, modes, first, mass="consistent"):
    """Eigenpairs of the surface in `mass`, and of the small mesh in `mass` and in the mass of the
    run, which errs less. Then the first eigenvalues, at the scale of the surface, of operators
    fitted to twice as many."""
    pairs = min(2 * first, len(run.V))
    fine = ss.eigenpairs(*run.part(), max(modes, pairs), mass)
    target = ss.Eigenpairs.from_arrays(
        fine.values[:pairs], fine.vectors[:, :pairs], fine.L, fine.M, mass
    )
    fitted = ss.fit_operators(run.V, run.F, run.P[:, run.used], target, first, mass="diagonal")
    values = fitted.values * (fitted.M.sum() / fine.M.sum())
    return fine, run.coarse_eigenpairs(modes, mass), run.coarse_eigenpairs(modes), values


def parcels(V, used, count=40):
    """Parcels of about one size: the nearest of points that are far from each other."""
    seeds = [int(used[0])]
    distance = np.linalg.norm(V - V[seeds[0]], axis=1)
    labels = np.zeros(len(V), int)
    for i in range(1, count):
        seeds.append(int(used[distance[used].argmax()]))
        nearer = np.linalg.norm(V - V[seeds[-1]], axis=1)
        labels[nearer < distance] = i
        distance = np.minimum(distance, nearer)
    return labels


def figure(path, run, fine, coarse, errors_by_k):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    aligned = ss.align(coarse, fine, run.P[:, run.used])
    surfaces = ((*run.part(), aligned.vectors), (run.V, run.F, coarse.vectors))
    picture = plt.figure(figsize=(13, 6))
    modes = [m for m in (2, 6, 20, 50) if m <= coarse.vectors.shape[1]]
    for row, (V, F, vectors) in enumerate(surfaces):
        for column, mode in enumerate(modes):
            axes = picture.add_subplot(
                2, len(modes) + 1, row * (len(modes) + 1) + column + 1, projection="3d"
            )
            value = vectors[:, mode - 1][F].mean(axis=1)  # counted from 1, as in the text
            drawn = axes.plot_trisurf(
                *V.T, triangles=F, cmap="RdBu", linewidth=0, antialiased=False
            )
            drawn.set_array(value)
            drawn.set_clim(-abs(value).max(), abs(value).max())
            axes.view_init(10, 180)
            axes.set_box_aspect(np.ptp(V, axis=0))
            axes.set_axis_off()
            axes.set_title(f"mode {mode}, {len(V)} vertices", fontsize=8)
    axes = picture.add_subplot(1, len(modes) + 1, len(modes) + 1)
    for k, e in errors_by_k.items():
        axes.semilogy(range(k - len(e) + 1, k + 1), 100 * e, label=f"K = {k}")
    axes.set_xlabel("mode")
    axes.set_title("error of the eigenvalue, %", fontsize=8)
    axes.legend()
    picture.savefig(path, dpi=130, bbox_inches="tight")
    plt.close(picture)


def main(arguments=None):
    parser = argparse.ArgumentParser(description="Simplifies a cortex and keeps its modes.")
    parser.add_argument(
        "--surface", help="GIFTI, VTK, or what read_mesh() takes; a folded sphere without"
    )
    parser.add_argument("--mask", help="what read_mask() takes: which vertices are cortex")
    parser.add_argument(
        "--eigenvalues", help="published eigenvalues of the masked surface to compare with, as text"
    )
    parser.add_argument(
        "--other", nargs="*", default=[], help="surfaces of the subject, such as the pial one"
    )
    parser.add_argument("--vertices", type=int, help="2000; of the folded sphere 600")
    parser.add_argument(
        "--modes", type=int, nargs="+", default=[100], help="K; several for one curve each"
    )
    parser.add_argument("--mass", default="averaged", help="of the run: averaged or consistent")
    parser.add_argument("--output", default=".")
    a = parser.parse_args(arguments)
    if a.surface is None and a.mask is not None:
        parser.error("--mask is that of a surface: give --surface as well.")
    out = pathlib.Path(a.output)
    target = a.vertices or (600 if a.surface is None else 2000)

    others = {}
    if a.surface is None:
        V, F, sphere, mask = folded_sphere()
        others["sphere"] = sphere, None
    else:
        V, F = ss.read_mesh(a.surface)
        mask = None if a.mask is None else ss.read_mask(a.mask, len(V))
    for name in a.other:
        positions, faces = ss.read_mesh(name)
        if not np.array_equal(faces, F):
            raise ValueError(
                f"{name} has other faces than the surface: take one of the same subject and mesh."
            )
        like = name if name.endswith(".gii") else None  # GIFTI says which structure it shows
        others[pathlib.Path(name).name] = positions, like  # lh.pial and lh.white have one stem
    out.mkdir(parents=True, exist_ok=True)  # before what takes long

    curves = {}
    for k in a.modes:
        run = ss.simplify(V, F, target, k, mass=a.mass, mask=mask)
        first = min(50, k)
        fine, coarse, own, fitted = compared(run, k, first)
        curves[k] = errors(own.values, fine, k)
        print(f"{len(run.used)} of {len(V)} vertices to {len(run.V)}, K = {k}")
        for name, values in (
            ("small mesh in the consistent mass", coarse.values),
            (f"small mesh in the {a.mass} mass", own.values),
            ("operators fitted on it", fitted),
        ):
            e = errors(values, fine, first)
            print(
                f"  first {first} eigenvalues, {name}: error {100 * e.mean():.2f} % in the mean, "
                f"{100 * e.max():.2f} % at most"
            )
    if a.eigenvalues:
        published = np.loadtxt(a.eigenvalues)
        n = min(len(published), len(fine))
        print(
            f"  published eigenvalues agree with the full surface within "
            f"{100 * errors(published, fine, n).max():.3f} %"
        )

    labels = parcels(V, run.used)
    carried = run.transfer_labels(labels, by="area")
    sizes, small = (
        np.bincount(of, np.asarray(pairs.M.sum(axis=1)).ravel() / pairs.M.sum(), minlength=40)
        for of, pairs in ((labels[run.used], fine), (carried, own))
    )
    print(
        f"  {len(np.unique(carried))} of 40 parcels carried, their areas off by "
        f"{100 * abs(small - sizes).max():.2f} % of all at most"
    )
    for name, (positions, like) in others.items():
        known = name.endswith((".gii", ".off", ".obj", ".ply", ".stl", ".vtk", ".vtp"))
        place = out / f"cortex_{name}{'' if known else '.off'}"  # lh.pial has no ending of a format
        ss.write_mesh(place, run.apply(positions).V, run.F, like)
    ss.write_mesh(out / "cortex.off", run.V, run.F)
    run.save(out / "cortex.npz")
    try:
        figure(out / "cortex.png", run, fine, own, curves)
    except ImportError:
        print("  no figure: Matplotlib is not installed")
    return run, curves


if __name__ == "__main__":
    try:
        main()
    except (ValueError, OSError) as error:
        raise SystemExit(f"cortex.py: {error}") from None
