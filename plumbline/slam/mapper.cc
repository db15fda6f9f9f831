// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/mapper.h"

#include "plumbline/base/error.h"
#include "plumbline/geometry/measured_depth.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/mapping/whole_map_adjustment.h"
#include "plumbline/slam/atlas_places.h"
#include "plumbline/slam/pending_keyframes.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace plumbline {
namespace {

// Features of all keyframes are corrected at once when a lens is learned, which must not take long.
bool MayCalibrateRadialDistortion(const Map& map) {
  constexpr std::size_t kMostKeyFrames = 512;
  return map.keyframes().size() <= kMostKeyFrames;
}

auto WholeMapAdjustment(const CameraAndPyramid& imaging, const LineSettings& lines) {
  return [imaging, lines](MappingOptions mapping, const Map& map, const StopCheck& stop) {
    mapping.lens_calibration = mapping.lens_calibration && MayCalibrateRadialDistortion(map);
    return AdjustWholeMap(map, imaging, lines, mapping, stop);
  };
}

auto LensAdjustment(const CameraAndPyramid& imaging, const LineWeights& weights) {
  return [imaging, weights](const MappingOptions& mapping, const Map& map, const StopCheck& stop) {
    return AdjustToLens(map, imaging, weights, mapping, stop);
  };
}

BackgroundAdjustment::Worker AdjustmentWorker(RunMode mode, const Execution& execution) {
  if (mode == RunMode::kInline || !execution.threads) return BackgroundAdjustment::Worker::kCaller;
  return mode == RunMode::kLive ? BackgroundAdjustment::Worker::kThreadOfLowPriority
                                : BackgroundAdjustment::Worker::kThread;
}

}  // namespace

Mapper::Mapper(const CameraAndPyramid& imaging,
               const SlamOptions& options,
               const Execution& execution,
               const SystemMethods& methods)
    : mode_(options.slam.mode),
      corrects_when_ready_(mode_ == RunMode::kLive && execution.threads),
      camera_(imaging.camera),
      options_(options.mapping),
      local_(imaging, methods.Lines(options.lines), options.mapping),
      relocalizer_(imaging, options.tracking, methods.MakePoseEstimator(imaging.camera, options)),
      places_(imaging, options.loop),
      adjustment_(AdjustmentWorker(mode_, execution)),
      adjust_map_(WholeMapAdjustment(imaging, methods.Lines(options.lines))),
      adjust_to_lens_(LensAdjustment(imaging, options.lines.weights())) {}

void Mapper::Continue(Atlas atlas, const LocalMapper::State& state) {
  PLUMBLINE_CHECK(atlas_.empty(), "maps are loaded before the first keyframe");
  atlas_ = std::move(atlas);
  atlas_.Activate(atlas_.active_id());
  places_.Follow(atlas_);
  local_.SetState(state);
}

MapUpdate Mapper::Process(const MapCommand& command, LoadLevel load) {
  if (mode_ == RunMode::kLive) local_.SetOptions(ReducedOptions(options_, load));
  // If no other command follows, the end of the run takes the correction or gives it up; after a
  // reader, too.
  const bool changes_nothing = std::holds_alternative<MapReader>(command.work);
  if (mode_ == RunMode::kLive || !changes_nothing) TakeCorrection(command.frame);
  return command.starts_map ? StartMap(command) : Process(command);
}

std::vector<MappingStep> Mapper::Finish(const StopCheck& stop) {
  local_.SetOptions(options_);  // those of the last command may be reduced
  TakeLastCorrection(stop);
  std::vector<MappingStep> times;
  for (const MapId id : std::exchange(changed_, {})) {
    const std::vector<MappingStep> more = local_.Finish(*atlas_.Find(id), stop);
    times.insert(times.end(), more.begin(), more.end());
  }
  MoveFirstKeyFramesBack(atlas_);
  first_places_.clear();
  return times;
}

MapUpdate Mapper::Process(const MapCommand& command) {
  return std::visit([&](const auto& work) { return Process(work, command.frame); }, command.work);
}

// A map that fails before its first keyframe is in it is as if it never was.
MapUpdate Mapper::StartMap(const MapCommand& command) {
  Atlas before = atlas_;
  try {
    local_.StartNewMap(atlas_.Start());
    centres_.clear();
    return Process(command);
  } catch (...) {
    if (atlas_.maps().size() > before.maps().size() && atlas_.active().keyframes().empty()) {
      atlas_ = std::move(before);
    }
    throw;
  }
}

