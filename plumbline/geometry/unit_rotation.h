// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <Eigen/Geometry>

namespace plumbline {

// The rule for rotations that callers hand in, and for those of files: a quaternion is a rotation
// where its norm is 1 to within kMostNormError. One that is off by no more is normalized; one that
// is off by rounding alone (1e-9) stays as it is, to the last bit. Any other is refused.
constexpr double kMostNormError = 0.01;

// Whether the norm is 1 to within kMostNormError; false for NaN.
bool IsRotation(const Eigen::Quaterniond& quaternion);

// Returns the rotation by the rule above. Throws InputError "WHAT: expected a quaternion of norm 1,
// found one of norm 2".
Eigen::Quaterniond UnitRotation(const Eigen::Quaterniond& quaternion, std::string_view what);

}  // namespace plumbline
