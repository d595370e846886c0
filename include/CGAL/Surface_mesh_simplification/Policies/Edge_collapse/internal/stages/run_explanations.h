// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_RUN_EXPLANATIONS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_RUN_EXPLANATIONS_H

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_options.h>

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>
#include <CGAL/Spectral_geometry/internal/surface/Triangle_element.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

#include <set>
#include <sstream>

namespace CGAL::Surface_mesh_simplification::internal {

inline Eigen::Index number_of_components(const Spectral_geometry::Mesh_matrices& mesh)
{
  const std::vector<Eigen::Index> component =
      Spectral_geometry::internal::connected_components(mesh.V.rows(), mesh.T);
  return *std::max_element(component.begin(), component.end()) + 1;
}

/// Handles of all components together, by Euler's formula.
inline Eigen::Index genus(const Spectral_geometry::Mesh_matrices& mesh)
{
  using namespace Spectral_geometry::internal;
  const auto border = boundary_edges(mesh.T);
  const std::vector<Eigen::Index> loop_of =
      connected_components(mesh.V.rows(), [&](const auto& join) {
        for(const auto& [i, j] : border)
          join(i, j);
      });
  std::set<Eigen::Index> loops;
  for(const auto& [i, j] : border)
    loops.insert(loop_of[i]);
  const Eigen::Index edges = (3 * mesh.T.rows() + Eigen::Index(border.size())) / 2;
  const Eigen::Index characteristic = mesh.V.rows() - edges + mesh.T.rows();
  return (2 * number_of_components(mesh) - characteristic - Eigen::Index(loops.size())) / 2;
}

/// Why a mesh that has run out of edges cannot be reduced further, and what helps. `wanted`: the
/// target, or 0 where nobody knows it.
inline std::string explain_exhausted_queue(const Spectral_geometry::Mesh_matrices& mesh,
                                           const Spectral_refusals& refusals,
                                           const std::size_t wanted)
{
  const Eigen::Index components = number_of_components(mesh), handles = genus(mesh);
  return sentence(
      "The mesh stopped at ", mesh.V.rows(), " vertices",
      wanted == 0 ? "" : sentence(" instead of ", wanted),
      " because every edge left was refused (topology ", refusals.topology, ", geometry ",
      refusals.geometry, ", filter ", refusals.filter, ", placement ", refusals.placement, " times",
      refusals.crossing == 0 ? ""
                             : sentence("; ", refusals.crossing,
                                        " times so that no face goes through another, as "
                                        "keep_free_of_self_intersections asks"),
      "; constrained edges are never collapsed): it has ", components,
      components == 1 ? " component, which needs at" : " components, each of which needs at",
      " least 3 (open) or 4 (closed) vertices, genus ", handles,
      handles == 0 ? "" : ", as handles need more,", " and ",
      Spectral_geometry::internal::boundary_edges(mesh.T).size(), " border edges; ",
      refusals.filter > refusals.topology && refusals.filter > refusals.crossing
          ? "ask for more vertices, or loosen the filter."
      : refusals.crossing > refusals.topology && 2 * refusals.crossing > refusals.placement
          ? "ask for more vertices, or allow self-intersections."
      : refusals.topology >= refusals.placement && (components > 1 || handles > 0)
          ? "ask for more vertices, or take small components and handles away."
      : refusals.geometry > refusals.topology && refusals.geometry > refusals.placement
          ? "ask for more vertices, or constrain and keep less; CGAL folds no faces to within a "
            "degree of each other, as at the rim of a thin body."
          : "ask for more vertices, or constrain and keep less.");
}

/// What was done, but is not advised: one sentence each.
inline void warn_of_eigenpairs(std::vector<std::string>& warnings,
                               const Spectral_geometry::Eigenpairs* const pairs)
{
  if(pairs != nullptr && !pairs->complete && pairs->residuals.size() != 0 &&
     pairs->residuals.maxCoeff() > 1e-3)
    warnings.push_back(sentence(
        "The eigenpairs of the input did not reach their tolerance, the largest residual is ",
        pairs->residuals.maxCoeff(),
        ": its triangles are of too different sizes for doubles; remesh it."));
}

/// \copydoc warn_of_eigenpairs()
inline void warn_of_target(std::vector<std::string>& warnings, const std::size_t vertices,
                           const Eigen::Index K, const Eigen::Index seen)
{
  if(Eigen::Index(vertices) < 3 * K)
    warnings.push_back(sentence(
        "The target of ", vertices, " vertices is less than 3 K = ", 3 * K,
        "; the upper part of the spectrum will not be preserved (section 4.3 of the paper)",
        seen < K ? sentence(", and the metric saw the first ", seen, " eigenvectors.") : "."));
}

/// \copydoc warn_of_eigenpairs()
inline void warn_of_error(std::vector<std::string>& warnings, const double relative_error)
{
  if(relative_error > 0.5)
    warnings.push_back(sentence("The relative error is ", relative_error,
                                ": the Laplacian of the output is off by more than half on the "
                                "signals; ask for more vertices or fewer eigenvectors, or take "
                                "small components away. Where much is kept or constrained, tiny "
                                "faces there may be the reason."));
}

/// A connected component, and what a target needs for it.
struct Component_size
{
  std::size_t vertices = 0, faces = 0;
  bool closed = true;
  double area = 0;

