# Copyright (c) 2026 The Spectral mesh simplification authors.
#
# SPDX-License-Identifier: GPL-3.0-or-later
#
# What a user of spectral_simplification sees: the module is compiled with this text and executes it when it is loaded.

from collections.abc import Callable, Sequence
import numpy
import scipy.sparse

Progress = Callable[[str, float], bool | None]


def interpolate(self, values: numpy.ndarray, unit: bool = False) -> numpy.ndarray:
    """interpolate(values, unit=False) -> numpy.ndarray

    Carries what the vertices of V have to this mesh, as P @ values: (v,) or (v, c) real numbers give (n,) or
    (n, c). Integers, as those of colours, are rounded and keep their dtype; unit=True gives rows, of normals for
    instance, the length 1."""
    values = numpy.asarray(values)
    if values.ndim not in (1, 2) or len(values) != self.P.shape[1]:
        raise ValueError(f"values has the shape {values.shape}, it must be ({self.P.shape[1]},) or "
                         f"({self.P.shape[1]}, c), a row for each vertex of V.")
    if values.dtype.kind not in "fiu":
        raise TypeError(f"values has the dtype {values.dtype}, it must hold real numbers; transfer_labels() carries others.")
    result = self.P @ values.astype(float)
    if unit:
        if values.ndim == 1:
            raise ValueError(f"values has the shape {values.shape}, for unit=True it must be ({len(values)}, c).")
        length = numpy.linalg.norm(result, axis=1, keepdims=True)
        return result / numpy.where(length > 0, length, 1)
    if values.dtype.kind == "f":
        return result
    limits = numpy.iinfo(values.dtype)
    return numpy.clip(numpy.rint(result), limits.min, limits.max).astype(values.dtype)


def transfer_labels(self, labels: numpy.ndarray) -> numpy.ndarray:
    """transfer_labels(labels) -> numpy.ndarray

    Carries (v,) labels, integers or strings, of the vertices of V to this mesh: of those in a row of P the one of most
    weight, the smallest of several."""
    labels = numpy.asarray(labels)
    if labels.shape != (self.P.shape[1],):
        raise ValueError(f"labels has the shape {labels.shape}, it must be ({self.P.shape[1]},), one for each vertex of V.")
    if labels.dtype.kind not in "biuSU":
        raise TypeError(f"labels has the dtype {labels.dtype}, it must hold integers or strings; interpolate() carries real "
                        "numbers.")
    names, of = numpy.unique(labels, return_inverse=True)
    weights = self.P @ scipy.sparse.csr_matrix((numpy.ones(len(of)), (numpy.arange(len(of)), of)))
    return names[numpy.asarray(weights.argmax(axis=1)).ravel()]


Level.interpolate, Level.transfer_labels = interpolate, transfer_labels
del interpolate, transfer_labels


