// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_MESH_DIAGNOSIS_H
#define CGAL_SPECTRAL_TOOLBOX_MESH_DIAGNOSIS_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_toolbox/internal/separate_compilation.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief how often something was found in a mesh, and where first.
struct Mesh_finding
{
  std::size_t count = 0; ///< how often
  std::size_t first = 0; ///< the first vertex or face concerned, counted from 0
  /// what belongs to it: the other face or vertex, or the number of corners or parts
  std::size_t second = 0;

  /// \brief counts one more.
  void add(const std::size_t where, const std::size_t partner = 0)
  {
    if(count++ == 0) {
      first = where;
      second = partner;
    }
  }
};

/// \brief a connected component: vertices that faces join.
struct Mesh_component
{
  std::size_t vertices = 0; ///< how many it has
  std::size_t faces = 0;    ///< how many it has
  bool closed = true;       ///< no edge of it has one face only
  std::size_t first = 0;    ///< its first vertex
  double area = 0;          ///< of its faces that are sound and finite
};

/// \brief what `diagnose_polygon_soup()` and `diagnose_mesh()` found, counted, with the first
/// offender of each kind.
struct Mesh_diagnosis
{
  std::size_t number_of_vertices = 0; ///< isolated ones included
  std::size_t number_of_faces = 0;    ///< sound or not

  double extent = 0; ///< the largest coordinate in magnitude; to be usable between 1e-50 and 1e50

  /// \name Obstacles: the Laplace operator or a halfedge structure is impossible with any of them
  /// @{
  Mesh_finding non_finite_vertices; ///< vertices with a coordinate that is infinite or not a number
  Mesh_finding foreign_indices;     ///< faces that use a vertex that does not exist
  Mesh_finding repeated_vertices;   ///< faces that use a vertex twice, or have fewer than three
  /// faces with more than three vertices; `second` is how many the first has
  Mesh_finding polygons;
  /// faces with the vertices of an earlier one, which `second` is for the first
  Mesh_finding duplicate_faces;
  /// edges of more than two faces; from vertex `first` to vertex `second`
  Mesh_finding non_manifold_edges;
  /// edges along which their two faces, `first` and `second`, run in the same direction
  Mesh_finding misoriented_edges;
  /// vertices where parts of the surface touch only in that vertex
  Mesh_finding non_manifold_vertices;
  Mesh_finding isolated_vertices; ///< vertices that no face uses
  Mesh_finding massless_vertices; ///< vertices all of whose faces have zero area
  Mesh_finding overflowing_faces; ///< needles with a cotangent above 1e12, or areas that overflow
  /// @}

  /// \name What is handled
  /// @{
  /// from vertex `first` to `second`; merged before the first collapse
  Mesh_finding zero_length_edges;
  /// degenerate to rounding, zero-length edges included; contribute nothing
  Mesh_finding zero_area_faces;
  /// vertices at the position of another, `second`, that they share no edge with
  Mesh_finding coincident_vertices;
  /// @}

  /// pairs of border vertices of a triangle mesh that share no edge and are no further apart than
  /// 1e-5 of the box's diagonal and 0.49 of every edge at them. Each is paired with the first such
  /// vertex before it that is not itself the first of a pair. The surface is cut there, or its
  /// coordinates were rounded.
  std::vector<std::pair<std::size_t, std::size_t>> cracks;

  /// in the order of their first vertices; isolated vertices are not components
  std::vector<Mesh_component> components;

  /// \brief whether the mesh can be simplified as it is.
  bool usable() const { return number_of_faces != 0 && obstacles().empty(); }

  /// \brief whether `extent` is not usable: another unit of length helps then, no repair.
  bool out_of_scale() const { return !internal::extent_is_usable(extent); }

  /// \brief returns one clause for each kind of obstacle, without a full stop: how many, where
  /// first, what helps. The most elementary comes first; later ones may be its consequences.
  std::vector<std::string> obstacles() const;

