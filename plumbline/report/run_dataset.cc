// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_dataset.h"

#include "plumbline/report/reading_time.h"
#include "plumbline/slam/pipeline.h"

#include <chrono>
#include <cstddef>
#include <optional>
#include <thread>

namespace plumbline {
namespace {

// Reads the frames of a recording, each as long before it is due as reading takes, and gives each
// out when it is due.
class LiveReader {
 public:
  explicit LiveReader(const Dataset& dataset) : dataset_(dataset) {}

  Expected<SensorFrame, ImageFailure> Read(std::size_t frame) {
    if (start_) std::this_thread::sleep_until(DueOf(frame) - reading_.Enough());
    const Clock::time_point begin = Clock::now();
    auto read = dataset_.Read(frame);
    reading_.Add(Clock::now() - begin);
    if (!start_) start_ = Clock::now();
    std::this_thread::sleep_until(DueOf(frame));
    return read;
  }

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point DueOf(std::size_t frame) const {
    return *start_ + std::chrono::nanoseconds(dataset_.stamp_ns(frame) - dataset_.stamp_ns(0));
  }

  const Dataset& dataset_;
  std::optional<Clock::time_point> start_;  // when the first frame was due
  ReadingTime reading_;
};

}  // namespace

std::unique_ptr<System> RunDataset(const Dataset& dataset,
                                   const SlamOptions& options,
                                   const FrameObserver& observe,
                                   const StopCheck& stop) {
  auto system = std::make_unique<System>(dataset.calibration(), options);
  const bool live = options.slam.mode == RunMode::kLive;
  LiveReader live_reader(dataset);
  Pipeline pipeline(*system, [&observe](const FrameRecord& record, const FrameView&) {
    if (observe) observe(record);
  });
  for (std::size_t i = 0; i < dataset.size(); ++i) {
    if (IsToStop(stop)) break;
    const auto frame = live ? live_reader.Read(i) : dataset.Read(i);
    if (frame) {
      pipeline.Feed(*frame);
    } else {
      pipeline.Skip(dataset.stamp_ns(i), "image_unreadable");
    }
  }
  pipeline.Finish(stop);
  return system;
}

}  // namespace plumbline