def simplify(V: numpy.ndarray, F: numpy.ndarray, n: int, k: int | None = None, preset: str = 'best', *,
             mass: str | None = None, placement: str | None = None, shape: float | None = None,
             self_intersections: str | None = None, relocate: str | None = None, flips: str = 'none',
             keep: Sequence[int] | None = None, binary: bool = False, preserve_border: bool = False,
             signals: numpy.ndarray | None = None, eigenpairs: Eigenpairs | None = None,
             quadrics_above: float | None = None, pre_simplify: int | None = None, max_error: float | None = None,
             fit_operators: bool = False, coefficients: numpy.ndarray | None = None, boundary: str = 'neumann',
             intrinsic_delaunay: bool = False, threads: int | None = None,
             progress: Progress | None = None) -> Simplification:
    """Simplifies a triangle mesh and keeps the first k eigenvalues and eigenvectors of its Laplacian.

    V          (v, 3) real numbers, positions in any unit of length
    F          (f, 3) integers, the corners of the triangles, counted from 0: an oriented manifold, with or
               without border, in which each vertex has a face
    n          how many vertices are left; 3 k or more, a warning says so
    k          how many eigenvectors are kept, the constant one included; below v. 100, or as many as signals has
               columns
    preset     'best': what keeps the spectrum best; 'fast': the same with pre_simplify at 30 n, at least 10000;
               'paper': what the paper describes (Lescoat et al., Spectral Mesh Simplification, 2020). Each of the
               next five, quadrics_above and pre_simplify overrides it
    mass       'lumped' (paper) or 'averaged' (best), the mean of lumped and consistent mass, which keeps
               eigenvalues of coarse meshes much closer, or 'voronoi', lumped by mixed Voronoi areas
    placement  'on_edge' (paper), 'midpoint' or 'free' (best): where the vertex goes that replaces an edge
    shape      weight of the shape beside the spectrum (best: 3, paper: 0)
    self_intersections
               'allow' (paper) or 'refuse' (best) collapses that put a face through another
    relocate   'none' (paper), 'sampled' (best), 'carried' or 'carried_and_sampled': how vertices are moved
               afterwards. With 'sampled' P is that of the closest points and does not follow vertex_map
    flips      'none', 'spectral' or 'delaunay': which edges are flipped before that
    keep       indices of vertices of V that stay where they are; vertex_map says where they went
    binary     P of ones and zeros, it picks vertices of V. Not with relocate='sampled'
    preserve_border
               no edge is drawn away from the border
    signals    (v, s) real numbers, functions to keep instead of eigenvectors
    eigenpairs what eigenpairs(V, F, k, mass) returned, to save the solve; the first k are used
    quadrics_above
               while there are more than this many times n vertices, collapse edges by quadrics alone: much faster,
               and as good (best, fast: 15, paper: infinity, never). Levels above that are those of quadrics
    pre_simplify
               first reduce a larger mesh to this number of vertices by quadrics alone; 0: do not. None: as the preset
    max_error  stop before the relative error sqrt(E / sum lambda^2) exceeds this; 0.1 keeps the spectrum
               closely, 0.14 well
    fit_operators
               afterwards choose a Laplacian and a mass of the simplified mesh so that they have the spectrum of V, F
               as nearly as they can: fitted of the result. Takes another solve, for a fifth more eigenpairs, unless
               eigenpairs are given
    coefficients
               (v, 7) of the operator whose spectrum is kept, -div(D grad phi) = lambda rho phi, in place of the
               Laplacian: rho, and D as xx, xy, xz, yy, yz, zz; see weighted_coefficients() and
               curvature_coefficients(). The simplified mesh has those of the result
    intrinsic_delaunay
               for a mesh of needles: keep eigenvectors of its intrinsic Delaunay triangulation
    boundary   'neumann' or 'dirichlet': on the border the derivative of functions across it is zero, or they are
    threads    for eigenpairs, costs and relocation, all cores by default and at most; the result does not depend
               on it
    progress   is called with a phase and the fraction of it that is done, at most twenty times a second; raises
               Cancelled where it returns False. Ctrl-C raises KeyboardInterrupt without it

    Nothing is repaired, and V and F are not changed: ValueError and TypeError name the first thing that is
    wrong. What is done but not advised is a UserWarning, and so is a run that ends above n."""
    if k is None and signals is None:
        k = 100
    return _simplify(locals())


def eigenpairs(V: numpy.ndarray, F: numpy.ndarray, k: int = 100, mass: str = 'averaged', *, tolerance: float = 1e-10,
               coefficients: numpy.ndarray | None = None, boundary: str = 'neumann',
               intrinsic_delaunay: bool = False, threads: int | None = None,
               progress: Progress | None = None) -> Eigenpairs:
    """The first k eigenpairs of a mesh, L phi = lambda M phi, at the scale of V: eigenvalues have the unit of
    an inverse area.

    V, F       as of simplify(), but faces need not form a manifold
    k          from 1 to v
    mass       'lumped', 'averaged' or 'voronoi'
    tolerance  relative accuracy of the solver; a run of simplify() has pairs of 1e-8
    coefficients, boundary, intrinsic_delaunay, threads, progress
               as of simplify()"""
    return _eigenpairs(locals())


