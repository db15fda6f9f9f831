// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/mapper_thread.h"

#include "plumbline/base/error.h"
#include "plumbline/slam/atlas_places.h"
#include "plumbline/slam/pending_keyframes.h"

#include <algorithm>
#include <utility>

namespace plumbline {

MapperThread::MapperThread(const CameraAndPyramid& imaging,
                           const SlamOptions& options,
                           const Execution& execution,
                           const SystemMethods& methods)
    : mode_(options.slam.mode),
      camera_(imaging.camera),
      creation_(options.mapping.creation),
      schedule_(mode_, options.slam.lag),
      mapper_(imaging, options, execution, methods) {
  if (mode_ != RunMode::kInline && execution.threads) {
    worker_ = std::jthread([this] { WorkUntilStopped(); });
  }
}

MapperThread::~MapperThread() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  task_added_.notify_all();
}

std::optional<DroppedKeyFrame> MapperThread::Submit(std::int64_t frame,
                                                    NewKeyFrame keyframe,
                                                    bool starts_map) {
  Submit({std::make_shared<const NewKeyFrame>(std::move(keyframe)), frame, starts_map});
  return mode_ == RunMode::kLive ? GiveUpOne() : std::nullopt;
}

void MapperThread::Submit(std::int64_t frame, InitialMapEdit start) {
  Submit({std::move(start), frame, true});
}

void MapperThread::Submit(std::int64_t frame, RelocalizationRequest request) {
  Submit({std::move(request), frame});
}

void MapperThread::Submit(std::int64_t frame, SwitchMap back) {
  Submit({back, frame});
  ForgetEarlierSnapshots();
}

void MapperThread::Submit(std::int64_t frame, UpdateLocalMapRequest request) {
  Submit({std::move(request), frame});
}

void MapperThread::Submit(std::int64_t frame, MapReader reader) {
  Submit({std::move(reader), frame});
}

void MapperThread::Continue(Atlas atlas, const LocalMapper::State& state) {
  const std::lock_guard lock(mutex_);
  PLUMBLINE_CHECK(submitted_ == 0, "maps are loaded before the first keyframe");
  mapper_.Continue(std::move(atlas), state);
}

std::optional<RelocalizationOutcome> MapperThread::TakeRelocalization() {
  const std::lock_guard lock(mutex_);
  if (outcomes_.empty() || outcomes_.front().task > versions_.front().task) return std::nullopt;
  RelocalizationOutcome outcome = std::move(outcomes_.front().outcome);
  outcomes_.pop_front();
  return outcome;
}

void MapperThread::Use(const std::shared_ptr<const MapSnapshot>& snapshot) {
  const std::lock_guard lock(mutex_);
  const auto& before = versions_.back().snapshot;
  if (before != nullptr && before->map != snapshot->map) ForgetEarlierSnapshots();
  for (PublishedSnapshot& version : versions_) version.snapshot = snapshot;
}

// Snapshots taken before the last task that was submitted show another map than the one in use.
void MapperThread::ForgetEarlierSnapshots() {
  map_begins_ = submitted_;
  kept_.clear();
}

// If memory runs out, nothing was submitted.
void MapperThread::Submit(MapCommand command) {
  const std::int64_t number = submitted_ + 1;
  const bool starts_map = command.starts_map;
  schedule_.Add(number, command.frame, starts_map);
  try {
    const std::lock_guard lock(mutex_);
    tasks_.push_back({number, std::move(command)});
  } catch (...) {
    schedule_.Remove(number);
    throw;
  }
  submitted_ = number;
  if (starts_map) ForgetEarlierSnapshots();
  task_added_.notify_one();
}

