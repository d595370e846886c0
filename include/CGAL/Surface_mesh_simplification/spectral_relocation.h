// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_RELOCATION_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_RELOCATION_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Fine_vertex_slots.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/surface/Triangle_element.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Spectral_geometry/relocation.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/boost/graph/properties.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

namespace internal {

/// Whether a relocation can reach the eigenvalues of the fine mesh. With less than half of the
/// consistent mass linear elements have lower ones, and only a bent shape would have the same.
inline bool has_reachable_eigenvalues(const Spectral_geometry::Local_operator& op)
{
  return op.theta >= 0.5;
}

inline double area(const Spectral_geometry::Mesh_matrices& mesh)
{
  double result = 0;
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f)
    result += Spectral_geometry::internal::face_normal(mesh.V, mesh.T, f).norm() / 2;
  return result;
}

/// Returns what a relocation by eigenpairs sees, as in a run with default options.
inline Run_signals::Signals mixtures_of_eigenpairs(const Spectral_geometry::Eigenpairs& pairs)
{
  const Eigen::VectorXd& values = pairs.values;
  const Eigen::Index constants = pairs.zeros >= 0
                                     ? (std::min)(pairs.zeros, pairs.size())
                                     : (values.array() <= 1e-9 * values.maxCoeff()).count();
  const Eigen::MatrixXd R =
      mixing_matrix_of_relocation({}, Eigen::VectorXd::Ones(values.size()), constants, values);
  return {pairs.vectors * R, pairs.vectors * (values.asDiagonal() * R)};
}

/// `spectral_relocation()` for signals: F and Z = B^-1 L F are fine x K. `fixed`: further vertices
/// that stay, in addition to those of the named parameters, or empty.
template <class TriangleMesh, class NamedParameters>
Spectral_geometry::Relocation_result
relocate_mesh(TriangleMesh& mesh, const Eigen::SparseMatrix<double>& P,
              const Spectral_geometry::Mesh_matrices& fine, const Eigen::MatrixXd& F,
              const Eigen::MatrixXd& Z, const Spectral_geometry::Local_operator& op,
              const Spectral_geometry::Relocation_options& options, std::vector<bool> fixed,
              const NamedParameters& np)
{
  using parameters::choose_parameter;
  using parameters::get_parameter;
  Spectral_geometry::Mesh_matrices coarse = Spectral_geometry::mesh_matrices(mesh, np);
  const Eigen::MatrixXd before = coarse.V;
  const std::vector<char> further = fixed_vertex_flags(mesh, kept_vertex_flags(mesh, {}, np), np);
  fixed.resize((std::max)(fixed.size(), further.size()), false);
  for(std::size_t v = 0; v < further.size(); ++v)
    fixed[v] = fixed[v] || further[v];
  Spectral_geometry::Relocation_result result =
      Spectral_geometry::relocate_positions(coarse.V, coarse.T, P, fine, F, Z, op, fixed, options);
  const auto points = choose_parameter(get_parameter(np, internal_np::vertex_point),
                                       get_property_map(vertex_point, mesh));
  using Point = std::decay_t<decltype(get(points, *vertices(mesh).begin()))>;
  using FT = typename Kernel_traits<Point>::Kernel::FT;
  Eigen::Index i = 0;
  for(const auto v : vertices(mesh)) {
    // A point that did not move keeps its own number type's digits.
    if(coarse.V.row(i) != before.row(i))
      put(points, v, Point(FT(coarse.V(i, 0)), FT(coarse.V(i, 1)), FT(coarse.V(i, 2))));
    ++i;
  }
  return result;
}

/// Replaces the flagged rows of `own` by those of P, which the collapses left.
template <class Flags>
void keep_rows(Eigen::SparseMatrix<double>& own, const Eigen::SparseMatrix<double>& P,
               const Flags& kept)
{
  Eigen::SparseMatrix<double> carried = P;
  carried.prune([&](const Eigen::Index row, Eigen::Index, double) { return bool(kept[row]); });
  own.prune([&](const Eigen::Index row, Eigen::Index, double) { return !kept[row]; });
  own += carried;
}

