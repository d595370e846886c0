// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// The repair of meshes, apart from the programs that use it because CGAL's templates take their
// time.

// What CGAL asserts holds for any file in a release build as well: where it does not, CGAL's
// functions follow handles to nothing.
#define CGAL_DEBUG

#include "mesh_repair.h"

#include "orientation.h"
#include "silence.h"

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_toolbox/mesh_diagnosis.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_mesh_to_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/exceptions.h>
#include <CGAL/utility.h>
#include <CGAL/version.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

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
    else if(!std::all_of(polygon.begin(), polygon.end(),
                         [&](const std::size_t v) { return finite[v]; }))
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

// Takes repetitions out of polygons, and what is no polygon then; true if no vertex is left twice
// in any of them.
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

// A polygon without its direction, its smallest vertex first, and whether it runs the other way.
std::pair<std::vector<std::size_t>, bool> undirected(std::vector<std::size_t> polygon)
{
  std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
  const bool turned = polygon[1] > polygon.back();
  if(turned)
    std::reverse(polygon.begin() + 1, polygon.end());
  return {polygon, turned};
}

double area(const Exact_soup& soup, const std::vector<std::size_t>& polygon)
{
  double sum = 0;
  for(std::size_t i = 2; i < polygon.size(); ++i)
    sum += std::sqrt(CGAL::squared_area(soup.points[polygon[0]], soup.points[polygon[i - 1]],
                                        soup.points[polygon[i]]));
  return sum;
}

// Where a thin part of a closed surface has collapsed to a fin, each of its faces lies on one that
// runs the other way, and at its root two faces of the rest meet, which run along it in opposite
// directions: they meet still when both copies have gone, while one alone would be a third face of
// that edge. What hangs on such faces goes with them. Larger fins, above a hundredth of the area,
// may be meant: of them, and of a surface whose faces are all there twice, one copy stays.
void remove_fins(Exact_soup& soup, Repair_log& log)
{
  using Vertices = std::vector<std::size_t>;
  std::vector<std::pair<Vertices, std::size_t>> faces; // each with the place of its polygon
  std::vector<bool> turned(soup.polygons.size());
  for(std::size_t i = 0; i < soup.polygons.size(); ++i) {
    log.go_on();
    auto [vertices, is_turned] = undirected(soup.polygons[i]);
    turned[i] = is_turned;
    faces.emplace_back(std::move(vertices), i);
  }
  std::sort(faces.begin(), faces.end());
  constexpr std::size_t none = std::size_t(-1);
  std::vector<std::size_t> fold_of(soup.polygons.size(),
                                   none); // of each polygon that lies on another
  std::vector<Vertices> folded;
  for(std::size_t i = 0, j; i < faces.size(); i = j) {
    bool differ = false;
    for(j = i + 1; j < faces.size() && faces[j].first == faces[i].first; ++j)
      differ = differ || turned[faces[j].second] != turned[faces[i].second];
    if(!differ)
      continue;
    for(std::size_t k = i; k < j; ++k)
      fold_of[faces[k].second] = folded.size();
    folded.push_back(faces[i].first);
  }
  if(folded.empty())
    return;

  struct Edge
  {
    std::array<int, 2> single{}; // faces that are not folded, by their direction
    std::vector<std::size_t> folded;
  };
  std::map<std::pair<std::size_t, std::size_t>, Edge> edges; // those of the folded faces
  const auto ends = [](const Vertices& face, const std::size_t i) {
    return std::make_pair(face[i], face[(i + 1) % face.size()]);
  };
  const auto sorted = [](const std::pair<std::size_t, std::size_t>& e) {
    return e.first < e.second ? e : std::make_pair(e.second, e.first);
  };
  for(std::size_t f = 0; f < folded.size(); ++f)
    for(std::size_t i = 0; i < folded[f].size(); ++i)
      edges[sorted(ends(folded[f], i))].folded.push_back(f);
  double whole = 0;
  for(std::size_t f = 0; f < fold_of.size(); ++f) {
    log.go_on();
    const Vertices& polygon = soup.polygons[f];
    whole += area(soup, polygon);
    for(std::size_t i = 0; i < polygon.size() && fold_of[f] == none; ++i) {
      const auto e = ends(polygon, i);
      const auto found = edges.find(sorted(e));
      if(found != edges.end())
        ++found->second.single[e.first < e.second];
    }
  }

  std::vector<bool> seen(folded.size(), false), goes(folded.size(), false);
  for(const auto& [e, root] : edges) {
    if(root.single[0] != 1 || root.single[1] != 1)
      continue;
    std::vector<std::size_t> fin;
    const auto take = [&](const Edge& edge) {
      for(const std::size_t f : edge.folded)
        if(!seen[f]) {
          seen[f] = true;
          fin.push_back(f);
        }
    };
    take(root);
    double size = 0;
    for(std::size_t k = 0; k < fin.size(); ++k) {
      const Vertices& face = folded[fin[k]];
      size += area(soup, face);
      for(std::size_t i = 0; i < face.size(); ++i)
        if(const Edge& edge = edges[sorted(ends(face, i))]; edge.single[0] + edge.single[1] == 0)
          take(edge);
    }
    if(size <= 0.01 * whole)
      for(const std::size_t f : fin)
        goes[f] = true;
  }
  std::vector<Vertices> left;
  for(std::size_t f = 0; f < fold_of.size(); ++f)
    if(fold_of[f] == none || !goes[fold_of[f]])
      left.push_back(std::move(soup.polygons[f]));
  const char* words = "faces removed that were folded onto each other"; // never one alone
  log.add(words, words, soup.polygons.size() - left.size());
  soup.polygons = std::move(left);
}

