// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Collapses by quadrics, of a first stage or ahead of the spectral cost: their order against all
// costs computed anew, what they keep, and what follows them.

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/spectral_edge_collapse.h>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_geometry/internal/surface/triangles_intersect.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>
#include <CGAL/Spectral_geometry/operator_coefficients.h>

#include "catch.h"
#include "collapse_helpers.h"
#include "topology.h"

namespace test_pre_simplification {

using namespace spectral_test;

namespace {

SMS::Collapse_log quadric_log(const Mesh& mesh, const std::size_t target,
                              const std::vector<char>& fixed = {})
{
  SMS::internal::Triangle_arrays arrays =
      SMS::internal::triangle_arrays(mesh, SG::mesh_matrices(mesh));
  arrays.fixed = fixed;
  return SMS::internal::quadric_collapses(std::move(arrays), false, target, [](std::size_t) {}).log;
}

Mesh replayed(Mesh mesh, const SMS::Collapse_log& log, const std::size_t N)
{
  SMS::Collapse_replay<Mesh>(mesh, log).collapse_to(N);
  return mesh;
}

// The expected squared distance to the planes of a vertex, as a matrix in homogeneous coordinates:
// from the definition.
using Quadric = Eigen::Matrix4d;

Quadric plane(const Eigen::Vector3d& normal, const Eigen::Vector3d& p, const double weight)
{
  Quadric point = Quadric::Identity();
  point.topRightCorner<3, 1>() = -p;
  point.bottomLeftCorner<1, 3>() = -p.transpose();
  point(3, 3) = p.squaredNorm();
  const Eigen::Vector4d h(normal[0], normal[1], normal[2], -normal.dot(p));
  return weight * (h * h.transpose() + 0.15 * 0.15 * point);
}

std::vector<Quadric> quadrics_of(const shapes::Matrices& mesh)
{
  std::vector<Quadric> result(std::size_t(mesh.V.rows()), Quadric::Zero());
  for(Eigen::Index f = 0; f < mesh.T.rows(); ++f) {
    const auto point = [&](const int k) { return Eigen::Vector3d(mesh.V.row(mesh.T(f, k % 3))); };
    const Eigen::Vector3d cross = (point(1) - point(0)).cross(point(2) - point(0));
    for(int k = 0; k < 3; ++k)
      result[std::size_t(mesh.T(f, k))] += plane(cross.normalized(), point(k), cross.norm() / 2);
  }
  return result;
}

double least_value(const Quadric& q, Eigen::Vector3d& x)
{
  x = q.topLeftCorner<3, 3>().fullPivLu().solve(-q.topRightCorner<3, 1>());
  return x.homogeneous().dot(q * x.homogeneous());
}

// Whether the faces at u that do not contain v turn by more than 78 degrees or become needles when
// u moves to x.
bool spoils_faces(const Mesh& mesh, const Mesh::Vertex_index u, const Mesh::Vertex_index v,
                  const Eigen::Vector3d& x)
{
  const auto at = [&](const Mesh::Vertex_index w) {
    return Eigen::Vector3d(mesh.point(w).x(), mesh.point(w).y(), mesh.point(w).z());
  };
  for(const auto h : halfedges_around_target(u, mesh)) {
    const auto a = source(h, mesh), b = target(next(h, mesh), mesh);
    if(is_border(h, mesh) || a == v || b == v)
      continue;
    const Eigen::Vector3d before = (at(b) - at(u)).cross(at(a) - at(u)),
                          after = (at(b) - x).cross(at(a) - x);
    const double longest =
        (std::max)({(at(a) - x).norm(), (at(b) - x).norm(), (at(a) - at(b)).norm()});
    if(before.normalized().dot(after.normalized()) < 0.2 + 1e-9 ||
       after.norm() < 1.0001e-3 * longest * longest)
      return true;
  }
  return false;
}

} // namespace

TEST_CASE("Each collapse is the cheapest that is possible, with all costs computed anew")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  Mesh mesh = make_mesh(input);
  const SMS::Collapse_log log = quadric_log(mesh, 20);
  REQUIRE(log.number_of_vertices_left() == 20);
  std::vector<Quadric> quadrics = quadrics_of(input);
  SMS::Collapse_replay<Mesh> replay(mesh, log);
  std::size_t dearer = 0, off = 0;
  for(std::size_t i = 0; i < log.points().size(); ++i) {
    const std::vector<Eigen::Index> slots = replay.slots();
    std::vector<Eigen::Index> slot_of(mesh.num_vertices(), -1);
    std::size_t k = 0;
    for(const auto v : mesh.vertices())
      slot_of[v.idx()] = slots[k++];
    double cheapest = std::numeric_limits<double>::infinity();
    for(const auto e : mesh.edges()) {
      const auto u = source(e, mesh), v = target(e, mesh);
      Eigen::Vector3d x;
      const double cost = least_value(
          quadrics[std::size_t(slot_of[u.idx()])] + quadrics[std::size_t(slot_of[v.idx()])], x);
      if(cost < cheapest && CGAL::Euler::does_satisfy_link_condition(e, mesh) &&
         !spoils_faces(mesh, u, v, x) && !spoils_faces(mesh, v, u, x))
        cheapest = cost;
    }
    const auto& merge = log.forest().merges()[i];
    quadrics[std::size_t(merge.kept)] += quadrics[std::size_t(merge.removed)];
    Eigen::Vector3d x;
    dearer += least_value(quadrics[std::size_t(merge.kept)], x) > cheapest * (1 + 1e-5);
    off += (x - log.points()[i]).norm() > 1e-9;
    replay.collapse_to(log.number_of_vertices() - i - 1);
  }
  CHECK(dearer == 0);
  CHECK(off == 0);
}

