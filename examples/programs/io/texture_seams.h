// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_TEXTURE_SEAMS_H
#define SPECTRAL_EXAMPLES_IO_TEXTURE_SEAMS_H

#include "mesh_io.h"

#include <cstddef>
#include <vector>

// The texture of a mesh and its seams: edges whose two faces have other coordinates at one of its
// ends, and border edges in the place of another, where a file has copies of vertices.
//
// A simplification that keeps the vertices of seams keeps their edges: a collapse takes no edge
// away that joins two vertices which stay.
class Texture_seams
{
public:
  // `corners`: by halfedges, the coordinates at the target in the face.
  Texture_seams(const Mesh& mesh, Corner_texture corners);

  // Edges in the same place count once.
  std::size_t number_of_edges() const { return m_number_of_edges; }

  // The vertices at seams, in the order of `vertices(mesh)`.
  const std::vector<std::size_t>& vertices() const { return m_vertices; }

  // The coordinates at the corners of what the mesh was simplified to, with these vertices kept;
  // `map` has for each vertex the one that it went to, in the order of `vertices(coarse)`. Beside a
  // seam each side has its own coordinates as before; any other vertex has those of the closest
  // point of the surface on its side of the seams.
  Corner_texture simplified(const Mesh& coarse, const std::vector<std::size_t>& map) const;

private:
  using Vertex = Mesh::Vertex_index;
  using Halfedge = Mesh::Halfedge_index;

  bool is_seam(const Halfedge h) const { return m_is_seam[m_mesh.edge(h)]; }
  void set_beside_seams(const Mesh& coarse, const std::vector<Vertex>& handles,
                        const std::vector<std::size_t>& map, Corner_texture& result) const;
  void set_elsewhere(const Mesh& coarse, const std::vector<Vertex>& handles,
                     const std::vector<std::size_t>& map, Corner_texture& result) const;
  Texture_point closest(const Kernel::Point_3& query, std::vector<Mesh::Face_index> faces,
                        const std::vector<char>& near) const;

  Mesh m_mesh; // a copy
  Corner_texture m_corners;
  std::vector<char> m_is_seam; // by edges
  std::vector<std::size_t> m_vertices;
  std::size_t m_number_of_edges = 0;
};

#endif // SPECTRAL_EXAMPLES_IO_TEXTURE_SEAMS_H
