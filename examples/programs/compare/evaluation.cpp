// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "evaluation.h"

#include "../report/judgement.h"
#include "mode_alignment.h"

#include <CGAL/Spectral_geometry/functional_map.h>
#include <CGAL/Spectral_toolbox/spectral_distances.h>

#include <algorithm>
#include <cmath>

namespace SG = CGAL::Spectral_geometry;

namespace {

// The first K pairs of a mesh scaled to unit area.
SG::Eigenpairs unit_area(const SG::Eigenpairs& pairs, double area, Eigen::Index K)
{
  SG::Eigenpairs result;
  result.values = area * pairs.values.head(K);
  result.vectors = std::sqrt(area) * pairs.vectors.leftCols(K);
  result.zeros = pairs.zeros;
  return result;
}

// The mean, over the columns, of sum_w M_w |coarse - P fine| / sum_w M_w |P fine|.
double relative_error(const Eigen::SparseMatrix<double>& P, const Eigen::MatrixXd& fine,
                      const Eigen::MatrixXd& coarse, const Eigen::VectorXd& mass)
{
  const Eigen::MatrixXd restricted = P * fine;
  const Eigen::RowVectorXd difference = mass.transpose() * (coarse - restricted).cwiseAbs();
  const Eigen::RowVectorXd size = mass.transpose() * restricted.cwiseAbs();
  return (difference.array() / size.array()).mean();
}

// Distances from the paired sources on the coarse mesh against those of the fine mesh restricted by
// P, and the signatures of all vertices, both meshes at unit area, K modes; times and energies of
// the fine mesh.
Distance_errors distance_errors(const Fine_reference& reference, const Coarse_candidate& candidate,
                                const SG::Eigenpairs& coarse_pairs)
{
  const Eigen::Index K = (std::min)(reference.K, coarse_pairs.size());
  const SG::Eigenpairs fine = unit_area(reference.pairs, reference.op.mass.sum(), K);
  const SG::Eigenpairs coarse = unit_area(coarse_pairs, candidate.op.mass.sum(), K);
  const Eigen::SparseMatrix<double>& P = candidate.restriction();
  const auto [fine_sources, coarse_sources] = paired_sources(reference.sources, P);
  const double t = SG::default_diffusion_time(fine);
  const Eigen::VectorXd times = SG::heat_kernel_times(fine, 30);
  const SG::Wave_kernel_energies energies = SG::wave_kernel_energies(fine, 50);
  const auto error = [&](const Eigen::MatrixXd& on_fine, const Eigen::MatrixXd& on_coarse) {
    return relative_error(P, on_fine, on_coarse, candidate.op.mass);
  };
  Distance_errors result;
  result.diffusion = error(SG::squared_diffusion_distance(fine, fine_sources, t),
                           SG::squared_diffusion_distance(coarse, coarse_sources, t));
  result.biharmonic = error(SG::squared_biharmonic_distance(fine, fine_sources),
                            SG::squared_biharmonic_distance(coarse, coarse_sources));
  result.commute_time = error(SG::squared_commute_time_distance(fine, fine_sources),
                              SG::squared_commute_time_distance(coarse, coarse_sources));
  result.wave_kernel = error(SG::wave_kernel_distance(fine, fine_sources, energies),
                             SG::wave_kernel_distance(coarse, coarse_sources, energies));
  result.heat_kernel_signature =
      error(SG::heat_kernel_signature(fine, times), SG::heat_kernel_signature(coarse, times));
  result.wave_kernel_signature =
      error(SG::wave_kernel_signature(fine, energies), SG::wave_kernel_signature(coarse, energies));
  return result;
}

} // namespace

Fine_reference fine_reference(const SG::Mesh_matrices& mesh, SG::Mass mass, Eigen::Index K,
                              const std::vector<Eigen::Index>& sources,
                              const std::function<bool(double)>& progress)
{
  Fine_reference r;
  r.mass = SG::mass_name(mass);
  r.op = SG::laplace_operator(mesh.V, mesh.T, mass);
  r.K = K;
  r.sources = sources;
  SG::Eigenpairs_options options;
  options.progress = progress;
  r.pairs = SG::eigenpairs(r.op, (std::min)(mesh.V.rows(), K + (K + 1) / 2), options);
  return r;
}

std::pair<std::vector<Eigen::Index>, std::vector<Eigen::Index>>
paired_sources(const std::vector<Eigen::Index>& sources, const Eigen::SparseMatrix<double>& P)
{
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = P;
  std::pair<std::vector<Eigen::Index>, std::vector<Eigen::Index>> result;
  for(const Eigen::Index source : sources) {
    // Columns may be empty: then the next vertex that has a value anywhere.
    Eigen::Index column = source;
    while(P.outerIndexPtr()[column] == P.outerIndexPtr()[column + 1])
      column = (column + 1) % P.cols();
    Eigen::Index coarse = 0, fine = 0;
    double largest = -1;
    for(Eigen::SparseMatrix<double>::InnerIterator entry(P, column); entry; ++entry)
      if(entry.value() > largest) {
        largest = entry.value();
        coarse = entry.row();
      }
    largest = -1;
    for(Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(rows, coarse); entry;
        ++entry)
      if(entry.value() > largest) {
        largest = entry.value();
        fine = entry.col();
      }
    result.first.push_back(fine);
    result.second.push_back(coarse);
  }
  return result;
}

Judged judge(const Fine_reference& reference, const Coarse_candidate& candidate,
             const std::function<bool(double)>& progress)
{
  SG::Eigenpairs_options options;
  options.progress = progress;
  const Eigen::Index N = candidate.op.L.rows();
  Judged result;
  result.aligned = SG::eigenpairs(candidate.op, (std::min)(N, reference.pairs.size()), options);

  Judgement& j = result.judgement;
  j.mass = reference.mass;
  Eigen::MatrixXd C;
  for(const bool carried : {false, true}) {
    const auto& P = carried ? candidate.carried : candidate.closest;
    if(!P)
      continue;
    const SG::Spectral_evaluation e =
        SG::evaluate_spectrum(reference.op, reference.pairs, candidate.op, result.aligned, *P,
                              reference.K, candidate.prolongation);
    add_evaluation(j, e, carried);
    C = e.C;
  }
  j.distances = distance_errors(reference, candidate, result.aligned);
  j.distances_by = candidate.carried ? "carried" : "closest point";

  const Eigen::MatrixXd R = aligning_rotation(C, reference.op.mass.sum() * reference.pairs.values);
  j.C = R.transpose() * C;
  result.aligned.vectors = (result.aligned.vectors.leftCols(R.rows()) * R).eval();
  result.aligned.values.conservativeResize(R.rows());
  return result;
}
