// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_SUPERNODAL_STRUCTURE_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_SUPERNODAL_STRUCTURE_H

#include <Eigen/Core>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <vector>

namespace CGAL::Spectral_geometry::internal {

using Sparse_matrix = Eigen::SparseMatrix<double>;

// A(order, order)
inline Sparse_matrix permuted(const Sparse_matrix& A, const std::vector<int>& order)
{
  const Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> P(
      Eigen::VectorXi::Map(order.data(), A.rows()));
  Sparse_matrix result;
  result = A.twistedBy(P.inverse());
  return result;
}

// The parent of each column in the elimination tree (Liu 1990), n for a root.
inline std::vector<int> elimination_tree(const Sparse_matrix& A)
{
  const int n = static_cast<int>(A.cols());
  std::vector<int> parent(n, n), ancestor(n, n);
  for(int k = 0; k < n; ++k)
    for(Sparse_matrix::InnerIterator it(A, k); it; ++it)
      for(int i = static_cast<int>(it.row()); i < k;) {
        const int next = ancestor[i];
        ancestor[i] = k; // path compression
        if(next == n)
          parent[i] = k;
        i = next;
      }
  return parent;
}

// Eigen's minimum degree order, sorted so that every subtree of the elimination tree is contiguous:
// columns of one structure become neighbours, and a solve walks through memory.
inline std::vector<int> postordered_minimum_degree(const Sparse_matrix& A)
{
  const int n = static_cast<int>(A.cols());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> degree_order;
  Eigen::AMDOrdering<int>()(A, degree_order);
  const std::vector<int> order(degree_order.indices().data(), degree_order.indices().data() + n);
  const std::vector<int> parent = elimination_tree(permuted(A, order));
  std::vector<int> size(n + 1, 1), end(n + 1, n),
      result(n); // of subtrees, and where the next child's ends
  for(int j = 0; j < n; ++j)
    size[parent[j]] += size[j];
  for(int j = n - 1; j >= 0; --j) {
    end[j] = end[parent[j]] - 1;
    result[end[j]] = order[j];
    end[parent[j]] -= size[j];
  }
  return result;
}

// The number of entries of each column of the Cholesky factor, the diagonal included: row k of the
// factor has those that the way up the tree from an entry of row k of A meets.
inline std::vector<int> column_counts(const Sparse_matrix& A, const std::vector<int>& parent)
{
  const int n = static_cast<int>(A.cols());
  std::vector<int> count(n, 1), met_by(n, -1);
  for(int k = 0; k < n; ++k) {
    met_by[k] = k;
    for(Sparse_matrix::InnerIterator it(A, k); it && it.row() < k; ++it)
      for(int j = static_cast<int>(it.row()); met_by[j] != k; j = parent[j]) {
        ++count[j];
        met_by[j] = k;
      }
  }
  return count;
}

// Neighbouring columns of a factor that are stored with one row structure.
struct Column_group
{
  int first, width, below;
  double zeros; // entries that only the common structure has
};

// Merges a group with the one before, its child in the elimination tree, when that adds few zeros;
// the bounds are CHOLMOD's.
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

inline std::vector<Column_group> group_columns(const Sparse_matrix& A)
{
  const std::vector<int> parent = elimination_tree(A), count = column_counts(A, parent);
  const int n = static_cast<int>(A.cols());
  std::vector<Column_group> groups;
  for(int j = 0; j < n;) {
    Column_group group{j, 1, count[j] - 1, 0.};
    for(++j; j < n && parent[j - 1] == j && count[j] == group.below;
        ++j) { // the very same structure
      ++group.width;
      group.below = count[j] - 1;
    }
    while(!groups.empty() && parent[group.first - 1] == group.first &&
          merge_groups(groups.back(), group)) {
      group = groups.back();
      groups.pop_back();
    }
    groups.push_back(group);
  }
  return groups;
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_SUPERNODAL_STRUCTURE_H
