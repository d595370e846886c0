// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// What lives how long: policies and their mesh, logs, handles; exceptions and threads. To be run
// under AddressSanitizer, too.

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Restriction_visitor.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>

#include <CGAL/Spectral_geometry/internal/numerics/for_each_task.h>
#include <CGAL/Spectral_geometry/internal/numerics/product.h>

#include "catch.h"
#include "collapse_helpers.h"

#include <new>
#include <system_error>
#include <thread>

namespace test_lifetime {

using namespace spectral_test;
using Policies = SMS::Spectral_policies<Mesh, Kernel>;

namespace {

template <class Stop>
void run(Mesh& mesh, const Policies& policies, const Stop& stop)
{
  SMS::edge_collapse(mesh, stop,
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .visitor(policies.visitor()));
}

} // namespace

TEST_CASE("Policies, visitors and replays may be destroyed after their mesh")
{
  auto mesh = std::make_unique<Mesh>(make_mesh(shapes::bumpy_icosphere_matrices(1)));
  auto copy = std::make_unique<Mesh>(*mesh);
  auto policies = std::make_unique<Policies>(*mesh, options_with(4));
  SMS::Restriction_visitor<Mesh> visitor(*mesh);
  collapse(*mesh, *policies, 30);
  SMS::Collapse_replay<Mesh> replay(*copy, policies->log()); // the log is a temporary
  const auto kept = policies->get_cost();
  replay.collapse_to(35);
  CHECK(count_vertices(*copy) == 35);
  mesh.reset();
  copy.reset();
  policies.reset();
}

TEST_CASE("What policies leave in a mesh is gone when the next ones are made")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(1));
  const std::size_t before = mesh.properties<Mesh::Vertex_index>().size();
  for(int i = 0; i < 3; ++i)
    const Policies policies(mesh, options_with(4));
  const Policies last(mesh, options_with(4));
  CHECK(mesh.properties<Mesh::Vertex_index>().size() == before + 1);
}

TEST_CASE("A mesh that has been assigned to is refused, one that is put back as it was is not")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(1));
  const Policies policies(mesh, options_with(4));
  const SMS::Restriction_visitor<Mesh> visitor(mesh);
  const Mesh backup = mesh;
  mesh = backup;
  collapse(mesh, policies, 30);
  mesh = make_mesh(shapes::bumpy_icosphere_matrices(1));
  CHECK_THROWS_AS(collapse(mesh, policies, 20), std::logic_error);
  CHECK_THROWS_AS(policies.restriction(), std::logic_error);
  CHECK_THROWS_AS(visitor.restriction(), std::logic_error);
  CHECK(count_vertices(mesh) == 42);
}

TEST_CASE("Handles that stand for nothing say so")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(1));
  Policies policies(mesh, options_with(4));
  const SMS::Vertex_count_stop_predicate<Mesh> stop(30, mesh);
  CHECK_THROWS_AS(SMS::edge_collapse(mesh, stop,
                                     CGAL::parameters::get_cost(Policies::Get_cost())
                                         .get_placement(policies.get_placement())
                                         .visitor(policies.visitor())),
                  std::logic_error);
  CHECK_THROWS_AS(SMS::edge_collapse(mesh, stop,
                                     CGAL::parameters::get_cost(policies.get_cost())
                                         .get_placement(Policies::Get_placement())
                                         .visitor(policies.visitor())),
                  std::logic_error);
  const Policies moved = std::move(policies);
  CHECK_THROWS_AS(policies.restriction(), std::logic_error);
  CHECK_THROWS_AS(policies.get_cost(), std::logic_error);
  CHECK_THROWS_AS(policies.visitor(), std::logic_error);
  CHECK_THROWS_AS(policies.error(), std::logic_error);
  run(mesh, moved, stop);
  CHECK(count_vertices(mesh) == 30);
}

TEST_CASE("A temporary is refused where it would have to live on")
{
  CHECK_FALSE(
      std::is_constructible<SMS::Vertex_count_stop_predicate<Mesh>, std::size_t, Mesh&&>::value);
  CHECK_FALSE(std::is_constructible<Policies, Mesh&&>::value);
  CHECK_FALSE(std::is_constructible<SMS::Restriction_visitor<Mesh>, Mesh&&>::value);
  CHECK(std::is_constructible<SMS::Collapse_replay<Mesh>, Mesh&, SMS::Collapse_log&&>::value);
}

