// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_REGISTRATION_H
#define SPECTRAL_EXAMPLES_MATCHING_REGISTRATION_H

#include "proxy.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

// Refines a map between fine meshes by what the modes cannot tell: where along a limb, and on which
// side of it, a vertex is.
//
// A pose stretches a surface at the joints and moves the rest rigidly. A functional map spreads
// that stretch over the limbs, and the map that the modes agree on best is off by a tenth of a
// limb. Here X is bent onto Y in space instead: a control mesh of 2,000 vertices of X, as rigid as
// possible (Sorkine and Alexa 2007), is drawn to the points of Y that are nearest to it,
//
//   min  sum_ij w_ij |(p_i - p_j) - R_i (x_i - x_j)|^2  +  mu sum_i m_i |p_i - y_i|_{n_i}^2  +  mu
//   sum_k m_k |p_k' - y_k|_{n_k}^2
//
// over points p and rotations R, with cotangents w, areas m and |v|_n^2 = (n.v)^2 + 0.3 (|v|^2 -
// (n.v)^2), which lets the surfaces slide upon each other. y_i is the vertex of Y nearest to p_i,
// in space and by normals, and p_k' the control vertex nearest to y_k, for the vertices k of a
// control mesh of Y: without this half a foot of X could end halfway along the leg of Y. It starts
// where a few iterations by modes and curvature, from the control vertices of X to those of Y and
// back, lead. The first two thirds of the iterations compare mean curvature as well, in bands of
// scale between an edge and the finest mode, which moves with the surface and says where wrinkles
// go.
class Registration
{
public:
  // largest_weight: of a band of curvature, which has variance 1, in hundredths of the root of the
  // area; 0: positions alone. Throws what `keep_going` stops.
  Registration(const Shape& X, const Shape& Y, double largest_weight, int threads);

  struct Maps
  {
    std::vector<Eigen::Index> map; // from X to Y
    // Between the meshes that these were reduced from, if one was.
    std::vector<Eigen::Index> of_full;
  };

  // What C, from Y to X, leads to after so many iterations; 0: its map as it is, and none of full
  // meshes.
  Maps refine(const Eigen::MatrixXd& C, int iterations, const Keep_going& keep_going) const;

private:
  // At unit area, one column per vertex.
  struct Points
  {
    Eigen::MatrixXd V, normals;
  };

  // A surface, and a control mesh of few vertices, each beside one of the fine mesh.
  struct Surface : Points
  {
    Eigen::MatrixXd bands; // of the fine mesh, one column per vertex
    CGAL::Spectral_geometry::Mesh_matrices control;
    std::vector<Eigen::Index> nearest; // fine vertex, for each of the control mesh
    Eigen::VectorXd areas;             // of the control mesh, which sum to 1
  };

  // Takes a mesh in the unit of that shape.
  static Points points(const Shape& shape, const CGAL::Spectral_geometry::Mesh_matrices& mesh);
  static Surface surface(const Shape& shape, double shortest_time, Eigen::Index bands);
  // Signal over noise of each band under the images, r^2 / (1 - r^2) with the correlation r, cut at
  // the largest weight: animals of different species share the shape of the limbs, not the
  // wrinkles.
  Eigen::VectorXd weights(const std::vector<Eigen::Index>& images) const;
  // One row for each control vertex.
  static Eigen::MatrixXd at_control(const Eigen::MatrixXd& functions, const Surface& surface);
  // From the control vertices of X to those of Y and back to the functional map, until nothing
  // moves, by modes and curvature.
  Eigen::MatrixXd settled(Eigen::MatrixXd C, int iterations, const Keep_going& keep_going) const;
  // What points are compared by: positions, normals, curvature.
  static Eigen::MatrixXd features(const Eigen::MatrixXd& V, const Eigen::MatrixXd& normals,
                                  const Eigen::MatrixXd& bands, const Eigen::VectorXd& weights);

  const Shape &m_shape_X, &m_shape_Y;
  double m_largest_weight;
  int m_threads;
  Surface m_X, m_Y;
  Eigen::MatrixXd m_bands_X; // at the control vertices
};

#endif // SPECTRAL_EXAMPLES_MATCHING_REGISTRATION_H
