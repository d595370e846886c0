// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_OPERATOR_READER_H
#define SPECTRAL_EXAMPLES_OPERATOR_READER_H

#include "mesh_io.h"
#include "vertex_numbering.h"

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>

#include <string>

// What --operator says: "cotangent", "weighted:FILE" or "anisotropic:A".
struct Operator_word
{
  std::string kind = "cotangent", file; // the file of `weighted`
  double anisotropy = 0;                // of `anisotropic`
};

// Throws with one sentence for what is none of these.
Operator_word parsed_operator(const std::string& word);

// The coefficients at the vertices of a mesh; none for `cotangent`. A file is a NumPy array with a
// row for each vertex of INPUT: the conductivity in one column, density and conductivity in two, or
// density and the tensor xx, xy, xz, yy, yz, zz in seven.
CGAL::Spectral_geometry::Operator_coefficients
operator_coefficients(const Operator_word& word, const Mesh& mesh,
                      const Vertex_numbering& numbering);

#endif // SPECTRAL_EXAMPLES_OPERATOR_READER_H
