// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_MATCHING_STARTS_H
#define SPECTRAL_EXAMPLES_MATCHING_STARTS_H

#include "matcher.h"

#include <CGAL/Spectral_toolbox/functional_map_estimation.h>

#include <Eigen/Core>

// How far a functional map is from one of an orientation-preserving isometry: departure from
// orthonormality, from commuting with the Laplace operators, and from carrying oriented derivatives
// along a few smooth functions. Small is good. Limbs that changed places and mirror images are far.
// C goes from Y to X and is square.
double strangeness(const Eigen::MatrixXd& C, const CGAL::Spectral_geometry::Spectral_shape& X,
                   const CGAL::Spectral_geometry::Spectral_shape& Y);

// The map from Y to X of `options.modes` modes, or as many as there are, that descriptors and
// landmarks lead to.
Eigen::MatrixXd map_of_descriptors(const CGAL::Spectral_geometry::Spectral_shape& X,
                                   const CGAL::Spectral_geometry::Spectral_shape& Y,
                                   const Landmarks& landmarks, const Matching_options& options,
                                   const Keep_going& keep_going);

// Tries many starts, for coarse meshes: the one whose map of 50 modes is the least strange,
// of descriptors in several settings and, without landmarks, of maps of the very first modes that
// were grown mode by mode.
Eigen::MatrixXd map_of_many_starts(const CGAL::Spectral_geometry::Spectral_shape& X,
                                   const CGAL::Spectral_geometry::Spectral_shape& Y,
                                   const Landmarks& landmarks, const Matching_options& options,
                                   const Keep_going& keep_going);

#endif // SPECTRAL_EXAMPLES_MATCHING_STARTS_H