  /// \brief returns one clause for each thing that is unusual but handled, without a full stop.
  std::vector<std::string> remarks() const;

  /// \brief returns one sentence for each reason why `K` eigenvectors on this mesh preserve less
  /// than was asked for, or something other than was meant.
  std::vector<std::string> warnings(std::size_t K) const;
};

/// \brief examines points and faces that need not form a mesh, as they were read from a file.
///
/// \param V         n x 3 positions
/// \param polygons  for each face the indices of its vertices, counted from 0
///
/// Takes \f$O(m \log m)\f$ for m faces and changes nothing.
CGAL_SPECTRAL_TOOLBOX_INLINE Mesh_diagnosis diagnose_polygon_soup(
    const Eigen::MatrixXd& V, const std::vector<std::vector<std::size_t>>& polygons);

/// \brief examines a mesh, which may have faces of any number of vertices; vertices and faces are
/// counted from 0 in the order of `vertices(pm)` and `faces(pm)`.
///
/// \tparam PolygonMesh a model of `FaceListGraph` and `HalfedgeGraph`
/// \param pm the mesh
/// \param np an optional sequence of named parameters among the one below
///
/// \cgalNamedParamsBegin
///   \cgalParamNBegin{vertex_point_map}
///     \cgalParamDescription{the positions of the vertices, which `CGAL::to_double()` reads}
///     \cgalParamType{a model of `ReadablePropertyMap` from vertices to points}
///     \cgalParamDefault{the mesh's own map}
///   \cgalParamNEnd
/// \cgalNamedParamsEnd
template <class PolygonMesh, class NamedParameters = parameters::Default_named_parameters>
Mesh_diagnosis diagnose_mesh(const PolygonMesh& pm,
                             const NamedParameters& np = parameters::default_values())
{
  const auto index = get(CGAL::dynamic_vertex_property_t<std::size_t>(), pm);
  const Eigen::MatrixXd V = internal::numbered_positions(pm, np, index);
  std::vector<std::vector<std::size_t>> polygons;
  for(const auto f : faces(pm)) {
    polygons.emplace_back();
    for(const auto v : vertices_around_face(halfedge(f, pm), pm))
      polygons.back().push_back(get(index, v));
  }
  return diagnose_polygon_soup(V, polygons);
}

/// @}

} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_TOOLBOX_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_TOOLBOX)

#include <CGAL/Spectral_geometry/internal/surface/Box_tree.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

#include <boost/pending/disjoint_sets.hpp>

#include <numeric>

namespace CGAL::Spectral_geometry {

namespace internal {

/// The steps of a diagnosis. Faces that are no polygons of different, existing vertices are counted
/// and left out of all that follows.
class Mesh_examination
{
public:
  using Polygons = std::vector<std::vector<std::size_t>>;

  Mesh_examination(const Eigen::MatrixXd& V, const Polygons& polygons)
    : m_V(V)
    , m_polygons(polygons)
    , m_n(std::size_t(V.rows()))
  {}

  Mesh_diagnosis run()
  {
    m_result.number_of_vertices = m_n;
    m_result.number_of_faces = m_polygons.size();
    m_result.extent = extent_of(m_V);
    examine_vertices();
    examine_faces();
    collect_sides();
    examine_edges();
    examine_fans();
    examine_areas();
    find_coincident_vertices();
    find_cracks();
    collect_components();
    return m_result;
  }

private:
  // A side of a face, along an edge. There are six for each vertex, so numbers have 32 bits.
  struct Side
  {
    std::uint32_t low, high, face;
    std::uint32_t place; // of the side in the face
    bool forward;
    bool operator<(const Side& other) const
    {
      return std::tie(low, high, face) < std::tie(other.low, other.high, other.face);
    }
  };

  Eigen::Vector3d point(const std::size_t v) const { return m_V.row(Eigen::Index(v)); }

