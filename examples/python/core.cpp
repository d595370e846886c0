// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The compiled module of the package: arrays of NumPy in, arrays out. What a user sees, signatures
// and texts of help(), is Python, _interface.py; each function there hands its arguments to one
// here.

#include "arguments.h"
#include "arrays.h"
#include "distances.h"
#include "kept.h"
#include "meshes.h"
#include "spectra.h"
#include "watch.h"

#include "../programs/option_words.h"
#include "../programs/report/run_json.h"
#include "../programs/simplification.h"
#ifdef SPECTRAL_PYTHON_MATCH
#include "match.h"
#endif

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_toolbox/fit_operators_of_run.h>

#include <pybind11/eval.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

// A mesh that was simplified, and what says which vertex became which.
py::dict level_of(const SG::Mesh_matrices& coarse, const Eigen::SparseMatrix<double>& P,
                  const std::vector<std::size_t>& map)
{
  py::dict result;
  result["V"] = py::cast(Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>(coarse.V));
  result["F"] = py::cast(Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>(coarse.T));
  result["P"] = csr(P);
  result["vertex_map"] = array_of(map);
  return result;
}

// One record for each collapse.
py::object records(const SMS::Collapse_log& log)
{
  const auto& merges = log.forest().merges();
  std::vector<Index> removed, kept;
  py::array_t<double> weight(py::ssize_t(merges.size())),
      point({py::ssize_t(merges.size()), py::ssize_t(3)});
  for(std::size_t i = 0; i < merges.size(); ++i) {
    removed.push_back(merges[i].removed);
    kept.push_back(merges[i].kept);
    weight.mutable_at(i) = merges[i].weight;
    for(Index j = 0; j < 3; ++j)
      point.mutable_at(i, j) = log.points()[i][j];
  }
  py::object result = py::module_::import("numpy").attr("empty")(
      merges.size(),
      py::eval("[('removed', 'i8'), ('kept', 'i8'), ('weight', 'f8'), ('point', 'f8', 3)]"));
  result["removed"] = array_of(removed);
  result["kept"] = array_of(kept);
  result["weight"] = weight;
  result["point"] = point;
  return result;
}

// The log of a mesh of n vertices, from its records.
SMS::Collapse_log log_of(const py::object& records, const Index n)
{
  const auto column = [&](const char* name) { return records.attr("__getitem__")(name); };
  const auto removed = py::array_t<std::int64_t>(column("removed")),
             kept = py::array_t<std::int64_t>(column("kept"));
  const auto weight = py::array_t<double>(column("weight")),
             point = py::array_t<double>(column("point"));
  SMS::Collapse_log log(n);
  for(py::ssize_t i = 0; i < removed.size(); ++i)
    log.merge(removed.at(i), kept.at(i), weight.at(i),
              {point.at(i, 0), point.at(i, 1), point.at(i, 2)});
  return log;
}

// The mesh of n vertices on the way, from the records of a run.
py::dict level(const Arguments& a)
{
  const SG::Mesh_matrices fine = a.mesh("V", "F");
  const SMS::Collapse_log log = log_of(a["collapses"], fine.V.rows());
  const std::size_t N = std::size_t(a.integer("n", Index(log.number_of_vertices_left()),
                                              Index(log.number_of_vertices()),
                                              ", the vertices of the levels of this run"));
  struct Replayed
  {
    SG::Mesh_matrices mesh;
    Eigen::SparseMatrix<double> P;
    std::vector<std::size_t> map;
  };
  const Replayed result = interruptible([&] {
    Mesh copy = surface_mesh(fine);
    SMS::Collapse_replay<Mesh> replay(copy, log);
    constexpr std::size_t step = 20000; // collapses between two questions for signals
    while(replay.number_of_vertices() > N + step) {
      replay.collapse_to(replay.number_of_vertices() - step);
      check_signals();
    }
    replay.collapse_to(N);
    return Replayed{SG::mesh_matrices(copy), replay.restriction(), replay.vertex_map()};
  });
  return level_of(result.mesh, result.P, result.map);
}

py::object prolongation(const Arguments& a)
{
  const SG::Mesh_matrices fine = a.mesh("V", "F"), coarse = a.mesh("Vc", "Fc");
  const Eigen::SparseMatrix<double> P = a.sparse("P", coarse.V.rows(), fine.V.rows());
  return csr(interruptible([&] { return SG::closest_point_prolongation(fine, coarse, P); }));
}

