// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Bytes become a small mesh and options; it is simplified, and everything that must hold afterwards
// is checked.
//
//   fuzz_collapse RUNS SEED    random bytes
//   fuzz_collapse FILE...      the bytes of these files
// or, with SPECTRAL_FUZZ and clang, a target of libFuzzer.

#include "../fitted_operator_helpers.h"
#include "../topology.h"
#include "fuzz_input.h"
#include "fuzz_main.h"

#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Restriction_visitor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace spectral_test;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;

// Every cost that CGAL's queue sees is a number.
struct Cost_probe : SMS::internal::Dummy_visitor
{
  explicit Cost_probe(bool& good)
    : good(&good)
  {}
  template <class Profile, class Cost>
  void OnCollected(const Profile&, const Cost& cost)
  {
    *good = *good && cost && std::isfinite(*cost);
  }
  template <class Profile, class Cost>
  void OnSelected(const Profile&, const Cost& cost, std::size_t, std::size_t)
  {
    *good = *good && cost && std::isfinite(*cost);
  }
  bool* good;
};

double largest_cotangent(const shapes::Matrices& mesh)
{
  double result = 0;
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f)
    result = (std::max)(result,
                        SG::triangle_cotangents(mesh.V.row(mesh.T(f, 0)), mesh.V.row(mesh.T(f, 1)),
                                                mesh.V.row(mesh.T(f, 2)))
                            .cot.cwiseAbs()
                            .maxCoeff());
  return result;
}

// What a run says of itself.
struct Outcome
{
  Eigen::SparseMatrix<double> P;
  double E, relative_error;
  const SG::Eigenpairs* pairs;
  SG::Operator_coefficients coefficients;
};

// Whether the metric leaves the pairs of eigenvalue 0 out: P carries the constants of components
// over exactly. Beside needles a solver leaves 1e-6 of other functions in them, of which E would be
// large.
bool pairs_of_constants_are_left_out(const shapes::Matrices& fine, const SG::Laplace_operator& op)
{
  const auto component = SG::internal::connected_components(fine.V.rows(), fine.T);
  return SG::number_of_zero_eigenvalues(op) <=
         1 + *std::max_element(component.begin(), component.end());
}

// E recomputed from whole matrices, with the rounding that cotangents of that size leave in it.
std::string fault_of_E(const shapes::Matrices& coarse, const Outcome& outcome,
                       const shapes::Matrices& fine,
                       const SMS::Spectral_edge_collapse_options& options)
{
  const double worst_angle = (std::max)(largest_cotangent(coarse), largest_cotangent(fine));
  if(!std::isfinite(outcome.E) || !std::isfinite(outcome.relative_error) || outcome.E < 0)
    return "E is " + std::to_string(outcome.E) + ", " + std::to_string(outcome.relative_error) +
           " relative to the signals";
  if(worst_angle > 1e6 || !SG::diagnose_polygon_soup(coarse.V, polygons_of(coarse.T)).usable())
    return "";
  const SG::Local_operator local = SMS::internal::local_operator(options);
  const SG::Laplace_operator op = SG::laplace_operator(fine.V, fine.T, local);
  const bool given = options.signals.size() != 0;
  Basis basis = given ? signal_basis(fine, local, options.signals)
                      : basis_of_pairs(op, *outcome.pairs, local);
  if(!given && SMS::internal::pairs_are_rough(outcome.pairs->residuals))
    basis.Z = signal_basis(fine, local, basis.F)
                  .Z; // as the policies do where needles have left them rough
  if(!given && pairs_of_constants_are_left_out(fine, op)) {
    const Eigen::Index count = (std::min)(SG::number_of_zero_eigenvalues(op), basis.F.cols());
    basis.F.leftCols(count).setZero();
    basis.Z.leftCols(count).setZero();
  }
  const SG::Laplace_operator now = SG::laplace_operator(
      coarse.V, coarse.T, {options.mass, outcome.coefficients, options.boundary});
  const Eigen::SparseMatrix<double> B = now.B / basis.area;
  Eigen::MatrixXd PF = outcome.P * basis.F, PZ = outcome.P * basis.Z;
  if(options.weights.size() != 0) {
    PF *= options.weights.cwiseSqrt().asDiagonal();
    PZ *= options.weights.cwiseSqrt().asDiagonal();
  }
  const Eigen::VectorXd mass = now.mass / basis.area;
  const Eigen::VectorXd E = (B * PZ - now.L * PF).rowwise().squaredNorm().cwiseQuotient(mass);
  const Eigen::SparseMatrix<double> size_of_L = now.L.cwiseAbs();
  const Eigen::VectorXd rounding = 1e-13 * (100 + worst_angle) *
                                   (B * PZ.cwiseAbs() + size_of_L * PF.cwiseAbs())
                                       .rowwise()
                                       .norm()
                                       .cwiseQuotient(mass.cwiseSqrt());
  const double tolerance =
      1e-6 * E.sum() + (2 * E.cwiseSqrt().cwiseProduct(rounding) + rounding.cwiseAbs2()).sum();
  if(!(std::abs(E.sum() - outcome.E) <= tolerance))
    return "E is off by " + std::to_string((E.sum() - outcome.E) / tolerance) + " tolerances";
  return "";
}

