// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef CGAL_SPECTRAL_GEOMETRY_INTERNAL_TALL_PRODUCTS_H
#define CGAL_SPECTRAL_GEOMETRY_INTERNAL_TALL_PRODUCTS_H

#include <CGAL/Spectral_geometry/internal/Panel_kernels.h>

#include <Eigen/Core>

#include <algorithm>

namespace CGAL {
namespace Spectral_geometry {
namespace internal {

/// Products of tall matrices, in wide registers: blocks of rows, short enough for the cache, in panels of eight columns, the last of
/// which is filled up with zeros.
class Tall_products
{
public:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  // A^T B, which is known to be symmetric
  static Eigen::MatrixXd symmetric(const Rows& A, const Rows& B)
  {
    const Index panels = (A.cols() + panel_width - 1) / panel_width;
    Rows P(panels * block, panel_width), W(P), H = Rows::Zero(panels * panels * panel_width, panel_width);
    for(Index first = 0; first < A.rows(); first += block) {
      const Index rows = (std::min)(block, A.rows() - first);
      pack(A, first, rows, P);
      pack(B, first, rows, W);
      for(Index p = 0; p < panels; ++p)
        for(Index q = p; q < panels; ++q)
          gram(P.data() + p * size, W.data() + q * size, rows, H.data() + (p * panels + q) * square);
    }
    Eigen::MatrixXd result(A.cols(), A.cols());
    for(Index j = 0; j < result.cols(); ++j)
      for(Index i = 0; i <= j; ++i)
        result(i, j) = result(j, i) =
            H(i / panel_width * panels * panel_width + j / panel_width * panel_width + i % panel_width,
              j % panel_width);
    return result;
  }

  // C += A M
  static void add(Rows& C, const Rows& A, const Eigen::MatrixXd& M)
  {
    const Index panels = (A.cols() + panel_width - 1) / panel_width;
    Rows P(panels * block, panel_width), W(P), H = Rows::Zero(panels * panels * panel_width, panel_width);
    for(Index j = 0; j < M.cols(); ++j)
      for(Index i = 0; i < M.rows(); ++i)
        H(i / panel_width * panels * panel_width + j / panel_width * panel_width + i % panel_width,
          j % panel_width) = -M(i, j);
    for(Index first = 0; first < A.rows(); first += block) {
      const Index rows = (std::min)(block, A.rows() - first);
      pack(A, first, rows, P);
      pack(C, first, rows, W);
      for(Index q = 0; q < panels; ++q) {
        for(Index p = 0; p < panels; ++p)
          subtract_product(W.data() + q * size, P.data() + p * size, rows,
                           H.data() + (p * panels + q) * square);
        const Index begin = q * panel_width, width = (std::min)(Index(panel_width), C.cols() - begin);
        C.block(first, begin, rows, width) = W.block(q * block, 0, rows, width);
      }
    }
  }

private:
  static constexpr Index block = 128, size = block * panel_width, square = panel_width * panel_width;

  static void pack(const Rows& A, Index first, Index rows, Rows& P)
  {
    for(Index p = 0; p * panel_width < A.cols(); ++p) {
      const Index begin = p * panel_width, width = (std::min)(Index(panel_width), A.cols() - begin);
      P.block(p * block, 0, rows, width) = A.block(first, begin, rows, width);
      P.block(p * block, width, rows, panel_width - width).setZero();
    }
  }
};

} // namespace internal
} // namespace Spectral_geometry
} // namespace CGAL

#endif // CGAL_SPECTRAL_GEOMETRY_INTERNAL_TALL_PRODUCTS_H
