// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The shape term of the cost, the guard against crossings, and the presets that switch them on.

#include "catch.h"
#include "collapse_helpers.h"
#include "core_helpers.h"

#include <CGAL/Spectral_geometry/closest_point_interpolation.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_geometry/internal/surface/Surface_regions.h>
#include <CGAL/Spectral_geometry/internal/surface/closest_point_search.h>
#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_probabilistic_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

namespace test_shape_term {

using namespace spectral_test;
using SMS::Spectral_edge_collapse_options;
using SMS::Spectral_options;
using SMS::Spectral_placement_strategy;

namespace {

constexpr double variance = 0.0225; // of a normal, see Spectral_shape_term

// A plane of the input beside a vertex of it.
struct Plane
{
  Eigen::Vector3d normal, point;
  double weight;
};

using Planes = std::vector<Plane>;

std::vector<Planes> planes_of(const shapes::Matrices& mesh)
{
  std::vector<Planes> result(std::size_t(mesh.V.rows()));
  std::map<std::pair<int, int>, int> faces;
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f)
    for(int k = 0; k < 3; ++k)
      ++faces[std::minmax(mesh.T(f, k), mesh.T(f, (k + 1) % 3))];
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f) {
    const Eigen::Vector3d p[3] = {mesh.V.row(mesh.T(f, 0)), mesh.V.row(mesh.T(f, 1)),
                                  mesh.V.row(mesh.T(f, 2))};
    const Eigen::Vector3d cross = (p[1] - p[0]).cross(p[2] - p[0]);
    for(int k = 0; k < 3; ++k) {
      const int v = mesh.T(f, k), w = mesh.T(f, (k + 1) % 3);
      result[std::size_t(v)].push_back({cross.normalized(), p[k], cross.norm() / 2});
      if(faces.at(std::minmax(v, w)) != 1)
        continue;
      const Eigen::Vector3d edge = p[(k + 1) % 3] - p[k], normal = cross.cross(edge).normalized();
      result[std::size_t(v)].push_back({normal, p[k], 10 * edge.squaredNorm()});
      result[std::size_t(w)].push_back({normal, p[(k + 1) % 3], 10 * edge.squaredNorm()});
    }
  }
  return result;
}

double quadric(const Planes& planes, const Eigen::Vector3d& x)
{
  double sum = 0;
  for(const Plane& plane : planes) {
    const Eigen::Vector3d d = x - plane.point;
    sum += plane.weight * (std::pow(plane.normal.dot(d), 2) + variance * d.squaredNorm());
  }
  return sum;
}

double vertex_mass(const Slow_mesh& mesh, const int v, const double area)
{
  double sum = 0;
  for(const Eigen::Vector3i& t : mesh.triangles)
    if(Slow_mesh::contains(t, v)) {
      const Eigen::Vector3d a = mesh.V.row(t(0)), b = mesh.V.row(t(1)), c = mesh.V.row(t(2));
      sum += (b - a).cross(c - a).norm() / 6;
    }
  return sum / area;
}

// The largest distance of a fine vertex from the coarse mesh.
double furthest(const shapes::Matrices& fine, const shapes::Matrices& coarse)
{
  const SG::internal::Closest_point_query closest(coarse);
  double result = 0;
  for(Eigen::Index v = 0; v < fine.V.rows(); ++v)
    result =
        (std::max)(result, (closest(fine.V.row(v)).point - Eigen::Vector3d(fine.V.row(v))).norm());
  return result;
}

Mesh simplified(const shapes::Matrices& input, const std::size_t N,
                const Spectral_edge_collapse_options& options)
{
  Mesh mesh = make_mesh(input);
  REQUIRE(SMS::spectral_edge_collapse(mesh, N, options).output_vertices == N);
  return mesh;
}

// Calls a function with the profile of each edge before the first collapse.
template <class Function>
struct At_first_costs : SMS::internal::Dummy_visitor
{
  const Function* function;

  explicit At_first_costs(const Function* f)
    : function(f)
  {}
  template <class Profile, class Cost>
  void OnCollected(const Profile& profile, const Cost&) const
  {
    (*function)(profile);
  }
};

} // namespace

