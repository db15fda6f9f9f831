// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"
#include "plumbline/inertial/inertial_sample.h"
#include "plumbline/io/datasets/dataset.h"
#include "plumbline/io/datasets/read_ahead.h"
#include "plumbline/io/live/live_source.h"
#include "plumbline/io/live/stamp_continuity.h"
#include "plumbline/report/playback_schedule.h"
#include "plumbline/slam/options.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace plumbline {

// An input frame of a run.
struct InputFrame {
  std::int64_t stamp_ns = 0;
  std::optional<SensorFrame> frame;  // nullopt: it could not be read
  std::string reason;                // then: a word for tables
  // Samples of the inertial sensor of a live source since the input frame before, those of frames
  // that were not selected included.
  std::vector<InertialSample> inertial = {};
};

// Source of the frames of a run, one after the other.
class FrameInput {
 public:
  using GoOn = std::function<bool()>;
  using Say = std::function<void(const std::string&)>;

  FrameInput() = default;
  FrameInput(const FrameInput&) = delete;
  FrameInput& operator=(const FrameInput&) = delete;
  virtual ~FrameInput() = default;

  // Returns the next frame as soon as it is available, or due; nullopt if there are no more, or if
  // `go_on`, which is called often, returned false.
  virtual std::optional<InputFrame> Next(const GoOn& go_on) = 0;
  // Shifts the schedule of all later frames by `pause`.
  virtual void Delay(std::chrono::steady_clock::duration /*pause*/) {}
};

// Selected frames of a recording, by index. Live runs get them when they are due, at their original
// intervals; others as soon as they are read, in lockstep runs ahead, by a thread of their own.
// `go_on` is not called while an image is read.
class RecordedInput : public FrameInput {
 public:
  RecordedInput(std::shared_ptr<const Dataset> dataset,
                std::vector<std::size_t> frames,
                RunMode mode,
                Say say);
  std::optional<InputFrame> Next(const GoOn& go_on) override;
  void Delay(std::chrono::steady_clock::duration pause) override { schedule_.Delay(pause); }

 private:
  Expected<SensorFrame, ImageFailure> Read(std::size_t k);

  std::shared_ptr<const Dataset> dataset_;
  std::vector<std::size_t> frames_;
  std::size_t position_ = 0;  // of the next frame
  bool live_;
  Say say_;
  PlaybackSchedule schedule_;
  std::optional<ReadAhead> ahead_;
};

// Selected frames of a source: every stride-th from `from` to before `to`.
struct FrameSelection {
  std::size_t from = 0;
  std::size_t to = 0;
  std::size_t stride = 1;
};

// Frames of a live source with increasing stamps (StampContinuity). A source that does not answer
// is abandoned once `go_on` returns false (CallOrAbandon).
class LiveInput : public FrameInput {
 public:
  LiveInput(std::shared_ptr<LiveSource> source, const FrameSelection& range, Say say);
  // Throws InputError if the source ends before its first frame.
  std::optional<InputFrame> Next(const GoOn& go_on) override;

 private:
  InputFrame Take(LiveEvent event, bool chosen);
  void TakeInertial(std::int64_t source_ns, const StampContinuity::Stamp& stamp);
  void SayWhyMissing(const std::string& why);

  std::string name_;
  FrameSelection range_;
  Say say_;
  std::size_t next_ = 0;      // index of the next frame
  std::size_t position_ = 0;  // number of the next selected frame
  // reason why the previous selected frame was missing; empty: it was not
  std::string last_why_;
  std::size_t alike_ = 0;  // successive selected frames with this reason
  StampContinuity continuity_;
  std::vector<InertialSample> inertial_;  // for the next selected frame
  std::shared_ptr<LiveSource> source_;
};

}  // namespace plumbline