TEST_CASE("The first stage keeps a manifold what it is, its border and its parts")
{
  const bool hub = GENERATE(false, true);
  shapes::Matrices input =
      hub ? shapes::gear_matrices(600, 3)
          : GENERATE(wavy_grid_matrices(24, 20), shapes::torus_matrices(24, 12),
                     shapes::components_matrices(shapes::tetrahedron_matrices(), 5),
                     shapes::components_matrices(shapes::icosphere_matrices(1), 3));
  CAPTURE(hub, input.V.rows());
  const Mesh mesh = make_mesh(input);
  const SMS::Collapse_log log = quadric_log(mesh, 1);
  const Mesh coarse = replayed(mesh, log, log.number_of_vertices_left());
  CHECK(CGAL::is_valid_polygon_mesh(coarse));
  CHECK(topology(coarse) == topology(mesh));
  CHECK(log.number_of_vertices_left() <
        (std::max)(std::size_t(26), std::size_t(input.V.rows()) / 10));
}

TEST_CASE("Edges without length go first, and faces without area are no obstacle")
{
  shapes::Matrices input = shapes::bumpy_icosphere_matrices(2);
  for(const int f : {10, 100, 200})
    input.V.row(input.T(f, 0)) = input.V.row(input.T(f, 1));
  input.V.row(input.T(300, 0)) = (input.V.row(input.T(300, 1)) + input.V.row(input.T(300, 2))) / 2;
  const Mesh mesh = make_mesh(input);
  const SMS::Collapse_log log = quadric_log(mesh, 60);
  REQUIRE(log.number_of_vertices_left() == 60);
  const Mesh first = replayed(mesh, log, log.number_of_vertices() - 3),
             last = replayed(mesh, log, 60);
  const auto shortest = [](const Mesh& m) {
    double length = std::numeric_limits<double>::infinity();
    for(const auto e : m.edges())
      length =
          (std::min)(length, CGAL::squared_distance(m.point(source(e, m)), m.point(target(e, m))));
    return length;
  };
  CHECK(shortest(mesh) == 0);
  CHECK(shortest(first) > 0);
  CHECK(shortest(last) > 1e-4);
  CHECK(CGAL::is_valid_polygon_mesh(last));
}

