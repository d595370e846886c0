# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# python_adapters_test.py FOLDER Adapters|Script: the adapters of the package against what pyFM and
# geomfum have, as far as the adapters use it; where these packages are installed they are used
# themselves. And the script, which needs Matplotlib.

import importlib.util
import os
import sys
import tempfile
import types
import unittest
import unittest.mock

import numpy as np

import spectral_simplification as ss
from python_shapes import sphere

if len(sys.argv) > 1:
    FOLDER = os.path.abspath(sys.argv.pop(1))


def record(names):
    """Modules by their names, each with its attributes."""
    for name, attributes in names.items():
        module = sys.modules[name] = types.ModuleType(name)
        vars(module).update(attributes)
        parent, _, child = name.rpartition(".")
        if parent:
            setattr(sys.modules[parent], child, module)


class TriMesh:  # of pyFM.mesh: setting vertices forgets the spectrum
    def __init__(self, vertices, faces):
        self.vertlist, self.facelist = np.array(vertices, float), np.array(faces)
        self.W = self.A = self.eigenvalues = self.eigenvectors = None

    def project(self, f):
        return self.eigenvectors.T @ (self.A @ f)


class Shape:  # of geomfum.shape
    def __init__(self, vertices, faces):
        self.vertices, self.faces, self.laplacian, self.basis = vertices, faces, None, None
        self.n_vertices = len(vertices)

    def set_basis(self, basis):
        self.basis = basis


class Laplacian:
    def __init__(self, shape, stiffness_matrix, mass_matrix):
        self.stiffness_matrix, self.mass_matrix = stiffness_matrix, mass_matrix


class Basis:
    def __init__(self, shape, vals, vecs):
        self.full_vals, self.full_vecs, self.shape = vals, vecs, shape

    @property
    def pinv(self):
        return self.full_vecs.T @ self.shape.laplacian.mass_matrix


class HierarchicalShape:
    def __init__(self, low, high):
        self.low, self.high = low, high

    def extend_basis(self):
        return self.scalar_low_high(self.low.basis.full_vecs.T).T


class HierarchicalMesh:
    known = {}

    @classmethod
    def register(cls, key, name, requires=(), as_default=False):
        assert importlib.util.find_spec(requires)
        cls.known[key] = name

    @classmethod
    def from_registry(cls, *arguments, which, **options):
        module = __import__("geomfum.wrap." + which, fromlist=[""])
        return getattr(module, cls.known[which])(*arguments, **options)


def matvecmul(matrix, vector):
    return matrix @ vector if vector.ndim == 1 else (matrix @ vector.T).T


def installed(name):
    try:
        importlib.import_module(name)
        return True
    except ImportError:
        for module in [m for m in sys.modules if m.partition(".")[0] == name.partition(".")[0]]:
            del sys.modules[module]
        return False


if not installed("pyFM.mesh"):
    record({"pyFM": {}, "pyFM.mesh": dict(TriMesh=TriMesh)})
if not installed("geomfum.shape.hierarchical"):
    record({"geomstats": {}, "geomfum": {}, "geomfum.wrap": {}, "geomfum.shape": {},
            "geomstats.backend": dict(array=np.array, to_numpy=np.asarray),
            "geomfum.backend": dict(sparse=types.SimpleNamespace(from_scipy_csc=lambda m: m)),
            "geomfum.linalg": dict(matvecmul=matvecmul),
            "geomfum.basis": dict(LaplaceEigenBasis=Basis),
            "geomfum.operator": dict(Laplacian=Laplacian),
            "geomfum._registry": dict(register_hierarchical_mesh=HierarchicalMesh.register),
            "geomfum.shape.mesh": dict(TriangleMesh=Shape),
            "geomfum.shape.hierarchical": dict(HierarchicalShape=HierarchicalShape,
                                               HierarchicalMesh=HierarchicalMesh)})

# From here on these names are the classes of the packages, where they are installed.
from geomfum.shape.hierarchical import HierarchicalMesh
from geomfum.shape.mesh import TriangleMesh
from pyFM.mesh import TriMesh
from spectral_simplification import geomfum_hierarchy, pyfm_mesh

V, F = sphere(3)


def hierarchy(mesh, **options):
    options.update(which="spectral_simplification", min_n_samples=150)
    return HierarchicalMesh.from_registry(mesh, **options)


