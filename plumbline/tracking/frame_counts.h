// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline {

// Numbers of landmark matches of a frame, and of their inliers.
struct FrameCounts {
  int matched_points = 0, matched_lines = 0;
  int inlier_points = 0, inlier_lines = 0;
  int cut_lines = 0;  // of the pose that was accepted (PoseEstimate::cut_lines)
};

}  // namespace plumbline
