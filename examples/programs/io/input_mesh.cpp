// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "input_mesh.h"

#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

#include <CGAL/exceptions.h>

#include <boost/functional/hash.hpp>
#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <unordered_set>
#include <utility>

namespace {

using CGAL::Spectral_geometry::Mesh_diagnosis;
using CGAL::Spectral_geometry::Mesh_finding;
using Polygons = std::vector<std::vector<std::size_t>>;

// Polygons with vertices of the file, and which of these have become one.
struct Mended
{
  Polygons polygons;
  std::vector<std::size_t> vertex; // the one that stands for each
  Repair_log log;
};

// Merges the ends of edges without length; what is no polygon then goes.
void close_edges(const Polygon_soup& soup, Mended& mended)
{
  boost::disjoint_sets_with_storage<> sets(soup.points.size());
  for(const auto& p : mended.polygons)
    for(std::size_t i = 0; i < p.size(); ++i) {
      const std::size_t v = p[i], w = p[(i + 1) % p.size()];
      if(soup.points[v] == soup.points[w])
        sets.union_set(v, w);
    }
  std::size_t merged = 0;
  std::vector<std::size_t> first_of(mended.vertex.size(),
                                    mended.vertex.size()); // by representatives
  for(std::size_t v = 0; v < mended.vertex.size(); ++v) {
    std::size_t& first = first_of[sets.find_set(v)];
    first = (std::min)(first, v);
    mended.vertex[v] = first;
    merged += mended.vertex[v] != v;
  }
  for(auto& p : mended.polygons) {
    for(std::size_t& v : p)
      v = mended.vertex[v];
    p.erase(std::unique(p.begin(), p.end()), p.end());
    while(p.size() > 1 && p.front() == p.back())
      p.pop_back();
  }
  mended.polygons.erase(std::remove_if(mended.polygons.begin(), mended.polygons.end(),
                                       [](const auto& p) { return p.size() < 3; }),
                        mended.polygons.end());
  mended.log.add("edge without length closed", "edges without length closed", merged);
}

void remove_copies(Mended& mended)
{
  const std::size_t before = mended.polygons.size();
  std::unordered_set<std::vector<std::size_t>, boost::hash<std::vector<std::size_t>>> known;
  mended.polygons.erase(std::remove_if(mended.polygons.begin(), mended.polygons.end(),
                                       [&](std::vector<std::size_t> p) {
                                         std::sort(p.begin(), p.end());
                                         return !known.insert(std::move(p)).second;
                                       }),
                        mended.polygons.end());
  mended.log.add("copy of a face removed", "copies of faces removed",
                 before - mended.polygons.size());
}

// Sets of faces that agree with one of them, or are contrary to it.
class Orientations
{
public:
  explicit Orientations(const std::size_t n)
    : m_parent(n)
    , m_contrary(n, 0)
  {
    std::iota(m_parent.begin(), m_parent.end(), std::size_t(0));
  }

  // The face that stands for the set of f, and whether f is contrary to it.
  std::pair<std::size_t, bool> find(std::size_t f)
  {
    bool contrary = false;
    while(m_parent[f] != f) {
      const std::size_t p = m_parent[f];
      m_contrary[f] ^= m_contrary[p];
      m_parent[f] = m_parent[p];
      contrary ^= m_contrary[f] != 0;
      f = m_parent[f];
    }
    return {f, contrary};
  }

