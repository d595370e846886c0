// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Simplifies a mesh from the command line and says how well its spectrum was kept; --help shows the options.

#include "io/Progress_bar.h"
#include "io/index_reader.h"
#include "io/machine_memory.h"
#include "io/matrix_io.h"
#include "io/mesh_io.h"
#include "io/mesh_repair.h"
#include "io/npy_reader.h"
#include "io/output_files.h"
#include "report/html_report.h"
#include "report/single_run.h"
#include "spectral_simplify_arguments.h"
#include "spectral_simplify_report.h"

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_memory_estimate.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace SMS = CGAL::Surface_mesh_simplification;
namespace SG = CGAL::Spectral_geometry;

// Set by Ctrl-C. The run looks at it, so that the program ends by its own way and leaves no file behind; the second time
// the signal does what it does to any program.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

extern "C" void interrupt(int signal)
{
  interrupted = true;
  std::signal(signal, SIG_DFL);
}

// The files of --eigenpairs.
constexpr const char* eigenpairs_files[] = {
    "fine_eigenvalues.npy", "fine_eigenvectors.npy",  "fine_L.mtx",
    "fine_mass.mtx",        "coarse_eigenvalues.npy", "coarse_eigenvectors.npy",
    "coarse_L.mtx",         "coarse_mass.mtx",        "C.npy"};

// The name of a level: "coarse-600.ply" beside "coarse.ply".
std::string level_name(const std::string& path, const std::size_t level)
{
  const std::filesystem::path p(path);
  return (p.parent_path() / (p.stem().string() + "-" + std::to_string(level) + p.extension().string()))
      .string();
}

// The files that are written for each of --levels.
std::vector<std::string> files_of_level(const Arguments& a, const std::size_t level)
{
  std::vector<std::string> files;
  for(const std::string& path : {a.output, a.restriction, a.map})
    if(!path.empty())
      files.push_back(level_name(path, level));
  return files;
}

// Makes room for every output, so that what cannot be written is known before the work.
void announce(Output_files& files, const Arguments& a)
{
  files.add(a.output); // which may be INPUT itself
  for(const std::string& path : {a.input, a.keep, a.signals})
    if(!path.empty())
      files.keep(path);
  for(const std::string& path : {a.restriction, a.prolongation, a.map, a.json, a.report, a.repaired})
    if(!path.empty())
      files.add(path);
  for(const std::size_t level : a.levels)
    for(const std::string& path : files_of_level(a, level))
      files.add(path);
  if(!a.eigenpairs.empty()) {
    files.add_folder(a.eigenpairs);
    for(const std::string name : eigenpairs_files)
      files.add(a.eigenpairs + "/" + name);
  }
}

// Both meshes as matrices, as far as the outputs need them.
struct Both_meshes
{
  SG::Mesh_matrices fine, coarse;
  SG::Laplace_operator fine_operator, coarse_operator;
  std::shared_ptr<const SG::Eigenpairs> fine_pairs;
  SG::Eigenpairs coarse_pairs;
};

const char* phase_name(SMS::Spectral_phase phase)
{
  switch(phase) {
  case SMS::Spectral_phase::pre_simplification:
    return "preparation";
  case SMS::Spectral_phase::eigenpairs:
    return "eigenpairs";
  case SMS::Spectral_phase::first_costs:
    return "first costs";
  case SMS::Spectral_phase::flips:
    return "edge flips";
  case SMS::Spectral_phase::relocation:
    return "relocation";
  case SMS::Spectral_phase::collapses:
    break;
  }
  return "collapses";
}

// The preset and what overrides it.
SMS::Spectral_edge_collapse_options preset_options(const Arguments& a)
{
  using Options = SMS::Spectral_edge_collapse_options;
  using Signals = SG::Relocation_options::Signals;
  Options options = a.preset == "paper" ? Options::paper() : Options::best();
  if(!a.placement.empty())
    options.placement = a.placement == "midpoint" ? SMS::Spectral_placement_strategy::midpoint
                        : a.placement == "free"   ? SMS::Spectral_placement_strategy::free
                                                  : SMS::Spectral_placement_strategy::on_edge;
  if(!a.mass.empty())
    options.mass = a.mass == "averaged" ? SG::Mass::averaged : SG::Mass::lumped;
  if(a.shape)
    options.shape = *a.shape;
  if(!a.self_intersections.empty())
    options.keep_free_of_self_intersections = a.self_intersections == "refuse";
  if(!a.relocate.empty()) {
    options.relocate = a.relocate != "none";
    options.relocation.signals = a.relocate == "carried"   ? Signals::carried
                                 : a.relocate == "sampled" ? Signals::sampled
                                                           : Signals::carried_and_sampled;
  }
  return options;
}

