// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/run_dataset.h"

#include "plumbline/slam/pipeline.h"

#include <chrono>
#include <cstddef>
#include <thread>

namespace plumbline {

std::unique_ptr<System> RunDataset(const Dataset& dataset,
                                   const SlamOptions& options,
                                   const FrameObserver& observe,
                                   const StopCheck& stop) {
  auto system = std::make_unique<System>(dataset.calibration(), options);
  const bool live = options.slam.mode == RunMode::kLive;
  const auto begin = std::chrono::steady_clock::now();
  Pipeline pipeline(*system, [&observe](const FrameRecord& record, const FrameView&) {
    if (observe) observe(record);
  });
  for (std::size_t i = 0; i < dataset.size(); ++i) {
    if (IsToStop(stop)) break;
    const auto frame = dataset.Read(i);
    const std::chrono::nanoseconds due(dataset.stamp_ns(i) - dataset.stamp_ns(0));
    if (live) std::this_thread::sleep_until(begin + due);
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
