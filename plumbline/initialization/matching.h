// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/features/match_lines.h"
#include "plumbline/features/match_points.h"
#include "plumbline/features/types.h"
#include "plumbline/geometry/rectified_camera.h"
#include "plumbline/initialization/image_motion.h"
#include "plumbline/solvers/relative_pose.h"

#include <span>
#include <vector>

namespace plumbline {

struct ReferenceMatchOptions {
  double first_window_px = 100;   // half width around the guess, where the motion is not yet known
  double guessed_window_px = 50;  // half width around `guess`, where it is known
  int first_max_distance = 60;    // Hamming, of 256 bits
  double first_ratio = 0.8;       // best / second best in the window
  double window_px = 25;          // half width around the place that other matches predict
  int max_distance = 70;
  double ratio = 0.9;
  double max_roll_error_deg = 15;  // orientation against the roll of the camera
  double max_line_offset_px = 15;  // across, of a line's midpoint from its predicted place
};

// Features of a reference frame (a) found again in a later frame (b).
struct ReferenceMatches {
  std::vector<PointMatch> points;  // by feature of the reference
  std::vector<LineMatch> lines;
  ImageMotion motion;  // from the reference to the frame: the guess for the next frame
};

// Matches the points and lines of a reference frame with those of a later frame by descriptor.
//
// Points twice: first in a wide window around the place that `guess` gives, and of these only
// matches whose orientation goes with the roll of the camera and whose place goes with that of
// their neighbours; then all points in a narrow window around the place that those predict. Lines
// after that, warped by the same motion.
//
//   guess    the motion to an earlier frame near to this one; a default one for the first
//   returns  at most one match for each feature
//   cost     about 5 ms for 1000 points and 200 lines, less with a guess
ReferenceMatches MatchToReference(const Features& reference,
                                  const Features& frame,
                                  const ImageMotion& guess = {},
                                  const ReferenceMatchOptions& options = {});

// Matches as rays, for the solvers of two views: one for each pair, in order.
std::vector<RayMatch> RayMatchesOf(const RectifiedCamera& camera,
                                   const Features& a,
                                   const Features& b,
                                   std::span<const PointMatch> matches);

}  // namespace plumbline
