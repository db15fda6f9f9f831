// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/parallax.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/median.h"

#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace plumbline {

double MedianParallax(std::span<const RayMatch> matches, const Eigen::Quaterniond& b_from_a) {
  std::vector<double> angles;
  angles.reserve(matches.size());
  for (const RayMatch& match : matches) {
    const Eigen::Vector3d q = b_from_a * match.a.homogeneous();
    const Eigen::Vector3d b = match.b.homogeneous();
    angles.push_back(math::Atan2(q.cross(b).norm(), q.dot(b)));
  }
  return UpperMedian(std::move(angles));
}

}  // namespace plumbline
