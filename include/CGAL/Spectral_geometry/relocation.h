// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_RELOCATION_H
#define CGAL_SPECTRAL_GEOMETRY_RELOCATION_H

#include <CGAL/Spectral_geometry/Relocation_options.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/separate_compilation.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/*!
moves the vertices of a coarse mesh so that its Laplace-Beltrami operator agrees better with that of
a fine one. The triangles stay; with `sampled` signals the result has a new restriction.

L-BFGS over all positions lowers the part of the residual of the metric (Eq. 2 of Lescoat et al.
2020) that the functional map sees, see `Relocation_energy`. Guards are on by default. No triangle
is inverted or degenerates, and no new self-intersection appears. Total area, volume and the
eigenvalues beyond K are kept. No fine vertex gets further away than the furthest was at the start.
No vertex leaves the place its signals were taken from, and boundary vertices stay on the boundary.
The mesh may come from an edge collapse, with its restriction, or from a remesher, with
`closest_point_restriction()`.

This residual does not protect the coarse eigenvalues beyond K: their modes meet signals of lower
eigenvalues only, and each term \f$ (\lambda_j - \widetilde\lambda_i)^2 C_{ij}^2 \f$ falls when \f$
\widetilde\lambda_i \f$ does, although these eigenvalues are too low already. The term of the
spectrum therefore keeps the mean of the next K / 2 from falling, and raises it towards fine
eigenvalues beyond K that are given. This needs the lowest 1.5 K eigenpairs of the coarse mesh and
16 more, found once and updated every ten steps, or every five with eigenvalues as goals and K up to
256.

Nor does the residual fix the directions of low eigenvectors, on which biharmonic distances depend
most. At most twelve of them are kept from rotating into each other. This needs sampled signals, and
eigenpairs and eigenvalues of the fine mesh.

A further term draws the surfaces together where they lie furthest apart,
`Relocation_options::hausdorff_goal`. The spectrum hardly sees these places.

Nor does the residual control how area is spread over the mesh, on which distances and heat kernels
depend. Inner products of `sampled` signals are therefore drawn to those on the fine mesh, see
`Relocation_energy::keep_inner_products()`. This is left out with coefficients, since the density of
the fine mesh is not known here, and if `smoothing` is 0.

Made for the averaged mass. With the lumped mass (theta = 0) the leading error of the elements is as
large as what is to be repaired, and a descent cancels it by distorting the shape.

@param V      coarse x 3, the positions, changed in place
@param T      the triangles of the coarse mesh
@param P      coarse x fine, the restriction
@param fine   the fine mesh
@param F, Z   fine x K, the signals and B^-1 L F; for eigenvectors Phi and Phi Lambda
@param op     the operator, with coefficients for the coarse vertices or none; a mass by name, or
the weight theta of the consistent mass
@param fixed  for each coarse vertex whether it must stay; empty: none
@param options what to minimise, guards, when to stop

Throws `std::invalid_argument` for matrices that do not belong together, an index, a number or an
option out of range, and `Cancelled` when it is cancelled. V is then as it was. Returns what was
done, with the restriction to use.
*/
CGAL_SPECTRAL_GEOMETRY_INLINE Relocation_result
relocate_positions(Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                   const Eigen::SparseMatrix<double>& P, const Mesh_matrices& fine,
                   const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z, const Local_operator& op,
                   const std::vector<bool>& fixed = {}, const Relocation_options& options = {});

/// @}

namespace internal {

/// Relocates within other limits; the arguments have been checked.
CGAL_SPECTRAL_GEOMETRY_INLINE Relocation_result
relocate_within(Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const Eigen::SparseMatrix<double>& P,
                const Mesh_matrices& fine, const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z,
                const Local_operator& op, const std::vector<bool>& fixed,
                const Relocation_options& options, const Relocation_limits& limits);

} // namespace internal

} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_GEOMETRY_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_GEOMETRY)

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/internal/numerics/Eigen_problem.h>
#include <CGAL/Spectral_geometry/internal/numerics/product.h>
#include <CGAL/Spectral_geometry/internal/relocation/Guarded_descent.h>
#include <CGAL/Spectral_geometry/internal/relocation/Relocation_guards.h>
#include <CGAL/Spectral_geometry/internal/relocation/Relocation_objective.h>
#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>