class Adapters(unittest.TestCase):
    def test_pyFM(self):
        fine = TriMesh(V, F)
        coarse, run = pyfm_mesh.simplified(fine, 150, 30, preset="paper")
        self.assertEqual(len(coarse.vertlist), 150)
        for mesh in fine, coarse:
            phi = mesh.eigenvectors
            self.assertLess(abs(mesh.project(phi) - np.eye(30)).max(), 1e-6)
            self.assertLess(abs(mesh.W @ phi - mesh.A @ phi * mesh.eigenvalues).max(), 1e-4)
            phi *= -1  # they belong to the mesh, and can be written
        corners = run.V[run.F]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        self.assertAlmostEqual(coarse.A.sum(), np.linalg.norm(normals, axis=1).sum() / 2)
        self.assertLess(abs(coarse.A.sum() / fine.A.sum() - 1), 0.1)
        carried = np.diag(coarse.project(run.P @ fine.eigenvectors))[:10]
        self.assertLess(np.linalg.norm(abs(carried) - 1), 0.2)

    def test_pyFM_with_signals(self):
        fine = TriMesh(V, F)
        coarse, _ = pyfm_mesh.simplified(fine, 150, signals=V)
        shapes = fine.eigenvectors.shape, coarse.eigenvectors.shape
        self.assertEqual(shapes, ((642, 3), (150, 3)))

    def test_the_operator_is_that_of_the_run(self):
        coefficients = ss.weighted_coefficients(1 + V[:, 0]**2)
        coarse, run = pyfm_mesh.simplified(TriMesh(V, F), 150, k=200, coefficients=coefficients)
        self.assertEqual(coarse.eigenvectors.shape, (150, 150))  # fewer vertices than modes
        self.assertEqual(abs(coarse.A - run.coarse_eigenpairs().M).nnz, 0)
        both = hierarchy(TriangleMesh(V, F), spectrum_size=200, coefficients=coefficients)
        self.assertEqual(both.low.basis.full_vecs.shape, (150, 150))
        words = r"of 642 vertices take part.* pass TriMesh\(\*run.part"
        with self.assertRaisesRegex(ValueError, words):
            pyfm_mesh.simplified(TriMesh(V, F), 150, 30, mask=V[:, 0] < 1)

    def test_geomfum_with_signals(self):
        both = hierarchy(TriangleMesh(V, F), signals=V)
        self.assertEqual(both.low.basis.full_vecs.shape, (150, 3))

    def test_geomfum(self):
        mesh = TriangleMesh(V, F)
        both = hierarchy(mesh, spectrum_size=30, preset="paper")
        self.assertIsInstance(both, geomfum_hierarchy.SpectralHierarchicalMesh)
        self.assertIs(both.high, mesh)
        self.assertEqual(both.low.n_vertices, 150)
        self.assertEqual(both.scalar_low_high(np.ones((2, 150))).shape, (2, 642))
        self.assertLess(abs(both.scalar_low_high(np.ones(150)) - 1).max(), 1e-12)
        basis = both.low.basis
        self.assertLess(abs(basis.pinv @ basis.full_vecs - np.eye(30)).max(), 1e-6)
        extended = both.extend_basis()[:, :10]
        M = ss.eigenpairs(V, F, 10, "lumped").M
        self.assertLess(abs(extended.T @ (M @ extended) - np.eye(10)).max(), 0.1)


class Script(unittest.TestCase):
    def test_the_script(self):
        script, names = "simplify_match_plot.py", {}
        with open(os.path.join(FOLDER, script)) as file:
            code = compile(file.read(), script, "exec")
        words = [script, "X.off", "Y.off", "picture.png", "150"]
        self.addCleanup(os.chdir, os.getcwd())
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch("sys.argv", words):
            os.chdir(folder)
            for name, positions in ("X.off", V), ("Y.off", V * [1, 1, 1.05]):
                with open(name, "w") as file:
                    print("OFF\n%d %d 0" % (len(V), len(F)), file=file)
                    np.savetxt(file, positions)
                    np.savetxt(file, np.insert(F, 0, 3, axis=1), "%d")
            exec(code, names)
            self.assertGreater(os.path.getsize("picture.png"), 10000)
        self.assertLess(np.linalg.norm(V[names["matched"].map] - V, axis=1).mean(), 0.02)


if __name__ == "__main__":
    unittest.main()
