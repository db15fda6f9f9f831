// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/user_options.h"

#include <algorithm>
#include <array>

namespace plumbline {
namespace {

constexpr std::array<std::string_view, 26> kUserOptions = {"slam.mode",
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
                                                           "initialization.frames",
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
                                                           "mapping.line_map.max_mean_chi2",
                                                           "mapping.line_map.min_mean_length_px",
                                                           "loop.enabled"};

constexpr std::array<std::string_view, 25> kPaperOptions = {
    "features.line.merge",
    "features.line.refine",
    "lines.residual",
    "lines.reconstruction",
    "lines.weighting",
    "lines.constant_sigma_px",
    "lines.min_length_ratio",
    "lines.rotation_gate",
    "cutting.method",
    "cutting.information",
    "cutting.ends",
    "cutting.end_sigma",
    "initialization.method",
    "initialization.relative_pose",
    "initialization.factorize",
    "initialization.interpolate",
    "initialization.min_line_angle_deg",
    "initialization.reweighting",
    "initialization.matching",
    "initialization.pairwise.missing",
    "initialization.pairwise.reject_outliers",
    "initialization.pairwise.adjust",
    "tracking.reference",
    "mapping.window.parallel_lines",
    "mapping.ba.robust"};

constexpr const char* kPapersHeading =
    "\n# Of the papers' presets: what these, their experiments and their controls set.\n";

}  // namespace

OptionTier TierOf(std::string_view key) {
  const auto holds = [key](const auto& keys) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  if (holds(kUserOptions)) return OptionTier::kUser;
  return holds(kPaperOptions) ? OptionTier::kPaper : OptionTier::kMethod;
}

std::string ListOptions(const OptionTable& table) {
  const auto of_papers = [](const OptionField& field) {
    return TierOf(field.key) == OptionTier::kPaper;
  };
  return table.Dump([&](const OptionField& field) { return !of_papers(field); }) + kPapersHeading +
         table.DumpDotted(of_papers);
}

}  // namespace plumbline
