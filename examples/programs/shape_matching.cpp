// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Matches two shapes over their simplifications, section 5.2 of Lescoat et al. 2020; --help shows
// the options.

#include "io/index_reader.h"
#include "io/input_mesh.h"
#include "io/machine_memory.h"
#include "io/matrix_io.h"
#include "io/mesh_io.h"
#include "io/orientation.h"
#include "io/output_files.h"
#include "io/program.h"
#include "matching/geodesic_error.h"
#include "matching/matching_arguments.h"
#include "matching/matching_report.h"
#include "option_words.h"

#include <CGAL/Real_timer.h>
#include <CGAL/Spectral_geometry/Run_control.h>

#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace SG = CGAL::Spectral_geometry;

namespace {

bool keep_going()
{
  return !interrupted;
}

// The files that are read, which no output replaces.
std::vector<std::string> inputs(const Matching_arguments& a)
{
  std::vector<std::string> result{a.X, a.Y, a.landmarks, a.ground_truth};
  for(const Foreign_proxy& foreign : a.foreign())
    result.insert(result.end(), {foreign.X, foreign.Y});
  return result;
}

// Foreign proxies as they were read.
struct Read_proxies
{
  Foreign_proxy of;
  Input_mesh X, Y;
};

// One run of the program.
class Run
{
public:
  explicit Run(const Matching_arguments& arguments)
    : m_arguments(arguments)
    , m_reading(started())
    , m_input_X(read(arguments.X))
    , m_input_Y(read(arguments.Y))
    , m_proxy_size(proxy_size(arguments, m_X.number_of_vertices(), m_Y.number_of_vertices()))
    , m_files(inputs(arguments))
  {
    m_arguments.threads = usable_threads(arguments.threads, arguments.quiet);
    m_stages.push_back({"reading", m_reading.time(), peak_memory()});
    for(const std::string& path : {m_arguments.output, m_arguments.report, m_arguments.json})
      if(!path.empty())
        m_files.add(path);
    Option_words words;
    words.preset = arguments.preset;
    words.mass = arguments.mass;
    m_options = options_of(words);
    read_correspondences();
    for(const Foreign_proxy& foreign : m_arguments.foreign())
      m_foreign.push_back({foreign, read_proxy(foreign.X, m_X), read_proxy(foreign.Y, m_Y)});
    say_changes(m_input_X, m_arguments.X);
    say_changes(m_input_Y, m_arguments.Y);
    for(const Read_proxies& foreign : m_foreign) {
      say_changes(foreign.X, foreign.of.X);
      say_changes(foreign.Y, foreign.of.Y);
    }
  }

  void run()
  {
    if(m_arguments.pre_simplify > 0)
      reduce();
    compute_fine_shapes();
    Matching_comparison c;
    c.command = m_arguments.command;
    c.X = std::filesystem::path(m_arguments.X).filename().string();
    c.Y = std::filesystem::path(m_arguments.Y).filename().string();
    c.mass = SG::mass_name(m_options.mass);
    c.matcher = m_arguments.matcher;
    c.modes = m_arguments.eigenvectors;
    c.landmarks = m_landmarks.size();
    c.shape_X = &m_shape_X;
    c.shape_Y = &m_shape_Y;
    for(const Proxy_kind kind : m_arguments.kinds())
      c.results.push_back(match(kind));
    for(const Read_proxies& foreign : m_foreign)
      c.results.push_back(match(foreign));
    if(!m_truth.empty())
      measure(c.results);
    write(c);
    if(!m_arguments.quiet)
      print_matching(c);
  }

private:
  static CGAL::Real_timer started()
  {
    CGAL::Real_timer timer;
    timer.start();
    return timer;
  }

  void say_changes(const Input_mesh& input, const std::string& path) const
  {
    if(!m_arguments.quiet && !input.changes.empty())
      std::cout << printable(input.changes_of(path)) << "\n" << std::flush;
  }

  // The start of a match tells a shape from its mirror image by the orientation: of closed surfaces
  // it must be that of their volume.
  Input_mesh read(const std::string& path) const
  {
    Input_mesh input = read_input_mesh(path, mending(m_arguments.strict, m_arguments.repair), false,
                                       0, not_interrupted);
    SG::Mesh_matrices matrices = SG::mesh_matrices(input.mesh);
    const std::vector<Eigen::Index> turned = inside_out(matrices.V, matrices.T);
    if(turned.empty())
      return input;
    if(m_arguments.strict)
      throw std::runtime_error(
          "'" + path +
          "' is inside out, its volume is negative, and would be matched to a mirror "
          "image: turn its faces round, or leave out --strict.");
    for(const Eigen::Index t : turned)
      std::swap(matrices.T(t, 1), matrices.T(t, 2));
    input.mesh = mesh_of(matrices);
    input.changes.push_back({"face of an inside-out body turned round",
                             "faces of inside-out bodies turned round", turned.size()});
    return input;
  }

