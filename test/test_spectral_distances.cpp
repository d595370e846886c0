// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include <CGAL/Spectral_toolbox/spectral_distances.h>

#include "catch.h"
#include "shapes.h"

#include <CGAL/Surface_mesh.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace test_spectral_distances {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using SG::Eigenpairs;

namespace {

Eigenpairs pairs_of(const shapes::Matrices& mesh, Index K, double theta = 0.)
{
  return SG::eigenpairs(SG::laplace_operator(mesh.V, mesh.T, theta), K);
}

// Two meshes as one.
shapes::Matrices joined(const shapes::Matrices& a, const shapes::Matrices& b)
{
  shapes::Matrices result{MatrixXd(a.V.rows() + b.V.rows(), 3),
                          Eigen::MatrixXi(a.T.rows() + b.T.rows(), 3)};
  result.V << a.V, b.V;
  result.T << a.T, b.T.array() + static_cast<int>(a.V.rows());
  return result;
}

const Eigenpairs& bumpy()
{
  static const Eigenpairs pairs = pairs_of(shapes::bumpy_icosphere_matrices(3), 60);
  return pairs;
}

constexpr Index degrees = 10; // of spherical harmonics, 100 eigenpairs

struct Sphere
{
  shapes::Matrices mesh = shapes::icosphere_matrices(4);
  Eigenpairs pairs = pairs_of(mesh, degrees* degrees, 0.5);

  double cosine(Index u, Index v) const { return mesh.V.row(u).dot(mesh.V.row(v)); }
};

const Sphere& sphere()
{
  static const Sphere unit_sphere;
  return unit_sphere;
}

// sum over l >= first of (2 l + 1) / (4 pi) f(l (l + 1)) P_l(cosine): what a function of the
// eigenvalues of the unit sphere gives, by the addition theorem
template <class Function>
double legendre_sum(double cosine, Index first, Function f)
{
  double previous = 0., legendre = 1., sum = 0.;
  for(Index l = 0; l < degrees; ++l) {
    if(l >= first)
      sum += (2. * l + 1.) / (4. * shapes::pi) * f(l * (l + 1.)) * legendre;
    const double next = ((2. * l + 1.) * cosine * legendre - l * previous) / (l + 1.);
    previous = legendre;
    legendre = next;
  }
  return sum;
}

// The largest deviation from the closed form, relative to its largest value.
template <class Exact>
double sphere_error(const VectorXd& values, Index source, Exact exact)
{
  double error = 0., largest = 0.;
  for(Index v = 0; v < values.size(); ++v) {
    const double e = exact(sphere().cosine(source, v));
    largest = std::max(largest, std::abs(e));
    error = std::max(error, std::abs(values(v) - e));
  }
  return error / largest;
}

// All eigenpairs up to a frequency of the flat torus R^2 / (a Z x b Z), at given points.
Eigenpairs flat_torus(const MatrixXd& points, double a, double b, int frequency)
{
  const auto mode = [](double x, double period, int k) { // k > 0: cosine, k < 0: sine
    const double phase = 2. * shapes::pi * k * x / period;
    return k == 0 ? 1. / std::sqrt(period)
                  : std::sqrt(2. / period) * (k > 0 ? std::cos(phase) : std::sin(phase));
  };
  std::vector<std::pair<double, std::pair<int, int>>> modes;
  for(int p = -frequency; p <= frequency; ++p)
    for(int q = -frequency; q <= frequency; ++q)
      modes.push_back(
          {std::pow(2. * shapes::pi * p / a, 2) + std::pow(2. * shapes::pi * q / b, 2), {p, q}});
  std::sort(modes.begin(), modes.end());
  Eigenpairs pairs;
  pairs.values.resize(modes.size());
  pairs.vectors.resize(points.rows(), modes.size());
  for(std::size_t k = 0; k < modes.size(); ++k) {
    pairs.values(k) = modes[k].first;
    for(Index v = 0; v < points.rows(); ++v)
      pairs.vectors(v, k) = mode(points(v, 0), a, modes[k].second.first) *
                            mode(points(v, 1), b, modes[k].second.second);
  }
  return pairs;
}

// The heat kernel of a circle as the Gaussians of all images of the source.
double circle_heat_kernel(double x, double period, double t)
{
  double sum = 0.;
  for(int image = -20; image <= 20; ++image)
    sum += std::exp(-std::pow(x + image * period, 2) / (4. * t));
  return sum / std::sqrt(4. * shapes::pi * t);
}

// The stiffness of a cycle of n vertices and unit weights, and all its eigenpairs (unit masses).
MatrixXd cycle_laplacian(Index n)
{
  MatrixXd L = MatrixXd::Zero(n, n);
  for(Index i = 0; i < n; ++i) {
    L(i, i) = 2.;
    L(i, (i + 1) % n) = L((i + 1) % n, i) = -1.;
  }
  return L;
}

Eigenpairs cycle(Index n)
{
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(cycle_laplacian(n));
  Eigenpairs pairs;
  pairs.values = solver.eigenvalues();
  pairs.vectors = solver.eigenvectors();
  pairs.zeros = 1;
  return pairs;
}

// Direct sums in extended precision, `zeros` terms skipped.
template <class Weight>
double direct_distance(const Eigenpairs& pairs, Index u, Index v, Index zeros, Weight weight)
{
  long double sum = 0;
  for(Index i = zeros; i < pairs.size(); ++i) {
    const long double d = static_cast<long double>(pairs.vectors(u, i)) - pairs.vectors(v, i);
    sum += d * d * weight(static_cast<long double>(pairs.values(i)));
  }
  return static_cast<double>(sum);
}

double direct_wks(const Eigenpairs& pairs, Index v, double t, double sigma, Index zeros)
{
  long double above = 0, below = 0;
  for(Index i = zeros; i < pairs.size(); ++i) {
    const long double x = (t - std::log(static_cast<long double>(pairs.values(i)))) / sigma;
    const long double phi = pairs.vectors(v, i);
    above += phi * phi * std::exp(-x * x / 2);
    below += std::exp(-x * x / 2);
  }
  return static_cast<double>(above / below);
}

} // namespace

