// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "registration.h"

#include "elastic_surface.h"
#include "matcher.h"

#include <CGAL/Spectral_geometry/Run_control.h>
#include <CGAL/Spectral_toolbox/vertex_maps.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace SG = CGAL::Spectral_geometry;
namespace SMS = CGAL::Surface_mesh_simplification;

namespace {

// One column per vertex; zero where the faces cancel.
Eigen::MatrixXd vertex_normals(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T)
{
  Eigen::MatrixXd normals = Eigen::MatrixXd::Zero(3, V.cols());
  for(Eigen::Index t = 0; t < T.rows(); ++t) {
    const Eigen::Vector3d a = V.col(T(t, 0)), b = V.col(T(t, 1)), c = V.col(T(t, 2));
    for(int k = 0; k < 3; ++k)
      normals.col(T(t, k)) += (b - a).cross(c - a);
  }
  for(Eigen::Index v = 0; v < V.cols(); ++v)
    normals.col(v).normalize();
  return normals;
}

// Mean curvature smoothed by two implicit steps of heat of ever longer times, four times the time
// from one to the next; a band is the difference of two neighbours, scaled to variance 1. One row
// per band.
Eigen::MatrixXd curvature_bands(const Shape& shape, const Eigen::MatrixXd& normals,
                                double shortest_time, Eigen::Index bands)
{
  const SG::Laplace_operator& op = shape.spectral.op;
  const Eigen::MatrixXd LV = op.L * shape.matrices.V;
  const Eigen::VectorXd curvature = LV.cwiseProduct(normals.transpose()).rowwise().sum();
  const Eigen::SparseMatrix<double> M(op.mass.asDiagonal());
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  solver.analyzePattern(op.L + M);
  Eigen::MatrixXd result(bands, curvature.size());
  Eigen::VectorXd smoother;
  for(Eigen::Index band = 0; band <= bands; ++band) {
    solver.factorize(M + shortest_time * std::pow(4., static_cast<double>(band)) * op.L);
    if(solver.info() != Eigen::Success)
      throw std::runtime_error("the curvature of a mesh cannot be smoothed, its Laplace operator "
                               "is not semidefinite: repair it.");
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

// The mesh with at most `vertices` vertices where edges can be collapsed, by Lindstrom and Turk's
// costs, which keep the volume.
SG::Mesh_matrices control_mesh(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                               std::size_t vertices)
{
  Mesh mesh = mesh_of({V.transpose(), T});
  if(mesh.number_of_vertices() > vertices)
    SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate(vertices, mesh),
                       CGAL::parameters::get_cost(SMS::LindstromTurk_cost<Mesh>())
                           .get_placement(SMS::LindstromTurk_placement<Mesh>()));
  return SG::mesh_matrices(mesh);
}

Eigen::VectorXd vertex_areas(const SG::Mesh_matrices& mesh)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(mesh.V.rows());
  for(Eigen::Index t = 0; t < mesh.T.rows(); ++t) {
    const Eigen::Vector3d a = mesh.V.row(mesh.T(t, 0)), b = mesh.V.row(mesh.T(t, 1)),
                          c = mesh.V.row(mesh.T(t, 2));
    for(int k = 0; k < 3; ++k)
      result(mesh.T(t, k)) += (b - a).cross(c - a).norm();
  }
  return result / result.sum();
}

// Points of a fine mesh moved with a control mesh: by its vertex that is nearest at rest and the
// neighbours of that one, none of which lies on another limb.
Eigen::MatrixXd carried(const Eigen::MatrixXd& fine, const Eigen::MatrixXd& fine_normals,
                        const Elastic_surface& elastic, const Eigen::MatrixXd& P, int threads)
{
  const SG::Mesh_matrices& rest = elastic.rest();
  std::vector<std::set<Eigen::Index>> ring(static_cast<std::size_t>(rest.V.rows()));
  for(Eigen::Index t = 0; t < rest.T.rows(); ++t)
    for(int k = 0; k < 3; ++k)
      for(int l = 0; l < 3; ++l)
        ring[static_cast<std::size_t>(rest.T(t, k))].insert(rest.T(t, l));
  constexpr double weight_of_normals = 0.1;
  const Eigen::MatrixXd V = rest.V.transpose(), normals = vertex_normals(V, rest.T);
  Eigen::MatrixXd points(V.cols(), 6), queries(fine.cols(), 6);
  points << V.transpose(), weight_of_normals * normals.transpose();
  queries << fine.transpose(), weight_of_normals * fine_normals.transpose();
  const std::vector<Eigen::Index> nearest = SG::nearest_rows(points, queries, {threads});
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3, fine.cols());
  for(Eigen::Index v = 0; v < fine.cols(); ++v) {
    const std::set<Eigen::Index>& around =
        ring[static_cast<std::size_t>(nearest[static_cast<std::size_t>(v)])];
    double farthest = 0, sum = 0;
    for(const Eigen::Index c : around)
      farthest = (std::max)(farthest, (fine.col(v) - V.col(c)).norm());
    for(const Eigen::Index c : around) {
      const Eigen::Vector3d offset = fine.col(v) - V.col(c);
      const double closeness = 1.001 - (farthest > 0 ? offset.norm() / farthest : 1.);
      sum += closeness * closeness;
      result.col(v) += closeness * closeness *
                       (elastic.rotations()[static_cast<std::size_t>(c)] * offset + P.col(c));
    }
    result.col(v) /= sum;
  }
  return result;
}