  /// The number below which no collapse goes: 3 vertices, or if closed as many as the handles need,
  /// 4 without handles (Heawood's bound, by Euler's formula).
  std::size_t least() const
  {
    if(!closed || faces == 0) // isolated vertices are refused elsewhere
      return faces == 0 ? 0 : 3;
    const double characteristic = double(vertices) - double(faces) / 2;
    const double bound = (7 + std::sqrt((std::max)(49 - 24 * characteristic, 1.))) / 2;
    return (std::min)(vertices, std::size_t(std::ceil(bound - 1e-9)));
  }

  /// The number of vertices that leaves a little of the shape: collapses of lattices of 1 to 81
  /// handles end at some 3.5 for each handle.
  std::size_t of_shape() const
  {
    // Negative where sheets meet at a vertex, which is refused elsewhere.
    const std::ptrdiff_t genus = closed ? (2 + std::ptrdiff_t(faces / 2 - vertices)) / 2 : 0;
    return (std::max)(least(), genus <= 0 ? 0 : std::size_t(6 + 4 * genus));
  }
};

inline std::vector<Component_size> component_sizes(const Spectral_geometry::Mesh_matrices& mesh)
{
  const std::vector<Eigen::Index> component =
      Spectral_geometry::internal::connected_components(mesh.V.rows(), mesh.T);
  std::vector<Component_size> result(
      std::size_t(*std::max_element(component.begin(), component.end()) + 1));
  const auto of = [&](const int v) -> Component_size& { return result[component[v]]; };
  for(int v = 0; v < int(mesh.V.rows()); ++v)
    ++of(v).vertices;
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f) {
    ++of(mesh.T(f, 0)).faces;
    of(mesh.T(f, 0)).area += Spectral_geometry::internal::face_normal(mesh.V, mesh.T, f).norm() / 2;
  }
  for(const auto& edge : Spectral_geometry::internal::boundary_edges(mesh.T))
    of(edge.first).closed = false;
  return result;
}

/// The smallest useful target: each component keeps a little of its shape, and as many vertices as
/// the metric sees modes of it: one for each component, the others in proportion to area. Below, a
/// large component among many small ones ends as a tetrahedron. A single component without handles
/// is as coarse as the target says.
inline std::size_t useful_target(const std::vector<Component_size>& components,
                                 const Eigen::Index K)
{
  const Eigen::Index zeros = Eigen::Index(components.size());
  std::size_t least = 0, of_shape = 0, n = 0;
  double area = 0;
  for(const Component_size& c : components) {
    least += c.least();
    of_shape += c.of_shape();
    n += c.vertices;
    area += c.area;
  }
  if(components.size() == 1 && of_shape == least)
    return least;
  std::size_t result = (std::min)(n, (std::max)(of_shape, least + (components.size() > 1)));
  for(std::size_t before = 0; before < result;) {
    before = result;
    const double more =
        weights_for_target(before, std::clamp(K, Eigen::Index(1), Eigen::Index(n)), zeros).sum() -
        double(zeros);
    std::size_t sum = 0;
    for(const Component_size& c : components) {
      const double modes =
          1 + (area > 0 && std::isfinite(area) ? (std::max)(more, 0.) * c.area / area : 0.);
      sum += (std::min)(c.vertices, (std::max)(c.of_shape(), std::size_t(modes)));
    }
    result = (std::max)(result, sum);
  }
  return result;
}

/// A share as a percentage of two digits, never less than it is.
inline std::string rounded_up(const double share)
{
  const double unit = std::pow(10., std::floor(std::log10((std::max)(100 * share, 1e-9))) - 1);
  std::ostringstream text;
  text << std::ceil(100 * share / unit - 1e-9) * unit << " %";
  return text.str();
}

/// Refuses a target that would leave nothing of the shape, with the number to ask for.
inline void check_useful_target(const Spectral_geometry::Mesh_matrices& mesh,
                                const std::size_t target, const Eigen::Index K)
{
  const std::vector<Component_size> components = component_sizes(mesh);
  const std::size_t useful = useful_target(components, K);
  if(target >= useful)
    return;
  const auto counted = [](const std::size_t n, const char* const rest) {
    return sentence(n, " component", n == 1 ? "" : "s", rest);
  };
  std::size_t least = 0, most = 0, small = 0, largest_small = 0;
  double area = 0, largest_area = 0;
  for(const Component_size& c : components) {
    least += c.least();
    most = (std::max)(most, c.vertices);
    area += c.area;
  }
  for(const Component_size& c : components)
    if(10 * c.vertices < most) {
      ++small;
      largest_small = (std::max)(largest_small, c.vertices);
      largest_area = (std::max)(largest_area, c.area);
    }
  require(false, "The target is ", target, target == 1 ? " vertex, but " : " vertices, but ",
          counted(components.size(), components.size() == 1 ? " needs" : " need"), " at least ",
          least, " vertices",
          useful == least
              ? ""
              : sentence(", and ", useful, " for something of ",
                         components.size() == 1 ? "its handles" : "their shapes", " to be left"),
          ": ask for ", useful, " or more",
          small == 0
              ? ""
              : sentence(", or leave out the ", counted(small, " of "), largest_small,
                         " vertices or fewer, none of which has more than ",
                         rounded_up(area > 0 && std::isfinite(area) ? largest_area / area : 1.),
                         " of the area"),
          ".");
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_INTERNAL_STAGES_RUN_EXPLANATIONS_H
