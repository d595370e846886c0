// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// What lives how long: policies and their mesh, logs, handles; exceptions and threads. To be run
// under AddressSanitizer, too.

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Restriction_visitor.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Spectral_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Vertex_count_stop_predicate.h>

#include <CGAL/Spectral_geometry/internal/numerics/Thread_pool.h>

#include "catch.h"
#include "collapse_helpers.h"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <new>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

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
  options.progress = [&](const SMS::Spectral_progress& p) {
    cancel = cancel || (p.phase == SMS::Spectral_phase::collapses && p.fraction > 0.5 &&
                        p.number_of_vertices > 100);
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

TEST_CASE("What a call of the pool throws reaches the caller, and the pool goes on")
{
  struct Scratch
  {
    int used = 0;
  };
  using Pool = CGAL::Spectral_geometry::internal::Thread_pool<Scratch>;
  for(const int threads : {1, 2, 4}) {
    Pool pool(threads);
    for(const std::size_t thrower : {0, 500, 999}) {
      const auto body = [thrower](const std::size_t i, Scratch& scratch) {
        ++scratch.used;
        if(i == thrower)
          throw std::bad_alloc();
      };
      CHECK_THROWS_AS(pool.for_each(1000, 4, body), std::bad_alloc);
    }
    std::atomic<int> calls{0};
    pool.for_each(1000, 4, [&](std::size_t, Scratch&) { ++calls; });
    CHECK(calls == 1000);
  }
}

TEST_CASE("Where a worker is held up the caller does the next calls alone, and is helped again "
          "afterwards")
{
  struct Scratch
  {};
  CGAL::Spectral_geometry::internal::Thread_pool<Scratch> pool(2);
  REQUIRE(pool.number_of_threads() == 2);
  const std::thread::id caller = std::this_thread::get_id();
  // Two calls, of which the worker does one at least, if it comes within five seconds.
  const auto worker_comes = [&](const int milliseconds) {
    std::atomic<bool> came{false};
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    pool.for_each(2, 1, [&](std::size_t, Scratch&) {
      if(std::this_thread::get_id() != caller) {
        came = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      }
      while(!came && std::chrono::steady_clock::now() < end)
        std::this_thread::yield();
    });
    return bool(came);
  };
  REQUIRE(worker_comes(50));
  std::atomic<int> by_worker{0};
  const auto count = [&](std::size_t, Scratch&) {
    by_worker += std::this_thread::get_id() != caller;
  };
  for(int loop = 0; loop < 50; ++loop)
    pool.for_each(64, 1, count);
  CHECK(by_worker == 0);
  for(int loop = 0; loop < 1000; ++loop)
    pool.for_each(64, 1, count);
  CHECK(worker_comes(0));
}

TEST_CASE("A pool does with the threads it gets, and ends them if its construction fails")
{
  struct Scratch
  {};
  using Pool = CGAL::Spectral_geometry::internal::Thread_pool<Scratch>;
  int left = 0;
  const auto start = [&left](auto error) {
    return [&left, error](auto&& worker) {
      if(left-- == 0)
        throw error;
      return std::thread(worker);
    };
  };
  left = 2;
  CHECK(Pool(6, start(std::system_error(
                    std::make_error_code(std::errc::resource_unavailable_try_again))))
            .number_of_threads() == 3);
  left = 1;
  CHECK(Pool(6, start(std::bad_alloc())).number_of_threads() == 2);
  left = 2;
  CHECK_THROWS_AS(Pool(6, start(std::runtime_error("something else"))), std::runtime_error);
}

TEST_CASE("What one of the tasks of a loop throws reaches the caller")
{
  for(const int threads : {1, 2, 4})
    CHECK_THROWS_AS(CGAL::Spectral_geometry::internal::for_each_task(100, threads,
                                                                     [](const int i) {
                                                                       if(i == 50)
                                                                         throw std::bad_alloc();
                                                                     }),
                    std::bad_alloc);
}

} // namespace test_lifetime
