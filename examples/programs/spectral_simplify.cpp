// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Simplifies a mesh from the command line and says how well its spectrum was kept; --help shows the options.

#include "io/Progress_bar.h"
#include "io/index_reader.h"
#include "io/input_mesh.h"
#include "io/machine_memory.h"
#include "io/matrix_io.h"
#include "io/mesh_io.h"
#include "io/npy_reader.h"
#include "io/operator_reader.h"
#include "io/output_files.h"
#include "io/program.h"
#include "io/texture_seams.h"
#include "option_words.h"
#include "report/html_report.h"
#include "report/json_text.h"
#include "report/judgement.h"
#include "report/plain_words.h"
#include "report/shape_view.h"
#include "simplification.h"
#include "spectral_simplify_arguments.h"
#include "spectral_simplify_report.h"

#include <CGAL/Real_timer.h>
#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_memory_estimate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace SMS = CGAL::Surface_mesh_simplification;
namespace SG = CGAL::Spectral_geometry;

// The files of --eigenpairs.
constexpr const char* eigenpairs_files[] = {
    "fine_eigenvalues.npy", "fine_eigenvectors.npy",  "fine_L.mtx",
    "fine_mass.mtx",        "coarse_eigenvalues.npy", "coarse_eigenvectors.npy",
    "coarse_L.mtx",         "coarse_mass.mtx",        "C.npy"};

// One more of them, where --operator has coefficients.
constexpr const char* coefficients_file = "/coarse_coefficients.npy";

bool has_coefficients(const Arguments& a)
{
  return a.operator_.kind != "cotangent";
}

// Those of --fit-operators.
constexpr const char* fitted_files[] = {"L.mtx", "mass.mtx", "eigenvalues.npy", "eigenvectors.npy"};

// The name of a level: "coarse-600.ply" beside "coarse.ply".
std::string level_name(const std::string& path, const std::size_t level)
{
  const std::filesystem::path p(path);
  return (p.parent_path() / (p.stem().string() + "-" + std::to_string(level) + p.extension().string()))
      .string();
}

// Makes room for every output, so that what cannot be written is known before the work.
void announce(Output_files& files, const Arguments& a)
{
  files.add(a.output, Output_files::Input::may_be_replaced);
  for(const std::string& path : {a.restriction, a.prolongation, a.map, a.json, a.report, a.repaired})
    if(!path.empty())
      files.add(path);
  for(const std::size_t level : a.levels)
    for(const std::string& path : {a.output, a.restriction, a.map})
      if(!path.empty())
        files.add(level_name(path, level));
  const auto add_folder = [&files](const std::string& folder, const auto& names) {
    if(folder.empty())
      return;
    files.add_folder(folder);
    for(const std::string name : names)
      files.add(folder + "/" + name);
  };
  add_folder(a.eigenpairs, eigenpairs_files);
  if(has_coefficients(a) && !a.eigenpairs.empty())
    files.add(a.eigenpairs + coefficients_file);
  add_folder(a.fit_operators, fitted_files);
}

// What the input has and the output will not have; empty if there is nothing.
std::string lost_attributes(const Vertex_attributes& attributes, const std::string& output)
{
  Vertex_attributes others = attributes;
  others.remove(writable(attributes, output).names());
  std::vector<std::string> lost = others.names();
  const bool of_format = !lost.empty();
  lost.insert(lost.end(), others.unknown.begin(), others.unknown.end());
  return lost.empty() ? ""
                      : "The output is without what the input has beside: " + printable(joined(lost)) +
                            (of_format ? "; a .ply file holds more." : ".");
}

// What becomes of seams that are not kept; empty if there are none.
std::string lost_seams(const Arguments& a, const Input_mesh& input)
{
  if(a.keep_seams || input.texture.empty())
    return "";
  const std::size_t n = Texture_seams(input.mesh, input.texture).number_of_edges();
  return n == 0 ? ""
                : "The seams of the texture, " + std::to_string(n) + (n == 1 ? " edge" : " edges") +
                      ", are lost: add --keep-seams, and write an .obj file.";
}