TEST_CASE("heat kernel of a sphere equals the sum of Legendre polynomials")
{
  for(const double t : {0.05, 0.2, 1.})
    for(const Index source : {0, 100}) {
      const auto exact = [&](double c) {
        return legendre_sum(c, 0, [&](double l) { return std::exp(-l * t); });
      };
      CHECK(sphere_error(SG::heat_kernel(sphere().pairs, source, t), source, exact) <
            0.01); // O(h^2)
    }
}

TEST_CASE("diffusion, biharmonic and commute-time distances of a sphere equal their closed forms")
{
  const Eigenpairs& pairs = sphere().pairs;
  const auto distance = [](auto weight) {
    return [weight](double c) {
      return 2. * (legendre_sum(1., 1, weight) - legendre_sum(c, 1, weight));
    };
  };
  const double t = 0.1;
  CHECK(sphere_error(SG::squared_diffusion_distance(pairs, 7, t), 7,
                     distance([&](double l) { return std::exp(-2. * l * t); })) < 0.005);
  CHECK(sphere_error(SG::squared_biharmonic_distance(pairs, 7), 7,
                     distance([](double l) { return 1. / (l * l); })) < 0.005);
  CHECK(sphere_error(SG::squared_commute_time_distance(pairs, 7), 7,
                     distance([](double l) { return 1. / l; })) < 0.01);
}

