// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_COLLAPSE_LOG_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_COLLAPSE_LOG_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Fine_vertex_slots.h>

#include <CGAL/Spectral_geometry/restriction.h>

#include <CGAL/Kernel_traits.h>
#include <CGAL/Named_function_parameters.h>
#include <CGAL/assertions.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/boost/graph/properties.h>

namespace CGAL::Surface_mesh_simplification {

namespace internal {

/// Whether one of these named parameters is given.
template <class NamedParameters, class... Parameter>
constexpr bool is_given =
    !(parameters::is_default_parameter<NamedParameters, Parameter>::value && ...);

/// Returns the merge that was announced, given the slot that remains. The loop keeps v1 in every
/// version tried; should it keep v0, the weights change places.
inline Spectral_geometry::Merge_forest::Merge merge_into(const Eigen::Index kept,
                                                         Spectral_geometry::Merge_forest::Merge m)
{
  if(kept != m.kept) {
    CGAL_assertion(kept == m.removed);
    m = {m.kept, m.removed, 1 - m.weight};
  }
  return m;
}

} // namespace internal

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * The record of a simplification, from which every level of detail between its start and its end
 * can be rebuilt. It holds the merges in order, with those of edges without length before the loop,
 * and the point where each put its vertex: 48 bytes per collapse.
 *
 * P at any level comes from the log alone, the mesh from `Collapse_replay` with a copy of the
 * input:
 *
 * \code
 * Mesh copy = mesh;
 * const auto result = SMS::spectral_edge_collapse(mesh, 600, options);
 * SMS::Collapse_replay<Mesh> replay(copy, result.log);
 * for(const std::size_t N : {5000, 2000, 1000}) {
 *   replay.collapse_to(N); // as spectral_edge_collapse(copy, N, options) would
 *   const Eigen::SparseMatrix<double> P = replay.restriction();
 * }
 * \endcode
 *
 * (This holds without `Spectral_edge_collapse_options::quadrics_above`, which depends on the
 * target, and from 3 K vertices on. Below, the weights depend on it too, see
 * `weights_for_target()`; set all `Spectral_options::weights` to 1.)
 *
 * Vertices are known by their *slot*, the position in `vertices(mesh)` of the input. Changes of the
 * mesh after the collapses, such as relocation, are not in the log. Neither are vertices that were
 * moved between two runs.
 *
 * Made by `Spectral_policies::log()`, `Restriction_visitor::log()`, `spectral_edge_collapse()` and
 * `quadric_edge_collapse()`.
 */
class Collapse_log
{
public:
  using Index = Eigen::Index; ///< of a slot or of a merge

  /// The log of an empty mesh.
  Collapse_log() = default;

  /// The log of n vertices without merges. Throws `std::invalid_argument` if n is negative.
  explicit Collapse_log(const Index n)
    : m_forest(n)
  {}

  /// The merges, and for each where its vertex was put. Throws `std::invalid_argument` if their
  /// numbers differ.
  Collapse_log(Spectral_geometry::Merge_forest forest, std::vector<Eigen::Vector3d> points)
    : m_forest(std::move(forest))
    , m_points(std::move(points))
  {
    internal::require(m_forest.merges().size() == m_points.size(), "Collapse_log: there are ",
                      m_points.size(), " points for ", m_forest.merges().size(),
                      " merges; give one for each.");
  }

  /// Reserves memory for this many merges in all.
  void reserve(const std::size_t number_of_merges)
  {
    m_forest.reserve(Index(number_of_merges));
    m_points.reserve(number_of_merges);
  }

  /// Adds the merge of `removed` into `kept`, which then lies at `point`: F_kept = (1 - weight)
  /// F_kept + weight F_removed. Throws as `Merge_forest::merge()` does.
  void merge(const Index removed, const Index kept, const double weight,
             const Eigen::Vector3d& point)
  {
    m_points.push_back(point); // first, so that both get it or none
    try {
      m_forest.merge(removed, kept, weight);
    } catch(...) {
      m_points.pop_back();
      throw;
    }
  }

  /// Appends the log of a second simplification that started where this one ended: `slots[i]` is
  /// the slot here that the second log calls i. Throws `std::invalid_argument` if they do not fit.
  void append(const Collapse_log& second, const std::vector<Index>& slots)
  {
    internal::require(Index(slots.size()) == second.m_forest.number_of_slots() &&
                          slots.size() == number_of_vertices_left(),
                      "Collapse_log: the log to append starts at ",
                      second.m_forest.number_of_slots(), " vertices, but ",
                      number_of_vertices_left(), " are left here, and ", slots.size(),
                      " slots are given; let all three agree.");
    reserve(m_points.size() + second.m_points.size());
    for(std::size_t i = 0; i < second.m_points.size(); ++i) {
      const Spectral_geometry::Merge_forest::Merge& m = second.m_forest.merges()[i];
      merge(slots[m.removed], slots[m.kept], m.weight, second.m_points[i]);
    }
  }