// The seams to keep.
std::optional<Texture_seams> seams_of(const Arguments& a, Input_mesh& input)
{
  if(!a.keep_seams)
    return {};
  if(input.texture.empty())
    throw std::runtime_error("there are no seams to keep in '" + a.input + "', " + input.without_texture +
                             ": leave out --keep-seams.");
  return Texture_seams(input.mesh, std::move(input.texture));
}

// Both meshes as matrices, as far as the outputs need them.
struct Both_meshes
{
  SG::Mesh_matrices fine, coarse;
  SG::Laplace_operator fine_operator, coarse_operator;
  std::shared_ptr<const SG::Eigenpairs> fine_pairs;
  SG::Eigenpairs coarse_pairs;
};

SMS::Spectral_edge_collapse_options options_of_run(const Arguments& a, const std::size_t target,
                                                   const Vertex_numbering& numbering,
                                                   const std::optional<Texture_seams>& seams,
                                                   Progress_bar& bar)
{
  SMS::Spectral_edge_collapse_options options =
      options_of({a.preset, target, a.placement, a.mass, a.self_intersections, a.relocate, a.shape,
                  a.quadrics_above, a.flips});
  options.number_of_eigenvectors = a.eigenvectors;
  options.binary = a.binary;
  options.preserve_border = a.preserve_border;
  options.boundary = value_of(boundary_words, a.boundary);
  options.intrinsic_delaunay = a.intrinsic_delaunay;
  options.threads = a.threads;
  if(a.pre_simplify)
    options.pre_simplify = static_cast<std::size_t>(*a.pre_simplify);
  options.progress = [&bar](const SMS::Spectral_progress& progress) {
    bar.show(word_of(phase_words, progress.phase), progress.fraction);
    return true;
  };
  options.cancel = &interrupted;
  if(!a.levels.empty()) { // one run for all of them: the largest decides
    if(!a.quadrics_above)
      options.quadrics_above *= double(a.levels.front()) / double(target);
    if(a.signals.empty() && options.source == SMS::Spectral_signal_source::eigenpairs)
      options.weights = SMS::weights_for_target(a.levels.front(), a.eigenvectors);
  }
  if(a.max_error)
    options.maximum_error = *a.max_error;
  std::string said;
  if(a.quadrics_above && quadrics_above_is_passed_over(options, said))
    throw std::runtime_error("--quadrics-above" + said);
  options.fit_operators = !a.fit_operators.empty();
  if(!a.fit_mass.empty())
    options.operator_fit = SG::Operator_fit_options::for_mass(a.fit_mass == "edges" ? 1. : 0.);
  if(a.fit_rings)
    options.operator_fit.rings = *a.fit_rings;
  if(!a.keep.empty())
    options.kept_vertices =
        numbering.vertices_of_mesh(read_indices(a.keep, numbering.number_of_file_vertices()), a.keep);
  if(seams)
    options.kept_vertices.insert(options.kept_vertices.end(), seams->vertices().begin(),
                                 seams->vertices().end());
  if(!a.signals.empty())
    options.signals = numbering.rows_of_mesh(read_signals(a.signals, numbering.number_of_file_vertices()));
  return options;
}

// Says how much memory the run will take, and refuses what the machine does not have. The evaluation, which comes when the result
// is on the disk, is warned of only.
void check_memory(const Arguments& a, const Mesh& mesh, const std::size_t target,
                  const SMS::Spectral_edge_collapse_options& options)
{
  const std::size_t n = num_vertices(mesh);
  const Eigen::Index K = options.signals.size() != 0 ? options.signals.cols() : Eigen::Index(a.eigenvectors);
  const double needed = SMS::estimated_memory(n, K, options), available = available_memory();
  if(available > 0 && needed > available)
    throw std::runtime_error("a mesh of " + std::to_string(n) + " vertices with " + std::to_string(K) +
                             " eigenvectors takes about " + formatted_memory(needed) +
                             " of memory, but this machine has " + formatted_memory(available) +
                             " left: add --pre-simplify 100000, or lower --eigenvectors.");
  const bool reduced = options.pre_simplify != 0 && n > options.pre_simplify;
  const bool pairs_are_known = options.signals.size() == 0 && !reduced;
  const double judging =
      a.no_evaluation ? 0. : SMS::estimated_evaluation_memory(n, target, K, {}, pairs_are_known);
  if(available > 0 && judging > available && !a.quiet)
    std::cerr << "spectral_simplify: warning: The evaluation takes about " << formatted_memory(judging)
              << ", more than the " << formatted_memory(available)
              << " that are left: add --no-evaluation.\n";
  if(!a.quiet)
    std::cout << "memory: about " << formatted_memory((std::max)(needed, judging))
              << (available > 0 ? " of the " + formatted_memory(available) + " that are available" : "")
              << "\n\n"
              << std::flush;
}

