// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/base/ids.h"
#include "plumbline/map/placement.h"
#include "plumbline/slam/load_shedding.h"
#include "plumbline/slam/stage_clock.h"
#include "plumbline/tracking/pose_search.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// What came of one input frame.
enum class FrameStatus { kTracked, kLost, kInitializing, kSkipped };
constexpr auto EnumNames(std::type_identity<FrameStatus>) {
  return std::array{std::pair{FrameStatus::kTracked, "tracked"},
                    std::pair{FrameStatus::kLost, "lost"},
                    std::pair{FrameStatus::kInitializing, "initializing"},
                    std::pair{FrameStatus::kSkipped, "skipped"}};
}

// All that is kept of one frame.
struct FrameRecord {
  FrameId id;
  std::int64_t stamp_ns = 0;
  FrameStatus status = FrameStatus::kSkipped;
  std::string reason;  // why there is no pose; empty where there is one
  MapId map;           // that the pose was reported in, where there is one (Atlas::Current)
  KeyFrameId reference;
  RelativePose from_reference;
  std::optional<Rigid3> causal_world_from_camera;  // as first reported, camera as delivered
  FrameCounts counts;                              // of from_reference
  bool keyframe = false;
  Shed shed = Shed::kNothing;  // what a live run left undone for this frame
  bool demoted = false;        // was a keyframe until mapping had no time for it
  // In order. "total" is from the frame's arrival to its pose; after_* are what was done for the
  // frame since (System::Complete). map_* are steps of mapping that ended since the last frame,
  // inline within "map", otherwise beside.
  std::vector<StageTime> times;
};

}  // namespace plumbline
