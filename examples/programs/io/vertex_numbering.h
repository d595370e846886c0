// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_VERTEX_NUMBERING_H
#define SPECTRAL_EXAMPLES_IO_VERTEX_NUMBERING_H

#include "polygon_soup.h"

#include <Eigen/SparseCore>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// Which vertices of a mesh are which of the file that it was made of. A vertex of the file may be
// missing in the mesh, several may be one there, and one may be several. Matrices, maps and lists
// of vertices that leave or enter a program number those of the file.
class Vertex_numbering
{
public:
  Vertex_numbering() = default;

  // For each vertex of the file one of the mesh, or `no_vertex`, and for each of the mesh one of
  // the file.
  Vertex_numbering(std::vector<std::size_t> mesh_vertices, std::vector<std::size_t> file_vertices)
    : m_mesh_vertices(std::move(mesh_vertices))
    , m_file_vertices(std::move(file_vertices))
  {
    m_identity = m_mesh_vertices.size() == m_file_vertices.size();
    for(std::size_t v = 0; m_identity && v < m_mesh_vertices.size(); ++v)
      m_identity = m_mesh_vertices[v] == v && m_file_vertices[v] == v;
    if(m_identity)
      return;
    std::vector<Eigen::Triplet<double>> picked, spread;
    for(std::size_t v = 0; v < m_mesh_vertices.size(); ++v)
      if(m_mesh_vertices[v] != no_vertex)
        spread.emplace_back(int(v), int(m_mesh_vertices[v]), 1.);
    for(std::size_t w = 0; w < m_file_vertices.size(); ++w)
      picked.emplace_back(int(w), int(m_file_vertices[w]), 1.);
    const Eigen::Index n = Eigen::Index(m_mesh_vertices.size()),
                       m = Eigen::Index(m_file_vertices.size());
    m_spread.resize(n, m);
    m_spread.setFromTriplets(spread.begin(), spread.end());
    m_picked.resize(m, n);
    m_picked.setFromTriplets(picked.begin(), picked.end());
    // A vertex that is one of several in the mesh has the copies of the one that the file's is.
    const Eigen::SparseMatrix<double> copies =
        m_picked * m_spread * Eigen::SparseMatrix<double>(m_spread.transpose());
    // A vector of its own: the product would copy that of an expression at every column.
    const Eigen::VectorXd share = (copies * Eigen::VectorXd::Ones(n)).cwiseInverse();
    m_mean = share.asDiagonal() * copies;
  }

  std::size_t number_of_file_vertices() const { return m_mesh_vertices.size(); }
  std::size_t number_of_mesh_vertices() const { return m_file_vertices.size(); }
  std::size_t mesh_vertex(const std::size_t v) const { return m_mesh_vertices[v]; }
  std::size_t file_vertex(const std::size_t w) const { return m_file_vertices[w]; }

  // Columns for the vertices of the mesh become columns for those of the file: copies share what
  // one has or, if the matrix is to stay `binary`, one of them gets it.
  Eigen::SparseMatrix<double> columns_of_file(const Eigen::SparseMatrix<double>& P,
                                              const bool binary = false) const
  {
    if(m_identity)
      return P;
    return P * (binary ? m_picked : m_mean);
  }

  Eigen::SparseMatrix<double> columns_of_mesh(const Eigen::SparseMatrix<double>& P) const
  {
    if(m_identity)
      return P;
    return P * m_spread;
  }

  // Numbers rows so; those of vertices that are not in the mesh are zero.
  template <class Matrix>
  Matrix rows_of_file(const Matrix& Q) const
  {
    if(m_identity)
      return Q;
    return m_spread * Q;
  }

  Eigen::SparseMatrix<double> operator_of_file(const Eigen::SparseMatrix<double>& L) const
  {
    if(m_identity)
      return L;
    return m_spread * L * Eigen::SparseMatrix<double>(m_spread.transpose());
  }

  template <class Matrix>
  Matrix rows_of_mesh(const Matrix& F) const
  {
    if(m_identity)
      return F;
    return m_mean * F;
  }

  // `map` has something for each vertex of the mesh; one that is missing there gets `missing`.
  template <class T>
  std::vector<T> map_of_file(const std::vector<T>& map, const T missing) const
  {
    std::vector<T> result;
    for(const std::size_t w : m_mesh_vertices)
      result.push_back(w == no_vertex ? missing : map[w]);
    return result;
  }

  // The vertices of the mesh that a file `path` names by those of the file of the mesh.
  std::vector<std::size_t> vertices_of_mesh(const std::vector<std::size_t>& vertices,
                                            const std::string& path) const
  {
    std::vector<std::size_t> result;
    std::vector<char> named(number_of_mesh_vertices(), 0);
    for(const std::size_t v : vertices) {
      if(m_mesh_vertices[v] == no_vertex)
        throw std::runtime_error("'" + path + "' names the vertex " + std::to_string(v) +
                                 ", which no face uses: name another.");
      if(char& before = named[m_mesh_vertices[v]]; !before) {
        result.push_back(m_mesh_vertices[v]);
        before = 1;
      }
    }
    return result;
  }

private:
  std::vector<std::size_t> m_mesh_vertices, m_file_vertices;
  Eigen::SparseMatrix<double> m_picked, m_mean,
      m_spread; // mesh x file, mesh x file, file x mesh; empty for the identity
  bool m_identity = true;
};

#endif // SPECTRAL_EXAMPLES_IO_VERTEX_NUMBERING_H