// Compares the spectra, with tight pairs of the whole input; a tenth more coarse modes tells loss from exchange at the cut, see `Spectral_evaluation`.
SG::Spectral_evaluation evaluate(Both_meshes& meshes, const SMS::Spectral_edge_collapse_options& run,
                                 const SMS::Spectral_edge_collapse_result& result, Progress_bar& bar)
{
  SMS::Spectral_options of_coarse = run;
  of_coarse.coefficients = result.coefficients;
  meshes.fine_operator = SMS::internal::operator_of_basis(meshes.fine.V, meshes.fine.T, run);
  meshes.coarse_operator = SMS::internal::operator_of_basis(meshes.coarse.V, meshes.coarse.T, of_coarse);
  SG::Eigenpairs_options options;
  options.progress = [&bar](double fraction) {
    bar.show("evaluation", fraction);
    return !interrupted;
  };
  // With signals of the user's, the run has not needed those of the input.
  meshes.fine_pairs = result.eigenpairs;
  if(!meshes.fine_pairs || meshes.fine_pairs->vectors.rows() != meshes.fine.V.rows())
    meshes.fine_pairs = std::make_shared<SG::Eigenpairs>(
        SG::eigenpairs(meshes.fine_operator, run.number_of_eigenvectors, options));
  const Eigen::Index K = meshes.fine_pairs->size(),
                     N = meshes.coarse_operator.L.rows() - meshes.coarse_operator.vanishing;
  meshes.coarse_pairs = SG::eigenpairs(meshes.coarse_operator, (std::min)(N, K + (K + 9) / 10), options);
  return SG::evaluate_spectrum(meshes.fine_operator, *meshes.fine_pairs, meshes.coarse_operator,
                               meshes.coarse_pairs, result.restriction, K);
}

// Judges fitted operators by the norms of the mesh's own.
Fitted_operators judge_fit(const SG::Operator_fit_result& fit, const Both_meshes& meshes,
                           const Eigen::SparseMatrix<double>& P, Progress_bar& bar)
{
  SG::Eigenpairs_options options;
  options.progress = [&bar](double fraction) {
    bar.show("evaluation", fraction);
    return !interrupted;
  };
  Fitted_operators result;
  result.pairs = SG::eigenpairs(fit.op, meshes.coarse_pairs.size(), options);
  result.evaluation = SG::evaluate_spectrum(meshes.fine_operator, *meshes.fine_pairs, fit.op, result.pairs, P,
                                            meshes.fine_pairs->size());
  return result;
}