SMS::Spectral_edge_collapse_options options_of_run(const Arguments& a, const std::size_t n, Progress_bar& bar)
{
  SMS::Spectral_edge_collapse_options options = preset_options(a);
  options.number_of_eigenvectors = a.eigenvectors;
  options.binary = a.binary;
  options.preserve_border = a.preserve_border;
  options.flips = a.flips == "spectral"   ? SG::Edge_flips::spectral
                  : a.flips == "delaunay" ? SG::Edge_flips::delaunay
                                          : SG::Edge_flips::none;
  options.threads = a.threads;
  options.pre_simplify = static_cast<std::size_t>(a.pre_simplify);
  options.progress = [&bar](const SMS::Spectral_progress& progress) {
    bar.show(phase_name(progress.phase), progress.fraction);
    return true;
  };
  options.cancel = &interrupted;
  if(!a.levels.empty() &&
     a.signals.empty()) // one run for all of them: the largest decides how many eigenvectors steer it
    options.metric_eigenvectors = SMS::metric_eigenvectors_for(a.levels.front(), a.eigenvectors);
  if(a.max_error)
    options.maximum_error = *a.max_error;
  if(!a.keep.empty())
    options.kept_vertices = read_indices(a.keep, n);
  if(!a.signals.empty())
    options.signals = read_signals(a.signals, n);
  return options;
}

// Says how much memory the run will take, and refuses what the machine does not have.
void check_memory(const Arguments& a, std::size_t n, const SMS::Spectral_edge_collapse_options& options)
{
  const Eigen::Index K = options.signals.size() != 0 ? options.signals.cols() : Eigen::Index(a.eigenvectors);
  const double needed = SMS::estimated_memory(n, K, options), available = available_memory();
  if(available > 0 && needed > available)
    throw std::runtime_error("a mesh of " + std::to_string(n) + " vertices with " + std::to_string(K) +
                             " eigenvectors takes about " + formatted_memory(needed) +
                             " of memory, but this machine has " + formatted_memory(available) +
                             " left: add --pre-simplify 100000, or lower --eigenvectors.");
  if(!a.quiet)
    std::cout << "memory: about " << formatted_memory(needed)
              << (available > 0 ? " of the " + formatted_memory(available) + " that are available" : "")
              << "\n\n"
              << std::flush;
}

// Compares the spectra, with tight pairs of the whole input; a tenth more coarse modes tells loss from exchange at the cut, see `Spectral_evaluation`.
SG::Spectral_evaluation evaluate(Both_meshes& meshes, SG::Mass mass,
                                 const Eigen::Index number_of_eigenvectors,
                                 const SMS::Spectral_edge_collapse_result& result, Progress_bar& bar)
{
  const Eigen::Index N = meshes.coarse.V.rows();
  meshes.fine_operator = SG::laplace_operator(meshes.fine.V, meshes.fine.T, SG::mass_blend(mass));
  meshes.coarse_operator = SG::laplace_operator(meshes.coarse.V, meshes.coarse.T, SG::mass_blend(mass));
  SG::Eigenpairs_options options;
  options.progress = [&bar](double fraction) {
    bar.show("evaluation", fraction);
    return !interrupted;
  };
  // With signals of the user's, the run has not needed those of the input.
  meshes.fine_pairs = result.eigenpairs;
  if(!meshes.fine_pairs || meshes.fine_pairs->vectors.rows() != meshes.fine.V.rows())
    meshes.fine_pairs = std::make_shared<SG::Eigenpairs>(
        SG::eigenpairs(meshes.fine_operator, number_of_eigenvectors, options));
  const Eigen::Index K = meshes.fine_pairs->size();
  meshes.coarse_pairs = SG::eigenpairs(meshes.coarse_operator, (std::min)(N, K + (K + 9) / 10), options);
  return SG::evaluate_spectrum(meshes.fine_operator, *meshes.fine_pairs, meshes.coarse_operator,
                               meshes.coarse_pairs, result.restriction, K);
}

// Everything at input scale, so that C = coarse_eigenvectors^T coarse_mass P fine_eigenvectors holds between the files.
void write_eigenpairs(const Output_files& files, const std::string& folder, const Both_meshes& meshes,
                      const SMS::Spectral_edge_collapse_result& result)
{
  const auto npy = [&](const std::string& name, const auto& matrix) {
    const std::string path = folder + "/" + name + ".npy";
    write_npy(files.temporary(path), matrix, path);
  };
  const auto mtx = [&](const std::string& name, const Eigen::SparseMatrix<double>& matrix) {
    const std::string path = folder + "/" + name + ".mtx";
    write_matrix_market(files.temporary(path), matrix, path);
  };
  const SG::Eigenpairs& fine = *meshes.fine_pairs;
  const Eigen::MatrixXd coarse_vectors = meshes.coarse_pairs.vectors.leftCols(fine.size());
  const Eigen::VectorXd coarse_values = meshes.coarse_pairs.values.head(fine.size());
  npy("fine_eigenvalues", fine.values);
  npy("fine_eigenvectors", fine.vectors);
  npy("coarse_eigenvalues", coarse_values);
  npy("coarse_eigenvectors", coarse_vectors);
  npy("C", SG::functional_map(coarse_vectors, meshes.coarse_operator.B, result.restriction, fine.vectors));
  mtx("fine_L", meshes.fine_operator.L);
  mtx("fine_mass", meshes.fine_operator.B);
  mtx("coarse_L", meshes.coarse_operator.L);
  mtx("coarse_mass", meshes.coarse_operator.B);
}

