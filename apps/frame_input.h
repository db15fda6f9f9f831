// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/image/image.h"
#include "plumbline/io/dataset.h"
#include "plumbline/live/live_source.h"
#include "plumbline/live/stamp_continuity.h"
#include "plumbline/report/playback_schedule.h"
#include "plumbline/slam/options.h"

#include "apps/frame_reader.h"
#include "apps/patient_reader.h"
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

// A frame on its way into a run.
struct InputFrame {
  std::int64_t stamp_ns = 0;
  std::optional<SensorFrame> frame;  // nullopt: it could not be had
  std::string reason;                // then: a word for tables
};

// Where a run gets its frames from, one after the other.
class FrameInput {
 public:
  using GoOn = std::function<bool()>;
  using Say = std::function<void(const std::string&)>;

  FrameInput() = default;
  FrameInput(const FrameInput&) = delete;
  FrameInput& operator=(const FrameInput&) = delete;
  virtual ~FrameInput() = default;

  // The next frame when it is there, or due. nullopt: there are no more, or `go_on`, which is asked
  // often, said no.
  virtual std::optional<InputFrame> Next(const GoOn& go_on) = 0;
  // What comes next is due that much later: nobody asked for a while.
  virtual void Delay(std::chrono::steady_clock::duration /*pause*/) {}
};

// Some of the frames of a recording, by index. Live runs get them when they are due, as far apart
// as they were taken; others as soon as they are read.
class RecordedInput : public FrameInput {
 public:
  RecordedInput(std::shared_ptr<const Dataset> dataset,
                std::vector<std::size_t> frames,
                RunMode mode,
                Say say);
  std::optional<InputFrame> Next(const GoOn& go_on) override;
  void Delay(std::chrono::steady_clock::duration pause) override { schedule_.Delay(pause); }

 private:
  std::shared_ptr<const Dataset> dataset_;
  std::vector<std::size_t> frames_;
  std::size_t position_ = 0;  // of the frame that comes next
  bool live_;
  Say say_;
  PlaybackSchedule schedule_;
  FrameReader reader_;
};

// Which frames of a source are taken: every stride-th from `from` to before `to`.
struct FrameSelection {
  std::size_t from = 0;
  std::size_t to = 0;
  std::size_t stride = 1;
};

// The frames of a live source with stamps that increase (StampContinuity).
class LiveInput : public FrameInput {
 public:
  LiveInput(const std::shared_ptr<LiveSource>& source, const FrameSelection& range, Say say);
  // InputError where the source ends before its first frame.
  std::optional<InputFrame> Next(const GoOn& go_on) override;

 private:
  InputFrame Take(LiveEvent event, bool chosen);
  void SayWhyMissing(const std::string& why);

  std::string name_;
  FrameSelection range_;
  Say say_;
  std::size_t next_ = 0;      // index of the frame that comes next
  std::size_t position_ = 0;  // number of the chosen frame that comes next
  std::string last_why_;      // why the chosen frame before was missing; empty: it was not
  std::size_t alike_ = 0;     // chosen frames in succession that have this reason
  StampContinuity continuity_;
  PatientReader<LiveEvent> reader_;
};

}  // namespace plumbline
