// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The module spectral_simplification: arrays of NumPy in, arrays out. What a user sees, signatures and texts of help(), is Python,
// interface.py; each function there hands its arguments to one here.

#include "arguments.h"
#include "watch.h"

#include "../programs/io/polygon_soup.h"
#include "../programs/option_words.h"
#include "../programs/report/run_json.h"
#ifdef SPECTRAL_PYTHON_MATCH
#include "../programs/matching/matcher.h"
#endif

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/curvature_coefficients.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/fitted_operators.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_geometry/mesh_diagnosis.h>
#include <CGAL/Spectral_geometry/spectral_distances.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <pybind11/eigen.h>
#include <pybind11/eval.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace SMS = CGAL::Surface_mesh_simplification;

using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

namespace {

// The library speaks of a mesh; here there may be two.
template <class Function>
auto named(const char* names, const Function& function)
{
  try {
    return function();
  } catch(const std::invalid_argument& error) {
    throw std::invalid_argument(std::string(names) + ": " + error.what());
  }
}

SG::Laplace_operator operator_of(const SG::Mesh_matrices& mesh, const SMS::Spectral_options& options,
                                 const char* names)
{
  return named(names, [&] { return SMS::internal::operator_of_basis(mesh.V, mesh.T, options); });
}

// The options that say which operator a function is about.
SMS::Spectral_options operator_options(const Arguments& a, const Index n)
{
  SMS::Spectral_options options;
  options.mass = a.mass();
  options.coefficients = a.coefficients(n);
  options.boundary = a.boundary();
  options.intrinsic_delaunay = a.intrinsic_delaunay();
  return options;
}

// Memory of `owner` as an array that may be read.
template <class Matrix>
py::array view(const Matrix& matrix, const py::object& owner)
{
  constexpr auto size = py::ssize_t(sizeof(typename Matrix::Scalar));
  py::array result = Matrix::ColsAtCompileTime == 1
                         ? py::array(py::dtype::of<double>(), {matrix.size()}, {size}, matrix.data(), owner)
                         : py::array(py::dtype::of<double>(), {matrix.rows(), matrix.cols()},
                                     {size, size * matrix.rows()}, matrix.data(), owner);
  result.attr("setflags")(py::arg("write") = false);
  return result;
}

py::object csr(const Eigen::SparseMatrix<double>& matrix)
{
  return py::cast(Eigen::SparseMatrix<double, Eigen::RowMajor>(matrix));
}

template <class T>
py::array array_of(const std::vector<T>& values)
{
  py::array_t<std::int64_t> result(py::ssize_t(values.size()));
  std::copy(values.begin(), values.end(), result.mutable_data());
  return result;
}

struct Pairs
{
  std::shared_ptr<const SG::Eigenpairs> pairs;
  std::shared_ptr<const SG::Laplace_operator> op;
  std::string mass;
};

struct Fitted_pairs : Pairs
{
  SG::Operator_fit_result fit; // without its operator
};

Fitted_pairs fitted_pairs(SG::Operator_fit_result fit, const SG::Operator_fit_options& options, const Index k,
                          const SG::Eigenpairs_options& solver = {})
{
  Fitted_pairs result;
  result.fit = std::move(fit);
  result.op = std::make_shared<SG::Laplace_operator>(std::move(result.fit.op));
  result.pairs = std::make_shared<SG::Eigenpairs>(SG::eigenpairs(*result.op, k, solver));
  result.mass = options.mass == SG::Operator_fit_options::Mass_pattern::diagonal ? "diagonal" : "edges";
  return result;
}

const Pairs& pairs_of(const Arguments& a, const char* name)
{
  if(!py::isinstance<Pairs>(a[name]))
    throw py::type_error(std::string(name) + " is " + type_name(a[name]) +
                         ", it must be Eigenpairs: pass what eigenpairs() returns.");
  return a[name].cast<const Pairs&>();
}

void check_rows(const Pairs& pairs, const char* name, const Index n, const char* of)
{
  if(pairs.op->L.rows() != n)
    refuse(std::string(name) + " are of " + to_string(pairs.op->L.rows()) + " vertices, but " + of + " has " +
           to_string(n) + ": pass the eigenpairs of that mesh.");
}

// Eigenpairs of the mesh of n vertices in the mass, k at least.
const Pairs& given_pairs(const Arguments& a, const Index n, const SG::Mass mass, const Index k)
{
  const Pairs& given = pairs_of(a, "eigenpairs");
  check_rows(given, "eigenpairs", n, "V");
  if(given.mass != SG::mass_name(mass))
    refuse("eigenpairs are of the " + given.mass + " mass, but the " + SG::mass_name(mass) +
           " one is wanted: pass mass='" + given.mass + "'.");
  if(given.pairs->size() < k)
    refuse("eigenpairs are " + to_string(given.pairs->size()) + ", but k is " + to_string(k) +
           ": pass k=" + to_string(given.pairs->size()) + ", or compute more.");
  return given;
}

SG::Eigenpairs first_pairs(const SG::Eigenpairs& all, const Index k)
{
  SG::Eigenpairs result;
  result.values = all.values.head(k);
  result.vectors = all.vectors.leftCols(k);
  result.residuals = all.residuals.head((std::min)(k, all.residuals.size()));
  result.solver = all.solver;
  result.complete = all.complete;
  result.zeros = all.zeros;
  return result;
}

Pairs eigenpairs(const Arguments& a)
{
  const SG::Mesh_matrices mesh = a.mesh("V", "F");
  const Index k = a.integer("k", 1, mesh.V.rows());
  const SMS::Spectral_options of = operator_options(a, mesh.V.rows());
  Watch watch(a);
  SG::Eigenpairs_options options;
  options.tolerance = a.number("tolerance", 0, false, 0.5);
  options.threads = a.threads();
  options.progress = [&](const double fraction) { return watch("eigenpairs", fraction); };
  return watch.run([&] {
    auto op = std::make_shared<SG::Laplace_operator>(operator_of(mesh, of, "V, F"));
    auto pairs = std::make_shared<SG::Eigenpairs>(SG::eigenpairs(*op, k, options));
    return Pairs{std::move(pairs), std::move(op), SG::mass_name(of.mass)};
  });
}

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

std::vector<std::vector<std::size_t>> triangles_of(const SG::Mesh_matrices& matrices)
{
  std::vector<std::vector<std::size_t>> result;
  for(Index f = 0; f < matrices.T.rows(); ++f)
    result.push_back(
        {std::size_t(matrices.T(f, 0)), std::size_t(matrices.T(f, 1)), std::size_t(matrices.T(f, 2))});
  return result;
}

Mesh surface_mesh(const SG::Mesh_matrices& matrices)
{
  std::vector<Kernel::Point_3> points;
  for(Index v = 0; v < matrices.V.rows(); ++v)
    points.emplace_back(matrices.V(v, 0), matrices.V(v, 1), matrices.V(v, 2));
  Mesh mesh;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, triangles_of(matrices), mesh);
  return mesh;
}

