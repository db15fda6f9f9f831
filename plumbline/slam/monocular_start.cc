// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/monocular_start.h"

#include "plumbline/image/image.h"
#include "plumbline/map/snapshot.h"

#include <cstddef>
#include <optional>
#include <utility>

namespace plumbline {
namespace {

constexpr int kSnapshotKeyFrames = 40;
constexpr int kMaxMissed = 5;  // frames in a row; those before them are left alone

// Goes back in time from a known pose with constant velocity.
class BackwardPrediction {
 public:
  bool Known() const { return last_.has_value(); }

  Rigid3 At(std::int64_t stamp_ns) const {
    const double seconds = 1e-9 * static_cast<double>(stamp_ns - last_->stamp_ns);
    return RetractLeft(last_->cam_from_world, seconds * velocity_);
  }

  void Add(std::int64_t stamp_ns, const Rigid3& cam_from_world) {
    if (last_) {
      const double seconds = 1e-9 * static_cast<double>(stamp_ns - last_->stamp_ns);
      velocity_ = LogSe3(cam_from_world * Inverse(last_->cam_from_world)) / seconds;
    }
    last_ = Pose{stamp_ns, cam_from_world};
  }

 private:
  struct Pose {
    std::int64_t stamp_ns = 0;
    Rigid3 cam_from_world;
  };
  std::optional<Pose> last_;
  Vector6d velocity_ = Vector6d::Zero();
};

}  // namespace

MonocularStart::MonocularStart(const ImagingModel& imaging, const SlamOptions& options)
    : imaging_(imaging),
      tracking_(options.tracking),
      weighting_(options.lines.weighting),
      initializer_(MakeInitializer(
          imaging, options.initialization, static_cast<std::uint64_t>(options.slam.seed))) {}

InitializationResult MonocularStart::Offer(FrameId id, const MeasuredFrame& frame) {
  waiting_.push_back({id, frame.stamp_ns, frame.indexed});
  if (waiting_.size() > kMaxWaiting) waiting_.pop_front();
  return initializer_->Add(
      {id, frame.stamp_ns, frame.indexed, std::make_shared<const GrayImage>(frame.images.left)});
}

void MonocularStart::Restart() {
  initializer_->Reset();
  waiting_.clear();
}

void MonocularStart::MapStarted(MapId map, const MapStart& start) {
  std::map<FrameId, KeyFrameId> keyframes;
  for (std::size_t i = 0; i < start.frames.size(); ++i) {
    keyframes[start.frames[i]] = start.keyframes[i];
  }
  starts_.push_back({map, std::move(keyframes), std::exchange(waiting_, {})});
  initializer_->Reset();
}

std::vector<EarlierFrame> MonocularStart::Locate(const std::vector<Map>& maps) {
  std::vector<EarlierFrame> located;
  for (const Start& start : starts_) {
    LocateFramesOf(start, maps.at(static_cast<std::size_t>(start.map.value)), located);
  }
  starts_.clear();
  return located;
}

void MonocularStart::LocateFramesOf(const Start& start,
                                    const Map& map,
                                    std::vector<EarlierFrame>& located) const {
  const KeyFrameId first = start.keyframes.begin()->second;
  const auto snapshot = TakeSnapshot(map, first, kSnapshotKeyFrames);
  const Rigid3 world_from_first = Inverse(map.PoseOf(first));
  BackwardPrediction prediction;
  int missed = 0;
  for (auto frame = start.frames.rbegin(); frame != start.frames.rend(); ++frame) {
    const auto keyframe = start.keyframes.find(frame->id);
    if (keyframe != start.keyframes.end()) {
      prediction.Add(frame->stamp_ns, map.PoseOf(keyframe->second));
      missed = 0;
      continue;
    }
    if (!prediction.Known() || missed >= kMaxMissed) continue;
    const auto pose = LocateFrame(imaging_,
                                  *frame->indexed,
                                  prediction.At(frame->stamp_ns),
                                  *snapshot,
                                  weighting_,
                                  tracking_);
    if (!pose) {
      ++missed;
      continue;
    }
    missed = 0;
    prediction.Add(frame->stamp_ns, pose->cam_from_world);
    located.push_back(
        {frame->id, start.map, first, pose->cam_from_world * world_from_first, pose->counts});
  }
}

}  // namespace plumbline
