// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/options.h"

namespace plumbline {

// When two keyframes are taken to see the same place.
struct LoopVerificationOptions {
  int neighbours = 8;             // covisible keyframes whose landmarks are searched for as well
  int max_distance = 64;          // Hamming distance of descriptors that start the search
  double ratio = 0.85;            // best / second best of these
  int min_matches = 10;           // points + 2 lines matched by their looks alone
  double search_radius_px = 10;   // around projections, first search; 4 in the second
  int min_inliers = 25;           // points + 2 lines that agree in the end
  double max_log10_chance = -12;  // of as many matches with a wrong relative pose
  double max_rival_share = 0.4;   // matches under another shift of the image / those found
  double min_spread = 0.08;       // deviation of the inliers in the image / its height, least axis
  double min_area_share = 0.4;    // of the cells that should show landmarks those that do
  double max_rotation_sigma_deg = 3;
  double max_translation_sigma = 0.1;  // of the depth of the scene
  int independent_matches = 30;        // more than these do not make the relative pose more certain
  int confirmations = 2;               // neighbouring keyframes that must agree as well
  double max_confirming_log10_chance = -3;
};

// What odometry may have drifted between two keyframes that follow each other: standard deviations
// that are meant to be too large rather than too small.
struct DriftOptions {
  double rotation_deg = 0.1;               // of each relative pose
  double rotation_per_turn = 0.01;         // and this part of its rotation
  double translation_per_distance = 0.03;  // part of its length
  double log_scale = 0.01;                 // one camera: of each relative pose
  double log_scale_per_turn = 0.04;        // and this times its rotation at worst [1/rad]
  double max_chi2 = 24.3;                  // 99.9 % of chi2 with seven degrees of freedom
};

struct LoopClosingOptions {
  int strong_covisibility = 60;  // shared landmarks that make an edge of the pose graph
  int max_candidates = 3;        // of those offered that are looked at
  int min_shared = 10;           // landmarks shared with a candidate that is no loop any more
  int pause = 5;                 // keyframes after a closure before the next
  // A loop that is known worse waits for a nearer view: odometry, whose drift is taken for larger
  // than it is, would follow it further than it should.
  double max_rotation_sigma_deg = 0.5;
  double max_odometry_chi2 = 24.3;  // of one odometry edge after the correction
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
