// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"

namespace plumbline {

// Limits for two keyframes to count as seeing the same place.
struct LoopVerificationOptions {
  // Covisible keyframes whose landmarks are searched for as well.
  int neighbours = 8;
  // Largest Hamming distance of the descriptors that start the search.
  int max_distance = 64;
  double ratio = 0.85;           // largest ratio of the best to the second best distance
  int min_matches = 10;          // fewest points + 2 lines that match by descriptor alone
  double search_radius_px = 10;  // radius around projections in the first search; 4 in the second
  int min_inliers = 25;          // fewest points + 2 lines that agree in the end
  // Decimal logarithm of the probability of so many matches with a wrong relative pose.
  double max_log10_chance = -12;
  // Matches under another shift of the image / matches found.
  double max_rival_share = 0.4;
  // Deviation of the inliers in the image along the least axis / height of the image.
  double min_spread = 0.08;
  // Share of the cells that should show landmarks and do.
  double min_area_share = 0.4;
  double max_rotation_sigma_deg = 3;
  double max_translation_sigma = 0.1;  // relative to the depth of the scene
  // More matches than these do not make the relative pose more certain.
  int independent_matches = 30;
  // Neighbouring keyframes that must agree as well.
  int confirmations = 2;
  double max_confirming_log10_chance = -3;
};

// What odometry may have drifted between two consecutive keyframes. The standard deviations are
// meant to be too large rather than too small.
struct DriftOptions {
  double rotation_deg = 0.1;               // for each relative pose
  double rotation_per_turn = 0.01;         // in addition, relative to the rotation
  double translation_per_distance = 0.03;  // relative to the length of the motion
  double log_scale = 0.01;                 // with one camera, for each relative pose
  double log_scale_per_turn = 0.04;  // with one camera at worst, in addition, per rotation [1/rad]
  double max_chi2 = 24.3;            // 99.9 % of chi2 with seven degrees of freedom
};

struct LoopClosingOptions {
  int strong_covisibility = 60;  // fewest shared landmarks that make an edge of the pose graph
  int max_candidates = 3;        // candidates that are looked at
  // A candidate that shares so many landmarks with the query is no loop any more.
  int min_shared = 10;
  int pause = 5;  // keyframes after a closure until the next one may follow
  // A loop whose rotation is known worse waits for a nearer view. Odometry, whose drift is assumed
  // to be larger than it is, would follow it further than it should.
  double max_rotation_sigma_deg = 0.5;
  double max_odometry_chi2 = 24.3;  // limit for one edge of odometry after the correction
};

struct LoopOptions {
  bool enabled = true;
  LoopVerificationOptions verification;
  DriftOptions drift;
  LoopClosingOptions closing;
};

template <class Visitor>
void VisitFields(Visitor&& visit, LoopOptions& o) {
  visit("enabled",
        o.enabled,
        "recognize places that were seen before: close loops, and join maps that show the same "
        "place");
}

}  // namespace plumbline
