// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Relocation: what it gains, its guards, the one-call form.

#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/spectral_relocation.h>

#include "catch.h"
#include "relocation_helpers.h"

#include <CGAL/Spectral_geometry/Run_control.h>
#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_geometry/operator_coefficients.h>
#include <CGAL/Spectral_geometry/internal/relocation/Distance_term.h>
#include <CGAL/Spectral_geometry/internal/relocation/Relocation_guards.h>
#include <CGAL/Spectral_geometry/internal/surface/Border_polyline.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Spectral_geometry/internal/surface/closest_point_search.h>
#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>

#include <Eigen/Dense>

namespace test_relocation {

using namespace spectral_test;
using Signals = SG::Relocation_options::Signals;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The result with the positions that it is about.
struct Relocated : SG::Relocation_result
{
  Eigen::MatrixXd V;
};

Relocated relocated(const Simplified_mesh& s, const SG::Relocation_options& options = {},
                    const std::vector<bool>& fixed = {})
{
  Eigen::MatrixXd V = s.coarse.V;
  return {SG::relocate_positions(V, s.coarse.T, s.P, s.fine, s.F(), s.Z(), 0.5, fixed, options), V};
}

Relocated relocated_within(const Simplified_mesh& s, const SG::internal::Relocation_limits& limits,
                           const SG::Relocation_options& options = {})
{
  Eigen::MatrixXd V = s.coarse.V;
  return {SG::internal::relocate_within(V, s.coarse.T, s.P, s.fine, s.F(), s.Z(), 0.5, {}, options,
                                        limits),
          V};
}

SG::Relocation_options with_signals(const Signals signals)
{
  SG::Relocation_options options;
  options.signals = signals;
  return options;
}

SMS::Spectral_edge_collapse_options default_options_with(const Eigen::Index K)
{
  SMS::Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = K;
  return options;
}

double area(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T)
{
  return SG::laplace_operator(V, T).mass.sum();
}

// The first n eigenvalues at unit area.
Eigen::ArrayXd eigenvalues(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const Eigen::Index n)
{
  const SG::Laplace_operator op = SG::laplace_operator(V, T, 0.5);
  return op.mass.sum() * SG::eigenpairs(op, n).values.array();
}

bool intersects_itself(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T)
{
  return !SG::internal::self_intersecting_faces(V, T).empty();
}

double distance_from_border(const shapes::Matrices& mesh, const Eigen::Vector3d& p)
{
  double result = infinity;
  for(const auto& [i, j] : SG::internal::boundary_edges(mesh.T)) {
    const SG::internal::Boundary_segment segment{mesh.V.row(i), mesh.V.row(j)};
    result = (std::min)(result, (segment.closest(p) - p).norm());
  }
  return result;
}

// Two meshes as one.
shapes::Matrices together(const shapes::Matrices& a, const shapes::Matrices& b)
{
  shapes::Matrices result{Eigen::MatrixXd(a.V.rows() + b.V.rows(), 3),
                          Eigen::MatrixXi(a.T.rows() + b.T.rows(), 3)};
  result.V << a.V, b.V;
  result.T << a.T, b.T.array() + int(a.V.rows());
  return result;
}

double norm_L(const Simplified_mesh& s, const Eigen::MatrixXd& V,
              const Eigen::SparseMatrix<double>& P)
{
  const SG::Laplace_operator coarse = SG::laplace_operator(V, s.coarse.T, 0.5);
  const SG::Eigenpairs pairs = SG::eigenpairs(coarse, s.pairs.size());
  return SG::evaluate_spectrum(s.op, s.pairs, coarse, pairs, P, s.K).norm_L;
}

Eigen::SparseMatrix<double> sampled(const Simplified_mesh& s, const Eigen::MatrixXd& V)
{
  return SG::closest_point_interpolation(V, s.fine);
}

double smallest_angle(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const Eigen::Index f)
{
  const SG::Triangle_cotangents t =
      SG::triangle_cotangents(V.row(T(f, 0)), V.row(T(f, 1)), V.row(T(f, 2)));
  return std::atan2(1., t.cot.maxCoeff());
}

// One corner in each row.
Eigen::Matrix3d corners_of(const Eigen::Index f, const Eigen::MatrixXd& V, const Eigen::MatrixXi& T)
{
  Eigen::Matrix3d result;
  result << V.row(T(f, 0)), V.row(T(f, 1)), V.row(T(f, 2));
  return result;
}

double volume(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T)
{
  double sum = 0;
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    sum += corners_of(f, V, T).determinant() / 6;
  return sum;
}

double largest_distance(const Eigen::MatrixXd& points, const shapes::Matrices& surface)
{
  const SG::internal::Closest_point_query closest(surface);
  double result = 0;
  for(const Eigen::Vector3d p : points.rowwise())
    result = (std::max)(result, (closest(p).point - p).norm());
  return result;
}

// What the guards promise and is not so; empty if all is well.
std::string broken_guard(const Simplified_mesh& s, const Eigen::MatrixXd& V,
                         const SG::internal::Relocation_limits& limits = {})
{
  const Eigen::MatrixXi& T = s.coarse.T;
  for(Eigen::Index f = 0; f < T.rows(); ++f) {
    if(normal(V, T, f).dot(normal(s.coarse.V, T, f)) < std::cos(limits.largest_turn) - 1e-9)
      return "a triangle has turned";
    if(smallest_angle(V, T, f) <
       (limits.smallest_angle_ratio - 1e-6) * smallest_angle(s.coarse.V, T, f))
      return "an angle has become too small";
  }
  const double before = area(s.coarse.V, T), fine = area(s.fine.V, s.fine.T), now = area(V, T);
  if(now < (std::min)(before, fine) - limits.size_tolerance * before ||
     now > (std::max)(before, fine) + limits.size_tolerance * before)
    return "the area is neither that of the coarse mesh nor nearer to that of the fine one";
  const Eigen::MatrixXd anchors = s.P * s.fine.V;
  Eigen::VectorXd length = Eigen::VectorXd::Zero(V.rows()), count = length;
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    for(int k = 0; k < 3; ++k)
      for(const int j : {T(f, (k + 1) % 3), T(f, (k + 2) % 3)}) {
        length(T(f, k)) += (s.coarse.V.row(T(f, k)) - s.coarse.V.row(j)).norm();
        count(T(f, k)) += 1;
      }
  for(Eigen::Index v = 0; v < V.rows(); ++v) // on a border edges are counted once or twice
    if((V.row(v) - anchors.row(v)).norm() > 1.2 * limits.trust_radius * length(v) / count(v))
      return "vertex " + std::to_string(v) + " has left its ball";
  if(intersects_itself(V, T))
    return "the mesh intersects itself";
  return "";
}

} // namespace

