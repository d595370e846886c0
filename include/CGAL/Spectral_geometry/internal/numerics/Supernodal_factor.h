// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_SUPERNODAL_FACTOR_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_SUPERNODAL_FACTOR_H

#include <CGAL/Spectral_geometry/internal/numerics/Panel_kernels.h>
#include <CGAL/Spectral_geometry/internal/numerics/for_each_task.h>

#include <CGAL/assertions.h>

#include <Eigen/OrderingMethods>

#include <atomic>
#include <new>

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

// The number of entries of each column of the Cholesky factor, including the diagonal. Row k of the
// factor has an entry in each column on the paths up the tree from the entries of row k of A.
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

/// A set of neighbouring supernodes on which no other supernodes depend but their ancestors.
struct Branch
{
  std::size_t first, last;    // supernodes first .. last - 1
  Index slot;                 // of the workspace, where it keeps its share of the ancestors' rows
  std::vector<int> ancestors; // these rows
  std::size_t values = 0;
};

/// A pivot was not positive.
struct Not_positive_definite : std::runtime_error
{
  Not_positive_definite()
    : std::runtime_error(
          "Eigenpairs: the factorisation of the shifted Laplacian failed; look for needle faces or "
          "coordinates of very different magnitude in the mesh.")
  {}
};

/// The factorisation P A P^T = L S L^T of a symmetric matrix. A is compressed, and only its lower
/// triangle is read. S holds the signs of the pivots; it is the identity if A is positive definite.
///
/// Supernodes are eliminated one by one, children first. Each passes its update of the remaining
/// matrix to its parent (the multifrontal method: Duff and Reid 1983, Liu 1992). The factorisation
/// and the solves consist of products with panels of eight columns. On a mesh of 50,000 vertices
/// CHOLMOD takes 3.5 times as long for the numerical factorisation with the reference BLAS, and
/// three times as long to solve for a vector. Branches of the elimination tree, each at least a
/// 256th of the factor, are processed in parallel. In the solves each branch has its own copy of
/// the ancestors' rows. The copies are added in a fixed order: results do not depend on the number
/// of threads.
class Supernodal_factor
{
public:
  /// The permitted signs of pivots. There is no pivoting: with pivots of either sign the caller
  /// must check the residual of a solve.
  enum class Pivots { positive, of_either_sign };

  /// Throws `Not_positive_definite` where a pivot is not positive, std::runtime_error where there
  /// is too little memory.
  explicit Supernodal_factor(const Sparse_matrix& A, int threads = 1,
                             Pivots pivots = Pivots::positive)
    : m_pivots(pivots)
  {
    CGAL_precondition(A.isCompressed());
    try {
      analyse(A);
      find_branches();
    } catch(const std::bad_alloc&) {
      throw_lack_of_memory();
    }
    factorise(A, threads);
  }

  /// Another matrix with entries in the same places.
  void factorise(const Sparse_matrix& A, int threads)
  {
    CGAL_precondition(A.isCompressed() && A.nonZeros() == Index(m_position.size()));
    const Index size = static_cast<Index>(m_value_start.back());
    for_each_range(size, 1 << 16, threads, [&](Index first, Index end) {
      std::fill(m_values.get() + first, m_values.get() + end, 0.);
    });
    for(std::size_t p = 0; p < m_position.size(); ++p)
      if(m_position[p] >= 0)
        m_values[m_position[p]] += A.valuePtr()[p];
    m_ok = true;
    m_negative.clear();
    try {
      std::vector<double> signs(m_order.size(), 1.); // of the pivots
      std::vector<std::vector<double>> updates(m_children.size());
      for_each_task(static_cast<Index>(m_branches.size()), threads, [&](Index b) {
        for(std::size_t k = m_branches[b].first; k < m_branches[b].last; ++k)
          eliminate(k, updates, signs.data() + m_first[k], 1);
      });
      for(const std::size_t k : m_top)
        eliminate(k, updates, signs.data() + m_first[k], threads);
      for(std::size_t i = 0; i < signs.size(); ++i)
        if(signs[i] < 0.)
          m_negative.push_back(static_cast<int>(i));
    } catch(const std::bad_alloc&) {
      throw_lack_of_memory();
    }
    if(!m_ok && m_pivots == Pivots::positive)
      throw Not_positive_definite();
  }

