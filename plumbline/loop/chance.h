// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/association/projection_search.h"
#include "plumbline/map/frame.h"

#include <optional>
#include <vector>

namespace plumbline {

// The logarithm to base 10 of the probability of at least `successes` in `trials` independent
// trials that each succeed with probability `p`, 0 <= p <= 1: what decides whether so many matches
// mean anything (Desolneux, Moisan and Morel 2000). 0 for successes <= 0. O(trials).
double Log10BinomialTail(int trials, int successes, double p);

// How many of the projected points would find a feature that looks like them, had the image been
// shifted: the most under any shift that is not near none. What repeats in the image (bricks,
// windows) shows here, since a wrong relative pose is most often such a shift; elsewhere it counts
// what is alike by chance. A point finds a feature of about its octave within max_distance, with
// the shift known to about `radius_px`. O(points x features).
int BestShiftedMatches(const RectifiedCamera& camera,
                       const IndexedFeatures& image,
                       const std::vector<std::optional<ProjectedPoint>>& points,
                       int max_distance,
                       double radius_px);

}  // namespace plumbline
