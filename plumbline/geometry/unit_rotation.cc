// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/geometry/unit_rotation.h"

#include "plumbline/base/error.h"

#include <cmath>
#include <sstream>

namespace plumbline {

bool IsRotation(const Eigen::Quaterniond& quaternion) {
  return std::abs(quaternion.norm() - 1) <= kMostNormError;
}

Eigen::Quaterniond UnitRotation(const Eigen::Quaterniond& quaternion, std::string_view what) {
  constexpr double kRounding = 1e-9;
  const double norm = quaternion.norm();
  if (std::abs(norm - 1) <= kRounding) return quaternion;
  if (IsRotation(quaternion)) return quaternion.normalized();
  std::ostringstream message;
  message << what << ": expected a quaternion of norm 1, found one of norm " << norm;
  throw InputError(message.str());
}

}  // namespace plumbline
