// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace plumbline {

// Duration of one stage for a frame.
struct StageTime {
  std::string stage;
  double milliseconds = 0;
};

// Times the successive stages of one frame, from the construction of the clock.
class StageClock {
 public:
  // Ends a stage, which began at the end of the previous one.
  void Done(const std::string& stage) {
    const auto now = Clock::now();
    times_.push_back({stage, Milliseconds(now - last_)});
    last_ = now;
  }
  // Adds a time measured elsewhere, which is not part of the total.
  void Add(const std::string& stage, double milliseconds) {
    times_.push_back({stage, milliseconds});
  }
  // Returns all stages and "total", which runs from the beginning to the end of the last stage.
  std::vector<StageTime> Finish() {
    times_.push_back({"total", Milliseconds(last_ - start_)});
    return Stages();
  }
  // Returns all stages without a total.
  std::vector<StageTime> Stages() { return std::exchange(times_, {}); }

 private:
  using Clock = std::chrono::steady_clock;
  static double Milliseconds(Clock::duration d) {
    return std::chrono::duration<double, std::milli>(d).count();
  }

  std::vector<StageTime> times_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

}  // namespace plumbline