  /// The number of negative eigenvalues of A (Sylvester's law of inertia), or -1 when a pivot
  /// vanished.
  Index number_of_negative_pivots() const
  {
    return m_ok ? static_cast<Index>(m_negative.size()) : -1;
  }

  /// The row of A that is row i of the factor and of panels.
  const std::vector<int>& order() const { return m_order; }

  /// x = A^-1 b, in the order of the factor; b may be x.
  void solve(const Panel& b, Panel& x, int threads)
  {
    if(m_workspace.size() < std::size_t(m_slots * panel_width))
      m_workspace.assign(m_slots * panel_width, 0.);
    double* const w = m_workspace.data();
    solve_in_workspace<panel_width>(
        w, threads, forward, backward,
        [&](Index first, Index last) {
          std::copy(b.row(first), b.row(last), w + first * panel_width);
        },
        [&](Index first, Index last) {
          std::copy(w + first * panel_width, w + last * panel_width, x.row(first));
        });
  }

  /// Solves for one vector, in the order of A.
  Eigen::VectorXd solve(const Eigen::VectorXd& b, int threads)
  {
    if(m_workspace.size() < std::size_t(m_slots))
      m_workspace.assign(m_slots, 0.);
    double* const w = m_workspace.data();
    Eigen::VectorXd x(b.size());
    solve_in_workspace<1>(
        w, threads, forward_vector, backward_vector,
        [&](Index first, Index last) {
          for(Index i = first; i < last; ++i)
            w[i] = b[m_order[i]];
        },
        [&](Index first, Index last) {
          for(Index i = first; i < last; ++i)
            x[m_order[i]] = w[i];
        });
    return x;
  }

private:
  [[noreturn]] static void throw_lack_of_memory()
  {
    throw std::runtime_error(
        "Eigenpairs: there is not enough memory for the factor of the shifted Laplacian; "
        "simplify the mesh before.");
  }

  std::size_t width(std::size_t k) const { return m_first[k + 1] - m_first[k]; }
  std::size_t below(std::size_t k) const { return m_row_start[k + 1] - m_row_start[k]; }
  static std::size_t padded(std::size_t n)
  {
    return (n + panel_width - 1) / panel_width * panel_width;
  }

  // --- the structure ---

  void analyse(const Sparse_matrix& A)
  {
    const Sparse_matrix symmetric = A.selfadjointView<Eigen::Lower>();
    m_order = postordered_minimum_degree(symmetric);
    const Sparse_matrix B = permuted(symmetric, m_order);
    const std::vector<Column_group> groups = group_columns(B);
    std::vector<int> group_of(B.cols()), taken_by(B.cols(), -1);
    for(std::size_t g = 0; g < groups.size(); ++g)
      std::fill_n(group_of.begin() + groups[g].first, groups[g].width, static_cast<int>(g));
    m_children.resize(groups.size());
    for(int g = 0; g < static_cast<int>(groups.size()); ++g) {
      const int last = groups[g].first + groups[g].width;
      const std::size_t start = m_rows.size();
      const auto take = [&](int row) {
        if(row >= last && taken_by[row] != g) {
          taken_by[row] = g;
          m_rows.push_back(row);
        }
      };
      for(int j = groups[g].first; j < last; ++j)
        for(Sparse_matrix::InnerIterator it(B, j); it; ++it)
          take(static_cast<int>(it.row()));
      for(const int c : m_children[g])
        for(std::size_t p = m_row_start[c]; p < m_row_start[c + 1]; ++p)
          take(m_rows[p]);
      std::sort(m_rows.begin() + start, m_rows.end());
      if(m_rows.size() > start)
        m_children[group_of[m_rows[start]]].push_back(g);
      m_first.push_back(last);
      m_row_start.push_back(m_rows.size());
      m_value_start.push_back(m_value_start.back() +
                              (groups[g].width + below(g)) * groups[g].width);
    }
    m_values.reset(new double[m_value_start.back()]);
    find_places(A, group_of);
  }

