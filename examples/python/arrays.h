// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_PYTHON_ARRAYS_H
#define SPECTRAL_PYTHON_ARRAYS_H

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace py = pybind11;

// Memory of `owner` as an array that may be read.
template <class Matrix>
py::array view(const Matrix& matrix, const py::object& owner)
{
  constexpr auto size = py::ssize_t(sizeof(typename Matrix::Scalar));
  py::array result =
      Matrix::ColsAtCompileTime == 1
          ? py::array(py::dtype::of<double>(), {matrix.size()}, {size}, matrix.data(), owner)
          : py::array(py::dtype::of<double>(), {matrix.rows(), matrix.cols()},
                      {size, size * matrix.rows()}, matrix.data(), owner);
  result.attr("setflags")(py::arg("write") = false);
  return result;
}

inline py::object csr(const Eigen::SparseMatrix<double>& matrix)
{
  return py::cast(Eigen::SparseMatrix<double, Eigen::RowMajor>(matrix));
}

template <class T>
py::array array_of(const std::vector<T>& values)
{
  py::array_t<std::int64_t> result(py::ssize_t(values.size()));
  std::copy(values.begin(), values.end(), result.mutable_data());
  return result;
}

#endif // SPECTRAL_PYTHON_ARRAYS_H
