# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# python_test.py [SPECTRAL_SIMPLIFY]: the Python module beside the program, on shapes that are made
# here.

import contextlib
import inspect
import io
import json
import math
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import tracemalloc
import unittest
import warnings

import numpy as np
import scipy.io
import scipy.sparse

import spectral_simplification as ss
from python_shapes import sheet, sphere

PROGRAM = None
V, F = sphere(4)
RUN = ss.simplify(V, F, 200, 50)


class Shapes(unittest.TestCase):
    V, F, run_ = V, F, RUN

    def close(self, a, b, tolerance=1e-9):
        self.assertEqual(np.shape(a), np.shape(b))
        largest = abs(b).max() if np.ndim(b) or scipy.sparse.issparse(b) else abs(b)
        difference = abs(a - b)
        self.assertLessEqual(difference.max() if np.ndim(difference) or scipy.sparse.issparse(difference) else difference,
                             tolerance * max(1, largest))


class Beside_the_program(Shapes):
    def program(self, *options):
        with open(os.path.join(self.folder, "in.off"), "w") as file:
            file.write("OFF\n%d %d 0\n" % (len(self.V), len(self.F)))
            file.writelines("%.17g %.17g %.17g\n" % tuple(v) for v in self.V)
            file.writelines("3 %d %d %d\n" % tuple(f) for f in self.F)
        subprocess.run([PROGRAM, "in.off", "out.off", "--vertices", "200", "--eigenvectors", "50", "--quiet", *options],
                       cwd=self.folder, check=True)

    def setUp(self):
        if PROGRAM is None:
            self.fail("the first argument must be the program spectral_simplify")
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = self.temporary.name
        self.addCleanup(self.temporary.cleanup)

    def mesh(self, name="out.off"):
        with open(os.path.join(self.folder, name)) as file:
            words = file.read().split()
        n, m = int(words[1]), int(words[2])
        V = np.array(words[4:4 + 3 * n], float).reshape(n, 3)
        return V, np.array(words[4 + 3 * n:4 + 3 * n + 4 * m], int).reshape(m, 4)[:, 1:]

    def matrix(self, name):
        return scipy.io.mmread(os.path.join(self.folder, name)).tocsr()

    def array(self, name):
        return np.load(os.path.join(self.folder, name))

    def check_mesh(self, level, suffix=""):
        V, F = self.mesh("out%s.off" % suffix)
        self.close(level.V, V)
        np.testing.assert_array_equal(level.F, F)
        self.close(level.P, self.matrix("P%s.mtx" % suffix))
        np.testing.assert_array_equal(level.vertex_map, np.loadtxt(os.path.join(self.folder, "map%s.txt" % suffix)))

    def same_report(self, report, said):
        for name, value in report.items():
            if isinstance(value, dict):
                self.same_report(value, said[name])
            elif name.startswith("seconds"):
                self.assertGreaterEqual(said[name], 0)
            elif isinstance(value, float):
                self.close(value, said[name])
            else:
                self.assertEqual(value, said[name], name)

    def test_everything_of_a_run(self):
        self.program("--restriction", "P.mtx", "--prolongation", "Q.mtx", "--map", "map.txt", "--eigenpairs", "pairs",
                     "--fit-operators", "fitted", "--levels", "1000,400", "--json", "out.json")
        # The program counts from its largest level.
        run = ss.simplify(self.V, self.F, 200, 50, quadrics_above=5 * self.run_.report["quadrics_above"])
        self.check_mesh(run)
        for n in (1000, 400):
            self.check_mesh(run.levels(n), "-%d" % n)
        self.close(run.Q, self.matrix("Q.mtx"))
        self.close(run.eigenpairs.L, self.matrix("pairs/fine_L.mtx"))
        self.close(run.eigenpairs.M, self.matrix("pairs/fine_mass.mtx"))
        self.close(run.eigenpairs.values, self.array("pairs/fine_eigenvalues.npy"))
        self.close(run.eigenpairs.vectors, self.array("pairs/fine_eigenvectors.npy"))
        coarse = ss.eigenpairs(run.V, run.F, 50)
        self.close(coarse.L, self.matrix("pairs/coarse_L.mtx"))
        self.close(abs(ss.functional_map(run.eigenpairs, coarse, run.P)), abs(self.array("pairs/C.npy")), 1e-6)
        with open(os.path.join(self.folder, "out.json")) as file:
            said = json.load(file)
        self.same_report(run.report, said)
        own = ss.evaluate(self.V, self.F, run.V, run.F, run.P, 50, eigenpairs=run.eigenpairs)
        fitted = ss.fit_operators(run.V, run.F, run.P, ss.eigenpairs(self.V, self.F, 60), 55)
        self.close(fitted.L, self.matrix("fitted/L.mtx"), 1e-5) # the program's mesh has its digits from a file
        self.close(fitted.M, self.matrix("fitted/mass.mtx"), 1e-5)
        self.close(fitted.values[:50], self.array("fitted/eigenvalues.npy"), 1e-6)
        of_fitted = ss.evaluate(self.V, self.F, run.V, run.F, run.P, 50, eigenpairs=run.eigenpairs, operators=fitted)
        for e, figures in ((own, said), (of_fitted, said["fitted"])):
            for name, value in (("norm_L", e.C_L), ("norm_D", e.C_D), ("eigenvalue_error_mean", e.eigenvalue_error),
                                ("eigenvalue_error_max", e.eigenvalue_error_max), ("area_ratio", e.area_ratio),
                                ("eigenvalue_error_low_mean", e.eigenvalue_error_low), ("span_loss", e.span_loss)):
                self.close(value, figures[name], 3e-6)
        self.assertLess(of_fitted.C_L, own.C_L)
        self.assertLess(of_fitted.eigenvalue_error, own.eigenvalue_error)

    def test_attributes(self):
        rng, n = np.random.default_rng(5), len(self.V)
        colours, labels = rng.integers(0, 256, (n, 3), np.uint8), rng.integers(-3, 4, n)
        numbers = rng.random(n)
        names = "double x", "double y", "double z", "uchar red", "uchar green", "uchar blue", "int label", "double heat", \
            "double nx", "double ny", "double nz"
        with open(os.path.join(self.folder, "in.ply"), "w") as file:
            file.write("ply\nformat ascii 1.0\nelement vertex %d\n%s\nelement face %d\n" %
                       (n, "\n".join("property " + name for name in names), len(self.F)))
            file.write("property list uchar int vertex_indices\nend_header\n")
            for v, c, l, h in zip(self.V, colours, labels, numbers):
                file.write(" ".join("%.17g" % x for x in (*v, *c, l, h, *v)) + "\n")
            file.writelines("3 %d %d %d\n" % tuple(f) for f in self.F)
        subprocess.run([PROGRAM, "in.ply", "out.ply", "--vertices", "200", "--eigenvectors", "50", "--quiet", "--no-evaluation"],
                       cwd=self.folder, check=True)
        with open(os.path.join(self.folder, "out.ply"), "rb") as file:
            header, data = file.read().split(b"end_header\n", 1)
        kinds = {"double": "<f8", "uchar": "u1", "int": "<i4"}
        lines = header.decode().split("element face")[0].split("\n")
        fields = [line.split()[1:] for line in lines if line.startswith("property")]
        out = np.frombuffer(data, [(name, kinds[kind]) for kind, name in fields], 200)
        run = self.run_
        self.close(np.c_[out["x"], out["y"], out["z"]], run.V)
        carried = run.interpolate(colours)
        self.assertEqual(carried.dtype, np.uint8)
        np.testing.assert_array_equal(carried, np.c_[out["red"], out["green"], out["blue"]])
        np.testing.assert_array_equal(run.transfer_labels(labels), out["label"])
        self.close(run.interpolate(numbers), out["heat"])
        self.close(run.interpolate(self.V, unit=True), np.c_[out["nx"], out["ny"], out["nz"]])

    def test_the_options_have_their_meaning(self):
        self.V, self.F = sphere(3)
        signals, keep = self.V[:, :2] ** 2, [7, 400]
        np.save(os.path.join(self.folder, "F.npy"), signals)
        np.savetxt(os.path.join(self.folder, "keep.txt"), keep, "%d")
        weights = np.exp(self.V[:, 1:])
        np.save(os.path.join(self.folder, "W.npy"), weights)
        outputs = "--restriction", "P.mtx", "--map", "map.txt", "--no-evaluation"
        for options, arguments in (
                ("--preset paper --keep keep.txt --shape 1", dict(preset="paper", keep=keep, shape=1)),
                ("--mass lumped --placement midpoint --relocate carried --binary",
                 dict(mass="lumped", placement="midpoint", relocate="carried", binary=True)),
                ("--signals F.npy --self-intersections allow",
                 dict(signals=signals, self_intersections="allow")),
                ("--operator anisotropic:2 --mass voronoi --relocate none",
                 dict(coefficients=ss.curvature_coefficients(self.V, self.F, 2), mass="voronoi", relocate="none")),
                ("--operator weighted:W.npy", dict(coefficients=ss.weighted_coefficients(*weights.T))),
                ("--preset fast --pre-simplify 400", dict(preset="fast", pre_simplify=400)),
                ("--quadrics-above 2", dict(quadrics_above=2)),
                ("--quadrics-above inf --preserve-border", dict(quadrics_above=math.inf, preserve_border=True)),
                ("--preset fast", dict(preset="fast")), # which is best on a mesh as small as this one
                ("--pre-simplify 500 --relocate carried_and_sampled --max-error 0.05 --preserve-border",
                 dict(pre_simplify=500, relocate="carried_and_sampled", max_error=0.05, preserve_border=True)),
                ("--prefer shape", dict(prefer="shape"))):
            if "signals" not in arguments:
                arguments["k"] = 50
            with self.subTest(options), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                self.program(*options.split(), *outputs)
                self.check_mesh(ss.simplify(self.V, self.F, 200, **arguments))
        run, shaped = (ss.simplify(self.V, self.F, 200, 50, prefer=word) for word in ("spectrum", "shape"))
        self.assertEqual([r.report["relocation"]["hausdorff_goal"] for r in (run, shaped)], [0.8, 0.5])
        self.assertGreater(abs(run.V - shaped.V).max(), 0)
        plain, nearer = (r.apply(self.V, by="merges", relocate=True) for r in (run, shaped))
        np.testing.assert_array_equal(run.vertex_map, shaped.vertex_map)
        self.assertGreater(abs(plain.V - nearer.V).max(), 0)