  // Finds where rows are in the block of the parent, and entries of A in that of their supernode.
  void find_places(const Sparse_matrix& A, const std::vector<int>& group_of)
  {
    const auto row_in = [&](int g, int row) {
      if(row < m_first[g + 1])
        return static_cast<std::size_t>(row - m_first[g]);
      const auto begin = m_rows.begin() + m_row_start[g], end = m_rows.begin() + m_row_start[g + 1];
      return width(g) + (std::lower_bound(begin, end, row) - begin);
    };
    m_place.resize(m_rows.size());
    for(std::size_t g = 0; g < m_children.size(); ++g)
      for(std::size_t p = m_row_start[g]; p < m_row_start[g + 1]; ++p)
        m_place[p] = static_cast<int>(row_in(group_of[m_rows[m_row_start[g]]], m_rows[p]));
    std::vector<int> number(m_order.size());
    for(std::size_t i = 0; i < m_order.size(); ++i)
      number[m_order[i]] = static_cast<int>(i);
    m_position.assign(A.nonZeros(), -1); // as it stays for those of the upper triangle
    for(int j = 0; j < A.cols(); ++j)
      for(int p = A.outerIndexPtr()[j]; p < A.outerIndexPtr()[j + 1]; ++p) {
        const int i = A.innerIndexPtr()[p];
        if(i < j)
          continue;
        const int row = (std::max)(number[i], number[j]), column = (std::min)(number[i], number[j]),
                  g = group_of[column];
        m_position[p] = static_cast<std::ptrdiff_t>(m_value_start[g] + row_in(g, row) * width(g) +
                                                    (column - m_first[g]));
      }
  }

