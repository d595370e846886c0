// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

// Eigenpairs beside those of another library, on meshes too large for the dense solver.

#include <CGAL/Spectral_geometry/cotangent_laplacian.h>
#include <CGAL/Spectral_geometry/eigenpairs.h>

#include "catch.h"
#include "shapes.h"
#include "spectra_eigenpairs.h"

#include <Eigen/Core>

namespace test_reference_eigenpairs {

TEST_CASE("The block method agrees with the reference at every tolerance")
{
  for(const shapes::Matrices& mesh :
      {shapes::bumpy_icosphere_matrices(4), shapes::irregular_grid_matrices(50, 45)})
    for(const double theta : {0., 0.5}) {
      const SG::Laplace_operator op = SG::laplace_operator(mesh.V, mesh.T, theta);
      const SG::Eigenpairs expected = reference::spectra_eigenpairs(op, 61);
      const Eigen::VectorXd values = expected.values.head(60);
      for(const double tolerance : {1e-2, 1e-5, 1e-8, 1e-12}) {
        SG::Eigenpairs_options options;
        options.method = SG::Eigenpairs_method::block;
        options.tolerance = tolerance;
        const SG::Eigenpairs pairs = SG::eigenpairs(op, 60, options);
        CHECK((pairs.values - values).cwiseAbs().maxCoeff() <
              (std::max)(10. * tolerance * tolerance, 1e-12) * values(59));
        CHECK(pairs.residuals.maxCoeff() < (std::max)(1e3 * tolerance, 1e-9));
        // The vectors of single eigenvalues, up to the sign: they err by the residual over the gap.
        if(tolerance > 1e-6)
          continue;
        const Eigen::MatrixXd product = expected.vectors.transpose() * op.B * pairs.vectors;
        int compared = 0;
        for(int k = 1; k < 60; ++k) {
          const double gap = (std::min)(expected.values(k) - expected.values(k - 1),
                                        expected.values(k + 1) - expected.values(k));
          if(gap < 1e-3 * expected.values(k))
            continue;
          ++compared;
          CHECK(std::abs(product(k, k)) > 1. - 1e-8);
        }
        CHECK(compared > 10);
      }
    }
}

} // namespace test_reference_eigenpairs