class Results(Shapes):
    def test_eigenpairs(self):
        pairs = ss.eigenpairs(self.V, self.F, 20, "lumped")
        phi, L, M = pairs.vectors, pairs.L, pairs.M
        self.assertTrue(scipy.sparse.isspmatrix_csr(L) and M.nnz == len(self.V) and len(pairs) == 20)
        self.close(phi.T @ (M @ phi), np.eye(20))
        self.assertLess(abs(L @ phi - M @ phi * pairs.values).max(), 1e-6)
        self.assertEqual((pairs.zeros, pairs.mass, pairs.complete), (1, "lumped", True))
        further = ss.eigenpairs(self.V, self.F, 30, "lumped").values[20:]
        n = len(pairs.further_values)
        self.assertGreater(n, 2)
        self.close(pairs.further_values / further[:n], np.ones(n), 1e-3)
        two = ss.eigenpairs(np.vstack([self.V, self.V + 9]), np.vstack([self.F, self.F + len(self.V)]), 5)
        self.assertEqual(two.zeros, 2)
        with self.assertWarnsRegex(UserWarning, "did not reach their tolerance of 1e-15, the largest residual is"):
            self.assertFalse(ss.eigenpairs(self.V, self.F, 20, tolerance=1e-15).complete)
        with self.assertWarnsRegex(UserWarning, "ask for a larger tolerance"):
            ss.eigsh(L, M, 20, tolerance=1e-15)

    def test_restriction_and_prolongation(self):
        run = self.run_
        self.close(run.P @ np.ones(len(self.V)), np.ones(200))
        self.close(run.Q @ np.ones(200), np.ones(len(self.V)))
        self.assertLess(abs(run.Q @ run.V - self.V).max(), 0.2)
        self.assertEqual((run.V.dtype, run.F.dtype, run.vertex_map.dtype), (np.float64, np.int32, np.int64))

    def test_what_vertices_have_is_carried(self):
        for level in self.run_, self.run_.levels(700):
            self.close(level.interpolate(self.V), level.P @ self.V)
            self.close(level.interpolate(self.V[:, 0].astype(np.float32)), level.P @ self.V[:, 0], 1e-6)
            normals = level.interpolate(self.V, unit=True)
            self.close(np.linalg.norm(normals, axis=1), np.ones(len(level.V)))
            self.assertLess(abs(normals - level.V / np.linalg.norm(level.V, axis=1, keepdims=True)).max(), 0.05)
            side = np.where(self.V[:, 0] > 0, "east", "west")
            away = abs(level.V[:, 0]) > 0.1
            np.testing.assert_array_equal(level.transfer_labels(side)[away],
                                          np.where(level.V[:, 0] > 0, "east", "west")[away])
        ends = self.run_.interpolate(np.full(len(self.V), 255, np.uint8))
        self.assertTrue((ends == 255).all() and ends.dtype == np.uint8)

    def test_fitted_operators_of_one_call(self):
        run = ss.simplify(self.V, self.F, 200, 50, fit_operators=True)
        self.close(run.V, self.run_.V)
        self.assertIsNone(self.run_.fitted)
        self.assertEqual((len(run.fitted), run.fitted.mass), (50, "edges"))
        alone = ss.fit_operators(run.V, run.F, run.P, ss.eigenpairs(self.V, self.F, 60, tolerance=1e-8), 50)
        self.close(run.fitted.L, alone.L, 1e-5)
        self.close(run.fitted.values, alone.values, 1e-5)
        self.assertLess(run.fitted.objective_after, run.fitted.objective_before)
        judged = [ss.evaluate(self.V, self.F, run.V, run.F, run.P, 50, eigenpairs=run.eigenpairs, operators=o)
                  for o in (run.fitted, None)]
        self.assertLess(judged[0].C_L, 0.9 * judged[1].C_L)
        lumped = ss.simplify(self.V, self.F, 200, 30, "paper", fit_operators=True)
        self.assertEqual(lumped.fitted.mass, "diagonal")

    def test_distances_are_what_numpy_finds(self):
        pairs = self.run_.eigenpairs
        phi, values = pairs.vectors[:, 1:], pairs.values[1:]
        squares = (phi - phi[3]) ** 2
        self.close(ss.distances(pairs, 3), squares @ values ** -2)
        self.close(ss.distances(pairs, 3, "commute_time"), squares @ (1 / values))
        self.close(ss.distances(pairs, [4, 3], "diffusion", time=0.1)[:, 1], squares @ np.exp(-0.2 * values))
        self.close(ss.distances(pairs, 3, "diffusion"), squares @ np.exp(-values / (2 * values[0])))
        energies = ss.wave_kernel_energies(pairs, 30)
        kernel = ss.wave_kernel_signature(pairs, energies)
        change = abs(kernel - kernel[3]) / (kernel + kernel[3])
        self.close(ss.distances(pairs, 3, "wave_kernel", energies=energies),
                   np.trapz(change, np.linspace(energies[0], energies[1], 30), axis=1))
        points = scipy.sparse.csr_matrix(([1, 0.25, 0.75], ([0, 1, 1], [3, 4, 9])), (2, len(phi)))
        at_point = ss.distances(pairs, points)
        self.close(at_point[:, 0], ss.distances(pairs, 3))
        self.close(at_point[:, 1], (phi - 0.25 * phi[4] - 0.75 * phi[9]) ** 2 @ values ** -2)
        self.close(ss.heat_kernel_signature(pairs, [0.1, 1]),
                   pairs.vectors ** 2 @ np.exp(-np.outer(pairs.values, [0.1, 1])))

    def test_functional_maps(self):
        run, coarse = self.run_, ss.eigenpairs(self.run_.V, self.run_.F, 55)
        C = ss.functional_map(run.eigenpairs, coarse, run.P)
        self.close(C, coarse.vectors.T @ (coarse.M @ (run.P @ run.eigenpairs.vectors)))
        e = ss.evaluate(self.V, self.F, run.V, run.F, run.P, 50, eigenpairs=run.eigenpairs)
        ratio = run.eigenpairs.M.sum() / coarse.M.sum()
        self.close(e.C, C[:50] * ratio ** 0.5, 1e-6)
        lambda_c = np.diag(e.coarse_values[:50])
        self.close(e.C_L, np.linalg.norm(e.C @ np.diag(e.values) - lambda_c @ e.C) / np.linalg.norm(e.C))
        self.close(e.C_D, np.linalg.norm(e.C.T @ e.C - np.eye(50)))
        carried, phi = run.Q @ coarse.vectors[:, :50], run.eigenpairs.vectors
        by_mass = run.eigenpairs.M @ carried
        left = phi - carried @ np.linalg.solve(carried.T @ by_mass, by_mass.T @ phi)
        self.close(e.span_loss, np.sum(left * (run.eigenpairs.M @ left)) / 50, 1e-6)
        self.close(e.eigenvalue_error, np.mean(abs(e.coarse_values[1:50] / e.values[1:] - 1)))
        at = ss.evaluate(self.V, self.F, run.V, run.F, run.P, 50, eigenpairs=run.eigenpairs, scale="mesh")
        self.assertEqual((e.scale, at.scale), ("unit", "mesh"))
        self.close(at.C, C[:50], 1e-6)
        self.close(at.values, run.eigenpairs.values)
        self.close(at.coarse_values[:50], coarse.values[:50], 1e-6)
        lambda_c = np.diag(at.coarse_values[:50])
        self.close(at.C_L, np.linalg.norm(at.C @ np.diag(at.values) - lambda_c @ at.C) / np.linalg.norm(at.C))
        self.close(at.C_D, np.linalg.norm(at.C.T @ at.C - np.eye(50)))
        self.close(at.eigenvalue_error, np.mean(abs(coarse.values[1:50] / run.eigenpairs.values[1:] - 1)), 1e-6)
        self.close(at.eigenvalue_error_max, np.max(abs(coarse.values[1:50] / run.eigenpairs.values[1:] - 1)), 1e-6)
        with self.assertRaisesRegex(ValueError, "scale is 'input', it must be 'unit' or 'mesh'"):
            ss.evaluate(self.V, self.F, run.V, run.F, run.P, 50, scale="input")

    def test_an_operator_with_coefficients(self):
        V, F = sheet(20)
        rho, c = np.exp(V[:, 0]), 1 + V[:, 1] ** 2
        coefficients = ss.weighted_coefficients(rho, c)
        self.close(ss.weighted_coefficients(None, c), ss.weighted_coefficients(np.ones(len(V)), c), 0)
        pairs = ss.eigenpairs(V, F, 30, coefficients=coefficients)
        self.close(pairs.L @ pairs.vectors, (pairs.M @ pairs.vectors) * pairs.values, 1e-6)
        plain = ss.eigenpairs(V, F, 30)
        self.close(pairs.M.sum(), plain.M.sum() * (plain.M @ rho).sum() / plain.M.sum(), 1e-9)
        run = ss.simplify(V, F, 100, 30, coefficients=coefficients, relocate="none", fit_operators=True)
        self.close(run.coefficients, run.P @ coefficients, 1e-12)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.assertIsNone(ss.simplify(V, F, 100, 30, relocate="none").coefficients)
        arguments = dict(k=30, coefficients=coefficients, eigenpairs=run.eigenpairs)
        e = ss.evaluate(V, F, run.V, run.F, run.P, **arguments)
        again = ss.evaluate(V, F, run.V, run.F, run.P, coarse_coefficients=run.coefficients, **arguments)
        self.close(e.C_L, again.C_L)
        self.assertLess(e.C_L, 0.5 * ss.evaluate(V, F, run.V, run.F, run.P, coarse_coefficients=ss.weighted_coefficients(
            np.ones(100)), **arguments).C_L)
        fitted = ss.fit_operators(run.V, run.F, run.P, pairs, 30, coefficients=run.coefficients)
        self.assertLess(ss.evaluate(V, F, run.V, run.F, run.P, operators=fitted, **arguments).C_L, e.C_L)
        for call, sentence in (
                (lambda: ss.simplify(V, F, 100, 30, coefficients=rho[:, None]), "coefficients has 1 columns, it must have 7"),
                (lambda: ss.simplify(V, F, 100, 30, coefficients=coefficients[:9]), "coefficients has 9 rows, but V has 400"),
                (lambda: ss.eigenpairs(V, F, 30, coefficients=-coefficients), "the density of vertex 0 .* is -"),
                (lambda: ss.weighted_coefficients(), "give one of them"),
                (lambda: ss.weighted_coefficients(rho, []), "conductivity is empty: give one number for each vertex"),
                (lambda: ss.weighted_coefficients(rho, c[:3]), "the conductivity has 3 entries where 400 are needed"),
                (lambda: ss.curvature_coefficients(V, F, -1), "anisotropy is -1, it must be a finite number from 0"),
                (lambda: ss.weighted_coefficients(-rho), "the density of vertex 0 .* is -"),
                (lambda: ss.evaluate(V, F, run.V, run.F, run.P, 30, coarse_coefficients=run.coefficients),
                 "without coefficients"),
                (lambda: ss.evaluate(V, F, run.V, run.F, run.P, 30, eigenpairs=pairs), "another mesh or operator"),
                (lambda: ss.evaluate(V, F, run.V, run.F, run.P, coarse_coefficients=coefficients, **arguments),
                 "coarse_coefficients has 400 rows, but Vc has 100")):
            with self.assertRaisesRegex(ValueError, sentence):
                call()

    def test_an_intrinsic_delaunay_triangulation(self):
        V, F = sphere(3)
        V = V * [1, 1, 0.1] # obtuse triangles
        pairs = ss.eigenpairs(V, F, 30, intrinsic_delaunay=True)
        L = pairs.L.tocoo()
        self.assertLess(L.data[L.row != L.col].max(), 1e-9)
        plain = ss.eigenpairs(V, F, 30).L.tocoo()
        self.assertGreater(plain.data[plain.row != plain.col].max(), 0.1)
        run = ss.simplify(V, F, 120, 30, intrinsic_delaunay=True)
        self.close(run.eigenpairs.values, pairs.values, 1e-6)
        e = ss.evaluate(V, F, run.V, run.F, run.P, 30, intrinsic_delaunay=True, eigenpairs=run.eigenpairs)
        self.assertLess(e.eigenvalue_error, 0.1)
        with self.assertRaisesRegex(ValueError, "leave out coefficients and boundary"):
            ss.eigenpairs(V, F, 30, intrinsic_delaunay=True, boundary="dirichlet")

    def test_functions_that_vanish_on_the_border(self):
        V, F = sheet(20)
        run = ss.simplify(V, F, 120, 20, boundary="dirichlet")
        border = np.arange(len(V)).reshape(20, 20)
        border = np.unique(np.r_[border[0], border[-1], border[:, 0], border[:, -1]])
        self.assertEqual(abs(run.eigenpairs.vectors[border]).max(), 0)
        self.assertGreater(run.eigenpairs.values[0], 1)
        e = ss.evaluate(V, F, run.V, run.F, run.P, 20, boundary="dirichlet", eigenpairs=run.eigenpairs)
        self.assertLess(e.eigenvalue_error, 0.05)
        e = ss.evaluate(V, F, run.V, run.F, run.P, 19, boundary="dirichlet", eigenpairs=run.eigenpairs)
        self.assertLess(e.span_loss, 0.03) # the 20th mode changes places with the next
        with self.assertRaisesRegex(ValueError, "another mesh or operator"):
            ss.evaluate(V, F, run.V, run.F, run.P, 20, eigenpairs=run.eigenpairs)
        with self.assertRaisesRegex(ValueError, "boundary is 'robin', it must be 'neumann' or 'dirichlet'"):
            ss.simplify(V, F, 120, 20, boundary="robin")

    def test_signals_say_how_many_they_are(self):
        V, F = sheet(8)
        for k in None, 3:
            run = ss.simplify(V, F, 30, k, signals=V)
            self.assertEqual((len(run.V), run.report["eigenvectors"], run.report["signals"]), (30, 3, 3))
        with self.assertRaisesRegex(ValueError, "k is 100, it must be an integer from 1 to 63"):
            ss.simplify(V, F, 30)

    def test_levels_and_collapses(self):
        run = self.run_
        self.assertEqual(len(run.collapses), len(self.V) - 200)
        level = run.levels(len(self.V) - 1)
        first = run.collapses[0]
        self.assertEqual(level.vertex_map[first["removed"]], level.vertex_map[first["kept"]])
        self.close(level.V[level.vertex_map[first["kept"]]], first["point"])
        self.close(run.levels(len(self.V)).V, self.V)
        with self.assertRaisesRegex(ValueError, "n is 199, it must be an integer from 200 to 2562"):
            run.levels(199)

    def test_kept_vertices(self):
        keep = np.array([0, 5, 77, 2000], dtype=np.uint16)
        run = ss.simplify(self.V, self.F, 200, 50, keep=keep)
        np.testing.assert_array_equal(run.V[run.vertex_map[keep]], self.V[keep])
        self.close(run.P[run.vertex_map[keep]], scipy.sparse.csr_matrix(np.eye(len(self.V))[keep]))

    def test_a_border_and_other_types(self):
        V, F = sheet(30)
        a = ss.simplify(V, F, 200, 30, "paper")
        b = ss.simplify(np.asfortranarray(V), F.astype(np.uint64).tolist(), np.int16(200), k=30, preset="paper")
        self.close(a.V, b.V)
        c = ss.simplify(V.astype(np.float32), F.astype(np.int16), 200, 30, "paper")
        self.close(c.V, ss.simplify(V.astype(np.float32).astype(float), F, 200, 30, "paper").V)

    def test_eigenpairs_are_used_again(self):
        pairs = ss.eigenpairs(self.V, self.F, 60, tolerance=1e-8)
        phases = []
        run = ss.simplify(self.V, self.F, 200, 60, eigenpairs=pairs, progress=lambda phase, _: phases.append(phase))
        self.assertNotIn("eigenpairs", phases)
        self.assertIs(run.eigenpairs, pairs)
        self.close(run.V, ss.simplify(self.V, self.F, 200, 60).V)
        fewer = ss.simplify(self.V, self.F, 200, 30, eigenpairs=pairs)
        self.assertEqual(fewer.report["eigenvectors"], 30)

    def test_threads_change_nothing(self):
        for threads in 1, 2:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of a machine with one
                run = ss.simplify(self.V, self.F, 200, 50, threads=threads)
            np.testing.assert_array_equal(run.V, self.run_.V)
            np.testing.assert_array_equal(run.F, self.run_.F)
            self.assertEqual(abs(run.P - self.run_.P).max(), 0)

    def test_no_more_threads_than_the_machine_runs(self):
        with self.assertWarnsRegex(UserWarning, r"this machine runs \d+ threads? at once: threads=100000 is taken for that\."):
            pairs = ss.eigenpairs(self.V, self.F, 5, threads=100000)
        self.close(pairs.values, self.run_.eigenpairs.values[:5], 1e-6)

    def test_warnings(self):
        with self.assertWarnsRegex(UserWarning, "less than 3 K = 300") as caught:
            run = ss.simplify(self.V, self.F, 200)
        self.assertEqual(caught.filename, __file__)
        self.assertIn("less than 3 K", run.report["warnings"][0])
        with self.assertRaisesRegex(ValueError, "The target is 3 vertices, but 1 component needs at least 4"):
            ss.simplify(self.V, self.F, 3, 1)

    def test_match(self):
        V, F = sphere(3)
        order = np.random.default_rng(1).permutation(len(V))
        place = np.argsort(order)
        try:
            found = ss.match(V, F, V[order], place[F], 150, 30, fine_iterations=10)
            own = ss.match(V, F, V[order], place[F], 150, 30, fine_iterations=10, operators="mesh")
            bcicp = ss.match(V, F, V[order], place[F], 150, 30, fine_iterations=10, matcher="bcicp")
        except RuntimeError as error:
            self.assertRegex(str(error), "LEMON was not found")
            self.skipTest("LEMON was not found")
        self.assertGreater(np.mean(order[found.map] == np.arange(len(V))), 0.9)
        self.assertGreater(np.mean(order[bcicp.map] == np.arange(len(V))), 0.9)
        self.assertEqual(found.C.shape, (30, 30))
        self.assertNotEqual(found.condition, own.condition)
        with self.assertRaises(ss.Cancelled):
            ss.match(V, F, V, F, 150, 30, progress=lambda phase, _: phase != "proxies")
        with self.assertRaisesRegex(ValueError, r"landmarks\[1, 1\] is 9999, but VY has 642 vertices"):
            ss.match(V, F, V, F, 150, 30, landmarks=[[0, 0], [1, 9999]])
        with self.assertRaisesRegex(ValueError, "matcher is 'bcicp'.* proxy is 'none'"):
            ss.match(V, F, V, F, 150, 30, matcher="bcicp", proxy="none")