TEST_CASE("A cost with a shape term is that of whole matrices and of all planes that were merged")
{
  const bool closed = GENERATE(true, false);
  const shapes::Matrices input =
      closed ? shapes::bumpy_icosphere_matrices(2) : wavy_grid_matrices(12, 11);
  const Basis basis = eigenbasis(input, GENERATE(0., 0.5), 8);
  Slow_mesh mesh(input, basis);
  std::vector<Planes> planes = planes_of(input);
  Parameters parameters = Parameters::paper();
  parameters.placement =
      GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::free);
  parameters.shape = GENERATE(0.5, 300.);
  const double sum_of_squares = basis.lambda.squaredNorm();
  Core core = make_core(mesh, basis, parameters);
  std::mt19937 random(5);
  std::size_t n = std::size_t(input.V.rows());
  for(int round = 0; round < 3; ++round) {
    int counts[2] = {}; // costs that the loss of E decides in part, and those where it is bounded
    int at_minimum[2] = {};
    const double before = mesh.energy();
    for(const Edge& e : mesh.edge_list()) {
      if(random() % 8 != 0)
        continue;
      const Sample candidate = core.evaluate(Slot(e.first), Slot(e.second));
      if(!candidate.collapsible())
        continue;
      const Eigen::Vector3d x = candidate.point;
      const Planes &at_u = planes[std::size_t(e.first)], &at_v = planes[std::size_t(e.second)];
      const double change = quadric(at_u, x) + quadric(at_v, x) -
                            quadric(at_u, on_edge(mesh, e, 0)) - quadric(at_v, on_edge(mesh, e, 1));
      const double loss =
          mesh.energy_after(e, core.projected_weight(Slot(e.first), Slot(e.second), x), x) - before;
      const double bound =
          10 * sum_of_squares *
          (vertex_mass(mesh, e.first, basis.area) + vertex_mass(mesh, e.second, basis.area));
      const double slow = (std::min)(loss, bound) + parameters.shape * sum_of_squares * double(n) *
                                                        change / (basis.area * basis.area);
      ++counts[loss > bound];
      CHECK(std::abs(candidate.cost - slow) < 1e-8 * (std::abs(slow) + before + std::abs(loss)));
      if(parameters.placement == Spectral_placement_strategy::free) {
        // The least quadric within reach, or the cheapest of the ends and the middle.
        const Eigen::Vector3d middle = on_edge(mesh, e, 0.5);
        const double radius = (on_edge(mesh, e, 1) - on_edge(mesh, e, 0)).norm(),
                     reach = (x - middle).norm();
        const bool at_sample = x == on_edge(mesh, e, 0) || x == middle || x == on_edge(mesh, e, 1);
        const auto both = [&](const Eigen::Vector3d& y) {
          return quadric(at_u, y) + quadric(at_v, y);
        };
        ++at_minimum[at_sample];
        CHECK(reach < radius * (1 + 1e-12));
        for(const double alpha : {0., 0.5, 1.})
          CHECK(candidate.cost <=
                core.cost_at(Slot(e.first), Slot(e.second), on_edge(mesh, e, alpha)) +
                    1e-12 * (std::abs(slow) + before + std::abs(loss)));
        for(int axis = 0; axis < 6 && !at_sample && reach < 0.99 * radius; ++axis) {
          const Eigen::Vector3d step =
              (axis % 2 == 0 ? 1e-3 : -1e-3) * radius * Eigen::Vector3d::Unit(axis / 2);
          CHECK(both(x) < both(x + step));
        }
      }
    }
    CHECK(counts[0] > 10);
    if(parameters.placement == Spectral_placement_strategy::free)
      CHECK(at_minimum[0] > 2);
    for(int i = 0; i < 15; ++i) {
      const std::vector<Edge> edges = mesh.edge_list();
      const Edge e = edges[random() % edges.size()];
      const Sample c = core.evaluate(Slot(e.first), Slot(e.second));
      if(!c.collapsible())
        continue;
      commit(core, mesh, e, c, true);
      Planes& kept = planes[std::size_t(e.first)];
      const Planes& removed = planes[std::size_t(e.second)];
      kept.insert(kept.end(), removed.begin(), removed.end());
      --n;
    }
    REQUIRE(n < std::size_t(input.V.rows()) - 5);
  }
}

