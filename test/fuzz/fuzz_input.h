// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_FUZZ_INPUT_H
#define SPECTRAL_TEST_FUZZ_INPUT_H

#include "../collapse_helpers.h"

#include <CGAL/Spectral_toolbox/fitted_operators.h>
#include <CGAL/Spectral_toolbox/mesh_diagnosis.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

// What a fuzzer's bytes mean: a small mesh, and options. A change here changes the meaning of every
// input on record.
namespace spectral_test {

using Polygons = std::vector<std::vector<std::size_t>>;

// Reads numbers off the bytes; zeros follow their end.
class Bytes
{
public:
  Bytes(const std::uint8_t* data, const std::size_t size)
    : m_data(data)
    , m_size(size)
  {}

  bool empty() const { return m_next >= m_size; }
  unsigned byte() { return empty() ? 0u : m_data[m_next++]; }
  int below(const int n) { return int(byte() % unsigned(n)); }
  bool one_in(const unsigned n) { return byte() % n == n - 1; }
  double unit() { return double(byte()) / 255; } // in [0, 1]

private:
  const std::uint8_t* m_data;
  std::size_t m_size, m_next = 0;
};

inline Polygons polygons_of(const Eigen::MatrixXi& T)
{
  Polygons result;
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    result.push_back({std::size_t(T(f, 0)), std::size_t(T(f, 1)), std::size_t(T(f, 2))});
  return result;
}

// Triangles between any vertices, each taken if the surface is still an oriented manifold but for
// fans that touch.
inline shapes::Matrices any_triangles(Bytes& bytes)
{
  const int n = 3 + bytes.below(10);
  shapes::Matrices mesh{Eigen::MatrixXd::Random(n, 3), Eigen::MatrixXi(0, 3)};
  for(Eigen::Index v = 0; v < n; ++v)
    mesh.V.row(v) << std::sin(12.9898 * double(v)), std::sin(78.233 * double(v)),
        std::sin(37.719 * double(v));
  for(int i = 3 * n + bytes.below(40); i > 0; --i) {
    const int a = bytes.below(n), b = bytes.below(n), c = bytes.below(n);
    mesh.T.conservativeResize(mesh.T.rows() + 1, 3);
    mesh.T.bottomRows(1) << a, b, c;
    const SG::Mesh_diagnosis d = SG::diagnose_polygon_soup(mesh.V, polygons_of(mesh.T));
    if(d.repeated_vertices.count + d.duplicate_faces.count + d.non_manifold_edges.count +
           d.misoriented_edges.count !=
       0)
      mesh.T.conservativeResize(mesh.T.rows() - 1, 3);
  }
  return mesh;
}

// Now and then a hub.
inline int high_degree(Bytes& bytes)
{
  const int limit = int(SMS::internal::Spectral_fields().largest_degree_of_others);
  return bytes.one_in(8) ? limit - 2 + bytes.below(12) : 3 + bytes.below(40);
}

inline bool is_large(const shapes::Matrices& mesh)
{
  return mesh.V.rows() > 200;
}

inline shapes::Matrices shape(Bytes& bytes)
{
  switch(bytes.below(11)) {
  case 0:
    return shapes::tetrahedron_matrices();
  case 1:
    return shapes::icosphere_matrices(bytes.below(2));
  case 2:
    return shapes::bumpy_icosphere_matrices(1 + bytes.below(2));
  case 3:
    return shapes::torus_matrices(3 + bytes.below(6), 3 + bytes.below(4));
  case 4:
    return wavy_grid_matrices(1 + bytes.below(8), 1 + bytes.below(6));
  case 5:
    return shapes::components_matrices(shapes::torus_matrices(3 + bytes.below(2), 3),
                                       1 + bytes.below(3));
  case 6:
    return shapes::grid_matrices(1 + bytes.below(6), 1 + bytes.below(6));
  case 7:
    return shapes::disc_matrices(high_degree(bytes));
  case 8:
    return shapes::gear_matrices(high_degree(bytes), 1 + bytes.below(2));
  default:
    return any_triangles(bytes);
  }
}

inline void make_holes(shapes::Matrices& mesh, Bytes& bytes)
{
  for(int holes = bytes.below(5) - 1; holes > 0 && mesh.T.rows() > 1; --holes) {
    mesh.T.row(bytes.below(int(mesh.T.rows()))) = mesh.T.bottomRows(1);
    mesh.T.conservativeResize(mesh.T.rows() - 1, 3);
  }
}

// Edges without length, short edges, flat parts, other units of length, offsets, rarely something
// that is no number.
inline void disturb(shapes::Matrices& mesh, Bytes& bytes)
{
  const int n = int(mesh.V.rows());
  for(int i = bytes.below(8) - 1; i > 0 && !bytes.empty(); --i) {
    const int f = bytes.below(int(mesh.T.rows())), v = mesh.T(f, 0), w = mesh.T(f, 1),
              x = mesh.T(f, 2);
    const double t = bytes.unit();
    switch(bytes.below(9)) {
    case 0:
      mesh.V.row(v) = mesh.V.row(w);
      break;
    case 1:
      mesh.V.row(v) =
          mesh.V.row(w) + std::pow(10., -1 - bytes.below(16)) * (mesh.V.row(v) - mesh.V.row(w));
      break;
    case 2: // a cap, more or less flat
      mesh.V.row(v) = (1 - t) * mesh.V.row(w) + t * mesh.V.row(x) +
                      std::pow(10., -1 - bytes.below(16)) * mesh.V.row(v);
      break;
    case 3:
      mesh.V.col(bytes.below(3)) *= std::pow(10., -bytes.below(12));
      break;
    case 4:
      mesh.V *= std::pow(10., bytes.below(200) - 100);
      break;
    case 5:
      mesh.V.col(bytes.below(3)).array() +=
          std::pow(10., bytes.below(14) - 5) * mesh.V.cwiseAbs().maxCoeff();
      break;
    case 6:
      mesh.V.row(v) +=
          mesh.V.cwiseAbs().maxCoeff() *
          Eigen::RowVector3d(bytes.unit() - 0.5, bytes.unit() - 0.5, bytes.unit() - 0.5);
      break;
    case 7:
      mesh.V.row(bytes.below(n)) = mesh.V.row(bytes.below(n));
      break;
    default:
      if(bytes.one_in(64))
        mesh.V(v, 0) = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

inline SMS::Spectral_edge_collapse_options options_from(Bytes& bytes, const shapes::Matrices& mesh)
{
  SMS::Spectral_edge_collapse_options options;
  const int n = int(mesh.V.rows());
  options.number_of_eigenvectors = 1 + bytes.below((std::min)(n - 1, 40));
  const SMS::Spectral_placement_strategy placements[] = {SMS::Spectral_placement_strategy::midpoint,
                                                         SMS::Spectral_placement_strategy::on_edge,
                                                         SMS::Spectral_placement_strategy::free};
  options.placement = placements[bytes.below(3)];
  options.mass = bytes.one_in(2) ? SG::Mass::averaged : SG::Mass::lumped;
  options.binary = bytes.one_in(3);
  options.preserve_border = bytes.one_in(3);
  const double shapes_of_term[] = {0, 3, 1e6};
  options.shape = shapes_of_term[bytes.below(3)];
  options.keep_free_of_self_intersections = bytes.one_in(2);
  options.threads = bytes.one_in(16) ? 2 : 1;
  const double losses[] = {10, 0.1, std::numeric_limits<double>::infinity()};
  options.largest_loss = losses[bytes.below(3)];
  // Large meshes are rarely solved, which takes most of the time.
  const unsigned basis = bytes.byte();
  if(is_large(mesh) ? basis % 8 != 0 : basis % 4 == 3) {
    options.number_of_eigenvectors =
        (std::min)(options.number_of_eigenvectors, Eigen::Index(is_large(mesh) ? 6 : 40));
    const double extent = mesh.V.cwiseAbs().maxCoeff();
    shapes::Matrices unit = mesh;
    unit.V /= extent > 0 && std::isfinite(extent) ? extent : 1.;
    options.signals = rough_signals(unit, options.number_of_eigenvectors);
  }
  const Eigen::Index mixtures[] = {16, 0, 3, 20};
  options.number_of_mixtures = mixtures[bytes.below(4)];
  options.seed = bytes.byte();
  if(bytes.one_in(4)) {
    options.weights.resize(options.number_of_eigenvectors);
    for(double& weight : options.weights)
      weight = bytes.unit();
  } else if(options.number_of_mixtures != 0 && options.signals.size() == 0 && bytes.one_in(4))
    options.source = SMS::Spectral_signal_source::filtered_noise;
  return options;
}

inline std::size_t target_from(Bytes& bytes, const shapes::Matrices& mesh)
{
  const int n = int(mesh.V.rows());
  return std::size_t(is_large(mesh) ? n - bytes.below(40) : 1 + bytes.below(n));
}

inline std::vector<std::size_t> some_vertices(Bytes& bytes, const shapes::Matrices& mesh)
{
  std::vector<std::size_t> result;
  for(int i = bytes.below(5); i > 0; --i)
    result.push_back(std::size_t(bytes.below(int(mesh.V.rows()))));
  return result;
}

// Refuses some edges by their ends, and normals that turn.
struct Random_filter
{
  unsigned every = 0; // 0: nothing is refused
  bool normals = false;

  template <class Profile, class OptionalPoint>
  OptionalPoint operator()(const Profile& profile, const OptionalPoint& point) const
  {
    if(every != 0 && (unsigned(profile.v0()) + unsigned(profile.v1())) % every == 0)
      return OptionalPoint();
    return normals ? SMS::Bounded_normal_change_filter<>()(profile, point) : point;
  }
};

inline Random_filter filter_from(Bytes& bytes)
{
  Random_filter filter;
  filter.every = bytes.one_in(3) ? 2 + unsigned(bytes.below(4)) : 0;
  filter.normals = bytes.one_in(3);
  return filter;
}

// What is done to policies, beside calling edge_collapse() with them.
struct Handling
{
  explicit Handling(Bytes& bytes)
    : filter(filter_from(bytes))
    , place(Place(bytes.below(4)))
    , runs(1 + bytes.below(3))
    , steps(bytes.byte())
    , level(bytes.byte())
  {}

  bool does(const unsigned step) const { return (steps & step) != 0; }

  enum class Place { none, behind, in_front, alone };
  // What happens to the policies: moved, copied while the original goes, others made for the same
  // mesh. To the mesh: copied and put back, garbage collected, both before each run. At the end:
  // the policies go before their handles, the mesh before all.
  enum Step : unsigned {
    move = 1,
    copy = 2,
    others = 4,
    put_back = 8,
    collect = 16,
    handles_last = 32,
    mesh_first = 64
  };

  Random_filter filter;
  Place place; // of the user's filter with regard to that of the policies
  int runs;
  unsigned steps, level;
};

struct One_call
{
  shapes::Matrices fine;
  SG::Mesh_diagnosis diagnosis;
  SMS::Spectral_edge_collapse_options options;
  std::size_t N = 0;
  Random_filter filter;
  int calls_until_cancelled = 0; // 0: never
  unsigned level = 0;            // of the replay

  bool pre_simplified() const
  {
    return options.pre_simplify != 0 && options.pre_simplify < std::size_t(fine.V.rows());
  }
  bool post_processed() const { return options.relocate; }
  bool has_zero_lengths() const { return diagnosis.zero_length_edges.count != 0; }
};

// For signals as rough as any, too.
inline SG::Operator_fit_options fit_options_from(Bytes& bytes)
{
  SG::Operator_fit_options o = SG::Operator_fit_options::for_mass(0.5 * bytes.below(2));
  o.rings = 1 + bytes.below(2);
  if(bytes.one_in(2))
    return o;
  const auto one_of = [&](const std::vector<double>& values) {
    return values[std::size_t(bytes.below(int(values.size())))];
  };
  o.low_modes = one_of({0, 1, 2.5, 6});
  o.orthonormality = one_of({0, 0.01, 1, 1e6});
  o.whole_residual = one_of({0, 0.2, 1e6});
  o.regularization = one_of({0.05, 1e-9, 1e6});
  o.smallest_weight = one_of({0.02, 1e-6, 1});
  o.smallest_mass = one_of({0.01, 1e-6, 1});
  o.tolerance = one_of({0.05, 1e-6, 0.9});
  o.maximum_iterations = int(one_of({30, 0, 3}));
  return o;
}

// Coefficients of a contrast of up to 10,000, each vertex with axes of its own.
inline SG::Operator_coefficients coefficients_from(Bytes& bytes, const Eigen::Index n)
{
  const double contrast = std::pow(10., 4 * bytes.unit()), phase = bytes.byte();
  const bool tensors = bytes.one_in(2);
  SG::Operator_coefficients result = SG::Operator_coefficients::Zero(n, 7);
  for(Eigen::Index v = 0; v < n; ++v) {
    const auto wave = [&](const double f) { return std::sin(f * double(v) + phase); };
    result(v, 0) = std::pow(contrast, 0.5 * wave(3.7));
    const double c = std::pow(contrast, 0.5 * wave(12.9898));
    for(const int i : {1, 4, 6})
      result(v, i) = c;
    if(tensors) {
      const double x = wave(1.3), y = wave(2.1), z = wave(0.7),
                   more = std::pow(contrast, 0.5 * wave(7.1));
      const double axis[6] = {x * x, x * y, x * z, y * y, y * z, z * z};
      for(int i = 0; i < 6; ++i)
        result(v, 1 + i) += more * axis[i];
    }
  }
  return result;
}

inline void add_operator(One_call& call, Bytes& bytes)
{
  SMS::Spectral_edge_collapse_options& o = call.options;
  if(bytes.one_in(3))
    o.mass = SG::Mass::voronoi;
  if(bytes.one_in(2))
    o.coefficients = coefficients_from(bytes, call.fine.V.rows());
  if(bytes.one_in(3) && o.signals.size() == 0)
    o.boundary = SG::Boundary_condition::dirichlet;
}

inline void add_one_call_options(One_call& call, Bytes& bytes)
{
  SMS::Spectral_edge_collapse_options& o = call.options;
  const int n = int(call.fine.V.rows());
  o.relocate = bytes.one_in(3);
  using Signals = SG::Relocation_options::Signals;
  const Signals signals[] = {Signals::carried, Signals::carried_and_sampled, Signals::sampled};
  o.relocation.signals = o.binary ? Signals::carried : signals[bytes.below(3)];
  o.relocation.maximum_steps = 3;
  o.relocation.smoothing = bytes.one_in(2) ? 0 : 1;
  o.relocation.fix_boundary = bytes.one_in(2);
  if(bytes.one_in(4) && !SMS::internal::is_filtered(o))
    o.maximum_error = bytes.unit();
  o.quadrics_above = 1 + 4 * bytes.unit();
  if(bytes.one_in(4) && o.signals.size() == 0) {
    o.pre_simplify = (std::min)(std::size_t(n),
                                (std::max)(std::size_t(2), call.N + std::size_t(bytes.below(n))));
    o.number_of_eigenvectors =
        (std::min)(o.number_of_eigenvectors, Eigen::Index(o.pre_simplify) - 1);
    if(o.weights.size() != 0)
      o.weights.conservativeResize(o.number_of_eigenvectors);
  }
  o.kept_vertices = some_vertices(bytes, call.fine);
  call.filter = filter_from(bytes);
  call.calls_until_cancelled = bytes.one_in(8) ? 1 + int(bytes.byte()) : 0;
  call.level = bytes.byte();
  if(bytes.one_in(3))
    add_operator(call, bytes);
}

} // namespace spectral_test

#endif // SPECTRAL_TEST_FUZZ_INPUT_H