class Control(Shapes):
    def test_progress(self):
        said = []
        ss.simplify(self.V, self.F, 200, 50, progress=lambda *arguments: said.append(arguments))
        self.assertEqual(list(dict.fromkeys(phase for phase, _ in said)),
                         ["eigenpairs", "pre_simplification", "first_costs", "collapses", "relocation"])
        for (phase, fraction), (next_phase, next_fraction) in zip(said, said[1:]):
            self.assertTrue(0 <= fraction <= 1 and (phase != next_phase or fraction <= next_fraction))

    def test_the_callback_cancels(self):
        pairs = ss.eigenpairs(self.V, self.F, 20)
        for phase in "eigenpairs", "first_costs", "collapses", "relocation":
            with self.subTest(phase), self.assertRaisesRegex(ss.Cancelled, "The computation was cancelled"):
                ss.simplify(self.V, self.F, 200, 50, progress=lambda now, _: now != phase)
        run = self.run_
        for function in (lambda p: ss.eigenpairs(self.V, self.F, 20, progress=p),
                         lambda p: ss.evaluate(self.V, self.F, run.V, run.F, run.P, 20, progress=p),
                         lambda p: ss.fit_operators(run.V, run.F, run.P, pairs, progress=p)):
            with self.assertRaises(ss.Cancelled):
                function(lambda *_: np.bool_(False))
        with self.assertRaises(ss.Cancelled):
            ss.simplify(self.V, self.F, 200, 20, fit_operators=True, progress=lambda now, _: now != "operator_fit")
        self.assertTrue(issubclass(ss.Cancelled, RuntimeError))

    def test_what_the_callback_raises_is_raised(self):
        with self.assertRaises(ZeroDivisionError):
            ss.simplify(self.V, self.F, 200, 50, progress=lambda *_: 1 / 0)

    def test_an_interrupt_stops_and_others_run_meanwhile(self):
        V, F = sphere(6)  # 40,962 vertices: more than ten seconds
        # Where a shell runs the test in the background, Python does not set it.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        seen = []

        def interrupt():
            for _ in range(20):
                time.sleep(0.02)
                seen.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=interrupt)
        start = time.monotonic()
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            ss.simplify(V, F, 600, 200)
        thread.join()
        # The thread had its turns while the computation went on: at the pace it wanted, give or
        # take the machine's.
        self.assertLess(seen[9] - start, 5)
        self.assertLess(time.monotonic() - seen[-1], 5)