void clean(Exact_soup& soup, Repair_log& log)
{
  log.add("isolated vertex removed", "isolated vertices removed",
          PMP::remove_isolated_points_in_polygon_soup(soup.points, soup.polygons));
  log.add("vertex merged that had the position of another",
          "vertices merged that had the same position",
          PMP::merge_duplicate_points_in_polygon_soup(soup.points, soup.polygons));
  const bool simple = without_repetitions(soup, log);
  remove_fins(soup, log);
  if(simple) // a precondition of CGAL's
    log.add("copy of a face removed", "copies of faces removed",
            PMP::merge_duplicate_polygons_in_polygon_soup(soup.points, soup.polygons));
  const std::size_t before = soup.polygons.size();
  log.go_on();
  PMP::repair_polygon_soup(soup.points, soup.polygons);
  if(soup.polygons.size() < before)
    log.add("face removed that used a vertex twice", "faces removed that used a vertex twice",
            before - soup.polygons.size());
}

// Moves border vertices that all but lie on others there, also in `input`: where a surface was cut
// or coordinates were rounded.
void close_cracks(Exact_soup& soup, Polygon_soup& input, Repair_log& log)
{
  std::map<std::array<double, 3>, Kernel::Point_3> moved;
  const auto position = [](const auto& p) { return std::array<double, 3>{p.x(), p.y(), p.z()}; };
  for(const auto& [v, w] : diagnose(soup).cracks) { // w stays
    log.go_on();
    moved.emplace(position(soup.points[v]),
                  Kernel::Point_3(soup.points[w].x(), soup.points[w].y(), soup.points[w].z()));
    soup.points[v] = soup.points[w];
  }
  if(moved.empty())
    return;
  for(Kernel::Point_3& p : input.points) {
    log.go_on();
    if(const auto found = moved.find(position(p)); found != moved.end())
      p = found->second;
  }
  log.add("vertex of a crack moved onto another", "vertices of cracks moved onto others",
          moved.size());
  clean(soup, log);
}

// A triangle, and what lies on its sides between corner i and the next, in this order.
struct Split_triangle
{
  std::array<std::size_t, 3> corners;
  std::array<std::vector<std::size_t>, 3> on_side;
};

// Cuts a triangle from its corners to the vertices on its sides.
void add_parts(const Split_triangle& t, std::vector<std::vector<std::size_t>>& triangles)
{
  for(std::size_t i = 0; i < 3; ++i) {
    if(t.on_side[i].empty())
      continue;
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3, opposite = t.corners[k];
    std::vector<std::size_t> side = {t.corners[i]};
    side.insert(side.end(), t.on_side[i].begin(), t.on_side[i].end());
    side.push_back(t.corners[j]);
    for(std::size_t s = 0; s + 1 < side.size(); ++s)
      add_parts({{side[s], side[s + 1], opposite},
                 {std::vector<std::size_t>(),
                  s + 2 == side.size() ? t.on_side[j] : std::vector<std::size_t>(),
                  s == 0 ? t.on_side[k] : std::vector<std::size_t>()}},
                triangles);
    return;
  }
  triangles.push_back({t.corners[0], t.corners[1], t.corners[2]});
}

