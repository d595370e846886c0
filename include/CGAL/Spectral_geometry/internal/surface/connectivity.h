// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_CONNECTIVITY_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_CONNECTIVITY_H

#include <CGAL/Spectral_geometry/internal/basics.h>

#include <boost/pending/disjoint_sets.hpp>
#include <boost/range/iterator_range_core.hpp>

#include <numeric>

namespace CGAL::Spectral_geometry::internal {

/// For each of n vertices the number of its component, from 0 in the order of their first vertices.
/// `for_each_edge` calls its argument with the ends of each edge.
template <class For_each_edge>
std::vector<Eigen::Index> connected_components(const Eigen::Index n,
                                               const For_each_edge& for_each_edge)
{
  boost::disjoint_sets_with_storage<> sets(static_cast<std::size_t>(n));
  for_each_edge([&](const Eigen::Index i, const Eigen::Index j) {
    sets.union_set(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  });
  std::vector<Eigen::Index> of_root(static_cast<std::size_t>(n), -1), result;
  Eigen::Index components = 0;
  for(std::size_t v = 0; v < of_root.size(); ++v) {
    Eigen::Index& c = of_root[sets.find_set(v)];
    if(c == -1)
      c = components++;
    result.push_back(c);
  }
  return result;
}

/// Here triangles (m x 3) join vertices.
inline std::vector<Eigen::Index> connected_components(const Eigen::Index n,
                                                      const Eigen::MatrixXi& T)
{
  return connected_components(n, [&](const auto& join) {
    for(Eigen::Index f = 0; f < T.rows(); ++f)
      for(int c = 1; c < 3; ++c)
        join(T(f, 0), T(f, c));
  });
}

/// Sorts items by the vertex, 0 to n - 1, that they belong to, and by `<` within a vertex: linear
/// if each vertex has few items. `for_each` is called twice and calls its argument with vertex and
/// item of each.
template <class Item, class For_each>
std::vector<Item> sorted_by_vertex(const std::size_t n, const For_each& for_each)
{
  std::vector<std::size_t> last(n + 1, 0);
  for_each([&](const std::size_t v, const Item&) { ++last[v + 1]; });
  std::partial_sum(last.begin(), last.end(), last.begin());
  std::vector<Item> result(last[n]);
  for_each([&](const std::size_t v, const Item& item) { result[last[v]++] = item; });
  for(std::size_t v = 0, first = 0; v < n; first = last[v++])
    std::sort(result.begin() + std::ptrdiff_t(first), result.begin() + std::ptrdiff_t(last[v]));
  return result;
}

/// The edges of one face, sorted, each with its smaller vertex first.
inline std::vector<std::pair<int, int>> boundary_edges(const Eigen::MatrixXi& T)
{
  using Edge = std::pair<int, int>;
  const std::size_t n = T.size() == 0 ? 0 : std::size_t(T.maxCoeff()) + 1;
  const std::vector<Edge> edges = sorted_by_vertex<Edge>(n, [&](const auto& add) {
    for(Eigen::Index f = 0; f < T.rows(); ++f)
      for(int k = 0; k < 3; ++k) {
        const Edge edge = std::minmax({T(f, k), T(f, (k + 1) % 3)});
        add(std::size_t(edge.first), edge);
      }
  });
  std::vector<Edge> result;
  for(std::size_t i = 0; i < edges.size(); ++i)
    if((i == 0 || edges[i - 1] != edges[i]) && (i + 1 == edges.size() || edges[i + 1] != edges[i]))
      result.push_back(edges[i]);
  return result;
}

/// One flag for each of n vertices: whether it is an end of such an edge.
inline std::vector<char> border_vertices(const Eigen::MatrixXi& T, const Eigen::Index n)
{
  std::vector<char> result(std::size_t(n), 0);
  for(const auto& [i, j] : boundary_edges(T))
    result[i] = result[j] = 1;
  return result;
}

/// A face at each of n vertices, or -1.
inline std::vector<Eigen::Index> faces_at_vertices(const Eigen::MatrixXi& T, const Eigen::Index n)
{
  std::vector<Eigen::Index> result(std::size_t(n), -1);
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    for(int k = 0; k < 3; ++k)
      result[T(f, k)] = f;
  return result;
}

/// For each of n vertices what lies around it, sorted and each once: other vertices, or faces.
class Vertex_rings
{
public:
  static Vertex_rings of_vertices(const Eigen::MatrixXi& T, const Eigen::Index n)
  {
    return Vertex_rings(T, n, n, {1, 2},
                        [&](const Eigen::Index f, const int k) { return T(f, k); });
  }

  static Vertex_rings of_faces(const Eigen::MatrixXi& T, const Eigen::Index n)
  {
    return Vertex_rings(T, n, T.rows(), {0}, [](const Eigen::Index f, int) { return int(f); });
  }

  boost::iterator_range<const int*> operator[](const int v) const
  {
    const int* const start = m_items.outerIndexPtr() + v;
    return {m_items.innerIndexPtr() + start[0], m_items.innerIndexPtr() + start[1]};
  }

  /// The vertices around v, ring by ring, until there are at least `wanted`; v comes first. A hub
  /// adds only some neighbours, evenly chosen: a fan would give all of its vertices to each. `seen`
  /// must be zero everywhere, and is zero again afterwards.
  std::vector<int> around(const int v, const std::size_t wanted, std::vector<char>& seen) const
  {
    constexpr std::size_t most_of_a_hub = 64;
    std::vector<int> result = {v};
    seen[v] = 1;
    for(std::size_t first = 0; first < result.size() && result.size() < wanted;) {
      const std::size_t last = result.size();
      for(; first < last; ++first) {
        const auto ring = (*this)[result[first]];
        const std::size_t n = ring.size(),
                          step = first == 0 ? 1 : (n + most_of_a_hub - 1) / most_of_a_hub;
        for(std::size_t i = 0; i < n; i += step)
          if(const int w = ring.begin()[i]; !seen[w]) {
            seen[w] = 1;
            result.push_back(w);
          }
      }
    }
    for(const int w : result)
      seen[w] = 0;
    return result;
  }

private:
  // A corner k of a face has `item(face, corner k + step)` around it for each of the steps.
  template <class Item>
  Vertex_rings(const Eigen::MatrixXi& T, const Eigen::Index n, const Eigen::Index items,
               const std::initializer_list<int> steps, const Item& item)
    : m_items(items, n)
  {
    std::vector<Eigen::Triplet<double>> entries;
    for(Eigen::Index f = 0; f < T.rows(); ++f)
      for(int k = 0; k < 3; ++k)
        for(const int step : steps)
          entries.emplace_back(item(f, (k + step) % 3), T(f, k), 1.);
    m_items.setFromTriplets(entries.begin(), entries.end());
  }

  Eigen::SparseMatrix<double> m_items; // a column for each vertex, of which the pattern counts
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_CONNECTIVITY_H