TEST_CASE("squared biharmonic distance of antipodes of the unit sphere is pi over 12")
{
  Index antipode;
  (sphere().mesh.V * sphere().mesh.V.row(0).transpose()).minCoeff(&antipode);
  REQUIRE(sphere().cosine(0, antipode) == Approx(-1.));
  CHECK(SG::squared_biharmonic_distance(sphere().pairs, 0)(antipode) ==
        Approx(shapes::pi / 12.).epsilon(0.01));
}

TEST_CASE("heat kernel signature of a sphere is constant")
{
  const VectorXd times = SG::heat_kernel_times(sphere().pairs, 5);
  const MatrixXd hks = SG::heat_kernel_signature(sphere().pairs, times);
  for(Index i = 0; i < times.size(); ++i) {
    const double exact = legendre_sum(1., 0, [&](double l) { return std::exp(-l * times(i)); });
    CHECK((hks.col(i).array() / exact - 1.).abs().maxCoeff() < 0.01);
  }
  CHECK(SG::default_diffusion_time(sphere().pairs) == Approx(1. / 8.).epsilon(1e-3)); // 0.00995 A
}

TEST_CASE(
    "wave kernel signature of a sphere converges to a constant with the square of the edge length")
{
  double error[2], distance[2];
  const Eigenpairs coarser = pairs_of(shapes::icosphere_matrices(3), degrees * degrees, 0.5);
  for(int i = 0; i < 2; ++i) {
    const Eigenpairs& pairs = i == 0 ? coarser : sphere().pairs;
    const SG::Wave_kernel_energies energies = SG::wave_kernel_energies(pairs);
    const MatrixXd wks = SG::wave_kernel_signature(pairs);
    CHECK(wks.rows() == pairs.vectors.rows());
    CHECK(wks.cols() == 100);
    error[i] = (wks.array() * 4. * shapes::pi - 1.).abs().maxCoeff();
    distance[i] =
        SG::wave_kernel_distance(pairs, 0, energies).maxCoeff() / (energies.t_max - energies.t_min);
  }
  CHECK(error[1] < 0.035);
  CHECK(error[0] / error[1] == Approx(4.).epsilon(0.1));
  CHECK(distance[1] < 0.007);
  CHECK(distance[0] / distance[1] > 3.);
}

TEST_CASE("heat kernel of a flat torus equals the sum over images")
{
  MatrixXd points(5, 2);
  points << 0., 0., 0.3, 0.1, 0.5, 0.75, 0.9, 1.4, 0.01, 0.;
  const double a = 1., b = 1.5;
  const Eigenpairs pairs = flat_torus(points, a, b, 25);
  for(const double t : {0.004, 0.02, 0.1}) {
    const auto kernel = [&](Index u, Index v, double time) {
      return circle_heat_kernel(points(u, 0) - points(v, 0), a, time) *
             circle_heat_kernel(points(u, 1) - points(v, 1), b, time);
    };
    const MatrixXd heat = SG::heat_kernel(pairs, {0, 3}, t);
    const MatrixXd diffusion = SG::squared_diffusion_distance(pairs, {0, 3}, t);
    const MatrixXd hks = SG::heat_kernel_signature(pairs, VectorXd::Constant(1, t));
    for(Index v = 0; v < points.rows(); ++v) {
      for(Index s = 0; s < 2; ++s) {
        const Index u = s == 0 ? 0 : 3;
        CHECK(heat(v, s) == Approx(kernel(u, v, t)).epsilon(1e-9).margin(1e-9));
        CHECK(
            diffusion(v, s) ==
            Approx(2. * (kernel(v, v, 2. * t) - kernel(u, v, 2. * t))).epsilon(1e-9).margin(1e-9));
      }
      CHECK(hks(v, 0) == Approx(kernel(v, v, t)).epsilon(1e-9));
    }
  }
}

