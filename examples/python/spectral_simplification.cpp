// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The module spectral_simplification: arrays of NumPy in, arrays out. What a user sees, signatures and texts of help(), is Python,
// interface.py; each function there hands its arguments to one here.

#include "arguments.h"
#include "arrays.h"
#include "distances.h"
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

#include <pybind11/eval.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace {

// A simplified mesh.
struct Level
{
  std::shared_ptr<const SG::Mesh_matrices> fine;
  SG::Mesh_matrices coarse;
  py::array V, F, vertex_map;
  py::object P, Q; // Q when somebody asks for it

  Level(std::shared_ptr<const SG::Mesh_matrices> fine_mesh, SG::Mesh_matrices mesh,
        const Eigen::SparseMatrix<double>& restriction, const std::vector<std::size_t>& map)
    : fine(std::move(fine_mesh))
    , coarse(std::move(mesh))
    , V(py::cast(Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>(coarse.V)))
    , F(py::cast(Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>(coarse.T)))
    , vertex_map(array_of(map))
    , P(csr(restriction))
  {}

  py::object prolongation()
  {
    if(!Q) {
      Eigen::SparseMatrix<double> matrix;
      {
        const py::gil_scoped_release no_gil;
        matrix = SG::closest_point_interpolation(fine->V, coarse);
      }
      Q = csr(matrix);
    }
    return Q;
  }
};

struct Simplification : Level
{
  using Level::Level;

  SMS::Collapse_log log;
  py::object eigenpairs, fitted, coefficients;
  py::dict report;

  // One record for each collapse.
  py::array collapses() const
  {
    const auto& merges = log.forest().merges();
    std::vector<Index> removed, kept;
    py::array_t<double> alpha(py::ssize_t(merges.size())),
        point({py::ssize_t(merges.size()), py::ssize_t(3)});
    for(std::size_t i = 0; i < merges.size(); ++i) {
      removed.push_back(merges[i].removed);
      kept.push_back(merges[i].kept);
      alpha.mutable_at(i) = merges[i].alpha;
      for(Index j = 0; j < 3; ++j)
        point.mutable_at(i, j) = log.points()[i][j];
    }
    const py::module_ numpy = py::module_::import("numpy");
    py::object result = numpy.attr("empty")(
        merges.size(), py::eval("[('removed', 'i8'), ('kept', 'i8'), ('alpha', 'f8'), ('point', 'f8', 3)]"));
    result["removed"] = array_of(removed);
    result["kept"] = array_of(kept);
    result["alpha"] = alpha;
    result["point"] = point;
    return result;
  }

  Level level(const py::object& n) const
  {
    py::dict values;
    values["n"] = n;
    const std::size_t N = std::size_t(Arguments(values).integer("n", Index(log.number_of_vertices_left()),
                                                                Index(log.number_of_vertices()),
                                                                ", the vertices of the levels of this run"));
    SG::Mesh_matrices mesh;
    Eigen::SparseMatrix<double> restriction;
    std::vector<std::size_t> map;
    {
      const py::gil_scoped_release no_gil;
      Mesh copy = surface_mesh(*fine);
      SMS::Collapse_replay<Mesh> replay(copy, log);
      replay.collapse_to(N);
      mesh = SG::mesh_matrices(copy);
      restriction = replay.restriction();
      map = replay.vertex_map();
    }
    return Level(fine, std::move(mesh), restriction, map);
  }
};

SMS::Spectral_edge_collapse_options run_options(const Arguments& a, const Index target)
{
  using Signals = SG::Relocation_options::Signals;
  Option_words words;
  words.preset = a.word("preset", {"best", "fast", "paper"});
  words.vertices = std::size_t(target);
  words.placement = a.word("placement", words_of(placement_words), true);
  words.mass = a.word("mass", {"lumped", "averaged", "voronoi"}, true);
  if(a.has("shape"))
    words.shape = a.number("shape", 0);
  if(a.has("quadrics_above"))
    words.quadrics_above = a.number("quadrics_above", 1, true, HUGE_VAL, false);
  words.self_intersections = a.word("self_intersections", {"allow", "refuse"}, true);
  words.relocate = a.word("relocate", words_of(relocation_words, {"none"}), true);
  words.flips = a.word("flips", words_of(flip_words));
  SMS::Spectral_edge_collapse_options options = options_of(words);
  options.binary = a.flag("binary");
  if(options.binary && options.relocate && options.relocation.signals == Signals::sampled)
    refuse(
        "binary asks for a P of ones and zeros, and relocation by the closest points makes another one: pass "
        "relocate='none' or relocate='carried'.");
  options.preserve_border = a.flag("preserve_border");
  options.fit_operators = a.flag("fit_operators");
  if(options.fit_operators && a.has("signals"))
    refuse("fit_operators fits to eigenvectors, but signals are given: leave one of them out.");
  options.threads = a.threads();
  if(a.has("max_error"))
    options.maximum_error = a.number("max_error", 0, false);
  std::string said;
  if(a.has("quadrics_above") && quadrics_above_is_passed_over(options, said))
    refuse("quadrics_above" + said);
  return options;
}

