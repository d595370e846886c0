// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_POLICIES_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_POLICIES_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_error_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_state.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_visitor.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_handle.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/stages/run_explanations.h>

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>

#include <CGAL/Kernel_traits.h>
#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/boost/graph/properties.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * Cost, placement and visitor for `edge_collapse()` that keep the spectrum of the Laplace-Beltrami
 * operator.
 *
 * Each candidate costs the change of
 * \f[ E = \| P Z - \tilde M^{-1} \tilde L P F \|_{\tilde M}^2, \qquad Z = M^{-1} L F \f]
 * (Eq. 2 of Lescoat et al., *Spectral Mesh Simplification*, Computer Graphics Forum 39(2), 2020),
 * where F holds the first K eigenvectors of the input and P is the restriction from the input to
 * the current mesh. With `Spectral_options::mass` set to `averaged` the mass matrix B replaces M in
 * its weak form, \f$ E = \sum_w \| (\tilde B P Z - \tilde L P F)_w \|^2 / \tilde M_w \f$. All
 * values are for the input scaled to unit area.
 *
 * \code
 * SMS::Spectral_policies spectral(mesh);
 * SMS::edge_collapse(mesh, SMS::Vertex_count_stop_predicate(600, mesh),
 *                    CGAL::parameters::get_cost(spectral.get_cost())
 *                                     .get_placement(spectral.get_placement())
 *                                     .visitor(spectral.visitor()));
 * Eigen::SparseMatrix<double> P = spectral.restriction();
 * \endcode
 *
 * All three must be passed; without the visitor the first cost throws `std::logic_error`. The
 * object is a handle: copies share one state, and a moved-from object throws `std::logic_error`
 * when it is used. The mesh must outlive it and must not get new vertices. A second
 * `edge_collapse()` with the same policies continues, and P still starts at the original input.
 *
 * @tparam TriangleMesh a model of `MutableFaceGraph` with support for dynamic vertex properties
 * @tparam GeomTraits   a kernel, that of the points by default; exact numbers are read by
 * `to_double()`
 * @tparam VertexPointMap the mesh's own by default
 */
template <
    class TriangleMesh,
    class GeomTraits = typename Kernel_traits<typename boost::property_traits<
        typename boost::property_map<TriangleMesh, vertex_point_t>::type>::value_type>::Kernel,
    class VertexPointMap = typename boost::property_map<TriangleMesh, vertex_point_t>::type>
class Spectral_policies
{
public:
  /// \name Types
  /// @{

  /// the template parameters, what the handles share, and the handles
  using Triangle_mesh = TriangleMesh;
  using Geom_traits = GeomTraits;
  using Vertex_point_map = VertexPointMap;
  using State = internal::Spectral_state<Triangle_mesh, Geom_traits, Vertex_point_map>;
  using Get_cost = Spectral_cost<State>;
  using Get_placement = Spectral_placement<State>;

  /// @}

  /*!
   * Reads the mesh and finds the basis, which takes most of the time for large meshes.
   *
   * @param mesh a triangle mesh without isolated vertices
   * @param options see `Spectral_options`
   * @param np an optional sequence of named parameters among those below. The first two must be
   * those of `edge_collapse()`; the others are read only here
   *
   * \cgalNamedParamsBegin
   *   \cgalParamNBegin{vertex_point_map}
   *     \cgalParamDescription{the positions of the vertices}
   *     \cgalParamType{a model of `ReadWritePropertyMap` from vertices to points}
   *     \cgalParamDefault{the mesh's own map}
   *   \cgalParamNEnd
   *   \cgalParamNBegin{geom_traits}
   *     \cgalParamDescription{the kernel}
   *     \cgalParamType{one whose numbers `CGAL::to_double()` reads}
   *     \cgalParamDefault{that of the points}
   *   \cgalParamNEnd
   *   \cgalParamNBegin{vertex_is_constrained_map}
   *     \cgalParamDescription{vertices to keep, in addition to `Spectral_options::kept_vertices`}
   *     \cgalParamType{a model of `ReadablePropertyMap` from vertices to `bool`}
   *     \cgalParamDefault{no vertex is}
   *   \cgalParamNEnd
   *   \cgalParamNBegin{edge_is_constrained_map}
   *     \cgalParamDescription{edges whose ends `spectral_relocation()` leaves in place}
   *     \cgalParamType{a model of `ReadablePropertyMap` from edges to `bool`}
   *     \cgalParamDefault{no edge is constrained}
   *   \cgalParamNEnd
   * \cgalNamedParamsEnd
   *
   * \pre `CGAL::is_triangle_mesh(mesh)`
   *
   * @throws std::invalid_argument when the mesh or an option cannot be used; one sentence names the
   * first offender
   * @throws std::runtime_error when the eigenpairs do not converge
   * @throws Spectral_geometry::Cancelled when it is cancelled
   */
  template <class NamedParameters = parameters::Default_named_parameters>
  explicit Spectral_policies(Triangle_mesh& mesh,
                             const Spectral_options& options = Spectral_options(),
                             const NamedParameters& np = parameters::default_values())
    : m_state(std::make_shared<State>(mesh, options, np))
  {}

  /// Returns the cost to pass to `edge_collapse()`, a model of `GetCost`.
  Get_cost get_cost() const { return Get_cost(shared_state()); }