// Everything at input scale, so that C = coarse_eigenvectors^T coarse_mass P fine_eigenvectors holds between the files
// unless vertices of INPUT were doubled.
void write_eigenpairs(const Output_files& files, const std::string& folder, const Both_meshes& meshes,
                      const Vertex_numbering& numbering, const SMS::Spectral_edge_collapse_result& result)
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
  npy("fine_eigenvectors", numbering.rows_of_file(fine.vectors));
  npy("coarse_eigenvalues", coarse_values);
  npy("coarse_eigenvectors", coarse_vectors);
  npy("C", SG::functional_map(coarse_vectors, meshes.coarse_operator.B, result.restriction, fine.vectors));
  mtx("fine_L", numbering.operator_of_file(meshes.fine_operator.L));
  mtx("fine_mass", numbering.operator_of_file(meshes.fine_operator.B));
  mtx("coarse_L", meshes.coarse_operator.L);
  mtx("coarse_mass", meshes.coarse_operator.B);
  if(result.coefficients.rows() != 0)
    write_npy(files.temporary(folder + coefficients_file), Eigen::MatrixXd(result.coefficients),
              folder + coefficients_file);
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
  if(has_coefficients(a))
    run.simplifier += ", " + a.operator_word;
  if(a.boundary != "neumann")
    run.simplifier += ", " + a.boundary;
  if(a.binary)
    run.simplifier += ", binary";
  if(a.flips != "none")
    run.simplifier += ", " + a.flips + " flips";
  run.relocation = relocation_word(report.options);
  run.placement = word_of(placement_words, report.options.placement);
  run.metric_mass = SG::mass_name(report.options.mass);
  run.shape_term = report.options.shape;
  run.requested_vertices = run.vertices = result.output_vertices;
  run.faces = mesh.number_of_faces();
  run.seconds = result.seconds_collapse;
  run.seconds_eigenpairs = result.seconds_eigenpairs;
  run.note = result.explanation;
  Comparison comparison = single_run(*report.evaluation, run);
  if(report.fitted) {
    run.simplifier += ", fitted operators";
    comparison.results.push_back(single_run(report.fitted->evaluation, std::move(run)).results.front());
  }
  comparison.command = a.command;
  comparison.mesh = std::filesystem::path(a.input).filename().string();
  comparison.vertices = result.input_vertices;
  comparison.faces = static_cast<std::size_t>(meshes.fine.T.rows());
  comparison.threads = a.threads;
  comparison.notes = result.warnings;
  return html_report(comparison, plain_words(comparison, has_coefficients(a) ? "mass" : "area") +
                                     shape_view({meshes.fine, *meshes.fine_pairs},
                                                {meshes.coarse, meshes.coarse_pairs}, *report.evaluation));
}

// What the evaluation makes.
void write_evaluation(const Output_files& files, const Arguments& a, const Mesh& mesh,
                      const Both_meshes& meshes, const Vertex_numbering& numbering,
                      const Simplification_report& report)
{
  if(!a.eigenpairs.empty())
    write_eigenpairs(files, a.eigenpairs, meshes, numbering, report.result);
  if(report.fitted) {
    const auto path = [&a](const std::string& name) { return a.fit_operators + "/" + name; };
    write_matrix_market(files.temporary(path("L.mtx")), report.result.fitted->op.L, path("L.mtx"));
    write_matrix_market(files.temporary(path("mass.mtx")), report.result.fitted->op.B, path("mass.mtx"));
    const Eigen::Index K = meshes.fine_pairs->size();
    const Eigen::VectorXd values = report.fitted->pairs.values.head(K);
    const Eigen::MatrixXd vectors = report.fitted->pairs.vectors.leftCols(K);
    write_npy(files.temporary(path("eigenvalues.npy")), values, path("eigenvalues.npy"));
    write_npy(files.temporary(path("eigenvectors.npy")), vectors, path("eigenvectors.npy"));
  }
  if(!a.report.empty()) {
    std::ofstream stream(files.temporary(a.report));
    stream << page(a, mesh, meshes, report);
    finish_writing(stream, a.report);
  }
}

void write_json(const Output_files& files, const Arguments& a, const Simplification_report& report)
{
  if(a.json.empty())
    return;
  std::ofstream stream(files.temporary(a.json));
  stream << json_text(to_json(report), 2);
  finish_writing(stream, a.json);
}

// Writes a mesh, P and the map, whose vertices of the fine mesh become those of INPUT; `name` tells what each is called.
template <class Name>
void write_mesh_and_maps(const Output_files& files, const Arguments& a, const Input_mesh& input,
                         const std::optional<Texture_seams>& seams, const Mesh& mesh,
                         const Eigen::SparseMatrix<double>& P, const std::vector<std::size_t>& map,
                         const Name& name, std::vector<std::string>& written)
{
  const auto file = [&](const std::string& path) {
    written.push_back(name(path));
    return files.temporary(name(path));
  };
  write_mesh(file(a.output), mesh, name(a.output),
             input.attributes.known.empty()
                 ? Vertex_attributes()
                 : restricted(input.attributes, input.numbering.columns_of_file(P)),
             seams ? seams->simplified(mesh, map) : Corner_texture());
  if(!a.restriction.empty())
    write_matrix_market(file(a.restriction), input.numbering.columns_of_file(P, a.binary),
                        name(a.restriction));
  if(!a.map.empty())
    write_indices(file(a.map), input.numbering.map_of_file(map, no_vertex), name(a.map));
}