class Memory(Shapes):
    def test_arrays_of_other_types_alone_are_converted(self):
        V, F = sphere(5)
        peaks = []  # of what NumPy and Python allocate; the matrices of the library are not in it
        for v, f in (V, F), (V.astype(np.float32), F.astype(np.int32)):
            tracemalloc.start()
            run = ss.simplify(v, f, 200, 20)
            peaks.append(tracemalloc.get_traced_memory()[1])
            tracemalloc.stop()
        results = sum(a.nbytes for a in (run.V, run.F, run.vertex_map, run.P.data, run.P.indices, run.P.indptr))
        # The result has a copy of the mesh, which its owner may change.
        self.assertLess(peaks[0], results + run.collapses.nbytes + V.nbytes + F.nbytes + 100e3)
        self.assertGreater(peaks[1], results + V.nbytes + 2 * F.nbytes)

    def test_eigenvectors_are_views(self):
        pairs = self.run_.eigenpairs
        self.assertTrue(np.shares_memory(pairs.vectors, pairs.vectors))

    def test_borders_and_sharp_edges_stay(self):
        n = 13  # a square sheet, bent by 45 degrees
        x, y = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
        V = np.column_stack([x.ravel(), y.ravel(), np.maximum(0, x.ravel() - 6)]).astype(float)
        a = (x[:-1, :-1] * n + y[:-1, :-1]).ravel()
        F = np.vstack([np.column_stack([a, a + n, a + n + 1]), np.column_stack([a, a + n + 1, a + 1])])
        border = (V[:, 0] == 0) | (V[:, 0] == 12) | (V[:, 1] == 0) | (V[:, 1] == 12)
        corners = [0, 12, 156, 168]
        for keep, kept in (("border", np.flatnonzero(border)), ("sharp:44", np.r_[corners, np.flatnonzero(V[:, 0] == 6)]),
                           (["sharp:60", [30, 31], 44], [30, 31, 44] + corners)):
            run = ss.simplify(V, F, 70, 10, keep=keep)
            np.testing.assert_array_equal(run.V[run.vertex_map[kept]], V[kept])

    def test_integers_beyond_double_precision_are_refused(self):
        run = ss.simplify(self.V, self.F, 200, 20)
        for dtype in "u8", "i8":
            with self.assertRaisesRegex(ValueError, "integers beyond 2"):
                run.interpolate(np.full(len(self.V), np.iinfo(dtype).max, dtype))
            self.assertEqual(run.interpolate(np.full(len(self.V), 2 ** 40, dtype))[0], 2 ** 40)

    def test_a_target_that_leaves_nothing_is_refused(self):
        V = np.vstack([self.V + 3 * i for i in range(3)])
        F = np.vstack([self.F + len(self.V) * i for i in range(3)])
        with self.assertRaisesRegex(ValueError, "3 components need at least 12 vertices"):
            ss.simplify(V, F, 12, 5)

    def test_views_keep_what_they_show(self):
        vectors = ss.eigenpairs(self.V, self.F, 20).vectors
        expected = vectors.copy()
        for _ in range(3):
            ss.eigenpairs(self.V[::-1], self.F[:, ::-1].max() - self.F, 20)
        np.testing.assert_array_equal(vectors, expected)
        with self.assertRaisesRegex(ValueError, "read-only"):
            vectors[0, 0] = 1

    def test_nothing_is_left_behind(self):
        def resident():
            with open("/proc/self/statm") as file:
                return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

        V, F = self.V, self.F
        signals = np.random.default_rng(1).random((len(V), 200))  # 4 MB
        for i in range(10):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                with self.assertRaises(ss.Cancelled):
                    ss.simplify(V, F, 700, signals=signals, progress=lambda *_: False)
            if i == 3:
                before = resident()
        self.assertLess(resident() - before, 12e6)

    def test_the_input_stays(self):
        V, F = self.V.copy(), self.F.copy()
        ss.simplify(V, F, 300, 20)
        np.testing.assert_array_equal(V, self.V)
        np.testing.assert_array_equal(F, self.F)
        V.flags.writeable = F.flags.writeable = False
        ss.simplify(V, F, 300, 20)


