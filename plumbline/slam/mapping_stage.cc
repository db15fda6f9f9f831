// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/mapping_stage.h"

#include "plumbline/base/error.h"
#include "plumbline/map/covisibility.h"
#include "plumbline/mapping/whole_map_adjustment.h"
#include "plumbline/slam/atlas_places.h"
#include "plumbline/slam/pending_keyframes.h"

#include <algorithm>
#include <chrono>
#include <iterator>

namespace plumbline {
namespace {

// Features of all keyframes are corrected at once when a lens is learned, which must not take long.
bool MayCalibrateRadialDistortion(const Map& map) {
  constexpr std::size_t kMostKeyFrames = 512;
  return map.keyframes().size() <= kMostKeyFrames;
}

BackgroundAdjustment::Compute WholeMapAdjustment(const CameraAndPyramid& imaging,
                                                 const SlamOptions& options) {
  return [imaging, lines = options.lines, mapping = options.mapping](const Map& map,
                                                                     const StopCheck& stop) {
    MappingOptions adjusted = mapping;
    adjusted.lens_calibration = mapping.lens_calibration && MayCalibrateRadialDistortion(map);
    return AdjustWholeMap(map, imaging, lines, adjusted, stop);
  };
}

BackgroundAdjustment::Compute LensAdjustment(const CameraAndPyramid& imaging,
                                             const SlamOptions& options) {
  return [imaging, weights = options.lines.weights(), mapping = options.mapping](
             const Map& map, const StopCheck& stop) {
    return AdjustToLens(map, imaging, weights, mapping, stop);
  };
}

BackgroundAdjustment::Worker AdjustmentWorker(RunMode mode, const Execution& execution) {
  if (mode == RunMode::kInline || !execution.threads) return BackgroundAdjustment::Worker::kCaller;
  return mode == RunMode::kLive ? BackgroundAdjustment::Worker::kThreadOfLowPriority
                                : BackgroundAdjustment::Worker::kThread;
}

}  // namespace

MappingStage::MappingStage(const CameraAndPyramid& imaging,
                           const SlamOptions& options,
                           const Execution& execution)
    : mode_(options.slam.mode),
      lag_(options.slam.lag),
      camera_(imaging.camera),
      mapping_options_(options.mapping),
      mapper_(imaging, options.lines, options.mapping),
      relocalizer_(
          imaging, options.tracking, PoseEstimator(imaging.camera, options.lines, options.cutting)),
      places_(imaging, options.loop),
      adjustment_(AdjustmentWorker(mode_, execution)),
      adjust_map_(WholeMapAdjustment(imaging, options)),
      adjust_to_lens_(LensAdjustment(imaging, options)) {
  if (mode_ != RunMode::kInline && execution.threads) {
    worker_ = std::jthread([this] { WorkUntilStopped(); });
  }
}

MappingStage::~MappingStage() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  task_added_.notify_all();
}

std::optional<DroppedKeyFrame> MappingStage::Submit(std::int64_t frame,
                                                    NewKeyFrame keyframe,
                                                    bool starts_map) {
  Submit(frame, Work(std::make_shared<const NewKeyFrame>(std::move(keyframe))), starts_map);
  return mode_ == RunMode::kLive ? GiveUpOne() : std::nullopt;
}

void MappingStage::Submit(std::int64_t frame, InitialMapEdit start) {
  Submit(frame, Work(std::move(start)), true);
}

void MappingStage::Submit(std::int64_t frame, RelocalizationRequest request) {
  Submit(frame, Work(std::move(request)), false);
}

void MappingStage::Submit(std::int64_t frame, SwitchMap back) {
  Submit(frame, Work(back), false);
  ForgetEarlierSnapshots();
}

void MappingStage::Submit(std::int64_t frame, UpdateLocalMapRequest sighting) {
  Submit(frame, Work(std::move(sighting)), false);
}

void MappingStage::Submit(std::int64_t frame, MapReader visit) {
  Submit(frame, Work(std::move(visit)), false);
}

void MappingStage::Continue(Atlas atlas, const LocalMapper::State& mapper) {
  const std::lock_guard lock(mutex_);
  PLUMBLINE_CHECK(submitted_ == 0 && atlas_.empty(), "maps are loaded before the first keyframe");
  atlas_ = std::move(atlas);
  atlas_.Activate(atlas_.active_id());
  places_.Follow(atlas_);
  mapper_.SetState(mapper);
}

std::optional<RelocalizationOutcome> MappingStage::TakeRelocalization() {
  const std::lock_guard lock(mutex_);
  if (outcomes_.empty() || outcomes_.front().task > versions_.front().task) return std::nullopt;
  RelocalizationOutcome outcome = std::move(outcomes_.front().outcome);
  outcomes_.pop_front();
  return outcome;
}

