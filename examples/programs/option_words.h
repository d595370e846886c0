// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_OPTION_WORDS_H
#define SPECTRAL_EXAMPLES_OPTION_WORDS_H

#include <CGAL/Surface_mesh_simplification/Spectral_edge_collapse_options.h>
#include <CGAL/Spectral_toolbox/intrinsic_delaunay.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

// A value and the word for it on the command line, in Python and in JSON.
template <class Value>
struct Word
{
  Value value;
  const char* word;
};

inline constexpr Word<CGAL::Surface_mesh_simplification::Spectral_placement_strategy>
    placement_words[] = {
        {CGAL::Surface_mesh_simplification::Spectral_placement_strategy::on_edge, "on_edge"},
        {CGAL::Surface_mesh_simplification::Spectral_placement_strategy::midpoint, "midpoint"},
        {CGAL::Surface_mesh_simplification::Spectral_placement_strategy::free, "free"}};

inline constexpr Word<CGAL::Spectral_geometry::Relocation_options::Signals> relocation_words[] = {
    {CGAL::Spectral_geometry::Relocation_options::Signals::sampled, "sampled"},
    {CGAL::Spectral_geometry::Relocation_options::Signals::carried, "carried"},
    {CGAL::Spectral_geometry::Relocation_options::Signals::carried_and_sampled,
     "carried_and_sampled"}};

inline constexpr Word<CGAL::Spectral_geometry::Mass> mass_words[] = {
    {CGAL::Spectral_geometry::Mass::lumped, "lumped"},
    {CGAL::Spectral_geometry::Mass::averaged, "averaged"},
    {CGAL::Spectral_geometry::Mass::voronoi, "voronoi"},
    {CGAL::Spectral_geometry::Mass::consistent, "consistent"}};

inline constexpr Word<CGAL::Spectral_geometry::Boundary_condition> boundary_words[] = {
    {CGAL::Spectral_geometry::Boundary_condition::neumann, "neumann"},
    {CGAL::Spectral_geometry::Boundary_condition::dirichlet, "dirichlet"}};

inline constexpr Word<CGAL::Spectral_geometry::Phase> phase_words[] = {
    {CGAL::Spectral_geometry::Phase::pre_simplification, "pre_simplification"},
    {CGAL::Spectral_geometry::Phase::eigenpairs, "eigenpairs"},
    {CGAL::Spectral_geometry::Phase::first_costs, "first_costs"},
    {CGAL::Spectral_geometry::Phase::collapses, "collapses"},
    {CGAL::Spectral_geometry::Phase::relocation, "relocation"}};

template <class Value, std::size_t n>
const char* word_of(const Word<Value> (&words)[n], const Value value)
{
  for(const Word<Value>& w : words)
    if(w.value == value)
      return w.word;
  throw std::logic_error("word_of: a value has no word; add it to the table.");
}

template <class Value, std::size_t n>
Value value_of(const Word<Value> (&words)[n], const std::string& word)
{
  for(const Word<Value>& w : words)
    if(w.word == word)
      return w.value;
  throw std::logic_error("value_of: '" + word +
                         "' is not in the table; check it where it is read.");
}

// All words of a table, after those that stand for no value of it.
template <class Value, std::size_t n>
std::vector<std::string> words_of(const Word<Value> (&words)[n], std::vector<std::string> all = {})
{
  for(const Word<Value>& w : words)
    all.push_back(w.word);
  return all;
}

// "none" where nothing is relocated.
inline const char*
relocation_word(const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options& options)
{
  return options.relocate ? word_of(relocation_words, options.relocation.signals) : "none";
}

// The words in which the command line and Python speak of options; who reads them has checked that
// they are among these.
struct Option_words
{
  std::string preset;       // best, fast, paper
  std::size_t vertices = 0; // the target, for fast
  // Empty: as the preset has it, or the default.
  std::string placement;          // on_edge, midpoint, free
  std::string mass;               // lumped, averaged, voronoi, consistent
  std::string self_intersections; // allow, refuse
  std::string relocate;           // none, sampled, carried, carried_and_sampled
  std::string prefer;             // spectrum, shape
  std::optional<double> shape;
  std::optional<double> quadrics_above;
};

// Whether these options have no use for quadrics_above, which was given; `said` says what to do
// about it.
inline bool quadrics_above_is_passed_over(
    const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options& options,
    std::string& said)
{
  said = " goes with free placement and a shape term, and not with coefficients, a binary "
         "restriction, "
         "a border to preserve, the Dirichlet condition or an error bound, where all collapses are "
         "those of "
         "the metric: "
         "leave it out.";
  return std::isfinite(options.quadrics_above) &&
         !CGAL::Surface_mesh_simplification::internal::quadrics_come_first(options);
}

// Where quadrics stop before the eigenpairs are computed, if only these are to steer: as
// `Spectral_edge_collapse_options::best(vertices)` has it, but 0, never, where quadrics do not come
// first anyway or have to stop earlier.
inline std::size_t first_stage_of_best(
    const CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options& options,
    const std::size_t vertices)
{
  namespace SMS = CGAL::Surface_mesh_simplification;
  const std::size_t result = SMS::Spectral_edge_collapse_options::best(vertices).pre_simplify;
  return SMS::internal::quadrics_come_first(options) &&
                 options.quadrics_above * double(vertices) <= double(result)
             ? result
             : 0;
}

// What an intrinsic triangulation asks for, in the mass of the run.
inline auto intrinsic_operator(const CGAL::Spectral_geometry::Mass mass)
{
  return [mass](const Eigen::MatrixXd& V, const Eigen::MatrixXi& T) {
    return CGAL::Spectral_geometry::intrinsic_delaunay_laplacian(V, T, mass);
  };
}

inline void set_preference(const std::string& prefer,
                           CGAL::Spectral_geometry::Relocation_options& options)
{
  if(prefer == "shape")
    options.hausdorff_goal = 0.5;
}

// The preset and what overrides it.
inline CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options
options_of(const Option_words& words)
{
  namespace SMS = CGAL::Surface_mesh_simplification;
  using Options = SMS::Spectral_edge_collapse_options;
  Options options = words.preset == "paper"  ? Options::paper()
                    : words.preset == "fast" ? Options::fast(words.vertices)
                                             : Options::best();
  if(!words.placement.empty())
    options.placement = value_of(placement_words, words.placement);
  if(!words.mass.empty())
    options.mass = value_of(mass_words, words.mass);
  if(words.shape)
    options.shape = *words.shape;
  if(words.quadrics_above)
    options.quadrics_above = *words.quadrics_above;
  if(!words.self_intersections.empty())
    options.keep_free_of_self_intersections = words.self_intersections == "refuse";
  if(!words.relocate.empty()) {
    options.relocate = words.relocate != "none";
    if(options.relocate)
      options.relocation.signals = value_of(relocation_words, words.relocate);
  }
  set_preference(words.prefer, options.relocation);
  return options;
}

#endif // SPECTRAL_EXAMPLES_OPTION_WORDS_H
