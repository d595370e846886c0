// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_QUADRIC_EDGE_COLLAPSE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_QUADRIC_EDGE_COLLAPSE_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Fine_vertex_slots.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/stages/Quadric_collapses.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>

#include <CGAL/Spectral_geometry/Run_control.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/boost/graph/properties.h>

#include <iterator>
#include <numeric>

namespace CGAL::Surface_mesh_simplification {
namespace internal {

/// Whether there are named parameters of `edge_collapse()` that a call with a cost of its own has
/// no use for.
template <class NamedParameters>
constexpr bool overrides_policies =
    is_given<NamedParameters, internal_np::get_cost_policy_t, internal_np::get_placement_policy_t,
             internal_np::use_relaxed_order_t, internal_np::vertex_index_t,
             internal_np::halfedge_index_t>;

inline void check_target(const char* const caller, const std::size_t target, const std::size_t n)
{
  require(target >= 1 && target <= n, caller, ": the target is ", target,
          " vertices, but the mesh has ", n, "; use a number from 1 to ", n, ".");
}

/// Returns the corners of all faces in the order of `faces(mesh)`, each with the corner across its
/// edge. `matrices`: those of `mesh_matrices()`.
template <class TriangleMesh>
Triangle_arrays triangle_arrays(const TriangleMesh& mesh, Spectral_geometry::Mesh_matrices matrices)
{
  Triangle_arrays result;
  result.V = std::move(matrices.V);
  const auto index = get(CGAL::dynamic_face_property_t<int>(), mesh);
  int m = 0;
  for(const auto f : faces(mesh))
    put(index, f, m++);
  result.corners.reserve(3 * std::size_t(m));
  int c = 0;
  for(const auto f : faces(mesh)) {
    int k = 0; // corner k is the target of the k-th halfedge, and what leads from there the next
    for(const auto h : halfedges_around_face(next(halfedge(f, mesh), mesh), mesh)) {
      const auto beyond = opposite(h, mesh);
      int corner = -1;
      if(!is_border(beyond, mesh)) {
        const auto first = halfedge(face(beyond, mesh), mesh);
        corner = 3 * get(index, face(beyond, mesh)) + (beyond == next(first, mesh) ? 0
                                                       : beyond == first           ? 2
                                                                                   : 1);
      }
      result.corners.push_back({matrices.T(get(index, f), k++), corner, c++});
    }
  }
  return result;
}

/*!
 * Turns the mesh that `triangle_arrays()` read into what `Collapse_replay` would make, without
 * replaying each collapse. The remaining vertices, faces and edges are those that
 * `Euler::collapse_edge()` leaves, which keeps the target of the edge's halfedge. Faces and
 * vertices keep their halfedge unless it is gone. Returns the slots of `vertices(mesh)`.
 *
 *          t
 *        /   \         pq is gone, and with it the face and pt:
 *       /     \        the face beyond pt has the halfedge qt in its place
 *      /  side \
 *     p ------> q
 */
template <class TriangleMesh, class NamedParameters>
std::vector<Eigen::Index> set_collapsed(TriangleMesh& mesh, const Quadric_collapses& run,
                                        const NamedParameters& np)
{
  using Traits = boost::graph_traits<TriangleMesh>;
  using Point = typename boost::property_traits<
      typename GetVertexPointMap<TriangleMesh, NamedParameters>::type>::value_type;
  using FT = typename Kernel_traits<Point>::Kernel::FT;
  const auto points =
      parameters::choose_parameter(parameters::get_parameter(np, internal_np::vertex_point),
                                   get_property_map(vertex_point, mesh));
  const auto& corners = run.corners;
  const std::vector<typename Traits::vertex_descriptor> input(vertices(mesh).begin(),
                                                              vertices(mesh).end());
  const std::vector<typename Traits::face_descriptor> triangles(faces(mesh).begin(),
                                                                faces(mesh).end());
  std::vector<typename Traits::halfedge_descriptor> halfedges;
  halfedges.reserve(corners.size());
  for(const auto f : triangles)
    for(const auto h : halfedges_around_face(next(halfedge(f, mesh), mesh), mesh))
      halfedges.push_back(h);

  std::vector<int> vertex(input.size()); // of each slot
  std::iota(vertex.begin(), vertex.end(), 0);
  const auto& merges = run.log.forest().merges();
  for(std::size_t i = 0; i < merges.size(); ++i) {
    const int c = run.collapsed[i];
    const auto h = c < 0 ? opposite(halfedges[~c], mesh) : halfedges[c];
    if(halfedge(edge(h, mesh), mesh) != h) // an edge that knows no direction
      vertex[merges[i].kept] = vertex[merges[i].removed];
  }
  std::vector<Eigen::Index> slots(input.size(), -1);
  for(const Eigen::Index slot : run.log.forest().kept_slots(Eigen::Index(merges.size()))) {
    slots[vertex[slot]] = slot;
    const int place = run.place[slot];
    if(place < 0) {
      const Eigen::Vector3d& x = run.log.points()[~place];
      put(points, input[vertex[slot]], Point(FT(x.x()), FT(x.y()), FT(x.z())));
    } else if(place != vertex[slot])
      put(points, input[vertex[slot]], Point(get(points, input[place])));
  }

  const auto halfedge_of = [&](const int c) { return halfedges[corners[c].halfedge]; };
  const std::vector<typename Traits::edge_descriptor> sides(edges(mesh).begin(), edges(mesh).end());
  const auto is_left = get(CGAL::dynamic_edge_property_t<char>(), mesh); // OpenMesh: no bool
  for(const auto e : sides)
    put(is_left, e, char(false));
  for(int c = 0; c < int(corners.size()); ++c)
    if(corners[c].vertex >= 0)
      put(is_left, edge(halfedge_of(c), mesh), char(true));
  const auto is_gone = [&](const auto h) { return !get(is_left, edge(h, mesh)); };

  const auto vertex_of = [&](const int c) { return input[vertex[corners[c].vertex]]; };
  for(int c = 0; c < int(corners.size()); ++c) {
    const auto f = triangles[c / 3];
    if(corners[c].vertex < 0) {
      if(c % 3 == 0)
        remove_face(f, mesh);
      continue;
    }
    const auto h = halfedge_of(c), into = halfedge_of(previous_corner(c));
    set_target(into, vertex_of(c), mesh);
    set_next(into, h, mesh);
    set_face(h, f, mesh);
    if(is_gone(halfedge(f, mesh)))
      set_halfedge(f, into, mesh);
    if(is_gone(halfedge(vertex_of(c), mesh)))
      set_halfedge(vertex_of(c), into, mesh);
  }
  for(int c = 0; c < int(corners.size()); ++c)
    if(corners[c].vertex >= 0 && corners[c].opposite < 0) {
      int last = previous_corner(c); // that leads to the vertex of c
      while(corners[last].opposite >= 0)
        last = previous_corner(corners[last].opposite);
      const auto h = opposite(halfedge_of(c), mesh);
      set_face(h, Traits::null_face(), mesh);
      set_target(h, vertex_of(c), mesh);
      set_next(h, opposite(halfedge_of(last), mesh), mesh);
    }
  for(const auto e : sides)
    if(!get(is_left, e))
      remove_edge(e, mesh);
  for(std::size_t v = 0; v < input.size(); ++v)
    if(slots[v] < 0)
      remove_vertex(input[v], mesh);
  slots.erase(std::remove(slots.begin(), slots.end(), Eigen::Index(-1)), slots.end());
  return slots;
}

/// Runs `quadric_collapses()` on arrays with these options, then changes the mesh accordingly.
/// `kept`: by positions in `vertices(mesh)`, or empty. The run can be cancelled until the mesh
/// changes. Returns the log and the slots of the vertices that are left.
template <class TriangleMesh, class NamedParameters>
std::pair<Collapse_log, std::vector<Eigen::Index>>
collapse_by_quadrics(TriangleMesh& mesh, const std::size_t target, const std::vector<char>& kept,
                     const Spectral_options& options, const NamedParameters& np)
{
  using Point = typename boost::property_traits<
      typename GetVertexPointMap<TriangleMesh, NamedParameters>::type>::value_type;
  Spectral_geometry::Mesh_matrices matrices = Spectral_geometry::mesh_matrices(mesh, np);
  // Defects that would remain are refused before anything changes. Needles and faces without area
  // need not remain.
  check_extent(matrices.V);
  check_fans(mesh, matrices.T);
  check_kept_vertices_apart(kept, matrices.V, matrices.T);
  Triangle_arrays arrays = triangle_arrays(mesh, std::move(matrices));
  arrays.single_precision = std::is_same<typename Kernel_traits<Point>::Kernel::FT, float>::value;
  arrays.fixed = fixed_vertex_flags(mesh, kept, np);
  arrays.border_is_apart = options.preserve_border ||
                           options.boundary == Spectral_geometry::Boundary_condition::dirichlet;
  arrays.binary = options.binary;
  const std::size_t n = std::size_t(arrays.V.rows());
  const auto report = [&](const std::size_t left) {
    const double fraction = double(n - left) / double((std::max)(n - target, std::size_t(1)));
    Spectral_geometry::internal::report_to(
        options, {Spectral_geometry::Phase::pre_simplification, fraction, left});
  };
  report(n);
  Quadric_collapses run =
      quadric_collapses(std::move(arrays), options.keep_free_of_self_intersections, target, report);
  if constexpr(is_given<NamedParameters, internal_np::edge_is_constrained_t>) {
    // Where two edges become one, a constrained one stays.
    Collapse_replay<TriangleMesh, NamedParameters> replay(mesh, run.log, np);
    replay.collapse_to(run.log.number_of_vertices_left());
    return {std::move(run.log), replay.slots()};
  } else {
    std::vector<Eigen::Index> slots = set_collapsed(mesh, run, np);
    return {std::move(run.log), std::move(slots)};
  }
}

/// Sets P, vertex map and log of a run. `slots`: those of `vertices(mesh)` in the log, in that
/// order.
template <class Result>
void set_restriction(Result& result, Collapse_log log, const std::vector<Eigen::Index>& slots)
{
  result.log = std::move(log);
  result.restriction = result.log.forest().restriction(slots);
  result.vertex_map = result.log.forest().vertex_map(slots);
}

} // namespace internal

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/// What `quadric_edge_collapse()` returns.
struct Quadric_edge_collapse_result
{
  /// P, coarse x fine: rows in the order of `vertices(mesh)` when the function returned, columns in
  /// that of the input
  Eigen::SparseMatrix<double> restriction;
  std::vector<std::size_t> vertex_map; ///< for each vertex of the input the row of P it ended in
  Collapse_log log;                    ///< every level of detail between the input and the result
};

/*!
 * Simplifies a huge mesh by the quadrics of `Spectral_options::shape` alone (M. Garland and P.
 * Heckbert, *Surface Simplification Using Quadric Error Metrics*, SIGGRAPH 1997). This is the first
 * stage of `spectral_edge_collapse()` on its own, see
 * `Spectral_edge_collapse_options::pre_simplify`. It works on arrays, takes three to nine
 * microseconds per vertex, and computes no eigenvectors. No face turns by more than 78 degrees in a
 * collapse, and no new needle appears. In the end no face goes through another, unless it did
 * before; where this must be prevented, the run takes at least twice as long.
 *
 * @param mesh a triangle mesh without isolated vertices; changed in place, garbage is not collected
 * @param number_of_vertices the target, from 1 to the number of vertices. The result has more if no
 * further edge may be collapsed
 * @param progress is called with the fraction done; it may return false to cancel until the mesh
 * changes. May be empty
 * @param np an optional sequence of named parameters among those below; the others of
 * `edge_collapse()` do not compile
 *
 * \cgalNamedParamsBegin
 *   \cgalParamNBegin{vertex_point_map}
 *     \cgalParamDescription{the positions of the vertices}
 *     \cgalParamType{a model of `ReadWritePropertyMap` from vertices to points}
 *     \cgalParamDefault{the mesh's own map}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{edge_is_constrained_map}
 *     \cgalParamDescription{edges whose ends stay}
 *     \cgalParamType{a model of `ReadablePropertyMap` from edges to `bool`}
 *     \cgalParamDefault{no edge is constrained}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{vertex_is_constrained_map}
 *     \cgalParamDescription{vertices that stay}
 *     \cgalParamType{a model of `ReadablePropertyMap` from vertices to `bool`}
 *     \cgalParamDefault{no vertex is}
 *   \cgalParamNEnd
 * \cgalNamedParamsEnd
 *
 * \pre `CGAL::is_triangle_mesh(mesh)`
 *
 * @return P, the vertex map, the log
 *
 * @throws std::invalid_argument for a mesh or a target that cannot be used, before anything is
 * changed
 * @throws Spectral_geometry::Cancelled when the progress callback returns false; the mesh is then
 * as it was
 */
template <class TriangleMesh, class NamedParameters = parameters::Default_named_parameters>
Quadric_edge_collapse_result
quadric_edge_collapse(TriangleMesh& mesh, const std::size_t number_of_vertices,
                      const Spectral_geometry::Progress_callback& progress = {},
                      const NamedParameters& np = parameters::default_values())
{
  static_assert(
      !internal::overrides_policies<NamedParameters> &&
          !internal::is_given<NamedParameters, internal_np::filter_t, internal_np::visitor_t>,
      "quadric_edge_collapse() takes no get_cost, get_placement, use_relaxed_order, index map, "
      "filter or visitor");
  const std::size_t n = std::size_t(std::distance(vertices(mesh).begin(), vertices(mesh).end()));
  internal::check_target("quadric_edge_collapse", number_of_vertices, n);
  Spectral_options options;
  options.progress = progress;
  Quadric_edge_collapse_result result;
  auto [log, slots] = internal::collapse_by_quadrics(
      mesh, number_of_vertices, internal::kept_vertex_flags(mesh, {}, np), options, np);
  internal::set_restriction(result, std::move(log), slots);
  return result;
}

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_QUADRIC_EDGE_COLLAPSE_H
