# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# What a user sees of the compiled module: each function hands its arguments to the one of the
# same name there.

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Sequence
from typing import Any

import numpy
import scipy.sparse

from . import _core
from ._meshes import used_part, without_debris
from ._results import (
    Eigenpairs,
    Evaluation,
    Fitted_operators,
    Match,
    Progress,
    Simplification,
    _array,
    _diagonal,
    _flag,
    _rectangular,
)


def _renumbered(sentence: str, used: numpy.ndarray, faces: int | None) -> str:
    """Names vertices by their numbers in V, not among those that were used; `faces`: how many were,
    where these are not all."""

    def of_all(found):
        number = int(found[2])
        return f"{found[1]}{used[number] if number < len(used) else number}"

    sentence = re.sub(r"\b(vertex |vertices )(\d+)", of_all, sentence)
    sentence = re.sub(r"\b(vertices \d+ and )(\d+)", of_all, sentence)
    if faces is not None and re.search(r"\bface \d", sentence):
        sentence += f" Faces are counted among the {faces} that take part."
    return sentence


def _features(keep) -> tuple[list[str], list | None]:
    """The words of keep, and what else it holds."""
    if isinstance(keep, str):
        return keep.split(","), None
    if isinstance(keep, (list, tuple)) and any(
        isinstance(part, (str, numpy.ndarray)) for part in keep
    ):
        words = [word for part in keep if isinstance(part, str) for word in part.split(",")]
        others = [
            numpy.atleast_1d(_rectangular("keep", part))
            for part in keep
            if not isinstance(part, str)
        ]
        return words, others or None
    return [], None if keep is None else [_rectangular("keep", keep)]