// What the collapses are to keep: eigenvectors that are to be computed, those that are given, or signals.
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
    refuse("pre_simplify is " + to_string(first) + ", it must not be below n, which is " + to_string(target) +
           ", and above k, which is " + to_string(k) + ".");
  if(own + a.has("eigenpairs") + (first > 0 && first < n) > 1)
    refuse("of signals, eigenpairs and pre_simplify, which the preset fast sets, only one can be given.");
  if(!a.has("eigenpairs"))
    return;
  const Pairs& given = given_pairs(a, n, options.mass, k);
  options.eigenpairs =
      given.pairs->size() == k ? given.pairs : std::make_shared<SG::Eigenpairs>(first_pairs(*given.pairs, k));
}

Simplification simplify(const Arguments& a)
{
  auto fine = std::make_shared<const SG::Mesh_matrices>(a.mesh("V", "F"));
  const Index vertices = fine->V.rows();
  const SG::Mesh_diagnosis diagnosis = checked(*fine, "V, F");
  const Index n = a.integer("n", 1, vertices, ", as many as V has");
  SMS::Spectral_edge_collapse_options options = run_options(a, n);
  set_signals(a, vertices, n, options);
  options.coefficients = a.coefficients(vertices);
  options.boundary = a.boundary();
  options.intrinsic_delaunay = a.intrinsic_delaunay();
  if(a.has("keep"))
    options.kept_vertices = a.indices("keep", std::size_t(vertices), "V");
  Watch watch(a);
  options.progress = [&](const SMS::Spectral_progress& progress) {
    return watch(word_of(phase_words, progress.phase), progress.fraction);
  };
  struct Run
  {
    SMS::Spectral_edge_collapse_result result;
    SG::Mesh_matrices coarse;
    std::shared_ptr<const SG::Laplace_operator> op;
    std::optional<Fitted_pairs> fitted;
  };
  Run run = watch.run([&] {
    Run run;
    Mesh mesh = surface_mesh(*fine);
    run.result = simplify_mesh(mesh, std::size_t(n), options);
    run.coarse = SG::mesh_matrices(mesh);
    if(run.result.eigenpairs && run.result.eigenpairs->vectors.rows() == vertices)
      run.op = std::make_shared<SG::Laplace_operator>(operator_of(*fine, options, "V, F"));
    if(run.result.fitted)
      run.fitted = fitted_pairs(std::move(*run.result.fitted), options.operator_fit,
                                (std::min)(options.number_of_eigenvectors, run.coarse.V.rows()));
    return run;
  });
  const auto k = std::size_t(options.number_of_eigenvectors);
  for(const std::string& warning : diagnosis.warnings(k, std::size_t(n)))
    run.result.warnings.push_back(warning);
  Simplification result(std::move(fine), std::move(run.coarse), run.result.restriction,
                        run.result.vertex_map);
  result.report = py::module_::import("json").attr("loads")(
      run_json(run.result, options, a["preset"].cast<std::string>()).dump());
  result.eigenpairs = py::none();
  if(a.has("eigenpairs"))
    result.eigenpairs = a["eigenpairs"];
  else if(run.op)
    result.eigenpairs = py::cast(Pairs{run.result.eigenpairs, run.op, SG::mass_name(options.mass)});
  result.coefficients = run.result.coefficients.rows() != 0
                            ? py::cast(Eigen::MatrixXd(run.result.coefficients))
                            : py::object(py::none());
  result.fitted = run.fitted ? py::cast(std::move(*run.fitted)) : py::none();
  result.log = std::move(run.result.log);
  for(const std::string& warning : run.result.warnings)
    warn(warning);
  if(!run.result.explanation.empty())
    warn(run.result.explanation);
  return result;
}

// What a user sees, interface.py.
constexpr const char* python_interface =
#include "interface.h"
    ;

template <class Function>
void define(py::module_& m, const char* name, const Function& function)
{
  m.def(name, [function](const py::dict& values) { return function(Arguments(values)); });
}

