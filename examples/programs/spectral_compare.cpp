// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Compares every simplifier on one mesh, or judges anybody's result; --help shows the options.

#include "compare/coarse_mesh.h"
#include "compare/coloured_mesh.h"
#include "compare/compare_arguments.h"
#include "compare/evaluation.h"
#include "compare/lies_on.h"
#include "compare/shape_measures.h"
#include "io/Progress_bar.h"
#include "io/command_line.h"
#include "io/input_mesh.h"
#include "io/machine_memory.h"
#include "io/matrix_io.h"
#include "io/matrix_market_reader.h"
#include "io/mesh_io.h"
#include "io/output_files.h"
#include "io/program.h"
#include "report/comparison_json.h"
#include "report/comparison_table.h"
#include "report/html_report.h"
#include "report/json_text.h"

#include <CGAL/Real_timer.h>
#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_toolbox/fitted_operators.h>
#include <CGAL/Spectral_toolbox/spectral_distances.h>
#include <CGAL/version_macros.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <functional>
#include <fstream>
#include <iostream>
#include <new>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace SG = CGAL::Spectral_geometry;

namespace {

// The files that are read, which no output replaces.
std::vector<std::string> inputs(const Compare_arguments& a)
{
  std::vector<std::string> result{a.mesh};
  for(const Rival& r : a.rivals)
    result.insert(result.end(), {r.mesh, r.operator_file, r.mass_file, r.restriction});
  return result;
}

// A result of another program as it was read: a mesh, or a candidate.
struct Read_rival
{
  const Rival* rival; // what it was read from
  Coarse_mesh coarse;
  Coarse_candidate candidate;
  Simplified row;
};

// One run of the program: the fine mesh, the references in each mass, and what was found.
class Run
{
public:
  explicit Run(const Compare_arguments& arguments, const std::string& command)
    : m_arguments(arguments)
    , m_files(inputs(arguments))
    , m_bar(!arguments.quiet)
    , m_input(read(arguments.mesh))
    , m_fine(m_input.mesh)
  {
    m_comparison.command = command;
    m_arguments.threads = usable_threads(arguments.threads, arguments.quiet);
    for(const std::string& path : {m_arguments.report, m_arguments.json})
      if(!path.empty())
        m_files.add(path);
    if(!m_arguments.coloured.empty())
      m_files.add_folder(m_arguments.coloured);
  }

  // Returns the exit status: 1 where rivals were refused, and all others stand in the results.
  int run()
  {
    const std::vector<std::size_t> sizes =
        target_sizes(m_arguments, m_fine.number_of_vertices(), m_input.size_of(m_arguments.mesh));
    std::vector<Read_rival> rivals; // what is wrong with their files is known before the work
    for(const Rival& rival : m_arguments.rivals)
      try_rival(rival, [&] { rivals.push_back(read_rival(rival, sizes)); });
    refuse_doubles(rivals);
    refuse_alone(sizes, rivals.size());
    make_references();
    std::vector<Simplified> judged;
    for(Read_rival& rival : rivals)
      if(try_rival(*rival.rival, [&] { judge_rival(rival); }))
        judged.push_back(std::move(rival.row));
    refuse_alone(sizes, judged.size());
    if(!sizes.empty())
      compare(sizes);
    for(Simplified& row : judged)
      m_comparison.results.push_back(std::move(row));
    m_bar.clear();
    write();
    if(m_complaints.empty())
      return 0;
    complain(complaint());
    return 1;
  }

private:
  Input_mesh read(const std::string& path)
  {
    Input_mesh input = read_input_mesh(path, mending(m_arguments.strict, m_arguments.repair), false,
                                       0, not_interrupted);
    if(!input.changes.empty())
      m_comparison.notes.push_back(input.changes_of(path));
    return input;
  }

  std::function<bool(double)> progress(const std::string& phase)
  {
    return [this, phase](double fraction) {
      m_bar.show(phase, fraction);
      return !interrupted;
    };
  }

