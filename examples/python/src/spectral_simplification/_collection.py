# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Many meshes in one call: in this process, on the cores of this machine, or on a cluster of Dask,
# which brings the scheduler.

from __future__ import annotations

import concurrent.futures
import concurrent.futures.process
import hashlib
import json
import os
import pathlib
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy

from ._core import Wrong_type as _Wrong_type
from ._core import arrays as _arrays
from ._interface import _features, eigenpairs, simplify
from ._meshes import _OWN, _read_mesh, clean
from ._results import (
    Level,
    Simplification,
    _flag,
    _integer,
    _noted,
    _rectangular,
    _Result,
    _shown,
    _word,
    _written,
    load,
)

_DIED = "the process that computed it died each time: it may need more memory."
_ATTEMPTS = 3  # of a mesh whose process dies


class Collection_row(_Result):
    """What became of one mesh of simplify_collection().

    Attributes
    ----------
    name : str
        The file's name without its ending, or the number of the mesh in the collection.
    error : str or None
        Why there is no result, in one sentence.
    path : str or None
        The file of the result, with output=.
    seconds : float
        That it took; 0 where the result was there already.
    """

    name: str
    error: str | None
    path: str | None
    seconds: float
    _result: Any

    @property
    def result(self) -> Level:
        """The Simplification, or the Level with a shared connectivity; read from the file where
        there is one.

        Raises
        ------
        ValueError
            If there is none: with the error of the row.
        """
        if self.error is not None:
            raise ValueError(f"{self.name} has no result: {self.error}")
        return self._result if self.path is None else load(self.path)

    def __repr__(self) -> str:
        return f"<Collection_row: {self.name}, {self.error or f'{self.seconds:.1f} s'}>"


def _of_own_format(mesh: Any) -> bool:
    """Whether the file may hold polygons: then a repair is of the file, otherwise of its arrays."""
    return isinstance(mesh, (str, os.PathLike)) and pathlib.Path(mesh).suffix.lower() in _OWN


def _taken(
    mesh: Any, repair: bool = False, said: list | None = None
) -> tuple[numpy.ndarray, numpy.ndarray]:
    """V and F of an item, which may be a file's name."""
    if isinstance(mesh, (str, os.PathLike)):
        return _read_mesh(mesh, repair and _of_own_format(mesh), said)
    if not isinstance(mesh, (tuple, list)) or len(mesh) != 2:
        raise _Wrong_type(
            f"a mesh is of the type {type(mesh).__name__}, it must be the name of a file or a "
            "pair (V, F)."
        )
    V, F = mesh
    return _rectangular("V", V), _rectangular("F", F)


def _numbering(options: dict[str, Any]) -> list[str]:
    """Options that number the vertices as they come; words of keep do not."""
    given = {**options, "keep": _features(options.get("keep"))[1]}
    return [
        name for name in ("mask", "keep", "signals", "coefficients") if given.get(name) is not None
    ]


def _one(mesh: Any, n: int, repair: bool, options: dict[str, Any]) -> Simplification:
    """A mesh as it comes: cleaned as the programs do, and numbered as it came."""
    changes: list[str] = []
    V, F = _taken(mesh, repair, changes)
    if _numbering(options):
        return simplify(V, F, n, **options)
    cleaned = clean(V, F, repair and not _of_own_format(mesh))
    run = simplify(cleaned.V, cleaned.F, n, **options)
    run.report["changes"] = changes + cleaned.changes
    return (
        run._renumbered(numpy.array(V, float), cleaned.place, cleaned.origin)
        if cleaned.changes
        else run
    )


def _pairs(mesh: Any, k: int, mass: str, boundary: str, threads: int | None):
    V, F = _taken(mesh)
    return eigenpairs(V, F, k, mass, tolerance=1e-8, boundary=boundary, threads=threads)


def _posed(mesh: Any, run: Simplification, pairs: Any, relocate: bool, threads: int | None):
    V, _ = _taken(mesh)
    return run.apply(
        V, relocate=relocate, eigenpairs=pairs if relocate else None, threads=threads
    )