// The border vertices that lie on border edges, within the distance of cracks, in the order of each
// edge.
std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>>
vertices_on_edges(const Exact_soup& soup, const Repair_log& log)
{
  using Vector = Exact_predicates::Vector_3;
  // Border edges, sorted ends.
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> on_edge;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> opposite;
  for(const auto& t : soup.polygons)
    for(std::size_t i = 0; i < 3; ++i)
      opposite[std::minmax(t[i], t[(i + 1) % 3])].push_back(t[(i + 2) % 3]);
  std::vector<std::size_t> border;
  for(const auto& [edge, corners] : opposite)
    if(corners.size() == 1) {
      border.push_back(edge.first);
      border.push_back(edge.second);
    }
  std::sort(border.begin(), border.end());
  border.erase(std::unique(border.begin(), border.end()), border.end());
  const auto before = [&](const std::size_t v, const double x) { return soup.points[v].x() < x; };
  std::sort(border.begin(), border.end(), [&](const std::size_t v, const std::size_t w) {
    return before(v, soup.points[w].x());
  });
  const CGAL::Bbox_3 box = CGAL::bbox_3(soup.points.begin(), soup.points.end());
  const double largest = 1e-5 * std::sqrt(CGAL::square(box.x_span()) + CGAL::square(box.y_span()) +
                                          CGAL::square(box.z_span()));
  for(const auto& [edge, corners] : opposite) {
    log.go_on();
    if(corners.size() != 1)
      continue;
    const auto &p = soup.points[edge.first], &q = soup.points[edge.second];
    const Vector along = q - p;
    const double squared = along.squared_length();
    if(!(squared > 0))
      continue;
    const double reach = (std::min)(largest, 0.01 * std::sqrt(squared));
    std::vector<std::pair<double, std::size_t>> found;
    for(auto v = std::lower_bound(border.begin(), border.end(), (std::min)(p.x(), q.x()) - reach,
                                  before);
        v != border.end() && soup.points[*v].x() <= (std::max)(p.x(), q.x()) + reach; ++v) {
      const Vector there = soup.points[*v] - p;
      const double t = there * along / squared;
      if(*v != edge.first && *v != edge.second && *v != corners[0] && t > 0.02 && t < 0.98 &&
         (there - t * along).squared_length() <= reach * reach)
        found.emplace_back(t, *v);
    }
    std::sort(found.begin(), found.end());
    for(const auto& [t, v] : found)
      on_edge[edge].push_back(v);
  }
  return on_edge;
}

// Splits the edges of one sheet at the vertices of its neighbour that lie on them, where the
// neighbour is finer.
void close_t_junctions(Exact_soup& soup, Repair_log& log)
{
  const auto on_edge = vertices_on_edges(soup, log);
  if(on_edge.empty())
    return;
  std::vector<std::vector<std::size_t>> triangles;
  for(const auto& t : soup.polygons) {
    Split_triangle split{{t[0], t[1], t[2]}, {}};
    for(std::size_t i = 0; i < 3; ++i) {
      const std::size_t a = t[i], b = t[(i + 1) % 3];
      const auto found = on_edge.find(std::minmax(a, b));
      if(found == on_edge.end())
        continue;
      split.on_side[i] = found->second;
      if(a > b)
        std::reverse(split.on_side[i].begin(), split.on_side[i].end());
    }
    add_parts(split, triangles);
  }
  soup.polygons = std::move(triangles);
  log.add("edge split at the vertices that lie on it",
          "edges split at the vertices that lie on them", on_edge.size());
  clean(soup, log);
}

// Turns closed surfaces round whose volume is negative.
void turn_inside_out(Exact_soup& soup, Repair_log& log)
{
  Eigen::MatrixXd V(Eigen::Index(soup.points.size()), 3);
  for(std::size_t v = 0; v < soup.points.size(); ++v)
    V.row(Eigen::Index(v)) << soup.points[v].x(), soup.points[v].y(), soup.points[v].z();
  Eigen::MatrixXi T(Eigen::Index(soup.polygons.size()), 3);
  for(std::size_t t = 0; t < soup.polygons.size(); ++t)
    for(int i = 0; i < 3; ++i)
      T(Eigen::Index(t), i) = int(soup.polygons[t][std::size_t(i)]);
  const std::vector<Eigen::Index> turned = inside_out(V, T);
  for(const Eigen::Index t : turned)
    std::swap(soup.polygons[std::size_t(t)][1], soup.polygons[std::size_t(t)][2]);
  log.add("face of an inside-out body turned round", "faces of inside-out bodies turned round",
          turned.size());
}

// Splitting gives new vertices old positions, so that the direction of a face shows in its
// positions.
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