TEST_CASE("Vertices that are fixed stay, and the unit of length does not matter")
{
  shapes::Matrices input = wavy_grid_matrices(20, 18);
  std::vector<char> fixed(std::size_t(input.V.rows()), 0);
  for(const std::size_t v : every(17, input.V.rows()))
    fixed[v] = 1;
  const SMS::Collapse_log log = quadric_log(make_mesh(input), 60, fixed);
  REQUIRE(log.number_of_vertices_left() == 60);
  for(std::size_t i = 0; i < log.points().size(); ++i) {
    const auto& merge = log.forest().merges()[i];
    CHECK(!fixed[std::size_t(merge.removed)]);
    if(fixed[std::size_t(merge.kept)]) {
      CHECK(merge.weight == 0);
      CHECK(log.points()[i] == Eigen::Vector3d(input.V.row(merge.kept)));
    }
  }
  const double unit = GENERATE(0x1p-60, 0x1p60);
  input.V *= unit;
  const SMS::Collapse_log scaled = quadric_log(make_mesh(input), 60, fixed);
  REQUIRE(scaled.points().size() == log.points().size());
  for(std::size_t i = 0; i < log.points().size(); ++i)
    CHECK(scaled.points()[i] == unit * log.points()[i]);
}

TEST_CASE("The vertex where several fans of faces meet is named, whatever collapses first")
{
  // Two sheets of a grid, which have a corner in common.
  const shapes::Matrices sheet = shapes::grid_matrices(5, 5);
  const int n = int(sheet.V.rows());
  shapes::Matrices input{Eigen::MatrixXd(2 * n - 1, 3), Eigen::MatrixXi(2 * sheet.T.rows(), 3)};
  input.V << sheet.V, -sheet.V.bottomRows(n - 1);
  input.T << sheet.T, (sheet.T.array() == 0).select(0, sheet.T.array() + (n - 1));
  REQUIRE(sheet.V.row(0).norm() == 0);
  Mesh mesh = make_mesh(input);
  REQUIRE(mesh.number_of_faces() == std::size_t(input.T.rows()));
  const auto named = ContainsSubstring("vertex 0 (counted from 0) joins several fans");
  SMS::Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 5;
  SECTION("quadrics alone")
  {
    CHECK_THROWS_WITH(SMS::quadric_edge_collapse(mesh, 30), named);
  }
  SECTION("the policies")
  {
    CHECK_THROWS_WITH(SMS::Spectral_policies(mesh, options), named);
  }
  SECTION("the one call")
  {
    options.pre_simplify = GENERATE(0, 50);
    options.quadrics_above = GENERATE(1., std::numeric_limits<double>::infinity());
    CHECK_THROWS_WITH(SMS::spectral_edge_collapse(mesh, 30, options), named);
  }
  CHECK(mesh.number_of_vertices() == std::size_t(input.V.rows()));
}

TEST_CASE("Closed surfaces that meet in a vertex are refused for that, and not for their genus")
{
  // Euler's formula says that five of them have -2 handles.
  const shapes::Matrices part = shapes::bumpy_icosphere_matrices(1);
  Mesh mesh = make_mesh(shapes::components_matrices(part, 5));
  for(int i = 1; i < 5; ++i) {
    const Mesh::Vertex_index v(i * int(part.V.rows()));
    const auto range = CGAL::halfedges_around_target(v, mesh);
    for(const auto h : std::vector<Mesh::Halfedge_index>(range.begin(), range.end()))
      mesh.set_target(h, Mesh::Vertex_index(0));
    mesh.remove_vertex(v);
  }
  mesh.collect_garbage();
  SMS::Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 5;
  CHECK_THROWS_WITH(SMS::spectral_edge_collapse(mesh, 60, options),
                    ContainsSubstring("vertex 0 (counted from 0) joins several fans"));
}