MapUpdate Mapper::Process(const std::shared_ptr<const NewKeyFrame>& added, std::int64_t frame) {
  Map& map = atlas_.active();
  changed_.insert(map.id());
  MapUpdate update;
  update.times = local_.Add(map, SettledIn(map, *added), added->scores, added->left_pyramid.get());
  Recognize(added->keyframe.id, frame, update.times);
  CalibrateRadialDistortion(added->keyframe.id, frame);
  update.snapshot = TakeSnapshotAround(atlas_.active(), added->keyframe.id);
  return update;
}

// Recognizes a revisited place. It connects the new keyframe with the older one and begins to
// adjust the whole map; or it finds that a recent map is wrong, which is then withdrawn.
void Mapper::Recognize(KeyFrameId id, std::int64_t frame, std::vector<MappingStep>& times) {
  const auto start = std::chrono::steady_clock::now();
  places_.Follow(atlas_);
  std::optional<KeyFrameId> older;
  if (!places_.Withdraws(atlas_, id)) older = places_.Recognize(atlas_, id);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
  times.push_back({"recognize", taken.count()});
  if (!older) return;
  FollowJoins();
  Map& map = atlas_.active();
  changed_.insert(map.id());
  const std::vector<MappingStep> more = local_.AdjustLoopNeighbourhood(map, id, *older);
  times.insert(times.end(), more.begin(), more.end());
  adjustment_.Begin(map, frame + AdjustmentDelay(map), std::bind_front(adjust_map_, options_));
}

// Begins to calibrate the lens of a single camera when the map has enough keyframes to determine
// it, and again when their number has doubled, four times, or until its points show that the lens
// needs no correction. During another adjustment, the attempt
// is postponed to the first keyframe after it.
void Mapper::CalibrateRadialDistortion(KeyFrameId newest, std::int64_t frame) {
  constexpr std::int64_t kFirst = 16, kLast = 256;
  const Map& map = atlas_.active();
  if (MeasuresDepth(camera_) || !options_.lens_calibration || !MayCalibrateRadialDistortion(map))
    return;
  std::int64_t& asked = lens_asked_.try_emplace(map.id(), kFirst / 2).first->second;
  const std::int64_t taken_in = map.NumberOf(newest) + 1;
  if (adjustment_.Running() || asked >= kLast || taken_in < 2 * asked) return;
  asked = taken_in;
  adjustment_.Begin(map, frame + AdjustmentDelay(map), std::bind_front(adjust_to_lens_, options_));
}

// Adjusts a new map to the lens that the newest of the other maps has learned.
void Mapper::TakeKnownLens(Map& map) {
  if (!options_.lens_calibration) return;
  for (auto other = atlas_.maps().rbegin(); other != atlas_.maps().rend(); ++other) {
    const LensCorrection& lens = other->second.correction().lens;
    if (other->first == map.id() || places_.IsWithdrawn(other->first)) continue;
    if (lens.border_px() == 0) continue;
    return Apply(local_.ToLens(map, lens), map);
  }
}

// Transfers the state of a merged map to the map that it is now part of.
void Mapper::FollowJoins() {
  local_.FollowJoins(atlas_);
  std::set<MapId> changed;
  for (const MapId id : changed_) changed.insert(atlas_.Current(id));
  changed_ = std::move(changed);
  std::erase_if(first_places_, [&](const auto& place) { return !atlas_.Find(place.first); });
  std::erase_if(lens_asked_, [&](const auto& asked) { return !atlas_.Find(asked.first); });
}

MapUpdate Mapper::Process(const InitialMapEdit& start, std::int64_t) {
  Map& map = atlas_.active();
  changed_.insert(map.id());
  MapUpdate update;
  update.times = local_.Start(map, NumberedFor(map, start.edit), start.keyframes.back());
  TakeKnownLens(map);
  places_.Follow(atlas_);
  update.snapshot = TakeSnapshotAround(map, start.keyframes.back());
  return update;
}

MapUpdate Mapper::Process(const RelocalizationRequest& request, std::int64_t) {
  MapUpdate update;
  RelocalizationOutcome& outcome = update.relocalization.emplace();
  const std::vector<PlaceToTry> places =
      places_.PlacesOf(atlas_, request.frame.features(), Relocalizer::kCandidates);
  outcome.found = relocalizer_.Find(request.frame, places);
  if (!outcome.found) return update;
  const KeyFrameId keyframe = outcome.found->keyframe;
  const Map& map = *MapOf(atlas_, keyframe);
  outcome.snapshot = TakeSnapshotAround(map, keyframe);
  return update;
}