TEST_CASE("Where signals are constant the cost is CGAL's probabilistic plane quadric")
{
  // All faces are alike: CGAL does not weight them by area.
  const shapes::Matrices input = scaled(shapes::icosphere_matrices(0), 3);
  Mesh mesh = make_mesh(input), theirs = make_mesh(input);
  Spectral_options options;
  options.signals = Eigen::MatrixXd::Ones(input.V.rows(), 2);
  options.shape = 2;
  const SMS::Spectral_policies policies(mesh, options);
  using Variances = CGAL::Constant_property_map<Mesh::Face_index, std::pair<double, double>>;
  const SMS::GarlandHeckbert_probabilistic_plane_policies<Mesh, Kernel, Variances> quadrics(
      theirs, 100., Variances{{variance, 0.}});
  const double total = SG::laplace_operator(input.V, input.T).mass.sum(),
               area = total / double(input.T.rows());
  const double unit = options.shape * double(input.V.rows()) * area / (total * total);
  const auto place = [](const auto& profile, const int i) {
    return CGAL::barycenter(profile.p0(), 1 - 0.4 * i, profile.p1(), 0.4 * i) +
           Kernel::Vector_3(0.1, -0.2, 0.05);
  };
  std::vector<double> costs;
  const auto record = [&](const auto& profile) {
    for(int i = 0; i < 3; ++i) {
      const Kernel::Point_3 x = place(profile, i);
      costs.push_back(*quadrics(profile, SMS::internal::Spectral_optional<Kernel::Point_3>(x)));
      // There planes of a face go through one of its corners, here through the vertex itself.
      for(const auto& [v, p] :
          {std::pair{profile.v0(), profile.p0()}, std::pair{profile.v1(), profile.p1()}})
        for(const auto f : faces_around_target(halfedge(v, theirs), theirs))
          costs.back() +=
              variance *
              (CGAL::squared_distance(x, p) -
               CGAL::squared_distance(x, theirs.point(source(halfedge(f, theirs), theirs))));
    }
  };
  // By itself: what its get_cost() returns is of another type where variances are given (CGAL 5.5).
  SMS::edge_collapse(theirs, SMS::Vertex_count_stop_predicate<Mesh>(11, theirs),
                     CGAL::parameters::get_cost(quadrics).get_placement(quadrics).visitor(
                         At_first_costs<decltype(record)>(&record)));
  std::size_t compared = 0;
  const auto compare = [&](const auto& profile) {
    for(int i = 0; i < 3; ++i) {
      const double own = *policies.get_cost()(
          profile, SMS::internal::Spectral_optional<Kernel::Point_3>(place(profile, i)));
      CHECK(own == Catch::Approx(unit * costs.at(compared++)).epsilon(1e-10));
    }
  };
  collapse(mesh, policies, 11, At_first_costs<decltype(compare)>(&compare));
  CHECK(compared == 90);
}

TEST_CASE(
    "Without signals that tell anything the shape term simplifies as well as CGAL's quadrics do")
{
  const shapes::Matrices input = scaled(shapes::bumpy_icosphere_matrices(4), 50);
  Mesh ours = make_mesh(input), theirs = make_mesh(input);
  Spectral_edge_collapse_options options;
  options.signals = Eigen::MatrixXd::Ones(input.V.rows(), 1);
  options.relocate = false;
  SMS::spectral_edge_collapse(ours, 200, options);
  const SMS::GarlandHeckbert_probabilistic_plane_policies<Mesh, Kernel> quadrics(theirs);
  SMS::edge_collapse(
      theirs, SMS::Vertex_count_stop_predicate<Mesh>(200, theirs),
      CGAL::parameters::get_cost(quadrics.get_cost()).get_placement(quadrics.get_placement()));
  CHECK(furthest(input, SG::mesh_matrices(ours)) <
        1.25 * furthest(input, SG::mesh_matrices(theirs)));
}

