// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_PYTHON_SPECTRA_H
#define SPECTRAL_PYTHON_SPECTRA_H

#include "arguments.h"
#include "arrays.h"
#include "meshes.h"
#include "watch.h"

#include <CGAL/Spectral_toolbox/curvature_coefficients.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_toolbox/fitted_operators.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_toolbox/hierarchical_functional_maps.h>
#include <CGAL/Spectral_geometry/operator_coefficients.h>
#include <CGAL/Spectral_geometry/relocation.h>
#include <CGAL/Spectral_toolbox/vertex_maps.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>
#include <CGAL/Surface_mesh_simplification/spectral_relocation.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace SMS = CGAL::Surface_mesh_simplification;

// Operators, their eigenpairs, and how those of two meshes compare.

inline SG::Laplace_operator operator_of(const SG::Mesh_matrices& mesh,
                                        const SMS::Spectral_options& options, const char* names)
{
  return named(names, [&] { return SMS::internal::operator_of_basis(mesh.V, mesh.T, options); });
}

// The options that say which operator a function is about.
inline SMS::Spectral_options operator_options(const Arguments& a, const Index n)
{
  SMS::Spectral_options options;
  options.mass = a.mass();
  options.coefficients = a.coefficients(n);
  options.boundary = a.boundary();
  if(a.intrinsic_delaunay())
    options.operator_of_eigenpairs = intrinsic_operator(options.mass);
  return options;
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

inline Fitted_pairs fitted_pairs(SG::Operator_fit_result fit,
                                 const SG::Operator_fit_options& options, const Index k,
                                 const SG::Eigenpairs_options& solver = {})
{
  Fitted_pairs result;
  result.fit = std::move(fit);
  result.op = std::make_shared<SG::Laplace_operator>(std::move(result.fit.op));
  result.pairs = std::make_shared<SG::Eigenpairs>(SG::eigenpairs(*result.op, k, solver));
  result.mass =
      options.mass == SG::Operator_fit_options::Mass_pattern::diagonal ? "diagonal" : "edges";
  return result;
}

// What a result of Python's is made of.
inline py::object core_of(const py::object& value)
{
  return py::getattr(value, "_core", value);
}

inline const Pairs& pairs_of(const Arguments& a, const char* name)
{
  const py::object core = core_of(a[name]);
  if(!py::isinstance<Pairs>(core))
    throw Wrong_type(
        std::string(name) + " is " + type_name(a[name]) +
        ", it must be Eigenpairs: pass what eigenpairs() or Eigenpairs.from_arrays() returns.");
  return core.cast<const Pairs&>();
}

inline void check_rows(const Pairs& pairs, const char* name, const Index n, const char* of)
{
  if(pairs.op->L.rows() != n)
    refuse(std::string(name) + " are of " + to_string(pairs.op->L.rows()) + " vertices, but " + of +
           " has " + to_string(n) + ": pass the eigenpairs of that mesh.");
}

inline SG::Eigenpairs_options solver_options(const Arguments& a, Watch& watch)
{
  SG::Eigenpairs_options options;
  options.tolerance = a.number("tolerance", 0, false, 0.5);
  options.threads = a.threads();
  options.progress = [&watch](const double fraction) { return watch("eigenpairs", fraction); };
  return options;
}

// Eigenpairs of the mesh of n vertices in the mass, k at least.
inline const Pairs& given_pairs(const Arguments& a, const Index n, const SG::Mass mass,
                                const Index k)
{
  const Pairs& given = pairs_of(a, "eigenpairs");
  check_rows(given, "eigenpairs", n, "V");
  const std::vector<std::string> known = words_of(mass_words);
  if(given.mass != SG::mass_name(mass))
    refuse("eigenpairs are of the " + given.mass + " mass, but the " + SG::mass_name(mass) +
           " one is wanted: " +
           (std::count(known.begin(), known.end(), given.mass) == 0
                ? "compute them in that mass."
                : "pass mass='" + given.mass + "'."));
  if(given.pairs->size() < k)
    refuse("eigenpairs are " + to_string(given.pairs->size()) + ", but k is " + to_string(k) +
           ": pass k=" + to_string(given.pairs->size()) + ", or compute more.");
  return given;
}

inline SG::Eigenpairs first_pairs(const SG::Eigenpairs& all, const Index k)
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

// Pairs that were asked for, with a word where they missed their tolerance.
inline Pairs checked(const SG::Eigenpairs_options& options, Pairs pairs)
{
  if(!pairs.pairs->complete && pairs.pairs->residuals.size() != 0) {
    std::ostringstream sentence;
    sentence << "The eigenpairs did not reach their tolerance of " << options.tolerance
             << ", the largest residual is " << pairs.pairs->residuals.maxCoeff()
             << ": ask for a larger tolerance.";
    warn(sentence.str());
  }
  return pairs;
}

inline Pairs eigenpairs(const Arguments& a)
{
  const SG::Mesh_matrices mesh = a.mesh("V", "F");
  const Index k = a.integer("k", 1, mesh.V.rows());
  SMS::Spectral_options of;
  of.mass = a.mass();
  of.coefficients = a.coefficients(mesh.V.rows());
  of.boundary = a.boundary();
  if(a.intrinsic_delaunay())
    of.operator_of_eigenpairs = intrinsic_operator(of.mass);
  Watch watch(a);
  SG::Eigenpairs_options options = solver_options(a, watch);
  return checked(options, watch.run([&] {
    auto op = std::make_shared<SG::Laplace_operator>(operator_of(mesh, of, "V, F"));
    auto pairs = std::make_shared<SG::Eigenpairs>(SG::eigenpairs(*op, k, options));
    return Pairs{std::move(pairs), std::move(op), SG::mass_name(of.mass)};
  }));
}

// Eigenpairs of a pencil that has no mesh.
inline Pairs eigsh(const Arguments& a)
{
  auto op = std::make_shared<SG::Laplace_operator>();
  op->L = a.sparse("L", -1, a["L"].attr("shape").attr("__getitem__")(-1).cast<Index>(),
                   "rows x columns");
  op->B = a.sparse("M", op->L.rows(), op->L.rows(), "as L");
  const Index k = a.integer("k", 1, op->L.rows(), ", the rows of L");
  Watch watch(a);
  SG::Eigenpairs_options options = solver_options(a, watch);
  return checked(options, watch.run([&] {
    auto pairs = std::make_shared<SG::Eigenpairs>(SG::eigenpairs(op->L, op->B, k, options));
    return Pairs{std::move(pairs), std::move(op), "given"};
  }));
}

// Pairs that another solver found, or that were stored.
inline py::object pairs_of_arrays(const Arguments& a)
{
  SG::Laplace_operator op;
  auto pairs = std::make_shared<SG::Eigenpairs>();
  pairs->values = a.array<double>("values", 0, "eigenvalue").cast<Eigen::VectorXd>();
  const Index k = pairs->values.size(),
              n = a["vectors"].attr("shape").attr("__getitem__")(0).cast<Index>();
  pairs->vectors = a.matrix("vectors", n, "the mesh");
  op.L = a.sparse("L", n, n, "as vectors has rows");
  op.B = a.sparse("M", n, n, "as vectors has rows");
  op.mass =
      a.has("row_masses")
          ? Eigen::VectorXd(a.array<double>("row_masses", 0, "vertex").cast<Eigen::VectorXd>())
          : Eigen::VectorXd(op.B * Eigen::VectorXd::Ones(n));
  op.theta = a.number("theta", 0, true, 1);
  const std::string mass = a["mass"].cast<std::string>();
  op.voronoi = mass == "voronoi";
  op.boundary = a.boundary();
  op.vanishing = a.integer("vanishing", 0);
  op.has_coefficients = a.flag("has_coefficients");
  pairs->residuals = a.array<double>("residuals", 0, "eigenvalue").cast<Eigen::VectorXd>();
  if(pairs->vectors.cols() != k || pairs->residuals.size() != k)
    refuse("vectors has " + to_string(pairs->vectors.cols()) + " columns, but values has " +
           to_string(k) + ": give one column for each.");
  pairs->further_values =
      a.array<double>("further_values", 0, "eigenvalue").cast<Eigen::VectorXd>();
  pairs->solver = a["solver"].cast<std::string>();
  pairs->complete = a.flag("complete");
  pairs->zeros = a.has("zeros") ? a.integer("zeros", 0) : SG::number_of_zero_eigenvalues(op);
  Pairs result{std::move(pairs), std::make_shared<SG::Laplace_operator>(std::move(op)), mass};
  if(!a.has("fit"))
    return py::cast(std::move(result));
  Fitted_pairs fitted;
  static_cast<Pairs&>(fitted) = std::move(result);
  const auto fit = a["fit"].cast<py::tuple>();
  fitted.fit.objective_before = fit[0].cast<double>();
  fitted.fit.objective_after = fit[1].cast<double>();
  fitted.fit.iterations = fit[2].cast<int>();
  fitted.fit.converged = fit[3].cast<bool>();
  fitted.fit.unknowns = fit[4].cast<Index>();
  fitted.fit.at_bound = fit[5].cast<Index>();
  return py::cast(std::move(fitted));
}

// How well the spectrum was kept, with tight pairs; a tenth more coarse modes tells loss from
// exchange at the cut.
inline py::dict evaluate(const Arguments& a)
{
  const SG::Mesh_matrices fine = a.mesh("V", "F"), coarse = a.mesh("Vc", "Fc");
  const Index n = fine.V.rows(), N = coarse.V.rows(), k = a.integer("k", 1, n);
  const std::string scale = a.word("scale", {"unit", "mesh"});
  const Eigen::SparseMatrix<double> P = a.sparse("P", N, n);
  // P is what it is, but the positions that it carries show whether its rows belong to Vc.
  double area = 0;
  for(Index t = 0; t < fine.T.rows(); ++t) {
    const Eigen::RowVector3d p = fine.V.row(fine.T(t, 0)), q = fine.V.row(fine.T(t, 1)),
                             r = fine.V.row(fine.T(t, 2));
    area += (q - p).cross(r - p).norm() / 2;
  }
  const double off = (P * fine.V - coarse.V).rowwise().norm().mean() / std::sqrt(area);
  if(!(off < (std::max)(0.05, 0.5 / std::sqrt(double(N)))))
    warn("P @ V lies " + to_string(int(std::round(100 * off))) +
         " % of the square root of the area away from Vc, on average: do the rows of P belong to "
         "Vc, and is "
         "Vc where "
         "V is and in its unit?");
  if(SG::internal::boundary_edges(fine.T).empty() &&
     !SG::internal::boundary_edges(coarse.T).empty())
    warn(
        "Vc, Fc has a border, and V, F has none: after mask= pass *run.part() and P[:, run.used].");
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
    if(!py::isinstance<Fitted_pairs>(core_of(a["operators"])))
      throw Wrong_type("operators must be Fitted_operators: pass what fit_operators() returns.");
    fitted = pairs_of(a, "operators");
    check_rows(*fitted, "operators", N, "Vc");
    if(fitted->pairs->size() < (std::min)(k, N))
      refuse("operators have " + to_string(fitted->pairs->size()) + " eigenpairs, but k is " +
             to_string(k) + ": ask fit_operators() for more.");
  }
  Watch watch(a);
  SG::Eigenpairs_options options;
  options.threads = a.threads();
  options.progress = [&](const double fraction) { return watch("evaluation", fraction); };
  const SG::Spectral_evaluation e = watch.run([&] {
    const SG::Laplace_operator fine_op = operator_of(fine, of, "V, F");
    if(given && ((fine_op.L - given->op->L).norm() > 1e-12 * fine_op.L.norm() ||
                 (fine_op.mass - given->op->mass).norm() > 1e-12 * fine_op.mass.norm()))
      throw std::invalid_argument(
          "eigenpairs are those of another mesh or operator: compute them of V, F.");
    const SG::Laplace_operator coarse_op =
        fitted ? *fitted->op : operator_of(coarse, of_coarse, "Vc, Fc");
    const SG::Eigenpairs fine_pairs = given ? *given->pairs : SG::eigenpairs(fine_op, k, options);
    const SG::Eigenpairs coarse_pairs =
        fitted ? *fitted->pairs
               : SG::eigenpairs(coarse_op, (std::min)(N - coarse_op.vanishing, k + (k + 9) / 10),
                                options);
    return SG::evaluate_spectrum(fine_op, fine_pairs, coarse_op, coarse_pairs, P, k,
                                 SG::closest_point_prolongation(fine, coarse, P));
  });
  py::dict result;
  const bool unit = scale == "unit";
  const double fine_area = unit ? 1 : e.fine_area, coarse_area = unit ? 1 : e.coarse_area;
  const Eigen::VectorXd values = e.fine_values / fine_area,
                        coarse_values = e.coarse_values / coarse_area;
  const auto errors = [&](const Index first, const Index last) {
    return SG::eigenvalue_errors(values, coarse_values, first, last, e.fine_zeros);
  };
  result["scale"] = scale;
  result["C"] = Eigen::MatrixXd(std::sqrt(coarse_area / fine_area) * e.C);
  result["C_L"] = unit ? e.norm_L : e.norm_L_input_scale;
  result["C_D"] = unit ? e.norm_D : e.norm_D_input_scale;
  result["floor_C_L"] = e.floor_norm_L / fine_area;
  result["floor_C_D"] = e.floor_norm_D;
  result["span_loss"] = e.span_loss;
  result["eigenvalue_error"] = errors(0, e.judged_modes).mean;
  result["eigenvalue_error_max"] = errors(0, e.judged_modes).max;
  result["eigenvalue_error_low"] = errors(1, e.judged_modes / 5).mean;
  result["values"] = values;
  result["coarse_values"] = coarse_values;
  result["judged_modes"] = e.judged_modes;
  result["area_ratio"] = e.area_ratio;
  return result;
}