// The triangles of one polygon in its plane; where it has none, of the minimal surface that it
// bounds, or a fan.
std::vector<std::vector<std::size_t>> triangles_of(const Exact_soup& soup,
                                                   const std::vector<std::size_t>& polygon)
{
  std::vector<std::vector<std::size_t>> triangles;
  Exact_mesh mesh;
  std::vector<Exact_mesh::Vertex_index> corners;
  for(const std::size_t v : polygon)
    corners.push_back(mesh.add_vertex(soup.points[v]));
  // CGAL's function makes of corners on a line faces whose halfedges never come round.
  if(PMP::triangulate_face(mesh.add_face(corners), mesh) &&
     mesh.number_of_faces() == polygon.size() - 2 && CGAL::is_triangle_mesh(mesh)) {
    for(const auto f : mesh.faces()) {
      triangles.emplace_back();
      for(const auto v : vertices_around_face(mesh.halfedge(f), mesh))
        triangles.back().push_back(polygon[v]);
    }
    return triangles;
  }
  std::vector<Exact_predicates::Point_3> boundary;
  for(const std::size_t v : polygon)
    boundary.push_back(soup.points[v]);
  std::vector<CGAL::Triple<int, int, int>> triples;
  PMP::triangulate_hole_polyline(boundary, std::back_inserter(triples));
  if(triples.size() != polygon.size() - 2) {
    triples.clear();
    for(int i = 2; i < int(polygon.size()); ++i)
      triples.emplace_back(0, i - 1, i);
  }
  for(const auto& t : triples)
    triangles.push_back({polygon[std::size_t(t.first)], polygon[std::size_t(t.second)],
                         polygon[std::size_t(t.third)]});
  return triangles;
}

void triangulate(Exact_soup& soup, Repair_log& log)
{
  std::vector<std::vector<std::size_t>> triangles;
  std::size_t polygons = 0;
  for(const std::vector<std::size_t>& polygon : soup.polygons) {
    log.go_on();
    if(polygon.size() == 3) {
      triangles.push_back(polygon);
      continue;
    }
    ++polygons;
    for(const auto& triangle : triangles_of(soup, polygon))
      triangles.push_back(triangle);
  }
  if(polygons == 0)
    return;
  soup.polygons = std::move(triangles);
  log.add("polygon triangulated", "polygons triangulated", polygons);
  remove_fins(soup, log);
  log.add("copy of a face removed", "copies of faces removed",
          PMP::merge_duplicate_polygons_in_polygon_soup(soup.points, soup.polygons));
}

// Needles are collapsed, caps flipped; thresholds: edges of a ratio of a million, an angle of
// 179.9999 degrees. Where CGAL's function loses its way, as it may beside borders, the faces stay
// and the diagnosis names them.
void remove_degenerate_faces(Exact_mesh& mesh, Repair_log& log)
{
  const std::size_t before = mesh.number_of_faces();
  const Exact_mesh copy = mesh;
  const double ratio = 1e6, cosine = std::cos(std::acos(-1.) * 179.9999 / 180);
  try {
#if CGAL_VERSION_NR >= CGAL_VERSION_NUMBER(6, 0, 0)
    PMP::remove_almost_degenerate_faces(
        mesh, CGAL::parameters::needle_threshold(ratio).cap_threshold(cosine));
#else
    PMP::experimental::remove_almost_degenerate_faces(mesh, cosine, ratio, 0.);
#endif
  } catch(const CGAL::Failure_exception&) {
    mesh = copy;
    return;
  }
  mesh.collect_garbage();
  log.add("degenerate face removed", "degenerate faces removed", before - mesh.number_of_faces());
}