  /// Returns the placement to pass to `edge_collapse()`, a model of `GetPlacement`. You may wrap
  /// it, see filter().
  Get_placement get_placement() const { return Get_placement(shared_state()); }

  /// Returns the visitor to pass to `edge_collapse()`. It also calls yours, if any: pass
  /// `std::ref(v)` to share v; anything else is copied.
  template <class Visitor = internal::Dummy_visitor>
  Spectral_visitor<State, Visitor> visitor(Visitor user_visitor = Visitor()) const
  {
    return Spectral_visitor<State, Visitor>(shared_state(), std::move(user_visitor));
  }

  /// Returns the filter that `edge_collapse()` needs if the placement is wrapped, in
  /// `Constrained_placement` for instance, and there are vertices to keep or no face may go through
  /// another. Without it the first collapse to a point of the wrapper throws `std::logic_error`. It
  /// also calls yours, if any, which is copied.
  template <class Filter = internal::Dummy_filter>
  Spectral_filter<State, Filter> filter(Filter user_filter = Filter()) const
  {
    return Spectral_filter<State, Filter>(shared_state(), std::move(user_filter));
  }

  /// Returns P, coarse x fine (section 3.2): rows in the order of `vertices(mesh)` now, columns in
  /// its order at construction. Rows sum to 1, and columns have at most one nonzero.
  Eigen::SparseMatrix<double> restriction() const
  {
    return state().log().forest().restriction(state().current_slots());
  }

  /// Returns, for each vertex of the input, the position in `vertices(mesh)` of the vertex that it
  /// was merged into.
  std::vector<std::size_t> vertex_map() const
  {
    return state().log().forest().vertex_map(state().current_slots());
  }

  /// Returns the log of the merges so far and of the points where they put their vertices.
  /// `Collapse_replay` makes every level of detail between the input and the current mesh from it.
  Collapse_log log() const { return state().log(); }

  /// Returns the prolongation, fine x coarse, which takes functions on the current mesh back to the
  /// input. Rows hold barycentric coordinates of the closest point of the current mesh on the same
  /// part of the body, and sum to 1.
  Eigen::SparseMatrix<double> prolongation() const
  {
    return Spectral_geometry::closest_point_prolongation(state().fine(), current_matrices(),
                                                         restriction());
  }

  /// Returns the eigenpairs of the input, at its own scale; null with signals of your own or
  /// filtered noise. Put them into `Spectral_options::eigenpairs` to simplify the same input again.
  std::shared_ptr<const Spectral_geometry::Eigenpairs> eigenpairs() const
  {
    return state().basis().eigenpairs;
  }

  /// Returns E of the current mesh (Eq. 2), for the input scaled to unit area; tracked while
  /// collapsing.
  double error() const { return state().error(); }

  /// Returns sqrt(E / sum_k w_k lambda_k^2), which does not depend on scale; the sum is over the
  /// eigenvectors that the metric sees, with w = `Spectral_options::weights`. For signals of your
  /// own it is sqrt(E) / || Z ||_B. It is 0 if the signals are constant (as for K = 1): P carries
  /// constants over exactly.
  double relative_error() const { return state().relative_error(); }

  /// Returns one sentence if the last run ended because every edge left was refused: the reasons,
  /// with genus and components, and what to do. Empty if its stop predicate ended the run.
  std::string explanation() const
  {
    return state().has_run_out_of_edges()
               ? internal::explain_exhausted_queue(current_matrices(), refusals(), 0)
               : std::string();
  }

  /// Returns the numbers of candidates refused in all runs so far, by cause.
  Spectral_refusals refusals() const { return state().refusals(); }

  /// Returns one sentence for each thing that was done but is not advised: eigenpairs that did not
  /// reach their tolerance, a mesh of less than 3 K vertices, a relative error above one half.
  std::vector<std::string> warnings() const
  {
    std::vector<std::string> result;
    const Spectral_options& options = state().options();
    const Eigen::Index K = internal::number_of_signals(options);
    internal::warn_of_eigenpairs(result, eigenpairs().get());
    internal::warn_of_target(result, state().number_of_vertices(), K,
                             options.weights.size() == 0 ? K
                                                         : (options.weights.array() > 0).count());
    internal::warn_of_error(result, relative_error());
    return result;
  }

  /// \cond SKIP_IN_MANUAL
  // What the handles share: for the other headers of this package, and its tests.
  std::shared_ptr<State> shared_state() const
  {
    internal::state_of_handle(m_state, "Spectral_policies");
    return m_state;
  }

  State& state() const { return internal::state_of_handle(m_state, "Spectral_policies"); }
  /// \endcond

private:
  Spectral_geometry::Mesh_matrices current_matrices() const
  {
    return Spectral_geometry::mesh_matrices(
        state().mesh(), parameters::vertex_point_map(state().vertex_point_map()));
  }

  std::shared_ptr<State> m_state;
};

/// `vertex_point_map` and `geom_traits` among the named parameters choose the types.
template <class TriangleMesh, class NamedParameters>
Spectral_policies(TriangleMesh&, const Spectral_options&, const NamedParameters&)
    -> Spectral_policies<TriangleMesh, typename GetGeomTraits<TriangleMesh, NamedParameters>::type,
                         typename GetVertexPointMap<TriangleMesh, NamedParameters>::type>;

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_POLICIES_H
