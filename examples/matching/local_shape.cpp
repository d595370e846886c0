// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "local_shape.h"

#include <CGAL/Spectral_geometry/Cancelled.h>
#include <CGAL/Spectral_geometry/vertex_maps.h>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <thread>
#include <utility>

namespace SG = CGAL::Spectral_geometry;

namespace {

Eigen::MatrixXd vertex_normals(const SG::Mesh_matrices& mesh)
{
  Eigen::MatrixXd normals = Eigen::MatrixXd::Zero(mesh.V.rows(), 3);
  for(Eigen::Index t = 0; t < mesh.T.rows(); ++t) {
    const Eigen::Vector3d a = mesh.V.row(mesh.T(t, 0)), b = mesh.V.row(mesh.T(t, 1)),
                          c = mesh.V.row(mesh.T(t, 2));
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    for(int k = 0; k < 3; ++k)
      normals.row(mesh.T(t, k)) += normal;
  }
  normals.rowwise().normalize();
  return normals;
}

// Mean curvature smoothed by two implicit steps of heat of ever longer times, four times the time from one to the next;
// a band is the difference of two neighbours, scaled to variance 1. One row per band.
Eigen::MatrixXd curvature_bands(const Shape& shape, double shortest_time, Eigen::Index bands)
{
  const SG::Laplace_operator& op = shape.spectral.op;
  const Eigen::MatrixXd LV = op.L * shape.matrices.V;
  const Eigen::VectorXd curvature = LV.cwiseProduct(vertex_normals(shape.matrices)).rowwise().sum();
  const Eigen::SparseMatrix<double> M(op.mass.asDiagonal());
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  solver.analyzePattern(op.L + M);
  Eigen::MatrixXd result(bands, curvature.size());
  Eigen::VectorXd smoother;
  for(Eigen::Index band = 0; band <= bands; ++band) {
    solver.factorize(M + shortest_time * std::pow(4., static_cast<double>(band)) * op.L);
    if(solver.info() != Eigen::Success)
      throw std::runtime_error(
          "the curvature of a mesh cannot be smoothed, its Laplace operator is not semidefinite: repair it.");
    const Eigen::VectorXd once = solver.solve(curvature);
    const Eigen::VectorXd smooth = solver.solve(Eigen::VectorXd(op.mass.cwiseProduct(once)));
    if(band > 0) {
      const Eigen::VectorXd difference = smoother - smooth;
      const double variance = difference.cwiseAbs2().dot(op.mass);
      result.row(band - 1) = difference / (variance > 0 ? std::sqrt(variance) : 1.);
    }
    smoother = smooth;
  }
  return result;
}

std::vector<std::vector<Eigen::Index>> neighbours_of_vertices(const SG::Mesh_matrices& mesh)
{
  std::vector<std::vector<Eigen::Index>> result(static_cast<std::size_t>(mesh.V.rows()));
  for(Eigen::Index t = 0; t < mesh.T.rows(); ++t)
    for(int k = 0; k < 3; ++k)
      for(int other : {1, 2}) // twice in the interior, which nothing minds
        result[static_cast<std::size_t>(mesh.T(t, k))].push_back(mesh.T(t, (k + other) % 3));
  return result;
}

// Below the modes, one column per vertex.
Eigen::MatrixXd embedding(const Eigen::MatrixXd& modes, const Eigen::MatrixXd& local,
                          const Eigen::VectorXd& weights)
{
  Eigen::MatrixXd result(modes.cols() + local.rows(), modes.rows());
  result.topRows(modes.cols()) = modes.transpose();
  result.bottomRows(local.rows()) = weights.asDiagonal() * local;
  return result;
}

} // namespace

Local_refinement::Local_refinement(const Shape& X, const Shape& Y, double largest_weight, int threads)
  : m_X(X)
  , m_Y(Y)
  , m_largest_weight(largest_weight)
  , m_threads(threads)
  , m_neighbours_X(neighbours_of_vertices(X.matrices))
  , m_neighbours_Y(neighbours_of_vertices(Y.matrices))
{
  // The same bands for both, of times from that of half an edge of the coarser mesh to that of a third of the last mode's
  // wavelength, sqrt(pi / modes): what is larger the modes know.
  const double vertices = static_cast<double>((std::min)(X.matrices.V.rows(), Y.matrices.V.rows()));
  const double modes = static_cast<double>((std::min)(X.spectral.pairs.size(), Y.spectral.pairs.size()));
  const double shortest_time = 0.3 / vertices, longest_time = 1 / (CGAL_PI * modes);
  Eigen::Index bands = 0;
  for(double time = 4 * shortest_time; time <= longest_time; time *= 4)
    ++bands;
  m_of_X = curvature_bands(X, shortest_time, bands);
  m_of_Y = curvature_bands(Y, shortest_time, bands);
}