class Wrong_input(Shapes):
    def refused(self, error, text, function, *arguments, **options):
        with self.subTest(text):
            with self.assertRaises(error) as caught:
                function(*arguments, **options)
            sentence = str(caught.exception)
            self.assertRegex(sentence, text)
            self.assertNotIn("\n", sentence)
            self.assertRegex(sentence, r"\.$")

    def with_face(self, *corners):
        return np.vstack([self.F, [corners]])

    def test_meshes(self):
        V, F = self.V, self.F
        nan, infinite = V.copy(), V.copy()
        nan[17, 1], infinite[3] = np.nan, np.inf
        foreign, negative, twice, turned = F.copy(), F.copy(), F.copy(), F.copy()
        foreign[5, 2], negative[6, 0], twice[7, 1], turned[0] = 2562, -1, twice[7, 0], F[0, ::-1]
        a, b = F[0, 0], F[0, 1]
        c = next(v for v in range(1000, 2562) if v not in F[(F == a).any(1) | (F == b).any(1)])
        for error, text, v, f in (
                (TypeError, "V has the dtype complex128, it must hold real numbers", V + 0j, F),
                (TypeError, "V has the dtype <U1", [["a", "b", "c"]], F),
                (TypeError, "V is not an array of numbers: give each row the same length", [[1, 2, 3], [1, 2]], F),
                (ValueError, r"V has the shape \(3, 2562\), it must be \(n, 3\), one row for each vertex", V.T, F),
                (ValueError, r"V has the shape \(2562,\)", V[:, 0], F),
                (TypeError, "F has the dtype float64, it must hold integers", V, F.astype(float)),
                (ValueError, r"F has the shape \(5120, 2\), it must be \(n, 3\)", V, F[:, :2]),
                (ValueError, "vertex 17 .counted from 0. has a coordinate that is not a finite number", nan, F),
                (ValueError, "vertex 3 .counted from 0. has a coordinate that is not", infinite, F),
                (ValueError, r"F\[5, 2\] is 2562, but V has 2562 vertices: they are counted from 0", V, foreign),
                (ValueError, r"F\[6, 0\] is -1", V, negative),
                (ValueError, "F has a number above 9223372036854775807, which is no index", V, negative.astype(np.uint64)),
                (ValueError, "V has masked entries: fill them", np.ma.masked_less(V, 0), F),
                (ValueError, "face 7 .counted from 0. uses a vertex twice", V, twice),
                (ValueError, "has the vertices of face 0: remove", V, self.with_face(*F[0])),
                (ValueError, "has more than two faces", V, self.with_face(b, a, c)),
                (ValueError, "run along their common edge in the same direction", V, turned),
                (ValueError, "there are no faces|is isolated|are isolated", V, np.zeros((0, 3), int)),
                (ValueError, "above 1e50 in magnitude: scale the mesh", V * 1e60, F)):
            self.refused(error, text, ss.simplify, v, f, 200, 50)
        self.refused(ValueError, "V, F: .*vertex 2562 .counted from 0. is isolated", ss.eigenpairs,
                     np.vstack([V, [[9, 9, 9]]]), F, 20)
        self.refused(ValueError, "Vc, Fc: .*face 7 .counted from 0. uses one vertex twice", ss.evaluate, V, F, V, twice,
                     scipy.sparse.eye(2562), 20)

    def test_options(self):
        V, F, pairs = self.V, self.F, ss.eigenpairs(self.V, self.F, 20)
        signals = V.copy()
        signals[9, 1] = np.nan
        for error, text, options in (
                (ValueError, "n is 2563, it must be an integer from 1 to 2562", dict(n=2563)),
                (TypeError, "n is 200.0, it must be an integer", dict(n=200.0)),
                (TypeError, "n is True, it must be an integer", dict(n=True)),
                (TypeError, "n is of the type ndarray, it must be an integer", dict(n=V)),
                (TypeError, "shape is of the type ndarray, it must be a number", dict(shape=V)),
                (ValueError, "n is 1000000000000000000000000, it must be", dict(n=10 ** 24)),
                (ValueError, "k is 2562, it must be an integer from 1 to 2561", dict(k=2562)),
                (ValueError, "preset is 'good', it must be 'best', 'fast' or 'paper'", dict(preset="good")),
                (ValueError, "mass is 'full', it must be None, 'lumped', 'averaged', 'voronoi' or 'consistent'", dict(mass="full")),
                (TypeError, "placement is 3, it must be None, 'on_edge', 'midpoint' or 'free'", dict(placement=3)),
                (ValueError, "placement is 'edge'", dict(placement="edge")),
                (ValueError, "shape is -1, it must be a finite number from 0", dict(shape=-1)),
                (ValueError, "shape is nan", dict(shape=np.nan)),
                (TypeError, "shape is 'round', it must be a number", dict(shape="round")),
                (ValueError, "self_intersections is 'no', it must be", dict(self_intersections="no")),
                (ValueError, "relocate is 'yes', it must be", dict(relocate="yes")),
                (ValueError, "prefer is 'form', it must be None, 'spectrum' or 'shape'", dict(prefer="form")),
                (ValueError, "prefer='shape' is a matter of relocation", dict(prefer="shape", preset="paper")),
                (ValueError, "binary asks for a P of ones and zeros", dict(binary=True)),
                (TypeError, "binary is 1, it must be True or False", dict(binary=1)),
                (TypeError, "preserve_border is 'no', it must be True or False", dict(preserve_border="no")),
                (TypeError, "fit_operators is 1, it must be True or False", dict(fit_operators=1)),
                (ValueError, "fit_operators fits to eigenvectors, but signals are given",
                 dict(signals=V, fit_operators=True)),
                (ValueError, r"keep\[1\] is 2562, but V has 2562 vertices", dict(keep=[0, 2562])),
                (ValueError, r"keep has the shape \(5,\), but V has 2562 vertices: give True or False", dict(keep=np.ones(5, bool))),
                (ValueError, "keep has a 0 or a 1 for each vertex of V, but integers are indices: pass booleans",
                 dict(keep=np.ones(2562, int))),
                (TypeError, "keep has the dtype float64, it must hold integers", dict(keep=np.ones(3))),
                (ValueError, r"keep\[1\] names vertex 0 again: .* a mask must hold booleans", dict(keep=[0, 0])),
                (ValueError, "keep has 'sharp', an angle must follow", dict(keep="sharp")),
                (ValueError, "keep has 'seams', it must be 'border', 'sharp:ANGLE'", dict(keep=["border", "seams"])),
                (ValueError, "mask has the entry 2, it must hold True", dict(mask=np.full(2562, 2))),
                (ValueError, r"mask has the shape \(5,\), it must be \(2562,\)", dict(mask=np.ones(5, bool))),
                (ValueError, "mask leaves no face", dict(mask=np.zeros(2562, bool))),
                (ValueError, r"keep has the shape \(1, 2\), it must be \(n,\)", dict(keep=[[1, 2]])),
                (ValueError, "signals has 9 rows, but V has 2562 vertices", dict(signals=V[:9])),
                (ValueError, r"signals\[9, 1\] is not a finite number", dict(signals=signals)),
                (ValueError, "k is 50, but signals, which replace the eigenvectors, has 3 columns", dict(signals=V, k=50)),
                (ValueError, "k is 100, but signals.* has 1 column: leave out k", dict(signals=V[:, :1], k=100)),
                (ValueError, "signals has no columns", dict(signals=V[:, :0])),
                (ValueError, "only one can be given", dict(signals=V, eigenpairs=pairs)),
                (ValueError, "eigenpairs are 20, but k is 50: pass k=20", dict(eigenpairs=pairs, k=50)),
                (ValueError, "eigenpairs are of the averaged mass, but the lumped one is wanted: pass mass='averaged'",
                 dict(eigenpairs=pairs, k=20, mass="lumped")),
                (TypeError, "eigenpairs is of the type ndarray, it must be Eigenpairs", dict(eigenpairs=V)),
                (ValueError, "eigenpairs are of 200 vertices, but V has 2562",
                 dict(eigenpairs=ss.eigenpairs(self.run_.V, self.run_.F, 20), k=20)),
                (ValueError, "eigenpair . is not one of this mesh and operator in the averaged mass",
                 dict(eigenpairs=ss.eigenpairs(V * [1, 1, 2], F, 20), k=20)),
                (ValueError, "quadrics_above is 0.5, it must be a number from 1", dict(quadrics_above=0.5)),
                (ValueError, "quadrics_above goes with free placement", dict(quadrics_above=3, binary=True, relocate="none")),
                (ValueError, "pre_simplify is 100, it must not be below n, which is 200", dict(pre_simplify=100)),
                (ValueError, "max_error is 0, it must be a finite number above 0", dict(max_error=0)),
                (ValueError, "threads is 0, it must be an integer from 1", dict(threads=0)),
                (TypeError, "progress is 3, it must be None or a function", dict(progress=3))):
            self.refused(error, text, ss.simplify, V, F, **{**dict(n=200), **options})
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'colour'"):
            ss.simplify(V, F, 200, colour=1)

    def test_other_functions(self):
        V, F, run = self.V, self.F, self.run_
        pairs, P = run.eigenpairs, run.P
        bad = P.copy()
        bad.data[0] = np.nan
        self.refused(TypeError, "P is of the type ndarray, it must be a sparse matrix", ss.evaluate, V, F, run.V, run.F,
                     P.toarray())
        self.refused(ValueError, r"P has the shape \(2562, 200\), it must be \(200, 2562\), coarse x fine", ss.evaluate,
                     V, F, run.V, run.F, P.T)
        self.refused(TypeError, "P has the dtype complex128, it must hold real numbers", ss.evaluate, V, F, run.V, run.F,
                     P * 1j)
        self.refused(ValueError, r"P\[0, \d+\] is not a finite number", ss.evaluate, V, F, run.V, run.F, bad)
        self.refused(ValueError, "eigenpairs are those of another mesh", ss.evaluate, V, F, run.V, run.F, P, 20,
                     eigenpairs=ss.eigenpairs(V * [1, 1, 2], F, 20))
        self.refused(ValueError, "eigenpairs are of the averaged mass, but the lumped one is wanted", ss.evaluate, V, F,
                     run.V, run.F, P, 20, "lumped", eigenpairs=pairs)
        self.refused(TypeError, "operators must be Fitted_operators", ss.evaluate, V, F, run.V, run.F, P, operators=pairs)
        self.refused(ValueError, "rings is 3, it must be an integer from 1 to 2", ss.fit_operators, run.V, run.F, P,
                     pairs, rings=3)
        self.refused(ValueError, "mass is 'lumped', it must be None, 'diagonal' or 'edges'", ss.fit_operators, run.V,
                     run.F, P, pairs, mass="lumped")
        self.refused(ValueError, r"values has the shape \(200, 3\), it must be \(2562,\) or \(2562, c\)", run.interpolate,
                     run.V)
        self.refused(ValueError, r"for unit=True it must be \(2562, c\)", run.interpolate, V[:, 0], unit=True)
        self.refused(TypeError, "values has the dtype <U4, .*transfer_labels", run.interpolate, np.full(2562, "east"))
        self.refused(ValueError, r"labels has the shape \(2562, 3\), it must be \(2562,\)", run.transfer_labels, V)
        self.refused(TypeError, "labels has the dtype float64, it must hold integers or strings", run.transfer_labels,
                     V[:, 0])
        self.refused(ValueError, "tolerance is 0, it must be", ss.eigenpairs, V, F, 20, tolerance=0)
        self.refused(ValueError, "kind is 'euclidean', it must be", ss.distances, pairs, 0, "euclidean")
        self.refused(ValueError, "sources is 2562, it must be an integer from 0 to 2561", ss.distances, pairs, 2562)
        self.refused(ValueError, r"sources\[0\] is -1, but the mesh has 2562", ss.distances, pairs, [-1])
        self.refused(TypeError, "sources is of the type ndarray, it must be a sparse matrix", ss.distances, pairs, np.ones((1, 2562)) / 2562)
        self.refused(ValueError, r"sources has the shape \(1, 3\), it must be \(any, 2562\), sources x vertices", ss.distances, pairs,
                     scipy.sparse.csr_matrix((1, 3)))
        self.refused(ValueError, "time belongs to the kind 'diffusion'", ss.distances, pairs, 0, time=1)
        self.refused(ValueError, "time is -1, it must be", ss.distances, pairs, 0, "diffusion", time=-1)
        self.refused(TypeError, r"energies is \(1, 2\), it must be a tuple \(t_min, t_max, sigma, steps\)", ss.distances, pairs,
                     0, "wave_kernel", energies=(1, 2))
        self.refused(ValueError, "the time -1 is negative", ss.heat_kernel_signature, pairs, [-1])