TEST_CASE("Vertices that are fixed take no values from a border that is apart")
{
  const shapes::Matrices sheet = wavy_grid_matrices(6, 6);
  const Mesh mesh = make_mesh(sheet);
  const std::vector<char> border = SG::internal::border_vertices(sheet.T, sheet.V.rows());
  for(std::size_t every = 2; every < 8; ++every) {
    std::vector<char> fixed(border.size(), 0);
    for(std::size_t v = 0; v < fixed.size(); v += every)
      fixed[v] = !border[v];
    SMS::internal::Triangle_arrays arrays = SMS::internal::triangle_arrays(mesh, sheet);
    arrays.fixed = fixed;
    arrays.border_is_apart = true;
    const SMS::Collapse_log log =
        SMS::internal::quadric_collapses(std::move(arrays), true, 3, [](std::size_t) {}).log;
    const std::size_t N = log.number_of_vertices_left();
    CHECK(N < border.size());
    const std::vector<std::size_t> map = log.vertex_map(N);
    const Eigen::SparseMatrix<double> P = log.restriction(N);
    for(std::size_t v = 0; v < fixed.size(); ++v)
      if(fixed[v])
        CHECK(P.coeff(Eigen::Index(map[v]), Eigen::Index(v)) == 1);
  }
}

TEST_CASE("quadric_edge_collapse() is the first stage on its own")
{
  const Mesh input = make_mesh(shapes::bumpy_icosphere_matrices(3));
  Mesh mesh = input;
  const std::size_t n = count_vertices(mesh);
  auto kept = mesh.add_property_map<Mesh::Vertex_index, bool>("v:kept", false).first;
  for(std::size_t v = 0; v < n; v += 17)
    kept[Mesh::Vertex_index(Mesh::size_type(v))] = true;
  double last = 0;
  const SMS::Quadric_edge_collapse_result result = SMS::quadric_edge_collapse(
      mesh, 100,
      [&](const double fraction) {
        CHECK((fraction >= last && fraction <= 1));
        last = fraction;
        return true;
      },
      CGAL::parameters::vertex_is_constrained_map(kept));
  CHECK(last > 0.9);
  REQUIRE(count_vertices(mesh) == 100);
  CHECK((CGAL::is_valid_polygon_mesh(mesh) && CGAL::is_closed(mesh)));
  REQUIRE((result.restriction.rows() == 100 && std::size_t(result.restriction.cols()) == n));
  CHECK((result.restriction * Eigen::VectorXd::Ones(Eigen::Index(n)) - Eigen::VectorXd::Ones(100))
            .norm() < 1e-12);
  const Eigen::MatrixXd V = positions(mesh), fine = positions(input);
  for(std::size_t v = 0; v < n; v += 17) {
    const Eigen::Index row = Eigen::Index(result.vertex_map[v]);
    CHECK(result.restriction.coeff(row, Eigen::Index(v)) == 1);
    CHECK(V.row(row) == fine.row(Eigen::Index(v)));
  }

  Mesh other = input;
  SMS::Spectral_edge_collapse_options options = options_with(20);
  options.pre_simplify = 100;
  for(std::size_t v = 0; v < n; v += 17)
    options.kept_vertices.push_back(v);
  const auto whole = SMS::spectral_edge_collapse(other, 100, options);
  CHECK(positions(other) == V);
  CHECK((whole.restriction - result.restriction).norm() == 0);
}

