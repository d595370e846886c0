# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# What the functions return. Everything is an array, a sparse matrix or a plain value, so that
# results can be copied, pickled and stored.

from __future__ import annotations

import contextlib
import json
import operator
import os
import uuid
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy
import scipy.sparse

from . import _core

Progress = Callable[[str, float], bool | None]

_KINDS: dict[str, type] = {}  # of results, by name


def _rectangular(name: str, value: Any) -> numpy.ndarray:
    """An array of anything, or the sentence that says why it is none."""
    if numpy.ma.is_masked(value):
        raise ValueError(f"{name} has masked entries: fill them, or leave them out.")
    try:
        return numpy.asarray(value)
    except ValueError:
        raise _core.Wrong_type(f"{name} is not an array: give each row the same length.") from None


def _array(name: str, value: Any, kinds: str = "fiu") -> numpy.ndarray:
    """An array of numbers of these kinds, or the sentence that says why it is none."""
    array = _rectangular(name, value)
    if array.dtype.kind not in kinds:
        raise _core.Wrong_type(
            f"{name} has the dtype {array.dtype}, it must hold "
            + ("real numbers: pass float64." if "f" in kinds else "integers: pass int64.")
        )
    return array.astype(float) if "f" in kinds else array


def _check_entries(name: str, matrix: Any) -> None:
    """Refuses a sparse matrix that has other entries than finite real numbers."""
    if matrix.dtype.kind not in "fiu":
        raise _core.Wrong_type(
            f"{name} has the dtype {matrix.dtype}, it must hold real numbers: pass float64."
        )
    entries = matrix.tocoo()
    bad = ~numpy.isfinite(entries.data)
    if bad.any():
        i = int(bad.argmax())
        raise ValueError(f"{name}[{entries.row[i]}, {entries.col[i]}] is not a finite number.")


def _shown(value: Any) -> str:
    """A value in a sentence of one line."""
    text = repr(value)
    is_short = len(text) <= 80 and "\n" not in text
    return text if is_short else f"of the type {type(value).__name__}"


def _word(name: str, value: Any, words: Sequence[str]) -> str:
    """One of the words, or the sentence that says which they are."""
    if isinstance(value, str) and value in words:
        return value
    kind = ValueError if isinstance(value, str) else _core.Wrong_type
    listed = ", ".join(map(repr, words[:-1]))
    raise kind(f"{name} is {_shown(value)}, it must be {listed} or {words[-1]!r}.")


def _diagonal(matrix: Any) -> Any:
    """A matrix as it is, or the one that has this vector on its diagonal."""
    if isinstance(matrix, numpy.ndarray) and matrix.ndim == 1 and matrix.dtype.kind in "fiu":
        return scipy.sparse.diags(matrix.astype(float)).tocsr()
    return matrix


def _flag(name: str, value: Any) -> bool:
    """True or False, of Python or of NumPy."""
    if not isinstance(value, (bool, numpy.bool_)):
        raise _core.Wrong_type(f"{name} is {_shown(value)}, it must be True or False.")
    return bool(value)


def _integer(name: str, value: Any, least: int, most: int | None = None, why: str = "") -> int:
    """An integer in the range, or the sentence that says why it is none."""
    try:
        number = operator.index(None if isinstance(value, bool) else value)
    except TypeError:
        raise _core.Wrong_type(f"{name} is {_shown(value)}, it must be an integer.") from None
    if number < least or most is not None and number > most:
        to = "" if most is None else f" to {most}"
        raise ValueError(f"{name} is {number}, it must be from {least}{to}{why}.")
    return number


def _path(value: Any) -> str:
    """A path as text, or the sentence that says why it is none."""
    if not isinstance(value, (str, os.PathLike)):
        raise _core.Wrong_type(
            f"path is of the type {type(value).__name__}, it must be the name of a file."
        )
    path = os.fspath(value)
    if not path:
        raise ValueError("path is empty, it must be the name of a file.")
    return path


def _check_folder(path: str) -> None:
    folder = os.path.dirname(path)
    if folder and not os.path.isdir(folder):
        raise FileNotFoundError(f"{folder} is no folder: make it, or write {path} elsewhere.")
    if os.path.isdir(path):
        raise ValueError(f"{path} is a folder: give the name of a file.")
    if os.path.exists(path) and not os.path.isfile(path):  # a device would be replaced
        raise ValueError(f"{path} is no ordinary file: give the name of one.")


