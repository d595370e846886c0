// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Random mixtures of the signals in place of the signals: what they estimate, how well, and when
// there are none.

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include "catch.h"
#include "collapse_helpers.h"
#include "core_helpers.h"

#include <Eigen/QR>

namespace test_mixtures {

using namespace spectral_test;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;
using SMS::Spectral_edge_collapse_options;
using SMS::Spectral_options;
using SMS::internal::random_mixtures;
using SMS::internal::spectral_basis;

namespace {

// Mean and variance of numbers, each with the deviation that it has for so many of them.
class Sample_moments
{
public:
  void add(const double x) { m_values.push_back(x); }

  double mean() const { return moment(1, 0); }
  double variance() const { return moment(2, mean()); }
  double error_of_mean() const { return std::sqrt(variance() / size()); }
  double error_of_variance() const
  {
    return std::sqrt((moment(4, mean()) - variance() * variance()) / size());
  }

private:
  double size() const { return double(m_values.size()); }
  double moment(const int power, const double around) const
  {
    double sum = 0;
    for(const double x : m_values)
      sum += std::pow(x - around, power);
    return sum / size();
  }

  std::vector<double> m_values;
};

// What is seldom exceeded: once in a million numbers.
constexpr double deviations = 5;

Eigen::MatrixXd random_rotation(const Eigen::Index n)
{
  std::mt19937 random(17);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
  return Eigen::HouseholderQR<Eigen::MatrixXd>(A).householderQ();
}

Core mixed_core(const Slow_mesh& mesh, const shapes::Matrices& input,
                const Spectral_options& options)
{
  return make_core(mesh, spectral_basis(input.V, input.T, options),
                   SMS::internal::local_operator(options), options);
}

// F, or its mixtures, as a matrix.
Eigen::MatrixXd tracked_signals(const SMS::internal::Spectral_basis& basis)
{
  SMS::internal::Spectral_fields fields;
  fields.signals = basis.signals;
  Eigen::MatrixXd F(basis.number_of_vertices, basis.signals.size());
  for(Eigen::Index w = 0; w < F.rows() && F.cols() > 0; ++w)
    F.row(w) = spectral_test::tracked_signals(fields, w);
  return F;
}

// A collapse as a core is told of it.
struct Recorded_collapse
{
  Slot removed, kept;
  double weight;
  Eigen::Vector3d point;
  SMS::internal::Spectral_ring ring;
};

// Collapses of the core and the slow mesh, each the cheapest of a few edges drawn at random.
std::vector<Recorded_collapse> recorded_collapses(Core& core, Slow_mesh& mesh, const int count)
{
  std::mt19937 random(3);
  std::vector<Recorded_collapse> result;
  while(int(result.size()) < count) {
    const std::vector<Edge> edges = mesh.edge_list();
    Sample best;
    Edge edge(0, 0);
    for(int k = 0; k < 12; ++k) {
      const Edge e = edges[random() % edges.size()];
      const Sample c = core.evaluate(Slot(e.first), Slot(e.second));
      if(c.cost < best.cost) {
        best = c;
        edge = e;
      }
    }
    if(!best.collapsible())
      continue;
    commit(core, mesh, edge, best, false);
    result.push_back(
        {Slot(edge.first), Slot(edge.second), 1 - best.weight, best.point, mesh.ring(edge.second)});
  }
  return result;
}

Mesh simplified(const shapes::Matrices& input, const Spectral_edge_collapse_options& options)
{
  Mesh mesh = make_mesh(input);
  SMS::spectral_edge_collapse(mesh, 120, options);
  return mesh;
}

} // namespace

TEST_CASE("The columns of mixtures are orthogonal, of one length, and the same for the same seed")
{
  const Eigen::Index r = GENERATE(1, 4, 16);
  const Eigen::MatrixXd R = random_mixtures(20, r, 5);
  CHECK((R.transpose() * R - 20. / double(r) * Eigen::MatrixXd::Identity(r, r)).norm() < 1e-12);
  CHECK(R == random_mixtures(20, r, 5));
  CHECK((R - random_mixtures(20, r, 6)).norm() > 1);
  // As many mixtures as signals are no estimate.
  const Eigen::MatrixXd all = random_mixtures(r, r, 1);
  CHECK((all * all.transpose() - Eigen::MatrixXd::Identity(r, r)).norm() < 1e-12);
}

TEST_CASE("Mixtures estimate a squared norm without bias, with the variance that is documented")
{
  const Eigen::Index r = GENERATE(1, 4, 16), n = 24;
  enum Spectrum { rank_one, even, decaying, rank_two };
  const Spectrum spectrum = GENERATE(rank_one, even, decaying, rank_two);
  CAPTURE(r, int(spectrum));
  // A F in a basis that has nothing to do with that of the mixtures.
  Eigen::VectorXd singular = Eigen::VectorXd::Zero(n);
  if(spectrum == even)
    singular.setOnes();
  else if(spectrum == decaying)
    singular = Eigen::VectorXd::LinSpaced(n, 0, -2).array().exp();
  else
    singular.head(spectrum == rank_one ? 1 : 2) =
        Eigen::Vector2d(3, 1).head(spectrum == rank_one ? 1 : 2);
  const Eigen::MatrixXd AF = singular.asDiagonal() * random_rotation(n);

  Sample_moments estimates;
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(n, n); // of R R^T
  const int seeds = 2000;
  for(int seed = 0; seed < seeds; ++seed) {
    const Eigen::MatrixXd R = random_mixtures(n, r, std::uint64_t(seed));
    estimates.add((AF * R).squaredNorm());
    mean += R * R.transpose() / seeds;
  }
  const double trace = singular.squaredNorm(), squares = singular.cwiseAbs2().squaredNorm();
  const double variance =
      2. * double(n - r) / double(r * (n - 1) * (n + 2)) * (double(n) * squares - trace * trace);
  CHECK(std::abs(estimates.mean() - trace) <=
        deviations * std::sqrt(variance / seeds) + 1e-12 * trace);
  CHECK(std::abs(estimates.variance() - variance) <=
        deviations * estimates.error_of_variance() + 1e-12 * trace * trace);
  CHECK(estimates.variance() < 2. / double(r) * squares);
  if(spectrum != even) // where every column of R has the same norm
    CHECK(estimates.variance() > 0.1 * variance);
  CHECK((mean - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff() <
        deviations * std::sqrt(2. / (double(r) * seeds)));
}

TEST_CASE("Mixtures of a rotated basis give costs of the same mean and variance")
{
  const Eigen::Index r = GENERATE(1, 4), K = 12;
  const shapes::Matrices input = wavy_grid_matrices(7, 6);
  const Basis basis = eigenbasis(input, 0, K + 1);
  const Slow_mesh mesh(input, basis);
  Spectral_options options = Spectral_options::paper();
  const std::vector<Edge> edges = mesh.edge_list();
  const auto costs = [&] {
    std::vector<double> result;
    Core core = mixed_core(mesh, input, options);
    for(std::size_t i = 0; i < edges.size(); i += 6)
      result.push_back(
          core.cost_at(Slot(edges[i].first), Slot(edges[i].second), on_edge(mesh, edges[i], 0.4)));
    return result;
  };
  std::vector<double> exact;
  std::vector<Sample_moments> moments[2];
  for(const bool rotated : {false, true}) {
    options.signals = basis.F.rightCols(K);
    if(rotated)
      options.signals *= random_rotation(K);
    options.number_of_mixtures = 0;
    const std::vector<double> unmixed = costs();
    if(rotated)
      for(std::size_t i = 0; i < exact.size(); ++i)
        CHECK((unmixed[i] == exact[i] || relative_difference(unmixed[i], exact[i]) < 1e-8));
    exact = unmixed;
    options.number_of_mixtures = r;
    moments[rotated].resize(exact.size());
    for(options.seed = 0; options.seed < 2000; ++options.seed) {
      const std::vector<double> mixed = costs();
      for(std::size_t i = 0; i < exact.size(); ++i)
        moments[rotated][i].add(mixed[i]);
    }
  }
  int compared = 0;
  for(std::size_t i = 0; i < exact.size(); ++i) {
    if(!std::isfinite(exact[i]))
      continue;
    const Sample_moments &plain = moments[0][i], &rotated = moments[1][i];
    CHECK(std::abs(plain.mean() - exact[i]) < deviations * plain.error_of_mean());
    CHECK(std::abs(rotated.mean() - exact[i]) < deviations * rotated.error_of_mean());
    CHECK(std::abs(plain.variance() - rotated.variance()) <
          deviations * std::hypot(plain.error_of_variance(), rotated.error_of_variance()));
    CHECK(plain.error_of_mean() < 0.2 * std::abs(exact[i])); // or these were empty words
    ++compared;
  }
  CHECK(compared > 10);
}

TEST_CASE("Costs and E of mixtures estimate those of all signals without bias, before and after "
          "collapses")
{
  const SG::Mass mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  const Eigen::Index K = 40, r = 16;
  Spectral_options options = Spectral_options::paper();
  options.mass = mass;
  const SG::Laplace_operator op = SG::laplace_operator(input.V, input.T, SG::mass_blend(mass));
  options.eigenpairs = std::make_shared<const SG::Eigenpairs>(SG::eigenpairs(op, K));
  const Basis basis = basis_of_pairs(op, *options.eigenpairs, SG::mass_blend(mass));
  const Slow_mesh fine(input, basis);

  // All signals, which the definitions confirm.
  Slow_mesh coarse = fine;
  Core all = mixed_core(fine, input, options);
  CHECK(all.fields().signals.size() == K - 1);
  std::mt19937 random(1);
  CHECK(compare_costs(all, fine, 12, random).worst < 1e-9);
  const std::vector<Recorded_collapse> collapses = recorded_collapses(all, coarse, 70);
  CHECK(compare_costs(all, coarse, 12, random).worst < 1e-9);
  CHECK(relative_difference(all.total(), coarse.energy()) < 1e-9);

  const auto costs = [](Core& core, const Slow_mesh& mesh) {
    std::vector<double> result;
    const std::vector<Edge> edges = mesh.edge_list();
    for(std::size_t i = 0; i < edges.size(); i += 5)
      result.push_back(
          core.cost_at(Slot(edges[i].first), Slot(edges[i].second), on_edge(mesh, edges[i], 0.4)));
    return result;
  };
  Core all_before = mixed_core(fine, input, options);
  const std::vector<double> exact[2] = {costs(all_before, fine), costs(all, coarse)};
  std::vector<Sample_moments> estimates[2];
  Sample_moments E;
  options.number_of_mixtures = r;
  for(options.seed = 1; options.seed <= 300; ++options.seed) {
    Core core = mixed_core(fine, input, options);
    REQUIRE(core.fields().signals.size() == r);
    for(const int after : {0, 1}) {
      if(after == 1)
        for(const Recorded_collapse& c : collapses)
          core.commit({c.removed, c.kept, c.weight}, c.point, c.ring);
      const std::vector<double> mixed = costs(core, after == 1 ? coarse : fine);
      estimates[after].resize(mixed.size());
      for(std::size_t i = 0; i < mixed.size(); ++i)
        estimates[after][i].add(mixed[i]);
    }
    E.add(core.total());
  }
  CHECK(std::abs(E.mean() - all.total()) < deviations * E.error_of_mean());
  CHECK(E.variance() < 2. / double(r) * all.total() * all.total());
  CHECK(E.variance() > 1e-6 * all.total() * all.total());
  int compared = 0;
  for(const int after : {0, 1})
    for(std::size_t i = 0; i < exact[after].size(); ++i) {
      if(!std::isfinite(exact[after][i]))
        continue;
      const Sample_moments& m = estimates[after][i];
      CHECK(std::abs(m.mean() - exact[after][i]) < deviations * m.error_of_mean());
      if(after == 0) // E is 0 there, and a cost a squared norm
        CHECK(m.variance() < 2. / double(r) * exact[0][i] * exact[0][i]);
      ++compared;
    }
  CHECK(compared > 100);
}

TEST_CASE("The same seed gives the same mesh on any number of threads, another one gives another")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 40;
  options.relocate = GENERATE(false, true);
  const Mesh first = simplified(input, options);
  CHECK(identical(first, simplified(input, options)));
  options.threads = 2;
  CHECK(identical(first, simplified(input, options)));
  options.seed = 2;
  CHECK_FALSE(identical(first, simplified(input, options)));
}

TEST_CASE(
    "No more signals than the mixtures asked for are not mixed, those of eigenvalue 0 not counted")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Spectral_edge_collapse_options options;
  options.number_of_mixtures = 16;
  options.number_of_eigenvectors = GENERATE(5, 16, 17, 18);
  options.relocate = false;
  CAPTURE(options.number_of_eigenvectors);
  const bool few = options.number_of_eigenvectors <= 17;
  const Mesh mixed = simplified(input, options);
  options.seed = 77;
  CHECK(identical(mixed, simplified(input, options)) == few);
  options.number_of_mixtures = 0;
  CHECK(identical(mixed, simplified(input, options)) == few);
}

