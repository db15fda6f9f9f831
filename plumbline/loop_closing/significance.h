// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/map/frame.h"
#include "plumbline/matching/projection_search.h"

#include <optional>
#include <vector>

namespace plumbline {

// Returns the logarithm to base 10 of the probability of at least `successes` in `trials`
// independent trials, each of which succeeds with probability `p`, 0 <= p <= 1. It decides whether
// so many matches mean anything (Desolneux, Moisan and Morel 2000). Returns 0 for successes <= 0.
// O(trials).
double Log10BinomialTail(int trials, int successes, double p);

// Returns how many of the projected points would find a feature that looks like them if the image
// were shifted: the most under any shift that is not near zero. This reveals what repeats in the
// image (bricks, windows), since a wrong relative pose is most often such a shift; otherwise it
// counts what is alike by chance. A point finds a feature of about its octave within max_distance,
// where the shift is known to about `radius_px`. O(points x features).
int BestShiftedMatches(const RectifiedCamera& camera,
                       const FrameFeatures& image,
                       const std::vector<std::optional<ProjectedPoint>>& points,
                       int max_distance,
                       double radius_px);

}  // namespace plumbline