@contextlib.contextmanager
def _written(path: str) -> Iterator[str]:
    """A name to write to, so that the file is there wholly or not at all, whoever else writes it
    at the same time. A link stays one."""
    _check_folder(path)
    suffix = os.path.splitext(path)[1]  # which says the format
    path = os.path.realpath(path)
    part = os.path.join(os.path.dirname(path), f".{uuid.uuid4().hex}{suffix}")
    try:
        yield part
        os.replace(part, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(part)
        raise


class _Result:
    """What can be copied, pickled and stored: _state() says what a result is made of,
    _from_state() makes it again."""

    def __init_subclass__(cls) -> None:
        _KINDS[cls.__name__] = cls

    def _state(self) -> dict[str, Any]:
        return dict(vars(self))

    @classmethod
    def _from_state(cls, state: dict[str, Any]):
        result = cls.__new__(cls)
        vars(result).update(state)
        return result

    def __reduce__(self):
        return _restored, (type(self).__name__, self._state())

    def save(self, path: Any) -> None:
        """Writes the result for `load()`; the file appears complete or not at all.

        Parameters
        ----------
        path : str or path
            Of the file, an .npz of NumPy's: arrays, and no pickled objects.

        Raises
        ------
        FileNotFoundError
            If its folder does not exist.
        """
        path = _path(path)
        _check_folder(path)  # before the work
        arrays: dict[str, numpy.ndarray] = {}
        text = json.dumps(_packed(self, "r", arrays))
        with _written(path) as part, open(part, "wb") as file:
            numpy.savez_compressed(file, spectral_simplification=numpy.array(text), **arrays)


def _packed(value: Any, name: str, arrays: dict[str, numpy.ndarray]) -> Any:
    if isinstance(value, _Result):
        return {"is": type(value).__name__, "of": _packed(value._state(), name, arrays)}
    if isinstance(value, dict):
        return {
            "is": "dict",
            "of": {key: _packed(v, f"{name}.{key}", arrays) for key, v in value.items()},
        }
    if isinstance(value, (list, tuple)):
        return {
            "is": type(value).__name__,
            "of": [_packed(v, f"{name}.{i}", arrays) for i, v in enumerate(value)],
        }
    if scipy.sparse.issparse(value):
        m = value.tocsr()
        for part in "data", "indices", "indptr":
            arrays[f"{name}.{part}"] = getattr(m, part)
        return {"is": "csr", "of": list(m.shape), "in": name}
    if isinstance(value, numpy.ndarray):
        arrays[name] = value
        return {"is": "array", "in": name}
    if isinstance(value, numpy.generic):
        return value.item()
    return value


def _unpacked(value: Any, arrays: Any) -> Any:
    if not isinstance(value, dict):
        return value
    kind, of = value["is"], value.get("of")
    if kind == "csr":
        data, indices, indptr = (
            arrays[f"{value['in']}.{part}"] for part in ("data", "indices", "indptr")
        )
        matrix = scipy.sparse.csr_matrix((data, indices, indptr), tuple(of))
        matrix.check_format()  # an index beyond its shape would end the process
        return matrix
    if kind == "array":
        return arrays[value["in"]]
    if kind == "dict":
        return {key: _unpacked(v, arrays) for key, v in of.items()}
    if kind in ("list", "tuple"):
        items = [_unpacked(v, arrays) for v in of]
        return items if kind == "list" else tuple(items)
    return _restored(kind, _unpacked(of, arrays))


def _restored(kind: str, state: dict[str, Any]) -> Any:
    return _KINDS[kind]._from_state(state)


def load(path: Any) -> Any:
    """Reads what `save()` of a result has written.

    Parameters
    ----------
    path : str or path
        Of the file.

    Returns
    -------
    Simplification, Level, Eigenpairs, Fitted_operators or another result
        As it was saved.

    Raises
    ------
    ValueError
        If the file was written by something else.
    FileNotFoundError
        If there is no such file.
    """
    return _read(path, _unpacked)


def _noted(path: Any, name: str) -> Any:
    """What a result that was saved has by this name, without its arrays; None if nothing."""
    return _read(path, lambda state, _: state["of"]["of"].get(name))


def _read(path: Any, function: Callable[[Any, Any], Any]) -> Any:
    """What a function makes of a file that save() has written."""
    path = _path(path)
    if not os.path.exists(path):
        raise FileNotFoundError(f"{path} does not exist.")
    try:
        with numpy.load(path, allow_pickle=False) as arrays:
            state = json.loads(str(arrays["spectral_simplification"]))
            if not isinstance(state, dict) or state["is"] not in _KINDS:
                raise ValueError
            return function(state, arrays)
    except (PermissionError, MemoryError):
        raise
    except Exception:  # a damaged archive raises what zipfile, zlib and NumPy raise
        raise ValueError(
            f"{path} holds no result of spectral_simplification, or is damaged: give a file that "
            "save() has written."
        ) from None


def _frozen(array: numpy.ndarray) -> numpy.ndarray:
    array.setflags(write=False)
    return array


class Eigenpairs(_Result):
    """Eigenpairs of a mesh, at its scale, or of any pencil. Arrays are views and cannot be
    written."""

    def __init__(self, _core_pairs: Any):
        self._core = _core_pairs
        self._matrices: dict[str, Any] = {}

    @property
    def values(self) -> numpy.ndarray:
        """(k,) eigenvalues, ascending, in the inverse of a unit of area."""
        return self._core.values

    @property
    def vectors(self) -> numpy.ndarray:
        """(v, k) eigenvectors, vectors^T M vectors = 1."""
        return self._core.vectors

    @property
    def residuals(self) -> numpy.ndarray:
        """(k,) relative residuals."""
        return self._core.residuals

    def _matrix(self, name: str) -> scipy.sparse.csr_matrix:
        if name not in self._matrices:
            self._matrices[name] = getattr(self._core, name)
        return self._matrices[name].copy()

    @property
    def L(self) -> scipy.sparse.csr_matrix:
        """(v, v) cotangent Laplacian, positive semidefinite; a copy each time."""
        return self._matrix("L")

    @property
    def M(self) -> scipy.sparse.csr_matrix:
        """(v, v) mass, in units of area; a copy each time. M.diagonal() is all of a lumped one,
        as networks take it."""
        return self._matrix("M")

    @property
    def mass(self) -> str:
        """'lumped', 'averaged', 'consistent' or 'voronoi'; 'diagonal' or 'edges' where fitted;
        'given' without a mesh."""
        return self._core.mass

    @property
    def further_values(self) -> numpy.ndarray:
        """Some of the next eigenvalues, to a thousandth, which the solver has at no extra cost."""
        return self._core.further_values

    @property
    def zeros(self) -> int:
        """How many eigenvalues are zero: one per component; 'dirichlet': per closed component."""
        return self._core.zeros

    @property
    def complete(self) -> bool:
        """Whether none can be missing."""
        return self._core.complete

    @property
    def solver(self) -> str:
        """Which one was used."""
        return self._core.solver

    @classmethod
    def from_arrays(
        cls,
        values: numpy.ndarray,
        vectors: numpy.ndarray,
        L: scipy.sparse.spmatrix,
        M: scipy.sparse.spmatrix,
        mass: str | None = None,
    ) -> Eigenpairs:
        """Eigenpairs that another solver found, of LaPy or SciPy for instance, for `simplify()`
        and others.

        Parameters
        ----------
        values : (k,) array
            Eigenvalues, ascending.
        vectors : (v, k) array
            Eigenvectors, vectors^T M vectors = 1.
        L, M : (v, v) sparse matrices
            Stiffness, positive semidefinite, and mass.
        mass : str, optional
            'lumped', 'averaged', 'consistent' or 'voronoi'. None: what the diagonal of M says,
            'lumped' for a diagonal one.

        Returns
        -------
        Eigenpairs
            Of the mass 'given' where M is none of these.

        Raises
        ------
        ValueError
            If these are not the first eigenpairs of L and M, as far as that can be seen.
        """
        if mass is not None:
            mass = _word("mass", mass, ("lumped", "averaged", "consistent", "voronoi", "given"))
        w, U = _array("values", values), _array("vectors", vectors)
        for name, array in ("values", w), ("vectors", U):
            bad = numpy.argwhere(~numpy.isfinite(array))
            if len(bad):
                place = ", ".join(map(str, bad[0]))
                raise ValueError(f"{name}[{place}] is not a finite number.")
        M = _diagonal(M)
        for name, matrix in ("L", L), ("M", M):
            if not scipy.sparse.issparse(matrix):
                raise _core.Wrong_type(
                    f"{name} is of the type {type(matrix).__name__}, it must be a sparse "
                    "matrix: pass "
                    f"scipy.sparse.csr_matrix({name})."
                )
        if w.ndim != 1 or U.ndim != 2 or U.shape[1] != len(w) or len(w) == 0:
            raise ValueError(
                f"values and vectors have the shapes {w.shape} and {U.shape}, they must be "
                "(k,) and (v, k)."
            )
        for name, matrix in ("L", L), ("M", M):
            if matrix.shape != (len(U), len(U)):
                raise ValueError(
                    f"{name} has the shape {matrix.shape}, it must be ({len(U)}, {len(U)}), as "
                    "vectors has rows."
                )
            _check_entries(name, matrix)
        falls = numpy.diff(w) < -1e-8 * abs(w).max()
        if falls.any():
            raise ValueError(
                f"values are not ascending at {int(falls.argmax()) + 1}: sort them, and the "
                "columns of vectors alike."
            )
        MU = M @ U
        off = abs(U.T @ MU - numpy.eye(len(w))).max()
        if off > 1e-5:
            raise ValueError(
                f"vectors are not orthonormal in M, by {off:.1e}: scale them so that vectors^T "
                "M vectors = 1."
            )
        row_masses = numpy.asarray(M.sum(axis=1)).ravel()
        if not (row_masses > 0).all():
            raise ValueError(
                f"the sum of row {int(numpy.argmin(row_masses > 0))} of M is not positive: pass a "
                "mass matrix."
            )
        difference = L @ U - MU * w
        unit = 4 * numpy.pi / row_masses.sum()
        residuals = numpy.sqrt((difference**2 / row_masses[:, None]).sum(axis=0)) / (
            abs(w) + unit
        )
        if residuals.max() > 1e-3:
            worst = int(residuals.argmax())
            raise ValueError(
                f"values[{worst}] and vectors[:, {worst}] are no eigenpair of L and M, the "
                "residual is "
                f"{residuals[worst]:.1e}: check that L is positive semidefinite, and that all "
                "belong together."
            )
        share = numpy.median(1 - M.diagonal() / row_masses)
        theta = (
            0.0
            if abs(share) < 1e-6
            else 1.0
            if abs(share - 0.5) < 1e-6
            else 0.5
            if abs(share - 0.25) < 1e-6
            else None
        )
        if mass is None:
            mass = (
                {0.0: "lumped", 0.5: "averaged", 1.0: "consistent"}.get(theta, "given")
                if theta is not None
                else "given"
            )
        elif (
            mass != "given"
            and theta != {"lumped": 0.0, "voronoi": 0.0, "averaged": 0.5, "consistent": 1.0}[mass]
        ):
            raise ValueError(f"mass is {mass!r}, but M is another one: leave it out.")
        result = cls._from_state(
            dict(
                values=numpy.maximum(w, 0),
                vectors=U,
                residuals=residuals,
                further_values=numpy.empty(0),
                L=L,
                M=M,
                row_masses=row_masses,
                theta=theta or 0.0,
                mass=mass,
                boundary="neumann",
                vanishing=0,
                has_coefficients=False,
                zeros=None,
                complete=False,
                solver="given",
            )
        )
        # Zeros of other solvers are rounded.
        missing = result.values[: result.zeros] > 1e-6 * max(unit, w.max())
        if missing.any():
            raise ValueError(
                f"values[{int(missing.argmax())}] is {w[missing.argmax()]:.6g}, but L has the "
                f"eigenvalue zero {result.zeros} times: give the eigenpairs from the first on."
            )
        return result

    def _state(self) -> dict[str, Any]:
        names = (
            "values",
            "vectors",
            "residuals",
            "further_values",
            "L",
            "M",
            "row_masses",
            "theta",
            "mass",
            "boundary",
            "vanishing",
            "has_coefficients",
            "zeros",
            "complete",
            "solver",
        )
        return {name: getattr(self._core, name) for name in names}

    @classmethod
    def _from_state(cls, state: dict[str, Any]):
        return cls(_core.pairs_of_arrays({"fit": None, **state}))

    def __len__(self) -> int:
        return len(self.values)

    def _size(self) -> str:
        return f"{len(self)} of {len(self.vectors)} vertices, {self.mass} mass>"

    def __repr__(self) -> str:
        return "<Eigenpairs: " + self._size()


class Fitted_operators(Eigenpairs):
    """Operators that were fitted, L and M, and their eigenpairs; mass is 'diagonal' or 'edges'."""

    _FIT = "objective_before", "objective_after", "iterations", "converged", "unknowns", "at_bound"

    @property
    def objective_before(self) -> float:
        """What was minimised, for the mesh's own entries."""
        return self._core.objective_before

    @property
    def objective_after(self) -> float:
        """What was minimised, for these entries."""
        return self._core.objective_after

    @property
    def iterations(self) -> int:
        """Iterations of the barrier method."""
        return self._core.iterations

    @property
    def converged(self) -> bool:
        """False if the fit was stopped; its operators are valid even then."""
        return self._core.converged

    @property
    def unknowns(self) -> int:
        """How many weights were chosen."""
        return self._core.unknowns

    @property
    def at_bound(self) -> int:
        """How many weights are at their bounds."""
        return self._core.at_bound

    def _state(self) -> dict[str, Any]:
        return {**super()._state(), "fit": tuple(getattr(self, name) for name in self._FIT)}

    def __repr__(self) -> str:
        return "<Fitted_operators: " + self._size()


def _vertex_areas(V: numpy.ndarray, F: numpy.ndarray) -> numpy.ndarray:
    """A third of the area of the faces at each vertex."""
    sides = V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]
    areas = numpy.linalg.norm(numpy.cross(*sides), axis=1) / 6
    return numpy.bincount(F.ravel(), numpy.repeat(areas, 3), len(V))


