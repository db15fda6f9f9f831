// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/system.h"

#include "plumbline/features/extractor.h"

#include <chrono>
#include <map>
#include <utility>

namespace plumbline {
namespace {

// Times consecutive stages of one frame.
class StageClock {
 public:
  explicit StageClock(std::vector<StageTime>& times) : times_(times) {}

  void Done(const std::string& stage) {
    const auto now = Clock::now();
    times_.push_back({stage, Milliseconds(now - last_)});
    last_ = now;
  }
  void Total() { times_.push_back({"total", Milliseconds(Clock::now() - start_)}); }

 private:
  using Clock = std::chrono::steady_clock;
  static double Milliseconds(Clock::duration d) {
    return std::chrono::duration<double, std::milli>(d).count();
  }

  std::vector<StageTime>& times_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

std::shared_ptr<const IndexedFeatures> Index(const RectifiedCamera& camera, Features features) {
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(features.points.size());
  for (const PointFeature& point : features.points) positions.push_back(point.px);
  PointGrid grid(positions, camera.width, camera.height);
  return std::make_shared<const IndexedFeatures>(
      IndexedFeatures{std::move(features), std::move(grid)});
}

ValidRegion RegionOf(const GrayImage& mask) {
  return mask.empty() ? ValidRegion(0, 0) : ValidRegion(mask);
}

// Pose that a map's first frame gets: the world is the camera as delivered, the tracker's camera
// the rectified one.
Rigid3 WorldFromFirstCamera(const Rectifier& rectifier) {
  return {rectifier.rectified_left_from_left().conjugate(), Eigen::Vector3d::Zero()};
}

}  // namespace

System::System(const Calibration& calibration, const SlamOptions& options)
    : options_(options),
      rectifier_(calibration, options.rectification),
      imaging_{rectifier_.camera(), options.features.orb.scale_factor},
      left_valid_(RegionOf(rectifier_.left_mask())),
      right_valid_(RegionOf(rectifier_.right_mask())),
      mapping_(imaging_, options_),
      tracker_(
          imaging_, options_.tracking, options_.lines.weighting, WorldFromFirstCamera(rectifier_)) {
}

System::~System() = default;

const FrameRecord& System::Skip(std::int64_t stamp_ns, const std::string& reason) {
  FrameRecord record;
  record.id = FrameId{static_cast<std::int64_t>(frames_.size())};
  record.stamp_ns = stamp_ns;
  record.reason = reason;
  frames_.push_back(std::move(record));
  return frames_.back();
}

const FrameRecord& System::Process(SensorFrame sensor_frame) {
  FrameRecord record;
  record.id = FrameId{static_cast<std::int64_t>(frames_.size())};
  record.stamp_ns = sensor_frame.stamp_ns;
  StageClock clock(record.times);

  view_.images = rectifier_.Apply(std::move(sensor_frame));
  clock.Done("rectify");

  FeatureInput input;
  input.left = &view_.images.left;
  input.left_valid = &left_valid_;
  if (view_.images.right) {
    input.right = &*view_.images.right;
    input.right_valid = &right_valid_;
  }
  if (view_.images.depth) input.depth = &*view_.images.depth;
  auto indexed = Index(imaging_.camera, ExtractFeatures(imaging_.camera, input, options_.features));
  clock.Done("features");

  const auto snapshot = mapping_.SnapshotFor(record.id.value);
  for (const MappingStep& step : mapping_.TakeTimes()) {
    record.times.push_back({"map_" + step.name, step.milliseconds});
  }
  clock.Done("map");

  TrackingResult result =
      tracker_.Track(record.id, record.stamp_ns, std::move(indexed), snapshot.get());
  view_.frame = std::move(result.frame);
  clock.Done("track");

  if (result.keyframe) {
    mapping_.Submit(record.id.value, std::move(*result.keyframe), result.starts_map);
    record.keyframe = true;
    for (const MappingStep& step : mapping_.TakeTimes()) {
      record.times.push_back({"map_" + step.name, step.milliseconds});
    }
  }
  clock.Done("submit");
  clock.Total();
  RecordTracking(result, record);
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
  record.map = mapping_.maps().back().id();
  record.reference = result.reference;
  record.cam_from_reference = result.cam_from_reference;
  record.causal_world_from_camera = AsDelivered(*result.cam_from_world);
}

void System::Finish() { mapping_.Finish(); }

Rigid3 System::AsDelivered(const Rigid3& rectified_cam_from_world) const {
  const Rigid3 rectified_from_delivered{rectifier_.rectified_left_from_left(),
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
