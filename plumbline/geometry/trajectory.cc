// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/trajectory.h"

#include "plumbline/geometry/se3.h"

#include <algorithm>
#include <cstddef>
#include <string>

namespace plumbline {
namespace {

// Returns the first pose at or after the stamp.
Trajectory::const_iterator LowerBound(const Trajectory& trajectory, std::int64_t stamp_ns) {
  return std::ranges::lower_bound(trajectory, stamp_ns, {}, &StampedPose::stamp_ns);
}

Rigid3 PoseOf(const StampedPose& stamped) {
  const Rigid3& pose = stamped.world_from_camera;
  return {UnitRotation(pose.rotation, "a pose of the trajectory"), pose.translation};
}

}  // namespace

std::optional<Rigid3> InterpolateAt(const Trajectory& trajectory,
                                    std::int64_t stamp_ns,
                                    std::int64_t max_gap_ns) {
  const auto after = LowerBound(trajectory, stamp_ns);
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return PoseOf(*after);
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const std::int64_t gap = after->stamp_ns - before->stamp_ns;
  if (gap > max_gap_ns) return std::nullopt;
  const double s = static_cast<double>(stamp_ns - before->stamp_ns) / static_cast<double>(gap);
  return Interpolate(PoseOf(*before), PoseOf(*after), s);
}

std::optional<std::size_t> NearestIndex(const Trajectory& trajectory,
                                        std::int64_t stamp_ns,
                                        std::int64_t max_difference_ns) {
  if (trajectory.empty()) return std::nullopt;
  auto nearest = LowerBound(trajectory, stamp_ns);
  if (nearest == trajectory.end() ||
      (nearest != trajectory.begin() &&
       stamp_ns - std::prev(nearest)->stamp_ns <= nearest->stamp_ns - stamp_ns)) {
    --nearest;
  }
  const std::int64_t difference =
      std::max(nearest->stamp_ns, stamp_ns) - std::min(nearest->stamp_ns, stamp_ns);
  if (difference > max_difference_ns) return std::nullopt;
  return static_cast<std::size_t>(nearest - trajectory.begin());
}

Trajectory TimeReversed(Trajectory trajectory, std::int64_t mirror_ns) {
  std::ranges::reverse(trajectory);
  for (StampedPose& pose : trajectory) pose.stamp_ns = mirror_ns - pose.stamp_ns;
  return trajectory;
}

Trajectory WithUnitRotations(Trajectory trajectory, std::string_view what) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    Eigen::Quaterniond& rotation = trajectory[i].world_from_camera.rotation;
    if (IsRotation(rotation)) {
      rotation = UnitRotation(rotation, what);
    } else {
      UnitRotation(rotation, std::string(what) + ": pose " + std::to_string(i) + " (from 0)");
    }
  }
  return trajectory;
}

double PathLength(const Trajectory& trajectory) {
  double length = 0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length += (trajectory[i].world_from_camera.translation -
               trajectory[i - 1].world_from_camera.translation)
                  .norm();
  }
  return length;
}

}  // namespace plumbline
