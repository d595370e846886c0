// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The energies of relocation against slow ones and finite differences.

#include "catch.h"
#include "relocation_helpers.h"

#include <CGAL/Spectral_geometry/internal/relocation/Guarded_descent.h>
#include <CGAL/Spectral_geometry/internal/relocation/Relocation_objective.h>
#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/internal/surface/closest_point_search.h>

#include <Eigen/Dense>

namespace test_relocation_energy {

using namespace spectral_test;
using Positions = SG::Relocation_energy::Positions;
using Rows = SG::Position_dependent_signals::Rows;

namespace {

// Functions of the position of which everything is known.
class Plane_waves : public SG::Position_dependent_signals
{
public:
  void evaluate(const Positions& V, Rows& F, Rows& Z) override
  {
    m_V = V;
    F.resize(V.rows(), 35); // more than one panel
    Z.resize(V.rows(), 35);
    for(Eigen::Index w = 0; w < V.rows(); ++w)
      for(int k = 0; k < 35; ++k) {
        F(w, k) = std::sin(axis(k).dot(V.row(w)) + k);
        Z(w, k) = 3 * std::cos(axis(k).dot(V.row(w)));
      }
  }
  void add_gradient(const Rows& by_F, const Rows& by_Z, Positions& gradient) const override
  {
    for(Eigen::Index w = 0; w < m_V.rows(); ++w)
      for(int k = 0; k < 35; ++k) {
        const double t = axis(k).dot(m_V.row(w));
        gradient.row(w) +=
            (by_F(w, k) * std::cos(t + k) - 3 * by_Z(w, k) * std::sin(t)) * axis(k).transpose();
      }
  }

private:
  static Eigen::Vector3d axis(const int k) { return {1. + k % 3, 0.5 * (k % 5), 1.5 - k % 2}; }
  Positions m_V;
};

// The term of the spectrum as an energy of its own, at a weight of 3.
struct Penalty
{
  SG::internal::Spectrum_term term;

