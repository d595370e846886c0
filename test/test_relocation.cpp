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

Eigen::MatrixXd relocated(const Simplified_mesh& s, SG::Relocation_result& result,
                          const SG::Relocation_options& options = {},
                          const std::vector<bool>& fixed = {})
{
  Eigen::MatrixXd V = s.coarse.V;
  result = SG::relocate_positions(V, s.coarse.T, s.P, s.fine, s.F(), s.Z(), 0.5, fixed, options);
  return V;
}

SG::Relocation_result relocated_within(const Simplified_mesh& s, Eigen::MatrixXd& V,
                                       const SG::Relocation_options& options,
                                       const SG::internal::Relocation_limits& limits)
{
  V = s.coarse.V;
  return SG::internal::relocate_within(V, s.coarse.T, s.P, s.fine, s.F(), s.Z(), 0.5, {}, options,
                                       limits);
}

SG::Spectral_evaluation evaluated(const Simplified_mesh& s, const Eigen::MatrixXd& V,
                                  const Eigen::SparseMatrix<double>& P)
{
  const SG::Laplace_operator coarse = SG::laplace_operator(V, s.coarse.T, 0.5);
  return SG::evaluate_spectrum(s.op, s.pairs, coarse, SG::eigenpairs(coarse, s.pairs.size()), P,
                               Simplified_mesh::K);
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

double volume(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T)
{
  double sum = 0;
  for(Eigen::Index f = 0; f < T.rows(); ++f) {
    Eigen::Matrix3d corners;
    for(int k = 0; k < 3; ++k)
      corners.row(k) = V.row(T(f, k));
    sum += corners.determinant() / 6;
  }
  return sum;
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
  const auto area = [](const Eigen::MatrixXd& W, const Eigen::MatrixXi& F) {
    return SG::laplace_operator(W, F).mass.sum();
  };
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
  if(!SG::internal::self_intersecting_faces(V, T).empty())
    return "the mesh intersects itself";
  return "";
}

} // namespace

TEST_CASE("relocation lowers the commutativity with either restriction and keeps every guard")
{
  SG::Relocation_options options;
  options.signals = Signals::carried_and_sampled;
  for(const Simplified_mesh* s : {&closed_example(), &open_example()}) {
    SG::Relocation_result result;
    const Eigen::MatrixXd V = relocated(*s, result, options);
    CHECK(result.objective_after < 0.9 * result.objective_before);
    CHECK(result.moved_vertices > std::size_t(V.rows() / 2));
    CHECK(evaluated(*s, V, s->P).norm_L < 0.9 * evaluated(*s, s->coarse.V, s->P).norm_L);
    CHECK(evaluated(*s, V, sampled(*s, V)).norm_L <
          0.9 * evaluated(*s, s->coarse.V, sampled(*s, s->coarse.V)).norm_L);
    CHECK(broken_guard(*s, V) == "");
    CHECK((result.restriction - s->P).norm() == 0);
  }
  const Simplified_mesh& s = closed_example();
  SG::Relocation_result result;
  const double after = volume(relocated(s, result), s.coarse.T),
               before = volume(s.coarse.V, s.coarse.T), fine = volume(s.fine.V, s.fine.T);
  REQUIRE(before < fine);
  CHECK(after >= 0.97 * before);
  CHECK(after <= fine + 0.03 * before);
}

TEST_CASE("the eigenvalues beyond K do not fall in the mean, and would without their guard")
{
  const Simplified_mesh& s = closed_example();
  const auto beyond = [&](const Eigen::MatrixXd& V) {
    const SG::Laplace_operator op = SG::laplace_operator(V, s.coarse.T, 0.5);
    return Eigen::ArrayXd(op.mass.sum() *
                          SG::eigenpairs(op, 3 * s.K / 2).values.tail(s.K / 2).array());
  };
  const Eigen::ArrayXd start = beyond(s.coarse.V);
  SG::Relocation_options options;
  options.signals = Signals::carried_and_sampled;
  SG::Relocation_result result;
  CHECK((beyond(relocated(s, result, options)) / start).mean() > 1);
  SG::internal::Relocation_limits limits;
  limits.beyond = 0;
  Eigen::MatrixXd V;
  relocated_within(s, V, options, limits);
  CHECK((beyond(V) / start).mean() < 1);
}

