// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/slam/load_control.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

constexpr double kShareOfLines = 0.5;
// Half of the points would double the error of a car at 5 images a second and save a tenth of the
// time.
constexpr double kShareOfPoints = 0.75;
constexpr double kShareOfMapping = 0.4;  // share of the keyframes that mapping looks at

LoadLevel More(LoadLevel shed) {
  return shed < LoadLevel::kPoints ? static_cast<LoadLevel>(static_cast<int>(shed) + 1) : shed;
}

LoadLevel Less(LoadLevel shed) {
  return shed > LoadLevel::kNothing ? static_cast<LoadLevel>(static_cast<int>(shed) - 1) : shed;
}

// Returns the share of a number, rounded; at least 1, unless the number is 0.
int Part(int number, double share) {
  return number == 0 ? 0 : std::max(1, static_cast<int>(std::lround(share * number)));
}

}  // namespace

LoadLevel LoadControl::Next(const Load& load) {
  const bool dropped = load.frames_dropped > 0;
  const bool late = dropped || load.wait > kLateWait;
  late_ = late ? late_ + 1 : 0;
  calm_ = !late && load.wait < kCalmWait ? calm_ + 1 : 0;
  if (dropped || late_ >= kLateFrames) {
    shed_ = More(shed_);
    late_ = 0;
  } else if (calm_ >= kCalmFrames) {
    shed_ = Less(shed_);
    calm_ = 0;
  }
  if (load.tasks_waiting >= kManyTasksWaiting) mapping_ = true;
  if (load.tasks_waiting == 0) mapping_ = false;
  return std::max(shed_, mapping_ ? LoadLevel::kMapping : LoadLevel::kNothing);
}

double FeatureShare(LoadLevel shed) { return shed >= LoadLevel::kPoints ? kShareOfPoints : 1; }

FeatureOptions ReducedOptions(FeatureOptions options, LoadLevel shed) {
  if (shed >= LoadLevel::kLines) options.line_count = Part(options.line_count, kShareOfLines);
  if (shed >= LoadLevel::kPoints) options.point_count = Part(options.point_count, kShareOfPoints);
  return options;
}

MappingOptions ReducedOptions(MappingOptions options, LoadLevel shed) {
  if (shed < LoadLevel::kMapping) return options;
  const auto less = [](int& number) { number = Part(number, kShareOfMapping); };
  less(options.fusion_neighbours);
  less(options.creation.neighbours);
  less(options.window.free_keyframes);
  less(options.window.fixed_keyframes);
  options.ba.rounds = std::min(options.ba.rounds, 2);
  less(options.ba.max_iterations);
  return options;
}

}  // namespace plumbline
