// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_TOOLBOX_INTRINSIC_DELAUNAY_H
#define CGAL_SPECTRAL_TOOLBOX_INTRINSIC_DELAUNAY_H

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_toolbox/internal/separate_compilation.h>
#include <CGAL/Spectral_geometry/local_operator.h>

namespace CGAL::Spectral_geometry {

/// \addtogroup PkgSpectralMeshSimplificationOperators
/// @{

/// \brief assembles the cotangent Laplacian and the mass of the intrinsic Delaunay triangulation of
/// the mesh (V, T): for meshes with needles and obtuse triangles.
///
/// The surface and the vertices stay as they are, and so does the area. Edges become geodesics of
/// the surface: an edge with two faces, laid out in the plane, is flipped within them until no two
/// opposite angles sum to more than \f$\pi\f$, \f$\cot\alpha_{ij} + \cot\beta_{ij} \ge 0\f$
/// (Bobenko and Springborn 2007, Fisher et al. 2007, Sharp and Crane 2020). Each flip lowers the
/// Dirichlet energy of every function (Rippa 1990), so \f$L_{plain} - L\f$ is positive semidefinite
/// where all faces have an area. It also lowers the sum of all cotangents, so flips end.
/// Off-diagonal entries of \f$L\f$ are at most 0 to rounding, which gives a maximum principle. The
/// exception is an obtuse angle that faces an edge which is never flipped: one on a border, with
/// more than two faces, or with two whose orientations disagree; or one beside a face that still
/// has no area. A mesh that is Delaunay has the L and B of `laplace_operator()`.
///
/// L and B are those of linear elements on the intrinsic triangles, see `laplace_operator()`; there
/// can be edges from a vertex to itself, which add nothing to L, and several between two vertices.
/// Functions are linear on the intrinsic triangles, not on the faces T: only their values at the
/// vertices belong to both. Faces of zero area contribute nothing; one with a corner between its
/// other two is gone after the flips, which connects what it had torn apart.
///
/// `Spectral_options::operator_of_eigenpairs` hands it to a simplification:
/// `options.operator_of_eigenpairs = [](const auto& V, const auto& T) { return
/// intrinsic_delaunay_laplacian(V, T, Mass::averaged); };`
///
/// \param V      n x 3 positions, in any unit of length u; B is in u^2, eigenvalues in u^-2
/// \param T      m x 3 vertex indices, counted from 0; the mesh need not be a manifold
/// \param mass   averaged (\f$\theta = 1/2\f$, default), lumped, voronoi or consistent
///
/// Time: that of sorting 3 m edges, and a constant for each flip. A face takes part in at most
/// 10000 flips, since edges wind without end around surfaces that are thinner than rounding; meshes
/// of needles take hundreds.
///
/// \throws std::invalid_argument that names the first offender: a coordinate that is not finite, an
///         index out of range, a face that uses a vertex twice, a needle whose cotangent is larger
///         than 1e12 after the flips, an isolated vertex, a vertex with only zero-area faces.
CGAL_SPECTRAL_TOOLBOX_INLINE Laplace_operator intrinsic_delaunay_laplacian(
    const Eigen::MatrixXd& V, const Eigen::MatrixXi& T, Mass mass = Mass::averaged);

/// @}

} // namespace CGAL::Spectral_geometry

#if !defined(CGAL_SPECTRAL_TOOLBOX_COMPILED) || defined(CGAL_SPECTRAL_COMPILE_TOOLBOX)

#include <CGAL/Spectral_geometry/internal/surface/Triangle_element.h>
#include <CGAL/Spectral_geometry/internal/surface/Face_element.h>

namespace CGAL::Spectral_geometry {
namespace internal {

/*!
 * Triangles glued along their sides, in their own metric: vertices have no positions. Slot 3 f + k
 * is the side of face f that lies opposite to its corner k. A vertex may be at several corners of a
 * face, and sides of a face may be glued to each other.
 *
 * A face is known by the length of its sides, the dot products at its corners and its area. The
 * last two follow from the lengths, but Heron's formula would give the height of a flat triangle to
 * half of the digits only.
 */
class Intrinsic_triangulation
{
public:
  Intrinsic_triangulation(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T)
    : m_T(T)
    , m_twin(std::size_t(3 * T.rows()), -1)
    , m_length(std::size_t(3 * T.rows()))
    , m_element(std::size_t(T.rows()))
    , m_flips(std::size_t(T.rows()), 0)
  {
    // Powers of two are exact, and squares of areas stay in the range of doubles.
    const double extent = extent_of(V);
    m_exponent = extent > 0 ? std::ilogb(extent) : 0;
    const auto scaled = [&](const double x) { return std::scalbn(x, -m_exponent); };
    for(int f = 0; f < int(T.rows()); ++f) {
      Eigen::Vector3d edge[3];
      for(int k = 0; k < 3; ++k) {
        const Eigen::RowVector3d p = V.row(T(f, (k + 1) % 3)).unaryExpr(scaled);
        edge[k] = V.row(T(f, (k + 2) % 3)).unaryExpr(scaled) - p;
        m_length[3 * f + k] = edge[k].norm();
      }
      m_element[f] = triangle_element(edge);
    }
    glue_sides();
  }

