// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_VERTEX_MAPS_H
#define CGAL_SPECTRAL_TOOLBOX_VERTEX_MAPS_H

#include <CGAL/Spectral_geometry/Run_control.h>
#include <CGAL/Spectral_toolbox/internal/separate_compilation.h>

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

The search is exact and returns the first of equally near points. It is fast if the leading columns
tell most points apart, as in embeddings by eigenvectors, and if each query is near the next.

@param points n x d, n and d positive, finite
@param queries m x d, finite
@param control of the search; each thread reports, at every query
@return m indices in [0, n)

Throws `std::invalid_argument` for sizes that do not match, an empty set of points or a number that
is not finite; `Cancelled` when it is cancelled.
*/
CGAL_SPECTRAL_TOOLBOX_INLINE std::vector<Eigen::Index>
nearest_rows(const Eigen::MatrixXd& points, const Eigen::MatrixXd& queries,
             const Run_control& control = {});

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
@param control of the search
@return one vertex of X for each vertex of Y

Throws `std::invalid_argument` if there are fewer eigenvectors than C needs, or a number that is not
finite.
*/
CGAL_SPECTRAL_TOOLBOX_INLINE std::vector<Eigen::Index>
target_to_source_map(const Eigen::MatrixXd& C, const Eigen::MatrixXd& source_vectors,
                     const Eigen::MatrixXd& target_vectors, const Run_control& control = {});

/*!
returns the map from vertices of Y to *points* of X of a functional map \f$ C_{X,Y} \f$. Each vertex
y goes to the point of the faces of X, embedded by \f$ x \mapsto C \Phi_X(x)^\top \f$, that is
nearest to \f$ \Phi_Y(y)^\top \f$ (Ezuz and Ben-Chen 2017). Only faces within one edge of the
nearest vertex are searched.

A vertex map between coarse meshes is off by half an edge; this one is as exact as the functional
map, and between coarse meshes the maps made of it keep more modes.

@param C, source_vectors, target_vectors, control as for `target_to_source_map()`
@param source_T the triangles of X, m x 3
@return n_Y x n_X, at most three nonzeros in each row, none negative, which sum to 1
*/
CGAL_SPECTRAL_TOOLBOX_INLINE Eigen::SparseMatrix<double>
target_to_source_points(const Eigen::MatrixXd& C, const Eigen::MatrixXd& source_vectors,
                        const Eigen::MatrixXi& source_T, const Eigen::MatrixXd& target_vectors,
                        const Run_control& control = {});

/// @}

} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_TOOLBOX_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_TOOLBOX)

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_toolbox/internal/Ball_tree.h>
#include <CGAL/Spectral_geometry/internal/surface/closest_point_search.h>
#include <CGAL/Spectral_geometry/internal/numerics/for_each_task.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

#include <map>
#include <set>