  bool joined(const std::size_t low, const std::size_t high) const
  {
    const Side sought = {std::uint32_t(low), std::uint32_t(high), 0, 0, false};
    const auto side = std::lower_bound(m_sides.begin(), m_sides.end(), sought);
    return side != m_sides.end() && side->low == low && side->high == high;
  }

  void examine_vertices()
  {
    for(std::size_t v = 0; v < m_n; ++v) {
      m_finite.push_back(m_V.row(Eigen::Index(v)).allFinite());
      if(!m_finite[v])
        m_result.non_finite_vertices.add(v);
    }
  }

  void examine_faces()
  {
    m_sound.assign(m_polygons.size(), false);
    std::vector<bool> used(m_n, false);
    std::vector<std::size_t> sorted;
    for(std::size_t f = 0; f < m_polygons.size(); ++f) {
      sorted = m_polygons[f];
      std::sort(sorted.begin(), sorted.end());
      const bool foreign = !sorted.empty() && sorted.back() >= m_n;
      const bool repeated =
          sorted.size() < 3 || std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
      for(const std::size_t v : sorted)
        if(v < m_n)
          used[v] = true;
      if(foreign)
        m_result.foreign_indices.add(f);
      else if(repeated)
        m_result.repeated_vertices.add(f);
      else {
        m_sound[f] = true;
        if(sorted.size() > 3)
          m_result.polygons.add(f, sorted.size());
      }
    }
    for(std::size_t v = 0; v < m_n; ++v)
      if(!used[v])
        m_result.isolated_vertices.add(v);
    find_duplicate_faces();
  }

  // Only faces whose least vertices and whose sums of all vertices are equal are compared.
  void find_duplicate_faces()
  {
    using Sum_and_face = std::pair<std::size_t, std::size_t>;
    const auto least = [&](const std::size_t f) {
      return *std::min_element(m_polygons[f].begin(), m_polygons[f].end());
    };
    const std::vector<Sum_and_face> order =
        sorted_by_vertex<Sum_and_face>(m_n, [&](const auto& add) {
          for(std::size_t f = 0; f < m_polygons.size(); ++f)
            if(m_sound[f])
              add(least(f),
                  {std::accumulate(m_polygons[f].begin(), m_polygons[f].end(), std::size_t(0)), f});
        });
    std::vector<std::pair<std::vector<std::size_t>, std::size_t>> alike; // vertices and number
    for(std::size_t i = 0, j = 0; i < order.size(); i = j) {
      const auto is_alike = [&](const std::size_t k) {
        return order[k].first == order[i].first && least(order[k].second) == least(order[i].second);
      };
      for(++j; j < order.size() && is_alike(j);)
        ++j;
      if(j - i == 1)
        continue;
      alike.clear();
      for(std::size_t k = i; k < j; ++k) {
        alike.emplace_back(m_polygons[order[k].second], order[k].second);
        std::sort(alike.back().first.begin(), alike.back().first.end());
      }
      std::sort(alike.begin(), alike.end());
      for(std::size_t k = 1, first = 0; k < alike.size(); ++k)
        if(alike[k].first != alike[first].first)
          first = k;
        else
          add_smallest(m_result.duplicate_faces, {alike[k].second, alike[first].second});
    }
  }

  void collect_sides()
  {
    m_sides = sorted_by_vertex<Side>(m_n, [&](const auto& add) {
      for(std::size_t face = 0; face < m_polygons.size(); ++face) {
        const std::vector<std::size_t>& p = m_polygons[face];
        for(std::size_t i = 0; m_sound[face] && i < p.size(); ++i) {
          const auto v = std::uint32_t(p[i]), w = std::uint32_t(p[i + 1 == p.size() ? 0 : i + 1]);
          add((std::min)(v, w),
              {(std::min)(v, w), (std::max)(v, w), std::uint32_t(face), std::uint32_t(i), v < w});
        }
      }
    });
  }

