// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_RESTRICTION_H
#define CGAL_SPECTRAL_GEOMETRY_RESTRICTION_H

#include <CGAL/Spectral_geometry/internal/basics.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationTransfer
/// @{

/*!
The fine-to-coarse restriction matrix `P = Q_m ... Q_2 Q_1` of a sequence of vertex merges
(section 3.2 of Lescoat et al. 2020), recorded in constant time per merge.

A *slot* is the index, in `[0, n)`, of a vertex of the fine mesh. The merge of the slot `r`
(removed) into the slot `k` (kept) with weight \f$ \alpha \f$ stands for the matrix `Q` with
\f[ (Q F)_k = (1 - \alpha) F_k + \alpha F_r, \qquad (Q F)_w = F_w \ \mbox{for the other slots}, \f]
after which `r` is gone and `k` remains; later merges may keep or remove it.

Slots merged into one another form disjoint sets, so every fine vertex ends in exactly one coarse
vertex, and `P` has at most one nonzero per column. The merges form a binary forest with a weight on
each arc (\f$ \alpha \f$ for the removed side, \f$ 1 - \alpha \f$ for the kept one). A nonzero of
`P` is the product of the weights from a fine vertex up to its root. The forest is stored as the log
of its merges in order. Reading the log backwards visits every node before its two children, so that
`P` is expanded in linear time, at the end of the log or after any number of its merges, without a
single product of sparse matrices.

Every row of `P` sums to 1. When each weight is 0 or 1, every row holds exactly one nonzero, equal
to 1.

Reference: T. Lescoat, H.-T. D. Liu, J.-M. Thiery, A. Jacobson, T. Boubekeur, M. Ovsjanikov,
*Spectral Mesh Simplification*, Computer Graphics Forum 39(2), 2020.
*/
class Merge_forest
{
public:
  using Index = Eigen::Index;                 ///< of a slot or a merge
  using Matrix = Eigen::SparseMatrix<double>; ///< type of `P`

  /// one merge: `F_kept <- (1 - weight) F_kept + weight F_removed`.
  struct Merge
  {
    Index removed; ///< the slot that is gone
    Index kept;    ///< the slot that goes on
    double weight; ///< alpha, in [0, 1], of the removed slot
  };

  /// the forest of the empty mesh.
  Merge_forest() = default;

  /// `n` slots and no merge: `P` is the identity. Throws `std::invalid_argument` if `n` is
  /// negative.
  explicit Merge_forest(Index n)
  {
    internal::require(n >= 0, "Merge_forest: the number of slots is ", n,
                      ", pass the number of vertices of the fine mesh.");
    m_alive.assign(static_cast<std::size_t>(n), true);
  }

  /*!
  merges the slot `removed` into the slot `kept`: `F_kept <- (1 - weight) F_kept + weight
  F_removed`.

  Constant (amortised) time. Throws `std::invalid_argument`, and changes nothing, if a slot is out
  of range or has been removed before, if both are the same, or if `weight` is not in `[0, 1]`.
  */
  void merge(Index removed, Index kept, double weight)
  {
    check_alive(removed);
    check_alive(kept);
    internal::require(removed != kept, "Merge_forest: slot ", kept,
                      " is merged into itself, pass two different slots.");
    internal::require(weight >= 0 && weight <= 1, "Merge_forest: the weight of slot ", removed,
                      " is ", weight, ", clamp it to [0, 1].");
    m_merges.push_back({removed, kept, weight});
    m_alive[removed] = false;
  }

  /// reserves memory for this many merges in all.
  void reserve(Index number_of_merges) { m_merges.reserve(std::size_t(number_of_merges)); }

  /// number of vertices of the fine mesh, the columns of `P`.
  Index number_of_slots() const { return static_cast<Index>(m_alive.size()); }

  /// number of merges recorded so far.
  Index number_of_merges() const { return static_cast<Index>(m_merges.size()); }

  /// `true` if the slot has not been removed by any merge; `false` for an index out of range.
  bool is_alive(Index slot) const { return slot >= 0 && slot < number_of_slots() && m_alive[slot]; }

  /// the merges in the order in which they happened, from which a run can be replayed.
  const std::vector<Merge>& merges() const { return m_merges; }

  /// returns the slots left after the first `number_of_merges` merges, or after all, ascending.
  std::vector<Index> kept_slots(const std::optional<Index> number_of_merges = {}) const
  {
    const std::vector<bool> alive = alive_after(number_of_merges);
    std::vector<Index> slots;
    for(Index slot = 0; slot < number_of_slots(); ++slot)
      if(alive[slot])
        slots.push_back(slot);
    return slots;
  }

