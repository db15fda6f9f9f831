// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/mapping_stage.h"

#include "plumbline/base/error.h"

#include <sys/resource.h>
#include <unistd.h>

namespace plumbline {
namespace {

constexpr std::size_t kBehind = 2;  // waiting keyframes

// Of this thread (Linux). Where it is refused, things stay as they are.
void LowerPriority() {
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
}

// The keyframe beside its parent as the map has it today, which may have moved since the frame was
// tracked.
KeyFrame PlacedIn(const Map& map, const NewKeyFrame& added) {
  KeyFrame keyframe = added.keyframe;
  if (!keyframe.parent.valid() || !map.Knows(keyframe.parent)) return keyframe;
  const Placement parent = map.PlaceOf(keyframe.parent);
  keyframe.frame.cam_from_world = PoseBeside(parent, added.from_parent);
  keyframe.unit = parent.unit;
  return keyframe;
}

}  // namespace

MappingStage::MappingStage(const ImagingModel& imaging, const SlamOptions& options)
    : mode_(options.slam.mode),
      lag_(options.slam.lag),
      mapper_(imaging, options.lines, options.mapping) {
  if (mode_ != RunMode::kInline) worker_ = std::jthread([this] { WorkUntilStopped(); });
}

MappingStage::~MappingStage() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  task_added_.notify_all();
}

void MappingStage::Submit(std::int64_t frame, NewKeyFrame keyframe, bool starts_map) {
  Submit(frame, std::variant<NewKeyFrame, MapStart>(std::move(keyframe)), starts_map);
}

void MappingStage::Submit(std::int64_t frame, MapStart start) {
  Submit(frame, std::variant<NewKeyFrame, MapStart>(std::move(start)), true);
}

void MappingStage::Submit(std::int64_t frame,
                          std::variant<NewKeyFrame, MapStart> work,
                          bool starts_map) {
  ++submitted_;
  if (mode_ != RunMode::kLive || starts_map) {
    dues_.push_back({starts_map ? frame : frame + 1 + lag_, submitted_});
  }
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back({submitted_, std::move(work), starts_map});
  }
  task_added_.notify_one();
}

std::shared_ptr<const MapSnapshot> MappingStage::SnapshotFor(std::int64_t frame) {
  std::int64_t wanted = 0;
  for (const Due& due : dues_) {
    if (due.frame <= frame) wanted = due.task;
  }
  while (!dues_.empty() && dues_.front().task <= wanted) dues_.pop_front();
  WaitFor(wanted);
  const std::lock_guard lock(mutex_);
  if (mode_ == RunMode::kLive) wanted = Done();
  while (!versions_.empty() && versions_.front().task < wanted) versions_.pop_front();
  return versions_.empty() ? nullptr : versions_.front().snapshot;
}

bool MappingStage::Behind() const {
  const std::lock_guard lock(mutex_);
  return tasks_.size() >= kBehind;
}

void MappingStage::Finish(const StopCheck& stop) {
  WaitFor(submitted_);
  dues_.clear();
  const std::lock_guard lock(mutex_);
  while (versions_.size() > 1) versions_.pop_front();
  if (finished_ == submitted_) return;
  finished_ = submitted_;
  for (const auto& [id, map] : atlas_.maps()) {
    const std::vector<MappingStep> times = mapper_.Finish(*atlas_.Find(id), stop);
    times_.insert(times_.end(), times.begin(), times.end());
  }
}

void MappingStage::CheckComplete() const {
  if (mode_ == RunMode::kInline) return;
  const std::lock_guard lock(mutex_);
  if (failure_) return;  // the worker has ended
  PLUMBLINE_CHECK(Done() == submitted_, "maps are complete only after Finish");
}

const Atlas& MappingStage::atlas() const {
  CheckComplete();
  return atlas_;
}

const AdjustedLines& MappingStage::adjusted_lines() const {
  CheckComplete();
  return mapper_.adjusted_lines();
}

std::vector<MappingStep> MappingStage::TakeTimes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(times_, {});
}

void MappingStage::WaitFor(std::int64_t task) {
  std::unique_lock lock(mutex_);
  if (mode_ == RunMode::kInline) {
    while (!failure_ && Done() < task) TryNext(lock);
  } else {
    task_done_.wait(lock, [&] { return failure_ != nullptr || Done() >= task; });
  }
  if (failure_) std::rethrow_exception(failure_);
}

void MappingStage::WorkUntilStopped() {
  if (mode_ == RunMode::kLive) LowerPriority();  // frames come, whether mapping is done or not
  std::unique_lock lock(mutex_);
  while (true) {
    task_added_.wait(lock, [&] { return stop_ || !tasks_.empty(); });
    if (stop_) return;
    TryNext(lock);
    task_done_.notify_all();
    if (failure_) return;
  }
}

// What it throws is kept for WaitFor, which the tracker's thread calls.
void MappingStage::TryNext(std::unique_lock<std::mutex>& lock) {
  try {
    DoNext(lock);
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    failure_ = std::current_exception();
  }
}

// Does the next task, without holding the lock meanwhile.
void MappingStage::DoNext(std::unique_lock<std::mutex>& lock) {
  const Task task = std::move(tasks_.front());
  tasks_.pop_front();
  lock.unlock();
  if (task.starts_map) {
    mapper_.StartNewMap(atlas_.Start());
    centres_.clear();
  }
  Map& map = atlas_.active();
  KeyFrameId newest;
  std::vector<MappingStep> times;
  if (const auto* start = std::get_if<MapStart>(&task.work)) {
    newest = start->keyframes.back();
    times = mapper_.Start(map, start->edit, newest);
  } else {
    const auto& added = std::get<NewKeyFrame>(task.work);
    newest = added.keyframe.id;
    times = mapper_.Add(map, PlacedIn(map, added), added.scores);
  }
  auto snapshot = TakeSnapshotAround(map, newest);
  lock.lock();
  versions_.push_back({task.number, std::move(snapshot)});
  times_.insert(times_.end(), times.begin(), times.end());
}

// Also of the places of the snapshots before: the tracker's last pose may hang on one of them.
std::shared_ptr<const MapSnapshot> MappingStage::TakeSnapshotAround(const Map& map,
                                                                    KeyFrameId centre) {
  constexpr std::size_t kRemembered = 16;
  const std::vector<KeyFrameId> earlier(centres_.begin(), centres_.end());
  centres_.push_back(centre);
  if (centres_.size() > kRemembered) centres_.pop_front();
  return TakeSnapshot(map, centre, kSnapshotKeyFrames, earlier);
}

}  // namespace plumbline