SG::Mesh_diagnosis checked(const SG::Mesh_matrices& matrices, const std::string& names)
{
  const py::gil_scoped_release no_gil;
  SG::Mesh_diagnosis diagnosis = SG::diagnose_polygon_soup(matrices.V, triangles_of(matrices));
  const std::vector<std::string> obstacles = diagnosis.obstacles();
  if(!obstacles.empty())
    refuse(names + " cannot be used as they are: " + obstacles.front() + ".");
  if(matrices.T.rows() == 0)
    refuse(names + " cannot be used as they are: there are no faces.");
  return diagnosis;
}

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
  words.placement = a.word("placement", {"on_edge", "midpoint", "free"}, true);
  words.mass = a.word("mass", {"lumped", "averaged", "voronoi"}, true);
  if(a.has("shape"))
    words.shape = a.number("shape", 0);
  words.self_intersections = a.word("self_intersections", {"allow", "refuse"}, true);
  words.relocate = a.word("relocate", {"none", "sampled", "carried", "carried_and_sampled"}, true);
  words.flips = a.word("flips", {"none", "spectral", "delaunay"});
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
    return watch(phase_name(progress.phase), progress.fraction);
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
    run.result = SMS::spectral_edge_collapse(mesh, std::size_t(n), options);
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

// How well the spectrum was kept, with tight pairs; a tenth more coarse modes tells loss from exchange at the cut.
SG::Spectral_evaluation evaluate(const Arguments& a)
{
  const SG::Mesh_matrices fine = a.mesh("V", "F"), coarse = a.mesh("Vc", "Fc");
  const Index n = fine.V.rows(), N = coarse.V.rows(), k = a.integer("k", 1, n);
  const Eigen::SparseMatrix<double> P = a.sparse("P", N, n);
  const SMS::Spectral_options of = operator_options(a, n);
  SMS::Spectral_options of_coarse = of;
  if(a.has("coarse_coefficients") && !a.has("coefficients"))
    refuse("coarse_coefficients are given without coefficients: two operators would be compared.");
  if(a.has("coarse_coefficients"))
    of_coarse.coefficients = a.coefficients(N, "coarse_coefficients", "Vc");
  else if(of.coefficients.rows() != 0)
    of_coarse.coefficients = P * of.coefficients;
  std::optional<Pairs> given, fitted;
  if(a.has("eigenpairs"))
    given = given_pairs(a, n, of.mass, k);
  if(a.has("operators")) {
    if(!py::isinstance<Fitted_pairs>(a["operators"]))
      throw py::type_error("operators must be Fitted_operators: pass what fit_operators() returns.");
    fitted = pairs_of(a, "operators");
    check_rows(*fitted, "operators", N, "Vc");
    if(fitted->pairs->size() < (std::min)(k, N))
      refuse("operators have " + to_string(fitted->pairs->size()) + " eigenpairs, but k is " + to_string(k) +
             ": ask fit_operators() for more.");
  }
  Watch watch(a);
  SG::Eigenpairs_options options;
  options.threads = a.threads();
  options.progress = [&](const double fraction) { return watch("evaluation", fraction); };
  return watch.run([&] {
    const SG::Laplace_operator fine_op = operator_of(fine, of, "V, F");
    if(given && ((fine_op.L - given->op->L).norm() > 1e-12 * fine_op.L.norm() ||
                 (fine_op.mass - given->op->mass).norm() > 1e-12 * fine_op.mass.norm()))
      throw std::invalid_argument("eigenpairs are those of another mesh or operator: compute them of V, F.");
    const SG::Laplace_operator coarse_op = fitted ? *fitted->op : operator_of(coarse, of_coarse, "Vc, Fc");
    const SG::Eigenpairs fine_pairs = given ? *given->pairs : SG::eigenpairs(fine_op, k, options);
    const SG::Eigenpairs coarse_pairs =
        fitted ? *fitted->pairs
               : SG::eigenpairs(coarse_op, (std::min)(N - coarse_op.vanishing, k + (k + 9) / 10), options);
    return SG::evaluate_spectrum(fine_op, fine_pairs, coarse_op, coarse_pairs, P, k);
  });
}

