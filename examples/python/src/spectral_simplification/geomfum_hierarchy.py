# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# For geomfum (github.com/luisfpereira/geomfum): a hierarchical mesh, in the place that ReMatching
# has in its registry.
#
#     import spectral_simplification.geomfum_hierarchy
#     hmesh = HierarchicalMesh.from_registry(mesh, which="spectral_simplification",
# min_n_samples=1000)
#     hmesh.extend_basis()
#
# The low mesh has its Laplacian and its basis already. Call find_spectrum(recompute=True) for
# another.

import sys

import geomfum.backend as xgs
import geomfum.linalg as la
import geomstats.backend as gs
import geomfum.wrap  # its own implementations register first
from geomfum._registry import register_hierarchical_mesh
from geomfum.basis import LaplaceEigenBasis
from geomfum.operator import Laplacian
from geomfum.shape.hierarchical import HierarchicalShape
from geomfum.shape.mesh import TriangleMesh

import spectral_simplification as ss


class SpectralHierarchicalMesh(HierarchicalShape):
    """The mesh and its simplification to min_n_samples vertices, which keeps spectrum_size
    eigenpairs. `run` is the result of simplify(). Options as in
    spectral_simplification.simplify()."""

    def __init__(self, mesh, min_n_samples, spectrum_size=None, **options):
        V, F = gs.to_numpy(mesh.vertices), gs.to_numpy(mesh.faces)
        self.run = run = ss.simplify(V, F, min_n_samples, spectrum_size, **options)
        pairs = run.coarse_eigenpairs()
        low = TriangleMesh(gs.array(run.V), gs.array(run.F))
        low.laplacian = Laplacian(
            low, *(xgs.sparse.from_scipy_csc(m.tocsc()) for m in (pairs.L, pairs.M))
        )
        low.set_basis(LaplaceEigenBasis(low, gs.array(pairs.values), gs.array(pairs.vectors)))
        self._prolongation = xgs.sparse.from_scipy_csc(run.Q.tocsc())
        super().__init__(low=low, high=mesh)

    def scalar_low_high(self, scalar):
        return la.matvecmul(self._prolongation, scalar)


# The registry looks for a module of its own.
sys.modules["geomfum.wrap.spectral_simplification"] = sys.modules[__name__]
register_hierarchical_mesh(
    "spectral_simplification", "SpectralHierarchicalMesh", requires="spectral_simplification"
)
