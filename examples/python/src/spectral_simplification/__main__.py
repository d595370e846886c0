# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# python3 -m spectral_simplification IN OUT --vertices N: most words of the
# program spectral_simplify, a mask, and files of more formats.

from __future__ import annotations

import argparse
import contextlib
import json
import math
import os
import pathlib
import sys
import warnings
from typing import Any

import numpy
import scipy.io

from . import __version__, clean, evaluate, read_mask, simplify, write_mesh
from ._interface import _features
from ._meshes import _check_ending, _numbers, _read_mesh
from ._results import _check_folder, _written


class _Parser(argparse.ArgumentParser):
    def error(self, message: str):  # 1, as of every other error and of the program
        self.exit(1, f"error: {message}; --help shows every option.\n")


def _arguments() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="python3 -m spectral_simplification",
        allow_abbrev=False,
        description="Simplifies a triangle mesh and keeps the eigenvalues and eigenvectors of "
        "its Laplace-Beltrami operator as well as it "
        "can. IN and OUT are files of meshes, see read_mesh().",
        epilog="Exit status: 0 on success; 1 on error, with no file written; 130 if interrupted.",
    )
    add = parser.add_argument
    add("IN")
    add("OUT")
    add(
        "--vertices",
        metavar="N|P%",
        required=True,
        help="how many vertices OUT has, such as 600 or 3%%",
    )
    add(
        "--eigenvectors",
        metavar="K",
        type=int,
        help="how many to keep, the constant one included (100)",
    )
    add("--preset", choices=["best", "fast", "paper"], default="best")
    add("--mass", choices=["lumped", "averaged", "voronoi", "consistent"])
    add("--placement", choices=["on_edge", "midpoint", "free"])
    add("--shape", metavar="G", type=float, help="weight of the shape term in the cost")
    add("--self-intersections", choices=["allow", "refuse"])
    add("--relocate", choices=["none", "sampled", "carried", "carried_and_sampled"])
    add("--prefer", choices=["spectrum", "shape"])
    add(
        "--quadrics-above",
        metavar="R",
        type=float,
        help="above R N vertices collapse by quadrics alone",
    )
    add(
        "--pre-simplify",
        metavar="N0",
        type=int,
        help="first reduce to this number by quadrics alone",
    )
    add("--max-error", metavar="E", type=float, help="stop before the relative error exceeds this")
    add("--boundary", choices=["neumann", "dirichlet"], default="neumann")
    add("--intrinsic-delaunay", action="store_true")
    add("--signals", metavar="F.npy", help="preserve these functions instead of eigenvectors")
    add(
        "--keep",
        metavar="LIST",
        help="vertices that stay where they are, separated by commas: border, sharp:ANGLE, "
        "or a file of one index per line, from 0",
    )
    add("--binary", action="store_true", help="a restriction of ones and zeros")
    add("--preserve-border", action="store_true")
    add("--repair", action="store_true", help="make IN an oriented manifold of triangles")
    add(
        "--drop-debris",
        metavar="S%",
        help="leave out components of less than this share of the area, such as 0.1%%",
    )
    add("--restriction", metavar="P.mtx", help="the matrix that carries functions to OUT")
    add("--prolongation", metavar="Q.mtx", help="the matrix that carries them back")
    add(
        "--map",
        metavar="FILE",
        help="for each vertex of IN the one of OUT it went to; -1: left out",
    )
    add("--json", metavar="FILE", help="the figures of the run")
    add("--threads", metavar="T", type=int)
    judged = parser.add_mutually_exclusive_group().add_argument
    judged(
        "--no-evaluation",
        action="store_true",
        help="do not compute how well the spectrum was kept; with fast the default above 20000 "
        "vertices, unless --json shows it",
    )
    judged("--evaluation", action="store_true", help="compute it in any case")
    add("--quiet", action="store_true", help="no figures, no warnings")
    add(
        "--mask",
        metavar="FILE",
        help="vertices that take part: 0 or 1 for each vertex of IN (text, .npy, .gii) or a .label",
    )
    add("--save", metavar="FILE.npz", help="the whole result, for load()")
    add("--version", action="version", version=__version__)
    return parser


def _number(word: str, n: int) -> int:
    try:
        return max(1, round(float(word[:-1]) * n / 100)) if word.endswith("%") else int(word)
    except (ValueError, OverflowError):
        raise ValueError(
            f"--vertices is {word}, it must be a number such as 600 or a percentage such as 3%."
        ) from None


def _share(word: str | None) -> float | None:
    if word is None:
        return None
    try:
        share = float(word[:-1]) / 100 if word.endswith("%") else 0
    except ValueError:
        share = 0
    if not 0 < share < 1:
        raise ValueError(
            f"--drop-debris is {word}, it must be a percentage above 0 and below 100, such as 0.1%."
        )
    return share


def _kept(words: str | None) -> list | None:
    if words is None:
        return None
    return [
        word
        if word in ("", "border", "sharp") or word.startswith("sharp:")
        else _numbers(word, int)
        for word in words.split(",")
    ]