  void examine_edges()
  {
    m_border.assign(m_n, false);
    for(std::size_t i = 0, j; i < m_sides.size(); i = j) {
      const Side& side = m_sides[i];
      for(j = i; j < m_sides.size() && m_sides[j].low == side.low && m_sides[j].high == side.high;)
        ++j;
      if(j - i > 2)
        m_result.non_manifold_edges.add(side.low, side.high);
      else if(j - i == 2 && side.forward == m_sides[i + 1].forward)
        add_smallest(m_result.misoriented_edges, {side.face, m_sides[i + 1].face});
      else if(j - i == 1)
        m_border[side.low] = m_border[side.high] = true;
      if(point(side.low) == point(side.high))
        m_result.zero_length_edges.add(side.low, side.high);
    }
  }

  // The corners of a vertex that edges join form one fan.
  void examine_fans()
  {
    std::vector<std::size_t> first_corner(m_polygons.size() + 1, 0);
    for(std::size_t f = 0; f < m_polygons.size(); ++f)
      first_corner[f + 1] = first_corner[f] + (m_sound[f] ? m_polygons[f].size() : 0);
    const auto corner = [&](const Side& side, const bool of_low) {
      const std::size_t next = side.place + 1 == m_polygons[side.face].size() ? 0 : side.place + 1;
      return first_corner[side.face] + (of_low == side.forward ? side.place : next);
    };
    boost::disjoint_sets_with_storage<> corners(first_corner.back());
    for(std::size_t i = 1; i < m_sides.size(); ++i)
      if(m_sides[i].low == m_sides[i - 1].low && m_sides[i].high == m_sides[i - 1].high)
        for(const bool of_low : {true, false})
          corners.union_set(corner(m_sides[i], of_low), corner(m_sides[i - 1], of_low));
    std::vector<std::size_t> fans(m_n, 0);
    for(std::size_t f = 0; f < m_polygons.size(); ++f)
      for(std::size_t c = first_corner[f]; c < first_corner[f + 1]; ++c)
        if(corners.find_set(c) == c)
          ++fans[m_polygons[f][c - first_corner[f]]];
    for(std::size_t v = 0; v < m_n; ++v)
      if(fans[v] > 1)
        m_result.non_manifold_vertices.add(v, fans[v]);
  }

  // Polygons are left to their triangulation.
  void examine_areas()
  {
    enum State : unsigned char { unused, massless, massive };
    std::vector<State> state(m_n, unused);
    for(std::size_t f = 0; f < m_polygons.size(); ++f) {
      const std::vector<std::size_t>& p = m_polygons[f];
      if(!m_sound[f] ||
         !std::all_of(p.begin(), p.end(), [&](const std::size_t v) { return m_finite[v]; }))
        continue;
      double area = 1;
      if(p.size() == 3) {
        const Triangle_cotangents t = triangle_cotangents(
            m_V.row(Eigen::Index(p[0])), m_V.row(Eigen::Index(p[1])), m_V.row(Eigen::Index(p[2])));
        area = t.area;
        if(area == 0)
          m_result.zero_area_faces.add(f);
        else if(!(t.cot.cwiseAbs().maxCoeff() <= largest_cotangent) || !std::isfinite(area))
          m_result.overflowing_faces.add(f);
      }
      for(const std::size_t v : p)
        state[v] = (std::max)(state[v], area == 0 ? massless : massive);
    }
    for(std::size_t v = 0; v < m_n; ++v)
      if(state[v] == massless)
        m_result.massless_vertices.add(v);
  }

  void find_coincident_vertices()
  {
    std::vector<std::pair<std::array<double, 3>, std::size_t>> order;
    order.reserve(m_n);
    for(std::size_t v = 0; v < m_n; ++v)
      if(m_finite[v])
        order.push_back(
            {{m_V(Eigen::Index(v), 0), m_V(Eigen::Index(v), 1), m_V(Eigen::Index(v), 2)}, v});
    std::sort(order.begin(), order.end());
    for(std::size_t i = 1, first = 0; i < order.size(); ++i)
      if(order[i].first != order[first].first)
        first = i;
      else if(!joined(order[first].second, order[i].second) &&
              !joined(order[i - 1].second, order[i].second))
        add_smallest(m_result.coincident_vertices, {order[i].second, order[first].second});
  }