void MappingStage::Use(const std::shared_ptr<const MapSnapshot>& snapshot) {
  const std::lock_guard lock(mutex_);
  const auto& before = versions_.back().snapshot;
  if (before != nullptr && before->map != snapshot->map) ForgetEarlierSnapshots();
  for (PublishedSnapshot& version : versions_) version.snapshot = snapshot;
}

// Snapshots taken before the last task that was submitted show another map than the one in use.
void MappingStage::ForgetEarlierSnapshots() {
  map_begins_ = submitted_;
  kept_.clear();
}

// Where memory runs out, nothing was submitted.
void MappingStage::Submit(std::int64_t frame, Work work, bool starts_map) {
  const std::int64_t number = submitted_ + 1;
  const bool has_due = mode_ != RunMode::kLive || starts_map;
  if (has_due) dues_.push_back({starts_map ? frame : frame + 1 + lag_, number});
  try {
    const std::lock_guard lock(mutex_);
    tasks_.push_back({number, frame, std::move(work), starts_map});
  } catch (...) {
    if (has_due) dues_.pop_back();
    throw;
  }
  submitted_ = number;
  if (starts_map) ForgetEarlierSnapshots();
  task_added_.notify_one();
}

// Gives up one keyframe where more than kMaxWaiting wait: the one with the fewest new measurements,
// the older one of two. The newest is kept, since tracking goes on from it.
std::optional<DroppedKeyFrame> MappingStage::GiveUpOne() {
  const std::lock_guard lock(mutex_);
  std::vector<std::size_t> places;  // positions of the waiting keyframes in tasks_
  std::vector<std::shared_ptr<const NewKeyFrame>> waiting;
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    const auto* keyframe = std::get_if<std::shared_ptr<const NewKeyFrame>>(&tasks_[i].work);
    if (keyframe == nullptr) continue;
    places.push_back(i);
    waiting.push_back(*keyframe);
  }
  if (waiting.size() <= kMaxWaiting) return std::nullopt;
  std::optional<std::size_t> least;
  int fewest = 0;
  for (std::size_t k = 0; k + 1 < waiting.size(); ++k) {
    if (tasks_[places[k]].starts_map) continue;
    const int measurements = NewMeasurements(*waiting[k], camera_);
    if (!least || measurements < fewest) {
      least = k;
      fewest = measurements;
    }
  }
  if (!least) return std::nullopt;
  const auto gone = TakeOut(*least, waiting);
  const std::size_t place = places[*least];
  places.erase(places.begin() + static_cast<std::ptrdiff_t>(*least));
  for (std::size_t k = 0; k < places.size(); ++k) tasks_[places[k]].work = waiting[k];
  tasks_.erase(tasks_.begin() + static_cast<std::ptrdiff_t>(place));
  const KeyFrame& keyframe = gone->keyframe;
  return DroppedKeyFrame{keyframe.id, keyframe.frame.id, keyframe.parent, gone->from_parent};
}

std::shared_ptr<const MapSnapshot> MappingStage::SnapshotFor(std::int64_t frame) {
  std::int64_t wanted = 0;
  for (const SnapshotDue& due : dues_) {
    if (due.frame <= frame) wanted = due.task;
  }
  while (!dues_.empty() && dues_.front().task <= wanted) dues_.pop_front();
  WaitFor(wanted);
  if (mode_ == RunMode::kLive) return NewestSnapshot();
  const std::lock_guard lock(mutex_);
  while (versions_.front().task < wanted) versions_.pop_front();
  return versions_.front().snapshot;
}

std::shared_ptr<const MapSnapshot> MappingStage::NewestSnapshot() {
  std::shared_ptr<const MapSnapshot> base;
  std::vector<std::shared_ptr<const NewKeyFrame>> ahead;
  {
    const std::lock_guard lock(mutex_);
    for (; versions_.size() > 1; versions_.pop_front()) {
      const PublishedSnapshot& earlier = versions_.front();
      const bool of_this_map = earlier.task >= map_begins_ && earlier.snapshot != nullptr;
      if (of_this_map && earlier.snapshot != versions_[1].snapshot) {
        kept_.push_front(earlier.snapshot);
      }
    }
    base = versions_.back().snapshot;
    if (begun_) ahead.push_back(begun_);
    for (const Task& task : tasks_) {
      const auto* keyframe = std::get_if<std::shared_ptr<const NewKeyFrame>>(&task.work);
      if (keyframe != nullptr) ahead.push_back(*keyframe);
    }
  }
  if (kept_.size() > kEarlierKept) kept_.resize(kEarlierKept);
  if (base == nullptr) return nullptr;
  if (base != base_ || ahead != ahead_) {
    with_ahead_ = ahead.empty()
                      ? base
                      : WithPendingKeyFrames(*base, ahead, camera_, mapping_options_.creation);
    base_ = std::move(base);
    ahead_ = std::move(ahead);
  }
  return with_ahead_;
}

