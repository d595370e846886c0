// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_PYTHON_MATCH_H
#define SPECTRAL_PYTHON_MATCH_H

#include "../programs/io/orientation.h"
#include "../programs/matching/matcher.h"
#include "arguments.h"
#include "arrays.h"
#include "meshes.h"
#include "watch.h"

#include <cstddef>
#include <cstdint>
#include <string>

// What the program shape_matching does.
inline py::dict match(const Arguments& a)
{
  SG::Mesh_matrices X = a.mesh("VX", "FX"), Y = a.mesh("VY", "FY");
  checked(X, "VX, FX");
  checked(Y, "VY, FY");
  // The start tells a shape from its mirror image by the orientation.
  for(SG::Mesh_matrices* const mesh : {&X, &Y})
    if(const auto turned = inside_out(mesh->V, mesh->T); !turned.empty()) {
      warn(std::string(mesh == &X ? "VX, FX" : "VY, FY") +
           " is inside out, its volume is negative: its faces are turned round for the match.");
      for(const Index t : turned)
        std::swap(mesh->T(t, 1), mesh->T(t, 2));
    }
  const Index n =
      a.integer("n", 4, (std::min)(X.V.rows(), Y.V.rows()), ", the vertices of the smaller mesh");
  SMS::Spectral_edge_collapse_options simplification;
  simplification.mass = a.mass();
  Matching_options options;
  options.matcher = a.word("matcher", {"product_manifold_filter", "bcicp"}) == "bcicp"
                        ? Matcher::bcicp
                        : Matcher::product_manifold_filter;
  options.modes = a.integer("k", 10, n, ", which is n");
  options.initial_modes = a.integer("initial", 4, 60);
  options.filter_iterations = int(a.integer("filter_iterations", 0, 1000));
  options.fine_iterations = int(a.integer("fine_iterations", 0, 1000));
  options.local_weight = a.number("local_weight", 0, true, 100);
  options.threads = a.threads();
  const std::string proxy = a.word("proxy", {"spectral", "garland_heckbert", "none"});
  if(options.matcher == Matcher::bcicp && proxy == "none")
    refuse(
        "matcher is 'bcicp', which refines the match of simplified meshes, and proxy is 'none'.");
  const auto operators = a.word("operators", {"fitted", "mesh"}) == "fitted"
                             ? Proxy_operators::fitted
                             : Proxy_operators::mesh;
  Landmarks landmarks;
  if(a.has("landmarks")) {
    const auto rows = a.array<std::int64_t>("landmarks", 2, "pair of vertices");
    for(py::ssize_t i = 0; i < rows.shape(0); ++i) {
      for(int side = 0; side < 2; ++side) {
        for(py::ssize_t j = 0; j < i; ++j)
          if(rows.at(i, side) == rows.at(j, side))
            refuse("landmarks[" + to_string(i) + ", " + to_string(side) + "] names vertex " +
                   to_string(rows.at(i, side)) + " again: write each once.");
        if(rows.at(i, side) < 0 || rows.at(i, side) >= (side == 0 ? X : Y).V.rows())
          refuse("landmarks[" + to_string(i) + ", " + to_string(side) + "] is " +
                 to_string(rows.at(i, side)) + ", but " + (side == 0 ? "VX" : "VY") + " has " +
                 to_string((side == 0 ? X : Y).V.rows()) + " vertices: they are counted from 0.");
      }
      landmarks.emplace_back(rows.at(i, 0), rows.at(i, 1));
    }
  }
  Watch watch(a);
  const Match match = watch.run([&] {
    const auto going = [&](const char* phase, const double fraction) {
      return Keep_going([&watch, phase, fraction] { return watch(phase, fraction); });
    };
    const auto shape = [&](const SG::Mesh_matrices& mesh) {
      return make_shape(mesh, options.modes, simplification.mass, going("eigenpairs", 0));
    };
    const auto [x, y] = side_by_side(
        options.threads, [&] { return shape(X); }, [&] { return shape(Y); });
    if(proxy == "none")
      return match_directly(x, y, landmarks, options, going("match", 0.5));
    const auto kind = proxy == "spectral" ? Proxy_kind::spectral : Proxy_kind::garland_heckbert;
    const auto coarse = [&](const Shape& fine) {
      return make_proxy(surface_mesh(fine.matrices), fine, kind, std::size_t(n), options.modes,
                        simplification, operators, going("proxies", 1. / 3));
    };
    const Shape &fine_X = x, &fine_Y = y;
    const auto [coarse_X, coarse_Y] = side_by_side(
        options.threads, [&] { return coarse(fine_X); }, [&] { return coarse(fine_Y); });
    return match_over_proxies(x, coarse_X, y, coarse_Y, landmarks, options, going("match", 2. / 3));
  });
  py::dict result;
  result["map"] = array_of(match.map);
  result["C"] = match.C;
  result["condition"] = match.condition;
  result["relative_residual"] = match.relative_residual;
  return result;
}

#endif // SPECTRAL_PYTHON_MATCH_H
