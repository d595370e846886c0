// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_FACE_ATTRIBUTES_H
#define SPECTRAL_EXAMPLES_IO_FACE_ATTRIBUTES_H

#include "mesh_io.h"

#include <cstddef>
#include <vector>

// Carries attributes of faces to what a mesh was simplified to, by the area of the mesh that each
// coarse face takes over: labels are elected, the channels of a colour together, and numbers are
// means. `map` has for each vertex of the mesh the one that it went to, in the order of
// `vertices(coarse)`. Faces near which a fine one may lie are those at the vertices that its own
// went to, so that no label comes from another part of the shape that lies close by.
Attributes carried_by_area(const Attributes& fine_attributes, const Mesh& fine, const Mesh& coarse,
                           const std::vector<std::size_t>& map);

#endif // SPECTRAL_EXAMPLES_IO_FACE_ATTRIBUTES_H