TEST_CASE(
    "all pairs of a cycle give its effective resistance and the norm of the Green's functions")
{
  const Index n = 31;
  const Eigenpairs pairs = cycle(n);
  const VectorXd resistance = SG::squared_commute_time_distance(pairs, 4);
  const VectorXd biharmonic = SG::squared_biharmonic_distance(pairs, 4);
  const Eigen::LLT<MatrixXd> green(cycle_laplacian(n) + MatrixXd::Ones(n, n));
  for(Index v = 0; v < n; ++v) {
    const double d = static_cast<double>(std::abs(v - 4));
    CHECK(resistance(v) == Approx(d * (n - d) / n).epsilon(1e-10).margin(1e-12));
    const VectorXd dipole = VectorXd::Unit(n, v) - VectorXd::Unit(n, 4);
    CHECK(biharmonic(v) == Approx(green.solve(dipole).squaredNorm()).epsilon(1e-9).margin(1e-12));
  }
}

TEST_CASE("distances equal direct sums")
{
  const Eigenpairs& pairs = bumpy();
  const std::vector<Index> sources = {0, 17, 400, 641};
  const double t = SG::default_diffusion_time(pairs);
  const MatrixXd diffusion = SG::squared_diffusion_distance(pairs, sources, t);
  const MatrixXd biharmonic = SG::squared_biharmonic_distance(pairs, sources);
  const MatrixXd commute = SG::squared_commute_time_distance(pairs, sources);
  const MatrixXd heat = SG::heat_kernel(pairs, sources, t);
  REQUIRE(diffusion.rows() == 642);
  REQUIRE(diffusion.cols() == 4);
  for(std::size_t s = 0; s < sources.size(); ++s) {
    for(Index v = 0; v < 642; v += 13) {
      const Index u = sources[s];
      const auto close = [](double x) { return Approx(x).epsilon(1e-10).margin(1e-15); };
      CHECK(diffusion(v, s) ==
            close(direct_distance(pairs, u, v, 0, [&](auto l) { return std::exp(-2 * l * t); })));
      CHECK(biharmonic(v, s) ==
            close(direct_distance(pairs, u, v, 1, [](auto l) { return 1 / (l * l); })));
      CHECK(commute(v, s) == close(direct_distance(pairs, u, v, 1, [](auto l) { return 1 / l; })));
      double kernel = 0.;
      for(Index i = 0; i < pairs.size(); ++i)
        kernel += pairs.vectors(u, i) * pairs.vectors(v, i) * std::exp(-pairs.values(i) * t);
      CHECK(heat(v, s) == Approx(kernel).epsilon(1e-10).margin(1e-13));
    }
    const Index column = static_cast<Index>(s);
    CHECK(diffusion.col(column) == SG::squared_diffusion_distance(pairs, sources[s], t));
    CHECK(biharmonic.col(column) == SG::squared_biharmonic_distance(pairs, sources[s]));
    CHECK(commute.col(column) == SG::squared_commute_time_distance(pairs, sources[s]));
    CHECK(heat.col(column).isApprox(SG::heat_kernel(pairs, sources[s], t), 1e-14));
    CHECK(diffusion(sources[s], s) == 0.);
    CHECK(biharmonic(sources[s], s) == 0.);
    CHECK(commute(sources[s], s) == 0.);
  }
  CHECK(biharmonic(sources[2], 1) == biharmonic(sources[1], 2));
}

