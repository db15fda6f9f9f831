// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/se3.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

// geometry_msgs/TransformStamped.
struct TransformMessage {
  std::int64_t stamp_ns = 0;
  std::string parent, child;  // names of frames
  Rigid3 parent_from_child;
};

// Parses a tf2_msgs/TFMessage of ROS 1 or (`cdr`) ROS 2, in the forms of ParseRosImage. Returns
// nullopt if the bytes are no such message, or a transform is no rigid motion.
std::optional<std::vector<TransformMessage>> ParseRosTransforms(
    bool cdr, std::span<const std::uint8_t> bytes);

}  // namespace plumbline
