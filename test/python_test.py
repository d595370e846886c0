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
from functools import partial

import numpy as np
import scipy.io
import scipy.sparse

import spectral_simplification as ss
from python_shapes import sheet, sphere

PROGRAM = None
V, F = sphere(4)
RUN = ss.simplify(V, F, 200, 50)


def evaluate(run, V=V, F=F, k=50, **options):
    """Judges a run by the eigenpairs that it had, or by others that are given."""
    options.setdefault("eigenpairs", run.eigenpairs)
    return ss.evaluate(V, F, run.V, run.F, run.P, k, **options)


class Case(unittest.TestCase):
    def refused(self, error, text, function, *arguments, **options):
        with self.subTest(text):
            with self.assertRaises(error) as caught:
                function(*arguments, **options)
            sentence = str(caught.exception)
            self.assertRegex(sentence, text)
            self.assertNotIn("\n", sentence)
            self.assertRegex(sentence, r"\.$")

    def close(self, a, b, tolerance=1e-9):
        def largest(x):
            return abs(x).max() if scipy.sparse.issparse(x) else np.max(abs(x))

        self.assertEqual(np.shape(a), np.shape(b))
        self.assertLessEqual(largest(a - b), tolerance * max(1, largest(b)))


class Beside_the_program(Case):
    def setUp(self):
        if PROGRAM is None:
            self.fail("the first argument must be the program spectral_simplify")
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def program(self, ending, header, rows, F, options):
        words = f"in{ending} out{ending} --vertices 200 --eigenvectors 50 --quiet {options}".split()
        with open(self.path(words[0]), "w") as file:
            file.write(header)
            np.savetxt(file, rows, "%.17g")
            np.savetxt(file, np.insert(F, 0, 3, axis=1), "%d")
        subprocess.run([PROGRAM, *words], cwd=self.folder, check=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def matrix(self, name):
        return scipy.io.mmread(self.path(name)).tocsr()

    def array(self, name):
        return np.load(self.path(name))

    def check_mesh(self, level, suffix=""):
        with open(self.path(f"out{suffix}.off")) as file:
            words = file.read().split()
        n, m = int(words[1]), int(words[2])
        self.close(level.V, np.array(words[4:4 + 3 * n], float).reshape(n, 3))
        faces = np.array(words[4 + 3 * n:], int).reshape(m, 4)[:, 1:]
        np.testing.assert_array_equal(level.F, faces)
        self.close(level.P, self.matrix(f"P{suffix}.mtx"))
        places = np.loadtxt(self.path(f"map{suffix}.txt"))
        np.testing.assert_array_equal(level.vertex_map, places)

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
        outputs = "--restriction P.mtx --prolongation Q.mtx --map map.txt --eigenpairs pairs "
        outputs += "--fit-operators fitted --levels 1000,400 --json out.json"
        self.program(".off", f"OFF\n{len(V)} {len(F)} 0\n", V, F, outputs)
        # The program counts from its largest level.
        run = ss.simplify(V, F, 200, 50, quadrics_above=5 * RUN.report["quadrics_above"])
        self.check_mesh(run)
        for n in 1000, 400:
            self.check_mesh(run.levels(n), f"-{n}")
        pairs, coarse = run.eigenpairs, ss.eigenpairs(run.V, run.F, 50)
        self.close(run.Q, self.matrix("Q.mtx"))
        self.close(pairs.L, self.matrix("pairs/fine_L.mtx"))
        self.close(pairs.M, self.matrix("pairs/fine_mass.mtx"))
        self.close(pairs.values, self.array("pairs/fine_eigenvalues.npy"))
        self.close(pairs.vectors, self.array("pairs/fine_eigenvectors.npy"))
        self.close(coarse.L, self.matrix("pairs/coarse_L.mtx"))
        C = ss.functional_map(pairs, coarse, run.P)
        self.close(abs(C), abs(self.array("pairs/C.npy")), 1e-6)
        with open(self.path("out.json")) as file:
            said = json.load(file)
        self.same_report(run.report, said)
        own = evaluate(run)
        # The program solves to 1e-8, and a fit follows the last digits of what it is fitted to.
        further = ss.eigenpairs(V, F, 60, tolerance=1e-8)
        fitted = ss.fit_operators(run.V, run.F, run.P, further, 55)
        self.close(fitted.L, self.matrix("fitted/L.mtx"), 1e-5)
        self.close(fitted.M, self.matrix("fitted/mass.mtx"), 1e-5)
        self.close(fitted.values[:50], self.array("fitted/eigenvalues.npy"), 1e-6)
        of_fitted = evaluate(run, operators=fitted)
        names = "norm_L norm_D area_ratio span_loss eigenvalue_error_mean eigenvalue_error_max"
        for name in [*names.split(), "eigenvalue_error_low_mean"]:
            # An evaluation says C_L where the report says norm_L, and not that an error is a mean.
            attribute = name.replace("norm", "C").replace("_mean", "")
            self.close(getattr(own, attribute), said[name], 3e-6)
            self.close(getattr(of_fitted, attribute), said["fitted"][name], 3e-6)
        self.assertLess(of_fitted.C_L, own.C_L)
        self.assertLess(of_fitted.eigenvalue_error, own.eigenvalue_error)

    def test_attributes(self):
        rng, n = np.random.default_rng(5), len(V)
        colours, labels = rng.integers(0, 256, (n, 3), np.uint8), rng.integers(-3, 4, n)
        numbers = rng.random(n)
        kinds = {"double": "<f8", "uchar": "u1", "int": "<i4"}
        properties = ("double x,double y,double z,uchar red,uchar green,uchar blue,int label,"
                      "double heat,double nx,double ny,double nz")
        header = (f"ply\nformat ascii 1.0\nelement vertex {n}\n"
                  + "".join(f"property {name}\n" for name in properties.split(","))
                  + f"element face {len(F)}\nproperty list uchar int vertex_indices\nend_header\n")
        rows = np.column_stack([V, colours, labels, numbers, V])
        self.program(".ply", header, rows, F, "--no-evaluation")
        with open(self.path("out.ply"), "rb") as file:
            header, data = file.read().split(b"end_header\n", 1)
        fields = re.findall(r"(?m)^property (\w+) (\w+)$", header.decode().split("element face")[0])
        out = np.frombuffer(data, [(name, kinds[kind]) for kind, name in fields], 200)

        def columns(names):
            return np.column_stack([out[name] for name in names.split()])

        self.close(columns("x y z"), RUN.V)
        carried = RUN.interpolate(colours)
        self.assertEqual(carried.dtype, np.uint8)
        np.testing.assert_array_equal(carried, columns("red green blue"))
        np.testing.assert_array_equal(RUN.transfer_labels(labels), out["label"])
        self.close(RUN.interpolate(numbers), out["heat"])
        self.close(RUN.interpolate(V, unit=True), columns("nx ny nz"))

    def test_the_options_have_their_meaning(self):
        V, F = sphere(3)
        signals, keep, weights = V[:, :2] ** 2, [7, 400], np.exp(V[:, 1:])
        np.save(self.path("F.npy"), signals)
        np.savetxt(self.path("keep.txt"), keep, "%d")
        np.save(self.path("W.npy"), weights)
        outputs = " --restriction P.mtx --map map.txt --no-evaluation"
        curved, weighted = ss.curvature_coefficients(V, F, 2), ss.weighted_coefficients(*weights.T)
        for options, arguments in (
            ("--preset paper --keep keep.txt --shape 1", dict(preset="paper", keep=keep, shape=1)),
            ("--mass lumped --placement midpoint --relocate carried --binary",
             dict(mass="lumped", placement="midpoint", relocate="carried", binary=True)),
            ("--signals F.npy --self-intersections allow",
             dict(k=None, signals=signals, self_intersections="allow")),
            ("--operator anisotropic:2 --mass voronoi --relocate none",
             dict(coefficients=curved, mass="voronoi", relocate="none")),
            ("--operator weighted:W.npy", dict(coefficients=weighted)),
            ("--preset fast --pre-simplify 400", dict(preset="fast", pre_simplify=400)),
            ("--quadrics-above 2", dict(quadrics_above=2)),
            ("--quadrics-above inf --preserve-border",
             dict(quadrics_above=math.inf, preserve_border=True)),
            ("--preset fast", dict(preset="fast")),  # which is best on a mesh as small as this one
            ("--pre-simplify 500 --relocate carried_and_sampled --max-error 0.05 --preserve-border",
             dict(pre_simplify=500, relocate="carried_and_sampled", max_error=0.05,
                  preserve_border=True)),
            ("--prefer shape", dict(prefer="shape")),
        ):
            with self.subTest(options), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                self.program(".off", f"OFF\n{len(V)} {len(F)} 0\n", V, F, options + outputs)
                self.check_mesh(ss.simplify(V, F, 200, **{"k": 50, **arguments}))
        run, shaped = (ss.simplify(V, F, 200, 50, prefer=word) for word in ("spectrum", "shape"))
        goals = [r.report["relocation"]["hausdorff_goal"] for r in (run, shaped)]
        self.assertEqual(goals, [0.8, 0.5])
        self.assertGreater(abs(run.V - shaped.V).max(), 0)
        plain, nearer = (r.apply(V, by="merges", relocate=True) for r in (run, shaped))
        np.testing.assert_array_equal(run.vertex_map, shaped.vertex_map)
        self.assertGreater(abs(plain.V - nearer.V).max(), 0)


class Results(Case):
    def test_eigenpairs(self):
        pairs = ss.eigenpairs(V, F, 20, "lumped")
        phi, L, M = pairs.vectors, pairs.L, pairs.M
        self.assertTrue(scipy.sparse.isspmatrix_csr(L) and M.nnz == len(V) and len(pairs) == 20)
        self.close(phi.T @ (M @ phi), np.eye(20))
        self.assertLess(abs(L @ phi - M @ phi * pairs.values).max(), 1e-6)
        self.assertEqual((pairs.zeros, pairs.mass, pairs.complete), (1, "lumped", True))
        further = ss.eigenpairs(V, F, 30, "lumped").values[20:]
        n = len(pairs.further_values)
        self.assertGreater(n, 2)
        self.close(pairs.further_values / further[:n], np.ones(n), 1e-3)
        two = ss.eigenpairs(np.vstack([V, V + 9]), np.vstack([F, F + len(V)]), 5)
        self.assertEqual(two.zeros, 2)
        words = "did not reach their tolerance of 1e-15, the largest residual is"
        with self.assertWarnsRegex(UserWarning, words):
            self.assertFalse(ss.eigenpairs(V, F, 20, tolerance=1e-15).complete)
        with self.assertWarnsRegex(UserWarning, "ask for a larger tolerance"):
            ss.eigsh(L, M, 20, tolerance=1e-15)

    def test_restriction_and_prolongation(self):
        self.close(RUN.P @ np.ones(len(V)), np.ones(200))
        self.close(RUN.Q @ np.ones(200), np.ones(len(V)))
        self.assertLess(abs(RUN.Q @ RUN.V - V).max(), 0.2)
        kinds = RUN.V.dtype, RUN.F.dtype, RUN.vertex_map.dtype
        self.assertEqual(kinds, (np.float64, np.int32, np.int64))

    def test_what_vertices_have_is_carried(self):
        def sides(V):
            return np.where(V[:, 0] > 0, "east", "west")

        for level in RUN, RUN.levels(700):
            self.close(level.interpolate(V), level.P @ V)
            self.close(level.interpolate(V[:, 0].astype(np.float32)), level.P @ V[:, 0], 1e-6)
            normals = level.interpolate(V, unit=True)
            self.close(np.linalg.norm(normals, axis=1), np.ones(len(level.V)))
            outward = level.V / np.linalg.norm(level.V, axis=1, keepdims=True)
            self.assertLess(abs(normals - outward).max(), 0.05)
            away = abs(level.V[:, 0]) > 0.1
            carried = level.transfer_labels(sides(V))
            np.testing.assert_array_equal(carried[away], sides(level.V)[away])
        ends = RUN.interpolate(np.full(len(V), 255, np.uint8))
        self.assertTrue((ends == 255).all() and ends.dtype == np.uint8)

    def test_fitted_operators_of_one_call(self):
        run = ss.simplify(V, F, 200, 50, fit_operators=True)
        self.close(run.V, RUN.V)
        self.assertIsNone(RUN.fitted)
        self.assertEqual((len(run.fitted), run.fitted.mass), (50, "edges"))
        pairs = ss.eigenpairs(V, F, 60, tolerance=1e-8)
        alone = ss.fit_operators(run.V, run.F, run.P, pairs, 50)
        self.close(run.fitted.L, alone.L, 1e-5)
        self.close(run.fitted.values, alone.values, 1e-5)
        self.assertLess(run.fitted.objective_after, run.fitted.objective_before)
        self.assertLess(evaluate(run, operators=run.fitted).C_L, 0.9 * evaluate(run).C_L)
        lumped = ss.simplify(V, F, 200, 30, "paper", fit_operators=True)
        self.assertEqual(lumped.fitted.mass, "diagonal")

    def test_distances_are_what_numpy_finds(self):
        pairs = RUN.eigenpairs
        distances = partial(ss.distances, pairs)
        phi, values = pairs.vectors[:, 1:], pairs.values[1:]
        squares = (phi - phi[3]) ** 2
        self.close(distances(3), squares @ values ** -2)
        self.close(distances(3, "commute_time"), squares @ (1 / values))
        at_time = distances([4, 3], "diffusion", time=0.1)[:, 1]
        self.close(at_time, squares @ np.exp(-0.2 * values))
        self.close(distances(3, "diffusion"), squares @ np.exp(-values / (2 * values[0])))
        energies = ss.wave_kernel_energies(pairs, 30)
        kernel = ss.wave_kernel_signature(pairs, energies)
        change = abs(kernel - kernel[3]) / (kernel + kernel[3])
        expected = np.trapz(change, np.linspace(energies[0], energies[1], 30), axis=1)
        self.close(distances(3, "wave_kernel", energies=energies), expected)
        points = scipy.sparse.csr_matrix(([1, 0.25, 0.75], ([0, 1, 1], [3, 4, 9])), (2, len(phi)))
        at_point = distances(points)
        self.close(at_point[:, 0], distances(3))
        self.close(at_point[:, 1], (phi - 0.25 * phi[4] - 0.75 * phi[9]) ** 2 @ values ** -2)
        heat = pairs.vectors ** 2 @ np.exp(-np.outer(pairs.values, [0.1, 1]))
        self.close(ss.heat_kernel_signature(pairs, [0.1, 1]), heat)

    def test_functional_maps(self):
        def check_norms(e):
            commutator = e.C @ np.diag(e.values) - np.diag(e.coarse_values[:50]) @ e.C
            self.close(e.C_L, np.linalg.norm(commutator) / np.linalg.norm(e.C))
            self.close(e.C_D, np.linalg.norm(e.C.T @ e.C - np.eye(50)))

        pairs, coarse = RUN.eigenpairs, ss.eigenpairs(RUN.V, RUN.F, 55)
        C = ss.functional_map(pairs, coarse, RUN.P)
        self.close(C, coarse.vectors.T @ (coarse.M @ (RUN.P @ pairs.vectors)))
        e = evaluate(RUN)
        self.close(e.C, C[:50] * (pairs.M.sum() / coarse.M.sum()) ** 0.5, 1e-6)
        check_norms(e)
        carried, phi = RUN.Q @ coarse.vectors[:, :50], pairs.vectors
        by_mass = pairs.M @ carried
        left = phi - carried @ np.linalg.solve(carried.T @ by_mass, by_mass.T @ phi)
        self.close(e.span_loss, np.sum(left * (pairs.M @ left)) / 50, 1e-6)
        self.close(e.eigenvalue_error, np.mean(abs(e.coarse_values[1:50] / e.values[1:] - 1)))
        at = evaluate(RUN, scale="mesh")
        self.assertEqual((e.scale, at.scale), ("unit", "mesh"))
        self.close(at.C, C[:50], 1e-6)
        self.close(at.values, pairs.values)
        self.close(at.coarse_values[:50], coarse.values[:50], 1e-6)
        check_norms(at)
        errors = abs(coarse.values[1:50] / pairs.values[1:] - 1)
        self.close(at.eigenvalue_error, np.mean(errors), 1e-6)
        self.close(at.eigenvalue_error_max, np.max(errors), 1e-6)
        text = "scale is 'input', it must be 'unit' or 'mesh'"
        self.refused(ValueError, text, evaluate, RUN, eigenpairs=None, scale="input")

    def test_an_operator_with_coefficients(self):
        V, F = sheet(20)
        rho, c = np.exp(V[:, 0]), 1 + V[:, 1] ** 2
        weighted, solve = ss.weighted_coefficients, partial(ss.eigenpairs, V, F, 30)
        simplify = partial(ss.simplify, V, F, 100, 30)
        both = weighted(rho, c)
        self.close(weighted(None, c), weighted(np.ones(len(V)), c), 0)
        pairs, plain = solve(coefficients=both), solve()
        self.close(pairs.L @ pairs.vectors, (pairs.M @ pairs.vectors) * pairs.values, 1e-6)
        self.close(pairs.M.sum(), (plain.M @ rho).sum())
        run = simplify(coefficients=both, relocate="none", fit_operators=True)
        self.close(run.coefficients, run.P @ both, 1e-12)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.assertIsNone(simplify(relocate="none").coefficients)
        judge = partial(evaluate, run, V, F, 30)
        weigh = partial(judge, coefficients=both)
        e = weigh()
        self.close(e.C_L, weigh(coarse_coefficients=run.coefficients).C_L)
        self.assertLess(e.C_L, 0.5 * weigh(coarse_coefficients=weighted(np.ones(100))).C_L)
        fitted = ss.fit_operators(run.V, run.F, run.P, pairs, 30, coefficients=run.coefficients)
        self.assertLess(weigh(operators=fitted).C_L, e.C_L)
        for text, call in (
            ("coefficients has 1 columns, it must have 7",
             lambda: simplify(coefficients=rho[:, None])),
            ("coefficients has 9 rows, but V has 400", lambda: simplify(coefficients=both[:9])),
            ("the density of vertex 0 .* is -", lambda: solve(coefficients=-both)),
            ("anisotropy is -1, it must be a finite number from 0",
             lambda: ss.curvature_coefficients(V, F, -1)),
            ("give one of them", weighted),
            ("conductivity is empty: give one number for each vertex", lambda: weighted(rho, [])),
            ("the conductivity has 3 entries where 400 are needed", lambda: weighted(rho, c[:3])),
            ("the density of vertex 0 .* is -", lambda: weighted(-rho)),
            ("without coefficients",
             lambda: judge(eigenpairs=None, coarse_coefficients=run.coefficients)),
            ("another mesh or operator", lambda: judge(eigenpairs=pairs)),
            ("coarse_coefficients has 400 rows, but Vc has 100",
             lambda: weigh(coarse_coefficients=both)),
        ):
            self.refused(ValueError, text, call)

    def test_an_intrinsic_delaunay_triangulation(self):
        V, F = sphere(3)
        V = V * [1, 1, 0.1]  # obtuse triangles
        pairs = ss.eigenpairs(V, F, 30, intrinsic_delaunay=True)
        own, plain = pairs.L.tocoo(), ss.eigenpairs(V, F, 30).L.tocoo()
        self.assertLess(own.data[own.row != own.col].max(), 1e-9)
        self.assertGreater(plain.data[plain.row != plain.col].max(), 0.1)
        run = ss.simplify(V, F, 120, 30, intrinsic_delaunay=True)
        self.close(run.eigenpairs.values, pairs.values, 1e-6)
        self.assertLess(evaluate(run, V, F, 30, intrinsic_delaunay=True).eigenvalue_error, 0.1)
        both = dict(intrinsic_delaunay=True, boundary="dirichlet")
        text = "leave out coefficients and boundary"
        self.refused(ValueError, text, ss.eigenpairs, V, F, 30, **both)

    def test_functions_that_vanish_on_the_border(self):
        V, F = sheet(20)
        run = ss.simplify(V, F, 120, 20, boundary="dirichlet")
        border = np.arange(len(V)).reshape(20, 20)
        border = np.unique(np.r_[border[0], border[-1], border[:, 0], border[:, -1]])
        self.assertEqual(abs(run.eigenpairs.vectors[border]).max(), 0)
        self.assertGreater(run.eigenpairs.values[0], 1)
        e, fewer = (evaluate(run, V, F, k, boundary="dirichlet") for k in (20, 19))
        self.assertLess(e.eigenvalue_error, 0.05)
        self.assertLess(fewer.span_loss, 0.03)  # the 20th mode changes places with the next
        self.refused(ValueError, "another mesh or operator", evaluate, run, V, F, 20)
        text = "boundary is 'robin', it must be 'neumann' or 'dirichlet'"
        self.refused(ValueError, text, ss.simplify, V, F, 120, 20, boundary="robin")

    def test_signals_say_how_many_they_are(self):
        V, F = sheet(8)
        for k in None, 3:
            run = ss.simplify(V, F, 30, k, signals=V)
            counts = len(run.V), run.report["eigenvectors"], run.report["signals"]
            self.assertEqual(counts, (30, 3, 3))
        text = "k is 100, it must be an integer from 1 to 63"
        self.refused(ValueError, text, ss.simplify, V, F, 30)

    def test_levels_and_collapses(self):
        self.assertEqual(len(RUN.collapses), len(V) - 200)
        level, first = RUN.levels(len(V) - 1), RUN.collapses[0]
        self.assertEqual(level.vertex_map[first["removed"]], level.vertex_map[first["kept"]])
        self.close(level.V[level.vertex_map[first["kept"]]], first["point"])
        self.close(RUN.levels(len(V)).V, V)
        text = "n is 199, it must be an integer from 200 to 2562"
        self.refused(ValueError, text, RUN.levels, 199)

    def test_kept_vertices(self):
        keep = np.array([0, 5, 77, 2000], dtype=np.uint16)
        run = ss.simplify(V, F, 200, 50, keep=keep)
        np.testing.assert_array_equal(run.V[run.vertex_map[keep]], V[keep])
        self.close(run.P[run.vertex_map[keep]], scipy.sparse.csr_matrix(np.eye(len(V))[keep]))

    def test_a_border_and_other_types(self):
        V, F = sheet(30)
        a = ss.simplify(V, F, 200, 30, "paper")
        numbers = F.astype(np.uint64).tolist()
        b = ss.simplify(np.asfortranarray(V), numbers, np.int16(200), k=30, preset="paper")
        self.close(a.V, b.V)
        single = V.astype(np.float32)
        c = ss.simplify(single, F.astype(np.int16), 200, 30, "paper")
        self.close(c.V, ss.simplify(single.astype(float), F, 200, 30, "paper").V)

    def test_eigenpairs_are_used_again(self):
        pairs = ss.eigenpairs(V, F, 60, tolerance=1e-8)
        told = []
        run = ss.simplify(V, F, 200, 60, eigenpairs=pairs, progress=lambda *now: told.append(now))
        self.assertNotIn("eigenpairs", [phase for phase, _ in told])
        self.assertIs(run.eigenpairs, pairs)
        self.close(run.V, ss.simplify(V, F, 200, 60).V)
        fewer = ss.simplify(V, F, 200, 30, eigenpairs=pairs)
        self.assertEqual(fewer.report["eigenvectors"], 30)

    def test_threads_change_nothing(self):
        for threads in 1, 2:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # where the machine has one
                run = ss.simplify(V, F, 200, 50, threads=threads)
            np.testing.assert_array_equal(run.V, RUN.V)
            np.testing.assert_array_equal(run.F, RUN.F)
            self.assertEqual(abs(run.P - RUN.P).max(), 0)

    def test_no_more_threads_than_the_machine_runs(self):
        words = r"this machine runs \d+ threads? at once: threads=100000 is taken for that\."
        with self.assertWarnsRegex(UserWarning, words):
            pairs = ss.eigenpairs(V, F, 5, threads=100000)
        self.close(pairs.values, RUN.eigenpairs.values[:5], 1e-6)

    def test_warnings(self):
        with self.assertWarnsRegex(UserWarning, "less than 3 K = 300") as caught:
            run = ss.simplify(V, F, 200)
        self.assertEqual(caught.filename, __file__)
        self.assertIn("less than 3 K", run.report["warnings"][0])
        text = "The target is 3 vertices, but 1 component needs at least 4"
        self.refused(ValueError, text, ss.simplify, V, F, 3, 1)

    def test_match(self):
        V, F = sphere(3)
        order = np.random.default_rng(1).permutation(len(V))
        match = partial(ss.match, V, F, V[order], np.argsort(order)[F], 150, 30, fine_iterations=10)
        try:
            found, own, bcicp = match(), match(operators="mesh"), match(matcher="bcicp")
        except RuntimeError as error:
            self.assertRegex(str(error), "LEMON was not found")
            self.skipTest("LEMON was not found")
        for result in found, bcicp:
            self.assertGreater(np.mean(order[result.map] == np.arange(len(V))), 0.9)
        self.assertEqual(found.C.shape, (30, 30))
        self.assertNotEqual(found.condition, own.condition)
        match = partial(ss.match, V, F, V, F, 150, 30)
        self.assertRaises(ss.Cancelled, match, progress=lambda phase, _: phase != "proxies")
        text = r"landmarks\[1, 1\] is 9999, but VY has 642 vertices"
        self.refused(ValueError, text, match, landmarks=[[0, 0], [1, 9999]])
        text = "matcher is 'bcicp'.* proxy is 'none'"
        self.refused(ValueError, text, match, matcher="bcicp", proxy="none")


class Control(Case):
    def test_progress(self):
        said = []
        ss.simplify(V, F, 200, 50, progress=lambda *arguments: said.append(arguments))
        phases = ["eigenpairs", "pre_simplification", "first_costs", "collapses", "relocation"]
        self.assertEqual(list(dict.fromkeys(phase for phase, _ in said)), phases)
        for (phase, fraction), (next_phase, next_fraction) in zip(said, said[1:]):
            self.assertTrue(0 <= fraction <= 1)
            self.assertTrue(phase != next_phase or fraction <= next_fraction)

    def test_the_callback_cancels(self):
        words = "The computation was cancelled"
        for phase in "eigenpairs", "first_costs", "collapses", "relocation":
            with self.subTest(phase), self.assertRaisesRegex(ss.Cancelled, words):
                ss.simplify(V, F, 200, 50, progress=lambda now, _: now != phase)
        for call in (
            partial(ss.eigenpairs, V, F, 20),
            partial(ss.evaluate, V, F, RUN.V, RUN.F, RUN.P, 20),
            partial(ss.fit_operators, RUN.V, RUN.F, RUN.P, ss.eigenpairs(V, F, 20)),
        ):
            self.assertRaises(ss.Cancelled, call, progress=lambda *_: np.bool_(False))
        fitting = partial(ss.simplify, V, F, 200, 20, fit_operators=True)
        self.assertRaises(ss.Cancelled, fitting, progress=lambda now, _: now != "operator_fit")
        self.assertTrue(issubclass(ss.Cancelled, RuntimeError))

    def test_what_the_callback_raises_is_raised(self):
        with self.assertRaises(ZeroDivisionError):
            ss.simplify(V, F, 200, 50, progress=lambda *_: 1 / 0)

    def test_an_interrupt_stops_and_others_run_meanwhile(self):
        V, F = sphere(6)  # 40,962 vertices: more than ten seconds
        # Where a shell runs the test in the background, Python does not set it.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
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


class Memory(Case):
    def test_arrays_of_other_types_alone_are_converted(self):
        V, F = sphere(5)
        peaks = []  # NumPy and Python allocate it; the matrices of the library are not in it
        for v, f in (V, F), (V.astype(np.float32), F.astype(np.int32)):
            tracemalloc.start()
            run = ss.simplify(v, f, 200, 20)
            peaks.append(tracemalloc.get_traced_memory()[1])
            tracemalloc.stop()
        arrays = run.V, run.F, run.vertex_map, run.P.data, run.P.indices, run.P.indptr
        results = sum(a.nbytes for a in arrays)
        # The result has a copy of the mesh, which its owner may change.
        self.assertLess(peaks[0], results + run.collapses.nbytes + V.nbytes + F.nbytes + 100e3)
        self.assertGreater(peaks[1], results + V.nbytes + 2 * F.nbytes)

    def test_eigenvectors_are_views(self):
        pairs = RUN.eigenpairs
        self.assertTrue(np.shares_memory(pairs.vectors, pairs.vectors))

    def test_borders_and_sharp_edges_stay(self):
        n = 13  # a square sheet, bent by 45 degrees
        x, y = np.divmod(np.arange(n * n), n)
        V = np.column_stack([x, y, np.maximum(0, x - 6)]).astype(float)
        F = sheet(n)[1]
        border = np.flatnonzero((x == 0) | (x == 12) | (y == 0) | (y == 12))
        corners = [0, 12, 156, 168]
        for keep, kept in (("border", border),
                           ("sharp:44", np.r_[corners, np.flatnonzero(x == 6)]),
                           (["sharp:60", [30, 31], 44], [30, 31, 44] + corners)):
            run = ss.simplify(V, F, 70, 10, keep=keep)
            np.testing.assert_array_equal(run.V[run.vertex_map[kept]], V[kept])

    def test_integers_beyond_double_precision_are_refused(self):
        run = ss.simplify(V, F, 200, 20)
        for dtype in "u8", "i8":
            large = np.full(len(V), np.iinfo(dtype).max, dtype)
            self.refused(ValueError, "integers beyond 2", run.interpolate, large)
            self.assertEqual(run.interpolate(np.full(len(V), 2 ** 40, dtype))[0], 2 ** 40)

    def test_a_target_that_leaves_nothing_is_refused(self):
        three = [np.vstack([a + step * i for i in range(3)]) for a, step in ((V, 3), (F, len(V)))]
        text = "3 components need at least 12 vertices"
        self.refused(ValueError, text, ss.simplify, *three, 12, 5)

    def test_views_keep_what_they_show(self):
        vectors = ss.eigenpairs(V, F, 20).vectors
        expected = vectors.copy()
        for _ in range(3):
            ss.eigenpairs(V[::-1], F[:, ::-1].max() - F, 20)
        np.testing.assert_array_equal(vectors, expected)
        with self.assertRaisesRegex(ValueError, "read-only"):
            vectors[0, 0] = 1

    def test_nothing_is_left_behind(self):
        def resident():
            with open("/proc/self/statm") as file:
                return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

        signals = np.random.default_rng(1).random((len(V), 200))  # 4 MB
        for i in range(10):
            with warnings.catch_warnings(), self.assertRaises(ss.Cancelled):
                warnings.simplefilter("ignore")
                ss.simplify(V, F, 700, signals=signals, progress=lambda *_: False)
            if i == 3:
                before = resident()
        self.assertLess(resident() - before, 12e6)

    def test_the_input_stays(self):
        v, f = V.copy(), F.copy()
        ss.simplify(v, f, 300, 20)
        np.testing.assert_array_equal(v, V)
        np.testing.assert_array_equal(f, F)
        v.flags.writeable = f.flags.writeable = False
        ss.simplify(v, f, 300, 20)


class Wrong_input(Case):
    def test_meshes(self):
        nan, infinite = V.copy(), V.copy()
        nan[17, 1], infinite[3] = np.nan, np.inf
        foreign, negative, twice, turned = F.copy(), F.copy(), F.copy(), F.copy()
        foreign[5, 2], negative[6, 0], twice[7, 1], turned[0] = 2562, -1, twice[7, 0], F[0, ::-1]
        a, b = F[0, 0], F[0, 1]
        c = next(v for v in range(1000, 2562) if v not in F[(F == a).any(1) | (F == b).any(1)])
        again, third = np.vstack([F, [F[0]]]), np.vstack([F, [[b, a, c]]])
        for text, v, f in (
            ("V has the dtype complex128, it must hold real numbers", V + 0j, F),
            ("V has the dtype <U1", [["a", "b", "c"]], F),
            ("V is not an array of numbers: give each row the same length", [[1, 2, 3], [1, 2]], F),
            ("F has the dtype float64, it must hold integers", V, F.astype(float)),
        ):
            self.refused(TypeError, text, ss.simplify, v, f, 200, 50)
        for text, v, f in (
            (r"V has the shape \(3, 2562\), it must be \(n, 3\), one row for each vertex", V.T, F),
            (r"V has the shape \(2562,\)", V[:, 0], F),
            (r"F has the shape \(5120, 2\), it must be \(n, 3\)", V, F[:, :2]),
            ("vertex 17 .counted from 0. has a coordinate that is not a finite number", nan, F),
            ("vertex 3 .counted from 0. has a coordinate that is not", infinite, F),
            (r"F\[5, 2\] is 2562, but V has 2562 vertices: they are counted from 0", V, foreign),
            (r"F\[6, 0\] is -1", V, negative),
            ("F has a number above 9223372036854775807, which is no index",
             V, negative.astype(np.uint64)),
            ("V has masked entries: fill them", np.ma.masked_less(V, 0), F),
            ("face 7 .counted from 0. uses a vertex twice", V, twice),
            ("has the vertices of face 0: remove", V, again),
            ("has more than two faces", V, third),
            ("run along their common edge in the same direction", V, turned),
            ("there are no faces|is isolated|are isolated", V, np.zeros((0, 3), int)),
            ("above 1e50 in magnitude: scale the mesh", V * 1e60, F),
        ):
            self.refused(ValueError, text, ss.simplify, v, f, 200, 50)
        loose = np.vstack([V, [[9, 9, 9]]])
        text = "V, F: .*vertex 2562 .counted from 0. is isolated"
        self.refused(ValueError, text, ss.eigenpairs, loose, F, 20)
        text = "Vc, Fc: .*face 7 .counted from 0. uses one vertex twice"
        self.refused(ValueError, text, ss.evaluate, V, F, V, twice, scipy.sparse.eye(2562), 20)

    def test_options(self):
        pairs, coarse = ss.eigenpairs(V, F, 20), ss.eigenpairs(RUN.V, RUN.F, 20)
        longer = ss.eigenpairs(V * [1, 1, 2], F, 20)
        signals = V.copy()
        signals[9, 1] = np.nan
        for text, options in (
            ("n is 200.0, it must be an integer", dict(n=200.0)),
            ("n is True, it must be an integer", dict(n=True)),
            ("n is of the type ndarray, it must be an integer", dict(n=V)),
            ("shape is of the type ndarray, it must be a number", dict(shape=V)),
            ("shape is 'round', it must be a number", dict(shape="round")),
            ("placement is 3, it must be None, 'on_edge', 'midpoint' or 'free'", dict(placement=3)),
            ("binary is 1, it must be True or False", dict(binary=1)),
            ("preserve_border is 'no', it must be True or False", dict(preserve_border="no")),
            ("fit_operators is 1, it must be True or False", dict(fit_operators=1)),
            ("keep has the dtype float64, it must hold integers", dict(keep=np.ones(3))),
            ("eigenpairs is of the type ndarray, it must be Eigenpairs", dict(eigenpairs=V)),
            ("progress is 3, it must be None or a function", dict(progress=3)),
        ):
            self.refused(TypeError, text, ss.simplify, V, F, **{"n": 200, **options})
        for text, options in (
            ("n is 2563, it must be an integer from 1 to 2562", dict(n=2563)),
            ("n is 1000000000000000000000000, it must be", dict(n=10 ** 24)),
            ("k is 2562, it must be an integer from 1 to 2561", dict(k=2562)),
            ("preset is 'good', it must be 'best', 'fast' or 'paper'", dict(preset="good")),
            ("mass is 'full', it must be None, 'lumped', 'averaged', 'voronoi' or 'consistent'",
             dict(mass="full")),
            ("placement is 'edge'", dict(placement="edge")),
            ("shape is -1, it must be a finite number from 0", dict(shape=-1)),
            ("shape is nan", dict(shape=np.nan)),
            ("self_intersections is 'no', it must be", dict(self_intersections="no")),
            ("relocate is 'yes', it must be", dict(relocate="yes")),
            ("prefer is 'form', it must be None, 'spectrum' or 'shape'", dict(prefer="form")),
            ("prefer='shape' is a matter of relocation", dict(prefer="shape", preset="paper")),
            ("binary asks for a P of ones and zeros", dict(binary=True)),
            ("fit_operators fits to eigenvectors, but signals are given",
             dict(signals=V, fit_operators=True)),
            (r"keep\[1\] is 2562, but V has 2562 vertices", dict(keep=[0, 2562])),
            (r"keep has the shape \(5,\), but V has 2562 vertices: give True or False",
             dict(keep=np.ones(5, bool))),
            ("keep has a 0 or a 1 for each vertex of V, but integers are indices: pass booleans",
             dict(keep=np.ones(2562, int))),
            (r"keep\[1\] names vertex 0 again: .* a mask must hold booleans", dict(keep=[0, 0])),
            ("keep has 'sharp', an angle must follow", dict(keep="sharp")),
            ("keep has 'seams', it must be 'border', 'sharp:ANGLE'",
             dict(keep=["border", "seams"])),
            (r"keep has the shape \(1, 2\), it must be \(n,\)", dict(keep=[[1, 2]])),
            ("mask has the entry 2, it must hold True", dict(mask=np.full(2562, 2))),
            (r"mask has the shape \(5,\), it must be \(2562,\)", dict(mask=np.ones(5, bool))),
            ("mask leaves no face", dict(mask=np.zeros(2562, bool))),
            ("signals has 9 rows, but V has 2562 vertices", dict(signals=V[:9])),
            (r"signals\[9, 1\] is not a finite number", dict(signals=signals)),
            ("k is 50, but signals, which replace the eigenvectors, has 3 columns",
             dict(signals=V, k=50)),
            ("k is 100, but signals.* has 1 column: leave out k", dict(signals=V[:, :1], k=100)),
            ("signals has no columns", dict(signals=V[:, :0])),
            ("only one can be given", dict(signals=V, eigenpairs=pairs)),
            ("eigenpairs are 20, but k is 50: pass k=20", dict(eigenpairs=pairs, k=50)),
            ("eigenpairs are of the averaged mass, but the lumped one is wanted: "
             "pass mass='averaged'", dict(eigenpairs=pairs, k=20, mass="lumped")),
            ("eigenpairs are of 200 vertices, but V has 2562", dict(eigenpairs=coarse, k=20)),
            ("eigenpair . is not one of this mesh and operator in the averaged mass",
             dict(eigenpairs=longer, k=20)),
            ("quadrics_above is 0.5, it must be a number from 1", dict(quadrics_above=0.5)),
            ("quadrics_above goes with free placement",
             dict(quadrics_above=3, binary=True, relocate="none")),
            ("pre_simplify is 100, it must not be below n, which is 200", dict(pre_simplify=100)),
            ("max_error is 0, it must be a finite number above 0", dict(max_error=0)),
            ("threads is 0, it must be an integer from 1", dict(threads=0)),
        ):
            self.refused(ValueError, text, ss.simplify, V, F, **{"n": 200, **options})
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'colour'"):
            ss.simplify(V, F, 200, colour=1)

    def test_other_functions(self):
        pairs, P = RUN.eigenpairs, RUN.P
        bad = P.copy()
        bad.data[0] = np.nan
        longer = ss.eigenpairs(V * [1, 1, 2], F, 20)
        evaluate = partial(ss.evaluate, V, F, RUN.V, RUN.F)
        fit = partial(ss.fit_operators, RUN.V, RUN.F, P, pairs)
        distances = partial(ss.distances, pairs)
        for text, function, *arguments in (
            ("P is of the type ndarray, it must be a sparse matrix", evaluate, P.toarray()),
            ("P has the dtype complex128, it must hold real numbers", evaluate, P * 1j),
            ("operators must be Fitted_operators", partial(evaluate, operators=pairs), P),
            ("values has the dtype <U4, .*transfer_labels", RUN.interpolate, np.full(2562, "east")),
            ("labels has the dtype float64, it must hold integers or strings",
             RUN.transfer_labels, V[:, 0]),
            ("sources is of the type ndarray, it must be a sparse matrix",
             distances, np.ones((1, 2562)) / 2562),
            (r"energies is \(1, 2\), it must be a tuple \(t_min, t_max, sigma, steps\)",
             partial(distances, energies=(1, 2)), 0, "wave_kernel"),
        ):
            self.refused(TypeError, text, function, *arguments)
        for text, function, *arguments in (
            (r"P has the shape \(2562, 200\), it must be \(200, 2562\), coarse x fine",
             evaluate, P.T),
            (r"P\[0, \d+\] is not a finite number", evaluate, bad),
            ("eigenpairs are those of another mesh", partial(evaluate, eigenpairs=longer), P, 20),
            ("eigenpairs are of the averaged mass, but the lumped one is wanted",
             partial(evaluate, eigenpairs=pairs), P, 20, "lumped"),
            ("rings is 3, it must be an integer from 1 to 2", partial(fit, rings=3)),
            ("mass is 'lumped', it must be None, 'diagonal' or 'edges'",
             partial(fit, mass="lumped")),
            (r"values has the shape \(200, 3\), it must be \(2562,\) or \(2562, c\)",
             RUN.interpolate, RUN.V),
            (r"for unit=True it must be \(2562, c\)", partial(RUN.interpolate, unit=True), V[:, 0]),
            (r"labels has the shape \(2562, 3\), it must be \(2562,\)", RUN.transfer_labels, V),
            ("tolerance is 0, it must be", partial(ss.eigenpairs, tolerance=0), V, F, 20),
            ("kind is 'euclidean', it must be", distances, 0, "euclidean"),
            ("sources is 2562, it must be an integer from 0 to 2561", distances, 2562),
            (r"sources\[0\] is -1, but the mesh has 2562", distances, [-1]),
            (r"sources has the shape \(1, 3\), it must be \(any, 2562\), sources x vertices",
             distances, scipy.sparse.csr_matrix((1, 3))),
            ("time belongs to the kind 'diffusion'", partial(distances, time=1), 0),
            ("time is -1, it must be", partial(distances, time=-1), 0, "diffusion"),
            ("the time -1 is negative", ss.heat_kernel_signature, pairs, [-1]),
        ):
            self.refused(ValueError, text, function, *arguments)


class Documentation(unittest.TestCase):
    def test_the_example_of_its_page(self):
        page = os.path.join(os.path.dirname(__file__), "..", "examples", "python", "README.md")
        with open(page) as file:
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
        public = [getattr(ss, name) for name in ss.__all__]
        functions = [function for function in public if inspect.isfunction(function)]
        for kind in ss.Level, ss.Simplification, ss.Eigenpairs:
            functions += [method for name, method in inspect.getmembers(kind, callable)
                          if name[0] != "_" and name != "save"]
        self.assertEqual(set(dir(ss)), set(ss.__all__) | {"__version__", "__doc__"})
        for function in functions:
            name = function.__name__
            self.assertTrue(function.__module__.startswith("spectral_simplification"))
            doc = inspect.getdoc(function)
            parameters = dict(inspect.signature(function).parameters)
            parameters.pop("self", None)
            wanted = ["Parameters"] * bool(parameters)
            wanted += ["Returns"] * (function is not ss.write_mesh) + ["Raises"] * bool(parameters)
            sections = re.findall(r"(?m)^(Parameters|Returns|Raises)\n---+$", doc)
            self.assertEqual(sections, wanted, name)
            for parameter in parameters.values():
                self.assertIsNot(parameter.annotation, parameter.empty)
                words = r"(?m)^([\w*]+, )*[*]*%s(, \w+)*( : |$)" % parameter.name
                self.assertRegex(doc, words, name)
            self.assertLess(max(map(len, doc.split("\n"))), 140)

    def test_objects_are_described(self):
        for kind in (getattr(ss, name) for name in ss.__all__):
            if inspect.isclass(kind):
                self.assertTrue(kind.__doc__)
                for name, member in vars(kind).items():
                    if isinstance(member, property):
                        self.assertTrue(member.__doc__, name)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