Fitted_pairs fit_operators(const Arguments& a)
{
  const SG::Mesh_matrices coarse = a.mesh("Vc", "Fc");
  const Pairs fine = pairs_of(a, "eigenpairs");
  const Eigen::SparseMatrix<double> P = a.sparse("P", coarse.V.rows(), fine.op->L.rows());
  const Index k =
      a.has("k") ? a.integer("k", 1, coarse.V.rows()) : (std::min)(fine.pairs->size(), coarse.V.rows());
  const std::string mass = a.word("mass", {"diagonal", "edges"}, true);
  SG::Operator_fit_options options = SG::Operator_fit_options::for_mass(mass.empty()      ? fine.op->theta
                                                                        : mass == "edges" ? 1.
                                                                                          : 0.);
  if(a.has("rings"))
    options.rings = int(a.integer("rings", 1, 2));
  options.low_modes = a.number("low_modes", 0);
  options.orthonormality = a.number("orthonormality", 0);
  options.plain = a.number("plain", 0);
  SG::Local_operator local(fine.op->theta);
  local.voronoi = fine.op->voronoi;
  local.boundary = fine.op->boundary;
  local.coefficients = a.coefficients(coarse.V.rows(), "coefficients", "Vc");
  Watch watch(a);
  options.progress = [&](const double fraction) { return watch("operator_fit", fraction); };
  SG::Eigenpairs_options solver;
  solver.progress = [&](const double fraction) { return watch("eigenpairs", fraction); };
  return watch.run([&] {
    const SG::Laplace_operator op =
        named("Vc, Fc", [&] { return SG::laplace_operator(coarse.V, coarse.T, local); });
    return fitted_pairs(SG::fit_operators(op, P, *fine.op, *fine.pairs, options), options, k, solver);
  });
}

