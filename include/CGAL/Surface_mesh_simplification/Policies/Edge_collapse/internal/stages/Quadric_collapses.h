// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_QUADRIC_COLLAPSES_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_QUADRIC_COLLAPSES_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>

#include <CGAL/Spectral_geometry/internal/separate_compilation.h>

namespace CGAL::Surface_mesh_simplification::internal {

/// An oriented 2-manifold of triangles, with or without border, in arrays. Corner 3 f + i is the
/// i-th of face f; the halfedge of a corner leads from its vertex to that of the next corner of its
/// face.
struct Triangle_arrays
{
  struct Corner
  {
    int vertex;
    int opposite;   ///< the corner whose halfedge leads back, -1 on the border
    int halfedge;   ///< that leads from here now, by its corner of the input
    int state = -2; ///< of the halfedge in a run: what is read together lies together
  };

  Eigen::MatrixXd V; ///< n x 3, finite
  std::vector<Corner> corners;
  bool single_precision = false; ///< whether the mesh holds positions as `float`
  std::vector<char> fixed;       ///< a flag for each vertex that stays where it is, or nothing
  bool border_is_apart = false;  ///< whether a vertex of the border stays on it, with its values
  bool binary = false;           ///< whether a merged vertex has the values of one of both ends
};

inline int next_corner(const int c)
{
  return c % 3 == 2 ? c - 2 : c + 1;
}
inline int previous_corner(const int c)
{
  return c % 3 == 0 ? c + 2 : c - 1;
}

/// What `quadric_collapses()` has done.
struct Quadric_collapses
{
  Collapse_log log;
  /// for each merge the halfedge that leads to the vertex that is kept, or ~ of the one back
  std::vector<int> collapsed;
  /// for each remaining vertex the input vertex at its position, or ~ of the merge that moved it
  std::vector<int> place;
  std::vector<Triangle_arrays::Corner> corners; ///< at the end; -1 as vertex if the face is gone
};

/*!
 * Collapses edges by quadrics alone until `target` vertices are left, or until no edge is left that
 * may be collapsed.
 *
 * The cost of an edge is the minimum of the sum of the quadrics at its ends, those of the shape
 * term (`Spectral_shape_term`). The merged vertex is placed at the minimiser (M. Garland and P.
 * Heckbert, *Surface Simplification Using Quadric Error Metrics*, SIGGRAPH 1997). Quadrics only
 * grow, so a cost computed before the ends changed is a lower bound. The queue holds each edge
 * once, and its cost is recomputed when it comes up. The order is the same (to single precision) as
 * if all were recomputed.
 *
 * See `quadric_edge_collapse()` for what is preserved of the mesh. A needle is a face whose height
 * is below a thousandth of its longest side. Edges without length come first, edges between
 * vertices of many neighbours last. O(n log n), deterministic.
 *
 * @param keep_free_of_self_intersections whether no face may go through another in the end, see
 *        `Spectral_crossing_guard`
 * @param progress is called with the number of vertices left, each time a hundredth of the
 *        collapses is done and before refused edges are looked at again; what it throws comes
 *        through
 * @return the collapses; a fixed vertex keeps its slot, its position and its values
 */
CGAL_SPECTRAL_GEOMETRY_INLINE Quadric_collapses
quadric_collapses(Triangle_arrays mesh, bool keep_free_of_self_intersections, std::size_t target,
                  const std::function<void(std::size_t)>& progress);

} // namespace CGAL::Surface_mesh_simplification::internal

#if !defined(CGAL_SPECTRAL_GEOMETRY_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_LOOP)

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Fine_vertex_slots.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_crossing_guard.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/cost/Spectral_shape_term.h>

#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>

#include <cstring>
#include <numeric>
#include <queue>

#ifdef __GNUC__
#define CGAL_SPECTRAL_PREFETCH(address) __builtin_prefetch(address)
#else
#define CGAL_SPECTRAL_PREFETCH(address)
#endif

