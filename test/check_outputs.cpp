// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// check_outputs FOLDER INPUT OUTPUT: reads what spectral_simplify wrote into FOLDER (P.mtx, Q.mtx,
// map.txt, out.json and the folder pairs) and checks every definition. Prints the first that does
// not hold.

#include "io/input_mesh.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

using Sparse = Eigen::SparseMatrix<double>;
using Dense = Eigen::MatrixXd;

namespace {

void require(bool holds, const std::string& sentence)
{
  if(!holds)
    throw std::runtime_error("does not hold: " + sentence);
}

void require_small(double x, double bound, const std::string& sentence)
{
  std::ostringstream what;
  what << sentence << " (" << x << " is not below " << bound << ")";
  require(x < bound, what.str());
}

// From memory of the format's definition, not with the writer's code.
Sparse read_mtx(const std::string& path)
{
  std::ifstream stream(path);
  std::string banner;
  std::getline(stream, banner);
  require(banner == "%%MatrixMarket matrix coordinate real general",
          path + " has the banner of a real general matrix");
  Eigen::Index rows, columns, entries;
  stream >> rows >> columns >> entries;
  std::vector<Eigen::Triplet<double>> triplets;
  Eigen::Index i, j;
  double x;
  while(stream >> i >> j >> x) {
    require(i >= 1 && i <= rows && j >= 1 && j <= columns && x != 0,
            path + " has indices in range and no zeros");
    triplets.emplace_back(i - 1, j - 1, x);
  }
  require(static_cast<Eigen::Index>(triplets.size()) == entries,
          path + " has as many entries as announced");
  Sparse matrix(rows, columns);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  require(matrix.nonZeros() == entries, path + " names no entry twice");
  return matrix;
}

Dense read_npy(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  require(bytes.compare(0, 8, std::string("\x93NUMPY\x01\x00", 8)) == 0, path + " is an .npy file");
  const std::size_t length =
      static_cast<unsigned char>(bytes[8]) + 256 * static_cast<unsigned char>(bytes[9]);
  require((10 + length) % 64 == 0 && bytes[9 + length] == '\n', path + " has an aligned header");
  const std::string header = bytes.substr(10, length);
  std::smatch shape;
  require(std::regex_search(header, shape, std::regex("'shape': \\((\\d+),(?: (\\d+))?\\)")),
          path + " has a shape");
  require(header.find("'<f8'") != std::string::npos && header.find("True") != std::string::npos,
          path + " holds little-endian doubles by columns");
  const Eigen::Index rows = std::stol(shape[1]),
                     columns = shape[2].matched ? std::stol(shape[2]) : 1;
  require(bytes.size() == 10 + length + sizeof(double) * rows * columns, path + " is complete");
  return Eigen::Map<const Dense>(reinterpret_cast<const double*>(bytes.data() + 10 + length), rows,
                                 columns);
}

Dense positions(const Mesh& mesh)
{
  Dense V(num_vertices(mesh), 3);
  for(const auto v : vertices(mesh))
    V.row(v.idx()) << mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z();
  return V;
}

// By what the JSON file says of the run: P of the collapses, or of the closest points after a
// relocation.
bool carries(const nlohmann::json& json)
{
  return json.at("relocation").is_null() || json["relocation"].at("signals") != "sampled";
}

void check_restriction(const Sparse& P, const Dense& fine, const Dense& coarse,
                       const nlohmann::json& json)
{
  const bool binary = json.at("binary"),
             on_edges = json.at("placement") != "free" && json.at("relocation").is_null();
  require(P.rows() == coarse.rows() && P.cols() == fine.rows(), "P is coarse x fine");
  require_small(
      (P * Eigen::VectorXd::Ones(P.cols()) - Eigen::VectorXd::Ones(P.rows())).cwiseAbs().maxCoeff(),
      1e-12, "the rows of P sum to 1");
  for(Eigen::Index column = 0; carries(json) && column < P.cols(); ++column)
    require(P.outerIndexPtr()[column + 1] - P.outerIndexPtr()[column] <= 1,
            "a column of P has at most one nonzero");
  if(binary)
    require(P.nonZeros() == P.rows(), "a binary P has one 1 in each row");
  // Also shows that the rows have OUTPUT's order and the columns INPUT's. Rounded weights do not
  // move positions, and a free placement leaves the edge by less than its length.
  if(on_edges && !binary)
    require_small((P * fine - coarse).cwiseAbs().maxCoeff(), 1e-9,
                  "P times the fine positions are the coarse ones");
  else
    require_small((P * fine - coarse).rowwise().norm().mean() /
                      (fine.colwise().maxCoeff() - fine.colwise().minCoeff()).norm(),
                  0.03, "P times the fine positions are near the coarse ones");
}

void check_map(const std::string& path, const Sparse& P, bool agrees)
{
  std::ifstream stream(path);
  std::vector<Eigen::Index> map;
  for(Eigen::Index i; stream >> i;)
    map.push_back(i);
  require(static_cast<Eigen::Index>(map.size()) == P.cols(),
          "the map has a line for each vertex of the input");
  for(Eigen::Index column = 0; column < P.cols(); ++column) {
    require(map[column] >= 0 && map[column] < P.rows(), "the map leads to vertices of the output");
    for(Sparse::InnerIterator entry(P, column); agrees && entry; ++entry)
      require(entry.row() == map[column], "the map agrees with P");
  }
}

struct Spectrum
{
  Spectrum(const std::string& folder, const std::string& mesh)
    : values(read_npy(folder + "/" + mesh + "_eigenvalues.npy"))
    , vectors(read_npy(folder + "/" + mesh + "_eigenvectors.npy"))
    , L(read_mtx(folder + "/" + mesh + "_L.mtx"))
    , B(read_mtx(folder + "/" + mesh + "_mass.mtx"))
  {
    const Dense gram = vectors.transpose() * B * vectors;
    require_small((gram - Dense::Identity(gram.rows(), gram.cols())).norm(), 1e-8,
                  mesh + " eigenvectors are orthonormal");
    require_small((L * vectors - B * vectors * values.asDiagonal()).norm(),
                  1e-5 * (L * vectors).norm(), mesh + " eigenpairs solve L phi = lambda B phi");
  }