class Level(_Result):
    """A simplified mesh.

    Attributes
    ----------
    V : (n, 3) float64
        Positions.
    F : (m, 3) int32
        Triangles.
    P : (n, v) csr_matrix
        Carries functions of the input to this mesh: P @ f. Rows sum to 1; columns of vertices
        that no face uses, or that a mask leaves out, are empty.
    vertex_map : (v,) int64
        For each vertex of the input, the vertex of this mesh it went to; -1 if left out.
    fine_V : (v, 3) float64
        Positions of the input.
    fine_F : (f, 3) int64
        The triangles of the input that were used.
    eigenpairs : Eigenpairs or None
        Of the input, if the run had them: None with signals or pre_simplify, and in results of
        apply() and of a shared connectivity. fine_eigenpairs is always available.
    coefficients : (n, 7) array or None
        Of the operator on this mesh: coefficients= as the collapses carried them.
    fitted : Fitted_operators or None
        With fit_operators=True, for evaluate(..., operators=...).
    report : dict
        Of a run what was done, with the names of spectral_simplify --json: counts, seconds,
        stop_reason, warnings. Of other levels mass, eigenvectors and output_vertices.
    """

    V: numpy.ndarray
    F: numpy.ndarray
    P: scipy.sparse.csr_matrix
    vertex_map: numpy.ndarray
    fine_V: numpy.ndarray
    fine_F: numpy.ndarray
    eigenpairs: Eigenpairs | None
    coefficients: numpy.ndarray | None
    fitted: Fitted_operators | None
    report: dict[str, Any]
    _asked: dict[str, Any]  # of simplify(): what says which operator it was about
    _Q: scipy.sparse.csr_matrix | None
    _used: numpy.ndarray | None  # vertices of the input that have faces; None: all
    _stays: numpy.ndarray | None = None  # for merged vertices of the input the one that stays

    @classmethod
    def _of(
        cls,
        core: dict[str, Any],
        fine_V: numpy.ndarray,
        fine_F: numpy.ndarray,
        used: numpy.ndarray | None,
        **more: Any,
    ):
        """From what the compiled module says of the part of the input that was used."""
        if used is not None:
            n = len(fine_V)
            P = core["P"].tocoo()
            core = {
                **core,
                "P": scipy.sparse.csr_matrix((P.data, (P.row, used[P.col])), (P.shape[0], n)),
            }
            vertex_map = numpy.full(n, -1, numpy.int64)
            vertex_map[used] = core["vertex_map"]
            stays = more.get("_stays")
            core["vertex_map"] = vertex_map if stays is None else vertex_map[stays]
        return cls._from_state(
            dict(
                V=core["V"],
                F=core["F"],
                P=core["P"],
                vertex_map=core["vertex_map"],
                fine_V=fine_V,
                fine_F=fine_F,
                _used=used,
                _Q=None,
                **more,
            )
        )

    def _renumbered(self, V: numpy.ndarray, place: numpy.ndarray, origin: numpy.ndarray):
        """The result numbered as the mesh that was cleaned: `place` and `origin` of clean()."""
        numbers, times = numpy.unique(origin, return_counts=True)
        if (times > 1).any():
            raise ValueError(
                f"repair separates sheets at vertex {numbers[times > 1][0]}, which becomes "
                "several: pass V and F of clean(V, F, repair=True), which number the result."
            )
        P = self.P.tocoo()
        vertex_map = numpy.where(place >= 0, self.vertex_map[place], -1)
        everyone = numpy.arange(len(V))
        stays = numpy.where(place >= 0, origin[place], everyone)
        state = dict(
            self._state(),
            P=scipy.sparse.csr_matrix((P.data, (P.row, origin[P.col])), (P.shape[0], len(V))),
            fine_V=V,
            fine_F=origin[self.fine_F],
            vertex_map=vertex_map,
            _used=origin[self.used],
            _stays=stays if (stays != everyone).any() else None,
            _Q=None,
        )
        if "report" in state:
            left_out = origin[numpy.asarray(state["report"]["left_out"], numpy.int64)]
            state["report"] = {**state["report"], "left_out": left_out.tolist()}
        return self._from_state(state)

    def part(self) -> tuple[numpy.ndarray, numpy.ndarray]:
        """The part of the input that was used, with its own numbering: the mesh of `eigenpairs`.

        Returns
        -------
        V : (u, 3) float64
            Positions of the vertices `used`.
        F : (f, 3) int64
            Their triangles. With P[:, used] both go to evaluate().
        """
        if self._used is None:
            return self.fine_V, self.fine_F
        place = numpy.full(len(self.fine_V), -1, numpy.int64)
        place[self._used] = numpy.arange(len(self._used))
        return self.fine_V[self._used], place[self.fine_F]

    def _part_P(self) -> scipy.sparse.csr_matrix:
        return self.P if self._used is None else self.P[:, self._used]

    @property
    def used(self) -> numpy.ndarray:
        """(u,) int64, the vertices of the input that have faces; eigenpairs have a row for each
        of them."""
        return numpy.arange(len(self.fine_V)) if self._used is None else self._used

    @property
    def Q(self) -> scipy.sparse.csr_matrix:
        """(v, n) csr_matrix that carries functions back, by barycentric coordinates of the closest
        points. Rows of vertices that were left out are empty; vertices that clean() merged have
        equal rows. Computed when it is first used."""
        if self._Q is None:
            V, F = self.part()
            Q = _core.prolongation(dict(V=V, F=F, Vc=self.V, Fc=self.F, P=self._part_P()))
            if self._used is not None:
                Q = Q.tocoo()
                Q = scipy.sparse.csr_matrix(
                    (Q.data, (self._used[Q.row], Q.col)), (len(self.fine_V), len(self.V))
                )
            self._Q = Q if self._stays is None else Q.tocsr()[self._stays]
        return self._Q

    @property
    def A(self) -> scipy.sparse.csr_matrix:
        """(n, v) csr_matrix of area-weighted means, for average(): every used vertex of the input
        counts, rows sum to 1. A vertex with no vertex of the input nearby has its row of P."""
        weights = self.Q.T @ scipy.sparse.diags(_vertex_areas(self.fine_V, self.fine_F))
        total = numpy.asarray(weights.sum(axis=1)).ravel()
        lonely = total <= 1e-12 * total.sum()
        result = (
            scipy.sparse.diags(numpy.where(lonely, 0, 1 / numpy.where(lonely, 1, total))) @ weights
        )
        return (
            result + scipy.sparse.diags(lonely.astype(float)) @ self.P if lonely.any() else result
        ).tocsr()

    def _carried(
        self, W: scipy.sparse.csr_matrix, values: numpy.ndarray, unit: bool, nan: str
    ) -> numpy.ndarray:
        if numpy.ma.isMaskedArray(values) and values.dtype.kind in "fiu":
            values = values.astype(float).filled(numpy.nan)
        values = _rectangular("values", values)
        v = W.shape[1]
        if values.ndim == 0 or len(values) != v:
            raise ValueError(
                f"values has the shape {values.shape}, it must be ({v},) or ({v}, c), a row "
                "for each vertex of V."
            )
        if values.dtype.kind not in "fiu":
            raise _core.Wrong_type(
                f"values has the dtype {values.dtype}, it must hold real numbers; "
                "transfer_labels() carries others."
            )
        nan, unit = _word("nan", nan, ("propagate", "omit")), _flag("unit", unit)
        if unit and values.ndim != 2:
            raise ValueError(
                f"values has the shape {values.shape}, for unit=True it must be ({v}, c)."
            )
        wide = values.dtype.kind in "iu" and values.dtype.itemsize == 8 and values.size > 0
        if wide and (values.max() > 2**53 or values.min() < -(2**53)):
            raise ValueError(
                "values has integers beyond 2^53, which double precision does not hold: "
                "transfer_labels() carries them as labels."
            )
        flat = values.reshape(v, -1).astype(float)
        missing = numpy.isnan(flat)
        if nan == "omit" and missing.any():
            weight = W @ (~missing).astype(float)
            with numpy.errstate(divide="ignore", invalid="ignore"):
                result = numpy.where(
                    weight > 1e-12, (W @ numpy.where(missing, 0, flat)) / weight, numpy.nan
                )
        else:
            result = W @ flat
        result = result.reshape((len(result),) + values.shape[1:])
        if unit:
            length = numpy.linalg.norm(result, axis=1, keepdims=True)
            return result / numpy.where(length > 0, length, 1)
        if values.dtype.kind == "f":
            return result
        limits = numpy.iinfo(values.dtype)
        return numpy.clip(numpy.rint(result), limits.min, limits.max).astype(values.dtype)

    def interpolate(
        self, values: numpy.ndarray, unit: bool = False, nan: str = "propagate"
    ) -> numpy.ndarray:
        """Carries values at the vertices of V to this mesh, as P @ values: for values at points,
        such as positions or colours.

        Parameters
        ----------
        values : (v, ...) array
            Real numbers; masked entries count as NaN. Results for integers, such as colours, are
            rounded and keep the dtype.
        unit : bool
            Gives rows, of normals for instance, the length 1.
        nan : str
            'propagate', or 'omit': the mean of the values that are not NaN, NaN if there are none.

        Returns
        -------
        (n, ...) array
            In the unit of the values.

        Raises
        ------
        ValueError, TypeError
            If the input is invalid; one sentence names the first fault.
        """
        return self._carried(self.P, values, unit, nan)

    def average(
        self, values: numpy.ndarray, unit: bool = False, nan: str = "propagate"
    ) -> numpy.ndarray:
        """Carries values at the vertices of V to this mesh, as means over the area around each
        vertex: for noisy measurements such as thickness or activity. Every vertex of V counts,
        while P gives most no weight.

        Parameters
        ----------
        values, unit, nan : array, bool, str
            As in interpolate(), or booleans.

        Returns
        -------
        (n, ...) array
            In the unit of the values, not rounded.

        Raises
        ------
        ValueError, TypeError
            If the input is invalid; one sentence names the first fault.
        """
        if not numpy.ma.isMaskedArray(values):
            values = _rectangular("values", values)
        if values.dtype.kind in "biu":  # a mean of counts is no count
            values = values.astype(float)
        return self._carried(self.A, values, unit, nan)

    def transfer_labels(self, labels: Any, by: str = "restriction") -> Any:
        """Carries labels of the vertices of V to this mesh.

        Parameters
        ----------
        labels : (v,) array
            Integers, booleans or strings, of NumPy or pandas; a pandas categorical gives one. Whole
            numbers of type float are integers. Those of vertices that were left out are not read,
            and may be missing.
        by : str
            'restriction': the label with the largest weight in a row of P, on a tie the smallest;
            'area': the label with the most area around the vertex, as average() weights it.

        Returns
        -------
        (n,) array or pandas.Categorical
            Some of the labels.

        Raises
        ------
        ValueError, TypeError
            If the input is invalid, or a used vertex has no label; one sentence names the first
            fault.
        """
        by = _word("by", by, ("restriction", "area"))
        v = self.P.shape[1]
        kind = getattr(labels, "dtype", None)
        if hasattr(kind, "categories"):  # pandas
            codes = numpy.asarray(labels.cat.codes if hasattr(labels, "cat") else labels.codes)
            self._check_labels(codes, v, codes < 0)
            carried = self._voted(codes, by)
            import pandas

            return pandas.Categorical.from_codes(carried, dtype=kind)
        missing = False
        if numpy.ma.isMaskedArray(labels):
            missing, labels = numpy.ma.getmaskarray(labels).ravel(), labels.data
        if hasattr(kind, "numpy_dtype"):  # integers and booleans of pandas that may be missing
            missing = numpy.asarray(labels.isna())
            labels = labels.to_numpy(kind.numpy_dtype, na_value=0)
        labels = _rectangular("labels", labels)
        missing = numpy.broadcast_to(missing, labels.size)
        # None, NaN and pandas' NA are not equal to themselves, or not strings
        if labels.dtype.kind == "O":
            missing = missing | numpy.array(
                [x is None or type(x).__name__ in ("NAType", "float") for x in labels.ravel()], bool
            )
        if labels.dtype.kind == "f" and numpy.all(numpy.isnan(labels) | (labels % 1 == 0)):
            missing = missing | numpy.isnan(labels).ravel()  # whole numbers of a file of text
            labels = numpy.where(numpy.isnan(labels), 0, labels).astype(numpy.int64)
        self._check_labels(labels, v, missing)
        if labels.dtype.kind == "O" and not all(isinstance(x, str) for x in labels[self.used]):
            raise _core.Wrong_type(
                "labels holds objects that are not strings: pass integers, strings or categories."
            )
        if labels.dtype.kind not in "biuSUO":
            raise _core.Wrong_type(
                f"labels has the dtype {labels.dtype}, it must hold integers or strings; "
                "interpolate() carries real "
                "numbers."
            )
        return self._voted(labels, by)

    def prolong_labels(self, labels: Any, outside: Any = None) -> numpy.ndarray:
        """Carries labels of this mesh to the vertices of V: each gets the label with the largest
        weight in its row of Q.

        Parameters
        ----------
        labels : (n,) array
            Of any type, a label for each vertex of this mesh; a pandas categorical gives one.
        outside : optional
            Label of vertices that do not take part, which mask= leaves out or which have no face;
            needed if there are any. Of the kind of the labels.

        Returns
        -------
        (v,) array or pandas.Categorical

        Raises
        ------
        ValueError, TypeError
            If the input is invalid; one sentence names the first fault.
        """
        kind = getattr(labels, "dtype", None)
        if hasattr(kind, "categories"):  # pandas
            import pandas

            if outside is not None and (
                numpy.ndim(outside) != 0 or outside not in kind.categories
            ):
                raise ValueError(
                    f"outside is {_shown(outside)}, it must be one of the categories of labels."
                )
            codes = numpy.asarray(labels.cat.codes if hasattr(labels, "cat") else labels.codes)
            code = None if outside is None else kind.categories.get_loc(outside)
            return pandas.Categorical.from_codes(self.prolong_labels(codes, code), dtype=kind)
        labels, n = _rectangular("labels", labels), len(self.V)
        if labels.shape != (n,):
            raise ValueError(
                f"labels has the shape {labels.shape}, it must be ({n},), one for each vertex of "
                "the simplified mesh."
            )
        carried = labels[numpy.asarray(self.Q.argmax(axis=1)).ravel()]
        others = numpy.diff(self.Q.indptr) == 0
        if not others.any():
            return carried
        if outside is None:
            count = f"{others.sum()} vertices do" if others.sum() > 1 else "one vertex does"
            raise ValueError(
                f"{count} not take part, vertex {others.argmax()} is the first: pass outside=, the "
                "label that they get."
            )
        one, kind = numpy.asarray(outside), labels.dtype.kind
        takes = dict(i="iu", u="iu", f="iuf", O="OUSbiufc").get(kind, kind)
        fits = one.ndim == 0 and one.dtype.kind in takes
        result = numpy.result_type(labels.dtype, numpy.min_scalar_type(outside)) if fits else None
        if not fits or result.kind not in takes:
            raise _core.Wrong_type(
                f"outside is {_shown(outside)}, it must be one value of the kind of labels, whose "
                f"dtype is {labels.dtype}."
            )
        carried = carried.astype(result)
        carried[others] = outside
        return carried

    def _check_labels(self, labels: numpy.ndarray, v: int, missing: numpy.ndarray) -> None:
        if labels.shape != (v,):
            raise ValueError(
                f"labels has the shape {labels.shape}, it must be ({v},), one for each vertex of V; "
                "prolong_labels() carries those of the simplified mesh."
            )
        bad = self.used[missing[self.used]]  # no label of the others is read
        if bad.size:
            raise ValueError(f"labels[{bad[0]}] is missing: give each vertex one.")

    def _voted(self, labels: numpy.ndarray, by: str) -> numpy.ndarray:
        names, of = numpy.unique(labels[self.used], return_inverse=True)
        W = (self.P if by == "restriction" else self.A)[:, self.used]
        weights = W @ scipy.sparse.csr_matrix((numpy.ones(len(of)), (numpy.arange(len(of)), of)))
        return names[numpy.asarray(weights.argmax(axis=1)).ravel()]

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {len(self.fine_V)} to {len(self.V)} vertices>"

    @property
    def fine_eigenpairs(self) -> Eigenpairs:
        """Eigenpairs of the input in the mass of the run. If `eigenpairs` is None, they are
        computed when first used. There are as many as the run kept, or all that eigenpairs= had;
        rows are those of `used`."""
        if self.eigenpairs is not None:
            return self.eigenpairs
        if self._asked.get("pairs") is None:
            V, F = self.part()
            self._asked["pairs"] = self._pairs(
                V,
                F,
                self.report["eigenvectors"],
                self.report["mass"],
                self._asked["coefficients"],
                tolerance=1e-8,  # as a run has it
            )
        return self._asked["pairs"]

    def coarse_eigenpairs(
        self, k: int | None = None, mass: str | None = None, *, progress: Progress | None = None
    ) -> Eigenpairs:
        """Eigenpairs of the simplified mesh.

        Parameters
        ----------
        k : int, optional
            How many; as many as the run kept.
        mass : str, optional
            'lumped', 'averaged', 'consistent' or 'voronoi'; 'fitted' for operators fitted to the
            spectrum of the input. None: the mass of the run.
        progress : function, optional
            As in simplify().

        Returns
        -------
        Eigenpairs
            For 'fitted' Fitted_operators.

        Raises
        ------
        ValueError, TypeError
            If the input is invalid; one sentence names the first fault.
        Cancelled
            If progress returns False.
        """
        k = min(self.report["eigenvectors"], len(self.V)) if k is None else k
        k = _integer("k", k, 1, len(self.V), ", the vertices of the simplified mesh")
        mass = self.report["mass"] if mass is None else mass
        mass = _word("mass", mass, ("lumped", "averaged", "consistent", "voronoi", "fitted"))
        if mass != "fitted":
            return self._pairs(self.V, self.F, k, mass, self.coefficients, progress)
        if self.fitted is not None and len(self.fitted) == k:
            return self.fitted
        values = dict(
            Vc=self.V,
            Fc=self.F,
            P=self._part_P(),
            eigenpairs=self.fine_eigenpairs,
            k=k,
            mass=None,
            rings=None,
            low_modes=2.5,
            orthonormality=0.01,
            whole_residual=0.2,
            coefficients=self.coefficients,
            progress=progress,
        )
        return Fitted_operators(_core.fit_operators(values))

    def _pairs(
        self, V, F, k, mass, coefficients, progress=None, tolerance: float = 1e-10, threads=None
    ) -> Eigenpairs:
        return Eigenpairs(
            _core.eigenpairs(
                dict(
                    V=V,
                    F=F,
                    k=k,
                    mass=mass,
                    tolerance=tolerance,
                    coefficients=coefficients,
                    boundary=self._asked["boundary"],
                    intrinsic_delaunay=self._asked["intrinsic_delaunay"],
                    threads=threads,
                    progress=progress,
                )
            )
        )


