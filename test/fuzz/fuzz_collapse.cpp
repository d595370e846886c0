// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Bytes become a small mesh and options; it is simplified, and everything that must hold afterwards is checked.
//
//   fuzz_collapse RUNS SEED    random bytes
//   fuzz_collapse FILE...      the bytes of these files
//
// or, with SPECTRAL_FUZZ and clang, a target of libFuzzer.

#include "../collapse_helpers.h"
#include "../topology.h"

#include <CGAL/Spectral_geometry/mesh_diagnosis.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace spectral_test;
using Polygons = std::vector<std::vector<std::size_t>>;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;

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

Polygons polygons_of(const Eigen::MatrixXi& T)
{
  Polygons result;
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    result.push_back({std::size_t(T(f, 0)), std::size_t(T(f, 1)), std::size_t(T(f, 2))});
  return result;
}

// Triangles between any vertices, each taken if the surface is still an oriented manifold but for fans that touch.
shapes::Matrices any_triangles(Bytes& bytes)
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

shapes::Matrices shape(Bytes& bytes)
{
  switch(bytes.below(8)) {
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
    return shapes::components_matrices(shapes::torus_matrices(3 + bytes.below(2), 3), 1 + bytes.below(3));
  case 6:
    return shapes::grid_matrices(1 + bytes.below(6), 1 + bytes.below(6));
  default:
    return any_triangles(bytes);
  }
}

void make_holes(shapes::Matrices& mesh, Bytes& bytes)
{
  for(int holes = bytes.below(5) - 1; holes > 0 && mesh.T.rows() > 1; --holes) {
    mesh.T.row(bytes.below(int(mesh.T.rows()))) = mesh.T.bottomRows(1);
    mesh.T.conservativeResize(mesh.T.rows() - 1, 3);
  }
}