std::string fault_of_estimate(const double E)
{
  return std::isfinite(E) && E >= 0 ? "" : "E is " + std::to_string(E);
}

// Whether the metric may see mixtures: of fewer signals it never does.
bool has_mixtures(const Policies& policies, const SMS::Spectral_edge_collapse_options& options)
{
  const Eigen::Index K =
      policies.eigenpairs() ? policies.eigenpairs()->size() : options.signals.cols();
  return SMS::internal::is_filtered(options) ||
         (options.number_of_mixtures != 0 && options.number_of_mixtures < K);
}

// Faces that go through each other, where none of the input do.
std::string fault_of_crossings(const shapes::Matrices& coarse, const shapes::Matrices& fine,
                               const SMS::Spectral_edge_collapse_options& options)
{
  const auto crossings = [](const shapes::Matrices& mesh) {
    return SG::internal::self_intersecting_faces(mesh.V, mesh.T).size();
  };
  if(!options.keep_free_of_self_intersections || crossings(fine) != 0)
    return "";
  const std::size_t count = crossings(coarse);
  return count == 0 ? "" : std::to_string(count) + " pairs of faces cross";
}

std::string fault_of_result(const Mesh& mesh, const Policies& policies,
                            const shapes::Matrices& fine,
                            const SMS::Spectral_edge_collapse_options& options)
{
  if(!CGAL::is_valid_polygon_mesh(mesh) || !CGAL::is_triangle_mesh(mesh))
    return "the mesh is not a valid triangle mesh";
  const shapes::Matrices coarse = SG::mesh_matrices(mesh);
  const Eigen::SparseMatrix<double> P = policies.restriction();
  const std::string fault = fault_of_restriction(P, policies.vertex_map(), options.binary);
  if(!fault.empty())
    return fault;
  if(!options.binary && options.placement != SMS::Spectral_placement_strategy::free &&
     !(position_error(P, fine.V, coarse.V) < 1e-11))
    return "P times the fine positions is off by " +
           std::to_string(position_error(P, fine.V, coarse.V));
  const std::string crossings = fault_of_crossings(coarse, fine, options);
  if(!crossings.empty())
    return crossings;
  if(has_mixtures(policies, options)) // then E is an estimate
    return fault_of_estimate(policies.error());
  return fault_of_E(
      coarse,
      {P, policies.error(), policies.relative_error(), policies.eigenpairs().get(),
       SG::Local_operator(options.mass, options.coefficients).restricted(P).coefficients},
      fine, options);
}

// --- The one call, with all that it takes
// ------------------------------------------------------------------------------