Eigen::MatrixXd curvature_coefficients(const Arguments& a)
{
  const SG::Mesh_matrices mesh = a.mesh("V", "F");
  const double anisotropy = a.number("anisotropy", 0, true, 1e6);
  const py::gil_scoped_release no_gil;
  return SG::curvature_coefficients(mesh.V, mesh.T, anisotropy);
}

Eigen::MatrixXd functional_map(const Arguments& a)
{
  const Pairs fine = pairs_of(a, "eigenpairs"), coarse = pairs_of(a, "coarse_eigenpairs");
  const Eigen::SparseMatrix<double> P = a.sparse("P", coarse.op->L.rows(), fine.op->L.rows());
  const py::gil_scoped_release no_gil;
  return SG::functional_map(coarse.pairs->vectors, coarse.op->B, P, fine.pairs->vectors);
}

// One source, and true, or a sequence of them.
std::pair<std::vector<Index>, bool> sources_of(const Arguments& a, const SG::Eigenpairs& pairs)
{
  const auto n = std::size_t(pairs.vectors.rows());
  if(PyIndex_Check(a["sources"].ptr()) &&
     py::module_::import("numpy").attr("ndim")(a["sources"]).cast<int>() == 0)
    return {{a.integer("sources", 0, Index(n) - 1, ", a vertex")}, true};
  const std::vector<std::size_t> sources = a.indices("sources", n, "the mesh");
  return {{sources.begin(), sources.end()}, false};
}

SG::Wave_kernel_energies energies_of(const Arguments& a, const SG::Eigenpairs& pairs)
{
  if(!a.has("energies"))
    return SG::wave_kernel_energies(pairs);
  try {
    if(py::isinstance<py::tuple>(a["energies"])) {
      const auto e = a["energies"].cast<std::tuple<double, double, double, Index>>();
      return {std::get<0>(e), std::get<1>(e), std::get<2>(e), std::get<3>(e)};
    }
  } catch(const py::cast_error&) {
  }
  a.must_be("energies", "a tuple (t_min, t_max, sigma, steps), see wave_kernel_energies()", true);
}

py::object distances(const Arguments& a)
{
  const Pairs given = pairs_of(a, "eigenpairs");
  const SG::Eigenpairs& pairs = *given.pairs;
  const auto [sources, one] = sources_of(a, pairs);
  const std::string kind = a.word("kind", {"diffusion", "biharmonic", "commute_time", "wave_kernel"});
  for(const auto& [name, of] :
      {std::make_pair("time", "diffusion"), std::make_pair("energies", "wave_kernel")})
    if(a.has(name) && kind != of)
      refuse(std::string(name) + " belongs to the kind '" + of + "', but the kind is '" + kind +
             "': leave it out.");
  const double time = kind != "diffusion" ? 0
                      : a.has("time")     ? a.number("time", 0)
                                          : SG::default_diffusion_time(pairs);
  const SG::Wave_kernel_energies energies =
      kind == "wave_kernel" ? energies_of(a, pairs) : SG::Wave_kernel_energies{0, 0, 1, 2};
  Eigen::MatrixXd result;
  {
    const py::gil_scoped_release no_gil;
    result = kind == "diffusion"      ? SG::squared_diffusion_distance(pairs, sources, time)
             : kind == "biharmonic"   ? SG::squared_biharmonic_distance(pairs, sources)
             : kind == "commute_time" ? SG::squared_commute_time_distance(pairs, sources)
                                      : SG::wave_kernel_distance(pairs, sources, energies);
  }
  return one ? py::cast(Eigen::VectorXd(result.col(0))) : py::cast(std::move(result));
}

Eigen::MatrixXd heat_kernel_signature(const Arguments& a)
{
  const Pairs given = pairs_of(a, "eigenpairs");
  const Eigen::VectorXd times = a.has("times") ? a.array<double>("times", 0, "time").cast<Eigen::VectorXd>()
                                               : SG::heat_kernel_times(*given.pairs);
  const py::gil_scoped_release no_gil;
  return SG::heat_kernel_signature(*given.pairs, times);
}

