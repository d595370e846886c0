# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# pyfm_recipe.py PAIRS P.mtx map.txt: what a user of pyFM does with the files of spectral_simplify,
# in NumPy alone, and whether it holds. pyFM's TriMesh keeps W, A, eigenvalues and eigenvectors, and
# uses A only in products `A @ f`: any symmetric matrix will do.

import sys

import numpy as np


def read_mtx(path):
    with open(path) as stream:
        stream.readline()
        rows, columns, _ = map(int, stream.readline().split())
        entries = np.loadtxt(stream, ndmin=2)
    matrix = np.zeros((rows, columns))
    matrix[entries[:, 0].astype(int) - 1, entries[:, 1].astype(int) - 1] = entries[:, 2]
    return matrix


class Mesh:  # the attributes of pyFM.mesh.TriMesh
    def __init__(self, pairs, which):
        self.W = read_mtx(pairs + "/" + which + "_L.mtx")
        self.A = read_mtx(pairs + "/" + which + "_mass.mtx")
        self.eigenvalues = np.load(pairs + "/" + which + "_eigenvalues.npy")
        self.eigenvectors = np.load(pairs + "/" + which + "_eigenvectors.npy")

    def project(self, f):
        return self.eigenvectors.T @ (self.A @ f)


def require(holds, sentence):
    if not holds:
        sys.exit("does not hold: " + sentence)


def main(pairs, restriction, map_file):
    fine, coarse = Mesh(pairs, "fine"), Mesh(pairs, "coarse")
    P, vertex_map, C = read_mtx(restriction), np.loadtxt(map_file, dtype=int), np.load(pairs + "/C.npy")
    for mesh in (fine, coarse):
        k = len(mesh.eigenvalues)
        require(np.allclose(mesh.project(mesh.eigenvectors), np.eye(k), atol=1e-6), "orthonormal in A")
        residual = mesh.W @ mesh.eigenvectors - (mesh.A @ mesh.eigenvectors) * mesh.eigenvalues
        require(np.abs(residual).max() < 1e-3 * np.abs(mesh.W @ mesh.eigenvectors).max(), "W Phi = A Phi Lambda")
    require(np.allclose(C, coarse.project(P @ fine.eigenvectors), atol=1e-6), "C of the files")

    # pyFM.spectral.p2p_to_FM(vertex_map, coarse.eigenvectors, fine.eigenvectors, A2=fine.A): from
    # coarse to fine.
    back = fine.project(coarse.eigenvectors[vertex_map])
    require(np.linalg.norm(back[:10, :10] - C[:10, :10].T) < 0.5 * np.linalg.norm(C[:10, :10]),
            "the vertex map gives the transposed map, roughly")
    # A diagonal in place of A is another product, in which the eigenvectors are not orthonormal.
    if np.count_nonzero(coarse.A - np.diag(np.diag(coarse.A))):
        wrong = coarse.eigenvectors.T @ (np.diag(coarse.A)[:, None] * coarse.eigenvectors)
        require(np.abs(wrong - np.eye(len(wrong))).max() > 0.1, "the diagonal of A does not do")


main(*sys.argv[1:])
