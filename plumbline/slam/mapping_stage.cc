// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/mapping_stage.h"

#include <limits>
#include <utility>

namespace plumbline {
namespace {

constexpr int kSnapshotKeyFrames = 40;

}  // namespace

MappingStage::MappingStage(const ImagingModel& imaging, const SlamOptions& options)
    : mapper_(imaging, options.lines.weighting, options.mapping), lag_(options.slam.lag) {}

void MappingStage::Submit(std::int64_t frame, NewKeyFrame keyframe, bool starts_map) {
  if (!starts_map) {
    pending_.push_back({frame, std::move(keyframe)});
    return;
  }
  Finish();
  mapper_.StartNewMap();
  maps_.emplace_back(MapId{static_cast<std::int64_t>(maps_.size())});
  Process(keyframe);
}

std::shared_ptr<const MapSnapshot> MappingStage::SnapshotFor(std::int64_t frame) {
  while (!pending_.empty() && pending_.front().frame + 1 + lag_ <= frame) {
    Process(pending_.front().keyframe);
    pending_.pop_front();
  }
  return snapshot_;
}

void MappingStage::Finish() { SnapshotFor(std::numeric_limits<std::int64_t>::max()); }

std::vector<MappingStep> MappingStage::TakeTimes() { return std::exchange(times_, {}); }

void MappingStage::Process(const NewKeyFrame& keyframe) {
  Map& map = maps_.back();
  const auto times = mapper_.Add(map, keyframe.keyframe, keyframe.scores);
  times_.insert(times_.end(), times.begin(), times.end());
  snapshot_ = TakeSnapshot(map, keyframe.keyframe.id, kSnapshotKeyFrames);
}

}  // namespace plumbline
