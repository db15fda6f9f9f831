// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/consistency/consistency_sample.h"

#include <filesystem>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace plumbline {

// Poses at which features and landmarks are held against each other.
enum class ConsistencyPoses { kTruth, kRun };
constexpr auto EnumNames(std::type_identity<ConsistencyPoses> /*of*/) {
  return std::array{std::pair{ConsistencyPoses::kTruth, "truth"},
                    std::pair{ConsistencyPoses::kRun, "run"}};
}

// Returns the errors of what a run measured, mapped and reported (ResidualSamples,
// LandmarkSamples where the world is known, MotionSamples).
//
//   sequence  folder of a data set with ground truth, perhaps with lines.csv and surfaces.csv
//   run       folder of a run over it: trajectory.txt, trajectory_causal.txt,
//             trajectory_covariance.txt, map.plb, summary.json
//   poses     those of residuals: of the truth, or the run's final ones where the truth is not
//             known to a tenth of a pixel, as in recordings
//   fails     nullopt without ground truth; throws InputError if a file cannot be read
std::optional<std::vector<ConsistencySample>> ReadRunConsistency(
    const std::filesystem::path& sequence,
    const std::filesystem::path& run,
    ConsistencyPoses poses);

}  // namespace plumbline