TEST_CASE("coarse eigenvalues are drawn to those of the fine mesh, beyond K as well")
{
  for(const Simplified_mesh* s : {&closed_example(), &open_example()}) {
    const auto values = [](const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                           const Eigen::Index n) {
      const SG::Laplace_operator op = SG::laplace_operator(V, T, 0.5);
      return Eigen::VectorXd(op.mass.sum() * SG::eigenpairs(op, n).values);
    };
    const Eigen::Index K = s->K, n = K + K / 2;
    const Eigen::VectorXd goals = values(s->fine.V, s->fine.T, n);
    const auto error = [&](const Eigen::MatrixXd& V, const Eigen::Index from,
                           const Eigen::Index to) {
      const Eigen::ArrayXd ratio = values(V, s->coarse.T, n).array() / goals.array();
      return (ratio.segment(from, to - from) - 1).abs().mean();
    };
    SG::Relocation_options options;
    SG::Relocation_result result;
    const Eigen::MatrixXd without = relocated(*s, result, options);
    options.eigenvalues = goals;
    const Eigen::MatrixXd with = relocated(*s, result, options);
    CHECK(error(with, 1, K) < 0.7 * error(without, 1, K));
    CHECK(error(with, K, n) < 0.9 * error(s->coarse.V, K, n));
    options.eigenvalues = goals.head(K);
    CHECK(error(with, K, n) < error(relocated(*s, result, options), K, n));
    options.eigenvalues = goals;
    CHECK(broken_guard(*s, with) == "");
    SG::internal::Relocation_limits limits;
    limits.eigenvalue_error = 0;
    Eigen::MatrixXd V;
    relocated_within(*s, V, options, limits);
    CHECK(V == without);
    options.eigenvalues[2] = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH(relocated(*s, result, options), ContainsSubstring("eigenvalue 2"));
  }
}

TEST_CASE("goals that cannot be had lose weight until something is gained")
{
  const Simplified_mesh& s = closed_example();
  SG::Relocation_options options;
  options.eigenvalues = 1.15 * s.op.mass.sum() * s.pairs.values;
  bool anew = false; // which is told by a whole fraction
  options.progress = [&](const double fraction) { return anew = anew || fraction == 1, true; };
  SG::Relocation_result result;
  relocated(s, result, options);
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
  SG::Relocation_options options;
  options.signals = Signals::carried_and_sampled;
  SG::Relocation_result both, alone;
  const Eigen::MatrixXd V = relocated(s, both, options);
  options.signals = Signals::sampled;
  const Eigen::MatrixXd W = relocated(s, alone, options);
  CHECK((alone.restriction - sampled(s, W)).norm() < 1e-12);
  CHECK(evaluated(s, W, alone.restriction).norm_L < evaluated(s, V, sampled(s, V)).norm_L);
  CHECK(broken_guard(s, W) == "");
}