#include <CGAL/Real_timer.h>

namespace CGAL::Spectral_geometry {
namespace internal {

/// One relocation from the set-up of its objective to the repair at its end.
class Relocation
{
public:
  using Positions = Operator_geometry::Positions;

  Relocation(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
             const Eigen::SparseMatrix<double>& P, const Mesh_matrices& fine,
             const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z, const Local_operator& op,
             const std::vector<bool>& fixed, const Relocation_options& options,
             const Relocation_limits& limits)
    : m_options(options)
    , m_limits(limits)
    , m_given(V)
    , m_T(T)
    , m_on_border(border_vertices(T, V.rows()))
    , m_fine(fine)
    , m_P(P)
    , m_F(F)
    , m_Z(Z)
    , m_op(op)
    , m_timer(started())
    , m_border(fine)
    , m_coarse{V, T}
    , m_regions(m_coarse, fine, P)
    , m_closest(fine)
    , m_followed(m_closest, m_regions, std::size_t(V.rows()))
    , m_start(first_positions(fixed))
    , m_guards(m_given, m_start, T, Positions(P * fine.V), limits, options.threads)
    , m_size(T, m_start, fine, limits.size_tolerance)
    , m_sampled(fine, m_followed, F, Z, options.threads)
    , m_times_back(std::size_t(V.rows()), 0)
  {
    set_guards(fixed);
    set_objective();
    if(m_options.keep_free_of_self_intersections)
      m_crossing = self_intersecting_faces(m_start, m_T);
    m_distance = distance_term(m_start);
    if(m_distance)
      m_objective->keep_near(*m_distance);
  }

  bool keeps_inner_products() const { return m_keeps_inner_products; }

  Positions run(Relocation_result& result)
  {
    check_areas();
    Descent descent(*m_objective, m_guards,
                    0.05 * std::sqrt(m_size.area() / double(m_start.rows())));
    result.E_before = m_objective->E(m_given);
    result.norm_before = norm(m_given, m_P);
    const bool nothing_to_gain = result.norm_before == 0;
    Positions V = m_start;
    m_guards.admit(m_start, V); // boundary vertices go to the boundary
    descent.start(V);
    result.objective_before = descent.value();
    if(!nothing_to_gain)
      result.stop_reason = descend(descent, result.steps);
    result.objective_after = descent.value();
    V = repaired(descent.positions());
    result.resampled = m_options.signals == Signals::sampled;
    result.restriction = m_P;
    if(result.resampled) {
      result.restriction = m_regions.restriction(m_closest, V);
      keep_border_rows_on_border(result.restriction, V);
    }
    result.norm_after = norm(V, result.restriction);
    if(nothing_to_gain || result.norm_after > result.norm_before) {
      result.stop_reason = Stop_reason::no_gain;
      V = m_start;
      result.norm_after = m_start == m_given ? result.norm_before : norm(V, m_P);
      if(result.norm_after > result.norm_before) {
        V = m_given;
        result.norm_after = result.norm_before;
      }
      result.resampled = false;
      result.restriction = m_P;
    }
    result.held = m_guards.held();
    result.reverted_vertices = m_reverted;
    result.held.fixed -= m_reverted;
    result.E_after = m_objective->E(V);
    for(Eigen::Index v = 0; v < V.rows(); ++v)
      result.moved_vertices += V.row(v) != m_given.row(v);
    result.seconds = m_timer.time();
    return V;
  }

private:
  static Real_timer started()
  {
    Real_timer timer;
    timer.start();
    return timer;
  }