std::shared_ptr<const MapSnapshot> MappingStage::EarlierSnapshot() {
  if (kept_.empty()) return nullptr;
  next_kept_ %= kept_.size();
  return kept_[next_kept_++];
}

std::size_t MappingStage::Waiting() const {
  const std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(std::count_if(tasks_.begin(), tasks_.end(), [](const Task& task) {
    return !std::holds_alternative<MapReader>(task.work);
  }));
}

void MappingStage::Lighten(LoadLevel shed) {
  const std::lock_guard lock(mutex_);
  shed_ = shed;
}

bool MappingStage::WorkOnce() {
  std::unique_lock lock(mutex_);
  if (tasks_.empty() || failure_) return false;
  TryNext(lock);
  return true;
}

void MappingStage::Finish(const StopCheck& stop) {
  Lighten(LoadLevel::kNothing);
  WaitFor(submitted_);
  dues_.clear();
  const std::lock_guard lock(mutex_);
  while (versions_.size() > 1) versions_.pop_front();
  adjustment_.GiveUp();                  // the adjustment below does more
  mapper_.SetOptions(mapping_options_);  // those of the last task may be lightened
  for (const MapId id : std::exchange(changed_, {})) {
    const std::vector<MappingStep> times = mapper_.Finish(*atlas_.Find(id), stop);
    times_.insert(times_.end(), times.begin(), times.end());
  }
  MoveFirstKeyFramesBack(atlas_);
  first_places_.clear();
}

void MappingStage::CheckMappingDone() const {
  if (mode_ == RunMode::kInline) return;
  const std::lock_guard lock(mutex_);
  if (failure_) return;  // the worker has ended, so that the maps cannot change any more
  PLUMBLINE_CHECK(LastDone() == submitted_, "maps are complete only after Finish");
}

std::vector<DroppedKeyFrame> MappingStage::NotMapped() const {
  std::vector<DroppedKeyFrame> gone;
  const auto add = [&](const NewKeyFrame& added) {
    const KeyFrame& keyframe = added.keyframe;
    if (!keyframe.parent.valid() || MapOf(atlas_, keyframe.id) != nullptr) return;
    gone.push_back({keyframe.id, keyframe.frame.id, keyframe.parent, added.from_parent});
  };
  const std::lock_guard lock(mutex_);
  if (failure_ == nullptr) return gone;
  for (auto task = tasks_.rbegin(); task != tasks_.rend(); ++task) {
    const auto* added = std::get_if<std::shared_ptr<const NewKeyFrame>>(&task->work);
    if (added != nullptr) add(**added);
  }
  if (begun_) add(*begun_);
  return gone;
}

const Atlas& MappingStage::atlas() const {
  CheckMappingDone();
  return atlas_;
}

const AdjustedLines& MappingStage::adjusted_lines() const {
  CheckMappingDone();
  return mapper_.adjusted_lines();
}

MapEvents MappingStage::events() const {
  CheckMappingDone();
  return {places_.loops(), places_.joins(), {}};
}

MapEvents MappingStage::EventsSince(MapEventCounts& known) const {
  const std::lock_guard lock(mutex_);
  return {TakeNew(events_.loops, known.loops), TakeNew(events_.joins, known.joins), {}};
}

LocalMapper::State MappingStage::mapper_state() const {
  CheckMappingDone();
  return mapper_.state();
}

std::vector<MappingStep> MappingStage::TakeTimes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(times_, {});
}

void MappingStage::WaitFor(std::int64_t task) {
  std::unique_lock lock(mutex_);
  if (!worker_.joinable()) {
    while (!failure_ && LastDone() < task) TryNext(lock);
  } else {
    task_done_.wait(lock, [&] { return failure_ != nullptr || LastDone() >= task; });
  }
  if (failure_) std::rethrow_exception(failure_);
}

void MappingStage::WorkUntilStopped() {
  std::unique_lock lock(mutex_);
  while (true) {
    task_added_.wait(lock, [&] { return stop_ || !tasks_.empty(); });
    if (stop_) return;
    TryNext(lock);
    task_done_.notify_all();
    if (failure_) return;
  }
}