  /// The merges, from which P at any level follows.
  const Spectral_geometry::Merge_forest& forest() const { return m_forest; }

  /// Returns, for each merge, the point where it put its vertex.
  const std::vector<Eigen::Vector3d>& points() const { return m_points; }

  /// Number of vertices of the input.
  std::size_t number_of_vertices() const { return std::size_t(m_forest.number_of_slots()); }

  /// Number of vertices at the end of the log: the smallest level that it holds.
  std::size_t number_of_vertices_left() const { return number_of_vertices() - m_points.size(); }

  /*!
   * Returns P of the level of N vertices, N x number_of_vertices(): rows in ascending order of
   * slots, which is the order of `vertices()` of the replayed mesh before its garbage is collected.
   *
   * Throws `std::invalid_argument` unless N is from number_of_vertices_left() to
   * number_of_vertices().
   */
  Eigen::SparseMatrix<double> restriction(const std::size_t N) const
  {
    const Index merges = number_of_merges(N);
    return m_forest.restriction(m_forest.kept_slots(merges), merges);
  }

  /// Returns, for each vertex of the input, its row of restriction(N). Throws as restriction()
  /// does.
  std::vector<std::size_t> vertex_map(const std::size_t N) const
  {
    const Index merges = number_of_merges(N);
    return m_forest.vertex_map(m_forest.kept_slots(merges), merges);
  }

  /// Returns how many merges lead to the level of N vertices. Throws as restriction() does.
  Index number_of_merges(const std::size_t N) const
  {
    internal::require(N >= number_of_vertices_left() && N <= number_of_vertices(),
                      "Collapse_log: a level of ", N, " vertices is asked for; use a number from ",
                      number_of_vertices_left(), " to ", number_of_vertices(),
                      ", those of this log.");
    return Index(number_of_vertices() - N);
  }

private:
  Spectral_geometry::Merge_forest m_forest;
  std::vector<Eigen::Vector3d> m_points;
};

/*!
 * Collapses a copy of the input of a `Collapse_log` to one level after the other, from fine to
 * coarse, without computing a single cost.
 *
 * Each merge is done by `Euler::collapse_edge()` on the edge that the run collapsed. On a copy
 * (`Mesh copy = mesh;` before the run) the mesh of N vertices therefore equals that of a run
 * stopped at N, with equal options, also those that depend on the target (see `Collapse_log`).
 * Connectivity, coordinates and the order of vertices, faces and edges before garbage is collected
 * are the same; only the halfedge that a face or vertex names may differ. On the same mesh rebuilt
 * in another way (read from a file again, in another type) connectivity and coordinates are still
 * the same. The order may differ, since the other end of an edge may survive its collapse;
 * restriction() follows the mesh as it is. Edges without length are merged before a run asks
 * whether to stop, so no run stops at the levels among them.
 *
 * Coordinates that are not `double` are restored from `double`; a merge that keeps an end of its
 * edge copies that point.
 *
 * @tparam TriangleMesh a model of `MutableFaceGraph` with support for dynamic vertex properties
 * @tparam NamedParameters those of the constructor
 */
template <class TriangleMesh, class NamedParameters = parameters::Default_named_parameters>
class Collapse_replay
{
public:
  using Index = Eigen::Index;         ///< of a slot
  using Triangle_mesh = TriangleMesh; ///< the type of the mesh
  /// that of the named parameters, or the mesh's own
  using Vertex_point_map = typename GetVertexPointMap<Triangle_mesh, NamedParameters>::type;

  /*!
   * @param mesh a copy of the input of the log, as it was before the run; must outlive this object
   * @param log a copy is kept; move it here if you no longer need it
   * @param np an optional sequence of named parameters among those below, all of the copy
   *
   * \cgalNamedParamsBegin
   *   \cgalParamNBegin{vertex_point_map}
   *     \cgalParamDescription{the positions of the vertices}
   *     \cgalParamType{a model of `ReadWritePropertyMap` from vertices to points}
   *     \cgalParamDefault{the mesh's own map}
   *   \cgalParamNEnd
   *   \cgalParamNBegin{edge_is_constrained_map}
   *     \cgalParamDescription{the edges that were constrained in the run}
   *     \cgalParamType{a model of `ReadablePropertyMap` from edges to `bool`}
   *     \cgalParamDefault{no edge is constrained}
   *   \cgalParamNEnd
   * \cgalNamedParamsEnd
   *
   * @throws std::invalid_argument if the mesh has another number of vertices than the input of the
   * log
   */
  Collapse_replay(Triangle_mesh& mesh, Collapse_log log,
                  const NamedParameters& np = parameters::default_values())
    : m_mesh(&mesh)
    , m_log(std::move(log))
    , m_np(np)
    , m_vpm(parameters::choose_parameter(parameters::get_parameter(np, internal_np::vertex_point),
                                         get_property_map(vertex_point, mesh)))
    , m_slots(mesh, "Collapse_replay")
  {
    internal::require(std::size_t(m_slots.size()) == m_log.number_of_vertices(),
                      "Collapse_replay: the mesh has ", m_slots.size(),
                      " vertices, but the log starts at ", m_log.number_of_vertices(),
                      "; pass a copy of the input as it was before the run.");
  }