def evaluate(V: numpy.ndarray, F: numpy.ndarray, Vc: numpy.ndarray, Fc: numpy.ndarray, P: scipy.sparse.csr_matrix,
             k: int = 100, mass: str = 'averaged', *, eigenpairs: Eigenpairs | None = None,
             operators: Fitted_operators | None = None, coefficients: numpy.ndarray | None = None,
             coarse_coefficients: numpy.ndarray | None = None, boundary: str = 'neumann',
             intrinsic_delaunay: bool = False, threads: int | None = None,
             progress: Progress | None = None) -> Evaluation:
    """How well a coarse mesh keeps the first k eigenpairs of a fine one, whoever made it. Figures are for both
    meshes at unit area; compare figures of one mass only.

    V, F       the fine mesh
    Vc, Fc     the coarse mesh
    P          (vc, v) sparse matrix that carries functions from fine to coarse, rows that sum to 1
    k          modes to judge
    mass       'lumped', 'averaged' or 'voronoi', of both operators
    eigenpairs of the fine mesh in that mass, k or more, to save the solve
    operators  what fit_operators() returned, in the place of the coarse mesh's own operators
    coefficients
               of the operator, (v, 7), as of simplify()
    coarse_coefficients
               those of the coarse mesh, (vc, 7), coefficients of a Simplification; P @ coefficients where None
    boundary, intrinsic_delaunay, threads, progress
               as of simplify()"""
    return _evaluate(locals())


def fit_operators(Vc: numpy.ndarray, Fc: numpy.ndarray, P: scipy.sparse.csr_matrix, eigenpairs: Eigenpairs,
                  k: int | None = None, mass: str | None = None, rings: int | None = None, *,
                  low_modes: float = 2.5, orthonormality: float = 0.01, plain: float = 0.2,
                  coefficients: numpy.ndarray | None = None, progress: Progress | None = None) -> Fitted_operators:
    """Chooses the entries of a Laplacian and a mass on a coarse mesh so that they have the eigenpairs of the fine
    one as nearly as they can: for functional maps and spectral distances, not for geometry.

    Vc, Fc     the coarse mesh
    P          (vc, v) sparse matrix from fine to coarse
    eigenpairs of the fine mesh, a fifth more than are to be judged
    k          how many eigenpairs of the fitted operators are computed; as many as eigenpairs are
    mass       'diagonal' (lumped mass) or 'edges' (averaged mass): where M has entries
    rings      where L has entries: 1, the edges, or 2, two rings, the default
    low_modes  e: mode k has the weight (lambda_k + 4 pi)^-e; more is for distances, less for C_L
    orthonormality
               weight of orthonormality; more lowers C_D and raises C_L
    plain      weight of the whole residual; more keeps the modes beyond k
    coefficients
               (vc, 7), of the coarse mesh: coefficients of a Simplification; where eigenpairs have such
    progress   as of simplify()"""
    return _fit_operators(locals())


def weighted_coefficients(density: numpy.ndarray | None = None, conductivity: numpy.ndarray | None = None) -> numpy.ndarray:
    """(v, 7), the coefficients of -div(c grad phi) = lambda rho phi, with the density rho and the conductivity c at
    each vertex, positive; 1 where None. simplify() and others take them."""
    return _weighted_coefficients(locals())


def curvature_coefficients(V: numpy.ndarray, F: numpy.ndarray, anisotropy: float) -> numpy.ndarray:
    """(v, 7), the coefficients of an anisotropic Laplacian (Andreux et al. 2014): in the direction of a principal
    curvature kappa the surface conducts 1 / (1 + anisotropy |kappa|), with kappa in units of the sphere of the same
    area. simplify() and others take them.

    V, F       as of simplify(), but faces need not form a manifold
    anisotropy from 0, the Laplacian itself"""
    return _curvature_coefficients(locals())