namespace CGAL::Surface_mesh_simplification::internal {

/// The offset to subtract from positions (the rows of V, at least one). Along an axis on which the
/// mesh lies at least eight times as far from the origin as it is long, it is the coordinate of a
/// point of the mesh: quadrics would otherwise lose what they tell apart. On other axes it is 0. No
/// point changes by being moved there and back: such differences of doubles are exact.
inline Eigen::Vector3d offset_of(const Eigen::MatrixXd& V)
{
  Eigen::Vector3d offset = V.row(0);
  for(int axis = 0; axis < 3; ++axis)
    if(!(V.col(axis).cwiseAbs().minCoeff() >=
         8 * (V.col(axis).maxCoeff() - V.col(axis).minCoeff())))
      offset[axis] = 0;
  return offset;
}

/// A queue of halfedges, least cost first. Entries are kept in buckets by the leading bits of their
/// cost. The first bucket is sorted when its turn comes; a heap holds what is added to it then. So
/// the next entries are known, and their memory can be prefetched. A run from a million vertices
/// takes 0.59 times as long as with a single heap, 0.83 times without prefetching.
class Halfedge_queue
{
public:
  struct Entry
  {
    float cost; // in single precision, to keep the queue small
    int halfedge;

    friend bool operator<(const Entry& a, const Entry& b) // the largest is that of least cost
    {
      return std::tie(b.cost, b.halfedge) < std::tie(a.cost, a.halfedge);
    }
  };

  bool empty() const { return m_size == 0; }

  const Entry& top()
  {
    if(m_sorted.empty() && m_added.empty()) {
      while(m_buckets[m_first].empty())
        ++m_first;
      m_sorted = std::exchange(m_buckets[m_first], {});
      std::sort(m_sorted.begin(), m_sorted.end());
    }
    return added_is_next() ? m_added.top() : m_sorted.back();
  }

  /// The halfedge that comes after so many others, those added lately aside, or -1.
  int ahead(const std::size_t count) const
  {
    return count < m_sorted.size() ? m_sorted[m_sorted.size() - 1 - count].halfedge : -1;
  }

  void push(const Entry& entry)
  {
    const std::size_t b = bucket_of(entry.cost);
    ++m_size;
    if(b > m_first)
      m_buckets[b].push_back(entry);
    else
      m_added.push(entry);
  }

  /// Removes what top() has returned.
  void pop()
  {
    --m_size;
    if(added_is_next())
      m_added.pop();
    else
      m_sorted.pop_back();
  }

private:
  bool added_is_next() const
  {
    return m_sorted.empty() || (!m_added.empty() && m_sorted.back() < m_added.top());
  }

  // Nonnegative numbers are ordered like their bits. A bucket is the exponent and six more bits.
  static std::size_t bucket_of(const float cost)
  {
    if(cost < 0)
      return 0;
    std::uint32_t bits;
    std::memcpy(&bits, &cost, sizeof bits);
    return 1 + ((bits & 0x7fffffff) >> 17);
  }

  using Buckets = std::vector<std::vector<Entry>>;

  Buckets m_buckets = Buckets(2 + (0x7fffffff >> 17));
  std::size_t m_first = 0, m_size = 0;
  std::vector<Entry> m_sorted; // of the buckets up to m_first; m_added has what came later
  std::priority_queue<Entry> m_added;
};

/// The run of `quadric_collapses()`. Halfedge c leads from the vertex of corner c to that of the
/// next corner of its face.
class Quadric_collapser
{
public:
  /// `watched`: a flag for each vertex around which no triangle may go through another; empty:
  /// none.
  Quadric_collapser(Triangle_arrays mesh, std::vector<char> watched)
    : m_origin(offset_of(mesh.V))
    , m_cost_scale(std::pow((mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff()).norm(), -4))
    , m_log(mesh.V.rows())
    , m_mesh(std::move(mesh))
    , m_watched(std::move(watched))
  {
    const std::size_t n = m_log.number_of_vertices();
    m_mesh.fixed.resize(n, false);
    m_points.resize(n);
    for(std::size_t v = 0; v < n; ++v)
      m_points[v] = m_mesh.V.row(Eigen::Index(v)).transpose() - m_origin;
    m_mesh.V.resize(0, 3);
    m_quadrics.resize(n);
    m_vertices.resize(n);
    m_place.resize(n);
    std::iota(m_place.begin(), m_place.end(), 0);
    for(int c = 0; c < number_of_corners(); ++c)
      add_corner(c);
    if(!m_watched.empty())
      m_crossing.set_geometry(m_points, Watched_fans{*this});
  }

