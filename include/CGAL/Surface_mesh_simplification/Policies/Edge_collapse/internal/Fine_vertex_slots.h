// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_FINE_VERTEX_SLOTS_H
#define CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_FINE_VERTEX_SLOTS_H

#include <CGAL/Named_function_parameters.h>
#include <CGAL/Surface_mesh/Surface_mesh_fwd.h>
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/properties.h>
#include <CGAL/number_utils.h>

#include <CGAL/Spectral_geometry/internal/surface/connectivity.h>

#include <iterator>
#include <mutex>

namespace CGAL::Surface_mesh_simplification::internal {

template <class Point>
Eigen::Vector3d to_vector(const Point& p)
{
  return Eigen::Vector3d(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
}

/// alpha = (x - u).(v - u) / |v - u|^2 clamped to [0,1], the weight of `v` when the edge (u, v) is
/// collapsed to x (appendix A of Lescoat et al. 2020); 1/2 on an edge without length, where no end
/// is closer to x than the other.
inline double projected_edge_weight(const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                                    const Eigen::Vector3d& x)
{
  const Eigen::Vector3d edge = v - u;
  const double squared_length = edge.squaredNorm();
  if(!(squared_length > 0))
    return 0.5;
  return (std::min)((std::max)(edge.dot(x - u) / squared_length, 0.), 1.);
}

/// A number for each vertex of a mesh that follows it when garbage is collected; 0 for vertices
/// that were added later. May be destroyed after the mesh.
template <class TriangleMesh>
class Vertex_slot_map
{
public:
  using vertex_descriptor = typename boost::graph_traits<TriangleMesh>::vertex_descriptor;

  explicit Vertex_slot_map(TriangleMesh& mesh)
    : m_map(get(dynamic_vertex_property_t<Eigen::Index>(), mesh))
  {}

  /// Whether the mesh still holds the numbers. False after it has been assigned to; true where that
  /// cannot be told.
  bool attach(const TriangleMesh&) { return true; }

  Eigen::Index operator[](const vertex_descriptor v) const { return get(m_map, v); }
  void set(const vertex_descriptor v, const Eigen::Index number) { put(m_map, v, number); }

private:
  typename boost::property_map<TriangleMesh, dynamic_vertex_property_t<Eigen::Index>>::type m_map;
};

/// A `Surface_mesh` loses a dynamic property when its map is destroyed, and without notice when a
/// mesh is assigned to it. So this is a named property, which is looked up. Properties that nobody
/// uses any more are removed when the next one is made.
template <class Point>
class Vertex_slot_map<Surface_mesh<Point>>
{
public:
  using Triangle_mesh = Surface_mesh<Point>;
  using vertex_descriptor = typename boost::graph_traits<Triangle_mesh>::vertex_descriptor;

  explicit Vertex_slot_map(Triangle_mesh& mesh)
  {
    // The names in use, of all meshes of this type: a copy of a mesh has its properties, too.
    static std::mutex mutex;
    static std::vector<std::shared_ptr<const std::string>> names;
    static std::size_t next = 0;
    const std::string prefix = "v:spectral_slot_";
    const std::lock_guard<std::mutex> lock(mutex);
    names.erase(std::remove_if(names.begin(), names.end(),
                               [](const auto& name) { return name.use_count() == 1; }),
                names.end());
    for(const std::string& name : mesh.template properties<vertex_descriptor>())
      if(name.compare(0, prefix.size(), prefix) == 0 &&
         std::none_of(names.begin(), names.end(), [&](const auto& used) { return *used == name; }))
        if(std::optional<Map> map = look_up(mesh, name))
          mesh.remove_property_map(*map);
    m_name = std::make_shared<const std::string>(prefix + std::to_string(next++));
    names.push_back(m_name);
    m_map = mesh.template add_property_map<vertex_descriptor, Number>(*m_name, Number()).first;
  }

  bool attach(const Triangle_mesh& mesh)
  {
    const std::optional<Map> map = look_up(mesh, *m_name);
    m_map = map.value_or(m_map);
    return map.has_value();
  }

  Eigen::Index operator[](const vertex_descriptor v) const { return m_map[v].value; }
  void set(const vertex_descriptor v, const Eigen::Index number) { m_map[v].value = number; }

private:
  // Not a plain number: code that writes all properties of known types then leaves it out.
  struct Number
  {
    Eigen::Index value = 0;
  };
  using Map = typename Triangle_mesh::template Property_map<vertex_descriptor, Number>;

  static std::optional<Map> look_up(const Triangle_mesh& mesh, const std::string& name)
  {
#if CGAL_VERSION_NR >= 1060000900
    return mesh.template property_map<vertex_descriptor, Number>(name);
#else
    const auto found = mesh.template property_map<vertex_descriptor, Number>(name);
    return found.second ? std::optional<Map>(found.first) : std::nullopt;
#endif
  }

  std::shared_ptr<const std::string> m_name;
  Map m_map;
};

/// Which column of the restriction a vertex stands for: its position in `vertices(mesh)` at
/// construction, kept while the mesh is collapsed and its garbage collected.
template <class TriangleMesh>
class Fine_vertex_slots
{
public:
  using Triangle_mesh = TriangleMesh;
  using vertex_descriptor = typename boost::graph_traits<Triangle_mesh>::vertex_descriptor;

  /// A Surface_mesh is given a property, which keeps the slots right when its garbage is collected.
  Fine_vertex_slots(Triangle_mesh& mesh, const std::string& owner)
    : m_mesh(&mesh)
    , m_owner(owner)
    , m_slots(mesh)
  {
    for(const vertex_descriptor v : vertices(mesh))
      m_slots.set(v, ++m_size);
  }

  Eigen::Index size() const { return m_size; } ///< number of vertices at construction

  /// The slot of a vertex. A vertex that a collapse has just removed still has one: its handle is
  /// looked up, never followed.
  Eigen::Index slot(const vertex_descriptor v) const
  {
    // The map holds slot + 1: a vertex that appeared after construction reads as 0.
    const Eigen::Index s = m_slots[v];
    if(s == 0)
      throw std::logic_error(
          m_owner + ": a vertex of the mesh was not there when it was made; make a new one "
                    "after adding vertices.");
    return s - 1;
  }

  /// Gives a vertex a slot that is another's no more.
  void set(const vertex_descriptor v, const Eigen::Index slot) { m_slots.set(v, slot + 1); }

  /// Gives the vertices of the mesh, in their order, these slots: other handles may go on for them.
  void set(const std::vector<Eigen::Index>& slots)
  {
    std::size_t i = 0;
    for(const vertex_descriptor v : vertices(*m_mesh))
      set(v, slots[i++]);
  }

  /// Throws `std::logic_error` where the mesh has been assigned to and its vertices are others.
  void check() const
  {
    if(!m_slots.attach(*m_mesh))
      throw std::logic_error(
          m_owner +
          ": another mesh has been assigned to the one that it was made for; make a new one.");
  }

  /// The slots of `vertices(mesh)`, in that order. Throws what check() throws.
  std::vector<Eigen::Index> current() const
  {
    check();
    std::vector<Eigen::Index> slots;
    for(const vertex_descriptor v : vertices(*m_mesh))
      slots.push_back(slot(v));
    return slots;
  }

private:
  const Triangle_mesh* m_mesh;
  std::string m_owner;
  Eigen::Index m_size = 0;
  mutable Vertex_slot_map<Triangle_mesh> m_slots; // mutable: where the mesh keeps them is looked up
};

/// One flag for each vertex in the order of `vertices(mesh)`, from indices in that order and from
/// the named parameter `vertex_is_constrained_map`; empty if there is none to keep.
template <class TriangleMesh, class NamedParameters>
std::vector<char> kept_vertex_flags(const TriangleMesh& mesh,
                                    const std::vector<std::size_t>& indices,
                                    const NamedParameters& np)
{
  std::vector<char> flags;
  bool any = !indices.empty();
  for([[maybe_unused]] const auto v : vertices(mesh)) {
    bool kept = false;
    if constexpr(!parameters::is_default_parameter<NamedParameters,
                                                   internal_np::vertex_is_constrained_t>::value)
      kept = get(parameters::get_parameter(np, internal_np::vertex_is_constrained), v);
    any = any || kept;
    flags.push_back(kept);
  }
  for(const std::size_t i : indices) {
    require(i < flags.size(), "Spectral_options: vertex ", i, " is to be kept, but the mesh has ",
            flags.size(), " vertices; use indices from 0.");
    flags[i] = true;
  }
  return any ? flags : std::vector<char>();
}

/// The vertices that must be left where they are: those to keep and the ends of constrained edges.
/// Empty, or one flag for each.
template <class TriangleMesh, class NamedParameters>
std::vector<char> fixed_vertex_flags([[maybe_unused]] const TriangleMesh& mesh,
                                     const std::vector<char>& kept, const NamedParameters& np)
{
  std::vector<char> fixed = kept;
  if constexpr(!parameters::is_default_parameter<NamedParameters,
                                                 internal_np::edge_is_constrained_t>::value) {
    const auto constrained = parameters::get_parameter(np, internal_np::edge_is_constrained);
    fixed.resize(std::size_t(std::distance(vertices(mesh).begin(), vertices(mesh).end())), false);
    std::size_t i = 0;
    for(const auto v : vertices(mesh)) {
      const auto h0 = halfedge(v, mesh);
      if(h0 != boost::graph_traits<TriangleMesh>::null_halfedge())
        for(const auto h : halfedges_around_target(h0, mesh))
          fixed[i] = fixed[i] || get(constrained, edge(h, mesh));
      ++i;
    }
  }
  return fixed;
}

/// Throws for the first vertex that no face uses, or where several fans of faces meet: a walk
/// around it sees one of them, or crosses two gaps. `T`: the faces.
template <class TriangleMesh>
void check_fans(const TriangleMesh& mesh, const Eigen::MatrixXi& T)
{
  std::vector<int> own(std::size_t(std::distance(vertices(mesh).begin(), vertices(mesh).end())), 0);
  for(Eigen::Index f = 0; f < T.rows(); ++f)
    for(int k = 0; k < 3; ++k)
      ++own[T(f, k)];
  std::size_t i = 0;
  for(const auto v : vertices(mesh)) {
    require(own[i] != 0, "edge collapses: ", vertex_name(Eigen::Index(i)),
            " is isolated, no face uses it; remove it.");
    int faces = 0, gaps = 0;
    for(const auto h : halfedges_around_target(halfedge(v, mesh), mesh))
      ++(is_border(h, mesh) ? gaps : faces);
    require(faces == own[i] && gaps <= 1, "edge collapses: ", vertex_name(Eigen::Index(i)),
            " joins several fans of faces; duplicate it "
            "(CGAL::Polygon_mesh_processing::duplicate_non_manifold_vertices).");
    ++i;
  }
}

/// Throws where two vertices to be kept are joined by edges without length: `edge_collapse()`
/// merges their ends before it asks for a cost. `kept`: empty, or one flag for each row of V.
inline void check_kept_vertices_apart(const std::vector<char>& kept, const Eigen::MatrixXd& V,
                                      const Eigen::MatrixXi& T)
{
  if(kept.empty())
    return;
  const std::vector<Eigen::Index> place =
      Spectral_geometry::internal::connected_components(V.rows(), [&](const auto& join) {
        for(Eigen::Index f = 0; f < T.rows(); ++f)
          for(int k = 0; k < 3; ++k)
            if(V.row(T(f, k)) == V.row(T(f, (k + 1) % 3)))
              join(T(f, k), T(f, (k + 1) % 3));
      });
  std::vector<Eigen::Index> kept_at(kept.size(), -1);
  for(std::size_t v = 0; v < kept.size(); ++v)
    if(kept[v]) {
      Eigen::Index& first = kept_at[place[v]];
      require(first < 0, "Spectral_options: the vertices ", first, " and ", v,
              " are both to be kept, but edges without length join them and are collapsed before "
              "anything "
              "else; keep one of the two.");
      first = Eigen::Index(v);
    }
}

} // namespace CGAL::Surface_mesh_simplification::internal

#endif // CGAL_SURFACE_MESH_SIMPLIFICATION_POLICIES_EDGE_COLLAPSE_INTERNAL_FINE_VERTEX_SLOTS_H
