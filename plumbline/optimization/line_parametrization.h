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
  kPlucker,    // orthonormal form of the Plücker coordinates, 4 parameters
  kEndpoints,  // two points, 6 parameters; two of them are held, as no image fixes them
};

constexpr auto EnumNames(std::type_identity<LineParametrization>) {
  return std::array{std::pair{LineParametrization::kPlucker, "plucker"},
                    std::pair{LineParametrization::kEndpoints, "endpoints"}};
}

}  // namespace plumbline