  Input_mesh read_proxy(const std::string& path, const Mesh& fine) const
  {
    Input_mesh input = read(path);
    const std::size_t n = input.mesh.number_of_vertices();
    if(n > fine.number_of_vertices() || static_cast<long>(n) < m_arguments.eigenvectors)
      throw std::runtime_error("'" + path + "' has " + std::to_string(n) +
                               " vertices, a proxy must have at least --eigenvectors, which is " +
                               std::to_string(m_arguments.eigenvectors) +
                               ", and at most as many as its mesh, which has " +
                               std::to_string(fine.number_of_vertices()) + ".");
    return input;
  }

  void read_correspondences()
  {
    const Vertex_numbering &X = m_input_X.numbering, &Y = m_input_Y.numbering;
    const std::size_t n_X = X.number_of_file_vertices(), n_Y = Y.number_of_file_vertices();
    if(!m_arguments.landmarks.empty())
      for(const auto& line : read_vertex_lines(m_arguments.landmarks, {n_X, n_Y}))
        m_landmarks.emplace_back(mesh_vertex(X, line[0]), mesh_vertex(Y, line[1]));
    if(m_arguments.ground_truth.empty())
      return;
    const auto truth = read_vertex_lines(m_arguments.ground_truth, {n_Y}, true);
    if(truth.size() != n_X)
      throw std::runtime_error(
          "'" + m_arguments.ground_truth + "' has " + std::to_string(truth.size()) +
          " lines, it must have one for each of the " + std::to_string(n_X) + " vertices of X.");
    for(std::size_t w = 0; w < X.number_of_mesh_vertices(); ++w) {
      const std::size_t v = truth[X.file_vertex(w)][0];
      const std::size_t there = v == no_vertex ? no_vertex : Y.mesh_vertex(v);
      m_truth.push_back(there == no_vertex ? Eigen::Index(-1) : static_cast<Eigen::Index>(there));
    }
  }

  Eigen::Index mesh_vertex(const Vertex_numbering& numbering, const std::size_t v) const
  {
    return static_cast<Eigen::Index>(
        numbering.vertices_of_mesh({v}, m_arguments.landmarks).front());
  }

  void reduce()
  {
    const CGAL::Real_timer timer = started();
    const std::size_t N0 = static_cast<std::size_t>(m_arguments.pre_simplify);
    const auto reduced = [&](const Mesh& mesh) {
      return mesh.number_of_vertices() <= N0 ? std::optional<Reduced_mesh>()
                                             : reduced_by_quadrics(mesh, N0, keep_going);
    };
    std::tie(m_reduced_X, m_reduced_Y) = side_by_side(
        m_arguments.threads, [&] { return reduced(m_X); }, [&] { return reduced(m_Y); });
    for(auto& [x, y] : m_landmarks) {
      x = m_reduced_X ? m_reduced_X->vertex_map[static_cast<std::size_t>(x)] : x;
      y = m_reduced_Y ? m_reduced_Y->vertex_map[static_cast<std::size_t>(y)] : y;
    }
    m_stages.push_back({"reduction", timer.time(), peak_memory()});
  }

  // The meshes that are matched.
  const Mesh& matched_X() const { return m_reduced_X ? m_reduced_X->mesh : m_X; }
  const Mesh& matched_Y() const { return m_reduced_Y ? m_reduced_Y->mesh : m_Y; }

  void compute_fine_shapes()
  {
    const CGAL::Real_timer timer = started();
    const auto shape = [&](const Mesh& mesh, const Mesh& as_read) {
      Shape result =
          make_shape(SG::mesh_matrices(mesh), m_arguments.eigenvectors, m_options.mass, keep_going);
      if(&mesh != &as_read)
        result.full = SG::mesh_matrices(as_read);
      return result;
    };
    std::tie(m_shape_X, m_shape_Y) = side_by_side(
        m_arguments.threads, [&] { return shape(matched_X(), m_X); },
        [&] { return shape(matched_Y(), m_Y); });
    m_stages.push_back({"eigenpairs", timer.time(), peak_memory()});
  }

  Matching_options matching_options() const
  {
    Matching_options options;
    options.matcher =
        m_arguments.matcher == "bcicp" ? Matcher::bcicp : Matcher::product_manifold_filter;
    options.initial_modes = m_arguments.initial_modes;
    options.modes = m_arguments.eigenvectors;
    options.filter_iterations = static_cast<int>(m_arguments.filter_iterations);
    options.fine_iterations = static_cast<int>(m_arguments.fine_iterations);
    options.local_weight = m_arguments.local_weight;
    options.threads = m_arguments.threads;
    return options;
  }

  Proxy_operators operators() const
  {
    return m_arguments.operators == "fitted" ? Proxy_operators::fitted : Proxy_operators::mesh;
  }

  Matching_result match(const Proxy_kind kind) const
  {
    if(kind == Proxy_kind::none)
      return matched_directly();
    const auto proxy = [&](const Mesh& mesh, const Shape& fine) {
      return make_proxy(mesh, fine, kind, m_proxy_size, m_arguments.eigenvectors, m_options,
                        operators(), keep_going);
    };
    return matched_over(
        proxy_name(kind), [&] { return proxy(matched_X(), m_shape_X); },
        [&] { return proxy(matched_Y(), m_shape_Y); });
  }