py::array rows_off_their_part(const Arguments& a)
{
  const SG::Mesh_matrices fine = a.mesh("V", "F"), coarse = a.mesh("Vc", "Fc");
  const Eigen::SparseMatrix<double> P = a.sparse("P", coarse.V.rows(), fine.V.rows());
  return array_of(interruptible([&] { return SG::rows_off_their_part(coarse, fine, P); }));
}

SMS::Spectral_edge_collapse_options run_options(const Arguments& a, const Index target)
{
  using Signals = SG::Relocation_options::Signals;
  Option_words words;
  words.preset = a.word("preset", {"best", "fast", "paper"});
  words.vertices = std::size_t(target);
  words.placement = a.word("placement", words_of(placement_words), true);
  words.mass = a.word("mass", words_of(mass_words), true);
  if(a.has("shape"))
    words.shape = a.number("shape", 0);
  if(a.has("quadrics_above"))
    words.quadrics_above = a.number("quadrics_above", 1, true, HUGE_VAL, false);
  words.self_intersections = a.word("self_intersections", {"allow", "refuse"}, true);
  words.relocate = a.word("relocate", words_of(relocation_words, {"none"}), true);
  words.prefer = a.word("prefer", {"spectrum", "shape"}, true);
  SMS::Spectral_edge_collapse_options options = options_of(words);
  if(words.prefer == "shape" && !options.relocate)
    refuse("prefer='shape' is a matter of relocation, and nothing is relocated: leave it out, or "
           "pass relocate='sampled'.");
  options.binary = a.flag("binary");
  if(options.binary && options.relocate && options.relocation.signals == Signals::sampled)
    refuse("binary asks for a P of ones and zeros, and relocation by the closest points makes "
           "another one: pass "
           "relocate='none' or relocate='carried'.");
  options.preserve_border = a.flag("preserve_border");
  options.threads = a.threads();
  if(a.has("max_error"))
    options.maximum_error = a.number("max_error", 0, false);
  std::string said;
  if(a.has("quadrics_above") && quadrics_above_is_passed_over(options, said))
    refuse("quadrics_above" + said);
  return options;
}

// What the collapses are to keep: eigenvectors that are to be computed, those that are given, or
// signals.
void set_signals(const Arguments& a, const Index n, const Index target,
                 SMS::Spectral_edge_collapse_options& options)
{
  const bool own = a.has("signals");
  if(own) {
    options.signals = a.matrix("signals", n, "V");
    const Index columns = options.signals.cols();
    if(columns == 0)
      refuse("signals has no columns: give one at least.");
    if(a.has("k") && a.integer("k", 1) != columns)
      refuse("k is " + shown(a["k"]) + ", but signals, which replace the eigenvectors, has " +
             to_string(columns) + (columns == 1 ? " column" : " columns") + ": leave out k.");
  }
  options.number_of_eigenvectors =
      own ? options.signals.cols() : a.integer("k", 1, n - 1, ", one less than V has vertices");
  const Index k = options.number_of_eigenvectors;
  if(a.has("pre_simplify"))
    options.pre_simplify = std::size_t(a.integer("pre_simplify", 0));
  const Index first = Index(options.pre_simplify);
  if(first > 0 && (first < target || first <= k))
    refuse("pre_simplify is " + to_string(first) + ", it must not be below n, which is " +
           to_string(target) + ", and above k, which is " + to_string(k) + ".");
  if(own + a.has("eigenpairs") + (first > 0 && first < n) > 1)
    refuse("of signals, eigenpairs and pre_simplify, which the preset fast sets, only one can be "
           "given.");
  if(!a.has("eigenpairs"))
    return;
  const Pairs& given = given_pairs(a, n, options.mass, k);
  options.eigenpairs = given.pairs->size() == k
                           ? given.pairs
                           : std::make_shared<SG::Eigenpairs>(first_pairs(*given.pairs, k));
}

using Result = SMS::Spectral_edge_collapse_result;

struct Run
{
  Result result;
  SG::Mesh_matrices coarse;
  std::shared_ptr<const SG::Laplace_operator> op;
  std::optional<Fitted_pairs> fitted;
};

