// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_COTANGENT_LAPLACIAN_H
#define CGAL_SPECTRAL_GEOMETRY_COTANGENT_LAPLACIAN_H

#include <CGAL/Named_function_parameters.h>
#include <CGAL/boost/graph/helpers.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/boost/graph/properties.h>
#include <CGAL/number_utils.h>

#include <CGAL/Spectral_geometry/internal/separate_compilation.h>
#include <CGAL/Spectral_geometry/internal/surface/Triangle_element.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief a triangle mesh as two matrices.
struct Mesh_matrices
{
  Eigen::MatrixXd V; ///< n x 3, positions; row i is the i-th vertex of `vertices(tm)`
  Eigen::MatrixXi T; ///< m x 3, indices into the rows of V; row f is the f-th face of `faces(tm)`
};

/// \brief stiffness and mass of a triangle mesh, \f$L \phi = \lambda B \phi\f$.
struct Laplace_operator
{
  /// n x n, symmetric, positive semidefinite, \f$L_{ij} = -(\cot\alpha_{ij} + \cot\beta_{ij})/2\f$
  /// off the diagonal, rows sum to 0. Invariant under scaling. Its kernel holds one constant for
  /// each connected component.
  Eigen::SparseMatrix<double> L;
  /// n x n, symmetric, positive definite, \f$B = (1-\theta) M_{lumped} + \theta M_{consistent}\f$,
  /// in units of area.
  Eigen::SparseMatrix<double> B;
  /// n, the row sums of B: with barycentric lumping \f$M_{ii}\f$, one third of the area of the
  /// incident faces, whatever \f$\theta\f$ is. Their sum is the area of the mesh.
  Eigen::VectorXd mass;
  /// the blend \f$\theta\f$ in [0, 1] that made B
  double theta = 0.;
  /// whether `mass` is that of mixed Voronoi areas
  bool voronoi = false;
  /// with `dirichlet`, border vertices have no couplings in L and B; `mass` does not change
  Boundary_condition boundary = Boundary_condition::neumann;
  Eigen::Index vanishing = 0; ///< number of these vertices
  /// their numbers; if they are missing, their rows are treated like the others
  std::vector<int> vanishing_vertices;
  bool has_coefficients = false; ///< whether it is that of other coefficients than 1
};

/// \brief returns how many eigenvalues of an operator are zero: one for each connected component of
/// the graph of L whose rows sum to zero, at least in single precision, so that constants are in
/// the kernel. No eigenvalue is computed.
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::Index number_of_zero_eigenvalues(const Laplace_operator& op);

/// \brief the cotangents of a triangle's three angles and its area.
struct Triangle_cotangents
{
  /// cot(k) is the cotangent of the angle at the k-th corner, opposite to the k-th edge
  Eigen::Vector3d cot;
  double area; ///< 0 for a triangle that is degenerate to rounding, and then cot is 0, too
};

/// \brief returns the cotangents (dot product over length of the cross product) and the area of a
/// triangle.
///
/// A triangle counts as degenerate when the cross product of its two shortest edges is not larger
/// than four roundings of the product of their lengths: what remains is then noise, and would
/// depend on whether the compiler contracts products into fused operations. Coordinates of any
/// magnitude are legal; a result that overflows is returned as such.
CGAL_SPECTRAL_GEOMETRY_INLINE Triangle_cotangents triangle_cotangents(const Eigen::Vector3d& p,
                                                                      const Eigen::Vector3d& q,
                                                                      const Eigen::Vector3d& r);