  using Signals = Relocation_options::Signals;
  using Stop_reason = Relocation_result::Stop_reason;
  using Descent = Guarded_descent<Relocation_objective, Relocation_guards>;

  void check_areas() const
  {
    const Positions& V = m_start;
    for(Eigen::Index f = 0; f < m_T.rows(); ++f)
      require(triangle_cotangents(V.row(m_T(f, 0)), V.row(m_T(f, 1)), V.row(m_T(f, 2))).area > 0,
              "relocation: ", face_name(f), " of the coarse mesh has no area; remove it.");
  }

  // With more modes their eigenvectors are updated every ten steps, not every five: the cost of an
  // update is cubic. With K = 400 a run takes 0.75 of the time, and errors of eigenvalues are 1.06
  // times as large (four meshes).
  static constexpr Eigen::Index modes_updated_often = 256;

  // The objective changes with its goals at each update: so the gains of the steps are summed.
  Stop_reason descend(Descent& descent, int& steps)
  {
    const bool often = m_objective->has_goals() && m_options.modes <= modes_updated_often;
    double last = descent.value(), gained = 0;
    while(steps < m_options.maximum_steps) {
      report_to(m_options, {Phase::relocation, double(steps) / double(m_options.maximum_steps)});
      if(!(m_timer.time() < m_options.maximum_seconds))
        return Stop_reason::seconds;
      if(!descent.step())
        return Stop_reason::no_descent;
      gained += last - descent.value();
      if(++steps % 10 == 0) {
        if(gained < m_limits.relative_decrease * (descent.value() + gained))
          return Stop_reason::converged;
        gained = 0;
        if(steps < m_options.maximum_steps) {
          const Positions repaired_so_far = repaired(descent.positions());
          const bool refreshed = m_objective->refresh(repaired_so_far);
          if(repaired_so_far != descent.positions())
            descent.go_on_from(repaired_so_far);
          else if(refreshed)
            descent.refresh();
        }
      } else if(often && steps % 5 == 0 && m_objective->refresh(descent.positions()))
        descent.refresh();
      last = descent.value();
    }
    return Stop_reason::steps;
  }

  // A border vertex gets its row from the closest point of those border loops that its row of P
  // came from. If it came from none, the row stays.
  void keep_border_rows_on_border(Eigen::SparseMatrix<double>& P, const Positions& V) const
  {
    std::vector<char> on_border = m_on_border;
    const auto own = m_border.loops_of_rows(m_P);
    std::vector<Eigen::Triplet<double>> entries;
    for(std::size_t w = 0; w < own.size(); ++w) {
      on_border[w] = on_border[w] && !own[w].empty();
      if(!on_border[w])
        continue;
      const auto point = m_border.closest(V.row(Eigen::Index(w)), [&](const std::size_t segment) {
        return own[w].count(m_border.loop(segment)) != 0;
      });
      const auto [i, j] = m_border.segment(point.segment);
      if(point.weight < 1)
        entries.emplace_back(int(w), i, 1 - point.weight);
      if(point.weight > 0)
        entries.emplace_back(int(w), j, point.weight);
    }
    Eigen::SparseMatrix<double> rows(P.rows(), P.cols());
    rows.setFromTriplets(entries.begin(), entries.end());
    P.prune([&](const Eigen::Index row, Eigen::Index, double) { return !on_border[row]; });
    P += rows;
  }