// Removes faces without area that no flip and no collapse mends: components of such faces alone,
// and from the border on those at vertices that have no others.
void remove_massless_faces(Exact_mesh& mesh, Repair_log& log)
{
  const auto part = mesh.add_property_map<Exact_mesh::Face_index, std::size_t>("f:part").first;
  const std::size_t parts = PMP::connected_components(mesh, part);
  std::vector<char> has_area(mesh.number_of_faces(), 0), has_mass(mesh.number_of_vertices(), 0),
      part_has_area(parts, 0);
  const auto row = [&](const Exact_mesh::Vertex_index v) {
    const auto& p = mesh.point(v);
    return Eigen::RowVector3d(p.x(), p.y(), p.z());
  };
  for(const auto f : mesh.faces()) {
    log.go_on();
    const auto h = mesh.halfedge(f);
    const auto u = mesh.source(h), v = mesh.target(h), w = mesh.target(mesh.next(h));
    has_area[f] = CGAL::Spectral_geometry::triangle_cotangents(row(u), row(v), row(w)).area != 0;
    part_has_area[part[f]] |= has_area[f];
    for(const auto x : {u, v, w})
      has_mass[x] |= has_area[f];
  }
  std::vector<Exact_mesh::Face_index> next(mesh.faces().begin(), mesh.faces().end());
  std::size_t removed = 0;
  while(!next.empty()) {
    const auto f = next.back();
    next.pop_back();
    if(mesh.is_removed(f) || has_area[f])
      continue;
    const auto h = mesh.halfedge(f);
    bool massless = false, at_border = !part_has_area[part[f]];
    std::vector<Exact_mesh::Face_index> beside;
    for(const auto g : mesh.halfedges_around_face(h)) {
      massless = massless || !has_mass[mesh.target(g)];
      if(mesh.is_border(mesh.opposite(g)))
        at_border = true;
      else
        beside.push_back(mesh.face(mesh.opposite(g)));
    }
    if(!massless || !at_border)
      continue;
    CGAL::Euler::remove_face(h, mesh);
    ++removed;
    next.insert(next.end(), beside.begin(), beside.end());
  }
  mesh.collect_garbage();
  log.add("degenerate face removed", "degenerate faces removed", removed);
  const std::size_t before = std::size_t(std::count(part_has_area.begin(), part_has_area.end(), 1));
  if(const std::size_t after = PMP::connected_components(mesh, part); after > before)
    log.add("part separated that only faces without area had joined",
            "parts separated that only faces without area had joined", after - before);
}

// The result in the order of `input`, and how the vertices of both belong together: by their
// positions, as what follows the closing of cracks moves no vertex, and leaves one where several
// had been.
Polygon_soup in_order(const Exact_soup& result, const Polygon_soup& input,
                      const std::vector<bool>& used, std::vector<std::size_t>& vertex,
                      std::vector<std::size_t>& origin)
{
  std::map<std::array<double, 3>, std::size_t> places; // and the first vertex of the input there
  const auto position = [](const auto& p) { return std::array<double, 3>{p.x(), p.y(), p.z()}; };
  for(std::size_t v = 0; v < input.points.size(); ++v)
    if(used[v])
      places.emplace(position(input.points[v]), v);
  std::vector<std::pair<std::size_t, std::size_t>> order;
  for(std::size_t w = 0; w < result.points.size(); ++w)
    order.emplace_back(places.at(position(result.points[w])), w);
  std::sort(order.begin(), order.end());

  Polygon_soup soup;
  std::vector<std::size_t> rank(order.size()), first(input.points.size(), no_vertex);
  origin.clear();
  for(const auto& [v, w] : order) {
    rank[w] = soup.points.size();
    first[v] = (std::min)(first[v], rank[w]);
    soup.points.emplace_back(result.points[w].x(), result.points[w].y(), result.points[w].z());
    origin.push_back(v);
  }
  soup.polygons = result.polygons;
  for(auto& polygon : soup.polygons)
    for(std::size_t& w : polygon)
      w = rank[w];
  vertex.assign(input.points.size(), no_vertex);
  for(std::size_t v = 0; v < vertex.size(); ++v)
    if(used[v])
      vertex[v] = first[places.at(position(input.points[v]))];
  return soup;
}

} // namespace

Polygon_soup repaired_soup(const Polygon_soup& file, Repair_log& log,
                           std::vector<std::size_t>& vertex, std::vector<std::size_t>& origin)
{
  const Silence silence; // what CGAL warns of, the diagnosis says better
  Polygon_soup input{file.points, {}};
  Exact_soup soup = usable_part(file, log);
  std::vector<bool> used(input.points.size(), false);
  for(const auto& polygon : soup.polygons)
    for(const std::size_t v : polygon)
      used[v] = true;
  clean(soup, log);
  triangulate(soup, log);
  close_cracks(soup, input, log);
  close_t_junctions(soup, log);
  orient(soup, log);
  turn_inside_out(soup, log);
  Exact_mesh mesh = to_mesh(soup);
  log.add("pair of border edges stitched", "pairs of border edges stitched",
          PMP::stitch_borders(mesh));
  mesh.collect_garbage();
  const auto diagnosis = diagnose(to_soup(mesh));
  if(diagnosis.zero_area_faces.count != 0 || diagnosis.overflowing_faces.count != 0) {
    remove_degenerate_faces(mesh, log);
    remove_massless_faces(mesh, log);
  }
  log.add("vertex doubled to separate sheets", "vertices doubled to separate sheets",
          PMP::duplicate_non_manifold_vertices(mesh));
  log.add("isolated vertex removed", "isolated vertices removed",
          PMP::remove_isolated_vertices(mesh));
  mesh.collect_garbage();

  return in_order(to_soup(mesh), input, used, vertex, origin);
}