// Does the next task and keeps what it throws for WaitFor, which the tracker's thread calls.
void MappingStage::TryNext(std::unique_lock<std::mutex>& lock) {
  try {
    ProcessNext(lock);
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    failure_ = std::current_exception();
  }
}

// Does the next task; the lock is released while it works.
void MappingStage::ProcessNext(std::unique_lock<std::mutex>& lock) {
  const Task task = std::move(tasks_.front());
  tasks_.pop_front();
  const auto* added = std::get_if<std::shared_ptr<const NewKeyFrame>>(&task.work);
  begun_ = added != nullptr ? *added : nullptr;
  if (mode_ == RunMode::kLive) mapper_.SetOptions(ReducedOptions(mapping_options_, shed_));
  lock.unlock();
  // Where no other task follows, the end of the run gives the correction up; with a visit, too.
  const bool changes_nothing = std::holds_alternative<MapReader>(task.work);
  if (mode_ == RunMode::kLive || !changes_nothing) TakeCorrection(task.frame);
  Done done = task.starts_map ? StartMap(task) : DoWork(task);
  lock.lock();
  begun_ = nullptr;
  const auto& in_use = versions_.back().snapshot;
  // The lost camera may have been found in another map since it saw this.
  const bool is_sighting = std::holds_alternative<UpdateLocalMapRequest>(task.work);
  if (is_sighting && done.snapshot && in_use && done.snapshot->map != in_use->map) {
    done.snapshot = nullptr;
  }
  if (done.snapshot == nullptr) done.snapshot = versions_.back().snapshot;
  versions_.push_back({task.number, std::move(done.snapshot)});
  times_.insert(times_.end(), done.times.begin(), done.times.end());
  // Both lists only grow, so that only what is new is copied.
  const auto take_over = [](auto& events, const auto& all) {
    events.insert(events.end(), all.begin() + std::ssize(events), all.end());
  };
  take_over(events_.loops, places_.loops());
  take_over(events_.joins, places_.joins());
  if (done.relocalization) outcomes_.push_back({task.number, *std::move(done.relocalization)});
}

MappingStage::Done MappingStage::DoWork(const Task& task) {
  return std::visit([&](const auto& work) { return Process(work, task.frame); }, task.work);
}

// A map that fails before its first keyframe is in it is as if it never was.
MappingStage::Done MappingStage::StartMap(const Task& task) {
  Atlas before = atlas_;
  try {
    mapper_.StartNewMap(atlas_.Start());
    centres_.clear();
    return DoWork(task);
  } catch (...) {
    if (atlas_.maps().size() > before.maps().size() && atlas_.active().keyframes().empty()) {
      atlas_ = std::move(before);
    }
    throw;
  }
}

MappingStage::Done MappingStage::Process(const std::shared_ptr<const NewKeyFrame>& added,
                                         std::int64_t frame) {
  Map& map = atlas_.active();
  changed_.insert(map.id());
  Done done;
  done.times = mapper_.Add(map, SettledIn(map, *added), added->scores, added->left_pyramid.get());
  Recognize(added->keyframe.id, frame, done.times);
  CalibrateRadialDistortion(added->keyframe.id, frame);
  done.snapshot = TakeSnapshotAround(atlas_.active(), added->keyframe.id);
  return done;
}

// Recognizes a place that was seen before. It ties the new keyframe to the older one and begins to
// adjust the whole map; or it finds that a young map is wrong, which is then withdrawn.
void MappingStage::Recognize(KeyFrameId id, std::int64_t frame, std::vector<MappingStep>& times) {
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
  const std::vector<MappingStep> more = mapper_.AdjustLoopNeighbourhood(map, id, *older);
  times.insert(times.end(), more.begin(), more.end());
  adjustment_.Begin(map, frame + AdjustmentDelay(map), adjust_map_);
}

// Begins to learn the lens of a single camera when the map has taken in enough keyframes to tell of
// it, and again when these have doubled, four times. Where an adjustment is under way, the map is
// asked with the first keyframe after it.
void MappingStage::CalibrateRadialDistortion(KeyFrameId newest, std::int64_t frame) {
  constexpr std::int64_t kFirst = 16, kLast = 256;
  const Map& map = atlas_.active();
  if (camera_.baseline > 0 || !mapping_options_.lens_calibration ||
      !MayCalibrateRadialDistortion(map))
    return;
  std::int64_t& asked = lens_asked_.try_emplace(map.id(), kFirst / 2).first->second;
  const std::int64_t taken_in = map.NumberOf(newest) + 1;
  if (adjustment_.Running() || asked >= kLast || taken_in < 2 * asked) return;
  asked = taken_in;
  adjustment_.Begin(map, frame + AdjustmentDelay(map), adjust_to_lens_);
}

