// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_COMPARISON_TABLE_H
#define SPECTRAL_EXAMPLES_REPORT_COMPARISON_TABLE_H

#include "../io/program.h"
#include "Comparison.h"
#include "html_figures.h"

#include <cmath>
#include <cstdio>
#include <string>

// The comparison on a terminal: the figures that matter most, one line per result and mass.

namespace comparison_table_internal {

inline std::string cell(double x, int width, int digits)
{
  char text[64];
  if(std::isfinite(x))
    std::snprintf(text, sizeof(text), "%*.*f", width, digits, x);
  else
    std::snprintf(text, sizeof(text), "%*s", width, "-");
  return text;
}

inline void print_block(const Comparison& c, std::size_t N, const std::string& mass)
{
  std::printf("\nN = %zu, judged in the %s mass\n", N, mass.c_str());
  std::printf("%-40s %-8s %-8s %-5s %6s %8s %6s %9s %8s %7s %7s %7s %7s %7s %6s %8s\n",
              "simplifier", "place", "metric", "reloc", "N", "|C|_L", "|C|_D", "L closest",
              "D close.", "err %", "low %", "span %", "diff %", "HKS %", "Hd %", "total s");
  double floor_L = not_computed, floor_D = not_computed;
  for(const auto& [s, j] : html_internal::judged(c, N, mass)) {
    const Map_norms closest = j->closest ? *j->closest : Map_norms();
    std::printf("%-40s %-8s %-8s %-5s %6zu %s %s %s %s %s %s %s %s %s %s %s\n",
                printable(s->simplifier).c_str(), s->placement.c_str(), s->metric_mass.c_str(),
                s->relocation.c_str(), s->vertices, cell(j->norms().norm_L, 8, 2).c_str(),
                cell(j->norms().norm_D, 6, 2).c_str(), cell(closest.norm_L, 9, 2).c_str(),
                cell(closest.norm_D, 8, 2).c_str(), cell(100 * j->error_mean, 7, 2).c_str(),
                cell(100 * j->error_low_mean, 7, 2).c_str(), cell(100 * j->span_loss, 7, 2).c_str(),
                cell(100 * j->distances.diffusion, 7, 2).c_str(),
                cell(100 * j->distances.heat_kernel_signature, 7, 2).c_str(),
                cell(100 * s->shape.hausdorff, 6, 2).c_str(),
                cell(s->seconds_total(), 8, 2).c_str());
    floor_L = j->floor_norm_L;
    floor_D = j->floor_norm_D;
  }
  std::printf("%-71s %s %s\n", "ideal linear elements (estimate)", cell(floor_L, 8, 2).c_str(),
              cell(floor_D, 6, 2).c_str());
}

} // namespace comparison_table_internal

inline void print_comparison(const Comparison& c)
{
  std::printf("%s, %zu vertices, K = %d; norms at unit area, not squared; closest: with the P of "
              "the closest "
              "points\n",
              printable(c.mesh).c_str(), c.vertices, static_cast<int>(c.K));
  for(const std::size_t N : html_internal::sizes(c))
    for(const Fine_spectrum& f : c.fine)
      comparison_table_internal::print_block(c, N, f.mass);
  if(!c.refused.empty())
    std::printf("\nrefused\n");
  for(const Refused& r : c.refused)
    std::printf("%-40s %s\n", printable(r.name).c_str(), printable(r.reason).c_str());
  for(const std::string& note : html_internal::all_notes(c))
    std::printf("\n%s\n", printable(note).c_str());
}

#endif // SPECTRAL_EXAMPLES_REPORT_COMPARISON_TABLE_H