/// Returns eigenpairs that judge a relocation by filtered noise. Noise covers fewer modes than
/// |C|_L does, and its variance matters where there are few. Without them |C|_L rose in 94 of 386
/// runs of *fast* (4 to 350 vertices, 5 to 100 eigenvectors), to 1.5 times at most. Null for many
/// vertices and many eigenvectors, where it did not rise.
template <class State>
std::shared_ptr<const Spectral_geometry::Eigenpairs>
judging_eigenpairs(const State& state, const Spectral_options& options, const Eigen::Index vertices,
                   const Spectral_geometry::Relocation_options& relocation)
{
  const Eigen::Index K = options.number_of_eigenvectors;
  if(K > 32 && vertices >= 2 * K)
    return nullptr;
  const Spectral_geometry::Laplace_operator op =
      operator_of_basis(state.fine().V, state.fine().T, options);
  auto solver = Spectral_geometry::Eigenpairs_options::with_tolerance(1e-3);
  solver.threads = relocation.threads;
  if(relocation.progress)
    solver.progress = [&](const Spectral_geometry::Progress&) {
      return relocation.progress({Spectral_geometry::Phase::relocation, 0.});
    };
  solver.cancel = relocation.cancel;
  return std::make_shared<Spectral_geometry::Eigenpairs>(Spectral_geometry::eigenpairs(
      op, (std::min)({K, vertices, op.L.rows() - op.vanishing}), solver));
}

/// Relocates after the collapses of a run, whose P leads to `mesh`. Signals, mass, operator and
/// fixed vertices are those of the run.
template <class TriangleMesh, class State, class NamedParameters>
Spectral_geometry::Relocation_result
relocate_after_collapses(TriangleMesh& mesh, const State& state, const Spectral_options& options,
                         const Eigen::SparseMatrix<double>& P,
                         Spectral_geometry::Relocation_options relocation,
                         const NamedParameters& np)
{
  const Run_signals signals(state.basis(), state.fine(), options);
  relocation.modes = signals.modes();
  relocation.threads = (std::max)(relocation.threads, options.threads);
  if(relocation.cancel == nullptr)
    relocation.cancel = options.cancel;
  const std::shared_ptr<const Spectral_geometry::Eigenpairs> pairs =
      state.basis().filtered && relocation.eigenpairs == nullptr
          ? judging_eigenpairs(state, options, P.rows(), relocation)
          : state.basis().eigenpairs;
  if(relocation.eigenpairs == nullptr)
    relocation.eigenpairs = pairs.get();
  const Spectral_geometry::Local_operator op = local_operator(options).restricted(P);
  if(pairs && relocation.eigenvalues.size() == 0 && has_reachable_eigenvalues(op))
    relocation.eigenvalues = state.basis().area * pairs->all_values();
  const Spectral_geometry::Filtered_signals* const filtered = state.basis().filtered.get();
  const auto mixtures = filtered ? decltype(signals.mixtures())() : signals.mixtures();
  Spectral_geometry::Relocation_result result = relocate_mesh(
      mesh, P, state.fine(), filtered ? filtered->F : mixtures.first,
      filtered ? filtered->Z : mixtures.second, op, relocation, state.fixed_vertices(), np);
  if(!result.resampled)
    return result;
  // If several input vertices share a place, the closest point may belong to another one.
  if(const std::vector<bool> kept = state.kept_vertices(); !kept.empty())
    keep_rows(result.restriction, P, kept);
  // A border vertex keeps its values 0, even if its closest point is an inner one.
  if(options.boundary == Spectral_geometry::Boundary_condition::dirichlet)
    keep_rows(result.restriction, P,
              Spectral_geometry::internal::border_vertices(
                  Spectral_geometry::mesh_matrices(mesh, np).T, P.rows()));
  return result;
}

} // namespace internal

