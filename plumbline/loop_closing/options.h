// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"

namespace plumbline {

// Limits for two keyframes to count as seeing the same place.
struct LoopVerificationOptions {
  // Number of covisible keyframes whose landmarks are searched as well.
  int neighbours = 8;
  // Largest Hamming distance of the initial descriptor matches.
  int max_distance = 64;
  double ratio = 0.85;           // largest ratio of the best to the second best distance
  int min_matches = 10;          // least number of points + 2 lines matched by descriptor alone
  double search_radius_px = 10;  // radius around projections in the first search; 4 in the second
  int min_inliers = 25;          // least number of points + 2 lines that agree in the end
  // Decimal logarithm of the probability of this many matches with a wrong relative pose.
  double max_log10_chance = -12;
  // Matches under another shift of the image / matches found.
  double max_rival_share = 0.4;
  // Standard deviation of the inliers in the image along the least axis / height of the image.
  double min_spread = 0.08;
  // Share of the cells with predicted landmarks that have matches.
  double min_area_share = 0.4;
  double max_rotation_sigma_deg = 3;
  double max_translation_sigma = 0.1;  // relative to the depth of the scene
  // Number of matches beyond which the relative pose does not become more certain.
  int independent_matches = 30;
  // Number of neighbouring keyframes that must agree as well.
  int confirmations = 2;
  double max_confirming_log10_chance = -3;
};

// Drift of odometry between two consecutive keyframes. The standard deviations are chosen rather
// too large than too small.
struct DriftOptions {
  double rotation_deg = 0.1;               // for each relative pose
  double rotation_per_turn = 0.01;         // in addition, relative to the rotation
  double translation_per_distance = 0.03;  // relative to the length of the motion
  double log_scale = 0.01;                 // with one camera, for each relative pose
  double log_scale_per_turn = 0.04;  // with one camera at worst, in addition, per rotation [1/rad]
  double max_chi2 = 24.3;            // 99.9 % of chi2 with seven degrees of freedom
};

struct LoopOptions {
  bool enabled = true;
  LoopVerificationOptions verification;
  DriftOptions drift;
  // Constants of closing a loop:
  int strong_covisibility = 60;  // least number of shared landmarks for an edge of the pose graph
  int max_candidates = 3;        // candidates to be tried
  // Least number of landmarks shared with the query for which a candidate is no loop any more.
  int min_shared = 10;
  int pause = 5;  // keyframes from a closure to the next possible one
  // A loop with a larger uncertainty of rotation waits for a nearer view. Odometry, whose assumed
  // drift is too large, would follow it further than it should.
  double max_rotation_sigma_deg = 0.5;
  double max_odometry_chi2 = 24.3;  // limit for one edge of odometry after the correction
};

template <class Visitor>
void VisitFields(Visitor&& visit, LoopOptions& o) {
  visit("enabled",
        o.enabled,
        "recognize places that were seen before: close loops, and join maps that show the same "
        "place");
}

}  // namespace plumbline