  void describe()
  {
    Comparison& c = m_comparison;
    c.program = "spectral_compare";
    c.mesh = std::filesystem::path(m_arguments.mesh).filename().string();
    c.vertices = m_fine.number_of_vertices();
    c.faces = m_fine.number_of_faces();
    c.diagonal = box_diagonal(m_fine);
    c.closed = CGAL::is_closed(m_fine);
    c.components = number_of_components(m_fine);
    c.K = m_arguments.eigenvectors;
    c.sources = static_cast<std::size_t>(m_arguments.sources);
    c.seed = static_cast<unsigned>(m_arguments.seed);
    c.threads = m_arguments.threads;
    c.cgal_version = CGAL_VERSION_STR;
#if defined(__clang__)
    c.compiler = "Clang " __clang_version__;
#elif defined(__GNUC__)
    c.compiler = "GCC " __VERSION__;
#endif
  }

  void make_references()
  {
    describe();
    const Eigen::Index n = static_cast<Eigen::Index>(m_fine.number_of_vertices()),
                       K = m_arguments.eigenvectors;
    if(K >= n)
      throw std::runtime_error("--eigenvectors is " + std::to_string(K) + ", it must be below " +
                               std::to_string(n) + ": that is how many vertices '" +
                               m_arguments.mesh + "' has.");
    check_sources(m_arguments.sources, m_fine.number_of_vertices());
    m_matrices = SG::mesh_matrices(m_fine);
    std::vector<Eigen::Index> sources;
    std::mt19937 random(
        static_cast<unsigned>(m_arguments.seed)); // its modulo is the same everywhere
    for(long s = 0; s < m_arguments.sources; ++s)
      sources.push_back(static_cast<Eigen::Index>(random() % static_cast<unsigned>(n)));
    for(const SG::Mass mass : {SG::Mass::lumped, SG::Mass::averaged, SG::Mass::consistent}) {
      if(m_arguments.masses.find(SG::mass_name(mass)) == std::string::npos)
        continue;
      CGAL::Real_timer timer;
      timer.start();
      Fine_reference r = fine_reference(m_matrices, mass, K, sources, progress("reference"));
      SG::Eigenpairs first; // by which distances are judged
      first.values = r.pairs.values.head(K);
      first.zeros = r.pairs.zeros;
      try {
        SG::wave_kernel_energies(first);
      } catch(const std::invalid_argument&) {
        throw std::runtime_error("the first eigenvalues of '" + m_arguments.mesh +
                                 "' are 0 or equal, so that distances cannot be judged by " +
                                 std::to_string(K) + ": ask for more with --eigenvectors.");
      }
      m_comparison.area = r.op.mass.sum();
      m_comparison.fine.push_back({r.mass, m_comparison.area * r.pairs.values, r.pairs.zeros,
                                   timer.time(), r.pairs.residuals.maxCoeff()});
      m_references.push_back(std::move(r));
      m_masses.push_back(mass);
    }
  }

  void compare(const std::vector<std::size_t>& sizes)
  {
    std::vector<Basis> bases;
    for(const SG::Mass mass : m_masses) {
      m_bar.show("basis", 0.);
      stop_if_interrupted();
      bases.push_back(spectral_basis(m_fine, m_arguments.eigenvectors, mass));
      bases.back().seed = static_cast<std::uint64_t>(m_arguments.seed);
    }
    std::vector<Simplifier> simplifiers = collapse_simplifiers(m_fine, bases, m_arguments.threads);
    for(Simplifier& s : remeshers(m_fine, m_comparison.notes))
      simplifiers.push_back(std::move(s));
    for(const Rival& rival : m_arguments.rivals)
      for(const Simplifier& s : simplifiers)
        if(rival.name == s.name || rival.name == fitted_name(s))
          throw std::runtime_error(rival.option + " has the name of a simplifier: choose another.");
    for(const std::string& text : m_arguments.only)
      if(std::none_of(simplifiers.begin(), simplifiers.end(), [&](const Simplifier& s) {
           return is_wanted(s.name, {text}) || is_wanted(fitted_name(s), {text});
         }))
        throw std::runtime_error(no_simplifier(text));
    std::size_t done = 0;
    for(const std::size_t N : sizes)
      for(const Simplifier& s : simplifiers) {
        m_bar.show("comparison", static_cast<double>(done++) /
                                     static_cast<double>(sizes.size() * simplifiers.size()));
        stop_if_interrupted();
        if(is_wanted(s.name, m_arguments.only) || is_wanted(fitted_name(s), m_arguments.only))
          try_simplifier(s, N);
      }
    if(!m_arguments.without.empty())
      m_comparison.notes.push_back("Left out by --without: simplifiers with '" +
                                   m_arguments.without + "' in their names.");
    if(m_comparison.results.empty())
      throw std::runtime_error(m_failure.empty() ? no_simplifier(joined(m_arguments.only, "' or '"))
                                                 : m_failure);
  }