TEST_CASE("signatures equal direct sums at the documented times and energies")
{
  const Eigenpairs& pairs = bumpy();
  const VectorXd times = SG::heat_kernel_times(pairs);
  REQUIRE(times.size() == 100);
  CHECK(times(0) * pairs.values(59) == Approx(4. * std::log(10.)));
  CHECK(times(99) * pairs.values(1) == Approx(4. * std::log(10.)));
  CHECK(times(50) / times(49) == Approx(times(1) / times(0)));
  const MatrixXd hks = SG::heat_kernel_signature(pairs);
  const SG::Wave_kernel_energies energies = SG::wave_kernel_energies(pairs);
  const double range = std::log(pairs.values(59) / pairs.values(1));
  CHECK(energies.sigma == Approx(0.07 * range));
  CHECK(energies.t_max - energies.t_min == Approx(0.72 * range));
  const MatrixXd wks = SG::wave_kernel_signature(pairs);
  for(Index v = 0; v < 642; v += 40)
    for(Index i = 0; i < 100; i += 9) {
      double sum = 0.;
      for(Index k = 0; k < 60; ++k)
        sum += pairs.vectors(v, k) * pairs.vectors(v, k) * std::exp(-pairs.values(k) * times(i));
      CHECK(hks(v, i) == Approx(sum).epsilon(1e-10));
      CHECK(wks(v, i) ==
            Approx(direct_wks(pairs, v, energies.at(i), energies.sigma, 1)).epsilon(1e-10));
    }
  CHECK((hks.col(7) - SG::heat_kernel(pairs, Index(5), times(7))).cwiseAbs()(5) < 1e-12);
}

TEST_CASE("wave kernel distance equals an integral on a finer grid")
{
  const Eigenpairs& pairs = bumpy();
  const SG::Wave_kernel_energies e = SG::wave_kernel_energies(pairs, 400);
  const std::vector<Index> sources = {3, 200};
  const MatrixXd distance = SG::wave_kernel_distance(pairs, sources, e);
  const MatrixXd coarse = SG::wave_kernel_distance(pairs, sources, SG::wave_kernel_energies(pairs));
  for(Index s = 0; s < 2; ++s) {
    for(Index v = 0; v < 642; v += 107) {
      double integral = 0.;
      const int steps = 4000;
      for(int i = 0; i < steps; ++i) { // midpoints
        const double t = e.t_min + (e.t_max - e.t_min) * (i + 0.5) / steps;
        const double a = direct_wks(pairs, sources[s], t, e.sigma, 1),
                     b = direct_wks(pairs, v, t, e.sigma, 1);
        integral += std::abs(a - b) / (a + b) * (e.t_max - e.t_min) / steps;
      }
      CHECK(distance(v, s) == Approx(integral).epsilon(1e-3));
      CHECK(coarse(v, s) == Approx(integral).epsilon(1e-2));
    }
    CHECK(distance(sources[s], s) == 0.);
    CHECK(distance.col(s).maxCoeff() <= e.t_max - e.t_min);
    CHECK(distance.col(s) == SG::wave_kernel_distance(pairs, sources[s], e));
  }
  CHECK(distance(sources[1], 0) == Approx(distance(sources[0], 1)));
}

TEST_CASE("energies far from the spectrum give the signature of the nearest eigenvalue")
{
  const Eigenpairs& pairs = bumpy();
  const MatrixXd wks = SG::wave_kernel_signature(pairs, {-1e4, 1e4, 0.01, 2});
  CHECK(wks.col(0).isApprox(pairs.vectors.col(1).cwiseAbs2(), 1e-12));
  CHECK(wks.col(1).isApprox(pairs.vectors.col(59).cwiseAbs2(), 1e-12));
}

