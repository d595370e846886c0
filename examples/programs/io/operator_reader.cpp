// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "operator_reader.h"

#include "npy_reader.h"
#include "program.h"

#include <CGAL/Spectral_toolbox/curvature_coefficients.h>
#include <CGAL/Spectral_geometry/operator_coefficients.h>

#include <cstddef>
#include <cstdlib>
#include <stdexcept>

namespace SG = CGAL::Spectral_geometry;

Operator_word parsed_operator(const std::string& word)
{
  Operator_word result;
  const std::size_t colon = word.find(':');
  result.kind = word.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : word.substr(colon + 1);
  if(result.kind == "cotangent" && colon == std::string::npos)
    return result;
  if(result.kind == "weighted" && !rest.empty()) {
    result.file = rest;
    return result;
  }
  if(result.kind == "anisotropic" && !rest.empty()) {
    char* end = nullptr;
    result.anisotropy = std::strtod(rest.c_str(), &end);
    if(*end == '\0' && result.anisotropy >= 0 && result.anisotropy <= 1e6)
      return result;
  }
  throw std::runtime_error(
      "--operator is '" + word +
      "', it must be cotangent, weighted:FILE.npy or anisotropic:A with a number A from 0 to 1e6.");
}

namespace {

// Checked as the file numbers vertices.
SG::Operator_coefficients read_coefficients(const std::string& file, const std::size_t n)
{
  const Eigen::MatrixXd given = read_signals(file, n);
  const auto columns = given.cols();
  try {
    if(columns == 7)
      return SG::anisotropic_coefficients(given.rightCols(6), given.col(0));
    if(columns == 1 || columns == 2)
      return SG::weighted_coefficients(
          columns == 2 ? Eigen::VectorXd(given.col(0)) : Eigen::VectorXd(), given.col(columns - 1));
  } catch(const std::invalid_argument& error) {
    throw std::runtime_error("cannot use '" + file + "': " + error.what());
  }
  throw std::runtime_error(
      "cannot use '" + file + "': it has " + std::to_string(columns) +
      " columns; give the conductivity in one, density and conductivity in two, or density "
      "and the tensor xx, xy, xz, yy, yz, zz in seven.");
}

} // namespace

SG::Operator_coefficients operator_coefficients(const Operator_word& word, const Mesh& mesh,
                                                const Vertex_numbering& numbering)
{
  if(word.kind == "weighted")
    return numbering.rows_of_mesh(
        read_coefficients(word.file, numbering.number_of_file_vertices()));
  if(word.kind == "anisotropic") {
    const SG::Mesh_matrices matrices = SG::mesh_matrices(mesh);
    return SG::curvature_coefficients(matrices.V, matrices.T, word.anisotropy,
                                      [](double) { return !interrupted; });
  }
  return {};
}