Eigen::MatrixXd wave_kernel_signature(const Arguments& a)
{
  const Pairs given = pairs_of(a, "eigenpairs");
  const SG::Wave_kernel_energies energies = energies_of(a, *given.pairs);
  const py::gil_scoped_release no_gil;
  return SG::wave_kernel_signature(*given.pairs, energies);
}

py::tuple wave_kernel_energies(const Arguments& a)
{
  const SG::Wave_kernel_energies e =
      SG::wave_kernel_energies(*pairs_of(a, "eigenpairs").pairs, a.integer("steps", 1, 1000000));
  return py::make_tuple(e.t_min, e.t_max, e.sigma, e.steps);
}

#ifdef SPECTRAL_PYTHON_MATCH
struct Matched
{
  py::array map;
  Eigen::MatrixXd C;
  double condition, relative_residual;
};

// What the program shape_matching does.
Matched match(const Arguments& a)
{
  const SG::Mesh_matrices X = a.mesh("VX", "FX"), Y = a.mesh("VY", "FY");
  checked(X, "VX, FX");
  checked(Y, "VY, FY");
  const Index n = a.integer("n", 4, (std::min)(X.V.rows(), Y.V.rows()), ", the vertices of the smaller mesh");
  const SG::Mass mass = a.mass();
  Matching_options options;
  options.modes = a.integer("k", 10, n, ", which is n");
  options.initial_modes = a.integer("initial", 4, 60);
  options.filter_iterations = int(a.integer("filter_iterations", 0, 1000));
  options.fine_iterations = int(a.integer("fine_iterations", 0, 1000));
  options.local_weight = a.number("local_weight", 0, true, 100);
  options.threads = a.threads();
  const std::string proxy = a.word("proxy", {"spectral", "garland_heckbert", "none"});
  const auto operators =
      a.word("operators", {"fitted", "mesh"}) == "fitted" ? Proxy_operators::fitted : Proxy_operators::mesh;
  Landmarks landmarks;
  if(a.has("landmarks")) {
    const auto rows = a.array<std::int64_t>("landmarks", 2, "pair of vertices");
    for(py::ssize_t i = 0; i < rows.shape(0); ++i) {
      for(int side = 0; side < 2; ++side)
        if(rows.at(i, side) < 0 || rows.at(i, side) >= (side == 0 ? X : Y).V.rows())
          refuse("landmarks[" + to_string(i) + ", " + to_string(side) + "] is " +
                 to_string(rows.at(i, side)) + ", but " + (side == 0 ? "VX" : "VY") + " has " +
                 to_string((side == 0 ? X : Y).V.rows()) + " vertices: they are counted from 0.");
      landmarks.emplace_back(rows.at(i, 0), rows.at(i, 1));
    }
  }
  Watch watch(a);
  const Match match = watch.run([&] {
    const auto going = [&](const char* phase, const double fraction) {
      return Keep_going([&watch, phase, fraction] { return watch(phase, fraction); });
    };
    const auto shape = [&](const SG::Mesh_matrices& mesh) {
      return make_shape(mesh, options.modes, mass, going("eigenpairs", 0));
    };
    const auto [x, y] = side_by_side(
        options.threads, [&] { return shape(X); }, [&] { return shape(Y); });
    if(proxy == "none")
      return match_directly(x, y, landmarks, options, going("match", 0.5));
    const auto kind = proxy == "spectral" ? Proxy_kind::spectral : Proxy_kind::garland_heckbert;
    const auto coarse = [&](const Shape& fine) {
      return make_proxy(surface_mesh(fine.matrices), fine, kind, std::size_t(n), options.modes, mass,
                        operators, going("proxies", 1. / 3));
    };
    const Shape &fine_X = x, &fine_Y = y;
    const auto [coarse_X, coarse_Y] = side_by_side(
        options.threads, [&] { return coarse(fine_X); }, [&] { return coarse(fine_Y); });
    return match_over_proxies(x, coarse_X, y, coarse_Y, landmarks, options, going("match", 2. / 3));
  });
  return {array_of(match.map), match.C, match.condition, match.relative_residual};
}
#endif

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