  // A name with any of the texts, or any name if there is none, that --without does not leave out.
  bool is_wanted(const std::string& name, const std::vector<std::string>& texts) const
  {
    const auto in_name = [&](const std::string& text) {
      return name.find(text) != std::string::npos;
    };
    return (texts.empty() || std::any_of(texts.begin(), texts.end(), in_name)) &&
           (m_arguments.without.empty() || !in_name(m_arguments.without));
  }

  std::string no_simplifier(const std::string& text) const
  {
    return "no simplifier has '" + text + "' in its name" +
           (m_arguments.without.empty() ? "" : ", lacks '" + m_arguments.without + "'") +
           " and can simplify this mesh.";
  }

  // Names the row that follows with fitted operators, or the simplifier's if there is none.
  static std::string fitted_name(const Simplifier& s)
  {
    return s.fits_operators ? s.name + ", fitted operators" : s.name;
  }

  // A simplifier or a fit that fails does not end the comparison.
  void try_simplifier(const Simplifier& s, std::size_t N)
  {
    Simplified row;
    row.simplifier = s.name;
    row.placement = s.placement;
    row.metric_mass = s.metric_mass;
    row.relocation = s.relocation;
    row.shape_term = s.shape;
    row.requested_vertices = N;
    row.seconds_eigenpairs = s.seconds_eigenpairs;
    try {
      const Coarse_mesh coarse = s.run(m_fine, N);
      row.seconds = coarse.seconds;
      row.note = coarse.note;
      if(is_wanted(s.name, m_arguments.only)) {
        Simplified own = row;
        judge_mesh(coarse, own);
        m_comparison.results.push_back(std::move(own));
      }
      if(s.fits_operators && is_wanted(fitted_name(s), m_arguments.only)) {
        row.simplifier = fitted_name(s);
        judge_fitted(coarse, row);
        m_comparison.results.push_back(row);
      }
    } catch(const SG::Cancelled&) {
      throw;
    } catch(const std::bad_alloc&) {
      throw;
    } catch(const Write_error&) {
      throw;
    } catch(const std::exception& error) {
      const std::string what = row.name() + ", N = " + std::to_string(N) + ", is missing: ";
      m_comparison.notes.push_back(what + error.what());
      if(m_failure.empty())
        m_failure = m_comparison.notes.back();
    }
  }

  // What is judged of a mesh; the row gets what no mass is in.
  Coarse_candidate candidate_of(const Coarse_mesh& coarse, const SG::Mesh_matrices& matrices,
                                Simplified& row)
  {
    row.vertices = coarse.mesh.number_of_vertices();
    row.faces = coarse.mesh.number_of_faces();
    row.shape = shape_measures(m_fine, coarse.mesh);
    Coarse_candidate candidate;
    candidate.carried = coarse.carried;
    candidate.closest = SG::closest_point_restriction(matrices, m_matrices);
    candidate.prolongation =
        SG::closest_point_prolongation(m_matrices, matrices, candidate.restriction());
    const std::size_t off =
        SG::rows_off_their_part(matrices, m_matrices, candidate.restriction()).size();
    row.shape.rows_off_their_part = double(off);
    if(off != 0)
      m_comparison.notes.push_back(
          row.name() + ", N = " + std::to_string(row.vertices) + ": " + std::to_string(off) +
          " rows of P read functions off another part of the shape than their "
          "neighbours.");
    return candidate;
  }

  void judge_mesh(const Coarse_mesh& coarse, Simplified& row)
  {
    const SG::Mesh_matrices matrices = SG::mesh_matrices(coarse.mesh);
    Coarse_candidate candidate = candidate_of(coarse, matrices, row);
    for(const Fine_reference& reference : m_references) {
      candidate.op = SG::laplace_operator(matrices.V, matrices.T, reference.op.theta);
      Judged judged = judge(reference, candidate, [](double) { return !interrupted; });
      if(!m_arguments.coloured.empty() && &reference == &m_references.front())
        write_coloured(coarse.mesh, candidate, judged, row);
      row.judgements.push_back(std::move(judged.judgement));
    }
    note_missing_modes(row);
  }

