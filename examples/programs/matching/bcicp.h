// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_BCICP_H
#define SPECTRAL_EXAMPLES_MATCHING_BCICP_H

#include "proxy.h"

#include <Eigen/Core>

#include <vector>

// For each vertex of X one of Y, and for each vertex of Y one of X.
struct Vertex_maps
{
  std::vector<Eigen::Index> X_to_Y, Y_to_X;
};

// Bijective and continuous ICP (Ren, Poulenard, Wonka, Ovsjanikov 2018): both maps are brought
// nearer to bijections, nearer to inverses of each other and nearer to continuous ones, by turns in
// the first `modes` modes and on the surfaces. For coarse meshes: memory and time grow with the
// square of their size. A bijection that keeps all lengths stays as it is. Unlike in the paper what
// is averaged and compared on a surface are distances within it, not positions, which need poses
// that are alike; and a vertex moves, to make a map smoother, only where that uncovers no other.
Vertex_maps bcicp(const Shape& X, const Shape& Y, Vertex_maps maps, Eigen::Index modes,
                  int iterations, int threads, const Keep_going& keep_going);

#endif // SPECTRAL_EXAMPLES_MATCHING_BCICP_H