  // |C|_L (Eq. 3) of both meshes at unit area, for signals of any kind: || A D - A~ Lambda~ C || /
  // || C ||, where C and D are Phi~^T B~ P F and Phi~^T B~ P Z. 0 if a vertex without mass leaves
  // no modes, or if signals that are constant on each component leave only rounding.
  double norm(const Positions& V, const Eigen::SparseMatrix<double>& P) const
  {
    const Laplace_operator op = laplace_operator(V, m_T, m_op);
    const Eigenpairs* const fine_pairs = m_options.eigenpairs;
    const Eigen::Index modes = (std::min)(fine_pairs != nullptr ? fine_pairs->size()
                                          : m_options.modes > 0 ? m_options.modes
                                                                : m_F.cols(),
                                          V.rows() - op.vanishing);
    if(modes < 1 || !(op.mass.minCoeff() > 0))
      return 0;
    Eigenpairs_options options = Eigenpairs_options::with_tolerance(1e-3);
    options.verify = false;
    options.threads = m_options.threads;
    options.cancel = m_options.cancel;
    const Eigenpairs pairs = eigenpairs(op, modes, options);
    const Eigen::MatrixXd BPhi = op.B * pairs.vectors;
    Eigen::MatrixXd C, D;
    if(fine_pairs != nullptr) {
      C = BPhi.transpose() * (P * fine_pairs->vectors.leftCols(modes));
      D = C * fine_pairs->values.head(modes).asDiagonal();
    } else {
      C = BPhi.transpose() * (P * m_F);
      D = BPhi.transpose() * (P * m_Z);
    }
    const auto [area, fine_area] = m_size.areas(V);
    const double result = (fine_area * D - area * (pairs.values.asDiagonal() * C)).norm() /
                          (std::max)(C.norm(), (std::numeric_limits<double>::min)());
    return result > 1e-6 * area * pencil_shift(op) ? result : 0.;
  }

  // Returns the term with the distances from V, or null if there is no goal.
  std::unique_ptr<Distance_term> distance_term(const Positions& V) const
  {
    if(!std::isfinite(m_options.hausdorff_goal))
      return nullptr;
    return std::make_unique<Distance_term>(m_fine, m_regions.fine_vertices(), m_closest, m_T, V,
                                           m_options.hausdorff_goal, m_options.threads);
  }

  bool is_near_border(const int v, const std::size_t s) const
  {
    const auto [i, j] = m_border.segment(s);
    return m_regions.are_near(v, i) || m_regions.are_near(v, j);
  }

  // Returns the given positions, except for two kinds of vertices. Boundary vertices go to the
  // boundary of the fine mesh, since collapses draw them off it. Vertices to which another limb is
  // nearer go to the closest point of their own. A vertex stays if a triangle would turn over,
  // become a needle or go through another one; off the boundary also if the fine surface would be
  // left behind. It may get there later.
  Positions first_positions(const std::vector<bool>& fixed)
  {
    Positions V = m_given;
    const std::vector<Eigen::Index> face_of = faces_at_vertices(m_T, V.rows());
    const auto loops = m_border.loops_of_rows(m_P);
    bool beside = false; // whether a vertex off the boundary is elsewhere
    for(Eigen::Index v = 0; v < V.rows(); ++v) {
      if(face_of[v] < 0 || (!fixed.empty() && fixed[v]))
        continue;
      if(!m_on_border[v]) {
        if(m_options.signals != Signals::carried &&
           m_followed.is_beside_another_part(v, V.row(v))) {
          V.row(v) = m_followed(v, V.row(v)).point.transpose();
          beside = true;
        }
        continue;
      }
      if(m_options.fix_boundary || m_border.is_empty())
        continue;
      Border_polyline::Point point = m_border.closest(
          V.row(v), [&](const std::size_t s) { return is_near_border(int(v), s); });
      if(!point.exists())
        point = m_border.closest(
            V.row(v), [&](const std::size_t s) { return loops[v].count(m_border.loop(s)) != 0; });
      if(point.exists())
        V.row(v) = point.position.transpose();
    }
    if(V == m_given)
      return V;
    const Relocation_guards shapes(m_given, m_given, m_T, m_given, m_limits, m_options.threads);
    const std::unique_ptr<Distance_term> distance = beside ? distance_term(m_given) : nullptr;
    Face_pairs crossing;
    if(m_options.keep_free_of_self_intersections)
      crossing = self_intersecting_faces(m_given, m_T);
    for(bool back = true; back;) { // fewer vertices are elsewhere in each round
      back = false;
      const auto go_back = [&](const Eigen::Index f, const bool from_boundary = true) {
        for(const int v : m_T.row(f))
          if(V.row(v) != m_given.row(v) && (from_boundary || !m_on_border[v])) {
            V.row(v) = m_given.row(v);
            back = true;
          }
      };
      for(Eigen::Index f = 0; f < m_T.rows(); ++f)
        if(!shapes.legal(f, V))
          go_back(f);
      if(!back && m_options.keep_free_of_self_intersections)
        for(const auto& pair : self_intersecting_faces(V, m_T))
          if(!std::binary_search(crossing.begin(), crossing.end(), pair)) {
            go_back(pair.first);
            go_back(pair.second);
          }
      if(!back && distance)
        distance->for_each_face_left_behind(V, [&](const Eigen::Index f) { go_back(f, false); });
    }
    return V;
  }

