# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Maps between meshes, whoever found them.
#
# A functional map C takes functions on a source to functions on a target, modes of the target x
# modes of the source. A point map says for each vertex of the target which vertex of the source
# it is.

from __future__ import annotations

import numpy
import scipy.sparse

from . import _core
from ._results import (
    Alignment,
    Eigenpairs,
    Level,
    Progress,
    _array,
    _check_entries,
    _integer,
    _shown,
)


def _pairs(name: str, value) -> Eigenpairs:
    if not isinstance(value, Eigenpairs):
        raise _core.Wrong_type(
            f"{name} is of the type {type(value).__name__}, it must be Eigenpairs: pass what "
            "eigenpairs() or "
            "Eigenpairs.from_arrays() returns."
        )
    return value


def _run(name: str, value) -> Level:
    if not isinstance(value, Level):
        raise _core.Wrong_type(
            f"{name} is of the type {type(value).__name__}, it must be a Simplification or a "
            "Level: pass what simplify() or apply() returns."
        )
    return value


def _modes(name: str, C, target: Eigenpairs, source: Eigenpairs) -> numpy.ndarray:
    C = _array(name, C.toarray() if scipy.sparse.issparse(C) else C)
    if C.ndim != 2 or not 0 < C.shape[0] <= len(target) or not 0 < C.shape[1] <= len(source):
        raise ValueError(
            f"{name} has the shape {C.shape}, it must be modes of the target x modes of the "
            "source, at most "
            f"({len(target)}, {len(source)})."
        )
    if not numpy.isfinite(C).all():
        row, column = numpy.argwhere(~numpy.isfinite(C))[0]
        raise ValueError(f"{name}[{row}, {column}] is not a finite number: correct the map.")
    return C


def _point_map(name: str, T, target: int, source: int) -> numpy.ndarray:
    T = _array(name, T, "iu")
    if T.shape != (target,):
        raise ValueError(
            f"{name} has the shape {T.shape}, it must be ({target},), for each vertex of the "
            "target one of the source."
        )
    if T.min(initial=0) < 0 or T.max(initial=0) >= source:
        bad = int(((T < 0) | (T >= source)).argmax())
        raise ValueError(
            f"{name}[{bad}] is {T[bad]}, but the source has {source} vertices: they are "
            "counted from 0."
        )
    return T


def functional_map_of_point_map(
    T: numpy.ndarray, source: Eigenpairs, target: Eigenpairs
) -> numpy.ndarray:
    """The functional map of a point map, at the scale of the meshes.

    Parameters
    ----------
    T : (target vertices,) integers
        For each vertex of the target one of the source.
    source, target : Eigenpairs
        Of both meshes.

    Returns
    -------
    (k_target, k_source) array
        Without a unit where the areas agree.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    """
    source, target = _pairs("source", source), _pairs("target", target)
    T = _point_map("T", T, len(target.vectors), len(source.vectors))
    return target.vectors.T @ (target.M @ source.vectors[T])


def point_map(
    C: numpy.ndarray, source: Eigenpairs, target: Eigenpairs, threads: int | None = None
) -> numpy.ndarray:
    """The point map of a functional map: for each vertex of the target the one of the source
    whose image is nearest.

    Parameters
    ----------
    C : (k_target, k_source) array
        At most as many modes as the eigenpairs have.
    source, target : Eigenpairs
        Of both meshes, which have the same area, about.
    threads : int, optional
        All cores by default.

    Returns
    -------
    (target vertices,) int64
        Vertices of the source.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    """
    C = _modes("C", C, _pairs("target", target), _pairs("source", source))
    return _core.point_map(locals())


