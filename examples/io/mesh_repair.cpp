// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The repair of meshes, apart from the programs that use it because CGAL's templates take their time.

#include "mesh_repair.h"

#include <CGAL/Spectral_geometry/mesh_diagnosis.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_mesh_to_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/version.h>

#include <algorithm>
#include <cmath>

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;

// Triangulation and the removal of degenerate faces ask for predicates that do not err.
using Exact_predicates = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact_mesh = CGAL::Surface_mesh<Exact_predicates::Point_3>;

struct Exact_soup
{
  std::vector<Exact_predicates::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
};

CGAL::Spectral_geometry::Mesh_diagnosis diagnose(const Exact_soup& soup)
{
  Eigen::MatrixXd V(Eigen::Index(soup.points.size()), 3);
  for(std::size_t v = 0; v < soup.points.size(); ++v)
    V.row(Eigen::Index(v)) << soup.points[v].x(), soup.points[v].y(), soup.points[v].z();
  return CGAL::Spectral_geometry::diagnose_polygon_soup(V, soup.polygons);
}

// CGAL's functions compare coordinates and follow indices: faces where that is impossible go first.
Exact_soup usable_part(const Polygon_soup& soup, Repair_log& log)
{
  Exact_soup result;
  std::vector<bool> finite;
  for(const Kernel::Point_3& p : soup.points) {
    finite.push_back(std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()));
    result.points.emplace_back(finite.back() ? p.x() : 0., finite.back() ? p.y() : 0.,
                               finite.back() ? p.z() : 0.);
  }
  std::size_t foreign = 0, infinite = 0;
  for(const std::vector<std::size_t>& polygon : soup.polygons) {
    const auto exists = [&](const std::size_t v) { return v < finite.size(); };
    if(!std::all_of(polygon.begin(), polygon.end(), exists))
      ++foreign;
    else if(!std::all_of(polygon.begin(), polygon.end(), [&](const std::size_t v) { return finite[v]; }))
      ++infinite;
    else
      result.polygons.push_back(polygon);
  }
  log.add("face removed that uses a vertex that does not exist",
          "faces removed that use a vertex that does not exist", foreign);
  log.add("face removed with a coordinate that is not finite",
          "faces removed with a coordinate that is not finite", infinite);
  return result;
}

// Takes repetitions out of polygons, and what is no polygon then; true if no vertex is left twice in any of them.
bool without_repetitions(Exact_soup& soup, Repair_log& log)
{
  bool simple = true;
  const std::size_t before = soup.polygons.size();
  for(std::vector<std::size_t>& polygon : soup.polygons) {
    polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
    while(polygon.size() > 1 && polygon.front() == polygon.back())
      polygon.pop_back();
    std::vector<std::size_t> sorted = polygon;
    std::sort(sorted.begin(), sorted.end());
    simple = simple && std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  }
  soup.polygons.erase(
      std::remove_if(soup.polygons.begin(), soup.polygons.end(),
                     [](const std::vector<std::size_t>& polygon) { return polygon.size() < 3; }),
      soup.polygons.end());
  log.add("face removed that used a vertex twice", "faces removed that used a vertex twice",
          before - soup.polygons.size());
  return simple;
}

void clean(Exact_soup& soup, Repair_log& log)
{
  log.add("isolated vertex removed", "isolated vertices removed",
          PMP::remove_isolated_points_in_polygon_soup(soup.points, soup.polygons));
  log.add("vertex merged that had the position of another", "vertices merged that had the same position",
          PMP::merge_duplicate_points_in_polygon_soup(soup.points, soup.polygons));
  if(without_repetitions(soup, log)) // a precondition of CGAL's
    log.add("copy of a face removed", "copies of faces removed",
            PMP::merge_duplicate_polygons_in_polygon_soup(soup.points, soup.polygons));
  const std::size_t before = soup.polygons.size();
  PMP::repair_polygon_soup(soup.points, soup.polygons);
  if(soup.polygons.size() < before)
    log.add("face removed that used a vertex twice", "faces removed that used a vertex twice",
            before - soup.polygons.size());
}