  double value(const Positions& V)
  {
    Positions gradient;
    return value_and_gradient(V, gradient);
  }
  double value_and_gradient(const Positions& V, Positions& gradient)
  {
    gradient.setZero(V.rows(), 3);
    return term.penalty(V, 3., gradient);
  }
};

// A row for each of n vertices.
Rows waves(const Eigen::Index n, const double frequency, const double phase = 0,
           const Eigen::Index columns = 3)
{
  return Rows::NullaryExpr(n, columns, [=](const Eigen::Index v, const Eigen::Index k) {
    return std::sin(frequency * double(v * columns + k) + phase);
  });
}

template <class Energy>
double gradient_error(Energy& energy, const Positions& V)
{
  Positions gradient;
  energy.value_and_gradient(V, gradient);
  double worst = 0;
  const double h = 1e-5;
  for(int trial = 0; trial < 6; ++trial) {
    Positions direction = waves(V.rows(), 17. * (trial + 1), trial);
    if(trial > 3) { // one vertex alone
      direction.topRows(7 * trial).setZero();
      direction.bottomRows(V.rows() - 7 * trial - 1).setZero();
    }
    // Five points: small triangles bend the energy too much for two.
    const auto difference = [&](const double step) {
      return energy.value(V + step * direction) - energy.value(V - step * direction);
    };
    const double slope = (8 * difference(h) - difference(2 * h)) / (12 * h);
    const Positions expected = gradient.cwiseProduct(direction);
    worst = (std::max)(worst, std::abs(slope - expected.sum()) / expected.norm());
  }
  return worst;
}

} // namespace

TEST_CASE("without a first term it is E, as the assembled matrices give it")
{
  const Simplified_mesh& s = closed_example();
  for(const double theta : {0., 0.5, 1.}) {
    CAPTURE(theta);
    SG::Relocation_energy energy(s.coarse.T, s.P * s.F(), s.P * s.Z(), theta);
    const double slow = SG::restriction_energy(SG::laplace_operator(s.coarse.V, s.coarse.T, theta),
                                               s.P, s.F(), s.Z());
    CHECK(relative_difference(energy.value(s.coarse.V), slow) < 1e-10);
    CHECK(energy.smoothed_part() == 0);
  }
}

TEST_CASE("the smoothed energy is that of dense matrices")
{
  const Simplified_mesh& s = open_example();
  const double tau = 0.01, mu = 0.3;
  const SG::Laplace_operator op = SG::laplace_operator(s.coarse.V, s.coarse.T, 0.5);
  const Eigen::MatrixXd B = op.B, A = B + tau * Eigen::MatrixXd(op.L);
  const Eigen::MatrixXd R = B * (s.P * s.Z()) - op.L * (s.P * s.F());
  const Eigen::MatrixXd Y = A.llt().solve(R);
  const double smoothed = Y.cwiseProduct(B * Y).sum();
  const double plain = SG::restriction_energy(op, s.P, s.F(), s.Z());
  SG::Relocation_energy energy(s.coarse.T, s.P * s.F(), s.P * s.Z(), 0.5, tau, mu);
  CHECK(relative_difference(energy.value(s.coarse.V), smoothed + mu * plain) < 1e-9);
  CHECK(relative_difference(energy.smoothed_part(), smoothed) < 1e-9);
  CHECK(relative_difference(energy.energy_part(), plain) < 1e-9);
}

TEST_CASE("inner products of moving signals are compared with those of the fine mesh")
{
  const Simplified_mesh& s = open_example();
  const SG::Laplace_operator op = SG::laplace_operator(s.coarse.V, s.coarse.T, 0.5),
                             fine = SG::laplace_operator(s.fine.V, s.fine.T, 0.5);
  Plane_waves moving;
  Rows F, Z;
  moving.evaluate(s.coarse.V, F, Z);
  const Eigen::MatrixXd on_coarse = F;
  moving.evaluate(s.fine.V, F, Z);
  const Eigen::MatrixXd on_fine = F, Z_fine = Z, none(s.coarse.V.rows(), 0);
  double difference = 0, size = 0;
  for(const auto& [first, columns] : {std::pair(0, 32), std::pair(32, 3)}) {
    const Eigen::MatrixXd f = on_fine.middleCols(first, columns),
                          g = on_coarse.middleCols(first, columns);
    const double lost = 0.5 * fine.mass.sum() / (4 * std::sqrt(3.) * double(s.coarse.V.rows()));
    const Eigen::MatrixXd half = f.transpose() * fine.mass.asDiagonal() *
                                 (f - lost * Z_fine.middleCols(first, columns)) / fine.mass.sum();
    const Eigen::MatrixXd T = (half + half.transpose()) / 2;
    difference += (g.transpose() * op.B * g / op.mass.sum() - T).squaredNorm();
    size += std::pow(T.trace(), 2);
  }
  SG::Relocation_energy energy(s.coarse.T, none, none, 0.5, 0.02, 0.5, &moving);
  const double without = energy.value(s.coarse.V);
  energy.keep_inner_products(fine.mass, on_fine, Z_fine, without);
  CHECK(difference > 1e-8 * size);
  CHECK(relative_difference(energy.value(s.coarse.V), without * (1 + difference / size)) < 1e-12);
  CHECK_THROWS_AS(energy.keep_inner_products(fine.mass, on_coarse, Z_fine, 1),
                  std::invalid_argument);
  energy.keep_inner_products(fine.mass, on_fine.leftCols(3), Z_fine.leftCols(3), 1);
  CHECK_THROWS_AS(energy.value(s.coarse.V), std::invalid_argument);
}

TEST_CASE("gradients agree with finite differences, in every mass, with a boundary and without")
{
  for(const Simplified_mesh* s : {&closed_example(), &open_example()})
    for(const double theta : {0., 0.5, 1.}) {
      CAPTURE(theta);
      const Eigen::MatrixXd F = s->P * s->F(), Z = s->P * s->Z();
      const Positions V = s->coarse.V;
      SG::Relocation_energy plain(s->coarse.T, F, Z, theta);
      CHECK(gradient_error(plain, V) < 1e-6);
      SG::Relocation_energy smoothed(s->coarse.T, F, Z, theta, 0.02, 0.5);
      CHECK(gradient_error(smoothed, V) < 1e-6);
      Plane_waves moving;
      SG::Relocation_energy both(s->coarse.T, F, Z, theta, 0.02, 0.5, &moving);
      CHECK(gradient_error(both, V) < 1e-6);
      SG::Relocation_energy moving_alone(s->coarse.T, F.leftCols(0), Z.leftCols(0), theta, 0.02, 0.,
                                         &moving);
      CHECK(gradient_error(moving_alone, V) < 1e-6);
      Rows fine_F, fine_Z;
      moving.evaluate(s->fine.V, fine_F, fine_Z);
      both.keep_inner_products(SG::laplace_operator(s->fine.V, s->fine.T, theta).mass, fine_F,
                               fine_Z, 1e4 * both.value(V));
      CHECK(gradient_error(both, V) < 1e-6);
    }
}

TEST_CASE("the term of the spectrum: what it says is what an eigensolver says, and its gradient "
          "is right")
{
  for(const Simplified_mesh* s : {&closed_example(), &open_example()}) {
    const Positions V = s->coarse.V, W = V + 0.004 * waves(V.rows(), 12.9898);
    SG::internal::Spectrum_term guard(s->coarse.T, V, 0.5, 20, {}, {}, {});
    REQUIRE(guard.is_active());
    CHECK(std::abs(guard.changes(V).mean()) < 1e-4);
    const double before = guard.changes(W).mean(); // with the eigenvectors of V
    guard.refresh(W);
    guard.refresh(W); // each is one step of an iteration
    const auto values = [&](const Positions& at, const Eigen::Index n) {
      const SG::Laplace_operator op = SG::laplace_operator(at, s->coarse.T, 0.5);
      return Eigen::ArrayXd(op.mass.sum() * SG::eigenpairs(op, n).values.array());
    };
    const double change = (values(W, 30) / values(V, 30)).tail(10).mean() - 1;
    CHECK(guard.changes(W).mean() == Catch::Approx(change).margin(1e-4));
    CHECK(before > change);   // eigenvectors of another mesh
    REQUIRE(change < 0.0015); // the penalty begins at 0.002
    Penalty penalty{guard};
    CHECK(gradient_error(penalty, W) < 1e-6);
    CHECK(penalty.value(W) > 0);
    SG::internal::Relocation_limits limits;
    limits.beyond = 0;
    CHECK(!SG::internal::Spectrum_term(s->coarse.T, V, 0.5, 20, {}, {}, limits).is_active());
    // Goals of all but the constant, and four eigenvalues after them, that say how far the others
    // are to rise.
    limits.beyond = 1;
    Eigen::VectorXd eigenvalues = values(V, 12);
    eigenvalues.tail(11) *= 1.01;
    SG::internal::Spectrum_term goals(s->coarse.T, V, 0.5, 8, eigenvalues, {}, limits);
    REQUIRE(goals.has_goals());
    const Eigen::ArrayXd errors = goals.changes(V).transpose();
    REQUIRE(errors.size() == 15);
    CHECK((errors.head(7) + 0.01 / 1.01).abs().maxCoeff() < 1e-4);
    CHECK(errors.tail(8).abs().maxCoeff() < 1e-4);
    Penalty to_goals{goals};
    CHECK(gradient_error(to_goals, W) < 1e-6);
    REQUIRE(V.rows() > 10 * 8); // more than ten vertices for each mode: epsilon is smaller
    const double epsilon = limits.eigenvalue_error * std::pow(10. * 8 / double(V.rows()), 2. / 3);
    CHECK(to_goals.value(V) ==
          Catch::Approx(3. * (std::pow(0.01 / 1.01 / epsilon, 2) + std::pow(0.01 / 0.02, 2)))
              .epsilon(0.05));
  }
}

TEST_CASE("the term of low modes is the angle by which they are turned, and its gradient is right")
{
  for(const Simplified_mesh* s : {&closed_example(), &open_example()}) {
    const Positions V = s->coarse.V;
    const SG::Laplace_operator op = SG::laplace_operator(V, s->coarse.T, 0.5);
    const SG::Eigenpairs pairs = SG::eigenpairs(op, 30);
    const Eigen::VectorXd values = op.mass.sum() * pairs.values;
    SG::internal::Relocation_limits limits;
    limits.beyond = 0;
    const Eigen::Index K = 8, i = 2, j = 5;
    const double epsilon =
        limits.eigenvalue_error * std::pow((std::min)(1., 10. * K / double(V.rows())), 2. / 3);
    const auto value_of_turned = [&](const double angle) {
      const auto turned = [&](const Positions&, const Eigen::Index count) {
        Eigen::MatrixXd result = 2 * pairs.vectors.leftCols(count); // of another scale
        result.applyOnTheRight(i, j,
                               Eigen::JacobiRotation<double>(std::cos(angle), -std::sin(angle)));
        return result;
      };
      return Penalty{{s->coarse.T, V, 0.5, K, values, turned, limits}}.value(V);
    };
    CHECK(value_of_turned(0) < 1e-4);
    const double angle = 0.1, h = (values(j) - values(i)) * std::sin(2 * angle) / 2 /
                                  std::sqrt(values(i) * values(j));
    const Eigen::ArrayXd inverses = values.segment(1, K - 1).array().inverse();
    const double weights = // of pairs, each counted twice
        std::pow(inverses.sum(), 2) - inverses.square().sum();
    CHECK(value_of_turned(angle) ==
          Catch::Approx(3. * 2 * h * h / (values(i) * values(j)) / weights / (epsilon * epsilon))
              .epsilon(0.01));
    // At positions where all of it changes.
    const Positions W = V + 0.004 * waves(V.rows(), 12.9898);
    const auto moved = [&](const Positions&, const Eigen::Index count) {
      return Eigen::MatrixXd(s->P * s->pairs.vectors.leftCols(count));
    };
    const auto penalty_of = [&](SG::internal::Spectrum_term::Fine_modes modes) {
      return Penalty{{s->coarse.T, V, 0.5, 20, values, std::move(modes), limits}};
    };
    Penalty with = penalty_of(moved), without = penalty_of({});
    CHECK(with.value(W) > 1.01 * without.value(W));
    CHECK(gradient_error(with, W) < 1e-6);
    // No coarse mode is near a fine one that P takes to 0, or there are too few: there is no term.
    const auto lost = [&](const Positions& at, const Eigen::Index count) {
      Eigen::MatrixXd result = moved(at, count);
      result.col(3).setZero();
      return result;
    };
    const auto constant = [&](const Positions& at, Eigen::Index) { return moved(at, 1); };
    CHECK(penalty_of(lost).value(W) == without.value(W));
    CHECK(penalty_of(constant).value(W) == without.value(W));
  }
}

TEST_CASE("the term of the spectrum compares with the start, also where it has to find the "
          "eigenvectors again")
{
  // A needle in a component whose mass is below the rounding of its cotangents: some of these
  // matrices have no Cholesky factor.
  const shapes::Matrices sphere = shapes::bumpy_icosphere_matrices(2);
  const int n = int(sphere.V.rows());
  Eigen::MatrixXi T(sphere.T.rows() + 4, 3);
  T << sphere.T, n, n + 2, n + 1, n, n + 1, n + 3, n + 1, n + 2, n + 3, n + 2, n, n + 3;
  for(const double size : {1e-4, 1e-5})
    for(const double height : {1e-8, 3e-9, 1e-9, 3e-10, 1e-10}) {
      CAPTURE(size, height);
      Positions V(n + 4, 3);
      V << sphere.V, 0, 0, 0, size, 0, 0, 0, size, 0, 0, 0, size;
      Positions W = V;
      W.col(2).head(n) *= 1.3;
      W.row(n + 3) << 0.5 * size, -height * size, height * size;
      SG::internal::Spectrum_term guard(T, V, 0.5, 20, {}, {}, {});
      guard.refresh(W);
      CHECK(guard.changes(W).mean() > 0.001);
    }
}

TEST_CASE("signals read off a surface are those of its closest points, with the slope there")
{
  const shapes::Matrices fine = wavy_grid_matrices(9, 9);
  const Eigen::MatrixXd F = rough_signals(fine, 4), Z = 2 * F;
  const SG::internal::Closest_point_query closest(fine);
  Positions V(32, 3); // inside of faces, and off the surface
  for(Eigen::Index i = 0; i < V.rows(); ++i) {
    const Eigen::Index f = 5 * i + 3;
    const Eigen::RowVector3i t = fine.T.row(f);
    V.row(i) = 0.3 * fine.V.row(t[0]) + 0.45 * fine.V.row(t[1]) + 0.25 * fine.V.row(t[2]) +
               0.003 * normal(fine.V, fine.T, f).transpose();
  }
  const SG::Mesh_matrices coarse{V, Eigen::MatrixXi(0, 3)};
  const SG::internal::Surface_regions regions(coarse, fine,
                                              SG::closest_point_interpolation(V, fine));
  SG::internal::Followed_closest_points followed(closest, regions, std::size_t(V.rows()));
  SG::internal::Surface_signals signals(fine, followed, F, Z, GENERATE(1, 3));
  for(const double step : {0., 0.06, 0.}) { // to other faces, and back to those that are known
    const Positions W = V.rowwise() + Eigen::RowVector3d(step, step / 2, 0);
    const Eigen::SparseMatrix<double> read = SG::closest_point_interpolation(W, fine);
    Rows f, z;
    signals.evaluate(W, f, z);
    CHECK((Eigen::MatrixXd(f) - read * F).cwiseAbs().maxCoeff() < 1e-12);
    CHECK((Eigen::MatrixXd(z) - read * Z).cwiseAbs().maxCoeff() < 1e-12);
  }
  const Rows by_F = waves(V.rows(), 1, 0, 4), by_Z = waves(V.rows(), 1, shapes::pi / 2, 4);
  const auto value = [&](const Positions& at) {
    Rows f, z;
    signals.evaluate(at, f, z);
    return by_F.cwiseProduct(f).sum() + by_Z.cwiseProduct(z).sum();
  };
  value(V);
  const Positions direction = waves(V.rows(), 5, 1);
  Positions gradient = Positions::Zero(V.rows(), 3);
  signals.add_gradient(by_F, by_Z, gradient);
  const double slope = (value(V + 1e-6 * direction) - value(V - 1e-6 * direction)) / 2e-6;
  CHECK(slope == Catch::Approx(gradient.cwiseProduct(direction).sum()).epsilon(1e-6));
}

namespace {

// Vertices on springs of unequal strength, each pulled elsewhere.
struct Springs
{
  Eigen::MatrixXd H;
  Positions pull;

