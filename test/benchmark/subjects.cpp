// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "subjects.h"

#include "../../examples/programs/io/input_mesh.h"
#include "../../examples/programs/io/mesh_io.h"
#include "../spectra_eigenpairs.h"
#include "generated_shape.h"

#include <CGAL/Real_timer.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Spectral_toolbox/Spectral_memory_estimate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace SMS = CGAL::Surface_mesh_simplification;
namespace SG = CGAL::Spectral_geometry;

namespace {

Mesh load(const std::string& name)
{
  const std::size_t colon = name.find(':');
  const std::string kind = name.substr(0, colon);
  if(colon == std::string::npos || (kind != "generated" && kind != "disc" && kind != "gear"))
    return read_input_mesh(name, Mending::none).mesh;
  const std::size_t size = std::stoul(name.substr(colon + 1));
  Mesh mesh;
  shapes::make_mesh(mesh, kind == "disc"   ? shapes::disc_matrices(int(size))
                          : kind == "gear" ? shapes::gear_matrices(int(size), 4)
                                           : generated_shape(size));
  return mesh;
}

SG::Mass mass(const Setting& setting)
{
  return setting.paper ? SG::Mass::lumped : SG::Mass::averaged;
}

SMS::Spectral_edge_collapse_options spectral_options(const Setting& setting, int threads)
{
  SMS::Spectral_edge_collapse_options options = setting.paper
                                                    ? SMS::Spectral_edge_collapse_options::paper()
                                                    : SMS::Spectral_edge_collapse_options::best();
  options.number_of_eigenvectors = setting.eigenvectors;
  options.pre_simplify = setting.pre_simplify;
  options.quadrics_above = setting.quadrics_above;
  options.threads = threads;
  if(setting.all_in_metric)
    options.weights = Eigen::VectorXd::Ones(setting.eigenvectors);
  options.relocate = options.relocate && !setting.loop_alone;
  return options;
}

// A folder that goes with its owner.
struct Scratch_folder
{
  std::filesystem::path path;

  Scratch_folder()
  {
    std::string name =
        (std::filesystem::temp_directory_path() / "spectral_benchmark.XXXXXX").string();
    if(mkdtemp(&name[0]) == nullptr)
      throw std::runtime_error("'" + name + "' cannot be made.");
    path = name;
  }