namespace internal {

// Beyond it the rounding of the two huge entries of a row (2e-16 times 1e12) shows in the small
// eigenvalues.
constexpr double largest_cotangent = 1e12;

// Beyond them squares of areas leave the range of doubles, in E as in the geometric tests of CGAL's
// loop.
constexpr double smallest_extent = 1e-50, largest_extent = 1e50;

/// The largest coordinate in magnitude, of those that are finite.
inline double extent_of(const Eigen::MatrixXd& V)
{
  double result = 0.;
  for(Eigen::Index v = 0; v < V.rows(); ++v)
    if(V.row(v).allFinite())
      result = (std::max)(result, V.row(v).cwiseAbs().maxCoeff());
  return result;
}

inline bool extent_is_usable(const double extent)
{
  return extent == 0. || (extent >= smallest_extent && extent <= largest_extent);
}

inline void check_positions(const Eigen::MatrixXd& V)
{
  require(V.cols() == 3, "Laplace operator: V must have 3 columns, one row per vertex, but has ",
          V.cols(), " columns.");
  for(Eigen::Index v = 0; v < V.rows(); ++v)
    require(V.row(v).allFinite(), "Laplace operator: ", vertex_name(v),
            " has a coordinate that is not a finite number; repair or remove it.");
}

inline void check_triangles(const Eigen::MatrixXi& T, const Eigen::Index n)
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

inline void check_mass(const Eigen::VectorXd& mass, const Eigen::MatrixXi& T)
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

/// Throws `std::invalid_argument` unless theta is in [0, 1], 0 with Voronoi shares, and
/// coefficients are none, or one row for each of n vertices, positive (definite) and finite.
inline void check_local_operator(const Local_operator& op, const Eigen::Index n)
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

/// Returns the positions of a mesh, one in each row, and sets `index` to the numbers of the
/// vertices as they come. So removed elements, or the lack of an internal index, do not matter.
template <class Mesh, class NamedParameters, class Index_map>
Eigen::MatrixXd numbered_positions(const Mesh& mesh, const NamedParameters& np, Index_map index)
{
  using parameters::choose_parameter;
  using parameters::get_parameter;
  const auto points = choose_parameter(get_parameter(np, internal_np::vertex_point),
                                       get_const_property_map(vertex_point, mesh));
  std::vector<double> coordinates;
  typename boost::property_traits<Index_map>::value_type n = 0;
  for(const auto v : vertices(mesh)) {
    put(index, v, n++);
    const auto& p = get(points, v);
    for(const double x : {to_double(p.x()), to_double(p.y()), to_double(p.z())})
      coordinates.push_back(x);
  }
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      coordinates.data(), static_cast<Eigen::Index>(n), 3);
}

} // namespace internal

/// \brief returns, for each face of the mesh (V, T), a third of its area: the mass that each of its
/// corners gets.
CGAL_SPECTRAL_GEOMETRY_INLINE Eigen::VectorXd barycentric_corner_masses(const Eigen::MatrixXd& V,
                                                                        const Eigen::MatrixXi& T);

/// \brief assembles the cotangent Laplacian and the mass of the mesh (V, T).
///
/// \f$L\f$ is the stiffness of linear elements (Pinkall and Polthier 1993, Meyer et al. 2003):
/// positive semidefinite,
/// \f$L_{ij} = -(\cot\alpha_{ij} + \cot\beta_{ij})/2\f$ with the angles opposite to edge ij (one
/// angle on a border),
/// \f$L_{ii} = -\sum_j L_{ij}\f$. The pointwise Laplacian, positive semidefinite as well, is
/// \f$M^{-1} L\f$. Negative weights of obtuse angles are left as they are. The boundary condition
/// is the natural one (Neumann).
/// \f$B = (1-\theta) M_{lumped} + \theta M_{consistent}\f$: \f$M_{lumped}\f$ has one third of the
/// incident area on its diagonal; \f$M_{consistent}\f$ adds A/6 on the diagonal and A/12 off it for
/// each face. Faces of zero area contribute nothing. Other masses, densities and conductivities:
/// see `Local_operator`.
///
/// \param V      n x 3 positions, in any unit of length u; B is in u^2, eigenvalues in u^-2
/// \param T      m x 3 vertex indices, counted from 0
/// \param op     a mass by name, the blend \f$\theta\f$ in [0, 1] (0 lumped, 1/2 averaged, the
/// default, 1 consistent), or an operator
///               with coefficients
///
/// \throws std::invalid_argument that names the first offender: a coordinate that is not finite, an
///         index out of range, a face that uses a vertex twice, a needle whose cotangent is larger
///         than 1e12, an isolated vertex, a vertex with only zero-area faces, a coefficient that is
///         not positive.
CGAL_SPECTRAL_GEOMETRY_INLINE Laplace_operator laplace_operator(const Eigen::MatrixXd& V,
                                                                const Eigen::MatrixXi& T,
                                                                const Local_operator& op = {});

/// \brief copies positions and faces of a triangle mesh into matrices.
///
/// \tparam TriangleMesh a model of `FaceListGraph` and `HalfedgeGraph`
/// \param tm the mesh
/// \param np an optional sequence of named parameters among the one below
///
/// \cgalNamedParamsBegin
///   \cgalParamNBegin{vertex_point_map}
///     \cgalParamDescription{the positions of the vertices, which `CGAL::to_double()` reads}
///     \cgalParamType{a model of `ReadablePropertyMap` from vertices to points}
///     \cgalParamDefault{the mesh's own map}
///   \cgalParamNEnd
/// \cgalNamedParamsEnd
///
/// \throws std::invalid_argument that names the first face that is not a triangle, or the first
///         vertex with a coordinate that is not finite; faces and vertices are counted from 0 in
///         the order of `faces(tm)` and `vertices(tm)`
template <class TriangleMesh, class NamedParameters = parameters::Default_named_parameters>
Mesh_matrices mesh_matrices(const TriangleMesh& tm,
                            const NamedParameters& np = parameters::default_values())
{
  const auto index = get(CGAL::dynamic_vertex_property_t<int>(), tm);
  Mesh_matrices result;
  result.V = internal::numbered_positions(tm, np, index);
  std::vector<int> corners;
  Eigen::Index m = 0;
  for(const auto f : faces(tm)) {
    internal::require(is_triangle(halfedge(f, tm), tm), "Mesh: ", internal::face_name(m),
                      " is not a triangle; triangulate the faces first "
                      "(CGAL::Polygon_mesh_processing::triangulate_faces).");
    for(const auto v : vertices_around_face(halfedge(f, tm), tm))
      corners.push_back(get(index, v));
    ++m;
  }

  result.T = Eigen::Map<const Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      corners.data(), m, 3);
  internal::check_positions(result.V);
  return result;
}