// Adjusts a new map to the lens that the newest of the other maps has learned.
void MappingStage::TakeKnownLens(Map& map) {
  if (!mapping_options_.lens_calibration) return;
  for (auto other = atlas_.maps().rbegin(); other != atlas_.maps().rend(); ++other) {
    const LensCorrection& lens = other->second.correction().lens;
    if (other->first == map.id() || places_.IsWithdrawn(other->first)) continue;
    if (lens.border_px() == 0) continue;
    return Apply(mapper_.ToLens(map, lens), map);
  }
}

// What is remembered of a map that was joined is of the one that it is part of.
void MappingStage::FollowJoins() {
  mapper_.FollowJoins(atlas_);
  std::set<MapId> changed;
  for (const MapId id : changed_) changed.insert(atlas_.Current(id));
  changed_ = std::move(changed);
  std::erase_if(first_places_, [&](const auto& place) { return !atlas_.Find(place.first); });
  std::erase_if(lens_asked_, [&](const auto& asked) { return !atlas_.Find(asked.first); });
}

MappingStage::Done MappingStage::Process(const InitialMapEdit& start, std::int64_t) {
  Map& map = atlas_.active();
  changed_.insert(map.id());
  Done done;
  done.times = mapper_.Start(map, NumberedFor(map, start.edit), start.keyframes.back());
  TakeKnownLens(map);
  places_.Follow(atlas_);
  done.snapshot = TakeSnapshotAround(map, start.keyframes.back());
  return done;
}

MappingStage::Done MappingStage::Process(const RelocalizationRequest& request, std::int64_t) {
  Done done;
  RelocalizationOutcome& outcome = done.relocalization.emplace();
  const std::vector<PlaceToTry> places =
      places_.PlacesOf(atlas_, request.frame.features(), Relocalizer::kCandidates);
  outcome.found = relocalizer_.Find(request.frame, places);
  if (!outcome.found) return done;
  const KeyFrameId keyframe = outcome.found->keyframe;
  const Map& map = *MapOf(atlas_, keyframe);
  outcome.snapshot = TakeSnapshotAround(map, keyframe);
  return done;
}

MappingStage::Done MappingStage::Process(const SwitchMap& back, std::int64_t) {
  const MapId id = atlas_.Current(back.map);
  if (id == atlas_.active_id()) return {};
  mapper_.GoOnInAnotherMap();
  atlas_.Activate(id);
  centres_ = {back.keyframe};
  return {};
}

MappingStage::Done MappingStage::Process(const UpdateLocalMapRequest& sighting, std::int64_t) {
  const Map& map = *atlas_.Find(atlas_.Current(sighting.map));
  SharedCounts shared;
  for (const PointId id : sighting.points) {
    if (const MapPoint* point = map.Find(id)) shared.Add(point->observations);
  }
  for (const LineId id : sighting.lines) {
    if (const MapLine* line = map.Find(id)) shared.Add(line->observations);
  }
  const std::vector<CovisibleKeyFrame> ranking = shared.Rank(1);
  Done done;
  if (!ranking.empty()) done.snapshot = TakeSnapshotAround(map, ranking.front().id);
  return done;
}

MappingStage::Done MappingStage::Process(const MapReader& visit, std::int64_t) {
  visit.look(atlas_, mapper_, places_);
  return {};
}

// Applies the correction that was computed beside mapping, if it takes effect at this frame.
void MappingStage::TakeCorrection(std::int64_t frame) {
  const bool when_ready = mode_ == RunMode::kLive && worker_.joinable();
  const auto found = when_ready ? adjustment_.TakeReady() : adjustment_.TakeDue(frame);
  if (!found || found->correction.empty()) return;
  Map& map = *atlas_.Find(atlas_.Current(found->map));
  Apply(found->correction, map);
  changed_.insert(map.id());
}

void MappingStage::Apply(const MapCorrection& correction, Map& map) {
  if (correction.lens) {
    const auto& [first, keyframe] = *map.keyframes().begin();
    first_places_.try_emplace(map.id(), PlacedKeyFrame{first, keyframe.frame.cam_from_world});
  }
  map.Apply(RebaseCorrection(correction, map));
}

void MappingStage::MoveFirstKeyFramesBack(Atlas& atlas) const {
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
std::shared_ptr<const MapSnapshot> MappingStage::TakeSnapshotAround(const Map& map,
                                                                    KeyFrameId centre) {
  constexpr std::size_t kRemembered = 16;
  // The earlier centres of this map; others exist where a lost camera was found in another map.
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