// Springs from control vertices to points of Y, stiff along the normals of Y.
class Springs
{
public:
  explicit Springs(Eigen::Index n)
    : D(static_cast<std::size_t>(n), Eigen::Matrix3d::Zero())
    , f(Eigen::MatrixXd::Zero(3, n))
  {}

  // Hardly any where the surfaces face opposite ways.
  void add(Eigen::Index i, const Eigen::Vector3d& normal, const Eigen::Vector3d& at,
           const Eigen::Vector3d& at_normal, double stiffness, double along_surface = 0.3)
  {
    constexpr double least_agreement = 0.01;
    const double agreement = (std::max)(normal.dot(at_normal), least_agreement);
    const Eigen::Matrix3d spring = stiffness * agreement *
                                   ((1 - along_surface) * at_normal * at_normal.transpose() +
                                    along_surface * Eigen::Matrix3d::Identity());
    D[static_cast<std::size_t>(i)] += spring;
    f.col(i) += spring * at;
  }

  std::vector<Eigen::Matrix3d> D;
  Eigen::MatrixXd f;
};

} // namespace

Registration::Points Registration::points(const Shape& shape, const SG::Mesh_matrices& mesh)
{
  Points result;
  result.V = mesh.V.transpose() / std::sqrt(shape.area);
  result.normals = vertex_normals(result.V, mesh.T);
  return result;
}

Registration::Surface Registration::surface(const Shape& shape, double shortest_time,
                                            Eigen::Index bands)
{
  constexpr std::size_t control_vertices = 2000;
  Surface s;
  static_cast<Points&>(s) = points(shape, shape.matrices);
  s.bands = curvature_bands(shape, s.normals, shortest_time, bands);
  s.control = control_mesh(s.V, shape.matrices.T, control_vertices);
  s.nearest = SG::nearest_rows(s.V.transpose(), s.control.V);
  s.areas = vertex_areas(s.control);
  return s;
}

Registration::Registration(const Shape& X, const Shape& Y, double largest_weight, int threads)
  : m_shape_X(X)
  , m_shape_Y(Y)
  , m_largest_weight(largest_weight)
  , m_threads(threads)
{
  // Both have these bands, of times from that of half an edge of the coarser mesh to that of two
  // thirds of the last mode's wavelength, sqrt(pi / modes): what is larger the modes know.
  const double vertices = static_cast<double>((std::min)(X.matrices.V.rows(), Y.matrices.V.rows()));
  const double modes =
      static_cast<double>((std::min)(X.spectral.pairs.size(), Y.spectral.pairs.size()));
  const double shortest_time = 0.3 / vertices, longest_time = 4 / (CGAL_PI * modes);
  Eigen::Index bands = 0;
  for(double time = 4 * shortest_time; time <= longest_time; time *= 4)
    ++bands;
  std::tie(m_X, m_Y) = side_by_side(
      threads, [&] { return surface(X, shortest_time, bands); },
      [&] { return surface(Y, shortest_time, bands); });
  m_bands_X.resize(bands, m_X.control.V.rows());
  for(Eigen::Index i = 0; i < m_bands_X.cols(); ++i)
    m_bands_X.col(i) = m_X.bands.col(m_X.nearest[static_cast<std::size_t>(i)]);
}

Eigen::MatrixXd Registration::at_control(const Eigen::MatrixXd& functions, const Surface& surface)
{
  Eigen::MatrixXd result(surface.control.V.rows(), functions.cols());
  for(Eigen::Index i = 0; i < result.rows(); ++i)
    result.row(i) = functions.row(surface.nearest[static_cast<std::size_t>(i)]);
  return result;
}

