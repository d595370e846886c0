// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_INPUT_MESH_H
#define SPECTRAL_EXAMPLES_IO_INPUT_MESH_H

#include "mesh_io.h"
#include "mesh_repair.h"
#include "vertex_numbering.h"

#include <CGAL/Spectral_toolbox/mesh_diagnosis.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

// A mesh that a program reads, with what was changed so that it can be used.
struct Input_mesh
{
  Mesh mesh;
  Vertex_numbering numbering;
  CGAL::Spectral_geometry::Mesh_diagnosis diagnosis; // its components begin at vertices of the file
  std::vector<Repair> changes;
  std::vector<std::size_t> left_out; // the first vertices of the file of components left out
  std::string still_cut;             // what a full repair had to leave cut, a sentence, or nothing
  // Where they are asked for:
  Attributes attributes;      // of the vertices of the file
  Attributes face_attributes; // of the faces of the mesh
  std::vector<std::string> material_libraries;
  Corner_texture texture;      // by halfedges, at the target in the face; or empty
  std::string without_texture; // why it is empty, the end of a sentence

  // "'bunny.obj': 2 faces turned round, 1113 isolated vertices left out."; empty if nothing was
  // changed.
  std::string changes_of(const std::string& path) const;

  // "'bunny.obj' has 405 vertices, and 430 before it was cleaned".
  std::string size_of(const std::string& path) const;
};

// What may be changed: nothing; what leaves the surface as it is, that is isolated vertices, copies
// of faces, edges without length, faces turned the other way than their neighbours; or anything,
// see `repaired_soup()`.
enum class Mending { none, plain, full };

// What the options --strict and --repair ask for.
inline Mending mending(const bool strict, const bool repair)
{
  if(strict && repair)
    throw std::runtime_error("--strict and --repair cannot both be given.");
  return strict ? Mending::none : repair ? Mending::full : Mending::plain;
}

// Reads a triangle mesh, its vertices in the order of the file (of first appearance for STL).
// Throws with the first obstacle that is left. `with_attributes`: keeps what vertices and corners
// have beside positions. Leaves out components of less than the share `debris` of the area.
Input_mesh read_input_mesh(const std::string& path, Mending mending, bool with_attributes = false,
                           double debris = 0, const std::function<bool()>& keep_going = {});

// A mesh that has been read, or was never in a file; `name` begins what is said of it. The repair
// throws `Cancelled` when `keep_going` has returned false.
Input_mesh input_mesh(Polygon_soup soup, const std::string& name, Mending mending,
                      bool with_attributes = false, double debris = 0,
                      const std::function<bool()>& keep_going = {});

#endif // SPECTRAL_EXAMPLES_IO_INPUT_MESH_H