TEST_CASE("quadric_edge_collapse() that is cancelled or refused leaves the mesh as it was")
{
  const Mesh input = make_mesh(shapes::bumpy_icosphere_matrices(2));
  Mesh mesh = input;
  CHECK_THROWS_AS(
      SMS::quadric_edge_collapse(mesh, 20, [](const double fraction) { return fraction < 0.5; }),
      SG::Cancelled);
  CHECK_THROWS_WITH(SMS::quadric_edge_collapse(mesh, 163),
                    ContainsSubstring("the target is 163 vertices, but the mesh has 162"));
  CHECK_THROWS_WITH(SMS::quadric_edge_collapse(mesh, 0), ContainsSubstring("from 1 to 162"));
  Mesh with_isolated = input;
  with_isolated.add_vertex(Kernel::Point_3(9, 9, 9));
  CHECK_THROWS_WITH(SMS::quadric_edge_collapse(with_isolated, 20),
                    ContainsSubstring("vertex 162") && ContainsSubstring("is isolated"));
  CHECK(positions(mesh) == positions(input));
  CHECK(SMS::quadric_edge_collapse(mesh, 162).vertex_map.size() == 162);
}

SMS::Spectral_edge_collapse_options ahead_options()
{
  SMS::Spectral_edge_collapse_options options;
  options.number_of_eigenvectors = 12;
  options.relocate = false;
  return options;
}

TEST_CASE("The mesh after quadrics is the one that a replay of their log leaves")
{
  using Exact_mesh = CGAL::Surface_mesh<CGAL::Exact_predicates_exact_constructions_kernel::Point_3>;
  const bool apart = GENERATE(false, true); // the border, whose points stay on an end
  const auto check = [apart](auto input, const std::size_t N, const std::vector<char>& kept) {
    using Any_mesh = decltype(input);
    Any_mesh mesh = input;
    SMS::Spectral_options options;
    options.preserve_border = apart;
    const auto [log, slots] = SMS::internal::collapse_by_quadrics(
        mesh, N, kept, options, CGAL::parameters::default_values());
    SMS::Collapse_replay<Any_mesh> replay(input, log);
    replay.collapse_to(log.number_of_vertices_left());
    REQUIRE(log.number_of_vertices_left() == N);
    CHECK(replay.slots() == slots);
    CHECK((mesh.is_valid(false) && CGAL::is_valid_polygon_mesh(mesh)));
    REQUIRE(mesh.number_of_faces() == input.number_of_faces());
    REQUIRE(mesh.number_of_edges() == input.number_of_edges());
    std::size_t others = 0;
    for(const auto v : input.vertices())
      others += mesh.is_removed(v) || mesh.point(v) != input.point(v) ||
                mesh.target(mesh.halfedge(v)) != v || mesh.is_removed(mesh.halfedge(v));
    for(const auto f : input.faces())
      others += mesh.is_removed(f) || mesh.face(mesh.halfedge(f)) != f;
    for(const auto h : input.halfedges())
      others += mesh.is_removed(h) || mesh.target(h) != input.target(h) ||
                mesh.next(h) != input.next(h) || mesh.face(h) != input.face(h);
    CHECK(others == 0);
  };
  const std::size_t N = GENERATE(40, 200);
  for(const shapes::Matrices& shape :
      {shapes::bumpy_icosphere_matrices(3), wavy_grid_matrices(25, 25)}) {
    std::vector<char> kept(std::size_t(shape.V.rows()));
    check(make_mesh(shape), N, kept);
    for(std::size_t v = 3; v < kept.size(); v += 41)
      kept[v] = true;
    check(make_mesh(shape), N, kept);
    Exact_mesh exact;
    shapes::make_mesh(exact, shape);
    for(const auto v : exact.vertices()) // where no double is
      exact.point(v) = exact.point(v) + (exact.point(v) - CGAL::ORIGIN) / 3;
    check(exact, N, kept);
  }
}

