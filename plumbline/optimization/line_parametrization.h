// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <type_traits>
#include <utility>

namespace plumbline {

// The parameters of a line in bundle adjustment. The residual is the same, so is the cost at the
// minimum; docs/benchmarks.md compares their speed.
enum class LineParametrization {
  kPlucker,      // orthonormal form of the Plücker coordinates, 4 parameters
  kPluckerLeft,  // the same, turned about the axes of the frame: U <- Exp(theta) U, as PPL-SLAM
  kEndpoints,    // two points, 6 parameters; two of them are held, as no image fixes them
};

constexpr auto EnumNames(std::type_identity<LineParametrization>) {
  return std::array{std::pair{LineParametrization::kPlucker, "plucker"},
                    std::pair{LineParametrization::kPluckerLeft, "plucker_left"},
                    std::pair{LineParametrization::kEndpoints, "endpoints"}};
}

// The two residuals of a line in an image, in pixels.
enum class LineResidualKind {
  kObservedEnds,   // of the measured ends from the projected infinite line (first paper, eq. 13)
  kProjectedEnds,  // of the projected ends from the measured infinite line (second paper, eq. 1)
};

constexpr auto EnumNames(std::type_identity<LineResidualKind>) {
  return std::array{std::pair{LineResidualKind::kObservedEnds, "observed_ends"},
                    std::pair{LineResidualKind::kProjectedEnds, "projected_ends"}};
}

}  // namespace plumbline
