// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Simplifies a mesh and says how well its spectrum was kept, as the arguments of the program say.

#include "io/Progress_bar.h"
#include "io/index_reader.h"
#include "io/face_attributes.h"
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
#include <CGAL/Spectral_toolbox/Spectral_memory_estimate.h>
#include <CGAL/Spectral_toolbox/fit_operators_of_run.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>

#include <algorithm>
#include <cmath>
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

// The files of --fit-operators.
constexpr const char* fitted_files[] = {"L.mtx", "mass.mtx", "eigenvalues.npy", "eigenvectors.npy"};

// The name of a level: "coarse-600.ply" beside "coarse.ply".
std::string level_name(const std::string& path, const std::size_t level)
{
  const std::filesystem::path p(path);
  return (p.parent_path() /
          (p.stem().string() + "-" + std::to_string(level) + p.extension().string()))
      .string();
}

// Makes room for every output, so that what cannot be written is known before the work.
void announce(Output_files& files, const Arguments& a)
{
  files.add(a.output, Output_files::Input::may_be_replaced);
  for(const std::string& path :
      {a.restriction, a.prolongation, a.map, a.json, a.report, a.repaired})
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

// The names of attributes of faces, as they stand beside those of vertices.
std::vector<std::string> names_of_faces(const Attributes& attributes)
{
  std::vector<std::string> names;
  for(const Attribute& a : attributes.known)
    names.push_back(a.name + " of faces");
  return names;
}

// What the input has and the output will not have; empty if there is nothing.
std::string lost_attributes(const Input_mesh& input, const std::string& output)
{
  Attributes at_vertices = input.attributes, at_faces = input.face_attributes;
  at_vertices.remove(writable(input.attributes, output).names());
  at_faces.remove(writable_at_faces(input.face_attributes, output).names());
  std::vector<std::string> lost = at_vertices.names();
  for(const std::string& name : names_of_faces(at_faces))
    lost.push_back(name);
  const bool of_format = !lost.empty();
  for(const Attributes* const a : {&at_vertices, &at_faces})
    lost.insert(lost.end(), a->unknown.begin(), a->unknown.end());
  return lost.empty()
             ? ""
             : "The output is without what the input has beside: " + printable(joined(lost)) +
                   (of_format ? "; a .ply file holds more." : ".");
}

// What becomes of seams that are not kept; empty if there are none.
std::string lost_seams(const Arguments& a, const Input_mesh& input)
{
  if(a.kept.seams || input.texture.empty())
    return "";
  const std::size_t n = Texture_seams(input.mesh, input.texture).number_of_edges();
  return n == 0 ? ""
                : "The seams of the texture, " + std::to_string(n) + (n == 1 ? " edge" : " edges") +
                      ", are lost: add --keep seams, and write an .obj file.";
}

// The seams to keep.
std::optional<Texture_seams> seams_of(const Arguments& a, Input_mesh& input)
{
  if(!a.kept.seams)
    return {};
  if(input.texture.empty())
    throw std::runtime_error("there are no seams to keep in '" + a.input + "', " +
                             input.without_texture + ": leave out the word seams of --keep.");
  return Texture_seams(input.mesh, std::move(input.texture));
}

// Both meshes as matrices, as far as the outputs need them.
struct Both_meshes
{
  SG::Mesh_matrices fine, coarse;
  SG::Laplace_operator fine_operator, coarse_operator;
  std::shared_ptr<const SG::Eigenpairs> fine_pairs;
  SG::Eigenpairs coarse_pairs;
  Eigen::SparseMatrix<double> prolongation;
};

// Q, made once for its file and for the evaluation.
const Eigen::SparseMatrix<double>& prolongation(Both_meshes& meshes,
                                                const SMS::Spectral_edge_collapse_result& result)
{
  if(meshes.prolongation.size() == 0)
    meshes.prolongation =
        SG::closest_point_prolongation(meshes.fine, meshes.coarse, result.restriction);
  return meshes.prolongation;
}

// What --keep names, by places in `vertices(mesh)`, each once.
std::vector<std::size_t> kept_vertices(const Arguments& a, const Input_mesh& input,
                                       const std::optional<Texture_seams>& seams)
{
  std::vector<std::size_t> kept = feature_vertices(input.mesh, a.kept);
  const auto add = [&kept](const std::vector<std::size_t>& more) {
    kept.insert(kept.end(), more.begin(), more.end());
  };
  for(const std::string& file : a.kept.files)
    add(input.numbering.vertices_of_mesh(
        read_indices(file, input.numbering.number_of_file_vertices()), file));
  if(seams)
    add(seams->vertices());
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

// Carries as labels what --labels names.
void set_labels(const Arguments& a, Input_mesh& input)
{
  for(const std::string& name : a.labels) {
    bool found = false;
    for(Attributes* const attributes : {&input.attributes, &input.face_attributes})
      for(Attribute& attribute : attributes->known)
        if(attribute.name == name) {
          attribute.kind = Attribute::Kind::label;
          found = true;
        }
    if(!found) {
      std::vector<std::string> names = input.attributes.names();
      for(const std::string& of_faces : names_of_faces(input.face_attributes))
        names.push_back(of_faces);
      throw std::runtime_error("--labels names '" + name + "', but '" + a.input + "' has " +
                               (names.empty() ? "no attributes" : "only " + joined(names)) +
                               ": choose among them, or leave it out.");
    }
  }
}

SMS::Spectral_edge_collapse_options options_of_run(const Arguments& a, const std::size_t target,
                                                   const Vertex_numbering& numbering,
                                                   std::vector<std::size_t> kept, Progress_bar& bar)
{
  SMS::Spectral_edge_collapse_options options =
      options_of({a.preset, a.levels.empty() ? target : std::size_t(a.levels.front()), a.placement,
                  a.mass, a.self_intersections, a.relocate, a.prefer, a.shape, a.quadrics_above});
  options.number_of_eigenvectors = a.eigenvectors;
  options.binary = a.binary;
  options.preserve_border = a.preserve_border;
  options.boundary = value_of(boundary_words, a.boundary);
  if(a.intrinsic_delaunay)
    options.operator_of_eigenpairs = intrinsic_operator(options.mass);
  options.threads = a.threads;
  options.progress = [&bar](const SG::Progress& progress) {
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
  options.kept_vertices = std::move(kept);
  if(!a.signals.empty())
    options.signals =
        numbering.rows_of_mesh(read_signals(a.signals, numbering.number_of_file_vertices()));
  return options;
}

// Says how much memory the run will take, and refuses what the machine does not have. The
// evaluation, which comes when the result is on the disk, is warned of only.
void check_memory(const Arguments& a, const Mesh& mesh, const std::size_t target,
                  const SMS::Spectral_edge_collapse_options& options)
{
  const std::size_t n = num_vertices(mesh);
  const Eigen::Index K =
      options.signals.size() != 0 ? options.signals.cols() : Eigen::Index(a.eigenvectors);
  const double needed = SMS::estimated_memory(n, K, options, !a.fit_operators.empty()),
               available = available_memory();
  const bool reduced = options.pre_simplify != 0 && n > options.pre_simplify;
  const std::size_t intermediate = 100000;
  if(available > 0 && needed > available)
    throw std::runtime_error(
        "a mesh of " + std::to_string(n) + " vertices with " + std::to_string(K) +
        " eigenvectors takes about " + formatted_memory(needed) +
        " of memory, but this machine has " + formatted_memory(available) + " left: " +
        (a.signals.empty() && (reduced ? options.pre_simplify : n) > intermediate
             ? "add --pre-simplify " + std::to_string(intermediate) + ", or "
             : std::string()) +
        "lower --eigenvectors.");
  const bool pairs_are_known = options.signals.size() == 0 && !reduced;
  const double judging =
      a.no_evaluation ? 0. : SMS::estimated_evaluation_memory(n, target, K, {}, pairs_are_known);
  if(available > 0 && judging > available && !a.quiet)
    std::cerr << "spectral_simplify: warning: The evaluation takes about "
              << formatted_memory(judging) << ", more than the " << formatted_memory(available)
              << " that are left: add --no-evaluation.\n";
  if(!a.quiet)
    std::cout << "memory: about " << formatted_memory((std::max)(needed, judging))
              << (available > 0 ? " of the " + formatted_memory(available) + " that are available"
                                : "")
              << "\n\n"
              << std::flush;
}

// Compares the spectra, with tight pairs of the whole input; a tenth more coarse modes tells loss
// from exchange at the cut, see `Spectral_evaluation`.
SG::Spectral_evaluation evaluate(Both_meshes& meshes,
                                 const SMS::Spectral_edge_collapse_options& run,
                                 const SMS::Spectral_edge_collapse_result& result,
                                 Progress_bar& bar)
{
  SMS::Spectral_options of_coarse = run;
  of_coarse.coefficients = result.coefficients;
  meshes.fine_operator = SMS::internal::operator_of_basis(meshes.fine.V, meshes.fine.T, run);
  meshes.coarse_operator =
      SMS::internal::operator_of_basis(meshes.coarse.V, meshes.coarse.T, of_coarse);
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
  meshes.coarse_pairs =
      SG::eigenpairs(meshes.coarse_operator, (std::min)(N, K + (K + 9) / 10), options);
  return SG::evaluate_spectrum(meshes.fine_operator, *meshes.fine_pairs, meshes.coarse_operator,
                               meshes.coarse_pairs, result.restriction, K,
                               prolongation(meshes, result));
}

// Fits operators, and judges them by the norms of the mesh's own.
Fitted_operators fit_and_judge(const Arguments& a, const SMS::Spectral_edge_collapse_options& run,
                               const SMS::Spectral_edge_collapse_result& run_result,
                               const Both_meshes& meshes, Progress_bar& bar)
{
  Fitted_operators result;
  CGAL::Real_timer timer;
  timer.start();
  result.options = SG::Operator_fit_options::for_mass(a.fit_mass.empty() ? SG::mass_blend(run.mass)
                                                      : a.fit_mass == "edges" ? 1.
                                                                              : 0.);
  if(a.fit_rings)
    result.options.rings = *a.fit_rings;
  SG::Operator_fit_options fit = result.options;
  fit.progress = [&bar](double fraction) {
    bar.show("operator_fit", fraction);
    return !interrupted;
  };
  result.fit = SMS::fit_operators_of_run(meshes.fine, meshes.coarse, run, run_result, fit);
  result.seconds = timer.time();
  SG::Eigenpairs_options options;
  options.progress = [&bar](double fraction) {
    bar.show("evaluation", fraction);
    return !interrupted;
  };
  result.pairs = SG::eigenpairs(result.fit.op, meshes.coarse_pairs.size(), options);
  result.evaluation =
      SG::evaluate_spectrum(meshes.fine_operator, *meshes.fine_pairs, result.fit.op, result.pairs,
                            run_result.restriction, meshes.fine_pairs->size(), meshes.prolongation);
  return result;
}

// Everything at input scale, so that C = coarse_eigenvectors^T coarse_mass P fine_eigenvectors
// holds between the files unless vertices of INPUT were doubled.
void write_eigenpairs(const Output_files& files, const std::string& folder,
                      const Both_meshes& meshes, const Vertex_numbering& numbering,
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
  // OUTPUT may have fewer, where functions vanish on its border for instance.
  const Eigen::Index K = (std::min)(fine.size(), meshes.coarse_pairs.size());
  const Eigen::MatrixXd coarse_vectors = meshes.coarse_pairs.vectors.leftCols(K);
  const Eigen::VectorXd coarse_values = meshes.coarse_pairs.values.head(K);
  npy("fine_eigenvalues", fine.values);
  npy("fine_eigenvectors", numbering.rows_of_file(fine.vectors));
  npy("coarse_eigenvalues", coarse_values);
  npy("coarse_eigenvectors", coarse_vectors);
  npy("C", SG::functional_map(coarse_vectors, meshes.coarse_operator.B, result.restriction,
                              fine.vectors));
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
  run.relocation = relocation_word(report.options);
  run.placement = word_of(placement_words, report.options.placement);
  run.metric_mass = SG::mass_name(report.options.mass);
  run.shape_term = report.options.shape;
  run.requested_vertices = run.vertices = result.output_vertices;
  run.faces = mesh.number_of_faces();
  run.note = result.explanation;
  Comparison comparison = single_run(*report.evaluation, run);
  if(report.fitted) {
    run.simplifier += ", fitted operators";
    comparison.results.push_back(
        single_run(report.fitted->evaluation, std::move(run)).results.front());
  }
  comparison.restriction = restriction_in_words(result, report.options);
  comparison.times = times(report);
  comparison.command = a.command;
  comparison.mesh = std::filesystem::path(a.input).filename().string();
  comparison.vertices = result.input_vertices;
  comparison.faces = static_cast<std::size_t>(meshes.fine.T.rows());
  comparison.threads = a.threads;
  comparison.notes = result.warnings;
  return html_report(comparison,
                     plain_words(comparison, has_coefficients(a) ? "mass" : "area") +
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
    write_matrix_market(files.temporary(path("L.mtx")), report.fitted->fit.op.L, path("L.mtx"));
    write_matrix_market(files.temporary(path("mass.mtx")), report.fitted->fit.op.B,
                        path("mass.mtx"));
    const Eigen::Index K = (std::min)(meshes.fine_pairs->size(), report.fitted->pairs.size());
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

// Files of materials, named as seen from the folder of the output.
std::vector<std::string> libraries_from(const std::string& output, const std::string& input,
                                        std::vector<std::string> libraries)
{
  namespace fs = std::filesystem;
  const auto folder = [](const std::string& path) {
    return fs::absolute(path).parent_path().lexically_normal();
  };
  if(folder(output) != folder(input))
    for(std::string& library : libraries)
      if(fs::path(library).is_relative() && fs::exists(folder(input) / library))
        library = (folder(input) / library).lexically_proximate(folder(output)).generic_string();
  return libraries;
}

// Writes a mesh, P and the map, whose vertices of the fine mesh become those of INPUT; `name` tells
// what each is called. The mesh of `input` is as it was read.
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
  Decoration decoration;
  if(!input.attributes.known.empty())
    decoration.vertices = restricted(input.attributes, input.numbering.columns_of_file(P));
  if(!input.face_attributes.known.empty())
    decoration.faces = carried_by_area(input.face_attributes, input.mesh, mesh, map);
  if(seams)
    decoration.texture = seams->simplified(mesh, map);
  decoration.libraries = libraries_from(a.output, a.input, input.material_libraries);
  write_mesh(file(a.output), mesh, name(a.output), decoration);
  if(!a.restriction.empty())
    write_matrix_market(file(a.restriction), input.numbering.columns_of_file(P, a.binary),
                        name(a.restriction));
  if(!a.map.empty())
    write_indices(file(a.map), input.numbering.map_of_file(map, no_vertex), name(a.map));
}

// Writes the levels that the run has reached, from its log and a copy of the input, and returns
// them.
std::vector<std::size_t> write_levels(const Output_files& files, const Arguments& a,
                                      const Input_mesh& input,
                                      const std::optional<Texture_seams>& seams, Mesh& copy,
                                      const SMS::Collapse_log& log,
                                      std::vector<std::string>& written)
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
void evaluate(Simplification_report& report, const Arguments& a, Both_meshes& meshes,
              Progress_bar& bar)
{
  CGAL::Real_timer timer;
  timer.start();
  report.evaluation = evaluate(meshes, report.options, report.result, bar);
  report.rows_off_their_part =
      SG::rows_off_their_part(meshes.coarse, meshes.fine, report.result.restriction).size();
  report.seconds_evaluation = timer.time();
  if(const double error = report.evaluation->errors.mean; error > 0.5)
    report.result.warnings.push_back(
        "Eigenvalues are off by " + arguments_internal::shown(std::round(100 * error)) +
        " % on average, so that the result says little about the input: ask for more "
        "vertices, or for fewer eigenvectors.");
  if(report.rows_off_their_part != 0)
    report.result.warnings.push_back(
        std::to_string(report.rows_off_their_part) +
        " rows of the restriction read functions off another part of the shape "
        "than their neighbours: ask for "
        "more vertices.");
  // E is summed over the vertices that are left. What is worn away from a border, where faces are
  // of very different sizes, is not in it.
  const double area = report.evaluation->area_ratio;
  if(area < 0.25 && !has_coefficients(a))
    report.result.warnings.push_back(
        "Only " + arguments_internal::shown(100 * area) +
        " % of the area is left, and the relative error does not see what is "
        "gone: ask for more vertices, or remesh so that faces differ less in size.");
}

// What the fit minimises is neither norm: a warning says where the mesh's own operators are better.
void add_fit(Simplification_report& report, const Arguments& a, const Both_meshes& meshes,
             Progress_bar& bar)
{
  try {
    report.fitted = fit_and_judge(a, report.options, report.result, meshes, bar);
  } catch(const SG::Cancelled&) {
    throw;
  } catch(const std::runtime_error& error) {
    report.result.warnings.push_back("The operators were not fitted: " + std::string(error.what()));
    return;
  }
  const SG::Spectral_evaluation &own = *report.evaluation, &e = report.fitted->evaluation;
  const auto larger = [](const double fitted, const double own_figure) {
    return fitted > 1.1 * own_figure;
  };
  const std::string worse = larger(e.norm_L, own.norm_L)   ? "|C|_L"
                            : larger(e.norm_D, own.norm_D) ? "|C|_D"
                            : larger(e.errors.mean, own.errors.mean)
                                ? "mean error of the eigenvalues"
                                : "";
  if(!worse.empty())
    report.result.warnings.push_back(
        "The fitted operators have a " + worse + " more than a tenth larger than the mesh's own" +
        (report.fitted->options.rings == 1 ? ": --fit-rings 2 may do better." : "."));
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
    write_matrix_market(files.temporary(a.prolongation),
                        input.numbering.rows_of_file(prolongation(meshes, report.result)),
                        a.prolongation);
    written.push_back(a.prolongation);
  }
  written.push_back(a.repaired); // from before the run
  if(interrupted && a.on_interrupt != "write")
    throw SG::Cancelled();
  files.commit(written);
  report.seconds_writing = timer.time();
}

// Evaluates and writes what is said about the result; returns the exit status. Whatever fails here
// leaves the result where it is.
int evaluate_and_write(Output_files& files, const Arguments& a, const Input_mesh& input,
                       const Mesh& mesh, Both_meshes& meshes, Progress_bar& bar,
                       Simplification_report& report)
{
  std::string failure;
  std::vector<std::string> written = {a.json};
  try {
    if(!a.no_evaluation && !interrupted) {
      evaluate(report, a, meshes, bar);
      if(!a.fit_operators.empty())
        add_fit(report, a, meshes, bar);
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

// How many vertices a mesh has when it has so many faces. A closed mesh has two for each vertex,
// less what its handles take; a border that is not kept is taken to lose vertices as its mesh does.
std::size_t vertices_for_faces(const Arguments& a, const Mesh& mesh)
{
  if(!a.faces)
    return 0;
  const double F = double(mesh.number_of_faces()), V = double(mesh.number_of_vertices());
  const double wanted = double(a.faces->of(mesh.number_of_faces()));
  if(wanted > F)
    throw std::runtime_error("--faces is " + std::to_string(std::size_t(wanted)) + ", but '" +
                             a.input + "' has " + std::to_string(mesh.number_of_faces()) +
                             " faces.");
  const auto edges = mesh.edges();
  const auto border = double(
      std::count_if(edges.begin(), edges.end(), [&](const auto e) { return mesh.is_border(e); }));
  const double twice_characteristic = 2 * V - border - F;
  double vertices = (wanted + twice_characteristic) / 2;
  if(a.kept.border)
    vertices += border / 2;
  for(int i = 0; i < 50 && border > 0 && !a.kept.border; ++i)
    vertices =
        (wanted + twice_characteristic + border * std::sqrt((std::max)(vertices, 0.) / V)) / 2;
  return std::size_t((std::max)((std::min)(std::floor(vertices), V), 1.));
}

// The number of faces follows from that of the vertices where no border loses edges. Else the run
// is done again from a copy, with as many vertices more or less as the faces ask for.
SMS::Spectral_edge_collapse_result
simplify_to_faces(Mesh& mesh, std::size_t target, const std::size_t faces,
                  const SMS::Spectral_edge_collapse_options& options)
{
  const Mesh copy = is_closed(mesh) ? Mesh() : mesh;
  SMS::Spectral_edge_collapse_result result = simplify_mesh(mesh, target, options);
  for(int i = 0; i < 8 && !copy.is_empty() && result.explanation.empty() && !interrupted; ++i) {
    const auto off = static_cast<long>(faces) - static_cast<long>(mesh.number_of_faces());
    if(off == 0 || off == 1 || (i > 3 && off > 0)) // a border may jump over the number
      break;
    const long step = off / 2 + (off < 0 && off % 2 != 0 ? -1 : 0);
    const long next = static_cast<long>(target) + step;
    if(next < 3 || next < static_cast<long>(options.kept_vertices.size()) ||
       next > static_cast<long>(copy.number_of_vertices()))
      break;
    target = static_cast<std::size_t>(next);
    mesh = copy;
    result = simplify_mesh(mesh, target, options);
  }
  return result;
}

// Without an output that has its figures: it takes as long as all the rest of fast.
bool leaves_out_evaluation(const Arguments& a, const std::size_t vertices)
{
  constexpr std::size_t many = 20000;
  return a.preset == "fast" && vertices > many && !a.evaluation && !a.no_evaluation &&
         a.json.empty() && a.report.empty() && a.eigenpairs.empty() && a.fit_operators.empty();
}

int run(Arguments a)
{
  a.threads = usable_threads(a.threads, a.quiet);
  Progress_bar bar(!a.quiet);
  CGAL::Real_timer timer;
  timer.start();
  bar.show("reading", 0);
  Input_mesh input = read_input_mesh(a.input, mending(a.strict, a.repair), !a.no_attributes,
                                     a.drop_debris, not_interrupted);
  const std::string lost_edges = lost_seams(a, input);
  const std::optional<Texture_seams> seams = seams_of(a, input);
  if(seams) // at corners instead
    input.attributes.remove({"s", "t"});
  bar.clear();
  Simplification_report report;
  report.seconds_reading = timer.time();
  if(leaves_out_evaluation(a, num_vertices(input.mesh))) {
    a.no_evaluation = true;
    if(!a.quiet)
      std::cout << "fast does not judge more than 20000 vertices: add --evaluation for that\n\n";
  }
  set_labels(a, input);
  std::vector<std::size_t> kept = kept_vertices(a, input, seams);
  const std::string nothing_kept =
      a.kept.has_features() && feature_vertices(input.mesh, a.kept).empty()
          ? "'" + a.input +
                "' has no vertex at what --keep names: no border, no sharp edge of that angle."
          : "";
  const std::size_t target =
      resolve_sizes(a, num_vertices(input.mesh), kept.size(), vertices_for_faces(a, input.mesh),
                    input.size_of(a.input));
  SMS::Spectral_edge_collapse_options options =
      options_of_run(a, target, input.numbering, std::move(kept), bar);
  options.coefficients = operator_coefficients(a.operator_, input.mesh, input.numbering);
  if(a.pre_simplify)
    options.pre_simplify = static_cast<std::size_t>(*a.pre_simplify);
  else if(a.preset == "best" && a.no_evaluation && a.signals.empty())
    options.pre_simplify = first_stage_of_best(options, target);
  std::vector<std::string> inputs = {a.input, a.signals, a.operator_.file};
  inputs.insert(inputs.end(), a.kept.files.begin(), a.kept.files.end());
  Output_files files(inputs);
  announce(files, a);
  std::vector<std::string> rounded = {a.repaired.empty() ? "" : rounding(input.mesh, a.repaired)};
  rounding(input.mesh, a.output, target);
  check_memory(a, input.mesh, target, options);
  if(!a.quiet && !input.changes.empty())
    std::cout << printable(input.changes_of(a.input)) << "\n\n" << std::flush;
  // What faces have is carried from the mesh as it was.
  const bool stays = !input.face_attributes.known.empty();
  Mesh mesh = stays ? input.mesh : std::move(input.mesh), copy;
  if(!a.repaired.empty())
    write_mesh(files.temporary(a.repaired), mesh, a.repaired);
  if(!a.levels.empty())
    copy = mesh;
  Both_meshes meshes;
  if(!a.no_evaluation || !a.prolongation.empty())
    meshes.fine = SG::mesh_matrices(mesh);

  report.result = a.faces ? simplify_to_faces(mesh, target, a.faces->of(num_faces(mesh)), options)
                          : simplify_mesh(mesh, target, options);
  if(interrupted && a.on_interrupt != "write")
    throw SG::Cancelled();
  const std::vector<std::string> warnings =
      input.diagnosis.warnings(static_cast<std::size_t>(a.eigenvectors));
  report.result.warnings.insert(report.result.warnings.end(), warnings.begin(), warnings.end());
  report.repairs = input.changes;
  report.left_out = input.left_out;
  report.input = a.input;
  report.output = a.output;
  report.preset = a.preset;
  report.operator_word = a.operator_word;
  report.options = options;
  report.attributes = writable(input.attributes, a.output).names();
  for(const std::string& name : names_of_faces(writable_at_faces(input.face_attributes, a.output)))
    report.attributes.push_back(name);
  rounded.push_back(rounding(mesh, a.output));
  for(const std::string& loss : {lost_attributes(input, a.output), lost_edges, rounded[0],
                                 rounded[1], input.still_cut, nothing_kept})
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
