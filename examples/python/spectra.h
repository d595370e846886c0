// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_PYTHON_SPECTRA_H
#define SPECTRAL_PYTHON_SPECTRA_H

#include "arguments.h"
#include "meshes.h"
#include "watch.h"

#include <CGAL/Spectral_geometry/curvature_coefficients.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/fitted_operators.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_geometry/operator_coefficients.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/internal/Spectral_basis.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace SMS = CGAL::Surface_mesh_simplification;

// Operators, their eigenpairs, and how those of two meshes compare.

inline SG::Laplace_operator operator_of(const SG::Mesh_matrices& mesh, const SMS::Spectral_options& options,
                                        const char* names)
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
  options.intrinsic_delaunay = a.intrinsic_delaunay();
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

inline Fitted_pairs fitted_pairs(SG::Operator_fit_result fit, const SG::Operator_fit_options& options,
                                 const Index k, const SG::Eigenpairs_options& solver = {})
{
  Fitted_pairs result;
  result.fit = std::move(fit);
  result.op = std::make_shared<SG::Laplace_operator>(std::move(result.fit.op));
  result.pairs = std::make_shared<SG::Eigenpairs>(SG::eigenpairs(*result.op, k, solver));
  result.mass = options.mass == SG::Operator_fit_options::Mass_pattern::diagonal ? "diagonal" : "edges";
  return result;
}

inline const Pairs& pairs_of(const Arguments& a, const char* name)
{
  if(!py::isinstance<Pairs>(a[name]))
    throw py::type_error(std::string(name) + " is " + type_name(a[name]) +
                         ", it must be Eigenpairs: pass what eigenpairs() returns.");
  return a[name].cast<const Pairs&>();
}

inline void check_rows(const Pairs& pairs, const char* name, const Index n, const char* of)
{
  if(pairs.op->L.rows() != n)
    refuse(std::string(name) + " are of " + to_string(pairs.op->L.rows()) + " vertices, but " + of + " has " +
           to_string(n) + ": pass the eigenpairs of that mesh.");
}

// Eigenpairs of the mesh of n vertices in the mass, k at least.
inline const Pairs& given_pairs(const Arguments& a, const Index n, const SG::Mass mass, const Index k)
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

inline Pairs eigenpairs(const Arguments& a)
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

// How well the spectrum was kept, with tight pairs; a tenth more coarse modes tells loss from exchange at the cut.
inline SG::Spectral_evaluation evaluate(const Arguments& a)
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

inline Fitted_pairs fit_operators(const Arguments& a)
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

inline Eigen::MatrixXd weighted_coefficients(const Arguments& a)
{
  if(!a.has("density") && !a.has("conductivity"))
    refuse("density and conductivity are None: give one of them.");
  const auto values = [&](const char* name) {
    return a.has(name) ? a.array<double>(name, 0, "vertex").template cast<Eigen::VectorXd>()
                       : Eigen::VectorXd();
  };
  return SG::weighted_coefficients(values("density"), values("conductivity"));
}

inline Eigen::MatrixXd curvature_coefficients(const Arguments& a)
{
  const SG::Mesh_matrices mesh = a.mesh("V", "F");
  const double anisotropy = a.number("anisotropy", 0, true, 1e6);
  const py::gil_scoped_release no_gil;
  return SG::curvature_coefficients(mesh.V, mesh.T, anisotropy);
}

inline Eigen::MatrixXd functional_map(const Arguments& a)
{
  const Pairs fine = pairs_of(a, "eigenpairs"), coarse = pairs_of(a, "coarse_eigenpairs");
  const Eigen::SparseMatrix<double> P = a.sparse("P", coarse.op->L.rows(), fine.op->L.rows());
  const py::gil_scoped_release no_gil;
  return SG::functional_map(coarse.pairs->vectors, coarse.op->B, P, fine.pairs->vectors);
}

#endif // SPECTRAL_PYTHON_SPECTRA_H