class Documentation(unittest.TestCase):
    def test_the_example_of_its_page(self):
        with open(os.path.join(os.path.dirname(__file__), "..", "examples", "python", "README.md")) as file:
            code = file.read().split("```python\n")[1].split("```")[0]
        names, here = {}, os.getcwd()
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            try:
                os.chdir(folder)
                ss.write_mesh("cat.off", V, F)
                exec(code, names)
            finally:
                os.chdir(here)
        self.assertEqual((names["run"].V.shape, names["finer"].V.shape), ((600, 3), (1200, 3)))
        self.assertLess(abs(names["back"] - V[:, 2]).max(), 0.1)

    def test_help_says_what_each_argument_is(self):
        functions = [getattr(ss, name) for name in ss.__all__ if inspect.isfunction(getattr(ss, name))]
        functions += [method for kind in (ss.Level, ss.Simplification, ss.Eigenpairs) for name, method in
                      inspect.getmembers(kind, callable) if name[0] != "_" and name != "save"]
        self.assertEqual(set(dir(ss)), set(ss.__all__) | {"__version__", "__doc__"})
        for function in functions:
            self.assertTrue(function.__module__.startswith("spectral_simplification"))
            doc = inspect.getdoc(function)
            sections = re.findall(r"(?m)^(\w+)\n---+$", doc)
            parameters = {name: p for name, p in inspect.signature(function).parameters.items() if name != "self"}
            wanted = ["Parameters"] * bool(parameters) + ["Returns"] * (function is not ss.write_mesh) + ["Raises"] * bool(parameters)
            self.assertEqual([s for s in sections if s in ("Parameters", "Returns", "Raises")], wanted, function.__name__)
            for name, parameter in parameters.items():
                self.assertIsNot(parameter.annotation, parameter.empty)
                self.assertRegex(doc, r"(?m)^([\w*]+, )*[*]*%s(, \w+)*( : |$)" % name, function.__name__)
            self.assertLess(max(map(len, doc.split("\n"))), 140)

    def test_objects_are_described(self):
        for kind in (getattr(ss, name) for name in ss.__all__ if inspect.isclass(getattr(ss, name))):
            self.assertTrue(kind.__doc__)
            for name, member in vars(kind).items():
                if isinstance(member, property):
                    self.assertTrue(member.__doc__, name)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
