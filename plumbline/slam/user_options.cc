// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/user_options.h"

#include <algorithm>
#include <array>

namespace plumbline {
namespace {

constexpr std::array<std::string_view, 31> kUserOptions = {"slam.mode",
                                                           "slam.seed",
                                                           "slam.lag",
                                                           "features.points",
                                                           "features.point_count",
                                                           "features.lines",
                                                           "features.line_count",
                                                           "features.line_detector",
                                                           "features.parallel",
                                                           "features.line.min_length",
                                                           "features.depth.min_depth_m",
                                                           "features.depth.max_depth_m",
                                                           "lines.weighting",
                                                           "cutting.method",
                                                           "cutting.information",
                                                           "cutting.budget",
                                                           "initialization.method",
                                                           "initialization.frames",
                                                           "initialization.matching",
                                                           "tracking.reference",
                                                           "tracking.new_map_after",
                                                           "tracking.keyframes.min_frames",
                                                           "tracking.keyframes.max_frames",
                                                           "relocalization.enabled",
                                                           "relocalization.patience",
                                                           "mapping.cleanup.revisited_share",
                                                           "mapping.stereo_calibration",
                                                           "mapping.lens_calibration",
                                                           "mapping.final_adjustment_keyframes",
                                                           "mapping.line_map.min_keyframes",
                                                           "loop.enabled"};

}  // namespace

bool IsUserOption(std::string_view key) {
  return std::find(kUserOptions.begin(), kUserOptions.end(), key) != kUserOptions.end();
}

}  // namespace plumbline