// Gives up one keyframe if more than kMaxWaiting wait: the one with the fewest new measurements,
// the older one of two. The newest is kept, since tracking goes on from it.
std::optional<DroppedKeyFrame> MapperThread::GiveUpOne() {
  const std::lock_guard lock(mutex_);
  std::vector<std::size_t> places;  // positions of the waiting keyframes in tasks_
  std::vector<std::shared_ptr<const NewKeyFrame>> waiting;
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    const auto* keyframe = std::get_if<std::shared_ptr<const NewKeyFrame>>(&tasks_[i].command.work);
    if (keyframe == nullptr) continue;
    places.push_back(i);
    waiting.push_back(*keyframe);
  }
  if (waiting.size() <= kMaxWaiting) return std::nullopt;
  std::optional<std::size_t> least;
  int fewest = 0;
  for (std::size_t k = 0; k + 1 < waiting.size(); ++k) {
    if (tasks_[places[k]].command.starts_map) continue;
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
  for (std::size_t k = 0; k < places.size(); ++k) tasks_[places[k]].command.work = waiting[k];
  tasks_.erase(tasks_.begin() + static_cast<std::ptrdiff_t>(place));
  const KeyFrame& keyframe = gone->keyframe;
  return DroppedKeyFrame{keyframe.id, keyframe.frame.id, keyframe.parent, gone->from_parent};
}

std::shared_ptr<const MapSnapshot> MapperThread::SnapshotFor(std::int64_t frame) {
  const std::int64_t wanted = schedule_.DueAt(frame);
  WaitFor(wanted);
  if (mode_ == RunMode::kLive) return NewestSnapshot();
  const std::lock_guard lock(mutex_);
  while (versions_.front().task < wanted) versions_.pop_front();
  return versions_.front().snapshot;
}

std::shared_ptr<const MapSnapshot> MapperThread::NewestSnapshot() {
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
      const auto* keyframe = std::get_if<std::shared_ptr<const NewKeyFrame>>(&task.command.work);
      if (keyframe != nullptr) ahead.push_back(*keyframe);
    }
  }
  if (kept_.size() > kEarlierKept) kept_.resize(kEarlierKept);
  if (base == nullptr) return nullptr;
  if (base != base_ || ahead != ahead_) {
    with_ahead_ = ahead.empty() ? base : WithPendingKeyFrames(*base, ahead, camera_, creation_);
    base_ = std::move(base);
    ahead_ = std::move(ahead);
  }
  return with_ahead_;
}

std::shared_ptr<const MapSnapshot> MapperThread::EarlierSnapshot() {
  if (kept_.empty()) return nullptr;
  next_kept_ %= kept_.size();
  return kept_[next_kept_++];
}

std::size_t MapperThread::Waiting() const {
  const std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(std::count_if(tasks_.begin(), tasks_.end(), [](const Task& task) {
    return !std::holds_alternative<MapReader>(task.command.work);
  }));
}

void MapperThread::Lighten(LoadLevel shed) {
  const std::lock_guard lock(mutex_);
  shed_ = shed;
}

bool MapperThread::WorkOnce() {
  std::unique_lock lock(mutex_);
  if (tasks_.empty() || failure_) return false;
  TryNext(lock);
  return true;
}

void MapperThread::Finish(const StopCheck& stop) {
  Lighten(LoadLevel::kNothing);
  WaitFor(submitted_);
  schedule_.Clear();
  const std::lock_guard lock(mutex_);
  while (versions_.size() > 1) versions_.pop_front();
  const std::vector<MappingStep> times = mapper_.Finish(stop);
  times_.insert(times_.end(), times.begin(), times.end());
}

void MapperThread::CheckMappingDone() const {
  if (mode_ == RunMode::kInline) return;
  const std::lock_guard lock(mutex_);
  if (failure_) return;  // the worker has ended, so that the maps cannot change any more
  PLUMBLINE_CHECK(LastDone() == submitted_, "maps are complete only after Finish");
}