TEST_CASE("relocation lowers the commutativity with either restriction and keeps every guard")
{
  for(const Simplified_mesh* s : {&closed_example(), &open_example()}) {
    const Relocated result = relocated(*s, with_signals(Signals::carried_and_sampled));
    const Eigen::MatrixXd& V = result.V;
    CHECK(result.objective_after < 0.9 * result.objective_before);
    CHECK(result.moved_vertices > std::size_t(V.rows() / 2));
    CHECK(norm_L(*s, V, s->P) < 0.9 * norm_L(*s, s->coarse.V, s->P));
    CHECK(norm_L(*s, V, sampled(*s, V)) < 0.9 * norm_L(*s, s->coarse.V, sampled(*s, s->coarse.V)));
    CHECK(broken_guard(*s, V) == "");
    CHECK((result.restriction - s->P).norm() == 0);
  }
  const Simplified_mesh& s = closed_example();
  const double after = volume(relocated(s).V, s.coarse.T), before = volume(s.coarse.V, s.coarse.T),
               fine = volume(s.fine.V, s.fine.T);
  REQUIRE(before < fine);
  CHECK(after >= 0.97 * before);
  CHECK(after <= fine + 0.03 * before);
}

TEST_CASE("the eigenvalues beyond K do not fall in the mean, and would without their guard")
{
  const Simplified_mesh& s = closed_example();
  const auto rise = [&](const Eigen::MatrixXd& V) {
    const Eigen::Index n = 3 * s.K / 2;
    const Eigen::ArrayXd start = eigenvalues(s.coarse.V, s.coarse.T, n);
    return (eigenvalues(V, s.coarse.T, n) / start).tail(s.K / 2).mean();
  };
  const SG::Relocation_options options = with_signals(Signals::carried_and_sampled);
  CHECK(rise(relocated(s, options).V) > 1);
  SG::internal::Relocation_limits limits;
  limits.beyond = 0;
  CHECK(rise(relocated_within(s, limits, options).V) < 1);
}

TEST_CASE("coarse eigenvalues are drawn to those of the fine mesh, beyond K as well")
{
  for(const Simplified_mesh* s : {&closed_example(), &open_example()}) {
    const Eigen::Index K = s->K, n = K + K / 2;
    const Eigen::ArrayXd goals = eigenvalues(s->fine.V, s->fine.T, n);
    const auto error = [&](const Eigen::MatrixXd& V, const Eigen::Index from,
                           const Eigen::Index to) {
      const Eigen::ArrayXd ratio = eigenvalues(V, s->coarse.T, n) / goals;
      return (ratio.segment(from, to - from) - 1).abs().mean();
    };
    SG::Relocation_options options;
    const Eigen::MatrixXd without = relocated(*s).V;
    options.eigenvalues = goals.head(K);
    const Eigen::MatrixXd with_few = relocated(*s, options).V;
    options.eigenvalues = goals;
    const Eigen::MatrixXd with = relocated(*s, options).V;
    CHECK(error(with, 1, K) < 0.7 * error(without, 1, K));
    CHECK(error(with, K, n) < 0.9 * error(s->coarse.V, K, n));
    CHECK(error(with, K, n) < error(with_few, K, n));
    CHECK(broken_guard(*s, with) == "");
    SG::internal::Relocation_limits limits;
    limits.eigenvalue_error = 0;
    CHECK(relocated_within(*s, limits, options).V == without);
    options.eigenvalues[2] = infinity;
    CHECK_THROWS_WITH(relocated(*s, options), ContainsSubstring("eigenvalue 2"));
  }
}

TEST_CASE("goals that cannot be had lose weight until something is gained")
{
  const Simplified_mesh& s = closed_example();
  SG::Relocation_options options;
  options.eigenvalues = 1.15 * s.op.mass.sum() * s.pairs.values;
  bool anew = false; // which is told by a whole fraction
  options.progress = [&](const double fraction) { return anew = anew || fraction == 1, true; };
  const SG::Relocation_result result = relocated(s, options);
  CHECK(anew);
  CHECK(result.norm_after < SG::internal::Relocation_limits().gain * result.norm_before);
}

TEST_CASE("goals that no step comes near lose weight where few vertices are left as well")
{
  // Vertices of the fine mesh: what is read there is what P carries, and nothing rises or falls.
  const shapes::Matrices fine = shapes::pebble_matrices(shapes::icosphere_matrices(3)),
                         coarse = shapes::pebble_matrices(shapes::icosphere_matrices(1));
  const SG::Eigenpairs pairs = SG::eigenpairs(SG::laplace_operator(fine.V, fine.T, 0.5), 20);
  SG::Relocation_options options;
  options.eigenvalues = Eigen::VectorXd::Constant(20, 1e300);
  Eigen::MatrixXd V = coarse.V;
  const SG::Relocation_result result = SG::relocate_positions(
      V, coarse.T, SG::closest_point_restriction(coarse, fine), fine, pairs.vectors,
      pairs.vectors * pairs.values.asDiagonal(), 0.5, {}, options);
  CHECK(result.steps > 0);
  CHECK(result.norm_after < 0.9 * result.norm_before);
}

TEST_CASE("with sampled signals the closest-point restriction comes back and fits best")
{
  const Simplified_mesh& s = closed_example();
  const Eigen::MatrixXd V = relocated(s, with_signals(Signals::carried_and_sampled)).V;
  const Relocated alone = relocated(s, with_signals(Signals::sampled));
  CHECK((alone.restriction - sampled(s, alone.V)).norm() < 1e-12);
  CHECK(norm_L(s, alone.V, alone.restriction) < norm_L(s, V, sampled(s, V)));
  CHECK(broken_guard(s, alone.V) == "");
}