// Writes the levels that the run has reached, from its log and a copy of the input, and returns them.
std::vector<std::size_t> write_levels(const Output_files& files, const Arguments& a, const Input_mesh& input,
                                      const std::optional<Texture_seams>& seams, Mesh& copy,
                                      const SMS::Collapse_log& log, std::vector<std::string>& written)
{
  std::vector<std::size_t> levels;
  SMS::Collapse_replay<Mesh> replay(copy, log);
  for(const std::size_t level : a.levels) {
    if(level < log.number_of_vertices_left())
      break;
    replay.collapse_to(level);
    write_mesh_and_maps(
        files, a, input, seams, copy, replay.restriction(), replay.vertex_map(),
        [level](const std::string& path) { return level_name(path, level); }, written);
    levels.push_back(level);
  }
  return levels;
}

// How well the spectrum was kept.
void evaluate(Simplification_report& report, const Arguments& a, Both_meshes& meshes, Progress_bar& bar)
{
  CGAL::Real_timer timer;
  timer.start();
  report.evaluation = evaluate(meshes, report.options, report.result, bar);
  report.seconds_evaluation = timer.time();
  // E is summed over the vertices that are left. What is worn away from a border, where faces are of very different sizes, is not in it.
  const double area = report.evaluation->area_ratio;
  if(area < 0.25 && !has_coefficients(a))
    report.result.warnings.push_back(
        "Only " + arguments_internal::shown(100 * area) +
        " % of the area is left, and the relative error does not see what is "
        "gone: ask for more vertices, or remesh so that faces differ less in size.");
}

// What the fit minimises is neither norm: a warning says where the mesh's own operators are better.
void add_fit(Simplification_report& report, const Both_meshes& meshes, Progress_bar& bar)
{
  report.fitted = judge_fit(*report.result.fitted, meshes, report.result.restriction, bar);
  const SG::Spectral_evaluation &own = *report.evaluation, &e = report.fitted->evaluation;
  const auto larger = [](const double fitted, const double own_figure) { return fitted > 1.1 * own_figure; };
  const std::string worse = larger(e.norm_L, own.norm_L)             ? "|C|_L"
                            : larger(e.norm_D, own.norm_D)           ? "|C|_D"
                            : larger(e.errors.mean, own.errors.mean) ? "mean error of the eigenvalues"
                                                                     : "";
  if(!worse.empty())
    report.result.warnings.push_back(
        "The fitted operators have a " + worse + " more than a tenth larger than the mesh's own" +
        (report.options.operator_fit.rings == 1 ? ": --fit-rings 2 may do better." : "."));
}