  // Once for all.
  void note_missing_modes(const Simplified& row)
  {
    if(!m_has_all_modes || row.judgements.front().C.rows() >= m_arguments.eigenvectors)
      return;
    m_has_all_modes = false;
    m_comparison.notes.push_back(
        "Eigenvalues and distances of coarse meshes that have fewer than " +
        std::to_string(m_arguments.eigenvectors) + " modes are judged by those that they have.");
  }

  // Judges the mesh with fitted operators. Its seconds are those of the mesh and of the fits in all
  // masses.
  void judge_fitted(const Coarse_mesh& coarse, Simplified& row)
  {
    const SG::Mesh_matrices matrices = SG::mesh_matrices(coarse.mesh);
    Coarse_candidate candidate = candidate_of(coarse, matrices, row);
    for(const Fine_reference& reference : m_references) {
      SG::Operator_fit_options options = SG::Operator_fit_options::for_mass(reference.op.theta);
      options.progress = [](double) { return !interrupted; };
      const Eigen::Index fitted = (std::min)(reference.K + reference.K / 5, reference.pairs.size());
      SG::Eigenpairs pairs; // a fifth more than are judged, for the sake of the modes beyond
      pairs.values = reference.pairs.values.head(fitted);
      pairs.vectors = reference.pairs.vectors.leftCols(fitted);
      CGAL::Real_timer timer;
      timer.start();
      candidate.op =
          SG::fit_operators(SG::laplace_operator(matrices.V, matrices.T, reference.op.theta),
                            candidate.restriction(), reference.op, pairs, options)
              .op;
      row.seconds += timer.time();
      row.judgements.push_back(
          judge(reference, candidate, [](double) { return !interrupted; }).judgement);
    }
    note_missing_modes(row);
  }

  // Whether `function` had nothing to object to a rival: one that is refused does not end the
  // comparison of the others.
  template <class Function>
  bool try_rival(const Rival& rival, const Function& function)
  {
    try {
      function();
      return true;
    } catch(const SG::Cancelled&) {
      throw;
    } catch(const Write_error&) {
      throw;
    } catch(const std::bad_alloc&) {
      throw;
    } catch(const std::exception& error) {
      m_comparison.refused.push_back({rival.name, error.what()});
      m_complaints.push_back(rival.option + ": " + error.what());
      return false;
    }
  }

  // One sentence for all rivals that were refused.
  std::string complaint() const
  {
    return m_complaints.size() == 1
               ? m_complaints.front()
               : std::to_string(m_complaints.size()) + " of " +
                     std::to_string(m_arguments.rivals.size()) +
                     " rivals were refused, the first: " + m_complaints.front();
  }

  // Where nothing is to be judged but rivals, and none is left.
  void refuse_alone(const std::vector<std::size_t>& sizes, const std::size_t rivals) const
  {
    if(sizes.empty() && rivals == 0)
      throw std::runtime_error(complaint());
  }

  static void refuse_doubles(const std::vector<Read_rival>& rivals)
  {
    for(auto a = rivals.begin(); a != rivals.end(); ++a)
      for(auto b = rivals.begin(); b != a; ++b)
        if(a->row.simplifier == b->row.simplifier &&
           a->row.requested_vertices == b->row.requested_vertices)
          throw std::runtime_error(a->rival->option +
                                   ": another result of this name stands at N = " +
                                   std::to_string(a->row.requested_vertices) + " already.");
  }

  Read_rival read_rival(const Rival& rival, const std::vector<std::size_t>& sizes)
  {
    Read_rival result;
    result.rival = &rival;
    result.row.simplifier = rival.name;
    if(!rival.mesh.empty()) {
      Input_mesh input = read(rival.mesh);
      result.coarse.mesh = std::move(input.mesh);
      result.row.vertices = result.coarse.mesh.number_of_vertices();
      if(!rival.restriction.empty()) {
        result.coarse.carried = input.numbering.rows_of_mesh(
            given_restriction(rival.restriction, input.numbering.number_of_file_vertices()));
        SG::internal::check_rows_of_restriction((rival.restriction + ": ").c_str(),
                                                *result.coarse.carried);
      }
    } else {
      result.candidate.op = given_operator(rival);
      result.row.vertices = static_cast<std::size_t>(result.candidate.op.L.rows());
      result.candidate.carried = given_restriction(rival.restriction, result.row.vertices);
    }
    const auto distance = [&](std::size_t N) {
      return std::abs(std::log(static_cast<double>(N) / static_cast<double>(result.row.vertices)));
    };
    const auto nearest =
        std::min_element(sizes.begin(), sizes.end(),
                         [&](std::size_t M, std::size_t N) { return distance(M) < distance(N); });
    result.row.requested_vertices = nearest == sizes.end() ? result.row.vertices : *nearest;
    return result;
  }