Eigen::VectorXd Local_refinement::weights(const std::vector<Eigen::Index>& map) const
{
  const Eigen::Index bands = m_of_X.rows();
  Eigen::VectorXd products = Eigen::VectorXd::Zero(bands), squares_X = products, squares_Y = products;
  for(Eigen::Index x = 0; x < m_of_X.cols(); ++x) {
    const auto of_x = m_of_X.col(x), of_y = m_of_Y.col(map[static_cast<std::size_t>(x)]);
    products += of_x.cwiseProduct(of_y);
    squares_X += of_x.cwiseAbs2();
    squares_Y += of_y.cwiseAbs2();
  }
  Eigen::VectorXd result(bands);
  for(Eigen::Index band = 0; band < bands; ++band) {
    const double norms = std::sqrt(squares_X(band) * squares_Y(band));
    const double r = norms > 0 ? (std::max)(0., products(band) / norms) : 0.;
    result(band) = r * r < (1 - r * r) * m_largest_weight ? r * r / (1 - r * r) : m_largest_weight;
  }
  return result;
}

std::vector<Eigen::Index> Local_refinement::step(const std::vector<Eigen::Index>& map,
                                                 const Eigen::MatrixXd& C,
                                                 const Eigen::VectorXd& weights) const
{
  const Eigen::MatrixXd points =
      embedding(m_Y.spectral.pairs.vectors.leftCols(C.cols()) * C.transpose(), m_of_Y, weights);
  const Eigen::MatrixXd queries = embedding(m_X.spectral.pairs.vectors.leftCols(C.rows()), m_of_X, weights);
  std::vector<Eigen::Index> result(map.size());
  const auto work = [&](std::size_t begin, std::size_t end) {
    std::vector<std::size_t> last_query(m_neighbours_Y.size(), map.size()); // that tried this vertex
    for(std::size_t x = begin; x < end; ++x) {
      Eigen::Index best = -1;
      double smallest = std::numeric_limits<double>::infinity();
      const auto try_vertex = [&](Eigen::Index y) {
        if(std::exchange(last_query[static_cast<std::size_t>(y)], x) == x)
          return;
        const double d = (points.col(y) - queries.col(static_cast<Eigen::Index>(x))).squaredNorm();
        if(d < smallest) {
          smallest = d;
          best = y;
        }
      };
      try_vertex(map[x]);
      for(const Eigen::Index neighbour : m_neighbours_X[x])
        try_vertex(map[static_cast<std::size_t>(neighbour)]);
      for(Eigen::Index from = -1; from != best;) {
        from = best;
        for(const Eigen::Index y : m_neighbours_Y[static_cast<std::size_t>(from)])
          try_vertex(y);
      }
      result[x] = best;
    }
  };
  std::vector<std::thread> others;
  const std::size_t share =
      (map.size() + static_cast<std::size_t>(m_threads) - 1) / static_cast<std::size_t>(m_threads);
  for(std::size_t begin = share; begin < map.size(); begin += share)
    others.emplace_back(work, begin, (std::min)(begin + share, map.size()));
  work(0, (std::min)(share, map.size()));
  for(std::thread& other : others)
    other.join();
  return result;
}

void Local_refinement::refine(std::vector<Eigen::Index>& map, Eigen::MatrixXd& C, int iterations,
                              const Keep_going& keep_going) const
{
  std::vector<Eigen::Index> by_modes = map;
  for(int i = 0; i < iterations; ++i) {
    if(!keep_going())
      throw SG::Cancelled();
    // What a band is worth is judged by a map that did not use it.
    if(m_largest_weight > 0)
      by_modes = step(map, C, Eigen::VectorXd::Zero(m_of_X.rows()));
    std::vector<Eigen::Index> next = step(map, C, weights(by_modes));
    const bool moved = next != map;
    map = std::move(next);
    C = SG::functional_map_of_vertex_map(m_Y.spectral.pairs.vectors.leftCols(C.cols()),
                                         m_X.spectral.pairs.vectors.leftCols(C.rows()), m_X.spectral.op.B,
                                         map);
    if(!moved && i > 0) // C was another map's at first
      break;
  }
}
