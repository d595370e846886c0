// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_DISTANCE_TERM_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_DISTANCE_TERM_H

#include <CGAL/Spectral_geometry/internal/numerics/for_each_task.h>
#include <CGAL/Spectral_geometry/internal/surface/Operator_geometry.h>
#include <CGAL/Spectral_geometry/internal/surface/closest_point_search.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

namespace CGAL::Spectral_geometry::internal {

/*!
Draws the coarse and the fine surface together where they lie furthest apart.

With d the distance of a sample from the other surface, the term is
\f[ \omega\, n \Big( \mathop{\mathrm{mean}}_{\text{fine}} h^2 +
\mathop{\mathrm{mean}}_{\text{coarse}} h^2 \Big), \qquad h = \max(0, d^2 / \delta^2 - 1), \f] where
n is the number of coarse vertices. Samples of the fine surface are its vertices, those of the
coarse one its vertices and the middles of its edges and faces. The threshold delta is a fraction of
the largest distance of a fine vertex at the start, or more: a quarter of that of a coarse sample,
or 1e-6 of the size. Only few samples exceed it, at tips and in folds, where movement hardly affects
the spectrum.

Between two calls of `refresh()` each sample keeps its closest face. The point in it that is closest
moves with the vertices, which to the first order does not change the distance.
*/
class Distance_term
{
public:
  using Positions = Operator_geometry::Positions;
  using Index = Eigen::Index;

  /// `on_fine` answers for the surface of `fine`; both are kept by reference. `seen`: fine vertices
  /// that the coarse surface stands for. `V`: the positions at the start; delta is
  /// `goal` times the largest distance there.
  Distance_term(const Mesh_matrices& fine, std::vector<Index> seen,
                const Closest_point_query& on_fine, const Eigen::MatrixXi& T, const Positions& V,
                const double goal, const int threads)
    : m_fine(fine)
    , m_on_fine(on_fine)
    , m_T(T)
    , m_fine_samples(std::move(seen))
    , m_coarse_samples(samples(T, V.rows()))
    , m_threads(threads)
    , m_closest_at_start(m_fine_samples.size())
    , m_closest_on_fine(m_coarse_samples.size())
  {
    const Closest_point_query on_coarse(Mesh_matrices{V, m_T});
    m_furthest =
        furthest(on_coarse, m_closest_at_start, [&](const Index i) { return fine_sample(i); });
    m_closest_on_coarse = m_closest_at_start;
    const double from_coarse = furthest(m_on_fine, m_closest_on_fine, [&](const Index i) {
      return position(m_coarse_samples[i], V);
    });
    // Fine vertices may lie in the coarse surface where that lies far from the fine one. Rounding
    // of surfaces that lie in each other is no distance.
    const double size = (V.colwise().maxCoeff() - V.colwise().minCoeff()).norm(),
                 delta = (std::max)({goal * m_furthest, from_coarse / 4, 1e-6 * size});
    m_delta2 = delta * delta;
    look(V, on_coarse);
  }

  /// Looks for samples that are far from the other surface, and for their closest faces. False if
  /// there are none, and were none.
  bool refresh(const Positions& V)
  {
    const bool any = !m_far_fine.empty() || !m_far_coarse.empty();
    look(V, Closest_point_query(Mesh_matrices{V, m_T}));
    return any || !m_far_fine.empty() || !m_far_coarse.empty();
  }

  /// The value at these positions, times `weight`; adds its gradient.
  double penalty(const Positions& V, const double weight, Positions& gradient) const
  {
    double value = 0;
    const double w = strength * weight * double(V.rows());
    // Adds h^2 to the value; returns its slope along the way between both points.
    const auto slope = [&](const double squared_distance, const double of_each) {
      const double h = (std::max)(0., squared_distance / m_delta2 - 1);
      value += of_each * h * h;
      return 4 * of_each * h / m_delta2;
    };
    for(const Index i : m_far_fine) {
      const Eigen::Vector3d point = fine_sample(i);
      const Index f = m_closest_on_coarse[i];
      Eigen::Matrix3d corners;
      for(int k = 0; k < 3; ++k)
        corners.col(k) = V.row(m_T(f, k)).transpose();
      const Point_of_triangle closest = closest_point_of_triangle(point, corners);
      const Eigen::Vector3d g = slope(closest.squared_distance, w / double(m_fine_samples.size())) *
                                (corners * closest.weights - point);
      for(int k = 0; k < 3; ++k)
        gradient.row(m_T(f, k)) += closest.weights(k) * g.transpose();
    }
    for(const Index i : m_far_coarse) {
      const Sample& sample = m_coarse_samples[i];
      const Eigen::Vector3d point = position(sample, V);
      const Eigen::Matrix3d& corners = m_on_fine.corners(m_closest_on_fine[i]);
      const Point_of_triangle closest = closest_point_of_triangle(point, corners);
      const Eigen::Vector3d g =
          slope(closest.squared_distance, w / double(m_coarse_samples.size())) *
          (point - corners * closest.weights);
      for(int k = 0; k < sample.size; ++k)
        gradient.row(sample.vertices[k]) += g.transpose() / sample.size;
    }
    return value;
  }