MapUpdate Mapper::Process(const SwitchMap& back, std::int64_t) {
  const MapId id = atlas_.Current(back.map);
  if (id == atlas_.active_id()) return {};
  local_.GoOnInAnotherMap();
  atlas_.Activate(id);
  centres_ = {back.keyframe};
  return {};
}

MapUpdate Mapper::Process(const UpdateLocalMapRequest& request, std::int64_t) {
  const Map& map = *atlas_.Find(atlas_.Current(request.map));
  SharedCounts shared;
  for (const PointId id : request.points) {
    if (const MapPoint* point = map.Find(id)) shared.Add(point->observations);
  }
  for (const LineId id : request.lines) {
    if (const MapLine* line = map.Find(id)) shared.Add(line->observations);
  }
  const std::vector<CovisibleKeyFrame> ranking = shared.Rank(1);
  MapUpdate update;
  if (!ranking.empty()) update.snapshot = TakeSnapshotAround(map, ranking.front().id);
  return update;
}

MapUpdate Mapper::Process(const MapReader& reader, std::int64_t) {
  reader.look(atlas_, local_, places_);
  return {};
}

// Applies the correction that was computed beside mapping, if it takes effect at this frame.
void Mapper::TakeCorrection(std::int64_t frame) {
  Take(corrects_when_ready_ ? adjustment_.TakeReady() : adjustment_.TakeDue(frame));
}

// Takes the correction that is not due yet where the adjustment at the end, which does more, will
// leave the map as it is: the map is too large, or the run is stopped. Without an adjustment at the
// end the run ends at once.
void Mapper::TakeLastCorrection(const StopCheck& stop) {
  if (!adjustment_.Running()) return;
  const Map& map = *atlas_.Find(atlas_.Current(adjustment_.map()));
  if (options_.final_adjustment_keyframes == 0 || local_.AdjustsAtEnd(map, stop)) {
    adjustment_.GiveUp();
  } else {
    Take(adjustment_.TakeAtEnd(stop));
  }
}

void Mapper::Take(const std::optional<BackgroundAdjustment::Result>& found) {
  if (found && found->correction.lens_is_right) options_.lens_calibration = false;
  if (!found || found->correction.empty()) return;
  Map& map = *atlas_.Find(atlas_.Current(found->map));
  Apply(found->correction, map);
  changed_.insert(map.id());
}

void Mapper::Apply(const MapCorrection& correction, Map& map) {
  if (correction.lens) {
    const auto& [first, keyframe] = *map.keyframes().begin();
    first_places_.try_emplace(map.id(), PlacedKeyFrame{first, keyframe.frame.cam_from_world});
  }
  map.Apply(RebaseCorrection(correction, map));
}

void Mapper::MoveFirstKeyFramesBack(Atlas& atlas) const {
  for (const auto& [id, place] : first_places_) {
    Map* map = atlas.Find(id);
    if (map == nullptr) continue;
    const Similarity3 new_from_old =
        ToSimilarity(Inverse(place.cam_from_world) * map->PoseOf(place.id));
    edit::MoveKeyFrames motion;
    for (const auto& [moved, keyframe] : map->keyframes()) {
      motion.new_from_old.emplace(moved, new_from_old);
    }
    map->Apply({std::move(motion), edit::SetPose{place.id, place.cam_from_world}});
  }
}

// Takes a snapshot that also holds the places of earlier centres, because the tracker's last pose
// may refer to one of them.
std::shared_ptr<const MapSnapshot> Mapper::TakeSnapshotAround(const Map& map, KeyFrameId centre) {
  constexpr std::size_t kRemembered = 16;
  // The earlier centres of this map; others exist if a lost camera was found in another map.
  std::vector<KeyFrameId> earlier;
  std::copy_if(centres_.begin(), centres_.end(), std::back_inserter(earlier), [&](KeyFrameId id) {
    return map.Knows(id);
  });
  centres_.push_back(centre);
  if (centres_.size() > kRemembered) centres_.pop_front();
  auto snapshot = TakeSnapshot(map, centre, kSnapshotKeyFrames, earlier);
  if (!places_.IsWithdrawn(map.id())) return snapshot;
  auto last = std::make_shared<MapSnapshot>(*snapshot);
  last->withdrawn = true;
  return last;
}

}  // namespace plumbline
