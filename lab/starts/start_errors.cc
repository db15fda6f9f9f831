// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/starts/start_errors.h"

#include "plumbline/base/elementary.h"
#include "plumbline/base/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumbline {
namespace {

using Eigen::Vector3d;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::size_t kLeastPoints = 10;

double AngleDeg(const Vector3d& a, const Vector3d& b) {
  return kDegrees * math::Atan2(a.cross(b).norm(), a.dot(b));
}

void CompareMotion(const Rigid3& estimate, const Rigid3& truth, StartErrors& errors) {
  errors.rotation_deg = kDegrees * AngularDistance(estimate.rotation, truth.rotation);
  // Without any motion no direction is right.
  constexpr double kNone = 180;
  const Vector3d centre = Inverse(truth).translation;
  errors.direction_deg = centre.isZero(0) ? kNone : AngleDeg(Inverse(estimate).translation, centre);
}

// Of each point with a true depth: that depth by the estimated one.
std::vector<double> DepthRatios(const InitialMap& map,
                                const TrueDepth& depth,
                                const RectifiedCamera& camera) {
  std::vector<double> ratios;
  for (const InitialPoint& point : map.points) {
    const Vector3d p = map.views.front().cam_from_world * point.position;
    if (p.z() == 0) continue;
    // A point behind the camera lies on the line through the pixel that shows it as well.
    if (const auto truth = depth.PointAt(camera.Project(p))) ratios.push_back(truth->z() / p.z());
  }
  return ratios;
}

void CompareDepths(const std::vector<double>& ratios, StartErrors& errors) {
  constexpr double kFar = 0.2;
  errors.compared = static_cast<int>(ratios.size());
  if (ratios.size() < kLeastPoints) return;
  const double middle = UpperMedian(ratios);
  std::vector<double> differences;
  std::size_t far = 0;
  for (const double ratio : ratios) {
    differences.push_back(std::abs(ratio / middle - 1));
    far += differences.back() > kFar;
  }
  const bool mirrored = middle <= 0;
  errors.depth = mirrored ? std::numeric_limits<double>::infinity() : UpperMedian(differences);
  errors.depth_outliers =
      mirrored ? 1 : static_cast<double>(far) / static_cast<double>(ratios.size());
}

}  // namespace

double MedianParallaxDeg(const std::vector<Vector3d>& points,
                         const Rigid3& b_from_a,
                         const RectifiedCamera& camera) {
  constexpr std::size_t kLeastShare = 10;
  const Vector3d centre = Inverse(b_from_a).translation;
  std::vector<double> angles;
  for (const Vector3d& point : points) {
    const Vector3d in_b = b_from_a * point;
    if (in_b.z() <= 0 || !camera.Contains(camera.Project(in_b))) continue;
    angles.push_back(AngleDeg(point, point - centre));
  }
  if (angles.size() < kLeastPoints || kLeastShare * angles.size() < points.size()) return 0;
  return UpperMedian(std::move(angles));
}

StartErrors CompareInitialMap(const InitialMap& map,
                              const std::optional<Rigid3>& true_newest_from_first,
                              const TrueDepth* depth,
                              const RectifiedCamera& camera) {
  StartErrors errors;
  if (true_newest_from_first) {
    const Rigid3 newest_from_first =
        map.views.back().cam_from_world * Inverse(map.views.front().cam_from_world);
    CompareMotion(newest_from_first, *true_newest_from_first, errors);
  }
  if (depth != nullptr) CompareDepths(DepthRatios(map, *depth, camera), errors);
  return errors;
}

std::string ExceededLimits(const StartMap& map, const StartLimits& limits) {
  std::string names;
  const auto check = [&names](bool exceeded, const char* name) {
    if (exceeded) names += (names.empty() ? "" : " ") + std::string(name);
  };
  const StartErrors& errors = map.errors;
  check(errors.rotation_deg.value_or(0) > limits.rotation_deg, "rotation");
  check(errors.direction_deg.value_or(0) > limits.direction_deg, "direction");
  check(errors.depth.value_or(0) > limits.depth, "depth");
  check(map.parallax_deg.value_or(limits.parallax_deg) < limits.parallax_deg, "parallax");
  return names;
}

}  // namespace plumbline
