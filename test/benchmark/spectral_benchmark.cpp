// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// How long the spectral metric takes beside CGAL's own costs, its eigenpairs beside Spectra's, and
// how both grow with the mesh and K; --help shows the options. Each measurement has a process of
// its own; figures are medians.

#include "../../examples/programs/io/machine_memory.h"
#include "in_child.h"
#include "subjects.h"

#include <boost/program_options.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

struct Arguments
{
  std::vector<std::string> meshes;
  std::size_t vertices = 0, pre_simplify = 0;
  double quadrics_above = std::numeric_limits<double>::infinity();
  long eigenvectors = 100;
  int runs = 3;
  int threads = (std::max)(1, static_cast<int>(std::thread::hardware_concurrency()));
  bool no_spectra = false;
  std::string pairs, solver = "block";
  std::string rivals;
  std::string preset = "best";
  std::string json, scaling;
  std::string scaling_vertices = "12000,25000,50000,100000,200000,400000,1000000";
  std::string scaling_eigenvectors = "50,100,200,400";
  std::string scaling_shape = "generated";
  std::string help;
};

Arguments parse_arguments(int argc, char* argv[])
{
  namespace po = boost::program_options;
  Arguments a;
  po::options_description visible(
      "spectral_benchmark MESH... [options]\nspectral_benchmark --scaling CSV [options]\n\n"
      "Measures the spectral simplification of each MESH (a file, generated:N for a shape of about "
      "N "
      "vertices, disc:D or gear:D for fans of D faces) beside "
      "CGAL's Garland-Heckbert (plane) and Lindstrom-Turk costs, and programs of "
      "--rivals.\n\nOptions",
      100, 60);
  auto add = visible.add_options();
  add("help", "show this text");
  add("vertices", po::value(&a.vertices)->value_name("N"),
      "target; 2 % of the mesh or 3 K, if that is more");
  add("eigenvectors", po::value(&a.eigenvectors)->value_name("K")->default_value(a.eigenvectors),
      "how many to keep");
  add("preset", po::value(&a.preset)->value_name("best|paper")->default_value(a.preset),
      "of the options");
  add("pre-simplify", po::value(&a.pre_simplify)->value_name("N0"),
      "reduce to this number first, by quadrics");
  add("quadrics-above", po::value(&a.quadrics_above)->value_name("R"),
      "collapse by quadrics above R times the target; inf by default: it is the metric's collapses "
      "that are "
      "measured");
  add("threads", po::value(&a.threads)->value_name("T"),
      "all processors by default; one is measured as well");
  add("runs", po::value(&a.runs)->value_name("R")->default_value(a.runs),
      "each figure is a median of so many");
  add("no-spectra", po::bool_switch(&a.no_spectra),
      "leave out Spectra's eigenpairs, the slowest part");
  add("pairs", po::value(&a.pairs)->value_name("LIST"),
      "measure nothing but eigenpairs, at each of these tolerances, with one thread and with all");
  add("solver", po::value(&a.solver)->value_name("block|spectra")->default_value(a.solver),
      "of --pairs; Spectra has the threads of its BLAS");
  add("rivals", po::value(&a.rivals)->value_name("FOLDER"),
      "measure the programs FOLDER/NAME/run beside them, as doc/run_rivals.sh explains them");
  add("json", po::value(&a.json)->value_name("FILE"), "write the main figures of each mesh");
  add("scaling", po::value(&a.scaling)->value_name("CSV"),
      "measure generated shapes down to 1 % of their vertices, fans of which 20 vertices are "
      "taken, and "
      "write a table");
  add("scaling-shape",
      po::value(&a.scaling_shape)
          ->value_name("generated|disc|gear")
          ->default_value(a.scaling_shape),
      "which; discs and gears have vertices of many neighbours, and --scaling-vertices is their "
      "number");
  add("scaling-vertices",
      po::value(&a.scaling_vertices)->value_name("LIST")->default_value(a.scaling_vertices),
      "their sizes");
  add("scaling-eigenvectors",
      po::value(&a.scaling_eigenvectors)->value_name("LIST")->default_value(a.scaling_eigenvectors),
      "numbers of eigenvectors");
  po::options_description all;
  all.add(visible).add_options()("mesh", po::value(&a.meshes));
  po::variables_map values;
  po::store(po::command_line_parser(argc, argv)
                .options(all)
                .positional(po::positional_options_description().add("mesh", -1))
                .run(),
            values);
  po::notify(values);
  if(values.count("help")) {
    std::ostringstream text;
    text << visible;
    a.help = text.str();
  } else if(a.meshes.empty() && a.scaling.empty())
    throw std::runtime_error("name a mesh, or --scaling CSV; --help shows everything.");
  if(a.preset != "best" && a.preset != "paper")
    throw std::runtime_error("--preset is '" + a.preset + "', it must be best or paper.");
  if(a.solver != "block" && a.solver != "spectra")
    throw std::runtime_error("--solver is '" + a.solver + "', it must be block or spectra.");
  if(a.scaling_shape != "generated" && a.scaling_shape != "disc" && a.scaling_shape != "gear")
    throw std::runtime_error("--scaling-shape is '" + a.scaling_shape +
                             "', it must be generated, disc or gear.");
  if(!a.rivals.empty() && (a.meshes.empty() || !a.pairs.empty()))
    throw std::runtime_error(
        "--rivals simplify a MESH: they have no part in --pairs or --scaling.");
  if(a.runs < 1 || a.threads < 1 || a.eigenvectors < 1)
    throw std::runtime_error("--runs, --threads and --eigenvectors must be positive.");
  return a;
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? 0 : 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

// The runs of one subject.
struct Samples
{
  std::vector<double> us_per_collapse, us_per_evaluation, evaluations_per_collapse,
      seconds_eigenpairs, seconds_first_costs, seconds_collapse, seconds_total, peak_mb;

  void add(const Spectral_time& t, double peak_bytes)
  {
    const double collapses = double((std::max)(std::size_t(1), t.collapses));
    us_per_collapse.push_back(1e6 * t.seconds_collapse / collapses);
    us_per_evaluation.push_back(1e6 * t.seconds_first_costs / double(t.edges));
    evaluations_per_collapse.push_back(double(t.evaluations) / collapses);
    seconds_eigenpairs.push_back(t.seconds_eigenpairs);
    seconds_first_costs.push_back(t.seconds_first_costs);
    seconds_collapse.push_back(t.seconds_collapse);
    seconds_total.push_back(t.seconds_total);
    peak_mb.push_back(peak_bytes / 1e6);
  }

  void add(const Collapse_time& t, double peak_bytes)
  {
    us_per_collapse.push_back(1e6 * t.seconds / double((std::max)(std::size_t(1), t.collapses)));
    seconds_total.push_back(t.seconds);
    peak_mb.push_back(peak_bytes / 1e6);
  }
};

void run_spectral(const std::string& mesh, const Setting& setting, int threads, Samples& samples)
{
  double peak = 0;
  const Spectral_time t = in_child([&] { return measure_spectral(mesh, setting, threads); }, peak);
  samples.add(t, peak);
}

void run_rival(const std::string& mesh, Rival rival, std::size_t target, Samples& samples)
{
  double peak = 0;
  const Collapse_time t = in_child([&] { return measure_rival(mesh, rival, target); }, peak);
  samples.add(t, peak);
}

// A program outside of CGAL. One that fails is not asked again.
struct Program_samples
{
  std::string name, path;
  Samples samples;
  std::string failure;
};

std::vector<Program_samples> programs(const std::string& folder)
{
  std::vector<Program_samples> result;
  if(folder.empty())
    return result;
  std::error_code missing;
  for(const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
    const std::filesystem::path run = std::filesystem::absolute(entry.path() / "run");
    if(std::filesystem::exists(run))
      result.push_back({entry.path().filename().string(), run.string(), {}, {}});
  }
  if(result.empty())
    throw std::runtime_error("--rivals: there is no NAME/run in '" + folder + "'.");
  std::sort(result.begin(), result.end(),
            [](const Program_samples& a, const Program_samples& b) { return a.name < b.name; });
  return result;
}

void run_program(const std::string& mesh, std::size_t target, Program_samples& program)
{
  if(!program.failure.empty())
    return;
  double peak = 0;
  try {
    const Collapse_time t =
        in_child([&] { return measure_program(program.path, mesh, target); }, peak);
    program.samples.add(t, peak);
  } catch(const std::exception& error) {
    program.failure = error.what();
  }
}

struct Solver_samples
{
  std::string name;
  Solver solver;
  double tolerance;
  int threads;
  std::vector<double> seconds;
  double residual = 0, peak_mb = 0;
};

std::string threads_of(const Solver_samples& s)
{
  return s.solver == Solver::block ? std::to_string(s.threads) : "BLAS's";
}

void run_solver(const std::string& mesh, const Setting& setting, Solver_samples& s)
{
  double peak = 0;
  const Eigenpairs_time t = in_child(
      [&] { return measure_eigenpairs(mesh, setting, s.solver, s.tolerance, s.threads); }, peak);
  s.seconds.push_back(t.seconds);
  s.residual = t.residual; // the same in every run
  s.peak_mb = peak / 1e6;
}

std::vector<Solver_samples> solvers(const Arguments& a)
{
  std::vector<Solver_samples> result = {
      {"block (the default basis)", Solver::block, default_tolerance(), a.threads, {}, 0, 0},
      {"block", Solver::block, 1e-8, 1, {}, 0, 0},
      {"block", Solver::block, 1e-10, 1, {}, 0, 0}};
  if(!a.no_spectra) {
    result.push_back({"Spectra", Solver::spectra, 1e-8, 1, {}, 0, 0});
    result.push_back({"Spectra", Solver::spectra, 1e-10, 1, {}, 0, 0});
  }
  return result;
}

void print_collapses(const char* name, const Samples& s, double garland_heckbert)
{
  const double us = median(s.us_per_collapse);
  std::printf("  %-28s %9.1f %9.2f %10.2f %9.0f\n", name, us, us / garland_heckbert,
              median(s.seconds_total), median(s.peak_mb));
}

nlohmann::json measure(const std::string& mesh, const Arguments& a)
{
  double peak = 0;
  const Mesh_size size = in_child([&] { return measure_mesh(mesh); }, peak);
  Setting setting;
  setting.target = a.vertices != 0 ? a.vertices
                                   : (std::max)(size.vertices / 50,
                                                static_cast<std::size_t>(3 * a.eigenvectors));
  setting.eigenvectors = a.eigenvectors;
  setting.pre_simplify = a.pre_simplify;
  setting.quadrics_above = a.quadrics_above;
  setting.paper = a.preset == "paper";

  Samples one, many, garland_heckbert, lindstrom_turk;
  std::vector<Program_samples> rivals = programs(a.rivals);
  std::vector<Solver_samples> paths = solvers(a);
  for(int run = 0; run < a.runs;
      ++run) { // in turn, so that a disturbance of the machine meets all of them
    run_spectral(mesh, setting, a.threads, many);
    run_rival(mesh, Rival::garland_heckbert, setting.target, garland_heckbert);
    run_rival(mesh, Rival::lindstrom_turk, setting.target, lindstrom_turk);
    if(a.threads > 1)
      run_spectral(mesh, setting, 1, one);
    for(Program_samples& rival : rivals)
      run_program(mesh, setting.target, rival);
    for(Solver_samples& path : paths)
      run_solver(mesh, setting, path);
  }

  const double base = median(garland_heckbert.us_per_collapse);
  const std::string with_threads = "spectral, " + std::to_string(a.threads) + " threads";
  std::printf("%s: %zu -> %zu vertices, K = %ld, %s mass\n", mesh.c_str(), size.vertices,
              setting.target, a.eigenvectors, a.preset == "paper" ? "lumped" : "averaged");
  std::printf("  %-28s %9s %9s %10s %9s\n", "", "us/coll.", "ratio", "total s", "peak MB");
  print_collapses(a.threads > 1 ? with_threads.c_str() : "spectral, 1 thread", many, base);
  if(a.threads > 1)
    print_collapses("spectral, 1 thread", one, base);
  print_collapses("Garland-Heckbert, plane", garland_heckbert, base);
  print_collapses("Lindstrom-Turk", lindstrom_turk, base);
  for(const Program_samples& rival : rivals)
    if(rival.failure.empty())
      print_collapses(rival.name.c_str(), rival.samples, base);
    else
      std::printf("  %-28s failed: %s\n", rival.name.c_str(), rival.failure.c_str());
  if(!rivals.empty())
    std::printf(
        "  Programs outside of CGAL read and write files in their time, unless they leave one of "
        "their own.\n");
  std::printf(
      "  evaluations per collapse %.1f, us per evaluation (first costs) %.2f; seconds: eigenpairs "
      "%.2f, first "
      "costs %.2f, collapses with them %.2f; memory as estimated %.0f MB\n",
      median(many.evaluations_per_collapse), median(many.us_per_evaluation),
      median(many.seconds_eigenpairs), median(many.seconds_first_costs),
      median(many.seconds_collapse), estimated_memory(size.vertices, setting) / 1e6);
  std::printf("  %-28s %9s %9s %10s %9s\n", "eigenpairs", "tolerance", "threads", "seconds",
              "residual");
  for(const Solver_samples& path : paths)
    std::printf("  %-28s %9.0e %9s %10.2f %9.1e\n", path.name.c_str(), path.tolerance,
                threads_of(path).c_str(), median(path.seconds), path.residual);
  std::printf("\n");
  std::fflush(stdout);

  nlohmann::json json = {{"us_per_collapse", median(many.us_per_collapse)},
                         {"us_per_collapse_garland_heckbert", base},
                         {"ratio_garland_heckbert", median(many.us_per_collapse) / base},
                         {"us_per_evaluation", median(many.us_per_evaluation)},
                         {"evaluations_per_collapse", median(many.evaluations_per_collapse)},
                         {"seconds_eigenpairs", median(many.seconds_eigenpairs)},
                         {"seconds_eigenpairs_spectra", nullptr},
                         {"seconds_total", median(many.seconds_total)},
                         {"threads", a.threads},
                         {"eigenvectors", a.eigenvectors},
                         {"peak_rss_mb", median(many.peak_mb)}};
  if(!a.no_spectra)
    json["seconds_eigenpairs_spectra"] = median(paths.back().seconds);
  for(const Program_samples& rival : rivals)
    json["rivals"][rival.name] =
        rival.failure.empty()
            ? nlohmann::json({{"us_per_collapse", median(rival.samples.us_per_collapse)},
                              {"seconds_total", median(rival.samples.seconds_total)},
                              {"peak_rss_mb", median(rival.samples.peak_mb)}})
            : nlohmann::json({{"failed", rival.failure}});
  return json;
}

template <class Number>
std::vector<Number> numbers(const std::string& list)
{
  std::vector<Number> result;
  std::istringstream stream(list);
  for(std::string item; std::getline(stream, item, ',');) {
    Number value = 0;
    std::istringstream number(item);
    if(!(number >> value) || !number.eof() || value <= 0)
      throw std::runtime_error("'" + list + "' is not a list of positive numbers.");
    result.push_back(value);
  }
  return result;
}

// A list of what each setting took.
nlohmann::json measure_pairs(const std::string& mesh, const Arguments& a)
{
  double peak = 0;
  const Mesh_size size = in_child([&] { return measure_mesh(mesh); }, peak);
  Setting setting;
  setting.eigenvectors = a.eigenvectors;
  setting.paper = a.preset == "paper";
  const Solver solver = a.solver == "block" ? Solver::block : Solver::spectra;
  std::vector<Solver_samples> paths;
  for(const double tolerance : numbers<double>(a.pairs)) {
    paths.push_back({a.solver, solver, tolerance, 1, {}, 0, 0});
    if(solver == Solver::block && a.threads > 1)
      paths.push_back({a.solver, solver, tolerance, a.threads, {}, 0, 0});
  }
  for(int run = 0; run < a.runs; ++run)
    for(Solver_samples& path : paths)
      run_solver(mesh, setting, path);
  std::printf("%s: %zu vertices, K = %ld\n  %-28s %9s %9s %10s %9s %9s\n", mesh.c_str(),
              size.vertices, a.eigenvectors, "eigenpairs", "tolerance", "threads", "seconds",
              "residual", "peak MB");
  nlohmann::json json = {{"vertices", size.vertices},
                         {"eigenvectors", a.eigenvectors},
                         {"build", build_description()},
                         {"pairs", nlohmann::json::array()}};
  for(const Solver_samples& path : paths) {
    const double seconds = median(path.seconds);
    std::printf("  %-28s %9.0e %9s %10.2f %9.1e %9.0f\n", path.name.c_str(), path.tolerance,
                threads_of(path).c_str(), seconds, path.residual, path.peak_mb);
    json["pairs"].push_back({{"solver", path.name},
                             {"tolerance", path.tolerance},
                             {"threads", path.threads},
                             {"seconds", seconds},
                             {"residual", path.residual},
                             {"peak_rss_mb", path.peak_mb}});
  }
  std::fflush(stdout);
  return json;
}

void measure_scaling(const Arguments& a)
{
  std::ofstream csv(a.scaling);
  csv << "vertices,target,eigenvectors,threads,us_per_collapse,us_per_collapse_garland_heckbert,"
         "evaluations_per_collapse,seconds_eigenpairs,seconds_collapse,seconds_total,peak_rss_mb\n";
  const bool fans = a.scaling_shape != "generated";
  for(const long size_or_degree : numbers<long>(a.scaling_vertices)) {
    const std::string mesh = a.scaling_shape + ":" + std::to_string(size_or_degree);
    double peak = 0;
    const Mesh_size size = in_child([&] { return measure_mesh(mesh); }, peak);
    Setting setting;
    const std::size_t n = size.vertices;
    setting.target = fans ? (std::max)(n / 2, n - (std::min)(n, std::size_t(20))) : n / 100;
    setting.paper = a.preset == "paper";
    setting.pre_simplify = a.pre_simplify;
    setting.quadrics_above = a.quadrics_above;
    setting.all_in_metric = true; // the series is to show what K costs
    setting.loop_alone = fans;    // and that of fans what their collapses cost
    for(const long K : numbers<long>(a.scaling_eigenvectors)) {
      setting.eigenvectors = K;
      const double needed = estimated_memory(size.vertices, setting),
                   available = available_memory();
      if(available > 0 && needed > available) {
        std::printf("%zu vertices, K = %ld: left out, %s of memory are needed.\n", size.vertices, K,
                    formatted_memory(needed).c_str());
        continue;
      }
      Samples spectral, garland_heckbert;
      for(int run = 0; run < a.runs; ++run) {
        run_spectral(mesh, setting, a.threads, spectral);
        run_rival(mesh, Rival::garland_heckbert, setting.target, garland_heckbert);
      }
      char line[300];
      std::snprintf(line, sizeof(line), "%zu,%zu,%ld,%d,%.2f,%.2f,%.2f,%.3f,%.3f,%.3f,%.0f\n",
                    size.vertices, setting.target, K, a.threads, median(spectral.us_per_collapse),
                    median(garland_heckbert.us_per_collapse),
                    median(spectral.evaluations_per_collapse), median(spectral.seconds_eigenpairs),
                    median(spectral.seconds_collapse), median(spectral.seconds_total),
                    median(spectral.peak_mb));
      csv << line << std::flush;
      std::cout << line << std::flush;
    }
  }
  if(!csv)
    throw std::runtime_error("'" + a.scaling + "' cannot be written.");
}

int main(int argc, char* argv[])
{
  try {
    const Arguments a = parse_arguments(argc, argv);
    std::cout << (a.help.empty() ? build_description() + "\n\n" : a.help) << std::flush;
    if(!a.help.empty())
      return 0;
    nlohmann::json json = nlohmann::json::object();
    for(const std::string& mesh : a.meshes)
      json[std::filesystem::path(mesh).filename().string()] =
          a.pairs.empty() ? measure(mesh, a) : measure_pairs(mesh, a);
    if(!a.json.empty()) {
      std::ofstream stream(a.json);
      stream << json.dump(2) << '\n';
      if(!stream.flush())
        throw std::runtime_error("'" + a.json + "' cannot be written.");
    }
    if(!a.scaling.empty())
      measure_scaling(a);
    return 0;
  } catch(const std::exception& error) {
    std::cerr << "spectral_benchmark: " << error.what() << '\n';
    return 1;
  }
}