// The page of this run.
std::string page(const Arguments& a, const Mesh& mesh, const Both_meshes& meshes,
                 const Simplification_report& report)
{
  const auto& result = report.result;
  Simplified run;
  run.simplifier = report.options.shape > 0 ? "spectral with shape term" : "spectral";
  if(!a.signals.empty())
    run.simplifier += ", own signals";
  if(a.binary)
    run.simplifier += ", binary";
  if(a.flips != "none")
    run.simplifier += ", " + a.flips + " flips";
  run.relocation = relocation_name(report.options);
  run.placement = SMS::placement_name(report.options.placement);
  run.metric_mass = SG::mass_name(report.options.mass);
  run.shape_term = report.options.shape;
  run.requested_vertices = run.vertices = result.output_vertices;
  run.faces = mesh.number_of_faces();
  run.seconds = result.seconds_collapse;
  run.seconds_eigenpairs = result.seconds_eigenpairs;
  run.note = result.explanation;
  Comparison comparison = single_run(*report.evaluation, std::move(run));
  comparison.command = a.command;
  comparison.mesh = std::filesystem::path(a.input).filename().string();
  comparison.vertices = result.input_vertices;
  comparison.faces = static_cast<std::size_t>(meshes.fine.T.rows());
  comparison.threads = a.threads;
  comparison.notes = result.warnings;
  return html_report(comparison);
}

// The evaluation was interrupted: what it would have made does not appear.
void drop_evaluation(Output_files& files, const Arguments& a)
{
  files.drop(a.report);
  for(const std::string name : eigenpairs_files)
    files.drop(a.eigenpairs + "/" + name);
  files.drop_new_folders();
}

// What the evaluation makes.
void write_evaluation(Output_files& files, const Arguments& a, const Mesh& mesh, const Both_meshes& meshes,
                      const Simplification_report& report)
{
  if(!a.eigenpairs.empty())
    write_eigenpairs(files, a.eigenpairs, meshes, report.result);
  if(!a.report.empty()) {
    std::ofstream stream(files.temporary(a.report));
    stream << page(a, mesh, meshes, report);
    finish_writing(stream, a.report);
  }
}

void write_outputs(Output_files& files, const Arguments& a, const Mesh& mesh, const Both_meshes& meshes,
                   const Simplification_report& report)
{
  write_mesh(files.temporary(a.output), mesh, a.output);
  if(!a.restriction.empty())
    write_matrix_market(files.temporary(a.restriction), report.result.restriction, a.restriction);
  if(!a.prolongation.empty())
    write_matrix_market(files.temporary(a.prolongation),
                        SG::closest_point_interpolation(meshes.fine.V, meshes.coarse), a.prolongation);
  if(!a.map.empty())
    write_indices(files.temporary(a.map), report.result.vertex_map, a.map);
  if(report.evaluation)
    write_evaluation(files, a, mesh, meshes, report);
  else
    drop_evaluation(files, a);
  if(!a.json.empty()) {
    std::ofstream stream(files.temporary(a.json));
    stream << to_json(report).dump(2) << '\n';
    finish_writing(stream, a.json);
  }
}

Mesh input_mesh(const Arguments& a, Repair_log& log)
{
  if(!a.repair)
    return to_mesh(read_polygon_soup(a.input), a.input, ", or add --repair");
  return to_mesh(repaired_soup(read_polygon_soup(a.input), log), a.input, ", which --repair could not do");
}

// What the mesh does not allow, apart from what the simplification itself warns of.
std::vector<std::string> warnings_of_input(const Arguments& a, const Mesh& mesh, const std::size_t target)
{
  return SG::diagnose_mesh(mesh).warnings(static_cast<std::size_t>(a.eigenvectors), target);
}

