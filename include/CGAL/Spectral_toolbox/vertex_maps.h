// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_VERTEX_MAPS_H
#define CGAL_SPECTRAL_TOOLBOX_VERTEX_MAPS_H

#include <CGAL/Spectral_toolbox/internal/separate_compilation.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <vector>

/*!
\file
From functional maps to vertices and back.

Directions: a functional map \f$ C_{X,Y} \f$ takes functions on a *source* X to functions on a
*target* Y, from the coefficients in \f$ \Phi_X \f$ to those in \f$ \Phi_Y \f$; its size is (modes
of Y) x (modes of X). A vertex map T that induces one goes the other way: it says for each vertex of
Y which vertex of X it is, and \f$ (C f)(y) = f(T(y)) \f$. Eigenvectors are orthonormal in the
masses of their meshes, all of them scaled to unit area, or all as they are when the areas agree.
*/

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationTransfer
/// @{

/*!
returns for each row of `queries` the index of the row of `points` that is nearest to it in the
Euclidean norm.

Exact, the first of those that are equally near. Fast where the leading columns tell most points
apart, as those of embeddings by eigenvectors do, and where queries come in an order in which one is
near to the next.

@param points n x d, n and d positive, finite
@param queries m x d, finite
@param threads how many share the queries, at least 1; the result does not depend on it
@return m indices in [0, n)

Throws `std::invalid_argument` for sizes that do not match, an empty set of points or a number that
is not finite.
*/
CGAL_SPECTRAL_TOOLBOX_INLINE std::vector<Eigen::Index>
nearest_rows(const Eigen::MatrixXd& points, const Eigen::MatrixXd& queries, int threads = 1);

/*!
returns the functional map \f$ C_{X,Y} = \Phi_Y^\top B_Y \Pi \Phi_X \f$ of a vertex map T from Y to
X, where \f$ (\Pi f)_y = f_{T(y)} \f$.

@param source_vectors \f$ \Phi_X \f$, n_X x k_X
@param target_vectors \f$ \Phi_Y \f$, n_Y x k_Y, orthonormal in `target_B`
@param target_B the mass of Y, n_Y x n_Y
@param target_to_source T, one vertex of X for each vertex of Y
@return k_Y x k_X

Throws `std::invalid_argument` if sizes do not match or an entry of T is no vertex of X.
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::MatrixXd functional_map_of_vertex_map(
    const Eigen::MatrixXd& source_vectors, const Eigen::MatrixXd& target_vectors,
    const Eigen::SparseMatrix<double>& target_B, const std::vector<Eigen::Index>& target_to_source);

/*!
returns the vertex map from Y to X of a functional map \f$ C_{X,Y} \f$: for each vertex y of Y the
vertex x of X whose image \f$ C \Phi_X(x)^\top \f$ is nearest to \f$ \Phi_Y(y)^\top \f$ (Ovsjanikov
et al. 2012; with C of a vertex map this is the step of ZoomOut, Melzi et al. 2019).

@param C k_Y x k_X
@param source_vectors \f$ \Phi_X \f$, at least k_X columns, of which the first are used
@param target_vectors \f$ \Phi_Y \f$, at least k_Y columns
@param threads of the search
@return one vertex of X for each vertex of Y

Throws `std::invalid_argument` if there are fewer eigenvectors than C needs, or a number that is not
finite.
*/
CGAL_SPECTRAL_TOOLBOX_INLINE std::vector<Eigen::Index>
target_to_source_map(const Eigen::MatrixXd& C, const Eigen::MatrixXd& source_vectors,
                     const Eigen::MatrixXd& target_vectors, int threads = 1);

/*!
returns the map from the vertices of Y to *points* of X of a functional map \f$ C_{X,Y} \f$: for
each vertex y the point of the faces of X, embedded by \f$ x \mapsto C \Phi_X(x)^\top \f$, that is
nearest to \f$ \Phi_Y(y)^\top \f$ (Ezuz and Ben-Chen 2017), looked for in the faces within one edge
of the nearest vertex.

A vertex map between coarse meshes is off by half an edge; this one is as exact as the functional
map, and between coarse meshes the maps made of it keep more modes.

@param C, source_vectors, target_vectors, threads as for `target_to_source_map()`
@param source_T the triangles of X, m x 3
@return n_Y x n_X, at most three nonzeros in each row, none negative, which sum to 1
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::SparseMatrix<double>
target_to_source_points(const Eigen::MatrixXd& C, const Eigen::MatrixXd& source_vectors,
                        const Eigen::MatrixXi& source_T, const Eigen::MatrixXd& target_vectors,
                        int threads = 1);

/// @}

} // namespace CGAL::Spectral_geometry

#ifndef CGAL_SPECTRAL_TOOLBOX_COMPILED
#include <CGAL/Spectral_toolbox/internal/vertex_maps_impl.h>
#endif

#endif // CGAL_SPECTRAL_TOOLBOX_VERTEX_MAPS_H
