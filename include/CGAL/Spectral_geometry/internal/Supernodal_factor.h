// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SUPERNODAL_FACTOR_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SUPERNODAL_FACTOR_H

#include <CGAL/Spectral_geometry/internal/Cholesky.h>
#include <CGAL/Spectral_geometry/internal/Panel_kernels.h>

#include <Eigen/Core>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <cstddef>
#include <utility>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

// A(order, order)
inline Sparse_matrix permuted(const Sparse_matrix& A, const std::vector<int>& order)
{
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> P(A.rows());
  for(int i = 0; i < static_cast<int>(order.size()); ++i)
    P.indices()(order[i]) = i;
  Sparse_matrix result(A.rows(), A.cols());
  result = A.twistedBy(P);
  return result;
}

#ifndef CGAL_SPECTRAL_WITH_CHOLMOD

// The parent of each column in the elimination tree (Liu 1990), -1 for a root.
inline std::vector<int> elimination_tree(const Sparse_matrix& A)
{
  const int n = static_cast<int>(A.cols());
  std::vector<int> parent(n, -1), ancestor(n, -1);
  for(int k = 0; k < n; ++k)
    for(Sparse_matrix::InnerIterator it(A, k); it; ++it)
      for(int i = static_cast<int>(it.row()); i != -1 && i < k;) {
        const int next = ancestor[i];
        ancestor[i] = k; // path compression
        if(next == -1)
          parent[i] = k;
        i = next;
      }
  return parent;
}

// Eigen's minimum degree order, sorted so that every subtree of the elimination tree is contiguous: columns of one structure
// become neighbours, and a solve walks through memory.
inline std::vector<int> postordered_minimum_degree(const Sparse_matrix& A)
{
  const int n = static_cast<int>(A.cols());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> degree_order;
  Sparse_matrix copy = A; // AMDOrdering works in place
  Eigen::AMDOrdering<int>()(copy, degree_order);
  const std::vector<int> order(degree_order.indices().data(), degree_order.indices().data() + n);
  const std::vector<int> parent = elimination_tree(permuted(A, order));

  std::vector<int> first_child(n, -1), sibling(n, -1), result, stack;
  for(int j = n - 1; j >= 0; --j)
    if(parent[j] >= 0) {
      sibling[j] = first_child[parent[j]];
      first_child[parent[j]] = j;
    }
  result.reserve(n);
  for(int root = 0; root < n; ++root) {
    if(parent[root] >= 0)
      continue;
    stack.push_back(root);
    while(!stack.empty()) {
      const int j = stack.back(), child = first_child[j];
      if(child < 0) {
        result.push_back(order[j]);
        stack.pop_back();
      } else {
        first_child[j] = sibling[child];
        stack.push_back(child);
      }
    }
  }
  return result;
}

// Neighbouring columns of a factor that are stored with one row structure.
struct Column_group
{
  int first, width, below;
  double zeros; // entries that only the common structure has
};

// Merges a group with the one before, its child in the elimination tree, when that adds few zeros; the bounds are CHOLMOD's.
inline bool merge_groups(Column_group& child, const Column_group& group)
{
  const double width = child.width + group.width;
  const double zeros =
      child.zeros + group.zeros + double(child.width) * (group.width + group.below - child.below);
  const double ratio = zeros / (width * (0.5 * (width + 1.) + group.below));
  if(width > 4 && !(width <= 16 && ratio < 0.8) && !(width <= 48 && ratio < 0.1) && !(ratio < 0.05))
    return false;
  child = {child.first, child.width + group.width, group.below, zeros};
  return true;
}

inline std::vector<Column_group> group_columns(const Sparse_matrix& L)
{
  const int n = static_cast<int>(L.cols());
  const int* start = L.outerIndexPtr();
  const auto below = [&](int j) { return start[j + 1] - start[j] - 1; };
  const auto parent = [&](int j) { return below(j) > 0 ? L.innerIndexPtr()[start[j] + 1] : -1; };

  std::vector<Column_group> groups;
  for(int j = 0; j < n;) {
    Column_group group{j, 1, below(j), 0.};
    for(++j; j < n && parent(j - 1) == j && below(j) + 1 == group.below; ++j) { // the very same structure
      ++group.width;
      group.below = below(j);
    }
    while(!groups.empty() && parent(group.first - 1) == group.first && merge_groups(groups.back(), group)) {
      group = groups.back();
      groups.pop_back();
    }
    groups.push_back(group);
  }
  return groups;
}

#endif // CGAL_SPECTRAL_WITH_CHOLMOD