TEST_CASE(
    "low eigenvectors turn towards each other less where eigenpairs of the fine mesh are known")
{
  for(const Simplified_mesh* s : {&closed_example(), &open_example()}) {
    const auto turned = [&](const SG::Eigenpairs* const eigenpairs, const int seed) {
      SG::Relocation_options options;
      options.eigenvalues = s->op.mass.sum() * s->pairs.values;
      options.eigenpairs = eigenpairs;
      Simplified_mesh start = *s;
      start.coarse.V.array() += 1e-9 * (1e3 * seed * s->coarse.V.array()).sin();
      const Relocated result = relocated(start, options);
      const SG::Laplace_operator op = SG::laplace_operator(result.V, s->coarse.T, 0.5);
      const Eigen::Index m = 7; // modes, the constant among them
      const SG::Eigenpairs pairs = SG::eigenpairs(op, m);
      const Eigen::MatrixXd C =
          pairs.vectors.transpose() * op.B * result.restriction * s->pairs.vectors.leftCols(m);
      double sum = 0; // C commutes with the operators where nothing is turned
      for(Eigen::Index j = 1; j < m; ++j)
        for(Eigen::Index k = 1; k < m; ++k)
          if(j != k)
            sum += std::pow(C(j, k) * (pairs.values(j) - s->pairs.values(k)), 2) /
                   (s->pairs.values(j) * s->pairs.values(k));
      return std::sqrt(sum);
    };
    // A descent follows the last digits of its start: one alone tells little.
    double with = 0, without = 0;
    for(int seed = 1; seed <= 5; ++seed) {
      with += turned(&s->pairs, seed);
      without += turned(nullptr, seed);
    }
    CAPTURE(with, without);
    CHECK(with < 0.8 * without);
  }
}

TEST_CASE("inner products of the signals come nearer to those of the fine mesh")
{
  for(const Simplified_mesh* s : {&closed_example(), &open_example()}) {
    const SG::Laplace_operator fine = SG::laplace_operator(s->fine.V, s->fine.T);
    // What an even mesh of so many vertices finds.
    const double lost = 0.5 / (4 * std::sqrt(3.) * double(s->coarse.V.rows()));
    const Eigen::MatrixXd T = s->F().transpose() * fine.B * s->F() / fine.mass.sum() -
                              lost * s->F().transpose() * fine.L * s->F();
    const auto difference = [&](const SG::Local_operator& op) {
      Eigen::MatrixXd V = s->coarse.V;
      const Eigen::SparseMatrix<double> P =
          SG::relocate_positions(V, s->coarse.T, s->P, s->fine, s->F(), s->Z(), op).restriction;
      const SG::Laplace_operator coarse = SG::laplace_operator(V, s->coarse.T);
      const Eigen::MatrixXd F = P * s->F();
      return (F.transpose() * coarse.B * F / coarse.mass.sum() - T).norm() / T.norm();
    };
    // The cotangent Laplacian as one with coefficients, which leaves the term out.
    const Eigen::Index n = s->coarse.V.rows();
    const SG::Operator_coefficients ones =
        SG::weighted_coefficients(Eigen::VectorXd::Ones(n), Eigen::VectorXd::Ones(n));
    const double with = difference(0.5), without = difference({SG::Mass::averaged, ones});
    CAPTURE(with, without);
    CHECK(with < 0.9 * without);
  }
}

TEST_CASE("relocation does not depend on the number of threads")
{
  const Simplified_mesh& s = open_example();
  SG::Relocation_options options;
  options.maximum_steps = 12;
  const Relocated one = relocated(s, options);
  options.threads = 3;
  const Relocated three = relocated(s, options);
  CHECK(three.V == one.V);
  CHECK(three.objective_after == one.objective_after);
  CHECK(one.moved_vertices > 0);
  options.threads = 0;
  CHECK_THROWS_WITH(relocated(s, options), ContainsSubstring("threads") && ContainsSubstring("0"));
}

TEST_CASE("the plain metric alone falls monotonically")
{
  const Simplified_mesh& s = closed_example();
  SG::Relocation_options options = with_signals(Signals::carried);
  options.smoothing = 0;
  options.hausdorff_goal = infinity;
  SG::internal::Relocation_limits limits;
  limits.beyond = 0;
  const auto energy_at = [&](const Eigen::MatrixXd& V) {
    return SG::restriction_energy(SG::laplace_operator(V, s.coarse.T, 0.5), s.P, s.F(), s.Z());
  };
  double last = energy_at(s.coarse.V);
  for(const int steps : {1, 5, 20}) {
    options.maximum_steps = steps;
    const Relocated result = relocated_within(s, limits, options);
    CHECK(result.steps == steps);
    const double E = energy_at(result.V);
    CHECK(relative_difference(E, result.E_after) < 1e-9);
    CHECK(E < last);
    last = E;
  }
}

TEST_CASE("fixed vertices stay")
{
  const Simplified_mesh& s = closed_example();
  std::vector<bool> fixed(std::size_t(s.coarse.V.rows()), false);
  for(std::size_t v = 0; v < fixed.size(); v += 3)
    fixed[v] = true;
  const Relocated result = relocated(s, {}, fixed);
  CHECK(result.moved_vertices > 0);
  for(Eigen::Index v = 0; v < result.V.rows(); v += 3)
    CHECK(result.V.row(v) == s.coarse.V.row(v));
  fixed.assign(fixed.size(), true);
  CHECK(relocated(s, {}, fixed).V == s.coarse.V);
}