// Which edges are constrained.
struct Edge_flags
{
  using key_type = Mesh::Edge_index;
  using value_type = bool;
  using reference = bool;
  using category = boost::read_write_property_map_tag;

  explicit Edge_flags(const Mesh& mesh)
    : flags(std::make_shared<std::vector<char>>(mesh.num_edges(), 0))
  {}
  friend bool get(const Edge_flags& map, const key_type e)
  {
    return (*map.flags)[std::size_t(e)] != 0;
  }
  friend void put(const Edge_flags& map, const key_type e, const bool flag)
  {
    (*map.flags)[std::size_t(e)] = flag;
  }
  std::shared_ptr<std::vector<char>> flags;
};

// The ends of all constrained edges, sorted.
std::vector<std::array<double, 6>> constrained_segments(const Mesh& mesh, const Edge_flags& flags)
{
  std::vector<std::array<double, 6>> result;
  for(const auto e : edges(mesh))
    if(get(flags, e)) {
      const auto p = mesh.point(mesh.vertex(e, 0)), q = mesh.point(mesh.vertex(e, 1));
      const auto [low, high] = std::minmax(p, q);
      result.push_back({low.x(), low.y(), low.z(), high.x(), high.y(), high.z()});
    }
  std::sort(result.begin(), result.end());
  return result;
}

bool unchanged(const Mesh& mesh, const Mesh& before)
{
  const shapes::Matrices a = SG::mesh_matrices(mesh), b = SG::mesh_matrices(before);
  return a.V.rows() == b.V.rows() && a.T.rows() == b.T.rows() && a.V == b.V && a.T == b.T;
}

// Begins each face at its least vertex: a mesh that was set in one sweep may begin it elsewhere
// than collapses one by one do.
Eigen::MatrixXi from_least_vertices(Eigen::MatrixXi T)
{
  for(Eigen::Index f = 0; f < T.rows(); ++f) {
    int corner = 0;
    T.row(f).minCoeff(&corner);
    const Eigen::RowVector3i face = T.row(f);
    for(int k = 0; k < 3; ++k)
      T(f, k) = face((corner + k) % 3);
  }
  return T;
}

bool same_faces(const Mesh& mesh, const Mesh& other)
{
  const shapes::Matrices a = SG::mesh_matrices(mesh), b = SG::mesh_matrices(other);
  return a.V.rows() == b.V.rows() && a.T.rows() == b.T.rows() && a.V == b.V &&
         from_least_vertices(a.T) == from_least_vertices(b.T);
}

// The levels of detail are those of the run.
std::string fault_of_log(Mesh copy, const Edge_flags& flags, const Mesh& mesh, const One_call& call,
                         const SMS::Spectral_edge_collapse_result& result, const bool swept)
{
  const auto np = CGAL::parameters::edge_is_constrained_map(flags);
  SMS::Collapse_replay<Mesh, std::decay_t<decltype(np)>> replay(copy, result.log, np);
  const std::size_t n = count_vertices(copy),
                    level = n - call.level % (n - result.output_vertices + 1);
  for(const std::size_t N : {level, result.output_vertices}) {
    replay.collapse_to(N);
    if(!CGAL::is_valid_polygon_mesh(copy) || count_vertices(copy) != N)
      return "a level of detail is not valid";
    if((replay.restriction() - result.log.restriction(N)).norm() != 0)
      return "the replay and the log have two restrictions";
  }
  if(!result.relocation.resampled &&
     (result.log.restriction(result.output_vertices) - result.restriction).norm() != 0)
    return "the last level has another restriction than the result";
  if(!call.post_processed() && !(swept ? same_faces(copy, mesh) : unchanged(copy, mesh)))
    return "the last level is not the result";
  return "";
}