inline Fitted_pairs fit_operators(const Arguments& a)
{
  const SG::Mesh_matrices coarse = a.mesh("Vc", "Fc");
  const Pairs fine = pairs_of(a, "eigenpairs");
  const Eigen::SparseMatrix<double> P = a.sparse("P", coarse.V.rows(), fine.op->L.rows());
  const Index k = a.has("k") ? a.integer("k", 1, coarse.V.rows())
                             : (std::min)(fine.pairs->size(), coarse.V.rows());
  const std::string mass = a.word("mass", {"diagonal", "edges"}, true);
  SG::Operator_fit_options options =
      SG::Operator_fit_options::for_mass(mass.empty()      ? fine.op->theta
                                         : mass == "edges" ? 1.
                                                           : 0.);
  if(a.has("rings"))
    options.rings = int(a.integer("rings", 1, 2));
  options.low_modes = a.number("low_modes", 0);
  options.orthonormality = a.number("orthonormality", 0);
  options.whole_residual = a.number("whole_residual", 0);
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
    return fitted_pairs(SG::fit_operators(op, P, *fine.op, *fine.pairs, options), options, k,
                        solver);
  });
}

inline Eigen::MatrixXd weighted_coefficients(const Arguments& a)
{
  if(!a.has("density") && !a.has("conductivity"))
    refuse("density and conductivity are None: give one of them.");
  const auto values = [&](const char* name) {
    if(!a.has(name))
      return Eigen::VectorXd();
    const auto given = a.array<double>(name, 0, "vertex").template cast<Eigen::VectorXd>();
    if(given.size() == 0)
      refuse(std::string(name) + " is empty: give one number for each vertex, or None.");
    return given;
  };
  return SG::weighted_coefficients(values("density"), values("conductivity"));
}