// Where no operators can be fitted, the mesh is made all the same: a warning says why.
void fit(Run& run, const SG::Mesh_matrices& fine,
         const SMS::Spectral_edge_collapse_options& options, Watch& watch)
{
  SG::Operator_fit_options how = SG::Operator_fit_options::for_mass(SG::mass_blend(options.mass));
  how.progress = [&](const double fraction) { return watch("operator_fit", fraction); };
  const auto warn = [&run](const std::exception& error) {
    run.result.warnings.push_back("The operators were not fitted: " + std::string(error.what()));
  };
  try {
    run.fitted = fitted_pairs(SMS::fit_operators_of_run(fine, run.coarse, options, run.result, how),
                              how, (std::min)(options.number_of_eigenvectors, run.coarse.V.rows()));
  } catch(const SG::Cancelled&) {
    throw;
  } catch(const std::invalid_argument& error) {
    warn(error);
  } catch(const std::runtime_error& error) {
    warn(error);
  }
}

py::dict simplify(const Arguments& a)
{
  auto fine = std::make_shared<const SG::Mesh_matrices>(a.mesh("V", "F"));
  const Index vertices = fine->V.rows();
  const SG::Mesh_diagnosis diagnosis = checked(*fine, "V, F");
  const Index n = a.integer("n", 1, vertices, ", as many as V has");
  SMS::Spectral_edge_collapse_options options = run_options(a, n);
  set_signals(a, vertices, n, options);
  options.coefficients = a.coefficients(vertices);
  options.boundary = a.boundary();
  if(a.intrinsic_delaunay())
    options.operator_of_eigenpairs = intrinsic_operator(options.mass);
  const bool fits_operators = a.flag("fit_operators");
  if(fits_operators && a.has("signals"))
    refuse("fit_operators fits to eigenvectors, but signals are given: leave one of them out.");
  if(fits_operators && options.boundary == SG::Boundary_condition::dirichlet)
    refuse("fit_operators fits Laplacians whose rows sum to zero, which those of the Dirichlet "
           "condition do not: leave one of them out.");
  if(a.has("keep"))
    options.kept_vertices = a.indices("keep", std::size_t(vertices), "V");
  for(const std::size_t v : feature_vertices(surface_mesh(*fine), kept_features(a)))
    options.kept_vertices.push_back(v);
  std::sort(options.kept_vertices.begin(), options.kept_vertices.end());
  options.kept_vertices.erase(
      std::unique(options.kept_vertices.begin(), options.kept_vertices.end()),
      options.kept_vertices.end());
  Watch watch(a);
  options.progress = [&](const SG::Progress& progress) {
    return watch(word_of(phase_words, progress.phase), progress.fraction);
  };
  Run run = watch.run([&] {
    Run run;
    Mesh mesh = surface_mesh(*fine);
    run.result = simplify_mesh(mesh, std::size_t(n), options);
    run.coarse = SG::mesh_matrices(mesh);
    if(run.result.eigenpairs && run.result.eigenpairs->vectors.rows() == vertices)
      run.op = std::make_shared<SG::Laplace_operator>(operator_of(*fine, options, "V, F"));
    if(fits_operators && run.result.stop_reason != Result::Stop_reason::cancelled)
      fit(run, *fine, options, watch);
    return run;
  });
  for(const std::string& warning : diagnosis.warnings(std::size_t(options.number_of_eigenvectors)))
    run.result.warnings.push_back(warning);
  py::dict result = level_of(run.coarse, run.result.restriction, run.result.vertex_map);
  result["kept"] = array_of(options.kept_vertices);
  result["report"] = py::module_::import("json").attr("loads")(
      run_json(run.result, options, a["preset"].cast<std::string>()).dump());
  result["eigenpairs"] =
      run.op ? py::cast(Pairs{run.result.eigenpairs, run.op, SG::mass_name(options.mass)})
             : py::object(py::none());
  result["coefficients"] = run.result.coefficients.rows() != 0
                               ? py::cast(Eigen::MatrixXd(run.result.coefficients))
                               : py::object(py::none());
  result["fitted"] = run.fitted ? py::cast(std::move(*run.fitted)) : py::object(py::none());
  result["collapses"] = records(run.result.log);
  return result;
}

template <class Function>
void define(py::module_& m, const char* name, const Function& function)
{
  m.def(name, [function](const py::dict& values) { return function(Arguments(values)); });
}

template <class Matrix>
py::cpp_function viewed(const Matrix SG::Eigenpairs::*member)
{
  return py::cpp_function([member](const py::object& self) {
    return view((*self.cast<const Pairs&>().pairs).*member, self);
  });
}

template <class Matrix>
py::cpp_function of_pairs(const Matrix SG::Eigenpairs::*member)
{
  return py::cpp_function([member](const Pairs& self) { return (*self.pairs).*member; });
}