  void run(const std::size_t target, const std::function<void(std::size_t)>& progress)
  {
    for(int c = 0; c < number_of_corners(); ++c)
      if(opposite(c) < c)
        push(c);
    const std::size_t n = m_log.number_of_vertices(), most = n - (std::min)(n, target);
    m_log.reserve(most);
    m_collapsed.reserve(most);
    const std::size_t step = (std::max)(most / 100, std::size_t(1));
    std::size_t reported = n, before = n;
    while(m_log.number_of_vertices_left() > target) {
      if(m_queue.empty()) { // once more for those that were refused, while that leads on
        const bool stuck = m_log.number_of_vertices_left() == before;
        if(stuck && m_largest_degree == unlimited)
          return;
        before = m_log.number_of_vertices_left();
        progress(before);
        m_largest_degree = stuck ? unlimited : (std::min)(4 * m_largest_degree, unlimited);
        for(const int c : std::exchange(m_refused, {}))
          if(source(c) != removed && state(c) == refused)
            push(c);
        continue;
      }
      const Entry entry = m_queue.top();
      m_queue.pop();
      prefetch_next();
      handle(entry);
      if(const std::size_t left = m_log.number_of_vertices_left(); left + step <= reported)
        progress(reported = left);
    }
  }

  Quadric_collapses take_result()
  {
    return {std::move(m_log), std::move(m_collapsed), std::move(m_place),
            std::move(m_mesh.corners)};
  }

  /// Flags the input vertices that were merged into vertices of intersecting faces or their
  /// neighbours. Returns whether one that is now in such a face was not watched by this run.
  bool watch_intersections(std::vector<char>& watched) const
  {
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> V(
        m_points.front().data(), Eigen::Index(m_points.size()), 3);
    Eigen::MatrixXi T(number_of_corners() / 3, 3);
    Eigen::Index faces = 0;
    for(int c = 0; c < number_of_corners(); c += 3)
      if(source(c) != removed)
        T.row(faces++) << source(c), source(c + 1), source(c + 2);
    T.conservativeResize(faces, 3);
    enum : char { apart, beside, of_face };
    std::vector<char> place(m_points.size(), apart);
    for(const auto& [f, g] : Spectral_geometry::internal::self_intersecting_faces(V, T))
      for(const Eigen::Index face : {f, g})
        for(const int v : T.row(face)) {
          place[v] = of_face;
          for_neighbours(v, [&](const int w) { place[w] = (std::max)(place[w], char(beside)); });
        }
    const auto& merges = m_log.forest().merges();
    for(auto m = merges.rbegin(); m != merges.rend(); ++m)
      place[m->removed] = place[m->kept];
    watched.resize(place.size(), false);
    bool result = false;
    for(std::size_t v = 0; v < place.size(); ++v) {
      result = result || (place[v] == of_face && !watched[v]);
      watched[v] = watched[v] || place[v] != apart;
    }
    return result;
  }

  /// Calls visit(a, b) for each triangle (v, a, b), as `Spectral_crossing_guard` asks for.
  template <class Visit>
  void for_triangles(const int v, const Visit& visit) const
  {
    for_outgoing(v, [&](const int c) { visit(target(c), source(previous_corner(c))); });
  }

  /// Calls visit(w) for each neighbour of v.
  template <class Visit>
  void for_neighbours(const int v, const Visit& visit) const
  {
    for_outgoing(v, [&](const int c) {
      visit(target(c));
      if(is_border(previous_corner(c)))
        visit(source(previous_corner(c)));
    });
  }

private:
  // The states of a halfedge: not in the queue; refused; otherwise queued, with the number of
  // collapses before its cost was computed.
  static constexpr int none = -2, refused = -1;

  using Entry = Halfedge_queue::Entry;

  struct Vertex
  {
    int degree = 0, outgoing = -1;
    int changed = 0; // the number of collapses when it last did
    int mark = 0;
  };

  // The triangles that have a watched vertex.
  struct Watched_fans
  {
    const Quadric_collapser& run;

    template <class Visit>
    void for_triangles(const int v, const Visit& visit) const
    {
      run.for_triangles(v, [&](const int a, const int b) {
        if(run.m_watched[v] || run.m_watched[a] || run.m_watched[b])
          visit(a, b);
      });
    }
    template <class Visit>
    void for_neighbours(const int v, const Visit& visit) const
    {
      run.for_neighbours(v, visit);
    }
  };