// Splitting gives new vertices old positions, so that the direction of a face shows in its positions.
bool same_direction(const Exact_soup& before, const Exact_soup& after, const std::size_t f)
{
  const std::vector<std::size_t>&p = before.polygons[f], &q = after.polygons[f];
  for(std::size_t i = 0; i < q.size(); ++i)
    if(after.points[q[i]] == before.points[p[0]])
      return after.points[q[(i + 1) % q.size()]] == before.points[p[1]];
  return true;
}

void orient(Exact_soup& soup, Repair_log& log)
{
  const Exact_soup before = soup;
  PMP::orient_polygon_soup(soup.points, soup.polygons);
  std::size_t turned = 0;
  for(std::size_t f = 0; f < soup.polygons.size(); ++f)
    turned += !same_direction(before, soup, f);
  log.add("face turned round", "faces turned round", turned);
  log.add("vertex doubled to separate sheets", "vertices doubled to separate sheets",
          soup.points.size() - before.points.size());
}

Exact_mesh to_mesh(const Exact_soup& soup)
{
  Exact_mesh mesh;
  PMP::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, mesh);
  return mesh;
}

Exact_soup to_soup(const Exact_mesh& mesh)
{
  Exact_soup soup;
  PMP::polygon_mesh_to_polygon_soup(mesh, soup.points, soup.polygons);
  return soup;
}

void triangulate(Exact_soup& soup, Repair_log& log)
{
  const auto polygons = std::count_if(soup.polygons.begin(), soup.polygons.end(),
                                      [](const auto& polygon) { return polygon.size() > 3; });
  if(polygons == 0)
    return;
  Exact_mesh mesh = to_mesh(soup);
  PMP::triangulate_faces(mesh);
  soup = to_soup(mesh);
  log.add("polygon triangulated", "polygons triangulated", std::size_t(polygons));
  // Two polygons may have got the same diagonal.
  orient(soup, log);
}

// Needles are collapsed, caps flipped; thresholds: edges of a ratio of a million, an angle of 179.9999 degrees.
void remove_degenerate_faces(Exact_mesh& mesh, Repair_log& log)
{
  const std::size_t before = mesh.number_of_faces();
  const double ratio = 1e6, cosine = std::cos(std::acos(-1.) * 179.9999 / 180);
#if CGAL_VERSION_NR >= CGAL_VERSION_NUMBER(6, 0, 0)
  PMP::remove_almost_degenerate_faces(mesh, CGAL::parameters::needle_threshold(ratio).cap_threshold(cosine));
#else
  PMP::experimental::remove_almost_degenerate_faces(mesh, cosine, ratio, 0.);
#endif
  mesh.collect_garbage();
  log.add("degenerate face removed", "degenerate faces removed", before - mesh.number_of_faces());
}

} // namespace

Polygon_soup repaired_soup(const Polygon_soup& input, Repair_log& log)
{
  const Silence silence; // what CGAL warns of, the diagnosis says better
  Exact_soup soup = usable_part(input, log);
  clean(soup, log);
  orient(soup, log);
  triangulate(soup, log);
  Exact_mesh mesh = to_mesh(soup);
  log.add("pair of border edges stitched", "pairs of border edges stitched", PMP::stitch_borders(mesh));
  mesh.collect_garbage();
  const auto diagnosis = diagnose(to_soup(mesh));
  if(diagnosis.zero_area_faces.count != 0 || diagnosis.overflowing_faces.count != 0)
    remove_degenerate_faces(mesh, log);
  log.add("vertex doubled to separate sheets", "vertices doubled to separate sheets",
          PMP::duplicate_non_manifold_vertices(mesh));
  log.add("isolated vertex removed", "isolated vertices removed", PMP::remove_isolated_vertices(mesh));
  mesh.collect_garbage();

  const Exact_soup result = to_soup(mesh);
  Polygon_soup repaired;
  for(const Exact_predicates::Point_3& p : result.points)
    repaired.points.emplace_back(p.x(), p.y(), p.z());
  repaired.polygons = result.polygons;
  return repaired;
}
