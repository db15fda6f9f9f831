// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/slam/frame_log.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

// Distribution of the time of one stage over the frames in which it ran, milliseconds. Percentiles
// are actual values (nearest rank); the median of an even number is the mean of the middle two.
struct StageStatistics {
  std::string stage;
  std::size_t count = 0;
  double median = 0, p95 = 0, p99 = 0, max = 0, mean = 0;
};

// Returns one entry for each stage, in the order of first appearance. "total" is the time from a
// frame's arrival to its pose.
std::vector<StageStatistics> TimingStatistics(const FrameLog& frames);

// Returns the milliseconds of one stage in the frames with these numbers; nullopt if it did not
// run.
std::vector<std::optional<double>> StageMilliseconds(const FrameLog& frames,
                                                     const std::vector<std::size_t>& numbers,
                                                     const std::string& stage);

// Return a table with a row for each frame and a column for each stage; empty if the stage did not
// run.
std::string FormatTimingCsv(const FrameLog& frames);
std::string FormatTimingJson(const FrameLog& frames);

}  // namespace plumbline