  static constexpr int removed = -1; // vertex of the corners of a face that is gone
  static constexpr int unlimited = (std::numeric_limits<int>::max)() / 8;

  int number_of_corners() const { return int(m_mesh.corners.size()); }
  int source(const int c) const { return m_mesh.corners[c].vertex; }
  int target(const int c) const { return source(next_corner(c)); }
  int opposite(const int c) const { return m_mesh.corners[c].opposite; }
  int halfedge(const int c) const { return m_mesh.corners[c].halfedge; }
  int state(const int c) const { return m_mesh.corners[c].state; }
  int& state(const int c) { return m_mesh.corners[c].state; }
  bool is_border(const int c) const { return opposite(c) < 0; }
  bool is_border_vertex(const int v) const { return is_border(m_vertices[v].outgoing); }

  // Starts with the halfedge on the border, if there is one, and turns from there.
  template <class Visit>
  void for_outgoing(const int v, const Visit& visit) const
  {
    const int first = m_vertices[v].outgoing;
    int c = first;
    do {
      const int beyond = opposite(previous_corner(c));
      visit(c);
      c = beyond;
    } while(c >= 0 && c != first);
  }

  void add_corner(const int c)
  {
    const int v = source(c);
    const Eigen::Vector3d& p = m_points[v];
    m_vertices[v].degree += is_border(c) ? 2 : 1;
    if(m_vertices[v].outgoing < 0 || is_border(c))
      m_vertices[v].outgoing = c;
    m_quadrics[v].add_corner(p, m_points[target(c)] - p, is_border(c),
                             m_points[source(previous_corner(c))] - p,
                             is_border(previous_corner(c)));
  }

  void push(const int c) { push(c, placement(c).first); }

  void push(const int c, const float cost)
  {
    state(c) = number_of_collapses();
    m_queue.push({cost, c});
  }

  int number_of_collapses() const { return int(m_log.points().size()); }

  // Least cost and where it is taken.
  std::pair<float, Eigen::Vector3d> placement(const int c) const
  {
    const int u = source(c), v = target(c);
    const Eigen::Vector3d &p = m_points[u], &q = m_points[v];
    if(p == q)
      return {-1.f, p};
    const Spectral_quadric sum = m_quadrics[u] + m_quadrics[v];
    Eigen::Vector3d x = m_mesh.fixed[u] ? p : m_mesh.fixed[v] ? q : sum.minimiser();
    if(!x.allFinite())
      x = (p + q) / 2;
    // A fixed end is exactly there: p + (q - p) rounds.
    if(m_mesh.border_is_apart && !m_mesh.fixed[u] && !m_mesh.fixed[v] &&
       (is_border_vertex(u) || is_border_vertex(v)))
      x = !is_border_vertex(v)   ? p
          : !is_border_vertex(u) ? q
                                 : Eigen::Vector3d(p + projected_edge_weight(p, q, x) * (q - p));
    x = x + m_origin;
    if(m_mesh.single_precision)
      x = x.cast<float>().cast<double>();
    x = (x - m_origin).eval(); // what the mesh will hold
    return {float((std::max)(m_cost_scale * sum(x), 0.)), x};
  }

  void handle(const Entry& entry)
  {
    const int c = entry.halfedge;
    if(source(c) == removed)
      return;
    const int computed = std::exchange(state(c), none);
    if(!is_border(c) &&
       state(opposite(c)) >= 0) // two edges have become one: its other entry stands for it
      return;
    const int u = source(c), v = target(c);
    if(would_change(u, v) || would_change(v, u))
      return;
    const auto [cost, x] = placement(c);
    if((std::max)(m_vertices[u].changed, m_vertices[v].changed) > computed && !m_queue.empty() &&
       cost > m_queue.top().cost) {
      push(c, cost);
      return;
    }
    if(m_vertices[u].degree + m_vertices[v].degree > m_largest_degree || !keeps_manifold(c) ||
       !keeps_shape(u, v, x) || !keeps_shape(v, u, x) ||
       (!m_watched.empty() && (m_watched[u] || m_watched[v]) &&
        m_crossing.crosses(m_points, *this, Spectral_slot(u), Spectral_slot(v), x))) {
      state(c) = refused;
      m_refused.push_back(c);
      return;
    }
    if(m_mesh.fixed[u])
      collapse(c, v, u, x);
    else
      collapse(c, u, v, x);
  }