class Simplification(Level):
    """What simplify() returns: a Level with its collapses.

    Attributes
    ----------
    collapses : structured array
        One record for each collapse, in order: removed and kept, the two vertices of the input;
        weight, that of the removed one; point, where the vertex was put. Vertices are indices
        into `used`.
    """

    collapses: numpy.ndarray

    def levels(self, n: int) -> Level:
        """The mesh of n vertices on the way from the input to the result, before relocation.

        Parameters
        ----------
        n : int
            From the vertices of the result to those of the input.

        Returns
        -------
        Level
            Of the same eigenpairs.

        Raises
        ------
        ValueError, TypeError
            If n is outside of this range.
        """
        V, F = self.part()
        core = _core.level(dict(V=V, F=F, collapses=self.collapses, n=n))
        of_input = self._asked["coefficients"]
        return self._beside(
            core,
            self.fine_V,
            eigenpairs=self.eigenpairs,
            coefficients=None if of_input is None else core["P"] @ of_input,
        )

    def _beside(self, core: dict[str, Any], fine_V: numpy.ndarray, **more: Any) -> Level:
        """A level with the operator of this run."""
        names = "eigenvectors", "mass"
        report = dict({name: self.report[name] for name in names}, warnings=[], left_out=[])
        return Level._of(
            core,
            fine_V,
            self.fine_F,
            self._used,
            fitted=None,
            report=dict(report, output_vertices=len(core["V"])),
            _asked=dict(self._asked, pairs=None),
            _stays=self._stays,
            **more,
        )

    def apply(
        self,
        V_other: numpy.ndarray,
        by: str = "restriction",
        relocate: bool = False,
        k: int | None = None,
        eigenpairs: Eigenpairs | None = None,
        *,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Level:
        """Simplifies another pose with the connectivity of the input. The result has the faces of
        this mesh, and its vertex i is in the same place.

        Parameters
        ----------
        V_other : (v, 3) array
            Positions of the other pose; its faces are those of the input.
        by : str
            'restriction': vertices are P @ V_other; 'merges': the same with the P of the collapses,
            before relocation.
        relocate : bool
            Moves the vertices so that the spectrum of this pose is kept, as relocate='sampled' of
            simplify() does. With 'restriction' the vertices start beside P @ V_other, as those of
            the run lie beside P @ V. Good eigenvalues need it. But vertex i then lies elsewhere,
            where the P of the result says: to compare poses vertex by vertex, do without it.
        k : int, optional
            How many eigenpairs of this pose relocation sees; as many as the run kept. Not with
            eigenpairs.
        eigenpairs : Eigenpairs, optional
            Of the other pose in the mass of the run, rows as in `used`, to save the solve: all of
            them are seen.
        threads, progress
            As in simplify().

        Returns
        -------
        Level
            Its fine_eigenpairs are those of the pose, computed when they are first asked for.

        Raises
        ------
        ValueError, TypeError
            If the input is invalid; one sentence names the first fault.
        Cancelled
            If progress returns False.
        """
        by, relocate = _word("by", by, ("restriction", "merges")), _flag("relocate", relocate)
        if not relocate and (k is not None or eigenpairs is not None):
            raise ValueError("k and eigenpairs belong to relocate=True: leave them out.")
        if k is not None and eigenpairs is not None:
            raise ValueError("k and eigenpairs are both given: leave out k.")
        if relocate and self._asked["coefficients"] is not None:
            raise ValueError(
                "relocate=True keeps the spectrum of the Laplacian, and the run has coefficients "
                "of another operator: leave it out, or simplify V_other."
            )
        V_other = _array("V_other", V_other)
        if V_other.shape != self.fine_V.shape:
            raise ValueError(
                f"V_other has the shape {V_other.shape}, it must be {self.fine_V.shape}, as V "
                "of the run."
            )
        bad = ~numpy.isfinite(V_other[self.used]).all(axis=1)
        if bad.any():
            raise ValueError(
                f"V_other[{int(self.used[bad.argmax()])}] is not finite: correct the position."
            )
        V_other[~numpy.isfinite(V_other).all(axis=1)] = 0  # of vertices without faces
        P = self.P if by == "restriction" else self._merge_restriction()
        V, F = _part_of(V_other, self.fine_F, self._used)
        core = dict(V=P @ V_other, F=self.F)
        if relocate and by == "restriction":
            core["V"] += _carried_offsets(self.V, P @ self.fine_V, core["V"], self.F)
        part_P = P if self._used is None else P[:, self._used]
        if relocate:
            k = self.report["eigenvectors"] if k is None else k
            if eigenpairs is None:
                eigenpairs = self._pairs(
                    V, F, k, self.report["mass"], None, progress, 1e-8, threads
                )
            else:
                self._check_pairs(eigenpairs, V, F)
            core.update(
                _core.relocate(
                    dict(
                        V=V,
                        F=F,
                        Vc=core["V"],
                        Fc=self.F,
                        P=part_P,
                        eigenpairs=eigenpairs,
                        fixed=self._asked["kept"],
                        signals="sampled",
                        prefer=self._asked["prefer"],
                        threads=threads,
                        progress=progress,
                    )
                )
            )
            part_P = core["P"]
        core["P"], core["vertex_map"] = part_P, self.vertex_map[self.used]
        return self._beside(core, V_other, eigenpairs=None, coefficients=self.coefficients)

    def _check_pairs(self, eigenpairs: Eigenpairs, V, F) -> None:
        """Refuses eigenpairs that are not those of the mesh V, F in the mass of the run."""
        if not isinstance(eigenpairs, Eigenpairs):
            raise _core.Wrong_type(
                f"eigenpairs is of the type {type(eigenpairs).__name__}, it must be Eigenpairs: "
                "pass what eigenpairs() or Eigenpairs.from_arrays() returns."
            )
        if len(eigenpairs.vectors) != len(V):
            raise ValueError(
                f"eigenpairs are of {len(eigenpairs.vectors)} vertices, but V_other has {len(V)} "
                "that are used: pass those of this mesh."
            )
        if eigenpairs.mass != self.report["mass"]:
            raise ValueError(
                f"eigenpairs are of the {eigenpairs.mass} mass, but the run is of the "
                f"{self.report['mass']} one: compute them in that mass."
            )
        # Every mass has the area of its mesh, and no two poses have quite the same.
        area, mass = _vertex_areas(V, F).sum(), eigenpairs._core.row_masses.sum()
        if not abs(mass - area) <= 1e-5 * area:
            raise ValueError(
                f"eigenpairs are of a mesh with the area {mass:.6g}, but that of V_other is "
                f"{area:.6g}: pass those of this pose."
            )

    def _merge_restriction(self) -> scipy.sparse.csr_matrix:
        """P of the merges alone, rows in the order of this mesh."""
        n = len(self.used)
        entry = numpy.ones(n)
        log = self.collapses[::-1]
        for removed, kept, weight in zip(
            log["removed"].tolist(), log["kept"].tolist(), log["weight"].tolist()
        ):
            # Before this merge both had what the kept one has afterwards, in their shares.
            entry[removed] = entry[kept] * weight
            entry[kept] = entry[kept] * (1 - weight)
        rows = self.vertex_map[self.used]
        P = scipy.sparse.csr_matrix((entry, (rows, self.used)), (len(self.V), len(self.fine_V)))
        P.eliminate_zeros()
        return P


def _carried_offsets(V, on_surface, on_other, F):
    """How far vertices lie off P V, carried to another pose: turned and scaled with the edges
    around each, and mirrored where the pose is. Relocation begins nearer to where it ends: |C|_L is
    0.9 times as large."""
    ends = numpy.vstack([F[:, e] for e in ([0, 1], [1, 2], [2, 0])])
    i, j = numpy.vstack([ends, ends[:, ::-1]]).T
    here, there = on_surface[j] - on_surface[i], on_other[j] - on_other[i]
    products, lengths = numpy.zeros((len(V), 3, 3)), numpy.zeros((len(V), 2))
    numpy.add.at(products, i, here[:, :, None] * there[:, None])
    numpy.add.at(lengths, i, numpy.stack([(here**2).sum(1), (there**2).sum(1)], axis=1))
    tiny = numpy.finfo(float).tiny
    left, size, right = numpy.linalg.svd(products)  # W. Kabsch 1976
    side = numpy.sign(numpy.linalg.det(left @ right))
    # Flat surroundings do not know it: all decide, by how far from flat they are.
    mirrored = (side * size[:, 2] / numpy.maximum(size[:, 0], tiny)).sum() < -1e-9 * len(V)
    left[:, :, 2] *= (-side if mirrored else side)[:, None]
    known = lengths[:, 0] > 0
    scales = numpy.sqrt(numpy.where(known, lengths[:, 1], 0) / numpy.where(known, lengths[:, 0], 1))
    return scales[:, None] * ((V - on_surface)[:, None] @ left @ right)[:, 0]


def _part_of(V, F, used):
    if used is None:
        return V, F
    place = numpy.full(len(V), -1, numpy.int64)
    place[used] = numpy.arange(len(used))
    return V[used], place[F]


class Evaluation(_Result):
    """What evaluate() returns. 0 is perfect.

    Attributes
    ----------
    scale : str
        'unit': both meshes at unit area; 'mesh': as they are.
    C : (k, k) array
        Functional map, rows are coarse modes.
    C_L : float
        |C Lambda - Lambda_c C| / |C|, how far from commuting.
    C_D : float
        |C^T C - 1|, how far from orthonormal.
    floor_C_L, floor_C_D : float
        About what ideal linear elements have.
    span_loss : float
        |Phi - Q Phi_c X|^2 / k for the best X, in the norm of the fine mass: how much of the fine
        eigenvectors lies outside the span of the coarse ones, which the Q of Simplification carries
        back. Between 0 and 1.
    eigenvalue_error, eigenvalue_error_max, eigenvalue_error_low : float
        Relative error of the eigenvalues without the zeros: the mean, the largest, and the mean of
        the modes 2 to k / 5.
    values, coarse_values : arrays
        Fine and coarse eigenvalues.
    judged_modes : int
        k, or the number of coarse vertices if that is less.
    area_ratio : float
        Coarse over fine.
    """

    scale: str = "unit"
    C: numpy.ndarray
    C_L: float
    C_D: float
    floor_C_L: float
    floor_C_D: float
    span_loss: float
    eigenvalue_error: float
    eigenvalue_error_max: float
    eigenvalue_error_low: float
    values: numpy.ndarray
    coarse_values: numpy.ndarray
    judged_modes: int
    area_ratio: float

    def __repr__(self) -> str:
        error = 100 * self.eigenvalue_error
        scale = "unit area" if self.scale == "unit" else "scale of the meshes"
        return (
            f"<Evaluation: C_L {self.C_L:.6f}, C_D {self.C_D:.6f}, eigenvalue error {error:.6f} %, "
            f"{scale}>"
        )


class Match(_Result):
    """What match() returns.

    Attributes
    ----------
    map : (vx,) int64
        For each vertex of X that of Y.
    C : (k, k) array
        Functional map from Y to X, at unit area.
    condition, relative_residual : float
        Of the lift from the simplified meshes.
    """

    map: numpy.ndarray
    C: numpy.ndarray
    condition: float
    relative_residual: float

    def __repr__(self) -> str:
        return f"<Match: {len(self.map)} vertices, {len(self.C)} modes>"


class Alignment(_Result):
    """What align() returns.

    Attributes
    ----------
    vectors : (v, k) array
        Eigenvectors of the second mesh, aligned with those of the first.
    rotation : (k, k) array
        Orthogonal, a block for each cluster: vectors is the second's eigenvectors times it.
    clusters : list of (int, int)
        First mode of each and one past its last, as in range().
    """

    vectors: numpy.ndarray
    rotation: numpy.ndarray
    clusters: list

    def __repr__(self) -> str:
        return f"<Alignment: {len(self.rotation)} modes in {len(self.clusters)} clusters>"
