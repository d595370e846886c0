// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_RESTRICTION_VISITOR_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_RESTRICTION_VISITOR_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Collapse_log.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_visitor.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Fine_vertex_slots.h>

#include <CGAL/Spectral_geometry/restriction.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{
namespace internal {

/// What the copies of a `Restriction_visitor` share: the merges so far, and the one under way.
template <class TriangleMesh>
class Restriction_tracker
{
public:
  using Slots = Fine_vertex_slots<TriangleMesh>;
  using vertex_descriptor = typename Slots::vertex_descriptor;

  explicit Restriction_tracker(TriangleMesh& mesh)
    : m_mesh(&mesh)
    , m_slots(mesh, "Restriction_visitor")
    , m_log(m_slots.size())
  {}

  void check_mesh(const TriangleMesh& mesh)
  {
    require(&mesh == m_mesh,
            "Restriction_visitor: edge_collapse() was called with another mesh than the one "
            "that the visitor was made for; make a visitor for that mesh.");
    m_slots.check();
    m_announced.reset(); // left so by an exception during a collapse
  }

  // Before the collapse: afterwards p1 reads the new point, and some mesh types have freed v0.
  template <class Profile, class OptionalPoint>
  void on_collapsing(const Profile& profile, const OptionalPoint& placement)
  {
    // Without a placement CGAL leaves the kept vertex where it is.
    const double weight =
        placement ? projected_edge_weight(to_vector(profile.p1()), to_vector(profile.p0()),
                                          to_vector(*placement))
                  : 0.;
    m_announced = {m_slots.slot(profile.v0()), m_slots.slot(profile.v1()), weight};
  }

  template <class Profile>
  void on_collapsed(const Profile& profile, const vertex_descriptor kept_vertex)
  {
    if(!m_announced) // an edge without length, collapsed before the loop
      m_announced = {m_slots.slot(profile.v0()), m_slots.slot(profile.v1()), 0.5};
    const Merge m = merge_into(m_slots.slot(kept_vertex), *std::exchange(m_announced, {}));
    m_log.merge(m.removed, m.kept, m.weight,
                to_vector(get(profile.vertex_point_map(), kept_vertex)));
  }

  void on_finished() const {}
  void on_stop_condition_reached() const {}
  void on_selected() const {}
  void on_non_collapsable() const {}

  const Slots& slots() const { return m_slots; }
  const Collapse_log& log() const { return m_log; }

private:
  using Merge = Spectral_geometry::Merge_forest::Merge;

  const TriangleMesh* m_mesh;
  Slots m_slots;
  Collapse_log m_log;
  std::optional<Merge> m_announced; // the one under way
};

} // namespace internal

/*!
 * A visitor that tracks the restriction P from the input to the simplified mesh under *any* cost
 * and placement, so that Garland-Heckbert, Lindstrom-Turk or a cost of your own can be judged as
 * the spectral one is.
 *
 * When the edge (u, v) is collapsed to x, the value of a function there becomes \f$ (1 - \alpha)
 * F_u + \alpha F_v \f$ with \f$ \alpha = (x - u) \cdot (v - u) / |v - u|^2 \f$ clamped to [0, 1]
 * (appendix A of Lescoat et al., *Spectral Mesh Simplification*, Computer Graphics Forum 39(2),
 * 2020), and 1/2 on an edge without length. P is the product of these steps.
 *
 * \code
 * SMS::Restriction_visitor visitor(mesh);
 * SMS::edge_collapse(mesh, stop,
 * CGAL::parameters::get_cost(cost).get_placement(placement).visitor(visitor));
 * Eigen::SparseMatrix<double> P = visitor.restriction();
 * \endcode
 *
 * \cgalModels{EdgeCollapseSimplificationVisitor}
 *
 * The object is a handle: copies, those that `edge_collapse()` makes included, share what is
 * tracked. The mesh must outlive it and must not be given new vertices. A second `edge_collapse()`
 * with the same visitor continues, and P still starts at the mesh of the constructor. Constant time
 * and memory per collapse. `Spectral_policies` tracks its own P: it needs no such visitor.
 *
 * @tparam TriangleMesh a model of `MutableFaceGraph` with support for dynamic vertex properties
 * @tparam UserVisitor a visitor to which every call is forwarded after this one has done its part.
 *         It is copied, as `edge_collapse()` itself copies visitors; pass a
 *         `std::reference_wrapper` to share it
 */
template <class TriangleMesh, class UserVisitor = internal::Dummy_visitor>
class Restriction_visitor
  : public internal::Following_visitor<internal::Restriction_tracker<TriangleMesh>, UserVisitor>
{
  using Tracker = internal::Restriction_tracker<TriangleMesh>;
  using Base = internal::Following_visitor<Tracker, UserVisitor>;

public:
  using Triangle_mesh = TriangleMesh; ///< the type of the mesh
  using User_visitor = UserVisitor;   ///< the type of the visitor to which calls are forwarded

  /// Takes the mesh in its present state as the fine mesh.
  explicit Restriction_visitor(Triangle_mesh& mesh, User_visitor user = User_visitor())
    : Base(std::make_shared<Tracker>(mesh), std::move(user))
  {}

  /// Returns P, coarse x fine: rows in the order of `vertices(mesh)` now, columns in its order at
  /// construction. Rows sum to 1, and columns have at most one nonzero.
  ///
  /// @throws std::logic_error when the mesh has got new vertices
  Eigen::SparseMatrix<double> restriction() const
  {
    return log().forest().restriction(this->m_follower->slots().current());
  }

  /// Returns, for each vertex of the input, the position in `vertices(mesh)` of the vertex that it
  /// was merged into.
  std::vector<std::size_t> vertex_map() const
  {
    return log().forest().vertex_map(this->m_follower->slots().current());
  }

  /// Returns the merges and the points, from which `Collapse_replay` makes every level of detail.
  const Collapse_log& log() const { return this->m_follower->log(); }

  /// as in the concept; throws `std::invalid_argument` for another mesh than that of the
  /// constructor
  void OnStarted(Triangle_mesh& mesh)
  {
    this->m_follower->check_mesh(mesh);
    this->user().OnStarted(mesh);
  }
};

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_RESTRICTION_VISITOR_H