  /*!
  returns `P` (`slots.size()` x `number_of_slots()`): row `i` belongs to the coarse vertex in
  `slots[i]`.

  At most one nonzero per column; zeros (a merge with weight 0 or 1 makes some) are not written.
  Rows sum to 1.

  @param slots every slot that is left after the merges, once, in the order wanted for the rows: for
  a simplified mesh the slots of `vertices(mesh)` in their order, which `collect_garbage()` may
  change.
  @param number_of_merges how many merges of the log are expanded, from 0 (`P` is a permutation) to
  `number_of_merges()`, the default: this gives `P` of any intermediate level of the simplification.

  Throws `std::invalid_argument` if `slots` is not a list of the slots that are left, or if there
  are fewer merges.
  */
  Matrix restriction(const std::vector<Index>& slots,
                     const std::optional<Index> number_of_merges = {}) const
  {
    const Expansion e = expand(slots, number_of_merges);
    std::vector<Eigen::Triplet<double>> entries;
    for(std::size_t s = 0; s < e.row.size(); ++s)
      if(e.weight[s] != 0)
        entries.emplace_back(static_cast<int>(e.row[s]), static_cast<int>(s), e.weight[s]);
    Matrix P(static_cast<Index>(slots.size()), number_of_slots());
    P.setFromTriplets(entries.begin(), entries.end());
    return P;
  }

  /*!
  returns, for every fine vertex, the row of the coarse vertex into which it was merged
  (`number_of_slots()` entries).

  The map is total: a fine vertex whose weight in `P` is zero has a coarse vertex all the same.
  Parameters and exceptions are those of `restriction()`.
  */
  std::vector<std::size_t> vertex_map(const std::vector<Index>& slots,
                                      const std::optional<Index> number_of_merges = {}) const
  {
    const std::vector<Index> row = expand(slots, number_of_merges).row;
    return {row.begin(), row.end()};
  }

private:
  struct Expansion
  {
    std::vector<Index> row;     // the coarse vertex of each slot
    std::vector<double> weight; // and the slot's weight in it
  };

  void check_alive(Index slot) const
  {
    internal::require(slot >= 0 && slot < number_of_slots(), "Merge_forest: slot ", slot,
                      " is not one of the ", number_of_slots(),
                      " vertices of the fine mesh, pass an index in [0, n).");
    internal::require(m_alive[slot], "Merge_forest: slot ", slot,
                      " has been removed by an earlier merge, pass the slot that was kept.");
  }

  std::vector<bool> alive_after(const std::optional<Index> asked_for) const
  {
    const Index n = asked_for.value_or(number_of_merges());
    internal::require(n >= 0 && n <= number_of_merges(), "Merge_forest: ", n,
                      " merges are asked for, pass a number in [0, ", number_of_merges(),
                      "], those that were recorded.");
    std::vector<bool> alive(m_alive.size(), true);
    for(Index i = 0; i < n; ++i)
      alive[m_merges[i].removed] = false;
    return alive;
  }

  Expansion expand(const std::vector<Index>& slots,
                   const std::optional<Index> number_of_merges) const
  {
    const std::vector<bool> alive = alive_after(number_of_merges);
    Expansion e{std::vector<Index>(alive.size(), -1), std::vector<double>(alive.size(), 0.)};
    for(std::size_t i = 0; i < slots.size(); ++i) {
      const Index slot = slots[i];
      const std::size_t s = static_cast<std::size_t>(slot); // large where it is negative
      internal::require(
          s < alive.size() && alive[s] && e.row[s] == -1, "Merge_forest: slot ", slot, " of row ",
          i, " is out of range, removed or listed twice, list each slot that is left once.");
      e.row[s] = static_cast<Index>(i);
      e.weight[s] = 1;
    }
    for(std::size_t s = 0; s < alive.size(); ++s)
      internal::require(!alive[s] || e.row[s] != -1, "Merge_forest: slot ", s,
                        " is left but has no row, list each slot that is left once.");
    // Backwards through the log: before a merge, what is now in `kept` was in `kept` and in
    // `removed`.
    for(Index i = number_of_merges.value_or(this->number_of_merges()); i-- > 0;) {
      const Merge& m = m_merges[i];
      const std::size_t k = static_cast<std::size_t>(m.kept),
                        r = static_cast<std::size_t>(m.removed);
      e.row[r] = e.row[k];
      e.weight[r] = e.weight[k] * m.weight;
      e.weight[k] *= 1 - m.weight;
    }
    return e;
  }

  std::vector<Merge> m_merges;
  std::vector<bool> m_alive;
};

/// @}

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_RESTRICTION_H