namespace CGAL::Spectral_geometry {

std::vector<Eigen::Index> nearest_rows(const Eigen::MatrixXd& points,
                                       const Eigen::MatrixXd& queries, const Run_control& control)
{
  internal::require(points.size() != 0,
                    "nearest rows: there is no point to search for, pass at least one.");
  internal::check_dimension("the number of columns of the queries", queries.cols(), points.cols());
  internal::require(control.threads >= 1, "nearest rows: the number of threads is ",
                    control.threads, ", pass at least 1.");
  for(const Eigen::MatrixXd* matrix : {&points, &queries})
    for(Eigen::Index i = 0; i < matrix->rows(); ++i)
      internal::require(matrix->row(i).allFinite(), "nearest rows: row ", i, " of the ",
                        matrix == &points ? "points" : "queries",
                        " has an entry that is not finite, check the maps and eigenvectors.");

  const internal::Ball_tree tree(points.transpose());
  const Eigen::MatrixXd query_columns = queries.transpose();
  std::vector<Eigen::Index> result(static_cast<std::size_t>(queries.rows()));
  constexpr Eigen::Index share = 256;
  internal::for_each_task(
      static_cast<int>((queries.rows() + share - 1) / share), control.threads, [&](const int k) {
        Eigen::Index place = 0;
        for(Eigen::Index i = k * share; i < (std::min)((k + 1) * share, queries.rows()); ++i) {
          internal::report_to(control, {Phase::matching, double(i) / double(queries.rows())});
          result[i] = tree.nearest(query_columns.col(i), place);
        }
      });
  return result;
}

Eigen::MatrixXd functional_map_of_vertex_map(const Eigen::MatrixXd& source_vectors,
                                             const Eigen::MatrixXd& target_vectors,
                                             const Eigen::SparseMatrix<double>& target_B,
                                             const std::vector<Eigen::Index>& target_to_source)
{
  internal::check_dimension("the number of entries of the vertex map",
                            static_cast<Eigen::Index>(target_to_source.size()),
                            target_vectors.rows());
  for(std::size_t y = 0; y < target_to_source.size(); ++y)
    internal::require(target_to_source[y] >= 0 && target_to_source[y] < source_vectors.rows(),
                      "vertex map: entry ", y, " is ", target_to_source[y],
                      ", it must be a vertex of the source, in [0, ", source_vectors.rows(), ").");
  internal::check_dimension("the size of the mass of the target", target_B.rows(),
                            target_vectors.rows());
  internal::check_dimension("the number of columns of the mass of the target", target_B.cols(),
                            target_vectors.rows());
  Eigen::MatrixXd pulled_back(target_vectors.rows(), source_vectors.cols());
  for(Eigen::Index y = 0; y < pulled_back.rows(); ++y)
    pulled_back.row(y) = source_vectors.row(target_to_source[y]);
  return target_vectors.transpose() * (target_B * pulled_back);
}

std::vector<Eigen::Index> target_to_source_map(const Eigen::MatrixXd& C,
                                               const Eigen::MatrixXd& source_vectors,
                                               const Eigen::MatrixXd& target_vectors,
                                               const Run_control& control)
{
  internal::require(source_vectors.cols() >= C.cols() && target_vectors.cols() >= C.rows(),
                    "vertex map: C is ", internal::size_name(C), ", but there are ",
                    target_vectors.cols(), " target and ", source_vectors.cols(),
                    " source eigenvectors, pass as many.");
  return nearest_rows(source_vectors.leftCols(C.cols()) * C.transpose(),
                      target_vectors.leftCols(C.rows()), control);
}

Eigen::SparseMatrix<double> target_to_source_points(const Eigen::MatrixXd& C,
                                                    const Eigen::MatrixXd& source_vectors,
                                                    const Eigen::MatrixXi& source_T,
                                                    const Eigen::MatrixXd& target_vectors,
                                                    const Run_control& control)
{
  const std::vector<Eigen::Index> nearest =
      target_to_source_map(C, source_vectors, target_vectors, control);
  internal::check_triangles(source_T, source_vectors.rows());
  const Eigen::MatrixXd points = C * source_vectors.leftCols(C.cols()).transpose(),
                        queries = target_vectors.leftCols(C.rows()).transpose();
  const auto star = internal::Vertex_rings::of_faces(source_T, source_vectors.rows());
  Eigen::Matrix3Xd lengths(3, source_T.rows()); // squared
  for(Eigen::Index t = 0; t < source_T.rows(); ++t)
    for(int c = 0; c < 3; ++c)
      lengths(c, t) =
          (points.col(source_T(t, (c + 1) % 3)) - points.col(source_T(t, c))).squaredNorm();

  Eigen::Matrix3Xi corners(3, queries.cols()); // of the face, for each query
  Eigen::Matrix3Xd weights(3, queries.cols());
  const auto look = [&](const Eigen::Index y) {
    const int near = int(nearest[y]);
    std::set<int> faces; // within one edge of the nearest vertex
    for(const int around : star[near])
      for(const int v : source_T.row(around))
        faces.insert(star[v].begin(), star[v].end());
    std::map<int, double> distances; // of their vertices, squared
    const auto distance = [&](const int v) {
      const auto [place, is_new] = distances.try_emplace(v);
      if(is_new)
        place->second = (points.col(v) - queries.col(y)).squaredNorm();
      return place->second;
    };
    double best = distance(near);
    corners.col(y).setConstant(near);
    weights.col(y) = Eigen::Vector3d::UnitX();
    for(const int t : faces) {
      const Eigen::Vector3d d(distance(source_T(t, 0)), distance(source_T(t, 1)),
                              distance(source_T(t, 2)));
      const internal::Point_of_triangle candidate =
          internal::closest_point_of_triangle_by_distances(d, lengths.col(t));
      if(candidate.squared_distance < best) {
        best = candidate.squared_distance;
        corners.col(y) = source_T.row(t);
        weights.col(y) = candidate.weights;
      }
    }
  };
  internal::for_each_task(queries.cols(), control.threads, look, 64);
  std::vector<Eigen::Triplet<double>> entries;
  for(Eigen::Index y = 0; y < queries.cols(); ++y)
    for(int c = 0; c < 3; ++c)
      if(weights(c, y) != 0)
        entries.emplace_back(int(y), corners(c, y), weights(c, y));
  Eigen::SparseMatrix<double> result(target_vectors.rows(), source_vectors.rows());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

} // namespace CGAL::Spectral_geometry

#endif // definitions

#endif // CGAL_SPECTRAL_TOOLBOX_VERTEX_MAPS_H