  void set_guards(const std::vector<bool>& fixed)
  {
    for(Eigen::Index v = 0; v < m_start.rows(); ++v)
      if((!fixed.empty() && fixed[v]) || (m_on_border[v] && m_options.fix_boundary))
        m_guards.fix(v);
      else if(m_on_border[v])
        m_guards.keep_on(v, m_border,
                         [&](const std::size_t s) { return is_near_border(int(v), s); });
    if(m_options.signals != Signals::carried) {
      std::vector<char> beside(std::size_t(m_start.rows()));
      for(Eigen::Index v = 0; v < m_start.rows(); ++v)
        beside[v] = m_followed.is_beside_another_part(v, m_start.row(v));
      m_guards.set_leaps([this, beside](const Eigen::Index v, const Eigen::Vector3d& from,
                                        const Eigen::Vector3d& to) {
        return m_followed.leaps(v, from, to) ||
               (!beside[v] && m_followed.is_beside_another_part(v, to));
      });
    }
  }

  void set_objective()
  {
    const double largest =
        std::sqrt((m_Z.colwise().squaredNorm().array() /
                   m_F.colwise().squaredNorm().array().max((std::numeric_limits<double>::min)()))
                      .maxCoeff());
    const double tau = largest > 0 ? m_options.smoothing / largest : 0.;
    Surface_signals* const sampled = m_options.signals == Signals::carried ? nullptr : &m_sampled;
    Spectrum_term::Fine_modes fine_modes;
    if(sampled && m_options.eigenpairs != nullptr)
      fine_modes = [this](const Positions& V, const Eigen::Index count) {
        const Eigen::MatrixXd& Phi = m_options.eigenpairs->vectors;
        Eigen::MatrixXd result(V.rows(), (std::min)(count, Phi.cols()));
        for(Eigen::Index w = 0; w < V.rows(); ++w) {
          const Closest_point_query::Answer closest = m_followed(w, V.row(w));
          result.row(w).setZero();
          for(int k = 0; k < 3; ++k)
            result.row(w) +=
                closest.weights(k) * Phi.row(m_fine.T(closest.face, k)).leftCols(result.cols());
        }
        return result;
      };
    m_objective = std::make_unique<Relocation_objective>(
        m_T, product(m_P, m_F, m_options.threads), product(m_P, m_Z, m_options.threads), m_op,
        m_size, m_start, sampled, m_options.signals != Signals::sampled, tau, fine_modes, m_options,
        m_limits);
    m_keeps_inner_products =
        m_limits.keep_inner_products && sampled && tau > 0 && m_op.coefficients.rows() == 0;
    if(m_keeps_inner_products)
      m_objective->keep_inner_products(mass_of_fine(), m_F, m_Z);
  }

  // A third of each face at its corners; `barycentric_corner_masses()` refuses needles.
  Eigen::VectorXd mass_of_fine() const
  {
    Eigen::VectorXd mass = Eigen::VectorXd::Zero(m_fine.V.rows());
    for(Eigen::Index f = 0; f < m_fine.T.rows(); ++f)
      for(const int v : m_fine.T.row(f))
        mass(v) += face_normal(m_fine.V, m_fine.T, f).norm() / 6;
    return mass;
  }

