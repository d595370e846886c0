// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_COMPARE_SHAPE_MEASURES_H
#define SPECTRAL_EXAMPLES_COMPARE_SHAPE_MEASURES_H

#include "../io/mesh_io.h"
#include "../report/Comparison.h"

#include <cstddef>

// Diagonal of the bounding box.
double box_diagonal(const Mesh& mesh);

// Connected components.
std::size_t number_of_components(const Mesh& mesh);

// Smallest angle and largest aspect ratio alone, those that need no fine mesh.
Shape_measures shape_measures(const Mesh& fine, const Mesh& coarse);

#endif // SPECTRAL_EXAMPLES_COMPARE_SHAPE_MEASURES_H
