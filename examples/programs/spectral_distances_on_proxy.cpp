// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Spectral distances and signatures on a simplified mesh, brought back to the input in three ways
// and compared with those of the input (section 5.1 of Lescoat et al. 2020); --help shows the
// options.

#include "compare/heaviest_vertices.h"
#include "io/command_line.h"
#include "io/input_mesh.h"
#include "io/machine_memory.h"
#include "io/matrix_io.h"
#include "io/mesh_io.h"
#include "io/output_files.h"
#include "io/program.h"
#include "io/vertex_target.h"
#include "option_words.h"
#include "report/html_report.h"
#include "report/mesh_picture.h"
#include "simplification.h"

#include <CGAL/Real_timer.h>
#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_toolbox/fit_operators_of_run.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_toolbox/spectral_distances.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace SMS = CGAL::Surface_mesh_simplification;
namespace SG = CGAL::Spectral_geometry;

namespace {

struct Distance_arguments
{
  std::string mesh, vertices, report, preset = "best", mass, operators = "fitted", command, help;
  Vertex_target target;
  long eigenvectors = 100, sources = 10;
  int threads = all_threads();
  bool repair = false, strict = false, quiet = false;
};

double seconds_of(const std::function<void()>& work)
{
  CGAL::Real_timer timer;
  timer.start();
  work();
  return timer.time();
}

// A mesh with its spectrum at unit area, as in the figures of the paper.
struct Unit_shape
{
  SG::Mesh_matrices matrices;
  SG::Laplace_operator op;
  SG::Eigenpairs pairs;
  double area = 0, seconds = 0; // of the eigenpairs

  Unit_shape(SG::Mesh_matrices mesh, SG::Laplace_operator of_mesh, Eigen::Index K, int threads)
    : matrices(std::move(mesh))
    , op(std::move(of_mesh))
  {
    area = op.mass.sum();
    op.B /= area;
    op.mass /= area;
    SG::Eigenpairs_options options;
    options.threads = threads;
    options.progress = [](double) { return !interrupted; };
    seconds = seconds_of([&] { pairs = SG::eigenpairs(op, K, options); });
  }
};

// A kind of distance, from all sources at once.
struct Distance
{
  std::string name;
  std::function<Eigen::MatrixXd(const SG::Eigenpairs&, const SG::Distance_sources&)> compute;
};

// Times and energies are those of the fine mesh, for both.
std::vector<Distance> distances(const SG::Eigenpairs& fine)
{
  const SG::Wave_kernel_energies energies = SG::wave_kernel_energies(fine);
  return {{"diffusion, t = 0.01",
           [](const SG::Eigenpairs& p, const SG::Distance_sources& s) {
             return SG::squared_diffusion_distance(p, s, 0.01);
           }},
          {"biharmonic",
           [](const SG::Eigenpairs& p, const SG::Distance_sources& s) {
             return SG::squared_biharmonic_distance(p, s);
           }},
          {"commute time",
           [](const SG::Eigenpairs& p, const SG::Distance_sources& s) {
             return SG::squared_commute_time_distance(p, s);
           }},
          {"wave kernel", [energies](const SG::Eigenpairs& p, const SG::Distance_sources& s) {
             return SG::wave_kernel_distance(p, s, energies);
           }}};
}

// Both meshes and the ways between them.
struct Pair
{
  Unit_shape fine, coarse;
  Eigen::SparseMatrix<double> P, Q; // restriction and prolongation
  std::vector<std::size_t> vertex_map;
  Eigen::MatrixXd C;
  double seconds_simplification = 0, seconds_fit = 0;
  SG::Mass mass = SG::Mass::averaged;