TEST_CASE("A weight of the shape term means the same at every unit of length")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Spectral_options options;
  options.number_of_eigenvectors = 20;
  const auto map_at = [&](const double factor) {
    Mesh mesh = make_mesh(scaled(input, factor));
    const SMS::Spectral_policies policies(mesh, options);
    collapse(mesh, policies, 120);
    return policies.vertex_map();
  };
  const std::vector<std::size_t> map = map_at(1);
  CHECK(map_at(1024) == map);
  CHECK(map_at(1. / 1024) == map);
}

TEST_CASE("A thin limb folded beside a body survives, and would not in the paper's metric",
          "[slow]")
{
  const shapes::Matrices input = shapes::folded_limb_matrices(260, 20);
  REQUIRE(SG::internal::self_intersecting_faces(input.V, input.T).empty());
  constexpr Eigen::Index K = 30;
  struct Found
  {
    double furthest, low, norm_L;
    std::size_t crossings;
  };
  const SG::Laplace_operator fine_op = SG::laplace_operator(input.V, input.T, 0.5);
  const SG::Eigenpairs fine_pairs = SG::eigenpairs(fine_op, K);
  const auto found = [&](Spectral_edge_collapse_options options, const std::size_t vertices = 90) {
    options.number_of_eigenvectors = K;
    const Mesh mesh = simplified(input, vertices, options);
    const shapes::Matrices coarse = SG::mesh_matrices(mesh);
    const SG::Laplace_operator op = SG::laplace_operator(coarse.V, coarse.T, 0.5);
    const SG::Spectral_evaluation e =
        SG::evaluate_spectrum(fine_op, fine_pairs, op, SG::eigenpairs(op, K),
                              SG::closest_point_interpolation(coarse.V, input), K);
    return Found{furthest(input, coarse), e.errors_low.mean, e.norm_L,
                 SG::internal::self_intersecting_faces(coarse.V, coarse.T).size()};
  };
  Spectral_edge_collapse_options policies;
  policies.relocate = false;
  const Found paper = found(Spectral_edge_collapse_options::paper()), shaped = found(policies),
              best = found(Spectral_edge_collapse_options::best());
  CAPTURE(paper.furthest, shaped.furthest, best.furthest, paper.low, shaped.low, best.low,
          paper.norm_L, shaped.norm_L, best.norm_L, paper.crossings);
  CHECK(shaped.furthest < 0.75 * paper.furthest);
  CHECK(best.furthest < 1.001 * shaped.furthest);
  // They say little of the paper's metric: rounding decides how the limb is lost, at all of these
  // sizes alike.
  CHECK((std::max)(shaped.low, best.low) < 0.16);
  for(const std::size_t vertices : {82, 86, 94, 98})
    for(const auto& options : {policies, Spectral_edge_collapse_options::best()})
      CHECK(found(options, vertices).low < 0.16);
  CHECK(best.norm_L < shaped.norm_L);
  CHECK(shaped.crossings == 0);
  CHECK(best.crossings == 0);
}

TEST_CASE("Two sheets close to each other do not cross, and would without the guard")
{
  const shapes::Matrices input = shapes::thin_bowl_matrices(4);
  REQUIRE(SG::internal::self_intersecting_faces(input.V, input.T).empty());
  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 20;
  options.relocate = false;
  options.placement =
      GENERATE(Spectral_placement_strategy::on_edge, Spectral_placement_strategy::free,
               Spectral_placement_strategy::midpoint);
  const auto crossings = [&] {
    const shapes::Matrices coarse = SG::mesh_matrices(simplified(input, 150, options));
    return SG::internal::self_intersecting_faces(coarse.V, coarse.T).size();
  };
  CHECK(crossings() == 0);
  options.keep_free_of_self_intersections = false;
  CHECK(crossings() > 0);
}

