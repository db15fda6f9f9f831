// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/system_methods.h"

#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"

#include <fmt/format.h>

namespace plumbline {

void CheckOptions(const SlamOptions& options) { CheckOptions(options, {}); }

void CheckOptions(const SlamOptions& options, const SystemMethods& methods) {
  SlamOptions copy = options;  // the table needs references to options that may be changed
  OptionTable(copy, methods.added).CheckRanges();
  const FeatureOptions& f = options.features;
  if (!(f.points && f.point_count > 0) && !(f.lines && f.line_count > 0)) {
    throw InputError(
        "features.points, features.lines: expected at least one of them, found both off (or a "
        "count of 0)");
  }
  if (f.depth.min_depth_m >= f.depth.max_depth_m) {
    throw InputError(
        fmt::format("features.depth.min_depth_m: expected less than features.depth.max_depth_m, "
                    "{:g}, found {:g}",
                    f.depth.max_depth_m,
                    f.depth.min_depth_m));
  }
  const KeyFramePolicyOptions& keyframes = options.tracking.keyframes;
  if (keyframes.min_frames > keyframes.max_frames) {
    throw InputError(fmt::format(
        "tracking.keyframes.min_frames: expected at most tracking.keyframes.max_frames, "
        "{}, found {}",
        keyframes.max_frames,
        keyframes.min_frames));
  }
  if (options.tracking.reference != TrackingReference::kLastFrame &&
      methods.line_method(options.lines).only_odometry) {
    throw InputError(fmt::format(
        "lines.residual: {} needs tracking.reference last_frame, found local_map; maps are "
        "adjusted by other residuals",
        options.lines.residual));
  }
}

}  // namespace plumbline