// Kept vertices are where they were, as are constrained edges.
std::string fault_of_constraints(const Mesh& mesh, const Edge_flags& flags, const Mesh& before,
                                 const Edge_flags& flags_before, const One_call& call,
                                 const SMS::Spectral_edge_collapse_result& result)
{
  const Eigen::MatrixXd V = positions(mesh);
  for(const std::size_t v : call.options.kept_vertices) {
    const Eigen::Index row = Eigen::Index(result.vertex_map[v]);
    if(V.row(row) != call.fine.V.row(Eigen::Index(v)))
      return "a kept vertex has moved";
    if(result.restriction.coeff(row, Eigen::Index(v)) != 1)
      return "the values of a kept vertex have changed";
  }
  if(!call.has_zero_lengths() &&
     constrained_segments(mesh, flags) != constrained_segments(before, flags_before))
    return "constrained edges have changed";
  return "";
}

// A P that was read off at closest points.
std::string fault_of_sampled_restriction(const Eigen::SparseMatrix<double>& P,
                                         const std::vector<std::size_t>& map)
{
  const Eigen::VectorXd sums = P * Eigen::VectorXd::Ones(P.cols());
  if(!((sums.array() - 1).abs().maxCoeff() < 1e-12))
    return "a row of P does not sum to one";
  for(Eigen::Index v = 0; v < P.outerSize(); ++v)
    for(Eigen::SparseMatrix<double>::InnerIterator it(P, v); it; ++it)
      if(!(it.value() > -1e-12 && it.value() < 1 + 1e-12))
        return "an entry of P is " + std::to_string(it.value());
  if(Eigen::Index(map.size()) != P.cols() ||
     *std::max_element(map.begin(), map.end()) >= std::size_t(P.rows()))
    return "the vertex map is not one";
  return "";
}

// E of the second stage, whose input is what the first has left: P is the product of both, and the
// rows of the first have no column in common.
std::string fault_of_second_E(const shapes::Matrices& coarse, const One_call& call,
                              const SMS::Spectral_edge_collapse_result& result, Mesh before)
{
  SMS::Collapse_replay<Mesh> replay(before, result.log);
  replay.collapse_to(result.pre_simplified_vertices);
  const Eigen::SparseMatrix<double> first = replay.restriction(), transposed = first.transpose();
  const Eigen::VectorXd squares = first.cwiseAbs2() * Eigen::VectorXd::Ones(first.cols());
  const Eigen::SparseMatrix<double> second =
      result.restriction * transposed * squares.cwiseInverse().asDiagonal();
  if(!(Eigen::SparseMatrix<double>(second * first - result.restriction).norm() < 1e-10))
    return "P is not the product of two";
  SMS::Spectral_edge_collapse_options options = call.options;
  if(options.coefficients.size() != 0)
    options.coefficients =
        SG::Local_operator(options.mass, options.coefficients).restricted(first).coefficients;
  return fault_of_E(
      coarse,
      {second, result.E, result.relative_error, result.eigenpairs.get(), result.coefficients},
      SG::mesh_matrices(before), options);
}