Eigen::VectorXd Registration::weights(const std::vector<Eigen::Index>& images) const
{
  const Eigen::Index bands = m_bands_X.rows();
  Eigen::VectorXd products = Eigen::VectorXd::Zero(bands), squares_X = products,
                  squares_Y = products;
  for(std::size_t i = 0; i < images.size(); ++i) {
    const auto of_x = m_bands_X.col(static_cast<Eigen::Index>(i)), of_y = m_Y.bands.col(images[i]);
    const double area = m_X.areas(static_cast<Eigen::Index>(i));
    products += area * of_x.cwiseProduct(of_y);
    squares_X += area * of_x.cwiseAbs2();
    squares_Y += area * of_y.cwiseAbs2();
  }
  Eigen::VectorXd result(bands);
  for(Eigen::Index band = 0; band < bands; ++band) {
    const double norms = std::sqrt(squares_X(band) * squares_Y(band));
    const double r = norms > 0 ? (std::max)(0., products(band) / norms) : 0.;
    result(band) = r * r < (1 - r * r) * m_largest_weight ? r * r / (1 - r * r) : m_largest_weight;
  }
  return result;
}

Eigen::MatrixXd Registration::features(const Eigen::MatrixXd& V, const Eigen::MatrixXd& normals,
                                       const Eigen::MatrixXd& bands, const Eigen::VectorXd& weights)
{
  constexpr double weight_of_normals = 0.03, weight_of_bands = 0.01;
  Eigen::MatrixXd result(V.cols(), 6 + weights.size());
  result << V.transpose(), weight_of_normals * normals.transpose(),
      weight_of_bands * bands.topRows(weights.size()).transpose() * weights.asDiagonal();
  return result;
}

Eigen::MatrixXd Registration::settled(Eigen::MatrixXd C, int iterations,
                                      const Keep_going& keep_going) const
{
  const Eigen::MatrixXd phi = at_control(m_shape_X.spectral.pairs.vectors.leftCols(C.rows()), m_X),
                        psi = at_control(m_shape_Y.spectral.pairs.vectors.leftCols(C.cols()), m_Y),
                        bands_X = m_bands_X.transpose(),
                        bands_Y = at_control(m_Y.bands.transpose(), m_Y);
  // Least squares, weighted by areas: the modes are orthonormal over all vertices, not over some.
  const Eigen::MatrixXd weighted = phi.transpose() * m_X.areas.asDiagonal();
  const Eigen::MatrixXd to_map = (weighted * phi).ldlt().solve(weighted);
  std::vector<Eigen::Index> images;
  for(int iteration = 0; iteration < iterations; ++iteration) {
    if(!keep_going())
      throw SG::Cancelled();
    const Eigen::MatrixXd modes = psi * C.transpose();
    std::vector<Eigen::Index> next = SG::nearest_rows(modes, phi, {m_threads});
    if(m_largest_weight > 0) { // what a band is worth is judged by a map that did not use it
      std::vector<Eigen::Index> fine;
      for(const Eigen::Index y : next)
        fine.push_back(m_Y.nearest[static_cast<std::size_t>(y)]);
      const Eigen::VectorXd weights = this->weights(fine);
      Eigen::MatrixXd points(psi.rows(), C.rows() + weights.size()),
          queries(phi.rows(), points.cols());
      points << modes, bands_Y * weights.asDiagonal();
      queries << phi, bands_X * weights.asDiagonal();
      next = SG::nearest_rows(points, queries, {m_threads});
    }
    std::size_t changes = images.empty() ? next.size() : 0;
    for(std::size_t i = 0; i < images.size(); ++i)
      changes += next[i] != images[i];
    images = std::move(next);
    Eigen::MatrixXd at_images(phi.rows(), C.cols());
    for(Eigen::Index i = 0; i < at_images.rows(); ++i)
      at_images.row(i) = psi.row(images[static_cast<std::size_t>(i)]);
    C = to_map * at_images;
    if(500 * changes <= images.size())
      break;
  }
  return C;
}

