# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# For pyFM (github.com/RobinMagnet/pyFM): meshes with eigenpairs that are ready, and the coarse
# mesh of one.
#
#     from spectral_simplification.pyfm_mesh import simplified
#     fine = TriMesh("cat.off")
#     coarse, run = simplified(fine, 600)
#     model = FunctionalMapping(coarse, other_coarse)
#     model.preprocess(n_ev=(50, 50), k_process=100)
#
# pyFM uses A in products alone, so the averaged mass, which is not diagonal, works; pass A, not its
# diagonal. By default pyFM calls process(200), see k_process. With fewer eigenpairs than it asks
# for it computes W and A anew, lumped.

from pyFM.mesh import TriMesh

import spectral_simplification as ss


def trimesh(V, F, pairs):
    """The TriMesh of V and F with L as W, M as A, and the eigenpairs of both."""
    mesh = TriMesh(V, F)
    mesh.W, mesh.A = pairs.L.tocsc(), pairs.M.tocsc()
    mesh.eigenvalues, mesh.eigenvectors = pairs.values.copy(), pairs.vectors.copy()
    return mesh


def simplified(mesh, n, k=None, **options):
    """Returns the TriMesh of n vertices, with k eigenpairs in the mass of the run (n if n < k), and
    the run. run.P carries functions of `mesh` to it, run.Q carries them back, and run.vertex_map
    says which vertex became which. `mesh` gets W, A and the k eigenpairs of the run as well.
    Options as in spectral_simplification.simplify()."""
    run = ss.simplify(mesh.vertlist, mesh.facelist, n, k, **options)
    if len(run.used) != len(mesh.vertlist):
        raise ValueError(
            f"{len(run.used)} of {len(mesh.vertlist)} vertices take part, and a spectrum of pyFM "
            "has a row for each: pass TriMesh(*run.part()), of run = simplify() with these options."
        )
    k, pairs = run.report["eigenvectors"], run.fine_eigenpairs
    mesh.W, mesh.A = pairs.L.tocsc(), pairs.M.tocsc()
    mesh.eigenvalues, mesh.eigenvectors = pairs.values[:k].copy(), pairs.vectors[:, :k].copy()
    return trimesh(run.V, run.F, run.coarse_eigenpairs()), run
