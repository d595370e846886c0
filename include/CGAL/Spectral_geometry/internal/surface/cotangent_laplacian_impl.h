// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_COTANGENT_LAPLACIAN_IMPL_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_COTANGENT_LAPLACIAN_IMPL_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/internal/surface/Face_element.h>
#include <CGAL/Spectral_geometry/internal/surface/Triangle_element.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Spectral_geometry/internal/require.h>

namespace CGAL::Spectral_geometry {

CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::Index number_of_zero_eigenvalues(const Laplace_operator& op)
{
  using Entry = Eigen::SparseMatrix<double>::InnerIterator;
  const double rounding = 1e-6; // of a row's sum, relative to its entries
  const std::vector<Eigen::Index> component =
      internal::connected_components(op.L.cols(), [&](const auto& join) {
        for(Eigen::Index v = 0; v < op.L.cols(); ++v)
          for(Entry entry(op.L, v); entry; ++entry)
            if(entry.row() < v && entry.value() != 0.)
              join(v, entry.row());
      });
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(op.L.cols()), sum = op.L * ones,
                        size = op.L.cwiseAbs() * ones;
  std::vector<char> kernel;
  for(Eigen::Index v = 0; v < op.L.cols(); ++v) {
    const std::size_t c = std::size_t(component[std::size_t(v)]);
    kernel.resize((std::max)(kernel.size(), c + 1), true);
    kernel[c] = kernel[c] && std::abs(sum(v)) <= rounding * size(v);
  }
  return Eigen::Index(std::count(kernel.begin(), kernel.end(), true));
}

namespace internal {

// With coefficients the area is weighted by the density.
inline Triangle_cotangents cotangents_of(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                                         const Eigen::Vector3d& r,
                                         const std::optional<Point_coefficients>& mean)
{
  Eigen::Vector3d edge[3] = {r - q, p - r, q - p};
  const double extent = (std::max)({edge[0].cwiseAbs().maxCoeff(), edge[1].cwiseAbs().maxCoeff(),
                                    edge[2].cwiseAbs().maxCoeff()});
  // Cotangents have no unit. A power of two makes products neither overflow nor underflow, and is
  // exact.
  const int exponent = extent > 0. && std::isfinite(extent) ? std::ilogb(extent) : 0;
  for(Eigen::Vector3d& e : edge)
    for(int c = 0; c < 3; ++c)
      e(c) = std::scalbn(e(c), -exponent);

  Triangle_cotangents result = cotangents_of(triangle_element(edge, mean), exponent);
  result.area *= density(mean);
  return result;
}

CGAL_SPECTRAL_GEOMETRY_INLINE Triangle_cotangents local_cotangents(const Eigen::MatrixXd& V,
                                                                   const int (&t)[3],
                                                                   const Operator_coefficients& c)
{
  return cotangents_of(V.row(t[0]), V.row(t[1]), V.row(t[2]), mean_coefficients(c, t));
}

CGAL_SPECTRAL_GEOMETRY_INLINE void check_positions(const Eigen::MatrixXd& V)
{
  require(V.cols() == 3, "Laplace operator: V must have 3 columns, one row per vertex, but has ",
          V.cols(), " columns.");
  for(Eigen::Index v = 0; v < V.rows(); ++v)
    require(V.row(v).allFinite(), "Laplace operator: ", vertex_name(v),
            " has a coordinate that is not a finite number; repair or remove it.");
}

CGAL_SPECTRAL_GEOMETRY_INLINE void check_triangles(const Eigen::MatrixXi& T, Eigen::Index n)
{
  require(T.cols() == 3 && T.rows() != 0,
          "Laplace operator: T must have 3 columns and at least one row, but is ", size_name(T),
          ".");
  for(Eigen::Index f = 0; f < T.rows(); ++f) {
    const int i = T(f, 0), j = T(f, 1), k = T(f, 2);
    require((std::min)({i, j, k}) >= 0 && (std::max)({i, j, k}) < n,
            "Laplace operator: ", face_name(f), " refers to a vertex outside 0..", n - 1,
            "; repair the indices.");
    require(i != j && j != k && k != i, "Laplace operator: ", face_name(f),
            " uses one vertex twice; remove the face.");
  }
}

CGAL_SPECTRAL_GEOMETRY_INLINE void check_local_operator(const Local_operator& op,
                                                        const Eigen::Index n)
{
  require(op.theta >= 0. && op.theta <= 1., "Local operator: theta must lie in [0, 1], but is ",
          op.theta, ".");
  require(!op.voronoi || op.theta == 0.,
          "Local operator: Voronoi shares are those of a lumped mass, but theta is ", op.theta,
          "; set one of the two to 0.");
  const Operator_coefficients& c = op.coefficients;
  require(c.rows() == 0 || c.rows() == n, "Local operator: there are coefficients for ", c.rows(),
          " vertices, but the mesh has ", n, "; give one row for each.");
  for(Eigen::Index v = 0; v < c.rows(); ++v) {
    require(c(v, 0) > 0. && std::isfinite(c(v, 0)), "Local operator: the density of ",
            vertex_name(v), " is ", c(v, 0), "; use positive numbers.");
    Eigen::Matrix3d D = conductivity(c.row(v).transpose());
    D /= D.trace(); // of any unit
    // Sylvester's criterion, each minor beside what it is a difference of.
    const double xy = D(0, 0) * D(1, 1), yz = D(1, 1) * D(2, 2);
    require(D.allFinite() && D(0, 0) > 0. && D(1, 1) > 0. && D(2, 2) > 0. &&
                xy - D(0, 1) * D(0, 1) > 1e-14 * xy && yz - D(1, 2) * D(1, 2) > 1e-14 * yz &&
                D.determinant() > 0.,
            "Local operator: the conductivity of ", vertex_name(v),
            " is not positive definite; correct it.");
  }
}

inline Triangle_cotangents checked_cotangents(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                                              Eigen::Index f, const Operator_coefficients& c = {})
{
  const int corners[3] = {T(f, 0), T(f, 1), T(f, 2)};
  const Triangle_cotangents t = local_cotangents(V, corners, c);
  const Eigen::Vector3d own = // of the triangle itself, whatever conducts
      c.rows() == 0 ? t.cot : local_cotangents(V, corners, {}).cot;
  require(own.cwiseAbs().maxCoeff() <= largest_cotangent && t.cot.allFinite() &&
              std::isfinite(t.area),
          "Laplace operator: ", face_name(f),
          " is a needle or too large, its cotangents or its area overflow the matrix; collapse its "
          "shortest "
          "edge, remesh it or rescale the mesh.");
  return t;
}

CGAL_SPECTRAL_GEOMETRY_INLINE void check_mass(const Eigen::VectorXd& mass, const Eigen::MatrixXi& T)
{
  for(Eigen::Index v = 0; v < mass.size(); ++v) {
    require(mass(v) <= 0. || std::isfinite(mass(v)), "Laplace operator: the mass of ",
            vertex_name(v), " is not a finite number; rescale the mesh.");
    require(mass(v) > 0. || (T.array() != static_cast<int>(v)).all(),
            "Laplace operator: ", vertex_name(v),
            " has no mass because all its faces have zero area; remove these faces.");
    require(mass(v) > 0., "Laplace operator: ", vertex_name(v),
            " is isolated, no face uses it; remove it.");
  }
}

// See `Boundary_condition`.
inline void impose_dirichlet(const std::vector<char>& border, Laplace_operator& op)
{
  const auto on_border = [&](const Eigen::Index v) { return border[std::size_t(v)] != 0; };
  const double unit = op.L.diagonal().cwiseAbs().mean() / std::sqrt(12.);
  const double beyond = 100 * std::acos(-1.) * double(op.L.rows()) * unit / op.mass.sum();
  for(Eigen::SparseMatrix<double>* matrix : {&op.L, &op.B})
    matrix->prune([&](const Eigen::Index i, const Eigen::Index j, double) {
      return i == j || !(on_border(i) || on_border(j));
    });
  for(Eigen::Index v = 0; v < op.L.rows(); ++v)
    if(on_border(v))
      op.L.coeffRef(v, v) = beyond * op.B.coeff(v, v);
  op.boundary = Boundary_condition::dirichlet;
  for(std::size_t v = 0; v < border.size(); ++v)
    if(border[v])
      op.vanishing_vertices.push_back(int(v));
  op.vanishing = Eigen::Index(op.vanishing_vertices.size());
}

} // namespace internal

CGAL_SPECTRAL_GEOMETRY_INLINE Triangle_cotangents triangle_cotangents(const Eigen::Vector3d& p,
                                                                      const Eigen::Vector3d& q,
                                                                      const Eigen::Vector3d& r)
{
  return internal::cotangents_of(p, q, r, {});
}

CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::MatrixXd barycentric_corner_masses(const Eigen::MatrixXd& V,
                                                                        const Eigen::MatrixXi& T)
{
  internal::check_positions(V);
  internal::check_triangles(T, V.rows());
  Eigen::MatrixXd corner_masses(T.rows(), 3);
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    corner_masses.row(f).setConstant(internal::checked_cotangents(V, T, f).area / 3.);
  return corner_masses;
}

CGAL_SPECTRAL_GEOMETRY_INLINE Laplace_operator
laplace_operator(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                 const Eigen::MatrixXd& corner_masses, double theta)
{
  internal::check_positions(V);
  internal::check_triangles(T, V.rows());
  internal::check_local_operator(theta, V.rows());
  internal::require(corner_masses.rows() == T.rows() && corner_masses.cols() == 3,
                    "Laplace operator: the corner masses must be a matrix of the size of T.");
  return internal::assemble(T, V.rows(), theta, [&](const Eigen::Index f) {
    return internal::Face_element{internal::checked_cotangents(V, T, f), corner_masses.row(f)};
  });
}

CGAL_SPECTRAL_GEOMETRY_INLINE Laplace_operator laplace_operator(const Eigen::MatrixXd& V,
                                                                const Eigen::MatrixXi& T,
                                                                const Local_operator& op)
{
  internal::check_positions(V);
  internal::check_triangles(T, V.rows());
  internal::check_local_operator(op, V.rows());
  Laplace_operator result = internal::assemble(T, V.rows(), op.theta, [&](const Eigen::Index f) {
    return internal::lumped_element(internal::checked_cotangents(V, T, f, op.coefficients),
                                    op.voronoi);
  });
  result.voronoi = op.voronoi;
  result.has_coefficients = op.coefficients.rows() != 0;
  if(op.boundary == Boundary_condition::dirichlet)
    internal::impose_dirichlet(internal::border_vertices(T, V.rows()), result);
  return result;
}

} // namespace CGAL::Spectral_geometry

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_SURFACE_COTANGENT_LAPLACIAN_IMPL_H