TEST_CASE("F, Z and P follow collapses by quadrics ahead of the spectral cost")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(4);
  const Eigen::Index n = input.V.rows();
  SMS::Spectral_edge_collapse_options options = ahead_options();
  const std::string kinds[] = {"eigenvectors", "signals", "rough pairs"},
                    kind = kinds[GENERATE(0, 1, 2)];
  CAPTURE(kind);
  if(kind == "signals")
    options.signals = input.V.array().sin().matrix();
  if(kind == "rough pairs")
    options.eigenpairs_options.tolerance = 1e-3;
  Mesh mesh = make_mesh(input), copy = mesh;
  const auto result = SMS::spectral_edge_collapse(mesh, 60, options);
  CHECK(result.quadric_collapses == std::size_t(n) - 420);
  CHECK(result.pre_simplified_vertices == std::size_t(n));
  REQUIRE((count_vertices(mesh) == 60 && result.log.number_of_vertices_left() == 60));
  REQUIRE(result.restriction.cols() == n);

  // E from P alone.
  const shapes::Matrices coarse = SG::mesh_matrices(mesh);
  const SG::Laplace_operator fine_op = SG::laplace_operator(input.V, input.T, options.mass),
                             coarse_op = SG::laplace_operator(coarse.V, coarse.T, options.mass);
  const double area = fine_op.mass.sum();
  const bool own = kind == "signals";
  REQUIRE(bool(result.eigenpairs) == !own);
  const Eigen::MatrixXd& F = own ? options.signals : result.eigenpairs->vectors;
  const Eigen::MatrixXd Z = SMS::internal::spectral_z(fine_op, F);
  const double E =
      SG::restriction_energy(coarse_op, result.restriction, F, Z) * area * (own ? 1. : area);
  CHECK(std::abs(result.E / E - 1) < 1e-6);

  // The quadrics come first, and the level where they end is theirs.
  const SMS::Collapse_log log = quadric_log(copy, 900);
  for(std::size_t i = 0; i < log.points().size(); ++i)
    REQUIRE(log.points()[i] == result.log.points()[i]);
  CHECK(SG::number_of_zero_eigenvalues(coarse_op) == 1);
  SMS::Collapse_replay<Mesh>(copy, result.log).collapse_to(60);
  CHECK(positions(copy) == positions(mesh));
}

TEST_CASE("Quadrics of the shape and slots follow, on meshes whose vertices are handles as well")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(4);
  using Polyhedron = CGAL::Polyhedron_3<Kernel>;
  Polyhedron mesh;
  shapes::make_mesh(mesh, input);
  const SMS::Spectral_edge_collapse_options options = ahead_options();
  SMS::Spectral_policies<Polyhedron, Kernel> policies(mesh, options);
  SMS::Collapse_log log;
  policies.state().collapse_by_others([&] {
    auto done = SMS::internal::collapse_by_quadrics(mesh, 300, {}, options,
                                                    CGAL::parameters::default_values());
    log = done.first;
    return done;
  });
  CHECK(count_vertices(mesh) == 300);

  // Each vertex that is left has the planes of all that went into it.
  SMS::internal::Spectral_rings rings;
  rings.resize(std::size_t(input.V.rows()));
  std::vector<Eigen::Vector3d> points;
  Mesh fine = make_mesh(input);
  for(const auto v : fine.vertices()) {
    points.push_back(input.V.row(Eigen::Index(v.idx())));
    for(const auto h : CGAL::halfedges_around_target(v, fine)) {
      rings[v.idx()].emplace_back();
      rings[v.idx()].back().vertex = fine.source(h).idx();
      rings[v.idx()].back().face = true;
    }
  }
  SMS::internal::Spectral_shape_term expected;
  const double area = SG::laplace_operator(input.V, input.T, options.mass).mass.sum();
  expected.set_weights(options, policies.state().basis().sum_of_squares);
  expected.set_geometry(points, rings, 1 / area);
  for(const SG::Merge_forest::Merge& m : log.forest().merges())
    expected.merge(SMS::internal::Spectral_slot(m.removed), SMS::internal::Spectral_slot(m.kept));
  const std::vector<Eigen::Index> slots = policies.state().current_slots();
  const SMS::internal::Spectral_shape_term& followed = policies.state().core().shape();
  for(std::size_t i = 0; i < slots.size(); ++i) {
    const auto u = SMS::internal::Spectral_slot(slots[i]),
               v = SMS::internal::Spectral_slot(slots[(i + 1) % slots.size()]);
    const Eigen::Vector3d x = 1.1 * input.V.row(slots[i]);
    CHECK(std::abs(followed.cost(points, u, v, x) / expected.cost(points, u, v, x) - 1) < 1e-9);
  }
  collapse(mesh, policies, 60);
  CHECK(count_vertices(mesh) == 60);
  const Eigen::SparseMatrix<double> P = policies.restriction();
  REQUIRE((P.rows() == 60 && P.cols() == input.V.rows()));
  const shapes::Matrices coarse = SG::mesh_matrices(mesh);
  const auto pairs = policies.eigenpairs();
  const double E =
      SG::restriction_energy(SG::laplace_operator(coarse.V, coarse.T, options.mass), P,
                             pairs->vectors, pairs->vectors * pairs->values.asDiagonal());
  CHECK(std::abs(policies.error() / (E * area * area) - 1) < 1e-6);
}

