// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/cutting_testbed/scene.h"

#include <array>
#include <cstdint>
#include <map>
#include <type_traits>
#include <utility>

namespace plumbline {

// Pieces and weights of the lines that determine a pose.
enum class PoseVariant {
  kFull,           // whole, all weights 1
  kCut,            // greedy, independent
  kCutSweeps,      // greedy_sweeps
  kCutPrinted,     // greedy with the printed information
  kDrop,           // the worst 30 % left out
  kScalar,         // whole, each line by the inverse of its mean variance
  kWeighted,       // whole, each residual by the inverse of its variance (2 x 2, diagonal there)
  kCutWeighted,    // greedy, each residual by the inverse of its variance
  kCutCorrelated,  // greedy, 2 x 2 with the covariance between the two residuals
  kLongCutCorrelated,  // the same with points cut to pieces of a tenth of the line
  kDropWeighted,       // drop, then as kWeighted
  kAdjusted,           // whole, the ends estimated with the pose (SolvePoseAndPoints)
  kCutAdjusted,        // greedy, the cut points estimated with the pose
};
constexpr auto EnumNames(std::type_identity<PoseVariant>) {
  return std::array{std::pair{PoseVariant::kFull, "full"},
                    std::pair{PoseVariant::kCut, "cut"},
                    std::pair{PoseVariant::kCutSweeps, "cut_sweeps"},
                    std::pair{PoseVariant::kCutPrinted, "cut_printed"},
                    std::pair{PoseVariant::kDrop, "drop"},
                    std::pair{PoseVariant::kScalar, "full_scalar"},
                    std::pair{PoseVariant::kWeighted, "full_weighted"},
                    std::pair{PoseVariant::kCutWeighted, "cut_weighted"},
                    std::pair{PoseVariant::kCutCorrelated, "cut_correlated"},
                    std::pair{PoseVariant::kLongCutCorrelated, "long_cut_correlated"},
                    std::pair{PoseVariant::kDropWeighted, "drop_weighted"},
                    std::pair{PoseVariant::kAdjusted, "full_adjusted"},
                    std::pair{PoseVariant::kCutAdjusted, "cut_adjusted"}};
}

struct PoseError {
  double translation_m = 0;
  double rotation_deg = 0;
  double along_motion_m = 0;  // below 0: the motion is underestimated; 0 without motion
};
using PoseTrial = std::map<PoseVariant, PoseError>;

// Returns the errors of the pose estimated by each variant in scene `index`. The prediction, which
// is the initial pose and the pose of cuts and weights, has errors of 1 degree and 5 cm in each
// axis (standard deviations); all variants have the same measurements.
PoseTrial TryPoses(const SceneOptions& options, std::uint64_t index);

}  // namespace plumbline