  // A run waits for memory half of its time. Which vertices an edge has is known only when its
  // corners have come.
  void prefetch_next() const
  {
    if(const int c = m_queue.ahead(8); c >= 0)
      CGAL_SPECTRAL_PREFETCH(&m_mesh.corners[c]);
    if(const int c = m_queue.ahead(4); c >= 0 && source(c) != removed)
      for(const int v : {source(c), target(c)}) {
        CGAL_SPECTRAL_PREFETCH(&m_points[v]);
        CGAL_SPECTRAL_PREFETCH(&m_quadrics[v]);
        CGAL_SPECTRAL_PREFETCH(&m_quadrics[v].c);
        CGAL_SPECTRAL_PREFETCH(&m_vertices[v]);
      }
  }

  // Whether the place or the values of a fixed vertex would become those of the other one.
  bool would_change(const int fixed, const int other) const
  {
    return m_mesh.fixed[fixed] &&
           (m_mesh.fixed[other] ||
            (m_mesh.border_is_apart && is_border_vertex(other) && !is_border_vertex(fixed)));
  }

  // The link condition.
  bool keeps_manifold(const int c)
  {
    const int u = source(c), v = target(c);
    if(!is_border(c) && is_border_vertex(u) && is_border_vertex(v))
      return false;
    int faces = 0;
    for(const int side : {c, opposite(c)}) {
      if(side < 0)
        continue;
      ++faces;
      const int apex = source(previous_corner(side));
      // an ear, or a tetrahedron
      if((is_border(next_corner(side)) && is_border(previous_corner(side))) ||
         (m_vertices[apex].degree == 3 && !is_border_vertex(apex)))
        return false;
    }
    ++m_marks;
    for_neighbours(u, [&](const int w) { m_vertices[w].mark = m_marks; });
    int common = 0;
    for_neighbours(v, [&](const int w) { common += m_vertices[w].mark == m_marks; });
    return common == faces;
  }

  // Whether the faces around u, but for those of the edge uv, keep their shape if u moves to x.
  bool keeps_shape(const int u, const int v, const Eigen::Vector3d& x) const
  {
    bool result = true;
    for_triangles(u, [&](const int a, const int b) {
      if(!result || a == v || b == v)
        return;
      const Face before(m_points[u], m_points[a], m_points[b]), after(x, m_points[a], m_points[b]);
      if(before.is_needle())
        result = !after.has_short_side() || before.has_short_side();
      else
        result = !after.is_needle() && before.turns_little(after);
    });
    return result;
  }

  struct Face
  {
    Face(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b)
      : cross((a - p).cross(b - p))
      , squares((a - p).squaredNorm(), (b - p).squaredNorm(), (b - a).squaredNorm())
    {}

    bool has_short_side() const { return !(squares.minCoeff() > 0); }
    bool is_needle() const
    {
      const double longest = squares.maxCoeff();
      return !(cross.squaredNorm() > 1e-6 * longest * longest);
    }
    bool turns_little(const Face& after) const
    {
      const double dot = cross.dot(after.cross);
      return dot > 0 && dot * dot > 0.04 * cross.squaredNorm() * after.cross.squaredNorm();
    }

    Eigen::Vector3d cross, squares;
  };