  // False if it is known to be otherwise.
  bool unite(const std::size_t f, const std::size_t g, const bool contrary)
  {
    const auto a = find(f), b = find(g);
    const bool differs = (a.second != b.second) != contrary;
    if(a.first == b.first)
      return !differs;
    m_parent[(std::max)(a.first, b.first)] = (std::min)(a.first, b.first);
    m_contrary[(std::max)(a.first, b.first)] = differs;
    return true;
  }

private:
  std::vector<std::size_t> m_parent;
  std::vector<char> m_contrary; // to its parent
};

// Turns the smaller part of each component round where its faces then agree along all edges, and no
// faces otherwise.
void orient(Mended& mended)
{
  using Side = std::tuple<std::size_t, std::size_t, std::size_t, bool>; // ends, face, direction
  const auto sides = CGAL::Spectral_geometry::internal::sorted_by_vertex<Side>(
      mended.vertex.size(), [&](const auto& add) {
        for(std::size_t f = 0; f < mended.polygons.size(); ++f) {
          const auto& p = mended.polygons[f];
          for(std::size_t i = 0; i < p.size(); ++i) {
            const std::size_t v = p[i], w = p[i + 1 == p.size() ? 0 : i + 1];
            add((std::min)(v, w), {(std::min)(v, w), (std::max)(v, w), f, v < w});
          }
        }
      });
  const auto same_edge = [&](const std::size_t i, const std::size_t j) {
    return j < sides.size() && std::get<0>(sides[i]) == std::get<0>(sides[j]) &&
           std::get<1>(sides[i]) == std::get<1>(sides[j]);
  };
  Orientations faces(mended.polygons.size());
  for(std::size_t i = 0; i < sides.size(); ++i)
    if(same_edge(i, i + 1)) {
      const bool contrary = std::get<3>(sides[i]) == std::get<3>(sides[i + 1]);
      if(same_edge(i, i + 2) ||
         !faces.unite(std::get<2>(sides[i]), std::get<2>(sides[i + 1]), contrary))
        return; // branched, or one-sided
      ++i;
    }
  std::vector<std::ptrdiff_t> majority(mended.polygons.size(),
                                       0); // those that agree less those that do not
  for(std::size_t f = 0; f < majority.size(); ++f) {
    const auto [first, contrary] = faces.find(f);
    majority[first] += contrary ? -1 : 1;
  }
  std::size_t turned = 0;
  for(std::size_t f = 0; f < majority.size(); ++f) {
    const auto [first, contrary] = faces.find(f);
    if(contrary == (majority[first] >= 0)) {
      std::reverse(mended.polygons[f].begin(), mended.polygons[f].end());
      ++turned;
    }
  }
  mended.log.add("face turned round", "faces turned round", turned);
}

Mended mended(const Polygon_soup& soup, const bool merge, const bool copies)
{
  Mended result;
  result.polygons = soup.polygons;
  result.vertex.resize(soup.points.size());
  std::iota(result.vertex.begin(), result.vertex.end(), std::size_t(0));
  if(merge)
    close_edges(soup, result);
  if(merge || copies) // merging makes some
    remove_copies(result);
  orient(result);
  return result;
}

// The repair closes cracks; what is left is where it has separated sheets that share an edge or a
// vertex.
std::string still_cut(const Mesh_diagnosis& diagnosis, const std::vector<std::size_t>& origin)
{
  if(diagnosis.cracks.empty())
    return "";
  const std::size_t n = diagnosis.cracks.size();
  return "The surface is still cut at " + std::to_string(n) +
         (n == 1 ? " border vertex that lies" : " border vertices that lie") +
         " on another, where --repair had to separate sheets, the first is vertex " +
         std::to_string(origin[diagnosis.cracks.front().first]) +
         " of INPUT (counted from 0): functions may jump there.";
}

// Gives obstacles in a repaired soup the numbers of the file, and the totals. `vertex` says which
// of the soup each vertex of the file has become, `origin` the contrary; a face has the number of
// the polygon with most of its vertices.
void number_as_in_file(Mesh_diagnosis& d, const Polygon_soup& repaired, const Polygon_soup& file,
                       const std::vector<std::size_t>& vertex,
                       const std::vector<std::size_t>& origin)
{
  const auto face_of_file = [&](const std::size_t f) {
    const std::vector<std::size_t>& face = repaired.polygons[f];
    std::pair<std::size_t, std::size_t> best{0, 0}; // shared vertices, polygon
    for(std::size_t p = 0; p < file.polygons.size() && best.first < face.size(); ++p) {
      std::size_t shared = 0;
      for(const std::size_t v : face) // one of those that have the position, if it was doubled
        shared += std::any_of(file.polygons[p].begin(), file.polygons[p].end(), [&](std::size_t w) {
          return w < vertex.size() && vertex[w] != no_vertex && origin[vertex[w]] == origin[v];
        });
      if(shared > best.first)
        best = {shared, p};
    }
    return best.second;
  };
  // A halfedge mesh without isolated vertices has no other obstacles.
  if(d.massless_vertices.count != 0)
    d.massless_vertices.first = origin[d.massless_vertices.first];
  for(Mesh_finding* const finding : {&d.overflowing_faces, &d.duplicate_faces})
    if(finding->count != 0) {
      finding->first = face_of_file(finding->first);
      finding->second = face_of_file(finding->second);
    }
  d.number_of_vertices = file.points.size();
  d.number_of_faces = repaired.polygons.empty() ? 0 : file.polygons.size();
}

// " 2 faces turned round, 1 isolated vertex left out"
std::string list_of(const std::vector<Repair>& changes)
{
  std::string list;
  for(const Repair& change : changes)
    list += (list.empty() ? " " : ", ") + std::to_string(change.count) + " " + change.what();
  return list;
}

std::string help_with(const Mesh_diagnosis& diagnosis, const Mending mending)
{
  // Such a mesh is told to be scaled, and no repair does that.
  if(diagnosis.out_of_scale() && diagnosis.non_finite_vertices.count == 0)
    return "";
  return mending == Mending::full ? ", which --repair could not do" : ", or add --repair";
}

// Leaves out the faces of components of less than a share of the area; their vertices are then
// isolated.
void drop_debris(Input_mesh& input, Polygon_soup& soup, const std::vector<std::size_t>& origin,
                 const double share)
{
  using CGAL::Spectral_geometry::Mesh_component;
  const std::vector<Mesh_component>& components = input.diagnosis.components;
  double area = 0;
  for(const Mesh_component& c : components)
    area += c.area;
  boost::disjoint_sets_with_storage<> sets(soup.points.size());
  for(const auto& p : soup.polygons)
    for(const std::size_t v : p)
      sets.union_set(p[0], v);
  std::vector<char> is_debris(soup.points.size(), 0); // by representatives
  for(const Mesh_component& c : components)
    if(c.area < share * area) {
      is_debris[sets.find_set(c.first)] = 1;
      input.left_out.push_back(origin[c.first]);
    }
  const std::size_t left_out = input.left_out.size();
  if(left_out == 0)
    return;
  if(left_out == components.size())
    throw std::runtime_error("no component has the share of the area that --drop-debris asks for: "
                             "lower it.");
  soup.polygons.erase(
      std::remove_if(soup.polygons.begin(), soup.polygons.end(),
                     [&](const auto& p) { return is_debris[sets.find_set(p[0])] != 0; }),
      soup.polygons.end());
  const bool is_cut = !input.diagnosis.cracks.empty();
  input.diagnosis = diagnose(soup);
  input.diagnosis.isolated_vertices = {};
  if(!is_cut)
    input.diagnosis.cracks.clear();
  input.changes.push_back({"component left out", "components left out", left_out});
}

// Makes the mesh of a soup without what `diagnosis` calls isolated vertices. `vertex` says which
// vertex of the soup stands for each vertex of the file, or is `no_vertex`; `origin` says where
// each vertex of the soup is in the file.
void build(Input_mesh& input, const std::string& name, const Mending mending, Polygon_soup soup,
           const std::vector<std::size_t>& vertex, const std::vector<std::size_t>& origin)
{
  Mesh_diagnosis& diagnosis = input.diagnosis;
  const std::vector<std::string> obstacles = diagnosis.obstacles();
  if(!obstacles.empty())
    throw std::runtime_error(name + " cannot be used as it is: " + obstacles.front() +
                             help_with(diagnosis, mending) + ".");
  if(diagnosis.number_of_faces == 0) {
    const std::string changes = list_of(input.changes);
    throw std::runtime_error(name + " has no faces left" +
                             (changes.empty() ? help_with(diagnosis, mending) : ":" + changes) +
                             ".");
  }
  std::vector<std::size_t> place(soup.points.size(), no_vertex), file_vertices;
  for(const auto& p : soup.polygons)
    for(const std::size_t v : p)
      place[v] = 0;
  std::size_t n = 0;
  for(std::size_t v = 0; v < place.size(); ++v)
    if(place[v] == 0) {
      place[v] = n;
      soup.points[n++] = soup.points[v];
      file_vertices.push_back(origin[v]);
    }
  if(n < soup.points.size()) {
    soup.points.resize(n);
    for(auto& p : soup.polygons)
      for(std::size_t& v : p)
        v = place[v];
  }
  std::vector<std::size_t> mesh_vertices;
  for(const std::size_t v : vertex)
    mesh_vertices.push_back(v == no_vertex ? no_vertex : place[v]);
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(soup.points, soup.polygons,
                                                              input.mesh);
  input.numbering = Vertex_numbering(std::move(mesh_vertices), std::move(file_vertices));
  for(CGAL::Spectral_geometry::Mesh_component& c : diagnosis.components)
    c.first = origin[c.first];
}

// The coordinates at the corners of polygons, which each vertex has the same of where the file has
// them at vertices.
Corner_texture texture_of(const Polygon_soup& soup)
{
  Corner_texture texture = soup.texture;
  const auto t = soup.attributes.find(std::array<const char*, 2>{"s", "t"});
  if(texture.empty() && t[0] != nullptr)
    for(const auto& p : soup.polygons)
      for(const std::size_t v : p)
        texture.push_back(v < soup.points.size() ? Texture_point{t[0]->values[v], t[1]->values[v]}
                                                 : Texture_point{});
  return texture;
}

// Which polygons of the file the faces of the mesh are parts of: those that have their vertices,
// also where some of these have become one.
class Origins_of_faces
{
public:
  Origins_of_faces(const Input_mesh& input, const Polygons& polygons)
    : m_input(input)
    , m_polygons(polygons)
    , m_polygons_at(input.numbering.number_of_file_vertices())
  {
    for(std::size_t p = 0; p < polygons.size(); ++p)
      for(const std::size_t v : polygons[p])
        if(vertex(v) != no_vertex)
          m_polygons_at[vertex(v)].push_back(p);
  }

