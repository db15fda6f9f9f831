// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/solvers/parallax.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/median.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace plumbline {

namespace {

std::vector<double> Parallaxes(std::span<const RayMatch> matches,
                               const Eigen::Quaterniond& b_from_a) {
  std::vector<double> angles;
  angles.reserve(matches.size());
  for (const RayMatch& match : matches) {
    const Eigen::Vector3d q = b_from_a * match.a.homogeneous();
    const Eigen::Vector3d b = match.b.homogeneous();
    angles.push_back(math::Atan2(q.cross(b).norm(), q.dot(b)));
  }
  return angles;
}

}  // namespace

double MedianParallax(std::span<const RayMatch> matches, const Eigen::Quaterniond& b_from_a) {
  return UpperMedian(Parallaxes(matches, b_from_a));
}

double ParallaxOf(std::size_t count,
                  std::span<const RayMatch> matches,
                  const Eigen::Quaterniond& b_from_a) {
  std::vector<double> angles = Parallaxes(matches, b_from_a);
  if (angles.empty() || count == 0) return 0;
  const std::size_t rank = std::min(count, angles.size()) - 1;
  std::nth_element(angles.begin(),
                   angles.begin() + static_cast<std::ptrdiff_t>(rank),
                   angles.end(),
                   std::greater<>());
  return angles[rank];
}

}  // namespace plumbline
