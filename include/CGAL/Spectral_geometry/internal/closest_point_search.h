// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_CLOSEST_POINT_SEARCH_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_CLOSEST_POINT_SEARCH_H

#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/closest_point_of_triangle.h>
#include <CGAL/version.h>
#if CGAL_VERSION_MAJOR >= 6
#include <CGAL/AABB_traits_3.h>
#else
#include <CGAL/AABB_traits.h>
#endif

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

using Closest_point_kernel = CGAL::Simple_cartesian<double>;

inline Closest_point_kernel::Point_3 to_point(const Eigen::Vector3d& p)
{
  return Closest_point_kernel::Point_3(p(0), p(1), p(2));
}

// A face of the surface, its index and its corners (one per column).
struct Indexed_face
{
  Indexed_face(Eigen::Index face, const Eigen::Matrix3d& points)
    : id(face)
    , corners(points)
    , triangle(to_point(points.col(0)), to_point(points.col(1)), to_point(points.col(2)))
  {}

  Eigen::Index id;
  Eigen::Matrix3d corners;
  Closest_point_kernel::Triangle_3 triangle;
};

// Model of `AABBPrimitive`: a handle on a face.
class Indexed_face_primitive
{
public:
  using Id = std::vector<Indexed_face>::const_iterator;
  using Point = Closest_point_kernel::Point_3;
  using Datum = Closest_point_kernel::Triangle_3;
  using Datum_reference = const Datum&;
  using Point_reference = const Point&;

  Indexed_face_primitive(Id face)
    : m_face(face)
  {}

  Id id() const { return m_face; }
  Datum_reference datum() const { return m_face->triangle; }
  Point_reference reference_point() const { return m_face->triangle.vertex(0); }

private:
  Id m_face;
};

#if CGAL_VERSION_MAJOR >= 6
using Face_traits_base = CGAL::AABB_traits_3<Closest_point_kernel, Indexed_face_primitive>;
#else
using Face_traits_base = CGAL::AABB_traits<Closest_point_kernel, Indexed_face_primitive>;
#endif

// CGAL's traits with the closest point above instead of the kernel's.
class Face_traits : public Face_traits_base
{
public:
  struct Closest_point
  {
    Point_3 operator()(const Point_3& query, const Indexed_face_primitive& face, const Point_3& bound) const
    {
      const Eigen::Vector3d q(query.x(), query.y(), query.z());
      const Point_of_triangle closest = closest_point_of_triangle(q, face.id()->corners);
      if(closest.squared_distance >= CGAL::squared_distance(query, bound))
        return bound;
      return to_point(face.id()->corners * closest.weights);
    }
  };

  Closest_point closest_point_object() const { return Closest_point(); }
};

/// Closest points of one surface, asked for again and again.
class Closest_point_query
{
public:
  struct Answer
  {
    Eigen::Index face;
    Eigen::Vector3d weights, point;
  };

  /// `parts`: for each vertex of the surface the number, from 0, of the part that its faces belong to; parts are searched apart,
  /// so that another one in the way does not count. Empty: all is one part.
  explicit Closest_point_query(const Mesh_matrices& surface, const std::vector<Eigen::Index>& parts = {})
    : m_places(std::size_t(surface.T.rows()))
  {
    for(Eigen::Index f = 0; f < surface.T.rows(); ++f) {
      const std::size_t part = parts.empty() ? 0 : std::size_t(parts[std::size_t(surface.T(f, 0))]);
      while(m_parts.size() <= part)
        m_parts.push_back(std::make_unique<Part>());
      Eigen::Matrix3d corners;
      for(int c = 0; c < 3; ++c)
        corners.col(c) = surface.V.row(surface.T(f, c)).transpose();
      m_places[std::size_t(f)] = {part, m_parts[part]->faces.size()};
      m_parts[part]->faces.emplace_back(f, corners);
    }
    for(auto& part : m_parts) {
      part->tree.insert(part->faces.cbegin(), part->faces.cend());
      part->tree.build();
      part->tree.accelerate_distance_queries(); // now: queries may come from several threads
    }
  }

  Answer operator()(const Eigen::Vector3d& query, const Eigen::Index part = 0) const
  {
    return answer(query,
                  m_parts[std::size_t(part)]->tree.closest_point_and_primitive(to_point(query)).second);
  }

  /// The same from the answer to a query nearby, in its part, which saves half of the search.
  Answer operator()(const Eigen::Vector3d& query, const Answer& nearby) const
  {
    const auto [part, index] = m_places[std::size_t(nearby.face)];
    const Face face = m_parts[part]->faces.cbegin() + std::ptrdiff_t(index);
    const Eigen::Vector3d weights = closest_point_of_triangle(query, face->corners).weights;
    const auto hint = std::make_pair(to_point(face->corners * weights), face);
    return answer(query, m_parts[part]->tree.closest_point_and_primitive(to_point(query), hint).second);
  }

  const Eigen::Matrix3d& corners(const Eigen::Index face) const
  {
    const auto [part, index] = m_places[std::size_t(face)];
    return m_parts[part]->faces[index].corners;
  }

private:
  using Face = std::vector<Indexed_face>::const_iterator;

  struct Part // the tree points into the faces
  {
    std::vector<Indexed_face> faces;
    CGAL::AABB_tree<Face_traits> tree;
  };

  static Answer answer(const Eigen::Vector3d& query, const Face face)
  {
    const Eigen::Vector3d weights = closest_point_of_triangle(query, face->corners).weights;
    return {face->id, weights, face->corners * weights};
  }

  std::vector<std::unique_ptr<Part>> m_parts;
  std::vector<std::pair<std::size_t, std::size_t>> m_places; // part of each face, and its index there
};

/// Interpolation at the points closest to the rows of `points`, each looked for in its part.
inline Eigen::SparseMatrix<double> interpolation(const Closest_point_query& closest,
                                                 const Mesh_matrices& surface, const Eigen::MatrixXd& points,
                                                 const std::vector<Eigen::Index>& parts = {})
{
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(std::size_t(3 * points.rows()));
  for(Eigen::Index i = 0; i < points.rows(); ++i) {
    const Closest_point_query::Answer a = closest(points.row(i), parts.empty() ? 0 : parts[std::size_t(i)]);
    for(int c = 0; c < 3; ++c)
      if(a.weights(c) != 0)
        entries.emplace_back(int(i), surface.T(a.face, c), a.weights(c));
  }
  Eigen::SparseMatrix<double> W(points.rows(), surface.V.rows());
  W.setFromTriplets(entries.begin(), entries.end());
  return W;
}

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_CLOSEST_POINT_SEARCH_H