def _finite(value: Any) -> Any:
    """For JSON, which has no NaN: null."""
    if isinstance(value, dict):
        return {key: _finite(part) for key, part in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _write_matrix(path: str, matrix: Any) -> None:
    with open(path, "wb") as file:  # to the name of a file SciPy adds .mtx
        scipy.io.mmwrite(file, matrix)


def _check_places(read: list[str | None], written: list[str | None]) -> None:
    """Before the work, as the program does: no file is lost by another name for it."""
    taken = {os.path.realpath(path) for path in read if path}
    for path in written:
        if path is None:
            continue
        _check_folder(path)
        if not os.path.basename(path):
            raise ValueError(f"{path!r} names no file: give a name.")
        if os.path.realpath(path) in taken:
            raise ValueError(f"{path} is read or written already: give another name.")
        taken.add(os.path.realpath(path))


def _run(a: argparse.Namespace) -> None:
    _check_ending(pathlib.Path(a.OUT))
    read = [a.mask, a.signals, *(a.keep or "").split(",")]
    _check_places(read, [a.OUT])  # which may be IN
    _check_places(read + [a.IN, a.OUT], [a.restriction, a.prolongation, a.map, a.json, a.save])
    keep = _kept(a.keep)
    own = a.IN.lower().endswith((".off", ".obj", ".ply", ".stl"))
    if a.repair and own and (a.restriction or a.prolongation or a.map):
        raise ValueError(
            "--repair renumbers vertices, and --restriction, --prolongation and --map number those "
            "of IN: repair first."
        )
    changes: list[str] = []
    V, F = _read_mesh(a.IN, a.repair and own, changes)
    cleaned = None
    if a.mask is None and _features(keep)[1] is None and a.signals is None:
        cleaned = clean(V, F, a.repair and not own)
    elif a.repair:
        raise ValueError(
            "--repair renumbers vertices, and --mask, --keep and --signals number those of IN: "
            "repair first."
        )
    options = {
        name: getattr(a, name)
        for name in (
            "preset",
            "mass",
            "placement",
            "shape",
            "self_intersections",
            "relocate",
            "prefer",
            "quadrics_above",
            "pre_simplify",
            "max_error",
            "boundary",
            "intrinsic_delaunay",
            "binary",
            "preserve_border",
            "threads",
        )
    }
    options.update(
        k=a.eigenvectors,
        keep=keep,
        drop_debris=_share(a.drop_debris),
        signals=None if a.signals is None else _numbers(a.signals, float),
    )
    if a.mask is not None:
        options["mask"] = read_mask(a.mask, len(V))
    given = (V, F) if cleaned is None else (cleaned.V, cleaned.F)
    run = simplify(*given, _number(a.vertices, len(given[0])), **options)
    changes += [] if cleaned is None else cleaned.changes
    if changes and not a.quiet:
        print(f"{a.IN}: {', '.join(changes)}.", file=sys.stderr)
    if cleaned is not None and cleaned.changes:
        is_one_to_one = len(numpy.unique(cleaned.origin)) == len(cleaned.origin)
        if is_one_to_one or a.restriction or a.prolongation or a.map or a.save:
            run = run._renumbered(V, cleaned.place, cleaned.origin)
    report = dict(run.report)
    left_out = a.preset == "fast" and len(given[0]) > 20000 and not (a.evaluation or a.json)
    if left_out and not (a.no_evaluation or a.quiet):
        print("fast does not judge more than 20000 vertices: add --evaluation for that")
    if not (a.no_evaluation or left_out):
        k = min(report["eigenvectors"], len(run.V))
        e = evaluate(
            *run.part(),
            run.V,
            run.F,
            run._part_P(),
            k,
            report["mass"],
            boundary=a.boundary,
            intrinsic_delaunay=a.intrinsic_delaunay,
            threads=a.threads,
        )
        report.update(
            norm_L=e.C_L,
            norm_D=e.C_D,
            span_loss=e.span_loss,
            eigenvalue_error_mean=e.eigenvalue_error,
            eigenvalue_error_max=e.eigenvalue_error_max,
            eigenvalue_error_low_mean=e.eigenvalue_error_low,
            area_ratio=e.area_ratio,
        )
        if not a.quiet:
            print(
                f"{len(run.used)} to {len(run.V)} vertices, at unit area in the mass "
                f"{report['mass']}: |C|_L {e.C_L:.3f}, |C|_D {e.C_D:.3f}, eigenvalue error "
                f"{100 * e.eigenvalue_error:.2f} %"
            )
    both_gifti = all(file.lower().endswith(".gii") for file in (a.IN, a.OUT))
    like = a.IN if both_gifti else None
    # All are written beside their places first, and those that enter last get theirs first.
    with contextlib.ExitStack() as places:
        for path, write in (
            (a.OUT, lambda f: write_mesh(f, run.V, run.F, like)),
            (a.save, run.save),
            (
                a.json,
                lambda f: pathlib.Path(f).write_text(json.dumps(_finite(report), indent=2) + "\n"),
            ),
            (a.map, lambda f: numpy.savetxt(f, run.vertex_map, "%d")),
            (a.prolongation, lambda f: _write_matrix(f, run.Q)),
            (a.restriction, lambda f: _write_matrix(f, run.P)),
        ):
            if path is not None:
                write(places.enter_context(_written(path)))


def main() -> int:
    a = _arguments().parse_args()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore" if a.quiet else "once", UserWarning)
            warnings.showwarning = lambda message, *_: print(f"warning: {message}", file=sys.stderr)
            _run(a)
    except (ValueError, OSError, RuntimeError) as error:
        said = str(error).replace("repair=True", "--repair")  # as this command has it
        print(f"error: {said}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