def functional_map(eigenpairs: Eigenpairs, coarse_eigenpairs: Eigenpairs,
                   P: scipy.sparse.csr_matrix) -> numpy.ndarray:
    """C, coarse modes x fine modes: a function of the fine coefficients x has the coarse coefficients C x. It is
    vectors^T M P vectors, the first two of coarse_eigenpairs, the last of eigenpairs, at the scale of the
    meshes; evaluate() has that of unit area. P is (vc, v), sparse."""
    return _functional_map(locals())


def distances(eigenpairs: Eigenpairs, sources: int | Sequence[int] | scipy.sparse.spmatrix, kind: str = 'biharmonic', *,
              time: float | None = None, energies: tuple | None = None) -> numpy.ndarray:
    """Spectral distances from sources to all vertices: (v,) for one source, (v, s) for s of them.

    sources    a vertex, a sequence of vertices, or points: a sparse interpolation (s, v), such as run.Q[fine vertices]
    kind       'diffusion', 'biharmonic' or 'commute_time', which are squared, or 'wave_kernel', which is not
    time       of 'diffusion', in the unit of area; 1 / (4 lambda_1)
    energies   of 'wave_kernel', (t_min, t_max, sigma, steps); wave_kernel_energies(eigenpairs)

    To compare two meshes pass the time or the energies of one of them for both."""
    return _distances(locals())


def heat_kernel_signature(eigenpairs: Eigenpairs, times: Sequence[float] | None = None) -> numpy.ndarray:
    """(v, t), one column for each time, which has the unit of area; 100 times of constant ratio if none are given."""
    return _heat_kernel_signature(locals())


def wave_kernel_signature(eigenpairs: Eigenpairs, energies: tuple | None = None) -> numpy.ndarray:
    """(v, steps), one column for each energy; those of wave_kernel_energies(eigenpairs) if none are given."""
    return _wave_kernel_signature(locals())


def wave_kernel_energies(eigenpairs: Eigenpairs, steps: int = 100) -> tuple:
    """(t_min, t_max, sigma, steps): energies, logarithms of eigenvalues, as Aubry et al. 2011 choose them."""
    return _wave_kernel_energies(locals())


def match(VX: numpy.ndarray, FX: numpy.ndarray, VY: numpy.ndarray, FY: numpy.ndarray, n: int = 600, k: int = 100, *,
          mass: str = 'averaged', landmarks: numpy.ndarray | None = None, proxy: str = 'spectral',
          operators: str = 'fitted', initial: int = 20, matcher: str = 'product_manifold_filter',
          filter_iterations: int = 5, fine_iterations: int = 18, local_weight: float = 4, threads: int | None = None,
          progress: Progress | None = None) -> 'Match':
    """Finds for each vertex of X the vertex of Y that corresponds to it, as the program shape_matching does: over
    simplified meshes, by a functional map from signatures, ZoomOut and the Product Manifold Filter or BCICP.

    VX, FX, VY, FY
               two meshes, nearly isometric, as of simplify()
    n          vertices of the simplified meshes, 3 k or more
    k          eigenvectors of all meshes, from 10 to n
    mass       'lumped', 'averaged' or 'voronoi'
    landmarks  (l, 2) integers, pairs of vertices of X and Y that are known to correspond
    proxy      'spectral', 'garland_heckbert' or 'none': how the meshes are simplified
    operators  'fitted' or 'mesh', of the simplified meshes: fitted to the spectra of X and Y, or their own
    initial    modes of the functional map from signatures, from 4 to 60
    matcher    'product_manifold_filter' or 'bcicp' (Ren et al. 2018): what makes the map between the
               simplified meshes bijective
    filter_iterations
               of the matcher; 0: none
    fine_iterations
               of bending X onto Y in space, at the end; 0: none
    local_weight
               of curvature in these, from 0 to 100
    threads    all cores by default; the result does not depend on it
    progress   as of simplify(); the fraction counts three stages"""
    return _match(locals())
