// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_NPY_READER_H
#define SPECTRAL_EXAMPLES_IO_NPY_READER_H

#include <Eigen/Core>

#include <cstddef>
#include <string>

// Reads a matrix that numpy.save wrote: one or two dimensions, float64 or float32 of either byte
// order, C or Fortran order. Throws with one sentence that names the file and what is wrong.

// Returns the array of the file, a vector as a single column.
Eigen::MatrixXd read_npy(const std::string& path);

// Returns the signals of a file for a mesh of n vertices, one row for each.
Eigen::MatrixXd read_signals(const std::string& path, std::size_t n);

#endif // SPECTRAL_EXAMPLES_IO_NPY_READER_H
