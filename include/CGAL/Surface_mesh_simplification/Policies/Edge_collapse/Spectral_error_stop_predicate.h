// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_ERROR_STOP_PREDICATE_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_ERROR_STOP_PREDICATE_H

#include <CGAL/Spectral_geometry/internal/basics.h>

namespace CGAL::Surface_mesh_simplification {

/// \addtogroup PkgSpectralMeshSimplificationPolicies
/// @{

/*!
 * Stops before the collapse that would raise the relative error above a bound, so that the mesh is
 * as coarse as the greedy order makes it within that bound.
 *
 * \cgalModels{StopPredicate}
 *
 * \code
 * SMS::Spectral_policies spectral(mesh);
 * SMS::Spectral_error_stop_predicate stop(spectral, 0.14);
 * \endcode
 *
 * The error is \f$ \epsilon = \sqrt{E / \sum_k \lambda_k^2} \f$,
 * `Spectral_policies::relative_error()`: 0 for the input, independent of its scale and size, and
 * for the lumped mass an upper bound of the commutativity norm,
 * \f$ |C|_L \le \epsilon \sqrt{\sum_k \lambda_k^2} / |C| \f$ (section 4 and appendix B of
 * Lescoat et al. 2020).
 *
 * *Choosing the bound.* With Weyl's law, \f$ \lambda_k \approx 4 \pi k \f$ at unit area, and \f$
 * |C| \approx \sqrt K \f$: \f$ |C|_L \le 7.3 K \epsilon \f$. In practice the norm is a tenth of
 * that at 48 K vertices, four tenths at 12 K and eight tenths at 6 K; below about 4 K vertices |C|
 * is smaller and the estimate fails. Measured with K = 100, on_edge (rocker-arm.obj, 10,044
 * vertices, lumped mass; homer.obj, 6,002, averaged):
 *
 * | vertices / K                 | 48    | 24   | 12   | 6    | 3    |
 * |------------------------------|-------|------|------|------|------|
 * | error, lumped                | 0.090 | 0.12 | 0.14 | 0.15 | 0.17 |
 * | mean eigenvalue error        | 0.3 % | 1.3 % | 3.3 % | 7.0 % | 15 % |
 * | error, averaged              | 0.055 | 0.11 | 0.14 | 0.16 | 0.16 |
 * | mean eigenvalue error        | 0.2 % | 0.5 % | 0.8 % | 1.9 % | 6.7 % |
 *
 * So 0.1 keeps the spectrum closely and 0.14 well; 0.16 is about the largest error that the metric
 * sees. Near 3 K vertices the error reaches its largest value and then *falls*, because signals
 * that are averaged out on both sides of Eq. 2 no longer differ. A bound above that value never
 * stops a run: use `Spectral_stop_predicate` with a number of vertices as well, for instance 3 K.
 *
 * The result keeps the bound to rounding, except for edges without length, which are merged before
 * any predicate is called. The predicate needs the visitor of the policies and, if the placement is
 * wrapped, the wrapper.
 *
 * @tparam Policies a `Spectral_policies`; deduced
 * @tparam GetPlacement the placement that `edge_collapse()` gets; deduced
 */
template <class Policies, class GetPlacement = typename Policies::Get_placement>
class Spectral_error_stop_predicate
{
public:
  /// @param policies those of the run
  /// @param maximum_error the bound, from 0; another number throws `std::invalid_argument`
  Spectral_error_stop_predicate(const Policies& policies, const double maximum_error)
    : Spectral_error_stop_predicate(policies, maximum_error, policies.get_placement())
  {}

  /// Takes a placement that wraps that of the policies, `Constrained_placement` for instance.
  Spectral_error_stop_predicate(const Policies& policies, const double maximum_error,
                                const GetPlacement& placement)
    : m_state(policies.shared_state())
    , m_placement(placement)
    , m_bound(maximum_error)
  {
    internal::require(maximum_error >= 0, "Spectral_error_stop_predicate: the bound is ",
                      maximum_error, ", use a number from 0.");
  }

  /// whether to stop before the collapse of the selected candidate
  template <class Cost, class Profile>
  bool operator()(const Cost&, const Profile& profile, std::size_t, std::size_t) const
  {
    // A ten-thousandth of a per cent aside, so that rounding does not lift the result over the
    // bound.
    return m_state->relative_error_after(profile, m_placement) * (1 + 1e-6) > m_bound;
  }

private:
  std::shared_ptr<typename Policies::State> m_state;
  GetPlacement m_placement;
  double m_bound;
};

/// @}

} // namespace CGAL::Surface_mesh_simplification

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_SPECTRAL_ERROR_STOP_PREDICATE_H