def _guarded(function: Callable, arguments: tuple) -> tuple[Any, str | None, float]:
    """What a worker does: a result, or a sentence. Nothing that one mesh causes ends the others."""
    import warnings

    begin = time.perf_counter()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # they are in the report
            return function(*arguments), None, time.perf_counter() - begin
    except Exception as error:
        return None, str(error) or type(error).__name__, time.perf_counter() - begin


def _here(
    tasks: Iterable[tuple[int, Callable, tuple]]
) -> Iterator[tuple[int, Any, str | None, float]]:
    for i, function, arguments in tasks:
        yield i, *_guarded(function, arguments)


def _on_processes(tasks, workers: int):
    """Processes of this machine. Where one dies, what ran with it is tried again, each mesh alone:
    so it is known whose fault it was."""
    import multiprocessing

    context = multiprocessing.get_context("spawn")  # libraries have threads, which fork loses
    tasks = iter(tasks)
    suspects: list = []  # with the number of deaths while they were alone
    more, first = True, True
    while more or suspects:
        alone = bool(suspects)
        running: dict = {}
        with concurrent.futures.ProcessPoolExecutor(
            1 if alone else workers, mp_context=context
        ) as pool:
            try:
                while True:
                    while more and not alone and len(running) < 2 * workers:
                        task = next(tasks, None)
                        more = task is not None
                        if more:
                            if first:
                                _check_worker(pool)
                                first = False
                            running[_submitted(pool, task, running)] = (task, 0)
                    if alone and suspects and not running:
                        task, deaths = suspects.pop(0)
                        running[_submitted(pool, task, running)] = (task, deaths)
                    if not running:
                        break
                    done, _ = concurrent.futures.wait(
                        running, return_when=concurrent.futures.FIRST_COMPLETED
                    )
                    for future in done:
                        result = future.result()
                        yield running.pop(future)[0][0], *result
            except concurrent.futures.process.BrokenProcessPool:
                for future, (task, deaths) in running.items():
                    if future is not None and future.done() and future.exception() is None:
                        yield task[0], *future.result()
                    elif alone and deaths + 1 == _ATTEMPTS:
                        yield task[0], None, _DIED, 0.0
                    else:
                        suspects.append((task, deaths + alone))
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise


def _check_worker(pool) -> None:
    """Whether a process starts at all: it imports the script first."""
    try:
        pool.submit(int).result()
    except concurrent.futures.process.BrokenProcessPool:
        raise RuntimeError(
            "No process can be started for workers=, its own words are above. In a script what "
            "calls simplify_collection() must stand below if __name__ == '__main__':, and the script "
            "must be a file, since each process imports it."
        ) from None


def _submitted(pool, task, running: dict):
    try:
        return pool.submit(_guarded, task[1], task[2])
    except concurrent.futures.process.BrokenProcessPool:
        running[None] = (task, 0)  # it has not begun
        raise


def _on_dask(tasks, client):
    try:
        import distributed
    except ImportError:
        raise ValueError(
            "a cluster needs the package distributed, which is not installed: pip install "
            "distributed, or on Debian "
            "apt-get install python3-distributed."
        ) from None
    own = None
    if isinstance(client, str):
        try:
            client = own = distributed.Client(client, timeout=10)
        except (OSError, ValueError) as error:
            raise ValueError(f"no scheduler of Dask answers at {client}: {error}.") from None
    running, futures, tasks = {}, {}, iter(tasks)
    try:
        completed = distributed.as_completed()

        def submit() -> bool:
            task = next(tasks, None)
            if task is None:
                return False
            future = client.submit(_guarded, task[1], task[2], pure=False, retries=_ATTEMPTS - 1)
            running[future.key], futures[future.key] = task[0], future
            completed.add(future)
            return True

        # A few more than there are threads, so that meshes are read as they are wanted.
        while len(running) < 2 * max(1, sum(client.nthreads().values())) and submit():
            pass
        while running:
            future = next(completed)
            i = running.pop(future.key)
            del futures[future.key]
            submit()
            try:
                result = future.result()
            except Exception as error:  # distributed.KilledWorker, and what a broken cluster says
                result = None, f"the cluster lost it, {type(error).__name__}: {error}", 0.0
            yield i, *result
    finally:
        client.cancel(list(futures.values()))
        if own is not None:
            own.close()