std::string fault_of_one_result(const Mesh& mesh, const Mesh& before, const One_call& call,
                                const SMS::Spectral_edge_collapse_result& result)
{
  using Reason = SMS::Spectral_edge_collapse_result::Stop_reason;
  if(!CGAL::is_valid_polygon_mesh(mesh) || !CGAL::is_triangle_mesh(mesh))
    return "the mesh is not a valid triangle mesh";
  if(!(topology(mesh) == topology(before)))
    return "the topology has changed";
  if(count_vertices(mesh) != result.output_vertices ||
     (result.output_vertices < call.N && !call.has_zero_lengths()))
    return "the vertices are miscounted";
  const bool reached = result.output_vertices <= call.N;
  if(result.stop_reason != Reason::cancelled &&
     reached != (result.stop_reason == Reason::target_reached))
    return "the reason for which the run ended is wrong";
  const shapes::Matrices coarse = SG::mesh_matrices(mesh);
  const bool binary = call.options.binary, resampled = result.relocation.resampled;
  if(binary && resampled)
    return "a binary P was read off at closest points";
  std::string fault = resampled
                          ? fault_of_sampled_restriction(result.restriction, result.vertex_map)
                          : fault_of_restriction(result.restriction, result.vertex_map, binary);
  if(fault.empty() && !call.has_zero_lengths())
    fault = fault_of_crossings(coarse, call.fine, call.options);
  if(!fault.empty())
    return fault;
  if(!binary && call.options.placement != SMS::Spectral_placement_strategy::free &&
     !call.pre_simplified() && !call.options.relocate &&
     call.options.boundary == SG::Boundary_condition::neumann && // see its option
     !(position_error(result.restriction, call.fine.V, coarse.V) < 1e-11))
    return "P times the fine positions is off";
  // Before the first collapse E is the rounding of 0, which a bound of 0 is below.
  if(!(result.relative_error <= call.options.maximum_error) &&
     result.collapses != result.quadric_collapses && !call.post_processed() &&
     !call.has_zero_lengths())
    return "the error is " + std::to_string(result.relative_error) + ", " +
           std::to_string(result.relative_error / call.options.maximum_error) + " times the bound";
  if(SMS::internal::is_filtered(call.options))
    return fault_of_estimate(result.E);
  if(!result.eigenpairs &&
     call.options.signals.size() == 0) // cancelled before the first spectral collapse
    return result.stop_reason == Reason::cancelled ? "" : "there are no eigenpairs";
  if(call.pre_simplified())
    return fault_of_second_E(coarse, call, result, before);
  return fault_of_E(coarse,
                    {result.restriction, result.E, result.relative_error, result.eigenpairs.get(),
                     result.coefficients},
                    call.fine, call.options);
}

// Operators of the coarse mesh, fitted to the pairs of the run, or to what has nothing to do with
// them.
std::string fault_of_fitting(const shapes::Matrices& coarse, const One_call& call,
                             const SMS::Spectral_edge_collapse_result& result, Bytes& bytes)
{
  if(!SG::diagnose_polygon_soup(coarse.V, polygons_of(coarse.T)).usable())
    return ""; // a vertex without a mass
  const double theta = SG::mass_blend(call.options.mass);
  const SG::Laplace_operator own = SG::laplace_operator(coarse.V, coarse.T, theta),
                             fine = SG::laplace_operator(call.fine.V, call.fine.T, theta);
  const Eigen::Index n = fine.L.rows();
  SG::Eigenpairs pairs;
  if(result.eigenpairs && result.eigenpairs->vectors.rows() == n && !bytes.one_in(4))
    pairs = *result.eigenpairs;
  else {
    pairs.vectors = Eigen::MatrixXd::NullaryExpr(
        n, 1 + bytes.below(int(n)), [](Eigen::Index v, Eigen::Index k) {
          return std::sin(12.9898 * double(v + 1) * double(k + 1));
        });
    pairs.values = Eigen::VectorXd::LinSpaced(pairs.vectors.cols(), 0, 1000 / fine.mass.sum());
    for(Eigen::Index k = 0; k < pairs.vectors.cols(); ++k)
      pairs.vectors.col(k) /= std::sqrt(pairs.vectors.col(k).cwiseAbs2().dot(fine.mass));
  }
  const bool good = own.mass.allFinite() && own.mass.minCoeff() > 0 &&
                    std::isfinite(fine.mass.sum()) && std::isfinite(own.L.sum()) &&
                    pairs.vectors.allFinite() && pairs.values.allFinite();
  try {
    const SG::Operator_fit_result fit =
        SG::fit_operators(own, result.restriction, fine, pairs, fit_options_from(bytes));
    return good ? fault_of_fit(fit, own) : "operators that are no numbers were fitted";
  } catch(const std::invalid_argument& error) {
    return good ? std::string("the fit was refused: ") + error.what() : "";
  }
}