// A shell and one inside of it, which comes out at its pole.
shapes::Matrices crossing_shells()
{
  shapes::Matrices result = shapes::components_matrices(shapes::bumpy_icosphere_matrices(4), 2);
  const Eigen::Index half = result.V.rows() / 2;
  for(Eigen::Index v = 0; v < half; ++v) {
    const Eigen::Vector3d p = result.V.row(v);
    result.V.row(half + v) = (p.normalized().z() > 0.98 ? 1.01 : 0.975) * p;
  }
  return result;
}

TEST_CASE(
    "An edge whose placement would cross another sheet is not collapsed elsewhere at any price",
    "[slow]")
{
  // One vertex would swallow what lies around it: on some sizes eigenvalues were off by 6 to 13 %.
  const shapes::Matrices input = crossing_shells();
  constexpr Eigen::Index K = 40;
  const SG::Laplace_operator fine_op = SG::laplace_operator(input.V, input.T, 0.5);
  const SG::Eigenpairs fine_pairs = SG::eigenpairs(fine_op, K);
  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = K;
  double largest = 0;
  for(const std::size_t vertices : {140, 185, 215, 230}) {
    const SG::Mesh_matrices coarse = SG::mesh_matrices(simplified(input, vertices, options));
    REQUIRE(coarse.V.rows() == Eigen::Index(vertices));
    const SG::Laplace_operator op = SG::laplace_operator(coarse.V, coarse.T, 0.5);
    const SG::Spectral_evaluation e =
        SG::evaluate_spectrum(fine_op, fine_pairs, op, SG::eigenpairs(op, K),
                              SG::closest_point_interpolation(coarse.V, input), K);
    CAPTURE(vertices, e.errors.mean, e.norm_L);
    CHECK(e.errors.mean < 0.055);
    largest = (std::max)(largest, e.norm_L);
  }
  CHECK(largest < 100);
}

TEST_CASE("Where two sheets cross in one place the crossing does not spread")
{
  const shapes::Matrices input = crossing_shells();
  const auto number_crossing = [](const shapes::Matrices& m) {
    return SG::internal::self_intersecting_faces(m.V, m.T).size();
  };
  const std::size_t before = number_crossing(input);
  REQUIRE(before > 20);
  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 20;
  options.relocate = false;
  Mesh mesh = make_mesh(input);
  CHECK(SMS::spectral_edge_collapse(mesh, 300, options).output_vertices == 300);
  CHECK(number_crossing(SG::mesh_matrices(mesh)) < before / 2);
}

TEST_CASE("Where faces would cross whatever is collapsed the run ends above its target and says so")
{
  // Four shells, each close inside of the one before: with so few vertices they cannot keep apart.
  const shapes::Matrices shell = shapes::bumpy_icosphere_matrices(2);
  shapes::Matrices input = shapes::components_matrices(shell, 4);
  const Eigen::Index n = shell.V.rows();
  for(int c = 0; c < 4; ++c)
    input.V.middleRows(c * n, n) = (1 - 0.006 * c) * shell.V;
  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 12;
  options.relocate = false;
  Mesh guarded = make_mesh(input), free = guarded;
  const auto result = SMS::spectral_edge_collapse(guarded, 20, options);
  const shapes::Matrices coarse = SG::mesh_matrices(guarded);
  CHECK(SG::internal::self_intersecting_faces(coarse.V, coarse.T).empty());
  CHECK(result.stop_reason == SMS::Spectral_edge_collapse_result::Stop_reason::queue_exhausted);
  CHECK(result.output_vertices > 20);
  CHECK(result.output_vertices < 40);
  CHECK(result.refusals.crossing > 0);
  CHECK(result.refusals.crossing <= result.refusals.placement);
  CHECK_THAT(result.explanation, ContainsSubstring("keep_free_of_self_intersections"));
  options.keep_free_of_self_intersections = false;
  const auto other = SMS::spectral_edge_collapse(free, 20, options);
  CHECK(other.output_vertices == 20);
  CHECK(other.refusals.crossing == 0);
}