TEST_CASE(
    "the term of the distance is its formula over all samples, and its gradient the difference")
{
  const Simplified_mesh& s = closed_example();
  const SG::internal::Closest_point_query on_fine(s.fine);
  using Positions = SG::internal::Distance_term::Positions;
  const Positions start = s.coarse.V;
  const double goal = 0.4;
  std::vector<Eigen::Index> all(std::size_t(s.fine.V.rows()));
  std::iota(all.begin(), all.end(), 0);
  SG::internal::Distance_term term(s.fine, all, on_fine, s.coarse.T, start, goal, 2);
  Positions V = start;
  for(Eigen::Index v = 0; v < V.rows(); ++v) // elsewhere, so that the closest faces are others
    V.row(v) *= 1 + 0.02 * std::sin(7. * double(v));
  term.refresh(V);

  // The distances of points from the nearest of all faces, without a tree.
  const auto distances = [](const std::vector<Eigen::Vector3d>& points, const Eigen::MatrixXd& W,
                            const Eigen::MatrixXi& T) {
    Eigen::ArrayXd least = Eigen::ArrayXd::Constant(Eigen::Index(points.size()), infinity);
    for(Eigen::Index f = 0; f < T.rows(); ++f) {
      const Eigen::Matrix3d corners = corners_of(f, W, T).transpose();
      for(std::size_t i = 0; i < points.size(); ++i)
        least[Eigen::Index(i)] = (std::min)(
            least[Eigen::Index(i)],
            SG::internal::closest_point_of_triangle(points[i], corners).squared_distance);
    }
    return Eigen::ArrayXd(least.sqrt());
  };
  const auto of_fine = [&](const Positions& W) {
    return distances({s.fine.V.rowwise().begin(), s.fine.V.rowwise().end()}, W, s.coarse.T);
  };
  const auto of_coarse = [&](const Positions& W) {
    std::vector<Eigen::Vector3d> samples(W.rowwise().begin(), W.rowwise().end());
    for(const auto t : s.coarse.T.rowwise()) {
      samples.push_back((W.row(t(0)) + W.row(t(1)) + W.row(t(2))) / 3);
      for(int k = 0; k < 3; ++k)
        if(const int i = t(k), j = t((k + 1) % 3); i < j) // one of the two sides of each edge
          samples.push_back((W.row(i) + W.row(j)) / 2);
    }
    return distances(samples, s.fine.V, s.fine.T);
  };
  const double delta =
      (std::max)(goal * of_fine(start).maxCoeff(), of_coarse(start).maxCoeff() / 4);
  const auto mean = [&](const Eigen::ArrayXd& d) {
    return ((d / delta).square() - 1).max(0.).square().mean();
  };
  Positions gradient = Positions::Zero(V.rows(), 3), other = gradient;
  const double value = term.penalty(V, 3, gradient);
  CHECK(value > 0);
  CHECK(value ==
        Approx(0.3 * double(V.rows()) * (mean(of_fine(V)) + mean(of_coarse(V)))).epsilon(1e-9));
  const double largest = gradient.cwiseAbs().maxCoeff();
  int seen = 0;
  for(Eigen::Index v = 0; v < V.rows(); v += 7)
    for(int c = 0; c < 3; ++c) {
      const double step = 1e-6;
      Positions W = V;
      W(v, c) += step;
      const double above = term.penalty(W, 3, other);
      W(v, c) -= 2 * step;
      const double difference = (above - term.penalty(W, 3, other)) / (2 * step);
      CHECK(gradient(v, c) == Approx(difference).epsilon(1e-4).margin(1e-5 * largest));
      seen += std::abs(difference) > 1e-3 * largest;
    }
  CHECK(seen > 3);

  // Surfaces that lie in each other have no distance but rounding.
  SG::internal::Distance_term none(s.fine, all, on_fine, s.fine.T, s.fine.V, goal, 1);
  other.setZero(s.fine.V.rows(), 3);
  CHECK(none.penalty(s.fine.V, 1, other) == 0);
  CHECK(other.isZero(0));
  CHECK_FALSE(none.refresh(s.fine.V));
}

TEST_CASE("where fine vertices are on the coarse surface its own distances are the measure")
{
  // A roof over a square, and the same four vertices with the other diagonal.
  const shapes::Matrices roof =
      shapes::matrices({{0, 0, 0}, {1, 0, 0.2}, {1, 1, 0}, {0, 1, 0.2}}, {{0, 1, 2}, {0, 2, 3}});
  const Eigen::MatrixXi other = (Eigen::MatrixXi(2, 3) << 0, 1, 3, 1, 2, 3).finished();
  const SG::internal::Closest_point_query on_roof(roof);
  SG::internal::Distance_term term(roof, {0, 1, 2, 3}, on_roof, other, roof.V, 0.8, 1);
  auto gradient = SG::internal::Distance_term::Positions::Zero(4, 3).eval();
  const double value = term.penalty(roof.V, 1, gradient);
  CHECK(value > 0);
  CHECK(value <= 0.1 * 4 * 15 * 15); // no h is above 16 - 1
}

