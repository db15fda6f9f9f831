// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/matching/line_matching.h"

#include "plumbline/geometry/se3.h"

#include <algorithm>
#include <numbers>

namespace plumbline {

LineMatchOptions LineMatchingOf(const LineOptions& lines,
                                const std::optional<Eigen::Quaterniond>& b_from_a) {
  LineMatchOptions options;
  options.min_length_ratio = lines.min_length_ratio;
  if (lines.rotation_gate && b_from_a) {
    const double turned = AngularDistance(Eigen::Quaterniond::Identity(), *b_from_a);
    options.max_angle_deg = std::min(options.max_angle_deg, turned * 180 / std::numbers::pi);
  }
  return options;
}

}  // namespace plumbline