  /// Flips every edge that is not Delaunay.
  void make_delaunay()
  {
    std::vector<int> stack;
    for(int s = int(m_twin.size()) - 1; s >= 0; --s)
      if(s < twin(s))
        stack.push_back(s);
    while(!stack.empty()) {
      const int s = stack.back(), t = twin(s);
      stack.pop_back();
      if(is_delaunay(s) || !flip(s))
        continue;
      for(const int outer : {s, next(next(s)), t, next(next(t))})
        stack.push_back(outer);
    }
  }

  const Eigen::MatrixXi& triangles() const { return m_T; }

  Triangle_cotangents cotangents(const Eigen::Index f) const
  {
    return cotangents_of(m_element[f], m_exponent);
  }

private:
  static int next(const int slot) { return slot % 3 == 2 ? slot - 2 : slot + 1; }
  int twin(const int slot) const { return m_twin[slot]; }
  int& vertex(const int slot) { return m_T(slot / 3, slot % 3); }
  const Triangle_element& element(const int slot) const { return m_element[slot / 3]; }
  double dot(const int slot) const { return element(slot).dot[slot % 3]; }

  void glue(const int s, const int t)
  {
    m_twin[s] = t;
    if(t >= 0)
      m_twin[t] = s;
  }

  // Two sides of opposite direction, and no third: all others stay without a twin, as on a border.
  void glue_sides()
  {
    std::vector<std::pair<std::pair<int, int>, int>> sides; // ends and slot
    sides.reserve(m_twin.size());
    for(int s = 0; s < int(m_twin.size()); ++s)
      sides.emplace_back(std::minmax({vertex(next(s)), vertex(next(next(s)))}), s);
    std::sort(sides.begin(), sides.end());
    for(auto side = sides.begin(), end = side; side != sides.end(); side = end) {
      while(end != sides.end() && end->first == side->first)
        ++end;
      const int s = side->second, t = end[-1].second;
      if(end - side == 2 && vertex(next(s)) != vertex(next(t)))
        glue(s, t);
    }
  }

  // cot a + cot b >= 0 to rounding, multiplied by both areas. A corner without area has an angle of
  // 0 or pi.
  bool is_delaunay(const int s) const
  {
    constexpr double tolerance = 1e-10;
    const int t = twin(s);
    if(t < 0)
      return true;
    const double a = element(s).twice_area, b = element(t).twice_area;
    if(a == 0 && b == 0)
      return dot(s) >= 0 || dot(t) >= 0;
    return dot(s) * b + dot(t) * a >= -tolerance * a * b;
  }

  // What flips lower: the sum of the cotangents (the harmonic index, Bobenko and Springborn 2007),
  // before that the number of faces without area, and where both have none the length of the edge.
  // Compared as it is stored: rounding cannot lead in circles.
  static std::tuple<int, double, double> energy(const Triangle_element& f,
                                                const Triangle_element& g, const double length)
  {
    const auto cotangents = [](const Triangle_element& t) {
      return t.is_degenerate() ? 0. : (t.dot[0] + t.dot[1] + t.dot[2]) / t.twice_area;
    };
    const int degenerate = int(f.is_degenerate()) + int(g.is_degenerate());
    return {degenerate, cotangents(f) + cotangents(g), degenerate == 2 ? length : 0.};
  }

