// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include <CGAL/Spectral_geometry/restriction.h>

#include "catch.h"

namespace test_restriction {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using SG::Merge_forest;
using Sparse = Eigen::SparseMatrix<double>;

namespace {

std::vector<Index> first_indices(Index n)
{
  std::vector<Index> indices(n);
  std::iota(indices.begin(), indices.end(), Index(0));
  return indices;
}

enum class Weights { any, binary };

// Merges random slots until `left` are left. One weight out of three is exactly 0 or 1.
Merge_forest random_forest(Index n, Index left, unsigned seed, Weights weights)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0., 1.);
  std::vector<Index> alive = first_indices(n);
  Merge_forest forest(n);
  while(static_cast<Index>(alive.size()) > left) {
    std::shuffle(alive.begin(), alive.end(), random);
    double alpha = uniform(random);
    if(weights == Weights::binary || alpha < 0.3)
      alpha = random() % 2;
    forest.merge(alive.back(), alive.front(), alpha);
    alive.pop_back();
  }
  return forest;
}

// P = Q_m ... Q_2 Q_1 by sparse products, one matrix with one row less for each merge.
Sparse product_of_merges(const Merge_forest& forest, Index number_of_merges,
                         std::vector<Index>& slots)
{
  slots = first_indices(forest.number_of_slots());
  Sparse P(forest.number_of_slots(), forest.number_of_slots());
  P.setIdentity();
  for(Index m = 0; m < number_of_merges; ++m) {
    const Merge_forest::Merge merge = forest.merges()[m];
    Sparse Q(static_cast<Index>(slots.size()) - 1, static_cast<Index>(slots.size()));
    std::vector<Index> left;
    for(Index w = 0; w < static_cast<Index>(slots.size()); ++w)
      if(slots[w] != merge.removed) {
        Q.insert(static_cast<Index>(left.size()), w) =
            slots[w] == merge.kept ? 1. - merge.weight : 1.;
        if(slots[w] == merge.kept) {
          const auto v = std::find(slots.begin(), slots.end(), merge.removed) - slots.begin();
          Q.insert(static_cast<Index>(left.size()), v) = merge.weight;
        }
        left.push_back(slots[w]);
      }
    P = Sparse(Q * P);
    slots = left;
  }
  return P;
}

void check_restriction(const Sparse& P)
{
  for(Index column = 0; column < P.cols(); ++column) {
    Index nonzeros = 0;
    for(Sparse::InnerIterator it(P, column); it; ++it, ++nonzeros)
      CHECK(it.value() > 0.);
    CHECK(nonzeros <= 1);
  }
  const VectorXd sums = P * VectorXd::Ones(P.cols());
  CHECK((sums.array() - 1.).abs().maxCoeff() < 1e-13);
}

} // namespace

TEST_CASE("restriction equals the product of the matrices of all merges, after any number of them")
{
  for(unsigned seed = 1; seed <= 8; ++seed) {
    const Merge_forest forest = random_forest(60, seed, seed, Weights::any);
    for(const Index m : {Index(0), Index(1), Index(17), forest.number_of_merges()}) {
      std::vector<Index> slots;
      const Sparse expected = product_of_merges(forest, m, slots);
      CHECK(forest.kept_slots(m) == slots);
      const Sparse P = forest.restriction(slots, m);
      check_restriction(P);
      CHECK(P.rows() == 60 - m);
      CHECK((MatrixXd(P) - MatrixXd(expected)).cwiseAbs().maxCoeff() < 1e-15);
    }
  }
}

TEST_CASE("restriction rows follow the order of the list of slots")
{
  const Merge_forest forest = random_forest(40, 9, 5, Weights::any);
  std::vector<Index> slots = forest.kept_slots();
  const MatrixXd P = forest.restriction(slots);
  std::reverse(slots.begin(), slots.end());
  CHECK(MatrixXd(forest.restriction(slots)) == MatrixXd(P.colwise().reverse()));
  const std::vector<std::size_t> map = forest.vertex_map(slots);
  for(Index row = 0; row < 9; ++row)
    CHECK(Index(map[slots[row]]) == row);
}