TEST_CASE("Sheets that lie in each other from the start do not hold a run up")
{
  shapes::Matrices input = shapes::components_matrices(shapes::bumpy_icosphere_matrices(3), 2);
  const Eigen::Index half = input.V.rows() / 2;
  input.V.bottomRows(half) = input.V.topRows(half);
  input.V.bottomRows(half).col(0).array() += 2e-3;
  REQUIRE(SG::internal::self_intersecting_faces(input.V, input.T).size() > 300);
  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 20;
  options.relocate = false;
  Mesh mesh = make_mesh(input);
  const auto result = SMS::spectral_edge_collapse(mesh, 200, options);
  CHECK(result.output_vertices == 200);
  CHECK(result.evaluations < 60 * result.collapses);
}

TEST_CASE("Several runs with a shape term go on from each other")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Spectral_options options;
  options.number_of_eigenvectors = 12;
  Mesh once = make_mesh(input), twice = make_mesh(input);
  const SMS::Spectral_policies a(once, options), b(twice, options);
  collapse(once, a, 100);
  collapse(twice, b, 300);
  collapse(twice, b, 100);
  // The order may differ by edges that the first run had put off; planes and crossings are those of
  // the input.
  const double difference = std::abs(
      furthest(input, SG::mesh_matrices(once)) / furthest(input, SG::mesh_matrices(twice)) - 1);
  CHECK(difference < 0.3);
  CHECK(
      SG::internal::self_intersecting_faces(SG::mesh_matrices(twice).V, SG::mesh_matrices(twice).T)
          .empty());
}

TEST_CASE("With a shape term the result does not depend on the number of threads, and the error "
          "bound speaks "
          "of E alone")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 15;
  options.relocate = false;
  options.maximum_error = 0.15;
  Mesh bounded = make_mesh(input);
  const auto result = SMS::spectral_edge_collapse(bounded, 45, options);
  CHECK(result.relative_error <= 0.15);
  CHECK(result.relative_error > 0.1);
  const Basis basis = eigen_input(input, options.mass, *result.eigenpairs).basis;
  CHECK(relative_difference(energy(SG::mesh_matrices(bounded), basis, result.restriction),
                            result.E) < 1e-8);
}

TEST_CASE(
    "Vertices to keep are where they were after a relocation, with a single 1 in their rows of P")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(3);
  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 15;
  options.kept_vertices = {3, 77, 500};
  Mesh mesh = make_mesh(input);
  const auto result = SMS::spectral_edge_collapse(mesh, 100, options);
  REQUIRE(result.relocation.resampled);
  CHECK(result.relocation.held.fixed == 3);
  const shapes::Matrices coarse = SG::mesh_matrices(mesh);
  const Eigen::SparseMatrix<double, Eigen::RowMajor> P = result.restriction;
  for(const std::size_t v : options.kept_vertices) {
    const Eigen::Index row = Eigen::Index(result.vertex_map[v]);
    CHECK(coarse.V.row(row) == input.V.row(Eigen::Index(v)));
    CHECK(P.row(row).nonZeros() == 1);
    CHECK(P.coeff(row, Eigen::Index(v)) == 1);
  }
}

TEST_CASE("Presets: the defaults are the best, the paper's have neither shape term nor relocation")
{
  const Spectral_edge_collapse_options plain, best = Spectral_edge_collapse_options::best(),
                                              paper = Spectral_edge_collapse_options::paper();
  for(const Spectral_edge_collapse_options& o : {plain, best}) {
    CHECK(o.mass == SG::Mass::averaged);
    CHECK(o.placement == Spectral_placement_strategy::free);
    CHECK(o.shape == 3);
    CHECK(o.quadrics_above == 7);
    CHECK(o.number_of_mixtures == 32);
    CHECK(o.keep_free_of_self_intersections);
    CHECK(o.relocate);
    CHECK(o.relocation.signals == SG::Relocation_options::Signals::sampled);
  }
  for(const Spectral_edge_collapse_options& o : {plain, best, paper})
    CHECK(o.source == SMS::Spectral_signal_source::eigenpairs);
  CHECK(Spectral_edge_collapse_options::fast(600).source ==
        SMS::Spectral_signal_source::filtered_noise);
  CHECK(Spectral_edge_collapse_options::fast(600).quadrics_above == 7);
  CHECK(Spectral_edge_collapse_options::fast(600).pre_simplify == 10000);
  CHECK(Spectral_edge_collapse_options::fast(1000).pre_simplify == 15000);
  CHECK(best.pre_simplify == 0);
  CHECK(Spectral_edge_collapse_options::best(600).pre_simplify == 300000);
  CHECK(Spectral_edge_collapse_options::best(20000).pre_simplify == 600000);
  CHECK(Spectral_options().shape == Spectral_options::best().shape);
  CHECK(paper.mass == SG::Mass::lumped);
  CHECK(paper.placement == Spectral_placement_strategy::on_edge);
  CHECK(paper.shape == 0);
  CHECK(paper.number_of_mixtures == 0);
  CHECK_FALSE(paper.keep_free_of_self_intersections);
  CHECK_FALSE(paper.relocate);
  CHECK(std::isinf(paper.quadrics_above));
  CHECK(Spectral_options::paper().mass == SG::Mass::lumped);
}