inline Eigen::MatrixXd curvature_coefficients(const Arguments& a)
{
  const SG::Mesh_matrices mesh = a.mesh("V", "F");
  const double anisotropy = a.number("anisotropy", 0, true, 1e6);
  return interruptible([&] {
    return SG::curvature_coefficients(mesh.V, mesh.T, anisotropy,
                                      [](double) { return check_signals(), true; });
  });
}

inline Eigen::MatrixXd functional_map(const Arguments& a)
{
  const Pairs fine = pairs_of(a, "eigenpairs"), coarse = pairs_of(a, "coarse_eigenpairs");
  const Eigen::SparseMatrix<double> P = a.sparse("P", coarse.op->L.rows(), fine.op->L.rows());
  const py::gil_scoped_release no_gil;
  return SG::functional_map(coarse.pairs->vectors, coarse.op->B, P, fine.pairs->vectors);
}

// The vertices of a mesh of any origin moved so that its spectrum comes closer to that of a fine
// one.
inline py::dict relocate(const Arguments& a)
{
  const SG::Mesh_matrices fine = a.mesh("V", "F");
  SG::Mesh_matrices coarse = a.mesh("Vc", "Fc");
  const Pairs pairs = pairs_of(a, "eigenpairs");
  check_rows(pairs, "eigenpairs", fine.V.rows(), "V");
  const Eigen::SparseMatrix<double> P = a.sparse("P", coarse.V.rows(), fine.V.rows());
  SG::Local_operator op(pairs.op->theta);
  op.voronoi = pairs.op->voronoi;
  op.boundary = pairs.op->boundary;
  std::vector<bool> fixed(std::size_t(coarse.V.rows()), false);
  for(const std::size_t v : a.indices("fixed", fixed.size(), "Vc"))
    fixed[v] = true;
  Watch watch(a);
  SG::Relocation_options options;
  options.signals = value_of(relocation_words, a.word("signals", words_of(relocation_words)));
  set_preference(a.word("prefer", {"spectrum", "shape"}, true), options);
  options.threads = a.threads();
  options.eigenpairs = pairs.pairs.get();
  options.modes = pairs.pairs->size();
  if(SMS::internal::has_reachable_eigenvalues(op))
    options.eigenvalues = pairs.op->mass.sum() * pairs.pairs->all_values();
  options.progress = [&](const double fraction) { return watch("relocation", fraction); };
  const SG::Relocation_result done = watch.run([&] {
    const auto [F, Z] = SMS::internal::mixtures_of_eigenpairs(*pairs.pairs);
    return SG::relocate_positions(coarse.V, coarse.T, P, fine, F, Z, op, fixed, options);
  });
  py::dict result;
  result["V"] = py::cast(Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>(coarse.V));
  result["P"] = csr(done.restriction);
  return result;
}