  // The tree holds the reach of each vertex that is not near an earlier one: of many vertices in
  // one place it holds one.
  void find_cracks()
  {
    if(m_result.polygons.count != 0 ||
       std::find(m_border.begin(), m_border.end(), true) == m_border.end())
      return;
    Eigen::AlignedBox3d box;
    for(const Side& side : m_sides)
      for(const std::size_t v : {side.low, side.high})
        if(m_finite[v])
          box.extend(point(v));
    const double largest = 1e-5 * box.diagonal().norm();
    if(box.isEmpty() || !(largest > 0) || !std::isfinite(largest))
      return;
    std::vector<double> reach(m_n, largest);
    for(const Side& side : m_sides)
      if(m_finite[side.low] && m_finite[side.high])
        for(const std::size_t v : {side.low, side.high})
          reach[v] = (std::min)(reach[v], 0.49 * (point(side.low) - point(side.high)).norm());
    std::vector<std::size_t> candidates;
    std::vector<Box_tree::Box> boxes;
    for(std::size_t v = 0; v < m_n; ++v)
      if(m_border[v] && m_finite[v] && reach[v] > 1e-10 * largest) { // closer ones are equal
        candidates.push_back(v);
        boxes.emplace_back(point(v).array() - reach[v], point(v).array() + reach[v]);
      }
    Box_tree tree;
    tree.build(boxes);
    for(std::size_t i = 0; i < boxes.size(); ++i)
      tree.update(i, Box_tree::Box());
    for(std::size_t i = 0; i < boxes.size(); ++i) {
      const std::size_t v = candidates[i];
      std::size_t first = v;
      tree.any(boxes[i], [&](const std::size_t j) {
        const std::size_t w = candidates[j];
        if(w < first && (point(v) - point(w)).norm() <= (std::min)(reach[v], reach[w]) &&
           !joined(w, v))
          first = w;
        return false;
      });
      if(first != v)
        m_result.cracks.emplace_back(v, first);
      else
        tree.update(i, boxes[i]);
    }
  }

  void collect_components()
  {
    const std::vector<Eigen::Index> component =
        connected_components(Eigen::Index(m_n), [&](const auto& join) {
          for(std::size_t f = 0; f < m_polygons.size(); ++f)
            for(std::size_t i = 1; m_sound[f] && i < m_polygons[f].size(); ++i)
              join(Eigen::Index(m_polygons[f][0]), Eigen::Index(m_polygons[f][i]));
        });
    std::vector<Mesh_component> all;
    for(std::size_t v = 0; v < m_n; ++v) {
      const std::size_t i = std::size_t(component[v]);
      if(i == all.size()) {
        all.emplace_back();
        all.back().first = v;
      }
      ++all[i].vertices;
      all[i].closed = all[i].closed && !m_border[v];
    }
    for(std::size_t f = 0; f < m_polygons.size(); ++f)
      if(m_sound[f]) {
        Mesh_component& c = all[component[m_polygons[f][0]]];
        ++c.faces;
        if(const double area = fan_area(m_polygons[f]); std::isfinite(area))
          c.area += area;
      }
    for(const Mesh_component& c : all)
      if(c.faces != 0) // else an isolated vertex
        m_result.components.push_back(c);
  }

  double fan_area(const std::vector<std::size_t>& p) const
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const auto at = [&](const std::size_t i) {
      return Eigen::Vector3d(m_V.row(Eigen::Index(p[i])));
    };
    for(std::size_t i = 2; i < p.size(); ++i)
      sum += (at(i - 1) - at(0)).cross(at(i) - at(0));
    return sum.norm() / 2;
  }