TEST_CASE("Signals of the user's beyond the mixtures asked for are mixed, each with its weight or "
          "not at all")
{
  const shapes::Matrices input = wavy_grid_matrices(9, 8);
  const Eigen::Index K = 20, r = 6;
  Spectral_options options;
  options.mass = GENERATE(SG::Mass::lumped, SG::Mass::averaged);
  options.number_of_mixtures = r;
  options.signals = rough_signals(input, K);
  options.seed = 9;
  const Eigen::Index positive = GENERATE(20, 7, 6, 2);
  CAPTURE(positive);
  options.weights = Eigen::VectorXd::Zero(K);
  Eigen::MatrixXd seen(input.V.rows(), positive);
  for(Eigen::Index k = 0; k < positive; ++k) {
    const Eigen::Index column = K - 1 - k * (K / positive); // the others between them have none
    options.weights[column] = 0.5 + double(k);
    seen.col(positive - 1 - k) = std::sqrt(0.5 + double(k)) * options.signals.col(column);
  }
  const SMS::internal::Spectral_basis basis = spectral_basis(input.V, input.T, options);
  const Eigen::MatrixXd F = tracked_signals(basis);
  if(positive <= r)
    CHECK((F - seen).norm() < 1e-12 * seen.norm());
  else
    CHECK((F - seen * random_mixtures(positive, r, 9)).norm() < 1e-12 * seen.norm());
  // Whatever is mixed, E at its worst is that of all signals.
  const Basis whole = signal_basis(input, SG::mass_blend(options.mass),
                                   options.signals * options.weights.cwiseSqrt().asDiagonal());
  const SG::Laplace_operator op =
      SG::laplace_operator(input.V, input.T, SG::mass_blend(options.mass));
  const double lost = whole.Z.cwiseProduct(op.B * whole.Z).sum() / whole.area;
  CHECK(relative_difference(basis.sum_of_squares, lost) < 1e-9);
}