  ~Scratch_folder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

std::string quoted(const std::string& word)
{
  std::string result = "'";
  for(const char c : word)
    result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

std::string last_line(const std::filesystem::path& file)
{
  std::ifstream stream(file);
  std::string result;
  for(std::string line; std::getline(stream, line);)
    if(!line.empty())
      result = line;
  return result;
}

// The file that holds dgemm_: BLAS is chosen when the program starts, by the alternatives of the
// system.
std::string blas()
{
  void* const function = dlsym(RTLD_DEFAULT, "dgemm_");
  Dl_info info{};
  if(function == nullptr || dladdr(function, &info) == 0)
    return "none";
  std::error_code ignored;
  return std::filesystem::canonical(info.dli_fname, ignored).filename().string();
}

} // namespace

Mesh_size measure_mesh(const std::string& name)
{
  const Mesh mesh = load(name);
  return {mesh.number_of_vertices(), mesh.number_of_edges()};
}

Spectral_time measure_spectral(const std::string& name, const Setting& setting, int threads)
{
  Mesh mesh = load(name);
  const std::size_t edges = mesh.number_of_edges();
  const auto result =
      SMS::spectral_edge_collapse(mesh, setting.target, spectral_options(setting, threads));
  Spectral_time time;
  time.seconds_pre_simplification = result.seconds_pre_simplification;
  time.seconds_eigenpairs = result.seconds_eigenpairs;
  time.seconds_first_costs = result.seconds_first_costs;
  time.seconds_collapse = result.seconds_collapse;
  time.seconds_total = result.seconds_total;
  // A collapse on a closed surface takes three edges away.
  time.edges = edges - 3 * result.quadric_collapses;
  time.evaluations = result.evaluations;
  time.collapses = result.collapses - result.quadric_collapses;
  return time;
}

Collapse_time measure_rival(const std::string& name, Rival rival, std::size_t target)
{
  Mesh mesh = load(name);
  const std::size_t n = mesh.number_of_vertices();
  CGAL::Real_timer timer;
  timer.start();
  const SMS::Vertex_count_stop_predicate<Mesh> stop(target, mesh);
  if(rival == Rival::garland_heckbert) {
    SMS::GarlandHeckbert_plane_policies<Mesh, Kernel> policies(mesh);
    SMS::edge_collapse(
        mesh, stop,
        CGAL::parameters::get_cost(policies.get_cost()).get_placement(policies.get_placement()));
  } else
    SMS::edge_collapse(mesh, stop,
                       CGAL::parameters::get_cost(SMS::LindstromTurk_cost<Mesh>())
                           .get_placement(SMS::LindstromTurk_placement<Mesh>()));
  return {timer.time(), n - mesh.number_of_vertices()};
}

Collapse_time measure_program(const std::string& program, const std::string& name,
                              std::size_t target)
{
  const Scratch_folder scratch;
  const std::string input = (scratch.path / "input.off").string(),
                    prefix = (scratch.path / "out").string(),
                    said = (scratch.path / "said").string();
  const Mesh mesh = load(name);
  write_mesh(input, mesh, input);
  const std::string command = quoted(program) + ' ' + quoted(input) + ' ' + std::to_string(target) +
                              ' ' + quoted(prefix) + " >" + quoted(said) + " 2>&1";
  CGAL::Real_timer timer;
  timer.start();
  const int status = std::system(command.c_str());
  timer.stop();
  const bool has_mesh = std::filesystem::exists(prefix + ".off");
  if(status != 0 || (!has_mesh && !std::filesystem::exists(prefix + ".L.mtx"))) {
    const std::string words = last_line(said);
    throw std::runtime_error(words.empty() ? "left neither a mesh nor a word" : words);
  }
  // Not all of them leave a manifold.
  const std::size_t n = mesh.number_of_vertices(),
                    reached = has_mesh ? read_polygon_soup(prefix + ".off").points.size() : target;
  double seconds = 0;
  const bool has_seconds = bool(std::ifstream(prefix + ".seconds") >> seconds);
  return {has_seconds ? seconds : timer.time(), n - (std::min)(n, reached)};
}

Eigenpairs_time measure_eigenpairs(const std::string& name, const Setting& setting, Solver solver,
                                   double tolerance, int threads)
{
  const SG::Laplace_operator op = SG::cotangent_laplacian(load(name), mass(setting));
  SG::Eigenpairs_options options;
  options.method = SG::Eigenpairs_method::block;
  options.tolerance = tolerance;
  options.threads = threads;
  options.verify = false;
  CGAL::Real_timer timer;
  timer.start();
  const SG::Eigenpairs pairs =
      solver == Solver::block ? SG::eigenpairs(op, setting.eigenvectors, options)
                              : reference::spectra_eigenpairs(op, setting.eigenvectors, tolerance);
  return {timer.time(), pairs.residuals.maxCoeff()};
}

double estimated_memory(std::size_t vertices, const Setting& setting)
{
  return SMS::estimated_memory(vertices, setting.eigenvectors, spectral_options(setting, 1));
}

double default_tolerance()
{
  return SMS::Spectral_edge_collapse_options().eigenpairs_options.tolerance;
}

std::string build_description()
{
  std::string result = "CGAL " CGAL_VERSION_STR;
#ifdef SPECTRAL_TEST_WITH_CHOLMOD
  result += ", Spectra with CHOLMOD on " + blas();
#else
  result += ", Spectra with Eigen's Cholesky factorisation";
#endif
#ifdef __AVX2__
  result += ", for this processor (AVX2)";
#else
  result += ", no -march flag";
#endif
#ifdef NDEBUG
  result += ", optimised";
#else
  result += ", with assertions: these times mean little";
#endif
  return result;
}