  // For `rows` coarse vertices and those of the file of the fine mesh.
  Eigen::SparseMatrix<double> given_restriction(const std::string& path, std::size_t rows) const
  {
    const std::size_t n = m_input.numbering.number_of_file_vertices();
    const Eigen::SparseMatrix<double> P =
        read_matrix_market(path, [&](long long given_rows, long long columns, long long nonzeros) {
          return nonzeros == 0 ? std::string("holds nothing but zeros.")
                 : given_rows == static_cast<long long>(rows) &&
                         columns == static_cast<long long>(n)
                     ? std::string()
                     : "is " + std::to_string(given_rows) + " x " + std::to_string(columns) +
                           " where " + std::to_string(rows) + " x " + std::to_string(n) +
                           " is needed, coarse x fine.";
        });
    return m_input.numbering.columns_of_mesh(P);
  }

  void judge_rival(Read_rival& rival)
  {
    if(rival.candidate.op.L.rows() == 0) {
      const std::string reason = not_on(SG::mesh_matrices(rival.coarse.mesh), m_matrices);
      if(!reason.empty())
        throw std::runtime_error("'" + rival.rival->mesh + "', a simplification of '" +
                                 m_arguments.mesh + "', " + reason + ".");
      judge_mesh(rival.coarse, rival.row);
    } else
      judge_operator(rival.candidate, rival.row);
  }

  void judge_operator(Coarse_candidate& candidate, Simplified& row)
  {
    // Symmetric matrices, as in appendix D of the paper: half of L and M with its indices.
    const double n = static_cast<double>(row.vertices);
    row.shape.bytes_per_vertex =
        12 * (static_cast<double>(candidate.op.L.nonZeros()) + n) / 2 / n +
        (candidate.op.B.nonZeros() == candidate.op.B.rows()
             ? 8.
             : 12 * (static_cast<double>(candidate.op.B.nonZeros()) + n) / 2 / n);
    for(const Fine_reference& reference : m_references) {
      candidate.op.theta = reference.op.theta;
      row.judgements.push_back(
          judge(reference, candidate, [](double) { return !interrupted; }).judgement);
    }
    note_missing_modes(row);
    m_comparison.notes.push_back(
        "The coarse operator '" + row.simplifier +
        "' has the mass matrix that it came with, whichever mass it is judged "
        "in; the fine mesh has that of the heading.");
  }

  static SG::Laplace_operator given_operator(const Rival& rival)
  {
    SG::Laplace_operator op;
    const auto square = [](long long rows, long long columns, long long nonzeros) -> std::string {
      if(rows != columns)
        return "is not square.";
      return nonzeros < rows ? "has rows without a nonzero." : "";
    };
    op.L = read_matrix_market(rival.operator_file, square);
    op.B = read_matrix_market(rival.mass_file, square);
    const auto refuse = [](const std::string& path, const std::string& why) {
      throw std::runtime_error("'" + path + "' " + why);
    };
    if(op.B.rows() != op.L.rows())
      refuse(rival.mass_file,
             "is " + std::to_string(op.B.rows()) + " x " + std::to_string(op.B.rows()) +
                 ", it must have the size of the operator, " + std::to_string(op.L.rows()) + ".");
    for(const auto* matrix : {&op.L, &op.B}) {
      const Eigen::SparseMatrix<double> skew =
          *matrix - Eigen::SparseMatrix<double>(matrix->transpose());
      if(skew.norm() > 1e-9 * matrix->norm())
        refuse(matrix == &op.L ? rival.operator_file : rival.mass_file,
               "is not symmetric: " + first_entry(skew, 1e-9 * matrix->norm() / skew.cols()) +
                   " differs from its mirror image.");
    }
    if(op.L.diagonal().sum() < 0)
      refuse(rival.operator_file,
             "is negative: pass the positive semidefinite Laplacian, that times -1.");
    op.mass = op.B * Eigen::VectorXd::Ones(op.B.cols());
    Eigen::Index least = 0;
    if(!(op.mass.minCoeff(&least) > 0))
      refuse(rival.mass_file,
             "has a row whose sum is not positive, number " + std::to_string(least + 1) + ".");
    return op;
  }

