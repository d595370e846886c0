// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_MATRIX_MARKET_READER_H
#define SPECTRAL_EXAMPLES_IO_MATRIX_MARKET_READER_H

#include <Eigen/SparseCore>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

// What is wrong with a matrix of so many rows, columns and nonzeros, as "'P.mtx' " begins it; empty
// if nothing is.
using Size_objection = std::function<std::string(long long, long long, long long)>;

// Reads a sparse matrix as other programs write it: Matrix Market, coordinate, real or integer,
// general or symmetric, the words of the header in upper or lower case. Errors name the file and
// the first line that is wrong. `objection` is asked before memory is taken: rows and columns cost
// some, and the file may promise any number of them.
inline Eigen::SparseMatrix<double> read_matrix_market(const std::string& path,
                                                      const Size_objection& objection)
{
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error("cannot read '" + path + "': " + why);
  };
  std::ifstream stream(path);
  if(!stream)
    refuse("there is no such file, or it may not be read.");
  std::string line, banner, object, format, field, symmetry;
  std::getline(stream, line);
  std::transform(line.begin(), line.end(), line.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::istringstream(line) >> banner >> object >> format >> field >> symmetry;
  if(banner != "%%matrixmarket" || object != "matrix" || format != "coordinate" ||
     (field != "real" && field != "integer") || (symmetry != "general" && symmetry != "symmetric"))
    refuse("it must begin with '%%MatrixMarket matrix coordinate real general' (or integer, or "
           "symmetric).");

  std::size_t number = 1;
  do {
    std::getline(stream, line);
    ++number;
  } while(stream && (line.empty() || line[0] == '%'));
  long long rows = 0, columns = 0, nonzeros = 0;
  constexpr long long largest = std::numeric_limits<int>::max();
  if(!(std::istringstream(line) >> rows >> columns >> nonzeros) || rows < 1 || columns < 1 ||
     nonzeros < 0 || rows > largest || columns > largest || nonzeros > largest)
    refuse("line " + std::to_string(number) +
           " must give the numbers of rows, columns and nonzeros.");

  if(symmetry == "symmetric" && rows != columns)
    refuse("line " + std::to_string(number) + " gives a symmetric matrix that is not square.");

  const std::string wrong = objection(rows, columns, nonzeros);
  if(!wrong.empty())
    throw std::runtime_error("'" + path + "' " + wrong);

  std::vector<Eigen::Triplet<double>> entries;
  for(long long k = 0; k < nonzeros; ++k) {
    ++number;
    long long i = 0, j = 0;
    double x = 0;
    if(!std::getline(stream, line) || !(std::istringstream(line) >> i >> j >> x) ||
       !std::isfinite(x))
      refuse("line " + std::to_string(number) + " must hold a row, a column and a number.");
    if(i < 1 || i > rows || j < 1 || j > columns)
      refuse("the entry of line " + std::to_string(number) + " lies outside of the matrix.");
    entries.emplace_back(static_cast<int>(i - 1), static_cast<int>(j - 1), x);
    if(symmetry == "symmetric" && i != j)
      entries.emplace_back(static_cast<int>(j - 1), static_cast<int>(i - 1), x);
  }
  Eigen::SparseMatrix<double> matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

#endif // SPECTRAL_EXAMPLES_IO_MATRIX_MARKET_READER_H
