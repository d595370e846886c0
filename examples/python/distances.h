// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_PYTHON_DISTANCES_H
#define SPECTRAL_PYTHON_DISTANCES_H

#include "arguments.h"
#include "spectra.h"
#include "watch.h"

#include <CGAL/Spectral_toolbox/spectral_distances.h>

#include <pybind11/stl.h>

#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

// Distances and signatures from eigenpairs.

// One source, a sequence of them, or a matrix that interpolates at points.
struct Sources
{
  std::vector<Index> vertices;
  Eigen::SparseMatrix<double, Eigen::RowMajor> points;
  bool are_points = false, one = false;

  Index size() const { return are_points ? points.rows() : Index(vertices.size()); }

  SG::Distance_sources some(const Index first, const Index count) const
  {
    if(are_points)
      return Eigen::SparseMatrix<double>(points.middleRows(first, count));
    return std::vector<Index>(vertices.begin() + first, vertices.begin() + first + count);
  }
};

inline Sources sources_of(const Arguments& a, const SG::Eigenpairs& pairs)
{
  const auto n = std::size_t(pairs.vectors.rows());
  Sources result;
  if(PyIndex_Check(a["sources"].ptr()) &&
     py::module_::import("numpy").attr("ndim")(a["sources"]).cast<int>() == 0) {
    result.vertices.push_back(a.integer("sources", 0, Index(n) - 1, ", a vertex"));
    result.one = true;
  } else if(py::module_::import("scipy.sparse").attr("issparse")(a["sources"]).cast<bool>() ||
            (py::isinstance<py::array>(a["sources"]) &&
             a["sources"].attr("ndim").cast<int>() == 2)) {
    result.points = a.sparse("sources", -1, Index(n), "sources x vertices");
    result.are_points = true;
  } else {
    const std::vector<std::size_t> sources = a.indices("sources", n, "the mesh");
    result.vertices.assign(sources.begin(), sources.end());
  }
  return result;
}

inline SG::Wave_kernel_energies energies_of(const Arguments& a, const SG::Eigenpairs& pairs)
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

inline py::object distances(const Arguments& a)
{
  const Pairs given = pairs_of(a, "eigenpairs");
  const SG::Eigenpairs& pairs = *given.pairs;
  const Sources sources = sources_of(a, pairs);
  const std::string kind =
      a.word("kind", {"diffusion", "biharmonic", "commute_time", "wave_kernel"});
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
  const auto from = [&](const SG::Distance_sources& some) -> Eigen::MatrixXd {
    return kind == "diffusion"      ? SG::squared_diffusion_distance(pairs, some, time)
           : kind == "biharmonic"   ? SG::squared_biharmonic_distance(pairs, some)
           : kind == "commute_time" ? SG::squared_commute_time_distance(pairs, some)
                                    : SG::wave_kernel_distance(pairs, some, energies);
  };
  Eigen::MatrixXd result = interruptible([&] {
    constexpr Index step = 64; // sources between two questions for signals
    Eigen::MatrixXd distances(pairs.vectors.rows(), sources.size());
    for(Index first = 0; first < sources.size(); first += step) {
      const Index count = (std::min)(step, sources.size() - first);
      distances.middleCols(first, count) = from(sources.some(first, count));
      check_signals();
    }
    return distances;
  });
  return sources.one ? py::cast(Eigen::VectorXd(result.col(0))) : py::cast(std::move(result));
}

inline Eigen::MatrixXd heat_kernel_signature(const Arguments& a)
{
  const Pairs given = pairs_of(a, "eigenpairs");
  const Eigen::VectorXd times = a.has("times")
                                    ? a.array<double>("times", 0, "time").cast<Eigen::VectorXd>()
                                    : SG::heat_kernel_times(*given.pairs);
  return interruptible([&] {
    constexpr Index step = 8; // times between two questions for signals
    Eigen::MatrixXd result(given.pairs->vectors.rows(), times.size());
    for(Index first = 0; first < times.size(); first += step) {
      const Index count = (std::min)(step, times.size() - first);
      result.middleCols(first, count) =
          SG::heat_kernel_signature(*given.pairs, times.segment(first, count));
      check_signals();
    }
    return result;
  });
}

inline Eigen::MatrixXd wave_kernel_signature(const Arguments& a)
{
  const Pairs given = pairs_of(a, "eigenpairs");
  const SG::Wave_kernel_energies energies = energies_of(a, *given.pairs);
  const py::gil_scoped_release no_gil;
  return SG::wave_kernel_signature(*given.pairs, energies);
}

inline py::tuple wave_kernel_energies(const Arguments& a)
{
  const SG::Wave_kernel_energies e =
      SG::wave_kernel_energies(*pairs_of(a, "eigenpairs").pairs, a.integer("steps", 1, 1000000));
  return py::make_tuple(e.t_min, e.t_max, e.sigma, e.steps);
}

#endif // SPECTRAL_PYTHON_DISTANCES_H