template <class Matrix>
py::cpp_function viewed(const Matrix SG::Eigenpairs::*member)
{
  return py::cpp_function(
      [member](const py::object& self) { return view((*self.cast<const Pairs&>().pairs).*member, self); });
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

std::string size(const Pairs& pairs)
{
  return to_string(pairs.pairs->size()) + " of " + to_string(pairs.op->L.rows()) + " vertices, " +
         pairs.mass + " mass>";
}

} // namespace

PYBIND11_MODULE(spectral_simplification, m)
{
  m.doc() =
      "Simplifies triangle meshes so that the spectrum of their Laplacian stays what it was (Lescoat et "
      "al.,\n"
      "Spectral Mesh Simplification, 2020): arrays of NumPy in, arrays out, sparse matrices of SciPy.\n\n"
      "    run = simplify(V, F, 600)\n    run.V, run.F, run.P\n\n"
      "Options have the names, defaults and words of the program spectral_simplify. Computations let other\n"
      "threads of Python run.";
  py::options options;
  options.disable_function_signatures();

  py::register_exception<SG::Cancelled>(m, "Cancelled", PyExc_RuntimeError).attr("__doc__") =
      "The progress callback returned False. Nothing is returned, nothing was changed.";

  py::class_<Pairs>(m, "Eigenpairs",
                    "Eigenpairs of a mesh, at its scale. The arrays are views and cannot be written.")
      .def_property_readonly("values", viewed(&SG::Eigenpairs::values), "(k,) eigenvalues, ascending")
      .def_property_readonly("vectors", viewed(&SG::Eigenpairs::vectors),
                             "(v, k) eigenvectors, vectors^T M vectors = 1")
      .def_property_readonly("residuals", viewed(&SG::Eigenpairs::residuals), "(k,) relative residuals")
      .def_property_readonly(
          "L", [](const Pairs& self) { return csr(self.op->L); },
          "(v, v) cotangent Laplacian, positive semidefinite; a new csr_matrix each time")
      .def_property_readonly(
          "M", [](const Pairs& self) { return csr(self.op->B); },
          "(v, v) mass, the manual's B; a new csr_matrix each time")
      .def_readonly("mass", &Pairs::mass, "'lumped', 'averaged' or 'voronoi'")
      .def_property_readonly("zeros", of_pairs(&SG::Eigenpairs::zeros),
                             "how many eigenvalues are zero, one for each component")
      .def_property_readonly("complete", of_pairs(&SG::Eigenpairs::complete), "whether none can be missing")
      .def_property_readonly("solver", of_pairs(&SG::Eigenpairs::solver), "which one was used")
      .def("__len__", [](const Pairs& self) { return self.pairs->size(); })
      .def("__repr__", [](const Pairs& self) { return "<Eigenpairs: " + size(self); });

  py::class_<Fitted_pairs, Pairs>(
      m, "Fitted_operators",
      "Operators that were fitted, L and M, and their eigenpairs; mass is 'diagonal' or "
      "'edges'.")
      .def_property_readonly("objective_before", of_fit(&SG::Operator_fit_result::objective_before),
                             "what was minimised, for the mesh's own entries")
      .def_property_readonly("objective_after", of_fit(&SG::Operator_fit_result::objective_after),
                             "and for these")
      .def_property_readonly("iterations", of_fit(&SG::Operator_fit_result::iterations),
                             "of the barrier method")
      .def_property_readonly("converged", of_fit(&SG::Operator_fit_result::converged),
                             "False where it was stopped, valid all the same")
      .def_property_readonly("unknowns", of_fit(&SG::Operator_fit_result::unknowns),
                             "how many weights were chosen")
      .def_property_readonly("at_bound", of_fit(&SG::Operator_fit_result::at_bound),
                             "and how many are at their bounds")
      .def("__repr__", [](const Fitted_pairs& self) { return "<Fitted_operators: " + size(self); });

  py::class_<Level>(m, "Level", "A simplified mesh.")
      .def_readonly("V", &Level::V, "(n, 3) float64, positions")
      .def_readonly("F", &Level::F, "(m, 3) int32, triangles")
      .def_readonly("P", &Level::P, "(n, v) csr_matrix, carries functions to this mesh: P @ f; rows sum to 1")
      .def_property_readonly(
          "Q", &Level::prolongation,
          "(v, n) csr_matrix, carries functions back: barycentric coordinates of the closest "
          "points; computed when it is first asked for")
      .def_readonly("vertex_map", &Level::vertex_map,
                    "(v,) int64, the vertex of this mesh that each went to");

  py::class_<Simplification, Level>(m, "Simplification", "What simplify() returns.")
      .def_property_readonly(
          "collapses", &Simplification::collapses,
          "one record for each collapse, in order: the vertices of the input removed and kept, alpha, "
          "the weight of the removed one, and point, where the vertex was put")
      .def_readonly(
          "eigenpairs", &Simplification::eigenpairs,
          "of the input, for simplify(..., eigenpairs=...) and evaluate(); None with signals or pre_simplify")
      .def_readonly(
          "coefficients", &Simplification::coefficients,
          "(n, 7), what the collapses have made of coefficients=: of the operator of this mesh; None "
          "without")
      .def_readonly("fitted", &Simplification::fitted,
                    "with fit_operators=True operators of the mesh that were fitted to the spectrum of the "
                    "input, and k "
                    "eigenpairs of them: for evaluate(..., operators=...); else None")
      .def_readonly("report", &Simplification::report,
                    "a dict of what was done, with the names of spectral_simplify --json: counts, seconds, "
                    "stop_reason, "
                    "warnings")
      .def("levels", &Simplification::level, py::arg("n"),
           "levels(n) -> Level\n\nThe mesh of n vertices on the way from the input to the result, before "
           "flips and "
           "relocation.")
      .def("__repr__", [](const Simplification& self) {
        return "<Simplification: " + to_string(self.fine->V.rows()) + " to " +
               to_string(self.coarse.V.rows()) + " vertices>";
      });

  using Evaluation = SG::Spectral_evaluation;
  py::class_<Evaluation>(m, "Evaluation", "What evaluate() returns. 0 is perfect.")
      .def_readonly("C", &Evaluation::C, "(k, k) functional map, rows are coarse modes")
      .def_readonly("C_L", &Evaluation::norm_L, "|C Lambda - Lambda_c C| / |C|, how far from commuting")
      .def_readonly("C_D", &Evaluation::norm_D, "|C^T C - 1|, how far from orthonormal")
      .def_readonly("floor_C_L", &Evaluation::floor_norm_L, "C_L of ideal linear elements, about")
      .def_readonly("floor_C_D", &Evaluation::floor_norm_D, "C_D of ideal linear elements, about")
      .def_property_readonly(
          "eigenvalue_error", [](const Evaluation& e) { return e.errors.mean; },
          "mean relative error of the eigenvalues, zeros left out")
      .def_property_readonly(
          "eigenvalue_error_max", [](const Evaluation& e) { return e.errors.max; }, "the largest")
      .def_property_readonly(
          "eigenvalue_error_low", [](const Evaluation& e) { return e.errors_low.mean; },
          "mean of the modes 2 to k / 5")
      .def_readonly("values", &Evaluation::fine_values, "fine eigenvalues at unit area")
      .def_readonly("coarse_values", &Evaluation::coarse_values, "coarse eigenvalues at unit area")
      .def_readonly("judged_modes", &Evaluation::judged_modes,
                    "k, or the number of coarse vertices if that is less")
      .def_readonly("area_ratio", &Evaluation::area_ratio, "coarse over fine")
      .def("__repr__", [](const Evaluation& e) {
        return "<Evaluation: C_L " + to_string(e.norm_L) + ", C_D " + to_string(e.norm_D) +
               ", eigenvalue error " + to_string(100 * e.errors.mean) + " %>";
      });

  define(m, "_simplify", simplify);
  define(m, "_eigenpairs", eigenpairs);
  define(m, "_evaluate", evaluate);
  define(m, "_fit_operators", fit_operators);
  define(m, "_curvature_coefficients", curvature_coefficients);
  define(m, "_weighted_coefficients", weighted_coefficients);
  define(m, "_functional_map", functional_map);
  define(m, "_distances", distances);
  define(m, "_heat_kernel_signature", heat_kernel_signature);
  define(m, "_wave_kernel_signature", wave_kernel_signature);
  define(m, "_wave_kernel_energies", wave_kernel_energies);
#ifdef SPECTRAL_PYTHON_MATCH
  py::class_<Matched>(m, "Match", "What match() returns.")
      .def_readonly("map", &Matched::map, "(vx,) int64, for each vertex of X that of Y")
      .def_readonly("C", &Matched::C, "(k, k) functional map from Y to X, at unit area")
      .def_readonly("condition", &Matched::condition, "of the lift from the simplified meshes")
      .def_readonly("relative_residual", &Matched::relative_residual, "of the lift");
  define(m, "_match", match);
#else
  m.def("_match", [](const py::dict&) -> py::object {
    throw std::runtime_error("match() is not in this build, LEMON was not found: install it (on Debian: "
                             "apt-get install liblemon-dev) and "
                             "build again.");
  });
#endif
  py::exec(python_interface, m.attr("__dict__"));
  m.attr("__all__") =
      py::eval("sorted(n for n, x in globals().items() if getattr(x, '__module__', '') == __name__ "
               "and n[0] != '_')",
               m.attr("__dict__"));
}