std::string fault_of_one_call(Mesh mesh, One_call call, Bytes& bytes)
{
  add_one_call_options(call, bytes);
  Edge_flags flags(mesh);
  const int flagged = bytes.below(4);
  const bool without_map = flagged == 0 && !bytes.one_in(3);
  for(int i = 0; i < flagged; ++i)
    put(flags, Mesh::Edge_index(unsigned(bytes.byte()) % mesh.num_edges()), true);
  const Mesh before = mesh;
  Edge_flags flags_before(mesh), flags_of_replay(mesh);
  *flags_before.flags = *flags_of_replay.flags = *flags.flags;
  int calls = 0;
  SMS::Spectral_edge_collapse_options options = call.options;
  options.progress = [&](const SG::Progress&) { return ++calls != call.calls_until_cancelled; };
  SMS::Spectral_edge_collapse_result result;
  try {
    const auto run = [&](const auto& with_filter, const auto& np) {
      return call.pre_simplified() // which calls no filter
                 ? SMS::spectral_edge_collapse(mesh, call.N, options, np)
                 : SMS::spectral_edge_collapse(mesh, call.N, options, with_filter);
    };
    const auto np = CGAL::parameters::edge_is_constrained_map(flags);
    result = without_map // a first stage sets the mesh in one sweep then
                 ? run(CGAL::parameters::filter(call.filter), CGAL::parameters::all_default())
                 : run(np.filter(call.filter), np);
  } catch(const SG::Cancelled&) {
    return unchanged(mesh, before) ? "" : "a cancelled run has changed the mesh";
  } catch(const std::invalid_argument& error) {
    const std::string sentence = error.what();
    bool expected = false;
    for(const char* const part : {"both to be kept", "where functions vanish",
                                  "but 1 component needs at least", "components need at least"})
      expected = expected || sentence.find(part) != std::string::npos;
    return expected && unchanged(mesh, before) ? "" : "refused: " + sentence;
  } catch(const std::runtime_error& error) {
    if(std::string(error.what()).find("first stage has left") != std::string::npos)
      return ""; // the first stage made needles
    throw;
  }
  std::string fault = fault_of_one_result(mesh, before, call, result);
  if(fault.empty())
    fault = fault_of_constraints(mesh, flags, before, flags_before, call, result);
  if(fault.empty())
    fault = fault_of_log(before, flags_of_replay, mesh, call, result,
                         without_map && call.pre_simplified());
  return fault.empty() && !is_large(call.fine) && bytes.one_in(4)
             ? fault_of_fitting(SG::mesh_matrices(mesh), call, result, bytes)
             : fault;
}

// ------------------------------------------------------------------------------------------------

bool refused(Mesh& mesh, const SMS::Spectral_edge_collapse_options& options)
{
  try {
    const Policies policies(mesh, options);
    return false;
  } catch(const std::invalid_argument&) {
    return true;
  }
}

// --- The policies, handed about
// ----------------------------------------------------------------------------------------

// The user's filter where `Handling` places it.
struct Placed_filter
{
  template <class Profile, class OptionalPoint>
  OptionalPoint operator()(const Profile& profile, const OptionalPoint& point) const
  {
    using Place = Handling::Place;
    const OptionalPoint p =
        place == Place::in_front || place == Place::alone ? user(profile, point) : point;
    if(!p || place == Place::alone)
      return p;
    return place == Place::behind ? with_user(profile, p) : ours(profile, p);
  }

  Handling::Place place;
  Random_filter user;
  SMS::Spectral_filter<Policies::State> ours;
  SMS::Spectral_filter<Policies::State, Random_filter> with_user;
};

// All that edge_collapse() gets, and nothing of the policies themselves.
struct Handles
{
  Handles(const Policies& policies, const Handling& handling,
          const SMS::Restriction_visitor<Mesh, Cost_probe>& user)
    : cost(policies.get_cost())
    , placement(policies.get_placement())
    , visitor(policies.visitor(user))
    , filter{handling.place, handling.filter, policies.filter(), policies.filter(handling.filter)}
  {}

