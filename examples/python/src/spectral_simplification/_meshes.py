# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Meshes as they come: from files, with faults, with vertices that are masked.

from __future__ import annotations

import base64
import numbers
import os
import pathlib
import warnings
import xml.etree.ElementTree
import zlib
from typing import Any

import numpy
import scipy.sparse
import scipy.sparse.csgraph

from . import _core
from ._results import (
    _array,
    _check_folder,
    _flag,
    _integer,
    _path,
    _rectangular,
    _Result,
    _shown,
    _written,
)


class Cleaned(_Result):
    """What clean() returns.

    Attributes
    ----------
    V : (n, 3) float64
        Positions.
    F : (m, 3) int32
        Triangles.
    place : (v,) int64
        New index of each vertex that was given; -1 if it was left out.
    origin : (n,) int64
        For each vertex, its index among those given.
    changes : list of str
        What was changed, with numbers; empty if nothing.
    """

    V: numpy.ndarray
    F: numpy.ndarray
    place: numpy.ndarray
    origin: numpy.ndarray
    changes: list

    def __repr__(self) -> str:
        return f"<Cleaned: {len(self.V)} vertices, {', '.join(self.changes) or 'nothing changed'}>"


class Diagnosis(_Result):
    """What diagnose() returns.

    Attributes
    ----------
    usable : bool
        Whether simplify() takes the mesh as it is.
    obstacles : list of str
        One clause for each kind of fault: how many, where first, what helps. The most elementary
        comes first.
    remarks : list of str
        What is unusual, but handled.
    components : list of (vertices, faces, closed, first vertex)
        The connected parts.
    """

    usable: bool
    obstacles: list
    remarks: list
    components: list

    def __repr__(self) -> str:
        return (
            f"<Diagnosis: {'usable' if self.usable else '; '.join(self.obstacles) or 'no faces'}>"
        )


def clean(V: numpy.ndarray, F: numpy.ndarray, repair: bool = False) -> Cleaned:
    """Cleans a mesh as the programs do automatically: reorients faces, leaves out isolated vertices
    and duplicate faces, closes edges of zero length. The surface stays as it is.

    Parameters
    ----------
    V : (v, 3) array
        Positions.
    F : (f, 3) array
        Triangles.
    repair : bool
        Also repairs as --repair does: merges vertices of equal position, closes cracks, separates
        sheets, removes faces.

    Returns
    -------
    Cleaned
        V, F, the index maps place and origin, and changes.

    Raises
    ------
    ValueError
        If the mesh cannot be used even then; it names the first obstacle.
    KeyboardInterrupt
        Ctrl-C ends a repair as well.

    Examples
    --------
    A tetrahedron with a face that is turned round, and a vertex without faces:

    >>> import numpy
    >>> V = numpy.array([[0, 0, 0], [9, 9, 9], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> F = numpy.array([[0, 3, 2], [0, 2, 4], [0, 4, 3], [2, 4, 3]])
    >>> diagnose(V, F).usable
    False
    >>> mesh = clean(V, F)
    >>> mesh.changes
    ['1 face turned round', '1 isolated vertex left out']
    >>> mesh.place, mesh.origin
    (array([ 0, -1,  1,  2,  3]), array([0, 2, 3, 4]))
    """
    return Cleaned._from_state(_core.clean(locals()))


def diagnose(V: numpy.ndarray, F: numpy.ndarray) -> Diagnosis:
    """Says what is wrong with a mesh, if anything. Changes nothing.

    Parameters
    ----------
    V : (v, 3) array
        Positions.
    F : (f, 3) array
        Triangles, with any fault.

    Returns
    -------
    Diagnosis
        usable, obstacles, remarks, components.

    Raises
    ------
    ValueError, TypeError
        If V and F are no arrays of these shapes.
    """
    return Diagnosis._from_state(_core.diagnose(locals()))


def _is_mesh(V: numpy.ndarray, F: numpy.ndarray) -> bool:
    return (
        V.ndim == 2
        and V.shape[1] == 3
        and V.dtype.kind in "fiu"
        and F.ndim == 2
        and F.shape[1] == 3
        and F.dtype.kind in "iu"
        and F.size != 0
        and F.min() >= 0
        and F.max() < len(V)
    )