  // The smallest counts as the first, in whatever order they come.
  static void add_smallest(Mesh_finding& finding, const std::pair<std::size_t, std::size_t>& found)
  {
    if(finding.count++ == 0 || found < std::pair(finding.first, finding.second))
      std::tie(finding.first, finding.second) = found;
  }

  const Eigen::MatrixXd& m_V;
  const Polygons& m_polygons;
  std::size_t m_n;
  std::vector<bool> m_finite, m_sound, m_border;
  std::vector<Side> m_sides; // sorted
  Mesh_diagnosis m_result;
};

/// "1 face", "2 faces"
inline std::string counted(const std::size_t n, const char* one, const char* many)
{
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

inline const Mesh_component& smallest_component(const std::vector<Mesh_component>& all)
{
  return *std::min_element(all.begin(), all.end(),
                           [](auto& a, auto& b) { return a.vertices < b.vertices; });
}

/// Adds what was found, if anything: "3 of 17 faces have zero area, the first is face 4 (counted
/// from 0): they ...". `singular` and `plural` are what one or several of them do.
inline void add_clause(std::vector<std::string>& clauses, const Mesh_finding& finding,
                       const std::size_t total, const bool faces, const std::string& singular,
                       const std::string& plural, const std::string& help)
{
  const std::string kind = faces ? "face" : "vertex", kinds = faces ? "faces" : "vertices";
  const std::string first = kind + " " + std::to_string(finding.first) + " (counted from 0)";
  if(finding.count == 1)
    clauses.push_back(first + " " + singular + ": " + help);
  else if(finding.count > 1)
    clauses.push_back(std::to_string(finding.count) + " of " + std::to_string(total) + " " + kinds +
                      " " + plural + ", the first is " + first + ": " + help);
}

/// Edges have no number but two ends.
inline void add_edge_clause(std::vector<std::string>& clauses, const Mesh_finding& finding,
                            const std::string& singular, const std::string& plural,
                            const std::string& help)
{
  const std::string first = "from vertex " + std::to_string(finding.first) + " to vertex " +
                            std::to_string(finding.second) + " (counted from 0)";
  if(finding.count == 1)
    clauses.push_back("the edge " + first + " " + singular + ": " + help);
  else if(finding.count > 1)
    clauses.push_back(std::to_string(finding.count) + " edges " + plural + ", the first runs " +
                      first + ": " + help);
}

} // namespace internal

CGAL_SPECTRAL_TOOLBOX_INLINE std::vector<std::string> Mesh_diagnosis::obstacles() const
{
  using std::to_string;
  std::vector<std::string> result;
  const auto vertices = [&](const Mesh_finding& f, const char* one, const char* many,
                            const char* help) {
    internal::add_clause(result, f, number_of_vertices, false, one, many, help);
  };
  const auto faces = [&](const Mesh_finding& f, const std::string& one, const char* many,
                         const std::string& help) {
    internal::add_clause(result, f, number_of_faces, true, one, many, help);
  };
  vertices(non_finite_vertices, "has a coordinate that is not a finite number",
           "have a coordinate that is not a finite number",
           "correct it or remove the faces around");
  if(out_of_scale())
    result.push_back(std::string("the largest coordinate is ") +
                     (extent > 1 ? "above 1e50" : "below 1e-50") +
                     " in magnitude: scale the mesh to another unit of length");
  faces(foreign_indices, "uses a vertex that does not exist", "use a vertex that does not exist",
        "correct the indices");
  faces(repeated_vertices, "uses a vertex twice or has fewer than three",
        "use a vertex twice or have fewer than three", "remove such faces");
  const std::string corners = "has " + to_string(polygons.second) + " vertices";
  faces(polygons, corners, "have more than three vertices",
        (polygons.count > 1 ? "it " + corners + "; " : std::string()) + "triangulate the faces");
  const std::string twin = "has the vertices of face " + to_string(duplicate_faces.second);
  faces(duplicate_faces, twin, "have the vertices of an earlier one",
        (duplicate_faces.count > 1 ? "it " + twin + "; " : std::string()) + "remove the copies");
  internal::add_edge_clause(result, non_manifold_edges, "has more than two faces",
                            "have more than two faces", "separate the sheets");
  if(misoriented_edges.count != 0)
    result.push_back("the faces " + to_string(misoriented_edges.first) + " and " +
                     to_string(misoriented_edges.second) +
                     " (counted from 0) run along their common edge in the same direction, " +
                     internal::counted(misoriented_edges.count, "edge", "edges") +
                     " in all: orient the faces alike");
  vertices(non_manifold_vertices, "is where parts of the surface touch in a single vertex",
           "are where parts of the surface touch in a single vertex",
           "give each part a vertex of its own");
  vertices(isolated_vertices, "is isolated, no face uses it", "are isolated, no face uses them",
           "remove every such vertex");
  faces(overflowing_faces, "is a needle or too large, its cotangents or its area overflow",
        "are needles or too large, their cotangents or their area overflow",
        "collapse the shortest edges, remesh or rescale the mesh");
  vertices(massless_vertices, "has no mass because all its faces have zero area",
           "have no mass because all their faces have zero area", "remove such faces");
  return result;
}

CGAL_SPECTRAL_TOOLBOX_INLINE std::vector<std::string> Mesh_diagnosis::remarks() const
{
  std::vector<std::string> result;
  internal::add_edge_clause(result, zero_length_edges, "has no length", "have no length",
                            "their ends are merged first");
  internal::add_clause(result, zero_area_faces, number_of_faces, true, "has zero area",
                       "have zero area", "they contribute nothing to the operator");
  internal::add_clause(result, coincident_vertices, number_of_vertices, false,
                       "lies where another vertex lies", "lie where another vertex lies",
                       "seams stay open unless they are stitched");
  if(components.size() > 1) {
    const Mesh_component& smallest = internal::smallest_component(components);
    result.push_back("there are " + std::to_string(components.size()) +
                     " components, the smallest of " + std::to_string(smallest.vertices) +
                     " vertices around vertex " + std::to_string(smallest.first) +
                     " (counted from 0): each of them is kept");
  }
  return result;
}

CGAL_SPECTRAL_TOOLBOX_INLINE std::vector<std::string>
Mesh_diagnosis::warnings(const std::size_t K) const
{
  std::vector<std::string> result;
  if(components.size() > 1 && K <= components.size())
    result.push_back("With " + internal::counted(K, "eigenvector", "eigenvectors") +
                     " only functions are preserved that are constant on each of the " +
                     std::to_string(components.size()) +
                     " components, not their shapes: ask for more than there are components.");
  else if(components.size() > 1) {
    const Mesh_component& smallest = internal::smallest_component(components);
    if(K >= smallest.vertices)
      result.push_back("The smallest of " + std::to_string(components.size()) +
                       " components, around vertex " + std::to_string(smallest.first) +
                       " (counted from 0), has " + std::to_string(smallest.vertices) +
                       " vertices and as many modes, not more than the " + std::to_string(K) +
                       " eigenvectors asked for, which belong to the larger components mostly.");
  }
  if(!cracks.empty())
    result.push_back(
        "The surface is cut at " +
        internal::counted(cracks.size(), "border vertex that lies", "border vertices that lie") +
        " on another, the first is vertex " + std::to_string(cracks.front().first) +
        " (counted from 0) on vertex " + std::to_string(cracks.front().second) +
        ": functions may jump there. Where that is not meant merge them; --repair of the "
        "programs closes cracks.");
  return result;
}

Mesh_diagnosis diagnose_polygon_soup(const Eigen::MatrixXd& V,
                                     const std::vector<std::vector<std::size_t>>& polygons)
{
  return internal::Mesh_examination(V, polygons).run();
}

} // namespace CGAL::Spectral_geometry

#endif // definitions

#endif // CGAL_SPECTRAL_TOOLBOX_MESH_DIAGNOSIS_H
