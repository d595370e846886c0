// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_JUDGEMENT_H
#define SPECTRAL_EXAMPLES_REPORT_JUDGEMENT_H

#include "../compare/mode_alignment.h"
#include "Comparison.h"

#include <CGAL/Spectral_geometry/functional_map.h>

#include <utility>

// Errors of the modes 2 to K/5 of the meshes as they are.
inline CGAL::Spectral_geometry::Eigenvalue_errors
low_errors_at_input_scale(const CGAL::Spectral_geometry::Spectral_evaluation& e)
{
  return CGAL::Spectral_geometry::eigenvalue_errors(e.fine_values / e.fine_area,
                                                    e.coarse_values / e.coarse_area, 1,
                                                    e.judged_modes / 5, e.fine_zeros);
}

// Takes over what an evaluation says of the spectrum, and its norms as those of the carried P or of
// the closest points.
inline void add_evaluation(Judgement& j, const CGAL::Spectral_geometry::Spectral_evaluation& e,
                           bool carried)
{
  (carried ? j.carried : j.closest) = Map_norms{e.norm_L,
                                                e.norm_D,
                                                e.norm_D_extended,
                                                e.norm_L_input_scale,
                                                e.norm_L_common_scale,
                                                e.norm_D_input_scale};
  j.floor_norm_L = e.floor_norm_L;
  j.floor_norm_D = e.floor_norm_D;
  j.span_loss = e.span_loss;
  j.error_mean = e.errors.mean;
  j.error_max = e.errors.max;
  j.error_low_mean = e.errors_low.mean;
  j.error_beyond_mean = e.errors_beyond.mean;
  j.error_beyond_max = e.errors_beyond.max;
  j.error_input_scale_mean = e.errors_input_scale.mean;
  j.error_input_scale_max = e.errors_input_scale.max;
  j.error_input_scale_low_mean = low_errors_at_input_scale(e).mean;
  j.coarse_values = e.coarse_values;
}

// One evaluation as a comparison of one, for the page. `run` says what was evaluated: its
// judgements are replaced.
inline Comparison single_run(const CGAL::Spectral_geometry::Spectral_evaluation& e, Simplified run)
{
  Judgement j;
  j.mass = e.mass;
  add_evaluation(j, e, true);
  j.C = aligning_rotation(e.C, e.fine_values).transpose() * e.C;
  run.shape.area_ratio = e.area_ratio;
  run.judgements = {j};

  Comparison c;
  c.is_run = true;
  c.area = e.fine_area;
  c.K = e.requested_modes;
  c.fine.push_back({e.mass, e.fine_values, e.fine_zeros, not_computed, not_computed});
  c.results.push_back(std::move(run));
  return c;
}

#endif // SPECTRAL_EXAMPLES_REPORT_JUDGEMENT_H
