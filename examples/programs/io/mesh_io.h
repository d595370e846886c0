// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_MESH_IO_H
#define SPECTRAL_EXAMPLES_IO_MESH_IO_H

#include "polygon_soup.h"

#include <CGAL/Spectral_geometry/mesh_diagnosis.h>

#include <CGAL/Surface_mesh.h>

#include <string>

using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

// Reading and writing of meshes with errors of one sentence that name the file and the first offender.

// Returns the extension of a mesh file in lower case; throws when the programs do not read and write it.
std::string mesh_format(const std::string& path);

Polygon_soup read_polygon_soup(const std::string& path);

CGAL::Spectral_geometry::Mesh_diagnosis diagnose(const Polygon_soup& soup);

// Those that a file of this name can hold: PLY holds all.
Vertex_attributes writable(const Vertex_attributes& attributes, const std::string& name);

// Writes a mesh, its vertices in the order of `vertices(mesh)`, with those of the attributes that the format holds, to the file
// `file`, which errors call `name`. Only OBJ holds a texture with seams, which replaces the attributes s and t.
void write_mesh(const std::string& file, const Mesh& mesh, const std::string& name,
                const Vertex_attributes& attributes = {}, const Corner_texture& texture = {});

#endif // SPECTRAL_EXAMPLES_IO_MESH_IO_H
