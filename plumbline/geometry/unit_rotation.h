// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <Eigen/Geometry>

namespace plumbline {

// Rule for rotations given by callers and files: a quaternion is a rotation if its norm is 1 to
// within kMostNormError. It is then normalized, unless its norm is 1 up to rounding (1e-9): then it
// stays the same to the last bit. Any other quaternion is refused.
constexpr double kMostNormError = 0.01;

// Returns true if the norm is 1 to within kMostNormError; false for NaN.
bool IsRotation(const Eigen::Quaterniond& quaternion);

// Returns the rotation by the rule above. Throws InputError "WHAT: expected a quaternion of norm 1,
// found one of norm 2".
Eigen::Quaterniond UnitRotation(const Eigen::Quaterniond& quaternion, std::string_view what);

}  // namespace plumbline