template <class Value>
py::cpp_function of_fit(const Value SG::Operator_fit_result::*member)
{
  return py::cpp_function([member](const Fitted_pairs& self) { return self.fit.*member; });
}

} // namespace

PYBIND11_MODULE(_core, m)
{
  m.attr("__version__") = SPECTRAL_VERSION;
  py::register_exception<SG::Cancelled>(m, "Cancelled", PyExc_RuntimeError).attr("__doc__") =
      "The progress callback returned False. Nothing is returned, nothing was changed.";

  // Wrong types are both, as users may catch either.
  py::register_exception<Wrong_type>(
      m, "Wrong_type", py::make_tuple(py::handle(PyExc_TypeError), py::handle(PyExc_ValueError)));

  // What is handed from call to call without a copy; _results.py has what a user sees of them.
  py::class_<Pairs>(m, "Pairs")
      .def_property_readonly("values", viewed(&SG::Eigenpairs::values))
      .def_property_readonly("vectors", viewed(&SG::Eigenpairs::vectors))
      .def_property_readonly("residuals", viewed(&SG::Eigenpairs::residuals))
      .def_property_readonly("further_values", viewed(&SG::Eigenpairs::further_values))
      .def_property_readonly("L", [](const Pairs& self) { return csr(self.op->L); })
      .def_property_readonly("M", [](const Pairs& self) { return csr(self.op->B); })
      .def_property_readonly("row_masses", [](const Pairs& self) { return self.op->mass; })
      .def_property_readonly("theta", [](const Pairs& self) { return self.op->theta; })
      .def_property_readonly(
          "boundary", [](const Pairs& self) { return word_of(boundary_words, self.op->boundary); })
      .def_property_readonly("vanishing", [](const Pairs& self) { return self.op->vanishing; })
      .def_property_readonly("has_coefficients",
                             [](const Pairs& self) { return self.op->has_coefficients; })
      .def_readonly("mass", &Pairs::mass)
      .def_property_readonly("zeros", of_pairs(&SG::Eigenpairs::zeros))
      .def_property_readonly("complete", of_pairs(&SG::Eigenpairs::complete))
      .def_property_readonly("solver", of_pairs(&SG::Eigenpairs::solver));
  py::class_<Fitted_pairs, Pairs>(m, "Fitted_pairs")
      .def_property_readonly("objective_before", of_fit(&SG::Operator_fit_result::objective_before))
      .def_property_readonly("objective_after", of_fit(&SG::Operator_fit_result::objective_after))
      .def_property_readonly("iterations", of_fit(&SG::Operator_fit_result::iterations))
      .def_property_readonly("converged", of_fit(&SG::Operator_fit_result::converged))
      .def_property_readonly("unknowns", of_fit(&SG::Operator_fit_result::unknowns))
      .def_property_readonly("at_bound", of_fit(&SG::Operator_fit_result::at_bound));

  define(m, "simplify", simplify);
  define(m, "level", level);
  define(m, "prolongation", prolongation);
  define(m, "rows_off_their_part", rows_off_their_part);
  define(m, "pairs_of_arrays", pairs_of_arrays);
  define(m, "eigsh", eigsh);
  define(m, "lift_functional_map", lift_functional_map);
  define(m, "point_map", point_map);
  define(m, "relocate", relocate);
  define(m, "clean", clean);
  define(m, "diagnose", diagnosis_of);
  define(m, "kept", [](const Arguments& a) { return array_of(kept_indices(a)); });
  define(m, "arrays", [](const Arguments& a) {
    return py::make_tuple(a.array<double>("V", 3, "vertex"),
                          a.array<std::int64_t>("F", 3, "triangle"));
  });
  m.def("read_mesh", read_mesh);
  define(m, "eigenpairs", eigenpairs);
  define(m, "evaluate", evaluate);
  define(m, "fit_operators", fit_operators);
  define(m, "curvature_coefficients", curvature_coefficients);
  define(m, "weighted_coefficients", weighted_coefficients);
  define(m, "functional_map", functional_map);
  define(m, "distances", distances);
  define(m, "heat_kernel_signature", heat_kernel_signature);
  define(m, "wave_kernel_signature", wave_kernel_signature);
  define(m, "wave_kernel_energies", wave_kernel_energies);
#ifdef SPECTRAL_PYTHON_MATCH
  define(m, "match", match);
#else
  m.def("match", [](const py::dict&) -> py::object {
    throw std::runtime_error(
        "match() is not in this build, LEMON was not found: install it (on Debian: "
        "apt-get install liblemon-dev) and build again.");
  });
#endif
}
