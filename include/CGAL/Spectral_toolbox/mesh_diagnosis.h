// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_MESH_DIAGNOSIS_H
#define CGAL_SPECTRAL_TOOLBOX_MESH_DIAGNOSIS_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_toolbox/internal/separate_compilation.h>

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief how often something was found in a mesh, and where first.
struct Mesh_finding
{
  std::size_t count = 0; ///< how often
  std::size_t first = 0; ///< the first vertex or face concerned, counted from 0
  std::size_t second =
      0; ///< what belongs to it: the other face or vertex, or the number of corners or parts

  /// \brief counts one more.
  void add(const std::size_t where, const std::size_t partner = 0)
  {
    if(count++ == 0) {
      first = where;
      second = partner;
    }
  }
};

/// \brief a connected component: vertices that faces join.
struct Mesh_component
{
  std::size_t vertices = 0; ///< how many it has
  std::size_t faces = 0;    ///< how many it has
  bool closed = true;       ///< no edge of it has one face only
  std::size_t first = 0;    ///< its first vertex
  double area = 0;          ///< of its faces that are sound and finite
  /// what no collapse of a triangle mesh goes below: 3 vertices, and if closed as many as its
  /// handles need, 4 without any (Heawood's bound, by Euler's formula)
  CGAL_SPECTRAL_TOOLBOX_INLINE std::size_t least_vertices() const;
  /// with how many vertices a little of the shape is left: 3 for each handle of a closed component
  /// beside 4, where collapses of a lattice of 81 handles end a little earlier
  CGAL_SPECTRAL_TOOLBOX_INLINE std::size_t vertices_of_shape() const;
};

/// \brief what `diagnose_polygon_soup()` and `diagnose_mesh()` found, counted, with the first
/// offender of each kind.
struct Mesh_diagnosis
{
  std::size_t number_of_vertices = 0; ///< isolated ones included
  std::size_t number_of_faces = 0;    ///< sound or not

  double extent = 0; ///< the largest coordinate in magnitude; to be usable between 1e-50 and 1e50

  /// \name Obstacles: the Laplace operator or a halfedge structure is impossible with any of them
  /// @{
  Mesh_finding non_finite_vertices; ///< vertices with a coordinate that is infinite or not a number
  Mesh_finding foreign_indices;     ///< faces that use a vertex that does not exist
  Mesh_finding repeated_vertices;   ///< faces that use a vertex twice, or have fewer than three
  Mesh_finding
      polygons; ///< faces with more than three vertices; `second` is how many the first has
  Mesh_finding duplicate_faces; ///< faces with the vertices of an earlier one, which `second` is
                                ///< for the first
  Mesh_finding
      non_manifold_edges; ///< edges of more than two faces; from vertex `first` to vertex `second`
  Mesh_finding
      misoriented_edges; ///< edges along which their two faces, `first` and `second`, run alike
  Mesh_finding non_manifold_vertices; ///< vertices where parts of the surface touch in nothing but
                                      ///< the vertex
  Mesh_finding isolated_vertices;     ///< vertices that no face uses
  Mesh_finding massless_vertices;     ///< vertices all of whose faces have zero area
  Mesh_finding overflowing_faces; ///< needles with a cotangent above 1e12, or areas that overflow
  /// @}

  /// \name What is handled
  /// @{
  Mesh_finding
      zero_length_edges; ///< from vertex `first` to `second`; merged before the first collapse
  Mesh_finding
      zero_area_faces; ///< degenerate to rounding, zero-length edges included; contribute nothing
  Mesh_finding coincident_vertices; ///< vertices at the position of another, `second`, that they
                                    ///< share no edge with
  /// @}

  /// of a mesh of triangles pairs of border vertices that lie together within 1e-5 of the box's
  /// diagonal and 0.49 of every edge at them, and share no edge: each with the first such vertex
  /// before it that is not itself the first of a pair. The surface is cut there, or its coordinates
  /// were rounded.
  std::vector<std::pair<std::size_t, std::size_t>> cracks;

