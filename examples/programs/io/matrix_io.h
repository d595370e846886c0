// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_MATRIX_IO_H
#define SPECTRAL_EXAMPLES_IO_MATRIX_IO_H

#include "output_files.h"

#include <Eigen/SparseCore>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

// Matrices for other programs. Each function writes the file `file`, which errors call `name`.

// Matrix Market, coordinate real general, indices from 1, 17 digits: scipy.io.mmread, MATLAB's
// mmread.
inline void write_matrix_market(const std::string& file, const Eigen::SparseMatrix<double>& matrix,
                                const std::string& name)
{
  std::ofstream stream(file);
  stream << "%%MatrixMarket matrix coordinate real general\n"
         << matrix.rows() << ' ' << matrix.cols() << ' ' << matrix.nonZeros() << '\n';
  char line[80];
  for(Eigen::Index column = 0; column < matrix.outerSize(); ++column) {
    for(Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
      std::snprintf(line, sizeof(line), "%lld %lld %.17g\n",
                    static_cast<long long>(entry.row() + 1),
                    static_cast<long long>(entry.col() + 1), entry.value());
      stream << line;
    }
  }
  finish_writing(stream, name);
}

// NumPy's format, doubles, a matrix in column-major order and a vector as a one-dimensional array:
// numpy.load.
template <class Matrix>
void write_npy(const std::string& file, const Matrix& matrix, const std::string& name)
{
  const std::uint16_t one = 1;
  const bool little_endian = *reinterpret_cast<const unsigned char*>(&one) == 1;
  std::string shape = std::to_string(matrix.rows()) + ",";
  if(Matrix::ColsAtCompileTime != 1)
    shape += " " + std::to_string(matrix.cols());
  std::string header = std::string("{'descr': '") + (little_endian ? "<" : ">") +
                       "f8', 'fortran_order': True, 'shape': (" + shape + "), }";
  // Magic number, version and length take 10 bytes; with the header they fill a multiple of 64.
  header.append(63 - (10 + header.size()) % 64, ' ');
  header += '\n';

  std::ofstream stream(file, std::ios::binary);
  stream.write("\x93NUMPY\x01\x00", 8);
  stream.put(static_cast<char>(header.size() & 0xff)).put(static_cast<char>(header.size() >> 8));
  stream << header;
  stream.write(reinterpret_cast<const char*>(matrix.data()),
               static_cast<std::streamsize>(sizeof(double)) * matrix.size());
  finish_writing(stream, name);
}

// One index per line, counted from 0; what is no index, the largest of numbers, is -1.
inline void write_indices(const std::string& file, const std::vector<std::size_t>& indices,
                          const std::string& name)
{
  std::ofstream stream(file);
  for(const std::size_t index : indices)
    stream << static_cast<long long>(index) << '\n';
  finish_writing(stream, name);
}

#endif // SPECTRAL_EXAMPLES_IO_MATRIX_IO_H