TEST_CASE("A second run with a predicate that was cancelled or has reached its target begins anew")
{
  Mesh mesh = make_mesh(shapes::bumpy_icosphere_matrices(2));
  std::atomic<bool> cancel{true};
  auto options = options_with(4);
  options.cancel = &cancel;
  options.progress = [&](const SG::Progress& p) {
    cancel = cancel ||
             (p.phase == SG::Phase::collapses && p.fraction > 0.5 && p.number_of_vertices > 100);
    return true;
  };
  cancel = false;
  const Policies policies(mesh, options);
  const SMS::Spectral_stop_predicate stop(policies, 60);
  run(mesh, policies, stop);
  CHECK(stop.cancelled());
  CHECK(count_vertices(mesh) > 100);
  cancel = false;
  options.progress = nullptr;
  run(mesh, policies, stop);
  CHECK(count_vertices(mesh) < 110);
  cancel = false;
  while(count_vertices(mesh) > 60) {
    cancel = false;
    run(mesh, policies, stop);
  }
  CHECK(stop.reached());
  CHECK_FALSE(stop.cancelled());
}

TEST_CASE("A loop does with the threads it gets, and all that is to be done is done")
{
  using CGAL::Spectral_geometry::internal::for_each_range;
  const auto refuse_third = [](auto error) {
    return [error, left = std::make_shared<int>(2)](const auto& worker) {
      if((*left)-- == 0)
        throw error;
      return std::thread(worker);
    };
  };
  std::atomic<int> calls{0};
  const auto count = [&](std::ptrdiff_t begin, std::ptrdiff_t end) { calls += int(end - begin); };
  for_each_range(1000, 4, 6, count,
                 refuse_third(std::system_error(
                     std::make_error_code(std::errc::resource_unavailable_try_again))));
  CHECK(calls == 1000);
  for_each_range(1000, 4, 6, count, refuse_third(std::bad_alloc()));
  CHECK(calls == 2000);
  CHECK_THROWS_AS(for_each_range(1000, 4, 6, count, refuse_third(std::runtime_error("another"))),
                  std::runtime_error);
}

TEST_CASE("Ranges cover every number once, and products on several threads are those on one")
{
  using CGAL::Spectral_geometry::internal::for_each_range;
  using CGAL::Spectral_geometry::internal::product;
  const Eigen::Index size = GENERATE(0, 1, 1023, 1024, 1025, 5000);
  CAPTURE(size);
  std::vector<int> calls(std::size_t(size), 0);
  std::atomic<bool> short_enough{true};
  for_each_range(size, 64, 3, [&](const Eigen::Index first, const Eigen::Index end) {
    if(!(first < end && end - first <= 64))
      short_enough = false;
    for(Eigen::Index i = first; i < end; ++i)
      ++calls[std::size_t(i)];
  });
  CHECK(short_enough);
  CHECK(std::count(calls.begin(), calls.end(), 1) == size);

  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(size, 7), B = Eigen::MatrixXd::Random(7, 5);
  Eigen::SparseMatrix<double> S(7, 7);
  S.insert(6, 2) = 3;
  S.insert(0, 5) = -2;
  CHECK((product(A, B, 3) - A * B).norm() <= 1e-14 * double(size));
  CHECK(product(A, B, 3) == product(A, B, 1));
  CHECK((product(S, B, 3) - S * B).norm() < 1e-14);
  CHECK(product(S, B, 3) == product(S, B, 1));
}

TEST_CASE("What one of the tasks of a loop throws reaches the caller, on whichever thread")
{
  for(const int threads : {1, 2, 4})
    for(const int thrower : {0, 500, 999})
      CHECK_THROWS_AS(CGAL::Spectral_geometry::internal::for_each_task(
                          1000, threads,
                          [thrower](const std::ptrdiff_t i) {
                            if(i == thrower)
                              throw std::bad_alloc();
                          },
                          4),
                      std::bad_alloc);
}

} // namespace test_lifetime