  Policies::Get_cost cost;
  Policies::Get_placement placement;
  SMS::Spectral_visitor<Policies::State, SMS::Restriction_visitor<Mesh, Cost_probe>> visitor;
  Placed_filter filter;
};

bool stands_for_nothing(const Policies& policies)
{
  try {
    policies.restriction();
    return false;
  } catch(const std::logic_error&) {
    return true;
  }
}

// Brings the policies to another place; empty unless what has been left there is still good for
// something.
std::string fault_of_moves(std::unique_ptr<Policies>& policies, const Handling& handling)
{
  if(handling.does(Handling::move)) {
    auto moved = std::make_unique<Policies>(std::move(*policies));
    if(!stands_for_nothing(*policies))
      return "what has been moved from can be used";
    *policies = *moved; // and may be assigned to
    policies = std::move(moved);
  }
  if(handling.does(Handling::copy)) {
    auto copy = std::make_unique<Policies>(*policies);
    policies = std::move(copy);
  }
  return "";
}

// From what the log says, without the policies and without what the mesh was then.
std::string fault_of_replay(const Mesh& before, const Policies& policies,
                            const Eigen::SparseMatrix<double>& P, const unsigned level)
{
  auto copy = std::make_unique<Mesh>(before);
  SMS::Collapse_replay<Mesh> replay(*copy, policies.log());
  const std::size_t n = count_vertices(before), N = std::size_t(P.rows());
  replay.collapse_to(n - level % (n - N + 1));
  copy->collect_garbage();
  auto moved = std::move(replay);
  moved.collapse_to(N);
  if(!CGAL::is_valid_polygon_mesh(*copy) || count_vertices(*copy) != N)
    return "a level of detail is not valid";
  // Rows may come in another order.
  const Eigen::VectorXd numbers = Eigen::VectorXd::LinSpaced(P.cols(), 1, 2);
  Eigen::VectorXd a = P * numbers, b = moved.restriction() * numbers;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  const bool same = a == b;
  copy.reset(); // before the replay
  return same ? "" : "the replay and the run have two restrictions";
}

std::string fault_of_kept(const Mesh& mesh, const Policies& policies, const shapes::Matrices& fine,
                          const std::vector<std::size_t>& kept)
{
  const Eigen::MatrixXd V = positions(mesh);
  const std::vector<std::size_t> map = policies.vertex_map();
  for(const std::size_t v : kept)
    if(V.row(Eigen::Index(map[v])) != fine.V.row(Eigen::Index(v)))
      return "a kept vertex has moved";
  return "";
}