void say(const Arguments& a, const Simplification_report& report)
{
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

// Writes what the run made and gives it its names: nothing that fails later may lose it.
void write_result(Output_files& files, const Arguments& a, const Input_mesh& input,
                  const std::optional<Texture_seams>& seams, const Mesh& mesh, Mesh& copy,
                  Both_meshes& meshes, Simplification_report& report)
{
  std::vector<std::string> written;
  CGAL::Real_timer timer;
  timer.start();
  write_mesh_and_maps(
      files, a, input, seams, mesh, report.result.restriction, report.result.vertex_map,
      [](const std::string& path) { return path; }, written);
  if(!a.levels.empty())
    report.levels = write_levels(files, a, input, seams, copy, report.result.log, written);
  if(!a.prolongation.empty()) {
    write_matrix_market(
        files.temporary(a.prolongation),
        input.numbering.rows_of_file(SG::closest_point_interpolation(meshes.fine.V, meshes.coarse)),
        a.prolongation);
    written.push_back(a.prolongation);
  }
  written.push_back(a.repaired); // from before the run
  if(interrupted && a.on_interrupt != "write")
    throw SG::Cancelled();
  files.commit(written);
  report.seconds_writing = timer.time();
}

// Evaluates and writes what is said about the result; returns the exit status. Whatever fails here leaves the result where it is.
int evaluate_and_write(Output_files& files, const Arguments& a, const Input_mesh& input, const Mesh& mesh,
                       Both_meshes& meshes, Progress_bar& bar, Simplification_report& report)
{
  std::string failure;
  std::vector<std::string> written = {a.json};
  try {
    if(!a.no_evaluation && !interrupted) {
      evaluate(report, a, meshes, bar);
      if(report.result.fitted)
        add_fit(report, meshes, bar);
      write_evaluation(files, a, mesh, meshes, input.numbering, report);
      written.push_back(a.report);
      for(const std::string name : eigenpairs_files)
        written.push_back(a.eigenpairs + "/" + name);
      if(has_coefficients(a))
        written.push_back(a.eigenpairs + coefficients_file);
      for(const std::string name : fitted_files)
        written.push_back(a.fit_operators + "/" + name);
    }
    write_json(files, a, report);
    files.commit(written);
    return interrupted ? 130 : 0;
  } catch(const SG::Cancelled&) {
  } catch(const std::bad_alloc&) {
    failure = "the memory does not suffice.";
  } catch(const std::exception& error) {
    failure = error.what();
  }
  bar.clear();
  if(!failure.empty())
    complain("'" + a.output + "' is written, but its evaluation failed: " + failure);
  try {
    write_json(files, a, report);
    files.commit({a.json});
  } catch(const std::exception& error) {
    if(failure.empty())
      complain(error.what());
  }
  return failure.empty() ? 130 : evaluation_failed;
}

int run(Arguments a)
{
  a.threads = usable_threads(a.threads, a.quiet);
  Progress_bar bar(!a.quiet);
  CGAL::Real_timer timer;
  timer.start();
  bar.show("reading", 0);
  Input_mesh input = read_input_mesh(a.input, mending(a.strict, a.repair), !a.no_attributes);
  const std::string lost_edges = lost_seams(a, input);
  const std::optional<Texture_seams> seams = seams_of(a, input);
  if(seams) // at corners instead
    input.attributes.remove({"s", "t"});
  bar.clear();
  Simplification_report report;
  report.seconds_reading = timer.time();
  const std::size_t target = resolve_sizes(a, num_vertices(input.mesh), seams ? seams->vertices().size() : 0);
  SMS::Spectral_edge_collapse_options options = options_of_run(a, target, input.numbering, seams, bar);
  options.coefficients = operator_coefficients(a.operator_, input.mesh, input.numbering);
  Output_files files({a.input, a.keep, a.signals, a.operator_.file});
  announce(files, a);
  check_memory(a, input.mesh, target, options);
  if(!a.quiet && !input.changes.empty())
    std::cout << printable(input.changes_of(a.input)) << "\n\n" << std::flush;
  Mesh mesh = std::move(input.mesh), copy;
  if(!a.repaired.empty())
    write_mesh(files.temporary(a.repaired), mesh, a.repaired);
  if(!a.levels.empty())
    copy = mesh;
  Both_meshes meshes;
  if(!a.no_evaluation || !a.prolongation.empty())
    meshes.fine = SG::mesh_matrices(mesh);

  report.result = simplify_mesh(mesh, target, options);
  if(interrupted && a.on_interrupt != "write")
    throw SG::Cancelled();
  const std::vector<std::string> warnings =
      input.diagnosis.warnings(static_cast<std::size_t>(a.eigenvectors), target);
  report.result.warnings.insert(report.result.warnings.end(), warnings.begin(), warnings.end());
  report.repairs = input.changes;
  report.input = a.input;
  report.output = a.output;
  report.preset = a.preset;
  report.operator_word = a.operator_word;
  report.options = options;
  report.attributes = writable(input.attributes, a.output).names();
  const std::string lost = lost_attributes(input.attributes, a.output);
  for(const std::string& loss : {lost, lost_edges})
    if(!loss.empty())
      report.result.warnings.push_back(loss);
  if(seams)
    report.seam_edges = seams->number_of_edges();
  meshes.coarse = SG::mesh_matrices(mesh);
  bar.show("writing", 0);
  write_result(files, a, input, seams, mesh, copy, meshes, report);
  const int status = evaluate_and_write(files, a, input, mesh, meshes, bar, report);
  bar.clear();
  say(a, report);
  if(status == 130)
    complain("interrupted, what had been done is written.");
  return status;
}

int main(int argc, char* argv[])
{
  return run_program("spectral_simplify", [&] {
    const Arguments arguments = parse_arguments(argc, argv);
    if(arguments.help.empty())
      return run(arguments);
    std::cout << arguments.help;
    return 0;
  });
}
