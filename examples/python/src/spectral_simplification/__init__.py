# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
"""Simplifies triangle meshes and keeps the spectrum of their Laplacian (Lescoat et al., Spectral
Mesh Simplification, 2020). Input and output are NumPy arrays, matrices are SciPy sparse matrices.

    run = simplify(V, F, 600)
    run.V, run.F, run.P

Options have the names, defaults and words of the program spectral_simplify. Computations let
other threads of Python run.
"""

import typing as _typing

from ._collection import Collection_row, simplify_collection
from ._core import Cancelled, __version__
from ._interface import (
    curvature_coefficients,
    distances,
    eigenpairs,
    eigsh,
    evaluate,
    fit_operators,
    functional_map,
    heat_kernel_signature,
    match,
    rows_off_their_part,
    simplify,
    wave_kernel_energies,
    wave_kernel_signature,
    weighted_coefficients,
)
from ._maps import (
    align,
    functional_map_of_point_map,
    lift_functional_map,
    lift_point_map,
    point_map,
    zoom_out,
)
from ._meshes import Cleaned, Diagnosis, clean, diagnose, read_mask, read_mesh, write_mesh
from ._results import (
    Alignment,
    Eigenpairs,
    Evaluation,
    Fitted_operators,
    Level,
    Match,
    Simplification,
    load,
)

__all__ = [
    "Alignment",
    "Cancelled",
    "Cleaned",
    "Collection_row",
    "Diagnosis",
    "Eigenpairs",
    "Evaluation",
    "Fitted_operators",
    "Level",
    "Match",
    "Simplification",
    "align",
    "clean",
    "curvature_coefficients",
    "diagnose",
    "distances",
    "eigenpairs",
    "eigsh",
    "evaluate",
    "fit_operators",
    "functional_map",
    "functional_map_of_point_map",
    "heat_kernel_signature",
    "lift_functional_map",
    "lift_point_map",
    "load",
    "match",
    "point_map",
    "read_mask",
    "read_mesh",
    "rows_off_their_part",
    "simplify",
    "simplify_collection",
    "wave_kernel_energies",
    "wave_kernel_signature",
    "weighted_coefficients",
    "write_mesh",
    "zoom_out",
]

for _thing in list(globals().values()):  # whoever prints or pickles them finds them here
    if getattr(_thing, "__module__", "").startswith(__name__ + "._"):
        if isinstance(_thing, type):  # whose annotations have names of the module that it leaves
            _hints = _typing.get_type_hints(_thing)
            for _name in vars(_thing).get("__annotations__", ()):
                _thing.__annotations__[_name] = _hints[_name]
        _thing.__module__ = __name__
del _thing, _hints, _name


def __dir__() -> list:
    return __all__ + ["__version__", "__doc__"]