/*!
 * Moves the vertices of a coarse mesh so that its Laplace-Beltrami spectrum agrees better with that
 * of a fine mesh: the mesh form of `Spectral_geometry::relocate_positions()`, which describes the
 * objective and the guards.
 *
 * The coarse mesh may come from anywhere. For one that `spectral_edge_collapse()` made, pass the
 * restriction of its result; for a remeshed one `Spectral_geometry::closest_point_restriction()`.
 *
 * @param mesh  the coarse mesh; its connectivity stays
 * @param P     coarse x fine, rows in the order of `vertices(mesh)`
 * @param fine  the fine mesh, taken with `Spectral_geometry::mesh_matrices()` before it was
 * simplified
 * @param pairs eigenpairs of the fine mesh, of the same operator and mass, at its own scale; of
 *        tight tolerance, since Z is taken as Phi Lambda. Relocation sees at most 64 mixtures of
 *        them, in which low ones weigh more, as after a run with default options. If `options` has
 *        no eigenvalues, those of the pairs are the goals, unless `op` has coefficients or less
 *        than half of the consistent mass
 * @param op    a mass, or an operator with coefficients for the vertices of `mesh`. Made for the
 * mass `averaged`: with any other the shape bends to cancel the error of the elements
 * @param options what to minimise, guards, when to stop
 * @param np    an optional sequence of named parameters among those below
 *
 * \cgalNamedParamsBegin
 *   \cgalParamNBegin{vertex_point_map}
 *     \cgalParamDescription{the positions of the vertices}
 *     \cgalParamType{a model of `ReadWritePropertyMap` from vertices to points}
 *     \cgalParamDefault{the mesh's own map}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{vertex_is_constrained_map}
 *     \cgalParamDescription{vertices that stay where they are}
 *     \cgalParamType{a model of `ReadablePropertyMap` from vertices to `bool`}
 *     \cgalParamDefault{no vertex is}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{edge_is_constrained_map}
 *     \cgalParamDescription{edges whose ends stay where they are}
 *     \cgalParamType{a model of `ReadablePropertyMap` from edges to `bool`}
 *     \cgalParamDefault{no edge is constrained}
 *   \cgalParamNEnd
 * \cgalNamedParamsEnd
 *
 * \pre `CGAL::is_triangle_mesh(mesh)`
 *
 * @return what was done, and the restriction to use from now on
 *
 * @throws std::invalid_argument for matrices that do not belong together, or options out of range
 * @throws Spectral_geometry::Cancelled when it is cancelled; the mesh is then as it was
 */
template <class TriangleMesh, class NamedParameters = parameters::Default_named_parameters>
Spectral_geometry::Relocation_result
spectral_relocation(TriangleMesh& mesh, const Eigen::SparseMatrix<double>& P,
                    const Spectral_geometry::Mesh_matrices& fine,
                    const Spectral_geometry::Eigenpairs& pairs,
                    const Spectral_geometry::Local_operator& op = Spectral_geometry::Mass::averaged,
                    const Spectral_geometry::Relocation_options& options = {},
                    const NamedParameters& np = parameters::default_values())
{
  internal::require(pairs.size() != 0 && pairs.vectors.cols() == pairs.size(),
                    "spectral_relocation: there are ", pairs.size(), " eigenvalues for ",
                    pairs.vectors.cols(), " eigenvectors; give one for each, and some.");
  Spectral_geometry::Relocation_options with_goals = options;
  if(options.eigenpairs == nullptr)
    with_goals.eigenpairs = &pairs;
  if(options.eigenvalues.size() == 0 && internal::has_reachable_eigenvalues(op) &&
     op.coefficients.size() == 0)
    with_goals.eigenvalues = pairs.all_values() * internal::area(fine);
  if(options.modes == 0)
    with_goals.modes = pairs.size();
  const auto [F, Z] = internal::mixtures_of_eigenpairs(pairs);
  return internal::relocate_mesh(mesh, P, fine, F, Z, op, with_goals, {}, np);
}