  Matching_result match(const Read_proxies& foreign) const
  {
    const auto proxy = [&](const Input_mesh& coarse, const std::string& path, const Shape& fine,
                           const std::string& path_of_fine) {
      try {
        return make_foreign_proxy(coarse.mesh, fine, m_arguments.eigenvectors, m_options.mass,
                                  operators(), keep_going);
      } catch(const SG::Cancelled&) {
        throw;
      } catch(const std::exception& error) {
        throw std::runtime_error("'" + path + "', a proxy of '" + path_of_fine + "', " +
                                 error.what());
      }
    };
    return matched_over(
        foreign.of.name, [&] { return proxy(foreign.X, foreign.of.X, m_shape_X, m_arguments.X); },
        [&] { return proxy(foreign.Y, foreign.of.Y, m_shape_Y, m_arguments.Y); });
  }

  Matching_result matched_directly() const
  {
    Matching_result result;
    result.proxy = proxy_name(Proxy_kind::none);
    result.stages = m_stages;
    result.vertices = matched_X().number_of_vertices();
    result.match =
        match_directly(m_shape_X, m_shape_Y, m_landmarks, matching_options(), keep_going);
    result.stages.push_back({"proxies", 0, peak_memory()});
    add_stages_of_match(result);
    return result;
  }

  template <class Make_X, class Make_Y>
  Matching_result matched_over(const std::string& name, const Make_X& make_X,
                               const Make_Y& make_Y) const
  {
    Matching_result result;
    result.proxy = name;
    result.stages = m_stages;
    const CGAL::Real_timer timer = started();
    const auto [coarse_X, coarse_Y] = side_by_side(m_arguments.threads, make_X, make_Y);
    result.stages.push_back({"proxies", timer.time(), peak_memory()});
    result.vertices = static_cast<std::size_t>(coarse_X.restriction.rows());
    result.match = match_over_proxies(m_shape_X, coarse_X, m_shape_Y, coarse_Y, m_landmarks,
                                      matching_options(), keep_going);
    add_stages_of_match(result);
    return result;
  }

  static void add_stages_of_match(Matching_result& result)
  {
    result.stages.push_back({"matching", result.match.seconds_coarse, result.match.peak_coarse});
    result.stages.push_back({"lift", result.match.seconds_lift, peak_memory()});
  }

  void measure(std::vector<Matching_result>& results) const
  {
    std::vector<const std::vector<Eigen::Index>*> maps;
    for(const Matching_result& r : results)
      maps.push_back(&r.match.map);
    Geodesic_error error(m_Y, m_shape_Y.area, m_truth,
                         static_cast<std::size_t>(m_arguments.samples));
    const auto columns = error.measure(maps, [](double) { stop_if_interrupted(); });
    for(std::size_t i = 0; i < results.size(); ++i)
      results[i].errors = columns[i];
  }

  void write(const Matching_comparison& c)
  {
    if(!m_arguments.output.empty()) {
      std::vector<std::size_t> map;
      for(const Eigen::Index w : c.results.front().match.map)
        map.push_back(m_input_Y.numbering.file_vertex(static_cast<std::size_t>(w)));
      write_indices(m_files.temporary(m_arguments.output),
                    m_input_X.numbering.map_of_file(map, no_vertex), m_arguments.output);
    }
    if(!m_arguments.report.empty()) {
      std::ofstream stream(m_files.temporary(m_arguments.report), std::ios::binary);
      stream << matching_page(c);
      finish_writing(stream, m_arguments.report);
    }
    if(!m_arguments.json.empty()) {
      std::ofstream stream(m_files.temporary(m_arguments.json), std::ios::binary);
      stream << json_text(to_json(c), 1);
      finish_writing(stream, m_arguments.json);
    }
    stop_if_interrupted();
    m_files.commit();
  }

  Matching_arguments m_arguments;
  CGAL::Real_timer m_reading; // before the meshes, which are read when they are initialised
  Input_mesh m_input_X, m_input_Y;
  const Mesh &m_X = m_input_X.mesh, &m_Y = m_input_Y.mesh;
  std::size_t m_proxy_size;
  CGAL::Surface_mesh_simplification::Spectral_edge_collapse_options m_options;
  Output_files m_files;
  Landmarks m_landmarks;
  std::vector<Eigen::Index> m_truth;
  std::vector<Read_proxies> m_foreign;
  std::optional<Reduced_mesh> m_reduced_X, m_reduced_Y;
  Shape m_shape_X, m_shape_Y;
  std::vector<Stage> m_stages; // of all results
};

} // namespace

int main(int argc, char* argv[])
{
  return run_program("shape_matching", [&] {
    const Matching_arguments arguments = parse_matching_arguments(argc, argv);
    if(!arguments.help.empty())
      std::cout << arguments.help;
    else
      Run(arguments).run();
    return 0;
  });
}