def used_part(
    V: numpy.ndarray, F: numpy.ndarray, mask: Any
) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray] | None:
    """The vertices that faces use, within the mask, and these faces numbered by all vertices and
    by those; None where these are all, or V and F are no mesh, which is for others to say."""
    if not _is_mesh(V, F):
        return None
    if mask is not None:
        mask = _rectangular("mask", mask)
        if mask.dtype.kind in "iuf":
            other = numpy.flatnonzero((mask != 0) & (mask != 1))
            if other.size and mask.dtype.kind != "f":
                raise ValueError(
                    f"mask has the entry {mask.flat[other[0]]}, it must hold True for vertices "
                    "that stay: of their indices make m = numpy.zeros(len(V), bool); m[mask] = True."
                )
            if other.size:
                raise ValueError(
                    f"mask[{other[0]}] is {mask.flat[other[0]]}, it must be 1 for a vertex that "
                    "stays and 0 for others."
                )
            mask = mask.astype(bool)
        if mask.dtype.kind != "b":
            raise ValueError(
                f"mask has the dtype {mask.dtype}, it must hold booleans, True for vertices "
                "that stay."
            )
        if mask.shape != (len(V),):
            raise ValueError(
                f"mask has the shape {mask.shape}, it must be ({len(V)},), one for each vertex "
                "of V."
            )
        F = F[mask[F].all(axis=1)]
        if len(F) == 0:
            raise ValueError("mask leaves no face: a face stays where all of its corners do.")
    is_used = numpy.zeros(len(V), bool)
    is_used[F] = True
    if is_used.all():
        return None
    return numpy.flatnonzero(is_used), F, (numpy.cumsum(is_used) - 1)[F]


def without_debris(
    V: numpy.ndarray, F: numpy.ndarray, part: Any, share: float
) -> tuple[tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray] | None, numpy.ndarray]:
    """What used_part() returned, without components of less than a share of the area, and the
    first vertices of these."""
    if not isinstance(share, numbers.Real) or isinstance(share, bool) or not 0 < share < 1:
        raise ValueError(
            f"drop_debris is {_shown(share)}, it must be a share of the area in (0, 1)."
        )
    if not _is_mesh(V, F):
        return part, numpy.empty(0, numpy.int64)
    faces = F if part is None else part[1]
    if not numpy.isfinite(V[faces]).all():
        return part, numpy.empty(0, numpy.int64)  # which is for others to say, too
    a, b, c = (V[faces[:, i]] for i in range(3))
    areas = numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1) / 2
    sides = scipy.sparse.coo_matrix(
        (
            numpy.ones(2 * len(faces)),
            (numpy.repeat(faces[:, 0], 2), faces[:, 1:].ravel()),
        ),
        shape=(len(V), len(V)),
    )
    of_vertex = scipy.sparse.csgraph.connected_components(sides, directed=False)[1]
    area = numpy.bincount(of_vertex[faces[:, 0]], areas, minlength=of_vertex.max() + 1)
    stays = area[of_vertex[faces[:, 0]]] >= share * areas.sum()
    if stays.all():
        return part, numpy.empty(0, numpy.int64)
    if not stays.any():
        raise ValueError(
            f"no component has the share {share} of the area, which drop_debris asks for: lower it."
        )
    lost = numpy.unique(faces[~stays])
    first = lost[numpy.unique(of_vertex[lost], return_index=True)[1]]
    faces = faces[stays]
    is_used = numpy.zeros(len(V), bool)
    is_used[faces] = True
    return (
        (numpy.flatnonzero(is_used), faces, (numpy.cumsum(is_used) - 1)[faces]),
        numpy.sort(first),
    )


# Files. The compiled module reads what the programs read; nibabel, meshio and a few lines here
# the rest.

_OWN = ".off", ".obj", ".ply", ".stl"
_FREESURFER = (
    ".pial",
    ".white",
    ".inflated",
    ".sphere",
    ".orig",
    ".smoothwm",
    ".reg",
    ".midthickness",
)
_MESHIO = ".vtu", ".msh", ".xdmf", ".mesh", ".inp", ".vtk"


def _needed(package: str, path: Any):
    try:
        return __import__(package)
    except ImportError:
        raise ValueError(
            f"{path} needs the package {package}, which is not installed: pip install "
            f"{package}, or on Debian "
            f"apt-get install python3-{package}."
        ) from None


