// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Bytes become a small mesh and options; it is simplified, and everything that must hold afterwards is checked.
//
//   fuzz_collapse RUNS SEED    random bytes
//   fuzz_collapse FILE...      the bytes of these files
// or, with SPECTRAL_FUZZ and clang, a target of libFuzzer.

#include "../topology.h"
#include "fuzz_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace spectral_test;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;

// Every cost that CGAL's queue sees is a number.
struct Cost_probe : SMS::internal::No_visitor
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
    result = (std::max)(result, SG::triangle_cotangents(mesh.V.row(mesh.T(f, 0)), mesh.V.row(mesh.T(f, 1)),
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
  Eigen::Index signals; // that the metric saw, the first ones
};

// E recomputed from whole matrices, with the rounding that cotangents of that size leave in it.
std::string fault_of_E(const shapes::Matrices& coarse, const Outcome& outcome, const shapes::Matrices& fine,
                       const SMS::Spectral_edge_collapse_options& options)
{
  const double worst_angle = (std::max)(largest_cotangent(coarse), largest_cotangent(fine));
  if(!std::isfinite(outcome.E) || !std::isfinite(outcome.relative_error) || outcome.E < 0)
    return "E is " + std::to_string(outcome.E) + ", " + std::to_string(outcome.relative_error) +
           " relative to the signals";
  if(worst_angle > 1e6 || !SG::diagnose_polygon_soup(coarse.V, polygons_of(coarse.T)).usable())
    return "";
  const double theta = SG::mass_blend(options.mass);
  const SG::Laplace_operator op = SG::laplace_operator(fine.V, fine.T, theta);
  const bool given = options.signals.size() != 0;
  Basis basis = given ? signal_basis(fine, theta, options.signals) : basis_of_pairs(op, *outcome.pairs);
  if(!given && SMS::internal::pairs_are_rough(SMS::internal::spectral_residuals(op, *outcome.pairs)))
    basis.Z = signal_basis(fine, theta, basis.F).Z; // as the policies do where needles have left them rough
  const SG::Laplace_operator now = SG::laplace_operator(coarse.V, coarse.T, theta);
  const Eigen::SparseMatrix<double> B = now.B / basis.area;
  Eigen::MatrixXd PF = outcome.P * basis.F, PZ = outcome.P * basis.Z;
  if(options.weights.size() != 0) {
    PF *= options.weights.cwiseSqrt().asDiagonal();
    PZ *= options.weights.cwiseSqrt().asDiagonal();
  }
  PF.conservativeResize(Eigen::NoChange, outcome.signals);
  PZ.conservativeResize(Eigen::NoChange, outcome.signals);
  const Eigen::VectorXd mass = now.mass / basis.area;
  const Eigen::VectorXd E = (B * PZ - now.L * PF).rowwise().squaredNorm().cwiseQuotient(mass);
  const Eigen::SparseMatrix<double> size_of_L = now.L.cwiseAbs();
  const Eigen::VectorXd rounding =
      1e-13 * (100 + worst_angle) *
      (B * PZ.cwiseAbs() + size_of_L * PF.cwiseAbs()).rowwise().norm().cwiseQuotient(mass.cwiseSqrt());
  const double tolerance =
      1e-6 * E.sum() + (2 * E.cwiseSqrt().cwiseProduct(rounding) + rounding.cwiseAbs2()).sum();
  if(!(std::abs(E.sum() - outcome.E) <= tolerance))
    return "E is off by " + std::to_string((E.sum() - outcome.E) / tolerance) + " tolerances";
  return "";
}

std::string fault_of_result(const Mesh& mesh, const Policies& policies, const shapes::Matrices& fine,
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
    return "P times the fine positions is off by " + std::to_string(position_error(P, fine.V, coarse.V));
  return fault_of_E(coarse,
                    {P, policies.error(), policies.relative_error(), policies.eigenpairs().get(),
                     policies.state().core().number_of_signals()},
                    fine, options);
}

// --- The one call, with all that it takes ------------------------------------------------------------------------------

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
  friend bool get(const Edge_flags& map, const key_type e) { return (*map.flags)[std::size_t(e)] != 0; }
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

// The levels of detail are those of the run.
std::string fault_of_log(Mesh copy, const Edge_flags& flags, const Mesh& mesh, const One_call& call,
                         const SMS::Spectral_edge_collapse_result& result)
{
  const auto np = CGAL::parameters::edge_is_constrained_map(flags);
  SMS::Collapse_replay<Mesh, std::decay_t<decltype(np)>> replay(copy, result.log, np);
  const std::size_t n = count_vertices(copy), level = n - call.level % (n - result.output_vertices + 1);
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
  if(!call.post_processed() && !unchanged(copy, mesh))
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
  if(result.stop_reason != Reason::cancelled && reached != (result.stop_reason == Reason::target_reached))
    return "the reason for which the run ended is wrong";
  const shapes::Matrices coarse = SG::mesh_matrices(mesh);
  const bool binary = call.options.binary && !call.pre_simplified();
  const std::string fault =
      result.relocation.resampled ? "" : fault_of_restriction(result.restriction, result.vertex_map, binary);
  if(!fault.empty())
    return fault;
  if(!binary && call.options.placement != SMS::Spectral_placement_strategy::free && !call.pre_simplified() &&
     !call.options.relocate && !(position_error(result.restriction, call.fine.V, coarse.V) < 1e-11))
    return "P times the fine positions is off";
  // Before the first collapse E is the rounding of 0, which a bound of 0 is below.
  if(!(result.relative_error <= call.options.maximum_error) && result.collapses != 0 &&
     !call.post_processed() && !call.pre_simplified() && !call.has_zero_lengths())
    return "the error is " + std::to_string(result.relative_error) + ", " +
           std::to_string(result.relative_error / call.options.maximum_error) + " times the bound";
  if(!result.eigenpairs && call.options.signals.size() == 0) // cancelled before the first spectral collapse
    return result.stop_reason == Reason::cancelled ? "" : "there are no eigenpairs";
  if(call.pre_simplified())
    return std::isfinite(result.E) && result.E >= 0 ? "" : "E is " + std::to_string(result.E);
  return fault_of_E(coarse,
                    {result.restriction, result.E, result.relative_error, result.eigenpairs.get(),
                     Eigen::Index(result.signals)},
                    call.fine, call.options);
}

std::string fault_of_one_call(Mesh mesh, One_call call, Bytes& bytes)
{
  add_one_call_options(call, bytes);
  Edge_flags flags(mesh);
  for(int i = bytes.below(4); i > 0; --i)
    put(flags, Mesh::Edge_index(unsigned(bytes.byte()) % mesh.num_edges()), true);
  const Mesh before = mesh;
  Edge_flags flags_before(mesh), flags_of_replay(mesh);
  *flags_before.flags = *flags_of_replay.flags = *flags.flags;
  int calls = 0;
  SMS::Spectral_edge_collapse_options options = call.options;
  options.progress = [&](const SMS::Spectral_progress&) { return ++calls != call.calls_until_cancelled; };
  SMS::Spectral_edge_collapse_result result;
  try {
    result = SMS::spectral_edge_collapse(
        mesh, call.N, options, CGAL::parameters::edge_is_constrained_map(flags).filter(call.filter));
  } catch(const SG::Cancelled&) {
    return unchanged(mesh, before) ? "" : "a cancelled run has changed the mesh";
  } catch(const std::invalid_argument& error) {
    const bool expected = std::string(error.what()).find("both to be kept") != std::string::npos;
    return expected && unchanged(mesh, before) ? "" : std::string("refused: ") + error.what();
  } catch(const std::runtime_error& error) {
    if(std::string(error.what()).find("pre_simplify has left") != std::string::npos)
      return ""; // the first stage made needles
    throw;
  }
  std::string fault = fault_of_one_result(mesh, before, call, result);
  if(fault.empty())
    fault = fault_of_constraints(mesh, flags, before, flags_before, call, result);
  return fault.empty() ? fault_of_log(before, flags_of_replay, mesh, call, result) : fault;
}

// -----------------------------------------------------------------------------------------------------------------------

bool refused(Mesh& mesh, const SMS::Spectral_edge_collapse_options& options)
{
  try {
    const Policies policies(mesh, options);
    return false;
  } catch(const std::invalid_argument&) {
    return true;
  }
}

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
  const std::size_t n = std::size_t(fine.V.rows()), N = 1 + std::size_t(bytes.below(int(n)));
  Mesh mesh = make_mesh(fine);
  if(!diagnosis.usable())
    return refused(mesh, options) ? "" : "accepted: " + diagnosis.obstacles().front();

  if(bytes.one_in(2))
    return fault_of_one_call(mesh, {fine, diagnosis, options, N, {}, 0, 0}, bytes);
  const Topology before = topology(mesh);
  Policies policies(mesh, options);
  policies.state().set_batched(!bytes.one_in(4));
  bool costs_are_numbers = true;
  collapse(mesh, policies, N, Cost_probe(costs_are_numbers));
  if(!costs_are_numbers)
    return "a cost is not a number";
  if(count_vertices(mesh) != policies.state().number_of_vertices())
    return "the vertices are miscounted";
  if(count_vertices(mesh) < N && diagnosis.zero_length_edges.count == 0)
    return "the target was missed";
  if(!(topology(mesh) == before))
    return "the topology has changed";
  return fault_of_result(mesh, policies, fine, options);
}