inline py::dict lift_functional_map(const Arguments& a)
{
  const auto read = [&](const char* name) {
    const Index rows = a.array<double>(name, -1, "mode").shape(0);
    return a.matrix(name, rows, name);
  };
  const SG::Lifted_functional_map lifted =
      SG::lift_functional_map(read("source_restriction"), read("coarse"),
                              read("target_restriction"), a.number("tolerance", 0, true, 1));
  py::dict result;
  result["C"] = lifted.C;
  result["condition"] = lifted.condition;
  result["rank"] = lifted.rank;
  result["relative_residual"] = lifted.relative_residual;
  return result;
}

// For each vertex of the target one of the source.
inline py::array point_map(const Arguments& a)
{
  const Pairs source = pairs_of(a, "source"), target = pairs_of(a, "target");
  const Index rows = a.array<double>("C", -1, "mode of the target").shape(0);
  const Eigen::MatrixXd C = a.matrix("C", rows, "the target");
  const int threads = a.threads();
  Watch watch;
  return array_of(watch.run([&] {
    return SG::target_to_source_map(
        C, source.pairs->vectors, target.pairs->vectors,
        {threads, [&](const double fraction) { return watch("point_map", fraction); }});
  }));
}

#endif // SPECTRAL_PYTHON_SPECTRA_H