std::string fault_of_policies(const shapes::Matrices& fine, const SG::Mesh_diagnosis& diagnosis,
                              SMS::Spectral_edge_collapse_options options, const std::size_t N,
                              Bytes& bytes)
{
  const Handling handling(bytes);
  options.kept_vertices = some_vertices(bytes, fine);
  auto mesh = std::make_unique<Mesh>(make_mesh(fine));
  const Mesh before = *mesh;
  std::unique_ptr<Policies> policies, others;
  try {
    policies = std::make_unique<Policies>(*mesh, options);
  } catch(const std::invalid_argument& error) {
    const bool expected = std::string(error.what()).find("both to be kept") != std::string::npos;
    return expected && unchanged(*mesh, before) ? "" : std::string("refused: ") + error.what();
  }
  bool costs_are_numbers = true;
  const SMS::Restriction_visitor<Mesh, Cost_probe> tracker(*mesh, Cost_probe(costs_are_numbers));
  auto handles = std::make_unique<Handles>(Policies(*policies), handling, tracker);
  std::string fault = fault_of_moves(policies, handling);
  if(handling.does(Handling::others)) {
    if(policies->eigenpairs())
      options.eigenpairs = policies->eigenpairs();
    others = std::make_unique<Policies>(*mesh, options);
  }
  const std::size_t n = count_vertices(*mesh);
  for(int run = 1; run <= handling.runs; ++run) {
    if(handling.does(Handling::put_back)) {
      const Mesh backup = *mesh;
      *mesh = backup;
    }
    if(handling.does(Handling::collect))
      mesh->collect_garbage();
    const std::size_t target = run == handling.runs || N > n
                                   ? N
                                   : n - (n - N) * std::size_t(run) / std::size_t(handling.runs);
    SMS::edge_collapse(*mesh, SMS::Vertex_count_stop_predicate<Mesh>(target, *mesh),
                       CGAL::parameters::get_cost(handles->cost)
                           .get_placement(handles->placement)
                           .visitor(handles->visitor)
                           .filter(handles->filter));
  }
  const auto check = [&](const bool good, const char* what) {
    if(fault.empty() && !good)
      fault = what;
  };
  check(costs_are_numbers, "a cost is not a number");
  check(count_vertices(*mesh) == policies->state().number_of_vertices(),
        "the vertices are miscounted");
  check(count_vertices(*mesh) >= N || diagnosis.zero_length_edges.count != 0,
        "the target was missed");
  check(topology(*mesh) == topology(before), "the topology has changed");
  if(fault.empty())
    fault = fault_of_result(*mesh, *policies, fine, options);
  if(fault.empty())
    fault = fault_of_restriction(tracker.restriction(), tracker.vertex_map());
  check(tracker.vertex_map() == policies->vertex_map(), "the two vertex maps differ");
  if(fault.empty())
    fault = fault_of_kept(*mesh, *policies, fine, options.kept_vertices);
  if(fault.empty())
    fault = fault_of_replay(before, *policies, policies->restriction(), handling.level);

  if(handling.does(Handling::mesh_first))
    mesh.reset();
  if(handling.does(Handling::handles_last))
    policies.reset();
  handles.reset();
  policies.reset();
  others.reset();
  check(!mesh || CGAL::is_valid_polygon_mesh(*mesh), "the mesh is not valid without its policies");
  return fault;
}

// ------------------------------------------------------------------------------------------------

// What went wrong; empty if nothing did.
std::string fault_of_input(Bytes bytes)
{
  shapes::Matrices fine = shape(bytes);
  make_holes(fine, bytes);
  if(fine.T.rows() == 0)
    return "";
  disturb(fine, bytes);
  const SG::Mesh_diagnosis diagnosis = SG::diagnose_polygon_soup(fine.V, polygons_of(fine.T));
  if(diagnosis.non_manifold_vertices.count != 0)
    return ""; // not a mesh
  const SMS::Spectral_edge_collapse_options options = options_from(bytes, fine);
  const std::size_t N = target_from(bytes, fine);
  if(!diagnosis.usable()) {
    Mesh mesh = make_mesh(fine);
    return refused(mesh, options) ? "" : "accepted: " + diagnosis.obstacles().front();
  }
  return bytes.one_in(2)
             ? fault_of_one_call(make_mesh(fine), {fine, diagnosis, options, N, {}, 0, 0}, bytes)
             : fault_of_policies(fine, diagnosis, options, N, bytes);
}

} // namespace

std::string spectral_test::checked(const std::uint8_t* data, const std::size_t size)
{
  try {
    return fault_of_input(Bytes(data, size));
  } catch(const std::exception& error) {
    return std::string("an exception: ") + error.what();
  }
}

spectral_test::Byte_string spectral_test::random_input(std::mt19937& random)
{
  Byte_string bytes(8 + random() % 150);
  for(std::uint8_t& byte : bytes)
    byte = static_cast<std::uint8_t>(random() >> 16);
  return bytes;
}

spectral_test::Byte_string spectral_test::input_of_file(const std::string&,
                                                        const Byte_string& contents)
{
  return contents;
}
