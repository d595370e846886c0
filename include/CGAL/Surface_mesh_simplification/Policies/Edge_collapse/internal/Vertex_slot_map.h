// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_VERTEX_SLOT_MAP_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_VERTEX_SLOT_MAP_H

#include <CGAL/license/Surface_mesh_simplification.h>

#include <CGAL/Surface_mesh/Surface_mesh_fwd.h>
#include <CGAL/boost/graph/properties.h>

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>

namespace CGAL {
namespace Surface_mesh_simplification {
namespace internal {

/// A number for each vertex of a mesh that follows it when garbage is collected; 0 for vertices that were added later. May be
/// destroyed after the mesh.
template <class TriangleMesh>
class Vertex_slot_map
{
public:
  using vertex_descriptor = typename boost::graph_traits<TriangleMesh>::vertex_descriptor;

  explicit Vertex_slot_map(TriangleMesh& mesh)
    : m_map(get(dynamic_vertex_property_t<Eigen::Index>(), mesh))
  {}

  /// Whether the mesh still holds the numbers. False after it has been assigned to; true where that cannot be told.
  bool attach(const TriangleMesh&) { return true; }

  Eigen::Index operator[](const vertex_descriptor v) const { return get(m_map, v); }
  void set(const vertex_descriptor v, const Eigen::Index number) { put(m_map, v, number); }

private:
  typename boost::property_map<TriangleMesh, dynamic_vertex_property_t<Eigen::Index>>::type m_map;
};

/// The dynamic properties of a `Surface_mesh` are removed from it when their map is destroyed, and are lost without notice when it
/// is assigned to. So this is a property with a name, which is looked up; what nobody uses any more goes when the next one is made.
template <class Point>
class Vertex_slot_map<Surface_mesh<Point>>
{
public:
  using Triangle_mesh = Surface_mesh<Point>;
  using vertex_descriptor = typename boost::graph_traits<Triangle_mesh>::vertex_descriptor;

  explicit Vertex_slot_map(Triangle_mesh& mesh)
    : m_name(Names::add())
  {
    for(const std::string& name : mesh.template properties<vertex_descriptor>())
      if(Names::is_abandoned(name)) {
        auto found = mesh.template property_map<vertex_descriptor, Number>(name);
        if(is_there(found))
          mesh.remove_property_map(map_of(found));
      }
    m_map = mesh.template add_property_map<vertex_descriptor, Number>(*m_name, Number()).first;
  }

  bool attach(const Triangle_mesh& mesh)
  {
    auto found = mesh.template property_map<vertex_descriptor, Number>(*m_name);
    if(!is_there(found))
      return false;
    m_map = map_of(found);
    return true;
  }

  Eigen::Index operator[](const vertex_descriptor v) const { return m_map[v].value; }
  void set(const vertex_descriptor v, const Eigen::Index number) { m_map[v].value = number; }

private:
  // Not a number: what writes all properties of a mesh that it knows the types of leaves it out.
  struct Number
  {
    Eigen::Index value = 0;
  };
  using Map = typename Triangle_mesh::template Property_map<vertex_descriptor, Number>;

  // A pair before CGAL 6, an optional since.
  static bool is_there(const std::pair<Map, bool>& found) { return found.second; }
  template <class Optional>
  static bool is_there(const Optional& found)
  {
    return bool(found);
  }
  static Map& map_of(std::pair<Map, bool>& found) { return found.first; }
  template <class Optional>
  static Map& map_of(Optional& found)
  {
    return *found;
  }

  // The names that are in use, of all meshes of this type: a copy of a mesh has its properties, too.
  class Names
  {
  public:
    static std::shared_ptr<const std::string> add()
    {
      const std::lock_guard<std::mutex> lock(names().m_mutex);
      const std::string name = prefix() + std::to_string(names().m_next++);
      names().m_used.insert(name);
      return std::shared_ptr<const std::string>(new std::string(name), [](const std::string* gone) {
        const std::lock_guard<std::mutex> lock(names().m_mutex);
        names().m_used.erase(*gone);
        delete gone;
      });
    }

    static bool is_abandoned(const std::string& name)
    {
      const std::lock_guard<std::mutex> lock(names().m_mutex);
      return name.compare(0, prefix().size(), prefix()) == 0 && names().m_used.count(name) == 0;
    }

  private:
    static std::string prefix() { return "v:spectral_slot_"; }
    // Never destroyed: a map in static memory may be destroyed later.
    static Names& names()
    {
      static Names& result = *new Names;
      return result;
    }

    std::mutex m_mutex;
    std::set<std::string> m_used;
    std::size_t m_next = 0;
  };

  std::shared_ptr<const std::string> m_name;
  Map m_map;
};

} // namespace internal
} // namespace Surface_mesh_simplification
} // namespace CGAL

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_VERTEX_SLOT_MAP_H