/*!
 * Relocates after `edge_collapse()` with the policies, as `spectral_edge_collapse()` does at its
 * end. Signals of any kind, mass, operator, fine mesh and P are those of the policies. Kept
 * vertices stay, and so do both ends of constrained edges if the policies or this call got the map.
 *
 * \code
 * SMS::Spectral_policies spectral(mesh);
 * SMS::edge_collapse(mesh, ...);
 * Eigen::SparseMatrix<double> P = SMS::spectral_relocation(mesh, spectral).restriction;
 * \endcode
 *
 * `Spectral_policies::restriction()` remains the P of the collapses. CGAL's filters, for instance a
 * bound on the distance to the input, are not called.
 *
 * @param mesh     that of the policies
 * @param policies after the collapses
 * @param options  as above; `modes` is replaced. If `progress` or `cancel` is empty, that of the
 * policies is used
 * @param np an optional sequence of named parameters among those below, for `mesh` as it is now
 *
 * \cgalNamedParamsBegin
 *   \cgalParamNBegin{vertex_is_constrained_map}
 *     \cgalParamDescription{further vertices that stay}
 *     \cgalParamType{a model of `ReadablePropertyMap` from vertices to `bool`}
 *     \cgalParamDefault{no vertex is}
 *   \cgalParamNEnd
 *   \cgalParamNBegin{edge_is_constrained_map}
 *     \cgalParamDescription{edges whose ends stay}
 *     \cgalParamType{a model of `ReadablePropertyMap` from edges to `bool`}
 *     \cgalParamDefault{no edge is constrained}
 *   \cgalParamNEnd
 * \cgalNamedParamsEnd
 *
 * @throws std::invalid_argument for another mesh, for `Spectral_options::binary` with `sampled`
 * signals, and if a wrapper of the placement has chosen points but no map of constrained edges was
 * given
 * @throws Spectral_geometry::Cancelled as above
 */
template <class TriangleMesh, class GeomTraits, class VertexPointMap,
          class NamedParameters = parameters::Default_named_parameters>
Spectral_geometry::Relocation_result
spectral_relocation(TriangleMesh& mesh,
                    const Spectral_policies<TriangleMesh, GeomTraits, VertexPointMap>& policies,
                    const Spectral_geometry::Relocation_options& options = {},
                    const NamedParameters& np = parameters::default_values())
{
  const auto& state = policies.state();
  internal::require(&mesh == &state.mesh(), "spectral_relocation: the policies are those of "
                                            "another mesh; pass the mesh that they were made for.");
  constexpr bool has_constraints =
      internal::is_given<NamedParameters, internal_np::edge_is_constrained_t>;
  internal::require(
      has_constraints || state.knows_constraints() || !state.has_foreign_points(),
      "spectral_relocation: a wrapper of the placement has chosen points, and the policies know of "
      "no constrained edges; make them with edge_is_constrained_map, or pass it here, one that is "
      "false everywhere if no edge is constrained.");
  internal::require(!state.options().binary ||
                        options.signals != Spectral_geometry::Relocation_options::Signals::sampled,
                    "spectral_relocation: the restriction that it takes anew is not binary; set "
                    "signals to carried.");
  Spectral_geometry::Relocation_options relocation = options;
  if(!relocation.progress)
    relocation.progress = [&state](const double fraction) {
      return state.report(Spectral_geometry::Phase::relocation, fraction);
    };
  return internal::relocate_after_collapses(mesh, state, state.options(), policies.restriction(),
                                            relocation,
                                            np.vertex_point_map(state.vertex_point_map()));
}

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_SPECTRAL_RELOCATION_H
