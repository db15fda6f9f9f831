// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/system.h"

#include <map>
#include <utility>

namespace plumbline {
namespace {

// Pose that a map's first frame gets: the world is the camera as delivered, the tracker's camera
// the rectified one.
Rigid3 WorldFromFirstCamera(const Rectifier& rectifier) {
  return {rectifier.rectified_left_from_left().conjugate(), Eigen::Vector3d::Zero()};
}

}  // namespace

System::System(const Calibration& calibration, const SlamOptions& options)
    : options_(options),
      front_end_(calibration, options.rectification, options.features),
      imaging_{front_end_.rectifier().camera(), options.features.orb.scale_factor},
      mapping_(imaging_, options_),
      tracker_(imaging_,
               options_.tracking,
               options_.lines.weighting,
               WorldFromFirstCamera(front_end_.rectifier())) {}

System::~System() = default;

const FrameRecord& System::Skip(std::int64_t stamp_ns, const std::string& reason) {
  FrameRecord record;
  record.id = FrameId{static_cast<std::int64_t>(frames_.size())};
  record.stamp_ns = stamp_ns;
  record.reason = reason;
  frames_.push_back(std::move(record));
  return frames_.back();
}

const FrameRecord& System::Process(SensorFrame frame) { return Track(Measure(std::move(frame))); }

const FrameRecord& System::Track(MeasuredFrame measured) {
  FrameRecord record;
  record.id = FrameId{static_cast<std::int64_t>(frames_.size())};
  record.stamp_ns = measured.stamp_ns;
  StageClock clock = std::move(measured.clock);
  clock.Done("wait");  // until tracking had time

  const auto snapshot = mapping_.SnapshotFor(record.id.value);
  clock.Done("map");
  for (const MappingStep& step : mapping_.TakeTimes()) {
    clock.Add("map_" + step.name, step.milliseconds);
  }
  const bool behind = options_.slam.mode == RunMode::kLive && mapping_.Behind();
  TrackingResult result = tracker_.Track(
      record.id, record.stamp_ns, std::move(measured.indexed), snapshot.get(), behind);
  if (result.keyframe) {
    mapping_.Submit(record.id.value, std::move(*result.keyframe), result.starts_map);
    record.keyframe = true;
    maps_started_ += result.starts_map;
  }
  clock.Done("track");
  RecordTracking(result, record);
  record.times = clock.Finish();
  view_ = {std::move(measured.images), std::move(result.frame)};
  frames_.push_back(std::move(record));
  return frames_.back();
}

void System::RecordTracking(const TrackingResult& result, FrameRecord& record) const {
  record.counts = result.counts;
  if (!result.cam_from_world) {
    record.status = result.state == TrackerState::kInitializing ? FrameStatus::kInitializing
                                                                : FrameStatus::kLost;
    record.reason = NameOf(result.failure);
    return;
  }
  record.status = FrameStatus::kTracked;
  record.map = MapId{maps_started_ - 1};
  record.reference = result.reference;
  record.cam_from_reference = result.cam_from_reference;
  record.causal_world_from_camera = AsDelivered(*result.cam_from_world);
}

void System::Finish() { mapping_.Finish(); }

Rigid3 System::AsDelivered(const Rigid3& rectified_cam_from_world) const {
  const Rigid3 rectified_from_delivered{rectifier().rectified_left_from_left(),
                                        Eigen::Vector3d::Zero()};
  return Inverse(rectified_cam_from_world) * rectified_from_delivered;
}

Trajectory System::FinalTrajectory(MapId map) const {
  Trajectory trajectory;
  const Map& owner = maps().at(static_cast<std::size_t>(map.value));
  for (const FrameRecord& record : frames_) {
    if (record.status != FrameStatus::kTracked || record.map != map) continue;
    trajectory.push_back(
        {record.stamp_ns, AsDelivered(record.cam_from_reference * owner.PoseOf(record.reference))});
  }
  return trajectory;
}

Trajectory System::KeyFrameTrajectory(MapId map) const {
  Trajectory trajectory;
  const Map& owner = maps().at(static_cast<std::size_t>(map.value));
  for (const auto& [id, keyframe] : owner.keyframes()) {
    trajectory.push_back({keyframe.frame.stamp_ns, AsDelivered(keyframe.frame.cam_from_world)});
  }
  return trajectory;
}

Trajectory System::CausalTrajectory(MapId map) const {
  Trajectory trajectory;
  for (const FrameRecord& record : frames_) {
    if (record.causal_world_from_camera && record.map == map) {
      trajectory.push_back({record.stamp_ns, *record.causal_world_from_camera});
    }
  }
  return trajectory;
}

std::optional<MapId> System::MainMap() const {
  std::map<MapId, int> frames;
  for (const FrameRecord& record : frames_) {
    if (record.status == FrameStatus::kTracked) ++frames[record.map];
  }
  std::optional<MapId> main;
  for (const auto& [id, count] : frames) {
    if (!main || count > frames[*main]) main = id;
  }
  return main;
}

}  // namespace plumbline