/// A Cholesky factor P A P^T = L L^T whose triangular solves work on panels of eight right-hand sides.
///
/// CHOLMOD's own solves take 1.6 ms per vector on a mesh of 50,000 vertices, with eight or with a hundred right-hand
/// sides; these take 0.5 ms. Panels are in the order of the factor: order()[i] is the row of A that is row i of the panel.
class Supernodal_factor
{
public:
  explicit Supernodal_factor(const Sparse_matrix& A)
  {
#ifdef CGAL_SPECTRAL_WITH_CHOLMOD
    from_cholmod(A);
#else
    from_eigen(A);
#endif
  }

  const std::vector<int>& order() const { return m_order; }

  // x = L^-T L^-1 x
  void solve(double* x) const
  {
    const std::size_t count = m_first.size() - 1;
    for(std::size_t k = 0; k < count; ++k)
      forward(supernode(k), x);
    for(std::size_t k = count; k-- > 0;)
      backward(supernode(k), x);
  }

private:
  Supernode supernode(std::size_t k) const
  {
    const int width = m_first[k + 1] - m_first[k];
    return {m_values.data() + m_value_start[k], m_rows.data() + m_row_start[k], m_first[k], width,
            static_cast<int>(m_row_start[k + 1] - m_row_start[k])};
  }

  // Appends a supernode; the caller fills the returned (width + below) x width values, by rows.
  double* append(int width, const int* rows, int below)
  {
    m_first.push_back(m_first.back() + width);
    m_rows.insert(m_rows.end(), rows, rows + below);
    m_row_start.push_back(m_rows.size());
    m_value_start.push_back(m_values.size());
    m_values.resize(m_values.size() + std::size_t(width + below) * width);
    return m_values.data() + m_value_start.back();
  }

  void reserve(std::size_t rows, std::size_t values)
  {
    m_rows.reserve(rows);
    m_values.reserve(values);
  }

#ifdef CGAL_SPECTRAL_WITH_CHOLMOD
  void from_cholmod(const Sparse_matrix& A)
  {
    const Cholmod_factor cholmod(A, true);
    if(!cholmod.ok())
      factorisation_failed();
    const cholmod_factor& f = *cholmod.get();
    const int* order = static_cast<const int*>(f.Perm);
    const int* first = static_cast<const int*>(f.super);
    const int* row_start = static_cast<const int*>(f.pi);
    const int* value_start = static_cast<const int*>(f.px);
    const int* rows = static_cast<const int*>(f.s);
    const double* values = static_cast<const double*>(f.x);
    m_order.assign(order, order + f.n);
    reserve(f.ssize, f.xsize);
    for(std::size_t k = 0; k < f.nsuper; ++k) {
      const int width = first[k + 1] - first[k], height = row_start[k + 1] - row_start[k];
      double* to = append(width, rows + row_start[k] + width, height - width);
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> block(to, height, width);
      block = Eigen::Map<const Eigen::MatrixXd>(values + value_start[k], height, width);
      block.diagonal() = block.diagonal().cwiseInverse().eval();
    }
  }
#else
  void from_eigen(const Sparse_matrix& A)
  {
    m_order = postordered_minimum_degree(A);
    const Eigen::SimplicialLLT<Sparse_matrix, Eigen::Lower, Eigen::NaturalOrdering<int>> llt(permuted(A, m_order));
    if(llt.info() != Eigen::Success)
      factorisation_failed();
    const Sparse_matrix& L = llt.matrixL().nestedExpression();

    const std::vector<Column_group> groups = group_columns(L);
    std::size_t rows = 0, values = 0;
    for(const Column_group& g : groups) {
      rows += g.below;
      values += std::size_t(g.width + g.below) * g.width;
    }
    reserve(rows, values);
    std::vector<int> local(L.rows());
    for(const Column_group& g : groups) {
      const int last = g.first + g.width - 1;
      const int* below = L.innerIndexPtr() + L.outerIndexPtr()[last] + 1;
      double* to = append(g.width, below, g.below);
      for(int i = 0; i < g.width; ++i)
        local[g.first + i] = i;
      for(int i = 0; i < g.below; ++i)
        local[below[i]] = g.width + i;
      for(int t = 0; t < g.width; ++t)
        for(Sparse_matrix::InnerIterator it(L, g.first + t); it; ++it)
          to[std::size_t(local[it.row()]) * g.width + t] = it.row() == it.col() ? 1. / it.value() : it.value();
    }
  }
#endif

  std::vector<int> m_order;
  std::vector<int> m_first = {0};             // first column of each supernode, and n
  std::vector<std::size_t> m_row_start = {0}; // into m_rows
  std::vector<int> m_rows;
  std::vector<std::size_t> m_value_start; // into m_values
  std::vector<double> m_values;
};

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SUPERNODAL_FACTOR_H