def _mesh(V: Any, F: Any, path: Any) -> tuple[numpy.ndarray, numpy.ndarray]:
    V, F = numpy.asarray(V, float), numpy.asarray(F)
    if V.ndim != 2 or V.shape[1] != 3 or F.ndim != 2 or F.shape[1] != 3 or len(F) == 0:
        raise ValueError(f"{path} holds no mesh of triangles.")
    return numpy.ascontiguousarray(V), numpy.ascontiguousarray(F, numpy.int64)


def read_mesh(path: Any, repair: bool = False) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Reads the triangles of a file as they are; see clean() for faults.

    Parameters
    ----------
    path : str or path
        .off, .obj, .ply, .stl; .vtk and .vtp of polygons; through nibabel .gii and FreeSurfer
        surfaces such as lh.pial; through meshio .vtu, .msh, .xdmf, .mesh, .inp and other .vtk.
    repair : bool
        Of .off, .obj, .ply and .stl: triangulates polygons, and does what --repair does.

    Returns
    -------
    V : (v, 3) float64
        Positions.
    F : (f, 3) int64
        Triangles.

    Raises
    ------
    ValueError
        If the file cannot be read, or the package is missing that reads it.
    FileNotFoundError
        If there is no such file.
    """
    return _read_mesh(path, repair)


def _read_mesh(
    path: Any, repair: bool = False, said: list | None = None
) -> tuple[numpy.ndarray, numpy.ndarray]:
    """read_mesh(), and adds what the repair changed to `said`."""
    path = pathlib.Path(_path(path))
    if not path.exists():
        raise FileNotFoundError(f"{path} does not exist.")
    ending = path.suffix.lower()
    repair = _flag("repair", repair)
    if repair and ending not in _OWN:
        raise ValueError(
            f"repair is for {', '.join(_OWN)}: read {path} without, and pass the arrays to clean()."
        )
    try:
        if ending in _OWN:
            V, F, changes = _core.read_mesh(str(path), repair)
            if said is not None:
                said.extend(changes)
            return _mesh(V, F, path)
        if ending == ".gii":
            arrays = _needed("nibabel", path).load(str(path))
            sets = [arrays.agg_data(intent) for intent in ("pointset", "triangle")]
            if any(isinstance(s, tuple) for s in sets):
                raise ValueError("it has no points or no triangles")
            return _mesh(*sets, path)
        if ending in _FREESURFER:
            _needed("nibabel", path)
            from nibabel.freesurfer import read_geometry

            return _mesh(*read_geometry(str(path))[:2], path)
        if ending == ".vtp":
            return _mesh(*_read_vtp(path), path)
        if ending == ".vtk" and b"POLYDATA" in path.read_bytes()[:1000]:
            return _mesh(*_read_vtk(path), path)
        if ending in _MESHIO:
            mesh = _needed("meshio", path).read(str(path))
            for kind in sorted({cells.type for cells in mesh.cells} - {"triangle"}):
                if kind.startswith(("quad", "polygon", "triangle")):  # a hole if left out
                    raise ValueError(f"it has faces of the kind {kind}: triangulate them first")
            return _mesh(mesh.points, mesh.cells_dict.get("triangle", ()), path)
    except ValueError as error:
        why = str(error)
        raise ValueError(
            why if str(path) in why else f"{path} cannot be read: {why.rstrip('.')}."
        ) from None
    except SystemExit:
        raise ValueError(f"{path} cannot be read: meshio does not know what is in it.") from None
    except Exception as error:
        if isinstance(error, MemoryError):
            raise
        raise ValueError(f"{path} cannot be read: {type(error).__name__}, {error}.") from None
    raise ValueError(_unknown(path))


def _unknown(path: pathlib.Path) -> str:
    return (
        f"{path} ends in {path.suffix!r}, which is not known: use {', '.join(_OWN)}, .vtk, "
        ".vtp, .gii, a surface of FreeSurfer "
        f"such as {_FREESURFER[0]}, or {', '.join(_MESHIO[:5])}."
    )


def _check_ending(path: pathlib.Path) -> str:
    """The ending of a file that write_mesh() can write."""
    ending = path.suffix.lower()
    if ending not in _OWN + _FREESURFER + _MESHIO + (".gii", ".vtp"):
        raise ValueError(_unknown(path))
    return ending


def _numbers(path: str, kind: type) -> numpy.ndarray:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # of no numbers, and of integers with a fraction
            numbers = (
                numpy.load(path, allow_pickle=False)
                if path.endswith(".npy")
                else numpy.loadtxt(path, kind, ndmin=1)
            )
        if not isinstance(numbers, numpy.ndarray) or numbers.dtype.kind not in "biuf":
            raise ValueError("it holds no array of numbers")
        return numbers
    except (ValueError, Warning) as error:
        said = str(error).partition("\n")[0].rstrip(".")
        raise ValueError(f"{path} cannot be read: {said}.") from None


def read_mask(path: Any, n: int) -> numpy.ndarray:
    """Reads which vertices take part, for mask=.

    Parameters
    ----------
    path : str or path
        Text or .npy with 1 for each vertex that takes part and 0 for the others; .gii with such
        values, or labels that are 0 elsewhere; a FreeSurfer .label of the vertices that take part.
        The last two need nibabel.
    n : int
        The number of vertices.

    Returns
    -------
    (n,) array of bool
        True for the vertices that take part.

    Raises
    ------
    ValueError
        If the file cannot be read, holds other numbers, or is of another number of vertices.
    FileNotFoundError
        If there is no such file.
    """
    path, n = _path(path), _integer("n", n, 1)
    if not os.path.exists(path):
        raise FileNotFoundError(f"{path} does not exist.")
    try:
        if path.endswith(".label"):
            _needed("nibabel", path)
            from nibabel.freesurfer import read_label

            named = read_label(path)
            found = numpy.isin(numpy.arange(max(n, named.max() + 1)), named)
        elif path.endswith(".gii"):
            found = _needed("nibabel", path).load(path).agg_data()
            if isinstance(found, tuple):
                raise ValueError(
                    f"{path} holds {len(found)} arrays, it must hold one, with a value for each "
                    "vertex."
                )
            found = numpy.asarray(found)
            found = found != 0 if found.dtype.kind in "iu" else found
        else:
            found = _numbers(path, float)
    except ValueError:
        raise
    except Exception as error:
        raise ValueError(f"{path} cannot be read: {type(error).__name__}, {error}.") from None
    if found.shape == (n, 1):
        found = found[:, 0]
    if found.shape != (n,):
        raise ValueError(f"{path} has the shape {found.shape}, it must be ({n},).")
    if not numpy.isin(found, (0, 1)).all():
        raise ValueError(f"{path} must hold 0 or 1 for each vertex.")
    return found.astype(bool)


def _structure(like: Any) -> dict:
    """What a surface of GIFTI says of the structure that it shows."""
    found = _needed("nibabel", like).load(like).get_arrays_from_intent("NIFTI_INTENT_POINTSET")
    if not found:
        raise ValueError(f"like is {like}, which holds no surface: pass one that does.")
    names = "AnatomicalStructurePrimary", "AnatomicalStructureSecondary", "GeometricType"
    return {name: found[0].meta[name] for name in names if name in found[0].meta}


def write_mesh(path: Any, V: numpy.ndarray, F: numpy.ndarray, like: Any = None) -> None:
    """Writes a mesh; the file appears complete or not at all.

    Parameters
    ----------
    path : str or path
        As in read_mesh().
    V : (v, 3) array
        Positions.
    F : (f, 3) array
        Triangles.
    like : str or path, optional
        For .gii: the GIFTI surface that was simplified, or another of the same structure. The file
        names that structure (CortexLeft), which Connectome Workbench asks for.

    Raises
    ------
    ValueError
        If the ending is not known, the package is missing that writes it, or V and F are no mesh;
        if like is not for this ending, or is no surface.
    FileNotFoundError
        If its folder does not exist, or like.
    """
    path = pathlib.Path(_path(path))
    _check_folder(str(path))
    V, F = _array("V", V), _array("F", F, "iu")
    for name, array, rows in ("V", V, "vertex"), ("F", F, "triangle"):
        if array.ndim != 2 or array.shape[1] != 3 or len(array) == 0:
            raise ValueError(
                f"{name} has the shape {array.shape}, it must be (n, 3), one row for each {rows}."
            )
    V, F = _mesh(V, F, path)
    if F.min() < 0 or F.max() >= len(V):
        face, corner = numpy.argwhere((F < 0) | (F >= len(V)))[0]
        raise ValueError(
            f"F[{face}, {corner}] is {F[face, corner]}, but V has {len(V)} vertices: they are "
            "counted from 0."
        )
    if not numpy.isfinite(V).all():
        vertex = int((~numpy.isfinite(V)).any(axis=1).argmax())
        raise ValueError(f"V[{vertex}] is not finite: correct the position.")
    ending = _check_ending(path)
    if like is not None:
        for file in str(path), _path(like):
            if not file.lower().endswith(".gii"):
                raise ValueError(f"like is for files of GIFTI, {file} does not end in '.gii'.")
    if ending == ".gii" or ending in _FREESURFER:
        _needed("nibabel", path)
    elif ending in _MESHIO and ending != ".vtk":
        _needed("meshio", path)
        if ending == ".xdmf":
            _needed("h5py", path)  # which meshio imports whether it writes HDF or not
    with _written(str(path)) as temporary:
        if ending == ".gii":
            import nibabel

            array = nibabel.gifti.GiftiDataArray
            structure = {} if like is None else _structure(_path(like))
            points = array(
                V.astype(numpy.float32),
                "NIFTI_INTENT_POINTSET",
                "NIFTI_TYPE_FLOAT32",
                meta=nibabel.gifti.GiftiMetaData(structure),
            )
            triangles = array(F.astype(numpy.int32), "NIFTI_INTENT_TRIANGLE", "NIFTI_TYPE_INT32")
            nibabel.save(nibabel.gifti.GiftiImage(darrays=[points, triangles]), temporary)
        elif ending in _FREESURFER:
            from nibabel.freesurfer import write_geometry

            write_geometry(temporary, V, F)
        elif ending in _MESHIO and ending != ".vtk":
            import meshio

            # The format's own default are further files, named as the temporary one.
            inline = {"data_format": "XML"} if ending == ".xdmf" else {}
            meshio.Mesh(V, [("triangle", F)]).write(temporary, **inline)
        else:
            with open(temporary, "w") as file:
                {
                    ".off": _write_off,
                    ".obj": _write_obj,
                    ".ply": _write_ply,
                    ".stl": _write_stl,
                    ".vtk": _write_vtk,
                    ".vtp": _write_vtp,
                }[ending](file, V, F)


def _rows(file: Any, array: numpy.ndarray, begin: str = "") -> None:
    form = "%.17g" if array.dtype.kind == "f" else "%d"
    numpy.savetxt(file, array, fmt=begin + " ".join([form] * array.shape[1]))


def _write_off(file, V, F):
    file.write(f"OFF\n{len(V)} {len(F)} 0\n")
    _rows(file, V)
    _rows(file, F, "3 ")


def _write_obj(file, V, F):
    _rows(file, V, "v ")
    _rows(file, F + 1, "f ")


def _write_ply(file, V, F):
    file.write(
        f"ply\nformat ascii 1.0\nelement vertex {len(V)}\nproperty double x\nproperty double "
        "y\nproperty double z\n"
        f"element face {len(F)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    _rows(file, V)
    _rows(file, F, "3 ")


def _write_stl(file, V, F):
    file.write("solid mesh\n")
    for a, b, c in V[F]:
        file.write(
            "facet normal 0 0 0\nouter loop\n"
            + "".join("vertex %.9g %.9g %.9g\n" % tuple(p) for p in (a, b, c))
            + "endloop\nendfacet\n"
        )
    file.write("endsolid mesh\n")


def _write_vtk(file, V, F):
    file.write(
        f"# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET POLYDATA\nPOINTS {len(V)} double\n"
    )
    _rows(file, V)
    file.write(f"POLYGONS {len(F)} {4 * len(F)}\n")
    _rows(file, F, "3 ")


def _write_vtp(file, V, F):
    def array(kind, name, values, more=""):
        file.write(f'<DataArray type="{kind}" Name="{name}" {more}format="ascii">\n')
        _rows(file, values)
        file.write("</DataArray>\n")

    file.write(
        '<?xml version="1.0"?>\n<VTKFile type="PolyData" version="0.1" '
        'byte_order="LittleEndian">\n<PolyData>\n'
        f'<Piece NumberOfPoints="{len(V)}" NumberOfPolys="{len(F)}">\n<Points>\n'
    )
    array("Float64", "Points", V, 'NumberOfComponents="3" ')
    file.write("</Points>\n<Polys>\n")
    array("Int64", "connectivity", F)
    array("Int64", "offsets", 3 * numpy.arange(1, len(F) + 1)[:, None])
    file.write("</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n")


def _triangles(counts: numpy.ndarray, corners: numpy.ndarray) -> numpy.ndarray:
    if not (counts == 3).all():
        raise ValueError(
            f"polygon {int((counts != 3).argmax())} is no triangle: triangulate it first"
        )
    return corners.reshape(-1, 3)


def _read_vtk(path: pathlib.Path):
    """Polygons of the legacy format, in text or in binary."""
    data = path.read_bytes()
    lines = data.split(b"\n", 3)
    binary = lines[2].strip().upper() == b"BINARY"
    kinds = {b"float": ">f4", b"double": ">f8", b"int": ">i4", b"vtktypeint64": ">i8"}

    def head(word: bytes, start: int = 0) -> tuple[list[bytes], int]:
        """The words of the line that begins so, and where it ends."""
        place = data.find(b"\n" + word + b" ", start)
        if place < 0:
            raise ValueError(f"it has no {word.decode()}")
        end = data.index(b"\n", place + 1)
        return data[place:end].split(), end

    def values(count: int, kind: bytes, end: int) -> numpy.ndarray:
        if kind not in kinds:
            raise ValueError(f"it has numbers of the type {kind.decode()}")
        real = "f" in kinds[kind]
        if binary:
            result = numpy.frombuffer(data, kinds[kind], count, end + 1)
        else:
            words = data[end:].split(None, count)[:count]
            result = numpy.array(words, float if real else numpy.int64)
        if len(result) != count:
            raise ValueError("it ends too early")
        return result.astype(float if real else numpy.int64)

    (_, count, kind), end = head(b"POINTS")
    V = values(3 * int(count), kind, end).reshape(-1, 3)
    (_, first, second), end = head(b"POLYGONS")
    if data[end:].lstrip().startswith(b"OFFSETS"):  # from version 5 on
        (_, kind), start = head(b"OFFSETS", end)
        counts = numpy.diff(values(int(first), kind, start))
        (_, kind), start = head(b"CONNECTIVITY", end)
        return V, _triangles(counts, values(int(second), kind, start))
    faces = values(int(second), b"int", end)
    if len(faces) % 4 or (faces[::4] != 3).any():
        raise ValueError("its polygons are not all triangles: triangulate them first")
    return V, faces.reshape(-1, 4)[:, 1:]


def _read_vtp(path: pathlib.Path):
    """Polygons of VTK's XML, in text or inline binary."""
    root = xml.etree.ElementTree.parse(path).getroot()
    order = "<" if root.get("byte_order", "LittleEndian") == "LittleEndian" else ">"
    header = numpy.dtype(order + ("u8" if root.get("header_type") == "UInt64" else "u4"))
    pieces = root.findall("./PolyData/Piece")
    if len(pieces) != 1:
        raise ValueError(f"it has {len(pieces)} pieces of PolyData: write it as one")
    (piece,) = pieces

    def values(where: str, name: str | None) -> numpy.ndarray:
        for element in piece.findall(f"./{where}/DataArray"):
            if name is None or element.get("Name") == name:
                kind = element.get("type", "")
                dtype = numpy.dtype(
                    order
                    + {"Float": "f", "Int": "i", "UInt": "u"}[kind.rstrip("0123456789")]
                    + str(int(kind.lstrip("FloatUIn")) // 8)
                )
                text = (element.text or "").strip()
                if element.get("format") == "ascii":
                    return numpy.array(text.split(), dtype)
                if element.get("format") != "binary":
                    raise ValueError("its data are appended: write it with inline data")
                return numpy.frombuffer(_decoded(text, header, root.get("compressor")), dtype)
        raise ValueError(f"it has no {name or where}")

    counts = numpy.diff(values("Polys", "offsets").astype(numpy.int64), prepend=0)
    return values("Points", None).reshape(-1, 3), _triangles(
        counts, values("Polys", "connectivity")
    )


def _decoded(text: str, header: numpy.dtype, compressor: str | None) -> bytes:
    size = header.itemsize
    if not compressor:
        return base64.b64decode(text)[size:]
    if compressor != "vtkZLibDataCompressor":
        raise ValueError(f"it is compressed by {compressor}: write it with zlib")

    def length(n):  # of n bytes in base64
        return 4 * ((n + 2) // 3)

    blocks = int(numpy.frombuffer(base64.b64decode(text[: length(size)])[:size], header)[0])
    first = length((3 + blocks) * size)
    sizes = numpy.frombuffer(base64.b64decode(text[:first]), header)[3:]
    data, result, at = base64.b64decode(text[first:]), b"", 0
    for n in sizes:
        result += zlib.decompress(data[at : at + int(n)])
        at += int(n)
    return result
