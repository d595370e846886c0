// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_CONSUMER_SIMPLIFY_H
#define SPECTRAL_CONSUMER_SIMPLIFY_H

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <Eigen/SparseCore>

#include <string>

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

// Simplifies `mesh` to `number_of_vertices` and returns the restriction (coarse x fine). `solver`
// becomes the name of what computed the eigenpairs.
Eigen::SparseMatrix<double> simplify(Mesh& mesh, std::size_t number_of_vertices,
                                     std::string& solver);

#endif // SPECTRAL_CONSUMER_SIMPLIFY_H
