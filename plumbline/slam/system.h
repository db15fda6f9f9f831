// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/trajectory.h"
#include "plumbline/image/image.h"
#include "plumbline/image/rectify.h"
#include "plumbline/map/map.h"
#include "plumbline/slam/mapping_stage.h"
#include "plumbline/slam/options.h"
#include "plumbline/tracking/tracker.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
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

struct StageTime {
  std::string stage;
  double milliseconds = 0;
};

struct FrameRecord {
  FrameId id;
  std::int64_t stamp_ns = 0;
  FrameStatus status = FrameStatus::kSkipped;
  std::string reason;  // why there is no pose; empty where there is one
  MapId map;           // where there is a pose
  KeyFrameId reference;
  Rigid3 cam_from_reference;
  std::optional<Rigid3> causal_world_from_camera;  // as first reported, camera as delivered
  FrameCounts counts;
  bool keyframe = false;
  std::vector<StageTime> times;  // "total" last
};

// What Process tells of a frame beside its record, for display.
struct FrameView {
  RectifiedFrame images;
  Frame frame;  // features; matches where tracked
};

// The whole pipeline for one camera: feed frames in order, then Finish.
//
// Poses are world_from_camera of the left camera as delivered (before rectification); the world is
// that camera at the first keyframe of each map. Not thread-safe.
class System {
 public:
  // Throws InputError for a calibration that cannot be used.
  System(const Calibration& calibration, const SlamOptions& options);
  ~System();
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  // Throws InputError when an image has another size than the calibration says.
  const FrameRecord& Process(SensorFrame frame);
  // A frame that could not be read.
  const FrameRecord& Skip(std::int64_t stamp_ns, const std::string& reason);
  // Completes the mapping of all frames so far.
  void Finish();

  const std::vector<FrameRecord>& frames() const { return frames_; }
  const std::vector<Map>& maps() const { return mapping_.maps(); }
  const RectifiedCamera& camera() const { return rectifier_.camera(); }
  const Rectifier& rectifier() const { return rectifier_; }
  // The last processed frame.
  const FrameView& view() const { return view_; }

  // Poses of the camera as delivered, by the map as it is now; frames in order of time.
  Trajectory FinalTrajectory(MapId map) const;
  Trajectory KeyFrameTrajectory(MapId map) const;
  Trajectory CausalTrajectory(MapId map) const;
  // The map in which most frames have a pose (the earlier of two); nullopt when none has.
  std::optional<MapId> MainMap() const;

 private:
  Rigid3 AsDelivered(const Rigid3& rectified_cam_from_world) const;
  void RecordTracking(const TrackingResult& result, FrameRecord& record) const;

  SlamOptions options_;
  Rectifier rectifier_;
  ImagingModel imaging_;
  ValidRegion left_valid_;
  ValidRegion right_valid_;
  MappingStage mapping_;
  Tracker tracker_;
  std::vector<FrameRecord> frames_;
  FrameView view_;
};

}  // namespace plumbline