  // One that has all vertices of the face, or none.
  std::size_t whole(const Mesh::Face_index f) const
  {
    const auto [polygon, shared] = best(f);
    return shared == 3 ? polygon : no_vertex;
  }

  // One that has as many as any.
  std::size_t nearest(const Mesh::Face_index f) const { return best(f).first; }

  // The corner of a polygon that is this vertex of the mesh, or as many as it has.
  std::size_t corner(const std::size_t polygon, const Mesh::Vertex_index v) const
  {
    const auto& corners = m_polygons[polygon];
    const auto at = std::find_if(corners.begin(), corners.end(), [&](const std::size_t w) {
      return vertex(w) == m_input.numbering.file_vertex(v);
    });
    return std::size_t(at - corners.begin());
  }

private:
  // The vertex of the file that stands for v, or none.
  std::size_t vertex(const std::size_t v) const
  {
    const Vertex_numbering& numbering = m_input.numbering;
    const std::size_t w =
        v < numbering.number_of_file_vertices() ? numbering.mesh_vertex(v) : no_vertex;
    return w == no_vertex ? w : numbering.file_vertex(w);
  }

  std::pair<std::size_t, std::size_t> best(const Mesh::Face_index f) const
  {
    const Mesh& mesh = m_input.mesh;
    std::pair<std::size_t, std::size_t> result{no_vertex, 0};
    for(const auto v : mesh.vertices_around_face(mesh.halfedge(f)))
      for(const std::size_t p : m_polygons_at[m_input.numbering.file_vertex(v)]) {
        std::size_t shared = 0;
        for(const auto w : mesh.vertices_around_face(mesh.halfedge(f)))
          shared += corner(p, w) < m_polygons[p].size();
        if(shared > result.second)
          result = {p, shared};
        if(shared == 3)
          return result;
      }
    return result;
  }