TEST_CASE("Kept vertices and constrained edges stay, and edges without length are merged, when "
          "quadrics come first")
{
  shapes::Matrices input = wavy_grid_matrices(40, 40);
  if(GENERATE(false, true))
    for(const int f : {20, 200, 410, 700})
      input.V.row(input.T(f, 0)) = input.V.row(input.T(f, 1));
  SMS::Spectral_edge_collapse_options options = ahead_options();
  options.quadrics_above = GENERATE(2., 15.);
  for(Eigen::Index v = 820; v < 1000; v += 13)
    options.kept_vertices.push_back(std::size_t(v));
  Mesh mesh = make_mesh(input);
  auto constrained = mesh.add_property_map<Mesh::Edge_index, bool>("e:constrained", false).first;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> ends;
  for(const auto e : mesh.edges())
    if(e.idx() % 400 == 7) {
      constrained[e] = true;
      ends.emplace_back(mesh.vertex(e, 0).idx(), mesh.vertex(e, 1).idx());
    }
  const auto result = SMS::spectral_edge_collapse(
      mesh, 80, options, CGAL::parameters::edge_is_constrained_map(constrained));
  CHECK(result.quadric_collapses ==
        std::size_t(input.V.rows() - Eigen::Index(80 * options.quadrics_above)));
  CHECK(fault_of_result(mesh, result.restriction, result.vertex_map, input) == "");
  CHECK(survivors(options.kept_vertices, input, mesh, result.restriction, result.vertex_map) ==
        options.kept_vertices.size());
  const Eigen::MatrixXd V = positions(mesh);
  REQUIRE(ends.size() > 5);
  for(const auto& [u, v] : ends)
    CHECK((V.row(Eigen::Index(result.vertex_map[std::size_t(u)])) == input.V.row(u) &&
           V.row(Eigen::Index(result.vertex_map[std::size_t(v)])) == input.V.row(v)));
}