  double value_at(const Positions& V) const { return V.cwiseProduct(0.5 * H * V - pull).sum(); }
  double value_and_gradient(const Positions& V, Positions& gradient) const
  {
    gradient = H * V - pull;
    return value_at(V);
  }
  Positions minimum() const { return H.ldlt().solve(Eigen::MatrixXd(pull)); }
};

// One vertex at most must stay.
struct One_fixed
{
  Eigen::Index v = -1;

  void tangential(const Positions&, Positions& direction) const
  {
    if(v >= 0)
      direction.row(v).setZero();
  }
  void admit(const Positions& from, Positions& to) const
  {
    if(v >= 0)
      to.row(v) = from.row(v);
  }
};

} // namespace

TEST_CASE("a vertex that no step of the others suits does not hold them")
{
  const Eigen::Index n = 40;
  Springs springs{Eigen::MatrixXd::Identity(n, n), waves(n, 3)};
  springs.H(5, 5) = 1e12;
  const double least = springs.value_at(springs.minimum());
  One_fixed guards;
  SG::internal::Guarded_descent<Springs, One_fixed> descent(springs, guards, 0.1);
  descent.start(Positions::Zero(n, 3));
  const double gap = descent.value() - least;
  for(int i = 0; i < 30 && descent.value() - least > 1e-6 * gap; ++i)
    REQUIRE(descent.step());
  CHECK(descent.value() - least < 1e-6 * gap);
}

TEST_CASE("a descent goes on after a vertex was put back, and knows what it knew")
{
  const Eigen::Index n = 40;
  Springs springs{0.01 * Eigen::MatrixXd::Identity(n, n), waves(n, 3)};
  for(Eigen::Index i = 0; i + 1 < n; ++i) {
    const double strength = 1 + 30 * (i % 3);
    springs.H.block(i, i, 2, 2) += strength * (Eigen::Matrix2d() << 1., -1., -1., 1.).finished();
  }
  One_fixed guards;
  using Descent = SG::internal::Guarded_descent<Springs, One_fixed>;
  const auto advance = [](Descent& descent, const int steps) {
    for(int i = 0; i < steps; ++i)
      REQUIRE(descent.step());
  };
  const auto after = [&](const int steps) {
    Descent descent(springs, guards, 0.1);
    descent.start(Positions::Zero(n, 3));
    advance(descent, steps);
    return descent;
  };
  Descent whole = after(25), kept = after(15);
  kept.go_on_from(kept.positions()); // where nothing was put back
  advance(kept, 10);
  CHECK(kept.value() == Catch::Approx(whole.value()).epsilon(1e-10));

  Positions V = whole.positions();
  V.row(17).setZero();
  guards.v = 17;
  Springs held = springs; // its minimum is that where vertex 17 stays in the origin
  held.H.row(17).setZero();
  held.H.col(17).setZero();
  held.H(17, 17) = 1;
  held.pull.row(17).setZero();
  const double least = springs.value_at(held.minimum());
  const auto steps_to_minimum = [&](Descent& descent) {
    const double gap = descent.value() - least;
    int steps = 0;
    for(; descent.value() - least > 1e-6 * gap && steps < 500; ++steps)
      REQUIRE(descent.step());
    CHECK(descent.positions().row(17).norm() == 0);
    return steps;
  };
  Descent anew = whole;
  anew.start(V);
  whole.go_on_from(V);
  CHECK(whole.value() == Catch::Approx(anew.value()).epsilon(1e-12));
  const int with_history = steps_to_minimum(whole), without = steps_to_minimum(anew);
  CAPTURE(with_history, without);
  CHECK(without < 500);
  CHECK(with_history < without);

  Descent all = after(10);
  all.go_on_from(Positions::Zero(n, 3)); // all of them: nothing is known any more
  Descent first = after(0);
  for(int i = 0; i < 10; ++i) {
    advance(all, 1);
    advance(first, 1);
    CHECK(all.value() == Catch::Approx(first.value()).epsilon(1e-10));
  }
}

} // namespace test_relocation_energy