TEST_CASE("A step that leaps to another sheet is told from one along the surface")
{
  shapes::Matrices sheets = shapes::components_matrices(shapes::grid_matrices(10, 10), 2);
  const Eigen::Index half = sheets.V.rows() / 2;
  sheets.V.bottomRows(half) = sheets.V.topRows(half);
  sheets.V.bottomRows(half).col(2).setConstant(0.1);
  const SG::internal::Closest_point_query closest(sheets);
  // A coarse triangle whose corners are on both sheets, so that each may go to either.
  const SG::Mesh_matrices coarse =
      shapes::matrices({{0, 0, 0}, {0, 0, 0.1}, {1, 0, 0}}, {{0, 1, 2}});
  const SG::internal::Surface_regions regions(coarse, sheets,
                                              SG::closest_point_interpolation(coarse.V, sheets));
  SG::internal::Followed_closest_points followed(closest, regions, 2);
  const Eigen::Vector3d low(0.5, 0.5, 0.04), high(0.5, 0.5, 0.06);
  CHECK(followed.leaps(0, low, high));
  CHECK_FALSE(followed.leaps(0, low, {0.6, 0.52, 0.045}));
  CHECK_FALSE(followed.leaps(1, high, {0.5, 0.3, 0.3}));
  CHECK(followed.leaps(0, high, low)); // from elsewhere now
  for(const Eigen::Vector3d& p : {low, high, low, Eigen::Vector3d(0.1, 0.2, 0.03), high, low})
    CHECK(followed(0, p).point == regions.of_coarse_vertex(closest, 0, p).point);
}

TEST_CASE("Relocation leaves no vertex of the input further behind than before, and says what held "
          "which vertex")
{
  const shapes::Matrices input = shapes::folded_limb_matrices(200, 16);
  Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 25;
  const auto run = [&](const bool guarded, SMS::Spectral_edge_collapse_result& result) {
    Mesh mesh = make_mesh(input);
    options.relocation.hausdorff_goal = guarded ? 1e9 : std::numeric_limits<double>::infinity();
    result = SMS::spectral_edge_collapse(mesh, 75, options);
    return furthest(input, SG::mesh_matrices(mesh));
  };
  SMS::Spectral_edge_collapse_result guarded, free, before;
  const double with = run(true, guarded), without = run(false, free);
  options.relocate = false;
  const double start = run(true, before);
  CHECK(with <= start * (1 + 1e-9));
  CHECK(with <= without * (1 + 1e-9));
  CHECK(guarded.relocation.reverted_vertices > 0);
  CHECK(guarded.relocation.steps > 0);
  CHECK(guarded.relocation.held.trust + guarded.relocation.held.triangles +
            guarded.relocation.held.sheet >
        0);
  CHECK(guarded.relocation.held.fixed == 0);
  CHECK(std::string(guarded.relocation.stop_reason_name()) != "");
  if(guarded.relocation.stop_reason == SG::Relocation_result::Stop_reason::steps)
    CHECK(guarded.relocation.steps == options.relocation.maximum_steps);
  else // as it may with the last step
    CHECK(guarded.relocation.steps <= options.relocation.maximum_steps);
}

} // namespace test_shape_term