  const Input_mesh& m_input;
  const Polygons& m_polygons;
  Polygons m_polygons_at; // by vertices of the file
};

// Gives the corners of the mesh what those of the file's polygons have.
void set_texture(Input_mesh& input, const Polygons& polygons, const Corner_texture& texture)
{
  const Origins_of_faces origins(input, polygons);
  std::vector<std::size_t> begin(1, 0); // of the corners of each
  for(const auto& polygon : polygons)
    begin.push_back(begin.back() + polygon.size());
  const Mesh& mesh = input.mesh;
  input.texture.resize(mesh.num_halfedges());
  for(const auto f : mesh.faces()) {
    const std::size_t p = origins.whole(f);
    if(p == no_vertex) {
      input.texture.clear();
      input.without_texture = "the repair has made faces that are no part of one of the file";
      return;
    }
    for(const auto h : mesh.halfedges_around_face(mesh.halfedge(f)))
      input.texture[h] = texture[begin[p] + origins.corner(p, mesh.target(h))];
  }
}

// Gives the faces of the mesh what the polygons of the file have.
void set_face_attributes(Input_mesh& input, const Polygons& polygons, const Attributes& attributes)
{
  const Origins_of_faces origins(input, polygons);
  input.face_attributes = attributes;
  for(Attribute& a : input.face_attributes.known)
    a.values.clear();
  for(const auto f : input.mesh.faces()) {
    const std::size_t p = origins.nearest(f);
    for(std::size_t k = 0; k < attributes.known.size(); ++k)
      input.face_attributes.known[k].values.push_back(
          p == no_vertex ? 0. : attributes.known[k].values[p]);
  }
}

} // namespace

std::string Input_mesh::size_of(const std::string& path) const
{
  const std::size_t n = mesh.number_of_vertices(), in_file = numbering.number_of_file_vertices();
  return "'" + path + "' has " + std::to_string(n) + " vertices" +
         (in_file == n ? "" : ", and " + std::to_string(in_file) + " before it was cleaned");
}

