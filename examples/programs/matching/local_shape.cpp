// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "local_shape.h"

#include <CGAL/Spectral_geometry/Cancelled.h>
#include <CGAL/Spectral_geometry/vertex_maps.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>
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
  Eigen::MatrixXd result(modes.rows() + local.rows(), modes.cols());
  result.topRows(modes.rows()) = modes;
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

Local_refinement::Part Local_refinement::part(std::vector<Eigen::Index> vertices, Eigen::Index modes) const
{
  const Eigen::Index n = static_cast<Eigen::Index>(vertices.size());
  Part part;
  part.modes.resize(modes, n);
  part.bands.resize(m_of_X.rows(), n);
  Eigen::VectorXd mass(n);
  for(Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index x = vertices[static_cast<std::size_t>(i)];
    part.modes.col(i) = m_X.spectral.pairs.vectors.row(x).head(modes).transpose();
    part.bands.col(i) = m_of_X.col(x);
    mass(i) = m_X.spectral.op.mass(x);
  }
  // Least squares, weighted by the mass: the modes are orthonormal over all vertices, not over some.
  const Eigen::MatrixXd weighted = part.modes * mass.asDiagonal();
  part.to_map = (weighted * part.modes.transpose()).ldlt().solve(weighted);
  part.complete = n == m_of_X.cols();
  part.vertices = std::move(vertices);
  return part;
}

Eigen::VectorXd Local_refinement::weights(const Part& part, const std::vector<Eigen::Index>& images) const
{
  const Eigen::Index bands = m_of_X.rows();
  Eigen::VectorXd products = Eigen::VectorXd::Zero(bands), squares_X = products, squares_Y = products;
  for(std::size_t i = 0; i < images.size(); ++i) {
    const auto of_x = part.bands.col(static_cast<Eigen::Index>(i)), of_y = m_of_Y.col(images[i]);
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

std::vector<Eigen::Index> Local_refinement::walked(const Part& part, const Eigen::MatrixXd& points,
                                                   const Eigen::MatrixXd& queries) const
{
  const std::vector<Eigen::Index>& images = part.images;
  std::vector<Eigen::Index> result(images.size());
  const auto work = [&](std::size_t begin, std::size_t end) {
    std::vector<std::size_t> last_query(m_neighbours_Y.size(), images.size()); // that tried this vertex
    for(std::size_t i = begin; i < end; ++i) {
      Eigen::Index best = -1;
      double smallest = std::numeric_limits<double>::infinity();
      const auto try_vertex = [&](Eigen::Index y) {
        if(std::exchange(last_query[static_cast<std::size_t>(y)], i) == i)
          return;
        const double d = (points.col(y) - queries.col(static_cast<Eigen::Index>(i))).squaredNorm();
        if(d < smallest) {
          smallest = d;
          best = y;
        }
      };
      try_vertex(images[i]);
      if(part.complete)
        for(const Eigen::Index neighbour : m_neighbours_X[i])
          try_vertex(images[static_cast<std::size_t>(neighbour)]);
      for(Eigen::Index from = -1; from != best;) {
        from = best;
        for(const Eigen::Index y : m_neighbours_Y[static_cast<std::size_t>(from)])
          try_vertex(y);
      }
      result[i] = best;
    }
  };
  std::vector<std::thread> others;
  const std::size_t share =
      (images.size() + static_cast<std::size_t>(m_threads) - 1) / static_cast<std::size_t>(m_threads);
  for(std::size_t begin = share; begin < images.size(); begin += share)
    others.emplace_back(work, begin, (std::min)(begin + share, images.size()));
  work(0, (std::min)(share, images.size()));
  for(std::thread& other : others)
    other.join();
  return result;
}

std::vector<Eigen::Index> Local_refinement::searched(const Part& part, const Eigen::MatrixXd& C,
                                                     const Eigen::VectorXd& weights) const
{
  const Eigen::MatrixXd modes = C * m_Y.spectral.pairs.vectors.leftCols(C.cols()).transpose();
  return SG::nearest_rows(embedding(modes, m_of_Y, weights).transpose(),
                          embedding(part.modes, part.bands, weights).transpose(), m_threads);
}

void Local_refinement::set_map(const Part& part, Eigen::MatrixXd& C) const
{
  Eigen::MatrixXd at_images(static_cast<Eigen::Index>(part.images.size()), C.cols());
  for(std::size_t i = 0; i < part.images.size(); ++i)
    at_images.row(static_cast<Eigen::Index>(i)) =
        m_Y.spectral.pairs.vectors.row(part.images[i]).head(C.cols());
  C = part.to_map * at_images;
}

std::size_t Local_refinement::iterate(Part& part, Eigen::MatrixXd& C, Eigen::VectorXd& weights,
                                      bool among_all) const
{
  const Eigen::MatrixXd modes = C * m_Y.spectral.pairs.vectors.leftCols(C.cols()).transpose();
  // What a band is worth is judged by a map that did not use it.
  if(m_largest_weight > 0)
    weights = this->weights(part, walked(part, modes, part.modes));
  std::vector<Eigen::Index> next =
      among_all ? searched(part, C, weights)
                : walked(part, embedding(modes, m_of_Y, weights), embedding(part.modes, part.bands, weights));
  std::size_t changes = 0;
  for(std::size_t i = 0; i < next.size(); ++i)
    changes += next[i] != part.images[i];
  part.images = std::move(next);
  set_map(part, C);
  return changes;
}

std::vector<Eigen::Index> Local_refinement::refine(Eigen::MatrixXd& C, int iterations,
                                                   const Keep_going& keep_going) const
{
  constexpr std::size_t sample_size = 3000;
  constexpr int round = 4, iterations_of_all = 4;
  std::vector<Eigen::Index> vertices(static_cast<std::size_t>(m_of_X.cols()));
  std::iota(vertices.begin(), vertices.end(), Eigen::Index(0));
  Part all = part(vertices, C.rows());
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(m_of_X.rows());

  std::mt19937 random(2020);
  for(std::size_t i = 0; i < vertices.size() && i < sample_size; ++i)
    std::swap(vertices[i], vertices[i + random() % (vertices.size() - i)]);
  vertices.resize((std::min)(vertices.size(), sample_size));
  Part sample = part(std::move(vertices), C.rows());
  if(iterations > 0)
    sample.images = searched(sample, C, weights);
  for(int i = 1; i <= iterations; ++i) {
    if(!keep_going())
      throw SG::Cancelled();
    const bool among_all = i % round == 0;
    const std::size_t changes = iterate(sample, C, weights, among_all);
    if(among_all && 1000 * changes <= sample.images.size())
      break;
  }

  all.images = searched(all, C, weights);
  if(iterations > 0)
    set_map(all, C);
  for(int i = 0; i < (std::min)(iterations, iterations_of_all); ++i) {
    if(!keep_going())
      throw SG::Cancelled();
    if(iterate(all, C, weights, false) == 0)
      break;
  }
  return all.images;
}