TEST_CASE(
    "low eigenvectors turn towards each other less where eigenpairs of the fine mesh are known")
{
  for(const Simplified_mesh* s : {&closed_example(), &open_example()}) {
    const auto turned = [&](const SG::Eigenpairs* const eigenpairs) {
      SG::Relocation_options options;
      options.eigenvalues = s->op.mass.sum() * s->pairs.values;
      options.eigenpairs = eigenpairs;
      SG::Relocation_result result;
      const Eigen::MatrixXd V = relocated(*s, result, options);
      const SG::Laplace_operator op = SG::laplace_operator(V, s->coarse.T, 0.5);
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
    const double with = turned(&s->pairs), without = turned(nullptr);
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
  SG::Relocation_result one, three;
  const Eigen::MatrixXd V = relocated(s, one, options);
  options.threads = 3;
  CHECK(relocated(s, three, options) == V);
  CHECK(three.objective_after == one.objective_after);
  CHECK(one.moved_vertices > 0);
  options.threads = 0;
  CHECK_THROWS_WITH(relocated(s, three, options),
                    ContainsSubstring("threads") && ContainsSubstring("0"));
}

TEST_CASE("the plain metric alone falls monotonically")
{
  const Simplified_mesh& s = closed_example();
  SG::Relocation_options options;
  options.signals = Signals::carried;
  options.smoothing = 0;
  options.hausdorff_goal = std::numeric_limits<double>::infinity();
  SG::internal::Relocation_limits limits;
  limits.beyond = 0;
  double last =
      SG::restriction_energy(SG::laplace_operator(s.coarse.V, s.coarse.T, 0.5), s.P, s.F(), s.Z());
  for(const int steps : {1, 5, 20}) {
    options.maximum_steps = steps;
    Eigen::MatrixXd V;
    const SG::Relocation_result result = relocated_within(s, V, options, limits);
    CHECK(result.steps == steps);
    const double E =
        SG::restriction_energy(SG::laplace_operator(V, s.coarse.T, 0.5), s.P, s.F(), s.Z());
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
  SG::Relocation_result result;
  const Eigen::MatrixXd V = relocated(s, result, {}, fixed);
  CHECK(result.moved_vertices > 0);
  for(Eigen::Index v = 0; v < V.rows(); v += 3)
    CHECK(V.row(v) == s.coarse.V.row(v));
  fixed.assign(fixed.size(), true);
  CHECK(relocated(s, result, {}, fixed) == s.coarse.V);
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

  // The distance from the nearest of all faces, without a tree.
  const auto distance = [](const Eigen::Vector3d& p, const Eigen::MatrixXd& W,
                           const Eigen::MatrixXi& T) {
    double least = std::numeric_limits<double>::infinity();
    for(Eigen::Index f = 0; f < T.rows(); ++f) {
      Eigen::Matrix3d corners;
      for(int k = 0; k < 3; ++k)
        corners.col(k) = W.row(T(f, k)).transpose();
      least =
          (std::min)(least, SG::internal::closest_point_of_triangle(p, corners).squared_distance);
    }
    return std::sqrt(least);
  };
  struct Distances
  {
    std::vector<double> of_fine, of_coarse;
  };
  const auto distances_at = [&](const Positions& W) {
    Distances found;
    for(Eigen::Index i = 0; i < s.fine.V.rows(); ++i)
      found.of_fine.push_back(distance(s.fine.V.row(i), W, s.coarse.T));
    std::set<std::pair<int, int>> edges;
    const auto at = [&](const Eigen::Vector3d& p) {
      found.of_coarse.push_back(distance(p, s.fine.V, s.fine.T));
    };
    for(Eigen::Index v = 0; v < W.rows(); ++v)
      at(W.row(v));
    for(Eigen::Index f = 0; f < s.coarse.T.rows(); ++f) {
      const auto t = s.coarse.T.row(f);
      at((W.row(t(0)) + W.row(t(1)) + W.row(t(2))) / 3);
      for(int k = 0; k < 3; ++k)
        if(edges.insert(std::minmax(int(t(k)), int(t((k + 1) % 3)))).second)
          at((W.row(t(k)) + W.row(t((k + 1) % 3))) / 2);
    }
    return found;
  };
  const auto largest = [](const std::vector<double>& d) {
    return *std::max_element(d.begin(), d.end());
  };
  const Distances before = distances_at(start), now = distances_at(V);
  const double delta = (std::max)(goal * largest(before.of_fine), largest(before.of_coarse) / 4);
  const auto mean = [&](const std::vector<double>& distances) {
    double sum = 0;
    for(const double d : distances)
      sum += std::pow((std::max)(0., d * d / (delta * delta) - 1), 2);
    return sum / double(distances.size());
  };
  Positions gradient = Positions::Zero(V.rows(), 3), other = gradient;
  const double value = term.penalty(V, 3, gradient);
  CHECK(value > 0);
  CHECK(value ==
        Approx(0.3 * double(V.rows()) * (mean(now.of_fine) + mean(now.of_coarse))).epsilon(1e-9));

  int seen = 0;
  for(Eigen::Index v = 0; v < V.rows(); v += 7)
    for(int c = 0; c < 3; ++c) {
      const double step = 1e-6;
      Positions W = V;
      W(v, c) += step;
      const double above = term.penalty(W, 3, other);
      W(v, c) -= 2 * step;
      const double difference = (above - term.penalty(W, 3, other)) / (2 * step);
      CHECK(gradient(v, c) ==
            Approx(difference).epsilon(1e-4).margin(1e-5 * gradient.cwiseAbs().maxCoeff()));
      seen += std::abs(difference) > 1e-3 * gradient.cwiseAbs().maxCoeff();
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
  shapes::Matrices roof;
  roof.V.resize(4, 3);
  roof.V << 0, 0, 0, 1, 0, 0.2, 1, 1, 0, 0, 1, 0.2;
  roof.T.resize(2, 3);
  roof.T << 0, 1, 2, 0, 2, 3;
  Eigen::MatrixXi other(2, 3);
  other << 0, 1, 3, 1, 2, 3;
  const SG::internal::Closest_point_query on_roof(roof);
  SG::internal::Distance_term term(roof, {0, 1, 2, 3}, on_roof, other, roof.V, 0.8, 1);
  SG::internal::Distance_term::Positions gradient(4, 3);
  gradient.setZero();
  const double value = term.penalty(roof.V, 1, gradient);
  CHECK(value > 0);
  CHECK(value <= 0.1 * 4 * 15 * 15); // no h is above 16 - 1
}

TEST_CASE("a fine vertex that no face has does not count among the distances")
{
  const Simplified_mesh& s = closed_example();
  SG::Relocation_options options;
  options.maximum_steps = 20;
  SG::Relocation_result result;
  const Eigen::MatrixXd V = relocated(s, result, options);
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
  CHECK((W - V).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("a lower goal brings the surfaces nearer to each other, from either side")
{
  for(const Simplified_mesh* const s : {&closed_example(), &open_example()}) {
    const auto furthest = [&](const Eigen::MatrixXd& V) {
      const SG::internal::Closest_point_query on_fine(s->fine),
          on_coarse(shapes::Matrices{V, s->coarse.T});
      double result = 0;
      const auto look = [&](const SG::internal::Closest_point_query& surface,
                            const Eigen::Vector3d& p) {
        result = (std::max)(result, (surface(p).point - p).norm());
      };
      for(Eigen::Index i = 0; i < s->fine.V.rows(); ++i)
        look(on_coarse, s->fine.V.row(i));
      for(Eigen::Index f = 0; f < s->coarse.T.rows(); ++f) {
        const auto t = s->coarse.T.row(f);
        look(on_fine, (V.row(t(0)) + V.row(t(1)) + V.row(t(2))) / 3);
        for(int k = 0; k < 3; ++k)
          look(on_fine, V.row(t(k)));
      }
      return result;
    };
    std::vector<double> found;
    for(const double goal : {std::numeric_limits<double>::infinity(), 0.45, 0.25}) {
      SG::Relocation_options options;
      options.hausdorff_goal = goal;
      SG::Relocation_result result;
      found.push_back(furthest(relocated(*s, result, options)));
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
  SMS::Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 20;
  const auto result = SMS::spectral_edge_collapse(mesh, 120, options);
  CHECK(result.relocation.steps > 50);
  CHECK(result.relocation.norm_after < 0.45 * result.relocation.norm_before);
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
      Eigen::MatrixXd V = s->coarse.V;
      SG::internal::relocate_within(V, s->coarse.T, s->P, s->fine, s->F(), s->Z(), 0.5, {}, {},
                                    limits);
      CHECK(V.allFinite());
      for(Eigen::Index f = 0; f < s->coarse.T.rows(); ++f)
        CHECK(normal(V, s->coarse.T, f).dot(normal(s->coarse.V, s->coarse.T, f)) >
              std::cos(turn) - 1e-11);
    }
}

TEST_CASE("boundary vertices slide along the boundary of the fine mesh, or stay")
{
  const Simplified_mesh& s = open_example();
  std::set<int> on_boundary;
  for(const auto& [i, j] : SG::internal::boundary_edges(s.coarse.T)) {
    on_boundary.insert(i);
    on_boundary.insert(j);
  }
  REQUIRE(on_boundary.size() > 10);
  std::vector<SG::internal::Boundary_segment> segments;
  for(const auto& [i, j] : SG::internal::boundary_edges(s.fine.T))
    segments.push_back({s.fine.V.row(i), s.fine.V.row(j)});
  SG::Relocation_options options;
  SG::Relocation_result result;
  const Eigen::MatrixXd V = relocated(s, result, options);
  std::size_t moved = 0;
  for(const int v : on_boundary) {
    const Eigen::Vector3d p = V.row(v);
    double nearest = 1e9;
    for(const auto& segment : segments)
      nearest = (std::min)(nearest, (segment.closest(p) - p).norm());
    CHECK(nearest < 1e-12);
    moved += V.row(v) != s.coarse.V.row(v);
  }
  CHECK(moved > on_boundary.size() / 2);
  options.fix_boundary = true;
  const Eigen::MatrixXd W = relocated(s, result, options);
  for(const int v : on_boundary)
    CHECK(W.row(v) == s.coarse.V.row(v));
  CHECK(result.moved_vertices > 0);
}

TEST_CASE("after a run the border lies on that of the input, wherever the collapses left it",
          "[slow]")
{
  const shapes::Matrices input = shapes::island_matrices(24, 96);
  const SG::internal::Border_polyline coast(input);
  const auto furthest = [&](const Mesh& mesh) {
    double result = 0;
    for(const auto v : vertices(mesh))
      if(is_border(v, mesh)) {
        const auto& p = mesh.point(v);
        const auto all = [](std::size_t) { return true; };
        result = (std::max)(result,
                            std::sqrt(coast.closest({p.x(), p.y(), p.z()}, all).squared_distance));
      }
    return result;
  };
  SMS::Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 20;
  options.preserve_border = GENERATE(false, true);
  options.quadrics_above = GENERATE(10., std::numeric_limits<double>::infinity());
  const std::size_t N = GENERATE(40, 90, 250);
  CAPTURE(options.preserve_border, options.quadrics_above, N);
  options.relocation.maximum_steps = 20;
  Mesh mesh = make_mesh(input), collapsed = mesh;
  const auto result = SMS::spectral_edge_collapse(mesh, N, options);
  CHECK(furthest(mesh) < 1e-12);
  CHECK(result.relocation.norm_after <= result.relocation.norm_before);
  CHECK(SG::internal::self_intersecting_faces(SG::mesh_matrices(mesh).V, SG::mesh_matrices(mesh).T)
            .empty());
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
    double least = std::numeric_limits<double>::infinity();
    for(std::size_t s = 0; s < pieces.size(); ++s) {
      const auto [i, j] = border.segment(s);
      CHECK(pieces[s] == std::make_pair(i, j));
      if(border.loop(s) == loop)
        least = (std::min)(
            least, (SG::internal::Boundary_segment{island.V.row(i), island.V.row(j)}.closest(p) - p)
                       .norm());
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
  Simplified_mesh s = closed_example();
  shapes::Matrices inner = s.coarse;
  for(Eigen::Index f = 0; f < inner.T.rows(); ++f)
    std::swap(inner.T(f, 1), inner.T(f, 2));
  const Eigen::Index n = s.coarse.V.rows(), m = s.coarse.T.rows();
  Eigen::MatrixXd V(2 * n, 3);
  V << s.coarse.V, 0.9998 * s.coarse.V;
  Eigen::MatrixXi T(2 * m, 3);
  T << s.coarse.T, (inner.T.array() + int(n)).matrix();
  REQUIRE(SG::internal::self_intersecting_faces(V, T).empty());
  shapes::Matrices fine = s.fine;
  const Eigen::Index fine_n = fine.V.rows(), fine_m = fine.T.rows();
  fine.V.conservativeResize(2 * fine_n, 3);
  fine.V.bottomRows(fine_n) = 0.9998 * s.fine.V;
  fine.T.conservativeResize(2 * fine_m, 3);
  fine.T.bottomRows(fine_m) = s.fine.T.array() + int(fine_n);
  const Eigen::MatrixXd F = s.F().replicate(2, 1), Z = s.Z().replicate(2, 1);
  // fixed below, moving above: what is found in between has to be taken back
  std::vector<bool> fixed(std::size_t(2 * n), false);
  std::fill(fixed.begin() + n, fixed.end(), true);
  Eigen::SparseMatrix<double> P(2 * n, 2 * fine_n);
  std::vector<Eigen::Triplet<double>> entries;
  for(Eigen::Index j = 0; j < s.P.outerSize(); ++j)
    for(Eigen::SparseMatrix<double>::InnerIterator it(s.P, j); it; ++it)
      for(const int sheet : {0, 1})
        entries.emplace_back(int(it.row() + sheet * n), int(j + sheet * fine_n), it.value());
  P.setFromTriplets(entries.begin(), entries.end());
  SG::Relocation_options options;
  options.signals = Signals::carried;
  SG::internal::Relocation_limits limits;
  limits.size_tolerance = 0.5; // there is hardly any volume between the sheets
  Eigen::MatrixXd free = V, guarded = V;
  options.keep_free_of_self_intersections = false;
  SG::internal::relocate_within(free, T, P, fine, F, Z, 0.5, fixed, options, limits);
  REQUIRE(!SG::internal::self_intersecting_faces(free, T).empty());
  options.keep_free_of_self_intersections = true;
  const SG::Relocation_result result =
      SG::internal::relocate_within(guarded, T, P, fine, F, Z, 0.5, fixed, options, limits);
  CHECK(SG::internal::self_intersecting_faces(guarded, T).empty());
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
  CHECK(SG::relocate_positions(V, s.coarse.T, s.P, s.fine, s.F(), s.Z(), 0.5, {}, options).steps ==
        0);
  options.maximum_seconds = 1e9;
  SG::internal::Relocation_limits limits;
  limits.relative_decrease = 0.9;
  CHECK(relocated_within(s, V, options, limits).steps == 10);
}

TEST_CASE("relocation refuses what does not belong together")
{
  const Simplified_mesh& s = closed_example();
  const auto refusal = [&](const Eigen::MatrixXd& V, const Eigen::SparseMatrix<double>& P,
                           const SG::Relocation_options& options) {
    Eigen::MatrixXd copy = V;
    try {
      SG::relocate_positions(copy, s.coarse.T, P, s.fine, s.F(), s.Z(), 0.5, {}, options);
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

  {
    Eigen::MatrixXd V = s.coarse.V;
    SG::Relocation_options options;
    options.modes = (std::numeric_limits<Eigen::Index>::max)();
    CHECK_THROWS_WITH(
        SG::relocate_positions(V, s.coarse.T, s.P, s.fine, s.F(), s.Z(), 0.5, {}, options),
        ContainsSubstring("where the fine mesh has"));
  }

  for(const double scale : {1e100, 1e-100}) {
    SG::Mesh_matrices far = s.fine;
    far.V *= scale;
    refused("not between 1e-50 and 1e50", s.coarse, far, s.F(), s.P);
  }
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
  const Simplified_mesh& made = closed_example();
  Simplified_mesh s = made;
  s.coarse = shapes::bumpy_icosphere_matrices(
      2); // 162 vertices that no collapse chose, and somewhat disordered
  for(Eigen::Index i = 0; i < s.coarse.V.size(); ++i)
    s.coarse.V.data()[i] += 0.05 * std::sin(12.9898 * double(i));
  s.coarse.V = sampled(s, s.coarse.V) * s.fine.V;
  s.P = sampled(s, s.coarse.V);
  REQUIRE(SG::internal::self_intersecting_faces(s.coarse.V, s.coarse.T).empty());
  Mesh mesh = make_mesh(s.coarse);
  SG::Eigenpairs pairs = s.pairs;
  SMS::spectral_relocation(mesh, s.P, s.fine, pairs);
  const Eigen::MatrixXd V = SG::mesh_matrices(mesh).V;
  CHECK(evaluated(s, V, sampled(s, V)).norm_L < 0.97 * evaluated(s, s.coarse.V, s.P).norm_L);
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
  auto constraints = mesh.add_property_map<Mesh::Edge_index, bool>("e:constrained", false).first;
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
  CHECK((SG::mesh_matrices(plain).V - b.V).norm() < 1e-5 * b.V.norm());
  CHECK(later.steps == after.relocation.steps);
  const Basis basis = eigen_input(input, options.mass, *after.eigenpairs).basis;
  CHECK(relative_difference(energy(b, basis, after.restriction), after.E) < 1e-8);
  CHECK(relative_difference(std::sqrt(after.E / basis.lambda.squaredNorm()), after.relative_error) <
        1e-8);

  Mesh held = make_mesh(input);
  constraints = held.add_property_map<Mesh::Edge_index, bool>("e:constrained", false).first;
  int count = 0;
  std::set<Kernel::Point_3> ends;
  for(const auto e : edges(held))
    if(++count % 97 == 0) {
      constraints[e] = true;
      ends.insert(held.point(source(e, held)));
      ends.insert(held.point(target(e, held)));
    }
  SMS::spectral_edge_collapse(held, 300, options,
                              CGAL::parameters::edge_is_constrained_map(constraints));
  for(const auto v : vertices(held))
    ends.erase(held.point(v));
  CHECK(ends.empty());
}

TEST_CASE("closest points are those of the same component, whichever lies in the way")
{
  // A small sphere that is half inside of a large one.
  shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  const shapes::Matrices small = shapes::icosphere_matrices(2, 0.3);
  const Eigen::Index n = input.V.rows(), m = input.T.rows();
  input.V.conservativeResize(n + small.V.rows(), 3);
  input.T.conservativeResize(m + small.T.rows(), 3);
  input.V.bottomRows(small.V.rows()) = small.V.rowwise() + Eigen::RowVector3d(1, 0, 0);
  input.T.bottomRows(small.T.rows()) = small.T.array() + int(n);
  SMS::Spectral_edge_collapse_options options = options_with(20);
  options.mass = SG::Mass::averaged;
  options.relocate = true;
  Mesh mesh = make_mesh(input);
  const auto result = SMS::spectral_edge_collapse(mesh, 160, options);
  CHECK(result.relocation.moved_vertices > 0);
  Eigen::VectorXd is_small = Eigen::VectorXd::Zero(input.V.rows());
  is_small.tail(small.V.rows()).setOnes();
  const Eigen::VectorXd share = result.restriction * is_small;
  int mixed = 0, of_small = 0;
  for(std::size_t v = 0; v < std::size_t(input.V.rows()); ++v) {
    const double expected = v < std::size_t(n) ? 0 : 1,
                 found = share(Eigen::Index(result.vertex_map[v]));
    mixed += std::abs(found - expected) > 1e-12;
    of_small += found > 0.5;
  }
  CHECK(mixed == 0);
  CHECK(of_small > 0);
}

TEST_CASE("no row of P comes from the limb beside that of its vertex, fewer "
          "closest points find the wrong one after relocation, and its norm is no worse")
{
  const shapes::Matrices input = shapes::folded_limb_matrices(200, 16, 0.062);
  SMS::Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 30;
  Mesh mesh = make_mesh(input);
  const auto result = SMS::spectral_edge_collapse(mesh, 120, options);
  const SG::Mesh_matrices coarse = SG::mesh_matrices(mesh);
  CHECK(result.relocation.resampled);
  CHECK(result.relocation.norm_after <= result.relocation.norm_before);
  CHECK(SG::rows_off_their_part(coarse, input, result.restriction).empty());
  const auto of_closest_points = [&](const SG::Mesh_matrices& of) {
    return SG::rows_off_their_part(of, input, SG::closest_point_interpolation(of.V, input)).size();
  };
  options.relocate = false;
  Mesh before = make_mesh(input);
  SMS::spectral_edge_collapse(before, 120, options);
  CHECK(of_closest_points(SG::mesh_matrices(before)) > 0);
  CHECK(of_closest_points(coarse) < of_closest_points(SG::mesh_matrices(before)));
  const auto furthest = [&](const Mesh& surface) {
    const SG::internal::Closest_point_query closest(SG::mesh_matrices(surface));
    double result = 0;
    for(Eigen::Index i = 0; i < input.V.rows(); ++i)
      result =
          (std::max)(result, (closest(input.V.row(i)).point - input.V.row(i).transpose()).norm());
    return result;
  };
  CHECK(furthest(mesh) <= furthest(before) * (1 + 1e-9));
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
  const double ratio = SG::laplace_operator(coarse.V, coarse.T).mass.sum() /
                       SG::laplace_operator(fine.V, fine.T).mass.sum();
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
  options.eigenvalues = 1.1 * SG::laplace_operator(coarse.V, coarse.T).mass.sum() * pairs.values;
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
    SMS::Spectral_edge_collapse_options options;
    options.number_of_eigenvectors = K;
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
  const Eigen::Index n = patch.V.rows(), m = patch.T.rows();
  const Eigen::RowVector3d up(0, 0, 0.004);
  shapes::Matrices input{Eigen::MatrixXd(2 * n, 3), Eigen::MatrixXi(2 * m, 3)};
  input.V << patch.V, patch.V.rowwise() + up;
  input.T << patch.T, patch.T.array() + int(n);
  std::vector<SG::internal::Boundary_segment> border;
  for(const auto& [i, j] : SG::internal::boundary_edges(patch.T))
    border.push_back({patch.V.row(i), patch.V.row(j)});
  SMS::Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 20;
  options.relocation.signals =
      GENERATE(SG::Relocation_options::Signals::carried, SG::Relocation_options::Signals::sampled);
  // Vertices of the border, and those of them that are as far from their own as the other one is:
  // some by chance.
  const auto on_border_and_strayed = [&] {
    Mesh mesh = make_mesh(input);
    const auto result = SMS::spectral_edge_collapse(mesh, 120, options);
    CHECK((result.relocation.moved_vertices > 0) == options.relocate);
    std::vector<char> is_upper(mesh.number_of_vertices());
    for(std::size_t v = 0; v < std::size_t(2 * n); ++v)
      is_upper[result.vertex_map[v]] = v >= std::size_t(n);
    const Eigen::MatrixXd after = SG::mesh_matrices(mesh).V;
    Eigen::Index i = 0;
    int on_border = 0, strayed = 0;
    for(const auto v : vertices(mesh)) {
      const Eigen::Vector3d p =
          after.row(i) - (is_upper[std::size_t(i)] ? up : Eigen::RowVector3d::Zero().eval());
      ++i;
      if(!is_border(v, mesh))
        continue;
      double distance = std::numeric_limits<double>::infinity();
      for(const auto& segment : border)
        distance = (std::min)(distance, (segment.closest(p) - p).norm());
      ++on_border;
      strayed += std::abs(distance - up.norm()) < up.norm() / 4;
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
  CHECK(SG::mesh_matrices(plain).V == SG::mesh_matrices(mesh).V);
  REQUIRE(result.warnings.size() == 1); // lumped
  CHECK_THAT(result.warnings[0], ContainsSubstring("averaged"));
}

} // namespace test_relocation