TEST_CASE("sums with inverse eigenvalues skip one zero for each component")
{
  const shapes::Matrices mesh = shapes::components_matrices(shapes::bumpy_icosphere_matrices(2), 3);
  Eigenpairs pairs = pairs_of(mesh, 30);
  CHECK(pairs.zeros == 3);
  pairs.values.head(3) << 0., 1e-15, 1e-11; // what other solvers leave of zeros
  const VectorXd biharmonic = SG::squared_biharmonic_distance(pairs, 5);
  const VectorXd commute = SG::squared_commute_time_distance(pairs, 5);
  for(const Index v : {0, 5, 100, 170, 400}) {
    CHECK(biharmonic(v) ==
          Approx(direct_distance(pairs, 5, v, 3, [](auto l) { return 1 / (l * l); }))
              .epsilon(1e-9)
              .margin(1e-15));
    CHECK(commute(v) == Approx(direct_distance(pairs, 5, v, 3, [](auto l) { return 1 / l; }))
                            .epsilon(1e-9)
                            .margin(1e-15));
  }
  CHECK(SG::wave_kernel_signature(pairs).allFinite());
  CHECK(SG::heat_kernel_times(pairs)(99) * pairs.values(3) == Approx(4. * std::log(10.)));
  // heat stays in its component
  const VectorXd heat = SG::heat_kernel(pairs, Index(5), 1e9);
  CHECK(heat.tail(324).cwiseAbs().maxCoeff() < 1e-2 * heat(5));
  // nothing but zeros, of whatever size they are
  Eigenpairs kernel = pairs;
  kernel.values = pairs.values.head(3).eval();
  kernel.vectors = pairs.vectors.leftCols(3).eval();
  CHECK_THROWS_WITH(SG::squared_biharmonic_distance(kernel, 0),
                    ContainsSubstring("all of the 3 eigenvalues"));
}

TEST_CASE("modes of components of very different size are not taken for zeros")
{
  // Spheres of radius 1 and 1e-4 in either order: the constants of both are first, in any mixture.
  for(const double radius : {1., 1e-4}) {
    const shapes::Matrices mesh =
        joined(shapes::icosphere_matrices(3, radius), shapes::icosphere_matrices(2, 1e-4 / radius));
    Eigenpairs pairs = pairs_of(mesh, 20, 0.5);
    CHECK(pairs.zeros == 2);
    CHECK(SG::default_diffusion_time(pairs) == Approx(1. / 8.).epsilon(0.02));
    const Index large = radius == 1. ? 0 : 642;
    const VectorXd biharmonic = SG::squared_biharmonic_distance(pairs, large);
    CHECK(biharmonic.segment(large, radius == 1. ? 642 : 162).maxCoeff() ==
          Approx(shapes::pi / 12.).epsilon(0.05));
    // A basis of the kernel as other solvers may return it.
    const MatrixXd constants = pairs.vectors.leftCols(2);
    const double c = std::cos(1.), s = std::sin(1.);
    pairs.vectors.col(0) = c * constants.col(0) + s * constants.col(1);
    pairs.vectors.col(1) = c * constants.col(1) - s * constants.col(0);
    CHECK(SG::squared_biharmonic_distance(pairs, large) == biharmonic);
  }
}

TEST_CASE("small eigenvalues of a thin neck are not taken for zeros")
{
  // A strip of 400 squares that is 1e5 times longer than wide.
  const Eigenpairs pairs = pairs_of(shapes::grid_matrices(400, 1, 1., 1e-5), 5);
  CHECK(pairs.zeros == 1);
  CHECK(SG::default_diffusion_time(pairs) ==
        Approx(1. / (4. * shapes::pi * shapes::pi)).epsilon(0.01));
}

TEST_CASE("zeros of pairs that are filled by hand must be given")
{
  Eigenpairs pairs = bumpy();
  pairs.zeros = -1;
  CHECK_THROWS_WITH(SG::squared_biharmonic_distance(pairs, 0),
                    ContainsSubstring("Eigenpairs::zeros"));
  CHECK_THROWS_WITH(SG::wave_kernel_energies(pairs), ContainsSubstring("Eigenpairs::zeros"));
  CHECK_NOTHROW(SG::heat_kernel(pairs, 0, 1.));
  pairs.zeros = 1;
  pairs.values(1) = 0.;
  CHECK_THROWS_WITH(SG::default_diffusion_time(pairs),
                    ContainsSubstring("eigenvalue 1 was computed as zero"));
}

