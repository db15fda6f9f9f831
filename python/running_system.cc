// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "running_system.h"

#include "plumbline/base/error.h"
#include "plumbline/io/text_rows.h"
#include "plumbline/report/summary.h"
#include "plumbline/slam/front_end.h"

#include <utility>

#include <fmt/format.h>

namespace plumbline::python {
namespace {

// An image must have the size of the calibration, and exist exactly if it is required.
template <class T>
void CheckImage(const char* name, const Image<T>& image, const Calibration& calibration) {
  const int width = calibration.left.width(), height = calibration.left.height();
  if (image.width() == width && image.height() == height) return;
  throw InputError(
      fmt::format("{}: expected an image of {} rows and {} columns, as calibrated, found {} and {}",
                  name,
                  height,
                  width,
                  image.height(),
                  image.width()));
}

}  // namespace

RunningSystem::RunningSystem(const Calibration& calibration,
                             const SlamOptions& options,
                             std::optional<std::string> preset)
    : calibration_(calibration),
      options_(options),
      preset_(std::move(preset)),
      system_(calibration, options),
      pipeline_(system_, [this](const FrameRecord& record, const FrameView& view) {
        Observe(record, view);
      }) {}

void RunningSystem::UseInertial(const InertialCalibration& calibration) {
  const auto lock = Enter("imu");
  CheckRunning("imu");
  system_.UseInertial(calibration);
  uses_inertial_ = true;
}

void RunningSystem::AddInertial(std::span<const InertialSample> samples) {
  if (samples.empty()) return;
  const auto lock = Enter("imu");
  CheckRunning("imu");
  std::vector<InertialSample> ordered;
  for (const InertialSample& sample : samples) {
    inertial_order_.Add(sample);
    while (const auto next = inertial_order_.Take()) ordered.push_back(*next);
  }
  pipeline_.AddInertial(ordered);
}

void RunningSystem::Feed(SensorFrame frame) {
  const auto lock = Enter("feed");
  CheckRunning("feed");
  CheckFrame(frame);
  CheckStamp(frame.stamp_ns);
  pipeline_.Feed(std::move(frame));
}

FrameRecord RunningSystem::Process(SensorFrame frame) {
  const auto lock = Enter("process");
  CheckRunning("process");
  CheckFrame(frame);
  const std::int64_t stamp_ns = frame.stamp_ns;
  CheckStamp(stamp_ns);
  {
    const std::lock_guard records(records_mutex_);
    awaited_ns_ = stamp_ns;
    awaited_.reset();
  }
  pipeline_.Feed(std::move(frame));
  pipeline_.Drain();
  {
    const std::lock_guard records(records_mutex_);
    awaited_ns_.reset();
    if (awaited_) return *std::exchange(awaited_, std::nullopt);
  }
  // Tracking failed: completes the mapping so far, and rethrows the reason.
  FinishRun({});
  throw BugError("a frame has no record");
}

void RunningSystem::Skip(std::int64_t stamp_ns, const std::string& reason) {
  const auto lock = Enter("skip");
  CheckRunning("skip");
  if (reason.empty()) throw InputError("reason: expected why the frame is left out, found nothing");
  CheckStamp(stamp_ns);
  pipeline_.Skip(stamp_ns, reason);
}

std::vector<FrameRecord> RunningSystem::TakeRecords() {
  const std::lock_guard lock(records_mutex_);
  return std::exchange(records_, {});
}

MapEvents RunningSystem::TakeEvents() {
  const std::lock_guard lock(records_mutex_);
  return std::exchange(events_, {});
}

std::vector<std::string> RunningSystem::Continue(SavedAtlas saved, bool read_only) {
  const auto lock = Enter("continue_in");
  CheckRunning("continue_in");
  if (last_stamp_ns_ || continues_) {
    throw InputError("continue_in: expected a system before its first frame, found one that runs");
  }
  std::vector<std::string> notes = system_.Continue(std::move(saved), read_only);
  continues_ = true;
  return notes;
}

void RunningSystem::KeepViews(const std::vector<std::size_t>& frames) {
  const auto lock = Enter("run");
  RunFrames input;
  input.frames = frames;
  views_ = KeptViews(input);
}

void RunningSystem::Finish(const StopCheck& stop) {
  const auto lock = Enter("finish");
  CheckRunning("finish");
  FinishRun(stop);
}

// Whatever fails, the system is finished afterwards, with the result so far.
void RunningSystem::FinishRun(const StopCheck& stop) {
  std::exception_ptr failure;
  result_ = pipeline_.Finish(stop, &failure);
  if (failure) std::rethrow_exception(failure);
  NoteEvents(TakeNew(result_->events, events_known_));
}

SavedAtlas RunningSystem::CopyMaps() {
  const auto lock = Enter("maps");
  if (!last_stamp_ns_) {
    throw InputError("maps: expected a system with a frame, found one before its first frame");
  }
  if (result_) return {result_->atlas, result_->context};
  pipeline_.Drain();
  SavedAtlas copied;
  system_.ReadMaps([&copied](const CurrentMaps& maps) { copied = maps.copy(); });
  system_.WaitForMapping();
  return copied;
}

MapEvents RunningSystem::Events() {
  const auto lock = Enter("events");
  if (!last_stamp_ns_) return {};
  if (result_) return result_->events;
  pipeline_.Drain();
  system_.WaitForMapping();
  MapEventCounts none;
  return system_.EventsSince(none);
}

std::unique_lock<std::mutex> RunningSystem::Enter(const char* what) {
  std::unique_lock lock(entered_, std::try_to_lock);
  if (lock) return lock;
  throw InputError(std::string(what) +
                   ": expected one thread at a time in a system, found another one in it");
}

void RunningSystem::CheckRunning(const char* what) const {
  if (!result_) return;
  throw InputError(std::string(what) + ": expected a system that runs, found one that is finished");
}

void RunningSystem::CheckFinished(const char* what) const {
  if (result_) return;
  throw InputError(std::string(what) +
                   ": expected a system that is finished (finish()), found one that runs");
}

void RunningSystem::CheckFrame(const SensorFrame& frame) const {
  CheckImages(calibration_, frame);
  CheckImage("left", frame.left, calibration_);
  if (calibration_.right) CheckImage("right", *frame.right, calibration_);
  if (frame.depth) CheckImage("depth", *frame.depth, calibration_);
  if (frame.left_mask) CheckImage("mask", *frame.left_mask, calibration_);
  if (frame.right_mask) CheckImage("mask", *frame.right_mask, calibration_);
}

void RunningSystem::CheckStamp(std::int64_t stamp_ns) {
  if (!IsReadableStamp(stamp_ns)) {
    throw InputError(fmt::format(
        "stamp_ns: expected a stamp within {} ns of 0, found {}", kLatestStampNs, stamp_ns));
  }
  if (last_stamp_ns_ && stamp_ns <= *last_stamp_ns_) {
    throw InputError(fmt::format(
        "stamp_ns: expected a frame after {} ns, found one of {} ns", *last_stamp_ns_, stamp_ns));
  }
  last_stamp_ns_ = stamp_ns;
}

// In the thread that tracks, or when it has ended.
void RunningSystem::NoteEvents(const MapEvents& fresh) {
  if (fresh.empty()) return;
  const std::lock_guard lock(records_mutex_);
  const auto append = [](auto& events, const auto& more) {
    events.insert(events.end(), more.begin(), more.end());
  };
  append(events_.loops, fresh.loops);
  append(events_.joins, fresh.joins);
  append(events_.relocalizations, fresh.relocalizations);
}

// In the thread that tracks.
void RunningSystem::Observe(const FrameRecord& record, const FrameView& view) {
  views_.Offer(static_cast<std::size_t>(record.id.value), view);
  NoteEvents(system_.EventsSince(events_known_));
  const std::lock_guard lock(records_mutex_);
  if (!first_pose_seconds_ && record.status == FrameStatus::kTracked) {
    first_pose_seconds_ = SecondsSinceProcessStart();
  }
  if (awaited_ns_ == record.stamp_ns) {
    awaited_ = record;
  } else {
    records_.push_back(record);
  }
}

}  // namespace plumbline::python