  /*!
   * Collapses the mesh to N vertices.
   *
   * @throws std::invalid_argument, before anything is changed, unless N is from the end of the log
   *         to number_of_vertices() (a replay only coarsens: begin again with another copy). Also
   *         if two vertices that should be joined are not: the mesh is not a copy of the input, and
   *         is left where that was found
   * @throws std::logic_error when the mesh has got new vertices
   */
  void collapse_to(const std::size_t N)
  {
    const Index end = m_log.number_of_merges(N);
    internal::require(end >= m_done, "Collapse_replay: a level of ", N,
                      " vertices is asked for, but the mesh has only ", number_of_vertices(),
                      " left; go from fine to coarse, or begin again with another copy.");
    m_slots.check();
    // Afresh: garbage may have been collected meanwhile.
    m_vertices.resize(m_log.number_of_vertices());
    for(const vertex_descriptor v : vertices(*m_mesh))
      m_vertices[m_slots.slot(v)] = v;
    for(; m_done < end; ++m_done)
      merge(m_log.forest().merges()[m_done], m_log.points()[m_done]);
  }

  /// Number of vertices of the mesh as it is.
  std::size_t number_of_vertices() const
  {
    return m_log.number_of_vertices() - std::size_t(m_done);
  }

  /// Returns the slot of each vertex of the mesh as it is, in the order of `vertices(mesh)`: the
  /// vertex of the input that it continues.
  std::vector<Index> slots() const { return m_slots.current(); }

  /// Returns P of the mesh as it is: rows in the order of `vertices(mesh)` now, columns in that of
  /// the input.
  Eigen::SparseMatrix<double> restriction() const
  {
    return m_log.forest().restriction(slots(), m_done);
  }

  /// Returns, for each vertex of the input, the position in `vertices(mesh)` of the vertex that it
  /// was merged into.
  std::vector<std::size_t> vertex_map() const { return m_log.forest().vertex_map(slots(), m_done); }

private:
  using Point = typename boost::property_traits<Vertex_point_map>::value_type;
  using vertex_descriptor = typename boost::graph_traits<Triangle_mesh>::vertex_descriptor;
  using halfedge_descriptor = typename boost::graph_traits<Triangle_mesh>::halfedge_descriptor;
  using Merge = Spectral_geometry::Merge_forest::Merge;
  using FT = typename Kernel_traits<Point>::Kernel::FT;

  void merge(const Merge& m, const Eigen::Vector3d& at)
  {
    const vertex_descriptor removed = m_vertices[m.removed], kept = m_vertices[m.kept];
    const auto [h, are_joined] = halfedge(removed, kept, *m_mesh);
    internal::require(
        are_joined, "Collapse_replay: the vertices ", m.removed, " and ", m.kept,
        " are not joined by an edge where the log merges them; pass a copy of the input as it "
        "was before the run.");
    const Point point = at == internal::to_vector(get(m_vpm, kept)) ? Point(get(m_vpm, kept))
                        : at == internal::to_vector(get(m_vpm, removed))
                            ? Point(get(m_vpm, removed))
                            : Point(FT(at.x()), FT(at.y()), FT(at.z()));
    const vertex_descriptor left = collapse(h);
    // The other of the two, should the halfedges of the copy lie otherwise.
    m_vertices[m.kept] = left;
    m_slots.set(left, m.kept);
    put(m_vpm, left, point);
  }

  vertex_descriptor collapse(const halfedge_descriptor h)
  {
    if constexpr(internal::is_given<NamedParameters, internal_np::edge_is_constrained_t>)
      return Euler::collapse_edge(
          edge(h, *m_mesh), *m_mesh,
          parameters::get_parameter(m_np, internal_np::edge_is_constrained));
    else
      return Euler::collapse_edge(edge(h, *m_mesh), *m_mesh);
  }

  Triangle_mesh* m_mesh;
  Collapse_log m_log;
  NamedParameters m_np;
  Vertex_point_map m_vpm;
  internal::Fine_vertex_slots<Triangle_mesh> m_slots;
  std::vector<vertex_descriptor> m_vertices; // of each slot that is left
  Index m_done = 0;
};

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_COLLAPSE_LOG_H
