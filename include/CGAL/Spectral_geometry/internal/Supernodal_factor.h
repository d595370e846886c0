// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SUPERNODAL_FACTOR_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SUPERNODAL_FACTOR_H

#include <CGAL/Spectral_geometry/internal/Cholesky.h>
#include <CGAL/Spectral_geometry/internal/Panel.h>
#include <CGAL/Spectral_geometry/internal/Panel_kernels.h>
#include <CGAL/Spectral_geometry/internal/column_groups.h>
#include <CGAL/Spectral_geometry/internal/Thread_pool.h>

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// A set of neighbouring supernodes that no other supernode outside of the set and its ancestors depends on.
struct Branch
{
  std::size_t first, last;    // supernodes first .. last - 1
  Index slot;                 // of the workspace, where it keeps its share of the ancestors' rows
  std::vector<int> ancestors; // these rows
  std::size_t values = 0;
};

/// A Cholesky factor P A P^T = L L^T whose triangular solves work on panels of eight right-hand sides.
///
/// CHOLMOD's own solves take 1.6 ms per vector on a mesh of 50,000 vertices, with eight or with a hundred right-hand
/// sides; these take 0.5 ms. Panels are in the order of the factor: order()[i] is the row of A that is row i of the panel.
/// Branches of the elimination tree are solved in parallel, each with its own copy of the ancestors' rows, which are then
/// added in a fixed order.
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
    find_branches();
  }

  const std::vector<int>& order() const
  {
    return m_order;
  }

  // x = L^-T L^-1 b
  void solve(const Panel& b, Panel& x, int threads)
  {
    double* w = m_workspace->row(0);
    const Index entries = Index(m_order.size()) * panel_width;
    std::copy_n(b.row(0), entries, w);
    const int branches = static_cast<int>(m_branches.size());
    for_each_task(branches, threads, [&](int k) { forward_branch(m_branches[k], w); });
    for(const Branch& branch : m_branches)
      add_to_ancestors(branch, w);
    for(const std::size_t k : m_top)
      forward(supernode(k), w);
    for(std::size_t k = m_top.size(); k-- > 0;)
      backward(supernode(m_top[k]), w);
    for_each_task(branches, threads, [&](int k) { backward_branch(m_branches[k], w); });
    std::copy_n(w, entries, x.row(0));
  }

private:
  Supernode supernode(std::size_t k) const
  {
    const int width = m_first[k + 1] - m_first[k];
    return {m_values.data() + m_value_start[k], m_rows.data() + m_row_start[k], m_first[k], width,
            static_cast<int>(m_row_start[k + 1] - m_row_start[k])};
  }

  void forward_branch(const Branch& branch, double* w) const
  {
    std::fill_n(w + branch.slot * panel_width, branch.ancestors.size() * panel_width, 0.);
    for(std::size_t k = branch.first; k < branch.last; ++k)
      forward(supernode(k), w);
  }

  void add_to_ancestors(const Branch& branch, double* w) const
  {
    const double* from = w + branch.slot * panel_width;
    for(const int row : branch.ancestors)
      for(int c = 0; c < panel_width; ++c)
        w[Index(row) * panel_width + c] += *from++;
  }

  void backward_branch(const Branch& branch, double* w) const
  {
    double* to = w + branch.slot * panel_width;
    for(const int row : branch.ancestors)
      to = std::copy_n(w + Index(row) * panel_width, panel_width, to);
    for(std::size_t k = branch.last; k-- > branch.first;)
      backward(supernode(k), w);
  }

  // Subtrees of between 1/256 and 1/16 of the factor become branches; the rest is the top, solved by one thread.
  void find_branches()
  {
    const std::size_t count = m_first.size() - 1, total = m_values.size();
    std::vector<Branch> subtree(count);
    for(std::size_t k = 0; k < count; ++k)
      subtree[k] = {k, k + 1, 0, {}, 0};
    for(std::size_t k = 0; k < count; ++k) {
      subtree[k].values += (k + 1 < count ? m_value_start[k + 1] : total) - m_value_start[k];
      if(m_row_start[k] == m_row_start[k + 1])
        continue;
      const int row = m_rows[m_row_start[k]];
      const std::size_t parent = std::upper_bound(m_first.begin(), m_first.end(), row) - m_first.begin() - 1;
      subtree[parent].first = (std::min)(subtree[parent].first, subtree[k].first);
      subtree[parent].values += subtree[k].values;
    }
    for(std::size_t k = count; k > 0;) {
      const Branch& s = subtree[--k];
      if(s.values <= total / 16 && s.values >= total / 256) {
        m_branches.push_back(s);
        k = s.first;
      } else
        m_top.push_back(k);
    }
    std::reverse(m_top.begin(), m_top.end());
    Index slot = m_order.size();
    for(Branch& branch : m_branches) {
      branch.slot = slot;
      detach(branch);
      slot += branch.ancestors.size();
    }
    m_workspace = std::make_unique<Panel>(slot);
  }

  // Ancestors' rows are those of the branch's root; the branch refers to its own copies of them.
  void detach(Branch& branch)
  {
    const std::size_t root = branch.last - 1;
    branch.ancestors.assign(m_rows.begin() + m_row_start[root], m_rows.begin() + m_row_start[root + 1]);
    for(std::size_t p = m_row_start[branch.first]; p < m_row_start[branch.last]; ++p)
      if(m_rows[p] >= m_first[branch.last]) {
        const auto found = std::lower_bound(branch.ancestors.begin(), branch.ancestors.end(), m_rows[p]);
        m_rows[p] = static_cast<int>(branch.slot + (found - branch.ancestors.begin()));
      }
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
      factorisation_failed(cholmod.status());
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
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> block(to, height,
                                                                                               width);
      block = Eigen::Map<const Eigen::MatrixXd>(values + value_start[k], height, width);
      block.diagonal() = block.diagonal().cwiseInverse().eval();
    }
  }
#else
  void from_eigen(const Sparse_matrix& A)
  {
    m_order = postordered_minimum_degree(A);
    const Eigen::SimplicialLLT<Sparse_matrix, Eigen::Lower, Eigen::NaturalOrdering<int>> llt(
        permuted(A, m_order));
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
          to[std::size_t(local[it.row()]) * g.width + t] =
              it.row() == it.col() ? 1. / it.value() : it.value();
    }
  }
#endif

  std::vector<int> m_order;
  std::vector<int> m_first = {0};             // first column of each supernode, and n
  std::vector<std::size_t> m_row_start = {0}; // into m_rows
  std::vector<int> m_rows;
  std::vector<std::size_t> m_value_start; // into m_values
  std::vector<double> m_values;
  std::vector<Branch> m_branches;
  std::vector<std::size_t> m_top;     // supernodes outside of the branches
  std::unique_ptr<Panel> m_workspace; // n rows and the branches' copies
};

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SUPERNODAL_FACTOR_H