def _scheduled(tasks, workers):
    if isinstance(workers, str) and workers != "all" or hasattr(workers, "submit"):
        return _on_dask(tasks, workers)
    if workers == "all":
        workers = (
            len(os.sched_getaffinity(0))
            if hasattr(os, "sched_getaffinity")
            else os.cpu_count() or 1
        )
    return _here(tasks) if workers == 1 else _on_processes(tasks, workers)


def _bar(done: int, total: int | None, name: str) -> None:
    width = 30
    filled = width * done // total if total else 0
    of = f" of {total}" if total else ""
    print(
        f"\r[{'#' * filled}{'.' * (width - filled)}] {done}{of} {name[:30]:30}",
        end="",
        file=sys.stderr,
        flush=True,
    )


def _plain(value: Any) -> Any:
    if isinstance(value, numpy.generic):
        value = value.item()
    if isinstance(value, (str, int, float, bool, type(None))):
        return value
    if isinstance(value, (list, tuple)) and any(isinstance(part, str) for part in value):
        return [_plain(part) for part in value]  # of keep, words and indices
    array = numpy.ascontiguousarray(value)
    return f"{array.dtype}{array.shape}{hashlib.sha256(array.tobytes()).hexdigest()}"


def _source(mesh: Any) -> str:
    """What tells a mesh from another: a hash of its file, or of V and F."""
    if isinstance(mesh, (str, os.PathLike)):
        try:
            return hashlib.sha256(pathlib.Path(mesh).read_bytes()).hexdigest()
        except OSError:  # workers of a cluster may see files that this process does not
            return os.path.abspath(mesh)
    try:
        return " ".join(_plain(part) for part in mesh)
    except (TypeError, ValueError):
        return ""  # it is no mesh, and has no result


def _check_settings(folder: pathlib.Path, settings: dict[str, Any]) -> None:
    """Refuses a folder with results of other arguments; notes the arguments in a new one."""
    kept = folder / "settings.json"
    if kept.exists():
        try:
            said = json.loads(kept.read_text())
        except ValueError:
            said = None
        if not isinstance(said, dict) or not {"n", "shared_connectivity"} <= set(said):
            raise ValueError(
                f"{kept} was written by something else: choose another folder, or remove it."
            )
        if said == settings:
            return
        if any(folder.glob("*.npz")):
            raise ValueError(
                f"{folder} has results of other arguments, {kept.name} says which: choose "
                "another folder, or empty it."
            )
    with _written(str(kept)) as part:
        pathlib.Path(part).write_text(json.dumps(settings))