TEST_CASE("zeros are counted on the matrix")
{
  using SG::laplace_operator;
  const shapes::Matrices grid = shapes::grid_matrices(4, 3); // right angles: weights of zero
  SG::Laplace_operator op = laplace_operator(grid.V, grid.T);
  CHECK(SG::number_of_zero_eigenvalues(op) == 1);
  op.L += 0.1 * op.B;
  CHECK(SG::number_of_zero_eigenvalues(op) == 0);
  const shapes::Matrices nine = shapes::components_matrices(shapes::icosphere_matrices(1), 9);
  CHECK(SG::number_of_zero_eigenvalues(laplace_operator(nine.V, nine.T)) == 9);
  CHECK(pairs_of(nine, 7).zeros == 9);
  // two triangles, and one without area between them
  shapes::Matrices linked =
      shapes::matrices({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0, 0}, {4, 0, 0}, {3, 1, 0}},
                       {{0, 1, 2}, {3, 4, 5}, {0, 1, 3}});
  CHECK(SG::number_of_zero_eigenvalues(laplace_operator(linked.V, linked.T)) == 2);
  linked.V(3, 1) = 0.1;
  CHECK(SG::number_of_zero_eigenvalues(laplace_operator(linked.V, linked.T)) == 1);
}

TEST_CASE("results follow the unit of length as documented")
{
  const Eigenpairs& pairs = bumpy();
  const double s = 1000.;
  shapes::Matrices mesh = shapes::bumpy_icosphere_matrices(3);
  mesh.V *= s;
  const Eigenpairs scaled = pairs_of(mesh, 60);
  const auto ratio_is = [](const MatrixXd& a, const MatrixXd& b, double factor) {
    return (a - factor * b).norm() < 1e-7 * a.norm();
  };
  const double t = SG::default_diffusion_time(pairs), T = SG::default_diffusion_time(scaled);
  CHECK(T == Approx(s * s * t).epsilon(1e-7));
  CHECK(ratio_is(SG::squared_diffusion_distance(scaled, 9, T),
                 SG::squared_diffusion_distance(pairs, 9, t), 1. / (s * s)));
  CHECK(ratio_is(SG::squared_biharmonic_distance(scaled, 9),
                 SG::squared_biharmonic_distance(pairs, 9), s * s));
  CHECK(ratio_is(SG::squared_commute_time_distance(scaled, 9),
                 SG::squared_commute_time_distance(pairs, 9), 1.));
  CHECK(
      ratio_is(SG::heat_kernel_signature(scaled), SG::heat_kernel_signature(pairs), 1. / (s * s)));
  CHECK(
      ratio_is(SG::wave_kernel_signature(scaled), SG::wave_kernel_signature(pairs), 1. / (s * s)));
  CHECK(ratio_is(SG::wave_kernel_distance(scaled, 9, SG::wave_kernel_energies(scaled)),
                 SG::wave_kernel_distance(pairs, 9, SG::wave_kernel_energies(pairs)), 1.));
}