  // Turns (c, i, j) and (d, j, i) into (c, i, d) and (d, j, c), unless that lowers nothing.
  bool flip(const int s)
  {
    const int t = twin(s), s1 = next(s), s2 = next(s1), t1 = next(t), t2 = next(t1);
    int &flips_of_f = m_flips[s / 3], &flips_of_g = m_flips[t / 3];
    if(s / 3 == t / 3 || (std::max)(flips_of_f, flips_of_g) == most_flips)
      return false;
    // Laid out in the plane, ij along x (Sharp and Crane 2020, section 3). Each vector is measured
    // from its own end: a short one beside a long edge keeps its digits.
    const auto length = [&](const int slot) -> double& { return m_length[slot]; };
    const double l = length(s), c_height = element(s).twice_area / l,
                 d_height = element(t).twice_area / l;
    const Eigen::Vector3d ic(dot(s1) / l, c_height, 0), jc(-dot(s2) / l, c_height, 0);
    const Eigen::Vector3d id(dot(t2) / l, -d_height, 0), jd(-dot(t1) / l, -d_height, 0);
    const Eigen::Vector3d cd = length(s2) + length(t1) < length(s1) + length(t2)
                                   ? Eigen::Vector3d(id - ic)
                                   : Eigen::Vector3d(jd - jc);

    Eigen::Vector3d edge_of_f[3], edge_of_g[3];
    edge_of_f[s % 3] = id, edge_of_f[s1 % 3] = -cd, edge_of_f[s2 % 3] = -ic;
    edge_of_g[t % 3] = jc, edge_of_g[t1 % 3] = cd, edge_of_g[t2 % 3] = -jd;
    const Triangle_element f = triangle_element(edge_of_f), g = triangle_element(edge_of_g);
    if(!(energy(f, g, cd.norm()) < energy(element(s), element(t), l)))
      return false;
    ++flips_of_f;
    ++flips_of_g;
    m_element[s / 3] = f;
    m_element[t / 3] = g;

    // The sides ci and dj stay in their slots. The two that move may be glued to each other.
    const auto moved = [&](const int slot) { return slot == s1 ? t : slot == t1 ? s : slot; };
    const int beyond_jc = moved(twin(s1)), beyond_id = moved(twin(t1));
    glue(t, beyond_jc);
    glue(s, beyond_id);
    glue(s1, t1);
    length(t) = length(s1);
    length(s) = length(t1);
    length(s1) = length(t1) = cd.norm();
    vertex(s2) = vertex(t);
    vertex(t2) = vertex(s);
    return true;
  }

  // A face takes part in at most this many. Large meshes of needles take hundreds. Where a surface
  // is thinner than rounding, edges wind around it as often as lengths differ in magnitude, and
  // would be unwound turn by turn.
  static constexpr int most_flips = 10000;

  Eigen::MatrixXi m_T;
  std::vector<int> m_twin;                 // by slot, -1 without one
  std::vector<double> m_length;            // by slot
  std::vector<Triangle_element> m_element; // by face
  std::vector<int> m_flips;                // by face
  int m_exponent = 0;                      // of the unit of length, a power of two
};

} // namespace internal

Laplace_operator intrinsic_delaunay_laplacian(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T,
                                              const Mass mass)
{
  internal::check_positions(V);
  internal::check_triangles(T, V.rows());
  internal::Intrinsic_triangulation mesh(V, T);
  mesh.make_delaunay();
  const Eigen::MatrixXi& corners = mesh.triangles();
  const double theta = mass_blend(mass);
  std::vector<std::pair<int, double>> loops; // vertex and area of the triangle

  Laplace_operator result = internal::assemble(corners, V.rows(), theta, [&](const Eigen::Index f) {
    const Triangle_cotangents t = mesh.cotangents(f);
    internal::require(
        t.cot.cwiseAbs().maxCoeff() <= internal::largest_cotangent && std::isfinite(t.area),
        "Laplace operator: the intrinsic triangle of the vertices ", corners(f, 0), ", ",
        corners(f, 1), " and ", corners(f, 2),
        " (counted from 0) is a needle or too large, its cotangents or its area overflow the "
        "matrix; collapse its shortest edge, remesh there or rescale the mesh.");
    internal::Face_element element = internal::lumped_element(t, mass == Mass::voronoi);
    for(int k = 0; k < 3; ++k)
      if(const int v = corners(f, (k + 1) % 3); v == corners(f, (k + 2) % 3)) {
        element.t.cot(k) = 0.; // its difference of values is 0
        loops.emplace_back(v, t.area);
      }
    return element;
  });
  result.voronoi = mass == Mass::voronoi;

  // Both of a loop's entries A/12 lie on the diagonal, where assembling by upper triangles leaves
  // one of them.
  for(const auto& [v, area] : loops)
    result.B.coeffRef(v, v) += theta * area / 12.;
  return result;
}

} // namespace CGAL::Spectral_geometry

#endif // definitions

#endif // CGAL_SPECTRAL_TOOLBOX_INTRINSIC_DELAUNAY_H