  // Functions on the coarse mesh, one per column, in the way of that number.
  Eigen::MatrixXd bring_back(int way, const Eigen::MatrixXd& g) const
  {
    if(way == 0)
      return Q * g;
    if(way == 1)
      return SG::prolong_through_spectrum(fine.op, fine.pairs, coarse.op, coarse.pairs, C, g);
    Eigen::MatrixXd f(fine.op.mass.size(), g.cols());
    for(Eigen::Index i = 0; i < f.rows(); ++i)
      f.row(i) = g.row(static_cast<Eigen::Index>(vertex_map[static_cast<std::size_t>(i)]));
    return f;
  }
};

constexpr const char* ways[] = {"prolongation", "through the spectrum", "vertex map"};

Pair simplify(const Distance_arguments& a)
{
  Input_mesh input =
      read_input_mesh(a.mesh, mending(a.strict, a.repair), false, 0, not_interrupted);
  Mesh& mesh = input.mesh;
  const std::size_t n = mesh.number_of_vertices(), N = a.target.of(n);
  check_sources(a.sources, n);
  if(N > n || static_cast<long>(N) < a.eigenvectors)
    throw std::runtime_error("--vertices asks for " + std::to_string(N) + ", it must be at least " +
                             std::to_string(a.eigenvectors) +
                             ", the number of eigenvectors, and '" + a.mesh + "' has " +
                             std::to_string(n) + " vertices.");
  if(!a.quiet && !input.changes.empty())
    std::cout << printable(input.changes_of(a.mesh)) << "\n" << std::flush;
  Option_words words;
  words.preset = a.preset;
  words.mass = a.mass;
  SMS::Spectral_edge_collapse_options options = options_of(words);
  options.threads = usable_threads(a.threads, a.quiet);
  options.cancel = &interrupted;
  const SG::Mesh_matrices matrices = SG::mesh_matrices(mesh);
  Unit_shape fine(matrices, SG::laplace_operator(matrices.V, matrices.T, options.mass),
                  a.eigenvectors, options.threads);
  SG::Eigenpairs pairs = fine.pairs; // at the scale of the mesh
  pairs.values /= fine.area;
  pairs.vectors /= std::sqrt(fine.area);
  options.eigenpairs = std::make_shared<SG::Eigenpairs>(std::move(pairs));
  const SMS::Spectral_edge_collapse_result result = simplify_mesh(mesh, N, options);
  stop_if_interrupted();
  if(!result.explanation.empty())
    throw std::runtime_error(result.explanation);
  CGAL::Real_timer timer;
  timer.start();
  SG::Mesh_matrices left = SG::mesh_matrices(mesh);
  SG::Laplace_operator op = a.operators == "fitted"
                                ? SMS::fit_operators_of_run(matrices, left, options, result).op
                                : SG::laplace_operator(left.V, left.T, options.mass);
  const double seconds_fit = a.operators == "fitted" ? timer.time() : 0;
  Pair pair{std::move(fine),
            Unit_shape(std::move(left), std::move(op), a.eigenvectors, options.threads),
            result.restriction,
            {},
            result.vertex_map,
            {},
            result.seconds_total,
            seconds_fit,
            options.mass};
  pair.Q = SG::closest_point_prolongation(pair.fine.matrices, pair.coarse.matrices, pair.P);
  pair.C = SG::functional_map(pair.coarse.pairs.vectors, pair.coarse.op.B, pair.P,
                              pair.fine.pairs.vectors);
  return pair;
}

// Sum of mass |g - f| over sum of mass |f|, mean over the columns.
double relative_error(const Eigen::VectorXd& mass, const Eigen::MatrixXd& g,
                      const Eigen::MatrixXd& f)
{
  const Eigen::RowVectorXd errors = mass.transpose() * (g - f).cwiseAbs(),
                           sizes = mass.transpose() * f.cwiseAbs();
  return (errors.array() / sizes.array()).mean();
}

struct Distance_row
{
  std::string name;
  double errors[3];
  double seconds_fine = 0, seconds_coarse = 0;
  Eigen::VectorXd fine, coarse; // of the first source
};

// The sources on the coarse mesh are their closest points.
Distance_row compare(const Distance& distance, const Pair& pair,
                     const std::vector<Eigen::Index>& sources)
{
  Eigen::SparseMatrix<double> chosen(static_cast<Eigen::Index>(sources.size()), pair.Q.rows());
  for(std::size_t s = 0; s < sources.size(); ++s)
    chosen.insert(static_cast<Eigen::Index>(s), sources[s]) = 1;
  const SG::Distance_sources at_vertices = sources, at_points = chosen * pair.Q;
  Distance_row row;
  row.name = distance.name;
  Eigen::MatrixXd fine, coarse;
  row.seconds_fine = seconds_of([&] { fine = distance.compute(pair.fine.pairs, at_vertices); });
  row.seconds_coarse = seconds_of([&] { coarse = distance.compute(pair.coarse.pairs, at_points); });
  for(int way = 0; way < 3; ++way)
    row.errors[way] = relative_error(pair.fine.op.mass, pair.bring_back(way, coarse), fine);
  row.fine = fine.col(0);
  row.coarse = coarse.col(0);
  return row;
}

// Signatures of the coarse mesh against those of the fine one at the heaviest vertex of each
// cluster: P of a signature, a mean of squares, is not the signature of P. Means over times or
// energies.
std::vector<std::pair<std::string, double>> signature_errors(const Pair& pair)
{
  const std::vector<Eigen::Index> heaviest = heaviest_vertices(pair.P);
  const auto error = [&](const Eigen::MatrixXd& fine, const Eigen::MatrixXd& coarse) {
    Eigen::MatrixXd at_heaviest(coarse.rows(), coarse.cols());
    for(Eigen::Index i = 0; i < coarse.rows(); ++i)
      at_heaviest.row(i) = fine.row(heaviest[static_cast<std::size_t>(i)]);
    return relative_error(pair.coarse.op.mass, coarse, at_heaviest);
  };
  const Eigen::VectorXd times = SG::heat_kernel_times(pair.fine.pairs);
  const SG::Wave_kernel_energies energies = SG::wave_kernel_energies(pair.fine.pairs);
  return {{"heat kernel signature", error(SG::heat_kernel_signature(pair.fine.pairs, times),
                                          SG::heat_kernel_signature(pair.coarse.pairs, times))},
          {"wave kernel signature", error(SG::wave_kernel_signature(pair.fine.pairs, energies),
                                          SG::wave_kernel_signature(pair.coarse.pairs, energies))}};
}

struct Summary
{
  std::vector<Distance_row> rows;
  std::vector<std::pair<std::string, double>> signatures;