  // Subtrees of between 1/256 and 1/16 of the factor become branches; the rest is the top.
  void find_branches()
  {
    const std::size_t count = m_children.size(), total = m_value_start.back();
    std::vector<Branch> subtree(count);
    for(std::size_t k = 0; k < count; ++k) {
      subtree[k] = {k, k + 1, 0, {}, m_value_start[k + 1] - m_value_start[k]};
      for(const int c : m_children[k]) {
        subtree[k].first = (std::min)(subtree[k].first, subtree[c].first);
        subtree[k].values += subtree[c].values;
      }
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
    m_slots = m_order.size();
    for(Branch& branch : m_branches) {
      branch.slot = m_slots;
      detach(branch);
      m_slots += branch.ancestors.size();
    }
  }

  // Ancestors' rows are those of the branch's root; the branch refers to its own copies of them.
  void detach(Branch& branch)
  {
    const std::size_t root = branch.last - 1;
    branch.ancestors.assign(m_rows.begin() + m_row_start[root],
                            m_rows.begin() + m_row_start[root + 1]);
    for(std::size_t p = m_row_start[branch.first]; p < m_row_start[branch.last]; ++p)
      if(m_rows[p] >= m_first[branch.last]) {
        const auto found =
            std::lower_bound(branch.ancestors.begin(), branch.ancestors.end(), m_rows[p]);
        m_rows[p] = static_cast<int>(branch.slot + (found - branch.ancestors.begin()));
      }
  }

  // --- the numbers ---

  // Eliminates supernode k. Its block F, (width + below) x width by rows, becomes L; U, below x
  // below, is the update for its parent. `signs` receives the signs of its pivots and is 1 before.
  void eliminate(std::size_t k, std::vector<std::vector<double>>& updates, double* signs,
                 int threads)
  {
    double* const F = m_values.get() + m_value_start[k];
    const std::size_t w = width(k), b = below(k), stride = padded(b);
    std::vector<double>& U = updates[k];
    U.assign(b * stride, 0.);
    for(const int c : m_children[k]) {
      add_update(c, updates[c], F, w, U.data(), stride);
      std::vector<double>().swap(updates[c]); // its memory, too
    }
    factorise_block(F, w, w + b, signs);
    const double* const below_F = F + w * w;
    const bool large = double(w) * b * b > 1e6; // a millisecond: worth starting a thread
    for_each_task(static_cast<Index>(stride / panel_width), large ? threads : 1, [&](Index panel) {
      const std::size_t j = panel * panel_width;
      std::vector<double> T(w * panel_width);
      pack(below_F + j * w, w, w, static_cast<int>((std::min)(b - j, std::size_t(panel_width))),
           signs, T.data());
      multiply_block(U.data() + j * stride + j, stride, panel_width, below_F + j * w, w, T.data(),
                     w, b - j, true);
    });
    for(std::size_t j = 0; j < w; ++j)
      F[j * w + j] = 1. / F[j * w + j]; // which the solves multiply by
  }

  // Adds the lower triangle of the update from child c to F and U.
  void add_update(int c, const std::vector<double>& update, double* F, std::size_t w, double* U,
                  std::size_t stride) const
  {
    const std::size_t count = below(c);
    const int* place = m_place.data() + m_row_start[c];
    const std::size_t in_F = std::lower_bound(place, place + count, static_cast<int>(w)) - place;
    for(std::size_t i = 0; i < count; ++i) {
      const double* from = update.data() + i * padded(count);
      double* to = F + place[i] * w;
      for(std::size_t j = 0; j < (std::min)(in_F, i + 1); ++j)
        to[place[j]] += from[j];
      if(i < in_F)
        continue;
      to = U + (place[i] - w) * stride;
      for(std::size_t j = in_F; j <= i; ++j)
        to[place[j] - w] += from[j];
    }
  }

  // F = L S L^T in its first w rows, and F := F L^-T S in those below; eight columns at a time.
  void factorise_block(double* F, std::size_t w, std::size_t rows, double* signs)
  {
    std::vector<double> T(padded(w) * panel_width);
    for(std::size_t f = 0; f < w; f += panel_width) {
      const int columns = static_cast<int>((std::min)(w - f, std::size_t(panel_width)));
      if(f > 0) {
        pack(F + f * w, w, f, columns, signs, T.data());
        multiply_block(F + f * w + f, w, columns, F + f * w, w, T.data(), f, rows - f, true);
      }
      factorise_square(F + f * w + f, w, columns, signs + f);
      invert_square(F + f * w + f, w, columns, signs + f, T.data());
      double* const under = F + (f + columns) * w + f;
      multiply_block(under, w, columns, under, w, T.data(), columns, rows - f - columns, false);
    }
  }

  void factorise_square(double* D, std::size_t stride, int size, double* signs)
  {
    for(int j = 0; j < size; ++j) {
      for(int i = j; i < size; ++i)
        for(int t = 0; t < j; ++t)
          D[i * stride + j] -= D[i * stride + t] * signs[t] * D[j * stride + t];
      double pivot = D[j * stride + j];
      if(!(m_pivots == Pivots::positive ? pivot > 0. : pivot != 0.) || !std::isfinite(pivot)) {
        m_ok = false;
        pivot = 1.;
      }
      if(pivot < 0.)
        signs[j] = -1.;
      const double root = std::sqrt(std::abs(pivot));
      D[j * stride + j] = root;
      for(int i = j + 1; i < size; ++i)
        D[i * stride + j] *= signs[j] / root;
    }
  }

  // T = D^-T S
  static void invert_square(const double* D, std::size_t stride, int size, const double* signs,
                            double* T)
  {
    std::fill_n(T, panel_width * panel_width, 0.);
    for(int j = 0; j < size; ++j) {
      T[j * panel_width + j] = 1. / D[j * stride + j];
      for(int i = j + 1; i < size; ++i) {
        double sum = 0.;
        for(int t = j; t < i; ++t)
          sum -= D[i * stride + t] * T[j * panel_width + t];
        T[j * panel_width + i] = sum / D[i * stride + i];
      }
    }
    for(int i = 0; i < size; ++i)
      for(int c = 0; c < size; ++c)
        T[i * panel_width + c] *= signs[c];
  }

  // T = S A^T, `count` rows of eight; A has `columns` rows.
  static void pack(const double* A, std::size_t stride, std::size_t count, int columns,
                   const double* signs, double* T)
  {
    for(std::size_t t = 0; t < count; ++t, T += panel_width) {
      for(int c = 0; c < columns; ++c)
        T[c] = signs[t] * A[c * stride + t];
      std::fill(T + columns, T + panel_width, 0.);
    }
  }

  // --- the solves ---

  using Row = Eigen::Map<const Eigen::VectorXd>;

  static Row row(const Supernode& s, int i, int size)
  {
    return Row(s.L + std::ptrdiff_t(i) * s.width, size);
  }

  static void forward_vector(const Supernode& s, double* w)
  {
    Eigen::Map<Eigen::VectorXd> own(w + s.first, s.width);
    for(int k = 0; k < s.width; ++k)
      own[k] = (own[k] - row(s, k, k).dot(own.head(k))) * row(s, k, s.width)[k];
    for(int i = 0; i < s.below; ++i)
      w[s.rows[i]] -= row(s, s.width + i, s.width).dot(own);
  }

  static void backward_vector(const Supernode& s, double* w)
  {
    Eigen::Map<Eigen::VectorXd> own(w + s.first, s.width);
    for(int i = 0; i < s.below; ++i)
      own -= w[s.rows[i]] * row(s, s.width + i, s.width);
    for(int k = s.width - 1; k >= 0; --k) {
      own[k] *= row(s, k, s.width)[k];
      own.head(k) -= own[k] * row(s, k, k);
    }
  }

  // w = L^-T S L^-1 w, by `forward` and `backward`, the steps of one supernode. `read` and `write`
  // copy rows first .. last - 1 into and out of the workspace; those of a branch are copied by the
  // thread that works on it.
  template <int columns, class Forward, class Backward, class Read, class Write>
  void solve_in_workspace(double* w, int threads, const Forward& forward, const Backward& backward,
                          const Read& read, const Write& write) const
  {
    const Index branches = static_cast<Index>(m_branches.size());
    for(const std::size_t k : m_top)
      read(m_first[k], m_first[k + 1]);
    for_each_task(branches, threads, [&](Index b) {
      const Branch& branch = m_branches[b];
      read(m_first[branch.first], m_first[branch.last]);
      std::fill_n(w + branch.slot * columns, branch.ancestors.size() * columns, 0.);
      for(std::size_t k = branch.first; k < branch.last; ++k)
        forward(supernode(k), w);
    });
    for(const Branch& branch : m_branches) {
      const double* from = w + branch.slot * columns;
      for(const int row : branch.ancestors)
        for(int c = 0; c < columns; ++c)
          w[Index(row) * columns + c] += *from++;
    }
    for(const std::size_t k : m_top)
      forward(supernode(k), w);
    for(const int row : m_negative)
      for(int c = 0; c < columns; ++c)
        w[Index(row) * columns + c] *= -1.;
    for(std::size_t k = m_top.size(); k-- > 0;)
      backward(supernode(m_top[k]), w);
    for_each_task(branches, threads, [&](Index b) {
      const Branch& branch = m_branches[b];
      double* to = w + branch.slot * columns;
      for(const int row : branch.ancestors)
        to = std::copy_n(w + Index(row) * columns, columns, to);
      for(std::size_t k = branch.last; k-- > branch.first;)
        backward(supernode(k), w);
      write(m_first[branch.first], m_first[branch.last]);
    });
    for(const std::size_t k : m_top)
      write(m_first[k], m_first[k + 1]);
  }

  Supernode supernode(std::size_t k) const
  {
    return {m_values.get() + m_value_start[k], m_rows.data() + m_row_start[k], m_first[k],
            static_cast<int>(width(k)), static_cast<int>(below(k))};
  }

  Pivots m_pivots;
  std::atomic<bool> m_ok{true};
  std::vector<int> m_negative; // the pivots that are
  std::vector<int> m_order;
  std::vector<int> m_first = {0};             // first column of each supernode, and n
  std::vector<std::vector<int>> m_children;   // of each supernode
  std::vector<std::size_t> m_row_start = {0}; // into m_rows
  std::vector<int> m_rows,
      m_place; // below the columns, and where each is in the block of the parent
  std::vector<std::size_t> m_value_start = {0}; // into m_values
  std::unique_ptr<double[]> m_values;           // first touched by the threads that set them to 0
  std::vector<std::ptrdiff_t> m_position;       // in m_values, of each entry of A
  std::vector<Branch> m_branches;
  std::vector<std::size_t> m_top; // supernodes outside of the branches
  std::size_t m_slots = 0;        // n rows and the branches' copies
  Aligned_buffer m_workspace;
};

/// The number of negative eigenvalues of a symmetric matrix, or -1 when a pivot vanishes.
inline Index number_of_negative_eigenvalues(const Sparse_matrix& A, int threads = 1)
{
  return Supernodal_factor(A, threads, Supernodal_factor::Pivots::of_either_sign)
      .number_of_negative_pivots();
}

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_NUMERICS_SUPERNODAL_FACTOR_H