std::string Input_mesh::changes_of(const std::string& path) const
{
  const std::string list = list_of(changes);
  if(list.empty())
    return "";
  std::string debris;
  for(std::size_t i = 0; i < (std::min)(left_out.size(), std::size_t(10)); ++i)
    debris +=
        (i == 0 ? " The components left out begin at vertex " : ", ") + std::to_string(left_out[i]);
  if(!left_out.empty())
    debris += std::string(left_out.size() > 10 ? " and so on" : "") + ", counted from 0.";
  return "'" + path + "':" + list + "." + debris;
}

Input_mesh read_input_mesh(const std::string& path, const Mending mending,
                           const bool with_attributes, const double debris,
                           const std::function<bool()>& keep_going)
{
  return input_mesh(read_polygon_soup(path), "'" + path + "'", mending, with_attributes, debris,
                    keep_going);
}

Input_mesh input_mesh(Polygon_soup soup, const std::string& name, const Mending mending,
                      const bool with_attributes, const double debris,
                      const std::function<bool()>& keep_going)
{
  Input_mesh input;
  const Corner_texture texture = with_attributes ? texture_of(soup) : Corner_texture();
  const Attributes face_attributes =
      with_attributes ? std::move(soup.face_attributes) : Attributes();
  const Polygons polygons =
      texture.empty() && face_attributes.known.empty() ? Polygons() : soup.polygons;
  if(with_attributes) {
    input.face_attributes.unknown = face_attributes.unknown;
    input.material_libraries = std::move(soup.material_libraries);
    input.without_texture = std::move(soup.without_texture);
    input.attributes = std::move(soup.attributes);
  }
  soup = Polygon_soup{std::move(soup.points), std::move(soup.polygons)}; // no more is needed
  Repair_log log(keep_going);
  std::vector<std::size_t> vertex(soup.points.size()), origin;
  std::iota(vertex.begin(), vertex.end(), std::size_t(0));
  if(mending == Mending::full) {
    Polygon_soup repaired;
    try {
      repaired = repaired_soup(soup, log, vertex, origin);
    } catch(const CGAL::Failure_exception&) {
      throw std::runtime_error(
          name + " cannot be repaired: CGAL's functions contradict themselves on it.");
    }
    input.diagnosis = diagnose(repaired);
    input.still_cut = still_cut(input.diagnosis, origin);
    number_as_in_file(input.diagnosis, repaired, soup, vertex, origin);
    input.diagnosis.cracks.clear(); // what helps there is no repair
    soup = std::move(repaired);
  } else {
    input.diagnosis = diagnose(soup);
    origin = vertex;
    // Not before every face is one.
    const Mesh_diagnosis& d = input.diagnosis;
    if(mending == Mending::plain &&
       d.non_finite_vertices.count + d.foreign_indices.count + d.repeated_vertices.count == 0) {
      const bool merge = d.zero_length_edges.count != 0;
      if(merge || d.duplicate_faces.count + d.misoriented_edges.count != 0) {
        for(const bool merging : {true, false}) {
          if(merging && !merge)
            continue;
          Mended candidate = mended(soup, merging, d.duplicate_faces.count != 0);
          Polygon_soup changed{soup.points, candidate.polygons};
          Mesh_diagnosis diagnosis = diagnose(changed);
          diagnosis.isolated_vertices = {};
          // Where merging leaves an obstacle, the simplification deals with such edges.
          if(!merging || diagnosis.usable()) {
            soup = std::move(changed);
            vertex = std::move(candidate.vertex);
            input.diagnosis = std::move(diagnosis);
            log = std::move(candidate.log);
            break;
          }
        }
      }
      input.diagnosis.isolated_vertices = {};
      std::vector<bool> used(soup.points.size(), false);
      for(const auto& p : soup.polygons)
        for(const std::size_t v : p)
          used[v] = true;
      std::size_t isolated = 0;
      for(std::size_t& v : vertex)
        if(!used[v]) {
          v = no_vertex;
          ++isolated;
        }
      log.add("isolated vertex left out", "isolated vertices left out", isolated);
    }
  }
  input.changes = log.changes();
  if(debris > 0 && input.diagnosis.usable())
    drop_debris(input, soup, origin, debris);
  build(input, name, mending, std::move(soup), vertex, origin);
  if(!texture.empty())
    set_texture(input, polygons, texture);
  if(!face_attributes.known.empty())
    set_face_attributes(input, polygons, face_attributes);
  return input;
}
