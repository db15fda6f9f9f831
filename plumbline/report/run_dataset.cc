// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_dataset.h"

#include "plumbline/io/datasets/read_ahead.h"
#include "plumbline/report/playback_schedule.h"
#include "plumbline/slam/pipeline.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <thread>

namespace plumbline {
namespace {

// Reads a frame shortly before it is due, and returns when it is due.
Expected<SensorFrame, ImageFailure> ReadLive(const Dataset& dataset,
                                             std::size_t frame,
                                             PlaybackSchedule& schedule) {
  using Clock = PlaybackSchedule::Clock;
  const std::int64_t stamp_ns = dataset.stamp_ns(frame);
  std::this_thread::sleep_until(schedule.ReadAt(stamp_ns));
  const Clock::time_point begin = Clock::now();
  auto read = dataset.Read(frame);
  std::this_thread::sleep_until(schedule.DueOnceRead(stamp_ns, begin, Clock::now()));
  return read;
}

}  // namespace

RunResult RunDataset(const Dataset& dataset,
                     const SlamOptions& options,
                     const FrameObserver& observe,
                     const StopCheck& stop) {
  System system(dataset.calibration(), options);
  const bool live = options.slam.mode == RunMode::kLive;
  PlaybackSchedule schedule;
  Pipeline pipeline(system, [&observe](const FrameRecord& record, const FrameView&) {
    if (observe) observe(record);
  });
  std::optional<ReadAhead> ahead;
  if (options.slam.mode == RunMode::kLockstep) ahead.emplace(dataset);
  for (std::size_t i = 0; i < dataset.size(); ++i) {
    if (IsToStop(stop)) break;
    const auto next = i + 1 < dataset.size() ? std::optional(i + 1) : std::nullopt;
    auto frame = live    ? ReadLive(dataset, i, schedule)
                 : ahead ? ahead->Read(i, next)
                         : dataset.Read(i);
    if (frame) {
      pipeline.Feed(*std::move(frame));
    } else {
      pipeline.Skip(dataset.stamp_ns(i), frame.error().reason());
    }
  }
  return pipeline.Finish(stop);
}

}  // namespace plumbline
