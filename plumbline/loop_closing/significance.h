// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/matching/projection_search.h"

#include <optional>
#include <vector>

namespace plumbline {

// Returns the logarithm to base 10 of the probability of at least `successes` in `trials`
// independent trials with success probability `p`, 0 <= p <= 1: the significance of a number of
// matches (Desolneux, Moisan and Morel 2000). Returns 0 for successes <= 0. O(trials).
double Log10BinomialTail(int trials, int successes, double p);

// Returns the number of projected points that would match a feature by descriptor if the image were
// shifted: the largest under any shift that is not near zero. It reveals repetitive structure
// (bricks, windows), since a wrong relative pose is most often such a shift; otherwise it counts
// chance matches. A point matches a feature of about its octave within max_distance, for a shift
// known to about `radius_px`. O(points x features).
int BestShiftedMatches(const RectifiedCamera& camera,
                       const FrameFeatures& image,
                       const std::vector<std::optional<ProjectedPoint>>& points,
                       int max_distance,
                       double radius_px);

}  // namespace plumbline
