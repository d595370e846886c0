// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_MESH_IO_H
#define SPECTRAL_EXAMPLES_IO_MESH_IO_H

#include "polygon_soup.h"

#include <CGAL/Spectral_toolbox/mesh_diagnosis.h>

#include <CGAL/Surface_mesh.h>

#include <cstddef>
#include <string>
#include <vector>

using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

// Reading and writing of meshes with errors of one sentence that name the file and the first
// offender.

// Returns the extension of a mesh file in lower case; throws when the programs do not read and
// write it.
std::string mesh_format(const std::string& path);

Polygon_soup read_polygon_soup(const std::string& path);

CGAL::Spectral_geometry::Mesh_diagnosis diagnose(const Polygon_soup& soup);

// The attributes of vertices that a file of this name can hold: PLY holds all.
Attributes writable(const Attributes& attributes, const std::string& name);

// The attributes of faces that it can hold: PLY all, OBJ materials and the like, OFF and STL a
// colour or a label.
Attributes writable_at_faces(const Attributes& attributes, const std::string& name);

// What a file has beside positions and faces.
struct Decoration
{
  Attributes vertices, faces;  // in the order of `vertices(mesh)` and `faces(mesh)`
  Corner_texture texture = {}; // by halfedges, or empty; only OBJ holds it, in place of s and t
  std::vector<std::string> libraries = {}; // of materials, as OBJ files name them
};

// Writes a mesh, its vertices in the order of `vertices(mesh)`, with those of the attributes that
// the format holds, to the file `file`, which errors call `name`. Throws where the format cannot
// hold the positions.
void write_mesh(const std::string& file, const Mesh& mesh, const std::string& name,
                const Decoration& decoration = {});

// Positions of STL files are rounded to single precision. Returns what that does to a mesh, a
// sentence, where it is more than a thousandth of the median edge, or nothing. Throws where faces
// would collapse: other programs could not use the file. Before a mesh is simplified to so many
// vertices, throws where half of an edge that it will have is lost.
std::string rounding(const Mesh& mesh, const std::string& name, std::size_t simplified_to = 0);

#endif // SPECTRAL_EXAMPLES_IO_MESH_IO_H