def simplify_collection(
    meshes: Iterable[Any],
    n: int,
    output: Any = None,
    *,
    workers: Any = 1,
    shared_connectivity: bool = False,
    repair: bool = False,
    progress: bool | Callable[[int, Any, str], Any] | None = None,
    **options: Any,
) -> list[Collection_row]:
    """Simplifies many meshes. Returns a row for each, with its result or with the sentence that
    says why there is none.

    Parameters
    ----------
    meshes : iterable
        File names, see read_mesh(), or pairs (V, F); for a folder the list of glob.glob(). They are
        read as needed, or all at once for a shared connectivity. Each is cleaned as clean() does,
        unless an option has vertex indices or a row for each vertex; results still number the
        vertices as given. If the iterable raises an exception, the last row says so.
    n : int
        Vertices of each result.
    output : folder, optional
        Where results are written as they come, NAME.npz each, for load(). A second call with the
        same arguments continues where the first one ended. A file of the same name but of another
        mesh is not touched: the row has an error. None: the rows hold the results.
    workers : int, 'all', address or client
        1: this process; more, or 'all': processes of this machine; an address such as
        'tcp://host:8786', or a distributed.Client: a cluster of Dask, whose workers see the files
        and have this package.
    shared_connectivity : bool
        All meshes have the same faces, as poses of one figure. The results then have one
        connectivity, too, with vertex i in the same place. The eigenvectors of all meshes decide
        the collapses, in the metric of the first mesh. Unless relocate is 'none', each result is
        relocated by its own eigenvectors, starting where the first result ended. Options that are
        about one mesh, or leave out a part of it, are refused.
    repair : bool
        Does what --repair does to each mesh. Results of files are numbered as
        read_mesh(name, repair=True) numbers these.
    progress : bool or function, optional
        True: a bar on stderr, the default at a terminal. A function gets the number done, the
        total or None, and the name. If it returns False, Cancelled is raised, and what is written
        stays.
    **options
        Of simplify(), for all meshes.

    Returns
    -------
    list of Collection_row
        In the order of meshes.

    Raises
    ------
    ValueError
        If output has results of other arguments, or, with a shared connectivity, of other meshes;
        or if an option cannot be meant.
    """
    n = _integer("n", n, 1)
    try:
        iter(meshes)
        total = len(meshes) if hasattr(meshes, "__len__") else None
    except TypeError:
        raise _Wrong_type(
            f"meshes is of the type {type(meshes).__name__}, it must be a list of names or of "
            "pairs (V, F)."
        ) from None
    if isinstance(meshes, (str, os.PathLike)):
        raise ValueError(
            f"meshes is the one name {os.fspath(meshes)!r}: pass a list of names, such as "
            "glob.glob('folder/*.off')."
        )
    if "progress" in options or "eigenpairs" in options:
        raise ValueError("eigenpairs belong to one mesh: leave them out.")
    if not (isinstance(workers, str) or hasattr(workers, "nthreads")):
        try:
            workers = _integer("workers", workers, 1, 10000)
        except ValueError:
            raise ValueError(
                f"workers is {_shown(workers)}, it must be from 1 to 10000, 'all', an address or "
                "a distributed.Client."
            ) from None
    repair = _flag("repair", repair)
    shared_connectivity = _flag("shared_connectivity", shared_connectivity)
    if not (progress is None or callable(progress)):
        try:
            progress = _flag("progress", progress)
        except ValueError:
            raise _Wrong_type(
                f"progress is {_shown(progress)}, it must be None, True, False or a function."
            ) from None
    numbering = _numbering(options)
    if repair and (shared_connectivity or numbering):
        raise ValueError(
            f"repair renumbers vertices, and {(numbering or ['shared_connectivity'])[0]} needs "
            "them as they come: repair first."
        )
    import inspect

    for name in options:
        if name not in inspect.signature(simplify).parameters or name in ("V", "F", "n"):
            raise ValueError(f"simplify() has no option {name!r}.")
    if workers != 1:
        options.setdefault("threads", 1)
    folder = None
    if output is not None:
        if not isinstance(output, (str, os.PathLike)):
            raise _Wrong_type(
                f"output is of the type {type(output).__name__}, it must be the name of a folder."
            )
        folder = pathlib.Path(output)
        if folder.exists() and not folder.is_dir():
            raise ValueError(f"output is {folder}, which is a file: give the name of a folder.")
        folder.mkdir(parents=True, exist_ok=True)
        settings = {
            "n": n,
            "shared_connectivity": shared_connectivity,
            **({"repair": True} if repair else {}),
            **{
                name: _plain(value)
                for name, value in sorted(options.items())
                if name != "threads" and value is not None
            },
        }
        _check_settings(folder, settings)
    if progress is None:
        progress = sys.stderr.isatty()
    tell = _bar if progress is True else progress or None

    rows: dict[int, Collection_row] = {}
    names: dict[int, str] = {}
    sources: dict[int, str] = {}
    known: set[str] = set()

    def named(i: int, mesh: Any) -> str:
        name = (
            pathlib.Path(mesh).name.rpartition(".")[0] or pathlib.Path(mesh).name
            if isinstance(mesh, (str, os.PathLike))
            else f"{i:04d}"
        )
        while name in known:
            name += "+"
        known.add(name)
        names[i] = name
        if folder is not None:
            sources[i] = _source(mesh)
        return name

    def foreign(i: int) -> str | None:
        """Why the file of this name is not the result of this mesh, if it is another."""
        path = folder / (names[i] + ".npz")
        try:
            source = _noted(path, "_source")
        except ValueError as error:
            return f"{str(error).partition(': give')[0]}: choose another folder, or remove it."
        if source == sources[i]:
            return None
        what = "the result of another mesh" if source else "no result of simplify_collection()"
        return f"{path} is {what}: choose another folder, or remove it."

    def there(i: int) -> bool:
        """Whether a former call has written this one, or something else is in its place."""
        path = folder / (names[i] + ".npz") if folder else None
        if path is None or not path.exists():
            return False
        error = foreign(i)
        if error is not None:
            ended(i, None, error, 0.0)
            return True
        rows[i] = Collection_row._from_state(
            dict(name=names[i], error=None, path=str(path), seconds=0.0, _result=None)
        )
        said(i)
        return True

    def said(i: int) -> None:
        answer = None if tell is None else tell(len(rows), total, names[i])
        if isinstance(answer, (bool, numpy.bool_)) and not answer:
            from ._core import Cancelled

            raise Cancelled("The progress function returned False.")

    def ended(i: int, result: Any, error: str | None, seconds: float) -> None:
        path = None
        if error is None and folder is not None:
            path = str(folder / (names[i] + ".npz"))
            result._source = sources[i]
            result.save(path)
            result = None
        rows[i] = Collection_row._from_state(
            dict(name=names[i], error=error, path=path, seconds=seconds, _result=result)
        )
        said(i)

    if shared_connectivity:
        meshes = list(meshes)
        for i, mesh in enumerate(meshes):
            named(i, mesh)
        # All decide the connectivity: results of other poses have another one.
        whole = hashlib.sha256(" ".join(sources.values()).encode()).hexdigest()
        for i in sources:
            sources[i] += " of " + whole
            if (folder / (names[i] + ".npz")).exists() and foreign(i) is not None:
                raise ValueError(
                    f"{folder} has results of other meshes, such as {names[i]}.npz, and all "
                    "decide the connectivity: choose another folder, or empty it."
                )
        _shared(meshes, n, options, workers, there, ended)
    else:

        def tasks():
            source = enumerate(meshes)
            while True:
                try:
                    i, mesh = next(source)
                except StopIteration:
                    return
                except Exception as error:  # what has been computed is not lost to it
                    i = len(names)
                    named(i, None)
                    reason = f"meshes ended with {type(error).__name__}: {error}."
                    return ended(i, None, reason, 0.0)
                named(i, mesh)
                if not there(i):
                    yield i, _one, (mesh, n, repair, options)

        for i, result, error, seconds in _scheduled(tasks(), workers):
            ended(i, result, error, seconds)
    if tell is _bar:
        print(file=sys.stderr)
    return [rows[i] for i in sorted(rows)]