  std::vector<Mesh_component>
      components; ///< in the order of their first vertices; isolated vertices are none

  /// \brief whether the mesh can be simplified as it is.
  bool usable() const { return number_of_faces != 0 && obstacles().empty(); }

  /// \brief whether `extent` is not usable: another unit of length helps then, no repair.
  bool out_of_scale() const { return !internal::extent_is_usable(extent); }

  /// \brief one clause for each kind of obstacle, without a full stop: how many, where first, what
  /// helps. The most elementary comes first; what follows may be its consequence.
  std::vector<std::string> obstacles() const;

  /// \brief one clause for each thing that is unusual but handled, without a full stop.
  std::vector<std::string> remarks() const;

  /// \brief what to expect of `K` eigenvectors and a target of `N` vertices on this mesh: one
  /// sentence for each reason for which less is preserved than was asked for, or something else
  /// than was meant.
  std::vector<std::string> warnings(std::size_t K, std::size_t N) const;

  /// \brief the least target that is of use for `K` eigenvectors: each component has
  /// `Mesh_component::vertices_of_shape()`, and as many vertices as it has modes, which go by area
  /// beside one for each. Among many small components a large one ends as a tetrahedron below.
  CGAL_SPECTRAL_TOOLBOX_INLINE std::size_t useful_vertices(std::size_t K) const;

  /// \brief why a target of `N` vertices would leave nothing of the shape, and what to do: a
  /// clause; or nothing. With several components or handles that is so below `useful_vertices()`.
  CGAL_SPECTRAL_TOOLBOX_INLINE std::string too_small(std::size_t N, std::size_t K) const;

  /// \brief a lower bound of the number of vertices that collapses lead to, summed over the
  /// components
  std::size_t least_vertices() const
  {
    std::size_t sum = 0;
    for(const Mesh_component& c : components)
      sum += c.least_vertices();
    return sum;
  }
};

/// \brief examines points and faces that need not form a mesh, as they were read from a file.
///
/// \param V         n x 3 positions
/// \param polygons  for each face the indices of its vertices, counted from 0
///
/// Takes \f$O(m \log m)\f$ for m faces and changes nothing.
CGAL_SPECTRAL_TOOLBOX_INLINE Mesh_diagnosis diagnose_polygon_soup(
    const Eigen::MatrixXd& V, const std::vector<std::vector<std::size_t>>& polygons);

/// \brief examines a mesh, which may have faces of any number of vertices; vertices and faces are
/// counted from 0 in the order of `vertices(pm)` and `faces(pm)`.
///
/// \tparam PolygonMesh a model of `FaceListGraph` and `HalfedgeGraph`
/// \param pm the mesh
/// \param np named parameters: `vertex_point_map` (default: the internal one); coordinates go
/// through `CGAL::to_double`
template <class PolygonMesh, class NamedParameters = parameters::Default_named_parameters>
Mesh_diagnosis diagnose_mesh(const PolygonMesh& pm,
                             const NamedParameters& np = parameters::default_values())
{
  const auto index = get(CGAL::dynamic_vertex_property_t<std::size_t>(), pm);
  const Eigen::MatrixXd V = internal::numbered_positions(pm, np, index);
  std::vector<std::vector<std::size_t>> polygons;
  for(const auto f : faces(pm)) {
    polygons.emplace_back();
    for(const auto v : vertices_around_face(halfedge(f, pm), pm))
      polygons.back().push_back(get(index, v));
  }
  return diagnose_polygon_soup(V, polygons);
}

/// @}

} // namespace CGAL::Spectral_geometry

#ifndef CGAL_SPECTRAL_TOOLBOX_COMPILED
#include <CGAL/Spectral_toolbox/internal/mesh_diagnosis_impl.h>
#endif

#endif // CGAL_SPECTRAL_TOOLBOX_MESH_DIAGNOSIS_H