TEST_CASE("Eigenvectors of eigenvalue 0, one for each component, are left out of the metric")
{
  const shapes::Matrices input =
      shapes::components_matrices(shapes::bumpy_icosphere_matrices(1), 2);
  const SG::Laplace_operator op = SG::laplace_operator(input.V, input.T, 0.5);
  Spectral_options options;
  options.number_of_mixtures = 16;
  const Eigen::Index K = GENERATE(1, 2, 3, 12, 30);
  CAPTURE(K);
  options.eigenpairs = std::make_shared<const SG::Eigenpairs>(SG::eigenpairs(op, K));
  options.shape = 0;
  // Nothing else says what is good where nothing costs anything.
  options.keep_free_of_self_intersections = false;
  const SMS::internal::Spectral_basis basis = spectral_basis(input.V, input.T, options);
  const Eigen::Index left = (std::max)(K - 2, Eigen::Index(0));
  REQUIRE(basis.signals.size() == (std::min)(left, Eigen::Index(16)));
  Eigen::MatrixXd expected = std::sqrt(basis.area) * options.eigenpairs->vectors.rightCols(left);
  if(left > 16)
    expected *= random_mixtures(left, 16, options.seed);
  CHECK((tracked_signals(basis) - expected).norm() <= 1e-12 * expected.norm());
  Mesh mesh = make_mesh(input);
  const Policies policies(mesh, options);
  collapse(mesh, policies, 40);
  CHECK(count_vertices(mesh) == 40);
  CHECK((policies.error() > 0) == (left > 0));
}

} // namespace test_mixtures