Registration::Maps Registration::refine(const Eigen::MatrixXd& C, int iterations,
                                        const Keep_going& keep_going) const
{
  const Eigen::MatrixXd &phi = m_shape_X.spectral.pairs.vectors,
                        &psi = m_shape_Y.spectral.pairs.vectors;
  if(iterations == 0)
    return {SG::target_to_source_map(C, psi, phi, {m_threads}), {}};

  // The modes say where a limb is, but not how it is turned about its axis: it is thinner than they
  // are long. The surface is first drawn with both smoothed, which leaves limbs free to turn with
  // what they grow out of, then at the vertices that face where their images do. Neighbouring
  // rotations stay a little alike to the end: a paw that is free settles as it happens to be
  // turned.
  constexpr double smoothing_time = 1e-2, first_stiffness = 1e3, second_stiffness = 1e5,
                   likeness = 10, last_likeness = 0.3;
  constexpr int first_iterations = 20, second_iterations = 10;
  Elastic_surface elastic(m_X.control);
  const Eigen::Index n = m_X.control.V.rows();
  constexpr int settling_iterations = 4;
  std::vector<Eigen::Index> images =
      SG::target_to_source_map(settled(C, (std::min)(iterations, settling_iterations), keep_going),
                               psi, at_control(phi, m_X), {m_threads});
  Eigen::MatrixXd targets(3, n);
  for(Eigen::Index i = 0; i < n; ++i)
    targets.col(i) = m_Y.V.col(images[static_cast<std::size_t>(i)]);
  const Eigen::VectorXd first_stiffnesses = first_stiffness * m_X.areas;
  const auto smoothed = elastic.smoothing(m_X.areas / smoothing_time);
  const Eigen::MatrixXd smooth_targets = smoothed(targets);
  Eigen::MatrixXd P = smooth_targets;
  Springs springs(n);
  for(Eigen::Index i = 0; i < n; ++i)
    springs.D[static_cast<std::size_t>(i)] = first_stiffnesses(i) * Eigen::Matrix3d::Identity();
  for(int iteration = 0; iteration < first_iterations; ++iteration) {
    elastic.fit_rotations(P, likeness);
    springs.f = (smooth_targets + P - smoothed(P)) * first_stiffnesses.asDiagonal();
    P = elastic.solve(springs.D, springs.f);
  }
  for(int iteration = 0; iteration < second_iterations; ++iteration) {
    const Eigen::MatrixXd normals = vertex_normals(P, m_X.control.T);
    springs = Springs(n);
    for(Eigen::Index i = 0; i < n; ++i)
      springs.add(i, normals.col(i), targets.col(i),
                  m_Y.normals.col(images[static_cast<std::size_t>(i)]),
                  second_stiffness * m_X.areas(i), 1.);
    elastic.fit_rotations(P, likeness);
    P = elastic.solve(springs.D, springs.f);
  }

  Eigen::VectorXd none(0);
  for(int iteration = 0; iteration < iterations; ++iteration) {
    if(!keep_going())
      throw SG::Cancelled();
    const bool by_curvature = m_largest_weight > 0 && 3 * iteration < 2 * iterations;
    const double stiffness = 3 * iteration < 2 * iterations ? 3e3 : 1e4;
    const Eigen::VectorXd weights = by_curvature ? this->weights(images) : none;
    const Eigen::MatrixXd normals = vertex_normals(P, m_X.control.T);
    const Eigen::MatrixXd of_X = features(P, normals, m_bands_X, weights),
                          of_Y = features(m_Y.V, m_Y.normals, m_Y.bands, weights);
    images = SG::nearest_rows(of_Y, of_X, {m_threads});
    springs = Springs(n);
    for(Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Index y = images[static_cast<std::size_t>(i)];
      springs.add(i, normals.col(i), m_Y.V.col(y), m_Y.normals.col(y), stiffness * m_X.areas(i));
    }
    Eigen::MatrixXd of_control(m_Y.areas.size(), of_Y.cols());
    for(Eigen::Index k = 0; k < of_control.rows(); ++k)
      of_control.row(k) = of_Y.row(m_Y.nearest[static_cast<std::size_t>(k)]);
    const std::vector<Eigen::Index> origins = SG::nearest_rows(of_X, of_control, {m_threads});
    for(Eigen::Index k = 0; k < of_control.rows(); ++k) {
      const Eigen::Index y = m_Y.nearest[static_cast<std::size_t>(k)],
                         i = origins[static_cast<std::size_t>(k)];
      springs.add(i, normals.col(i), m_Y.V.col(y), m_Y.normals.col(y), stiffness * m_Y.areas(k));
    }
    for(int step = 0; step < 2; ++step) {
      elastic.fit_rotations(P, last_likeness);
      P = elastic.solve(springs.D, springs.f);
    }
  }
  elastic.fit_rotations(P);
  // For each vertex of X that has gone with the control mesh the nearest of Y.
  const auto map = [&](const Points& of_X, const Eigen::MatrixXi& T, const Points& of_Y) {
    const Eigen::MatrixXd moved = carried(of_X.V, of_X.normals, elastic, P, m_threads);
    const Eigen::MatrixXd no_bands_X(0, of_X.V.cols()), no_bands_Y(0, of_Y.V.cols());
    return SG::nearest_rows(features(of_Y.V, of_Y.normals, no_bands_Y, none),
                            features(moved, vertex_normals(moved, T), no_bands_X, none),
                            {m_threads});
  };
  Maps result;
  result.map = map(m_X, m_shape_X.matrices.T, m_Y);
  if(m_shape_X.full || m_shape_Y.full)
    result.of_full = map(points(m_shape_X, m_shape_X.read()), m_shape_X.read().T,
                         points(m_shape_Y, m_shape_Y.read()));
  return result;
}