/// \brief assembles the cotangent Laplacian and the mass of a triangle mesh: `laplace_operator()`
/// of `mesh_matrices()`.
///
/// \tparam TriangleMesh a model of `FaceListGraph` and `HalfedgeGraph`
/// \param tm   the mesh; rows and columns follow `vertices(tm)`
/// \param mass the mass matrix
/// \param np   an optional sequence of named parameters among the one below
///
/// \cgalNamedParamsBegin
///   \cgalParamNBegin{vertex_point_map}
///     \cgalParamDescription{the positions of the vertices, which `CGAL::to_double()` reads}
///     \cgalParamType{a model of `ReadablePropertyMap` from vertices to points}
///     \cgalParamDefault{the mesh's own map}
///   \cgalParamNEnd
/// \cgalNamedParamsEnd
///
/// \throws std::invalid_argument as these two functions do
template <class TriangleMesh, class NamedParameters = parameters::Default_named_parameters>
Laplace_operator cotangent_laplacian(const TriangleMesh& tm, Mass mass = Mass::averaged,
                                     const NamedParameters& np = parameters::default_values())
{
  const Mesh_matrices mesh = mesh_matrices(tm, np);
  return laplace_operator(mesh.V, mesh.T, mass);
}

/// @}

} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_GEOMETRY_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_GEOMETRY)

#include <CGAL/Spectral_geometry/internal/surface/Face_element.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

namespace CGAL::Spectral_geometry {

Eigen::Index number_of_zero_eigenvalues(const Laplace_operator& op)
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
    const std::size_t c = std::size_t(component[v]);
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
  // exact. Its inverse is to be a double.
  const int exponent =
      extent > 0. && std::isfinite(extent) ? (std::max)(std::ilogb(extent), -1022) : 0;
  const double unit = std::scalbn(1., -exponent);
  for(Eigen::Vector3d& e : edge)
    e *= unit;

  Triangle_cotangents result = cotangents_of(triangle_element(edge, mean), exponent);
  result.area *= density(mean);
  return result;
}

inline Triangle_cotangents checked_cotangents(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                                              Eigen::Index f, const Operator_coefficients& c = {})
{
  const int k[3] = {T(f, 0), T(f, 1), T(f, 2)};
  const auto cotangents = [&](const std::optional<Point_coefficients>& mean) {
    return cotangents_of(V.row(k[0]), V.row(k[1]), V.row(k[2]), mean);
  };
  const Triangle_cotangents t = cotangents(mean_coefficients(c, k));
  const Eigen::Vector3d own = // of the triangle itself, whatever conducts
      c.rows() == 0 ? t.cot : cotangents({}).cot;
  require(own.cwiseAbs().maxCoeff() <= largest_cotangent && t.cot.allFinite() &&
              std::isfinite(t.area),
          "Laplace operator: ", face_name(f),
          " is a needle or too large, its cotangents or its area overflow the matrix; collapse its "
          "shortest "
          "edge, remesh it or rescale the mesh.");
  return t;
}

// See `Boundary_condition`.
inline void impose_dirichlet(const std::vector<char>& border, Laplace_operator& op)
{
  const auto on_border = [&](const Eigen::Index v) { return border[v] != 0; };
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

Triangle_cotangents triangle_cotangents(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                                        const Eigen::Vector3d& r)
{
  return internal::cotangents_of(p, q, r, {});
}

Eigen::VectorXd barycentric_corner_masses(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T)
{
  internal::check_positions(V);
  internal::check_triangles(T, V.rows());
  Eigen::VectorXd corner_masses(T.rows());
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    corner_masses[f] = internal::checked_cotangents(V, T, f).area / 3.;
  return corner_masses;
}

Laplace_operator laplace_operator(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
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

#endif // definitions

#endif // CGAL_SPECTRAL_GEOMETRY_COTANGENT_LAPLACIAN_H