  // Moves vertices back where triangles that were apart meet or the fine surface is left behind,
  // and all vertices while the size is out of bounds. Vertices that go back in two rounds then
  // stay, and the others move around them. With one round |C|_D is 1.02 times as large.
  Positions repaired(Positions V)
  {
    for(int round = 0;; ++round) {
      std::vector<char> back(std::size_t(V.rows()), 0);
      if(m_options.keep_free_of_self_intersections)
        for(const auto& pair : self_intersecting_faces(V, m_T))
          if(!std::binary_search(m_crossing.begin(), m_crossing.end(), pair))
            mark_faces({pair.first, pair.second}, back);
      if(m_distance)
        m_distance->for_each_face_left_behind(V,
                                              [&](const Eigen::Index f) { mark_faces({f}, back); });
      const bool any = std::count(back.begin(), back.end(), 1) != 0, too_large = !m_size.within(V);
      if(!any && !too_large)
        break;
      if(round >= 24) { // single vertices going back have put others in the way
        std::fill(back.begin(), back.end(), 1);
        V = m_start;
      }
      for(Eigen::Index v = 0; v < V.rows(); ++v) {
        if(too_large || back[v]) {
          // Half way back, a boundary vertex would lie off the boundary.
          const double kept = round < 12 && !m_guards.is_on_boundary(v) ? 0.6 : 0.;
          V.row(v) = m_start.row(v) + kept * (V.row(v) - m_start.row(v));
        }
        if(back[v] && !m_guards.is_fixed(v) && ++m_times_back[v] == 2) {
          ++m_reverted;
          m_guards.fix(v);
        }
      }
      m_guards.admit_without_projection(m_start, V);
      if(round >= 24)
        break;
    }
    return V;
  }

  void mark_faces(const std::initializer_list<Eigen::Index> faces, std::vector<char>& marks) const
  {
    for(const Eigen::Index f : faces)
      for(const int v : m_T.row(f))
        marks[v] = 1;
  }

