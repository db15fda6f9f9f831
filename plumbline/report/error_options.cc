// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/report/error_options.h"

#include <cstdint>

namespace plumbline {

TrajectoryErrorOptions ErrorOptionsFor(SensorKind sensor, DatasetFormat format) {
  constexpr std::int64_t kKittiGapNs = 250'000'000;  // its frames are 0.1 s apart
  TrajectoryErrorOptions options;
  if (sensor == SensorKind::kMono) options.alignment = TrajectoryAlignment::kSim3;
  if (format == DatasetFormat::kKitti) options.max_gap_ns = kKittiGapNs;
  return options;
}

}  // namespace plumbline