TEST_CASE("vertex map is total, agrees with the restriction, and binary rows hold exactly one 1")
{
  for(const Weights weights : {Weights::any, Weights::binary}) {
    const Merge_forest forest = random_forest(200, 25, 3, weights);
    const std::vector<Index> slots = forest.kept_slots();
    const Sparse P = forest.restriction(slots);
    const std::vector<std::size_t> map = forest.vertex_map(slots);
    REQUIRE(map.size() == 200);
    CHECK(*std::max_element(map.begin(), map.end()) < 25);
    for(Index column = 0; column < P.cols(); ++column)
      for(Sparse::InnerIterator it(P, column); it; ++it)
        CHECK(it.row() == Index(map[column]));
    CHECK(P.nonZeros() <
          200); // merges with alpha 0 or 1 leave empty columns, but no hole in the map
    if(weights == Weights::binary) {
      CHECK(P.nonZeros() == P.rows());
      CHECK((MatrixXd(P).rowwise().maxCoeff().array() == 1.).all());
    }
  }
}

TEST_CASE("restriction of a log of a hundred thousand merges in one chain")
{
  const Index n = 100000;
  Merge_forest forest(n);
  for(Index i = 0; i + 1 < n; ++i)
    forest.merge(i, i + 1, 1. - 1. / static_cast<double>(i + 2)); // the mean of all so far
  const Sparse P = forest.restriction(forest.kept_slots());
  CHECK(P.nonZeros() == n);
  CHECK(P.coeff(0, 0) == Approx(1. / n).epsilon(1e-9));
  CHECK(P.coeff(0, n - 1) == Approx(1. / n).epsilon(1e-9));
}

TEST_CASE("merge forest rejects nonsense and stays as it was")
{
  Merge_forest forest(4);
  forest.merge(1, 0, 0.25);
  CHECK_THROWS_WITH(forest.merge(1, 2, 0.5), ContainsSubstring("slot 1 has been removed"));
  CHECK_THROWS_WITH(forest.merge(2, 1, 0.5), ContainsSubstring("slot 1 has been removed"));
  CHECK_THROWS_WITH(forest.merge(2, 2, 0.5), ContainsSubstring("into itself"));
  CHECK_THROWS_WITH(forest.merge(4, 2, 0.5), ContainsSubstring("slot 4 is not one of the 4"));
  CHECK_THROWS_AS(forest.merge(2, -1, 0.5), std::invalid_argument);
  CHECK_THROWS_AS(forest.merge(2, 3, 1.5), std::invalid_argument);
  CHECK_THROWS_AS(forest.merge(2, 3, std::numeric_limits<double>::quiet_NaN()),
                  std::invalid_argument);
  CHECK(forest.number_of_merges() == 1);
  CHECK(forest.is_alive(2));
  CHECK_FALSE(forest.is_alive(1));
  CHECK_THROWS_WITH(forest.restriction({0, 1, 2}), ContainsSubstring("slot 1"));
  CHECK_THROWS_WITH(forest.restriction({0, 2}), ContainsSubstring("slot 3 is left but has no row"));
  CHECK_THROWS_WITH(forest.restriction({0, 2, 3, 2}), ContainsSubstring("twice"));
  CHECK_THROWS_AS(forest.restriction({0, 2, 7}), std::invalid_argument);
  CHECK_THROWS_AS(forest.vertex_map({0, 2, 3}, 2), std::invalid_argument);
  CHECK_THROWS_AS(Merge_forest(-1), std::invalid_argument);
  CHECK(MatrixXd(forest.restriction({3, 0, 2})).row(1) == Eigen::RowVector4d(0.75, 0.25, 0., 0.));
  CHECK(Merge_forest().restriction({}).size() == 0);
}

} // namespace test_restriction