  double area() const { return Sparse(B).sum(); }

  Eigen::VectorXd values;
  Dense vectors;
  Sparse L, B;
};

void check_spectra(const std::string& folder, const Sparse& P, const Sparse& Q,
                   const nlohmann::json& json)
{
  const Spectrum fine(folder, "fine"), coarse(folder, "coarse");
  const Dense C = read_npy(folder + "/C.npy");
  require_small((C - coarse.vectors.transpose() * coarse.B * P * fine.vectors).norm(), 1e-8,
                "C is what it is called");

  // The norms of section 4 of the paper at unit area, once more.
  const double fine_area = fine.area(), coarse_area = coarse.area();
  const Dense U = std::sqrt(fine_area / coarse_area) * C;
  const Dense commutator =
      U * (fine_area * fine.values).asDiagonal() - (coarse_area * coarse.values).asDiagonal() * U;
  const double norm_L = commutator.norm() / U.norm();
  const double norm_D = (U.transpose() * U - Dense::Identity(U.cols(), U.cols())).norm();
  require_small(std::abs(norm_L / json.at("norm_L").get<double>() - 1), 1e-8,
                "norm_L follows from the files");
  require_small(std::abs(norm_D / json.at("norm_D").get<double>() - 1), 1e-8,
                "norm_D follows from the files");
  require_small(std::abs(coarse_area / fine_area / json.at("area_ratio").get<double>() - 1), 1e-10,
                "area_ratio follows from the files");
  const Dense carried = Q * coarse.vectors, by_mass = fine.B * carried;
  const Dense left =
      fine.vectors -
      carried * (carried.transpose() * by_mass).ldlt().solve(by_mass.transpose() * fine.vectors);
  require_small(std::abs(left.cwiseProduct(fine.B * left).sum() / double(left.cols()) /
                             json.at("span_loss").get<double>() -
                         1),
                1e-8, "span_loss follows from the files");
  double sum = 0, low = 0, largest = 0;
  const Eigen::Index last_low = fine.values.size() / 5; // modes 2..K/5
  for(Eigen::Index k = 1; k < fine.values.size(); ++k) {
    const double error =
        std::abs(coarse_area * coarse.values[k] / (fine_area * fine.values[k]) - 1);
    sum += error;
    low += k < last_low ? error : 0;
    largest = (std::max)(largest, error);
  }
  require_small(
      std::abs(sum / (fine.values.size() - 1) / json.at("eigenvalue_error_mean").get<double>() - 1),
      1e-8, "eigenvalue_error_mean follows from the files");
  require_small(
      std::abs(low / (last_low - 1) / json.at("eigenvalue_error_low_mean").get<double>() - 1), 1e-8,
      "eigenvalue_error_low_mean follows from the files");
  require_small(std::abs(largest / json.at("eigenvalue_error_max").get<double>() - 1), 1e-8,
                "eigenvalue_error_max follows from the files");
}

void check_json(const nlohmann::json& json)
{
  for(const char* name :
      {"input_vertices", "output_vertices", "eigenvectors", "norm_L", "norm_D",
       "norm_L_input_scale", "eigenvalue_error_mean", "eigenvalue_error_max", "area_ratio",
       "seconds_eigenpairs", "seconds_collapse", "seconds_evaluation", "seconds_total"})
    require(json.contains(name) && json[name].is_number(),
            std::string(name) + " is a number in the JSON file");
  for(const char* name : {"mass", "stop_reason"})
    require(json.contains(name) && json[name].is_string(),
            std::string(name) + " is a text in the JSON file");
}

} // namespace

int main(int argc, char* argv[])
{
  try {
    require(argc == 4, "usage: check_outputs FOLDER INPUT OUTPUT");
    const std::string folder = argv[1];
    const nlohmann::json json = nlohmann::json::parse(std::ifstream(folder + "/out.json"));
    check_json(json);
    const Dense fine = positions(read_input_mesh(argv[2], Mending::none).mesh),
                coarse = positions(read_input_mesh(argv[3], Mending::none).mesh);
    require(json.at("input_vertices") == fine.rows() && json.at("output_vertices") == coarse.rows(),
            "the JSON file counts the vertices");
    const Sparse P = read_mtx(folder + "/P.mtx"), Q = read_mtx(folder + "/Q.mtx");
    check_restriction(P, fine, coarse, json);
    check_map(folder + "/map.txt", P, carries(json));
    require(Q.rows() == P.cols() && Q.cols() == P.rows(), "Q is fine x coarse");
    require_small((Q * Eigen::VectorXd::Ones(Q.cols()) - Eigen::VectorXd::Ones(Q.rows()))
                      .cwiseAbs()
                      .maxCoeff(),
                  1e-12, "the rows of Q sum to 1");
    check_spectra(folder + "/pairs", P, Q, json);
    return 0;
  } catch(const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