def zoom_out(
    C: numpy.ndarray,
    source: Eigenpairs,
    target: Eigenpairs,
    k: int | None = None,
    step: int = 1,
    threads: int | None = None,
    *,
    progress: Progress | None = None,
) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Refines a functional map by ZoomOut (Melzi et al. 2019): to a point map and back, with more
    modes each time.

    Parameters
    ----------
    C : (k0, k0) array
        A map of a few modes, square.
    source, target : Eigenpairs
        Of both meshes.
    k : int, optional
        Modes at the end; as many as both have.
    step : int
        Modes added in each step, which searches all vertices of both meshes: 10 takes a tenth of
        the time of 1, and errs as much.
    threads : int, optional
        All cores by default.
    progress : function, optional
        As in simplify(), with the phase 'zoom_out'; called between the steps.

    Returns
    -------
    C : (k, k) array
        The refined map.
    T : (target vertices,) int64
        The point map of it.

    Raises
    ------
    Cancelled
        If progress returns False.
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    """
    C = _modes("C", C, _pairs("target", target), _pairs("source", source))
    most = min(len(source), len(target))
    k = most if k is None else k
    if C.shape[0] != C.shape[1]:
        raise ValueError(
            f"C has the shape {C.shape}, it must be square: pass as many modes of both."
        )
    k = _integer("k", k, len(C), most, ", the modes of C and those of both eigenpairs")
    step = _integer("step", step, 1)
    if not (progress is None or callable(progress)):
        raise _core.Wrong_type(
            f"progress is {_shown(progress)}, it must be None or a function of a phase and a "
            "fraction."
        )
    first = len(C)
    phi, image = source.vectors, target.M @ target.vectors
    T = point_map(C, source, target, threads)
    while len(C) < k:
        if progress is not None:
            answer = progress("zoom_out", (len(C) - first) / (k - first))
            if answer is not None and not answer:
                raise _core.Cancelled("The progress callback returned False. Nothing is returned.")
        n = min(len(C) + step, k)
        C = image[:, :n].T @ phi[T, :n]
        T = point_map(C, source, target, threads)
    return C, T


def lift_functional_map(
    C: numpy.ndarray,
    source: Level,
    target: Level,
    source_eigenpairs: Eigenpairs,
    target_eigenpairs: Eigenpairs,
    tolerance: float = 0.05,
) -> numpy.ndarray:
    """Lifts a functional map between two simplified meshes, found by any method, to the meshes they
    were made from (Lescoat et al., section 5.2).

    Parameters
    ----------
    C : (k_target, k_source) array
        Between the simplified meshes, in the eigenpairs that are given.
    source, target : Level
        What simplify() or apply() returned for both.
    source_eigenpairs, target_eigenpairs : Eigenpairs
        Of the simplified meshes, such as run.coarse_eigenpairs().
    tolerance : float
        Singular values below this fraction of the largest are cut off; from 0, below 1.

    Returns
    -------
    (fine modes of target, fine modes of source) array
        In run.fine_eigenpairs of both, at the scale of the meshes.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    """
    C = _modes(
        "C",
        C,
        _pairs("target_eigenpairs", target_eigenpairs),
        _pairs("source_eigenpairs", source_eigenpairs),
    )
    down = []
    for run, pairs, modes in (
        (_run("source", source), source_eigenpairs, C.shape[1]),
        (_run("target", target), target_eigenpairs, C.shape[0]),
    ):
        if len(pairs.vectors) != len(run.V):
            raise ValueError(
                f"eigenpairs of {len(pairs.vectors)} vertices were given for a mesh of "
                f"{len(run.V)}: pass "
                "run.coarse_eigenpairs()."
            )
        fine = run.fine_eigenpairs
        k = min(len(fine), modes)
        down.append(pairs.vectors[:, :modes].T @ (pairs.M @ (run._part_P() @ fine.vectors[:, :k])))
    return _core.lift_functional_map(
        dict(source_restriction=down[0], coarse=C, target_restriction=down[1], tolerance=tolerance)
    )["C"]


def lift_point_map(
    T: numpy.ndarray,
    source: Level,
    target: Level,
    k: int | None = None,
    threads: int | None = None,
) -> numpy.ndarray:
    """Lifts a point map between two simplified meshes, found by any method, to the meshes they
    were made from, by way of its functional map.

    Parameters
    ----------
    T : (vertices of target.V,) integers
        For each the vertex of source.V.
    source, target : Level
        What simplify(), apply() or load() returned for both.
    k : int, optional
        How many modes; as many as both runs kept. Time grows with both inputs' vertices and k.
    threads : int, optional
        All cores by default.

    Returns
    -------
    (u,) int64
        For each vertex of the target's input that was used one of the source's.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    """
    runs = _run("source", source), _run("target", target)
    most = min(min(run.report["eigenvectors"], len(run.V)) for run in runs)
    k = _integer("k", most if k is None else k, 1, most, ", what both runs kept")
    pairs = source.coarse_eigenpairs(k), target.coarse_eigenpairs(k)
    # Where the last mode is exchanged with the next its singular value is small, and what it says
    # is noise: cut off at 0.05 it moved a map by half an edge.
    C = lift_functional_map(functional_map_of_point_map(T, *pairs), source, target, *pairs, 0.2)
    return source.used[point_map(C, source.fine_eigenpairs, target.fine_eigenpairs, threads)]


def _share_edges(A: scipy.sparse.spmatrix, B: scipy.sparse.spmatrix) -> bool:
    """Whether nearly all entries of one stand in the other as well. Two runs on a mesh that is
    numbered by rows share up to three quarters; intrinsic Delaunay flips leave nine tenths."""
    patterns = []
    for matrix in A, B:
        pattern = scipy.sparse.csr_matrix(matrix, dtype=float, copy=True)
        pattern.sum_duplicates()
        pattern.eliminate_zeros()
        pattern.data[:] = 1
        patterns.append(pattern)
    common = patterns[0].multiply(patterns[1]).nnz
    return common >= 0.85 * min(pattern.nnz for pattern in patterns)


def align(
    first: Eigenpairs,
    second: Eigenpairs,
    T: numpy.ndarray | scipy.sparse.spmatrix | None = None,
    mixing: float = 0.3,
) -> Alignment:
    """Aligns the eigenvectors of a mesh with those of another, by signs and by rotations within
    clusters.

    A cluster is a smallest set of consecutive modes that do not mix with the modes below and above
    them, as far as the map between the meshes tells.

    Parameters
    ----------
    first, second : Eigenpairs
        Of two meshes.
    T : (vertices of first,) integers or sparse matrix, optional
        For each vertex of the first the one of the second, or an interpolation (first x second).
        None: both have the same connectivity, as poses that share it.
    mixing : float
        Largest part of a mode that may lie on the other side of a cut between clusters; from 0
        to 1.

    Returns
    -------
    Alignment
        vectors, rotation, clusters; of as many modes as both have.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.

    Examples
    --------
    Vectors of the opposite sign are flipped:

    >>> import numpy
    >>> from scipy.sparse import diags, identity
    >>> from spectral_simplification import Eigenpairs, eigsh
    >>> L, M = diags([numpy.arange(9.0)], [0]).tocsr(), identity(9, format="csr")
    >>> w, U = eigsh(L, M, 3)
    >>> first, second = (Eigenpairs.from_arrays(w, U * sign, L, M) for sign in (1, [1, -1, 1]))
    >>> align(first, second).rotation.round(9) + 0
    array([[ 1.,  0.,  0.],
           [ 0., -1.,  0.],
           [ 0.,  0.,  1.]])
    """
    first, second = _pairs("first", first), _pairs("second", second)
    if _array("mixing", mixing).ndim != 0 or not 0 <= mixing <= 1:
        raise ValueError(f"mixing is {_shown(mixing)}, it must be a number from 0 to 1.")
    n, m = len(first.vectors), len(second.vectors)
    k = min(len(first), len(second))
    phi = second.vectors[:, :k]
    if T is None:
        if n != m:
            raise ValueError(
                f"first has {n} vertices and second {m}: pass T, which says where they correspond."
            )
        if not _share_edges(first.L, second.L):
            raise ValueError(
                "first and second have as many vertices, but other edges: pass T, which says where "
                "they correspond, such as X.P @ Y.Q of two runs on poses."
            )
        moved = phi
    elif scipy.sparse.issparse(T):
        if T.shape != (n, m):
            raise ValueError(
                f"T has the shape {T.shape}, it must be ({n}, {m}), vertices of first x second."
            )
        _check_entries("T", T)
        moved = T @ phi
    else:
        moved = phi[_point_map("T", T, n, m)]
    C = first.vectors[:, :k].T @ (first.M @ moved)
    C /= numpy.maximum(numpy.linalg.norm(C, axis=0), 1e-300)
    # What goes across the cut before mode i, from below and from above.
    squares = C**2
    cuts = [0]
    for i in range(1, k):
        across = max(squares[i:, cuts[-1] : i].sum(axis=0).max(), squares[:i, i:].sum(axis=0).max())
        if across <= mixing**2:
            cuts.append(i)
    cuts.append(k)
    clusters = [(int(a), int(b)) for a, b in zip(cuts[:-1], cuts[1:])]
    rotation = numpy.zeros((k, k))
    for a, b in clusters:
        U, _, W = numpy.linalg.svd(C[a:b, a:b])
        rotation[a:b, a:b] = (U @ W).T
    return Alignment._from_state(dict(vectors=phi @ rotation, rotation=rotation, clusters=clusters))