  // "the entry 3, 7", counted from 1 as in the file, of the first that is larger.
  static std::string first_entry(const Eigen::SparseMatrix<double>& A, double limit)
  {
    for(Eigen::Index j = 0; j < A.cols(); ++j)
      for(Eigen::SparseMatrix<double>::InnerIterator it(A, j); it; ++it)
        if(std::abs(it.value()) > limit)
          return "the entry " + std::to_string(it.row() + 1) + ", " + std::to_string(it.col() + 1);
    return "an entry";
  }

  // Fine and coarse share times and scales, and the coarse modes are aligned with the fine ones.
  void write_coloured(const Mesh& mesh, const Coarse_candidate& candidate, const Judged& judged,
                      const Simplified& row)
  {
    const Fine_reference& reference = m_references.front();
    const auto [fine, coarse] =
        paired_sources({reference.sources.front()}, candidate.restriction());
    SG::Eigenpairs fine_pairs;
    fine_pairs.values = reference.pairs.values.head(reference.K);
    fine_pairs.vectors = reference.pairs.vectors.leftCols(reference.K);
    fine_pairs.zeros = reference.pairs.zeros;
    if(!m_colours_known) {
      m_colours_known = true;
      m_colours.hks_time = SG::heat_kernel_times(fine_pairs, 3)(1);
      m_colours.largest_distance = std::sqrt(
          SG::squared_biharmonic_distance(fine_pairs, reference.sources.front()).maxCoeff());
      write_one_coloured("fine", m_fine,
                         vertex_functions(fine_pairs, reference.sources.front(), m_colours));
    }
    write_one_coloured(row.name() + " " + std::to_string(row.requested_vertices), mesh,
                       vertex_functions(judged.aligned, coarse.front(), m_colours));
  }

  void write_one_coloured(const std::string& name, const Mesh& mesh,
                          const Vertex_functions& functions)
  {
    std::string file;
    for(const char c : name)
      if(std::isalnum(static_cast<unsigned char>(c)))
        file += c;
      else if(!file.empty() && file.back() != '_')
        file += '_';
    const std::string path = m_arguments.coloured + "/" + file + ".ply";
    m_files.add(path);
    write_coloured_ply(m_files.temporary(path), mesh, functions, path);
  }

  void write_text(const std::string& path, const std::string& text)
  {
    if(path.empty())
      return;
    std::ofstream stream(m_files.temporary(path), std::ios::binary);
    stream << text;
    finish_writing(stream, path);
  }

  void write()
  {
    if(!m_arguments.json.empty())
      write_text(m_arguments.json, json_text(to_json(m_comparison), 1));
    if(!m_arguments.report.empty())
      write_text(m_arguments.report, html_report(m_comparison));
    stop_if_interrupted();
    m_files.commit();
    if(!m_arguments.quiet)
      print_comparison(m_comparison);
  }

  Compare_arguments m_arguments;
  Output_files m_files;
  Progress_bar m_bar;
  Comparison m_comparison;
  bool m_has_all_modes = true; // every result so far
  std::string m_failure;       // of the first simplifier that failed
  // About the rivals that were refused, with the options that named them.
  std::vector<std::string> m_complaints;
  Input_mesh m_input;
  const Mesh& m_fine;
  SG::Mesh_matrices m_matrices;
  std::vector<SG::Mass> m_masses;
  std::vector<Fine_reference> m_references;
  Colour_scale m_colours;
  bool m_colours_known = false;
};

} // namespace

int main(int argc, char* argv[])
{
  return run_program("spectral_compare", [&] {
    const Compare_arguments arguments = parse_compare_arguments(argc, argv);
    if(arguments.help.empty())
      return Run(arguments, command_line("spectral_compare", argc, argv)).run();
    std::cout << arguments.help;
    return 0;
  });
}