  /// Finds the fine vertices further from V than any was at the start, and calls `mark` for their
  /// closest faces, now and at the start. Once the latter are back, so is the distance.
  template <class Mark>
  void for_each_face_left_behind(const Positions& V, const Mark& mark) const
  {
    const Closest_point_query on_coarse(Mesh_matrices{V, m_T});
    std::vector<Index> faces(m_fine_samples.size(), -1);
    const auto look_at = [&](const Index i) {
      const Eigen::Vector3d point = fine_sample(i);
      // The face that was closest is nearly always near enough still, and the search is spared.
      const auto before =
          closest_point_of_triangle(point, on_coarse.corners(m_closest_at_start[i]));
      if(std::sqrt(before.squared_distance) <= m_furthest)
        return;
      const Closest_point_query::Answer closest = on_coarse(point);
      if((closest.point - point).norm() > m_furthest * (1 + 1e-9))
        faces[i] = closest.face;
    };
    for_each_task(Index(faces.size()), m_threads, look_at, 64);
    for(std::size_t i = 0; i < faces.size(); ++i)
      if(faces[i] >= 0) {
        mark(faces[i]);
        mark(m_closest_at_start[i]);
      }
  }

private:
  // omega. With 1 |C|_L is 1.04 times as large, the Hausdorff distance as large.
  static constexpr double strength = 0.1;

  // The mean of one, two or three vertices.
  struct Sample
  {
    int vertices[3], size;
  };

  static std::vector<Sample> samples(const Eigen::MatrixXi& T, const Index n)
  {
    std::vector<Sample> result;
    const Vertex_rings rings = Vertex_rings::of_vertices(T, n);
    for(int v = 0; v < int(n); ++v) {
      if(!rings[v].empty())
        result.push_back({{v}, 1});
      for(const int w : rings[v])
        if(v < w)
          result.push_back({{v, w}, 2});
    }
    for(Index f = 0; f < T.rows(); ++f)
      result.push_back({{T(f, 0), T(f, 1), T(f, 2)}, 3});
    return result;
  }

  static Eigen::Vector3d position(const Sample& sample, const Positions& V)
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for(int k = 0; k < sample.size; ++k)
      sum += V.row(sample.vertices[k]);
    return sum / sample.size;
  }

  Eigen::Vector3d fine_sample(const Index i) const { return m_fine.V.row(m_fine_samples[i]); }

  // The largest distance of points from a surface; sets their closest faces.
  template <class Point>
  double furthest(const Closest_point_query& surface, std::vector<Index>& closest,
                  const Point& point) const
  {
    std::vector<double> distances(closest.size());
    const auto measure = [&](const Index i) {
      const Eigen::Vector3d p = point(i);
      const Closest_point_query::Answer answer = surface(p);
      closest[i] = answer.face;
      distances[i] = (answer.point - p).norm();
    };
    for_each_task(Index(closest.size()), m_threads, measure, 64);
    return distances.empty() ? 0. : *std::max_element(distances.begin(), distances.end());
  }

  void look(const Positions& V, const Closest_point_query& on_coarse)
  {
    m_far_fine = far(Index(m_fine_samples.size()), [&](const Index i) {
      return is_far(on_coarse, fine_sample(i), m_closest_on_coarse[i]);
    });
    m_far_coarse = far(Index(m_coarse_samples.size()), [&](const Index i) {
      return is_far(m_on_fine, position(m_coarse_samples[i], V), m_closest_on_fine[i]);
    });
  }

  // Somewhat below delta, since a sample may go beyond it before the next look. `face`, where the
  // search begins, is the closest one afterwards if the sample is far.
  bool is_far(const Closest_point_query& surface, const Eigen::Vector3d& point, Index& face) const
  {
    const double bound = 0.64 * m_delta2;
    if(closest_point_of_triangle(point, surface.corners(face)).squared_distance <= bound)
      return false;
    const auto closest = surface.among(point, face, [](Index) { return true; });
    face = closest.face;
    return (closest.point - point).squaredNorm() > bound;
  }

  template <class Is_far>
  std::vector<Index> far(const Index n, const Is_far& is_far) const
  {
    std::vector<char> marks(std::size_t(n), 0);
    for_each_task(
        n, m_threads, [&](const Index i) { marks[i] = is_far(i); }, 64);
    std::vector<Index> result;
    for(Index i = 0; i < n; ++i)
      if(marks[i])
        result.push_back(i);
    return result;
  }

  const Mesh_matrices& m_fine;
  const Closest_point_query& m_on_fine;
  Eigen::MatrixXi m_T;
  std::vector<Index> m_fine_samples; // vertices
  std::vector<Sample> m_coarse_samples;
  int m_threads;
  std::vector<Index> m_closest_at_start, m_closest_on_coarse; // faces, of each fine sample
  std::vector<Index> m_closest_on_fine;                       // of each coarse sample
  double m_furthest = 0, m_delta2 = 0;
  std::vector<Index> m_far_fine, m_far_coarse;
};

} // namespace CGAL::Spectral_geometry::internal

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_RELOCATION_DISTANCE_TERM_H