  void collapse(const int c, const int gone, const int kept, const Eigen::Vector3d& x)
  {
    double weight =
        m_mesh.fixed[kept] ? 0. : projected_edge_weight(m_points[kept], m_points[gone], x);
    if(m_mesh.border_is_apart && is_border_vertex(kept) != is_border_vertex(gone))
      weight = is_border_vertex(kept) ? 0. : 1.;
    if(m_mesh.binary)
      weight = weight <= 0.5 ? 0. : 1.;
    m_collapsed.push_back(gone == source(c) ? halfedge(c) : ~halfedge(c));
    if(x != m_points[kept])
      m_place[kept] = x == m_points[gone] ? m_place[gone] : ~number_of_collapses();
    m_log.merge(gone, kept, weight, x + m_origin);

    std::vector<int>& ring = m_ring; // what is left of both
    ring.clear();
    const int beyond = opposite(c);
    const auto is_left = [&](const int h) {
      return h / 3 != c / 3 && (beyond < 0 || h / 3 != beyond / 3);
    };
    for(const int v : {gone, kept})
      for_outgoing(v, [&](const int h) {
        if(is_left(h))
          ring.push_back(h);
      });
    m_vertices[kept].degree += m_vertices[gone].degree - 2;
    for(const int side : {c, beyond})
      if(side >= 0)
        close(side, kept);
    m_points[kept] = x;
    m_quadrics[kept] += m_quadrics[gone];
    m_vertices[kept].changed = number_of_collapses();
    m_vertices[kept].outgoing = ring.front();
    for(const int h : ring) {
      m_mesh.corners[h].vertex = kept;
      if(is_border(h))
        m_vertices[kept].outgoing = h;
    }
    for(const int h : ring) {
      reconsider(h);
      reconsider(previous_corner(h));
    }
    if(m_watched.empty())
      return;
    m_watched[kept] = m_watched[kept] || m_watched[gone];
    bool near = m_watched[kept];
    for_neighbours(kept, [&](const int w) { near = near || m_watched[w]; });
    if(near)
      m_crossing.commit(m_points, Watched_fans{*this}, Spectral_slot(gone), Spectral_slot(kept));
  }

  // Removes a face on the edge: its other two edges become one.
  void close(const int side, const int kept)
  {
    const int apex = source(previous_corner(side));
    const int a = opposite(next_corner(side)), b = opposite(previous_corner(side));
    const bool was_queued =
        state(next_corner(side)) != none || state(previous_corner(side)) != none;
    if(a >= 0)
      m_mesh.corners[a].opposite = b;
    if(b >= 0) { // which has the halfedge of the other side from now on
      m_mesh.corners[b].opposite = a;
      m_mesh.corners[b].halfedge = halfedge(next_corner(side));
    }
    if(m_vertices[apex].outgoing == previous_corner(side))
      m_vertices[apex].outgoing = a;
    --m_vertices[apex].degree;
    --m_vertices[kept].degree;
    for(const int h : {side, next_corner(side), previous_corner(side)})
      m_mesh.corners[h].vertex = removed;
    // An entry of the edge that is left, if only one of the removed sides had one.
    const int left = a >= 0 ? a : b;
    if(was_queued && state(left) == none && (b < 0 || state(b) == none))
      state(left) = refused; // until the ring is complete
  }

  void reconsider(const int h)
  {
    if(state(h) == refused)
      push(h);
    if(!is_border(h) && state(opposite(h)) == refused)
      push(opposite(h));
  }

  Eigen::Vector3d m_origin;
  double m_cost_scale; // costs are fourth powers of lengths
  Collapse_log m_log;
  std::vector<int> m_collapsed, m_place;
  Triangle_arrays m_mesh;                // but for positions
  std::vector<Eigen::Vector3d> m_points; // of each vertex, as what follows, from the origin
  std::vector<Spectral_quadric> m_quadrics;
  std::vector<Vertex> m_vertices;
  int m_marks = 0;
  std::vector<int> m_refused, m_ring;
  std::vector<char> m_watched; // of each vertex, or nothing
  // Hubs come last: to look at one takes as long as it has neighbours.
  int m_largest_degree = 200;
  Spectral_crossing_guard m_crossing;
  Halfedge_queue m_queue;
};

Quadric_collapses quadric_collapses(Triangle_arrays mesh,
                                    const bool keep_free_of_self_intersections,
                                    const std::size_t target,
                                    const std::function<void(std::size_t)>& progress)
{
  // To check every collapse for intersections takes five times as long as the collapses. So the run
  // is repeated, watching only where intersections were left at the end, until there are no others.
  // The fifth run watches everywhere.
  const std::size_t n = std::size_t(mesh.V.rows());
  std::size_t least = n;
  const auto report = [&](const std::size_t left) {
    least = (std::min)(least, left);
    progress(least);
  };
  std::vector<char> watched;
  for(int round = 0;; ++round) {
    if(round == 4)
      watched.assign(n, true);
    const bool last = round == 4 || !keep_free_of_self_intersections;
    Quadric_collapser run(last ? std::move(mesh) : mesh, watched);
    run.run(target, report);
    if(last || !run.watch_intersections(watched))
      return run.take_result();
  }
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // definitions

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_QUADRIC_COLLAPSES_H
