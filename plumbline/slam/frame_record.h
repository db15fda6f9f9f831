// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/map/keyframe_pose.h"
#include "plumbline/slam/load_level.h"
#include "plumbline/slam/stage_clock.h"
#include "plumbline/tracking/frame_counts.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Result of an input frame.
enum class FrameStatus { kTracked, kLost, kInitializing, kSkipped };
constexpr auto EnumNames(std::type_identity<FrameStatus>) {
  return std::array{std::pair{FrameStatus::kTracked, "tracked"},
                    std::pair{FrameStatus::kLost, "lost"},
                    std::pair{FrameStatus::kInitializing, "initializing"},
                    std::pair{FrameStatus::kSkipped, "skipped"}};
}

// Record of one frame. Its pose is relative (`from_reference`) to the keyframe `reference`, so that
// later corrections of the map move it, too.
struct FrameRecord {
  FrameId id;
  std::int64_t stamp_ns = 0;
  FrameStatus status = FrameStatus::kSkipped;
  std::string reason;  // reason without a pose; else empty
  // Map in which the pose was reported; it may have been merged into another since
  // (Atlas::Current).
  MapId map;
  KeyFrameId reference;
  RelativePose from_reference;
  // Pose world_from_camera of the left camera as delivered (before rectification), as first
  // reported, before later corrections; nullopt if the frame got its pose later.
  std::optional<Rigid3> causal_world_from_camera;
  // Covariance of causal_world_from_camera relative to the map, along the axes of the world, of [x,
  // y, z, rotation about x, y, z] (PoseCovarianceInWorld), in square metres and radians, with one
  // camera in map units; nullopt without a causal pose, or if the pose was not estimated from
  // matches (TrackingResult::covariance).
  std::optional<Matrix6d> causal_covariance;
  FrameCounts counts;  // matches and inliers of the pose, or of the attempt that failed
  bool keyframe = false;
  LoadLevel shed = LoadLevel::kNothing;  // work that a live run left out for this frame
  bool demoted = false;  // true if the frame was a keyframe that mapping had no time for
  // Times of the frame, in order. "total" runs from the frame's arrival to its pose. after_* is the
  // work for the frame after its pose was known (System::Complete). map_* are steps of mapping that
  // ended since the last frame: part of "map" in inline mode, in other modes concurrent with the
  // frame's own work.
  std::vector<StageTime> times;
};

// The covariance of a pose at one time (FrameRecord::causal_covariance).
struct StampedCovariance {
  std::int64_t stamp_ns = 0;
  Matrix6d covariance;
};

}  // namespace plumbline