TEST_CASE("Quadrics are passed over where not all that was asked for could be kept, and when they "
          "are told to be",
          "[slow]")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(4);
  SMS::Spectral_edge_collapse_options options = ahead_options();
  const auto quadric_collapses = [&](const auto& np) {
    Mesh mesh = make_mesh(input);
    return SMS::spectral_edge_collapse(mesh, 100, options, np).quadric_collapses;
  };
  const auto none = CGAL::parameters::default_values();
  CHECK(quadric_collapses(none) == std::size_t(input.V.rows()) - 700);
  CHECK(quadric_collapses(CGAL::parameters::visitor(SMS::internal::Dummy_visitor())) == 0);
  CHECK(quadric_collapses(CGAL::parameters::filter(SMS::Bounded_normal_change_filter<>())) == 0);
  using Options = SMS::Spectral_edge_collapse_options;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(input.V.rows());
  const std::function<void(Options&)> changes[] = {
      [](Options& o) { o.quadrics_above = std::numeric_limits<double>::infinity(); },
      [](Options& o) { o.quadrics_above = 26; },
      [](Options& o) { o.shape = 0; },
      [](Options& o) { o.placement = SMS::Spectral_placement_strategy::on_edge; },
      [](Options& o) { o.binary = true; },
      [](Options& o) { o.preserve_border = true; },
      [](Options& o) { o.maximum_error = 100; },
      [](Options& o) { o.boundary = SG::Boundary_condition::dirichlet; },
      [&](Options& o) { o.coefficients = SG::weighted_coefficients(ones, ones); }};
  changes[GENERATE(range(0, 9))](options);
  CHECK(quadric_collapses(none) == 0);
}

TEST_CASE("A run that is cancelled while quadrics come first leaves the mesh as it was, later what "
          "they have made")
{
  const shapes::Matrices input = shapes::bumpy_icosphere_matrices(4);
  Mesh mesh = make_mesh(input);
  SMS::Spectral_edge_collapse_options options = ahead_options();
  const SG::Phase phase = GENERATE(SG::Phase::pre_simplification, SG::Phase::first_costs);
  options.progress = [&](const SG::Progress& p) { return p.phase != phase || p.fraction < 0.5; };
  if(phase == SG::Phase::pre_simplification) {
    CHECK_THROWS_AS(SMS::spectral_edge_collapse(mesh, 100, options), SG::Cancelled);
    CHECK(positions(mesh) == input.V);
    return;
  }
  const auto result = SMS::spectral_edge_collapse(mesh, 100, options);
  CHECK(result.stop_reason == SMS::Spectral_edge_collapse_result::Stop_reason::cancelled);
  CHECK((result.output_vertices == 700 && count_vertices(mesh) == 700));
  CHECK(result.quadric_collapses == std::size_t(input.V.rows()) - 700);
  CHECK(fault_of_result(mesh, result.restriction, result.vertex_map, input) == "");
  Mesh copy = make_mesh(input);
  SMS::Collapse_replay<Mesh>(copy, result.log).collapse_to(700);
  CHECK(positions(copy) == positions(mesh));
}

TEST_CASE("Quadrics put no face through another, and would without the guard")
{
  shapes::Matrices input = shapes::thin_bowl_matrices(4);
  if(GENERATE(false, true)) { // a part that nothing comes near
    const shapes::Matrices other = shapes::bumpy_icosphere_matrices(4);
    const Eigen::Index n = input.V.rows(), m = input.T.rows();
    input.V.conservativeResize(n + other.V.rows(), 3);
    input.T.conservativeResize(m + other.T.rows(), 3);
    input.V.bottomRows(other.V.rows()) = other.V.rowwise() + Eigen::RowVector3d(10, 0, 0);
    input.T.bottomRows(other.T.rows()) = other.T.array() + int(n);
  }
  REQUIRE(SG::internal::self_intersecting_faces(input.V, input.T).empty());
  const std::size_t N = GENERATE(60, 150);
  const auto crossings = [&](const bool guarded) {
    Mesh mesh = make_mesh(input);
    const SMS::Collapse_log log =
        SMS::internal::quadric_collapses(SMS::internal::triangle_arrays(mesh, input), guarded, N,
                                         [](std::size_t) {})
            .log;
    CHECK(log.number_of_vertices_left() == N);
    const shapes::Matrices coarse = SG::mesh_matrices(replayed(mesh, log, N));
    return SG::internal::self_intersecting_faces(coarse.V, coarse.T).size();
  };
  CHECK(crossings(false) > 0);
  CHECK(crossings(true) == 0);
}

} // namespace test_pre_simplification
