// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_ORIENTATION_H
#define SPECTRAL_EXAMPLES_IO_ORIENTATION_H

#include <Eigen/Core>

#include <vector>

// The triangles of closed components that are inside out: their volume is negative. A component
// within another is a cavity as often as a body, so that it tells nothing by itself and turns with
// the one around it.
std::vector<Eigen::Index> inside_out(const Eigen::MatrixXd& V, const Eigen::MatrixXi& T);

#endif // SPECTRAL_EXAMPLES_IO_ORIENTATION_H
