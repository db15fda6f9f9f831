// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/frame_input.h"

#include "plumbline/base/error.h"
#include "plumbline/base/units.h"
#include "plumbline/io/live/call_or_abandon.h"

#include <algorithm>
#include <thread>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace plumbline {
namespace {

using Clock = PlaybackSchedule::Clock;

// Waits until it is `due`. Returns false if `go_on` returned false before.
bool WaitUntil(Clock::time_point due, const FrameInput::GoOn& go_on) {
  constexpr std::chrono::milliseconds kAskEvery(50);
  while (go_on()) {
    if (Clock::now() >= due) return true;
    std::this_thread::sleep_until(std::min(due, Clock::now() + kAskEvery));
  }
  return false;
}

}  // namespace

RecordedInput::RecordedInput(std::shared_ptr<const Dataset> dataset,
                             std::vector<std::size_t> frames,
                             RunMode mode,
                             Say say)
    : dataset_(std::move(dataset)),
      frames_(std::move(frames)),
      live_(mode == RunMode::kLive),
      say_(std::move(say)) {
  if (mode == RunMode::kLockstep) ahead_.emplace(*dataset_);
}

// Reads frame k, after which position_ is that of the next one.
Expected<SensorFrame, ImageFailure> RecordedInput::Read(std::size_t k) {
  if (!ahead_) return dataset_->Read(k);
  return ahead_->Read(
      k, position_ < frames_.size() ? std::optional(frames_[position_]) : std::nullopt);
}

std::optional<InputFrame> RecordedInput::Next(const GoOn& go_on) {
  if (position_ >= frames_.size() || !go_on()) return std::nullopt;
  const std::size_t position = position_++;
  const std::size_t k = frames_[position];
  const std::int64_t stamp_ns = dataset_->stamp_ns(k);
  if (live_ && !WaitUntil(schedule_.ReadAt(stamp_ns), go_on)) return std::nullopt;
  const Clock::time_point begin = Clock::now();
  auto read = Read(k);
  const Clock::time_point due = schedule_.DueOnceRead(stamp_ns, begin, Clock::now());
  if (!(live_ ? WaitUntil(due, go_on) : go_on())) return std::nullopt;
  InputFrame next{stamp_ns, std::nullopt, ""};
  if (read) {
    next.frame = std::move(*read);
    return next;
  }
  const ImageFailure& failure = read.error();
  say_(fmt::format("frame {} skipped: {}: {}", position, failure.path.string(), failure.why));
  next.reason = failure.reason();
  return next;
}

LiveInput::LiveInput(std::shared_ptr<LiveSource> source, const FrameSelection& range, Say say)
    : name_(source->info().name), range_(range), say_(std::move(say)), source_(std::move(source)) {}

std::optional<InputFrame> LiveInput::Next(const GoOn& go_on) {
  while (go_on() && next_ < range_.to) {
    auto event = CallOrAbandon<LiveEvent>([source = source_] { return source->Next(); }, go_on);
    if (!event) return std::nullopt;
    if (const auto* end = std::get_if<SourceEnd>(&*event)) {
      if (next_ == 0) throw InputError(name_ + ": expected frames, found none");
      if (!end->why.empty()) say_(end->why);
      return std::nullopt;
    }
    const std::size_t k = next_++;
    const bool chosen = k >= range_.from && (k - range_.from) % range_.stride == 0;
    InputFrame frame = Take(*std::move(event), chosen);
    if (!chosen) continue;
    ++position_;
    frame.inertial = std::exchange(inertial_, {});
    return frame;
  }
  return std::nullopt;
}

// Says once, and once that it lasts, why chosen frames in succession are missing: a camera may be
// wrong for hours.
void LiveInput::SayWhyMissing(const std::string& why) {
  alike_ = why == last_why_ ? alike_ + 1 : 1;
  last_why_ = why;
  if (why.empty() || alike_ > 2) return;
  const char* again = "for the same reason; more such frames in succession are not told";
  say_(fmt::format("frame {} skipped: {}: {}", position_, name_, alike_ == 1 ? why : again));
}

// Takes the samples that came before a frame. Their stamps follow those of the frames. Where these
// jump back, samples of the clock before would be in the future, and are left out.
void LiveInput::TakeInertial(std::int64_t source_ns, const StampContinuity::Stamp& stamp) {
  constexpr std::size_t kMost = 60'000;  // a minute at 1 kHz
  for (InertialSample sample : source_->TakeInertial()) {
    if (stamp.jumped_back_ns && sample.stamp_ns > source_ns + kNsPerSecond) continue;
    sample.stamp_ns += stamp.stamp_ns - source_ns;
    inertial_.push_back(sample);
  }
  if (inertial_.size() > kMost) inertial_.erase(inertial_.begin(), inertial_.end() - kMost);
}

InputFrame LiveInput::Take(LiveEvent event, bool chosen) {
  InputFrame next;
  std::string why;
  if (auto* frame = std::get_if<SensorFrame>(&event)) {
    next.stamp_ns = frame->stamp_ns;
    next.frame = std::move(*frame);
  } else {
    const MissingFrame& missing = std::get<MissingFrame>(event);
    next.stamp_ns = missing.stamp_ns;
    next.reason = missing.reason;
    why = missing.why;
  }
  if (chosen) SayWhyMissing(why);
  const StampContinuity::Stamp stamp = continuity_.Next(next.stamp_ns);
  if (stamp.jumped_back_ns) {
    say_(fmt::format(
        "frame {}: {}: the stamps jump back by {:.3f} s; from here on they are {:.3f} s "
        "later in the results",
        position_,
        name_,
        1e-9 * static_cast<double>(*stamp.jumped_back_ns),
        1e-9 * static_cast<double>(stamp.stamp_ns - next.stamp_ns)));
  }
  TakeInertial(next.stamp_ns, stamp);
  next.stamp_ns = stamp.stamp_ns;
  if (next.frame) next.frame->stamp_ns = stamp.stamp_ns;
  return next;
}

}  // namespace plumbline
