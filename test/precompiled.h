// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Nobody includes this file: the compiler reads it before a test where SPECTRAL_PRECOMPILE_HEADERS is set. A test still
// includes all that it uses.
#include <CGAL/Surface_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/helpers.h>
#include <Eigen/Dense>
#include <Eigen/Sparse>
#include "catch.h"