std::vector<DroppedKeyFrame> MapperThread::NotMapped() const {
  std::vector<DroppedKeyFrame> gone;
  const auto add = [&](const NewKeyFrame& added) {
    const KeyFrame& keyframe = added.keyframe;
    if (!keyframe.parent.valid() || MapOf(mapper_.atlas(), keyframe.id) != nullptr) return;
    gone.push_back({keyframe.id, keyframe.frame.id, keyframe.parent, added.from_parent});
  };
  const std::lock_guard lock(mutex_);
  if (failure_ == nullptr) return gone;
  for (auto task = tasks_.rbegin(); task != tasks_.rend(); ++task) {
    const auto* added = std::get_if<std::shared_ptr<const NewKeyFrame>>(&task->command.work);
    if (added != nullptr) add(**added);
  }
  if (begun_) add(*begun_);
  return gone;
}

const Atlas& MapperThread::atlas() const {
  CheckMappingDone();
  return mapper_.atlas();
}

Atlas MapperThread::TakeAtlas() {
  CheckMappingDone();
  return mapper_.TakeAtlas();
}

const AdjustedLines& MapperThread::adjusted_lines() const {
  CheckMappingDone();
  return mapper_.adjusted_lines();
}

MapEvents MapperThread::events() const {
  CheckMappingDone();
  return {mapper_.places().loops(), mapper_.places().joins(), {}};
}

LocalMapper::State MapperThread::mapper_state() const {
  CheckMappingDone();
  return mapper_.state();
}

MapEvents MapperThread::EventsSince(MapEventCounts& known) const {
  const std::lock_guard lock(mutex_);
  return {TakeNew(events_.loops, known.loops), TakeNew(events_.joins, known.joins), {}};
}

std::vector<MappingStep> MapperThread::TakeTimes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(times_, {});
}

void MapperThread::WaitFor(std::int64_t task) {
  std::unique_lock lock(mutex_);
  if (!worker_.joinable()) {
    while (!failure_ && LastDone() < task) TryNext(lock);
  } else {
    task_done_.wait(lock, [&] { return failure_ != nullptr || LastDone() >= task; });
  }
  if (failure_) std::rethrow_exception(failure_);
}

void MapperThread::WorkUntilStopped() {
  std::unique_lock lock(mutex_);
  while (true) {
    task_added_.wait(lock, [&] { return stop_ || !tasks_.empty(); });
    if (stop_) return;
    TryNext(lock);
    task_done_.notify_all();
    if (failure_) return;
  }
}

// Executes the next task and stores its exception for WaitFor, which the tracker's thread calls.
void MapperThread::TryNext(std::unique_lock<std::mutex>& lock) {
  try {
    ProcessNext(lock);
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    failure_ = std::current_exception();
  }
}

// Does the next task; the lock is released while it works.
void MapperThread::ProcessNext(std::unique_lock<std::mutex>& lock) {
  const Task task = std::move(tasks_.front());
  tasks_.pop_front();
  const auto* added = std::get_if<std::shared_ptr<const NewKeyFrame>>(&task.command.work);
  begun_ = added != nullptr ? *added : nullptr;
  const LoadLevel load = shed_;
  lock.unlock();
  MapUpdate update = mapper_.Process(task.command, load);
  lock.lock();
  begun_ = nullptr;
  const auto& in_use = versions_.back().snapshot;
  // The lost camera may have been found in another map since it saw this.
  const bool is_request = std::holds_alternative<UpdateLocalMapRequest>(task.command.work);
  if (is_request && update.snapshot && in_use && update.snapshot->map != in_use->map) {
    update.snapshot = nullptr;
  }
  if (update.snapshot == nullptr) update.snapshot = in_use;
  versions_.push_back({task.number, std::move(update.snapshot)});
  times_.insert(times_.end(), update.times.begin(), update.times.end());
  // Both lists only grow, so that only new entries are copied.
  const auto take_over = [](auto& events, const auto& all) {
    events.insert(events.end(), all.begin() + std::ssize(events), all.end());
  };
  take_over(events_.loops, mapper_.places().loops());
  take_over(events_.joins, mapper_.places().joins());
  if (update.relocalization) outcomes_.push_back({task.number, *std::move(update.relocalization)});
}

}  // namespace plumbline
