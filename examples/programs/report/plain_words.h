// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_REPORT_PLAIN_WORDS_H
#define SPECTRAL_EXAMPLES_REPORT_PLAIN_WORDS_H

#include "Comparison.h"
#include "svg_plot.h"

#include <cmath>
#include <string>

// What the figures of one run say, in sentences, for a reader who does not know the columns yet.

namespace plain_words_internal {

inline std::string percent(double x)
{
  return formatted(100 * x) + " %";
}

inline std::string about_eigenvalues(const Judgement& j)
{
  std::string text = "The first " + std::to_string(j.C.rows()) + " eigenvalues are off by " +
                     percent(j.error_mean) + " in the mean and by " + percent(j.error_max) +
                     " at worst.";
  if(std::isfinite(j.error_low_mean)) {
    const double ratio = j.error_low_mean / j.error_mean;
    text += " The low modes, 2 to " + std::to_string(j.C.rows() / 5) + ", are kept " +
            (ratio > 1.1   ? "less well"
             : ratio < 0.9 ? "better"
                           : "alike") +
            ", to " + percent(j.error_low_mean) +
            (ratio > 2 ? ": limbs may have lost their tips." : ".");
  }
  return text;
}

// `floor`: what ideal linear elements have.
inline std::string about_norm(const std::string& meaning, double norm, double floor)
{
  return meaning + " by " + formatted(norm) +
         (floor > 0 ? ", " + formatted(norm / floor) +
                          " times the estimate for ideal linear elements (" + formatted(floor) + ")"
                    : std::string());
}

inline std::string about_map(const Judgement& j)
{
  return about_norm("The functional map fails to commute with the Laplacians (|C|<sub>L</sub>)",
                    j.norms().norm_L, j.floor_norm_L) +
         about_norm(", and to be orthonormal (|C|<sub>D</sub>)", j.norms().norm_D, j.floor_norm_D) +
         ". Both would be 0 if nothing were lost.";
}

inline std::string about_area(const std::string& measure, double ratio)
{
  return "The " + measure + " is " + percent(std::abs(ratio - 1)) +
         (ratio < 1 ? " smaller" : " larger") + " than before.";
}

inline std::string about_fit(const Judgement& own, const Judgement& fitted)
{
  const auto beside = [](double x, double y) {
    return std::string(x < y ? "better than" : "not better than");
  };
  return "The fitted operators have eigenvalues off by " + percent(fitted.error_mean) +
         " in the mean, which is " + beside(fitted.error_mean, own.error_mean) +
         " the mesh's own, and |C|<sub>L</sub> " + formatted(fitted.norms().norm_L) +
         ", which is " + beside(fitted.norms().norm_L, own.norms().norm_L) + " the mesh's own.";
}

} // namespace plain_words_internal

// A list of sentences on the first result of `c`, judged once, and on its fitted operators if they
// are the second. `measure` is what the sum of the masses is: the area, or the mass.
inline std::string plain_words(const Comparison& c, const std::string& measure)
{
  using namespace plain_words_internal;
  const Simplified& s = c.results.front();
  const Judgement& j = s.judgements.front();
  std::string html = "<ul class='words'>\n";
  const auto say = [&html](const std::string& sentence) { html += "<li>" + sentence + "</li>\n"; };
  if(std::isfinite(j.error_mean))
    say(about_eigenvalues(j));
  say(about_map(j));
  say(about_area(measure, s.shape.area_ratio));
  if(c.results.size() > 1)
    say(about_fit(j, c.results[1].judgements.front()));
  return html + "</ul>\n";
}

#endif // SPECTRAL_EXAMPLES_REPORT_PLAIN_WORDS_H