// Writes the levels that the run has reached, from its log and a copy of the input, and returns them.
std::vector<std::size_t> write_levels(Output_files& files, const Arguments& a, Mesh& copy,
                                      const SMS::Collapse_log& log)
{
  std::vector<std::size_t> written;
  SMS::Collapse_replay<Mesh> replay(copy, log);
  for(const std::size_t level : a.levels) {
    if(level < log.number_of_vertices_left()) {
      for(const std::string& path : files_of_level(a, level))
        files.drop(path);
      continue;
    }
    replay.collapse_to(level);
    const auto name = [level](const std::string& path) { return level_name(path, level); };
    write_mesh(files.temporary(name(a.output)), copy, name(a.output));
    if(!a.restriction.empty())
      write_matrix_market(files.temporary(name(a.restriction)), replay.restriction(), name(a.restriction));
    if(!a.map.empty())
      write_indices(files.temporary(name(a.map)), replay.vertex_map(), name(a.map));
    written.push_back(level);
  }
  return written;
}

// How well the spectrum was kept, unless nobody wants to know or it takes the user too long.
void evaluate(Simplification_report& report, const Arguments& a, Both_meshes& meshes, SG::Mass mass,
              Progress_bar& bar)
{
  if(a.no_evaluation || interrupted)
    return;
  const auto begin = std::chrono::steady_clock::now();
  try {
    report.evaluation = evaluate(meshes, mass, a.eigenvectors, report.result, bar);
  } catch(const SG::Cancelled&) {
    return;
  }
  report.seconds_evaluation = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  // E is summed over the vertices that are left. What is worn away from a border, where faces are of very different sizes, is not in it.
  const double area = report.evaluation->area_ratio;
  if(area < 0.25)
    report.result.warnings.push_back(
        "Only " + arguments_internal::shown(100 * area) +
        " % of the area is left, and the relative error does not see what is "
        "gone: ask for more vertices, or remesh so that faces differ less in size.");
}

void say(const Arguments& a, const Simplification_report& report)
{
  const auto warn = [](const std::string& sentence) {
    std::cerr << "spectral_simplify: warning: " << sentence << '\n';
  };
  if(!a.quiet) {
    for(const std::string& warning : report.result.warnings)
      warn(warning);
    print_table(report);
  }
  if(!report.result.explanation.empty())
    warn(report.result.explanation);
  if(report.levels.size() < a.levels.size())
    warn("The level of " + std::to_string(a.levels[report.levels.size()]) +
         " vertices was not reached, so that it and smaller ones are not written.");
}

void run(const Arguments& a)
{
  Repair_log repairs;
  Mesh mesh = input_mesh(a, repairs);
  const std::size_t target = checked_target(a, num_vertices(mesh));
  const std::vector<std::string> warnings = warnings_of_input(a, mesh, target);
  Progress_bar bar(!a.quiet);
  const SMS::Spectral_edge_collapse_options options = options_of_run(a, num_vertices(mesh), bar);
  Output_files files;
  announce(files, a);
  check_memory(a, num_vertices(mesh), options);
  if(!a.repaired.empty())
    write_mesh(files.temporary(a.repaired), mesh, a.repaired);
  Mesh copy;
  if(!a.levels.empty())
    copy = mesh;
  Both_meshes meshes;
  if(!a.no_evaluation || !a.prolongation.empty())
    meshes.fine = SG::mesh_matrices(mesh);

  Simplification_report report;
  report.result = SMS::spectral_edge_collapse(mesh, target, options);
  const auto check_interrupted = [&a] {
    if(interrupted && a.on_interrupt != "write")
      throw SG::Cancelled();
  };
  check_interrupted();
  report.result.warnings.insert(report.result.warnings.end(), warnings.begin(), warnings.end());
  report.repairs = repairs.changes();
  report.input = a.input;
  report.output = a.output;
  report.preset = a.preset;
  report.options = options;
  meshes.coarse = SG::mesh_matrices(mesh);
  evaluate(report, a, meshes, options.mass, bar);
  check_interrupted();
  bar.clear();

  if(!a.levels.empty())
    report.levels = write_levels(files, a, copy, report.result.log);
  write_outputs(files, a, mesh, meshes, report);
  check_interrupted();
  files.commit();
  say(a, report);
}

int main(int argc, char* argv[])
{
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  try {
    const Arguments arguments = parse_arguments(argc, argv);
    if(!arguments.help.empty())
      std::cout << arguments.help;
    else
      run(arguments);
    if(!interrupted)
      return 0;
    std::cerr << "spectral_simplify: interrupted, what had been done is written.\n";
    return 130;
  } catch(const SG::Cancelled&) {
    std::cerr << "spectral_simplify: interrupted, nothing was written.\n";
    return 130;
  } catch(const std::bad_alloc&) {
    std::cerr
        << "spectral_simplify: the memory does not suffice for this mesh and this number of eigenvectors.\n";
  } catch(const std::exception& error) {
    std::cerr << "spectral_simplify: " << error.what() << '\n';
  }
  return 1;
}