TEST_CASE("a fine vertex that no face has does not count among the distances")
{
  const Simplified_mesh& s = closed_example();
  SG::Relocation_options options;
  options.maximum_steps = 20;
  const auto with_row = [](const Eigen::MatrixXd& m, const double value) {
    Eigen::MatrixXd more(m.rows() + 1, m.cols());
    more << m, Eigen::RowVectorXd::Constant(m.cols(), value);
    return more;
  };
  const shapes::Matrices fine{with_row(s.fine.V, 100), s.fine.T};
  Eigen::SparseMatrix<double> P = s.P;
  P.conservativeResize(P.rows(), P.cols() + 1);
  Eigen::MatrixXd W = s.coarse.V;
  SG::relocate_positions(W, s.coarse.T, P, fine, with_row(s.F(), 0), with_row(s.Z(), 0), 0.5, {},
                         options);
  CHECK((W - relocated(s, options).V).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("a lower goal brings the surfaces nearer to each other, from either side")
{
  for(const Simplified_mesh* const s : {&closed_example(), &open_example()}) {
    const auto furthest = [&](const Eigen::MatrixXd& V) {
      const Eigen::MatrixXi& T = s->coarse.T;
      Eigen::MatrixXd centroids(T.rows(), 3);
      for(Eigen::Index f = 0; f < T.rows(); ++f)
        centroids.row(f) = corners_of(f, V, T).colwise().mean();
      return (std::max)({largest_distance(s->fine.V, {V, T}), largest_distance(V, s->fine),
                         largest_distance(centroids, s->fine)});
    };
    std::vector<double> found;
    for(const double goal : {infinity, 0.45, 0.25}) {
      SG::Relocation_options options;
      options.hausdorff_goal = goal;
      const Relocated result = relocated(*s, options);
      found.push_back(furthest(result.V));
      CHECK(result.norm_after < result.norm_before);
    }
    CAPTURE(found, furthest(s->coarse.V));
    CHECK(found[1] < found[0]);
    CHECK(found[2] < found[1]);
  }
}

TEST_CASE("goals that change do not end the descent")
{
  // On a flat square the first change of the goals raises the objective above what it was before.
  Mesh mesh = make_mesh(shapes::grid_matrices(30, 30));
  const auto result = SMS::spectral_edge_collapse(mesh, 120, default_options_with(20));
  CHECK(result.relocation.steps > 50);
  CHECK(result.relocation.norm_after < 0.45 * result.relocation.norm_before);
}

TEST_CASE("goals of many modes are reached although their eigenvectors are updated less often",
          "[slow]")
{
  const shapes::Matrices fine = shapes::bumpy_icosphere_matrices(4);
  const Eigen::ArrayXd goals = eigenvalues(fine.V, fine.T, 257);
  const auto error = [&](const Eigen::Index K, const bool relocate) {
    SMS::Spectral_edge_collapse_options options = default_options_with(K);
    options.relocate = relocate;
    Mesh mesh = make_mesh(fine);
    SMS::spectral_edge_collapse(mesh, 900, options);
    const shapes::Matrices coarse = SG::mesh_matrices(mesh);
    CHECK_FALSE(intersects_itself(coarse.V, coarse.T));
    return (eigenvalues(coarse.V, coarse.T, 257) / goals - 1).tail(256).abs().mean();
  };
  const double often = error(256, true), less_often = error(257, true),
               collapsed = error(257, false);
  CAPTURE(often, less_often, collapsed);
  CHECK(less_often < 1.2 * often);
  CHECK(less_often < 0.7 * collapsed);
}

TEST_CASE("guards without room end the descent")
{
  for(const Simplified_mesh* s : {&closed_example(), &open_example()})
    for(const double turn : {1e-300, 1e-9, 1e-3}) {
      SG::internal::Relocation_limits limits;
      limits.largest_turn = turn;
      limits.smallest_angle_ratio = 1;
      limits.trust_radius = turn;
      limits.size_tolerance = turn;
      const Eigen::MatrixXd V = relocated_within(*s, limits).V;
      CHECK(V.allFinite());
      for(Eigen::Index f = 0; f < s->coarse.T.rows(); ++f)
        CHECK(normal(V, s->coarse.T, f).dot(normal(s->coarse.V, s->coarse.T, f)) >
              std::cos(turn) - 1e-11);
    }
}

TEST_CASE("boundary vertices slide along the boundary of the fine mesh, or stay")
{
  const Simplified_mesh& s = open_example();
  const std::vector<char> on_boundary =
      SG::internal::border_vertices(s.coarse.T, s.coarse.V.rows());
  const auto number = std::count(on_boundary.begin(), on_boundary.end(), 1);
  REQUIRE(number > 10);
  SG::Relocation_options options;
  const Eigen::MatrixXd V = relocated(s, options).V;
  options.fix_boundary = true;
  const Relocated inside = relocated(s, options);
  CHECK(inside.moved_vertices > 0);
  int moved = 0;
  for(Eigen::Index v = 0; v < V.rows(); ++v)
    if(on_boundary[std::size_t(v)]) {
      CHECK(distance_from_border(s.fine, V.row(v)) < 1e-12);
      moved += V.row(v) != s.coarse.V.row(v);
      CHECK(inside.V.row(v) == s.coarse.V.row(v));
    }
  CHECK(moved > number / 2);
}

TEST_CASE("after a run the border lies on that of the input, wherever the collapses left it",
          "[slow]")
{
  const shapes::Matrices input = shapes::island_matrices(24, 96);
  const auto furthest = [&](const Mesh& mesh) {
    double result = 0;
    for(const auto v : vertices(mesh))
      if(is_border(v, mesh)) {
        const auto& p = mesh.point(v);
        result = (std::max)(result, distance_from_border(input, {p.x(), p.y(), p.z()}));
      }
    return result;
  };
  SMS::Spectral_edge_collapse_options options = default_options_with(20);
  options.preserve_border = GENERATE(false, true);
  options.quadrics_above = GENERATE(10., infinity);
  const std::size_t N = GENERATE(40, 90, 250);
  CAPTURE(options.preserve_border, options.quadrics_above, N);
  options.relocation.maximum_steps = 20;
  Mesh mesh = make_mesh(input), collapsed = mesh;
  const auto result = SMS::spectral_edge_collapse(mesh, N, options);
  CHECK(furthest(mesh) < 1e-12);
  CHECK(result.relocation.norm_after <= result.relocation.norm_before);
  CHECK_FALSE(intersects_itself(positions(mesh), SG::mesh_matrices(mesh).T));
  options.relocate = false;
  SMS::spectral_edge_collapse(collapsed, N, options);
  if(!options.preserve_border)
    CHECK(furthest(collapsed) > 1e-4); // on chords
}

TEST_CASE("the closest point of a border is that of a search through all of it")
{
  const shapes::Matrices island = shapes::components_matrices(shapes::island_matrices(5, 40), 2);
  const SG::internal::Border_polyline border(island);
  const auto pieces = SG::internal::boundary_edges(island.T);
  REQUIRE(pieces.size() == 80);
  for(int k = 0; k < 200; ++k) {
    const Eigen::Vector3d p(2.5 * std::sin(12.9 * k), 1.5 * std::sin(78.2 * k), std::sin(3.1 * k));
    const Eigen::Index loop = border.loop(k % 80);
    double least = infinity;
    for(std::size_t s = 0; s < pieces.size(); ++s) {
      CHECK(pieces[s] == border.segment(s));
      const SG::internal::Boundary_segment segment{border.end(s, 0), border.end(s, 1)};
      if(border.loop(s) == loop)
        least = (std::min)(least, (segment.closest(p) - p).norm());
    }
    const auto found =
        border.closest(p, [&](const std::size_t s) { return border.loop(s) == loop; });
    REQUIRE(found.exists());
    CHECK(std::sqrt(found.squared_distance) == Approx(least));
    CHECK((found.position - p).norm() == Approx(least));
    CHECK(border.loop(found.segment) == loop);
    const Eigen::Vector3d a = border.end(found.segment, 0), b = border.end(found.segment, 1);
    CHECK((a + found.weight * (b - a) - found.position).norm() < 1e-14);
  }
  CHECK_FALSE(border.closest({0, 0, 0}, [](std::size_t) { return false; }).exists());
  CHECK(SG::internal::Border_polyline(shapes::tetrahedron_matrices()).is_empty());
}

TEST_CASE("two sheets that nearly touch do not pass through each other")
{
  const Simplified_mesh& s = closed_example();
  shapes::Matrices inner = scaled(s.coarse, 0.9998);
  inner.T.col(1).swap(inner.T.col(2));
  const shapes::Matrices coarse = together(s.coarse, inner),
                         fine = together(s.fine, scaled(s.fine, 0.9998));
  REQUIRE_FALSE(intersects_itself(coarse.V, coarse.T));
  const Eigen::Index n = s.P.rows(), fine_n = s.P.cols();
  Eigen::MatrixXd both = Eigen::MatrixXd::Zero(2 * n, 2 * fine_n);
  both.topLeftCorner(n, fine_n) = both.bottomRightCorner(n, fine_n) = s.P;
  const Eigen::SparseMatrix<double> P = both.sparseView();
  // fixed below, moving above: what is found in between has to be taken back
  std::vector<bool> fixed(std::size_t(2 * n), false);
  std::fill(fixed.begin() + n, fixed.end(), true);
  SG::Relocation_options options = with_signals(Signals::carried);
  SG::internal::Relocation_limits limits;
  limits.size_tolerance = 0.5; // there is hardly any volume between the sheets
  const auto relocate = [&](Eigen::MatrixXd& V) {
    return SG::internal::relocate_within(V, coarse.T, P, fine, s.F().replicate(2, 1),
                                         s.Z().replicate(2, 1), 0.5, fixed, options, limits);
  };
  Eigen::MatrixXd free = coarse.V, guarded = coarse.V;
  options.keep_free_of_self_intersections = false;
  relocate(free);
  REQUIRE(intersects_itself(free, coarse.T));
  options.keep_free_of_self_intersections = true;
  const SG::Relocation_result result = relocate(guarded);
  CHECK_FALSE(intersects_itself(guarded, coarse.T));
  CHECK(result.reverted_vertices > 0);
  const bool gains = result.stop_reason != SG::Relocation_result::Stop_reason::no_gain;
  CHECK((result.moved_vertices > 0) == gains);
}

TEST_CASE("a cancelled relocation leaves the positions, a spent budget ends it")
{
  const Simplified_mesh& s = closed_example();
  Eigen::MatrixXd V = s.coarse.V;
  SG::Relocation_options options;
  int calls = 0;
  options.progress = [&](const double fraction) {
    CHECK((fraction >= 0 && fraction <= 1));
    return ++calls < 4;
  };
  CHECK_THROWS_AS(
      SG::relocate_positions(V, s.coarse.T, s.P, s.fine, s.F(), s.Z(), 0.5, {}, options),
      SG::Cancelled);
  CHECK(V == s.coarse.V);
  CHECK(calls == 4);
  options.progress = nullptr;
  options.maximum_seconds = 0;
  CHECK(relocated(s, options).steps == 0);
  options.maximum_seconds = 1e9;
  SG::internal::Relocation_limits limits;
  limits.relative_decrease = 0.9;
  CHECK(relocated_within(s, limits, options).steps == 10);
}

TEST_CASE("relocation refuses what does not belong together")
{
  const Simplified_mesh& s = closed_example();
  const auto refusal = [&](Eigen::MatrixXd V, const Eigen::SparseMatrix<double>& P,
                           const SG::Relocation_options& options) {
    try {
      SG::relocate_positions(V, s.coarse.T, P, s.fine, s.F(), s.Z(), 0.5, {}, options);
    } catch(const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(refusal(s.coarse.V, s.P.transpose(), {}), ContainsSubstring("coarse x fine"));
  SG::Relocation_options options;
  options.hausdorff_goal = 0;
  CHECK_THAT(refusal(s.coarse.V, s.P, options), ContainsSubstring("hausdorff_goal"));
  options = {};
  options.smoothing = -1;
  CHECK_THAT(refusal(s.coarse.V, s.P, options), ContainsSubstring("smoothing"));
  Eigen::MatrixXd V = s.coarse.V;
  V.row(s.coarse.T(3, 0)) = V.row(s.coarse.T(3, 1));
  CHECK_THAT(refusal(V, s.P, {}), ContainsSubstring("face") && ContainsSubstring("no area"));
  V(5, 1) = std::nan("");
  CHECK_THAT(refusal(V, s.P, {}), ContainsSubstring("vertex 5"));
}

TEST_CASE("relocation refuses indices, numbers and eigenpairs that cannot be used")
{
  const Simplified_mesh& s = closed_example();
  const auto refused = [&](const std::string& sentence, const SG::Mesh_matrices& coarse,
                           const SG::Mesh_matrices& fine, const Eigen::MatrixXd& F,
                           const Eigen::SparseMatrix<double>& P,
                           const SG::Eigenpairs* const pairs = nullptr) {
    Eigen::MatrixXd V = coarse.V;
    SG::Relocation_options options;
    options.eigenpairs = pairs;
    CHECK_THROWS_WITH(SG::relocate_positions(V, coarse.T, P, fine, F, s.Z(), 0.5, {}, options),
                      ContainsSubstring(sentence));
    CHECK(V == coarse.V);
  };
  for(const int vertex : {-1, 1 << 20}) {
    SG::Mesh_matrices coarse = s.coarse, fine = s.fine;
    coarse.T(3, 1) = fine.T(7, 2) = vertex;
    refused("face 3 of the coarse mesh", coarse, s.fine, s.F(), s.P);
    refused("face 7 of the fine mesh", s.coarse, fine, s.F(), s.P);
  }
  SG::Mesh_matrices coarse = s.coarse, fine = s.fine;
  coarse.T.resize(0, 3);
  refused("the coarse mesh has no face", coarse, s.fine, s.F(), s.P);
  fine.V(5, 1) = std::nan("");
  refused("vertex 5 of the fine mesh", s.coarse, fine, s.F(), s.P);
  Eigen::MatrixXd F = s.F();
  F(2, 1) = std::nan("");
  refused("not a finite number", s.coarse, s.fine, F, s.P);
  refused("row 0 (counted from 0) of P sums to nan", s.coarse, s.fine, s.F(), std::nan("") * s.P);
  refused("sums to 0.5 and not to 1", s.coarse, s.fine, s.F(), 0.5 * s.P);
  SG::Relocation_options options;
  options.modes = (std::numeric_limits<Eigen::Index>::max)();
  CHECK_THROWS_WITH(relocated(s, options), ContainsSubstring("where the fine mesh has"));
  for(const double scale : {1e100, 1e-100})
    refused("not between 1e-50 and 1e50", s.coarse, scaled(s.fine, scale), s.F(), s.P);
  Mesh mesh = make_mesh(s.coarse);
  SG::Eigenpairs pairs = s.pairs;
  pairs.values.conservativeResize(10);
  refused("one vector for each value", s.coarse, s.fine, s.F(), s.P, &pairs);
  CHECK_THROWS_WITH(SMS::spectral_relocation(mesh, s.P, s.fine, pairs),
                    ContainsSubstring("10 eigenvalues for 30 eigenvectors"));
  pairs.values.resize(0);
  pairs.vectors.resize(s.fine.V.rows(), 0);
  refused("or are none", s.coarse, s.fine, s.F(), s.P, &pairs);
}

TEST_CASE("a remeshed start: any mesh of the surface with its closest-point restriction")
{
  Simplified_mesh s = closed_example();
  // 162 vertices that no collapse chose, and somewhat disordered.
  s.coarse = shapes::bumpy_icosphere_matrices(2);
  for(Eigen::Index i = 0; i < s.coarse.V.size(); ++i)
    s.coarse.V.data()[i] += 0.05 * std::sin(12.9898 * double(i));
  s.coarse.V = sampled(s, s.coarse.V) * s.fine.V;
  s.P = sampled(s, s.coarse.V);
  REQUIRE_FALSE(intersects_itself(s.coarse.V, s.coarse.T));
  Mesh mesh = make_mesh(s.coarse);
  SMS::spectral_relocation(mesh, s.P, s.fine, s.pairs);
  const Eigen::MatrixXd V = positions(mesh);
  CHECK(norm_L(s, V, sampled(s, V)) < 0.97 * norm_L(s, s.coarse.V, s.P));
  CHECK(broken_guard(s, V) == "");
}

TEST_CASE("the one-call form relocates: same triangles, E of the mesh as it is, constrained edges "
          "in place")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(4);
  SMS::Spectral_edge_collapse_options options = options_with(20);
  options.mass = SG::Mass::averaged;
  Mesh plain = make_mesh(input), mesh = make_mesh(input);
  const auto before = SMS::spectral_edge_collapse(plain, 160, options);
  options.relocate = true;
  options.relocation.signals = Signals::carried_and_sampled;
  bool told = false;
  options.progress = [&](const SG::Progress& p) {
    told = told || p.phase == SG::Phase::relocation;
    return true;
  };
  const auto after = SMS::spectral_edge_collapse(mesh, 160, options);
  const shapes::Matrices a = SG::mesh_matrices(plain), b = SG::mesh_matrices(mesh);
  CHECK(told);
  CHECK(a.T == b.T);
  CHECK(a.V != b.V);
  CHECK((before.restriction - after.restriction).norm() == 0);
  CHECK(after.E < before.E);
  CHECK(after.relocation.moved_vertices > 100);
  const auto later = SMS::spectral_relocation( // the mesh form sees the same mixtures
      plain, before.restriction, input, *before.eigenpairs, options.mass, options.relocation);
  CHECK((positions(plain) - b.V).norm() < 1e-5 * b.V.norm());
  CHECK(later.steps == after.relocation.steps);
  const Basis basis = eigen_input(input, options.mass, *after.eigenpairs).basis;
  CHECK(relative_difference(energy(b, basis, after.restriction), after.E) < 1e-8);
  CHECK(relative_difference(std::sqrt(after.E / basis.lambda.squaredNorm()), after.relative_error) <
        1e-8);

  Mesh held = make_mesh(input);
  const Constraints constraints = constrain_every(0, held);
  for(const auto e : edges(held))
    constraints[e] = e.idx() % 97 == 96;
  const std::set<Kernel::Point_3> held_ends = ends(held, constraints);
  SMS::spectral_edge_collapse(held, 300, options,
                              CGAL::parameters::edge_is_constrained_map(constraints));
  CHECK(held_ends.size() > 20);
  CHECK(ends(held, constraints) == held_ends);
}

TEST_CASE("closest points are those of the same component, whichever lies in the way")
{
  // A small sphere that is half inside of a large one.
  const shapes::Matrices large = shapes::bumpy_icosphere_matrices(3);
  shapes::Matrices small = shapes::icosphere_matrices(2, 0.3);
  small.V.col(0).array() += 1;
  const shapes::Matrices input = together(large, small);
  SMS::Spectral_edge_collapse_options options = options_with(20);
  options.mass = SG::Mass::averaged;
  options.relocate = true;
  Mesh mesh = make_mesh(input);
  const auto result = SMS::spectral_edge_collapse(mesh, 160, options);
  CHECK(result.relocation.moved_vertices > 0);
  Eigen::VectorXd is_small = Eigen::VectorXd::Zero(input.V.rows());
  is_small.tail(small.V.rows()).setOnes();
  const Eigen::VectorXd share = result.restriction * is_small, found = share(result.vertex_map);
  CHECK((found - is_small).cwiseAbs().maxCoeff() <= 1e-12);
  CHECK(found.maxCoeff() > 0.5);
}

TEST_CASE("no row of P comes from the limb beside that of its vertex, fewer "
          "closest points find the wrong one after relocation, and its norm is no worse")
{
  const shapes::Matrices input = shapes::folded_limb_matrices(200, 16, 0.062);
  SMS::Spectral_edge_collapse_options options = default_options_with(30);
  Mesh mesh = make_mesh(input);
  const auto result = SMS::spectral_edge_collapse(mesh, 120, options);
  const SG::Mesh_matrices coarse = SG::mesh_matrices(mesh);
  CHECK(result.relocation.resampled);
  CHECK(result.relocation.norm_after <= result.relocation.norm_before);
  CHECK(SG::rows_off_their_part(coarse, input, result.restriction).empty());
  options.relocate = false;
  Mesh before = make_mesh(input);
  SMS::spectral_edge_collapse(before, 120, options);
  const SG::Mesh_matrices collapsed = SG::mesh_matrices(before);
  const auto of_closest_points = [&](const SG::Mesh_matrices& of) {
    return SG::rows_off_their_part(of, input, SG::closest_point_interpolation(of.V, input)).size();
  };
  CHECK(of_closest_points(collapsed) > 0);
  CHECK(of_closest_points(coarse) < of_closest_points(collapsed));
  CHECK(largest_distance(input.V, coarse) <= largest_distance(input.V, collapsed) * (1 + 1e-9));
  const SG::Laplace_operator fine_op = SG::laplace_operator(input.V, input.T, SG::Mass::averaged),
                             op = SG::laplace_operator(coarse.V, coarse.T, SG::Mass::averaged);
  const SG::Spectral_evaluation e = SG::evaluate_spectrum(
      fine_op, *result.eigenpairs, op, SG::eigenpairs(op, 30), result.restriction, 30);
  CHECK(relative_difference(e.norm_L, result.relocation.norm_after) < 0.02);
}

TEST_CASE("a mesh whose norm relocation would raise is returned as it was")
{
  // Signals that P carries to a thousandth, and that are rough wherever a vertex could go.
  const shapes::Matrices fine = shapes::bumpy_icosphere_matrices(3);
  shapes::Matrices coarse = shapes::bumpy_icosphere_matrices(2);
  Eigen::SparseMatrix<double> P = SG::closest_point_interpolation(coarse.V, fine);
  REQUIRE(P.nonZeros() == P.rows());
  coarse.V =
      (coarse.V * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()).toRotationMatrix()).eval();
  const SG::Eigenpairs pairs =
      SG::eigenpairs(SG::laplace_operator(coarse.V, coarse.T, SG::Mass::averaged), 20);
  Eigen::MatrixXd F(fine.V.rows(), 20);
  for(Eigen::Index i = 0; i < F.size(); ++i)
    F.data()[i] = std::sin(17. * double(i));
  Eigen::MatrixXd Z = 30 * F;
  const double scale = pairs.vectors.col(1).cwiseAbs().maxCoeff();
  const double ratio = area(coarse.V, coarse.T) / area(fine.V, fine.T);
  for(Eigen::Index j = 0; j < P.cols(); ++j)
    for(Eigen::SparseMatrix<double>::InnerIterator it(P, j); it; ++it) {
      F.row(j) = pairs.vectors.row(it.row()) / scale;
      Z.row(j) = 1.001 * ratio * F.row(j) * pairs.values.asDiagonal();
    }
  Eigen::MatrixXd V = coarse.V;
  const SG::Relocation_result result =
      SG::relocate_positions(V, coarse.T, P, fine, F, Z, SG::Mass::averaged);
  CHECK(result.stop_reason == SG::Relocation_result::Stop_reason::no_gain);
  CHECK(V == coarse.V);
  CHECK(result.moved_vertices == 0);
  CHECK_FALSE(result.resampled);
  CHECK((result.restriction - P).norm() == 0);
  CHECK(result.norm_after == result.norm_before);

  // With goals it is tried anew without them, and says so to the callback by a whole fraction.
  SG::Relocation_options options;
  options.eigenvalues = 1.1 * area(coarse.V, coarse.T) * pairs.values;
  std::vector<double> fractions;
  options.progress = [&](const double fraction) {
    fractions.push_back(fraction);
    return true;
  };
  const SG::Relocation_result again =
      SG::relocate_positions(V, coarse.T, P, fine, F, Z, SG::Mass::averaged, {}, options);
  CHECK(again.stop_reason == SG::Relocation_result::Stop_reason::no_gain);
  CHECK(V == coarse.V);
  CHECK(fractions.back() == 1);
  CHECK(std::is_sorted(fractions.begin(), fractions.end()));
}

TEST_CASE("signals that are constant on each component leave nothing to gain")
{
  const shapes::Matrices fine =
      shapes::components_matrices(shapes::bumpy_icosphere_matrices(1), 12);
  for(const Eigen::Index K : {1, 5, 12, 14}) {
    SMS::Spectral_edge_collapse_options options = default_options_with(K);
    Mesh mesh = make_mesh(fine), collapsed = mesh;
    const auto result = SMS::spectral_edge_collapse(mesh, 240, options);
    const SG::Relocation_result& relocation = result.relocation;
    options.relocate = false;
    SMS::spectral_edge_collapse(collapsed, 240, options);
    CAPTURE(K, relocation.norm_before, relocation.norm_after);
    const bool nothing = K <= 12;
    CHECK((relocation.norm_before == 0) == nothing);
    CHECK((relocation.steps == 0) == nothing);
    CHECK((positions(mesh) == positions(collapsed)) == nothing);
    if(nothing)
      CHECK(relocation.stop_reason == SG::Relocation_result::Stop_reason::no_gain);
    else
      CHECK(relocation.norm_after < relocation.norm_before);
  }
}

TEST_CASE("a vertex of the border stays on that of its own component, whichever is nearer")
{
  // Two patches, one close above the other.
  const shapes::Matrices patch = wavy_grid_matrices(24, 20);
  const Eigen::Index n = patch.V.rows();
  const double height = 0.004;
  shapes::Matrices upper = patch;
  upper.V.col(2).array() += height;
  const shapes::Matrices input = together(patch, upper);
  SMS::Spectral_edge_collapse_options options = default_options_with(20);
  options.relocation.signals = GENERATE(Signals::carried, Signals::sampled);
  // Vertices of the border, and those of them that are as far from their own as the other one is:
  // some by chance.
  const auto on_border_and_strayed = [&] {
    Mesh mesh = make_mesh(input);
    const auto result = SMS::spectral_edge_collapse(mesh, 120, options);
    CHECK((result.relocation.moved_vertices > 0) == options.relocate);
    const shapes::Matrices after = SG::mesh_matrices(mesh);
    std::vector<char> is_upper(std::size_t(after.V.rows()));
    for(std::size_t v = 0; v < std::size_t(2 * n); ++v)
      is_upper[result.vertex_map[v]] = v >= std::size_t(n);
    const std::vector<char> is_border = SG::internal::border_vertices(after.T, after.V.rows());
    int on_border = 0, strayed = 0;
    for(Eigen::Index v = 0; v < after.V.rows(); ++v)
      if(is_border[std::size_t(v)]) {
        const double distance =
            distance_from_border(is_upper[std::size_t(v)] ? upper : patch, after.V.row(v));
        ++on_border;
        strayed += std::abs(distance - height) < height / 4;
      }
    return std::make_pair(on_border, strayed);
  };
  const auto [on_border, strayed] = on_border_and_strayed();
  options.relocate = false;
  const auto [before, strayed_before] = on_border_and_strayed();
  CAPTURE(on_border, before, strayed_before);
  CHECK(on_border > 30);
  CHECK(strayed <= strayed_before + 2);
}

TEST_CASE("a relocation that is cancelled in the one-call form leaves what the collapses made")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  SMS::Spectral_edge_collapse_options options = options_with(10);
  Mesh plain = make_mesh(input), mesh = make_mesh(input);
  SMS::spectral_edge_collapse(plain, 80, options);
  options.relocate = true;
  options.progress = [](const SG::Progress& p) { return p.phase != SG::Phase::relocation; };
  const auto result = SMS::spectral_edge_collapse(mesh, 80, options);
  CHECK(result.stop_reason == SMS::Spectral_edge_collapse_result::Stop_reason::cancelled);
  CHECK_THAT(result.explanation, ContainsSubstring("cancelled"));
  CHECK(positions(plain) == positions(mesh));
  REQUIRE(result.warnings.size() == 1); // lumped
  CHECK_THAT(result.warnings[0], ContainsSubstring("averaged"));
}

} // namespace test_relocation