  double seconds(double Distance_row::*which) const
  {
    double sum = 0;
    for(const Distance_row& row : rows)
      sum += row.*which;
    return sum;
  }
};

void print(const Pair& pair, const Summary& s)
{
  std::printf("%ld -> %ld vertices, simplified in %.2f s",
              static_cast<long>(pair.fine.op.mass.size()),
              static_cast<long>(pair.coarse.op.mass.size()), pair.seconds_simplification);
  if(pair.seconds_fit > 0)
    std::printf(", operators fitted in %.2f s", pair.seconds_fit);
  std::printf("\n\n");
  std::printf("%-24s %14s %14s %14s %10s\n", "relative error", "prolongation", "spectrum",
              "vertex map", "speed-up");
  for(const Distance_row& row : s.rows)
    std::printf("%-24s %12.2f %% %12.2f %% %12.2f %% %10.1f\n", row.name.c_str(),
                100 * row.errors[0], 100 * row.errors[1], 100 * row.errors[2],
                row.seconds_fine / row.seconds_coarse);
  for(const auto& [name, error] : s.signatures)
    std::printf("%-24s %12.2f %% at the heaviest vertices\n", name.c_str(), 100 * error);
  const double fine = pair.fine.seconds + s.seconds(&Distance_row::seconds_fine);
  const double coarse = pair.coarse.seconds + s.seconds(&Distance_row::seconds_coarse);
  std::printf("\neigenpairs and distances: %.3f s fine, %.3f s coarse, %.1f times faster\n", fine,
              coarse, fine / coarse);
}

std::string figures(const Pair& pair, const Summary& s)
{
  std::string html;
  for(const Distance_row& row : s.rows) {
    const double largest = row.fine.maxCoeff();
    const auto figure = [&](const SG::Mesh_matrices& mesh, const Eigen::VectorXd& squared,
                            const std::string& caption) {
      // All but the wave kernel's are squares: their roots are what looks like a distance.
      const bool is_squared = row.name != "wave kernel";
      const Eigen::VectorXd shown =
          is_squared ? Eigen::VectorXd((squared.array() / largest).max(0.).sqrt())
                     : Eigen::VectorXd(squared / largest);
      Picture picture;
      picture.width = 400;
      picture.height = 290;
      picture.colours = colours_of_values(shown);
      picture.levels = 15 * shown;
      html += "<figure class='wide'><img alt='" + escaped(caption) + "' src='" +
              mesh_picture(mesh, picture) + "'><figcaption>" + escaped(caption) +
              "</figcaption></figure>\n";
    };
    html += "<h3>" + escaped(row.name) + "</h3>\n<div class='figures'>\n";
    figure(pair.fine.matrices, row.fine, "computed on the fine mesh");
    figure(pair.coarse.matrices, row.coarse, "computed on the coarse mesh");
    for(int way = 0; way < 2; ++way)
      figure(pair.fine.matrices, pair.bring_back(way, row.coarse).col(0),
             std::string("brought back: ") + ways[way]);
    html += "</div>\n";
  }
  return html;
}

std::string page(const Distance_arguments& a, const Pair& pair, const Summary& s)
{
  using namespace html_internal;
  const std::string name = std::filesystem::path(a.mesh).filename().string();
  std::string html =
      "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>"
      "<meta name='viewport' content='width=device-width'><title>Distances on a proxy: " +
      escaped(name) + "</title>\n<style>" + style() +
      "figure.wide{width:400px}</style></head><body>\n<h1>Spectral distances on a proxy: " +
      escaped(name) + "</h1>\n<p>" + std::to_string(pair.fine.op.mass.size()) +
      " vertices, proxy " + std::to_string(pair.coarse.op.mass.size()) + " vertices, " +
      std::to_string(a.eigenvectors) + " eigenvectors, " + SG::mass_name(pair.mass) +
      " mass, operators: " + escaped(a.operators) + ", " + std::to_string(a.sources) +
      " sources. <code>" + escaped(a.command) + "</code></p>\n";
  html +=
      "<h2>Relative errors on the fine mesh in percent, and times</h2>\n<table>\n" +
      heading_row({"distance", ways[0], ways[1], ways[2], "fine, s", "coarse, s", "speed-up"}, 1);
  for(const Distance_row& row : s.rows)
    html += "<tr>" + cell(escaped(row.name), "td", "l") + cell(percent(row.errors[0])) +
            cell(percent(row.errors[1])) + cell(percent(row.errors[2])) +
            cell(formatted(row.seconds_fine)) + cell(formatted(row.seconds_coarse)) +
            cell(formatted(row.seconds_fine / row.seconds_coarse)) + "</tr>\n";
  html += "<tr>" + cell("eigenpairs", "td", "l") + "<td></td><td></td><td></td>" +
          cell(formatted(pair.fine.seconds)) + cell(formatted(pair.coarse.seconds)) +
          cell(formatted(pair.fine.seconds / pair.coarse.seconds)) + "</tr>\n";
  html += "</table>\n<p class='note'>Simplification: " + formatted(pair.seconds_simplification) +
          " s" +
          (pair.seconds_fit > 0 ? ", fit of the operators: " + formatted(pair.seconds_fit) + " s"
                                : std::string()) +
          ", once for all distances. Errors: sum of M |g − f| over sum of M |f| of the squared "
          "distances "
          "(the wave "
          "kernel's is not squared), mean over the sources.</p>\n<table>\n";
  for(const auto& [signature, error] : s.signatures)
    html += "<tr>" +
            cell(escaped(signature) + ", at the heaviest vertex of each cluster, %", "td", "l") +
            cell(percent(error)) + "</tr>\n";
  return html + "</table>\n<h2>Lines of equal distance from one source</h2>\n" + figures(pair, s) +
         "</body></html>\n";
}

Command_line described(Distance_arguments& a)
{
  Command_line line("spectral_distances_on_proxy MESH --vertices N [options]",
                    "Computes spectral distances on a simplified mesh and says how far they are "
                    "from those of MESH.");
  line.argument(a.mesh);
  line.group("Size");
  line.option("vertices", a.vertices, "N|P%", "of the simplified mesh, such as 600 or 3%");
  line.group("Quality");
  line.option("eigenvectors", a.eigenvectors, "K", "of both meshes; best N >= 3 K");
  line.choice("preset", a.preset, {"best", "paper"}, "how to simplify");
  line.choice("mass", a.mass, words_of(mass_words),
              "the mass matrix (best: averaged, paper: lumped)");
  line.choice("operators", a.operators, {"fitted", "mesh"},
              "of the simplified mesh: fitted to the spectrum of MESH, or its own");
  line.option("sources", a.sources, "S", "random vertices to measure distances from");
  line.group("Input");
  line.flag("repair", a.repair, "change a mesh that cannot be used, as spectral_simplify does");
  line.strict(a.strict);
  line.group("Outputs");
  line.option("report", a.report, "FILE.html", "a page with pictures");
  line.group("Run");
  line.threads(a.threads);
  line.flag("quiet", a.quiet, "no table");
  return line;
}

Distance_arguments parse(int argc, char* argv[])
{
  Distance_arguments a;
  a.command = command_line("spectral_distances_on_proxy", argc, argv);
  a.help = described(a).read(argc, argv);
  if(!a.help.empty())
    return a;
  if(a.mesh.empty() || a.vertices.empty())
    throw std::runtime_error(
        "a mesh and a size are needed: spectral_distances_on_proxy MESH --vertices N.");
  a.target = parsed_vertex_target("--vertices", a.vertices);
  if(a.eigenvectors < 3)
    throw std::runtime_error("--eigenvectors is " + std::to_string(a.eigenvectors) +
                             ", it must be at least 3.");
  if(a.quiet && a.report.empty())
    throw std::runtime_error(
        "nothing is to be said or written: give --report, or leave out --quiet.");
  if(a.sources < 1)
    throw std::runtime_error("--sources is " + std::to_string(a.sources) +
                             ", it must be at least 1.");
  return a;
}

void run(const Distance_arguments& a)
{
  Output_files files({a.mesh});
  if(!a.report.empty())
    files.add(a.report);
  const Pair pair = simplify(a);
  std::mt19937 random(1);
  std::vector<Eigen::Index> sources;
  for(long s = 0; s < a.sources; ++s)
    sources.push_back(
        static_cast<Eigen::Index>(random() % static_cast<unsigned>(pair.fine.op.mass.size())));
  Summary summary;
  for(const Distance& distance : distances(pair.fine.pairs)) {
    stop_if_interrupted();
    summary.rows.push_back(compare(distance, pair, sources));
  }
  summary.signatures = signature_errors(pair);
  if(!a.report.empty()) {
    std::ofstream stream(files.temporary(a.report), std::ios::binary);
    stream << page(a, pair, summary);
    finish_writing(stream, a.report);
    stop_if_interrupted();
    files.commit();
  }
  if(!a.quiet)
    print(pair, summary);
}

} // namespace

int main(int argc, char* argv[])
{
  return run_program("spectral_distances_on_proxy", [&] {
    const Distance_arguments arguments = parse(argc, argv);
    if(!arguments.help.empty())
      std::cout << arguments.help;
    else
      run(arguments);
    return 0;
  });
}