// Edges without length, short edges, flat parts, other units of length, offsets, rarely something that is no number.
void disturb(shapes::Matrices& mesh, Bytes& bytes)
{
  const int n = int(mesh.V.rows());
  for(int i = bytes.below(8) - 1; i > 0 && !bytes.empty(); --i) {
    const int f = bytes.below(int(mesh.T.rows())), v = mesh.T(f, 0), w = mesh.T(f, 1), x = mesh.T(f, 2);
    const double t = bytes.unit();
    switch(bytes.below(9)) {
    case 0:
      mesh.V.row(v) = mesh.V.row(w);
      break;
    case 1:
      mesh.V.row(v) = mesh.V.row(w) + std::pow(10., -1 - bytes.below(16)) * (mesh.V.row(v) - mesh.V.row(w));
      break;
    case 2: // a cap, more or less flat
      mesh.V.row(v) =
          (1 - t) * mesh.V.row(w) + t * mesh.V.row(x) + std::pow(10., -1 - bytes.below(16)) * mesh.V.row(v);
      break;
    case 3:
      mesh.V.col(bytes.below(3)) *= std::pow(10., -bytes.below(12));
      break;
    case 4:
      mesh.V *= std::pow(10., bytes.below(200) - 100);
      break;
    case 5:
      mesh.V.col(bytes.below(3)).array() += std::pow(10., bytes.below(14) - 5) * mesh.V.cwiseAbs().maxCoeff();
      break;
    case 6:
      mesh.V.row(v) += mesh.V.cwiseAbs().maxCoeff() *
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

SMS::Spectral_options options_from(Bytes& bytes, const shapes::Matrices& mesh)
{
  SMS::Spectral_options options;
  const int n = int(mesh.V.rows());
  options.number_of_eigenvectors = 1 + bytes.below((std::min)(n - 1, 40));
  const SMS::Spectral_placement_strategy placements[] = {SMS::Spectral_placement_strategy::midpoint,
                                                         SMS::Spectral_placement_strategy::on_edge,
                                                         SMS::Spectral_placement_strategy::free};
  options.placement = placements[bytes.below(3)];
  options.mass = bytes.one_in(2) ? SG::Mass::averaged : SG::Mass::lumped;
  options.binary = bytes.one_in(3);
  options.preserve_border = bytes.one_in(3);
  options.threads = bytes.one_in(16) ? 2 : 1;
  if(bytes.one_in(4)) {
    const double extent = mesh.V.cwiseAbs().maxCoeff();
    shapes::Matrices unit = mesh;
    unit.V /= extent > 0 && std::isfinite(extent) ? extent : 1.;
    options.signals = rough_signals(unit, options.number_of_eigenvectors);
  }
  return options;
}

// Every cost that CGAL's queue sees is a number.
struct Cost_probe : SMS::internal::No_visitor
{
  explicit Cost_probe(bool& good)
    : good(&good)
  {}
  template <class Profile, class Cost>
  void OnCollected(const Profile&, const Cost& cost)
  {
    *good = *good && cost && std::isfinite(*cost);
  }
  template <class Profile, class Cost>
  void OnSelected(const Profile&, const Cost& cost, std::size_t, std::size_t)
  {
    *good = *good && cost && std::isfinite(*cost);
  }
  bool* good;
};

double largest_cotangent(const shapes::Matrices& mesh)
{
  double result = 0;
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f)
    result = (std::max)(result, SG::triangle_cotangents(mesh.V.row(mesh.T(f, 0)), mesh.V.row(mesh.T(f, 1)),
                                                        mesh.V.row(mesh.T(f, 2)))
                                    .cot.cwiseAbs()
                                    .maxCoeff());
  return result;
}

// E recomputed from whole matrices, with the rounding that cotangents of that size leave in it.
std::string fault_of_E(const shapes::Matrices& coarse, const Policies& policies, const shapes::Matrices& fine,
                       const SMS::Spectral_options& options)
{
  const double worst_angle = (std::max)(largest_cotangent(coarse), largest_cotangent(fine));
  if(!std::isfinite(policies.error()) || !std::isfinite(policies.relative_error()) || policies.error() < 0)
    return "E is " + std::to_string(policies.error());
  if(worst_angle > 1e6 || !SG::diagnose_polygon_soup(coarse.V, polygons_of(coarse.T)).usable())
    return "";
  const double theta = SG::mass_blend(options.mass);
  const SG::Laplace_operator op = SG::laplace_operator(fine.V, fine.T, theta);
  const Basis basis = options.signals.size() != 0 ? signal_basis(fine, theta, options.signals)
                                                  : basis_of_pairs(op, *policies.eigenpairs());
  const SG::Laplace_operator now = SG::laplace_operator(coarse.V, coarse.T, theta);
  const Eigen::SparseMatrix<double> P = policies.restriction(), B = now.B / basis.area;
  const Eigen::MatrixXd PF = P * basis.F, PZ = P * basis.Z;
  const Eigen::VectorXd mass = now.mass / basis.area;
  const Eigen::VectorXd E = (B * PZ - now.L * PF).rowwise().squaredNorm().cwiseQuotient(mass);
  const Eigen::SparseMatrix<double> size_of_L = now.L.cwiseAbs();
  const Eigen::VectorXd rounding =
      1e-13 * (100 + worst_angle) *
      (B * PZ.cwiseAbs() + size_of_L * PF.cwiseAbs()).rowwise().norm().cwiseQuotient(mass.cwiseSqrt());
  const double tolerance =
      1e-6 * E.sum() + (2 * E.cwiseSqrt().cwiseProduct(rounding) + rounding.cwiseAbs2()).sum();
  if(!(std::abs(E.sum() - policies.error()) <= tolerance))
    return "E is off by " + std::to_string((E.sum() - policies.error()) / tolerance) + " tolerances";
  return "";
}

std::string fault_of_result(const Mesh& mesh, const Policies& policies, const shapes::Matrices& fine,
                            const SMS::Spectral_options& options)
{
  if(!CGAL::is_valid_polygon_mesh(mesh) || !CGAL::is_triangle_mesh(mesh))
    return "the mesh is not a valid triangle mesh";
  const shapes::Matrices coarse = SG::mesh_matrices(mesh);
  const Eigen::SparseMatrix<double> P = policies.restriction();
  const std::string fault = fault_of_restriction(P, policies.vertex_map(), options.binary);
  if(!fault.empty())
    return fault;
  if(!options.binary && options.placement != SMS::Spectral_placement_strategy::free &&
     !(position_error(P, fine.V, coarse.V) < 1e-11))
    return "P times the fine positions is off by " + std::to_string(position_error(P, fine.V, coarse.V));
  return fault_of_E(coarse, policies, fine, options);
}

bool refused(Mesh& mesh, const SMS::Spectral_options& options)
{
  try {
    const Policies policies(mesh, options);
    return false;
  } catch(const std::invalid_argument&) {
    return true;
  }
}

// What went wrong; empty if nothing did.
std::string fault_of_input(Bytes bytes)
{
  shapes::Matrices fine = shape(bytes);
  make_holes(fine, bytes);
  if(fine.T.rows() == 0)
    return "";
  disturb(fine, bytes);
  const SG::Mesh_diagnosis diagnosis = SG::diagnose_polygon_soup(fine.V, polygons_of(fine.T));
  if(diagnosis.non_manifold_vertices.count != 0)
    return ""; // not a mesh
  const SMS::Spectral_options options = options_from(bytes, fine);
  const std::size_t n = std::size_t(fine.V.rows()), N = 1 + std::size_t(bytes.below(int(n)));
  Mesh mesh = make_mesh(fine);
  if(!diagnosis.usable())
    return refused(mesh, options) ? "" : "accepted: " + diagnosis.obstacles().front();

  const Topology before = topology(mesh);
  Policies policies(mesh, options);
  policies.state().set_batched(!bytes.one_in(4));
  bool costs_are_numbers = true;
  collapse(mesh, policies, N, Cost_probe(costs_are_numbers));
  if(!costs_are_numbers)
    return "a cost is not a number";
  if(count_vertices(mesh) != policies.state().number_of_vertices())
    return "the vertices are miscounted";
  if(count_vertices(mesh) < N && diagnosis.zero_length_edges.count == 0)
    return "the target was missed";
  if(!(topology(mesh) == before))
    return "the topology has changed";
  return fault_of_result(mesh, policies, fine, options);
}

std::string checked(const std::uint8_t* data, const std::size_t size)
{
  try {
    return fault_of_input(Bytes(data, size));
  } catch(const std::exception& error) {
    return std::string("an exception: ") + error.what();
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, const std::size_t size)
{
  const std::string fault = checked(data, size);
  if(fault.empty())
    return 0;
  std::fprintf(stderr, "%s\n", fault.c_str());
  std::abort();
}

#ifndef SPECTRAL_LIBFUZZER

namespace {

int failures = 0;

void run(const std::vector<std::uint8_t>& bytes, const std::string& name)
{
  const std::string fault = checked(bytes.data(), bytes.size());
  if(!fault.empty()) {
    ++failures;
    std::printf("%s: %s\n", name.c_str(), fault.c_str());
  }
}

} // namespace

int main(int argc, char* argv[])
{
  char* end = nullptr;
  const unsigned long runs = argc == 3 ? std::strtoul(argv[1], &end, 10) : 0;
  if(runs > 0 && *end == '\0') {
    const unsigned long seed = std::strtoul(argv[2], nullptr, 10);
    for(unsigned long i = 0; i < runs; ++i) {
      std::mt19937 random(static_cast<std::uint32_t>(seed + i));
      std::vector<std::uint8_t> bytes(8 + random() % 150);
      for(std::uint8_t& byte : bytes)
        byte = static_cast<std::uint8_t>(random() >> 16);
      run(bytes, "1 " + std::to_string(seed + i));
    }
    std::printf("%lu runs, %d failures\n", runs, failures);
  } else {
    for(int i = 1; i < argc; ++i) {
      std::ifstream stream(argv[i], std::ios::binary);
      const std::vector<char> text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
      run(std::vector<std::uint8_t>(text.begin(), text.end()), argv[i]);
    }
    std::printf("%d files, %d failures\n", argc - 1, failures);
  }
  return failures == 0 ? 0 : 1;
}

#endif