def simplify(
    V: numpy.ndarray,
    F: numpy.ndarray,
    n: int,
    k: int | None = None,
    preset: str = 'best',
    *,
    mass: str | None = None,
    placement: str | None = None,
    shape: float | None = None,
    self_intersections: str | None = None,
    relocate: str | None = None,
    prefer: str | None = None,
    keep: str | Sequence | numpy.ndarray | None = None,
    mask: numpy.ndarray | None = None,
    drop_debris: float | None = None,
    binary: bool = False,
    preserve_border: bool = False,
    signals: numpy.ndarray | None = None,
    eigenpairs: Eigenpairs | None = None,
    quadrics_above: float | None = None,
    pre_simplify: int | None = None,
    max_error: float | None = None,
    fit_operators: bool = False,
    coefficients: numpy.ndarray | None = None,
    boundary: str = 'neumann',
    intrinsic_delaunay: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Simplification:
    """Simplifies a triangle mesh and keeps the first k eigenvalues and eigenvectors of its
    Laplacian.

    Parameters
    ----------
    V : array
        (v, 3) real numbers, positions in any unit of length
    F : array
        (f, 3) integers, the corners of the triangles, counted from 0: an oriented manifold, with or
        without border. Vertices without a face are left out, but P, Q and vertex_map still number
        the vertices as V does
    n : int
        number of vertices of the result; below the advised 3 k there is a warning
    k : int, optional
        number of eigenvectors to keep, the constant one included; below v. By default 100, or the
        number of columns of signals
    preset : str
        'best' keeps the spectrum best; 'fast' is the same with pre_simplify at 15 n, at least
        10000, and filtered noise in place of eigenvectors; 'paper' is the method of Lescoat et al.
        (Spectral Mesh Simplification, 2020). The next five parameters, quadrics_above and
        pre_simplify override it
    mass : str, optional
        mass matrix: 'lumped' (paper); 'averaged' (best), the mean of lumped and consistent, which
        keeps eigenvalues of coarse meshes much closer; 'voronoi', lumped by mixed Voronoi areas;
        'consistent', for finite elements such as LaPy's
    placement : str, optional
        'on_edge' (paper), 'midpoint' or 'free' (best): where the vertex goes that replaces an edge
    shape : float, optional
        weight of the shape term in the cost (best: 3, paper: 0)
    self_intersections : str, optional
        'allow' (paper) or 'refuse' (best) collapses that put a face through another
    relocate : str, optional
        'none' (paper), 'sampled' (best), 'carried' or 'carried_and_sampled': how vertices are moved
        afterwards. With 'sampled' P interpolates at closest points and does not follow vertex_map
    prefer : str, optional
        'spectrum', the default, or 'shape': relocation brings the surfaces nearer to each other.
        The Hausdorff distance is a fifth smaller, errors of the spectrum are a tenth larger
    keep : str, sequence of int or bool, or list of both, optional
        vertices of V that keep their positions: indices, each once, or booleans; 'border';
        'sharp:ANGLE', ends of edges whose two face normals are ANGLE degrees apart or more, and
        corners of the border. vertex_map has their new indices
    mask : array of bool, optional
        (v,), True or 1 for the vertices of V that take part, such as a cortex without its medial
        wall. A face takes part if all its corners do. P, Q and vertex_map still number the
        vertices as V does; columns of P are empty elsewhere
    drop_debris : float, optional
        leaves out components of less than this share of the area, in (0, 1); report['left_out'] has
        the first vertex of each. Otherwise many crumbs can reduce the body to a tetrahedron
    binary : bool
        P of ones and zeros, it picks vertices of V. Not with relocate='sampled'
    preserve_border : bool
        no collapse draws a vertex off the border
    signals : array, optional
        (v, s) real numbers, functions to keep instead of eigenvectors
    eigenpairs : Eigenpairs, optional
        what eigenpairs(V, F, k, mass) returned, to save the solve; the first k are used
    quadrics_above : float, optional
        while there are more than this many times n vertices, collapse edges by quadrics alone:
        much faster, and as good (best and fast: 7, paper: infinity, never). Levels above that are
        those of quadrics
    pre_simplify : int, optional
        first reduce a larger mesh to this number of vertices by quadrics alone; 0: do not. None:
        as the preset
    max_error : float, optional
        stop before the relative error sqrt(E / sum lambda^2) exceeds this; 0.1 keeps the spectrum
        closely, 0.14 well
    fit_operators : bool
        afterwards fit a Laplacian and a mass matrix of the simplified mesh to the spectrum of V, F;
        the result has them as fitted. This takes another solve, for a fifth more eigenpairs,
        unless eigenpairs are given
    coefficients : array, optional
        (v, 7), for an operator whose spectrum is kept in place of the Laplacian's,
        -div(D grad phi) = lambda rho phi: rho, and D as xx, xy, xz, yy, yz, zz; see
        weighted_coefficients() and curvature_coefficients(). The result has those of its mesh
    intrinsic_delaunay : bool
        for a mesh of needles: keep eigenvectors of its intrinsic Delaunay triangulation
    boundary : str
        boundary condition: 'neumann' (zero normal derivative) or 'dirichlet' (zero value)
    threads : int, optional
        for eigenpairs and relocation, all cores by default and at most; the result does not depend
        on it
    progress : function, optional
        called with a phase and the fraction of it that is done, at most twenty times a second. If
        it returns False, Cancelled is raised. Ctrl-C raises KeyboardInterrupt even without it

    Returns
    -------
    Simplification
        V, F, P, Q, vertex_map, collapses, eigenpairs, report, levels(n), and methods that carry
        functions.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    Cancelled
        If progress returns False.

    Notes
    -----
    Nothing is repaired, and V and F are not changed: ValueError and TypeError name the first
    fault. A UserWarning tells of what is done but not advised, and of a run that ends above n.

    Examples
    --------
    A square, whose second eigenvalue is pi^2:

    >>> import numpy, scipy.spatial
    >>> x, y = map(numpy.ravel, numpy.mgrid[0:1:30j, 0:1:30j])
    >>> V = numpy.column_stack([x, y, 0 * x])
    >>> F = scipy.spatial.Delaunay(V[:, :2]).simplices
    >>> run = simplify(V, F, 200, k=20)
    >>> run.V.shape, run.P.shape
    ((200, 3), (200, 900))
    >>> abs(run.coarse_eigenpairs(2).values[1] / numpy.pi**2 - 1) < 0.005
    True
    >>> abs(run.Q @ (run.P @ y) - y).max() < 0.01  # carried there and back
    True
    """
    values = dict(locals())
    if k is None and signals is None:
        values["k"] = 100
    used = None
    fine_V, fine_F = _core.arrays(dict(V=V, F=F))
    all_faces = len(fine_F)
    part = used_part(fine_V, fine_F, mask)
    left_out = numpy.empty(0, numpy.int64)
    if drop_debris is not None:
        part, left_out = without_debris(fine_V, fine_F, part, drop_debris)
    values["features"], keep = _features(keep)
    if keep is not None:
        named = [_core.kept(dict(keep=part, v=len(fine_V))) for part in keep]
        values["keep"] = keep = numpy.unique(numpy.concatenate(named))
    else:
        values["keep"] = None
    if part is not None:
        used, fine_F, values["F"] = part
        values["V"] = fine_V[used]
        for name in "signals", "coefficients":
            if values[name] is not None:
                given = _array(name, values[name])
                of_all = given.shape[:1] == (len(fine_V),)
                values[name] = given[used] if of_all else given
        if keep is not None:
            out = ~numpy.isin(keep, used)
            if out.any():
                raise ValueError(
                    f"keep names the vertex {keep[out][0]}, which no face uses that is left: "
                    "leave it out."
                )
            values["keep"] = numpy.searchsorted(used, keep)
    faces = len(fine_F) if len(fine_F) < all_faces else None
    try:
        core = _core.simplify(values)
    except ValueError as error:
        if used is None:
            raise
        said = _renumbered(str(error), used, faces)
        if mask is not None and "touch in a single vertex" in said:
            said += " If it is the mask that parts them, leave the vertex out by it, too."
        raise type(error)(said) from None
    report = core["report"]
    if used is not None:
        report["warnings"] = [_renumbered(w, used, faces) for w in report["warnings"]]
    for said in [*report["warnings"], report["explanation"]]:
        if said:
            warnings.warn(said, stacklevel=2)
    pairs = (
        eigenpairs
        if eigenpairs is not None
        else core["eigenpairs"] and Eigenpairs(core["eigenpairs"])
    )
    report["left_out"] = left_out.tolist()
    kept = core["vertex_map"][core["kept"]]
    asked = dict(
        boundary=boundary,
        intrinsic_delaunay=intrinsic_delaunay,
        coefficients=values["coefficients"],
        kept=numpy.asarray(kept, numpy.int64),
        prefer=prefer,
        pairs=None,
    )
    return Simplification._of(
        core,
        numpy.array(fine_V, float),
        numpy.array(fine_F, numpy.int64),
        used,
        eigenpairs=pairs,
        coefficients=core["coefficients"],
        fitted=core["fitted"] and Fitted_operators(core["fitted"]),
        report=report,
        collapses=core["collapses"],
        _asked=asked,
    )


def eigenpairs(
    V: numpy.ndarray,
    F: numpy.ndarray,
    k: int = 100,
    mass: str = 'averaged',
    *,
    tolerance: float = 1e-10,
    coefficients: numpy.ndarray | None = None,
    boundary: str = 'neumann',
    intrinsic_delaunay: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Eigenpairs:
    """The first k eigenpairs of a mesh, L phi = lambda M phi, at the scale of V: eigenvalues have
    the unit of an inverse area.

    Parameters
    ----------
    V, F : array
        as in simplify(), but faces need not form a manifold
    k : int
        from 1 to v
    mass : str
        'lumped', 'averaged', 'consistent', as LaPy takes it, or 'voronoi'
    tolerance : float
        bound on the residuals, the norm of L phi - lambda M phi (in M^-1, lumped) over
        lambda + 4 pi / area. If it is not reached there is a warning. A run of simplify() computes
        its pairs with 1e-8
    coefficients, boundary, intrinsic_delaunay, threads, progress : array, optional
        as in simplify()

    Returns
    -------
    Eigenpairs
        values, vectors, L, M.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    Cancelled
        If progress returns False.
    """
    return Eigenpairs(_core.eigenpairs(locals()))


def eigsh(
    L: scipy.sparse.spmatrix,
    M: scipy.sparse.spmatrix | None = None,
    k: int = 6,
    *,
    tolerance: float = 1e-10,
    threads: int | None = None,
    progress: Progress | None = None,
) -> tuple[numpy.ndarray, numpy.ndarray]:
    """The k smallest eigenvalues of any pencil, L u = w M u, and their eigenvectors. Replaces
    scipy.sparse.linalg.eigsh(L, k, M, sigma=0 or below).

    Parameters
    ----------
    L : (n, n) sparse matrix
        Symmetric, positive semidefinite, in any unit.
    M : (n, n) sparse matrix or (n,) array, optional
        Symmetric, positive definite, with positive row sums: a mass matrix, or its diagonal. None:
        the identity.
    k : int
        From 1 to n.
    tolerance : float
        Of the residuals, relative to the size of the eigenvalues. Matrices that are rounded, to
        float32 for instance, need a larger one.
    threads : int, optional
        All cores by default; the result does not depend on it.
    progress : function, optional
        As in simplify().

    Returns
    -------
    w : (k,) array
        Ascending.
    U : (n, k) array
        U^T M U = 1.

    Raises
    ------
    ValueError
        If a matrix is not symmetric, L has a negative eigenvalue, or M has a row without positive
        sum, in one sentence.
    RuntimeError
        If the tolerance is not reached.

    Examples
    --------
    >>> from scipy.sparse import diags
    >>> ends = [1.0] + 98 * [2.0] + [1.0]
    >>> L = diags([ends, 99 * [-1.0], 99 * [-1.0]], [0, 1, -1]).tocsr()
    >>> w, U = eigsh(L, k=3)
    >>> print((w / w[1]).round(2))
    [0. 1. 4.]
    """
    if scipy.sparse.issparse(L) and 0 in L.shape:
        raise ValueError(f"L has the shape {L.shape}, it must have a row: pass a larger matrix.")
    if not scipy.sparse.issparse(L) or len(L.shape) != 2:
        raise _core.Wrong_type(
            f"L is of the type {type(L).__name__}, it must be a sparse matrix: pass "
            "scipy.sparse.csr_matrix(L)."
        )
    if isinstance(M, (int, numpy.integer)):
        raise _core.Wrong_type("M is a number, it must be a sparse matrix: call eigsh(L, M, k).")
    M = _diagonal(scipy.sparse.identity(L.shape[0], format="csr") if M is None else M)
    pairs = _core.eigsh(locals())
    return numpy.array(pairs.values), numpy.array(pairs.vectors)


def evaluate(
    V: numpy.ndarray,
    F: numpy.ndarray,
    Vc: numpy.ndarray,
    Fc: numpy.ndarray,
    P: scipy.sparse.csr_matrix,
    k: int | None = None,
    mass: str = 'averaged',
    *,
    eigenpairs: Eigenpairs | None = None,
    operators: Fitted_operators | None = None,
    coefficients: numpy.ndarray | None = None,
    coarse_coefficients: numpy.ndarray | None = None,
    boundary: str = 'neumann',
    intrinsic_delaunay: bool = False,
    scale: str = 'unit',
    threads: int | None = None,
    progress: Progress | None = None,
) -> Evaluation:
    """Measures how well a coarse mesh, from any source, keeps the first k eigenpairs of a fine one.
    Figures are for unit area unless scale says otherwise; compare figures of the same mass only.

    Parameters
    ----------
    V, F : array
        the fine mesh
    Vc, Fc : array
        the coarse mesh
    P : csr_matrix
        (vc, v) sparse matrix that carries functions from fine to coarse, rows that sum to 1. After
        mask= V, F are those of run.part(), and P is run.P[:, run.used]
    k : int, optional
        modes to judge: as many as eigenpairs has, or 100
    mass : str
        'lumped', 'averaged', 'consistent' or 'voronoi', of both operators
    eigenpairs : Eigenpairs, optional
        of the fine mesh in that mass, k or more, to save the solve
    operators : Fitted_operators, optional
        what fit_operators() returned, in the place of the coarse mesh's own operators
    coefficients : array, optional
        of the operator, (v, 7), as in simplify()
    coarse_coefficients : array, optional
        those of the coarse mesh, (vc, 7), coefficients of a Simplification; P @ coefficients
        where None
    scale : str
        'unit': both meshes at unit area; 'mesh': as they are. Then a mesh that has shrunk has
        larger eigenvalues, and C_L and values have the unit of an inverse area
    boundary, intrinsic_delaunay, threads, progress : str
        as in simplify()

    Returns
    -------
    Evaluation
        C, C_L, C_D, span_loss, eigenvalue_error.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    Cancelled
        If progress returns False.
    """
    if k is None:
        k = numpy.size(getattr(eigenpairs, "values", ())) or 100
    return Evaluation._from_state(_core.evaluate(locals()))


def rows_off_their_part(
    V: numpy.ndarray,
    F: numpy.ndarray,
    Vc: numpy.ndarray,
    Fc: numpy.ndarray,
    P: scipy.sparse.csr_matrix,
) -> numpy.ndarray:
    """Finds rows of P that read functions from another part of the shape than the rows of their
    neighbours do, such as an arm from the flank beside it. A good P has none.

    Parameters
    ----------
    V, F : array
        the fine mesh
    Vc, Fc : array
        the coarse mesh
    P : csr_matrix
        (vc, v) sparse matrix that carries functions from fine to coarse, rows that sum to 1

    Returns
    -------
    (r,) int64 array
        Indices of rows, ascending.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    """
    return _core.rows_off_their_part(locals())


def fit_operators(
    Vc: numpy.ndarray,
    Fc: numpy.ndarray,
    P: scipy.sparse.csr_matrix,
    eigenpairs: Eigenpairs,
    k: int | None = None,
    mass: str | None = None,
    rings: int | None = None,
    *,
    low_modes: float = 2.5,
    orthonormality: float = 0.01,
    whole_residual: float = 0.2,
    coefficients: numpy.ndarray | None = None,
    progress: Progress | None = None,
) -> Fitted_operators:
    """Fits the entries of a Laplacian and a mass matrix on a coarse mesh to the eigenpairs of the
    fine mesh. The operators are for functional maps and spectral distances, not for geometry.

    Parameters
    ----------
    Vc, Fc : array
        the coarse mesh
    P : csr_matrix
        (vc, v) sparse matrix from fine to coarse
    eigenpairs : Eigenpairs
        of the fine mesh, a fifth more than are to be judged
    k : int, optional
        how many eigenpairs of the fitted operators are computed; as many as eigenpairs are
    mass : str, optional
        'diagonal' (lumped mass) or 'edges' (averaged mass): where M has entries
    rings : int, optional
        where L has entries: 1, the edges, or 2, two rings, the default
    low_modes : float
        e: mode k has the weight (lambda_k + 4 pi)^-e; more is for distances, less for C_L
    orthonormality : float
        weight of orthonormality; more lowers C_D and raises C_L
    whole_residual : float
        weight of the whole residual; more keeps the modes beyond k
    coefficients : array, optional
        (vc, 7), of the coarse mesh: coefficients of a Simplification; where eigenpairs have such
    progress : function, optional
        as in simplify()

    Returns
    -------
    Fitted_operators
        L, M and their eigenpairs.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    Cancelled
        If progress returns False.
    """
    return Fitted_operators(_core.fit_operators(locals()))


def weighted_coefficients(
    density: numpy.ndarray | None = None, conductivity: numpy.ndarray | None = None
) -> numpy.ndarray:
    """The coefficients of -div(c grad phi) = lambda rho phi, for simplify() and others.

    Parameters
    ----------
    density : (v,) array, optional
        rho at each vertex, positive; 1 where None
    conductivity : (v,) array, optional
        c at each vertex, positive; 1 where None

    Returns
    -------
    (v, 7) array
        Density, xx, xy, xz, yy, yz, zz, in the units of both.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    """
    return _core.weighted_coefficients(locals())


def curvature_coefficients(V: numpy.ndarray, F: numpy.ndarray, anisotropy: float) -> numpy.ndarray:
    """The coefficients of an anisotropic Laplacian (Andreux et al. 2014), for simplify() and
    others. In the direction of a principal curvature kappa the conductivity is
    1 / (1 + anisotropy |kappa|); kappa is 1 on the sphere of the same area.

    Parameters
    ----------
    V, F : array
        as in simplify(), but faces need not form a manifold
    anisotropy : float
        from 0, the Laplacian itself

    Returns
    -------
    (v, 7) array
        Without a unit: a density, and the tensor xx, xy, xz, yy, yz, zz.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    """
    return _core.curvature_coefficients(locals())


def functional_map(
    eigenpairs: Eigenpairs, coarse_eigenpairs: Eigenpairs, P: scipy.sparse.csr_matrix
) -> numpy.ndarray:
    """The functional map C, coarse modes x fine modes: it takes fine coefficients x of a function
    to the coarse ones, C x. C = Uc^T Mc P U, with vectors Uc and mass Mc of coarse_eigenpairs and
    vectors U of eigenpairs, at the scale of the meshes; evaluate() gives C at unit area.

    Parameters
    ----------
    eigenpairs : Eigenpairs
        of the fine mesh
    coarse_eigenpairs : Eigenpairs
        of the coarse mesh
    P : csr_matrix
        (vc, v), from fine to coarse

    Returns
    -------
    (k_coarse, k) array

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    """
    return _core.functional_map(locals())


def distances(
    eigenpairs: Eigenpairs,
    sources: int | Sequence[int] | scipy.sparse.spmatrix,
    kind: str = 'biharmonic',
    *,
    time: float | None = None,
    energies: tuple | None = None,
    squared: bool | None = None,
) -> numpy.ndarray:
    """Spectral distances from sources to all vertices: (v,) for one source, (v, s) for s of them.

    Parameters
    ----------
    eigenpairs : Eigenpairs
        of the mesh
    sources : int, sequence of int or sparse matrix
        a vertex, a sequence of vertices, or points: a sparse interpolation (s, v), such as
        run.Q[fine vertices]
    kind : str
        'diffusion', 'biharmonic' or 'commute_time', or 'wave_kernel'
    time : float, optional
        for 'diffusion', in the unit of area; None: 1 / (4 lambda_2), where lambda_2 is the first
        nonzero eigenvalue
    energies : tuple, optional
        of 'wave_kernel', (t_min, t_max, sigma, steps); wave_kernel_energies(eigenpairs)
    squared : bool, optional
        False: return distances; otherwise the first three kinds are squared distances

    Returns
    -------
    (v,) or (v, s) array

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.

    Notes
    -----
    To compare two meshes pass the time or the energies of one of them for both.
    """
    squared = None if squared is None else _flag("squared", squared)
    if squared and kind == "wave_kernel":
        raise ValueError(
            "squared is True, but the distance 'wave_kernel' is no root: leave it out."
        )
    result = _core.distances(locals())
    if squared is False and kind != "wave_kernel":
        numpy.sqrt(result, out=result)
    return result


def heat_kernel_signature(
    eigenpairs: Eigenpairs, times: Sequence[float] | None = None
) -> numpy.ndarray:
    """The heat kernel signature of each vertex.

    Parameters
    ----------
    eigenpairs : Eigenpairs
        of the mesh
    times : sequence of float, optional
        in the unit of area; 100 of constant ratio where None

    Returns
    -------
    (v, t) array
        One column for each time.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    """
    return _core.heat_kernel_signature(locals())


def wave_kernel_signature(eigenpairs: Eigenpairs, energies: tuple | None = None) -> numpy.ndarray:
    """The wave kernel signature of each vertex (Aubry et al. 2011).

    Parameters
    ----------
    eigenpairs : Eigenpairs
        of the mesh
    energies : tuple, optional
        (t_min, t_max, sigma, steps); wave_kernel_energies(eigenpairs) where None

    Returns
    -------
    (v, steps) array
        One column for each energy.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    """
    return _core.wave_kernel_signature(locals())


def wave_kernel_energies(eigenpairs: Eigenpairs, steps: int = 100) -> tuple:
    """Energies, logarithms of eigenvalues, as Aubry et al. 2011 choose them.

    Parameters
    ----------
    eigenpairs : Eigenpairs
        of the mesh
    steps : int
        how many

    Returns
    -------
    (t_min, t_max, sigma, steps) : tuple

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    """
    return _core.wave_kernel_energies(locals())


def match(
    VX: numpy.ndarray,
    FX: numpy.ndarray,
    VY: numpy.ndarray,
    FY: numpy.ndarray,
    n: int = 600,
    k: int = 100,
    *,
    mass: str = 'averaged',
    landmarks: numpy.ndarray | None = None,
    proxy: str = 'spectral',
    operators: str = 'fitted',
    initial: int = 20,
    matcher: str = 'product_manifold_filter',
    filter_iterations: int = 5,
    fine_iterations: int = 18,
    local_weight: float = 4,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Match:
    """Finds the vertex of Y that corresponds to each vertex of X, as the program shape_matching
    does. It matches simplified meshes, by a functional map from signatures, ZoomOut and the
    Product Manifold Filter or BCICP.

    Parameters
    ----------
    VX, FX, VY, FY : array
        two meshes, nearly isometric, as in simplify()
    n : int
        vertices of the simplified meshes, 3 k or more
    k : int
        eigenvectors of all meshes, from 10 to n
    mass : str
        'lumped', 'averaged', 'consistent' or 'voronoi'
    landmarks : array, optional
        (l, 2) integers, pairs of vertices of X and Y that are known to correspond
    proxy : str
        'spectral', 'garland_heckbert' or 'none': how the meshes are simplified
    operators : str
        operators of the simplified meshes: 'fitted' to the spectra of X and Y, or 'mesh', their own
    initial : int
        modes of the functional map from signatures, from 4 to 60
    matcher : str
        'product_manifold_filter' or 'bcicp' (Ren et al. 2018): what makes the map between the
        simplified meshes bijective
    filter_iterations : int
        iterations of the matcher; 0: none
    fine_iterations : int
        iterations that bend X onto Y in space, at the end; 0: none
    local_weight : float
        weight of curvature in these iterations, from 0 to 100
    threads : int, optional
        all cores by default; the result does not depend on it
    progress : function, optional
        as in simplify(); the fraction counts three stages

    Returns
    -------
    Match
        map, C.

    Raises
    ------
    ValueError, TypeError
        If the input is invalid; one sentence names the first fault.
    Cancelled
        If progress returns False.
    """
    return Match._from_state(_core.match(locals()))