  Relocation_options m_options;
  Relocation_limits m_limits;
  Positions m_given;
  Eigen::MatrixXi m_T;
  std::vector<char> m_on_border; // by coarse vertex
  const Mesh_matrices& m_fine;
  const Eigen::SparseMatrix<double>& m_P;
  const Eigen::MatrixXd &m_F, &m_Z;
  Local_operator m_op;
  Real_timer m_timer;
  Border_polyline m_border; // of the fine mesh
  Mesh_matrices m_coarse;   // as given
  Surface_regions m_regions;
  Closest_point_query m_closest; // on the fine mesh
  Followed_closest_points m_followed;
  Positions m_start; // where the descent begins
  Relocation_guards m_guards;
  Size_bounds m_size;
  Surface_signals m_sampled;
  std::vector<int> m_times_back; // of each vertex, in rounds
  std::unique_ptr<Relocation_objective> m_objective;
  std::unique_ptr<Distance_term> m_distance; // where there is a goal
  Face_pairs m_crossing;                     // at the start
  std::size_t m_reverted = 0;                // vertices that went back, and stay
  bool m_keeps_inner_products = false;
};

CGAL_SPECTRAL_GEOMETRY_INLINE Relocation_result
relocate_within(Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const Eigen::SparseMatrix<double>& P,
                const Mesh_matrices& fine, const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z,
                const Local_operator& op, const std::vector<bool>& fixed,
                const Relocation_options& options, const Relocation_limits& limits)
{
  Relocation_result result;
  Eigen::MatrixXd moved;
  bool keeps_inner_products;
  { // what a second relocation needs memory for
    Relocation relocation(V, T, P, fine, F, Z, op, fixed, options, limits);
    moved = relocation.run(result);
    keeps_inner_products = relocation.keeps_inner_products();
  }
  // Little gained: again, without inner products and with less and less weight of the eigenvalues.
  const bool eigenvalues = options.eigenvalues.size() > 0 && limits.eigenvalue_error > 0;
  const Eigen::Index K = options.modes > 0 ? options.modes : F.cols();
  const bool gained =
      result.stop_reason != Relocation_result::Stop_reason::no_gain &&
      result.norm_after < (V.rows() < 4 * K ? 1. : limits.gain) * result.norm_before;
  if(!gained && result.norm_before > 0 && (keeps_inner_products || eigenvalues)) {
    Relocation_options without = options;
    Relocation_limits fewer = limits;
    fewer.keep_inner_products = false;
    fewer.eigenvalue_error *= keeps_inner_products            ? std::sqrt(2.)
                              : limits.eigenvalue_error < 0.1 ? 2.
                                                              : 0.;
    without.maximum_seconds = (std::max)(0., options.maximum_seconds - result.seconds);
    if(options.progress) // a fraction never decreases
      without.progress = [&](const Progress&) { return options.progress({Phase::relocation, 1.}); };
    Eigen::MatrixXd anew = V;
    Relocation_result second = relocate_within(anew, T, P, fine, F, Z, op, fixed, without, fewer);
    const double seconds = result.seconds + second.seconds;
    if(second.norm_after < result.norm_after) {
      result = std::move(second);
      moved.swap(anew);
    }
    result.seconds = seconds;
  }
  V = moved;
  return result;
}

} // namespace internal

CGAL_SPECTRAL_GEOMETRY_INLINE Relocation_result relocate_positions(
    Eigen::MatrixXd& V, const Eigen::MatrixXi& T, const Eigen::SparseMatrix<double>& P,
    const Mesh_matrices& fine, const Eigen::MatrixXd& F, const Eigen::MatrixXd& Z,
    const Local_operator& op, const std::vector<bool>& fixed, const Relocation_options& options)
{
  using internal::require;
  internal::check_pair({V, T}, fine, P, "relocation: ");
  require(F.rows() == P.cols() && Z.rows() == P.cols() && Z.cols() == F.cols() && F.cols() > 0,
          "relocation: F is ", internal::size_name(F), " and Z ", internal::size_name(Z),
          "; pass two matrices with one row for each of the ", P.cols(),
          " fine vertices and one column for each signal.");
  require(F.allFinite() && Z.allFinite(),
          "relocation: F or Z has an entry that is not a finite number; correct it.");
  require(options.modes <= P.cols(), "relocation: modes is ", options.modes,
          " where the fine mesh has ", P.cols(), " vertices; pass K, or 0.");
  require(options.eigenpairs == nullptr || options.eigenpairs->vectors.rows() == P.cols(),
          "relocation: the eigenpairs are not of the fine mesh, which has ", P.cols(),
          " vertices.");
  require(options.eigenpairs == nullptr ||
              (options.eigenpairs->size() != 0 &&
               options.eigenpairs->vectors.cols() == options.eigenpairs->size()),
          "relocation: the eigenpairs do not have one vector for each value, or are none; pass "
          "those of the fine mesh.");
  require(fixed.empty() || Eigen::Index(fixed.size()) == V.rows(),
          "relocation: the list of fixed vertices has ", fixed.size(), " entries for ", V.rows(),
          " vertices; pass one for each, or none.");
  for(const Eigen::MatrixXd* const positions : {&fine.V, &std::as_const(V)})
    require(internal::extent_is_usable(internal::extent_of(*positions)),
            "relocation: the coordinates of a mesh are not between 1e-50 and 1e50 in magnitude; "
            "rescale both meshes.");
  internal::check_relocation_options(options);
  return internal::relocate_within(V, T, P, fine, F, Z, op, fixed, options, {});
}

} // namespace CGAL::Spectral_geometry

#endif // definitions

#endif // CGAL_SPECTRAL_GEOMETRY_RELOCATION_H
