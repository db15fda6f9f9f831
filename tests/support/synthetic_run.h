// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/mapper_thread.h"
#include "plumbline/slam/options.h"
#include "plumbline/tracking/tracker.h"

#include "tests/support/synthetic_world.h"
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace plumbline {

// Tracker and mapping together on frames without images: the part of System after the features.
class SyntheticRun {
 public:
  SyntheticRun(const SyntheticWorld& world,
               const SlamOptions& options = InlineOptions(),
               const SystemMethods& methods = {})
      : world_(world),
        mapping_(world.Imaging(), options, {}, methods),
        tracker_(world.Imaging(),
                 options.tracking,
                 methods.MakePoseEstimator(world.camera, options),
                 Rigid3{}) {}

  static SlamOptions InlineOptions() {
    SlamOptions options;
    options.slam.mode = RunMode::kInline;
    return options;
  }

  // Steps to the next frame.
  TrackingResult Step(const SyntheticFrame& sensed) {
    const std::int64_t frame = next_++;
    const auto snapshot = mapping_.SnapshotFor(frame);
    TrackingResult result =
        tracker_.Track(FrameId{frame}, 50'000'000 * frame, sensed.indexed, snapshot.get());
    if (result.keyframe) mapping_.Submit(frame, *result.keyframe, result.starts_map);
    return result;
  }
  TrackingResult Step(const Rigid3& cam_from_world, const SensorModel& sensor) {
    Rng rng(1, "synthetic_run", static_cast<std::uint64_t>(next_));
    return Step(Sense(world_, cam_from_world, sensor, rng));
  }
  // Starts a map from several frames, the last of which is the next frame.
  TrackingResult Start(const InitialMap& initial, const Vector6d& velocity) {
    next_ = initial.views.back().frame.id.value;
    const InitialMapEdit start =
        MakeInitialMapEdit(initial, world_.Imaging(), Rigid3{}, tracker_.next_keyframe());
    mapping_.Submit(next_, start);
    return tracker_.StartFrom(*mapping_.SnapshotFor(next_++), velocity);
  }
  // Steps to a frame without features.
  TrackingResult StepBlind() { return Step({IndexFeatures(world_.camera, {}), {}, {}}); }

  void Finish() { mapping_.Finish(); }
  const std::map<MapId, Map>& maps() const { return mapping_.maps(); }
  const Tracker& tracker() const { return tracker_; }
  const MapperThread& mapping() const { return mapping_; }

 private:
  SyntheticWorld world_;
  MapperThread mapping_;
  Tracker tracker_;
  std::int64_t next_ = 0;
};

}  // namespace plumbline