std::string checked(const std::uint8_t* data, const std::size_t size)
{
  try {
    return fault_of_input(Bytes(data, size));
  } catch(const std::exception& error) {
    return std::string("an exception: ") + error.what();
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, const std::size_t size)
{
  const std::string fault = checked(data, size);
  if(fault.empty())
    return 0;
  std::fprintf(stderr, "%s\n", fault.c_str());
  std::abort();
}

#ifndef SPECTRAL_LIBFUZZER

namespace {

int failures = 0;

void run(const std::vector<std::uint8_t>& bytes, const std::string& name)
{
  const std::string fault = checked(bytes.data(), bytes.size());
  if(!fault.empty()) {
    ++failures;
    std::printf("%s: %s\n", name.c_str(), fault.c_str());
  }
}

} // namespace

int main(int argc, char* argv[])
{
  char* end = nullptr;
  const unsigned long runs = argc == 3 ? std::strtoul(argv[1], &end, 10) : 0;
  if(runs > 0 && *end == '\0') {
    const unsigned long seed = std::strtoul(argv[2], nullptr, 10);
    for(unsigned long i = 0; i < runs; ++i) {
      std::mt19937 random(static_cast<std::uint32_t>(seed + i));
      std::vector<std::uint8_t> bytes(8 + random() % 150);
      for(std::uint8_t& byte : bytes)
        byte = static_cast<std::uint8_t>(random() >> 16);
      run(bytes, "1 " + std::to_string(seed + i));
    }
    std::printf("%lu runs, %d failures\n", runs, failures);
  } else {
    for(int i = 1; i < argc; ++i) {
      std::ifstream stream(argv[i], std::ios::binary);
      const std::vector<char> text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
      run(std::vector<std::uint8_t>(text.begin(), text.end()), argv[i]);
    }
    std::printf("%d files, %d failures\n", argc - 1, failures);
  }
  return failures == 0 ? 0 : 1;
}

#endif