TEST_CASE("distances from points are those of interpolated eigenfunctions")
{
  const Eigenpairs& pairs = bumpy();
  const SG::Wave_kernel_energies energies = SG::wave_kernel_energies(pairs, 20);
  const double t = SG::default_diffusion_time(pairs);
  Eigen::SparseMatrix<double> W(2, 642);
  W.insert(0, 17) = 1.;
  W.insert(1, 4) = 0.25;
  W.insert(1, 9) = 0.75;
  Eigenpairs with_point = pairs; // vertex 642 is the point
  with_point.vectors.conservativeResize(643, Eigen::NoChange);
  with_point.vectors.row(642) = 0.25 * pairs.vectors.row(4) + 0.75 * pairs.vectors.row(9);
  const auto check = [&](const MatrixXd& of_points, const MatrixXd& of_vertices) {
    REQUIRE(of_points.rows() == 642);
    REQUIRE(of_points.cols() == 2);
    CHECK(of_points.isApprox(of_vertices.topRows(642), 1e-12));
    CHECK(of_points.col(1).minCoeff() > 0.); // no vertex is there
  };
  check(SG::squared_diffusion_distance(pairs, W, t),
        SG::squared_diffusion_distance(with_point, {17, 642}, t));
  check(SG::squared_biharmonic_distance(pairs, W),
        SG::squared_biharmonic_distance(with_point, {17, 642}));
  check(SG::squared_commute_time_distance(pairs, W),
        SG::squared_commute_time_distance(with_point, {17, 642}));
  check(SG::wave_kernel_distance(pairs, W, energies),
        SG::wave_kernel_distance(with_point, {17, 642}, energies));
  CHECK(SG::heat_kernel(pairs, W, t)
            .isApprox(SG::heat_kernel(with_point, {17, 642}, t).topRows(642), 1e-12));
  CHECK_THROWS_WITH(SG::squared_biharmonic_distance(with_point, W),
                    ContainsSubstring("of a mesh of 642 vertices, but there are 643"));
  // What converts to them: an expression, another order of storage, an index of CGAL's.
  const Eigen::SparseMatrix<double, Eigen::RowMajor> by_rows = W;
  const MatrixXd biharmonic = SG::squared_biharmonic_distance(pairs, W);
  CHECK(SG::squared_biharmonic_distance(pairs, by_rows).isApprox(biharmonic, 1e-14));
  CHECK(SG::squared_biharmonic_distance(pairs, W * 1.).isApprox(biharmonic, 1e-14));
  CHECK(SG::squared_biharmonic_distance(pairs, CGAL::SM_Vertex_index(17))
            .isApprox(biharmonic.col(0), 1e-12));
  for(const double w : {std::numeric_limits<double>::quiet_NaN(), 0.5}) {
    W.coeffRef(1, 9) = w;
    CHECK_THROWS_WITH(SG::heat_kernel(pairs, W, t),
                      ContainsSubstring("the weights of source 1 sum to"));
  }
}

TEST_CASE("distances and signatures reject bad input")
{
  const Eigenpairs& pairs = bumpy();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(SG::squared_biharmonic_distance(pairs, 642), ContainsSubstring("source 642"));
  CHECK_THROWS_WITH(SG::squared_diffusion_distance(pairs, {0, -1}, 1.),
                    ContainsSubstring("source -1"));
  CHECK_THROWS_WITH(SG::heat_kernel(pairs, {0, 1}, -1.), ContainsSubstring("time -1"));
  CHECK_THROWS_AS(SG::squared_diffusion_distance(pairs, 0, nan), std::invalid_argument);
  CHECK_THROWS_AS(SG::heat_kernel_signature(pairs, VectorXd::Constant(1, -1.)),
                  std::invalid_argument);
  CHECK_THROWS_AS(SG::heat_kernel_times(pairs, 0), std::invalid_argument);
  CHECK_THROWS_AS(SG::wave_kernel_signature(pairs, {0., 1., 0., 10}), std::invalid_argument);
  CHECK_THROWS_AS(SG::wave_kernel_signature(pairs, {1., 0., 1., 10}), std::invalid_argument);
  CHECK_THROWS_AS(SG::wave_kernel_signature(pairs, {0., nan, 1., 10}), std::invalid_argument);
  CHECK_THROWS_AS(SG::wave_kernel_distance(pairs, 0, {0., 1., 1., 1}), std::invalid_argument);
  Eigenpairs two = pairs;
  two.values = pairs.values.head(2).eval();
  two.vectors = pairs.vectors.leftCols(2).eval();
  CHECK_THROWS_WITH(SG::wave_kernel_energies(two), ContainsSubstring("are equal"));
  // Three equal ones, up to rounding.
  const shapes::Matrices tetrahedron = shapes::tetrahedron_matrices();
  CHECK_THROWS_WITH(SG::wave_kernel_energies(
                        SG::eigenpairs(SG::laplace_operator(tetrahedron.V, tetrahedron.T), 4)),
                    ContainsSubstring("are equal"));
}

} // namespace test_spectral_distances