def _shared(
    meshes: list,
    n: int,
    options: dict,
    workers: Any,
    there: Callable,
    ended: Callable,
) -> None:
    """All poses decide the collapses: the signals are random mixtures of all their eigenvectors,
    since a sketch of all side by side has the metric of all. Then each pose gets the coarse mesh
    and is relocated by its own eigenvectors."""
    for name in (
        "signals",
        "keep",
        "coefficients",
        "fit_operators",
        "mask",
        "pre_simplify",
        "drop_debris",
        "intrinsic_delaunay",
    ):
        if options.get(name) is not None and options[name] is not False:
            raise ValueError(f"{name} is not for meshes of one connectivity: leave it out.")

    def chosen(name: str, otherwise: Any) -> Any:
        return otherwise if options.get(name) is None else options[name]

    preset = options.get("preset", "best")
    relocate = chosen("relocate", "none" if preset == "paper" else "sampled")
    if not isinstance(relocate, str) or relocate not in ("none", "sampled"):
        raise ValueError(
            f"relocate is {_shown(relocate)}, for meshes of one connectivity it must be 'none' or "
            "'sampled'."
        )
    prefer = _word("prefer", chosen("prefer", "spectrum"), ("spectrum", "shape"))
    if prefer == "shape" and relocate == "none":
        raise ValueError(
            "prefer='shape' is a matter of relocation, and nothing is relocated: leave it out, or "
            "pass relocate='sampled'."
        )
    if _flag("binary", options.get("binary", False)) and relocate == "sampled":
        raise ValueError(
            "binary asks for a P of ones and zeros, and relocation of each pose makes another one: "
            "pass relocate='none'."
        )
    first = None  # faces, and whose
    going: dict[int, Any] = {}
    for i, mesh in enumerate(meshes):
        try:
            V, F = _taken(mesh)
            V, F = _arrays(dict(V=V, F=F))
            if first is None:
                cleaned = clean(V, F)
                if cleaned.changes:
                    raise ValueError(
                        f"meshes of one connectivity must be usable as they are: "
                        f"{', '.join(cleaned.changes)} by clean()."
                    )
                first = V, F, i
            elif V.shape != first[0].shape or not numpy.array_equal(F, first[1]):
                raise ValueError(
                    f"it has not the faces of mesh {first[2]}: leave it out, or simplify "
                    "without shared_connectivity."
                )
            elif not numpy.isfinite(V).all():
                bad = int((~numpy.isfinite(V)).any(axis=1).argmax())
                raise ValueError(f"V[{bad}] is not finite: correct the position.")
            going[i] = (V, F)
        except Exception as error:
            ended(i, None, str(error), 0.0)
    if not going:
        return
    mass = chosen("mass", "lumped" if preset == "paper" else "averaged")
    k = chosen("k", 100)
    boundary = options.get("boundary", "neumann")
    threads = options.get("threads")
    pairs = {}
    for i, result, error, seconds in _scheduled(
        [(i, _pairs, (m, k, mass, boundary, threads)) for i, m in going.items()],
        workers,
    ):
        if error is None:
            pairs[i] = result
        else:
            del going[i]
            ended(i, None, error, seconds)
    if not going:
        return
    random = numpy.random.default_rng(1)
    signals = 0
    columns = min(max(k, 32), 100)
    for i in sorted(going):
        unit = numpy.sqrt(pairs[i].M.sum() / len(going))
        signals = signals + unit * pairs[i].vectors @ random.standard_normal(
            (k, columns)
        ) / numpy.sqrt(columns)
    one = min(going)
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        decided = {**options, "relocate": "none", "k": None, "prefer": None}
        run = simplify(*going[one], n, signals=signals, **decided)
    run.report["eigenvectors"] = k
    run._asked["prefer"] = prefer
    sampled = relocate == "sampled"

    missing = [i for i in going if not there(i)]
    if sampled and missing:  # the pose of the operator first: the others start where it ends
        level, error, seconds = _guarded(_posed, (going[one], run, pairs[one], True, threads))
        if one in missing:
            missing.remove(one)
            ended(one, level, error, seconds)
        if error is not None:
            for i in missing:
                ended(i, None, f"mesh {one}, where this one begins, was not relocated: {error}", 0.0)
            return
        run = run._from_state(dict(run._state(), V=level.V, P=level.P, _Q=None))
    tasks = [(i, _posed, (going[i], run, pairs[i], sampled, threads)) for i in missing]
    for i, result, error, seconds in _scheduled(tasks, workers):
        ended(i, result, error, seconds)
